/* Errors and notes of commands as the window shows them in German: each is translated by its format, with its values. */
#include "test.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/text.h"
#include "command/session.h"
#include "ui/toolkit/words.h"

#include <string.h>

static const struct {
    const char *line;
    const char *english, *german; /* NULL: the line succeeds */
} rows[] = {
    { "dabb 0.5,0.5", "unknown command \"dabb\": did you mean dab?",
      "unbekannter Befehl \"dabb\": war dab gemeint?" },
    { "undo", "undo: nothing to undo",
      "undo: nichts r\xc3\xbc"
      "ckg\xc3\xa4ngig zu machen" },
    { "dab 0.5,0.5 radius=-3.7", "dab: radius=-3.7: must be a number, 0..1e9 texels",
      "dab: radius=-3.7: muss eine Zahl, 0..1e9 Texel sein" },
    { "dab 0.5", "dab: u,v 0.5: must be 2 numbers separated by commas, each -1e9..1e9",
      "dab: u,v 0.5: muss 2 Zahlen mit Kommas dazwischen, jede -1e9..1e9 sein" },
    { "dab 0.5,0.5 radius=3 radius=4", "dab: radius= is given twice",
      "dab: radius= steht zweimal da" },
    { "solid sphere radius=-2",
      "solid sphere: radius=-2: must be a number, above 0, up to 16384 texels",
      "solid sphere: radius=-2: muss eine Zahl, \xc3\xbc"
      "ber 0, bis 16384 Texel sein" },
    { "fill 1 2", "fill: \"2\" is one value too many", "fill: \"2\" ist ein Wert zu viel" },
    { "table 5", "table: WxH 5: must be WxH, two whole numbers, each 1..16384 texels",
      "table: WxH 5: muss WxH, zwei ganze Zahlen, jede 1..16384 Texel sein" },
    { "layer set 9 opacity=0.5", "layer 9: must be 1..1", "Ebene 9: muss 1..1 sein" },
    { "layer set abc opacity=0.5", "layer: no layer is called \"abc\": must be a name or 1..1",
      "layer: keine Ebene hei\xc3\x9ft \"abc\": muss ein Name sein oder 1..1" },
    { "layer delete 1", "layer: the last layer stays: a document has at least one",
      "layer: die letzte Ebene bleibt: ein Dokument hat mindestens eine" },
    { "layer add top", NULL, NULL },
    { "layer set 2 lock=on", NULL, NULL },
    { "dab 0.5,0.5 radius=4", "dab: layer 2 \"top\" is locked: `layer set 2 lock=off` unlocks it",
      "dab: layer 2 \"top\" ist gesperrt: `layer set 2 lock=off` entsperrt sie" },
    { "layer set 2 lock=off", NULL, NULL },
    { "save /nothere/x.exr", "save: /nothere/x.exr: its folder does not exist",
      "save: /nothere/x.exr: den Ordner daf\xc3\xbcr gibt es nicht" },
    /* A word of the system. */
    { "image /nothere/x.png", "image: /nothere/x.png: No such file or directory",
      "image: /nothere/x.png: Datei oder Ordner nicht gefunden" },
    /* From the reader process. */
    { "image " WR_SOURCE_DIR "/tests/CMakeLists.txt",
      "image: " WR_SOURCE_DIR "/tests/CMakeLists.txt: is not a picture of a kind that can be read",
      "image: " WR_SOURCE_DIR
      "/tests/CMakeLists.txt: ist kein Bild einer Art, die gelesen werden kann" },
    /* An error inside an error. */
    { "stroke points=0.1,0.1 set=foo",
      "stroke: set: settings: 'foo': must be NAME=VALUE or NAME:INPUT=X,Y|X,Y|..., with ; between "
      "several",
      "stroke: set: Einstellungen: 'foo': muss NAME=WERT oder NAME:EINGABE=X,Y|X,Y|... sein, mit ; "
      "zwischen mehreren" },
    { "light directional to=0,0,0", "light: to=0,0,0 points nowhere: one number must not be 0",
      "light: to=0,0,0 zeigt nirgends hin: eine Zahl muss ungleich 0 sein" },
    { "adjust levels in-low=1 in-high=1",
      "adjust: levels: in-low and in-high are both 1: they must differ",
      "adjust: levels: in-low und in-high sind beide 1: sie m\xc3\xbcssen verschieden sein" },
    { "object remove nosuch", "object: there is no object \"nosuch\"; the only one is \"object 1\"",
      "object: es gibt kein Objekt \"nosuch\"; das einzige ist \"object 1\"" },
};

static void errors_of_commands_are_translated(void **state)
{
    (void)state;
    WrSession *session = wr_session_new(&(WrSessionOptions){ .composites = true, .outputs = true });
    wr_words_choose(2);
    const bool german = strcmp(wr_words_language(), "de") == 0; /* not without msgfmt */
    for (int i = 0; i < WR_LENGTH(rows); i++) {
        char said[WR_WORDS_MESSAGE];
        WrError err = { "" };
        assert_int_equal(wr_session_run(session, rows[i].line, &err), rows[i].english == NULL);
        if (!rows[i].english) continue;
        wr_words_message(wr_error_message(&err), said, sizeof said);
        assert_string_equal(err.text, rows[i].english);
        if (german) assert_string_equal(said, rows[i].german);
    }
    wr_session_free(session);
    wr_words_choose(1);
}

/* ---- notes ---- */

static void keep(void *ctx, const char *text)
{
    wr_text_add(ctx, text);
}

static void notes_are_messages_if_asked_for(void **state)
{
    (void)state;
    WrText note = { 0 };
    char said[WR_WORDS_MESSAGE];
    wr_words_choose(2);
    const bool german = strcmp(wr_words_language(), "de") == 0;
    for (int messages = 0; messages < 2; messages++) {
        WrSession *session = wr_session_new(
            &(WrSessionOptions){ .note = keep, .note_ctx = &note, .note_messages = messages });
        wr_text_clear(&note);
        assert_true(wr_session_run(session, "export height a.png", NULL));
        static const char english[] =
            "skipped: export height a.png (only `wrinkle run` writes files)";
        if (!messages) assert_string_equal(wr_text_get(&note), english);
        else if (german)
            assert_string_equal(
                wr_words_message(wr_text_get(&note), said, sizeof said),
                "\xc3\xbc"
                "bersprungen: export height a.png (nur `wrinkle run` schreibt Dateien)");
        wr_session_free(session);
    }
    wr_text_fini(&note);
    wr_words_choose(1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_of_commands_are_translated),
        cmocka_unit_test(notes_are_messages_if_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Errors and notes of commands as the window shows them in German and French: each is translated by its format, with its
   values. */
#include "test.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/text.h"
#include "command/session.h"
#include "ui/toolkit/words.h"

#include <string.h>

static const struct {
    const char *line;
    const char *english, *said[2]; /* in German and French; NULL: the line succeeds */
} rows[] = {
    { "dabb 0.5,0.5",
      "unknown command \"dabb\": did you mean dab?",
      { "unbekannter Befehl \"dabb\": war dab gemeint?",
        "commande \"dabb\" inconnue : était-ce dab ?" } },
    { "undo",
      "undo: nothing to undo",
      { "undo: nichts r\xc3\xbc"
        "ckg\xc3\xa4ngig zu machen",
        "undo: rien à annuler" } },
    { "dab 0.5,0.5 radius=-3.7",
      "dab: radius=-3.7: must be a number, 0..1e9 texels",
      { "dab: radius=-3.7: muss eine Zahl, 0..1e9 Texel sein",
        "dab: radius=-3.7 : doit être un nombre, 0..1e9 texels" } },
    { "dab 0.5",
      "dab: u,v 0.5: must be 2 numbers separated by commas, each -1e9..1e9",
      { "dab: u,v 0.5: muss 2 Zahlen mit Kommas dazwischen, jede -1e9..1e9 sein",
        "dab: u,v 0.5 : doit être 2 nombres séparés par des virgules, chacun -1e9..1e9" } },
    { "dab 0.5,0.5 radius=3 radius=4",
      "dab: radius= is given twice",
      { "dab: radius= steht zweimal da", "dab : radius= est donné deux fois" } },
    { "solid sphere radius=-2",
      "solid sphere: radius=-2: must be a number, above 0, up to 16384 texels",
      { "solid sphere: radius=-2: muss eine Zahl, \xc3\xbc"
        "ber 0, bis 16384 Texel sein",
        "solid sphere: radius=-2 : doit être un nombre, au-dessus de 0, jusqu’à 16384 texels" } },
    { "fill 1 2",
      "fill: \"2\" is one value too many",
      { "fill: \"2\" ist ein Wert zu viel", "fill : \"2\" est une valeur de trop" } },
    { "table 5",
      "table: WxH 5: must be WxH, two whole numbers, each 1..16384 texels",
      { "table: WxH 5: muss WxH, zwei ganze Zahlen, jede 1..16384 Texel sein",
        "table: WxH 5 : doit être WxH, deux nombres entiers, chacun 1..16384 texels" } },
    { "layer set 9 opacity=0.5",
      "layer 9: must be 1..1",
      { "Ebene 9: muss 1..1 sein", "calque 9 : doit être 1..1" } },
    { "layer set abc opacity=0.5",
      "layer: no layer is called \"abc\": must be a name or 1..1",
      { "layer: keine Ebene hei\xc3\x9ft \"abc\": muss ein Name sein oder 1..1",
        "layer: aucun calque ne s’appelle \"abc\" : doit être un nom ou 1..1" } },
    { "layer delete 1",
      "layer: the last layer stays: a document has at least one",
      { "layer: die letzte Ebene bleibt: ein Dokument hat mindestens eine",
        "layer: le dernier calque reste : un document en a au moins un" } },
    { "layer add top", NULL, { NULL, NULL } },
    { "layer set 2 lock=on", NULL, { NULL, NULL } },
    { "dab 0.5,0.5 radius=4",
      "dab: layer 2 \"top\" is locked: `layer set 2 lock=off` unlocks it",
      { "dab: layer 2 \"top\" ist gesperrt: `layer set 2 lock=off` entsperrt sie",
        "dab: layer 2 \"top\" est verrouillé : `layer set 2 lock=off` le déverrouille" } },
    { "layer set 2 lock=off", NULL, { NULL, NULL } },
    { "save /nothere/x.exr",
      "save: /nothere/x.exr: its folder does not exist",
      { "save: /nothere/x.exr: den Ordner daf\xc3\xbcr gibt es nicht",
        "save: /nothere/x.exr : son dossier n’existe pas" } },
    /* A word of the system. */
    { "image /nothere/x.png",
      "image: /nothere/x.png: No such file or directory",
      { "image: /nothere/x.png: Datei oder Ordner nicht gefunden",
        "image: /nothere/x.png : aucun fichier ou dossier de ce nom" } },
    /* From the reader process. */
    { "image " WR_SOURCE_DIR "/tests/CMakeLists.txt",
      "image: " WR_SOURCE_DIR "/tests/CMakeLists.txt: is not a picture of a kind that can be read",
      { "image: " WR_SOURCE_DIR
        "/tests/CMakeLists.txt: ist kein Bild einer Art, die gelesen werden kann",
        "image: " WR_SOURCE_DIR
        "/tests/CMakeLists.txt : n’est pas une image d’un genre qui peut être lu" } },
    /* An error inside an error. */
    { "stroke points=0.1,0.1 set=foo",
      "stroke: set: settings: 'foo': must be NAME=VALUE or NAME:INPUT=X,Y|X,Y|..., with ; between "
      "several",
      { "stroke: set: Einstellungen: 'foo': muss NAME=WERT oder NAME:EINGABE=X,Y|X,Y|... sein, mit "
        "; "
        "zwischen mehreren",
        "stroke: set: paramètres : 'foo' : doit être NOM=VALEUR ou NOM:ENTRÉE=X,Y|X,Y|..., avec ; "
        "entre plusieurs" } },
    { "light directional to=0,0,0",
      "light: to=0,0,0: has no direction; one number must not be 0",
      { "light: to=0,0,0 zeigt nirgends hin: eine Zahl muss ungleich 0 sein",
        "light: to=0,0,0 ne pointe nulle part : un nombre ne doit pas être 0" } },
    { "adjust levels in-low=1 in-high=1",
      "adjust: levels: in-low and in-high are both 1: they must differ",
      { "adjust: levels: in-low und in-high sind beide 1: sie m\xc3\xbcssen verschieden sein",
        "adjust: levels : in-low et in-high sont tous deux 1 : ils doivent différer" } },
    { "object remove nosuch",
      "object: no object \"nosuch\": the only one is \"object 1\"",
      { "object: es gibt kein Objekt \"nosuch\"; das einzige ist \"object 1\"",
        "object: il n’y a pas d’objet \"nosuch\" ; le seul est \"object 1\"" } },
};

static void are_translated(int language, const char *code, int column)
{
    WrSession *session = wr_session_new(&(WrSessionOptions){ .composites = true, .outputs = true });
    wr_words_choose(language);
    const bool spoken = strcmp(wr_words_language(), code) == 0; /* not without msgfmt */
    for (int i = 0; i < WR_LENGTH(rows); i++) {
        char said[WR_WORDS_MESSAGE];
        WrError err = { "" };
        assert_int_equal(wr_session_run(session, rows[i].line, &err), rows[i].english == NULL);
        if (!rows[i].english) continue;
        wr_words_message(wr_error_message(&err), said, sizeof said);
        assert_string_equal(err.text, rows[i].english);
        if (spoken) assert_string_equal(said, rows[i].said[column]);
    }
    wr_session_free(session);
    wr_words_choose(1);
}

static void errors_of_commands_are_translated(void **state)
{
    (void)state;
    are_translated(2, "de", 0);
    are_translated(3, "fr", 1);
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

/* Steps of the history in words. */
#include "test.h"

#include "base/error.h"
#include "base/text.h"

#include "ui/app/state/plain_error.h"
#include "ui/app/state/remedy.h"
#include "ui/app/state/step_label.h"
#include "ui/toolkit/words.h"

#include <string.h>

static void lines_are_said_in_words(void **state)
{
    (void)state;
    static const char *const said[][2] = {
        { "stroke preset=leaves radius=44 strength=0.9 points=0.1,0.2;0.3,0.4;0.5,0.6",
          "Stroke, leaves, 3 samples" },
        { "stroke preset=\"/home/me/my brushes/wet clay.myb\" points=0.1,0.2",
          "Stroke, wet clay, 1 sample" },
        { "stroke radius=3 mode=erase points=0.1,0.2;0.3,0.4", "Stroke, erased, 2 samples" },
        { "stroke mode=lower points=0.1,0.2", "Stroke, lowered, 1 sample" },
        { "dab 0.3,0.4 mode=smear radius=3", "Dab, smeared" },
        { "dab 0.3,0.4 mode=raise", "Dab" },
        { "dab 0.25,0.5 tip=stamps/rivet.png radius=20", "Dab, rivet" },
        { "adjust blur sigma=3", "Gaussian blur, sigma 3" },
        { "pattern bricks joint=7", "Bricks, joint 7" },
        { "text \"Tinny Town\" size=80", "Text: Tinny Town, size 80" },
        { "layer add \"second one\"", "New layer: second one" },
        { "layer use 3 part=mask", "Layer 3 chosen" },
        { "layer set 12 visible=off", "Layer 12 hidden" },
        { "layer set 2 visible=on opacity=0.5", "Layer 2 shown" },
        { "layer set 1 lock=on", "Layer 1 locked" },
        { "layer set 7 lock=off", "Layer 7 unlocked" },
        { "layer set 5 opacity=0.3", "Layer 5, opacity 0.3" },
        { "layer set 2,4,15 visible=off", "3 layers hidden" },
        { "layer set 2,moss visible=on", "2 layers shown" },
        { "layer set 1,3 lock=on", "2 layers locked" },
        { "layer set 12,13,14,15 lock=off", "4 layers unlocked" },
        { "layer set 2,4 opacity=0.3", "2 layers, opacity 0.3" },
        { "layer delete 2,4", "2 layers deleted" },
        { "image /tmp/pictures/bark.v2.png", "Heights of a picture, bark.v2" },
        { "table 512x256", "New table, 512x256" },
        { "light directional to=1,1,1 # noon", "Light source, directional, to 1,1,1" },
        { "bump height=0.25 method=blinn", "Bump, height 0.25, method blinn" },
        { "step set 3 line=\"fill 0.5\"", "Change of the history, set 3, line fill 0.5" },
        { "hum 3", "Hum, 3" },
        { "", "" },
        { "stroke", "Stroke" },
        { "stroke points=", "Stroke, 0 samples" },
    };
    for (size_t i = 0; i < sizeof said / sizeof *said; i++) {
        WrText out = { 0 };
        wr_step_label(said[i][0], &out);
        assert_string_equal(wr_text_get(&out), said[i][1]);
        wr_text_fini(&out);
    }
    /* lines of any length */
    char line[40000] = "stroke points=";
    for (int i = 0; i < 6000; i++) strcat(line, i ? ";0,0" : "0,0");
    WrText out = { 0 };
    wr_step_label(line, &out);
    assert_string_equal(wr_text_get(&out), "Stroke, 6000 samples");
    wr_text_clear(&out);
    for (size_t i = 0; i + 2 < sizeof line; i++) line[i] = i % 2 ? ' ' : 'x';
    line[sizeof line - 2] = '\0';
    wr_step_label(line, &out);
    assert_string_equal(wr_text_get(&out), "X, x x");
    wr_text_fini(&out);
}

static void an_error_offers_the_command_that_it_names(void **state)
{
    (void)state;
    static const struct {
        const char *text, *shown, *line, *label;
    } rows[] = {
        { "stroke: layer 8 \"Moss\" is hidden: `layer set 8 visible=on` shows it",
          "stroke: layer 8 \"Moss\" is hidden", "layer set 8 visible=on", "Show layer" },
        { "layer 3 is locked: `layer set 3 lock=off` unlocks it", "layer 3 is locked",
          "layer set 3 lock=off", "Unlock layer" },
        { "Ebene 2 ist verborgen: `layer set 2 visible=on` zeigt sie", "Ebene 2 ist verborgen",
          "layer set 2 visible=on", "Show layer" },
        /* the first one lacks its values */
        { "layer 5 is a generator layer: `layer set 5 change=` changes its arguments, `layer "
          "rasterize 5` makes heights of it",
          "layer 5 is a generator layer", "layer rasterize 5", "Rasterize layer" },
        { "layer 4 \"a: `layer delete 1` b\" is locked: `layer set 4 lock=off` unlocks it",
          "layer 4 \"a: `layer delete 1` b\" is locked", "layer set 4 lock=off", "Unlock layer" },
        { "there is no ground: `ground on` adds one", NULL, NULL, NULL }, /* has no label */
        /* a file would be written; words that are no command; an open quote */
        { "nothing to do: `save a.exr` writes it", NULL, NULL, NULL },
        { "name= is for a new layer: `layer rename` renames one", NULL, NULL, NULL },
        { "ends in `layer add", NULL, NULL, NULL },
        { "", NULL, NULL, NULL },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        WrRemedy remedy;
        if (wr_remedy_find(rows[i].text, &remedy) != (rows[i].line != NULL))
            fail_msg("%s", rows[i].text);
        if (!rows[i].line) continue;
        assert_string_equal(remedy.line, rows[i].line);
        assert_string_equal(remedy.label, rows[i].label);
        assert_int_equal(remedy.length, strlen(rows[i].shown));
        assert_memory_equal(rows[i].text, rows[i].shown, (size_t)remedy.length);
    }
}

/* Errors as commands write them, and as the window shows them. */
static void errors_are_shown_in_plain_words(void **state)
{
    (void)state;
    char out[WR_WORDS_MESSAGE];
    const char *actions[WR_PLAIN_ACTIONS];
    WrError err;
    wr_fail(&err,
            "%s is a filter layer, which has no heights of its own: `layer use` another layer, or "
            "its mask",
            "layer 8 \"blur\"");
    wr_error_prefix(&err, "%s: ", "stroke");
    wr_plain_error(wr_error_message(&err), out, sizeof out);
    assert_string_equal(out, "This is a filter layer. Paint on its mask, or choose another layer.");
    assert_true(wr_plain_error_actions(wr_error_message(&err), actions));
    assert_string_equal(actions[0], "mask_edit");
    /* an error without a row loses its verb alone; a name that is no verb stays */
    wr_fail(&err, "corner=%g: must be %g or more", -3.0, 0.0);
    wr_error_prefix(&err, "%s: ", "shape");
    wr_plain_error(wr_error_message(&err), out, sizeof out);
    assert_string_equal(out, "corner=-3: must be 0 or more");
    assert_false(wr_plain_error_actions(wr_error_message(&err), actions));
    assert_null(actions[0]);
    wr_fail(&err, "%s: %s", "/tmp/stroke.png", "No such file or directory");
    wr_plain_error(wr_error_message(&err), out, sizeof out);
    assert_string_equal(out, "/tmp/stroke.png: No such file or directory");
    /* without marks, as other threads pass it on */
    wr_plain_error("dab: the table is flat", out, sizeof out);
    assert_string_equal(out, "the table is flat");
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(lines_are_said_in_words),
                                        cmocka_unit_test(errors_are_shown_in_plain_words),
                                        cmocka_unit_test(
                                            an_error_offers_the_command_that_it_names) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

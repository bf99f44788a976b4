/* Edit previews: computed without changing the document, and equal to the command's result. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "system/clock.h"

#include "ui/canvas/outline.h"
#include "ui/app/jobs/edit_preview.h"

#include <unistd.h>

static WrSession *session_of(const char *const *lines, int count)
{
    WrError err;
    WrSession *session = wr_session_new(&(WrSessionOptions){ 0 });
    for (int i = 0; i < count; i++)
        if (!wr_session_run(session, lines[i], &err)) fail_msg("%s: %s", lines[i], err.text);
    return session;
}

static const char *const painted[] = { "table 256x192", "grid cells=4x3 width=6 low=0 high=1",
                                       "layer add moss blend=max",
                                       "stroke points=0.1,0.2;0.9,0.7 radius=20 strength=2",
                                       "select rect from=0.3,0.1 to=1.2,0.6" };

static void wait_until_done(WrEditPreview *trial)
{
    double began = wr_clock_seconds();
    while (wr_edit_preview_busy(trial, NULL, NULL) && wr_clock_seconds() - began < 20) usleep(500);
    assert_false(wr_edit_preview_busy(trial, NULL, NULL));
}

static void assert_same_heights(const WrField *a, const WrField *b)
{
    WrHash x = wr_field_hash(a), y = wr_field_hash(b);
    assert_memory_equal(&x, &y, sizeof x);
}

/* Preview, then run: both composites are bit-identical. */
static void try_then_run(const WrEditPreviewRequest *ask, const char *line)
{
    WrError err;
    WrSession *session = session_of(painted, 5);
    WrEditPreview *trial = wr_edit_preview_new(1, SDL_USEREVENT);
    WrHash before = wr_session_hash(session);
    wr_edit_preview_request(trial, wr_session_document(session), ask);
    wait_until_done(trial);
    WrHash after = wr_session_hash(session);
    assert_memory_equal(&before, &after, sizeof before);
    const WrField *tried = wr_edit_preview_field(trial);
    assert_non_null(tried);
    if (!wr_session_run(session, line, &err)) fail_msg("%s: %s", line, err.text);
    assert_same_heights(tried, wr_document_field(wr_session_document(session)));
    wr_edit_preview_end(trial);
    assert_null(wr_edit_preview_field(trial));
    wr_edit_preview_free(trial);
    wr_session_free(session);
}

static void an_operation_that_is_tried_comes_out_as_its_command(void **state)
{
    (void)state;
    try_then_run(&(WrEditPreviewRequest){ .op = wr_op_find("blur"), .param = { 5 } },
                 "adjust blur sigma=5");
    try_then_run(
        &(WrEditPreviewRequest){ .op = wr_op_find("invert"), .param = { 1 }, .all_layers = true },
        "adjust invert about=zero layers=all");
}

static void a_command_that_is_tried_comes_out_as_it_runs(void **state)
{
    (void)state;
    static const char *const lines[] = { "layer mask 2 live=\"wear low=0.02 seed=7\"",
                                         "layer duplicate 2 linked=on" };
    for (int i = 0; i < 2; i++)
        try_then_run(&(WrEditPreviewRequest){ .command = lines[i] }, lines[i]);
}

/* Coverage moves along if texels only move. */
static void an_offset_that_is_tried_moves_what_layers_say_too(void **state)
{
    (void)state;
    try_then_run(&(WrEditPreviewRequest){ .op = wr_op_find("offset"),
                                          .param = { 100, 31 },
                                          .all_layers = true },
                 "adjust offset du=100 dv=31 layers=all");
    /* if the filter overshoots, coverage stays within 0 to 1 */
    try_then_run(&(WrEditPreviewRequest){ .op = wr_op_find("warp"),
                                          .param = { 23.7, 9, 3, 0, 7 },
                                          .all_layers = true },
                 "adjust warp amount=23.7 cells=9 octaves=3 seed=7 layers=all");
}

static void a_layers_settings_that_are_tried_come_out_as_their_command(void **state)
{
    (void)state;
    try_then_run(
        &(WrEditPreviewRequest){
            .layer = 1, .blend = WR_BLEND_SMOOTH_MAX, .opacity = 0.5f, .radius = 0.25f },
        "layer set 2 blend=smooth-max opacity=0.5 radius=0.25");
}

/* Inside the selection, onto the active layer, with its blend mode. */
static void a_generator_that_is_tried_comes_out_as_its_command(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "pattern bricks across=3 rows=5 height=0.5 blend=smooth-max offset=-0.1",
        "noise perlin cells=5 octaves=3 blend=add",
        "formula fourier terms=3,0,0.5;0,5,0.25,90,0 blend=multiply"
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        try_then_run(&(WrEditPreviewRequest){ .line = lines[i] }, lines[i]);
}

static void take_note(void *ctx, const char *text)
{
    snprintf(ctx, 256, "%s", text);
}

static void what_a_generator_notes_is_told_with_what_it_shows(void **state)
{
    (void)state;
    WrError err;
    char said[256] = "", expected[260];
    static const char line[] = "noise perlin cells=64 octaves=10";
    WrSession *session = wr_session_new(&(WrSessionOptions){ .note = take_note, .note_ctx = said });
    WrEditPreview *trial = wr_edit_preview_new(1, SDL_USEREVENT);
    wr_edit_preview_request(trial, wr_session_document(session),
                            &(WrEditPreviewRequest){ .line = line });
    wait_until_done(trial);
    assert_true(wr_session_run(session, line, &err));
    assert_true(said[0]);
    snprintf(expected, sizeof expected, "%s\n", said);
    assert_string_equal(wr_edit_preview_notes(trial), expected);
    assert_true(wr_edit_preview_seconds(trial) > 0.0);
    wr_edit_preview_end(trial);
    assert_string_equal(wr_edit_preview_notes(trial), "");
    wr_edit_preview_free(trial);
    wr_session_free(session);
}

static double mean_difference(const WrField *a, const WrField *b)
{
    int width = wr_field_width(a), height = wr_field_height(a);
    float *row = wr_alloc((size_t)width, 2 * sizeof *row);
    double sum = 0.0;
    for (int j = 0; j < height; j++) {
        wr_field_read(a, 0, j, width, 1, row, (size_t)width);
        wr_field_read(b, 0, j, width, 1, row + width, (size_t)width);
        for (int i = 0; i < width; i++) sum += fabs((double)row[i] - (double)row[width + i]);
    }
    wr_free(row);
    return sum / width / height;
}

/* Lines of 24 texels with bevels of 8, 128 apart, made at half the size: a length that is not halved would cover as
   many texels too much on both sides, a tenth of the table and more. */
static void a_rough_trial_is_near_and_then_the_exact_one_comes(void **state)
{
    (void)state;
    WrError err;
    static const char line[] = "pattern grid across=8 rows=8 width=24 bevel=8";
    WrSession *session = session_of((const char *const[]){ "table 1024x1024" }, 1);
    WrEditPreview *trial = wr_edit_preview_new(1, SDL_USEREVENT);
    WrEditPreviewRequest ask = { .line = line, .rough = true };
    wr_edit_preview_request(trial, wr_session_document(session), &ask);
    wait_until_done(trial);
    assert_true(wr_edit_preview_is_rough(trial)); /* the exact one starts when this is fetched */
    WrField *rough = wr_field_share(wr_edit_preview_field(trial));
    wait_until_done(trial);
    assert_false(wr_edit_preview_is_rough(trial));
    WrField *exact = wr_field_share(wr_edit_preview_field(trial));
    assert_true(wr_session_run(session, line, &err));
    assert_same_heights(exact, wr_document_field(wr_session_document(session)));
    assert_int_equal(wr_field_width(rough), 1024);
    assert_true(mean_difference(rough, exact) > 0.0);
    assert_true(mean_difference(rough, exact) < 0.02);
    wr_field_free(rough);
    wr_field_free(exact);
    wr_edit_preview_free(trial);
    wr_session_free(session);
}

/* The rough result of a change within a stack is nearer to the exact one than the composite before the change.
   grouped: layers 2 and 3 in a group, with layer 4 in another */
static void rough_changes(bool grouped)
{
    static const char *const stack[] = {
        "table 1087x1031",
        "noise gradient cells=7 amplitude=0.3 seed=5",
        "layer add low from=\"noise perlin cells=6 amplitude=0.4 seed=8 blend=add\"",
        "filter blur sigma=2",
        "layer add top from=\"noise gradient cells=90 amplitude=0.1\"",
        "layer set top blend=add opacity=0.7"
    };
    static const char *const groups[] = { "layer group inner of=2..3", "layer group outer of=2..5",
                                          "layer set outer opacity=0.8", "layer use top" };
    const WrOpInfo *blur = wr_op_find("blur");
    const struct {
        WrEditPreviewRequest ask;
        const char *line;
    } changes[] = {
        { { .line = "noise perlin cells=6 amplitude=0.55 seed=8",
            .target = WR_LINE_OF_LAYER,
            .rough = true,
            .layer = 1,
            .blend = WR_BLEND_ADD,
            .radius = 0.1f,
            .opacity = 1.0f },
          "layer set low change=\"amplitude=0.55\"" },
        { { .layer = 1, .blend = WR_BLEND_ADD, .opacity = 0.25f }, "layer set low opacity=0.25" },
        { { .line = "noise perlin cells=5 amplitude=0.2 blend=add",
            .target = WR_LINE_NEW_LAYER,
            .rough = true },
          "layer add new from=\"noise perlin cells=5 amplitude=0.2 blend=add\"" },
        { { .op = blur, .param = { 31 }, .filters = true, .layer = 2 },
          "filter blur sigma=31 layer=3" },
    };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        WrError err = { "" };
        WrSession *session = session_of(stack, sizeof stack / sizeof *stack);
        for (size_t k = 0; grouped && k < sizeof groups / sizeof *groups; k++)
            if (!wr_session_run(session, groups[k], &err)) fail_msg("%s", err.text);
        WrField *before = wr_field_share(wr_document_field(wr_session_document(session)));
        WrEditPreview *trial = wr_edit_preview_new(2, SDL_USEREVENT);
        wr_edit_preview_request(trial, wr_session_document(session), &changes[i].ask);
        wait_until_done(trial);
        assert_true(wr_edit_preview_is_rough(trial));
        WrField *rough = wr_field_share(wr_edit_preview_field(trial));
        wait_until_done(trial);
        assert_false(wr_edit_preview_is_rough(trial));
        const WrField *exact = wr_edit_preview_field(trial);
        const double change = mean_difference(before, exact);
        assert_true(change > 0.0);
        if (!(mean_difference(rough, exact) < 0.2 * change))
            fail_msg("%s: %g, of a change of %g", changes[i].line, mean_difference(rough, exact),
                     change);
        if (wr_session_run(session, changes[i].line, &err))
            assert_same_heights(exact, wr_document_field(wr_session_document(session)));
        else assert_int_equal(i, 3); /* filters are changed by another command */
        wr_field_free(before);
        wr_field_free(rough);
        wr_edit_preview_free(trial);
        wr_session_free(session);
    }
}

static void rough_changes_of_layers_are_near(void **state)
{
    (void)state;
    rough_changes(false);
}

static void rough_changes_in_groups_are_near(void **state)
{
    (void)state;
    rough_changes(true);
}

static void a_line_that_is_wrong_is_said_to_be(void **state)
{
    (void)state;
    static const struct {
        const char *line, *says;
    } wrong[] = { { "pattern bricks across=0", "across" },
                  { "pattern brocks", "bricks" },
                  { "dab 0.5,0.5", "generator" },
                  { "", "generator" } };
    WrSession *session = session_of(painted, 5);
    WrEditPreview *trial = wr_edit_preview_new(1, SDL_USEREVENT);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        WrError err = { "" };
        wr_edit_preview_request(trial, wr_session_document(session),
                                &(WrEditPreviewRequest){ .line = wrong[i].line });
        wait_until_done(trial);
        assert_null(wr_edit_preview_field(trial));
        assert_true(wr_edit_preview_error(trial, &err));
        if (!strstr(err.text, wrong[i].says)) fail_msg("%s: %s", wrong[i].line, err.text);
    }
    wr_edit_preview_free(trial);
    wr_session_free(session);
}

static void a_trial_that_fails_says_why_once(void **state)
{
    (void)state;
    WrError err = { "" };
    WrSession *session = session_of(painted, 5);
    WrEditPreview *trial = wr_edit_preview_new(1, SDL_USEREVENT);
    wr_edit_preview_request(trial, wr_session_document(session),
                            &(WrEditPreviewRequest){ .op = wr_op_find("blur"), .param = { -1 } });
    wait_until_done(trial);
    assert_null(wr_edit_preview_field(trial));
    assert_true(wr_edit_preview_error(trial, &err));
    assert_non_null(strstr(err.text, "sigma"));
    assert_false(wr_edit_preview_error(trial, &err));
    wr_edit_preview_free(trial);
    wr_session_free(session);
}

/* ---- outlines ---- */

static const WrOutline *outline_of(WrOutliner *outliner, const WrSession *session,
                                   const WrOutlineRequest *ask)
{
    uint64_t serial;
    wr_outliner_request(outliner, wr_session_document(session), ask);
    double began = wr_clock_seconds();
    while (wr_outliner_busy(outliner, NULL, NULL) && wr_clock_seconds() - began < 20) usleep(500);
    return wr_outliner_get(outliner, &serial);
}

/* The largest width of an outline in u. */
static double width_of(const WrOutline *outline)
{
    double low = 1e9, high = -1e9;
    for (int i = 0; i < outline->point_count; i++) {
        low = fmin(low, outline->points[i].u);
        high = fmax(high, outline->points[i].u);
    }
    return high - low;
}

static void outlines_show_what_a_selection_would_become(void **state)
{
    (void)state;
    WrSession *session = session_of(painted, 5);
    WrOutliner *outliner = wr_outliner_new(1, SDL_USEREVENT);
    const WrOutline *now = outline_of(outliner, session, &(WrOutlineRequest){ 0 });
    assert_non_null(now);
    assert_near(width_of(now), 0.9, 1.5 / 256); /* 0.3 to 1.2, across the edge */
    const WrOutline *grown =
        outline_of(outliner, session, &(WrOutlineRequest){ .kind = WR_OUTLINE_GROW, .by = 5 });
    assert_non_null(grown);
    assert_near(width_of(grown), 0.9 + 10.0 / 256, 1.5 / 256);
    const WrOutline *shrunk =
        outline_of(outliner, session, &(WrOutlineRequest){ .kind = WR_OUTLINE_SHRINK, .by = 5 });
    assert_non_null(shrunk);
    assert_near(width_of(shrunk), 0.9 - 10.0 / 256, 1.5 / 256);
    uint64_t serial;
    wr_outliner_clear(outliner);
    assert_null(wr_outliner_get(outliner, &serial));
    wr_outliner_free(outliner);
    wr_session_free(session);
}

static void without_a_selection_there_is_no_outline(void **state)
{
    (void)state;
    WrSession *session = session_of(painted, 4);
    WrOutliner *outliner = wr_outliner_new(1, SDL_USEREVENT);
    assert_null(
        outline_of(outliner, session, &(WrOutlineRequest){ .kind = WR_OUTLINE_GROW, .by = 5 }));
    /* by height there is one: around the strokes and the grid's lines */
    assert_non_null(
        outline_of(outliner, session,
                   &(WrOutlineRequest){ .kind = WR_OUTLINE_HEIGHT, .low = 0.5, .high = 10 }));
    wr_outliner_free(outliner);
    wr_session_free(session);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_operation_that_is_tried_comes_out_as_its_command),
        cmocka_unit_test(a_command_that_is_tried_comes_out_as_it_runs),
        cmocka_unit_test(an_offset_that_is_tried_moves_what_layers_say_too),
        cmocka_unit_test(a_layers_settings_that_are_tried_come_out_as_their_command),
        cmocka_unit_test(a_generator_that_is_tried_comes_out_as_its_command),
        cmocka_unit_test(what_a_generator_notes_is_told_with_what_it_shows),
        cmocka_unit_test(a_rough_trial_is_near_and_then_the_exact_one_comes),
        cmocka_unit_test(rough_changes_of_layers_are_near),
        cmocka_unit_test(rough_changes_in_groups_are_near),
        cmocka_unit_test(a_line_that_is_wrong_is_said_to_be),
        cmocka_unit_test(a_trial_that_fails_says_why_once),
        cmocka_unit_test(outlines_show_what_a_selection_would_become),
        cmocka_unit_test(without_a_selection_there_is_no_outline),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

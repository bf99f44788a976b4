/* The tour of the cost of accuracy: each step has its picture of the patch; the document never changes, and the comparison
   of before comes back. */
#include "test.h"

#include "app.h"

#include "ui/panels/accuracy/accuracy.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui_rows.h"

#include <string.h>

static void click(Bench *bench, const char *label)
{
    WrApp *app = bench->app;
    float place[4] = { 0 };
    wr_gui_light_row(app->gui, "", label);
    for (int i = 0; i < 8; i++) draw_again(app); /* the tab opens and scrolls */
    if (!wr_gui_lit_row(app->gui, place)) fail_msg("no button '%s'", label);
    const int x = (int)(place[0] + 0.5F * place[2]), y = (int)(place[1] + 0.5F * place[3]);
    for (int i = 0; i < 2; i++) {
        push_motion(app, x, y);
        draw_again(app);
        push_button(app, i == 0, SDL_BUTTON_LEFT, x, y);
        draw_again(app);
    }
    settle(bench);
}

static void every_step_has_its_picture_and_the_end_restores_the_comparison(void **state)
{
    static const WrPatchLook looks[] = { WR_PATCH_PLAIN, WR_PATCH_ERROR, WR_PATCH_RAN,
                                         WR_PATCH_SPLIT, WR_PATCH_SPLIT, WR_PATCH_DROPPED,
                                         WR_PATCH_SPLIT, WR_PATCH_LACKS, WR_PATCH_PLAIN };
    const int count = (int)(sizeof looks / sizeof *looks);
    Bench bench;
    (void)state;
    begin(&bench);
    WrApp *app = bench.app;
    WrAccuracy *a = app->accuracy;
    for (int d = 0; d < WR_DIAL_COUNT; d++) wr_accuracy_dial(app, 1, d);
    wr_accuracy_set_dial(app, 1, WR_DIAL_SAMPLES, 3);
    wr_accuracy_set_view(app, WR_PATCH_FLICKER);
    double b[WR_DIAL_COUNT];
    memcpy(b, a->b, sizeof b);
    const uint64_t revision = wr_session_revision(bench.session);
    wr_action_run(app, "study");
    settle(&bench);
    for (int i = 0; i < count; i++) {
        assert_int_equal(a->study.step, i + 1);
        assert_int_equal(a->look, looks[i]);
        if (i + 1 < count) click(&bench, "Next");
    }
    click(&bench, "Back");
    assert_int_equal(a->study.step, count - 1);
    wr_accuracy_set_dial(app, 1, WR_DIAL_SAMPLES, 7); /* as a step does */
    click(&bench, "End the tour");
    assert_int_equal(a->study.step, 0);
    assert_int_equal(a->look, WR_PATCH_FLICKER);
    assert_memory_equal(a->b, b, sizeof b);
    assert_true(wr_session_revision(bench.session) == revision);
    finish(&bench);
}

static void a_measurement_ends_with_its_tab(void **state)
{
    Bench bench;
    (void)state;
    begin(&bench);
    WrApp *app = bench.app;
    app->settings->turning = false;
    wr_action_run(app, "accuracy");
    const double late = wr_clock_seconds() + 300;
    wr_action_run(app, "accuracy_measure");
    while (!app->accuracy->measuring && wr_clock_seconds() < late) draw_again(app);
    assert_true(app->accuracy->measuring);
    wr_action_run(app, "brushes");
    for (int i = 0; i < 3; i++) draw_again(app);
    assert_false(app->accuracy->measuring);
    for (int i = 0; i < 3; i++) draw_again(app);
    assert_false(app->accuracy->measuring);
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_measurement_ends_with_its_tab),
        cmocka_unit_test(every_step_has_its_picture_and_the_end_restores_the_comparison),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

/* Seam meter of the window: it shows the newest table, the canvas's tiling and formulas, and no frame measures a table. */
#include "test.h"
#include "app.h"

#include "field/seam_check.h"

#include "ui/app/state/layout.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/overlays/panel_seam.h"

/* True once the meter shows these orders; a wrong one never becomes right. */
static bool shows(Bench *bench, int u, int v)
{
    const double end = wr_clock_seconds() + PATIENCE;
    while (wr_clock_seconds() < end) {
        draw_again(bench->app);
        const WrCertificate *now = wr_seam_meter_certificate(bench->app);
        if (now && now->pattern.u.order == u && now->pattern.v.order == v) return true;
    }
    return false;
}

static void run(Bench *bench, const char *line)
{
    WrError err = { "" };
    if (!wr_session_run(bench->session, line, &err)) fail_msg("%s: %s", line, err.text);
}

static void the_meter_shows_the_newest_table(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    run(&bench, "pattern bricks");
    assert_true(shows(&bench, 2, 2));
    run(&bench, "ramp linear from=0,0 to=1,0 high=0.7");
    assert_true(shows(&bench, -1, 2));
    /* Shifted by half its width at the upper edge, the ramp does not fit there either. */
    bench.app->settings->tiling = WR_TILING_BRICK;
    assert_true(shows(&bench, -1, -1));
    bench.app->settings->tiling = WR_TILING_STRAIGHT;
    assert_true(shows(&bench, -1, 2));
    run(&bench, "undo");
    assert_true(shows(&bench, 2, 2));
    run(&bench, "analytic poly c=1,0,0.3"); /* F = 0.3 u jumps at the edge */
    assert_true(shows(&bench, -1, 2));
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_meter_shows_the_newest_table),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

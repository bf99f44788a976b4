/* Fingers in a window without a display: strokes, two-finger gestures on the canvas and the patch, taps. */
#include "test.h"

#include "app.h"

#include "document/document.h"
#include "scene/scene.h"

#include "ui/app/state/layout.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/session_view.h"
#include "ui/canvas/view.h"
#include "ui/input/pen.h"
#include "ui/patch/patch.h"

#include <math.h>

static void finger(const WrApp *app, Uint32 type, int id, double x, double y)
{
    int w, h;
    SDL_GetWindowSize(app->window, &w, &h);
    SDL_PushEvent(&(SDL_Event){ .tfinger = { .type = type,
                                             .timestamp = SDL_GetTicks(),
                                             .touchId = 77,
                                             .fingerId = id,
                                             .x = (float)(x / w),
                                             .y = (float)(y / h),
                                             .pressure = 1.0f,
                                             .windowID = SDL_GetWindowID(app->window) } });
}

/* SDL's mouse event for the first finger. */
static void echo(const WrApp *app, bool down, double x, double y)
{
    SDL_PushEvent(&(SDL_Event){ .button = { .type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                            .windowID = SDL_GetWindowID(app->window),
                                            .which = SDL_TOUCH_MOUSEID,
                                            .button = SDL_BUTTON_LEFT,
                                            .state = down ? SDL_PRESSED : SDL_RELEASED,
                                            .clicks = 1,
                                            .x = (int)x,
                                            .y = (int)y } });
}

static void middle(const SDL_Rect *r, double *x, double *y)
{
    *x = r->x + r->w / 2.0;
    *y = r->y + r->h / 2.0;
}

static void stroke(Bench *bench, double x, double y)
{
    WrApp *app = bench->app;
    finger(app, SDL_FINGERDOWN, 1, x, y);
    echo(app, true, x, y);
    for (int i = 1; i <= 6; i++) {
        finger(app, SDL_FINGERMOTION, 1, x + 9 * i, y);
        draw_again(app);
    }
    finger(app, SDL_FINGERUP, 1, x + 54, y);
    echo(app, false, x + 54, y);
    settle(bench);
}

static void tap(Bench *bench, int fingers, double x, double y)
{
    Uint32 from;
    do { /* held up by a busy machine, it would be no tap */
        from = SDL_GetTicks();
        for (int i = 0; i < fingers; i++) finger(bench->app, SDL_FINGERDOWN, i, x + 40 * i, y);
        for (int i = 0; i < fingers; i++) finger(bench->app, SDL_FINGERUP, i, x + 40 * i, y);
    } while (SDL_GetTicks() - from > 300);
    settle(bench);
}

static int position(const Bench *bench)
{
    return wr_session_history_position(bench->session);
}

static void a_finger_paints_once_and_taps_undo_and_redo(void **state)
{
    (void)state;
    Bench bench;
    double x, y;
    begin(&bench);
    const int before = position(&bench);
    middle(&bench.app->layout->canvas, &x, &y);
    stroke(&bench, x - 30, y - 20);
    assert_int_equal(position(&bench), before + 1);
    assert_int_equal(strncmp(wr_session_last_command(bench.session), "stroke", 6), 0);
    tap(&bench, 2, x, y);
    assert_int_equal(position(&bench), before);
    tap(&bench, 3, x, y);
    assert_int_equal(position(&bench), before + 1);
    tap(&bench, 2, x, bench.app->height - 4); /* on the status line it is no undo */
    tap(&bench, 4, x, y);
    assert_int_equal(position(&bench), before + 1);
    finish(&bench);
}

/* Two fingers that move apart by 2 and turn by 90 degrees, the second later than a stroke's first motion. */
static void two_fingers_move_the_canvas_and_paint_nothing(void **state)
{
    (void)state;
    Bench bench;
    double x, y, at_x, at_y, px, py;
    begin(&bench);
    WrApp *app = bench.app;
    const int before = position(&bench);
    const uint64_t revision = wr_session_revision(bench.session);
    middle(&app->layout->canvas, &x, &y);
    const Uint32 from = SDL_GetTicks();
    finger(app, SDL_FINGERDOWN, 1, x, y);
    finger(app, SDL_FINGERMOTION, 1, x + 12, y);
    finger(app, SDL_FINGERDOWN, 2, x + 72, y);
    if (SDL_GetTicks() - from > 300) { /* a busy machine: the stroke is too old */
        finish(&bench);
        skip();
    }
    draw_again(app);
    assert_int_equal(app->brush->strokes, 1);
    assert_int_equal(app->hand->grab, WR_GRAB_NONE);
    finger(app, SDL_FINGERMOTION, 1, x,
           y); /* past the threshold, and turned by more than 10 degrees */
    finger(app, SDL_FINGERMOTION, 2, x + 60, y + 40);
    finger(app, SDL_FINGERMOTION, 2, x + 60, y + 41);
    draw_again(app);
    const double zoom = app->view->zoom, turn = app->view->turn;
    const double was = atan2(41, 60) * 180 / M_PI, length = hypot(60, 41);
    wr_view_to_texel(app->view, x, y, &at_x, &at_y);
    finger(app, SDL_FINGERMOTION, 2, x - 41 * 2, y + 60 * 2);
    draw_again(app);
    assert_near(app->view->zoom / zoom, 2.0, 1e-5);
    assert_near(app->view->turn - turn, 90.0, 1e-3);
    wr_view_to_pixel(app->view, at_x, at_y, &px, &py); /* the other finger is on its texel */
    assert_near(hypot(px - x, py - y), 0.0, 0.01);
    assert_true(was > 10 && length > 20);
    finger(app, SDL_FINGERUP, 1, x, y);
    finger(app, SDL_FINGERUP, 2, x, y);
    settle(&bench);
    assert_int_equal(position(&bench), before);
    assert_true(wr_session_revision(bench.session) == revision);
    finish(&bench);
}

/* On the patch they move the camera, which becomes a command. */
static void two_fingers_move_the_camera(void **state)
{
    (void)state;
    Bench bench;
    double x, y;
    WrPlacement near, far;
    begin(&bench);
    WrApp *app = bench.app;
    settle(&bench);
    const int before = position(&bench);
    middle(&app->layout->patch, &x, &y);
    assert_true(wr_patch_place(app, &far));
    const WrVec3 target = wr_app_scene(app)->camera.target;
    finger(app, SDL_FINGERDOWN, 1, x - 20, y);
    finger(app, SDL_FINGERDOWN, 2, x + 20, y);
    for (int i = 1; i <= 20; i++) {
        finger(app, SDL_FINGERMOTION, 1, x - 20 - i, y + i);
        finger(app, SDL_FINGERMOTION, 2, x + 20 + i, y + i);
        draw_again(app);
    }
    finger(app, SDL_FINGERUP, 1, x - 40, y + 20);
    finger(app, SDL_FINGERUP, 2, x + 40, y + 20);
    const double end = wr_clock_seconds() + PATIENCE;
    while (app->live && wr_clock_seconds() < end) wr_app_step(app);
    settle(&bench);
    assert_int_equal(position(&bench), before); /* views are no steps */
    assert_true(wr_patch_place(app, &near));
    const WrCamera *camera = &wr_app_scene(app)->camera;
    const double away = v3_len(v3_sub(far.eye, target));
    assert_true(v3_len(v3_sub(near.eye, camera->target)) < 0.8 * away);
    assert_true(v3_dot(v3_sub(camera->target, target), near.up) > 0.0); /* the picture moved down */
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_finger_paints_once_and_taps_undo_and_redo),
        cmocka_unit_test(two_fingers_move_the_canvas_and_paint_nothing),
        cmocka_unit_test(two_fingers_move_the_camera),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

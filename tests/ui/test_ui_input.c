/* Input at slow frames: events are handled in order of arrival, keys go to the widget focused by the
   click before them, and a click belongs to the frame on the screen at its time. */
#include "test.h"
#include "app.h"

#include "ui/app/state/action.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/view.h"
#include "ui/toolkit/focus.h"
#include "ui/toolkit/gui.h"
#include "ui/canvas/tools/tool_stamp.h"

#include "document/document.h"
#include "system/thread.h"

#include <math.h>
#include <string.h>

#define PICTURE_MS 60
#define GAP_MS 22 /* between events: several of them arrive within a frame */
#define MAX_MOST 64

static void slow(WrApp *app)
{
    (void)app;
    SDL_Delay(PICTURE_MS);
}

/* ---- events, pushed by a thread of their own while the window draws ---- */

typedef struct Feed {
    SDL_Event events[MAX_MOST];
    int gap[MAX_MOST]; /* ms after it */
    int count;
    Uint32 end; /* event type that marks the end */
    volatile int done;
} Feed;

static void add(Feed *feed, const SDL_Event *event, int gap)
{
    assert_true(feed->count < MAX_MOST);
    feed->gap[feed->count] = gap;
    feed->events[feed->count++] = *event;
}

static void add_click(const WrApp *app, Feed *feed, int x, int y, int gap)
{
    const Uint32 id = SDL_GetWindowID(app->window);
    add(feed, &(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .windowID = id, .x = x, .y = y } },
        0);
    for (int down = 1; down >= 0; down--)
        add(feed,
            &(SDL_Event){ .button = { .type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                      .windowID = id,
                                      .button = SDL_BUTTON_LEFT,
                                      .state = down ? SDL_PRESSED : SDL_RELEASED,
                                      .clicks = 1,
                                      .x = x,
                                      .y = y } },
            down ? 0 : gap);
}

/* letter: resulting text, 0: none. */
static void add_key(Feed *feed, SDL_Scancode code, Uint16 mod, char letter, int gap)
{
    const SDL_Keysym key = { .scancode = code, .sym = SDL_GetKeyFromScancode(code), .mod = mod };
    add(feed, &(SDL_Event){ .key = { .type = SDL_KEYDOWN, .keysym = key } }, 0);
    if (letter) {
        SDL_Event text = { .text = { .type = SDL_TEXTINPUT } };
        text.text.text[0] = letter;
        add(feed, &text, 0);
    }
    add(feed, &(SDL_Event){ .key = { .type = SDL_KEYUP, .keysym = key } }, gap);
}

static void *push_all(void *ctx)
{
    Feed *feed = ctx;
    for (int i = 0; i < feed->count; i++) {
        SDL_PushEvent(&feed->events[i]);
        if (feed->gap[i] > 0) SDL_Delay((Uint32)feed->gap[i]);
    }
    __atomic_store_n(&feed->done, 1, __ATOMIC_RELEASE);
    SDL_PushEvent(&(SDL_Event){ .type = feed->end });
    return NULL;
}

/* Run until all events are handled, and eight frames more. */
static void run(WrApp *app, Feed *feed)
{
    WrThread thread;
    feed->end = app->ready_event;
    app->drawn = slow;
    draw_again(app); /* events arrive during frames */
    assert_true(wr_thread_begin(&thread, push_all, feed));
    while (!__atomic_load_n(&feed->done, __ATOMIC_ACQUIRE)) draw_again(app);
    wr_thread_join(thread);
    for (int i = 0; i < 12; i++) draw_again(app);
    app->drawn = NULL;
}

/* ---- places ---- */

/* Centre of the n-th stop of a kind inside `inside`. */
static bool find(const WrApp *app, WrKeyStopKind kind, const SDL_Rect *inside, int n, int *x,
                 int *y)
{
    int count;
    const WrKeyStop *stops = wr_gui_stops(app->gui, &count);
    for (int i = 0; i < count; i++) {
        const int mx = (int)(stops[i].x0 + stops[i].x1) / 2;
        const int my = (int)(stops[i].y0 + stops[i].y1) / 2;
        if (stops[i].kind != kind || !wr_layout_inside(inside, mx, my) || n-- > 0) continue;
        *x = mx, *y = my;
        return true;
    }
    return false;
}

static const SDL_Rect all_of_it = { 0, 0, 900, 700 };

/* ---- tests ---- */

/* The first number field of the option row is the brush's size; it must have the focus when the keys arrive. */
static void keys_after_a_click_on_a_number_go_into_it(void **state)
{
    (void)state;
    Bench bench;
    Feed feed = { .count = 0 };
    int x, y;
    begin(&bench);
    WrApp *app = bench.app;
    assert_true(find(app, WR_STOP_NUMBER, &all_of_it, 0, &x, &y));
    const double turn = app->view->turn;
    const int tool = app->tool;
    add_click(app, &feed, x, y, GAP_MS);
    add_key(&feed, SDL_SCANCODE_6, 0, '6', GAP_MS);
    add_key(&feed, SDL_SCANCODE_RETURN, 0, 0, GAP_MS);
    run(app, &feed);
    assert_float_equal(app->settings->brush.radius, 3.0, 1e-9); /* size 6 */
    assert_float_equal(app->view->turn, turn, 0.0);
    assert_int_equal(app->tool, tool);
    assert_false(wr_gui_wants_text(app->gui));
    finish(&bench);
}

static void add_ctrl(Feed *feed, Uint32 type, Uint16 mod)
{
    const SDL_Keysym key = { .scancode = SDL_SCANCODE_LCTRL, .sym = SDLK_LCTRL, .mod = mod };
    add(feed, &(SDL_Event){ .key = { .type = type, .keysym = key } }, GAP_MS);
}

/* A click types, and Ctrl+click restores the default without opening the field. */
static void ctrl_click_resets_a_number(void **state)
{
    (void)state;
    Bench bench;
    Feed feed = { .count = 0 };
    int x, y;
    begin(&bench);
    WrApp *app = bench.app;
    assert_true(find(app, WR_STOP_NUMBER, &all_of_it, 0, &x, &y));
    add_click(app, &feed, x, y, GAP_MS);
    add_key(&feed, SDL_SCANCODE_6, 0, '6', GAP_MS);
    add_key(&feed, SDL_SCANCODE_RETURN, 0, 0, GAP_MS);
    run(app, &feed);
    assert_float_equal(app->settings->brush.radius, 3.0, 1e-9);
    feed.count = 0;
    feed.done = 0;
    add_ctrl(&feed, SDL_KEYDOWN, KMOD_LCTRL);
    add_click(app, &feed, x, y, GAP_MS);
    add_ctrl(&feed, SDL_KEYUP, 0);
    run(app, &feed);
    assert_float_equal(app->settings->brush.radius, 16.0, 1e-9); /* size 32, the default */
    assert_false(wr_gui_wants_text(app->gui));
    finish(&bench);
}

/* Two action keys after the number belong to the canvas again. */
static void keys_after_enter_are_the_canvas_s(void **state)
{
    (void)state;
    Bench bench;
    Feed feed = { .count = 0 };
    int x, y;
    begin(&bench);
    WrApp *app = bench.app;
    assert_true(find(app, WR_STOP_NUMBER, &all_of_it, 0, &x, &y));
    add_click(app, &feed, x, y, GAP_MS);
    add_key(&feed, SDL_SCANCODE_8, 0, '8', 0);
    add_key(&feed, SDL_SCANCODE_RETURN, 0, 0, 0);
    add_key(&feed, SDL_SCANCODE_N, KMOD_LCTRL, 0, GAP_MS);
    run(app, &feed);
    assert_float_equal(app->settings->brush.radius, 4.0, 1e-9);
    assert_int_equal(app->dialog->now, WR_DIALOG_NEW);
    finish(&bench);
}

/* Typing ahead: a key opens the search, the text goes to it, and Enter runs the result. */
static void what_is_typed_after_a_key_that_opens_a_dialog_goes_to_it(void **state)
{
    (void)state;
    Bench bench;
    Feed feed = { .count = 0 };
    begin(&bench);
    const int layers = wr_session_document(bench.session)->layer_count;
    add_key(&feed, SDL_SCANCODE_RETURN, KMOD_LCTRL, 0, GAP_MS);
    for (const char *at = "duplicate"; *at; at++)
        add_key(&feed, (SDL_Scancode)(SDL_SCANCODE_A + (*at - 'a')), 0, *at, 20);
    add_key(&feed, SDL_SCANCODE_RETURN, 0, 0, GAP_MS);
    run(bench.app, &feed);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_NONE);
    assert_int_equal(wr_session_document(bench.session)->layer_count, layers + 1);
    finish(&bench);
}

/* The second click came while the screen showed the canvas, before the dialog appeared: it must not press a button of
   the dialog, and must not paint either. */
static void a_click_is_for_what_was_on_the_screen(void **state)
{
    (void)state;
    Bench bench;
    Feed feed = { .count = 0 };
    int x, y;
    begin(&bench);
    WrApp *app = bench.app;
    wr_dialog_open(app, WR_DIALOG_NEW); /* position of its last button */
    for (int i = 0; i < 30; i++) draw_again(app);
    SDL_Rect canvas = app->layout->canvas;
    int count = 0;
    while (find(app, WR_STOP_PRESS, &all_of_it, count, &x, &y)) count++;
    int bx = 0, by = 0;
    for (int i = 0; i < count; i++) {
        find(app, WR_STOP_PRESS, &all_of_it, i, &x, &y);
        if (wr_layout_inside(&canvas, x, y)) bx = x, by = y;
    }
    assert_true(bx > 0);
    wr_dialog_close(app);
    for (int i = 0; i < 30; i++) draw_again(app);
    const uint64_t before = wr_session_revision(bench.session);
    add_key(&feed, SDL_SCANCODE_N, KMOD_LCTRL, 0, 10);
    add_click(app, &feed, bx, by, GAP_MS);
    run(app, &feed);
    assert_int_equal(app->dialog->now, WR_DIALOG_NEW);
    assert_true(wr_session_revision(bench.session) == before);
    finish(&bench);
}

/* A stroke right after a click on the panels is one stroke with all its motions. */
static void a_stroke_after_a_click_is_whole(void **state)
{
    (void)state;
    Bench bench;
    Feed feed = { .count = 0 };
    int x, y;
    begin(&bench);
    WrApp *app = bench.app;
    assert_true(find(app, WR_STOP_TAB, &all_of_it, 0, &x, &y));
    const SDL_Rect c = app->layout->canvas;
    const int cx = c.x + c.w / 2, cy = c.y + c.h / 2;
    const int64_t revision = (int64_t)wr_session_revision(bench.session);
    add_click(app, &feed, x, y, 5);
    const Uint32 id = SDL_GetWindowID(app->window);
    SDL_Event at = { .motion = { .type = SDL_MOUSEMOTION, .windowID = id, .x = cx, .y = cy } };
    add(&feed, &at, 0);
    SDL_Event button = { .button = { .type = SDL_MOUSEBUTTONDOWN,
                                     .windowID = id,
                                     .button = SDL_BUTTON_LEFT,
                                     .state = SDL_PRESSED,
                                     .x = cx,
                                     .y = cy } };
    add(&feed, &button, 5);
    for (int i = 1; i <= 10; i++) {
        at.motion.x = cx + 4 * i;
        add(&feed, &at, 5);
    }
    button.button.type = SDL_MOUSEBUTTONUP;
    button.button.state = SDL_RELEASED;
    button.button.x = cx + 40;
    add(&feed, &button, GAP_MS);
    run(app, &feed);
    assert_true((int64_t)wr_session_revision(bench.session) == revision + 1);
    assert_int_equal(app->hand->grab, WR_GRAB_NONE);
    finish(&bench);
}

/* Modifier keys are those at the event, not at its handling: Ctrl+wheel zooms, the wheel alone resizes the stamp. */
static void a_turn_of_the_wheel_has_the_keys_held_when_it_came(void **state)
{
    (void)state;
    Bench bench;
    Feed feed = { .count = 0 };
    begin(&bench);
    WrApp *app = bench.app;
    wr_action_run(app, "stamp");
    for (int i = 0; i < 4; i++) draw_again(app);
    app->stamp->radius = 20;
    const double zoom = app->view->zoom;
    const SDL_Rect c = app->layout->canvas;
    const Uint32 id = SDL_GetWindowID(app->window);
    SDL_Keysym ctrl = { .scancode = SDL_SCANCODE_LCTRL, .sym = SDLK_LCTRL, .mod = KMOD_LCTRL };
    const SDL_Event turned = {
        .wheel = { .type = SDL_MOUSEWHEEL, .windowID = id, .y = 1, .preciseY = 1 }
    };
    add(&feed,
        &(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION,
                                  .windowID = id,
                                  .x = c.x + c.w / 2,
                                  .y = c.y + c.h / 2 } },
        0);
    add(&feed, &(SDL_Event){ .key = { .type = SDL_KEYDOWN, .keysym = ctrl } }, 0);
    add(&feed, &turned, 0);
    ctrl.mod = KMOD_NONE;
    add(&feed, &(SDL_Event){ .key = { .type = SDL_KEYUP, .keysym = ctrl } }, 0);
    add(&feed, &turned, GAP_MS);
    run(app, &feed);
    assert_float_equal(app->view->zoom, zoom * exp2(1.0 / 3.0), 1e-6 * zoom);
    assert_float_equal(app->stamp->radius, rint(20 * exp2(1.0 / 6.0)), 0); /* once */
    finish(&bench);
}

/* The chip's text changes with the first click, before the frame that shows it. */
static void a_second_click_on_a_button_whose_word_changes_counts(void **state)
{
    (void)state;
    Bench bench;
    Feed feed = { .count = 0 };
    begin(&bench);
    WrApp *app = bench.app;
    const SDL_Rect patch = app->layout->patch;
    int x, y, n = 0;
    for (int i = 0; i < 4; i++) draw_again(app); /* the chip's layout is measured */
    bool was = app->settings->turning, found = false;
    while (!found && find(app, WR_STOP_PRESS, &patch, n++, &x, &y)) {
        push_motion(app, x, y);
        draw_again(app);
        push_button(app, true, SDL_BUTTON_LEFT, x, y);
        push_button(app, false, SDL_BUTTON_LEFT, x, y);
        for (int i = 0; i < 6; i++) draw_again(app);
        found = app->settings->turning != was;
    }
    assert_true(found);
    was = app->settings->turning;
    for (int i = 0; i < 3; i++) add_click(app, &feed, x, y, i < 2 ? 10 : GAP_MS);
    run(app, &feed);
    assert_true(app->settings->turning != was); /* three times */
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_after_a_click_on_a_number_go_into_it),
        cmocka_unit_test(ctrl_click_resets_a_number),
        cmocka_unit_test(keys_after_enter_are_the_canvas_s),
        cmocka_unit_test(what_is_typed_after_a_key_that_opens_a_dialog_goes_to_it),
        cmocka_unit_test(a_click_is_for_what_was_on_the_screen),
        cmocka_unit_test(a_stroke_after_a_click_is_whole),
        cmocka_unit_test(a_turn_of_the_wheel_has_the_keys_held_when_it_came),
        cmocka_unit_test(a_second_click_on_a_button_whose_word_changes_counts),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

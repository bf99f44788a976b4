/* The History tab in a window without a display: clicks, double clicks, the eyes and drags of its rows, and the dialogs of a
   step and of a macro. */
#include "test.h"
#include "test_folder.h"

#include "app.h"

#include "base/error.h"
#include "base/file.h"
#include "command/command_line.h"
#include "document/document.h"

#include "ui/app/state/action.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/panels/panel_history.h"
#include "ui/toolkit/focus.h"
#include "ui/toolkit/gui.h"

#include <string.h>

static const char *const lines[] = { "pattern bricks across=3", "layer add a", "fill 0.25",
                                     "bump height=0.3" };

static void open_history(Bench *bench)
{
    WrError err;
    begin(bench);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        if (!wr_session_run(bench->session, lines[i], &err)) fail_msg("%s", err.text);
    wr_tab_show(bench->app, "History");
    bench->app->settings->lower = 0; /* the layers have rows too */
    settle(bench);
}

/* The row of the state after `position` steps; the newest is on top. */
static WrKeyStop row(const Bench *bench, int position)
{
    int count, n = wr_session_history_count(bench->session) - position;
    const WrKeyStop *stops = wr_gui_stops(bench->app->gui, &count);
    for (int i = 0; i < count; i++)
        if (stops[i].kind == WR_STOP_ROW && n-- == 0) return stops[i];
    fail_msg("the row is missing");
    return (WrKeyStop){ 0 };
}

static int middle(const Bench *bench, int position)
{
    const WrKeyStop stop = row(bench, position);
    return (int)(0.5f * (stop.y0 + stop.y1));
}

static void button(Bench *bench, bool down, Uint8 which, Uint8 clicks, int x, int y)
{
    push_motion(bench->app, x, y);
    draw_again(bench->app);
    SDL_PushEvent(&(SDL_Event){ .button = { .type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                            .windowID = SDL_GetWindowID(bench->app->window),
                                            .button = which,
                                            .state = down ? SDL_PRESSED : SDL_RELEASED,
                                            .clicks = clicks,
                                            .x = x,
                                            .y = y } });
    draw_again(bench->app);
}

static void click(Bench *bench, Uint8 which, Uint8 clicks, int x, int y)
{
    button(bench, true, which, clicks, x, y);
    button(bench, false, which, clicks, x, y);
    settle(bench);
}

static void click_row(Bench *bench, int position, Uint8 clicks)
{
    click(bench, SDL_BUTTON_LEFT, clicks, (int)row(bench, position).x0 + wr_gui_px(90),
          middle(bench, position));
}

static void double_click(Bench *bench, int position)
{
    click_row(bench, position, 1);
    click_row(bench, position, 2);
}

static void tap(Bench *bench, SDL_Scancode code)
{
    for (int down = 1; down >= 0; down--)
        SDL_PushEvent(&(SDL_Event){
            .key = { .type = down ? SDL_KEYDOWN : SDL_KEYUP,
                     .windowID = SDL_GetWindowID(bench->app->window),
                     .keysym = { .scancode = code, .sym = SDL_GetKeyFromScancode(code) } } });
    settle(bench);
}

static int position(const Bench *bench)
{
    return wr_session_history_position(bench->session);
}

static void a_click_goes_and_a_double_click_changes(void **state)
{
    (void)state;
    WrError err;
    Bench bench;
    open_history(&bench);
    assert_int_equal(position(&bench), 5);
    click_row(&bench, 2, 1);
    assert_int_equal(position(&bench), 2);
    click_row(&bench, 5, 1);
    assert_int_equal(position(&bench), 5);
    double_click(&bench, 2);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_STEP);
    assert_int_equal(position(&bench), 5); /* where it was before the first of the two clicks */
    tap(&bench, SDL_SCANCODE_ESCAPE);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_NONE);
    assert_string_equal(wr_session_history_line(bench.session, 1), lines[0]);
    double_click(&bench, 2);
    assert_true(wr_call_change(bench.app->history->call, "across=2", &err));
    tap(&bench, SDL_SCANCODE_RETURN);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_NONE);
    assert_string_equal(wr_session_history_line(bench.session, 1), "pattern bricks across=2");
    assert_int_equal(position(&bench), 5);
    wr_action_run(bench.app, "undo");
    settle(&bench);
    assert_string_equal(wr_session_history_line(bench.session, 1), lines[0]);
    finish(&bench);
}

static void eyes_and_drags(void **state)
{
    (void)state;
    Bench bench;
    open_history(&bench);
    const int eye = (int)row(&bench, 4).x1 - wr_gui_px(48);
    click(&bench, SDL_BUTTON_LEFT, 1, eye, middle(&bench, 4));
    assert_true(wr_session_history_is_off(bench.session, 3));
    assert_int_equal(position(&bench), 5);
    click(&bench, SDL_BUTTON_LEFT, 1, eye, middle(&bench, 4));
    assert_false(wr_session_history_is_off(bench.session, 3));

    const int x = (int)row(&bench, 5).x0 + wr_gui_px(120), from = middle(&bench, 5);
    const int to = middle(&bench, 3);
    button(&bench, true, SDL_BUTTON_LEFT, 1, x, from);
    for (int i = 1; i <= 6; i++) {
        push_motion(bench.app, x, from + (to - from) * i / 6);
        draw_again(bench.app);
    }
    button(&bench, false, SDL_BUTTON_LEFT, 1, x, to);
    settle(&bench);
    assert_string_equal(wr_session_history_line(bench.session, 2), lines[3]);
    assert_string_equal(wr_session_history_line(bench.session, 3), lines[1]);

    click(&bench, SDL_BUTTON_RIGHT, 1, x, middle(&bench, 3));
    assert_true(wr_gui_popup_open_now(bench.app->gui));
    tap(&bench, SDL_SCANCODE_ESCAPE);
    assert_false(wr_gui_popup_open_now(bench.app->gui));
    finish(&bench);
}

static void a_macro_runs_with_the_values_of_its_dialog(void **state)
{
    (void)state;
    static const char text[] = "fill 0.5\nadjust add amount=0.25\n";
    WrError err;
    Bench bench;
    open_history(&bench);
    assert_true(wr_file_write("m.wrinkle", text, strlen(text), &err));
    wr_macro_chosen(bench.app, "m.wrinkle");
    settle(&bench);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_MACRO);
    assert_int_equal(bench.app->history->lines.count, 2);
    assert_true(wr_call_change(bench.app->history->lines.data[1].now, "amount=1.5", &err));
    tap(&bench, SDL_SCANCODE_RETURN);
    assert_int_equal(position(&bench), 6);
    assert_non_null(strstr(wr_session_history_line(bench.session, 5), "values=\"2: amount=1.5\""));
    const WrDocument *document = wr_session_document(bench.session);
    assert_near(wr_field_get(document->layers[document->active].heights, 7, 11), 2.0, 1e-6);
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_click_goes_and_a_double_click_changes),
        cmocka_unit_test(eyes_and_drags),
        cmocka_unit_test(a_macro_runs_with_the_values_of_its_dialog),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

/* Commands of the guide's pages run where they stand: the pointer presses Run, the effect is shown, Return runs the line as
   one step and Escape does not. Without a display. */
#include "test.h"
#include "app.h"
#include "test_folder.h"

#include "base/file.h"
#include "base/text.h"
#include "document/document.h"
#include "scene/scene.h"

#include "ui/panels/help/guide.h"
#include "ui/app/state/dialog.h"
#include "ui/toolkit/focus.h"

#include <string.h>

#define TORUS "surface torus R=1 r=0.35"

static void press(WrApp *app, SDL_Scancode code)
{
    SDL_KeyboardEvent event = { .keysym = { .scancode = code,
                                            .sym = SDL_GetKeyFromScancode(code) } };
    event.type = SDL_KEYDOWN;
    SDL_PushEvent(&(SDL_Event){ .key = event });
    draw_again(app);
    event.type = SDL_KEYUP;
    SDL_PushEvent(&(SDL_Event){ .key = event });
    for (int i = 0; i < 3; i++) draw_again(app);
}

static void type(WrApp *app, const char *text)
{
    for (const char *at = text; *at; at++) {
        SDL_Event event = { .text = { .type = SDL_TEXTINPUT } };
        event.text.text[0] = *at;
        SDL_PushEvent(&event);
        draw_again(app);
    }
}

/* The page moves to the place that the search found, so the pointer goes where Run is at rest. */
static void click_run(WrApp *app, const char *line)
{
    int x = -1, y = -1, was_y = -2;
    const double end = wr_clock_seconds() + PATIENCE;
    while (y != was_y && wr_clock_seconds() < end) {
        was_y = y;
        for (int i = 0; i < 3; i++) draw_again(app);
        if (!wr_guide_run_place(app, line, &x, &y)) was_y = -2;
    }
    if (y != was_y) fail_msg("%s: no Run is seen", line);
    push_motion(app, x, y);
    draw_again(app);
    push_button(app, true, SDL_BUTTON_LEFT, x, y);
    draw_again(app);
    push_button(app, false, SDL_BUTTON_LEFT, x, y);
    while (!wr_guide_proposed(app) && wr_clock_seconds() < end) draw_again(app);
    assert_non_null(wr_guide_proposed(app));
    for (int i = 0; i < 3; i++) draw_again(app);
}

static void wait_for_step(WrApp *app, int steps)
{
    const double end = wr_clock_seconds() + PATIENCE;
    while ((app->busy || wr_session_history_position(app->session) != steps) &&
           wr_clock_seconds() < end)
        draw_again(app);
    assert_int_equal(wr_session_history_position(app->session), steps);
}

static void a_command_runs_as_one_step_once_its_effect_was_shown(void **state)
{
    (void)state;
    Bench bench;
    WrText effect = { 0 };
    begin(&bench);
    WrApp *app = bench.app;
    const int steps = wr_session_history_position(app->session);
    wr_dialog_open(app, WR_DIALOG_HELP);
    for (int i = 0; i < 3; i++) draw_again(app);
    type(app, TORUS);
    for (int i = 0; i < 3; i++) draw_again(app);
    assert_null(wr_guide_proposed(app));

    click_run(app, TORUS); /* shown, not run */
    assert_string_equal(wr_guide_proposed(app), TORUS);
    assert_int_equal(wr_session_history_position(app->session), steps);
    wr_guide_effect(app, TORUS, &effect);
    assert_non_null(strstr(wr_text_get(&effect), "Changes the scene"));
    press(app, SDL_SCANCODE_ESCAPE);
    assert_null(wr_guide_proposed(app));
    assert_int_equal(app->dialog->now, WR_DIALOG_HELP);
    assert_int_equal(wr_session_history_position(app->session), steps);

    click_run(app, TORUS);
    press(app, SDL_SCANCODE_RETURN);
    wait_for_step(app, steps + 1);
    assert_null(wr_guide_proposed(app));
    assert_int_equal(app->dialog->now, WR_DIALOG_HELP);
    assert_int_equal(wr_session_document(app->session)->scene->shape.kind, WR_SURFACE_torus);
    assert_string_equal(wr_session_last_command(app->session), TORUS);
    WrError err = { "" };
    assert_true(wr_session_run(app->session, "undo", &err));
    assert_int_equal(wr_session_document(app->session)->scene->shape.kind, WR_SURFACE_plane);
    wr_text_fini(&effect);
    finish(&bench);
}

/* True if the ring is around the word Run of the command. */
static bool is_on_run(const WrApp *app, const char *line)
{
    int count, x, y;
    const WrKeyStop *stops = wr_gui_stops(app->gui, &count);
    const unsigned now = wr_gui_focus_now(app->gui);
    if (!wr_guide_run_place(app, line, &x, &y)) return false;
    for (int i = 0; i < count; i++)
        if (stops[i].id == now && x >= stops[i].x0 && x <= stops[i].x1 && y >= stops[i].y0 &&
            y <= stops[i].y1)
            return true;
    return false;
}

static void tab_to(WrApp *app, const char *line)
{
    for (int i = 0; i < 400 && !is_on_run(app, line); i++) press(app, SDL_SCANCODE_TAB);
    assert_true(is_on_run(app, line));
}

static void keys_reach_and_run_a_command(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    WrApp *app = bench.app;
    const int steps = wr_session_history_position(app->session);
    wr_dialog_open(app, WR_DIALOG_HELP);
    for (int i = 0; i < 3; i++) draw_again(app);
    type(app, TORUS);
    for (int i = 0; i < 3; i++) draw_again(app);
    tab_to(app, TORUS);
    press(app, SDL_SCANCODE_RETURN); /* shown, not run */
    assert_string_equal(wr_guide_proposed(app), TORUS);
    assert_int_equal(wr_session_history_position(app->session), steps);
    press(app, SDL_SCANCODE_ESCAPE);
    assert_null(wr_guide_proposed(app));
    assert_int_equal(app->dialog->now, WR_DIALOG_HELP);
    tab_to(app, TORUS);
    press(app, SDL_SCANCODE_RETURN);
    press(app, SDL_SCANCODE_RETURN);
    wait_for_step(app, steps + 1);
    assert_string_equal(wr_session_last_command(app->session), TORUS);
    finish(&bench);
}

static void expect_effect(const WrApp *app, const char *line, const char *words)
{
    WrText effect = { 0 };
    wr_guide_effect(app, line, &effect);
    if (!strstr(wr_text_get(&effect), words)) fail_msg("%s: %s", line, wr_text_get(&effect));
    wr_text_fini(&effect);
}

static void what_a_command_would_change_is_said_of_each_class(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    const WrApp *app = bench.app;
    expect_effect(app, "fill 0.5", "the active layer is base");
    expect_effect(app, "material gate=off", "Changes the scene");
    expect_effect(app, "render new.png size=64x64", "Writes the file /");
    assert_true(wr_file_write("new.png", "x", 1, NULL));
    expect_effect(app, "render new.png size=64x64", "Replaces the file /");
    expect_effect(app, "undo", "another step of the history");
    assert_false(wr_guide_is_command("wrinkle render a.wrinkle -o a.png"));
    assert_false(wr_guide_is_command("# only a remark"));
    assert_false(wr_guide_is_command("fill much"));
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_command_runs_as_one_step_once_its_effect_was_shown),
        cmocka_unit_test(keys_reach_and_run_a_command),
        cmocka_unit_test(what_a_command_would_change_is_said_of_each_class),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

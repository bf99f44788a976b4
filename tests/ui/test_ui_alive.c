/* User actions during a long background command: done at once, queued in order, or refused with a message. Without a
   display. */
#include "test.h"
#include "test_folder.h"
#include "ui_busy_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "command/session_internal.h"
#include "system/clock.h"

#include "ui/app/state/action.h"
#include "ui/app/state/background_command_internal.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/tools/stroke_input.h"

#include <string.h>
#include <unistd.h>

static void push_click(int x, int y)
{
    SDL_Event down = button(SDL_MOUSEBUTTONDOWN, x, y), up = button(SDL_MOUSEBUTTONUP, x, y);
    SDL_PushEvent(&(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = x, .y = y } });
    SDL_PushEvent(&down);
    SDL_PushEvent(&up);
}

static void push_key(SDL_Keycode code, Uint16 mod)
{
    SDL_Event event = key(SDL_KEYDOWN, code);
    event.key.keysym.scancode = SDL_GetScancodeFromKey(code);
    event.key.keysym.mod = mod;
    SDL_PushEvent(&event);
    event.type = SDL_KEYUP;
    SDL_PushEvent(&event);
}

static bool is_written(const char *line)
{
    char *path = wr_config_path("window.conf"), *text = NULL;
    size_t length;
    const bool read = wr_file_read(path, 1 << 16, &text, &length, NULL);
    const bool found = read && strstr(text, line);
    wr_free(text);
    wr_free(path);
    return found;
}

/* One action after the other, each seen before the next: a tab, the guide and back, a setting saved to disk while the
   command still runs, the brush's size. */
static bool use_the_window(Long *work)
{
    WrApp *app = work->app;
    const SDL_Rect *panel = &app->layout->panel;
    const bool seen[] = { true,
                          app->settings->tab != 0,
                          app->dialog->now == WR_DIALOG_HELP,
                          app->dialog->now == WR_DIALOG_NONE,
                          is_written("grid 1"),
                          app->settings->brush.radius > 33.0 };
    const int last = (int)(sizeof seen / sizeof *seen);
    if (!seen[work->stage]) return false;
    switch (++work->stage) {
    case 1: push_click(panel->x + panel->w / 2, panel->y + 16); break;
    case 2: push_key(SDLK_F1, 0); break;
    case 3: push_key(SDLK_ESCAPE, 0); break; /* of the guide, not of the command */
    case 4: push_key(SDLK_g, KMOD_LALT); break;
    case 5: push_key(SDLK_RIGHTBRACKET, 0); break;
    }
    return work->stage == last;
}

static void the_window_is_used_meanwhile(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    app->settings->tab = 0;
    app->settings->grid = false;
    app->settings->brush.radius = 32.7;
    const WrHash before = wr_session_hash(bench.session);
    Long work = { .app = app, .watch = use_the_window };
    assert_true(run(&work, &err));
    const WrHash after = wr_session_hash(bench.session);
    assert_memory_equal(&before, &after, sizeof before);
    finish(&bench);
}

static bool drag_on(Long *work)
{
    WrApp *app = work->app;
    if (!wr_busy_greys(app)) return false; /* the bar is visible then */
    if (work->stage++ == 1)
        SDL_PushEvent(&(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = 400, .y = 51 } });
    return app->settings->brush.radius > 34.0;
}

/* The appearance of the progress bar does not end a drag. */
static void a_slider_is_dragged_through_the_beginning(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    app->settings->brush.radius = 32.7;
    SDL_Event down = button(SDL_MOUSEBUTTONDOWN, 320, 51), up = button(SDL_MOUSEBUTTONUP, 400, 51);
    SDL_PushEvent(&(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = 320, .y = 51 } });
    draw_again(app);
    SDL_PushEvent(&down);
    draw_again(app);
    Long work = { .app = app, .watch = drag_on };
    assert_true(run(&work, &err));
    SDL_PushEvent(&up);
    draw_again(app);
    finish(&bench);
}

/* A stroke's end and the next click arrive between two frames, as on a slow machine. */
static bool click_at_once(Long *work)
{
    WrApp *app = work->app;
    const SDL_Rect *canvas = &app->layout->canvas, *panel = &app->layout->panel;
    const int x = canvas->x + canvas->w / 2, y = canvas->y + canvas->h / 2;
    SDL_Event down = button(SDL_MOUSEBUTTONDOWN, x, y), up = button(SDL_MOUSEBUTTONUP, x, y);
    if (!wr_busy_greys(app)) return false;
    work->stage++;
    if (work->stage == 1) SDL_PushEvent(&down);
    if (work->stage == 1 || app->hand->grab == WR_GRAB_NONE) return app->settings->tab != 0;
    SDL_PushEvent(&up);
    push_click(panel->x + panel->w / 2, panel->y + 16);
    return false;
}

static void a_click_right_after_another_is_not_lost(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    bench.app->settings->tab = 0;
    Long work = { .app = bench.app, .watch = click_at_once };
    assert_true(run(&work, &err));
    finish(&bench);
}

/* Actions that change the document are disabled, and their keys refused with a message, except those that can
   wait. */
static bool try_to_edit(Long *work)
{
    WrApp *app = work->app;
    if (!wr_busy_greys(app)) return false;
    if (work->stage++ == 0) {
        assert_false(wr_action_can(app, wr_action_find(app, "layer_add")));
        assert_true(wr_action_can(app, wr_action_find(app, "undo"))); /* it is queued */
        assert_true(wr_action_can(app, wr_action_find(app, "layer_show")));
        assert_true(wr_action_can(app, wr_action_find(app, "theme_dark")));
        assert_false(wr_app_run_line(app, "fill 0.37"));
        app->busy->refused_at = -1e9;
        push_key(SDLK_j, KMOD_LCTRL);
    }
    return app->busy->refused_at > 0.0; /* the bar shows a message */
}

static void an_edit_is_refused_with_words(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    const WrHash before = wr_session_hash(bench.session);
    Long work = { .app = bench.app, .watch = try_to_edit };
    assert_true(run(&work, &err));
    draw_again(bench.app);
    const WrHash after = wr_session_hash(bench.session);
    assert_memory_equal(&before, &after, sizeof before);
    assert_true(wr_action_can(bench.app, wr_action_find(bench.app, "layer_add")));
    finish(&bench);
}

static void push_stroke(const WrApp *app, int from, int to)
{
    const SDL_Rect *canvas = &app->layout->canvas;
    const int x = canvas->x + canvas->w / 2, y = canvas->y + canvas->h / 2;
    SDL_Event down = button(SDL_MOUSEBUTTONDOWN, x + from, y);
    SDL_Event up = button(SDL_MOUSEBUTTONUP, x + to, y + 3);
    SDL_PushEvent(&(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = x + from, .y = y } });
    SDL_PushEvent(&down);
    SDL_PushEvent(&(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = x + to, .y = y + 3 } });
    SDL_PushEvent(&up);
}

/* A stroke, a lock, a stroke: the second one finds the layer locked. */
static bool paint_and_lock(Long *work)
{
    WrApp *app = work->app;
    if (app->waits->items.count < work->stage) return false;
    switch (work->stage++) {
    case 0: push_stroke(app, 0, 41); break;
    case 1: assert_true(wr_app_run_line(app, "layer set 1 lock=on")); break;
    case 2: push_stroke(app, 7, -29); break;
    default: return true;
    }
    return false;
}

static void what_waits_is_done_in_its_order(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    const int before = wr_session_history_position(bench.session);
    Long work = { .app = app, .watch = paint_and_lock };
    assert_true(run(&work, &err));
    assert_int_equal(wr_session_history_position(bench.session), before);
    draw_again(app);
    draw_again(app);
    assert_int_equal(app->waits->items.count, 0);
    assert_int_equal(wr_session_history_position(bench.session), before + 2);
    const char *stroke = wr_session_history_line(bench.session, before);
    assert_int_equal(strncmp(stroke, "stroke ", 7), 0);
    assert_string_equal(wr_session_history_line(bench.session, before + 1), "layer set 1 lock=on");
    assert_int_equal(app->messages->unread, 1); /* the layer is locked */
    finish(&bench);
}

/* Two strokes, undo twice, redo, and a stroke that is not yet released when the command ends. */
static bool paint_and_undo(Long *work)
{
    WrApp *app = work->app;
    const SDL_Rect *canvas = &app->layout->canvas;
    SDL_Event down = button(SDL_MOUSEBUTTONDOWN, canvas->x + canvas->w / 2 - 9, canvas->y + 80);
    if (!wr_busy_greys(app) || app->waits->items.count < work->stage) return false;
    switch (work->stage++) {
    case 0: push_stroke(app, 0, 41); break;
    case 1: push_stroke(app, 7, -29); break;
    case 2:
    case 3: push_key(SDLK_z, KMOD_LCTRL); break;
    case 4: push_key(SDLK_z, KMOD_LCTRL | KMOD_LSHIFT); break;
    case 5: SDL_PushEvent(&down); break;
    default: return true;
    }
    return false;
}

static void an_undo_waits_behind_the_strokes(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    const SDL_Rect *canvas = &app->layout->canvas;
    const int before = wr_session_history_position(bench.session);
    Long work = { .app = app, .watch = paint_and_undo };
    assert_true(run(&work, &err));
    draw_again(app);
    draw_again(app);
    assert_int_equal(app->waits->items.count, 0);
    assert_int_equal(wr_session_history_position(bench.session), before + 1);
    assert_true(app->brush->drawing); /* the last stroke goes on */
    SDL_Event up = button(SDL_MOUSEBUTTONUP, canvas->x + canvas->w / 2 + 31, canvas->y + 95);
    SDL_PushEvent(&up);
    for (int i = 0; i < 50 && app->brush->jobs.count > 0; i++) draw_again(app);
    assert_int_equal(wr_session_history_position(bench.session), before + 2);
    assert_int_equal(wr_session_redo_count(bench.session), 0);
    assert_int_equal(app->messages->unread, 0);
    finish(&bench);
}

/* Cancelled: queued actions are dropped with a message. */
static bool paint_and_give_up(Long *work)
{
    WrApp *app = work->app;
    if (work->stage++ > 0) return app->waits->items.count == 2;
    assert_true(wr_app_run_line(app, "layer set 1 visible=off"));
    push_stroke(app, 3, 38);
    return false;
}

static bool give_up_after(Long *work)
{
    if (!paint_and_give_up(work)) return false;
    push_key(SDLK_ESCAPE, 0);
    return true;
}

static void what_waits_is_dropped_with_what_is_given_up(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    const WrHash before = wr_session_hash(bench.session);
    Long work = { .app = app, .watch = give_up_after, .gives_up = true };
    assert_false(run(&work, &err));
    draw_again(app);
    draw_again(app);
    const WrHash after = wr_session_hash(bench.session);
    assert_memory_equal(&before, &after, sizeof before);
    assert_int_equal(app->waits->items.count, 0);
    assert_int_equal(app->brush->jobs.count, 0);
    const WrMessage *said = wr_messages_shown(app->messages, 0.0);
    assert_non_null(said);
    assert_non_null(strstr(said->text, "actions that waited"));
    assert_non_null(strstr(said->text, "Stroke"));
    finish(&bench);
}

/* Lines refer to layers by number; the numbers change when the command adds a layer. */
static void what_waits_is_not_done_to_other_layers(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    Long work = { .app = app, .watch = paint_and_give_up, .line = "layer add" };
    assert_true(run(&work, &err));
    const WrHash before = wr_session_hash(bench.session);
    draw_again(app);
    draw_again(app);
    const WrHash after = wr_session_hash(bench.session);
    assert_memory_equal(&before, &after, sizeof before);
    assert_int_equal(app->brush->jobs.count, 0);
    const WrMessage *said = wr_messages_shown(app->messages, 0.0);
    assert_non_null(said);
    assert_non_null(strstr(said->text, "layers have changed"));
    finish(&bench);
}

/* A widget that runs a line is inside a frame, which must not block: the main loop finishes the line. */
static void a_line_of_a_widget_does_not_hold_its_picture_up(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    WrApp *app = bench.app;
    const WrHash before = wr_session_hash(bench.session);
    app->in_frame = true;
    assert_true(wr_app_run_line(app, "render x.png size=16384x16384"));
    assert_true(wr_app_run_line(app, "material ks=0.37")); /* part of the same press */
    app->in_frame = false;
    assert_non_null(app->busy);
    assert_int_equal(app->waits->items.count, 1);
    assert_true(app->session != bench.session); /* still a snapshot */
    const double end = wr_clock_seconds() + PATIENCE;
    while (wr_busy_is_young(app) && wr_clock_seconds() < end) draw_again(app);
    app->in_frame = true;
    assert_false(wr_app_run_line(app, "material ks=0.41")); /* a separate action */
    app->in_frame = false;
    push_key(SDLK_ESCAPE, 0);
    while (app->busy && wr_clock_seconds() < end) draw_again(app);
    assert_null(app->busy);
    assert_ptr_equal(app->session, bench.session);
    const WrHash after = wr_session_hash(bench.session);
    assert_memory_equal(&before, &after, sizeof before);
    const WrMessage *said = wr_messages_shown(app->messages, 0.0);
    assert_non_null(said);
    assert_int_equal(strncmp(said->text, "Cancelled", 9), 0);
    assert_int_equal(access("x.png", F_OK), -1);
    finish(&bench);
}

/* Escape cancels the stroke being drawn, not the command; it is removed from the queue. */
static bool give_the_stroke_up(Long *work)
{
    WrApp *app = work->app;
    const SDL_Rect *canvas = &app->layout->canvas;
    const int x = canvas->x + canvas->w / 3, y = canvas->y + canvas->h / 2;
    SDL_Event down = button(SDL_MOUSEBUTTONDOWN, x, y);
    const int waits = app->waits->items.count;
    if (!wr_busy_greys(app)) return false;
    switch (work->stage) {
    case 0:
        SDL_PushEvent(&(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = x, .y = y } });
        SDL_PushEvent(&down);
        work->stage = 1;
        break;
    case 1:
        if (waits == 1) push_key(SDLK_ESCAPE, 0), work->stage = 2;
        break;
    default: return waits == 0;
    }
    return false;
}

static void a_stroke_that_waits_is_given_up_by_hand(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    Long work = { .app = bench.app, .watch = give_the_stroke_up };
    assert_true(run(&work, &err));
    assert_int_equal(bench.app->brush->jobs.count, 0);
    finish(&bench);
}

/* Journal upkeep has no waiting caller: a request to close arrives meanwhile and is executed. */
static bool see_a_few(Long *work)
{
    return ++work->stage > 5;
}

static void it_closes_while_the_journal_is_tended(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    WrApp *app = bench.app;
    Long work = { .app = app, .watch = see_a_few };
    watched = &work;
    app->drawn = picture_drawn;
    wr_background_upkeep_start(app, "Keeping the journal short", take_long, &work);
    assert_non_null(app->busy);
    SDL_PushEvent(&(SDL_Event){ .type = SDL_QUIT });
    const double end = wr_clock_seconds() + PATIENCE;
    while (!app->quit && wr_clock_seconds() < end) draw_again(app);
    assert_true(app->quit);
    assert_null(app->busy);
    watched = NULL;
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_window_is_used_meanwhile),
        cmocka_unit_test(a_slider_is_dragged_through_the_beginning),
        cmocka_unit_test(a_click_right_after_another_is_not_lost),
        cmocka_unit_test(an_edit_is_refused_with_words),
        cmocka_unit_test(what_waits_is_done_in_its_order),
        cmocka_unit_test(an_undo_waits_behind_the_strokes),
        cmocka_unit_test(what_waits_is_dropped_with_what_is_given_up),
        cmocka_unit_test(what_waits_is_not_done_to_other_layers),
        cmocka_unit_test(a_line_of_a_widget_does_not_hold_its_picture_up),
        cmocka_unit_test(a_stroke_that_waits_is_given_up_by_hand),
        cmocka_unit_test(it_closes_while_the_journal_is_tended),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

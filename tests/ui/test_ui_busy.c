/* Events of the window during a long command: handled at once, handled afterwards, or refused with a message. Without
   a display; the long command belongs to the test and ends when the test has seen the expected state. */
#include "test.h"
#ifdef WR_TEST_PORTAL
#include "portal_help.h"
#endif
#include "test_folder.h"
#include "ui_busy_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "command/session_internal.h"
#include "field/field.h"
#include "system/clock.h"

#include "ui/app/loop.h"
#include "ui/app/state/app_options.h"
#include "ui/canvas/view.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/settings.h"
#include "ui/app/jobs/files.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void step_until(WrApp *app, const bool *reached)
{
    double end = wr_clock_seconds() + PATIENCE;
    while (!*reached && wr_clock_seconds() < end) {
        /* otherwise it might wait for user input */
        SDL_PushEvent(&(SDL_Event){ .type = app->ready_event });
        wr_app_step(app);
    }
    assert_true(*reached);
}

static void step_until_open(WrApp *app, const char *path)
{
    double end = wr_clock_seconds() + PATIENCE;
    while (strcmp(wr_session_path(app->session), path) != 0 && wr_clock_seconds() < end) {
        SDL_PushEvent(&(SDL_Event){ .type = app->ready_event });
        wr_app_step(app);
    }
    assert_string_equal(wr_session_path(app->session), path);
}

/* A document in the folder; the caller frees the path. */
static char *some_file(const char *name)
{
    WrError err = { "" };
    char *folder = getcwd(NULL, 0), *path = wr_path_join(folder, name);
    WrSession *session = wr_session_new(&(WrSessionOptions){ 0 });
    if (!wr_session_run(session, "table 32x32", &err) || !wr_session_save(session, path, &err))
        fail_msg("%s", err.text);
    wr_session_free(session);
    free(folder);
    return path;
}

/* ---- the tests ---- */

/* The views react as usual: a canvas key at once; a rotation of the patch becomes one step of the history after the
   command. */
static void the_views_are_alive_meanwhile(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    app->settings->turning = false;
    const double zoom = app->view->zoom;
    const bool grid = app->settings->grid;
    SDL_Event in = key(SDL_KEYDOWN, SDLK_PLUS), lines = key(SDL_KEYDOWN, SDLK_g);
    in.key.keysym.sym = SDLK_EQUALS;
    lines.key.keysym.mod = KMOD_LALT;
    Long keys = { .app = app, .events = { in, lines }, .count = 2 };
    assert_true(run(&keys, &err));
    assert_true(app->view->zoom > zoom * 1.05);
    assert_true(app->settings->grid != grid);

    const WrHash before = wr_session_hash(bench.session);
    const int x = app->layout->patch.x + app->layout->patch.w / 2;
    const int y = app->layout->patch.y + app->layout->patch.h / 2;
    SDL_Event move = { .motion = { .type = SDL_MOUSEMOTION, .x = x + 40, .y = y, .xrel = 40 } };
    Long drag = { .app = app,
                  .events = { button(SDL_MOUSEBUTTONDOWN, x, y), move,
                              button(SDL_MOUSEBUTTONUP, x + 40, y) },
                  .count = 3 };
    assert_true(run(&drag, &err));
    assert_non_null(app->live); /* shown until it is a command */
    WrHash after = wr_session_hash(bench.session);
    assert_memory_equal(&before, &after, sizeof before); /* not while the command ran */
    for (int i = 0; i < 50 && app->live; i++) draw_again(app);
    assert_null(app->live);
    after = wr_session_hash(bench.session);
    assert_memory_not_equal(&before, &after, sizeof before);
    finish(&bench);
}

/* Changes of the document are made neither during the command nor afterwards. */
static void what_changes_the_document_is_refused_meanwhile(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    const WrHash before = wr_session_hash(bench.session);
    const int x = app->layout->canvas.x + app->layout->canvas.w / 2;
    SDL_Event layer = key(SDL_KEYDOWN, SDLK_j);
    layer.key.keysym.mod = KMOD_LCTRL;
    Long work = { .app = app,
                  .events = { layer, key(SDL_KEYDOWN, SDLK_DELETE),
                              button(SDL_MOUSEBUTTONDOWN, x, 51) },
                  .count = 3 };
    assert_true(run(&work, &err));
    for (int i = 0; i < 3; i++) draw_again(app);
    const WrHash after = wr_session_hash(bench.session);
    assert_memory_equal(&before, &after, sizeof before);
    finish(&bench);
}

static void what_the_window_is_told_holds_at_once(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    SDL_WindowEvent hidden = { .type = SDL_WINDOWEVENT,
                               .windowID = SDL_GetWindowID(app->window),
                               .event = SDL_WINDOWEVENT_MINIMIZED };
    app->hand->space = true; /* held at its start */
    Long work = { .app = app,
                  .events = { { .window = hidden }, key(SDL_KEYUP, SDLK_SPACE) },
                  .count = 2 };
    assert_true(run(&work, &err));
    assert_false(app->visible);
    assert_false(app->hand->space);
    finish(&bench);
}

static void a_dropped_file_opens_afterwards(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    char *path = some_file("dropped.exr");
    begin(&bench);
    SDL_DropEvent drop = { .type = SDL_DROPFILE, .file = SDL_strdup(path) };
    Long work = { .app = bench.app, .events = { { .drop = drop } }, .count = 1 };
    assert_true(run(&work, &err));
    assert_string_equal(wr_session_path(bench.session), ""); /* not before its end */
    step_until_open(bench.app, path);
    finish(&bench);
    wr_free(path);
}

#ifdef WR_TEST_PORTAL
/* The answer of the native file dialog, here a portal that answers at once. */
static void a_chosen_file_is_taken_afterwards(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    if (!start_bus()) skip();
    char *path = some_file("chosen.exr");
    FILE *answer = fopen("answer", "w");
    assert_non_null(answer);
    fprintf(answer, "%s\n", path);
    fclose(answer);
    const Act act = { .replies = true, .file = "answer" };
    const pid_t portal = start_portal(&act);
    begin(&bench);
    wr_files_choose_way(bench.app->files, WR_FILE_WAY_DESKTOP);
    assert_true(wr_files_request_path(bench.app->files, WR_FILE_OPEN, NULL, ""));
    double end = wr_clock_seconds() + PATIENCE;
    while (!SDL_HasEvent(bench.app->file_event) && wr_clock_seconds() < end) usleep(1000);
    Long work = { .app = bench.app, .events = { { .type = SDL_USEREVENT + 100 } }, .count = 1 };
    assert_true(run(&work, &err));
    step_until_open(bench.app, path);
    finish(&bench);
    end_portal(portal);
    end_bus();
    wr_free(path);
}
#endif

/* Journal upkeep was not requested by the user: actions meanwhile are done all the same, and Escape cancels
   nothing. */
static void all_waits_while_the_journal_is_tended(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    assert_true(wr_app_run_line(app, "dab 0.31,0.77 radius=9"));
    const int before = wr_session_history_position(bench.session);
    SDL_Event undo = key(SDL_KEYDOWN, SDLK_z);
    undo.key.keysym.mod = KMOD_LCTRL;
    Long work = { .app = app,
                  .kind = WR_BUSY_TEND,
                  .events = { undo, key(SDL_KEYDOWN, SDLK_ESCAPE) },
                  .count = 2 };
    assert_true(run(&work, &err));
    assert_int_equal(wr_session_history_position(bench.session), before);
    draw_again(app);
    assert_int_equal(wr_session_history_position(bench.session), before - 1);
    finish(&bench);
}

static void a_cancel_is_no_error_and_then_it_closes(void **state)
{
    (void)state;
    Bench bench;
    WrError err = { "" };
    begin(&bench);
    WrApp *app = bench.app;
    WrHash before = wr_session_hash(bench.session);
    Long work = { .app = app,
                  .events = { { .type = SDL_QUIT }, key(SDL_KEYDOWN, SDLK_ESCAPE) },
                  .count = 2,
                  .gives_up = true };
    assert_false(run(&work, &err));
    assert_false(app->quit); /* it waited */
    wr_busy_fail(app, "something", &err);
    assert_int_equal(app->messages->unread, 0);
    const WrMessage *said = wr_messages_shown(app->messages, 0.0);
    assert_non_null(said);
    assert_string_equal(said->text, "Cancelled: something, nothing changed");
    WrHash after = wr_session_hash(bench.session);
    assert_memory_equal(&before, &after, sizeof before);
    step_until(app, &app->quit);
    wr_fail(&err, "the disk is full"); /* a failure that the user did not cause is an error */
    app->gave_up = false;
    wr_busy_fail(app, "something", &err);
    assert_int_equal(app->messages->unread, 1);
    finish(&bench);
}

/* There is nothing else to undo yet, and the undo comes before the stroke is drawn. */
static void the_first_stroke_is_undone_before_it_is_drawn(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    WrApp *app = bench.app;
    wr_session_restart_history(bench.session);
    uint64_t clean = wr_session_revision(bench.session);
    WrHash before = wr_session_hash(bench.session);
    int x = app->layout->canvas.x + app->layout->canvas.w / 2;
    int y = app->layout->canvas.y + app->layout->canvas.h / 2;
    SDL_Event down = button(SDL_MOUSEBUTTONDOWN, x, y), up = button(SDL_MOUSEBUTTONUP, x + 20, y);
    SDL_Event undo = key(SDL_KEYDOWN, SDLK_z);
    undo.key.keysym.mod = KMOD_LCTRL;
    SDL_PushEvent(&(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = x, .y = y } });
    SDL_PushEvent(&down);
    SDL_PushEvent(&(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = x + 20, .y = y } });
    SDL_PushEvent(&up);
    SDL_PushEvent(&undo);
    wr_app_step(app);
    assert_int_equal(wr_session_history_count(bench.session), 1); /* it was a stroke */
    assert_int_equal(wr_session_history_position(bench.session), 0);
    assert_true(wr_session_revision(bench.session) == clean);
    WrHash after = wr_session_hash(bench.session);
    assert_memory_equal(&before, &after, sizeof before);
    finish(&bench);
}

/* Motion, button release and leaving the window arrive before one frame: the number is that at the release. */
static void a_number_is_where_the_button_went_up(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    WrApp *app = bench.app;
    const int x = 320, y = 51; /* the brush's size, in the bar at the top */
    const double before = app->settings->brush.radius;
    SDL_Event move = { .motion = { .type = SDL_MOUSEMOTION, .x = x, .y = y } };
    SDL_Event leave = { .window = { .type = SDL_WINDOWEVENT,
                                    .windowID = SDL_GetWindowID(app->window),
                                    .event = SDL_WINDOWEVENT_LEAVE } };
    SDL_Event down = button(SDL_MOUSEBUTTONDOWN, x, y), up = button(SDL_MOUSEBUTTONUP, x + 25, y);
    SDL_PushEvent(&move);
    draw_again(app);
    SDL_PushEvent(&down);
    draw_again(app);
    assert_true(app->settings->brush.radius == before);
    SDL_PushEvent(&up);
    SDL_PushEvent(&leave);
    draw_again(app);
    draw_again(app);
    const double ratio = app->settings->brush.radius / before;
    if (!(ratio > 1.05 && ratio < 50)) fail_msg("%g times the size", ratio);
    finish(&bench);
}

/* The document of the command line: its reading ends after the first frame, so a window that waits for it is never
   drawn. */
typedef struct Opening {
    int frames;         /* atomic: drawn so far */
    int before_its_end; /* frames drawn when the reading ended */
    int shown;          /* frames with the progress in the middle of the canvas */
    bool gives_up;      /* the reading ends only when it is cancelled ... */
    bool closes;        /* ... since the window is closed meanwhile */
} Opening;

static Opening *opening;

static void count_frame(WrApp *app)
{
    const SDL_Rect *room = &app->layout->canvas;
    const int x = room->x + room->w / 2, y = room->y + room->h / 2;
    const int frames = __atomic_add_fetch(&opening->frames, 1, __ATOMIC_RELEASE);
    if (app->busy) opening->shown += wr_gui_owns_point(app->gui, x, y);
    if (!app->busy || frames != 2) return;
    if (opening->gives_up)
        SDL_PushEvent(&(SDL_Event){ .key = { .type = SDL_KEYDOWN, .keysym.sym = SDLK_ESCAPE } });
    if (opening->closes) {
        SDL_PushEvent(&(SDL_Event){ .type = SDL_QUIT });
        SDL_PushEvent(&(SDL_Event){ .key = { .type = SDL_KEYDOWN, .keysym.sym = SDLK_ESCAPE } });
    }
}

static bool open_after_a_frame(WrSession *session, void *ctx, WrError *err)
{
    Opening *now = ctx;
    const double end = wr_clock_seconds() + PATIENCE;
    while (!__atomic_load_n(&now->frames, __ATOMIC_ACQUIRE) && wr_clock_seconds() < end)
        usleep(1000);
    now->before_its_end = __atomic_load_n(&now->frames, __ATOMIC_ACQUIRE);
    while ((now->gives_up || now->closes) && !wr_progress_stopped() && wr_clock_seconds() < end)
        usleep(1000);
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    return wr_session_run(session, "table 48x16", err);
}

/* Start a window whose document is opened by open_after_a_frame, until that has ended or the window is closed. */
static Bench open_slowly(Opening *now)
{
    Bench bench;
    WrError err = { "" };
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    bench.pool = wr_pool_new(1);
    bench.session = wr_session_new(&(WrSessionOptions){ .pool = bench.pool, .outputs = true });
    bench.options = (WrAppOptions){ .session = bench.session,
                                    .open = open_after_a_frame,
                                    .open_ctx = now,
                                    .file_given = true,
                                    .threads = 1,
                                    .width = 900,
                                    .height = 700 };
    bench.app = wr_store_new();
    bench.app->options = &bench.options;
    bench.app->session = bench.session;
    bench.app->drawn = count_frame;
    opening = now;
    if (!wr_app_begin(bench.app, &err)) fail_msg("%s", err.text);
    const double end = wr_clock_seconds() + PATIENCE;
    while ((bench.app->busy || now->frames < 2) && !bench.app->quit && wr_clock_seconds() < end) {
        SDL_PushEvent(&(SDL_Event){ .type = bench.app->ready_event });
        wr_app_step(bench.app);
    }
    return bench;
}

static void the_first_frame_does_not_wait_for_the_document(void **state)
{
    (void)state;
    Opening now = { 0 };
    Bench bench = open_slowly(&now);
    assert_int_equal(wr_field_width(wr_app_field(bench.app)), 48);
    assert_true(now.before_its_end > 0 && now.shown > 0);
    draw_again(bench.app);
    const int shown = now.shown;
    draw_again(bench.app);
    assert_int_equal(now.shown, shown); /* it is gone */
    finish(&bench);
}

/* The start document stays, and the window lives on. */
static void an_opening_at_the_start_is_given_up(void **state)
{
    (void)state;
    Opening now = { .gives_up = true };
    Bench bench = open_slowly(&now);
    assert_true(now.shown > 0 && !bench.app->busy && !bench.app->quit && bench.app->file->unread);
    assert_int_not_equal(wr_field_width(wr_app_field(bench.app)), 48);
    assert_false(wr_app_unsaved(bench.app));
    finish(&bench);
}

static void the_window_closes_during_an_opening(void **state)
{
    (void)state;
    Opening now = { .closes = true };
    Bench bench = open_slowly(&now);
    const double end = wr_clock_seconds() + PATIENCE;
    while (!bench.app->quit && wr_clock_seconds() < end) {
        SDL_PushEvent(&(SDL_Event){ .type = bench.app->ready_event });
        wr_app_step(bench.app);
    }
    assert_true(bench.app->quit && bench.app->dialog->now == WR_DIALOG_NONE);
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_the_window_is_told_holds_at_once),
        cmocka_unit_test(the_first_frame_does_not_wait_for_the_document),
        cmocka_unit_test(an_opening_at_the_start_is_given_up),
        cmocka_unit_test(the_window_closes_during_an_opening),
        cmocka_unit_test(the_views_are_alive_meanwhile),
        cmocka_unit_test(what_changes_the_document_is_refused_meanwhile),
        cmocka_unit_test(a_dropped_file_opens_afterwards),
#ifdef WR_TEST_PORTAL
        cmocka_unit_test(a_chosen_file_is_taken_afterwards),
#endif
        cmocka_unit_test(all_waits_while_the_journal_is_tended),
        cmocka_unit_test(a_cancel_is_no_error_and_then_it_closes),
        cmocka_unit_test(the_first_stroke_is_undone_before_it_is_drawn),
        cmocka_unit_test(a_number_is_where_the_button_went_up),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

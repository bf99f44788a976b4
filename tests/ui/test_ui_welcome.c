/* The first start: the welcome opens without settings only, and the tour ends by itself. */
#include "test.h"
#include "app.h"

#include "base/file.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/layout.h"

/* settings: they are there, as after an earlier session. */
static void start(Bench *bench, bool settings, bool file_given)
{
    WrError err;
    char *path = wr_config_path("window.conf");
    mkdir("wrinkle", 0700);
    unlink(path);
    if (settings && !wr_file_write(path, "theme 0\n", 8, &err)) fail_msg("%s", err.text);
    wr_free(path);
    begin_with(bench, &(WrAppOptions){ .file_given = file_given, .width = 1280, .height = 800 });
}

static WrDialog dialog_at_start(bool settings, bool file_given)
{
    Bench bench;
    start(&bench, settings, file_given);
    const WrDialog now = bench.app->dialog->now;
    finish(&bench);
    return now;
}

static void the_welcome_opens_at_the_first_start_only(void **state)
{
    (void)state;
    assert_int_equal(dialog_at_start(false, true), WR_DIALOG_NONE); /* a file is named */
    assert_int_equal(dialog_at_start(false, false), WR_DIALOG_WELCOME);
    assert_int_equal(dialog_at_start(true, false), WR_DIALOG_NONE);
}

static void press(Bench *bench, SDL_Keycode key)
{
    const SDL_Scancode code = SDL_GetScancodeFromKey(key);
    const Uint32 window = SDL_GetWindowID(bench->app->window);
    SDL_PushEvent(&(SDL_Event){ .key = { .type = SDL_KEYDOWN,
                                         .windowID = window,
                                         .state = SDL_PRESSED,
                                         .keysym = { .scancode = code, .sym = key } } });
    draw_again(bench->app);
    SDL_PushEvent(&(SDL_Event){ .key = { .type = SDL_KEYUP,
                                         .windowID = window,
                                         .state = SDL_RELEASED,
                                         .keysym = { .scancode = code, .sym = key } } });
    for (int i = 0; i < 3; i++) draw_again(bench->app);
}

static void the_welcome_is_skipped_and_the_tour_has_an_end(void **state)
{
    (void)state;
    Bench bench;
    start(&bench, false, false);
    settle(&bench);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_WELCOME);
    press(&bench, SDLK_ESCAPE);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_NONE);
    assert_true(bench.app->file->starter); /* the document stays */
    wr_action_run(bench.app, WR_ACT(tour));
    settle(&bench);
    int stops = 0;
    for (; bench.app->dialog->now == WR_DIALOG_TOUR && stops < 20; stops++) {
        assert_int_equal(bench.app->dialog->stop, stops);
        press(&bench, SDLK_RETURN);
    }
    assert_in_range(stops, 4, 8);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_NONE);
    wr_action_run(bench.app, WR_ACT(tour));
    settle(&bench);
    assert_int_equal(bench.app->dialog->stop, 0);
    press(&bench, SDLK_ESCAPE);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_NONE);
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_welcome_opens_at_the_first_start_only),
        cmocka_unit_test(the_welcome_is_skipped_and_the_tour_has_an_end),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

/* Latency of Cancel, in milliseconds from the key to the end of the command: a table for people. Checked is only that
   each command ends as cancelled and leaves the document unchanged. WR_FULL=1: a table of 4096, three times each. */
#include "test.h"
#include "test_folder.h"
#include "window.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "system/clock.h"

#include "ui/app/loop.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/app_options.h"
#include "ui/app/state/background_command.h"
#include "ui/app/jobs/job.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const lines[] = {
    "adjust blur sigma=200",
    "adjust median radius=24",
    "adjust dilate radius=64",
    "adjust slope-limit limit=0.001",
    "adjust resize width=%d height=%d",
    "pattern scales",
    "noise perlin cells=16 octaves=9 warp=0.3",
    "terrain hydraulic",
    "terrain thermal rounds=200",
    "solid letters Wrinkle size=2000",
    "select slope low=10 high=60",
    "export height x.png",
    "export height x.exr",
    "export normal+y x.tif",
    "save x.exr",
    "save x.ora",
    "render x.png size=4096x4096",
};

typedef struct Press {
    WrApp *app;
    double after; /* seconds */
    double at;    /* clock */
} Press;

static void *press(void *arg)
{
    Press *p = arg;
    usleep((useconds_t)(p->after * 1e6));
    SDL_KeyboardEvent event = { .type = SDL_KEYDOWN, .keysym = { .sym = SDLK_ESCAPE } };
    p->at = wr_clock_seconds();
    SDL_PushEvent(&(SDL_Event){ .key = event });
    return NULL;
}

/* Milliseconds; below 0: it ended before. */
static double cancelled_after(WrApp *app, const char *line, double seconds)
{
    Press p = { .app = app, .after = seconds };
    WrThread thread;
    assert_true(wr_thread_start(&thread, press, &p));
    bool good = wr_app_run_line(app, line);
    double end = wr_clock_seconds();
    wr_thread_join(thread);
    SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT);
    if (good || !app->gave_up) {
        const WrMessages *m = app->messages;
        if (!good) printf("  (%s)\n", m->list.data[m->list.count - 1].text);
        return -1.0;
    }
    return (end - p.at) * 1e3;
}

static void a_cancel_ends_what_is_done(void **state)
{
    (void)state;
    WrError err = { "" };
    const char *full = getenv("WR_FULL");
    int size = full && *full ? 4096 : 512, tries = full && *full ? 3 : 1;
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
    WrPool *pool = wr_pool_new(0);
    WrSession *session = wr_session_new(&(WrSessionOptions){ .pool = pool, .outputs = true });
    WrAppOptions options = {
        .session = session, .file_given = true, .threads = 1, .width = 900, .height = 700
    };
    char line[128];
    snprintf(line, sizeof line, "table %dx%d", size, size);
    if (!wr_session_run(session, line, &err)) fail_msg("%s", err.text);
    if (!wr_session_run(session, "noise perlin cells=64 octaves=9", &err)) fail_msg("%s", err.text);
    WrApp *app = wr_store_new();
    app->options = &options;
    app->session = session;
    if (!wr_app_begin(app, &err)) fail_msg("%s", err.text);
    while (app->drawn_at == 0.0) wr_app_step(app);
    WrHash before = wr_session_hash(session);
    int base = wr_session_history_position(session);
    printf("%-44s milliseconds from Escape to the end\n", "command");
    const char *only = getenv("WR_ONLY"); /* lines that contain this text */
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        if (only && !strstr(lines[i], only)) continue;
        snprintf(line, sizeof line, lines[i], size * 2, size * 2);
        double began = wr_clock_seconds();
        printf("%-44s", line);
        for (int k = 0; k < tries; k++) {
            double ms = cancelled_after(app, line, 0.25 + 0.4 * k);
            if (ms < 0.0) printf("     done");
            else printf(" %8.0f", ms);
            fflush(stdout);
            while (wr_session_history_position(session) > base)
                if (!wr_session_run(session, "undo", &err)) fail_msg("%s", err.text);
        }
        printf("   (%.1f s in all)\n", wr_clock_seconds() - began);
        WrHash after = wr_session_hash(session);
        assert_memory_equal(&before, &after, sizeof before);
    }
    wr_app_end(app);
    wr_free(app);
    wr_session_free(session);
    wr_pool_free(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cancel_ends_what_is_done),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

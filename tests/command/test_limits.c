/* Legal values end in reasonable time: each argument of each height command at its minimum and maximum, on a small
   table. Slow commands must react to cancellation: a watchdog cancels after a time so long that the machine's speed
   does not matter; a command that does not stop then fails the test. */
#include "test.h"
#include "session_help.h"

#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/session.h"
#include "system/clock.h"

#include <pthread.h>
#include <unistd.h>

#define PATIENCE 10.0 /* seconds before a line is cancelled */
#define MERCY 120.0   /* seconds after the cancellation before a failure */

/* ---- the watchdog ---- */

typedef struct Dog {
    pthread_mutex_t lock;      /* protects `since` and the reported line */
    volatile int cancel, stop; /* atomic */
    double since;              /* clock; 0: no line runs */
    char line[256];
} Dog;

static void *watch(void *arg)
{
    Dog *dog = arg;
    while (!__atomic_load_n(&dog->stop, __ATOMIC_RELAXED)) {
        pthread_mutex_lock(&dog->lock);
        double took = dog->since > 0.0 ? wr_clock_seconds() - dog->since : 0.0;
        if (took > PATIENCE) __atomic_store_n(&dog->cancel, 1, __ATOMIC_RELAXED);
        pthread_mutex_unlock(&dog->lock);
        if (took > PATIENCE + MERCY) {
            fprintf(stderr, "%s: did not stop when it was told to\n", dog->line);
            abort();
        }
        usleep(20000);
    }
    return NULL;
}

/* Start or end of a line: the clock, or 0. */
static void set_since(Dog *dog, double since)
{
    pthread_mutex_lock(&dog->lock);
    dog->since = since;
    if (since > 0.0) __atomic_store_n(&dog->cancel, 0, __ATOMIC_RELAXED);
    pthread_mutex_unlock(&dog->lock);
}

/* ---- lines ---- */

static const char *const verbs[] = { "grid", "dab",     "stroke",  "shape",   "flood",
                                     "ramp", "pattern", "noise",   "formula", "text",
                                     "rim",  "solid",   "terrain", "select",  "adjust" };

/* Required arguments: positional ones, and those that must be given. */
static const char *needed(const WrCommand *command, const char *form)
{
    static const struct {
        const char *verb, *form, *rest;
    } rests[] = { { "dab", "", "0.5,0.5" },
                  { "stroke", "", "points=0.1,0.1;0.9,0.9" },
                  { "shape", "rectangle", "a=0.1,0.1 b=0.9,0.9" },
                  { "shape", "ellipse", "middle=0.5,0.5 radii=0.4,0.3" },
                  { "shape", "polygon", "points=0.1,0.1;0.9,0.2;0.5,0.9" },
                  { "shape", "path", "points=0.1,0.1;0.3,0.9;0.7,0.9;0.9,0.1" },
                  { "flood", "", "0.5,0.5" },
                  { "ramp", "linear", "from=0,0 to=1,0" },
                  { "ramp", "radial", "from=0.5,0.5 to=0.5,1" },
                  { "ramp", "cone", "from=0.5,0.5 to=0.5,1" },
                  { "formula", "poly", "c=1,1,0.5" },
                  { "formula", "fourier", "terms=3,2,0.5" },
                  { "text", "", "ab" },
                  { "solid", "letters", "ab" },
                  { "select", "rect", "from=0.1,0.1 to=0.9,0.9" },
                  { "select", "ellipse", "centre=0.5,0.5 radii=0.3,0.3" },
                  { "select", "lasso", "points=0.1,0.1;0.9,0.2;0.5,0.9" },
                  { "select", "flood", "0.5,0.5" },
                  { "solid", "mesh", NULL },
                  { "terrain", "elevation", NULL } };
    for (size_t i = 0; i < sizeof rests / sizeof *rests; i++)
        if (strcmp(rests[i].verb, command->name) == 0 && strcmp(rests[i].form, form) == 0)
            return rests[i].rest;
    return "";
}

static void add_extreme(WrText *line, const WrArgSpec *spec, bool most)
{
    double value = most ? spec->high : spec->low;
    if (!most && spec->above) value += spec->whole ? 1.0 : 1e-3;
    int count = wr_arg_width(spec);
    wr_text_addf(line, " %s=", spec->name);
    for (int k = 0; k < count; k++) {
        if (k > 0) wr_text_add(line, ",");
        wr_text_add_number(line, value);
    }
}

static bool is_numeric(const WrArgSpec *spec)
{
    return !spec->positional && (spec->type == WR_ARG_NUMBER || spec->type == WR_ARG_TUPLE);
}

/* ---- one of them ---- */

typedef struct Trials {
    Dog dog;
    WrSession *session;
    int number, every, tried, late;
} Trials;

static void try_line(Trials *t, const char *line)
{
    WrError err = { "" };
    const WrProgress progress = { .cancel = &t->dog.cancel };
    if (t->number++ % t->every != 0) return;
    must_run(t->session, "table 64x64");
    must_run(t->session, "grid cells=8x8");
    must_run(t->session, "select ellipse centre=0.5,0.5 radii=0.4,0.4");
    snprintf(t->dog.line, sizeof t->dog.line, "%s", line);
    double began = wr_clock_seconds();
    set_since(&t->dog, began);
    wr_progress_set(&progress);
    bool good = wr_session_run(t->session, line, &err);
    wr_progress_set(NULL);
    set_since(&t->dog, 0.0);
    t->tried++;
    if (getenv("WR_TELL") && wr_clock_seconds() - began > 1.0)
        printf("%6.1f s  %s  %s\n", wr_clock_seconds() - began, line, good ? "" : err.text);
    bool told = __atomic_load_n(&t->dog.cancel, __ATOMIC_RELAXED) != 0;
    if (!told) return;
    t->late++;
    if (good || !strstr(err.text, "cancelled"))
        fail_msg("%s: told to stop, it said: %s", line, good ? "nothing" : err.text);
}

static void try_form(Trials *t, const WrCommand *command, int form, const char *name)
{
    WrArgSpec specs[WR_ARGS_MAX];
    const char *rest = needed(command, name);
    if (!rest) return;
    int count = wr_command_specs(command, form, specs);
    for (int i = 0; i < count; i++)
        for (int most = 0; most < 2 && is_numeric(&specs[i]); most++) {
            WrText line = { 0 };
            char own[40];
            snprintf(own, sizeof own, " %s=", specs[i].name);
            if (strstr(rest, own + 1)) continue;
            wr_text_addf(&line, "%s%s%s%s%s", command->name, *name ? " " : "", name,
                         *rest ? " " : "", rest);
            add_extreme(&line, &specs[i], most == 1);
            try_line(t, wr_text_get(&line));
            wr_text_fini(&line);
        }
}

/* Combinations of two values that once ran for minutes. */
static const char *const known[] = {
    "solid cylinder radius=16384 length=100",
    "solid torus rows=1024 across=1024",
    "solid sphere rows=1024 across=1024",
    "solid surface sphere size=16384",
    "solid letters ab size=16384",
    "solid box size=16384,16384,10",
};

static void extremes_end_or_can_be_stopped(void **state)
{
    (void)state;
    pthread_t watcher;
    WrPool *pool = wr_pool_new(0);
    Trials t = { .every = 1 };
    pthread_mutex_init(&t.dog.lock, NULL);
    t.session = wr_session_new(&(WrSessionOptions){ .pool = pool });
    assert_int_equal(pthread_create(&watcher, NULL, watch, &t.dog), 0);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) try_line(&t, known[i]);
    t.every = getenv("WR_FULL") ? 1 : 10;
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++) {
        const WrCommand *command = wr_command_find(verbs[i]);
        WrForm form;
        assert_non_null(command);
        if (!command->form) try_form(&t, command, -1, "");
        for (int k = 0; command->form && command->form(k, &form); k++)
            try_form(&t, command, k, form.name);
    }
    if (getenv("WR_TELL")) printf("%d lines, %d told to stop\n", t.tried, t.late);
    assert_true(t.tried > 50);
    __atomic_store_n(&t.dog.stop, 1, __ATOMIC_RELAXED);
    pthread_join(watcher, NULL);
    wr_session_free(t.session);
    wr_pool_free(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(extremes_end_or_can_be_stopped) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

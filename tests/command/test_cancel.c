/* Cancellation of every long operation: each command, on a large table, is cancelled at one of its own progress
   reports and must leave no trace. Its work afterwards is counted in pieces and reports, not in seconds, so that the
   speed of the machine does not matter. */
#include "test.h"
#include "progress_checks.h"
#include "test_folder.h"
#include "session_help.h"
#include "cancel_lines.h"

#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/command_table.h"
#include "command/session.h"
#include "generate/generator.h"
#include "system/clock.h"

#include <sys/stat.h>

#define THREADS 2
#define PIECES_AFTER (2 * THREADS) /* running, or started at the same moment */
#define REPORTS_AFTER 4
#define SOON 100 /* ms between two checks: slower ones are printed in detail */

static bool is_whole(void)
{
    return getenv("WR_FULL") != NULL;
}

/* Side of the table in texels. */
static int side(void)
{
    return is_whole() ? 4096 : 256;
}

/* ---- cancelled lines ---- */

typedef struct Stop {
    volatile int cancel;
    int reports, at; /* reports so far; the one to cancel at, 0: never */
    int64_t pieces;  /* started before the cancellation */
    double since;    /* clock at the cancellation */
} Stop;

static void hear(void *ctx, double fraction)
{
    Stop *stop = ctx;
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    if (++stop->reports != stop->at) return;
    __atomic_store_n(&stop->cancel, 1, __ATOMIC_RELAXED);
    stop->pieces = wr_pool_pieces();
    stop->since = wr_clock_seconds();
}

/* ---- the commands ---- */

/* "NAME FORM", or its prefix: instant for any table size, not a table command, or tested elsewhere. */
static const char *const instant[] = {
    "table",
    "script",
    "layer rasterize",
    "layer group",
    "layer ungroup",
    "variant add",
    "variant use",
    "variant set",
    "variant rename",
    "variant delete",
    "layer use",
    "layer move",
    "layer rename",
    "layer set",
    "layer solo",
    "layer delete",
    "layer duplicate",
    "select all",
    "select none",
    "fill",
    "open",
    "export normal-baked",
    "filter",
    "bake",       /* test_bake_command.c */
    "bake-tiles", /* test_udim_command.c */
    "sculpt",
    "project", /* test_sculpt.c */
    "macro",   /* test_steps.c */
    "model",   /* a small mesh */
};

/* Arguments that generators need besides their defaults; generators that read files are tested elsewhere. */
static const char *line_of(const WrGenerator *g, WrText *line)
{
    static const struct {
        const char *family, *name, *rest;
    } given[] = { { "text", NULL, " Wrinkles size=200" },
                  { "solid", "letters", " ab size=400" },
                  { "solid", "surface", " sphere size=300" },
                  { "formula", "fourier", " terms=3,2,0.5" },
                  { "formula", "poly", " c=1,1,0.5" },
                  { "terrain", "elevation", " big.exr" },
                  { "picture", "photo", " big.exr" },
                  { "picture", "paste", " big.exr" },
                  { "picture", "normals", " big.png" },
                  { "picture", "svg", NULL }, /* drawn as path */
                  { "solid", "mesh", NULL } };
    wr_text_clear(line);
    wr_text_addf(line, "%s%s%s", g->family, g->name ? " " : "", g->name ? g->name : "");
    for (size_t i = 0; i < sizeof given / sizeof *given; i++) {
        bool same = strcmp(given[i].family, g->family) == 0 &&
                    (!g->name || !given[i].name || strcmp(given[i].name, g->name) == 0);
        if (same && !given[i].rest) return NULL;
        if (same) wr_text_add(line, given[i].rest);
    }
    return wr_text_get(line);
}

/* ---- one of them ---- */

typedef struct Rig {
    WrSession *session;
    WrHash hash;
    int steps;
    uint64_t revision, folder;
    bool print;
} Rig;

static void assert_untouched(const Rig *rig, const char *line, int at)
{
    if (!wr_hash_equal(wr_session_hash(rig->session), rig->hash))
        fail_msg("%s: cancelled at report %d, it changed the document", line, at);
    assert_int_equal(wr_session_history_position(rig->session), rig->steps);
    assert_true(wr_session_revision(rig->session) == rig->revision);
    if (look_at_folder() != rig->folder) fail_msg("%s: left a file behind", line);
}

/* Cancel the line at that report. False: it ended before. */
static bool stop_at(Rig *rig, const char *line, int at, double *ms)
{
    WrError err = { "" };
    Stop stop = { .at = at };
    WrProgress progress = { &stop.cancel, hear, &stop };
    wr_progress_set(&progress);
    bool good = wr_session_run(rig->session, line, &err);
    double seconds = wr_clock_seconds() - stop.since;
    int64_t pieces = wr_pool_pieces() - stop.pieces;
    wr_progress_set(NULL);
    if (!stop.cancel) return false;
    if (good) fail_msg("%s: went on though it was cancelled at report %d", line, at);
    if (!strstr(err.text, "cancelled")) fail_msg("%s: cancelled, it said %s", line, err.text);
    if (pieces > PIECES_AFTER)
        fail_msg("%s: began %d pieces after report %d cancelled it", line, (int)pieces, at);
    if (stop.reports - at > REPORTS_AFTER)
        fail_msg("%s: %d reports after report %d cancelled it", line, stop.reports - at, at);
    assert_untouched(rig, line, at);
    if (seconds * 1e3 > *ms) *ms = seconds * 1e3;
    return true;
}

/* Restore the state before the line. */
static void take_back(Rig *rig, const char *line)
{
    take_back_line(rig->session, line);
    rig->folder = look_at_folder();
    rig->revision = wr_session_revision(rig->session);
    assert_untouched(rig, line, 0);
}

static void tell(const char *line, double took, const Stop *whole, double gap, double ms)
{
    if (!getenv("WR_TELL")) return;
    printf("%-70.70s %8.0f ms, %5d reports, looks within %6.1f ms, stopped within %6.1f ms\n", line,
           took * 1e3, whole->reports, gap, ms);
    fflush(stdout);
    if (gap > SOON && strcmp(getenv("WR_TELL"), "where") == 0)
        backtrace_symbols_fd(looks.where, looks.frames, 1);
}

/* One complete run, which counts reports and checks. */
static double run_whole(Rig *rig, const char *line, Stop *whole, double *gap)
{
    WrError err = { "" };
    WrProgress progress = { &whole->cancel, hear, whole };
    wr_progress_set(&progress);
    const double began = wr_clock_seconds();
    looks_begin();
    bool good = wr_session_run(rig->session, line, &err);
    *gap = looks_end();
    const double took = wr_clock_seconds() - began;
    wr_progress_set(NULL);
    if (!good) fail_msg("%s: %s", line, err.text);
    take_back(rig, line);
    return took;
}

/* Large tables are processed once completely; on small ones late cancellation is tested too, in the middle of the first
   line and at the end of the next in turn. */
static void try_line(Rig *rig, const char *line)
{
    static int is_odd = 1;
    is_odd = !is_odd;
    Stop whole = { 0 };
    double ms = 0.0, gap;
    if (!stop_at(rig, line, 1, &ms)) fail_msg("%s: no report", line);
    const double took = run_whole(rig, line, &whole, &gap);
    const int late[] = { whole.reports / 2 + 1, whole.reports };
    for (int i = is_odd; i < 2 && !is_whole(); i += 2)
        if (!stop_at(rig, line, late[i], &ms)) take_back(rig, line);
    tell(line, took, &whole, gap, ms);
}

static Rig make_rig(WrPool *pool, int side)
{
    Rig rig = { .session = busy_session(pool, side) };
    rig.hash = wr_session_hash(rig.session);
    rig.steps = wr_session_history_position(rig.session);
    rig.revision = wr_session_revision(rig.session);
    rig.folder = look_at_folder();
    return rig;
}

static void each_command_stops_at_a_report_and_leaves_no_trace(void **state)
{
    (void)state;
    WrPool *pool = wr_pool_new(THREADS);
    const char *only = getenv("WR_ONLY");
    WrSession *maker = busy_session(pool, side());
    must_run(maker, "export normal+y big.exr");
    must_run(maker, "export normal+y big.png");
    wr_session_free(maker);
    Rig rig = make_rig(pool, side());
    for (int i = 0; i < LINES; i += test_amount(1, 3))
        if (!only || strstr(lines[i], only)) try_line(&rig, lines[i]);
    wr_session_free(rig.session);
    wr_pool_free(pool);
}

/* True if a complete run on a large table needs long in proportion to its texels: on a smaller one the pieces are as
   large. */
static bool is_long(const char *line)
{
    static const char *const begin[] = { "terrain hydraulic", "solid letters", "solid surface",
                                         "pattern scales",    "pattern weave", "pattern cracks" };
    for (size_t i = 0; i < sizeof begin / sizeof *begin; i++)
        if (strncmp(line, begin[i], strlen(begin[i])) == 0) return true;
    return false;
}

static void each_generator_stops_at_a_report_and_leaves_no_trace(void **state)
{
    (void)state;
    WrPool *pool = wr_pool_new(THREADS);
    const char *only = getenv("WR_ONLY");
    WrText line = { 0 };
    Rig rig = make_rig(pool, side()), smaller = make_rig(pool, side() / 4);
    int number = 0;
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family; g++) {
            if (number++ % test_amount(1, 3) != 0) continue;
            if (!line_of(g, &line) || (only && !strstr(wr_text_get(&line), only))) continue;
            bool small = is_whole() && is_long(wr_text_get(&line));
            try_line(small ? &smaller : &rig, wr_text_get(&line));
        }
    wr_text_fini(&line);
    wr_session_free(smaller.session);
    wr_session_free(rig.session);
    wr_pool_free(pool);
}

/* ---- completeness ---- */

static bool begins(const char *line, const char *name)
{
    size_t length = strlen(name);
    return strncmp(line, name, length) == 0 && (line[length] == ' ' || line[length] == '\0');
}

/* Commands of the scene, the view and the history change no table. */
static bool is_known(const WrCommand *command, int form, const char *name)
{
    const WrCommandClass of = command->class_of ? command->class_of(form) : command->kind;
    if (of != WR_CLASS_EDIT && of != WR_CLASS_OUTPUT) return true;
    for (size_t i = 0; i < sizeof instant / sizeof *instant; i++)
        if (begins(name, instant[i])) return true;
    for (int i = 0; i < LINES; i++)
        if (begins(lines[i], name)) return true;
    return false;
}

static void each_command_is_tried_or_known_to_be_instant(void **state)
{
    (void)state;
    for (int i = 0; i < wr_command_count; i++) {
        const WrCommand *command = wr_commands[i];
        WrForm form;
        if (wr_family_find(command->name)) continue;
        if (!command->form && !is_known(command, -1, command->name))
            fail_msg("%s: is not tried", command->name);
        for (int k = 0; command->form && command->form(k, &form); k++) {
            char name[64];
            snprintf(name, sizeof name, "%s %s", command->name, form.name);
            if (!is_known(command, k, name)) fail_msg("%s: is not tried", name);
        }
    }
}

/* ---- operations without a command ---- */

/* False: it ended before. */
static bool cancelled_at(int at, bool (*work)(WrSession *, WrError *), WrSession *session)
{
    WrError err = { "" };
    Stop stop = { .at = at };
    WrProgress progress = { &stop.cancel, hear, &stop };
    wr_progress_set(&progress);
    bool good = work(session, &err);
    wr_progress_set(NULL);
    if (!stop.cancel) return false;
    assert_false(good);
    assert_non_null(strstr(err.text, "cancelled"));
    return true;
}

static bool open_document(WrSession *session, WrError *err)
{
    return wr_session_open(session, "old.exr", err);
}

static bool open_archive(WrSession *session, WrError *err)
{
    return wr_session_open(session, "old.ora", err);
}

static bool open_picture(WrSession *session, WrError *err)
{
    return wr_session_open(session, "old.png", err);
}

static bool open_script(WrSession *session, WrError *err)
{
    return wr_session_open(session, "old.wrinkle", err);
}

static bool save_again(WrSession *session, WrError *err)
{
    return wr_session_save(session, "old.exr", err);
}

static void opening_stops_and_keeps_what_was_open(void **state)
{
    (void)state;
    static bool (*const works[])(WrSession *, WrError *) = { open_document, open_archive,
                                                             open_picture, open_script,
                                                             save_again };
    WrPool *pool = wr_pool_new(THREADS);
    WrSession *maker = busy_session(pool, side());
    WrError err;
    must_run(maker, "save old.exr");
    must_run(maker, "save old.ora");
    must_run(maker, "export height old.png");
    assert_true(wr_session_save_history(maker, "old.wrinkle", &err));
    uint64_t folder = look_at_folder();
    for (size_t i = 0; i < sizeof works / sizeof *works; i++) {
        WrSession *s = wr_session_new(&(WrSessionOptions){ .pool = pool, .journal = true });
        must_run(s, "table 200x100");
        must_run(s, "pattern dots");
        WrHash hash = wr_session_hash(s);
        int stops = 0;
        for (int at = 1; cancelled_at(at, works[i], s); at += 1 + at / 2) {
            assert_true(wr_hash_equal(wr_session_hash(s), hash));
            assert_int_equal(wr_session_history_position(s), 2);
            assert_string_equal(wr_session_path(s), "");
            assert_true(look_at_folder() == folder);
            stops++;
        }
        assert_true(stops > 0);
        wr_session_free(s);
    }
    wr_session_free(maker);
    wr_pool_free(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_command_is_tried_or_known_to_be_instant),
        cmocka_unit_test(each_command_stops_at_a_report_and_leaves_no_trace),
        cmocka_unit_test(each_generator_stops_at_a_report_and_leaves_no_trace),
        cmocka_unit_test(opening_stops_and_keeps_what_was_open),
    };
    return cmocka_run_group_tests(tests, enter_state_folder, remove_folder);
}

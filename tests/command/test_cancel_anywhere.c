/* Cancellation at any check, not only at reports: work ends with "cancelled", and partial results are never used as
   complete ones afterwards. Pictures, films and generators with every kind of cached table. The test replaces the
   check function (tests/CMakeLists.txt). */
#include "test.h"
#include "progress_checks.h"
#include "test_folder.h"
#include "session_help.h"
#include "cancel_lines.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/slab.h"
#include <math.h>

#define THREADS 2
#define STOPS (getenv("WR_FULL") ? 14 : 6)     /* of one picture */
#define LINE_STOPS (getenv("WR_FULL") ? 3 : 2) /* of one line */
#define TABLE "table 130x97", "noise perlin", "surface sphere", "bump height=0.05"
#define SCENE 10

/* The check after which to cancel, from 1; 0: none. Any thread checks. */
static struct {
    int64_t at, seen;
    int64_t tiles; /* taken before */
    volatile int cancel;
} stop;

static void count_look(void)
{
    const int64_t seen = __atomic_add_fetch(&stop.seen, 1, __ATOMIC_RELAXED);
    if (stop.at > 0 && seen == stop.at) stop.tiles = wr_slab_pieces();
    if (stop.at > 0 && seen >= stop.at) __atomic_store_n(&stop.cancel, 1, __ATOMIC_RELAXED);
}

static bool run_until(WrSession *session, const char *line, int64_t at, WrError *err)
{
    stop.at = at;
    __atomic_store_n(&stop.seen, 0, __ATOMIC_RELAXED);
    stop.cancel = 0;
    const WrProgress progress = { .cancel = &stop.cancel };
    wr_progress_set(&progress);
    const bool good = wr_session_run(session, line, err);
    wr_progress_set(NULL);
    return good;
}

/* 0, 0 if the file is missing. */
static WrHash hash_of(const char *path)
{
    char *bytes;
    size_t length;
    WrError err;
    if (access(path, F_OK) != 0) return (WrHash){ 0, 0 };
    if (!wr_file_read(path, 1 << 24, &bytes, &length, &err)) fail_msg("%s", err.text);
    const WrHash hash = wr_hash_bytes(bytes, length, (WrHash){ 0, 0 });
    wr_free(bytes);
    return hash;
}

static WrSession *session_with(WrPool *pool, const char *const *scene)
{
    const WrSessionOptions options = { .pool = pool, .outputs = true };
    WrSession *session = wr_session_new(&options);
    for (; *scene; scene++) must_run(session, *scene);
    return session;
}

/* Number of the nth tested check: the first few, then spread over all. */
static int64_t nth_look(int n, int64_t all)
{
    if (n < 4) return n + 1;
    return 1 + (int64_t)(fmod(n * 0.6180339887498949, 1.0) * (double)all);
}

/* The scene is created anew for each stop, and so are all of the renderer's tables. */
static void try_scene(WrPool *pool, const char *const *scene, const char *line, const char *path)
{
    WrError err = { "" };
    WrSession *whole = session_with(pool, scene);
    if (!run_until(whole, line, 0, &err)) fail_msg("%s\n  %s", line, err.text);
    const int64_t all = stop.seen;
    const WrHash right = hash_of(path);
    wr_session_free(whole);
    assert_true(all > 4);
    for (int n = 0; n < STOPS; n++) {
        const int64_t at = nth_look(n, all);
        WrSession *session = session_with(pool, scene);
        remove(path);
        const bool good = run_until(session, line, at, &err);
        if (good && at < all / 2)
            fail_msg("%s: look %d of %d did not stop it", scene[4], (int)at, (int)all);
        if (good && !wr_hash_equal(hash_of(path), right))
            fail_msg("%s: look %d", scene[4], (int)at);
        if (!good && !strstr(err.text, "cancelled"))
            fail_msg("%s: stopped at look %d of %d it said %s", scene[4], (int)at, (int)all,
                     err.text);
        if (!good) assert_true(wr_hash_equal(hash_of(path), (WrHash){ 0, 0 }));
        must_run(session, line);
        if (!wr_hash_equal(hash_of(path), right))
            fail_msg("%s: after a stop at look %d of %d the picture is another", scene[4], (int)at,
                     (int)all);
        wr_session_free(session);
    }
}

static void a_picture_stops_at_any_look(void **state)
{
    (void)state;
    static const char *const scenes[][SCENE] = {
        { TABLE, "bump scheme=bilinear" },
        { TABLE, "surface torus", "bump scheme=bspline mode=exact" },
        { TABLE, "dials aa=filter" },
        { TABLE, "dials aa=moments moments=lean", "replicate 3,2" },
        { TABLE, "dials heights=8bit" },
        { TABLE, "dials shading=double", "bump scheme=bspline-fit" },
        { TABLE, "dials aa=adaptive samples=4" },
        { TABLE, "environment studio", "material model=ggx roughness=0.3" },
        { TABLE, "grain wood drives=all" },
        { TABLE, "colouring ramp cavity=0.2,0.1,0.3" },
        { TABLE, "bump displaced=on" },
        { TABLE, "material shadow=on occlusion=on" },
        { TABLE, "object add second at=1,0.3,0", "surface cube", "ground on" },
    };
    WrPool *pool = wr_pool_new(THREADS);
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
        try_scene(pool, scenes[i], "render p.png size=61x47", "p.png");
    wr_pool_free(pool);
}

/* Each line of the table, at a few checks: nothing is changed, no file is left, and afterwards it can run. */
static void a_line_stops_at_any_look(void **state)
{
    (void)state;
    WrPool *pool = wr_pool_new(THREADS);
    WrSession *session = busy_session(pool, 256);
    must_run(session, "export normal+y big.exr");
    must_run(session, "export normal+y big.png");
    const WrHash hash = wr_session_hash(session);
    uint64_t folder = look_at_folder();
    for (int i = 0; i < LINES; i += test_amount(1, 4)) {
        WrError err = { "" };
        int64_t all = 40 * (i % 7 + 1);
        for (int n = 0; n < LINE_STOPS; n++) {
            const int64_t at = nth_look(n + 7 * i, all);
            if (run_until(session, lines[i], at, &err)) {
                take_back_line(session, lines[i]);
                folder = look_at_folder();
                all = stop.seen;
            } else if (!strstr(err.text, "cancelled")) {
                fail_msg("%s: stopped at look %d it said %s", lines[i], (int)at, err.text);
            }
            if (!wr_hash_equal(wr_session_hash(session), hash))
                fail_msg("%s: stopped at look %d it changed the document", lines[i], (int)at);
            if (look_at_folder() != folder) fail_msg("%s: left a file behind", lines[i]);
        }
    }
    wr_session_free(session);
    wr_pool_free(pool);
}

#define LARGE_STOPS (getenv("WR_FULL") ? 6 : 3)
#define CHECKS_AFTER                                                                               \
    1200 /* one for each of the 768 tiles at most, whose work it ends, and some on the way back */
#define TILES_AFTER 256 /* of two tables' batch */

/* Runs the line whole, to count its checks, then cancels it between two checks. A bounded number of others follows, few
   tiles are made, and all memory is given back. */
static void try_large(WrSession *s, const char *line)
{
    const int before = wr_session_history_position(s);
    int64_t all = 0;
    for (int n = 0; n <= LARGE_STOPS; n++) {
        WrError err = { "" };
        const int64_t held = wr_memory_bytes();
        const int64_t at = n == 0  ? INT64_MAX
                           : n < 3 ? n
                                   : 2 + (all - 3) * (n - 2) / (LARGE_STOPS - 1);
        const bool good = run_until(s, line, at, &err);
        if (n == 0) all = stop.seen;
        if (n == 0 && !good) fail_msg("%s: %s", line, err.text);
        if (wr_session_history_position(s) != before) must_run(s, "undo");
        if (good) continue;
        const int64_t checks = stop.seen - at, tiles = wr_slab_pieces() - stop.tiles;
        if (checks > CHECKS_AFTER || tiles > TILES_AFTER || wr_memory_bytes() != held)
            fail_msg("%s: cancelled after check %d of %d it made %d checks and %d tiles and keeps "
                     "%d bytes",
                     line, (int)at, (int)all, (int)checks, (int)tiles,
                     (int)(wr_memory_bytes() - held));
    }
}

/* Lines after a + prepare the following ones. */
static void a_large_table_stops_within_a_slice(void **state)
{
    (void)state;
    static const char *const large[] = {
        "adjust invert",
        "adjust flip-u",
        "adjust rotate angle=90",
        "adjust resize width=3000 height=2000",
        "adjust blur sigma=2",
        "adjust blur sigma=50",
        "adjust slope-limit limit=0.001",
        "adjust median radius=2",
        "noise perlin",
        "noise perlin blend=add",
        "pattern bricks",
        "terrain fractal octaves=2",
        "terrain thermal rounds=1",
        "terrain hydraulic rain=0.002",
        "solid sphere radius=700",
        "solid torus across=16 rows=16",
        "solid surface sphere size=900",
        "rim",
        "grid cells=512x512 width=2",
        "ramp linear from=0,0 to=1,0",
        "flood 0.5,0.5 tolerance=100",
        "shape rectangle a=0.1,0.1 b=0.9,0.9 paint=fill",
        "export height x.png",
        "save x.exr",
        "+select ellipse centre=0.5,0.5 radii=0.45,0.4",
        "transform move=17,9",
        "select grow by=30",
        "select feather by=40",
        "select slope low=0 high=30",
        "layer clear 1",
    };
    WrPool *pool = wr_pool_new(THREADS);
    WrSessionOptions options = { .pool = pool, .outputs = true };
    WrSession *s = wr_session_new(&options);
    must_run(s, test_amount(0, 1) ? "table 1024x1024"
                                  : "table 2048x1536"); /* several batches of tiles */
    must_run(s, "noise value cells=64");
    for (size_t i = 0; i < sizeof large / sizeof *large; i++)
        if (large[i][0] == '+') must_run(s, large[i] + 1);
        else if (i % (size_t)test_amount(1, 3) == 0) try_large(s, large[i]);
    wr_session_free(s);
    wr_pool_free(pool);
}

int main(void)
{
    looks.hook = count_look;
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_picture_stops_at_any_look),
                                        cmocka_unit_test(a_line_stops_at_any_look),
                                        cmocka_unit_test(a_large_table_stops_within_a_slice) };
    return cmocka_run_group_tests(tests, enter_state_folder, remove_folder);
}

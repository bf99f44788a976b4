/* Large pictures are written in bands of rows: the same bytes, in little memory, and nothing is left after a
   cancellation. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "command/session.h"
#include "image/image.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/resource.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

static const char *const endings[] = { "png", "exr", "tif", "bmp", "tga", "ppm", "jpg" };
enum { ENDINGS = sizeof endings / sizeof *endings };

static WrSession *session_with(WrPool *pool, size_t picture_bytes, const char *const *lines)
{
    const WrSessionOptions options = { .pool = pool,
                                       .outputs = true,
                                       .picture_bytes = picture_bytes };
    WrSession *s = wr_session_new(&options);
    must_run(s, "table 64x48");
    must_run(s, "pattern bricks");
    must_run(s, "surface torus");
    for (int i = 0; lines[i]; i++) must_run(s, lines[i]);
    return s;
}

static void expect_same(const char *a, const char *b)
{
    WrError err = { "" };
    char *bytes[2];
    size_t length[2];
    if (!wr_file_read(a, 1 << 28, &bytes[0], &length[0], &err) ||
        !wr_file_read(b, 1 << 28, &bytes[1], &length[1], &err))
        fail_msg("%s", err.text);
    if (length[0] != length[1] || memcmp(bytes[0], bytes[1], length[0]) != 0)
        fail_msg("%s and %s differ", a, b);
    wr_free(bytes[0]);
    wr_free(bytes[1]);
}

static void render(WrSession *s, const char *name, const char *ending, int width, int height)
{
    WrError err = { "" };
    char path[64];
    snprintf(path, sizeof path, "%s.%s", name, ending);
    if (!wr_session_render(s, path, width, height, NULL, 30, &err)) fail_msg("%s", err.text);
}

/* One row of strips per band, and several: in every format, with an odd end, for a picture that fits one band. */
static void files_by_bands_are_those_of_the_whole(void **state)
{
    (void)state;
    static const char *const scenes[][3] = {
        { "dials aa=supersample samples=2", NULL },
        { "dials aa=adaptive samples=4", "surface bezier", NULL },
        { "tolerance rms=0.01", NULL }, /* held in memory as a whole */
    };
    static const int sizes[][2] = { { 90, 331 }, { 133, 64 }, { 57, 65 } };
    WrPool *pool = wr_pool_new(2);
    for (int k = 0; k < 3; k++) {
        const int width = sizes[k][0], height = sizes[k][1];
        WrSession *whole = session_with(pool, 0, scenes[k]);
        WrSession *bands = session_with(pool, 1, scenes[k]);
        WrSession *more = session_with(pool, (size_t)(200 * width) * 16, scenes[k]);
        for (int i = 0; i < ENDINGS; i++) {
            char a[16], b[16];
            snprintf(a, sizeof a, "a.%s", endings[i]);
            snprintf(b, sizeof b, "b.%s", endings[i]);
            render(whole, "a", endings[i], width, height);
            render(bands, "b", endings[i], width, height);
            expect_same(a, b);
            render(more, "b", endings[i], width, height);
            expect_same(a, b);
        }
        wr_session_free(whole);
        wr_session_free(bands);
        wr_session_free(more);
    }
    wr_pool_free(pool);
}

/* ---- memory ---- */

/* Peak memory of this process since the last call, in bytes. */
static double most_held(void)
{
    FILE *file = fopen("/proc/self/status", "r");
    char line[256];
    double kilobytes = 0;
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, "VmHWM:", 6) == 0) kilobytes = strtod(line + 6, NULL);
    if (file) fclose(file);
    return 1024 * kilobytes;
}

static bool forget_most(void)
{
    const int fd = open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
    const bool good = fd >= 0 && write(fd, "5", 1) == 1;
    if (fd >= 0) close(fd);
    return good;
}

/* 64 million bytes as floats, 16 million as codes; a band is 4 million. */
static void a_large_picture_takes_the_memory_of_a_band(void **state)
{
    (void)state;
    if (SANITIZED) skip();
    static const char *const plain[] = { "surface plane", "dials aa=point", NULL };
    WrPool *pool = wr_pool_new(2);
    WrSession *s = session_with(pool, 4000000, plain);
    for (int i = 0; i < 3; i++) { /* memory of each library is allocated before */
        render(s, "small", endings[i], 1000, 300);
        if (!forget_most()) skip();
        const double before = most_held();
        render(s, "large", endings[i], 1000, 4000);
        const double more = most_held() - before;
        if (more > 16e6) fail_msg("%s: %.1f MB more", endings[i], more / 1e6);
    }
    wr_session_free(s);
    wr_pool_free(pool);
}

static WrImage *read_picture(const char *path)
{
    WrError err = { "" };
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

/* Cut anywhere, alone and together: pixels of files with 8 bits, with alpha, and with floats. */
static void rows_alone_are_those_of_the_whole(void **state)
{
    (void)state;
    static const char *const scenes[][3] = {
        { "dials aa=supersample samples=2", "background none", NULL },
        { "surface bezier", "dials aa=adaptive samples=4", NULL },
        { "tolerance rms=0.01", NULL },
    };
    static const int cuts[] = { 0, 1, 70, 71, 150, 211 };
    enum { WIDTH = 57, HEIGHT = 211 };
    WrPool *pool = wr_pool_new(2);
    for (int k = 0; k < 6; k++) {
        const char *ending = k < 3 ? "png" : "exr";
        WrSession *s = session_with(pool, k % 2, scenes[k % 3]);
        render(s, "whole", ending, WIDTH, HEIGHT);
        char path[16];
        snprintf(path, sizeof path, "whole.%s", ending);
        WrImage *whole = read_picture(path);
        snprintf(path, sizeof path, "part.%s", ending);
        for (size_t c = 0; c + 1 < sizeof cuts / sizeof *cuts; c++) {
            WrError err = { "" };
            const WrPictureRows rows = { cuts[c], cuts[c + 1] - cuts[c] };
            if (!wr_session_render(s, path, WIDTH, HEIGHT, &rows, 30, &err))
                fail_msg("%s", err.text);
            WrImage *part = read_picture(path);
            assert_true(part->width == WIDTH && part->height == rows.count &&
                        part->channels == whole->channels);
            const size_t row = (size_t)WIDTH * (size_t)part->channels;
            assert_memory_equal(part->data, whole->data + row * (size_t)rows.first,
                                row * (size_t)rows.count * sizeof *part->data);
            wr_image_free(part);
        }
        wr_image_free(whole);
        WrError err = { "" };
        const WrPictureRows beyond = { 200, 12 };
        assert_false(wr_session_render(s, path, WIDTH, HEIGHT, &beyond, 30, &err));
        assert_string_equal(err.text, "rows 200-211: the picture has rows 0 to 210");
        wr_session_free(s);
    }
    wr_pool_free(pool);
}

/* The whole would be 4.3 GB. */
static void a_tolerance_that_lacks_memory_tells_the_way_out(void **state)
{
    (void)state;
    if (SANITIZED) skip(); /* sanitizers reserve terabytes of addresses */
    static const char *const lines[] = { "tolerance rms=0.01", NULL };
    WrError err = { "" };
    struct rlimit was;
    WrSession *s = session_with(NULL, 0, lines);
    assert_int_equal(getrlimit(RLIMIT_AS, &was), 0);
    const struct rlimit now = { .rlim_cur = 4000000000, .rlim_max = was.rlim_max };
    assert_int_equal(setrlimit(RLIMIT_AS, &now), 0);
    const bool good = wr_session_render(s, "tolerant.png", 16384, 16384, NULL, 0, &err);
    assert_int_equal(setrlimit(RLIMIT_AS, &was), 0);
    assert_false(good);
    if (!strstr(err.text, "not enough memory for 4295 MB") || !strstr(err.text, "`tolerance off`"))
        fail_msg("%s", err.text);
    wr_session_free(s);
}

/* ---- giving up ---- */

typedef struct Stop {
    volatile int cancel;
    int reports, at; /* reports so far; the one to cancel at, 0: never */
    double last;
} Stop;

static void hear(void *ctx, double fraction)
{
    Stop *stop = ctx;
    if (!(fraction >= stop->last && fraction <= 1))
        fail_msg("report %d: %g after %g", stop->reports, fraction, stop->last);
    stop->last = fraction;
    if (++stop->reports == stop->at) __atomic_store_n(&stop->cancel, 1, __ATOMIC_RELAXED);
}

static int files_here(void)
{
    int count = 0;
    DIR *dir = opendir(".");
    for (struct dirent *e; (e = readdir(dir));)
        count += strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0;
    closedir(dir);
    return count;
}

/* Cancel at that report. Returns the number of reports. */
static int render_until(WrSession *s, const char *path, int at)
{
    WrError err = { "" };
    Stop stop = { .at = at };
    const WrProgress progress = { &stop.cancel, hear, &stop };
    const int files = files_here();
    wr_progress_set(&progress);
    const bool good = wr_session_render(s, path, 90, 700, NULL, 0, &err);
    wr_progress_set(NULL);
    if (stop.cancel && good) fail_msg("%s: went on at report %d", path, at);
    if (!good && !strstr(err.text, "cancelled")) fail_msg("%s: %s", path, err.text);
    if (!good && files_here() != files) fail_msg("%s: left a file at report %d", path, at);
    return stop.reports;
}

static void giving_up_leaves_nothing_and_progress_rises(void **state)
{
    (void)state;
    static const char *const lines[] = { "dials aa=supersample samples=2", NULL };
    WrPool *pool = wr_pool_new(2);
    WrSession *s = session_with(pool, 1, lines);
    for (int i = 0; i < 3; i++) {
        char path[32];
        snprintf(path, sizeof path, "stopped.%s", endings[i]);
        const int all = render_until(s, path, 0);
        assert_true(all > 20);
        if (remove(path) != 0) fail_msg("%s is not there", path);
        const int step = getenv("WR_FULL") ? 1 : all / 12;
        for (int at = 1; at < all; at += step) render_until(s, path, at);
    }
    wr_session_free(s);
    wr_pool_free(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_alone_are_those_of_the_whole),
        cmocka_unit_test(files_by_bands_are_those_of_the_whole),
        cmocka_unit_test(a_large_picture_takes_the_memory_of_a_band),
        cmocka_unit_test(a_tolerance_that_lacks_memory_tells_the_way_out),
        cmocka_unit_test(giving_up_leaves_nothing_and_progress_rises),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

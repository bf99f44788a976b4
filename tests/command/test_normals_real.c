/* test_normals_real.c - heights from realistic maps: the program's own exports of painted tables, and maps from
   central differences made here. Components that a map does not determine become 0, and flat ground stays flat. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/memory.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"

#define FLAT 0.45 /* fraction of the table, from its left border: empty ground */

/* Hills with grain, optionally with texel noise, to the right of flat ground. */
static WrField *ground(int w, int h, double rough)
{
    TestRandom random = { (uint64_t)(w * h) };
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            const double u = (i + 0.5) / w, v = (j + 0.5) / h, x = (u - 0.72) / 0.2;
            const double y = 0.5 - fabs(v - 0.5), fine = sin(40 * u + 11 * v) * cos(30 * v + u * 9);
            const double grain = rough * test_random(&random) + 0.004 * fine;
            if (u > FLAT && fabs(x) < 1)
                wr_field_set(field, i, j,
                             (float)((1 - x * x) * (1 - x * x) * (0.05 + 0.1 * y + grain)));
        }
    return field;
}

static void write_table(const WrField *field, const char *path)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    float *texels = wr_alloc((size_t)w * (size_t)h, sizeof *texels);
    WrError err;
    wr_field_read(field, 0, 0, w, h, texels, (size_t)w);
    if (!wr_image_write_pixels(path, w, h, 1, WR_PIXEL_F32, false, texels, &err))
        fail_msg("%s", err.text);
    wr_free(texels);
}

/* The program's export of the table with that scheme and depth. */
static void export_map(const WrField *field, const char *scheme, int depth)
{
    char line[200];
    write_table(field, "ground.exr");
    WrSession *s = session_of((const char *[]){ "image ground.exr", "bump height=1", NULL });
    wr_session_set_outputs(s, true);
    snprintf(line, sizeof line, "export normal+y map.png scheme=%s depth=%d", scheme, depth);
    must_run(s, line);
    wr_session_free(s);
}

/* The same by hand: central differences of the heights in memory, 8-bit codes. */
static void write_map(const WrField *field)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    uint8_t *codes = wr_alloc((size_t)w * (size_t)h, 3);
    WrError err;
    for (int k = 0; k < w * h; k++) {
        const int i = k % w, j = k / w;
        const double right = (double)wr_field_get(field, (i + 1) % w, j) -
                             (double)wr_field_get(field, (i + w - 1) % w, j);
        const double down = (double)wr_field_get(field, i, (j + 1) % h) -
                            (double)wr_field_get(field, i, (j + h - 1) % h);
        const double x = -0.5 * w * right, y = 0.5 * h * down, l = sqrt(x * x + y * y + 1);
        codes[3 * k] = (uint8_t)lrint(127.5 * (x / l + 1));
        codes[3 * k + 1] = (uint8_t)lrint(127.5 * (y / l + 1));
        codes[3 * k + 2] = (uint8_t)lrint(127.5 * (1 / l + 1));
    }
    if (!wr_image_write_pixels("map.png", w, h, 3, WR_PIXEL_U8, false, codes, &err))
        fail_msg("%s", err.text);
    wr_free(codes);
}

static WrSession *heights_of_map(int w, int h, const char *slopes)
{
    char line[200];
    snprintf(line, sizeof line, "table %dx%d", w, h);
    WrSession *s = session_of((const char *[]){ line, NULL });
    snprintf(line, sizeof line, "picture normals map.png y=up slopes=%s", slopes);
    must_run(s, line);
    return s;
}

/* RMS of the components cos(2 pi k i / W) and sin along rows. */
static double power(const WrField *f, int k, bool down)
{
    const int w = wr_field_width(f), h = wr_field_height(f), n = down ? h : w;
    double sum = 0;
    for (int line = 0; line < (down ? w : h); line++) {
        double c = 0, s = 0;
        for (int i = 0; i < n; i++) {
            const double z = wr_field_get(f, down ? line : i, down ? i : line);
            c += z * cos(2 * M_PI * k * i / n) / n;
            s += z * sin(2 * M_PI * k * i / n) / n;
        }
        sum += c * c + s * s;
    }
    return sqrt(sum / (down ? w : h));
}

/* The steepest cell of the flat ground in degrees, without its last 3 texels. */
static double steepest(const WrField *f)
{
    const int w = wr_field_width(f), h = wr_field_height(f);
    double worst = 0;
    for (int j = 0; j < h; j++)
        for (int i = 3; i < FLAT * w - 3; i++) {
            const double z = wr_field_get(f, i, j);
            const double a = w * ((double)wr_field_get(f, i + 1, j) - z);
            const double b = h * ((double)wr_field_get(f, i, (j + 1) % h) - z);
            worst = fmax(worst, atan(hypot(a, b)) * 180 / M_PI);
        }
    return worst;
}

/* Along that axis the highest bin is no higher than those before it: no comb. */
static void expect_no_comb(const WrField *f, bool down, const char *what)
{
    const int n = down ? wr_field_height(f) : wr_field_width(f), k = n / 2;
    const double before = fmax(power(f, k - 1, down), power(f, k - 2, down));
    const double last = power(f, k, down);
    if (last > 2 * before + 1e-9) fail_msg("%s: %g at bin %d, %g before it", what, last, k, before);
}

static const int sizes[][2] = { { 64, 48 }, { 63, 49 }, { 96, 31 }, { 33, 70 } };

/* Heights of map.png of a table of that size; none of them with a comb, and the ground as flat as stated. */
static void expect_heights(int w, int h, const char *slopes, double flat, const char *made)
{
    char what[120];
    snprintf(what, sizeof what, "%dx%d, %s, slopes=%s", w, h, made, slopes);
    WrSession *s = heights_of_map(w, h, slopes);
    const WrField *f = wr_document_field(doc(s));
    const double steep = steepest(f);
    expect_no_comb(f, false, what);
    expect_no_comb(f, true, what);
    if (!(steep < flat)) fail_msg("%s: flat ground leans by %g degrees", what, steep);
    wr_session_free(s);
}

/* An 8-bit code is half a degree of slope, a 16-bit one almost nothing. */
static void exported_tables_come_back_without_a_comb(void **state)
{
    (void)state;
    static const char *const schemes[] = { "central", "bilinear", "bspline-fit", "bspline" };
    for (int k = 0; k < 4 * 4 * 2; k++) {
        const int *size = sizes[k % 4], depth = k / 4 % 2 ? 16 : 8;
        const char *scheme = schemes[k / 8];
        char made[60];
        WrField *f = ground(size[0], size[1], 0);
        snprintf(made, sizeof made, "scheme=%s depth=%d", scheme, depth);
        export_map(f, scheme, depth);
        expect_heights(size[0], size[1], "auto", depth == 8 ? 0.6 : 0.3, made);
        expect_heights(size[0], size[1], "smooth", depth == 8 ? 0.6 : 0.3, made);
        wr_field_free(f);
    }
}

/* Made without this program's export. Texel noise has a component at the highest bin, which central differences
   contain: it is restored, and the ground beside it stays flat. */
static void maps_by_central_differences_keep_the_grain_that_they_tell_of(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        const int *size = sizes[k % 4];
        WrField *f = ground(size[0], size[1], k < 4 ? 0 : 0.02);
        write_map(f);
        expect_heights(size[0], size[1], "auto", k < 4 ? 0.6 : 2, k < 4 ? "own" : "own, rough");
        wr_field_free(f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exported_tables_come_back_without_a_comb),
        cmocka_unit_test(maps_by_central_differences_keep_the_grain_that_they_tell_of),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

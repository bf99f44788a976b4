/* test_cell_sheets.c - cells arranged for other programs: every texel of repeats, half-drops, bricks and atlases computed
   from the table's, hexagonal lattices and n + 1 samples against a formula, mip levels as files against recomputed
   means. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/memory.h"
#include "command/session.h"
#include "image/image.h"
#include "scene/scene.h"

#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

static const double turn = 6.283185307179586;

static WrSession *table_of(int width, int height, const char *more)
{
    const WrSessionOptions options = { .outputs = true };
    WrSession *s = wr_session_new(&options);
    char line[100];
    snprintf(line, sizeof line, "table %dx%d%s", width, height, more);
    must_run(s, line);
    must_run(s, "formula fourier terms=1,2,0.7,-54,0;3,0,0.2,-32.70422048691768,0");
    return s;
}

/* Random, so that no two texels are alike. */
static WrSession *random_table(int width, int height, const char *more)
{
    WrSession *s = table_of(width, height, more);
    must_run(s, "noise perlin cells=3 octaves=5 amplitude=2.3 seed=7 blend=add");
    return s;
}

static WrImage *picture(const char *path)
{
    WrError err;
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

static WrImage *exported(WrSession *s, const char *line, const char *path)
{
    char text[200];
    snprintf(text, sizeof text, line, path);
    must_run(s, text);
    return picture(path);
}

static float at(const WrImage *image, int i, int j, int c)
{
    return image->data[((size_t)j * (size_t)image->width + (size_t)i) * (size_t)image->channels +
                       (size_t)c];
}

/* ---- arrangements ---- */

typedef struct Lay {
    const char *options;
    int m, n;           /* number of tables horizontally and vertically */
    int roll_u, roll_v; /* of every second column or row, texels */
} Lay;

static float laid(const WrSession *s, const Lay *lay, int w, int h, int i, int j)
{
    i = (i % (lay->m * w) + lay->m * w) % (lay->m * w);
    j = (j % (lay->n * h) + lay->n * h) % (lay->n * h);
    const int a = lay->roll_u && j / h % 2 ? lay->roll_u : 0;
    const int b = lay->roll_v && i / w % 2 ? lay->roll_v : 0;
    return f_at(s, (i + a) % w, (j + b) % h);
}

static void every_texel_is_where_it_belongs(void **state)
{
    (void)state;
    enum { W = 22, H = 14 };
    static const Lay lays[] = {
        { "repeat=3x2", 3, 2, 0, 0 },
        { "lay=half-drop", 2, 1, 0, H / 2 },
        { "lay=brick", 1, 2, W / 2, 0 },
        { "lay=brick repeat=2x3", 2, 6, W / 2, 0 },
        { "lay=half-drop repeat=3x1", 6, 1, 0, H / 2 },
    };
    for (int k = 0; k < 5; k++) {
        const Lay *lay = &lays[k];
        WrSession *s = random_table(W, H, "");
        char line[120];
        snprintf(line, sizeof line, "export height %%s %s", lay->options);
        WrImage *image = exported(s, line, "h.exr");
        snprintf(line, sizeof line, "export slopes %%s scheme=central cell=3,5 %s", lay->options);
        must_run(s, "bump height=0.25");
        WrImage *slopes = exported(s, line, "s.exr");
        assert_true(image->width == lay->m * W && image->height == lay->n * H);
        for (int n = 0; n < image->width * image->height; n++) {
            const int i = n % image->width, j = n / image->width;
            assert_true(at(image, i, j, 0) == laid(s, lay, W, H, i, j));
            const double p = (double)(laid(s, lay, W, H, i + 1, j) - laid(s, lay, W, H, i - 1, j));
            const double q = (double)(laid(s, lay, W, H, i, j - 1) - laid(s, lay, W, H, i, j + 1));
            /* of a cell of the former size */
            assert_near(at(slopes, i, j, 0), 0.25 * p * W / 2 / 3, 2e-6);
            assert_near(at(slopes, i, j, 1), 0.25 * q * H / 2 / 5, 2e-6);
        }
        wr_image_free(image);
        wr_image_free(slopes);
        wr_session_free(s);
    }
}

static void what_cannot_be_laid_is_refused(void **state)
{
    (void)state;
    WrSession *s = random_table(21, 15, "");
    must_fail(s, "export height x.png lay=half-drop", "15 rows");
    must_fail(s, "export height x.png lay=brick", "21 columns");
    must_fail(s, "export height x.png lay=spiral", "half-drop");
    must_fail(s, "export height x.png repeat=1000x1", "21000x15");
    must_fail(s, "export height x.png repeat=0x1", "repeat");
    must_fail(s, "export height x.png resize=big", "resize");
    must_fail(s, "export height x.png atlas=one", "endings");
    must_fail(s, "export height x.png atlas=missing.png", "missing.png");
    must_fail(s, "export height x.png atlas=cell.wrinkle", "a document or a picture");
    must_fail(s, "export height x.png margin=-1", "margin");
    must_fail(s, "export height x.png border=on atlas=a.png", "border");
    must_run(s, "table 16x16 wrap=clamp-u");
    must_fail(s, "export height x.png lay=hex", "periodic");
    assert_int_equal(access("x.png", F_OK), -1);
    wr_session_free(s);
}

/* Tables of one and four texels. */
static void the_smallest_tables_are_laid_too(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 1, 1 }, { 2, 2 }, { 1, 2 }, { 2, 1 } };
    for (int k = 0; k < 4; k++) {
        WrSession *s = random_table(sizes[k][0], sizes[k][1], "");
        WrImage *image = exported(s, "export height %s repeat=3x2 border=on", "h.exr");
        assert_true(image->width == 3 * sizes[k][0] + 1 && image->height == 2 * sizes[k][1] + 1);
        wr_image_free(image);
        image = exported(s, "export height %s lay=hex", "h.exr");
        assert_int_equal(image->width, sizes[k][0]);
        wr_image_free(image);
        must_run(s, "export bump-slopes b.exr repeat=3x1");
        must_run(s, "export normal+y n.png mips=on");
        wr_session_free(s);
    }
}

/* ---- hexagons ---- */

/* F of the cell's own u, v; the rectangle of 1 by sqrt(3) has it at u = x - y/sqrt(3), v = 2y/sqrt(3). */
static void a_hexagonal_lattice_is_a_rectangle(void **state)
{
    (void)state;
    WrSession *s = table_of(112, 112, "");
    must_run(s, "cell 2,7"); /* its height is ignored: the lattice determines it */
    WrImage *image = exported(s, "export height %s lay=hex scheme=bspline-fit", "h.exr");
    assert_true(image->width == 112 && image->height == 194); /* 56 : 97 */
    for (int n = 0; n < 112 * 194; n++) {
        const double x = (n % 112 + 0.5) / 112, y = sqrt(3) * (1 - (n / 112 + 0.5) / 194);
        const double u = x - y / sqrt(3), v = 2 * y / sqrt(3);
        const double f =
            0.7 * sin(turn * (u + 0.1)) * cos(2 * turn * v) + 0.2 * sin(3 * turn * u + 1);
        assert_near(image->data[n], f, 2e-5);
    }
    /* the lattice's other point is in the middle */
    for (int n = 0; n < 112 * 97; n++)
        assert_near(at(image, n % 112, n / 112, 0),
                    at(image, (n % 112 + 56) % 112, n / 112 + 97, 0), 1e-6);
    assert_near(image->label.cell[1] / image->label.cell[0], sqrt(3), 1e-12);
    assert_near(image->label.cell[0], 2, 0);
    wr_image_free(image);
    wr_session_free(s);
}

/* ---- n + 1 ---- */

static void borders_are_shared_to_the_bit(void **state)
{
    (void)state;
    static const char *const schemes[] = { "nearest", "bilinear",    "central",
                                           "bspline", "bspline-fit", "catmull" };
    for (int k = 0; k < 6; k++) {
        WrSession *s = random_table(13, 10, "");
        static const char *const kinds[] = { "height", "normal+y", "slopes" };
        for (int m = 0; m < 3; m++) {
            char line[100];
            snprintf(line, sizeof line, "export %s %%s border=on scheme=%s", kinds[m], schemes[k]);
            WrImage *image = exported(s, line, "b.exr");
            assert_true(image->width == 14 && image->height == 11);
            for (int c = 0; c < image->channels; c++) {
                for (int i = 0; i < 14; i++) assert_true(at(image, i, 0, c) == at(image, i, 10, c));
                for (int j = 0; j < 11; j++) assert_true(at(image, 0, j, c) == at(image, 13, j, c));
            }
            if (m == 0 && k == 1) /* between four texels */
                for (int n = 0; n < 14 * 11; n++) {
                    const int i = n % 14, j = n / 14;
                    const double sum = (double)f_at(s, i % 13, j % 10) +
                                       (double)f_at(s, (i + 12) % 13, j % 10) +
                                       (double)f_at(s, i % 13, (j + 9) % 10) +
                                       (double)f_at(s, (i + 12) % 13, (j + 9) % 10);
                    assert_near(image->data[n], sum / 4, 1e-6);
                }
            wr_image_free(image);
        }
        wr_session_free(s);
    }
}

static void formulas_are_sampled_at_i_of_n(void **state)
{
    (void)state;
    WrSession *s = table_of(13, 10, "");
    must_run(s, "analytic fourier terms=1,0,0.731,20,0;0,2,0.4375,0,70");
    must_run(s, "bump height=0.5");
    must_run(s, "cell 2,3");
    WrImage *h = exported(s, "export height %s border=on", "h.exr");
    WrImage *p = exported(s, "export slopes %s border=on", "p.exr");
    WrImage *n = exported(s, "export normal+y %s border=on", "n.exr");
    for (int k = 0; k < 14 * 11; k++) {
        const double a = turn * (k % 14) / 13 + turn / 18;
        const double b = 2 * turn * (1 - (k / 14) / 10.0) + turn * 70 / 360;
        const double x = -0.5 * 0.731 * turn * sin(a) / 2,
                     y = -0.5 * 0.4375 * 2 * turn * sin(b) / 3;
        assert_near(h->data[k], 0.731 * cos(a) + 0.4375 * cos(b), 1e-6);
        assert_near(p->data[2 * k], x, 1e-6);
        assert_near(p->data[2 * k + 1], y, 1e-6);
        assert_near(n->data[3 * k], 0.5 - 0.5 * x / sqrt(1 + x * x + y * y), 1e-6);
    }
    wr_image_free(h), wr_image_free(p), wr_image_free(n);
    wr_session_free(s);
}

/* ---- sizes and levels ---- */

static void powers_of_two_are_the_nearest(void **state)
{
    (void)state;
    static const int sizes[][4] = { { 100, 90, 128, 64 },
                                    { 91, 181, 128, 128 },
                                    { 23, 182, 32, 256 } };
    for (int k = 0; k < 3; k++) {
        WrSession *s = table_of(sizes[k][0], sizes[k][1], "");
        WrImage *image = exported(s, "export height %s resize=pot", "h.exr");
        assert_true(image->width == sizes[k][2] && image->height == sizes[k][3]);
        for (int n = 0; n < image->width * image->height; n++) {
            const double u = (n % image->width + 0.5) / image->width;
            const double v = 1 - (n / image->width + 0.5) / image->height;
            const double f =
                0.7 * sin(turn * (u + 0.1)) * cos(2 * turn * v) + 0.2 * sin(3 * turn * u + 1);
            assert_near(image->data[n], f, 0.01); /* Lanczos' third lobe */
        }
        wr_image_free(image);
        wr_session_free(s);
    }
}

/* [i n/m, (i + 1) n/m) within [a, a + 1) */
static double part(int n, int m, int i, int a)
{
    const double x = (double)n / m;
    return fmax(0.0, fmin((i + 1) * x, a + 1) - fmax(i * x, a)) / x;
}

static void levels_are_files_of_means(void **state)
{
    (void)state;
    static const int widths[] = { 21, 10, 5, 2, 1 }, heights[] = { 12, 6, 3, 1, 1 };
    WrSession *s = random_table(21, 12, "");
    WrImage *above = exported(s, "export height %s mips=on sidecar=on", "m.exr");
    for (int k = 1; k < 5; k++) {
        char path[20];
        snprintf(path, sizeof path, "m_%d.exr", k);
        WrImage *image = picture(path);
        assert_true(image->width == widths[k] && image->height == heights[k]);
        for (int n = 0; n < image->width * image->height; n++) {
            double sum = 0;
            for (int m = 0; m < above->width * above->height; m++)
                sum += part(above->width, image->width, n % image->width, m % above->width) *
                       part(above->height, image->height, n / image->width, m / above->width) *
                       (double)above->data[m];
            assert_near(image->data[n], sum, 1e-6);
        }
        wr_image_free(above);
        above = image;
    }
    wr_image_free(above);
    assert_int_equal(access("m_5.exr", F_OK), -1);
    /* each sidecar describes its own file */
    assert_int_equal(
        system("for k in m m_1 m_2 m_3 m_4; do "
               "grep -q \"$(sha256sum <$k.exr | cut -d' ' -f1)\" $k.exr.json || exit 1; done"),
        0);
    /* codes mean the same heights in all of them */
    static const char *const ranges[] = { "auto", "signed" };
    for (int r = 0; r < 2; r++) {
        char line[80];
        snprintf(line, sizeof line, "export height %%s mips=on range=%s", ranges[r]);
        WrImage *first = exported(s, line, "c.png"), *third = picture("c_3.png");
        assert_true(first->label.low == third->label.low &&
                    first->label.step == third->label.step &&
                    first->label.zero == third->label.zero);
        wr_image_free(first);
        wr_image_free(third);
    }
    wr_session_free(s);
}

static void levels_come_together_or_not_at_all(void **state)
{
    (void)state;
    WrSession *s = random_table(301, 300, "");
    struct rlimit old, small;
    getrlimit(RLIMIT_FSIZE, &old);
    small = old;
    small.rlim_cur = 100000;
    WrError err = { "" };
    must_run(s, "export height l.r16"); /* 180 kB, so the limit holds for the numbers alone */
    assert_int_equal(system("sha256sum l.r16 l.r16.json >before"), 0);
    must_run(s, "fill 3");
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    const bool good = wr_session_run(s, "export height l.r16 mips=on", &err);
    setrlimit(RLIMIT_FSIZE, &old);
    signal(SIGXFSZ, handler);
    assert_false(good);
    assert_int_equal(system("sha256sum --status -c before"), 0);
    assert_int_equal(system("ls -A | grep -q -e l_1 -e part"), 256);
    wr_session_free(s);
}

/* ---- atlases ---- */

static void cells_stand_side_by_side_in_their_own_margins(void **state)
{
    (void)state;
    enum { PAD = 3 };
    WrSession *s[3] = { random_table(20, 14, ""), random_table(9, 31, ""),
                        random_table(25, 8, " wrap=clamp") };
    must_run(s[1], "adjust offset du=3 dv=4");
    must_run(s[1], "export height one.png range=-5,5");
    must_run(s[2], "save two.exr");
    WrImage *image = exported(s[0], "export height %s atlas=one.png;two.exr margin=3", "a.exr");
    const int wide = 25 + 2 * PAD, high = 31 + 2 * PAD;
    assert_true(image->width == 2 * wide && image->height == 2 * high);
    for (int k = 0; k < 3; k++) {
        const WrField *f = wr_document_field(doc(s[k]));
        const int w = wr_field_width(f), h = wr_field_height(f);
        for (int j = -PAD; j < h + PAD; j++)
            for (int i = -PAD; i < w + PAD; i++) {
                const int a = k == 2 ? (i < 0 ? 0 : i >= w ? w - 1 : i) : (i + w) % w;
                const int b = k == 2 ? (j < 0 ? 0 : j >= h ? h - 1 : j) : (j + h) % h;
                const float have = at(image, k % 2 * wide + i + PAD, k / 2 * high + j + PAD, 0);
                assert_near(have, f_at(s[k], a, b), k == 1 ? 10.0 / 65535 / 2 + 1e-6 : 0);
            }
    }
    wr_image_free(image);
    WrError err;
    WrImageFile *file = wr_image_file_open("a.exr", &err);
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:atlas"),
                        "3,3,20,14;34,3,9,31;3,40,25,8");
    wr_image_file_close(file);
    for (int k = 0; k < 3; k++) wr_session_free(s[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_texel_is_where_it_belongs),
        cmocka_unit_test(what_cannot_be_laid_is_refused),
        cmocka_unit_test(the_smallest_tables_are_laid_too),
        cmocka_unit_test(a_hexagonal_lattice_is_a_rectangle),
        cmocka_unit_test(borders_are_shared_to_the_bit),
        cmocka_unit_test(formulas_are_sampled_at_i_of_n),
        cmocka_unit_test(powers_of_two_are_the_nearest),
        cmocka_unit_test(levels_are_files_of_means),
        cmocka_unit_test(levels_come_together_or_not_at_all),
        cmocka_unit_test(cells_stand_side_by_side_in_their_own_margins),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

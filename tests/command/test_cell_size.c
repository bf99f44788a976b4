/* test_cell_size.c - physical size of the unit cell: stored in documents, scripts and undo; written to exported files
   and read from them; used by normals and solids. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "command/session.h"
#include "image/image.h"
#include "scene/scene.h"

#include <math.h>

static const char size_line[] = "cell 123.25,80.5 mm=on height=2.375";
static const char table[] = "noise perlin cells=3 octaves=4 amplitude=2.3 level=-1.1 seed=5";

static WrSession *sized(Said *said, const char *first)
{
    WrSession *s = listening(said);
    must_run(s, first);
    must_run(s, table);
    must_run(s, size_line);
    return s;
}

static void assert_size(const WrSession *s, double w, double h, bool mm, double height)
{
    const WrCellSize *cell = &doc(s)->scene->cell;
    assert_true(cell->w == w && cell->h == h && cell->mm == mm && cell->height == height);
}

static void documents_scripts_and_undo_keep_it(void **state)
{
    (void)state;
    static const char *const files[] = { "a.exr", "a.ora", "a.wrinkle" };
    Said said;
    WrSession *s = sized(&said, "table 45x62");
    must_run(s, "layer add");
    must_run(s, "save a.exr");
    must_run(s, "save a.ora");
    must_run(s, "script a.wrinkle");
    for (int k = 0; k < 3; k++) {
        WrError err;
        WrSession *back = wr_session_new(NULL);
        if (!wr_session_open(back, files[k], &err)) fail_msg("%s", err.text);
        assert_size(back, 123.25, 80.5, true, 2.375);
        wr_session_free(back);
    }
    must_run(s, "cell 2,1 mm=off");
    assert_size(s, 2, 1, false, 2.375);
    must_run(s, "undo");
    assert_size(s, 123.25, 80.5, true, 2.375);
    must_fail(s, "cell 0,1", "0");
    must_fail(s, "cell 1,nan", "nan");
    must_fail(s, "cell 1,1 height=-2", "-2");
    wr_session_free(s);
}

/* Every file format that stores it, loaded into a document of another size, wrap and cell. */
static void files_tell_it_and_it_is_taken_from_them(void **state)
{
    (void)state;
    static const char *const lines[][2] = {
        { "export height h.png range=-3,4", "image h.png" },
        { "export height h.tif", "image h.tif" },
        { "export height h.exr", "image h.exr" },
        { "export normal+y n.png", "image n.png" },
        { "export normal-y n.exr", "image n.exr" },
    };
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        Said said, other;
        WrSession *s = sized(&said, "table 45x62 wrap=clamp-v"), *back = listening(&other);
        must_run(s, lines[k][0]);
        must_run(back, lines[k][1]);
        assert_size(back, 123.25, 80.5, true, 2.375);
        assert_int_equal(wr_field_wrap_u(wr_document_field(doc(back))), WR_WRAP_PERIODIC);
        assert_int_equal(wr_field_wrap_v(wr_document_field(doc(back))), WR_WRAP_CLAMP);
        assert_non_null(strstr(other.text, "123.25 x 80.5 mm"));
        wr_session_free(back);
        /* resampled into the table, or an invalid label: the size is not used */
        back = listening(&other);
        char line[80];
        snprintf(line, sizeof line, "%s fit=table", lines[k][1]);
        must_run(back, line);
        snprintf(line, sizeof line, "%s labels=ignore", lines[k][1]);
        must_run(back, line);
        assert_size(back, 1, 1, false, 1);
        assert_int_equal(wr_field_wrap_v(wr_document_field(doc(back))), WR_WRAP_PERIODIC);
        wr_session_free(back);
        wr_session_free(s);
    }
}

/* n = (-h Fu / W, -h Fv / H, 1) of F = a cos 2 pi u + b cos(2 pi v + 90 degrees), in millimetres. */
static void normals_are_as_steep_as_the_millimetres_say(void **state)
{
    (void)state;
    const double a = 0.731, b = 0.4375, w = 12.25, h = 8.5, high = 2.375;
    Said said;
    WrSession *s = listening(&said);
    must_run(s, "table 37x26");
    must_run(s, "analytic fourier terms=1,0,0.731;0,1,0.4375,0,90");
    must_run(s, "bump height=0.01"); /* ignored */
    must_run(s, "cell 12.25,8.5 mm=on height=2.375");
    must_run(s, "export normal+y n.exr");
    WrError err;
    WrImage *image = wr_image_read("n.exr", &err);
    assert_non_null(image);
    assert_true(image->label.sized && image->label.mm && image->label.height == high);
    for (int k = 0; k < 37 * 26; k++) {
        const double u = (k % 37 + 0.5) / 37, v = 1 - (k / 37 + 0.5) / 26, turn = 2 * acos(-1);
        double fu, fv;
        wr_scene_height(doc(s)->scene, NULL, u, v, NULL, &fu, &fv);
        const double own_u = -a * turn * sin(turn * u),
                     own_v = -b * turn * sin(turn * v + turn / 4);
        assert_near(fu, 0.01 * own_u, 1e-12); /* check of the phase's meaning */
        assert_near(fv, 0.01 * own_v, 1e-12);
        const double p = high * own_u / w, q = high * own_v / h, n = sqrt(1 + p * p + q * q);
        const float *c = image->data + 3 * k;
        assert_near(c[0], 0.5 - 0.5 * p / n, 1e-7);
        assert_near(c[1], 0.5 - 0.5 * q / n, 1e-7);
        assert_near(c[2], 0.5 + 0.5 / n, 1e-7);
    }
    wr_image_free(image);
    wr_session_free(s);
}

static void a_plane_of_cells_is_as_wide_as_they_are(void **state)
{
    (void)state;
    Said said;
    WrSession *s = listening(&said);
    must_run(s, "table 32x32");
    must_run(s, "surface plane");
    must_run(s, "dab 0.5,0.5 radius=6 strength=1.5");
    must_run(s, "replicate 3,3");
    must_run(s, "cell 12.5,12.5 mm=on height=2");
    must_run(s, "export stl a.stl error=0.01");
    assert_non_null(strstr(said.text, "37.5 x 37.5 x 5 mm")); /* 2 mm under 1.5 times 2 */
    must_run(s, "export stl a.stl size=80 error=0.5");
    assert_non_null(strstr(said.text, "80 x 80 x"));
    wr_session_free(s);
}

static uint16_t grey = 777;

static bool one_code(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)y, (void)err;
    for (int k = 0; k < 2 * rows; k++) ((uint16_t *)out)[k] = *(const uint16_t *)ctx;
    return true;
}

static void sizes_that_make_no_sense_are_not_taken(void **state)
{
    (void)state;
    static const char *const wrong[][3] = { { "0,1", "mm", "1" },     { "1e99,1", "mm", "1" },
                                            { "3", "mm", "1" },       { "3,4", "mm", "-1" },
                                            { "3,4", "mm", "nan" },   { "3,4", "inch", "1" },
                                            { "nan,4", "scene", "1" } };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        const WrImageAttribute says[] = { { "wrinkle:kind", "height" },
                                          { "wrinkle:cell", wrong[k][0] },
                                          { "wrinkle:unit", wrong[k][1] },
                                          { "wrinkle:height", wrong[k][2] } };
        const WrImageOut out = { .width = 2,
                                 .height = 3,
                                 .channels = 1,
                                 .type = WR_PIXEL_U16,
                                 .attributes = says,
                                 .attribute_count = 4,
                                 .data = true,
                                 .rows = one_code,
                                 .ctx = &grey };
        WrError err;
        Said said;
        if (!wr_image_write("wrong.png", &out, 1, &err)) fail_msg("%s", err.text);
        WrSession *s = listening(&said);
        must_run(s, "image wrong.png");
        if (!strstr(said.text, "is invalid")) fail_msg("%zu: %s", k, said.text);
        assert_size(s, 1, 1, false, 1);
        wr_session_free(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(documents_scripts_and_undo_keep_it),
        cmocka_unit_test(files_tell_it_and_it_is_taken_from_them),
        cmocka_unit_test(normals_are_as_steep_as_the_millimetres_say),
        cmocka_unit_test(a_plane_of_cells_is_as_wide_as_they_are),
        cmocka_unit_test(sizes_that_make_no_sense_are_not_taken),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

/* UDIM tiles: `surface mesh udim=`, baking of one tile and of all, names of maps and of files that are read. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "image/image.h"
#include "scene/scene.h"
#include "surface/triangles.h"
#include "system/path.h"

#include <math.h>

static void write_text(const char *path, const char *text)
{
    WrError err;
    if (!wr_file_write(path, text, strlen(text), &err)) fail_msg("%s", err.text);
}

/* Three rectangles side by side, from x = 0, 1 and 2 to 4, y of 0 to 1: on tiles 1002, 1001 and 1015, that is columns
   1, 0, 4 and rows 0, 0, 1. Their (u,v) are the left 3/4 of each tile. */
static const int left[4] = { 0, 1, 2, 4 }, columns[3] = { 1, 0, 4 }, rows[3] = { 0, 0, 1 };
static const int numbers[3] = { 1002, 1001, 1015 };

static void write_low(const char *path)
{
    WrText text = { 0 };
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 4; k++) {
            const int x = k == 1 || k == 2, y = k > 1;
            wr_text_addf(&text, "v %d %d 0\nvt %g %d\n", left[i + x], y, columns[i] + 0.75 * x,
                         rows[i] + y);
        }
        wr_text_addf(&text, "f %d/%d %d/%d %d/%d %d/%d\n", 4 * i + 1, 4 * i + 1, 4 * i + 2,
                     4 * i + 2, 4 * i + 3, 4 * i + 3, 4 * i + 4, 4 * i + 4);
    }
    write_text(path, wr_text_get(&text));
    wr_text_fini(&text);
}

static double height_at(double x, double y)
{
    return 0.1 * x + 0.05 * y + 0.02;
}

/* The plane z = height_at(x, y), larger than the rectangles. */
static void write_high(const char *path)
{
    WrText text = { 0 };
    for (int k = 0; k < 4; k++) {
        const int x = k == 1 || k == 2 ? 6 : -2, y = k > 1 ? 3 : -2;
        wr_text_addf(&text, "v %d %d %.9g\n", x, y, height_at(x, y));
    }
    wr_text_add(&text, "f 1 2 3 4\n");
    write_text(path, wr_text_get(&text));
    wr_text_fini(&text);
}

static WrSession *with_low(Said *said)
{
    write_low("low.obj");
    write_high("high.obj");
    WrSession *s = listening(said);
    must_run(s, "table 32x16");
    must_run(s, "surface mesh file=low.obj");
    return s;
}

/* ---- the tile of the object ---- */

static void the_other_tiles_have_no_coordinates(void **state)
{
    (void)state;
    Said said;
    WrError err = { "" };
    WrSession *s = with_low(&said);
    assert_non_null(
        strstr(said.text, "UDIM tiles and their triangles: 1001 (2), 1002 (2), 1015 (2)"));
    const uint64_t whole = doc(s)->scene->triangles->key;
    must_run(s, "surface mesh udim=1015");
    assert_non_null(strstr(said.text, "tile 1015 shows the table, the others have no relief"));
    const WrTriangles *mesh = doc(s)->scene->triangles;
    assert_int_equal(mesh->triangle_count, 6);
    for (int i = 0; i < mesh->corner_count; i++) {
        const WrTriangleCorner *c = &mesh->corners[i];
        const bool there = c->u != 0 || c->v != 0;
        if (there) assert_true(c->p[0] >= 2 && c->u >= 4 && c->v >= 1);
        if (c->p[0] > 2) assert_true(there);
    }
    const WrHash is = wr_session_hash(s);
    must_run(s, "save d.exr");
    must_run(s, "surface mesh tile=1001"); /* another name of the argument */
    assert_false(wr_hash_equal(wr_session_hash(s), is));
    must_run(s, "surface mesh udim=all");
    assert_true(doc(s)->scene->triangles->key == whole);
    must_run(s, "undo");
    must_run(s, "undo");
    assert_true(wr_hash_equal(wr_session_hash(s), is));
    assert_int_equal(unlink("low.obj"), 0);
    if (!wr_session_open(s, "d.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(s), is));
    assert_int_equal(doc(s)->scene->projection.udim, 1015);
    must_run(s, "surface mesh udim=1002"); /* the whole mesh is in the document */
    must_run(s, "surface mesh projection=box");
    assert_int_equal(doc(s)->scene->projection.udim, 0);
    must_run(s, "surface mesh projection=uv");
    assert_true(doc(s)->scene->triangles->key == whole);
    wr_session_free(s);
}

static void wrong_tiles_are_refused(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_low(&said);
    must_fail(s, "surface mesh udim=1003",
              "no triangle of the mesh is on tile 1003; triangles on others: 1001 (2), 1002 (2)");
    must_fail(s, "surface mesh udim=999", "must be all, or a tile's number, 1001..9999");
    must_fail(s, "surface mesh projection=box udim=1001", "needs projection=uv");
    must_fail(s, "bake-tiles high.obj flat.exr",
              "the mesh has 3 tiles: the file name needs <UDIM>");
    must_fail(s, "bake-tiles high.obj flat.<UDIM>.xyz", "xyz");
    must_fail(s, "export height h.<UDIM>.exr", "the object has no tile");
    must_fail(s, "maps blender . udim=12", "must be none, or a tile's number");
    must_fail(s, "image none.<UDIM>.exr", "no file has such a name");
    write_text("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    must_fail(s, "surface mesh file=bare.obj udim=1001", "no texture coordinates");
    write_text("left.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt -1 0.5\nvt -0.5 0.5\nvt -0.5 0.9\n"
                           "f 1/1 2/2 3/3\n");
    must_fail(s, "surface mesh file=left.obj udim=1001", "or on any other: u must be 0 to 10");
    must_run(s, "surface sphere");
    must_fail(s, "surface mesh udim=1001", "the object has no mesh");
    wr_session_free(s);
}

/* ---- baking ---- */

/* Height of the plane over a texel of a tile, in units of `unit`. */
static double want_at(int square, int x, int y, int w, int h, double unit)
{
    const double u = (x + 0.5) / w, v = 1 - (y + 0.5) / h;
    return height_at(left[square] + (left[square + 1] - left[square]) * u / 0.75, v) / unit;
}

static WrImage *picture(const char *format, int number)
{
    char path[40];
    WrError err = { "" };
    snprintf(path, sizeof path, format, number);
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

static void bake_takes_the_objects_tile(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_low(&said);
    must_run(s, "bump height=0.5");
    must_run(s, "surface mesh udim=1002");
    must_run(s, "bake high.obj padding=3");
    assert_non_null(strstr(said.text, "tile 1002, distances"));
    assert_non_null(strstr(said.text, "384 texels, none missed")); /* 24 x 16 */
    assert_null(strstr(said.text, "all are baked into one picture"));
    for (int j = 0; j < 16; j++) {
        for (int i = 0; i < 24; i++)
            assert_near((double)f_at(s, i, j), want_at(0, i, j, 32, 16, 0.5), 1e-6);
        assert_true(f_at(s, 26, j) > 0);
        assert_near((double)f_at(s, 27, j), 0, 0); /* beyond the padding ... */
        assert_near((double)f_at(s, 31, j), 0, 0); /* ... which does not come round from u = 0 */
    }
    must_run(s, "surface mesh udim=all");
    must_run(s, "bake high.obj");
    assert_non_null(strstr(said.text, "the mesh has 3 UDIM tiles, and all are baked into one"));
    wr_session_free(s);
}

/* F = 0.1 cos(2 pi u) with height 0.5; u rises by 3/4 over a width of 1, or of 2. */
static void baked_normals_are_of_the_objects_tile(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_low(&said);
    must_run(s, "analytic fourier terms=1,0,0.1");
    must_run(s, "bump mode=blinn height=0.5");
    for (int t = 0; t < 3; t++) {
        char line[60];
        snprintf(line, sizeof line, "surface mesh udim=%d", numbers[t]);
        must_run(s, line);
        must_run(s, "export normal-baked baked.<UDIM>.exr padding=0");
        WrImage *image = picture("baked.%d.exr", numbers[t]);
        for (int i = 0; i < 32; i++) {
            const double du = 0.75 / (left[t + 1] - left[t]), u = (i + 0.5) / 32;
            const double slope = -0.5 * 0.1 * 2 * M_PI * sin(2 * M_PI * u) * du;
            const double want = i < 24 ? -slope / sqrt(1 + slope * slope) : 0;
            assert_near(2 * (double)image->data[3 * (32 * 5 + i)] - 1, want, 1e-6);
        }
        wr_image_free(image);
    }
    wr_session_free(s);
}

/* Files of all tiles by the plane's formula; integer heights have one range. */
static void bake_tiles_writes_all(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_low(&said);
    const double length = sqrt(0.1 * 0.1 + 0.05 * 0.05 + 1);
    const double normal[3] = { -0.1 / length, -0.05 / length, 1 / length };
    must_run(s, "bump height=-0.5");
    must_run(s, "surface mesh udim=1002"); /* all are baked nevertheless */
    const WrHash before = wr_session_hash(s);
    must_run(s, "bake-tiles high.obj h.<UDIM>.exr size=24x20 padding=0");
    must_run(s, "bake-tiles high.obj h.<UDIM>.png size=24x20 padding=0");
    must_run(s, "bake-tiles high.obj n_<UDIM>.png map=normal size=24x20 padding=0");
    assert_true(wr_hash_equal(wr_session_hash(s), before));
    for (int t = 0; t < 3; t++) {
        WrImage *exr = picture("h.%d.exr", numbers[t]), *png = picture("h.%d.png", numbers[t]);
        WrImage *normals = picture("n_%d.png", numbers[t]);
        assert_int_equal(exr->label.kind, WR_LABEL_HEIGHT);
        assert_int_equal(normals->label.green, 1);
        assert_near(png->label.low + png->label.step * 65535, 0, 1e-9); /* uncovered texels */
        assert_near(png->label.low, want_at(2, 17, 0, 24, 20, -0.5), 1e-6);
        assert_true(wr_image_apply_range(png));
        for (int j = 0; j < 20; j++)
            for (int i = 0; i < 24; i++) {
                const double want = i < 18 ? want_at(t, i, j, 24, 20, -0.5) : 0;
                const float *n = &normals->data[3 * (24 * j + i)];
                assert_near((double)exr->data[24 * j + i], want, 1e-6);
                assert_near((double)png->data[24 * j + i], want, 1e-5);
                for (int k = 0; k < 3; k++)
                    assert_near(2 * (double)n[k] - 1, i < 18 ? normal[k] : k == 2, 4e-5);
            }
        wr_image_free(exr);
        wr_image_free(png);
        wr_image_free(normals);
    }
    wr_session_free(s);
}

/* A tile without a hit is an error, and no file of the others remains. */
static void bake_tiles_writes_all_or_none(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_low(&said);
    write_text("short.obj", "v -1 -1 0\nv 1.5 -1 0\nv 1.5 2 0\nv -1 2 0\nf 1 2 3 4\n");
    must_fail(s, "bake-tiles short.obj q.<UDIM>.png map=normal cage=0.1",
              "none of 384 rays hit a front face");
    assert_false(wr_path_is_there("q.1001.png"));
    wr_session_free(s);
}

typedef struct Stop {
    volatile int cancel;
    int reports, at;
} Stop;

static void count_report(void *ctx, double fraction)
{
    Stop *stop = ctx;
    assert_true(fraction >= 0 && fraction <= 1);
    if (++stop->reports == stop->at) stop->cancel = 1;
}

static void check_cancelled(WrSession *s, const char *line)
{
    bool good = false;
    int at = 0;
    while (!good) {
        WrError err = { "" };
        Stop stop = { .at = ++at };
        const WrProgress progress = { &stop.cancel, count_report, &stop };
        wr_progress_set(&progress);
        good = wr_session_run(s, line, &err);
        wr_progress_set(NULL);
        if (good) break;
        assert_non_null(strstr(err.text, "cancelled"));
        for (int t = 0; t < 3; t++) {
            char path[40];
            snprintf(path, sizeof path, "c.%d.exr", numbers[t]);
            assert_false(wr_path_is_there(path));
        }
    }
    assert_true(at > 10);
    assert_int_equal(unlink("c.1001.exr") | unlink("c.1002.exr") | unlink("c.1015.exr"), 0);
}

/* Cancelled at any report, no tile has a file. */
static void bake_tiles_is_cancelled(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_low(&said);
    check_cancelled(s, "bake-tiles high.obj c.<UDIM>.exr map=normal samples=2");
    check_cancelled(s, "bake-tiles high.obj c.<UDIM>.exr");
    wr_session_free(s);
}

/* ---- names ---- */

static void maps_have_the_tiles_number(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_low(&said);
    must_run(s, "grid cells=4x4");
    must_run(s, "maps unreal . name=plain");
    assert_true(wr_path_is_there("T_plain_N.png"));
    must_run(s, "surface mesh udim=1015");
    must_run(s, "maps unreal . name=rock contact=all.png");
    assert_true(wr_path_is_there("T_rock_N.1015.png") && wr_path_is_there("T_rock_H.1015.png"));
    assert_false(wr_path_is_there("T_rock_N.png"));
    assert_non_null(strstr(said.text, "the range is this tile's"));
    said.text[0] = '\0';
    must_run(s, "maps unreal . name=rock udim=1020 range=0,1");
    assert_true(wr_path_is_there("T_rock_H.1020.png"));
    assert_null(strstr(said.text, "the range is this tile's"));
    must_run(s, "maps unreal . name=rock udim=none");
    assert_true(wr_path_is_there("T_rock_N.png"));
    must_run(s, "export height rock_<UDIM>_h.exr");
    assert_true(wr_path_is_there("rock_1015_h.exr"));
    must_fail(s, "maps unreal . name=rock contact=T_rock_N.1015.png", "is the name of one of");
    wr_session_free(s);
}

/* The object's tile, else the first; the others are noted. */
static void pictures_are_read_by_tile(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_low(&said);
    for (int t = 0; t < 3; t++) {
        char line[60];
        snprintf(line, sizeof line, "fill %g", 0.25 + 0.125 * t);
        must_run(s, line);
        snprintf(line, sizeof line, "export height in.%d.exr", numbers[t]);
        must_run(s, line);
    }
    said.text[0] = '\0';
    must_run(s, "image in.<UDIM>.exr");
    assert_near((double)f_at(s, 3, 4), 0.375, 0);
    assert_non_null(strstr(said.text, "in.1001.exr: tile 1001; there are also 1002, 1015"));
    assert_non_null(strstr(wr_session_last_command(s), "in.1001.exr")); /* replays do not search */
    must_run(s, "surface mesh udim=1015");
    must_run(s, "image in.<UDIM>.exr");
    assert_near((double)f_at(s, 3, 4), 0.5, 0);
    said.text[0] = '\0';
    must_run(s, "image in.1002.exr");
    assert_near((double)f_at(s, 3, 4), 0.25, 0);
    assert_non_null(strstr(said.text, "in.1002.exr: tile 1002; there are also 1001, 1015"));
    must_run(s, "layer add high");
    must_run(s, "colour in.<UDIM>.exr");
    assert_string_equal(doc(s)->scene->colour_laid.path, "in.1015.exr");
    assert_int_equal(unlink("in.1015.exr"), 0);
    must_fail(s, "image in.<UDIM>.exr fit=table",
              "no file of the object's tile 1015; there are 1001, 1002");
    must_run(s, "surface mesh udim=1001");
    assert_int_equal(unlink("in.1002.exr"), 0);
    said.text[0] = '\0';
    must_run(s, "image in.<UDIM>.exr fit=table"); /* the only one */
    assert_string_equal(said.text, "");
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_other_tiles_have_no_coordinates),
        cmocka_unit_test(wrong_tiles_are_refused),
        cmocka_unit_test(bake_takes_the_objects_tile),
        cmocka_unit_test(baked_normals_are_of_the_objects_tile),
        cmocka_unit_test(bake_tiles_writes_all),
        cmocka_unit_test(bake_tiles_writes_all_or_none),
        cmocka_unit_test(bake_tiles_is_cancelled),
        cmocka_unit_test(maps_have_the_tiles_number),
        cmocka_unit_test(pictures_are_read_by_tile),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

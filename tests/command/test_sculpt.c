/* The commands `sculpt` and `project`: a dab by its distance over the faces of a mesh, alike on both sides of a seam of (u,v), not
   through walls, not on faces turned away; against strokes on the table where the mesh is flat; replay and errors. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "base/text.h"
#include "brush/brush.h"
#include "command/session.h"
#include "document/document.h"
#include "scene/scene.h"

#include <math.h>

#define SIDE 80 /* texels of an island */
#define GAP 100 /* between the beginnings of two */

static void write_text(const char *path, const char *text)
{
    WrError err;
    if (!wr_file_write(path, text, strlen(text), &err)) fail_msg("%s", err.text);
}

/* A box of islands of SIDE x SIDE texels in a table of 3 GAP x 2 GAP: the front, the right side, the back, the left,
   top and bottom. Texel (i, j) of an island is i to the right and j down, seen from outside. */
enum { FRONT, RIGHT, BACK };

static const double box_faces[6][9] = {
    { 0, 0, 1, 1, 0, 0, 0, 1, 0 },  { 1, 0, 0, 0, 0, -1, 0, 1, 0 }, { 0, 0, -1, -1, 0, 0, 0, 1, 0 },
    { -1, 0, 0, 0, 0, 1, 0, 1, 0 }, { 0, 1, 0, 1, 0, 0, 0, 0, -1 }, { 0, -1, 0, 1, 0, 0, 0, 0, 1 },
};

static void write_box(const char *path, double depth, int cells)
{
    WrText text = { 0 };
    const double size[3] = { 1, 1, depth };
    for (int f = 0; f < 6; f++) {
        const double *n = box_faces[f];
        for (int k = 0; k < (cells + 1) * (cells + 1); k++) {
            const double s = (double)(k % (cells + 1)) / cells,
                         t = (double)(k / (cells + 1)) / cells;
            wr_text_add(&text, "v");
            for (int c = 0; c < 3; c++)
                wr_text_addf(&text, " %.9g",
                             size[c] * (n[c] + (2 * s - 1) * n[3 + c] + (2 * t - 1) * n[6 + c]));
            wr_text_addf(&text, "\nvt %.9g %.9g\n", (f % 3 * GAP + 10 + SIDE * s) / (3 * GAP),
                         1 - (f / 3 * GAP + 10 + SIDE * (1 - t)) / (2 * GAP));
        }
        for (int k = 0; k < cells * cells; k++) {
            const int p = f * (cells + 1) * (cells + 1) + k / cells * (cells + 1) + k % cells + 1;
            const int q[4] = { p, p + 1, p + cells + 2, p + cells + 1 };
            wr_text_addf(&text, "f %d/%d %d/%d %d/%d %d/%d\n", q[0], q[0], q[1], q[1], q[2], q[2],
                         q[3], q[3]);
        }
    }
    write_text(path, wr_text_get(&text));
    wr_text_fini(&text);
}

static WrSession *with_mesh(Said *said, const char *table, const char *mesh)
{
    WrSession *s = listening(said);
    must_run(s, table);
    must_run(s, mesh);
    said->text[0] = '\0';
    return s;
}

static WrSession *with_box(Said *said, double depth, int cells)
{
    write_box("box.obj", depth, cells);
    return with_mesh(said, "table 300x200", "surface mesh file=box.obj");
}

static double island(const WrSession *s, int face, int i, int j)
{
    return (double)f_at(s, face % 3 * GAP + 10 + i, face / 3 * GAP + 10 + j);
}

/* The dab's height by the straight distance in space, in texels; the middle of the box is 0,0,0. */
static double expected(int face, int i, int j, const double centre[3], double radius)
{
    const double *n = box_faces[face], s = (2 * i + 1.0) / SIDE - 1, t = 1 - (2 * j + 1.0) / SIDE;
    WrBrush brush = wr_brush_default();
    double d2 = 0;
    brush.radius = radius;
    for (int c = 0; c < 3; c++) d2 += pow(n[c] + s * n[3 + c] + t * n[6 + c] - centre[c], 2);
    return 0.7 * wr_brush_coverage(&brush, sqrt(d2) * SIDE / 2);
}

static void a_dab_on_an_edge_is_the_same_on_both_islands(void **state)
{
    (void)state;
    for (int cells = 1; cells <= 7; cells += 3) {
        Said said;
        WrSession *s = with_box(&said, 1, cells);
        const double centre[3] = { 1, 0.13, 1 };
        double edge = 0, flat = 0;
        must_run(s, "sculpt points=1,0.13,1 radius=17 strength=0.7");
        for (int j = 0; j < SIDE; j++)
            for (int i = 0; i < SIDE; i++) {
                const double f = island(s, FRONT, i, j);
                assert_near(f, expected(FRONT, i, j, centre, 17), 1e-5);
                assert_near(f, island(s, RIGHT, SIDE - 1 - i, j), 1e-5);
                edge += f + island(s, RIGHT, i, j);
            }
        /* Interpolation at the border reads two texels more, which continue the face. */
        assert_near(island(s, FRONT, SIDE + 1, 35), expected(FRONT, SIDE + 1, 35, centre, 17),
                    1e-5);
        assert_true(island(s, FRONT, SIDE + 1, 35) > 0.3 && island(s, FRONT, SIDE + 2, 35) == 0);
        must_run(s, "undo");
        must_run(s, "sculpt points=0.013,0.13,1 radius=17 strength=0.7");
        for (int k = 0; k < SIDE * SIDE; k++) flat += island(s, FRONT, k % SIDE, k / SIDE);
        assert_near(edge / flat, 1, 2e-3); /* the volume of the middle's */
        assert_string_equal(said.text, "");
        wr_session_free(s);
    }
}

static void a_wall_is_not_painted_through(void **state)
{
    (void)state;
    for (int cells = 1; cells <= 7; cells += 3) {
        Said said;
        WrSession *s = with_box(&said, 0.03, cells); /* 0.06 thick; its rim has texels too */
        must_run(s, "sculpt points=0.8,0.1,0.03 radius=24 strength=0.7");
        double rim = 0, far = 0;
        for (int k = 0; k < SIDE * SIDE; k++) {
            /* beyond a tenth of the width, next to the rim */
            if (k % SIDE >= 8) far = fmax(far, island(s, BACK, k % SIDE, k / SIDE));
            rim = fmax(rim, island(s, RIGHT, k % SIDE, k / SIDE));
        }
        assert_true(rim > 0.1 && far == 0);
        assert_true(island(s, FRONT, 71, 35) > 0.69);
        wr_session_free(s);
    }
}

static void faces_turned_away_from_the_eye_stay(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_box(&said, 1, 3);
    const double centre[3] = { 1, 0.13, 1 };
    must_run(s, "sculpt points=1,0.13,1 radius=17 strength=0.7 eye=0.2,0.1,9");
    for (int k = 0; k < SIDE * SIDE; k++) {
        const int i = k % SIDE, j = k / SIDE;
        assert_near(island(s, FRONT, i, j), expected(FRONT, i, j, centre, 17), 1e-5);
        assert_true(island(s, RIGHT, i, j) == 0);
    }
    wr_session_free(s);
}

/* ---- a flat mesh ---- */

static const char flat[] =
    "v 0 0 0\nv 1.5 0 0\nv 1.5 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

/* Relief first, so that modes have something to change. */
static WrSession *with_flat(Said *said)
{
    write_text("flat.obj", flat);
    WrSession *s = with_mesh(said, "table 192x128", "surface mesh file=flat.obj");
    must_run(s, "noise perlin cells=6 rows=4 seed=5 amplitude=0.3");
    return s;
}

/* Largest and mean difference of the two strokes. */
static void compare(const char *brush, double *most, double *mean)
{
    Said said;
    char line[300];
    WrSession *a = with_flat(&said), *b = with_flat(&said);
    snprintf(line, sizeof line, "stroke points=0.25,0.3;0.7,0.62,0.8;0.45,0.75 %s", brush);
    must_run(a, line);
    snprintf(line, sizeof line, "sculpt points=0.375,0.3,0;1.05,0.62,0,0.8;0.675,0.75,0 %s", brush);
    must_run(b, line);
    *most = *mean = 0;
    for (int k = 0; k < 192 * 128; k++) {
        const double d =
            fabs((double)f_at(a, k % 192, k / 192) - (double)f_at(b, k % 192, k / 192));
        *most = fmax(*most, d);
        *mean += d / (192 * 128);
    }
    wr_session_free(a);
    wr_session_free(b);
}

static void on_a_flat_mesh_dabs_are_those_of_the_table(void **state)
{
    (void)state;
    const char *const brushes[] = { "radius=14 flow=0.3", "radius=9 buildup=on mode=lower",
                                    "radius=14 aspect=3 angle=30 jitter=0.5,20,0.5 seed=4",
                                    "radius=12 aspect=2 follow=on mode=flatten flow=0.9",
                                    "radius=15 pressure=size mode=to to=0.2" };
    for (int i = 0; i < (int)(sizeof brushes / sizeof *brushes); i++) {
        double most, mean;
        compare(brushes[i], &most, &mean);
        if (!(most < 2e-5)) fail_msg("%s: %g", brushes[i], most);
    }
}

/* Without spacing on the table; on a mesh dabs, a tenth of the radius apart. Moving modes work on another grid. */
static void on_a_flat_mesh_other_strokes_are_nearly_those_of_the_table(void **state)
{
    (void)state;
    const char *const brushes[] = { "radius=14 strength=0.4", "radius=14 mode=smooth",
                                    "radius=14 mode=level",   "radius=14 mode=pinch",
                                    "radius=14 mode=smear",   "radius=14 mode=erode" };
    for (int i = 0; i < (int)(sizeof brushes / sizeof *brushes); i++) {
        double most, mean;
        compare(brushes[i], &most, &mean);
        if (!(mean < 1.5e-3 && most < 0.08)) fail_msg("%s: %g, mean %g", brushes[i], most, mean);
    }
}

/* ---- moving modes across a seam ---- */

/* A step of height 1 at the edge: by symmetry the front loses at each place as much as the side gains. */
static void smoothing_exchanges_heights_across_a_seam(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_box(&said, 1, 2);
    must_run(s, "select rect from=0,0.5 to=0.33333333,1");
    must_run(s, "fill 1");
    must_run(s, "select all");
    for (int k = 0; k < 4; k++)
        must_run(s, "sculpt points=1,0.0125,1;1,0.1,1 radius=12 reach=2 mode=smooth");
    for (int k = 0; k < 5; k++) {
        const double f = island(s, FRONT, SIDE - 1 - k, 37), g = island(s, RIGHT, k, 37);
        assert_near(f + g, 1, 0.02);
        assert_true(g > 0.05 && g < 0.5);
    }
    assert_true(island(s, FRONT, SIDE - 1 - 20, 37) == 1 && island(s, RIGHT, 20, 37) == 0);
    wr_session_free(s);
}

/* ---- projection of a layer ---- */

/* A square of 2 x 2 in the plane z = 0, and one of 0.6 x 0.6 before it at z = 1; islands of 80 and 60 texels. */
static const char screens[] =
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -0.3 -0.3 1\nv 0.3 -0.3 1\nv 0.3 0.3 1\nv -0.3 0.3 "
    "1\n"
    "vt 0.1 0.15\nvt 0.36666667 0.15\nvt 0.36666667 0.55\nvt 0.1 0.55\n"
    "vt 0.6 0.2\nvt 0.8 0.2\nvt 0.8 0.5\nvt 0.6 0.5\nf 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n";

/* Heights (s - 0.1) / 0.8 between s = 0.1 and 0.9. */
static WrSession *with_screens(Said *said)
{
    write_text("screens.obj", screens);
    WrSession *s = with_mesh(said, "table 300x200", "surface mesh file=screens.obj");
    must_run(s, "ramp linear from=0.1,0.5 to=0.9,0.5");
    return s;
}

static double slope(double s)
{
    return fmin(1, fmax(0, (s - 0.1) / 0.8));
}

static float relief(const WrSession *s, int i, int j)
{
    return wr_field_get(doc(s)->layers[1].heights, i, j);
}

static void a_layer_is_projected_onto_what_the_eye_sees(void **state)
{
    (void)state;
    for (int parallel = 0; parallel < 2; parallel++) {
        Said said;
        WrSession *s = with_screens(&said);
        /* 3 wide and 2 high at z = 0, 3 from the eye: there as large as it is, at z = 1 two thirds of it, but */
        const double near = parallel ? 1 : 1.5; /* all of it by parallel rays */
        must_run(s, parallel
                        ? "project 1 eye=0,0,3 at=0,0,0 width=3 strength=0.5 parallel=on into=new"
                        : "project 1 eye=0,0,3 at=0,0,0 width=3 strength=0.5 into=new");
        assert_true(doc(s)->layer_count == 2 && doc(s)->active == 1);
        assert_true(!doc(s)->layers[0].visible && doc(s)->layers[1].visible);
        for (int j = 2; j < 78; j++)
            for (int i = 2; i < 78; i++) {
                const double x = (i + 0.5) / 40 - 1, y = 1 - (j + 0.5) / 40;
                const double edge = fmax(fabs(x), fabs(y)) - 0.3 * near;
                const double f = (double)relief(s, 30 + i, 90 + j);
                if (edge > 0.03) assert_near(f, 0.5 * slope((x + 1.5) / 3), 2e-3);
                if (edge < -0.03) assert_true(f == 0); /* in the shadow of the other */
            }
        for (int j = 0; j < 60; j++)
            for (int i = 0; i < 60; i++) {
                const double x = 0.3 * ((i + 0.5) / 30 - 1);
                assert_near((double)relief(s, 180 + i, 100 + j), 0.5 * slope((x * near + 1.5) / 3),
                            2e-3);
            }
        assert_true(relief(s, 5, 5) == 0);
        wr_session_free(s);
    }
}

/* The right side is seen at 86 degrees: asin(0.5 / 7). */
static void a_projection_fades_where_faces_turn_away(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_box(&said, 1, 2);
    must_run(s, "fill 1");
    must_run(s, "layer add relief");
    must_run(s, "layer set 1 visible=off");
    must_run(s, "project 1 eye=1.5,0,7 at=0,0,0 width=40 strength=0.5");
    const double x = 0.5 / 7 / 0.17; /* of 10 degrees */
    assert_near(island(s, FRONT, 40, 40), 0.5, 1e-6);
    assert_near(island(s, RIGHT, 40, 40), 0.5 * x * x * (3 - 2 * x), 0.01);
    assert_true(island(s, BACK, 40, 40) == 0);
    wr_session_free(s);
}

static void a_projection_that_meets_nothing_is_an_error(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_screens(&said);
    must_fail(s, "project 1 eye=0,0,-3 at=0,0,0 width=3", "nothing of the layer hits the mesh");
    must_fail(s, "project 1 eye=0,0,3 at=0,0,3 width=3", "define no view");
    must_fail(s, "project 1 eye=0,0,3 at=0,0,0 up=0,0,2 width=3", "define no view");
    must_fail(s, "project none eye=0,0,3 at=0,0,0 width=3", "none");
    must_fail(s, "project 1 eye=0,0,3 at=0,0,0 width=3 mode=smooth",
              "moves heights along the path");
    must_run(s, "surface plane");
    must_fail(s, "project 1 eye=0,0,3 at=0,0,0 width=3", "not a mesh");
    wr_session_free(s);
}

/* ---- mirrors ---- */

/* Largest difference between an island and another one, read from right to left. */
static double unlike(const WrSession *s, int face, int other)
{
    double most = 0;
    for (int j = -1; j <= SIDE; j++)
        for (int i = -1; i <= SIDE; i++)
            most = fmax(most, fabs(island(s, face, i, j) - island(s, other, SIDE - 1 - i, j)));
    return most;
}

/* The dab is a slanted ellipse, so that a copy that is only moved or turned differs. */
#define SLANTED "aspect=2.7 angle=31 radius=13 hardness=0.4 strength=0.8"
#define PATH "points=0.31,0.12,1,0.6;0.62,0.47,1,1 "

static void mirrors_draw_it_on_the_other_side(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_box(&said, 1, 3), *alone = with_box(&said, 1, 3);
    must_run(alone, "sculpt " PATH SLANTED);
    assert_true(unlike(alone, FRONT, FRONT) > 0.3);
    must_run(s, "sculpt " PATH SLANTED " mirror_axes=x");
    assert_true(unlike(s, FRONT, FRONT) < 1e-5);
    assert_float_equal(island(s, FRONT, 57, 31), island(alone, FRONT, 57, 31), 1e-6);
    assert_true(island(alone, FRONT, 57, 31) > 0.1);
    must_run(s, "undo");
    /* The eye is mirrored too: the back is towards its image. */
    must_run(s, "sculpt " PATH SLANTED " mirror_axes=xz eye=0.3,0.2,6");
    assert_true(unlike(s, FRONT, FRONT) < 1e-5 && unlike(s, FRONT, BACK) < 1e-5);
    assert_true(island(s, BACK, 57, 31) > 0.1);
    wr_session_free(s);
    wr_session_free(alone);
}

static void moved_heights_stay_as_in_a_mirror(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_box(&said, 1, 3), *alone = with_box(&said, 1, 3);
    must_run(s, "sculpt " PATH SLANTED " mirror_axes=x");
    must_run(alone, "sculpt " PATH SLANTED " mirror_axes=x");
    const double before = island(s, FRONT, 60, 25);
    must_run(s, "sculpt mode=smear points=0.3,0.1,1;0.51,0.4,1;0.6,0.7,1 radius=9 mirror_axes=x");
    must_run(alone, "sculpt mode=smear points=0.3,0.1,1;0.51,0.4,1;0.6,0.7,1 radius=9");
    assert_true(unlike(alone, FRONT, FRONT) > 0.02);
    assert_true(unlike(s, FRONT, FRONT) < 1e-5);
    assert_true(fabs(island(s, FRONT, 60, 25) - before) > 0.01);
    wr_session_free(s);
    wr_session_free(alone);
}

static void a_mirrored_dab_beside_the_mesh_is_left_out(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_box(&said, 1, 3), *alone = with_box(&said, 1, 3);
    must_run(alone, "sculpt points=0.31,0.12,1 radius=13");
    must_run(s, "sculpt points=0.31,0.12,1 radius=13 mirror_axes=x mirror_at=2,0,0");
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(alone)));
    must_run(s, "undo");
    must_run(s, "sculpt points=0.31,0.12,1 radius=13 mirror_axes=x mirror_at=0.5,0,0");
    assert_float_equal(island(s, FRONT, 67, 35), island(s, FRONT, 52, 35), 1e-5);
    assert_true(island(s, FRONT, 67, 35) > 0.05);
    wr_session_free(s);
    /* A square from 3 to 4, away from the origin: mirrored about its own centre. */
    write_text("far.obj", "v 3 0 0\nv 4 0 0\nv 4 1 0\nv 3 1 0\nvt 0.1 0.1\nvt 0.9 0.1\n"
                          "vt 0.9 0.9\nvt 0.1 0.9\nf 1/1 2/2 3/3 4/4\n");
    s = with_mesh(&said, "table 100x100", "surface mesh file=far.obj");
    must_run(s, "sculpt points=3.2,0.4,0 radius=8 mirror_axes=x");
    assert_float_equal(f_at(s, 25, 57), f_at(s, 74, 57), 1e-5);
    assert_true(f_at(s, 25, 57) > 0.05);
    wr_session_free(s);
    wr_session_free(alone);
}

/* ---- modes that look around ---- */

/* Two squares of 80 x 80 texels side by side, in one island; or the right one in another, a quarter turn on. */
static void write_strip(const char *path, bool split)
{
    WrText text = { 0 };
    for (int k = 0; k < 8; k++) {
        const double x = k / 4 + (k % 4 == 1 || k % 4 == 2), y = k % 4 > 1;
        const bool turned = split && k > 3;
        wr_text_addf(&text, "v %g %g 0\nvt %.9g %.9g\n", x, y,
                     (turned ? 10 + 80 * y : 10 + 80 * x) / 200,
                     (turned ? 110 + 80 * (2 - x) : 10 + 80 * y) / 200);
    }
    wr_text_add(&text, "f 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n");
    write_text(path, wr_text_get(&text));
    wr_text_fini(&text);
}

/* The height at texel (a, b) of the strip, from its left and lower side. */
static double strip(const WrSession *s, bool split, int a, int b)
{
    return split && a > 79 ? (double)f_at(s, 10 + b, a - 70) : (double)f_at(s, 10 + a, 189 - b);
}

static void targets_are_found_across_a_seam(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "sculpt mode=dilate reach=6 points=0.95,0.4,0;1.04,0.62,0 radius=15 hardness=0.7",
        "sculpt mode=erode reach=4 points=0.97,0.41,0;1.05,0.6,0 radius=17 hardness=0.6",
        "sculpt mode=sharpen reach=5 points=0.96,0.4,0;1.02,0.63,0 radius=16 strength=0.8",
    };
    Said said;
    write_strip("whole.obj", false);
    write_strip("split.obj", true);
    WrSession *whole = with_mesh(&said, "table 200x200", "surface mesh file=whole.obj");
    WrSession *parts = with_mesh(&said, "table 200x200", "surface mesh file=split.obj");
    const char *relief = "sculpt points=1.06,0.47,0;1.1,0.7,0 radius=11 strength=0.7";
    must_run(whole, relief);
    must_run(parts, relief);
    for (int k = 0; k < 3; k++) {
        double most = 0, change = 0, before[80];
        for (int b = 0; b < 80; b++) before[b] = strip(whole, false, 77, b);
        must_run(whole, lines[k]);
        must_run(parts, lines[k]);
        for (int b = 0; b < 80; b++) {
            change = fmax(change, fabs(strip(whole, false, 77, b) - before[b]));
            for (int a = 40; a < 120; a++)
                most = fmax(most, fabs(strip(whole, false, a, b) - strip(parts, true, a, b)));
        }
        assert_true(change > 0.05);
        assert_true(most < 0.25 * change);
        must_run(whole, "undo");
        must_run(parts, "undo");
    }
    wr_session_free(whole);
    wr_session_free(parts);
}

/* ---- the command ---- */

static void shared_texels_are_noted_once(void **state)
{
    (void)state;
    Said said;
    write_text(
        "twins.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 3 0 0\nv 4 0 0\nv 4 1 0\nv 3 1 0\nvt 0.1 0.1\n"
        "vt 0.9 0.1\nvt 0.9 0.9\nvt 0.1 0.9\nf 1/1 2/2 3/3 4/4\nf 5/1 6/2 7/3 8/4\n");
    WrSession *s = with_mesh(&said, "table 64x64", "surface mesh file=twins.obj");
    must_run(s, "sculpt points=3.4,0.5,0 radius=5");
    assert_non_null(strstr(said.text, "texels of the stroke belong to several places of the mesh"));
    said.text[0] = '\0';
    must_run(s, "sculpt points=0.4,0.5,0 radius=5");
    assert_string_equal(said.text, "");
    wr_session_free(s);
}

static void a_stroke_by_samples_is_repeated_by_its_line(void **state)
{
    (void)state;
    Said said;
    WrError err;
    WrSession *s = with_box(&said, 1, 3), *again = with_box(&said, 1, 3);
    const WrSample samples[] = { { .p = { 0.21234567891, 0.1, 1 }, .pressure = 0.4 },
                                 { .p = { 0.9, 0.123456789, 1 }, .pressure = 1 },
                                 { .p = { 1, 0.2, 0.4 }, .pressure = 0.75 } };
    const WrHash before = wr_session_hash(s);
    assert_true(wr_session_stroke_begin(s, "sculpt radius=9 eye=4,3,5", &err));
    assert_true(wr_session_stroke_add(s, samples, 3, &err));
    assert_true(wr_session_stroke_end(s, &err));
    const char *line = wr_session_last_command(s);
    assert_non_null(strstr(line, "points=0.2123457,0.1,1,0.4;0.9,0.1234568,1;1,0.2,0.4,0.75"));
    must_run(again, line);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    must_run(s, "undo");
    assert_true(wr_hash_equal(wr_session_hash(s), before));
    wr_session_free(s);
    wr_session_free(again);
}

/* The window prepares the mesh before the first stroke. */
static void a_prepared_mesh_gives_the_same_stroke(void **state)
{
    (void)state;
    static const char line[] = "sculpt points=0.3,0.1,1;1,0.37,0.2 radius=11 eye=4,3,5";
    Said said;
    WrError err;
    WrSession *s = with_box(&said, 1, 3), *again = with_box(&said, 1, 3);
    const WrTriangles *mesh = wr_session_document(s)->scene->triangles;
    assert_true(wr_session_mesh_needs_preparing(s));
    assert_null(wr_session_mesh_tree(s, mesh));
    const WrHash before = wr_session_hash(s);
    assert_true(wr_session_prepare_mesh(s, &err));
    assert_true(wr_hash_equal(wr_session_hash(s), before));
    assert_false(wr_session_mesh_needs_preparing(s));
    const WrRayTree *tree = wr_session_mesh_tree(s, mesh);
    assert_non_null(tree);
    must_run(s, line);
    must_run(again, line);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    assert_false(wr_session_mesh_needs_preparing(again));
    must_run(s, "replicate 2,1");
    assert_true(wr_session_mesh_needs_preparing(s));
    assert_true(wr_session_prepare_mesh(s, &err));
    assert_ptr_equal(wr_session_mesh_tree(s, mesh), tree);
    must_run(s, "surface sphere");
    assert_false(wr_session_mesh_needs_preparing(s));
    wr_session_free(s);
    wr_session_free(again);
}

static void cancelled_it_changes_nothing(void **state)
{
    (void)state;
    Said said;
    WrError err = { "" };
    WrSession *s = with_box(&said, 1, 3);
    const WrHash before = wr_session_hash(s);
    volatile int cancel = 1;
    const WrProgress progress = { .cancel = &cancel };
    must_run(s, "sculpt points=0,0,1");
    must_run(s, "undo");
    wr_progress_set(&progress);
    assert_false(wr_session_run(s, "sculpt points=1,0.13,1;0.5,0.1,1;-1,0,0.3", &err));
    wr_progress_set(NULL);
    assert_non_null(strstr(err.text, "cancelled"));
    assert_true(wr_hash_equal(wr_session_hash(s), before));
    wr_session_free(s);
}

static void errors_name_the_cause_and_the_remedy(void **state)
{
    (void)state;
    Said said;
    WrSession *s = with_box(&said, 1, 1);
    must_fail(s, "sculpt points=0,0", "each tuple must be x,y,z");
    must_fail(s, "sculpt points=0,0,1 mirror=u", "leave them out on a mesh");
    must_fail(s, "sculpt points=0,0,1 mode=clone", "mode=clone needs source=");
    must_run(s, "surface sphere");
    must_fail(s, "sculpt points=0,0,1", "paint on its table with `stroke`");
    write_text("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    must_run(s, "surface mesh file=bare.obj");
    must_fail(s, "sculpt points=0,0,1", "no texture coordinates to paint on");
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_dab_on_an_edge_is_the_same_on_both_islands,
                                        enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(a_wall_is_not_painted_through, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(faces_turned_away_from_the_eye_stay, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(on_a_flat_mesh_dabs_are_those_of_the_table,
                                        enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(on_a_flat_mesh_other_strokes_are_nearly_those_of_the_table,
                                        enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(smoothing_exchanges_heights_across_a_seam, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(a_layer_is_projected_onto_what_the_eye_sees,
                                        enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(a_projection_fades_where_faces_turn_away, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(a_projection_that_meets_nothing_is_an_error,
                                        enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(shared_texels_are_noted_once, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(a_stroke_by_samples_is_repeated_by_its_line,
                                        enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(mirrors_draw_it_on_the_other_side, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(moved_heights_stay_as_in_a_mirror, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(a_mirrored_dab_beside_the_mesh_is_left_out,
                                        enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(targets_are_found_across_a_seam, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(a_prepared_mesh_gives_the_same_stroke, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(cancelled_it_changes_nothing, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(errors_name_the_cause_and_the_remedy, enter_own_folder,
                                        leave_own_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

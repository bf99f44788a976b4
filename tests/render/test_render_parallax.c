/* Parallax: visibility against closed forms, against the displaced surface and against the reference; conditions
   under which it is skipped; special cases. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "render/kernels/kern.h"
#include "render/plan/plan.h"
#include "scene/objects.h"

/* Waves a few texels long, slopes up to `most` per period. */
static WrField *wavy_field(int w, int h)
{
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            const double x = 2 * WR_PI * (i + 0.31) / w, y = 2 * WR_PI * (j + 0.77) / h;
            wr_field_set(field, i, j,
                         (float)(0.37 + sin(2 * x + 0.4) * cos(3 * y) + 0.31 * cos(4 * x - y)));
        }
    return field;
}

static WrScene *parallax_of(const char *surface, double height)
{
    WrScene *scene = scene_of(surface);
    scene->parallax = true;
    scene->height = height;
    return scene;
}

/* ---- closed forms ---- */

#define STEP_SIDE 211

/* A plateau of height c behind a step at y = 0, seen from (0, y, z) along a column of pixels, computed by hand:
   visible part of its top, its wall, or the ground. */
static double step_seen(double eye_y, double eye_z, double c, double dir_y, double dir_z)
{
    const double ground = eye_y - eye_z * dir_y / dir_z;
    const double top = eye_y + (c - eye_z) * dir_y / dir_z;
    if (eye_y < 0) return top >= 0 ? top : ground >= 0 ? 0 : ground;
    return top >= 0 ? top : ground;
}

static void a_step_hides_what_is_behind_it(void **state)
{
    (void)state;
    static const double eyes[][2] = { { -1.37, 1.13 }, { 1.19, 1.47 } };
    const double c = 0.1173;
    WrField *field = wr_field_new(8, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 2; j < 32; j++) /* 1/2 < v < 31/32: a periodic table is level at its seam */
        for (int i = 0; i < 8; i++) wr_field_set(field, i, j, 1.0f);
    for (int k = 0; k < 2; k++) {
        WrScene *scene = parallax_of("plane", c);
        scene->still = true;
        scene->replicate_u = scene->replicate_v = 1;
        scene->scheme = WR_SCHEME_NEAREST;
        look_from(scene, 0, eyes[k][0], eyes[k][1]);
        Shot shot = shoot(scene, field, STEP_SIDE, STEP_SIDE, 1, "auto", false);
        assert_true(shot.frame.plan->rows[WR_EFFECT_PARALLAX].ran);
        const double y = eyes[k][0], z = eyes[k][1], away = hypot(y, z);
        const double half = tan(scene->camera.fov_deg * WR_PI / 360);
        const double up_y = z / away, up_z = -y / away;
        int seen = 0, walls = 0;
        for (int row = 0; row < STEP_SIDE; row++) {
            const double t = half * (1 - (row + 0.5) * 2 / STEP_SIDE);
            const double want = step_seen(y, z, c, -y / away + t * up_y, -z / away + t * up_z);
            double u, v;
            int face;
            if (want < -0.49 || want > 0.46) continue;
            if (!wr_renderer_pick(shot.renderer, STEP_SIDE / 2 + 0.5, row + 0.5, &u, &v, &face))
                fail_msg("eye %d, row %d: nothing, not %g", k, row, want + 0.5);
            seen++, walls += want == 0;
            if (fabs(v - 0.5 - want) > 2e-4)
                fail_msg("eye %d, row %d: %g, not %g", k, row, v, want + 0.5);
        }
        assert_true(seen > 50 && (k == 1 || walls > 3));
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* A plane at distance d that faces the eye and is raised by c grows by d / (d - c); lowering works in the same
   way. */
static void a_raised_plane_comes_nearer(void **state)
{
    (void)state;
    static const double rise[] = { 0.4173, -0.5311 };
    const double d = 2.9, f = 150.5 / tan(35 * WR_PI / 360);
    for (int k = 0; k < 2; k++) {
        WrField *field = level_field(37, 22, rise[k]);
        WrScene *scene = parallax_of("plane", 1);
        scene->still = true;
        look_from(scene, 0, 0, d);
        Shot shot = shoot(scene, field, 301, 301, 1, "auto", false);
        assert_near(sqrt((double)shot.frame.covered), f / (d - rise[k]), 1);
        put_away(&shot);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* A sphere with height c everywhere is a sphere of radius R + c, and a tube accordingly: compared are the coverage of
   each pixel, also outside the base's silhouette, and the shading. */
static void a_raised_ball_is_a_larger_ball(void **state)
{
    (void)state;
    static const double rise[] = { 0.2137, -0.0311, 0.0173, -0.41 };
    for (int k = 0; k < 8; k++) {
        const double c = rise[k / 2], d = 4.1;
        const bool tube = k % 2;
        WrField *field = level_field(37, 22, c);
        WrScene *scene = parallax_of(tube ? "cylinder" : "sphere", 1);
        look_from(scene, 0.31, tube ? 1.9 : 0.2, d);
        scene->dials.shading = k < 4 ? WR_SHADING_FLOAT : WR_SHADING_DOUBLE;
        WrScene *plain = wr_scene_clone(scene);
        plain->parallax = false, plain->bump = WR_BUMP_NONE, plain->height = 0;
        plain->shape.value[0] += c;
        plain->camera.fit = scene->camera.fit = false;
        Shot got = shoot(scene, field, 211, 201, 2, "auto", false);
        Shot want = shoot(plain, field, 211, 201, 2, "auto", false);
        int off = 0;
        for (int i = 0; i < 211 * 201 * 4; i++)
            off += fabsf(got.frame.rgba[i] - want.frame.rgba[i]) > 2e-3f;
        print_message("%s of %g: %d numbers are off\n", tube ? "tube" : "ball", c, off);
        assert_true(want.frame.covered > 900 && off <= 8);
        put_away(&got), put_away(&want);
        wr_scene_free(scene), wr_scene_free(plain);
        wr_field_free(field);
    }
}

/* ---- beside the surface itself ---- */

/* RMS difference where both pictures are opaque; and number of pixels whose coverage differs by over a half. */
static double apart(const Shot *a, const Shot *b, int *outline)
{
    double sum = 0;
    int count = 0;
    *outline = 0;
    const int pixels = a->frame.width * a->frame.height;
    for (int k = 0; k < pixels; k++) {
        const float *p = a->frame.rgba + 4 * k, *q = b->frame.rgba + 4 * k;
        *outline += fabsf(p[3] - q[3]) > 0.5f;
        if (p[3] < 1 || q[3] < 1) continue;
        count++;
        for (int c = 0; c < 3; c++) sum += pow((double)p[c] - (double)q[c], 2) / 3;
    }
    return sqrt(sum / count);
}

typedef struct Case {
    const char *surface;
    double height, turn; /* about x, degrees */
    WrScheme scheme;
    bool jagged;  /* random heights */
    double most;  /* largest remaining fraction of the bump error */
    int outlines; /* pixels; below 0: the base's silhouette */
} Case;

/* kind 0: bump, 1: parallax, 2: displaced. */
static Shot shape_of(const Case *at, int kind, const WrField *field)
{
    WrScene *scene = parallax_of(at->surface, at->height);
    wr_scene_hold_camera(scene, scene, 160.0 / 131); /* the same camera for all three */
    scene->parallax = kind == 1, scene->displaced = kind == 2;
    scene->bump = WR_BUMP_EXACT;
    scene->scheme = at->scheme;
    scene->dials.dice = 0.0625;
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ at->turn, 11, 23 };
    Shot shot = shoot(scene, field, 160, 131, 2, "auto", false);
    wr_scene_free(scene);
    return shot;
}

/* On a plane rays meet the same relief, edges included, also from behind and where a spline overshoots. On curved
   bases the remaining error is of third order, largest where u and v are stretched, as at a pole. */
static void it_is_the_displaced_surface(void **state)
{
    (void)state;
    static const Case cases[] = {
        { "plane", 0.023, -47, WR_SCHEME_BSPLINE, false, 0.02, 6 },
        { "plane", 0.023, 141, WR_SCHEME_BILINEAR, false, 0.1, 12 },
        { "plane", 0.12, -31, WR_SCHEME_CATMULL, true, 0.1, 24 },
        { "sphere", 0.017, -47, WR_SCHEME_BSPLINE, false, 0.15, 12 },
        { "cylinder", 0.017, -47, WR_SCHEME_BSPLINE_FIT, false, 0.15, 12 },
        { "torus", 0.017, -47, WR_SCHEME_BSPLINE, false, 0.4, -1 },
    };
    WrField *waves = wavy_field(48, 37), *jagged = random_field(5, 4, 12);
    for (int k = 0; k < 6; k++) {
        const WrField *field = cases[k].jagged ? jagged : waves;
        int bump, parallax;
        Shot a = shape_of(&cases[k], 0, field), b = shape_of(&cases[k], 1, field);
        Shot c = shape_of(&cases[k], 2, field);
        const double before = apart(&a, &c, &bump), after = apart(&b, &c, &parallax);
        print_message("%s: %g of bump, %g of parallax; outlines %d, %d\n", cases[k].surface, before,
                      after, bump, parallax);
        assert_true(before > 0.008);
        assert_true(after < cases[k].most * before);
        if (cases[k].outlines >= 0) assert_true(parallax <= cases[k].outlines && bump > 50);
        put_away(&a), put_away(&b), put_away(&c);
    }
    wr_field_free(waves);
    wr_field_free(jagged);
}

/* Along a tube's axis its base is invisible, but its relief is visible, as on the displaced tube. */
static void the_relief_of_a_tube_is_seen_along_its_axis(void **state)
{
    (void)state;
    int covered[2];
    WrField *field = wavy_field(48, 37);
    for (int k = 0; k < 2; k++) {
        WrScene *scene = parallax_of("cylinder", 0.07);
        scene->parallax = k == 0, scene->displaced = k == 1;
        scene->bump = WR_BUMP_EXACT, scene->scheme = WR_SCHEME_BSPLINE;
        scene->still = scene->posed = true;
        look_from(scene, 0, 0, 5);
        scene->camera.up = (WrVec3){ 0, 1, 0 };
        scene->camera.orthographic = true, scene->camera.size = 2;
        Shot shot = shoot(scene, field, 121, 121, 1, "auto", false);
        covered[k] = (int)shot.frame.covered;
        put_away(&shot);
        wr_scene_free(scene);
    }
    print_message("along the axis: %d pixels, displaced %d\n", covered[0], covered[1]);
    assert_true(covered[1] > 400 && abs(covered[0] - covered[1]) < covered[1] / 20);
    wr_field_free(field);
}

/* A relief in front of its base's bounding sphere is not skipped behind another object that hides the sphere
   (E52). */
static void what_rises_before_others_is_seen(void **state)
{
    (void)state;
    WrField *field = level_field(37, 22, 0.8);
    WrScene *scene = parallax_of("plane", 1), *other;
    scene->still = true;
    scene->material.colour = (WrVec3){ 1, 0, 0 };
    look_from(scene, 0, 0, 4.1);
    other = wr_scene_clone(scene);
    other->parallax = false, other->height = 0;
    other->at = (WrVec3){ 0, 0, 0.75 };
    other->size = 8; /* it fills the tiles */
    other->material.colour = (WrVec3){ 0, 1, 0 };
    scene->others = wr_alloc(1, sizeof *scene->others);
    scene->others[scene->other_count++] = other;
    Shot shot = shoot(scene, field, 150, 150, 1, "auto", false);
    const float *middle = shot.frame.rgba + 4 * (75 * 150 + 75);
    assert_true(middle[0] > 0.1f && middle[1] < 0.5f * middle[0]);
    put_away(&shot);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* ---- the reference ---- */

static void the_reference_marches_to_the_same_place(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "plane", "sphere", "torus", "bent", "cylinder" };
    WrField *field = wavy_field(41, 29);
    for (int k = 0; k < 5; k++) {
        WrScene *scene = parallax_of(surfaces[k], k == 4 ? -0.021 : 0.023);
        scene->bump = WR_BUMP_EXACT;
        scene->scheme = WR_SCHEME_BSPLINE_FIT;
        scene->material.shadow = k == 2;
        scene->dials.shading = k == 1 ? WR_SHADING_DOUBLE : WR_SHADING_FLOAT;
        Shot shot = shoot(scene, field, 90, 73, 2, "auto", false);
        float *want = true_picture(scene, field, 90, 73);
        int off = 0, covered = 0;
        for (int i = 0; i < 90 * 73; i++) {
            const float *p = shot.frame.rgba + 4 * i, *q = want + 4 * i;
            covered += q[3] > 0;
            float most = fabsf(p[3] - q[3]);
            for (int c = 0; c < 3; c++) most = fmaxf(most, fabsf(p[c] - q[c]));
            off += most > 0.01f;
        }
        print_message("%s: %d of %d are off\n", surfaces[k], off, covered);
        assert_true(covered > 800 && off <= covered / (k == 2 ? 40 : 100));
        wr_free(want);
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* ---- skipped parallax (E85) ---- */

static bool forced_apart(double height, double *off)
{
    WrField *field = random_field(64, 64, 9);
    WrScene *flat = scene_of("sphere"), *deep = parallax_of("sphere", height);
    WrForce force[WR_EFFECT_COUNT] = { 0 };
    WrFrame forced;
    WrError err = { "" };
    int outline;
    flat->height = height;
    Shot a = shoot(flat, field, 150, 150, 1, "auto", false);
    Shot b = shoot(deep, field, 150, 150, 1, "auto", false);
    const bool same = same_picture(&a, &b) && !wr_plan_runs(b.frame.plan, WR_EFFECT_PARALLAX);
    force[WR_EFFECT_PARALLAX] = WR_FORCE_ON;
    const WrFrameRequest request = {
        .field = field, .scene = deep, .width = 150, .height = 150, .turn_deg = 15, .force = force
    };
    assert_true(wr_renderer_frame(b.renderer, &request, &forced, &err));
    assert_true(forced.plan->rows[WR_EFFECT_PARALLAX].ran);
    b.frame = forced;
    *off = apart(&a, &b, &outline);
    put_away(&a), put_away(&b);
    wr_scene_free(flat), wr_scene_free(deep);
    wr_field_free(field);
    return same;
}

/* Below half a pixel the picture equals bump mapping bit for bit, and parallax would make no visible difference. F =
   0: the same. */
static void what_nobody_sees_is_bump(void **state)
{
    (void)state;
    double off;
    assert_true(forced_apart(0, &off));
    print_message("F = 0: %g\n", off);
    assert_true(off < 1e-5);
    assert_true(forced_apart(0.0013, &off));
    print_message("just left out: %g\n", off);
    assert_true(off > 0 && off < 0.02);
}

/* ---- special cases ---- */

static void the_bits_are_the_same(void **state)
{
    (void)state;
    static const char *const isas[] = { "v1", "v3", "v4" };
    static const char *const kinds[] = { "torus", "plane", "cone" };
    static const WrScheme schemes[] = { WR_SCHEME_BSPLINE, WR_SCHEME_CENTRAL, WR_SCHEME_CATMULL };
    WrField *field = random_field(33, 20, 8);
    for (int i = 0; i < 3; i++) {
        WrScene *scene = parallax_of(kinds[i], 0.07);
        scene->scheme = schemes[i];
        if (i == 1) scene->dials.aa = WR_AA_SUPERSAMPLE, scene->dials.samples = 2;
        Shot first = shoot(scene, field, 111, 90, 1, "ref", false);
        assert_true(first.frame.plan->rows[WR_EFFECT_PARALLAX].ran);
        for (int k = 0; k < 3; k++) {
            if (!wr_kernels_get(isas[k], false, NULL)) continue;
            Shot other = shoot(scene, field, 111, 90, 2, isas[k], k == 1);
            if (!same_picture(&first, &other)) fail_msg("%s, %s", kinds[i], isas[k]);
            put_away(&other);
        }
        put_away(&first);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* Views along the plane, from inside the relief, from behind; extreme heights; every scheme with its ends. */
static void no_view_makes_nonsense(void **state)
{
    (void)state;
    static const double eyes[][3] = {
        { 0.07, 2.3, 1e-6 }, { 0.13, -0.21, 0.02 }, { 0.4, 0.3, -2 }, { 1, 1.5, 0 }, { 0.3, 0.2, 3 }
    };
    static const char *const surfaces[] = { "plane", "sphere", "plane", "bezier", "cone" };
    TestRandom random = { 5 };
    WrField *field = wr_field_new(31, 17, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, 0, NULL);
    for (int i = 0; i < 31 * 17; i++)
        wr_field_set(field, i % 31, i / 31, (float)test_random(&random));
    for (int k = 0; k < 10; k++) {
        WrScene *scene = parallax_of(surfaces[k % 5], k < 5 ? 0.063 : k % 2 ? 1e6 : -1e30);
        scene->scheme = (WrScheme)(k % WR_SCHEME_COUNT);
        scene->still = true;
        scene->dials.heights = k % 3 ? WR_HEIGHTS_FLOAT : WR_HEIGHTS_DOUBLE;
        look_from(scene, eyes[k % 5][0], eyes[k % 5][1], eyes[k % 5][2]);
        Shot shot = shoot(scene, field, 40, 33, 2, "auto", false);
        for (int i = 0; i < 40 * 33 * 4; i++)
            if (!isfinite(shot.frame.rgba[i])) fail_msg("case %d", k);
        put_away(&shot);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* An edit changes visibility far from it: a static view must be bit-identical to a new picture. */
static void an_edit_is_seen_from_afar(void **state)
{
    (void)state;
    WrScene *scene = parallax_of("cylinder", 0.06);
    expect_refreshed(scene, 0);
    wr_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_hides_what_is_behind_it),
        cmocka_unit_test(a_raised_plane_comes_nearer),
        cmocka_unit_test(a_raised_ball_is_a_larger_ball),
        cmocka_unit_test(it_is_the_displaced_surface),
        cmocka_unit_test(the_relief_of_a_tube_is_seen_along_its_axis),
        cmocka_unit_test(what_rises_before_others_is_seen),
        cmocka_unit_test(the_reference_marches_to_the_same_place),
        cmocka_unit_test(what_nobody_sees_is_bump),
        cmocka_unit_test(the_bits_are_the_same),
        cmocka_unit_test(no_view_makes_nonsense),
        cmocka_unit_test(an_edit_is_seen_from_afar),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

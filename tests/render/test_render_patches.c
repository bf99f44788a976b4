/* Pictures of sets of bicubic patches: against the one patch that a set was divided from, against the reference, and
   between instruction sets. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"
#include "patch_sets.h"

#include "render/kernels/kern.h"
#include "render/reference/reference.h"

typedef struct Way {
    WrAntialias aa;
    int samples;
    WrSpread spread;
    WrBumpMode bump;
    WrShading shading;
    bool orthographic;
} Way;

static const Way ways[] = {
    { WR_AA_POINT, 1, 0, WR_BUMP_BLINN, WR_SHADING_FLOAT, false },
    { WR_AA_POINT, 1, 0, WR_BUMP_INVARIANT, WR_SHADING_DOUBLE, true },
    { WR_AA_ADAPTIVE, 4, 0, WR_BUMP_BLINN, WR_SHADING_FLOAT, true },
    { WR_AA_MOMENTS, 1, 0, WR_BUMP_BLINN, WR_SHADING_FLOAT, false },
};
enum { WAYS = sizeof ways / sizeof *ways };

static WrScene *scene_with(WrTriangles *set, const Way *way)
{
    WrScene *scene = scene_of("patches");
    wr_scene_set_triangles(scene, set, "a.bpt", NULL);
    assert_int_equal(scene->shape.kind, WR_SURFACE_patches);
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ -60, 0, 30 };
    scene->scheme = WR_SCHEME_BSPLINE;
    scene->dials.aa = way->aa;
    scene->dials.samples = way->samples;
    scene->dials.shading = way->shading;
    scene->bump = way->bump;
    scene->camera.orthographic = way->orthographic;
    return scene;
}

static WrTriangles *set_of(const float (*points)[48], int32_t count, WrPatchTable table)
{
    WrError err = { "" };
    WrTriangles *made = wr_patches_new(points, count, table, &err);
    if (!made) fail_msg("%s", err.text);
    return made;
}

static WrTriangles *teapot(WrPatchTable table)
{
    int32_t count;
    float(*points)[48] = teapot_points(&count);
    WrTriangles *made = set_of((const float(*)[48])points, count, table);
    wr_free(points);
    return made;
}

/* RMS of linear intensity where both cover fully; pixels with different coverage, and pixels that differ by more than
   a hundredth. */
typedef struct Apart {
    double rms;
    int cover, off, count;
} Apart;

static Apart compare(const float *a, const float *b, int pixels)
{
    Apart apart = { 0 };
    double sum = 0;
    for (int i = 0; i < pixels; i++, a += 4, b += 4) {
        apart.cover += fabsf(a[3] - b[3]) > 0.01f;
        if (a[3] != 1 || b[3] != 1) continue;
        double worst = 0;
        for (int c = 0; c < 3; c++) {
            const double d = fabs((double)a[c] - (double)b[c]);
            worst = fmax(worst, d);
            sum += d * d;
        }
        apart.off += worst > 0.01;
        apart.count++;
    }
    apart.rms = apart.count > 0 ? sqrt(sum / (3 * apart.count)) : 1;
    return apart;
}

static void the_bits_are_the_same(void **state)
{
    (void)state;
    static const char *const isas[] = { "v1", "v2", "v3", "v4" };
    WrField *field = random_field(33, 20, 8);
    for (int i = 0; i < WAYS; i++) {
        WrScene *scene = scene_with(teapot((WrPatchTable)(i % WR_PATCH_TABLES)), &ways[i]);
        Shot first = shoot(scene, field, 111, 90, 1, "ref", false);
        assert_true(first.frame.covered > 500);
        for (int k = 0; k < 4; k++) {
            if (!wr_kernels_get(isas[k], false, NULL)) continue;
            Shot other = shoot(scene, field, 111, 90, 1 + 3 * (k % 2), isas[k], k == 3);
            if (!same_picture(&first, &other))
                fail_msg("way %d: %s differs by %g", i, isas[k],
                         (double)worst_difference(&first, &other));
            put_away(&other);
        }
        put_away(&first);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

/* HC151: one patch, and its four parts, rotated and mirrored, with a quarter of the table each: the same picture, up
   to rounding of hits. */
static void a_cut_patch_is_the_patch(void **state)
{
    (void)state;
    WrField *field = bumpy_field(64, 64);
    WrScene *whole = scene_of("bezier");
    for (int i = 0; i < 48; i++) whole->shape.value[i] = (double)wavy_patch[i];
    for (int i = 0; i < WAYS; i++) {
        float points[4][48];
        quarter(wavy_patch, points);
        for (int k = 1; k < 4; k++) turn_points(points[k], k + i, (k + i) % 2);
        WrScene *cut = scene_with(set_of((const float(*)[48])points, 4, WR_PATCH_SPLIT), &ways[i]);
        assert_int_equal(cut->triangles->patches->report.joined, 4);
        WrScene *own = scene_with(NULL, &ways[i]);
        wr_scene_set_shape(own, &whole->shape);
        /* the same camera, for any bounding sphere */
        const WrVec3 centre = wr_shape_centre(&own->shape);
        const double ball[4] = { centre.x, centre.y, centre.z, wr_shape_radius(&own->shape) };
        WrShape shape = cut->shape;
        memcpy(shape.value + WR_MESH_CENTRE, ball, sizeof ball);
        wr_scene_set_shape(cut, &shape);
        Shot a = shoot(own, field, 150, 150, 2, NULL, false);
        Shot b = shoot(cut, field, 150, 150, 2, NULL, false);
        const Apart apart = compare(a.frame.rgba, b.frame.rgba, 150 * 150);
        if (!(apart.rms < 2e-6 && apart.off == 0 && apart.cover < 40 && apart.count > 1500))
            fail_msg("way %d: rms %g, %d off, %d cover of %d", i, apart.rms, apart.off, apart.cover,
                     apart.count);
        put_away(&a);
        put_away(&b);
        wr_scene_free(own);
        wr_scene_free(cut);
    }
    wr_scene_free(whole);
    wr_field_free(field);
}

/* The reference uses rays, trees of pieces and Newton's method in double, without triangles. */
static void the_reference_agrees(void **state)
{
    (void)state;
    const int w = 140, h = 100;
    WrField *field = bumpy_field(64, 32);
    for (int i = 0; i < 4; i++) {
        WrScene *scene = scene_with(teapot((WrPatchTable)(i % WR_PATCH_TABLES)), &ways[i % 2]);
        scene->scheme = WR_SCHEME_BSPLINE_FIT;
        Shot got = shoot(scene, field, w, h, 2, NULL, false);
        float *rgba = true_picture(scene, field, w, h);
        const Apart apart = compare(got.frame.rgba, rgba, w * h);
        /* separate cells meet in steps, and samples within rounding of an edge may be on either side */
        const double most = i % WR_PATCH_TABLES == WR_PATCH_OWN ? 2e-3 : 1e-4;
        if (!(apart.rms < most && apart.off < 3 && apart.cover < 6 && apart.count > 2000))
            fail_msg("set %d: rms %g, %d off, %d cover of %d", i, apart.rms, apart.off, apart.cover,
                     apart.count);
        wr_free(rgba);
        put_away(&got);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bits_are_the_same),
        cmocka_unit_test(a_cut_patch_is_the_patch),
        cmocka_unit_test(the_reference_agrees),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

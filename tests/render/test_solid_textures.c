/* test_solid_textures.c - solid textures: pictures against the reference, which has separate formulas and noise, in single and
   double precision, on surfaces at random rotations; as colours and as bumps; filtered ones against its many samples.
   All samples agree, except five of a thousand on the torus: its hits come from Newton's method, and a point within
   rounding of a step's edge may be on either side. */
#include "test.h"
#include "render_scenes.h"

#include "base/error.h"
#include "base/pool.h"
#include "render/reference/reference.h"
#include "scene/scene.h"
#include "shade/reflection_models.h"

enum { W = 61, H = 47 };

static WrReference truth_of(const WrScene *scene, const WrField *field, int samples)
{
    WrError err = { "" };
    WrReference r = { 0 };
    WrPool *pool = wr_pool_new(2);
    const WrReferenceRequest request = { .field = field,
                                         .scene = scene,
                                         .width = W,
                                         .height = H,
                                         .turn_deg = 15,
                                         .first = samples,
                                         .most = samples };
    if (!wr_reference_render(&request, pool, &r, &err)) fail_msg("%s", err.text);
    wr_pool_free(pool);
    return r;
}

/* Fraction of samples that differ from the reference by more than `enough`, and their number. */
static double differ(const WrScene *scene, const WrField *field, double enough, int *shown)
{
    WrReference r = truth_of(scene, field, 1);
    Shot shot = shoot(scene, field, W, H, 2, "auto", false);
    int off = 0;
    *shown = 0;
    for (int i = 0; i < W * H; i++) {
        if (r.rgba[4 * i + 3] != 1 || shot.frame.rgba[4 * i + 3] != 1) continue;
        double worst = 0;
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs(r.rgba[4 * i + c] - (double)shot.frame.rgba[4 * i + c]));
        off += worst > enough, ++*shown;
    }
    put_away(&shot);
    wr_reference_fini(&r);
    return (double)off / *shown;
}

static WrScene *grainy(WrSolidTextureKind kind, const char *surface, int number)
{
    WrScene *scene = scene_of(surface);
    scene->grain = wr_grains[kind].usual;
    scene->grain.axis = (WrSolidTextureAxis)((kind + (unsigned)number) % WR_SOLID_TEXTURE_AXES);
    scene->grain.rings *= 0.8137, scene->grain.cells *= 1.193;
    scene->height = 0; /* excludes differences of slopes */
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ 31.7 + 50 * number, 12.9 * kind, -71.3 };
    scene->dials.aa = WR_AA_POINT;
    return scene;
}

static void pictures_are_the_references(void **state)
{
    (void)state;
    static const char *const surfaces[] = { "sphere", "cylinder", "cube", "torus" };
    WrField *field = bumpy_field(16, 16);
    for (int kind = WR_SOLID_TEXTURE_WOOD; kind < WR_SOLID_TEXTURE_KINDS; kind++)
        for (int s = 0; s < 4; s++)
            for (int in_double = 0; in_double < 2; in_double++) {
                WrScene *scene = grainy((WrSolidTextureKind)kind, surfaces[s], s);
                int shown;
                if (in_double) scene->dials.shading = WR_SHADING_DOUBLE;
                const double off = differ(scene, field, in_double ? 1e-5 : 1e-3, &shown);
                if (!(shown > 200 && off <= (s == 3 ? 0.005 : 0)))
                    fail_msg("%s %s %d: %g of %d apart", wr_grains[kind].name, surfaces[s],
                             in_double, off, shown);
                wr_scene_free(scene);
            }
    wr_field_free(field);
}

/* Slopes at steps' edges are steps again: a sample within rounding of one may be on either side. */
static void bumps_are_the_references(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int kind = WR_SOLID_TEXTURE_WOOD; kind < WR_SOLID_TEXTURE_KINDS; kind++)
        for (int in_double = 0; in_double < 2; in_double++) {
            WrScene *scene =
                grainy((WrSolidTextureKind)kind, kind % 2 == 0 ? "sphere" : "cube", 1 + in_double);
            int shown;
            scene->grain.drives = WR_SOLID_TEXTURE_COLOURS | WR_SOLID_TEXTURE_BUMPS;
            scene->grain.edge = 0.137 * in_double;
            scene->grain.height = kind % 2 == 0 ? 0.0237 : -0.0173;
            if (in_double) scene->dials.shading = WR_SHADING_DOUBLE;
            const double off = differ(scene, field, in_double ? 1e-5 : 5e-3, &shown);
            if (!(shown > 200 && off <= (in_double ? 0 : 0.002)))
                fail_msg("%s %d: %g of %d apart", wr_grains[kind].name, in_double, off, shown);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

/* ---- roughness ---- */

/* Lights on facets with textured roughness. */
static void roughness_is_the_references(void **state)
{
    static const WrReflect models[] = { WR_REFLECT_GGX, WR_REFLECT_OREN_NAYAR,
                                        WR_REFLECT_TORRANCE_SPARROW };
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int k = 0; k < 12; k++) {
        const bool in_double = k / 3 % 2;
        WrScene *scene =
            grainy(k % 2 ? WR_SOLID_TEXTURE_NOISE : WR_SOLID_TEXTURE_GRANITE, "sphere", k % 3);
        int shown;
        scene->grain.drives = WR_SOLID_TEXTURE_ROUGHENS;
        scene->grain.roughness[0] = 0.137, scene->grain.roughness[1] = 0.83;
        scene->material.model = models[k % 3];
        scene->material.energy = (WrEnergy)(k / 6);
        scene->material.metalness = 0.37, scene->material.specular = 0.7;
        scene->material.diffuse = 0.8;
        if (in_double) scene->dials.shading = WR_SHADING_DOUBLE;
        /* the albedo of cached facets is linear between sixteenths of roughness */
        const bool kept = models[k % 3] == WR_REFLECT_GGX && k / 6 == 0;
        const double off = differ(scene, field, kept ? 5e-3 : in_double ? 1e-5 : 2e-3, &shown);
        if (!(shown > 200 && off == 0))
            fail_msg("%s %d: %g of %d apart", wr_reflects[models[k % 3]].name, k, off, shown);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static double apart(const WrScene *a, const WrScene *b, const WrField *field)
{
    Shot one = shoot(a, field, W, H, 2, "auto", false);
    Shot other = shoot(b, field, W, H, 2, "auto", false);
    double squares = 0, all = 0;
    for (int i = 0; i < 4 * W * H; i++) {
        const double d = (double)one.frame.rgba[i] - (double)other.frame.rgba[i];
        if (one.frame.rgba[i | 3] == 1 && other.frame.rgba[i | 3] == 1) squares += d * d, all += 1;
    }
    put_away(&one);
    put_away(&other);
    return sqrt(squares / all);
}

static WrScene *under_sky(double roughness)
{
    WrScene *scene = grainy(WR_SOLID_TEXTURE_WOOD, "sphere", 0);
    scene->grain = wr_grains[WR_SOLID_TEXTURE_OFF].usual;
    wr_environment_set(&scene->environment, WR_ENVIRONMENT_MAP_STUDIO,
                       wr_environment_map_built(WR_ENVIRONMENT_MAP_STUDIO, NULL), NULL, NULL);
    scene->light_count = 0;
    scene->material.model = WR_REFLECT_GGX, scene->material.metalness = 0.83;
    scene->material.specular = 1;
    scene->material.roughness = roughness;
    return scene;
}

/* Reflections of the environment are equal for a constant roughness and an equal textured one, at a prefilter level
   and, nearly, in between; below 1/8 the blur changes to the mirror without a step. */
static void rungs_of_the_blur_meet(void **state)
{
    static const double at[] = { 0.5, 0.25, 0.41, 0.17 };
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int k = test_amount(0, 3); k < 4; k++) {
        WrScene *all = under_sky(at[k]), *by = under_sky(0.9);
        by->grain = wr_grains[WR_SOLID_TEXTURE_WOOD].usual;
        by->grain.drives = WR_SOLID_TEXTURE_ROUGHENS;
        by->grain.roughness[0] = by->grain.roughness[1] = at[k];
        const double off = apart(all, by, field);
        if (!(off <= (k < 2 ? 2e-3 : 0.03))) fail_msg("roughness %g: %g apart", at[k], off);
        wr_scene_free(all);
        wr_scene_free(by);
    }
    WrScene *below = under_sky(0.1249), *above = under_sky(0.1251), *mirror = under_sky(0.01);
    WrScene *near = under_sky(0.0316);
    const double step = apart(below, above, field), whole = apart(below, mirror, field);
    const double last = apart(near, mirror, field);
    if (!(step < 0.05 * whole && last < 0.1 * whole && whole > 0.01))
        fail_msg("%g, %g of %g", step, last, whole);
    wr_scene_free(below);
    wr_scene_free(above);
    wr_scene_free(mirror);
    wr_scene_free(near);
    wr_field_free(field);
}

/* Slopes finer than pixels blur reflections of a smooth surface. */
static void slopes_widen_what_is_mirrored(void **state)
{
    (void)state;
    WrField *field = random_field(256, 256, 1978);
    WrScene *scene = under_sky(0.13);
    scene->height = 0.01;
    scene->replicate_u = 4, scene->replicate_v = 2;
    scene->dials.aa = WR_AA_SUPERSAMPLE, scene->dials.samples = 16; /* each with its own normal */
    Shot truth = shoot(scene, field, W, H, 2, "auto", false);
    double rms[2] = { 0 };
    for (int k = 0; k < 2; k++) {
        scene->dials.aa = k ? WR_AA_MOMENTS : WR_AA_FILTER;
        Shot shot = shoot(scene, field, W, H, 2, "auto", false);
        for (int i = 0; i < 4 * W * H; i += 4)
            if (truth.frame.rgba[i + 3] == 1 && shot.frame.rgba[i + 3] == 1)
                rms[k] += pow((double)(shot.frame.rgba[i] - truth.frame.rgba[i]), 2);
        put_away(&shot);
    }
    if (!(rms[1] < 0.5 * rms[0])) fail_msg("%g of %g", rms[1], rms[0]);
    put_away(&truth);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* ---- filtered ---- */

typedef struct Far {
    double rms, mean; /* difference from the reference; difference of the means */
} Far;

static Far far_from(const WrScene *scene, const WrField *field, const WrReference *r)
{
    Shot shot = shoot(scene, field, W, H, 2, "auto", false);
    double squares = 0, sum = 0, all = 0;
    for (int i = 0; i < W * H; i++) {
        if (r->rgba[4 * i + 3] != 1 || shot.frame.rgba[4 * i + 3] != 1) continue;
        const double d = (double)shot.frame.rgba[4 * i] - r->rgba[4 * i];
        squares += d * d, sum += d, all += 1;
    }
    put_away(&shot);
    return (Far){ sqrt(squares / all), fabs(sum / all) };
}

/* Rings and cells of about a pixel: filters are closer to the truth than point samples, and equally bright (HC121).
   Noise alone is faded where a pixel could show half of it. */
static void filtered_ones_are_nearer(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int kind = WR_SOLID_TEXTURE_WOOD; kind < WR_SOLID_TEXTURE_KINDS; kind++)
        for (int s = 0; s < 2; s++) {
            WrScene *scene = grainy((WrSolidTextureKind)kind, s ? "plane" : "sphere", s);
            for (int c = 0; c < 3; c++) scene->grain.light[c] = 1, scene->grain.dark[c] = 0;
            scene->grain.rings = 13.7,
            scene->grain.cells = kind == WR_SOLID_TEXTURE_WOOD ? 2.3 : 9.3;
            scene->material.ambient = 1, scene->material.diffuse = scene->material.specular = 0;
            WrReference r = truth_of(scene, field, 16);
            const Far point = far_from(scene, field, &r);
            scene->dials.aa = WR_AA_FILTER;
            const Far filter = far_from(scene, field, &r);
            wr_reference_fini(&r);
            const bool nearer = !wr_grains[kind].ringed || filter.rms < 0.85 * point.rms;
            if (!(nearer && filter.mean < (wr_grains[kind].ringed ? 0.01 : 0.06)))
                fail_msg("%s %d: %g of %g, %g", wr_grains[kind].name, s, filter.rms, point.rms,
                         filter.mean);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

/* At a grazing angle, noise of about a pixel along the view and much less across has no larger error than one
   sample. */
static void grazing_is_no_worse(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int kind = WR_SOLID_TEXTURE_GRANITE; kind < WR_SOLID_TEXTURE_KINDS; kind++)
        for (int k = 0; k < 3; k++) {
            WrScene *scene = grainy((WrSolidTextureKind)kind, "plane", k);
            scene->rotate_deg = (WrVec3){ -77 + 5 * k, 13, 7 };
            for (int c = 0; c < 3; c++) scene->grain.light[c] = 1, scene->grain.dark[c] = 0;
            scene->grain.cells = 3.7 * (k + 1);
            scene->material.ambient = 1, scene->material.diffuse = scene->material.specular = 0;
            WrReference r = truth_of(scene, field, 16);
            const Far point = far_from(scene, field, &r);
            scene->dials.aa = WR_AA_FILTER;
            const Far filter = far_from(scene, field, &r);
            wr_reference_fini(&r);
            if (!(filter.rms < 0.97 * point.rms && filter.mean < 0.02))
                fail_msg("%s %d: %g of %g, %g", wr_grains[kind].name, k, filter.rms, point.rms,
                         filter.mean);
            wr_scene_free(scene);
        }
    wr_field_free(field);
}

/* Samples are saved where bands are wide, without a visible difference from the picture with all samples. */
static void adaptive_spares_samples(void **state)
{
    (void)state;
    int spared = 0;
    WrField *field = bumpy_field(16, 16);
    for (int kind = WR_SOLID_TEXTURE_WOOD; kind < WR_SOLID_TEXTURE_KINDS; kind++) {
        WrScene *scene = grainy((WrSolidTextureKind)kind, kind % 2 ? "sphere" : "plane", 0);
        enum { WIDE = 211, HIGH = 189 };
        scene->grain.rings = 0.83, scene->grain.cells = 0.71, scene->grain.octaves = 1;
        scene->grain.share = 0.43;
        scene->dials.aa = WR_AA_SUPERSAMPLE, scene->dials.samples = 4;
        Shot all = shoot(scene, field, WIDE, HIGH, 2, "auto", false);
        scene->dials.aa = WR_AA_ADAPTIVE;
        Shot few = shoot(scene, field, WIDE, HIGH, 2, "auto", false);
        double squares = 0, worst = 0;
        for (int i = 0; i < 4 * WIDE * HIGH; i++) {
            const double d = fabs((double)(all.frame.rgba[i] - few.frame.rgba[i]));
            squares += d * d, worst = fmax(worst, d);
        }
        const double rms = sqrt(squares / (4.0 * WIDE * HIGH));
        const int64_t taken = few.frame.plan->shaded, full = all.frame.plan->shaded;
        spared += taken < full * 3 / 4;
        if (!(rms < 0.002 && worst < 0.1 && taken <= full))
            fail_msg("%s: %g, %g, %lld of %lld", wr_grains[kind].name, rms, worst, (long long)taken,
                     (long long)full);
        put_away(&all);
        put_away(&few);
        wr_scene_free(scene);
    }
    assert_true(spared >= 2);
    wr_field_free(field);
}

/* Endless ground up to the horizon, for any dials. */
static void ground_without_end_is_its_mean(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    WrScene *scene = grainy(WR_SOLID_TEXTURE_CHECKER, "plane", 0);
    scene->shape.value[2] = 1;
    scene->rotate_deg = (WrVec3){ -90, 0, 0 };
    scene->grain.rings = 40;
    scene->camera.fit = false;
    scene->camera.eye = (WrVec3){ 0.13, 0.4, 2 }, scene->camera.target = (WrVec3){ 0, 0.3, 0 };
    for (int c = 0; c < 3; c++) scene->grain.light[c] = 1, scene->grain.dark[c] = 0;
    scene->material.ambient = 1, scene->material.diffuse = scene->material.specular = 0;
    Shot shot = shoot(scene, field, W, H, 2, "auto", false);
    int far = 0;
    for (int x = 0; x < W; x++)
        for (int y = 1; y < H; y++) { /* the row below the horizon */
            const float *here = shot.frame.rgba + 4 * (y * W + x), *above = here - 4 * W;
            if (!(here[3] == 1 && above[3] < 1)) continue;
            assert_near((double)here[0], 0.5, 0.15);
            far++;
            break;
        }
    assert_true(far > W / 2);
    put_away(&shot);
    wr_scene_free(scene);
    wr_field_free(field);
}

/* ---- rotation (HC120) ---- */

/* An object rotated by quarters together with its camera produces the same bits: the texture is fixed to it. */
static void turning_leaves_the_grains_bits(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int kind = WR_SOLID_TEXTURE_WOOD; kind < WR_SOLID_TEXTURE_KINDS; kind++) {
        WrScene *scene = grainy((WrSolidTextureKind)kind, "sphere", 0);
        scene->material.ambient = 1, scene->material.diffuse = scene->material.specular = 0;
        scene->camera.fit = false, scene->camera.target = (WrVec3){ 0, 0, 0 };
        scene->rotate_deg = (WrVec3){ 0, 0, 0 }, scene->camera.eye = (WrVec3){ 0, 0, 3.7 };
        Shot before = shoot(scene, field, W, H, 2, "auto", false);
        scene->rotate_deg = (WrVec3){ 0, 90, 0 }, scene->camera.eye = (WrVec3){ 3.7, 0, 0 };
        Shot after = shoot(scene, field, W, H, 2, "auto", false);
        assert_true(same_picture(&before, &after));
        put_away(&after);
        scene->rotate_deg = (WrVec3){ 0, 37, 0 };
        after = shoot(scene, field, W, H, 2, "auto", false);
        assert_false(same_picture(&before, &after));
        put_away(&after);
        put_away(&before);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_the_references),
        cmocka_unit_test(bumps_are_the_references),
        cmocka_unit_test(roughness_is_the_references),
        cmocka_unit_test(rungs_of_the_blur_meet),
        cmocka_unit_test(slopes_widen_what_is_mirrored),
        cmocka_unit_test(filtered_ones_are_nearer),
        cmocka_unit_test(grazing_is_no_worse),
        cmocka_unit_test(adaptive_spares_samples),
        cmocka_unit_test(ground_without_end_is_its_mean),
        cmocka_unit_test(turning_leaves_the_grains_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* test_facets.c - roughness and metalness maps: against the reference, which fetches them in double precision and
   computes each point separately; over footprints against its many samples. */
#include "test.h"
#include "render_scenes.h"

#include "base/error.h"
#include "base/pool.h"
#include "image/image.h"
#include "render/reference/reference.h"
#include "scene/scene.h"
#include "shade/reflection_models.h"

enum { W = 61, H = 47 };

/* Random numbers of 0..1, not smoothed. */
static WrImage *numbers(int w, int h, uint64_t seed)
{
    TestRandom random = { seed };
    WrImage *image = wr_image_new(w, h, 1, NULL);
    for (int i = 0; i < w * h; i++) image->data[i] = (float)test_random(&random);
    return image;
}

static void lay(WrScene *scene, WrFacetKind kind, WrImage *image, double ru, double rv)
{
    scene->facets[kind].image = image;
    scene->facets[kind].laid = (WrTextureSample){ .own = true, .ru = ru, .rv = rv };
}

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

/* The largest difference where both cover fully, and its RMS. */
static double worst_of(const WrScene *scene, const WrField *field, const WrReference *r,
                       double *rms)
{
    Shot shot = shoot(scene, field, W, H, 2, "auto", false);
    double worst = 0, squares = 0, all = 0;
    for (int i = 0; i < 4 * W * H; i++) {
        if (r->rgba[i | 3] != 1 || shot.frame.rgba[i | 3] != 1) continue;
        const double off = fabs(r->rgba[i] - (double)shot.frame.rgba[i]);
        worst = fmax(worst, off), squares += off * off, all += 1;
    }
    assert_true(all > 4 * 300);
    if (rms) *rms = sqrt(squares / all);
    put_away(&shot);
    return worst;
}

static WrScene *worn(WrReflect model, const char *surface)
{
    WrScene *scene = scene_of(surface);
    scene->height = 0; /* excludes differences of slopes */
    scene->posed = true;
    scene->rotate_deg = (WrVec3){ 31.7, -12.9, 71.3 };
    scene->dials.aa = WR_AA_POINT;
    scene->material.model = model;
    scene->material.metalness = 0.37, scene->material.specular = 0.7;
    scene->material.diffuse = 0.8;
    return scene;
}

/* Lights: either map, or both, with separate tiling, on periodic and clamped tables. */
static void pictures_are_the_references(void **state)
{
    static const WrReflect models[] = { WR_REFLECT_GGX, WR_REFLECT_OREN_NAYAR,
                                        WR_REFLECT_TORRANCE_SPARROW };
    static const char *const surfaces[] = { "sphere", "plane", "cube", "cylinder" };
    (void)state;
    WrField *round = bumpy_field(16, 16);
    WrField *ends = wr_field_new(9, 7, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, NULL);
    for (int k = 0; k < 24; k += test_amount(1, 5)) {
        const bool in_double = k / 3 % 2, kept = k / 12 == 0 && k % 3 == 0;
        WrScene *scene = worn(models[k % 3], surfaces[k % 4]);
        scene->material.energy = (WrEnergy)(k / 12);
        if (k % 5 != 1)
            lay(scene, WR_FACET_ROUGHNESS, numbers(23, 17, 7 + (uint64_t)k), 0.83, -1.7);
        if (k % 5 != 2) lay(scene, WR_FACET_METALNESS, numbers(5, 31, 9 + (uint64_t)k), -0.57, 1);
        if (in_double) scene->dials.shading = WR_SHADING_DOUBLE;
        const WrField *field = k % 7 == 3 ? ends : round;
        WrReference r = truth_of(scene, field, 1);
        /* the albedo of cached facets is linear between sixteenths of roughness */
        const double off = worst_of(scene, field, &r, NULL);
        if (!(off <= (kept ? 5e-3 : in_double ? 1e-5 : 2e-3)))
            fail_msg("%d, %s on %s: %g", k, wr_reflects[models[k % 3]].name, surfaces[k % 4], off);
        wr_reference_fini(&r);
        wr_scene_free(scene);
    }
    wr_field_free(round);
    wr_field_free(ends);
}

/* A constant map equals that number in the material, whatever the material's own is; also for reflections, where the
   environment is prefiltered in levels. */
static void an_even_picture_is_the_number(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int k = test_amount(0, 3); k < 4; k++) {
        WrScene *scene = worn(WR_REFLECT_GGX, "sphere"), *same;
        const double rough = 0.5, metal = k & 1 ? 0.83 : 0;
        wr_environment_set(&scene->environment, WR_ENVIRONMENT_MAP_STUDIO,
                           wr_environment_map_built(WR_ENVIRONMENT_MAP_STUDIO, NULL), NULL, NULL);
        scene->material.energy = (WrEnergy)(k / 2);
        same = wr_scene_clone(scene);
        same->material.roughness = rough, same->material.metalness = metal;
        scene->material.roughness = 0.11, scene->material.metalness = 1;
        lay(scene, WR_FACET_ROUGHNESS, numbers(3, 5, 1), 1, 1);
        lay(scene, WR_FACET_METALNESS, numbers(2, 1, 1), 1, 1);
        for (int i = 0; i < 15; i++) scene->facets[0].image->data[i] = (float)rough;
        for (int i = 0; i < 2; i++) scene->facets[1].image->data[i] = (float)metal;
        Shot one = shoot(scene, field, W, H, 2, "auto", false);
        Shot other = shoot(same, field, W, H, 2, "auto", false);
        const float off = worst_difference(&one, &other);
        if (!(off <= 5e-3f)) fail_msg("%d: %g apart", k, (double)off);
        put_away(&one);
        put_away(&other);
        wr_scene_free(scene);
        wr_scene_free(same);
    }
    wr_field_free(field);
}

/* Many texels per pixel: their means are closer to 8 x 8 samples than one texel is, where shading depends less
   steeply on roughness than under narrow lobes. */
static void footprints_have_their_means(void **state)
{
    (void)state;
    WrField *field = bumpy_field(16, 16);
    for (int k = 0; k < 2; k++) {
        WrScene *scene = worn(WR_REFLECT_GGX, k ? "cylinder" : "sphere");
        double one, mean;
        lay(scene, WR_FACET_ROUGHNESS, numbers(211, 187, 3), 1.3, 1.1);
        lay(scene, WR_FACET_METALNESS, numbers(97, 151, 5), 1.7, -2.1);
        for (int i = 0; i < 211 * 187; i++)
            scene->facets[0].image->data[i] = 0.5f + 0.3f * scene->facets[0].image->data[i];
        WrReference r = truth_of(scene, field, 8);
        worst_of(scene, field, &r, &one);
        scene->dials.aa = WR_AA_FILTER;
        worst_of(scene, field, &r, &mean);
        if (!(mean < 0.5 * one)) fail_msg("%d: %g of %g", k, mean, one);
        wr_reference_fini(&r);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_are_the_references),
        cmocka_unit_test(an_even_picture_is_the_number),
        cmocka_unit_test(footprints_have_their_means),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The renderer against an independent one: rays marched in double precision against the implicit equation of each
   surface, then the paper's formulas from shade/bump.h. And invariance: threads, instruction sets, earlier
   pictures. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "field/field.h"
#include "render/kernels/kern.h"
#include "shade/reflection_models.h"
#include "scene/scene.h"
#include "shade/bump.h"

/* ---- the independent renderer ------------------------------------------------------------------- */

/* Zero on the surface, in object space; NaN outside the surface's ends. */
static double implicit(const WrShape *shape, WrVec3 p)
{
    const double *a = shape->value;
    double rho = hypot(p.x, p.y);
    switch ((int)shape->kind) {
    case WR_SURFACE_plane: return p.z;
    case WR_SURFACE_sphere: return v3_len(p) - a[0];
    case WR_SURFACE_cylinder: return rho - a[0];
    case WR_SURFACE_cone: return rho - a[0] * (0.5 - p.z / a[1]);
    default: return hypot(rho - a[0], p.z) - a[1]; /* torus */
    }
}

/* (u, v) of a surface point; false beyond the surface's ends. */
static bool invert(const WrShape *shape, WrVec3 p, double *u, double *v)
{
    const double *a = shape->value;
    *u = atan2(p.y, p.x) / (2 * WR_PI);
    *u -= floor(*u);
    switch ((int)shape->kind) {
    case WR_SURFACE_plane: *u = p.x / a[0], *v = p.y / a[1]; break;
    case WR_SURFACE_sphere: *v = 0.5 + asin(p.z / v3_len(p)) / WR_PI; break;
    case WR_SURFACE_cylinder:
    case WR_SURFACE_cone: *v = 0.5 + p.z / a[1]; break;
    default: *v = atan2(p.z, hypot(p.x, p.y) - a[0]) / (2 * WR_PI); *v -= floor(*v);
    }
    return *u >= 0 && *u <= 1 && *v >= 0 && *v <= 1;
}

static WrVec3 to_object(const WrPlacement *place, WrVec3 w)
{
    const double *m = place->rotation;
    return (WrVec3){ m[0] * w.x + m[3] * w.y + m[6] * w.z, m[1] * w.x + m[4] * w.y + m[7] * w.z,
                     m[2] * w.x + m[5] * w.y + m[8] * w.z };
}

/* First root along the ray by marching and bisection. */
static bool march(const WrShape *shape, WrVec3 eye, WrVec3 d, double from, double to, double *u,
                  double *v, WrVec3 *hit)
{
    const int steps = 1500;
    double before = implicit(shape, v3_mad(eye, d, from));
    for (int i = 1; i <= steps; i++) {
        double t = from + (to - from) * i / steps, now = implicit(shape, v3_mad(eye, d, t));
        if ((before < 0) != (now < 0)) {
            double low = t - (to - from) / steps, high = t;
            for (int k = 0; k < 60; k++) {
                double middle = 0.5 * (low + high);
                bool same = (implicit(shape, v3_mad(eye, d, middle)) < 0) == (before < 0);
                if (same) low = middle;
                else high = middle;
            }
            *hit = v3_mad(eye, d, high);
            if (invert(shape, *hit, u, v)) return true;
        }
        before = now;
    }
    return false;
}

static WrVec3 shade(const WrScene *scene, const WrPlacement *place, WrVec3 eye, WrVec3 hit,
                    double u, double v, const WrField *field, double *facing)
{
    const WrMaterial *m = &scene->material;
    WrSurfacePoint at;
    double f, fu, fv;
    wr_surface_at(&scene->shape, 0, u, v, &at);
    wr_scene_height(scene, field, u, v, &f, &fu, &fv);
    WrVec3 n = wr_bump_unit(
        wr_bump_normal(scene->bump, at.n, at.n_unit, at.pu, at.pv, at.n_u, at.n_v, f, fu, fv),
        at.n_unit);
    WrVec3 view = v3_unit(v3_sub(eye, hit), at.n_unit);
    *facing = v3_dot(at.n_unit, view);
    if (*facing < 0) n = v3_neg(n);
    double diffuse = m->ambient, specular = 0;
    for (int i = 0; i < scene->light_count; i++) {
        const WrLight *light = &scene->lights[i];
        WrVec3 l = to_object(place, light->where);
        if (light->kind == WR_LIGHT_POINT) l = v3_sub(v3_add(l, place->centre), hit);
        l = v3_unit(l, n);
        WrVec3 h = v3_unit(v3_add(l, view), n);
        double ndl = v3_dot(n, l), ndh = fmax(0, v3_dot(n, h));
        diffuse += m->diffuse * fmax(0, ndl) * light->strength * light->colour.x;
        if (ndl > 0)
            specular += m->specular * pow(ndh, m->shininess) * light->strength * light->colour.x;
    }
    double red = m->colour.x * diffuse + specular;
    return (WrVec3){ red, red, red };
}

/* Compare the red channel of every pixel; silhouettes (grazing, or next to another coverage) separately. */
static void compare_with_marched(const char *surface, WrBumpMode mode, WrScheme scheme, bool ortho)
{
    enum { SIDE = 48 };
    WrField *field = bumpy_field(32, 40);
    WrScene *scene = scene_of(surface);
    scene->bump = mode;
    scene->scheme = scheme;
    scene->camera.orthographic = ortho;
    scene->camera.size = 0;
    Shot shot = shoot(scene, field, SIDE, SIDE, 2, "auto", false);
    WrPlacement place;
    assert_true(wr_scene_place(scene, 15, 1, &place, NULL));
    WrVec3 eye = v3_add(to_object(&place, place.eye), place.centre);
    WrVec3 right = to_object(&place, place.right), up = to_object(&place, place.up);
    WrVec3 ahead = to_object(&place, place.forward);
    double distance = v3_len(place.eye), worst = 0;
    int compared = 0, wrong_cover = 0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double a = (2 * (x + 0.5) / SIDE - 1) * place.half_height, u, v, facing;
            double b = (1 - 2 * (y + 0.5) / SIDE) * place.half_height;
            WrVec3 sideways = v3_add(v3_scale(right, a), v3_scale(up, b)), hit, from = eye;
            WrVec3 d = ortho ? ahead : v3_add(ahead, sideways);
            if (ortho) from = v3_add(eye, sideways);
            bool there = march(&scene->shape, from, d, distance - 1.5 * place.radius,
                               distance + 1.5 * place.radius, &u, &v, &hit);
            const float *got = shot.frame.rgba + (y * SIDE + x) * 4;
            wrong_cover += there != (got[3] > 0);
            if (!there || got[3] == 0) continue;
            WrVec3 viewer = ortho ? v3_mad(hit, ahead, -1) : eye;
            WrVec3 want = shade(scene, &place, viewer, hit, u, v, field, &facing);
            if (fabs(facing) < 0.15) continue;
            compared++;
            worst = fmax(worst, fabs(want.x - (double)got[0]));
        }
    if (compared < 200 || worst > 2e-4 || wrong_cover > 12)
        fail_msg("%s mode %d scheme %d: %d pixels, worst %g, %d with wrong coverage", surface, mode,
                 scheme, compared, worst, wrong_cover);
    put_away(&shot);
    wr_scene_free(scene);
    wr_field_free(field);
}

static void pictures_agree_with_marched_rays_in_double(void **state)
{
    (void)state;
    const char *const surfaces[] = { "plane", "sphere", "cylinder", "cone", "torus" };
    for (int i = 0; i < 5; i++)
        for (int mode = 0; mode < WR_BUMP_COUNT; mode++)
            compare_with_marched(surfaces[i], (WrBumpMode)mode, WR_SCHEME_CENTRAL, mode & 1);
    for (int scheme = WR_SCHEME_BILINEAR; scheme < WR_SCHEME_COUNT; scheme++)
        compare_with_marched("torus", WR_BUMP_EXACT, (WrScheme)scheme, false);
}

/* ---- same bits ------------------------------------------------------------------------------------ */

static void pictures_are_the_same_bits_on_any_threads_and_instruction_set(void **state)
{
    (void)state;
    WrField *field = bumpy_field(50, 70);
    const char *plain = wr_kernels_get("v1", false, NULL) ? "v1" : "ref";
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrScene *scene = scene_of(wr_surfaces[kind]->name);
        scene->bump = WR_BUMP_EXACT;
        Shot one = shoot(scene, field, 150, 110, 1, "ref", false);
        for (int k = 0; k < 3; k++) {
            Shot other =
                shoot(scene, field, 150, 110, k == 0 ? 2 : 7, k == 2 ? plain : "auto", false);
            if (!same_picture(&one, &other)) fail_msg("%s differs", wr_surfaces[kind]->name);
            put_away(&other);
        }
        put_away(&one);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void leaving_effects_out_changes_no_bit(void **state)
{
    (void)state;
    WrField *flat = wr_field_new(40, 40, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.7f, NULL);
    WrField *bumpy = bumpy_field(40, 40);
    for (int which = 0; which < 6; which++) {
        WrScene *scene = scene_of(which & 1 ? "torus" : "sphere");
        if (which == 2) scene->material.specular = 0;
        if (which == 3) scene->material.diffuse = 0;
        if (which == 4) scene->lights[0].strength = 0;
        if (which == 5) scene->height = 0;
        const WrField *field = which < 2 ? flat : bumpy;
        Shot planned = shoot(scene, field, 90, 90, 2, "auto", false);
        Shot full = shoot(scene, field, 90, 90, 2, "auto", true);
        if (!same_picture(&planned, &full)) fail_msg("scene %d differs", which);
        put_away(&planned);
        put_away(&full);
        wr_scene_free(scene);
    }
    wr_field_free(flat);
    wr_field_free(bumpy);
}

/* The largest difference of a value. */
static double apart(const Shot *a, const Shot *b)
{
    double most = 0;
    for (int i = 0; i < 4 * a->frame.width * a->frame.height; i++)
        most = fmax(most, fabs((double)a->frame.rgba[i] - (double)b->frame.rgba[i]));
    return most;
}

/* Every surface, smooth or with curvature terms; on flat ones the exact normal is skipped, equal up to rounding
   (E12). */
static void every_surface_is_planned_to_the_bits_of_all_effects(void **state)
{
    (void)state;
    WrField *field = bumpy_field(40, 40);
    for (int k = 0; k < 2 * WR_SURFACE_COUNT; k++) {
        WrScene *scene = scene_of(wr_surfaces[k / 2]->name);
        scene->bump = k % 2 ? WR_BUMP_EXACT : WR_BUMP_NONE;
        Shot planned = shoot(scene, field, 90, 90, 2, "auto", false);
        Shot full = shoot(scene, field, 90, 90, 2, "auto", true);
        const bool rounded = wr_surfaces[k / 2]->flat && scene->bump == WR_BUMP_EXACT;
        if (rounded ? apart(&planned, &full) > 1e-5 : !same_picture(&planned, &full))
            fail_msg("%s, %s: %g apart", wr_surfaces[k / 2]->name, wr_bumps[scene->bump].name,
                     apart(&planned, &full));
        put_away(&planned);
        put_away(&full);
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

static void an_edit_refreshes_what_a_new_renderer_would_make(void **state)
{
    (void)state;
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++) {
        WrField *field = bumpy_field(200, 150);
        WrScene *scene = scene_of("plane");
        scene->scheme = (WrScheme)scheme;
        Shot kept = shoot(scene, field, 96, 96, 2, "auto", false);
        TestRandom random = { 99 };
        for (int step = 0; step < 12; step++) {
            int i = step == 0 ? 0 : (int)(200 * test_random(&random));
            int j = step == 1 ? 149 : (int)(150 * test_random(&random));
            wr_field_set(field, i, j, (float)(2 * test_random(&random)));
            WrFrameRequest request = {
                .field = field, .scene = scene, .width = 96, .height = 96, .turn_deg = 15
            };
            assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
            Shot fresh = shoot(scene, field, 96, 96, 1, "auto", false);
            if (!same_picture(&kept, &fresh)) fail_msg("scheme %d, step %d differs", scheme, step);
            put_away(&fresh);
        }
        put_away(&kept);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* E29: only affected tiles are rendered again, with an identical result. */
static void a_resting_view_is_refreshed_to_the_bits_of_a_new_picture(void **state)
{
    (void)state;
    const char *const surfaces[] = { "plane", "sphere", "torus", "cube" };
    for (int kind = 0; kind < 4; kind++) {
        WrField *field = bumpy_field(300, 200);
        WrScene *scene = scene_of(surfaces[kind]);
        scene->scheme = (WrScheme)(kind + WR_SCHEME_CENTRAL);
        scene->dials.aa = WR_AA_SUPERSAMPLE;
        scene->dials.samples = 2;
        scene->replicate_u = scene->replicate_v = 1;
        Shot kept = shoot(scene, field, 120, 96, 2, "auto", false);
        WrFrameRequest request = {
            .field = field, .scene = scene, .width = 120, .height = 96, .turn_deg = 15, .keep = true
        };
        assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
        int64_t whole = kept.frame.shaded, covered = kept.frame.covered;
        TestRandom random = { 5 };
        for (int step = 0; step < 10; step++) {
            int i = step == 0 ? 0 : (int)(300 * test_random(&random));
            int j = step == 1 ? 199 : (int)(200 * test_random(&random));
            wr_field_set(field, i, j, (float)(2 * test_random(&random)));
            assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
            Shot fresh = shoot(scene, field, 120, 96, 1, "auto", false);
            if (!same_picture(&kept, &fresh)) fail_msg("%s, step %d", surfaces[kind], step);
            assert_true(kept.frame.covered == covered && fresh.frame.covered == covered);
            assert_true(kept.frame.shaded <= whole);
            if (kind == 0) assert_true(kept.frame.shaded < whole); /* its tiles show parts of v */
            put_away(&fresh);
        }
        assert_true(wr_renderer_frame(kept.renderer, &request, &kept.frame, NULL));
        assert_int_equal(kept.frame.shaded, 0); /* no change, no work */
        put_away(&kept);
        wr_scene_free(scene);
        wr_field_free(field);
    }
}

/* A patch that occludes itself in places. */
static WrScene *folded_patch(void)
{
    TestRandom random = { 41 };
    WrScene *scene = scene_of("bezier");
    for (int k = 0; k < 48; k++) scene->shape.value[k] += 0.9 * (test_random(&random) - 0.5);
    return scene;
}

static void fast_arithmetic_stays_near_the_exact_picture(void **state)
{
    (void)state;
    WrField *field = bumpy_field(64, 64);
    WrScene *const scenes[] = { scene_of("torus"), scene_of("bezier"), folded_patch() };
    for (int k = 0; k < 3; k++) {
        const int w = k ? 331 : 128, h = k ? 190 : 128;
        Shot exact = shoot(scenes[k], field, w, h, 2, "auto", false);
        scenes[k]->dials.arithmetic = WR_ARITHMETIC_FAST;
        Shot fast = shoot(scenes[k], field, w, h, 2, "auto", false);
        assert_true(exact.frame.covered == fast.frame.covered);
        assert_near((double)worst_difference(&exact, &fast), 0, 2e-3);
        put_away(&exact);
        put_away(&fast);
        wr_scene_free(scenes[k]);
    }
    wr_field_free(field);
}

/* Samples whose colours differ by more than `most`. */
static int samples_apart(const Shot *a, const Shot *b, float most)
{
    int count = 0;
    for (int i = 0; i < a->frame.width * a->frame.height; i++) {
        float worst = 0;
        for (int c = 0; c < 4; c++)
            worst = fmaxf(worst, fabsf(a->frame.rgba[4 * i + c] - b->frame.rgba[4 * i + c]));
        count += !(worst <= most);
    }
    return count;
}

/* Spheres have special kernels there (sphere_rows.h): with one light, before other stages, and fallback where these do
   not apply, as from inside. Rounding may decide whether a sample at the silhouette is a hit. */
static void fast_spheres_stay_near_the_exact_ones(void **state)
{
    (void)state;
    WrField *field = bumpy_field(64, 64);
    for (int k = 0; k < 24; k++) {
        WrScene *scene = scene_of("sphere");
        if (k % 2) scene->bump = WR_BUMP_NONE;
        if (k % 3 == 1) scene->material.shininess = 7;
        if (k % 4 == 2) scene->lights[0].kind = WR_LIGHT_POINT;
        if (k % 5 == 3) scene->dials.aa = WR_AA_FILTER;
        if (k % 6 == 4) scene->camera.orthographic = true;
        if (k % 7 == 5) scene->material.model = WR_REFLECT_GGX;
        if (k % 8 >= 6)
            look_from(scene, 0.4, 0.3, k % 8 == 6 ? 1.15 : 0.5); /* the second is inside */
        for (int isa = 3; isa < 5; isa++) {
            const char *name = isa == 3 ? "v3" : "v4";
            if (!wr_kernels_get(name, true, NULL)) continue;
            scene->dials.arithmetic = WR_ARITHMETIC_EXACT;
            Shot exact = shoot(scene, field, 287, 131, 2, name, false);
            scene->dials.arithmetic = WR_ARITHMETIC_FAST;
            Shot fast = shoot(scene, field, 287, 131, 2, name, false);
            const int apart = samples_apart(&exact, &fast, 2e-3f);
            if (apart > 6 || exact.frame.covered < 2000)
                fail_msg("picture %d, %s: %d samples", k, name, apart);
            put_away(&exact);
            put_away(&fast);
        }
        wr_scene_free(scene);
    }
    wr_field_free(field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_agree_with_marched_rays_in_double),
        cmocka_unit_test(pictures_are_the_same_bits_on_any_threads_and_instruction_set),
        cmocka_unit_test(leaving_effects_out_changes_no_bit),
        cmocka_unit_test(every_surface_is_planned_to_the_bits_of_all_effects),
        cmocka_unit_test(an_edit_refreshes_what_a_new_renderer_would_make),
        cmocka_unit_test(a_resting_view_is_refreshed_to_the_bits_of_a_new_picture),
        cmocka_unit_test(fast_arithmetic_stays_near_the_exact_picture),
        cmocka_unit_test(fast_spheres_stay_near_the_exact_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

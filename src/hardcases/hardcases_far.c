/* Hard cases of HC156 and later: eyes inside, far away and close by, light from behind, seams. */
#include "hardcases/hardcases_later.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "field/field.h"
#include "scene/scene.h"
#include "base/vec.h"

#include <float.h>

bool wr_hard_tame(WrHardGauge *g, const WrField *field, const WrScene *scene, WrError *err)
{
    const WrFrameRequest request = { .field = field, .scene = scene, .width = 40, .height = 40 };
    bool good = true;
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot = { .renderer = NULL };
        good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
        if (good) wr_hard_holds(g, wr_hard_precision(way), wr_hard_wild(&shot) == 0);
        wr_hard_put_away(&shot);
    }
    WrReference reference = { 0 };
    good = good && wr_hard_refer(g, &request, 1, &reference, err);
    if (good) wr_hard_holds(g, WR_HARD_DOUBLE, wr_hard_wild_reference(&reference) == 0);
    wr_reference_fini(&reference);
    return good;
}

/* Share of pixels in which pictures of each arithmetic differ from the reference by more than `off`. */
static bool against_reference(WrHardGauge *g, const WrFrameRequest *request, int samples,
                              double off, WrError *err)
{
    const int count = request->width * request->height;
    WrReference reference = { 0 };
    bool good = wr_hard_refer(g, request, samples, &reference, err);
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot = { .renderer = NULL };
        int differ = 0;
        good = wr_hard_shoot_by(g, request, (WrHardWay)way, &shot, err);
        for (int i = 0; i < count && good; i++) {
            const float *p = shot.frame.rgba + 4 * (size_t)i;
            const double *q = reference.rgba + 4 * (size_t)i;
            differ += !(fabs((double)p[0] - q[0]) <= off && fabs((double)p[3] - q[3]) <= off);
        }
        if (good) wr_hard_off(g, wr_hard_precision(way), (double)differ / count);
        wr_hard_put_away(&shot);
    }
    wr_reference_fini(&reference);
    return good;
}

static WrScene *scene_of(WrSurfaceKind kind)
{
    WrScene *scene = wr_scene_new();
    scene->shape = wr_hard_shape(kind);
    scene->posed = true;
    scene->height = 0.002; /* the reference uses another scheme */
    return scene;
}

static void give_light(WrScene *scene, WrLightKind kind, WrVec3 where)
{
    scene->lights_given = true;
    scene->lights[0] =
        (WrLight){ .kind = kind, .where = where, .colour = { 1, 1, 1 }, .strength = 1 };
}

/* ---- eyes ---- */

bool wr_hard_hc158(WrHardGauge *g, WrError *err)
{
    static const struct {
        WrSurfaceKind kind;
        WrVec3 eye;
    } inside[] = {
        { WR_SURFACE_sphere, { 0, 0, 0 } },   { WR_SURFACE_sphere, { 0.9999, 0, 0 } },
        { WR_SURFACE_cube, { 0, 0, 0 } },     { WR_SURFACE_cube, { 0.1, 0.2, 0.499 } },
        { WR_SURFACE_cylinder, { 0, 0, 0 } }, { WR_SURFACE_cylinder, { 0, 0.65, 0.1 } },
        { WR_SURFACE_cone, { 0, 0, -0.2 } },  { WR_SURFACE_cone, { 0, 0, 0.7 } },
        { WR_SURFACE_torus, { 1, 0, 0 } },    { WR_SURFACE_torus, { 1.39, 0, 0 } },
    };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 10 && good; k++) {
        WrScene *scene = scene_of(inside[k].kind);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 48, .height = 48
        };
        const WrVec3 eye = inside[k].eye;
        give_light(scene, WR_LIGHT_POINT, v3_add(eye, (WrVec3){ -0.01, 0.02, 0.015 }));
        scene->camera = (WrCamera){ .eye = eye,
                                    .target = v3_add(eye, (WrVec3){ -1, 0.3, 0.2 }),
                                    .up = { 0, 0, 1 },
                                    .fov_deg = 70 };
        good = against_reference(g, &request, 1, 0.02, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

bool wr_hard_hc164(WrHardGauge *g, WrError *err)
{
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 1 && good; k++) {
        WrScene *scene = scene_of(WR_SURFACE_ribbon);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 32, .height = 32
        };
        scene->shape.value[4] = k ? -60 : 60;
        scene->height = 0.002;
        scene->material.specular = 0.0;
        scene->dials.aa = WR_AA_SUPERSAMPLE;
        scene->dials.samples = 8;
        give_light(scene, WR_LIGHT_DIRECTIONAL, (WrVec3){ 0.3, 0.4, 0.8 });
        scene->camera =
            (WrCamera){ .orthographic = true, .eye = { 0, 0, 5 }, .up = { 0, 1, 0 }, .size = 2.6 };
        good = against_reference(g, &request, 8, 0.05, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Orthographic from above, and a perspective view from near: each ray hits the cone. */
bool wr_hard_hc167(WrHardGauge *g, WrError *err)
{
    enum { SIZE = 41 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 12 && good; k++) {
        const double grow = k % 2 ? wr_hard_between(g, 1e3, 1e6) : wr_hard_between(g, 1e-6, 1);
        const double window = pow(10, -1 - k / 2) * grow;
        WrScene *scene = scene_of(WR_SURFACE_cone);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIZE, .height = SIZE
        };
        for (int p = 0; p < 2; p++) scene->shape.value[p] *= grow;
        scene->height = 1e-3 * grow;
        scene->camera = (WrCamera){
            .orthographic = true, .eye = { 0, 0, 5 * grow }, .up = { 0, 1, 0 }, .size = window
        };
        WrReference reference = { 0 };
        good = wr_hard_refer(g, &request, 1, &reference, err);
        for (int i = 0; i < SIZE * SIZE && good; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, reference.rgba[4 * i + 3] == 1.0);
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            if (good) wr_hard_holds(g, wr_hard_precision(way), shot.frame.covered == SIZE * SIZE);
            wr_hard_put_away(&shot);
        }
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* The middle column looks down by 45 degrees at its middle and by `far` at the ground's end: below that every
   pixel shows ground, in every arithmetic. */
static bool down_to_the_feet(WrHardGauge *g, const WrFrameRequest *request, double far,
                             WrError *err)
{
    const int size = request->height;
    WrReference reference = { 0 };
    bool good = wr_hard_refer(g, request, 1, &reference, err);
    for (int way = 0; way < WR_HARD_WAYS && good; way++) {
        WrHardShot shot = { .renderer = NULL };
        good = wr_hard_shoot_by(g, request, (WrHardWay)way, &shot, err);
        for (int y = 0; y < size && good; y++) {
            const double tangent = (1 - 2 * (y + 0.5) / size) * tan(60 * WR_RAD_PER_DEG);
            const size_t at = 4 * ((size_t)y * (size_t)size + (size_t)size / 2) + 3;
            if (WR_RAD_PER_DEG * 45 - atan(tangent) < far + 0.02) continue;
            if (!(shot.frame.rgba[at] == 1.0f)) wr_hard_off(g, wr_hard_precision(way), 1.0);
            if (!(reference.rgba[at] == 1.0)) wr_hard_off(g, WR_HARD_DOUBLE, 1.0);
        }
        wr_hard_put_away(&shot);
    }
    wr_reference_fini(&reference);
    return good;
}

/* The plane in closed form, and as a bent patch by mesh: flat, so that only its position matters. */
bool wr_hard_hc168(WrHardGauge *g, WrError *err)
{
    static const double sides[] = { 3, 2e5, 1.7e7 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 6 && good; k++) {
        const double side = sides[k / 2];
        WrScene *scene = scene_of(k % 2 ? WR_SURFACE_bent : WR_SURFACE_plane);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 60, .height = 60
        };
        scene->shape.value[0] = scene->shape.value[1] = side;
        if (k % 2) scene->shape.value[2] = scene->shape.value[3] = scene->shape.value[4] = 0.0;
        scene->height = scene->material.specular = 0.0;
        give_light(scene, WR_LIGHT_DIRECTIONAL, (WrVec3){ 0.2, 0.3, 0.7 });
        scene->camera = (WrCamera){
            .eye = { 0, 0, 0.5 }, .target = { 0, 0.5, 0 }, .up = { 0, 0, 1 }, .fov_deg = 120
        };
        good = against_reference(g, &request, 1, 0.02, err) &&
               down_to_the_feet(g, &request, atan(0.5 / (0.5 * side)), err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* An infinite plane: from above and below, looking up, along it and away from it, on it, and from so far that
   its sides are smaller than a pixel. The formula for the area of a far pixel is infinite. */
bool wr_hard_hc179(WrHardGauge *g, WrError *err)
{
    static const struct {
        double eye, up; /* the eye's height; the upward component of the view */
    } sights[] = { { 0.5, -0.1 },  { 0.5, 0 },    { -0.7, 0.2 }, { -0.7, -0.3 }, { 1e-6, 0 },
                   { -1e-9, 0.1 }, { 40, -0.02 }, { 1e6, -0.5 }, { 1e9, -1.5 },  { 0, 0 } };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 10 && good; k++) {
        WrScene *scene = scene_of(WR_SURFACE_plane);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 40, .height = 40
        };
        const WrVec3 eye = { wr_hard_between(g, -3, 3), wr_hard_between(g, -3, 3), sights[k].eye };
        scene->shape.value[2] = 1;
        scene->camera = (WrCamera){ .eye = eye,
                                    .target = v3_add(eye, (WrVec3){ 0.2, 1, sights[k].up }),
                                    .up = { 0, 0, 1 },
                                    .fov_deg = 60 };
        give_light(scene, WR_LIGHT_DIRECTIONAL, (WrVec3){ 0.2, 0.3, 0.7 });
        good = wr_hard_tame(g, field, scene, err);
        scene->height = scene->material.specular = 0.0;
        if (sights[k].eye != 0) good = good && against_reference(g, &request, 1, 0.02, err);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Below 0.01 degrees, compared with the equivalent window at the object. */
bool wr_hard_hc170(WrHardGauge *g, WrError *err)
{
    enum { SIZE = 72 };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < WR_SURFACE_COUNT && good; k++) {
        WrScene *scene = scene_of((WrSurfaceKind)k);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIZE, .height = SIZE
        };
        const double window = 2.4 * wr_shape_radius(&scene->shape);
        const double away = window / (2.0 * tan(0.005 * WR_RAD_PER_DEG));
        scene->rotate_deg = (WrVec3){ -50, 10, 0 };
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot far = { .renderer = NULL }, flat = { .renderer = NULL };
            scene->camera = (WrCamera){ .eye = { 0, 0, away }, .up = { 0, 1, 0 }, .fov_deg = 0.01 };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &far, err);
            scene->camera = (WrCamera){
                .orthographic = true, .eye = { 0, 0, 9 }, .up = { 0, 1, 0 }, .size = window
            };
            good = good && wr_hard_shoot_by(g, &request, (WrHardWay)way, &flat, err);
            if (good)
                wr_hard_off(g, wr_hard_precision(way),
                            (double)wr_hard_differ(&far, &flat, 0.002) / (4 * SIZE * SIZE));
            if (good) wr_hard_off(g, wr_hard_precision(way), flat.frame.covered > 300 ? 0.0 : 1.0);
            wr_hard_put_away(&far);
            wr_hard_put_away(&flat);
        }
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* Odd sizes put a pixel's centre on the corner towards the eye, and columns on edges. */
bool wr_hard_hc171(WrHardGauge *g, WrError *err)
{
    static const WrVec3 eyes[] = { { 3, 3, 3 }, { 3, 3, 0 }, { 0, -3, 3 }, { 3, 0, 0 } };
    WrField *field = wr_hard_waves(32, 32);
    bool good = true;
    for (int k = 0; k < 12 && good; k++) {
        const int size = 21 + 2 * (k / 4) * 17;
        WrScene *scene = scene_of(WR_SURFACE_cube);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = size, .height = size
        };
        /* inside the outline for any side: the sphere inscribed in the cube */
        scene->camera =
            (WrCamera){ .orthographic = true, .eye = eyes[k % 4], .up = { 0, 0, 1 }, .size = 0.69 };
        WrReference reference = { 0 };
        good = wr_hard_refer(g, &request, 1, &reference, err);
        for (int i = 0; i < size * size && good; i++)
            wr_hard_holds(g, WR_HARD_DOUBLE, reference.rgba[4 * i + 3] == 1.0);
        for (int way = 0; way < WR_HARD_WAYS && good; way++) {
            WrHardShot shot = { .renderer = NULL };
            good = wr_hard_shoot_by(g, &request, (WrHardWay)way, &shot, err);
            if (good) wr_hard_holds(g, wr_hard_precision(way), shot.frame.covered == size * size);
            wr_hard_put_away(&shot);
        }
        wr_reference_fini(&reference);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

/* right, up and forward: unit length, orthogonal, right-handed. */
bool wr_hard_hc172(WrHardGauge *g, WrError *err)
{
    WrScene *scene = scene_of(WR_SURFACE_torus);
    bool good = true;
    for (int k = 0; k < 300 && good; k++) {
        const WrVec3 view = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1),
                              k % 3 ? wr_hard_between(g, -1, 1) : 0.0 };
        const WrVec3 aside = { wr_hard_between(g, -1, 1), wr_hard_between(g, -1, 1), 0.3 };
        const double tilt = k % 4 ? pow(10, -k % 17) : 0.0;
        WrPlacement place;
        scene->camera =
            (WrCamera){ .eye = v3_scale(view, 7.0),
                        .up = v3_mad(v3_scale(view, k % 2 ? -1.0 : 1.0), aside, k % 5 ? tilt : 0),
                        .fov_deg = 30 };
        if (k % 20 == 0) scene->camera.up = (WrVec3){ 0, 0, 0 };
        good = wr_scene_place(scene, 0, 1, &place, err);
        if (!good) break;
        const WrVec3 axes[3] = { place.right, place.up, v3_neg(place.forward) };
        for (int a = 0; a < 3; a++) {
            wr_hard_near(g, WR_HARD_DOUBLE, v3_dot(axes[a], axes[a]), 1.0);
            wr_hard_near(g, WR_HARD_DOUBLE, v3_dot(axes[a], axes[(a + 1) % 3]), 0.0);
        }
        wr_hard_near(g, WR_HARD_DOUBLE, v3_dot(axes[2], v3_cross(axes[0], axes[1])), 1.0);
    }
    wr_scene_free(scene);
    return good;
}

/* ---- light from behind ---- */

/* v and l almost opposite: the rounding error of h is ulp / |l + v|; a power s makes s (n'.h) of it, or its
   square root of s near 1. */
bool wr_hard_hc166(WrHardGauge *g, WrError *err)
{
    (void)err;
    for (int k = 0; k < 4000; k++) {
        const double tilt = pow(10, -9 * wr_hard_random(g)), s = k % 3 ? 20 : 1000;
        const double around = 2.0 * WR_PI * wr_hard_random(g);
        const WrVec3 v = v3_unit((WrVec3){ cos(around), sin(around), wr_hard_between(g, 0, 0.5) },
                                 (WrVec3){ 0, 0, 1 });
        const WrVec3 n = { 0, 0, 1 };
        const WrVec3 aside = v3_unit(v3_cross(v, (WrVec3){ 0.1, 0.2, 1 }), n);
        /* h at random around n, as wide as the lobe */
        const WrVec3 h_way = v3_mad(n, aside, 3.0 * wr_hard_random(g) / sqrt(s));
        const WrVec3 l = v3_unit(v3_mad(v3_neg(v), h_way, tilt), n);
        for (int set = 0; set < g->all; set++) {
            WrStrip *strip = g->strip;
            const WrVec3f lf = v3f_from(l), vf = v3f_from(v);
            const WrKernLight lamp = { .where = { lf.x, lf.y, lf.z }, .rgb = { 1, 1, 1 } };
            strip->count = 1;
            strip->bx[0] = strip->by[0] = 0.0f, strip->bz[0] = 1.0f;
            strip->vx[0] = vf.x, strip->vy[0] = vf.y, strip->vz[0] = vf.z;
            strip->px[0] = strip->py[0] = strip->pz[0] = 0.0f;
            g->kernels[set]->begin(0.0f, strip);
            g->kernels[set]->light(&lamp, strip);
            g->kernels[set]->specular(&lamp, 1.0f, (float)s, false, strip);
            const WrVec3 h = v3_add(wr_hard_vec(lf), wr_hard_vec(vf));
            const double len = v3_len(h), got = (double)strip->sr[0];
            const double c = len > 1e-12 ? fmax(0.0, h.z / len) : 0.0;
            wr_hard_off(g, WR_HARD_FLOAT, got >= 0.0 && got <= 1.0 ? 0.0 : 2.0);
            wr_hard_off(g, WR_HARD_FLOAT,
                        fabs(got - pow(c, s)) / (s * (double)FLT_EPSILON / fmax(len, 1e-12)));
        }
        WrStripd *strip = g->wide_strip;
        const WrKernLightd lamp = { .where = { l.x, l.y, l.z }, .rgb = { 1, 1, 1 } };
        strip->count = 1;
        strip->bx[0] = strip->by[0] = 0.0, strip->bz[0] = 1.0;
        strip->vx[0] = v.x, strip->vy[0] = v.y, strip->vz[0] = v.z;
        strip->px[0] = strip->py[0] = strip->pz[0] = 0.0;
        g->wide[1]->begin(0.0, strip);
        g->wide[1]->light(&lamp, strip);
        g->wide[1]->specular(&lamp, 1.0, s, false, strip);
        const WrVec3 h = v3_add(l, v);
        const double len = v3_len(h), c = fmax(0.0, h.z / len);
        wr_hard_off(g, WR_HARD_DOUBLE, fabs(strip->sr[0] - pow(c, s)) / (s * DBL_EPSILON / len));
    }
    return true;
}

/* ---- seams and filters ---- */

/* The kernels' closed forms for rays that hit y = +-0: u is 0 where x > 0 and a half where x < 0. */
bool wr_hard_hc169(WrHardGauge *g, WrError *err)
{
    (void)err;
    static const float nothing[] = { 0.0f, -0.0f, 1e-45f, -1e-45f, 1e-20f, -1e-20f, 1e-9f, -1e-9f };
    static const WrSurfaceKind kinds[] = { WR_SURFACE_sphere, WR_SURFACE_cylinder,
                                           WR_SURFACE_cone };
    for (int k = 0; k < 3 * 8 * 2; k++) {
        const WrShape shape = wr_hard_shape(kinds[k % 3]);
        const bool behind = k / 24;
        WrShapef single;
        wr_shape_scaled(&shape, 1.0, &single);
        /* from x = +-9 towards the middle, a tenth of a unit below it */
        const float side = behind ? -1.0f : 1.0f, y = nothing[k / 3 % 8];
        const WrRays rays = { .q0 = { 0, y, -0.1f }, .d0 = { -side, 0, 0 }, .s_min = -9.0f };
        const WrRaysd wide = { .q0 = { 0, (double)y, -0.1 },
                               .d0 = { (double)-side, 0, 0 },
                               .s_min = -9.0 };
        for (int set = 0; set < g->all; set++) {
            const WrKernels *kernels = g->kernels[set];
            const WrRound *body = &kernels->round[wr_surfaces[kinds[k % 3]]->inversion];
            const int hits = body->hit(&rays, &single, 0, 0, 1, g->strip);
            body->params(&single, g->strip);
            const double u = (double)g->strip->u[0], want = behind ? 0.5 : 0.0;
            const double off = fabs(u - want), round = fmin(off, 1.0 - off);
            wr_hard_holds(g, WR_HARD_FLOAT, hits == 1 && u >= 0.0 && u < 1.0 && round < 1e-6);
        }
        const WrRoundd *body = &g->wide[1]->round[wr_surfaces[kinds[k % 3]]->inversion];
        const int hits = body->hit(&wide, &shape, 0, 0, 1, g->wide_strip);
        body->params(&shape, g->wide_strip);
        const double u = g->wide_strip->u[0], off = fabs(u - (behind ? 0.5 : 0.0));
        wr_hard_holds(g, WR_HARD_DOUBLE,
                      hits == 1 && u >= 0.0 && u < 1.0 && fmin(off, 1.0 - off) < 1e-6);
    }
    return true;
}

/* A table rolled by half on a body turned by half: the former seam is now at its back. Filters that used the
   step of u across the seam as a footprint would blur it. */
bool wr_hard_hc174(WrHardGauge *g, WrError *err)
{
    static const WrSurfaceKind kinds[] = { WR_SURFACE_cylinder, WR_SURFACE_torus,
                                           WR_SURFACE_sphere };
    WrField *field = wr_hard_waves(64, 64), *rolled = wr_hard_rolled(field, 32, 0);
    bool good = true;
    for (int k = 0; k < 3 * 4 && good; k++) {
        WrScene *scene = scene_of(kinds[k / 4]);
        WrFrameRequest request = { .field = field, .scene = scene, .width = 64, .height = 64 };
        WrHardShot seam = { .renderer = NULL }, back = { .renderer = NULL };
        scene->dials.aa = WR_AA_MOMENTS;
        scene->dials.moments = k % 2 ? WR_MOMENTS_LEAN : WR_MOMENTS_TOKSVIG;
        scene->dials.footprint = k / 2 % 2 ? WR_FOOTPRINT_ANISOTROPIC : WR_FOOTPRINT_ISOTROPIC;
        scene->camera =
            (WrCamera){ .orthographic = true, .eye = { 5, 0, 0.4 }, .up = { 0, 0, 1 }, .size = 3 };
        give_light(scene, WR_LIGHT_DIRECTIONAL, (WrVec3){ 1, 0.3, 0.5 });
        good = wr_hard_shoot(g, &request, &seam, err);
        request.field = rolled;
        scene->rotate_deg = (WrVec3){ 0, 0, 180 };
        good = good && wr_hard_shoot(g, &request, &back, err);
        for (int i = 0; i < 4 * 64 * 64 && good; i++) /* outlines may differ in a pixel */
            if (i % 4 < 3 && seam.frame.rgba[i / 4 * 4 + 3] == back.frame.rgba[i / 4 * 4 + 3])
                wr_hard_near(g, WR_HARD_FLOAT, (double)seam.frame.rgba[i],
                             (double)back.frame.rgba[i]);
        wr_hard_put_away(&seam);
        wr_hard_put_away(&back);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    wr_field_free(rolled);
    return good;
}

/* Compared with the picture without heights, without highlights: the highlight is spread, as it should be. */
bool wr_hard_hc163(WrHardGauge *g, WrError *err)
{
    static const double repeats[] = { 1e6, 1e6 / 3.0, 12345.678, -1e6 };
    WrField *field = wr_hard_waves(64, 64);
    bool good = true;
    for (int k = 0; k < 8 && good; k++) {
        WrScene *scene = scene_of(k % 2 ? WR_SURFACE_bent : WR_SURFACE_plane);
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = 48, .height = 48
        };
        WrHardShot level = { .renderer = NULL }, bumpy = { .renderer = NULL };
        scene->replicate_u = repeats[k / 2];
        scene->replicate_v = repeats[3 - k / 2];
        scene->material.specular = 0.0;
        scene->dials.aa = WR_AA_MOMENTS;
        scene->height = 0.0;
        good = wr_hard_shoot(g, &request, &level, err);
        scene->height = 0.01 / fabs(fmax(scene->replicate_u, scene->replicate_v));
        good = good && wr_hard_shoot(g, &request, &bumpy, err);
        for (int i = 0; i < 4 * 48 * 48 && good; i++)
            wr_hard_near(g, WR_HARD_FLOAT, (double)bumpy.frame.rgba[i],
                         (double)level.frame.rgba[i]);
        wr_hard_put_away(&level);
        wr_hard_put_away(&bumpy);
        wr_scene_free(scene);
    }
    wr_field_free(field);
    return good;
}

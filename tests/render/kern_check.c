/* kern_check.c - every span kernel of every instruction set of this processor, on random strips of every length 0..67
   (and a full one), against the plain C of "ref": `exact` sets must be bit-identical, `fast` sets stay within the
   stated bound. No value past the strip's length may change. kern_check [--seed N]; kern_check --bench prints
   nanoseconds per sample instead. */
#include "test.h"
#include "field/scheme_list.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "render/kernels/kern.h"
#include "shade/reflection_models.h"
#include "render/frame/pixel_encode.h"
#include "render/textures/slope_pyramid.h"
#include "system/clock.h"

#define LANES 16 /* kernels may write up to whole vectors (kern_body.h) */

/* Bounds of `fast` sets, relative to 1 or to the value, whichever is larger.

   Contraction and reordering change each rounding of a dot product of unit vectors by 2^-24 at most: 12 roundings with
   normalizing. Microfacet models divide by n'.v, which is 1e-3 for a normal bent towards the viewer (reflect_seen), so
   their relative error is 12 x 2^-24 / 1e-3. That of D = a^2 / w^2 is less, 4 x 12 x 2^-24 / a: the error of
   w = a^2 (n.h)^2 + |n x h|^2 is 2 x 12 x 2^-24 |n x h|, and |n x h| / w <= 1 / (2 a |n.h|) (HC99).

   The direction of a lamp in the tangent plane loses as many digits as E G - F^2, which is E G sin^2 of the angle between
   the tangents: sin^2 < 1e-3 for one random pair in 2000. */
#define FAST_BOUND 2e-4
#define FACET_BOUND (FAST_BOUND + 12 * 0x1p-24 / 1e-3)
#define TANGENT_BOUND (FAST_BOUND + 12 * 0x1p-24 * 1e3)

typedef struct Bench {
    WrStrip strip;
    WrRays rays;
    WrShapef shape[WR_SURFACE_COUNT];
    WrQuad quad;
    WrLook look;
    WrColourLook colour;
    WrKernLight light[2];
    float *heights, *gradient, *rgba;
    WrPyramid pyramid, range;
} Bench;

static float between(TestRandom *random, double low, double high)
{
    return (float)(low + (high - low) * test_random(random));
}

static void fill(TestRandom *random, float *out, int count, double low, double high)
{
    for (int i = 0; i < count; i++) out[i] = between(random, low, high);
}

/* Random unit vectors into three rows. */
static void fill_units(TestRandom *random, float *x, float *y, float *z)
{
    for (int i = 0; i < WR_SPAN; i++) {
        WrVec3 a = { between(random, -1, 1), between(random, -1, 1), between(random, -1, 1) };
        a = v3_unit(a, (WrVec3){ 0, 0, 1 });
        x[i] = (float)a.x, y[i] = (float)a.y, z[i] = (float)a.z;
    }
}

static void fill_strip(TestRandom *random, WrStrip *s)
{
    memset(s, 0, sizeof *s);
    fill(random, s->u, WR_SPAN, 0, 1);
    fill(random, s->v, WR_SPAN, 0, 1);
    for (int i = 0; i < WR_SPAN; i++) s->index[i] = i;
    float *wide[] = { s->px,  s->py,  s->pz,  s->pux, s->puy, s->puz, s->pvx, s->pvy, s->pvz,
                      s->nux, s->nuy, s->nuz, s->nvx, s->nvy, s->nvz, s->fu,  s->fv };
    for (size_t k = 0; k < sizeof wide / sizeof *wide; k++) fill(random, wide[k], WR_SPAN, -2, 2);
    fill(random, s->f, WR_SPAN, -0.2, 0.2);
    fill(random, s->n_len, WR_SPAN, 0.01, 3);
    fill_units(random, s->nx, s->ny, s->nz);
    fill_units(random, s->bx, s->by, s->bz);
    fill_units(random, s->vx, s->vy, s->vz);
    fill_units(random, s->lx, s->ly, s->lz);
    fill(random, s->n_dot_l, WR_SPAN, -1, 1);
    float *colour[] = { s->dr, s->dg, s->db, s->sr, s->sg, s->sb, s->cr, s->cg, s->cb };
    for (size_t k = 0; k < sizeof colour / sizeof *colour; k++)
        fill(random, colour[k], WR_SPAN, 0, 1);
    fill(random, s->x, WR_SPAN, 0, 63);
    fill(random, s->y, WR_SPAN, 0, 63);
    float *texels[] = { s->rx, s->ry, s->wx, s->wy };
    for (int k = 0; k < 4; k++) fill(random, texels[k], WR_SPAN, -9, 9);
    fill(random, s->level, WR_SPAN, 0.01, 4.99);
    fill(random, s->suu, WR_SPAN, 0, 3);
    fill(random, s->svv, WR_SPAN, 0, 3);
    fill(random, s->suv, WR_SPAN, -1, 1);
    fill(random, s->see, WR_SPAN, 0, 0.3);
    fill(random, s->sff, WR_SPAN, 0, 0.3);
    fill(random, s->sef, WR_SPAN, -0.05, 0.05);
    fill_units(random, s->ex, s->ey, s->ez);
    float *bounds[] = { s->reach, s->turn, s->swing, s->bound };
    for (int k = 0; k < 4; k++) fill(random, bounds[k], WR_SPAN, 0, 0.3);
    for (int i = 0; i < WR_SPAN; i++) {
        s->u_low[i] = s->u[i] - 0.01f, s->u_high[i] = s->u[i] + 0.02f;
        s->v_low[i] = s->v[i] - 0.03f, s->v_high[i] = s->v[i] + 0.01f;
        s->fu_low[i] = s->fu[i] - 0.4f, s->fu_high[i] = s->fu[i] + 0.2f;
        s->fv_low[i] = s->fv[i] - 0.1f, s->fv_high[i] = s->fv[i] + 0.3f;
    }
    s->suu[3] = s->suv[3] = s->svv[3] = 0.0f;
    s->rx[5] = s->ry[5] = s->wx[5] = s->wy[5] = 0.0f;
    /* Corners of each range: level slopes, no normal, limits of the parameters. */
    s->fu[3] = s->fv[3] = s->f[3] = 0.0f;
    s->fu[5] = 3e38f, s->fv[5] = -1e38f;
    s->n_len[7] = 0.0f;
    s->u[9] = 0.0f, s->v[9] = 1.0f, s->u[11] = 1.0f, s->v[11] = 0.0f;
}

/* A view of the unit sphere from (0, 0, 4), 64 samples high. */
static WrRays some_rays(bool perspective)
{
    const float step = 2.4f / 64;
    WrRays rays = { .q0 = { -1.2f, 1.2f, 0 },
                    .qx = { step, 0, 0 },
                    .qy = { 0, -step, 0 },
                    .d0 = { 0, 0, -1 },
                    .s_min = -3.9f,
                    .perspective = perspective,
                    .eye = { 0, 0, 4 },
                    .toward = { 0, 0, 1 } };
    if (!perspective) return rays;
    rays.d0[0] = -0.3f, rays.d0[1] = 0.3f;
    rays.dx[0] = step / 4, rays.dy[1] = -step / 4;
    return rays;
}

#define SIDE 37 /* texels of the test table */

static void bench_init(Bench *b, TestRandom *random)
{
    const int pitch = SIDE + 2 * WR_APRON;
    b->heights = wr_alloc((size_t)(pitch * pitch), sizeof(float));
    b->gradient = wr_alloc((size_t)(pitch * pitch), 2 * sizeof(float));
    b->rgba = wr_alloc((SIDE + 2) * (SIDE + 2), 4 * sizeof(float));
    fill(random, b->heights, pitch * pitch, -1, 1);
    fill(random, b->gradient, 2 * pitch * pitch, -30, 30);
    fill(random, b->rgba, 4 * (SIDE + 2) * (SIDE + 2), 0, 1);
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        WrShape shape;
        wr_shape_default((WrSurfaceKind)kind, &shape);
        wr_shape_scaled(&shape, 1, &b->shape[kind]);
    }
    b->quad = (WrQuad){
        { -0.9f, -0.8f, 0 }, { 0, 0, 1 }, { 0.6f, 0, 0 }, { 0, 0.6f, 0 }, 0, 1, 0, 1, 0, 1
    };
    WrField *field = wr_field_new(SIDE, SIDE, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) wr_field_set(field, i, j, between(random, -1, 1));
    assert_true(wr_pyramid_update(&b->pyramid, WR_PYRAMID_MOMENTS, field, NULL, NULL));
    assert_true(wr_pyramid_update(&b->range, WR_PYRAMID_RANGE, field, NULL, NULL));
    wr_field_free(field);
    b->look = (WrLook){ .heights = b->heights,
                        .gradient = b->gradient,
                        .pitch = pitch,
                        .width = SIDE,
                        .height = SIDE,
                        .ru = 3,
                        .rv = 2,
                        .periodic_u = true,
                        .periodic_v = true,
                        .scale_f = 0.1f,
                        .scale_u = 0.3f,
                        .scale_v = 0.2f };
    b->colour = (WrColourLook){ b->rgba, SIDE + 2, SIDE, SIDE, 3, 2, true, true };
    b->light[0] = (WrKernLight){ false, { 0.6f, 0, 0.8f }, { 1, 0.9f, 0.8f }, 0, false };
    b->light[1] = (WrKernLight){ true, { 1, 3, 5 }, { 0.5f, 0.9f, 1 }, 0, false };
}

static void bench_fini(Bench *b)
{
    wr_free(b->heights);
    wr_free(b->gradient);
    wr_free(b->rgba);
    wr_pyramid_drop(&b->pyramid);
    wr_pyramid_drop(&b->range);
}

/* Test of one kernel, identified by (family, member). Returns false past the last member. */
typedef bool (*Run)(const WrKernels *k, Bench *b, int member, int count);

static const int ways[] = { WR_INVERT_SPHERE, WR_INVERT_CYLINDER, WR_INVERT_CONE };

static bool run_hit(const WrKernels *k, Bench *b, int member, int count)
{
    const int shapes[] = { WR_SURFACE_sphere, WR_SURFACE_cylinder, WR_SURFACE_cone };
    if (member >= 8) return false;
    b->rays = some_rays(member & 1);
    if (member < 6)
        k->round[ways[member / 2]].hit(&b->rays, &b->shape[shapes[member / 2]], 3, 31, count,
                                       &b->strip);
    else k->hit_quad(&b->rays, &b->quad, 3, 31, count, &b->strip);
    return true;
}

/* u and v, the normal alone, the frame, from points near the surface. */
static bool run_round(const WrKernels *k, Bench *b, int member, int count)
{
    static const int shapes[] = { WR_SURFACE_sphere, WR_SURFACE_cylinder, WR_SURFACE_cone };
    if (member >= 9) return false;
    const WrShapef *shape = &b->shape[shapes[member / 3]];
    b->strip.count = count;
    switch (member % 3) {
    case 0: k->round[ways[member / 3]].params(shape, &b->strip); break;
    case 1: k->round[ways[member / 3]].tangents(shape, &b->strip); break;
    default: k->round[ways[member / 3]].normals(shape, &b->strip); break;
    }
    return true;
}

static bool run_polish(const WrKernels *k, Bench *b, int member, int count)
{
    if (member >= WR_SURFACE_COUNT) return false;
    const WrNewton how = { .reach_u = 0.02f, .reach_v = 0.02f, .closed_u = true, .steps = 2 };
    b->rays = some_rays(true);
    b->strip.count = count;
    for (int i = 0; i < count; i++) {
        b->strip.x[i] = 3 + (float)b->strip.index[i];
        b->strip.y[i] = 31;
    }
    k->polish[member](&b->rays, &b->shape[member], &how, &b->strip);
    return true;
}

static bool run_geometry(const WrKernels *k, Bench *b, int member, int count)
{
    if (member >= WR_SURFACE_COUNT) return false;
    b->strip.count = count;
    k->geometry[member](&b->shape[member], member == WR_SURFACE_cube ? 4 : 0, &b->strip);
    return true;
}

static bool run_curvature(const WrKernels *k, Bench *b, int member, int count)
{
    if (member >= WR_SURFACE_COUNT) return false;
    b->strip.count = count;
    k->curvature[member](&b->shape[member], 0, &b->strip);
    return true;
}

static bool run_points(const WrKernels *k, Bench *b, int member, int count)
{
    if (member >= WR_SURFACE_COUNT) return false;
    WrStrip *s = &b->strip;
    k->points[member](&b->shape[member], count, s->u, s->v, s->px, s->py, s->pz);
    return true;
}

/* Members vary the scheme, then periodic and clamped axes, narrow and wide. */
static bool run_look(const WrKernels *k, Bench *b, int member, int count)
{
    if (member >= 8 * WR_SCHEME_COUNT) return false;
    int how = member / WR_SCHEME_COUNT;
    b->look.periodic_u = how & 1, b->look.periodic_v = how & 2, b->look.wide = how & 4;
    b->strip.count = count;
    k->look[member % WR_SCHEME_COUNT](&b->look, &b->strip);
    return true;
}

static bool run_bump(const WrKernels *k, Bench *b, int member, int count)
{
    if (member >= 2 * WR_BUMP_COUNT) return false;
    b->rays = some_rays(member >= WR_BUMP_COUNT);
    b->strip.count = count;
    k->bump[member % WR_BUMP_COUNT](&b->rays, &b->strip);
    return true;
}

/* Blinn's n' of a sphere, from its tangents or in one step. */
static bool run_bend(const WrKernels *k, Bench *b, int member, int count)
{
    WrStrip *s = &b->strip;
    const WrShapef *sphere = &b->shape[WR_SURFACE_sphere];
    if (member >= 2) return false;
    b->rays = some_rays(member & 1);
    s->count = count;
    for (int i = 0; i < WR_SPAN; i++) s->px[i] = s->nx[i], s->py[i] = s->ny[i], s->pz[i] = s->nz[i];
    wr_kernels_get("ref", false, NULL)->round[WR_INVERT_SPHERE].tangents(sphere, s);
    if (k->bend[WR_INVERT_SPHERE]) k->bend[WR_INVERT_SPHERE](&b->rays, sphere, s);
    else k->bump[WR_BUMP_BLINN](&b->rays, s);
    return true;
}

static bool run_light(const WrKernels *k, Bench *b, int member, int count)
{
    WrStrip *s = &b->strip;
    s->count = count;
    b->rays = some_rays(member & 1);
    switch (member) {
    case 0:
    case 1: k->view(&b->rays, s); return true;
    case 2: k->begin(0.1f, s); return true;
    case 3: k->colour(&b->colour, s); return true;
    case 4: k->light(&b->light[0], s); return true;
    case 5: k->light(&b->light[1], s); return true;
    case 6: k->diffuse(&b->light[0], 0.7f, s); return true;
    case 7: k->specular(&b->light[0], 0.4f, 40, true, s); return true;
    case 8: k->specular(&b->light[1], 0.4f, 0, false, s); return true;
    case 9: k->finish((const float[3]){ 0.8f, 0.7f, 0.6f }, s); return true;
    default: return false;
    }
}

/* All parts of a light in one pass, then conversion to codes. */
static bool run_shade(const WrKernels *k, Bench *b, int member, int count)
{
    if (member >= 32) return false;
    const WrKernShine shine = { 0.4f, 17, member & 16 };
    const WrKernMaterial material = { 0.1f, 0.7f, { 0.8f, 0.7f, 0.6f } };
    b->strip.count = count;
    b->rays = some_rays(member & 1);
    k->shade[member >> 1 & 1][member & 1][member >> 2 & 1][member >> 3 & 1](
        &b->rays, &b->light[member >> 1 & 1], &shine, &material, &b->strip);
    return true;
}

/* Turns each n' to the viewer, as loops that bend none require. */
static void face_viewer(WrStrip *s)
{
    for (int i = 0; i < WR_SPAN; i++) {
        const float nv = s->bx[i] * s->vx[i] + s->by[i] * s->vy[i] + s->bz[i] * s->vz[i];
        const bool flat = fabsf(nv) < (float)WR_FACED_FROM;
        const float sign = nv < 0 ? -1.0f : 1.0f;
        s->bx[i] = flat ? s->vx[i] : sign * s->bx[i];
        s->by[i] = flat ? s->vy[i] : sign * s->by[i];
        s->bz[i] = flat ? s->vz[i] : sign * s->bz[i];
    }
}

/* The reflection models in both forms, unchanged and roughened; coloured highlights. */
static bool run_reflect(const WrKernels *k, Bench *b, int member, int count)
{
    const int model = member / 10, way = member % 10;
    WrStrip *s = &b->strip;
    s->count = count;
    if (model == WR_REFLECT_COUNT && way == 0) {
        const float axis[3] = { 0.6f, 0, 0.8f }, v0[3] = { 0, 0.6f, 0.8f }, l0[3] = { 1, 0, 0 };
        float found[4];
        k->survey(axis, v0, l0, s, found);
        for (int i = 0; i < 4 && count >= 6; i++) s->cr[i] = found[i];
        if (count >= 6) s->cr[4] = k->faces(s), s->cr[5] = k->gathered(s);
        return true;
    }
    if (model >= WR_REFLECT_COUNT) return false;
    if (model == WR_REFLECT_BLINN_PHONG) {
        k->tint(0.3f, s);
        return true;
    }
    const WrKernMatter matter = { .kd = 0.7f,
                                  .ks = 0.4f,
                                  .colour = { 0.8f, 0.7f, 0.6f },
                                  .shininess = 17,
                                  .scale = 0.25f,
                                  .alpha = 0.5f,
                                  .ior = 1.5f,
                                  .f0 = 0.04f,
                                  .least = 1e-5f,
                                  .metal = 0.3f,
                                  .a = 0.9f,
                                  .b = 0.2f,
                                  .mean = 0.9f,
                                  .again = 10,
                                  .albedo = { 1, 0.1f, -1.3f, 0.7f, 0.05f, 0.01f, -0.2f, 0.1f } };
    if (way % 5 >= WR_REFLECT_FACING) face_viewer(s);
    k->reflect[model][way / 5](&b->light[0], &matter, (WrReflectSpread)(way % 5), s);
    return true;
}

static bool run_surround(const WrKernels *k, Bench *b, int member, int count)
{
    float texels[4 * 8 * 6];
    WrStrip *s = &b->strip;
    WrKernSurround how = { .kd = 0.7f, .colour = { 0.8f, 0.7f, 0.6f }, .mean = 0.9f };
    WrKernMirror mirror = { .axes = { 0.6f, 0, 0.8f, 0, 1, 0, -0.8f, 0, 0.6f },
                            .strength = 1.3f,
                            .rgba = texels + 4 * 9,
                            .pitch = 8,
                            .width = 6,
                            .height = 4,
                            .even = { 0.3f, 0.4f, 0.5f } };
    s->count = count;
    for (int i = 0; i < 4 * 8 * 6; i++) texels[i] = 0.1f + 0.037f * (float)(i * 5 % 23);
    for (int i = 0; i < 3 * WR_FORM_TERMS; i++)
        how.form[i / WR_FORM_TERMS][i % WR_FORM_TERMS] = 0.9f - 0.057f * (float)i;
    for (int i = 0; i < WR_ALBEDO_TERMS; i++) {
        how.matt[i] = mirror.own[i] = 0.31f - 0.04f * (float)i;
        how.again[i] = mirror.white[i] = 0.02f * (float)i;
    }
    if (member < 6) k->surround[member / 3][member % 3](&how, s);
    else if (member < 8) (member == 6 ? k->mirror : k->mirror_even)(&mirror, s);
    return member < 8;
}

/* Smooth functions of roughness and n.v, as light shares are. */
static void fill_shares(float (*of)[WR_SVBRDF_TERMS], float first)
{
    for (int i = 0; i < WR_SVBRDF_STEPS * WR_ALBEDO_TERMS; i++) {
        const int step = i / WR_ALBEDO_TERMS, term = i % WR_ALBEDO_TERMS;
        of[step][term] = (first - 0.043f * (float)term) * (1 - 0.021f * (float)step);
    }
}

/* Roughness and metalness per sample: reflection models, diffuse environment light, reflections. */
static bool run_vary(const WrKernels *k, Bench *b, int member, int count)
{
    static const WrReflect models[] = { WR_REFLECT_TORRANCE_SPARROW, WR_REFLECT_OREN_NAYAR,
                                        WR_REFLECT_GGX };
    const WrKernMatter matter = { .kd = 0.7f,
                                  .ks = 0.4f,
                                  .colour = { 0.8f, 0.7f, 0.6f },
                                  .scale = 0.25f,
                                  .ior = 1.5f,
                                  .f0 = 0.04f };
    float texels[2][4 * 8 * 6];
    WrKernSurround how = { .kd = 0.7f, .colour = { 0.8f, 0.7f, 0.6f } };
    WrKernMirror mirror = { .axes = { 0.6f, 0, 0.8f, 0, 1, 0, -0.8f, 0, 0.6f }, .strength = 1.3f };
    WrKernVary vary = { .metals = true, .again_twice = member & 1, .alike = member & 2 };
    WrStrip *s = &b->strip;
    s->count = count;
    memcpy(s->rough, s->cr, sizeof s->rough);
    memcpy(s->metal, s->cg, sizeof s->metal);
    s->rough[2] = -0.5f, s->rough[4] = 0, s->rough[6] = 1, s->rough[8] = 1.5f, s->metal[1] = 2;
    for (int i = 0; i < 4 * 8 * 6; i++) {
        texels[0][i] = 0.1f + 0.037f * (float)(i * 5 % 23);
        texels[1][i] = 0.2f + 0.029f * (float)(i * 7 % 19);
    }
    for (int i = 0; i < 3 * WR_FORM_TERMS; i++)
        how.form[i / WR_FORM_TERMS][i % WR_FORM_TERMS] = 0.9f - 0.057f * (float)i;
    for (int i = 0; i < WR_SVBRDF_STEPS; i++)
        vary.mean[i] = 0.9f - 0.01f * (float)i, vary.again[i] = 0.3f + 0.2f * (float)i;
    fill_shares(vary.albedo, 0.4f), fill_shares(vary.matt, 0.6f), fill_shares(vary.twice, 0.1f);
    for (int i = 0; i < 2; i++)
        fill_shares(vary.own[i], 0.2f + 0.3f * (float)i), fill_shares(vary.white[i], 0.37f);
    for (int i = 0; i < WR_SVBRDF_RUNGS; i++)
        vary.rung[i] = (WrKernMipLevel){ texels[i % 2] + 4 * 9, 8, 6 - i % 2, 4 };
    if (member < 18)
        k->reflect_vary(&b->light[0], &matter, &vary, models[member / 6], member % 2,
                        (WrReflectSpread)(member % 6 / 2), s);
    else if (member < 20) k->surround_vary(&how, &vary, s);
    else if (member < 24) k->mirror_vary(&mirror, &vary, member & 1, s);
    return member < 24;
}

/* Lights of both kinds, point and area, over a table's horizons; ambient occlusion; caching. Shares are compared in
   the strip. */
static bool run_shadow(const WrKernels *k, Bench *b, int member, int count)
{
    enum { WIDE = 7, HIGH = 5, WAYS = 8 };
    float slope[WAYS * (WIDE + 1) * (HIGH + 1)], share[WR_SPAN] = { 0 };
    WrKernHorizon horizon = { slope, slope, WIDE, HIGH, WAYS, 3.3f, -2.7f, 0.31f, 0 };
    WrKernLight light = b->light[member & 1];
    WrStrip *s = &b->strip;
    s->count = count;
    for (int i = 0; i < WAYS * (WIDE + 1) * (HIGH + 1); i++) {
        slope[i] = 0.05f * (float)(i * 7 % 13);
        horizon.steepest = fmaxf(horizon.steepest, slope[i]);
    }
    light.radius = member & 2 ? 0.3 : 0;
    for (int i = 0; i < count; i += 3) /* faces the viewer for any n' */
        s->bx[i] = s->nx[i], s->by[i] = s->ny[i], s->bz[i] = s->nz[i];
    if (member < 4) s->count += 100 * (int)k->shadow(&light, &horizon, s, share);
    else if (member == 4) k->open(&horizon, s, share);
    else if (member < 7) k->veil(s->cr, member == 5 ? NULL : s->cb, count, s->cg);
    if (member < 5) memcpy(s->cr, share, (size_t)count * sizeof *share);
    return member < 7;
}

static bool run_hit_at(const WrKernels *k, Bench *b, int member, int count)
{
    const int shapes[] = { WR_SURFACE_sphere, WR_SURFACE_cylinder, WR_SURFACE_cone };
    if (member >= 8) return false;
    b->rays = some_rays(member & 1);
    if (member < 6)
        k->round[ways[member / 2]].hit_at(&b->rays, &b->shape[shapes[member / 2]], count,
                                          &b->strip);
    else k->hit_quad_at(&b->rays, &b->quad, count, &b->strip);
    return true;
}

/* Footprints, levels, mip pyramids on periodic and clamped axes, widened highlights. */
static bool run_filter(const WrKernels *k, Bench *b, int member, int count)
{
    WrStrip *s = &b->strip;
    WrLook look = b->look;
    const WrKernShine shine = { 0.4f, 40, member & 1 };
    b->rays = some_rays(member & 1);
    look.pyramid = &b->pyramid;
    look.periodic_u = member & 1, look.periodic_v = member & 2;
    s->count = count;
    switch (member) {
    case 0:
    case 1: k->footprint(&b->rays, &look, 1, s); return true;
    case 2:
    case 3: k->spread(&look, member & 1, s); return true;
    case 4:
    case 5:
    case 6:
    case 7: k->look_pyramid(&look, member & 2, s); return true;
    case 8:
    case 9: k->widen(member & 1, s); return true;
    case 10:
    case 11: k->specular_lean(&b->light[member & 1], &shine, s); return true;
    case 12:
    case 13: k->specular_toksvig(&b->light[member & 1], &shine, s); return true;
    case 14:
    case 15: k->colour_pyramid(&look, s); return true;
    default: return false;
    }
}

static bool run_bound(const WrKernels *k, Bench *b, int member, int count)
{
    WrStrip *s = &b->strip;
    WrLook look = b->look;
    const WrKernShine shine = { 0.4f, 40, member & 1 };
    b->rays = some_rays(member & 1);
    look.range = &b->range;
    look.periodic_u = member & 1;
    s->count = count;
    switch (member) {
    case 0:
    case 1: k->bound_sphere(&b->rays, &b->shape[WR_SURFACE_sphere], 0.5f, s); return true;
    case 2:
    case 3: k->bound_quad(&b->rays, &b->quad, 0.5f, s); return true;
    case 4:
    case 5: k->bound_slopes(&look, s); return true;
    case 6:
    case 7: k->bound_normal(member & 1, true, s); return true;
    case 8:
    case 9: k->bound_light(&b->rays, &b->light[member & 1], &shine, 0.7f, s); return true;
    default: return false;
    }
}

static const struct {
    const char *name;
    Run run;
    double fast_bound;
} families[] = {
    { "hit", run_hit, FAST_BOUND },
    { "round", run_round, FAST_BOUND },
    { "polish", run_polish, FAST_BOUND },
    { "geometry", run_geometry, FAST_BOUND },
    { "curvature", run_curvature, FAST_BOUND },
    { "points", run_points, FAST_BOUND },
    { "look", run_look, FAST_BOUND },
    { "bump", run_bump, FAST_BOUND },
    { "light", run_light, FAST_BOUND },
    { "shade", run_shade, FAST_BOUND },
    { "hit at", run_hit_at, FAST_BOUND },
    { "filter", run_filter, FAST_BOUND },
    { "bound", run_bound, FAST_BOUND },
    { "bend", run_bend, FAST_BOUND },
    { "reflect", run_reflect, FACET_BOUND },
    { "surround", run_surround, FAST_BOUND },
    { "vary", run_vary, FACET_BOUND },
    { "shadow", run_shadow, TANGENT_BOUND },
};
#define FAMILIES (int)(sizeof families / sizeof *families)

static uint64_t seed = 20241;

/* Random numbers of one member: those of others do not shift when a model or a member is added. */
static TestRandom member_random(const char *family, int member)
{
    uint64_t state = seed;
    for (const char *c = family; *c; c++) state = state * 31 + (uint64_t)*c;
    return (TestRandom){ state * 1000003 + (uint64_t)member };
}

/* Beyond any surface: where a ray runs nearly parallel to it, rounding decides how far. */
#define FAR_AWAY 1e12f

static bool near_enough(float a, float b, double bound)
{
    if (a == b && !signbit(a) == !signbit(b)) return true;
    if (memcmp(&a, &b, sizeof a) == 0) return true; /* not numbers */
    if (bound >= 0 && ((a > FAR_AWAY && b > FAR_AWAY) || (a < -FAR_AWAY && b < -FAR_AWAY)))
        return true;
    double scale = fmax(1.0, fmax(fabs((double)a), fabs((double)b)));
    return fabs((double)a - (double)b) <= bound * scale;
}

/* Compare two strips of `length` samples, bit by bit if bound < 0: results in the first elements (more for rows of
   pairs and fours); no change past them except in whole vectors. Every member after `index` consists of rows of WR_SPAN
   four-byte values. */
static void compare(const WrStrip *got, const WrStrip *want, int length, double bound,
                    const char *what)
{
    const size_t whole = ((size_t)length + LANES - 1) / LANES * LANES;
    const float *a = (const float *)(const void *)got->index;
    const float *b = (const float *)(const void *)want->index;
    size_t count = (sizeof *got - offsetof(WrStrip, index)) / sizeof(float);
    assert_int_equal(got->count, want->count);
    if (memcmp(a, b, count * sizeof *a) == 0) return;
    for (size_t i = 0; i < count; i++)
        if ((i % WR_SPAN < (size_t)length || i % WR_SPAN >= whole) &&
            !near_enough(a[i], b[i], bound))
            fail_msg("%s: row %zu, sample %zu: %.9g, ref %.9g", what, i / WR_SPAN, i % WR_SPAN,
                     (double)a[i], (double)b[i]);
}

/* Results that amplify rounding, so that fast arithmetic is unconstrained: Newton may stop elsewhere when a residual
   ties (only its point counts); the footprint of nearly parallel tangents; the limit of a bound's validity. */
static bool ill_posed(Run run, int member)
{
    return run == run_polish || run == run_bound || (run == run_filter && member < 2);
}

static void check_set(const WrKernels *set, const WrKernels *ref)
{
    TestRandom tables = { seed };
    Bench *b = wr_alloc(1, sizeof *b), *r = wr_alloc(1, sizeof *r);
    WrStrip *filled = wr_alloc(1, sizeof *filled);
    bench_init(b, &tables);
    for (int f = 0; f < FAMILIES; f++)
        for (int member = 0;; member++) {
            const double bound = set->exact ? -1 : families[f].fast_bound;
            TestRandom random = member_random(families[f].name, member);
            bool any = true;
            for (int count = 0; count <= 68 && any; count++) {
                char what[80];
                int length = count == 68 ? WR_SPAN : count;
                if (count % 6 == 0) fill_strip(&random, filled);
                b->strip = *filled;
                *r = *b;
                any = families[f].run(set, b, member, length);
                families[f].run(ref, r, member, length);
                snprintf(what, sizeof what, "%s%s %s[%d], %d samples", set->exact ? "" : "fast ",
                         set->name, families[f].name, member, length);
                if (set->exact || !ill_posed(families[f].run, member))
                    compare(&b->strip, &r->strip, length, bound, what);
            }
            if (!any) break;
        }
    bench_fini(b);
    wr_free(filled);
    wr_free(b);
    wr_free(r);
}

static void exact_kernels_give_the_bits_of_the_reference(void **state)
{
    (void)state;
    const char *const names[] = { "v1", "v2", "v3", "v4" };
    const WrKernels *ref = wr_kernels_get("ref", false, NULL);
    printf("seed %llu\n", (unsigned long long)seed);
    for (int i = 0; i < 4; i++) {
        const WrKernels *set = wr_kernels_get(names[i], false, NULL);
        if (set) check_set(set, ref);
        else printf("%s: this processor does not have it\n", names[i]);
    }
}

static void fast_kernels_stay_within_their_bound(void **state)
{
    (void)state;
    const char *const names[] = { "v3", "v4" };
    const WrKernels *ref = wr_kernels_get("ref", false, NULL);
    for (int i = 0; i < 2; i++) {
        const WrKernels *set = wr_kernels_get(names[i], true, NULL);
        if (set) check_set(set, ref);
    }
}

/* Codes are integers: every set returns the same, for strips and for premultiplied colours. */
static void all_sets_make_the_same_codes(void **state)
{
    (void)state;
    const char *const names[] = { "v1", "v2", "v3", "v4" };
    static uint32_t bins[WR_CODE_BINS + 1], want[WR_SPAN], got[WR_SPAN];
    static float rgba[WR_SPAN + 1][4];
    const float ground[3] = { 0.3f, 0.05f, 0.9f };
    const WrKernels *ref = wr_kernels_get("ref", false, NULL);
    TestRandom random = { seed };
    WrStrip *strip = wr_alloc(1, sizeof *strip);
    wr_code_bins_fill(bins);
    for (int round = 0; round < 40; round++) {
        const int count = round < 20 ? round : 237 + round % 20;
        fill_strip(&random, strip);
        strip->count = count;
        for (int i = 0; i < (WR_SPAN + 1) * 4; i++)
            rgba[i / 4][i % 4] = (float)test_random(&random);
        strip->cg[3] = NAN, strip->cb[7] = -INFINITY, rgba[5][1] = INFINITY;
        for (int i = 0; i < 4; i++) {
            const WrKernels *set = wr_kernels_get(names[i], false, NULL);
            if (!set) continue;
            assert_int_equal(set->codes(bins, strip, got), ref->codes(bins, strip, want));
            assert_memory_equal(got, want, (size_t)count * sizeof *got);
            assert_int_equal(set->codes_over(bins, ground, count, rgba[0], got),
                             ref->codes_over(bins, ground, count, rgba[0], want));
            assert_memory_equal(got, want, (size_t)count * sizeof *got);
        }
        for (int i = 0; i < 4; i++) {
            const WrKernels *set = wr_kernels_get(names[i], false, NULL);
            const WrToneCurve tone = { 1.37f, round & 1 ? 0.5f : 3e38f, false, NULL };
            if (!set) continue;
            assert_int_equal(set->codes_behind(bins, &tone, rgba[1], count, rgba[0], got),
                             ref->codes_behind(bins, &tone, rgba[1], count, rgba[0], want));
            assert_memory_equal(got, want, (size_t)count * sizeof *got);
        }
        if (count > 7) assert_true(ref->codes(bins, strip, want) >= 2);
    }
    wr_free(strip);
}

static void unknown_sets_are_refused(void **state)
{
    (void)state;
    WrError err = { "" };
    assert_null(wr_kernels_get("v9", false, &err));
    assert_non_null(strstr(err.text, "v9"));
    assert_non_null(wr_kernels_get(NULL, false, &err));
    assert_non_null(wr_kernels_get("auto", true, &err));
}

static void print_speed(const WrKernels *set, Bench *b, TestRandom *random)
{
    for (int f = 0; f < FAMILIES; f++)
        for (int member = 0;; member++) {
            double best = 1e9;
            bool any = true;
            for (int round = 0; round < 7 && any; round++) {
                fill_strip(random, &b->strip);
                double start = wr_clock_seconds();
                for (int i = 0; i < 200 && any; i++) any = families[f].run(set, b, member, WR_SPAN);
                best = fmin(best, wr_clock_seconds() - start);
            }
            if (!any) break;
            printf("%-4s %-5s %-10s %2d %8.2f ns\n", set->name, set->exact ? "exact" : "fast",
                   families[f].name, member, 1e9 * best / (200.0 * WR_SPAN));
        }
}

static int bench(void)
{
    const char *const names[] = { "ref", "v1", "v2", "v3", "v4" };
    TestRandom random = { seed };
    Bench *b = wr_alloc(1, sizeof *b);
    bench_init(b, &random);
    for (int i = 0; i < 5; i++)
        for (int fast = 0; fast < 2; fast++) {
            const WrKernels *set = wr_kernels_get(names[i], fast, NULL);
            if (set && set->exact == !fast) print_speed(set, b, &random);
        }
    bench_fini(b);
    wr_free(b);
    return 0;
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--bench") == 0) return bench();
        if (strcmp(argv[i], "--seed") == 0 && i + 1 < argc) seed = strtoull(argv[++i], NULL, 10);
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_kernels_give_the_bits_of_the_reference),
        cmocka_unit_test(fast_kernels_stay_within_their_bound),
        cmocka_unit_test(all_sets_make_the_same_codes),
        cmocka_unit_test(unknown_sets_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

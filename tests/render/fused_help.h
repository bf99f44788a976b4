/* fused_help.h - shared helpers of the tests of fused kernels: instruction sets, spheres seen from outside,
   comparison of two strips. */
#pragma once
#include "test.h"

#include "base/kernmath.h"
#include "base/memory.h"
#include "base/vec.h"
#include "render/kernels/kern.h"
#include "render/simd/simd_kernels.h"

#define FAST_BOUND 2e-4 /* scene/dials.h: absolute below 1, else relative */

typedef struct Sets {
    const WrKernels *ref;
    const WrWide *wide;
    const char *name;
} Sets;

/* Instruction set i that this processor supports; false: no more, or not this one (name NULL). */
static inline bool set_of(int i, Sets *sets)
{
    const char *const names[] = { "v3", "v4" };
    if (i >= 2) return false;
    const WrKernels *fast = wr_kernels_get(names[i], true, NULL);
    *sets = (Sets){ wr_kernels_get("ref", false, NULL), fast ? wr_wide_of(fast) : NULL, names[i] };
    return true;
}

static inline float between(TestRandom *random, double low, double high)
{
    return (float)(low + (high - low) * test_random(random));
}

static inline double off_by(double got, double want)
{
    return fabs(got - want) / fmax(fabs(want), 1);
}

typedef struct Scenery {
    WrRays rays;
    WrShapef shape;
    WrKernLight light;
    WrKernShine shine;
    WrKernMaterial material;
} Scenery;

static inline WrVec3 some_unit(TestRandom *random)
{
    const WrVec3 a = { between(random, -1, 1), between(random, -1, 1), between(random, -1, 1) };
    return v3_unit(a, (WrVec3){ 0, 0, 1 });
}

static inline void put3(float to[3], WrVec3 a)
{
    to[0] = (float)a.x, to[1] = (float)a.y, to[2] = (float)a.z;
}

/* A sphere from a random viewpoint outside, from some 100 samples to much wider. */
static inline Scenery some_scenery(TestRandom *random)
{
    Scenery s = { .shine = { between(random, 0.05, 1), between(random, 15, 300),
                             test_random(random) < 0.5 } };
    WrShape shape;
    if (test_random(random) < 0.5) s.shine.shininess = floorf(between(random, 1, 140));
    wr_shape_default(WR_SURFACE_sphere, &shape);
    shape.value[0] = between(random, 0.6, 1.7);
    wr_shape_scaled(&shape, 1, &s.shape);
    const double R = shape.value[0], away = R * (1.2 + 6 * test_random(random));
    const WrVec3 back = some_unit(random), eye = v3_scale(back, away);
    const WrVec3 right = v3_unit(v3_cross(some_unit(random), back), (WrVec3){ 1, 0, 0 });
    const WrVec3 up = v3_cross(back, right);
    const double half = 1.3 * R, step = 2 * half / (90 + 900 * test_random(random));
    const WrVec3 corner = v3_mad(v3_scale(right, -half), up, half);
    s.rays.perspective = test_random(random) < 0.7;
    put3(s.rays.eye, eye), put3(s.rays.toward, back);
    put3(s.rays.q0, corner);
    put3(s.rays.qx, v3_scale(right, step)), put3(s.rays.qy, v3_scale(up, -step));
    put3(s.rays.d0, v3_scale(back, -1));
    s.rays.s_min = (float)(-away + 0.01 * R);
    if (test_random(random) < 0.1) s.rays.s_min = (float)(-0.8 * R); /* the near plane cuts it */
    if (s.rays.perspective) { /* through the eye: q - eye = away d */
        put3(s.rays.d0, v3_scale(v3_sub(corner, eye), 1 / away));
        put3(s.rays.dx, v3_scale(right, step / away));
        put3(s.rays.dy, v3_scale(up, -step / away));
    }
    s.light.point = test_random(random) < 0.4;
    put3(s.light.where, v3_scale(some_unit(random), s.light.point ? R * 3 : 1));
    s.material = (WrKernMaterial){ between(random, 0, 0.3), between(random, 0, 1), { 1, 1, 1 } };
    const float strength = test_random(random) < 0.3 ? 40.0f : 1.0f;
    const bool grey = test_random(random) < 0.3;
    for (int c = 0; c < 3; c++) {
        s.light.rgb[c] = grey ? strength : strength * between(random, 0.1, 1);
        if (!grey) s.material.rgb[c] = between(random, 0, 1);
    }
    return s;
}

/* Separate stages: intersection and frame. */
static inline void met_by_stages(const Sets *sets, const Scenery *s, float gx, float gy, int count,
                                 WrStrip *strip)
{
    const WrRound *round = &sets->ref->round[WR_INVERT_SPHERE];
    round->hit(&s->rays, &s->shape, gx, gy, count, strip);
    round->params(&s->shape, strip);
    round->tangents(&s->shape, strip);
    round->normals(&s->shape, strip);
}

/* Distance of two periodic parameters. */
static inline double turns_off(double a, double b)
{
    const double d = fabs(a - b);
    return fmin(d, fabs(1 - d));
}

/* For grazing rays, rounding decides about the hit and its position. */
static inline bool is_grazing(const Scenery *s, const WrStrip *strip, int i)
{
    const WrVec3 p = { strip->px[i], strip->py[i], strip->pz[i] };
    const WrVec3 n = { strip->nx[i], strip->ny[i], strip->nz[i] };
    const WrVec3 eye = { s->rays.eye[0], s->rays.eye[1], s->rays.eye[2] };
    const WrVec3 toward = { s->rays.toward[0], s->rays.toward[1], s->rays.toward[2] };
    const WrVec3 v = s->rays.perspective ? v3_unit(v3_sub(eye, p), n) : toward;
    return v3_dot(n, v) < 0.03;
}

/* Compare samples that both have; samples of only one must be at the silhouette. Returns the number of
   comparisons. */
typedef void Compare(const WrStrip *got, int i, const WrStrip *want, int k, const char *set);

static inline int compare(const Scenery *s, const WrStrip *got, const WrStrip *want,
                          const char *set, Compare *each)
{
    int both = 0;
    for (int i = 0, k = 0; i < got->count || k < want->count;) {
        const int a = i < got->count ? got->index[i] : 1 << 20;
        const int b = k < want->count ? want->index[k] : 1 << 20;
        if (a == b && !is_grazing(s, want, k)) each(got, i, want, k, set), both++;
        if (b < a && !is_grazing(s, want, k)) fail_msg("%s: sample %d is not met", set, b);
        if (a < b && want->count > 0 && a > want->index[0] + 9 &&
            a < want->index[want->count - 1] - 9)
            fail_msg("%s: sample %d is met", set, a);
        i += a <= b, k += b <= a;
    }
    return both;
}

static inline void same_colour(const WrStrip *got, int i, const WrStrip *want, int k,
                               const char *set)
{
    const float *const a[] = { got->cr, got->cg, got->cb }, *const b[] = { want->cr, want->cg,
                                                                           want->cb };
    for (int c = 0; c < 3; c++)
        if (off_by(a[c][i], b[c][k]) > 3 * FAST_BOUND) /* point, normal and light: three stages */
            fail_msg("%s: channel %d is %.9g, not %.9g", set, c, (double)a[c][i], (double)b[c][k]);
}

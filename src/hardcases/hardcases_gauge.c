/* Functions shared by the measurements of the hard cases: comparisons, points, tables, fetches, pictures. */
#include "hardcases/hardcases_internal.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/memory.h"
#include "field/field.h"
#include "scene/scene.h"
#include "shade/bump.h"

#include <float.h>
#include <string.h>

/* ---- comparisons ---- */

static void note(WrHardGauge *gauge, WrHardPrecision precision, double deviation)
{
    gauge->checks[precision]++;
    if (isnan(deviation)) deviation = INFINITY;
    if (deviation > gauge->worst[precision]) gauge->worst[precision] = deviation;
}

void wr_hard_off(WrHardGauge *gauge, WrHardPrecision precision, double deviation)
{
    note(gauge, precision, fabs(deviation + gauge->nudge[precision]));
}

void wr_hard_near(WrHardGauge *gauge, WrHardPrecision precision, double got, double want)
{
    wr_hard_off(gauge, precision, got == want ? 0.0 : fabs(got - want));
}

void wr_hard_holds(WrHardGauge *gauge, WrHardPrecision precision, bool ok)
{
    gauge->checks[precision]++;
    if (ok != (gauge->nudge[precision] == 0.0)) gauge->worst[precision] += 1.0;
}

double wr_hard_random(WrHardGauge *gauge)
{
    uint64_t z = (gauge->random += 0x9e3779b97f4a7c15ULL);
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ z >> 27) * 0x94d049bb133111ebULL;
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

double wr_hard_between(WrHardGauge *gauge, double low, double high)
{
    return low + (high - low) * wr_hard_random(gauge);
}

float wr_hard_float(WrHardGauge *gauge)
{
    return (float)(floor(wr_hard_random(gauge) * 0x1p24) * 0x1p-24);
}

/* ---- points of surfaces ---- */

WrShape wr_hard_shape(WrSurfaceKind kind)
{
    WrShape shape;
    wr_shape_default(kind, &shape);
    return shape;
}

WrShape wr_hard_patch(WrVec3 (*point)(int i, int j))
{
    WrShape shape = wr_hard_shape(WR_SURFACE_bezier);
    for (int k = 0; k < 16; k++) {
        WrVec3 p = point(k % 4, k / 4);
        memcpy(shape.value + 3 * (size_t)k, &p, sizeof p);
    }
    return shape;
}

#define GET3(strip, name)                                                                          \
    ((WrVec3f){ (strip)->name##x[0], (strip)->name##y[0], (strip)->name##z[0] })
#define SET3(strip, name, a)                                                                       \
    ((strip)->name##x[0] = (a).x, (strip)->name##y[0] = (a).y, (strip)->name##z[0] = (a).z)

WrSurfacePointf wr_hard_point(WrHardGauge *gauge, int set, const WrShape *shape, double scale,
                              int face, float u, float v)
{
    WrShapef single;
    WrStrip *strip = gauge->strip;
    wr_shape_scaled(shape, scale, &single);
    strip->count = 1;
    strip->u[0] = u;
    strip->v[0] = v;
    gauge->kernels[set]->geometry[shape->kind](&single, face, strip);
    gauge->kernels[set]->curvature[shape->kind](&single, face, strip);
    WrSurfacePointf at = { .p = GET3(strip, p),
                           .pu = GET3(strip, pu),
                           .pv = GET3(strip, pv),
                           .n_unit = GET3(strip, n),
                           .n_u = GET3(strip, nu),
                           .n_v = GET3(strip, nv),
                           .n_len = strip->n_len[0] };
    at.n = v3f_scale(at.n_unit, at.n_len);
    return at;
}

WrVec3 wr_hard_perturbed(WrBumpMode mode, const WrSurfacePoint *at, WrHardSlope slope)
{
    return wr_bump_unit_normal(mode, at->n, at->n_unit, at->pu, at->pv, at->n_u, at->n_v, slope.f,
                               slope.fu, slope.fv);
}

WrVec3 wr_hard_perturbed_f(WrHardGauge *gauge, int set, WrBumpMode mode, const WrSurfacePointf *at,
                           WrHardSlope slope, bool behind)
{
    WrStrip *strip = gauge->strip;
    const float side = behind ? -1.0f : 1.0f;
    const WrRays rays = { .toward = { side * at->n_unit.x, side * at->n_unit.y,
                                      side * at->n_unit.z } };
    strip->count = 1;
    SET3(strip, p, at->p);
    SET3(strip, pu, at->pu);
    SET3(strip, pv, at->pv);
    SET3(strip, n, at->n_unit);
    SET3(strip, nu, at->n_u);
    SET3(strip, nv, at->n_v);
    strip->n_len[0] = at->n_len;
    strip->f[0] = (float)slope.f;
    strip->fu[0] = (float)slope.fu;
    strip->fv[0] = (float)slope.fv;
    gauge->kernels[set]->bump[mode](&rays, strip);
    return wr_hard_vec(GET3(strip, b));
}

WrVec3 wr_hard_perturbed_wide(WrHardGauge *gauge, int set, WrBumpMode mode,
                              const WrSurfacePoint *at, WrHardSlope slope)
{
    WrStripd *strip = gauge->wide_strip;
    const WrRaysd rays = { .toward = { at->n_unit.x, at->n_unit.y, at->n_unit.z } };
    strip->count = 1;
    SET3(strip, p, at->p);
    SET3(strip, pu, at->pu);
    SET3(strip, pv, at->pv);
    SET3(strip, n, at->n_unit);
    SET3(strip, nu, at->n_u);
    SET3(strip, nv, at->n_v);
    strip->n_len[0] = at->n_len;
    strip->f[0] = slope.f, strip->fu[0] = slope.fu, strip->fv[0] = slope.fv;
    gauge->wide[set]->bump[mode](&rays, strip);
    return (WrVec3){ strip->bx[0], strip->by[0], strip->bz[0] };
}

WrSurfacePoint wr_hard_widen(const WrSurfacePointf *at)
{
    return (WrSurfacePoint){ .p = wr_hard_vec(at->p),
                             .pu = wr_hard_vec(at->pu),
                             .pv = wr_hard_vec(at->pv),
                             .n = v3_cross(wr_hard_vec(at->pu), wr_hard_vec(at->pv)),
                             .n_unit = wr_hard_vec(at->n_unit),
                             .n_u = wr_hard_vec(at->n_u),
                             .n_v = wr_hard_vec(at->n_v),
                             .n_len = (double)at->n_len };
}

WrSurfacePointf wr_hard_narrow(const WrSurfacePoint *at)
{
    return (WrSurfacePointf){ .p = v3f_from(at->p),
                              .pu = v3f_from(at->pu),
                              .pv = v3f_from(at->pv),
                              .n = v3f_from(at->n),
                              .n_unit = v3f_from(at->n_unit),
                              .n_u = v3f_from(at->n_u),
                              .n_v = v3f_from(at->n_v),
                              .n_len = (float)at->n_len };
}

/* ---- tables ---- */

WrField *wr_hard_rough(WrHardGauge *gauge, int width, int height, WrWrap wrap)
{
    WrField *field = wr_field_new(width, height, wrap, wrap, 0.0f, NULL);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j, (float)(wr_hard_random(gauge) - 0.5));
    return field;
}

WrField *wr_hard_waves(int width, int height)
{
    WrField *field = wr_field_new(width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            double u = (i + 0.5) / width, v = 1.0 - (j + 0.5) / height, s[2], c[2];
            wr_sincos_turns(3.0 * u + 2.0 * v, &s[0], &c[0]);
            wr_sincos_turns(5.0 * v, &s[1], &c[1]);
            wr_field_set(field, i, j, (float)(0.5 * s[0] + 0.3 * c[1]));
        }
    return field;
}

bool wr_hard_equal(const WrField *a, const WrField *b)
{
    return wr_hash_equal(wr_field_hash(a), wr_field_hash(b));
}

WrField *wr_hard_rolled(const WrField *field, int di, int dj)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    WrField *out = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(out, i, j, wr_field_get(field, (i + di) % w, (j + dj) % h));
    return out;
}

WrHardSlope wr_hard_sample(const WrField *field, WrScheme scheme, double u, double v)
{
    WrHardSlope s;
    wr_field_sample(field, scheme, 1, &u, &v, &s.f, &s.fu, &s.fv);
    return s;
}

bool wr_hard_same_slope(WrHardSlope a, WrHardSlope b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* ---- pictures ---- */

bool wr_hard_shoot(WrHardGauge *gauge, const WrFrameRequest *request, WrHardShot *shot,
                   WrError *err)
{
    WrHardShot made = { .renderer = wr_renderer_new(gauge->pool, gauge->isa, err) };
    if (!made.renderer) return false;
    if (!wr_renderer_frame(made.renderer, request, &made.frame, err)) {
        wr_renderer_free(made.renderer);
        return false;
    }
    *shot = made;
    return true;
}

bool wr_hard_shoot_by(WrHardGauge *gauge, const WrFrameRequest *request, WrHardWay way,
                      WrHardShot *shot, WrError *err)
{
    WrScene *scene = wr_scene_clone(request->scene);
    WrFrameRequest changed = *request;
    changed.scene = scene;
    scene->dials.arithmetic = way == WR_HARD_FAST ? WR_ARITHMETIC_FAST : WR_ARITHMETIC_EXACT;
    scene->dials.shading = way == WR_HARD_WIDE ? WR_SHADING_DOUBLE : WR_SHADING_FLOAT;
    scene->dials.heights = way == WR_HARD_WIDE ? WR_HEIGHTS_DOUBLE : WR_HEIGHTS_FLOAT;
    const bool good = wr_hard_shoot(gauge, &changed, shot, err);
    wr_scene_free(scene);
    return good;
}

int64_t wr_hard_differ(const WrHardShot *a, const WrHardShot *b, double off)
{
    const int64_t count = (int64_t)a->frame.width * a->frame.height * 4;
    int64_t differ = 0;
    for (int64_t i = 0; i < count; i++)
        differ += !(fabs((double)a->frame.rgba[i] - (double)b->frame.rgba[i]) <= off);
    return differ;
}

void wr_hard_put_away(WrHardShot *shot)
{
    wr_renderer_free(shot->renderer);
    shot->renderer = NULL;
}

int64_t wr_hard_wild(const WrHardShot *shot)
{
    const int64_t count = (int64_t)shot->frame.width * shot->frame.height * 4;
    int64_t wild = 0;
    for (int64_t i = 0; i < count; i++) wild += !isfinite(shot->frame.rgba[i]);
    return wild;
}

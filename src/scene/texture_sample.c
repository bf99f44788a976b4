#include "scene/texture_sample.h"

#include "base/exactmath.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/normal_map.h"
#include "shade/bump.h"
#include "surface/surface.h"
#include "surface/triangles.h"

#include <math.h>

/* ---- look-ups ------------------------------------------------------------------------------------ */

/* As for heights: periodic axes are reduced, clamped ones end; in is false outside, where slopes are 0. */
static double place(double u, double replicate, bool periodic, bool *in)
{
    *in = true;
    if (periodic) return wr_field_reduce(u, replicate);
    const double x = replicate * u;
    *in = x >= 0 && x <= 1;
    return x > 0 ? x < 1 ? x : 1 : 0;
}

/* Index of texel i of n on a periodic or clamped axis. */
static size_t texel_at(int i, int n, bool periodic)
{
    if (periodic) return (size_t)((i % n + n) % n);
    return (size_t)(i < 0 ? 0 : i >= n ? n - 1 : i);
}

/* Taps i, i + 1 with x = W u - 1/2: texel centres are at half-integers and rows run down (DESIGN). */
WrTexels wr_texture_bilinear_taps(const WrScene *scene, const WrImage *image,
                                  const WrTextureSample *laid, bool periodic_u, bool periodic_v,
                                  double u, double v)
{
    const int w = image->width, h = image->height;
    double ru, rv;
    WrTexels out;
    wr_scene_repeat(scene, laid, &ru, &rv);
    const double x = w * place(u, ru, periodic_u, &out.in_u) - 0.5;
    const double y = h * (1 - place(v, rv, periodic_v, &out.in_v)) - 0.5;
    const int i = (int)floor(x), j = (int)floor(y);
    const double a = x - i, b = y - j;
    for (int k = 0; k < 4; k++) {
        const size_t column = texel_at(i + k % 2, w, periodic_u);
        const size_t row = texel_at(j + k / 2, h, periodic_v);
        out.texel[k] = image->data + (row * (size_t)w + column) * (size_t)image->channels;
        out.weight[k] = (k % 2 ? a : 1 - a) * (k / 2 ? b : 1 - b);
    }
    return out;
}

/* ---- normals ------------------------------------------------------------------------------------- */

WrNormalFrame wr_scene_frame(const WrScene *scene)
{
    const WrNormalFrame frame = scene->normals.frame;
    if (scene->normals.object) return WR_FRAME_OBJECT;
    if (scene->triangles && scene->triangles->patches) return WR_FRAME_GRADIENT; /* no corners */
    if (frame != WR_FRAME_AUTO) return frame;
    return wr_surfaces[scene->shape.kind]->held ? WR_FRAME_MIKK : WR_FRAME_GRADIENT;
}

/* gradient: unit tangents as they are; mikk: t made perpendicular to n and b = n x t, the frame for which the
   map was baked. */
bool wr_texture_sample_axes(WrNormalFrame frame, const WrSurfacePoint *at, WrMapAxes *axes)
{
    const WrVec3 n = at->n_unit, none = { 0, 0, 0 };
    const WrVec3 flat = v3_mad(at->pu, n, -v3_dot(at->pu, n));
    axes->n = n;
    axes->t = v3_unit(frame == WR_FRAME_MIKK ? flat : at->pu, none);
    axes->b = frame == WR_FRAME_MIKK ? v3_cross(n, axes->t) : v3_unit(at->pv, none);
    return v3_dot(axes->t, axes->t) > 0 && v3_dot(axes->b, axes->b) > 0;
}

/* The gradient whose normal is m, of any length. For vectors that face away from n its steepness is
 * limited as in reading.
 * g = -(m - n (n.m)) / (n.m): the normal n - g has the direction of m. */
static WrVec3 gradient_of(WrVec3 m, WrVec3 n)
{
    const double z = v3_dot(n, m), least = WR_NORMAL_MIN * v3_len(m);
    const WrVec3 none = { 0, 0, 0 };
    if (!(least > 0)) return none;
    return v3_scale(v3_mad(m, n, -z), -1 / (z > least ? z : least));
}

/* Fu and Fv of such a gradient; under `invariant` they alone determine the tilt, for any length of the
 * tangents.
 * Fu = g.Pu, Fv = g.Pv if N = Pu x Pv. On mirrored maps Pu x Pv is opposite to n while N is not, so k = |N| /
 * (n.(Pu x Pv)) restores the sign with which D = -|N| g. */
static void add_gradient(WrBumpMode mode, const WrSurfacePoint *at, WrVec3 g, double *fu,
                         double *fv)
{
    const double along = v3_dot(at->n_unit, v3_cross(at->pu, at->pv));
    const double length = v3_len(at->n);
    double k = fabs(along) > 1e-12 * v3_len(at->pu) * v3_len(at->pv) ? length / along : 0;
    const double gu = v3_dot(g, at->pu), gv = v3_dot(g, at->pv), size = wr_hypot(gu, gv);
    if (mode == WR_BUMP_INVARIANT) k = size > 0 ? copysign(v3_len(g) / size, k) : 0;
    *fu += k * gu;
    *fv += k * gv;
}

/* The gradient that these slopes turn the normal by: -D / |N|; under `invariant` of length hypot(Fu, Fv). */
static WrVec3 gradient_by(WrBumpMode mode, const WrSurfacePoint *at, double fu, double fv)
{
    const WrVec3 none = { 0, 0, 0 }, d = wr_bump_d(at->n_unit, at->pu, at->pv, fu, fv);
    const double length = v3_len(at->n);
    if (mode == WR_BUMP_INVARIANT) return v3_scale(v3_unit(d, none), -wr_hypot(fu, fv));
    return length > 0 ? v3_scale(d, -1 / length) : none;
}

/* The relief's slopes Fu and Fv become those of the relief over a map of this gradient. */
static void combine(const WrScene *scene, const WrSurfacePoint *at, WrVec3 g, double *fu,
                    double *fv)
{
    const WrVec3 b = gradient_by(scene->bump, at, *fu, *fv);
    const bool alone = scene->normals.combine == WR_COMBINE_SLOPES || v3_dot(b, b) == 0;
    if (!alone) {
        *fu = *fv = 0;
        g = gradient_of(wr_bump_combined(scene->normals.combine, at->n_unit, g, b), at->n_unit);
    }
    add_gradient(scene->bump, at, g, fu, fv);
}

/* Slopes are averaged, not vectors: heights add where slopes add, and the mean of unit vectors is too short on
   rough maps. */
static void mean_slopes(const WrTexels *at, double *p, double *q)
{
    *p = *q = 0;
    for (int k = 0; k < 4; k++) {
        double own_p, own_q;
        wr_normal_map_slopes(at->texel[k], &own_p, &own_q);
        *p += at->weight[k] * own_p, *q += at->weight[k] * own_q;
    }
    if (!at->in_u) *p = 0;
    if (!at->in_v) *q = 0;
}

/* Sign of a map's direction for this repetition: mirrored, or 0. */
static double sign_of(double repeat)
{
    return repeat > 0 ? 1 : repeat < 0 ? -1 : 0;
}

static WrVec3 mean_vector(const WrTexels *at)
{
    double m[3] = { 0 };
    for (int k = 0; k < 4; k++)
        for (int c = 0; c < 3; c++) m[c] += at->weight[k] * (double)at->texel[k][c];
    return (WrVec3){ m[0], m[1], m[2] };
}

void wr_scene_slopes(const WrScene *scene, const WrField *field, const WrSurfacePoint *at, double u,
                     double v, double *f, double *fu, double *fv)
{
    WrMapAxes axes;
    const bool found = wr_texture_sample_axes(wr_scene_frame(scene), at, &axes);
    const bool periodic_u = !field || wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
    const bool periodic_v = !field || wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    wr_scene_height(scene, field, u, v, f, fu, fv);
    wr_texture_sample_add_normals(scene, periodic_u, periodic_v, at, found ? &axes : NULL, u, v, fu,
                                  fv);
}

/* Order: decode, scale by strength, then the repetition's factor. In the gradient frame slopes are by the
   patch's parameters and get the factor ru, rv; in unit frames only the sign of a mirrored repetition matters. */
void wr_texture_sample_add_normals(const WrScene *scene, bool periodic_u, bool periodic_v,
                                   const WrSurfacePoint *at, const WrMapAxes *axes, double u,
                                   double v, double *fu, double *fv)
{
    const WrNormalMap *map = &scene->normals;
    if (!map->image || map->strength == 0) return;
    const WrTexels texels =
        wr_texture_bilinear_taps(scene, map->image, &map->laid, periodic_u, periodic_v, u, v);
    double ru, rv, p, q;
    wr_scene_repeat(scene, &map->laid, &ru, &rv);
    if (map->object) {
        const WrVec3 g = gradient_of(mean_vector(&texels), at->n_unit);
        combine(scene, at, v3_scale(g, map->strength), fu, fv);
        return;
    }
    mean_slopes(&texels, &p, &q);
    p *= map->strength, q *= map->strength;
    if (wr_scene_frame(scene) == WR_FRAME_GRADIENT) {
        if (map->combine == WR_COMBINE_SLOPES) *fu += p * ru, *fv += q * rv;
        else combine(scene, at, gradient_by(scene->bump, at, p * ru, q * rv), fu, fv);
    } else if (axes) {
        p *= sign_of(ru), q *= sign_of(rv);
        const WrVec3 m = v3_mad(v3_mad(axes->n, axes->t, -p), axes->b, -q);
        combine(scene, at, gradient_of(m, at->n_unit), fu, fv);
    }
}

#include "render/visibility/raster.h"

#include "base/vec.h"

#include <math.h>

/* ---- silhouette ---- */

static WrVec3 sum3(const double a[3], const double b[3], double x, const double c[3], double y)
{
    return (WrVec3){ a[0] + x * b[0] + y * c[0], a[1] + x * b[1] + y * c[1],
                     a[2] + x * b[2] + y * c[2] };
}

/* True if the ray's distance from the bounding sphere exceeds the distance of rays within the pixel. */
static bool misses_ball(const WrView *view, const WrRaysd *rays, double x, double y)
{
    const double R = view->shell_d.value[0];
    WrVec3 d = sum3(rays->d0, rays->dx, x, rays->dy, y),
           q = sum3(rays->q0, rays->qx, x, rays->qy, y);
    double dd = v3_dot(d, d), m = v3_dot(q, d) / dd, near = -m;
    WrVec3 foot = v3_mad(q, d, near);
    const double zero[3] = { 0 };
    WrVec3 across =
        v3_mad(sum3(rays->qx, zero, 0, zero, 0), sum3(rays->dx, zero, 0, zero, 0), near);
    WrVec3 down = v3_mad(sum3(rays->qy, zero, 0, zero, 0), sum3(rays->dy, zero, 0, zero, 0), near);
    double slack = 0.51 * (v3_len(across) + v3_len(down));
    return v3_len(foot) - slack > R * (1 + 1e-5);
}

/* True if all four corners of the pixel are outside the same edge of the quad, or none hits its plane in front. */
static bool misses_quad(const WrView *view, const WrRaysd *rays, const WrQuadd *quad, double x,
                        double y)
{
    int left = 0, right = 0, below = 0, above = 0, behind = 0;
    const double zero[3] = { 0 };
    WrVec3 o = sum3(quad->origin, zero, 0, zero, 0), n = sum3(quad->normal, zero, 0, zero, 0);
    double first = 0;
    (void)view;
    for (int k = 0; k < 4; k++) {
        double cx = x + (k & 1 ? 0.501 : -0.501), cy = y + (k & 2 ? 0.501 : -0.501);
        WrVec3 d = sum3(rays->d0, rays->dx, cx, rays->dy, cy);
        WrVec3 q = sum3(rays->q0, rays->qx, cx, rays->qy, cy);
        double dn = v3_dot(d, n);
        if (k == 0) first = dn;
        if (dn * first <= 0) return false; /* the horizon crosses the pixel */
        double s = v3_dot(v3_sub(o, q), n) / dn;
        WrVec3 p = v3_sub(v3_mad(q, d, s), o);
        double u = p.x * quad->eu[0] + p.y * quad->eu[1] + p.z * quad->eu[2];
        double v = p.x * quad->ev[0] + p.y * quad->ev[1] + p.z * quad->ev[2];
        left += u<quad->u0 - 1e-6, right += u> quad->u1 + 1e-6;
        below += v<quad->v0 - 1e-6, above += v> quad->v1 + 1e-6;
        behind += s <= rays->s_min;
    }
    if (behind > 0) return behind == 4;
    return left == 4 || right == 4 || below == 4 || above == 4;
}

bool wr_outline_misses(const WrTileJob *job, double x, double y)
{
    const WrView *view = job->view;
    const WrRaysd *rays = &wr_view_grid(view, 1)->rays_d;
    if (job->plan->inversion == WR_INVERT_SPHERE) return misses_ball(view, rays, x, y);
    for (int i = 0; i < view->quad_count; i++)
        if (!misses_quad(view, rays, &view->quads_d[i], x, y)) return false;
    return true;
}

/* Corner k of a planar face. */
static WrVec3 corner_of(const WrQuadd *quad, int k)
{
    const WrVec3 origin = { quad->origin[0], quad->origin[1], quad->origin[2] };
    const WrVec3 eu = { quad->eu[0], quad->eu[1], quad->eu[2] };
    const WrVec3 ev = { quad->ev[0], quad->ev[1], quad->ev[2] };
    const double u = k % 2 ? quad->u1 : quad->u0, v = k / 2 % 2 ? quad->v1 : quad->v0;
    return v3_mad(v3_mad(origin, eu, u / v3_dot(eu, eu)), ev, v / v3_dot(ev, ev));
}

/* True if the scene shows that face. Back faces are drawn if nothing is culled (E25), but are hidden. */
static bool shown(const WrTileJob *job, const WrQuadd *quad)
{
    const WrView *view = job->view;
    const WrVec3 n = { quad->normal[0], quad->normal[1], quad->normal[2] };
    const WrVec3 to =
        view->perspective ? v3_sub(view->eye, corner_of(quad, 0)) : v3_neg(view->ahead);
    return wr_plan_calls(job->plan, WR_EFFECT_BACK) || v3_dot(to, n) > 0;
}

int wr_outline_tips(const WrTileJob *job, WrRasterVertex tips[WR_OUTLINE_TIPS])
{
    const WrView *view = job->view;
    const WrViewMesh *mesh = job->mesh;
    int count = 0;
    for (int k = 0; k < 4 * view->quad_count; k++)
        count += shown(job, &view->quads_d[k / 4]) &&
                 wr_raster_project(view, corner_of(&view->quads_d[k / 4], k), 0, 0, &tips[count]);
    for (int k = 0; mesh && k < 4; k++) {
        const int at = k / 2 * mesh->mv * (mesh->mu + 1) + k % 2 * mesh->mu;
        tips[count] = (WrRasterVertex){ .x = mesh->sx[at], .y = mesh->sy[at] };
        count += !mesh->out[at];
    }
    return count;
}

WrClipVertex wr_raster_camera_vertex(const WrView *view, WrVec3 p, double u, double v)
{
    WrVec3 w = v3_sub(p, view->eye);
    return (WrClipVertex){ v3_dot(w, view->right), v3_dot(w, view->up), v3_dot(w, view->forward), u,
                           v };
}

/* Grid position of x and of y along the camera's axes, 1/256 samples; inv: 1 / depth, or 1. */
static inline double column_at(double x, double inv, double half_w, double grid_w)
{
    return (0.5 + 0.5 * x * inv / half_w) * grid_w * 256.0;
}

static inline double row_at(double y, double inv, double half_h, double grid_h)
{
    return (0.5 - 0.5 * y * inv / half_h) * grid_h * 256.0;
}

/* Camera axes -> grid samples, for a vertex known to be inside the near plane and the guard band. */
static WrRasterVertex project(const WrView *view, const WrClipVertex *c)
{
    double inv = view->perspective ? 1.0 / c->depth : 1.0;
    double x = column_at(c->x, inv, view->half_w, view->grid_w);
    double y = row_at(c->y, inv, view->half_h, view->grid_h);
    return (WrRasterVertex){ (int32_t)rint(x), (int32_t)rint(y),
                             (float)(view->perspective ? inv : -c->depth), (float)c->u,
                             (float)c->v };
}

bool wr_raster_project(const WrView *view, WrVec3 p, double u, double v, WrRasterVertex *out)
{
    WrClipVertex c = wr_raster_camera_vertex(view, p, u, v);
    double reach = WR_GUARD * (view->perspective ? c.depth : 1.0);
    *out = (WrRasterVertex){ 0 };
    if (!(c.depth >= view->near) || !(fabs(c.x) <= reach * view->half_w) ||
        !(fabs(c.y) <= reach * view->half_h))
        return false;
    *out = project(view, &c);
    return true;
}

static int32_t within_int(double x)
{
    return (int32_t)fmin(fmax(x, -0x1p30), 0x1p30);
}

bool wr_raster_bound(const WrView *view, WrVec3 p, int32_t *x, int32_t *y)
{
    const WrClipVertex c = wr_raster_camera_vertex(view, p, 0, 0);
    *x = *y = 0;
    if (!(c.depth >= view->near)) return false;
    const double inv = view->perspective ? 1.0 / c.depth : 1.0;
    *x = within_int(column_at(c.x, inv, view->half_w, view->grid_w));
    *y = within_int(row_at(c.y, inv, view->half_h, view->grid_h));
    return true;
}

/* From here on doubles are whole numbers; below 2^51, adding and subtracting it rounds to the nearest whole
   number, ties to even, like rint. */
#define WHOLE_FROM 0x1.8p52

/* Vertices during projection. */
#define PROJECTED 128
typedef struct Projected {
    double x[PROJECTED], y[PROJECTED]; /* 1/256 samples, whole */
    double close[PROJECTED];           /* as in WrRasterVertex */
    int in[PROJECTED];                 /* inside the near plane and the guard band */
} Projected;

/* Projects `count` points as wr_raster_project does. */
static void project_many(const WrView *view, int count, const float *restrict px,
                         const float *restrict py, const float *restrict pz,
                         Projected *restrict out)
{
    const WrVec3 eye = view->eye, right = view->right, up = view->up, ahead = view->forward;
    const bool perspective = view->perspective;
    const double half_w = view->half_w, half_h = view->half_h, near = view->near;
    const double grid_w = view->grid_w, grid_h = view->grid_h;
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const double wx = (double)px[i] - eye.x, wy = (double)py[i] - eye.y;
        const double wz = (double)pz[i] - eye.z;
        const double x = wx * right.x + wy * right.y + wz * right.z;
        const double y = wx * up.x + wy * up.y + wz * up.z;
        const double depth = wx * ahead.x + wy * ahead.y + wz * ahead.z;
        const double inv = perspective ? 1.0 / depth : 1.0;
        const double reach = WR_GUARD * (perspective ? depth : 1.0);
        out->x[i] = column_at(x, inv, half_w, grid_w) + WHOLE_FROM - WHOLE_FROM;
        out->y[i] = row_at(y, inv, half_h, grid_h) + WHOLE_FROM - WHOLE_FROM;
        out->close[i] = perspective ? inv : -depth;
        out->in[i] = (depth >= near) & (fabs(x) <= reach * half_w) & (fabs(y) <= reach * half_h);
    }
}

/* Projects a vertex that is not inside. */
static WrVertexPlace bound_of(const WrView *view, WrVec3 p, int32_t *x, int32_t *y)
{
    return wr_raster_bound(view, p, x, y) ? WR_VERTEX_OUT : WR_VERTEX_BEHIND;
}

void wr_raster_project_row(const WrView *view, int count, const float *x, const float *y,
                           const float *z, const WrRasterRow *row)
{
    Projected at;
    for (int from = 0; from < count; from += PROJECTED) {
        const int left = count - from, n = left < PROJECTED ? left : PROJECTED;
        project_many(view, n, x + from, y + from, z + from, &at);
        for (int k = 0; k < n; k++) {
            const int i = from + k;
            row->out[i] = WR_VERTEX_IN;
            row->close[i] = at.in[k] ? (float)at.close[k] : 0;
            if (at.in[k]) row->x[i] = (int32_t)at.x[k], row->y[i] = (int32_t)at.y[k];
            else
                row->out[i] = (unsigned char)bound_of(view, (WrVec3){ x[i], y[i], z[i] },
                                                      &row->x[i], &row->y[i]);
        }
    }
}

/* Edge from (ax, ay) to (bx, by): e(x, y) > 0 on its left; whole numbers, 1/256 sample squared. Samples on the
   edge belong to it only if it is a top or left one. */
typedef struct Edge {
    int64_t at, step_x, step_y;
} Edge;

static Edge edge_of(int64_t ax, int64_t ay, int64_t bx, int64_t by, int64_t px, int64_t py)
{
    int64_t dx = bx - ax, dy = by - ay;
    bool owns = dy < 0 || (dy == 0 && dx < 0);
    Edge e = { dx * (py - ay) - dy * (px - ax) - (owns ? 0 : 1), -dy * 256, dx * 256 };
    return e;
}

static int32_t floor_sample(int64_t x)
{
    return (int32_t)(x >= 0 ? x / 256 : -((-x + 255) / 256));
}

static int64_t min3(int64_t a, int64_t b, int64_t c)
{
    a = a < b ? a : b;
    return a < c ? a : c;
}

static int64_t max3(int64_t a, int64_t b, int64_t c)
{
    a = a > b ? a : b;
    return a > c ? a : c;
}

/* Plane of an interpolated value: q = value / depth is affine on the screen, and so is closeness. */
static WrPlane plane_of(float a, float b, float c)
{
    return (WrPlane){ a, b - a, c - a };
}

/* Setup of a triangle: steps of its edges from sample to sample, and the interpolated planes. */
typedef struct Walk {
    Edge a, b, c;
    WrPlane close, u, v;
    float inv;
    bool perspective;
    int32_t x0, y0, x1, y1; /* samples of the tile */
} Walk;

/* Writes sample `cell`, whose edge values are fa, fb, fc; false if it is outside. */
static inline bool take(const Walk *walk, int64_t fa, int64_t fb, int64_t fc, size_t cell,
                        WrDepthTile *tile)
{
    if ((fa | fb | fc) < 0) return false;
    float l1 = (float)fb * walk->inv, l2 = (float)fc * walk->inv;
    float near = walk->close.base + l1 * walk->close.d1 + l2 * walk->close.d2;
    if (!(near > tile->close[cell])) return true;
    float w = walk->perspective ? 1.0f / near : 1.0f;
    tile->close[cell] = near;
    tile->u[cell] = (walk->u.base + l1 * walk->u.d1 + l2 * walk->u.d2) * w;
    tile->v[cell] = (walk->v.base + l1 * walk->v.d1 + l2 * walk->v.d2) * w;
    return true;
}

/* Covers row by row; a row ends at the triangle's far side. */
static void cover(Walk *walk, WrDepthTile *tile)
{
    for (int32_t y = walk->y0; y < walk->y1; y++) {
        int64_t fa = walk->a.at, fb = walk->b.at, fc = walk->c.at;
        size_t row = (size_t)y * (size_t)tile->w;
        bool within = false;
        for (int32_t x = walk->x0; x < walk->x1; x++) {
            const bool in = take(walk, fa, fb, fc, row + (size_t)x, tile);
            if (within && !in) break;
            within = in;
            fa += walk->a.step_x, fb += walk->b.step_x, fc += walk->c.step_x;
        }
        walk->a.at += walk->a.step_y, walk->b.at += walk->b.step_y, walk->c.at += walk->c.step_y;
    }
}

/* Largest side L of a triangle, 1/256 samples, whose edge values fit in 32 bits over its box, with one vector to
   its right and one row below: 2 L (L + 18 * 256) < 2^31. */
#define SMALL_SIDE 30000

static void cover_small(const Walk *walk, WrDepthTile *tile)
{
    const Edge *edges[3] = { &walk->a, &walk->b, &walk->c };
    WrWalk small = { .inv = walk->inv,
                     .perspective = walk->perspective,
                     .close = walk->close,
                     .u = walk->u,
                     .v = walk->v,
                     .x0 = walk->x0,
                     .y0 = walk->y0,
                     .x1 = walk->x1,
                     .y1 = walk->y1,
                     .pitch = tile->w };
    for (int k = 0; k < 3; k++) {
        small.at[k] = (int32_t)edges[k]->at;
        small.step_x[k] = (int32_t)edges[k]->step_x;
        small.step_y[k] = (int32_t)edges[k]->step_y;
    }
    tile->kernels->cover(&small, tile->close, tile->u, tile->v);
}

static int64_t shifted(const Edge *edge, int64_t at, const signed char *shift)
{
    return at + edge->step_x / 256 * shift[0] + edge->step_y / 256 * shift[1];
}

/* Covers a tile whose samples are offset from the grid. */
static void cover_shifted(Walk *walk, WrDepthTile *tile)
{
    for (int32_t y = walk->y0; y < walk->y1; y++) {
        int64_t fa = walk->a.at, fb = walk->b.at, fc = walk->c.at;
        size_t row = (size_t)y * (size_t)tile->w;
        for (int32_t x = walk->x0; x < walk->x1; x++) {
            const signed char *shift = tile->shift + 2 * (row + (size_t)x);
            (void)take(walk, shifted(&walk->a, fa, shift), shifted(&walk->b, fb, shift),
                       shifted(&walk->c, fc, shift), row + (size_t)x, tile);
            fa += walk->a.step_x, fb += walk->b.step_x, fc += walk->c.step_x;
        }
        walk->a.at += walk->a.step_y, walk->b.at += walk->b.step_y, walk->c.at += walk->c.step_y;
    }
}

/* Converts from the grid of `of` samples a pixel to that of k. Each vertex is rounded independently, so that
   triangles that share it still do. */
static int32_t to_grid(int32_t x, int k, int of)
{
    int64_t twice = 2 * (int64_t)x * k + of;
    int64_t down = twice / (2 * of);
    return (int32_t)(down - (twice % (2 * of) < 0));
}

static void bring_to_grid(const WrView *view, const WrDepthTile *tile, WrRasterVertex *vertex)
{
    if (tile->k <= 0 || tile->k == view->samples) return;
    vertex->x = to_grid(vertex->x, tile->k, view->samples);
    vertex->y = to_grid(vertex->y, tile->k, view->samples);
}

/* Puts the farthest vertex first, if one is far closer than another. Interpolated values then start at their
   minimum and only grow, so that nothing cancels however deep the triangle is. */
static void farthest_first(WrRasterVertex *a, WrRasterVertex *b, WrRasterVertex *c)
{
    const float deep = 64.0f, ab = a->close < b->close ? a->close : b->close;
    const float least = ab < c->close ? ab : c->close, limit = deep * least;
    if (a->close <= limit && b->close <= limit && c->close <= limit) return;
    for (int k = 0; k < 2 && a->close > least; k++) {
        const WrRasterVertex first = *a;
        *a = *b, *b = *c, *c = first;
    }
}

/* mark: value of u over the whole triangle; NULL: u and v are interpolated. */
static void raster(const WrView *view, WrRasterVertex a, WrRasterVertex b, WrRasterVertex c,
                   const float *mark, WrDepthTile *tile)
{
    bring_to_grid(view, tile, &a);
    bring_to_grid(view, tile, &b);
    bring_to_grid(view, tile, &c);
    const bool mirrored = view->stretch[0] * view->stretch[1] * view->stretch[2] < 0;
    int64_t area =
        ((int64_t)b.x - a.x) * ((int64_t)c.y - a.y) - ((int64_t)b.y - a.y) * ((int64_t)c.x - a.x);
    if (area == 0 || ((area > 0) != mirrored && view->cull))
        return; /* rows run down: front faces have area < 0 */
    if (area < 0) {
        WrRasterVertex t = b;
        b = c, c = t, area = -area;
    }
    if (view->perspective) farthest_first(&a, &b, &c);
    const int more = tile->shift ? 128 : 0;
    Walk walk = { .perspective = view->perspective && !mark, .inv = 1.0f / (float)area };
    const int64_t left = min3(a.x, b.x, c.x), right = max3(a.x, b.x, c.x);
    const int64_t top = min3(a.y, b.y, c.y), low = max3(a.y, b.y, c.y);
    int32_t x0 = floor_sample(left - 128 - more) - tile->x;
    int32_t x1 = floor_sample(right - 128 + more) + 1 - tile->x;
    int32_t y0 = floor_sample(top - 128 - more) - tile->y;
    int32_t y1 = floor_sample(low - 128 + more) + 1 - tile->y;
    walk.x0 = x0 < 0 ? 0 : x0, walk.y0 = y0 < 0 ? 0 : y0;
    walk.x1 = x1 > tile->w ? tile->w : x1, walk.y1 = y1 > tile->h ? tile->h : y1;
    if (walk.x0 >= walk.x1 || walk.y0 >= walk.y1) return;

    int64_t px = ((int64_t)tile->x + walk.x0) * 256 + 128;
    int64_t py = ((int64_t)tile->y + walk.y0) * 256 + 128;
    walk.a = edge_of(b.x, b.y, c.x, c.y, px, py);
    walk.b = edge_of(c.x, c.y, a.x, a.y, px, py);
    walk.c = edge_of(a.x, a.y, b.x, b.y, px, py);
    float wa = view->perspective ? a.close : 1, wb = view->perspective ? b.close : 1,
          wc = view->perspective ? c.close : 1;
    walk.close = plane_of(a.close, b.close, c.close);
    walk.u = plane_of(a.u * wa, b.u * wb, c.u * wc);
    walk.v = plane_of(a.v * wa, b.v * wb, c.v * wc);
    if (mark) walk.u = (WrPlane){ *mark, 0, 0 }, walk.v = (WrPlane){ 0, 0, 0 };
    if (tile->shift) cover_shifted(&walk, tile);
    else if (right - left <= SMALL_SIDE && low - top <= SMALL_SIDE) cover_small(&walk, tile);
    else cover(&walk, tile);
}

void wr_raster_triangle(const WrView *view, WrRasterVertex a, WrRasterVertex b, WrRasterVertex c,
                        WrDepthTile *tile)
{
    raster(view, a, b, c, NULL, tile);
}

void wr_raster_marked(const WrView *view, const WrRasterVertex corner[3], float mark,
                      WrDepthTile *tile)
{
    raster(view, corner[0], corner[1], corner[2], &mark, tile);
}

/* Signed distance of a vertex from clip plane k: near, left, right, bottom, top. */
static double inside(const WrView *view, int k, const WrClipVertex *c)
{
    double reach = 0.99 * WR_GUARD * (view->perspective ? c->depth : 1.0);
    switch (k) {
    case 0: return c->depth - view->near * 1.001;
    case 1: return reach * view->half_w + c->x;
    case 2: return reach * view->half_w - c->x;
    case 3: return reach * view->half_h + c->y;
    default: return reach * view->half_h - c->y;
    }
}

static WrClipVertex between(const WrClipVertex *a, const WrClipVertex *b, double t)
{
    return (WrClipVertex){ a->x + t * (b->x - a->x), a->y + t * (b->y - a->y),
                           a->depth + t * (b->depth - a->depth), a->u + t * (b->u - a->u),
                           a->v + t * (b->v - a->v) };
}

static void clipped(const WrView *view, const WrClipVertex corner[3], const float *mark,
                    WrDepthTile *tile)
{
    WrClipVertex poly[16], next[16];
    int count = 3;
    for (int i = 0; i < 3; i++) poly[i] = corner[i];
    /* Sutherland and Hodgman clipping, one plane at a time */
    for (int k = 0; k < 5 && count > 0; k++) {
        int kept = 0;
        for (int i = 0; i < count; i++) {
            const WrClipVertex *p = &poly[i], *q = &poly[(i + 1) % count];
            double dp = inside(view, k, p), dq = inside(view, k, q);
            if (dp >= 0) next[kept++] = *p;
            if ((dp >= 0) != (dq >= 0)) next[kept++] = between(p, q, dp / (dp - dq));
        }
        for (int i = 0; i < kept; i++) poly[i] = next[i];
        count = kept;
    }
    if (count < 3) return;
    WrRasterVertex first = project(view, &poly[0]);
    for (int i = 1; i + 1 < count; i++)
        raster(view, first, project(view, &poly[i]), project(view, &poly[i + 1]), mark, tile);
}

void wr_raster_clipped(const WrView *view, const WrClipVertex corner[3], WrDepthTile *tile)
{
    clipped(view, corner, NULL, tile);
}

void wr_raster_clipped_marked(const WrView *view, const WrClipVertex corner[3], float mark,
                              WrDepthTile *tile)
{
    clipped(view, corner, &mark, tile);
}

WrRasterBounds wr_raster_bounds(const WrDepthTile *tile, int samples)
{
    const int k = tile->k > 0 ? tile->k : samples;
    const int more = tile->shift || k != samples ? 1 : 0; /* samples */
    return (WrRasterBounds){ (int64_t)(tile->x - more) * 256 * samples / k,
                             (int64_t)(tile->y - more) * 256 * samples / k,
                             (int64_t)(tile->x + tile->w + more) * 256 * samples / k,
                             (int64_t)(tile->y + tile->h + more) * 256 * samples / k };
}

bool wr_raster_meets(const WrViewMeshBlock *b, const WrRasterBounds *tile)
{
    return b->clipped ||
           (b->x1 >= tile->x0 && b->x0 <= tile->x1 && b->y1 >= tile->y0 && b->y0 <= tile->y1);
}

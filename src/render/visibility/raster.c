#include "render/visibility/raster.h"
#include "render/frame/tile.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/vec.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- triangles into a tile ---- */

/* Coordinates are whole numbers of 1/256 sample, x to the right, rows down; sample (i, j) has its centre at
   256 i + 128. Vertices are rounded once, before any triangle uses them, and all edge functions are exact
   integers from then on. So a shared edge is the same number with opposite sign in its two triangles, and a
   fill rule assigns each sample on it to exactly one of them (HC85, HC135): no gap and no sample drawn twice,
   for any order of triangles and threads.
   `close` is 1 / depth in perspective and -depth otherwise: larger is nearer, and it is affine on the screen. */

/* ---- silhouette ---- */

static WrVec3 sum3(const double a[3], const double b[3], double x, const double c[3], double y)
{
    return (WrVec3){ a[0] + x * b[0] + y * c[0], a[1] + x * b[1] + y * c[1],
                     a[2] + x * b[2] + y * c[2] };
}

/* True if the ray's distance from the bounding sphere exceeds the distance of rays within the pixel.
   The ray's distance from the centre is |foot|; within the pixel the foot moves by at most half the
   derivatives of the ray by x and y at that parameter. The factor 0.51 instead of 0.5 and the 1e-5 are margins
   for rounding: a pixel may be kept for nothing, but never lost. */
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

/* True if all four corners of the pixel are outside the same edge of the quad, or none hits its plane in front.
   The pixel's image on the plane is a quadrilateral if all four rays hit the plane from the same side; then it
   misses the face if one edge of the face separates them. A pixel that contains the horizon has an unbounded
   image: kept. */
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

static bool raster_project(const WrView *view, WrVec3 p, double u, double v, WrRasterVertex *out);

int wr_outline_tips(const WrTileJob *job, WrRasterVertex tips[WR_OUTLINE_TIPS])
{
    const WrView *view = job->view;
    const WrViewMesh *mesh = job->mesh;
    int count = 0;
    for (int k = 0; k < 4 * view->quad_count; k++)
        count += shown(job, &view->quads_d[k / 4]) &&
                 raster_project(view, corner_of(&view->quads_d[k / 4], k), 0, 0, &tips[count]);
    for (int k = 0; mesh && k < 4; k++) {
        const int at = k / 2 * mesh->mv * (mesh->mu + 1) + k % 2 * mesh->mu;
        tips[count] = (WrRasterVertex){ .x = mesh->sx[at], .y = mesh->sy[at] };
        count += !mesh->out[at];
    }
    return count;
}

static WrClipVertex raster_camera_vertex(const WrView *view, WrVec3 p, double u, double v)
{
    WrVec3 w = v3_sub(p, view->eye);
    return (WrClipVertex){ v3_dot(w, view->right), v3_dot(w, view->up), v3_dot(w, view->forward), u,
                           v };
}

/* Grid position of x and of y along the camera's axes, 1/256 samples; inv: 1 / depth, or 1.
   Both functions are shared by the scalar and the vector path, with the same order of operations, so that both
   round a vertex to the same place. */
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

static bool raster_project(const WrView *view, WrVec3 p, double u, double v, WrRasterVertex *out)
{
    WrClipVertex c = raster_camera_vertex(view, p, u, v);
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

/* Position of a vertex outside the guard band, 1/256 samples, clamped to 2^30; false if it is not beyond the
   near plane. */
static bool raster_bound(const WrView *view, WrVec3 p, int32_t *x, int32_t *y)
{
    const WrClipVertex c = raster_camera_vertex(view, p, 0, 0);
    *x = *y = 0;
    if (!(c.depth >= view->near)) return false;
    const double inv = view->perspective ? 1.0 / c.depth : 1.0;
    *x = within_int(column_at(c.x, inv, view->half_w, view->grid_w));
    *y = within_int(row_at(c.y, inv, view->half_h, view->grid_h));
    return true;
}

/* From here on doubles are whole numbers; below 2^51, adding and subtracting it rounds to the nearest whole
   number, ties to even, like rint.
   Adding 1.5 * 2^52 moves the units' digit to the last bit of the mantissa. Unlike rint it vectorises without
   SSE4.1; the guard band keeps |x| far below 2^51. */
#define WHOLE_FROM 0x1.8p52

/* Vertices during projection. */
#define PROJECTED 128
typedef struct Projected {
    double x[PROJECTED], y[PROJECTED]; /* 1/256 samples, whole */
    double close[PROJECTED];           /* as in WrRasterVertex */
    int in[PROJECTED];                 /* inside the near plane and the guard band */
} Projected;

/* Projects `count` points as raster_project does. */
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
    return raster_bound(view, p, x, y) ? WR_VERTEX_OUT : WR_VERTEX_BEHIND;
}

/* Vertices outside the guard band have no exact position; they only get a bound for block boxes, and their
   triangles go through clipping. */
static void raster_project_row(const WrView *view, int count, const float *x, const float *y,
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

/* Edge from (ax, ay) to (bx, by): e(x, y) > 0 on the inner side; whole numbers, 1/256 sample squared. Samples on the
   edge belong to it only if it is a left one, or a horizontal one at the bottom (rows run down).
       e(x, y) = (bx - ax) (y - ay) - (by - ay) (x - ax)
   is twice the signed area of (a, b, sample). Moving by one sample adds -256 dy or 256 dx. For edges that do
   not own their samples 1 is subtracted once at the start, so that the inner loop tests e >= 0 for all three:
   one sign bit of their OR. Coordinates stay below 2^31, products below 2^63. */
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

/* Writes sample `cell`, whose edge values are fa, fb, fc; false if it is outside.
   l1 and l2 are the barycentric weights of the second and third vertex; the error of each is 2^-24 relative,
   from the conversion of the exact integer. u and v are interpolated as u / depth and multiplied by the depth
   at the sample. A tie in depth keeps the earlier triangle (HC85), hence the strict comparison. */
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

/* Covers row by row; a row ends at the triangle's far side.
   A triangle is convex: samples of a row inside it are contiguous, so the first one outside after them ends
   the row. */
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
   its right and one row below: 2 L (L + 18 * 256) < 2^31.
   |e| <= 2 L (distance from the box's corner) with both factors at most L plus the overhang: 16 samples of a
   vector and 2 more for rounding to samples. */
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

/* Covers a tile whose samples are offset from the grid.
   A shift moves a sample by up to half a sample; step / 256 is the edge function's change for 1/256 sample,
   exact because the steps are multiples of 256. Shifted samples of a row need not be contiguous, so no row
   ends early. */
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
   triangles that share it still do.
   floor((2 x k + of) / (2 of)) is x k / of rounded to nearest. C divides towards zero, hence the correction
   for negative x. */
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

/* mark: value of u over the whole triangle; NULL: u and v are interpolated.
   Order of the vertices: first to the tile's grid, then the area's sign by the rounded places (else a sliver
   could have a sign here and another area below), then so that the area is positive, then the farthest first.
   The box is widened by half a sample for shifted samples. Outside the tile nothing is set up, so `at` starts
   from the tile's first sample. */
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

/* Rasterise triangles whose samples get u = `mark` and v = 0; the second one clips first. */
static void raster_marked(const WrView *view, const WrRasterVertex corner[3], float mark,
                          WrDepthTile *tile)
{
    raster(view, corner[0], corner[1], corner[2], &mark, tile);
}

/* Signed distance of a vertex from clip plane k: near, left, right, bottom, top.
   Planes of the view pyramid, slightly inside of those raster_project tests against: a vertex that clipping
   makes then passes project() in spite of rounding, and 1 / depth stays finite (HC82, HC83). */
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

/* Each plane adds at most one vertex to a convex polygon: 3 + 5 = 8 of 16. Interpolation is linear before the
   division by depth, so u and v stay right in perspective. The result is drawn as a fan. */
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

/* Clips against the near plane and the guard band, before any division (HC82, HC83), and rasterises. */
static void raster_clipping(const WrView *view, const WrClipVertex corner[3], WrDepthTile *tile)
{
    clipped(view, corner, NULL, tile);
}

/* Rasterise triangles whose samples get u = `mark` and v = 0; the second one clips first. */
static void raster_clipped_marked(const WrView *view, const WrClipVertex corner[3], float mark,
                                  WrDepthTile *tile)
{
    clipped(view, corner, &mark, tile);
}

/* The tile in units of the frame's grid. One sample more where vertices are rounded to another grid, or
   samples are shifted: a triangle outside could otherwise be discarded although its rounded version reaches
   in. */
static WrRasterBounds raster_bounds(const WrDepthTile *tile, int samples)
{
    const int k = tile->k > 0 ? tile->k : samples;
    const int more = tile->shift || k != samples ? 1 : 0; /* samples */
    return (WrRasterBounds){ (int64_t)(tile->x - more) * 256 * samples / k,
                             (int64_t)(tile->y - more) * 256 * samples / k,
                             (int64_t)(tile->x + tile->w + more) * 256 * samples / k,
                             (int64_t)(tile->y + tile->h + more) * 256 * samples / k };
}

static bool raster_meets(const WrViewMeshBlock *b, const WrRasterBounds *tile)
{
    return b->clipped ||
           (b->x1 >= tile->x0 && b->x0 <= tile->x1 && b->y1 >= tile->y0 && b->y0 <= tile->y1);
}

/* ---- curved surfaces ---- */

/* Vertex (i, j) of the mesh is at index j * (mu + 1) + i in all arrays; u runs along a row. x, y, z are object
   space in kernel units and depend on the shape alone; sx, sy, close, out depend on the view too and are
   projected again when it changes. blocks [blocks_v][blocks_u] bound WR_MESH_BLOCK^2 cells each. */
static void free_points(WrViewMesh *mesh)
{
    wr_free(mesh->v);
    wr_free(mesh->x);
    wr_free(mesh->y);
    wr_free(mesh->z);
    wr_free(mesh->sx);
    wr_free(mesh->sy);
    wr_free(mesh->close);
    wr_free(mesh->out);
    wr_free(mesh->blocks);
}

void wr_view_mesh_fini(WrViewMesh *mesh)
{
    free_points(mesh);
    *mesh = (WrViewMesh){ 0 };
}

/* Samples per kernel unit of length at the nearest point of the object. */
static double samples_per_unit(const WrView *view, const WrShape *shape)
{
    double per = view->grid_h / (2.0 * view->half_h);
    if (!view->perspective) return per;
    WrVec3 centre = v3_scale(wr_shape_centre(shape), view->scale);
    const WrVec3 s = { view->stretch[0], view->stretch[1], view->stretch[2] };
    double depth = v3_len(v3_times(v3_sub(centre, view->eye), s)) - view->radius;
    double least = 0.05 * view->radius;
    return per / (depth > least ? depth : least);
}

/* The smallest sufficient of a few fixed sizes, so that a moving view seldom changes them. At least 16, for
   which a round outline keeps 0.97 of its area however small it is (HC86). */
static int round_cells(double want, int most)
{
    static const int sizes[] = { 16,  24,  32,  48,  64,   96,   128, 192,
                                 256, 384, 512, 768, 1024, 1536, 2048 };
    const int count = (int)(sizeof sizes / sizeof *sizes);
    for (int i = 0; i < count; i++)
        if (want <= sizes[i] || sizes[i] == most) return sizes[i];
    return sizes[count - 1];
}

#define WR_MESH_CORNERS 64

/* Largest |Puu|, |Puv|, |Pvv| over the surface (sampled), in object units; cached while the shape is unchanged. */
static void measure_bend(WrViewMesh *mesh, const WrShape *shape)
{
    if (mesh->measured && memcmp(&mesh->source, shape, sizeof *shape) == 0) return;
    mesh->uu = mesh->uv = mesh->vv = 0;
    /* a user-defined curve may bend within short pieces */
    const int across = 16, up = shape->data ? 128 : 16;
    for (int j = 0; j <= up; j++)
        for (int i = 0; i <= across; i++) {
            WrSurfacePoint at;
            wr_surface_at(shape, 0, (double)i / across, (double)j / up, &at);
            mesh->uu = fmax(mesh->uu, v3_len(at.puu));
            mesh->uv = fmax(mesh->uv, v3_len(at.puv));
            mesh->vv = fmax(mesh->vv, v3_len(at.pvv));
        }
    mesh->source = *shape;
    mesh->measured = true;
}

/* The error of a cell's chord is at most (|Puu| du^2 + 2 |Puv| du dv + |Pvv| dv^2) / 8 (Taylor).
   With 2 du dv <= du^2 + dv^2 the bound separates into (|Puu| + |Puv|) du^2 / 8 and (|Pvv| + |Puv|) dv^2 / 8;
   each may be half the tolerance. Hence cells = sqrt(2 k bend), k = samples per unit / (8 tolerance). */
static void choose_cells(const WrViewMesh *mesh, const WrShape *shape, const WrView *view,
                         int finer, int *mu, int *mv)
{
    const double tolerance = 0.25 * view->samples; /* a quarter of a pixel, in samples */
    double k = view->scale * samples_per_unit(view, shape) / (8.0 * tolerance);
    const int most = WR_MESH_MAX; /* a ribbon of sixty turns needs 1500 along it (HC164) ... */
    double u = fmin(sqrt(2.0 * k * (mesh->uu + mesh->uv)), most);
    double v = fmin(sqrt(2.0 * k * (mesh->vv + mesh->uv)), most);
    /* ... but not in both directions */
    const double over = fmax(1.0, sqrt(u * v / (512.0 * 512.0)));
    *mu = round_cells(u / over, most);
    *mv = round_cells(v / over, most);
    *mu = round_cells(scalbn(*mu, finer), most);
    *mv = round_cells(scalbn(*mv, finer), most);
}

typedef struct MeshJob {
    WrViewMesh *mesh;
    const WrView *view;
    const WrKernels *kernels;
} MeshJob;

static void make_row(int j, int worker, void *ctx)
{
    (void)worker;
    MeshJob *job = ctx;
    WrViewMesh *mesh = job->mesh;
    float u[WR_SPAN], v[WR_SPAN];
    for (int from = 0; from <= mesh->mu; from += WR_SPAN) {
        int n = mesh->mu + 1 - from < WR_SPAN ? mesh->mu + 1 - from : WR_SPAN;
        for (int i = 0; i < n; i++) {
            u[i] = (float)(from + i) / (float)mesh->mu;
            v[i] = mesh->v[j];
        }
        size_t at = (size_t)j * (size_t)(mesh->mu + 1) + (size_t)from;
        job->kernels->points[mesh->kind](&mesh->shape, n, u, v, mesh->x + at, mesh->y + at,
                                         mesh->z + at);
    }
}

/* Rows are evenly spaced, except that the row next to a corner moves onto it; else cells would cut it off. */
static void place_rows(WrViewMesh *mesh, const WrShape *shape)
{
    double corner[WR_MESH_CORNERS];
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    const int corners = info->corners ? info->corners(shape, corner, WR_MESH_CORNERS) : 0;
    for (int j = 0; j <= mesh->mv; j++) mesh->v[j] = (float)j / (float)mesh->mv;
    for (int k = 0, last = 0; k < corners; k++) {
        int j = (int)(corner[k] * mesh->mv + 0.5);
        j = j > last ? j : last + 1; /* two corners share one row: the next row moves */
        if (j >= mesh->mv) break;
        mesh->v[j] = (float)corner[k];
        for (int i = j + 1; i < mesh->mv && mesh->v[i] <= mesh->v[j]; i++) mesh->v[i] = mesh->v[j];
        last = j;
    }
}

/* A block may be discarded only if the tile is outside the bounds of all its vertices. Vertices behind the
   near plane have no place on the screen, so a block that straddles the plane counts as unbounded (`clipped`). */
static void project_row(int j, int worker, void *ctx)
{
    (void)worker;
    MeshJob *job = ctx;
    WrViewMesh *mesh = job->mesh;
    const size_t at = (size_t)j * (size_t)(mesh->mu + 1);
    const WrRasterRow row = { mesh->sx + at, mesh->sy + at, mesh->close + at, mesh->out + at };
    raster_project_row(job->view, mesh->mu + 1, mesh->x + at, mesh->y + at, mesh->z + at, &row);
}

static void bound_row(int by, int worker, void *ctx)
{
    (void)worker;
    MeshJob *job = ctx;
    WrViewMesh *mesh = job->mesh;
    const int pitch = mesh->mu + 1;
    for (int bx = 0; bx < mesh->blocks_u; bx++) {
        WrViewMeshBlock b = { INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN, false };
        int behind = 0;
        for (int y = 0; y <= WR_MESH_BLOCK; y++)
            for (int x = 0; x <= WR_MESH_BLOCK; x++) {
                size_t at = (size_t)(by * WR_MESH_BLOCK + y) * (size_t)pitch +
                            (size_t)(bx * WR_MESH_BLOCK + x);
                if (mesh->out[at] == WR_VERTEX_BEHIND) {
                    behind++;
                    continue;
                }
                b.x0 = mesh->sx[at] < b.x0 ? mesh->sx[at] : b.x0;
                b.x1 = mesh->sx[at] > b.x1 ? mesh->sx[at] : b.x1;
                b.y0 = mesh->sy[at] < b.y0 ? mesh->sy[at] : b.y0;
                b.y1 = mesh->sy[at] > b.y1 ? mesh->sy[at] : b.y1;
            }
        /* A block entirely behind the near plane is empty: no tile overlaps its box. */
        b.clipped = behind > 0 && behind < (WR_MESH_BLOCK + 1) * (WR_MESH_BLOCK + 1);
        mesh->blocks[by * mesh->blocks_u + bx] = b;
    }
}

static void allocate(WrViewMesh *mesh, int mu, int mv)
{
    size_t count = (size_t)(mu + 1) * (size_t)(mv + 1);
    free_points(mesh);
    mesh->mu = mu, mesh->mv = mv;
    mesh->blocks_u = mu / WR_MESH_BLOCK, mesh->blocks_v = mv / WR_MESH_BLOCK;
    mesh->v = wr_alloc((size_t)mv + 1, sizeof *mesh->v);
    mesh->x = wr_alloc(count, sizeof *mesh->x);
    mesh->y = wr_alloc(count, sizeof *mesh->y);
    mesh->z = wr_alloc(count, sizeof *mesh->z);
    mesh->sx = wr_alloc(count, sizeof *mesh->sx);
    mesh->sy = wr_alloc(count, sizeof *mesh->sy);
    mesh->close = wr_alloc(count, sizeof *mesh->close);
    mesh->out = wr_alloc(count, sizeof *mesh->out);
    mesh->blocks = wr_alloc((size_t)mesh->blocks_u * (size_t)mesh->blocks_v, sizeof *mesh->blocks);
}

/* Newton's method starts from the raster's (u, v), which is within one cell (reach). Its error after a step is
   the square of the one before times bend / slope; on a mesh of 64 cells or more two steps reach float
   precision. */
static WrNewton choose_newton(const WrViewMesh *mesh, const WrSurfaceInfo *info, double scale,
                              const WrMeshRequest *ask)
{
    const int enough = mesh->mu < 64 || mesh->mv < 64 ? 3 : 2;
    return (WrNewton){ .reach_u = 1.0f / (float)mesh->mu,
                       .reach_v = 1.0f / (float)mesh->mv,
                       .enough_u = (float)fmin(ask->texels / fmax(ask->table_w, 1e-9), 1.0),
                       .enough_v = (float)fmin(ask->texels / fmax(ask->table_h, 1e-9), 1.0),
                       .uu = (float)(mesh->uu * scale),
                       .uv = (float)(mesh->uv * scale),
                       .vv = (float)(mesh->vv * scale),
                       .closed_u = info->closed_u,
                       .closed_v = info->closed_v,
                       .steps = ask->newton < 0 ? enough : ask->newton };
}

WrViewProjection wr_view_projection(const WrView *view)
{
    return (WrViewProjection){ .eye = view->eye,
                               .right = view->right,
                               .up = view->up,
                               .forward = view->forward,
                               .half_w = view->half_w,
                               .half_h = view->half_h,
                               .near = view->near,
                               .grid_w = view->grid_w,
                               .grid_h = view->grid_h,
                               .perspective = view->perspective };
}

/* Three stages, each only if its inputs changed: second derivatives of the shape, points of the mesh,
   projection. A view that only turns repeats the last one. */
void wr_view_mesh_prepare(WrViewMesh *mesh, const WrShape *shape, const WrView *view,
                          const WrMeshRequest *ask, const WrKernels *kernels, WrPool *pool)
{
    MeshJob job = { mesh, view, kernels };
    int mu, mv;
    measure_bend(mesh, shape);
    choose_cells(mesh, shape, view, ask->mesh, &mu, &mv);
    bool same = mesh->mu == mu && mesh->mv == mv && mesh->kind == shape->kind &&
                memcmp(&mesh->shape, &view->shape, sizeof view->shape) == 0;
    if (!same) {
        allocate(mesh, mu, mv);
        mesh->kind = shape->kind;
        mesh->shape = view->shape;
        place_rows(mesh, shape);
        wr_pool_run(pool, mv + 1, make_row, &job);
    }
    mesh->newton = choose_newton(mesh, wr_surfaces[shape->kind], view->scale, ask);
    const WrViewProjection projection = wr_view_projection(view);
    if (same && memcmp(&mesh->projection, &projection, sizeof projection) == 0) return;
    mesh->projection = projection;
    wr_pool_run(pool, mv + 1, project_row, &job);
    wr_pool_run(pool, mesh->blocks_v, bound_row, &job);
}

bool wr_view_mesh_box(const WrViewMesh *mesh, const WrView *view, const WrDepthTile *tile,
                      double box[4])
{
    const WrRasterBounds bounds = raster_bounds(tile, view->samples);
    box[0] = box[1] = INFINITY;
    box[2] = box[3] = -INFINITY;
    for (int i = 0; i < mesh->blocks_u * mesh->blocks_v; i++) {
        const WrViewMeshBlock *b = &mesh->blocks[i];
        if (!raster_meets(b, &bounds)) continue;
        box[0] = fmin(box[0], b->clipped ? -INFINITY : b->x0 / 256.0);
        box[1] = fmin(box[1], b->clipped ? -INFINITY : b->y0 / 256.0);
        box[2] = fmax(box[2], b->clipped ? INFINITY : b->x1 / 256.0);
        box[3] = fmax(box[3], b->clipped ? INFINITY : b->y1 / 256.0);
    }
    return box[0] <= box[2];
}

static void raster_clipped(const WrViewMesh *mesh, const WrView *view, const int ij[3][2],
                           WrDepthTile *tile)
{
    WrClipVertex corner[3];
    for (int k = 0; k < 3; k++) {
        size_t at = (size_t)ij[k][1] * (size_t)(mesh->mu + 1) + (size_t)ij[k][0];
        corner[k] = raster_camera_vertex(view, (WrVec3){ mesh->x[at], mesh->y[at], mesh->z[at] },
                                         (double)ij[k][0] / mesh->mu, (double)mesh->v[ij[k][1]]);
    }
    raster_clipping(view, corner, tile);
}

/* A block of cells while a tile of samples is drawn. */
typedef struct Block {
    const WrViewMesh *mesh;
    const WrView *view;
    WrRasterBounds bounds; /* of the tile */
    bool culls; /* back faces are detected before vertices are converted to the tile's grid */
    bool mirrored;
    float u[WR_MESH_BLOCK + 1]; /* of the vertices */
    int i0;
} Block;

/* Bits of the sides of the tile that each vertex of a row is outside of; 0 if it has no position.
   The bits of four vertices are ANDed: a cell is skipped if one side of the tile has all of them outside. A
   vertex behind the near plane has no bits, so its cell is always kept. */
static void find_sides(const Block *block, size_t at, unsigned char sides[WR_MESH_BLOCK + 1])
{
    const WrViewMesh *mesh = block->mesh;
    const WrRasterBounds *tile = &block->bounds;
    for (size_t i = 0; i <= WR_MESH_BLOCK; i++) {
        const int64_t x = mesh->sx[at + i], y = mesh->sy[at + i];
        const int beyond =
            (x < tile->x0) | (x > tile->x1) << 1 | (y < tile->y0) << 2 | (y > tile->y1) << 3;
        sides[i] = (unsigned char)(mesh->out[at + i] == WR_VERTEX_BEHIND ? 0 : beyond);
    }
}

static WrRasterVertex vertex_at(const Block *block, size_t at, int i, int j)
{
    const WrViewMesh *mesh = block->mesh;
    return (WrRasterVertex){ mesh->sx[at], mesh->sy[at], mesh->close[at], block->u[i - block->i0],
                             mesh->v[j] };
}

/* True if the triangle faces away or is degenerate, with the same decision as wr_raster_triangle. */
static bool looks_away(const Block *block, size_t a, size_t b, size_t c)
{
    const int32_t *x = block->mesh->sx, *y = block->mesh->sy;
    const int64_t area = ((int64_t)x[b] - x[a]) * ((int64_t)y[c] - y[a]) -
                         ((int64_t)y[b] - y[a]) * ((int64_t)x[c] - x[a]);
    return block->culls && (area == 0 || (area > 0) != block->mirrored);
}

/* Draws a cell whose four vertices are in front of the eye and near the picture.
   (i, j) is the cell's upper left vertex. Both triangles share the diagonal a - d, drawn with the same two
   vertices: no crack. */
static void raster_whole(const Block *block, size_t at, int i, int j, WrDepthTile *tile)
{
    const size_t low = at + (size_t)block->mesh->mu + 1;
    const bool one = !looks_away(block, at, at + 1, low + 1);
    const bool two = !looks_away(block, at, low + 1, low);
    if (!one && !two) return;
    const WrRasterVertex a = vertex_at(block, at, i, j);
    const WrRasterVertex d = vertex_at(block, low + 1, i + 1, j + 1);
    if (one) wr_raster_triangle(block->view, a, vertex_at(block, at + 1, i + 1, j), d, tile);
    if (two) wr_raster_triangle(block->view, a, d, vertex_at(block, low, i, j + 1), tile);
}

static void raster_cell(const Block *block, size_t at, int i, int j, WrDepthTile *tile)
{
    const unsigned char *top = block->mesh->out + at, *low = top + block->mesh->mu + 1;
    if (!(top[0] | top[1] | low[0] | low[1])) {
        raster_whole(block, at, i, j, tile);
        return;
    }
    if (top[0] == WR_VERTEX_BEHIND && top[1] == WR_VERTEX_BEHIND && low[0] == WR_VERTEX_BEHIND &&
        low[1] == WR_VERTEX_BEHIND)
        return;
    const int one[3][2] = { { i, j }, { i + 1, j }, { i + 1, j + 1 } };
    const int two[3][2] = { { i, j }, { i + 1, j + 1 }, { i, j + 1 } };
    raster_clipped(block->mesh, block->view, one, tile);
    raster_clipped(block->mesh, block->view, two, tile);
}

/* Draws the cells of block b that may overlap the tile: those whose corners are not all outside the same side.
   Two rows of bits, used alternately: each vertex is classified once, though two rows of cells use it. */
static void raster_block(Block *block, int b, WrDepthTile *tile)
{
    const WrViewMesh *mesh = block->mesh;
    const size_t pitch = (size_t)mesh->mu + 1;
    const int i0 = b % mesh->blocks_u * WR_MESH_BLOCK, j0 = b / mesh->blocks_u * WR_MESH_BLOCK;
    unsigned char sides[2][WR_MESH_BLOCK + 1];
    block->i0 = i0;
    for (int i = 0; i <= WR_MESH_BLOCK; i++) block->u[i] = (float)(i0 + i) / (float)mesh->mu;
    for (int j = 0; j <= WR_MESH_BLOCK; j++) {
        const size_t at = (size_t)(j0 + j) * pitch + (size_t)i0;
        const unsigned char *here = sides[j % 2], *over = sides[(j + 1) % 2];
        find_sides(block, at, sides[j % 2]);
        for (int i = 0; i < WR_MESH_BLOCK && j > 0; i++)
            if (!(over[i] & over[i + 1] & here[i] & here[i + 1]))
                raster_cell(block, at - pitch + (size_t)i, i0 + i, j0 + j - 1, tile);
    }
}

void wr_view_mesh_raster(const WrViewMesh *mesh, const WrView *view, WrDepthTile *tile)
{
    const bool own_grid = tile->k <= 0 || tile->k == view->samples;
    Block block = { .mesh = mesh,
                    .view = view,
                    .bounds = raster_bounds(tile, view->samples),
                    .culls = view->cull && own_grid,
                    .mirrored = view->stretch[0] * view->stretch[1] * view->stretch[2] < 0 };
    for (int i = 0; i < tile->w * tile->h; i++) tile->close[i] = -FLT_MAX;
    for (int b = 0; b < mesh->blocks_u * mesh->blocks_v; b++)
        if (raster_meets(&mesh->blocks[b], &block.bounds)) raster_block(&block, b, tile);
}

/* ---- mesh files ---- */

#define CHUNK 4096 /* corners projected by one task */

void wr_view_triangles_fini(WrViewTriangles *to)
{
    wr_triangles_free(to->source);
    wr_free(to->cones);
    wr_free(to->sx);
    wr_free(to->sy);
    wr_free(to->close);
    wr_free(to->out);
    wr_free(to->blocks);
    wr_free(to->groups);
    *to = (WrViewTriangles){ 0 };
}

static bool allocate_triangles(WrViewTriangles *to, const WrTriangles *source, WrError *err)
{
    const size_t corners = (size_t)source->corner_count;
    to->block_count = (source->triangle_count + WR_TRIANGLE_BLOCK - 1) / WR_TRIANGLE_BLOCK;
    to->group_count = (to->block_count + WR_TRIANGLE_GROUP - 1) / WR_TRIANGLE_GROUP;
    to->sx = wr_try_alloc(corners, sizeof *to->sx, "a mesh's view", err);
    to->sy = to->sx ? wr_try_alloc(corners, sizeof *to->sy, "a mesh's view", err) : NULL;
    to->close = to->sy ? wr_try_alloc(corners, sizeof *to->close, "a mesh's view", err) : NULL;
    to->out = to->close ? wr_try_alloc(corners, sizeof *to->out, "a mesh's view", err) : NULL;
    to->cones = to->out
                    ? wr_try_alloc((size_t)to->block_count, sizeof *to->cones, "a mesh's view", err)
                    : NULL;
    if (!to->cones) return false;
    to->blocks = wr_alloc((size_t)to->block_count, sizeof *to->blocks);
    to->groups = wr_alloc((size_t)to->group_count, sizeof *to->groups);
    return true;
}

/* ---- blocks ---- */

static int32_t block_end(const WrViewTriangles *to, int32_t block)
{
    const int32_t end = (block + 1) * WR_TRIANGLE_BLOCK, all = to->source->triangle_count;
    return end < all ? end : all;
}

static WrVec3 corner_at(const WrTriangles *t, int32_t i, int k)
{
    return v3_load(wr_triangle_corner(t, i, k)->p);
}

static WrVec3 face_normal(const WrTriangles *t, int32_t i)
{
    const WrVec3 a = corner_at(t, i, 0), none = { 0, 0, 0 };
    return v3_unit(v3_cross(v3_sub(corner_at(t, i, 1), a), v3_sub(corner_at(t, i, 2), a)), none);
}

/* Bounding sphere and normal cone of a block: the axis is the mean of the face normals, and the margin of 1e-9
   covers rounding. */
static void make_cone(int block, int worker, void *ctx)
{
    (void)worker;
    WrViewTriangles *to = ctx;
    const WrTriangles *t = to->source;
    const int32_t from = block * WR_TRIANGLE_BLOCK, end = block_end(to, block);
    WrTriangleCone cone = { .cosine = 1 };
    WrVec3 sum = { 0, 0, 0 };
    for (int32_t i = from; i < end; i++) {
        sum = v3_add(sum, face_normal(t, i));
        for (int k = 0; k < 3; k++)
            cone.centre = v3_mad(cone.centre, corner_at(t, i, k), 1.0 / (3 * (end - from)));
    }
    cone.axis = v3_unit(sum, (WrVec3){ 0, 0, 0 });
    for (int32_t i = from; i < end; i++) {
        cone.cosine = fmin(cone.cosine, v3_dot(cone.axis, face_normal(t, i)));
        for (int k = 0; k < 3; k++)
            cone.radius = fmax(cone.radius, v3_len(v3_sub(corner_at(t, i, k), cone.centre)));
    }
    cone.cosine -= 1e-9;
    cone.radius *= 1 + 1e-9;
    cone.sine = sqrt(fmax(0, 1 - cone.cosine * cone.cosine));
    to->cones[block] = cone;
}

/* True if all faces of the block certainly face away from the eye. With the axis at angle b from the direction
   to the eye and normals within a of it, n . (eye - P) <= |w| cos(b - a) + radius.
   Derivation: P = centre + r with |r| <= radius, so n.(eye - P) <= n.w + radius; n.w <= |w| cos(angle), and
   the angle between n and w is at least b - a. cos(b - a) = cos b cos a + sin b sin a. Strictly negative by
   1e-6 |w|: float normals and the integer area test may differ from this by rounding, and a visible face must
   not be lost (E61). */
static bool cone_looks_away(const WrTriangleCone *cone, const WrView *view)
{
    if (cone->cosine < 0) return false;
    WrVec3 w = v3_neg(view->ahead);
    double radius = 0, length = 1;
    if (view->perspective) {
        w = v3_sub(view->eye, v3_scale(cone->centre, view->scale));
        radius = cone->radius * view->scale;
        length = v3_len(w);
    }
    const double cos_b = v3_dot(cone->axis, w) / (length > 0 ? length : 1);
    const double sin_b = sqrt(fmax(0, 1 - cos_b * cos_b));
    /* the axis is within the cone's angle of that direction */
    if (cos_b > cone->cosine) return false;
    const double most = cos_b * cone->cosine + sin_b * cone->sine;
    return most * length + radius < -1e-6 * length;
}

typedef struct Job {
    WrViewTriangles *to;
    const WrView *view;
    bool apart;
} Job;

static void project_chunk(int chunk, int worker, void *ctx)
{
    (void)worker;
    const Job *job = ctx;
    WrViewTriangles *to = job->to;
    const int32_t end = (chunk + 1) * CHUNK, all = to->source->corner_count;
    for (int32_t i = chunk * CHUNK; i < (end < all ? end : all); i++) {
        const float *from = to->source->corners[i].p;
        const WrVec3 p = v3_scale((WrVec3){ (double)from[0], (double)from[1], (double)from[2] },
                                  job->view->scale);
        WrRasterVertex vertex;
        to->out[i] = WR_VERTEX_IN;
        if (!raster_project(job->view, p, 0, 0, &vertex))
            to->out[i] =
                raster_bound(job->view, p, &vertex.x, &vertex.y) ? WR_VERTEX_OUT : WR_VERTEX_BEHIND;
        to->sx[i] = vertex.x;
        to->sy[i] = vertex.y;
        to->close[i] = vertex.close;
    }
}

static const WrViewMeshBlock nothing = { INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN, false };

static void include_box(WrViewMeshBlock *in, const WrViewMeshBlock *b)
{
    in->x0 = b->x0 < in->x0 ? b->x0 : in->x0;
    in->x1 = b->x1 > in->x1 ? b->x1 : in->x1;
    in->y0 = b->y0 < in->y0 ? b->y0 : in->y0;
    in->y1 = b->y1 > in->y1 ? b->y1 : in->y1;
    in->clipped |= b->clipped;
}

/* Bounds of the projected corners. Corners behind the near plane have no position: a block with some of them has
   unknown bounds, one with only such corners is empty. */
static WrViewMeshBlock bound_block(const WrViewTriangles *to, int32_t block)
{
    WrViewMeshBlock b = nothing;
    int behind = 0, before = 0;
    for (int32_t i = block * WR_TRIANGLE_BLOCK; i < block_end(to, block); i++)
        for (int k = 0; k < 3; k++) {
            const int32_t c = to->source->triangles[i].corner[k];
            if (to->out[c] == WR_VERTEX_BEHIND) {
                behind++;
                continue;
            }
            before++;
            include_box(&b,
                        &(WrViewMeshBlock){ to->sx[c], to->sy[c], to->sx[c], to->sy[c], false });
        }
    b.clipped = behind > 0 && before > 0;
    return b;
}

static void bound_group(int group, int worker, void *ctx)
{
    (void)worker;
    const Job *job = ctx;
    WrViewTriangles *to = job->to;
    WrViewMeshBlock all = nothing;
    for (int32_t i = group * WR_TRIANGLE_GROUP;
         i < (group + 1) * WR_TRIANGLE_GROUP && i < to->block_count; i++) {
        const bool away =
            job->apart && job->view->cull && cone_looks_away(&to->cones[i], job->view);
        to->blocks[i] = away ? nothing : bound_block(to, i);
        include_box(&all, &to->blocks[i]);
    }
    to->groups[group] = all;
}

/* Corners are projected once for all triangles around them, and blocks of WR_TRIANGLE_BLOCK consecutive
   triangles are bounded; triangles are sorted along a space-filling curve, so blocks are compact. */
bool wr_view_triangles_prepare(WrViewTriangles *to, const WrTriangles *source, const WrView *view,
                               bool blocks_apart, WrPool *pool, WrError *err)
{
    Job job = { to, view, blocks_apart };
    if (to->source != source || (blocks_apart && !to->coned)) {
        WrTriangles *shared = wr_triangles_share(source);
        wr_view_triangles_fini(to);
        to->source = shared;
        if (!allocate_triangles(to, source, err)) {
            wr_view_triangles_fini(to);
            return false;
        }
        if (blocks_apart) wr_pool_run(pool, to->block_count, make_cone, to);
        to->coned = blocks_apart;
        to->whole = false;
    }
    const WrViewProjection projection = wr_view_projection(view);
    const bool apart = blocks_apart && view->cull;
    if (to->whole && to->scale == view->scale && to->cull == apart &&
        memcmp(&to->projection, &projection, sizeof projection) == 0)
        return true;
    to->projection = projection, to->scale = view->scale, to->cull = apart;
    wr_pool_run(pool, (source->corner_count + CHUNK - 1) / CHUNK, project_chunk, &job);
    wr_pool_run(pool, to->group_count, bound_group, &job);
    to->whole = true;
    return true;
}

/* ---- tiles ---- */

static WrRasterVertex vertex_of(const WrViewTriangles *from, int32_t c)
{
    return (WrRasterVertex){ from->sx[c], from->sy[c], from->close[c], 0, 0 };
}

static void raster_out(const WrViewTriangles *from, const WrView *view, int32_t i,
                       WrDepthTile *tile)
{
    WrClipVertex corner[3];
    for (int k = 0; k < 3; k++)
        corner[k] =
            raster_camera_vertex(view, v3_scale(corner_at(from->source, i, k), view->scale), 0, 0);
    raster_clipped_marked(view, corner, (float)i, tile);
}

/* True if all three are outside the same side.
   Marked triangles hold their index in u, and no depth-corrected (u, v): these are computed later, exactly,
   for the visible triangle alone. */
static bool beyond(int32_t a, int32_t b, int32_t c, int64_t from, int64_t to)
{
    return (a < from && b < from && c < from) || (a > to && b > to && c > to);
}

static void raster_one(const WrViewTriangles *from, const WrView *view,
                       const WrRasterBounds *bounds, int32_t i, WrDepthTile *tile)
{
    const int32_t *c = from->source->triangles[i].corner;
    const unsigned char *out = from->out;
    const int behind = (out[c[0]] == WR_VERTEX_BEHIND) + (out[c[1]] == WR_VERTEX_BEHIND) +
                       (out[c[2]] == WR_VERTEX_BEHIND);
    if (behind == 3) return;
    if (behind == 0 &&
        (beyond(from->sy[c[0]], from->sy[c[1]], from->sy[c[2]], bounds->y0, bounds->y1) ||
         beyond(from->sx[c[0]], from->sx[c[1]], from->sx[c[2]], bounds->x0, bounds->x1)))
        return;
    if (out[c[0]] | out[c[1]] | out[c[2]]) {
        raster_out(from, view, i, tile);
        return;
    }
    const WrRasterVertex corner[3] = { vertex_of(from, c[0]), vertex_of(from, c[1]),
                                       vertex_of(from, c[2]) };
    raster_marked(view, corner, (float)i, tile);
}

void wr_view_triangles_raster(const WrViewTriangles *from, const WrView *view, WrDepthTile *tile)
{
    const WrRasterBounds bounds = raster_bounds(tile, view->samples);
    for (int i = 0; i < tile->w * tile->h; i++) tile->close[i] = -FLT_MAX;
    for (int32_t b = 0; b < from->block_count; b++) {
        if (b % WR_TRIANGLE_GROUP == 0 &&
            !raster_meets(&from->groups[b / WR_TRIANGLE_GROUP], &bounds)) {
            b += WR_TRIANGLE_GROUP - 1;
            continue;
        }
        if (!raster_meets(&from->blocks[b], &bounds)) continue;
        const int32_t end = block_end(from, b);
        for (int32_t i = b * WR_TRIANGLE_BLOCK; i < end; i++)
            raster_one(from, view, &bounds, i, tile);
    }
}

bool wr_view_triangles_box(const WrViewTriangles *from, const WrView *view, const WrDepthTile *tile,
                           double box[4])
{
    const WrRasterBounds bounds = raster_bounds(tile, view->samples);
    WrViewMeshBlock all = nothing;
    for (int32_t i = 0; i < from->group_count; i++) {
        if (!raster_meets(&from->groups[i], &bounds)) continue;
        const int32_t end = (i + 1) * WR_TRIANGLE_GROUP;
        for (int32_t b = i * WR_TRIANGLE_GROUP; b < end && b < from->block_count; b++)
            if (raster_meets(&from->blocks[b], &bounds)) include_box(&all, &from->blocks[b]);
    }
    box[0] = all.clipped ? -INFINITY : all.x0 / 256.0;
    box[1] = all.clipped ? -INFINITY : all.y0 / 256.0;
    box[2] = all.clipped ? INFINITY : all.x1 / 256.0;
    box[3] = all.clipped ? INFINITY : all.y1 / 256.0;
    return box[0] <= box[2];
}

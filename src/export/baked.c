/* Baking of normal maps for a mesh. Each texel gets the bumped normal of the surface point with its (u,v), in
   the tangent frame of MikkTSpace, so that programs which shade by

     n' = unit(x vT + y vB + z vN),   vB = sign vN x vT,   vT and vN interpolated and not normalised

   obtain n' = unit(n - grad F), grad F = Fu grad u + Fv grad v without its component along n
   (surface/triangles.h). Uncovered texels get the mean of their neighbours, ring by ring, up to the padding, so
   that a filter at an island's edge reads only such values. Of several points with one (u,v) the last triangle
   counts: mirrored ones have the same normal there. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "export/job.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "surface/tangent_frames.h"
#include "surface/triangles.h"

#include <math.h>

#define LOOK 4096   /* triangles between two checks for cancellation */
#define SLIVER 1e-5 /* smallest ratio of height to longest side */

/* Values of `owner` that are not triangles. */
enum { NOBODY = -1, PADDING = -2, THIS_RING = -3 };

typedef struct Bake {
    WrExportJob *job;
    const WrTriangles *mesh;
    const WrTangent *frames; /* [3 triangles] */
    int32_t *owner;          /* [height][width] index of a triangle, or one of these */
    int padded;              /* set if the current ring has any texel */
} Bake;

/* ---- coverage of texels by triangles ---- */

/* A triangle on the map: texels from the top left, centres at whole numbers. */
typedef struct Flat {
    double x[3], y[3], area2; /* signed */
    int x0, x1, y0, y1;       /* texels that it can cover; not wrapped into the map */
} Flat;

static int whole(double x)
{
    return x < -2e9 ? -2000000000 : x > 2e9 ? 2000000000 : (int)x;
}

static bool lay_flat(const Bake *bake, int32_t triangle, Flat *flat)
{
    const double w = bake->job->width, h = bake->job->height;
    const int32_t *corner = bake->mesh->triangles[triangle].corner;
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c = &bake->mesh->corners[corner[k]];
        flat->x[k] = w * (double)c->u - 0.5;
        flat->y[k] = h * (1.0 - (double)c->v) - 0.5;
        low[0] = fmin(low[0], flat->x[k]), high[0] = fmax(high[0], flat->x[k]);
        low[1] = fmin(low[1], flat->y[k]), high[1] = fmax(high[1], flat->y[k]);
    }
    flat->area2 = (flat->x[1] - flat->x[0]) * (flat->y[2] - flat->y[0]) -
                  (flat->x[2] - flat->x[0]) * (flat->y[1] - flat->y[0]);
    flat->x0 = whole(ceil(low[0] - 1e-9)), flat->x1 = whole(floor(high[0] + 1e-9));
    flat->y0 = whole(ceil(low[1] - 1e-9)), flat->y1 = whole(floor(high[1] + 1e-9));
    /* A triangle larger than the map overlaps itself: one period is enough. */
    if (flat->x1 - flat->x0 >= bake->job->width) flat->x1 = flat->x0 + bake->job->width - 1;
    if (flat->y1 - flat->y0 >= bake->job->height) flat->y1 = flat->y0 + bake->job->height - 1;
    return flat->area2 != 0.0 && isfinite(flat->area2);
}

/* Barycentric coordinates of a texel's centre. */
static void shares(const Flat *flat, double x, double y, double l[3])
{
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        l[k] = ((flat->x[a] - x) * (flat->y[b] - y) - (flat->x[b] - x) * (flat->y[a] - y)) /
               flat->area2;
    }
}

static int wrapped(int i, int size)
{
    const int rest = i % size;
    return rest < 0 ? rest + size : rest;
}

/* True if the corners are almost collinear, as at a sphere's pole: such a triangle is invisible, but its slopes
   are unbounded. */
static bool is_sliver(const Bake *bake, int32_t triangle)
{
    const int32_t *corner = bake->mesh->triangles[triangle].corner;
    WrVec3 p[3];
    for (int k = 0; k < 3; k++) {
        const float *at = bake->mesh->corners[corner[k]].p;
        p[k] = (WrVec3){ (double)at[0], (double)at[1], (double)at[2] };
    }
    const WrVec3 a = v3_sub(p[1], p[0]), b = v3_sub(p[2], p[0]), c = v3_sub(p[2], p[1]);
    const double longest = fmax(fmax(v3_dot(a, a), v3_dot(b, b)), v3_dot(c, c));
    return !(v3_len(v3_cross(a, b)) > SLIVER * longest);
}

static void cover(Bake *bake, int32_t triangle)
{
    const int width = bake->job->width, height = bake->job->height;
    Flat flat;
    if (!lay_flat(bake, triangle, &flat) || is_sliver(bake, triangle)) return;
    for (int y = flat.y0; y <= flat.y1; y++)
        for (int x = flat.x0; x <= flat.x1; x++) {
            double l[3];
            shares(&flat, x, y, l);
            if (l[0] < -1e-9 || l[1] < -1e-9 || l[2] < -1e-9) continue;
            bake->owner[(size_t)wrapped(y, height) * (size_t)width + (size_t)wrapped(x, width)] =
                triangle;
        }
}

/* ---- normal at a texel ---- */

static WrVec3 mixed(const double l[3], const WrVec3 of[3])
{
    return v3_mad(v3_mad(v3_scale(of[0], l[0]), of[1], l[1]), of[2], l[2]);
}

/* Positions and normals of a triangle's corners, and its frames. */
static void corners_of(const Bake *bake, int32_t triangle, WrVec3 p[3], WrVec3 n[3], WrVec3 t[3],
                       double uv[3][2])
{
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c = &bake->mesh->corners[bake->mesh->triangles[triangle].corner[k]];
        p[k] = (WrVec3){ (double)c->p[0], (double)c->p[1], (double)c->p[2] };
        n[k] = (WrVec3){ (double)c->n[0], (double)c->n[1], (double)c->n[2] };
        t[k] = bake->frames[3 * (size_t)triangle + (size_t)k].t;
        uv[k][0] = (double)c->u, uv[k][1] = (double)c->v;
    }
}

/* Components x, y, z of a vector in three axes that need not be perpendicular. */
static bool along(WrVec3 t, WrVec3 b, WrVec3 n, WrVec3 of, WrVec3 *out)
{
    const WrVec3 bn = v3_cross(b, n), nt = v3_cross(n, t), tb = v3_cross(t, b);
    const double det = v3_dot(t, bn);
    if (!(fabs(det) > 1e-12)) return false;
    *out = (WrVec3){ v3_dot(of, bn) / det, v3_dot(of, nt) / det, v3_dot(of, tb) / det };
    return true;
}

/* Normal of one texel. False if the point has no frame. */
static bool bake_texel(const Bake *bake, int32_t triangle, int x, int y, WrVec3 *out)
{
    const WrExportJob *job = bake->job;
    const WrVec3 up = { 0, 0, 1 };
    WrVec3 p[3], n[3], t[3], face, gu, gv, grad = { 0, 0, 0 };
    double uv[3][2], l[3], f, fu, fv;
    Flat flat;
    lay_flat(bake, triangle, &flat);
    /* Chooses the periodic copy of the texel that is inside the triangle. */
    x = flat.x0 + wrapped(x - flat.x0, job->width);
    y = flat.y0 + wrapped(y - flat.y0, job->height);
    shares(&flat, x, y, l);
    corners_of(bake, triangle, p, n, t, uv);
    const bool sloped = wr_triangle_gradients(p, (const double(*)[2])uv, &face, &gu, &gv);
    const WrVec3 vn = mixed(l, n), vt = mixed(l, t), unit = v3_unit(vn, sloped ? face : up);
    if (sloped && job->scene->bump != WR_BUMP_NONE) {
        wr_scene_height(job->scene, job->field, (x + 0.5) / job->width,
                        1.0 - (y + 0.5) / job->height, &f, &fu, &fv);
        grad = v3_mad(v3_scale(gu, fu), gv, fv);
        grad = v3_mad(grad, unit, -v3_dot(unit, grad));
    }
    const double sign = bake->frames[3 * (size_t)triangle].sign;
    const WrVec3 bumped = v3_unit(v3_sub(unit, grad), unit);
    if (!along(vt, v3_scale(v3_cross(vn, vt), sign), vn, bumped, out)) return false;
    *out = v3_unit(*out, up);
    return true;
}

static void put(WrExportJob *job, int x, int y, WrVec3 n)
{
    float *at = job->map + 3 * ((size_t)y * (size_t)job->width + (size_t)x);
    at[0] = (float)n.x, at[1] = (float)n.y, at[2] = (float)n.z;
}

static void bake_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const Bake *bake = ctx;
    int64_t replaced = 0;
    if (wr_progress_stopped()) return;
    for (int j = y; j < y + rows; j++)
        for (int i = 0; i < job->width; i++) {
            const int32_t owner = bake->owner[(size_t)j * (size_t)job->width + (size_t)i];
            WrVec3 n = { 0, 0, 1 };
            if (owner >= 0 && !bake_texel(bake, owner, i, j, &n)) replaced++;
            put(job, i, j, n);
        }
    __atomic_fetch_add(&job->report.replaced, replaced, __ATOMIC_RELAXED);
}

/* ---- padding ---- */

/* Sets an uncovered texel to the mean of its covered neighbours: covered by triangles, or by an earlier ring. */
static bool pad_texel(Bake *bake, int x, int y)
{
    const int width = bake->job->width, height = bake->job->height;
    WrVec3 sum = { 0, 0, 0 };
    int count = 0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            const size_t at =
                (size_t)wrapped(y + dy, height) * (size_t)width + (size_t)wrapped(x + dx, width);
            const float *n = bake->job->map + 3 * at;
            const int32_t owner = __atomic_load_n(&bake->owner[at], __ATOMIC_RELAXED);
            if (owner == NOBODY || owner == THIS_RING) continue;
            sum = v3_add(sum, (WrVec3){ (double)n[0], (double)n[1], (double)n[2] });
            count++;
        }
    if (count > 0) put(bake->job, x, y, v3_unit(sum, (WrVec3){ 0, 0, 1 }));
    return count > 0;
}

/* Texels of this ring are used only by the next one. */
static void ring_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    Bake *bake = ctx;
    for (int j = y; j < y + rows; j++)
        for (int i = 0; i < job->width; i++) {
            int32_t *owner = &bake->owner[(size_t)j * (size_t)job->width + (size_t)i];
            if (*owner != NOBODY || !pad_texel(bake, i, j)) continue;
            __atomic_store_n(owner, THIS_RING, __ATOMIC_RELAXED);
            __atomic_store_n(&bake->padded, 1, __ATOMIC_RELAXED);
        }
}

static void settle_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const Bake *bake = ctx;
    int32_t *owner = bake->owner + (size_t)y * (size_t)job->width;
    for (size_t i = 0; i < (size_t)rows * (size_t)job->width; i++)
        if (owner[i] == THIS_RING) owner[i] = PADDING;
}

static void pad_ring(Bake *bake)
{
    WrExportJob *job = bake->job;
    bake->padded = 0;
    wr_export_run(job, 0, job->height, ring_piece, bake);
    wr_export_run(job, 0, job->height, settle_piece, bake);
}

/* ---- whole map ---- */

static bool bake_all(Bake *bake, WrError *err)
{
    WrExportJob *job = bake->job;
    const size_t texels = (size_t)job->width * (size_t)job->height;
    bake->owner = wr_try_alloc(texels, sizeof *bake->owner, "a map", err);
    job->map = bake->owner ? wr_try_alloc(3 * texels, sizeof(float), "a map", err) : NULL;
    if (!job->map) return false;
    for (size_t i = 0; i < texels; i++) bake->owner[i] = NOBODY;
    for (int32_t i = 0; i < bake->mesh->triangle_count; i++) {
        if (i % LOOK == 0 && wr_progress_stopped()) break;
        cover(bake, i);
    }
    wr_export_run(job, 0, job->height, bake_piece, bake);
    bake->padded = 1;
    for (int ring = 0; ring < job->options.padding && bake->padded; ring++) {
        if (wr_progress_stopped()) break;
        pad_ring(bake);
    }
    return !wr_progress_stopped() || wr_fail(err, "cancelled");
}

static bool bake_mesh(WrExportJob *job, const WrTriangles *mesh, WrError *err)
{
    const size_t count = 3 * (size_t)mesh->triangle_count;
    WrTangent *frames = wr_try_alloc(count, sizeof *frames, "the frames of a mesh", err);
    Bake bake = { .job = job, .mesh = mesh, .frames = frames };
    const bool good =
        frames &&
        wr_tangents_mikk(mesh->corners, mesh->triangles, mesh->triangle_count, frames, err) &&
        bake_all(&bake, err);
    wr_free(bake.owner);
    wr_free(frames);
    return good;
}

bool wr_export_baked_make(WrExportJob *job, WrError *err)
{
    const WrScene *scene = job->scene;
    if (!wr_surfaces[scene->shape.kind]->held)
        return wr_fail(err,
                       "surface %s: maps are baked for a mesh, patches or a terrain (`surface mesh "
                       "file=FILE`)",
                       wr_surfaces[scene->shape.kind]->name);
    if (scene->bump != WR_BUMP_NONE && scene->bump != WR_BUMP_BLINN)
        return wr_fail(err, "maps are baked for bump mode=blinn, or none: choose one of them");
    if (scene->triangles) return bake_mesh(job, scene->triangles, err);
    WrTriangles *square = wr_triangles_square();
    const bool good = bake_mesh(job, square, err);
    wr_triangles_free(square);
    return good;
}

static void put_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const WrExportStrip *strip = ctx;
    for (int j = y; j < y + rows; j++)
        for (int i = 0; i < job->width; i++) {
            const float *n = job->map + 3 * ((size_t)j * (size_t)job->width + (size_t)i);
            wr_export_store_normal(job, strip->out,
                                   (size_t)(j - strip->y) * (size_t)job->width + (size_t)i,
                                   (WrVec3){ (double)n[0], (double)n[1], (double)n[2] }, i, j);
        }
}

void wr_export_baked_rows(WrExportJob *job, int y, int rows, void *out)
{
    WrExportStrip strip = { y, out };
    wr_export_run(job, y, rows, put_piece, &strip);
}

void wr_export_baked_describe(WrExportJob *job)
{
    wr_text_add(wr_export_attribute(job, "wrinkle:frame"), "mikk");
    wr_export_describe_axes(job);
}

#include "surface/triangles_at.h"

#include "surface/patches.h"

#include <math.h>
#include <string.h>

#define EDGE                                                                                       \
    1e-9 /* tolerance outside a triangle, as a fraction of it, within which a point still counts as
            on its edge */
#define SHIFTS 64 /* maximum repeats of the table covered by one triangle, in each direction */
#define SAME 1e-6 /* points closer than this fraction of the radius are equal */

/* ---- search ---- */

typedef struct Search {
    const WrTriangles *mesh;
    double u, v;
    int most;
    WrTrianglesPlace *out;
    int64_t count;
} Search;

static void add_place(Search *search, int32_t index, double a, double b)
{
    const WrTrianglesPlace place = { index, { a, b } };
    WrSurfacePoint at, other;
    wr_triangles_at(search->mesh, &place, &at);
    const int64_t kept = search->count < search->most ? search->count : search->most;
    for (int64_t i = 0; i < kept; i++) {
        wr_triangles_at(search->mesh, &search->out[i], &other);
        if (v3_len(v3_sub(at.p, other.p)) <= SAME * search->mesh->radius) return;
    }
    if (search->count < search->most) search->out[search->count] = place;
    search->count++;
}

/* The weights (a, b) for which the corner at (o) plus a du, b dv is (u,v) or a repeat of it; in a
 * triangle or a square. */
typedef struct Frame {
    double o[2], a[2], b[2];
    bool square;
} Frame;

static void try_frame(Search *search, int32_t index, const Frame *f)
{
    const double det = f->a[0] * f->b[1] - f->a[1] * f->b[0];
    const double want[2] = { search->u, search->v };
    double first[2], last[2];
    if (!(fabs(det) > 0)) return;
    for (int k = 0; k < 2; k++) { /* integer shifts that bring the target into its range */
        const double x = f->o[k], y = x + f->a[k], z = x + f->b[k], w = f->square ? y + f->b[k] : x;
        const double slack = EDGE * (fabs(f->a[k]) + fabs(f->b[k])) + 1e-12;
        first[k] = ceil(fmin(fmin(x, y), fmin(z, w)) - want[k] - slack);
        last[k] = fmin(floor(fmax(fmax(x, y), fmax(z, w)) - want[k] + slack), first[k] + SHIFTS);
    }
    for (double j = first[1]; j <= last[1]; j++)
        for (double i = first[0]; i <= last[0]; i++) {
            const double x = want[0] + i - f->o[0], y = want[1] + j - f->o[1];
            const double a = (x * f->b[1] - y * f->b[0]) / det;
            const double b = (y * f->a[0] - x * f->a[1]) / det;
            const bool within = f->square ? a <= 1 + EDGE && b <= 1 + EDGE : a + b <= 1 + EDGE;
            if (a >= -EDGE && b >= -EDGE && within)
                add_place(search, index, fmin(fmax(a, 0), 1), fmin(fmax(b, 0), 1));
        }
}

static void search_mesh(Search *search)
{
    const WrTriangles *t = search->mesh;
    for (int32_t p = 0; p < t->part_count; p++) {
        const WrTrianglePart *part = &t->parts[p];
        for (int32_t i = part->first; part->mapped && i < part->first + part->count; i++) {
            const WrTriangleCorner *c[3];
            for (int k = 0; k < 3; k++) c[k] = &t->corners[t->triangles[i].corner[k]];
            const double u = (double)c[0]->u, v = (double)c[0]->v;
            const Frame frame = { { u, v },
                                  { (double)c[1]->u - u, (double)c[1]->v - v },
                                  { (double)c[2]->u - u, (double)c[2]->v - v },
                                  false };
            try_frame(search, i, &frame);
        }
    }
}

static void search_patches(Search *search)
{
    const WrPatches *set = search->mesh->patches;
    for (int32_t i = 0; i < set->count; i++) {
        const WrPatch *patch = &set->patch[i];
        Frame f = { .square = true };
        wr_patch_chart(set, patch, 0, 0, &f.o[0], &f.o[1]);
        wr_patch_chart(set, patch, 1, 0, &f.a[0], &f.a[1]);
        wr_patch_chart(set, patch, 0, 1, &f.b[0], &f.b[1]);
        for (int k = 0; k < 2; k++) f.a[k] -= f.o[k], f.b[k] -= f.o[k];
        try_frame(search, i, &f);
    }
}

int64_t wr_triangles_find(const WrTriangles *triangles, double u, double v, int most,
                          WrTrianglesPlace *out)
{
    Search search = {
        .mesh = triangles, .u = u - floor(u), .v = v - floor(v), .most = most, .out = out
    };
    if (!(fabs(u) < 1e15 && fabs(v) < 1e15)) return 0;
    if (triangles->patches) search_patches(&search);
    else search_mesh(&search);
    return search.count;
}

/* ---- the point ---- */

static void lay(WrVec3 n, WrVec3 grad_u, WrVec3 grad_v, WrSurfacePoint *out)
{
    const double area = v3_len(v3_cross(grad_u, grad_v)), length = area > 1e-30 ? 1 / area : 1;
    out->n_unit = n;
    out->n = v3_scale(n, length);
    out->n_len = length;
    out->pu = v3_scale(v3_cross(grad_v, n), length);
    out->pv = v3_scale(v3_cross(n, grad_u), length);
}

static WrVec3 vector_of(const float p[3])
{
    return (WrVec3){ (double)p[0], (double)p[1], (double)p[2] };
}

static void mesh_at(const WrTriangles *mesh, const WrTrianglesPlace *place, WrSurfacePoint *out)
{
    const double share[3] = { 1 - place->share[0] - place->share[1], place->share[0],
                              place->share[1] };
    const WrVec3 none = { 0, 0, 0 };
    WrVec3 p[3], n = none, face = { 0, 0, 1 }, gu = none, gv = none;
    double uv[3][2];
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *corner = &mesh->corners[mesh->triangles[place->index].corner[k]];
        p[k] = vector_of(corner->p);
        n = v3_mad(n, vector_of(corner->n), share[k]);
        uv[k][0] = (double)corner->u, uv[k][1] = (double)corner->v;
        out->p = v3_mad(out->p, p[k], share[k]);
    }
    (void)wr_triangle_gradients(p, (const double(*)[2])uv, &face, &gu, &gv);
    lay(v3_unit(n, face), gu, gv, out);
}

/* The patch's own gradients, transformed by the chart: table's u = (c0 + c1 u + c2 v) scale_u. */
static void patch_at(const WrPatches *set, const WrTrianglesPlace *place, WrSurfacePoint *out)
{
    const WrPatch *patch = &set->patch[place->index];
    const float *c = patch->chart;
    WrShape shape;
    WrSurfacePoint own;
    wr_shape_default(WR_SURFACE_bezier, &shape);
    for (int k = 0; k < 48; k++) shape.value[k] = (double)patch->point[k];
    wr_surface_at(&shape, 0, place->share[0], place->share[1], &own);
    out->p = own.p;
    const double inverse = own.n_len > 0 ? 1 / own.n_len : 0;
    const WrVec3 gu = v3_scale(v3_cross(own.pv, own.n_unit), inverse);
    const WrVec3 gv = v3_scale(v3_cross(own.n_unit, own.pu), inverse);
    lay(own.n_unit,
        v3_scale(v3_add(v3_scale(gu, (double)c[1]), v3_scale(gv, (double)c[2])), set->scale_u),
        v3_scale(v3_add(v3_scale(gu, (double)c[4]), v3_scale(gv, (double)c[5])), set->scale_v),
        out);
}

void wr_triangles_at(const WrTriangles *triangles, const WrTrianglesPlace *place,
                     WrSurfacePoint *out)
{
    memset(out, 0, sizeof *out);
    if (triangles->patches) patch_at(triangles->patches, place, out);
    else mesh_at(triangles, place, out);
}

#include "export/model.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "scene/scene.h"
#include "surface/surface.h"
#include "surface/triangles.h"

#include <math.h>
#include <stdlib.h>

#define STEPS 64   /* squares along u and along v of a curved face */
#define CORNERS 64 /* rows where Pv jumps, at most */
#define LINES (STEPS + 2 * CORNERS + 1)
#define CREASE                                                                                     \
    1e-6 /* of v: half the distance of the two rows at such a place, so that each has its own normals */

static bool reserve(WrModel *m, int32_t points, int32_t triangles, WrError *err)
{
    const size_t p = (size_t)points, t = (size_t)triangles;
    m->points = wr_try_alloc_unset(p, sizeof *m->points, "a model", err);
    m->normals = m->points ? wr_try_alloc_unset(p, sizeof *m->normals, "a model", err) : NULL;
    m->uv = m->normals ? wr_try_alloc_unset(p, sizeof *m->uv, "a model", err) : NULL;
    m->triangles = m->uv ? wr_try_alloc_unset(t, sizeof *m->triangles, "a model", err) : NULL;
    return m->triangles;
}

static WrVec3 times(WrVec3 a, WrVec3 b)
{
    return (WrVec3){ a.x * b.x, a.y * b.y, a.z * b.z };
}

static void put(float out[3], WrVec3 v)
{
    out[0] = (float)v.x, out[1] = (float)v.y, out[2] = (float)v.z;
}

/* One without area, as at a pole, is left out. */
static void add_triangle(WrModel *m, int32_t a, int32_t b, int32_t c, bool mirrored)
{
    WrVec3 p[3];
    const int32_t corner[3] = { a, mirrored ? c : b, mirrored ? b : c };
    for (int k = 0; k < 3; k++) {
        const float *at = m->points[corner[k]];
        p[k] = (WrVec3){ (double)at[0], (double)at[1], (double)at[2] };
    }
    const WrVec3 x = v3_sub(p[1], p[0]), y = v3_sub(p[2], p[0]);
    if (!(v3_len(v3_cross(x, y)) > 1e-9 * (v3_dot(x, x) + v3_dot(y, y)))) return;
    for (int k = 0; k < 3; k++) m->triangles[m->triangle_count][k] = (uint32_t)corner[k];
    m->triangle_count++;
}

/* ---- triangles that the scene holds ---- */

static bool take_triangles(const WrTriangles *t, WrVec3 stretch, WrVec3 cofactor, bool mirrored,
                           WrModel *m, WrError *err)
{
    if (!reserve(m, t->corner_count, t->triangle_count, err)) return false;
    for (int32_t i = 0; i < t->corner_count; i++) {
        const WrTriangleCorner *c = &t->corners[i];
        const WrVec3 p = { (double)c->p[0], (double)c->p[1], (double)c->p[2] };
        const WrVec3 n = { (double)c->n[0], (double)c->n[1], (double)c->n[2] };
        put(m->points[i], times(stretch, p));
        put(m->normals[i], v3_unit(times(cofactor, n), n));
        m->uv[i][0] = c->u, m->uv[i][1] = c->v;
    }
    m->point_count = t->corner_count;
    for (int32_t i = 0; i < t->triangle_count; i++) {
        const int32_t *c = t->triangles[i].corner;
        add_triangle(m, c[0], c[1], c[2], mirrored);
    }
    m->mapped = t->mapped;
    m->per_u = m->per_v = 1;
    return true;
}

/* ---- surfaces by formulas ---- */

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The rows of a face, ascending; where Pv jumps there are two. */
static int lay_rows(const WrShape *shape, WrSurfaceCell cell, int steps, double rows[LINES])
{
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    double corners[CORNERS];
    const int jumps = info->corners ? info->corners(shape, corners, CORNERS) : 0;
    int count = 0;
    for (int j = 0; j <= steps; j++) {
        const double v = cell.v0 + (cell.v1 - cell.v0) * j / steps;
        bool near = false;
        for (int k = 0; k < jumps; k++) near |= fabs(v - corners[k]) < 2 * CREASE;
        if (!near) rows[count++] = v;
    }
    for (int k = 0; k < jumps; k++) {
        rows[count++] = corners[k] - CREASE;
        rows[count++] = corners[k] + CREASE;
    }
    qsort(rows, (size_t)count, sizeof *rows, compare);
    return count;
}

typedef struct Cut {
    const WrShape *shape;
    WrVec3 stretch, cofactor;
    bool mirrored;
    double area, per_u, per_v; /* sums over the corners, weighted by the area about them */
} Cut;

static void add_point(Cut *cut, int face, double u, double v, WrModel *m)
{
    WrSurfacePoint o;
    wr_surface_at(cut->shape, face, u, v, &o);
    const WrVec3 pu = times(cut->stretch, o.pu), pv = times(cut->stretch, o.pv);
    const double area = v3_len(v3_cross(pu, pv));
    if (isfinite(area)) {
        cut->area += area;
        cut->per_u += area * v3_len(pu);
        cut->per_v += area * v3_len(pv);
    }
    put(m->points[m->point_count], times(cut->stretch, o.p));
    put(m->normals[m->point_count], v3_unit(times(cut->cofactor, o.n_unit), o.n_unit));
    m->uv[m->point_count][0] = (float)u, m->uv[m->point_count][1] = (float)v;
    m->point_count++;
}

static void cut_face(Cut *cut, int face, int steps, WrModel *m)
{
    const WrSurfaceCell cell = wr_surface_cell(cut->shape, face);
    double rows[LINES];
    const int count = lay_rows(cut->shape, cell, steps, rows);
    const int32_t first = m->point_count;
    for (int j = 0; j < count; j++)
        for (int i = 0; i <= steps; i++)
            add_point(cut, face, cell.u0 + (cell.u1 - cell.u0) * i / steps, rows[j], m);
    for (int j = 0; j + 1 < count; j++)
        for (int i = 0; i < steps; i++) {
            const int32_t a = first + j * (steps + 1) + i, b = a + 1, d = a + steps + 1, c = d + 1;
            add_triangle(m, a, b, c, cut->mirrored);
            add_triangle(m, a, c, d, cut->mirrored);
        }
}

static bool cut_surface(const WrScene *scene, Cut *cut, WrModel *m, WrError *err)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    const int steps = info->flat && !info->closed_u && !info->corners ? 1 : STEPS;
    if (!reserve(m, info->faces * LINES * (steps + 1), info->faces * LINES * 2 * steps, err))
        return false;
    for (int face = 0; face < info->faces; face++) cut_face(cut, face, steps, m);
    m->mapped = true;
    m->per_u = cut->area > 0 ? cut->per_u / cut->area : 1;
    m->per_v = cut->area > 0 ? cut->per_v / cut->area : 1;
    return true;
}

bool wr_model_make(const WrScene *scene, WrModel *model, WrError *err)
{
    *model = (WrModel){ 0 };
    Cut cut = { .shape = &scene->shape };
    wr_scene_stretch(scene, &cut.stretch, &cut.cofactor);
    cut.mirrored = cut.stretch.x * cut.stretch.y * cut.stretch.z < 0;
    bool good;
    if (wr_surfaces[scene->shape.kind]->held) {
        WrTriangles *own = scene->triangles ? NULL : wr_triangles_square();
        good = take_triangles(own ? own : scene->triangles, cut.stretch, cut.cofactor, cut.mirrored,
                              model, err);
        wr_triangles_free(own);
    } else {
        good = cut_surface(scene, &cut, model, err);
    }
    if (good && wr_progress_stopped()) good = wr_fail(err, "cancelled");
    if (!good) wr_model_fini(model);
    return good;
}

void wr_model_fini(WrModel *model)
{
    wr_free(model->points);
    wr_free(model->normals);
    wr_free(model->uv);
    wr_free(model->triangles);
    *model = (WrModel){ 0 };
}

/* Relief on an imported mesh as a solid in millimetres: the triangles of render/tessellation/mesh_relief.h, with folds
   counted, or lowered. */
#include "export/mesh_solid.h"

#include "base/error.h"
#include "base/length_unit.h"
#include "base/memory.h"
#include "base/pool.h"
#include "export/job.h"
#include "export/solid_body.h"
#include "field/field.h"
#include "render/tessellation/dice.h"
#include "render/tessellation/mesh_relief.h"
#include "scene/scene.h"
#include "surface/mesh_faults.h"
#include "surface/ray_tree.h"
#include "surface/triangles.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define LIMIT_ROUNDS 40 /* halvings of the heights of folded triangles */

/* ---- folds ---- */

/* True if the relief turned the triangle over: its normal is opposite to that without relief. */
static bool is_folded(const WrMeshRelief *r, const WrMeshReliefTriangle *t)
{
    WrVec3 p[3];
    for (int k = 0; k < 3; k++) p[k] = wr_mesh_relief_position(r, r->points.data[t->point[k]].base);
    const WrVec3 n = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
    for (int k = 0; k < 3; k++) {
        const float *at = r->at.data + 3 * t->point[k];
        p[k] = (WrVec3){ (double)at[0], (double)at[1], (double)at[2] };
    }
    return v3_dot(n, v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]))) < 0.0;
}

/* Counts the folded triangles; the place of the one with the largest displacement is the report's. */
static int64_t count_folds(const WrMeshRelief *r, WrExportReport *report)
{
    int64_t count = 0;
    double most = -1.0;
    for (int32_t i = 0; i < r->triangles.count; i++) {
        const WrMeshReliefTriangle *t = &r->triangles.data[i];
        if (!is_folded(r, t)) continue;
        const WrMeshReliefPoint *point = &r->points.data[t->point[0]];
        const WrVec3 at = wr_mesh_relief_position(r, point->base);
        count++;
        if (!(v3_len(point->d) > most)) continue;
        most = v3_len(point->d);
        report->solid_fold[0] = at.x, report->solid_fold[1] = at.y, report->solid_fold[2] = at.z;
    }
    return count;
}

/* Halves the displacement of folded triangles' points until none is folded: at 0 the mesh itself has no fold. */
static void limit_folds(WrMeshRelief *r, WrExportReport *report)
{
    bool *low = wr_alloc((size_t)r->points.count, sizeof *low);
    for (int round = 0; round < LIMIT_ROUNDS; round++) {
        int32_t count = 0;
        memset(low, 0, (size_t)r->points.count * sizeof *low);
        for (int32_t i = 0; i < r->triangles.count; i++)
            for (int k = 0; k < 3 && is_folded(r, &r->triangles.data[i]); k++)
                low[r->triangles.data[i].point[k]] = true;
        for (int32_t i = 0; i < r->points.count; i++) {
            if (!low[i]) continue;
            r->points.data[i].part = round + 1 < LIMIT_ROUNDS ? r->points.data[i].part / 2 : 0.0;
            wr_mesh_relief_move(r, i);
            count++;
        }
        if (count == 0) break;
    }
    wr_free(low);
    for (int32_t i = 0; i < r->points.count; i++)
        report->solid_limited += r->points.data[i].part < 1.0;
}

/* ---- thin walls and narrow gaps ---- */

#define ROOM_PIECE 1024  /* points */
#define OFF_SURFACE 1e-5 /* of the mesh's radius: rays start there, off the point's own faces */
#define ROOM_USED 0.9    /* of the room, after limiting */

/* Each point's relief may take half of the way to the mesh's next face in its direction: that face may come as far. */
typedef struct Rooms {
    const WrMeshRelief *relief;
    const WrRayTree *tree;
    double *room; /* [points]: half of that way, object units; INFINITY: there is enough */
} Rooms;

static void room_piece(int index, int worker, void *ctx)
{
    (void)worker;
    const Rooms *rooms = ctx;
    const WrMeshRelief *r = rooms->relief;
    const double off = OFF_SURFACE * r->request.mesh->radius;
    for (int32_t i = ROOM_PIECE * index; i < r->points.count && i < ROOM_PIECE * (index + 1); i++) {
        const WrMeshReliefPoint *point = &r->points.data[i];
        const double height = v3_len(point->d);
        WrRayHit hit;
        rooms->room[i] = INFINITY;
        if (!(height > off)) continue;
        const WrVec3 way = v3_scale(point->d, 1.0 / height);
        if (wr_ray_tree_closest(rooms->tree, v3_mad(point->base, way, off), way, 2.0 * height,
                                false, &hit))
            rooms->room[i] = (hit.t + off) / 2.0;
    }
}

/* Counts the points whose relief has no room, and lowers it there if that was asked for. */
static bool check_rooms(WrMeshRelief *r, bool limit, WrExportReport *report, WrError *err)
{
    WrRayTree *tree = wr_ray_tree_new(r->request.mesh, 0, r->request.mesh->triangle_count, err);
    double *room =
        tree ? wr_try_alloc((size_t)r->points.count, sizeof *room, "a solid", err) : NULL;
    Rooms rooms = { r, tree, room };
    double least = 1.0;
    bool good =
        room && (wr_pool_run_with_progress(r->request.pool, r->points.count / ROOM_PIECE + 1,
                                           room_piece, &rooms) ||
                 wr_fail(err, "cancelled"));
    for (int32_t i = 0; i < r->points.count && good; i++) {
        WrMeshReliefPoint *point = &r->points.data[i];
        const double height = v3_len(point->d), part = room[i] / height;
        if (!(part < 1.0)) continue;
        if (limit) {
            point->part = ROOM_USED * part;
            wr_mesh_relief_move(r, i);
            continue;
        }
        report->solid_thin++;
        if (part >= least) continue;
        const WrVec3 at = wr_mesh_relief_position(r, point->base);
        least = part;
        report->solid_thinnest[0] = at.x, report->solid_thinnest[1] = at.y,
        report->solid_thinnest[2] = at.z;
    }
    wr_free(room);
    wr_ray_tree_free(tree);
    return good;
}

/* ---- the whole ---- */

/* Moves the solid to where the mesh is in its file, if rounding to 32-bit floats there is at most half of the error
   (a rounding is up to half a unit in the last place along each axis). */
static void set_origin(WrMeshReliefRequest *ask, WrExportReport *report)
{
    const double *o = ask->scene->projection.origin;
    const WrVec3 at = { ask->stretch.x * o[0], ask->stretch.y * o[1], ask->stretch.z * o[2] };
    const double away = fmax(fabs(at.x), fmax(fabs(at.y), fabs(at.z))) * ask->scale;
    if (away * FLT_EPSILON <= ask->error / 2) {
        ask->middle = v3_neg(at);
        return;
    }
    report->solid_left_out[0] = at.x * ask->scale;
    report->solid_left_out[1] = at.y * ask->scale;
    report->solid_left_out[2] = at.z * ask->scale;
}

/* Millimetres per unit of the mesh: those of its file's unit, with its place there, or such that its longest side is
   `size`, about the origin. */
static void set_scale(WrMeshReliefRequest *ask, double size, WrExportReport *report)
{
    WrVec3 low = { INFINITY, INFINITY, INFINITY }, high = { -INFINITY, -INFINITY, -INFINITY };
    ask->scale = wr_length_unit_mm(ask->scene->projection.unit);
    if (!(size > 0)) {
        set_origin(ask, report);
        return;
    }
    for (int32_t i = 0; i < ask->mesh->corner_count; i++) {
        const float *p = ask->mesh->corners[i].p;
        const WrVec3 at = { ask->stretch.x * (double)p[0], ask->stretch.y * (double)p[1],
                            ask->stretch.z * (double)p[2] };
        low = (WrVec3){ fmin(low.x, at.x), fmin(low.y, at.y), fmin(low.z, at.z) };
        high = (WrVec3){ fmax(high.x, at.x), fmax(high.y, at.y), fmax(high.z, at.z) };
    }
    const WrVec3 d = v3_sub(high, low);
    ask->middle = v3_scale(v3_add(low, high), 0.5);
    ask->scale = size / fmax(d.x, fmax(d.y, d.z));
}

static void fill_body(const WrMeshRelief *r, WrSolidBody *body)
{
    const WrScene *scene = r->request.scene;
    const WrVec3 s = r->request.stretch;
    for (int32_t i = 0; i < r->points.count; i++)
        wr_solid_body_add_point(body, r->at.data + 3 * (size_t)i);
    for (int32_t i = 0; i < r->triangles.count; i++) {
        const WrMeshReliefTriangle *t = &r->triangles.data[i];
        float uv[3][2];
        for (int k = 0; k < 3; k++) {
            const WrMeshReliefPlace at = wr_mesh_relief_place(
                r->request.mesh, t->face, (double)t->b[k][0], (double)t->b[k][1]);
            uv[k][0] = (float)(at.u * scene->replicate_u);
            uv[k][1] = (float)(at.v * scene->replicate_v);
        }
        wr_solid_body_add_triangle(body, t->point, uv);
    }
    if (s.x * s.y * s.z < 0) wr_solid_body_reverse(body);
}

/* Of F, in object units: over the points, and over all texels of a table, since a relief below the error has few
   points. */
static double height_range(const WrExportJob *job, const WrMeshRelief *r)
{
    float low, high;
    if (job->scene->analytic.kind != WR_ANALYTIC_OFF) return r->high - r->low;
    wr_field_range(job->field, &low, &high);
    return fmax(r->high - r->low, fabs(job->scene->height) * ((double)high - (double)low));
}

static void report_relief(const WrMeshRelief *r, WrExportReport *report)
{
    for (int32_t i = 0; i < r->triangles.count; i++) {
        const WrMeshReliefTriangle *t = &r->triangles.data[i];
        if (t->error > t->allowed && wr_mesh_relief_at_crease(r, t)) report->solid_steps++;
        else report->solid_error = fmax(report->solid_error, (double)t->error);
        report->solid_missed += t->error > t->allowed && !wr_mesh_relief_at_crease(r, t);
    }
    report->low = r->low;
    report->high = r->high;
    report->solid_open = !r->request.mesh->closed;
    report->solid_folds = count_folds(r, report);
}

bool wr_mesh_solid_make(WrExportJob *job, WrSolidBody *body, WrError *err)
{
    WrMeshRelief relief = { 0 };
    WrVec3 cofactor;
    WrMeshReliefRequest ask = { .scene = job->scene,
                                .field = job->field,
                                .pool = job->pool,
                                .mesh = job->scene->triangles,
                                .rounded = job->options.solid_rounded,
                                .error = job->options.solid_error,
                                .fine = true,
                                .most = job->options.solid_most };
    if (!ask.mesh) return wr_fail(err, "the mesh has no file: `surface mesh file=FILE` reads one");
    if (!ask.mesh->mapped)
        return wr_fail(err, "the mesh has no texture coordinates, which relief needs: `surface "
                            "mesh projection=box` computes them");
    wr_scene_stretch(job->scene, &ask.stretch, &cofactor);
    if (wr_scene_is_thin(job->scene) &&
        fmin(fabs(ask.stretch.x), fmin(fabs(ask.stretch.y), fabs(ask.stretch.z))) <= WR_THINNEST)
        return wr_fail(
            err, "the object is flat (size=...,0): a solid needs a size above 0 along all axes");
    set_scale(&ask, job->options.solid_size, &job->report);
    WrRaised raised;
    bool good = wr_raised_init(&raised, job->scene, job->field, err);
    ask.scene = raised.scene;
    if (raised.field) ask.field = raised.field;
    good = good && wr_mesh_relief_make(&relief, &ask, err);
    if (good && relief.full && relief.triangles.count == 0)
        good = wr_fail(err, "the mesh has too many texels of the table for a solid: fewer repeats "
                            "(replicate), or a larger cell=");
    if (good && relief.full)
        good = wr_export_solid_full(job, wr_mesh_relief_fitting_error(&relief), err);
    const WrTriangles *file = wr_scene_mesh_source(job->scene);
    good = good &&
           wr_mesh_faults_find(file, job->scene->projection.origin, &job->report.solid_faults, err);
    const bool limit = job->options.solid_limited;
    good = good && check_rooms(&relief, limit, &job->report, err);
    if (good && limit) limit_folds(&relief, &job->report);
    if (good) {
        report_relief(&relief, &job->report);
        job->report.solid_relief = height_range(job, &relief) * ask.scale;
        fill_body(&relief, body);
    }
    wr_mesh_relief_fini(&relief);
    wr_raised_fini(&raised);
    return good;
}

/* Baking of normal maps for a mesh. Each texel gets the bumped normal of the surface point with its (u,v), in
   the tangent frame of MikkTSpace, so that programs which shade by

     n' = unit(x vT + y vB + z vN),   vB = sign vN x vT,   vT and vN interpolated and not normalised

   obtain n' = unit(n - grad F), grad F = Fu grad u + Fv grad v without its component along n
   (surface/triangles.h). F's slopes are combined with those of the object's normal map. Of several points with one (u,v) the last triangle counts: mirrored ones have the same
   normal there. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "export/job.h"
#include "field/field.h"
#include "scene/scene.h"
#include "scene/texture_sample.h"
#include "surface/surface.h"
#include "surface/tangent_frames.h"
#include "surface/triangles.h"
#include "surface/uv_coverage.h"

#include <math.h>

typedef struct Bake {
    WrExportJob *job;
    const WrTriangles *mesh;
    const WrTangent *frames; /* [3 triangles] */
    const WrTangent
        *lecture; /* [3 triangles] of the object's normal map, in frame=lecture; else NULL */
    WrUvCoverage cover;
} Bake;

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

/* Combines the slopes with those of the object's normal map, as pictures of the object show it. */
static void add_normal_map(const Bake *bake, int32_t triangle, const double l[3], WrVec3 vt,
                           WrVec3 vn, double u, double v, double *fu, double *fv)
{
    const WrExportJob *job = bake->job;
    const WrVec3 none = { 0, 0, 0 };
    const WrTrianglesPlace place = { triangle, { l[1], l[2] } };
    const bool table = !job->analytic;
    WrMapAxes axes = { vt, v3_scale(v3_cross(vn, vt), bake->frames[3 * (size_t)triangle].sign),
                       vn };
    WrSurfacePoint at;
    if (!job->scene->normals.image) return;
    if (bake->lecture) {
        const WrTangent *own = &bake->lecture[3 * (size_t)triangle];
        axes.t = v3_unit(mixed(l, (WrVec3[3]){ own[0].t, own[1].t, own[2].t }), none);
        axes.b = v3_unit(mixed(l, (WrVec3[3]){ own[0].b, own[1].b, own[2].b }), none);
        axes.n = v3_unit(vn, none);
    }
    wr_triangles_at(bake->mesh, &place, &at);
    wr_texture_sample_add_normals(
        job->scene, !table || wr_field_wrap_u(job->field) == WR_WRAP_PERIODIC,
        !table || wr_field_wrap_v(job->field) == WR_WRAP_PERIODIC, &at,
        v3_len(axes.t) > 0 && v3_len(axes.b) > 0 ? &axes : NULL, u, v, fu, fv);
}

/* Normal of one texel. False if the point has no frame. */
static bool bake_texel(const Bake *bake, int32_t triangle, int x, int y, WrVec3 *out)
{
    const WrExportJob *job = bake->job;
    const WrVec3 up = { 0, 0, 1 };
    WrVec3 p[3], n[3], t[3], face, gu, gv, grad = { 0, 0, 0 };
    double uv[3][2], l[3], f, fu, fv;
    wr_uv_coverage_shares(&bake->cover, triangle, x, y, l);
    corners_of(bake, triangle, p, n, t, uv);
    const bool sloped = wr_triangle_gradients(p, (const double(*)[2])uv, &face, &gu, &gv);
    const WrVec3 vn = mixed(l, n), vt = mixed(l, t), unit = v3_unit(vn, sloped ? face : up);
    if (sloped && job->scene->bump != WR_BUMP_NONE) {
        const double u = (x + 0.5) / job->width, v = 1.0 - (y + 0.5) / job->height;
        wr_scene_height(job->scene, job->field, u, v, &f, &fu, &fv);
        add_normal_map(bake, triangle, l, vt, vn, u, v, &fu, &fv);
        grad = v3_mad(v3_scale(gu, fu), gv, fv);
        grad = v3_mad(grad, unit, -v3_dot(unit, grad));
    }
    const double sign = bake->frames[3 * (size_t)triangle].sign;
    return wr_tangent_components(vt, vn, sign, v3_unit(v3_sub(unit, grad), unit), out);
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
            const int32_t owner = bake->cover.owner[(size_t)j * (size_t)job->width + (size_t)i];
            WrVec3 n = { 0, 0, 1 };
            if (owner >= 0 && !bake_texel(bake, owner, i, j, &n)) replaced++;
            put(job, i, j, n);
        }
    __atomic_fetch_add(&job->report.replaced, replaced, __ATOMIC_RELAXED);
}

/* ---- whole map ---- */

static bool bake_all(Bake *bake, WrError *err)
{
    WrExportJob *job = bake->job;
    job->map =
        wr_try_alloc(3 * (size_t)job->width * (size_t)job->height, sizeof(float), "a map", err);
    if (!job->map || !wr_uv_coverage_init(&bake->cover, bake->mesh, job->width, job->height, err))
        return false;
    bake->cover.udim = job->scene->projection.udim;
    wr_uv_coverage_fill(&bake->cover, 0, 0);
    wr_export_run(job, 0, job->height, bake_piece, bake);
    wr_uv_coverage_pad(&bake->cover, job->map, 3, true, job->options.padding, job->pool);
    return !wr_progress_stopped() || wr_fail(err, "cancelled");
}

static bool bake_mesh(WrExportJob *job, const WrTriangles *mesh, WrError *err)
{
    const size_t count = 3 * (size_t)mesh->triangle_count;
    const bool map = job->scene->normals.image && !job->scene->normals.object &&
                     wr_scene_frame(job->scene) == WR_FRAME_LECTURE;
    WrTangent *frames = wr_try_alloc(count, sizeof *frames, "the frames of a mesh", err);
    WrTangent *lecture =
        map ? wr_try_alloc(count, sizeof *lecture, "the frames of a mesh", err) : NULL;
    Bake bake = { .job = job, .mesh = mesh, .frames = frames, .lecture = lecture };
    const bool good =
        frames && (!map || lecture) &&
        wr_tangents_mikk(mesh->corners, mesh->triangles, mesh->triangle_count, frames, err) &&
        (!map ||
         wr_tangents_average(mesh->corners, mesh->triangles, mesh->triangle_count, lecture, err)) &&
        bake_all(&bake, err);
    wr_uv_coverage_fini(&bake.cover);
    wr_free(frames);
    wr_free(lecture);
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
    if (scene->triangles && !scene->triangles->mapped)
        return wr_fail(err, "the mesh has no texture coordinates for maps: unwrap it in a "
                            "modelling program and read it again");
    if (scene->bump != WR_BUMP_NONE && scene->bump != WR_BUMP_BLINN)
        return wr_fail(err, "maps are baked for bump mode=blinn, or none: choose one of them");
    job->report.table_sized = job->options.map_w == 0;
    if (scene->triangles)
        job->report.overlap = wr_triangles_overlap(scene->triangles, WR_UV_OVERLAP_CELLS);
    WrTriangles *mesh = scene->triangles ? wr_scene_whole_mesh(scene, err) : wr_triangles_square();
    const bool good = mesh && bake_mesh(job, mesh, err);
    wr_triangles_free(mesh);
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

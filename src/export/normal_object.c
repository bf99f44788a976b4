/* Object-space normals: the scene's surface bent by its bump, at each texel's centre. */
#include "base/error.h"
#include "export/job.h"
#include "scene/texture_sample.h"
#include "scene/scene.h"
#include "shade/bump.h"
#include "surface/surface.h"

/* Slopes come from wr_scene_slopes, as in rendering: by the scene's scheme, replicated. */
static WrVec3 normal_at(const WrExportJob *job, double u, double v)
{
    const WrScene *scene = job->scene;
    WrSurfacePoint p;
    double f, fu, fv;
    wr_surface_at(&scene->shape, 0, u, v, &p);
    wr_scene_slopes(scene, job->field, &p, u, v, &f, &fu, &fv);
    return wr_bump_unit_normal(scene->bump, p.n, p.n_unit, p.pu, p.pv, p.n_u, p.n_v, f, fu, fv);
}

static void piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const WrExportStrip *strip = ctx;
    for (int j = y; j < y + rows; j++)
        for (int i = 0; i < job->width; i++)
            wr_export_store_normal(job, strip->out,
                                   (size_t)(j - strip->y) * (size_t)job->width + (size_t)i,
                                   normal_at(job, job->u[i], wr_export_row_v(job, j)), i, j);
}

void wr_export_object_rows(WrExportJob *job, int y, int rows, void *out)
{
    WrExportStrip strip = { y, out };
    wr_export_run(job, y, rows, piece, &strip);
}

bool wr_export_object_check(const WrScene *scene, WrError *err)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    if (info->faces > 1 || info->inversion == WR_INVERT_TRIANGLES)
        return wr_fail(err,
                       "surface %s: normals along the object's axes are made of surfaces that "
                       "(u,v) lead to a point of: not of meshes, patches, terrains, cubes",
                       info->name);
    return true;
}

void wr_export_object_describe(WrExportJob *job)
{
    wr_text_add(wr_export_attribute(job, "wrinkle:space"), "object");
    wr_export_describe_axes(job);
}

/* Meshes from files, seen from above. */
#include "base/error.h"
#include "base/memory.h"
#include "generate/tile_builder.h"
#include "generate/solid.h"
#include "image/mesh.h"

const WrParam wr_params_solid_mesh[] = {
    { .name = "file",
      .label = "File",
      .help = "a mesh file: OBJ, PLY, STL, glTF and others",
      .unit = "",
      .kind = WR_PARAM_FILE,
      .positional = true },
    WR_S_RADIUS("size", "Size", 128, "of the longest side of its box, before it is turned"),
    WR_S_POSE,
    WR_S_HEIGHT("of its highest place over its lowest, as it is turned"),
    WR_S_PLACE,
    WR_P_END,
};

/* Centres the points at the middle of their bounding box and scales its longest side to `size`. False
 * if all are equal. */
static bool fit(const WrMesh *mesh, double size, double (*points)[3])
{
    double low[3], high[3], most = 0.0;
    for (int k = 0; k < 3; k++) {
        low[k] = high[k] = (double)mesh->points[0][k];
        for (int32_t i = 1; i < mesh->point_count; i++) {
            double x = (double)mesh->points[i][k];
            low[k] = x < low[k] ? x : low[k];
            high[k] = x > high[k] ? x : high[k];
        }
        if (high[k] - low[k] > most) most = high[k] - low[k];
    }
    double scale = size / most;
    if (!isfinite(scale)) return false;
    for (int32_t i = 0; i < mesh->point_count; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] =
                scale * ((double)mesh->points[i][k] - (low[k] + 0.5 * (high[k] - low[k])));
    return true;
}

bool wr_solid_mesh(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                   WrError *err)
{
    const WrParams params = { wr_params_solid_mesh, values };
    const char *file = wr_param_value(&params, "file")->text;
    WrMesh mesh;
    if (!wr_mesh_read(file, &mesh, err)) return false;
    double(*points)[3] =
        wr_try_alloc((size_t)mesh.point_count, sizeof *points, "the mesh's points", err);
    bool good = points;
    if (good && !fit(&mesh, wr_param_number(&params, "size"), points))
        good = wr_fail(err, "%s: all its points are in one place", file);
    const WrSolidNet net = { .points = (const double(*)[3])points,
                             .corners = mesh.corners,
                             .point_count = mesh.point_count,
                             .count = mesh.triangle_count };
    good = good && wr_solid_draw_net(&params, &net, job, out, err);
    wr_free(points);
    wr_mesh_fini(&mesh);
    return good;
}

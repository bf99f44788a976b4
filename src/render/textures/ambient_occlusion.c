#include "render/textures/ambient_occlusion.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"
#include "scene/scene.h"

#include <math.h>

#define LOOKS 12 /* sample points along u and along v at which the surface is measured */

void wr_occlusion_map_table_drop(WrOcclusionMapTable *table)
{
    wr_free(table->open);
    *table = (WrOcclusionMapTable){ 0 };
}

/* Mean length of a texel along u and v, in units of height, which must not be 0.
   pu, pv per unit of u, v: divided by texels per unit and by the height, they scale slopes of F to true
   slopes. */
static void occlusion_map_texel(const WrScene *scene, const WrField *field, double *across,
                                double *down)
{
    double wide = 0, high = 0;
    for (int k = 0; k < LOOKS * LOOKS; k++) {
        WrSurfacePoint at;
        wr_surface_at(&scene->shape, 0, (k % LOOKS + 0.5) / LOOKS,
                      ((double)(k / LOOKS) + 0.5) / LOOKS, &at);
        wide += v3_len(at.pu) / (LOOKS * LOOKS), high += v3_len(at.pv) / (LOOKS * LOOKS);
    }
    const double per = fabs(scene->height);
    *across = wide / (fmax(fabs(scene->replicate_u), 1e-9) * wr_field_width(field) * per);
    *down = high / (fmax(fabs(scene->replicate_v), 1e-9) * wr_field_height(field) * per);
}

/* After an edit only texels in `changed` are computed again; the key is that of the field before and after. */
bool wr_occlusion_map_table_update(WrOcclusionMapTable *table, const WrScene *scene,
                                   const WrField *field, const WrOcclusionMapEdit *edit,
                                   const WrHorizon *horizon, WrPool *pool, WrError *err)
{
    const double sign = scene->height < 0 ? -1 : 1;
    double across, down;
    WrOcclusionMap opening;
    occlusion_map_texel(scene, field, &across, &down);
    const bool like = table->open && table->width == horizon->width &&
                      table->height == horizon->height &&
                      table->directions == horizon->directions && table->across == sign * across &&
                      table->down == sign * down;
    if (like && table->key == edit->key) return true;
    const bool edited = like && edit->changed && table->key == edit->before;
    float *open = edited ? table->open : NULL;
    if (edited) table->open = NULL; /* incomplete while texels are updated */
    wr_occlusion_map_table_drop(table);
    if (!open)
        open = wr_try_alloc(wr_horizon_plane_size(horizon), sizeof *open, "how open the relief is",
                            err);
    if (!open) return false;
    wr_occlusion_map_make(&opening, horizon->directions, across, down);
    wr_occlusion_map_table(&opening, horizon, field, sign, edited ? edit->changed : NULL, pool,
                           open);
    if (wr_progress_stopped()) { /* it may be incomplete */
        wr_free(open);
        return wr_fail(err, "cancelled");
    }
    *table = (WrOcclusionMapTable){ .open = open,
                                    .width = horizon->width,
                                    .height = horizon->height,
                                    .key = edit->key,
                                    .directions = horizon->directions,
                                    .across = sign * across,
                                    .down = sign * down };
    return true;
}

#include "render/reference/reference_bezier.h"

#include "base/error.h"
#include "base/memory.h"
#include "render/reference/reference_box.h"

#include <math.h>
#include <string.h>

#define SLACK 1e-12
#define GROUP 16 /* patches that are neighbours in the file, with a common box */

struct WrReferenceBezierPiece {
    WrShape shape;
    WrReferencePatches tree;
    /* group: of the patches from here on; only in the first of each GROUP */
    WrReferenceBounds box, group;
};

/* A patch is inside the convex hull of its control points. */
static WrReferenceBounds box_of(const float *points)
{
    WrReferenceBounds box = wr_reference_bounds();
    for (int i = 0; i < 48; i++) wr_reference_bounds_add(&box, i % 3, (double)points[i]);
    return box;
}

bool wr_reference_bezier_init(WrReferenceBezier *set, const WrPatches *source, WrError *err)
{
    *set = (WrReferenceBezier){ .source = source };
    set->pieces = wr_try_alloc((size_t)source->count, sizeof *set->pieces, "the reference", err);
    if (!set->pieces) return false;
    for (int32_t i = 0; i < source->count; i++) {
        WrReferenceBezierPiece *piece = &set->pieces[i];
        wr_shape_default(WR_SURFACE_bezier, &piece->shape);
        for (int k = 0; k < 48; k++) piece->shape.value[k] = (double)source->patch[i].point[k];
        piece->box = piece->group = box_of(source->patch[i].point);
        WrReferenceBounds *group = &set->pieces[i - i % GROUP].group;
        for (int k = 0; k < 3; k++) {
            wr_reference_bounds_add(group, k, piece->box.low[k]);
            wr_reference_bounds_add(group, k, piece->box.high[k]);
        }
        if (!wr_reference_patches_init(&piece->tree, &piece->shape, err)) return false;
    }
    return true;
}

void wr_reference_bezier_fini(WrReferenceBezier *set)
{
    for (int32_t i = 0; set->pieces && i < set->source->count; i++)
        wr_reference_patches_fini(&set->pieces[i].tree);
    wr_free(set->pieces);
    *set = (WrReferenceBezier){ 0 };
}

bool wr_reference_bezier_hit(const WrReferenceBezier *set, bool cull, const WrReferenceRay *ray,
                             WrReferenceHit *hit)
{
    WrReferenceHit best = { .s = INFINITY, .triangle = -1 };
    for (int32_t i = 0; i < set->source->count; i++) {
        const WrReferenceBezierPiece *piece = &set->pieces[i];
        if (i % GROUP == 0 && !wr_reference_bounds_met(&piece->group, ray, best.s, SLACK)) {
            i += GROUP - 1;
            continue;
        }
        WrReferenceHit own = { 0 };
        if (!wr_reference_bounds_met(&piece->box, ray, best.s, SLACK) ||
            !wr_reference_patches_hit(&piece->tree, &piece->shape, cull, ray, &own) ||
            own.s >= best.s)
            continue;
        best = own;
        best.triangle = i;
    }
    if (best.triangle < 0) return false;
    *hit = best;
    hit->share[0] = best.u, hit->share[1] = best.v;
    wr_patch_chart(set->source, &set->source->patch[best.triangle], best.u, best.v, &hit->u,
                   &hit->v);
    return true;
}

/* The point with derivatives by the table's u and v, from the gradients of the patch's parameters. */
void wr_reference_bezier_at(const WrReferenceBezier *set, const WrReferenceHit *hit,
                            WrSurfacePoint *out)
{
    const float *c = set->source->patch[hit->triangle].chart;
    WrSurfacePoint at;
    wr_surface_at(&set->pieces[hit->triangle].shape, 0, hit->share[0], hit->share[1], &at);
    memset(out, 0, sizeof *out);
    out->p = at.p;
    out->n_unit = at.n_unit;
    out->n = at.n_unit;
    out->n_len = 1;
    if (!(at.n_len > 0)) return;
    const WrVec3 gu = v3_scale(v3_cross(at.pv, at.n_unit), 1 / at.n_len);
    const WrVec3 gv = v3_scale(v3_cross(at.n_unit, at.pu), 1 / at.n_len);
    const WrVec3 own_u = v3_scale(v3_add(v3_scale(gu, (double)c[1]), v3_scale(gv, (double)c[2])),
                                  set->source->scale_u);
    const WrVec3 own_v = v3_scale(v3_add(v3_scale(gu, (double)c[4]), v3_scale(gv, (double)c[5])),
                                  set->source->scale_v);
    wr_reference_lay(at.n_unit, own_u, own_v, out);
}

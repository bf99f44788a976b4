#include "render/reference/reference_displacement_difference.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/vec.h"
#include "render/reference/reference_shade.h"
#include "scene/objects.h"

#include <math.h>

typedef struct Row {
    int64_t places;
    double way, most, light;
} Row;

typedef struct Walk {
    const WrReferenceRequest *request;
    const WrReferenceStage *stage;
    Row *rows; /* [height] */
} Walk;

/* Screen position of an object's point, pixels. */
static void pixel_of(const WrReferenceView *view, WrVec3 p, double at[2])
{
    const WrVec3 from = v3_sub(p, view->perspective ? view->eye : view->middle);
    const WrVec3 a = v3_cross(view->up, view->forward), b = v3_cross(view->forward, view->right);
    const WrVec3 c = v3_cross(view->right, view->up);
    const double volume = v3_dot(view->right, a);
    const double deep = view->perspective ? v3_dot(from, c) / volume : 1;
    at[0] = view->width / 2 * (1 + v3_dot(from, a) / volume / deep / view->half_w);
    at[1] = view->height / 2 * (1 - v3_dot(from, b) / volume / deep / view->half_h);
}

/* The light of a point: with displacement, or with bump mapping. */
static void light_of(const WrReferenceStage *stage, WrSurfacePoint at, const WrReferenceHit *hit,
                     WrVec3 perturbed, double rgb[3])
{
    const WrReferenceView *view = &stage->view;
    const WrVec3 to = view->perspective ? v3_sub(view->eye, at.p) : view->toward;
    if (v3_dot(at.n_unit, to) < 0) perturbed = v3_neg(perturbed);
    wr_reference_light(stage, &at, hit, wr_reference_normal_stretched(view, perturbed),
                       (WrReferenceShare){ 0, 1 }, rgb);
}

static void note(const Walk *walk, const WrReferenceRay *ray, const WrReferenceHit *hit, Row *row)
{
    const WrReferenceStage *stage = walk->stage;
    WrSurfacePoint at;
    double f, fu, fv, from[2], to[2], bumped[3], displaced[3];
    wr_reference_view_at(&stage->view, hit, &at);
    wr_reference_height(stage, hit->u, hit->v, &f, &fu, &fv);
    wr_reference_add_map(stage, hit, &at, &fu, &fv);
    light_of(stage, at, hit, wr_reference_normal(stage->scene->bump, &at, f, fu, fv), bumped);
    pixel_of(&stage->view, at.p, from);
    const WrVec3 own = wr_reference_normal(WR_BUMP_EXACT, &at, f, fu, fv);
    at.p = v3_mad(ray->q, ray->d, hit->s);
    pixel_of(&stage->view, at.p, to);
    light_of(stage, at, hit, own, displaced);
    const double way = hypot(to[0] - from[0], to[1] - from[1]);
    row->places++;
    row->way += way, row->most = fmax(row->most, way);
    for (int c = 0; c < 3; c++) row->light += pow(displaced[c] - bumped[c], 2) / 3;
}

static void walk_row(int y, int worker, void *ctx)
{
    (void)worker;
    const Walk *walk = ctx;
    if (wr_cancel_requested(walk->request->cancel)) return;
    for (int x = 0; x < walk->request->width; x++) {
        const WrReferenceRay ray = wr_reference_view_ray(&walk->stage->view, x + 0.5, y + 0.5);
        WrReferenceHit hit;
        if (wr_reference_raised_hit(&walk->stage->raised, &ray, &hit))
            note(walk, &ray, &hit, &walk->rows[y]);
    }
}

static bool walk_object(const WrReferenceRequest *request, int i, Row *rows, WrPool *pool,
                        WrError *err)
{
    const WrField *own = request->fields ? request->fields[i] : NULL;
    const WrField *field = own ? own : request->field;
    WrScene *part =
        wr_scene_object_alone(request->scene, i, (double)request->width / request->height);
    WrReferenceStage *stage = wr_alloc(1, sizeof *stage);
    part->material.shadow = false;
    const bool good = wr_reference_stage_init(stage, field, part, request->turn_deg, request->width,
                                              request->height, true, pool, err) &&
                      wr_reference_stage_raise(stage, field, pool, err);
    Walk walk = { request, stage, rows };
    if (good) wr_pool_run(pool, request->height, walk_row, &walk);
    wr_reference_stage_fini(stage);
    wr_free(stage);
    wr_scene_free(part);
    return good;
}

bool wr_reference_displacement_difference(const WrReferenceRequest *request, WrPool *pool,
                                          WrMoved *out, WrError *err)
{
    Row *rows = wr_alloc((size_t)request->height, sizeof *rows), all = { 0 };
    bool good = true;
    for (int i = 0; i < wr_scene_object_count(request->scene) && good; i++) {
        const WrScene *object = wr_scene_object(request->scene, i);
        if (!object->hidden && wr_reference_displaced(object))
            good = walk_object(request, i, rows, pool, err);
    }
    for (int y = 0; y < request->height; y++) {
        all.places += rows[y].places;
        all.way += rows[y].way, all.light += rows[y].light;
        all.most = fmax(all.most, rows[y].most);
    }
    wr_free(rows);
    if (good && wr_cancel_requested(request->cancel)) return wr_fail(err, "cancelled");
    const double count = all.places > 0 ? (double)all.places : 1;
    *out = (WrMoved){ all.places, all.way / count, all.most, sqrt(all.light / count) };
    return good;
}

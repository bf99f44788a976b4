/* Picture of several objects: each is prepared as a picture of its own, then all are drawn tile by tile. */
#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "render/frame/frame_internal.h"
#include "scene/objects.h"
#include "system/clock.h"

#include <string.h>

/* One visible object. */
typedef struct Part {
    WrRenderer *renderer; /* owned, except for memory that the group's renderer lends it */
    WrScene *scene;       /* a scene with this object alone, as in the picture; owned */
    int object;           /* index among the scene's objects */
} Part;

struct WrGroup {
    WrScene *scene; /* of the last picture; own share */
    double aspect;
    Part parts[WR_OBJECTS_MAX];
    int count;       /* visible objects */
    int made;        /* parts that have a renderer */
    uint64_t scenes; /* number of scenes shown so far */
    WrFrameRequest last;
    bool whole; /* the last picture was finished */
};

static void free_part(Part *part)
{
    if (part->renderer) wr_renderer_forget(part->renderer);
    wr_free(part->renderer);
    wr_scene_free(part->scene);
    *part = (Part){ 0 };
}

void wr_group_free(WrRenderer *renderer)
{
    WrGroup *group = renderer->group;
    if (!group) return;
    for (int i = 0; i < group->made; i++) free_part(&group->parts[i]);
    wr_scene_free(group->scene);
    wr_free(group);
    renderer->group = NULL;
}

/* Creates a renderer that uses the group's threads and memory. */
static WrRenderer *new_part(WrRenderer *group)
{
    WrRenderer *part = wr_alloc(1, sizeof *part);
    part->pool = group->pool;
    part->threads = group->threads;
    part->scratch = group->scratch;
    memcpy(part->bins, group->bins, sizeof part->bins);
    memcpy(part->isa, group->isa, sizeof part->isa);
    wr_table_init(&part->table);
    part->relight = &group->own_relight;
    return part;
}

/* Reuses the old scene's part that has this object: its renderer holds copies of the object's table.
   Parts are swapped into place, so an edit that adds, removes or reorders objects keeps the tables and meshes
   of all others. */
static void take_renderer(WrGroup *group, int i, int object, WrRenderer *renderer)
{
    for (int k = i; k < group->made; k++) {
        if (group->parts[k].object != object) continue;
        const Part found = group->parts[k];
        group->parts[k] = group->parts[i];
        group->parts[i] = found;
        return;
    }
    if (i < group->made && group->made == WR_OBJECTS_MAX) return;
    if (i < group->made) group->parts[group->made] = group->parts[i];
    group->made++;
    group->parts[i] = (Part){ .renderer = new_part(renderer) };
}

/* Creates a renderer and a scene for each visible object. */
static void update_parts(WrRenderer *renderer, const WrFrameRequest *request)
{
    WrGroup *group = renderer->group;
    const double aspect = (double)request->width / request->height;
    if (group->scene == request->scene && group->aspect == aspect) return;
    WrScene *scene = wr_scene_share(request->scene);
    wr_scene_free(group->scene);
    group->scene = scene;
    group->scenes++;
    group->aspect = aspect;
    group->whole = false;
    group->count = 0;
    for (int i = 0; i < wr_scene_object_count(scene) && group->count < WR_OBJECTS_MAX; i++) {
        if (!wr_scene_shows(scene, i, aspect)) continue;
        take_renderer(group, group->count, i, renderer);
        Part *part = &group->parts[group->count++];
        wr_scene_free(part->scene);
        part->scene = wr_scene_object_alone(scene, i, aspect);
        part->object = i;
    }
    for (int i = group->count; i < group->made; i++) free_part(&group->parts[i]);
    group->made = group->count;
}

/* Codes are encoded once for the whole picture, so each part renders without them; the dials are those of the
   whole scene. */
static WrFrameRequest request_of(const Part *part, const WrFrameRequest *request)
{
    WrFrameRequest own = *request;
    const WrField *field = request->fields ? request->fields[part->object] : NULL;
    own.scene = part->scene;
    own.dials = request->dials ? request->dials : &request->scene->dials;
    own.field = field ? field : request->field;
    own.fields = NULL;
    own.codes = (WrFrameCodes){ 0 };
    return own;
}

/* Chooses the relight cache's use, if only light has changed. */
static void choose_steady(WrRenderer *renderer, const WrFrameRequest *request,
                          WrRenderer *const *owners)
{
    const WrGroup *group = renderer->group;
    WrRelightPart parts[WR_OBJECTS_MAX];
    for (int i = 0; i < group->count; i++) {
        const WrFrameRequest own = request_of(&group->parts[i], request);
        parts[i] = (WrRelightPart){ .scene = own.scene,
                                    .plan = &owners[i]->plan,
                                    .field = wr_field_key(own.field),
                                    .object = group->parts[i].object };
    }
    if (group->count > 0) renderer->kernels = owners[0]->kernels, renderer->wide = owners[0]->wide;
    wr_frame_choose_relight_cache(renderer, request, parts, owners, group->count);
}

/* Order: casters of all objects first, because a plan depends on whether anything can shadow its object; then
   all plans; then the relight cache, which compares all plans; then views and meshes. */
static bool prepare_parts(WrRenderer *renderer, const WrFrameRequest *request, WrError *err)
{
    WrGroup *group = renderer->group;
    WrRenderer *own_renderers[WR_OBJECTS_MAX];
    const WrScene *own_scenes[WR_OBJECTS_MAX];
    const WrField *own_fields[WR_OBJECTS_MAX];
    for (int i = 0; i < group->count; i++) {
        own_renderers[i] = group->parts[i].renderer;
        own_scenes[i] = group->parts[i].scene;
        own_fields[i] = request_of(&group->parts[i], request).field;
    }
    if (!wr_frame_casts(own_renderers, own_scenes, own_fields, group->count, request, err))
        return false;
    for (int i = 0; i < group->count; i++) {
        Part *part = &group->parts[i];
        const WrFrameRequest own = request_of(part, request);
        part->renderer->among = group->count;
        if (!wr_frame_resize(part->renderer, &own, err)) return false;
        if (!wr_frame_decide(part->renderer, &own, err)) return false;
    }
    choose_steady(renderer, request, own_renderers);
    for (int i = 0; i < group->count; i++) {
        const WrFrameRequest own = request_of(&group->parts[i], request);
        if (!wr_frame_prepare(own_renderers[i], &own, err)) return false;
    }
    return true;
}

/* Joins the plans: an effect runs if it runs for any object, and adaptive sampling is used if any object uses
   it. With no visible object: the plan of the current object. */
static void join_plans(WrRenderer *renderer, const WrFrameRequest *request)
{
    const WrGroup *group = renderer->group;
    const WrPlanRequest ask = { .scene = request->scene,
                                .dials = request->dials ? request->dials : &request->scene->dials };
    if (group->count == 0) wr_plan_build(&renderer->plan, &ask);
    for (int i = 0; i < group->count; i++) {
        const WrPlan *own = &group->parts[i].renderer->plan;
        if (i == 0) renderer->plan = *own;
        else wr_plan_add(&renderer->plan, own);
        if (own->sampling == WR_SAMPLING_ADAPTIVE) renderer->plan.sampling = own->sampling;
    }
}

/* True if the last picture fits this request, apart from edits of the tables. */
static bool group_rests(const WrRenderer *renderer, const WrFrameRequest *request)
{
    const WrGroup *group = renderer->group;
    bool rest = group->whole && group->count > 0 && wr_frame_may_keep(request) &&
                wr_frame_may_keep(&group->last) &&
                wr_frame_same_output(&group->last.codes, &request->codes);
    for (int i = 0; i < group->count && rest; i++)
        rest = !wr_plan_runs(&group->parts[i].renderer->plan, WR_EFFECT_AGAIN);
    return rest;
}

/* Everything that decides which object a sample shows.
   A hash of these is part of every object's uv-cache key: if one object moves, others may become visible
   behind it. */
typedef struct Place {
    WrViewProjection uv_cache;
    WrShapef shape;
    WrNewton newton;
    double deep[3], deep_from, nearest, stretch[3], x0, y0, x1, y1;
    int object, mu, mv, cull, triangles;
} Place;

static WrHash place_of(const Part *part, WrHash before)
{
    const WrRenderer *own = part->renderer;
    const WrView *view = &own->view;
    const WrViewProjection uv_cache = wr_view_projection(view);
    Place place;
    memset(&place, 0, sizeof place); /* clears padding as well: its bytes are hashed */
    memcpy(&place.uv_cache, &uv_cache, sizeof uv_cache);
    memcpy(&place.shape, &view->shape, sizeof place.shape);
    memcpy(place.deep, view->deep, sizeof place.deep);
    memcpy(place.stretch, view->stretch, sizeof place.stretch);
    if (own->mesh) memcpy(&place.newton, &own->mesh->newton, sizeof place.newton);
    if (own->mesh) place.mu = own->mesh->mu, place.mv = own->mesh->mv;
    place.deep_from = view->deep_from, place.nearest = view->nearest;
    place.x0 = view->x0, place.y0 = view->y0, place.x1 = view->x1, place.y1 = view->y1;
    place.object = part->object, place.cull = view->cull;
    place.triangles = own->triangles.source != NULL;
    return wr_hash_bytes(&place, sizeof place, before);
}

/* Reads or fills the objects' uv caches: they are valid while no object moves. */
static void update_sights(WrRenderer *renderer, const WrFrameRequest *request, bool anew)
{
    WrGroup *group = renderer->group;
    WrHash all = { .low = 1 };
    for (int i = 0; i < group->count; i++) {
        all = place_of(&group->parts[i], all);
        /* Triangles of a mesh file are not compared: the cache is valid only for this scene. */
        if (group->parts[i].renderer->triangles.source)
            all = wr_hash_bytes(&group->scenes, sizeof group->scenes, all);
    }
    for (int i = 0; i < group->count; i++) {
        const WrFrameRequest own = request_of(&group->parts[i], request);
        wr_frame_update_visibility(group->parts[i].renderer, &own, all, anew);
    }
}

/* True if tiles record their fetches from the tables. */
static bool notes_tiles(const WrRenderer *renderer, const WrFrameRequest *request, bool rests)
{
    return wr_frame_may_keep(request) && !rests && renderer->relight->use != WR_RELIGHT_KNOWN;
}

/* Target of the group's pixels. */
static WrTileJob make_canvas(WrRenderer *renderer, const WrFrameRequest *request)
{
    const WrDials *dials = request->dials ? request->dials : &request->scene->dials;
    const WrGroup *group = renderer->group;
    renderer->samples = group->count > 0 ? group->parts[0].renderer->samples : 1;
    renderer->kernels =
        wr_kernels_get(renderer->isa, dials->arithmetic == WR_ARITHMETIC_FAST, NULL);
    return wr_frame_canvas(renderer, request);
}

/* The parts' jobs, the nearest first.
   Sorted by the nearest depth of the bounding sphere; a stable insertion sort of at most WR_OBJECTS_MAX jobs. */
static int make_jobs(WrRenderer *renderer, const WrFrameRequest *request, bool rests,
                     const WrTileJob *canvas, WrTileJob jobs[WR_OBJECTS_MAX],
                     const WrDirty *keeps[WR_OBJECTS_MAX])
{
    WrGroup *group = renderer->group;
    for (int i = 0; i < group->count; i++) {
        Part *part = &group->parts[i];
        WrRenderer *own = part->renderer;
        const WrFrameRequest asked = request_of(part, request);
        WrTileJob job = wr_frame_job(own, &asked);
        const bool noted = notes_tiles(renderer, request, rests);
        if (noted) wr_frame_start_notes(canvas, &own->keep);
        else if (!rests) wr_dirty_fini(&own->keep);
        job.seen = noted ? &own->keep : NULL;
        job.object = part->object;
        keeps[i] = &own->keep;
        int k = i;
        for (; k > 0 && jobs[k - 1].view->nearest > job.view->nearest; k--) jobs[k] = jobs[k - 1];
        jobs[k] = job;
    }
    return group->count;
}

static void drop_keeps(WrRenderer *renderer)
{
    WrGroup *group = renderer->group;
    group->whole = false;
    for (int i = 0; i < group->count; i++) wr_dirty_fini(&group->parts[i].renderer->keep);
}

/* Invariant as in single_frame: after cancellation nothing of the picture is kept, because some tiles are new
   and others old. */
bool wr_group_frame(WrRenderer *renderer, const WrFrameRequest *request, WrFrame *frame,
                    WrError *err)
{
    const double started = wr_clock_seconds();
    if (!renderer->group) {
        wr_renderer_forget(renderer);
        renderer->group = wr_alloc(1, sizeof *renderer->group);
    }
    WrGroup *group = renderer->group;
    if (!wr_frame_resize(renderer, request, err)) return false;
    update_parts(renderer, request);
    if (!prepare_parts(renderer, request, err)) {
        drop_keeps(renderer);
        return false;
    }
    const bool rests = group_rests(renderer, request);
    update_sights(renderer, request, !rests);
    join_plans(renderer, request);
    wr_frame_start_counts(renderer);
    if (!rests) wr_did(renderer->scratch[0], WR_EFFECT_AGAIN);
    WrTileJob jobs[WR_OBJECTS_MAX];
    const WrDirty *keeps[WR_OBJECTS_MAX];
    FrameJob job = { .tile = make_canvas(renderer, request),
                     .objects = jobs,
                     .keeps = keeps,
                     .scratch = renderer->scratch,
                     .only = request->only,
                     .cancel = rests ? NULL : request->cancel };
    job.count = make_jobs(renderer, request, rests, &job.tile, jobs, keeps);
    job.keep_count = rests ? job.count : 0;
    renderer->last = *request;
    const double prepared = wr_clock_seconds() - started;
    if (!wr_frame_run(renderer, &job)) {
        drop_keeps(renderer);
        return wr_fail(err, "cancelled");
    }
    for (int i = 0; i < group->count; i++) wr_frame_mark_current(group->parts[i].renderer);
    group->last = *request;
    group->whole = true;
    wr_frame_account(renderer, prepared, started, frame);
    if (renderer->relight->use == WR_RELIGHT_NOTE) renderer->relight->whole = true;
    return true;
}

/* Depth is the affine function of P that find_depth in view.c sets up; the nearest object wins. */
bool wr_group_pick(WrRenderer *renderer, double x, double y, int *object, double *u, double *v,
                   int *face)
{
    WrGroup *group = renderer->group;
    double nearest = INFINITY;
    for (int i = 0; i < group->count; i++) {
        WrRenderer *part = group->parts[i].renderer;
        const WrView *view = &part->view;
        double at_u, at_v;
        int at_face;
        if (!part->seen) continue;
        WrTileJob job = wr_frame_job(part, NULL);
        if (!wr_tile_pick(&job, (int)(x * part->samples), (int)(y * part->samples),
                          renderer->scratch[0], &at_u, &at_v, &at_face))
            continue;
        WrSurfacePoint p;
        wr_surface_at(&view->shape_d, at_face, at_u, at_v, &p);
        const double depth =
            view->deep_from + view->deep[0] * p.p.x + view->deep[1] * p.p.y + view->deep[2] * p.p.z;
        if (!(depth < nearest)) continue;
        nearest = depth;
        *u = at_u, *v = at_v, *face = at_face, *object = group->parts[i].object;
    }
    return nearest < INFINITY;
}

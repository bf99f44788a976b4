#include "render/caches/relight_cache.h"

#include "base/memory.h"
#include "render/visibility/view.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#include <string.h>

static size_t samples_of(const WrRelightView *view)
{
    return (size_t)view->width * (size_t)view->height;
}

/* Floats per sample of each group; a view stores only the groups that its shading reads (wr_relight_groups). */
static const int group_sizes[] = {
    [WR_RELIGHT_BENT] = 3,    [WR_RELIGHT_POINTS] = 3,   [WR_RELIGHT_PLACES] = 2,
    [WR_RELIGHT_NORMALS] = 3, [WR_RELIGHT_TANGENTS] = 6, [WR_RELIGHT_SPREAD] = 6,
    [WR_RELIGHT_TRIANGLE] = 1
};
_Static_assert(sizeof group_sizes / sizeof *group_sizes == WR_RELIGHT_GROUPS, "all groups");

static int each_of(unsigned groups)
{
    int each = 0;
    for (int g = 0; g < WR_RELIGHT_GROUPS; g++)
        if (groups & WR_RELIGHT_BIT(g)) each += group_sizes[g];
    return each;
}

static void drop_numbers(WrRelight *relight)
{
    wr_free(relight->numbers);
    wr_free(relight->owner);
    for (int i = 0; i < relight->share_count; i++) wr_free(relight->shares[i].of);
    wr_free(relight->shares);
    wr_free(relight->lamps);
    relight->numbers = NULL;
    relight->owner = NULL;
    relight->shares = NULL;
    relight->lamps = NULL;
    relight->share_count = 0;
    relight->whole = false;
}

static void free_parts(WrRelightPart *parts, int count)
{
    for (int i = 0; i < count; i++) {
        wr_scene_free((WrScene *)parts[i].scene);
        wr_free((WrPlan *)parts[i].plan);
    }
    wr_free(parts);
}

void wr_relight_fini(WrRelight *relight)
{
    drop_numbers(relight);
    free_parts(relight->parts, relight->view.count);
    *relight = (WrRelight){ .parts = NULL };
}

/* ---- supported scenes ---- */

const char *wr_relight_hinders(const WrScene *scene, const WrPlan *plan)
{
    if (wr_plan_runs(plan, WR_EFFECT_DISPLACED)) return "the surface is displaced";
    if (wr_plan_runs(plan, WR_EFFECT_PARALLAX)) return "parallax moves the visible points";
    if (plan->sampling == WR_SAMPLING_ADAPTIVE)
        return "the samples that `adaptive` uses depend on their light";
    if (plan->shading_double) return "they are in double precision";
    if (wr_shape_endless(&scene->shape)) return "a plane without end fades by samples";
    return NULL;
}

unsigned wr_relight_groups(const WrScene *scene, const WrPlan *plan)
{
    const bool wide = wr_plan_runs(plan, WR_EFFECT_TINT) || plan->facets_filtered;
    const bool shadow = wr_plan_runs(plan, WR_EFFECT_SHADOW);
    const bool cast = wr_plan_runs(plan, WR_EFFECT_CAST);
    const bool held =
        wr_surfaces[scene->shape.kind]->held && !(scene->triangles && scene->triangles->patches);
    unsigned groups = WR_RELIGHT_BIT(WR_RELIGHT_BENT) | WR_RELIGHT_BIT(WR_RELIGHT_POINTS);
    if (wr_plan_runs(plan, WR_EFFECT_COLOUR) || wr_plan_runs(plan, WR_EFFECT_FACETS) || shadow ||
        wr_plan_runs(plan, WR_EFFECT_OCCLUSION))
        groups |= WR_RELIGHT_BIT(WR_RELIGHT_PLACES);
    if (wide || shadow || cast || wr_plan_runs(plan, WR_EFFECT_FADED))
        groups |= WR_RELIGHT_BIT(WR_RELIGHT_NORMALS);
    if (wide || shadow) groups |= WR_RELIGHT_BIT(WR_RELIGHT_TANGENTS);
    if (wr_plan_runs(plan, WR_EFFECT_SPREAD)) groups |= WR_RELIGHT_BIT(WR_RELIGHT_SPREAD);
    if (cast && held) groups |= WR_RELIGHT_BIT(WR_RELIGHT_TRIANGLE);
    return groups;
}

/* Samples of all objects have the same layout, the union of their groups, so that one index serves all. */
static unsigned all_groups(const WrRelightView *view)
{
    unsigned groups = 0;
    for (int i = 0; i < view->count; i++)
        groups |= wr_relight_groups(view->parts[i].scene, view->parts[i].plan);
    return groups;
}

/* ---- comparing ---- */

/* Effects that depend only on light, or on material that is a function of P, and the effects they own; and those
   that decide which numbers are computed, which `groups` compares. */
static const WrEffect of_light[] = { WR_EFFECT_DIFFUSE,   WR_EFFECT_SPECULAR,  WR_EFFECT_MODEL,
                                     WR_EFFECT_KEPT,      WR_EFFECT_FAINT,     WR_EFFECT_SURROUND,
                                     WR_EFFECT_MIRROR,    WR_EFFECT_BLUR,      WR_EFFECT_HARMONICS,
                                     WR_EFFECT_VARIED,    WR_EFFECT_GRAIN,     WR_EFFECT_OCTAVES,
                                     WR_EFFECT_FADED,     WR_EFFECT_COLOUR,    WR_EFFECT_TINT,
                                     WR_EFFECT_FACETS,    WR_EFFECT_SPREAD,    WR_EFFECT_SHADOW,
                                     WR_EFFECT_CAST,      WR_EFFECT_OCCLUSION, WR_EFFECT_TANGENTS,
                                     WR_EFFECT_PARAMETERS };

/* Copies from b everything that only light reads; the plans must then be equal. A new setting of the plan
   counts as geometry until it is listed here: the cache then misses, but never shows a stale picture. */
static bool same_plan(const WrPlan *a, const WrPlan *b)
{
    WrPlan lit = *a;
    for (size_t i = 0; i < sizeof of_light / sizeof *of_light; i++)
        lit.rows[of_light[i]].run = b->rows[of_light[i]].run;
    lit.model = b->model;
    lit.tint = b->tint;
    lit.kept = b->kept;
    lit.faint = b->faint;
    lit.harmonics = b->harmonics;
    lit.gloss = b->gloss;
    lit.grain = b->grain;
    lit.graded = b->graded;
    lit.lean = b->lean;
    lit.tint_anisotropic = b->tint_anisotropic;
    lit.facets_filtered = b->facets_filtered;
    lit.facets_anisotropic = b->facets_anisotropic;
    lit.rays = b->rays;
    lit.horizons = b->horizons;
    return wr_plan_same(&lit, b);
}

/* True if both bend n' by the same solid texture, or both by none. */
static bool same_grain(const WrRelightPart *a, const WrRelightPart *b)
{
    return !wr_plan_runs(b->plan, WR_EFFECT_EMBOSSED) ||
           memcmp(&a->scene->grain, &b->scene->grain, sizeof a->scene->grain) == 0;
}

static bool same_part(const WrRelightPart *a, const WrRelightPart *b)
{
    return a->field == b->field && a->object == b->object &&
           wr_scene_same_normals(a->scene, b->scene) && same_grain(a, b) &&
           same_plan(a->plan, b->plan);
}

static bool same(const WrRelightView *a, const WrRelightView *b)
{
    bool all = a->count == b->count && a->kernels == b->kernels && a->turn_deg == b->turn_deg &&
               a->width == b->width && a->height == b->height;
    for (int i = 0; i < b->count && all; i++) all = same_part(&a->parts[i], &b->parts[i]);
    return all;
}

/* Makes this view the one that later frames are compared with. */
static void take(WrRelight *relight, const WrRelightView *view)
{
    WrRelightPart *parts = wr_alloc((size_t)view->count, sizeof *parts);
    for (int i = 0; i < view->count; i++) {
        WrPlan *plan = wr_alloc(1, sizeof *plan);
        parts[i] = view->parts[i];
        *plan = *view->parts[i].plan;
        parts[i].plan = plan;
        parts[i].scene =
            wr_scene_share(parts[i].scene); /* before the old one is released: it may be the same */
    }
    drop_numbers(relight);
    free_parts(relight->parts, relight->view.count);
    relight->parts = parts;
    relight->view = *view;
    relight->view.parts = parts;
}

/* ---- lamps ---- */

/* Number of rays or directions that lamp shares are computed with, for the parts that have any; 0: none has. */
static int fine_of(const WrRelightView *view, bool cast)
{
    int fine = 0;
    for (int i = 0; i < view->count; i++) {
        const WrPlan *plan = view->parts[i].plan;
        const bool runs = wr_plan_runs(plan, cast ? WR_EFFECT_CAST : WR_EFFECT_SHADOW);
        const int own = cast ? plan->rays : plan->horizons;
        if (runs && own > fine) fine = own;
    }
    return fine;
}

static bool same_lamp(const WrLight *a, const WrLight *b)
{
    return a->kind == b->kind && a->where.x == b->where.x && a->where.y == b->where.y &&
           a->where.z == b->where.z && a->size_deg == b->size_deg && a->shadow == b->shadow;
}

static size_t share_bytes(const WrRelightView *view)
{
    return samples_of(view) * sizeof(float);
}

static size_t number_bytes(const WrRelightView *view)
{
    const size_t blocks = ((size_t)view->width + WR_RELIGHT_BLOCK - 1) / WR_RELIGHT_BLOCK;
    return blocks * (size_t)view->height * WR_RELIGHT_BLOCK * (size_t)each_of(all_groups(view)) *
               sizeof(float) +
           samples_of(view);
}

/* A share that no lamp of the current frame uses, or a new one without data; NULL: out of memory. */
static WrRelightShare *empty_share(WrRelight *relight)
{
    const size_t count = samples_of(&relight->view);
    WrRelightShare *share = NULL;
    for (int i = 0; i < relight->share_count && !share; i++)
        if (!relight->shares[i].used) share = &relight->shares[i];
    if (!share) {
        const size_t more = ((size_t)relight->share_count + 1) * share_bytes(&relight->view);
        if (more + number_bytes(&relight->view) > WR_RELIGHT_MAX) return NULL;
        float *of = wr_try_alloc(count, sizeof *of, "shadows", NULL);
        if (!of) return NULL;
        const size_t shares = (size_t)relight->share_count;
        relight->shares = wr_realloc(relight->shares, shares, shares + 1, sizeof *relight->shares);
        share = &relight->shares[relight->share_count++];
        share->of = of;
    }
    for (size_t i = 0; i < count; i++) share->of[i] = -1;
    return share;
}

static WrRelightShare *known_share(const WrRelight *relight, const WrLight *lamp, bool cast,
                                   int fine)
{
    for (int i = 0; i < relight->share_count; i++) {
        WrRelightShare *share = &relight->shares[i];
        if (share->cast == cast && share->fine == fine && same_lamp(&share->lamp, lamp))
            return share;
    }
    return NULL;
}

/* Assigns a share to each lamp. Lamps with known shares come first, so that no known share is reused for another
   lamp. */
static void update_shares(WrRelight *relight, const WrScene *scene, bool cast, int fine)
{
    for (int round = 0; round < 2; round++)
        for (int k = 0, i = 0; k < scene->light_count && fine > 0; k++) {
            const WrLight *lamp = &scene->lights[k];
            if (!wr_view_shows_light(scene, k)) continue;
            float **of = cast ? &relight->lamps[i].cast : &relight->lamps[i].relief;
            i++;
            if (*of || (cast && !lamp->shadow)) continue;
            WrRelightShare *share = known_share(relight, lamp, cast, fine);
            if (!share && round == 1 && (share = empty_share(relight))) {
                share->lamp = *lamp;
                share->cast = cast;
                share->fine = fine;
            }
            if (!share) continue;
            share->used = true;
            *of = share->of;
        }
}

/* Updates the shares of the current view's lamps. */
static void update_lamps(WrRelight *relight, const WrRelightView *view)
{
    const WrScene *scene = view->parts[0].scene;
    const int rays = fine_of(view, true), directions = fine_of(view, false);
    wr_free(relight->lamps);
    relight->lamps = NULL;
    for (int i = 0; i < relight->share_count; i++) relight->shares[i].used = false;
    if (rays == 0 && directions == 0) return;
    relight->lamps = wr_alloc((size_t)scene->light_count + 1, sizeof *relight->lamps);
    update_shares(relight, scene, true, rays);
    update_shares(relight, scene, false, directions);
}

/* ---- whole view ---- */

size_t wr_relight_bytes(const WrRelightView *view)
{
    const WrScene *scene = view->parts[0].scene;
    const bool relief = fine_of(view, false) > 0, cast = fine_of(view, true) > 0;
    size_t shares = 0;
    for (int k = 0; k < scene->light_count; k++)
        if (wr_view_shows_light(scene, k)) shares += relief + (cast && scene->lights[k].shadow);
    return number_bytes(view) + shares * share_bytes(view);
}

/* numbers [height][blocks of a row][each][WR_RELIGHT_BLOCK]; owner [samples] is the object + 1 that a sample
   shows, 0 for none. */
static bool make_room(WrRelight *relight, const WrRelightView *view)
{
    const size_t bytes = number_bytes(view), samples = samples_of(view);
    drop_numbers(relight);
    relight->groups = all_groups(view);
    relight->each = each_of(relight->groups);
    if (bytes > WR_RELIGHT_MAX) return false;
    relight->numbers = wr_try_alloc(bytes - samples, 1, "normals", NULL);
    relight->owner = wr_try_alloc(samples, 1, "samples", NULL);
    return relight->numbers && relight->owner;
}

/* NONE: another view than the last one, recorded now. NOTE: the same view again, samples are stored. KNOWN:
   they are read. */
WrRelightUse wr_relight_update(WrRelight *relight, const WrRelightView *view)
{
    const bool known = relight->whole;
    const bool lacks = known && (all_groups(view) & ~relight->groups) != 0;
    if (lacks || !same(&relight->view, view)) {
        take(relight, view);
        return WR_RELIGHT_NONE;
    }
    if (!known && !make_room(relight, view)) {
        drop_numbers(relight);
        return WR_RELIGHT_NONE;
    }
    update_lamps(relight, view);
    return known ? WR_RELIGHT_KNOWN : WR_RELIGHT_NOTE;
}

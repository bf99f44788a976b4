/* Composite of a document's layers: an incremental compositor for each part of the stack, and filters between the
   parts. */
#include "document/composite.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "document/below.h"
#include "document/document.h"
#include "document/layer_times.h"
#include "field/field.h"
#include "system/clock.h"
#include "system/thread.h"

#include <math.h>
#include <string.h>

/* ---- the compositor of one part ---- */

/* The inputs of a composite are stored as shares of the visible layers, its `parts`. An update compares the old
   and new parts, marks the tiles that may differ and computes them again.

   A tile is "bare" if it shows no more than the floor. The floor is the lowest part if that is shown unchanged,
   else an empty table at the composite's level. The composite starts as a share of the floor, so bare tiles cost
   nothing. If many tiles become bare later, they are shared with the floor again. A few, as under a brush, are
   copied, because the next dab would copy a shared tile anyway, into newly allocated memory each time. Once
   there are more of these stray copies than blended tiles, the composite restarts from the floor and keeps the
   blended tiles, so that memory stays bounded. */

#define TEXELS (WR_TILE * WR_TILE)
#define STRAYS 64 /* up to this many strays are tolerated */

typedef struct Part {
    /* compositor->parts own shares of the fields; elsewhere they are borrowed */
    WrBlendLayer layer;
    bool on_ground; /* no part below it is visible */
} Part;

/* A tile to be blended. */
typedef struct Job {
    int tx, ty;
    float *out;
} Job;

struct WrCompositor {
    WrField *result; /* NULL before the first update */
    Part *parts;     /* [count] */
    int count;
    bool broken;     /* an update was cancelled: the result does not match the parts */
    int64_t strays;  /* bare tiles copied since the last restart */
    int64_t blended; /* blended tiles at the last restart */
};

/* State of one update. */
typedef struct Update {
    WrCompositor *compositor;
    Part *parts; /* [count] the new parts, with borrowed fields */
    int count;
    WrField *floor;
    const Part *base; /* the part that is the floor, or NULL */
    bool whole;       /* mark all allocated tiles */
    uint8_t *marked;  /* [tiles] flags of the tiles in `dirty` */
    int tiles_u;
    WR_ARRAY(int) dirty; /* indices tx + ty tiles_u */
    WR_ARRAY(Job) jobs;
} Update;

static bool same_bits(float a, float b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

static bool same_size(const WrField *a, const WrField *b)
{
    return wr_field_width(a) == wr_field_width(b) && wr_field_height(a) == wr_field_height(b);
}

bool wr_blend_layer_check(const WrBlendLayer *layer, WrError *err)
{
    if ((int)layer->mode < 0 || layer->mode >= WR_BLEND_COUNT)
        return wr_fail(err, "blend mode %d: must be 0..%d", (int)layer->mode, WR_BLEND_COUNT - 1);
    if (!(layer->opacity >= 0.0f && layer->opacity <= 1.0f))
        return wr_fail(err, "opacity %g: must be 0..1", (double)layer->opacity);
    if (!(layer->radius >= 0.0f && layer->radius <= 3.4028234e38f))
        return wr_fail(err, "blend radius %g: must be 0 or more and finite", (double)layer->radius);
    const WrField *h = layer->heights;
    const WrField *others[] = { layer->cover, layer->mask };
    for (int i = 0; i < 2; i++)
        if (others[i] && !same_size(h, others[i]))
            return wr_fail(err, "%s of %dx%d texels: must have its layer's size, %dx%d",
                           i == 0 ? "coverage" : "mask", wr_field_width(others[i]),
                           wr_field_height(others[i]), wr_field_width(h), wr_field_height(h));
    return true;
}

/* The blend input of one tile of a part. */
static WrBlendTile part_tile(const Part *part, int tx, int ty)
{
    const WrBlendLayer *l = &part->layer;
    WrBlendTile tile = { .heights = wr_field_tile(l->heights, tx, ty),
                         .level = wr_field_level(l->heights),
                         .cover_level = 1.0f,
                         .mask_level = 1.0f };
    if (l->cover) {
        tile.cover = wr_field_tile(l->cover, tx, ty);
        tile.cover_level = wr_field_level(l->cover);
    }
    if (l->mask) {
        tile.mask = wr_field_tile(l->mask, tx, ty);
        tile.mask_level = wr_field_level(l->mask);
    }
    return tile;
}

/* The blend input of tiles in which all of a part's fields are empty. */
static WrBlendTile part_level(const Part *part)
{
    const WrBlendLayer *l = &part->layer;
    return (WrBlendTile){ .level = wr_field_level(l->heights),
                          .cover_level = l->cover ? wr_field_level(l->cover) : 1.0f,
                          .mask_level = l->mask ? wr_field_level(l->mask) : 1.0f };
}

/* True if the part changes no bit below. Decided by levels, so "false" may be wrong. Bits are
   compared, not values: 0 and -0 are equal but leave different bits. */
static bool is_idle(const Part *part, const WrBlendTile *tile)
{
    const WrBlendMode *mode = &wr_blends[part->layer.mode];
    const bool covers = tile->cover || tile->cover_level > 0.0f;
    if (!tile->mask && !(tile->mask_level > 0.0f)) return true;
    if (mode->uses_cover && !covers) return true;
    if (part->layer.backdrop == WR_BACKDROP_PARTIAL && covers) return false; /* changes coverage */
    return !tile->heights && same_bits(tile->level, mode->neutral);
}

static WrBlend mode_of(const Part *part)
{
    WrBlend mode = part->layer.mode;
    return part->on_ground && mode == WR_BLEND_ADD ? WR_BLEND_MIX : mode;
}

/* True if the part's result is exactly its heights, independent of those below. */
static bool is_opaque(const Part *part, const WrBlendTile *tile)
{
    const WrBlendMode *mode = &wr_blends[mode_of(part)];
    if (part->layer.backdrop == WR_BACKDROP_FILTER) return false; /* coverage is of those below */
    if (!mode->takes || part->layer.opacity < 1.0f) return false;
    if (tile->mask || tile->mask_level < 1.0f) return false;
    return !mode->uses_cover || (!tile->cover && tile->cover_level >= 1.0f);
}

/* cover: coverage of `below`, changed by parts on a partial backdrop */
static void blend(const Part *part, const WrBlendTile *tile, size_t count, float *below,
                  float *cover)
{
    const WrBlendLayer *l = &part->layer;
    if (l->backdrop == WR_BACKDROP_PARTIAL)
        wr_blend_tile_partial(l->mode, part->on_ground, l->opacity, l->radius, tile, count, below,
                              cover);
    else wr_blend_tile(mode_of(part), l->opacity, l->radius, tile, count, below);
}

/* Level of the composite where all parts are empty. A field's absent tile has its level everywhere, so blending one texel of
   levels through the same code yields the bits that blending such a whole tile would. */
static float composite_level(const Part *parts, int count)
{
    float level = 0.0f, cover = 0.0f;
    for (int i = 0; i < count; i++) {
        WrBlendTile tile = part_level(&parts[i]);
        blend(&parts[i], &tile, 1, &level, &cover);
    }
    return level;
}

/* The part that all bare tiles show, or NULL. */
static const Part *base_of(const Part *parts, int count, float level)
{
    if (count == 0 || !same_bits(level, wr_field_level(parts[0].layer.heights))) return NULL;
    WrBlendTile tile = part_level(&parts[0]);
    bool everywhere =
        !parts[0].layer.mask && !(wr_blends[mode_of(&parts[0])].uses_cover && parts[0].layer.cover);
    return everywhere && is_opaque(&parts[0], &tile) ? &parts[0] : NULL;
}

static bool is_bare(const Update *update, int tx, int ty)
{
    for (int i = update->base ? 1 : 0; i < update->count; i++) {
        WrBlendTile tile = part_tile(&update->parts[i], tx, ty);
        if (is_idle(&update->parts[i], &tile)) continue;
        /* with a base, a part that has an effect at its level changes the base's heights */
        if (update->base || tile.heights || tile.cover || tile.mask) return false;
    }
    return true;
}

static void mark(int tx, int ty, void *ctx)
{
    Update *update = ctx;
    int index = tx + ty * update->tiles_u;
    if (update->marked[index]) return;
    update->marked[index] = 1;
    wr_array_push(&update->dirty, index);
}

/* Marks every allocated tile of the field. */
static void mark_held(Update *update, const WrField *field)
{
    if (!field) return;
    WrField *empty = wr_field_new(wr_field_width(field), wr_field_height(field), WR_WRAP_PERIODIC,
                                  WR_WRAP_PERIODIC, wr_field_level(field), NULL);
    wr_field_changes(empty, field, mark, update);
    wr_field_free(empty);
}

static void mark_part(Update *update, const Part *part)
{
    WrBlendTile tile = part_level(part);
    if (!is_idle(part, &tile)) update->whole = true;
    mark_held(update, part->layer.heights);
    mark_held(update, part->layer.cover);
    mark_held(update, part->layer.mask);
}

static void mark_changes(Update *update, const WrField *a, const WrField *b)
{
    if (!a || wr_field_key(a) == wr_field_key(b)) return;
    if (same_bits(wr_field_level(a), wr_field_level(b))) wr_field_changes(a, b, mark, update);
    else update->whole = true;
}

/* True if both are the same layer, except for the contents of its fields. */
static bool same_settings(const Part *a, const Part *b)
{
    return a->layer.mode == b->layer.mode && a->layer.opacity == b->layer.opacity &&
           a->layer.radius == b->layer.radius && a->on_ground == b->on_ground &&
           a->layer.backdrop == b->layer.backdrop && !a->layer.cover == !b->layer.cover &&
           !a->layer.mask == !b->layer.mask;
}

static bool same_key(const WrField *a, const WrField *b)
{
    return (!a && !b) || wr_field_key(a) == wr_field_key(b);
}

static bool same_part(const Part *a, const Part *b)
{
    return same_settings(a, b) && same_key(a->layer.heights, b->layer.heights) &&
           same_key(a->layer.cover, b->layer.cover) && same_key(a->layer.mask, b->layer.mask);
}

/* Marks the differences between the old and new parts. Equal ones at both ends are skipped; in between, parts
   are compared in pairs if there are equally many, else all of them count as changed. Any pairing marks enough
   tiles: two different layers differ wherever either has a tile. */
static void mark_differences(Update *update)
{
    const Part *then = update->compositor->parts, *now = update->parts;
    int then_count = update->compositor->count, now_count = update->count;
    while (then_count && now_count && same_part(then, now))
        then++, now++, then_count--, now_count--;
    while (then_count && now_count && same_part(then + then_count - 1, now + now_count - 1))
        then_count--, now_count--;
    bool pairs = then_count == now_count;
    for (int i = 0; i < then_count || i < now_count; i++) {
        if (pairs && same_settings(&then[i], &now[i])) {
            mark_changes(update, then[i].layer.heights, now[i].layer.heights);
            mark_changes(update, then[i].layer.cover, now[i].layer.cover);
            mark_changes(update, then[i].layer.mask, now[i].layer.mask);
            continue;
        }
        if (i < then_count) mark_part(update, &then[i]);
        if (i < now_count) mark_part(update, &now[i]);
    }
}

/* Replaces the composite by its floor. */
static void start(Update *update)
{
    WrCompositor *c = update->compositor;
    wr_field_free(c->result);
    c->result = wr_field_share(update->floor);
    c->strays = c->blended = 0;
    for (int i = 0; i < update->count; i++) {
        mark_held(update, update->parts[i].layer.heights);
        mark_held(update, update->parts[i].layer.cover);
        mark_held(update, update->parts[i].layer.mask);
    }
}

static void copy_tile(WrField *to, const WrField *from, int tx, int ty)
{
    const float *tile = wr_field_tile(from, tx, ty);
    float *out = wr_field_tile_write(to, tx, ty);
    if (tile) memcpy(out, tile, sizeof *out * TEXELS);
    else
        for (int i = 0; i < TEXELS; i++) out[i] = wr_field_level(from);
}

static void run_job(int index, int worker, void *ctx)
{
    (void)worker;
    const Update *update = ctx;
    Job job = update->jobs.data[index];
    int first = update->count - 1; /* parts below an opaque tile have no effect */
    for (; first > 0; first--) {
        WrBlendTile tile = part_tile(&update->parts[first], job.tx, job.ty);
        if (is_opaque(&update->parts[first], &tile)) break;
    }
    float cover[TEXELS];
    memset(job.out, 0, sizeof *job.out * TEXELS);
    memset(cover, 0, sizeof cover);
    for (int i = first < 0 ? 0 : first; i < update->count; i++) {
        WrBlendTile tile = part_tile(&update->parts[i], job.tx, job.ty);
        if (!is_idle(&update->parts[i], &tile))
            blend(&update->parts[i], &tile, TEXELS, job.out, cover);
    }
}

/* Computes the marked tiles again. */
static void repaint(Update *update, WrPool *pool)
{
    WrCompositor *c = update->compositor;
    for (int i = 0; i < update->dirty.count && (i % 256 || !wr_progress_stopped()); i++) {
        int tx = update->dirty.data[i] % update->tiles_u;
        int ty = update->dirty.data[i] / update->tiles_u;
        if (!is_bare(update, tx, ty)) {
            Job job = { tx, ty, wr_field_tile_fresh(c->result, tx, ty) };
            wr_array_push(&update->jobs, job);
        } else if (update->dirty.count > STRAYS) {
            wr_field_tile_share(c->result, update->floor, tx, ty);
        } else if (wr_field_tile(c->result, tx, ty) != wr_field_tile(update->floor, tx, ty)) {
            copy_tile(c->result, update->floor, tx, ty);
            c->strays++;
        }
    }
    if (update->jobs.count) wr_pool_run_with_progress(pool, update->jobs.count, run_job, update);
}

typedef struct Gathering {
    const Update *update;
    WrField *fresh;
    int64_t blended;
} Gathering;

static void gather_tile(int tx, int ty, void *ctx)
{
    Gathering *g = ctx;
    if (is_bare(g->update, tx, ty)) return;
    wr_field_tile_share(g->fresh, g->update->compositor->result, tx, ty);
    g->blended++;
}

/* Restarts from the floor and keeps the blended tiles; all tiles that differ from the floor are either these or
   strays. */
static void drop_strays(Update *update)
{
    WrCompositor *c = update->compositor;
    Gathering gathering = { update, wr_field_share(update->floor), 0 };
    wr_field_changes(update->floor, c->result, gather_tile, &gathering);
    wr_field_free(c->result);
    c->result = gathering.fresh;
    c->strays = 0;
    c->blended = gathering.blended;
}

static void free_parts(Part *parts, int count)
{
    for (int i = 0; i < count; i++) {
        wr_field_free((WrField *)parts[i].layer.heights);
        wr_field_free((WrField *)parts[i].layer.cover);
        wr_field_free((WrField *)parts[i].layer.mask);
    }
    wr_free(parts);
}

static WrField *share_or_null(const WrField *field)
{
    return field ? wr_field_share(field) : NULL;
}

/* A copy of parts that owns shares of their fields. */
static Part *share_parts(const Part *parts, int count)
{
    if (count == 0) return NULL;
    Part *copy = wr_alloc((size_t)count, sizeof *copy);
    for (int i = 0; i < count; i++) {
        copy[i] = parts[i];
        copy[i].layer.heights = wr_field_share(parts[i].layer.heights);
        copy[i].layer.cover = share_or_null(parts[i].layer.cover);
        copy[i].layer.mask = share_or_null(parts[i].layer.mask);
    }
    return copy;
}

WrCompositor *wr_compositor_new(void)
{
    return wr_alloc(1, sizeof(WrCompositor));
}

WrCompositor *wr_compositor_snapshot(const WrCompositor *compositor)
{
    WrCompositor *copy = wr_compositor_new();
    *copy = *compositor;
    if (compositor->result) copy->result = wr_field_share(compositor->result);
    copy->parts = share_parts(compositor->parts, compositor->count);
    return copy;
}

void wr_compositor_free(WrCompositor *compositor)
{
    if (!compositor) return;
    free_parts(compositor->parts, compositor->count);
    wr_field_free(compositor->result);
    wr_free(compositor);
}

/* Selects the visible layers, without coverage if the mode does not use it. */
static void pick_parts(Update *update, const WrBlendLayer *layers, int count)
{
    update->parts = wr_alloc((size_t)count, sizeof *update->parts);
    for (int i = 0; i < count; i++) {
        WR_ASSERT(wr_blend_layer_check(&layers[i], NULL));
        WR_ASSERT(wr_field_alike(layers[i].heights, layers[0].heights));
        if (layers[i].hidden || !(layers[i].opacity > 0.0f)) continue;
        Part *part = &update->parts[update->count];
        *part = (Part){ .layer = layers[i], .on_ground = update->count == 0 };
        const bool covers =
            layers[i].backdrop == WR_BACKDROP_PARTIAL && layers[i].mode != WR_BLEND_MIX;
        if (!wr_blends[part->layer.mode].uses_cover && !covers) part->layer.cover = NULL;
        if (!wr_blends[part->layer.mode].uses_radius) part->layer.radius = 0.0f;
        update->count++;
    }
}

/* True if the old composite can be updated by computing only marked tiles. */
static bool is_mendable(const Update *update, const WrField *like, float level)
{
    const WrCompositor *c = update->compositor;
    return c->result && !c->broken && wr_field_alike(c->result, like) &&
           same_bits(wr_field_level(c->result), level) &&
           !base_of(c->parts, c->count, level) == !update->base;
}

static void keep_parts(const Update *update)
{
    WrCompositor *c = update->compositor;
    Part *kept = share_parts(update->parts, update->count);
    free_parts(c->parts, c->count);
    c->parts = kept;
    c->count = update->count;
    c->broken = false;
}

/* ---- cancelled updates ---- */

/* State before an update that can be cancelled. */
typedef struct Before {
    WrField *result; /* owned; NULL: nothing can be restored */
    int64_t strays, blended;
} Before;

static Before keep_before(const WrCompositor *c)
{
    bool keeps = c->result && !c->broken && wr_progress_here();
    return (Before){ keeps ? wr_field_share(c->result) : NULL, c->strays, c->blended };
}

/* Restores the old result, which still matches the old parts; otherwise the next update restarts. */
static void put_back(WrCompositor *c, Before *before)
{
    c->broken = !before->result;
    if (c->broken) return;
    wr_field_free(c->result);
    c->result = before->result;
    before->result = NULL;
    c->strays = before->strays;
    c->blended = before->blended;
}

const WrField *wr_compositor_update(WrCompositor *compositor, const WrBlendLayer *layers, int count,
                                    WrPool *pool)
{
    WR_ASSERT(count >= 1);
    const WrField *like = layers[0].heights;
    Update update = { .compositor = compositor, .tiles_u = wr_field_tiles_u(like) };
    pick_parts(&update, layers, count);
    float level = composite_level(update.parts, update.count);
    update.base = base_of(update.parts, update.count, level);
    update.floor = update.base
                       ? wr_field_share(update.base->layer.heights)
                       : wr_field_new(wr_field_width(like), wr_field_height(like),
                                      wr_field_wrap_u(like), wr_field_wrap_v(like), level, NULL);
    update.marked = wr_alloc((size_t)update.tiles_u * (size_t)wr_field_tiles_v(like), 1);
    update.whole = !is_mendable(&update, like, level);
    if (!update.whole) mark_differences(&update);
    Before before = keep_before(compositor);
    if (update.whole) start(&update);
    repaint(&update, pool);
    if (compositor->strays > compositor->blended + STRAYS) drop_strays(&update);
    if (wr_progress_stopped()) put_back(compositor, &before);
    else keep_parts(&update);
    wr_field_free(before.result);
    wr_free(update.parts);
    wr_free(update.marked);
    wr_array_free(&update.dirty);
    wr_array_free(&update.jobs);
    wr_field_free(update.floor);
    return compositor->result;
}

/* ---- the composite, divided by filters and groups ---- */

/* A filter divides the stack: the layers below it are composited separately, the operation is applied, and the
   rest is composited on top. So each part of the stack has its own compositor. Each filter stores its input and
   its output, and recomputes only the part that an edit may have changed.

   A group is a stack of its own, composited first; its result is then blended as a layer's heights and coverage are. An
   update of the group changes only the tiles that differ, and so does the update of the stack that it is in.

   The coverage of a stack is a composite too: of flat heights 1 that replace by the layers' coverage. */

/* A filter, or none, and the layers from there up to the next filter. */
typedef struct Stage {
    WrFilter filter;     /* op NULL: none, as in the lowest stage */
    WrField *given;      /* input of `made`; NULL: not computed; owned */
    WrField *made;       /* owned */
    WrCompositor *above; /* compositor of `made`, or of `given`, with the layers; owned */
    WrCompositor
        *cover; /* compositor of the coverage up to there; empty if it is not needed; owned */
} Stage;

/* The stack of one group, or of the top level. */
typedef struct Chain {
    WR_ARRAY(Stage) stages;
} Chain;

struct WrComposite {
    WrMutex lock;
    Chain top;
    WR_ARRAY(Chain) groups; /* [groups] in the order of their rows */
    WrField *one;           /* height 1 everywhere; NULL: not needed yet */
    WrBelow *below;         /* for layers that read the layers below them; owned; NULL: none has */
};

/* Error of the last filter that failed; "" if none did. */
static _Thread_local WrError lack;

void wr_filters_forget(void)
{
    lack.text[0] = '\0';
}

bool wr_filters_carried(WrError *err)
{
    if (!lack.text[0]) return true;
    if (err) *err = lack;
    return false;
}

WrComposite *wr_composite_new(void)
{
    WrComposite *composite = wr_alloc(1, sizeof *composite);
    wr_mutex_init(&composite->lock);
    return composite;
}

static Chain share_chain(const Chain *chain)
{
    Chain copy = { 0 };
    for (int i = 0; i < chain->stages.count; i++) {
        const Stage *stage = &chain->stages.data[i];
        wr_array_push(&copy.stages,
                      ((Stage){ stage->filter, share_or_null(stage->given),
                                share_or_null(stage->made), wr_compositor_snapshot(stage->above),
                                wr_compositor_snapshot(stage->cover) }));
    }
    return copy;
}

WrComposite *wr_composite_share(const WrComposite *composite)
{
    /* the cast is only for locking */
    WrComposite *from = (WrComposite *)composite, *copy = wr_composite_new();
    wr_mutex_lock(&from->lock);
    copy->top = share_chain(&from->top);
    for (int i = 0; i < from->groups.count; i++)
        wr_array_push(&copy->groups, share_chain(&from->groups.data[i]));
    copy->one = share_or_null(from->one);
    copy->below = wr_below_share(from->below);
    wr_mutex_unlock(&from->lock);
    return copy;
}

static void drop_stages(Chain *chain, int first)
{
    for (int i = first; i < chain->stages.count; i++) {
        Stage *stage = &chain->stages.data[i];
        wr_field_free(stage->given);
        wr_field_free(stage->made);
        wr_compositor_free(stage->above);
        wr_compositor_free(stage->cover);
    }
    if (chain->stages.count > first) chain->stages.count = first;
    if (first == 0) wr_array_free(&chain->stages);
}

static void drop_groups(WrComposite *composite, int first)
{
    for (int i = first; i < composite->groups.count; i++)
        drop_stages(&composite->groups.data[i], 0);
    if (composite->groups.count > first) composite->groups.count = first;
}

void wr_composite_free(WrComposite *composite)
{
    if (!composite) return;
    drop_stages(&composite->top, 0);
    drop_groups(composite, 0);
    wr_array_free(&composite->groups);
    wr_field_free(composite->one);
    wr_below_free(composite->below);
    wr_mutex_fini(&composite->lock);
    wr_free(composite);
}

static Stage *stage_at(Chain *chain, int index)
{
    if (index == chain->stages.count)
        wr_array_push(&chain->stages,
                      ((Stage){ .above = wr_compositor_new(), .cover = wr_compositor_new() }));
    return &chain->stages.data[index];
}

static void note_time(const WrLayer *layer, double began, const WrField *in, const WrField *made)
{
    const size_t tiles = (size_t)wr_field_changed_tiles(in, made);
    wr_layer_time_note(wr_field_key(layer->heights), wr_clock_seconds() - began, tiles);
}

/* The filter applied to a composite. If it fails or is cancelled: the composite itself. */
static const WrField *filtered(Stage *stage, const WrLayer *layer, const WrField *in, WrPool *pool)
{
    const WrFilter *filter = &layer->filter;
    const bool same = stage->made && wr_filter_same(&stage->filter, filter);
    if (same && wr_field_key(stage->given) == wr_field_key(in)) return stage->made;
    /* progress that returns to 0 would be confusing */
    WrProgressPart quiet = { .progress = { 0 } };
    wr_progress_part(&quiet, wr_progress_here(), 0.0, 1.0);
    quiet.progress.report = NULL;
    const WrOpOptions options = { .was = same ? stage->given : NULL,
                                  .made = same ? stage->made : NULL,
                                  .pool = pool,
                                  .progress = &quiet.progress };
    WrError err;
    const double began = wr_clock_seconds();
    WrField *made = wr_op_run(filter->op, in, filter->param, &options, &err);
    if (!made && !wr_progress_stopped())
        wr_fail(&lack,
                "the filter layer '%.60s' cannot be computed (%.120s): hide it, or free memory",
                layer->name, err.text);
    if (!made) return in;
    note_time(layer, began, in, made);
    wr_field_free(stage->given);
    wr_field_free(stage->made);
    stage->filter = *filter;
    stage->given = wr_field_share(in);
    stage->made = made;
    return made;
}

/* State of one update of the composite. */
typedef struct Pass {
    WrComposite *composite;
    const WrLayer *layers;
    int solo;
    WrPool *pool;
} Pass;

/* Heights and coverage of rows; borrowed. */
typedef struct Made {
    const WrField *heights, *cover; /* cover NULL: not wanted */
    bool shown;                     /* false: no row is visible */
} Made;

/* The layers of the current stage. */
typedef struct Stack {
    Chain *chain;
    int at; /* index of the stage */
    bool partial, wants_cover;
    WR_ARRAY(WrBlendLayer) of;
    WR_ARRAY(WrBlendLayer) covers; /* empty unless wants_cover */
} Stack;

static void push(Stack *stack, WrBlendLayer layer)
{
    if (stack->partial && layer.backdrop == WR_BACKDROP_GROUND)
        layer.backdrop = WR_BACKDROP_PARTIAL;
    wr_array_push(&stack->of, layer);
}

static void push_cover(const Pass *pass, Stack *stack, WrBlendLayer layer)
{
    if (!stack->wants_cover) return;
    layer.heights = pass->composite->one;
    layer.mode = layer.mode == WR_BLEND_MIX ? WR_BLEND_MIX : WR_BLEND_REPLACE;
    layer.radius = 0.0f;
    wr_array_push(&stack->covers, layer);
}

/* Composites the layers of the current stage. like: an empty table */
static Made finish(const Pass *pass, const Stack *stack, const WrField *like)
{
    const WrBlendLayer ground = { .heights = like, .hidden = true };
    const Stage *stage = stage_at(stack->chain, stack->at);
    const WrBlendLayer *of = stack->of.count ? stack->of.data : &ground;
    const WrBlendLayer *covers = stack->covers.count ? stack->covers.data : &ground;
    const int count = stack->of.count ? stack->of.count : 1;
    const int cover_count = stack->covers.count ? stack->covers.count : 1;
    Made made = { .heights = wr_compositor_update(stage->above, of, count, pass->pool) };
    if (stack->wants_cover)
        made.cover = wr_compositor_update(stage->cover, covers, cover_count, pass->pool);
    return made;
}

static WrBlendLayer blended(const WrLayer *layer, const WrField *heights, const WrField *cover)
{
    return (WrBlendLayer){ .heights = heights,
                           .cover = cover,
                           .mask = layer->mask,
                           .mode = layer->blend,
                           .opacity = layer->opacity,
                           .radius = layer->radius };
}

/* Begins the stage above a filter with the heights below, which are omitted if the filter is shown alone, and the filter's.
   The lowest layer with mode add is its heights everywhere, with its coverage (wr_blend_tile_partial). */
static void begin_stage(const Pass *pass, Stack *stack, const WrLayer *layer, const Made *below,
                        const WrField *made)
{
    const bool alone = wr_blends[layer->blend].takes && layer->opacity >= 1.0f && !layer->mask;
    const WrBlend mode = stack->partial ? WR_BLEND_ADD : WR_BLEND_MIX;
    stack->of.count = stack->covers.count = 0;
    const WrBlendLayer first = {
        .heights = below->heights, .cover = below->cover, .mode = mode, .opacity = 1.0f
    };
    push_cover(pass, stack, first);
    if (stack->covers.count) stack->covers.data[0].mode = WR_BLEND_REPLACE;
    if (!alone || stack->partial) push(stack, first);
    if (alone && stack->partial) stack->of.data[0].heights = made;
    if (alone && stack->partial) return;
    WrBlendLayer filter = blended(layer, made, NULL);
    filter.backdrop = stack->partial ? WR_BACKDROP_FILTER : WR_BACKDROP_GROUND;
    push(stack, filter);
}

/* Frees the caches of hidden groups. */
static void drop_rows(const Pass *pass, int from, int to, int group)
{
    for (int i = from; i < to; i++)
        if (pass->layers[i].is_group) drop_stages(&pass->composite->groups.data[group++], 0);
}

static int groups_in(const WrLayer *layers, int from, int to)
{
    int count = 0;
    for (int i = from; i < to; i++) count += layers[i].is_group;
    return count;
}

static Made composite_rows(const Pass *pass, Stack stack, int from, int to, int group);

/* Pushes a layer. group: index of the first group among it and its members */
static bool push_row(const Pass *pass, Stack *stack, int first, int index, int group)
{
    const WrLayer *layer = &pass->layers[index];
    Made own = { .heights = layer->heights, .cover = layer->cover, .shown = true };
    if (layer->is_group) {
        const bool uses = wr_blends[layer->blend].uses_cover;
        Chain *chain = &pass->composite->groups.data[group + groups_in(pass->layers, first, index)];
        const Stack inner = { .chain = chain,
                              .partial = uses,
                              .wants_cover = uses || stack->wants_cover };
        own = composite_rows(pass, inner, first, index, group);
    }
    if (!own.shown) return false;
    const WrBlendLayer next = blended(layer, own.heights, own.cover);
    push(stack, next);
    push_cover(pass, stack, next);
    return true;
}

/* Composites the rows from..to - 1. The stack is empty; ownership of its arrays passes. group: index of the first group
   among the rows */
static Made composite_rows(const Pass *pass, Stack stack, int from, int to, int group)
{
    const WrLayer *layers = pass->layers;
    bool any = false;
    for (int i = from, first = from; i < to; i++) {
        const WrLayer *layer = &layers[i];
        if (layer->depth > layers[to - 1].depth) continue; /* comes with its group */
        const bool shown = (layer->visible || i == pass->solo) && layer->opacity > 0.0f;
        if (!shown) {
            drop_rows(pass, first, i + 1, group);
        } else if (!layer->filter.op) {
            any |= push_row(pass, &stack, first, i, group);
        } else {
            const Made below = finish(pass, &stack, layer->heights);
            Stage *stage = stage_at(stack.chain, ++stack.at);
            begin_stage(pass, &stack, layer, &below,
                        filtered(stage, layer, below.heights, pass->pool));
            any = true;
        }
        group += groups_in(layers, first, i + 1);
        first = i + 1;
    }
    Made made = { .shown = false };
    drop_stages(stack.chain, any || stack.chain == &pass->composite->top ? stack.at + 1 : 0);
    if (any || stack.chain == &pass->composite->top)
        made = finish(pass, &stack, layers[from].heights);
    made.shown = any;
    wr_array_free(&stack.of);
    wr_array_free(&stack.covers);
    return made;
}

static void make_room(WrComposite *composite, const WrRows *rows)
{
    const int groups = groups_in(rows->layers, rows->from, rows->to);
    drop_groups(composite, groups);
    while (composite->groups.count < groups) wr_array_push(&composite->groups, ((Chain){ 0 }));
    const WrField *like = rows->layers[rows->from].heights;
    if (composite->one && wr_field_alike(composite->one, like)) return;
    wr_field_free(composite->one);
    composite->one = wr_field_new(wr_field_width(like), wr_field_height(like),
                                  wr_field_wrap_u(like), wr_field_wrap_v(like), 1.0f, NULL);
}

/* Without groups, the layers below the last one that reads heights are not blended twice. */
static bool may_shorten(const WrComposite *composite, const WrRows *rows, int solo)
{
    return composite->below && solo < 0 && rows->from == 0 && !rows->partial &&
           groups_in(rows->layers, 0, rows->to) == 0;
}

const WrField *wr_composite_update(WrComposite *composite, const WrRows *rows, int solo,
                                   WrPool *pool, const WrField **cover)
{
    WR_ASSERT(rows->from < rows->to && rows->to - rows->from <= WR_LAYERS_MAX);
    wr_mutex_lock(&composite->lock);
    make_room(composite, rows);
    WrBelowStack slice = { .layers = rows->layers, .count = rows->to, .from = rows->from };
    if (!cover && may_shorten(composite, rows, solo))
        wr_below_begin(composite->below, rows->layers, rows->to, pool, &slice);
    const Pass pass = { composite, slice.layers, solo, pool };
    const Stack stack = { .chain = &composite->top,
                          .partial = rows->partial,
                          .wants_cover = cover || rows->partial };
    const Made made = composite_rows(&pass, stack, slice.from, slice.count, 0);
    wr_below_end(&slice);
    if (cover) *cover = made.cover;
    wr_mutex_unlock(&composite->lock);
    return made.heights;
}

WrField *wr_composite_below(WrComposite *composite, const WrRows *rows, int count, int index,
                            WrPool *pool)
{
    wr_mutex_lock(&composite->lock);
    WrField *made = wr_below_update(&composite->below, rows, count, index, pool);
    wr_mutex_unlock(&composite->lock);
    return made;
}

#include "ui/canvas/canvas_derived_map.h"
#include "ui/app/jobs/job.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"

#include <string.h>

#define BATCH 64 /* tiles computed before they are stored in the table */

/* Inputs of a map. */
typedef struct Made {
    WrField *source; /* shared; NULL: none yet */
    WrField *map;
    WrFieldMapKind kind;
    WrMapJob job; /* its field is NULL */
} Made;

typedef struct Work {
    Made made;   /* of the map's source; the map is the old one until all tiles are done */
    bool *dirty; /* [tiles] */
    int tiles_u, tiles_v;
    bool good;
} Work;

struct WrCanvasMap {
    WrJob *job;
    Made made;
    int64_t tiles;
};

static void drop_made(Made *made)
{
    wr_field_free(made->source);
    wr_field_free(made->map);
    *made = (Made){ 0 };
}

static void drop(void *arg)
{
    Work *work = arg;
    drop_made(&work->made);
    wr_free(work->dirty);
    wr_free(work);
}

/* ---- on the worker thread ------------------------------------------------------------------------ */

typedef struct Batch {
    const Work *work;
    int tile[BATCH], count;
    float texels[BATCH][WR_TILE * WR_TILE];
    bool failed[BATCH];
} Batch;

static WrMapPart part_of(const Work *work, int tile)
{
    const WrField *field = work->made.source;
    const int x = tile % work->tiles_u * WR_TILE, y = tile / work->tiles_u * WR_TILE;
    const int w = wr_field_width(field) - x, h = wr_field_height(field) - y;
    return (WrMapPart){ x, y, w < WR_TILE ? w : WR_TILE, h < WR_TILE ? h : WR_TILE, WR_TILE };
}

static void make_tile(int index, int worker, void *ctx)
{
    Batch *batch = ctx;
    const Made *made = &batch->work->made;
    const WrMapPart part = part_of(batch->work, batch->tile[index]);
    WrMapJob job = made->job;
    WrError err;
    (void)worker;
    job.ground.field = made->source;
    float *out = batch->texels[index];
    batch->failed[index] = !wr_map_make(made->kind, &job, &part, NULL, out, NULL, &err);
    if (made->kind != WR_FIELD_MAP_CURVATURE) return;
    const float wide = (float)(job.ground.cell_w / wr_field_width(made->source));
    for (int i = 0; i < WR_TILE * part.h; i++) out[i] *= wide;
}

static bool run_batch(Work *work, Batch *batch, WrPool *pool)
{
    if (!wr_pool_run(pool, batch->count, make_tile, batch)) return false;
    for (int i = 0; i < batch->count; i++) {
        const WrMapPart part = part_of(work, batch->tile[i]);
        if (batch->failed[i]) return false;
        wr_field_write(work->made.map, part.x, part.y, part.w, part.h, batch->texels[i], WR_TILE);
    }
    batch->count = 0;
    return true;
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    Work *work = arg;
    Batch *batch = wr_alloc_unset(1, sizeof *batch);
    bool good = true;
    batch->work = work;
    batch->count = 0;
    for (int i = 0; i < work->tiles_u * work->tiles_v && good; i++) {
        if (!work->dirty[i]) continue;
        batch->tile[batch->count++] = i;
        if (batch->count == BATCH) good = run_batch(work, batch, pool);
        good = good && !wr_progress_cancelled(progress);
    }
    work->good = good && run_batch(work, batch, pool);
    wr_free(batch);
}

/* ---- on the window's thread ---------------------------------------------------------------------- */

WrCanvasMap *wr_canvas_map_new(int threads, Uint32 done_event)
{
    static const WrJobKind kind = { run, drop };
    WrCanvasMap *map = wr_alloc(1, sizeof *map);
    map->job = wr_job_new(&kind, threads, done_event);
    return map;
}

void wr_canvas_map_free(WrCanvasMap *map)
{
    if (!map) return;
    wr_job_free(map->job);
    drop_made(&map->made);
    wr_free(map);
}

static bool same_job(const WrMapJob *a, const WrMapJob *b)
{
    const WrDerivatives *x = &a->ground, *y = &b->ground;
    return x->scheme == y->scheme && x->height == y->height && x->cell_w == y->cell_w &&
           x->cell_h == y->cell_h && a->directions == b->directions && a->reach == b->reach &&
           a->sigma == b->sigma && a->box == b->box && a->base == b->base;
}

/* Dirty tiles for a changed tile of the table: those with texels within `support` of it. */
typedef struct Spread {
    Work *work;
    int support, w, h;
} Spread;

/* Range of dirty tiles along one axis: first and count. The last tile may be small, so that the support reaches
   beyond it. */
static void reach(int tile, int support, int size, int tiles, int *from, int *count)
{
    const int end = (tile + 1) * WR_TILE < size ? (tile + 1) * WR_TILE : size;
    int low = tile * WR_TILE - support, high = end - 1 + support;
    if (high - low + 1 >= size) {
        *from = 0, *count = tiles;
        return;
    }
    /* in texels of the periodic axis; on a clamped one a few more tiles are harmless */
    low = (low + size) % size, high %= size;
    *from = low / WR_TILE;
    *count = high / WR_TILE - *from + 1;
    if (*count <= 0 || (*count == 1 && high < low)) *count += tiles;
    if (*count > tiles) *count = tiles;
}

static void note_change(int tx, int ty, void *ctx)
{
    const Spread *s = ctx;
    Work *work = s->work;
    int x, y, across, down;
    reach(tx, s->support, s->w, work->tiles_u, &x, &across);
    reach(ty, s->support, s->h, work->tiles_v, &y, &down);
    for (int j = 0; j < down; j++)
        for (int i = 0; i < across; i++)
            work->dirty[(y + j) % work->tiles_v * work->tiles_u + (x + i) % work->tiles_u] = true;
}

/* The work needed to update the map to this table. */
static Work *work_for(WrCanvasMap *map, const WrField *field, WrFieldMapKind kind,
                      const WrMapJob *job)
{
    const Made *old = &map->made;
    const bool follows = old->source && old->kind == kind && same_job(&old->job, job) &&
                         wr_field_alike(old->source, field);
    Work *work = wr_alloc(1, sizeof *work);
    *work = (Work){ .tiles_u = wr_field_tiles_u(field), .tiles_v = wr_field_tiles_v(field) };
    work->dirty = wr_alloc((size_t)work->tiles_u * (size_t)work->tiles_v, sizeof(bool));
    work->made = (Made){ wr_field_share(field), NULL, kind, *job };
    if (follows) {
        Spread spread = { work, wr_field_maps[kind].support(job), wr_field_width(field),
                          wr_field_height(field) };
        work->made.map = wr_field_share(old->map);
        if (wr_field_level(old->source) == wr_field_level(field)) {
            wr_field_changes(old->source, field, note_change, &spread);
            return work;
        }
    } else
        work->made.map = wr_field_new(wr_field_width(field), wr_field_height(field),
                                      wr_field_wrap_u(field), wr_field_wrap_v(field), 0, NULL);
    memset(work->dirty, true, (size_t)work->tiles_u * (size_t)work->tiles_v);
    return work;
}

static bool is_of(const Made *made, const WrField *field, WrFieldMapKind kind, const WrMapJob *job)
{
    return made->source && made->kind == kind && same_job(&made->job, job) &&
           wr_field_key(made->source) == wr_field_key(field) && wr_field_alike(made->source, field);
}

static void take(WrCanvasMap *map)
{
    Work *work = wr_job_take(map->job);
    if (!work) return;
    if (work->good) {
        drop_made(&map->made);
        map->made = work->made;
        work->made = (Made){ 0 };
        for (int i = 0; i < work->tiles_u * work->tiles_v; i++) map->tiles += work->dirty[i];
    }
    drop(work);
}

const WrField *wr_canvas_map_update(WrCanvasMap *map, const WrField *field, WrFieldMapKind kind,
                                    const WrMapJob *job)
{
    WrMapJob plain = *job;
    plain.ground.field = NULL;
    take(map);
    /* One job at a time, so that continuous painting still shows intermediate results. */
    if (!is_of(&map->made, field, kind, &plain) && !wr_job_busy(map->job, NULL, NULL))
        wr_job_start(map->job, work_for(map, field, kind, &plain));
    const bool shown =
        map->made.map && map->made.kind == kind && wr_field_alike(map->made.source, field);
    return shown ? map->made.map : NULL;
}

bool wr_canvas_map_busy(WrCanvasMap *map)
{
    return wr_job_busy(map->job, NULL, NULL);
}

int64_t wr_canvas_map_tiles(const WrCanvasMap *map)
{
    return map->tiles;
}

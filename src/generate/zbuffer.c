/* The depth buffer: lists the primitives of each tile, then draws the tiles on all threads. */
#include "generate/zbuffer.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "generate/zbuffer_tile.h"

#include <string.h>

#define TEXELS (WR_TILE * WR_TILE)
#define BATCH 64     /* tiles between two reports */
#define CHECKED 4096 /* primitives between two checks for cancellation */
#define MANY_SLOW 4
#define MANY 64    /* images in a tile from which on hidden-surface culling pays off */
#define LEVELS 512 /* height classes for sorting */

typedef struct Bin { /* of a tile */
    int64_t first, count;
} Bin;

typedef struct Box {
    double x0, y0, x1, y1; /* texels, closed */
} Box;

typedef struct Drawing {
    const WrZScene *scene;
    const WrField *like;
    int width, height, tiles_u, tiles_v;
    Bin *bins;         /* [tiles_v][tiles_u] */
    WrZEntry *entries; /* sorted by primitive within each bin; NULL during counting */
    int64_t total;     /* counted so far */
    int *busy;         /* tiles with entries */
    int busy_count;
    int first;                             /* first of the busy tiles being drawn */
    float *heights[BATCH], *covers[BATCH]; /* their texels */
    const WrProgress *progress;
} Drawing;

/* ---- bins ---- */

static Box box_of(const WrZScene *scene, int64_t index)
{
    if (index < scene->solid_count) {
        const WrZSolid *s = &scene->solids[index];
        return (Box){ s->at[0] + s->left, s->at[1] + s->top, s->at[0] + s->right,
                      s->at[1] + s->bottom };
    }
    const WrZTriangle *t = &scene->triangles[index - scene->solid_count];
    Box box = { t->x[0], t->y[0], t->x[0], t->y[0] };
    for (int k = 1; k < 3; k++) {
        box.x0 = t->x[k] < box.x0 ? t->x[k] : box.x0;
        box.x1 = t->x[k] > box.x1 ? t->x[k] : box.x1;
        box.y0 = t->y[k] < box.y0 ? t->y[k] : box.y0;
        box.y1 = t->y[k] > box.y1 ? t->y[k] : box.y1;
    }
    return box;
}

static bool is_in_reach(const WrZScene *scene, int64_t index)
{
    double sum = 0.0;
    if (index < scene->solid_count) {
        Box box = box_of(scene, index);
        return fabs(box.x0) <= WR_Z_REACH && fabs(box.x1) <= WR_Z_REACH &&
               fabs(box.y0) <= WR_Z_REACH && fabs(box.y1) <= WR_Z_REACH &&
               isfinite(scene->solids[index].at[2]);
    }
    const WrZTriangle *t = &scene->triangles[index - scene->solid_count];
    for (int k = 0; k < 3; k++) {
        if (!(fabs(t->x[k]) <= WR_Z_REACH && fabs(t->y[k]) <= WR_Z_REACH)) return false;
        sum += t->z[k];
    }
    return isfinite(sum);
}

static bool check_reach(const WrZScene *scene, int64_t index, WrError *err)
{
    if (is_in_reach(scene, index)) return true;
    bool triangle = index >= scene->solid_count;
    Box box = box_of(scene, index);
    return wr_fail(err,
                   "%s %lld reaches from %g,%g to %g,%g texels: must be finite, within %g of 0",
                   triangle ? "triangle" : "solid",
                   (long long)(triangle ? index - scene->solid_count : index) + 1, box.x0, box.y0,
                   box.x1, box.y1, WR_Z_REACH);
}

/* The images along one axis that meet the table: shifted by first, first + 1, ... whole periods. */
static int images(double low, double high, int n, WrWrap wrap, int *first)
{
    *first = 0;
    if (wrap == WR_WRAP_CLAMP) return high >= -1.0 && low <= n;
    *first = (int)ceil((-1.0 - high) / n);
    return (int)floor((n - low) / n) - *first + 1;
}

static int tile_of(double x, int tiles)
{
    double t = floor(x / WR_TILE);
    return t < 0.0 ? 0 : t > tiles - 1 ? tiles - 1 : (int)t;
}

/* Counts an image's tiles, or adds it to their lists. */
static void put_image(Drawing *d, int64_t index, const Box *box, double dx, double dy)
{
    int x0 = tile_of(box->x0 + dx - 1.0, d->tiles_u), x1 = tile_of(box->x1 + dx + 1.0, d->tiles_u);
    int y0 = tile_of(box->y0 + dy - 1.0, d->tiles_v), y1 = tile_of(box->y1 + dy + 1.0, d->tiles_v);
    d->total += (int64_t)(x1 - x0 + 1) * (y1 - y0 + 1);
    for (int y = y0; y <= y1; y++)
        for (int x = x0; x <= x1; x++) {
            Bin *bin = &d->bins[(size_t)y * (size_t)d->tiles_u + (size_t)x];
            if (d->entries) d->entries[bin->first + bin->count] = (WrZEntry){ index, dx, dy };
            bin->count++;
        }
}

/* Images of a primitive larger than the table: all of the same size, so one represents their number. */
static bool put_all(Drawing *d, WrError *err)
{
    int64_t count = d->scene->solid_count + d->scene->triangle_count;
    for (int64_t index = 0; index < count; index++) {
        if (index % CHECKED == 0 && wr_progress_cancelled(d->progress))
            return wr_fail(err, "cancelled");
        Box box = box_of(d->scene, index);
        int first_x, first_y;
        int nx = images(box.x0, box.x1, d->width, wr_field_wrap_u(d->like), &first_x);
        int ny = images(box.y0, box.y1, d->height, wr_field_wrap_v(d->like), &first_y);
        if (nx <= 0 || ny <= 0) continue;
        if ((int64_t)nx * ny + d->total > WR_Z_ENTRIES)
            return wr_fail(err,
                           "things larger than the table lie over it %lld times: must be fewer, at "
                           "most %d",
                           (long long)nx * ny, WR_Z_ENTRIES);
        for (int j = 0; j < ny; j++) {
            if (wr_progress_cancelled(d->progress)) return wr_fail(err, "cancelled");
            for (int i = 0; i < nx; i++)
                put_image(d, index, &box, (double)(first_x + i) * d->width,
                          (double)(first_y + j) * d->height);
        }
        if (d->total > WR_Z_ENTRIES)
            return wr_fail(err,
                           "all things together cover more than %d tiles of the table: must be "
                           "fewer or smaller",
                           WR_Z_ENTRIES);
    }
    return true;
}

static bool fill_bins(Drawing *d, WrError *err)
{
    size_t tiles = (size_t)d->tiles_u * (size_t)d->tiles_v;
    d->bins = wr_alloc(tiles, sizeof *d->bins);
    d->busy = wr_alloc(tiles, sizeof *d->busy);
    if (!put_all(d, err)) return false;
    int64_t total = 0;
    for (size_t i = 0; i < tiles; i++) {
        if (d->bins[i].count) d->busy[d->busy_count++] = (int)i;
        d->bins[i].first = total;
        total += d->bins[i].count;
        d->bins[i].count = 0;
    }
    d->entries = wr_try_alloc((size_t)total + 1, sizeof *d->entries, "a depth buffer's lists", err);
    d->total = 0;
    return d->entries && put_all(d, err);
}

/* ---- tiles ---- */

/* A texel shared by several solids and crossed by the rim of one: the mean over its samples. */
static double mean_depth(const WrZSheet *sheet, int at)
{
    const WrZBlock *block = &sheet->blocks.data[sheet->block[at] - 1];
    double sum = 0.0, whole = sheet->whole[at];
    int count = 0;
    bool hidden = whole > -INFINITY; /* only rims: then the mean must not be rounded */
    for (int s = 0; s < WR_Z_SAMPLES; s++) {
        double z = block->z[s] > whole ? block->z[s] : whole;
        hidden = hidden && !(block->z[s] > whole);
        if (!(z > -INFINITY)) continue;
        sum += z;
        count++;
    }
    return hidden ? whole : sum / count;
}

static double depth_at(const WrZSheet *sheet, int at)
{
    if (sheet->bodies[at] > 1 && sheet->block[at]) return mean_depth(sheet, at);
    return sheet->depth[at] > -INFINITY ? sheet->depth[at] : sheet->edge[at];
}

static double cover_at(const WrZSheet *sheet, const WrZScene *scene, int at, double z)
{
    double cover = (double)__builtin_popcount(sheet->mask[at]) / WR_Z_SAMPLES;
    if (!(scene->soft > 0.0)) return cover;
    double t = (z - scene->floor) / scene->soft;
    return t < 1.0 ? cover * (t * t * (3.0 - 2.0 * t)) : cover;
}

static void finish_tile(const Drawing *d, const WrZSheet *sheet, float *heights, float *cover)
{
    for (int y = 0; y < sheet->high; y++)
        for (int x = 0; x < sheet->wide; x++) {
            int at = y * WR_TILE + x;
            if (!sheet->mask[at]) continue;
            double z = depth_at(sheet, at), h = d->scene->offset + d->scene->scale * z;
            heights[at] = isfinite((float)h) ? (float)h : 0.0f;
            cover[at] = (float)cover_at(sheet, d->scene, at, z);
        }
}

static double top_of(const WrZTriangle *t)
{
    const double *z = t->z;
    return z[0] > z[1] ? (z[0] > z[2] ? z[0] : z[2]) : z[1] > z[2] ? z[1] : z[2];
}

/* Only the thread that started the work may report progress. */
static bool go_on(const Drawing *d, int busy, double part)
{
    if (d->progress && d->progress == wr_progress_here())
        return wr_progress_step(d->progress, (busy + part) / d->busy_count);
    return !wr_progress_cancelled(d->progress);
}

static void draw_entry(const Drawing *d, const WrZEntry *e, WrZSheet *sheet)
{
    int64_t triangle = e->index - d->scene->solid_count;
    if (triangle < 0) wr_zsheet_solid(sheet, &d->scene->solids[e->index], e->dx, e->dy);
    else wr_zsheet_triangle(sheet, &d->scene->triangles[triangle], e->dx, e->dy);
}

typedef struct Going {
    const Drawing *d;
    int busy;
} Going;

static bool tile_goes_on(const void *ctx, double part)
{
    const Going *going = ctx;
    return go_on(going->d, going->busy, part);
}

static void draw_few(const Drawing *d, int busy, const Bin *bin, WrZSheet *sheet)
{
    for (int64_t i = 0; i < bin->count; i++) {
        if (i % 64 == 0 && !go_on(d, busy, (double)i / (double)bin->count)) return;
        draw_entry(d, &d->entries[bin->first + i], sheet);
    }
}

/* Height class, the highest first. */
static int level_of(double bound, const double range[2])
{
    double part = (range[1] - bound) / (range[1] - range[0]);
    int level = part > 0.0 ? (int)(part * LEVELS) : 0;
    return level < LEVELS ? level : LEVELS - 1;
}

/* Sorts triangles roughly by their highest corners, the highest first. False: cancelled. */
static bool sort_triangles(const Drawing *d, int busy, const Bin *bin, double *tops, int32_t *order)
{
    double range[2] = { INFINITY, -INFINITY };
    int64_t starts[LEVELS + 1] = { 0 };
    for (int64_t i = 0; i < bin->count; i++) {
        if (i % CHECKED == 0 && !go_on(d, busy, 0.0)) return false;
        int64_t index = d->entries[bin->first + i].index - d->scene->solid_count;
        double z = tops[i] = top_of(&d->scene->triangles[index]);
        range[0] = z < range[0] ? z : range[0];
        range[1] = z > range[1] ? z : range[1];
    }
    for (int64_t i = 0; i < bin->count; i++) starts[level_of(tops[i], range) + 1]++;
    for (int k = 0; k < LEVELS; k++) starts[k + 1] += starts[k];
    for (int64_t i = 0; i < bin->count; i++) order[starts[level_of(tops[i], range)]++] = (int32_t)i;
    return true;
}

/* Draws the highest first, so that hidden ones can be skipped. The order changes no bit: each texel
   keeps only the greatest heights. */
static void draw_many_triangles(const Drawing *d, int busy, const Bin *bin, WrZSheet *sheet)
{
    double *tops = wr_alloc((size_t)bin->count, sizeof *tops), filled = -INFINITY;
    int32_t *order = wr_alloc((size_t)bin->count, sizeof *order);
    bool going = sort_triangles(d, busy, bin, tops, order);
    int drawn = 0;
    for (int64_t i = 0; i < bin->count && going; i++) {
        if (i % 64 == 0) going = go_on(d, busy, (double)i / (double)bin->count);
        if (!going || tops[order[i]] <= filled) continue;
        draw_entry(d, &d->entries[bin->first + order[i]], sheet);
        if (++drawn % 256 == 0) filled = wr_zsheet_filled(sheet);
    }
    wr_free(order);
    wr_free(tops);
}

/* Letters and rings are expensive per texel. */
static int many_of(const Drawing *d, const Bin *solids)
{
    if (solids->count == 0) return MANY;
    const WrZShape shape = d->scene->solids[d->entries[solids->first].index].shape;
    return shape == WR_Z_LETTERS || shape == WR_Z_TORUS ? MANY_SLOW : MANY;
}

static void draw_bin(const Drawing *d, int busy, const Bin *bin, WrZSheet *sheet)
{
    const Going going = { d, busy };
    const WrZGoOn goes_on = { tile_goes_on, &going };
    Bin solids = { bin->first, 0 };
    while (solids.count < bin->count &&
           d->entries[bin->first + solids.count].index < d->scene->solid_count)
        solids.count++;
    Bin triangles = { bin->first + solids.count, bin->count - solids.count };
    const WrZEntry *first = &d->entries[solids.first];
    if (solids.count < many_of(d, &solids)) draw_few(d, busy, &solids, sheet);
    else if (!wr_zsheet_many(sheet, d->scene, first, solids.count, &goes_on)) return;
    if (triangles.count < MANY) draw_few(d, busy, &triangles, sheet);
    else draw_many_triangles(d, busy, &triangles, sheet);
}

static int64_t squares; /* atomic */

int64_t wr_zbuffer_squares(void)
{
    return __atomic_load_n(&squares, __ATOMIC_RELAXED);
}

static void draw_tile(int index, int worker, void *ctx)
{
    (void)worker;
    Drawing *d = ctx;
    int busy = d->first + index, tile = d->busy[busy];
    if (wr_progress_cancelled(d->progress)) return;
    WrZSheet *sheet = wr_alloc(1, sizeof *sheet);
    sheet->x = tile % d->tiles_u * WR_TILE;
    sheet->y = tile / d->tiles_u * WR_TILE;
    sheet->wide = d->width - sheet->x < WR_TILE ? d->width - sheet->x : WR_TILE;
    sheet->high = d->height - sheet->y < WR_TILE ? d->height - sheet->y : WR_TILE;
    sheet->floor = d->scene->floor;
    for (int i = 0; i < TEXELS; i++) sheet->depth[i] = sheet->edge[i] = sheet->whole[i] = -INFINITY;
    if (d->scene->hidden) draw_few(d, busy, &d->bins[tile], sheet);
    else draw_bin(d, busy, &d->bins[tile], sheet);
    finish_tile(d, sheet, d->heights[index], d->covers[index]);
    __atomic_fetch_add(&squares, sheet->squares, __ATOMIC_RELAXED);
    wr_array_free(&sheet->blocks);
    wr_free(sheet);
}

/* Tiles are allocated batch by batch: for the largest tables all of them would take seconds. */
static bool run_tiles(Drawing *d, const WrGenerateJob *job, WrRelief *relief)
{
    for (d->first = 0; d->first < d->busy_count; d->first += BATCH) {
        const int left = d->busy_count - d->first, count = left < BATCH ? left : BATCH;
        if (!wr_progress_step(job->progress, (double)d->first / d->busy_count)) return false;
        for (int i = 0; i < count; i++) {
            int tx = d->busy[d->first + i] % d->tiles_u, ty = d->busy[d->first + i] / d->tiles_u;
            d->heights[i] = wr_field_tile_write(relief->heights, tx, ty);
            d->covers[i] = wr_field_tile_write(relief->cover, tx, ty);
        }
        wr_pool_run(job->pool, count, draw_tile, d);
    }
    return wr_progress_step(job->progress, 1.0);
}

static bool draw(Drawing *d, const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    WrRelief relief = { 0 };
    WrWrap wrap_u = wr_field_wrap_u(d->like), wrap_v = wr_field_wrap_v(d->like);
    relief.heights = wr_field_new(d->width, d->height, wrap_u, wrap_v, 0.0f, err);
    relief.cover = wr_field_new(d->width, d->height, wrap_u, wrap_v, 0.0f, err);
    bool good = relief.heights && relief.cover;
    if (good && !run_tiles(d, job, &relief)) good = wr_fail(err, "cancelled");
    if (good) *out = relief;
    else wr_relief_fini(&relief);
    return good;
}

bool wr_zbuffer_draw(const WrZScene *scene, const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    const WrField *like = job->like;
    for (int64_t i = 0; i < scene->solid_count + scene->triangle_count; i++) {
        if (i % CHECKED == 0 && wr_progress_cancelled(job->progress))
            return wr_fail(err, "cancelled");
        if (!check_reach(scene, i, err)) return false;
    }
    Drawing d = { .scene = scene,
                  .like = like,
                  .width = wr_field_width(like),
                  .height = wr_field_height(like),
                  .tiles_u = wr_field_tiles_u(like),
                  .tiles_v = wr_field_tiles_v(like),
                  .progress = job->progress };
    bool good = fill_bins(&d, err) && draw(&d, job, out, err);
    wr_free(d.bins);
    wr_free(d.busy);
    wr_free(d.entries);
    return good;
}

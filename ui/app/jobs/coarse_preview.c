#include "ui/app/jobs/coarse_preview.h"

#include "base/memory.h"
#include "base/pool.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"
#include "field/ops.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define SMALL_TEXELS 262144.0 /* approximate size of a small table */
#define LARGE_TEXELS 1.0e6    /* smaller tables are quick enough */

struct WrCoarse {
    int refs;         /* atomic */
    int index, step;  /* of the document's layer; reduction */
    bool is_new;      /* it is to be inserted there */
    int first, layer; /* lowest row that the small document has; index of the changed layer in it */
    int width, height; /* of the small tables */
    WrField *exact;    /* composite of the document; owned */
    WrField *before;   /* that of the small one; owned */
    WrDocument *small; /* owned */
};

int wr_coarse_step(const WrDocument *document)
{
    const WrField *like = document->layers[0].heights;
    const double texels = (double)wr_field_width(like) * wr_field_height(like);
    if (texels <= LARGE_TEXELS || document->solo >= 0) return 1;
    return (int)ceil(sqrt(texels / SMALL_TEXELS));
}

int wr_coarse_layer(const WrCoarse *coarse)
{
    return coarse->layer;
}

int wr_coarse_factor(const WrCoarse *coarse)
{
    return coarse->step;
}

/* ---- reduction ---- */

typedef struct Reduction {
    const WrField *from;
    WrField *to;
    float **tiles; /* of `to`, by index; NULL: at the level */
} Reduction;

static int nearest(int i, int small, int large)
{
    const int at = (int)(((int64_t)2 * i + 1) * large / (2 * (int64_t)small));
    return at < large ? at : large - 1;
}

/* True if any tile of the source under a tile of the result exists. */
static bool any_tile(const Reduction *r, int tx, int ty)
{
    const int w = wr_field_width(r->to), h = wr_field_height(r->to);
    const int right = tx * WR_TILE + WR_TILE < w ? tx * WR_TILE + WR_TILE : w;
    const int under = ty * WR_TILE + WR_TILE < h ? ty * WR_TILE + WR_TILE : h;
    const int i0 = nearest(tx * WR_TILE, w, wr_field_width(r->from)) / WR_TILE;
    const int i1 = nearest(right - 1, w, wr_field_width(r->from)) / WR_TILE;
    const int j0 = nearest(ty * WR_TILE, h, wr_field_height(r->from)) / WR_TILE;
    const int j1 = nearest(under - 1, h, wr_field_height(r->from)) / WR_TILE;
    for (int j = j0; j <= j1; j++)
        for (int i = i0; i <= i1; i++)
            if (wr_field_tile(r->from, i, j)) return true;
    return false;
}

static void reduce_tile(int index, int worker, void *ctx)
{
    (void)worker;
    Reduction *r = ctx;
    const int tx = index % wr_field_tiles_u(r->to), ty = index / wr_field_tiles_u(r->to);
    const int w = wr_field_width(r->to), h = wr_field_height(r->to);
    const float level = wr_field_level(r->from);
    if (!any_tile(r, tx, ty)) return;
    float *out = r->tiles[index] = wr_field_tile_make();
    for (int y = 0; y < WR_TILE; y++) {
        const int j = ty * WR_TILE + y;
        const int from_j = j < h ? nearest(j, h, wr_field_height(r->from)) : 0;
        const float *tile = NULL;
        int held = -1;
        for (int x = 0; x < WR_TILE; x++) {
            const int i = tx * WR_TILE + x;
            if (i >= w || j >= h) {
                out[y * WR_TILE + x] = level;
                continue;
            }
            const int from_i = nearest(i, w, wr_field_width(r->from));
            if (from_i / WR_TILE != held) {
                held = from_i / WR_TILE;
                tile = wr_field_tile(r->from, held, from_j / WR_TILE);
            }
            out[y * WR_TILE + x] =
                tile ? tile[from_j % WR_TILE * WR_TILE + from_i % WR_TILE] : level;
        }
    }
}

static void put_tiles(WrField *field, float **tiles)
{
    const int across = wr_field_tiles_u(field), count = across * wr_field_tiles_v(field);
    for (int k = 0; k < count; k++)
        if (tiles[k]) wr_field_tile_put(field, k % across, k / across, tiles[k]);
}

WrField *wr_coarse_reduce(const WrCoarse *coarse, const WrField *field, WrPool *pool)
{
    if (!field) return NULL;
    WrField *to = wr_field_new(coarse->width, coarse->height, wr_field_wrap_u(field),
                               wr_field_wrap_v(field), wr_field_level(field), NULL);
    const int count = wr_field_tiles_u(to) * wr_field_tiles_v(to);
    Reduction reduction = { field, to, wr_alloc((size_t)count, sizeof(float *)) };
    wr_pool_run(pool, count, reduce_tile, &reduction);
    put_tiles(to, reduction.tiles);
    wr_free(reduction.tiles);
    return to;
}

WrFilter wr_coarse_filter(const WrCoarse *coarse, const WrFilter *filter)
{
    WrFilter small = *filter;
    for (int i = 0; filter->op && filter->op->params[i].name; i++) {
        const WrOpParam *p = &filter->op->params[i];
        if (!p->unit || strcmp(p->unit, "texels") != 0 || p->points) continue;
        double value = filter->param[i] / coarse->step;
        if (p->whole) value = rint(value);
        if (value >= p->low && !(p->above && value == p->low)) small.param[i] = value;
    }
    return small;
}

/* ---- the small document ---- */

static WrLayer reduced(const WrCoarse *coarse, const WrLayer *layer, WrPool *pool)
{
    WrLayer small = { .name = wr_strdup(layer->name),
                      .heights = wr_coarse_reduce(coarse, layer->heights, pool),
                      .cover = wr_coarse_reduce(coarse, layer->cover, pool),
                      .mask = wr_coarse_reduce(coarse, layer->mask, pool),
                      .blend = layer->blend,
                      .opacity = layer->opacity,
                      .radius = layer->radius,
                      .visible = layer->visible,
                      .filter = wr_coarse_filter(coarse, &layer->filter),
                      .depth = layer->depth,
                      .is_group = layer->is_group };
    return small;
}

static bool any_shown(const WrDocument *document, int count)
{
    for (int i = 0; i < count; i++)
        if (document->layers[i].visible && document->layers[i].opacity > 0.0f) return true;
    return false;
}

/* The row of the top level that the layer is, or is in. */
static int top_row(const WrDocument *document, int index)
{
    for (int above; (above = wr_document_parent(document, index)) >= 0;) index = above;
    return index;
}

/* The composite below the small document's rows. Among groups, these begin with all rows of the group of the changed layer, or of
   the layer below a new one. A new layer on top has the number of the layers as its index. */
static WrField *begin_rows(WrCoarse *coarse, const WrDocument *document, WrPool *pool)
{
    const int index = coarse->index;
    coarse->first = index;
    coarse->layer = 1;
    if (!wr_document_groups(document))
        return index < document->layer_count ? wr_document_below(document, index, pool)
                                             : wr_field_share(coarse->exact);
    const int top = top_row(document, coarse->is_new ? index - 1 : index);
    coarse->first = wr_layers_first(document->layers, top);
    coarse->layer = 1 + index - coarse->first;
    return wr_document_below(document, top, pool);
}

/* Without groups, hidden layers above the changed one are left out. */
static void fill(WrCoarse *coarse, const WrDocument *document, WrPool *pool)
{
    WrField *below = begin_rows(coarse, document, pool);
    const bool groups = wr_document_groups(document);
    coarse->small = wr_document_new();
    wr_document_start_over(coarse->small, wr_coarse_reduce(coarse, below, pool));
    coarse->small->layers[0].visible = any_shown(document, coarse->first);
    wr_field_free(below);
    for (int i = coarse->first; i < document->layer_count; i++) {
        const WrLayer *layer = &document->layers[i];
        const int at = coarse->small->layer_count;
        if (!groups && i != coarse->index && !(layer->visible && layer->opacity > 0.0f)) continue;
        wr_document_insert(coarse->small, at, reduced(coarse, layer, pool));
        coarse->small->layers[at].depth = layer->depth; /* its group comes later */
    }
    coarse->before = wr_field_share(wr_document_composite(coarse->small, pool));
}

WrCoarse *wr_coarse_new(const WrDocument *document, int index, bool is_new, WrPool *pool)
{
    WrCoarse *coarse = wr_alloc(1, sizeof *coarse);
    const WrField *like = document->layers[0].heights;
    coarse->refs = 1;
    coarse->index = index;
    coarse->is_new = is_new;
    coarse->step = wr_coarse_step(document);
    coarse->width = (wr_field_width(like) + coarse->step - 1) / coarse->step;
    coarse->height = (wr_field_height(like) + coarse->step - 1) / coarse->step;
    coarse->exact = wr_field_share(wr_document_composite(document, pool));
    fill(coarse, document, pool);
    return coarse;
}

WrCoarse *wr_coarse_share(const WrCoarse *coarse)
{
    WrCoarse *shared = (WrCoarse *)coarse; /* the cast is for the count only */
    if (shared) __atomic_add_fetch(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_coarse_free(WrCoarse *coarse)
{
    if (!coarse || __atomic_sub_fetch(&coarse->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_document_free(coarse->small);
    wr_field_free(coarse->exact);
    wr_field_free(coarse->before);
    wr_free(coarse);
}

bool wr_coarse_fits(const WrCoarse *coarse, const WrDocument *document, int index, bool is_new,
                    WrPool *pool)
{
    return coarse && coarse->index == index && coarse->is_new == is_new && document->solo < 0 &&
           wr_field_key(coarse->exact) == wr_field_key(wr_document_composite(document, pool));
}

WrDocument *wr_coarse_begin(const WrCoarse *coarse)
{
    return wr_document_share(coarse->small);
}

/* ---- enlarging ---- */

/* Where a texel lies between two of the small table. */
typedef struct Between {
    int a, b;
    float part; /* of b */
} Between;

typedef struct Enlarging {
    const WrField *exact;
    const float *change; /* [height][width] of the small table */
    int width, height;
    Between *u, *v; /* [width], [height] of the exact table */
    float **tiles;
} Enlarging;

static Between *places(int large, int small, bool wraps)
{
    Between *places = wr_alloc((size_t)large, sizeof *places);
    for (int i = 0; i < large; i++) {
        const double at = (i + 0.5) * small / large - 0.5, whole = floor(at);
        const int a = (int)whole, b = a + 1;
        const int first = a >= 0 ? a : wraps ? small - 1 : 0;
        const int second = b < small ? b : wraps ? 0 : small - 1;
        places[i] = (Between){ first, second, (float)(at - whole) };
    }
    return places;
}

static float bounded(float x)
{
    return x > FLT_MAX ? FLT_MAX : x < -FLT_MAX ? -FLT_MAX : x;
}

static bool any_change(const Enlarging *e, const Between *u, int columns, const Between *v,
                       int rows)
{
    for (int y = 0; y < rows; y++) {
        const float *a = e->change + (size_t)v[y].a * (size_t)e->width;
        const float *b = e->change + (size_t)v[y].b * (size_t)e->width;
        for (int x = 0; x < columns; x++)
            if (a[u[x].a] != 0.0f || a[u[x].b] != 0.0f || b[u[x].a] != 0.0f || b[u[x].b] != 0.0f)
                return true;
    }
    return false;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* A tile without change remains shared. */
static void enlarge_tile(int index, int worker, void *ctx)
{
    (void)worker;
    Enlarging *e = ctx;
    const int tx = index % wr_field_tiles_u(e->exact), ty = index / wr_field_tiles_u(e->exact);
    const int columns = least(WR_TILE, wr_field_width(e->exact) - tx * WR_TILE);
    const int rows = least(WR_TILE, wr_field_height(e->exact) - ty * WR_TILE);
    const Between *u = e->u + tx * WR_TILE, *v = e->v + ty * WR_TILE;
    const float *exact = wr_field_tile(e->exact, tx, ty);
    const float level = wr_field_level(e->exact);
    if (!any_change(e, u, columns, v, rows)) return;
    float *out = e->tiles[index] = wr_field_tile_make();
    for (int k = 0; k < WR_TILE * WR_TILE; k++) out[k] = exact ? exact[k] : level;
    for (int y = 0; y < rows; y++) {
        const float *a = e->change + (size_t)v[y].a * (size_t)e->width;
        const float *b = e->change + (size_t)v[y].b * (size_t)e->width;
        for (int x = 0; x < columns;) { /* texels between the same two of the small table */
            const int i0 = u[x].a, i1 = u[x].b;
            const float left = a[i0] + v[y].part * (b[i0] - a[i0]);
            const float right = a[i1] + v[y].part * (b[i1] - a[i1]);
            for (; x < columns && u[x].a == i0 && u[x].b == i1; x++)
                out[y * WR_TILE + x] =
                    bounded(out[y * WR_TILE + x] + (left + u[x].part * (right - left)));
        }
    }
}

/* after - before, row by row. */
static float *change_of(const WrField *before, const WrField *after)
{
    const int width = wr_field_width(before), height = wr_field_height(before);
    const size_t texels = (size_t)width * (size_t)height;
    float *change = wr_alloc(texels, sizeof *change), *old = wr_alloc(texels, sizeof *old);
    wr_field_read(before, 0, 0, width, height, old, (size_t)width);
    wr_field_read(after, 0, 0, width, height, change, (size_t)width);
    /* halves of large numbers: their sums in bounds stay finite */
    for (size_t i = 0; i < texels; i++)
        change[i] = fminf(fmaxf(change[i] - old[i], -FLT_MAX / 4), FLT_MAX / 4);
    wr_free(old);
    return change;
}

WrField *wr_coarse_end(const WrCoarse *coarse, const WrDocument *changed, WrPool *pool)
{
    const WrField *exact = coarse->exact;
    const int width = wr_field_width(exact), height = wr_field_height(exact);
    const int count = wr_field_tiles_u(exact) * wr_field_tiles_v(exact);
    float *change = change_of(coarse->before, wr_document_composite(changed, pool));
    Enlarging enlarging = {
        .exact = exact,
        .change = change,
        .width = coarse->width,
        .height = coarse->height,
        .u = places(width, coarse->width, wr_field_wrap_u(exact) == WR_WRAP_PERIODIC),
        .v = places(height, coarse->height, wr_field_wrap_v(exact) == WR_WRAP_PERIODIC),
        .tiles = wr_alloc((size_t)count, sizeof(float *))
    };
    wr_pool_run(pool, count, enlarge_tile, &enlarging);
    WrField *made = wr_field_share(exact);
    put_tiles(made, enlarging.tiles);
    wr_free(enlarging.tiles);
    wr_free(enlarging.u);
    wr_free(enlarging.v);
    wr_free(change);
    return made;
}

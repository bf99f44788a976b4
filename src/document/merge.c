/* Merging of layers. */
#include "document/composite.h"

#include "base/memory.h"
#include "base/progress.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"

#include <float.h>
#include <math.h>

#define TEXELS (WR_TILE * WR_TILE)

/* The composite of `count` layers on the ground; owned by the caller. */
static WrField *composite_of(const WrLayer *layers, int count, int solo, WrPool *pool)
{
    WrComposite *composite = wr_composite_new();
    WrField *field = wr_field_share(wr_composite_update(composite, layers, count, solo, pool));
    wr_composite_free(composite);
    return field;
}

static float bounded(double x)
{
    return (float)(x > FLT_MAX ? FLT_MAX : x < -FLT_MAX ? -FLT_MAX : x);
}

/* Values of a tile that may be NULL; a NULL field is 1 everywhere. */
typedef struct Values {
    const float *tile;
    float level;
} Values;

static Values values_of(const WrField *field, int tx, int ty)
{
    if (!field) return (Values){ NULL, 1.0f };
    return (Values){ wr_field_tile(field, tx, ty), wr_field_level(field) };
}

static double value_at(const Values *values, int i)
{
    return values->tile ? values->tile[i] : values->level;
}

static double unit(double x)
{
    return x > 0.0 ? x < 1.0 ? x : 1.0 : 0.0;
}

static bool is_additive(const WrLayer *layer)
{
    if (layer->filter.op) return false;
    return layer->blend == WR_BLEND_ADD || layer->blend == WR_BLEND_SUBTRACT;
}

/* The amount that an additive layer adds at texel i of a tile. */
static double added(const WrLayer *layer, const Values *heights, const Values *mask, int i)
{
    double h = value_at(heights, i) * unit(value_at(mask, i)) * (double)layer->opacity;
    return layer->blend == WR_BLEND_SUBTRACT ? -h : h;
}

static void add_tile(const WrLayer *a, const WrLayer *b, int tx, int ty, WrField *out)
{
    Values ha = values_of(a->heights, tx, ty), ma = values_of(a->mask, tx, ty);
    Values hb = values_of(b->heights, tx, ty), mb = values_of(b->mask, tx, ty);
    if (!ha.tile && !ma.tile && !hb.tile && !mb.tile) return; /* equals out's level */
    float *texels = wr_field_tile_write(out, tx, ty);
    for (int i = 0; i < TEXELS; i++)
        texels[i] = bounded(added(a, &ha, &ma, i) + added(b, &hb, &mb, i));
}

static Values level_of(const WrField *field)
{
    return (Values){ NULL, field ? wr_field_level(field) : 1.0f };
}

static double row_part(const WrField *field, int ty)
{
    return (double)ty / wr_field_tiles_v(field);
}

/* The sum of two additive layers. */
static WrField *sum_of(const WrLayer *a, const WrLayer *b)
{
    Values ha = level_of(a->heights), ma = level_of(a->mask);
    Values hb = level_of(b->heights), mb = level_of(b->mask);
    const WrField *like = a->heights;
    WrField *out = wr_field_new(wr_field_width(like), wr_field_height(like), wr_field_wrap_u(like),
                                wr_field_wrap_v(like),
                                bounded(added(a, &ha, &ma, 0) + added(b, &hb, &mb, 0)), NULL);
    for (int ty = 0; ty < wr_field_tiles_v(like) && wr_progress_report(row_part(like, ty)); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(like); tx++) add_tile(a, b, tx, ty, out);
    return out;
}

typedef struct Change {
    const WrField *below, *with;
    WrField *out;
} Change;

/* Heights of a layer with mode add that turns `below` into `with`. */
static void change_tile(int tx, int ty, void *ctx)
{
    const Change *change = ctx;
    Values a = values_of(change->below, tx, ty), b = values_of(change->with, tx, ty);
    if (!a.tile && !b.tile) return; /* equals out's level */
    float *texels = wr_field_tile_write(change->out, tx, ty);
    for (int i = 0; i < TEXELS; i++) texels[i] = bounded(value_at(&b, i) - value_at(&a, i));
}

/* with - below, as a new field. */
static WrField *change_of(const WrField *below, const WrField *with)
{
    double level = (double)wr_field_level(with) - (double)wr_field_level(below);
    WrField *out =
        wr_field_new(wr_field_width(below), wr_field_height(below), wr_field_wrap_u(below),
                     wr_field_wrap_v(below), bounded(level), NULL);
    Change change = { below, with, out };
    for (int ty = 0; ty < wr_field_tiles_v(below) && !wr_progress_stopped(); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(below); tx++)
            if (level != 0.0 || wr_field_tile(below, tx, ty) != wr_field_tile(with, tx, ty))
                change_tile(tx, ty, &change);
    return out;
}

/* The larger coverage of two layers; NULL: 1 everywhere. */
static WrField *cover_of(const WrLayer *a, const WrLayer *b)
{
    if (!a->cover || !b->cover) return NULL;
    const WrField *f = a->cover, *g = b->cover;
    float low = wr_field_level(f), other = wr_field_level(g);
    WrField *out = wr_field_new(wr_field_width(f), wr_field_height(f), wr_field_wrap_u(f),
                                wr_field_wrap_v(f), low > other ? low : other, NULL);
    for (int ty = 0; ty < wr_field_tiles_v(f) && !wr_progress_stopped(); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(f); tx++) {
            Values x = values_of(f, tx, ty), y = values_of(g, tx, ty);
            if (!x.tile && !y.tile) continue;
            float *texels = wr_field_tile_write(out, tx, ty);
            for (int i = 0; i < TEXELS; i++) {
                double p = value_at(&x, i), q = value_at(&y, i);
                texels[i] = (float)(p > q ? p : q);
            }
        }
    return out;
}

WrField *wr_document_below(const WrDocument *document, int index, WrPool *pool)
{
    const WrField *like = document->layers[index].heights;
    if (index > 0) return composite_of(document->layers, index, -1, pool);
    return wr_field_new(wr_field_width(like), wr_field_height(like), wr_field_wrap_u(like),
                        wr_field_wrap_v(like), 0.0f, NULL);
}

void wr_document_merge(WrDocument *document, int index, WrPool *pool)
{
    WrLayer *layers = document->layers, *upper = &layers[index], *lower = &layers[index - 1];
    WrLayer made = { .name = wr_strdup(lower->name), .opacity = 1.0f, .visible = true };
    if (index == 1) {
        made.heights = composite_of(layers, 2, -1, pool);
    } else if (is_additive(upper) && is_additive(lower)) {
        made.heights = sum_of(upper, lower);
    } else {
        WrProgressPart part;
        const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.45);
        WrField *below = composite_of(layers, index - 1, -1, pool);
        part.from = part.to;
        part.to = 0.9;
        WrField *with = composite_of(layers, index + 1, -1, pool);
        wr_progress_set(whole);
        made.heights = change_of(below, with);
        wr_field_free(below);
        wr_field_free(with);
    }
    if (index > 1) made.cover = cover_of(upper, lower);
    bool active = document->active == index;
    bool alone = document->solo == index;
    wr_layer_fini(lower);
    *lower = made;
    wr_document_remove(document, index);
    if (active) document->active = index - 1;
    if (alone) document->solo = index - 1;
}

void wr_document_flatten(WrDocument *document, WrPool *pool)
{
    WrField *heights = composite_of(document->layers, document->layer_count, -1, pool);
    while (document->layer_count > 1) wr_document_remove(document, document->layer_count - 1);
    WrLayer *layer = &document->layers[0];
    WrLayer made = {
        .name = wr_strdup(layer->name), .heights = heights, .opacity = 1.0f, .visible = true
    };
    wr_layer_fini(layer);
    *layer = made;
    document->active = 0;
    document->solo = -1;
}

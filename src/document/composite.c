#include "document/composite.h"

#include "base/memory.h"

#include <pthread.h>

struct WrComposite {
    pthread_mutex_t lock;
    WrField *sum;      /* NULL before the first update */
    WrField **sources; /* [count] shares of the layers that `sum` was made of */
    int count;
};

WrComposite *wr_composite_new(void)
{
    WrComposite *composite = wr_alloc(1, sizeof *composite);
    pthread_mutex_init(&composite->lock, NULL);
    return composite;
}

WrComposite *wr_composite_share(const WrComposite *composite)
{
    WrComposite *from = (WrComposite *)composite; /* only to lock it */
    WrComposite *copy = wr_composite_new();
    pthread_mutex_lock(&from->lock);
    if (from->sum) {
        copy->sum = wr_field_share(from->sum);
        copy->count = from->count;
        copy->sources = wr_alloc((size_t)from->count, sizeof *copy->sources);
        for (int i = 0; i < from->count; i++) copy->sources[i] = wr_field_share(from->sources[i]);
    }
    pthread_mutex_unlock(&from->lock);
    return copy;
}

static void forget(WrComposite *composite)
{
    for (int i = 0; i < composite->count; i++) wr_field_free(composite->sources[i]);
    wr_free(composite->sources);
    wr_field_free(composite->sum);
    composite->sources = NULL;
    composite->sum = NULL;
    composite->count = 0;
}

void wr_composite_free(WrComposite *composite)
{
    if (!composite) return;
    forget(composite);
    pthread_mutex_destroy(&composite->lock);
    wr_free(composite);
}

/* Can the old sum be mended, or must it be made anew? */
static bool fits(const WrComposite *composite, const WrLayer *layers, int count)
{
    if (!composite->sum || composite->count != count) return false;
    const WrField *sum = composite->sum, *base = layers[0].field;
    if (wr_field_width(sum) != wr_field_width(base) ||
        wr_field_height(sum) != wr_field_height(base) ||
        wr_field_wrap_u(sum) != wr_field_wrap_u(base) ||
        wr_field_wrap_v(sum) != wr_field_wrap_v(base))
        return false;
    for (int i = 0; i < count; i++)
        if (wr_field_level(composite->sources[i]) != wr_field_level(layers[i].field)) return false;
    return true;
}

static float total(double sum)
{
    const double largest = 3.4028234663852886e38; /* FLT_MAX: heights stay finite */
    return (float)(sum > largest ? largest : sum < -largest ? -largest : sum);
}

typedef struct Adding {
    WrField *sum;
    WrField **layers; /* those to add now */
    int count;
} Adding;

static void add_tile(int tx, int ty, void *ctx)
{
    const Adding *adding = ctx;
    const float **tiles = wr_alloc((size_t)adding->count, sizeof *tiles);
    for (int k = 0; k < adding->count; k++) tiles[k] = wr_field_tile(adding->layers[k], tx, ty);
    float *out = wr_field_tile_write(adding->sum, tx, ty);
    for (int i = 0; i < WR_TILE * WR_TILE; i++) {
        double sum = 0.0;
        for (int k = 0; k < adding->count; k++)
            sum += tiles[k] ? tiles[k][i] : wr_field_level(adding->layers[k]);
        out[i] = total(sum);
    }
    wr_free(tiles);
}

/* A sum of nothing but levels, and shares of the layers with nothing in them, so that every tile that
 * is there counts as changed. */
static void start(WrComposite *composite, const WrLayer *layers, int count)
{
    forget(composite);
    const WrField *base = layers[0].field;
    int width = wr_field_width(base), height = wr_field_height(base);
    WrWrap wrap_u = wr_field_wrap_u(base), wrap_v = wr_field_wrap_v(base);
    double sum = 0.0;
    WrError err;
    composite->sources = wr_alloc((size_t)count, sizeof *composite->sources);
    composite->count = count;
    for (int i = 0; i < count; i++) {
        float level = wr_field_level(layers[i].field);
        sum += level;
        composite->sources[i] = wr_field_new(width, height, wrap_u, wrap_v, level, &err);
    }
    composite->sum = wr_field_new(width, height, wrap_u, wrap_v, total(sum), &err);
}

const WrField *wr_composite_update(WrComposite *composite, const WrLayer *layers, int count)
{
    pthread_mutex_lock(&composite->lock);
    if (!fits(composite, layers, count)) start(composite, layers, count);
    for (int i = 0; i < count; i++) {
        WrField *before = composite->sources[i], *now = layers[i].field;
        if (wr_field_key(before) == wr_field_key(now)) continue;
        WrField **fresh = wr_alloc((size_t)count, sizeof *fresh);
        for (int k = 0; k < count; k++) fresh[k] = layers[k].field;
        Adding adding = { composite->sum, fresh, count };
        wr_field_changes(before, now, add_tile, &adding);
        wr_free(fresh);
        composite->sources[i] = wr_field_share(now);
        wr_field_free(before);
    }
    const WrField *sum = composite->sum;
    pthread_mutex_unlock(&composite->lock);
    return sum;
}

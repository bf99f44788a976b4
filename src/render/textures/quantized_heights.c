#include "render/textures/quantized_heights.h"

#include "base/error.h"
#include "base/kernmath.h"
#include "base/memory.h"
#include "field/field.h"

#include <math.h>

void wr_quantized_heights_drop(WrQuantizedHeights *rounded)
{
    wr_field_free(rounded->source);
    wr_field_free(rounded->field);
    *rounded = (WrQuantizedHeights){ 0 };
}

typedef struct Rounding {
    WrQuantizedHeights *rounded;
    const WrField *source;
} Rounding;

/* Rounds to the format and back to float: half by the nearest binary16, integers by their code over low .. high. */
static float round_height(const WrQuantizedHeights *r, float f)
{
    if (r->format == WR_HEIGHTS_HALF) return wr_round_half(f);
    const double most = r->format == WR_HEIGHTS_16 ? 65535.0 : 255.0;
    const double span = (double)r->high - (double)r->low;
    if (!(span > 0.0)) return f;
    double code = rint(((double)f - (double)r->low) / span * most);
    code = code < 0.0 ? 0.0 : code > most ? most : code;
    return (float)((double)r->low + code * span / most);
}

static void round_tile(int tx, int ty, void *ctx)
{
    Rounding *job = ctx;
    const float *in = wr_field_tile(job->source, tx, ty);
    const float level = wr_field_level(job->source);
    float *out = wr_field_tile_write(job->rounded->field, tx, ty);
    for (int i = 0; i < WR_TILE * WR_TILE; i++)
        out[i] = round_height(job->rounded, in ? in[i] : level);
}

static bool same_layout(const WrField *a, const WrField *b)
{
    return a && wr_field_width(a) == wr_field_width(b) &&
           wr_field_height(a) == wr_field_height(b) && wr_field_wrap_u(a) == wr_field_wrap_u(b) &&
           wr_field_wrap_v(a) == wr_field_wrap_v(b);
}

const WrField *wr_quantized_heights_update(WrQuantizedHeights *rounded, const WrField *field,
                                           WrHeights format, float low, float high, WrError *err)
{
    if (format == WR_HEIGHTS_DOUBLE || format == WR_HEIGHTS_FLOAT) {
        wr_quantized_heights_drop(rounded);
        return field;
    }
    Rounding job = { rounded, field };
    const bool ranged = format != WR_HEIGHTS_HALF;
    if (same_layout(rounded->source, field) && rounded->format == format &&
        (!ranged || (rounded->low == low && rounded->high == high)) &&
        wr_field_level(rounded->source) == wr_field_level(field)) {
        wr_field_changes(rounded->source, field, round_tile, &job);
    } else {
        wr_quantized_heights_drop(rounded);
        rounded->format = format;
        rounded->low = low, rounded->high = high;
        rounded->field =
            wr_field_new(wr_field_width(field), wr_field_height(field), wr_field_wrap_u(field),
                         wr_field_wrap_v(field), round_height(rounded, wr_field_level(field)), err);
        if (!rounded->field) return NULL;
        for (int ty = 0; ty < wr_field_tiles_v(field); ty++)
            for (int tx = 0; tx < wr_field_tiles_u(field); tx++)
                if (wr_field_tile(field, tx, ty)) round_tile(tx, ty, &job);
    }
    wr_field_free(rounded->source);
    rounded->source = wr_field_share(field);
    return rounded->field;
}

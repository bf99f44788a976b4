/* Range of greys for other programs, and whether they would blend the document's layers to our composite
   (ora_show.h). */
#include "base/error.h"
#include "base/memory.h"
#include "document/document.h"
#include "document/ora_show.h"
#include "field/field.h"

#define BAND 16 /* rows that are read at a time */

static void widen(WrOraRange *range, const WrField *field)
{
    float low, high;
    wr_field_range(field, &low, &high);
    range->low = low < range->low ? low : range->low;
    range->high = high > range->high ? high : range->high;
}

WrOraRange wr_ora_range(const WrDocument *document)
{
    WrOraRange range = { .low = 0.0f, .high = 1.0f };
    widen(&range, wr_document_field(document));
    for (int i = 0; i < document->layer_count; i++) widen(&range, document->layers[i].heights);
    return range;
}

/* True if all of it is <= 0, or all >= 1; NULL is 1. */
static bool is_whole(const WrField *field)
{
    if (!field) return true;
    const int width = wr_field_width(field), height = wr_field_height(field);
    const size_t row = (size_t)width;
    float *values = wr_alloc_unset(BAND * row, sizeof *values);
    bool whole = true;
    for (int y = 0; y < height && whole; y += BAND) {
        const int rows = height - y < BAND ? height - y : BAND;
        wr_field_read(field, 0, y, width, rows, values, row);
        for (size_t i = 0; i < (size_t)rows * row; i++)
            whole = whole && (values[i] <= 0.0f || values[i] >= 1.0f);
    }
    wr_free(values);
    return whole;
}

static bool is_within(const WrField *heights, float least, float most)
{
    float low, high;
    wr_field_range(heights, &low, &high);
    return low >= least && high <= most;
}

/* Programs that blend in linear light get a different mean of two greys, and a different sum. Equal on both
   scales are the maximum, the minimum, a choice of one, and, since the scale is a power, the product. A factor
   is no grey, so black must be height 0 and the factor 0..1. */
static bool layer_agrees(const WrLayer *layer, const WrOraRange *range)
{
    if (layer->opacity <= 0.0f) return true;
    if (layer->filter.op || layer->opacity < 1.0f || !is_whole(layer->mask)) return false;
    if (wr_blends[layer->blend].uses_cover && !is_whole(layer->cover)) return false;
    switch (layer->blend) {
    case WR_BLEND_MAX:
    case WR_BLEND_MIN:
    case WR_BLEND_REPLACE:
    case WR_BLEND_MIX: return true;
    case WR_BLEND_SMOOTH_MAX:
    case WR_BLEND_SMOOTH_MIN: return !(layer->radius > 0.0f);
    case WR_BLEND_MULTIPLY: return range->low == 0.0f && is_within(layer->heights, 0.0f, 1.0f);
    case WR_BLEND_ADD:
    case WR_BLEND_SUBTRACT: return is_within(layer->heights, 0.0f, 0.0f);
    case WR_BLEND_COUNT: break;
    }
    return false;
}

bool wr_ora_agrees(const WrDocument *document, int lowest, const WrOraRange *range)
{
    for (int i = lowest < 0 ? document->layer_count : lowest + 1; i < document->layer_count; i++)
        if (wr_document_shows(document, i) && !layer_agrees(&document->layers[i], range))
            return false;
    return true;
}

/* Masks of layers: from the selection, heights or slopes; filled; inverted. */
#include "command/layer_mask.h"

#include "base/error.h"
#include "base/enum_rows.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"
#include "scene/scene.h"

#include <math.h>

#define SOURCES(X)                                                                                 \
    X(FROM_SELECTION, "selection")                                                                 \
    X(FROM_NONE, "none")                                                                           \
    X(FROM_WHITE, "white")                                                                         \
    X(FROM_BLACK, "black")                                                                         \
    X(FROM_HEIGHT, "height")                                                                       \
    X(FROM_SLOPE, "slope")                                                                         \
    X(FROM_INVERSE, "inverse")
enum { SOURCES(WR_WORD_ID) };
const char *const wr_mask_sources[] = { SOURCES(WR_WORD) NULL };

static double number(const WrCall *call, const char *name, double otherwise)
{
    return wr_call_given(call, name) ? wr_call_number(call, name) : otherwise;
}

static WrField *flat(const WrField *like, float level)
{
    return wr_field_new(wr_field_width(like), wr_field_height(like), wr_field_wrap_u(like),
                        wr_field_wrap_v(like), level, NULL);
}

static WrField *of_height(WrSession *session, const WrCall *call, WrError *err)
{
    if (!wr_call_given(call, "low") && !wr_call_given(call, "high")) {
        wr_fail(err, "from=height needs low= or high=, the ends of a range of heights");
        return NULL;
    }
    const WrField *f = wr_document_composite(session->state.document, session->options.pool);
    return wr_select_height(f, number(call, "low", -WR_BIG_HEIGHT),
                            number(call, "high", WR_BIG_HEIGHT), number(call, "soft", 0.0),
                            session->options.pool, err);
}

/* Mask by slope, with the scene's height scale unless the line sets one, as in `select slope`. */
static WrField *of_slope(WrSession *session, const WrCall *call, WrError *err)
{
    const WrDocument *document = session->state.document;
    const WrField *f = wr_document_composite(document, session->options.pool);
    return wr_select_slope(f, fabs(document->scene->height) * wr_field_width(f),
                           number(call, "low", 0.0), number(call, "high", 90.0),
                           number(call, "soft", 0.0), session->options.pool, err);
}

static WrField *inverse(const WrLayer *layer, int index, WrError *err)
{
    if (layer->mask) return wr_select_invert(layer->mask);
    wr_fail(err, "from=inverse: layer %d has no mask that could be turned over", index + 1);
    return NULL;
}

static bool check_range(const WrCall *call, int from, WrError *err)
{
    static const char *const names[] = { "low", "high", "soft" };
    for (int i = 0; i < 3 && from != FROM_HEIGHT && from != FROM_SLOPE; i++)
        if (wr_call_given(call, names[i]))
            return wr_fail(err, "%s= belongs to from=height and from=slope, not to from=%s",
                           names[i], wr_mask_sources[from]);
    return true;
}

bool wr_layer_mask_make(WrSession *session, const WrCall *call, int index, WrError *err)
{
    const WrDocument *document = session->state.document;
    WrLayer *layer = &document->layers[index];
    WrField *mask = NULL;
    const int from = wr_call_choice(call, "from");
    if (!check_range(call, from, err)) return false;
    if (from == FROM_SELECTION && !document->selection)
        return wr_fail(err, "from=selection: nothing is selected");
    if (from == FROM_SELECTION) mask = wr_field_share(document->selection);
    if (from == FROM_WHITE || from == FROM_BLACK)
        mask = flat(layer->heights, from == FROM_WHITE ? 1.0f : 0.0f);
    if (from == FROM_HEIGHT) mask = of_height(session, call, err);
    if (from == FROM_SLOPE) mask = of_slope(session, call, err);
    if (from == FROM_INVERSE) mask = inverse(layer, index, err);
    if (!mask && from != FROM_NONE) return false;
    wr_field_free(layer->mask);
    layer->mask = mask;
    layer->on_mask = layer->on_mask && mask;
    return true;
}

/* The command layer: layers, their masks, and pictures pasted as layers. */
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/linked_copies.h"
#include "command/live_masks.h"
#include "command/session_internal.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "field/select.h"
#include "generate/generator.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

extern const char *const wr_mask_sources[];

#define WR_MASK_ARGS                                                                               \
    { .name = "from",                                                                              \
      .type = WR_ARG_CHOICE,                                                                       \
      .words = wr_mask_sources,                                                                    \
      .help = "content of the mask: the selection; no mask; a mask that shows all or nothing; a "  \
              "range of the composite's height or slope; the inverse of the present mask" },       \
        { .name = "low",                                                                           \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .help = "for height and slope: lower end of the range, a height or degrees" },           \
        { .name = "high",                                                                          \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .help = "upper end of the range" },                                                      \
        { .name = "soft",                                                                          \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_BIG_HEIGHT,                                                                   \
          .help = "width of the fade beyond both ends; left out, no fade" },                       \
    {                                                                                              \
        .name = "live", .type = WR_ARG_TEXT, .shape = "\"KIND NAME=VALUE ...; ...\"",              \
        .check = wr_check_mask_line, .choice = wr_mask_kind, .explain = wr_mask_kind_explain,      \
        .help = "instead of from=: terms of a live mask, which is updated when the layers below "  \
                "change; off makes it a plain mask. Kinds of terms"                                \
    }

#define WR_PASTE_ARGS                                                                              \
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "a file that `copy` wrote, or any picture" },    \
        { .name = "at",                                                                            \
          .type = WR_ARG_TUPLE,                                                                    \
          .components = 2,                                                                         \
          .low = -1e6,                                                                             \
          .high = 1e6,                                                                             \
          .shape = "u,v",                                                                          \
          .help = "position of its centre; left out, the centre of the table" },                   \
        { .name = "size",                                                                          \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_FIELD_MAX,                                                                    \
          .unit = "texels",                                                                        \
          .help = "width; left out, one texel per pixel" },                                        \
    {                                                                                              \
        .name = "sha256", .type = WR_ARG_SHA256,                                                   \
        .help = "SHA-256 of the file; a file with other content is an error"                       \
    }

/* ---- Masks of layers: from the selection, heights or slopes; filled; inverted ---- */

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
    wr_fail(err, "from=inverse: layer %d has no mask to invert", index + 1);
    return NULL;
}

static bool check_range(const WrCall *call, int from, WrError *err)
{
    static const char *const names[] = { "low", "high", "soft" };
    for (int i = 0; i < 3 && from != FROM_HEIGHT && from != FROM_SLOPE; i++)
        if (wr_call_given(call, names[i]) && from < 0)
            return wr_fail(err,
                           "%s= belongs to from=height and from=slope, or into live=", names[i]);
        else if (wr_call_given(call, names[i]))
            return wr_fail(err, "%s= belongs to from=height and from=slope, not to from=%s",
                           names[i], wr_mask_sources[from]);
    return true;
}

/* Set or remove the mask of layer `index`, as the line states. */
static bool layer_mask_make(WrSession *session, const WrCall *call, int index, WrError *err)
{
    const WrDocument *document = session->state.document;
    WrLayer *layer = &document->layers[index];
    WrField *mask = NULL;
    const int from = wr_call_choice(call, "from");
    if (wr_call_given(call, "live") == wr_call_given(call, "from"))
        return wr_fail(err, "give either from= or live=");
    if (!check_range(call, from, err)) return false;
    if (wr_call_given(call, "live"))
        return wr_session_set_live_mask(session, index, wr_call_arg(call, "live")->text, err);
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
    wr_layer_set_mask_line(layer, NULL, layer->mask_read);
    return true;
}

/* ---- pasted pictures ---- */

static void note(void *ctx, const char *text)
{
    wr_session_note(ctx, "%s", text);
}

/* Run the picture generator with the line's values. */
static bool make(WrSession *session, const WrCall *call, const char *path, WrRelief *out,
                 WrError *err)
{
    const WrGenerator *generator = wr_generator_find("picture", "paste");
    WrParamValue values[WR_GENERATOR_PARAMS];
    wr_generator_defaults(generator, values);
    values[wr_generator_param_find(generator, "file")].text = path;
    if (wr_call_given(call, "at"))
        memcpy(values[wr_generator_param_find(generator, "at")].number,
               wr_call_arg(call, "at")->numbers, 2 * sizeof(double));
    if (wr_call_given(call, "size"))
        values[wr_generator_param_find(generator, "size")].number[0] = wr_call_number(call, "size");
    const WrGenerateJob job = { .like = session->state.document->layers[0].heights,
                                .pool = session->options.pool,
                                .progress = wr_progress_here(),
                                .note = note,
                                .note_ctx = session };
    return wr_generator_make(generator, values, &job, out, err);
}

/* Insert a layer above the active one. It holds the picture of the line's FILE; its coverage is the picture's alpha.
   Makes it the active layer and clears the selection. On failure the document is unchanged. layer: a new layer
   without texels; ownership passes to the function. */
static bool wr_layer_paste(WrSession *session, WrCall *call, WrLayer layer, WrError *err)
{
    WrDocument *document = session->state.document;
    WrRelief relief = { NULL, NULL };
    char *path = wr_session_input_path(session, wr_call_arg(call, "FILE")->text);
    const bool good =
        wr_session_check_sha256(call, path, err) && make(session, call, path, &relief, err);
    wr_free(path);
    if (!good) {
        wr_layer_fini(&layer);
        return false;
    }
    wr_field_free(layer.heights);
    wr_field_free(layer.cover);
    layer.heights = relief.heights;
    layer.cover = relief.cover;
    layer.blend = WR_BLEND_REPLACE;
    wr_document_insert(document, document->active + 1, layer);
    document->active++;
    wr_field_free(document->selection);
    document->selection = NULL;
    return true;
}

/* ---- The command layer: layers and their masks ---- */

typedef bool LayerHandler(WrSession *session, WrCall *call, WrError *err);

/* Layer of argument N; the active one if N is optional and missing. */
static bool find(const WrSession *session, const WrCall *call, const char *name, int *index,
                 WrError *err)
{
    const WrArg *arg = wr_call_arg(call, name);
    *index = session->state.document->active;
    return !arg->given || wr_session_find_layer(session, arg->text, index, err);
}

/* Layers of an argument, the lowest first; the active one if it is optional and missing. */
static bool find_all(const WrSession *session, const WrCall *call, const char *name,
                     WrLayerList *layers, WrError *err)
{
    const WrArg *arg = wr_call_arg(call, name);
    if (arg->given) return wr_layers_find(session->state.document, arg->text, layers, err);
    *layers = (WrLayerList){ .index = { session->state.document->active }, .count = 1 };
    return true;
}

/* Only those of the layers that are not in another one of them, with which they change. */
static void keep_outermost(const WrDocument *document, WrLayerList *layers)
{
    int count = 0;
    for (int i = 0; i < layers->count; i++) {
        bool inside = false;
        for (int k = i + 1; k < layers->count && !inside; k++)
            inside = wr_document_is_within(document, layers->index[i], layers->index[k]);
        if (!inside) layers->index[count++] = layers->index[i];
    }
    layers->count = count;
}

/* Rows of a layer with its members. */
static int rows_of(const WrDocument *document, int index)
{
    return index + 1 - wr_layers_first(document->layers, index);
}

static int rows_of_all(const WrDocument *document, const WrLayerList *layers)
{
    int rows = 0;
    for (int i = 0; i < layers->count; i++) rows += rows_of(document, layers->index[i]);
    return rows;
}

/* The layers, which move and vanish with their members. */
static bool find_outermost(const WrSession *session, const WrCall *call, WrLayerList *layers,
                           WrError *err)
{
    if (!find_all(session, call, "N", layers, err)) return false;
    keep_outermost(session->state.document, layers);
    return true;
}

/* The layer with its members. */
static bool check_all_unlocked(const WrSession *session, int index, WrError *err)
{
    for (int i = wr_layers_first(session->state.document->layers, index); i <= index; i++)
        if (!wr_session_check_unlocked(session, i, err)) return false;
    return true;
}

static bool find_unlocked(const WrSession *session, const WrCall *call, WrLayerList *layers,
                          WrError *err)
{
    if (!find_outermost(session, call, layers, err)) return false;
    for (int i = 0; i < layers->count; i++)
        if (!check_all_unlocked(session, layers->index[i], err)) return false;
    return true;
}

/* The group of argument `in`; -1: none is given, or "none". */
static bool find_group(const WrSession *session, const WrCall *call, int *group, WrError *err)
{
    const char *word = wr_call_arg(call, "in")->text;
    *group = -1;
    if (!word || strcmp(word, "none") == 0) return true;
    if (!wr_session_find_layer(session, word, group, err)) return false;
    if (session->state.document->layers[*group].is_group) return true;
    WrText name = { 0 };
    wr_fail(err, "%s is not a group: `layer group` makes one",
            wr_session_layer_name(session, *group, &name));
    wr_text_fini(&name);
    return false;
}

static bool check_room(const WrDocument *document, int rows, WrError *err)
{
    if (document->layer_count + rows <= WR_LAYERS_MAX) return true;
    return wr_fail(err, "a document has up to %d layers", WR_LAYERS_MAX);
}

/* ---- making and removing ---- */

/* "layer 3": a name with the first free number, starting at the count. */
static void free_name(const WrDocument *document, WrText *text)
{
    int number = document->layer_count + 1;
    do {
        wr_text_clear(text);
        wr_text_addf(text, "layer %d", number++);
    } while (wr_layer_named(document, wr_text_get(text)) >= 0);
}

static void take_settings(const WrCall *call, WrLayer *layer)
{
    if (wr_call_given(call, "blend")) layer->blend = (WrBlend)wr_call_choice(call, "blend");
    if (wr_call_given(call, "opacity")) layer->opacity = (float)wr_call_number(call, "opacity");
    if (wr_call_given(call, "radius")) layer->radius = (float)wr_call_number(call, "radius");
}

/* Apply the settings of a call. A generator layer is generated again if its content depends on the new blend mode. */
static bool settle(WrSession *session, const WrCall *call, int index, WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    const bool weighed = wr_blends[layer->blend].uses_cover;
    take_settings(call, layer);
    return !layer->line || wr_blends[layer->blend].uses_cover == weighed ||
           wr_session_generate_again(session, index, err);
}

static bool layer_add(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    const char *name = wr_call_arg(call, "NAME")->text;
    int below, group;
    WrText made = { 0 };
    if (!check_room(document, 1, err) || !find(session, call, "above", &below, err) ||
        !find_group(session, call, &group, err))
        return false;
    if (wr_call_given(call, "in") && wr_call_given(call, "above"))
        return wr_fail(err, "give above= or in=, not both: to place it in a group, use above= with "
                            "a layer of that group");
    if (wr_call_given(call, "in")) below = group < 0 ? document->layer_count - 1 : group - 1;
    free_name(document, &made);
    WrLayer layer = wr_layer_make(name ? name : wr_text_get(&made), document->layers[0].heights);
    wr_text_fini(&made);
    if (group >= 0) layer.depth = WR_DEPTH_MAX; /* the deepest possible there: in the group */
    bool good = true;
    int index = below + 1;
    if (wr_call_given(call, "from"))
        good = wr_session_add_generator_layer(session, call, &index, layer, err);
    else wr_document_insert(document, index, layer);
    if (good) document->active = index;
    return good && settle(session, call, index, err);
}

static bool layer_delete(WrSession *session, WrCall *call, WrError *err)
{
    const WrDocument *document = session->state.document;
    WrLayerList layers;
    if (!find_unlocked(session, call, &layers, err)) return false;
    if (rows_of_all(document, &layers) == document->layer_count)
        return wr_fail(err, "the last layer stays: a document has at least one");
    for (int i = layers.count - 1; i >= 0; i--)
        wr_document_remove(session->state.document, layers.index[i]);
    return true;
}

/* "NAME copy", cut to WR_LAYER_NAME_MAX bytes at a character boundary. */
static char *copy_name(const char *name)
{
    static const char ending[] = " copy";
    size_t length = strlen(name), most = WR_LAYER_NAME_MAX - (sizeof ending - 1);
    if (length > most) {
        length = most;
        while (length > 0 && ((unsigned char)name[length] & 0xC0) == 0x80) length--;
    }
    WrText text = { 0 };
    wr_text_add_n(&text, name, length);
    wr_text_add(&text, ending);
    return text.data;
}

/* Inserts a copy of a layer and its members above row place - 1, that much deeper. index < place. */
static void copy_layer(WrDocument *document, int index, int place, int deeper)
{
    for (int i = index; i >= wr_layers_first(document->layers, index); i--) {
        WrLayer layer = wr_layer_share(&document->layers[i]);
        layer.depth += deeper;
        if (i == index) {
            wr_free(layer.name);
            layer.name = copy_name(document->layers[index].name);
            layer.locked = false;
        }
        wr_document_insert(document, place, layer);
    }
}

/* Inserts a linked copy of a layer above row place - 1. index < place. */
static bool link_layer(WrSession *session, int index, int place, int depth, WrError *err)
{
    WrDocument *document = session->state.document;
    const WrLayer *source = &document->layers[index];
    if (source->filter.op)
        return wr_fail(err, "linked=on: layer %d is a filter layer, which has no heights to copy",
                       index + 1);
    WrLayer layer = wr_layer_share(source);
    wr_free(layer.name);
    layer.name = copy_name(source->name);
    layer.locked = false;
    layer.depth = depth;
    layer.is_group = layer.collapsed = false;
    wr_layer_link(&layer, source->name);
    wr_document_insert(document, place, layer);
    return wr_session_generate_again(session, place, err);
}

/* The copies go above the highest of the layers, in their order; the active layer's copy, else the highest, becomes
   active. */
static bool layer_duplicate(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrLayerList layers;
    if (!find_outermost(session, call, &layers, err)) return false;
    const bool linked = wr_call_choice(call, "linked") == 1;
    const int top = layers.index[layers.count - 1], depth = document->layers[top].depth;
    const int rows = linked ? layers.count : rows_of_all(document, &layers);
    const int was_active = document->active;
    if (!check_room(document, rows, err)) return false;
    int active = top + rows, place = top + rows;
    for (int i = layers.count - 1; i >= 0; i--) {
        const int index = layers.index[i];
        if (!linked && depth + wr_document_height(document, index) > WR_DEPTH_MAX)
            return wr_fail(err, "up to %d groups can be nested", WR_DEPTH_MAX);
        if (index == was_active) active = place;
        place -= linked ? 1 : rows_of(document, index);
        if (!linked) copy_layer(document, index, top + 1, depth - document->layers[index].depth);
        else if (!link_layer(session, index, top + 1, depth, err)) return false;
    }
    document->active = active;
    return true;
}

/* ---- joining ---- */

static bool check_visible(const WrSession *session, int index, WrError *err)
{
    if (session->state.document->layers[index].visible) return true;
    WrText name = { 0 };
    wr_fail(err, "%s is hidden: only visible layers can be merged",
            wr_session_layer_name(session, index, &name));
    wr_text_fini(&name);
    return false;
}

/* True if the layers are neighbours. */
static bool check_neighbours(const WrDocument *document, const WrLayerList *layers, WrError *err)
{
    for (int i = 1; i < layers->count; i++) {
        const int below = layers->index[i - 1], above = layers->index[i];
        if (wr_layers_first(document->layers, above) != below + 1 ||
            document->layers[below].depth != document->layers[above].depth)
            return wr_fail(err,
                           "layers %d and %d are not neighbours: move them together, or merge the "
                           "layers between too",
                           below + 1, above + 1);
    }
    return true;
}

static void note_hidden(WrSession *session, int from, int to)
{
    int hidden = 0;
    for (int i = from; i < to; i++) hidden += !session->state.document->layers[i].visible;
    if (hidden) wr_session_note(session, "%d hidden layers were removed", hidden);
}

static bool join_group(WrSession *session, int index)
{
    WrDocument *document = session->state.document;
    note_hidden(session, wr_layers_first(document->layers, index), index);
    wr_document_rasterize_group(document, index, session->options.pool);
    return true;
}

/* The layer below in its group, which it is merged into. */
static bool add_below(const WrSession *session, WrLayerList *layers, WrError *err)
{
    const WrDocument *document = session->state.document;
    const int index = layers->index[0];
    if (index == 0) return wr_fail(err, "layer 1 has no layer below to merge with");
    if (index == wr_layers_first_sibling(document->layers, index))
        return wr_fail(err, "layer %d has no layer below it in its group to merge with", index + 1);
    *layers = (WrLayerList){ .index = { index - 1, index }, .count = 2 };
    return check_all_unlocked(session, index - 1, err);
}

/* Joins neighbours from the bottom: onto layer 1, and onto the lowest of a group, that is exact. Groups among them
   become layers first, so that each layer has one row. */
static void join_layers(WrSession *session, const WrLayerList *layers)
{
    WrDocument *document = session->state.document;
    const int low = wr_layers_first(document->layers, layers->index[0]);
    const int joints = layers->count - 1;
    for (int i = joints; i >= 0 && !wr_progress_stopped(); i--)
        if (document->layers[layers->index[i]].is_group) join_group(session, layers->index[i]);
    for (int i = 0; i < joints && !wr_progress_stopped(); i++) {
        WrProgressPart part;
        const WrProgress *whole = wr_progress_enter(&part, (double)i / joints, (i + 1.0) / joints);
        wr_document_merge(document, low + 1, session->options.pool);
        wr_progress_set(whole);
    }
    if (joints > 0) wr_session_store_in_variants(session, low);
}

/* One layer is joined with the one below, several with each other, a single group becomes a layer. */
static bool layer_merge(WrSession *session, WrCall *call, WrError *err)
{
    const WrDocument *document = session->state.document;
    WrLayerList layers;
    if (!find_unlocked(session, call, &layers, err)) return false;
    if (!wr_session_make_all_layers(session, err)) return false;
    if (layers.count == 1 && document->layers[layers.index[0]].is_group)
        return join_group(session, layers.index[0]);
    if (layers.count == 1 && !add_below(session, &layers, err)) return false;
    if (!check_neighbours(document, &layers, err)) return false;
    for (int i = layers.count - 1; i >= 0; i--)
        if (!check_visible(session, layers.index[i], err)) return false;
    join_layers(session, &layers);
    return true;
}

static bool layer_flatten(WrSession *session, WrCall *call, WrError *err)
{
    (void)call;
    WrDocument *document = session->state.document;
    for (int i = 0; i < document->layer_count; i++)
        if (!wr_session_check_unlocked(session, i, err)) return false;
    if (!wr_session_make_all_layers(session, err)) return false;
    note_hidden(session, 0, document->layer_count);
    wr_document_flatten(document, session->options.pool);
    wr_session_store_in_variants(session, 0);
    return true;
}

/* ---- settings ---- */

static bool layer_use(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    if (!find(session, call, "N", &document->active, err)) return false;
    if (!wr_call_given(call, "part")) return true;
    WrLayer *layer = &document->layers[document->active];
    bool on_mask = wr_call_choice(call, "part") == 1;
    if (on_mask && !layer->mask)
        return wr_fail(err, "part=mask: layer %d has no mask: `layer mask %d from=white` adds one",
                       document->active + 1, document->active + 1);
    layer->on_mask = on_mask;
    return true;
}

/* Lowest row of the layers, in a block, without to=: at the top of the group, or above the one that the highest of them
   leaves. */
static int place_in(const WrDocument *document, const WrLayerList *layers, int group)
{
    const int highest = layers->index[layers->count - 1];
    int place = highest;
    if (group >= 0 && !wr_document_is_within(document, highest, group)) {
        place = group;
        for (int i = 0; i < layers->count; i++)
            if (layers->index[i] < group) place -= rows_of(document, layers->index[i]);
        return place;
    }
    for (int i = highest; i != group && i >= 0; i = wr_document_parent(document, i)) place = i;
    return place + 1 - rows_of_all(document, layers);
}

/* Moves a layer to that row. in: into the group of that name, or out of all groups (NULL); else as deep as possible
   and at most as it is. number: for messages. The name is compared as a pointer. */
static bool move_layer(WrDocument *document, int from, int to, bool in, const char *name, int depth,
                       int number, WrError *err)
{
    int least, most;
    wr_document_move_depths(document, from, to, &least, &most);
    const int possible = depth < least ? least : depth > most ? most : depth;
    if (!in) depth = possible;
    if (depth + wr_document_height(document, from) > WR_DEPTH_MAX)
        return wr_fail(err, "up to %d groups can be nested", WR_DEPTH_MAX);
    wr_document_move(document, from, to, possible);
    const int into = wr_document_parent(document, to);
    if (depth == possible && (!in || (into < 0 ? NULL : document->layers[into].name) == name))
        return true;
    if (!name) return wr_fail(err, "to=%d is in a group", number);
    return wr_fail(err, "to=%d is not in that group", number);
}

/* Moves the layers, in their order, so that their lowest row becomes `place`: to the top first, then each to its
   place. */
static bool move_rows(WrDocument *document, const WrLayerList *layers, int place, bool in,
                      int group, int number, WrError *err)
{
    int depths[WR_LAYERS_MAX], rows[WR_LAYERS_MAX], moved = 0;
    const int last = document->layer_count - 1;
    const char *name = group < 0 ? NULL : document->layers[group].name;
    for (int i = 0; i < layers->count; i++) {
        const WrLayer *layer = &document->layers[layers->index[i]];
        depths[i] = !in ? layer->depth : group < 0 ? 0 : document->layers[group].depth + 1;
        rows[i] = rows_of(document, layers->index[i]);
    }
    for (int i = 0; i < layers->count; moved += rows[i++])
        wr_document_move(document, layers->index[i] - moved, last, 0);
    for (int i = 0, at = last + 1 - moved; i < layers->count; i++) {
        place += rows[i];
        at += rows[i];
        if (!move_layer(document, at - 1, place - 1, in, name, depths[i], number, err))
            return false;
    }
    return true;
}

static bool layer_move(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrLayerList layers;
    int group;
    if (!find_outermost(session, call, &layers, err) || !find_group(session, call, &group, err))
        return false;
    for (int i = 0; i < layers.count; i++)
        if (group == layers.index[i] ||
            (group >= 0 && wr_document_is_within(document, group, layers.index[i])))
            return wr_fail(err, "layer %d cannot be moved into itself", layers.index[i] + 1);
    const bool in = wr_call_given(call, "in"), to_given = wr_call_given(call, "to");
    const int rows = rows_of_all(document, &layers);
    const int members = rows_of(document, layers.index[0]) - 1; /* of the lowest */
    const int to = to_given ? (int)wr_call_number(call, "to") - 1
                            : place_in(document, &layers, group) + members;
    const int most = document->layer_count - rows + members;
    if (!in && !to_given) return wr_fail(err, "give to=, the new number, or in=, a group");
    if (to < members || to > most)
        return wr_fail(err, "to=%d: must be %d..%d", to + 1, members + 1, most + 1);
    return move_rows(document, &layers, to - members, in, group, to + 1, err);
}

/* Lines, terms of masks, variants and objects that name the layer follow. */
static void rename_layer(WrSession *session, int index, const char *name)
{
    WrDocument *document = session->state.document;
    WrLayer *layer = &document->layers[index];
    wr_session_rename_in_variants(session, index, name);
    wr_session_rename_in_masks(session, index, name);
    wr_session_rename_in_links(session, index, name);
    wr_session_rename_in_lines(session, index, name);
    WrScene *scene = wr_scene_rename_layer(document->scene, layer->name, name);
    if (scene) wr_session_replace_scene(session, scene); /* objects still use it as their table */
    wr_free(layer->name);
    layer->name = wr_strdup(name);
}

static bool layer_rename(WrSession *session, WrCall *call, WrError *err)
{
    int index;
    if (!find(session, call, "N", &index, err)) return false;
    rename_layer(session, index, wr_call_arg(call, "NAME")->text);
    return true;
}

static bool set_one(WrSession *session, WrCall *call, int index, WrError *err)
{
    if (wr_call_given(call, "collapsed") && !session->state.document->layers[index].is_group)
        return wr_fail(err, "collapsed=: layer %d is not a group", index + 1);
    const bool generates = wr_call_given(call, "change") || wr_call_given(call, "from");
    if (generates &&
        (!wr_session_check_unlocked(session, index, err) ||
         !wr_session_change_generator_layer(
             session, call, index,
             wr_call_given(call, "change") ? wr_call_arg(call, "change")->text : NULL, err)))
        return false;
    if (!settle(session, call, index, err)) return false;
    WrLayer *layer = &session->state.document->layers[index];
    if (wr_call_given(call, "visible")) layer->visible = wr_call_choice(call, "visible") == 1;
    if (wr_call_given(call, "collapsed")) layer->collapsed = wr_call_choice(call, "collapsed") == 1;
    if (wr_call_given(call, "lock")) layer->locked = wr_call_choice(call, "lock") == 1;
    if (wr_call_given(call, "name")) rename_layer(session, index, wr_call_arg(call, "name")->text);
    return true;
}

static bool layer_set(WrSession *session, WrCall *call, WrError *err)
{
    WrLayerList layers;
    bool any = false;
    for (int i = 0; i < call->count; i++) any |= call->args[i].given && !call->specs[i].positional;
    if (!any)
        return wr_fail(err,
                       "nothing to set: give name=, blend=, opacity=, radius=, visible= or lock=, "
                       "of a generator layer change= or from=, or of a group collapsed=");
    if (!find_all(session, call, "N", &layers, err)) return false;
    if (wr_call_given(call, "name") && layers.count > 1)
        return wr_fail(err, "name= is for one layer: N names %d", layers.count);
    for (int i = 0; i < layers.count; i++)
        if (!set_one(session, call, layers.index[i], err)) return false;
    return true;
}

static bool rasterize_one(WrSession *session, WrCall *call, int index, WrError *err)
{
    (void)call;
    WrLayer *layer = &session->state.document->layers[index];
    if (layer->is_group) return join_group(session, index);
    if (!layer->line)
        return wr_fail(err, "layer %d is already a plain layer: there is nothing to rasterize",
                       index + 1);
    wr_layer_set_line(layer, NULL, (WrHash){ 0, 0 });
    return true;
}

/* Run `one` for each layer of argument N, which must be unlocked; from the top, so that rows may vanish. */
static bool each_unlocked(WrSession *session, WrCall *call,
                          bool (*one)(WrSession *, WrCall *, int, WrError *), WrError *err)
{
    WrLayerList layers;
    if (!find_unlocked(session, call, &layers, err)) return false;
    for (int i = layers.count - 1; i >= 0; i--)
        if (!one(session, call, layers.index[i], err)) return false;
    return true;
}

static bool layer_rasterize(WrSession *session, WrCall *call, WrError *err)
{
    if (!wr_session_make_all_layers(session, err)) return false;
    return each_unlocked(session, call, rasterize_one, err);
}

/* ---- groups ---- */

static bool layer_group(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    const char *name = wr_call_arg(call, "NAME")->text;
    WrLayerList layers;
    if (!check_room(document, 1, err) || !find_all(session, call, "of", &layers, err)) return false;
    bool chosen[WR_LAYERS_MAX] = { false };
    for (int i = 0; i < layers.count; i++) chosen[layers.index[i]] = true;
    WrText text = { 0 };
    int number = 1;
    do {
        wr_text_clear(&text);
        wr_text_addf(&text, "group %d", number++);
    } while (!name && wr_layer_named(document, wr_text_get(&text)) >= 0);
    const bool good = wr_document_group(document, chosen, name ? name : wr_text_get(&text)) >= 0;
    wr_text_fini(&text);
    return good || wr_fail(err, "up to %d groups can be nested", WR_DEPTH_MAX);
}

static bool ungroup_one(WrSession *session, int index, WrError *err)
{
    WrDocument *document = session->state.document;
    const WrLayer *layer = &document->layers[index];
    if (!wr_session_check_unlocked(session, index, err)) return false;
    if (!layer->is_group) return wr_fail(err, "layer %d is not a group", index + 1);
    if (document->layer_count == 1)
        return wr_fail(err, "the last layer stays: a document has at least one");
    if (layer->mask || layer->opacity < 1.0f)
        wr_session_note(session, "the group's mask and opacity were removed");
    wr_document_ungroup(document, index);
    return true;
}

static bool layer_ungroup(WrSession *session, WrCall *call, WrError *err)
{
    WrLayerList layers;
    if (!find_all(session, call, "N", &layers, err)) return false;
    for (int i = layers.count - 1; i >= 0; i--)
        if (!ungroup_one(session, layers.index[i], err)) return false;
    return true;
}

static bool layer_solo(WrSession *session, WrCall *call, WrError *err)
{
    int index = -1;
    const char *word = wr_call_arg(call, "N|off")->text;
    if (strcmp(word, "off") != 0 && !wr_session_find_layer(session, word, &index, err))
        return false;
    session->state.document->solo = index;
    return true;
}

/* ---- contents ---- */

static WrField *uniform(const WrLayer *layer, float level)
{
    const WrField *f = layer->heights;
    return wr_field_new(wr_field_width(f), wr_field_height(f), wr_field_wrap_u(f),
                        wr_field_wrap_v(f), level, NULL);
}

static bool clear_one(WrSession *session, WrCall *call, int index, WrError *err)
{
    (void)call;
    WrLayer *layer = &session->state.document->layers[index];
    if (layer->filter.op)
        return wr_fail(err, "layer %d is a filter layer, which has no heights to clear", index + 1);
    if (layer->is_group)
        return wr_fail(err, "layer %d is a group, which has no heights to clear", index + 1);
    wr_session_put_field(session, &layer->heights, uniform(layer, 0.0f));
    if (layer->cover) wr_session_put_field(session, &layer->cover, uniform(layer, 0.0f));
    return true;
}

static bool layer_clear(WrSession *session, WrCall *call, WrError *err)
{
    return each_unlocked(session, call, clear_one, err);
}

static bool layer_paste(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrText name = { 0 };
    if (!check_room(document, 1, err)) return false;
    free_name(document, &name);
    const WrLayer layer = wr_layer_make(wr_text_get(&name), document->layers[0].heights);
    wr_text_fini(&name);
    return wr_layer_paste(session, call, layer, err);
}

static bool layer_mask(WrSession *session, WrCall *call, WrError *err)
{
    int index;
    return find(session, call, "N", &index, err) &&
           wr_session_check_unlocked(session, index, err) &&
           layer_mask_make(session, call, index, err);
}

enum {
    LAYER_ADD,
    LAYER_DELETE,
    LAYER_USE,
    LAYER_MOVE,
    LAYER_RENAME,
    LAYER_SET,
    LAYER_RASTERIZE,
    LAYER_DUPLICATE,
    LAYER_MERGE,
    LAYER_FLATTEN,
    LAYER_CLEAR,
    LAYER_SOLO,
    LAYER_MASK,
    LAYER_PASTE,
    LAYER_GROUP,
    LAYER_UNGROUP,
    LAYER_FORMS
};

WR_ROWS(handlers);
static LayerHandler *const handlers[] = {
    [WR_ROW(LAYER_ADD)] = layer_add,
    [WR_ROW(LAYER_DELETE)] = layer_delete,
    [WR_ROW(LAYER_USE)] = layer_use,
    [WR_ROW(LAYER_MOVE)] = layer_move,
    [WR_ROW(LAYER_RENAME)] = layer_rename,
    [WR_ROW(LAYER_SET)] = layer_set,
    [WR_ROW(LAYER_RASTERIZE)] = layer_rasterize,
    [WR_ROW(LAYER_DUPLICATE)] = layer_duplicate,
    [WR_ROW(LAYER_MERGE)] = layer_merge,
    [WR_ROW(LAYER_FLATTEN)] = layer_flatten,
    [WR_ROW(LAYER_CLEAR)] = layer_clear,
    [WR_ROW(LAYER_SOLO)] = layer_solo,
    [WR_ROW(LAYER_MASK)] = layer_mask,
    [WR_ROW(LAYER_PASTE)] = layer_paste,
    [WR_ROW(LAYER_GROUP)] = layer_group,
    [WR_ROW(LAYER_UNGROUP)] = layer_ungroup,
};
WR_ROWS_END(handlers, LAYER_FORMS);

static bool run_layer(WrSession *session, WrCall *call, WrError *err)
{
    return handlers[call->form](session, call, err);
}

static const char *blend_name(int i)
{
    return i < WR_BLEND_COUNT ? wr_blends[i].name : NULL;
}

static const char *const layer_parts[] = { "heights", "mask", NULL };

#define LAYER_N                                                                                    \
    {                                                                                              \
        PLACE("N"), .type = WR_ARG_LAYER, .help = "the layer"                                      \
    }

#define LAYERS_N                                                                                   \
    {                                                                                              \
        PLACE("N"), .type = WR_ARG_LAYER, .several = true, .help = "the layer or layers"           \
    }

#define LAYER_FROM(help_)                                                                          \
    {                                                                                              \
        .name = "from", .type = WR_ARG_TEXT, .shape = "\"COMMAND ...\"",                           \
        .check = wr_check_layer_line, .help = help_                                                \
    }

#define LAYER_SETTINGS                                                                             \
    { .name = "blend", .type = WR_ARG_CHOICE, .choice = blend_name, .help = "blend mode" },        \
        { .name = "opacity", .type = WR_ARG_NUMBER, .low = 0, .high = 1, .help = "opacity" },      \
    {                                                                                              \
        .name = "radius", .type = WR_ARG_NUMBER, .low = 0, .high = WR_BIG_HEIGHT,                  \
        .unit = "height units",                                                                    \
        .help = "for the smooth blends: height difference within which they round the crease"      \
    }

WR_ROWS(layer_forms);
static const WrForm layer_forms[] = {
    [WR_ROW(
        LAYER_ADD)] = { .name = "add",
                        .help = "add an empty layer or a generator layer, and make it active",
                        .args = { { .name = "NAME",
                                    .type = WR_ARG_NAME,
                                    .positional = true,
                                    .help = "name; left out, \"layer 2\" and so on" },
                                  LAYER_FROM("command of a generator layer, which makes its "
                                             "heights, such as \"text Hello size=60\""),
                                  LAYER_SETTINGS,
                                  { .name = "above",
                                    .type = WR_ARG_LAYER,
                                    .help = "layer below the new one; left out, the active layer" },
                                  { .name = "in",
                                    .type = WR_ARG_LAYER,
                                    .help = "group in which it becomes the topmost layer" } } },
    [WR_ROW(LAYER_DELETE)] = { .name = "delete",
                               .help = "delete layers; a group with its layers",
                               .args = { LAYERS_N } },
    [WR_ROW(LAYER_USE)] = { .name = "use",
                            .help = "make a layer the active one, which is edited",
                            .args = { LAYER_N,
                                      { .name = "part",
                                        .type = WR_ARG_CHOICE,
                                        .words = layer_parts,
                                        .help = "part that strokes, fills, generators and `adjust` "
                                                "change; left out, unchanged" } } },
    [WR_ROW(
        LAYER_MOVE)] = { .name = "move",
                         .help =
                             "move layers to another place in the stack; a group with its layers",
                         .args = { LAYERS_N,
                                   { .name = "to",
                                     .type = WR_ARG_NUMBER,
                                     .whole = true,
                                     .low = 1,
                                     .high = WR_LAYERS_MAX,
                                     .help = "new number; for several layers, that of the lowest, "
                                             "and the others follow it" },
                                   { .name = "in",
                                     .type = WR_ARG_LAYER,
                                     .shape = "N|none",
                                     .help = "group to move it into, or none; without to=, it "
                                             "becomes the topmost layer there, or is placed above "
                                             "the group that it leaves" } } },
    [WR_ROW(LAYER_RENAME)] = { .name = "rename",
                               .help = "rename a layer",
                               .args = { LAYER_N,
                                         { PLACE("NAME"), .type = WR_ARG_NAME,
                                           .help = "the new name" } } },
    [WR_ROW(
        LAYER_SET)] = { .name = "set",
                        .help = "change the settings of layers; only given arguments change",
                        .args = { LAYERS_N,
                                  LAYER_SETTINGS,
                                  { .name = "change",
                                    .type = WR_ARG_TEXT,
                                    .shape = "\"NAME=VALUE ...\"",
                                    .help = "for a generator layer: arguments of its command to "
                                            "change" },
                                  LAYER_FROM("for a generator layer: its new command"),
                                  { .name = "name",
                                    .type = WR_ARG_NAME,
                                    .help = "the new name, as for `layer rename`" },
                                  { .name = "visible",
                                    .type = WR_ARG_CHOICE,
                                    .words = wr_off_on,
                                    .help = "on: it is part of the composite" },
                                  { .name = "collapsed",
                                    .type = WR_ARG_CHOICE,
                                    .words = wr_off_on,
                                    .help =
                                        "for a group: on hides its layers in the window's list" },
                                  { .name = "lock",
                                    .type = WR_ARG_CHOICE,
                                    .words = wr_off_on,
                                    .help = "on: the layer cannot be edited" } } },
    [WR_ROW(LAYER_RASTERIZE)] = { .name = "rasterize",
                                  .help = "convert generator layers and groups to plain layers, "
                                          "which can be painted on",
                                  .args = { LAYERS_N } },
    [WR_ROW(
        LAYER_DUPLICATE)] = { .name = "duplicate",
                              .help = "copy a layer above itself, or several above the highest, "
                                      "and make the copy active",
                              .args = { LAYERS_N,
                                        { .name = "linked",
                                          .type = WR_ARG_CHOICE,
                                          .words = wr_off_on,
                                          .fallback_text = "off",
                                          .help = "on: the copy follows the layer's heights and "
                                                  "coverage; its other settings are its own" } } },
    [WR_ROW(LAYER_MERGE)] = { .name = "merge",
                              .help = "merge a layer with the one below, or several neighbours. "
                                      "The composite changes only by rounding: not at all onto "
                                      "layer 1, else by up to 2^-21 of the largest height involved",
                              .args = { LAYERS_N } },
    [WR_ROW(
        LAYER_FLATTEN)] = { .name = "flatten",
                            .help =
                                "replace all layers by their composite; hidden layers are lost" },
    [WR_ROW(LAYER_CLEAR)] = { .name = "clear",
                              .help = "set heights and coverage to 0 inside the selection",
                              .args = { { .name = "N",
                                          .type = WR_ARG_LAYER,
                                          .positional = true,
                                          .several = true,
                                          .help = "layer; left out, the active one" } } },
    [WR_ROW(LAYER_SOLO)] = { .name = "solo",
                             .help = "show one layer alone, or all again",
                             .args = { { PLACE("N|off"), .type = WR_ARG_LAYER,
                                         .help = "the layer, or off" } } },
    [WR_ROW(LAYER_MASK)] = { .name = "mask",
                             .help = "set a layer's mask",
                             .args = { LAYER_N, WR_MASK_ARGS } },
    [WR_ROW(LAYER_PASTE)] = { .name = "paste",
                              .help = "add a picture as a new layer above the active one, covering "
                                      "those below; clears the selection",
                              .args = { WR_PASTE_ARGS } },
    [WR_ROW(
        LAYER_GROUP)] = { .name = "group",
                          .help =
                              "put layers into a new group, which is active. They are composited "
                              "on their own first; the group's blend mode is that of the lowest",
                          .args = { { .name = "NAME",
                                      .type = WR_ARG_NAME,
                                      .positional = true,
                                      .help = "name; left out, \"group 1\" and so on" },
                                    { .name = "of",
                                      .type = WR_ARG_LAYER,
                                      .several = true,
                                      .help = "layers of the group; left out, the active one" } } },
    [WR_ROW(LAYER_UNGROUP)] = { .name = "ungroup",
                                .help = "remove groups and keep their layers",
                                .args = { LAYERS_N } },
};
WR_ROWS_END(layer_forms, LAYER_FORMS);

WR_FORMS(form_layer, layer_forms)

/* ---- the row ---- */

static WrCommandClass class_of(int form)
{
    return form == LAYER_USE ? WR_CLASS_CHOICE : WR_CLASS_EDIT;
}

const WrCommand wr_command_layer = {
    .name = "layer",
    .kind = WR_CLASS_EDIT,
    .class_of = class_of,
    .form_word = "ACTION",
    .form = form_layer,
    .run = run_layer,
    .help = "add, order, merge and change layers",
    .details =
        "A layer is given by its number, from 1 at the bottom, or by its name if no other layer "
        "has it; several layers by a list, such as 2,4..6. Edits change the active layer; they are "
        "refused if it is locked or hidden. A generator layer stores the command of from= and runs "
        "it again when change= changes its arguments, or when a layer changes that it reads. "
        "blend= and radius= of the command are the layer's settings.",
    .example = "layer add moss blend=max"
};

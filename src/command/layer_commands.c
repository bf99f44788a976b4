/* The command layer: layers, their masks, and pictures pasted as layers. */
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/live_masks.h"
#include "command/session_internal.h"
#include "document/blend.h"
#include "document/document.h"
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
      .help =                                                                                      \
          "what is selected, no mask, a mask that shows all or nothing, where the composite's "    \
          "height or slope lies in a range, or the present mask turned over" },                    \
        { .name = "low",                                                                           \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .help = "of height and slope: lower end, a height or degrees" },                         \
        { .name = "high",                                                                          \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .help = "upper end" },                                                                   \
        { .name = "soft",                                                                          \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_BIG_HEIGHT,                                                                   \
          .help = "over how much it fades beyond the ends; left out, not at all" },                \
    {                                                                                              \
        .name = "live", .type = WR_ARG_TEXT, .shape = "\"KIND NAME=VALUE ...; ...\"",              \
        .check = wr_check_mask_line, .choice = wr_mask_kind, .explain = wr_mask_kind_explain,      \
        .help = "instead of from=: terms that the mask keeps, and follows as the layers below "    \
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
          .help = "where its middle lies; left out, in the middle of the table" },                 \
        { .name = "size",                                                                          \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_FIELD_MAX,                                                                    \
          .unit = "texels",                                                                        \
          .help = "how wide it becomes; left out, a texel for a pixel" },                          \
    {                                                                                              \
        .name = "sha256", .type = WR_ARG_SHA256,                                                   \
        .help = "of the file: another content is then an error"                                    \
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
    wr_fail(err, "from=inverse: layer %d has no mask that could be turned over", index + 1);
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

static bool find_unlocked(const WrSession *session, const WrCall *call, int *index, WrError *err)
{
    return find(session, call, "N", index, err) && wr_session_check_unlocked(session, *index, err);
}

static bool check_room(const WrDocument *document, WrError *err)
{
    if (document->layer_count < WR_LAYERS_MAX) return true;
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
    int below;
    WrText made = { 0 };
    if (!check_room(document, err) || !find(session, call, "above", &below, err)) return false;
    free_name(document, &made);
    WrLayer layer = wr_layer_make(name ? name : wr_text_get(&made), document->layers[0].heights);
    wr_text_fini(&made);
    bool good = true;
    if (wr_call_given(call, "from"))
        good = wr_session_add_generator_layer(session, call, below + 1, layer, err);
    else wr_document_insert(document, below + 1, layer);
    if (good) document->active = below + 1;
    return good && settle(session, call, below + 1, err);
}

static bool layer_delete(WrSession *session, WrCall *call, WrError *err)
{
    int index;
    if (!find_unlocked(session, call, &index, err)) return false;
    if (session->state.document->layer_count == 1)
        return wr_fail(err, "the last layer stays: a document has at least one");
    wr_document_remove(session->state.document, index);
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

static bool layer_duplicate(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    int index;
    if (!check_room(document, err) || !find(session, call, "N", &index, err)) return false;
    WrLayer layer = wr_layer_share(&document->layers[index]);
    wr_free(layer.name);
    layer.name = copy_name(document->layers[index].name);
    layer.locked = false;
    wr_document_insert(document, index + 1, layer);
    document->active = index + 1;
    return true;
}

/* ---- joining ---- */

static bool check_visible(const WrSession *session, int index, WrError *err)
{
    if (session->state.document->layers[index].visible) return true;
    WrText name = { 0 };
    wr_fail(err, "%s is hidden: only layers that are visible can be joined",
            wr_session_layer_name(session, index, &name));
    wr_text_fini(&name);
    return false;
}

static bool layer_merge(WrSession *session, WrCall *call, WrError *err)
{
    int index;
    if (!find_unlocked(session, call, &index, err)) return false;
    if (index == 0) return wr_fail(err, "layer 1 has none below that it could be merged into");
    if (!wr_session_check_unlocked(session, index - 1, err) ||
        !check_visible(session, index, err) || !check_visible(session, index - 1, err) ||
        !wr_session_make_all_layers(session, err))
        return false;
    wr_document_merge(session->state.document, index, session->options.pool);
    return true;
}

static bool layer_flatten(WrSession *session, WrCall *call, WrError *err)
{
    (void)call;
    WrDocument *document = session->state.document;
    int hidden = 0;
    for (int i = 0; i < document->layer_count; i++) {
        if (!wr_session_check_unlocked(session, i, err)) return false;
        hidden += !document->layers[i].visible;
    }
    if (!wr_session_make_all_layers(session, err)) return false;
    if (hidden) wr_session_note(session, "%d hidden layers are gone", hidden);
    wr_document_flatten(document, session->options.pool);
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
        return wr_fail(err, "part=mask: layer %d has none: `layer mask %d from=white` makes one",
                       document->active + 1, document->active + 1);
    layer->on_mask = on_mask;
    return true;
}

static bool layer_move(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    int from;
    double to = wr_call_number(call, "to");
    if (!find(session, call, "N", &from, err)) return false;
    if (to > document->layer_count)
        return wr_fail(err, "to=%g: must be 1..%d", to, document->layer_count);
    wr_document_move(document, from, (int)to - 1);
    return true;
}

static bool layer_rename(WrSession *session, WrCall *call, WrError *err)
{
    int index;
    if (!find(session, call, "N", &index, err)) return false;
    const char *name = wr_call_arg(call, "NAME")->text;
    WrDocument *document = session->state.document;
    WrLayer *layer = &document->layers[index];
    wr_session_rename_in_masks(session, index, name);
    WrScene *scene = wr_scene_rename_layer(document->scene, layer->name, name);
    if (scene) wr_session_replace_scene(session, scene); /* objects still use it as their table */
    wr_free(layer->name);
    layer->name = wr_strdup(name);
    return true;
}

static bool layer_set(WrSession *session, WrCall *call, WrError *err)
{
    int index;
    bool any = false;
    for (int i = 0; i < call->count; i++) any |= call->args[i].given && !call->specs[i].positional;
    if (!any)
        return wr_fail(err, "nothing to set: give blend=, opacity=, radius=, visible= or lock=, or "
                            "of a generator layer change= or from=");
    if (!find(session, call, "N", &index, err)) return false;
    const bool generates = wr_call_given(call, "change") || wr_call_given(call, "from");
    if (generates && (!wr_session_check_unlocked(session, index, err) ||
                      !wr_session_change_generator_layer(session, call, index,
                                                         wr_call_arg(call, "change")->text, err)))
        return false;
    if (!settle(session, call, index, err)) return false;
    WrLayer *layer = &session->state.document->layers[index];
    if (wr_call_given(call, "visible")) layer->visible = wr_call_choice(call, "visible") == 1;
    if (wr_call_given(call, "lock")) layer->locked = wr_call_choice(call, "lock") == 1;
    return true;
}

static bool layer_rasterize(WrSession *session, WrCall *call, WrError *err)
{
    int index;
    if (!find_unlocked(session, call, &index, err)) return false;
    WrLayer *layer = &session->state.document->layers[index];
    if (!layer->line)
        return wr_fail(err, "layer %d is no generator layer: there is nothing to rasterize",
                       index + 1);
    if (!wr_session_make_all_layers(session, err)) return false;
    wr_layer_set_line(layer, NULL, (WrHash){ 0, 0 });
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

static bool layer_clear(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    int index;
    if (!find_unlocked(session, call, &index, err)) return false;
    WrLayer *layer = &document->layers[index];
    if (layer->filter.op)
        return wr_fail(err, "layer %d is a filter, without heights that could be cleared",
                       index + 1);
    wr_session_put_field(session, &layer->heights, uniform(layer, 0.0f));
    if (layer->cover) wr_session_put_field(session, &layer->cover, uniform(layer, 0.0f));
    return true;
}

static bool layer_paste(WrSession *session, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrText name = { 0 };
    if (!check_room(document, err)) return false;
    free_name(document, &name);
    const WrLayer layer = wr_layer_make(wr_text_get(&name), document->layers[0].heights);
    wr_text_fini(&name);
    return wr_layer_paste(session, call, layer, err);
}

static bool layer_mask(WrSession *session, WrCall *call, WrError *err)
{
    int index;
    return find_unlocked(session, call, &index, err) && layer_mask_make(session, call, index, err);
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

#define LAYER_FROM(help_)                                                                          \
    {                                                                                              \
        .name = "from", .type = WR_ARG_TEXT, .shape = "\"COMMAND ...\"",                           \
        .check = wr_check_layer_line, .help = help_                                                \
    }

#define LAYER_SETTINGS                                                                             \
    { .name = "blend",                                                                             \
      .type = WR_ARG_CHOICE,                                                                       \
      .choice = blend_name,                                                                        \
      .help = "how it joins the layers below" },                                                   \
        { .name = "opacity",                                                                       \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = 1,                                                                               \
          .help = "how much of it shows" },                                                        \
    {                                                                                              \
        .name = "radius", .type = WR_ARG_NUMBER, .low = 0, .high = WR_BIG_HEIGHT,                  \
        .unit = "height units", .help = "of the smooth blends: how near heights must be to melt"   \
    }

WR_ROWS(layer_forms);
static const WrForm layer_forms[] = {
    [WR_ROW(
        LAYER_ADD)] = { .name = "add",
                        .help = "a new layer, active; empty, or made by a generator",
                        .args = { { .name = "NAME",
                                    .type = WR_ARG_NAME,
                                    .positional = true,
                                    .help = "left out, \"layer 2\" and so on" },
                                  LAYER_FROM("makes it a generator layer: the command line that "
                                             "its heights come from, such as \"text Hello "
                                             "size=60\""),
                                  LAYER_SETTINGS,
                                  { .name = "above",
                                    .type = WR_ARG_LAYER,
                                    .help = "where it goes; left out, above the active one" } } },
    [WR_ROW(LAYER_DELETE)] = { .name = "delete", .help = "remove a layer", .args = { LAYER_N } },
    [WR_ROW(LAYER_USE)] = { .name = "use",
                            .help = "edits go to this layer from now on",
                            .args = { LAYER_N,
                                      { .name = "part",
                                        .type = WR_ARG_CHOICE,
                                        .words = layer_parts,
                                        .help =
                                            "what of it strokes, fills, generators and `adjust` "
                                            "change; left out, as it was" } } },
    [WR_ROW(LAYER_MOVE)] = { .name = "move",
                             .help = "bring a layer to another place in the stack",
                             .args = { LAYER_N,
                                       { .name = "to",
                                         .type = WR_ARG_NUMBER,
                                         .required = true,
                                         .whole = true,
                                         .low = 1,
                                         .high = WR_LAYERS_MAX,
                                         .help = "its new number" } } },
    [WR_ROW(LAYER_RENAME)] = { .name = "rename",
                               .help = "give a layer another name",
                               .args = { LAYER_N,
                                         { PLACE("NAME"), .type = WR_ARG_NAME,
                                           .help = "the new name" } } },
    [WR_ROW(LAYER_SET)] = { .name = "set",
                            .help = "only given arguments change",
                            .args = { LAYER_N,
                                      LAYER_SETTINGS,
                                      { .name = "change",
                                        .type = WR_ARG_TEXT,
                                        .shape = "\"NAME=VALUE ...\"",
                                        .help = "of a generator layer: values of its command line "
                                                "that change" },
                                      LAYER_FROM("of a generator layer: its new command line"),
                                      { .name = "visible",
                                        .type = WR_ARG_CHOICE,
                                        .words = wr_off_on,
                                        .help = "whether it is in the composite" },
                                      { .name = "lock",
                                        .type = WR_ARG_CHOICE,
                                        .words = wr_off_on,
                                        .help = "whether edits are refused" } } },
    [WR_ROW(LAYER_RASTERIZE)] = { .name = "rasterize",
                                  .help = "make a generator layer a plain one, which can be "
                                          "painted on",
                                  .args = { LAYER_N } },
    [WR_ROW(LAYER_DUPLICATE)] = { .name = "duplicate",
                                  .help = "a copy above it, active",
                                  .args = { LAYER_N } },
    [WR_ROW(LAYER_MERGE)] = { .name = "merge",
                              .help = "join a layer and the one below; the composite changes by "
                                      "rounding at most: not at "
                                      "all onto layer 1, else by 2^-21 of the largest height that "
                                      "meets there",
                              .args = { LAYER_N } },
    [WR_ROW(LAYER_FLATTEN)] = { .name = "flatten",
                                .help =
                                    "one layer that holds the composite; hidden layers are lost" },
    [WR_ROW(LAYER_CLEAR)] = { .name = "clear",
                              .help = "heights 0, and nothing painted, inside the selection",
                              .args = { { .name = "N",
                                          .type = WR_ARG_LAYER,
                                          .positional = true,
                                          .help = "left out, the active layer" } } },
    [WR_ROW(LAYER_SOLO)] = { .name = "solo",
                             .help = "show one layer alone, or all again",
                             .args = { { PLACE("N|off"), .type = WR_ARG_LAYER,
                                         .help = "the layer, or off" } } },
    [WR_ROW(LAYER_MASK)] = { .name = "mask",
                             .help = "how much of a layer shows, texel by texel",
                             .args = { LAYER_N, WR_MASK_ARGS } },
    [WR_ROW(LAYER_PASTE)] = { .name = "paste",
                              .help = "a picture as a new layer above the active one, which covers "
                                      "what lies below; nothing is selected then",
                              .args = { WR_PASTE_ARGS } },
};
WR_ROWS_END(layer_forms, LAYER_FORMS);

WR_FORMS(form_layer, layer_forms)

/* ---- the row ---- */

const WrCommand wr_command_layer = {
    .name = "layer",
    .kind = WR_CLASS_EDIT,
    .form_word = "ACTION",
    .form = form_layer,
    .run = run_layer,
    .help = "add, order, join and set layers",
    .details =
        "Layers are named by their numbers, from 1 at the bottom, or by their names where only "
        "one "
        "has it. Edits go to the active layer; where it is locked or not shown they are refused. A "
        "generator layer keeps the command line of from=, a generator's, and is made again when "
        "change= gives that line other values, or when the layers below change that it reads; "
        "blend= and radius= of the line are the layer's.",
    .example = "layer add moss blend=max"
};

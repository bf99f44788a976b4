/* Generator layers: layers that keep the command line that generates them. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/commands.h"
#include "command/linked_copies.h"
#include "command/session_internal.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/layer_times.h"
#include "field/field.h"
#include "generate/generator.h"
#include "image/font.h"
#include "system/clock.h"
#include "system/path.h"

#include <stdlib.h>
#include <string.h>

/* The layer's heights and coverage are those of the line, so that composites, exports and other programs need to know
   nothing of lines. The line's own blend mode and radius become the layer's: the composite then has the bits of the
   plain command run on the layers below. */

#define FONT_FILE "file" /* argument in place of an installed font */

static const WrHash nothing; /* WrLayer.below of a line that reads no heights */

/* ---- the line's settings that belong to the layer ---- */

/* The value of a choice argument as a blend mode; -1: the form has no such argument. */
static int blend_of(const WrCall *call, const char *name)
{
    for (int i = 0; i < call->count; i++)
        if (strcmp(call->specs[i].name, name) == 0 && call->args[i].choice >= 0)
            return wr_blend_find(wr_arg_word(&call->specs[i], call->args[i].choice));
    return -1;
}

static void clear(WrCall *call, const char *name)
{
    for (int i = 0; i < call->count; i++)
        if (strcmp(call->specs[i].name, name) == 0) call->args[i].given = false;
}

static const char *own_name(const WrCall *call, const char *plain)
{
    const WrGenerator *generator = wr_call_generator(call);
    return generator ? wr_generator_argument(generator, plain) : plain;
}

/* Copy blend= and radius= of the line to the layer. all: defaults too, as for a new layer. */
static void take_blend(const WrCall *call, bool all, WrLayer *layer)
{
    const char *name = own_name(call, "blend");
    const int blend = blend_of(call, name);
    if (blend >= 0 && (all || wr_call_gives(call, name)))
        /* the plain command mixes by its coverage, a layer of mode mix does not */
        layer->blend = blend == WR_BLEND_MIX ? WR_BLEND_REPLACE : (WrBlend)blend;
    if (!wr_call_generator(call)) return;
    name = own_name(call, "radius");
    if (all || wr_call_given(call, name)) layer->radius = (float)wr_call_number(call, name);
}

void wr_call_begin_layer(const WrCall *call, const WrField *selection, WrLayer *layer)
{
    const WrFamily *family = wr_family_find(call->command->name);
    if (selection && !(family && family->beyond)) layer->mask = wr_field_share(selection);
    take_blend(call, true, layer);
}

/* File names become absolute: the line is run again later, from any folder. */
static void name_files(WrCall *call, void *ctx)
{
    WrSession *session = ctx;
    for (int i = 0; i < call->count; i++) {
        if (call->specs[i].type != WR_ARG_PATH || !wr_call_names_file(call, i)) continue;
        char *path = wr_session_input_path(session, call->args[i].text);
        char *full = wr_path_real(path);
        wr_call_set_text(call, call->specs[i].name, full ? full : path);
        free(full);
        wr_free(path);
    }
}

/* ---- generating ---- */

/* Commands that paint: on an empty layer, without the selection. */
static bool by_painting(WrSession *session, int index, WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    WrField *selection = document->selection;
    const int active = document->active, solo = document->solo;
    const WrLayer kept = document->layers[index];
    document->layers[index] = wr_layer_make(kept.name, kept.heights);
    document->selection = NULL;
    document->active = index;
    document->solo = -1;
    const bool good = call->command->run(session, call, err);
    WrLayer made = document->layers[index];
    document->layers[index] = kept;
    document->selection = selection;
    document->active = active;
    document->solo = solo;
    if (good) {
        WrLayer *layer = &document->layers[index];
        WrField *heights = layer->heights, *cover = layer->cover;
        layer->heights = made.heights;
        layer->cover = made.cover;
        made.heights = heights;
        made.cover = cover;
    }
    wr_layer_fini(&made);
    return good;
}

/* ---- heights made again near changes ---- */

/* Hash of the line without the settings that belong to the layer. */
static WrHash values_hash(WrCall *call)
{
    bool given[WR_ARGS_MAX];
    WrText line = { 0 };
    for (int i = 0; i < call->count; i++) given[i] = call->args[i].given;
    clear(call, own_name(call, "blend"));
    clear(call, own_name(call, "radius"));
    wr_call_print(call, &line);
    const WrHash hash = wr_hash_bytes(wr_text_get(&line), line.length, (WrHash){ 0, 0 });
    wr_text_fini(&line);
    for (int i = 0; i < call->count; i++) call->args[i].given = given[i];
    return hash;
}

/* The inputs of a line that reads heights, for made_from.h: those heights, their coverage, and its own values. */
static WrInputs inputs_of(const WrSession *session, int index, WrCall *call, const WrField *below)
{
    const WrDocument *document = session->state.document;
    const WrArg *named = wr_call_layer_argument(call);
    WrInputs inputs = { .of = { below }, .count = 2 };
    if (named) {
        const int i = wr_document_find_below(document, index, named->text);
        if (i >= 0) inputs.of[0] = document->layers[i].heights;
        if (i >= 0) inputs.of[1] = document->layers[i].cover;
    }
    const uint64_t weighs = wr_blends[document->layers[index].blend].uses_cover;
    inputs.values = wr_hash_bytes(&weighs, sizeof weighs, values_hash(call));
    return inputs;
}

static bool by_generator(WrSession *session, int index, WrCall *call, const WrField *below,
                         WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    WrProgressPart making, laying;
    WrLayersBelow layers = { session->state.document, index };
    WrField *heights = wr_field_share(layer->heights);
    WrField *cover = layer->cover ? wr_field_share(layer->cover) : NULL;
    const int tiles = wr_field_tiles_u(heights) * wr_field_tiles_v(heights);
    WrMadeBefore before = { .wanted = wr_alloc((size_t)tiles, 1) };
    memset(before.wanted, 1, (size_t)tiles);
    WrGenerateJob job = { .like = below ? below : layer->heights,
                          .layer = wr_layers_below_find,
                          .layer_ctx = &layers,
                          .mask = layer->mask,
                          .progress = wr_progress_part(&making, wr_progress_here(), 0.0, 0.9) };
    const WrInputs now = inputs_of(session, index, call, below);
    const WrInputs *was = layer->made == wr_field_key(heights)
                              ? wr_made_from_find(session->made_from, layer->made, &now)
                              : NULL;
    if (was && was->of[0]) {
        before.heights = was->of[0];
        before.cover = was->of[1];
        job.before = &before;
    }
    WrRelief relief = { NULL, NULL };
    const bool good = wr_call_make(session, call, &job, &relief, err) &&
                      wr_call_lay(call, &relief, layer, session->options.pool,
                                  wr_progress_part(&laying, wr_progress_here(), 0.9, 1.0), err);
    if (good) {
        wr_field_share_equal(layer->heights, heights, before.wanted);
        wr_field_share_equal(layer->cover, cover, before.wanted);
        if (now.of[0]) wr_made_from_note(&session->made_from, wr_field_key(layer->heights), &now);
    }
    wr_relief_fini(&relief);
    wr_field_free(heights);
    wr_field_free(cover);
    wr_free(before.wanted);
    return good;
}

/* Hash of the line's input: the layer that it names, or the composite of the layers below. `nothing` if it reads neither, or
   the layer is gone. *below: output, that composite, owned by the caller; or NULL */
static WrHash read_below(const WrSession *session, int index, const WrCall *call, WrField **below)
{
    const WrDocument *document = session->state.document;
    const WrGenerator *generator = wr_call_generator(call);
    const WrArg *named = generator ? wr_call_layer_argument(call) : NULL;
    *below = NULL;
    if (named) {
        const int i = wr_document_find_below(document, index, named->text);
        return i < 0 ? nothing : wr_layer_content_hash(&document->layers[i]);
    }
    if (!generator || !generator->reads) return nothing;
    *below = wr_document_below(document, index, session->options.pool);
    return wr_field_hash(*below);
}

/* Generate the content of layer `index` by a call, whose canonical line becomes the layer's. On failure the layer is
   unchanged. outer: the call whose from= this is; it gets the line with absolute file names and checksums; or NULL */
static bool generate(WrSession *session, int index, WrCall *call, WrCall *outer, WrError *err)
{
    const double began = wr_clock_seconds();
    WrField *below;
    WrHash source = nothing;
    if (!wr_session_take_source(session, index, call, &source, err)) return false;
    const WrHash read = read_below(session, index, call, &below);
    const WrHash hash = wr_hash_equal(read, nothing) ? source : read;
    const bool good = wr_call_generator(call) ? by_generator(session, index, call, below, err)
                                              : by_painting(session, index, call, err);
    wr_field_free(below);
    if (!good) return false;
    WrText line = { 0 };
    if (outer) {
        wr_call_print(call, &line);
        wr_call_set_text(outer, "from", wr_text_get(&line));
        wr_text_clear(&line);
    }
    clear(call, own_name(call, "blend"));
    if (wr_call_generator(call)) clear(call, own_name(call, "radius"));
    wr_call_print(call, &line);
    WrLayer *layer = &session->state.document->layers[index];
    wr_layer_set_line(layer, wr_text_get(&line), hash);
    wr_session_note_source(session, index);
    wr_layer_time_note(layer->made, wr_clock_seconds() - began, 0);
    wr_text_fini(&line);
    return true;
}

/* The line makes an edge of the selection. */
static bool is_edge(const WrCall *call, const WrDocument *document)
{
    const WrFamily *family = wr_family_find(call->command->name);
    if (!family || !family->beyond || !document->selection || wr_call_layer_argument(call))
        return false;
    const int of = wr_call_choice(call, "of");
    return of == WR_RIM_AUTO || of == WR_RIM_SELECTION;
}

/* A layer of opacity 0 with the selection as its coverage; it stays when the selection changes. The line then names it. */
static bool keep_selection(WrSession *session, WrCall *call, int index, const char *name,
                           WrError *err)
{
    WrDocument *document = session->state.document;
    const WrField *s = document->selection;
    WrText text = { 0 };
    if (document->layer_count + 1 >= WR_LAYERS_MAX)
        return wr_fail(err, "a document has up to %d layers: an edge of the selection needs two",
                       WR_LAYERS_MAX);
    for (int n = 1; n == 1 || wr_layer_named(document, wr_text_get(&text)) >= 0; n++) {
        char excerpt[WR_EXCERPT_SIZE];
        wr_text_clear(&text);
        wr_text_addf(&text, "%s shape", wr_excerpt(name, excerpt));
        if (n > 1) wr_text_addf(&text, " %d", n);
    }
    WrLayer shape = wr_layer_make(wr_text_get(&text), s);
    wr_field_free(shape.heights);
    wr_field_free(shape.cover);
    shape.heights = wr_field_new(wr_field_width(s), wr_field_height(s), wr_field_wrap_u(s),
                                 wr_field_wrap_v(s), 1.0f, NULL);
    shape.cover = wr_field_share(s);
    shape.opacity = 0.0f; /* unlike a hidden layer it can be painted on */
    wr_document_insert(document, index, shape);
    wr_call_set_text(call, "layer", wr_text_get(&text));
    clear(call, "of");
    wr_text_fini(&text);
    return true;
}

bool wr_session_add_generator_layer(WrSession *session, WrCall *outer, int *index, WrLayer layer,
                                    WrError *err)
{
    WrDocument *document = session->state.document;
    WrCall *call = wr_call_inner(outer);
    const bool edge = is_edge(call, document);
    bool good = !edge || keep_selection(session, call, *index, layer.name, err);
    *index += edge && good;
    wr_call_begin_layer(call, document->selection, &layer);
    /* the numbers of layers are those before it is inserted */
    good = good && wr_session_name_source(session, *index, *index, call, err);
    wr_document_insert(document, *index, layer);
    good = good && wr_session_take_tiles(session, call, err);
    if (good) {
        name_files(call, session);
        /* the step's line goes on to name the selection */
        good = generate(session, *index, call, edge ? NULL : outer, err);
    }
    wr_call_free(call);
    return good;
}

/* The call of the layer's line; NULL and an error if this program does not know it. */
static WrCall *call_of(const WrSession *session, int index, WrError *err)
{
    const WrLayer *layer = &session->state.document->layers[index];
    WrText name = { 0 };
    WrError why = { "" };
    WrCall *call = NULL;
    wr_session_layer_name(session, index, &name);
    if (!layer->line)
        wr_fail(err, "%s is not a generator layer: `layer add NAME from=` adds one",
                wr_text_get(&name));
    else if (!wr_check_layer_line(NULL, "from", layer->line, &why) ||
             !wr_call_parse(layer->line, false, &call, &why))
        wr_fail(err, "%s: its command is unknown to this version (%s): its heights stay",
                wr_text_get(&name), wr_error_message(&why));
    wr_text_fini(&name);
    return call;
}

bool wr_session_change_generator_layer(WrSession *session, WrCall *outer, int index,
                                       const char *change, WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    WrCall *call = call_of(session, index, err), *other = wr_call_inner(outer);
    const bool replaces = other;
    if (!call && !(other && layer->line)) { /* an unknown line can be replaced */
        wr_call_free(other);
        return false;
    }
    if (other) {
        wr_call_free(call);
        call = other;
    }
    bool good =
        (!change || wr_call_change(call, change, err)) && wr_session_take_tiles(session, call, err);
    if (good) {
        name_files(call, session);
        take_blend(call, false, layer);
        good = generate(session, index, call, replaces ? outer : NULL, err);
    }
    wr_call_free(call);
    return good;
}

bool wr_session_use_line(WrSession *session, int index, const char *line, WrError *err)
{
    WrError why = { "" };
    WrCall *call = NULL;
    if (!wr_check_layer_line(NULL, "line", line, &why) ||
        !wr_call_parse(line, false, &call, &why)) {
        WrText name = { 0 };
        wr_session_note(session,
                        "%s: its command is unknown to this version (%s): its heights stay",
                        wr_session_layer_name(session, index, &name), wr_error_message(&why));
        wr_text_fini(&name);
        return true;
    }
    if (wr_line_links(line)) { /* made at the end of the command, if its source is there */
        wr_layer_set_line(&session->state.document->layers[index], line, nothing);
        wr_call_free(call);
        return true;
    }
    const bool good = generate(session, index, call, NULL, err);
    wr_call_free(call);
    return good;
}

static bool is_file(const WrCall *call, int i)
{
    return call->specs[i].type == WR_ARG_PATH && wr_call_names_file(call, i) && *call->args[i].text;
}

static bool names_file(const WrCall *call)
{
    for (int i = 0; i < call->count; i++)
        if (is_file(call, i)) return true;
    return false;
}

/* True if the line names an installed font, not a file, and that font is not here. */
static bool is_font_missing(const WrCall *call, WrText *path)
{
    const WrGenerator *generator = wr_call_generator(call);
    const WrParam *p = generator ? generator->params : NULL;
    while (p && p->name && p->words != wr_font_names) p++;
    if (!p || !p->name || wr_call_given(call, FONT_FILE)) return false;
    const int index = wr_call_choice(call, p->name);
    char *file = wr_font_find(index, 32.0, NULL);
    if (!file) wr_text_add(path, wr_font_family(index));
    wr_free(file);
    return !file;
}

const char *wr_line_missing_file(const char *line, WrText *path)
{
    WrCall *call = NULL;
    const char *name = NULL;
    if (!wr_call_parse(line, false, &call, NULL)) return NULL;
    for (int i = 0; i < call->count && !name; i++) {
        if (!is_file(call, i) || wr_path_can_read(call->args[i].text)) continue;
        name = call->specs[i].positional ? "" : call->specs[i].name;
        wr_text_add(path, call->args[i].text);
    }
    if (!name && is_font_missing(call, path)) name = FONT_FILE;
    wr_call_free(call);
    return name;
}

/* The argument of that name is given. */
static bool gives(const WrCall *call, const char *name)
{
    for (int i = 0; i < call->count; i++)
        if (strcmp(call->specs[i].name, name) == 0) return call->args[i].given;
    return false;
}

void wr_session_spell_change(WrSession *session, WrCall *call)
{
    int index;
    const char *layer = gives(call, "N") ? wr_call_arg(call, "N")->text : NULL; /* not a number's */
    if (!gives(call, "change") || gives(call, "from") || !layer ||
        !wr_session_find_layer(session, layer, &index, NULL))
        return;
    WrCall *line = call_of(session, index, NULL);
    if (line && wr_call_change(line, wr_call_arg(call, "change")->text, NULL) && names_file(line)) {
        WrText text = { 0 };
        wr_call_print(line, &text);
        wr_call_set_text(call, "from", wr_text_get(&text));
        wr_text_fini(&text);
        clear(call, "change");
    }
    wr_call_free(line);
}

bool wr_session_generate_again(WrSession *session, int index, WrError *err)
{
    WrCall *call = call_of(session, index, err);
    const bool good = call && generate(session, index, call, NULL, err);
    wr_call_free(call);
    return good;
}

void wr_session_rename_in_lines(WrSession *session, int index, const char *name)
{
    WrDocument *document = session->state.document;
    for (int i = index + 1; i < document->layer_count; i++) {
        WrLayer *layer = &document->layers[i];
        WrCall *call = layer->line ? call_of(session, i, NULL) : NULL;
        WrArg *arg = call && wr_call_generator(call) ? wr_call_layer_argument(call) : NULL;
        if (arg && wr_document_find_below(document, i, arg->text) == index) {
            WrText line = { 0 };
            wr_call_set_text(call, call->specs[arg - call->args].name, name);
            wr_call_print(call, &line);
            wr_layer_set_line(layer, wr_text_get(&line), layer->below);
            wr_text_fini(&line);
        }
        wr_call_free(call);
    }
}

/* ---- after each command ---- */

/* True if the layers that the line reads have changed since. *seen: identifies the layers below as they are now */
static bool has_changed(const WrSession *session, int index, const WrCall *call, uint64_t *seen)
{
    const WrDocument *document = session->state.document;
    const WrLayer *layer = &document->layers[index];
    WrBelowKey key;
    wr_session_below_key(document, index, &key);
    const bool names = wr_call_generator(call) && wr_call_layer_argument(call);
    *seen = (names ? key.all.low : key.shown.low) | 1;
    if (layer->seen == *seen) return false;
    WrField *below;
    const WrHash hash = read_below(session, index, call, &below);
    wr_field_free(below);
    /* a layer that the line names may be gone: the heights then stay */
    return !wr_hash_equal(hash, nothing) && !wr_hash_equal(hash, layer->below);
}

/* Generate a layer whose line reads layers that have changed. A line of another version leaves the heights as they are. */
static bool follow_read(WrSession *session, int index, WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    WrCall *call = wr_hash_equal(layer->below, nothing) ? NULL : call_of(session, index, NULL);
    if (!call) return true;
    uint64_t seen;
    const bool stale = has_changed(session, index, call, &seen);
    wr_call_free(call);
    if (stale && !wr_session_generate_again(session, index, err)) return false;
    layer->seen = seen;
    return true;
}

bool wr_session_follow_line(WrSession *session, const WrLinks *links, int index, bool needed,
                            bool read, WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    if (!layer->line) return true;
    const bool written = wr_field_key(layer->heights) != layer->made;
    const bool copied =
        links->copies[index] && (written || read) && wr_session_check_source(session, links, index);
    /* a command on the tables of all layers changes the source too */
    if (copied && wr_session_link_lags(session, links, index))
        return wr_session_generate_again(session, index, err);
    if (!written) return links->copies[index] || !needed || follow_read(session, index, err);
    WrText name = { 0 }; /* another command wrote its heights */
    wr_session_note(session, "%s is a plain layer now: its heights no longer follow its command",
                    wr_session_layer_name(session, index, &name));
    wr_text_fini(&name);
    wr_layer_set_line(layer, NULL, nothing);
    return true;
}

int wr_session_line_layer(const WrSession *session, int index)
{
    const WrDocument *document = session->state.document;
    if (!document->layers[index].line || wr_hash_equal(document->layers[index].below, nothing))
        return -1;
    WrCall *call = call_of(session, index, NULL);
    const WrArg *named = call && wr_call_generator(call) ? wr_call_layer_argument(call) : NULL;
    const int found = named ? wr_document_find_below(document, index, named->text) : -1;
    wr_call_free(call);
    return found;
}

/* One note for a file, however many layers name it. */
static void note_missing(WrSession *session, int index)
{
    const WrDocument *document = session->state.document;
    WrText path = { 0 }, other = { 0 }, name = { 0 };
    const char *argument = wr_line_missing_file(document->layers[index].line, &path);
    int first = index, count = 0;
    for (int i = 0; argument && i < document->layer_count; i++) {
        wr_text_clear(&other);
        if (!document->layers[i].line || !wr_line_missing_file(document->layers[i].line, &other) ||
            strcmp(wr_text_get(&other), wr_text_get(&path)) != 0)
            continue;
        if (count++ == 0) first = i;
    }
    if (argument && first == index && count == 1)
        wr_session_note(session,
                        "%s: its file %s is missing: its heights stay; `layer set %d "
                        "change=\"%s%sPATH\"` sets another path",
                        wr_session_layer_name(session, index, &name), wr_text_get(&path), index + 1,
                        argument, *argument ? "=" : "");
    else if (argument && first == index)
        wr_session_note(session,
                        "%s and %d more layers: their file %s is missing: their heights stay; "
                        "`layer set %d change=\"%s%sPATH\"` sets another path",
                        wr_session_layer_name(session, index, &name), count - 1, wr_text_get(&path),
                        index + 1, argument, *argument ? "=" : "");
    wr_text_fini(&path);
    wr_text_fini(&other);
    wr_text_fini(&name);
}

void wr_session_note_lines(WrSession *session)
{
    const WrDocument *document = session->state.document;
    for (int i = 0; i < document->layer_count; i++) {
        if (document->layers[i].line) note_missing(session, i);
        WrError why = { "" };
        WrCall *call = document->layers[i].line ? call_of(session, i, &why) : NULL;
        if (document->layers[i].line && !call)
            wr_session_note(session, "%s", wr_error_message(&why));
        wr_call_free(call);
        wr_session_note_link(session, i);
        wr_session_note_mask(session, i);
    }
}

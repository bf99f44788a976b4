/* The command variant: named sets of layers' values; and output for each of them. */
#include "command/variants.h"

#include "base/array.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/linked_copies.h"
#include "command/session_internal.h"
#include "document/blend.h"
#include "document/document.h"
#include "system/path.h"

#include <string.h>

/* WrLayer.values has a line for each variant that contains the layer, in the syntax of a command without its verb:

     worn visible=on blend=add opacity=0.5 radius=0 line="pattern bricks rows=9"

   Equal values are equal texts, so that a comparison with the present ones needs no parser. */

#define VERB "values"

static const char *blend_name(int i)
{
    return i < WR_BLEND_COUNT ? wr_blends[i].name : NULL;
}

static const WrArgSpec value_args[] = {
    { PLACE("NAME"), .type = WR_ARG_NAME },
    { .name = "visible", .type = WR_ARG_CHOICE, .words = wr_off_on, .required = true },
    { .name = "blend", .type = WR_ARG_CHOICE, .choice = blend_name, .required = true },
    { .name = "opacity", .type = WR_ARG_NUMBER, .low = 0, .high = 1, .required = true },
    { .name = "radius", .type = WR_ARG_NUMBER, .low = 0, .high = WR_BIG_HEIGHT, .required = true },
    { .name = "filter", .type = WR_ARG_TEXT },
    { .name = "line", .type = WR_ARG_TEXT },
    { .name = "mask", .type = WR_ARG_TEXT },
    { 0 }
};
static const WrCommand value_row = { .name = VERB, .args = value_args };

/* ---- lines ---- */

static void add_value(WrText *text, const char *name, const char *value)
{
    if (!value) return;
    wr_text_addf(text, " %s=", name);
    wr_text_add_word(text, value);
}

/* The layer's present values as a line of that variant. */
static void print_values(const WrLayer *layer, const char *variant, WrText *text)
{
    char opacity[WR_NUMBER_SIZE], radius[WR_NUMBER_SIZE];
    WrText filter = { 0 };
    wr_text_add_word(text, variant);
    wr_text_addf(text, " visible=%s blend=%s opacity=%s radius=%s", wr_off_on[layer->visible],
                 wr_blends[layer->blend].name, wr_number_print_float(layer->opacity, opacity),
                 wr_number_print_float(layer->radius, radius));
    if (layer->filter.op) wr_filter_print(&layer->filter, &filter);
    add_value(text, "filter", filter.data);
    add_value(text, "line", layer->line);
    add_value(text, "mask", layer->mask_line);
    wr_text_fini(&filter);
}

/* The variant's line in a layer's values, without its end; NULL: it does not contain the layer. */
static const char *find_values(const char *values, const char *variant, size_t *length)
{
    WrText head = { 0 };
    wr_text_add_word(&head, variant);
    wr_text_add(&head, " ");
    const char *found = NULL;
    for (const char *at = values; at && *at && !found; at += *length + (at[*length] == '\n')) {
        *length = strcspn(at, "\n");
        if (strncmp(at, wr_text_get(&head), head.length) == 0) {
            found = at;
            break;
        }
    }
    wr_text_fini(&head);
    return found;
}

/* Put a line in place of the variant's; NULL or "": remove it. */
static void put_values(WrLayer *layer, const char *variant, const char *line)
{
    size_t length = 0;
    WrText text = { 0 };
    const char *values = layer->values ? layer->values : "";
    const char *old = find_values(values, variant, &length);
    const char *rest = old ? old + length + (old[length] == '\n') : "";
    wr_text_add_n(&text, values, old ? (size_t)(old - values) : strlen(values));
    if (line && *line) wr_text_addf(&text, "%s\n", line);
    wr_text_add(&text, rest);
    wr_free(layer->values);
    layer->values = text.length ? wr_strdup(wr_text_get(&text)) : NULL;
    wr_text_fini(&text);
}

/* The variant's values as a call; NULL: it does not contain the layer, or the line is of another version. */
static WrCall *values_of(const WrLayer *layer, const char *variant)
{
    size_t length;
    WrCall *call = NULL;
    const char *found = find_values(layer->values, variant, &length);
    char *line = found ? wr_strndup(found, length) : NULL;
    if (line && !wr_call_parse_words(&value_row, line, &call, NULL)) call = NULL;
    wr_free(line);
    return call;
}

bool wr_variant_differs(const WrDocument *document)
{
    bool differs = false;
    for (int i = 0; document->variant && i < document->layer_count && !differs; i++) {
        const WrLayer *layer = &document->layers[i];
        WrText now = { 0 };
        size_t length = 0;
        print_values(layer, document->variant, &now);
        const char *kept = find_values(layer->values, document->variant, &length);
        differs = kept ? length != now.length || strncmp(kept, wr_text_get(&now), length) != 0
                       : layer->visible;
        wr_text_fini(&now);
    }
    return differs;
}

/* ---- renaming of layers ---- */

static void rename_value(WrCall *call, const char *name, char *renamed)
{
    if (renamed) wr_call_set_text(call, name, renamed);
    wr_free(renamed);
}

/* Lines and terms of layer `of` in a variant that read layer `index` get its new name. */
static void rename_in_variant(WrDocument *document, int of, const char *variant, int index,
                              const char *name)
{
    WrCall *call = values_of(&document->layers[of], variant);
    WrText line = { 0 };
    if (!call) return;
    rename_value(call, "line",
                 wr_link_renamed(document, of, wr_call_arg(call, "line")->text, index, name));
    rename_value(call, "mask",
                 wr_mask_line_renamed(document, of, wr_call_arg(call, "mask")->text, index, name));
    wr_call_print(call, &line);
    put_values(&document->layers[of], variant, wr_text_get(&line) + sizeof VERB);
    wr_text_fini(&line);
    wr_call_free(call);
}

void wr_session_rename_in_variants(WrSession *session, int index, const char *name)
{
    WrDocument *document = session->state.document;
    char variant[WR_VARIANT_NAME_MAX + 1];
    for (int k = 0; k < wr_variant_count(document); k++) {
        wr_variant_name(document, k, variant);
        for (int i = 0; i < document->layer_count; i++)
            rename_in_variant(document, i, variant, index, name);
    }
}

/* ---- storing and using ---- */

static void store(WrDocument *document, const char *variant)
{
    for (int i = 0; i < document->layer_count; i++) {
        WrText line = { 0 };
        print_values(&document->layers[i], variant, &line);
        put_values(&document->layers[i], variant, wr_text_get(&line));
        wr_text_fini(&line);
    }
}

void wr_session_store_in_variants(WrSession *session, int index)
{
    WrDocument *document = session->state.document;
    WrLayer *layer = &document->layers[index];
    char variant[WR_VARIANT_NAME_MAX + 1];
    for (int k = 0; k < wr_variant_count(document); k++) {
        WrText line = { 0 };
        wr_variant_name(document, k, variant);
        print_values(layer, variant, &line);
        put_values(layer, variant, wr_text_get(&line));
        wr_text_fini(&line);
    }
}

static void set_in_use(WrDocument *document, const char *variant)
{
    char *copy = wr_strdup(variant);
    wr_free(document->variant);
    document->variant = copy;
}

/* Note that a stored line is not used, since the layer is plain now: its own heights, or its mask, would be lost. */
static void note_plain(WrSession *session, int index, const char *part)
{
    WrText name = { 0 };
    wr_session_note(session, "%s no longer has a %s: the one in the variant is left out",
                    wr_session_layer_name(session, index, &name), part);
    wr_text_fini(&name);
}

static bool differs(const char *a, const char *b)
{
    return strcmp(a ? a : "", b ? b : "") != 0;
}

/* Set everything but the line. True: the content of a generator layer depends on the changes. */
static bool use_settings(WrSession *session, int index, const WrCall *call)
{
    WrLayer *layer = &session->state.document->layers[index];
    const bool weighed = wr_blends[layer->blend].uses_cover;
    layer->visible = wr_call_choice(call, "visible") == 1;
    layer->blend = (WrBlend)wr_call_choice(call, "blend");
    layer->opacity = (float)wr_call_number(call, "opacity");
    layer->radius = (float)wr_call_number(call, "radius");
    const char *filter = wr_call_arg(call, "filter")->text;
    const char *mask = wr_call_arg(call, "mask")->text;
    if (filter && layer->filter.op) wr_filter_parse(filter, &layer->filter, NULL);
    if (mask && !layer->mask_line) note_plain(session, index, WR_MESSAGE("live mask"));
    else if (mask && differs(mask, layer->mask_line)) /* the end of the command makes it */
        wr_layer_set_mask_line(layer, mask, (WrHash){ 0, 0 });
    return layer->line && wr_blends[layer->blend].uses_cover != weighed;
}

static bool use_line(WrSession *session, int index, const WrCall *call, bool again, WrError *err)
{
    const WrLayer *layer = &session->state.document->layers[index];
    const char *line = wr_call_arg(call, "line")->text;
    if (line && !layer->line) note_plain(session, index, WR_MESSAGE("generator"));
    if (layer->line && line && differs(line, layer->line))
        return wr_session_use_line(session, index, line, err);
    return !again || wr_session_generate_again(session, index, err);
}

/* Hide the layers that the variant does not contain, since they were added later. */
static void hide_later_layers(WrSession *session, const char *variant)
{
    WrDocument *document = session->state.document;
    int hidden = 0;
    for (int i = 0; i < document->layer_count; i++) {
        WrLayer *layer = &document->layers[i];
        size_t length;
        if (find_values(layer->values, variant, &length)) continue;
        hidden += layer->visible;
        layer->visible = false;
    }
    if (hidden == 1)
        wr_session_note(session,
                        "1 layer was added after variant \"%s\" was stored, and is hidden; show it "
                        "and run `variant set` to store it in the variant",
                        variant);
    else if (hidden > 1)
        wr_session_note(session,
                        "%d layers were added after variant \"%s\" was stored, and are hidden; "
                        "show them and run `variant set` to store them in the variant",
                        hidden, variant);
}

/* All settings first, then the lines from the bottom up, which read composites. Lines that read a layer made later are made
   again at the end of the command. */
static bool use(WrSession *session, const char *variant, WrError *err)
{
    WrDocument *document = session->state.document;
    WrCall *calls[WR_LAYERS_MAX];
    bool again[WR_LAYERS_MAX] = { false }, good = true;
    const int count = document->layer_count;
    for (int i = 0; i < count; i++) {
        calls[i] = values_of(&document->layers[i], variant);
        if (calls[i]) again[i] = use_settings(session, i, calls[i]);
    }
    hide_later_layers(session, variant);
    for (int i = 0; i < count; i++) {
        WrProgressPart part;
        const WrProgress *whole =
            wr_progress_enter(&part, (double)i / count, (double)(i + 1) / count);
        good = good && (!calls[i] || use_line(session, i, calls[i], again[i], err));
        wr_progress_set(whole);
        wr_call_free(calls[i]);
    }
    if (good) set_in_use(document, variant);
    return good;
}

/* ---- the command variant ---- */

static bool find(const WrDocument *document, const char *name, int *index, WrError *err)
{
    char excerpt[WR_EXCERPT_SIZE];
    *index = wr_variant_find(document, name);
    return *index >= 0 ||
           wr_fail(err, "no variant \"%s\": `variant add` stores one", wr_excerpt(name, excerpt));
}

static bool check_new(const WrDocument *document, const char *name, WrError *err)
{
    char excerpt[WR_EXCERPT_SIZE];
    if (wr_variant_find(document, name) < 0) return true;
    return wr_fail(err, "a variant \"%s\" already exists: choose another name",
                   wr_excerpt(name, excerpt));
}

static bool variant_add(WrSession *session, const WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    const char *name = wr_call_arg(call, "NAME")->text;
    const int count = wr_variant_count(document);
    if (!check_new(document, name, err)) return false;
    if (count >= WR_VARIANTS_MAX)
        return wr_fail(err, "a document has up to %d variants", WR_VARIANTS_MAX);
    wr_variant_put_name(document, count, name);
    store(document, name);
    set_in_use(document, name);
    return true;
}

static bool variant_use(WrSession *session, const WrCall *call, WrError *err)
{
    int index;
    const char *name = wr_call_arg(call, "NAME")->text;
    return find(session->state.document, name, &index, err) && use(session, name, err);
}

static bool variant_set(WrSession *session, const WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    int index;
    const char *name = wr_call_arg(call, "NAME")->text;
    if (!name) name = document->variant;
    if (!name) return wr_fail(err, "no variant is in use: give its name");
    if (!find(document, name, &index, err)) return false;
    store(document, name);
    if (name != document->variant) set_in_use(document, name);
    return true;
}

static bool variant_rename(WrSession *session, const WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    int index;
    const char *name = wr_call_arg(call, "NAME")->text, *other = wr_call_arg(call, "NEW")->text;
    if (!find(document, name, &index, err) || !check_new(document, other, err)) return false;
    for (int i = 0; i < document->layer_count; i++) {
        WrLayer *layer = &document->layers[i];
        size_t length;
        const char *found = find_values(layer->values, name, &length);
        WrText line = { 0 }, word = { 0 };
        if (!found) continue;
        wr_text_add_word(&word, name);
        wr_text_add_word(&line, other);
        wr_text_add_n(&line, found + word.length, length - word.length);
        put_values(layer, name, wr_text_get(&line));
        wr_text_fini(&line);
        wr_text_fini(&word);
    }
    wr_variant_put_name(document, index, other);
    if (document->variant && strcmp(document->variant, name) == 0) set_in_use(document, other);
    return true;
}

static bool variant_delete(WrSession *session, const WrCall *call, WrError *err)
{
    WrDocument *document = session->state.document;
    int index;
    const char *name = wr_call_arg(call, "NAME")->text;
    if (!find(document, name, &index, err)) return false;
    for (int i = 0; i < document->layer_count; i++) put_values(&document->layers[i], name, NULL);
    wr_variant_put_name(document, index, NULL);
    if (document->variant && strcmp(document->variant, name) == 0) set_in_use(document, NULL);
    return true;
}

enum { VARIANT_ADD, VARIANT_USE, VARIANT_SET, VARIANT_RENAME, VARIANT_DELETE, VARIANT_FORMS };

static bool run_variant(WrSession *session, WrCall *call, WrError *err)
{
    WR_ROWS(handlers);
    static bool (*const handlers[])(WrSession *, const WrCall *, WrError *) = {
        [WR_ROW(VARIANT_ADD)] = variant_add,       [WR_ROW(VARIANT_USE)] = variant_use,
        [WR_ROW(VARIANT_SET)] = variant_set,       [WR_ROW(VARIANT_RENAME)] = variant_rename,
        [WR_ROW(VARIANT_DELETE)] = variant_delete,
    };
    WR_ROWS_END(handlers, VARIANT_FORMS);
    return handlers[call->form](session, call, err);
}

#define VARIANT_NAME                                                                               \
    {                                                                                              \
        PLACE("NAME"), .type = WR_ARG_NAME, .help = "name of the variant"                          \
    }

WR_ROWS(variant_forms);
static const WrForm variant_forms[] = {
    [WR_ROW(VARIANT_ADD)] = { .name = "add",
                              .help =
                                  "store the layers' present settings as a new variant, and use it",
                              .args = { VARIANT_NAME } },
    [WR_ROW(VARIANT_USE)] = { .name = "use",
                              .help = "apply a variant to the layers",
                              .args = { VARIANT_NAME } },
    [WR_ROW(
        VARIANT_SET)] = { .name = "set",
                          .help = "store the layers' present settings in a variant, and use it",
                          .args = { { .name = "NAME",
                                      .type = WR_ARG_NAME,
                                      .positional = true,
                                      .help = "name of the variant; left out, the one in use" } } },
    [WR_ROW(VARIANT_RENAME)] = { .name = "rename",
                                 .help = "rename a variant",
                                 .args = { VARIANT_NAME,
                                           { PLACE("NEW"), .type = WR_ARG_NAME,
                                             .help = "new name" } } },
    [WR_ROW(VARIANT_DELETE)] = { .name = "delete",
                                 .help = "delete a variant; the layers do not change",
                                 .args = { VARIANT_NAME } },
};
WR_ROWS_END(variant_forms, VARIANT_FORMS);

WR_FORMS(form_variant, variant_forms)

const WrCommand wr_command_variant = {
    .name = "variant",
    .kind = WR_CLASS_EDIT,
    .form_word = "ACTION",
    .form = form_variant,
    .run = run_variant,
    .help = "store and apply sets of layer settings",
    .details =
        "A variant stores each layer's visibility, blend mode, opacity and radius, the command of "
        "a generator layer, the terms of a live mask and the arguments of a filter. A layer that "
        "is added later is hidden in it until `variant set`. With <VARIANT> in a file name, "
        "`export`, `maps` and `render` write one file for each variant.",
    .example = "variant add worn"
};

/* ---- files for each variant ---- */

bool wr_variant_is_pattern(const char *path)
{
    return path && strstr(path, WR_VARIANT_PATTERN);
}

char *wr_variant_fill(const char *pattern, const char *variant)
{
    WrText path = { 0 };
    const char *at = pattern;
    for (const char *next; variant && (next = strstr(at, WR_VARIANT_PATTERN));
         at = next + strlen(WR_VARIANT_PATTERN)) {
        wr_text_add_n(&path, at, (size_t)(next - at));
        for (const char *p = variant; *p; p++)
            wr_text_add_n(&path, *p == '/' || (*p == '.' && p == variant) ? "-" : p, 1);
    }
    wr_text_add(&path, at);
    char *filled = wr_strdup(wr_text_get(&path));
    wr_text_fini(&path);
    return filled;
}

char *wr_variant_insert(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    if (wr_variant_is_pattern(path)) return wr_strdup(path);
    if (!dot) dot = path + strlen(path);
    WrText text = { 0 };
    wr_text_addf(&text, "%.*s_" WR_VARIANT_PATTERN "%s", (int)(dot - path), path, dot);
    char *made = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
    return made;
}

/* True if the names of all variants lead to files of their own. */
static bool check_files(const WrDocument *document, const char *path, WrError *err)
{
    WR_ARRAY(char *) files = { 0 };
    bool good = wr_variant_count(document) > 0 ||
                wr_fail(err, "%s: the document has no variants: `variant add` stores one", path);
    char name[WR_VARIANT_NAME_MAX + 1];
    for (int k = 0; k < wr_variant_count(document); k++) {
        wr_variant_name(document, k, name);
        char *file = wr_variant_fill(path, name);
        for (int i = 0; i < files.count && good; i++)
            if (strcmp(files.data[i], file) == 0)
                good = wr_fail(err, "%s: two variants would write this file: rename one", file);
        wr_array_push(&files, file);
    }
    for (int i = 0; i < files.count; i++) wr_free(files.data[i]);
    wr_array_free(&files);
    return good;
}

bool wr_session_for_variants(WrSession *session, const char *path, WrVariantWork *work, void *ctx,
                             WrError *err)
{
    if (!wr_variant_is_pattern(path)) return work(ctx, NULL, err);
    if (!check_files(session->state.document, path, err)) return false;
    WrDocument *kept = wr_document_share(session->state.document);
    const int count = wr_variant_count(kept);
    bool good = true;
    for (int k = 0; k < count && good; k++) {
        char name[WR_VARIANT_NAME_MAX + 1];
        WrProgressPart part;
        const WrProgress *whole =
            wr_progress_enter(&part, (double)k / count, (double)(k + 1) / count);
        wr_variant_name(kept, k, name);
        good = use(session, name, err) && wr_session_follow(session, err) && work(ctx, name, err);
        wr_progress_set(whole);
        wr_session_put_document(session, wr_document_share(kept));
    }
    wr_document_free(kept);
    return good;
}

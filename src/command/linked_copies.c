/* Linked copies: generator layers whose line copies the heights and coverage of another layer. */
#include "command/linked_copies.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/live_masks.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "document/edit.h"
#include "field/field.h"
#include "field/ops.h"
#include "generate/transform_piece.h"

#include <math.h>
#include <string.h>

/* A copy without values shares the tiles of its source: it costs no memory, and it is up to date exactly if the keys of
   both tables are equal. Other copies compare the source's keys with those of the last time, and after opening a file,
   which has no keys, the hash of its content.

   The copy of a group has its composite. That of the last group copied is kept in the session, so that several copies of it
   cost one composite.

   The source may be above or below. A line that reads the composite of the layers below reads all of them, so that a copy
   below it can close a cycle too. Cycles are refused when a copy is made; if another change closes one, such as a move, its
   copies keep their heights, as if their source were gone. */

#define VERB "link"
#define SOURCE "LAYER"

/* WrLayer.below of a copy that keeps its heights, since its source is gone: this was noted, and is not noted again. */
static const WrHash kept_as_is = { 0, UINT64_MAX };

bool wr_line_links(const char *line)
{
    return line && strncmp(line, VERB " ", sizeof VERB) == 0;
}

void wr_layer_link(WrLayer *layer, const char *source)
{
    WrText line = { 0 };
    wr_text_add(&line, VERB " ");
    wr_text_add_word(&line, source);
    wr_layer_set_line(layer, wr_text_get(&line), (WrHash){ 0, 0 });
    wr_text_fini(&line);
}

/* ---- sources ---- */

/* The layer of that name that is nearest below a place between layers, else nearest above it; -1: none. The layers from
   `above` on lie above the place. */
static int find_named(const WrDocument *document, int place, int above, const char *name)
{
    int i = place - 1;
    while (i >= 0 && strcmp(document->layers[i].name, name) != 0) i--;
    if (i >= 0) return i;
    for (i = above; i < document->layer_count; i++)
        if (strcmp(document->layers[i].name, name) == 0) return i;
    return -1;
}

static WrCall *call_of(const char *line)
{
    WrCall *call = NULL;
    return wr_line_links(line) && wr_call_parse(line, false, &call, NULL) ? call : NULL;
}

static bool is_link(const WrCall *call)
{
    return call->command && call->command->links;
}

static bool can_be_copied(const WrLayer *layer)
{
    return layer->is_group || wr_layer_holds(layer);
}

/* The source of a copy at layer `index`; -1: no layer has its name, or only a filter. */
static int source_of(const WrDocument *document, int index, const char *line)
{
    WrCall *call = call_of(line);
    int found = call ? find_named(document, index, index + 1, wr_call_arg(call, SOURCE)->text) : -1;
    if (found >= 0 && !can_be_copied(&document->layers[found])) found = -1;
    wr_call_free(call);
    return found;
}

static void mark_within(const WrDocument *document, int group, WrLinks *links)
{
    for (int i = wr_layers_first(document->layers, group); i < group; i++)
        links->within[i] |= wr_document_is_visible_up_to(document, i, group);
}

void wr_session_links(const WrSession *session, WrLinks *links)
{
    const WrDocument *document = session->state.document;
    *links = (WrLinks){ .any = false };
    for (int i = 0; i < document->layer_count; i++) {
        const char *line = document->layers[i].line;
        links->copies[i] = wr_line_links(line);
        links->source[i] = links->copies[i] ? source_of(document, i, line) : -1;
        links->any |= links->copies[i];
        if (links->source[i] >= 0) mark_within(document, links->source[i], links);
    }
}

bool wr_session_name_source(const WrSession *session, int place, int above, WrCall *call,
                            WrError *err)
{
    const WrDocument *document = session->state.document;
    if (!is_link(call)) return true;
    const char *word = wr_call_arg(call, SOURCE)->text;
    int found = find_named(document, place, above, word);
    if (found < 0 && !wr_session_find_layer(session, word, &found, err)) return false;
    WrText name = { 0 };
    wr_session_layer_name(session, found, &name);
    bool good = true;
    if (found >= place && found < above)
        good = wr_fail(err, "%s cannot copy itself: name another layer", wr_text_get(&name));
    else if (find_named(document, place, above, document->layers[found].name) != found)
        good =
            wr_fail(err, "%s has the name of another layer: rename it first", wr_text_get(&name));
    else if (!can_be_copied(&document->layers[found]))
        good =
            wr_fail(err, "%s is a filter layer, which has no heights to copy", wr_text_get(&name));
    else wr_call_set_text(call, SOURCE, document->layers[found].name);
    wr_text_fini(&name);
    return good;
}

/* ---- cycles ---- */

typedef struct Search {
    const WrSession *session;
    const WrLinks *links;
    int target;
    bool seen[WR_LAYERS_MAX], seen_masks[WR_LAYERS_MAX];
    WrText path; /* "layer 3 "b" > layer 1 "a"": each reads the next, on success */
} Search;

bool wr_layer_is_followed(const WrDocument *document, const WrLinks *links, int index)
{
    return links->within[index] || wr_document_shows(document, index);
}

WrReads wr_session_reads(const WrSession *session, const WrLinks *links, int index)
{
    const WrDocument *document = session->state.document;
    const WrLayer *layer = &document->layers[index];
    WrReads reads = { .layer = links->source[index] };
    if (links->copies[index]) return reads;
    if (layer->is_group) reads.from = wr_layers_first(document->layers, index);
    else if (!layer->line || wr_hash_equal(layer->below, (WrHash){ 0, 0 }) ||
             !wr_layer_is_followed(document, links, index))
        return reads;
    else if ((reads.layer = wr_session_line_layer(session, index)) < 0)
        reads.from = wr_layers_first_sibling(document->layers, index);
    reads.to = reads.layer < 0 ? index : 0;
    return reads;
}

static void prepend(Search *search, int index)
{
    WrText name = { 0 }, rest = search->path;
    search->path = (WrText){ 0 };
    wr_text_addf(&search->path, "%s%s%s", wr_session_layer_name(search->session, index, &name),
                 rest.length ? " > " : "", wr_text_get(&rest));
    wr_text_fini(&name);
    wr_text_fini(&rest);
}

static bool rows_reach(Search *search, int from, int to);

/* True if the heights of layer `from` depend on those of the target. */
static bool reaches(Search *search, int from)
{
    bool found = from == search->target;
    if (!found && search->seen[from]) return false;
    search->seen[from] = true;
    const WrReads reads = wr_session_reads(search->session, search->links, from);
    if (!found && reads.layer >= 0) found = reaches(search, reads.layer);
    found = found || rows_reach(search, reads.from, reads.to);
    if (found) prepend(search, from);
    return found;
}

static bool mask_reaches(Search *search, int index);

static bool rows_reach(Search *search, int from, int to)
{
    bool found = false;
    for (int i = to - 1; i >= from && !found; i--) found = reaches(search, i);
    for (int i = to - 1; i >= from && !found; i--) found = mask_reaches(search, i);
    return found;
}

static bool mask_reaches(Search *search, int index)
{
    const WrDocument *document = search->session->state.document;
    int named[WR_MASK_TERMS];
    if (!document->layers[index].mask_line || search->seen_masks[index]) return false;
    search->seen_masks[index] = true;
    bool found = rows_reach(search, wr_layers_first_sibling(document->layers, index), index);
    const int count = wr_mask_named(document, index, named);
    for (int i = 0; i < count && !found; i++) found = rows_reach(search, named[i], named[i] + 1);
    if (found) prepend(search, index);
    return found;
}

/* The error of a cycle that a copy at layer `index` closes, or would close; false: it closes one. */
static bool check_cycle(const WrSession *session, const WrLinks *links, int index, int source,
                        WrError *err)
{
    Search search = { .session = session, .links = links, .target = index };
    const bool cycle = reaches(&search, source);
    if (cycle) {
        prepend(&search, index);
        wr_fail(err, "a cycle of links: %s", wr_text_get(&search.path));
    }
    wr_text_fini(&search.path);
    return !cycle;
}

/* The reason why the copy at layer `index` keeps its heights; true: there is none. */
static bool check_source(const WrSession *session, const WrLinks *links, int index, WrError *err)
{
    const WrDocument *document = session->state.document;
    const int source = links->source[index];
    if (source >= 0) return check_cycle(session, links, index, source, err);
    WrCall *call = call_of(document->layers[index].line);
    if (!call) return true; /* of another version: noted when it was opened */
    char excerpt[WR_EXCERPT_SIZE];
    wr_fail(err, "no layer \"%s\" has heights to be copied",
            wr_excerpt(wr_call_arg(call, SOURCE)->text, excerpt));
    wr_call_free(call);
    return false;
}

/* ---- staleness ---- */

/* Key of heights and coverage, of a group of those of its members. */
static uint64_t key_of(const WrDocument *document, int index)
{
    const WrLayer *layer = &document->layers[index];
    if (layer->is_group) return wr_session_group_key(document, index).low | 1;
    const uint64_t keys[] = { wr_field_key(layer->heights),
                              layer->cover ? wr_field_key(layer->cover) : 0 };
    return wr_hash_bytes(keys, sizeof keys, (WrHash){ 0, 0 }).low | 1;
}

WrHash wr_layer_content_hash(const WrLayer *layer)
{
    const WrHash hashes[] = { wr_field_hash(layer->heights),
                              layer->cover ? wr_field_hash(layer->cover) : (WrHash){ 0, 0 } };
    return wr_hash_bytes(hashes, sizeof hashes, (WrHash){ 1, 0 });
}

/* Heights and coverage of a layer, or of a group's composite. Borrowed until the next call. */
static const WrLayer *content_of(WrSession *session, int index)
{
    const WrDocument *document = session->state.document;
    if (!document->layers[index].is_group) return &document->layers[index];
    const uint64_t key = key_of(document, index);
    if (session->group_key == key) return &session->group;
    WrDocument *copy = wr_document_snapshot(document);
    const int row = wr_document_rasterize_group(copy, index, session->options.pool);
    wr_layer_fini(&session->group);
    session->group = wr_layer_share(&copy->layers[row]);
    session->group_key = wr_progress_stopped() ? 0 : key;
    wr_document_free(copy);
    return &session->group;
}

bool wr_session_take_source(WrSession *session, int index, WrCall *call, WrHash *read, WrError *err)
{
    if (!is_link(call)) return true;
    if (!wr_session_name_source(session, index, index + 1, call, err)) return false;
    const WrDocument *document = session->state.document;
    WrLinks links;
    wr_session_links(session, &links);
    links.copies[index] = true; /* its present line counts no longer */
    links.source[index] = -1;
    const int source = find_named(document, index, index + 1, wr_call_arg(call, SOURCE)->text);
    if (!check_cycle(session, &links, index, source, err)) return false;
    *read = wr_layer_content_hash(content_of(session, source));
    return !wr_progress_stopped() || wr_fail(err, "cancelled");
}

void wr_session_note_source(WrSession *session, int index)
{
    WrDocument *document = session->state.document;
    WrLayer *layer = &document->layers[index];
    const int source = wr_line_links(layer->line) ? source_of(document, index, layer->line) : -1;
    layer->copied = source >= 0 ? key_of(document, source) : 0;
}

static bool has_values(const WrCall *call)
{
    bool any = false;
    for (int i = 0; i < call->count; i++) any |= call->args[i].given && !call->specs[i].positional;
    return any;
}

bool wr_session_link_lags(WrSession *session, const WrLinks *links, int index)
{
    WrDocument *document = session->state.document;
    WrLayer *layer = &document->layers[index];
    const int source = links->source[index];
    const uint64_t key = key_of(document, source);
    if (layer->copied == key) return false;
    WrCall *call = call_of(layer->line);
    const bool lags =
        has_values(call) || document->layers[source].is_group
            ? !wr_hash_equal(wr_layer_content_hash(content_of(session, source)), layer->below)
            : key_of(document, index) != key;
    wr_call_free(call);
    if (!lags) layer->copied = key;
    return lags;
}

bool wr_session_check_source(WrSession *session, const WrLinks *links, int index)
{
    WrLayer *layer = &session->state.document->layers[index];
    WrError why = { "" };
    if (check_source(session, links, index, &why)) return links->source[index] >= 0;
    if (wr_hash_equal(layer->below, kept_as_is)) return false;
    layer->below = kept_as_is;
    layer->copied = 0;
    WrText name = { 0 };
    wr_session_note(session, "%s: a linked copy, which keeps its heights (%s)",
                    wr_session_layer_name(session, index, &name), wr_error_message(&why));
    wr_text_fini(&name);
    return false;
}

void wr_session_note_link(WrSession *session, int index)
{
    WrLinks links;
    wr_session_links(session, &links);
    if (!links.copies[index]) return;
    session->state.document->layers[index].below = (WrHash){ 0, 1 }; /* once for each opening */
    wr_session_check_source(session, &links, index);
}

/* ---- renaming ---- */

char *wr_link_renamed(const WrDocument *document, int of, const char *line, int index,
                      const char *name)
{
    if (!wr_line_links(line) || of == index || source_of(document, of, line) != index) return NULL;
    WrCall *call = call_of(line);
    WrText text = { 0 };
    wr_call_set_text(call, SOURCE, name);
    wr_call_print(call, &text);
    wr_call_free(call);
    return text.data;
}

void wr_session_rename_in_links(WrSession *session, int index, const char *name)
{
    WrDocument *document = session->state.document;
    for (int i = 0; i < document->layer_count; i++) {
        WrLayer *layer = &document->layers[i];
        char *line = wr_link_renamed(document, i, layer->line, index, name);
        if (!line) continue;
        wr_free(layer->line);
        layer->line = line;
    }
}

/* ---- the command link ---- */

/* Whole texels within rounding: 3/97 of 97 texels are 3. */
static double texels(double part, int side)
{
    const double exact = part * side, whole = rint(exact);
    return fabs(exact - whole) < 1e-6 ? whole : exact;
}

/* Move, turn and scale the piece, as `transform` would. */
static bool place(const WrSession *session, const WrCall *call, WrLayer *piece, WrError *err)
{
    WrDocument *document = session->state.document;
    const double *shift = wr_call_arg(call, "shift")->numbers;
    const double *scale = wr_call_arg(call, "scale")->numbers;
    const double move[2] = { texels(shift[0], wr_field_width(piece->heights)),
                             texels(shift[1], wr_field_height(piece->heights)) };
    const double turn = wr_call_number(call, "turn");
    if (move[0] == 0.0 && move[1] == 0.0 && turn == 0.0 && scale[0] == 1.0 && scale[1] == 1.0)
        return true;
    WrText line = { 0 };
    const double *pairs[] = { move, scale };
    static const char *const names[] = { "transform move=", " scale=" };
    for (int i = 0; i < 2; i++) {
        wr_text_add(&line, names[i]);
        wr_text_add_number(&line, pairs[i][0]);
        wr_text_add(&line, ",");
        wr_text_add_number(&line, pairs[i][1]);
    }
    wr_text_add(&line, " turn=");
    wr_text_add_number(&line, turn);
    WrCall *transform = NULL;
    WrField *selection = document->selection;
    document->selection = NULL;
    const bool good = wr_call_parse(wr_text_get(&line), false, &transform, err) &&
                      wr_call_transform(transform, document, piece, session->options.pool,
                                        wr_progress_here(), err);
    document->selection = selection;
    wr_call_free(transform);
    wr_text_fini(&line);
    return good;
}

static bool multiply(const WrSession *session, const WrCall *call, WrLayer *piece, WrError *err)
{
    const double factor = wr_call_number(call, "factor");
    if (factor == 1.0) return true;
    const WrOpOptions options = { .pool = session->options.pool, .progress = wr_progress_here() };
    WrField *made = wr_op_run(wr_op_find("multiply"), piece->heights, &factor, &options, err);
    if (!made) return false;
    wr_field_free(piece->heights);
    piece->heights = made;
    return true;
}

/* Give the layer the heights and the coverage of the piece, inside the selection. */
static void put_piece(WrSession *session, WrLayer *layer, const WrLayer *piece)
{
    const WrField *selection = session->state.document->selection;
    wr_session_put_field(session, &layer->heights, wr_field_share(piece->heights));
    if (!layer->cover) return;
    if (piece->cover) {
        wr_session_put_field(session, &layer->cover, wr_field_share(piece->cover));
    } else if (selection) {
        wr_edit_mark(layer->cover, selection);
    } else {
        wr_field_free(layer->cover);
        layer->cover = NULL;
    }
}

static bool run_link(WrSession *session, WrCall *call, WrError *err)
{
    const WrDocument *document = session->state.document;
    const int index = document->active;
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer || !wr_session_name_source(session, index, index + 1, call, err)) return false;
    const int source = find_named(document, index, index + 1, wr_call_arg(call, SOURCE)->text);
    WrLayer piece = wr_layer_share(content_of(session, source));
    wr_field_free(piece.mask);
    piece.mask = NULL;
    const bool good = place(session, call, &piece, err) && multiply(session, call, &piece, err);
    if (good) put_piece(session, layer, &piece);
    wr_layer_fini(&piece);
    return good;
}

static const WrArgSpec args_link[] = {
    { PLACE(SOURCE), .type = WR_ARG_LAYER, .help = "the layer or group to copy, above or below" },
    { .name = "shift",
      .type = WR_ARG_TUPLE,
      .components = 2,
      .shape = "du,dv",
      .low = -4,
      .high = 4,
      .fallback = NUMBERS(0, 0),
      .help = "offset to the right and up, in widths and heights of the table" },
    WR_TRANSFORM_ARGS("rotation about the table's centre, anticlockwise"),
    { .name = "factor",
      .type = WR_ARG_NUMBER,
      .low = -WR_BIG_HEIGHT,
      .high = WR_BIG_HEIGHT,
      .fallback = NUMBERS(1),
      .help = "factor of the heights" },
    { 0 }
};

const WrCommand wr_command_link = {
    .name = VERB,
    .kind = WR_CLASS_EDIT,
    .args = args_link,
    .run = run_link,
    .generates = true,
    .links = true,
    .help = "copy the heights and the coverage of another layer or group",
    .details = "As the command of a generator layer it is a linked copy, updated when that layer "
               "changes; `layer duplicate linked=on` makes one. The arguments are those of "
               "`transform` without a selection. If several layers have the name, the nearest "
               "below is used, else the nearest above.",
    .example = "link base shift=0.5,0 factor=0.5"
};

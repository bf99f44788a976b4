/* Undo history of a document, and the history of its views. */
#include "document/history.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/objects.h"
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>

/* ---- memory cost of a step ---- */

/* Memory cost of keeping two states of a document: tiles of fields that are in one but not in the other. */

#define TILE_BYTES (WR_TILE * WR_TILE * sizeof(float) + WR_ALIGN)

typedef struct Fields {
    const WrField **of; /* [count], owned; NULL for those with an equal counterpart */
    int count;
} Fields;

static void add(Fields *fields, const WrField *field)
{
    if (field) fields->of[fields->count++] = field;
}

static Fields fields_of(const WrDocument *document)
{
    Fields fields = { wr_alloc(3 * (size_t)document->layer_count + 1, sizeof *fields.of), 0 };
    for (int i = 0; i < document->layer_count; i++) {
        add(&fields, document->layers[i].heights);
        add(&fields, document->layers[i].cover);
        add(&fields, document->layers[i].mask);
    }
    add(&fields, document->selection);
    return fields;
}

typedef struct Count {
    const WrField *a, *b;
    size_t tiles;
} Count;

static void count_tile(int tx, int ty, void *ctx)
{
    Count *count = ctx;
    count->tiles += wr_field_tile(count->a, tx, ty) || wr_field_tile(count->b, tx, ty);
}

static size_t between(const WrField *a, const WrField *b)
{
    Count count = { a, b, 0 };
    wr_field_changes(a, b, count_tile, &count);
    return count.tiles * TILE_BYTES;
}

static bool same_size(const WrField *a, const WrField *b)
{
    return wr_field_width(a) == wr_field_width(b) && wr_field_height(a) == wr_field_height(b);
}

/* Removes the pairs of equal fields. Both lists have the same order, so a search continues where the last one
   ended: an edit costs one pass. */
static void drop_equal(Fields *before, Fields *after)
{
    int from = 0;
    for (int i = 0; i < before->count; i++)
        for (int n = 0; n < after->count; n++) {
            int k = (from + n) % after->count;
            if (!after->of[k] || wr_field_key(after->of[k]) != wr_field_key(before->of[i]))
                continue;
            before->of[i] = after->of[k] = NULL;
            from = (k + 1) % after->count;
            break;
        }
}

static size_t bytes_of(const WrField *field)
{
    return field ? wr_field_bytes(field) : 0;
}

/* Pictures and the meshes of one object. */
#define OWN (4 + WR_FACET_KINDS)
typedef struct Own {
    const void *of[OWN];
    size_t bytes[OWN];
} Own;

static size_t image_bytes(const WrImage *image)
{
    if (!image) return 0;
    return (size_t)image->width * (size_t)image->height * (size_t)image->channels * sizeof(float);
}

static Own own_of(const WrScene *object)
{
    const WrTriangles *mesh = object->triangles, *source = object->mesh_source;
    const WrImage *const rough = object->facets[WR_FACET_ROUGHNESS].image;
    const WrImage *const metal = object->facets[WR_FACET_METALNESS].image;
    return (Own){ .of = { object->colour, object->normals.image, rough, metal, mesh, source },
                  .bytes = { image_bytes(object->colour), image_bytes(object->normals.image),
                             image_bytes(rough), image_bytes(metal),
                             mesh ? wr_scene_mesh_bytes(mesh) : 0,
                             source ? wr_scene_mesh_bytes(source) : 0 } };
}

static bool has(const WrScene *scene, const void *thing)
{
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const Own own = own_of(wr_scene_object(scene, i));
        for (int k = 0; k < OWN; k++)
            if (own.of[k] == thing) return true;
    }
    return false;
}

/* Bytes owned by the objects of one scene and by none of the other. */
static size_t own_bytes(const WrScene *scene, const WrScene *other)
{
    size_t bytes = 0;
    for (int i = 0; i < wr_scene_object_count(scene); i++) {
        const Own own = own_of(wr_scene_object(scene, i));
        for (int k = 0; k < OWN; k++)
            if (own.of[k] && !has(other, own.of[k])) bytes += own.bytes[k];
    }
    return bytes;
}

/*     bytes = tiles of fields that differ + pictures and meshes of one state only + layer records
   Tiles shared by both states cost nothing, as fields are copied on write. Fields are paired by key first; the rest are the
   edited ones and are paired in order, which is right for an edit that inserts no layer. A wrong pair only makes the estimate
   larger or smaller; nothing is freed by it. */
size_t wr_document_difference(const WrDocument *before, const WrDocument *after)
{
    Fields a = fields_of(before), b = fields_of(after);
    size_t bytes = sizeof *before + own_bytes(before->scene, after->scene) +
                   own_bytes(after->scene, before->scene) +
                   (size_t)before->layer_count * (sizeof(WrLayer) + 4 * WR_ALIGN);
    drop_equal(&a, &b);
    int k = 0;
    for (int i = 0; i < a.count; i++) { /* the remaining fields are compared in order */
        if (!a.of[i]) continue;
        while (k < b.count && !b.of[k]) k++;
        bool pair = k < b.count && same_size(a.of[i], b.of[k]);
        bytes += pair ? between(a.of[i], b.of[k]) : bytes_of(a.of[i]);
        if (pair) b.of[k] = NULL;
    }
    for (k = 0; k < b.count; k++) bytes += bytes_of(b.of[k]);
    wr_free(a.of);
    wr_free(b.of);
    return bytes;
}

/* ---- states and steps ---- */

/* Texts of a step. Reference-counted, because they outlive changes of the step. */
typedef struct Words {
    int refs;            /* atomic */
    char *line, *folder; /* owned */
} Words;

/* Shared by a history and its snapshots: modified only after make_own. */
typedef struct Step {
    int refs; /* atomic */
    Words *words;
    size_t bytes;      /* memory that its two states do not share */
    WrDocument *after; /* NULL: discarded */
    uint64_t mark;
    bool brings_view; /* its two states have different views */
    bool off;
    double seconds;
    char *choices; /* in the state after it; owned; NULL: none */
} Step;

/* State k is the document after k steps; step k leads from state k to state k + 1. States below `oldest` are discarded to
   stay within `budget`; 0 <= oldest <= position <= count. */
struct WrHistory {
    WrDocument *start; /* state 0, owned; NULL: discarded */
    uint64_t start_mark;
    WR_ARRAY(Step *) steps;
    int position, oldest;
    size_t budget, bytes; /* bytes: of steps oldest..count - 1 */
    char *start_choices;  /* as Step.choices */
    /* The list that this one revised, and one that revised this one: owned by the present history, and each by its neighbour
       nearer to it. */
    WrHistory *earlier, *later;
    int revised;          /* position at the end of the revision; -1: it is not one */
    size_t earlier_bytes; /* of the steps of all earlier lists that are not in this one */
    int counts_there
        [2]; /* of a snapshot: steps back and forward over its ends, which it does not keep */
};

/* Steps forward over the start of a later list and in it. */
static int forward_from(const WrHistory *later)
{
    const int own = 1 + later->steps.count - later->revised;
    return later->later ? own + forward_from(later->later) : own;
}

WrHistory *wr_history_new(const WrDocument *start, uint64_t mark, size_t budget)
{
    WrHistory *history = wr_alloc(1, sizeof *history);
    history->start = wr_document_snapshot(start);
    history->start_mark = mark;
    history->budget = budget;
    history->revised = -1;
    return history;
}

static bool is_last_of(int *refs)
{
    return __atomic_sub_fetch(refs, 1, __ATOMIC_ACQ_REL) == 0;
}

static void free_step(Step *step)
{
    if (!is_last_of(&step->refs)) return;
    wr_document_free(step->after);
    wr_free(step->choices);
    if (is_last_of(&step->words->refs)) {
        wr_free(step->words->line);
        wr_free(step->words->folder);
        wr_free(step->words);
    }
    wr_free(step);
}

/* Step k for modification: no longer shared with a snapshot. Snapshots hold references to the same steps and are read by
   another thread (saving): a step with refs > 1 is never written. The count can fall to 1 meanwhile, not rise, since only the
   owner of the history makes snapshots; a step copied needlessly is the worst case. */
static Step *make_own(WrHistory *history, int k)
{
    Step *step = history->steps.data[k];
    if (__atomic_load_n(&step->refs, __ATOMIC_ACQUIRE) == 1) return step;
    Step *own = wr_alloc(1, sizeof *own);
    *own = *step;
    own->refs = 1;
    own->after = step->after ? wr_document_snapshot(step->after) : NULL;
    own->choices = wr_strdup(step->choices);
    __atomic_add_fetch(&own->words->refs, 1, __ATOMIC_RELAXED);
    free_step(step);
    history->steps.data[k] = own;
    return own;
}

void wr_history_free(WrHistory *history)
{
    if (!history) return;
    wr_history_free(history->earlier);
    wr_history_free(history->later);
    wr_free(history->start_choices);
    for (int i = 0; i < history->steps.count; i++) free_step(history->steps.data[i]);
    wr_array_free(&history->steps);
    wr_document_free(history->start);
    wr_free(history);
}

/* A history with the same first steps, and no others before and after it. */
static WrHistory *share(const WrHistory *history, int count)
{
    WrHistory *other = wr_alloc(1, sizeof *other);
    *other = *history;
    other->start = history->start ? wr_document_snapshot(history->start) : NULL;
    other->start_choices = wr_strdup(history->start_choices);
    other->earlier = other->later = NULL;
    memset(&other->steps, 0, sizeof other->steps);
    for (int i = 0; i < count; i++) {
        Step *step = history->steps.data[i];
        __atomic_add_fetch(&step->refs, 1, __ATOMIC_RELAXED);
        wr_array_push(&other->steps, step);
    }
    return other;
}

WrHistory *wr_history_snapshot(const WrHistory *history)
{
    WrHistory *still = share(history, history->steps.count);
    still->counts_there[0] = history->earlier ? 1 + wr_history_undo_count(history->earlier) : 0;
    still->counts_there[1] = history->later ? forward_from(history->later) : 0;
    return still;
}

static const WrDocument *state_at(const WrHistory *history, int state)
{
    return state == 0 ? history->start : history->steps.data[state - 1]->after;
}

/* A state for modification. */
static WrDocument **own_state(WrHistory *history, int state)
{
    return state == 0 ? &history->start : &make_own(history, state - 1)->after;
}

/* Removes the last step with its line. */
static void drop_last(WrHistory *history)
{
    Step *last = history->steps.data[history->steps.count - 1];
    history->bytes -= last->bytes;
    free_step(last);
    history->steps.count--;
}

/* Forget the list that this one revised, and those that it leads to. */
static void forget_earlier(WrHistory *history)
{
    wr_history_free(history->earlier);
    history->earlier = NULL;
    history->earlier_bytes = 0;
    history->revised = -1;
}

static void keep_to_budget(WrHistory *history)
{
    const bool settled = history->revised >= 0; /* it is not being made */
    if (settled && history->bytes + history->earlier_bytes > history->budget &&
        history->position != history->revised)
        forget_earlier(history);
    while (history->bytes > history->budget && history->oldest < history->position - 1) {
        WrDocument **state = own_state(history, history->oldest);
        wr_document_free(*state);
        *state = NULL;
        Step *step = make_own(history, history->oldest++);
        history->bytes -= step->bytes;
        step->bytes = 0;
    }
    while (history->bytes > history->budget && history->steps.count > history->position)
        drop_last(history);
}

void wr_history_push(WrHistory *history, const WrDocument *document, const char *line,
                     const char *folder, uint64_t mark)
{
    while (history->steps.count > history->position) drop_last(history);
    wr_history_free(history->later);
    history->later = NULL;
    if (history->position < history->revised) forget_earlier(history); /* that state is gone */
    const WrDocument *before = state_at(history, history->position);
    WrSceneView old = wr_scene_view(before->scene), now = wr_scene_view(document->scene);
    Step *step = wr_alloc(1, sizeof *step);
    Words *words = wr_alloc(1, sizeof *words);
    *words = (Words){ .refs = 1, .line = wr_strdup(line), .folder = wr_strdup(folder) };
    *step = (Step){ .refs = 1,
                    .words = words,
                    .bytes = wr_document_difference(before, document),
                    .after = wr_document_snapshot(document),
                    .mark = mark,
                    .brings_view = !wr_scene_view_equal(&old, &now) };
    wr_array_push(&history->steps, step);
    history->position++;
    history->bytes += step->bytes;
    keep_to_budget(history);
}

void wr_history_note_step(WrHistory *history, double seconds, bool off)
{
    WR_ASSERT(history->position > 0);
    Step *step = make_own(history, history->position - 1);
    step->seconds = seconds;
    step->off = off;
}

double wr_history_step_seconds(const WrHistory *history, int step)
{
    WR_ASSERT(step >= 0 && step < history->steps.count);
    return history->steps.data[step]->seconds;
}

bool wr_history_is_off(const WrHistory *history, int step)
{
    WR_ASSERT(step >= 0 && step < history->steps.count);
    return history->steps.data[step]->off;
}

int wr_history_count(const WrHistory *history)
{
    return history->steps.count;
}

int wr_history_position(const WrHistory *history)
{
    return history->position;
}

int wr_history_oldest(const WrHistory *history)
{
    return history->oldest;
}

const char *wr_history_line(const WrHistory *history, int step)
{
    WR_ASSERT(step >= 0 && step < history->steps.count);
    return history->steps.data[step]->words->line;
}

const char *wr_history_folder(const WrHistory *history, int step)
{
    WR_ASSERT(step >= 0 && step < history->steps.count);
    return history->steps.data[step]->words->folder;
}

size_t wr_history_step_bytes(const WrHistory *history, int step)
{
    WR_ASSERT(step >= 0 && step < history->steps.count);
    return history->steps.data[step]->bytes;
}

size_t wr_history_bytes(const WrHistory *history)
{
    return history->bytes;
}

uint64_t wr_history_mark(const WrHistory *history)
{
    return history->position == 0 ? history->start_mark
                                  : history->steps.data[history->position - 1]->mark;
}

/* ---- views ---- */

void wr_history_record_view(WrHistory *history, const WrDocument *document)
{
    WrDocument **present = own_state(history, history->position);
    wr_document_free(*present);
    *present = wr_document_snapshot(document);
}

/* The lines without those equal to this one: it is added behind the others. The caller frees them. */
static char *lines_without(const char *lines, const char *line)
{
    WrText kept = { 0 };
    for (const char *p = lines; *p; p += strcspn(p, "\n") + 1) {
        const size_t length = strcspn(p, "\n");
        if (strlen(line) != length || strncmp(p, line, length) != 0)
            wr_text_add_n(&kept, p, length + 1);
    }
    char *text = wr_strdup(wr_text_get(&kept));
    wr_text_fini(&kept);
    return text;
}

void wr_history_record_choice(WrHistory *history, const WrDocument *document, const char *line)
{
    WrText text = { 0 };
    char **choices = history->position == 0 ? &history->start_choices
                                            : &make_own(history, history->position - 1)->choices;
    char *kept = lines_without(*choices ? *choices : "", line);
    wr_history_record_view(history, document);
    wr_text_addf(&text, "%s%s\n", kept, line);
    wr_free(kept);
    wr_free(*choices);
    *choices = wr_strdup(wr_text_get(&text));
    wr_text_fini(&text);
}

const char *wr_history_choices(const WrHistory *history, int state)
{
    WR_ASSERT(state >= 0 && state <= history->steps.count);
    const char *choices =
        state == 0 ? history->start_choices : history->steps.data[state - 1]->choices;
    return choices ? choices : "";
}

bool wr_history_view(const WrHistory *history, int state, WrSceneView *view)
{
    WR_ASSERT(state >= 0 && state <= history->steps.count);
    const WrDocument *document = state_at(history, state);
    if (document) *view = wr_scene_view(document->scene);
    return document != NULL;
}

const WrDocument *wr_history_document(const WrHistory *history, int state)
{
    WR_ASSERT(state >= 0 && state <= history->steps.count);
    return state_at(history, state);
}

const WrField *wr_history_heights(const WrHistory *history, int state)
{
    const WrDocument *document = wr_history_document(history, state);
    if (!document) return NULL;
    int layer = document->active;
    while (layer > 0 && !wr_layer_holds(&document->layers[layer])) layer--;
    return document->layers[layer].heights;
}

bool wr_history_restores_view(const WrHistory *history, int step)
{
    WR_ASSERT(step >= 0 && step < history->steps.count);
    return history->steps.data[step]->brings_view;
}

/* The view after going to `state`: the view on the near side of the last step on the way that changed it, else
   the current view. */
static WrSceneView view_there(const WrHistory *history, int state)
{
    Step *const *steps = history->steps.data;
    int side = history->position;
    for (int k = history->position - 1; k >= state; k--)
        if (steps[k]->brings_view) side = k;
    for (int k = history->position; k < state; k++)
        if (steps[k]->brings_view) side = k + 1;
    return wr_scene_view(state_at(history, side)->scene);
}

static void look(WrDocument *document, const WrSceneView *view)
{
    WrSceneView old = wr_scene_view(document->scene);
    if (wr_scene_view_equal(&old, view)) return;
    WrScene *scene = wr_scene_clone(document->scene);
    wr_scene_set_pose(scene, view);
    wr_scene_free(document->scene);
    document->scene = scene;
}

WrDocument *wr_history_go(WrHistory *history, int state)
{
    WR_ASSERT(state >= history->oldest && state <= history->steps.count);
    WrSceneView view = view_there(history, state);
    history->position = state;
    WrDocument *present = *own_state(history, state);
    look(present, &view);
    return wr_document_snapshot(present);
}

/* ---- revised lists of steps ---- */

WrHistory *wr_history_revise(WrHistory *history, int state)
{
    WR_ASSERT(state >= history->oldest && state <= history->position);
    WrHistory *revision = share(history, state);
    for (int k = state; k < history->steps.count; k++) {
        revision->bytes -= history->steps.data[k]->bytes;
        if (k < history->position) revision->earlier_bytes += history->steps.data[k]->bytes;
    }
    revision->earlier = history;
    revision->position = state;
    revision->revised = -1;
    return revision;
}

void wr_history_revised(WrHistory *history)
{
    WrHistory *earlier = history->earlier;
    while (earlier->steps.count > earlier->position) drop_last(earlier);
    wr_history_free(earlier->later);
    earlier->later = NULL;
    history->revised = history->position;
    keep_to_budget(history);
}

WrHistory *wr_history_take_back(WrHistory *history)
{
    WrHistory *earlier = history->earlier;
    history->earlier = NULL;
    wr_history_free(history);
    return earlier;
}

/* The steps back end at the revision rather than at the oldest state. */
static bool revision_behind(const WrHistory *history)
{
    return history->revised >= history->oldest && history->revised <= history->position;
}

int wr_history_list_end(const WrHistory *history)
{
    return revision_behind(history) ? history->revised : history->oldest;
}

int wr_history_undo_count(const WrHistory *history)
{
    if (!revision_behind(history)) return history->position - history->oldest;
    const int there =
        history->earlier ? 1 + wr_history_undo_count(history->earlier) : history->counts_there[0];
    return history->position - history->revised + there;
}

int wr_history_redo_count(const WrHistory *history)
{
    const int there = history->later ? forward_from(history->later) : history->counts_there[1];
    return history->steps.count - history->position + there;
}

/* Makes the neighbour the present list. Its view becomes the present one. */
static WrHistory *cross(WrHistory *history, bool back)
{
    const WrSceneView view = wr_scene_view(state_at(history, history->position)->scene);
    WrHistory *other = back ? history->earlier : history->later;
    if (back) {
        history->earlier = NULL;
        other->later = history;
    } else {
        history->later = NULL;
        other->earlier = history;
        other->position = other->revised;
    }
    look(*own_state(other, other->position), &view);
    return other;
}

WrDocument *wr_history_travel(WrHistory **history, int steps)
{
    while (steps != 0) {
        WrHistory *now = *history;
        const bool back = steps < 0;
        const int limit = back ? wr_history_list_end(now) : now->steps.count;
        const int room = abs(limit - now->position), wish = abs(steps);
        const int count = room == 0 ? 1 : wish < room ? wish : room;
        if (room == 0) *history = cross(now, back);
        else wr_document_free(wr_history_go(now, now->position + (back ? -count : count)));
        steps += back ? count : -count;
    }
    return wr_history_go(*history, (*history)->position);
}

void wr_history_set_budget(WrHistory *history, size_t bytes)
{
    history->budget = bytes;
    keep_to_budget(history);
}

/* ---- history of views ---- */

struct WrViews {
    WrSceneView start;
    WR_ARRAY(WrSceneView) list; /* oldest first */
    int position;               /* of the current one */
    int64_t given_up;
};

WrViews *wr_views_new(const WrSceneView *start)
{
    WrViews *views = wr_alloc(1, sizeof *views);
    views->start = *start;
    wr_array_push(&views->list, *start);
    return views;
}

void wr_views_free(WrViews *views)
{
    if (!views) return;
    wr_array_free(&views->list);
    wr_free(views);
}

WrViews *wr_views_clone(const WrViews *views)
{
    WrViews *clone = wr_alloc(1, sizeof *clone);
    *clone = *views;
    memset(&clone->list, 0, sizeof clone->list);
    for (int i = 0; i < views->list.count; i++) wr_array_push(&clone->list, views->list.data[i]);
    return clone;
}

void wr_views_make_current(WrViews *views, const WrSceneView *view)
{
    if (wr_scene_view_equal(&views->list.data[views->position], view)) return;
    views->list.count = views->position + 1;
    if (views->list.count == WR_VIEWS_MAX) {
        memmove(views->list.data, views->list.data + 1,
                (WR_VIEWS_MAX - 1) * sizeof *views->list.data);
        views->list.count--;
        views->given_up++;
    }
    wr_array_push(&views->list, *view);
    views->position = views->list.count - 1;
}

int wr_views_back(const WrViews *views)
{
    return views->position;
}

int wr_views_forward(const WrViews *views)
{
    return views->list.count - 1 - views->position;
}

WrSceneView wr_views_go(WrViews *views, int steps)
{
    WR_ASSERT(steps >= -wr_views_back(views) && steps <= wr_views_forward(views));
    views->position += steps;
    return views->list.data[views->position];
}

int64_t wr_views_number(const WrViews *views)
{
    return views->given_up + views->position;
}

WrSceneView wr_views_start(const WrViews *views)
{
    return views->start;
}

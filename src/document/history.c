#include "document/history.h"

#include "base/array.h"
#include "base/error.h"
#include "document/document.h"
#include "scene/scene.h"

#include <string.h>

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
} Step;

struct WrHistory {
    WrDocument *start; /* state 0, owned; NULL: discarded */
    uint64_t start_mark;
    WR_ARRAY(Step *) steps;
    int position, oldest;
    size_t budget, bytes; /* bytes: of steps oldest..count - 1 */
};

WrHistory *wr_history_new(const WrDocument *start, uint64_t mark, size_t budget)
{
    WrHistory *history = wr_alloc(1, sizeof *history);
    history->start = wr_document_snapshot(start);
    history->start_mark = mark;
    history->budget = budget;
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
    if (is_last_of(&step->words->refs)) {
        wr_free(step->words->line);
        wr_free(step->words->folder);
        wr_free(step->words);
    }
    wr_free(step);
}

/* Step k for modification: no longer shared with a snapshot. */
static Step *make_own(WrHistory *history, int k)
{
    Step *step = history->steps.data[k];
    if (__atomic_load_n(&step->refs, __ATOMIC_ACQUIRE) == 1) return step;
    Step *own = wr_alloc(1, sizeof *own);
    *own = *step;
    own->refs = 1;
    own->after = step->after ? wr_document_snapshot(step->after) : NULL;
    __atomic_add_fetch(&own->words->refs, 1, __ATOMIC_RELAXED);
    free_step(step);
    history->steps.data[k] = own;
    return own;
}

void wr_history_free(WrHistory *history)
{
    if (!history) return;
    for (int i = 0; i < history->steps.count; i++) free_step(history->steps.data[i]);
    wr_array_free(&history->steps);
    wr_document_free(history->start);
    wr_free(history);
}

WrHistory *wr_history_snapshot(const WrHistory *history)
{
    WrHistory *still = wr_alloc(1, sizeof *still);
    *still = *history;
    still->start = history->start ? wr_document_snapshot(history->start) : NULL;
    memset(&still->steps, 0, sizeof still->steps);
    for (int i = 0; i < history->steps.count; i++) {
        Step *step = history->steps.data[i];
        __atomic_add_fetch(&step->refs, 1, __ATOMIC_RELAXED);
        wr_array_push(&still->steps, step);
    }
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

static void keep_to_budget(WrHistory *history)
{
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

void wr_history_look(WrHistory *history, const WrDocument *document)
{
    WrDocument **present = own_state(history, history->position);
    wr_document_free(*present);
    *present = wr_document_snapshot(document);
}

bool wr_history_view(const WrHistory *history, int state, WrSceneView *view)
{
    WR_ASSERT(state >= 0 && state <= history->steps.count);
    const WrDocument *document = state_at(history, state);
    if (document) *view = wr_scene_view(document->scene);
    return document != NULL;
}

const WrField *wr_history_heights(const WrHistory *history, int state)
{
    WR_ASSERT(state >= 0 && state <= history->steps.count);
    const WrDocument *document = state_at(history, state);
    if (!document) return NULL;
    int layer = document->active;
    while (layer > 0 && document->layers[layer].filter.op) layer--;
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
    wr_scene_set_view(scene, view);
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

void wr_history_set_budget(WrHistory *history, size_t bytes)
{
    history->budget = bytes;
    keep_to_budget(history);
}

#include "document/history.h"

#include "base/array.h"

typedef struct Step {
    char *line, *folder; /* owned */
    size_t bytes;        /* of what its two states do not share */
    WrDocument *after;   /* NULL: given up */
    uint64_t mark;
} Step;

struct WrHistory {
    WrDocument *start; /* state 0; NULL: given up */
    uint64_t start_mark;
    WR_ARRAY(Step) steps;
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

static void fini_step(Step *step)
{
    wr_free(step->line);
    wr_free(step->folder);
    wr_document_free(step->after);
}

void wr_history_free(WrHistory *history)
{
    if (!history) return;
    for (int i = 0; i < history->steps.count; i++) fini_step(&history->steps.data[i]);
    wr_array_free(&history->steps);
    wr_document_free(history->start);
    wr_free(history);
}

static WrDocument **state_at(WrHistory *history, int state)
{
    return state == 0 ? &history->start : &history->steps.data[state - 1].after;
}

/* The last step goes, line and all. */
static void drop_last(WrHistory *history)
{
    Step *last = &history->steps.data[history->steps.count - 1];
    history->bytes -= last->bytes;
    fini_step(last);
    history->steps.count--;
}

static void keep_to_budget(WrHistory *history)
{
    while (history->bytes > history->budget && history->oldest < history->position - 1) {
        WrDocument **state = state_at(history, history->oldest);
        wr_document_free(*state);
        *state = NULL;
        Step *step = &history->steps.data[history->oldest++];
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
    Step step = { .line = wr_strdup(line),
                  .folder = wr_strdup(folder),
                  .bytes = wr_document_difference(*state_at(history, history->position), document),
                  .after = wr_document_snapshot(document),
                  .mark = mark };
    wr_array_push(&history->steps, step);
    history->position++;
    history->bytes += step.bytes;
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
    return history->steps.data[step].line;
}

const char *wr_history_folder(const WrHistory *history, int step)
{
    WR_ASSERT(step >= 0 && step < history->steps.count);
    return history->steps.data[step].folder;
}

size_t wr_history_step_bytes(const WrHistory *history, int step)
{
    WR_ASSERT(step >= 0 && step < history->steps.count);
    return history->steps.data[step].bytes;
}

size_t wr_history_bytes(const WrHistory *history)
{
    return history->bytes;
}

uint64_t wr_history_mark(const WrHistory *history)
{
    return history->position == 0 ? history->start_mark
                                  : history->steps.data[history->position - 1].mark;
}

WrDocument *wr_history_go(WrHistory *history, int state)
{
    WR_ASSERT(state >= history->oldest && state <= history->steps.count);
    history->position = state;
    return wr_document_snapshot(*state_at(history, state));
}

size_t wr_history_budget(const WrHistory *history)
{
    return history->budget;
}

void wr_history_set_budget(WrHistory *history, size_t bytes)
{
    history->budget = bytes;
    keep_to_budget(history);
}

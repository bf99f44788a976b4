#include "ui/canvas/outline.h"
#include "ui/app/jobs/job.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "document/document.h"
#include "field/field.h"
#include "field/select.h"
#include "scene/scene.h"

#include <SDL.h>
#include <math.h>

typedef struct Work {
    WrDocument *document; /* a snapshot */
    WrOutlineRequest ask;
    WrOutline outline; /* the result */
    bool made;
} Work;

struct WrOutliner {
    WrJob *job;
    WrOutline outline; /* newest result */
    bool there;
    uint64_t serial;
};

static void drop(void *arg)
{
    Work *work = arg;
    wr_document_free(work->document);
    wr_outline_fini(&work->outline);
    wr_free(work);
}

/* ---- on the worker thread ---- */

/* Selection by slope as in the select command, with the default height scale. */
static WrField *by_slope(const Work *work, const WrField *field, WrPool *pool)
{
    double relief = fabs(work->document->scene->height) * wr_field_width(field);
    return wr_select_slope(field, relief, work->ask.low, work->ask.high, work->ask.soft, pool,
                           NULL);
}

static WrField *join(const Work *work, WrField *made)
{
    if (!made || work->ask.mode == WR_SELECT_REPLACE) return made;
    WrField *joined = wr_select_combine(work->document->selection, made, work->ask.mode, NULL);
    wr_field_free(made);
    return joined;
}

static WrField *make(const Work *work, WrPool *pool)
{
    const WrOutlineRequest *ask = &work->ask;
    const WrField *now = work->document->selection;
    if (ask->kind == WR_OUTLINE_HEIGHT || ask->kind == WR_OUTLINE_SLOPE) {
        const WrField *field = wr_document_composite(work->document, pool);
        if (ask->kind == WR_OUTLINE_SLOPE) return join(work, by_slope(work, field, pool));
        return join(work, wr_select_height(field, ask->low, ask->high, ask->soft, pool, NULL));
    }
    if (!now) return NULL;
    switch (ask->kind) {
    case WR_OUTLINE_GROW: return wr_select_grow(now, ask->by, pool, NULL);
    case WR_OUTLINE_SHRINK: return wr_select_shrink(now, ask->by, pool, NULL);
    case WR_OUTLINE_FEATHER: return wr_select_feather(now, ask->by, pool, NULL);
    default: return wr_field_share(now);
    }
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    Work *work = arg;
    WrField *selection = make(work, pool);
    if (selection && !wr_progress_cancelled(progress))
        work->made = wr_select_outline(selection, &work->outline, NULL);
    wr_field_free(selection);
}

/* ---- on the window's thread ---- */

WrOutliner *wr_outliner_new(int threads, Uint32 done_event)
{
    static const WrJobKind kind = { run, drop };
    WrOutliner *outliner = wr_alloc(1, sizeof *outliner);
    outliner->job = wr_job_new(&kind, threads, done_event);
    return outliner;
}

void wr_outliner_free(WrOutliner *outliner)
{
    if (!outliner) return;
    wr_job_free(outliner->job);
    wr_outline_fini(&outliner->outline);
    wr_free(outliner);
}

void wr_outliner_request(WrOutliner *outliner, const WrDocument *document,
                         const WrOutlineRequest *ask)
{
    Work *work = wr_alloc(1, sizeof *work);
    work->document = wr_document_share(document);
    work->ask = *ask;
    wr_job_start(outliner->job, work);
}

static void put(WrOutliner *outliner, WrOutline outline, bool there)
{
    wr_outline_fini(&outliner->outline);
    outliner->outline = outline;
    outliner->there = there;
    outliner->serial++;
}

void wr_outliner_clear(WrOutliner *outliner)
{
    wr_job_cancel(outliner->job);
    if (outliner->there) put(outliner, (WrOutline){ 0 }, false);
}

const WrOutline *wr_outliner_get(WrOutliner *outliner, uint64_t *serial)
{
    Work *work = wr_job_take(outliner->job);
    if (work) {
        put(outliner, work->outline, work->made);
        work->outline = (WrOutline){ 0 };
        drop(work);
    }
    *serial = outliner->serial;
    return outliner->there ? &outliner->outline : NULL;
}

bool wr_outliner_busy(WrOutliner *outliner, double *fraction, double *seconds)
{
    return wr_job_busy(outliner->job, fraction, seconds);
}

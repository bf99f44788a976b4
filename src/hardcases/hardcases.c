/* The table of hard cases and its runner. */
#include "hardcases/hardcases.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "hardcases/hardcases_internal.h"
#include "system/clock.h"

#include <string.h>

WR_ROWS(wr_hard_subjects);
const char *const wr_hard_subjects[WR_HARD_SUBJECTS] = {
    [WR_ROW(WR_HARD_GEOMETRY)] = "geometry and normals",
    [WR_ROW(WR_HARD_TABLE)] = "table lookup",
    [WR_ROW(WR_HARD_NOISE)] = "noise",
    [WR_ROW(WR_HARD_PAINT)] = "painting, stamping, text",
    [WR_ROW(WR_HARD_RENDER)] = "rendering",
};
WR_ROWS_END(wr_hard_subjects, WR_HARD_SUBJECTS);

WR_ROWS(wr_hard_verdicts);
const char *const wr_hard_verdicts[WR_HARD_VERDICTS] = {
    [WR_ROW(WR_HARD_PASS)] = "pass",
    [WR_ROW(WR_HARD_FAIL)] = "fail",
    [WR_ROW(WR_HARD_WAITS)] = "waits",
    [WR_ROW(WR_HARD_UNMEASURED)] = "unmeasured",
};
WR_ROWS_END(wr_hard_verdicts, WR_HARD_VERDICTS);

#define ONE_LIST(name) &wr_hard_##name,
static const WrHardList *const lists[] = { WR_HARD_ROWS(ONE_LIST) };
#undef ONE_LIST

const WrHardCase *wr_hardcase(int index)
{
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        if (index < lists[k]->count) return &lists[k]->rows[index];
        index -= lists[k]->count;
    }
    return NULL;
}

const WrHardCase *wr_hardcase_find(const char *id)
{
    for (int i = 0; i < WR_HARDCASES; i++) {
        const WrHardCase *row = wr_hardcase(i);
        if (row && strcmp(row->id, id) == 0) return row;
    }
    return NULL;
}

/* ---- running ---- */

static WrHardVerdict judge(const WrHardCase *row, const WrHardGauge *gauge)
{
    for (int p = 0; p < WR_HARD_PRECISIONS; p++) {
        if (isnan(row->bound[p])) continue;
        if (gauge->checks[p] == 0 || !(gauge->worst[p] <= row->bound[p])) return WR_HARD_FAIL;
    }
    return row->waits ? WR_HARD_WAITS : WR_HARD_PASS;
}

static bool set_up(WrHardGauge *gauge, const WrHardRequest *request, WrError *err)
{
    *gauge = (WrHardGauge){ .isa = request->isa, .pool = request->pool, .random = 1978 };
    memcpy(gauge->nudge, request->nudge, sizeof gauge->nudge);
    gauge->kernels[0] = wr_kernels_get("ref", false, err);
    gauge->kernels[1] = wr_kernels_get(request->isa, false, err);
    if (!gauge->kernels[0] || !gauge->kernels[1]) return false;
    gauge->sets = gauge->kernels[0] == gauge->kernels[1] ? 1 : 2;
    gauge->kernels[gauge->sets] = wr_kernels_get(request->isa, true, err);
    gauge->all = gauge->kernels[gauge->sets]->exact ? gauge->sets : gauge->sets + 1;
    gauge->wide[0] = wr_kernels_double("ref", err);
    gauge->wide[1] = wr_kernels_double(request->isa, err);
    gauge->strip = wr_alloc(1, sizeof *gauge->strip);
    gauge->wide_strip = wr_alloc(1, sizeof *gauge->wide_strip);
    return true;
}

bool wr_hardcase_run(const WrHardCase *row, const WrHardRequest *request, WrHardResult *out,
                     WrError *err)
{
    const double start = wr_clock_seconds();
    WrHardGauge gauge;
    WrHardResult result = { .row = row, .verdict = WR_HARD_WAITS, .worst = { NAN, NAN } };
    if (!set_up(&gauge, request, err)) return false;
    if (row->measure) {
        WrError why = { "" };
        bool done = row->measure(&gauge, &why);
        result.verdict = done ? judge(row, &gauge) : WR_HARD_UNMEASURED;
        if (!done) snprintf(result.note, sizeof result.note, "%.255s", why.text);
        for (int p = 0; p < WR_HARD_PRECISIONS && done; p++) {
            if (gauge.checks[p] > 0) result.worst[p] = gauge.worst[p];
            result.checks[p] = gauge.checks[p];
        }
    }
    wr_free(gauge.strip);
    wr_free(gauge.wide_strip);
    result.seconds = wr_clock_seconds() - start;
    *out = result;
    return true;
}

bool wr_hardcases_run(const WrHardRequest *request, WrHardReport *out, WrError *err)
{
    const double start = wr_clock_seconds();
    const WrProgress *whole = request->progress ? request->progress : wr_progress_here();
    WrHardReport *report = wr_alloc(1, sizeof *report);
    bool good = true;
    for (int i = 0; i < WR_HARDCASES && good; i++) {
        if (!wr_progress_step(request->progress, (double)i / WR_HARDCASES)) {
            good = wr_fail(err, "cancelled");
            break;
        }
        /* A case reports progress from 0 to 1, which is one part of the whole here. */
        WrProgressPart part;
        const WrProgress *outer = wr_progress_set(wr_progress_part(
            &part, whole, (double)i / WR_HARDCASES, (double)(i + 1) / WR_HARDCASES));
        good = wr_hardcase_run(wr_hardcase(i), request, &report->results[i], err);
        wr_progress_set(outer);
        if (good) report->count[report->results[i].verdict]++;
    }
    report->seconds = wr_clock_seconds() - start;
    if (good) *out = *report;
    wr_free(report);
    return good;
}

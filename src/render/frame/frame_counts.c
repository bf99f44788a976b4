/* Cost counters of a frame, by stage and by effect. */
#include "base/memory.h"
#include "render/frame/frame_internal.h"
#include "system/clock.h"

#include <math.h>
#include <string.h>

void wr_frame_start_counts(WrRenderer *renderer)
{
    for (int i = 0; i < renderer->threads; i++) {
        if (!renderer->scratch[i]) renderer->scratch[i] = wr_alloc(1, sizeof(WrTileScratch));
        WrTileScratch *s = renderer->scratch[i];
        const bool wide = wr_plan_runs(&renderer->plan, WR_EFFECT_DOUBLE);
        if (wide && !s->wide) s->wide = wr_alloc(3, sizeof *s->wide);
        if (renderer->group && !s->nearest)
            s->nearest = wr_alloc(WR_TILE_SAMPLES_H, sizeof *s->nearest);
        memset(s->seconds, 0, sizeof s->seconds);
        memset(s->whole, 0, sizeof s->whole);
        s->all = s->all_strips = 0;
        s->covered = s->not_finite = s->shaded = s->tiles = s->wide_samples = s->wide_tints = 0;
        memset(s->spared, 0, sizeof s->spared);
        memset(s->spared_tiles, 0, sizeof s->spared_tiles);
        s->strips = 0;
        s->ran = 0;
    }
}

/* ---- time of each stage ---- */

/* Sum of all threads' counters. */
typedef struct Counts {
    int64_t tiles, shaded, filtered, tinted;
    int64_t spared[WR_RUN_KINDS], spared_tiles[WR_RUN_KINDS]; /* as in WrTileScratch */
    WrEffects ran;
} Counts;

/* Writes cost and touched samples of each effect to the plan's rows. */
static void account(WrPlan *plan, const double seconds[WR_STAGE_COUNT], const Counts *counts)
{
    const int64_t shaded = counts->shaded;
    for (int c = 0; c < WR_COST_COUNT; c++) plan->cost[c] = 0;
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow *row = &plan->rows[e];
        row->seconds = 0;
        row->ran = counts->ran >> e & 1;
        if (!row->run) continue;
        const unsigned spared = wr_effects[e].spared;
        row->tiles = counts->tiles - counts->spared_tiles[spared];
        row->pixels = e == WR_EFFECT_FILTER ? counts->filtered
                      : e == WR_EFFECT_TINT ? counts->tinted
                                            : shaded;
        for (unsigned run = 0; run < WR_RUN_KINDS; run++)
            if (run & spared) row->pixels -= counts->spared[run];
    }
    for (int stage = 0; stage < WR_STAGE_COUNT; stage++)
        wr_plan_charge(plan, (WrStage)stage, seconds[stage]);
    plan->shaded = shaded;
    for (int e = 0; e < WR_EFFECT_COUNT; e++)
        plan->rows[e].ns_per_pixel = shaded > 0 ? 1e9 * plan->rows[e].seconds / (double)shaded : 0;
}

/* Adds one thread's stage times. One strip in sixteen is measured; the total time of strips is divided in that
   ratio. Returns the rest of its tiles' time. */
static double add_thread(const WrTileScratch *s, double seconds[WR_STAGE_COUNT])
{
    double strips = 0, left = s->all;
    for (int k = 0; k < WR_STAGE_COUNT; k++) {
        strips += s->seconds[k];
        left -= s->whole[k];
    }
    left = fmax(left, 0);
    const double share = strips > 0 ? fmin(s->all_strips, left) / strips : 0;
    for (int k = 0; k < WR_STAGE_COUNT; k++) seconds[k] += s->whole[k] + share * s->seconds[k];
    return left - share * strips;
}

void wr_frame_account(WrRenderer *renderer, double prepared, double started, WrFrame *frame)
{
    double seconds[WR_STAGE_COUNT] = { 0 }, rest = 0, busy = 0;
    Counts counts = { 0 };
    WrPlan *plan = &renderer->plan;
    const double total = wr_clock_seconds() - started;
    *frame = (WrFrame){ .width = renderer->width,
                        .height = renderer->rows,
                        .first = renderer->top,
                        .of = renderer->height,
                        .plan = plan };
    if (renderer->last.codes.wanted) frame->codes = renderer->codes;
    else frame->rgba = renderer->rgba;
    for (int i = 0; i < renderer->threads; i++) {
        const WrTileScratch *s = renderer->scratch[i];
        rest += add_thread(s, seconds);
        busy += s->all;
        frame->covered += s->covered;
        frame->shaded += s->shaded;
        frame->not_finite += s->not_finite;
        counts.tiles += s->tiles;
        counts.filtered += s->wide_samples;
        counts.tinted += s->wide_tints;
        for (int run = 0; run < WR_RUN_KINDS; run++) {
            counts.spared[run] += s->spared[run];
            counts.spared_tiles[run] += s->spared_tiles[run];
        }
        counts.ran |= s->ran;
    }
    if (!wr_plan_runs(plan, WR_EFFECT_AGAIN))
        frame->covered = renderer->covered; /* heights do not change the outline */
    renderer->covered = frame->covered;
    counts.shaded = frame->shaded;
    account(plan, seconds, &counts);
    plan->work = prepared + renderer->threads * (total - prepared);
    plan->cost[WR_COST_PREPARE] += prepared;
    plan->cost[WR_COST_REST] += rest;
    plan->cost[WR_COST_WAIT] += plan->work - prepared - busy;
    frame->times = (WrStageTimes){
        .prepare = prepared,
        .visibility = seconds[WR_STAGE_VISIBILITY] + seconds[WR_STAGE_NEWTON],
        .geometry = seconds[WR_STAGE_GEOMETRY] + seconds[WR_STAGE_CURVATURE],
        .bump = seconds[WR_STAGE_FOOTPRINT] + seconds[WR_STAGE_LOOK] + seconds[WR_STAGE_PYRAMID] +
                seconds[WR_STAGE_NORMALS] + seconds[WR_STAGE_BUMP] + seconds[WR_STAGE_SPREAD],
        .shade = seconds[WR_STAGE_COLOUR] + seconds[WR_STAGE_TINT] + seconds[WR_STAGE_DIFFUSE] +
                 seconds[WR_STAGE_SPECULAR] + seconds[WR_STAGE_SURROUND] +
                 seconds[WR_STAGE_MIRROR] + seconds[WR_STAGE_SHADOW] + seconds[WR_STAGE_CAST] +
                 seconds[WR_STAGE_OCCLUSION] + seconds[WR_STAGE_LIGHT],
        .resolve = seconds[WR_STAGE_RESOLVE] + seconds[WR_STAGE_BOUND] + seconds[WR_STAGE_STORE],
        .pyramid = renderer->pyramid_seconds,
        .total = total,
    };
}

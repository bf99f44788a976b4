/* What a frame cost, by stage and by effect. */
#include "base/clock.h"
#include "base/memory.h"
#include "render/frame_inner.h"

#include <string.h>

void wr_frame_start_counts(WrRenderer *renderer)
{
    for (int i = 0; i < renderer->threads; i++) {
        if (!renderer->scratch[i]) renderer->scratch[i] = wr_alloc(1, sizeof(WrTileScratch));
        WrTileScratch *s = renderer->scratch[i];
        const bool wide =
            renderer->plan.shading_double || renderer->table.precision != WR_PRECISION_SINGLE;
        if (wide && !s->wide) s->wide = wr_alloc(3, sizeof *s->wide);
        memset(s->seconds, 0, sizeof s->seconds);
        s->covered = s->shaded = s->tiles = s->wide_samples = 0;
        s->strips = 0;
    }
}

/* What each effect cost and touched, into the plan's rows. */
static void account(WrRenderer *renderer, const double seconds[WR_STAGE_COUNT], int64_t tiles,
                    int64_t shaded, int64_t filtered)
{
    static const int stage_of[WR_EFFECT_COUNT] = {
        [WR_EFFECT_DIFFUSE] = WR_STAGE_DIFFUSE,
        [WR_EFFECT_SPECULAR] = WR_STAGE_SPECULAR,
        [WR_EFFECT_COLOUR] = WR_STAGE_COLOUR,
        [WR_EFFECT_BUMP] = WR_STAGE_BUMP,
        [WR_EFFECT_GRADIENT] = WR_STAGE_LOOK,
        [WR_EFFECT_WIDE] = -1,
        [WR_EFFECT_INVARIANT] = WR_STAGE_BUMP,
        [WR_EFFECT_EXACT] = WR_STAGE_BUMP,
        [WR_EFFECT_CURVATURE] = WR_STAGE_CURVATURE,
        [WR_EFFECT_SAMPLES] = WR_STAGE_RESOLVE,
        [WR_EFFECT_BOUND] = WR_STAGE_BOUND,
        [WR_EFFECT_FILTER] = WR_STAGE_PYRAMID,
        [WR_EFFECT_SPREAD] = -1,
        [WR_EFFECT_ROUNDED] = -1,
        [WR_EFFECT_DOUBLE] = -1,
        [WR_EFFECT_HALF] = WR_STAGE_HALF,
        [WR_EFFECT_BACK] = -1,
        [WR_EFFECT_DEPTH] = WR_STAGE_VISIBILITY,
        [WR_EFFECT_AGAIN] = -1,
        [WR_EFFECT_NEWTON] = WR_STAGE_NEWTON,
        [WR_EFFECT_PERSPECTIVE] = -1,
    };
    for (int e = 0; e < WR_EFFECT_COUNT; e++) {
        WrPlanRow *row = &renderer->plan.rows[e];
        if (!row->run) continue;
        row->tiles = tiles;
        row->pixels = shaded;
        double spent = stage_of[e] >= 0 ? seconds[stage_of[e]] : 0;
        if (e == WR_EFFECT_BUMP && !renderer->plan.gradient_table) spent += seconds[WR_STAGE_LOOK];
        if (e == WR_EFFECT_FILTER) {
            row->pixels = filtered;
            spent += seconds[WR_STAGE_FOOTPRINT];
        }
        row->ns_per_pixel = shaded > 0 ? 1e9 * spent / (double)shaded : 0;
    }
}

void wr_frame_account(WrRenderer *renderer, bool refreshed, double prepared, double started,
                      WrFrame *frame)
{
    double seconds[WR_STAGE_COUNT] = { 0 };
    int64_t tiles = 0, filtered = 0;
    *frame = (WrFrame){ .width = renderer->width,
                        .height = renderer->height,
                        .rgba = renderer->rgba,
                        .plan = &renderer->plan };
    for (int i = 0; i < renderer->threads; i++) {
        const WrTileScratch *s = renderer->scratch[i];
        for (int k = 0; k < WR_STAGE_COUNT; k++) seconds[k] += s->seconds[k];
        frame->covered += s->covered;
        frame->shaded += s->shaded;
        tiles += s->tiles;
        filtered += s->wide_samples;
    }
    if (refreshed) frame->covered = renderer->covered; /* heights do not move the outline */
    renderer->covered = frame->covered;
    account(renderer, seconds, tiles, frame->shaded, filtered);
    frame->times = (WrStageTimes){
        .prepare = prepared,
        .visibility = seconds[WR_STAGE_VISIBILITY] + seconds[WR_STAGE_NEWTON],
        .geometry = seconds[WR_STAGE_GEOMETRY] + seconds[WR_STAGE_CURVATURE],
        .bump = seconds[WR_STAGE_FOOTPRINT] + seconds[WR_STAGE_LOOK] + seconds[WR_STAGE_PYRAMID] +
                seconds[WR_STAGE_BUMP],
        .shade = seconds[WR_STAGE_COLOUR] + seconds[WR_STAGE_DIFFUSE] + seconds[WR_STAGE_SPECULAR],
        .resolve = seconds[WR_STAGE_RESOLVE] + seconds[WR_STAGE_BOUND],
        .pyramid = renderer->pyramid_seconds,
        .total = wr_clock_seconds() - started,
    };
}

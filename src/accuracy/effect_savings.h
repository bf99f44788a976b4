/* effect_savings.h - what each effect of a plan costs the picture, and what leaving it out saves: measured, by rendering
   the picture again with that effect forced the other way.
   Layer 6. Two renderers take turns, one for the picture as planned and one for the forced one, each with its
   copies of the table made: the difference is that of a frame after the first. What comes and goes with an effect, such
   as the gradient table with the bump, is in it. */
#pragma once
#include "render/plan/plan.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrChoice WrChoice;
typedef struct WrError WrError;
typedef struct WrFrameRequest WrFrameRequest;
typedef struct WrPool WrPool;

typedef struct WrSavingRequest {
    WrPool *pool;    /* borrowed; NULL: one thread */
    const char *isa; /* as wr_renderer_new takes it */
    const WrFrameRequest *frame;
    const WrChoice
        *choice; /* the dials that a tolerance took for that frame; NULL: the frame's own */
} WrSavingRequest;

typedef struct WrSaving {
    const char *why_not; /* the frame was not measured with it forced: why; NULL: it was */
    bool run;            /* as planned; the other frame then is the one without it, else with it */
    double seconds; /* that a frame with it takes more than one without: median of the runs' own */
    double spread;  /* of those, the middle half */
    bool noise;     /* seconds are no more than that */
    double planned, forced; /* median seconds of both frames */
    int runs;               /* of each */
    WrEffects also;         /* others that came or went with it */
    int64_t tiles, pixels;  /* that it ran on, in the frame where it does */
} WrSaving;

/* All effects, in the table's order. */
bool wr_savings_measure(const WrSavingRequest *request, WrSaving savings[WR_EFFECT_COUNT],
                        WrError *err);

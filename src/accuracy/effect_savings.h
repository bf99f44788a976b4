/* effect_savings.h - measured cost of each effect of a plan, and the time saved by leaving it out. The picture
   is rendered again with the effect forced the other way. Two renderers alternate, one for the picture as
   planned and one for the forced one, each with its table copies already built: so the difference is that of a
   frame after the first. It includes whatever depends on the effect, such as the gradient table for bump. */
#pragma once
#include "render/plan/plan.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrFrameRequest WrFrameRequest;
typedef struct WrPool WrPool;

typedef struct WrSavingRequest {
    WrPool *pool;    /* borrowed; NULL: one thread */
    const char *isa; /* as in wr_renderer_new */
    const WrFrameRequest *frame;
} WrSavingRequest;

typedef struct WrSaving {
    const char *why_not; /* reason why the effect could not be forced; NULL: it was measured */
    bool run; /* as planned; the other frame is without the effect if true, else with it */
    /* additional time of a frame with the effect: median of the runs' differences */
    double seconds;
    double spread;          /* interquartile range of the differences */
    bool noise;             /* seconds are at most `spread` */
    double planned, forced; /* median seconds of both frames */
    int runs;               /* number of frames of each */
    WrEffects also;         /* other effects that changed with it */
    int64_t tiles, pixels;  /* on which it ran, in the frame with it */
} WrSaving;

/* Measures all effects, in the table's order. */
bool wr_savings_measure(const WrSavingRequest *request, WrSaving savings[WR_EFFECT_COUNT],
                        WrError *err);

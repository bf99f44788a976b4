/* tolerance_internal.h - settings, their prices, and the check of a picture's error on some of its blocks. Private
   to tolerance*.c. */
#pragma once
#include "accuracy/tolerance.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One setting of the whole picture. */
typedef struct WrDialSet {
    WrScheme scheme;
    WrBumpMode mode;
    int mesh;    /* WrDials.mesh */
    int samples; /* a side: 1..WR_SAMPLES_MAX */
} WrDialSet;

#define WR_SAMPLES_MAX 16

/* The scene with that setting; the caller frees it. Several samples are adaptive, with a part of the tolerance as
   their contrast, except for a limit of time. fine: for a check, all of them, at random places: outlines and
   creases parallel to the pixels' rows do not bias it. */
WrScene *wr_dial_set_apply(const WrDialSet *set, const WrScene *scene, bool fine);

/* Sets the choice's reason: "tolerance rms=0.004: met; measured rms 0.003, max 0.1; " and `more`. */
void wr_choice_report(WrChoice *choice, const WrTolerance *tolerance, const char *more);

/* ---- tolerance_cost.c ---- */

/* Price of one sample: nanoseconds on the machine that the table was measured on; proportional elsewhere. */
double wr_price_sample(const WrScene *scene, WrScheme scheme, WrBumpMode mode);
/* Seconds per price on this machine with that many threads: measured once and stored in a file, so that the same
   time limit produces the same dials. The renderer's last picture is lost. */
bool wr_price_seconds(WrRenderer *renderer, double *out, WrError *err);

/* ---- tolerance_check.c ---- */

/* Frames of one choice, and their costs. */
typedef struct WrStudy {
    WrRenderer *renderer;
    const WrFrameRequest *request;
    WrFrame *frame; /* the renderer's last frame */
    double covered; /* pixels of the object, in the last whole picture */
    double seconds; /* of the last whole picture, without preparations */
    int frames;
    int64_t shaded;
    WrStageTimes times;
    WrPlan plan;
} WrStudy;

/* Renders the picture, or some of its blocks, into study->frame. only: as in WrFrameRequest; fine: as above. */
bool wr_study_render(WrStudy *study, const WrDialSet *set, const unsigned char *only, bool fine,
                     WrError *err);

/* The drawn blocks of a picture, with their pixels in the same order in each array. */
typedef struct WrCheck {
    WrStudy *study;
    int count;                   /* number of drawn blocks */
    bool all;                    /* these are all blocks with the object */
    int64_t *block;              /* [count] indices, row by row */
    double *weight;              /* [count] number of blocks that each stands for */
    unsigned char *only;         /* [blocks] for WrFrameRequest.only */
    float *picture;              /* [count] blocks of the picture */
    float *fine;                 /* [count] blocks with the best dials */
    float *other;                /* [count] blocks of another setting */
    int fine_samples, fine_mesh; /* dials of `fine`; 0 samples: not rendered */
} WrCheck;

typedef struct WrCheckError {
    double rms, max;
} WrCheckError;

/* Draws blocks of study->frame, a whole picture. Zero-initialise *check. */
bool wr_check_begin(WrCheck *check, WrStudy *study, WrError *err);
void wr_check_fini(WrCheck *check);
/* Copies the drawn blocks of study->frame into an array, or back: renderings of single blocks overwrite the picture. */
void wr_check_copy(const WrCheck *check, float *out, bool back);
/* Renders the drawn blocks with a setting into `out`: `fine` for a check, or `other`. */
bool wr_check_render(WrCheck *check, const WrDialSet *set, float *out, WrError *err);
/* Difference of two arrays of blocks, as an estimate of the whole picture's. raised: by its uncertainty. */
WrCheckError wr_check_error(const WrCheck *check, const float *a, const float *b, bool raised);

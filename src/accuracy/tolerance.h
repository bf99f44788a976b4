/* tolerance.h - the cheapest dials that keep to a stated error: chosen by measuring samples of this very
   picture, for each kind of block that it has.
   Layer 6.

   One frame with a sample a pixel sorts the picture's blocks of WR_FRAME_BLOCK pixels: empty, edge, and
   four kinds of inside by how much neighbouring pixels differ. A few blocks of each kind are then rendered
   at every rung: slopes and normals against the best of their axis, antialiasing against 16 x 16 samples.
   Squared errors of different axes add up, as independent errors do; the sum for every kind of block and
   setting is scaled to the whole picture, and the blocks' settings are raised one kind at a time, best
   gain for its time first, until the tolerance holds with a margin. The outcome is rendered on the sample
   once more and raised again if it does not hold there. */
#pragma once
#include "render/frame.h"

#define WR_CHOICE_KINDS 8 /* kinds of blocks */

typedef struct WrChoice {
    int kinds;                        /* 0: nothing was chosen */
    WrScene *scenes[WR_CHOICE_KINDS]; /* the scene with the dials for blocks of that kind; owned */
    int64_t blocks[WR_CHOICE_KINDS];  /* how many blocks there are of each */
    unsigned char *kind_of;           /* [blocks_v][blocks_u]; owned */
    int width, height;
    bool met;           /* the estimate is within the tolerance (time: within the time) */
    double rms, max;    /* estimated error of the whole picture */
    double seconds;     /* estimated time of a frame */
    double top_seconds; /* of the best setting that was tried, on the whole picture */
    double spent;       /* seconds that choosing took */
    double share;       /* of the picture's blocks that were sampled, 0..1 */
    char reason[320];   /* one or two sentences */
} WrChoice;

/* Choose for the request's picture under its scene's tolerance. The renderer's caches are used; its last
 * picture is lost. The answer depends on measured times, so it may differ from run to run where two rungs
 * cost nearly the same; each answer meets the tolerance, or says that it does not (met).
 * Zero-initialise *out. Errors: the scene has no tolerance; those of frames. */
bool wr_tolerance_choose(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *out,
                         WrError *err);
void wr_choice_fini(WrChoice *choice);

/* The picture with chosen dials: each kind's blocks with its own setting, in one frame.rgba. Bit for bit
   what each setting alone gives there. */
bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err);
/* "edges, 12 % of the blocks: mode=exact ... aa=supersample samples=4", a line a kind that has blocks. */
void wr_choice_print(const WrChoice *choice, WrText *text);

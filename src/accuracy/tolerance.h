/* tolerance.h - the cheapest dials that keep to a stated error: chosen by measuring samples of this very
   picture, for each kind of block that it has.
   Layer 6.

   One picture with a sample a pixel and one with 2 x 2 sort its blocks of WR_FRAME_BLOCK pixels: empty,
   edges, and insides, by how much the second differs from the first; kinds of few blocks join others. A
   few hundredths of the blocks are drawn, each kind for itself, with a chance as that difference is
   large, since it foretells where errors are. They are rendered with 1 to 8 samples a side against 8 x 8,
   or to 12 against 16 x 16 where 8 x 8 is itself too far off; 5, 6, 10 and 12 are interpolated; moments
   are tried where 2 x 2 samples are not enough and the table is not large. Bilinear slopes, the paper's
   normal and none at all are tried with 1 and with 2 x 2 samples; with more, what errors of formulas and
   of sampling have in common is taken from 2 x 2. The sum of squares is taken two and a half of its
   standard errors too high. The kinds are raised one at a time, best gain for its time first, until the
   tolerance holds, for every pair of slopes and normal and for all pairs together; the cheapest outcome
   is rendered on the sample once more, and raised again if it does not hold there.

   What it cannot know. It is a sample: an error in a place that no drawn block resembles is not seen, and
   a worst pixel (max=) least of all. `met` is therefore an estimate: of the 80
   pictures of samples/accuracy one was off by a hundredth more than its tolerance. Where a cheap setting keeps to the tolerance by a few hundredths
   only, the sample cannot tell, and a dearer one is taken. The true picture is taken to be what 16 x 16
   samples tend to: what the surface's mesh, the arithmetic or the stored heights lose is kept as the
   scene has it and is not counted. Choosing costs two whole pictures, of 1 and 2 x 2 samples, one to two
   per cent of the blocks at 16 x 16, some 20 small frames and the tables that they need: about a
   fifteenth of the best setting's frame. Where the tolerance is so fine that nearly all of that frame is
   needed, or the table has many more texels than the picture has pixels, less than ten times that is
   saved. */
#pragma once
#include "render/frame.h"

/* Blocks that have the same setting. */
typedef struct WrChoicePart {
    WrScene *scene;  /* the scene with their dials; owned */
    int64_t blocks;  /* how many there are; those without any of the object are not counted */
    char where[160]; /* "edges, the liveliest relief" */
} WrChoicePart;

typedef struct WrChoice {
    int count;              /* 0: nothing was chosen */
    WrChoicePart *parts;    /* [count]; owned */
    unsigned char *part_of; /* [blocks_v][blocks_u]; owned */
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

/* The picture with chosen dials: each part's blocks with its setting, in one frame.rgba. Bit for bit what
   each setting alone gives there. */
bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err);
/* "12 % of the blocks, edges: mode=exact ... aa=supersample samples=4", a line a part that has blocks. */
void wr_choice_print(const WrChoice *choice, WrText *text);

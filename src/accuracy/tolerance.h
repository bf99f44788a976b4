/* tolerance.h - the cheapest dials that keep to a stated error: chosen by measuring a sample of this very
   picture, for each kind of block that it has.
   Layer 6.

   The whole picture with one sample a pixel and with 2 x 2 sorts its blocks of WR_FRAME_BLOCK pixels into
   strata: empty, edges, insides, by how much the second differs from the first; and each stratum into
   grades, by the same. A few hundredths of the blocks are drawn, each stratum for itself, with a chance as
   that difference is large, since it foretells where errors are. They are rendered with 2 to 8 samples a
   side against 8 x 8, or where that is itself too far off against 12 x 12 or 16 x 16; 5, 6, 10 and 12 are
   interpolated; moments are tried where 2 x 2 samples are not enough and the table is not large. Other
   slopes and normals (bilinear, central; the paper's, none) are rendered whole with one sample, and the
   sample with 2 x 2; with more, what errors of formulas and of sampling have in common is taken from 2 x 2.

   So an error is estimated by ratio: what the sample says of a stratum's error beside a number that is known
   of every block (the change by 2 x 2; what slopes and normal change) times that number's sum. The sum
   of squares is taken two and a half of its standard errors too high. Stratum by stratum and grade by grade
   the settings are raised, best gain for its time first, until the tolerance holds; what is not needed
   is taken back; settings that are cheaper together are put together; one setting for all is taken
   where that is no dearer. The outcome is rendered on the sample once more, and raised again if it does
   not hold there.

   What it cannot know. It is a sample: an error in a place that no drawn block resembles is not seen, and
   a worst pixel (max=) least of all. `met` is therefore an estimate; samples/accuracy tells how often
   it held. Where a cheap setting keeps to the tolerance by a few hundredths only, the sample cannot tell, and
   some blocks get a dearer one. The true picture is taken to be what 16 x 16 samples tend to: what the
   surface's mesh, the arithmetic or the stored heights lose is kept as the scene has it and is not
   counted. Along outlines that run with the pixels' rows all counts of samples may be off alike: there the
   reference's error is taken to add to theirs. Choosing costs the whole picture with 2 x 2 samples and some
   three to six times with one, two hundredths of the blocks at 16 x 16, some 20 small frames and the tables
   that they need: about a fifteenth of the best setting's frame. Where the tolerance is so fine that a
   third of that frame is needed, or the table has many more texels than the picture has pixels, less than
   ten times that is saved. */
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
    unsigned char *part_of; /* [blocks_v][blocks_u] of parts' indices; owned */
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

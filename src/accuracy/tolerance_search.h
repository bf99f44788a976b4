/* tolerance_search.h - choice of the cheapest dials for each block of a picture under an error tolerance, with the
   resulting picture.

   The whole picture is rendered with one sample a pixel and with 2 x 2. The change in each block of
   WR_FRAME_BLOCK pixels yields an estimate of both errors, since errors fall by a known order as samples are
   added (tolerance_estimate.c). Blocks with too large an error get 4 x 4, then 8 x 8, then 16 x 16, until all
   together meet the tolerance (max=: until each does). Cheaper slopes and normals (none, bilinear, the paper's)
   are tested if they may save more than the test costs. Then a few blocks of each kind are rendered much finer:
   if their errors exceed the estimates, all blocks of their kind climb.

   So no error is measured directly: a setting's error is estimated from the change to the next finer one, the
   finest from the change before it. Cost is counted work (tolerance_search.c), never time: the same table, scene,
   size and tolerance give the same dials, on any machine and any number of threads. Only `time=` needs the speed
   of the machine, which is measured once and stored.

   If the best setting everywhere, 16 x 16 samples, costs no more than the least cost of choosing (for an object
   that covers few pixels), or the time allows it, it is used at once.

   The blocks' pictures at their chosen levels are the result: choosing and rendering are one process. Measured,
   that costs two to four times the cost of rendering the result again (samples/accuracy): blocks climb through
   all levels, some a level too high, and the proof that one sample suffices needs 2 x 2.

   Limits. `met` is an estimate: an error on which all levels of a block agree, and which the probes miss, is not
   detected. samples/accuracy records how often the estimate was right. The true picture is assumed to be the
   limit of 16 x 16 samples: errors of arithmetic or of stored heights remain as in the scene and are not
   counted, nor, except for max=, which uses a finer mesh, errors of the surface's mesh at outlines. If the error
   of 16 x 16 samples itself exceeds the tolerance, it is reported as not met. Along outlines parallel to the
   pixels' rows all levels may have equal errors: there the error is assumed to be the largest that such an
   outline can hide.

   Known doubts, each added to the estimate because a picture broke its bound without it:
   - an outline, crease, end of the relief or pole that ends in a corner or along a side of a block, where none of
     the block's samples meets it: the change of the neighbour's nearest pixels counts (tolerance_estimate.c,
     tolerance_estimate.c);
   - outlines and creases parallel to the pixels' rows or columns, also between two blocks (tolerance_estimate.c);
   - the greatest error of a pixel is estimated less surely than the rms: for max= estimates stay below 0.75 of the
     tolerance, for the rms below 0.93 (MARGIN_MAX, MARGIN_RMS in tolerance_search.c).
   Details smaller than a pixel in the middle of a block that neither 1 sample nor 2 x 2 meet remain undetected
   unless a probe meets them. The measurements in samples/accuracy are older than these three. */
#pragma once
#include "base/hash.h"
#include "render/plan/plan.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrPlan WrPlan;
typedef struct WrError WrError;
typedef struct WrFrame WrFrame;
typedef struct WrFrameRequest WrFrameRequest;
typedef struct WrRenderer WrRenderer;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

/* Blocks with the same setting. */
typedef struct WrChoicePart {
    WrScene *scene;  /* the scene with their dials; owned */
    int level;       /* samples a side: 1, 2, 4, 8, 16 */
    double price;    /* of one sample, with their slopes and normal */
    int64_t blocks;  /* number of blocks; those without the object are not counted */
    unsigned kinds;  /* kinds of these blocks, two bits per kind (tolerance_internal.h) */
    char where[160]; /* description: "edges, some of the liveliest insides" */
} WrChoicePart;

#define WR_CHOICE_NOTHING 255 /* value of part_of: a block without the object */

typedef struct WrChoice {
    int count;              /* 0: no choice */
    WrChoicePart *parts;    /* [count]; owned */
    unsigned char *part_of; /* [blocks_v][blocks_u] indices of parts; owned */
    int width, height;
    bool met;           /* the estimate is within the tolerance (time=: within the time) */
    double rms, max;    /* estimated error of the whole picture */
    double seconds;     /* estimated time of one further such frame */
    double top_seconds; /* estimated time with 16 x 16 samples everywhere */
    double spent;       /* seconds spent on choosing, including the picture */
    char reason[480];   /* one or two sentences */
    bool shown;         /* set by the caller after showing the reason to the user */
    int frames;         /* number of frames rendered for it, each of some of the blocks */
    int studies;        /* number of frames studied for it; 0: it was read from text */
    WrPlan plan;        /* costs of its last picture: the frame's plan */
    /* The picture that it belongs to. */
    const WrScene *scene; /* shared; owned */
    uint64_t tables_key;  /* wr_choice_tables_key */
    double turn_deg;
    bool turning; /* valid for any turn */
} WrChoice;

/* Chooses for the request's picture under its scene's tolerance, and returns the picture: *frame has the counts,
   times and plan of everything rendered for it; the plan is owned by the choice. The renderer's caches are used;
   its last picture is lost. Zero-initialise *out. Errors: the scene has no tolerance; those of frames. */
bool wr_tolerance_choose(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *out,
                         WrFrame *frame, WrError *err);
/* The request's picture under its scene's tolerance: by *choice if that belongs to the same table, scene, turn
   (or any turn) and size, else chosen again into *choice. */
bool wr_tolerance_frame(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *choice,
                        WrFrame *frame, WrError *err);
/* One choice for all frames of a turntable animation with those angles. Dials are chosen on up to four frames
   spread over it, at most a quarter of them; each block gets the most expensive setting of any. Equally many
   frames between are tested: a part of their blocks with finer samples. A frame with too large an error is
   studied too. Returns no picture; reason states these frames, and from how many frames on it pays. */
bool wr_tolerance_turn(WrRenderer *renderer, const WrFrameRequest *request, const double *turn_deg,
                       int count, WrChoice *out, WrError *err);
void wr_choice_fini(WrChoice *choice);

/* Renders the picture with chosen dials: each part's blocks with its setting, in one frame.rgba. The bits are
   those of each setting alone. */
bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err);
/* Identity of the tables of a picture's objects: a key valid in this process, and a hash. */
uint64_t wr_choice_tables_key(const WrFrameRequest *request);
WrHash wr_choice_tables_hash(const WrFrameRequest *request);
/* True if it belongs to the request's tables, scene, size and turn (or is valid for any turn). */
bool wr_choice_fits(const WrChoice *choice, const WrFrameRequest *request);
/* "12 % of the blocks, edges: mode=exact ... aa=supersample samples=4", one line for each part with blocks. */
void wr_choice_print(const WrChoice *choice, WrText *text);

/* ---- text form: tolerance_text.c ---- */

/* Identity of the table and scene, tolerance included, that a choice was made for; its size and turn are in the
   choice. */
typedef struct WrChoiceOrigin {
    WrHash table, scene;
} WrChoiceOrigin;

/* Writes the choice as one line of text, from which wr_choice_read restores the same picture, bit for bit. If
   the blocks need more than 256 KiB, the finest of its settings is written for all of them: it meets the
   tolerance too. */
void wr_choice_write(const WrChoice *choice, const WrChoiceOrigin *origin, WrText *text);
/* Validates such a text. Errors state the damage. */
bool wr_choice_check(const char *text, WrError *err);
/* For a valid text: the property that does not match, "table", "scene", "size" or "turn"; NULL: it fits. */
const char *wr_choice_misfit(const char *text, const WrChoiceOrigin *origin,
                             const WrFrameRequest *request);
/* For a valid text: true if it belongs to that table and scene, at any size and turn. */
bool wr_choice_is_for(const char *text, const WrChoiceOrigin *origin);
/* Reads a valid, matching text as the request's choice. */
void wr_choice_read(const char *text, const WrFrameRequest *request, WrChoice *out);

/* tolerance.h - the cheapest dials that keep to a stated error, for each block of this very picture, and the picture.
   Layer 6.

   The whole picture is made with one sample a pixel and with 2 x 2. What that changes in each block of
   WR_FRAME_BLOCK pixels tells what both are off, since errors fall by a known order as samples are added
   (tolerance_estimate.c). Blocks that are off by too much get 4 x 4, then 8 x 8, then 16 x 16, until all together
   keep to the tolerance (max=: until each does). Cheaper slopes and normals (none, bilinear, the paper's)
   are looked at where they may save more than that look takes. Then a few blocks of each kind are rendered
   far finer: where they are off by more than was estimated, all blocks of their kind climb.

   So nothing is measured by itself: a setting is told by what the next finer changes, the finest by what it
   changed in the one before. What is cheap is decided by counted work (tolerance_price.c), never by a clock: the
   same table, scene, size and tolerance give the same dials, on any machine and any number of threads. Only
   `time=` needs to know how fast the machine is; that is measured once and kept.

   Where the best setting everywhere, 16 x 16 samples, takes no more than choosing does at least (of an object that
   covers few pixels), or the time allows it, it is taken at once.

   The blocks' pictures at their picks are the picture: choosing and making it are one. As measured that takes two to
   four times what making it again takes (samples/accuracy): blocks climb through all levels, some a level too high,
   and to know that one sample will do costs 2 x 2.

   What it cannot know. `met` is an estimate: what all levels of a block agree on, and the probes do not meet, is
   not seen. samples/accuracy tells how often it held. The true picture is taken to be what 16 x 16 samples tend
   to: what the arithmetic or the stored heights lose is kept as the scene has it and is not counted, nor, but for
   max=, which takes a finer one, what the surface's mesh loses at outlines. Where 16 x 16 samples themselves are off by
   more than the tolerance, it is said not to be met. Along
   outlines that run with the pixels' rows all levels may be off alike: there the error is taken to be what such
   an outline can hide. */
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

/* Blocks that have the same setting. */
typedef struct WrChoicePart {
    WrScene *scene;  /* the scene with their dials; owned */
    int level;       /* of samples: 1, 2, 4, 8, 16 a side */
    double price;    /* of a sample, with their slopes and normal */
    int64_t blocks;  /* how many there are; those without any of the object are not counted */
    unsigned kinds;  /* of which kinds of blocks, two bits a kind (tolerance_internal.h) */
    char where[160]; /* "edges, some of the liveliest insides" */
} WrChoicePart;

#define WR_CHOICE_NOTHING 255 /* in part_of: a block that shows nothing of the object */

typedef struct WrChoice {
    int count;              /* 0: nothing was chosen */
    WrChoicePart *parts;    /* [count]; owned */
    unsigned char *part_of; /* [blocks_v][blocks_u] of parts' indices; owned */
    int width, height;
    bool met;           /* the estimate is within the tolerance (time: within the time) */
    double rms, max;    /* estimated error of the whole picture */
    double seconds;     /* estimated time of one more such frame */
    double top_seconds; /* the same of 16 x 16 samples everywhere */
    double spent;       /* seconds that choosing took, the picture included */
    char reason[480];   /* one or two sentences */
    bool told;          /* the caller's: that reason was given to the user */
    int frames;         /* that choosing rendered, each of some of the blocks */
    int studies; /* frames that were studied for it; 0: it was read, and nothing was chosen */
    WrPlan plan; /* what its last picture took: the frame's */
    /* Of what picture it is. */
    const WrScene *scene; /* shared; owned */
    uint64_t tables_key;  /* wr_choice_tables_key */
    double turn_deg;
    bool turning; /* for any turn */
} WrChoice;

/* Choose for the request's picture under its scene's tolerance, and give the picture: *frame, its counts, times
 * and plan those of all that was rendered for it; the plan is the choice's and goes with it. The renderer's caches are used; its last picture is lost.
 * Zero-initialise *out. Errors: the scene has no tolerance; those of frames. */
bool wr_tolerance_choose(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *out,
                         WrFrame *frame, WrError *err);
/* The request's picture under its scene's tolerance: as *choice has it if that was chosen for the same table, scene,
 * turn (or for any) and size, else chosen anew into *choice. */
bool wr_tolerance_frame(WrRenderer *renderer, const WrFrameRequest *request, WrChoice *choice,
                        WrFrame *frame, WrError *err);
/* One choice for all frames of a turn, those angles: dials are chosen on up to four of them that lie spread over it,
   a quarter of them at most; each block gets the dearest that it got on any. As many frames between are looked
   at: a part of their blocks with finer samples. One that is off by more is studied too. No picture is given;
   reason tells which and from how many frames on it pays. */
bool wr_tolerance_turn(WrRenderer *renderer, const WrFrameRequest *request, const double *turn_deg,
                       int count, WrChoice *out, WrError *err);
void wr_choice_fini(WrChoice *choice);

/* The picture with chosen dials: each part's blocks with its setting, in one frame.rgba. Bit for bit what
   each setting alone gives there. */
bool wr_choice_frame(WrRenderer *renderer, const WrFrameRequest *request, const WrChoice *choice,
                     WrFrame *frame, WrError *err);
/* What tells the tables that a picture shows, those of its objects, from others: in this process, and anywhere. */
uint64_t wr_choice_tables_key(const WrFrameRequest *request);
WrHash wr_choice_tables_hash(const WrFrameRequest *request);
/* Is it of that request's tables, scene, size and turn (or for any turn)? */
bool wr_choice_fits(const WrChoice *choice, const WrFrameRequest *request);
/* "12 % of the blocks, edges: mode=exact ... aa=supersample samples=4", a line a part that has blocks. */
void wr_choice_print(const WrChoice *choice, WrText *text);

/* ---- written down: tolerance_text.c ---- */

/* What a choice was made for besides size and turn, which it knows: hashes of the tables and of the scene, the
   tolerance included. */
typedef struct WrChoiceOrigin {
    WrHash table, scene;
} WrChoiceOrigin;

/* As one line of text, from which wr_choice_read makes the same picture, bit for bit. Of a picture whose blocks take
 * more than 256 KiB the finest of its settings is written for all of them: it keeps to the tolerance too. */
void wr_choice_write(const WrChoice *choice, const WrChoiceOrigin *origin, WrText *text);
/* Is it such a text? Errors say where it is damaged. */
bool wr_choice_check(const char *text, WrError *err);
/* Of a checked text: what it was not chosen for, "table", "scene", "size" or "turn"; NULL: it fits. */
const char *wr_choice_misfit(const char *text, const WrChoiceOrigin *origin,
                             const WrFrameRequest *request);
/* Of a checked text: is it for that table and scene, whatever the size and turn? */
bool wr_choice_is_for(const char *text, const WrChoiceOrigin *origin);
/* A checked text that fits, as the request's choice. */
void wr_choice_read(const char *text, const WrFrameRequest *request, WrChoice *out);

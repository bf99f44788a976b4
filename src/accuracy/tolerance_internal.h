/* tolerance_internal.h - study of a picture: its blocks with their pictures at increasing levels, and the
   estimated errors. Private to tolerance*.c.

   Levels are 1, 2, 4, 8 and 16 samples a side. Each block climbs as far as necessary: the change from one level
   to the next yields an estimate of both errors, since errors fall by a known order. */
#pragma once
#include "accuracy/tolerance_search.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LEVELS 5
#define TOP (LEVELS - 1)
#define PAIRS_MAX 4 /* pairs of slopes and normal; 0 is the best */

/* Samples a side. */
static inline int wr_level_side(int level)
{
    return 1 << level;
}

/* Interpolation scheme and normal formula. */
typedef struct Pair {
    WrScheme scheme;
    WrBumpMode mode;
    double price; /* of one sample (wr_price_sample) */
} Pair;

#define BLOCK_FLOATS ((size_t)4 * WR_FRAME_BLOCK * WR_FRAME_BLOCK)

/* A difference between two pictures of a block: squares summed over its pixels and R, G, B, and the largest. */
typedef struct Change {
    double squares, most;
} Change;

typedef struct Corner {
    int x, y, w, h; /* of a block, pixels */
} Corner;

enum { LEFT, RIGHT, UPPER, LOWER, SIDES }; /* outermost pixels of a block */

enum { NOTHING = 1, OBJECT = 2 }; /* content of pixels; may be combined */

typedef struct Block {
    bool shown;          /* it contains the object, or is next to an outline */
    bool edge, lined;    /* edge: an outline is in it or next to it; lined: in it */
    signed char level;   /* highest rendered level; 0: change[1] is predicted */
    signed char pair;    /* pair from level 2 on, and of its pick */
    signed char pick;    /* the chosen level */
    int covered;         /* pixels covered in the first picture */
    float *rgba[LEVELS]; /* BLOCK_FLOATS each, owned; NULL: not rendered, or no longer needed */
    signed char pair_of[LEVELS]; /* pair that the picture was rendered with */
    Change change[LEVELS];       /* [n]: from level n - 1 to n */
    Change side[LEVELS][SIDES];  /* the part of that along each side; 0 if change was predicted */
    /* largest error at that level hidden by an outline parallel to the pixels' rows */
    Change step[LEVELS];
    Change formula[PAIRS_MAX]; /* change by cheaper slopes and normals, with one sample a pixel */
} Block;

/* Correction of the estimates of all blocks with the same pick. */
typedef struct Doubt {
    double weight;      /* factor of actual over estimated errors, squared */
    double weight_most; /* that factor for the largest error */
    int64_t blocks;     /* number of blocks with that pick when it was probed; 0: not probed */
} Doubt;

/* Predictions for a level's blocks from the step to it, and the results of the step from it. */
typedef struct Learnt {
    double predicted, measured; /* squares, of the blocks that climbed */
    int64_t blocks;
} Learnt;

typedef struct Study {
    WrRenderer *renderer;
    const WrFrameRequest *request;
    WrFrame *frame; /* the renderer's last frame */
    int blocks_u, blocks_v;
    int64_t count;       /* number of blocks */
    Block *block;        /* [blocks_v][blocks_u] */
    unsigned char *mask; /* [blocks_v][blocks_u] for WrFrameRequest.only */
    double pixels;       /* pixels of the object */
    Pair pair[PAIRS_MAX];
    int pairs;
    int mesh; /* at least this value of WrDials.mesh from level mesh_from on */
    int mesh_from;
    Doubt doubt[LEVELS];
    Learnt learnt[LEVELS][2]; /* by level, and whether at an outline */
    double spent;             /* cost of all frames so far, in prices */
    double seconds;           /* time of these frames, without initial preparations */
    int64_t shaded;
    int frames; /* rendered so far */
    WrStageTimes times;
    WrPlan plan; /* costs of all frames */
} Study;

/* ---- tolerance_estimate.c ---- */

/* The scene with a pair's and a level's dials; the caller frees it. */
WrScene *wr_study_scene(const Study *study, int pair, int level);
/* Climb: each wanted block is rendered at the next level, with its pair. */
bool wr_study_climb(Study *study, const unsigned char *wanted, WrError *err);
/* Measures the change by another pair, with one sample a pixel. */
bool wr_study_formula(Study *study, int pair, WrError *err);
/* Composes each block's picture at its pick, rendered if missing, in study->frame. */
bool wr_study_compose(Study *study, WrError *err);
void wr_study_fini(Study *study);

/* After wr_study_begin: renders the second level with the best pair where necessary; sets all blocks' pictures
   and contents. */
bool wr_study_survey(Study *study, const WrTolerance *tolerance, WrError *err);

/* Renders the first level. */
bool wr_study_begin(Study *study, const WrTolerance *tolerance, WrError *err);
/* After the first level: true if the best setting everywhere costs no more than the minimum still needed for
   choosing, or the time allows it. */
bool wr_study_best_is_cheaper(const Study *study, const WrTolerance *tolerance);
/* Then uses it: all blocks at the finest level, with the error estimated from its change. */
bool wr_study_take_best(Study *study, WrError *err);

/* Error of a block at a level with a pair: squares summed over pixels and channels, and the largest. Above the
   block's own level it is predicted. */
Change wr_study_off(const Study *study, const Block *block, int pair, int level);
/* Root mean square of linear intensity over the object, of a sum of squares. */
double wr_study_rms(const Study *study, double squares);
/* Corrects the estimates by the results of blocks that have climbed since. */
void wr_study_learn(Study *study);
/* Renders a few blocks of each pick at a much finer level: if their errors exceed the estimates, those of all of
   their kind are raised. *worse: the result may change picks. */
bool wr_study_probe(Study *study, bool *worse, WrError *err);

/* ---- tolerance_search.c ---- */

/* Cost of the picks, in prices, and their error. */
double wr_study_cost(const Study *study);

/* Price of one sample: nanoseconds on the machine that the table was measured on; proportional elsewhere. */
double wr_price_sample(const WrScene *scene, WrScheme scheme, WrBumpMode mode);
/* Additional price of a frame of that many samples: passes over its pixels. */
double wr_price_pass(int64_t pixels);

/* Kinds of blocks for descriptions: outlines, and insides by the size of the change by 2 x 2 samples. A part's
   `kinds` has two bits for each. */
enum { KIND_EDGE, KIND_CALM, KIND_RELIEF, KIND_ROUGH, KIND_COUNT };
enum { HAS_NONE, HAS_SOME, HAS_MAX, HAS_ALL };
#define KIND_BITS 2

#define PARTS_MAX (PAIRS_MAX * LEVELS)

/* Writes "edges, some of the relief" to part->where, from part->kinds. */
void wr_part_name(WrChoicePart *part);
/* Sets the choice's reason: "tolerance rms=0.004: met; estimated rms 0.003, max 0.1; " and `more`. */
void wr_choice_say(WrChoice *choice, const WrTolerance *tolerance, const char *more);
/* The scene with those slopes, that normal and samples of a level, without tolerance; the caller frees it. */
WrScene *wr_level_scene(const WrScene *scene, WrScheme scheme, WrBumpMode mode, int level,
                        int mesh);

/* wr_choice_frame; the sum of its parts' costs goes into *plan, which becomes the frame's, or NULL. */
bool wr_choice_frame_plan(WrRenderer *renderer, const WrFrameRequest *request,
                          const WrChoice *choice, WrPlan *plan, WrFrame *frame, WrError *err);
/* Adds the times of each stage. */
void wr_times_add(WrStageTimes *sum, const WrStageTimes *more);
/* Pixels with coverage. */
int64_t wr_frame_covered(const WrFrame *frame);

/* tolerance_internal.h - what choosing knows of a picture: its blocks, their pictures at one level after the other,
   and what each is off by that.
   Layer 6, private to tolerance*.c.

   Levels are 1, 2, 4, 8 and 16 samples a side. Each block climbs as far as it must: what the step from one level
   to the next changes tells what both are off, since errors fall by a known order. */
#pragma once
#include "accuracy/tolerance.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LEVELS 5
#define TOP (LEVELS - 1)
#define PAIRS_MAX 4 /* of slopes and normal; 0 is the best */

/* Samples a side. */
static inline int wr_level_side(int level)
{
    return 1 << level;
}

/* Slopes and normal together. */
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

enum { LEFT, RIGHT, UPPER, LOWER, SIDES }; /* of a block, its outermost pixels */

enum { NOTHING = 1, OBJECT = 2 }; /* what pixels show; and both */

typedef struct Block {
    bool shown;          /* any of the object is in it, or an outline next to it */
    bool edge, lined;    /* an outline is in it or next to it; in it */
    signed char level;   /* the highest that it was rendered at; 0: change[1] is foretold */
    signed char pair;    /* from level 2 on, and of its pick */
    signed char pick;    /* the level that it gets */
    int covered;         /* pixels with coverage in the first picture */
    float *rgba[LEVELS]; /* BLOCK_FLOATS each, owned; NULL: not rendered, or not needed any more */
    signed char pair_of[LEVELS]; /* that the picture was made with */
    Change change[LEVELS];       /* [n]: from level n - 1 to n */
    Change side[LEVELS][SIDES];  /* of that the part along each side; 0 where change was foretold */
    Change
        step[LEVELS]; /* what an outline that runs with the pixels' rows may hide at that level */
    Change formula[PAIRS_MAX]; /* what cheaper slopes and normals change, one sample a pixel */
} Block;

/* Blocks whose estimates are corrected together: by the level of their pick. */
typedef struct Doubt {
    double weight;      /* times that errors are above the estimate, squared */
    double weight_most; /* the same of the largest */
    int64_t blocks;     /* how many had that pick when it was probed; 0: it was not */
} Doubt;

/* What was foretold of a level's blocks from the step to it, beside what the step from it then told. */
typedef struct Learnt {
    double foretold, told; /* squares, of the blocks that climbed on */
    int64_t blocks;
} Learnt;

typedef struct Study {
    WrRenderer *renderer;
    const WrFrameRequest *request;
    WrFrame *frame; /* the renderer's last */
    int blocks_u, blocks_v;
    int64_t count;       /* of blocks */
    Block *block;        /* [blocks_v][blocks_u] */
    unsigned char *mask; /* [blocks_v][blocks_u] for WrFrameRequest.only */
    double pixels;       /* of the object */
    Pair pair[PAIRS_MAX];
    int pairs;
    int mesh; /* WrDials, at least, from level mesh_from on */
    int mesh_from;
    Doubt doubt[LEVELS];
    Learnt learnt[LEVELS][2]; /* by level, and whether at an outline */
    double spent;             /* of all frames so far, in prices */
    double seconds;           /* of the same, by the clock, without what had to be made first */
    int64_t shaded;
    int frames; /* rendered so far */
    WrStageTimes times;
    WrPlan plan; /* what all frames took */
} Study;

/* ---- tolerance_blocks.c ---- */

/* The scene with a pair's and a level's dials; the caller frees it. */
WrScene *wr_study_scene(const Study *study, int pair, int level);
Corner wr_study_corner(const Study *study, int64_t block);
/* What a block shows, by the pictures that it has, and what the pixels next to it do: NOTHING, OBJECT or both;
   its pixels that the first picture covers are counted. */
int wr_study_look(const Study *study, int64_t b);
int wr_study_look_around(const Study *study, int64_t b);
void wr_study_drop(Block *block, int level);
/* Those blocks of study->mask at a level with a pair. keep: as their pictures of that level; else into `out`,
   BLOCK_FLOATS for each of them in order, or, where that is NULL too, nowhere: only study->frame has them. */
bool wr_study_render(Study *study, int pair, int level, bool keep, float *out, WrError *err);
/* Climb: each block that wants it gets its picture of the next level, with its pair. */
bool wr_study_climb(Study *study, const unsigned char *wanted, WrError *err);
/* What another pair changes, with one sample a pixel. */
bool wr_study_formula(Study *study, int pair, WrError *err);
/* Each block's picture at its pick, rendered where it is missing, in study->frame. */
bool wr_study_compose(Study *study, WrError *err);
Change wr_block_change(const float *a, const float *b);
/* Compare a block's pictures of a level and the one below: block->change and block->side of that level. */
void wr_block_compare(Block *block, int level);
void wr_study_fini(Study *study);

/* ---- tolerance_survey.c ---- */

/* After wr_study_begin: the second level with the best pair where it must be: all blocks' pictures and what they
   show. */
bool wr_study_survey(Study *study, const WrTolerance *tolerance, WrError *err);

/* The first level alone. */
bool wr_study_begin(Study *study, const WrTolerance *tolerance, WrError *err);
/* Of what the first level shows: does the best setting everywhere take no more than what would still have to be
   rendered to choose at least, or does the time allow it? */
bool wr_study_best_is_cheaper(const Study *study, const WrTolerance *tolerance);
/* Then that is taken: all blocks at the finest level, and what it changed tells what it is off. */
bool wr_study_take_best(Study *study, WrError *err);

/* ---- tolerance_estimate.c ---- */

/* What a block is off at a level with a pair: squares summed over pixels and channels, and the largest. A level
   above the block's own is foretold from that. */
Change wr_study_off(const Study *study, const Block *block, int pair, int level);
/* Root mean square of linear intensity over the object, of a sum of squares. */
double wr_study_rms(const Study *study, double squares);
/* How right were the estimates of blocks that have climbed on since? Those of the others follow. */
void wr_study_learn(Study *study);
/* A few blocks of each pick at a far finer level: where they are off by more than was estimated, all of their
   kind are taken to be. *worse: something was learnt that may change picks. */
bool wr_study_probe(Study *study, bool *worse, WrError *err);
/* Errors that were seen beside those that were foretold, each raised by a floor that comes to half of all that is
   foretold: the factor that makes the foretold right, with some caution. shares: their sum, and of their squares. */
double wr_study_factor(double shares, double squares, int64_t count);

/* ---- tolerance_pick.c ---- */

/* The cheapest pair and level for each block that together keep to the tolerance, by what is known now; for a
   time, in prices, the nearest that it allows. free_pairs: blocks may change their pairs. */
void wr_study_pick(Study *study, const WrTolerance *tolerance, bool free_pairs);
/* What the picks take, in prices, and are off. */
double wr_study_cost(const Study *study);
Change wr_study_picked_off(const Study *study);

/* ---- tolerance_price.c ---- */

/* What one sample takes: nanoseconds on the machine that the table was measured on; elsewhere in proportion. */
double wr_price_sample(const WrScene *scene, WrScheme scheme, WrBumpMode mode);
/* Of a frame of so many samples beyond those: passes over its pixels. */
double wr_price_pass(int64_t pixels);

/* ---- tolerance_speed.c ---- */

/* Seconds of one price on this machine with so many threads: measured once and kept in a file, so that the same
   time gives the same dials. The renderer's last picture is lost. */
bool wr_price_seconds(WrRenderer *renderer, double *out, WrError *err);

/* ---- tolerance_choice.c ---- */

/* Kinds of blocks for people: outlines, and what is inside of them by how much 2 x 2 samples change it. A part's
   `kinds` has two bits for each. */
enum { KIND_EDGE, KIND_CALM, KIND_RELIEF, KIND_ROUGH, KIND_COUNT };
enum { HAS_NONE, HAS_SOME, HAS_MOST, HAS_ALL };
#define KIND_BITS 2

#define PARTS_MAX (PAIRS_MAX * LEVELS)

/* "edges, some of the relief" into part->where, by part->kinds. */
void wr_part_name(WrChoicePart *part);
/* "tolerance rms=0.004: met; estimated rms 0.003, max 0.1; " and that, as the choice's reason. */
void wr_choice_say(WrChoice *choice, const WrTolerance *tolerance, const char *more);
/* The scene with those slopes, that normal and samples of a level, and no tolerance; the caller frees it. */
WrScene *wr_level_scene(const WrScene *scene, WrScheme scheme, WrBumpMode mode, int level,
                        int mesh);

/* The study's picks become the caller's choice: its parts. */
void wr_study_settle(const Study *study, WrChoice *out);
/* wr_choice_frame; what its parts took together into *plan, which becomes the frame's, or NULL. */
bool wr_choice_frame_told(WrRenderer *renderer, const WrFrameRequest *request,
                          const WrChoice *choice, WrPlan *plan, WrFrame *frame, WrError *err);
/* Stage by stage. */
void wr_times_add(WrStageTimes *sum, const WrStageTimes *more);
/* Pixels with coverage. */
int64_t wr_frame_covered(const WrFrame *frame);

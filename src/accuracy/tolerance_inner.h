/* tolerance_inner.h - what choosing knows of a picture: its kinds of blocks, a sample of them, and what
   each rung does there.
   Layer 6, private to tolerance*.c.

   Blocks are sorted twice. Strata, by what a second row of samples changes and whether an outline passes, are
   what is drawn from and measured. Grades cut each stratum by how much that is: a stratum and a grade are a
   kind, and each kind may have a setting of its own. What a kind has of its stratum's error tells a control,
   a number known of every block from whole pictures that are cheap: the error is the stratum's ratio, of
   the sample, times the kind's sum of the control. */
#pragma once
#include "accuracy/tolerance.h"

#define SCHEMES_MAX 3
#define MODES_MAX 3
#define STRATA 8 /* 0 is empty, then 2 of edges and 5 of insides */
#define GRADES 6
#define KINDS (1 + (STRATA - 1) * GRADES)

enum { STRATUM_EMPTY, STRATUM_EDGE, STRATUM_INSIDE = STRATUM_EDGE + 2 };

/* Grade 0 is the liveliest. */
static inline int wr_kind(int stratum, int grade)
{
    return stratum == STRATUM_EMPTY ? 0 : 1 + (stratum - 1) * GRADES + grade;
}

static inline int wr_stratum(int kind)
{
    return kind == 0 ? STRATUM_EMPTY : 1 + (kind - 1) / GRADES;
}

/* Ways against aliasing, cheap to good. */
enum {
    WAY_POINT,
    WAY_MOMENTS,
    WAY_TWO,
    WAY_THREE,
    WAY_FOUR,
    WAY_FIVE,
    WAY_SIX,
    WAY_EIGHT,
    WAY_TEN,
    WAY_TWELVE,
    WAY_SIXTEEN,
    WAY_COUNT
};
typedef struct Way {
    WrAntialias aa;
    int samples;
    int low, high; /* ways that it is not measured but interpolated between; 0, 0: measured */
} Way;
extern const Way wr_study_ways[WAY_COUNT];

/* A number of every block, and its sums. */
typedef struct Control {
    float *of; /* [block_count] */
    double sum[KINDS];
} Control;

/* What the sample says of an error, by stratum: how large it is beside a control, how uncertain that is (a
   standard error), the largest difference of a channel on the sample, and what the sample makes of the
   control's sum. */
typedef struct Rate {
    double ratio[STRATA], spread[STRATA], most[STRATA], weighed[STRATA];
} Rate;

/* Slopes and normal together, with all that is known of them. */
typedef struct Pair {
    bool tried;
    Control change;  /* one sample, against the best pair's 2 x 2 */
    Control formula; /* one sample, against the best pair's one */
    Rate point;      /* of one sample, by `change` */
    Rate own;        /* of 2 x 2, against the best pair's 2 x 2, by `formula` */
    Rate two;        /* of 2 x 2, by what the best pair's 2 x 2 and `own` make of it */
    double pace;     /* time, beside the best pair's */
} Pair;

/* One block of the picture. */
typedef struct Block {
    unsigned char stratum, kind;
    bool sampled;
    float weight; /* of its squared error, for the sum over all blocks of its stratum */
    int covered;  /* pixels with coverage in the first picture */
} Block;

#define BLOCK_FLOATS ((size_t)4 * WR_FRAME_BLOCK * WR_FRAME_BLOCK)

/* The blocks of a picture that show anything. */
typedef struct Packed {
    float *rgba;    /* [those][block][block][4]; beyond the picture 0 */
    int64_t *place; /* [block_count], where it is among those; -1: it shows nothing */
} Packed;

typedef struct Study {
    WrRenderer *renderer;
    const WrFrameRequest *request;
    int blocks_u, blocks_v;
    int64_t block_count;
    Block *block;           /* [blocks_v][blocks_u] */
    unsigned char *mask;    /* [blocks_v][blocks_u] for WrFrameRequest.only */
    int64_t blocks[KINDS];  /* of the picture */
    int64_t all[STRATA];    /* the same by stratum */
    int64_t chosen[STRATA]; /* of the sample */
    int64_t covered[KINDS]; /* pixels */
    double pixels;          /* of the object, half of each edge's included */
    Control
        size; /* squared change of the best pair by 2 x 2, and a little: what blocks are drawn by */
    int64_t sample_count;          /* blocks */
    Packed one, two;               /* the best pair's picture, of one and of 2 x 2 samples */
    float *best;                   /* [sample_count][block][block][4]: the reference */
    float *middle;                 /* the same, of 8 x 8 samples; NULL: they are the reference */
    float *other;                  /* the same, of the setting at hand */
    WrScheme schemes[SCHEMES_MAX]; /* cheap to good; the last is the best */
    WrBumpMode modes[MODES_MAX];
    int scheme_count, mode_count;
    int top; /* the way that the others are measured against */
    /* Processor seconds and seconds of all frames so far: threads, and what others do on the machine, part
       them. */
    double work, wall;
    double pass; /* processor seconds of a frame of nothing */
    Pair pair[SCHEMES_MAX][MODES_MAX];
    bool aligned[STRATA]; /* the reference is off along outlines that run with the pixels' rows */
    bool tried[WAY_COUNT];
    Rate way[WAY_COUNT];    /* with the best pair, by size */
    double each[WAY_COUNT]; /* processor seconds of a covered pixel */
} Study;

/* A setting of all three axes, as indices. */
typedef struct Place {
    int scheme, mode, way;
} Place;

static inline bool wr_same_place(Place a, Place b)
{
    return a.scheme == b.scheme && a.mode == b.mode && a.way == b.way;
}

/* The best slopes and normal. */
static inline Place wr_best_place(const Study *study, int way)
{
    return (Place){ study->scheme_count - 1, study->mode_count - 1, way };
}

/* The squared error of a kind, summed over pixels and channels; how uncertain that is, a standard error; the
   largest difference of a channel. */
typedef struct Error {
    double sum, spread, most;
} Error;

/* Sort the blocks, draw the sample and measure every rung on it. fine: the error that matters, RMS: what
   is far below it need not be known. */
bool wr_study_begin(Study *study, WrRenderer *renderer, const WrFrameRequest *request, double fine,
                    WrError *err);
void wr_study_fini(Study *study);
/* The scene with a place's dials; the caller frees it. */
WrScene *wr_study_scene(const Study *study, Place place);
/* Each stratum's error with each kind at its place, all axes together, by a picture of the sample. foretold:
   what wr_study_predict says of the same. */
bool wr_study_check(Study *study, const Place places[KINDS], Error seen[STRATA],
                    double foretold[STRATA], WrError *err);

/* A frame of one setting; only NULL: whole. *work: processor seconds, but for what the setting needed to be made
   first; may be NULL. */
bool wr_study_render(Study *study, Place place, const unsigned char *only, WrFrame *frame,
                     double *work, WrError *err);
/* One setting on the whole sample, into *out. work: processor seconds of one sample; may be NULL. */
bool wr_study_try(Study *study, Place place, float *out, double *work, WrError *err);

/* ---- tolerance_pairs.c ---- */

/* What the reference is off, from what a way with fewer samples differs from it. */
void wr_study_judge_top(Study *study, int half_way);
/* From a sum of squares against the reference to what it would be against the truth, of which the reference
   is `own` off. */
double wr_study_mended(bool aligned, double measured, double own);
/* The same of a rate by that control. */
void wr_study_mend(const Study *study, const Control *control, Rate *rate);
/* All pairs of slopes and normal that may be worth it. fine: as above; change: root mean square, by 2 x 2 samples;
   one_work: processor seconds of the best pair's whole picture of one sample. */
bool wr_study_pairs(Study *study, double fine, double change, double one_work, WrError *err);

/* ---- tolerance_predict.c ---- */

/* Seconds that all blocks of a kind take with a setting. */
double wr_study_seconds(const Study *study, int kind, Place place);
/* Seconds of a picture of so many passes whose kinds take `seconds` together. */
double wr_study_passes(const Study *study, double seconds, int passes);
/* What a kind is off with a setting. */
Error wr_study_predict(const Study *study, int kind, Place place);
/* The sum alone, of one block. */
double wr_study_predict_block(const Study *study, int64_t block, Place place);
/* A sum of squares that is hardly ever too small, from errors by stratum: some standard errors above. */
double wr_study_cautious(const Error strata[STRATA]);
/* Root mean square of linear intensity over the whole picture, of a sum of squares. */
double wr_study_rms(const Study *study, double squares);
/* The same of a rate over the whole picture, cautiously. */
double wr_study_rate_rms(const Study *study, const Rate *rate, const Control *control);

/* ---- tolerance_blocks.c ---- */

/* Pack a picture, [height][width][4]. */
bool wr_packed_make(const Study *study, const float *rgba, Packed *out, WrError *err);
void wr_packed_fini(Packed *packed);
/* A block's BLOCK_FLOATS: zeros where it shows nothing. */
const float *wr_packed_block(const Packed *packed, int64_t block);
/* The same of a picture, into *out. */
void wr_block_take(const Study *study, const float *rgba, int64_t block, float *out);
/* Squared differences of R, G, B between two blocks. */
double wr_block_change(const float *a, const float *b);
/* What kinds of blocks the picture has, by study->one and study->two. Returns the root mean square change. */
double wr_study_sort(Study *study);
typedef struct Ranked {
    float size;
    int64_t block;
} Ranked;
/* A stratum's blocks by size, small to large; the caller frees. */
Ranked *wr_study_rank(const Study *study, int stratum);

/* ---- tolerance_sample.c ---- */

/* The controls of slopes and normal from their picture of one sample, [height][width][4]; NULL: of the best. */
void wr_study_control(Study *study, const float *rgba, Pair *pair);
/* What a pair's formulas are off, root mean square over the whole picture of one sample. */
double wr_study_formula_rms(const Study *study, const Pair *pair);
/* A sample of about that share of the blocks, of each stratum `least` if it has them. Three times the share holds
   most blocks that the share holds. */
void wr_study_draw(Study *study, double share, int64_t least);
/* The sample's blocks of a picture, one after the other; what lies beyond the picture is 0. */
void wr_study_gather(const Study *study, const float *rgba, float *out);
void wr_study_gather_packed(const Study *study, const Packed *packed, float *out);
/* a, b: of the sample, as gathered. */
void wr_study_compare(const Study *study, const float *a, const float *b, const float *control,
                      Rate *out);
/* What k x k samples are off along outlines that run with the pixels' rows or columns, by stratum, scaled to all
   blocks. rgba: of the sample, with those k x k samples. Every pixel there has the same coverage, a multiple
   of 1/k, whatever the true one: off by up to 1/(2k), and k and 2k may agree on the same wrong one. */
void wr_study_aligned(const Study *study, const float *rgba, int k, double squares[STRATA]);
/* Floats of the sample's blocks. */
size_t wr_study_floats(const Study *study);
/* Its sums by stratum. */
void wr_control_strata(const Control *control, double out[STRATA]);
/* Its sums by kind, from its blocks. */
void wr_control_add_up(const Study *study, Control *control);
void wr_control_fini(Control *control);

/* ---- tolerance_pick.c ---- */

typedef struct Wish {
    WrTolerance tolerance;
    double margin_rms, margin_max; /* parts of the tolerance to keep to, 0..1 */
    double weight[STRATA];         /* times that errors are above the prediction, 1 or more */
} Wish;
/* The cheapest places that keep to the tolerance by the study's word; of kinds without blocks they mean nothing. */
/* Returns the seconds of the whole picture with those. */
double wr_study_pick(const Study *study, const Wish *wish, Place places[KINDS]);

/* ---- tolerance_choice.c ---- */

/* The study's findings become the caller's choice: its parts. */
void wr_study_settle(const Study *study, const Place places[KINDS], WrChoice *out);

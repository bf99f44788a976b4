/* tolerance_inner.h - what choosing knows of a picture: its kinds of blocks, a sample of them, and what
   each rung does there.
   Layer 6, private to tolerance*.c. */
#pragma once
#include "accuracy/tolerance.h"

#define SCHEMES_MAX 2
#define MODES_MAX 3

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

/* KIND_EDGE + 0..1 and KIND_INSIDE + 0..4: by what a second row of samples changes. */
enum { KIND_EMPTY, KIND_EDGE, KIND_INSIDE = KIND_EDGE + 2 };

/* What the sample says of an error, by kind of block: the squares, summed over the pixels and channels of ALL
   blocks of the kind, how uncertain that sum is, and the largest difference of a channel on the sample. */
typedef struct Measure {
    double sum[WR_CHOICE_KINDS], variance[WR_CHOICE_KINDS], most[WR_CHOICE_KINDS];
} Measure;

/* Slopes and normal together, with all that is known of them. */
typedef struct Pair {
    bool tried;
    Measure point, two;          /* of one sample and of 2 x 2, against the reference */
    Measure own;                 /* of 2 x 2, against the best pair's 2 x 2 */
    double point_pace, two_pace; /* time, beside the best pair's */
} Pair;

/* One block of the picture. */
typedef struct Block {
    unsigned char kind;
    bool sampled;
    float size;    /* what it is drawn by: its change, and a little */
    float weight;  /* of its squared error, for the sum over all blocks of its kind */
    double change; /* squared difference between one sample and 2 x 2 */
    int covered;   /* pixels with coverage in the first picture */
} Block;

typedef struct Study {
    WrRenderer *renderer;
    const WrFrameRequest *request;
    int blocks_u, blocks_v;
    int64_t block_count;
    Block *block;                    /* [blocks_v][blocks_u] */
    unsigned char *mask;             /* [blocks_v][blocks_u] for WrFrameRequest.only */
    int64_t blocks[WR_CHOICE_KINDS]; /* of the picture */
    int64_t chosen[WR_CHOICE_KINDS]; /* of the sample */
    double pixels;                   /* of the object, half of each edge's included */
    int64_t sample_count;            /* blocks */
    float *one;                      /* [height][width][4], the best pair's, one sample a pixel */
    float *best;                     /* [sample_count][block][block][4]: the reference */
    float *middle;                   /* the same, of 8 x 8 samples; of the small sample */
    float *other;                    /* the same, of the setting at hand */
    WrScheme schemes[SCHEMES_MAX];   /* cheap to good; the last is the best */
    WrBumpMode modes[MODES_MAX];
    int scheme_count, mode_count;
    int top; /* the way that the others are measured against */
    /* Processor seconds and seconds of all frames so far: threads, and what others do on the machine, part
       them. */
    double work, wall;
    Pair pair[SCHEMES_MAX][MODES_MAX];
    bool tried[WAY_COUNT];
    Measure way[WAY_COUNT];                         /* with the best pair */
    double way_seconds[WAY_COUNT][WR_CHOICE_KINDS]; /* processor time of all blocks of a kind */
} Study;

/* A setting of all three axes, as indices. */
typedef struct Place {
    int scheme, mode, way;
} Place;

static inline bool wr_same_place(Place a, Place b)
{
    return a.scheme == b.scheme && a.mode == b.mode && a.way == b.way;
}

/* Sort the blocks, draw the sample and measure every rung on it. fine: the error that matters, RMS: what
   is far below it need not be known. */
bool wr_study_begin(Study *study, WrRenderer *renderer, const WrFrameRequest *request, double fine,
                    WrError *err);
void wr_study_fini(Study *study);
/* The scene with a place's dials; the caller frees it. */
WrScene *wr_study_scene(const Study *study, Place place);
/* The errors measured with each kind at its place, all axes together; the reference's own among them. */
bool wr_study_check(Study *study, const Place places[WR_CHOICE_KINDS], Measure *out, WrError *err);

/* ---- tolerance_predict.c ---- */

/* Seconds that all blocks of a kind take with a setting. */
double wr_study_seconds(const Study *study, int kind, Place place);
/* Its squared error there, and the largest. */
void wr_study_predict(const Study *study, int kind, Place place, Measure *out);
/* From what was measured against the reference to what it would be against the truth. The reference
   itself was not off at all: what it is off comes to that. */
void wr_study_mend(const Study *study, int kind, int way, Measure *out);
/* A sum of squares over all kinds that is hardly ever too small: two standard errors above. */
double wr_study_cautious(const Study *study, const Measure *measure);
/* Root mean square of linear intensity over the whole picture. */
double wr_study_rms(const Study *study, const Measure *measure);

/* ---- tolerance_sample.c ---- */

/* What kinds of blocks the picture has: study->one and the frame of 2 x 2. */
void wr_study_sort(Study *study, const WrFrame *two);
/* A sample of about that share of the blocks. */
void wr_study_draw(Study *study, double share);
/* The sample's blocks of a frame, one after the other; what lies beyond the picture is 0. */
void wr_study_gather(const Study *study, const WrFrame *frame, float *out);
void wr_study_compare(const Study *study, const float *a, const float *b, Measure *out);
/* Squared differences between that frame and study->one, by kind, of the whole picture. */
void wr_study_whole(const Study *study, const WrFrame *frame, double squares[WR_CHOICE_KINDS]);
/* What k x k samples are off along outlines that run with the pixels' rows or columns, by kind, scaled to all
   blocks. rgba: of the sample, with those k x k samples. Every pixel there has the same coverage, a multiple
   of 1/k, whatever the true one: off by up to 1/(2k), and k and 2k may agree on the same wrong one. */
void wr_study_aligned(const Study *study, const float *rgba, int k,
                      double squares[WR_CHOICE_KINDS]);
/* Floats of the sample. */
size_t wr_study_floats(const Study *study);

/* tolerance_inner.h - what choosing knows of a picture: its kinds of blocks, a sample of them, and what
   each rung does there.
   Layer 6, private to tolerance*.c. */
#pragma once
#include "accuracy/tolerance.h"

#define SCHEMES_MAX 2
#define MODES_MAX 3
#define WR_STUDY_WAYS 11

/* KIND_EDGE + 0..1 and KIND_INSIDE + 0..4: by how lively they are. */
enum { KIND_EMPTY, KIND_EDGE, KIND_INSIDE = KIND_EDGE + 2 };

/* A way against aliasing. */
typedef struct Way {
    WrAntialias aa;
    int samples;
    int low, high; /* ways that it is not measured but interpolated between; 0, 0: measured */
} Way;
extern const Way wr_study_ways[WR_STUDY_WAYS];

/* What one rung of an axis does to each kind of block. */
typedef struct Effect {
    bool tried;
    double squares[WR_CHOICE_KINDS]; /* squared error, summed over pixels and channels of ALL its
                                        blocks */
    double most[WR_CHOICE_KINDS];    /* largest error of a channel on the sample */
    double
        seconds[WR_CHOICE_KINDS]; /* processor time of all its blocks; of a scheme or a normal: on
                                        2 x 2 samples, and only the sum is known, in [0] */
} Effect;

/* One block of the picture. */
typedef struct Block {
    unsigned char kind;
    bool sampled;
    float size;    /* what it is drawn by: its energy, and a little */
    float weight;  /* of its squared error, for the sum over all blocks of its kind */
    double energy; /* of the differences between neighbouring pixels */
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
    Effect of_scheme[SCHEMES_MAX], of_mode[MODES_MAX], of_way[WR_STUDY_WAYS];
} Study;

/* A setting of all three axes, as indices. */
typedef struct Place {
    int scheme, mode, way;
} Place;

/* Sort the blocks, draw the sample and measure every rung on it. fine: the error that matters, RMS: what
   is far below it need not be known. */
bool wr_study_begin(Study *study, WrRenderer *renderer, const WrFrameRequest *request, double fine,
                    WrError *err);
void wr_study_fini(Study *study);
/* The scene with a place's dials; the caller frees it. */
WrScene *wr_study_scene(const Study *study, Place place);
/* Seconds and squared error that all blocks of a kind take with a setting. */
double wr_study_seconds(const Study *study, int kind, Place place);
double wr_study_squares(const Study *study, int kind, Place place);
double wr_study_most(const Study *study, int kind, Place place);
/* The same errors measured with each kind at its place, all axes together. */
bool wr_study_check(Study *study, const Place places[WR_CHOICE_KINDS],
                    double squares[WR_CHOICE_KINDS], double most[WR_CHOICE_KINDS], WrError *err);

/* ---- tolerance_sample.c ---- */

/* What kinds of blocks the frame has, and a sample of about that share of them. */
void wr_study_sort(Study *study, const WrFrame *frame);
void wr_study_draw(Study *study, double share);
/* The sample's blocks of a frame, one after the other; what lies beyond the picture is 0. */
void wr_study_gather(const Study *study, const WrFrame *frame, float *out);
/* Squared differences by kind, scaled to all blocks of the kind; and the largest. */
void wr_study_compare(const Study *study, const float *a, const float *b, double *squares,
                      double *most);
/* What k x k samples are off along outlines that run with the pixels' rows or columns, by kind, scaled to all
   blocks. rgba: of the sample, with those k x k samples. Every pixel there has the same coverage, a multiple
   of 1/k, whatever the true one: off by up to 1/(2k), and k and 2k may agree on the same wrong one. */
void wr_study_aligned(const Study *study, const float *rgba, int k,
                      double squares[WR_CHOICE_KINDS]);
/* Floats of the sample. */
size_t wr_study_floats(const Study *study);

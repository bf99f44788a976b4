/* octave_kernels.h - inner loops of octaves on square cells (texel_grid.c), compiled once per
   instruction set.

   All sets give the same bits: only + - * / floor, comparisons and conversions, without contraction.
   Private to this module.

   WrNoiseColumns contains the columns' data for all rows of a piece; WrNoiseLattice the prescribed
   values of one lattice row at the piece's lattice columns, used for all texel rows between it and the
   next; WrNoiseBlended the row's A, B and their derivatives by y, C and D. Then

     p = A_k + B_k x     q = A_(k+1) + B_(k+1) (x - 1)     f = p + alpha (q - p)
     fx = B_k + alpha (B_(k+1) - B_k) + alpha' (q - p)
     fy = the blend of C + D x as f is of A + B x. */
#pragma once
#include "noise/noise_internal.h"

#define WR_NOISE_BLOCK 16 /* texels; columns and rows of texels are padded to whole blocks */

/* At most one cell per texel: a cell for each, the rounding of the first and the last, and the far
 * corner; plus the points read by a block that begins at the last of them. */
#define WR_NOISE_POINTS (WR_NOISE_STRIP + 8 + WR_NOISE_BLOCK)

typedef struct WrNoiseColumns {
    int count;    /* texels */
    int points;   /* lattice columns */
    bool narrow;  /* at most half a cell per texel: 9 points in a block, 5 in half of one */
    double first; /* lattice column of the first texel, not reduced */
    int32_t cell[WR_NOISE_STRIP];    /* near lattice column, from the piece's first */
    float x[WR_NOISE_STRIP];         /* position within the cell */
    float alpha[WR_NOISE_STRIP];     /* the fade there */
    float rate[WR_NOISE_STRIP];      /* its derivative */
    uint32_t index[WR_NOISE_POINTS]; /* lattice index, within the period */
    uint32_t chain[WR_NOISE_POINTS]; /* partial hash including x */
    float set[2][16];                /* perlin: the set of slopes, along x and along y */
} WrNoiseColumns;

typedef struct WrNoiseLattice {
    double index; /* floor(t), not reduced; NaN: empty */
    float f[WR_NOISE_POINTS], gx[WR_NOISE_POINTS], gy[WR_NOISE_POINTS];
} WrNoiseLattice;

typedef struct WrNoiseBlended {
    float a[WR_NOISE_POINTS], b[WR_NOISE_POINTS], c[WR_NOISE_POINTS], d[WR_NOISE_POINTS];
} WrNoiseBlended;

/* Texel rows of a piece, from the top: v falls, and so does the lattice row. */
typedef struct WrNoiseRows {
    int count;
    double whole[WR_NOISE_BAND]; /* the lattice row below, not reduced */
    float y[WR_NOISE_BAND];      /* position above it */
    float alpha[WR_NOISE_BAND], rate[WR_NOISE_BAND];
} WrNoiseRows;

/* Contribution of an octave: n += factor f, or n += factor |f| - below. */
typedef struct WrNoiseShare {
    float factor, below;
    bool magnitude;
} WrNoiseShare;

typedef struct WrNoiseKernels {
    const char *name; /* "v1", "v3", "v4": levels of x86-64; v1 is plain C everywhere */

    /* Computes first, cell, x, alpha, rate of columns->count texels from `i` on of `width`, t =
     * frequency u + offset; blocks are padded with texels beyond. */
    void (*place)(const WrFadeInfo *fade, double frequency, double offset, int i, int width,
                  WrNoiseColumns *columns);
    /* Computes the rows along v: rows->count rows from `j` on of `height`. */
    void (*stand)(const WrFadeInfo *fade, double frequency, double offset, int j, int height,
                  WrNoiseRows *rows);
    /* Computes f, gx, gy of a hashed lattice's row; `part` is the row's part of the hash. */
    void (*prescribe)(WrNoiseKind kind, const WrNoiseColumns *columns, uint32_t part,
                      WrNoiseLattice *row);
    /* y from the near row, the fade there and its derivative. */
    void (*blend)(int points, const WrNoiseLattice *near, const WrNoiseLattice *far, float y,
                  float alpha, float rate, WrNoiseBlended *out);
    void (*heights)(const WrNoiseColumns *columns, const WrNoiseBlended *in, float *f);
    void (*slopes)(const WrNoiseColumns *columns, const WrNoiseBlended *in, float *fx, float *fy);
    /* Adds rows first .. first + count - 1, all between `near` and `far`, to n: blend, heights and add
     * in one. Columns must be narrow. n: the first of these rows, columns->count texels of each are
     * written. */
    void (*sum)(const WrNoiseColumns *columns, const WrNoiseLattice *near,
                const WrNoiseLattice *far, const WrNoiseRows *rows, int first, int count,
                WrNoiseShare share, float *n, size_t pitch);
    /* f[i] = level + amplitude f[i], in double and rounded. */
    void (*scale)(double level, double amplitude, int count, float *f);
    /* n[i] += factor f[i]; n[i] += factor |f[i]| - below. Whole blocks of f are read, count of n. */
    void (*add)(float factor, const float *f, int count, float *n);
    void (*add_magnitude)(float factor, float below, const float *f, int count, float *n);
} WrNoiseKernels;

extern const WrNoiseKernels wr_noise_kernels_v1, wr_noise_kernels_v3, wr_noise_kernels_v4;

/* The fastest table for this processor. */
const WrNoiseKernels *wr_noise_kernels(void);

/* Enumerates the tables, index = 0, 1, ...; NULL where this processor cannot run that one, or past the
 * last. */
const WrNoiseKernels *wr_noise_kernels_at(int index);

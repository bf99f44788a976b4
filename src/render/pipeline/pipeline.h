/* pipeline.h - from places in the sample grid to intensities: the plan's stages over strips, in single or in
   double precision (pipeline_body.h is compiled twice).
   Layer 5, private to the renderer. */
#pragma once
#include "render/frame/tile.h"

#include <stdbool.h>
#include <stddef.h>

struct WrPipe {
    /* Row y of the tile, whose x, y, w, h are samples of a grid of k x k a pixel; with tile->shift each
       sample stands that far from its place. A mesh's depth tile was rasterised before. */
    void (*row)(const WrTileJob *job, int k, const WrDepthTile *tile, int y, const WrSink *sink,
                WrTileScratch *scratch);
    /* The samples of scratch->scatter; their places in it are the sink's indices. */
    void (*points)(const WrTileJob *job, int k, const WrDepthTile *tile, const WrSink *sink,
                   WrTileScratch *scratch);
    /* u, v, face of one sample; false where nothing is. */
    bool (*pick)(const WrTileJob *job, int gx, int gy, WrTileScratch *scratch, double *u, double *v,
                 int *face);
};

extern const WrPipe wr_pipe, wr_pipe_double;

/* What of the job the kernels of several stages at once (simd_kernels.h) are for: fills wide_newton, sheet, wide_sphere,
   wide_met, balls, grey. */
void wr_pipe_wide(WrTileJob *job);
/* Those draw all of a sphere under one lamp, if its highlight suits them. */
bool wr_pipe_at_once(const WrPlan *plan);
/* How samples of the job's mesh are solved. */
WrNewton wr_pipe_newton(const WrTileJob *job);

/* Refine a tile by dials.h's rule: a first sample at each centre, then k x k where it is called for. */
void wr_refine_tile(const WrTileJob *job, int x, int y, int w, int h, WrTileScratch *scratch);
/* The same of several objects: jobs[count], the nearest first; canvas: where pixels go; index: of the tile in their `seen`. */
void wr_refine_group(const WrTileJob *canvas, const WrTileJob *jobs, int count, WrTilePart part,
                     int index, WrTileScratch *scratch);
/* Is that for less than K x K everywhere? Told from a few blocks of the picture, whatever part of it is wanted. The
   scratch's counts are spoilt. */
bool wr_refine_pays(const WrTileJob *job, WrTileScratch *scratch);
/* Fill tile->shift for a grid of k x k a pixel (spread=jittered). */
void wr_tile_jitter(WrDepthTile *tile, int k, signed char *shift);
/* A depth tile of w x h samples at (x, y) of the grid of k a pixel; rasterised where there is a mesh. */
WrDepthTile wr_tile_depth(const WrTileJob *job, int k, int x, int y, int w, int h,
                          WrTileScratch *scratch);
/* The mean of the k x k samples of a pixel, added up in pairs; sample [k][k] at `step` floats a row, is
   overwritten. */
void wr_tile_mean(float *sample, int k, size_t step, float out[4]);

/* Clock readings cost as much as a short stage, so one strip in sixteen is timed: what all strips took is shared among
   the stages as it was on those. */
#define WR_TIMED 16

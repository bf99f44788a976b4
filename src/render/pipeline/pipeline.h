/* pipeline.h - the plan's stages over strips of samples, from grid position to intensity.
   Private to the renderer. pipeline_body.h is compiled twice, in single and in double precision. */
#pragma once
#include "render/frame/tile.h"

#include <stdbool.h>
#include <stddef.h>

struct WrPipe {
    /* Renders row y of the tile, whose x, y, w, h are in samples of a grid of k x k a pixel. tile->shift, if
       set, offsets each sample. The depth tile of a mesh must have been rasterised. */
    void (*row)(const WrTileJob *job, int k, const WrDepthTile *tile, int y, const WrSink *sink,
                WrTileScratch *scratch);
    /* Renders the samples of scratch->scatter; their indices in it are the sink's indices. */
    void (*points)(const WrTileJob *job, int k, const WrDepthTile *tile, const WrSink *sink,
                   WrTileScratch *scratch);
    /* u, v, face of one sample; false on the background. */
    bool (*pick)(const WrTileJob *job, int gx, int gy, WrTileScratch *scratch, double *u, double *v,
                 int *face);
};

extern const WrPipe wr_pipe, wr_pipe_double;

/* Chooses the work that the fused SIMD kernels (simd_kernels.h) do for the job: fills wide_sphere,
   wide_met, balls, grey. */
void wr_pipe_wide(WrTileJob *job);
/* True if the fused kernels draw all of a sphere under one lamp, which depends on its highlight. */
bool wr_pipe_at_once(const WrPlan *plan);

/* Adaptive sampling of a tile by the rule of dials.h: a first sample at each centre, then k x k where needed. */
void wr_refine_tile(const WrTileJob *job, int x, int y, int w, int h, WrTileScratch *scratch);
/* Adaptive sampling of several objects: jobs[count], the nearest first; canvas: target of the pixels; index: of
   the tile in their `seen`. */
void wr_refine_group(const WrTileJob *canvas, const WrTileJob *jobs, int count, WrTilePart part,
                     int index, WrTileScratch *scratch);
/* True if adaptive sampling costs less than K x K everywhere. Estimated from a few blocks of the whole picture,
   whichever part is rendered. Overwrites the scratch's counters. */
bool wr_refine_pays(const WrTileJob *job, WrTileScratch *scratch);
/* A depth tile of w x h samples at (x, y) of the grid of k x k a pixel; rasterised if there is a mesh. */
WrDepthTile wr_tile_depth(const WrTileJob *job, int k, int x, int y, int w, int h,
                          WrTileScratch *scratch);
/* Mean of the k x k samples of a pixel, added in pairs. sample: [k][k], `step` floats from row to row;
   overwritten. */
void wr_tile_mean(float *sample, int k, size_t step, float out[4]);

/* Reading the clock costs as much as a short stage, so one strip in sixteen is timed. The total time of all
   strips is divided among the stages in the ratio measured on those. */
#define WR_TIMED 16

/* tile.h - one tile of a picture: visibility, then the plan's stages strip by strip, then the mean of
   the samples of each pixel.
   Layer 5, private to the renderer. */
#pragma once
#include "render/keep.h"
#include "render/mesh.h"
#include "render/plan.h"

#define WR_TILE_SAMPLES_W 256 /* at most, along a tile */
#define WR_TILE_SAMPLES_H 64

typedef enum WrStage {
    WR_STAGE_VISIBILITY, /* rays against closed forms, or triangles into the depth tile */
    WR_STAGE_NEWTON,
    WR_STAGE_GEOMETRY,
    WR_STAGE_CURVATURE,
    WR_STAGE_LOOK, /* F, Fu, Fv */
    WR_STAGE_BUMP,
    WR_STAGE_COLOUR,
    WR_STAGE_DIFFUSE,
    WR_STAGE_SPECULAR,
    WR_STAGE_RESOLVE,
    WR_STAGE_COUNT
} WrStage;

/* What all tiles of a frame share; read only while they run. */
typedef struct WrTileJob {
    const WrView *view;
    const WrPlan *plan;
    const WrScene *scene;
    const WrKernels *kernels;
    const WrViewMesh *mesh; /* NULL: closed form */
    WrLook look;
    WrColourLook colour; /* rgba NULL: none */
    int samples;         /* K */
    int width, height;   /* pixels */
    int tile_w, tile_h;  /* pixels */
    float *rgba;         /* the picture */
    WrBlocks *seen;      /* [tiles] to fill with what each tile looks at; NULL: not wanted */
} WrTileJob;

/* One thread's memory and counts. */
typedef struct WrTileScratch {
    WrStrip strip;
    float close[WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H];
    float u[WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H], v[WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H];
    float plane[4][WR_TILE_SAMPLES_H][WR_TILE_SAMPLES_W]; /* R, G, B, A of the samples */
    double seconds[WR_STAGE_COUNT];
    int64_t covered, shaded; /* pixels, samples */
    int64_t tiles;           /* that held anything */
    WrBlocks *seen;          /* of the tile at hand; NULL: not wanted */
    unsigned strips;         /* counts strips: one in eight is timed */
} WrTileScratch;

/* Tile sizes for K x K samples: about 256 x 32 samples whatever K. */
void wr_tile_size(int samples, int *tile_w, int *tile_h);
/* index: of the tile in job->seen. */
void wr_tile_render(const WrTileJob *job, int tile_x, int tile_y, int index,
                    WrTileScratch *scratch);
/* (u,v) and face at one sample of the grid; false where nothing is. Uses scratch. */
bool wr_tile_pick(const WrTileJob *job, int gx, int gy, WrTileScratch *scratch, double *u,
                  double *v, int *face);

/* tile.h - renderer of one tile: visibility, then the plan's stages strip by strip, then the mean of each
   pixel's samples. Private to the renderer. */
#pragma once
#include "render/frame/pixel_encode.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "render/caches/dirty_regions.h"
#include "render/simd/simd_kernels.h"
#include "render/textures/slope_pyramid.h"
#include "render/visibility/raster.h"
#include "render/textures/ambient_occlusion.h"
#include "render/visibility/parallax.h"
#include "render/plan/plan.h"
#include "render/caches/uv_cache.h"
#include "render/caches/relight_cache.h"
#include "render/environment/env_setup.h"
#include "render/tessellation/dice.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_TILE_SAMPLES_W 256 /* maximum, along a tile */
#define WR_TILE_SAMPLES_H 64
#define WR_TILE_ROOM (WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H + WR_WALK_PAD)

typedef struct WrShadowRays WrShadowRays;
typedef struct WrFrames WrFrames;
typedef struct WrHorizon WrHorizon;
typedef struct WrPipe WrPipe;

/* A picture mapped over u and v, in the form that kernels fetch. */
typedef struct WrPictureLook {
    WrColourLook near; /* rgba NULL: none */
    WrLook far;        /* filtered by footprints; pyramid NULL: not requested */
    WrLookd far_double;
} WrPictureLook;

/* Inputs shared by all tiles of a frame; read only while they run. */
typedef struct WrTileJob {
    const WrView *view;
    const WrPlan *plan;
    const WrScene *scene;
    const WrPipe *pipe; /* single or double precision */
    const WrKernels *kernels;
    const WrKernelsd *kernels_double; /* for shading or heights in double; else NULL */
    const WrViewMesh *mesh;           /* NULL: rays are solved in closed form */
    const WrUvCache *uv_cache;        /* uv cache of the view, to read or to fill; NULL: neither */
    const WrViewTriangles *triangles; /* of a mesh file; or NULL */
    WrTriangleLook triangle_look;
    const WrDice *dice;         /* source of the triangles of a displaced surface; or NULL */
    bool seen_before;           /* `uv_cache` is complete and read */
    const WrRelight *relight;   /* relight cache to read; or NULL */
    const WrRelight *noting;    /* relight cache to fill; or NULL */
    const WrRelightLamp *lamps; /* cached visibility of the lamps; NULL: not cached */
    unsigned recalls;           /* bits of the WrRelightGroup that shading reads */
    bool newton;                /* Newton's method refines the mesh's parameters */
    WrLook look;
    WrLookd look_double;                /* fetch parameters of kernels_double */
    WrEffects looks;                    /* effects of a fetch from the table, by its inputs */
    const WrHorizon *horizon;           /* of the table, for shadows and ambient occlusion */
    const WrOcclusionMapTable *opening; /* ambient occlusion map of the relief */
    double relief_height;               /* height of one table unit, kernel units, above 0 */
    const WrShadowRays *cast; /* possible occluders of lamps; read if the plan runs shadow rays */
    int cast_count;           /* length of cast->to */
    const WrWide *wide;       /* fused SIMD kernels of several stages; or NULL */
    WrWideCodes wide_codes;   /* parameters of fused kernels that write codes; or NULL */
    WrSphereRows *balls;      /* for each grid of the view; filled if rows use sphere rows */
    bool wide_sphere;         /* rows use sphere rows */
    bool wide_met;            /* they also compute the ray-sphere hits */
    bool grey;                /* red, green and blue are equal in all samples */
    double cast_unit;         /* kernel units -> those of the occluders' object space */
    WrParallax parallax;      /* read if the plan runs parallax */
    WrLevel level;            /* slope bounds of the table; only for one of the next two */
    /* runs of samples are tested: is the table flat there? are all lights behind the surface? */
    bool ground, dark;
    WrMatter matter; /* parameters of the plan's light model; kd and ks of the terms that run */
    WrEnvironmentMapLook surround;
    WrPictureLook colour, facets[WR_FACET_KINDS];
    WrKernGrain grain; /* the solid texture */
    WrKernGraind grain_double;
    bool grain_roughens;    /* the solid texture drives roughness */
    double grain_texels[2]; /* its texels along u and v, at most; 0: unknown, or there is none */
    double rough;           /* roughness where no map sets it */
    WrKernVary vary;        /* read only if roughness varies or lobes widen */
    WrKernVaryd vary_double;
    WrLook relief; /* slopes of the normal map (mips.h); pyramid NULL: none */
    WrLookd relief_double;
    const WrFrames *frames; /* tangent frames at the mesh's corners, for the normal map; or NULL */
    int samples;            /* K: samples a side of a pixel */
    int width, height;      /* pixels */
    int top, rows;          /* the requested band */
    int tile_w, tile_h;     /* pixels */
    int tiles_u;
    float *
        rgba; /* the picture's band, or a part of it from (x0, y0) on; NULL: only codes are written */
    size_t rgba_pitch; /* pixels per row */
    int x0, y0;
    uint32_t *codes; /* the band as 8-bit codes over the backdrop; or NULL */
    WrPixelEncoder coder;
    const WrBackdrop *backdrop; /* background of the band */
    float *normals;             /* as in WrFrameRequest; or NULL */
    uint8_t *map;               /* as in WrFrameRequest; or NULL */
    WrDirty *seen;              /* dirty-region record to fill; NULL: none */
    int object;                 /* index of the object in the scene */
} WrTileJob;

/* Depth and object of a sample, in pictures of several objects. */
typedef struct WrNearest {
    float depth; /* by the view's `deep`; INFINITY: background */
    int object;  /* index in the scene; at equal depths the lower one is visible */
} WrNearest;

/* Destinations of a strip's results, indexed by sample; NULL: not requested. */
/* Red, green, blue and alpha of a sample, computed and stored at once. */
typedef float WrSampleColour __attribute__((vector_size(16)));

typedef struct WrSink {
    float *rgba; /* 4 per sample */
    /* 1 per sample: rgba as 8-bit codes. If rgba and codes are NULL, no light is computed */
    uint32_t *codes;
    /* No sample of the row of `wide` samples from (x, y) on is hit twice: codes are final and opaque. The
       background is not stored yet: the first strip that is stored also writes it outside the strip. */
    bool once;
    int x, y, wide;
    float *normals;     /* n', 3 per sample */
    WrNearest *nearest; /* 1 per sample; samples behind the stored depth are not written */
    float *bound;       /* largest change of intensity over the pixel */
    double pixel;       /* pixel side for the bound, in samples */
    float *uv;          /* u and v, 2 per sample, where the table or pictures are fetched */
    float *
        texels; /* texels per pixel, the larger number of the table and of the colour picture; 0: nothing is fetched */
} WrSink;

/* Samples at arbitrary positions of a grid. */
typedef struct WrScatter {
    int count;
    double x[WR_SPAN], y[WR_SPAN]; /* in grid samples */
    int cell[WR_SPAN];             /* index in the depth tile (mesh) */
} WrScatter;

/* A rectangle of pixels of the picture. */
typedef struct WrTilePart {
    int x, y, w, h;
} WrTilePart;

/* Tile size of `adaptive`, and width of the ring around it, pixels. A larger tile has relatively less ring, but
   more of it is rendered again after an edit. */
#define WR_REFINE_RING 2
#define WR_REFINE_W 124
#define WR_REFINE_H 60

/* Memory and counters of one thread. */
typedef struct WrTileScratch {
    WrStrip strip, near, far; /* near, far: the two mip levels of filtered slope fetches */
    WrStripd *wide;           /* [3], those strips in double; allocated on first use */
    /* [WR_TILE_SAMPLES_H], for several objects; allocated on first use */
    WrNearest (*nearest)[WR_TILE_SAMPLES_W];
    WrScatter scatter;
    float close[WR_TILE_ROOM], u[WR_TILE_ROOM], v[WR_TILE_ROOM];
    signed char shift[2 * WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H]; /* jitter offsets */
    float sample[WR_TILE_SAMPLES_H][WR_TILE_SAMPLES_W][4];        /* R, G, B, A */
    float mean[WR_REFINE_W * WR_REFINE_H]
              [4]; /* a tile's pixels before encoding, for several samples a pixel */
    /* adaptive: first samples, with the ring of pixels round the tile */
    float centre[WR_REFINE_H + 2 * WR_REFINE_RING][WR_REFINE_W + 2 * WR_REFINE_RING][4];
    /* u and v of the first samples */
    float uv[WR_REFINE_H + 2 * WR_REFINE_RING][WR_REFINE_W + 2 * WR_REFINE_RING][2];
    float texels[WR_REFINE_H][WR_REFINE_W]; /* adaptive: texels per pixel */
    float bound[WR_REFINE_H][WR_REFINE_W];  /* adaptive: largest error of one sample */
    /* adaptive: the pixel needs more samples (WR_OPEN) */
    unsigned char open[WR_REFINE_H][WR_REFINE_W];
    unsigned char list[WR_REFINE_W * WR_REFINE_H][2]; /* adaptive: x, y of the listed pixels */
    /* of strips; only the ratios count: one strip in sixteen is measured */
    double seconds[WR_STAGE_COUNT];
    double all_strips;            /* total time of all strips */
    double whole[WR_STAGE_COUNT]; /* of parts that are measured each time */
    double all;                   /* total time of all its tiles */
    int64_t covered, shaded;      /* pixels, samples */
    bool uv_known;                /* the strip's u and v arrived together with its points */
    int face;                     /* face of a displaced surface that the strip's samples lie on */
    bool behind;                  /* the background of the current row is stored */
    int64_t met; /* first samples of the last refined tile that hit something, counted per object */
    int64_t tiles;                      /* tiles that are not empty */
    int64_t not_finite;                 /* non-finite numbers among those encoded */
    int64_t spared[WR_RUN_KINDS];       /* samples that skipped work, for each bit of WrRun */
    int64_t spared_tiles[WR_RUN_KINDS]; /* tiles whose samples all skipped it */
    int64_t wide_samples;               /* filter, moments: samples that fetched above level 0 */
    int64_t wide_tints;                 /* samples that fetched the colour picture above level 0 */
    unsigned char wide_of[WR_SPAN], tint_of[WR_SPAN]; /* samples of the last strip that did so */
    WrEffects ran;                                    /* set by the code that runs each effect */
    WrDirtyNotes notes;                               /* dirty-region record of the current tile */
    WrTilePart mapped; /* pixels whose cost map this thread writes: its tile's */
    unsigned strips;   /* strip counter: one strip in sixteen is timed */
    int32_t picked;    /* last picked triangle */
} WrTileScratch;

_Static_assert(WR_REFINE_W + 2 * WR_REFINE_RING <= WR_SPAN, "a row of a tile is a strip");
_Static_assert((WR_REFINE_W + 2 * WR_REFINE_RING) * (WR_REFINE_H + 2 * WR_REFINE_RING) <=
                   WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H,
               "a tile is a depth tile");
_Static_assert(WR_REFINE_W *WR_REFINE_H >= WR_TILE_SAMPLES_W * 32 / 2, "tiles of 2 x 2 and more");

/* Records that an effect ran. */
static inline void wr_did(WrTileScratch *scratch, WrEffect effect)
{
    scratch->ran |= WR_EFFECT_BIT(effect);
}

/* Index of a picture's pixel in the stored band. */
static inline size_t wr_tile_place(const WrTileJob *job, int x, int y)
{
    return (size_t)(y - job->top) * (size_t)job->width + (size_t)x;
}

static inline float *wr_tile_pixel(const WrTileJob *job, int x, int y)
{
    return job->rgba + ((size_t)(y - job->y0) * job->rgba_pitch + (size_t)(x - job->x0)) * 4;
}

/* True if Newton's method evaluates the surface after its last step as well. A fixed number of steps is kept.
   Exact normals combine Pu and Pv with n_u and n_v, which must belong to the same point, whether or not the plan
   runs those terms. */
static inline bool wr_tile_exact(const WrTileJob *job)
{
    return job->plan->newton >= 0 || job->scene->bump == WR_BUMP_EXACT;
}

/* Samples a side, encoded for the cost map. */
static inline uint8_t wr_tile_encode_samples(int k)
{
    int level = 0;
    while (1 << level < k) level++;
    return (uint8_t)(level * WR_MAP_SAMPLES);
}

/* Adds bits to a pixel's cost map; pixels of other tiles belong to other threads and are skipped. */
static inline void wr_tile_map(const WrTileJob *job, const WrTileScratch *scratch, int x, int y,
                               uint8_t bits)
{
    const WrTilePart *own = &scratch->mapped;
    if (x < own->x || y < own->y || x >= own->x + own->w || y >= own->y + own->h) return;
    job->map[wr_tile_place(job, x, y)] |= bits;
}

/* Tile size for K x K samples: about 256 x 32 samples for any K. blocks: the width is a multiple of
   WR_FRAME_BLOCK pixels, or a power of two that divides it, and the height is at most WR_FRAME_BLOCK. */
void wr_tile_size(int samples, bool adaptive, bool blocks, int *tile_w, int *tile_h);
/* Renders a tile or a part of one, within the band; index: of the tile, for job->seen. */
void wr_tile_render(const WrTileJob *job, WrTilePart part, int index, WrTileScratch *scratch);
/* Renders a tile of several objects: jobs[count] in drawing order, the nearest first, all of one picture and one
   number of samples. canvas: target of the pixels. */
void wr_tile_render_group(const WrTileJob *canvas, const WrTileJob *jobs, int count,
                          WrTilePart part, int index, WrTileScratch *scratch);
/* (u,v) and face at one sample of the grid; false on the background. Uses scratch. */
bool wr_tile_pick(const WrTileJob *job, int gx, int gy, WrTileScratch *scratch, double *u,
                  double *v, int *face);

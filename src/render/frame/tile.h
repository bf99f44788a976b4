/* tile.h - one tile of a picture: visibility, then the plan's stages strip by strip, then the mean of
   the samples of each pixel.
   Layer 5, private to the renderer. */
#pragma once
#include "render/frame/pixel_encode.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "render/caches/dirty_regions.h"
#include "render/simd/simd_kernels.h"
#include "render/textures/slope_bounds.h"
#include "render/visibility/uv_raster.h"
#include "render/textures/ambient_occlusion.h"
#include "render/visibility/parallax.h"
#include "render/plan/plan.h"
#include "render/caches/uv_cache.h"
#include "render/caches/relight_cache.h"
#include "render/environment/env_setup.h"
#include "render/tessellation/dice.h"
#include "render/visibility/triangle_raster.h"

#include <stdbool.h>
#include <stdint.h>

#define WR_TILE_SAMPLES_W 256 /* at most, along a tile */
#define WR_TILE_SAMPLES_H 64
#define WR_TILE_ROOM (WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H + WR_WALK_PAD)

typedef struct WrShadowRays WrShadowRays;
typedef struct WrFrames WrFrames;
typedef struct WrHorizon WrHorizon;
typedef struct WrPipe WrPipe;

/* A picture that is laid over u and v, as kernels look it up. */
typedef struct WrPictureLook {
    WrColourLook near; /* rgba NULL: none */
    WrLook far;        /* its means over footprints; pyramid NULL: not wanted */
    WrLookd far_double;
} WrPictureLook;

/* What all tiles of a frame share; read only while they run. */
typedef struct WrTileJob {
    const WrView *view;
    const WrPlan *plan;
    const WrScene *scene;
    const WrPipe *pipe; /* in single or in double precision */
    const WrKernels *kernels;
    const WrKernelsd *kernels_double; /* shading or heights in double; else NULL */
    const WrViewMesh *mesh;           /* NULL: closed form */
    const WrUvCache
        *sight; /* what the view's samples look at, or where that is noted; NULL: neither */
    const WrViewTriangles *triangles; /* a mesh out of a file; or NULL */
    WrTriangleLook triangle_look;
    const WrDice *dice; /* of a displaced surface, what the triangles are; or NULL */
    bool seen_before;   /* it is known */
    const WrRelight
        *steady; /* what light looks at of the view's samples, which is known; or NULL */
    const WrRelight *noting;    /* where that is noted; or NULL */
    const WrRelightLamp *lamps; /* what samples see of the lamps; NULL: it is not kept */
    unsigned recalls;           /* bits of WrRelightGroup that light looks at */
    bool newton;                /* the mesh's parameters are made exact */
    WrLook look;
    WrLookd look_double;                /* where kernels_double looks */
    WrEffects looks;                    /* what a look-up in the table does, by what it was given */
    const WrHorizon *horizon;           /* of the table, for shadows and occlusion */
    const WrOcclusionMapTable *opening; /* how open the relief is */
    double relief_height;               /* of a table unit, kernel units, above 0 */
    const WrShadowRays *cast;  /* what can hide lamps from it; read where the plan runs that */
    int cast_count;            /* of cast->to */
    const WrWide *wide;        /* kernels of several stages at once; or NULL */
    WrWideCodes wide_codes;    /* codes of strips; or NULL */
    WrSphereRows *balls;       /* of each grid of the view; filled where rows go to them */
    bool wide_sphere;          /* rows go to them */
    bool wide_met;             /* where rays meet a sphere is asked of them */
    bool wide_newton;          /* (u,v) of a mesh's samples are */
    WrWideSheet sheet;         /* of what */
    const WrSparseHits *knots; /* of the mesh; or NULL */
    bool grey;                 /* red, green and blue of all samples are the same */
    double cast_unit;          /* kernel units -> those of the object */
    WrParallax parallax;       /* read where the plan runs that */
    WrLevel level;             /* how steep the table is where; only for one of the next two */
    bool ground,
        dark; /* runs of samples are asked: is the table level there? Are all lights behind? */
    WrMatter matter; /* what the plan's model goes by; kd and ks of what runs */
    WrEnvironmentMapLook surround;
    WrPictureLook colour, facets[WR_FACET_KINDS];
    WrKernGrain grain; /* the solid texture */
    WrKernGraind grain_double;
    bool grain_roughens;    /* it drives roughness */
    double grain_texels[2]; /* of it along u and v, at most; 0: not known, or there is none */
    double rough;           /* where no place has its own */
    WrKernVary vary;        /* only where some has, or lobes widen */
    WrKernVaryd vary_double;
    WrLook relief; /* the normal map's slopes (normal_mips.h); pyramid NULL: none */
    WrLookd relief_double;
    const WrFrames *frames; /* of the mesh's corners, that the map is turned by; or NULL */
    int samples;            /* K */
    int width, height;      /* pixels */
    int top, rows;          /* the band of it that is wanted */
    int tile_w, tile_h;     /* pixels */
    int tiles_u;
    float *
        rgba; /* the picture's band, or a part of it from (x0, y0) on; NULL: codes alone are wanted */
    size_t rgba_pitch; /* pixels a row */
    int x0, y0;
    uint32_t *codes; /* the band as 8-bit codes over `background`; or NULL */
    WrPixelEncoder coder;
    const WrBackdrop *backdrop; /* of the band */
    float *normals;             /* WrFrameRequest's; or NULL */
    uint8_t *map;               /* likewise */
    WrDirty *seen;              /* to note what each tile looks at; NULL: not wanted */
    int object;                 /* which of the scene's it draws */
} WrTileJob;

/* What a sample of several objects shows. */
typedef struct WrNearest {
    float depth; /* by the view's `deep`; INFINITY: nothing yet */
    int object;  /* its place among the scene's: of equal depths the lower one is seen */
} WrNearest;

/* Where a strip's results go, by the samples' index; members that are not wanted are NULL. */
typedef struct WrSink {
    float *rgba;     /* 4 a sample */
    uint32_t *codes; /* one a sample: rgba as 8-bit codes; with neither, no light is worked out */
    /* No sample of the row of `wide` from (x, y) on is met twice: codes are the picture's own, opaque everywhere. What
       lies behind it is not there yet: the first strip that is stored brings it to where the strip is not. */
    bool once;
    int x, y, wide;
    float *normals;     /* 3 a sample: n' */
    WrNearest *nearest; /* one a sample; what lies behind it is not stored */
    float *bound;       /* how far the intensity may change over the pixel */
    double pixel;       /* of the bound, samples a side */
    float *uv;          /* 2 a sample: u and v, where table or pictures are looked up */
    float *
        texels; /* how many of table and colour picture lie along a pixel, at most; only those that are not 0 */
} WrSink;

/* Samples anywhere in a grid, by their places. */
typedef struct WrScatter {
    int count;
    double x[WR_SPAN], y[WR_SPAN]; /* grid samples */
    int cell[WR_SPAN];             /* place in the depth tile (mesh) */
} WrScatter;

/* Pixels of the picture that a tile is made of. */
typedef struct WrTilePart {
    int x, y, w, h;
} WrTilePart;

/* Pixels of a tile of `adaptive`, and of the ring about it: the larger, the less the ring counts, and the more is
   rendered again for an edit. */
#define WR_REFINE_RING 2
#define WR_REFINE_W 124
#define WR_REFINE_H 60

/* One thread's memory and counts. */
typedef struct WrTileScratch {
    WrStrip strip, near, far;                /* near, far: look-ups of filtered slopes */
    WrStripd *wide;                          /* [3], the same in double; made on first use */
    WrNearest (*nearest)[WR_TILE_SAMPLES_W]; /* [WR_TILE_SAMPLES_H], of several objects; likewise */
    WrScatter scatter;
    float close[WR_TILE_ROOM], u[WR_TILE_ROOM], v[WR_TILE_ROOM];
    signed char shift[2 * WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H]; /* jittered */
    float sample[WR_TILE_SAMPLES_H][WR_TILE_SAMPLES_W][4];        /* R, G, B, A */
    float mean[WR_REFINE_W * WR_REFINE_H]
              [4]; /* several samples a pixel: a tile's pixels, before they become codes */
    /* adaptive: first samples, with the ring of pixels round the tile */
    float centre[WR_REFINE_H + 2 * WR_REFINE_RING][WR_REFINE_W + 2 * WR_REFINE_RING][4];
    float uv[WR_REFINE_H + 2 * WR_REFINE_RING][WR_REFINE_W + 2 * WR_REFINE_RING][2]; /* theirs */
    float texels[WR_REFINE_H][WR_REFINE_W];           /* adaptive: along a pixel */
    float bound[WR_REFINE_H][WR_REFINE_W];            /* adaptive: how far one sample may be off */
    unsigned char open[WR_REFINE_H][WR_REFINE_W];     /* adaptive: the pixel needs more */
    unsigned char list[WR_REFINE_W * WR_REFINE_H][2]; /* adaptive: x, y of those at hand */
    double seconds[WR_STAGE_COUNT]; /* of strips, in what ratio: a sixteenth of them is measured */
    double all_strips;              /* what they took together */
    double whole[WR_STAGE_COUNT];   /* of what is measured each time */
    double all;                     /* of all its tiles */
    int64_t covered, shaded;        /* pixels, samples */
    bool told;                      /* the strip's u and v came with its points */
    int face;                       /* of a displaced surface: that the strip's samples lie on */
    bool behind;                    /* what lies behind the row at hand is there */
    int64_t met;   /* samples of the last tile that was refined that met something, however often */
    int64_t tiles; /* that held anything */
    int64_t not_finite;           /* numbers that were not finite, among codes */
    int64_t spared[WR_RUN_KINDS]; /* samples that were spared that, by bits of WrRun */
    int64_t
        spared_tiles[WR_RUN_KINDS]; /* tiles whose samples were all spared for one of those bits */
    int64_t wide_samples;           /* filter, moments: that looked above level 0 */
    int64_t wide_tints;             /* the same of the colour picture */
    unsigned char wide_of[WR_SPAN],
        tint_of[WR_SPAN]; /* the last strip's: which of its samples did */
    WrEffects ran;        /* noted by what does it, where it is done */
    WrDirtyNotes notes;   /* of what the tile at hand looks at */
    WrTilePart mapped;    /* pixels whose map is this thread's: those of its tile */
    unsigned strips;      /* counts strips: one in sixteen is timed */
    int32_t picked;       /* the triangle that was picked last */
} WrTileScratch;

_Static_assert(WR_REFINE_W + 2 * WR_REFINE_RING <= WR_SPAN, "a row of a tile is a strip");
_Static_assert((WR_REFINE_W + 2 * WR_REFINE_RING) * (WR_REFINE_H + 2 * WR_REFINE_RING) <=
                   WR_TILE_SAMPLES_W * WR_TILE_SAMPLES_H,
               "a tile is a depth tile");
_Static_assert(WR_REFINE_W *WR_REFINE_H >= WR_TILE_SAMPLES_W * 32 / 2, "tiles of 2 x 2 and more");

/* A record beside the plan: this was done. */
static inline void wr_did(WrTileScratch *scratch, WrEffect effect)
{
    scratch->ran |= WR_EFFECT_BIT(effect);
}

/* Where a pixel of the picture is stored. */
static inline size_t wr_tile_place(const WrTileJob *job, int x, int y)
{
    return (size_t)(y - job->top) * (size_t)job->width + (size_t)x;
}

static inline float *wr_tile_pixel(const WrTileJob *job, int x, int y)
{
    return job->rgba + ((size_t)(y - job->y0) * job->rgba_pitch + (size_t)(x - job->x0)) * 4;
}

/* Does Newton's method evaluate the surface at its end too? A number of steps that was given is kept to; exact normals set Pu and Pv off against n_u and n_v, all of one
   place, whether the plan runs those or not. */
static inline bool wr_tile_exact(const WrTileJob *job)
{
    return job->plan->newton >= 0 || job->scene->bump == WR_BUMP_EXACT;
}

/* Samples a side as a pixel's map has them. */
static inline uint8_t wr_tile_map_samples(int k)
{
    int level = 0;
    while (1 << level < k) level++;
    return (uint8_t)(level * WR_MAP_SAMPLES);
}

/* Add bits to a pixel's map; not to those of other tiles, which other threads have. */
static inline void wr_tile_map(const WrTileJob *job, const WrTileScratch *scratch, int x, int y,
                               uint8_t bits)
{
    const WrTilePart *own = &scratch->mapped;
    if (x < own->x || y < own->y || x >= own->x + own->w || y >= own->y + own->h) return;
    job->map[wr_tile_place(job, x, y)] |= bits;
}

/* Tile sizes for K x K samples: about 256 x 32 samples whatever K. blocks: as many blocks of WR_FRAME_BLOCK
   pixels beside each other, or a power of two that divides one, and no taller than one. */
void wr_tile_size(int samples, bool adaptive, bool blocks, int *tile_w, int *tile_h);
/* A tile or a part of one, within the band; index: of the tile, for job->seen. */
void wr_tile_render(const WrTileJob *job, WrTilePart part, int index, WrTileScratch *scratch);
/* The same of several objects, jobs[count] in the order in which they are drawn, the nearest first; all are of one
   picture and one number of samples. canvas: where its pixels go. */
void wr_tile_render_group(const WrTileJob *canvas, const WrTileJob *jobs, int count,
                          WrTilePart part, int index, WrTileScratch *scratch);
/* (u,v) and face at one sample of the grid; false where nothing is. Uses scratch. */
bool wr_tile_pick(const WrTileJob *job, int gx, int gy, WrTileScratch *scratch, double *u,
                  double *v, int *face);

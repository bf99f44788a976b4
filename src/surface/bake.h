/* bake.h - baking of a detailed mesh onto a simple one: heights, normals and other quantities of the detailed surface
   as pictures in the simple mesh's (u,v).

   From each texel's point P of the simple mesh a ray starts at P + cage n, n its interpolated unit normal, and
   runs inwards over twice the cage distance. It takes the first triangle of the detailed mesh that shows its front. Values
   are double, by functions that are equal on every processor, and do not depend on the number of threads. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;
typedef struct WrTriangles WrTriangles;

#define WR_BAKE_SAMPLES_MAX 8 /* per side of a texel */
#define WR_BAKE_PADDING_MAX 64

typedef enum WrBakeKind {
    WR_BAKE_HEIGHT,        /* signed distance along n */
    WR_BAKE_NORMAL,        /* unit vectors in MikkTSpace frames */
    WR_BAKE_OBJECT_NORMAL, /* unit vectors in the object's axes */
    WR_BAKE_POSITION, /* 1/2 + (P - centre) / (2 radius), by the simple mesh's bounding sphere */
    WR_BAKE_OCCLUSION, /* cosine-weighted part of the hemisphere that the detailed mesh leaves open */
    WR_BAKE_CURVATURE, /* mean curvature k as 1/2 + x / (2 + 2 |x|), x = k radius / 20 */
    WR_BAKE_PARTS,     /* a colour for each part of the detailed mesh */
    WR_BAKE_HITS,      /* colours: hit, missed, only backs */
    WR_BAKE_KINDS
} WrBakeKind;

struct WrBakeHit;

typedef struct WrBakeRow {
    const char *name;
    int channels;                                             /* 1 or 3 */
    bool unit;                                                /* vectors of length 1 */
    bool (*take)(const struct WrBakeHit *hit, double out[3]); /* private; false: no tangent frame */
    const char *help;
} WrBakeRow;
extern const WrBakeRow wr_bakes[WR_BAKE_KINDS];

typedef struct WrBakeOptions {
    WrBakeKind kind;
    int width, height;
    int samples; /* rays per side of a texel, 1..WR_BAKE_SAMPLES_MAX; their mean is taken */
    int padding; /* rings of texels about the islands */
    int udim;    /* tile of the simple mesh (base/udim.h); 0: all of its (u,v), modulo 1 */
    double cage; /* distance; 0: just enough for every corner of the detailed mesh */
    bool match;  /* parts see only parts of equal name, not counting an ending _low or _high */
    WrPool *pool;
} WrBakeOptions;

typedef struct WrBakeReport {
    double cage;       /* as used */
    int64_t texels;    /* covered by (u,v) */
    int64_t missed;    /* of those: no ray hit a front, so padding fills them */
    int64_t backs;     /* of those: a back was hit */
    int64_t frameless; /* of those: hit, but without a tangent frame */
    int alone;         /* parts of the simple mesh without a partner */
    double low, high;  /* least and largest height */
} WrBakeReport;

/* Returns [height][width][channels], by wr_alloc; row 0 is the top one. Texels beyond the padding are 0, normals
 * (0,0,1). NULL and an error: no (u,v), no memory, cancelled. Reports to the thread's progress. */
float *wr_bake(const WrTriangles *simple, const WrTriangles *detailed, const WrBakeOptions *options,
               WrBakeReport *report, WrError *err);

/* Receives the map of one tile, which it owns (wr_free). False and an error: no more are baked. */
typedef bool WrBakeTake(void *ctx, int udim, float *map, const WrBakeReport *report, WrError *err);
/* Bakes several tiles, one after the other, with one tree of the detailed mesh and one cage. options->udim is not
 * used. udims: [count]. */
bool wr_bake_tiles(const WrTriangles *simple, const WrTriangles *detailed,
                   const WrBakeOptions *options, const int *udims, int count, WrBakeTake *take,
                   void *ctx, WrError *err);

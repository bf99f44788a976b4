/* uv_cache.h - what the samples of a resting view look at on a surface that rays meet by way of a mesh: (u,v) of each, so
   that a change of light, material, colour or table does without depth buffer and Newton's method (E26, E27).
   Layer 5, private to the renderer. */
#pragma once
#include "base/hash.h"
#include "render/visibility/uv_raster.h"

#include <stdbool.h>

typedef struct WrError WrError;

/* All that (u,v) depend on. */
typedef struct WrUvCacheKey {
    WrViewSight sight;
    WrShapef shape;
    WrNewton newton;
    int mu, mv;        /* the mesh's cells */
    int width, height; /* pixels */
    bool cull, exact;  /* exact: Newton's last step is evaluated too */
    bool tied;         /* it goes by knots (sparse_hits.h), if there is memory */
    const WrKernels *kernels;
    WrHash
        beside; /* of what else is drawn, which may hide it: what is hidden is not noted. 0: it is alone */
} WrUvCacheKey;

/* Zero-initialise; fini frees. */
typedef struct WrUvCache {
    WrUvCacheKey key;
    /* [height][width], where the surface was evaluated last: from there `resume` takes the last step again, to the same
       bits. u 2: nothing is seen; below 0 or -0: as its absolute value, and no step is left. */
    float *u, *v;
    bool whole;  /* each sample was noted ... */
    bool partly; /* ... but for those that knots alone tell */
} WrUvCache;

#define WR_UV_CACHE_NONE 2.0f

void wr_uv_cache_fini(WrUvCache *sight);
/* Fill a key, padding included. */
void wr_uv_cache_key(WrUvCacheKey *key, const WrViewMesh *mesh, const WrView *view, bool exact,
                     const WrKernels *kernels);
/* True if it holds this view. Else it is empty afterwards and ready to be filled; `whole` is then the caller's to set.
   Without memory it has no u and v: nothing is noted. */
bool wr_uv_cache_bring(WrUvCache *sight, const WrUvCacheKey *key);

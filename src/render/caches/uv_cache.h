/* uv_cache.h - cache of the (u,v) of every sample of a static view, for surfaces whose rays are intersected by
   way of a mesh. Private to the renderer. After a change of light, material, colour or table it replaces depth
   buffer and Newton's method (E26, E27). */
#pragma once
#include "base/hash.h"
#include "render/visibility/raster.h"

#include <stdbool.h>

typedef struct WrError WrError;

/* Everything that (u,v) depend on. */
typedef struct WrUvCacheKey {
    WrViewProjection projection;
    WrShapef shape;
    WrNewton newton;
    int mu, mv;        /* mesh cells along u and v */
    int width, height; /* pixels */
    bool cull, exact;  /* exact: Newton's last step is evaluated too */
    const WrKernels *kernels;
    /* hash of the other objects, which may hide this one: hidden samples are not stored. 0: there are none */
    WrHash beside;
} WrUvCacheKey;

/* Zero-initialise; fini frees. */
typedef struct WrUvCache {
    WrUvCacheKey key;
    /* [height][width], the last evaluation point of Newton's method; `resume` repeats the last step from there,
       with the same bits. u 2: background; below 0 or -0: the absolute value is final and no step is left. */
    float *u, *v;
    bool whole; /* every sample is stored */
} WrUvCache;

#define WR_UV_CACHE_NONE 2.0f

void wr_uv_cache_fini(WrUvCache *cache);
/* Fills a key, padding included. */
void wr_uv_cache_key(WrUvCacheKey *key, const WrViewMesh *mesh, const WrView *view, bool exact,
                     const WrKernels *kernels);
/* True if the cache holds this view. Otherwise it is emptied and ready to be filled; the caller then sets
   `whole`. Without memory u and v are NULL and nothing is stored. */
bool wr_uv_cache_update(WrUvCache *cache, const WrUvCacheKey *key);

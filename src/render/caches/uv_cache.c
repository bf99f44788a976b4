#include "render/caches/uv_cache.h"

#include "base/memory.h"

#include <string.h>

void wr_uv_cache_fini(WrUvCache *cache)
{
    wr_free(cache->u);
    wr_free(cache->v);
    *cache = (WrUvCache){ .u = NULL };
}

/* The mesh and Newton's method determine (u, v) of every sample: frames with equal keys have the same bits. */
void wr_uv_cache_key(WrUvCacheKey *key, const WrViewMesh *mesh, const WrView *view, bool exact,
                     const WrKernels *kernels)
{
    memset(key, 0, sizeof *key); /* clears padding as well: keys are compared as bytes */
    memcpy(&key->projection, &mesh->projection, sizeof key->projection);
    memcpy(&key->shape, &mesh->shape, sizeof key->shape);
    memcpy(&key->newton, &mesh->newton, sizeof key->newton);
    key->mu = mesh->mu;
    key->mv = mesh->mv;
    key->width = view->grid_w;
    key->height = view->grid_h;
    key->cull = view->cull;
    key->exact = exact;
    key->kernels = kernels;
}

/* Arrays are kept if only the key differs; `whole` stays false until a frame has filled all samples. */
bool wr_uv_cache_update(WrUvCache *cache, const WrUvCacheKey *key)
{
    const size_t count = (size_t)key->width * (size_t)key->height;
    if (cache->whole && memcmp(&cache->key, key, sizeof *key) == 0) return true;
    if (!cache->u || cache->key.width != key->width || cache->key.height != key->height) {
        wr_uv_cache_fini(cache);
        cache->u = wr_try_alloc(count, sizeof *cache->u, "UV cache", NULL);
        cache->v = wr_try_alloc(count, sizeof *cache->v, "UV cache", NULL);
        if (!cache->u || !cache->v) wr_uv_cache_fini(cache);
    }
    memcpy(&cache->key, key, sizeof *key);
    cache->whole = false;
    return false;
}

#include "render/caches/uv_cache.h"

#include "base/memory.h"

#include <string.h>

void wr_uv_cache_fini(WrUvCache *sight)
{
    wr_free(sight->u);
    wr_free(sight->v);
    *sight = (WrUvCache){ .u = NULL };
}

void wr_uv_cache_key(WrUvCacheKey *key, const WrViewMesh *mesh, const WrView *view, bool exact,
                     const WrKernels *kernels)
{
    memset(key, 0, sizeof *key); /* clears padding as well: keys are compared as bytes */
    memcpy(&key->sight, &mesh->sight, sizeof key->sight);
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

bool wr_uv_cache_update(WrUvCache *sight, const WrUvCacheKey *key)
{
    const size_t count = (size_t)key->width * (size_t)key->height;
    if (sight->whole && memcmp(&sight->key, key, sizeof *key) == 0) return true;
    if (!sight->u || sight->key.width != key->width || sight->key.height != key->height) {
        wr_uv_cache_fini(sight);
        sight->u = wr_try_alloc(count, sizeof *sight->u, "sight", NULL);
        sight->v = wr_try_alloc(count, sizeof *sight->v, "sight", NULL);
        if (!sight->u || !sight->v) wr_uv_cache_fini(sight);
    }
    memcpy(&sight->key, key, sizeof *key);
    sight->whole = false;
    return false;
}

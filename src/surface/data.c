#include "surface/data.h"

#include "base/error.h"
#include "base/hash.h"
/* Data that a surface compiles from texts (profiles, formulas). refs > 0 counts owners; -1 marks the defaults,
   which live as long as the program and are neither counted nor freed. */
#include "base/memory.h"

#include <string.h>

static void free_parts(WrSurfaceData *data)
{
    for (int i = 0; i < WR_SURFACE_TEXTS; i++) wr_free(data->text[i]);
    wr_free(data);
}

/* A hash of the texts: equal texts are equal shapes, although compiled separately. */
static uint64_t key_of(const WrSurfaceData *data)
{
    WrHash hash = { .low = (uint64_t)data->kind, .high = 1 };
    for (int i = 0; i < WR_SURFACE_TEXTS; i++)
        if (data->text[i]) hash = wr_hash_bytes(data->text[i], strlen(data->text[i]) + 1, hash);
    return hash.low;
}

static bool short_enough(const WrSurfaceInfo *info, int i, const char *text, WrError *err)
{
    const size_t length = text ? strlen(text) : 0;
    return length <= WR_SURFACE_TEXT_MAX ||
           wr_fail(err, "%s %s: %zu bytes: must be at most %d", info->name, info->texts[i].name,
                   length, WR_SURFACE_TEXT_MAX);
}

WrSurfaceData *wr_surface_data_make(WrSurfaceKind kind, const char *const text[WR_SURFACE_TEXTS],
                                    WrError *err)
{
    const WrSurfaceInfo *info = wr_surfaces[kind];
    WR_ASSERT(info->make);
    for (int i = 0; i < WR_SURFACE_TEXTS && info->texts[i].name; i++)
        if (!short_enough(info, i, text[i], err)) return NULL;
    WrSurfaceData *data = wr_alloc(1, sizeof *data);
    data->refs = 1;
    data->kind = kind;
    for (int i = 0; i < WR_SURFACE_TEXTS && info->texts[i].name; i++)
        data->text[i] = wr_strdup(text[i] ? text[i] : info->texts[i].fallback);
    data->key = key_of(data);
    if (info->make(data, err)) return data;
    free_parts(data);
    return NULL;
}

WrSurfaceData *wr_surface_data_share(const WrSurfaceData *data)
{
    WrSurfaceData *shared = (WrSurfaceData *)data; /* only the reference count changes */
    if (shared && __atomic_load_n(&shared->refs, __ATOMIC_RELAXED) > 0)
        __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_surface_data_free(WrSurfaceData *data)
{
    if (!data || __atomic_load_n(&data->refs, __ATOMIC_RELAXED) < 0) return;
    if (__atomic_sub_fetch(&data->refs, 1, __ATOMIC_ACQ_REL) == 0) free_parts(data);
}

/* Two threads may make a default at once; the first to store it wins, and the other frees its own. */
const WrSurfaceData *wr_surface_data_default(WrSurfaceKind kind)
{
    static WrSurfaceData *made[WR_SURFACE_COUNT]; /* each written once */
    if (!wr_surfaces[kind]->make) return NULL;
    WrSurfaceData *have = __atomic_load_n(&made[kind], __ATOMIC_ACQUIRE);
    if (have) return have;
    const char *const none[WR_SURFACE_TEXTS] = { NULL };
    WrSurfaceData *fresh = wr_surface_data_make(kind, none, NULL);
    WR_ASSERT(fresh);
    fresh->refs = -1;
    if (__atomic_compare_exchange_n(&made[kind], &have, fresh, false, __ATOMIC_ACQ_REL,
                                    __ATOMIC_ACQUIRE))
        return fresh;
    free_parts(fresh);
    return have;
}

void wr_shape_borrow_data(WrShape *shape, const WrSurfaceData *data)
{
    WR_ASSERT(!data || data->kind == shape->kind);
    shape->data = data;
    shape->key = data ? data->key : 0;
}

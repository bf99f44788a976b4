#include "document/composite.h"

#include "base/error.h"
#include "base/memory.h"
#include "document/compositor.h"
#include "document/document.h"
#include "system/thread.h"

struct WrComposite {
    WrMutex lock;
    WrCompositor *compositor;
};

static WrComposite *composite_of(WrCompositor *compositor)
{
    WrComposite *composite = wr_alloc(1, sizeof *composite);
    wr_mutex_init(&composite->lock);
    composite->compositor = compositor;
    return composite;
}

WrComposite *wr_composite_new(void)
{
    return composite_of(wr_compositor_new());
}

WrComposite *wr_composite_share(const WrComposite *composite)
{
    WrComposite *from = (WrComposite *)composite; /* only to lock it */
    wr_mutex_lock(&from->lock);
    WrCompositor *copy = wr_compositor_share(from->compositor);
    wr_mutex_unlock(&from->lock);
    return composite_of(copy);
}

void wr_composite_free(WrComposite *composite)
{
    if (!composite) return;
    wr_compositor_free(composite->compositor);
    wr_mutex_fini(&composite->lock);
    wr_free(composite);
}

const WrField *wr_composite_update(WrComposite *composite, const WrLayer *layers, int count,
                                   int solo, WrPool *pool)
{
    WrBlendLayer parts[WR_LAYERS_MAX];
    WR_ASSERT(count >= 1 && count <= WR_LAYERS_MAX);
    for (int i = 0; i < count; i++)
        parts[i] = (WrBlendLayer){ .heights = layers[i].heights,
                                   .cover = layers[i].cover,
                                   .mask = layers[i].mask,
                                   .mode = layers[i].blend,
                                   .opacity = layers[i].opacity,
                                   .radius = layers[i].radius,
                                   .hidden = solo < 0 ? !layers[i].visible : i != solo };
    wr_mutex_lock(&composite->lock);
    const WrField *result = wr_compositor_update(composite->compositor, parts, count, pool);
    wr_mutex_unlock(&composite->lock);
    return result;
}

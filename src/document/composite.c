/* A filter divides the stack: the layers below it are composited separately, the operation is applied, and the
   rest is composited on top. So each part of the stack has its own compositor. Each filter stores its input and
   its output, and recomputes only the part that an edit may have changed. */
#include "document/composite.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "document/compositor.h"
#include "document/document.h"
#include "field/field.h"
#include "system/thread.h"

/* A filter, or none, and the layers from there up to the next filter. */
typedef struct Stage {
    WrFilter filter;     /* op NULL: none, as in the lowest stage */
    WrField *given;      /* input of `made`; NULL: not computed; owned */
    WrField *made;       /* owned */
    WrCompositor *above; /* compositor of `made`, or of `given`, with the layers; owned */
} Stage;

struct WrComposite {
    WrMutex lock;
    WR_ARRAY(Stage) stages;
};

/* Error of the last filter that failed; "" if none did. */
static _Thread_local WrError lack;

void wr_filters_forget(void)
{
    lack.text[0] = '\0';
}

bool wr_filters_carried(WrError *err)
{
    if (!lack.text[0]) return true;
    if (err) *err = lack;
    return false;
}

/* The layers of the current stage. */
typedef struct Stack {
    WrBlendLayer of[WR_LAYERS_MAX + 2];
    int count;
} Stack;

WrComposite *wr_composite_new(void)
{
    WrComposite *composite = wr_alloc(1, sizeof *composite);
    wr_mutex_init(&composite->lock);
    return composite;
}

static WrField *share_or_null(const WrField *field)
{
    return field ? wr_field_share(field) : NULL;
}

WrComposite *wr_composite_share(const WrComposite *composite)
{
    /* the cast is only for locking */
    WrComposite *from = (WrComposite *)composite, *copy = wr_composite_new();
    wr_mutex_lock(&from->lock);
    for (int i = 0; i < from->stages.count; i++) {
        const Stage *stage = &from->stages.data[i];
        wr_array_push(&copy->stages,
                      ((Stage){ stage->filter, share_or_null(stage->given),
                                share_or_null(stage->made), wr_compositor_share(stage->above) }));
    }
    wr_mutex_unlock(&from->lock);
    return copy;
}

static void drop_stages(WrComposite *composite, int first)
{
    for (int i = first; i < composite->stages.count; i++) {
        Stage *stage = &composite->stages.data[i];
        wr_field_free(stage->given);
        wr_field_free(stage->made);
        wr_compositor_free(stage->above);
    }
    if (composite->stages.count > first) composite->stages.count = first;
}

void wr_composite_free(WrComposite *composite)
{
    if (!composite) return;
    drop_stages(composite, 0);
    wr_array_free(&composite->stages);
    wr_mutex_fini(&composite->lock);
    wr_free(composite);
}

static Stage *stage_at(WrComposite *composite, int index)
{
    if (index == composite->stages.count)
        wr_array_push(&composite->stages, ((Stage){ .above = wr_compositor_new() }));
    return &composite->stages.data[index];
}

/* The filter applied to a composite. If it fails or is cancelled: the composite itself. */
static const WrField *filtered(Stage *stage, const WrLayer *layer, const WrField *in, WrPool *pool)
{
    const WrFilter *filter = &layer->filter;
    const bool same = stage->made && wr_filter_same(&stage->filter, filter);
    if (same && wr_field_key(stage->given) == wr_field_key(in)) return stage->made;
    /* progress that returns to 0 would be confusing */
    WrProgressPart quiet = { .progress = { 0 } };
    wr_progress_part(&quiet, wr_progress_here(), 0.0, 1.0);
    quiet.progress.report = NULL;
    const WrOpOptions options = { .was = same ? stage->given : NULL,
                                  .made = same ? stage->made : NULL,
                                  .pool = pool,
                                  .progress = &quiet.progress };
    WrError err;
    WrField *made = wr_op_run(filter->op, in, filter->param, &options, &err);
    if (!made && !wr_progress_stopped())
        wr_fail(&lack,
                "the filter layer '%.60s' cannot be carried out (%.120s): hide it, or have "
                "less open",
                layer->name, err.text);
    if (!made) return in;
    wr_field_free(stage->given);
    wr_field_free(stage->made);
    stage->filter = *filter;
    stage->given = wr_field_share(in);
    stage->made = made;
    return made;
}

static WrBlendLayer blended(const WrLayer *layer, const WrField *heights)
{
    return (WrBlendLayer){ .heights = heights,
                           .cover = layer->cover,
                           .mask = layer->mask,
                           .mode = layer->blend,
                           .opacity = layer->opacity,
                           .radius = layer->radius };
}

/* First layer of a stage. It is omitted if the filter is shown alone. */
static void begin_stack(Stack *stack, const WrLayer *layer, const WrField *below,
                        const WrField *made)
{
    const bool alone = wr_blends[layer->blend].takes && layer->opacity >= 1.0f && !layer->mask;
    stack->count = 0;
    if (!alone)
        stack->of[stack->count++] =
            (WrBlendLayer){ .heights = below, .mode = WR_BLEND_MIX, .opacity = 1.0f };
    stack->of[stack->count++] = blended(layer, made);
}

/* True if the layer is visible, with layer `solo` alone, or all (-1). A solo filter is shown over its input. */
static bool is_shown(const WrLayer *layers, int i, int solo)
{
    if (solo < 0) return layers[i].visible;
    return i == solo || (layers[solo].filter.op && i < solo && layers[i].visible);
}

static const WrField *update(WrComposite *composite, const WrLayer *layers, int count, int solo,
                             WrPool *pool)
{
    Stack stack = { .count = 0 };
    int at = 0;
    for (int i = 0; i < count; i++) {
        const WrLayer *layer = &layers[i];
        const bool shown = is_shown(layers, i, solo);
        if (!layer->filter.op || !shown || !(layer->opacity > 0.0f)) {
            WrBlendLayer *next = &stack.of[stack.count++];
            *next = blended(layer, layer->heights);
            next->hidden = !shown || layer->filter.op;
            continue;
        }
        if (stack.count == 0) /* over the ground, heights 0 */
            stack.of[stack.count++] = (WrBlendLayer){ .heights = layer->heights, .hidden = true };
        const WrField *below =
            wr_compositor_update(stage_at(composite, at)->above, stack.of, stack.count, pool);
        const WrField *made = filtered(stage_at(composite, ++at), layer, below, pool);
        begin_stack(&stack, layer, below, made);
    }
    drop_stages(composite, at + 1);
    return wr_compositor_update(stage_at(composite, at)->above, stack.of, stack.count, pool);
}

const WrField *wr_composite_update(WrComposite *composite, const WrLayer *layers, int count,
                                   int solo, WrPool *pool)
{
    WR_ASSERT(count >= 1 && count <= WR_LAYERS_MAX);
    wr_mutex_lock(&composite->lock);
    const WrField *result = update(composite, layers, count, solo, pool);
    wr_mutex_unlock(&composite->lock);
    return result;
}

/* A filter parts the stack: what lies below it is composed by itself, goes through the operation, and the rest is
   composed upon that. So there is a compositor a part, and each filter keeps what it was given and what it made of it,
   from which only what an edit may have changed is made again. */
#include "document/composite.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "document/compositor.h"
#include "document/document.h"
#include "field/field.h"
#include "system/thread.h"

/* A filter, if it has one, and the layers from there up to the next. */
typedef struct Stage {
    WrFilter filter;     /* op NULL: none, as of the lowest */
    WrField *given;      /* what it was made of; NULL: it was not; owned */
    WrField *made;       /* owned */
    WrCompositor *above; /* of what was given, what was made, and the layers; owned */
} Stage;

struct WrComposite {
    WrMutex lock;
    WR_ARRAY(Stage) stages;
};

/* Why the newest filter that could not be carried out was not; "" if all were. */
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

/* The layers of the stage at hand. */
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
    WrComposite *from = (WrComposite *)composite, *copy = wr_composite_new(); /* only to lock it */
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

/* The filter over a composite. Where it cannot be carried out, and where the work is cancelled: that itself. */
static const WrField *filtered(Stage *stage, const WrLayer *layer, const WrField *in, WrPool *pool)
{
    const WrFilter *filter = &layer->filter;
    const bool same = stage->made && wr_filter_same(&stage->filter, filter);
    if (same && wr_field_key(stage->given) == wr_field_key(in)) return stage->made;
    WrProgressPart quiet = { .progress = { 0 } }; /* a step back to 0 would only confuse */
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

/* What a stage begins with: where the filter shows alone, there is no need of what lies below. */
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

/* Shown, with layer `solo` alone, or all (-1)? A filter alone is seen over what it filters. */
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
        if (stack.count == 0) /* over the ground */
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

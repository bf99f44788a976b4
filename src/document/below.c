/* The chain of composites below layers that read them. */
#include "document/below.h"

#include "base/array.h"
#include "base/memory.h"
#include "document/composite.h"
#include "document/document.h"
#include "field/field.h"

#include <string.h>

/* A link keeps the composite of the layers between the link before it and its own layer, above that link's result. The bits
   are those of one composite from the ground: a table mixed in with opacity 1 at the bottom of a stack yields exactly
   itself. If no layer below the link before is visible, the stack begins on the ground, where add means mix. */

typedef struct Link {
    int index;              /* of the layer that reads */
    WrComposite *composite; /* owned */
} Link;

struct WrBelow {
    WR_ARRAY(Link) links; /* sorted by index */
};

WrBelow *wr_below_share(const WrBelow *below)
{
    if (!below) return NULL;
    WrBelow *copy = wr_alloc(1, sizeof *copy);
    for (int i = 0; i < below->links.count; i++) {
        const Link *link = &below->links.data[i];
        wr_array_push(&copy->links, ((Link){ link->index, wr_composite_share(link->composite) }));
    }
    return copy;
}

void wr_below_free(WrBelow *below)
{
    if (!below) return;
    for (int i = 0; i < below->links.count; i++) wr_composite_free(below->links.data[i].composite);
    wr_array_free(&below->links);
    wr_free(below);
}

static bool is_live(const WrLayer *layers, int count, int index)
{
    return index < count && (layers[index].line || layers[index].mask_line);
}

/* Removes the links of layers that read no more; adds one for layer `index` if it is live. */
static void renew_links(WrBelow *below, const WrLayer *layers, int count, int index)
{
    int kept = 0, at = 0;
    for (int i = 0; i < below->links.count; i++) {
        const Link link = below->links.data[i];
        if (is_live(layers, count, link.index)) below->links.data[kept++] = link;
        else wr_composite_free(link.composite);
    }
    below->links.count = kept;
    if (!is_live(layers, count, index)) return;
    while (at < kept && below->links.data[at].index < index) at++;
    if (at < kept && below->links.data[at].index == index) return;
    const Link link = { index, wr_composite_new() };
    wr_array_push(&below->links, link);
    memmove(below->links.data + at + 1, below->links.data + at, (size_t)(kept - at) * sizeof link);
    below->links.data[at] = link;
}

static bool any_shown(const WrLayer *layers, int count)
{
    for (int i = 0; i < count; i++)
        if (layers[i].visible && layers[i].opacity > 0.0f) return true;
    return false;
}

/* Stacks layers[from..to-1] on `base`, the composite of those below, if any of them is visible. */
static void stack_on(const WrLayer *layers, int from, int to, WrField *base, WrBelowStack *stack)
{
    stack->own = wr_alloc((size_t)(to - from) + 1, sizeof *stack->own);
    stack->base = base;
    stack->count = 0;
    if (base && any_shown(layers, from))
        stack->own[stack->count++] =
            (WrLayer){ .heights = base, .blend = WR_BLEND_MIX, .opacity = 1.0f, .visible = true };
    memcpy(stack->own + stack->count, layers + from, (size_t)(to - from) * sizeof *layers);
    stack->count += to - from;
    stack->layers = stack->own;
}

void wr_below_end(WrBelowStack *stack)
{
    wr_free(stack->own);
    wr_field_free(stack->base);
}

static WrField *composite_of(WrComposite *composite, const WrRows *rows, WrPool *pool)
{
    return wr_field_share(wr_composite_update(composite, rows, -1, pool, NULL));
}

/* The composite of layers[from..to-1] above `base`, which is freed. */
static WrField *blend_on(WrComposite *composite, const WrLayer *layers, int from, int to,
                         WrField *base, WrPool *pool)
{
    WrBelowStack stack = { 0 };
    stack_on(layers, from, to, base, &stack);
    const WrRows rows = { .layers = stack.layers, .to = stack.count };
    WrField *made = composite_of(composite, &rows, pool);
    wr_below_end(&stack);
    return made;
}

/* Index of the topmost layer below layer `index` that hides all layers below it; 0: none, or the lowest. */
static int ground_of(const WrLayer *layers, int index)
{
    int i = index - 1;
    while (i > 0 && !wr_layer_hides(&layers[i])) i--;
    return i > 0 ? i : 0;
}

/* The composite up to the last link at or below layer `index`, whose index is *from. NULL: there is none above layer *from,
   which hides all layers below it, or is the lowest. */
static WrField *follow_links(WrBelow *below, const WrLayer *layers, int index, WrPool *pool,
                             int *from)
{
    WrField *made = NULL;
    *from = ground_of(layers, index);
    for (int i = 0; below && i < below->links.count; i++) {
        const Link *link = &below->links.data[i];
        if (link->index <= *from || link->index > index) continue;
        made = blend_on(link->composite, layers, *from, link->index, made, pool);
        *from = link->index;
    }
    return made;
}

static bool any_group(const WrLayer *layers, int count)
{
    bool any = false;
    for (int i = 0; i < count; i++) any |= layers[i].is_group;
    return any;
}

/* Among groups each link keeps the composite of all of its rows: links in different groups do not build on each other. */
static WrField *update_alone(const WrBelow *below, const WrRows *rows, int index, WrPool *pool)
{
    for (int i = 0; i < below->links.count; i++)
        if (below->links.data[i].index == index)
            return composite_of(below->links.data[i].composite, rows, pool);
    WrComposite *once = wr_composite_new();
    WrField *made = composite_of(once, rows, pool);
    wr_composite_free(once);
    return made;
}

WrField *wr_below_update(WrBelow **below, const WrRows *rows, int count, int index, WrPool *pool)
{
    int from;
    const WrLayer *layers = rows->layers;
    if (!*below) *below = wr_alloc(1, sizeof **below);
    renew_links(*below, layers, count, index);
    if (any_group(layers, count)) return update_alone(*below, rows, index, pool);
    WrField *made = follow_links(*below, layers, index, pool, &from);
    if (made && from == index) return made;
    WrComposite *once = wr_composite_new();
    made = blend_on(once, layers, from, index, made, pool);
    wr_composite_free(once);
    return made;
}

void wr_below_begin(WrBelow *below, const WrLayer *layers, int count, WrPool *pool,
                    WrBelowStack *stack)
{
    int from;
    renew_links(below, layers, count, count);
    WrField *made = follow_links(below, layers, count, pool, &from);
    if (from > 0) stack_on(layers, from, count, made, stack);
}

/* The plan of layers: why each ran or did not, its time and its memory. */
#include "command/layer_plan.h"

#include "base/array.h"
#include "base/message.h"
#include "base/text.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "document/layer_times.h"
#include "field/field.h"

#include <stdio.h>
#include <stdlib.h>

const char *const wr_layer_runs[] = { "evaluated", "reused", "skipped" };

/* ---- memory ---- */

/* A tile in memory and the layer that refers to it. */
typedef struct Owner {
    const float *tile;
    int layer;
} Owner;

typedef struct Owners {
    WR_ARRAY(Owner) all;
} Owners;

static void add_tiles(Owners *owners, const WrField *field, int layer)
{
    for (int ty = 0; field && ty < wr_field_tiles_v(field); ty++)
        for (int tx = 0; tx < wr_field_tiles_u(field); tx++) {
            const Owner owner = { wr_field_tile(field, tx, ty), layer };
            if (owner.tile) wr_array_push(&owners->all, owner);
        }
}

static int by_address(const void *a, const void *b)
{
    const Owner *x = a, *y = b;
    if (x->tile != y->tile) return x->tile < y->tile ? -1 : 1;
    return x->layer - y->layer;
}

/* Counts the tiles that only one layer refers to, each once. */
static void count_tiles(const WrDocument *document, WrLayerPlan *plan)
{
    Owners owners = { 0 };
    for (int i = 0; i < document->layer_count; i++) {
        add_tiles(&owners, document->layers[i].heights, i);
        add_tiles(&owners, document->layers[i].cover, i);
        add_tiles(&owners, document->layers[i].mask, i);
    }
    const Owner *of = owners.all.data;
    const int count = owners.all.count;
    if (count) qsort(owners.all.data, (size_t)count, sizeof *of, by_address);
    for (int first = 0, next; first < count; first = next) {
        for (next = first + 1; next < count && of[next].tile == of[first].tile;) next++;
        plan[of[first].layer].tiles += of[first].layer == of[next - 1].layer;
    }
    wr_array_free(&owners.all);
}

/* ---- times ---- */

static bool take_time(uint64_t key, WrLayerPlan *plan, WrLayerTime *latest)
{
    WrLayerTime time;
    if (!key || !wr_layer_time_find(key, &time)) return false;
    plan->seconds += time.seconds;
    plan->tiles += time.tiles;
    if (time.at > latest->at) *latest = time;
    return true;
}

static const char *kind_of(const WrLayer *layer)
{
    if (layer->is_group) return layer->mask_line ? "group, live mask" : "group";
    if (layer->filter.op) return layer->mask_line ? "filter, live mask" : "filter";
    if (layer->line) return layer->mask_line ? "generator, live mask" : "generator";
    return layer->mask_line ? "live mask" : "plain";
}

/* Prints why a layer is not needed. */
static void print_need(const WrLayerNeed *need, WrText *text)
{
    switch (need->why) {
    case WR_LAYER_HIDDEN: wr_message_addf(text, "the layer is hidden"); break;
    case WR_LAYER_CLEAR: wr_message_addf(text, "its opacity is 0"); break;
    case WR_LAYER_ALONE: wr_message_addf(text, "layer %d is shown alone", need->by + 1); break;
    case WR_LAYER_COVERED: wr_message_addf(text, "layer %d covers it", need->by + 1); break;
    case WR_LAYER_NEEDED: break;
    }
}

static void explain(const WrSession *session, const WrLayer *layer, const WrLayerNeed *need,
                    WrLayerPlan *plan)
{
    WrLayerTime latest = { 0 };
    WrText text = { 0 };
    plan->kind = kind_of(layer);
    if (layer->line) take_time(layer->made, plan, &latest);
    if (layer->mask_line) take_time(layer->mask_made, plan, &latest);
    if (layer->filter.op) take_time(wr_field_key(layer->heights), plan, &latest);
    const bool now = latest.at > session->made_before, needed = need->why == WR_LAYER_NEEDED;
    plan->run = now ? WR_LAYER_EVALUATED : needed ? WR_LAYER_REUSED : WR_LAYER_SKIPPED;
    /* a command that changes the values of a hidden layer makes it */
    if (now && !needed) wr_message_addf(&text, "its own settings have changed");
    else if (now) wr_message_addf(&text, "it or a layer below has changed");
    else if (!needed) print_need(need, &text);
    else if (layer->is_group) wr_message_addf(&text, "a group of the layers below it");
    else if (!layer->line && !layer->mask_line && !layer->filter.op)
        wr_message_addf(&text, "painted or read, not computed");
    else wr_message_addf(&text, "nothing that it depends on has changed");
    snprintf(plan->message, sizeof plan->message, "%s", wr_text_get(&text));
    wr_message_print(plan->message, NULL, plan->reason, sizeof plan->reason);
    wr_text_fini(&text);
}

void wr_session_layer_plan(const WrSession *session, WrLayerPlan *plan)
{
    const WrDocument *document = session->state.document;
    WrLayerNeed needs[WR_LAYERS_MAX];
    wr_session_layer_needs(session, needs);
    for (int i = 0; i < document->layer_count; i++) plan[i] = (WrLayerPlan){ 0 };
    count_tiles(document, plan);
    for (int i = 0; i < document->layer_count; i++) {
        explain(session, &document->layers[i], &needs[i], &plan[i]);
        plan[i].bytes = plan[i].tiles * WR_TILE * WR_TILE * sizeof(float);
    }
}

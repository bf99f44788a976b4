#include "ui/app/state/chosen_layers.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"

#include <stdlib.h>
#include <string.h>

static uint64_t name_of(const WrLayer *layer)
{
    return wr_hash_bytes(layer->name, strlen(layer->name), (WrHash){ 0, 0 }).low;
}

/* Index of the only element equal to `name`; -1: none, or several. */
static int only(const uint64_t *names, int count, uint64_t name)
{
    int found = -1;
    for (int i = 0; i < count; i++) {
        if (names[i] != name) continue;
        if (found >= 0) return -1;
        found = i;
    }
    return found;
}

void wr_chosen_range(WrChosenLayers *chosen, int first, int last)
{
    for (int i = 0; i < WR_LAYERS_MAX; i++)
        chosen->chosen[i] = i >= first && i <= last && i < chosen->count;
}

/* The layers have other names or places: choose the same ones as before. */
static void follow_names(WrChosenLayers *chosen, const uint64_t *names, int count)
{
    WrChosenLayers before = *chosen;
    const int anchor =
        before.anchor < before.count ? only(names, count, before.name[before.anchor]) : -1;
    for (int i = 0; i < WR_LAYERS_MAX; i++) {
        const int was = i < count ? only(before.name, before.count, names[i]) : -1;
        chosen->chosen[i] = was >= 0 && before.chosen[was] && only(names, count, names[i]) == i;
    }
    memcpy(chosen->name, names, (size_t)count * sizeof *names);
    chosen->count = count;
    chosen->anchor = anchor;
}

void wr_chosen_follow(WrChosenLayers *chosen, const WrDocument *document, const char *last_line)
{
    uint64_t names[WR_LAYERS_MAX];
    const int count = document->layer_count, active = document->active;
    for (int i = 0; i < count; i++) names[i] = name_of(&document->layers[i]);
    if (chosen->count != count || memcmp(chosen->name, names, (size_t)count * sizeof *names) != 0) {
        follow_names(chosen, names, count);
        chosen->awaited = 0; /* its layers have other numbers */
    }
    if (chosen->awaited == names[active] ||
        (chosen->line && strcmp(chosen->line, last_line) == 0)) {
        memcpy(chosen->chosen, chosen->next, sizeof chosen->chosen);
        wr_chosen_free(chosen);
    }
    if (!chosen->chosen[active]) wr_chosen_range(chosen, active, active);
    if (chosen->anchor < 0 || chosen->anchor >= count || !chosen->chosen[chosen->anchor])
        chosen->anchor = active;
}

void wr_chosen_free(WrChosenLayers *chosen)
{
    wr_free(chosen->line);
    chosen->line = NULL;
    chosen->awaited = 0;
}

int wr_chosen_pick(WrChosenLayers *chosen, int active, int index, WrChoosing how)
{
    if (how == WR_CHOOSE_RANGE) {
        const int from = chosen->anchor;
        wr_chosen_range(chosen, from < index ? from : index, from < index ? index : from);
        return index;
    }
    if (how == WR_CHOOSE_TOGGLE && chosen->chosen[index]) {
        if (wr_chosen_count(chosen) == 1) return active;
        chosen->chosen[index] = false;
        if (index != active) return active;
        int near = -1; /* the nearest one that is left; of two, the lower */
        for (int i = 0; i < chosen->count; i++)
            if (chosen->chosen[i] && (near < 0 || abs(i - index) < abs(near - index))) near = i;
        chosen->anchor = near;
        return near;
    }
    if (how == WR_CHOOSE_ONLY) wr_chosen_range(chosen, index, index);
    chosen->chosen[index] = true;
    chosen->anchor = index;
    return index;
}

void wr_chosen_expect(WrChosenLayers *chosen, const char *line, const bool next[WR_LAYERS_MAX])
{
    wr_chosen_free(chosen);
    chosen->line = wr_strdup(line);
    memcpy(chosen->next, next, sizeof chosen->next);
}

void wr_chosen_expect_active(WrChosenLayers *chosen, int active, const bool next[WR_LAYERS_MAX])
{
    wr_chosen_free(chosen);
    chosen->awaited = chosen->name[active];
    memcpy(chosen->next, next, sizeof chosen->next);
}

int wr_chosen_count(const WrChosenLayers *chosen)
{
    int count = 0;
    for (int i = 0; i < chosen->count; i++) count += chosen->chosen[i];
    return count;
}

int wr_chosen_highest(const WrChosenLayers *chosen)
{
    for (int i = chosen->count - 1; i >= 0; i--)
        if (chosen->chosen[i]) return i;
    return -1;
}

void wr_layers_print(const bool layers[WR_LAYERS_MAX], WrText *text)
{
    const char *comma = "";
    for (int i = 0; i < WR_LAYERS_MAX; i++) {
        if (!layers[i]) continue;
        wr_text_addf(text, "%s%d", comma, i + 1);
        comma = ",";
    }
}

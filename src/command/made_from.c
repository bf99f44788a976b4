/* Inputs of live masks and layers, by the key of the result. */
#include "command/made_from.h"

#include "base/array.h"
#include "base/memory.h"
#include "document/document.h"

#include <string.h>

#define MOST 0.75 /* part of the table above which making it whole is faster */

typedef struct Entry {
    uint64_t made;
    WrInputs inputs; /* shares; owned */
} Entry;

struct WrMadeFrom {
    WR_ARRAY(Entry) entries;
};

static WrField *share(const WrField *field)
{
    return field ? wr_field_share(field) : NULL;
}

static void fini(Entry *entry)
{
    for (int i = 0; i < entry->inputs.count; i++) wr_field_free((WrField *)entry->inputs.of[i]);
}

static Entry *find(const WrMadeFrom *all, uint64_t made)
{
    for (int i = 0; all && i < all->entries.count; i++)
        if (all->entries.data[i].made == made) return &all->entries.data[i];
    return NULL;
}

void wr_made_from_note(WrMadeFrom **all, uint64_t made, const WrInputs *inputs)
{
    Entry entry = { made, *inputs };
    if (!*all) *all = wr_alloc(1, sizeof **all);
    for (int i = 0; i < inputs->count; i++) entry.inputs.of[i] = share(inputs->of[i]);
    Entry *before = find(*all, made); /* other inputs may yield the same table */
    if (before) {
        fini(before);
        *before = entry;
    } else {
        wr_array_push(&(*all)->entries, entry);
    }
}

/* A changed level changes texels without tiles. */
static bool comparable(const WrField *a, const WrField *b)
{
    if (!a || !b) return a == b;
    const float was = wr_field_level(a), now = wr_field_level(b);
    return wr_field_alike(a, b) && memcmp(&was, &now, sizeof was) == 0;
}

const WrInputs *wr_made_from_find(const WrMadeFrom *all, uint64_t made, const WrInputs *now)
{
    const Entry *entry = find(all, made);
    if (!entry || entry->inputs.count != now->count ||
        !wr_hash_equal(entry->inputs.values, now->values))
        return NULL;
    for (int i = 0; i < now->count; i++)
        if (!comparable(entry->inputs.of[i], now->of[i])) return NULL;
    return &entry->inputs;
}

bool wr_made_from_changes(const WrMadeFrom *all, uint64_t made, const WrInputs *now, int reach,
                          WrFieldRect **blocks, int *count)
{
    WrFieldChange changes[WR_INPUTS_MAX];
    int changed = 0;
    double texels = 0.0;
    const WrInputs *was = wr_made_from_find(all, made, now);
    for (int i = 0; was && i < now->count; i++)
        if (now->of[i]) changes[changed++] = (WrFieldChange){ was->of[i], now->of[i] };
    if (changed == 0 || reach < 0) return false;
    *count = wr_changed_blocks(changes, changed, reach, blocks);
    for (int i = 0; i < *count; i++) {
        const WrFieldRect *b = &(*blocks)[i];
        texels += (double)(b->i1 - b->i0) * (b->j1 - b->j0);
    }
    const WrField *like = changes[0].now;
    if (texels <= MOST * wr_field_width(like) * wr_field_height(like)) return true;
    wr_free(*blocks);
    *blocks = NULL;
    return false;
}

static bool is_needed(const WrDocument *document, const bool *needed, uint64_t made)
{
    for (int i = 0; i < document->layer_count; i++) {
        const WrLayer *layer = &document->layers[i];
        if (needed[i] && ((layer->mask_line && layer->mask_made == made) ||
                          (layer->line && layer->made == made)))
            return true;
    }
    return false;
}

void wr_made_from_prune(WrMadeFrom *all, const WrDocument *document, const bool *needed)
{
    int kept = 0;
    for (int i = 0; all && i < all->entries.count; i++) {
        Entry entry = all->entries.data[i];
        if (is_needed(document, needed, entry.made)) all->entries.data[kept++] = entry;
        else fini(&entry);
    }
    if (all) all->entries.count = kept;
}

void wr_made_from_free(WrMadeFrom *all)
{
    if (!all) return;
    for (int i = 0; i < all->entries.count; i++) fini(&all->entries.data[i]);
    wr_array_free(&all->entries);
    wr_free(all);
}

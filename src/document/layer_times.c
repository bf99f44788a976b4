/* A ring of the last makings. */
#include "document/layer_times.h"

#include "system/thread.h"

#define ENTRIES 1024

typedef struct Entry {
    uint64_t key;
    WrLayerTime time;
} Entry;

static WrMutex lock = WR_MUTEX_READY;
static Entry entries[ENTRIES];
static uint64_t last; /* entry n is at entries[n % ENTRIES] */

void wr_layer_time_note(uint64_t key, double seconds, size_t tiles)
{
    wr_mutex_lock(&lock);
    last++;
    entries[last % ENTRIES] = (Entry){ key, { seconds, tiles, last } };
    wr_mutex_unlock(&lock);
}

bool wr_layer_time_find(uint64_t key, WrLayerTime *time)
{
    bool found = false;
    wr_mutex_lock(&lock);
    for (uint64_t n = last; !found && n > 0 && last - n < ENTRIES; n--) {
        const Entry *entry = &entries[n % ENTRIES];
        found = entry->key == key;
        if (found) *time = entry->time;
    }
    wr_mutex_unlock(&lock);
    return found;
}

uint64_t wr_layer_time_last(void)
{
    wr_mutex_lock(&lock);
    const uint64_t n = last;
    wr_mutex_unlock(&lock);
    return n;
}

/* layer_times.h - times of the last makings of layers, by the key of the result. Kept for the process, beside the
   documents: no file, hash or step contains them. Any thread. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrLayerTime {
    double seconds; /* of the making */
    size_t tiles;   /* of its result that its input does not share; only of filters */
    uint64_t at;    /* number of the making, from 1 in order of time */
} WrLayerTime;

/* Stores that something was made in so many seconds. key: wr_field_key of heights or of a mask; for a filter layer, whose
   result changes with the layers below, that of its own empty heights. The oldest of 1024 entries is overwritten. */
void wr_layer_time_note(uint64_t key, double seconds, size_t tiles);
/* The last making under that key; false: none is known. */
bool wr_layer_time_find(uint64_t key, WrLayerTime *time);
/* Number of the last making of the process; 0: none. */
uint64_t wr_layer_time_last(void);

/* array.h - typed growable arrays.
 *
 *   WR_ARRAY(WrLight) lights = { 0 };
 *   wr_array_push(&lights, light);
 *   for (int i = 0; i < lights.count; i++) use(&lights.data[i]);
 *   wr_array_free(&lights);
 * */
#pragma once
#include "base/memory.h"

#include <stddef.h>

#define WR_ARRAY(type)                                                                             \
    struct {                                                                                       \
        type *data;   /* owned; NULL while empty */                                                \
        int count;    /* used */                                                                   \
        int capacity; /* allocated */                                                              \
    }

/* Reserves memory for at least `want` elements. */
#define wr_array_reserve(array, want)                                                              \
    do {                                                                                           \
        if ((array)->capacity < (want)) {                                                          \
            int grown_ = (array)->capacity ? (array)->capacity * 2 : 8;                            \
            if (grown_ < (want)) grown_ = (want);                                                  \
            (array)->data = wr_realloc((array)->data, (size_t)(array)->count, (size_t)grown_,      \
                                       sizeof *(array)->data);                                     \
            (array)->capacity = grown_;                                                            \
        }                                                                                          \
    } while (0)

#define wr_array_push(array, value)                                                                \
    do {                                                                                           \
        wr_array_reserve((array), (array)->count + 1);                                             \
        (array)->data[(array)->count++] = (value);                                                 \
    } while (0)

#define wr_array_free(array)                                                                       \
    do {                                                                                           \
        wr_free((array)->data);                                                                    \
        (array)->data = NULL;                                                                      \
        (array)->count = (array)->capacity = 0;                                                    \
    } while (0)

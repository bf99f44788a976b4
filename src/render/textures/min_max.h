/* min_max.h - minimum and maximum of an array.
   Private to the renderer. */
#pragma once

/* Extends *low and *high by `count` numbers; NaNs are ignored. */
static inline void wr_extent_add(const float *restrict x, int count, float *low, float *high)
{
    float least = *low, most = *high;
#pragma omp simd reduction(min : least) reduction(max : most)
    for (int i = 0; i < count; i++) {
        least = x[i] < least ? x[i] : least;
        most = x[i] > most ? x[i] : most;
    }
    *low = least, *high = most;
}

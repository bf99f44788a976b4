/* min_max.h - the least and the largest of many numbers.
   Layer 5, private to the renderer. */
#pragma once

/* Of `count` numbers, and of what *low and *high hold already; numbers that are NaN do not count. */
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

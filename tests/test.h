/* test.h - common header of all tests. cmocka needs these headers first. */
#pragma once
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The tests of a module are one program: each main is renamed (wr_test in tests/CMakeLists.txt) and called by
   runner.c. */
#ifdef main
int main(void);
#endif

/* |a - b| <= tolerance, with the values in the message. */
#define assert_near(a, b, tolerance)                                                               \
    do {                                                                                           \
        double a_ = (a), b_ = (b), t_ = (tolerance);                                               \
        if (!(fabs(a_ - b_) <= t_))                                                                \
            fail_msg("%s = %.17g, %s = %.17g: differ by %g, over %g", #a, a_, #b, b_,              \
                     fabs(a_ - b_), t_);                                                           \
    } while (0)

/* Bit equality: distinguishes -0 from 0; a NaN equals itself. */
static inline bool same_bits(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* A number of cases, or the size of one: less under the address sanitizer, which is ten times as slow; WR_FULL selects the whole. */
static inline int test_amount(int whole, int sanitized)
{
#ifdef __SANITIZE_ADDRESS__
    if (!getenv("WR_FULL")) return sanitized;
#endif
    (void)sanitized;
    return whole;
}

/* Of a list of cases, how many to go on by: `step`, `sanitized` under the address sanitizer; with WR_FULL by one. */
static inline int test_step(int step, int sanitized)
{
    return getenv("WR_FULL") ? 1 : test_amount(step, sanitized);
}

/* A repeatable random stream: splitmix64. */
typedef struct TestRandom {
    uint64_t state;
} TestRandom;
static inline uint64_t test_random_u64(TestRandom *r)
{
    uint64_t z = (r->state += 0x9e3779b97f4a7c15ULL);
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ z >> 27) * 0x94d049bb133111ebULL;
    return z ^ z >> 31;
}
/* 0 <= x < 1 */
static inline double test_random(TestRandom *r)
{
    return (double)(test_random_u64(r) >> 11) * 0x1p-53;
}

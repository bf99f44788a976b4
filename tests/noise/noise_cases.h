/* noise_cases.h - noises of all kinds, and helpers to check them. */
#pragma once
#include "noise/octaves.h"

/* Every kind, dimension and fade, periodic where possible with different periods on each axis, and not periodic where
 * allowed. Returns their number. */
#define NOISE_CASES 61
static inline int noise_cases(WrNoise *out)
{
    static const int periods[WR_NOISE_AXES] = { 6, 12, 9 };
    int count = 0;
    for (int kind = 0; kind < WR_NOISE_KIND_COUNT; kind++)
        for (int dim = 1; dim <= WR_NOISE_AXES; dim++)
            for (int fade = 0; fade < (wr_noises[kind].cells ? WR_FADE_COUNT : 1); fade++)
                for (int repeats = 0; repeats < 2; repeats++) {
                    WrNoise noise = { .kind = (WrNoiseKind)kind, .fade = (WrFade)fade, .dim = dim };
                    noise.lattice.seed = 17;
                    for (int a = 0; repeats && a < dim; a++) noise.lattice.period[a] = periods[a];
                    if (!wr_noise_check(&noise, NULL)) continue;
                    assert_true(count < NOISE_CASES);
                    out[count++] = noise;
                }
    assert_int_equal(count, NOISE_CASES);
    return count;
}

/* Name for messages. */
static inline const char *noise_case_name(const WrNoise *noise)
{
    static char text[80];
    snprintf(text, sizeof text, "%s %dD %s period %d", wr_noises[noise->kind].name, noise->dim,
             wr_fade_words[noise->fade], noise->lattice.period[0]);
    return text;
}

/* A point inside a cell, at least 1/50 from its borders, within 8 cells of the origin. */
static inline void random_place(TestRandom *r, double *t)
{
    for (int a = 0; a < WR_NOISE_AXES; a++)
        t[a] = floor(16.0 * test_random(r)) - 8.0 + 0.02 + 0.96 * test_random(r);
}

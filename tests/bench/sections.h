/* sections.h - benchmark sections, each of which varies one thing. The pictures of a section are measured in turn and
   compared with a base row of the same section. */
#pragma once
#include "bench/peak.h"
#include "render/plan/plan.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrCli WrCli;
typedef struct WrError WrError;
typedef struct WrScene WrScene;

typedef enum WrBenchView {
    WR_BENCH_TURNS,  /* a new view in each round */
    WR_BENCH_MOVES,  /* as TURNS, a picture of the window */
    WR_BENCH_RESTS,  /* the same view, nothing changed */
    WR_BENCH_PAINTS, /* the same view after a dab of 64 x 64 texels */
    WR_BENCH_RELIT,  /* the same view with another material */
    WR_BENCH_FIRST   /* with a new renderer, whose creation is included */
} WrBenchView;

typedef enum WrBenchOut {
    WR_BENCH_CODES,    /* 8-bit output of the renderer, as in the window */
    WR_BENCH_FLOATS,   /* linear floats */
    WR_BENCH_CONVERTED /* floats converted to 8 bits afterwards */
} WrBenchOut;

typedef struct WrBenchPicture {
    char name[64];
    int base;        /* row for comparison; own index: none */
    WrScene *scene;  /* owned */
    int table;       /* texels along a side */
    const char *isa; /* NULL: that of the command line */
    WrBenchView view;
    WrBenchOut out;
    bool full;   /* no stages are skipped */
    bool staged; /* without hand-written SIMD loops */
    int effect;  /* effect that the row measures; -1: none */
    WrForce force[WR_EFFECT_COUNT];
    /* Results: */
    double ms;       /* median */
    double least_ms; /* of the shortest round */
    int64_t samples; /* shaded samples of the last picture */
    double bytes;    /* picture and tables, counted as in the guide; 0: not counted */
    double flops;    /* operations per sample, if counted; else 0 */
    bool ran;        /* the effect ran in the last picture */
} WrBenchPicture;

typedef struct WrBenchSections WrBenchSections;

typedef struct WrBenchSection {
    const char *name, *varies;
    /* Add the section's rows; false and an error if out of memory. */
    bool (*fill)(WrBenchSections *all, WrError *err);
} WrBenchSection;

/* The longest section measures every effect, with and without it. */
#define WR_BENCH_PICTURES (2 * WR_EFFECT_COUNT)

struct WrBenchSections {
    const WrCli *cli;
    int width, height, rounds;
    bool fast;
    WrPeaks peaks;
    const WrBenchSection *section; /* section of the pictures */
    WrBenchPicture picture[WR_BENCH_PICTURES];
    int count;
};

extern const WrBenchSection wr_bench_section_table[]; /* the last row has name NULL */

/* bench_sections.h - the parts of the benchmark that vary one thing: all rows of a section are pictures measured by
   turns, each beside a row of the same section.
   Layer 7, private to bench_section*.c and cmd_bench.c. */
#pragma once
#include "cli/bench_peak.h"
#include "render/plan/plan.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrCli WrCli;
typedef struct WrError WrError;
typedef struct WrFrame WrFrame;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

typedef enum WrBenchView {
    WR_BENCH_TURNS,  /* another view each time */
    WR_BENCH_RESTS,  /* the same, and nothing has changed */
    WR_BENCH_PAINTS, /* the same, after a dab of 64 x 64 texels */
    WR_BENCH_RELIT,  /* the same, of another material */
    WR_BENCH_FIRST   /* by a new renderer, the making of it counted */
} WrBenchView;

typedef enum WrBenchOut {
    WR_BENCH_CODES,    /* 8-bit codes by the renderer, as the window shows them */
    WR_BENCH_FLOATS,   /* linear floats */
    WR_BENCH_CONVERTED /* floats, made codes of afterwards */
} WrBenchOut;

typedef struct WrBenchPicture {
    char name[64];
    int base;        /* the row that its time is set beside; itself: none */
    WrScene *scene;  /* owned */
    int table;       /* texels along a side */
    const char *isa; /* NULL: the command line's */
    WrBenchView view;
    WrBenchOut out;
    bool full;  /* nothing is left out */
    int effect; /* that the row is about; -1: none */
    WrForce force[WR_EFFECT_COUNT];
    /* Filled by measuring: */
    double ms;       /* median */
    double least_ms; /* of the shortest round */
    int64_t samples; /* shaded, of the last picture */
    double bytes;    /* picture and tables, as the guide counts them; 0: not counted */
    double flops;    /* operations a sample, where they are counted; else 0 */
    bool ran;        /* the effect, in the last picture */
} WrBenchPicture;

typedef struct WrBenchSections WrBenchSections;

typedef struct WrBenchSection {
    const char *name, *varies;
    /* Adds the section's rows; false and an error without memory. */
    bool (*fill)(WrBenchSections *all, WrError *err);
} WrBenchSection;

/* The longest section shows every effect, with it and without. */
#define WR_BENCH_PICTURES (2 * WR_EFFECT_COUNT)

struct WrBenchSections {
    const WrCli *cli;
    int width, height, rounds;
    bool fast;
    WrPeaks peaks;
    const WrBenchSection *section; /* that the pictures are of */
    WrBenchPicture picture[WR_BENCH_PICTURES];
    int count;
};

extern const WrBenchSection wr_bench_sections[]; /* ends with name NULL */
int wr_bench_section_find(const char *name);     /* or -1 */

/* Fill and measure one section; clear frees its scenes. */
bool wr_bench_section_measure(WrBenchSections *all, const WrBenchSection *section, WrError *err);
void wr_bench_section_clear(WrBenchSections *all);

/* What a picture of this frame reads, writes and works out: bytes and flops, 0 where they are not counted. */
void wr_bench_picture_count(const WrBenchSections *all, WrBenchPicture *picture,
                            const WrFrame *frame);

/* As tables, and as members of one JSON object. */
void wr_bench_peaks_print(const WrBenchSections *all, WrText *text);
void wr_bench_section_print(const WrBenchSections *all, WrText *text);
void wr_bench_head_json(const WrBenchSections *all, WrText *text);
void wr_bench_section_json(const WrBenchSections *all, WrText *text);
/* Lines of six words, as --lines prints them, as an array of objects. */
void wr_bench_lines_json(const char *lines, WrText *text);

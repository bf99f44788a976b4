/* bench.h - the benchmark program: measurements and reference scenes. Figures are medians of interleaved runs, so that
   drift of the machine affects all rows equally. Measurements end with an error when they are interrupted. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrCli WrCli;
typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

int wr_bench_threads(const WrCli *cli);            /* --threads, or one per processor */
double wr_bench_median(double *values, int count); /* sorts `values` in place */

/* ---- frames.c: the reference scene and its pictures ---- */

typedef enum WrBenchMode {
    WR_BENCH_PHONG, /* bump mapping off */
    WR_BENCH_TEXTURE,
    WR_BENCH_BUMP, /* blinn, central */
    WR_BENCH_BUMP_TEXTURE,
    WR_BENCH_MIP,      /* bump, filtered slopes */
    WR_BENCH_SS16,     /* bump, 4 x 4 samples */
    WR_BENCH_ADAPTIVE, /* bump, up to 4 x 4 samples in pixels that need them */
    WR_BENCH_MODE_COUNT
} WrBenchMode;
extern const char *const wr_bench_modes[WR_BENCH_MODE_COUNT];

/* A periodic test table of smooth lumps, scratches and grain; heights in scene units. NULL if out of memory. */
WrField *wr_bench_field(int size, WrError *err);
/* The reference scene: eye at (0,0,4), a unit sphere whose silhouette touches the view's edge (or a
 * patch, or a torus), one directional light, ambient 0.08, diffuse 0.72, specular 0.35 with shininess
 * 40. */
WrScene *wr_bench_scene(const char *surface, WrBenchMode mode, bool fast, WrError *err);
/* A table; or lines 'surface view mode table threads ms', for comparison with other renderers. */
bool wr_bench_frame_table(const WrCli *cli, bool quick, bool exact, WrText *text, WrError *err);
bool wr_bench_frame_lines(const WrCli *cli, bool quick, bool exact, WrText *text, WrError *err);

/* ---- sections.c: pictures that differ in one thing, as tables or members of a JSON object ---- */

/* chosen: bit i for the section of wr_bench_section_table[i]. Sizes and --json are of `cli`. */
bool wr_bench_sections(const WrCli *cli, uint64_t chosen, bool quick, bool exact, WrText *text,
                       WrError *err);
/* Convert the six-word lines of --lines to a JSON array of objects. */
void wr_bench_lines_json(const char *lines, WrText *text);

/* ---- the other measurements, as tables ---- */

bool wr_bench_strokes(const WrCli *cli, bool quick, WrText *text, WrError *err);
bool wr_bench_edits(const WrCli *cli, bool quick, WrText *text, WrError *err);
/* 40 live layers of 2048 x 2048: drags of one value, until the table and the patch have their first form, and until the exact
 * composite is made. */
bool wr_bench_live_layers(const WrCli *cli, bool quick, WrText *text, WrError *err);
/* Long commands: time promised while they run, as a ratio of the time needed. */
bool wr_bench_promises(const WrCli *cli, bool quick, WrText *text, WrError *err);
/* Processor time of work while one quantity doubles (table, picture, layers, brush, objects, lights), and its exponent. */
bool wr_bench_scale(const WrCli *cli, bool quick, WrText *text, WrError *err);
/* Rows of median and 95th percentile: start of the program, its window's first picture, opening and saving a document. */
bool wr_bench_start(const WrCli *cli, bool quick, WrText *text, WrError *err);
bool wr_bench_files(bool quick, WrText *text, WrError *err);
/* Latency from a pen motion to its display in the window; empty in a build without a window. */
bool wr_bench_window(const WrCli *cli, bool quick, WrText *text, WrError *err);
/* Moments in which a user waits, on large tables; empty in a build without a window. */
bool wr_bench_moments(const WrCli *cli, bool quick, WrText *text, WrError *err);
/* Dabs of three radii beside libmypaint's: lines 'brush radius who table threads ms', or a table. */
bool wr_bench_brush_lines(const WrCli *cli, bool quick, WrText *text, WrError *err);
bool wr_bench_brush_table(const WrCli *cli, bool quick, WrText *text, WrError *err);
/* Generators and operations on whole tables of 4096 x 4096, compared with other installed programs: a table, or lines
 * 'make WHAT WHO table threads ms'. Needs minutes; seconds if `quick`. */
bool wr_bench_generate(const WrCli *cli, bool quick, bool lines, WrText *text, WrError *err);

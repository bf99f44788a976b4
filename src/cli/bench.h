/* bench.h - the program's own benchmark: what it measures and with which scenes.
   Layer 7. Figures are medians of interleaved runs, so that a drift of the machine hits all alike. */
#pragma once
#include "cli/cli.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

typedef enum WrBenchMode {
    WR_BENCH_PHONG, /* smooth */
    WR_BENCH_TEXTURE,
    WR_BENCH_BUMP, /* blinn, central */
    WR_BENCH_BUMP_TEXTURE,
    WR_BENCH_MIP,      /* bump, filtered slopes */
    WR_BENCH_SS16,     /* bump, 4 x 4 samples */
    WR_BENCH_ADAPTIVE, /* bump, up to 4 x 4 samples where a pixel needs them */
    WR_BENCH_MODE_COUNT
} WrBenchMode;
extern const char *const wr_bench_modes[WR_BENCH_MODE_COUNT];

/* One row to measure. The renderer keeps its caches from run to run, as the window's does. */
typedef struct WrBenchRow {
    const char *surface; /* "sphere", "bezier" or "torus" */
    int size;            /* view: size x size pixels */
    WrBenchMode mode;
    int table;   /* texels along a side */
    int threads; /* 0: all */
    double ms;   /* median; filled by wr_bench_run */
    int64_t covered;
} WrBenchRow;

/* Smooth lumps, scratches and grain, periodic; heights in scene units. NULL without memory. */
WrField *wr_bench_field(int size, WrError *err);
/* The reference scene: eye at (0,0,4), a unit sphere whose silhouette touches the view's edge (or a
 * patch, or a torus), one directional light, ambient 0.08, diffuse 0.72, specular 0.35 with shininess
 * 40. */
WrScene *wr_bench_scene(const char *surface, WrBenchMode mode, bool fast, WrError *err);

/* Measure all rows, `runs` rounds over them in turn. Stops and fails when interrupted. */
bool wr_bench_run(const WrCli *cli, WrBenchRow *rows, int count, int runs, bool fast, WrError *err);

typedef struct WrBenchStroke {
    int table;
    double apply_ms, apply_worst_ms; /* one stroke sample, radius 32 texels: median, worst */
    double preview_ms;               /* the 512 x 512 preview after it, median */
} WrBenchStroke;
bool wr_bench_stroke(const WrCli *cli, WrBenchStroke *stroke, int samples, WrError *err);

/* A dab of 64 texels across and its undo, each with the composite brought up to date after it: medians. */
typedef struct WrBenchEdit {
    int table, layers;
    const char *filter; /* the command of a filter layer over them; NULL: none */
    double dab_ms, composite_ms, undo_ms, undo_composite_ms;
    double bytes; /* that the step costs */
} WrBenchEdit;
bool wr_bench_edit(const WrCli *cli, WrBenchEdit *edit, int rounds, WrError *err);

/* Save and load a document of rough layers. */
typedef struct WrBenchFile {
    int table, layers;
    double save_seconds, load_seconds;
    double copy_seconds; /* oiiotool reading the file and writing it again; 0: not installed */
} WrBenchFile;
bool wr_bench_file(WrBenchFile *file, WrError *err);

/* How soon a motion of the pen is seen in the window, as rows of text; nothing where there is no window. */
bool wr_bench_window(const WrCli *cli, bool quick, WrText *text, WrError *err);

/* Dabs of one radius, dabs a second on one thread: medians. */
typedef struct WrBenchBrush {
    int table;
    double radius;
    double peer;   /* libmypaint's own surface */
    double engine; /* its engine with the same brush and motion, into our tiles */
    double round;  /* our round brush, as far apart */
} WrBenchBrush;
bool wr_bench_brush(const WrCli *cli, WrBenchBrush *brush, int dabs, int rounds, WrError *err);
/* All radii, as lines and as a table. */
bool wr_bench_brush_lines(const WrCli *cli, bool quick, WrText *text, WrError *err);
bool wr_bench_brush_table(const WrCli *cli, bool quick, WrText *text, WrError *err);

/* Generators and operations of whole tables of 4096 x 4096, beside other programs where these are
 * installed: a table, or lines 'make WHAT WHO table threads ms'. It takes minutes, seconds where quick. */
bool wr_bench_generate(const WrCli *cli, bool quick, bool lines, WrText *text, WrError *err);

double wr_bench_median(double *values, int count); /* sorts values */

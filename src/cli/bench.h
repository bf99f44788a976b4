/* bench.h - the built-in benchmark: measurements and reference scenes. Figures are medians of interleaved runs, so
   that drift of the machine affects all rows equally. */
#pragma once
#include "cli/cli.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrField WrField;
typedef struct WrScene WrScene;
typedef struct WrText WrText;

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

/* One measurement. The renderer keeps its caches between runs, as in the window. */
typedef struct WrBenchRow {
    const char *surface; /* "sphere", "bezier" or "torus" */
    int size;            /* picture of size x size pixels */
    WrBenchMode mode;
    int table;   /* texels along a side */
    int threads; /* 0: all processors */
    double ms;   /* median; filled by wr_bench_run */
    int64_t covered;
} WrBenchRow;

/* A periodic test table of smooth lumps, scratches and grain; heights in scene units. NULL if out of memory. */
WrField *wr_bench_field(int size, WrError *err);
/* The reference scene: eye at (0,0,4), a unit sphere whose silhouette touches the view's edge (or a
 * patch, or a torus), one directional light, ambient 0.08, diffuse 0.72, specular 0.35 with shininess
 * 40. */
WrScene *wr_bench_scene(const char *surface, WrBenchMode mode, bool fast, WrError *err);

/* Measure all rows in `runs` rounds, alternating between rows. Stops and fails when interrupted. */
bool wr_bench_run(const WrCli *cli, WrBenchRow *rows, int count, int runs, bool fast, WrError *err);

typedef struct WrBenchStroke {
    int table;
    double apply_ms, apply_worst_ms; /* one stroke sample, radius 32 texels: median, worst */
    double preview_ms;               /* the 512 x 512 preview after it, median */
} WrBenchStroke;
bool wr_bench_stroke(const WrCli *cli, WrBenchStroke *stroke, int samples, WrError *err);

/* Medians for a dab 64 texels across and for its undo, each including the update of the composite. */
typedef struct WrBenchEdit {
    int table, layers;
    const char *filter; /* command of a filter layer above; NULL: none */
    double dab_ms, composite_ms, undo_ms, undo_composite_ms;
    double bytes; /* memory of the step */
} WrBenchEdit;
bool wr_bench_edit(const WrCli *cli, WrBenchEdit *edit, int rounds, WrError *err);

/* Saving and loading of a document of rough layers. */
typedef struct WrBenchFile {
    int table, layers;
    double save_seconds, load_seconds;
    double copy_seconds; /* oiiotool copying the file; 0: not installed */
} WrBenchFile;
bool wr_bench_file(WrBenchFile *file, WrError *err);

/* Latency from a pen motion to its display in the window, as rows of text; empty in a build without a window. */
bool wr_bench_window(const WrCli *cli, bool quick, WrText *text, WrError *err);

/* Dabs of one radius: medians in dabs per second on one thread. */
typedef struct WrBenchBrush {
    int table;
    double radius;
    double peer;   /* libmypaint's own surface */
    double engine; /* its engine with the same brush and motion, on our tiles */
    double round;  /* our round brush, with the same spacing */
} WrBenchBrush;
/* All radii, as lines or as a table. */
bool wr_bench_brush_lines(const WrCli *cli, bool quick, WrText *text, WrError *err);
bool wr_bench_brush_table(const WrCli *cli, bool quick, WrText *text, WrError *err);

/* Generators and operations on whole tables of 4096 x 4096, compared with other installed programs: a table, or lines
 * 'make WHAT WHO table threads ms'. Takes minutes; seconds if `quick`. */
bool wr_bench_generate(const WrCli *cli, bool quick, bool lines, WrText *text, WrError *err);

double wr_bench_median(double *values, int count); /* sorts `values` in place */

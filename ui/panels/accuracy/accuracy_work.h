/* accuracy_work.h - background work of the Accuracy panel, the comparisons on the patch and the inspector, each one
   piece of work for job.h: on snapshots, with separate renderers. */
#pragma once
#include "ui/app/jobs/job.h"

#include "accuracy/illusion.h"
#include "accuracy/accuracy_benchmark.h"
#include "accuracy/metrics.h"
#include "base/error.h"
#include "hardcases/hardcases.h"
#include "render/reference/reference.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrTables WrTables;
typedef struct WrRenderer WrRenderer;
typedef struct WrScene WrScene;

#define WR_ERROR_SIDE                                                                              \
    256 /* largest length in pixels of the longer side of the picture for the error */
#define WR_ACCURACY_BENCHMARK_SIDE 96 /* of the benchmark's picture */
#define WR_MAP_SIDE 512               /* of a map over the patch */

typedef enum WrWorkKind {
    WR_WORK_ERROR,     /* the scene's own picture against the reference */
    WR_WORK_BENCHMARK, /* error and time of all settings */
    WR_WORK_CASES,     /* hard cases */
    WR_WORK_ILLUSION,  /* bump mapping compared with displacement */
    WR_WORK_PAIR,      /* two pictures to compare */
    WR_WORK_MAP,       /* map of one quantity */
    WR_WORK_PROBE      /* all quantities at one point */
} WrWorkKind;

/* Data that a thread reuses between pieces of work. */
typedef struct WrWorkTools {
    WrRenderer *renderer[2]; /* owned; created on the thread that uses them */
    const char *isa;         /* borrowed; as in wr_renderer_new */
    WrReference kept;        /* reference of the last error ... */
    char *kept_of;           /* ... and its inputs as text; owned; NULL: none */
} WrWorkTools;
/* The scene as commands, without its dials and its tolerance: the key of a benchmark. The caller frees it. */
char *wr_accuracy_base(const WrScene *scene);
void wr_work_tools_fini(WrWorkTools *tools); /* after the thread has ended */

typedef struct WrWork {
    WrWorkKind kind;
    WrWorkTools *tools; /* borrowed */
    uint64_t of;        /* for the caller: state of the document */
    WrField *field;     /* shared, owned */
    WrScene *scene;
    /* prepared tables of its objects, set by the caller; owned; NULL: all use `field` */
    WrTables *tables;
    WrScene *other; /* pair: the second scene; its tolerance is ignored */
    double turn_deg;
    int width, height; /* of the view, pixels */
    WrProbeMap map;
    bool on_table; /* probe: x, y are u, v of the patch, not pixels of the view */
    double x, y;

    /* ---- results; undefined before `done` ---- */
    bool done;
    WrError err; /* reason of a failure */
    /* error */
    WrErrors errors;
    int measured_w, measured_h; /* size of the measured picture, or of the map, in pixels */
    int samples;                /* along a side of the reference's pixels */
    /* RMS change by the last doubling of samples: smaller errors are due to the reference */
    double change;
    float *values;    /* error, map: [measured_h][measured_w], NAN where empty; owned */
    double low, high; /* their 0.5 and 99.5 percentiles; 0 if there are no values */
    WrAccuracyBenchmark benchmark; /* owned */
    WrHardReport *report;          /* owned */
    WrIllusion illusion;           /* owned */
    uint8_t *bgra[2];              /* pair: [height][width][4]; owned */
    WrProbe probe;
    int object; /* probe: index of the object */
    /* probe of a table position: it is visible in the view, and footprint, level and rgb are
       valid */
    bool seen;
} WrWork;

/* A piece of work for a state of the document, which it shares. */
WrWork *wr_work_new(WrWorkKind kind, WrWorkTools *tools, const WrField *field, const WrScene *scene,
                    double turn_deg, int width, int height);
void wr_work_free(WrWork *work);     /* NULL is allowed */
extern const WrJobKind wr_work_jobs; /* job kind for WrWork */

/* ---- probe of all quantities of the formulas at one point, and their text form ---- */

/* The work is WR_WORK_PROBE of accuracy_work.h. */

typedef struct WrText WrText;

/* Fill work->probe. False and work->err only for an invalid camera. */
bool wr_accuracy_probe(WrWork *work);

/* One row of the table: a name, one to three numbers, a unit, and a short description. */
typedef struct WrProbeRow {
    const char *name, *unit, *help;
    int count;
    double value[3];
} WrProbeRow;
#define WR_PROBE_ROWS 26
/* Rows of a probe that hit; footprint, level and intensity only if `seen`. Returns their number. */
int wr_accuracy_probe_rows(const WrProbe *probe, bool seen, WrProbeRow rows[WR_PROBE_ROWS]);
/* A number in the table's form, at most 10 characters. Returns text. */
char *wr_accuracy_probe_number_text(double value, char text[24]);
/* The whole probe as text, one row a line, with all digits. */
void wr_accuracy_probe_text(const WrProbe *probe, bool seen, WrText *text);

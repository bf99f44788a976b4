/* accuracy_work.h - what the Accuracy panel, the comparisons on the patch and the inspector have computed, each as
   one piece of work for a thread in the background (job.h): on snapshots, with renderers of its own. */
#pragma once
#include "ui/jobs/job.h"

#include "hardcases/hardcases.h"
#include "accuracy/illusion.h"
#include "accuracy/ladder.h"
#include "accuracy/metrics.h"
#include "base/error.h"
#include "render/reference/reference.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrTables WrTables;
typedef struct WrRenderer WrRenderer;
typedef struct WrScene WrScene;

#define WR_ERROR_SIDE                                                                              \
    256 /* pixels of the longer side of the picture that the error is measured on, at most */
#define WR_LADDER_SIDE 96 /* and of the ladder's */
#define WR_MAP_SIDE 512   /* and of a map over the patch */

typedef enum WrWorkKind {
    WR_WORK_ERROR,    /* the scene's own picture against the reference */
    WR_WORK_LADDER,   /* error and time of all settings */
    WR_WORK_CASES,    /* the hard cases */
    WR_WORK_ILLUSION, /* bump mapping beside displacement */
    WR_WORK_PAIR,     /* two pictures to compare */
    WR_WORK_MAP,      /* one quantity over the picture */
    WR_WORK_PROBE     /* every quantity at one place */
} WrWorkKind;

/* What one thread keeps from one piece of work to the next. */
typedef struct WrWorkTools {
    WrRenderer *renderer[2]; /* owned; made on the thread that uses them */
    const char *isa;         /* borrowed; as in wr_renderer_new */
    WrReference kept;        /* the last that an error was measured against ... */
    char *kept_of; /* ... and all that it depends on, as text; owned; NULL: there is none */
} WrWorkTools;
/* The scene as commands, but for its dials and its tolerance: what a ladder is about. Caller frees. */
char *wr_accuracy_base(const WrScene *scene);
void wr_work_tools_fini(WrWorkTools *tools); /* after the thread has ended */

typedef struct WrWork {
    WrWorkKind kind;
    WrWorkTools *tools; /* borrowed */
    uint64_t of;        /* the caller's: which state this is about */
    WrField *field;     /* own shares */
    WrScene *scene;
    WrTables *tables; /* of its objects, the caller's to set; owned; NULL: `field` is that of all */
    WrScene *other;   /* pair: the second; its tolerance is not looked at */
    double turn_deg;
    int width, height; /* of the view, pixels */
    WrProbeMap map;
    bool on_table; /* probe: x, y are u, v of the patch, not pixels of the view */
    double x, y;

    /* ---- results; of no meaning while not done ---- */
    bool done;
    WrError err; /* why not */
    /* error */
    WrErrors errors;
    int measured_w, measured_h; /* pixels of what was measured; of a map: of it */
    int samples;                /* a side of the reference's pixels */
    double
        change; /* what the last doubling of them changed, RMS: smaller errors are the reference's own */
    float *values;        /* error, map: [measured_h][measured_w], NAN where nothing is; owned */
    double low, high;     /* 0.5 and 99.5 percentiles of them; 0 without any */
    WrLadder ladder;      /* owned */
    WrHardReport *report; /* owned */
    WrIllusion illusion;  /* owned */
    uint8_t *bgra[2];     /* pair: [height][width][4]; owned */
    WrProbe probe;
    int object; /* probe: which of the scene's objects it is about */
    bool
        seen; /* probe: of a place of the table: the view shows it, and footprint, level and rgb hold */
} WrWork;

/* A piece of work about a state of the document, which it shares. */
WrWork *wr_work_new(WrWorkKind kind, WrWorkTools *tools, const WrField *field, const WrScene *scene,
                    double turn_deg, int width, int height);
void wr_work_free(WrWork *work);     /* NULL is fine */
extern const WrJobKind wr_work_jobs; /* runs a WrWork, or drops it */

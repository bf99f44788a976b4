/* busy_internal.h - what runs beside the window, and what waits for it: for busy*.c and run_line.c alone. */
#pragma once
#include "ui/state/busy.h"

#include "base/array.h"
#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

#define WR_BUSY_MOMENT 0.2 /* seconds: what takes less shows no bar */

typedef struct WrJob WrJob;

/* What is done when one is that nobody waits for. */
typedef void WrBusyDone(WrApp *app, void *ctx, bool ok, const WrError *err);

struct WrBusy {
    WrBusyKind kind;
    WrSession *session; /* the worker's alone */
    WrJob *job;         /* owned */
    WrBusyWork *work;
    void *ctx;   /* of the work */
    WrError err; /* of the worker's until it is done, and: */
    bool ok;

    bool is_done;
    char *what;        /* owned */
    double since;      /* clock */
    double furthest;   /* fraction: bars do not go back */
    double refused_at; /* clock */
    bool cancelled, closes;
    bool in_frame;     /* it began inside a picture of the window: */
    double picture;    /* app->drawn_at then */
    bool file_chosen;  /* the desktop's dialog spoke: it is heard afterwards */
    WrBusyDone *after; /* NULL: somebody waits */
    void *after_ctx;
};

/* Begin, and come back when it is done or a moment has passed. True if it is done. */
bool wr_busy_begin(WrApp *app, const WrBusy *busy);
/* Come back when it is done; not inside a picture, but that it may be. */
void wr_busy_wait(WrApp *app);
/* The user gives it up: it ends soon. */
void wr_busy_cancel(WrBusy *busy);
/* It is done: the session is the window's again. What it said; err may be NULL. */
bool wr_busy_end(WrApp *app, WrError *err);

/* ---- what waits: busy_waits.c ---- */

typedef struct WrWaiting {
    WrBusyLate *late;
    char *text, *words; /* owned */
    uint64_t layers;    /* what they were; 0: whatever they are */
} WrWaiting;

struct WrWaits {
    WR_ARRAY(WrWaiting) items; /* oldest first */
    bool running, given_up;
};

void wr_waits_run(WrApp *app);
typedef enum WrDropped { WR_DROPPED_CANCELLED, WR_DROPPED_LAYERS, WR_DROPPED_WISH } WrDropped;
void wr_waits_drop(WrApp *app, WrDropped why); /* with a word */
/* What waits, parted by `between`. */
void wr_waits_words(const WrApp *app, const char *between, char *text, size_t size);

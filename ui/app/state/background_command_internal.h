/* background_command_internal.h - state of the running background command and its queue. Private to busy*.c, run_line.c and
   document.c. */
#pragma once
#include "base/progress.h"
#include "ui/app/state/background_command.h"

#include "base/array.h"
#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

#define WR_BUSY_MOMENT 0.2 /* seconds: shorter work shows no progress */

typedef struct WrJob WrJob;

/* Called at the end of a command that no caller waits for. */
typedef void WrBusyDone(WrApp *app, void *ctx, bool ok, const WrError *err);

struct WrBusy {
    WrBusyKind kind;
    WrSession *session; /* only the worker uses it */
    WrJob *job;         /* owned */
    WrBusyWork *work;
    void *ctx;   /* argument of the work */
    WrError err; /* written by the worker until it is done, and: */
    bool ok;

    bool is_done;
    char *what;        /* owned */
    double since;      /* clock */
    double quiet;      /* seconds that wr_busy_begin waits for the work; 0: QUIET_SECONDS */
    double furthest;   /* fraction shown so far: progress never goes back */
    double refused_at; /* clock */
    WrTimeLeft left;
    bool cancelled, closes;
    bool in_frame;     /* it began inside a frame: */
    double picture;    /* app->drawn_at at that time */
    bool file_chosen;  /* the native file dialog closed; handled afterwards */
    WrBusyDone *after; /* NULL: a caller waits */
    void *after_ctx;
};

/* Start, and return when the work is done or a moment has passed. True if it is done. */
bool wr_busy_begin(WrApp *app, const WrBusy *busy);
/* Wait until the work is done; not inside a frame, except if it began there. */
void wr_busy_wait(WrApp *app);
/* Finish completed work: the window gets the session back. Returns the result; err may be NULL. */
bool wr_busy_end(WrApp *app, WrError *err);

/* ---- queued actions ---- */

typedef struct WrWaiting {
    WrBusyLate *late;
    char *text, *words; /* owned */
    uint64_t layers;    /* key of the layers at that time; 0: not checked */
} WrWaiting;

struct WrWaits {
    WR_ARRAY(WrWaiting) items; /* oldest first */
    bool running, given_up;
};

typedef enum WrDropped { WR_DROPPED_CANCELLED, WR_DROPPED_LAYERS, WR_DROPPED_WISH } WrDropped;

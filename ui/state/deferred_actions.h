/* deferred_actions.h - actions deferred to the end of the current frame. */
#pragma once
#include "ui/state/app_state.h"

#include "base/array.h"

#include <stdbool.h>

/* An action requested inside a frame, done after it. */
typedef void WrDeferredWork(WrApp *app, const char *text);
typedef struct WrDeferredItem {
    WrDeferredWork *work;
    char *text; /* owned */
} WrDeferredItem;
typedef struct WrDeferred {
    WR_ARRAY(WrDeferredItem)
    items;        /* in order of the requests; one of each kind */
    double since; /* clock */
} WrDeferred;

/* Request work(app, text) after the frame; replaces an earlier request of the same kind. */
void wr_deferred(WrApp *app, WrDeferredWork *work, const char *text);
bool wr_deferred_waits(const WrApp *app, WrDeferredWork *work); /* NULL: any */
void wr_deferred_run(WrApp *app);                               /* run the deferred actions */
void wr_deferred_free(WrApp *app);

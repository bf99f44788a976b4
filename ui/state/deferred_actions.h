/* deferred_actions.h - what is done after the picture of the window that is being made. */
#pragma once
#include "ui/state/app_state.h"

#include "base/array.h"

#include <stdbool.h>

/* What was asked for inside a picture of the window, to be done after it. */
typedef void WrDeferredWork(WrApp *app, const char *text);
typedef struct WrDeferredItem {
    WrDeferredWork *work;
    char *text; /* owned */
} WrDeferredItem;
typedef struct WrDeferred {
    WR_ARRAY(WrDeferredItem)
    items;        /* in the order in which they were asked for; one of each kind */
    double since; /* clock */
} WrDeferred;

/* work(app, text) then; what was put off of the same kind before is not done. */
void wr_deferred(WrApp *app, WrDeferredWork *work, const char *text);
bool wr_deferred_waits(const WrApp *app, WrDeferredWork *work); /* NULL: any */
void wr_deferred_run(WrApp *app);                               /* do what was put off */
void wr_deferred_free(WrApp *app);

/* action.h - named actions, used by menus, keys, buttons and the search. The rows are in the registry. */
#pragma once
#include "ui/app/state/app_state.h"

#include "base/array.h"

#include <stdbool.h>

/* State of the active layer that an action needs; otherwise it is disabled, and its key shows a note with the reason. */
typedef enum WrActionLayer {
    WR_ACTION_ANY_LAYER,
    WR_ACTION_UNLOCKED,
    WR_ACTION_PAINTABLE /* unlocked, visible, with heights or a mask to edit */
} WrActionLayer;

struct WrAction {
    const char *name;  /* as in the key file */
    const char *label; /* as in menus; "..." if it opens a dialog first */
    void (*run)(WrApp *app);
    bool (*enabled)(const WrApp *app); /* NULL: always */
    bool (*checked)(const WrApp *app); /* NULL: never */
    /* changes the document or a file of it: disabled while a command runs in the background */
    bool edits;
    bool waits; /* of those: queued behind the running command and the strokes that wait for it */
    WrActionLayer layer;
    const char *several; /* label for %d chosen layers; NULL: the same */
    int row_menu; /* its part of the context menu of a layer's row, from 1; 0: it is not there */
};

/* NULL: none, or an action of a family */
const WrAction *wr_action_find(const WrApp *app, const char *name);
/* One line of help for an action. */
const char *wr_action_help(const WrApp *app, const WrAction *action);
bool wr_action_can(const WrApp *app, const WrAction *action); /* enabled now */
/* Run now, or after the current frame. */
void wr_action_run(WrApp *app, const char *name);

/* ---- actions deferred to the end of the current frame ---- */

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

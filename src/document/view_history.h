/* view_history.h - history of camera views, with steps back and forward.
   Separate from the undo history (history.h): views are not edits, and the two histories have separate steps. */
#pragma once
#include "scene/camera.h"

#include <stdint.h>

typedef struct WrScene WrScene;

#define WR_VIEWS_MAX 1000 /* maximum; the oldest are removed */

typedef struct WrViews WrViews;

/* Creates a history with one view. The caller owns it. */
WrViews *wr_views_new(const WrSceneView *start);
void wr_views_free(WrViews *views);            /* NULL is fine */
WrViews *wr_views_clone(const WrViews *views); /* the caller owns it */

/* Makes `view` the current one. If it equals the current view there is no step; else the views after that are
   removed. */
void wr_views_note(WrViews *views, const WrSceneView *view);

int wr_views_back(const WrViews *views);    /* number of steps possible back */
int wr_views_forward(const WrViews *views); /* and forward */
/* Moves by `steps` (negative: back), -back..forward, and returns the view there. */
WrSceneView wr_views_go(WrViews *views, int steps);
/* Number of the current view, counted from the start, including removed ones. */
int64_t wr_views_number(const WrViews *views);
/* The first view, always kept. */
WrSceneView wr_views_start(const WrViews *views);

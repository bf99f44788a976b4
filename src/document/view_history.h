/* view_history.h - how the scene was looked at, one view after the other, and the way back through them. A history
   of its own beside that of the edits (history.h): views are no edits, and neither takes the other's steps.
   Layer 5. */
#pragma once
#include "scene/camera.h"

#include <stdint.h>

typedef struct WrScene WrScene;

#define WR_VIEWS_MAX 1000 /* that are kept; the oldest go first */

typedef struct WrViews WrViews;

/* The caller owns it. */
WrViews *wr_views_new(const WrSceneView *start);
void wr_views_free(WrViews *views);            /* NULL is fine */
WrViews *wr_views_clone(const WrViews *views); /* the caller owns it */

/* `view` is the present one now. One that equals the present one is no step; else those after it are gone. */
void wr_views_note(WrViews *views, const WrSceneView *view);

int wr_views_back(const WrViews *views);    /* how many can be gone back to */
int wr_views_forward(const WrViews *views); /* and forward */
/* Make the one `steps` after the present one (before it: below 0) the present one, -back..forward. */
WrSceneView wr_views_go(WrViews *views, int steps);
/* The present one's number: views are counted on however many were given up. */
int64_t wr_views_number(const WrViews *views);
/* The one that it began with, kept for good. */
WrSceneView wr_views_start(const WrViews *views);

/* patch_paint.h - painting on the patch. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/input_router.h"
#include "ui/preview/patch_picks.h"

#include <SDL.h>
#include <stdbool.h>

/* Painting on the patch (patch_paint.c). */
typedef struct WrPatchPaint {
    bool on;             /* the pointer over the patch paints instead of turning it */
    WrPatchPicks *picks; /* owned */
    WrScene *scene;      /* own share; what they were made for */
    double turn_deg;
    SDL_Rect room;
    bool inside; /* the last step lay on the object */
    WrPatchSpot last;
    WrPointer at; /* where the last step ended */
} WrPatchPaint;

/* Where the table is that lies under a pointer on the patch; false beside the object. */
bool wr_patch_paint_uv(WrApp *app, const WrPointer *at, double *u, double *v);
void wr_patch_paint_press(WrApp *app, const WrPointer *at);
void wr_patch_paint_drag(WrApp *app, const WrPointer *at);
void wr_patch_paint_release(WrApp *app, const WrPointer *at);
void wr_patch_paint_overlay(WrApp *app); /* the brush's outline on the object */
void wr_patch_paint_free(WrApp *app);

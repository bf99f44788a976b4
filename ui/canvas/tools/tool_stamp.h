/* tool_stamp.h - stamp tool: a picture, or the round brush, applied once. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/jobs/edit_preview.h"

#include "base/array.h"
#include "brush/brush.h"
#include "brush/tip.h"
#include "ui/canvas/tools/brush_outline.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrText WrText;

/* A picture for stamping; texts are owned. */
typedef struct WrStamp {
    char *path;
    char *group; /* heading in the browser */
    char *words; /* for the search; they begin with "lower" if it is carved */
} WrStamp;

/* Mode and values of settings.brush, with separate picture, size and rotation. */
typedef struct WrStampState {
    WrTip *tip;     /* owned; NULL: none chosen */
    char *tip_path; /* owned */
    double radius, angle_deg, first_radius, first_angle;
    bool placed, dragged;       /* its position is set; rotation and size were dragged */
    double u, v;                /* its position */
    WrEditPreviewRequest tried; /* last requested preview */
    WrBrush tried_brush;
    bool trying;
    WR_ARRAY(WrStamp) stamps; /* available pictures, of the program, the user and GIMP */
    bool stamps_known;
    uint64_t folder; /* hash of the names in the user's folder; 0: not read yet */
} WrStampState;

void wr_stamp_file_chosen(WrApp *app, const char *path); /* handler of a chosen file */
void wr_stamp_forget(WrApp *app);                        /* free it */

/* ---- the list of stamps ---- */

void wr_stamps_find(WrApp *app); /* scans the folders at the first call, and after a change */
/* True if the names in the user's folder changed since the last call: the list is scanned again. */
bool wr_stamps_changed(WrApp *app);
/* Readable form of a file name: "wood-grain_2.png" is Wood grain 2. */
void wr_stamp_name(const char *path, WrText *out);
SDL_Texture *wr_stamp_picture(WrApp *app, int index, int side); /* as wr_thumb */
int wr_stamp_chosen(const WrApp *app);                          /* index, or -1 */
/* Use it, with the tool; those that are carved lower the surface. -1: the round brush. False: unreadable, with a message. */
bool wr_stamp_choose(WrApp *app, int index);
/* Preview the chosen stamp at (u, v) while it is dragged over the canvas; over false: end it. */
void wr_stamp_hover(WrApp *app, double u, double v, bool over);

/* ---- stamps on the patch ---- */

bool wr_stamp_is_chosen(const WrApp *app); /* the tool */
WrBrushMark wr_stamp_mark(const WrApp *app);
void wr_stamp_at(WrApp *app, double u, double v);
/* At a point of the mesh, turned about its normal against u, degrees anticlockwise. eye: as in `sculpt`, or NULL. */
void wr_stamp_on_mesh(WrApp *app, WrVec3 p, const WrVec3 *eye, double turn_deg);

extern const WrPart wr_part_stamp;

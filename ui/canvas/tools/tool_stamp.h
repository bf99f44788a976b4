/* tool_stamp.h - stamp tool: a picture, or the round brush, applied once. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/jobs/edit_preview.h"

#include "base/array.h"
#include "brush/brush.h"
#include "brush/tip.h"
#include "ui/canvas/tools/brush_outline.h"

#include <stdbool.h>

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
    WR_ARRAY(char *) stamps; /* available pictures, owned */
    bool stamps_known;
} WrStampState;

void wr_stamp_file_chosen(WrApp *app, const char *path); /* handler of a chosen file */
void wr_stamp_forget(WrApp *app);                        /* free it */

/* ---- stamps on the patch ---- */

bool wr_stamp_is_chosen(const WrApp *app); /* the tool */
WrBrushMark wr_stamp_mark(const WrApp *app);
void wr_stamp_at(WrApp *app, double u, double v);
/* At a point of the mesh, turned about its normal against u, degrees anticlockwise. eye: as in `sculpt`, or NULL. */
void wr_stamp_on_mesh(WrApp *app, WrVec3 p, const WrVec3 *eye, double turn_deg);

extern const WrPart wr_part_stamp;

/* ---- pictures for stamping, in the brush folders of the program, the user and GIMP ---- */

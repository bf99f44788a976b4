/* tool_stamp.h - a stamp: a picture, or the round brush, put onto the table once. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"
#include "ui/jobs/edit_preview.h"

#include "base/array.h"
#include "brush/brush.h"
#include "brush/tip.h"

#include <stdbool.h>

/* settings.brush's mode and values, with a picture, size and turn of its own. */
typedef struct WrStampHand {
    WrTip *tip;     /* owned; NULL: none chosen */
    char *tip_path; /* owned */
    double radius, angle_deg, first_radius, first_angle;
    bool placed, dragged;   /* it lies on the table; its turn and size were dragged */
    double u, v;            /* where */
    WrEditPreviewAsk tried; /* what was asked for last */
    WrBrush tried_brush;
    bool trying;
    WR_ARRAY(char *) stamps; /* pictures to choose from, owned */
    bool stamps_known;
} WrStampHand;

/* That picture, NULL: the round brush. False: it cannot be read; a message says why. */
bool wr_stamp_choose(WrApp *app, const char *path);
void wr_stamp_take(WrApp *app, const char *path); /* of a file that was chosen */
void wr_stamp_forget(WrApp *app);                 /* at the end */

extern const WrPart wr_part_stamp;

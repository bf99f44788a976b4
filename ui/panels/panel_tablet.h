/* panel_tablet.h - what the two files of the tablet tester share. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/points_pad.h"
#include "ui/input/pen_curve.h"

#include "base/array.h"

#include <stdbool.h>
#include <stdint.h>

/* A point of the scribble. */
typedef struct WrScribble {
    double x, y; /* pixels of the window */
    double pressure;
    bool joined; /* to the one before */
    bool eraser, finger;
} WrScribble;

struct WrTester {
    int chosen;      /* index of the device */
    bool chosen_own; /* by a click; else the one that was heard of last */
    int64_t seen;    /* number of the next event to look at */
    WR_ARRAY(WrScribble) points;
    int drawing;                       /* device whose line is being drawn, -1: none */
    double pad_x, pad_y, pad_w, pad_h; /* of the scribble, as drawn last, pixels of the window */
    WrPointsHand grip;                 /* on the curve */
    double counted_at, rate;           /* events a second */
    int64_t counted;
    double newest_at; /* clock */
};

/* Look at what came since the last picture. */
void wr_tester_follow(WrApp *app);
void wr_tester_scribble(WrApp *app, double width, double height);
/* The newest numbers of the chosen device. */
void wr_tester_live(WrApp *app, double width, double height);
/* The curve from the device's pressure (across) to the brush's (up), whose points are moved by hand. */
WrEdit wr_tester_curve(WrApp *app, double side, WrPenCurve *curve);

/* panel_tablet.c: the pressure curves that were kept go to the pens; the tester. */
void wr_tablet_start(WrApp *app);
void wr_tablet_free(WrApp *app);
void wr_dialog_tablet_open(WrApp *app);
void wr_dialog_tablet(WrApp *app);

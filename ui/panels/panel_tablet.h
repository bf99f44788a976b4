/* panel_tablet.h - tablet tester: its state, its dialog, and the stored pressure curves. */
#pragma once
#include "ui/app/state/app_state.h"
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
    bool joined; /* connected to the previous point */
    bool eraser, finger;
} WrScribble;

struct WrTester {
    int chosen;      /* index of the device */
    bool chosen_own; /* chosen by a click; else the device of the last event */
    int64_t seen;    /* number of the next event to handle */
    WR_ARRAY(WrScribble) points;
    int drawing; /* device that draws the present line, -1: none */
    /* rectangle of the scribble in the last frame, pixels of the window */
    double pad_x, pad_y, pad_w, pad_h;
    WrPointsState grip;      /* drag of a curve point */
    double counted_at, rate; /* events per second */
    int64_t counted;
    double newest_at; /* clock */
};

/* Applies the pressure curves of the settings to the pens. */
void wr_tablet_start(WrApp *app);
void wr_tablet_free(WrApp *app);
void wr_dialog_tablet_open(WrApp *app); /* creates the tester */
void wr_dialog_tablet(WrApp *app);

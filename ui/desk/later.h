/* later.h - what is done after the picture of the window that is being made. */
#pragma once
#include "ui/desk/desk.h"

#include "base/array.h"

#include <stdbool.h>

/* What was asked for inside a picture of the window, to be done after it. */
typedef void WrLaterWork(WrApp *app, const char *text);
typedef struct WrLaterItem {
    WrLaterWork *work;
    char *text; /* owned */
} WrLaterItem;
typedef struct WrLater {
    WR_ARRAY(WrLaterItem) items; /* in the order in which they were asked for; one of each kind */
    double since;                /* clock */
} WrLater;

/* work(app, text) then; what was put off of the same kind before is not done. */
void wr_later(WrApp *app, WrLaterWork *work, const char *text);
bool wr_later_waits(const WrApp *app, WrLaterWork *work); /* NULL: any */
void wr_later_run(WrApp *app);                            /* do what was put off */
void wr_later_free(WrApp *app);

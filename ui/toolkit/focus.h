/* focus.h - the widgets by keys alone. While the focus is shown, a ring stands round one widget: Tab and the arrows move
   it, Space and Enter press, and all other keys do what they do without it. It goes at a press of the pointer, and with
   Escape; then the keys are the canvas's again. */
#pragma once
#include <SDL.h>
#include <stdbool.h>

typedef struct WrGui WrGui;

#ifdef __cplusplus
extern "C" {
#endif

/* From part to part: way 1 or -1. A part is a bar, a panel or a group on a view; after the last one the keys are the
   canvas's, as at first. Not while a dialog, a menu or a list is open. */
void wr_gui_focus_part(WrGui *gui, int way);
/* To the first of the menus; opened: with its entries. */
void wr_gui_focus_menus(WrGui *gui, bool opened);
/* The newest key that went down is for the focus, and nobody else's. */
bool wr_gui_took_key(const WrGui *gui);

/* ---- for tests: what can be reached ---- */

typedef enum WrKeyStopKind {
    WR_STOP_PRESS,   /* Space or Enter presses it */
    WR_STOP_MENU,    /* it opens a menu */
    WR_STOP_ITEM,    /* of a menu */
    WR_STOP_SEGMENT, /* one of several of which one is chosen */
    WR_STOP_TAB,
    WR_STOP_TILE,
    WR_STOP_LIST, /* a row of a list; Enter is a double click */
    WR_STOP_ROW,  /* a row that holds widgets */
    WR_STOP_NUMBER,
    WR_STOP_CHOICE,
    WR_STOP_TEXT,
    WR_STOP_PAD,   /* the arrows move a pointer on it, Space presses there */
    WR_STOP_SCROLL /* nothing to press: the keys move what it shows */
} WrKeyStopKind;

/* What Tab stops at, in the order in which the widgets stand. */
typedef struct WrKeyStop {
    unsigned id;
    unsigned part;   /* of the window that it belongs to, lists within it counted to it */
    unsigned window; /* the list, or the part itself */
    int group;       /* the same for neighbours among which arrows move and Tab does not; else 0 */
    WrKeyStopKind kind;
    bool chosen;          /* Tab comes to this one of its group */
    float x0, y0, x1, y1; /* pixels of the window */
} WrKeyStop;

/* Those of the newest picture of the window. Valid until the next. */
const WrKeyStop *wr_gui_stops(const WrGui *gui, int *count);
/* Moves the ring to a stop of the newest picture, as Tab would; false: there is no such stop, or it cannot be reached. */
bool wr_gui_focus_on(WrGui *gui, unsigned id);
unsigned wr_gui_focus_now(const WrGui *gui); /* what the ring is round; 0: none is shown */
unsigned wr_gui_under_pointer(void);         /* the widget that a press would be for; 0: none */

#ifdef __cplusplus
}
#endif

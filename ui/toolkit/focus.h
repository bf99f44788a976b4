/* focus.h - keyboard navigation of widgets. While the focus is visible, a ring marks one widget: Tab and the arrow
   keys move it, Space and Enter press the widget; all other keys work as without it. A press of the pointer or Escape
   hides it; the keys then belong to the canvas again. */
#pragma once
#include <SDL.h>
#include <stdbool.h>

typedef struct WrGui WrGui;

#ifdef __cplusplus
extern "C" {
#endif

/* Move from part to part: way 1 or -1. A part is a bar, a panel or a group on a view; after the last one the keys
   belong to the canvas, as initially. Not while a dialog, a menu or a list is open. */
void wr_gui_focus_part(WrGui *gui, int way);
/* Move to the first menu; opened: with its entries. */
void wr_gui_focus_menus(WrGui *gui, bool opened);
/* True if the newest key press is used by the focus alone. */
bool wr_gui_took_key(const WrGui *gui);

/* ---- for tests: reachable widgets ---- */

typedef enum WrKeyStopKind {
    WR_STOP_PRESS,   /* Space or Enter presses it */
    WR_STOP_MENU,    /* it opens a menu */
    WR_STOP_ITEM,    /* of a menu */
    WR_STOP_SEGMENT, /* one of several alternatives */
    WR_STOP_TAB,
    WR_STOP_TILE,
    WR_STOP_LIST, /* row of a list; Enter is a double click */
    WR_STOP_ROW,  /* row that contains widgets */
    WR_STOP_NUMBER,
    WR_STOP_CHOICE,
    WR_STOP_TEXT,
    WR_STOP_PAD,   /* the arrow keys move a pointer on it, Space presses there */
    WR_STOP_SCROLL /* scrolled by keys, without a widget to press */
} WrKeyStopKind;

/* A widget that Tab can reach, in layout order. */
typedef struct WrKeyStop {
    unsigned id;
    unsigned part;   /* its window; lists inside belong to it */
    unsigned window; /* the list, or the part itself */
    int group;       /* equal for neighbours among which the arrow keys, not Tab, move; else 0 */
    WrKeyStopKind kind;
    bool chosen;          /* the one of its group that Tab reaches */
    float x0, y0, x1, y1; /* pixels of the window */
} WrKeyStop;

/* Reachable widgets of the newest frame; valid until the next. */
const WrKeyStop *wr_gui_stops(const WrGui *gui, int *count);
/* Move the ring to a widget of the newest frame, as Tab would; false: it does not exist, or is unreachable. */
bool wr_gui_focus_on(WrGui *gui, unsigned id);
unsigned wr_gui_focus_now(const WrGui *gui); /* widget with the ring; 0: not visible */
unsigned wr_gui_under_pointer(void);         /* the widget that a press would reach; 0: none */

#ifdef __cplusplus
}
#endif

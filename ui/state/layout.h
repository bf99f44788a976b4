/* layout.h - which part of the window holds what. Pure geometry; tested without a window. */
#pragma once
#include <SDL.h>
#include <stdbool.h>

typedef enum WrShownViews { WR_VIEWS_BOTH, WR_VIEWS_CANVAS, WR_VIEWS_PATCH } WrShownViews;

/* From one tool of the strip to the next, pixels at scale 1: where all have room, and where they just fit into one
   column. */
#define WR_TOOL_MOST 38
#define WR_TOOL_LEAST 30
#define WR_STRIP_MORE 3 /* buttons among the tools (panels/panel_tools.c) */

typedef struct WrLayoutInput {
    int width, height; /* of the window, pixels */
    int menu_height;   /* pixels */
    double scale;      /* pixels a unit */
    double divider;    /* share of the views' room that the canvas gets, 0..1 */
    WrShownViews views;
    bool panels;  /* false: the views fill the window */
    double lower; /* share of the panel on the right that its lower part gets, 0..1 */
    int tools; /* in the strip, which has two columns where one is too short for them at their least */
} WrLayoutInput;

/* Rectangles in pixels; w = 0 where there is none. They cover the window without gaps or overlaps. */
typedef struct WrLayout {
    SDL_Rect options, strip, canvas, divider, patch, status;
    SDL_Rect panel, panel_divider, lower; /* on the right; lower.w is 0 where it is too short */
    bool stacked;                         /* the patch is under the canvas, not beside it */
} WrLayout;

WrLayout wr_layout_make(const WrLayoutInput *in);
/* The lower panel's share for a pointer at y. */
double wr_layout_lower_at(const WrLayout *layout, int y);
/* The divider's share for a pointer at (x, y). */
double wr_layout_divider_at(const WrLayout *layout, int x, int y);
/* Where a window goes whose borders (left, top, right, bottom) would lie beyond the room that the desktop
   leaves: as little smaller and as little moved as it takes. now, fits: the inside, without borders. False if
   it fits already. */
bool wr_layout_window(const SDL_Rect *room, const SDL_Rect *now, const int borders[4],
                      SDL_Rect *fits);
bool wr_layout_inside(const SDL_Rect *rect, int x, int y);

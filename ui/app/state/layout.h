/* layout.h - rectangles of the window's areas. Pure geometry; tested without a window. */
#pragma once
#include <SDL.h>
#include <stdbool.h>

typedef enum WrShownViews { WR_VIEWS_BOTH, WR_VIEWS_CANVAS, WR_VIEWS_PATCH } WrShownViews;

/* Tool strip spacing in pixels at scale 1: normal, and the smallest for one column. */
#define WR_TOOL_MAX 38
#define WR_TOOL_MIN 30
#define WR_STRIP_MORE 3 /* extra buttons among the tools (panels/panel_tools.c) */

typedef struct WrLayoutInput {
    int width, height; /* of the window, pixels */
    int menu_height;   /* pixels */
    double scale;      /* pixels per unit */
    double divider; /* share of the views' area for the canvas, 0..1; 0 and 1 close one of them */
    WrShownViews views;
    bool panels;  /* false: the views fill the window */
    double lower; /* share of the side panel for its lower part, 0..1; 0: closed */
    /* number in the strip; it has two columns if one is too short even at the smallest spacing */
    int tools;
    double side_width; /* of the side panel, units; 0: automatic, below 0: closed */
    bool side_left;    /* the side panel is on the left, the tool strip on the right */
    bool hide_strip, hide_options;
} WrLayoutInput;

/* Rectangles in pixels; w = 0 for a hidden area. They cover the window without gaps or overlaps. */
typedef struct WrLayout {
    SDL_Rect options, strip, canvas, divider, patch, status;
    SDL_Rect panel, panel_divider, lower; /* at the side; lower.w is 0 if the panel is too short */
    SDL_Rect side;                        /* divider between the views and the side panel */
    bool stacked;                         /* the patch is below the canvas, not beside it */
} WrLayout;

WrLayout wr_layout_make(const WrLayoutInput *in);
/* Share of the lower panel for a pointer at y; 0 near the lower end. */
double wr_layout_lower_at(const WrLayout *layout, int y);
/* Share of the divider for a pointer at (x, y), 0..1. */
double wr_layout_divider_at(const WrLayout *layout, int x, int y);
/* Width of the side panel in units for a pointer at x in a window of `width` pixels: below 0 near its edge. */
double wr_layout_side_at(const WrLayout *layout, int width, double scale, int x);
/* Fit a window with its borders (left, top, right, bottom) into the usable area of the desktop, with the smallest
   change of size and position. now, fits: inner rectangles, without borders. False if it fits already. */
bool wr_layout_window(const SDL_Rect *room, const SDL_Rect *now, const int borders[4],
                      SDL_Rect *fits);
bool wr_layout_inside(const SDL_Rect *rect, int x, int y);

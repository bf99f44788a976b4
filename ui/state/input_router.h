/* input_router.h - the pointer, and what it holds outside the widgets. */
#pragma once
#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrPointer {
    double x, y;           /* pixels of the window; 0.5 is the middle of the first */
    double u, v;           /* unwrapped position on the canvas */
    double pressure;       /* 0..1; of a mouse as settings.fake makes it, 1 unless set */
    double tilt_x, tilt_y; /* -1..1, to the right and towards the user; 0 of a mouse */
    double seconds;        /* of the device's clock; only differences mean something */
    bool pen;              /* a pen or a finger, not the mouse */
    bool eraser;           /* the pen's other end */
    int mods;              /* WR_MOD_ bits */
    int button;            /* SDL_BUTTON_LEFT, ...: a pen's tip is the left one */
} WrPointer;

/* What the pointer holds outside the widgets. */
typedef enum WrGrab {
    WR_GRAB_NONE,
    WR_GRAB_TOOL,
    WR_GRAB_PATCH_PAINT, /* the brush, on the patch */
    WR_GRAB_PICK,        /* a height, by a pen's second button */
    WR_GRAB_PAN,
    WR_GRAB_TURN,   /* the canvas */
    WR_GRAB_RESIZE, /* the brush, by Shift and dragging */
    WR_GRAB_DIVIDER,
    WR_GRAB_SPLIT,    /* the line between two pictures of the patch */
    WR_GRAB_PANELS,   /* the line between the panels on the right */
    WR_GRAB_SYMMETRY, /* its centre */
    WR_GRAB_ORBIT,
    WR_GRAB_LIGHT,
    WR_GRAB_SURROUND, /* they are turned */
    WR_GRAB_HANDLE    /* of the chosen object, on the patch */
} WrGrab;

/* One that patch_hand.c carries on. */
static inline bool wr_grab_on_patch(WrGrab grab)
{
    return grab == WR_GRAB_ORBIT || grab == WR_GRAB_LIGHT || grab == WR_GRAB_SURROUND ||
           grab == WR_GRAB_HANDLE;
}

typedef struct WrInput WrInput;

typedef struct WrHand {
    WrInput *input;  /* events that wait for their turn (ui/app/input.h); owned */
    WrPointer at;    /* newest position */
    WrPointer start; /* where the grab began */
    WrGrab grab;
    int button; /* that the grab began with */
    bool space; /* held over the canvas: the next drag pans */
    bool space_used;
    double turn_from;         /* of the canvas, degrees, when its turning began */
    bool on_canvas, on_patch; /* the pointer is there and over no widget */
    bool line;                /* the key for straight lines is held */
    SDL_Keycode line_key, quick_key;
    double quick_at;  /* clock at which the key for painting on the patch went down; 0: up */
    int quick_events; /* brush.strokes then */
    int device;       /* that the grab began with: of a pen, or -1 */
    double fake_at;   /* seconds of the mouse's last motion, for its pressure */
    int64_t events;   /* of pointers, taken so far (latency.c) */
} WrHand;

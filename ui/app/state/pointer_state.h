/* pointer_state.h - pointer state, and the target of a drag outside the widgets. */
#pragma once
#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrPointer {
    double x, y;           /* pixels of the window; 0.5 is the centre of the first */
    double u, v;           /* unwrapped position on the canvas */
    double pressure;       /* 0..1; of a mouse by settings.fake, 1 unless set */
    double tilt_x, tilt_y; /* -1..1, to the right and towards the user; 0 for a mouse */
    double turn_deg;       /* of a pen about its own axis, clockwise, -180..180; 0 without */
    double seconds;        /* device clock; only differences are meaningful */
    bool pen;              /* a pen or a finger, not a mouse */
    bool eraser;           /* the eraser end of the pen */
    int mods;              /* WR_MOD_ bits */
    int button;            /* SDL_BUTTON_LEFT, ...: a pen's tip is the left button */
} WrPointer;

/* Target of a drag outside the widgets. */
typedef enum WrGrab {
    WR_GRAB_NONE,
    WR_GRAB_TOOL,
    WR_GRAB_PATCH_PAINT, /* paint on the patch */
    WR_GRAB_PICK,        /* pick a height with a pen's second button */
    WR_GRAB_PAN,
    WR_GRAB_TURN,   /* rotate the canvas */
    WR_GRAB_RESIZE, /* change the brush size by Shift and dragging */
    WR_GRAB_DIVIDER,
    WR_GRAB_SPLIT,    /* divider between two pictures of the patch */
    WR_GRAB_PANELS,   /* divider between the two parts of the side panel */
    WR_GRAB_SIDE,     /* divider between the views and the side panel */
    WR_GRAB_SYMMETRY, /* centre of the symmetry */
    WR_GRAB_POINT,    /* point of a shape or ramp layer */
    WR_GRAB_ORBIT,
    WR_GRAB_LIGHT,
    WR_GRAB_SURROUND, /* rotate the environment */
    WR_GRAB_HANDLE    /* handle of the active object on the patch */
} WrGrab;

/* True for a drag handled by patch_input.c. */
static inline bool wr_grab_on_patch(WrGrab grab)
{
    return grab == WR_GRAB_ORBIT || grab == WR_GRAB_LIGHT || grab == WR_GRAB_SURROUND ||
           grab == WR_GRAB_HANDLE;
}

typedef struct WrInput WrInput;

typedef struct WrInputRouter {
    WrInput *input;  /* event queue (ui/app/input.h); owned */
    WrPointer at;    /* newest position */
    int mods;        /* modifier keys at the event that is handled, WR_MOD_ bits */
    int x, y;        /* pixel under the mouse at that event */
    WrPointer start; /* start of the drag */
    WrGrab grab;
    int button;          /* button that started the drag */
    WrGrab last_divider; /* the last pressed divider, */
    double divider_at;   /* and the clock of that press */
    bool space;          /* Space is held over the canvas: the next drag pans */
    bool space_used;
    double turn_from;         /* canvas rotation in degrees at the start of the drag */
    bool on_canvas, on_patch; /* the pointer is over that view and not over a widget */
    bool line;                /* the straight-line key is held */
    SDL_Keycode line_key, quick_key;
    bool key_is_free; /* the last key had no action: the sign it types may have one */
    /* clock at which the key for painting on the patch was pressed; 0: not pressed */
    double quick_at;
    int quick_events;        /* brush.strokes at that time */
    int device;              /* device that started the drag: a pen's index, or -1 */
    double fake_at;          /* seconds of the mouse's last motion, for its simulated pressure */
    const SDL_Rect *gripped; /* rectangle of the view that two fingers move; NULL: none */
    int64_t events;          /* number of pointer events handled so far (latency.c) */
} WrInputRouter;

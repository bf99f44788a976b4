/* state.h - the window's state, and what its files offer each other. Nobody outside ui/ includes it. */
#pragma once
#include "base/array.h"
#include "ui/ants.h"
#include "ui/app.h"
#include "ui/canvas.h"
#include "ui/files.h"
#include "ui/gui.h"
#include "ui/keys.h"
#include "ui/layout.h"
#include "ui/outline.h"
#include "ui/patch_pick.h"
#include "ui/pen.h"
#include "ui/preview.h"
#include "ui/rotation.h"
#include "ui/seam.h"
#include "ui/settings.h"
#include "ui/shelf.h"
#include "ui/steady.h"
#include "ui/trial.h"
#include "ui/view.h"

typedef struct WrApp WrApp;
typedef struct WrRoster WrRoster;             /* roster.h */
typedef struct WrTool WrTool;                 /* tool.h */
typedef struct WrAction WrAction;             /* action.h */
typedef struct WrGenerateHand WrGenerateHand; /* generate_hand.h */
typedef struct WrAccuracy WrAccuracy;         /* accuracy.h */
typedef struct WrLatency WrLatency;           /* latency.c */
typedef struct WrRest WrRest;                 /* rest.h */

/* ---- pointer ---- */

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

/* ---- parts of the state ---- */

typedef enum WrGrab { /* what the pointer holds outside the widgets */
                      WR_GRAB_NONE,
                      WR_GRAB_TOOL,
                      WR_GRAB_PATCH_PAINT, /* the brush, on the patch */
                      WR_GRAB_PICK,        /* a height, by a pen's second button */
                      WR_GRAB_PAN,
                      WR_GRAB_RESIZE, /* the brush, by Shift and dragging */
                      WR_GRAB_DIVIDER,
                      WR_GRAB_SPLIT,    /* the line between two pictures of the patch */
                      WR_GRAB_PANELS,   /* the line between the panels on the right */
                      WR_GRAB_SYMMETRY, /* its centre */
                      WR_GRAB_ORBIT,
                      WR_GRAB_LIGHT
} WrGrab;

typedef struct WrHand {
    WrPointer at;    /* newest position */
    WrPointer start; /* where the grab began */
    WrGrab grab;
    int button; /* that the grab began with */
    bool space; /* held over the canvas: the next drag pans */
    bool space_used;
    bool on_canvas, on_patch; /* the pointer is there and over no widget */
    bool line;                /* the key for straight lines is held */
    SDL_Keycode line_key, quick_key;
    double quick_at;  /* clock at which the key for painting on the patch went down; 0: up */
    int quick_events; /* brush.strokes then */
    int device;       /* that the grab began with: of a pen, or -1 */
    double fake_at;   /* seconds of the mouse's last motion, for its pressure */
    int64_t events;   /* of pointers, taken so far (latency.c) */
} WrHand;

/* What of the brush comes from files, as command lines name it. settings.brush.preset and .tip are what
   was read from them, owned by the window. */
typedef struct WrBrushSources {
    char *preset; /* id of the preset, owned; NULL: none */
    char *tip;    /* path of a tip that is not the preset's own, owned; NULL: none */
    char *set;    /* "name=value;...", owned; NULL: the preset's own settings */
} WrBrushSources;

/* One stroke: being drawn by the session, or waiting for the one before it to be done. */
typedef struct WrStrokeJob {
    char *head; /* the command without points, owned; NULL once the session has it */
    WR_ARRAY(WrSample) samples; /* not handed to the session yet */
    bool released;              /* the pointer let go: no more will come */
} WrStrokeJob;

typedef struct WrBrushHand {
    WR_ARRAY(WrStrokeJob) jobs; /* oldest first; the first may be open in the session */
    bool opened;                /* the first is */
    bool unfinished;            /* the session has more to draw of it */
    bool drawing;               /* the pointer is down and draws the last job */
    bool on_patch;              /* on the patch */
    WrBrush now;                /* the brush of the stroke under way: eraser, seed */
    double began;               /* seconds of its first sample */
    double pressure;            /* newest */
    double way_x, way_y;        /* newest direction in pixels, for outlines that follow it */
    WrSteady steady;
    bool have_last; /* where the last stroke ended, for straight lines */
    double last_u, last_v;
    bool straight; /* a straight line is being aimed */
    double line_u, line_v, to_u, to_v;
    double resize_radius; /* at the start of a resize */
    uint64_t line_key;    /* of the table when last_u, last_v were set: no lines into others */
    int strokes;          /* begun so far */
    uint32_t seeds;       /* strokes with chance in them so far */
    int64_t taken, shown; /* pointer events handed to the session, and drawn (latency.c) */
} WrBrushHand;

/* Painting on the patch (patch_paint.c). */
typedef struct WrPatchPaint {
    bool on;             /* the pointer over the patch paints instead of turning it */
    WrPatchPick *picker; /* owned */
    WrScene *scene;      /* own share; what the picker was made for */
    double turn_deg;
    SDL_Rect room;
    bool inside; /* the last step lay on the object */
    WrPatchSpot last;
    WrPointer at; /* where the last step ended */
} WrPatchPaint;

typedef struct WrPatch {
    SDL_Texture *texture; /* of the newest picture; owned */
    int texture_w, texture_h;
    uint64_t serial;       /* of that picture */
    int64_t seen;          /* pointer events that it shows (latency.c) */
    double turn_deg;       /* 0..360 */
    double rock;           /* where a rocking sheet is on its way, radians (rotation.h) */
    double turned_at;      /* clock at the last step of the turn */
    WrField *wished_field; /* own shares of what was wished for last */
    WrScene *wished_scene;
    double wished_turn;
    int wished_w, wished_h;
    bool wished_moving, wished_painted;
    bool refreshing;  /* sharp pictures are being brought up to date by an edit */
    bool outstanding; /* a moving picture was wished for and has not come */
    bool held;        /* it stands still to be painted on */
    double wished_at, rest_at;
    double still_since;
    /* of a drag */
    WrRotation from; /* the object's own rotation at the start */
    int light;       /* index of the light being moved */
    double light_x, light_y;
    double zoom_commit_at; /* clock at which a zoom by the wheel becomes a command; 0: none */
} WrPatch;

/* A selection that is being drawn. */
typedef struct WrSelectHand {
    bool active;
    WrSelectMode mode;
    double x, y;                    /* texel where it began, unwrapped */
    WR_ARRAY(WrSelectPoint) points; /* the shape so far; of a lasso also what the command gets */
} WrSelectHand;

/* An anchor of a Bezier path: its place and where its two arms end, texels, unwrapped. */
typedef struct WrAnchor {
    double x, y;
    double in_x, in_y, out_x, out_y;
} WrAnchor;

/* What the tools that draw other things than strokes hold. Places are texels, unwrapped. */
typedef struct WrDrawHand {
    bool active;                /* something is begun and neither done nor given up */
    double x0, y0, x1, y1;      /* of a drag: where it began, where it is */
    WR_ARRAY(WrAnchor) anchors; /* of polygons and paths */
    bool closed;                /* the path was closed by a click on its first anchor */
    int held, part;    /* anchor that is dragged, -1: none; 0 itself, 1 its arm back, 2 ahead */
    double clicked_at; /* clock at the last press */
    /* clone */
    bool source, anchored; /* a source was set; and a stroke tied it to the pointer */
    double source_u, source_v;
    /* stamp: settings.brush's mode and values, with a picture, size and turn of its own */
    WrTip *tip;     /* owned; NULL: none chosen */
    char *tip_path; /* owned */
    double radius, angle_deg, first_radius, first_angle;
    bool placed, dragged; /* it lies on the table; its turn and size were dragged */
    double u, v;          /* where */
    WrTrialAsk tried;     /* what was asked for last */
    WrBrush tried_brush;
    bool trying;
    WR_ARRAY(char *) stamps; /* pictures to choose from, owned */
    bool stamps_known;
} WrDrawHand;

/* The outlines on the canvas. */
typedef struct WrMarks {
    WrOutliner *outliner;
    bool trying;        /* the outline is of what a dialog would make, not of the selection */
    uint64_t asked_key; /* of the selection that was outlined last; 0: none */
    WrAnts ants, shape;
    uint64_t traced; /* serial of the outline in ants */
    WrCanvasView traced_view;
    double stepped_at; /* clock at the last step of the march */
} WrMarks;

/* A small picture of a table in a list. */
typedef struct WrThumb {
    SDL_Texture *texture; /* owned */
    int side;             /* pixels */
    uint64_t key, cover;  /* of what it shows */
    double made_at;
} WrThumb;

typedef struct WrLayersHand {
    int dragged; /* index of the layer that is held, -1: none */
    int gap;     /* where it would go: between layers gap - 1 and gap */
    int renamed; /* index of the layer whose name is being typed, -1: none */
    bool fresh;  /* it is the field's first frame */
    char name[WR_LAYER_NAME_MAX + 1];
    bool open;                /* the menu is asked for */
    WR_ARRAY(WrThumb) thumbs; /* two a layer: heights, mask */
} WrLayersHand;

/* What the dialog of an operation holds. */
typedef struct WrAdjust {
    const WrOpInfo *op; /* NULL: none */
    double param[WR_OP_PARAMS];
    int layers;        /* 0 the active one, 1 all */
    uint64_t asked_at; /* the document's revision when it was tried last */
    WrCanvasView view; /* as it was before */
} WrAdjust;

typedef struct WrFinder { /* the search for actions */
    char text[80];
    int chosen;
} WrFinder;

typedef struct WrMeter {     /* memory, measured now and then */
    double at;               /* clock */
    double tiles, undo, all; /* bytes */
} WrMeter;

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

typedef struct WrRecovery WrRecovery;
typedef struct WrTester WrTester; /* panel_tablet.h */

typedef struct WrMessage {
    char *text; /* owned */
    bool bad;   /* an error: stays until read */
    double since;
} WrMessage;

typedef struct WrMessages {
    WR_ARRAY(WrMessage) list; /* oldest first */
    int unread;               /* errors at the end of the list that nobody clicked away */
} WrMessages;

typedef enum WrDialog {
    WR_DIALOG_NONE,
    WR_DIALOG_UNSAVED,
    WR_DIALOG_TABLE,
    WR_DIALOG_FILL,
    WR_DIALOG_GRID,
    WR_DIALOG_IMPORT,
    WR_DIALOG_EXPORT,
    WR_DIALOG_FILE,
    WR_DIALOG_ADJUST,
    WR_DIALOG_SELECT,
    WR_DIALOG_SEARCH,
    WR_DIALOG_RECOVER,
    WR_DIALOG_PRESET,  /* the name of a preset to be saved */
    WR_DIALOG_REPLACE, /* a file that stands where one is to be written */
    WR_DIALOG_TABLET,
    WR_DIALOG_CASES,
    WR_DIALOG_HELP,
    WR_DIALOG_ABOUT,
    WR_DIALOG_COUNT
} WrDialog;

/* What to do once unsaved work is dealt with. */
typedef enum WrAfter {
    WR_AFTER_NOTHING,
    WR_AFTER_NEW,
    WR_AFTER_OPEN,
    WR_AFTER_PATH,
    WR_AFTER_LINES, /* after_path holds commands, a line each */
    WR_AFTER_QUIT
} WrAfter;

typedef struct WrForms { /* what the dialogs hold while they are open */
    double width, height, fill, cells_u, cells_v, line_width, low, high;
    int wrap, kind, range;
    bool fit;
} WrForms;

typedef enum WrReplaceKind {
    WR_REPLACE_CHOSEN,  /* the file of a name that was chosen */
    WR_REPLACE_CHANGED, /* the document's own, which another program has written since */
    WR_REPLACE_PRESET   /* a preset of the user's own */
} WrReplaceKind;

typedef struct WrReplace { /* while it is asked */
    WrReplaceKind kind;
    WrFilePurpose purpose;
    char *path; /* owned */
} WrReplace;

typedef struct WrTiming { /* of the window's own pictures */
    int pictures;
    double seconds, slowest;
} WrTiming;

struct WrApp {
    const WrRoster *roster;      /* borrowed: what the window is made of */
    const WrAppOptions *options; /* borrowed */
    WrSession *session;          /* borrowed */
    SDL_Window *window;
    SDL_Renderer *renderer;
    WrGui *gui;
    WrCanvas *canvas;
    WrPreview *preview;
    WrKeyMap *keys;
    WrPen *pen;
    WrTester *tester;      /* of tablets; owned, NULL until it is opened */
    struct WrGuide *guide; /* the help; owned, NULL until it is opened */
    WrSettings settings;
    WrSettings settings_known; /* as they were read or written last */
    double settings_at;        /* clock when they were looked at last */
    bool settings_failed;      /* and could not be written then */
    WrFiles *files;
    Uint32 ready_event; /* of the preview */
    Uint32 file_event;  /* of a native file dialog */
    Uint32 job_event;   /* of work in the background */
    WrRest *rest;       /* a test that asks; owned, or NULL */
    Uint32 rest_event;  /* it asked */
    SDL_Cursor *cursors[SDL_NUM_SYSTEM_CURSORS];
    SDL_SystemCursor cursor;

    WrLayout layout;
    int width, height, menu_height;
    double display_scale; /* of the display, in steps of 1/4 */
    bool fitted;          /* the user has seen the window: its size is left alone */
    int redraw;           /* pictures of the window still to draw */
    bool visible, quit;
    double drawn_at, started_at;
    double drawn_scale;
    WrTiming timing;

    WrCanvasView view;
    bool view_placed;
    WrCanvasRange range; /* heights that the canvas shows */
    bool canvas_unfinished;
    int tool;
    WrHand hand;
    WrBrushHand brush;
    WrBrushSources brush_files;
    WrShelf shelf;
    WrDrawHand draw;
    WrGenerateHand *generate; /* owned */
    WrAccuracy *accuracy;     /* owned */
    WrPatch patch;
    WrPatchPaint paint;
    WrLatency *latency;        /* while it is being measured; borrowed */
    void (*drawn)(WrApp *app); /* a picture of the window was shown; NULL: nobody asks */
    WrScene *live; /* what the preview shows while a scene value is being dragged; owned */
    bool hints;    /* shown until the first stroke */

    WrTrial *trial;
    bool trying; /* the views show what the trial gives */
    WrMarks marks;
    WrSelectHand select;
    WrLayersHand layers;
    WrAdjust adjust;
    WrOutlineAsk selecting; /* of the dialogs that change the selection */
    WrFinder finder;
    WrSeam seam;
    uint64_t seam_key; /* of the table that it was measured on */
    WrMeter meter;
    WrLater later;
    WrDocument *
        shown; /* while the session works on a thread of its own: the document from before; owned */
    double expected;      /* seconds that the line to be run will take; 0: not known */
    bool tending;         /* nobody asked for it: what is pressed meanwhile is kept */
    bool gave_up;         /* the newest of them failed because the user cancelled it */
    WrRecovery *recovery; /* while its dialog is open; owned */
    bool in_frame;        /* between the first and the last widget of a picture */
    double input_at;      /* clock at the last event of the user's */

    WrMessages messages;
    WrDialog dialog;
    bool dialog_fresh; /* in its first frame */
    WrForms forms;
    WrReplace replace;
    WrAfter after;
    char *after_path;        /* owned */
    uint64_t clean_revision; /* also counts as saved: a starter made by commands */
    bool starter;            /* the document is the starter */
};

#include "ui/action.h"
#include "ui/roster.h"
#include "ui/tool.h"

#include "ui/calls.h"

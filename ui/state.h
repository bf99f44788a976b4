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
#include "ui/preview.h"
#include "ui/rotation.h"
#include "ui/seam.h"
#include "ui/settings.h"
#include "ui/trial.h"
#include "ui/view.h"

typedef struct WrApp WrApp;

/* ---- pointer ---- */

typedef struct WrPointer {
    double x, y; /* pixels */
    double u, v; /* unwrapped position on the canvas */
    int mods;    /* WR_MOD_ bits */
    int button;  /* SDL_BUTTON_LEFT, ... */
} WrPointer;

/* A tool of the strip on the left. Each function may be NULL. */
typedef struct WrTool {
    const char *action; /* that chooses it; its name, label and keys are the action's */
    const char *icon;
    const char *help; /* one sentence */
    void (*press)(WrApp *app, const WrPointer *at);
    void (*drag)(WrApp *app, const WrPointer *at);
    void (*release)(WrApp *app, const WrPointer *at);
    void (*overlay)(WrApp *app); /* drawn over the canvas while the pointer is on it */
    void (*options)(WrApp *app); /* widgets of the option row */
} WrTool;
extern const WrTool wr_tools[];
extern const int wr_tool_count;
int wr_tool_find(const char *action); /* index, or -1 */

/* ---- actions ---- */

typedef struct WrAction {
    const char *name;  /* as in the key file */
    const char *label; /* as in menus; "..." when it asks first */
    void (*run)(WrApp *app);
    bool (*enabled)(const WrApp *app); /* NULL: always */
    bool (*checked)(const WrApp *app); /* NULL: never */
} WrAction;
extern const WrAction wr_actions[]; /* ends with name NULL */
const WrAction *wr_action_find(const char *name);
void wr_action_run(WrApp *app, const char *name);

/* ---- parts of the state ---- */

typedef enum WrGrab { /* what the pointer holds outside the widgets */
                      WR_GRAB_NONE,
                      WR_GRAB_TOOL,
                      WR_GRAB_PAN,
                      WR_GRAB_RESIZE, /* the brush, by Shift and dragging */
                      WR_GRAB_DIVIDER,
                      WR_GRAB_PANELS, /* the line between the panels on the right */
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
} WrHand;

typedef struct WrBrushHand {
    WR_ARRAY(WrSample) samples; /* not handed to the session yet */
    bool have_last;             /* where the last stroke ended, for straight lines */
    double last_u, last_v;
    double resize_radius; /* at the start of a resize */
    uint64_t line_key;    /* of the table when last_u, last_v were set: no lines into others */
} WrBrushHand;

typedef struct WrPatch {
    SDL_Texture *texture; /* of the newest picture; owned */
    int texture_w, texture_h;
    uint64_t serial;       /* of that picture */
    double turn_deg;       /* 0..360 */
    double turned_at;      /* clock at the last step of the turn */
    WrField *wished_field; /* own shares of what was wished for last */
    WrScene *wished_scene;
    double wished_turn;
    int wished_w, wished_h;
    bool wished_moving;
    bool refreshing;  /* sharp pictures are being brought up to date by an edit */
    bool outstanding; /* a moving picture was wished for and has not come */
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

/* The outlines on the canvas. */
typedef struct WrMarks {
    WrOutliner *outliner;
    bool trying;        /* the outline is of what a dialog would make, not of the selection */
    uint64_t asked_key; /* of the selection that was outlined last; 0: none */
    WrAnts ants, shape;
    uint64_t traced; /* serial of the outline in ants */
    WrView traced_view;
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
    int layers;  /* 0 the active one, 1 all */
    WrView view; /* as it was before */
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
typedef struct WrLater {
    const WrAction *action; /* NULL: none */
    char *line;             /* a command; owned */
    char *path;             /* a file chosen; owned */
    char *journal;          /* to recover; owned */
    double since;           /* clock */
    WrFilePurpose purpose;
} WrLater;

typedef struct WrRecovery WrRecovery;

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
    WR_DIALOG_HELP,
    WR_DIALOG_ABOUT
} WrDialog;

/* What to do once unsaved work is dealt with. */
typedef enum WrAfter {
    WR_AFTER_NOTHING,
    WR_AFTER_NEW,
    WR_AFTER_OPEN,
    WR_AFTER_PATH,
    WR_AFTER_QUIT
} WrAfter;

typedef struct WrForms { /* what the dialogs hold while they are open */
    double width, height, fill, cells_u, cells_v, line_width, low, high;
    int wrap, kind, range;
    bool fit;
} WrForms;

typedef struct WrTiming { /* of the window's own pictures */
    int pictures;
    double seconds, slowest;
} WrTiming;

struct WrApp {
    const WrAppOptions *options; /* borrowed */
    WrSession *session;          /* borrowed */
    SDL_Window *window;
    SDL_Renderer *renderer;
    WrGui *gui;
    WrCanvas *canvas;
    WrPreview *preview;
    WrKeyMap *keys;
    WrSettings settings;
    WrFiles *files;
    Uint32 ready_event; /* of the preview */
    Uint32 file_event;  /* of a native file dialog */
    Uint32 job_event;   /* of work in the background */
    SDL_Cursor *cursors[SDL_NUM_SYSTEM_CURSORS];
    SDL_SystemCursor cursor;

    WrLayout layout;
    int width, height, menu_height;
    double display_scale; /* of the display, in steps of 1/4 */
    int redraw;           /* pictures of the window still to draw */
    bool visible, quit;
    double drawn_at, started_at;
    double drawn_scale;
    WrTiming timing;

    WrView view;
    bool view_placed;
    double range[2]; /* heights shown as black and white */
    bool canvas_unfinished;
    int tool;
    WrHand hand;
    WrBrushHand brush;
    WrPatch patch;
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
    WrRecovery *recovery; /* while its dialog is open; owned */
    bool in_frame;        /* between the first and the last widget of a picture */
    double input_at;      /* clock at the last event of the user's */

    WrMessages messages;
    WrDialog dialog;
    bool dialog_fresh; /* in its first frame */
    WrForms forms;
    WrAfter after;
    char *after_path;        /* owned */
    uint64_t clean_revision; /* also counts as saved: a starter made by commands */
    bool starter;            /* the document is the starter */
};

/* ---- app.c ---- */
void wr_app_redraw(WrApp *app);
double wr_app_wanted_scale(const WrApp *app);
void wr_app_set_scale(WrApp *app, double setting); /* 0: the display's */

/* ---- document.c: the document behind the window ---- */
/* What the views show: the composite, or what it would become by what is being tried. */
const WrField *wr_app_field(const WrApp *app);
const WrDocument *wr_app_document(const WrApp *app);
/* Show what this would give; the document is not touched. */
void wr_app_try(WrApp *app, const WrTrialAsk *ask);
void wr_app_try_end(WrApp *app);
const WrScene *wr_app_scene(const WrApp *app); /* live if a value is being dragged */
bool wr_app_unsaved(const WrApp *app);
/* Run a command line; a failure becomes a message. */
bool wr_app_run_line(WrApp *app, const char *line);
bool wr_app_run_linef(WrApp *app, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* A scene that the caller may change at once; the preview shows it until wr_app_live_end. */
WrScene *wr_app_live(WrApp *app);
void wr_app_live_end(WrApp *app);
void wr_app_start(WrApp *app); /* the starter, or what was asked for */
void wr_app_new(WrApp *app);
void wr_app_open(WrApp *app);
void wr_app_open_path(WrApp *app, const char *path); /* asks first if work is unsaved */
bool wr_app_save(WrApp *app); /* false: not saved yet (a dialog is open, or it failed) */
void wr_app_save_as(WrApp *app);
void wr_app_save_history(WrApp *app); /* asks for the file */
/* The document is another one: forget what belonged to the old one. */
void wr_app_changed_document(WrApp *app);
void wr_app_quit(WrApp *app);
void wr_app_go_on(WrApp *app); /* with `after` */
void wr_app_file_chosen(WrApp *app, WrFilePurpose purpose, const char *path);
void wr_app_title(WrApp *app);
const char *wr_app_name(const WrApp *app); /* of the document, without folders */

/* ---- busy.c: what may take long ---- */
/* Call work(ctx), on another thread, and come back when it is done: with what it said. What takes longer
   than a moment shows `what` and a bar; the window stays alive, but nothing else can be done. Inside a
   picture of the window it is simply called. */
typedef bool WrBusyWork(void *ctx, WrError *err);
bool wr_busy_run(WrApp *app, const char *what, WrBusyWork *work, void *ctx, WrError *err);
/* Run a command that may take long, at once or after the picture of the window that is being made. */
void wr_app_run_slow(WrApp *app, const char *line);
/* The same for a file that was chosen, and for an action. */
void wr_later_file(WrApp *app, WrFilePurpose purpose, const char *path);
void wr_later_action(WrApp *app, const char *name);
void wr_later_recover(WrApp *app, const char *journal);
void wr_later_run(WrApp *app); /* do what was put off */

/* ---- marks.c: outlines of selections ---- */
void wr_marks_update(WrApp *app);
void wr_marks_draw(WrApp *app);
void wr_marks_try(WrApp *app, const WrOutlineAsk *ask); /* NULL: the selection as it is */
double wr_marks_next_time(const WrApp *app); /* clock at which they move on; 0: they do not */
void wr_marks_free(WrApp *app);

/* ---- messages.c ---- */
void wr_app_say(WrApp *app, const char *format, ...) __attribute__((format(printf, 2, 3)));
void wr_app_fail(WrApp *app, const WrError *err);
void wr_app_take_notes(WrApp *app);
void wr_messages_free(WrMessages *messages);

/* ---- hand.c: pointer and keys ---- */
void wr_hand_event(WrApp *app, const SDL_Event *event);
void wr_hand_let_go(WrApp *app); /* end what is being held, keeping what was done */
void wr_app_place_view(WrApp *app);

/* ---- tools ---- */
void wr_brush_press(WrApp *app, const WrPointer *at);
void wr_brush_drag(WrApp *app, const WrPointer *at);
void wr_brush_release(WrApp *app, const WrPointer *at);
void wr_brush_overlay(WrApp *app);
void wr_brush_flush(WrApp *app); /* hand the samples to the session */
void wr_brush_resize(WrApp *app, const WrPointer *at);
void wr_brush_pick(WrApp *app, const WrPointer *at);
void wr_brush_options(WrApp *app);
void wr_tool_pan_drag(WrApp *app, const WrPointer *at);
void wr_tool_zoom_press(WrApp *app, const WrPointer *at);
void wr_tool_zoom_drag(WrApp *app, const WrPointer *at);

void wr_select_press(WrApp *app, const WrPointer *at);
void wr_select_drag(WrApp *app, const WrPointer *at);
void wr_select_release(WrApp *app, const WrPointer *at);
void wr_select_cancel(WrApp *app);
void wr_select_options(WrApp *app);

/* ---- views ---- */
void wr_canvas_view_draw(WrApp *app);    /* the picture */
void wr_canvas_view_overlay(WrApp *app); /* what lies on it */
void wr_patch_update(WrApp *app);        /* wish for what is wanted; take what is ready */
void wr_patch_turn_on(
    WrApp *app); /* the same without a look at the document: it is being changed */
void wr_patch_draw(WrApp *app);
void wr_patch_overlay(WrApp *app);
bool wr_patch_press(WrApp *app, const WrPointer *at);
void wr_patch_drag(WrApp *app, const WrPointer *at);
void wr_patch_release(WrApp *app);
void wr_patch_wheel(WrApp *app, double steps);
void wr_patch_commit_zoom(WrApp *app, bool now);
void wr_patch_free(WrApp *app);
double wr_patch_next_time(const WrApp *app); /* clock at which update must run; 0: only on events */

/* ---- panels ---- */
void wr_panel_menu(WrApp *app);
void wr_panel_options(WrApp *app);
void wr_panel_tools(WrApp *app);
void wr_panel_right(WrApp *app);
void wr_panel_scene(WrApp *app);
void wr_panel_material(WrApp *app); /* its lower parts */
void wr_panel_lights(WrApp *app);
/* Run a scene command whose value was being dragged; clears the line. */
void wr_scene_run(WrApp *app, WrText *line);
/* A number of the scene at `place` bytes, while it is being dragged. */
void wr_scene_live_number(WrApp *app, size_t place, double value);
void wr_panel_plan(WrApp *app);
void wr_panel_history(WrApp *app);
void wr_panel_layers(WrApp *app, SDL_Rect room);
void wr_panel_layers_forget(WrApp *app); /* its pictures */
void wr_layer_rename_start(WrApp *app, int index);
void wr_panel_seam(WrApp *app); /* on the canvas */
void wr_panel_status(WrApp *app);
void wr_panel_dialogs(WrApp *app);
void wr_dialog_help(WrApp *app);
void wr_dialog_close(WrApp *app);
/* The operation of an action "adjust_NAME", or NULL. */
const WrOpInfo *wr_action_op(const char *name);
void wr_dialog_adjust_open(WrApp *app, const WrOpInfo *op);
void wr_dialog_adjust(WrApp *app);
void wr_dialog_select_open(WrApp *app, WrOutlineKind kind);
void wr_dialog_select(WrApp *app);
void wr_dialog_search(WrApp *app);
void wr_dialog_recover_open(WrApp *app); /* if there is anything to recover */
void wr_dialog_recover(WrApp *app);
void wr_recover(WrApp *app, const char *journal);
void wr_recovery_free(WrRecovery *recovery); /* NULL is fine */
/* Where a dialog stands whose effect the views show. */
SDL_Rect wr_dialog_side(const WrApp *app);
void wr_dialog_open(WrApp *app, WrDialog dialog);
/* The buttons at the end of a dialog: 1 done, -1 cancelled (also by Escape), 0 neither. */
int wr_dialog_buttons(WrApp *app, const char *done, bool enabled);

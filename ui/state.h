/* state.h - the window's state, and what its files offer each other. Nobody outside ui/ includes it. */
#pragma once
#include "base/array.h"
#include "ui/app.h"
#include "ui/canvas.h"
#include "ui/files.h"
#include "ui/gui.h"
#include "ui/keys.h"
#include "ui/layout.h"
#include "ui/preview.h"
#include "ui/rotation.h"
#include "ui/settings.h"
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
const WrField *wr_app_field(const WrApp *app);
const WrScene *wr_app_scene(const WrApp *app); /* live if a value is being dragged */
bool wr_app_unsaved(const WrApp *app);
/* Run a command line; a failure becomes a message. */
bool wr_app_run_line(WrApp *app, const char *line);
/* A scene that the caller may change at once; the preview shows it until wr_app_live_end. */
WrScene *wr_app_live(WrApp *app);
void wr_app_live_end(WrApp *app);
void wr_app_start(WrApp *app); /* the starter, or what was asked for */
void wr_app_new(WrApp *app);
void wr_app_open(WrApp *app);
void wr_app_open_path(WrApp *app, const char *path); /* asks first if work is unsaved */
bool wr_app_save(WrApp *app); /* false: not saved yet (a dialog is open, or it failed) */
void wr_app_save_as(WrApp *app);
void wr_app_quit(WrApp *app);
void wr_app_go_on(WrApp *app); /* with `after` */
void wr_app_file_chosen(WrApp *app, WrFilePurpose purpose, const char *path);
void wr_app_title(WrApp *app);
const char *wr_app_name(const WrApp *app); /* of the document, without folders */

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

/* ---- views ---- */
void wr_canvas_view_draw(WrApp *app);    /* the picture */
void wr_canvas_view_overlay(WrApp *app); /* what lies on it */
void wr_patch_update(WrApp *app);        /* wish for what is wanted; take what is ready */
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
void wr_panel_status(WrApp *app);
void wr_panel_dialogs(WrApp *app);
void wr_dialog_help(WrApp *app);
void wr_dialog_export(WrApp *app);
void wr_dialog_open(WrApp *app, WrDialog dialog);
/* The buttons at the end of a dialog: 1 done, -1 cancelled (also by Escape), 0 neither. */
int wr_dialog_buttons(WrApp *app, const char *done, bool enabled);

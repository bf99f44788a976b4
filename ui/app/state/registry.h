/* registry.h - lists of the window's tools, actions, dialogs, tabs and components, assembled only in app/registry_list.c.
   Lower modules access higher ones only through these lists, so a new component is one file and one row. */
#pragma once
#include "ui/app/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

/* Actions generated from another table, with a common prefix: "adjust_NAME", "generate_FAMILY". Runs the action;
   false: not in this family. */
typedef bool WrActionFamily(WrApp *app, const char *name);

/* A dialog, drawn while it is open. */
typedef struct WrDialogRow {
    void (*draw)(WrApp *app);
    /* effect visible on canvas and patch, which may be panned and turned meanwhile */
    bool shows_effect;
    const char *
        action; /* opens it; the search then finds its rows. NULL: it needs a situation of its own */
} WrDialogRow;

/* A tab of the side panel. One of draw and fill draws it. */
typedef struct WrTab {
    const char *label;
    void (*draw)(WrApp *app);
    void (*fill)(WrApp *app, SDL_Rect room); /* uses areas of its own */
    void (*second)(WrApp *app);              /* more sections, beside the others in a wide panel */
    bool is_long;                            /* needs many rows */
    /* all of it changes the document: disabled while a command runs in the background */
    bool edits;
    bool below; /* in the lower part of the panel */
    /* its rows are not listed for the search: they are the document's, or come from a table that is searched itself */
    bool unlisted;
    /* of tabs with fill: an area of theirs, and the function that draws its rows, which can be pinned */
    const char *rows_area;
    void (*rows)(WrApp *app);
} WrTab;

/* A component with background work. Each function may be NULL. */
typedef struct WrPart {
    void (*update)(WrApp *app); /* once before each frame, in the order of the list */
    /* after the frame: starts work that it should not share processors with */
    void (*after)(WrApp *app);
    /* clock at which update must run next; 0: only after events */
    double (*next_time)(const WrApp *app);
    bool (*works)(WrApp *app); /* true while it computes: its progress bar moves */
    /* Handle an event while a command runs in the background: true if it only changed the component's view. A
       resulting view command is run afterwards. */
    bool (*view_event)(WrApp *app, const SDL_Event *event);
    void (*draw)(WrApp *app);    /* draw its view, below all widgets */
    void (*let_go)(WrApp *app);  /* end a drag, keeping its result */
    void (*settle)(WrApp *app);  /* run delayed changes as a command now */
    void (*another)(WrApp *app); /* reset data of the previous document */
    void (*forget)(WrApp *app);  /* drop textures, which were lost */
} WrPart;

/* Handler of a chosen file, one for each purpose. */
typedef void WrFileTake(WrApp *app, const char *path);

struct WrRegistry {
    const WrTool *const *tools;
    int tool_count;
    const WrAction *actions;         /* the last row has name NULL */
    const char *const *helps;        /* one line of help for each action */
    WrActionFamily *const *families; /* NULL-terminated */
    const WrDialogRow *dialogs;      /* [WR_DIALOG_COUNT]; the first is empty */
    const WrTab *tabs;
    int tab_count;
    const WrPart *const *parts; /* NULL-terminated */
    WrFileTake *const *takes;   /* [WR_FILE_PURPOSES] */
    void (*step)(WrApp *app);   /* one iteration of the main loop: events, due work, a frame */
};

/* Index of a tab for settings.tab; 0 if there is none of that label. */
int wr_tab_find(const WrApp *app, const char *label);
/* Show that tab. */
void wr_tab_show(WrApp *app, const char *label);
/* End all drags in all components, keeping their results. */
void wr_input_router_let_go(WrApp *app);
/* End all drags, and run delayed changes as commands now, such as a wheel zoom. */
void wr_app_settle(WrApp *app);

/* roster.h - what the window is made of: its tools, actions, dialogs, tabs and parts, in lists that app/roster_list.c
   alone assembles. What lies below knows what lies above by these lists only, so that a new part is a file of its own
   and one row. */
#pragma once
#include "ui/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

/* Actions that come from another table, by names that begin alike: "adjust_NAME", "generate_FAMILY". Runs it;
   false: it is none of these. */
typedef bool WrActionFamily(WrApp *app, const char *name);

/* A dialog, drawn while it is open. */
typedef struct WrDialogRow {
    void (*draw)(WrApp *app);
    bool shows_effect; /* on canvas and patch: they may be looked at meanwhile */
} WrDialogRow;

/* A tab of the panel on the right. One of the two draws it. */
typedef struct WrTab {
    const char *label;
    void (*draw)(WrApp *app);
    void (*fill)(WrApp *app, SDL_Rect room); /* has areas of its own */
    bool is_long;                            /* it needs many rows */
    bool edits; /* all of it changes the document: grey while something runs beside the window */
} WrTab;

/* A part of the window that has a life of its own. Each function may be NULL. */
typedef struct WrPart {
    void (*update)(WrApp *app);            /* once before each picture, in the order of the list */
    double (*next_time)(const WrApp *app); /* clock at which update must run; 0: only on events */
    bool (*works)(WrApp *app);             /* something is computed: its bar moves */
    /* An event while a command runs beside the window: true if it was only for looking at its view. What comes of that
       becomes a command afterwards. */
    bool (*look)(WrApp *app, const SDL_Event *event);
    void (*draw)(WrApp *app);    /* its view, below all widgets */
    void (*let_go)(WrApp *app);  /* end what is held, keeping what was done */
    void (*settle)(WrApp *app);  /* what was put off becomes a command now */
    void (*another)(WrApp *app); /* the document is another one: forget what was the old one's */
    void (*forget)(WrApp *app);  /* textures were lost */
} WrPart;

/* A file was chosen, for what a purpose says. */
typedef void WrFileTake(WrApp *app, const char *path);

struct WrRoster {
    const WrTool *const *tools;
    int tool_count;
    const WrAction *actions;         /* ends with name NULL */
    const char *const *helps;        /* of each action what it does, in a line */
    WrActionFamily *const *families; /* ends with NULL */
    const WrDialogRow *dialogs;      /* [WR_DIALOG_COUNT]; the first is none */
    const WrTab *tabs;
    int tab_count;
    const WrPart *const *parts; /* ends with NULL */
    WrFileTake *const *takes;   /* [WR_FILE_PURPOSES] */
    void (*step)(WrApp *app);   /* one turn of the loop: events, work that is due, a picture */
};

/* Its index, for settings.tab; 0 if there is none of that label. */
int wr_tab_find(const WrApp *app, const char *label);
/* Show it. */
void wr_tab_show(WrApp *app, const char *label);
/* All parts let go: what is held is ended, keeping what was done. */
void wr_hand_let_go(WrApp *app);
/* The same, and what was put off becomes a command now: a zoom by the wheel. */
void wr_app_settle(WrApp *app);

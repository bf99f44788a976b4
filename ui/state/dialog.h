/* dialog.h - dialogs: which is open, and what most of them end with. What each shows is a row of the roster. */
#pragma once
#include "ui/state/app_state.h"

#include <SDL.h>
#include <stdbool.h>

typedef enum WrDialog {
    WR_DIALOG_NONE,
    WR_DIALOG_UNSAVED,
    WR_DIALOG_NEW,
    WR_DIALOG_TABLE,
    WR_DIALOG_FILL,
    WR_DIALOG_GRID,
    WR_DIALOG_IMPORT,
    WR_DIALOG_EXPORT,
    WR_DIALOG_SHEET, /* a set of maps */
    WR_DIALOG_RENDER,
    WR_DIALOG_FILM,
    WR_DIALOG_FILE,
    WR_DIALOG_ADJUST,
    WR_DIALOG_SELECT,
    WR_DIALOG_SEARCH,
    WR_DIALOG_PREFERENCES,
    WR_DIALOG_RECOVER,
    WR_DIALOG_PRESET,   /* the name of a preset to be saved */
    WR_DIALOG_DYNAMICS, /* curves of the brush */
    WR_DIALOG_REPLACE,  /* a file that stands where one is to be written */
    WR_DIALOG_TABLET,
    WR_DIALOG_CASES,
    WR_DIALOG_HELP,
    WR_DIALOG_ABOUT,
    WR_DIALOG_COUNT
} WrDialog;

/* Which one is open. */
typedef struct WrDialogHand {
    WrDialog now;
    bool fresh; /* in its first frame */
} WrDialogHand;

void wr_panel_dialogs(WrApp *app);
void wr_dialog_close(WrApp *app);
/* Where a dialog stands whose effect the views show. */
SDL_Rect wr_dialog_side(const WrApp *app);
void wr_dialog_open(WrApp *app, WrDialog dialog);
/* The buttons at the end of a dialog: 1 done, -1 cancelled (also by Escape), 0 neither. */
int wr_dialog_buttons(WrApp *app, const char *done, bool enabled);
/* "Needs 300 MB", where that is worth a word, and how much of a trial of it is left; else "". */
#define WR_EXPECTATION 96
void wr_expectation(const WrApp *app, const char *line, char text[WR_EXPECTATION]);
/* The same after a dialog's buttons: beside them, or below where there is no room; so they stay where they are. */
void wr_panel_estimate(const WrApp *app, const char *line);

/* dialog.h - the open dialog, and helpers shared by most dialogs. Each dialog's content is a row of the registry. */
#pragma once
#include "ui/app/state/app_state.h"

#include "base/progress.h"

#include <SDL.h>
#include <stdbool.h>

typedef enum WrDialog {
    WR_DIALOG_NONE,
    WR_DIALOG_UNSAVED,
    WR_DIALOG_NEW,
    WR_DIALOG_STARTERS,
    WR_DIALOG_TABLE,
    WR_DIALOG_FILL,
    WR_DIALOG_GRID,
    WR_DIALOG_IMPORT,
    WR_DIALOG_EXPORT,
    WR_DIALOG_SHEET, /* export sheet: a set of maps */
    WR_DIALOG_RENDER,
    WR_DIALOG_FILM,
    WR_DIALOG_FILE,
    WR_DIALOG_ADJUST,
    WR_DIALOG_SELECT,
    WR_DIALOG_SEARCH,
    WR_DIALOG_PREFERENCES,
    WR_DIALOG_RECOVER,
    WR_DIALOG_PRESET,    /* name of a preset to save */
    WR_DIALOG_DYNAMICS,  /* curve editor of the brush */
    WR_DIALOG_REPLACE,   /* question before an existing file is overwritten */
    WR_DIALOG_RASTERIZE, /* question before a generator layer is painted on */
    WR_DIALOG_MASK,      /* terms of a live mask */
    WR_DIALOG_LINK,      /* values of a linked copy */
    WR_DIALOG_VARIANT,   /* name of a variant */
    WR_DIALOG_STEP,      /* other values of a step of the history */
    WR_DIALOG_MACRO,     /* values of a macro */
    WR_DIALOG_TABLET,
    WR_DIALOG_BAKE, /* maps of a detailed mesh */
    WR_DIALOG_CASES,
    WR_DIALOG_DROP,    /* use of dropped pictures */
    WR_DIALOG_WELCOME, /* at the first start */
    WR_DIALOG_TOUR,
    WR_DIALOG_HELP,
    WR_DIALOG_ABOUT,
    WR_DIALOG_COUNT
} WrDialog;

/* The open dialog. */
typedef struct WrDialogState {
    WrDialog now;
    bool fresh; /* first frame */
    int stop;   /* of the tour, from 0 */
    WrTimeLeft preview_left;
} WrDialogState;

void wr_panel_dialogs(WrApp *app);
void wr_dialog_close(WrApp *app);
/* Area of a dialog whose effect is visible in the views. */
SDL_Rect wr_dialog_side(const WrApp *app);
void wr_dialog_open(WrApp *app, WrDialog dialog);
/* The buttons at the end of a dialog: 1 confirmed, -1 cancelled (also by Escape), 0 neither. */
int wr_dialog_buttons(WrApp *app, const char *done, bool enabled);
/* The button of a dialog whose changes are made at once; it, Enter and Escape close the dialog. */
void wr_dialog_close_button(WrApp *app, const char *word);
/* wr_time_left as text in the user's language, "0:07 left"; "" for NAN. */
#define WR_TIME_LEFT 24
void wr_time_left_words(WrTimeLeft *task, double fraction, double seconds, char text[WR_TIME_LEFT]);
/* Memory and time note, "Needs 300 MB" and the remaining time of a preview, if significant; else "". */
#define WR_EXPECTATION 96
void wr_expectation(const WrApp *app, const char *line, char text[WR_EXPECTATION]);
/* Show that note beside a dialog's buttons; without room its end is in the tip, so that no row is added. */
void wr_panel_estimate(const WrApp *app, const char *line);

/* panel_history.h - state of the History tab: the step that is changed, and the macro that is run. */
#pragma once
#include "ui/app/state/app_state.h"

#include "base/array.h"
#include "base/error.h"

#include <stdbool.h>

typedef struct WrCall WrCall;

/* A line of a macro: as in its file, and as changed. */
typedef struct WrMacroLine {
    WrCall *before, *now; /* owned */
    int number;           /* of the line in the file, from 1 */
} WrMacroLine;

typedef struct WrHistoryState {
    int step;       /* index of the step that is changed */
    WrCall *call;   /* its changed line; owned; NULL: none */
    WrError err;    /* of its preview; "": none */
    bool previewed; /* a preview was requested */
    int clicked_at; /* position before the last click on a row */
    int menu;       /* index of the step whose menu is open; -1: none */
    bool menu_opens;
    int dragged, drop; /* a dragged step, and the index that it would get; dragged -1: none */

    char *macro; /* path; owned */
    WR_ARRAY(WrMacroLine) lines;
} WrHistoryState;

void wr_panel_history(WrApp *app);
void wr_history_panel_free(WrApp *app);

/* ---- panel_step.c ---- */

/* Opens the dialog that changes that step. */
void wr_step_edit(WrApp *app, int step);
void wr_dialog_step(WrApp *app);
/* Saves the steps from this one to the present as a macro: the file dialog. */
void wr_macro_save(WrApp *app, int step);
void wr_macro_save_chosen(WrApp *app, const char *path);
/* The file dialog of a macro, and the dialog of its values. */
void wr_macro_open(WrApp *app);
void wr_macro_chosen(WrApp *app, const char *path);
void wr_dialog_macro(WrApp *app);

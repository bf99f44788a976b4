/* panel_search.h - state of the search for actions. */
#pragma once
#include "ui/app/state/app_state.h"

typedef struct WrFinder { /* the search */
    char text[600];
    /* a command was just chosen: the field contains its verb and needs the keyboard focus */
    bool fill;
    bool line; /* the text is a command line, not a search */
    int chosen;
    bool empty; /* Return in an empty field: restore the keyboard focus */
} WrFinder;

void wr_dialog_search(WrApp *app);
/* Opens the search with a command line, to be changed and run. */
void wr_search_line(WrApp *app, const char *line);

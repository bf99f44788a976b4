/* panel_search.h - finding an action by typing. */
#pragma once
#include "ui/state/app_state.h"

typedef struct WrFinder { /* the search for actions */
    char text[600];
    bool fill; /* a command was just chosen: the field holds its verb, and wants the keys again */
    bool line; /* what is typed is a command's line, not words of actions */
    int chosen;
    bool empty; /* Enter came with nothing typed: the field is to have the keys again */
} WrFinder;

void wr_dialog_search(WrApp *app);

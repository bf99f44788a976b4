/* panel_search.h - finding an action by typing. */
#pragma once
#include "ui/desk/desk.h"

typedef struct WrFinder { /* the search for actions */
    char text[80];
    int chosen;
    bool empty; /* Enter came with nothing typed: the field is to have the keys again */
} WrFinder;

void wr_dialog_search(WrApp *app);

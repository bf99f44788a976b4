/* action.h - what can be done by name: menus, keys, buttons and the search go by it. The rows are the roster's. */
#pragma once
#include "ui/state/app_state.h"

#include <stdbool.h>

struct WrAction {
    const char *name;  /* as in the key file */
    const char *label; /* as in menus; "..." when it asks first */
    void (*run)(WrApp *app);
    bool (*enabled)(const WrApp *app); /* NULL: always */
    bool (*checked)(const WrApp *app); /* NULL: never */
    bool edits; /* the document, or a file of it: not while something runs beside the window */
};

const WrAction *wr_action_find(const WrApp *app, const char *name); /* NULL: none, or of a family */
/* What it does, in a line. */
const char *wr_action_help(const WrApp *app, const WrAction *action);
bool wr_action_can(const WrApp *app, const WrAction *action); /* at present */
/* At once, or after the picture of the window that is being made. */
void wr_action_run(WrApp *app, const char *name);

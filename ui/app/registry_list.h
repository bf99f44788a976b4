/* registry_list.h - the complete registry and the table of actions. */
#pragma once
#include "ui/app/state/action.h"
#include "ui/app/state/registry.h"

extern const WrRegistry wr_registry;
extern const WrAction wr_actions[]; /* the last row has name NULL */
/* WR_ACTION_COUNT entries, in the order of WR_ACTIONS */
extern const char *const wr_action_helps[];

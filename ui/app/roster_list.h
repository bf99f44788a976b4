/* roster_list.h - the roster of all that there is, and the actions in it. */
#pragma once
#include "ui/state/action.h"
#include "ui/state/roster.h"

extern const WrRoster wr_roster;
extern const WrAction wr_actions[];         /* ends with name NULL */
extern const char *const wr_action_helps[]; /* WR_ACTION_COUNT, in the order of WR_ACTIONS */

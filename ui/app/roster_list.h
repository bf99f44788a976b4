/* roster_list.h - the complete roster and the table of actions. */
#pragma once
#include "ui/state/action.h"
#include "ui/state/roster.h"

extern const WrRoster wr_roster;
extern const WrAction wr_actions[]; /* the last row has name NULL */
/* WR_ACTION_COUNT entries, in the order of WR_ACTIONS */
extern const char *const wr_action_helps[];

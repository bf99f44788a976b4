/* roster_list.h - the complete roster and the table of actions. */
#pragma once
#include "ui/state/action.h"
#include "ui/state/roster.h"
#include "ui/tools/tool.h"

extern const WrRoster wr_roster;
extern const WrAction wr_actions[]; /* the last row has name NULL */
/* WR_ACTION_COUNT entries, in the order of WR_ACTIONS */
extern const char *const wr_action_helps[];

/* ---- list of all tools, in the order of the tool strip ---- */

/* All tools; NULL-terminated. */
extern const WrTool *const wr_tools[];
#define WR_TOOL_COUNT 19

/* tool_list.h - list of all tools, in the order of the tool strip. */
#pragma once
#include "ui/tools/tool.h"

/* All tools; NULL-terminated. */
extern const WrTool *const wr_tools[];
#define WR_TOOL_COUNT 19

/* tool_list.h - all tools, in the order of the strip. */
#pragma once
#include "ui/tools/tool.h"

/* All of them, in the order of the strip. */
extern const WrTool *const wr_tools[];
#define WR_TOOL_COUNT 19

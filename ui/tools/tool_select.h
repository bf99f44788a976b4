/* tool_select.h - selection being drawn. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/registry.h"

void wr_select_cancel(WrApp *app);

extern const WrPart wr_part_select;

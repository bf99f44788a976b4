/* tool_select.h - selection being drawn. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

void wr_select_cancel(WrApp *app);

extern const WrPart wr_part_select;

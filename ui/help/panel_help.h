/* panel_help.h - the dialog of the guide, and what this program is. */
#pragma once
#include "ui/state/app_state.h"

void wr_dialog_help(WrApp *app);

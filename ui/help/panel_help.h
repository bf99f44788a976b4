/* panel_help.h - dialogs of the guide and of information about the program. */
#pragma once
#include "ui/state/app_state.h"

void wr_dialog_help(WrApp *app);

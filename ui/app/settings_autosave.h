/* settings_autosave.h - loading of settings at the start and saving after changes. */
#pragma once
#include "ui/app/state/app_state.h"

void wr_settings_begin(WrApp *app); /* loads them */
/* Save them if changed, between drags and at most once per second; and the clock of the next save, 0: none. */
void wr_settings_autosave(WrApp *app);
double wr_settings_next_autosave(const WrApp *app);
void wr_settings_end(WrApp *app); /* saves them at once */

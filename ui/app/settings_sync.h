/* settings_sync.h - settings are read at the start and written when they change. */
#pragma once
#include "ui/state/app_state.h"

void wr_settings_begin(WrApp *app); /* reads them */
/* Writes them if they changed, between gestures and once a second at most; and when that is due, 0: never. */
void wr_settings_tend(WrApp *app);
double wr_settings_next_time(const WrApp *app);
void wr_settings_end(WrApp *app); /* writes them at once */

/* app_store.h - where the window's state lies. */
#pragma once
#include "ui/state/app_state.h"

/* All zero but for the roster, each subject in its place. wr_free frees it whole. */
WrApp *wr_store_new(void);

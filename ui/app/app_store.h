/* app_store.h - allocation of the window's state. */
#pragma once
#include "ui/state/app_state.h"

/* State with all members zero except the roster and the pointers to each component. wr_free frees it as a whole. */
WrApp *wr_store_new(void);

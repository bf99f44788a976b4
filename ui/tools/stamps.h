/* stamps.h - pictures for stamping, in the brush folders of the program, the user and GIMP. */
#pragma once
#include "ui/state/app_state.h"

/* Scan the folders at the first call; the paths are in stamp.stamps. */
void wr_stamps_find(WrApp *app);
void wr_stamp_picker(WrApp *app); /* a picture in the option row that opens the list */
void wr_stamps_free(WrApp *app);

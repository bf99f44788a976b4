/* stamps.h - pictures to stamp with, in the folders of brushes: ours, the user's and GIMP's. */
#pragma once
#include "ui/state/app_state.h"

/* Looks through them at the first call; the paths are stamp.stamps. */
void wr_stamps_find(WrApp *app);
void wr_stamp_picker(WrApp *app); /* a picture in the option row that opens all of them */
void wr_stamps_free(WrApp *app);

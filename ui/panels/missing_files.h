/* missing_files.h - files of generator layers that are missing on this machine, and the choice of another place. */
#pragma once
#include "ui/app/state/app_state.h"

/* The path of the first missing file of layer `index`; NULL: none. Looked up again after each change of the document.
   Valid until the next call. */
const char *wr_missing_file(WrApp *app, int index);
/* Open the file dialog for it. */
void wr_missing_file_locate(WrApp *app, int index);
/* The file chosen there: all layers with the same missing file get it. */
void wr_missing_file_chosen(WrApp *app, const char *path);
void wr_missing_files_free(WrApp *app);

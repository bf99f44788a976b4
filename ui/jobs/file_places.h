/* file_places.h - shortcut folders and name filters of the file dialog. Tested without a window. */
#pragma once
#include "ui/jobs/files.h"

#include <stdbool.h>

typedef struct WrFilePlace {
    char *label, *path; /* owned */
    bool named;         /* the label is translatable, not a folder name */
} WrFilePlace;
#define WR_FILE_PLACES 9

/* The home folder, the folders of documents, pictures and downloads if they exist, and the folders of the paths in
 * `recent` (NULL-terminated), each once. Returns their number; the caller frees them (wr_file_places_free). */
int wr_file_places(const char *home, char *const recent[], WrFilePlace places[WR_FILE_PLACES]);
void wr_file_places_free(WrFilePlace places[], int count);

/* True if a file of that extension may be read for the purpose. All names fit if any file is allowed, or if the file
 * will be written. */
bool wr_file_fits(WrFilePurpose purpose, const char *name);
/* The allowed extensions, NULL-terminated; NULL: any. */
const char *const *wr_file_endings(WrFilePurpose purpose);

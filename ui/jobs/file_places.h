/* file_places.h - where a file may lie, and which can be opened. Tested without a window. */
#pragma once
#include "ui/jobs/files.h"

#include <stdbool.h>

typedef struct WrFilePlace {
    char *label, *path; /* owned */
    bool named;         /* its label is a word of the window, not the folder's name */
} WrFilePlace;
#define WR_FILE_PLACES 9

/* The home folder, those of documents, pictures and downloads if they are there, and folders of the paths in `recent`
 * (NULL ends it), each once. Returns how many; they are the caller's (wr_file_places_free). */
int wr_file_places(const char *home, char *const recent[], WrFilePlace places[WR_FILE_PLACES]);
void wr_file_places_free(WrFilePlace places[], int count);

/* Is it, by its name's ending, one that may be read for that? All are where it may be anything, and of files to be
 * written. */
bool wr_file_fits(WrFilePurpose purpose, const char *name);
/* The endings that it goes by, NULL ends them; NULL: any. */
const char *const *wr_file_endings(WrFilePurpose purpose);

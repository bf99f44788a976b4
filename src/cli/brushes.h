/* brushes.h - shared list of library presets for `wrinkle brushes`. Private to src/cli. */
#pragma once
#include "brush/library.h"
#include "cli/cli.h"

#include <stdbool.h>

typedef struct WrBrushList {
    WrLibrary *library;          /* owned */
    const WrPresetEntry **entry; /* [count], borrowed from the library; the array is owned */
    int count;
} WrBrushList;

/* File name of an entry's thumbnail in MyPaint's form: its name with '/' as '-', and "_prev.png". */
void wr_brushes_thumbnail_name(const WrPresetEntry *entry, WrText *name);

/* Write one picture of all entries with their names, by collection and group; PNG, or the format of the extension. */
bool wr_brushes_sheet(const WrCli *cli, const WrBrushList *list, const char *path, WrError *err);
/* Write one picture for each entry into an existing folder. */
bool wr_brushes_thumbnails(const WrCli *cli, const WrBrushList *list, const char *folder,
                           WrError *err);

/* Print everything about a preset, as lines or as one JSON object and a line end. */
void wr_brushes_report(const WrPresetEntry *entry, const WrPreset *preset, bool json, WrText *text);

/* brushes.h - what `wrinkle brushes` works on: some presets of the library.
   Layer 7, inside cli. */
#pragma once
#include "brush/library.h"
#include "cli/cli.h"

#include <stdbool.h>

typedef struct WrBrushList {
    WrLibrary *library;          /* owned */
    const WrPresetEntry **entry; /* [count], borrowed from the library; the array is owned */
    int count;
} WrBrushList;

/* The file's name of an entry's thumbnail: its name with '/' as '-', and "_prev.png", as MyPaint's. */
void wr_brushes_thumbnail_name(const WrPresetEntry *entry, WrText *name);

/* One picture of all, by collection and group, each with its name; PNG or what the ending says. */
bool wr_brushes_sheet(const WrCli *cli, const WrBrushList *list, const char *path, WrError *err);
/* One picture each into a folder, which must exist. */
bool wr_brushes_thumbnails(const WrCli *cli, const WrBrushList *list, const char *folder,
                           WrError *err);

/* Everything that `wrinkle brushes NAME` says, as lines or as one JSON object and a new line. */
void wr_brushes_tell(const WrPresetEntry *entry, const WrPreset *preset, bool json, WrText *text);

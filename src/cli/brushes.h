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

/* Write one picture of all entries with their names, by collection and group; PNG, or the format of the extension. */


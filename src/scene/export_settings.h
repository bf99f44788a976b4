/* export_settings.h - last settings of the export dialog: maps, target program, destination. Stored
   with the document; this module writes no files. */
#pragma once
#include <stdbool.h>

typedef enum WrSheetDepth {
    WR_SHEET_AS_SET,
    WR_SHEET_8,
    WR_SHEET_16,
    WR_SHEET_FLOAT,
    WR_SHEET_DEPTHS
} WrSheetDepth;
typedef enum WrSheetSize {
    WR_SHEET_TABLE,
    WR_SHEET_HALF,
    WR_SHEET_QUARTER,
    WR_SHEET_POWER,
    WR_SHEET_SIZES
} WrSheetSize;
typedef enum WrSheetRange {
    WR_SHEET_RANGE_SET,
    WR_SHEET_RANGE_AUTO,
    WR_SHEET_RANGE_UNIT,
    WR_SHEET_RANGE_SIGNED,
    WR_SHEET_RANGES
} WrSheetRange;

#define WR_SHEET_WORD 48
#define WR_SHEET_FOLDER 1024
#define WR_SHEET_NAME 128

typedef struct WrSheetRequest {
    char as[WR_SHEET_WORD]; /* a set, or a kind of map; "": not set yet */
    char folder[WR_SHEET_FOLDER], name[WR_SHEET_NAME]; /* "": the document's */
    int depth, size, range;                            /* WrSheetDepth, WrSheetSize, WrSheetRange */
} WrSheetRequest;

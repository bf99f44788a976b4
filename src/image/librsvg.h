/* librsvg.h - interface of the module that contains librsvg (wrinkle_librsvg.so).

   The module exports one symbol, wr_librsvg_table; all calls use it.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_LIBRSVG_VERSION 1
#define WR_LIBRSVG_REASON 320
#define WR_LIBRSVG_SYMBOL "wr_librsvg_table"

typedef struct WrLibrsvgDrawing WrLibrsvgDrawing;

typedef struct WrLibrsvgTable {
    int version; /* WR_LIBRSVG_VERSION */
    /* Reads a file in memory and no other file. Elements that need fonts are left out. On failure NULL
       and one line in reason[WR_LIBRSVG_REASON]. */
    WrLibrsvgDrawing *(*open)(const void *bytes, size_t length, char *reason);
    /* The box of everything drawn, or the page: left, top, width, height in pixels of the file. */
    bool (*box)(const WrLibrsvgDrawing *drawing, bool page, double box[4], char *reason);
    /* Draws the box at `scale` pixels per pixel of the file, its corner at (1, 1). pixels: [height][width]
       32-bit ARGB, premultiplied; set to 0 by the caller. */
    bool (*draw)(const WrLibrsvgDrawing *drawing, const double box[4], double scale, int width,
                 int height, uint32_t *pixels, char *reason);
    void (*close)(WrLibrsvgDrawing *drawing);
} WrLibrsvgTable;

/* svg.h - coverage of a vector drawing (SVG), rasterized at any size.

   Drawings are untrusted, so they are read in the reader process (reader_protocol.h), which opens no
   other file. Text is left out, since it would need font files. */
#pragma once
#include "base/enum_rows.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_SVG_FILE_MAX ((size_t)64 << 20) /* bytes */
#define WR_SVG_SIDE_MAX 8192               /* pixels of the longest side */

/* The parts that count: everything drawn, or its darkness or lightness. */
#define WR_SVG_TAKES(X) X(WR_SVG_ALL, "all") X(WR_SVG_DARK, "dark") X(WR_SVG_LIGHT, "light")
typedef enum WrSvgTake { WR_SVG_TAKES(WR_WORD_ID) WR_SVG_TAKE_COUNT } WrSvgTake;

typedef struct WrSvgRequest {
    int32_t side; /* pixels of the box's longest side, 1..WR_SVG_SIDE_MAX */
    int32_t page; /* 1: the box is the page; 0: that of everything drawn */
    int32_t take; /* WrSvgTake */
} WrSvgRequest;

/* A raster of coverage, with a margin of one empty pixel on each side. Zeroed is empty; fini frees. */
typedef struct WrSvg {
    int width, height;    /* with the margin */
    double box[2];        /* width and height of the box in these pixels */
    bool text;            /* the file has text, which is not drawn */
    const uint8_t *cover; /* [height][width] 0..255 */
    char *block;          /* owned: memory of `cover` */
} WrSvg;

/* Reads a file.
 *
 * Errors   name the file: unreadable, no SVG, damaged or hostile, nothing drawn
 * Threads  any number at once */
bool wr_svg_read(const char *path, const WrSvgRequest *ask, WrSvg *out, WrError *err);
/* wr_svg_read for bytes in memory; `name` is for messages. */
bool wr_svg_read_bytes(const char *name, const void *bytes, size_t length, const WrSvgRequest *ask,
                       WrSvg *out, WrError *err);
void wr_svg_fini(WrSvg *svg);

/* ---- recognition; nothing is decoded ---- */

bool wr_svg_named(const char *path); /* the file's name ends in .svg or .svgz */
/* The text begins like an SVG file. */
bool wr_svg_is_text(const char *text);
/* The d= of an SVG text that draws one filled path and nothing else, unchanged by any other attribute, or of a
 * text that is such path data itself. The caller frees it (wr_free); NULL: it draws more. */
char *wr_svg_one_path(const char *text);
/* Length of the longest beginning that consists of letters of path data. */
size_t wr_svg_path_span(const char *text);

/* ---- in the process that reads the file ---- */

/* Header of a serialised raster; its rows follow. */
typedef struct WrSvgHead {
    int32_t width, height, text, unused;
    double box[2];
} WrSvgHead;

/* Loads the module that contains the library; it stays loaded. */
bool wr_svg_load(WrError *err);
/* Rasterizes a file in memory; appends the serialised raster to the block. memory: set to true if the
 * failure was lack of memory. Errors: one sentence that does not name the file */
bool wr_svg_make(const void *bytes, size_t length, const WrSvgRequest *ask, WrText *block,
                 bool *memory, WrError *err);

/* oiio.h - the border to the module that holds OpenImageIO (wrinkle_oiio.so). The module exports one
   symbol, wr_oiio_table; everything goes through it, and no exception crosses it.
   Private to this room. C and C++.

   Every function that can fail writes one line into reason[WR_OIIO_REASON] and returns false or NULL.
   The callers have checked the file's existence and kind; these functions check what the file says of
   itself before anything is allocated for it. */
#pragma once
#include "image/image.h"

#include <stdbool.h>
#include <string.h>

#define WR_OIIO_VERSION 4
#define WR_OIIO_REASON 320
#define WR_OIIO_SYMBOL "wr_oiio_table"
#define WR_OIIO_NO_MEMORY "not enough memory" /* a reason that callers look for */

typedef struct WrOiioReader WrOiioReader;
typedef struct WrOiioWriter WrOiioWriter;

/* What a part of an open file holds. Strings are valid until the reader is closed. */
typedef struct WrOiioPart {
    WrImagePart part;
    double divisor; /* integer codes / divisor = value; 0 for floats */
} WrOiioPart;

typedef struct WrOiioTable {
    int version; /* WR_OIIO_VERSION */

    /* fd: open for reading; borrowed until close. format: OpenImageIO's name or an ending. most: count parts
       up to this many; more is an error. */
    WrOiioReader *(*open)(int fd, const char *format, int most, char *reason);
    void (*close)(WrOiioReader *reader);
    int (*parts)(const WrOiioReader *reader);
    const WrOiioPart *(*part)(const WrOiioReader *reader, int part);
    /* Text of an attribute or NULL. */
    const char *(*attribute)(const WrOiioReader *reader, int part, const char *name);
    /* Rows [y, y + rows) and the first `channels` channels, values as WrImage has them, interleaved. */
    bool (*read)(WrOiioReader *reader, int part, int y, int rows, int channels, float *out,
                 char *reason);

    /* file: open for writing, empty, the caller's; where wr_oiio_by_name, the library opens it again and not
       all failures are told. */
    WrOiioWriter *(*create)(int file, const char *format, const WrImageOut *parts, int count,
                            char *reason);
    /* Rows of the present part, downwards. */
    bool (*write)(WrOiioWriter *writer, int y, int rows, const void *pixels, char *reason);
    /* Go on with the next part. */
    bool (*next)(WrOiioWriter *writer, char *reason);
    /* Closes and releases the writer whatever happens; false if the file is not whole. keep is false when
       the file is given up. */
    bool (*finish)(WrOiioWriter *writer, bool keep, char *reason);
} WrOiioTable;

/* Whether the library does not write such a file through what we hand it, but opens it itself: EXR of several
   parts, and TIFF, which reads back what it wrote. */
static inline bool wr_oiio_by_name(const char *format, int count)
{
    return count > 1 || strcmp(format, "tiff") == 0;
}

/* The table, loaded on first use by any thread; NULL and an error that says where it was looked for. */
const WrOiioTable *wr_oiio(WrError *err);
/* Begin to load it and return at once. */
void wr_oiio_warm(void);

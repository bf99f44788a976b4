/* oiio.h - the border to the module that holds OpenImageIO (wrinkle_oiio.so). The module exports one
   symbol, wr_oiio_table; everything goes through it.
   Private to this module. C and C++. */
#pragma once
#include "image/codec.h"

#include <stdbool.h>
#include <string.h>

#define WR_OIIO_VERSION 7
#define WR_OIIO_SYMBOL "wr_oiio_table"

/* Whether the library does not write such a file through what we hand it, but opens it itself: EXR of several
   parts, and TIFF, which reads back what it wrote (the library's own reading of what we hand it gives nothing). */
static inline bool wr_oiio_by_name(const char *format, const WrImageOut *parts, int count)
{
    return (count > 1 && !parts[0].levels) || strcmp(format, "tiff") == 0;
}

/* The table, loaded on first use by any thread; NULL and an error that says where it was looked for. */
const WrCodec *wr_oiio(WrError *err);
/* Begin to load it and return at once. */
void wr_oiio_warm(void);

/* oiio.h - interface of the module that contains OpenImageIO (wrinkle_oiio.so).

   The module exports one symbol, wr_oiio_table; all calls use it.
   Private to this module. C and C++. */
#pragma once
#include "image/codec.h"

#include <stdbool.h>
#include <string.h>

#define WR_OIIO_VERSION 8
#define WR_OIIO_SYMBOL "wr_oiio_table"

/* True if the library does not write such a file to a custom sink, but opens it by name: EXR of several
   parts, and TIFF, which reads back its own output (reading through a custom sink does not work). */
static inline bool wr_oiio_by_name(const char *format, const WrImageOut *parts, int count)
{
    return (count > 1 && !parts[0].levels) || strcmp(format, "tiff") == 0;
}

/* The table, loaded on first use by any thread; NULL and an error that lists the searched paths. */
const WrCodec *wr_oiio(WrError *err);
/* Starts loading it and returns at once. */
void wr_oiio_warm(void);

/* exr.h - OpenEXR files of plain float parts, such as the program's documents, by OpenEXR's C library and
   libdeflate.
   Private to this module.

   All other OpenEXR files go to OpenImageIO, which loads some 260 libraries. Pixels are compressed by "zip", as before:
   every OpenEXR program reads them. */
#pragma once
#include "image/codec.h"

#include <stdbool.h>

/* The codec; view and view_apply are NULL. Its open returns NULL with an empty reason for a file that OpenImageIO must
   read: not written by this program, tiled, deep, not all floats, of another compression, a damaged header. Then the
   descriptor's position is unchanged. */
extern const WrCodec wr_exr_codec;

/* True if the codec writes such parts: documents. */
bool wr_exr_writes(const char *format, const WrImageOut *parts, int count);

/* codec.h - what reads and writes picture files of one or more formats: OpenImageIO, which is a module (oiio.h), and
   libpng, which is there at once (png_codec.h). No exception crosses this border.
   Private to this module. C and C++.

   Every function that can fail writes one line into reason[WR_CODEC_REASON] and returns false or NULL.
   The callers have checked the file's existence and kind; these functions check what the file says of
   itself before anything is allocated for it. */
#pragma once
#include "base/sink.h"
#include "image/image.h"

#include <stdbool.h>

#define WR_CODEC_REASON 320
#define WR_CODEC_NO_MEMORY "not enough memory" /* a reason that callers look for */

#define WR_CODEC_LEVELS (-1)

typedef struct WrCodecReader WrCodecReader;
typedef struct WrCodecWriter WrCodecWriter;

/* What a part of an open file holds. Strings are valid until the reader is closed. */
typedef struct WrCodecPart {
    WrImagePart part;
    double divisor; /* integer codes / divisor = value; 0 for floats */
} WrCodecPart;

typedef struct WrCodec {
    int version; /* of a module (WR_OIIO_VERSION) */

    /* fd: open for reading; borrowed until close. format: OpenImageIO's name or an ending. most: count parts
       up to this many; more is an error; WR_CODEC_LEVELS: the first part's levels stand in their place. numbers: integers
       that are measurements (WrImageWish.elevation) are read as their numbers, not as codes. */
    WrCodecReader *(*open)(int fd, const char *format, int most, bool numbers, char *reason);
    void (*close)(WrCodecReader *reader);
    int (*parts)(const WrCodecReader *reader);
    const WrCodecPart *(*part)(const WrCodecReader *reader, int part);
    /* Text of an attribute or NULL. */
    const char *(*attribute)(const WrCodecReader *reader, int part, const char *name);
    /* Rows [y, y + rows) and the first `channels` channels, values as WrImage has them, interleaved. */
    bool (*read)(WrCodecReader *reader, int part, int y, int rows, int channels, float *out,
                 char *reason);

    /* to: empty; outlives the writer. spool: an empty memory file, the caller's, which is written in the sink's place where
       wr_oiio_by_name: the library opens it by its name and does not report all failures; else -1. */
    WrCodecWriter *(*create)(const WrByteSink *to, int spool, const char *format,
                             const WrImageOut *parts, int count, char *reason);
    /* Rows of the present part, downwards. */
    bool (*write)(WrCodecWriter *writer, int y, int rows, const void *pixels, char *reason);
    /* Go on with the next part. */
    bool (*next)(WrCodecWriter *writer, char *reason);
    /* Closes and releases the writer whatever happens; false if the file is not whole. keep is false when
       the file is given up. */
    bool (*finish)(WrCodecWriter *writer, bool keep, char *reason);
} WrCodec;

/* Whether files of a format are read and written by the module that holds OpenImageIO. */
bool wr_codec_takes_module(const char *format);
/* By OpenImageIO's name of the format, or an ending. NULL and an error that says where its module was looked for. */
const WrCodec *wr_codec(const char *format, WrError *err);

/* codec.h - interface of image file libraries: OpenImageIO, which is a module (oiio.h), and libpng
   (png.h).

   No exception crosses this interface.
   Private to this module. C and C++.
   Every function that can fail writes one line into reason[WR_CODEC_REASON] and returns false or NULL.
   Callers have checked the file's existence and kind; these functions check the file's header before
   they allocate memory for it. */
#pragma once
#include "base/spool.h"
#include "image/image.h"

#include <stdbool.h>

#define WR_CODEC_REASON 320
#define WR_CODEC_NO_MEMORY "not enough memory" /* a reason that callers test for */

#define WR_CODEC_LEVELS (-1)

typedef struct WrCodecReader WrCodecReader;
typedef struct WrCodecWriter WrCodecWriter;
typedef struct WrCodecView WrCodecView;

/* A part of an open file. Strings are valid until the reader is closed. */
typedef struct WrCodecPart {
    WrImagePart part;
    double divisor; /* integer codes / divisor = value; 0 for floats */
} WrCodecPart;

typedef struct WrCodec {
    int version; /* of a module (WR_OIIO_VERSION) */

    /* fd: open for reading; borrowed until close. format: OpenImageIO's name or an extension. most:
       maximum number of parts; more is an error. WR_CODEC_LEVELS: the mip levels of the first part are
       the parts. numbers: integers that are measurements (WrImageRequest.elevation) are read as numbers,
       not as codes. */
    WrCodecReader *(*open)(int fd, const char *format, int most, bool numbers, char *reason);
    void (*close)(WrCodecReader *reader);
    int (*parts)(const WrCodecReader *reader);
    const WrCodecPart *(*part)(const WrCodecReader *reader, int part);
    /* Text of an attribute or NULL. */
    const char *(*attribute)(const WrCodecReader *reader, int part, const char *name);
    /* Rows [y, y + rows) and the first `channels` channels, values as WrImage has them, interleaved. */
    bool (*read)(WrCodecReader *reader, int part, int y, int rows, int channels, float *out,
                 char *reason);

    /* to: empty; must outlive the writer. spool: an empty memory file of the caller, written instead of
       the sink if wr_oiio_by_name: the library opens it by its name and does not report all failures;
       else -1. */
    WrCodecWriter *(*create)(const WrByteSink *to, int spool, const char *format,
                             const WrImageOut *parts, int count, char *reason);
    /* Writes rows of the present part, downwards. */
    bool (*write)(WrCodecWriter *writer, int y, int rows, const void *pixels, char *reason);
    /* Starts the next part. */
    bool (*next)(WrCodecWriter *writer, char *reason);
    /* Closes and releases the writer in any case; false if the file is incomplete. keep is false when
       the file is abandoned. */
    bool (*finish)(WrCodecWriter *writer, bool keep, char *reason);

    /* A display transform of a colour configuration (display_view.h), never released; OpenImageIO only. display "":
       the default; space "": the role scene_linear. */
    WrCodecView *(*view)(const char *config, const char *display, const char *view,
                         const char *space, char *reason);
    /* Converts [count][3] in place; any number of threads. */
    void (*view_apply)(const WrCodecView *view, float *rgb, int count);
} WrCodec;

/* True if the module with OpenImageIO reads and writes this format. */
bool wr_codec_takes_module(const char *format);
/* The codec for OpenImageIO's name of a format, or an extension. NULL and an error with the paths where
 * the module was searched. */
const WrCodec *wr_codec(const char *format, WrError *err);

/* png_codec.h - PNG codec based on libpng, which is available at once; loading OpenImageIO takes a
   quarter of a second.

   Results equal those of OpenImageIO: palettes as colours, codes of fewer than 8 bits as 8,
   transparency as alpha, the program's texts from the description.
   Private to this module.
   Source: PNG specification (ISO/IEC 15948). */
#pragma once
#include "image/codec.h"

#include <png.h>

extern const WrCodec wr_png_codec; /* format: "png", one part */

/* Its two halves (png_read.c, png_write.c). */
WrCodecReader *wr_png_open(int fd, const char *format, int most, bool numbers, char *reason);
void wr_png_close(WrCodecReader *reader);
int wr_png_parts(const WrCodecReader *reader);
const WrCodecPart *wr_png_part(const WrCodecReader *reader, int part);
const char *wr_png_attribute(const WrCodecReader *reader, int part, const char *name);
bool wr_png_read(WrCodecReader *reader, int part, int y, int rows, int channels, float *out,
                 char *reason);
WrCodecWriter *wr_png_create(const WrByteSink *to, int spool, const char *format,
                             const WrImageOut *parts, int count, char *reason);
bool wr_png_write(WrCodecWriter *writer, int y, int rows, const void *pixels, char *reason);
bool wr_png_next(WrCodecWriter *writer, char *reason); /* always false: there is one part */
bool wr_png_finish(WrCodecWriter *writer, bool keep, char *reason);

/* Error and memory callbacks of libpng; png_get_error_ptr and png_get_mem_ptr point to this. */
typedef struct WrPngTrouble {
    char why[160];  /* the first error, on one line */
    bool no_memory; /* the error was lack of memory */
} WrPngTrouble;

PNG_NORETURN void wr_png_fail(png_structp png, png_const_charp why);
void wr_png_warn(png_structp png, png_const_charp why); /* ignores warnings */
png_voidp wr_png_alloc(png_structp png, png_alloc_size_t bytes);
void wr_png_free(png_structp png, png_voidp memory);
bool wr_png_swaps(void); /* 16-bit codes have the other byte order in files */
/* Always false; the reason is WR_CODEC_NO_MEMORY, or "before (why)". */
bool wr_png_report(const WrPngTrouble *trouble, const char *before, char *reason);

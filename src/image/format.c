#include "image/format.h"

#include "base/error.h"
#include "base/file.h"
#include "image/image.h"

#include <string.h>

/* Bit 0 of a row's mask: any number of channels; bit k: k channels. */
#define CHANNELS(a, b, c, d) ((a) << 1 | (b) << 2 | (c) << 3 | (d) << 4)

/* Columns: file extensions, library name, label, pixel types that it holds (8, 16 bits, float), remedy for others, channel
   counts, pictures only (values lose precision), exact (reading back returns the written bits). */
static const WrImageFormat formats[] = {
    { { "png" },
      "png",
      "PNG",
      { true, true, false },
      "8 or 16 bits; for floats use EXR or TIFF",
      CHANNELS(1, 1, 1, 1),
      false,
      true },
    { { "exr" },
      "openexr",
      "EXR",
      { false, false, true },
      "32-bit floats; for integers use PNG or TIFF",
      1,
      false,
      true },
    { { "tif", "tiff" },
      "tiff",
      "TIFF",
      { true, true, true },
      "8 or 16 bits or 32-bit floats",
      1,
      false,
      true },
    { { "jpg", "jpeg" },
      "jpeg",
      "JPEG",
      { true, false, false },
      "8 bits; for more use PNG, EXR or TIFF",
      CHANNELS(1, 0, 1, 0),
      false,
      false },
    { { "bmp" },
      "bmp",
      "BMP",
      { true, false, false },
      "8 bits; for more use PNG, EXR or TIFF",
      CHANNELS(1, 0, 1, 1),
      false,
      true },
    { { "tga" },
      "targa",
      "TGA",
      { true, false, false },
      "8 bits; for more use PNG, EXR or TIFF",
      CHANNELS(1, 0, 1, 1),
      false,
      true },
    { { "ppm" },
      "pnm",
      "PPM",
      { true, false, false },
      "8 bits here; for more use PNG, EXR or TIFF",
      CHANNELS(0, 0, 1, 0),
      false,
      true },
    { { "pgm" },
      "pnm",
      "PGM",
      { true, false, false },
      "8 bits here; for more use PNG, EXR or TIFF",
      CHANNELS(1, 0, 0, 0),
      false,
      true },
    { { "pnm" },
      "pnm",
      "PNM",
      { true, false, false },
      "8 bits here; for more use PNG, EXR or TIFF",
      CHANNELS(1, 0, 1, 0),
      false,
      true },
    { { "hdr" },
      "hdr",
      "HDR",
      { false, false, true },
      "floats; for integers use PNG or TIFF",
      CHANNELS(0, 0, 1, 0),
      true,
      false },
};
#define FORMAT_COUNT (sizeof formats / sizeof *formats)

const WrImageFormat *wr_image_format(const char *path, WrError *err)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    for (size_t i = 0; i < FORMAT_COUNT && *ending; i++)
        for (int k = 0; k < 3 && formats[i].endings[k]; k++)
            if (strcmp(ending, formats[i].endings[k]) == 0) return &formats[i];
    wr_fail(err,
            "%s: the extension%s%s%s is not a picture format that can be written; use .png, .exr, "
            ".tif, .jpg, .bmp, .tga, .ppm, .pgm or .hdr",
            path, *ending ? " '" : "", ending, *ending ? "'" : "");
    return NULL;
}

bool wr_image_can_write(const char *path, WrPixelType type, int channels, bool data, WrError *err)
{
    const WrImageFormat *format = wr_image_format(path, err);
    if (!format) return false;
    const char *label = format->label;
    if (!format->holds[type]) return wr_fail(err, "%s: %s holds %s", path, label, format->types);
    if (data && format->pictures_only)
        return wr_fail(err, "%s: %s stores only 8 bits per channel; use EXR or TIFF", path, label);
    if (channels < 1 || channels > WR_IMAGE_CHANNELS_MAX)
        return wr_fail(err, "%s: %d channels: must be 1..%d", path, channels,
                       WR_IMAGE_CHANNELS_MAX);
    if (!(format->channels & 1) && (channels > 4 || !(format->channels >> channels & 1)))
        return wr_fail(err, "%s: %s cannot store %d channel%s; use PNG, EXR or TIFF", path, label,
                       channels, channels == 1 ? "" : "s");
    return true;
}

bool wr_image_deepest(const char *path, WrPixelType *type, WrError *err)
{
    const WrImageFormat *format = wr_image_format(path, err);
    if (!format) return false;
    *type = format->holds[WR_PIXEL_F32]   ? WR_PIXEL_F32
            : format->holds[WR_PIXEL_U16] ? WR_PIXEL_U16
                                          : WR_PIXEL_U8;
    return true;
}

/* Signatures, longest first where one begins another. TIFF in both byte orders, 42 and 43 (BigTIFF). Contents decide, not the
   extension: renamed files are common. */
const char *wr_image_sniff(const unsigned char *bytes, size_t count)
{
    static const struct {
        const char *format;
        const char *magic;
        unsigned char at, length;
    } known[] = {
        { "png", "\x89PNG\r\n\x1a\n", 0, 8 },
        { "openexr", "\x76\x2f\x31\x01", 0, 4 },
        { "tiff", "II*\0", 0, 4 },
        { "tiff", "MM\0*", 0, 4 },
        { "tiff", "II+\0", 0, 4 },
        { "tiff", "MM\0+", 0, 4 },
        { "jpeg", "\xff\xd8\xff", 0, 3 },
        { "gif", "GIF8", 0, 4 },
        { "hdr", "#?RADIANCE", 0, 10 },
        { "hdr", "#?RGBE", 0, 6 },
        { "psd", "8BPS", 0, 4 },
        { "dpx", "SDPX", 0, 4 },
        { "dpx", "XPDS", 0, 4 },
        { "webp", "WEBP", 8, 4 },
        { "jpeg2000", "\0\0\0\x0cjP  ", 0, 8 },
        { "sgi", "\x01\xda", 0, 2 },
        { "fits", "SIMPLE  =", 0, 9 },
        { "bmp", "BM", 0, 2 },
        { "pnm", "P1", 0, 2 },
        { "pnm", "P2", 0, 2 },
        { "pnm", "P3", 0, 2 },
        { "pnm", "P4", 0, 2 },
        { "pnm", "P5", 0, 2 },
        { "pnm", "P6", 0, 2 },
        { "pnm", "Pf", 0, 2 },
        { "pnm", "PF", 0, 2 },
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (count >= (size_t)known[i].at + known[i].length &&
            memcmp(bytes + known[i].at, known[i].magic, known[i].length) == 0)
            return known[i].format;
    return NULL;
}

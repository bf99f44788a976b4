/* oiio.cpp - the module wrinkle_oiio.so; the only file that uses OpenImageIO. Its interface is oiio.h.

   Workarounds for the library:
   - reading a damaged TIFF always succeeds and only sets an error message: after every call a message
     counts as failure;
   - few readers enforce size limits: the checks here are the effective ones;
   - integer codes are multiplied by float factors, and other header properties are ignored: below "values";
   - alpha is multiplied into colours by default;
   - libjpeg exits the whole program when it cannot write: it never receives a write error;
   - multi-part EXR and TIFF are written to a file that the library opens, and failures at the end are
     not reported: the caller passes a memory file and reads it back; libtiff's error messages are
     intercepted. */
extern "C" {
#include "base/spool.h"
#include "image/oiio.h"
#include "system/fd.h"
}

#include "image/one_line.hpp"

#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

/* ---- errors ---- */

/* Replaces every occurrence. */
static void say_instead(std::string &text, const std::string &what, const std::string &instead)
{
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += instead.size())
        text.replace(at, what.size(), instead);
}

/* Stores the message as one line. The caller names the file; the path used by the library is internal
 * and is removed. */
static bool fail(char *reason, std::string text, const std::string &path = std::string())
{
    if (!path.empty()) say_instead(text, " (" + path + ")", "");
    for (const char *quote : { "\"", "'", "" }) {
        std::string quoted = quote + path + quote;
        for (const char *before : { "image file ", "file " })
            if (!path.empty()) say_instead(text, before + quoted, "the file");
        if (!path.empty()) say_instead(text, quoted, "the file");
    }
    one_line(reason, WR_CODEC_REASON, text);
    return false;
}

/* Runs a function that returns bool; an exception becomes a reason. */
template <typename Body> bool guarded(char *reason, Body body)
{
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return fail(reason, WR_CODEC_NO_MEMORY);
    } catch (const std::exception &problem) {
        return fail(reason, problem.what());
    } catch (...) {
        return fail(reason, "unknown exception in the library");
    }
}

/* ---- FITS ---- */

/* Parser of FITS header numbers that OpenImageIO misreads. C++, only in the module.

   OpenImageIO stops at the D of a Fortran exponent (1.25D1), which the FITS standard 4.0, 4.2.4 allows. */

#define FITS_BLOCK 2880 /* bytes; headers and data are padded to whole blocks */
#define FITS_CARD 80    /* bytes of a header line */

/* Offset of a picture's header, with OpenImageIO's numbering; -1: none. */
static int64_t fits_header(int fd, int picture)
{
    char begin[20];
    for (int64_t at = 0; wr_fd_read_at(fd, begin, sizeof begin, at) == sizeof begin;
         at += FITS_BLOCK)
        if ((!std::memcmp(begin, "SIMPLE", 6) ||
             !std::memcmp(begin, "XTENSION= 'IMAGE   '", sizeof begin)) &&
            picture-- == 0)
            return at;
    return -1;
}

/* The number of a key in a picture's header, or the fallback if absent. */
static double fits_number(int fd, int picture, const char *key, double fallback)
{
    char card[FITS_CARD + 1] = "", padded[12];
    std::snprintf(padded, sizeof padded, "%-8s= ", key);
    const int64_t begin = fits_header(fd, picture), most = begin + 1024 * FITS_BLOCK;
    for (int64_t at = begin; at >= 0 && at < most; at += FITS_CARD) {
        if (wr_fd_read_at(fd, card, FITS_CARD, at) != FITS_CARD ||
            !std::memcmp(card, "END     ", 8))
            break;
        if (std::memcmp(card, padded, 10) != 0) continue;
        std::string text(card + 10, strcspn(card + 10, "/"));
        for (char &letter : text)
            if (letter == 'D' || letter == 'd') letter = 'E';
        char *end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        return end != text.c_str() && std::isfinite(value) ? value : fallback;
    }
    return fallback;
}

/* ---- TIFF ---- */

/* Direct calls of libtiff: write errors and tags that OpenImageIO does not report.
   C++, only in the module.

   libtiff reports failures on closing a file only to an error handler. OpenImageIO links libtiff; its
   few functions used here are declared in this file. */

extern "C" void *TIFFSetErrorHandlerExt(void (*handler)(void *, const char *, const char *,
                                                        va_list)) __attribute__((weak));

/* The first error of this thread since the buffer was cleared, and errno before it. */
static thread_local char tiff_error[256];
static thread_local int tiff_errno;

static void forget_tiff_error()
{
    tiff_error[0] = '\0';
    tiff_errno = errno = 0;
}

/* Keeps the first errno of a disk that is full or broken. */
static void note_disk_error()
{
    bool disk = errno == EFBIG || errno == ENOSPC || errno == EDQUOT || errno == EIO;
    if (!tiff_errno && disk) tiff_errno = errno;
}

/* An unsupported tag was omitted intentionally (forbid_date), or is irrelevant. */
static void on_tiff_error(void *, const char *from, const char *format, va_list list)
{
    if (from && std::strstr(from, "SetField")) return;
    note_disk_error();
    if (!tiff_error[0]) vsnprintf(tiff_error, sizeof tiff_error, format, list);
}

static void listen_to_tiff()
{
    if (TIFFSetErrorHandlerExt) TIFFSetErrorHandlerExt(on_tiff_error);
}

/* libtiff is loaded with OpenImageIO; three functions do not justify requiring its headers. */
extern "C" {
struct tiff;
struct tiff *TIFFFdOpen(int fd, const char *name, const char *mode) __attribute__((weak));
int TIFFSetDirectory(struct tiff *file, uint32_t directory) __attribute__((weak));
int TIFFGetField(struct tiff *file, uint32_t tag, ...) __attribute__((weak));
void TIFFClose(struct tiff *file) __attribute__((weak));
}

#define TIFF_GDAL_METADATA 42112U /* XML */
#define TIFF_GDAL_NODATA 42113U   /* a number as text */
#define TIFF_MODEL_PIXEL_SCALE 33550U
#define TIFF_MODEL_TRANSFORMATION 34264U

/* A number of GDAL's metadata for the first channel, "scale" or "offset", or the fallback. */
static double gdal_number(const std::string &metadata, const char *role, double fallback)
{
    const std::string begin = std::string("sample=\"0\" role=\"") + role + "\">";
    const size_t at = metadata.find(begin);
    if (at == std::string::npos) return fallback;
    const char *from = metadata.c_str() + at + begin.size();
    char *end = nullptr;
    const double value = std::strtod(from, &end);
    return end != from && std::isfinite(value) ? value : fallback;
}

/* GDAL's no-data value and metadata of a directory, "" if absent. Returns true if the directory is georeferenced or
   has that value: its numbers are measurements. */
static bool tiff_no_data(int fd, int directory, std::string &text, std::string &metadata)
{
    if (!TIFFFdOpen || !TIFFSetDirectory || !TIFFGetField || !TIFFClose) return false;
    /* A copy shares its position with the original, which OpenImageIO reads. */
    const int64_t position = wr_fd_position(fd);
    int copy = wr_fd_copy(fd);
    if (copy < 0) return false;
    wr_fd_seek(copy, 0);
    struct tiff *file = TIFFFdOpen(copy, "picture", "r"); /* owns the copy */
    if (!file) {
        wr_fd_close(copy);
        wr_fd_seek(fd, position);
        return false;
    }
    bool measured = false;
    if (TIFFSetDirectory(file, static_cast<uint32_t>(directory))) {
        /* libtiff returns unknown tags with their count. */
        uint32_t count = 0;
        const char *found = nullptr;
        const void *numbers = nullptr;
        if (TIFFGetField(file, TIFF_GDAL_NODATA, &count, &found) && found && count > 0 &&
            count < 64) {
            text.assign(found, strnlen(found, count));
            measured = true;
        }
        if (TIFFGetField(file, TIFF_GDAL_METADATA, &count, &found) && found && count < 65536)
            metadata.assign(found, strnlen(found, count));
        if (TIFFGetField(file, TIFF_MODEL_PIXEL_SCALE, &count, &numbers) ||
            TIFFGetField(file, TIFF_MODEL_TRANSFORMATION, &count, &numbers))
            measured = true;
    }
    wr_fd_seek(fd, position);
    TIFFClose(file);
    return measured;
}

/* ---- values ---- */

/* Conversion of file values to WrImage: codes, numbers, inverted greys, missing
   values, the display window. C++, only in the module.

   OpenImageIO scales every integer to 0..1 or -1..1, inverts a TIFF whose photometric interpretation is
   "min is white" at 8 bits only (alpha included), ignores FITS's BZERO and BSCALE, the no-data value of
   GDAL and the display window of OpenEXR. All conversions are chosen here, once, when a part is opened. */

struct Values {
    OIIO::TypeDesc type;  /* type in which rows are requested from the library */
    double divisor = 0.0; /* codes / divisor; 0: numbers unchanged */
    int shift = 0;        /* of numbers: low bits that the library added */
    double scale = 1.0;   /* then value = scale x + offset */
    double offset = 0.0;
    bool invert = false;        /* 1 - x for every channel except `alpha` */
    bool restore_alpha = false; /* the library inverted it with the colours */
    int alpha = -1;
    bool has_no_data = false;
    double no_data = 0.0; /* becomes NaN */
    /* OpenEXR: with mixed types the library scales unsigned integers to 0..1: [channels] 2^32 - 1
     * undoes it. */
    std::vector<float> restore;
    /* The data window relative to the picture, which is the display window. */
    int x = 0, y = 0, width = 0, height = 0;
};

/* The largest code of an integer type. */
static double last_code(OIIO::TypeDesc type)
{
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8: return 255.0;
    case OIIO::TypeDesc::UINT16: return 65535.0;
    case OIIO::TypeDesc::UINT32: return 4294967295.0;
    default: return 0.0;
    }
}

static bool is_integer(OIIO::TypeDesc type)
{
    return !type.is_floating_point();
}

/* Signed integers, and unsigned ones of 32 bits in OpenEXR (IDs), are numbers; other integers are codes. */
static void choose_numbers(const OIIO::ImageSpec &spec, const std::string &format, Values &values)
{
    const bool exr = format == "openexr";
    if (!spec.channelformats.empty()) {
        values.type = OIIO::TypeDesc::FLOAT;
        values.restore.assign(spec.channelformats.size(), 0.0f);
        for (size_t c = 0; c < spec.channelformats.size(); c++)
            if (exr && spec.channelformats[c] == OIIO::TypeDesc::UINT32)
                values.restore[c] = 4294967295.0f;
        return;
    }
    values.type = spec.format;
    if (!is_integer(spec.format)) values.type = OIIO::TypeDesc::FLOAT;
    else if (!exr || spec.format != OIIO::TypeDesc::UINT32) values.divisor = last_code(spec.format);
}

/* FITS: the header defines the conversion of stored numbers to physical ones (FITS standard 4.0,
   4.4.2.5): x BSCALE + BZERO; BLANK marks integers without a value. Pictures of 8 bits without these
   keys stay codes. */
static void choose_fits(const OIIO::ImageSpec &spec, int fd, int picture, Values &values)
{
    values.scale = fits_number(fd, picture, "BSCALE", 1.0);
    values.offset = fits_number(fd, picture, "BZERO", 0.0);
    const bool physical = values.scale != 1.0 || values.offset != 0.0;
    if (physical) values.divisor = 0.0;
    const double blank = fits_number(fd, picture, "BLANK", std::nan(""));
    if (is_integer(spec.format) && values.divisor == 0.0 && !std::isnan(blank)) {
        values.has_no_data = true;
        values.no_data = blank;
    }
}

/* True if unsigned integers of a TIFF are numbers instead of codes. measured: it is georeferenced or
   has a no-data value; numbers: elevations were requested. 8 bits whose smallest value is white are
   inverted by the library: codes. */
static bool tiff_has_numbers(const OIIO::ImageSpec &spec, bool measured, bool numbers)
{
    if (spec.format == OIIO::TypeDesc::UINT32) return measured || numbers;
    const bool inverted = spec.format == OIIO::TypeDesc::UINT8 &&
                          spec.get_int_attribute("tiff:PhotometricInterpretation", 1) == 0;
    return measured && numbers && !inverted;
}

/* TIFF: photometric interpretation 0; GDAL's no-data value; voids of signed elevations. */
static bool choose_tiff(const OIIO::ImageSpec &spec, int fd, int directory, bool numbers,
                        Values &values, std::string &note, std::string &problem)
{
    const int bits = spec.get_int_attribute("oiio:BitsPerSample", 0);
    if (bits > 16 && bits < 32) {
        problem = "has " + std::to_string(bits) +
                  " bits a channel, which is not read: save it with 16 or 32 bits";
        return false;
    }
    std::string text, metadata;
    const bool measured = tiff_no_data(fd, directory, text, metadata);
    if (tiff_has_numbers(spec, measured, numbers)) {
        const int wide = static_cast<int>(8 * spec.format.size());
        values.divisor = 0.0;
        if (bits > 0 && bits < wide) values.shift = wide - bits; /* 12 bits are widened to 16 */
    }
    if (values.divisor == 0.0) {
        values.scale = gdal_number(metadata, "scale", 1.0);
        values.offset = gdal_number(metadata, "offset", 0.0);
    }
    values.alpha = spec.alpha_channel;
    if (spec.get_int_attribute("tiff:PhotometricInterpretation", 1) == 0) {
        const bool library = spec.format == OIIO::TypeDesc::UINT8;
        values.restore_alpha = library && values.alpha >= 0;
        values.invert = !library && values.divisor > 0.0;
        if (values.divisor == 0.0)
            note = "its smallest value is white by its header; numbers stay as they are";
    }
    char *end = nullptr;
    const double no_data = text.empty() ? 0.0 : std::strtod(text.c_str(), &end);
    if (end && end != text.c_str()) { /* "nan": NaN marks missing values */
        values.has_no_data = true;
        values.no_data = no_data;
        if (values.divisor > 0.0) { /* compared after the division */
            values.no_data =
                values.invert ? 1.0 - no_data / values.divisor : no_data / values.divisor;
        }
    } else if (spec.format == OIIO::TypeDesc::INT16 || spec.format == OIIO::TypeDesc::INT32) {
        values.has_no_data = true; /* SRTM and most elevation models */
        values.no_data = -32768.0;
    }
    return true;
}

static std::string size_text(int width, int height)
{
    return std::to_string(width) + "x" + std::to_string(height);
}

/* OpenEXR: the picture is the display window; pixels are stored for the data window, which may be
   smaller or larger. All parts of a file share one display window, so it is used only for parts with
   the first part's data window: others, such as those of the program's documents, are pictures of their
   own size. */
static void choose_window(const OIIO::ImageSpec &spec, const std::string &format, Values &values,
                          int &width, int &height, std::string &note)
{
    values.width = width = spec.width;
    values.height = height = spec.height;
    if (format != "openexr" || spec.full_width < 1 || spec.full_height < 1) return;
    if (spec.full_x == spec.x && spec.full_y == spec.y && spec.full_width == spec.width &&
        spec.full_height == spec.height)
        return;
    width = spec.full_width;
    height = spec.full_height;
    values.x = spec.x - spec.full_x;
    values.y = spec.y - spec.full_y;
    note = "its data window, " + size_text(spec.width, spec.height) + " at " +
           std::to_string(values.x) + "," + std::to_string(values.y) +
           ", is not its display window, " + size_text(width, height) +
           ": cut to it, and 0 where there is no data";
}

/* GDAL writes the largest floats with few digits: beyond 1e30 only the sign is compared. */
static bool is_no_data(float x, double no_data)
{
    if (std::fabs(no_data) > 1e30) return no_data > 0.0 ? x > 1e30f : x < -1e30f;
    return x == static_cast<float>(no_data);
}

/* Converts rows from the library to values of WrImage. */
template <typename Code>
static void decode_codes(const Code *codes, size_t count, const Values &values, float *out)
{
    if (values.divisor > 0.0) {
        const float divisor = static_cast<float>(values.divisor);
        for (size_t i = 0; i < count; i++)
            out[i] = sizeof(Code) < 4
                         ? static_cast<float>(codes[i]) / divisor
                         : static_cast<float>(static_cast<double>(codes[i]) / values.divisor);
    } else {
        for (size_t i = 0; i < count; i++)
            out[i] = static_cast<float>(static_cast<Code>(codes[i] >> values.shift));
    }
}

static void decode_values(const void *codes, size_t pixels, int channels, const Values &values,
                          float *out)
{
    const size_t count = pixels * static_cast<size_t>(channels);
    switch (values.type.basetype) {
    case OIIO::TypeDesc::UINT8:
        decode_codes(static_cast<const uint8_t *>(codes), count, values, out);
        break;
    case OIIO::TypeDesc::INT8:
        decode_codes(static_cast<const int8_t *>(codes), count, values, out);
        break;
    case OIIO::TypeDesc::UINT16:
        decode_codes(static_cast<const uint16_t *>(codes), count, values, out);
        break;
    case OIIO::TypeDesc::INT16:
        decode_codes(static_cast<const int16_t *>(codes), count, values, out);
        break;
    case OIIO::TypeDesc::UINT32:
        decode_codes(static_cast<const uint32_t *>(codes), count, values, out);
        break;
    case OIIO::TypeDesc::INT32:
        decode_codes(static_cast<const int32_t *>(codes), count, values, out);
        break;
    default: break; /* floats are already in `out` */
    }
    const int each = channels;
    for (size_t i = 0; i < count; i++) {
        const int c = static_cast<int>(i % static_cast<size_t>(each));
        float x = out[i];
        if (!values.restore.empty() && values.restore[static_cast<size_t>(c)] > 0.0f)
            x = std::rint(x * values.restore[static_cast<size_t>(c)]);
        if (c == values.alpha ? values.restore_alpha : values.invert) x = 1.0f - x;
        if (values.has_no_data && c != values.alpha && is_no_data(x, values.no_data)) x = NAN;
        else if (values.scale != 1.0 || values.offset != 0.0)
            x = static_cast<float>(values.scale * static_cast<double>(x) + values.offset);
        out[i] = x;
    }
}

/* True if decode_values changes floats. */
static bool changes_floats(const Values &values)
{
    return values.has_no_data || values.invert || values.restore_alpha || !values.restore.empty() ||
           values.scale != 1.0 || values.offset != 0.0;
}

/* ---- files ---- */

/* Buffered output proxy between an image library and a byte sink. C++, only in the
   module. */

/* An output of the caller for a library: accepts every write and stores the first failure. */
class Disk : public OIIO::Filesystem::IOProxy
{
  public:
    explicit Disk(const WrByteSink &to) : IOProxy("", Write), sink(to), block(1 << 16)
    {
    }
    const char *proxytype() const override
    {
        return "disk";
    }
    size_t read(void *, size_t) override
    {
        return 0;
    }
    size_t write(const void *bytes, size_t count) override
    {
        const char *from = static_cast<const char *>(bytes);
        for (size_t left = count; left > 0;) {
            if (m_pos != at + static_cast<int64_t>(held) || held == block.size()) empty();
            size_t take = std::min(left, block.size() - held);
            std::memcpy(block.data() + held, from, take);
            held += take;
            from += take;
            left -= take;
            m_pos += static_cast<int64_t>(take);
        }
        if (m_pos > end) end = m_pos;
        return count;
    }
    size_t size() const override
    {
        return static_cast<size_t>(end);
    }
    /* Flushes the buffer and continues at the library's present position. */
    void empty()
    {
        if (held > 0 && !error && !sink.write(sink.to, block.data(), held, at)) error = errno;
        held = 0;
        at = m_pos;
    }
    int error = 0; /* errno of the first failure */

  private:
    WrByteSink sink;
    std::vector<char> block; /* bytes to be written at `at` */
    size_t held = 0;
    int64_t at = 0, end = 0;
};

/* ---- the module ---- */

/* Declared in OpenImageIO/tiffutils.h, which needs libtiff's headers. */
OIIO_NAMESPACE_BEGIN
OIIO_API bool decode_exif(string_view exif, ImageSpec &spec);
OIIO_NAMESPACE_END

using namespace OIIO;

static void settle_library()
{
    listen_to_tiff();

    OIIO::attribute("threads", 1); /* the program parallelises its own work instead */
    OIIO::attribute("try_all_readers", 0);
    OIIO::attribute("debug", 0); /* otherwise it prints to standard error */
}

/* ---- reading ---- */

struct WrCodecReader {
    int fd;
    std::string path; /* of fd, for formats that need a path (system/open_interposer.h) and for
                         messages */
    std::unique_ptr<FILE, int (*)(FILE *)> file{ nullptr, std::fclose }; /* a copy of fd */
    std::unique_ptr<Filesystem::IOFile> proxy;                           /* must outlive `in` */
    std::unique_ptr<ImageInput> in;
    std::vector<ImageSpec> specs;
    std::vector<std::vector<const char *>> names;
    std::vector<WrCodecPart> parts;
    std::vector<Values> values; /* for each part */
    std::vector<char> codes;    /* scratch */
    std::vector<float> window;  /* rows of the data window, if it differs from the image */
    std::vector<float> band; /* of a tiled file: rows [band_y, band_y + band_rows) of band_part */
    int skipped = 0;         /* pictures without pixels before part 0 */
    int band_part = -1, band_y = 0, band_rows = 0, band_channels = 0;
    bool levels = false;  /* parts are mip levels of the first part */
    bool numbers = false; /* integers that are measurements are numbers */
};

/* 64-bit integers of FITS and TIFF: the library has no type for them, or returns zeros. */
#define UNREAD_NUMBERS                                                                             \
    "has numbers of a kind that is not read: save it as 32-bit integers or floats"

static bool check_spec(const ImageSpec &spec, char *reason)
{
    std::string size = std::to_string(spec.width) + "x" + std::to_string(spec.height);
    if (spec.width < 1 || spec.height < 1) return fail(reason, "has no pixels (" + size + ")");
    if (spec.width > WR_IMAGE_MAX || spec.height > WR_IMAGE_MAX)
        return fail(reason, "picture of " + size + ": each side must be 1.." +
                                std::to_string(WR_IMAGE_MAX));
    if (spec.depth > 1) return fail(reason, "is a volume, not a picture");
    if (spec.format == TypeDesc::UNKNOWN) return fail(reason, UNREAD_NUMBERS);
    if (spec.deep) return fail(reason, "is a deep picture (several samples a pixel)");
    if (spec.nchannels < 1 || spec.nchannels > WR_IMAGE_CHANNELS_MAX)
        return fail(reason, std::to_string(spec.nchannels) + " channels: must be 1.." +
                                std::to_string(WR_IMAGE_CHANNELS_MAX));
    if (spec.tile_width != 0 && (spec.tile_height < 1 || spec.tile_height > WR_IMAGE_MAX ||
                                 spec.tile_width < 1 || spec.tile_width > WR_IMAGE_MAX))
        return fail(reason, "tiles of impossible size");
    return true;
}

/* Formats without attributes store the program's attributes as lines of the description. */
static void unpack_description(ImageSpec &spec)
{
    std::string text = spec.get_string_attribute("ImageDescription");
    for (size_t at = 0; at < text.size();) {
        size_t end = text.find('\n', at);
        if (end == std::string::npos) end = text.size();
        std::string line = text.substr(at, end - at);
        size_t equals = line.find('=');
        if (equals != std::string::npos && line.compare(0, 8, "wrinkle:") == 0 &&
            !spec.find_attribute(line.substr(0, equals)))
            spec.attribute(line.substr(0, equals), line.substr(equals + 1));
        at = end + 1;
    }
}

/* The EXIF orientation of a WebP file: a chunk that the library skips. 0: none. */
static int webp_orientation(int fd)
{
    unsigned char head[12];
    if (wr_fd_read_at(fd, head, 12, 0) != 12 || std::memcmp(head + 8, "WEBP", 4) != 0) return 0;
    for (int64_t at = 12, chunks = 0; chunks < 4096; chunks++) {
        unsigned char chunk[8];
        if (wr_fd_read_at(fd, chunk, 8, at) != 8) return 0;
        const uint32_t size = uint32_t(chunk[4]) | uint32_t(chunk[5]) << 8 |
                              uint32_t(chunk[6]) << 16 | uint32_t(chunk[7]) << 24;
        if (std::memcmp(chunk, "EXIF", 4) == 0 && size > 8 && size <= 65536) {
            std::string bytes(size, 0);
            if (wr_fd_read_at(fd, &bytes[0], size, at + 8) != int64_t(size)) return 0;
            if (bytes.compare(0, 6, std::string("Exif\0\0", 6)) == 0) bytes.erase(0, 6);
            ImageSpec exif;
            decode_exif(bytes, exif);
            return exif.get_int_attribute("Orientation");
        }
        at += 8 + int64_t(size) + (size & 1);
    }
    return 0;
}

/* Chooses the conversion of a part's values; `note` receives remarks for the user. */
static bool choose_values(const WrCodecReader &reader, const ImageSpec &spec, Values &values,
                          WrImagePart &part, std::string &note, char *reason)
{
    const std::string format = reader.in->format_name();
    std::string problem;
    choose_numbers(spec, format, values);
    const int directory =
        reader.levels ? 0 : reader.skipped + static_cast<int>(reader.parts.size());
    if (format == "fits") choose_fits(spec, reader.fd, directory, values);
    if (format == "tiff" &&
        !choose_tiff(spec, reader.fd, directory, reader.numbers, values, note, problem))
        return fail(reason, problem);
    const ImageSpec &first = reader.specs.empty() ? spec : reader.specs[0];
    const bool shares = first.x == spec.x && first.y == spec.y && first.width == spec.width &&
                        first.height == spec.height;
    choose_window(spec, shares ? format : "", values, part.width, part.height, note);
    if (part.width <= WR_IMAGE_MAX && part.height <= WR_IMAGE_MAX) return true;
    return fail(reason, "display window of " + size_text(part.width, part.height) +
                            ": each side must be 1.." + std::to_string(WR_IMAGE_MAX));
}

static bool add_part(WrCodecReader &reader, ImageSpec spec, char *reason)
{
    if (!check_spec(spec, reason)) return false;
    unpack_description(spec);
    WrCodecPart part = {};
    Values values;
    std::string note;
    if (!choose_values(reader, spec, values, part.part, note, reason)) return false;
    int orientation = spec.get_int_attribute("Orientation");
    if (!orientation && !std::strcmp(reader.in->format_name(), "webp"))
        orientation = webp_orientation(reader.fd);
    spec.attribute("wrinkle:orientation", std::to_string(orientation));
    if (!note.empty()) spec.attribute("wrinkle:note", note);
    if (values.has_no_data) spec.attribute("wrinkle:no-data", "1");
    /* A number in bump slopes files; the interface returns only texts. */
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", double(spec.get_float_attribute("uvslopes_scale")));
    spec.attribute("wrinkle:uvslopes", text);
    part.part.channels = spec.nchannels;
    part.part.type = WR_PIXEL_F32;
    if (values.divisor == 255.0) part.part.type = WR_PIXEL_U8;
    else if (values.divisor == 65535.0) part.part.type = WR_PIXEL_U16;
    part.divisor = part.part.type == WR_PIXEL_F32 ? 0.0 : values.divisor;
    reader.specs.push_back(spec);
    reader.values.push_back(values);
    reader.parts.push_back(part);
    return true;
}

/* Sets pointers into the specs, after those no longer move. */
static void name_parts(WrCodecReader &reader)
{
    for (size_t i = 0; i < reader.parts.size(); i++) {
        ImageSpec &spec = reader.specs[i];
        std::vector<const char *> names;
        spec.channelnames.resize(static_cast<size_t>(spec.nchannels));
        names.reserve(spec.channelnames.size());
        for (const std::string &name : spec.channelnames) names.push_back(name.c_str());
        reader.names.push_back(names);
        reader.parts[i].part.channel_names = nullptr;
        /* Lives as long as the process; NULL for an empty name. */
        const char *name = ustring(spec.get_string_attribute("oiio:subimagename")).c_str();
        reader.parts[i].part.name = name ? name : "";
    }
    for (size_t i = 0; i < reader.parts.size(); i++)
        reader.parts[i].part.channel_names = reader.names[i].data();
}

/* Most formats read from the open file, since the reader may not be allowed to open any. */
static bool give_file(WrCodecReader &reader, char *reason)
{
    int copy = wr_fd_copy(reader.fd);
    reader.file.reset(copy < 0 ? nullptr : wr_fd_stream(copy, "rb"));
    if (!reader.file || !wr_stream_seek(reader.file.get(), 0))
        return fail(reason, std::strerror(errno));
    reader.proxy =
        std::make_unique<Filesystem::IOFile>(reader.file.get(), Filesystem::IOProxy::Read);
    reader.in->set_ioproxy(reader.proxy.get());
    return true;
}

static bool fail_open(const std::string &why, const std::string &path, char *reason)
{
    if (why.find("No support for data format") != std::string::npos)
        return fail(reason, UNREAD_NUMBERS);
    return fail(reason,
                "cannot be opened, truncated or damaged" + (why.empty() ? "" : " (" + why + ")"),
                path);
}

/* Telescopes write FITS files whose first header has no picture. Such pictures are not parts. */
static bool skip_empty(WrCodecReader &reader, char *reason)
{
    if (std::strcmp(reader.in->format_name(), "fits") != 0) return true;
    while (reader.in->spec().width < 1)
        if (!reader.in->seek_subimage(++reader.skipped, 0))
            return fail(reason, "has no picture, or only compressed ones, which are not read: "
                                "uncompress it, with funpack for example");
    return true;
}

static bool open_file(WrCodecReader &reader, const char *format, int most, char *reason)
{
    settle_library();
    if (*format) reader.in = ImageInput::create(format);
    std::string ignored = OIIO::geterror();
    if (!reader.in || !std::strcmp(reader.in->format_name(), "null") ||
        !std::strcmp(reader.in->format_name(), "FFmpeg movie"))
        return fail(reason, "is not a picture of a kind that can be read");
    ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1);
    if (reader.in->supports("ioproxy") && !give_file(reader, reason)) return false;
    if (!reader.in->open(reader.path, spec, config))
        return fail_open(reader.in->geterror(), reader.path, reason);
    /* Progressive JPEG files are decoded here, and the library reports success when they end early. */
    const std::string warning = reader.in->geterror();
    if (warning.find("Premature end") != std::string::npos)
        return fail_open(warning, reader.path, reason);
    if (!skip_empty(reader, reason)) return false;
    if (!add_part(reader, reader.in->spec(), reason)) return false;
    /* Readers detect further parts by trial; some do not recover from a failed trial, so it is avoided
     * if possible. */
    reader.levels = most == WR_CODEC_LEVELS;
    for (int i = 1; reader.levels && i < WR_IMAGE_PARTS_MAX && reader.in->seek_subimage(0, i); i++)
        if (!add_part(reader, reader.in->spec(), reason)) return false;
    for (int i = 1; most > 1 && reader.in->seek_subimage(reader.skipped + i, 0); i++) {
        if (i >= most) return fail(reason, "more than " + std::to_string(most) + " parts");
        if (!add_part(reader, reader.in->spec(), reason)) return false;
    }
    /* The error of the search for the end is irrelevant; damage is detected when rows are read. */
    ignored = reader.in->geterror();
    name_parts(reader);
    return true;
}

/* A name for libraries that accept only names. */
static std::string name_of(int fd)
{
    char name[WR_FD_NAME];
    wr_fd_name(fd, name);
    return name;
}

static WrCodecReader *reader_open(int fd, const char *format, int most, bool numbers, char *reason)
{
    WrCodecReader *opened = nullptr;
    guarded(reason, [&] {
        auto reader = std::make_unique<WrCodecReader>();
        reader->fd = fd;
        reader->numbers = numbers;
        reader->path = name_of(fd);
        if (!open_file(*reader, format, most, reason)) return false;
        opened = reader.release();
        return true;
    });
    return opened;
}

static void reader_close(WrCodecReader *reader)
{
    char reason[WR_CODEC_REASON];
    guarded(reason, [&] {
        delete reader;
        return true;
    });
}

static int reader_parts(const WrCodecReader *reader)
{
    return static_cast<int>(reader->parts.size());
}

static const WrCodecPart *reader_part(const WrCodecReader *reader, int part)
{
    return &reader->parts[static_cast<size_t>(part)];
}

static const char *reader_attribute(const WrCodecReader *reader, int part, const char *name)
{
    const char *text = nullptr;
    char reason[WR_CODEC_REASON];
    guarded(reason, [&] {
        const ImageSpec &spec = reader->specs[static_cast<size_t>(part)];
        const ParamValue *found = spec.find_attribute(name, TypeDesc::STRING);
        if (found) text = found->get_ustring().c_str();
        if (found && !text) text = "";
        return true;
    });
    return text;
}

static bool check_read(WrCodecReader &reader, bool ok, char *reason)
{
    std::string message = reader.in->geterror();
    if (ok && message.empty()) return true;
    return fail(reason, message, reader.path);
}

/* The library's FITS reader counts rows from 1: row 0 is beyond the file's last, and its first was
 * never read. */
static bool read_fits_rows(WrCodecReader &reader, int part, int top, int rows, int channels,
                           TypeDesc type, void *out)
{
    const ImageSpec &spec = reader.specs[static_cast<size_t>(part)];
    const size_t row =
        static_cast<size_t>(spec.width) * static_cast<size_t>(channels) * type.size();
    bool ok = channels == spec.nchannels && reader.in->seek_subimage(reader.skipped + part, 0);
    for (int j = 0; ok && j < rows; j++)
        ok = reader.in->read_scanline(top + j + 1, 0, type,
                                      static_cast<char *>(out) + static_cast<size_t>(j) * row);
    return ok;
}

/* Reads rows [y, y + rows) of the data window. */
static bool read_band(WrCodecReader &reader, int part, int y, int rows, int channels, float *out,
                      char *reason)
{
    const ImageSpec &spec = reader.specs[static_cast<size_t>(part)];
    const Values &values = reader.values[static_cast<size_t>(part)];
    const size_t pixels = static_cast<size_t>(spec.width) * static_cast<size_t>(rows);
    void *to = out;
    if (is_integer(values.type)) {
        reader.codes.resize(pixels * static_cast<size_t>(channels) * values.type.size());
        to = reader.codes.data();
    }
    int top = spec.y + y, subimage = reader.levels ? 0 : part, level = reader.levels ? part : 0;
    /* Only for no type at all does the library read straight to the caller; else through a buffer of 64 MiB of its own. */
    const bool as_stored = values.type == spec.format && spec.channelformats.empty();
    const TypeDesc type = as_stored ? TypeDesc(TypeDesc::UNKNOWN) : values.type;
    bool ok;
    if (spec.tile_width)
        ok = reader.in->read_tiles(subimage, level, spec.x, spec.x + spec.width, top, top + rows,
                                   spec.z, spec.z + 1, 0, channels, type, to);
    else if (!std::strcmp(reader.in->format_name(), "fits"))
        ok = read_fits_rows(reader, part, top, rows, channels, values.type, to);
    else
        ok = reader.in->read_scanlines(subimage, level, top, top + rows, spec.z, 0, channels, type,
                                       to);
    if (!check_read(reader, ok, reason)) return false;
    if (to != out || changes_floats(values)) decode_values(to, pixels, channels, values, out);
    return true;
}

/* A tiled file returns only whole rows of tiles: the last one is cached. */
static bool read_tiled(WrCodecReader &reader, int part, int y, int rows, int channels, float *out,
                       char *reason)
{
    const ImageSpec &spec = reader.specs[static_cast<size_t>(part)];
    size_t row = static_cast<size_t>(spec.width) * static_cast<size_t>(channels);
    for (int done = 0; done < rows;) {
        int at = y + done, band_y = at - at % spec.tile_height;
        if (reader.band_part != part || reader.band_y != band_y ||
            reader.band_channels != channels) {
            int band_rows = std::min(spec.tile_height, spec.height - band_y);
            reader.band_part = -1;
            reader.band.resize(row * static_cast<size_t>(band_rows));
            if (!read_band(reader, part, band_y, band_rows, channels, reader.band.data(), reason))
                return false;
            reader.band_part = part;
            reader.band_y = band_y;
            reader.band_rows = band_rows;
            reader.band_channels = channels;
        }
        int take = std::min(rows - done, band_y + reader.band_rows - at);
        std::memcpy(out + static_cast<size_t>(done) * row,
                    reader.band.data() + static_cast<size_t>(at - band_y) * row,
                    static_cast<size_t>(take) * row * sizeof(float));
        done += take;
    }
    return true;
}

static bool read_data(WrCodecReader &reader, int part, int y, int rows, int channels, float *out,
                      char *reason)
{
    if (reader.specs[static_cast<size_t>(part)].tile_width)
        return read_tiled(reader, part, y, rows, channels, out, reason);
    return read_band(reader, part, y, rows, channels, out, reason);
}

/* Reads rows [y, y + rows) of an image with a different data window: 0 where there is no data. */
static bool read_windowed(WrCodecReader &reader, int part, int y, int rows, int channels,
                          float *out, char *reason)
{
    const Values &values = reader.values[static_cast<size_t>(part)];
    const int width = reader.parts[static_cast<size_t>(part)].part.width;
    const size_t each = static_cast<size_t>(channels);
    std::fill_n(out, static_cast<size_t>(width) * static_cast<size_t>(rows) * each, 0.0f);
    const int top = std::max(y, values.y), bottom = std::min(y + rows, values.y + values.height);
    const int left = std::max(0, values.x), right = std::min(width, values.x + values.width);
    if (top >= bottom || left >= right) return true;
    const size_t row = static_cast<size_t>(values.width) * each;
    reader.window.resize(row * static_cast<size_t>(bottom - top));
    if (!read_data(reader, part, top - values.y, bottom - top, channels, reader.window.data(),
                   reason))
        return false;
    for (int j = top; j < bottom; j++)
        std::memcpy(out + (static_cast<size_t>(j - y) * static_cast<size_t>(width) +
                           static_cast<size_t>(left)) *
                              each,
                    reader.window.data() + static_cast<size_t>(j - top) * row +
                        static_cast<size_t>(left - values.x) * each,
                    static_cast<size_t>(right - left) * each * sizeof(float));
    return true;
}

static bool reader_read(WrCodecReader *reader, int part, int y, int rows, int channels, float *out,
                        char *reason)
{
    return guarded(reason, [&] {
        const Values &values = reader->values[static_cast<size_t>(part)];
        const WrImagePart &is = reader->parts[static_cast<size_t>(part)].part;
        const bool whole = values.x == 0 && values.y == 0 && values.width == is.width &&
                           values.height == is.height;
        return whole ? read_data(*reader, part, y, rows, channels, out, reason)
                     : read_windowed(*reader, part, y, rows, channels, out, reason);
    });
}

/* ---- writing ---- */

struct WrCodecWriter {
    std::string path;
    std::unique_ptr<Disk> disk; /* must outlive `out`; NULL if the library opens the file itself */
    std::unique_ptr<ImageOutput> out;
    std::vector<ImageSpec> specs;
    std::vector<TypeDesc> types; /* of the rows passed in */
    bool levels = false;
    size_t part = 0;
};

static void name_channels(ImageSpec &spec, const WrImageOut &part)
{
    static const char *const usual[4][4] = {
        { "Y" }, { "Y", "A" }, { "R", "G", "B" }, { "R", "G", "B", "A" }
    };
    spec.channelnames.clear();
    spec.alpha_channel = -1;
    for (int c = 0; c < part.channels; c++) {
        if (part.channel_names) spec.channelnames.push_back(part.channel_names[c]);
        else if (part.channels <= 4) spec.channelnames.push_back(usual[part.channels - 1][c]);
        else spec.channelnames.push_back("c" + std::to_string(1000 + c)); /* EXR sorts by name */
        if (spec.channelnames.back() == "A") spec.alpha_channel = c;
    }
}

/* The same image must give the same bytes at any time. Writers add the present time unless there is a
   DateTime; one of a type that they cannot write prevents that and is not written. */
static void forbid_date(ImageSpec &spec)
{
    long long nothing = 0;
    spec.attribute("DateTime", TypeDesc::INT64, &nothing);
}

static void set_attributes(ImageSpec &spec, const WrImageOut &part, const char *format)
{
    bool exr = !std::strcmp(format, "openexr"), integer = part.type != WR_PIXEL_F32;
    bool linear = part.data || !integer;
    forbid_date(spec);
    spec.attribute("oiio:ColorSpace", linear ? "linear" : "sRGB");
    if (integer) spec.attribute("oiio:UnassociatedAlpha", 1);
    if (!std::strcmp(format, "jpeg")) {
        spec.attribute("CompressionQuality", 95);
        spec.attribute("jpeg:subsampling", "4:4:4");
    } else if (exr || !std::strcmp(format, "tiff")) {
        spec.attribute("compression", "zip");
    }
    /* "Uncalibrated". The TIFF writer fails to write an empty Exif directory, so it gets an entry. */
    if (!std::strcmp(format, "tiff") && linear) spec.attribute("Exif:ColorSpace", 65535);
    if (exr && part.part_name) spec.attribute("oiio:subimagename", part.part_name);
    TypeDesc bytes(TypeDesc::UINT8, int(part.profile_size));
    if (part.profile) spec.attribute("ICCProfile", bytes, part.profile);
    std::string description;
    for (int i = 0; i < part.attribute_count; i++) {
        const WrImageAttribute &attribute = part.attributes[i];
        if (exr) spec.attribute(attribute.name, attribute.text);
        else description += std::string(attribute.name) + "=" + attribute.text + "\n";
    }
    if (!description.empty()) spec.attribute("ImageDescription", description);
}

/* Attributes that texture systems expect in a tiled mip-mapped file. Mantissas of slopes rarely repeat:
 * zip needs ten times as long as run-length compression and saves 3 to 5 % of such a file. */
static void set_levels(ImageSpec &spec, const WrImageOut &part)
{
    spec.tile_width = spec.tile_height = WR_IMAGE_TILE;
    spec.tile_depth = 1;
    spec.full_width = part.width;
    spec.full_height = part.height;
    spec.attribute("textureformat", "Plain Texture");
    spec.attribute("compression", "rle");
    spec.attribute("openexr:roundingmode", 0); /* down */
    if (part.uvslopes) spec.attribute("uvslopes_scale", float(part.uvslopes_scale));
}

static bool check_write(WrCodecWriter &writer, bool ok, char *reason)
{
    /* The error handler of OpenImageIO 2.5 drops failures at the end. */
    if (!writer.disk && errno != EIO) note_disk_error();
    std::string message = writer.out->geterror();
    if (writer.disk && writer.disk->error) return fail(reason, std::strerror(writer.disk->error));
    if (tiff_errno) return fail(reason, std::strerror(tiff_errno));
    if (message.empty()) message = tiff_error;
    if (ok && message.empty()) return true;
    return fail(reason, message, writer.path);
}

static bool create_file(WrCodecWriter &writer, const WrByteSink &to, const char *format,
                        const WrImageOut *parts, int count, char *reason)
{
    static const TypeDesc types[] = { TypeDesc::UINT8, TypeDesc::UINT16, TypeDesc::FLOAT };
    settle_library();
    forget_tiff_error();
    writer.levels = parts[0].levels;
    writer.out = ImageOutput::create(format);
    if (!writer.out) return fail(reason, OIIO::geterror(), writer.path);
    for (int i = 0; i < count; i++) {
        const TypeDesc type = types[parts[i].type];
        ImageSpec spec(parts[i].width, parts[i].height, parts[i].channels,
                       parts[i].half ? TypeDesc(TypeDesc::HALF) : type);
        /* The parts of an EXR file share one display window. */
        spec.full_width = parts[0].width;
        spec.full_height = parts[0].height;
        name_channels(spec, parts[i]);
        set_attributes(spec, parts[i], format);
        if (parts[0].levels) set_levels(spec, parts[i]);
        writer.specs.push_back(spec);
        writer.types.push_back(type);
    }
    if (!wr_oiio_by_name(format, parts, count)) {
        writer.disk = std::make_unique<Disk>(to);
        if (!writer.out->set_ioproxy(writer.disk.get()))
            return fail(reason, "the format cannot be written to a file of ours");
    }
    bool ok = count > 1 && !writer.levels
                  ? writer.out->open(writer.path, count, writer.specs.data())
                  : writer.out->open(writer.path, writer.specs[0]);
    if (!check_write(writer, ok, reason)) return false;
    if (writer.out->spec().format != writer.specs[0].format)
        return fail(reason, "the format does not hold this type");
    return true;
}

static WrCodecWriter *writer_create(const WrByteSink *to, int spool, const char *format,
                                    const WrImageOut *parts, int count, char *reason)
{
    WrCodecWriter *created = nullptr;
    guarded(reason, [&] {
        auto writer = std::make_unique<WrCodecWriter>();
        writer->path = name_of(spool);
        if (!create_file(*writer, *to, format, parts, count, reason)) return false;
        created = writer.release();
        return true;
    });
    return created;
}

static bool writer_write(WrCodecWriter *writer, int y, int rows, const void *pixels, char *reason)
{
    return guarded(reason, [&] {
        errno = 0;
        const TypeDesc type = writer->types[writer->part];
        bool ok = writer->levels ? writer->out->write_tiles(0, writer->specs[writer->part].width, y,
                                                            y + rows, 0, 1, type, pixels)
                                 : writer->out->write_scanlines(y, y + rows, 0, type, pixels);
        return check_write(*writer, ok, reason);
    });
}

static bool writer_next(WrCodecWriter *writer, char *reason)
{
    return guarded(reason, [&] {
        writer->part++;
        bool ok = writer->out->open(writer->path, writer->specs[writer->part],
                                    writer->levels ? ImageOutput::AppendMIPLevel
                                                   : ImageOutput::AppendSubimage);
        return check_write(*writer, ok, reason);
    });
}

static bool writer_finish(WrCodecWriter *writer, bool, char *reason)
{
    bool ok = guarded(reason, [&] {
        errno = 0;
        bool closed = check_write(*writer, writer->out->close(), reason);
        writer->out.reset(); /* for mip levels the library reports their positions only now */
        if (writer->disk) writer->disk->empty();
        if (!closed || !writer->disk || !writer->disk->error) return closed;
        return fail(reason, std::strerror(writer->disk->error));
    });
    delete writer;
    return ok;
}

/* ---- colour configurations ---- */

struct WrCodecView {
    OIIO::ColorProcessorHandle processor;
};

/* Fails unless the name is one of those; the message lists them. */
static bool check_name(const char *kind, const std::string &name,
                       const std::vector<std::string> &known, char *reason)
{
    std::string list;
    for (const std::string &one : known) {
        if (one == name) return true;
        list += (list.empty() ? "" : ", ") + one;
    }
    return fail(reason, "has no " + std::string(kind) + " '" + name + "', but " +
                            (list.empty() ? "none" : list));
}

static bool create_view(const char *config, const std::string &display, const std::string &view,
                        const std::string &space, WrCodecView &out, char *reason)
{
    OIIO::ColorConfig colours(config);
    if (colours.has_error())
        return fail(reason, "is no colour configuration: " + colours.geterror());
    const char *usual = colours.getDefaultDisplayName();
    const std::string shown = display.empty() && usual ? usual : display;
    if (!check_name("display", shown, colours.getDisplayNames(), reason) ||
        !check_name("view", view, colours.getViewNames(shown), reason) ||
        (!space.empty() &&
         !check_name("colour space", space, colours.getColorSpaceNames(), reason)))
        return false;
    const char *linear = colours.getColorSpaceNameByRole("scene_linear");
    if (space.empty() && !linear)
        return fail(reason, "has no role scene_linear: add space=NAME, the colour space of light");
    out.processor = colours.createDisplayTransform(shown, view, space.empty() ? linear : space);
    return out.processor || fail(reason, colours.geterror());
}

static WrCodecView *view_create(const char *config, const char *display, const char *view,
                                const char *space, char *reason)
{
    auto made = std::make_unique<WrCodecView>();
    const bool good =
        guarded(reason, [&] { return create_view(config, display, view, space, *made, reason); });
    return good ? made.release() : nullptr;
}

static void view_apply(const WrCodecView *view, float *rgb, int count)
{
    view->processor->apply(rgb, count, 1, 3, sizeof(float), 3 * sizeof(float),
                           3 * static_cast<OIIO::stride_t>(sizeof(float)) * count);
}

extern "C" __attribute__((visibility("default"))) const WrCodec wr_oiio_table;
const WrCodec wr_oiio_table = {
    WR_OIIO_VERSION,  reader_open, reader_close,  reader_parts, reader_part,
    reader_attribute, reader_read, writer_create, writer_write, writer_next,
    writer_finish,    view_create, view_apply,
};

/* oiio_values.hpp - conversion of file values to WrImage: codes, numbers, inverted greys, missing
   values, the display window. C++, only in the module.
   Private to this module.

   OpenImageIO scales every integer to 0..1 or -1..1, inverts a TIFF whose photometric interpretation is
   "min is white" at 8 bits only (alpha included), ignores FITS's BZERO and BSCALE, the no-data value of
   GDAL and the display window of OpenEXR. All conversions are chosen here, once, when a part is opened. */
#pragma once
#include "image/oiio_fail.hpp"
#include "image/oiio_fits.hpp"
#include "image/oiio_tiff.hpp"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

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
inline double last_code(OIIO::TypeDesc type)
{
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8: return 255.0;
    case OIIO::TypeDesc::UINT16: return 65535.0;
    case OIIO::TypeDesc::UINT32: return 4294967295.0;
    default: return 0.0;
    }
}

inline bool is_integer(OIIO::TypeDesc type)
{
    return !type.is_floating_point();
}

/* Signed integers, and unsigned ones of 32 bits in OpenEXR (IDs), are numbers; other integers are codes. */
inline void choose_numbers(const OIIO::ImageSpec &spec, const std::string &format, Values &values)
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
inline void choose_fits(const OIIO::ImageSpec &spec, int fd, int picture, Values &values)
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
inline bool tiff_has_numbers(const OIIO::ImageSpec &spec, bool measured, bool numbers)
{
    if (spec.format == OIIO::TypeDesc::UINT32) return measured || numbers;
    const bool inverted = spec.format == OIIO::TypeDesc::UINT8 &&
                          spec.get_int_attribute("tiff:PhotometricInterpretation", 1) == 0;
    return measured && numbers && !inverted;
}

/* TIFF: photometric interpretation 0; GDAL's no-data value; voids of signed elevations. */
inline bool choose_tiff(const OIIO::ImageSpec &spec, int fd, int directory, bool numbers,
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

inline std::string size_text(int width, int height)
{
    return std::to_string(width) + "x" + std::to_string(height);
}

/* OpenEXR: the picture is the display window; pixels are stored for the data window, which may be
   smaller or larger. All parts of a file share one display window, so it is used only for parts with
   the first part's data window: others, such as those of the program's documents, are pictures of their
   own size. */
inline void choose_window(const OIIO::ImageSpec &spec, const std::string &format, Values &values,
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
inline bool is_no_data(float x, double no_data)
{
    if (std::fabs(no_data) > 1e30) return no_data > 0.0 ? x > 1e30f : x < -1e30f;
    return x == static_cast<float>(no_data);
}

/* Converts rows from the library to values of WrImage. */
template <typename Code>
inline void decode_codes(const Code *codes, size_t count, const Values &values, float *out)
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

inline void decode_values(const void *codes, size_t pixels, int channels, const Values &values,
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
inline bool changes_floats(const Values &values)
{
    return values.has_no_data || values.invert || values.restore_alpha || !values.restore.empty() ||
           values.scale != 1.0 || values.offset != 0.0;
}

/* oiio.cpp - the module wrinkle_oiio.so; the only file that uses OpenImageIO. Its interface is oiio.h.

   Workarounds for the library:
   - reading a damaged TIFF always succeeds and only sets an error message: after every call a message
     counts as failure;
   - few readers enforce size limits: the checks here are the effective ones;
   - integer codes are multiplied by float factors, and other header properties are ignored:
     oiio_values.hpp;
   - alpha is multiplied into colours by default;
   - libjpeg exits the whole program when it cannot write: it never receives a write error;
   - multi-part EXR and TIFF are written to a file that the library opens, and failures at the end are
     not reported: the caller passes a memory file and reads it back; libtiff's error messages are
     intercepted. */
extern "C" {
#include "image/oiio.h"
}

#include "image/oiio_disk.hpp"
#include "image/oiio_fail.hpp"
#include "image/oiio_tiff.hpp"
#include "image/oiio_values.hpp"
#include "system/fd.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

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
    std::string path; /* of fd, for formats that need a path (system/sandbox_open.h) and for
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
    bool ok;
    if (spec.tile_width)
        ok = reader.in->read_tiles(subimage, level, spec.x, spec.x + spec.width, top, top + rows,
                                   spec.z, spec.z + 1, 0, channels, values.type, to);
    else if (!std::strcmp(reader.in->format_name(), "fits"))
        ok = read_fits_rows(reader, part, top, rows, channels, values.type, to);
    else
        ok = reader.in->read_scanlines(subimage, level, top, top + rows, spec.z, 0, channels,
                                       values.type, to);
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

extern "C" __attribute__((visibility("default"))) const WrCodec wr_oiio_table;
const WrCodec wr_oiio_table = {
    WR_OIIO_VERSION, reader_open,   reader_close, reader_parts, reader_part,   reader_attribute,
    reader_read,     writer_create, writer_write, writer_next,  writer_finish,
};

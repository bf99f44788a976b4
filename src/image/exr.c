/* Source: OpenEXR File Layout. A chunk of 16 rows (ZIP), or 1 (ZIPS, NONE), has for each row all values of one channel
   after the other, channels sorted by name. ZIP: the bytes are divided into those of even and of odd index, each byte
   becomes the difference to the one before it plus 128, and zlib compresses the result. A chunk that does not become
   smaller is stored as it is; readers see that by its size. */
#include "image/exr.h"

#include "base/memory.h"
#include "base/pool.h"
#include "system/fd.h"

#include <errno.h>
#include <libdeflate.h>
#include <openexr.h>
#include <stdio.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "chunks are little-endian");

#define CHANNELS 3             /* R, G, B; else one */
#define CHUNK_ROWS 16          /* of ZIP */
#define MARK "wrinkle:version" /* the attribute of a document's first part */
#define FILE_NAME "document"   /* the library opens no file, but requires a name */

static bool fail(char *reason, const char *why)
{
    snprintf(reason, WR_CODEC_REASON, "%s", why);
    return false;
}

static bool fail_code(char *reason, exr_result_t code)
{
    return fail(reason, code == EXR_ERR_OUT_OF_MEMORY ? WR_CODEC_NO_MEMORY
                                                      : exr_get_default_error_message(code));
}

/* Without it the library prints to standard error. */
static void ignore_message(exr_const_context_t file, exr_result_t code, const char *message)
{
    (void)file, (void)code, (void)message;
}

/* ---- ZIP ---- */

/* count: even. */
static void zip_order(const uint8_t *bytes, size_t count, uint8_t *out)
{
    const size_t half = count / 2;
    for (size_t i = 0; i < half; i++) {
        const uint8_t even = bytes[2 * i], before = i ? bytes[2 * i - 2] : 0;
        const uint8_t odd = bytes[2 * i + 1], odd_before = i ? bytes[2 * i - 1] : 0;
        out[i] = (uint8_t)(even - before + 128);
        out[half + i] = (uint8_t)(odd - odd_before + 128);
    }
    /* the first byte is stored as it is; the first odd one follows the last even one */
    out[0] = bytes[0];
    out[half] = (uint8_t)(bytes[1] - bytes[count - 2] + 128);
}

/* Even and odd bytes at once: two sums that do not wait for each other. */
static void zip_undo(const uint8_t *bytes, size_t count, uint8_t *out)
{
    const size_t half = count / 2;
    uint8_t even = 128, odd = 128;
    for (size_t i = 0; i < half; i++) odd = (uint8_t)(odd + bytes[i] - 128);
    for (size_t i = 0; i < half; i++) {
        even = (uint8_t)(even + bytes[i] - 128);
        odd = (uint8_t)(odd + bytes[half + i] - 128);
        out[2 * i] = even;
        out[2 * i + 1] = odd;
    }
}

/* ---- reading ---- */

struct WrCodecReader {
    exr_context_t file;
    int fd;
    int count; /* parts */
    WrCodecPart *parts;
    int *rows; /* of a chunk, for each part */
    struct libdeflate_decompressor *inflater;
    /* The last chunk, of `room` bytes each. Equal packed bytes, of a constant mask, are not unpacked again. */
    uint8_t *memory, *packed, *before, *bytes, *values;
    size_t room, packed_size; /* of `before`, whose values are in `values`; 0: none */
    int part, chunk;          /* of `values`; -1: none */
};

static int64_t read_at(exr_const_context_t file, void *from, void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t report)
{
    (void)file, (void)report;
    const WrCodecReader *reader = from;
    return wr_fd_read_at(reader->fd, buffer, (size_t)size, (int64_t)offset);
}

static int64_t size_of(exr_const_context_t file, void *from)
{
    (void)file;
    const WrCodecReader *reader = from;
    WrFileInfo info;
    return wr_fd_info(reader->fd, &info) ? info.bytes : -1;
}

/* Names of the channels if they are floats named B, G, R, or one channel; else NULL. */
static const char *const *channels_of(exr_const_context_t file, int part, int *count)
{
    static const char *const colours[CHANNELS] = { "R", "G", "B" };
    static const char *const grey[] = { "Y" };
    const exr_attr_chlist_t *list;
    if (exr_get_channels(file, part, &list) != EXR_ERR_SUCCESS) return NULL;
    *count = list->num_channels;
    for (int c = 0; c < *count && c < CHANNELS; c++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[c];
        const char *want = *count == 1 ? grey[0] : colours[CHANNELS - 1 - c];
        if (entry->pixel_type != EXR_PIXEL_FLOAT || entry->x_sampling != 1 ||
            entry->y_sampling != 1 || strcmp(entry->name.str, want) != 0)
            return NULL;
    }
    return *count == 1 ? grey : *count == CHANNELS ? colours : NULL;
}

static bool same_box(const exr_attr_box2i_t *a, const exr_attr_box2i_t *b)
{
    return a->min.x == b->min.x && a->min.y == b->min.y && a->max.x == b->max.x &&
           a->max.y == b->max.y;
}

/* All parts share the display window, which is the first part's data window. */
static bool open_part(WrCodecReader *reader, int part)
{
    exr_const_context_t file = reader->file;
    exr_storage_t storage;
    exr_compression_t compression;
    exr_attr_box2i_t data, display, first;
    int32_t rows;
    int channels;
    const char *name = NULL, *const *names = channels_of(file, part, &channels);
    if (!names || exr_get_storage(file, part, &storage) != EXR_ERR_SUCCESS ||
        exr_get_compression(file, part, &compression) != EXR_ERR_SUCCESS ||
        exr_get_data_window(file, part, &data) != EXR_ERR_SUCCESS ||
        exr_get_display_window(file, part, &display) != EXR_ERR_SUCCESS ||
        exr_get_data_window(file, 0, &first) != EXR_ERR_SUCCESS ||
        exr_get_scanlines_per_chunk(file, part, &rows) != EXR_ERR_SUCCESS)
        return false;
    exr_get_name(file, part, &name);
    if (storage != EXR_STORAGE_SCANLINE || rows < 1 || rows > CHUNK_ROWS || data.min.x != 0 ||
        data.min.y != 0 || data.max.x >= WR_IMAGE_MAX || data.max.y >= WR_IMAGE_MAX ||
        data.max.x < 0 || data.max.y < 0 || !same_box(&display, &first) ||
        (compression != EXR_COMPRESSION_NONE && compression != EXR_COMPRESSION_ZIP &&
         compression != EXR_COMPRESSION_ZIPS))
        return false;
    const size_t bytes = (size_t)rows * (size_t)(data.max.x + 1) * (size_t)channels * sizeof(float);
    if (bytes > reader->room) reader->room = bytes;
    reader->rows[part] = rows;
    reader->parts[part].part = (WrImagePart){ .name = name ? name : "",
                                              .width = data.max.x + 1,
                                              .height = data.max.y + 1,
                                              .channels = channels,
                                              .type = WR_PIXEL_F32,
                                              .channel_names = names };
    return true;
}

static const char *attribute(const WrCodecReader *reader, int part, const char *name)
{
    const exr_attribute_t *found;
    if (exr_get_attribute_by_name(reader->file, part, name, &found) != EXR_ERR_SUCCESS ||
        found->type != EXR_ATTR_STRING)
        return NULL;
    return found->string->str ? found->string->str : "";
}

static bool open_all(WrCodecReader *reader, int most)
{
    const exr_context_initializer_t start = { .size = sizeof start,
                                              .error_handler_fn = ignore_message,
                                              .user_data = reader,
                                              .read_fn = read_at,
                                              .size_fn = size_of,
                                              .zip_level = -2,
                                              .dwa_quality = -1.0f,
                                              .flags =
                                                  EXR_CONTEXT_FLAG_SILENT_HEADER_PARSE |
                                                  EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION };
    if (exr_start_read(&reader->file, FILE_NAME, &start) != EXR_ERR_SUCCESS ||
        exr_get_count(reader->file, &reader->count) != EXR_ERR_SUCCESS)
        return false;
    if (reader->count < 1 || !attribute(reader, 0, MARK)) return false;
    if (most == 1) reader->count = 1;
    if (reader->count > most) return false;
    reader->parts = wr_alloc((size_t)reader->count, sizeof *reader->parts);
    reader->rows = wr_alloc((size_t)reader->count, sizeof *reader->rows);
    for (int i = 0; i < reader->count; i++)
        if (!open_part(reader, i)) return false;
    reader->inflater = libdeflate_alloc_decompressor();
    reader->memory = wr_try_alloc(reader->room, 4, "rows of a picture", NULL);
    if (!reader->memory || !reader->inflater) return false;
    reader->packed = reader->memory;
    reader->before = reader->packed + reader->room;
    reader->bytes = reader->before + reader->room;
    reader->values = reader->bytes + reader->room;
    return true;
}

static void reader_close(WrCodecReader *reader)
{
    exr_finish(&reader->file);
    if (reader->inflater) libdeflate_free_decompressor(reader->inflater);
    wr_free(reader->memory);
    wr_free(reader->parts);
    wr_free(reader->rows);
    wr_free(reader);
}

static WrCodecReader *reader_open(int fd, const char *format, int most, bool numbers, char *reason)
{
    (void)format, (void)numbers;
    *reason = '\0';
    if (most == WR_CODEC_LEVELS) return NULL;
    WrCodecReader *reader = wr_alloc(1, sizeof *reader);
    *reader = (WrCodecReader){ .fd = fd, .part = -1 };
    if (open_all(reader, most)) return reader;
    reader_close(reader);
    return NULL;
}

static int reader_parts(const WrCodecReader *reader)
{
    return reader->count;
}

static const WrCodecPart *reader_part(const WrCodecReader *reader, int part)
{
    return &reader->parts[part];
}

/* Unpacks packed bytes to reader->values. */
static bool unpack(WrCodecReader *reader, size_t size, size_t bytes, char *reason)
{
    uint8_t *packed = reader->packed;
    if (size == reader->packed_size && memcmp(packed, reader->before, size) == 0) return true;
    reader->packed_size = 0;
    if (libdeflate_zlib_decompress(reader->inflater, packed, size, reader->bytes, bytes, NULL) !=
        LIBDEFLATE_SUCCESS)
        return fail(reason, "compressed data are damaged");
    zip_undo(reader->bytes, bytes, reader->values);
    reader->packed = reader->before;
    reader->before = packed;
    reader->packed_size = size;
    return true;
}

/* Reads chunk `chunk` to `out`, or to reader->values if that is NULL or the chunk is packed. *values: where they are. */
static bool read_chunk(WrCodecReader *reader, int part, int chunk, uint8_t *out,
                       const uint8_t **values, char *reason)
{
    const WrImagePart *is = &reader->parts[part].part;
    const int y = chunk * reader->rows[part];
    const int rows = is->height - y < reader->rows[part] ? is->height - y : reader->rows[part];
    const size_t bytes = (size_t)rows * (size_t)is->width * (size_t)is->channels * sizeof(float);
    exr_chunk_info_t info;
    *values = reader->values;
    if (reader->part == part && reader->chunk == chunk) return true;
    reader->part = -1;
    exr_result_t code = exr_read_scanline_chunk_info(reader->file, part, y, &info);
    if (code != EXR_ERR_SUCCESS) return fail_code(reason, code);
    if (info.unpacked_size != bytes || info.packed_size > bytes || info.start_y != y)
        return fail(reason, "a chunk has an impossible size");
    const bool packed = info.packed_size < bytes;
    if (!packed && out) *values = out;
    uint8_t *to = packed ? reader->packed : out ? out : reader->values;
    if (!packed && !out) reader->packed_size = 0;
    code = exr_read_chunk(reader->file, part, &info, to);
    if (code != EXR_ERR_SUCCESS) return fail_code(reason, code);
    if (packed && !unpack(reader, (size_t)info.packed_size, bytes, reason)) return false;
    if (*values != reader->values) return true;
    reader->part = part;
    reader->chunk = chunk;
    return true;
}

/* Row `row` of a chunk's values, interleaved; from 3 channels: B, G, R in the chunk. */
static void copy_row(const uint8_t *values, const WrImagePart *is, int row, int channels,
                     float *out)
{
    const size_t width = (size_t)is->width, line = width * sizeof(float);
    const uint8_t *from = values + (size_t)row * line * (size_t)is->channels;
    if (is->channels == 1) {
        memcpy(out, from, line);
        return;
    }
    for (int c = 0; c < channels; c++) {
        const uint8_t *plane = from + (size_t)(CHANNELS - 1 - c) * line;
        for (size_t x = 0; x < width; x++)
            memcpy(&out[x * (size_t)channels + (size_t)c], plane + x * sizeof(float),
                   sizeof(float));
    }
}

static bool reader_read(WrCodecReader *reader, int part, int y, int rows, int channels, float *out,
                        char *reason)
{
    const WrImagePart *is = &reader->parts[part].part;
    const size_t row = (size_t)is->width * (size_t)channels;
    const int each = reader->rows[part], end = y + rows;
    *reason = '\0';
    while (y < end) {
        const int chunk = y / each, first = y - chunk * each;
        const int last = is->height - chunk * each < each ? is->height - chunk * each : each;
        const int take = last - first < end - y ? last - first : end - y;
        const bool whole = is->channels == 1 && first == 0 && take == last;
        const uint8_t *values;
        if (!read_chunk(reader, part, chunk, whole ? (uint8_t *)out : NULL, &values, reason))
            return false;
        for (int k = 0; k < take && values != (const uint8_t *)out; k++)
            copy_row(values, is, first + k, channels, out + (size_t)k * row);
        out += (size_t)take * row;
        y += take;
    }
    return true;
}

/* ---- writing ---- */

/* Bytes of a chunk that are compressed for a trial, and the part of their size that must be saved: of noise ZIP saves
   7 % and needs most of the time. */
#define TRIAL 4096
#define TRIAL_PIECES 2
#define WORTH 0.85
#define LEVEL 1 /* of libdeflate; about 1 % larger than zlib's 4 in a third of the time */

#define PACKERS (WR_IMAGE_STRIP / CHUNK_ROWS) /* chunks of a strip, packed at once */

/* Compresses every PACKERS-th chunk of a part. */
typedef struct Packer {
    struct libdeflate_compressor *deflater;
    /* A chunk's values if they must be sorted, the bytes to compress, those compressed, and the values of the last
       compressed chunk, of `room` bytes each. */
    uint8_t *memory, *bytes, *packed, *before;
    size_t packed_size, before_size; /* before_size 0: none */
    /* of the present chunk: */
    int rows;
    const uint8_t *values;
    size_t size;
    bool smaller; /* `packed` is stored in place of `values` */
} Packer;

struct WrCodecWriter {
    exr_context_t file;
    WrByteSink sink;
    int error; /* errno of the sink's first failure */
    int part;
    const WrImageOut *parts;
    size_t room;
    int packers;
    Packer packer[PACKERS];
};

static int64_t write_at(exr_const_context_t file, void *to, const void *bytes, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t report)
{
    (void)file, (void)report;
    WrCodecWriter *writer = to;
    if (!writer->error && !writer->sink.write(writer->sink.to, bytes, size, (int64_t)offset))
        writer->error = errno;
    return writer->error ? -1 : (int64_t)size;
}

bool wr_exr_writes(const char *format, const WrImageOut *parts, int count)
{
    bool marked = false, plain = strcmp(format, "openexr") == 0;
    for (int i = 0; i < parts[0].attribute_count; i++)
        marked |= strcmp(parts[0].attributes[i].name, MARK) == 0;
    for (int i = 0; i < count; i++)
        plain = plain && parts[i].type == WR_PIXEL_F32 && !parts[i].channel_names &&
                (parts[i].channels == 1 || parts[i].channels == CHANNELS) && !parts[i].half &&
                !parts[i].levels && !parts[i].profile && parts[i].part_name;
    return marked && plain;
}

static exr_result_t add_part(WrCodecWriter *writer, const WrImageOut *part)
{
    static const char *const names[CHANNELS] = { "B", "G", "R" };
    const exr_attr_box2i_t display = { .max = { .x = writer->parts[0].width - 1,
                                                .y = writer->parts[0].height - 1 } };
    const exr_attr_box2i_t data = { .max = { .x = part->width - 1, .y = part->height - 1 } };
    const exr_attr_v2f_t centre = { .x = 0.0f };
    int index;
    exr_result_t code = exr_add_part(writer->file, part->part_name, EXR_STORAGE_SCANLINE, &index);
    if (!code)
        code = exr_initialize_required_attr(writer->file, index, &display, &data, 1.0f, &centre,
                                            1.0f, EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP);
    for (int c = 0; c < part->channels && !code; c++)
        code = exr_add_channel(writer->file, index, part->channels == 1 ? "Y" : names[c],
                               EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (int i = 0; i < part->attribute_count && !code; i++)
        code = exr_attr_set_string(writer->file, index, part->attributes[i].name,
                                   part->attributes[i].text);
    const size_t bytes = CHUNK_ROWS * (size_t)part->width * (size_t)part->channels * sizeof(float);
    if (bytes > writer->room) writer->room = bytes;
    return code;
}

static bool writer_check(const WrCodecWriter *writer, exr_result_t code, char *reason)
{
    if (writer->error) return fail(reason, strerror(writer->error));
    return code == EXR_ERR_SUCCESS || fail_code(reason, code);
}

static bool begin_packer(Packer *packer, size_t room)
{
    packer->deflater = libdeflate_alloc_compressor(LEVEL);
    packer->memory = wr_try_alloc_unset(room, 4, "rows of a picture", NULL);
    if (!packer->deflater || !packer->memory) return false;
    packer->bytes = packer->memory + room;
    packer->packed = packer->bytes + room;
    packer->before = packer->packed + room;
    return true;
}

static bool create(WrCodecWriter *writer, int count, char *reason)
{
    const exr_context_initializer_t start = { .size = sizeof start,
                                              .error_handler_fn = ignore_message,
                                              .user_data = writer,
                                              .write_fn = write_at,
                                              .zip_level = -2,
                                              .dwa_quality = -1.0f };
    exr_result_t code = exr_start_write(&writer->file, FILE_NAME, EXR_WRITE_FILE_DIRECTLY, &start);
    for (int i = 0; i < count && !code; i++) code = add_part(writer, &writer->parts[i]);
    if (!code) code = exr_write_header(writer->file);
    if (!writer_check(writer, code, reason)) return false;
    const int threads = wr_pool_threads(writer->parts[0].pool);
    writer->packers = threads < PACKERS ? threads : PACKERS;
    for (int k = 0; k < writer->packers; k++)
        if (!begin_packer(&writer->packer[k], writer->room))
            return fail(reason, WR_CODEC_NO_MEMORY);
    return true;
}

static bool writer_finish(WrCodecWriter *writer, bool keep, char *reason)
{
    const exr_result_t code = exr_finish(&writer->file);
    const bool good = !keep || writer_check(writer, code, reason);
    for (int k = 0; k < writer->packers; k++) {
        if (writer->packer[k].deflater) libdeflate_free_compressor(writer->packer[k].deflater);
        wr_free(writer->packer[k].memory);
    }
    wr_free(writer);
    return good;
}

static WrCodecWriter *writer_create(const WrByteSink *to, int spool, const char *format,
                                    const WrImageOut *parts, int count, char *reason)
{
    (void)spool, (void)format;
    WrCodecWriter *writer = wr_alloc(1, sizeof *writer);
    *writer = (WrCodecWriter){ .sink = *to, .parts = parts };
    if (create(writer, count, reason)) return writer;
    writer_finish(writer, false, reason);
    return NULL;
}

/* Rows in the order of a chunk. */
static void plan_rows(const WrImageOut *part, const float *pixels, int rows, uint8_t *out)
{
    const size_t width = (size_t)part->width;
    for (int y = 0; y < rows; y++, pixels += CHANNELS * width)
        for (int c = CHANNELS - 1; c >= 0; c--, out += width * sizeof(float))
            for (size_t x = 0; x < width; x++)
                memcpy(out + x * sizeof(float), &pixels[x * CHANNELS + (size_t)c], sizeof(float));
}

/* True if compressing a few pieces of the chunk saves enough. */
static bool is_worth(Packer *packer)
{
    uint8_t *piece = packer->packed;
    size_t length = 0;
    for (int k = 0; k < TRIAL_PIECES; k++, length += TRIAL)
        memcpy(piece + length,
               packer->values + (packer->size / TRIAL_PIECES * (size_t)k & ~(size_t)3), TRIAL);
    zip_order(piece, length, packer->bytes);
    return libdeflate_zlib_compress(packer->deflater, packer->bytes, length, piece,
                                    (size_t)(WORTH * (double)length)) > 0;
}

/* Compresses the present chunk; false if it stays as it is. */
static bool pack_smaller(Packer *packer)
{
    const size_t size = packer->size;
    if (size == packer->before_size && memcmp(packer->values, packer->before, size) == 0)
        return true;
    packer->before_size = 0;
    if (size >= 4 * TRIAL_PIECES * TRIAL && !is_worth(packer)) return false;
    zip_order(packer->values, size, packer->bytes);
    packer->packed_size =
        libdeflate_zlib_compress(packer->deflater, packer->bytes, size, packer->packed, size - 1);
    if (packer->packed_size == 0) return false;
    memcpy(packer->before, packer->values, size);
    packer->before_size = size;
    return true;
}

static void pack(int index, int worker, void *ctx)
{
    WrCodecWriter *writer = ctx;
    Packer *packer = &writer->packer[index];
    (void)worker;
    if (writer->parts[writer->part].channels == CHANNELS) {
        plan_rows(&writer->parts[writer->part], (const float *)(const void *)packer->values,
                  packer->rows, packer->memory);
        packer->values = packer->memory;
    }
    packer->smaller = pack_smaller(packer);
}

/* Packs as many chunks at once as there are packers, and writes them in their order: the file's bytes do not depend on
   the number of threads. */
static bool writer_write(WrCodecWriter *writer, int y, int rows, const void *pixels, char *reason)
{
    const WrImageOut *part = &writer->parts[writer->part];
    const size_t row = (size_t)part->width * (size_t)part->channels * sizeof(float);
    const uint8_t *from = pixels;
    exr_result_t code = EXR_ERR_SUCCESS;
    for (const int end = y + rows; y < end && !code;) {
        int count = 0;
        for (int at = y; at < end && count < writer->packers; count++) {
            Packer *packer = &writer->packer[count];
            packer->rows = end - at < CHUNK_ROWS ? end - at : CHUNK_ROWS;
            packer->size = (size_t)packer->rows * row;
            packer->values = from;
            from += packer->size;
            at += packer->rows;
        }
        if (!wr_pool_run(writer->parts[0].pool, count, pack, writer))
            return fail(reason, "cancelled");
        for (int k = 0; k < count && !code; k++) {
            const Packer *packer = &writer->packer[k];
            code = exr_write_scanline_chunk(writer->file, writer->part, y,
                                            packer->smaller ? packer->packed : packer->values,
                                            packer->smaller ? packer->packed_size : packer->size);
            y += packer->rows;
        }
    }
    return writer_check(writer, code, reason);
}

static bool writer_next(WrCodecWriter *writer, char *reason)
{
    (void)reason;
    writer->part++;
    return true;
}

const WrCodec wr_exr_codec = {
    .open = reader_open,
    .close = reader_close,
    .parts = reader_parts,
    .part = reader_part,
    .attribute = attribute,
    .read = reader_read,
    .create = writer_create,
    .write = writer_write,
    .next = writer_next,
    .finish = writer_finish,
};

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/spool.h"
#include "image/decode.h"
#include "image/exr.h"
#include "image/exr_written_check.h"
#include "image/image.h"
#include "image/oiio.h"
#include "image/read_internal.h"
#include "image/readback.h"
#include "system/fd.h"
#include "system/process.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

/* ---- check of a written file ---- */

/* Opens the same file again, with a position of its own. */
static int open_again(int fd, WrError *err)
{
    int again = wr_fd_reopen(fd);
    if (again < 0) wr_fail(err, "%s", strerror(errno));
    return again;
}

static bool verify_texts(WrImageFile *file, int index, const WrImageOut *part, WrError *err)
{
    for (int i = 0; i < part->attribute_count; i++) {
        const char *want = part->attributes[i].text;
        const char *have = wr_image_file_attribute(file, index, part->attributes[i].name);
        if (strcmp(have ? have : "", want) != 0)
            return wr_fail(err, "%.80s of part %d differs from the picture that was written",
                           part->attributes[i].name, index + 1);
    }
    return true;
}

#define MAX_CHANNELS 64 /* maximum number of channels that may be reordered in the file */

/* EXR sorts channels by their names: channel c of the part is channel from[c] of the file. *moved: the
 * order differs. False if the channels differ. */
static bool find_channels(const WrImageOut *part, const WrImagePart *is, int from[MAX_CHANNELS],
                          bool *moved)
{
    *moved = false;
    if (is->channels != part->channels || part->channels > MAX_CHANNELS) return false;
    for (int c = 0; part->channel_names && c < is->channels; c++) {
        int at = 0;
        while (at < is->channels && strcmp(part->channel_names[c], is->channel_names[at]) != 0)
            at++;
        if (at == is->channels) return false;
        from[c] = at;
        *moved |= at != c;
    }
    return true;
}

/* Reorders values from the file's order to the part's. */
static void put_in_order(const int *from, int channels, size_t texels, const float *values,
                         float *out)
{
    for (size_t i = 0; i < texels; i++)
        for (int c = 0; c < channels; c++)
            out[i * (size_t)channels + (size_t)c] = values[i * (size_t)channels + (size_t)from[c]];
}

/* Rows are transferred in a memory file, two strips at a time at most, to which the file size limit
 * applies too; digests need no file. */
static bool rows_fit(const WrImageOut *part)
{
    const size_t row = (size_t)part->width * (size_t)part->channels * sizeof(float);
    return 2 * (uint64_t)row * WR_IMAGE_STRIP < wr_process_file_limit();
}

/* Passes strips to the digest and to the `seen` callback. from: channel order in the file; NULL: the
 * part's order. */
static bool show_rows(WrImageFile *file, int index, const WrImageOut *part, bool exact,
                      const int *from, WrHash *have, WrError *err)
{
    const size_t row = (size_t)part->width * (size_t)part->channels;
    const size_t strip = row * WR_IMAGE_STRIP;
    float *values =
        wr_try_alloc(from ? 2 * strip : strip, sizeof *values, "rows of a picture", err);
    float *shown = from ? values + strip : values;
    bool good = values != NULL;
    for (int y = 0; y < part->height && good; y += WR_IMAGE_STRIP) {
        int rows = part->height - y < WR_IMAGE_STRIP ? part->height - y : WR_IMAGE_STRIP;
        good = (!wr_progress_stopped() || wr_fail(err, "cancelled")) &&
               wr_image_file_read_rows(file, index, y, rows, values, err);
        if (good) wr_digest_strip(have, values, row * (size_t)rows);
        if (good && from)
            put_in_order(from, part->channels, (size_t)part->width * (size_t)rows, values, shown);
        good = good && part->seen(part->ctx, y, rows, shown, exact, err);
    }
    wr_free(values);
    return good;
}

static bool digest_rows(WrImageFile *file, int index, int height, WrHash *have, WrError *err)
{
    for (int y = 0; y < height; y += WR_IMAGE_BAND) {
        int rows = height - y < WR_IMAGE_BAND ? height - y : WR_IMAGE_BAND;
        if (!wr_image_file_digest(file, index, y, rows, have, err)) return false;
    }
    return true;
}

static bool verify_part(WrImageFile *file, int index, const WrImageFormat *format,
                        const WrImageOut *part, WrHash want, WrError *err)
{
    WrImagePart is = wr_image_file_part(file, index);
    WrHash have = { 0 };
    bool exact = format->exact && !(part->channel_names && part->channels > 1);
    if (is.width != part->width || is.height != part->height)
        return wr_fail(err, "part %d is %dx%d, not %dx%d", index + 1, is.width, is.height,
                       part->width, part->height);
    if (exact && is.channels != part->channels)
        return wr_fail(err, "part %d has %d channels, not %d", index + 1, is.channels,
                       part->channels);
    int from[MAX_CHANNELS];
    bool moved;
    bool shown = part->seen && find_channels(part, &is, from, &moved) && rows_fit(part);
    if (!(shown ? show_rows(file, index, part, format->exact, moved ? from : NULL, &have, err)
                : digest_rows(file, index, is.height, &have, err)))
        return false;
    if (exact && !wr_hash_equal(have, want))
        return wr_fail(err, "texels of part %d are not what was written", index + 1);
    /* Other formats store all texts as lines of one, if at all. */
    return strcmp(format->library, "openexr") != 0 || verify_texts(file, index, part, err);
}

bool wr_image_verify(const char *name, int fd, const WrImageFormat *format, const WrImageOut *parts,
                     int count, const WrHash *digests, WrError *err)
{
    WrError inner = { "" };
    WrImageFile *file = wr_image_file_take(name, open_again(fd, &inner), parts[0].levels, &inner);
    bool good = file != NULL;
    if (good && strcmp(format->library, "openexr") == 0) good = wr_exr_check_chunks(fd, &inner);
    if (good && wr_image_file_parts(file) != count)
        good = wr_fail(&inner, "%d parts, not %d", wr_image_file_parts(file), count);
    for (int i = 0; i < count && good; i++)
        good = verify_part(file, i, format, &parts[i], digests[i], &inner);
    wr_image_file_close(file);
    if (good) return true;
    size_t length = strlen(name);
    bool named = strncmp(inner.text, name, length) == 0 && inner.text[length] == ':';
    return wr_fail(err, "it does not read back as it was written: %s",
                   named ? inner.text + length + 2 : wr_error_message(&inner));
}

/* ---- writing ---- */

#define PIECE_BYTES (1 << 20)

void wr_image_warm_writing(void)
{
    wr_oiio_warm();
}

static size_t type_bytes(WrPixelType type)
{
    return type == WR_PIXEL_U8 ? 1 : type == WR_PIXEL_U16 ? 2 : 4;
}

static bool check_parts(const char *path, const WrImageOut *parts, int count, WrError *err)
{
    const WrImageFormat *format = wr_image_format(path, err);
    if (!format) return false;
    if (count < 1 || count > WR_IMAGE_PARTS_MAX)
        return wr_fail(err, "%s: %d parts: must be 1..%d", path, count, WR_IMAGE_PARTS_MAX);
    const bool exr = strcmp(format->library, "openexr") == 0;
    if (count > 1 && !exr) return wr_fail(err, "%s: %d parts in one file need EXR", path, count);
    if ((parts[0].levels || parts[0].half) && !exr)
        return wr_fail(err, "%s: half floats, and mip levels in one file, need EXR", path);
    for (int i = 0; i < count; i++) {
        const WrImageOut *part = &parts[i];
        if (!wr_image_can_write(path, part->type, part->channels, part->data, err)) return false;
        if (part->width < 1 || part->width > WR_IMAGE_MAX || part->height < 1 ||
            part->height > WR_IMAGE_MAX)
            return wr_fail(err, "%s: picture of %dx%d: each side must be 1..%d", path, part->width,
                           part->height, WR_IMAGE_MAX);
    }
    return true;
}

/* The file size limit also applies to memory files, where libraries do not always report it. */
static bool is_cut(int fd)
{
    WrFileInfo info;
    return fd >= 0 && wr_fd_info(fd, &info) && (uint64_t)info.bytes >= wr_process_file_limit();
}

/* file: the written file, or -1. reason: the library's message, which may contain the system's. */
static bool fail_write(WrError *err, const char *path, int file, const char *reason)
{
    char text[WR_FILE_WHY];
    const char *why =
        is_cut(file) ? wr_file_why(EFBIG, text) : wr_file_why_of_library(reason, text);
    return wr_fail(err, "%s: cannot be written%s%s%s", path, *why ? " (" : "", why,
                   *why ? ")" : "");
}

typedef struct Writing {
    const char *path;
    int file;        /* final file, or -1 */
    WrByteSink sink; /* of that */
    WrSpool spool;   /* written first if the library writes by name; fd -1: none */
    const WrCodec *library;
    WrCodecWriter *writer;
    float *values; /* scratch: a strip as returned by a reader */
    int packed;    /* rows that are compressed together, or at once by several threads */
} Writing;

/* Expected digest of the strip when read back. */
static void digest_strip(const Writing *to, WrPixelType type, const void *pixels, size_t count,
                         WrHash *digest)
{
    const uint8_t *bytes = pixels;
    const uint16_t *words = pixels;
    const float *values = pixels;
    if (type != WR_PIXEL_F32) values = to->values;
    for (size_t i = 0; type == WR_PIXEL_U8 && i < count; i++)
        to->values[i] = (float)bytes[i] / 255.0f;
    for (size_t i = 0; type == WR_PIXEL_U16 && i < count; i++)
        to->values[i] = (float)words[i] / 65535.0f;
    wr_digest_strip(digest, values, count);
}

/* Maximum number of rows that a format compresses together. Pieces smaller than this would be compressed separately and make
   larger files. */
static int packed_rows(const char *format)
{
    return strcmp(format, "png") == 0 ? 1 : strcmp(format, "tiff") == 0 ? 32 : 16;
}

static bool fail_writing(const Writing *to, const char *reason, WrError *err)
{
    return fail_write(err, to->path, to->spool.fd >= 0 ? to->spool.fd : to->file, reason);
}

static bool spooled(const Writing *to, bool good, WrError *err)
{
    char why[WR_FILE_WHY];
    if (good) return true;
    if (errno == ECANCELED) return wr_fail(err, "cancelled");
    return fail_write(err, to->path, to->file, wr_file_why(errno, why));
}

/* Writes a strip in pieces small enough for frequent cancellation checks. row: bytes. */
static bool write_strip(Writing *to, int y, int rows, const void *pixels, size_t row, WrError *err)
{
    char reason[WR_CODEC_REASON] = "";
    int piece = WR_IMAGE_STRIP;
    while (piece > to->packed && (size_t)piece * row > PIECE_BYTES) piece /= 2;
    for (int first = 0; first < rows; first += piece) {
        int count = rows - first < piece ? rows - first : piece;
        const char *from = (const char *)pixels + (size_t)first * row;
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
        if (!to->library->write(to->writer, y + first, count, from, reason))
            return wr_progress_stopped() ? wr_fail(err, "cancelled")
                                         : fail_writing(to, reason, err);
    }
    return to->spool.fd < 0 || spooled(to, wr_spool_move(&to->spool, &to->sink), err);
}

/* While a strip is written its digest is updated; after the file is complete it is read back by the reader process, and the
   digests are compared: a full second copy in memory is not needed. */
static bool write_part(Writing *to, const WrImageOut *part, WrHash *digest, WrError *err)
{
    size_t row = (size_t)part->width * (size_t)part->channels;
    int strip = part->height < WR_IMAGE_STRIP ? part->height : WR_IMAGE_STRIP;
    void *pixels =
        wr_try_alloc(row * (size_t)strip, type_bytes(part->type), "rows of a picture", err);
    to->values = wr_try_alloc(row * (size_t)strip, sizeof(float), "rows of a picture", err);
    bool ok = pixels && to->values;
    for (int y = 0; y < part->height && ok; y += strip) {
        int rows = part->height - y < strip ? part->height - y : strip;
        if (part->reports ? wr_progress_stopped() : !wr_progress_report((double)y / part->height)) {
            ok = wr_fail(err, "cancelled");
            break;
        }
        ok = part->rows(part->ctx, y, rows, pixels, err);
        if (ok) digest_strip(to, part->type, pixels, row * (size_t)rows, digest);
        ok = ok && write_strip(to, y, rows, pixels, row * type_bytes(part->type), err);
    }
    wr_free(pixels);
    wr_free(to->values);
    return ok;
}

static bool write_parts(Writing *to, const char *format, const WrImageOut *parts, int count,
                        WrHash *digests, WrError *err)
{
    char reason[WR_CODEC_REASON] = "";
    to->writer = to->library->create(&to->sink, to->spool.fd, format, parts, count, reason);
    if (!to->writer) return fail_writing(to, reason, err);
    bool ok = true;
    for (int i = 0; i < count && ok; i++) {
        WrProgressPart share;
        const WrProgress *whole = wr_progress_enter(&share, (double)i / count, (i + 1.0) / count);
        if (i > 0 && !to->library->next(to->writer, reason)) ok = fail_writing(to, reason, err);
        ok = ok && write_part(to, &parts[i], &digests[i], err);
        wr_progress_set(whole);
    }
    bool whole = to->library->finish(to->writer, ok, reason);
    if (ok && !whole) ok = fail_writing(to, reason, err);
    if (ok && wr_progress_stopped()) ok = wr_fail(err, "cancelled"); /* rows may be missing */
    return ok;
}

/* sink: empty. file: its file, or -1. digests: [count], of the data written. */
static bool write_file(const char *path, WrByteSink sink, int file, const char *format,
                       const WrImageOut *parts, int count, WrHash *digests, WrError *err)
{
    char why[WR_FILE_WHY];
    const bool plain = wr_exr_writes(format, parts, count);
    Writing to = { .path = path,
                   .file = file,
                   .sink = sink,
                   .spool = { .fd = -1 },
                   .library = plain ? &wr_exr_codec : wr_codec(format, err),
                   .packed = plain             ? WR_IMAGE_STRIP
                             : parts[0].levels ? WR_IMAGE_TILE
                                               : packed_rows(format) };
    if (!to.library) return false;
    if (!plain && wr_oiio_by_name(format, parts, count) && !wr_spool_open(&to.spool))
        return fail_write(err, path, -1, wr_file_why(errno, why));
    bool ok = write_parts(&to, format, parts, count, digests, err);
    if (ok && to.spool.fd >= 0) ok = spooled(&to, wr_spool_end(&to.spool, &to.sink), err);
    wr_spool_close(&to.spool);
    return ok;
}

static bool write_target(WrFileTarget *target, const char *path, const WrImageFormat *format,
                         const WrImageOut *parts, int count, WrHash *digests, WrError *err)
{
    WrError inner = { "" };
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.7); /* reading back is the rest */
    bool good = write_file(path, wr_file_sink(target), target->fd, format->library, parts, count,
                           digests, err);
    wr_progress_set(whole);
    if (good) wr_fd_begin_sync(target->fd); /* while it is read back */
    return good && (wr_image_verify(path, target->fd, format, parts, count, digests, &inner) ||
                    fail_write(err, path, target->fd, wr_error_message(&inner)));
}

bool wr_image_write(const char *path, const WrImageOut *parts, int count, WrError *err)
{
    if (!check_parts(path, parts, count, err)) return false;
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    WrHash *digests = wr_alloc((size_t)count, sizeof *digests);
    bool good = write_target(&target, path, wr_image_format(path, err), parts, count, digests, err);
    wr_free(digests);
    if (good && wr_progress_stopped()) good = wr_fail(err, "cancelled");
    if (good) return wr_file_commit(&target, err);
    wr_file_abort(&target);
    return false;
}

/* A sink in memory. */
typedef struct Bytes {
    char *data;
    size_t length, room;
} Bytes;

#define BYTES_MAX ((size_t)1 << 40) /* no encoder seeks farther */

static bool bytes_write(void *to, const void *bytes, size_t length, int64_t at)
{
    Bytes *all = to;
    if (at < 0 || (uint64_t)at > BYTES_MAX || length > BYTES_MAX) return errno = EFBIG, false;
    const size_t from = (size_t)at, end = from + length;
    if (end > all->room) {
        const size_t room = end + end / 2;
        char *data = wr_try_alloc(room, 1, "a picture in memory", NULL);
        if (!data) return errno = ENOMEM, false;
        if (all->length) memcpy(data, all->data, all->length);
        wr_free(all->data);
        all->data = data;
        all->room = room;
    }
    memcpy(all->data + from, bytes, length);
    if (end > all->length) all->length = end;
    return true;
}

static bool verify_bytes(const char *name, const Bytes *all, const WrImageFormat *format,
                         const WrImageOut *part, const WrHash *digest, WrError *err)
{
    WrError inner = { "" };
    int fd = wr_fd_in_memory(name, all->data, all->length, err);
    if (fd < 0) return false;
    const bool good = wr_image_verify(name, fd, format, part, 1, digest, &inner);
    wr_fd_close(fd);
    return good || fail_write(err, name, -1, wr_error_message(&inner));
}

bool wr_image_write_bytes(const char *name, const WrImageOut *part, char **bytes, size_t *length,
                          WrError *err)
{
    if (!check_parts(name, part, 1, err)) return false;
    const WrImageFormat *format = wr_image_format(name, err);
    Bytes all = { 0 };
    const WrByteSink sink = { bytes_write, &all };
    WrHash digest = { 0 };
    if (!write_file(name, sink, -1, format->library, part, 1, &digest, err) ||
        !verify_bytes(name, &all, format, part, &digest, err)) {
        wr_free(all.data);
        return false;
    }
    *bytes = all.data;
    *length = all.length;
    return true;
}

typedef struct Pixels {
    const char *bytes;
    size_t row; /* bytes */
} Pixels;

static bool copy_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const Pixels *pixels = ctx;
    memcpy(out, pixels->bytes + (size_t)y * pixels->row, (size_t)rows * pixels->row);
    return true;
}

bool wr_image_write_pixels(const char *path, int width, int height, int channels, WrPixelType type,
                           bool data, const void *pixels, WrError *err)
{
    Pixels from = { pixels, (size_t)(width > 0 ? width : 0) *
                                (size_t)(channels > 0 ? channels : 0) * type_bytes(type) };
    WrImageOut out = { .width = width,
                       .height = height,
                       .channels = channels,
                       .type = type,
                       .data = data,
                       .rows = copy_rows,
                       .ctx = &from };
    return wr_image_write(path, &out, 1, err);
}

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/decode.h"
#include "image/oiio.h"
#include "image/verify.h"
#include "system/fd.h"
#include "system/process.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define SPOOL_MB 1024 /* files of more go to the disk at once (choose_spool) */
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
        return wr_fail(err, "%s: halves, and levels in one file, need EXR", path);
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

/* A limit on file sizes holds for memory files as well, where libraries do not always tell of it. */
static bool is_cut(int fd)
{
    WrFileInfo info;
    return wr_fd_info(fd, &info) && (uint64_t)info.bytes >= wr_process_file_limit();
}

/* reason: of the library, which may have the system's in it. */
static bool fail_write(WrError *err, const char *path, int file, const char *reason)
{
    char text[WR_FILE_WHY];
    const char *why = is_cut(file) ? wr_file_why(EFBIG, text) : wr_file_why_told(reason, text);
    return wr_fail(err, "%s: cannot be written%s%s%s", path, *why ? " (" : "", why,
                   *why ? ")" : "");
}

typedef struct Writing {
    const char *path;
    int file;
    const WrCodec *library;
    WrCodecWriter *writer;
    float *values; /* scratch: a strip as a reader gives it */
    int packed;    /* rows that the format packs together */
} Writing;

/* What reading the strip back will give. */
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

/* How many rows a format packs together, at most. */
static int packed_rows(const char *format)
{
    return strcmp(format, "png") == 0 ? 1 : strcmp(format, "tiff") == 0 ? 32 : 16;
}

/* A strip, in pieces so small that it soon looks whether it should stop. row: bytes. */
static bool write_strip(const Writing *to, int y, int rows, const void *pixels, size_t row,
                        WrError *err)
{
    char reason[WR_CODEC_REASON] = "";
    int piece = WR_IMAGE_STRIP;
    while (piece > to->packed && (size_t)piece * row > PIECE_BYTES) piece /= 2;
    for (int first = 0; first < rows; first += piece) {
        int count = rows - first < piece ? rows - first : piece;
        const char *from = (const char *)pixels + (size_t)first * row;
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
        if (!to->library->write(to->writer, y + first, count, from, reason))
            return fail_write(err, to->path, to->file, reason);
    }
    return true;
}

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
        if (part->tells ? wr_progress_stopped() : !wr_progress_tell((double)y / part->height)) {
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

/* file: open for writing, empty. digests: [count], of what was written. */
static bool write_file(const char *path, int file, const char *format, const WrImageOut *parts,
                       int count, WrHash *digests, WrError *err)
{
    char reason[WR_CODEC_REASON] = "";
    Writing to = { .path = path,
                   .file = file,
                   .library = wr_codec(format, err),
                   .packed = parts[0].levels ? WR_IMAGE_TILE : packed_rows(format) };
    if (!to.library) return false;
    to.writer = to.library->create(file, format, parts, count, reason);
    if (!to.writer) return fail_write(err, path, file, reason);
    bool ok = true;
    for (int i = 0; i < count && ok; i++) {
        WrProgressPart share;
        const WrProgress *whole = wr_progress_enter(&share, (double)i / count, (i + 1.0) / count);
        if (i > 0 && !to.library->next(to.writer, reason)) ok = fail_write(err, path, file, reason);
        ok = ok && write_part(&to, &parts[i], &digests[i], err);
        wr_progress_set(whole);
    }
    bool whole = to.library->finish(to.writer, ok, reason);
    if (ok && !whole) ok = fail_write(err, path, file, reason);
    if (ok && wr_progress_stopped()) ok = wr_fail(err, "cancelled"); /* rows may be missing */
    return ok;
}

/* Bytes that the parts' values take; a file is seldom larger. */
static double raw_bytes(const WrImageOut *parts, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += (double)parts[i].width * parts[i].height * parts[i].channels *
               (double)type_bytes(parts[i].type);
    return sum;
}

/* Where a library that opens its file itself writes to: a memory file, whose bytes then go to the disk where we
   see every failure; what is too large for that goes there at once, and only reading it back tells. */
static int choose_spool(const WrFileTarget *target, const char *format, const WrImageOut *parts,
                        int count)
{
    const char *setting = getenv("WRINKLE_SPOOL_MB");
    double most = SPOOL_MB;
    if (setting && !wr_number_parse(setting, strlen(setting), &most)) most = SPOOL_MB;
    if (!wr_oiio_by_name(format, parts, count) || raw_bytes(parts, count) > most * 1e6)
        return target->fd;
    int fd = wr_fd_memory("wrinkle picture");
    return fd >= 0 ? fd : target->fd;
}

static bool copy_file(int from, const WrFileTarget *target, WrError *err)
{
    static const size_t size = 1 << 18;
    char *block = wr_alloc(size, 1), why[WR_FILE_WHY];
    bool good = true;
    int64_t at = 0;
    for (int64_t n = 1; good && n != 0; at += n > 0 ? n : 0) {
        if (wr_progress_stopped()) good = wr_fail(err, "cancelled");
        if (!good) break;
        n = wr_fd_read_at(from, block, size, at);
        good = n >= 0 && (n == 0 || wr_fd_write(target->fd, block, (size_t)n));
        if (!good) wr_file_fail(target, wr_file_why(errno, why), err);
    }
    wr_free(block);
    return good;
}

static bool write_target(WrFileTarget *target, const char *path, const WrImageFormat *format,
                         const WrImageOut *parts, int count, WrHash *digests, WrError *err)
{
    WrError inner = { "" };
    int spool = choose_spool(target, format->library, parts, count);
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.7); /* reading it back is the rest */
    bool good = write_file(path, spool, format->library, parts, count, digests, err) &&
                (spool == target->fd || copy_file(spool, target, err));
    wr_progress_set(whole);
    if (spool != target->fd) wr_fd_close(spool);
    if (!good) return false;
    if (wr_image_verify(path, target->fd, format, parts, count, digests, &inner)) {
        wr_file_verified(target);
        return true;
    }
    return fail_write(err, path, target->fd, inner.text);
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

/* Everything that was written to a memory file. */
static bool take_bytes(const char *name, int fd, char **bytes, size_t *length, WrError *err)
{
    WrFileInfo info;
    if (!wr_fd_info(fd, &info)) return wr_fail(err, "%s: %s", name, strerror(errno));
    size_t want = (size_t)info.bytes, have = 0;
    char *block = wr_try_alloc(want + 1, 1, name, err);
    if (!block) return false;
    while (have < want) {
        int64_t n = wr_fd_read_at(fd, block + have, want - have, (int64_t)have);
        if (n <= 0) {
            wr_free(block);
            return wr_fail(err, "%s: %s", name, strerror(n < 0 ? errno : EIO));
        }
        have += (size_t)n;
    }
    *bytes = block;
    *length = want;
    return true;
}

bool wr_image_write_bytes(const char *name, const WrImageOut *part, char **bytes, size_t *length,
                          WrError *err)
{
    if (!check_parts(name, part, 1, err)) return false;
    const WrImageFormat *format = wr_image_format(name, err);
    if (strcmp(format->library, "tiff") == 0)
        return wr_fail(err, "%s: TIFF files cannot be written into memory", name);
    int fd = wr_fd_memory("wrinkle picture");
    if (fd < 0) return wr_fail(err, "%s: %s", name, strerror(errno));
    WrError inner = { "" };
    WrHash digest = { 0 };
    bool ok = write_file(name, fd, format->library, part, 1, &digest, err);
    if (ok && !wr_image_verify(name, fd, format, part, 1, &digest, &inner))
        ok = fail_write(err, name, fd, inner.text);
    ok = ok && take_bytes(name, fd, bytes, length, err);
    wr_fd_close(fd);
    return ok;
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

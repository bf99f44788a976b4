#include "image/format.h"
#include "image/oiio.h"

#include "base/file.h"
#include "base/memory.h"

#include <errno.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

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
    if (count > 1 && strcmp(format->library, "openexr") != 0)
        return wr_fail(err, "%s: %d parts in one file need EXR", path, count);
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

static bool fail_write(WrError *err, const char *path, const char *reason)
{
    return wr_fail(err, "%s: cannot be written%s%s%s", path, *reason ? " (" : "", reason,
                   *reason ? ")" : "");
}

typedef struct Writing {
    const char *path;
    const WrOiioTable *library;
    WrOiioWriter *writer;
} Writing;

static bool write_part(const Writing *to, const WrImageOut *part, WrError *err)
{
    size_t row = (size_t)part->width * (size_t)part->channels;
    int strip = part->height < WR_IMAGE_STRIP ? part->height : WR_IMAGE_STRIP;
    void *pixels =
        wr_try_alloc(row * (size_t)strip, type_bytes(part->type), "rows of a picture", err);
    if (!pixels) return false;
    bool ok = true;
    char reason[WR_OIIO_REASON] = "";
    for (int y = 0; y < part->height && ok; y += strip) {
        int rows = part->height - y < strip ? part->height - y : strip;
        ok = part->rows(part->ctx, y, rows, pixels, err);
        if (ok && !to->library->write(to->writer, y, rows, pixels, reason))
            ok = fail_write(err, to->path, reason);
    }
    wr_free(pixels);
    return ok;
}

static bool write_file(const char *path, const char *temporary, const char *format,
                       const WrImageOut *parts, int count, WrError *err)
{
    char reason[WR_OIIO_REASON] = "";
    Writing to = { .path = path, .library = wr_oiio(err) };
    if (!to.library) return false;
    to.writer = to.library->create(temporary, format, parts, count, reason);
    if (!to.writer) return fail_write(err, path, reason);
    bool ok = true;
    for (int i = 0; i < count && ok; i++) {
        if (i > 0 && !to.library->next(to.writer, reason)) ok = fail_write(err, path, reason);
        ok = ok && write_part(&to, &parts[i], err);
    }
    bool whole = to.library->finish(to.writer, ok, reason);
    if (ok && !whole) ok = fail_write(err, path, reason);
    return ok;
}

bool wr_image_write(const char *path, const WrImageOut *parts, int count, WrError *err)
{
    if (!check_parts(path, parts, count, err)) return false;
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    if (!write_file(path, target.temporary, wr_image_format(path, err)->library, parts, count,
                    err)) {
        wr_file_abort(&target);
        return false;
    }
    return wr_file_commit(&target, err);
}

/* Everything that was written to a memory file. */
static bool take_bytes(const char *name, int fd, char **bytes, size_t *length, WrError *err)
{
    struct stat info;
    if (fstat(fd, &info) != 0) return wr_fail(err, "%s: %s", name, strerror(errno));
    size_t want = (size_t)info.st_size, have = 0;
    char *block = wr_try_alloc(want + 1, 1, name, err);
    if (!block) return false;
    while (have < want) {
        ssize_t n = pread(fd, block + have, want - have, (off_t)have);
        if (n < 0 && errno == EINTR) continue;
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
    const char *format = wr_image_format(name, err)->library;
    if (strcmp(format, "tiff") == 0)
        return wr_fail(err, "%s: TIFF files cannot be written into memory", name);
    int fd = memfd_create("wrinkle picture", MFD_CLOEXEC);
    if (fd < 0) return wr_fail(err, "%s: %s", name, strerror(errno));
    char path[32];
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    bool ok =
        write_file(name, path, format, part, 1, err) && take_bytes(name, fd, bytes, length, err);
    close(fd);
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

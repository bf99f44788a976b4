#include "image/format.h"
#include "image/oiio.h"
#include "image/png.h"

#include "base/file.h"
#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct WrImageFile {
    const WrOiioTable *library;
    WrOiioReader *reader;
    char *path; /* for messages */
};

/* The file, open, if it can be a picture file at all. Never waits: a pipe is refused before it is read. */
static FILE *open_regular(const char *path, WrError *err)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat info;
    if (fd < 0 || fstat(fd, &info) != 0) {
        wr_fail(err, "%s: %s", path, strerror(errno));
    } else if (S_ISDIR(info.st_mode)) {
        wr_fail(err, "%s: is a folder; a picture file is needed", path);
    } else if (!S_ISREG(info.st_mode)) {
        wr_fail(err, "%s: is not a regular file", path);
    } else if (info.st_size == 0) {
        wr_fail(err, "%s: is empty", path);
    } else {
        FILE *file = fdopen(fd, "rb");
        if (file) return file;
        wr_fail(err, "%s: %s", path, strerror(errno));
    }
    if (fd >= 0) close(fd);
    return NULL;
}

/* The format by the file's first bytes, else by its ending. */
static const char *find_format(const char *path, char ending[16], WrError *err)
{
    FILE *file = open_regular(path, err);
    if (!file) return NULL;
    unsigned char bytes[WR_IMAGE_SNIFF];
    size_t count = fread(bytes, 1, sizeof bytes, file);
    const char *format = wr_image_sniff(bytes, count);
    if (!format) format = wr_path_ending(path, ending);
    if (strcmp(format, "png") == 0 && !wr_png_check(file, err)) {
        wr_error_prefix(err, "%s: ", path);
        format = NULL;
    }
    fclose(file);
    return format;
}

static WrOiioReader *open_reader(const char *path, int most, const WrOiioTable **library,
                                 WrError *err)
{
    char ending[16], reason[WR_OIIO_REASON] = "";
    const char *format = find_format(path, ending, err);
    if (!format) return NULL;
    *library = wr_oiio(err);
    if (!*library) return NULL;
    WrOiioReader *reader = (*library)->open(path, format, most, reason);
    if (!reader) wr_fail(err, "%s: %s", path, reason);
    return reader;
}

static bool fail_read(WrError *err, const char *path, const char *reason)
{
    return wr_fail(err, "%s: cannot be read whole, truncated or damaged%s%s%s", path,
                   *reason ? " (" : "", reason, *reason ? ")" : "");
}

/* Values that are not finite become 0; returns how many pixels had one. */
static int64_t replace_bad_pixels(float *values, size_t pixels, int channels)
{
    int64_t replaced = 0;
    for (size_t i = 0; i < pixels; i++) {
        bool bad = false;
        for (int c = 0; c < channels; c++) {
            float *value = &values[i * (size_t)channels + (size_t)c];
            if (isfinite(*value)) continue;
            *value = 0.0f;
            bad = true;
        }
        replaced += bad;
    }
    return replaced;
}

WrImage *wr_image_read(const char *path, WrError *err)
{
    const WrOiioTable *library;
    WrOiioReader *reader = open_reader(path, 1, &library, err);
    if (!reader) return NULL;
    const WrImagePart *part = &library->part(reader, 0)->part;
    int channels = part->channels < 4 ? part->channels : 4;
    WrImage *image = wr_image_new(part->width, part->height, channels, err);
    if (!image) {
        wr_error_prefix(err, "%s: ", path);
        goto done;
    }
    image->type = part->type;
    size_t row = (size_t)image->width * (size_t)channels;
    for (int y = 0; y < image->height; y += WR_IMAGE_STRIP) {
        int rows = image->height - y < WR_IMAGE_STRIP ? image->height - y : WR_IMAGE_STRIP;
        float *out = image->data + (size_t)y * row;
        char reason[WR_OIIO_REASON] = "";
        if (!library->read(reader, 0, y, rows, channels, out, reason)) {
            fail_read(err, path, reason);
            wr_image_free(image);
            image = NULL;
            goto done;
        }
        image->replaced += replace_bad_pixels(out, (size_t)image->width * (size_t)rows, channels);
    }
done:
    library->close(reader);
    return image;
}

WrImageFile *wr_image_file_open(const char *path, WrError *err)
{
    const WrOiioTable *library;
    WrOiioReader *reader = open_reader(path, WR_IMAGE_PARTS_MAX, &library, err);
    if (!reader) return NULL;
    WrImageFile *file = wr_alloc(1, sizeof *file);
    *file = (WrImageFile){ .library = library, .reader = reader, .path = wr_strdup(path) };
    return file;
}

void wr_image_file_close(WrImageFile *file)
{
    if (!file) return;
    file->library->close(file->reader);
    wr_free(file->path);
    wr_free(file);
}

int wr_image_file_parts(const WrImageFile *file)
{
    return file->library->parts(file->reader);
}

WrImagePart wr_image_file_part(const WrImageFile *file, int part)
{
    return file->library->part(file->reader, part)->part;
}

const char *wr_image_file_attribute(const WrImageFile *file, int part, const char *name)
{
    return file->library->attribute(file->reader, part, name);
}

bool wr_image_file_read_rows(WrImageFile *file, int part, int y, int rows, float *out, WrError *err)
{
    char reason[WR_OIIO_REASON] = "";
    int channels = wr_image_file_part(file, part).channels;
    if (file->library->read(file->reader, part, y, rows, channels, out, reason)) return true;
    return fail_read(err, file->path, reason);
}

bool wr_image_file_read(WrImageFile *file, int part, float *out, WrError *err)
{
    WrImagePart is = wr_image_file_part(file, part);
    size_t row = (size_t)is.width * (size_t)is.channels;
    for (int y = 0; y < is.height; y += WR_IMAGE_STRIP) {
        int rows = is.height - y < WR_IMAGE_STRIP ? is.height - y : WR_IMAGE_STRIP;
        if (!wr_image_file_read_rows(file, part, y, rows, out + (size_t)y * row, err)) return false;
    }
    return true;
}

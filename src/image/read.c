#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "image/codec.h"
#include "image/decode.h"
#include "image/reader_process.h"
#include "image/read_internal.h"
#include "image/reader_client.h"
#include "image/sidecar.h"
#include "system/fd.h"
#include "system/process.h"

#include <math.h>
#include <string.h>

/* Untrusted files are read by the reader process; inside this one only if the environment requests it. */
struct WrImageFile {
    WrReader *reader; /* NULL: `decoder` is used */
    WrDecoder *decoder;
    char *path; /* for messages */
    int fd;     /* the decoder's file; -1: the reader has its own */
};

void wr_image_warm(void)
{
    if (!wr_reader_inside()) wr_process_start(NULL);
}

/* Owns the descriptor; -1 means an earlier failure. */
static WrImageFile *open_file(const char *name, int fd, int most, bool numbers, bool outside,
                              WrError *err)
{
    if (fd < 0) return NULL;
    WrImageFile file = { .fd = -1 };
    if (!outside) {
        char ending[16];
        file.decoder = wr_decoder_open(fd, wr_path_ending(name, ending), most, numbers, NULL, err);
        if (file.decoder) file.fd = fd;
        else wr_error_prefix(err, "%s: ", name);
    } else {
        file.reader = wr_reader_open(name, fd, most, numbers, err);
    }
    if (file.fd < 0) wr_fd_close(fd);
    if (!file.reader && !file.decoder) return NULL;
    file.path = wr_strdup(name);
    WrImageFile *opened = wr_alloc(1, sizeof *opened);
    *opened = file;
    return opened;
}

WrImageFile *wr_image_file_open(const char *path, WrError *err)
{
    return open_file(path, wr_reader_file(path, WR_FILE_MOST, err), WR_IMAGE_PARTS_MAX, false,
                     !wr_reader_inside(), err);
}

WrImageFile *wr_image_file_open_levels(const char *path, WrError *err)
{
    return open_file(path, wr_reader_file(path, WR_FILE_MOST, err), WR_CODEC_LEVELS, false,
                     !wr_reader_inside(), err);
}

/* The program's own file: if no reader process or no sandbox is available, it is read in this process. */
WrImageFile *wr_image_file_take(const char *name, int fd, bool levels, WrError *err)
{
    bool outside = !wr_reader_inside() && wr_process_has_cage() && wr_process_start(NULL);
    return open_file(name, fd, levels ? WR_CODEC_LEVELS : WR_IMAGE_PARTS_MAX, false, outside, err);
}

void wr_image_file_close(WrImageFile *file)
{
    if (!file) return;
    wr_reader_close(file->reader);
    wr_decoder_close(file->decoder);
    if (file->fd >= 0) wr_fd_close(file->fd);
    wr_free(file->path);
    wr_free(file);
}

int wr_image_file_parts(const WrImageFile *file)
{
    return file->reader ? wr_reader_parts(file->reader) : wr_decoder_parts(file->decoder);
}

WrImagePart wr_image_file_part(const WrImageFile *file, int part)
{
    return file->reader ? wr_reader_part(file->reader, part) : wr_decoder_part(file->decoder, part);
}

const char *wr_image_file_attribute(const WrImageFile *file, int part, const char *name)
{
    return file->reader ? wr_reader_attribute(file->reader, part, name)
                        : wr_decoder_attribute(file->decoder, part, name);
}

static bool read_rows(WrImageFile *file, int part, int y, int rows, int channels, float *out,
                      WrError *err)
{
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    if (file->reader) return wr_reader_read(file->reader, part, y, rows, channels, out, err);
    if (wr_decoder_read(file->decoder, part, y, rows, channels, out, NULL, err)) return true;
    wr_error_prefix(err, "%s: ", file->path);
    return false;
}

bool wr_image_file_read_rows(WrImageFile *file, int part, int y, int rows, float *out, WrError *err)
{
    return read_rows(file, part, y, rows, wr_image_file_part(file, part).channels, out, err);
}

bool wr_image_file_read(WrImageFile *file, int part, float *out, WrError *err)
{
    WrImagePart is = wr_image_file_part(file, part);
    size_t row = (size_t)is.width * (size_t)is.channels;
    for (int y = 0; y < is.height; y += WR_IMAGE_BAND) {
        int rows = is.height - y < WR_IMAGE_BAND ? is.height - y : WR_IMAGE_BAND;
        if (!wr_progress_report((double)y / is.height)) return wr_fail(err, "cancelled");
        if (!wr_image_file_read_rows(file, part, y, rows, out + (size_t)y * row, err)) return false;
    }
    return true;
}

bool wr_image_file_digest(WrImageFile *file, int part, int y, int rows, WrHash *digest,
                          WrError *err)
{
    int channels = wr_image_file_part(file, part).channels;
    if (file->reader) return wr_reader_digest(file->reader, part, y, rows, channels, digest, err);
    return wr_decoder_digest(file->decoder, part, y, rows, channels, digest, NULL, err);
}

const char *wr_image_file_path(const WrImageFile *file)
{
    return file->path;
}

/* ---- images ---- */

bool wr_image_file_read_first(WrImageFile *file, int part, int y, int rows, int channels,
                              float *out, WrError *err)
{
    return read_rows(file, part, y, rows, channels, out, err);
}

/* Only the first part is opened, unless more are requested, or the format's parts can be listed safely. */
static int most_parts(const char *name, const WrImageRequest *wish)
{
    char buffer[16];
    const char *ending = wr_path_ending(name, buffer);
    const bool several =
        strcmp(ending, "exr") == 0 || strcmp(ending, "tif") == 0 || strcmp(ending, "tiff") == 0;
    return several || (wish->part && *wish->part) ? WR_IMAGE_PARTS_MAX : 1;
}

static WrImageRows *open_rows(const char *name, int fd, const WrImageRequest *wish, WrError *err)
{
    WrImageFile *file =
        open_file(name, fd, most_parts(name, wish), wish->elevation, !wr_reader_inside(), err);
    return file ? wr_image_rows_take(file, wish, err) : NULL;
}

static WrImage *read_whole(WrImageRows *rows, WrError *err)
{
    WrImage *image = rows ? wr_image_rows_whole(rows, err) : NULL;
    wr_image_rows_close(rows);
    return image;
}

WrImageRows *wr_image_rows_open(const char *path, const WrImageRequest *wish, WrError *err)
{
    if (wr_sidecar_takes(path)) return wr_sidecar_rows(path, wish, err);
    return open_rows(path, wr_reader_file(path, WR_FILE_MOST, err), wish, err);
}

WrImage *wr_image_read(const char *path, WrError *err)
{
    const WrImageRequest all = { .channel = NULL };
    return wr_image_read_wish(path, &all, err);
}

WrImage *wr_image_read_wish(const char *path, const WrImageRequest *wish, WrError *err)
{
    return read_whole(wr_image_rows_open(path, wish, err), err);
}

WrImage *wr_image_read_bytes(const char *name, const void *bytes, size_t length, WrError *err)
{
    const WrImageRequest all = { .channel = NULL };
    if (length == 0) {
        wr_fail(err, "%s: is empty", name);
        return NULL;
    }
    return read_whole(open_rows(name, wr_fd_in_memory(name, bytes, length, err), &all, err), err);
}

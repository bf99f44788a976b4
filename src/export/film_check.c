/* Verification of a finished film before it is renamed: by ffmpeg, every frame; for animated WebP, which ffmpeg
   cannot decode, the chunks of the file, and its first and last frame by the picture reader. */
#include "base/error.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "export/film_internal.h"
#include "image/image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CELL 16 /* smallest side of a cell, pixels, if the frame is that large */

/* ---- colours of a frame ---- */

static int cells_of(int side)
{
    const int cells = side / CELL;
    return cells < 1 ? 1 : cells > WR_FILM_GRID ? WR_FILM_GRID : cells;
}

static void sum_cell(const uint8_t *pixels, int width, int channels, const int x[2], const int y[2],
                     uint16_t mean[4])
{
    uint64_t sum[4] = { 0 };
    for (int j = y[0]; j < y[1]; j++) {
        const uint8_t *at = pixels + ((size_t)j * (size_t)width + (size_t)x[0]) * (size_t)channels;
        for (int i = x[0]; i < x[1]; i++, at += channels)
            for (int c = 0; c < channels; c++) sum[c] += at[c];
    }
    const double count = (double)(x[1] - x[0]) * (y[1] - y[0]);
    for (int c = 0; c < channels; c++) mean[c] = (uint16_t)rint(257.0 * (double)sum[c] / count);
}

void wr_film_sum(const uint8_t *pixels, int width, int height, int channels, WrFilmSums *sums)
{
    const int across = cells_of(width), down = cells_of(height);
    memset(sums, 0, sizeof *sums);
    for (int j = 0; j < down; j++)
        for (int i = 0; i < across; i++)
            sum_cell(pixels, width, channels,
                     (const int[2]){ width * i / across, width * (i + 1) / across },
                     (const int[2]){ height * j / down, height * (j + 1) / down },
                     sums->mean[j * WR_FILM_GRID + i]);
}

/* Largest difference of two cells' means, codes. */
static double difference(const WrFilmSums *a, const WrFilmSums *b)
{
    int worst = 0;
    for (int i = 0; i < WR_FILM_GRID * WR_FILM_GRID; i++)
        for (int c = 0; c < 4; c++) {
            const int off = abs(a->mean[i][c] - b->mean[i][c]);
            worst = off > worst ? off : worst;
        }
    return worst / 257.0;
}

/* ---- by ffmpeg ---- */

static bool read_frames(WrFilm *film, WrTool *tool, WrFilmReport *report, WrError *err)
{
    const size_t bytes = (size_t)film->width * (size_t)film->height * (size_t)film->channels;
    size_t got = bytes;
    int frames = 0;
    for (; got == bytes; frames++) {
        WrFilmSums sums;
        if (!wr_tool_get(tool, film->read, bytes, &got, err)) return false;
        if (got < bytes) break;
        if (frames == film->sums.count)
            return wr_fail(err, "%d frames were handed to ffmpeg, more stand in the file", frames);
        wr_film_sum(film->read, film->width, film->height, film->channels, &sums);
        const double off = difference(&sums, &film->sums.data[frames]);
        report->worst = off > report->worst ? off : report->worst;
    }
    if (frames != film->sums.count || got != 0)
        return wr_fail(err, "%d frames were handed to ffmpeg, %d stand in the file%s",
                       film->sums.count, frames, got ? " and a piece of one" : "");
    return true;
}

static bool read_back(WrFilm *film, WrFilmReport *report, WrError *err)
{
    WrTool tool;
    WrText in = { 0 };
    wr_text_addf(&in, "file:%s", film->target.temporary);
    const char *const line[] = {
        "ffmpeg",       "-nostdin",
        "-hide_banner", "-loglevel",
        "error",        "-xerror",
        "-i",           wr_text_get(&in),
        "-fps_mode",    "passthrough",
        "-vf",          "scale=flags=accurate_rnd+full_chroma_int+full_chroma_inp",
        "-f",           "rawvideo",
        "-pix_fmt",     film->channels == 4 ? "rgba" : "rgb24",
        "pipe:1",       NULL
    };
    bool good = wr_tool_start(&tool, line, -1, film->options.patience, err);
    if (good) good = read_frames(film, &tool, report, err) && wr_tool_finish(&tool, err);
    wr_tool_drop(&tool);
    wr_text_fini(&in);
    return good;
}

/* ---- animated WebP: chunks of a name, a length and that many bytes, padded to even ---- */

/* Summary of the chunks. */
typedef struct Pieces {
    int64_t frames;      /* equal consecutive frames are merged */
    double milliseconds; /* total duration; 0 for a still picture */
    bool whole;
} Pieces;

static uint32_t little(const unsigned char *bytes, int count)
{
    uint32_t value = 0;
    for (int i = count - 1; i >= 0; i--) value = value << 8 | bytes[i];
    return value;
}

static bool is_one(const unsigned char *head, const char *name)
{
    return memcmp(head, name, 4) == 0;
}

static Pieces pieces_of(const WrFilm *film, int64_t bytes)
{
    Pieces pieces = { 0 };
    unsigned char head[24];
    int64_t at = 12;
    const int fd = film->target.fd;
    if (wr_fd_read_at(fd, head, 12, 0) != 12 || !is_one(head, "RIFF") || !is_one(head + 8, "WEBP"))
        return pieces;
    const int64_t end = (int64_t)little(head + 4, 4) + 8;
    while (at < end && wr_fd_read_at(fd, head, sizeof head, at) >= 8) {
        if (is_one(head, "ANMF")) pieces.milliseconds += little(head + 20, 3);
        pieces.frames += is_one(head, "ANMF") || is_one(head, "VP8 ") || is_one(head, "VP8L");
        at += 8 + (((int64_t)little(head + 4, 4) + 1) & ~(int64_t)1);
    }
    pieces.whole = end == bytes && at == end;
    return pieces;
}

/* Converts a picture of the film's size to a frame. */
static void take_codes(WrFilm *film, const WrImage *image)
{
    const size_t pixels = (size_t)film->width * (size_t)film->height;
    const int channels = film->channels, have = image->channels;
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < channels; c++) {
            const double value = c < have ? (double)image->data[i * (size_t)have + (size_t)c] : 1.0;
            film->read[i * (size_t)channels + (size_t)c] = (uint8_t)rint(255.0 * value);
        }
}

/* Verifies by the picture reader: frame `part` of the file against the original. For transparent frames the
   coverage is compared, since a reader may have premultiplied the colours. */
static bool compare_frame(WrFilm *film, int64_t part, int64_t of, int frame, WrFilmReport *report,
                          WrError *err)
{
    char number[24];
    WrFilmSums sums, want = film->sums.data[frame];
    snprintf(number, sizeof number, "%lld", (long long)part);
    const WrImageRequest wish = { .part = of > 1 ? number : NULL };
    WrImage *image = wr_image_read_wish(film->target.temporary, &wish, err);
    if (!image) return false;
    bool good = (image->width == film->width && image->height == film->height) ||
                wr_fail(err, "frames of %dx%d were handed to ffmpeg, of %dx%d stand in the file",
                        film->width, film->height, image->width, image->height);
    if (good) {
        take_codes(film, image);
        wr_film_sum(film->read, film->width, film->height, film->channels, &sums);
        for (int i = 0; film->channels == 4 && i < WR_FILM_GRID * WR_FILM_GRID; i++)
            for (int c = 0; c < 3; c++) sums.mean[i][c] = want.mean[i][c] = 0;
        const double off = difference(&sums, &want);
        report->worst = off > report->worst ? off : report->worst;
    }
    wr_image_free(image);
    return good;
}

static bool read_pieces(WrFilm *film, WrFilmReport *report, WrError *err)
{
    const Pieces pieces = pieces_of(film, report->bytes);
    const double frame_ms = 1000.0 / film->options.fps, handed_ms = film->sums.count * frame_ms;
    if (!pieces.whole) return wr_fail(err, "ffmpeg's file is no whole WebP file");
    if (pieces.frames < 1 || pieces.frames > film->sums.count ||
        (pieces.milliseconds > 0.0 &&
         fabs(pieces.milliseconds - handed_ms) > frame_ms + (double)film->sums.count))
        return wr_fail(
            err, "%d frames, %.0f ms, were handed to ffmpeg, %lld, %.0f ms, stand in the file",
            film->sums.count, handed_ms, (long long)pieces.frames, pieces.milliseconds);
    /* Readers compose a transparent frame over the one before: only the first equals the original. */
    return compare_frame(film, 1, pieces.frames, 0, report, err) &&
           (film->channels == 4 ||
            compare_frame(film, pieces.frames, pieces.frames, film->sums.count - 1, report, err));
}

bool wr_film_check(WrFilm *film, WrFilmReport *report, WrError *err)
{
    WrFileInfo info;
    if (!wr_fd_info(film->target.fd, &info) || info.bytes == 0)
        return wr_fail(err, "ffmpeg wrote nothing");
    report->bytes = info.bytes;
    if (!(film->kind->by_reader ? read_pieces : read_back)(film, report, err)) return false;
    if (report->worst <= film->kind->wrong) return true;
    return wr_fail(err, "ffmpeg's file has other colours: off by %.3g codes where %g may be",
                   report->worst, film->kind->wrong);
}

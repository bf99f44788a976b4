#include "export/film.h"

#include "base/array.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/spool.h"
#include "base/text.h"
#include "image/image.h"
#include "system/channel.h"
#include "system/child.h"
#include "system/clock.h"
#include "system/fd.h"
#include "system/thread.h"

#include <errno.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WR_FILM_GRID 8 /* maximum cells per side for comparing colours */

/* A running ffmpeg: bytes are written to it or read from it through one channel. */
typedef struct WrTool {
    WrPid child;
    int channel, complaints; /* -1: none */
    double patience;         /* seconds */
    double since;            /* time of its last input or output */
    bool ended;
    WrChildEnd end;
} WrTool;

/* Kills it if it runs, and clears the struct; allowed after finish, and if it was never started (zeroed, channel
   -1). */
static void tool_drop(WrTool *tool);

/* Mean colours of a frame's cells. */
typedef struct WrFilmSums {
    uint16_t mean[WR_FILM_GRID * WR_FILM_GRID][4]; /* in 257ths of a code: 65535 is 255 */
} WrFilmSums;

/* Frames are 8-bit RGB or RGBA, row by row from the top. Per frame only the means of its cells are kept, for the check of the
   finished file. */
struct WrFilm {
    const WrFilmKind *kind;
    WrFilmOptions options;
    WrFileTarget target;
    WrSpool spool; /* ffmpeg's output */
    WrTool tool;
    int width, height; /* of the file */
    int channels;
    uint8_t *padded;           /* a frame padded to the file's size, if that differs; owned */
    uint8_t *read;             /* a decoded frame; owned */
    WR_ARRAY(WrFilmSums) sums; /* of each frame */
};

/* ---- The ffmpeg process: transfer of bytes in either direction, with cancellation at any time ---- */

/* The child's pipe is a channel that never blocks: each wait ends after LOOK_MS at the latest, so that cancelling, and a
   hanging ffmpeg, are noticed. Error output goes to a memory file, not to a pipe: a full pipe that nobody reads would stop
   ffmpeg. */
#define LOOK_MS 20 /* between two checks for cancellation */

static bool tool_start(WrTool *tool, const char *const *arguments, int out, double patience,
                       WrError *err)
{
    int ends[2] = { -1, -1 };
    *tool = (WrTool){ .channel = -1, .complaints = wr_fd_memory("complaints") };
    if (tool->complaints < 0 || !wr_channel_pair(ends, false)) {
        wr_fail(err, "ffmpeg cannot be started: %s", strerror(errno));
        tool_drop(tool);
        return false;
    }
    const bool gives = out < 0;
    const int nowhere = gives ? wr_fd_open_nowhere() : -1;
    const WrChildStart it = { .program = "ffmpeg",
                              .arguments = arguments,
                              .in = gives ? nowhere : ends[1],
                              .out = gives ? ends[1] : out,
                              .err = tool->complaints,
                              .search = true,
                              .bound = true };
    const int trouble = wr_child_start(&it, &tool->child);
    wr_fd_close(ends[1]);
    if (nowhere >= 0) wr_fd_close(nowhere);
    tool->channel = ends[0];
    tool->patience = patience;
    tool->since = wr_clock_seconds();
    if (trouble == 0) return true;
    tool->child = 0;
    tool_drop(tool);
    if (trouble == ENOENT)
        return wr_fail(err,
                       "films are made by the program ffmpeg, which is not installed (Debian's "
                       "package ffmpeg)");
    return wr_fail(err, "ffmpeg cannot be started: %s", strerror(trouble));
}

/* True if waiting may continue. Otherwise the process is ended. */
static bool waits(WrTool *tool, WrError *err)
{
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    if (wr_clock_seconds() - tool->since < tool->patience) return true;
    return wr_fail(err, "ffmpeg hangs: no progress for %g seconds", tool->patience);
}

static bool has_ended(WrTool *tool)
{
    if (!tool->ended && tool->child > 0) tool->ended = wr_child_ended(tool->child, &tool->end);
    return tool->ended;
}

/* Waits for its end. */
static bool wait_for_end(WrTool *tool, WrError *err)
{
    for (int ms = 1; !has_ended(tool); ms = ms < LOOK_MS ? 2 * ms : LOOK_MS) {
        if (!waits(tool, err)) return false;
        wr_thread_sleep_ms(ms);
    }
    return true;
}

/* Its last error message, in one line. */
static void complaint(const WrTool *tool, char words[WR_FILE_WHY])
{
    char text[2048], *line = text;
    const int64_t n = wr_fd_read_at(tool->complaints, text, sizeof text - 1, 0);
    text[n > 0 ? n : 0] = '\0';
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127) *c = ' ';
    line += strspn(line, " ");
    for (size_t length = strlen(line); length > 0 && line[length - 1] == ' ';) line[--length] = 0;
    char why[WR_FILE_WHY];
    snprintf(words, WR_FILE_WHY, "%s", wr_file_why_of_library(line, why));
}

static bool fail_end(const WrTool *tool, WrError *err)
{
    char words[WR_FILE_WHY];
    const char *crash = tool->end.why == WR_CHILD_CRASHED ? wr_child_crash(tool->end.number) : NULL;
    complaint(tool, words);
    if (words[0]) return wr_fail(err, "ffmpeg failed: %s", words);
    if (tool->end.why == WR_CHILD_KILLED)
        return wr_fail(err, "ffmpeg was killed, perhaps because memory ran out");
    if (tool->end.why == WR_CHILD_LEFT)
        return wr_fail(err, "ffmpeg failed with status %d and without a message", tool->end.number);
    return wr_fail(err, "ffmpeg crashed (%s)", crash ? crash : "at its limit of time");
}

/* Writes all bytes; false also if cancelled, or if it reads nothing for longer than its patience. */
static bool tool_put(WrTool *tool, const void *bytes, size_t length, WrError *err)
{
    const char *at = bytes;
    while (length > 0) {
        const int64_t n = wr_channel_put(tool->channel, at, length);
        if (n < 0) {
            if (!wait_for_end(tool, err)) return false;
            return fail_end(tool, err);
        }
        if (n > 0) {
            tool->since = wr_clock_seconds();
            at += n;
            length -= (size_t)n;
        } else if (!wr_channel_wait_room(tool->channel, LOOK_MS) && !waits(tool, err)) {
            return false;
        }
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    }
    return true;
}

/* Reads up to `length` bytes, fewer only at its end: *got. */
static bool tool_get(WrTool *tool, void *bytes, size_t length, size_t *got, WrError *err)
{
    char *at = bytes;
    *got = 0;
    while (*got < length) {
        if (wr_channel_wait(tool->channel, LOOK_MS) != WR_CHANNEL_NEWS) {
            if (!waits(tool, err)) return false;
            continue;
        }
        const int64_t n = wr_channel_receive(tool->channel, at + *got, length - *got, NULL, 0);
        if (n == 0 || n == -1) break;
        if (n > 0) *got += (size_t)n;
        tool->since = wr_clock_seconds();
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    }
    return true;
}

/* Closes its input and waits for its end; false and its error output if it failed. */
static bool tool_finish(WrTool *tool, WrError *err)
{
    wr_channel_end(tool->channel);
    tool->since = wr_clock_seconds();
    if (!wait_for_end(tool, err)) return false;
    if (tool->end.why == WR_CHILD_LEFT && tool->end.number == 0) return true;
    return fail_end(tool, err);
}

static void tool_drop(WrTool *tool)
{
    if (tool->child > 0 && !has_ended(tool)) {
        wr_child_kill(tool->child);
        wr_child_wait(tool->child, &tool->end);
    }
    tool->child = 0;
    if (tool->channel >= 0) wr_fd_close(tool->channel);
    if (tool->complaints >= 0) wr_fd_close(tool->complaints);
    tool->channel = tool->complaints = -1;
}

/* ---- check ---- */

/* Verification of a finished film before it is renamed: by ffmpeg, every frame; for animated WebP, which ffmpeg
   cannot decode, the chunks of the file, and its first and last frame by the picture reader. */

#define CELL 16 /* smallest side of a cell, pixels, if the frame is that large */

/* ---- colours of a frame ---- */

static int cells_of(int side)
{
    const int cells = side / CELL;
    return cells < 1 ? 1 : cells > WR_FILM_GRID ? WR_FILM_GRID : cells;
}

/* Means of cells, not pixels, are compared: lossy codecs and 4:2:0 chroma change single pixels by many codes, but hardly the
   mean of 16 x 16. In 257ths of a code they fill 16 bits, and equal frames have equal integers. */
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

static void film_sum(const uint8_t *pixels, int width, int height, int channels, WrFilmSums *sums)
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
        if (!tool_get(tool, film->read, bytes, &got, err)) return false;
        if (got < bytes) break;
        if (frames == film->sums.count)
            return wr_fail(err, "%d frames were passed to ffmpeg, but the file has more", frames);
        film_sum(film->read, film->width, film->height, film->channels, &sums);
        const double off = difference(&sums, &film->sums.data[frames]);
        report->worst = off > report->worst ? off : report->worst;
    }
    if (frames != film->sums.count || got != 0)
        return wr_fail(err, "%d frames were passed to ffmpeg, but the file has %d%s",
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
    bool good = tool_start(&tool, line, -1, film->options.patience, err);
    if (good) good = read_frames(film, &tool, report, err) && tool_finish(&tool, err);
    tool_drop(&tool);
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

/* RIFF: "RIFF", uint32 size of the rest, "WEBP", then chunks of a four-letter name and a little-endian uint32 length. ANMF
   holds a frame: x, y, width - 1, height - 1 and the duration in ms as 24-bit numbers, the duration 12 bytes into the
   payload, 20 into the chunk. A single frame may be written as a still picture, VP8 or VP8L, without ANMF. */
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
    WrImage *image = wr_image_read_request(film->target.temporary, &wish, err);
    if (!image) return false;
    bool good = (image->width == film->width && image->height == film->height) ||
                wr_fail(err, "frames of %dx%d were passed to ffmpeg, but the file has %dx%d",
                        film->width, film->height, image->width, image->height);
    if (good) {
        take_codes(film, image);
        film_sum(film->read, film->width, film->height, film->channels, &sums);
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
    /* Each duration is rounded to whole milliseconds, and equal consecutive frames are merged: the sum is compared with the
       tolerance of one frame plus one millisecond per frame. */
    const double frame_ms = 1000.0 / film->options.fps, handed_ms = film->sums.count * frame_ms;
    if (!pieces.whole) return wr_fail(err, "ffmpeg's file is not a complete WebP file");
    if (pieces.frames < 1 || pieces.frames > film->sums.count ||
        (pieces.milliseconds > 0.0 &&
         fabs(pieces.milliseconds - handed_ms) > frame_ms + (double)film->sums.count))
        return wr_fail(err,
                       "%d frames, %.0f ms, were passed to ffmpeg, but the file has %lld, %.0f ms",
                       film->sums.count, handed_ms, (long long)pieces.frames, pieces.milliseconds);
    /* Readers compose a transparent frame over the one before: only the first equals the original. */
    return compare_frame(film, 1, pieces.frames, 0, report, err) &&
           (film->channels == 4 ||
            compare_frame(film, pieces.frames, pieces.frames, film->sums.count - 1, report, err));
}

/* film.c: verifies the finished file. */
static bool film_check(WrFilm *film, WrFilmReport *report, WrError *err)
{
    WrFileInfo info;
    if (!wr_fd_info(film->target.fd, &info) || info.bytes == 0)
        return wr_fail(err, "ffmpeg wrote nothing");
    report->bytes = info.bytes;
    if (!(film->kind->by_reader ? read_pieces : read_back)(film, report, err)) return false;
    if (report->worst <= film->kind->wrong) return true;
    return wr_fail(
        err, "ffmpeg's file has other colours: they differ by %.3g codes, at most %g are expected",
        report->worst, film->kind->wrong);
}

#define PATIENCE 300.0 /* seconds: one frame of the largest size needs that order of time */
#define LEAST_FPS 0.1
#define MAX_FPS 240.0
#define TAGS "-color_primaries", "bt709", "-color_trc", "iec61966-2-1"

/* One palette per frame, so that only one is in memory; its ordered dither is constant where the picture is. */
#define PALETTE                                                                                    \
    "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=bayer:"          \
    "bayer_scale=4"

/* Frames are full-range sRGB codes: declared before any conversion, so that every step preserves it. */
#define SRGB "setparams=color_primaries=bt709:color_trc=iec61966-2-1"

/* Explicit matrix and range, since ffmpeg's default is that of standard-definition television. */
#define REC709                                                                                     \
    "scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+full_chroma_int,"        \
    "format=yuv420p," SRGB ":colorspace=bt709:range=tv"

/* `wrong`: largest difference of a cell's mean, in codes, that the codec may cause: 0 for lossless APNG, 12 for a palette of
   256 colours. first_loop: ffmpeg's value for "play once"; formats count plays or repeats, GIF repeats. */
const WrFilmKind wr_film_kinds[] = {
    { .ending = "gif",
      .name = "GIF",
      .loops = true,
      .most_fps = 50,
      .most_side = 16384,
      .wrong = 12.0,
      .coding = { "-vf", PALETTE, "-f", "gif", "-loop", "LOOP" },
      .first_loop = -1 },
    { .ending = "apng",
      .name = "APNG",
      .alpha = true,
      .loops = true,
      .most_fps = MAX_FPS,
      .most_side = 16384,
      .wrong = 0.0,
      .coding = { "-vf", SRGB, "-c:v", "apng", "-pred", "mixed", TAGS, "-f", "apng", "-plays",
                  "LOOP" },
      .first_loop = 1 },
    { .ending = "webp",
      .name = "WebP",
      .alpha = true,
      .loops = true,
      .most_fps = MAX_FPS,
      .most_side = 16383,
      .wrong = 8.0,
      .by_reader = true,
      .coding = { "-c:v", "libwebp_anim", "-pix_fmt", "bgra", "-quality", "90", "-f", "webp",
                  "-loop", "LOOP" },
      .first_loop = 1 },
    { .ending = "mp4",
      .name = "MP4",
      .even = true,
      .most_fps = MAX_FPS,
      .most_side = 8192,
      .wrong = 8.0,
      .rereads = true, /* +faststart */
      .coding = { "-vf", REC709, "-c:v", "libx264", "-crf", "16", TAGS, "-colorspace", "bt709",
                  "-color_range", "tv", "-movflags", "+faststart", "-f", "mp4" } },
};
_Static_assert(WR_LENGTH(wr_film_kinds) == WR_FILM_KIND_COUNT, "film.h counts them");

const WrFilmKind *wr_film_kind(const char *path)
{
    char buffer[16];
    const char *ending = wr_path_ending(path, buffer);
    for (int i = 0; i < WR_FILM_KIND_COUNT; i++)
        if (strcmp(wr_film_kinds[i].ending, ending) == 0) return &wr_film_kinds[i];
    return NULL;
}

/* ---- validation ---- */

static bool check(const char *path, const WrFilmKind *kind, const WrFilmOptions *o, WrError *err)
{
    if (!kind) return wr_fail(err, "%s: a film's name must end in gif, apng, webp or mp4", path);
    if (!(o->fps >= LEAST_FPS && o->fps <= kind->most_fps))
        return wr_fail(err, "%s: fps %g: must be %g..%g frames a second of %s", path, o->fps,
                       LEAST_FPS, kind->most_fps, kind->name);
    if (o->loop < 0 || o->loop > 65535)
        return wr_fail(err, "%s: loop %d: must be the number of repetitions, 0 (endless) to 65535",
                       path, o->loop);
    if (o->loop != 0 && !kind->loops)
        return wr_fail(err, "%s: loop %d: %s files do not store a number of repetitions", path,
                       o->loop, kind->name);
    if (o->width < 1 || o->height < 1 || o->width > kind->most_side || o->height > kind->most_side)
        return wr_fail(err, "%s: %dx%d: %s holds 1 to %d pixels each way", path, o->width,
                       o->height, kind->name, kind->most_side);
    if (o->alpha && !kind->alpha)
        return wr_fail(err, "%s: %s has no transparency: choose a background, or apng or webp",
                       path, kind->name);
    return true;
}

/* ---- ffmpeg command line ---- */

#define ARGUMENTS 48

typedef struct Line {
    const char *words[ARGUMENTS];
    int count;
} Line;

static void add(Line *line, const char *word)
{
    WR_ASSERT(line->count < ARGUMENTS - 1);
    line->words[line->count++] = word;
}

static bool start(WrFilm *film, WrError *err)
{
    const WrFilmOptions *o = &film->options;
    char rate[WR_NUMBER_SIZE], size[32], loop[16];
    WrText out = { 0 };
    Line line = { 0 };
    snprintf(size, sizeof size, "%dx%d", film->width, film->height);
    snprintf(loop, sizeof loop, "%d",
             o->loop == 0   ? 0
             : o->loop == 1 ? film->kind->first_loop
                            : o->loop - (film->kind->first_loop < 0));
    char name[WR_FD_NAME];
    wr_fd_name(WR_FD_OUT, name);
    wr_text_addf(&out, "file:%s", name);
    const char *const before[] = { "ffmpeg",
                                   "-nostdin",
                                   "-hide_banner",
                                   "-loglevel",
                                   "error",
                                   "-xerror",
                                   "-f",
                                   "rawvideo",
                                   "-pixel_format",
                                   film->channels == 4 ? "rgba" : "rgb24",
                                   "-video_size",
                                   size,
                                   "-framerate",
                                   wr_number_print(o->fps, rate),
                                   "-i",
                                   "pipe:0",
                                   "-map_metadata",
                                   "-1",
                                   "-fflags",
                                   "+bitexact",
                                   "-flags:v",
                                   "+bitexact" };
    for (size_t i = 0; i < WR_LENGTH(before); i++) add(&line, before[i]);
    for (const char *const *word = film->kind->coding; *word; word++)
        add(&line, strcmp(*word, "LOOP") == 0 ? loop : *word);
    add(&line, "-y");
    add(&line, wr_text_get(&out));
    const bool good = tool_start(&film->tool, line.words, film->spool.fd, o->patience, err);
    wr_text_fini(&out);
    return good;
}

/* ---- film ---- */

/* 4:2:0 chroma has one sample for 2 x 2 pixels: H.264 needs even sides. */
static int even(const WrFilmKind *kind, int side)
{
    return kind->even ? (side + 1) / 2 * 2 : side;
}

static WrFilm *new_film(const WrFilmKind *kind, const WrFilmOptions *options)
{
    WrFilm *film = wr_alloc(1, sizeof *film);
    film->kind = kind;
    film->options = *options;
    if (!(options->patience > 0.0)) film->options.patience = PATIENCE;
    film->width = even(kind, options->width);
    film->height = even(kind, options->height);
    film->channels = options->alpha ? 4 : 3;
    film->spool.fd = -1;
    film->tool = (WrTool){ .channel = -1, .complaints = -1 };
    return film;
}

static bool allocate(WrFilm *film, WrError *err)
{
    const size_t bytes = (size_t)film->width * (size_t)film->height * (size_t)film->channels;
    if (film->width != film->options.width || film->height != film->options.height) {
        film->padded = wr_try_alloc(bytes, 1, "a frame", err);
        if (!film->padded) return false;
    }
    film->read = wr_try_alloc(bytes, 1, "a frame", err);
    if (film->read && !wr_spool_open(&film->spool))
        return wr_fail(err, "a film: no memory file can be created (%s)", strerror(errno));
    return film->read != NULL;
}

WrFilm *wr_film_begin(const char *path, const WrFilmOptions *options, WrError *err)
{
    const WrFilmKind *kind = wr_film_kind(path);
    if (!check(path, kind, options, err)) return NULL;
    WrFilm *film = new_film(kind, options);
    if (allocate(film, err) && wr_file_begin(&film->target, path, err) && start(film, err))
        return film;
    wr_film_drop(film);
    return NULL;
}

void wr_film_drop(WrFilm *film)
{
    if (!film) return;
    tool_drop(&film->tool);
    wr_spool_close(&film->spool);
    wr_file_abort(&film->target);
    wr_free(film->padded);
    wr_free(film->read);
    wr_array_free(&film->sums);
    wr_free(film);
}

/* Repeats the last column and row. */
static const uint8_t *padded(WrFilm *film, const uint8_t *pixels)
{
    const size_t pixel = (size_t)film->channels, width = (size_t)film->options.width * pixel;
    const size_t wide = (size_t)film->width * pixel;
    if (!film->padded) return pixels;
    for (int y = 0; y < film->height; y++) {
        const int from = y < film->options.height ? y : film->options.height - 1;
        uint8_t *row = film->padded + (size_t)y * wide;
        memcpy(row, pixels + (size_t)from * width, width);
        if (wide > width) memcpy(row + width, row + width - pixel, pixel);
    }
    return film->padded;
}

/* Copies ffmpeg's output to the disk. ffmpeg writes into a spool in memory and never learns the file's path; completed parts
   are moved to the disk between frames. A format that is rewritten at the end (`rereads`: MP4's index moves to the front)
   stays in the spool until then. */
static bool pass_on(WrFilm *film, bool ended, WrError *err)
{
    char why[WR_FILE_WHY];
    const WrByteSink to = wr_file_sink(&film->target);
    if (!ended && film->kind->rereads) return true;
    if ((ended ? wr_spool_end : wr_spool_move)(&film->spool, &to)) return true;
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    return wr_fail(err, "cannot be written (%s)", wr_file_why(errno, why));
}

bool wr_film_add(WrFilm *film, const uint8_t *pixels, WrError *err)
{
    WrFilmSums sums;
    const size_t bytes = (size_t)film->width * (size_t)film->height * (size_t)film->channels;
    if (film->sums.count >= WR_FILM_FRAMES)
        return wr_fail(err, "%s: a film has at most %d frames", film->target.path, WR_FILM_FRAMES);
    pixels = padded(film, pixels);
    film_sum(pixels, film->width, film->height, film->channels, &sums);
    wr_array_push(&film->sums, sums);
    if (tool_put(&film->tool, pixels, bytes, err) && pass_on(film, false, err)) return true;
    if (!wr_progress_stopped()) wr_error_prefix(err, "%s: ", film->target.path);
    return false;
}

/* err must not refer to the path, which is freed with the film. */
static bool finish(WrFilm *film, WrFilmReport *report, WrError *err)
{
    *report = (WrFilmReport){
        .kind = film->kind, .width = film->width, .height = film->height, .frames = film->sums.count
    };
    if (film->sums.count == 0) return wr_fail(err, "a film needs at least one frame");
    if (!tool_finish(&film->tool, err)) return false;
    tool_drop(&film->tool);
    return pass_on(film, true, err) && film_check(film, report, err);
}

bool wr_film_end(WrFilm *film, WrFilmReport *report, WrError *err)
{
    bool good = finish(film, report, err);
    if (good) good = wr_file_commit(&film->target, err);
    else if (!wr_progress_stopped()) wr_error_prefix(err, "%s: ", film->target.path);
    wr_film_drop(film);
    return good;
}

void wr_film_report_text(const WrFilmReport *report, WrText *text)
{
    wr_text_addf(text, "%dx%d, %lld frame%s, ", report->width, report->height,
                 (long long)report->frames, report->frames == 1 ? "" : "s");
    if (report->bytes < 1000000) wr_text_addf(text, "%.3g kB", (double)report->bytes / 1e3);
    else wr_text_addf(text, "%.3g MB", (double)report->bytes / 1e6);
    wr_text_add(text, "; read back: ");
    if (report->worst > 0) wr_text_addf(text, "colours off by at most %.2g of 255", report->worst);
    else wr_text_add(text, "exact");
}

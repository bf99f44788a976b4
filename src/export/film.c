#include "export/film.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "export/film_internal.h"

#include <errno.h>
#include <string.h>

#define PATIENCE 300.0 /* seconds: one frame of the largest size takes that order of time */
#define LEAST_FPS 0.1
#define MOST_FPS 240.0
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
      .most_fps = MOST_FPS,
      .most_side = 16384,
      .wrong = 0.0,
      .coding = { "-vf", SRGB, "-c:v", "apng", "-pred", "mixed", TAGS, "-f", "apng", "-plays",
                  "LOOP" },
      .first_loop = 1 },
    { .ending = "webp",
      .name = "WebP",
      .alpha = true,
      .loops = true,
      .most_fps = MOST_FPS,
      .most_side = 16383,
      .wrong = 8.0,
      .by_reader = true,
      .coding = { "-c:v", "libwebp_anim", "-pix_fmt", "bgra", "-quality", "90", "-f", "webp",
                  "-loop", "LOOP" },
      .first_loop = 1 },
    { .ending = "mp4",
      .name = "MP4",
      .even = true,
      .most_fps = MOST_FPS,
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
        return wr_fail(err, "%s: loop %d: must be how often it is played, 0 (for ever) to 65535",
                       path, o->loop);
    if (o->loop != 0 && !kind->loops)
        return wr_fail(err, "%s: loop %d: %s does not say how often it is played", path, o->loop,
                       kind->name);
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
    const bool good = wr_tool_start(&film->tool, line.words, film->spool.fd, o->patience, err);
    wr_text_fini(&out);
    return good;
}

/* ---- film ---- */

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
        return wr_fail(err, "a film: no memory file can be had (%s)", strerror(errno));
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
    wr_tool_drop(&film->tool);
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

/* Copies ffmpeg's output to the disk. */
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
    wr_film_sum(pixels, film->width, film->height, film->channels, &sums);
    wr_array_push(&film->sums, sums);
    if (wr_tool_put(&film->tool, pixels, bytes, err) && pass_on(film, false, err)) return true;
    if (!wr_progress_stopped()) wr_error_prefix(err, "%s: ", film->target.path);
    return false;
}

/* err must not refer to the path, which is freed with the film. */
static bool finish(WrFilm *film, WrFilmReport *report, WrError *err)
{
    *report = (WrFilmReport){
        .kind = film->kind, .width = film->width, .height = film->height, .frames = film->sums.count
    };
    if (film->sums.count == 0) return wr_fail(err, "a film needs a frame");
    if (!wr_tool_finish(&film->tool, err)) return false;
    wr_tool_drop(&film->tool);
    return pass_on(film, true, err) && wr_film_check(film, report, err);
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

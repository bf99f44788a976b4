/* film.h - encoding of animations: frames are passed to ffmpeg as they are rendered. One row of wr_film_kinds
   for each format. Memory holds only one frame.

   ffmpeg is searched in the user's PATH, receives the frames through a pipe, and writes a file in memory
   (base/spool.h). Its bytes are copied by base/file.h to a temporary file beside the target, which is renamed
   when it is complete and verified. Verification compares its bytes with those from ffmpeg, and decodes it by
   ffmpeg: the number of frames, and the mean colours of a grid of cells in each frame are compared with the
   originals (for animated WebP, which ffmpeg cannot decode, the total time, and the colours of the first and the
   last frame). ffmpeg ends together with this program, however that ends. Frames are 8-bit sRGB, and tagged so
   where the format has tags. H.264 uses Rec. 709's matrix and chroma at half the resolution, so it needs even
   sizes: the last column or row of an odd one is repeated. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_FILM_FRAMES 100000 /* maximum */

typedef struct WrFilmKind {
    const char *ending; /* file extension */
    const char *name;
    bool alpha;      /* frames may be R,G,B,A */
    bool loops;      /* the file stores the number of repeats */
    bool even;       /* requires even sizes */
    double most_fps; /* highest frame rate that players support */
    int most_side;   /* pixels */
    bool by_reader;  /* it is verified by the picture reader instead of ffmpeg */
    bool rereads;    /* ffmpeg reads the whole file again before it ends */
    double wrong;    /* codes: largest accepted error of a cell's mean when verified */
    /* ffmpeg's arguments between the frames and the file, ends in NULL; LOOP stands for the number for -loop or
       -plays */
    const char *coding[20];
    int first_loop; /* the number that means playing once; -1 or 1 */
} WrFilmKind;

enum { WR_FILM_GIF, WR_FILM_APNG, WR_FILM_WEBP, WR_FILM_MP4, WR_FILM_KIND_COUNT };
extern const WrFilmKind wr_film_kinds[];
/* The kind by the path's extension; NULL: not a film. */
const WrFilmKind *wr_film_kind(const char *path);

typedef struct WrFilmOptions {
    int width, height; /* pixels */
    double fps;        /* frames a second, 0.1..240 */
    int loop;        /* number of repetitions; 0: endless, also for formats without this setting */
    bool alpha;      /* frames are R,G,B,A, not premultiplied; else R,G,B */
    double patience; /* longest time, seconds, without input or output of ffmpeg; 0: 300 */
} WrFilmOptions;

typedef struct WrFilmReport {
    const WrFilmKind *kind;
    int width, height; /* of the file */
    int64_t frames;
    int64_t bytes;
    double worst; /* codes: largest error of a cell's mean */
} WrFilmReport;

typedef struct WrFilm WrFilm;

/* Begins a file. All invalid input is reported here: an unknown extension, a size or rate that the format does
   not support, a read-only folder, a machine without ffmpeg. The caller owns it; NULL and an error. */
WrFilm *wr_film_begin(const char *path, const WrFilmOptions *options, WrError *err);
/* Adds a frame, [height][width][3 or 4]; waits until ffmpeg has read it, or the work is cancelled
   (base/progress.h). */
bool wr_film_add(WrFilm *film, const uint8_t *pixels, WrError *err);
/* Finishes and verifies the file, then renames it to the target. Frees the film in any case. */
bool wr_film_end(WrFilm *film, WrFilmReport *report, WrError *err);
/* Cancels the film: the old file stays. Frees it; NULL is allowed. */
void wr_film_drop(WrFilm *film);

/* "512x512, 120 frames, 1.3 MB; read back: colours off by at most 1.2 of 255". */
void wr_film_report_text(const WrFilmReport *report, WrText *text);

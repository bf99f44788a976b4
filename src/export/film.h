/* film.h - moving pictures: frames handed to the program ffmpeg as they are drawn, so that no more than one lies in
   memory here. One row in wr_film_kinds a format.
   Layer 6.

   ffmpeg is found where the user's programs are, gets the frames through a pipe, and writes a file in memory
   (base/spool.h). Its bytes go through the one door of all files (base/file.h) to a file beside the target, which takes its
   name when it is whole and was read back: its bytes beside those that ffmpeg wrote, and by ffmpeg again, all frames, their number, and
   the mean colours of a grid of cells in each beside those that were handed over (of animated WebP, which ffmpeg does
   not read, the time of all frames, and the colours of the first and the last). It ends with this program, however
   that ends. Frames are 8-bit sRGB, and tagged so where a format has tags; H.264 has brightness and colour by Rec. 709's matrix, colour at half the resolution, and so
   even sizes only: of an odd one the last column or row is there twice. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

#define WR_FILM_FRAMES 100000 /* at most */

typedef struct WrFilmKind {
    const char *ending; /* of its files */
    const char *name;
    bool alpha;      /* frames may be R,G,B,A */
    bool loops;      /* the file says how often it is played */
    bool even;       /* sizes */
    double most_fps; /* that players keep to */
    int most_side;   /* pixels */
    bool by_reader;  /* it is not read back by ffmpeg */
    bool rereads;    /* ffmpeg reads the whole file once more before it ends */
    double wrong;    /* codes: how far a cell's mean may be off when it is read back */
    /* What ffmpeg is told between the frames and the file, ends in NULL; LOOP stands for the number that its -loop or
     * -plays takes */
    const char *coding[20];
    int first_loop; /* what it calls playing once; -1 or 1 */
} WrFilmKind;

enum { WR_FILM_GIF, WR_FILM_APNG, WR_FILM_WEBP, WR_FILM_MP4, WR_FILM_KIND_COUNT };
extern const WrFilmKind wr_film_kinds[];
/* By the path's ending; NULL: it is no film. */
const WrFilmKind *wr_film_kind(const char *path);

typedef struct WrFilmOptions {
    int width, height; /* pixels */
    double fps;        /* frames a second, 0.1..240 */
    int loop;        /* how often it is played; 0: for ever, which is what formats without it get */
    bool alpha;      /* frames are R,G,B,A, not premultiplied; else R,G,B */
    double patience; /* seconds that ffmpeg may take without taking or giving anything; 0: 300 */
} WrFilmOptions;

typedef struct WrFilmReport {
    const WrFilmKind *kind;
    int width, height; /* of the file */
    int64_t frames;
    int64_t bytes;
    double worst; /* codes: the largest difference of a cell's mean */
} WrFilmReport;

typedef struct WrFilm WrFilm;

/* Begin a file. Everything is refused here that can be: an unknown ending, a size or rate that the format does not have, a
 * folder that cannot be written, a machine without ffmpeg. The caller owns it; NULL and an error. */
WrFilm *wr_film_begin(const char *path, const WrFilmOptions *options, WrError *err);
/* The next frame, [height][width][3 or 4]; waits until ffmpeg has taken it, or the work is cancelled (base/progress.h). */
bool wr_film_add(WrFilm *film, const uint8_t *pixels, WrError *err);
/* All frames are there: finish the file, read it back, let it take its name. Frees the film either way. */
bool wr_film_end(WrFilm *film, WrFilmReport *report, WrError *err);
/* Give it up: what was there stays. Frees it; NULL is fine. */
void wr_film_drop(WrFilm *film);

/* "512x512, 120 frames, 1.3 MB; read back: colours off by at most 1.2 of 255". */
void wr_film_report_text(const WrFilmReport *report, WrText *text);

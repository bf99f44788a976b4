/* film_internal.h - the ffmpeg process and a film's state, shared by the film files. Private to this module. */
#pragma once
#include "base/array.h"
#include "base/file.h"
#include "base/spool.h"
#include "export/film.h"
#include "system/child.h"

#include <stddef.h>

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

/* Starts ffmpeg; arguments end in NULL. out: an open file that becomes its standard output, while it reads from
   the channel; -1: its output comes through the channel. */
bool wr_tool_start(WrTool *tool, const char *const *arguments, int out, double patience,
                   WrError *err);
/* Writes all bytes; false also if cancelled, or if it reads nothing for longer than its patience. */
bool wr_tool_put(WrTool *tool, const void *bytes, size_t length, WrError *err);
/* Reads up to `length` bytes, fewer only at its end: *got. */
bool wr_tool_get(WrTool *tool, void *bytes, size_t length, size_t *got, WrError *err);
/* Closes its input and waits for its end; false and its error output if it failed. */
bool wr_tool_finish(WrTool *tool, WrError *err);
/* Kills it if it runs, and clears the struct; allowed after finish, and if it was never started (zeroed, channel
   -1). */
void wr_tool_drop(WrTool *tool);

/* Mean colours of a frame's cells. */
typedef struct WrFilmSums {
    uint16_t mean[WR_FILM_GRID * WR_FILM_GRID][4]; /* in 257ths of a code: 65535 is 255 */
} WrFilmSums;

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

/* film_check.c: verifies the finished file. */
bool wr_film_check(WrFilm *film, WrFilmReport *report, WrError *err);
void wr_film_sum(const uint8_t *pixels, int width, int height, int channels, WrFilmSums *sums);

/* film_internal.h - what the files of films know of one another.
   Private to this room. */
#pragma once
#include "base/array.h"
#include "base/file.h"
#include "base/spool.h"
#include "export/film.h"
#include "system/child.h"

#include <stddef.h>

#define WR_FILM_GRID 8 /* cells a side in which colours are compared, at most */

/* The program at work: bytes go in or come out through one channel. */
typedef struct WrTool {
    WrPid child;
    int channel, complaints; /* -1: none */
    double patience;         /* seconds */
    double since;            /* clock when it last took or gave something */
    bool ended;
    WrChildEnd end;
} WrTool;

/* Start ffmpeg; arguments end in NULL. out: an open file that becomes its standard output, and it reads from the channel;
 * -1: what it writes there comes through the channel. */
bool wr_tool_start(WrTool *tool, const char *const *arguments, int out, double patience,
                   WrError *err);
/* All of the bytes; false also when cancelled, or when it takes nothing for longer than its patience. */
bool wr_tool_put(WrTool *tool, const void *bytes, size_t length, WrError *err);
/* Up to `length` bytes, as many as there are until it ends: *got. */
bool wr_tool_get(WrTool *tool, void *bytes, size_t length, size_t *got, WrError *err);
/* Nothing more is put: wait until it ends; false and what it complained of where that was not well. */
bool wr_tool_finish(WrTool *tool, WrError *err);
/* Kill it if it runs, and forget it; fine after finish, and when it was never started (zeroed, channel -1). */
void wr_tool_drop(WrTool *tool);

/* Mean colours of a frame's cells. */
typedef struct WrFilmSums {
    uint16_t mean[WR_FILM_GRID * WR_FILM_GRID][4]; /* 257 codes: 65535 is 255 */
} WrFilmSums;

struct WrFilm {
    const WrFilmKind *kind;
    WrFilmOptions options;
    WrFileTarget target;
    WrSpool spool; /* that ffmpeg writes to */
    WrTool tool;
    int width, height; /* of the file */
    int channels;
    uint8_t *padded;           /* a frame of the file's size, where that is another; owned */
    uint8_t *read;             /* a frame that is read back; owned */
    WR_ARRAY(WrFilmSums) sums; /* of each frame */
};

/* film_check.c: read the finished file back. */
bool wr_film_check(WrFilm *film, WrFilmReport *report, WrError *err);
void wr_film_sum(const uint8_t *pixels, int width, int height, int channels, WrFilmSums *sums);

/* check.h - inspection of a picture file from any program: tileability, kind of content, and precision. Files
   are read like all pictures (image/image.h), by the reader process; only the numbers are trusted, not the
   file's claims.

    Edges     by the seam test (field/seam_check.h), for each colour; the worst one counts. For a sheet of several copies,
              as stated by our own label, the cell's edges; for a picture with its border the cell without it. A
              label also states the seam of the original data: a seam stated there is reported, and if it states
              none the numbers must exceed WR_CHECK_SURELY times the largest inner step. Axes of fewer than 8
              texels, atlases and maps of whole surfaces are not tested.
    Numbers   the number of distinct values (counted up to 65536), and the fewest bits that represent them all: b bits
              are codes round(k M/(2^b - 1)), or k 2^(B - b) of B bits; floats k/255, k/65535 and half precision. Not
              tested with fewer than 8 values besides black and white.
    Normals   three colours whose vectors have nearly length 1 and point up (scene/normal_map.h): green's direction,
              the largest deviation of a length from 1, and
                  curl^2 = 1 - sum a b / sqrt(sum a^2 sum b^2),   a = D_v p, b = D_u q
              with D central differences except at the edges, minus the effect of rounding on the squares: 0 for
              heights, whatever the cell's sides, 1 for unrelated slopes. Unknown if a and b are 0 except for
              rounding, as for f(u) + g(v). Two floats that the file does not label as grey and coverage are taken as
              the slopes p and q themselves. */
#pragma once
#include "base/enum_rows.h"
#include "field/seam_check.h"
#include "image/normal_encoding.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

/* Kind of content. */
#define WR_CHECK_KINDS(X)                                                                          \
    X(WR_CHECK_HEIGHT, "height")                                                                   \
    X(WR_CHECK_NORMAL, "normal")                                                                   \
    X(WR_CHECK_SLOPES, "slopes")                                                                   \
    X(WR_CHECK_COLOUR, "colour")
typedef enum WrCheckKind { WR_CHECK_KINDS(WR_WORD_ID) WR_CHECK_KIND_COUNT } WrCheckKind;
extern const char *const wr_check_kinds[];

/* Problems, with their names in machine-readable output. */
#define WR_CHECK_PROBLEMS(X)                                                                       \
    X(WR_CHECK_SEAM_U, "seam-u")                                                                   \
    X(WR_CHECK_SEAM_V, "seam-v")                                                                   \
    X(WR_CHECK_LOST, "not-finite")                                                                 \
    X(WR_CHECK_STEPS, "steps")                                                                     \
    X(WR_CHECK_LENGTH, "length")                                                                   \
    X(WR_CHECK_AWAY, "away")                                                                       \
    X(WR_CHECK_CURL, "curl")                                                                       \
    X(WR_CHECK_CONVERTED, "converted")                                                             \
    X(WR_CHECK_LABEL, "label")
typedef enum WrCheckProblem { WR_CHECK_PROBLEMS(WR_WORD_ID) WR_CHECK_PROBLEM_COUNT } WrCheckProblem;
extern const char *const wr_check_problems[];

#define WR_CHECK_SURELY                                                                            \
    3 /* factor over the largest inner step: counts as a seam even if our own label states none */

typedef struct WrCheckEdge {
    bool judged;     /* has enough texels */
    bool seam;       /* the height or the slope is discontinuous there */
    bool by_label;   /* a seam stated by the file's own label; not visible in its numbers */
    bool repeats;    /* the seam consists of a repeated line: the last one equals the first */
    WrSeamEdge test; /* for the worst colour, in the file's numbers */
} WrCheckEdge;

#define WR_CHECK_DISTINCT 65536 /* limit of distinct numbers */

typedef struct WrCheckNumbers {
    int distinct; /* WR_CHECK_DISTINCT: this many or more */
    int bits;     /* sufficient for all: 1..16; floats 8, 16, 32 */
    bool half;    /* half-precision floats */
    bool judged;  /* there are enough numbers */
    double low, high;
    double at_low, at_high; /* share of the numbers at either end of the range, 0..1 */
} WrCheckNumbers;

typedef struct WrCheckNormals {
    bool green_known, green_down;
    bool own;     /* floats that are the vectors' own components, not encoded in 0..1 */
    bool centred; /* zero is encoded by the code above the middle, as in most texels */
    bool lengths; /* has three components per vector */
    double off;   /* largest deviation of a length from 1 */
    bool curl_known;
    double curl;
    int64_t away; /* normals that point away from the surface */
    bool converted;
} WrCheckNormals;

typedef struct WrCheck {
    int width, height, channels;
    int depth;         /* bits per number in the file: 8, 16, 32 (float) */
    const char *label; /* kind of export in our own label; NULL: none */
    WrCheckKind kind;
    WrCheckEdge u, v; /* left and right; top and bottom */
    WrCheckNumbers numbers;
    WrCheckNormals normals; /* for normals and slopes */
    int64_t replaced;       /* non-finite texels */
    unsigned problems;      /* bits 1 << WrCheckProblem */
} WrCheck;

/* Inspects a file. kind: if known; -1: detected. coding: of float normals. False and an error if the file cannot
   be read. */
bool wr_check_picture(const char *path, int kind, WrCoding coding, WrCheck *check, WrError *err);

/* check.h - is a picture file, whoever made it, a cell that can be laid side by side, what do its numbers stand for,
   and how fine are they?
   Layer 6. Read as all pictures are (image/image.h), by the reader process; nothing of the file is believed but its
   numbers.

   Edges     by the seam test of the certificate (field/seam.h), for each colour; the worst one. Of a sheet of several
             copies, as a label of ours tells, the cell's edges; of a picture with its border the cell without it. A label
             also says how the edges met before the picture was coded: a seam that it tells of is one, and where it tells
             of none the numbers must be WR_CHECK_SURELY times what is inside. Axes of fewer than 8 texels, atlases and
             maps of whole surfaces are not judged.
   Numbers   how many different ones (told up to 65536), and the fewest bits that hold them all: b bits are codes
             round(k M/(2^b - 1)), or k 2^(B - b) of B bits; floats k/255, k/65535 and half precision. Not judged
             where there are fewer than 8 besides black and white.
   Normals   three colours whose vectors are nearly of length 1 and look up (scene/normal_map.h): green's direction, the
             largest distance of a length from 1, and
                 curl^2 = 1 - sum a b / sqrt(sum a^2 sum b^2),   a = D_v p, b = D_u q
             with D central differences but at the edges, less what rounding brings to the squares: 0 of heights,
             whatever the cell's sides, 1 of slopes that have nothing to do with one another. Not known where a and b
             are 0 but for rounding, as of f(u) + g(v).
             Two floats that the file does not call grey and coverage are taken for the slopes p and q themselves. */
#pragma once
#include "base/enum_rows.h"
#include "field/seam.h"
#include "image/coding.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;

/* What the numbers stand for. */
#define WR_CHECK_KINDS(X)                                                                          \
    X(WR_CHECK_HEIGHT, "height")                                                                   \
    X(WR_CHECK_NORMAL, "normal")                                                                   \
    X(WR_CHECK_SLOPES, "slopes")                                                                   \
    X(WR_CHECK_COLOUR, "colour")
typedef enum WrCheckKind { WR_CHECK_KINDS(WR_WORD_ID) WR_CHECK_KIND_COUNT } WrCheckKind;
extern const char *const wr_check_kinds[];

/* What can be wrong, and how programs are told. */
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
    3 /* times what is inside: a seam in spite of a label of ours that tells of none */

typedef struct WrCheckEdge {
    bool judged;     /* has texels enough */
    bool seam;       /* the height steps or the slope breaks there */
    bool told;       /* a seam as the file's own label tells; its numbers do not show it */
    bool repeats;    /* a seam, since the last line is the first one again */
    WrSeamEdge test; /* of the worst colour, in the file's numbers */
} WrCheckEdge;

#define WR_CHECK_DISTINCT 65536 /* numbers that are told apart */

typedef struct WrCheckNumbers {
    int distinct; /* WR_CHECK_DISTINCT: so many or more */
    int bits;     /* that hold them all: 1..16; floats 8, 16, 32 */
    bool half;    /* floats of half precision */
    bool judged;  /* enough of them for that */
    double low, high;
    double at_low, at_high; /* share of them that are these two, 0..1 */
} WrCheckNumbers;

typedef struct WrCheckNormals {
    bool green_known, green_down;
    bool own;     /* floats that are the vectors' own numbers, not coded in 0..1 */
    bool centred; /* the code above the middle stands for 0, as in most texels */
    bool lengths; /* has three numbers a vector */
    double off;   /* the largest distance of a length from 1 */
    bool curl_known;
    double curl;
    int64_t away; /* look away from the surface */
    bool converted;
} WrCheckNormals;

typedef struct WrCheck {
    int width, height, channels;
    int depth;         /* bits of a number as the file holds it: 8, 16, 32 (float) */
    const char *label; /* what our own label calls it, a kind of export; NULL: none */
    WrCheckKind kind;
    WrCheckEdge u, v; /* left and right; top and bottom */
    WrCheckNumbers numbers;
    WrCheckNormals normals; /* of normals and slopes */
    int64_t replaced;       /* texels that were not finite */
    unsigned problems;      /* bits 1 << WrCheckProblem */
} WrCheck;

/* kind: what it is, where somebody knows; -1: found out. coding: of normals in floats. False and an error where it cannot
 * be read. */
bool wr_check_file(const char *path, int kind, WrCoding coding, WrCheck *check, WrError *err);

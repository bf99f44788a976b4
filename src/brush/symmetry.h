/* symmetry.h - symmetric copies of a stroke: mirrors, rotations about a point, and a lattice over the
   cell.

   Computed in texel space, so that copies keep their shape in a cell that is not square. The copies are
   all products of

     mirror_u   x -> 2 cx - x        mirror_v   y -> 2 cy - y        (c: the centre)
     radial n   rotations by 360/n degrees about the centre
     repeat     shifts by i (1/M, stagger/N) and j (0, 1/N) cells, i < M, j < N: column i is i/M to the
                right and i stagger rows higher (half-drop: M even, stagger 1/2)

   If M stagger is an integer the repeat is a lattice that closes around the periodic cell; others are
   rejected. Every lattice that contains the cell's own is one of these, except for exchanging u and v. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;

#define WR_COPIES_MAX 4096 /* of a stroke */

typedef struct WrSymmetry {
    bool mirror_u, mirror_v;
    int radial;                /* 1..360; 0 and 1: none */
    double centre_u, centre_v; /* of mirrors and rotations */
    int repeat_u, repeat_v;    /* M, N, 1..64; 0 is treated as 1 */
    double stagger;            /* 0 <= stagger < 1 */
} WrSymmetry;

/* Words for mirror_u + 2 mirror_v, as in commands: "none", "u", "v", "uv"; ends with NULL. */
extern const char *const wr_mirror_names[];

/* An isometry of texel space: (x, y) -> (a x + b y + dx, c x + d y + dy), y down. */
typedef struct WrCopy {
    double a, b, c, d, dx, dy;
    bool flips; /* includes a reflection */
} WrCopy;

/* Checks ranges, closing of the lattice, WR_COPIES_MAX; errors name the command's arguments. */
bool wr_symmetry_check(const WrSymmetry *symmetry, WrError *err);
/* The copies for a table of that size; the first is the identity. Returns their number; symmetry out of
   range yields 1. Sine and cosine from base/exactmath.h. out: [WR_COPIES_MAX] */
int wr_symmetry_copies(const WrSymmetry *symmetry, const WrField *field, WrCopy *out);

/* symmetry.h - the copies of a stroke: mirrors, turns about a point, and a lattice over the cell.
   Everything happens in texel space, so that copies keep their shape in a cell that is not
   square.

   The copies are all products of
     mirror_u   x -> 2 cx - x        mirror_v   y -> 2 cy - y        (c: the centre)
     radial n   turns by 360/n degrees about the centre
     repeat     moves by i (1/M, stagger/N) and j (0, 1/N) cells, i < M, j < N: column i lies i/M to the
                right and i stagger rows higher (half-drop: M even, stagger 1/2)
   With M stagger a whole number the repeat is a lattice that closes round the periodic cell; others are
   refused. Every lattice that contains the cell's own is one of these, but for exchanging u and v. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrField WrField;

#define WR_COPIES_MAX 4096 /* of a stroke */

typedef struct WrSymmetry {
    bool mirror_u, mirror_v;
    int radial;                /* 1..360; 0 and 1: none */
    double centre_u, centre_v; /* of mirrors and turns */
    int repeat_u, repeat_v;    /* M, N, 1..64; 0 counts as 1 */
    double stagger;            /* 0 <= stagger < 1 */
} WrSymmetry;

/* Words for mirror_u + 2 mirror_v, as in commands: "none", "u", "v", "uv"; ends with NULL. */
extern const char *const wr_env_lookup_names[];

/* An isometry of texel space: (x, y) -> (a x + b y + dx, c x + d y + dy), y down. */
typedef struct WrCopy {
    double a, b, c, d, dx, dy;
    bool flips; /* a mirror image */
} WrCopy;

/* Ranges, the lattice's closing, WR_COPIES_MAX; names what is wrong as the command's arguments do. */
bool wr_symmetry_check(const WrSymmetry *symmetry, WrError *err);
/* The copies for a table of that size; the first is the identity. Returns how many; symmetry out of
   range gives 1. Sine and cosine from base/exactmath.h. out: [WR_COPIES_MAX] */
int wr_symmetry_copies(const WrSymmetry *symmetry, const WrField *field, WrCopy *out);

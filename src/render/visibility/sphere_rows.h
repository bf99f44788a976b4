/* sphere_rows.h - ray hits of a sphere seen from outside, as polynomials of the pixel position. Private to the
   renderer.

   For rays o + t d, either o is constant and d linear in the position x, y (perspective), or the other way
   round. So d.d is a quadratic, and so is r^2 = (o.d)^2 - d.d (o.o - 1), in radii. The nearer hit is at t =
   -(o.d + r) / d.d. For the normal n, which is that point,
       n.w = (o.w d.d - o.d d.w - r d.w) / d.d,   n.v = r / |d|
   for any fixed w. The polynomials are computed once per picture in double, where nothing cancels. Each pixel
   then needs a few products in single precision, relative to the middle of its row's chord. */
#pragma once
#include "render/kernels/kern.h"

#include <stdbool.h>

/* c[0] + c[1] x + c[2] y + c[3] x^2 + c[4] x y + c[5] y^2. */
typedef struct WrForm {
    double c[6];
} WrForm;

/* n.w = (along - r across) / d.d. */
typedef struct WrSlant {
    WrForm along, across;
} WrSlant;

/* Lengths in radii. If not `good`, nothing else is valid; if not `shown`, `lit` is not used: opposite to the
   viewer |l + v| is inaccurate from l.v. */
typedef struct WrSphereRows {
    /* all of it is in front of the eye and beyond the near plane: its outline is an ellipse */
    bool good;
    WrForm dd, rr; /* d.d, r^2 */
    double by;     /* -1/2 divided by the coefficient of x^2 in r^2 */
    WrSlant n[3];  /* x, y, z components of n */
    bool shown;    /* the lamp is distant and nowhere nearly opposite to the viewer */
    WrSlant lit;   /* n.l; its across is d.l */
} WrSphereRows;

/* Computes the polynomials for the rays of a grid; light: one, or NULL. Keeps none of the arguments. If that is
   impossible, `good` is false. */
void wr_sphere_rows_make(WrSphereRows *ball, const WrRays *rays, const WrShapef *shape,
                         const WrKernLight *light);

/* Intersection of a row with a sphere that is good. */
typedef struct WrChord {
    double y, middle; /* positions in the grid; middle: a whole number */
    int first, last;  /* pixels that hit it, counted from gx, 0 .. count - 1; last < first: none */
} WrChord;

/* Chord of `count` pixels from (gx, y) on; false: so far away that positions are not exact. */
bool wr_chord_of(const WrSphereRows *ball, double gx, double y, int count, WrChord *chord);

/* The form along a row, relative to the middle of its chord: c[0] + c[1] x + c[2] x^2. */
static inline void wr_form_along(const WrForm *form, const WrChord *chord, float c[3])
{
    const double *of = form->c, y = chord->y, m = chord->middle;
    const double slope = of[1] + y * of[4];
    c[0] = (float)(of[0] + y * (of[2] + y * of[5]) + m * (slope + m * of[3]));
    c[1] = (float)(slope + 2 * m * of[3]);
    c[2] = (float)of[3];
}

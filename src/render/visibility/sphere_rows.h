/* sphere_rows.h - a sphere that is seen from outside, as the rays of a whole grid meet it: as polynomials of a pixel's place.
   Layer 5, private to the renderer.
   Of a ray o + t d either o is the same for all and d linear in the place x, y (perspective), or the other way round. So d.d is a
   quadratic, and so is r^2 = (o.d)^2 - d.d (o.o - 1), in radii; the nearer point is at t = -(o.d + r) / d.d, and of the normal n,
   which is that point,
       n.w = (o.w d.d - o.d d.w - r d.w) / d.d,   n.v = r / |d|
   for any fixed w. Made once a picture in double, where nothing cancels; what is left for each pixel are a few products in
   single precision, about the middle of its row's chord. */
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

/* Lengths in radii. Without `good` nothing else is there; without `shown` nobody goes by `lit`:
   opposite to the viewer l.v tells |l + v| badly. */
typedef struct WrSphereRows {
    bool good;     /* all of it is before the eye and the near plane: its outline is an ellipse */
    WrForm dd, rr; /* d.d, r^2 */
    double by;     /* -1/2 by the part of x^2 in r^2 */
    WrSlant n[3];  /* n's own x, y, z */
    bool shown;    /* the lamp is distant, nowhere nearly opposite to the viewer */
    WrSlant lit;   /* n.l; its across is d.l */
} WrSphereRows;

/* Of the rays of a grid; light: one, or NULL. The ball keeps none of them. No error: what it cannot be made of is not good. */
void wr_sphere_rows_make(WrSphereRows *ball, const WrRays *rays, const WrShapef *shape,
                         const WrKernLight *light);

/* Where a row meets it; of a ball that is good. */
typedef struct WrChord {
    double y, middle; /* places in the grid; middle: a whole number */
    int first, last;  /* pixels that meet it, counted from gx, 0 .. count - 1; last < first: none */
} WrChord;

/* Of `count` pixels from (gx, y) on; false: so far away that places are not exact. */
bool wr_chord_of(const WrSphereRows *ball, double gx, double y, int count, WrChord *chord);

/* The form along a row, about the middle of its chord: c[0] + c[1] x + c[2] x^2. */
static inline void wr_form_along(const WrForm *form, const WrChord *chord, float c[3])
{
    const double *of = form->c, y = chord->y, m = chord->middle;
    const double slope = of[1] + y * of[4];
    c[0] = (float)(of[0] + y * (of[2] + y * of[5]) + m * (slope + m * of[3]));
    c[1] = (float)(slope + 2 * m * of[3]);
    c[2] = (float)of[3];
}

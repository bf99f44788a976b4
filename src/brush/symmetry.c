#include "base/error.h"
#include "base/exactmath.h"
#include "brush/symmetry.h"
#include "field/field.h"

#include <math.h>

const char *const wr_mirror_names[] = { "none", "u", "v", "uv", NULL };

static int at_least_1(int n)
{
    return n > 1 ? n : 1;
}

bool wr_symmetry_check(const WrSymmetry *s, WrError *err)
{
    if (s->radial < 0 || s->radial > 360)
        return wr_fail(err, "radial=%d: must be 0..360", s->radial);
    if (s->repeat_u < 0 || s->repeat_u > 64 || s->repeat_v < 0 || s->repeat_v > 64)
        return wr_fail(err, "repeat=%d,%d: both must be 1..64", s->repeat_u, s->repeat_v);
    if (!isfinite(s->centre_u) || !isfinite(s->centre_v))
        return wr_fail(err, "centre=%g,%g: must be finite", s->centre_u, s->centre_v);
    if (!(s->stagger >= 0.0 && s->stagger < 1.0))
        return wr_fail(err, "stagger=%g: must be at least 0 and below 1", s->stagger);
    double rows = s->stagger * at_least_1(s->repeat_u);
    if (fabs(rows - rint(rows)) > 1e-9)
        return wr_fail(err,
                       "stagger=%g: times %d columns must be a whole number of rows, as with %g, "
                       "so that the repeat tiles",
                       s->stagger, at_least_1(s->repeat_u),
                       at_least_1(s->repeat_u) > 1 ? 1.0 / at_least_1(s->repeat_u) : 0.0);
    int64_t count = (int64_t)at_least_1(s->radial) * at_least_1(s->repeat_u) *
                    at_least_1(s->repeat_v) * (s->mirror_u ? 2 : 1) * (s->mirror_v ? 2 : 1);
    if (count > WR_COPIES_MAX)
        return wr_fail(err, "%lld copies of a stroke: at most %d", (long long)count, WR_COPIES_MAX);
    return true;
}

/* The linear part of a mirror or rotation about the centre (cx, cy), then a shift.
       x' = c + A (x - c) = A x + (c - A c),   A = (a b; c d)
   A is orthogonal, so det A is 1 or -1, and its sign decides whether a dab's picture is mirrored. */
static WrCopy about(double a, double b, double c, double d, double cx, double cy)
{
    WrCopy copy = { .a = a, .b = b, .c = c, .d = d, .flips = a * d - b * c < 0.0 };
    copy.dx = cx - (a * cx + b * cy);
    copy.dy = cy - (c * cx + d * cy);
    return copy;
}

static bool same(const WrCopy *p, const WrCopy *q)
{
    const double eps = 1e-9;
    return fabs(p->a - q->a) < eps && fabs(p->b - q->b) < eps && fabs(p->c - q->c) < eps &&
           fabs(p->d - q->d) < eps && fabs(p->dx - q->dx) < eps && fabs(p->dy - q->dy) < eps;
}

/* Rotations and mirrors about the centre; both mirrors together are half a turn, which an even radial
 * includes already: each isometry once. */
static int about_centre(const WrSymmetry *s, double cx, double cy, WrCopy *out)
{
    int count = 0, turns = at_least_1(s->radial);
    for (int m = 0; m < 4; m++) {
        if (((m & 1) && !s->mirror_u) || ((m & 2) && !s->mirror_v)) continue;
        double su = m & 1 ? -1.0 : 1.0, sv = m & 2 ? -1.0 : 1.0;
        for (int k = 0; k < turns; k++) {
            double sine, cosine;
            wr_sincos_turns((double)k / turns, &sine, &cosine);
            WrCopy copy = about(cosine * su, sine * sv, -sine * su, cosine * sv, cx, cy);
            bool known = false;
            for (int i = 0; i < count && !known; i++) known = same(&out[i], &copy);
            if (!known) out[count++] = copy;
        }
    }
    return count;
}

/* Texel centres are integers here, so the centre at u is width u - 1/2, and rows go down while v goes up. Each copy about the
   centre is shifted by every offset of the lattice. Offsets beyond the cell are not reduced: the table wraps, and an axis
   that does not wrap clips them. The identity comes first, since m = 0 and k = 0 are visited first. */
int wr_symmetry_copies(const WrSymmetry *s, const WrField *field, WrCopy *out)
{
    out[0] = (WrCopy){ .a = 1.0, .d = 1.0 };
    if (!wr_symmetry_check(s, NULL)) return 1;
    int width = wr_field_width(field), height = wr_field_height(field);
    double cx = width * s->centre_u - 0.5, cy = height * (1.0 - s->centre_v) - 0.5;
    int base = about_centre(s, cx, cy, out), count = base;
    int columns = at_least_1(s->repeat_u), rows = at_least_1(s->repeat_v);
    for (int i = 0; i < columns; i++)
        for (int j = 0; j < rows; j++) {
            if (i == 0 && j == 0) continue;
            for (int k = 0; k < base; k++) {
                WrCopy copy = out[k];
                copy.dx += (double)i * width / columns;
                copy.dy -= (i * s->stagger + j) * height / rows;
                out[count++] = copy;
            }
        }
    return count;
}

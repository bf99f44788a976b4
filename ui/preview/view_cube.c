#include "ui/preview/view_cube.h"

#include "base/exactmath.h"

#include <math.h>

WrRotation wr_rotation_inverse(const WrRotation *r)
{
    const double *m = r->m;
    return (WrRotation){ { m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8] } };
}

/* A ray along the view meets the slabs of the three axes; the last that it enters is the face. */
bool wr_cube_at(const WrRotation *cube, double x, double y, int side[3])
{
    const WrRotation back = wr_rotation_inverse(cube);
    const WrVec3 from = wr_rotation_apply(&back, (WrVec3){ x, y, 10 }),
                 way = wr_rotation_apply(&back, (WrVec3){ 0, 0, -1 });
    const double o[3] = { from.x, from.y, from.z }, d[3] = { way.x, way.y, way.z };
    double enters = -INFINITY, leaves = INFINITY;
    for (int k = 0; k < 3; k++) {
        if (fabs(d[k]) < 1e-12) {
            if (fabs(o[k]) > 1) return false;
            continue;
        }
        double a = (-1 - o[k]) / d[k], b = (1 - o[k]) / d[k];
        enters = fmax(enters, fmin(a, b));
        leaves = fmin(leaves, fmax(a, b));
    }
    if (enters > leaves) return false;
    for (int k = 0; k < 3; k++) {
        double at = o[k] + enters * d[k];
        side[k] = at > WR_CUBE_RIM ? 1 : at < -WR_CUBE_RIM ? -1 : 0;
    }
    return true;
}

WrRotation wr_cube_facing(const int side[3])
{
    const WrVec3 to = v3_unit((WrVec3){ side[0], side[1], side[2] }, (WrVec3){ 0, 0, 1 });
    const bool pole = side[0] == 0 && side[2] == 0;
    const WrVec3 up = pole ? (WrVec3){ 0, 0, -side[1] } : (WrVec3){ 0, 1, 0 };
    const WrVec3 right = v3_unit(v3_cross(up, to), (WrVec3){ 1, 0, 0 });
    const WrVec3 over = v3_cross(to, right);
    return (WrRotation){ { right.x, right.y, right.z, over.x, over.y, over.z, to.x, to.y, to.z } };
}

/* The axis of half a turn: a column of R + 1, the longest. */
static WrVec3 half_turn_axis(const double *m)
{
    WrVec3 best = { 1, 0, 0 };
    double longest = 0;
    for (int k = 0; k < 3; k++) {
        const WrVec3 column = { m[k] + (k == 0), m[3 + k] + (k == 1), m[6 + k] + (k == 2) };
        if (v3_len(column) <= longest) continue;
        longest = v3_len(column);
        best = v3_scale(column, 1 / longest);
    }
    return best;
}

WrRotation wr_rotation_between(const WrRotation *a, const WrRotation *b, double t)
{
    const WrRotation back = wr_rotation_inverse(a), whole = wr_rotation_times(b, &back);
    const double *m = whole.m;
    const WrVec3 twice = { m[7] - m[5], m[2] - m[6], m[3] - m[1] }; /* 2 sin of the angle, axis */
    const double s = v3_len(twice) / 2, c = (m[0] + m[4] + m[8] - 1) / 2, turn = atan2(s, c);
    if (turn < 1e-12) return *a;
    const WrVec3 axis = s > 1e-6 ? v3_scale(twice, 0.5 / s) : half_turn_axis(m);
    const WrRotation part = wr_rotation_axis(axis, turn * t * 180 / WR_PI);
    return wr_rotation_times(&part, a);
}

double wr_cube_ease(double t)
{
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

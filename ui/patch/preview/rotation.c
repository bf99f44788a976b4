#include "ui/patch/preview/rotation.h"

#include "base/exactmath.h"
#include "base/vec.h"

#include <math.h>

#define LIGHT_RIM_DEG 100.0

WrRotation wr_rotation_axis(WrVec3 k, double deg)
{
    /* R = cos t I + sin t [k] + (1 - cos t) k k^T */
    double s, c;
    wr_sincos_turns(deg / 360.0, &s, &c);
    double d = 1.0 - c;
    return (WrRotation){ { c + d * k.x * k.x, d * k.x * k.y - s * k.z, d * k.x * k.z + s * k.y,
                           d * k.y * k.x + s * k.z, c + d * k.y * k.y, d * k.y * k.z - s * k.x,
                           d * k.z * k.x - s * k.y, d * k.z * k.y + s * k.x, c + d * k.z * k.z } };
}

WrRotation wr_rotation_times(const WrRotation *a, const WrRotation *b)
{
    WrRotation out;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out.m[3 * i + j] = a->m[3 * i] * b->m[j] + a->m[3 * i + 1] * b->m[3 + j] +
                               a->m[3 * i + 2] * b->m[6 + j];
    return out;
}

WrVec3 wr_rotation_apply(const WrRotation *r, WrVec3 v)
{
    const double *m = r->m;
    return (WrVec3){ m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
                     m[6] * v.x + m[7] * v.y + m[8] * v.z };
}

WrRotation wr_rotation_inverse(const WrRotation *r)
{
    const double *m = r->m;
    return (WrRotation){ { m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8] } };
}

/* The axis of a half turn: the longest column of R + 1. */
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

WrRotation wr_rotation_from_deg(WrVec3 deg)
{
    WrRotation x = wr_rotation_axis((WrVec3){ 1, 0, 0 }, deg.x);
    WrRotation y = wr_rotation_axis((WrVec3){ 0, 1, 0 }, deg.y);
    WrRotation z = wr_rotation_axis((WrVec3){ 0, 0, 1 }, deg.z);
    WrRotation yx = wr_rotation_times(&y, &x);
    return wr_rotation_times(&z, &yx);
}

static double whole(double deg)
{
    double r = rint(deg);
    return fabs(deg - r) < 1e-9 ? r + 0.0 : deg;
}

/* With R = Rz Ry Rx:  m20 = -sin y,  m21 = cos y sin x,  m22 = cos y cos x,
 *                     m10 = cos y sin z,  m00 = cos y cos z.
 * At |sin y| = 1 the first column's rest vanishes, and with z = 0:  m01 = sin y sin x, m11 = cos x. */
WrVec3 wr_rotation_to_deg(const WrRotation *r)
{
    const double *m = r->m;
    double cos_y = sqrt(m[0] * m[0] + m[3] * m[3]);
    double x, z = 0.0, y = wr_atan2(-m[6], cos_y);
    if (cos_y > 1e-8) {
        x = wr_atan2(m[7], m[8]);
        z = wr_atan2(m[3], m[0]);
    } else {
        x = wr_atan2(-m[5], m[4]);
    }
    return (WrVec3){ whole(x / WR_RAD_PER_DEG), whole(y / WR_RAD_PER_DEG),
                     whole(z / WR_RAD_PER_DEG) };
}

WrRotation wr_rotation_dragged(const WrRotation *rotation, double turn_deg, WrVec3 right, WrVec3 up,
                               double dx, double dy, double span)
{
    WrRotation about_up = wr_rotation_axis(up, 180.0 * dx / span);
    WrRotation about_right = wr_rotation_axis(right, 180.0 * dy / span);
    WrRotation drag = wr_rotation_times(&about_right, &about_up);
    /* Displayed is T R. Required: T R' = D T R, so R' = T^-1 D T R. */
    WrRotation turn = wr_rotation_axis((WrVec3){ 0, 1, 0 }, turn_deg);
    WrRotation back = wr_rotation_axis((WrVec3){ 0, 1, 0 }, -turn_deg);
    WrRotation tr = wr_rotation_times(&turn, rotation);
    WrRotation dtr = wr_rotation_times(&drag, &tr);
    return wr_rotation_times(&back, &dtr);
}

static double larger(double x, double y)
{
    return fabs(x) > fabs(y) ? fabs(x) : fabs(y);
}

/* With r = max(|x|, |y|), the angle from the view axis is proportional to r^2: common light directions are then near
 * the pad's corners, where the object does not hide them. */
void wr_light_to_pad(WrVec3 towards, double *x, double *y)
{
    double side = sqrt(towards.x * towards.x + towards.y * towards.y);
    double angle = wr_atan2(side, towards.z) / WR_RAD_PER_DEG;
    double r = sqrt(angle < LIGHT_RIM_DEG ? angle / LIGHT_RIM_DEG : 1.0);
    double reach = larger(towards.x, towards.y);
    *x = reach > 0.0 ? r * towards.x / reach : 0.0;
    *y = reach > 0.0 ? r * towards.y / reach : 0.0;
}

WrVec3 wr_light_from_pad(double x, double y)
{
    double r = larger(x, y), s, c;
    double bounded = r < 1.0 ? r : 1.0, side = sqrt(x * x + y * y);
    wr_sincos_turns(bounded * bounded * LIGHT_RIM_DEG / 360.0, &s, &c);
    double k = side > 0.0 ? s / side : 0.0;
    return (WrVec3){ k * x, k * y, c };
}

#define ROCK_SECONDS 12.0 /* period */

/* The phase with this angle; of the two per period, the one in the previous direction of motion. */
static double rock_from(double turn_deg, double before)
{
    double sine = (turn_deg > 180.0 ? turn_deg - 360.0 : turn_deg) / WR_ROCK_DEG;
    double there = asin(sine < -1.0 ? -1.0 : sine > 1.0 ? 1.0 : sine);
    return cos(before) < 0.0 ? WR_PI - there : there;
}

double wr_rotation_rock(double *way, double turn_deg, double seconds)
{
    *way = fmod(rock_from(turn_deg, *way) + 2.0 * WR_PI * seconds / ROCK_SECONDS, 2.0 * WR_PI);
    double deg = WR_ROCK_DEG * sin(*way);
    return deg < 0.0 ? deg + 360.0 : deg;
}

/* ---- faces of the view cube ---- */

/* Intersect a ray along the view with the slabs of the three axes; the last one entered is the face. */
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

double wr_cube_ease(double t)
{
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

#include "ui/preview/view_cube.h"

#include <math.h>

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

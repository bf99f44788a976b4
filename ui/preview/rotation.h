/* rotation.h - turning things by dragging: rotations as matrices, and as the three angles of the
   `rotate` and `light` commands. Pure geometry; tested without a window. */
#pragma once
#include "base/vec.h"

/* Row-major, orthonormal: world = m object. */
typedef struct WrRotation {
    double m[9];
} WrRotation;

/* About the world's x axis, then y, then z (degrees): Rz Ry Rx, as the rotate command has it. */
WrRotation wr_rotation_from_deg(WrVec3 deg);
/* The angles of a rotation: x and z in -180..180, y in -90..90. At y = +-90, where only x -+ z counts,
 * z is 0. Angles within 1e-9 of a whole number of degrees are that number. */
WrVec3 wr_rotation_to_deg(const WrRotation *rotation);
WrRotation wr_rotation_axis(WrVec3 unit_axis, double deg);              /* right-handed */
WrRotation wr_rotation_times(const WrRotation *a, const WrRotation *b); /* first b, then a */
WrRotation wr_rotation_inverse(const WrRotation *rotation);
/* From a (t = 0) to b (t = 1) about one axis, evenly. */
WrRotation wr_rotation_between(const WrRotation *a, const WrRotation *b, double t);
WrVec3 wr_rotation_apply(const WrRotation *rotation, WrVec3 v);

/* A drag by (dx, dy) pixels across a view that is `span` pixels: `rotation` is the object's own, to which
 * a turn of turn_deg about the world's y axis is added when it is shown. The object follows the pointer:
 * half a turn for a drag across the view, about the camera's up and right axes (unit, world). The result
 * replaces `rotation`; the turn stays. */
WrRotation wr_rotation_dragged(const WrRotation *rotation, double turn_deg, WrVec3 right, WrVec3 up,
                               double dx, double dy, double span);

/* Where a direction towards the light (camera space: x right, y up, z to the viewer; any length > 0)
 * stands on a pad, x right and y up, each -1..1: the middle is straight from the viewer, the rim 100
 * degrees away, and the pad's corners are diagonal. Lights farther behind stand on the rim. */
void wr_light_to_pad(WrVec3 towards, double *x, double *y);
/* The inverse; points outside the pad count as its rim. Unit length. */
WrVec3 wr_light_from_pad(double x, double y);
#define WR_ROCK_DEG 35.0
/* The turn (0..360 degrees) so many seconds later of what rocks by 35 degrees to and fro, like a pendulum. *way: the
   caller's, 0 at first: where on the way it is. From an angle that is not on the way it begins at the nearest
   that is. */
double wr_rotation_rock(double *way, double turn_deg, double seconds);

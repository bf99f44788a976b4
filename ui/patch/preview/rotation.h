/* rotation.h - rotation by dragging: rotation matrices, and the three angles of the `rotate` and `light` commands.
   Pure geometry; tested without a window. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>

/* Row-major, orthonormal: world = m object. */
typedef struct WrRotation {
    double m[9];
} WrRotation;

/* About the world's x axis, then y, then z (degrees): Rz Ry Rx, as in the rotate command. */
WrRotation wr_rotation_from_deg(WrVec3 deg);
/* The angles of a rotation: x and z in -180..180, y in -90..90. At y = +-90, where only x -+ z matters, z is 0.
 * Angles within 1e-9 of an integer in degrees are rounded to it. */
WrVec3 wr_rotation_to_deg(const WrRotation *rotation);
WrRotation wr_rotation_axis(WrVec3 unit_axis, double deg); /* right-handed */
/* applies b first, then a */
WrRotation wr_rotation_times(const WrRotation *a, const WrRotation *b);
WrRotation wr_rotation_inverse(const WrRotation *rotation);
/* Interpolation from a (t = 0) to b (t = 1) about one axis, at constant speed. */
WrRotation wr_rotation_between(const WrRotation *a, const WrRotation *b, double t);
WrVec3 wr_rotation_apply(const WrRotation *rotation, WrVec3 v);

/* A drag by (dx, dy) pixels in a view of `span` pixels: `rotation` is the object's own, displayed with an additional
 * rotation of turn_deg about the world's y axis. The object follows the pointer: half a turn for a drag across the
 * view, about the camera's up and right axes (unit, world). The result replaces `rotation`; turn_deg is unchanged. */
WrRotation wr_rotation_dragged(const WrRotation *rotation, double turn_deg, WrVec3 right, WrVec3 up,
                               double dx, double dy, double span);

/* Position of a light direction (camera space: x right, y up, z to the viewer; any length > 0) on a pad, x right and
 * y up, each -1..1. The centre is the viewer's direction, the rim is 100 degrees away, and the pad's corners are
 * diagonal. Lights farther behind are placed on the rim. */
void wr_light_to_pad(WrVec3 towards, double *x, double *y);
/* The inverse; points outside the pad are moved to its rim. Unit length. */
WrVec3 wr_light_from_pad(double x, double y);
#define WR_ROCK_DEG 35.0
/* Rotation angle (0..360 degrees) after `seconds` of rocking by 35 degrees to and fro, like a pendulum. *way: phase,
   stored by the caller, initially 0. An angle outside the range starts at the nearest one inside. */
double wr_rotation_rock(double *way, double turn_deg, double seconds);

/* ---- geometry of the orientation cube ---- */

/* The face, edge or corner under the pointer, and the rotation that brings one to the front. Pure geometry;
   tested without a window. The cube extends from -1 to 1; front is +z, right +x, top +y. Its rotation maps to
   the camera's axes: x to the right, y up, z to the viewer. */

/* Distance from the centre of a face to its rim, which belongs to edges and corners. */
#define WR_CUBE_RIM 0.62

/* The visible part at (x, y), in half sides from the centre, y up. Each of side[] is -1, 0 or 1; one, two or three
 * non-zero values stand for a face, an edge or a corner. False: beside the cube. */
bool wr_cube_at(const WrRotation *cube, double x, double y, int side[3]);
/* The rotation that shows that face, edge or corner in front, upright; top and bottom with the front face downwards
 * or upwards. */
WrRotation wr_cube_facing(const int side[3]);
/* Smooth step: fraction of the path for a fraction of the time, with zero speed at both ends. */
double wr_cube_ease(double t);

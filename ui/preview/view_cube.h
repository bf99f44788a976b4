/* view_cube.h - geometry of the orientation cube: the face, edge or corner under the pointer, and the rotation that
   brings one to the front. Pure geometry; tested without a window.

   The cube extends from -1 to 1; front is +z, right +x, top +y. Its rotation maps to the camera's axes: x to the
   right, y up, z to the viewer. */
#pragma once
#include "ui/preview/rotation.h"

#include "base/vec.h"

#include <stdbool.h>

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

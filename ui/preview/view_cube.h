/* view_cube.h - a cube that stands as what is looked at stands: which of its faces, edges and corners is under the pointer,
   and the turn that brings one to the front. Pure geometry; tested without a window.

   The cube goes from -1 to 1; front is +z, right +x, top +y. Its rotation takes it into the camera's axes: x to the right,
   y up, z to the viewer. */
#pragma once
#include "ui/preview/rotation.h"

#include "base/vec.h"

#include <stdbool.h>

/* How far from the middle of a face its rim begins, where edges and corners are. */
#define WR_CUBE_RIM 0.62

/* What is seen of it at (x, y), in half sides from its middle, y up: each of side[] is -1, 0 or 1, a face, an edge or a
 * corner by the number that are not 0. False: beside it. */
bool wr_cube_at(const WrRotation *cube, double x, double y, int side[3]);
/* The rotation that shows that face, edge or corner in front, upright; above and below with the front downwards, or
 * upwards. */
WrRotation wr_cube_facing(const int side[3]);
/* 0..1 of the way at 0..1 of the time: begins and ends at rest. */
double wr_cube_ease(double t);

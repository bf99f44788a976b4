/* camera_control.h - camera movements: standard sides, orbit, pan, dolly, and framing of the objects.

   All modify the camera of a scene owned by the caller; results are checked by wr_scene_place. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrScene WrScene;

typedef enum WrSide {
    WR_SIDE_FRONT, /* from the world's +z, and so on */
    WR_SIDE_BACK,
    WR_SIDE_LEFT,
    WR_SIDE_RIGHT,
    WR_SIDE_TOP, /* the front is below */
    WR_SIDE_BOTTOM,
    WR_SIDE_COUNT
} WrSide;
/* As in commands: "front", "back", "left", "right", "top", "bottom". */
extern const char *const wr_side_names[WR_SIDE_COUNT];

/* Views from that side, at the same distance from the target. A scene's only object is then aligned
   with its own axes: its surface's pose, with each angle rounded to a right one. */
void wr_camera_control_side(WrScene *scene, WrSide side);
/* Orbits the target: to the camera's right about the world's y axis, and up, never over the top.
 * Degrees. */
void wr_camera_control_orbit(WrScene *scene, double right_deg, double up_deg);
/* Moves sideways with its target, in picture heights at the target: to the right and up. Stops fitting:
   the distance is kept. aspect: of the picture. False with an error if the camera cannot be placed. */
bool wr_camera_control_pan(WrScene *scene, double right, double up, double aspect, WrError *err);
/* Multiplies the distance from the target, or, orthographic, the size of the view; factor > 0.
 * Otherwise as pan. */
bool wr_camera_control_dolly(WrScene *scene, double factor, double aspect, WrError *err);
/* Moves along its view until the objects counted for fitting just fill a picture `aspect` times as wide
   as high: their outlines are 2 % away from the nearer pair of borders, and centred in both directions.
   For meshes, every corner is checked, for other surfaces a grid of points. turn_from, turn_to: of the
   turntable; everything between fits. */
bool wr_camera_control_fill(WrScene *scene, double aspect, double turn_from, double turn_to,
                            WrError *err);
/* The least y of those objects, with the same sampling; independent of the turntable. */
bool wr_camera_control_lowest(const WrScene *scene, double *y, WrError *err);

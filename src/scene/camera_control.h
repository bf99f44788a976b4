/* camera_control.h - the camera moved: to a side, round its target, sideways, nearer, and to where the objects fill the picture.
   All change a scene that may be changed, by its camera; what they give is checked by wr_scene_place. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrScene WrScene;

typedef enum WrSide {
    WR_SIDE_FRONT, /* from the world's +z, and so on: */
    WR_SIDE_BACK,
    WR_SIDE_LEFT,
    WR_SIDE_RIGHT,
    WR_SIDE_TOP, /* the front is below */
    WR_SIDE_BOTTOM,
    WR_SIDE_COUNT
} WrSide;
/* As in commands: "front", "back", "left", "right", "top", "bottom". */
extern const char *const wr_side_names[WR_SIDE_COUNT];

/* From that side, as far from its target as it was. A scene's only object stands by its own axes then: its surface's
   pose, each angle the nearest right one. */
void wr_camera_control_side(WrScene *scene, WrSide side);
/* Round the target: to the camera's right about the world's y axis, and up, never over the top. Degrees. */
void wr_camera_control_orbit(WrScene *scene, double right_deg, double up_deg);
/* Sideways with its target, in heights of the picture at the target: to the right and up. It fits no more: its
   distance stays. aspect: of the picture. False with an error where the camera cannot be placed. */
bool wr_camera_control_pan(WrScene *scene, double right, double up, double aspect, WrError *err);
/* So many times as far from the target, or, orthographic, so many times as large a view; factor > 0. As pan. */
bool wr_camera_control_dolly(WrScene *scene, double factor, double aspect, WrError *err);
/* Along its view, to where the objects that a camera that fits minds just fill a picture `aspect` times as wide as
   high: their outlines keep 2 % from the nearer pair of borders, and are as far from one as from the other in both
   directions. Of meshes all corners are looked at, of other surfaces a grid of points. turn_from, turn_to: of the turntable;
   all that it shows between fits. */
bool wr_camera_control_fill(WrScene *scene, double aspect, double turn_from, double turn_to,
                            WrError *err);
/* The least y of those objects, as finely looked at; it stays however the turntable turns. */
bool wr_camera_control_lowest(const WrScene *scene, double *y, WrError *err);

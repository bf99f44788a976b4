/* camera.h - from where a scene is looked at. Plain data; placed by wr_scene_place of scene.h.
   World space is right-handed, y up; lengths in scene units, angles in degrees. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>

typedef struct WrCamera {
    bool orthographic;
    /* The eye is placed on the line from target along (eye - target) so that the object just fits;
       true until a camera command gives eye=. */
    bool fit;
    WrVec3 eye, target, up;
    double fov_deg; /* vertical, perspective: 0.01..179 */
    double size; /* height of the view in scene units, orthographic; <= 0: the object just fits */
    /* Of what must be seen, width by height, unless `fit`: a narrower picture sees as much across, and more from bottom to
       top; 0: however narrow, the height stays. */
    double frame;
} WrCamera;
/* As in commands: "perspective", "orthographic". */
extern const char *const wr_camera_names[2];

/* How a scene is looked at: the orientation of its one object and the camera. Not part of the work: it has a
   history of its own (document/view_history.h). */
typedef struct WrSceneView {
    bool of_one; /* the scene holds one object; of several each is turned by an edit of its own */
    bool posed;  /* as in WrScene; of one object */
    WrVec3 rotate_deg;
    WrCamera camera;
} WrSceneView;

/* A view with a name, kept in the document. */
typedef struct WrNamedView {
    char *name; /* owned */
    WrSceneView view;
} WrNamedView;

/* Do both show the same? The numbers of the kind of camera that is not chosen count too: they are kept. */
bool wr_scene_view_equal(const WrSceneView *a, const WrSceneView *b);

/* camera.h - cameras and views of a scene. Plain data; positioned by wr_scene_place of scene.h.

   World space is right-handed, y up; lengths in scene units, angles in degrees. */
#pragma once
#include "base/vec.h"

#include <stdbool.h>

typedef struct WrCamera {
    bool orthographic;
    /* The eye is placed on the line from target along (eye - target) so that the object just fits; true
       until a camera command sets eye=. */
    bool fit;
    WrVec3 eye, target, up;
    double fov_deg; /* vertical, perspective: 0.01..179 */
    double size; /* height of the view in scene units, orthographic; <= 0: the object just fits */
    /* Aspect ratio of the region that must be visible, unless `fit`: a narrower picture shows the same
       width, and more from bottom to top; 0: the height is fixed for any width. */
    double frame;
} WrCamera;
/* As in commands: "perspective", "orthographic". */
extern const char *const wr_camera_names[2];

/* A view: the orientation of a single object and the camera. Not part of the document's edits: it has a
   history of its own (document/history.h). */
typedef struct WrSceneView {
    bool of_one; /* the scene has one object; with several, rotations are edits of the objects */
    bool posed;  /* as in WrScene; for one object */
    WrVec3 rotate_deg;
    WrCamera camera;
} WrSceneView;

/* A named view, stored in the document. */
typedef struct WrNamedView {
    char *name; /* owned */
    WrSceneView view;
} WrNamedView;

/* True if both are equal. The numbers of the unused kind of camera also count, because they are kept. */
bool wr_scene_view_equal(const WrSceneView *a, const WrSceneView *b);

/* ---- named views ---- */

/* Named views of a scene.

   With several objects a view is only the camera. */

typedef struct WrScene WrScene;

#define WR_NAMED_VIEWS_MAX 256 /* maximum of a scene */

int wr_scene_find_view(const WrScene *scene, const char *name); /* its index, or -1 */
/* These modify a scene owned by the caller. An existing view of that name is replaced. */
void wr_scene_name_view(WrScene *scene, const char *name, const WrSceneView *view);
void wr_scene_forget_view(WrScene *scene, int i);
/* Replaces the views by those of another scene; removes all views. */

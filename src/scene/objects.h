/* objects.h - the objects of a scene: each with its own surface, pose, position, material and table,
   under common lights and one camera.

   Objects are numbered from 0 in the order of creation. One is active: its properties are the members
   of WrScene, and commands apply to it. The others are in `others` as scenes of one object each, whose
   lights, camera and dials are unused. All changes make a new scene; unchanged objects are shared. */
#pragma once
#include "scene/scene.h"

#include <stdbool.h>

#define WR_OBJECTS_MAX 64 /* of a scene */

int wr_scene_object_count(const WrScene *scene); /* 1 or more */
/* Object i, 0..count - 1, as a scene of which only the object is used: for the active one the scene
 * itself. Borrowed. */
const WrScene *wr_scene_object(const WrScene *scene, int i);
/* Its name, or "object" and its number from 1. Valid as long as the scene and the buffer. */
#define WR_OBJECT_LABEL 24
const char *wr_scene_object_label(const WrScene *scene, int i, char buffer[WR_OBJECT_LABEL]);
/* The index of the object of that name or label, or -1. */
int wr_scene_object_find(const WrScene *scene, const char *name);
/* True if object i is in a picture of that aspect. False if it is hidden; and for a floor (a still
   plane among other objects) if the camera is behind it, where it would hide everything that stands on
   it. */
bool wr_scene_shows(const WrScene *scene, int i, double aspect);

/* These return a new scene, owned by the caller, with a reference count of 1. */
WrScene *wr_scene_choose(const WrScene *scene, int i);
/* Adds an object, active and without a name: a copy of the active one, or that of an empty document. */
WrScene *wr_scene_add_object(const WrScene *scene, bool copy);
WrScene *wr_scene_hide(const WrScene *scene, int i, bool hidden);
/* Replaces object i, which is not active, of a modifiable scene; owns `object`. */
void wr_scene_set_object(WrScene *scene, int i, WrScene *object);
/* True if a visible object uses the layer, as its table or as its form. */
bool wr_scene_uses_layer(const WrScene *scene, const char *layer);
/* Objects that use a layer of that name, as table or form, use the other name from now on; NULL if none
 * does. */
WrScene *wr_scene_rename_layer(const WrScene *scene, const char *from, const char *to);
/* All objects get the scheme, or the normal mode, of the active one: for a dial that applies to the
 * whole scene. Normals of another model (invariant) are unchanged. */
void wr_scene_set_all_slopes(WrScene *scene, bool scheme, bool normals);
/* Removes object i of several. If it was active, the previous one (else the next) becomes active. */
WrScene *wr_scene_remove_object(const WrScene *scene, int i);

/* True if a fitting camera includes object i: all visible turning ones; if there are none, all visible
 * ones; else all. */
bool wr_scene_fit_includes(const WrScene *scene, int i);
/* Radius of the sphere about the world's origin that contains those objects for every turn of the
   turntable. displaced: including displacements; else only their bases. */
double wr_scene_bounding_radius(const WrScene *scene, bool displaced);
/* Fixes a fitting or orthographic camera at the position that the camera of `like` has in a picture
   `aspect` times as wide as high, with the same visible region; any other is unchanged. `like` may be
   the scene itself; if its camera is invalid nothing changes. */
void wr_scene_hold_camera(WrScene *scene, const WrScene *like, double aspect);

/* Object i alone at its position: with the scene's lights, background and dials, and a camera whose eye
   is that of the scene in a picture of that aspect. Used to render a single object. */
WrScene *wr_scene_object_alone(const WrScene *scene, int i, double aspect);

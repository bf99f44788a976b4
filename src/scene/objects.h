/* objects.h - the objects of a scene: each with surface, pose, place, material and table of its own, under the same lights
   and camera.

   Objects are numbered from 0 in the order in which they were added. One is at hand: its properties are the members of
   WrScene, and commands act on it. The others hang in `others` as scenes of one object each, whose lights, camera and
   dials nobody reads. All changes make a new scene; an object that stays is shared. */
#pragma once
#include "scene/scene.h"

#include <stdbool.h>

#define WR_OBJECTS_MAX 64 /* of a scene */

int wr_scene_object_count(const WrScene *scene); /* 1 or more */
/* Object i, 0..count - 1, as a scene of which only the object is read: the scene itself for the one at hand. Borrowed. */
const WrScene *wr_scene_object(const WrScene *scene, int i);
/* What it is called: its name, else "object" and its number from 1. Valid as long as the scene and the buffer. */
#define WR_OBJECT_LABEL 24
const char *wr_scene_object_label(const WrScene *scene, int i, char buffer[WR_OBJECT_LABEL]);
/* The object of that name or label; its index, or -1. */
int wr_scene_object_find(const WrScene *scene, const char *name);
int wr_scene_shown_count(const WrScene *scene); /* objects that are not hidden */
/* Is object i in a picture of that aspect? Not if it is hidden; and a floor, a plane that stands still among other objects,
   only as long as the camera is in front of it: from below it would hide all that stands on it. */
bool wr_scene_shows(const WrScene *scene, int i, double aspect);

/* These give a new scene, the caller's, of count 1. */
WrScene *wr_scene_choose(const WrScene *scene, int i);
/* One more object, at hand and without a name: as the one at hand, or as that of an empty document. */
WrScene *wr_scene_add_object(const WrScene *scene, bool copy);
WrScene *wr_scene_hide(const WrScene *scene, int i, bool hidden);
/* Another object (taken) in the place of object i, which is not at hand, of a scene that may be changed. */
void wr_scene_set_object(WrScene *scene, int i, WrScene *object);
/* Does an object that is shown, as its table or as its form? */
bool wr_scene_wears(const WrScene *scene, const char *layer);
/* Objects that wear a layer of that name, or have its form, wear the other from now on; NULL where none does. */
WrScene *wr_scene_rename_layer(const WrScene *scene, const char *from, const char *to);
/* All objects take the scheme, or the normals, of the one at hand: as a dial is turned of the whole scene. Normals of
 * another model (invariant) stay. */
void wr_scene_set_all_slopes(WrScene *scene, bool scheme, bool normals);
/* Without object i of several. The one before it (else after it) comes to hand where that was at hand. */
WrScene *wr_scene_remove_object(const WrScene *scene, int i);

/* Does a camera that fits mind object i? All that are shown and turned; where none is, all that are shown; else all. */
bool wr_scene_fits(const WrScene *scene, int i);
/* How far a displaced surface stands out of its base, in the object's units, at table heights of -1..1 or as high as its formula
   can be; 0: it is not displaced. Heights of a table are not asked: a camera does not move while one paints. */
double wr_scene_stands_out(const WrScene *object);
/* The radius of the ball about the world's origin that holds those, however the turntable turns them. displaced: with what
   stands out of them; else their bases. */
double wr_scene_ball(const WrScene *scene, bool displaced);
/* A camera that fits, or is orthographic, stands from now on where that of `like` does, in a picture `aspect` times as wide
   as high, and the latter shows as much; any other stays as it is. `like` may be the scene itself; where its camera cannot
   look nothing changes. */
void wr_scene_hold_camera(WrScene *scene, const WrScene *like, double aspect);

/* Object i alone as it stands among the others: with the scene's lights, background and dials, and a camera whose eye is
   where the scene's is in a picture of that aspect. What a picture of one object is made from. */
WrScene *wr_scene_part(const WrScene *scene, int i, double aspect);

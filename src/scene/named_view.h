/* named_view.h - views of a scene that were given names, so that they can be gone back to.
   Of several objects a view is the camera alone. */
#pragma once
#include "scene/camera.h"

typedef struct WrScene WrScene;

#define WR_NAMED_VIEWS_MAX 256 /* of a scene */

int wr_scene_find_view(const WrScene *scene, const char *name); /* its index, or -1 */
/* These change a scene that may be changed. One of that name is replaced. */
void wr_scene_name_view(WrScene *scene, const char *name, const WrSceneView *view);
void wr_scene_forget_view(WrScene *scene, int i);
/* All of another scene's, in place of its own; none. */
void wr_scene_take_views(WrScene *scene, const WrScene *from);
void wr_scene_drop_views(WrScene *scene);

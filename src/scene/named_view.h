/* named_view.h - named views of a scene.

   With several objects a view is only the camera. */
#pragma once
#include "scene/camera.h"

typedef struct WrScene WrScene;

#define WR_NAMED_VIEWS_MAX 256 /* maximum of a scene */

int wr_scene_find_view(const WrScene *scene, const char *name); /* its index, or -1 */
/* These modify a scene owned by the caller. An existing view of that name is replaced. */
void wr_scene_name_view(WrScene *scene, const char *name, const WrSceneView *view);
void wr_scene_forget_view(WrScene *scene, int i);
/* Replaces the views by those of another scene; removes all views. */

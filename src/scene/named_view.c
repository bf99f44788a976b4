#include "scene/named_view.h"

#include "base/memory.h"
#include "scene/scene.h"

#include <string.h>

int wr_scene_find_view(const WrScene *scene, const char *name)
{
    for (int i = 0; i < scene->view_count; i++)
        if (strcmp(scene->views[i].name, name) == 0) return i;
    return -1;
}

void wr_scene_name_view(WrScene *scene, const char *name, const WrSceneView *view)
{
    const int found = wr_scene_find_view(scene, name);
    if (found >= 0) {
        scene->views[found].view = *view;
        return;
    }
    const size_t count = (size_t)scene->view_count;
    scene->views = wr_realloc(scene->views, count, count + 1, sizeof *scene->views);
    scene->views[scene->view_count++] = (WrNamedView){ wr_strdup(name), *view };
}

void wr_scene_forget_view(WrScene *scene, int i)
{
    wr_free(scene->views[i].name);
    for (int k = i + 1; k < scene->view_count; k++) scene->views[k - 1] = scene->views[k];
    scene->view_count--;
}

void wr_scene_drop_views(WrScene *scene)
{
    for (int i = 0; i < scene->view_count; i++) wr_free(scene->views[i].name);
    wr_free(scene->views);
    scene->views = NULL;
    scene->view_count = 0;
}

void wr_scene_take_views(WrScene *scene, const WrScene *from)
{
    wr_scene_drop_views(scene);
    for (int i = 0; i < from->view_count; i++)
        wr_scene_name_view(scene, from->views[i].name, &from->views[i].view);
}

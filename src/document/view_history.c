#include "document/view_history.h"

#include "base/array.h"
#include "base/error.h"

#include <string.h>

struct WrViews {
    WrSceneView start;
    WR_ARRAY(WrSceneView) list; /* oldest first */
    int position;               /* of the current one */
    int64_t given_up;
};

WrViews *wr_views_new(const WrSceneView *start)
{
    WrViews *views = wr_alloc(1, sizeof *views);
    views->start = *start;
    wr_array_push(&views->list, *start);
    return views;
}

void wr_views_free(WrViews *views)
{
    if (!views) return;
    wr_array_free(&views->list);
    wr_free(views);
}

WrViews *wr_views_clone(const WrViews *views)
{
    WrViews *clone = wr_alloc(1, sizeof *clone);
    *clone = *views;
    memset(&clone->list, 0, sizeof clone->list);
    for (int i = 0; i < views->list.count; i++) wr_array_push(&clone->list, views->list.data[i]);
    return clone;
}

void wr_views_note(WrViews *views, const WrSceneView *view)
{
    if (wr_scene_view_equal(&views->list.data[views->position], view)) return;
    views->list.count = views->position + 1;
    if (views->list.count == WR_VIEWS_MAX) {
        memmove(views->list.data, views->list.data + 1,
                (WR_VIEWS_MAX - 1) * sizeof *views->list.data);
        views->list.count--;
        views->given_up++;
    }
    wr_array_push(&views->list, *view);
    views->position = views->list.count - 1;
}

int wr_views_back(const WrViews *views)
{
    return views->position;
}

int wr_views_forward(const WrViews *views)
{
    return views->list.count - 1 - views->position;
}

WrSceneView wr_views_go(WrViews *views, int steps)
{
    WR_ASSERT(steps >= -wr_views_back(views) && steps <= wr_views_forward(views));
    views->position += steps;
    return views->list.data[views->position];
}

int64_t wr_views_number(const WrViews *views)
{
    return views->given_up + views->position;
}

WrSceneView wr_views_start(const WrViews *views)
{
    return views->start;
}

/* View history: undo and redo of views, and the lines that restore them. */
#include "command/session_internal.h"

#include "base/memory.h"
#include "document/document.h"
#include "scene/scene.h"

#include <string.h>

void wr_session_note_view(WrSession *session)
{
    WrViews *views = session->state.views;
    int64_t before = wr_views_number(views);
    WrSceneView view = wr_scene_view(session->state.document->scene);
    wr_views_note(views, &view);
    if (wr_views_number(views) != before) session->view_top = wr_views_number(views);
}

int wr_session_views_back(const WrSession *session)
{
    return wr_views_back(session->state.views);
}

int wr_session_views_forward(const WrSession *session)
{
    return wr_views_forward(session->state.views);
}

/* ---- as lines ---- */

WrScene *wr_session_scene_at_start(const WrSession *session)
{
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrSceneView view = wr_views_start(session->state.views);
    wr_scene_set_view(scene, &view);
    return scene;
}

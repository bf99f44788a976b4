/* How the document is looked at: views, the way back through them, and the lines that bring them back. */
#include "command/inner.h"

#include "base/memory.h"

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

bool wr_run_view(WrSession *session, WrCall *call, WrError *err)
{
    WrViews *views = session->state.views;
    bool back = strcmp(call->form_name, "back") == 0;
    int steps = (int)wr_call_number(call, "N");
    int most = back ? wr_views_back(views) : wr_views_forward(views);
    if (most == 0) return wr_fail(err, "there is no view %s this one", back ? "before" : "after");
    if (steps > most) return wr_fail(err, "%d views: there are %d", steps, most);
    WrSceneView view = wr_views_go(views, back ? -steps : steps);
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_set_view(scene, &view);
    wr_session_replace_scene(session, scene);
    wr_history_look(session->state.history, session->state.document);
    return true;
}

/* ---- as lines ---- */

WrScene *wr_session_scene_at_start(const WrSession *session)
{
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrSceneView view = wr_views_start(session->state.views);
    wr_scene_set_view(scene, &view);
    return scene;
}

/* The lines that bring `view`. */
static void put_view(const WrSceneView *view, WrLineSink *sink, void *ctx)
{
    WrText text = { 0 };
    WrScene *scene = wr_scene_new();
    wr_scene_set_view(scene, view);
    if (!view->posed) wr_text_add(&text, "rotate pose=own\n");
    wr_print_rotate(scene, &text);
    wr_print_camera(scene, &text);
    for (const char *p = wr_text_get(&text); *p;) {
        size_t length = strcspn(p, "\n");
        char *line = wr_strndup(p, length);
        sink(ctx, line, NULL);
        wr_free(line);
        p += length + 1;
    }
    wr_scene_free(scene);
    wr_text_fini(&text);
}

/* A view is needed where the lines end, and where a step brings one, since undoing that step brings back the
   one before. A state that was given up is never gone back to. */
void wr_session_lines(const WrSession *session, WrLineSink *sink, void *ctx)
{
    const WrHistory *history = session->state.history;
    int position = wr_history_position(history);
    WrSceneView now = wr_views_start(session->state.views), there;
    bool known = true;
    for (int i = 0; i <= position; i++) {
        bool brings = i < position && wr_history_brings_view(history, i);
        if ((brings || i == position) && wr_history_view(history, i, &there)) {
            if (!known || !wr_scene_view_equal(&now, &there)) put_view(&there, sink, ctx);
            now = there;
            known = true;
        }
        if (i == position) break;
        sink(ctx, wr_history_line(history, i), wr_history_folder(history, i));
        known = known && !brings;
    }
}

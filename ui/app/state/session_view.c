/* The document as displayed, including an edit preview or a dragged value. */
#include "ui/app/state/session_view.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/chosen_layers.h"
#include "ui/app/state/document.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/edit_preview.h"

#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "scene/objects.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>

const WrDocument *wr_app_document(const WrApp *app)
{
    return wr_session_document(app->session);
}

WrChosenLayers *wr_app_chosen(const WrApp *app)
{
    wr_chosen_follow(app->chosen, wr_app_document(app), wr_session_last_command(app->session));
    return app->chosen;
}

const WrField *wr_app_field(const WrApp *app)
{
    const WrField *tried = app->trying ? wr_edit_preview_field(app->trial) : NULL;
    return tried ? tried : wr_document_field(wr_app_document(app));
}

bool wr_app_shows_mask(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    return app->mask_alone && document->layers[document->active].on_mask;
}

const WrField *wr_app_canvas_field(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayer *layer = &document->layers[document->active];
    if (wr_app_shows_mask(app)) {
        const WrDocument *made = app->trying ? wr_edit_preview_made(app->trial) : NULL;
        const bool same = made && made->layer_count == document->layer_count;
        const WrField *mask = same ? made->layers[document->active].mask : NULL;
        return mask ? mask : layer->mask;
    }
    const bool worn = !app->trying && !wr_document_shows(document, document->active) &&
                      document->solo < 0 && wr_scene_uses_layer(document->scene, layer->name);
    return worn && wr_layer_holds(layer) ? layer->heights : wr_app_field(app);
}

void wr_app_try(WrApp *app, const WrEditPreviewRequest *ask)
{
    app->trying = true;
    wr_edit_preview_request(app->trial, wr_app_document(app), ask);
    wr_app_redraw(app);
}

void wr_app_try_end(WrApp *app)
{
    if (!app->trying) return;
    app->trying = false;
    wr_edit_preview_end(app->trial);
    wr_app_redraw(app);
}

const WrScene *wr_app_scene(const WrApp *app)
{
    return app->live ? app->live : wr_app_document(app)->scene;
}

bool wr_app_unsaved(const WrApp *app)
{
    uint64_t now = wr_session_revision(app->session);
    return wr_session_in_stroke(app->session) ||
           (now != wr_session_saved_revision(app->session) && now != app->file->clean_revision);
}

WrScene *wr_app_live_begin(WrApp *app)
{
    WrScene *fresh = wr_scene_clone(wr_app_scene(app));
    if (app->live) wr_scene_free(app->live);
    app->live = fresh;
    wr_app_redraw(app);
    return fresh;
}

void wr_app_live_end(WrApp *app)
{
    if (app->live) wr_scene_free(app->live);
    app->live = NULL;
    wr_app_redraw(app);
}

/* ---- names ---- */

const char *wr_app_name(const WrApp *app)
{
    const char *path = wr_session_path(app->session);
    if (!path[0] && app->file->picture) path = app->file->picture;
    if (!path[0]) return wr_words(app->file->starter ? "bricks (starter)" : "untitled");
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

void wr_app_title(WrApp *app)
{
    char title[512];
    snprintf(title, sizeof title, "%s%s - Wrinkle", wr_app_name(app),
             wr_app_unsaved(app) ? " *" : "");
    if (strcmp(title, SDL_GetWindowTitle(app->window)) != 0) SDL_SetWindowTitle(app->window, title);
}

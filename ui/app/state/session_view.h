/* session_view.h - the document as displayed, including an edit preview or a dragged value. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/jobs/edit_preview.h"

#include <stdbool.h>

typedef struct WrChosenLayers WrChosenLayers;
typedef struct WrDocument WrDocument;
typedef struct WrField WrField;
typedef struct WrScene WrScene;

/* Heights in the views: the composite, or the edit preview. */
const WrField *wr_app_field(const WrApp *app);
/* Heights on the canvas: those of the views. If the active layer is hidden and used as an object's table, that layer
   alone. */
const WrField *wr_app_canvas_field(const WrApp *app);
/* True if the canvas shows the active layer's mask instead of heights. */
bool wr_app_shows_mask(const WrApp *app);
const WrDocument *wr_app_document(const WrApp *app);
/* The chosen layers of the present document. */
WrChosenLayers *wr_app_chosen(const WrApp *app);
/* Start an edit preview; the document is unchanged. */
void wr_app_try(WrApp *app, const WrEditPreviewRequest *ask);
void wr_app_try_end(WrApp *app);
const WrScene *wr_app_scene(const WrApp *app); /* `live` if a value is being dragged */
bool wr_app_unsaved(const WrApp *app);
/* A scene that the caller may change directly; the preview shows it until wr_app_live_end. */
WrScene *wr_app_live_begin(WrApp *app);
void wr_app_live_end(WrApp *app);
void wr_app_title(WrApp *app);
const char *wr_app_name(const WrApp *app); /* file name without folders */

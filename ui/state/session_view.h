/* session_view.h - the document as the window sees it: as it is, or as what is tried or dragged would make it. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/jobs/edit_preview.h"

#include <stdbool.h>

typedef struct WrDocument WrDocument;
typedef struct WrField WrField;
typedef struct WrScene WrScene;

/* What the views show: the composite, or what it would become by what is being tried. */
const WrField *wr_app_field(const WrApp *app);
/* What the canvas shows: the same, or, where the active layer is hidden and an object wears it, that layer alone. */
const WrField *wr_app_canvas_field(const WrApp *app);
/* Does it show the active layer's mask, in the place of heights? */
bool wr_app_shows_mask(const WrApp *app);
const WrDocument *wr_app_document(const WrApp *app);
/* Show what this would give; the document is not touched. */
void wr_app_try(WrApp *app, const WrEditPreviewAsk *ask);
void wr_app_try_end(WrApp *app);
const WrScene *wr_app_scene(const WrApp *app); /* live if a value is being dragged */
bool wr_app_unsaved(const WrApp *app);
/* A scene that the caller may change at once; the preview shows it until wr_app_live_end. */
WrScene *wr_app_live(WrApp *app);
void wr_app_live_end(WrApp *app);
void wr_app_title(WrApp *app);
const char *wr_app_name(const WrApp *app); /* of the document, without folders */

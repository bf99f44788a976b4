/* One block of memory for the state of all subjects. */
#include "ui/app/store.h"
#include "ui/app/roster_list.h"
#include "ui/app/timing.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/outline.h"
#include "ui/canvas/view.h"
#include "ui/desk/busy_inner.h"
#include "ui/desk/desk.h"
#include "ui/desk/dialog.h"
#include "ui/desk/document.h"
#include "ui/desk/hand.h"
#include "ui/desk/later.h"
#include "ui/desk/layout.h"
#include "ui/desk/messages.h"
#include "ui/desk/replace.h"
#include "ui/desk/settings.h"
#include "ui/panels/panel_adjust.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panel_objects.h"
#include "ui/panels/panel_scene.h"
#include "ui/panels/panel_preferences.h"
#include "ui/panels/panel_search.h"
#include "ui/panels/panel_status.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_paint.h"
#include "ui/tools/shelf.h"
#include "ui/tools/stroke_hand.h"
#include "ui/tools/tool_clone.h"
#include "ui/tools/tool_shape.h"
#include "ui/tools/tool_stamp.h"
#include "ui/tools/tool_transform.h"
#include "ui/views/marks.h"

#include "base/memory.h"
#include "field/certificate.h"
#include "field/seam.h"

typedef struct Store {
    WrApp app; /* the first: who frees it frees all */
    WrSettings settings;
    WrSettings settings_known;
    WrLayout layout;
    WrTiming timing;
    WrCanvasView view;
    WrCanvasRange range, map_range;
    WrHand hand;
    WrBrushHand brush;
    WrBrushSources brush_files;
    WrShelf shelf;
    WrDrawHand draw;
    WrPatch patch;
    WrPatchPaint paint;
    WrMarks marks;
    WrSelectHand select;
    WrLayersHand layers;
    WrSurfaceHand surface;
    WrObjectsHand objects;
    WrAdjust adjust;
    WrOutlineAsk selecting;
    WrFinder finder;
    WrPreferences preferences;
    WrSeam seam;
    WrCertificate certificate;
    WrMeter meter;
    WrLater later;
    WrWaits waits;
    WrMessages messages;
    WrForms forms;
    WrReplace replace;
    WrCloneHand clone;
    WrTransformHand transform;
    WrStampHand stamp;
    WrDialogHand dialog;
    WrDocumentHand file;
} Store;

WrApp *wr_store_new(void)
{
    Store *store = wr_alloc(1, sizeof *store);
    WrApp *app = &store->app;
    app->settings = &store->settings;
    app->settings_known = &store->settings_known;
    app->layout = &store->layout;
    app->timing = &store->timing;
    app->view = &store->view;
    app->range = &store->range;
    app->map_range = &store->map_range;
    app->hand = &store->hand;
    app->brush = &store->brush;
    app->brush_files = &store->brush_files;
    app->shelf = &store->shelf;
    app->draw = &store->draw;
    app->patch = &store->patch;
    app->paint = &store->paint;
    app->marks = &store->marks;
    app->select = &store->select;
    app->layers = &store->layers;
    app->surface = &store->surface;
    app->objects = &store->objects;
    app->adjust = &store->adjust;
    app->selecting = &store->selecting;
    app->finder = &store->finder;
    app->preferences = &store->preferences;
    app->seam = &store->seam;
    app->certificate = &store->certificate;
    app->meter = &store->meter;
    app->later = &store->later;
    app->waits = &store->waits;
    app->messages = &store->messages;
    app->forms = &store->forms;
    app->replace = &store->replace;
    app->clone = &store->clone;
    app->transform = &store->transform;
    app->stamp = &store->stamp;
    app->dialog = &store->dialog;
    app->file = &store->file;
    app->roster = &wr_roster;
    return app;
}

/* One memory block for the state of all components. */
#include "ui/app/app_store.h"
#include "ui/app/roster_list.h"
#include "ui/app/timing.h"
#include "ui/canvas/canvas.h"
#include "ui/canvas/outline.h"
#include "ui/canvas/view.h"
#include "ui/state/busy_internal.h"
#include "ui/state/app_state.h"
#include "ui/state/dialog.h"
#include "ui/state/document.h"
#include "ui/state/input_router.h"
#include "ui/state/deferred_actions.h"
#include "ui/state/layout.h"
#include "ui/state/messages.h"
#include "ui/state/replace.h"
#include "ui/state/settings.h"
#include "ui/panels/panel_adjust.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panel_objects.h"
#include "ui/panels/panel_scene.h"
#include "ui/panels/panel_preferences.h"
#include "ui/panels/panel_search.h"
#include "ui/panels/panel_status.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_paint.h"
#include "ui/tools/preset_browser.h"
#include "ui/tools/stroke_input.h"
#include "ui/tools/tool_clone.h"
#include "ui/tools/tool_shape.h"
#include "ui/tools/tool_stamp.h"
#include "ui/tools/tool_transform.h"
#include "ui/views/marks.h"

#include "base/memory.h"
#include "field/seam.h"

typedef struct Store {
    WrApp app; /* the first member: freeing it frees the block */
    WrSettings settings;
    WrSettings settings_known;
    WrLayout layout;
    WrTiming timing;
    WrCanvasView view;
    WrCanvasRange range, map_range;
    WrInputRouter hand;
    WrBrushState brush;
    WrBrushSources brush_files;
    WrPresetBrowser shelf;
    WrDrawState draw;
    WrPatch patch;
    WrPatchPaint paint;
    WrMarks marks;
    WrSelectState select;
    WrLayersState layers;
    WrSurfaceState surface;
    WrObjectsState objects;
    WrAdjust adjust;
    WrOutlineRequest selecting;
    WrFinder finder;
    WrPreferences preferences;
    WrSeam seam;
    WrCertificate certificate;
    WrMeter meter;
    WrDeferred later;
    WrWaits waits;
    WrMessages messages;
    WrForms forms;
    WrReplace replace;
    WrCloneState clone;
    WrTransformState transform;
    WrStampState stamp;
    WrDialogState dialog;
    WrDocumentState file;
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

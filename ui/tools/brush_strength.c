#include "ui/tools/brush_strength.h"
#include "ui/state/session_view.h"
#include "ui/state/settings.h"
#include "ui/tools/preset_browser.h"

#include "document/document.h"

bool wr_paints_mask(const WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    return document->layers[document->active].on_mask;
}

double *wr_strength_setting(WrApp *app)
{
    WrSettings *settings = app->settings;
    return wr_paints_mask(app) ? &settings->mask_strength : &settings->brush.strength;
}

WrNumber wr_strength_slider(const WrApp *app)
{
    if (wr_paints_mask(app))
        return (WrNumber){ .low = 0,
                           .high = 1,
                           .reset = 1,
                           .decimals = 2,
                           .tip = "How much one stroke changes the mask at its middle: 1 shows or "
                                  "hides the layer in full" };
    return (WrNumber){ .low = 0.001,
                       .high = 1,
                       .hard_low = -1e30,
                       .hard_high = 1e30,
                       .reset = wr_preset_browser_own(app).strength,
                       .decimals = -1,
                       .logarithmic = true,
                       .tip = "How much one stroke changes the height at its middle, in units of "
                              "the table." };
}

WrBrush wr_brush_now(const WrApp *app)
{
    WrBrush brush = app->settings->brush;
    if (wr_paints_mask(app)) brush.strength = app->settings->mask_strength;
    return brush;
}

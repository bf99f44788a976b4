/* Actions of the Accuracy panel, for the table in actions.c. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/panels/accuracy/accuracy_work.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"

#include "base/text.h"

#include <SDL.h>

void wr_act_accuracy(WrApp *app)
{
    app->settings->panels = true;
    app->settings->tab = wr_tab_find(app, "Accuracy");
}

bool wr_is_accuracy(const WrApp *app)
{
    return app->settings->panels && app->settings->tab == wr_tab_find(app, "Accuracy");
}

/* Without room below, the inspector is a tab among the others. */
void wr_act_inspector(WrApp *app)
{
    app->settings->inspector = !app->settings->inspector;
    if (!app->settings->inspector) return;
    app->settings->panels = true;
    if (app->layout->lower.w <= 0) wr_tab_show(app, "Inspector");
}

bool wr_is_inspector(const WrApp *app)
{
    return app->settings->inspector;
}

void wr_act_inspector_pin(WrApp *app)
{
    WrInspector *in = &app->accuracy->inspector;
    if (!app->settings->inspector) wr_act_inspector(app);
    in->pinned = !in->pinned;
}

bool wr_is_inspector_pinned(const WrApp *app)
{
    return app->accuracy->inspector.pinned;
}

void wr_act_inspector_copy(WrApp *app)
{
    WrInspector *in = &app->accuracy->inspector;
    WrText text = { 0 };
    if (!in->known) return;
    if (in->object[0]) wr_text_addf(&text, "%-10s %s\n", "object", in->object);
    wr_accuracy_probe_text(&in->probe, in->seen, &text);
    in->copied = SDL_SetClipboardText(wr_text_get(&text)) == 0;
    wr_text_fini(&text);
}

void wr_act_accuracy_measure(WrApp *app)
{
    wr_act_accuracy(app);
    app->settings->turning = false;
    app->accuracy->plot_asked = true;
}

void wr_act_compare_take(WrApp *app)
{
    wr_accuracy_b_from_a(app);
}

void wr_act_compare_swap(WrApp *app)
{
    wr_accuracy_swap_ab(app);
}

void wr_act_compare_hold(WrApp *app)
{
    app->accuracy->hold_b = !app->accuracy->hold_b;
    app->accuracy->hold_key = SDLK_UNKNOWN;
    if (app->accuracy->hold_b) app->settings->turning = false;
}

bool wr_is_compare_hold(const WrApp *app)
{
    return app->accuracy->hold_b;
}

/* ---- picture of the patch ---- */

#define LOOK(name, value)                                                                          \
    void wr_act_display_##name(WrApp *app)                                                         \
    {                                                                                              \
        wr_accuracy_set_view(app, value);                                                          \
    }                                                                                              \
    bool wr_is_display_##name(const WrApp *app)                                                    \
    {                                                                                              \
        return app->accuracy->look == value;                                                       \
    }

LOOK(plain, WR_PATCH_PLAIN)
LOOK(split, WR_PATCH_SPLIT)
LOOK(flicker, WR_PATCH_FLICKER)
LOOK(error, WR_PATCH_ERROR)
LOOK(dropped, WR_PATCH_DROPPED)
LOOK(tilt, WR_PATCH_TILT)
LOOK(level, WR_PATCH_LEVEL)
LOOK(height, WR_PATCH_HEIGHT)
LOOK(normal, WR_PATCH_NORMAL)
LOOK(ran, WR_PATCH_RAN)

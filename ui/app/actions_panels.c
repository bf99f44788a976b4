/* Actions of panels and workspaces, for the table in actions.c. */
#include "ui/app/actions_panels.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/app/state/workspace.h"
#include "ui/panels/panels.h"

#define TOGGLE(name, value)                                                                        \
    void wr_act_##name(WrApp *app)                                                                 \
    {                                                                                              \
        app->settings->value = !app->settings->value;                                              \
        wr_app_redraw(app);                                                                        \
    }                                                                                              \
    bool wr_is_##name(const WrApp *app)                                                            \
    {                                                                                              \
        return app->settings->value;                                                               \
    }
TOGGLE(side_left, side_left)
TOGGLE(hide_strip, hide_strip)
TOGGLE(hide_options, hide_options)
TOGGLE(meters, meters)
#undef TOGGLE

void wr_act_tab_float(WrApp *app)
{
    app->settings->panels = true;
    wr_tab_tear_off(app, app->settings->tab, app->width / 3, app->height / 4);
}

void wr_act_dock_all(WrApp *app)
{
    wr_tabs_dock_all(app);
}

#define WORKSPACE(name, kind)                                                                      \
    void wr_act_workspace_##name(WrApp *app)                                                       \
    {                                                                                              \
        wr_workspace_choose(app, kind);                                                            \
    }                                                                                              \
    bool wr_is_workspace_##name(const WrApp *app)                                                  \
    {                                                                                              \
        return app->settings->workspace == kind;                                                   \
    }
WORKSPACE(paint, WR_WORKSPACE_PAINT)
WORKSPACE(generate, WR_WORKSPACE_GENERATE)
WORKSPACE(light, WR_WORKSPACE_LIGHT)
WORKSPACE(export, WR_WORKSPACE_EXPORT)
WORKSPACE(study, WR_WORKSPACE_STUDY)
#undef WORKSPACE

void wr_act_workspace_reset(WrApp *app)
{
    wr_workspace_reset(app);
}

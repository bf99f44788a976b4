/* Calls to all components of the window through the registry. */
#include "ui/app/state/registry.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/settings.h"

#include <string.h>

int wr_tab_find(const WrApp *app, const char *label)
{
    for (int i = 0; i < app->registry->tab_count; i++)
        if (strcmp(app->registry->tabs[i].label, label) == 0) return i;
    return 0;
}

void wr_tab_show(WrApp *app, const char *label)
{
    const int tab = wr_tab_find(app, label);
    const bool below = app->registry->tabs[tab].below;
    app->settings->panels = true;
    if (below) app->settings->inspector = strcmp(label, "Inspector") == 0;
    if (!below || app->layout->lower.w <= 0) app->settings->tab = tab;
}

void wr_input_router_let_go(WrApp *app)
{
    for (const WrPart *const *p = app->registry->parts; *p; p++)
        if ((*p)->let_go) (*p)->let_go(app);
}

void wr_app_settle(WrApp *app)
{
    wr_input_router_let_go(app);
    for (const WrPart *const *p = app->registry->parts; *p; p++)
        if ((*p)->settle) (*p)->settle(app);
}

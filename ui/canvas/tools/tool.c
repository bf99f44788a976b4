/* The current tool. */
#include "ui/canvas/tools/tool.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/tools/preset_browser.h"

#include "brush/brush.h"

#include <string.h>

const WrTool *wr_tool_now(const WrApp *app)
{
    return app->registry->tools[app->tool];
}

int wr_tool_find(const WrApp *app, const char *action)
{
    for (int i = 0; i < app->registry->tool_count; i++)
        if (strcmp(app->registry->tools[i]->action, action) == 0) return i;
    return -1;
}

/* When a tool with its own brush mode is left, the brush's mode is restored. */
void wr_tool_choose(WrApp *app, int index)
{
    const WrTool *old = wr_tool_now(app), *tool = app->registry->tools[index];
    wr_input_router_let_go(app);
    if (index == app->tool) return;
    if (old->leave) old->leave(app);
    if (old->mode) app->settings->brush.mode = app->shelf->kept;
    if (tool->mode) {
        app->shelf->kept = app->settings->brush.mode;
        app->settings->brush.mode = (WrBrushMode)(tool->mode - 1);
    }
    app->tool = index;
    wr_app_redraw(app);
}

static void another(WrApp *app)
{
    if (wr_tool_now(app)->leave) wr_tool_now(app)->leave(app);
}

const WrPart wr_part_tools = { .another = another };

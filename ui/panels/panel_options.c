/* Option row below the menu: the current tool and its options. */
#include "ui/state/action.h"
#include "ui/state/app_state.h"
#include "ui/state/layout.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/panels/panels.h"
#include "ui/tools/tool.h"

void wr_panel_options(WrApp *app)
{
    const WrTool *tool = wr_tool_now(app);
    const WrAction *action = wr_action_find(app, tool->action);
    if (app->layout->options.w <= 0) return;
    wr_gui_area_begin("##options", WR_AREA_BAR, app->layout->options, WR_COLOUR_BAR);
    bool wide = app->width >= wr_gui_px(1060) || !tool->options;
    if (wide) wr_gui_text(WR_FONT_BOLD, WR_COLOUR_STRONG, action->label);
    if (tool->options) {
        tool->options(app);
    } else {
        wr_gui_same_line(14);
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, tool->help);
    }
    wr_gui_area_end();
}

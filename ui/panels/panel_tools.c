/* The strip of tools on the left. */
#include "ui/desk/action.h"
#include "ui/desk/desk.h"
#include "ui/desk/keys.h"
#include "ui/desk/layout.h"
#include "ui/desk/roster.h"
#include "ui/gui/gui.h"
#include "ui/gui/theme.h"
#include "ui/gui/words.h"
#include "ui/panels/panels.h"
#include "ui/tools/tool.h"

#include "base/text.h"

#include <math.h>

/* In one column, units from a tool to the next. */
static double pitch_of(const WrApp *app)
{
    const double room = app->layout->strip.h / wr_gui_scale() - 12;
    return fmin(WR_TOOL_MOST, floor(room / app->roster->tool_count));
}

void wr_panel_tools(WrApp *app)
{
    if (app->layout->strip.w <= 0) return;
    wr_gui_area_begin("##tools", WR_AREA_BAR, app->layout->strip, WR_COLOUR_BAR);
    int columns = app->layout->strip.w > wr_gui_px(60) ? 2 : 1;
    const double pitch = columns == 1 ? pitch_of(app) : WR_TOOL_MOST, side = pitch - 2;
    for (int i = 0; i < app->roster->tool_count; i++) {
        const WrAction *action = wr_action_find(app, app->roster->tools[i]->action);
        if (i % columns) wr_gui_same_line(0);
        wr_gui_move_to(wr_gui_px(columns == 1 ? 24 - side / 2 : 12 + 37 * (i % columns)));
        if (wr_gui_icon_button(app->roster->tools[i]->action, app->roster->tools[i]->icon, side,
                               i == app->tool))
            wr_action_run(app, app->roster->tools[i]->action);
        WrText tip = { 0 }, keys = { 0 };
        wr_keys_list(app->keys, app->roster->tools[i]->action, &keys);
        wr_text_addf(&tip, "%s   %s\n%s", wr_words(action->label), wr_text_get(&keys),
                     wr_words(app->roster->tools[i]->help));
        wr_gui_tip(wr_text_get(&tip));
        wr_text_fini(&tip);
        wr_text_fini(&keys);
        if (i % columns == columns - 1) wr_gui_space(-6);
    }
    wr_gui_area_end();
}

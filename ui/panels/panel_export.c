/* The Export tab: each way out of the program, with one line of help. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/panels/panels.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "base/enum_rows.h"

static void row(WrApp *app, const char *name)
{
    const WrAction *action = wr_action_find(app, name);
    wr_gui_disable(!wr_action_can(app, action));
    if (wr_gui_chip(NULL, action->label)) wr_action_run(app, name);
    wr_gui_disable_end();
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, wr_action_help(app, action));
    wr_gui_space(4);
}

static void rows(WrApp *app, const char *label, const char *const *names, int count)
{
    if (!wr_gui_fold(label, true)) return;
    for (int i = 0; i < count; i++) row(app, names[i]);
}

void wr_panel_export(WrApp *app)
{
    static const char *const maps[] = { WR_ACT(maps), WR_ACT(export) },
                             *const pictures[] = { WR_ACT(render), WR_ACT(film) },
                             *const more[] = { WR_ACT(bake), WR_ACT(save_history) };
    rows(app, "MAPS", maps, WR_LENGTH(maps));
    rows(app, "PICTURES AND FILMS", pictures, WR_LENGTH(pictures));
    rows(app, "MORE", more, WR_LENGTH(more));
    wr_panel_cell(app);
}

/* Tool strip on the left: tools, and frequently used generators. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/registry.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panels.h"
#include "ui/canvas/tools/tool.h"

#include "base/error.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "generate/generator.h"

#include <math.h>
#include <string.h>

typedef struct Button {
    const char *action, *icon, *label, *help;
    bool on;
} Button;

/* Button spacing of one column in units. */
static double pitch_of(const WrApp *app)
{
    const double room = app->layout->strip.h / wr_gui_scale() - 12;
    return fmin(WR_TOOL_MAX, floor(room / (app->registry->tool_count + WR_STRIP_MORE)));
}

/* Generator families with a button of their own. */
static const struct {
    const char *family, *action, *icon;
} own[] = { { "text", WR_ACT(generate_text), WR_ICON_TEXT },
            { "solid", "generate_solid_sphere", WR_ICON_CUBE } };
_Static_assert(sizeof own / sizeof *own + 1 == WR_STRIP_MORE, "and the eraser");

/* The current family, or "". */
static const char *family_now(const WrApp *app)
{
    const bool generates = strcmp(app->registry->tools[app->tool]->action, WR_ACT(generate)) == 0;
    const WrGenerator *generator = app->generate->generator;
    return generates && generator ? generator->family : "";
}

static Button tool_button(const WrApp *app, int i)
{
    const WrTool *tool = app->registry->tools[i];
    const WrAction *action = wr_action_find(app, tool->action);
    bool on = i == app->tool;
    for (int k = 0; k < WR_LENGTH(own) && strcmp(tool->action, WR_ACT(generate)) == 0; k++)
        if (strcmp(family_now(app), own[k].family) == 0) on = false;
    return (Button){ tool->action, tool->icon, action->label, tool->help, on };
}

static Button eraser_button(const WrApp *app)
{
    const WrAction *action = wr_action_find(app, WR_ACT(erase_mode));
    return (Button){ WR_ACT(erase_mode), WR_ICON_ERASER, action->label, wr_action_help(app, action),
                     action->checked(app) };
}

static Button family_button(const WrApp *app, int k)
{
    const WrGenerator *generator = wr_action_generator(own[k].action);
    const WrFamily *family = wr_family_find(generator->family);
    return (Button){ own[k].action, own[k].icon, family->label, family->help,
                     strcmp(family_now(app), own[k].family) == 0 };
}

/* List all buttons in order; returns their number. */
static int list(const WrApp *app, Button *buttons)
{
    int count = 0;
    for (int i = 0; i < app->registry->tool_count; i++) {
        buttons[count++] = tool_button(app, i);
        const char *action = app->registry->tools[i]->action;
        if (strcmp(action, WR_ACT(brush)) == 0) buttons[count++] = eraser_button(app);
        for (int k = 0; k < WR_LENGTH(own) && strcmp(action, WR_ACT(stamp)) == 0; k++)
            buttons[count++] = family_button(app, k);
    }
    return count;
}

static void tip(const WrApp *app, const Button *button)
{
    WrText text = { 0 }, keys = { 0 };
    wr_keys_list(app->keys, button->action, &keys);
    wr_text_addf(&text, "%s   %s\n%s", wr_words(button->label), wr_text_get(&keys),
                 wr_words(button->help));
    wr_gui_tip(wr_text_get(&text));
    wr_text_fini(&text);
    wr_text_fini(&keys);
}

#define BUTTONS_MAX 64

void wr_panel_tools(WrApp *app)
{
    if (app->layout->strip.w <= 0) return;
    Button buttons[BUTTONS_MAX];
    WR_ASSERT(app->registry->tool_count + WR_STRIP_MORE <= BUTTONS_MAX);
    const int count = list(app, buttons);
    wr_gui_area_begin("##tools", WR_AREA_BAR, app->layout->strip, WR_COLOUR_BAR);
    int columns = app->layout->strip.w > wr_gui_px(60) ? 2 : 1;
    const double pitch = columns == 1 ? pitch_of(app) : WR_TOOL_MAX, side = pitch - 2;
    for (int i = 0; i < count; i++) {
        const Button *button = &buttons[i];
        if (i % columns) wr_gui_same_line(0);
        wr_gui_move_to(wr_gui_px(columns == 1 ? 24 - side / 2 : 12 + 37 * (i % columns)));
        if (wr_gui_icon_button(button->action, button->icon, side, button->on))
            wr_action_run(app, button->action);
        tip(app, button);
        if (i % columns == columns - 1) wr_gui_space(-6);
    }
    wr_gui_area_end();
}

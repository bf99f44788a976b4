/* Page of keys: a table in order of importance, followed by the remaining actions. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/registry.h"
#include "ui/toolkit/words.h"
#include "ui/panels/help/guide.h"

#include "base/text.h"

#include <ctype.h>
#include <string.h>

typedef struct Row {
    const char *action; /* or a gesture, if no action has that name */
    const char *text;   /* NULL: the action's label */
} Row;

static const Row painting[] = {
    { "*Drag*", "paint; the brush raises, lowers, or moves to a height" },
    { "*Shift, click*", "straight line from the last stroke" },
    { "*Shift, drag*", "size of the brush" },
    { WR_ACT(hold_pick), "and a click: pick the height and paint towards it" },
    { WR_ACT(hold_invert), "held: raise and lower change places" },
    { WR_ACT(hold_smooth), "held: smooth" },
    { WR_ACT(size_down), "smaller" },
    { WR_ACT(size_up), "larger" },
    { WR_ACT(hardness_down), "softer" },
    { WR_ACT(hardness_up), "harder" },
    { WR_ACT(strength_down), "weaker" },
    { WR_ACT(strength_up), "stronger" },
    { WR_ACT(swap_mode), "swap raise and lower" },
    { WR_ACT(undo), "undo" },
    { WR_ACT(redo), "redo" },
    { NULL, NULL }
};
static const Row brushes[] = { { WR_ACT(brushes),
                                 "the tab of brushes: presets, and the values of the one in hand" },
                               { WR_ACT(preset_last), "the brush used before" },
                               { WR_ACT(preset_next), "the next favourite; the star makes them" },
                               { WR_ACT(preset_previous), "the favourite before" },
                               { WR_ACT(erase_mode), "erase with the same brush, and back" },
                               { WR_ACT(height_up), "the height that is painted to, up" },
                               { WR_ACT(height_down), "and down" },
                               { WR_ACT(reset_values), "mode and strength as the brush has them" },
                               { NULL, NULL } };
static const Row tools[] = {
    { WR_ACT(smooth), "smooth" },
    { WR_ACT(smear), "smear, as with a finger" },
    { WR_ACT(clone), "paint with heights from elsewhere; Ctrl, click sets the source" },
    { WR_ACT(flood), "fill connected texels" },
    { WR_ACT(ramp), "drag a slope from low to high" },
    { WR_ACT(shape_rect), "rectangle; Shift a square, Ctrl from its middle" },
    { WR_ACT(shape_ellipse), "ellipse" },
    { WR_ACT(shape_polygon), "polygon: click its corners, then Enter" },
    { WR_ACT(shape_path), "Bezier path: drag its arms, then Enter" },
    { WR_ACT(stamp), "stamp: press, drag for turn and size; the wheel sizes it" },
    { WR_ACT(generate_text), "text: type it, drag it, Ctrl+Enter puts it there" },
    { WR_ACT(generate), "patterns, noise, solids: Enter puts them there, Escape cancels" },
    { WR_ACT(symmetry), "mirrors, turns, a lattice; drag their centre" },
    { NULL, NULL }
};
static const Row tablet[] = {
    { "*Pen*", "paint; harder for more, or wider: set by *Pressure* in the row above" },
    { "*Its other end*", "erases with the same brush" },
    { "*Lower button*", "pick a height; the upper one moves the table" },
    { WR_ACT(tablet), "tablet tester, and the pen's pressure curve" },
    { NULL, NULL }
};
static const Row looking[] = {
    { "*Wheel*", "zoom at the pointer" },
    { "*Space, drag*", "move the table; so does the middle button" },
    { WR_ACT(zoom_100), "100 %" },
    { WR_ACT(fit), "the whole cell" },
    { WR_ACT(mirror_view), "the table as in a mirror: slanted shapes stand out" },
    { "*Shift, wheel*", "turn the table at the pointer; so does Shift, Space and dragging" },
    { WR_ACT(turn_left), "turn it left" },
    { WR_ACT(turn_right), "right" },
    { WR_ACT(turn_none), "upright again" },
    { WR_ACT(look_grey), "the table in grey" },
    { WR_ACT(look_occlusion), "a live map of it: occlusion" },
    { WR_ACT(look_curvature), "curvature" },
    { WR_ACT(panels), "hide and show the panels" },
    { WR_ACT(accuracy), "error and time of the picture, and the cost of other dials" },
    { WR_ACT(look_split), "two settings of the dials side by side" },
    { WR_ACT(compare_hold), "held: the other setting" },
    { WR_ACT(look_error), "where the picture is off" },
    { WR_ACT(look_ran), "where each effect ran" },
    { WR_ACT(inspector), "every quantity under the pointer" },
    { NULL, NULL }
};
static const Row layers[] = { { WR_ACT(select_rect),
                                "select a rectangle; Shift adds, Alt subtracts" },
                              { WR_ACT(select_ellipse), "an ellipse" },
                              { WR_ACT(select_lasso), "by hand" },
                              { WR_ACT(select_all), "all" },
                              { WR_ACT(select_none), "none" },
                              { WR_ACT(select_invert), "the rest" },
                              { WR_ACT(layer_add), "new layer" },
                              { WR_ACT(layer_merge), "merge it with the one below" },
                              { WR_ACT(layer_above), "the layer above" },
                              { WR_ACT(layer_below), "the layer below" },
                              { WR_ACT(offset_half), "offset by half a cell, to see the seams" },
                              { WR_ACT(search), "find any action by its name" },
                              { NULL, NULL } };
static const Row patch[] = { { "*Drag*", "turn it" },
                             { "*Right drag*", "move the light; or drag the small sun" },
                             { "*Shift, right drag*", "turn the surroundings" },
                             { "*Wheel*", "closer, farther" },
                             { "*Space over it*", "pause and go on turning" },
                             { NULL, NULL } };

static const Row keyboard[] = {
    { WR_ACT(part_next), "to the next part of the window: bars, panels, widgets on the views" },
    { WR_ACT(part_back), "to the part before" },
    { WR_ACT(menus), "to the menus; so does a tap on Alt" },
    { "*Tab, Shift+Tab*", "then: along the widgets, a ring shows the place" },
    { "*Arrows*", "change a number, a list, a row of choices; Shift by less; Delete resets" },
    { "*Space, Enter*", "press it, or type into it" },
    { "*Menu key*", "action of the right button" },
    { "*Escape*", "the keys are the canvas's again" },
    { NULL, NULL }
};

static const struct {
    const char *title;
    const Row *rows;
} groups[] = { { "Painting", painting }, { "Brushes", brushes },
               { "Tools", tools },       { "Tablet", tablet },
               { "Looking", looking },   { "Selecting and layers", layers },
               { "The patch", patch },   { "Without the pointer", keyboard } };
#define GROUP_COUNT (sizeof groups / sizeof *groups)

static void add_head(WrText *text, const char *title)
{
    wr_text_addf(text, "\n## %s\n\n| %s | |\n| --- | --- |\n", wr_words(title), wr_words("keys"));
}

/* A mark of Markdown may be a key. */
static void add_keys(const WrApp *app, const char *action, WrText *text)
{
    WrText keys = { 0 };
    wr_keys_list(app->keys, action, &keys);
    for (const char *p = wr_text_get(&keys); *p; p++)
        wr_text_addf(text, ispunct((unsigned char)*p) ? "\\%c" : "%c", *p);
    wr_text_fini(&keys);
}

static void add_row(WrText *text, const char *keys, const char *words)
{
    wr_text_addf(text, "| %s | %s |\n", keys, wr_words(words));
}

static bool is_told(const char *action)
{
    for (size_t i = 0; i < GROUP_COUNT; i++)
        for (const Row *row = groups[i].rows; row->action; row++)
            if (strcmp(row->action, action) == 0) return true;
    return false;
}

static void add_others(const WrApp *app, WrText *text)
{
    WrText keys = { 0 };
    for (const WrAction *a = app->registry->actions; a->name; a++) {
        wr_text_clear(&keys);
        add_keys(app, a->name, &keys);
        if (keys.length > 0 && !is_told(a->name)) add_row(text, wr_text_get(&keys), a->label);
    }
    wr_text_fini(&keys);
}

void wr_guide_keys(const WrApp *app, WrText *text)
{
    WrText keys = { 0 };
    wr_text_addf(
        text, "# %s\n\n%s", wr_words("Keys"),
        wr_words("On the left is the table of heights F(u,v): light is high. On the right the "
                 "same heights wrinkle a surface. The table repeats; paint on any copy. The pages "
                 "beside this one describe the rest."));
    if (strcmp(wr_words_language(), "en") != 0)
        wr_text_addf(text, " %s", wr_words("They are in English."));
    wr_text_add(text, "\n");
    for (size_t i = 0; i < GROUP_COUNT; i++) {
        add_head(text, groups[i].title);
        for (const Row *row = groups[i].rows; row->action; row++) {
            wr_text_clear(&keys);
            if (row->action[0] == '*') wr_text_add(&keys, wr_words(row->action));
            else add_keys(app, row->action, &keys);
            add_row(text, keys.length ? wr_text_get(&keys) : "-", row->text);
        }
    }
    add_head(text, "Everything else");
    add_others(app, text);
    wr_text_fini(&keys);
}

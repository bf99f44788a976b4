/* The keys, told in the order in which one comes to need them; those that are not told of follow. */
#include "ui/desk/action.h"
#include "ui/desk/desk.h"
#include "ui/desk/keys.h"
#include "ui/desk/roster.h"
#include "ui/help/guide.h"

#include "base/text.h"

#include <string.h>

typedef struct Row {
    const char *action; /* or a gesture, where there is none of that name */
    const char *text;   /* NULL: the action's own label */
} Row;

static const Row painting[] = {
    { "*Drag*", "paint; the brush raises, lowers, or moves to a height" },
    { "*Shift, click*", "straight line from the last stroke" },
    { "*Shift, drag*", "size of the brush" },
    { "hold_pick", "and a click: pick the height and paint towards it" },
    { "hold_invert", "held: raise and lower change places" },
    { "hold_smooth", "held: smooth" },
    { "size_down", "smaller" },
    { "size_up", "larger" },
    { "hardness_down", "softer" },
    { "hardness_up", "harder" },
    { "strength_down", "weaker" },
    { "strength_up", "stronger" },
    { "swap_mode", "swap raise and lower" },
    { "undo", "undo" },
    { "redo", "redo" },
    { NULL, NULL }
};
static const Row brushes[] = { { "brushes",
                                 "the tab of brushes: presets, and the values of the one in hand" },
                               { "preset_last", "the brush used before" },
                               { "preset_next", "the next favourite; the star makes them" },
                               { "preset_previous", "the favourite before" },
                               { "erase_mode", "erase with the same brush, and back" },
                               { "height_up", "the height that is painted to, up" },
                               { "height_down", "and down" },
                               { "reset_values", "mode and strength as the brush has them" },
                               { NULL, NULL } };
static const Row tools[] = {
    { "smooth", "smooth" },
    { "smear", "smear, as with a finger" },
    { "clone", "paint with heights from elsewhere; Ctrl, click says from where" },
    { "flood", "fill what is connected" },
    { "ramp", "drag a slope from low to high" },
    { "shape_rect", "rectangle; Shift a square, Ctrl from its middle" },
    { "shape_ellipse", "ellipse" },
    { "shape_polygon", "polygon: click its corners, then Enter" },
    { "shape_path", "Bezier path: drag its arms, then Enter" },
    { "stamp", "stamp: press, drag for turn and size; the wheel sizes it" },
    { "generate_text", "text: type it, drag it, Ctrl+Enter puts it there" },
    { "generate", "patterns, noise, solids: Enter puts them there, Escape gives up" },
    { "symmetry", "mirrors, turns, a lattice; drag their centre" },
    { NULL, NULL }
};
static const Row tablet[] = {
    { "*Pen*", "paint; harder for more, or wider: *Pressure* in the row above says which" },
    { "*Its other end*", "erases with the same brush" },
    { "*Lower button*", "pick a height; the upper one moves the table" },
    { "tablet", "tablet tester, and the pen's pressure curve" },
    { NULL, NULL }
};
static const Row looking[] = { { "*Wheel*", "zoom at the pointer" },
                               { "*Space, drag*", "move the table; so does the middle button" },
                               { "zoom_100", "100 %" },
                               { "fit", "the whole cell" },
                               { "panels", "hide and show the panels" },
                               { "accuracy",
                                 "error and time of the picture, and what other dials would cost" },
                               { "look_split", "two settings of the dials side by side" },
                               { "compare_hold", "held: the other setting" },
                               { "look_error", "where the picture is off" },
                               { "inspector", "every quantity under the pointer" },
                               { NULL, NULL } };
static const Row layers[] = { { "select_rect", "select a rectangle; Shift adds, Alt subtracts" },
                              { "select_ellipse", "an ellipse" },
                              { "select_lasso", "by hand" },
                              { "select_all", "all" },
                              { "select_none", "none" },
                              { "select_invert", "the rest" },
                              { "layer_add", "new layer" },
                              { "layer_merge", "merge it with the one below" },
                              { "layer_above", "the layer above" },
                              { "layer_below", "the layer below" },
                              { "offset_half", "offset by half a cell, to see the seams" },
                              { "search", "find any action by its name" },
                              { NULL, NULL } };
static const Row patch[] = { { "*Drag*", "turn it" },
                             { "*Right drag*", "move the light; or drag the small sun" },
                             { "*Wheel*", "closer, farther" },
                             { "*Space over it*", "pause and go on turning" },
                             { NULL, NULL } };

static const struct {
    const char *title;
    const Row *rows;
} groups[] = { { "Painting", painting }, { "Brushes", brushes }, { "Tools", tools },
               { "Tablet", tablet },     { "Looking", looking }, { "Selecting and layers", layers },
               { "The patch", patch } };
#define GROUP_COUNT (sizeof groups / sizeof *groups)

static void add_head(WrText *text, const char *title)
{
    wr_text_addf(text, "\n## %s\n\n| keys | |\n| --- | --- |\n", title);
}

/* A key may be a bar or a backquote. */
static void add_row(WrText *text, const char *keys, const char *words)
{
    wr_text_add(text, "| ");
    for (const char *p = keys; *p; p++) wr_text_addf(text, *p == '|' ? "\\%c" : "%c", *p);
    wr_text_addf(text, " | %s |\n", words);
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
    for (const WrAction *a = app->roster->actions; a->name; a++) {
        wr_text_clear(&keys);
        wr_keys_list(app->keys, a->name, &keys);
        if (keys.length > 0 && !is_told(a->name)) add_row(text, wr_text_get(&keys), a->label);
    }
    wr_text_fini(&keys);
}

void wr_guide_keys(const WrApp *app, WrText *text)
{
    WrText keys = { 0 };
    wr_text_add(
        text,
        "# Keys\n\nOn the left is the table of heights F(u,v): light is high. On the right the "
        "same heights wrinkle a surface. The table repeats; paint on any copy. The pages "
        "beside this one tell the rest.\n");
    for (size_t i = 0; i < GROUP_COUNT; i++) {
        add_head(text, groups[i].title);
        for (const Row *row = groups[i].rows; row->action; row++) {
            wr_text_clear(&keys);
            if (row->action[0] == '*') wr_text_add(&keys, row->action);
            else wr_keys_list(app->keys, row->action, &keys);
            add_row(text, keys.length ? wr_text_get(&keys) : "-", row->text);
        }
    }
    add_head(text, "Everything else");
    add_others(app, text);
    wr_text_fini(&keys);
}

/* SPDX-License-Identifier: MIT
   The short guide, and what this program is. */
#include "ui/state.h"

static void keys(const WrApp *app, const char *action, const char *text)
{
    WrText list = { 0 };
    wr_keys_list(app->keys, action, &list);
    wr_gui_label(wr_text_get(&list));
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, text);
    wr_gui_space(-6);
    wr_text_fini(&list);
}

static void hands(const char *gesture, const char *text)
{
    wr_gui_label(gesture);
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, text);
    wr_gui_space(-6);
}

static void brushes(WrApp *app)
{
    wr_gui_heading("BRUSHES");
    keys(app, "brushes", "the tab of brushes: presets, and the values of the one in hand");
    keys(app, "preset_last", "the brush used before");
    keys(app, "preset_next", "the next favourite; the star makes them");
    keys(app, "preset_previous", "the favourite before");
    keys(app, "erase_mode", "erase with the same brush, and back");
    keys(app, "height_up", "the height that is painted to, up");
    keys(app, "height_down", "and down");
    keys(app, "reset_values", "mode and strength as the brush has them");
    wr_gui_space(12);
    wr_gui_heading("TOOLS");
    keys(app, "smooth", "smooth");
    keys(app, "smear", "smear, as with a finger");
    keys(app, "clone", "paint with heights from elsewhere; Ctrl, click says from where");
    keys(app, "flood", "fill what is connected");
    keys(app, "ramp", "drag a slope from low to high");
    keys(app, "shape_rect", "rectangle; Shift a square, Ctrl from its middle");
    keys(app, "shape_ellipse", "ellipse");
    keys(app, "shape_polygon", "polygon: click its corners, then Enter");
    keys(app, "shape_path", "Bezier path: drag its arms, then Enter");
    keys(app, "stamp", "stamp: press, drag for turn and size; the wheel sizes it");
    keys(app, "generate_text", "text: type it, drag it, Ctrl+Enter puts it there");
    keys(app, "generate", "patterns, noise, solids: Enter puts them there, Escape gives up");
    keys(app, "symmetry", "mirrors, turns, a lattice; drag their centre");
    wr_gui_space(12);
    wr_gui_heading("TABLETS");
    hands("Press", "harder for more, or wider: Pressure in the row above says which");
    hands("Other end", "erases with the same brush");
    keys(app, "tablet", "what the tablet says, and its curve");
    wr_gui_space(12);
}

static void guide(WrApp *app)
{
    wr_gui_text_wrapped(
        WR_FONT_TEXT, WR_COLOUR_LABEL,
        "On the left is the table of heights F(u,v): light is high. On the right the "
        "same heights wrinkle a surface. The table repeats; paint on any copy.");
    wr_gui_space(4);
    wr_gui_list_begin("guide", wr_gui_px(380) < app->height - wr_gui_px(240)
                                   ? wr_gui_px(380)
                                   : app->height - wr_gui_px(240));
    wr_gui_heading("PAINTING");
    hands("Drag", "paint; the brush raises, lowers, or moves to a height");
    hands("Shift, click", "straight line from the last stroke");
    hands("Shift, drag", "size of the brush");
    keys(app, "hold_pick", "and a click: pick the height and paint towards it");
    keys(app, "hold_invert", "held: raise and lower change places");
    keys(app, "hold_smooth", "held: smooth");
    keys(app, "size_down", "smaller");
    keys(app, "size_up", "larger");
    keys(app, "hardness_down", "softer");
    keys(app, "hardness_up", "harder");
    keys(app, "strength_down", "weaker");
    keys(app, "strength_up", "stronger");
    keys(app, "swap_mode", "swap raise and lower");
    keys(app, "undo", "undo");
    keys(app, "redo", "redo");
    wr_gui_space(12);
    wr_gui_heading("TABLET");
    hands("Pen", "paint; pressure does what the option row says");
    hands("Its other end", "erase");
    hands("Lower button", "pick a height; the upper one moves the table");
    keys(app, "tablet", "tablet tester, and the pen's pressure curve");
    wr_gui_space(12);
    brushes(app);
    wr_gui_heading("LOOKING");
    hands("Wheel", "zoom at the pointer");
    hands("Space, drag", "move the table; so does the middle button");
    keys(app, "zoom_100", "100 %");
    keys(app, "fit", "the whole cell");
    keys(app, "panels", "hide and show the panels");
    keys(app, "accuracy", "error and time of the picture, and what other dials would cost");
    keys(app, "look_split", "two settings of the dials side by side");
    keys(app, "compare_hold", "held: the other setting");
    keys(app, "look_error", "where the picture is off");
    keys(app, "inspector", "every quantity under the pointer");
    wr_gui_space(12);
    wr_gui_heading("SELECTING AND LAYERS");
    keys(app, "select_rect", "select a rectangle; Shift adds, Alt subtracts");
    keys(app, "select_ellipse", "an ellipse");
    keys(app, "select_lasso", "by hand");
    keys(app, "select_all", "all");
    keys(app, "select_none", "none");
    keys(app, "select_invert", "the rest");
    keys(app, "layer_add", "new layer");
    keys(app, "layer_merge", "merge it with the one below");
    keys(app, "layer_above", "the layer above");
    keys(app, "layer_below", "the layer below");
    keys(app, "offset_half", "offset by half a cell, to see the seams");
    keys(app, "search", "find any action by its name");
    wr_gui_space(12);
    wr_gui_heading("THE PATCH");
    hands("Drag", "turn it");
    hands("Right drag", "move the light; or drag the small sun");
    hands("Wheel", "closer, farther");
    hands("Space over it", "pause and go on turning");
    wr_gui_space(8);
    wr_gui_list_end();
}

void wr_dialog_help(WrApp *app)
{
    bool about = app->dialog == WR_DIALOG_ABOUT;
    if (!wr_gui_dialog_begin(about ? "Wrinkle" : "Short guide", about ? 440 : 620)) return;
    if (about)
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT,
                            "Paint bump functions and watch them wrinkle a surface, after James F. "
                            "Blinn, Simulation of Wrinkled Surfaces, 1978.");
    else guide(app);
    wr_gui_space(8);
    bool leave = wr_gui_button("Close", true);
    if (!app->dialog_fresh && (wr_gui_escape_pressed() || wr_gui_return_pressed())) leave = true;
    if (leave) app->dialog = WR_DIALOG_NONE;
    wr_gui_dialog_end();
}

/* SPDX-License-Identifier: MIT
   The one table of tools: a new tool is a row here and its functions. */
#include "ui/generate_hand.h"

#include <string.h>

const WrTool wr_tools[] = {
    { .action = "brush",
      .icon = WR_ICON_BRUSH,
      .help = "Paint heights. Ctrl picks a height, Shift and dragging sizes the brush, Shift and a "
              "click "
              "draws a straight line from the last stroke.",
      .press = wr_brush_press,
      .drag = wr_brush_drag,
      .release = wr_brush_release,
      .overlay = wr_brush_overlay,
      .options = wr_brush_options,
      .paints = true },
    { .action = "smooth",
      .icon = WR_ICON_DROP,
      .help = "Let heights flow together under the brush; their mean stays.",
      .press = wr_brush_press,
      .drag = wr_brush_drag,
      .release = wr_brush_release,
      .overlay = wr_brush_overlay,
      .options = wr_brush_options,
      .paints = true,
      .mode = 1 + WR_BRUSH_SMOOTH },
    { .action = "smear",
      .icon = WR_ICON_FINGER,
      .help = "Drag heights along with the brush, as with a finger.",
      .press = wr_brush_press,
      .drag = wr_brush_drag,
      .release = wr_brush_release,
      .overlay = wr_brush_overlay,
      .options = wr_brush_options,
      .paints = true,
      .mode = 1 + WR_BRUSH_SMEAR },
    { .action = "clone",
      .icon = WR_ICON_CLONE,
      .help = "Paint with heights from elsewhere: Ctrl and a click says from where.",
      .press = wr_clone_press,
      .drag = wr_clone_drag,
      .release = wr_brush_release,
      .overlay = wr_brush_overlay,
      .marks = wr_clone_marks,
      .options = wr_brush_options,
      .paints = true,
      .mode = 1 + WR_BRUSH_CLONE },
    { .action = "flood",
      .icon = WR_ICON_BUCKET,
      .help = "Click to fill what is connected and as high as what is clicked.",
      .press = wr_flood_press,
      .options = wr_flood_options },
    { .action = "ramp",
      .icon = WR_ICON_RAMP,
      .help = "Drag from the low end of a slope to its high end; Shift keeps to 15 degrees.",
      .press = wr_ramp_press,
      .drag = wr_ramp_drag,
      .release = wr_ramp_release,
      .marks = wr_ramp_marks,
      .options = wr_ramp_options,
      .key = wr_ramp_key,
      .leave = wr_draw_leave },
    { .action = "shape_rect",
      .icon = WR_ICON_BOX,
      .help = "Drag a rectangle: Shift makes it a square, Ctrl begins in its middle.",
      .press = wr_shape_press,
      .drag = wr_shape_drag,
      .release = wr_shape_release,
      .marks = wr_shape_marks,
      .options = wr_shape_options,
      .key = wr_shape_key,
      .leave = wr_draw_leave },
    { .action = "shape_ellipse",
      .icon = WR_ICON_ROUND,
      .help = "Drag an ellipse: Shift makes it a circle, Ctrl begins in its middle.",
      .press = wr_shape_press,
      .drag = wr_shape_drag,
      .release = wr_shape_release,
      .marks = wr_shape_marks,
      .options = wr_shape_options,
      .key = wr_shape_key,
      .leave = wr_draw_leave },
    { .action = "shape_polygon",
      .icon = WR_ICON_POLYGON,
      .help = "Click the corners; Enter or a double click paints it, Backspace takes one back.",
      .press = wr_path_press,
      .drag = wr_path_drag,
      .release = wr_path_release,
      .marks = wr_path_marks,
      .options = wr_shape_options,
      .key = wr_path_key,
      .leave = wr_draw_leave },
    { .action = "shape_path",
      .icon = WR_ICON_CURVE,
      .help = "Click anchors, drag for their arms, move both; Enter or a double click paints it.",
      .press = wr_path_press,
      .drag = wr_path_drag,
      .release = wr_path_release,
      .marks = wr_path_marks,
      .options = wr_shape_options,
      .key = wr_path_key,
      .leave = wr_draw_leave },
    { .action = "stamp",
      .icon = WR_ICON_SEAL,
      .help = "Press where a picture goes, drag for its turn and size, let go; the wheel sizes it.",
      .press = wr_stamp_press,
      .drag = wr_stamp_drag,
      .release = wr_stamp_release,
      .overlay = wr_stamp_overlay,
      .marks = wr_stamp_marks,
      .options = wr_stamp_options,
      .key = wr_stamp_key,
      .wheel = wr_stamp_wheel,
      .leave = wr_stamp_leave },
    { .action = "generate",
      .icon = WR_ICON_WAND,
      .help =
          "Patterns, noise, text and more from the Generate tab: drag what it makes, Enter puts "
          "it on the table, Escape gives up.",
      .press = wr_pose_press,
      .drag = wr_pose_drag,
      .release = wr_pose_release,
      .marks = wr_pose_marks,
      .options = wr_pose_options,
      .key = wr_pose_key,
      .leave = wr_generate_cancel },
    { .action = "pick",
      .icon = WR_ICON_PICK,
      .help = "Pick the height under the pointer and paint towards it.",
      .press = wr_brush_pick,
      .drag = wr_brush_pick,
      .options = wr_brush_options },
    { .action = "select_rect",
      .icon = WR_ICON_RECT,
      .help = "Drag a rectangle, across the cell's edges if need be: edits then keep to it.",
      .press = wr_select_press,
      .drag = wr_select_drag,
      .release = wr_select_release,
      .options = wr_select_options },
    { .action = "select_ellipse",
      .icon = WR_ICON_ELLIPSE,
      .help = "Drag an ellipse: edits then keep to it.",
      .press = wr_select_press,
      .drag = wr_select_drag,
      .release = wr_select_release,
      .options = wr_select_options },
    { .action = "select_lasso",
      .icon = WR_ICON_LASSO,
      .help = "Draw an outline by hand: edits then keep to it.",
      .press = wr_select_press,
      .drag = wr_select_drag,
      .release = wr_select_release,
      .options = wr_select_options },
    { .action = "pan",
      .icon = WR_ICON_HAND,
      .help = "Move the table. Space and dragging, or the middle button, does it in any tool.",
      .drag = wr_tool_pan_drag },
    { .action = "zoom",
      .icon = WR_ICON_ZOOM,
      .help = "Click to zoom in, with Ctrl out; drag up and down to zoom smoothly. The wheel does "
              "it in "
              "any tool.",
      .press = wr_tool_zoom_press,
      .drag = wr_tool_zoom_drag },
};
const int wr_tool_count = (int)(sizeof wr_tools / sizeof *wr_tools);

int wr_tool_find(const char *action)
{
    for (int i = 0; i < wr_tool_count; i++)
        if (strcmp(wr_tools[i].action, action) == 0) return i;
    return -1;
}

/* A tool that paints with a mode of its own gives the brush back its mode when it is left. */
void wr_tool_choose(WrApp *app, int index)
{
    const WrTool *old = &wr_tools[app->tool], *tool = &wr_tools[index];
    wr_hand_let_go(app);
    if (index == app->tool) return;
    if (old->leave) old->leave(app);
    if (old->mode) app->settings.brush.mode = app->shelf.kept;
    if (tool->mode) {
        app->shelf.kept = app->settings.brush.mode;
        app->settings.brush.mode = (WrBrushMode)(tool->mode - 1);
    }
    app->tool = index;
    wr_app_redraw(app);
}

/* SPDX-License-Identifier: MIT
   The one table of tools: a new tool is a row here and its functions. */
#include "ui/state.h"

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
      .options = wr_brush_options },
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

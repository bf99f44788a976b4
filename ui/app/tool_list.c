/* The list of tools, in the order of the tool strip: a new tool is a file with its row, and a line here. */
#include "ui/app/tool_list.h"
#include "ui/generate/generate_state.h"
#include "ui/tools/tool.h"
#include "ui/tools/tool_rows.h"

const WrTool *const wr_tools[] = {
    &wr_tool_brush,         &wr_tool_smooth,      &wr_tool_smear,          &wr_tool_clone,
    &wr_tool_flood,         &wr_tool_ramp,        &wr_tool_shape_rect,     &wr_tool_shape_ellipse,
    &wr_tool_shape_polygon, &wr_tool_shape_path,  &wr_tool_stamp,          &wr_tool_generate,
    &wr_tool_pick,          &wr_tool_select_rect, &wr_tool_select_ellipse, &wr_tool_select_lasso,
    &wr_tool_transform,     &wr_tool_pan,         &wr_tool_zoom,
};
_Static_assert(sizeof wr_tools / sizeof *wr_tools == WR_TOOL_COUNT, "tool_rows.h counts them");

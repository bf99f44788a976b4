/* tool_rows.h - declarations of the tools' rows; each is at the end of the tool's .c file. */
#pragma once
#include "ui/canvas/tools/tool.h"

extern const WrTool wr_tool_brush;
extern const WrTool wr_tool_smooth;
extern const WrTool wr_tool_smear;
extern const WrTool wr_tool_clone;
extern const WrTool wr_tool_flood;
extern const WrTool wr_tool_ramp;
extern const WrTool wr_tool_shape_rect;
extern const WrTool wr_tool_shape_ellipse;
extern const WrTool wr_tool_shape_polygon;
extern const WrTool wr_tool_shape_path;
extern const WrTool wr_tool_stamp;
extern const WrTool wr_tool_pick;
extern const WrTool wr_tool_select_rect;
extern const WrTool wr_tool_select_ellipse;
extern const WrTool wr_tool_select_lasso;
extern const WrTool wr_tool_transform;
extern const WrTool wr_tool_pan;
extern const WrTool wr_tool_zoom;

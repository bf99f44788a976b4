/* parts.h - the rows of the parts, each at the end of its own file, and the roster of all that there is. */
#pragma once
#include "ui/roster.h"

extern const WrPart wr_part_accuracy;
extern const WrPart wr_part_canvas;
extern const WrPart wr_part_clone;
extern const WrPart wr_part_gallery;
extern const WrPart wr_part_generate;
extern const WrPart wr_part_hand;
extern const WrPart wr_part_layers;
extern const WrPart wr_part_marks;
extern const WrPart wr_part_patch;
extern const WrPart wr_part_select;
extern const WrPart wr_part_stamp;
extern const WrPart wr_part_strokes;
extern const WrPart wr_part_thumbs;
extern const WrPart wr_part_tools;
extern const WrPart wr_part_window;

extern const WrRoster wr_roster;
extern const WrAction wr_actions[]; /* ends with name NULL */

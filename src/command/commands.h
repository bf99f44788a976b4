/* commands.h - declarations of all command rows. Each row is at the end of the .c file that has its arguments,
   handler and printer. Private to src/command. */
#pragma once
#include "command/command_table.h"

extern const WrCommand wr_command_table, wr_command_fill, wr_command_grid, wr_command_image,
    wr_command_dab, wr_command_stroke, wr_command_shape, wr_command_flood, wr_command_ramp,
    wr_command_pattern, wr_command_noise, wr_command_formula, wr_command_text, wr_command_rim,
    wr_command_solid, wr_command_terrain, wr_command_picture, wr_command_open, wr_command_layer,
    wr_command_select, wr_command_adjust, wr_command_filter, wr_command_object, wr_command_surface,
    wr_command_ground, wr_command_rotate, wr_command_analytic, wr_command_bump,
    wr_command_replicate, wr_command_material, wr_command_grain, wr_command_colour,
    wr_command_colouring, wr_command_normalmap, wr_command_roughness, wr_command_metalness,
    wr_command_gltf, wr_command_light, wr_command_environment, wr_command_camera,
    wr_command_background, wr_command_tone, wr_command_cell, wr_command_sheet, wr_command_dials,
    wr_command_tolerance, wr_command_transform, wr_command_copy, wr_command_save, wr_command_export,
    wr_command_maps, wr_command_render, wr_command_script, wr_command_undo, wr_command_redo,
    wr_command_view, wr_command_history;

/* List of all commands. */
#include "command/commands.h"

#include "base/enum_rows.h"
#include "command/args.h"

#include <string.h>

WR_ROWS(wr_class_names);
const char *const wr_class_names[WR_CLASS_COUNT] = {
    [WR_ROW(WR_CLASS_EDIT)] = "edit",     [WR_ROW(WR_CLASS_SCENE)] = "scene",
    [WR_ROW(WR_CLASS_VIEW)] = "view",     [WR_ROW(WR_CLASS_CHOICE)] = "choice",
    [WR_ROW(WR_CLASS_OUTPUT)] = "output", [WR_ROW(WR_CLASS_HISTORY)] = "history",
};
WR_ROWS_END(wr_class_names, WR_CLASS_COUNT);

const char *const wr_off_on[] = { "off", "on", NULL };

const WrCommand *const wr_commands[] = { &wr_command_table,
                                         &wr_command_fill,
                                         &wr_command_grid,
                                         &wr_command_image,
                                         &wr_command_dab,
                                         &wr_command_stroke,
                                         &wr_command_sculpt,
                                         &wr_command_project,
                                         &wr_command_shape,
                                         &wr_command_flood,
                                         &wr_command_ramp,
                                         &wr_command_pattern,
                                         &wr_command_noise,
                                         &wr_command_formula,
                                         &wr_command_text,
                                         &wr_command_rim,
                                         &wr_command_solid,
                                         &wr_command_terrain,
                                         &wr_command_picture,
                                         &wr_command_link,
                                         &wr_command_macro,
                                         &wr_command_open,
                                         &wr_command_layer,
                                         &wr_command_variant,
                                         &wr_command_select,
                                         &wr_command_transform,
                                         &wr_command_adjust,
                                         &wr_command_filter,
                                         &wr_command_object,
                                         &wr_command_ground,
                                         &wr_command_surface,
                                         &wr_command_model,
                                         &wr_command_rotate,
                                         &wr_command_analytic,
                                         &wr_command_bump,
                                         &wr_command_replicate,
                                         &wr_command_material,
                                         &wr_command_grain,
                                         &wr_command_colour,
                                         &wr_command_colouring,
                                         &wr_command_normalmap,
                                         &wr_command_roughness,
                                         &wr_command_metalness,
                                         &wr_command_gltf,
                                         &wr_command_bake,
                                         &wr_command_light,
                                         &wr_command_environment,
                                         &wr_command_camera,
                                         &wr_command_background,
                                         &wr_command_tone,
                                         &wr_command_cell,
                                         &wr_command_sheet,
                                         &wr_command_dials,
                                         &wr_command_tolerance,
                                         &wr_command_save,
                                         &wr_command_copy,
                                         &wr_command_export,
                                         &wr_command_maps,
                                         &wr_command_bake_tiles,
                                         &wr_command_render,
                                         &wr_command_script,
                                         &wr_command_undo,
                                         &wr_command_redo,
                                         &wr_command_step,
                                         &wr_command_view,
                                         &wr_command_history,
                                         NULL };
const int wr_command_count = (int)(sizeof wr_commands / sizeof *wr_commands) - 1;

const WrCommand *wr_command_find(const char *name)
{
    for (int i = 0; i < wr_command_count; i++)
        if (strcmp(wr_commands[i]->name, name) == 0) return wr_commands[i];
    return NULL;
}

int wr_command_form(const WrCommand *command, const char *name, WrForm *out)
{
    for (int i = 0; command->form && command->form(i, out); i++)
        if (strcmp(out->name, name) == 0) return i;
    return -1;
}

int wr_command_specs(const WrCommand *command, int form, WrArgSpec out[WR_ARGS_MAX])
{
    int count = 0;
    WrForm row;
    if (form >= 0 && command->form ? command->form(form, &row) : command->row && command->row(&row))
        while (count < WR_ARGS_MAX && row.args[count].name) {
            out[count] = row.args[count];
            count++;
        }
    for (const WrArgSpec *s = command->args; s && s->name && count < WR_ARGS_MAX; s++)
        out[count++] = *s;
    for (const WrArgSpec *s = command->more; s && s->name && count < WR_ARGS_MAX; s++)
        out[count++] = *s;
    return count;
}

/* panels.h - the panels and dialogs that the roster lists. */
#pragma once
#include "ui/canvas/outline.h"
#include "ui/state/app_state.h"

#include <SDL.h>

void wr_panel_menu(WrApp *app);
void wr_menu_item(WrApp *app, const char *action); /* of any menu that is open */
void wr_menu_filters(WrApp *app);                  /* the operations that a new layer can be */
/* Told of each action that a menu has, while it is set; for tests. */
extern void (*wr_menu_listed)(const char *action);
void wr_panel_options(WrApp *app);
void wr_panel_tools(WrApp *app);
void wr_panel_right(WrApp *app);
void wr_panel_brushes(WrApp *app, SDL_Rect room);
void wr_panel_brush(WrApp *app); /* the values of the brush in hand */
void wr_panel_scene(WrApp *app);
void wr_panel_objects(WrApp *app);  /* its upper part */
void wr_panel_material(WrApp *app); /* its lower parts */
void wr_panel_maps(WrApp *app);
void wr_panel_colouring(WrApp *app);                       /* a part of that */
void wr_map_take_colour(WrApp *app, const char *path);     /* of a file that was chosen */
void wr_light_take_surround(WrApp *app, const char *path); /* likewise */
/* The chosen object becomes that mesh, set of patches or ground. */
void wr_surface_take_mesh(WrApp *app, const char *path);
void wr_surface_take_patches(WrApp *app, const char *path);
void wr_surface_take_terrain(WrApp *app, const char *path);
void wr_map_take_normals(WrApp *app, const char *path);
void wr_map_take_roughness(WrApp *app, const char *path);
void wr_map_take_metalness(WrApp *app, const char *path);
void wr_panel_lights(WrApp *app);
void wr_panel_camera(WrApp *app);
void wr_panel_cell(WrApp *app);
void wr_panel_solid(WrApp *app); /* relief and solid textures */
void wr_panel_plan(WrApp *app);
void wr_panel_history(WrApp *app);
void wr_dialog_unsaved(WrApp *app);
void wr_dialog_new(WrApp *app);
void wr_dialog_table(WrApp *app);
void wr_dialog_fill(WrApp *app);
void wr_dialog_grid(WrApp *app);
void wr_dialog_import(WrApp *app);
void wr_dialog_export(WrApp *app);
void wr_dialog_render(WrApp *app);
void wr_dialog_film(WrApp *app);
void wr_file_take_film(WrApp *app, const char *path);
void wr_file_take_render(WrApp *app, const char *path); /* what it asked for */
void wr_dialog_file(WrApp *app);
void wr_dialog_preset(WrApp *app); /* the name of a preset to be saved */
void wr_dialog_select_open(WrApp *app, WrOutlineKind kind);
void wr_dialog_select(WrApp *app);
void wr_dialog_recover_open(WrApp *app); /* if there is anything to recover */
void wr_dialog_recover(WrApp *app);
void wr_recovery_free(WrRecovery *recovery); /* NULL is fine */

/* panels.h - the panels and dialogs of the registry. */
#pragma once
#include "ui/canvas/outline.h"
#include "ui/app/state/app_state.h"

#include <SDL.h>

void wr_panel_menu(WrApp *app);
#define WR_ACTION_LABEL 96 /* bytes of a label */
/* An action's label in the menus, in the user's language: with the number of the chosen layers if it changes several. */
const char *wr_menu_label(const WrApp *app, const WrAction *action, char text[WR_ACTION_LABEL]);
void wr_menu_item(WrApp *app, const char *action); /* item of an open menu */
void wr_menu_filters(WrApp *app);                  /* operations usable as a new filter layer */
/* Called for each action in a menu, if set; for tests. */
extern void (*wr_menu_listed)(const char *action);
void wr_panel_options(WrApp *app);
void wr_panel_tools(WrApp *app);
void wr_panel_right(WrApp *app);
/* Move a tab into a floating panel at (x, y) in pixels; and all of these back. */
void wr_tab_tear_off(WrApp *app, int tab, int x, int y);
void wr_tabs_dock_all(WrApp *app);
void wr_panel_export(WrApp *app); /* the Export tab */
void wr_panel_brushes(WrApp *app, SDL_Rect room);
void wr_panel_brush(WrApp *app); /* parameters of the brush */
void wr_panel_scene(WrApp *app);
void wr_panel_scene_second(WrApp *app); /* its second column */
void wr_panel_objects(WrApp *app);      /* upper part of the scene panel */
void wr_panel_material(WrApp *app);     /* lower parts of the scene panel */
void wr_panel_maps(WrApp *app);
void wr_panel_colouring(WrApp *app);                       /* part of the material section */
void wr_map_take_colour(WrApp *app, const char *path);     /* handler of a chosen file */
void wr_light_take_surround(WrApp *app, const char *path); /* handler of a chosen file */
/* Handlers of a chosen file: the active object becomes that mesh, patch set or terrain. */
void wr_surface_take_mesh(WrApp *app, const char *path);
void wr_surface_take_patches(WrApp *app, const char *path);
void wr_surface_terrain_file_chosen(WrApp *app, const char *path);
void wr_map_take_normals(WrApp *app, const char *path);
void wr_map_take_roughness(WrApp *app, const char *path);
void wr_map_take_metalness(WrApp *app, const char *path);
void wr_panel_lights(WrApp *app);
void wr_panel_camera(WrApp *app);
void wr_panel_cell(WrApp *app);
void wr_panel_solid(WrApp *app); /* relief and solid textures */
void wr_panel_plan(WrApp *app);
void wr_dialog_unsaved(WrApp *app);
void wr_dialog_new(WrApp *app);
void wr_dialog_starters(WrApp *app);
void wr_dialog_welcome(WrApp *app);
void wr_dialog_tour(WrApp *app);
/* Open the welcome if the program has never been used. */
void wr_welcome_open(WrApp *app);
void wr_dialog_table(WrApp *app);
void wr_dialog_fill(WrApp *app);
void wr_dialog_grid(WrApp *app);
void wr_dialog_import(WrApp *app);
void wr_dialog_export(WrApp *app);
void wr_dialog_bake(WrApp *app);
void wr_file_take_bake(WrApp *app, const char *path);
void wr_dialog_render(WrApp *app);
void wr_dialog_film(WrApp *app);
void wr_file_take_film(WrApp *app, const char *path);
void wr_file_take_render(WrApp *app, const char *path); /* handler of the chosen file name */
void wr_dialog_file(WrApp *app);
void wr_dialog_drop(WrApp *app);       /* use of dropped pictures */
void wr_panel_drop_forget(WrApp *app); /* free its texture */
void wr_dialog_preset(WrApp *app);     /* name of a preset to save */
void wr_dialog_select_open(WrApp *app, WrOutlineKind kind);
void wr_dialog_select(WrApp *app);
void wr_dialog_mask(WrApp *app);
void wr_dialog_link(WrApp *app);
void wr_panel_variants(
    WrApp *app); /* row above the layers' list; only if the document has variants */
void wr_dialog_variant(WrApp *app); /* name of a variant */
void wr_act_variant_add(WrApp *app);
void wr_act_variant_set(WrApp *app);
void wr_act_variant_rename(WrApp *app);
void wr_act_variant_delete(WrApp *app);
bool wr_is_variant(const WrApp *app);         /* one is in use */
bool wr_is_variant_changed(const WrApp *app); /* the values differ from it */
void wr_dialog_recover_open(WrApp *app);      /* if there are recoverable journals */
void wr_dialog_recover(WrApp *app);
void wr_recovery_free(WrRecovery *recovery); /* NULL is allowed */

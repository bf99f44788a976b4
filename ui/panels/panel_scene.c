/* Scene panel: every field shows the document's value, changes the preview while it is dragged, and runs one command
   at the end. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/files.h"
#include "ui/panels/panel_scene.h"
#include "ui/panels/panels.h"
#include "ui/panels/param_row.h"
#include "ui/panels/picture_grid.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "command/command_line.h"
#include "document/document.h"
#include "scene/param.h"
#include "scene/scene.h"
#include "surface/data.h"
#include "surface/patches.h"
#include "surface/projection.h"
#include "surface/surface.h"
#include "system/path.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define GLYPH 24

/* ---- surface ---- */

/* Append the file of a surface, and the table part of each patch for a patch set. */
static void add_file(WrText *line, const WrShape *shape, const char *file, int table)
{
    if (!*file) return;
    wr_text_add(line, " file=");
    wr_text_add_word(line, file);
    if (shape->kind == WR_SURFACE_patches) wr_text_addf(line, " table=%s", wr_patch_tables[table]);
}

/* File and table part of the present surface, if it is of this kind. */
static const char *file_of(WrApp *app, WrSurfaceKind kind, int *table)
{
    const WrScene *scene = wr_app_scene(app);
    *table = WR_PATCH_EACH;
    if (!scene->triangles || !scene->triangles_path || scene->shape.kind != kind) return "";
    if (scene->triangles->patches) *table = (int)scene->triangles->patches->table;
    return scene->triangles_path;
}

/* Another file of the same model keeps the projection, but not the materials, whose names may differ. */
static void add_projection(WrText *line, const WrScene *scene)
{
    const WrProjection *is = &scene->projection;
    if (scene->shape.kind != WR_SURFACE_mesh || is->kind == WR_PROJECTION_UV) return;
    wr_text_addf(line, " projection=%s", wr_projection_names[is->kind]);
    wr_line_number(line, "cell", is->cell[0]);
    wr_text_add(line, ",");
    wr_text_add_number(line, is->cell[1]);
    wr_line_vec(line, "turn", (WrVec3){ is->turn_deg[0], is->turn_deg[1], is->turn_deg[2] });
    if (is->placed) wr_line_vec(line, "at", (WrVec3){ is->at[0], is->at[1], is->at[2] });
    wr_line_number(line, "blend", is->blend);
    wr_line_number(line, "crease", is->crease_deg);
    wr_text_addf(line, " facing=%s", wr_facing_names[is->facing]);
}

static void run_file(WrApp *app, const WrShape *shape, const char *const *text, const char *file,
                     int table)
{
    WrText line = { 0 };
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    const double *value = shape->value;
    wr_text_addf(&line, "surface %s", info->name);
    for (int k = 0; k < WR_SURFACE_PARAMS && info->params[k].name; k++) {
        int n = info->params[k].components, point = n < 3 ? n : 3;
        wr_text_addf(&line, " %s=", info->params[k].name);
        for (int i = 0; i < n; i++) {
            if (i) wr_text_add(&line, i % point ? "," : ";");
            wr_text_add_number(&line, *value++);
        }
    }
    for (int k = 0; text && k < WR_SURFACE_TEXTS && info->texts[k].name; k++) {
        wr_text_addf(&line, " %s=", info->texts[k].name);
        wr_text_add_word(&line, text[k]);
    }
    const char *layer = wr_app_scene(app)->form_layer;
    if (info->held) add_file(&line, shape, file, table);
    if (shape->kind == WR_SURFACE_mesh && *file) add_projection(&line, wr_app_scene(app));
    if (shape->kind == WR_SURFACE_terrain && !*file && layer) {
        wr_text_add(&line, " layer=");
        wr_text_add_word(&line, layer);
    }
    wr_scene_run(app, &line);
}

void wr_surface_run(WrApp *app, const WrShape *shape, const char *const *text)
{
    int table;
    const char *file = file_of(app, shape->kind, &table);
    run_file(app, shape, text, file, table);
}

bool wr_layer_choice(WrApp *app, const char *id, const char *now, int *which)
{
    const WrDocument *document = wr_app_document(app);
    const char *labels[1 + WR_LAYERS_MAX] = { wr_words("None") };
    *which = 0;
    for (int i = 0; i < document->layer_count; i++) {
        labels[1 + i] = document->layers[i].name;
        if (now && strcmp(now, labels[1 + i]) == 0) *which = 1 + i;
    }
    wr_gui_as_it_is(true); /* names of layers are not translated */
    const bool chosen = wr_gui_choice(id, 0, labels, 1 + document->layer_count, which);
    wr_gui_as_it_is(false);
    return chosen;
}

/* Choice of the layer that holds the heights of a terrain, or a file. */
static void form_layer(WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    int which;
    wr_gui_label("Layer");
    const bool chosen = wr_layer_choice(app, "form layer", scene->form_layer, &which);
    wr_gui_tip("Layer with the terrain's height map: painting there raises hills; other layers add "
               "detail");
    if (!chosen) return;
    WrText line = { 0 };
    wr_text_add(&line, "surface terrain");
    const double *value = scene->shape.value;
    const WrSurfaceParam *p = wr_surfaces[WR_SURFACE_terrain]->params;
    for (int k = 0; p[k].name; k++) {
        wr_text_addf(&line, " %s=", p[k].name);
        wr_text_add_number(&line, value[k]);
    }
    if (which > 0) wr_text_addf(&line, " layer=%d", which);
    wr_scene_run(app, &line);
}

/* ---- file of a surface ---- */

static void take_file(WrApp *app, WrSurfaceKind kind, const char *path)
{
    const WrScene *scene = wr_app_scene(app);
    WrShape shape = scene->shape;
    int table;
    const bool first = !*file_of(app, kind, &table);
    const bool repeats = scene->replicate_u != 1 || scene->replicate_v != 1;
    if (shape.kind != kind) wr_shape_default(kind, &shape); /* another kind was chosen meanwhile */
    run_file(app, &shape, NULL, path, table);
    /* The repeats were those of the surface before; the mesh's own (u,v) or its projection place the table. */
    if (kind == WR_SURFACE_mesh && first && repeats) wr_app_run_line(app, "replicate 1,1");
    wr_scene_refit(app);
}

void wr_surface_take_mesh(WrApp *app, const char *path)
{
    take_file(app, WR_SURFACE_mesh, path);
}

void wr_surface_take_patches(WrApp *app, const char *path)
{
    take_file(app, WR_SURFACE_patches, path);
}

void wr_surface_terrain_file_chosen(WrApp *app, const char *path)
{
    take_file(app, WR_SURFACE_terrain, path);
}

/* Open a file dialog at the present file, else in the folder of patch sets shipped with the program. */
static void browse(WrApp *app, const char *file)
{
    const WrSurfaceKind kind = wr_app_scene(app)->shape.kind;
    const WrFilePurpose purpose = kind == WR_SURFACE_patches   ? WR_FILE_PATCHES
                                  : kind == WR_SURFACE_terrain ? WR_FILE_TERRAIN
                                                               : WR_FILE_MESH;
    WrText shipped = { 0 };
    const char *from = *file ? file : NULL;
    if (!from && kind == WR_SURFACE_patches && wr_data_find("samples/teapot.bpt", &shipped))
        from = wr_text_get(&shipped);
    char *folder = from ? wr_path_folder(from) : NULL;
    if (!wr_files_request_path(app->files, purpose, folder, ""))
        wr_dialog_open(app, WR_DIALOG_FILE);
    wr_free(folder);
    wr_text_fini(&shipped);
}

/* File row of a mesh, patch set or terrain. */
static void surface_file(WrApp *app)
{
    const WrShape *shape = &wr_app_scene(app)->shape;
    WrSurfaceState *hand = app->surface;
    int table;
    const char *file = file_of(app, shape->kind, &table);
    const double key = shape->value[WR_MESH_KEY] + 0x1p40 * (1 + (int)shape->kind);
    if (!wr_surfaces[shape->kind]->held) return;
    if (hand->file_key != key) snprintf(hand->file, sizeof hand->file, "%s", file);
    hand->file_key = key;
    wr_gui_label("File");
    const double room = wr_gui_available() - wr_gui_px(GLYPH + 4);
    const bool done =
        wr_gui_text_field("##surface file", room, hand->file, sizeof hand->file, false);
    const bool left = wr_gui_field_left();
    wr_gui_tip(shape->kind == WR_SURFACE_terrain ? "A picture: black is low, white is high"
               : shape->kind == WR_SURFACE_patches
                   ? "A text file of bicubic patches, such as teapot.bpt"
                   : "OBJ, PLY, STL, glTF, 3MF and others");
    wr_gui_same_line(4);
    if (wr_gui_glyph("browse", WR_ICON_FOLDER, GLYPH, WR_COLOUR_LABEL)) browse(app, file);
    wr_gui_tip("Choose a file");
    if (left && wr_gui_escape_pressed()) hand->file_key = 0; /* read again */
    else if ((done || left) && *hand->file && strcmp(hand->file, file) != 0)
        run_file(app, shape, NULL, hand->file, table);
    if (shape->kind == WR_SURFACE_terrain) form_layer(app);
    if (shape->kind != WR_SURFACE_patches || !*file) return;
    static const char *const labels[WR_PATCH_TABLES] = { "Whole", "Whole, joined", "Unfolded",
                                                         "Own cells" };
    wr_gui_label("Table");
    const bool chosen = wr_gui_choice("patch table", 0, labels, WR_PATCH_TABLES, &table);
    wr_gui_tip("Part of the table on each patch: the whole table by its own u and v; the whole "
               "table, continuous across shared edges; a part of the table, with the set unfolded; "
               "a cell of its own");
    if (!chosen) return;
    WrText line = { 0 }; /* reuse the loaded set, since its file may have moved */
    wr_text_addf(&line, "surface patches table=%s", wr_patch_tables[table]);
    wr_scene_run(app, &line);
}

/* ---- parameters of a surface ---- */

/* Text parameters of a surface, each in a field that runs the command when the edit ends. */
static void surface_texts(WrApp *app)
{
    const WrShape *shape = &wr_app_scene(app)->shape;
    const WrSurfaceInfo *info = wr_surfaces[shape->kind];
    WrSurfaceState *hand = app->surface;
    const char *text[WR_SURFACE_TEXTS] = { NULL };
    bool done = false, left = false;
    if (!shape->data) return;
    for (int k = 0; k < WR_SURFACE_TEXTS && info->texts[k].name; k++) {
        if (hand->key != shape->key)
            snprintf(hand->text[k], sizeof hand->text[k], "%s", shape->data->text[k]);
        char id[24];
        snprintf(id, sizeof id, "##text%d", k);
        wr_gui_label(info->texts[k].label);
        if (wr_gui_text_field(id, 0, hand->text[k], sizeof hand->text[k], false)) done = true;
        if (wr_gui_field_left()) left = true;
        wr_gui_tip(info->texts[k].help);
        text[k] = hand->text[k];
    }
    hand->key = shape->key;
    if (!done && !left) return;
    if (left && wr_gui_escape_pressed()) hand->key = 0; /* read again */
    for (int k = 0; k < WR_SURFACE_TEXTS && info->texts[k].name && hand->key; k++) {
        if (strcmp(hand->text[k], shape->data->text[k]) == 0) continue;
        wr_surface_run(app, shape, text);
        return;
    }
}

/* A parameter with two values. */
static void end_choice(WrApp *app, const WrSurfaceParam *p, const char *label, int offset)
{
    WrShape shape = wr_app_scene(app)->shape;
    int which = shape.value[offset] >= p->high;
    if (!wr_gui_choice(label, 0, p->ends, 2, &which)) return;
    shape.value[offset] = which ? p->high : p->low;
    wr_surface_run(app, &shape, NULL);
}

static void surface_params(WrApp *app)
{
    WrShape shape = wr_app_scene(app)->shape;
    const WrSurfaceInfo *info = wr_surfaces[shape.kind];
    int offset = 0;
    for (int k = 0; k < WR_SURFACE_PARAMS && info->params[k].name; k++) {
        const WrSurfaceParam *p = &info->params[k];
        for (int i = 0; i < p->components && p->components <= 3; i++) {
            static const char *const parts[] = { " x", " y", " z" };
            double high = p->high < 1e3 ? p->high : fmax(2.0, fabs(p->fallback[i]) * 4.0);
            double low = p->low > -1e3 ? p->low : -high;
            WrNumber spec = { .low = low < high ? low : high - 1.0,
                              .high = high,
                              .hard_low = p->low,
                              .hard_high = p->high,
                              .reset = p->fallback[i],
                              .decimals = 3,
                              .tip = p->help };
            char label[128];
            snprintf(label, sizeof label, "%.96s%s", wr_words(p->help),
                     p->components == 3 ? parts[i] : "");
            if (label[0] >= 'a' && label[0] <= 'z') label[0] = (char)(label[0] - 'a' + 'A');
            wr_gui_label(p->ends[0] ? "Table" : label);
            if (p->ends[0]) {
                end_choice(app, p, label, offset);
                continue;
            }
            WrEdit edit = wr_gui_number(label, 0, &spec, &shape.value[offset + i]);
            if (edit == WR_EDIT_LIVE && wr_shape_check(&shape, NULL))
                wr_app_live_begin(app)->shape = shape;
            if (edit == WR_EDIT_DONE)
                wr_surface_run(app, &shape,
                               shape.data ? (const char *const *)shape.data->text : NULL);
        }
        offset += p->components;
    }
}

static void repeats(WrApp *app)
{
    const WrSceneParam *param = &wr_scene_params[WR_SCENE_PARAM_REPLICATE];
    const WrNumber spec = wr_param_slider(param);
    double ru = wr_app_scene(app)->replicate_u, rv = wr_app_scene(app)->replicate_v;
    wr_gui_label(param->label);
    double half = (wr_gui_available() - wr_gui_px(8)) / 2.0;
    WrEdit edit_u = wr_gui_number("ru", half, &spec, &ru);
    wr_gui_same_line(8);
    WrEdit edit_v = wr_gui_number("rv", half, &spec, &rv);
    /* a drag uses integers, so that closed surfaces stay seamless; any number can be typed */
    if (edit_u == WR_EDIT_LIVE) ru = rint(ru);
    if (edit_v == WR_EDIT_LIVE) rv = rint(rv);
    if (edit_u != WR_EDIT_NONE || edit_v != WR_EDIT_NONE)
        wr_scene_param_set(param, wr_app_live_begin(app), (const double[]){ ru, rv });
    if (edit_u != WR_EDIT_DONE && edit_v != WR_EDIT_DONE) return;
    WrText line = { 0 };
    wr_text_add(&line, "replicate ");
    wr_text_add_number(&line, ru);
    wr_text_add(&line, ",");
    wr_text_add_number(&line, rv);
    wr_scene_run(app, &line);
}

static void surface(WrApp *app)
{
    const char *labels[WR_SURFACE_COUNT];
    for (int i = 0; i < WR_SURFACE_COUNT; i++) labels[i] = wr_surfaces[i]->label;
    int kind = (int)wr_app_scene(app)->shape.kind;
    if (!wr_gui_fold("SURFACE", true)) return;
    wr_gui_label("Patch");
    if (wr_gui_choice("patch", 0, labels, WR_SURFACE_COUNT, &kind)) {
        WrShape shape;
        wr_shape_default((WrSurfaceKind)kind, &shape);
        wr_surface_run(app, &shape, NULL);
        wr_scene_refit(app);
    }
    wr_gui_tip(wr_surfaces[kind]->help);
    surface_params(app);
    if (wr_app_scene(app)->shape.kind == WR_SURFACE_revolution && wr_app_scene(app)->shape.data)
        wr_profile_row(app);
    surface_texts(app);
    surface_file(app);
    wr_projection_rows(app);
    repeats(app);
    wr_model_grid(app);
}

typedef void Section(WrApp *app);

/* first: number that separates fields of the same label */
static void sections(WrApp *app, Section *const *draw, int count, int first)
{
    for (int i = 0; i < count; i++) {
        wr_gui_push_id(first + i);
        draw[i](app);
        wr_gui_pop_id();
    }
}

void wr_panel_scene(WrApp *app)
{
    static Section *const list[] = { wr_panel_objects, surface, wr_panel_material, wr_panel_maps };
    sections(app, list, WR_LENGTH(list), 0);
}

void wr_panel_scene_second(WrApp *app)
{
    static Section *const list[] = { wr_panel_solid, wr_panel_lights, wr_panel_camera,
                                     wr_panel_cell };
    sections(app, list, WR_LENGTH(list), 100);
    wr_gui_space(8);
}

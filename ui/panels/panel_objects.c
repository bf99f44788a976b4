/* Objects section of the scene panel: list of objects, active object and its position. Every change is a command
   line. */
#include "ui/panels/panel_objects.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/line.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/files.h"
#include "ui/panels/panels.h"
#include "ui/panels/param_row.h"

#include "base/text.h"
#include "command/command_line.h"
#include "scene/objects.h"
#include "scene/param.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROW_UNITS 26

/* ---- the list ---- */

/* Run "object choose NAME" and similar lines. */
static void run_named(WrApp *app, const char *what, int i)
{
    char buffer[WR_OBJECT_LABEL];
    WrText line = { 0 };
    wr_text_addf(&line, "object %s ", what);
    wr_text_add_word(&line, wr_scene_object_label(wr_app_scene(app), i, buffer));
    wr_scene_run(app, &line);
}

/* True if a command was run: the list of objects has changed. */
static bool row(WrApp *app, int i)
{
    const WrScene *scene = wr_app_scene(app), *object = wr_scene_object(scene, i);
    const bool chosen = i == scene->chosen;
    char buffer[WR_OBJECT_LABEL];
    const char *kind = wr_surfaces[object->shape.kind]->label;
    const WrRow r = wr_gui_row_begin(i, ROW_UNITS, chosen);
    const double right = wr_gui_row_width() - wr_gui_px(8);
    wr_gui_row_set_cursor(wr_gui_px(4), wr_gui_px(20));
    const bool eye = wr_gui_glyph("eye", object->hidden ? WR_ICON_EYE_OFF : WR_ICON_EYE, 20,
                                  object->hidden ? WR_COLOUR_MUTED : WR_COLOUR_TEXT);
    wr_gui_tip(object->hidden ? "Show it" : "Hide it");
    const double wide = wr_gui_text_width(WR_FONT_SMALL, kind), x = wr_gui_px(32);
    wr_gui_row_set_cursor(x, 0);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_TEXT,
                    object->hidden ? WR_COLOUR_MUTED
                    : chosen       ? WR_COLOUR_STRONG
                                   : WR_COLOUR_TEXT,
                    wr_scene_object_label(scene, i, buffer), right - x - wide - wr_gui_px(8));
    wr_gui_as_it_is(false);
    wr_gui_row_set_cursor(right - wide, 0);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, kind);
    wr_gui_row_end();
    if (eye) run_named(app, object->hidden ? "show" : "hide", i);
    else if (r.clicked && !chosen) run_named(app, "choose", i);
    return eye || (r.clicked && !chosen);
}

/* ---- adding ---- */

/* "object 4": a name with the first free number, starting at the count. */
static void free_name(const WrScene *scene, WrText *text)
{
    int number = wr_scene_object_count(scene) + 1;
    do {
        wr_text_clear(text);
        wr_text_addf(text, "object %d", number++);
    } while (wr_scene_object_find(scene, wr_text_get(text)) >= 0);
}

/* Add an object to the right of all others. */
static void add(WrApp *app, const char *what)
{
    const WrScene *scene = wr_app_scene(app);
    WrText line = { 0 }, name = { 0 };
    free_name(scene, &name);
    wr_text_addf(&line, "object %s ", what);
    wr_text_add_word(&line, wr_text_get(&name));
    WrVec3 at = scene->at;
    at.x += 1.15 * scene->size * 2 * wr_shape_radius(&scene->shape);
    wr_line_vec(&line, "at", wr_line_round_vec(at, 3));
    wr_text_fini(&name);
    wr_scene_run(app, &line);
}

static void buttons(WrApp *app)
{
    const int floor_at = wr_scene_object_find(wr_app_scene(app), "ground");
    const bool ground = floor_at >= 0 && wr_scene_object(wr_app_scene(app), floor_at)->still;
    if (wr_gui_icon_button("add", WR_ICON_PLUS, 26, false)) add(app, "add");
    wr_gui_tip("Adds an object, a plane beside the active one; choose its surface below");
    wr_gui_same_line(4);
    if (wr_gui_icon_button("copy", WR_ICON_COPY, 26, false)) add(app, "copy");
    wr_gui_tip("Duplicates the active object beside it");
    wr_gui_same_line(4);
    wr_gui_disable(wr_scene_object_count(wr_app_scene(app)) == 1);
    if (wr_gui_icon_button("remove", WR_ICON_DELETE, 26, false))
        wr_app_run_linef(app, "object remove");
    wr_gui_tip("Removes the active object");
    wr_gui_disable_end();
    wr_gui_same_line(12);
    wr_gui_next_id("ground");
    if (wr_gui_chip(NULL, ground ? "Ground off" : "Ground")) wr_action_run(app, WR_ACT(ground));
    wr_gui_tip(ground
                   ? "Take the floor away"
                   : "Adds a floor at the lowest point of the objects; it does not turn with them");
}

/* ---- active object ---- */

static void name_row(WrApp *app)
{
    WrObjectsState *hand = app->objects;
    const WrScene *scene = wr_app_scene(app);
    char buffer[WR_OBJECT_LABEL];
    const char *label = wr_scene_object_label(scene, scene->chosen, buffer);
    if (strcmp(hand->of, label) != 0) {
        snprintf(hand->of, sizeof hand->of, "%s", label);
        snprintf(hand->name, sizeof hand->name, "%s", label);
    }
    wr_gui_label("Name");
    const bool done = wr_gui_text_field("##object", 0, hand->name, sizeof hand->name, false);
    const bool left = wr_gui_field_left() && !wr_gui_escape_pressed();
    if (!(done || left) || !hand->name[0] || strcmp(hand->name, hand->of) == 0) return;
    WrText line = { 0 };
    wr_text_add(&line, "object set");
    wr_line_text(&line, "name", hand->name);
    hand->of[0] = '\0';
    wr_scene_run(app, &line);
}

static void place(WrApp *app)
{
    static const char *const ids[3] = { "atx", "aty", "atz" }, *const turns[3] = { "rx", "ry",
                                                                                   "rz" };
    static const WrNumber away = {
        .low = -3,
        .high = 3,
        .hard_low = -1e9,
        .hard_high = 1e9,
        .decimals = 3,
        .tip = "Position of its centre: x to the right, y up, z to the viewer"
    };
    static const WrNumber deg = { .low = -180,
                                  .high = 180,
                                  .hard_low = -1e9,
                                  .hard_high = 1e9,
                                  .decimals = 1,
                                  .unit = "\xc2\xb0",
                                  .tip = "Rotation about the world's x, then y, then z axis" };
    const WrScene *scene = wr_app_scene(app);
    const double *own = wr_surfaces[scene->shape.kind]->pose_deg;
    double at[3] = { scene->at.x, scene->at.y, scene->at.z };
    double turn[3] = { own[0], own[1], own[2] };
    if (scene->posed)
        turn[0] = scene->rotate_deg.x, turn[1] = scene->rotate_deg.y, turn[2] = scene->rotate_deg.z;
    WrEdit edit = wr_param_vector("Position", ids, &away, at);
    if (edit != WR_EDIT_NONE) wr_app_live_begin(app)->at = (WrVec3){ at[0], at[1], at[2] };
    if (edit == WR_EDIT_DONE) {
        WrText line = { 0 };
        wr_text_add(&line, "object set");
        wr_line_vec(&line, "at", (WrVec3){ at[0], at[1], at[2] });
        wr_scene_run(app, &line);
        return;
    }
    edit = wr_param_vector("Turn", turns, &deg, turn);
    if (edit != WR_EDIT_NONE) {
        WrScene *live = wr_app_live_begin(app);
        live->posed = true;
        live->rotate_deg = (WrVec3){ turn[0], turn[1], turn[2] };
    }
    if (edit != WR_EDIT_DONE) return;
    WrText line = { 0 };
    wr_text_add(&line, "object set");
    wr_line_vec(&line, "turn", (WrVec3){ turn[0], turn[1], turn[2] });
    wr_scene_run(app, &line);
}

/* One size, or three if they differ; and a switch from one to three. */
static void sizes(WrApp *app, bool always)
{
    static const char *const ids[3] = { "sx", "sy", "sz" };
    static const WrNumber times = {
        .low = -3,
        .high = 3,
        .hard_low = -1e9,
        .hard_high = 1e9,
        .reset = 1,
        .decimals = 3,
        .tip = "Size along the object's own axes x, y, z; negative values mirror, 0 is flat"
    };
    const WrScene *scene = wr_app_scene(app);
    const bool three = v3_len(scene->sizes) > 0;
    if (!three && (always || scene->size != 1))
        wr_param_row(app, &wr_scene_params[WR_SCENE_PARAM_SIZE]);
    if (!three && !always) return;
    double s[3] = { scene->size, scene->size, scene->size };
    if (three) s[0] = scene->sizes.x, s[1] = scene->sizes.y, s[2] = scene->sizes.z;
    const WrEdit edit = wr_param_vector("Along x, y, z", ids, &times, s);
    const double most = fmax(fabs(s[0]), fmax(fabs(s[1]), fabs(s[2])));
    if (edit != WR_EDIT_NONE && most >= 1e-3) {
        WrScene *live = wr_app_live_begin(app);
        live->size = most;
        live->sizes = (WrVec3){ s[0], s[1], s[2] };
    }
    if (edit != WR_EDIT_DONE) return;
    WrText line = { 0 };
    wr_text_add(&line, "object set");
    wr_line_vec(&line, "size", (WrVec3){ s[0], s[1], s[2] });
    wr_scene_run(app, &line);
}

static void table(WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrScene *scene = wr_app_scene(app);
    const char *labels[WR_LAYERS_MAX + 2] = { wr_words("All layers") };
    const int file = document->layer_count + 1;
    int now = 0;
    for (int i = 0; i < document->layer_count; i++) {
        labels[i + 1] = document->layers[i].name;
        if (scene->layer && strcmp(scene->layer, labels[i + 1]) == 0) now = i + 1;
    }
    labels[file] = wr_words("A file\xe2\x80\xa6");
    const int before = now;
    wr_gui_label("Table");
    wr_gui_as_it_is(true); /* names of layers are not translated */
    const bool changed = wr_gui_choice("table", 0, labels, file + 1, &now);
    wr_gui_as_it_is(false);
    if (changed && now != before) {
        if (now == file) wr_files_request_path(app->files, WR_FILE_TABLE, NULL, "");
        else if (now > 0) wr_app_run_linef(app, "object set layer=%d", now);
        else wr_app_run_linef(app, "object set layer=all");
    }
    wr_gui_tip("Its heights: the composite of all layers, one layer, or a document or picture, "
               "which becomes a layer that only this object shows");
}

void wr_object_table_file_chosen(WrApp *app, const char *path)
{
    WrText line = { 0 };
    wr_text_add(&line, "object set");
    wr_line_text(&line, "table", path);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

void wr_panel_objects(WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    const int count = wr_scene_object_count(scene);
    if (!wr_gui_fold("OBJECTS", true)) return;
    for (int i = 0; i < count; i++)
        if (row(app, i)) return;
    buttons(app);
    if (count > 1 || scene->name) name_row(app);
    if (count > 1) place(app);
    sizes(app, count > 1);
    table(app);
}

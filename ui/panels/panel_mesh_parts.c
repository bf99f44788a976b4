/* The materials of an imported mesh that carry relief: a row of the scene panel. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/line.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/panels/panel_scene.h"

#include "base/text.h"
#include "scene/scene.h"
#include "surface/relief_weights.h"
#include "surface/triangles.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_listed(const WrScene *scene, int32_t part)
{
    const char *list = scene->projection.materials;
    return !*list || wr_relief_lists(list, scene->triangles, part);
}

/* True for a part that has the material of the one before: a tile divides the parts. */
static bool is_again(const WrTriangles *mesh, int32_t part)
{
    return part > 0 && wr_relief_number(mesh, part) == wr_relief_number(mesh, part - 1);
}

static int material_count(const WrTriangles *mesh)
{
    int count = 0;
    for (int32_t i = 0; i < mesh->part_count; i++) count += !is_again(mesh, i);
    return count;
}

/* Runs the list with that part added or removed; all of them: no list. */
static void toggle_part(WrApp *app, int32_t part)
{
    const WrScene *scene = wr_app_scene(app);
    const WrTriangles *mesh = scene->triangles;
    WrText list = { 0 }, line = { 0 };
    int count = 0;
    for (int32_t i = 0; i < mesh->part_count; i++) {
        const char *name = mesh->parts[i].name;
        if (is_again(mesh, i)) continue;
        const bool same = i == part || (*name && strcmp(name, mesh->parts[part].name) == 0);
        if (is_listed(scene, i) == same) continue;
        if (count++ > 0 && wr_relief_lists(wr_text_get(&list), mesh, i)) continue; /* same name */
        if (count > 1) wr_text_add(&list, ",");
        if (*name && !strchr(name, ',')) wr_text_add(&list, name);
        else wr_text_addf(&list, "%d", wr_relief_number(mesh, i));
    }
    wr_text_add(&line, "surface mesh");
    wr_line_text(&line, "materials",
                 count > 0 && count < material_count(mesh) ? wr_text_get(&list) : "");
    wr_scene_run(app, &line);
    wr_text_fini(&list);
}

static void part_list(WrApp *app, const WrTriangles *mesh)
{
    if (!wr_gui_popup_begin("mesh materials")) return;
    wr_gui_width_at_least(200);
    wr_gui_list_begin("##parts", wr_gui_px(30.0 * fmin(material_count(mesh), 10) + 14));
    for (int32_t i = 0; i < mesh->part_count; i++) {
        char label[WR_TRIANGLE_NAME + 16];
        if (is_again(mesh, i)) continue;
        bool on = is_listed(wr_app_scene(app), i);
        snprintf(label, sizeof label, "%d %s", wr_relief_number(mesh, i), mesh->parts[i].name);
        wr_gui_push_id(i);
        wr_gui_as_it_is(true);
        const bool changed = wr_gui_check(label, &on);
        wr_gui_as_it_is(false);
        wr_gui_pop_id();
        if (!changed) continue;
        toggle_part(app, i);
        break; /* the scene is another one now */
    }
    wr_gui_list_end();
    if (wr_gui_escape_pressed()) wr_gui_popup_close();
    wr_gui_popup_end();
}

void wr_mesh_parts_row(WrApp *app)
{
    const WrProjection *is = &wr_app_scene(app)->projection;
    const WrTriangles *mesh = wr_app_scene(app)->triangles;
    if (material_count(mesh) < 2) return;
    wr_gui_label("Materials");
    if (*is->materials) wr_gui_as_it_is(true);
    const bool open =
        wr_gui_list_button("materials", *is->materials ? is->materials : "All", wr_gui_available());
    wr_gui_as_it_is(false);
    wr_gui_tip("Limits relief to these materials of the file");
    if (open) wr_gui_popup_open("mesh materials");
    part_list(app, mesh);
}

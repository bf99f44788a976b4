/* Texture coordinates, normals and relief masks of an imported mesh: rows of the scene panel. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/line.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/patch/patch.h"
#include "ui/patch/patch_projection.h"
#include "ui/patch/preview/rotation.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/settings.h"
#include "ui/panels/panel_scene.h"
#include "ui/panels/param_row.h"

#include "base/exactmath.h"
#include "base/text.h"
#include "field/field.h"
#include "scene/scene.h"
#include "surface/projection.h"
#include "surface/triangles.h"
#include "surface/uv_tiles.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SEAMS_MOST 200000 /* triangles whose seams are listed without being asked for */

static void run(WrApp *app, const char *name, const double *values, int count)
{
    WrText line = { 0 };
    wr_text_addf(&line, "surface mesh %s=", name);
    for (int i = 0; i < count; i++) {
        if (i > 0) wr_text_add(&line, ",");
        wr_text_add_number(&line, values[i]);
    }
    wr_scene_run(app, &line);
}

static void run_word(WrApp *app, const char *name, const char *word)
{
    WrText line = { 0 };
    wr_text_addf(&line, "surface mesh %s=%s", name, word);
    wr_scene_run(app, &line);
}

/* Shows the values of a drag; runs the command at its end. */
static void take(WrApp *app, WrEdit edit, const WrProjection *is, const char *name,
                 const double *values, int count)
{
    if (edit == WR_EDIT_NONE) return;
    wr_projection_live(app, is);
    if (edit == WR_EDIT_DONE) run(app, name, values, count);
}

/* A projection begins with cells of the table's proportions, so that the relief is not stretched. */
static void choose(WrApp *app, int kind)
{
    const WrProjection *is = &wr_app_scene(app)->projection;
    const WrField *field = wr_app_field(app);
    const double table = (double)wr_field_width(field) / wr_field_height(field);
    WrText line = { 0 };
    wr_text_addf(&line, "surface mesh projection=%s", wr_projection_names[kind]);
    if (is->kind == WR_PROJECTION_UV && is->cell[0] == is->cell[1] && table != 1) {
        wr_line_number(&line, "cell", is->cell[0]);
        wr_text_add(&line, ",");
        wr_text_add_number(&line, fmax(0.01, wr_line_round(is->cell[0] / table, 2)));
    }
    wr_scene_run(app, &line);
}

static void cell_row(WrApp *app)
{
    WrProjection is = wr_app_scene(app)->projection;
    const double least = wr_projection_least_cell(wr_app_scene(app), &is);
    const WrNumber spec = { .low = 0.1,
                            .high = 1000,
                            .hard_low = least,
                            .hard_high = 1e9,
                            .reset = wr_projection_default.cell[0],
                            .decimals = -1,
                            .unit = "mm",
                            .logarithmic = true,
                            .tip = "Width and height of the table on the mesh" };
    wr_gui_label("Cell");
    const double half = (wr_gui_available() - wr_gui_px(8)) / 2;
    const WrEdit w = wr_gui_number("cell on mesh w", half, &spec, &is.cell[0]);
    wr_gui_same_line(8);
    const WrEdit h = wr_gui_number("cell on mesh h", half, &spec, &is.cell[1]);
    take(app, w > h ? w : h, &is, "cell", is.cell, 2);
}

static void place_rows(WrApp *app)
{
    static const char *const turn_ids[3] = { "projection turn x", "projection turn y",
                                             "projection turn z" };
    static const char *const at_ids[3] = { "projection at x", "projection at y",
                                           "projection at z" };
    const WrTriangles *mesh = wr_app_scene(app)->triangles;
    const WrNumber turn = {
        .low = -180,
        .high = 180,
        .hard_low = -360,
        .hard_high = 360,
        .decimals = 1,
        .tip = "Rotates the projection about the mesh's x, then y, then z axis, in degrees"
    };
    WrProjection is = wr_app_scene(app)->projection;
    const double reach =
        2 * mesh->radius + fabs(mesh->centre[0]) + fabs(mesh->centre[1]) + fabs(mesh->centre[2]);
    const double most = fmin(1e9, fmin(is.cell[0], is.cell[1]) / wr_length_unit_mm(is.unit) *
                                      WR_PROJECTION_CELLS / 32);
    const WrNumber at = { .low = -reach,
                          .high = reach,
                          .hard_low = -fmax(most, reach),
                          .hard_high = fmax(most, reach),
                          .decimals = -1,
                          .tip = "Origin of the projection, in the mesh's coordinates" };
    const WrEdit turned = wr_param_vector("Turn", turn_ids, &turn, is.turn_deg);
    take(app, turned, &is, "turn", is.turn_deg, 3);
    if (!is.placed) memcpy(is.at, mesh->centre, sizeof is.at);
    const WrEdit moved = wr_param_vector("Origin", at_ids, &at, is.at);
    is.placed = true;
    take(app, moved, &is, "at", is.at, 3);
}

/* A row for one number of the projection, which is a member of *is; name: of its argument. */
static void number_row(WrApp *app, const char *label, const char *name, const WrNumber *spec,
                       WrProjection *is, double *value)
{
    wr_gui_label(label);
    const WrEdit edit = wr_gui_number(name, 0, spec, value);
    take(app, edit, is, name, value, 1);
}

static void normals_row(WrApp *app)
{
    WrProjection is = wr_app_scene(app)->projection;
    const WrNumber spec = {
        .low = 0,
        .high = WR_CREASE_NONE,
        .reset = WR_CREASE_NONE,
        .decimals = 0,
        .tip = "Edges with a larger angle are sharp, others smooth; 180: the normals of the file"
    };
    number_row(app, "Crease", "crease", &spec, &is, &is.crease_deg);
}

static void blend_row(WrApp *app)
{
    WrProjection is = wr_app_scene(app)->projection;
    const WrNumber spec = { .low = 0,
                            .high = 1,
                            .decimals = 2,
                            .tip = "Blends the planes of the box near their borders, so that the "
                                   "relief is continuous; 0: each triangle uses one plane" };
    number_row(app, "Blend", "blend", &spec, &is, &is.blend);
}

static void facing_rows(WrApp *app)
{
    static const char *const labels[WR_FACINGS] = { "Everywhere", "X",  "Y",        "Z",      "-X",
                                                    "-Y",         "-Z", "Outwards", "Inwards" };
    WrProjection is = wr_app_scene(app)->projection;
    const WrNumber angle = { .low = 0,
                             .high = 180,
                             .reset = wr_projection_default.facing_deg,
                             .decimals = 0,
                             .tip =
                                 "Largest angle between the mesh and that direction, in degrees" };
    const WrNumber soft = { .low = 0,
                            .high = 180,
                            .decimals = 0,
                            .tip = "Width of the fade beyond that angle, in degrees; 0: no fade, "
                                   "each triangle is inside or outside" };
    int facing = (int)is.facing;
    wr_gui_label("Relief on");
    if (wr_gui_choice("facing", 0, labels, WR_FACINGS, &facing))
        run_word(app, "facing", wr_facing_names[facing]);
    wr_gui_tip("Limits relief to faces in that direction, along the projection's axes; outwards "
               "and inwards: away from and towards its z axis");
    if (is.facing == WR_FACING_ANY) return;
    number_row(app, "Angle", "angle", &angle, &is, &is.facing_deg);
    number_row(app, "Soft", "soft", &soft, &is, &is.facing_soft_deg);
}

/* Choice of the layer that limits the relief, for a mesh with (u,v) of its own. */
static void mask_row(WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    int which;
    if (!wr_scene_mesh_source(scene)->mapped) return;
    wr_gui_label("Mask");
    const bool chosen = wr_layer_choice(app, "mask layer", scene->mask_layer, &which);
    wr_gui_tip("Scales the relief by this layer: none at 0 or less, full at 1 or more. It uses the "
               "file's own texture coordinates, whatever the projection");
    if (!chosen) return;
    char number[16] = "\"\"";
    if (which > 0) snprintf(number, sizeof number, "%d", which);
    run_word(app, "mask", number);
}

/* Choice of the UDIM tile that shows the table, for a mesh with several. */
static void tile_row(WrApp *app)
{
    const WrScene *scene = wr_app_scene(app);
    const WrTriangles *mesh = wr_scene_mesh_source(scene);
    WrSurfaceState *hand = app->surface;
    if (hand->tiles_key != mesh->key) {
        WrUvTiles tiles = wr_uv_tiles(mesh);
        hand->tile_count = wr_uv_tiles_numbers(&tiles, hand->tiles, WR_SURFACE_TILES_MAX);
        wr_uv_tiles_fini(&tiles);
        hand->tiles_key = mesh->key;
    }
    if (hand->tile_count < 2 && !scene->projection.udim) return;
    char words[WR_SURFACE_TILES_MAX][8];
    const char *labels[1 + WR_SURFACE_TILES_MAX] = { wr_words("All") };
    int which = 0;
    for (int i = 0; i < hand->tile_count; i++) {
        snprintf(words[i], sizeof words[i], "%d", hand->tiles[i]);
        labels[1 + i] = words[i];
        if (hand->tiles[i] == scene->projection.udim) which = 1 + i;
    }
    wr_gui_label("UDIM tile");
    wr_gui_as_it_is(true); /* numbers are not translated */
    const bool chosen = wr_gui_choice("udim", 0, labels, 1 + hand->tile_count, &which);
    wr_gui_as_it_is(false);
    if (chosen) run_word(app, "udim", which > 0 ? labels[which] : "all");
    wr_gui_tip("UDIM tile that shows the table; other tiles have no relief. A document has one "
               "table: paint each tile in a document of its own");
}

static void handle_row(WrApp *app)
{
    bool on = wr_is_projecting(app);
    if (wr_gui_check("Handle in the view", &on)) wr_action_run(app, WR_ACT(projection_handle));
    wr_gui_tip("The disc moves the projection, the ring rotates it, the square scales its cell");
}

/* ---- seams ---- */

/* Turns the object so that its direction n faces the camera, by the shortest way: the light stays where it is. */
static void face(WrScene *scene, const WrPlacement *place, double turn_deg, WrVec3 n)
{
    WrRotation object;
    memcpy(object.m, place->rotation, sizeof object.m);
    const WrVec3 from = wr_rotation_apply(&object, n), to = v3_scale(place->forward, -1);
    const WrVec3 axis = v3_cross(from, to);
    const double deg = atan2(v3_len(axis), v3_dot(from, to)) * WR_DEG_PER_RAD;
    const WrRotation by = wr_rotation_axis(v3_unit(axis, place->up), deg);
    const WrRotation back = wr_rotation_axis((WrVec3){ 0, 1, 0 }, -turn_deg);
    const WrRotation world = wr_rotation_times(&by, &object);
    const WrRotation own = wr_rotation_times(&back, &world);
    scene->posed = true;
    scene->rotate_deg = wr_line_round_vec(wr_rotation_to_deg(&own), 2);
}

/* Looks at the seam along the mean normal of its faces, from near enough to see it among its surroundings: a single
   object turns, among several the camera goes there. */
static void go_to(WrApp *app, const WrTextureSeam *seam)
{
    const SDL_Rect *room = &app->layout->patch;
    const double turn_deg = app->patch->turn_deg, radius = wr_app_scene(app)->triangles->radius;
    WrPlacement place;
    WrText line = { 0 }, turn = { 0 };
    app->settings->turning = false;
    if (!wr_patch_place(app, &place)) return;
    WrScene *scene = wr_scene_clone(wr_app_scene(app));
    const bool single = scene->other_count == 0;
    if (single) face(scene, &place, turn_deg, seam->n);
    if (single && wr_scene_place(scene, turn_deg, (double)room->w / room->h, &place, NULL)) {
        wr_text_add(&turn, "rotate ");
        wr_line_plain_vec(&turn, scene->rotate_deg);
    }
    const WrVec3 at = wr_object_to_world(&place, seam->at);
    const WrVec3 out = wr_object_to_world(&place, v3_mad(seam->at, seam->n, radius));
    const WrVec3 n = v3_unit(v3_sub(out, at), v3_scale(place.forward, -1));
    const double away = 2 * radius * place.size;
    wr_text_addf(&line, "camera %s", wr_camera_names[scene->camera.orthographic]);
    wr_line_vec(&line, "eye", wr_line_round_vec(v3_mad(at, n, away), 4));
    wr_line_vec(&line, "target", wr_line_round_vec(at, 4));
    if (scene->camera.orthographic) wr_line_number(&line, "size", wr_line_round(away, 4));
    wr_scene_free(scene);
    if (turn.length > 0) wr_scene_run(app, &turn);
    wr_scene_run(app, &line);
}

static void seam_rows(WrApp *app)
{
    const WrTextureSeams *seams = &app->surface->seams;
    char text[160];
    if (seams->edges == 0) return;
    snprintf(text, sizeof text, wr_words("Edges where the table is discontinuous: %d. Longest:"),
             (int)seams->edges);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    for (int i = 0; i < WR_TEXTURE_SEAMS && i < seams->runs; i++) {
        wr_words_print(text, sizeof text, wr_words("%.4g long"), seams->run[i].length);
        wr_gui_push_id(i);
        wr_gui_as_it_is(true);
        wr_gui_label(text);
        wr_gui_as_it_is(false);
        if (wr_gui_chip(NULL, "Go there")) go_to(app, &seams->run[i]);
        wr_gui_tip("Shows the middle of the longest edge there");
        wr_gui_pop_id();
    }
}

/* Where the relief steps because the table does not run on. Of large meshes only when asked for: it takes a moment. */
static void seams_of(WrApp *app)
{
    const WrTriangles *mesh = wr_app_scene(app)->triangles;
    WrSurfaceState *state = app->surface;
    const bool small = mesh->triangle_count <= SEAMS_MOST;
    if (app->live) {
        seam_rows(app);
        return;
    }
    if (state->seams_key != mesh->key && !small) {
        wr_gui_label("");
        if (!wr_gui_chip(NULL, "Find the seams")) return;
    }
    if (state->seams_key != mesh->key) wr_triangles_seams(mesh, &state->seams, NULL);
    state->seams_key = mesh->key;
    seam_rows(app);
}

static WrProjectionKind kind_of(const WrApp *app)
{
    return wr_app_scene(app)->projection.kind;
}

void wr_projection_rows(WrApp *app)
{
    static const char *const labels[WR_PROJECTIONS] = { "Of the file", "Planar", "Box",
                                                        "Cylindrical", "Spherical" };
    static const char *const units[WR_UNIT_COUNT] = { "mm (assumed)", "mm",   "cm",         "m",
                                                      "inches",       "feet", "micrometres" };
    const WrScene *scene = wr_app_scene(app); /* each row may make another */
    if (scene->shape.kind != WR_SURFACE_mesh || !scene->triangles) return;
    int kind = (int)scene->projection.kind, unit = (int)scene->projection.unit;
    wr_gui_label("Projection");
    if (wr_gui_choice("projection", 0, labels, WR_PROJECTIONS, &kind)) choose(app, kind);
    wr_gui_tip("Projection of the table onto the mesh");
    if (kind_of(app) != WR_PROJECTION_UV) {
        cell_row(app);
        if (kind_of(app) == WR_PROJECTION_BOX) blend_row(app);
        place_rows(app);
        wr_gui_label("Unit");
        if (wr_gui_choice("mesh unit", 0, units, WR_UNIT_COUNT, &unit) && unit > 0)
            run_word(app, "unit", wr_length_units[unit - WR_UNIT_MM]);
        wr_gui_tip("Unit of the mesh's coordinates");
        handle_row(app);
    } else {
        tile_row(app);
    }
    normals_row(app);
    facing_rows(app);
    if (kind_of(app) == WR_PROJECTION_UV && wr_app_scene(app)->projection.facing != WR_FACING_ANY)
        place_rows(app);
    wr_mesh_parts_row(app);
    mask_row(app);
    if (wr_app_scene(app)->triangles->mapped) seams_of(app);
}

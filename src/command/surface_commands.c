/* Commands for the surface of an object and its bump: surface, rotate, analytic, bump, replicate, cell. */
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/length_unit.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "field/analytic.h"
#include "field/field.h"
#include "field/scheme_list.h"
#include "image/image.h"
#include "image/mesh.h"
#include "scene/objects.h"
#include "scene/param.h"
#include "scene/scene.h"
#include "surface/data.h"
#include "surface/mesh_faults.h"
#include "surface/patches.h"
#include "surface/projection.h"
#include "surface/relief_weights.h"
#include "surface/terrain.h"
#include "surface/triangles.h"
#include "surface/uv_tiles.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- surface terrain ---- */

/* The command `surface terrain`: a surface whose form is a height picture, or a layer of the document. Changes of the
   layer update the form. */

static const float *row_of_image(const void *ctx, int j, float *room)
{
    const WrImage *image = ctx;
    const size_t channels = (size_t)image->channels, w = (size_t)image->width;
    const float *from = image->data + (size_t)j * w * channels;
    for (size_t i = 0; i < w; i++) room[i] = wr_image_luma(from + i * channels, (int)channels);
    return room;
}

static const float *row_of_field(const void *ctx, int j, float *room)
{
    const WrField *field = ctx;
    wr_field_read(field, 0, j, wr_field_width(field), 1, room, (size_t)wr_field_width(field));
    return room;
}

/* Points are 4 x 4 control points of a bicubic Bezier patch, 16 x 3 = 48 floats each, patches row by row. */
static WrTriangles *made_of(WrTerrain terrain, const WrShape *shape, WrError *err)
{
    float(*points)[48];
    int columns, rows;
    terrain.a = shape->value[0], terrain.b = shape->value[1];
    terrain.height = shape->value[2];
    terrain.cells = (int)shape->value[3];
    if (!wr_terrain_points(&terrain, &points, &columns, &rows, err)) return NULL;
    WrTriangles *made =
        wr_patches_new((const float(*)[48])points, columns * rows, WR_PATCH_SPLIT, err);
    wr_free(points);
    return made;
}

/* Elevations in metres on a surface a few units wide make a needle. The note suggests the height scale for half as
   tall as wide. */
static void note_needle(WrSession *session, const char *path, const WrImage *image,
                        const WrShape *shape)
{
    const size_t channels = (size_t)image->channels,
                 count = (size_t)image->width * (size_t)image->height;
    float low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        const float z = wr_image_luma(image->data + i * channels, (int)channels);
        if (z < low) low = z;
        if (z > high) high = z;
    }
    const double span = (double)high - (double)low, side = fmin(shape->value[0], shape->value[1]);
    if (!(fabs(shape->value[2]) * span > 5 * side)) return;
    wr_session_note(session,
                    "%s: its values are %g to %g, so height=%g makes ground %g high and %g wide; "
                    "height=%.2g makes it half as high as wide",
                    path, (double)low, (double)high, shape->value[2], fabs(shape->value[2]) * span,
                    side, 0.5 * side / span);
}

/* Read the triangles of `surface terrain file=` and write notes about them; apply its layer= argument. */
static WrTriangles *terrain_read(WrSession *session, const char *path, const WrShape *shape,
                                 WrError *err)
{
    const WrImageRequest wish = { .elevation = true };
    WrImage *image = wr_image_read_request(path, &wish, err);
    if (!image) return NULL;
    wr_session_note_read(session, path, image);
    note_needle(session, path, image, shape);
    const WrTerrain terrain = {
        .row = row_of_image, .ctx = image, .w = image->width, .h = image->height
    };
    WrTriangles *made = made_of(terrain, shape, err);
    wr_image_free(image);
    return made;
}

static void terrain_note(WrSession *session, const char *path, const WrTriangles *mesh)
{
    const WrPatches *set = mesh->patches;
    wr_session_note(session, "%s: %d x %d patches in %d triangles", path, (int)set->columns,
                    (int)set->rows, (int)mesh->triangle_count);
}

/* ---- from a layer -------------------------------------------------------------------------------- */

/* Form, mask and bump use different layers: those of form and mask are hidden from the composite, so that their
   heights are no bumps. before: the layer that was used until now. */
static bool hide_layer(WrSession *session, int index, const WrScene *scene, const char *before,
                       bool is_mask, WrError *err)
{
    WrLayer *layer = &session->state.document->layers[index];
    if (scene->layer && strcmp(scene->layer, layer->name) == 0)
        return wr_fail(
            err,
            is_mask
                ? "that layer is the object's table: choose another layer as its mask"
                : "that layer already is this object's height map: choose another for the terrain");
    if (before && strcmp(before, layer->name) == 0) return true;
    if (!layer->visible) return true;
    layer->visible = false;
    wr_session_note(session,
                    is_mask ? "layer %d was hidden: it is now a mask, not relief"
                            : "layer %d was hidden: it is now the terrain's height map, not relief",
                    index + 1);
    return true;
}

static bool terrain_names_layer(const WrCall *call)
{
    return wr_call_given(call, "layer");
}

static bool terrain_take_layer(WrSession *session, WrCall *call, WrScene *scene, WrError *err)
{
    const char *word = wr_call_arg(call, "layer")->text, *name = word;
    int index;
    if (wr_call_given(call, "file")) return wr_fail(err, "give file= or layer=, not both");
    if (!session->loading) {
        if (!wr_session_find_layer(session, word, &index, err) ||
            !hide_layer(session, index, scene, session->state.document->scene->form_layer, false,
                        err))
            return false;
        name = session->state.document->layers[index].name;
    } else if (session->embedded_mesh) { /* until the layer's heights are used */
        WrTriangles *mesh = wr_scene_mesh_from_image(session->embedded_mesh, scene->chosen, err);
        if (!mesh) return false;
        wr_scene_set_triangles(scene, mesh, NULL, NULL);
    }
    scene->form_layer = wr_strdup(name);
    return true;
}

/* True if the layer that holds the form of object i exists and has changed; *index is that layer. form_key is the layer's key
   when the form was made: a comparison of two integers per command instead of heights. */
static bool lags(const WrDocument *document, int i, int *index)
{
    const WrScene *object = wr_scene_object(document->scene, i);
    if (!object->form_layer || object->shape.kind != WR_SURFACE_terrain) return false;
    *index = wr_layer_named(document, object->form_layer);
    return *index >= 0 &&
           (!object->triangles || object->form_key != wr_layer_key(document, *index));
}

static bool take_form(WrSession *session, WrScene *object, int index, WrError *err)
{
    const WrDocument *document = session->state.document;
    WrField *heights = wr_document_layer_alone(document, index, session->options.pool);
    const WrTerrain terrain = { .row = row_of_field,
                                .ctx = heights,
                                .w = wr_field_width(heights),
                                .h = wr_field_height(heights) };
    WrTriangles *made = made_of(terrain, &object->shape, err);
    wr_field_free(heights);
    if (!made) return false;
    wr_scene_set_triangles(object, made, NULL, NULL);
    object->form_key = wr_layer_key(document, index);
    return true;
}

/* ---- a mesh's mask ---- */

/* The layer of the object's mask, and the key of its heights; 0: there is no such layer. */
static uint64_t mask_key(const WrDocument *document, const WrScene *object, int *index)
{
    *index = wr_layer_named(document, object->mask_layer);
    return *index >= 0 ? wr_layer_key(document, *index) : 0;
}

static bool mask_lags(const WrDocument *document, const WrScene *object)
{
    int index;
    return object->mask_layer && object->triangles &&
           object->mask_key != mask_key(document, object, &index);
}

static void take_mask(const WrSession *session, WrScene *object)
{
    const WrDocument *document = session->state.document;
    int index;
    const uint64_t key = mask_key(document, object, &index);
    WrField *mask =
        index >= 0 ? wr_document_layer_alone(document, index, session->options.pool) : NULL;
    wr_scene_set_mask(object, object->mask_layer, mask, key);
    wr_field_free(mask);
}

/* Rebuild object i's form, its mask, its colours or all. */
static bool follow_object(WrSession *session, int i, int form, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    WrScene *object = wr_scene_clone(wr_scene_object(scene, i)), *all = object;
    const bool masked = mask_lags(session->state.document, object);
    if (masked) take_mask(session, object);
    const bool good = (form < 0 || take_form(session, object, form, err)) &&
                      (!masked || wr_scene_project(object, &object->projection, err)) &&
                      (!wr_height_colormap_lags(session, object) ||
                       wr_height_colormap_make(session, object, err));
    if (!good) {
        wr_scene_free(object);
        return false;
    }
    if (i != scene->chosen) {
        all = wr_scene_clone(scene);
        wr_scene_set_object(all, i, object);
    }
    wr_session_replace_scene(session, all);
    return true;
}

/* Runs after every edit: forms, masks and colours that depend on layers are rebuilt before the step is recorded, so a step never
   holds a stale surface. */
bool wr_session_follow(WrSession *session, WrError *err)
{
    if (!session->loading && !wr_session_follow_layers(session, err)) return false;
    for (int i = 0; i < wr_scene_object_count(session->state.document->scene); i++) {
        const WrScene *object = wr_scene_object(session->state.document->scene, i);
        int form = -1;
        if (!lags(session->state.document, i, &form)) form = -1;
        if (form < 0 && !mask_lags(session->state.document, object) &&
            !wr_height_colormap_lags(session, object))
            continue;
        if (!follow_object(session, i, form, err)) return false;
    }
    return true;
}

/* changes and additions for a terrain: 0 and 2 rows */
static void form_terrain(WrArgSpec *args)
{
    args[0] = (WrArgSpec){
        .name = "file",
        .type = WR_ARG_PATH,
        .help = "a picture, black low and white high; its heights are saved in the document"
    };
    args[2] = (WrArgSpec){ .name = "layer",
                           .type = WR_ARG_TEXT,
                           .shape = "NAME",
                           .help = "instead of file=: name or number of a layer, whose heights "
                                   "shape the ground while it is painted; it is hidden as a bump" };
}

/* ---- The mesh of `surface mesh file=`: reading, notes, storage in documents ---- */

_Static_assert(WR_MESH_NAME == WR_TRIANGLE_NAME, "names of parts");

/* The file's parts as the surface stores them. The caller frees them. */
static WrTrianglePart *parts_of(const WrMesh *mesh)
{
    WrTrianglePart *parts = wr_alloc((size_t)mesh->part_count, sizeof *parts);
    for (int32_t i = 0; i < mesh->part_count; i++) {
        parts[i] = (WrTrianglePart){ .first = mesh->parts[i].first, .count = mesh->parts[i].count };
        memcpy(parts[i].name, mesh->parts[i].name, sizeof parts[i].name);
    }
    return parts;
}

static bool is_moved(const WrMesh *mesh)
{
    return mesh->origin[0] != 0 || mesh->origin[1] != 0 || mesh->origin[2] != 0;
}

/* Note the offset if the positions were moved to the origin. */
static void note_origin(WrSession *session, const char *path, const WrMesh *mesh)
{
    WrText text = { 0 };
    double away = 0;
    if (!is_moved(mesh)) return;
    for (int k = 0; k < 3; k++) away = fmax(away, fabs(mesh->origin[k]));
    wr_text_addf(&text, "%s: lies far from its file's origin: ", path);
    for (int k = 0; k < 3; k++) {
        if (k > 0) wr_text_add(&text, ",");
        wr_text_add_number(&text, mesh->origin[k]);
    }
    wr_text_add(&text, " was subtracted from its points, and solids are exported there again");
    if (mesh->single)
        wr_text_addf(&text,
                     "; this format is read in single precision, so that relief below %.2g "
                     "is lost: save it as PLY or OBJ",
                     away * FLT_EPSILON);
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* Its points relative to that place of the file; the caller frees them. NULL: no memory. */
static float (*points_about(const WrMesh *mesh, const double about[3], WrError *err))[3]
{
    float(*points)[3] = wr_try_alloc((size_t)mesh->point_count, sizeof *points, "a mesh", err);
    for (int32_t i = 0; i < mesh->point_count && points; i++)
        for (int k = 0; k < 3; k++)
            points[i][k] = (float)((double)mesh->points[i][k] + (mesh->origin[k] - about[k]));
    return points;
}

/* Note points whose (u,v) are no numbers. */
static void note_bad_uv(WrSession *session, const char *path, const WrMesh *mesh)
{
    const double *at = mesh->bad_uv_at;
    if (mesh->bad_uv > 0)
        wr_session_note(session,
                        "%s: points with texture coordinates that are not numbers, or beyond 1e6: "
                        "%d, the first at %.6g,%.6g,%.6g; their triangles have no relief",
                        path, (int)mesh->bad_uv, at[0], at[1], at[2]);
}

WrTriangles *wr_session_read_mesh(WrSession *session, const char *path, const double *about,
                                  WrMeshFacts *facts, WrError *err)
{
    WrMesh mesh;
    if (!wr_mesh_read_attributes(path, &mesh, err)) return NULL;
    WrTrianglePart *parts = parts_of(&mesh);
    float(*moved)[3] = about ? points_about(&mesh, about, err) : NULL;
    const WrTrianglesSource source = { .points = moved ? (const float(*)[3])moved : mesh.points,
                                       .normals = mesh.normals,
                                       .uv = mesh.uv,
                                       .corners = mesh.corners,
                                       .point_count = mesh.point_count,
                                       .triangle_count = mesh.triangle_count,
                                       .parts = parts,
                                       .part_count = mesh.part_count };
    WrTriangles *made = !about || moved ? wr_triangles_new(&source, err) : NULL;
    facts->unit = mesh.unit;
    memcpy(facts->origin, about ? about : mesh.origin, sizeof facts->origin);
    if (made && (!about || mesh.single)) note_origin(session, path, &mesh);
    if (made) note_bad_uv(session, path, &mesh);
    else wr_error_prefix(err, "%s: ", path);
    wr_free(moved);
    wr_free(parts);
    wr_mesh_fini(&mesh);
    return made;
}

/* ---- notes ---- */

static void add_count(WrText *text, int32_t count, const char *label)
{
    if (count > 0) wr_text_addf(text, "; %s: %d", label, (int)count);
}

static void add_parts(WrText *text, const WrTriangles *mesh)
{
    if (mesh->part_count < 2) return;
    wr_text_addf(text, " in %d parts (", (int)mesh->part_count);
    for (int i = 0; i < mesh->part_count && i < 4; i++)
        wr_text_addf(text, "%s%s", i ? ", " : "",
                     mesh->parts[i].name[0] ? mesh->parts[i].name : "unnamed");
    wr_text_add(text, mesh->part_count > 4 ? ", ...)" : ")");
}

/* udim: the tile that shows the table; 0: all. */
static void add_map(WrText *text, const WrTriangles *mesh, int udim)
{
    if (!mesh->mapped) {
        wr_text_add(text, "; no texture coordinates: the table has no slope on it");
        return;
    }
    WrTriangles *tile = udim ? wr_triangles_of_tile(mesh, udim, NULL) : NULL;
    WrUvOverlap overlap = wr_triangles_overlap(tile ? tile : mesh, WR_UV_OVERLAP_CELLS);
    if (udim) overlap.outside = 0;
    wr_triangles_free(tile);
    if (overlap.share > WR_UV_OVERLAP_NOTED)
        wr_text_addf(text,
                     "; %.1f%% of its texture coordinates are met twice, the first at u, v of "
                     "%.3g,%.3g: paint there shows in several places",
                     100 * overlap.share, overlap.at[0], overlap.at[1]);
    add_count(text, overlap.outside, "triangles beyond u, v of 0..1, where the table repeats");
    add_count(text, mesh->report.no_map, "triangles without texture coordinates, without slope");
    add_count(text, mesh->report.collinear,
              "triangles with u, v along a line, without tangent frame but with exact slopes");
    add_count(text, mesh->report.mirrored, "mirrored triangles");
    add_count(text, mesh->report.near_uv,
              "corners that differ from another by a rounding of u, v, where tangent frames part");
}

/* own: its own texture coordinates are used, of the tile `udim`, or of all, 0. */
static void note_mesh(WrSession *session, const char *path, const WrTriangles *mesh,
                      const WrMeshFacts *facts, bool own, int udim)
{
    WrText text = { 0 };
    const WrTrianglesReport *report = &mesh->report;
    WrMeshFaults faults;
    const bool found = wr_mesh_faults_find(mesh, facts->origin, &faults, NULL);
    wr_text_addf(&text, "%s: %d triangle%s", path, (int)mesh->triangle_count,
                 mesh->triangle_count == 1 ? "" : "s");
    add_parts(&text, mesh);
    if (found) wr_text_addf(&text, ", %s", wr_mesh_faults_body(&faults, mesh));
    if (report->inside_out) wr_text_add(&text, "; it was inside out and has been turned");
    if (found) wr_mesh_faults_text(&faults, &text);
    add_count(&text, report->no_normal + report->bad_normal,
              "corners without a normal, given the mean of their faces'");
    add_count(&text, report->face_normal, "corners given their face's normal");
    if (own) add_map(&text, mesh, udim);
    char ending[16];
    wr_path_ending(path, ending);
    if (strcmp(ending, "gltf") == 0 || strcmp(ending, "glb") == 0)
        wr_text_add(&text, "; its material is not taken: the command gltf does that");
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* ---- sets of patches, terrains ---- */

#define PATCHES_BYTES (64 << 20) /* size limit of a patch file */

static WrTriangles *read_patches(const char *path, WrPatchTable table, WrError *err)
{
    char *text;
    size_t length;
    float(*points)[48];
    int32_t count;
    WrTriangles *made = NULL;
    if (!wr_file_read(path, PATCHES_BYTES, &text, &length, err)) return NULL;
    if (wr_patches_parse(text, length, &points, &count, err)) {
        made = wr_patches_new((const float(*)[48])points, count, table, err);
        wr_free(points);
    }
    if (!made) wr_error_prefix(err, "%s: ", path);
    wr_free(text);
    return made;
}

/* HC152: note open edges, collapsed edges and creases, since none of them is visible at once. */
static void note_patches(WrSession *session, const char *path, const WrTriangles *mesh)
{
    WrText text = { 0 };
    const WrPatches *set = mesh->patches;
    const WrPatchesReport *report = &set->report;
    wr_text_addf(&text, "%s: %d patch%s in %d triangles, %s", path, (int)set->count,
                 set->count == 1 ? "" : "es", (int)mesh->triangle_count,
                 mesh->closed ? "closed" : "open");
    add_count(&text, report->shared, "shared edges");
    add_count(&text, report->open, "open edges");
    if (report->loops > 1) wr_text_addf(&text, " in %d loops", (int)report->loops);
    add_count(&text, report->collapsed, "edges collapsed to a point");
    add_count(&text, report->crowded, "edges of more than two patches");
    add_count(&text, report->turned, "patches turned to the side of the others");
    add_count(&text, report->against, "edges between patches that face to different sides");
    if (report->crease_deg > 0)
        wr_text_addf(&text,
                     "; creased edges: %d, the sharpest between patches %d and %d by %.2f degrees",
                     (int)report->creased, (int)report->crease_of[0] + 1,
                     (int)report->crease_of[1] + 1, report->crease_deg);
    if (set->table == WR_PATCH_JOINED || set->table == WR_PATCH_SPLIT)
        wr_text_addf(&text, "; shared edges that the table runs on across: %d",
                     (int)report->joined);
    if (set->columns > 1 || set->rows > 1)
        wr_text_addf(&text, ", in cells of %d x %d", (int)set->columns, (int)set->rows);
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* ---- the command ---- */

static WrTriangles *read_held(WrSession *session, const WrCall *call, const WrShape *shape,
                              const char *path, WrMeshFacts *facts, WrError *err)
{
    if (shape->kind == WR_SURFACE_terrain) return terrain_read(session, path, shape, err);
    if (shape->kind == WR_SURFACE_mesh)
        return wr_session_read_mesh(session, path, NULL, facts, err);
    return read_patches(path, (WrPatchTable)wr_call_choice(call, "table"), err);
}

static void note_held(WrSession *session, WrSurfaceKind kind, const char *path,
                      const WrTriangles *mesh, const WrMeshFacts *facts, bool own, int udim)
{
    if (kind == WR_SURFACE_terrain) terrain_note(session, path, mesh);
    else if (kind == WR_SURFACE_mesh) note_mesh(session, path, mesh, facts, own, udim);
    else note_patches(session, path, mesh);
}

/* ---- projection of a mesh ---- */

/* Parses the value of udim=, 0: all. */
static bool udim_parse(const char *text, int *udim)
{
    *udim = 0;
    return strcmp(text, "all") == 0 || wr_udim_parse(text, udim);
}

static bool check_udim(const void *ctx, const char *name, const char *value, WrError *err)
{
    int udim;
    (void)ctx;
    if (udim_parse(value, &udim)) return true;
    return wr_fail(err, "%s=%.40s: must be all, or a tile's number, %d..%d", name, value,
                   WR_UDIM_FIRST, WR_UDIM_LAST);
}

static int udim_of(const WrCall *call)
{
    int udim = 0;
    if (wr_call_given(call, "udim")) udim_parse(wr_call_arg(call, "udim")->text, &udim);
    return udim;
}

/* Note the tiles of a mesh with several, and the one that shows the table. */
static void note_tiles(WrSession *session, const WrScene *scene)
{
    const int udim = scene->projection.udim;
    WrUvTiles tiles = wr_uv_tiles(wr_scene_mesh_source(scene));
    WrText text = { 0 };
    if (tiles.count > 1 || udim) {
        wr_message_addf(&text, "UDIM tiles and their triangles: ");
        wr_uv_tiles_print(&tiles, &text);
        if (tiles.crossing)
            wr_message_addf(&text, "; triangles across their borders: %d", (int)tiles.crossing);
        if (tiles.outside)
            wr_message_addf(&text,
                            "; triangles outside UDIM, which has u of 0 to 10 and v from 0: %d",
                            (int)tiles.outside);
        if (udim)
            wr_message_addf(&text, "; tile %d shows the table, the others have no relief", udim);
        else wr_message_addf(&text, "; all tiles show the table: udim= chooses one");
        wr_session_note(session, "%s", wr_text_get(&text));
    }
    wr_text_fini(&text);
    wr_uv_tiles_fini(&tiles);
}

/* True if the call has an argument of the projection. */
static bool names_projection(const WrCall *call)
{
    return wr_call_given(call, "udim") || wr_call_given(call, "projection") ||
           wr_call_given(call, "cell") || wr_call_given(call, "turn") ||
           wr_call_given(call, "at") || wr_call_given(call, "unit") ||
           wr_call_given(call, "origin") || wr_call_given(call, "crease") ||
           wr_call_given(call, "facing") || wr_call_given(call, "angle") ||
           wr_call_given(call, "soft") || wr_call_given(call, "materials") ||
           wr_call_given(call, "mask") || wr_call_given(call, "blend");
}

static bool take_masks(const WrCall *call, WrProjection *to, WrError *err)
{
    if (wr_call_given(call, "facing")) to->facing = (WrFacing)wr_call_choice(call, "facing");
    if (wr_call_given(call, "angle")) to->facing_deg = wr_call_number(call, "angle");
    if (wr_call_given(call, "soft")) to->facing_soft_deg = wr_call_number(call, "soft");
    if (wr_call_given(call, "blend")) to->blend = wr_call_number(call, "blend");
    if (wr_call_given(call, "materials")) {
        const char *list = wr_call_arg(call, "materials")->text;
        if (strlen(list) >= sizeof to->materials)
            return wr_fail(err, "materials=: the list is longer than %d bytes; give numbers",
                           (int)sizeof to->materials - 1);
        strcpy(to->materials, list);
    }
    return true;
}

/* Unused settings take their defaults: the printed line has the others alone. */
static void drop_unused(WrProjection *to)
{
    const WrProjection none = wr_projection_default;
    if (to->facing == WR_FACING_ANY)
        to->facing_deg = none.facing_deg, to->facing_soft_deg = none.facing_soft_deg;
    if (to->kind != WR_PROJECTION_BOX) to->blend = none.blend;
    if (to->kind != WR_PROJECTION_UV) return;
    memcpy(to->cell, none.cell, sizeof to->cell);
    if (to->facing != WR_FACING_ANY) return; /* it is along the projection's axes */
    memcpy(to->turn_deg, none.turn_deg, sizeof to->turn_deg);
    memcpy(to->at, none.at, sizeof to->at);
    to->placed = false;
}

static bool take_projection(const WrCall *call, WrProjection *to, WrError *err)
{
    const WrArg *cell = wr_call_arg(call, "cell");
    if (wr_call_given(call, "projection"))
        to->kind = (WrProjectionKind)wr_call_choice(call, "projection");
    if (cell->given)
        for (int k = 0; k < 2; k++) to->cell[k] = cell->numbers[k < cell->counts[0] ? k : 0];
    if (wr_call_given(call, "turn"))
        memcpy(to->turn_deg, wr_call_arg(call, "turn")->numbers, sizeof to->turn_deg);
    to->placed |= wr_call_given(call, "at");
    if (wr_call_given(call, "at")) memcpy(to->at, wr_call_arg(call, "at")->numbers, sizeof to->at);
    if (wr_call_given(call, "unit"))
        to->unit = (WrLengthUnit)(wr_call_choice(call, "unit") + WR_UNIT_MM);
    if (wr_call_given(call, "origin"))
        memcpy(to->origin, wr_call_arg(call, "origin")->numbers, sizeof to->origin);
    if (wr_call_given(call, "crease")) to->crease_deg = wr_call_number(call, "crease");
    if (wr_call_given(call, "udim")) to->udim = udim_of(call);
    else if (to->kind != WR_PROJECTION_UV) to->udim = 0;
    if (to->udim && to->kind != WR_PROJECTION_UV)
        return wr_fail(err, "udim=%d: needs projection=uv: only the file's own (u,v) have tiles",
                       to->udim);
    if (!take_masks(call, to, err)) return false;
    drop_unused(to);
    return true;
}

/* Use the file's mesh of the active object with another projection, since the file may have moved. */
static bool reuse_mesh(const WrSession *session, WrScene *scene, WrError *err)
{
    const WrScene *before = session->state.document->scene;
    if (!before->triangles || before->shape.kind != WR_SURFACE_mesh)
        return wr_fail(err, "settings of the projection need file=: the object has no mesh yet");
    const WrTriangles *source = wr_scene_mesh_source(before);
    wr_scene_set_triangles(scene, wr_triangles_share(source), before->triangles_path,
                           before->triangles_sha256);
    scene->projection = before->projection;
    wr_scene_set_mask(scene, before->mask_layer, before->mask, before->mask_key);
    return true;
}

/* The layer that limits the relief; mask="": none. */
static bool take_mask_layer(WrSession *session, const WrCall *call, WrScene *scene, WrError *err)
{
    const char *word = wr_call_given(call, "mask") ? wr_call_arg(call, "mask")->text : NULL;
    int index;
    if (!word) return true;
    if (!*word) {
        wr_scene_set_mask(scene, NULL, NULL, 0);
        return true;
    }
    if (session->loading) { /* its heights are used after the layers are there */
        wr_scene_set_mask(scene, word, NULL, 0);
        return true;
    }
    if (!wr_scene_mesh_source(scene)->mapped)
        return wr_fail(err,
                       "mask=%s: the mesh has no texture coordinates of its own; unwrap it in a "
                       "modelling program, or use facing= or materials=",
                       word);
    if (!wr_session_find_layer(session, word, &index, err) ||
        !hide_layer(session, index, scene, session->state.document->scene->mask_layer, true, err))
        return false;
    wr_scene_set_mask(scene, session->state.document->layers[index].name, NULL, 0);
    take_mask(session, scene);
    return true;
}

/* The remedy for a file without normals: relief of a face moves along the means with its neighbours. */
static void add_rounded(WrText *text, const WrScene *scene)
{
    const WrTrianglesReport *file = &wr_scene_mesh_source(scene)->report;
    if (scene->projection.crease_deg >= WR_CREASE_NONE && file->no_normal + file->bad_normal > 0)
        wr_message_addf(text, "; the file has no normals, so edges look rounded: crease=30 "
                              "computes normals that keep edges above 30 degrees sharp");
}

static bool note_projection(WrSession *session, const WrScene *scene, WrError *err)
{
    const WrProjection *is = &scene->projection;
    const WrTriangles *file = wr_scene_mesh_source(scene);
    WrTextureSeams seams;
    WrText text = { 0 };
    double radius;
    if (is->kind == WR_PROJECTION_UV) {
        note_tiles(session, scene);
        return true;
    }
    if (!wr_triangles_seams(scene->triangles, &seams, err)) return false;
    wr_text_addf(&text, "projection=%s: %d triangle%s", wr_projection_names[is->kind],
                 (int)scene->triangles->triangle_count,
                 scene->triangles->triangle_count == 1 ? "" : "s");
    if (is->unit == WR_UNIT_UNKNOWN)
        wr_text_add(&text,
                    "; the file's numbers are taken as millimetres: unit= states another unit");
    if (is->kind >= WR_PROJECTION_CYLINDRICAL) {
        const int round = wr_projection_round(file, is, &radius);
        wr_text_addf(&text, "; cells round: %d, at a radius of %.4g mm", round, radius);
    }
    if (seams.edges > 0)
        wr_text_addf(&text,
                     "; edges that the table does not run on across: %d, the longest run of them "
                     "%.4g long, at %.7g,%.7g,%.7g",
                     (int)seams.edges, seams.length, seams.at.x + is->origin[0],
                     seams.at.y + is->origin[1], seams.at.z + is->origin[2]);
    if (is->kind == WR_PROJECTION_BOX) add_rounded(&text, scene);
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&text);
    return true;
}

/* Triangles that have relief at their centres. */
static void note_masks(WrSession *session, const WrScene *scene)
{
    const WrProjection *is = &scene->projection;
    const WrTriangles *mesh = scene->triangles;
    WrReliefTap taps[WR_RELIEF_TAPS];
    int32_t count = 0;
    if (is->facing == WR_FACING_ANY && !*is->materials && !scene->mask) return;
    for (int32_t i = 0; i < mesh->triangle_count; i++)
        count += wr_relief_taps(mesh, i, 1.0 / 3, 1.0 / 3, taps) > 0;
    WrText text = { 0 };
    wr_message_addf(&text, "masks leave relief on %d of %d triangles", (int)count,
                    (int)mesh->triangle_count);
    if (is->kind != WR_PROJECTION_BOX) add_rounded(&text, scene);
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* Apply the projection of the call to the scene's mesh. */
static bool run_projection(WrSession *session, const WrCall *call, WrScene *scene, WrError *err)
{
    WrProjection projection = scene->projection;
    if (scene->shape.kind != WR_SURFACE_mesh) return true;
    if (!take_projection(call, &projection, err) || !take_mask_layer(session, call, scene, err) ||
        !wr_scene_project(scene, &projection, err))
        return false;
    if (session->loading) return true;
    note_masks(session, scene);
    return note_projection(session, scene, err);
}

static WrTriangles *find_mesh(WrSession *session, WrCall *call, const WrShape *shape,
                              const char *name, WrMeshFacts *facts, WrError *err)
{
    if (session->loading) {
        const int object = session->state.document->scene->chosen;
        if (session->embedded_mesh)
            return wr_scene_mesh_from_image(session->embedded_mesh, object, err);
        wr_fail(err, "the document refers to the mesh %s but does not contain it", name);
        return NULL;
    }
    char *path = wr_session_input_path(session, name);
    WrTriangles *mesh = NULL;
    char hex[65];
    /* The checksum is computed on another thread while the file is parsed. It is compared first: a changed file shall be
       reported as such, not by the parse error that it may cause. glTF consists of several files, whose joint checksum is
       computed by wr_input_sha256. */
    WrSha256Work *hash = wr_sha256_begin(path);
    mesh = read_held(session, call, shape, path, facts, err);
    WrError why = { "" };
    char ending[16];
    const bool parts = strcmp(wr_path_ending(path, ending), "gltf") == 0;
    if (!wr_sha256_end(hash, hex, &why) || (parts && !wr_input_sha256(path, hex, &why)) ||
        !wr_call_check_sha256(call, "sha256", path, hex,
                              &why)) { /* the checksum is compared first */
        wr_triangles_free(mesh);
        mesh = NULL;
        wr_fail(err, "%s", wr_error_message(&why));
    }
    const bool own = shape->kind != WR_SURFACE_mesh || !wr_call_given(call, "projection") ||
                     wr_call_choice(call, "projection") == WR_PROJECTION_UV;
    if (mesh)
        note_held(session, shape->kind, path, mesh, facts, own,
                  shape->kind == WR_SURFACE_mesh ? udim_of(call) : 0);
    wr_free(path);
    return mesh;
}

/* Reuse the patch set of the active object with another table, since its file may have moved. */
static bool run_table(const WrSession *session, const WrCall *call, WrScene *scene, WrError *err)
{
    const WrScene *before = session->state.document->scene;
    const WrPatches *set = before->triangles ? before->triangles->patches : NULL;
    if (!set || before->shape.kind != WR_SURFACE_patches)
        return wr_fail(err, "table= needs file=: the object has no patches yet");
    float(*points)[48] = wr_alloc((size_t)set->count, sizeof *points);
    for (int32_t i = 0; i < set->count; i++)
        memcpy(points[i], set->patch[i].point, sizeof points[i]);
    WrTriangles *made = wr_patches_new((const float(*)[48])points, set->count,
                                       (WrPatchTable)wr_call_choice(call, "table"), err);
    wr_free(points);
    if (made)
        wr_scene_set_triangles(scene, made, before->triangles_path,
                               *before->triangles_sha256 ? before->triangles_sha256 : NULL);
    return made != NULL;
}

/* The mesh part of `surface mesh`: reading its file into the scene; printing, with paths or only by content if the
 * checksum is known; its two argument rows. */
static bool run_mesh(WrSession *session, WrCall *call, WrScene *scene, WrError *err)
{
    if (scene->shape.kind == WR_SURFACE_terrain && terrain_names_layer(call))
        return terrain_take_layer(session, call, scene, err);
    if (!wr_call_given(call, "file")) {
        if (wr_call_given(call, "sha256")) return wr_fail(err, "sha256= needs file=");
        if (scene->shape.kind == WR_SURFACE_mesh && names_projection(call))
            return reuse_mesh(session, scene, err) && run_projection(session, call, scene, err);
        const bool table = scene->shape.kind == WR_SURFACE_patches && wr_call_given(call, "table");
        return !table || run_table(session, call, scene, err);
    }
    const char *name = wr_call_arg(call, "file")->text;
    WrMeshFacts facts = { .unit = WR_UNIT_UNKNOWN };
    WrTriangles *mesh = find_mesh(session, call, &scene->shape, name, &facts, err);
    if (!mesh) return false;
    wr_scene_set_triangles(scene, mesh, name, wr_call_arg(call, "sha256")->text);
    if (facts.unit != WR_UNIT_UNKNOWN) scene->projection.unit = facts.unit;
    memcpy(scene->projection.origin, facts.origin, sizeof facts.origin);
    return run_projection(session, call, scene, err);
}

static void add_numbers(WrText *text, const char *name, const double *numbers, int count,
                        const char *unit)
{
    wr_text_addf(text, " %s=", name);
    for (int i = 0; i < count; i++) {
        if (i > 0) wr_text_add(text, ",");
        wr_text_add_number(text, numbers[i]);
        wr_text_add(text, unit);
    }
}

static void print_masks(const WrScene *scene, WrText *text)
{
    const WrProjection *is = &scene->projection;
    if (is->facing != WR_FACING_ANY) {
        wr_text_addf(text, " facing=%s", wr_facing_names[is->facing]);
        add_numbers(text, "angle", &is->facing_deg, 1, "");
        if (is->facing_soft_deg > 0) add_numbers(text, "soft", &is->facing_soft_deg, 1, "");
    }
    if (*is->materials) {
        wr_text_add(text, " materials=");
        wr_text_add_word(text, is->materials);
    }
    if (!scene->mask_layer) return;
    wr_text_add(text, " mask=");
    wr_text_add_word(text, scene->mask_layer);
}

static void print_projection(const WrScene *scene, WrText *text)
{
    const WrProjection *is = &scene->projection;
    if (!wr_scene_projected(scene)) return;
    if (is->kind != WR_PROJECTION_UV) {
        wr_text_addf(text, " projection=%s", wr_projection_names[is->kind]);
        add_numbers(text, "cell", is->cell, is->cell[0] == is->cell[1] ? 1 : 2, "mm");
        if (is->blend > 0) add_numbers(text, "blend", &is->blend, 1, "");
    }
    if (is->udim) wr_text_addf(text, " udim=%d", is->udim);
    if (is->turn_deg[0] != 0 || is->turn_deg[1] != 0 || is->turn_deg[2] != 0)
        add_numbers(text, "turn", is->turn_deg, 3, "");
    if (is->placed) add_numbers(text, "at", is->at, 3, "");
    if (is->unit != WR_UNIT_UNKNOWN)
        wr_text_addf(text, " unit=%s", wr_length_units[is->unit - WR_UNIT_MM]);
    if (is->origin[0] != 0 || is->origin[1] != 0 || is->origin[2] != 0)
        add_numbers(text, "origin", is->origin, 3, "");
    if (is->crease_deg < WR_CREASE_NONE) add_numbers(text, "crease", &is->crease_deg, 1, "");
    print_masks(scene, text);
}

static void print_mesh(const WrScene *scene, bool content, WrText *text)
{
    if (scene->form_layer) {
        wr_text_add(text, " layer=");
        wr_text_add_word(text, scene->form_layer);
        return;
    }
    if (!scene->triangles) return;
    if (!content || !*scene->triangles_sha256) {
        wr_text_add(text, " file=");
        wr_text_add_word(text, scene->triangles_path);
    }
    if (scene->shape.kind == WR_SURFACE_patches && scene->triangles->patches)
        wr_text_addf(text, " table=%s", wr_patch_tables[scene->triangles->patches->table]);
    if (*scene->triangles_sha256) wr_text_addf(text, " sha256=%s", scene->triangles_sha256);
    print_projection(scene, text);
}

static const char *table_name(int i)
{
    return i < WR_PATCH_TABLES ? wr_patch_tables[i] : NULL;
}

#define TRIPLE(name_, shape_, low_, high_)                                                         \
    .name = name_, .type = WR_ARG_TUPLE, .components = 3, .shape = shape_, .low = low_,            \
    .high = high_
static const WrArgSpec projection_args[] = {
    { .name = "projection",
      .type = WR_ARG_CHOICE,
      .words = wr_projection_names,
      .fallback_text = "uv",
      .help = "texture coordinates. uv: the file's own; planar: along the projection's z; box: "
              "along x, y or z, chosen for each face by its normal; cylindrical: about z; "
              "spherical: about a point" },
    { .name = "cell",
      .type = WR_ARG_TUPLE,
      .components = 2,
      .counts = TUPLE_OF(1) | TUPLE_OF(2),
      .shape = "W[,H]",
      .above = true,
      .high = 1e9,
      .length = true,
      .unit = "mm",
      .fallback = wr_projection_default.cell,
      .help = "size of the table on the mesh, divided by replicate; around an axis the width is "
              "adjusted so that a whole number fits" },
    { TRIPLE("turn", "X,Y,Z", -360, 360), .unit = "degrees",
      .fallback = wr_projection_default.turn_deg,
      .help = "rotation of the projection about the mesh's x, then y, then z axis" },
    { TRIPLE("at", "X,Y,Z", -1e9, 1e9),
      .help = "origin of the projection, in the file's unit; left out, the centre of the mesh" },
    { .name = "udim",
      .also = "tile",
      .type = WR_ARG_TEXT,
      .shape = "all|NUMBER",
      .check = check_udim,
      .help = "UDIM tile that shows the table, from 1001; other tiles have no relief. all, or left "
              "out: every tile shows the table" },
    { .name = "unit",
      .type = WR_ARG_CHOICE,
      .words = wr_length_units,
      .help = "unit of the file's coordinates; left out, m for glTF, the unit in the file for 3MF, "
              "else mm" },
    { TRIPLE("origin", "X,Y,Z", -1e30, 1e30), .fallback = wr_projection_default.origin,
      .help = "origin of the mesh in the file's coordinates, to which exported solids are moved "
              "back; left out, 0,0,0, or for a mesh far from the file's origin the nearest corner "
              "of its box" },
    { .name = "crease",
      .type = WR_ARG_NUMBER,
      .high = WR_CREASE_NONE,
      .fallback = &wr_projection_default.crease_deg,
      .unit = "degrees",
      .help = "crease angle: below 180, normals are computed again, smooth except where faces meet "
              "at a larger angle; 180: the file's normals" },
    { .name = "blend",
      .type = WR_ARG_NUMBER,
      .high = 1,
      .fallback = &wr_projection_default.blend,
      .help = "for box projection: width of the zone in which the heights of two or three planes "
              "are blended, so that the relief is continuous across their borders; 0: each "
              "triangle uses one plane" },
    { .name = "facing",
      .type = WR_ARG_CHOICE,
      .words = wr_facing_names,
      .fallback_text = "any",
      .help = "relief only where the mesh faces along this axis of the projection; out and in: "
              "away from and towards its z axis, or its centre if spherical" },
    { .name = "angle",
      .type = WR_ARG_NUMBER,
      .high = 180,
      .fallback = &wr_projection_default.facing_deg,
      .unit = "degrees",
      .help = "for facing=: largest angle between normal and direction" },
    { .name = "soft",
      .type = WR_ARG_NUMBER,
      .high = 180,
      .fallback = &wr_projection_default.facing_soft_deg,
      .unit = "degrees",
      .help = "for facing=: width of the fade beyond the angle; 0: no fade, each triangle is "
              "inside or outside" },
    { .name = "materials",
      .type = WR_ARG_TEXT,
      .shape = "NAME,...",
      .may_be_empty = true,
      .help = "relief only on these materials or parts of the file, by name, or by number from 1; "
              "\"\": on all" },
    { .name = "mask",
      .type = WR_ARG_TEXT,
      .shape = "LAYER",
      .may_be_empty = true,
      .help = "name or number of a layer that scales the relief: none where it is 0 or less, full "
              "where it is 1 or more. It uses the mesh's own (u,v), whatever the projection, and "
              "is hidden as a bump; \"\": no mask" },
};

static void form_mesh(WrSurfaceKind kind, WrArgSpec *args)
{
    args[0] =
        (WrArgSpec){ .name = "file",
                     .type = WR_ARG_PATH,
                     .help = "the mesh, in its own unit and axes; it is saved in the document" };
    args[1] = (WrArgSpec){ .name = "sha256",
                           .type = WR_ARG_SHA256,
                           .help = "SHA-256 of the file; a file with other content is an error" };
    if (kind == WR_SURFACE_mesh) memcpy(args + 2, projection_args, sizeof projection_args);
    if (kind == WR_SURFACE_terrain) form_terrain(args);
    if (kind == WR_SURFACE_patches)
        args[2] = (WrArgSpec){
            .name = "table",
            .type = WR_ARG_CHOICE,
            .choice = table_name,
            .fallback_text = "each",
            .help = "each: each patch shows the whole table by its own u and v; joined: rotated so "
                    "that it continues across shared edges; split: each patch shows its part of "
                    "one table, on which the set is unfolded; own: each patch shows a cell of its "
                    "own in a grid, with a margin that keeps out other cells' heights. Without a "
                    "file, it applies to the present set"
        };
}

/* ---- Surface and bump commands: surface, rotate, analytic, bump, replicate ---- */

static void print_shape(const WrScene *scene, bool content, WrText *text)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    const double *value = scene->shape.value;
    wr_text_addf(text, "surface %s", info->name);
    for (int k = 0; k < WR_SURFACE_PARAMS && info->params[k].name; k++) {
        int components = info->params[k].components, point = components <= 3 ? components : 3;
        wr_text_addf(text, " %s=", info->params[k].name);
        for (int i = 0; i < components; i++) {
            if (i > 0) wr_text_add(text, i % point == 0 ? ";" : ",");
            wr_text_add_number(text, *value++);
        }
    }
    for (int k = 0; k < WR_SURFACE_TEXTS && info->texts[k].name; k++) {
        wr_text_addf(text, " %s=", info->texts[k].name);
        wr_text_add_word(text, scene->shape.data->text[k]);
    }
    if (info->held) print_mesh(scene, content, text);
    wr_text_add(text, "\n");
}

static void print_surface(const WrScene *scene, WrText *text)
{
    print_shape(scene, false, text);
}

static void print_surface_content(const WrScene *scene, WrText *text)
{
    print_shape(scene, true, text);
}

void wr_print_rotate(const WrScene *scene, WrText *text)
{
    if (!scene->posed) return;
    wr_text_add(text, "rotate ");
    wr_scene_print_value(&wr_scene_params[WR_SCENE_PARAM_ROTATE], scene, text);
    wr_text_add(text, "\n");
}

static void print_analytic(const WrScene *scene, WrText *text)
{
    const WrAnalytic *analytic = &scene->analytic;
    if (analytic->kind == WR_ANALYTIC_OFF) return;
    bool fourier = analytic->kind == WR_ANALYTIC_FOURIER;
    wr_text_add(text, fourier ? "analytic fourier terms=" : "analytic poly c=");
    for (int i = 0; i < analytic->count; i++) {
        const WrAnalyticTerm *term = &analytic->terms[i];
        wr_text_addf(text, "%s%d,%d,", i ? ";" : "", term->i, term->j);
        wr_text_add_number(text, term->a);
        if (!fourier || (term->phase_u_deg == 0 && term->phase_v_deg == 0)) continue;
        wr_text_add(text, ",");
        wr_text_add_number(text, term->phase_u_deg);
        wr_text_add(text, ",");
        wr_text_add_number(text, term->phase_v_deg);
    }
    wr_text_add(text, "\n");
}

static void print_bump(const WrScene *scene, WrText *text)
{
    wr_text_addf(text, "bump mode=%s scheme=%s", wr_bumps[scene->bump].name,
                 wr_schemes[scene->scheme].name);
    wr_scene_print_params("bump", NULL, scene, text);
    wr_text_add(text, "\n");
}

static void print_replicate(const WrScene *scene, WrText *text)
{
    wr_text_add(text, "replicate ");
    wr_scene_print_value(&wr_scene_params[WR_SCENE_PARAM_REPLICATE], scene, text);
    wr_text_add(text, "\n");
}

/* HC41: on a closed surface a replication that is not an integer leaves a seam. */
static void warn_seam(WrSession *session, const WrScene *scene)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    double u = scene->replicate_u, v = scene->replicate_v;
    if ((info->closed_u && u != floor(u)) || (info->closed_v && v != floor(v)))
        wr_session_note(
            session, "replicate %g,%g leaves a seam on the %s, which is closed: use whole numbers",
            u, v, info->name);
    if (!scene->triangles || scene->projection.kind < WR_PROJECTION_CYLINDRICAL) return;
    double radius;
    const int round = wr_projection_round(scene->mesh_source, &scene->projection, &radius);
    if (round * u != floor(round * u))
        wr_session_note(session,
                        "replicate %g,%g leaves a seam on the mesh, which has %d cells around it: "
                        "use whole numbers",
                        u, v, round);
}

/* Compile a surface's texts; *made stays NULL without texts. */
static bool make_data(const WrCall *call, WrSurfaceKind kind, WrSurfaceData **made, WrError *err)
{
    const WrSurfaceInfo *info = wr_surfaces[kind];
    const char *text[WR_SURFACE_TEXTS] = { NULL };
    if (!info->make) return true;
    for (int k = 0; k < WR_SURFACE_TEXTS && info->texts[k].name; k++)
        if (wr_call_given(call, info->texts[k].name))
            text[k] = wr_call_arg(call, info->texts[k].name)->text;
    *made = wr_surface_data_make(kind, text, err);
    return *made != NULL;
}

static bool run_surface(WrSession *session, WrCall *call, WrError *err)
{
    WrSurfaceData *data = NULL;
    WrShape shape = { .kind = (WrSurfaceKind)call->form };
    wr_shape_default(shape.kind, &shape);
    for (int i = 0; i < call->count; i++) {
        if (!call->args[i].given) continue;
        int offset = wr_surface_param_offset(shape.kind, call->specs[i].name);
        if (offset < 0) continue; /* a text or a mesh file, not a number */
        memcpy(shape.value + offset, call->args[i].numbers,
               (size_t)call->args[i].rows * (size_t)wr_arg_width(&call->specs[i]) * sizeof(double));
    }
    if (!wr_shape_check(&shape, err) || !make_data(call, shape.kind, &data, err)) return false;
    if (data) wr_shape_borrow_data(&shape, data);
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_set_triangles(scene, NULL, NULL, NULL);
    wr_scene_set_mask(scene, NULL, NULL, 0);
    wr_free(scene->form_layer);
    scene->form_layer = NULL;
    wr_scene_set_shape(scene, &shape);
    wr_surface_data_free(data);
    if (wr_surfaces[shape.kind]->held && !run_mesh(session, call, scene, err)) {
        wr_scene_free(scene);
        return false;
    }
    warn_seam(session, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

/* The edit that turns one of several objects; false where the call has neither or both. */
static bool rotate_as_edit(const WrCall *call, WrText *text)
{
    const bool own = wr_call_given(call, "pose");
    const WrArg *turn = wr_call_arg(call, "x,y,z");
    if (own == turn->given) return false;
    wr_text_add(text, "object set turn=");
    if (own) wr_text_add(text, WR_OWN_TURN);
    for (int i = 0; turn->given && i < 3; i++) {
        if (i > 0) wr_text_add(text, ",");
        wr_text_add_number(text, turn->numbers[i]);
    }
    return true;
}

static bool run_rotate(WrSession *session, WrCall *call, WrError *err)
{
    bool own = wr_call_given(call, "pose"), turned = wr_call_given(call, "x,y,z");
    if (own == turned) return wr_fail(err, "give x,y,z or pose=own, not both");
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    scene->posed = turned;
    scene->rotate_deg = (WrVec3){ 0 };
    wr_scene_take(call, NULL, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

enum { FORM_POLY, FORM_FOURIER, FORM_OFF, ANALYTIC_FORMS };

static bool run_analytic(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WR_ROWS(forms);
    static const struct {
        const char *list;
        WrAnalyticKind kind;
    } forms[] = { [WR_ROW(FORM_POLY)] = { "c", WR_ANALYTIC_POLY },
                  [WR_ROW(FORM_FOURIER)] = { "terms", WR_ANALYTIC_FOURIER },
                  [WR_ROW(FORM_OFF)] = { NULL, WR_ANALYTIC_OFF } };
    WR_ROWS_END(forms, ANALYTIC_FORMS);
    const int which = call->form;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_free(scene->analytic.terms);
    scene->analytic = (WrAnalytic){ .kind = forms[which].kind };
    if (forms[which].list) {
        const WrArg *list = wr_call_arg(call, forms[which].list);
        /* Rows of the list have a fixed stride, also where the optional phases are omitted (0). */
        size_t width = forms[which].kind == WR_ANALYTIC_POLY ? 3 : 5;
        scene->analytic.terms = wr_alloc((size_t)list->rows, sizeof *scene->analytic.terms);
        scene->analytic.count = list->rows;
        for (int i = 0; i < list->rows; i++) {
            const double *row = list->numbers + width * (size_t)i;
            scene->analytic.terms[i] =
                (WrAnalyticTerm){ (int)row[0], (int)row[1], row[2], width > 3 ? row[3] : 0,
                                  width > 3 ? row[4] : 0 };
        }
    }
    wr_session_replace_scene(session, scene);
    return true;
}

static bool run_bump(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    if (wr_call_given(call, "mode")) scene->bump = (WrBumpMode)wr_call_choice(call, "mode");
    if (wr_call_given(call, "scheme")) scene->scheme = (WrScheme)wr_call_choice(call, "scheme");
    wr_scene_take(call, NULL, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool run_replicate(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_take(call, NULL, scene);
    warn_seam(session, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static const char *bump_name(int i)
{
    return i < WR_BUMP_COUNT ? wr_bumps[i].name : NULL;
}

static const char *scheme_name(int i)
{
    return i < WR_SCHEME_COUNT ? wr_schemes[i].name : NULL;
}

static const WrComponent poly_parts[] = { { "i", 0, 64, true },
                                          { "j", 0, 64, true },
                                          { "a", -1e30, 1e30, false } };

static const WrComponent fourier_parts[] = {
    { "k", -16384, 16384, true },    { "l", -16384, 16384, true },    { "a", -1e30, 1e30, false },
    { "phase_u", -1e9, 1e9, false }, { "phase_v", -1e9, 1e9, false },
};

WR_ROWS(analytic_forms);
static const WrForm analytic_forms[] = {
    [WR_ROW(FORM_POLY)] = { .name = "poly",
                            .help = "sum of a u^i v^j",
                            .args = { { .name = "c",
                                        .type = WR_ARG_LIST,
                                        .required = true,
                                        .components = 3,
                                        .parts = poly_parts,
                                        .rows_low = 1,
                                        .rows_high = WR_TERMS_MAX,
                                        .shape = "i,j,a;...",
                                        .help = "the terms" } } },
    [WR_ROW(FORM_FOURIER)] = { .name = "fourier",
                               .help = "sum of a cos(2 pi k u + phase_u) cos(2 pi l v + phase_v), "
                                       "phases in degrees",
                               .args = { { .name = "terms",
                                           .type = WR_ARG_LIST,
                                           .required = true,
                                           .components = 5,
                                           .parts = fourier_parts,
                                           .counts = TUPLE_OF(3) | TUPLE_OF(5),
                                           .rows_low = 1,
                                           .rows_high = WR_TERMS_MAX,
                                           .shape = "k,l,a[,phase_u,phase_v];...",
                                           .help = "the terms" } } },
    [WR_ROW(FORM_OFF)] = { .name = "off", .help = "use the table again" },
};
WR_ROWS_END(analytic_forms, ANALYTIC_FORMS);

WR_FORMS(form_analytic, analytic_forms)

/* A surface's parameters as arguments; numbers with 3n components are lists of n points. */
static bool form_surface(int i, WrForm *out)
{
    if (i >= WR_SURFACE_COUNT) return false;
    const WrSurfaceInfo *info = wr_surfaces[i];
    *out = (WrForm){ .name = info->name, .help = info->help };
    int count = 0;
    for (int k = 0; k < WR_SURFACE_PARAMS && info->params[k].name; k++) {
        const WrSurfaceParam *p = &info->params[k];
        WrArgSpec spec = { .name = p->name,
                           .low = p->low,
                           .high = p->high,
                           .help = p->help,
                           .fallback = p->fallback };
        spec.type = p->components == 1   ? WR_ARG_NUMBER
                    : p->components <= 3 ? WR_ARG_TUPLE
                                         : WR_ARG_LIST;
        spec.components = p->components <= 3 ? p->components : 3;
        if (spec.type == WR_ARG_LIST) {
            spec.rows_low = spec.rows_high = spec.fallback_rows = p->components / 3;
            spec.shape = "x,y,z;...";
        }
        out->args[count++] = spec;
    }
    for (int k = 0; k < WR_SURFACE_TEXTS && info->texts[k].name; k++)
        out->args[count++] = (WrArgSpec){ .name = info->texts[k].name,
                                          .type = WR_ARG_TEXT,
                                          .shape = info->texts[k].shape,
                                          .fallback_text = info->texts[k].fallback,
                                          .help = info->texts[k].help };
    if (info->held) form_mesh((WrSurfaceKind)i, out->args + count);
    return true;
}

static bool row_bump(WrForm *out)
{
    *out = (WrForm){ .args = { { .name = "mode",
                                 .type = WR_ARG_CHOICE,
                                 .choice = bump_name,
                                 .help = "normal formula. none: unchanged; blinn: N + D of the "
                                         "paper; invariant: independent of the surface's scale; "
                                         "exact: the true normal of the displaced surface" },
                               { .name = "scheme",
                                 .type = WR_ARG_CHOICE,
                                 .choice = scheme_name,
                                 .help = "interpolation scheme, by which F is differentiated" } } };
    return wr_scene_args("bump", NULL, out->args + 2) > 0;
}

static bool row_replicate(WrForm *out)
{
    *out = (WrForm){ 0 };
    return wr_scene_args("replicate", NULL, out->args) > 0;
}

static const char *pose_word(int i)
{
    return i == 0 ? "own" : NULL;
}

static bool row_rotate(WrForm *out)
{
    *out = (WrForm){ 0 };
    const int count = wr_scene_args("rotate", NULL, out->args);
    out->args[count] = (WrArgSpec){ .name = "pose",
                                    .type = WR_ARG_CHOICE,
                                    .choice = pose_word,
                                    .help = "instead of angles: the surface's default pose" };
    return true;
}

/* ---- the rows ---- */

const WrCommand wr_command_surface = {
    .name = "surface",
    .kind = WR_CLASS_SCENE,
    .form_word = "NAME",
    .form = form_surface,
    .run = run_surface,
    .print = print_surface,
    .print_content = print_surface_content,
    .of_object = true,
    .help = "choose the surface of the object",
    .details = "Arguments that are left out take their defaults. `surface mesh` without a file is "
               "a square of two triangles, or with settings of the projection the present mesh, "
               "whose other settings stay. The size of the table on a mesh is its cell=; the "
               "command `cell` is for exported maps. On a cube, faces=6 gives each face its own "
               "cell of the table, in three columns and two rows from the lower left (front, "
               "right, back; left, top, bottom), with a margin of 1/32. In cells of 64 texels and "
               "more no filter, and no scheme except bspline-fit, reads another face's heights.",
    .example = "surface torus R=1 r=0.35"
};

const WrCommand wr_command_rotate = {
    .name = "rotate",
    .kind = WR_CLASS_VIEW,
    .row = row_rotate,
    .run = run_rotate,
    .print = wr_print_rotate,
    .in_object = true,
    .of_several = rotate_as_edit,
    .of_object = true,
    .help = "rotate the object",
    .details =
        "Replaces the surface's default pose; the rotation is about the object's centre. It is a "
        "view, not an edit: undo does not change it, `view back` goes back. With several objects, "
        "of which a ground is one, it rotates the active one, and is an edit: `object set turn=`.",
    .example = "rotate -90,0,30"
};

const WrCommand wr_command_analytic = {
    .name = "analytic",
    .kind = WR_CLASS_SCENE,
    .form_word = "KIND",
    .form = form_analytic,
    .run = run_analytic,
    .print = print_analytic,
    .of_object = true,
    .help = "use a formula in place of the table",
    .details =
        "It is evaluated at (ru u, rv v), reduced to [0,1) like a table, with exact derivatives.",
    .example = "analytic fourier terms=3,0,0.5;0,5,0.25,90,0"
};

const WrCommand wr_command_bump = { .name = "bump",
                                    .kind = WR_CLASS_SCENE,
                                    .row = row_bump,
                                    .run = run_bump,
                                    .print = print_bump,
                                    .of_object = true,
                                    .help = "set the bump mapping of the object",
                                    .details = "Only given arguments change.",
                                    .example = "bump mode=exact height=0.05" };

const WrCommand wr_command_replicate = { .name = "replicate",
                                         .kind = WR_CLASS_SCENE,
                                         .row = row_replicate,
                                         .run = run_replicate,
                                         .print = print_replicate,
                                         .of_object = true,
                                         .help = "set how often the table repeats over the surface",
                                         .example = "replicate 6,3" };

/* ---- The command cell: physical size of the unit cell, used by exports, solids and labels ---- */

static void print_cell(const WrScene *scene, WrText *text)
{
    if (!wr_cell_size_given(&scene->cell)) return;
    wr_text_add(text, "cell ");
    wr_scene_print_value(&wr_scene_params[WR_SCENE_PARAM_CELL_SIZE], scene, text);
    wr_scene_print_params("cell", NULL, scene, text);
    wr_text_add(text, "\n");
}

static bool run_cell(WrSession *session, WrCall *call, WrError *err)
{
    (void)err;
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_take(call, NULL, scene);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool row_cell(WrForm *out)
{
    *out = (WrForm){ 0 };
    return wr_scene_args("cell", NULL, out->args) > 0;
}

const WrCommand wr_command_cell = {
    .name = "cell",
    .kind = WR_CLASS_SCENE,
    .row = row_cell,
    .run = run_cell,
    .print = print_cell,
    .help = "set the size of the exported cell",
    .details =
        "Exported slopes and normals use this size, and so do solids of a plane; files store it in "
        "their metadata. Pictures of the scene do not depend on it. In millimetres, F = 1 has the "
        "height height=; in scene units, that of `bump height=`. Only given arguments change.",
    .example = "cell 120,80 mm=on height=2.5"
};

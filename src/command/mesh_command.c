/* The mesh of `surface mesh file=`: reading, notes, storage in documents. */
#include "command/session_internal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/scene_args.h"
#include "image/mesh.h"
#include "document/document.h"
#include "scene/scene.h"
#include "surface/patches.h"
#include "surface/triangles.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define OVERLAP_CELLS 512 /* cells of the overlap test along u and v */
#define OVERLAP_NOTED 0.005

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

/* Note the offset if the positions were moved to the origin. */
static void note_origin(WrSession *session, const char *path, const WrMesh *mesh)
{
    WrText text = { 0 };
    double away = 0;
    for (int k = 0; k < 3; k++) away = fmax(away, fabs(mesh->origin[k]));
    if (!(away > 0)) return;
    wr_text_addf(&text, "%s: lies far from its file's origin: ", path);
    for (int k = 0; k < 3; k++) {
        if (k > 0) wr_text_add(&text, ",");
        wr_text_add_number(&text, mesh->origin[k]);
    }
    wr_text_add(&text, " was subtracted from its points");
    if (mesh->single)
        wr_text_addf(&text,
                     "; this format is read in single precision, so that relief below %.2g "
                     "is lost: save it as PLY or OBJ",
                     away * FLT_EPSILON);
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

static WrTriangles *read_triangles(WrSession *session, const char *path, WrError *err)
{
    WrMesh mesh;
    if (!wr_mesh_read_whole(path, &mesh, err)) return NULL;
    WrTrianglePart *parts = parts_of(&mesh);
    const WrTrianglesSource source = { .points = mesh.points,
                                       .normals = mesh.normals,
                                       .uv = mesh.uv,
                                       .corners = mesh.corners,
                                       .point_count = mesh.point_count,
                                       .triangle_count = mesh.triangle_count,
                                       .parts = parts,
                                       .part_count = mesh.part_count };
    WrTriangles *made = wr_triangles_new(&source, err);
    if (made) note_origin(session, path, &mesh);
    else wr_error_prefix(err, "%s: ", path);
    wr_free(parts);
    wr_mesh_fini(&mesh);
    return made;
}

/* ---- notes ---- */

static void add_count(WrText *text, int32_t count, const char *what)
{
    if (count > 0) wr_text_addf(text, "; %d %s", (int)count, what);
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

static void add_map(WrText *text, const WrTriangles *mesh)
{
    int32_t outside;
    if (!mesh->mapped) {
        wr_text_add(text, "; no texture coordinates: the table has no slope on it");
        return;
    }
    const double share = wr_triangles_overlap(mesh, OVERLAP_CELLS, &outside);
    if (share > OVERLAP_NOTED)
        wr_text_addf(text,
                     "; %.1f%% of its texture coordinates are met twice: paint there shows "
                     "in several places",
                     100 * share);
    add_count(text, outside, "triangles reach beyond u, v of 0..1, where the table repeats");
    add_count(text, mesh->told.no_map, "triangles without texture coordinates: no slope there");
    add_count(text, mesh->told.collinear,
              "with u, v along a line: no tangent frame, slopes are exact");
    add_count(text, mesh->told.mirrored, "mirrored");
    add_count(text, mesh->told.near_uv,
              "corners differ from another by a rounding of u, v: tangent frames part there");
}

static void note_mesh(WrSession *session, const char *path, const WrTriangles *mesh)
{
    WrText text = { 0 };
    const WrTrianglesTold *told = &mesh->told;
    wr_text_addf(&text, "%s: %d triangles", path, (int)mesh->triangle_count);
    add_parts(&text, mesh);
    wr_text_add(&text, mesh->closed ? ", closed" : ", open");
    if (told->inside_out) wr_text_add(&text, "; it was inside out and has been turned");
    add_count(&text, told->no_area, "without area were left out");
    add_count(&text, told->no_normal + told->bad_normal,
              "corners without a normal have the mean of their faces'");
    add_count(&text, told->face_normal, "corners have their face's normal");
    add_map(&text, mesh);
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
    const WrPatchesTold *told = &set->told;
    wr_text_addf(&text, "%s: %d patches in %d triangles, %s; %d shared edges", path,
                 (int)set->count, (int)mesh->triangle_count, mesh->closed ? "closed" : "open",
                 (int)told->shared);
    if (told->open > 0)
        wr_text_addf(&text, "; %d open ones in %d loops", (int)told->open, (int)told->loops);
    add_count(&text, told->collapsed, "collapsed to a point");
    add_count(&text, told->crowded, "of more than two patches");
    add_count(&text, told->turned, "patches were turned to the side of the others");
    add_count(&text, told->against, "between patches that face to different sides");
    if (told->crease_deg > 0)
        wr_text_addf(&text, "; %d creased, patches %d and %d by %.2f degrees", (int)told->creased,
                     (int)told->crease_of[0] + 1, (int)told->crease_of[1] + 1, told->crease_deg);
    if (set->table == WR_PATCH_JOINED || set->table == WR_PATCH_SPLIT)
        wr_text_addf(&text, "; the table runs on across %d of the shared edges", (int)told->joined);
    if (set->columns > 1 || set->rows > 1)
        wr_text_addf(&text, ", in cells of %d x %d", (int)set->columns, (int)set->rows);
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* ---- the command ---- */

static WrTriangles *read_held(WrSession *session, const WrCall *call, const WrShape *shape,
                              const char *path, WrError *err)
{
    if (shape->kind == WR_SURFACE_terrain) return wr_terrain_read(session, path, shape, err);
    if (shape->kind == WR_SURFACE_mesh) return read_triangles(session, path, err);
    return read_patches(path, (WrPatchTable)wr_call_choice(call, "table"), err);
}

static void note_held(WrSession *session, WrSurfaceKind kind, const char *path,
                      const WrTriangles *mesh)
{
    if (kind == WR_SURFACE_terrain) wr_terrain_note(session, path, mesh);
    else if (kind == WR_SURFACE_mesh) note_mesh(session, path, mesh);
    else note_patches(session, path, mesh);
}

static WrTriangles *find_mesh(WrSession *session, WrCall *call, const WrShape *shape,
                              const char *name, WrError *err)
{
    if (session->loading) {
        const int object = session->state.document->scene->chosen;
        if (session->embedded_mesh)
            return wr_scene_mesh_from_image(session->embedded_mesh, object, err);
        wr_fail(err, "the document names the mesh %s but does not hold it", name);
        return NULL;
    }
    char *path = wr_session_input_path(session, name);
    WrTriangles *mesh = NULL;
    char hex[65];
    WrSha256Work *hash = wr_sha256_begin(path);
    mesh = read_held(session, call, shape, path, err);
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
    if (mesh) note_held(session, shape->kind, path, mesh);
    wr_free(path);
    return mesh;
}

/* Reuse the patch set of the active object with another table, since its file may have moved. */
static bool run_table(const WrSession *session, const WrCall *call, WrScene *scene, WrError *err)
{
    const WrScene *before = session->state.document->scene;
    const WrPatches *set = before->triangles ? before->triangles->patches : NULL;
    if (!set || before->shape.kind != WR_SURFACE_patches)
        return wr_fail(err, "table= belongs to a file=: the object has no patches yet");
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

bool wr_run_mesh(WrSession *session, WrCall *call, WrScene *scene, WrError *err)
{
    if (scene->shape.kind == WR_SURFACE_terrain && wr_terrain_names_layer(call))
        return wr_terrain_take_layer(session, call, scene, err);
    if (!wr_call_given(call, "file")) {
        if (wr_call_given(call, "sha256")) return wr_fail(err, "sha256= belongs to a file=");
        const bool table = scene->shape.kind == WR_SURFACE_patches && wr_call_given(call, "table");
        return !table || run_table(session, call, scene, err);
    }
    const char *name = wr_call_arg(call, "file")->text;
    WrTriangles *mesh = find_mesh(session, call, &scene->shape, name, err);
    if (!mesh) return false;
    wr_scene_set_triangles(scene, mesh, name, wr_call_arg(call, "sha256")->text);
    return true;
}

void wr_print_mesh(const WrScene *scene, bool content, WrText *text)
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
}

static const char *table_name(int i)
{
    return i < WR_PATCH_TABLES ? wr_patch_tables[i] : NULL;
}

void wr_form_mesh(WrSurfaceKind kind, WrArgSpec *args)
{
    args[0] =
        (WrArgSpec){ .name = "file",
                     .type = WR_ARG_PATH,
                     .help =
                         "the mesh, in its own unit and axes; it is saved inside the document" };
    args[1] = (WrArgSpec){ .name = "sha256",
                           .type = WR_ARG_SHA256,
                           .help = "of the file: another content is then an error" };
    if (kind == WR_SURFACE_terrain) wr_form_terrain(args);
    if (kind == WR_SURFACE_patches)
        args[2] =
            (WrArgSpec){ .name = "table",
                         .type = WR_ARG_CHOICE,
                         .choice = table_name,
                         .fallback_text = "each",
                         .help = "each patch has the whole table by its own u and v; or "
                                 "turned so that it runs on across shared edges; or a cell "
                                 "of one table, on which the set is unfolded; or a cell of its "
                                 "own, in rows, within a margin that keeps others' heights "
                                 "out. Without a file: of the set that is there" };
}

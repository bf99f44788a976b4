/* The commands bake and bake-tiles: quantities of a detailed mesh file, as a layer or a picture of the active object, or as
   files of all UDIM tiles of its mesh. */
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/message.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/args.h"
#include "command/commands.h"
#include "command/session_internal.h"
#include "document/document.h"
#include "export/export.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/normal_map.h"
#include "scene/scene.h"
#include "surface/bake.h"
#include "surface/projection.h"
#include "surface/triangles.h"
#include "surface/uv_tiles.h"

#include <math.h>
#include <string.h>

#define READ 0.3 /* of the progress, for the file */

static const char *const matches[] = { "all", "name", NULL };

static bool cage_parse(const char *text, double *cage)
{
    *cage = 0;
    if (strcmp(text, "auto") == 0) return true;
    return wr_number_parse(text, strlen(text), cage) && *cage > 0 && *cage <= 1e9;
}

static bool check_cage(const void *ctx, const char *name, const char *value, WrError *err)
{
    double cage;
    (void)ctx;
    if (cage_parse(value, &cage)) return true;
    return wr_fail(err, "%s=%.40s: must be auto, or a distance above 0, up to 1e9", name, value);
}

/* Checks of the object. */
static bool check_object(const WrScene *scene, WrBakeKind kind, WrError *err)
{
    if (scene->shape.kind != WR_SURFACE_mesh || !scene->triangles)
        return wr_fail(err, "the object is a %s: baking needs a mesh (`surface mesh file=FILE`)",
                       wr_surfaces[scene->shape.kind]->name);
    if (kind != WR_BAKE_HEIGHT) return true;
    if (!(fabs(scene->height) > 0))
        return wr_fail(err,
                       "bump height=0: baked heights would be infinite; choose another height");
    if (scene->replicate_u != 1 || scene->replicate_v != 1)
        return wr_fail(err,
                       "replicate %g,%g: the table repeats on the object; bake heights at "
                       "`replicate 1,1`",
                       scene->replicate_u, scene->replicate_v);
    return true;
}

/* Checks before the file is read. */
static bool check(const WrSession *session, const WrCall *call, WrBakeKind kind, WrError *err)
{
    const WrDocument *document = session->state.document;
    const WrField *like = document->layers[0].heights;
    const double *size = wr_call_arg(call, "size")->numbers;
    if (!check_object(document->scene, kind, err)) return false;
    if (kind != WR_BAKE_HEIGHT) return true;
    if (document->layer_count >= WR_LAYERS_MAX)
        return wr_fail(err, "a document has up to %d layers", WR_LAYERS_MAX);
    if (wr_call_given(call, "size") &&
        (size[0] != wr_field_width(like) || size[1] != wr_field_height(like)))
        return wr_fail(err,
                       "size=%gx%g: heights are baked into a layer of the table's size, %dx%d; "
                       "resize the table first (`adjust resize`)",
                       size[0], size[1], wr_field_width(like), wr_field_height(like));
    return true;
}

/* ---- results ---- */

/* Distances become heights of a new layer above the active one, in the table's unit. */
static bool put_layer(WrSession *session, float *map, WrError *err)
{
    WrDocument *document = session->state.document;
    const WrField *like = document->layers[0].heights;
    const int w = wr_field_width(like), h = wr_field_height(like);
    const double by = 1 / document->scene->height;
    for (size_t i = 0; i < (size_t)w * (size_t)h; i++) map[i] = (float)((double)map[i] * by);
    WrLayer layer = wr_layer_make("baked", like);
    WrField *heights = wr_field_new(w, h, wr_field_wrap_u(like), wr_field_wrap_v(like), 0, err);
    if (!heights) {
        wr_layer_fini(&layer);
        return false;
    }
    wr_field_write(heights, 0, 0, w, h, map, (size_t)w);
    wr_field_free(layer.heights);
    wr_field_free(layer.cover);
    layer.heights = heights;
    layer.cover = NULL;
    wr_document_insert(document, document->active + 1, layer);
    document->active++;
    return true;
}

/* The picture's name is the file's; its checksum is of its own numbers, since the file holds no picture. */
static void name_picture(WrTextureSample *laid, const char *path, const WrImage *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    wr_texture_sample_fini(laid);
    laid->path = wr_strdup(path);
    wr_sha256_bytes(image->data, count * sizeof *image->data, laid->sha256);
    laid->own = true;
    laid->ru = laid->rv = 1;
}

static bool put_normals(WrSession *session, const char *path, WrImage *image, bool object,
                        WrError *err)
{
    int64_t away = 0;
    WrImage *taken = object ? wr_image_share(image) : wr_normal_map_raised(image, &away, err);
    if (!taken) return false;
    if (away)
        wr_session_note(session,
                        "%lld normals that point below the surface were clamped to the horizon",
                        (long long)away);
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    WrNormalMap *map = &scene->normals;
    wr_image_free(map->image);
    wr_texture_sample_fini(&map->laid);
    *map = (WrNormalMap){ .image = taken,
                          .channels = 3,
                          .object = object,
                          .frame = object ? WR_FRAME_AUTO : WR_FRAME_MIKK,
                          .strength = 1,
                          .combine = WR_COMBINE_REORIENTED };
    name_picture(&map->laid, path, taken);
    wr_session_replace_scene(session, scene);
    return true;
}

static bool put_picture(WrSession *session, const char *path, const WrBakeOptions *options,
                        const float *map, WrError *err)
{
    const int channels = wr_bakes[options->kind].channels;
    WrImage *image = wr_image_new(options->width, options->height, channels, err);
    bool good = image != NULL;
    if (!good) return false;
    image->type = WR_PIXEL_F32;
    memcpy(image->data, map,
           (size_t)options->width * (size_t)options->height * (size_t)channels * sizeof *map);
    if (wr_bakes[options->kind].unit) {
        good = put_normals(session, path, image, options->kind == WR_BAKE_OBJECT_NORMAL, err);
        wr_image_free(image);
        return good;
    }
    WrScene *scene = wr_scene_clone(session->state.document->scene);
    wr_scene_drop_colour(scene);
    scene->colour = image;
    name_picture(&scene->colour_laid, path, image);
    wr_session_replace_scene(session, scene);
    return true;
}

static void note_bake(WrSession *session, const char *path, const WrBakeOptions *options, int udim,
                      const WrBakeReport *report)
{
    const WrUvOverlap overlap =
        wr_triangles_overlap(session->state.document->scene->triangles, WR_UV_OVERLAP_CELLS);
    WrText text = { 0 };
    wr_message_addf(&text, "%s: %s baked into %dx%d, cage %.4g", path, wr_bakes[options->kind].name,
                    options->width, options->height, report->cage);
    if (udim) wr_message_addf(&text, ", tile %d", udim);
    if (options->kind == WR_BAKE_HEIGHT && report->low <= report->high)
        wr_message_addf(&text, ", distances %.4g to %.4g", report->low, report->high);
    wr_message_addf(&text, "; %lld texels", (long long)report->texels);
    if (report->missed)
        wr_message_addf(
            &text,
            ", %lld of which missed it (%lld hit only back faces) and were filled from neighbours",
            (long long)report->missed, (long long)report->backs);
    else wr_message_addf(&text, ", none missed");
    if (report->frameless)
        wr_message_addf(&text, "; without a tangent frame: %lld", (long long)report->frameless);
    if (overlap.share > WR_UV_OVERLAP_NOTED)
        wr_message_addf(&text,
                        "; %.1f%% of the object's texture coordinates overlap, first at u, v of "
                        "%.3g,%.3g: one of the places is baked there",
                        100 * overlap.share, overlap.at[0], overlap.at[1]);
    if (report->alone)
        wr_message_addf(&text,
                        "; parts of the object without a part of the same name in the file: %d",
                        report->alone);
    const double radius = session->state.document->scene->triangles->radius;
    if (!(options->cage > 0) && report->missed > 0 && report->cage > radius)
        wr_message_addf(&text, "; the cage exceeds the object's radius: do both meshes have the "
                               "same position, unit and up axis?");
    wr_session_note(session, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* Fails if no ray met the detailed mesh. */
static bool check_hits(const char *name, const WrBakeReport *report, WrError *err)
{
    return report->missed < report->texels ||
           wr_fail(err,
                   "%s: none of %lld rays hit a front face within the cage distance %g (%lld hit "
                   "back faces): do both meshes have the same position and unit?",
                   name, (long long)report->texels, report->cage, (long long)report->backs);
}

/* Note that all tiles of the object come into one picture. */
static void note_mixed_tiles(WrSession *session, const WrTriangles *low)
{
    WrUvTiles tiles = wr_uv_tiles(low);
    if (tiles.count > 1)
        wr_session_note(session,
                        "the mesh has %d UDIM tiles, and all are baked into one picture: `surface "
                        "mesh udim=` chooses one, `bake-tiles` writes a file for each",
                        tiles.count);
    wr_uv_tiles_fini(&tiles);
}

/* ---- the command bake ---- */

/* Relative to the same place of the file as the object's mesh, which may have been moved near the origin. */
static WrTriangles *read_high(WrSession *session, WrCall *call, const char *path, WrError *err)
{
    WrMeshFacts facts;
    const double *origin = session->state.document->scene->projection.origin;
    WrTriangles *high = wr_session_check_sha256(call, path, err)
                            ? wr_session_read_mesh(session, path, origin, &facts, err)
                            : NULL;
    if (!high) return NULL;
    WrProjection normals = wr_projection_default;
    normals.crease_deg = wr_call_number(call, "crease");
    WrTriangles *creased = wr_triangles_project(high, &normals, NULL, err);
    wr_triangles_free(high);
    return creased;
}

static WrBakeOptions options_of(const WrSession *session, const WrCall *call)
{
    const WrField *like = session->state.document->layers[0].heights;
    const double *size = wr_call_arg(call, "size")->numbers;
    const bool given = wr_call_given(call, "size");
    WrBakeOptions options = { .kind = (WrBakeKind)wr_call_choice(call, "map"),
                              .width = given ? (int)size[0] : wr_field_width(like),
                              .height = given ? (int)size[1] : wr_field_height(like),
                              .samples = (int)wr_call_number(call, "samples"),
                              .padding = (int)wr_call_number(call, "padding"),
                              .match = wr_call_choice(call, "match") == 1,
                              .udim = session->state.document->scene->projection.udim,
                              .pool = session->options.pool };
    if (wr_call_given(call, "cage")) cage_parse(wr_call_arg(call, "cage")->text, &options.cage);
    return options;
}

static bool bake(WrSession *session, const char *name, const WrTriangles *high,
                 const WrBakeOptions *options, WrError *err)
{
    WrBakeReport report;
    WrProgressPart part;
    WrTriangles *low = wr_scene_whole_mesh(session->state.document->scene, err);
    if (!low) return false;
    const WrProgress *outer = wr_progress_enter(&part, READ, 1);
    float *map = wr_bake(low, high, options, &report, err);
    wr_progress_set(outer);
    if (map && !options->udim) note_mixed_tiles(session, low);
    wr_triangles_free(low);
    if (!map) return false;
    bool good = check_hits(name, &report, err);
    if (good) note_bake(session, name, options, options->udim, &report);
    good =
        good && (options->kind == WR_BAKE_HEIGHT ? put_layer(session, map, err)
                                                 : put_picture(session, name, options, map, err));
    wr_free(map);
    return good;
}

static bool run_bake(WrSession *session, WrCall *call, WrError *err)
{
    const WrBakeOptions options = options_of(session, call);
    const char *name = wr_call_arg(call, "FILE")->text;
    if (!check(session, call, options.kind, err)) return false;
    char *path = wr_session_input_path(session, name);
    WrTriangles *high = read_high(session, call, path, err);
    const bool good = high && bake(session, name, high, &options, err);
    wr_triangles_free(high);
    wr_free(path);
    return good;
}

/* ---- the command bake-tiles ---- */

typedef struct Tiles {
    WrSession *session;
    const char *name, *out; /* of the detailed mesh; of the files, with <UDIM> */
    const WrBakeOptions *options;
    WrPixelType type;
    int numbers[WR_UDIM_COUNT], count;
    float *heights[WR_UDIM_COUNT]; /* owned; kept until their common range is known */
    int baked;
    double low, high; /* of all heights */
} Tiles;

typedef struct Rows {
    const float *map;
    size_t row; /* numbers */
    WrPixelType type;
} Rows;

static bool put_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Rows *from = ctx;
    (void)err;
    wr_image_codes(from->type, from->map + (size_t)y * from->row, (size_t)rows * from->row, out,
                   NULL);
    return true;
}

/* Normals are coded as n/2 + 1/2 and labelled, as exports of them are. */
static bool write_picture(const Tiles *tiles, const char *path, float *map, WrError *err)
{
    const WrBakeOptions *options = tiles->options;
    const WrBakeRow *kind = &wr_bakes[options->kind];
    const bool object = options->kind == WR_BAKE_OBJECT_NORMAL;
    const WrImageAttribute label[] = { { "wrinkle:kind",
                                         object ? "normal-object" : "normal-baked" },
                                       { "wrinkle:edges", "open,open" },
                                       { "wrinkle:convention", "+Y" } };
    Rows rows = { map, (size_t)options->width * (size_t)kind->channels, tiles->type };
    const WrImageOut out = { .width = options->width,
                             .height = options->height,
                             .channels = kind->channels,
                             .type = tiles->type,
                             .data = true,
                             .attributes = label,
                             .attribute_count = kind->unit ? WR_LENGTH(label) : 0,
                             .rows = put_rows,
                             .ctx = &rows };
    for (size_t i = 0; i < (size_t)options->height * rows.row && kind->unit; i++)
        map[i] = 0.5f * map[i] + 0.5f;
    return wr_image_write(path, &out, 1, err);
}

/* As `export height` of a document with these heights; codes of all tiles have one range. */
static bool write_heights(const Tiles *tiles, const char *path, const float *map, WrError *err)
{
    const WrBakeOptions *ask = tiles->options;
    WrExportOptions options = wr_export_default();
    WrField *heights = wr_field_new(ask->width, ask->height, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, err);
    if (!heights) return false;
    wr_field_write(heights, 0, 0, ask->width, ask->height, map, (size_t)ask->width);
    WrDocument *document = wr_session_new_document(tiles->session);
    wr_document_start_over(document, heights);
    if (tiles->type != WR_PIXEL_F32) {
        options.range = WR_EXPORT_RANGE_GIVEN;
        options.low = tiles->low;
        options.high = tiles->high > tiles->low ? tiles->high : tiles->low + 1;
    }
    const bool good =
        wr_export(wr_export_find("height"), document, &options, ask->pool, path, NULL, err);
    wr_document_free(document);
    return good;
}

/* Files of the heights of all tiles, after the last of them. */
static bool write_all_heights(Tiles *tiles, WrError *err)
{
    const double by = 1 / tiles->session->state.document->scene->height;
    const size_t texels = (size_t)tiles->options->width * (size_t)tiles->options->height;
    bool good = true;
    tiles->low = INFINITY, tiles->high = -INFINITY;
    for (int i = 0; i < tiles->baked; i++)
        for (size_t k = 0; k < texels; k++) {
            float *height = &tiles->heights[i][k];
            *height = (float)((double)*height * by);
            tiles->low = fmin(tiles->low, (double)*height);
            tiles->high = fmax(tiles->high, (double)*height);
        }
    for (int i = 0; i < tiles->baked && good; i++) {
        char *path = wr_udim_fill(tiles->out, tiles->numbers[i]);
        good = write_heights(tiles, path, tiles->heights[i], err);
        wr_free(path);
    }
    return good;
}

static bool take_tile(void *ctx, int udim, float *map, const WrBakeReport *report, WrError *err)
{
    Tiles *tiles = ctx;
    bool good = check_hits(tiles->name, report, err);
    if (good) note_bake(tiles->session, tiles->name, tiles->options, udim, report);
    if (good && tiles->options->kind == WR_BAKE_HEIGHT) {
        tiles->heights[tiles->baked++] = map;
        return true;
    }
    char *path = wr_udim_fill(tiles->out, udim);
    good = good && write_picture(tiles, path, map, err);
    wr_free(path);
    wr_free(map);
    return good;
}

/* The tiles of the object's mesh, and whether the files' names tell them apart. */
static bool find_tiles(Tiles *tiles, const WrTriangles *low, WrError *err)
{
    WrUvTiles found = wr_uv_tiles(low);
    tiles->count = wr_uv_tiles_numbers(&found, tiles->numbers, WR_UDIM_COUNT);
    wr_uv_tiles_fini(&found);
    if (tiles->count == 0)
        return wr_fail(err, "the mesh has no UDIM tile: its u must be 0 to 10, v 0 or more");
    if (tiles->count == 1 || wr_udim_is_pattern(tiles->out)) return true;
    return wr_fail(err, "%s: the mesh has %d tiles: the file name needs <UDIM> for their numbers",
                   tiles->out, tiles->count);
}

/* All files are replaced, or none. */
static bool bake_tiles(Tiles *tiles, const WrTriangles *low, const WrTriangles *high, WrError *err)
{
    WrProgressPart part;
    WrFileGroup *group = wr_file_group_begin();
    const WrProgress *outer = wr_progress_enter(&part, READ, 1);
    bool good = wr_bake_tiles(low, high, tiles->options, tiles->numbers, tiles->count, take_tile,
                              tiles, err);
    wr_progress_set(outer);
    good = good && (tiles->options->kind != WR_BAKE_HEIGHT || write_all_heights(tiles, err)) &&
           (!wr_progress_stopped() || wr_fail(err, "cancelled"));
    for (int i = 0; i < tiles->baked; i++) wr_free(tiles->heights[i]);
    if (good) return wr_file_group_commit(group, err);
    wr_file_group_abort(group);
    return false;
}

static bool check_out(Tiles *tiles, WrError *err)
{
    return wr_image_deepest(tiles->out, &tiles->type, err) &&
           wr_image_can_write(tiles->out, tiles->type, wr_bakes[tiles->options->kind].channels,
                              true, err);
}

static bool run_bake_tiles(WrSession *session, WrCall *call, WrError *err)
{
    const WrBakeOptions options = options_of(session, call);
    const WrScene *scene = session->state.document->scene;
    Tiles *tiles = wr_alloc(1, sizeof *tiles);
    tiles->session = session;
    tiles->name = wr_call_arg(call, "FILE")->text;
    tiles->out = wr_call_arg(call, "OUT")->text;
    tiles->options = &options;
    WrTriangles *low = check_object(scene, options.kind, err) && check_out(tiles, err)
                           ? wr_scene_whole_mesh(scene, err)
                           : NULL;
    char *path = wr_session_input_path(session, tiles->name);
    WrTriangles *high =
        low && find_tiles(tiles, low, err) ? read_high(session, call, path, err) : NULL;
    const bool good = high && bake_tiles(tiles, low, high, err);
    wr_free(path);
    wr_triangles_free(high);
    wr_triangles_free(low);
    wr_free(tiles);
    return good;
}

/* ---- arguments ---- */

static const char *map_name(int i)
{
    return i < WR_BAKE_KINDS ? wr_bakes[i].name : NULL;
}

static void map_explain(int i, WrText *text)
{
    wr_text_add(text, wr_bakes[i].help);
}

#define DETAILED                                                                                   \
    PLACE("FILE"), .type = WR_ARG_PATH,                                                            \
                   .help = "the detailed mesh, with the position and unit of the object's mesh"

static const WrArgSpec args_bake[] = {
    { DETAILED },
    { .name = "map",
      .type = WR_ARG_CHOICE,
      .choice = map_name,
      .explain = map_explain,
      .fallback_text = "height",
      .help = "map to bake" },
    { .name = "cage",
      .type = WR_ARG_TEXT,
      .shape = "auto|DISTANCE",
      .check = check_cage,
      .help = "largest distance of the detailed mesh from the object, outwards and inwards. auto, "
              "or left out: just enough for all of it" },
    { .name = "samples",
      .type = WR_ARG_NUMBER,
      .low = 1,
      .high = WR_BAKE_SAMPLES_MAX,
      .whole = true,
      .fallback = NUMBERS(1),
      .help = "rays per texel along each side; their mean is stored" },
    { .name = "size",
      .type = WR_ARG_SIZE,
      .low = 1,
      .high = WR_FIELD_MAX,
      .unit = "texels",
      .help = "size of the picture; left out, the table's" },
    { .name = "padding",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = WR_BAKE_PADDING_MAX,
      .whole = true,
      .fallback = NUMBERS(8),
      .unit = "texels",
      .help = "width of the margin added around the islands of (u,v), and into holes" },
    { .name = "crease",
      .type = WR_ARG_NUMBER,
      .high = WR_CREASE_NONE,
      .fallback = &wr_projection_default.crease_deg,
      .unit = "degrees",
      .help = "crease angle of the detailed mesh: below 180, its normals are computed again, "
              "smooth except where faces meet at a larger angle; 180: the file's normals" },
    { .name = "match",
      .type = WR_ARG_CHOICE,
      .words = matches,
      .fallback_text = "all",
      .help = "name: each part of the object meets only parts of its own name, not counting an "
              "ending _low or _high" },
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "SHA-256 of the file; a file with other content is an error" },
    { 0 }
};

const WrCommand wr_command_bake = {
    .name = "bake",
    .kind = WR_CLASS_EDIT,
    .args = args_bake,
    .run = run_bake,
    .help = "bake relief and other maps of a detailed mesh for the object's mesh",
    .details = "For each texel, a ray starts outside the object at the cage distance along the "
               "interpolated normal, and runs inwards to the first front-facing triangle of the "
               "detailed mesh. Heights are divided by `bump height=`, so that bump and "
               "displacement are as high as the mesh. Baked pictures cover the object's (u,v) "
               "once. Slopes of heights and of normals add up, so bake only one of the two. A note "
               "reports the rays that missed or hit only back faces.",
    .example = "bake stone-high.ply map=normal size=2048x2048 samples=2"
};

static const WrArgSpec args_bake_tiles[] = {
    { DETAILED },
    { PLACE("OUT"), .type = WR_ARG_PATH,
      .help = "path of the files; <UDIM> is replaced by each tile's number, and the extension "
              "chooses the format" },
    { 0 }
};

const WrCommand wr_command_bake_tiles = {
    .name = "bake-tiles",
    .kind = WR_CLASS_OUTPUT,
    .args = args_bake_tiles,
    .more = args_bake + 1,
    .run = run_bake_tiles,
    .help = "bake maps of a detailed mesh, one file for each UDIM tile of the object's mesh",
    .details = "Like `bake`, but the document does not change. Every tile of the mesh's own (u,v) "
               "is baked, not only the one that shows the table. Heights are in the table's unit; "
               "in integer formats all tiles share one range, which is stored in the files' "
               "metadata. Normals have green up. Either all files are replaced or none.",
    .example = "bake-tiles stone-high.ply stone_normal.<UDIM>.png map=normal size=2048x2048"
};

/* Painting in a session: the brush's arguments, its presets, its target, and the stroke in progress. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "brush/library.h"
#include "brush/preset.h"
#include "brush/tip.h"
#include "command/args.h"
#include "command/session_internal.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/layer_times.h"
#include "field/field.h"
#include "field/ramp.h"
#include "field/select.h"
#include "scene/scene.h"
#include "surface/mesh_texels.h"
#include "system/clock.h"
#include "surface/triangles.h"
#include "system/path.h"

#include <math.h>
#include <string.h>

/* Validation of set=. */
static bool check_settings(const void *ctx, const char *name, const char *value, WrError *err);

/* ---- Arguments of the brush, shared by all painting commands ---- */

const char *wr_brush_mode_name(int i)
{
    return i < WR_BRUSH_MODE_COUNT ? wr_brush_modes[i].name : NULL;
}

static const char *pressure_name(int i)
{
    return i < WR_PRESSURE_COUNT ? wr_brush_pressures[i] : NULL;
}

/* "adds strength to the height (strength)": description and the names of the arguments that the mode uses. */
void wr_brush_mode_explain(int i, WrText *text)
{
    static const struct {
        unsigned bit;
        const char *name;
    } uses[] = { { WR_USES_STRENGTH, "strength=" },
                 { WR_USES_TO, "to=" },
                 { WR_USES_REACH, "reach=" },
                 { WR_USES_SOURCE, "source=" } };
    const WrBrushModeInfo *mode = &wr_brush_modes[i];
    wr_text_add(text, mode->help);
    const char *before = " (";
    for (size_t k = 0; k < sizeof uses / sizeof *uses; k++)
        if (mode->uses & uses[k].bit) {
            wr_text_addf(text, "%s%s", before, uses[k].name);
            before = " ";
        }
    if (*before == ' ' && before[1] == '\0') wr_text_add(text, ")");
}

static const WrComponent jitter_parts[] = { { "place", 0, 100, false },
                                            { "angle", 0, 180, false },
                                            { "size", 0, 1, false } };

const WrArgSpec wr_args_brush[] = {
    { .name = "radius",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 1e9,
      .fallback = NUMBERS(16),
      .unit = "texels",
      .help = "outer radius, beyond which nothing changes" },
    { .name = "hardness",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 1,
      .fallback = NUMBERS(0.5),
      .help = "share of the radius with full coverage" },
    PAINT_ARGS,
    { .name = "flow",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 1,
      .fallback = NUMBERS(1),
      .help = "coverage of each dab; below 1 the stroke builds up to its opacity" },
    { .name = "buildup",
      .type = WR_ARG_CHOICE,
      .words = wr_off_on,
      .fallback_text = "off",
      .help = "on: dabs add up without limit, also where the stroke crosses itself" },
    { .name = "spacing",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 10,
      .fallback = NUMBERS(0),
      .unit = "radii",
      .help = "distance between dabs, at least 0.01; 0: that of the mode or the tip" },
    { .name = "pressure",
      .type = WR_ARG_CHOICE,
      .choice = pressure_name,
      .fallback_text = "strength",
      .help = "settings that pen pressure controls; presets have their own curves" },
    { .name = "preset",
      .type = WR_ARG_PRESET,
      .help = "a brush preset by its name (`wrinkle brushes` lists them), or a .myb file; other "
              "arguments replace the preset's own" },
    { .name = "preset_sha256",
      .type = WR_ARG_SHA256,
      .help = "SHA-256 of the preset's file; a file with other content is an error" },
    { .name = "set",
      .type = WR_ARG_TEXT,
      .check = check_settings,
      .shape = "name=value;name:input=x,y|x,y|...;...",
      .help = "values for the preset's settings, by MyPaint's names, and curves for the amount "
              "that an input adds to a setting" },
    { .name = "seed",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 0x1p53,
      .whole = true,
      .fallback = NUMBERS(0),
      .help = "seed of the random numbers" },
    { .name = "tip",
      .type = WR_ARG_PATH,
      .help = "a picture, .gbr or .gih file in place of the round dab" },
    { .name = "tip_sha256",
      .type = WR_ARG_SHA256,
      .help = "SHA-256 of the tip's file; a file with other content is an error" },
    { .name = "angle",
      .type = WR_ARG_NUMBER,
      .low = -360,
      .high = 360,
      .fallback = NUMBERS(0),
      .unit = "degrees",
      .help = "rotation of a tip or an ellipse, anticlockwise" },
    { .name = "aspect",
      .type = WR_ARG_NUMBER,
      .low = 1,
      .high = 100,
      .fallback = NUMBERS(1),
      .help = "aspect ratio of the dab, length over width" },
    { .name = "follow",
      .type = WR_ARG_CHOICE,
      .words = wr_off_on,
      .fallback_text = "off",
      .help = "on: the angle is relative to the path's direction" },
    { .name = "jitter",
      .type = WR_ARG_TUPLE,
      .components = 3,
      .parts = jitter_parts,
      .shape = "place,angle,size",
      .fallback = NUMBERS(0, 0, 0),
      .help = "random variation of each dab: position in radii, angle in degrees to both sides, "
              "size reduced by up to 0..1" },
    { .name = "mirror",
      .type = WR_ARG_CHOICE,
      .words = wr_mirror_names,
      .fallback_text = "none",
      .help = "repeats the stroke mirrored along u, v or both" },
    { .name = "radial",
      .type = WR_ARG_NUMBER,
      .low = 1,
      .high = 360,
      .whole = true,
      .fallback = NUMBERS(1),
      .help = "number of copies around the centre" },
    { .name = "centre",
      .type = WR_ARG_TUPLE,
      .components = 2,
      .shape = "u,v",
      .low = -1e6,
      .high = 1e6,
      .fallback = NUMBERS(0.5, 0.5),
      .help = "centre of the mirrors and rotations" },
    { .name = "repeat",
      .type = WR_ARG_SIZE,
      .shape = "MxN",
      .low = 1,
      .high = 64,
      .fallback = NUMBERS(1, 1),
      .help = "number of copies across and down the cell" },
    { .name = "stagger",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 1,
      .fallback = NUMBERS(0),
      .help = "upward shift of each column relative to the one before, in rows; M stagger must be "
              "a whole number" },
    { 0 }
};

/* ---- cached presets and tips ---- */

/* Cache of presets and tips named by commands. Each is read again only if its files change. Starting a stroke then
   needs no disk access except a check of the file's date. */

#define FILES_MAX 48 /* entries kept in memory */

typedef struct Entry {
    bool is_tip;
    char *key;  /* a bare name, or a file's path; owned */
    char *path; /* owned */
    WrFileInfo stamp;
    char sha256[65];
    WrPreset *preset; /* owned; NULL if the entry is a tip: */
    WrTip *tip;       /* owned */
    char *tip_path;   /* owned; the preset's tip file; NULL: none */
    uint64_t used;
} Entry;

struct WrBrushFiles {
    Entry entries[FILES_MAX];
    int count;
    uint64_t clock;
};

static void entry_fini(Entry *entry)
{
    wr_free(entry->key);
    wr_free(entry->path);
    wr_free(entry->tip_path);
    wr_preset_free(entry->preset);
    wr_tip_free(entry->tip);
    *entry = (Entry){ 0 };
}

void wr_brush_files_free(WrBrushFiles *files)
{
    for (int i = 0; files && i < files->count; i++) entry_fini(&files->entries[i]);
    wr_free(files);
}

/* ---- files ---- */

/* True if none of the entry's files has changed. Modification time alone misses a file replaced by another with the same
   time; inode and change time do not. */
static bool is_fresh(const Entry *entry)
{
    WrFileInfo now;
    const WrFileInfo *then = &entry->stamp;
    return wr_path_info(entry->path, &now) && now.device == then->device &&
           now.inode == then->inode && now.bytes == then->bytes && now.seconds == then->seconds &&
           now.nanoseconds == then->nanoseconds && now.changed_seconds == then->changed_seconds &&
           now.changed_nanoseconds == then->changed_nanoseconds;
}

/* The string after the next `"tip" :`, or NULL; *p advances. The caller frees it. A name with escapes is skipped. */
static char *next_tip_name(const char **p)
{
    static const char key[] = "\"tip\"", blanks[] = " \t\r\n";
    while ((*p = strstr(*p, key))) {
        const char *s = *p += sizeof key - 1;
        s += strspn(s, blanks);
        if (*s++ != ':') continue;
        s += strspn(s, blanks);
        if (*s++ != '"') continue;
        size_t length = strcspn(s, "\"\\/");
        if (length == 0 || s[length] != '"') continue;
        return wr_strndup(s, length);
    }
    return NULL;
}

/* The tip file in a preset's folder. The text was already read as a preset. A false match of the key "tip" therefore
   yields at worst a file name that is never used. */
static char *tip_beside(const char *text, const char *folder)
{
    char *name, *found = NULL;
    while (!found && (name = next_tip_name(&text))) {
        WrFileInfo info;
        char *path = wr_path_join(folder, name);
        if (wr_path_info(path, &info) && info.kind == WR_KIND_FILE) found = path;
        else wr_free(path);
        wr_free(name);
    }
    return found;
}

/* "x/soft.myb" -> "soft"; a bare name stays. */
static char *short_name(const char *word)
{
    if (!wr_names_preset_file(word)) return wr_strdup(word);
    const char *slash = strrchr(word, '/');
    const char *base = slash ? slash + 1 : word;
    return wr_strndup(base, (size_t)(strrchr(base, '.') - base));
}

static bool read_preset(Entry *entry, const char *word, WrError *err)
{
    char *bytes;
    size_t length;
    if (!wr_file_read(entry->path, WR_PRESET_BYTES, &bytes, &length, err)) return false;
    char *folder = wr_path_folder(entry->path), *name = short_name(word);
    wr_sha256_bytes(bytes, length, entry->sha256);
    entry->preset = wr_preset_parse(bytes, length, name, folder, err);
    if (entry->preset && wr_preset_tip(entry->preset)) entry->tip_path = tip_beside(bytes, folder);
    if (!entry->preset && err && !strstr(err->text, entry->path))
        wr_error_prefix(err, "%s: ", entry->path);
    wr_free(folder);
    wr_free(name);
    wr_free(bytes);
    return entry->preset != NULL;
}

static bool read_tip(Entry *entry, WrError *err)
{
    if (!wr_sha256_file(entry->path, entry->sha256, err)) return false;
    entry->tip = wr_tip_read(entry->path, err);
    return entry->tip != NULL;
}

/* ---- cache ---- */

static Entry *find(WrBrushFiles *files, bool is_tip, const char *key)
{
    for (int i = 0; i < files->count; i++)
        if (files->entries[i].is_tip == is_tip && strcmp(files->entries[i].key, key) == 0)
            return &files->entries[i];
    return NULL;
}

/* Slot for a new entry: that of `old`, a free one, or the least recently used one. */
static Entry *place_for(WrBrushFiles *files, Entry *old)
{
    Entry *place = old;
    if (!place && files->count < FILES_MAX) return &files->entries[files->count++];
    for (int i = 0; !old && i < files->count; i++)
        if (!place || files->entries[i].used < place->used) place = &files->entries[i];
    entry_fini(place);
    return place;
}

/* The path (ownership passes), absolute and without links if it can be resolved. */
static char *absolute(char *path)
{
    char *real = path ? wr_path_real(path) : NULL;
    if (!real) return path;
    wr_free(path);
    path = wr_strdup(real);
    free(real);
    return path;
}

static bool take(WrSession *session, bool is_tip, const char *key, WrBrushFile *file, WrError *err)
{
    if (!session->brush_files) session->brush_files = wr_alloc(1, sizeof *session->brush_files);
    WrBrushFiles *files = session->brush_files;
    Entry *entry = find(files, is_tip, key);
    if (!entry || !is_fresh(entry)) {
        bool bare = !is_tip && !wr_names_preset_file(key);
        Entry made = { .is_tip = is_tip,
                       .path = bare ? absolute(wr_library_find(key, err)) : wr_strdup(key) };
        /* Take the file identity before reading: a file that changes during the read is then read again. */
        bool good = made.path != NULL;
        if (good && !wr_path_info(made.path, &made.stamp)) made.stamp = (WrFileInfo){ .bytes = -1 };
        good = good && (is_tip ? read_tip(&made, err) : read_preset(&made, key, err));
        if (!good) {
            entry_fini(&made);
            return false;
        }
        made.key = wr_strdup(key);
        entry = place_for(files, entry);
        *entry = made;
    }
    entry->used = ++files->clock;
    *file = (WrBrushFile){ entry->path, entry->sha256, entry->preset, entry->tip, entry->tip_path };
    return true;
}

bool wr_session_load_preset(WrSession *session, const char *word, const char *folder,
                            WrBrushFile *file, WrError *err)
{
    char *key = wr_names_preset_file(word) ? absolute(wr_path_join(folder, word)) : wr_strdup(word);
    bool good = take(session, false, key, file, err);
    wr_free(key);
    return good;
}

bool wr_session_tip_file(WrSession *session, const char *word, const char *folder,
                         WrBrushFile *file, WrError *err)
{
    char *key = absolute(wr_path_join(folder, word));
    bool good = take(session, true, key, file, err);
    wr_free(key);
    return good;
}

/* ---- Set-up of painting: brush and target layer of a line ---- */

bool wr_call_gives(const WrCall *call, const char *name)
{
    for (int i = 0; i < call->count; i++)
        if (strcmp(call->specs[i].name, name) == 0) return call->args[i].given;
    return false;
}

/* ---- the brush of a line ---- */

static void take_number(const WrCall *call, const char *name, double *value)
{
    if (wr_call_gives(call, name)) *value = wr_call_number(call, name);
}

static void take_switch(const WrCall *call, const char *name, bool *value)
{
    if (wr_call_gives(call, name)) *value = wr_call_choice(call, name) == 1;
}

static void take_values(const WrCall *call, WrBrush *brush)
{
    take_number(call, "radius", &brush->radius);
    take_number(call, "hardness", &brush->hardness);
    take_number(call, "strength", &brush->strength);
    take_number(call, "to", &brush->to);
    take_number(call, "opacity", &brush->opacity);
    take_number(call, "flow", &brush->flow);
    take_number(call, "spacing", &brush->spacing);
    take_number(call, "reach", &brush->reach);
    take_number(call, "angle", &brush->angle_deg);
    take_number(call, "aspect", &brush->aspect);
    take_switch(call, "buildup", &brush->buildup);
    take_switch(call, "follow", &brush->follow);
    if (wr_call_gives(call, "mode")) brush->mode = (WrBrushMode)wr_call_choice(call, "mode");
    if (wr_call_gives(call, "pressure"))
        brush->pressure = (WrBrushPressure)wr_call_choice(call, "pressure");
    if (wr_call_gives(call, "seed")) brush->seed = (uint64_t)wr_call_number(call, "seed");
    if (wr_call_gives(call, "source")) {
        const double *source = wr_call_arg(call, "source")->numbers;
        brush->source_u = source[0];
        brush->source_v = source[1];
    }
    if (wr_call_gives(call, "jitter")) {
        const double *jitter = wr_call_arg(call, "jitter")->numbers;
        brush->jitter_place = jitter[0];
        brush->jitter_angle_deg = jitter[1];
        brush->jitter_size = jitter[2];
    }
}

static bool take_symmetry(const WrCall *call, WrSymmetry *out, WrError *err)
{
    const double *centre = wr_call_arg(call, "centre")->numbers;
    const double *repeat = wr_call_arg(call, "repeat")->numbers;
    int mirror = wr_call_choice(call, "mirror"); /* choices: none, u, v, uv */
    WrSymmetry symmetry = { .mirror_u = mirror & 1,
                            .mirror_v = mirror & 2,
                            .radial = (int)wr_call_number(call, "radial"),
                            .centre_u = centre[0],
                            .centre_v = centre[1],
                            .repeat_u = (int)repeat[0],
                            .repeat_v = (int)repeat[1],
                            .stagger = wr_call_number(call, "stagger") };
    if (!wr_symmetry_check(&symmetry, err)) return false;
    *out = symmetry;
    return true;
}

static bool check_needs(const WrCall *call, const char *name, const char *needed, WrError *err)
{
    if (!wr_call_gives(call, name) || wr_call_gives(call, needed)) return true;
    return wr_fail(err, "%s= needs %s=", name, needed);
}

static bool take_preset(WrSession *session, WrCall *call, WrHeldBrush *held, WrError *err)
{
    if (!check_needs(call, "preset_sha256", "preset", err) ||
        !check_needs(call, "set", "preset", err))
        return false;
    if (!wr_call_gives(call, "preset")) return true;
    WrBrushFile file;
    if (!wr_session_load_preset(session, wr_call_arg(call, "preset")->text, session->folder, &file,
                                err) ||
        !wr_call_check_sha256(call, "preset_sha256", file.path, file.sha256, err))
        return false;
    wr_session_note_input(session, file.path);
    if (file.tip_path) wr_session_note_input(session, file.tip_path);
    held->preset = wr_call_gives(call, "set")
                       ? wr_preset_with(file.preset, wr_call_arg(call, "set")->text, err)
                       : wr_preset_share(file.preset);
    if (!held->preset) return false;
    held->brush = wr_preset_brush(held->preset);
    return true;
}

/* Use a tip; its own spacing is the default. */
static bool take_tip(WrSession *session, WrCall *call, WrHeldBrush *held, WrError *err)
{
    if (!check_needs(call, "tip_sha256", "tip", err)) return false;
    if (!wr_call_gives(call, "tip")) return true;
    WrBrushFile file;
    if (!wr_session_tip_file(session, wr_call_arg(call, "tip")->text, session->folder, &file,
                             err) ||
        !wr_call_check_sha256(call, "tip_sha256", file.path, file.sha256, err))
        return false;
    wr_session_note_input(session, file.path);
    held->tip = wr_tip_share(file.tip);
    held->brush.tip = held->tip;
    if (!wr_call_gives(call, "spacing") && wr_tip_spacing(held->tip) > 0.0)
        held->brush.spacing = wr_tip_spacing(held->tip);
    return true;
}

static void held_fini(WrHeldBrush *held)
{
    wr_preset_free(held->preset);
    wr_tip_free(held->tip);
    *held = (WrHeldBrush){ 0 };
}

/* A flood fill has no brush shape: no preset, tip or symmetry. */
static bool has_shape(const WrCall *call)
{
    return call->command->more == wr_args_brush;
}

static bool hold_brush(WrSession *session, WrCall *call, WrHeldBrush *out, WrError *err)
{
    WrHeldBrush held = { .brush = wr_brush_default() };
    bool good = !has_shape(call) ||
                (take_preset(session, call, &held, err) && take_tip(session, call, &held, err) &&
                 take_symmetry(call, &held.brush.symmetry, err));
    if (good) take_values(call, &held.brush);
    if (good && held.brush.mode == WR_BRUSH_CLONE && !wr_call_gives(call, "source"))
        good = wr_fail(err, "mode=clone needs source=du,dv, the offset of the copied heights");
    if (good) *out = held;
    else held_fini(&held);
    return good;
}

static bool check_settings(const void *ctx, const char *name, const char *value, WrError *err)
{
    (void)ctx;
    if (wr_preset_settings_check(value, err)) return true;
    wr_error_prefix(err, "%s: ", name);
    return false;
}

/* ---- target ---- */

/* Effect of erasing on a layer, by its blend mode:
 *   add, subtract   height 0, which changes nothing below
 *   mix             the composite of the layers below, computed once
 *   others          coverage falls; the heights stay, since changing them would alter the partly covered rest.
 *                   Where coverage reaches 0 they become 0, as in a new layer (wr_painting_end)
 * The bottom layer has nothing below it: without coverage its heights go to 0. */
static void prepare_erasing(WrSession *session, WrLayer *layer, WrPainting *painting)
{
    const WrDocument *document = session->state.document;
    bool covers = wr_blends[layer->blend].uses_cover;
    if (layer->blend == WR_BLEND_MIX) {
        painting->below = wr_document_below(document, document->active, session->options.pool);
    } else if (covers && (layer->cover || document->active > 0)) {
        const WrField *like = layer->heights;
        if (!layer->cover)
            layer->cover = wr_field_new(wr_field_width(like), wr_field_height(like),
                                        wr_field_wrap_u(like), wr_field_wrap_v(like), 1.0f, NULL);
        painting->cover_before = wr_field_share(layer->cover);
        painting->below = wr_field_share(layer->heights);
    }
}

/* ---- strokes on a mesh ---- */

/* The mesh that strokes paint on, and the table on it. */
static const WrTriangles *painted_mesh(const WrDocument *document, const WrField *field,
                                       WrMeshTexelsTable *table)
{
    *table = (WrMeshTexelsTable){ .width = wr_field_width(field),
                                  .height = wr_field_height(field),
                                  .periodic_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC,
                                  .periodic_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC };
    return wr_document_painted_mesh(document, &table->ru, &table->rv);
}

/* The texels of the active object's mesh for the table, made again for another mesh or table. */
static bool take_texels(WrSession *session, const WrField *field, WrError *err)
{
    const WrScene *scene = session->state.document->scene;
    WrMeshTexelsTable table;
    const WrTriangles *mesh = painted_mesh(session->state.document, field, &table);
    if (!scene->triangles || !wr_surfaces[scene->shape.kind]->held)
        return wr_fail(err, "the object is a %s, not a mesh; paint on its table with `stroke`",
                       wr_surfaces[scene->shape.kind]->name);
    if (session->mesh_texels && wr_mesh_texels_fit(session->mesh_texels, mesh, &table)) return true;
    WrMeshTexels *before = session->mesh_texels;
    session->mesh_texels = wr_mesh_texels_new(mesh, &table, before, err);
    wr_mesh_texels_free(before);
    session->mesh_sharing_told = false;
    return session->mesh_texels != NULL;
}

bool wr_session_mesh_needs_preparing(const WrSession *session)
{
    const WrDocument *document = session->state.document;
    const WrScene *scene = document->scene;
    if (!scene->triangles || !wr_surfaces[scene->shape.kind]->held) return false;
    WrMeshTexelsTable table;
    const WrField *field = document->layers[document->active].heights;
    const WrTriangles *mesh = painted_mesh(document, field, &table);
    return !session->mesh_texels || !wr_mesh_texels_fit(session->mesh_texels, mesh, &table);
}

bool wr_session_prepare_mesh(WrSession *session, WrError *err)
{
    const WrDocument *document = session->state.document;
    return take_texels(session, document->layers[document->active].heights, err);
}

const WrRayTree *wr_session_mesh_tree(const WrSession *session, const WrTriangles *mesh)
{
    return session->mesh_texels ? wr_mesh_texels_tree(session->mesh_texels, mesh) : NULL;
}

/* `project` has none. */
static void take_mirrors(const WrSession *session, const WrCall *call, WrBrushGround *ground)
{
    if (!wr_call_gives(call, "mirror_axes")) return;
    ground->mirrors = (unsigned)wr_call_choice(call, "mirror_axes");
    ground->mirror_at = wr_mesh_mirrors_at(session->state.document->scene->triangles);
    if (!wr_call_given(call, "mirror_at")) return;
    const double *at = wr_call_arg(call, "mirror_at")->numbers;
    ground->mirror_at = (WrVec3){ at[0], at[1], at[2] };
}

static bool take_mesh(WrSession *session, const WrCall *call, const WrBrush *brush,
                      WrBrushGround *ground, WrError *err)
{
    const WrSymmetry *s = &brush->symmetry;
    if (!call->command->on_mesh) return true;
    if (s->mirror_u || s->mirror_v || s->radial > 1 || s->repeat_u > 1 || s->repeat_v > 1)
        return wr_fail(
            err, "mirror=, radial= and repeat= work on the table only; leave them out on a mesh");
    if (!take_texels(session, ground->field, err)) return false;
    ground->mesh = session->mesh_texels;
    take_mirrors(session, call, ground);
    ground->clips = wr_call_given(call, "eye");
    if (!ground->clips) return true;
    const double *eye = wr_call_arg(call, "eye")->numbers;
    ground->eye = (WrVec3){ eye[0], eye[1], eye[2] };
    return true;
}

static void note_sharing(WrSession *session)
{
    const int64_t shared = wr_mesh_texels_shared(session->mesh_texels);
    if (shared == 0 || session->mesh_sharing_told) return;
    session->mesh_sharing_told = true;
    wr_session_note(session,
                    "%lld texels of the stroke belong to several places of the mesh, whose (u,v) "
                    "overlap; all of them change",
                    (long long)shared);
}

bool wr_painting_begin(WrSession *session, WrCall *call, WrPainting *painting, WrError *err)
{
    WrPainting made = { 0 };
    WrLayer *layer = wr_session_layer(session, err);
    if (!layer || !hold_brush(session, call, &made.held, err)) return false;
    wr_filters_forget();
    if (made.held.brush.mode == WR_BRUSH_ERASE) prepare_erasing(session, layer, &made);
    if (!wr_filters_carried(err)) { /* of the layers below */
        wr_field_free(made.below);
        held_fini(&made.held);
        return false;
    }
    made.ground = (WrBrushGround){ .field = layer->heights,
                                   .mark = layer->cover,
                                   .selection = session->state.document->selection,
                                   .below = made.below,
                                   .pool = session->options.pool };
    if (!take_mesh(session, call, &made.held.brush, &made.ground, err)) {
        wr_painting_end(session, &made);
        return false;
    }
    *painting = made;
    return true;
}

/* ---- afterwards ---- */

typedef struct Clearing {
    WrField *heights;
    const WrField *before, *after;
} Clearing;

/* Where coverage fell to 0 the heights become 0, too: other heights under no coverage would reappear when coverage is painted
   again. */
static void clear_tile(int tx, int ty, void *ctx)
{
    const Clearing *c = ctx;
    const float *before = wr_field_tile(c->before, tx, ty),
                *after = wr_field_tile(c->after, tx, ty);
    const float *old = wr_field_tile(c->heights, tx, ty);
    float before_level = wr_field_level(c->before), after_level = wr_field_level(c->after);
    float level = wr_field_level(c->heights), *heights = NULL;
    int columns = wr_field_width(c->heights) - tx * WR_TILE;
    int rows = wr_field_height(c->heights) - ty * WR_TILE;
    for (int i = 0; i < WR_TILE * WR_TILE; i++) {
        if (i % WR_TILE >= columns || i / WR_TILE >= rows) continue;
        bool went =
            (after ? after[i] : after_level) <= 0.0f && (before ? before[i] : before_level) > 0.0f;
        if (!went || (old ? old[i] : level) == 0.0f) continue;
        if (!heights) old = heights = wr_field_tile_write(c->heights, tx, ty);
        heights[i] = 0.0f;
    }
}

void wr_painting_end(WrSession *session, WrPainting *painting)
{
    if (painting->ground.mesh) note_sharing(session);
    if (painting->cover_before) {
        Clearing clearing = { painting->ground.field, painting->cover_before,
                              painting->ground.mark };
        wr_field_changes(clearing.before, clearing.after, clear_tile, &clearing);
    }
    wr_field_free(painting->cover_before);
    wr_field_free(painting->below);
    held_fini(&painting->held);
    *painting = (WrPainting){ 0 };
}

/* ---- Cancellable drawing of a whole stroke ---- */

#define SLICE 0.05 /* seconds between two checks for cancellation */

bool wr_session_draw(const WrPainting *painting, WrSampleAt *sample, const void *ctx, int count,
                     WrError *err)
{
    WrStroke *stroke = wr_stroke_new_on(&painting->ground, &painting->held.brush);
    bool more = true;
    for (int i = 0; i < count; i++) {
        wr_stroke_push(stroke, sample(ctx, i));
        do {
            if (!wr_progress_report((double)i / count)) {
                wr_stroke_abandon(stroke);
                return wr_fail(err, "cancelled");
            }
            more = wr_stroke_work(stroke, SLICE);
        } while (more);
    }
    wr_stroke_finish(stroke);
    return true;
}

/* ---- A stroke in progress: an open command ---- */

/* A stroke is a command whose points arrive one by one. Until its end the session refuses all other commands; the layer is
   edited in place, and a cancellation restores the state of the last step. */
bool wr_session_stroke_begin(WrSession *session, const char *head, WrError *err)
{
    WrCall *call;
    if (!wr_session_refuse_in_stroke(session, err)) return false;
    if (!wr_call_parse(head, true, &call, err)) return false;
    if (!call->command || !call->command->streams || wr_call_given(call, "points")) {
        wr_call_free(call);
        return wr_fail(err, "a stroke begins with a stroke command without points");
    }
    WrPainting painting;
    if (!wr_painting_begin(session, call, &painting, err)) {
        wr_document_edit_end(session->state.document, &session->stand_in);
        wr_error_prefix(err, "%s: ", call->command->name);
        wr_call_free(call);
        return false;
    }
    wr_session_journal_stroke_begin(session, call);
    session->step_seconds = 0.0;
    session->stroke_call = call;
    session->painting = painting;
    session->stroke = wr_stroke_new_on(&session->painting.ground, &session->painting.held.brush);
    return true;
}

/* The double that the text of `value` with n decimals reads back as. k / 10^n is correctly rounded because both are
   integers below 2^53. The stroke is drawn with the rounded samples, and the line stores these digits: repeating the line
   draws the same bits (HC75 concerns event timing, this the text). The sum with 0.0 removes a negative zero. */
static double round_decimals(double value, double ten_to_n)
{
    double k = rint(value * ten_to_n);
    return fabs(k) < 0x1p53 ? k / ten_to_n + 0.0 : value;
}

static double clamp_finite(double value, double low, double high)
{
    if (!(value >= low)) return isnan(value) ? 0 : low;
    return value > high ? high : value;
}

/* 10^n with n decimals for lengths of a mesh of that radius: seven digits and more. */
static double decimals_for(double radius)
{
    double ten_to_n = 1.0;
    while (ten_to_n < 1e22 && radius * ten_to_n < 1e7) ten_to_n *= 10.0;
    return ten_to_n;
}

static WrSample round_sample(WrSample s, double decimals)
{
    return (WrSample){ .u = round_decimals(s.u, 1e7),
                       .v = round_decimals(s.v, 1e7),
                       .p = { round_decimals(s.p.x, decimals), round_decimals(s.p.y, decimals),
                              round_decimals(s.p.z, decimals) },
                       .pressure = round_decimals(clamp_finite(s.pressure, 0, 1), 1e4),
                       .tilt_x = round_decimals(clamp_finite(s.tilt_x, -1, 1), 1e4),
                       .tilt_y = round_decimals(clamp_finite(s.tilt_y, -1, 1), 1e4),
                       .seconds = round_decimals(clamp_finite(s.seconds, 0, 1e9), 1e4),
                       .turn_deg = round_decimals(clamp_finite(s.turn_deg, -360, 360), 1e2) };
}

bool wr_session_stroke_push(WrSession *session, const WrSample *samples, int count, WrError *err)
{
    if (!session->stroke) return wr_fail(err, "no stroke is being drawn");
    const bool mesh = session->stroke_call->command->on_mesh;
    const double decimals =
        mesh ? decimals_for(session->state.document->scene->triangles->radius) : 1.0;
    for (int i = 0; i < count; i++) {
        const WrVec3 p = samples[i].p;
        if (mesh && !(fabs(p.x) + fabs(p.y) + fabs(p.z) <= WR_LENGTH_MAX))
            return wr_fail(err, "sculpt: sample %d is at %g,%g,%g: must be within %g of 0", i + 1,
                           p.x, p.y, p.z, WR_LENGTH_MAX);
        if (!mesh && (!(fabs(samples[i].u) <= 1e9) || !(fabs(samples[i].v) <= 1e9)))
            return wr_fail(err, "stroke: sample %d is at %g,%g: must be within 1e9 of 0", i + 1,
                           samples[i].u, samples[i].v);
    }
    if (count > WR_POINTS_MAX - wr_call_arg(session->stroke_call, "points")->rows)
        return wr_fail(err, "stroke: more than %d samples", WR_POINTS_MAX);
    for (int i = 0; i < count; i++) {
        WrSample s = round_sample(samples[i], decimals);
        const double rest[] = { s.pressure, s.tilt_x, s.tilt_y, s.seconds, s.turn_deg };
        double row[8] = { mesh ? s.p.x : s.u, mesh ? s.p.y : s.v, s.p.z };
        const int place = mesh ? 3 : 2;
        memcpy(row + place, rest, sizeof rest);
        /* Trailing defaults are omitted: u,v; u,v,pressure; with tilts 5, with times 6, with turns 7 numbers. */
        int n = place + (s.turn_deg != 0                  ? 5
                         : s.seconds != 0                 ? 4
                         : s.tilt_x != 0 || s.tilt_y != 0 ? 3
                         : s.pressure != 1                ? 1
                                                          : 0);
        wr_session_journal_stroke_add(session, row, n);
        wr_call_add_row(session->stroke_call, "points", row, n);
        wr_stroke_push(session->stroke, s);
    }
    return true;
}

bool wr_session_stroke_work(WrSession *session, double seconds)
{
    if (!session->stroke) return false;
    const double began = wr_clock_seconds();
    const bool more = wr_stroke_work(session->stroke, seconds);
    session->step_seconds += wr_clock_seconds() - began;
    return more;
}

int64_t wr_session_stroke_drawn(const WrSession *session)
{
    return session->stroke ? wr_stroke_drawn(session->stroke) : 0;
}

bool wr_session_stroke_add(WrSession *session, const WrSample *samples, int count, WrError *err)
{
    if (!wr_session_stroke_push(session, samples, count, err)) return false;
    while (wr_session_stroke_work(session, 1.0)) {
    }
    return true;
}

/* End the open stroke and return its line. */
static WrCall *take_call(WrSession *session)
{
    WrCall *call = session->stroke_call;
    session->stroke = NULL;
    session->stroke_call = NULL;
    return call;
}

/* Queued and delayed samples are drawn when the stroke is freed. */
bool wr_session_stroke_end(WrSession *session, WrError *err)
{
    if (!session->stroke) return wr_fail(err, "no stroke is being drawn");
    wr_stroke_finish(session->stroke);
    wr_painting_end(session, &session->painting);
    wr_document_edit_end(session->state.document, &session->stand_in);
    WrCall *call = take_call(session);
    bool drawn = wr_call_given(call, "points");
    session->made_before = wr_layer_time_last();
    const bool good = !drawn || wr_session_follow(session, err);
    drawn = drawn && good;
    if (drawn) wr_session_remember(session, call);
    else wr_session_restore(session);
    wr_session_journal_stroke_end(session, drawn);
    wr_call_free(call);
    return good;
}

void wr_session_stroke_cancel(WrSession *session)
{
    if (!session->stroke) return;
    wr_stroke_abandon(session->stroke);
    wr_painting_end(session, &session->painting);
    wr_document_edit_end(session->state.document, &session->stand_in);
    wr_call_free(take_call(session));
    wr_session_journal_stroke_end(session, false);
    wr_session_restore(session);
}

bool wr_session_in_stroke(const WrSession *session)
{
    return session->stroke != NULL;
}

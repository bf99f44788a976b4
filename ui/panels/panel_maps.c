/* Texture maps of the active object: colour, normals, roughness and metalness. Every change is a command line. */
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/app/jobs/files.h"
#include "ui/panels/panels.h"

#include "base/text.h"
#include "command/command_line.h"
#include "image/image.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#define GLYPH 24

/* A map. */
typedef struct Map {
    const char *verb, *label, *choose, *remove, *none;
    WrFilePurpose purpose;
    WrTextureSample *(*laid)(WrScene *scene);
} Map;

static WrTextureSample *colour_laid(WrScene *scene)
{
    return &scene->colour_laid;
}

static WrTextureSample *normals_laid(WrScene *scene)
{
    return &scene->normals.laid;
}

static WrTextureSample *roughness_laid(WrScene *scene)
{
    return &scene->facets[WR_FACET_ROUGHNESS].laid;
}

static WrTextureSample *metalness_laid(WrScene *scene)
{
    return &scene->facets[WR_FACET_METALNESS].laid;
}

static const Map colour = {
    "colour",       "Colours",  "Choose a picture of colours", "Take the colours off", "none",
    WR_FILE_COLOUR, colour_laid
};
static const Map facets[WR_FACET_KINDS] = {
    [WR_FACET_ROUGHNESS] = { "roughness", "Roughness",
                             "Choose a roughness map; of three channels G is used, as in glTF",
                             "Removes the roughness map", "as set above", WR_FILE_ROUGHNESS,
                             roughness_laid },
    [WR_FACET_METALNESS] = { "metalness", "Metalness",
                             "Choose a metalness map; of three channels B is used, as in glTF",
                             "Removes the metalness map", "as set above", WR_FILE_METALNESS,
                             metalness_laid },
};
static const Map normals = {
    "normalmap",
    "Normals",
    "Choose a normal map, as other programs bake it or `export normal` writes it",
    "Removes the normal map",
    "none",
    WR_FILE_NORMALS,
    normals_laid
};

/* Run "VERB FILE" or "VERB name=value". */
static void run(WrApp *app, const char *verb, const char *name, const char *value)
{
    WrText line = { 0 };
    wr_text_add(&line, verb);
    if (name) wr_text_addf(&line, " %s=%s", name, value);
    else wr_text_add(&line, " "), wr_text_add_word(&line, value);
    wr_scene_run(app, &line);
}

void wr_map_take_colour(WrApp *app, const char *path)
{
    run(app, colour.verb, NULL, path);
}

void wr_map_take_normals(WrApp *app, const char *path)
{
    run(app, normals.verb, NULL, path);
}

void wr_map_take_roughness(WrApp *app, const char *path)
{
    run(app, facets[WR_FACET_ROUGHNESS].verb, NULL, path);
}

void wr_map_take_metalness(WrApp *app, const char *path)
{
    run(app, facets[WR_FACET_METALNESS].verb, NULL, path);
}

static const char *name_of(const char *path)
{
    const char *slash = path ? strrchr(path, '/') : NULL;
    return slash ? slash + 1 : path;
}

/* The file's name, with buttons to open another one and to remove it. */
static void file_row(WrApp *app, const Map *map, const WrImage *image, const WrTextureSample *laid)
{
    const char *path = image && laid->path ? laid->path : "";
    wr_gui_label(map->label);
    const double buttons = wr_gui_px(image ? 2 * GLYPH + 4 : GLYPH);
    const double end = wr_gui_place() + wr_gui_available();
    wr_gui_text_cut(WR_FONT_TEXT, image ? WR_COLOUR_TEXT : WR_COLOUR_LABEL,
                    image ? name_of(path) : map->none, wr_gui_available() - buttons - wr_gui_px(4));
    if (image) wr_gui_tip(path);
    wr_gui_same_line(4);
    wr_gui_move_to(end - buttons);
    if (wr_gui_glyph("choose", WR_ICON_FOLDER, GLYPH, WR_COLOUR_LABEL) &&
        !wr_files_request_path(app->files, map->purpose, NULL, ""))
        wr_dialog_open(app, WR_DIALOG_FILE);
    wr_gui_tip(map->choose);
    if (!image) return;
    wr_gui_same_line(4);
    if (wr_gui_glyph("remove", WR_ICON_CLOSE, GLYPH, WR_COLOUR_LABEL))
        run(app, map->verb, NULL, "off");
    wr_gui_tip(map->remove);
}

/* Tiling: as the table, once, or a number of repeats. */
static void repeat_row(WrApp *app, const Map *map, const WrTextureSample *laid)
{
    static const char *const ways[] = { "As the table", "Once", "So often" };
    static const char *const words[] = { "table", "once", "2,2" };
    static const WrNumber spec = { .low = -8,
                                   .high = 8,
                                   .hard_low = -1e9,
                                   .hard_high = 1e9,
                                   .reset = 1,
                                   .decimals = 2,
                                   .tip = "Repeats along u and v" };
    const bool once = laid->own && laid->ru == 1 && laid->rv == 1;
    const int now = !laid->own ? 0 : once ? 1 : 2;
    double ru = laid->ru, rv = laid->rv;
    int way = now;
    wr_gui_label("Repeat");
    if (wr_gui_choice("repeat", 0, ways, 3, &way) && way != now) {
        run(app, map->verb, "repeat", words[way]);
        return;
    }
    wr_gui_tip("Repeats over the object");
    if (now != 2) return;
    wr_gui_label("");
    const double half = (wr_gui_available() - wr_gui_px(8)) / 2;
    const WrEdit edit_u = wr_gui_number("ru", half, &spec, &ru);
    wr_gui_same_line(8);
    const WrEdit edit_v = wr_gui_number("rv", half, &spec, &rv);
    if (edit_u == WR_EDIT_NONE && edit_v == WR_EDIT_NONE) return;
    WrTextureSample *own = map->laid(wr_app_live_begin(app));
    own->ru = ru, own->rv = rv;
    if (edit_u != WR_EDIT_DONE && edit_v != WR_EDIT_DONE) return;
    WrText value = { 0 };
    wr_text_add_number(&value, ru);
    wr_text_add(&value, ",");
    wr_text_add_number(&value, rv);
    run(app, map->verb, "repeat", wr_text_get(&value));
    wr_text_fini(&value);
}

/* A choice argument of the command. */
static void word_row(WrApp *app, const char *label, const char *name, const char *const *titles,
                     const char *const *words, int count, int now, const char *tip)
{
    int chosen = now;
    wr_gui_label(label);
    const bool changed = wr_gui_choice(name, 0, titles, count, &chosen);
    wr_gui_tip(tip);
    if (!changed || chosen == now) return;
    WrText line = { 0 };
    wr_text_add(&line, normals.verb);
    wr_text_addf(&line, " %s=%s", name, words[chosen]);
    wr_scene_run(app, &line);
}

static void normal_rows(WrApp *app)
{
    static const char *const
        spaces[] = { "Tangent plane", "Object's axes" },
        *const space_words[] = { "tangent", "object" }, *const greens[] = { "Up", "Down" },
        *const green_words[] = { "up", "down" },
        *const frames[] = { "Automatic", "Slopes of heights", "MikkTSpace", "As in the lecture" },
        *const combines[] = { "Slopes add", "Turned with it", "On its surface" };
    static const WrNumber strength = { .low = -2,
                                       .high = 2,
                                       .hard_low = -100,
                                       .hard_high = 100,
                                       .reset = 1,
                                       .decimals = 2,
                                       .tip = "Its slopes times this" };
    const WrNormalMap map = wr_app_scene(app)->normals;
    word_row(app, "Space", "space", spaces, space_words, 2, map.object,
             "Axes of its three channels: u, v and up, or the object's own axes");
    word_row(app, "Green", "green", greens, green_words, 2, map.green_down,
             "Direction of its second channel: up the picture (OpenGL, +Y) or down (DirectX, -Y)");
    if (!map.object)
        word_row(app, "Frame", "frame", frames, wr_normal_frame_names, WR_FRAME_OBJECT,
                 (int)map.frame,
                 "Tangent frame: slopes of heights, as our own export writes them, or unit vectors "
                 "in the frames of other programs. Automatic: MikkTSpace on a mesh");
    word_row(app, "Relief over it", "combine", combines, wr_combine_names, WR_COMBINE_COUNT,
             (int)map.combine,
             "Combination with the table's relief. Slopes add: like heights. Turned with it: the "
             "relief's normals are rotated with the map's. On its surface: also flatter where the "
             "map's slope stretches it");
    double value = map.strength;
    wr_gui_label("Strength");
    const WrEdit edit = wr_gui_number("strength", 0, &strength, &value);
    if (edit != WR_EDIT_NONE) wr_app_live_begin(app)->normals.strength = value;
    if (edit != WR_EDIT_DONE) return;
    WrText line = { 0 };
    wr_text_add(&line, normals.verb);
    wr_line_number(&line, "strength", value);
    wr_scene_run(app, &line);
}

/* Maps that the reflection model uses, and maps already loaded. */
static void facet_rows(WrApp *app)
{
    const WrReflectInfo *model = &wr_reflects[wr_app_scene(app)->material.model];
    const bool asked[WR_FACET_KINDS] = { model->roughness, model->metalness };
    for (int k = 0; k < WR_FACET_KINDS; k++) {
        const WrFacetMap *map = &wr_app_scene(app)->facets[k];
        if (!asked[k] && !map->image) continue;
        wr_gui_push_id(3 + k);
        file_row(app, &facets[k], map->image, &map->laid);
        if (wr_app_scene(app)->facets[k].image)
            repeat_row(app, &facets[k], &wr_app_scene(app)->facets[k].laid);
        wr_gui_pop_id();
    }
}

void wr_panel_maps(WrApp *app)
{
    if (!wr_gui_fold("PICTURES", false)) return;
    wr_gui_push_id(1);
    const bool ramp = wr_app_scene(app)->colouring.count > 0;
    if (!ramp) file_row(app, &colour, wr_app_scene(app)->colour, &wr_app_scene(app)->colour_laid);
    if (wr_app_scene(app)->colour && !ramp)
        repeat_row(app, &colour, &wr_app_scene(app)->colour_laid);
    wr_gui_pop_id();
    wr_gui_push_id(2);
    file_row(app, &normals, wr_app_scene(app)->normals.image, &wr_app_scene(app)->normals.laid);
    if (wr_app_scene(app)->normals.image) normal_rows(app);
    if (wr_app_scene(app)->normals.image)
        repeat_row(app, &normals, &wr_app_scene(app)->normals.laid);
    wr_gui_pop_id();
    facet_rows(app);
    wr_panel_colouring(app);
}

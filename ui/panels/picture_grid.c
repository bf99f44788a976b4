#include "ui/panels/picture_grid.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_rows.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "scene/light_preset.h"
#include "scene/material_preset.h"
#include "scene/stock_model.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>

#define GAP 6

static SDL_Texture *texture_of(WrApp *app, WrThumbKind kind, int i, int side,
                               const WrPictureItem *item)
{
    const WrThumbSource of = { .picture = item->picture,
                               .scene = item->lines.length ? item->lines.data : NULL };
    return wr_thumb(app, kind, i, side, &of);
}

/* ---- a grid ---- */

#define CAPTION_FROM                                                                               \
    100 /* units: names are cut below smaller pictures, and stand in their tips alone */

static bool tile(SDL_Texture *texture, const WrPictureItem *item, double side, bool chosen,
                 bool caption)
{
    char tip[300];
    snprintf(tip, sizeof tip, "%.60s: %.230s", wr_words(item->title), wr_words(item->help));
    wr_gui_group_begin();
    const bool pressed = wr_gui_tile("tile", texture, side, chosen, false) == 1;
    wr_gui_as_it_is(true);
    wr_gui_tip(tip);
    wr_gui_as_it_is(false);
    if (caption) {
        wr_gui_space(-4);
        wr_gui_text_cut(WR_FONT_SMALL, chosen ? WR_COLOUR_TEXT : WR_COLOUR_LABEL, item->title,
                        side);
    }
    wr_gui_group_end();
    return pressed;
}

int wr_picture_grid(WrApp *app, WrThumbKind kind, const char *name, int count, double units,
                    int chosen, void (*item)(const WrApp *app, int i, WrPictureItem *out))
{
    const int gap = wr_gui_px(GAP), room = (int)wr_gui_available() + gap;
    const int fit = (int)(room / (double)(wr_gui_px(units) + gap) + 0.5),
              columns = fit < 1 ? 1 : fit;
    const int side = room / columns - gap; /* they fill the row */
    int pressed = -1;
    wr_gui_name_row(name);
    for (int i = 0; i < count; i++) {
        WrPictureItem one = { 0 };
        item(app, i, &one);
        if (i % columns) wr_gui_same_line(GAP);
        wr_gui_push_id(i);
        SDL_Texture *texture = /* of one size, shown in another */
            wr_gui_will_see(side) ? texture_of(app, kind, i, wr_gui_px(units), &one) : NULL;
        if (tile(texture, &one, side, i == chosen, units >= CAPTION_FROM)) pressed = i;
        wr_gui_pop_id();
        wr_text_fini(&one.lines);
    }
    wr_gui_name_item(name);
    return pressed;
}

/* ---- materials, models, lights ---- */

#define TILE 60 /* units */

/* A sphere with shallow dimples shows highlight, shade and relief. */
#define BALL                                                                                       \
    "table 128x128\npattern dots across=4 rows=4\nadjust blur sigma=3\nsurface sphere\n"           \
    "replicate 4,2\nbump scheme=bspline height=-0.05\nmaterial occlusion=on\n"                     \
    "camera orthographic eye=0,0,5 size=2.1\ntone soft\n"                                          \
    "dials aa=supersample samples=3 horizons=8\n"

static void set_line(WrApp *app, const char *verb, const char *name)
{
    WrText line = { 0 };
    wr_text_addf(&line, "%s%s", verb, name);
    wr_scene_run(app, &line);
}

static void material_item(const WrApp *app, int i, WrPictureItem *out)
{
    (void)app;
    const WrMaterialPreset *preset = &wr_material_presets[i];
    out->title = preset->title, out->help = preset->help;
    wr_text_addf(&out->lines, BALL "light preset studio\nmaterial preset=%s\n", preset->name);
}

/* Index of the preset with the material's numbers, or -1. */
static int material_now(const WrMaterial *material)
{
    for (int i = 0; i < WR_MATERIAL_PRESETS; i++) {
        const WrMaterial *m = &wr_material_presets[i].material;
        if (m->model == material->model && m->energy == material->energy &&
            m->ambient == material->ambient && m->diffuse == material->diffuse &&
            m->specular == material->specular && m->shininess == material->shininess &&
            memcmp(&m->colour, &material->colour, sizeof m->colour) == 0 &&
            m->roughness == material->roughness && m->metalness == material->metalness &&
            m->ior == material->ior && m->tint == material->tint && m->gate == material->gate)
            return i;
    }
    return -1;
}

void wr_material_grid(WrApp *app)
{
    const int pressed =
        wr_picture_grid(app, WR_THUMB_MATERIAL, "Material", WR_MATERIAL_PRESETS, TILE,
                        material_now(&wr_app_scene(app)->material), material_item);
    if (pressed >= 0) set_line(app, "material preset=", wr_material_presets[pressed].name);
}

static void model_item(const WrApp *app, int i, WrPictureItem *out)
{
    (void)app;
    const WrStockModel *model = &wr_stock_models[i];
    out->title = model->title, out->help = model->help;
    wr_text_addf(&out->lines,
                 "table 4x4\nmodel %s\nmaterial preset=clay\nlight preset studio\ntone soft\n"
                 "camera fill aspect=1\ndials aa=supersample samples=3 rays=4\n",
                 model->name);
}

/* Index of the model whose mesh the scene has, or -1. */
static int model_now(const WrScene *scene)
{
    const char *path = scene->triangles ? scene->triangles_path : NULL;
    const char *name = path ? strstr(path, "models/") : NULL;
    for (int i = 0; name && i < WR_STOCK_MODELS; i++) {
        const size_t length = strlen(wr_stock_models[i].name);
        if (strncmp(name + 7, wr_stock_models[i].name, length) == 0 && name[7 + length] == '.')
            return i;
    }
    return -1;
}

void wr_model_grid(WrApp *app)
{
    const int pressed = wr_picture_grid(app, WR_THUMB_MODEL, "Models", WR_STOCK_MODELS, TILE,
                                        model_now(wr_app_scene(app)), model_item);
    if (pressed < 0) return;
    set_line(app, "model ", wr_stock_models[pressed].name);
    wr_scene_refit(app);
}

static void light_item(const WrApp *app, int i, WrPictureItem *out)
{
    (void)app;
    const WrLightPreset *preset = &wr_light_presets[i];
    out->title = preset->title, out->help = preset->help;
    wr_text_addf(&out->lines, BALL "material preset=porcelain\nlight preset %s\n", preset->name);
}

void wr_light_grid(WrApp *app)
{
    const int pressed = wr_picture_grid(app, WR_THUMB_LIGHT, "Presets", WR_LIGHT_PRESETS, TILE,
                                        wr_light_preset_now(wr_app_scene(app)), light_item);
    if (pressed >= 0) set_line(app, "light preset ", wr_light_presets[pressed].name);
}

SDL_Texture *wr_picture_of(WrApp *app, WrThumbKind kind, int i)
{
    static void (*const items[WR_THUMB_KINDS])(
        const WrApp *, int, WrPictureItem *) = { [WR_THUMB_MATERIAL] = material_item,
                                                 [WR_THUMB_MODEL] = model_item,
                                                 [WR_THUMB_LIGHT] = light_item };
    WrPictureItem one = { 0 };
    if (!items[kind]) return NULL;
    items[kind](app, i, &one);
    SDL_Texture *texture = texture_of(app, kind, i, wr_gui_px(TILE), &one);
    wr_text_fini(&one.lines);
    return texture;
}

/* Material menu: a sphere for each material, rendered like the patch, one per frame of the window. */
#include "ui/panels/panel_presets.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_sdl_renderer.h"
#include "ui/toolkit/theme.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/material_preset.h"

#include <SDL.h>
#include <string.h>

#define TILE_UNITS 64
#define COLUMNS 4
#define GROUND 0.012f /* background of the list, linear */

struct WrPresetTiles {
    WrSession *session; /* session that renders the pictures; NULL: not yet */
    SDL_Texture *texture[WR_MATERIAL_PRESETS];
    int made; /* number of rendered pictures, failures included */
    int side; /* pixels */
};

static const char *const studio[] = {
    "table 4x4",
    "surface sphere",
    "camera orthographic eye=0,0,5 size=2.1",
    "light clear",
    "light directional to=-0.5,0.7,0.7 strength=0.9",
    "light directional to=0.9,0.1,0.25 strength=0.5",
    "light directional to=-0.8,-0.5,0.1 strength=0.25",
    "dials aa=supersample samples=4",
};

static bool start(WrPresetTiles *tiles, WrError *err)
{
    tiles->session = wr_session_new(NULL);
    bool good = true;
    for (size_t i = 0; good && i < sizeof studio / sizeof *studio; i++)
        good = wr_session_run(tiles->session, studio[i], err);
    return good;
}

/* Composite over the background outside the sphere. */
static void fill_over(const WrFrame *frame, size_t count, float *rgb)
{
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            rgb[3 * i + c] =
                wr_srgb_encode(frame->rgba[4 * i + c] + (1 - frame->rgba[4 * i + 3]) * GROUND);
}

static SDL_Texture *texture_of(SDL_Renderer *renderer, const WrFrame *frame, int side)
{
    const size_t count = (size_t)side * (size_t)side;
    float *rgb = wr_alloc(3 * count, sizeof *rgb);
    uint8_t *codes = wr_alloc(3 * count, 1);
    fill_over(frame, count, rgb);
    wr_image_codes(WR_PIXEL_U8, rgb, 3 * count, codes, NULL);
    SDL_Texture *texture =
        SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STATIC, side, side);
    if (texture) wr_gui_sdl_update(texture, NULL, codes, side * 3);
    wr_free(rgb);
    wr_free(codes);
    return texture;
}

/* Render the next missing picture. */
static void make_one(const WrApp *app, WrPresetTiles *tiles)
{
    WrError err;
    WrFrame frame;
    WrText line = { 0 };
    const int i = tiles->made++;
    wr_text_addf(&line, "material preset=%s", wr_material_presets[i].name);
    if ((tiles->session || start(tiles, &err)) &&
        wr_session_run(tiles->session, wr_text_get(&line), &err) &&
        wr_session_frame(tiles->session, tiles->side, tiles->side, 0, &frame, &err))
        tiles->texture[i] = texture_of(app->renderer, &frame, tiles->side);
    wr_text_fini(&line);
}

static void forget(WrApp *app)
{
    WrPresetTiles *tiles = app->presets;
    if (!tiles) return;
    for (int i = 0; i < WR_MATERIAL_PRESETS; i++) {
        if (tiles->texture[i]) SDL_DestroyTexture(tiles->texture[i]);
        tiles->texture[i] = NULL;
    }
    tiles->made = 0;
}

void wr_presets_free(WrApp *app)
{
    if (!app->presets) return;
    forget(app);
    if (app->presets->session) wr_session_free(app->presets->session);
    wr_free(app->presets);
    app->presets = NULL;
}

const WrPart wr_part_presets = { .forget = forget };

/* ---- the list ---- */

/* Index of the preset with the material's numbers, or -1. */
static int chosen(const WrMaterial *material)
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

static bool tile(const WrPresetTiles *tiles, int i, bool at_hand)
{
    const double side = wr_gui_px(TILE_UNITS);
    const WrMaterialPreset *preset = &wr_material_presets[i];
    if (i % COLUMNS) wr_gui_same_line(8);
    wr_gui_push_id(i);
    wr_gui_group_begin();
    const bool pressed = wr_gui_tile("tile", tiles->texture[i], side, at_hand, false) == 1;
    wr_gui_tip(preset->help);
    wr_gui_space(-4);
    wr_gui_text_cut(WR_FONT_SMALL, at_hand ? WR_COLOUR_TEXT : WR_COLOUR_LABEL, preset->title, side);
    wr_gui_group_end();
    wr_gui_pop_id();
    return pressed;
}

/* One more picture in each frame. */
static void make_next(WrApp *app, WrPresetTiles *tiles)
{
    const int side = wr_gui_px(TILE_UNITS);
    if (side != tiles->side) forget(app);
    tiles->side = side;
    if (tiles->made == WR_MATERIAL_PRESETS) return;
    make_one(app, tiles);
    wr_app_redraw(app);
}

static WrPresetTiles *tiles_of(WrApp *app)
{
    if (!app->presets) app->presets = wr_alloc(1, sizeof *app->presets);
    return app->presets;
}

SDL_Texture *wr_presets_picture(WrApp *app, int preset)
{
    WrPresetTiles *tiles = tiles_of(app);
    if (!tiles->texture[preset]) make_next(app, tiles);
    return tiles->texture[preset];
}

static void list(WrApp *app, WrPresetTiles *tiles, int at_hand)
{
    if (!wr_gui_popup_begin("materials")) return;
    make_next(app, tiles);
    wr_gui_width_at_least(COLUMNS * (TILE_UNITS + 8) + 12);
    int pressed = -1;
    for (int i = 0; i < WR_MATERIAL_PRESETS; i++)
        if (tile(tiles, i, i == at_hand)) pressed = i;
    if (pressed >= 0) {
        WrText line = { 0 };
        wr_text_addf(&line, "material preset=%s", wr_material_presets[pressed].name);
        wr_scene_run(app, &line);
        wr_text_fini(&line);
    }
    if (pressed >= 0 || wr_gui_escape_pressed()) wr_gui_popup_close();
    wr_gui_popup_end();
}

void wr_panel_presets(WrApp *app)
{
    WrPresetTiles *tiles = tiles_of(app);
    const int at_hand = chosen(&wr_app_scene(app)->material);
    wr_gui_label("Material");
    wr_gui_next_id("material");
    if (wr_gui_button(at_hand >= 0 ? wr_material_presets[at_hand].title : "of your own", false))
        wr_gui_popup_open("materials");
    wr_gui_tip("Material presets as pictures: a click sets all values of the material");
    list(app, tiles, at_hand);
}

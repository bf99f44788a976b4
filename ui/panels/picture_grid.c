#include "ui/panels/picture_grid.h"
#include "ui/app/jobs/job.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_rows.h"
#include "ui/toolkit/gui_sdl_renderer.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "base/memory.h"
#include "command/session.h"
#include "image/image.h"
#include "render/frame/frame.h"
#include "scene/light_preset.h"
#include "scene/material_preset.h"
#include "scene/stock_model.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>

#define GROUND 0.02f /* background of the pictures, linear */
#define GAP 6

typedef struct Picture {
    SDL_Texture *texture; /* owned; NULL: not made yet, or failed */
    bool tried;
} Picture;

struct WrPictures {
    WrJob *job;
    bool working;
    Picture list[WR_PICTURE_SETS][WR_PICTURES_MAX];
    int side[WR_PICTURE_SETS]; /* pixels */
};

/* ---- making a picture ---- */

typedef struct Work {
    char *lines, *path; /* owned */
    WrPictureSet set;
    int index, side, width, height;
    uint8_t *rgb; /* codes, owned; NULL: failed */
} Work;

static void drop(void *arg)
{
    Work *work = arg;
    wr_free(work->lines);
    wr_free(work->path);
    wr_free(work->rgb);
    wr_free(work);
}

static uint8_t *codes_of(const float *light, size_t count)
{
    uint8_t *codes = wr_alloc(count, 1);
    wr_image_codes(WR_PIXEL_U8, light, count, codes, NULL);
    return codes;
}

/* The frame over the background of the grid. */
static void take_frame(Work *work, const WrScene *scene, const WrFrame *frame)
{
    const size_t count = (size_t)work->side * (size_t)work->side;
    float *rgb = wr_alloc(3 * count, sizeof *rgb);
    for (size_t i = 0; i < count; i++) {
        float *out = rgb + 3 * i;
        for (int c = 0; c < 3; c++)
            out[c] = frame->rgba[4 * i + (size_t)c] + (1 - frame->rgba[4 * i + 3]) * GROUND;
        wr_tone_colour(&scene->tone, out);
        for (int c = 0; c < 3; c++) out[c] = wr_srgb_encode(out[c]);
    }
    work->width = work->height = work->side;
    work->rgb = codes_of(rgb, 3 * count);
    wr_free(rgb);
}

static void render(Work *work)
{
    WrSession *session = wr_session_new(NULL);
    WrFrame frame;
    bool good = true;
    for (char *at = work->lines, *next; good && *at; at = next) {
        next = at + strcspn(at, "\n");
        if (*next) *next++ = '\0';
        good = wr_session_run(session, at, NULL);
    }
    if (good && wr_session_frame(session, work->side, work->side, 0, &frame, NULL))
        take_frame(work, wr_session_document(session)->scene, &frame);
    wr_session_free(session);
}

static void read(Work *work)
{
    WrImage *image = wr_image_read(work->path, NULL);
    if (image && image->channels == 3) {
        work->width = image->width, work->height = image->height;
        work->rgb = codes_of(image->data, 3 * (size_t)image->width * (size_t)image->height);
    }
    wr_image_free(image);
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    (void)pool;
    (void)progress;
    Work *work = arg;
    if (work->lines) render(work);
    else read(work);
}

/* ---- the pictures that are there ---- */

static void forget_set(WrPictures *pictures, WrPictureSet set)
{
    for (int i = 0; i < WR_PICTURES_MAX; i++) {
        Picture *picture = &pictures->list[set][i];
        if (picture->texture) SDL_DestroyTexture(picture->texture);
        *picture = (Picture){ 0 };
    }
}

static void forget(WrApp *app)
{
    if (!app->pictures) return;
    for (int set = 0; set < WR_PICTURE_SETS; set++) forget_set(app->pictures, (WrPictureSet)set);
}

void wr_pictures_free(WrApp *app)
{
    if (!app->pictures) return;
    wr_job_free(app->pictures->job);
    forget(app);
    wr_free(app->pictures);
    app->pictures = NULL;
}

static void take(WrApp *app, WrPictures *pictures)
{
    Work *work = wr_job_take(pictures->job);
    if (!work) return;
    pictures->working = false;
    Picture *picture = &pictures->list[work->set][work->index];
    if (work->rgb && work->side == pictures->side[work->set] && !picture->texture) {
        picture->texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_RGB24,
                                             SDL_TEXTUREACCESS_STATIC, work->width, work->height);
        if (picture->texture) {
            SDL_SetTextureScaleMode(picture->texture, SDL_ScaleModeLinear);
            wr_gui_sdl_update(picture->texture, NULL, work->rgb, work->width * 3);
        }
    }
    drop(work);
    wr_app_redraw(app);
}

static void update(WrApp *app)
{
    if (app->pictures) take(app, app->pictures);
}

const WrPart wr_part_pictures = { .update = update, .forget = forget };

static WrPictures *pictures_of(WrApp *app, WrPictureSet set, int side)
{
    static const WrJobKind kind = { run, drop };
    if (!app->pictures) {
        app->pictures = wr_alloc(1, sizeof *app->pictures);
        app->pictures->job = wr_job_new(&kind, 1, app->job_event);
    }
    if (app->pictures->side[set] != side) forget_set(app->pictures, set);
    app->pictures->side[set] = side;
    return app->pictures;
}

/* Start on that picture unless another is being made. */
static void make(WrPictures *pictures, WrPictureSet set, int i, const WrPictureItem *item)
{
    if (pictures->working || pictures->list[set][i].tried) return;
    Work *work = wr_alloc(1, sizeof *work);
    *work = (Work){ .set = set, .index = i, .side = pictures->side[set] };
    if (item->lines.length) work->lines = wr_strdup(item->lines.data);
    else work->path = wr_strdup(wr_text_get((WrText *)&item->path));
    pictures->list[set][i].tried = pictures->working = true;
    wr_job_start(pictures->job, work);
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

int wr_picture_grid(WrApp *app, WrPictureSet set, const char *name, int count, double units,
                    int chosen, void (*item)(const WrApp *app, int i, WrPictureItem *out))
{
    const int gap = wr_gui_px(GAP), room = (int)wr_gui_available() + gap;
    const int fit = (int)(room / (double)(wr_gui_px(units) + gap) + 0.5),
              columns = fit < 1 ? 1 : fit;
    const int side = room / columns - gap; /* they fill the row */
    WrPictures *pictures =
        pictures_of(app, set, wr_gui_px(units)); /* of one size, shown in another */
    int pressed = -1;
    wr_gui_name_row(name);
    for (int i = 0; i < count && i < WR_PICTURES_MAX; i++) {
        WrPictureItem one = { 0 };
        item(app, i, &one);
        if (i % columns) wr_gui_same_line(GAP);
        wr_gui_push_id(i);
        if (wr_gui_will_see(side)) make(pictures, set, i, &one);
        if (tile(pictures->list[set][i].texture, &one, side, i == chosen, units >= CAPTION_FROM))
            pressed = i;
        wr_gui_pop_id();
        wr_text_fini(&one.lines);
        wr_text_fini(&one.path);
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
        wr_picture_grid(app, WR_PICTURES_MATERIALS, "Material", WR_MATERIAL_PRESETS, TILE,
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
    const int pressed = wr_picture_grid(app, WR_PICTURES_MODELS, "Models", WR_STOCK_MODELS, TILE,
                                        model_now(wr_app_scene(app)), model_item);
    if (pressed >= 0) set_line(app, "model ", wr_stock_models[pressed].name);
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
    const int pressed = wr_picture_grid(app, WR_PICTURES_LIGHTS, "Presets", WR_LIGHT_PRESETS, TILE,
                                        wr_light_preset_now(wr_app_scene(app)), light_item);
    if (pressed >= 0) set_line(app, "light preset ", wr_light_presets[pressed].name);
}

SDL_Texture *wr_picture_of(WrApp *app, WrPictureSet set, int i)
{
    static void (*const items[WR_PICTURE_SETS])(
        const WrApp *, int, WrPictureItem *) = { [WR_PICTURES_MATERIALS] = material_item,
                                                 [WR_PICTURES_MODELS] = model_item,
                                                 [WR_PICTURES_LIGHTS] = light_item };
    if (!items[set]) return NULL;
    WrPictures *pictures = pictures_of(app, set, wr_gui_px(TILE));
    WrPictureItem one = { 0 };
    items[set](app, i, &one);
    make(pictures, set, i, &one);
    wr_text_fini(&one.lines);
    wr_text_fini(&one.path);
    return pictures->list[set][i].texture;
}

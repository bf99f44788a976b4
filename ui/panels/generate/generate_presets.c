/* Presets of generators, in presets.wrinkle in the settings folder: the name as a comment, the command below, so that
   the file is also a script. Unknown lines are kept. */
#include "ui/panels/generate/generate_presets.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/settings.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/search_score.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_sdl_renderer.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/job.h"
#include "ui/app/jobs/edit_preview.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "document/document.h"
#include "field/field.h"
#include "generate/generator.h"
#include "system/path.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define FILE_MAX (1 << 22) /* bytes */

static void forget(WrGenerateState *hand)
{
    for (int i = 0; i < hand->presets.count; i++) {
        wr_free(hand->presets.data[i].name);
        wr_free(hand->presets.data[i].line);
    }
    hand->presets.count = 0;
}

static const WrGenerator *generator_of(const char *line)
{
    WrCall *call = NULL;
    WrError err;
    const WrGenerator *generator =
        wr_call_parse(line, false, &call, &err) && call->command ? wr_call_generator(call) : NULL;
    wr_call_free(call);
    return generator;
}

static void parse(WrGenerateState *hand, const char *text)
{
    char *name = NULL;
    while (*text) {
        size_t length = strcspn(text, "\r\n");
        char *line = wr_strndup(text, length);
        text += length + (text[length] != '\0');
        if (line[0] == '#') {
            wr_free(name);
            name = wr_strdup(line + strspn(line, "# "));
            name[strlen(name) < WR_GENERATE_NAME ? strlen(name) : WR_GENERATE_NAME - 1] = '\0';
        } else if (line[0] && name && hand->presets.count < WR_GENERATE_PRESETS) {
            wr_array_push(&hand->presets, ((WrGeneratePreset){ name, line, generator_of(line) }));
            name = line = NULL;
        }
        wr_free(line);
    }
    wr_free(name);
}

/* Read the file again, since another window may have added presets. False: it exists but is unreadable. */
static bool read_file(WrApp *app, WrError *err)
{
    char *path = wr_config_path("presets.wrinkle"), *bytes = NULL;
    size_t length;
    bool there = path && wr_path_is_there(path);
    bool good = !there || wr_file_read(path, FILE_MAX, &bytes, &length, err);
    if (good) {
        forget(app->generate);
        if (bytes) parse(app->generate, bytes);
    }
    wr_free(bytes);
    wr_free(path);
    return good;
}

static bool write_file(WrApp *app, WrError *err)
{
    const WrGenerateState *hand = app->generate;
    char *path = wr_config_path("presets.wrinkle");
    WrText text = { 0 };
    for (int i = 0; i < hand->presets.count; i++)
        wr_text_addf(&text, "# %s\n%s\n", hand->presets.data[i].name, hand->presets.data[i].line);
    bool good = path ? true : wr_fail(err, "no folder for settings: HOME is not set");
    if (good) wr_settings_make_folder();
    good = good && wr_file_write(path, wr_text_get(&text), text.length, err);
    wr_text_fini(&text);
    wr_free(path);
    return good;
}

void wr_generate_presets_find(WrApp *app)
{
    WrError err;
    if (app->generate->presets_known) return;
    app->generate->presets_known = true;
    if (!read_file(app, &err)) wr_app_fail(app, &err);
}

static int find(const WrGenerateState *hand, const WrGenerator *generator, const char *name)
{
    for (int i = 0; i < hand->presets.count; i++)
        if (hand->presets.data[i].generator == generator &&
            strcmp(hand->presets.data[i].name, name) == 0)
            return i;
    return -1;
}

/* Trim blanks and a leading #; control characters become blanks. */
static bool tidy(const char *name, char out[WR_GENERATE_NAME])
{
    SDL_utf8strlcpy(out, name + strspn(name, " #\t"), WR_GENERATE_NAME);
    for (char *c = out; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f) *c = ' ';
    for (size_t n = strlen(out); n > 0 && out[n - 1] == ' '; n--) out[n - 1] = '\0';
    return out[0] != '\0';
}

bool wr_generate_preset_taken(const WrApp *app, const char *name)
{
    char own[WR_GENERATE_NAME];
    return tidy(name, own) && find(app->generate, app->generate->generator, own) >= 0;
}

bool wr_generate_preset_save(WrApp *app, const char *name)
{
    WrGenerateState *hand = app->generate;
    WrError err;
    WrText line = { 0 };
    char own[WR_GENERATE_NAME];
    if (!hand->generator || !tidy(name, own)) return false;
    wr_generate_line(hand, &line);
    bool good = generator_of(wr_text_get(&line)) == hand->generator
                    ? read_file(app, &err)
                    : wr_fail(&err, "this cannot be made yet: the panel shows why");
    int i = good ? find(hand, hand->generator, own) : -1;
    if (good && i < 0 && hand->presets.count >= WR_GENERATE_PRESETS)
        good = wr_fail(&err, "there are %d presets: delete one first", WR_GENERATE_PRESETS);
    if (good && i < 0) {
        wr_array_push(&hand->presets,
                      ((WrGeneratePreset){ wr_strdup(own), NULL, hand->generator }));
        i = hand->presets.count - 1;
    }
    if (good) {
        wr_free(hand->presets.data[i].line);
        hand->presets.data[i].line = wr_strdup(wr_text_get(&line));
        hand->preset = i;
        good = write_file(app, &err);
    }
    if (!good) wr_app_fail(app, &err);
    wr_text_fini(&line);
    return good;
}

bool wr_generate_preset_delete(WrApp *app, int index)
{
    WrGenerateState *hand = app->generate;
    WrError err;
    if (index < 0 || index >= hand->presets.count) return false;
    char *name = wr_strdup(hand->presets.data[index].name);
    const WrGenerator *generator = hand->presets.data[index].generator;
    bool good = read_file(app, &err);
    int i = good ? find(hand, generator, name) : -1;
    wr_free(name);
    if (i >= 0) {
        WrGeneratePreset *list = hand->presets.data;
        wr_free(list[i].name);
        wr_free(list[i].line);
        memmove(list + i, list + i + 1, (size_t)(hand->presets.count - i - 1) * sizeof *list);
        hand->presets.count--;
        good = write_file(app, &err);
    }
    hand->preset = -2;
    if (!good) wr_app_fail(app, &err);
    return good;
}

/* ---- gallery of generators and presets ---- */

#define ITEMS_MAX 128
#define TILE_UNITS 76
#define COLUMNS 5
#define LIST_UNITS 470
#define TEXELS 384.0        /* approximate side of the table of a picture */
#define PLACED_TEXELS 192.0 /* for generators of one placed object */
#define STEEPNESS 0.07      /* height range divided by the table's side */
#define WRITTEN "Aa"

typedef struct Tile {
    const WrGenerator *generator;
    SDL_Texture *texture; /* owned; NULL: not ready, or failed */
    bool asked;
} Tile;

struct WrGallery {
    WrJob *job;
    Tile tiles[ITEMS_MAX];
    int count;
    int side;  /* texture size in pixels */
    int round; /* number of the request; results of older ones are dropped */
    char filter[64];
    bool fresh; /* just opened */
};

typedef struct Work {
    int index, round, side; /* tile index; size of its picture in pixels */
    int texels;             /* side of the table, a multiple of the picture's */
    /* command lines, owned: of the generator, of the first one in its family */
    char *line, *ground;
    uint32_t *argb; /* [side * side], owned; NULL: failed */
} Work;

static void drop(void *arg)
{
    Work *work = arg;
    wr_free(work->line);
    wr_free(work->ground);
    wr_free(work->argb);
    wr_free(work);
}

/* ---- on the worker thread ---- */

/* Run a line on a flat table, or on the result of `first`; NULL if the result is flat. */
static WrDocument *made(const Work *work, const char *first, WrPool *pool,
                        const WrProgress *progress)
{
    WrError err;
    WrText notes = { 0 };
    float low = 0.0f, high = 0.0f;
    WrField *level =
        wr_field_new(work->texels, work->texels, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, &err);
    if (!level) return NULL;
    WrDocument *document = wr_document_new();
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = level;
    bool good = (!first || wr_edit_preview_generate(document, first, WR_LINE_INTO_ACTIVE, true,
                                                    pool, progress, &notes, &err)) &&
                wr_edit_preview_generate(document, work->line, WR_LINE_INTO_ACTIVE, true, pool,
                                         progress, &notes, &err);
    if (good) wr_field_range(document->layers[0].heights, &low, &high);
    wr_text_fini(&notes);
    if (good && low < high) return document;
    wr_document_free(document);
    return NULL;
}

/* Shading from the upper left, scaled to a relief of STEEPNESS. */
static double light(const WrField *field, int i, int j, double steep)
{
    int w = wr_field_width(field), h = wr_field_height(field);
    double east = (double)wr_field_get(field, (i + 1) % w, j);
    double west = (double)wr_field_get(field, (i + w - 1) % w, j);
    double south = (double)wr_field_get(field, i, (j + 1) % h);
    double north = (double)wr_field_get(field, i, (j + h - 1) % h);
    double x = -(east - west) * steep, y = -(south - north) * steep;
    double facing = (-0.5 * x - 0.5 * y + 0.7071067811865476) / sqrt(x * x + y * y + 1.0);
    return 0.08 + 0.92 * (facing > 0.0 ? facing : 0.0);
}

static void shade(const WrField *field, const Work *work, uint32_t *argb)
{
    int step = work->texels / work->side;
    float low, high;
    wr_field_range(field, &low, &high);
    double steep = 0.5 * STEEPNESS * work->texels / ((double)high - (double)low);
    for (int y = 0; y < work->side; y++)
        for (int x = 0; x < work->side; x++) {
            double sum = 0.0;
            for (int j = 0; j < step; j++)
                for (int i = 0; i < step; i++)
                    sum += light(field, x * step + i, y * step + j, steep);
            uint32_t c = (uint32_t)fmin(255.0, floor(sum / (step * step) * 255.0 + 0.5));
            argb[y * work->side + x] = 0xff000000u | c << 16 | c << 8 | c;
        }
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    Work *work = arg;
    WrDocument *document = made(work, NULL, pool, progress);
    if (!document && work->ground) /* it may modify existing heights */
        document = made(work, work->ground, pool, progress);
    if (!document) return;
    work->argb = wr_alloc((size_t)work->side * (size_t)work->side, sizeof *work->argb);
    shade(document->layers[0].heights, work, work->argb);
    wr_document_free(document);
}

/* ---- on the window's thread ---- */

static WrGallery *gallery_of(WrApp *app)
{
    static const WrJobKind kind = { run, drop };
    if (app->generate->gallery) return app->generate->gallery;
    WrGallery *gallery = wr_alloc(1, sizeof *gallery);
    gallery->job = wr_job_new(&kind, 1, app->job_event);
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family && gallery->count < ITEMS_MAX; g++)
            gallery->tiles[gallery->count++].generator = g;
    return app->generate->gallery = gallery;
}

/* drop the textures; they are rendered again */
static void gallery_forget(WrApp *app)
{
    WrGallery *gallery = app->generate->gallery;
    if (!gallery) return;
    wr_job_cancel(gallery->job);
    gallery->round++;
    for (int i = 0; i < gallery->count; i++) {
        if (gallery->tiles[i].texture) SDL_DestroyTexture(gallery->tiles[i].texture);
        gallery->tiles[i].texture = NULL;
        gallery->tiles[i].asked = false;
    }
}

void wr_gallery_free(WrApp *app)
{
    WrGallery *gallery = app->generate ? app->generate->gallery : NULL;
    if (!gallery) return;
    gallery_forget(app);
    wr_job_free(gallery->job);
    wr_free(gallery);
    app->generate->gallery = NULL;
}

static void take(WrApp *app, WrGallery *gallery)
{
    Work *work = wr_job_take(gallery->job);
    if (!work) return;
    if (work->argb && work->round == gallery->round) {
        SDL_Texture *texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_ARGB8888,
                                                 SDL_TEXTUREACCESS_STATIC, work->side, work->side);
        if (texture) wr_gui_sdl_update(texture, NULL, work->argb, work->side * 4);
        gallery->tiles[work->index].texture = texture;
    }
    drop(work);
    wr_app_redraw(app);
}

static char *line_of(const WrGenerator *generator)
{
    WrText line = { 0 };
    wr_generate_default_line(generator, WRITTEN, &line);
    char *copy = wr_strdup(wr_text_get(&line));
    wr_text_fini(&line);
    return copy;
}

static void ask(WrGallery *gallery, int index)
{
    const WrGenerator *generator = gallery->tiles[index].generator;
    const WrGenerator *first = wr_family_find(generator->family)->rows;
    bool placed = wr_generator_param_find(generator, "at") >= 0;
    double step = floor((placed ? PLACED_TEXELS : TEXELS) / gallery->side + 0.5);
    Work *work = wr_alloc(1, sizeof *work);
    work->index = index;
    work->round = gallery->round;
    work->side = gallery->side;
    work->texels = gallery->side * (step > 1.0 ? (int)step : 1);
    work->line = line_of(generator);
    work->ground = first != generator ? line_of(first) : NULL;
    gallery->tiles[index].asked = true;
    wr_job_start(gallery->job, work);
}

static void go_on(WrApp *app, WrGallery *gallery)
{
    int side = wr_gui_px(TILE_UNITS);
    if (side != gallery->side) gallery_forget(app);
    gallery->side = side;
    take(app, gallery);
    for (int i = 0; i < gallery->count && !wr_job_busy(gallery->job, NULL, NULL); i++)
        if (!gallery->tiles[i].asked) ask(gallery, i);
}

/* ---- the list ---- */

static bool answers(const WrGenerator *generator, const char *query)
{
    char label[320];
    snprintf(label, sizeof label, "%.40s %.40s %.200s", generator->family, generator->label,
             generator->help);
    return wr_search_score(label, query) > 0 ||
           wr_search_score(wr_words(generator->label), query) > 0;
}

/* A tile and its name below; true if pressed. */
static bool tile(const WrApp *app, const Tile *tile, int id)
{
    double side = wr_gui_px(TILE_UNITS);
    wr_gui_push_id(id);
    wr_gui_group_begin();
    bool chosen = tile->generator == app->generate->generator;
    bool pressed = wr_gui_tile("tile", tile->texture, side, chosen, false) == 1;
    wr_gui_tip(tile->generator->help);
    wr_gui_space(-4);
    wr_gui_text_within(WR_FONT_SMALL, chosen ? WR_COLOUR_TEXT : WR_COLOUR_LABEL,
                       tile->generator->label, side);
    wr_gui_group_end();
    wr_gui_pop_id();
    return pressed;
}

/* Tiles that match the typed text, by family; `first` becomes the first one. Returns the pressed one, or NULL. */
static const WrGenerator *tiles(WrApp *app, const WrGallery *gallery, const WrGenerator **first)
{
    const WrGenerator *pressed = NULL;
    const char *family = NULL;
    int column = 0;
    for (int i = 0; i < gallery->count; i++) {
        const WrGenerator *g = gallery->tiles[i].generator;
        if (!answers(g, gallery->filter)) continue;
        if (!*first) *first = g;
        if (!family || strcmp(family, g->family) != 0) {
            wr_gui_heading(wr_family_find(g->family)->label);
            column = 0;
        }
        family = g->family;
        if (column++ % COLUMNS) wr_gui_same_line(8);
        if (tile(app, &gallery->tiles[i], i)) pressed = g;
    }
    if (!*first) wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "Nothing has these words.");
    return pressed;
}

void wr_gallery_open(WrApp *app)
{
    WrGallery *gallery = gallery_of(app);
    gallery->filter[0] = '\0';
    gallery->fresh = true;
    wr_gui_popup_open("gallery");
    app->redraw = WR_GENERATE_WAKE;
}

void wr_gallery_list(WrApp *app)
{
    if (!wr_gui_popup_begin("gallery")) return;
    WrGallery *gallery = gallery_of(app);
    const WrGenerator *first = NULL;
    go_on(app, gallery);
    wr_gui_width_at_least(COLUMNS * (TILE_UNITS + 8) + 30);
    bool enter =
        wr_gui_text_field("##filter", 0, gallery->filter, sizeof gallery->filter, gallery->fresh);
    wr_gui_tip("Only those that have these words");
    gallery->fresh = false;
    double most = app->height - wr_gui_px(150);
    wr_gui_list_begin("tiles", fmin(wr_gui_px(LIST_UNITS), most));
    const WrGenerator *chosen = tiles(app, gallery, &first);
    wr_gui_list_end();
    if (enter) chosen = first;
    if (chosen) {
        wr_generate_open(app, chosen);
        wr_gui_popup_close();
    } else if (wr_gui_escape_pressed()) {
        wr_gui_popup_close();
    }
    wr_gui_popup_end();
}

const WrPart wr_part_gallery = { .forget = gallery_forget };

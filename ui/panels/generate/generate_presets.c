/* Presets of generators, in presets.wrinkle in the settings folder: the name as a comment, the command below, so that
   the file is also a script. Unknown lines are kept. */
#include "ui/panels/generate/generate_presets.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/settings.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/search_score.h"
#include "ui/canvas/tools/preset_browser.h"
#include "ui/canvas/tools/thumbs.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "generate/generator.h"
#include "system/path.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define FILE_MAX (1 << 22) /* bytes */

void wr_generate_presets_forget(WrGenerateState *hand)
{
    for (int i = 0; i < hand->presets.count; i++) {
        wr_free(hand->presets.data[i].name);
        wr_free(hand->presets.data[i].line);
        wr_free(hand->presets.data[i].words);
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

/* shipped: names are followed by a colon and words for the search. */
static void parse(WrGenerateState *hand, const char *text, bool shipped)
{
    char *name = NULL;
    while (*text) {
        size_t length = strcspn(text, "\r\n");
        char *line = wr_strndup(text, length);
        text += length + (text[length] != '\0');
        if (line[0] == '#') {
            wr_free(name);
            name = wr_strndup(line + strspn(line, "# "), shipped ? length : WR_GENERATE_NAME - 1);
        } else if (line[0] && name && hand->presets.count < WR_GENERATE_PRESETS) {
            char *words = shipped ? strchr(name, ':') : NULL;
            if (words) *words = '\0';
            wr_array_push(&hand->presets,
                          ((WrGeneratePreset){ name, line, generator_of(line),
                                               words ? wr_strdup(words + 1) : NULL }));
            name = line = NULL;
        }
        wr_free(line);
    }
    wr_free(name);
}

/* Add the presets that ship with the program; a missing file is no error. */
static void read_shipped(WrApp *app)
{
    WrText path = { 0 };
    char *bytes = NULL;
    size_t length;
    if (wr_data_find("brushes/generators.wrinkle", &path) &&
        wr_file_read(wr_text_get(&path), FILE_MAX, &bytes, &length, NULL))
        parse(app->generate, bytes, true);
    wr_free(bytes);
    wr_text_fini(&path);
}

/* Read the files again, since another window may have added presets. False: the user's exists but is unreadable. */
static bool read_file(WrApp *app, WrError *err)
{
    char *path = wr_config_path("presets.wrinkle"), *bytes = NULL;
    size_t length;
    bool there = path && wr_path_is_there(path);
    bool good = !there || wr_file_read(path, FILE_MAX, &bytes, &length, err);
    if (good) {
        wr_generate_presets_forget(app->generate);
        if (bytes) parse(app->generate, bytes, false);
        read_shipped(app);
        app->shelf->serial++; /* places in the list changed, and so their thumbnails */
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
        if (!hand->presets.data[i].words)
            wr_text_addf(&text, "# %s\n%s\n", hand->presets.data[i].name,
                         hand->presets.data[i].line);
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
    if (read_file(app, &err)) return;
    wr_app_fail(app, &err);
    read_shipped(app);
}

void wr_generate_preset_open(WrApp *app, int index)
{
    char *line = wr_strdup(app->generate->presets.data[index].line);
    wr_generate_open(app, app->generate->presets.data[index].generator);
    wr_generate_load(app, line);
    app->generate->preset = index;
    wr_generate_changed(app);
    wr_free(line);
}

/* One of the user's own. */
static int find(const WrGenerateState *hand, const WrGenerator *generator, const char *name)
{
    for (int i = 0; i < hand->presets.count; i++)
        if (hand->presets.data[i].generator == generator && !hand->presets.data[i].words &&
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
                    : wr_fail(&err, "this cannot be applied yet: the panel shows why");
    int i = good ? find(hand, hand->generator, own) : -1;
    if (good && i < 0 && hand->presets.count >= WR_GENERATE_PRESETS)
        good = wr_fail(&err, "there are %d presets: delete one first", WR_GENERATE_PRESETS);
    if (good && i < 0) {
        wr_array_push(&hand->presets,
                      ((WrGeneratePreset){ wr_strdup(own), NULL, hand->generator, NULL }));
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
        wr_free(list[i].words);
        memmove(list + i, list + i + 1, (size_t)(hand->presets.count - i - 1) * sizeof *list);
        hand->presets.count--;
        good = write_file(app, &err);
    }
    hand->preset = -2;
    if (!good) wr_app_fail(app, &err);
    return good;
}

/* ---- gallery of generators ---- */

#define ITEMS_MAX 128
#define TILE_UNITS 76
#define COLUMNS 5
#define LIST_UNITS 470
#define WRITTEN "Aa"

struct WrGallery {
    const WrGenerator *tiles[ITEMS_MAX];
    int count;
    char filter[64];
    bool fresh; /* just opened */
};

static WrGallery *gallery_of(WrApp *app)
{
    if (app->generate->gallery) return app->generate->gallery;
    WrGallery *gallery = wr_alloc(1, sizeof *gallery);
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family && gallery->count < ITEMS_MAX; g++)
            gallery->tiles[gallery->count++] = g;
    return app->generate->gallery = gallery;
}

void wr_gallery_free(WrApp *app)
{
    wr_free(app->generate ? app->generate->gallery : NULL);
}

/* Thumbnail of a line, or of the generator's defaults (NULL). */
static SDL_Texture *picture(WrApp *app, WrThumbKind kind, int index, int side,
                            const WrGenerator *generator, const char *line)
{
    const WrGenerator *first = wr_family_find(generator->family)->rows;
    WrText own = { 0 }, ground = { 0 };
    if (!line) wr_generate_default_line(generator, WRITTEN, &own);
    if (first != generator) wr_generate_default_line(first, WRITTEN, &ground);
    const WrThumbSource of = { .line = line ? line : wr_text_get(&own),
                               .ground = ground.length > 0 ? wr_text_get(&ground) : NULL,
                               .placed = !line && wr_generator_param_find(generator, "at") >= 0 };
    SDL_Texture *texture = wr_thumb(app, kind, index, side, &of);
    wr_text_fini(&own);
    wr_text_fini(&ground);
    return texture;
}

SDL_Texture *wr_generate_preset_picture(WrApp *app, int index, int side)
{
    const WrGeneratePreset *preset = &app->generate->presets.data[index];
    return preset->generator
               ? picture(app, WR_THUMB_PRESET, index, side, preset->generator, preset->line)
               : NULL;
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
static bool tile(WrApp *app, const WrGenerator *generator, int id)
{
    double side = wr_gui_px(TILE_UNITS);
    wr_gui_push_id(id);
    wr_gui_group_begin();
    bool chosen = generator == app->generate->generator;
    SDL_Texture *texture = wr_gui_will_see(side)
                               ? picture(app, WR_THUMB_GENERATOR, id, (int)side, generator, NULL)
                               : NULL;
    bool pressed = wr_gui_tile("tile", texture, side, chosen, false) == 1;
    wr_gui_tip(generator->help);
    wr_gui_space(-4);
    wr_gui_text_within(WR_FONT_SMALL, chosen ? WR_COLOUR_TEXT : WR_COLOUR_LABEL, generator->label,
                       side);
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
        const WrGenerator *g = gallery->tiles[i];
        if (!answers(g, gallery->filter)) continue;
        if (!*first) *first = g;
        if (!family || strcmp(family, g->family) != 0) {
            wr_gui_heading(wr_family_find(g->family)->label);
            column = 0;
        }
        family = g->family;
        if (column++ % COLUMNS) wr_gui_same_line(8);
        if (tile(app, g, i)) pressed = g;
    }
    if (!*first) wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "Nothing matches these words.");
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
    wr_gui_width_at_least(COLUMNS * (TILE_UNITS + 8) + 30);
    bool enter =
        wr_gui_text_field("##filter", 0, gallery->filter, sizeof gallery->filter, gallery->fresh);
    wr_gui_tip("Shows only those that match these words");
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

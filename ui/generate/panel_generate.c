/* The Generate tab, built from the table of generators: generator, presets, messages. */
#include "ui/state/busy.h"
#include "ui/state/app_state.h"
#include "ui/state/dialog.h"
#include "ui/generate/generate_gallery.h"
#include "ui/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/jobs/edit_preview.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "generate/generator.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define CHOICES_MAX 64

/* ---- choice of the generator ---- */

static const WrFamily *family_of(const WrGenerator *generator)
{
    return generator ? wr_family_find(generator->family) : NULL;
}

static const WrFamily *choose_family(WrApp *app, double width)
{
    const WrFamily *families[CHOICES_MAX], *now = family_of(app->generate->generator);
    const char *labels[CHOICES_MAX];
    int count = 0, index = 0;
    for (const WrFamily *f = wr_families; f->name && count < CHOICES_MAX; f++) {
        if (!f->rows->family) continue;
        if (f == now) index = count;
        labels[count] = f->label;
        families[count++] = f;
    }
    if (count == 0) return NULL;
    if (wr_gui_choice("family", width, labels, count, &index) && families[index] != now)
        wr_generate_open(app, families[index]->rows);
    wr_gui_tip(families[index]->help);
    return families[index];
}

static void choose_generator(WrApp *app, const WrFamily *family)
{
    const char *labels[CHOICES_MAX];
    int count = 0, index = -1;
    for (const WrGenerator *g = family->rows; g->family && count < CHOICES_MAX; g++) {
        if (g == app->generate->generator) index = count;
        labels[count++] = g->label;
    }
    if (index < 0) index = 0;
    if (wr_gui_choice("generator", wr_gui_available() - wr_gui_px(30), labels, count, &index))
        wr_generate_open(app, &family->rows[index]);
    wr_gui_tip(family->rows[index].help);
    wr_gui_same_line(4);
    if (wr_gui_glyph("all", WR_ICON_GRID, 24, WR_COLOUR_LABEL)) wr_gallery_open(app);
    wr_gui_tip("Pictures of all that can be made");
    wr_gallery_list(app);
}

/* ---- presets ---- */

static void save_popup(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    if (!wr_gui_popup_begin("preset_name")) return;
    wr_gui_width_at_least(240);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, "Name of the preset");
    bool fresh = hand->name[0] == '\n';
    if (fresh) hand->name[0] = '\0';
    bool done = wr_gui_text_field("##name", wr_gui_px(220), hand->name, sizeof hand->name, fresh);
    bool taken = wr_generate_preset_taken(app, hand->name);
    if (taken) wr_gui_text(WR_FONT_SMALL, WR_COLOUR_CELL, "There is a preset of this name.");
    if (wr_gui_button(taken ? "Replace it" : "Save it", !taken) || (done && !taken)) {
        if (wr_generate_preset_save(app, hand->name)) wr_gui_popup_close();
    }
    wr_gui_popup_end();
}

static void take_preset(WrApp *app, int preset)
{
    WrGenerateState *hand = app->generate;
    if (preset < 0) {
        wr_generate_defaults(app);
    } else {
        char *line = wr_strdup(hand->presets.data[preset].line);
        wr_generate_load(app, line);
        hand->preset = preset;
        wr_free(line);
    }
    wr_generate_changed(app);
}

static void presets(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    const char *labels[WR_GENERATE_PRESETS + 2];
    int ids[WR_GENERATE_PRESETS + 2], count = 0, index = 0;
    wr_generate_presets_find(app);
    if (hand->preset >= hand->presets.count) hand->preset = -2;
    if (hand->preset == -2) {
        labels[count] = "Preset";
        ids[count++] = -2;
    }
    labels[count] = "Defaults";
    ids[count++] = -1;
    for (int i = 0; i < hand->presets.count; i++) {
        if (hand->presets.data[i].generator != hand->generator) continue;
        labels[count] = hand->presets.data[i].name;
        ids[count++] = i;
    }
    for (int i = 0; i < count; i++)
        if (ids[i] == hand->preset) index = i;
    wr_gui_space(2);
    if (wr_gui_choice("preset", wr_gui_available() - wr_gui_px(60), labels, count, &index) &&
        ids[index] != -2)
        take_preset(app, ids[index]);
    wr_gui_tip("Values to begin with: the defaults, and those you saved");
    wr_gui_same_line(4);
    if (wr_gui_glyph("save", WR_ICON_SAVE, 24, WR_COLOUR_LABEL)) {
        snprintf(hand->name, sizeof hand->name, "\n");
        wr_gui_popup_open("preset_name");
        app->redraw = WR_GENERATE_WAKE;
    }
    wr_gui_tip("Save these values as a preset");
    wr_gui_same_line(4);
    bool own = hand->preset >= 0;
    wr_gui_disable(!own);
    if (wr_gui_glyph("delete", WR_ICON_DELETE, 24, own ? WR_COLOUR_LABEL : WR_COLOUR_OFF))
        wr_generate_preset_delete(app, hand->preset);
    wr_gui_enable();
    wr_gui_tip(own ? "Delete this preset" : "Only presets of your own can be deleted");
    save_popup(app);
}

/* ---- messages ---- */

/* A required file that is not chosen yet is not an error. */
static bool lacks_file(const WrGenerateState *hand)
{
    return hand->blamed >= 0 && hand->generator->params[hand->blamed].kind == WR_PARAM_FILE &&
           !hand->value[hand->blamed].text[0];
}

/* The error without the generator's name, in the user's language. */
static const char *error_of(const WrGenerateState *hand, char said[WR_WORDS_MESSAGE])
{
    wr_words_message(wr_error_message(&hand->err), said, WR_WORDS_MESSAGE);
    const bool named =
        strncmp(said, hand->err.text, hand->blame) == 0; /* no word, not translated */
    return said + (named ? hand->blame : 0);
}

/* The error, or the notes of the preview; "" if there are none. */
static const char *notes(const WrApp *app, char said[WR_WORDS_MESSAGE])
{
    const WrGenerateState *hand = app->generate;
    if (lacks_file(hand)) return "Choose a file to begin.";
    if (hand->err.text[0]) return error_of(hand, said);
    return hand->active && app->trying ? wr_edit_preview_notes(app->trial) : "";
}

static void tell(const WrApp *app, const char *text)
{
    const bool bad = app->generate->err.text[0] && !lacks_file(app->generate);
    for (const char *at = text; *at;) {
        char line[260];
        size_t length = strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        wr_gui_text_wrapped(WR_FONT_SMALL, bad ? WR_COLOUR_BAD : WR_COLOUR_CELL, line);
        wr_gui_space(-4);
        at += length + (at[length] != '\0');
    }
}

/* ---- the tab ---- */

static void head(WrApp *app)
{
    double half = floor(wr_gui_available() * 0.38);
    const WrFamily *family = choose_family(app, half);
    if (!family) return;
    wr_gui_same_line(6);
    choose_generator(app, family);
    if (app->generate->generator) presets(app);
}

static SDL_Rect cut(SDL_Rect *room, int height, bool top)
{
    SDL_Rect part = *room;
    part.h = height < room->h ? height : room->h;
    room->h -= part.h;
    if (top) room->y += part.h;
    else part.y = room->y + room->h;
    return part;
}

/* Expected duration, if significant. */
static void expectation(const WrApp *app)
{
    WrText line = { 0 };
    char text[WR_EXPECTATION];
    if (!app->generate->generator || app->generate->err.text[0]) return;
    wr_generate_line(app->generate, &line);
    wr_expectation(app, wr_text_get(&line), text);
    wr_text_fini(&line);
    if (text[0]) wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
}

/* Errors and notes, or the expected duration, above the buttons. The space is reserved, so that the values do not
   move when a note appears or disappears. */
static void said(const WrApp *app, SDL_Rect *room)
{
    char said[WR_WORDS_MESSAGE];
    const char *text = notes(app, said);
    wr_gui_area_begin("##generate_notes", WR_AREA_PANEL, cut(room, wr_gui_px(42), false),
                      WR_COLOUR_BAR);
    if (*text) tell(app, text);
    else expectation(app);
    wr_gui_area_end();
}

static void foot(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    double fraction, seconds;
    bool busy = hand->active && app->trying &&
                wr_edit_preview_busy(app->trial, &fraction, &seconds) && seconds > 0.3;
    wr_busy_hold(app);
    wr_gui_disable(hand->err.text[0] != '\0');
    if (wr_gui_button(hand->active ? "Apply" : "Apply again", true)) wr_generate_commit(app);
    wr_gui_enable();
    wr_busy_hold_end();
    wr_gui_tip("Enter");
    wr_gui_same_line(8);
    if (hand->active) {
        if (wr_gui_button("Cancel", false)) wr_generate_cancel(app);
        wr_gui_tip("Escape: nothing was changed");
    } else {
        if (wr_gui_button("Show", false)) wr_generate_open(app, hand->generator);
        wr_gui_tip("Show a preview of it");
    }
    if (!busy) return;
    wr_gui_same_line(10);
    wr_gui_progress(0, fraction);
}

void wr_panel_generate(WrApp *app, SDL_Rect room)
{
    WrGenerateState *hand = app->generate;
    SDL_Rect top = cut(&room, wr_gui_px(82), true);
    SDL_Rect low = cut(&room, wr_gui_px(44), false);
    if (!hand->generator) wr_generate_take(app, wr_generate_last(app));
    wr_generate_blame(hand);
    said(app, &room);
    wr_gui_area_begin("##generate_head", WR_AREA_PANEL, top, WR_COLOUR_PANEL);
    head(app);
    wr_gui_area_end();
    if (room.h > wr_gui_px(20)) {
        char name[40]; /* each generator has its own scroll position */
        snprintf(name, sizeof name, "##generate_values%d", hand->opened % 64);
        wr_gui_area_begin(name, WR_AREA_PANEL, room, WR_COLOUR_LIST);
        wr_panel_generate_values(app);
        wr_gui_area_end();
    }
    wr_gui_area_begin("##generate_foot", WR_AREA_BAR, low, WR_COLOUR_BAR);
    foot(app);
    wr_gui_area_end();
}

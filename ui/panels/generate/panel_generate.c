/* The Generate tab, built from the table of generators: generator, presets, messages. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/generate/font_choice.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/files.h"
#include "ui/app/state/background_command.h"
#include "ui/panels/generate/generate_presets.h"
#include "ui/app/jobs/edit_preview.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/blend.h"
#include "document/document.h"
#include "generate/generator.h"
#include "image/font.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- values of the current generator and its blending, with errors below them ---- */

#define NOTES_UNITS 42  /* height of the notes */
#define SEED_LAST 999.0 /* largest seed of the button for the next seed */

/* Group of parameters starting at the named one, folded under a heading if other parameters come before it. */
typedef struct Group {
    const char *name, *title;
    bool number; /* only if the parameter is a number */
    bool open;   /* initially */
} Group;

static const Group groups[] = {
    { "uneven", "Variety", true, true },
    { "scatter", "Variety", true, true },
    { "altitude", "Lie of the land", true, true },
    { "warp_cells", "Warp and ridges", false, false },
    { "amplitude", "Height and place", true, true },
    { "fade", "Finer points", false, false },
    { "way", "Finer points", false, false },
    { "direction", "Script", false, false },
    { "face", "More settings of the font", false, false },
    { "align", "Lines and place", false, true },
    { "points", "Along a path", false, false },
    { "edge", "Relief", false, true },
    { "across", "Repeat", false, false },
    { "height", "Height and place", true, true },
};

static const char *unit_of(const WrParam *p)
{
    if (strcmp(p->unit, "degrees") == 0) return "\xc2\xb0";
    return p->unit[0] && strlen(p->unit) < 8 ? p->unit : NULL;
}

static WrNumber spec_of(const WrParam *p, int component)
{
    bool whole = p->kind == WR_PARAM_WHOLE, degrees = strcmp(p->unit, "degrees") == 0;
    bool fine = strcmp(p->unit, "texels") != 0 && p->soft_high <= 20.0;
    WrNumber spec = { .low = p->soft_low,
                      .high = p->soft_high,
                      .hard_low = p->low,
                      .hard_high = p->high,
                      .reset = p->fallback[component],
                      .decimals = whole     ? 0
                                  : degrees ? 1
                                  : fine    ? 3
                                            : 2,
                      .unit = unit_of(p),
                      .tip = p->help };
    bool unsaid = p->soft_low == p->low && p->low < 0.0 && spec.high > 0.0;
    if (unsaid && -spec.low > spec.high) spec.low = -spec.high; /* symmetric range */
    if (!(spec.low < spec.high)) spec.high = spec.low + 1.0;
    if (p->above && spec.low <= p->low) spec.low = p->low + (spec.high - p->low) / 1000.0;
    return spec;
}

static bool numbers(const WrParam *p, WrGenerateValue *value)
{
    int count = p->kind == WR_PARAM_TUPLE ? p->components : 1;
    double wide = (wr_gui_available() - (count - 1) * wr_gui_px(4)) / count;
    bool changed = false;
    for (int k = 0; k < count; k++) {
        char id[16];
        WrNumber spec = spec_of(p, k);
        if (count > 1) spec.unit = NULL;
        snprintf(id, sizeof id, "n%d", k);
        if (k > 0) wr_gui_same_line(4);
        if (wr_gui_number(id, k == count - 1 ? 0 : floor(wide), &spec, &value->number[k]) !=
            WR_EDIT_NONE) {
            value->number[k] = wr_line_round(value->number[k], 7);
            changed = true;
        }
    }
    return changed;
}

static bool choice(const WrParam *p, WrGenerateValue *value)
{
    int count = 0, index = (int)value->number[0];
    while (p->words[count]) count++;
    bool changed = wr_gui_choice("choice", 0, p->words, count, &index);
    value->number[0] = index;
    return changed;
}

static bool turn_switch(WrGenerateValue *value)
{
    bool on = value->number[0] != 0.0;
    bool changed = wr_gui_check("##switch", &on);
    value->number[0] = on ? 1.0 : 0.0;
    return changed;
}

/* A seed field with a button for the next seed. */
static bool seed(const WrParam *p, WrGenerateValue *value)
{
    WrNumber spec = spec_of(p, 0);
    double room = wr_gui_available() - wr_gui_px(30);
    bool changed = wr_gui_number("seed", room, &spec, &value->number[0]) != WR_EDIT_NONE;
    wr_gui_same_line(4);
    if (wr_gui_glyph("next", WR_ICON_DICE, 24, WR_COLOUR_LABEL)) {
        value->number[0] = value->number[0] < SEED_LAST ? value->number[0] + 1.0 : 0.0;
        changed = true;
    }
    wr_gui_tip("Another random variation: the next seed");
    return changed;
}

static bool file(WrApp *app, int i, const WrParam *p, WrGenerateValue *value)
{
    bool changed =
        wr_gui_hint_field("##file", p->fallback_text ? "none" : "a file",
                          wr_gui_available() - wr_gui_px(30), value->text, WR_GENERATE_TEXT);
    wr_gui_tip(value->text[0] ? value->text : p->help);
    wr_gui_same_line(4);
    if (wr_gui_glyph("choose", WR_ICON_FOLDER, 24, WR_COLOUR_LABEL)) {
        app->generate->asking_file = i;
        if (!wr_files_request_path(app->files, WR_FILE_GENERATE, NULL, ""))
            wr_dialog_open(app, WR_DIALOG_FILE);
    }
    wr_gui_tip("Choose a file");
    return changed;
}

static bool text(WrApp *app, WrGenerateValue *value)
{
    int *tries = &app->generate->focus_text;
    if (wr_gui_wants_text(app->gui)) *tries = 0;
    bool focus = *tries > 0;
    if (focus) (*tries)--;
    char typed[WR_GENERATE_TEXT];
    memcpy(typed, value->text, sizeof typed);
    bool changed = wr_gui_text_area("##text", 3, value->text, WR_GENERATE_TEXT, focus);
    /* while Ctrl is held */
    bool done = wr_gui_field_left() && wr_gui_key_pressed(SDL_SCANCODE_RETURN);
    if (wr_gui_field_left() && wr_gui_escape_pressed()) { /* leaves the field; the text stays */
        memcpy(value->text, typed, sizeof typed);
        changed = false;
    }
    if (done && !app->generate->err.text[0]) wr_generate_commit(app);
    return changed && !done;
}

/* The layers below the edited or the new one; a name that is not among them stays. */
static bool layer_choice(WrApp *app, WrGenerateValue *value)
{
    const WrDocument *document = wr_app_document(app);
    const int edited = app->generate->layer;
    const int count = edited >= 0 ? edited : document->active + !app->generate->into_active;
    const char *names[WR_LAYERS_MAX + 2] = { "none" };
    int index = value->text[0] ? -1 : 0, last = 1;
    for (int i = count - 1; i >= 0; i--) {
        if (strcmp(document->layers[i].name, value->text) == 0) index = last;
        names[last++] = document->layers[i].name;
    }
    if (index < 0) {
        index = last;
        names[last++] = value->text;
    }
    if (!wr_gui_choice("layer", 0, names, last, &index)) return false;
    wr_generate_set_text(value, index > 0 ? names[index] : "");
    return true;
}

static bool field(WrApp *app, int i, const WrParam *p, WrGenerateValue *value)
{
    switch (p->kind) {
    case WR_PARAM_NUMBER:
    case WR_PARAM_WHOLE:
    case WR_PARAM_TUPLE: return strcmp(p->name, "seed") == 0 ? seed(p, value) : numbers(p, value);
    case WR_PARAM_CHOICE:
        return p->words == wr_font_names ? wr_font_choice_row(app, i) : choice(p, value);
    case WR_PARAM_SWITCH: return turn_switch(value);
    case WR_PARAM_FILE: return file(app, i, p, value);
    case WR_PARAM_TEXT:
        if (p->layer) return layer_choice(app, value);
        return i == wr_generate_written(app->generate->generator)
                   ? text(app, value)
                   : wr_gui_hint_field("##text", "none", 0, value->text, WR_GENERATE_TEXT);
    case WR_PARAM_POINTS:
    case WR_PARAM_TERMS: break;
    }
    return wr_gui_hint_field("##list", p->shape ? p->shape : "u,v;u,v;...", 0, value->text,
                             WR_GENERATE_TEXT);
}

static bool parameter(WrApp *app, int i)
{
    WrGenerateState *hand = app->generate;
    const WrParam *p = &hand->generator->params[i];
    wr_gui_push_id(i);
    wr_gui_label(p->label);
    wr_gui_tip(p->help);
    bool changed = field(app, i, p, &hand->value[i]);
    if (p->kind != WR_PARAM_NUMBER && p->kind != WR_PARAM_WHOLE && p->kind != WR_PARAM_FILE)
        wr_gui_tip(p->help); /* other kinds show their own tip */
    wr_gui_pop_id();
    return changed;
}

static bool joining(WrGenerateState *hand)
{
    const char *labels[WR_BLEND_COUNT];
    bool changed = false;
    WrNumber radius = { .low = 0,
                        .high = 1,
                        .hard_high = 1e30,
                        .reset = 0.1,
                        .decimals = 3,
                        .tip = "Distance within which heights blend smoothly" };
    WrNumber offset = { .low = -1,
                        .high = 1,
                        .hard_low = -1e30,
                        .hard_high = 1e30,
                        .decimals = 3,
                        .tip = "Added to the heights before blending" };
    for (int i = 0; i < WR_BLEND_COUNT; i++) labels[i] = wr_blends[i].label;
    if (!wr_gui_fold("BLENDING", true)) return false;
    wr_gui_label("Blend");
    changed |= wr_gui_choice("blend", 0, labels, WR_BLEND_COUNT, &hand->blend);
    wr_gui_tip(wr_blends[hand->blend].help);
    if (wr_blends[hand->blend].uses_radius) {
        wr_gui_label("Radius");
        changed |= wr_gui_number("join_radius", 0, &radius, &hand->radius) != WR_EDIT_NONE;
    }
    wr_gui_label("Offset");
    changed |= wr_gui_number("join_offset", 0, &offset, &hand->offset) != WR_EDIT_NONE;
    return changed;
}

/* The group that starts at a parameter; NULL: none. */
static const Group *group_at(const WrGenerator *generator, int i)
{
    const WrParam *p = &generator->params[i];
    /* its height is set by its position */
    bool placed = wr_generator_param_find(generator, "at") >= 0;
    for (size_t k = 0; i > 0 && k < sizeof groups / sizeof *groups; k++) {
        if (strcmp(groups[k].name, p->name) != 0) continue;
        if (groups[k].number && (p->kind != WR_PARAM_NUMBER || placed)) continue;
        return &groups[k];
    }
    return NULL;
}

/* Number of values in the group that differ from their defaults. */
static int count_changed(const WrGenerateState *hand, int first, const Group *group)
{
    int count = 0;
    for (int i = first; hand->generator->params[i].name; i++) {
        const Group *other = group_at(hand->generator, i);
        if (other && strcmp(other->title, group->title) != 0) break;
        count += !wr_generate_param_is_default(hand, i);
    }
    return count;
}

/* Heading of a group; true while the group is open. */
static bool heading(const WrGenerateState *hand, int first, const Group *group)
{
    char label[96];
    int changed = count_changed(hand, first, group);
    if (changed > 0)
        snprintf(label, sizeof label, wr_words("%s (%d changed)###%s"), wr_words(group->title),
                 changed, group->title);
    else snprintf(label, sizeof label, "%s###%s", group->title, group->title);
    return wr_gui_fold(label, group->open);
}

/* The main parameters of a text are shown directly below it. */
static const char *const written_first[] = { "size", "height", "profile", "bevel" };

static bool comes_first(const WrGenerator *generator, int i)
{
    if (wr_generate_written(generator) < 0) return false;
    for (size_t k = 0; k < sizeof written_first / sizeof *written_first; k++)
        if (strcmp(generator->params[i].name, written_first[k]) == 0) return true;
    return false;
}

static bool parameters(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    const Group *group = NULL;
    bool changed = false, shown = true;
    for (int i = 0; hand->generator->params[i].name; i++) {
        if (comes_first(hand->generator, i)) continue;
        const Group *next = group_at(hand->generator, i);
        if (next && (!group || strcmp(next->title, group->title) != 0)) {
            group = next;
            shown = heading(hand, i, group);
        }
        if (shown) changed |= parameter(app, i);
        if (i != wr_generate_written(hand->generator)) continue;
        for (size_t k = 0; k < sizeof written_first / sizeof *written_first; k++) {
            int first = wr_generator_param_find(hand->generator, written_first[k]);
            if (first >= 0) changed |= parameter(app, first);
        }
    }
    return changed;
}

void wr_panel_generate_values(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    bool changed = parameters(app);
    changed |= joining(hand);
    if (wr_app_document(app)->selection)
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, "Only the selection changes.");
    if (!changed) return;
    hand->preset = -2;
    wr_generate_changed(app);
}

/* ---- choice of the generator ---- */

#define CHOICES_MAX 64

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
    wr_gui_tip("Pictures of all generators and presets");
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
    if (taken) wr_gui_text(WR_FONT_SMALL, WR_COLOUR_CELL, "A preset with this name exists.");
    if (wr_gui_button(taken ? "Replace it" : "Save it", !taken) || (done && !taken)) {
        if (wr_generate_preset_save(app, hand->name)) wr_gui_popup_close();
    }
    wr_gui_popup_end();
}

static void take_preset(WrApp *app, int preset)
{
    if (preset >= 0) {
        wr_generate_preset_open(app, preset);
        return;
    }
    wr_generate_defaults(app);
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
    wr_gui_tip("Presets: the defaults, and those you saved");
    wr_gui_same_line(4);
    if (wr_gui_glyph("save", WR_ICON_SAVE, 24, WR_COLOUR_LABEL)) {
        snprintf(hand->name, sizeof hand->name, "\n");
        wr_gui_popup_open("preset_name");
        app->redraw = WR_GENERATE_WAKE;
    }
    wr_gui_tip("Save these values as a preset");
    wr_gui_same_line(4);
    bool own = hand->preset >= 0 && !hand->presets.data[hand->preset].words;
    wr_gui_disable(!own);
    if (wr_gui_glyph("delete", WR_ICON_DELETE, 24, own ? WR_COLOUR_LABEL : WR_COLOUR_OFF))
        wr_generate_preset_delete(app, hand->preset);
    wr_gui_disable_end();
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

/* Expected duration, if significant, else "". */
static void expectation(const WrApp *app, char text[WR_EXPECTATION])
{
    WrText line = { 0 };
    text[0] = '\0';
    if (!app->generate->generator || app->generate->err.text[0]) return;
    wr_generate_line(app->generate, &line);
    wr_expectation(app, wr_text_get(&line), text);
    wr_text_fini(&line);
}

/* Errors and notes, or the expected duration, above the buttons. Without any, the values have the room; returns the height
   in units that they then need below the last value, so that their scroll position never changes with the notes. */
static double said(const WrApp *app, SDL_Rect *room)
{
    char said[WR_WORDS_MESSAGE], expected[WR_EXPECTATION];
    const char *text = notes(app, said);
    expectation(app, expected);
    if (!*text && !*expected) return NOTES_UNITS;
    wr_gui_area_begin("##generate_notes", WR_AREA_PANEL, cut(room, wr_gui_px(NOTES_UNITS), false),
                      WR_COLOUR_BAR);
    if (*text) tell(app, text);
    else wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, expected);
    wr_gui_area_end();
    return 0;
}

/* Where the result goes: the name of the edited layer, or the choice. */
static void destination(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    const WrDocument *document = wr_app_document(app);
    if (hand->layer >= 0) {
        char text[WR_LAYER_NAME_MAX + 40];
        snprintf(text, sizeof text, wr_words("Layer: %s"), document->layers[hand->layer].name);
        wr_gui_as_it_is(true);
        wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_LABEL, text, wr_gui_available());
        wr_gui_as_it_is(false);
        return;
    }
    static const char *const labels[] = { "New layer", "Active layer" };
    int index = wr_generate_target(hand) == WR_LINE_INTO_ACTIVE;
    if (wr_gui_choice("destination", wr_gui_available(), labels, 2, &index)) {
        hand->into_active = index == 1;
        wr_generate_changed(app);
    }
    wr_gui_tip(index == 1 ? "Paints it into the active layer, inside the selection"
                          : "Adds it as a generator layer: its values can be changed at any time");
}

static void foot(WrApp *app)
{
    WrGenerateState *hand = app->generate;
    double fraction, seconds;
    bool busy = hand->active && app->trying &&
                wr_edit_preview_busy(app->trial, &fraction, &seconds) && seconds > 0.3;
    destination(app);
    wr_busy_hold(app);
    wr_gui_disable(hand->err.text[0] != '\0');
    if (wr_gui_button("Apply", true)) wr_generate_commit(app);
    wr_gui_disable_end();
    wr_busy_hold_end();
    wr_gui_tip(wr_generate_writes(app) ? "Enter; while you type the text, Ctrl+Enter" : "Enter");
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
    SDL_Rect low = cut(&room, wr_gui_px(80), false);
    if (!hand->generator) wr_generate_take(app, wr_generate_last(app));
    wr_generate_blame(hand);
    const double below = said(app, &room);
    wr_gui_area_begin("##generate_head", WR_AREA_PANEL, top, WR_COLOUR_PANEL);
    head(app);
    wr_gui_area_end();
    if (room.h > wr_gui_px(20)) {
        char name[40]; /* each generator has its own scroll position */
        snprintf(name, sizeof name, "##generate_values%d", hand->opened % 64);
        wr_gui_area_begin(name, WR_AREA_PANEL, room, WR_COLOUR_LIST);
        wr_gui_pinnable(true);
        wr_panel_generate_values(app);
        wr_gui_pinnable(false);
        wr_gui_space(below);
        wr_gui_area_end();
    }
    wr_gui_area_begin("##generate_foot", WR_AREA_PANEL, low, WR_COLOUR_BAR);
    foot(app);
    wr_gui_area_end();
}

/* SPDX-License-Identifier: MIT
   The Generate tab, made from the generators' table: which one, its values, how it joins what is there. */
#include "ui/generate_hand.h"

#include "base/memory.h"
#include "command/generate.h"
#include "ui/line.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define CHOICES_MAX 64

/* ---- which one ---- */

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
    if (wr_gui_choice("generator", 0, labels, count, &index))
        wr_generate_open(app, &family->rows[index]);
    wr_gui_tip(family->rows[index].help);
}

/* ---- presets ---- */

static void save_popup(WrApp *app)
{
    WrGenerateHand *hand = app->generate;
    if (!wr_gui_popup_begin("preset_name")) return;
    wr_gui_width_at_least(240);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, "Name of the preset");
    bool fresh = hand->name[0] == '\n';
    if (fresh) hand->name[0] = '\0';
    bool done = wr_gui_text_field("##name", wr_gui_px(220), hand->name, sizeof hand->name, fresh);
    if (wr_gui_button("Save it", true) || done) {
        if (wr_generate_preset_save(app, hand->name)) wr_gui_popup_close();
    }
    wr_gui_popup_end();
}

static void take_preset(WrApp *app, int preset)
{
    WrGenerateHand *hand = app->generate;
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
    WrGenerateHand *hand = app->generate;
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
    }
    wr_gui_tip("Save these values as a preset");
    wr_gui_same_line(4);
    bool own = hand->preset >= 0;
    wr_gui_disable(!own);
    if (wr_gui_glyph("delete", WR_ICON_DELETE, 24, own ? WR_COLOUR_LABEL : 0xff5c5c5cu))
        wr_generate_preset_delete(app, hand->preset);
    wr_gui_enable();
    wr_gui_tip(own ? "Delete this preset" : "Only presets of your own can be deleted");
    save_popup(app);
}

/* ---- parameters ---- */

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
    if (spec.low < -100.0 * fabs(spec.high)) spec.low = -spec.high; /* as wide to either side */
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

static bool file(WrApp *app, int i, const WrParam *p, WrGenerateValue *value)
{
    bool changed =
        wr_gui_hint_field("##file", p->fallback_text ? "none" : "a file",
                          wr_gui_available() - wr_gui_px(30), value->text, WR_GENERATE_TEXT);
    wr_gui_tip(value->text[0] ? value->text : p->help);
    wr_gui_same_line(4);
    if (wr_gui_glyph("choose", WR_ICON_FOLDER, 24, WR_COLOUR_LABEL)) {
        app->generate->asking_file = i;
        if (!wr_files_ask(app->files, WR_FILE_GENERATE, NULL, ""))
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
    bool done = wr_gui_field_left() && wr_gui_key_pressed(SDL_SCANCODE_RETURN); /* with Ctrl */
    if (wr_gui_field_left() && wr_gui_escape_pressed()) { /* only leaves it: what was typed stays */
        memcpy(value->text, typed, sizeof typed);
        changed = false;
    }
    if (done && !app->generate->err.text[0]) wr_generate_commit(app);
    return changed && !done;
}

static bool parameter(WrApp *app, int i)
{
    WrGenerateHand *hand = app->generate;
    const WrParam *p = &hand->generator->params[i];
    WrGenerateValue *value = &hand->value[i];
    bool changed = false;
    wr_gui_push_id(i);
    wr_gui_label(p->label);
    switch (p->kind) {
    case WR_PARAM_NUMBER:
    case WR_PARAM_WHOLE:
    case WR_PARAM_TUPLE: changed = numbers(p, value); break;
    case WR_PARAM_CHOICE: changed = choice(p, value); break;
    case WR_PARAM_SWITCH: changed = turn_switch(value); break;
    case WR_PARAM_TEXT:
        changed = i == wr_generate_written(hand->generator)
                      ? text(app, value)
                      : wr_gui_hint_field("##text", "none", 0, value->text, WR_GENERATE_TEXT);
        break;
    case WR_PARAM_FILE: changed = file(app, i, p, value); break;
    case WR_PARAM_POINTS:
    case WR_PARAM_TERMS:
        changed = wr_gui_hint_field("##list", p->shape ? p->shape : "u,v;u,v;...", 0, value->text,
                                    WR_GENERATE_TEXT);
        break;
    }
    if (p->kind != WR_PARAM_NUMBER && p->kind != WR_PARAM_WHOLE && p->kind != WR_PARAM_FILE)
        wr_gui_tip(p->help);
    wr_gui_pop_id();
    return changed;
}

static bool joining(WrGenerateHand *hand)
{
    const char *labels[WR_BLEND_COUNT];
    bool changed = false;
    WrNumber radius = { .low = 0,
                        .high = 1,
                        .hard_high = 1e30,
                        .reset = 0.1,
                        .decimals = 3,
                        .tip = "How far from each other heights flow together" };
    WrNumber offset = { .low = -1,
                        .high = 1,
                        .hard_low = -1e30,
                        .hard_high = 1e30,
                        .decimals = 3,
                        .tip = "Added to its heights first" };
    for (int i = 0; i < WR_BLEND_COUNT; i++) labels[i] = wr_blends[i].label;
    wr_gui_space(4);
    wr_gui_heading("HOW IT JOINS THE LAYER");
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

/* What it has to say; "" if nothing. */
static const char *notes(const WrApp *app)
{
    const WrGenerateHand *hand = app->generate;
    if (hand->err.text[0]) return hand->err.text;
    return hand->active && app->trying ? wr_trial_notes(app->trial) : "";
}

/* One line each, the whole where the pointer rests. */
static void tell(const WrApp *app, const char *text)
{
    bool bad = app->generate->err.text[0] != '\0';
    for (const char *at = text; *at;) {
        char line[260];
        size_t length = strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        wr_gui_text_cut(WR_FONT_SMALL, bad ? WR_COLOUR_BAD : WR_COLOUR_CELL, line,
                        wr_gui_available());
        wr_gui_tip(line);
        wr_gui_space(-4);
        at += length + (at[length] != '\0');
    }
}

static void body(WrApp *app)
{
    WrGenerateHand *hand = app->generate;
    bool changed = false;
    const WrDocument *document = wr_app_document(app);
    for (int i = 0; hand->generator->params[i].name; i++) changed |= parameter(app, i);
    changed |= joining(hand);
    if (document->selection)
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, "Only what is selected changes.");
    if (!changed) return;
    hand->preset = -2;
    wr_generate_changed(app);
}

/* ---- the tab ---- */

static void head(WrApp *app)
{
    double half = floor(wr_gui_available() * 0.42);
    const WrFamily *family = choose_family(app, half);
    if (!family) return;
    wr_gui_same_line(6);
    choose_generator(app, family);
    if (app->generate->generator) presets(app);
}

static void foot(WrApp *app)
{
    WrGenerateHand *hand = app->generate;
    double fraction, seconds;
    bool busy = hand->active && app->trying && wr_trial_busy(app->trial, &fraction, &seconds) &&
                seconds > 0.3;
    wr_gui_disable(hand->err.text[0] != '\0');
    if (wr_gui_button(hand->active ? "Apply" : "Apply again", true)) wr_generate_commit(app);
    wr_gui_enable();
    wr_gui_tip("Enter");
    wr_gui_same_line(8);
    if (hand->active) {
        if (wr_gui_button("Cancel", false)) wr_generate_cancel(app);
        wr_gui_tip("Escape: nothing was changed");
    } else {
        if (wr_gui_button("Show", false)) wr_generate_open(app, hand->generator);
        wr_gui_tip("Show what it would make");
    }
    if (!busy) return;
    wr_gui_same_line(10);
    wr_gui_progress(0, fraction);
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

void wr_panel_generate(WrApp *app, SDL_Rect room)
{
    WrGenerateHand *hand = app->generate;
    SDL_Rect top = cut(&room, wr_gui_px(82), true);
    SDL_Rect low = cut(&room, wr_gui_px(44), false);
    const char *said = notes(app);
    if (!hand->generator) wr_generate_take(app, wr_generate_last(app));
    if (*said) {
        SDL_Rect told = cut(&room, wr_gui_px(42), false);
        wr_gui_area_begin("##generate_notes", WR_AREA_PANEL, told, WR_COLOUR_BAR);
        tell(app, said);
        wr_gui_area_end();
    }
    wr_gui_area_begin("##generate_head", WR_AREA_PANEL, top, WR_COLOUR_PANEL);
    head(app);
    wr_gui_area_end();
    if (room.h > wr_gui_px(20)) {
        wr_gui_area_begin("##generate_values", WR_AREA_PANEL, room, 0xff292929u);
        body(app);
        wr_gui_area_end();
    }
    wr_gui_area_begin("##generate_foot", WR_AREA_BAR, low, WR_COLOUR_BAR);
    foot(app);
    wr_gui_area_end();
}

/* Dialog of a live mask: its terms, one below the other. Each change is a command line, and so an undo step. */
#include "ui/app/state/background_command.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panels.h"

#include "base/text.h"
#include "command/command_line.h"
#include "command/command_table.h"
#include "command/live_masks.h"
#include "document/document.h"
#include "field/field.h"

#include <math.h>
#include <string.h>

#define WORDS_MAX 16 /* kinds, or words of a choice */

/* Labels of arguments; a name without one is its own label. */
static const char *label_of(const char *name)
{
    static const char *const labels[][2] = { { "low", "From" },        { "high", "To" },
                                             { "soft", "Softness" },   { "angle", "Azimuth" },
                                             { "scale", "Size" },      { "reach", "Reach" },
                                             { "rough", "Roughness" }, { "cells", "Cells" },
                                             { "octaves", "Octaves" }, { "seed", "Seed" },
                                             { "side", "Side" },       { "of", "Layer" },
                                             { "op", "Joins by" },     { "invert", "Inverted" } };
    for (size_t i = 0; i < sizeof labels / sizeof *labels; i++)
        if (strcmp(labels[i][0], name) == 0) return labels[i][1];
    return name;
}

/* ---- changes ---- */

/* Replace term `index` by these words; index = count: a new one. Empty words: it is removed. While a value is dragged, only
   the preview changes. */
static void put_term(WrApp *app, const WrMaskTerms *terms, int index, const char *words,
                     WrEdit edit)
{
    WrText all = { 0 }, line = { 0 };
    for (int i = 0; i < terms->count + (index == terms->count); i++) {
        const WrMaskTerms one = { .count = 1, .calls = { terms->calls[i] } };
        if (i == index && !words[0]) continue;
        if (all.length) wr_text_add(&all, "; ");
        if (i == index) wr_text_add(&all, words);
        else wr_mask_terms_print(&one, &all);
    }
    wr_text_addf(&line, "layer mask %d live=", wr_app_document(app)->active + 1);
    wr_text_add_word(&line, all.length ? wr_text_get(&all) : "off");
    wr_app_try_command(app, edit, wr_text_get(&line));
    wr_text_fini(&all);
    wr_text_fini(&line);
}

/* Change one argument of a term; value NULL: it is left out. */
static void put_value(WrApp *app, const WrMaskTerms *terms, int index, int arg, const char *value,
                      WrEdit edit)
{
    WrCall *term = terms->calls[index];
    const char *name = term->specs[arg].name;
    WrText words = { 0 };
    bool good = true;
    if (value) {
        wr_text_addf(&words, "%s=", name);
        wr_text_add_word(&words, value);
        good = wr_call_change(term, wr_text_get(&words), NULL);
    } else {
        wr_arg_fini(&term->args[arg]);
    }
    wr_text_clear(&words);
    const WrMaskTerms one = { .count = 1, .calls = { term } };
    wr_mask_terms_print(&one, &words);
    if (good) put_term(app, terms, index, wr_text_get(&words), edit);
    wr_text_fini(&words);
}

/* Words of a new term: defaults, and where one is needed a range or a layer. */
static void words_of_kind(const WrApp *app, const char *kind, WrText *words)
{
    const WrDocument *document = wr_app_document(app);
    wr_text_add(words, kind);
    if (strcmp(kind, "mask") == 0 && document->active > 0) {
        wr_text_add(words, " of=");
        wr_text_add_word(words, document->layers[document->active - 1].name);
    }
    if (strcmp(kind, "slope") == 0) wr_text_add(words, " low=20"); /* its default is everything */
    if (strcmp(kind, "height") == 0) {
        float low, high;
        WrField *below = wr_document_below(document, document->active, NULL);
        wr_field_range(below, &low, &high);
        wr_field_free(below);
        wr_line_number(words, "low", wr_line_round(((double)low + (double)high) / 2.0, 3));
        wr_line_number(words, "high", wr_line_round((double)high + 0.0005, 3));
    }
}

/* ---- rows ---- */

/* A number of the term; `otherwise` if it has none of that name. */
static double number_of(const WrCall *term, const char *name, double otherwise)
{
    for (int i = 0; i < term->count; i++)
        if (strcmp(term->specs[i].name, name) == 0 && term->args[i].numbers)
            return term->args[i].numbers[0];
    return otherwise;
}

static bool number_row(WrApp *app, const WrMaskTerms *terms, int index, int arg)
{
    const WrCall *term = terms->calls[index];
    const WrArgSpec *spec = &term->specs[arg];
    double value = wr_call_number(term, spec->name);
    /* of heights and the like, enough for the value that is given */
    const double some = fabs(value) > 1.0 && fabs(value) < 1000.0 ? ceil(fabs(value)) : 1.0;
    const double most = spec->unit ? 32.0 : spec->whole ? 64.0 : some;
    WrNumber number = { .low = spec->low < -1000.0 ? -most : spec->low,
                        .high = spec->high < 1000.0 && !spec->unit ? spec->high : most,
                        .hard_low = spec->above ? 0.01 : spec->low,
                        .hard_high = spec->high,
                        .reset = spec->fallback ? *spec->fallback : 0.0,
                        .decimals = spec->whole ? 0 : -1,
                        .unit = spec->unit };
    /* the ends of a range do not cross */
    if (strcmp(spec->name, "low") == 0)
        number.hard_high = number_of(term, "high", number.hard_high);
    if (strcmp(spec->name, "high") == 0) number.hard_low = number_of(term, "low", number.hard_low);
    for (int i = 0; strcmp(spec->name, "soft") == 0 && i < term->count; i++)
        if (strcmp(term->specs[i].name, "high") == 0 && term->specs[i].high < 1000.0)
            number.high = term->specs[i].high; /* it fades in the units of the range */
    const WrEdit edit = wr_gui_number(spec->name, 0, &number, &value);
    if (edit == WR_EDIT_NONE) return false;
    WrText text = { 0 };
    wr_text_add_number(&text, wr_line_round(value, 6));
    put_value(app, terms, index, arg, wr_text_get(&text), edit);
    wr_text_fini(&text);
    return edit == WR_EDIT_DONE; /* the terms stay while it is dragged */
}

static bool choice_row(WrApp *app, const WrMaskTerms *terms, int index, int arg)
{
    const WrCall *term = terms->calls[index];
    const WrArgSpec *spec = &term->specs[arg];
    const char *words[WORDS_MAX];
    int count = 0, chosen = wr_call_choice(term, spec->name);
    while (count < WORDS_MAX && spec->words[count]) {
        words[count] = wr_words(spec->words[count]);
        count++;
    }
    if (!wr_gui_choice(spec->name, 0, words, count, &chosen)) return false;
    put_value(app, terms, index, arg, spec->words[chosen], WR_EDIT_DONE);
    return true;
}

/* The layers below, nearest first, and unless one is required all together. */
static bool layer_row(WrApp *app, const WrMaskTerms *terms, int index, int arg)
{
    const WrDocument *document = wr_app_document(app);
    const WrCall *term = terms->calls[index];
    const char *names[WR_LAYERS_MAX + 1];
    const int first = term->specs[arg].required ? 0 : 1;
    int count = 0, chosen = 0;
    bool found = false;
    if (first) names[count++] = wr_words("All below");
    for (int i = document->active - 1; i >= 0; i--, count++) {
        names[count] = document->layers[i].name;
        if (!found && term->args[arg].given && strcmp(names[count], term->args[arg].text) == 0) {
            chosen = count;
            found = true;
        }
    }
    wr_gui_as_it_is(true);
    const bool changed = wr_gui_choice("of", 0, names, count, &chosen);
    wr_gui_as_it_is(false);
    if (changed)
        put_value(app, terms, index, arg, chosen < first ? NULL : names[chosen], WR_EDIT_DONE);
    return changed;
}

static bool value_rows(WrApp *app, const WrMaskTerms *terms, int index)
{
    const WrCall *term = terms->calls[index];
    for (int i = 0; i < term->count; i++) {
        const WrArgSpec *spec = &term->specs[i];
        if (index == 0 && strcmp(spec->name, "op") == 0) continue; /* there is nothing to join */
        wr_gui_label(label_of(spec->name));
        if (spec->type == WR_ARG_NUMBER && number_row(app, terms, index, i)) return true;
        if (spec->type == WR_ARG_CHOICE && choice_row(app, terms, index, i)) return true;
        if (spec->type == WR_ARG_LAYER && layer_row(app, terms, index, i)) return true;
    }
    return false;
}

static bool term_rows(WrApp *app, const WrMaskTerms *terms, int index)
{
    const char *kinds[WORDS_MAX];
    int count = 0, kind = terms->calls[index]->form;
    for (const char *name; count < WORDS_MAX && (name = wr_mask_kind(count)); count++)
        kinds[count] = wr_words(name);
    wr_gui_push_id(index);
    wr_gui_label("Mask by");
    bool changed = wr_gui_choice("kind", 0, kinds, count, &kind);
    if (changed) {
        WrText words = { 0 };
        words_of_kind(app, wr_mask_kind(kind), &words);
        if (index > 0) {
            const WrCall *term = terms->calls[index];
            for (int i = 0; i < term->count; i++)
                if (strcmp(term->specs[i].name, "op") == 0 && term->args[i].given)
                    wr_text_addf(&words, " op=%s", term->specs[i].words[term->args[i].choice]);
        }
        put_term(app, terms, index, wr_text_get(&words), WR_EDIT_DONE);
        wr_text_fini(&words);
    }
    changed = changed || value_rows(app, terms, index);
    if (!changed && terms->count > 1 && wr_gui_button("Remove this term", false)) {
        put_term(app, terms, index, "", WR_EDIT_DONE);
        changed = true;
    }
    wr_gui_space(8);
    wr_gui_pop_id();
    return changed;
}

void wr_dialog_mask(WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayer *layer = &document->layers[document->active];
    WrMaskTerms terms = { 0 };
    if (!layer->mask_line || !wr_mask_terms_parse(layer->mask_line, &terms, NULL)) {
        wr_dialog_close(app);
        return;
    }
    if (wr_gui_dialog_begin_at("Live mask", wr_dialog_side(app))) {
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            "It follows the layers below. Terms are combined in order.");
        wr_gui_space(4);
        bool changed = false;
        wr_busy_hold(app);
        for (int i = 0; i < terms.count && !changed; i++) changed = term_rows(app, &terms, i);
        if (!changed && terms.count < WR_MASK_TERMS && wr_gui_button("Add a term", false))
            put_term(app, &terms, terms.count, "noise", WR_EDIT_DONE);
        wr_busy_hold_end();
        wr_dialog_close_button(app, "Done");
        if (app->dialog->now == WR_DIALOG_NONE) wr_app_try_end(app);
        wr_gui_dialog_end();
    }
    wr_mask_terms_free(&terms);
}

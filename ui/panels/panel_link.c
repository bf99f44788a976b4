/* Dialog of a linked copy's values. Each change is a command line, and so an undo step. */
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/line.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/panels.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "base/text.h"
#include "command/command_line.h"
#include "command/linked_copies.h"
#include "document/document.h"

#include <string.h>

/* A number of an argument, as a row; its limits are the argument's. */
static const struct {
    const char *argument, *label;
    int part;
    WrNumber number;
} rows[] = {
    { "shift", "Shift u", 0, { .low = -1, .high = 1, .decimals = 3 } },
    { "shift", "Shift v", 1, { .low = -1, .high = 1, .decimals = 3 } },
    { "turn", "Turn", 0, { .low = -180, .high = 180, .decimals = 1, .unit = "degrees" } },
    { "scale",
      "Scale u",
      0,
      { .low = -2, .high = 2, .reset = 1, .decimals = 2, .tip = "Negative values mirror" } },
    { "scale",
      "Scale v",
      1,
      { .low = -2, .high = 2, .reset = 1, .decimals = 2, .tip = "Negative values mirror" } },
    { "factor",
      "Height",
      0,
      { .low = -2, .high = 2, .reset = 1, .decimals = 2, .tip = "Factor of all heights" } },
};

static void change(WrApp *app, const char *words, WrEdit edit)
{
    WrText line = { 0 };
    wr_text_addf(&line, "layer set %d change=", wr_app_document(app)->active + 1);
    wr_text_add_word(&line, words);
    wr_app_try_command(app, edit, wr_text_get(&line));
    wr_text_fini(&line);
}

static void put_number(WrApp *app, const WrCall *call, const char *name, int part, double value,
                       WrEdit edit)
{
    const int index = (int)(wr_call_arg(call, name) - call->args);
    const int count = wr_arg_width(&call->specs[index]);
    WrText words = { 0 };
    wr_text_addf(&words, "%s=", name);
    for (int k = 0; k < count; k++) {
        if (k) wr_text_add(&words, ",");
        wr_text_add_number(&words,
                           k == part ? wr_line_round(value, 6) : call->args[index].numbers[k]);
    }
    change(app, wr_text_get(&words), edit);
    wr_text_fini(&words);
}

/* All layers but filters, the copy itself and the groups that it is in, from the top. */
static bool layer_row(WrApp *app, const WrCall *call)
{
    const WrDocument *document = wr_app_document(app);
    const char *names[WR_LAYERS_MAX + 1];
    const WrArg *source = &call->args[0];
    int count = 0, chosen = -1;
    for (int i = document->layer_count - 1; i >= 0; i--) {
        if (i == document->active || document->layers[i].filter.op ||
            wr_document_is_within(document, document->active, i))
            continue;
        names[count] = document->layers[i].name;
        if (chosen < 0 && strcmp(names[count], source->text) == 0) chosen = count;
        count++;
    }
    if (chosen < 0) { /* it is gone */
        names[count] = source->text;
        chosen = count++;
    }
    wr_gui_label("Copy of");
    wr_gui_as_it_is(true);
    const bool changed = wr_gui_choice("source", 0, names, count, &chosen);
    wr_gui_as_it_is(false);
    if (!changed) return false;
    WrText words = { 0 };
    wr_text_add_word(&words, names[chosen]);
    change(app, wr_text_get(&words), WR_EDIT_DONE);
    wr_text_fini(&words);
    return true;
}

static bool number_rows(WrApp *app, const WrCall *call)
{
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const WrArg *arg = wr_call_arg(call, rows[i].argument);
        const WrArgSpec *spec = &call->specs[arg - call->args];
        WrNumber number = rows[i].number;
        number.hard_low = spec->low;
        number.hard_high = spec->high;
        double value = arg->numbers[rows[i].part];
        wr_gui_label(rows[i].label);
        const WrEdit edit = wr_gui_number(rows[i].label, 0, &number, &value);
        if (edit == WR_EDIT_NONE) continue;
        put_number(app, call, rows[i].argument, rows[i].part, value, edit);
        if (edit == WR_EDIT_DONE) return true;
    }
    return false;
}

void wr_dialog_link(WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const WrLayer *layer = &document->layers[document->active];
    WrCall *call = NULL;
    if (!wr_line_links(layer->line) || !wr_call_parse(layer->line, false, &call, NULL)) {
        wr_dialog_close(app);
        return;
    }
    if (wr_gui_dialog_begin_at("Linked copy", wr_dialog_side(app))) {
        wr_gui_text_wrapped(
            WR_FONT_SMALL, WR_COLOUR_LABEL,
            "It follows the heights of its layer or group. Blend, opacity and mask are its "
            "own.");
        wr_gui_space(4);
        wr_busy_hold(app);
        if (!layer_row(app, call)) number_rows(app, call);
        wr_busy_hold_end();
        wr_dialog_close_button(app, "Done");
        if (app->dialog->now == WR_DIALOG_NONE) wr_app_try_end(app);
        wr_gui_dialog_end();
    }
    wr_call_free(call);
}

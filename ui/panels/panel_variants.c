/* Variants: a row above the layers' list, and the dialog of a name. Each change is a command line. */
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/session_view.h"
#include "ui/panels/panel_layers.h"
#include "ui/panels/panels.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"

#include "base/text.h"
#include "command/command_line.h"
#include "command/variants.h"
#include "document/document.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>

bool wr_is_variant(const WrApp *app)
{
    return wr_app_document(app)->variant != NULL;
}

bool wr_is_variant_changed(const WrApp *app)
{
    return wr_variant_differs(wr_app_document(app));
}

static void run(WrApp *app, const char *verb, const char *name, const char *other)
{
    WrText line = { 0 };
    wr_text_addf(&line, "variant %s ", verb);
    wr_text_add_word(&line, name);
    if (other) wr_text_add(&line, " "), wr_text_add_word(&line, other);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* ---- the row ---- */

static void menu(WrApp *app)
{
    if (wr_gui_glyph("variant_menu", WR_ICON_MORE, 24, WR_COLOUR_TEXT))
        wr_gui_popup_open("variants");
    wr_gui_tip("Add, rename and delete variants");
    if (!wr_gui_popup_begin("variants")) return;
    wr_menu_item(app, WR_ACT(variant_add));
    wr_menu_item(app, WR_ACT(variant_set));
    wr_menu_item(app, WR_ACT(variant_rename));
    wr_menu_item(app, WR_ACT(variant_delete));
    wr_gui_popup_end();
}

void wr_panel_variants(WrApp *app)
{
    const WrDocument *document = wr_app_document(app);
    const char *labels[WR_VARIANTS_MAX + 1];
    char names[WR_VARIANTS_MAX][WR_VARIANT_NAME_MAX + 1], changed[WR_VARIANT_NAME_MAX + 3];
    const int count = wr_variant_count(document);
    const bool differs = wr_variant_differs(document);
    const int used = document->variant ? wr_variant_find(document, document->variant) : -1;
    for (int i = 0; i < count; i++) {
        wr_variant_name(document, i, names[i]);
        labels[i] = names[i];
    }
    /* other values than those of any variant are an entry of their own, so that choosing the variant restores its values */
    snprintf(changed, sizeof changed, "%s *", used >= 0 ? names[used] : "");
    labels[count] = used >= 0 ? changed : wr_words("None in use");
    const int now = used >= 0 && !differs ? used : count;
    int chosen = now;
    wr_gui_label("Variant");
    wr_gui_as_it_is(true);
    const bool uses = wr_gui_choice("variant", wr_gui_available() - wr_gui_px(64), labels,
                                    count + (now == count), &chosen);
    wr_gui_as_it_is(false);
    wr_gui_tip(differs ? "The layers differ from this variant: choose it to restore them"
                       : "Applies a variant to all layers");
    if (uses && chosen < count) {
        run(app, "use", names[chosen], NULL);
        return;
    }
    wr_gui_same_line(8);
    wr_gui_disable(!differs);
    if (wr_gui_glyph("variant_set", WR_ICON_SAVE, 24, differs ? WR_COLOUR_CELL : WR_COLOUR_OFF))
        wr_action_run(app, WR_ACT(variant_set));
    wr_gui_disable_end();
    wr_gui_tip("Stores the layers' settings in this variant");
    wr_gui_same_line(8);
    menu(app);
}

/* ---- actions ---- */

static void ask_name(WrApp *app, bool renames, const char *name)
{
    app->layers->renames_variant = renames;
    SDL_utf8strlcpy(app->layers->variant, name, sizeof app->layers->variant);
    wr_dialog_open(app, WR_DIALOG_VARIANT);
}

void wr_act_variant_add(WrApp *app)
{
    char name[40];
    int number = wr_variant_count(wr_app_document(app));
    do snprintf(name, sizeof name, wr_words("variant %d"), ++number);
    while (wr_variant_find(wr_app_document(app), name) >= 0);
    ask_name(app, false, name);
}

void wr_act_variant_set(WrApp *app)
{
    wr_app_run_line(app, "variant set");
}

void wr_act_variant_rename(WrApp *app)
{
    ask_name(app, true, wr_app_document(app)->variant);
}

void wr_act_variant_delete(WrApp *app)
{
    run(app, "delete", wr_app_document(app)->variant, NULL);
}

void wr_dialog_variant(WrApp *app)
{
    WrLayersState *hand = app->layers;
    const char *old = wr_app_document(app)->variant;
    const bool renames = hand->renames_variant;
    if (renames && !old) { /* undone meanwhile */
        wr_dialog_close(app);
        return;
    }
    if (!wr_gui_dialog_begin(renames ? "Rename variant" : "New variant", 380)) return;
    if (!renames)
        wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL,
                            "A variant stores visibility, blend mode, opacity and the settings of "
                            "generators, filters and live masks of each layer.");
    wr_gui_space(4);
    wr_gui_label("Name");
    const bool enter =
        wr_gui_text_field("##name", 0, hand->variant, sizeof hand->variant, app->dialog->fresh);
    int answer = wr_dialog_buttons(app, renames ? "Rename" : "Store", hand->variant[0] != '\0');
    if (enter && answer == 0 && hand->variant[0]) {
        answer = 1;
        wr_dialog_close(app);
    }
    wr_gui_dialog_end();
    if (answer <= 0) return;
    if (!renames) run(app, "add", hand->variant, NULL);
    else if (strcmp(old, hand->variant) != 0) run(app, "rename", old, hand->variant);
}

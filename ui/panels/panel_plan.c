/* Plan panel: decisions of the planner for the last picture, with reasons and costs. */
#include "ui/app/state/app_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panel_layer_plan.h"
#include "ui/panels/panels.h"
#include "ui/patch/patch.h"
#include "ui/patch/preview/preview.h"

#include "base/enum_rows.h"
#include "render/plan/plan.h"

#include <stdio.h>

/* Toggle of a row: the picture without the effect, or with it; a second press restores the plan. */
static void eye(WrApp *app, int effect, bool runs)
{
    WrPreviewLook *look = &app->patch->look;
    const bool forced = look->force && (int)look->effect == effect;
    wr_gui_push_id(effect);
    if (wr_gui_icon_button("eye", runs ? WR_ICON_EYE : WR_ICON_EYE_OFF, 18, forced)) {
        look->effect = (WrEffect)effect;
        look->force = forced ? WR_FORCE_NONE : runs ? WR_FORCE_OFF : WR_FORCE_ON;
    }
    wr_gui_pop_id();
    wr_gui_tip(forced ? "As the plan has it again"
               : runs ? "The picture without it, to compare; another click switches it on again"
                      : "The picture with it, to compare");
    wr_gui_same_line(6);
}

/* True if the picture can be rendered both ways. */
static bool has_eye(const WrPlanRow *row, const WrEffectInfo *info)
{
    return row->verdict != WR_VERDICT_NONE && !(row->run && info->only_way);
}

static void effect(WrApp *app, int i, const WrPlanRow *e)
{
    WR_ROWS(proofs);
    static const char *const proofs[] = { [WR_ROW(WR_PROOF_IDENTICAL)] = "same bits",
                                          [WR_ROW(WR_PROOF_BOUNDED)] = "bounded",
                                          [WR_ROW(WR_PROOF_POLICY)] = "by choice" };
    WR_ROWS_END(proofs, WR_PROOF_COUNT);
    char text[240];
    if (has_eye(e, &wr_effects[i])) eye(app, i, e->run);
    const double room = wr_gui_available() - wr_gui_px(76); /* beside its time */
    const bool wide = wr_gui_text_width(WR_FONT_TEXT, e->name) > room;
    wr_gui_text(wide ? WR_FONT_SMALL : WR_FONT_TEXT, e->run ? WR_COLOUR_STRONG : WR_COLOUR_MUTED,
                e->name);
    if (e->run && e->ns_per_pixel > 0.0) {
        snprintf(text, sizeof text, "%.3g ns", e->ns_per_pixel);
        wr_gui_same_line(8);
        wr_gui_move_to(wr_gui_width() - wr_gui_text_width(WR_FONT_SMALL, text) - wr_gui_px(24));
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
        wr_gui_tip("Nanoseconds a pixel, measured in the last picture");
    }
    wr_gui_space(-6);
    /* The proof applies to the planner's own decision, not to an effect that the user disabled. */
    if (e->run || e->verdict == WR_VERDICT_RUN)
        snprintf(text, sizeof text, "%s", wr_words(e->reason));
    else snprintf(text, sizeof text, "%s: %s", wr_words(proofs[e->proof]), wr_words(e->reason));
    wr_gui_text_wrapped(WR_FONT_SMALL, e->run ? WR_COLOUR_LABEL : WR_COLOUR_FAINT, text);
    wr_gui_tip(e->rule);
    wr_gui_space(4);
}

/* True if the row belongs to the list of running effects. A toggled row stays in its list, under the pointer. */
static bool belongs(const WrApp *app, int effect, bool runs)
{
    const WrPreviewLook *look = &app->patch->look;
    return look->force && (int)look->effect == effect ? look->force == WR_FORCE_OFF : runs;
}

void wr_panel_plan(WrApp *app)
{
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    if (picture->serial == 0) {
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "No picture yet.");
        return;
    }
    char words[WR_PICTURE_WORDS];
    wr_picture_words(picture, words);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, words);
    for (int pass = 0; pass < 2; pass++) {
        if (!wr_gui_fold(pass == 0 ? "RUNS" : "LEFT OUT", pass == 0)) continue;
        for (int i = 0; i < WR_EFFECT_COUNT; i++)
            if (belongs(app, i, picture->plan.rows[i].run) == (pass == 0))
                effect(app, i, &picture->plan.rows[i]);
    }
    wr_panel_layer_plan(app);
}

/* What the planner decided for the last picture, with its reasons and prices. */
#include "ui/desk/desk.h"
#include "ui/gui/gui.h"
#include "ui/gui/theme.h"
#include "ui/panels/panels.h"
#include "ui/preview/preview.h"

#include "base/rows.h"
#include "render/plan.h"

#include <stdio.h>

static void effect(const WrPlanRow *e)
{
    WR_ROWS(proofs);
    static const char *const proofs[] = { [WR_ROW(WR_PROOF_IDENTICAL)] = "same bits",
                                          [WR_ROW(WR_PROOF_BOUNDED)] = "bounded",
                                          [WR_ROW(WR_PROOF_POLICY)] = "by choice" };
    WR_ROWS_END(proofs, WR_PROOF_COUNT);
    char text[96];
    wr_gui_text(WR_FONT_TEXT, e->run ? WR_COLOUR_STRONG : 0xff868686u, e->name);
    wr_gui_same_line(8);
    snprintf(text, sizeof text, "%s, %s", e->rule, e->run ? "runs" : proofs[e->proof]);
    wr_gui_text(WR_FONT_SMALL, e->run ? WR_COLOUR_ACCENT : 0xff868686u, text);
    if (e->run && e->ns_per_pixel > 0.0) {
        snprintf(text, sizeof text, "%.3g ns", e->ns_per_pixel);
        wr_gui_same_line(8);
        wr_gui_move_to(wr_gui_width() - wr_gui_text_width(WR_FONT_SMALL, text) - wr_gui_px(24));
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, text);
        wr_gui_tip("Nanoseconds a pixel, measured in the last picture");
    }
    wr_gui_space(-6);
    wr_gui_text_wrapped(WR_FONT_SMALL, e->run ? WR_COLOUR_LABEL : 0xff767676u, e->reason);
    wr_gui_space(4);
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
        wr_gui_heading(pass == 0 ? "RUNS" : "LEFT OUT");
        wr_gui_space(2);
        for (int i = 0; i < WR_EFFECT_COUNT; i++)
            if (picture->plan.rows[i].run == (pass == 0)) effect(&picture->plan.rows[i]);
        wr_gui_space(8);
    }
}

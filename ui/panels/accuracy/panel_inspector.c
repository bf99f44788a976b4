/* Inspector: all quantities of the formulas under the pointer, on the patch or on the table. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/panels/accuracy/accuracy_work.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"

#include "scene/scene.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>

/* ---- position ---- */

/* A patch parameter that `repeat` maps to the table position `t`, 0..1; false if there is none. */
static bool parameter_at(double t, double repeat, double *out)
{
    *out = repeat > 0 ? t / repeat : repeat < 0 ? (t - 1) / repeat : 0.5;
    return *out >= 0 && *out <= 1;
}

void wr_inspector_follow(WrApp *app)
{
    WrInspector *in = &app->accuracy->inspector;
    const WrInputRouter *hand = app->hand;
    const SDL_Rect *room = &app->layout->patch;
    double u, v;
    if (!app->settings->inspector || in->pinned || hand->grab != WR_GRAB_NONE) return;
    if (hand->on_patch && room->w > 0) {
        in->on_table = false;
        in->x = (hand->at.x - room->x) / room->w;
        in->y = (hand->at.y - room->y) / room->h;
        in->have = true;
    } else if (hand->on_canvas &&
               parameter_at(hand->at.u - floor(hand->at.u), app->accuracy->scene->replicate_u,
                            &u) &&
               parameter_at(hand->at.v - floor(hand->at.v), app->accuracy->scene->replicate_v,
                            &v)) {
        in->on_table = true;
        in->x = u;
        in->y = v;
        in->have = true;
    }
}

/* ---- the table ---- */

static void values(const WrProbeRow *row, double wide)
{
    const double pad = wr_gui_px(10), from = wide * 0.24;
    const double column = (wide - from - pad) / 3;
    for (int k = 0; k < row->count; k++) {
        char text[40], number[24];
        snprintf(text, sizeof text, "%s%s%s", wr_accuracy_probe_number_text(row->value[k], number),
                 row->unit[0] && k == row->count - 1 ? " " : "",
                 k == row->count - 1 ? row->unit : "");
        double end = from + column * (k + 1);
        wr_gui_row_set_cursor(end - wr_gui_text_width(WR_FONT_SMALL, text), 0);
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_STRONG, text);
    }
}

static void table(const WrInspector *in)
{
    WrProbeRow rows[WR_PROBE_ROWS];
    const int count = wr_accuracy_probe_rows(&in->probe, in->seen, rows);
    for (int i = 0; i < count; i++) {
        wr_gui_row_begin(i, 20, false);
        wr_gui_tip(rows[i].help);
        const double wide = wr_gui_row_width();
        wr_gui_row_set_cursor(wr_gui_px(10), 0);
        wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, rows[i].name, wide * 0.3);
        values(&rows[i], wide);
        wr_gui_row_end();
    }
    if (!in->seen) {
        wr_gui_space(6);
        wr_gui_text_wrapped(
            WR_FONT_SMALL, WR_COLOUR_LABEL,
            "This point is not visible: no footprint, level, samples and intensity.");
    }
}

void wr_panel_inspector(WrApp *app)
{
    const WrInspector *in = &app->accuracy->inspector;
    wr_gui_next_id("pin");
    if (wr_gui_chip(in->pinned ? WR_ICON_LOCK : WR_ICON_UNLOCK, in->pinned ? "pinned" : "follows"))
        wr_action_run(app, WR_ACT(inspector_pin));
    wr_gui_tip("Follows the pointer over the patch and the table, or stays at its point while the "
               "scene changes");
    wr_gui_same_line(6);
    wr_gui_disable(!in->known);
    wr_gui_next_id("copy");
    if (wr_gui_chip(WR_ICON_COPY, in->copied ? "copied" : "copy"))
        wr_action_run(app, WR_ACT(inspector_copy));
    wr_gui_disable_end();
    wr_gui_tip("Copies everything with all digits, as text");
    if (!in->have || !in->known) {
        wr_gui_space(4);
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            in->have && !in->on_table ? "Nothing is there."
                                                      : "Point at the patch, or at the table.");
        return;
    }
    wr_gui_same_line(10);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, in->on_table ? "table" : "patch");
    if (in->object[0]) {
        wr_gui_same_line(10);
        wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_STRONG, in->object, wr_gui_available());
    }
    wr_gui_space(2);
    table(in);
}

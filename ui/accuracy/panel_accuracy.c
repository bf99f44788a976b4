/* The Accuracy tab: picture of the patch, error and time, cost of other dials, the dials. */
#include "ui/accuracy/accuracy.h"
#include "ui/accuracy/accuracy_work.h"
#include "ui/state/action.h"
#include "ui/state/action_list.h"
#include "ui/state/app_state.h"
#include "ui/state/layout.h"
#include "ui/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/preview/preview.h"
#include "accuracy/plot.h"
#include "base/error.h"
#include "base/enum_rows.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- picture of the patch ---- */

static void show(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    int look = (int)a->look;
    wr_gui_label("Patch shows");
    if (wr_gui_choice("look", 0, wr_patch_look_names, WR_PATCH_LOOKS, &look))
        wr_accuracy_show(app, (WrPatchLook)look);
    wr_gui_tip(
        "A is the scene with its own dials, B has dials of its own. Split has a line to drag. Maps "
        "lie over the patch: its distance from the reference, the error of the small-F "
        "approximation of the paper, the angle by which the normal turns, the number of texels in "
        "a "
        "pixel. The patch stands still for all of them. Effects that ran have the colours of the "
        "plan, and are as live as the picture.");
}

/* ---- numbers in two columns ---- */

typedef struct Cell {
    WrColour colour; /* colour of the disc before the name; 0: none */
    const char *name, *tip;
    char value[32];
} Cell;

static void cell(const Cell *c, double from, double wide)
{
    wr_gui_move_to(from);
    if (c->colour) {
        wr_gui_swatch(c->colour, 3.5 * wr_gui_scale(), 0);
        wr_gui_same_line(5);
    }
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, c->name);
    wr_gui_tip(c->tip);
    wr_gui_same_line(0);
    wr_gui_move_to(from + wide - wr_gui_text_width(WR_FONT_SMALL, c->value));
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_STRONG, c->value);
    wr_gui_tip(c->tip);
}

static void cells(const Cell *left, const Cell *right)
{
    const double from = wr_gui_place(), gap = wr_gui_px(16);
    const double wide = floor((wr_gui_available() - gap) / 2);
    cell(left, from, wide);
    wr_gui_same_line(0);
    cell(right, from + wide + gap, wide);
    wr_gui_space(-7);
}

/* ---- error ---- */

/* One line that is always there, so that nothing below it jumps: why the numbers are not this view's. */
static void error_state(const WrApp *app)
{
    const WrAccuracy *a = app->accuracy;
    const bool failed = a->error_of == a->state && a->error_why.text[0];
    const bool old = a->error && a->error->of != a->state;
    char why[WR_WORDS_MESSAGE];
    if (failed) wr_words_message(wr_error_message(&a->error_why), why, sizeof why);
    const char *text = failed                   ? why
                       : old                    ? "Of the view before; measured anew when it rests."
                       : app->settings->turning ? "Measured while the patch rests."
                       : !a->error              ? "Measuring ..."
                                                : "Of this view.";
    const WrColour ink = failed ? WR_COLOUR_BAD : old ? WR_COLOUR_CELL : WR_COLOUR_LABEL;
    wr_gui_text_cut(WR_FONT_SMALL, ink, text, wr_gui_available());
    wr_gui_tip(text);
}

static void caption(const WrWork *error)
{
    char text[160], number[16];
    wr_gui_space(6);
    if (!error) {
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, " ");
        wr_gui_space(-6);
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, " ");
        return;
    }
    snprintf(text, sizeof text, wr_words("%d \xc3\x97 %d pixels, a reference of %d \xc3\x97 %d"),
             error->measured_w, error->measured_h, error->samples, error->samples);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, text);
    wr_gui_tip(
        "The view is measured scaled down to at most 256 pixels along its longer side. The "
        "reference "
        "is rendered in double precision, by code of its own, with so many samples a pixel.");
    snprintf(text, sizeof text, wr_words("samples, itself off by about %s"),
             wr_plot_number(error->change, number));
    wr_gui_space(-6);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, text);
    wr_gui_tip("Change by the last doubling of its samples, rms: smaller errors may be its own");
}

static void error(WrApp *app)
{
    const WrAccuracy *a = app->accuracy;
    const WrWork *e = a->error;
    wr_gui_heading("ERROR AGAINST THE REFERENCE");
    error_state(app);
    Cell c[4] = {
        { 0, "rms", "Root mean square of the error of linear intensity, over all covered pixels",
          "" },
        { 0, "max", "The largest error of a channel of any pixel", "" },
        { 0, "99.9 %", "Error that 99.9 % of the pixels do not exceed", "" },
        { 0, "angle",
          "Root mean square angle between normals and the reference's, at pixel centres; not "
          "measured "
          "with a tolerance",
          "" },
    };
    if (e) {
        wr_plot_number(e->errors.rms, c[0].value);
        wr_plot_number(e->errors.max, c[1].value);
        wr_plot_number(e->errors.p999, c[2].value);
        wr_plot_number(e->errors.angle_rms, c[3].value);
        if (!isnan(e->errors.angle_rms)) strcat(c[3].value, "\xc2\xb0");
    }
    wr_gui_space(-2);
    cells(&c[0], &c[1]);
    cells(&c[2], &c[3]);
    caption(e);
}

/* ---- time ---- */

/* Indices into wr_series. */
static const int stage_colours[] = { 6, 0, 2, 1, 4, 3 };
_Static_assert(WR_LENGTH(stage_colours) == WR_PICTURE_STAGES, "a colour for each stage");

static void stage_bar(const double ms[WR_PICTURE_STAGES], double all)
{
    WrPad pad = wr_gui_pad_begin("stages", 0, wr_gui_px(14));
    double x = pad.x + 1;
    for (int i = 0; i < WR_PICTURE_STAGES; i++) {
        const double w = all > 0 ? (pad.w - 2) * ms[i] / all : 0;
        wr_gui_draw_fill(floor(x), pad.y + 1, ceil(x + w) - floor(x), pad.h - 2,
                         wr_series[stage_colours[i]], 0);
        x += w;
    }
    wr_gui_pad_end();
}

static void stages(WrApp *app)
{
    static const char *const tips[] = {
        "Copies of the table, slopes, meshes: only where something changed",
        "u, v of each sample",
        "P, Pu, Pv and N there",
        "F, its slopes and the turned normal",
        "Light and material",
        "Samples become pixels"
    };
    _Static_assert(WR_LENGTH(tips) == WR_PICTURE_STAGES, "a tip for each stage");
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    char words[WR_PICTURE_WORDS];
    double ms[WR_PICTURE_STAGES], all = wr_picture_time(picture, ms);
    if (!picture->serial) return;
    wr_gui_space(8);
    wr_gui_heading("TIME OF A PICTURE, MS");
    stage_bar(ms, all);
    wr_gui_space(-4);
    for (int i = 0; i < WR_PICTURE_STAGES; i += 2) {
        Cell c[2] = { { wr_series[stage_colours[i]], wr_picture_stages[i], tips[i], "" },
                      { wr_series[stage_colours[i + 1]], wr_picture_stages[i + 1], tips[i + 1],
                        "" } };
        for (int k = 0; k < 2; k++)
            snprintf(c[k].value, sizeof c[k].value, ms[i + k] < 10 ? "%.2f" : "%.1f", ms[i + k]);
        cells(&c[0], &c[1]);
    }
    wr_picture_words(picture, words);
    wr_gui_space(6);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, words);
}

/* ---- whole tab ---- */

void wr_panel_accuracy(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    a->error_open = true;
    show(app);
    wr_gui_space(8);
    error(app);
    stages(app);
    wr_gui_space(8);
    wr_panel_accuracy_plot(app);
    wr_gui_space(8);
    wr_panel_accuracy_dials(app);
    wr_gui_space(8);
    wr_panel_illusion(app);
    wr_gui_space(8);
    wr_gui_heading("HARD CASES");
    if (wr_gui_button("Hard cases...", false)) wr_action_run(app, WR_ACT(hard_cases));
    wr_gui_tip("120 inputs at which a naive program fails: the required result, and the error of "
               "this one");
    if (a->inspector.shown && app->layout->lower.w <= 0) {
        wr_gui_space(8);
        wr_gui_heading("INSPECTOR");
        wr_panel_inspector(app);
    }
    wr_gui_space(8);
}

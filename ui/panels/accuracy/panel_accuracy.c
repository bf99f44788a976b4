/* The Accuracy tab: picture of the patch, error and time, cost of other dials, the dials. */
#include "ui/panels/accuracy/accuracy.h"
#include "ui/panels/accuracy/accuracy_work.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/patch/preview/preview.h"
#include "ui/app/state/background_command.h"
#include "ui/app/state/line.h"
#include "ui/app/state/scene_line.h"
#include "ui/app/state/session_view.h"
#include "ui/app/jobs/job.h"

#include "accuracy/accuracy_benchmark.h"
#include "accuracy/plot.h"
#include "base/array.h"
#include "base/enum_rows.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "scene/dials.h"
#include "scene/scene.h"

#include <ctype.h>
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
        wr_accuracy_set_view(app, (WrPatchLook)look);
    wr_gui_tip("A is the scene with its dials, B has dials of its own. Split has a line to drag. "
               "Maps cover the patch: its error against the reference, the error of the paper's "
               "small-F approximation, the angle between smooth and bumped normal, the number of "
               "texels in a pixel. The patch does not turn while they are shown. Effects that ran "
               "have the colours of the plan, and are updated with the picture.");
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
    const char *text = failed ? why
                       : old  ? "For the previous view; measured again when the view rests."
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
    wr_gui_tip("The view is measured at a size of at most 256 pixels along its longer side. The "
               "reference is rendered in double precision, by separate code, with this number of "
               "samples per pixel.");
    snprintf(text, sizeof text, wr_words("samples, with an error of about %s itself"),
             wr_plot_number(error->change, number));
    wr_gui_space(-6);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, text);
    wr_gui_tip("Change by the last doubling of its samples, rms: smaller errors may be those of "
               "the reference");
}

static void error(WrApp *app)
{
    const WrAccuracy *a = app->accuracy;
    const WrWork *e = a->error;
    if (!wr_gui_fold("ERROR AGAINST THE REFERENCE", true)) return;
    error_state(app);
    Cell c[4] = {
        { 0, "rms", "Root mean square error of linear intensity over all covered pixels", "" },
        { 0, "max", "Largest error of any channel of any pixel", "" },
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
        "Tables, slopes and meshes, updated only where something changed",
        "u, v of each sample",
        "P, Pu, Pv and N there",
        "F, its slopes and the bumped normal",
        "Light and material",
        "Samples become pixels"
    };
    _Static_assert(WR_LENGTH(tips) == WR_PICTURE_STAGES, "a tip for each stage");
    const WrPreviewPicture *picture = wr_preview_picture(app->preview);
    char words[WR_PICTURE_WORDS];
    double ms[WR_PICTURE_STAGES], all = wr_picture_time(picture, ms);
    if (!picture->serial) return;
    if (!wr_gui_fold("TIME OF A PICTURE, MS", true)) return;
    stage_bar(ms, all);
    wr_gui_space(-4);
    for (int i = 0; i < WR_PICTURE_STAGES; i += 2) {
        Cell c[2] = { { wr_series[stage_colours[i]], wr_picture_stages[i], tips[i], "" },
                      { wr_series[stage_colours[i + 1]], wr_picture_stages[i + 1], tips[i + 1],
                        "" } };
        for (int k = 0; k < 2; k++)
            wr_words_print(c[k].value, sizeof c[k].value, ms[i + k] < 10 ? "%.2f" : "%.1f",
                           ms[i + k]);
        cells(&c[0], &c[1]);
    }
    wr_picture_words(picture, words);
    wr_gui_space(6);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_MUTED, words);
}

/* ---- dials of the scene or of the compared side, built from their table ---- */

/* And the tolerance, which sets them by measurement. */

#define CHOSEN_UNITS 120 /* height of the box with the chosen dials */

/* ---- tolerance ---- */

static void run_tolerance(WrApp *app, int kind, double value)
{
    WrText line = { 0 };
    wr_text_addf(&line, "tolerance %s", wr_tolerance_names[kind]);
    if (kind != WR_TOLERANCE_NONE) wr_text_add(&line, "=");
    if (kind != WR_TOLERANCE_NONE)
        wr_text_add_number(&line,
                           kind == WR_TOLERANCE_TIME ? wr_line_round(1e3 * value, 4) : value);
    if (kind == WR_TOLERANCE_TIME) wr_text_add(&line, "ms");
    wr_scene_run(app, &line);
}

static void tolerance_value(WrApp *app, const WrTolerance *t)
{
    const bool timed = t->kind == WR_TOLERANCE_TIME;
    WrNumber spec = {
        .low = timed ? 0.5 : 1e-4,
        .high = timed ? 200 : 0.2,
        .hard_low = timed ? 0.1 : 1e-9,
        .hard_high = timed ? 3.6e6 : 1e6,
        .reset = timed                         ? 8
                 : t->kind == WR_TOLERANCE_RMS ? 0.004
                                               : 0.05,
        .decimals = -1,
        .unit = timed ? "ms" : NULL,
        .logarithmic = true,
        .tip = timed ? "Time limit of a picture: the smallest error within it"
                     : "Limit of the error of linear intensity: the shortest time within it"
    };
    double value = timed ? 1e3 * t->value : t->value;
    wr_gui_label(timed ? "At most" : "Error up to");
    if (wr_gui_number("tolerance_value", 0, &spec, &value) == WR_EDIT_DONE)
        run_tolerance(app, (int)t->kind, timed ? 1e-3 * value : value);
}

static void report_chosen(const WrApp *app, const WrChosen *c)
{
    if (!c->any) {
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            app->settings->turning ? "Chosen when the patch rests."
                                                   : "Choosing ...");
        return;
    }
    wr_gui_text_wrapped(WR_FONT_SMALL, c->met ? WR_COLOUR_TEXT : WR_COLOUR_CELL, c->reason);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, c->line);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                        c->kept ? "Stored in the document for this view: nothing had to be chosen."
                                : "Chosen for this view; saved with the document.");
}

/* The result of a tolerance, in a box of constant height, so that the rows below stay in place. */
static void chosen(WrApp *app)
{
    const WrChosen *c = &app->accuracy->full_times.chosen;
    wr_gui_list_begin("chosen", wr_gui_px(CHOSEN_UNITS));
    report_chosen(app, c);
    wr_gui_list_end();
    wr_gui_disable(!c->any);
    if (wr_gui_button("Keep these dials", false)) wr_accuracy_keep(app);
    wr_gui_disable_end();
    wr_gui_tip("Copies the chosen dials to the scene, and switches the tolerance off");
}

static void panel_accuracy_tolerance(WrApp *app)
{
    WR_ROWS(fresh);
    static const struct {
        const char *name;
        double value; /* initial value */
    } fresh[WR_TOLERANCE_COUNT] = {
        [WR_ROW(WR_TOLERANCE_NONE)] = { "Off", 0 },
        [WR_ROW(WR_TOLERANCE_RMS)] = { "RMS", 0.004 },
        [WR_ROW(WR_TOLERANCE_MAX)] = { "Max", 0.05 },
        [WR_ROW(WR_TOLERANCE_TIME)] = { "Time", 0.008 },
    };
    WR_ROWS_END(fresh, WR_TOLERANCE_COUNT);
    const char *names[WR_TOLERANCE_COUNT];
    for (int i = 0; i < WR_TOLERANCE_COUNT; i++) names[i] = fresh[i].name;
    const WrTolerance t = wr_app_scene(app)->tolerance;
    int kind = (int)t.kind;
    if (!wr_gui_fold("TOLERANCE", false)) return;
    if (wr_gui_segments("tolerance", names, NULL, WR_TOLERANCE_COUNT, &kind))
        run_tolerance(app, kind, fresh[kind].value);
    wr_gui_tip("The cheapest dials within an error, or the most accurate within a time, found by "
               "measuring samples of this picture");
    if (t.kind == WR_TOLERANCE_NONE || kind == WR_TOLERANCE_NONE) return;
    tolerance_value(app, &t);
    chosen(app);
}

/* ---- dials ---- */

static void choose(WrApp *app, int side, int id)
{
    const WrDial *dial = &wr_dials[id];
    const char *names[32];
    int count = 0, index = (int)wr_accuracy_dial(app, side, id);
    for (; count < dial->choices && count < 32; count++) names[count] = dial->choice(count);
    if (wr_gui_choice(dial->name, 0, names, count, &index))
        wr_accuracy_set_dial(app, side, id, index);
}

/* A slider over the useful values; typing allows the whole range. */
static void number(WrApp *app, int side, int id, double reset)
{
    const WrDial *dial = &wr_dials[id];
    double value = wr_accuracy_dial(app, side, id), low = dial->low, high = dial->low;
    for (int i = 0; dial->rungs && !isnan(dial->rungs[i]); i++) high = fmax(high, dial->rungs[i]);
    if (!(high > low)) high = dial->high;
    WrNumber spec = { .low = low,
                      .high = high,
                      .hard_low = dial->low,
                      .hard_high = dial->high,
                      .reset = reset,
                      .decimals = dial->whole ? 0 : -1 };
    WrEdit edit = wr_gui_number(dial->name, 0, &spec, &value);
    if (dial->whole) value = rint(value);
    if (edit == WR_EDIT_LIVE && side == 0) dial->set(wr_app_live_begin(app), value);
    else if (edit != WR_EDIT_NONE) wr_accuracy_set_dial(app, side, id, value);
}

static bool set_by_tolerance(const WrApp *app, int side, const WrDial *dial)
{
    return side == 0 && wr_app_scene(app)->tolerance.kind != WR_TOLERANCE_NONE &&
           (dial->axis == WR_AXIS_DERIVATIVE || dial->axis == WR_AXIS_NORMAL ||
            dial->axis == WR_AXIS_ANTIALIASING);
}

static void axis_dials(WrApp *app, int side, WrAxis axis, const WrScene *scene,
                       const WrScene *plain)
{
    for (int d = 0; d < WR_DIAL_COUNT; d++) {
        const WrDial *dial = &wr_dials[d];
        char tip[256];
        if (dial->axis != axis) continue;
        const bool matters = !dial->matters || dial->matters(scene);
        const bool chooses = set_by_tolerance(app, side, dial);
        wr_gui_disable(!matters || chooses);
        wr_gui_label(dial->label);
        if (dial->choices > 0) choose(app, side, d);
        else number(app, side, d, dial->get(plain));
        wr_gui_disable_end();
        snprintf(tip, sizeof tip, "%s=: %s%s", dial->name, wr_words(dial->help),
                 chooses    ? wr_words(". The tolerance sets it.")
                 : !matters ? wr_words(". With the present other dials it has no effect.")
                            : "");
        wr_gui_tip(tip);
    }
}

static void which_side(WrApp *app)
{
    static const char *const sides[] = { "A: the scene", "B: to compare" };
    WrAccuracy *a = app->accuracy;
    wr_gui_segments("side", sides, NULL, 2, &a->chooses);
    wr_gui_tip("Setting that is changed by the rows below and by clicks in the plot");
    if (a->chooses == 0) return;
    if (wr_gui_chip(NULL, "Take A's")) wr_action_run(app, WR_ACT(compare_take));
    wr_gui_tip("Copies the scene's dials to B");
    wr_gui_same_line(6);
    if (wr_gui_chip(NULL, "Swap A and B")) wr_action_run(app, WR_ACT(compare_swap));
    wr_gui_tip("Swaps the dials of the scene and B");
}

static void panel_accuracy_dials(WrApp *app)
{
    if (!wr_gui_fold("DIALS", true)) return;
    which_side(app);
    const int side = app->accuracy->chooses;
    if (side == 0) {
        wr_busy_hold(app);
        panel_accuracy_tolerance(app);
    }
    WrScene *scene = wr_accuracy_scene(app, side), *plain = wr_scene_new();
    for (int axis = 0; axis < WR_AXIS_COUNT; axis++) {
        char heading[48];
        int i = 0;
        for (; wr_axis_labels[axis][i] && i < 47; i++)
            heading[i] = (char)toupper((unsigned char)wr_axis_labels[axis][i]);
        heading[i] = '\0';
        wr_gui_push_id(axis + 100 * side);
        if (wr_gui_fold(heading, false)) axis_dials(app, side, (WrAxis)axis, scene, plain);
        wr_gui_pop_id();
    }
    if (side == 0) wr_busy_hold_end();
    wr_scene_free(plain);
    wr_scene_free(scene);
}

/* ---- plot of error against time of all settings in the benchmark, both logarithmic ---- */

/* The Pareto front, and a ring around the present setting. A click on a point applies it. */

#define TICKS 6
#define PLOT_UNITS 210 /* height of the plot */
#define REACH_UNITS 12 /* hit radius of a point */
#define TELL_UNITS 66  /* height of the box with a point's setting */

_Static_assert(WR_SERIES == WR_AXIS_COUNT + 1, "and one for several axes at once");

typedef struct Canvas {
    double end; /* right end of the pad: labels stay left of it */
    bool old;   /* of another state of table or scene: faded */
} Canvas;

static WrColour colour_of(const Canvas *canvas, WrPlotInk ink)
{
    const WrColour colours[WR_PLOT_SERIES] = { [WR_PLOT_GRID] = WR_COLOUR_GRID,
                                               [WR_PLOT_FRAME] = WR_COLOUR_GRAB,
                                               [WR_PLOT_LABEL] = WR_COLOUR_LABEL,
                                               [WR_PLOT_REFERENCE] = WR_COLOUR_MUTED,
                                               [WR_PLOT_FRONT] = WR_COLOUR_MUTED };
    const WrColour colour = ink < WR_PLOT_SERIES ? colours[ink] : wr_series[ink - WR_PLOT_SERIES];
    return canvas->old && ink >= WR_PLOT_FRONT ? (colour & 0x00ffffffu) | 0x58000000u : colour;
}

/* Thin lines of axes are whole pixels. */
static void draw_line(void *ctx, const WrPlotSpot *p, int count, double width, WrPlotInk ink)
{
    for (int i = 1; i < count; i++) {
        const WrPlotSpot a = p[i - 1], b = p[i];
        if (ink >= WR_PLOT_FRONT) wr_gui_draw_line(a.x, a.y, b.x, b.y, colour_of(ctx, ink), width);
        else
            wr_gui_draw_fill(floor(fmin(a.x, b.x)), floor(fmin(a.y, b.y)), fmax(1, fabs(b.x - a.x)),
                             fmax(1, fabs(b.y - a.y)), colour_of(ctx, ink), 0);
    }
}

static void draw_mark(void *ctx, WrPlotSpot at, double radius, WrPlotInk ink)
{
    wr_gui_draw_disc(at.x, at.y, radius, colour_of(ctx, ink));
}

static void draw_ring(void *ctx, WrPlotSpot at, double radius, double width)
{
    (void)ctx;
    wr_gui_draw_circle(at.x, at.y, radius, WR_COLOUR_STRONG, width);
}

static void draw_word(void *ctx, const char *word, double x, double y, double anchor, WrPlotInk ink)
{
    const Canvas *canvas = ctx;
    const double wide = wr_gui_text_width(WR_FONT_SMALL, word);
    wr_gui_draw_text(fmin(x - anchor * wide, canvas->end - wide),
                     y - wr_gui_line_height(WR_FONT_SMALL) / 2, WR_FONT_SMALL, colour_of(ctx, ink),
                     word);
}

static void lay_out(const WrPad *pad, WrPlot *plot)
{
    const double s = wr_gui_scale(), line = wr_gui_line_height(WR_FONT_SMALL);
    double ticks[TICKS], widest = 0;
    char text[16];
    const int count = wr_plot_ticks(&plot->error, ticks, TICKS);
    for (int i = 0; i < count; i++)
        widest = fmax(widest, wr_gui_text_width(WR_FONT_SMALL, wr_plot_number(ticks[i], text)));
    const double left = widest + 12 * s, top = line + 12 * s;
    wr_plot_lay_out(plot, pad->x + left, pad->y + top, pad->w - 12 * s - left,
                    pad->h - line - 10 * s - top);
}

static void draw_plot(const WrAccuracy *a, const WrPad *pad, const WrPlot *plot, int present,
                      bool old)
{
    const double s = wr_gui_scale(), line = wr_gui_line_height(WR_FONT_SMALL);
    const char *time = "ms a picture \xe2\x86\x92";
    const int room = (int)(plot->w / (44 * s));
    Canvas mine = { .end = pad->x + pad->w - 4 * s, .old = old };
    const WrPlotCanvas canvas = { .ctx = &mine,
                                  .unit = s,
                                  .text = line,
                                  .times = room < 2       ? 2
                                           : room > TICKS ? TICKS
                                                          : room,
                                  .errors = TICKS,
                                  .line = draw_line,
                                  .mark = draw_mark,
                                  .ring = draw_ring,
                                  .word = draw_word };
    wr_plot_draw(plot, &canvas, "the reference's own", present);
    if (a->plot_hot >= 0)
        wr_gui_draw_circle(plot->spots[a->plot_hot].x, plot->spots[a->plot_hot].y, 6 * s,
                           WR_COLOUR_ACCENT, 1.5 * s);
    wr_gui_draw_text(pad->x + 6 * s, pad->y + 5 * s, WR_FONT_SMALL, WR_COLOUR_TEXT, "error, rms");
    wr_gui_draw_text(pad->x + pad->w - 8 * s - wr_gui_text_width(WR_FONT_SMALL, time),
                     pad->y + 5 * s, WR_FONT_SMALL, WR_COLOUR_TEXT, time);
}

/* ---- texts ---- */

static void report_rung(const WrAccuracyBenchmark *benchmark, int index, bool present)
{
    WrText text = { 0 };
    char time[16], rms[16], max[16];
    const WrRung *rung = &benchmark->rungs[index];
    if (present) wr_text_add(&text, "ringed: ");
    if (rung->current) wr_text_add(&text, "as the scene stood");
    else wr_setting_print(&rung->setting, &text);
    wr_text_addf(&text, wr_words("\n%s ms, rms %s, max %s"),
                 wr_plot_number(1e3 * rung->seconds, time), wr_plot_number(rung->errors.rms, rms),
                 wr_plot_number(rung->errors.max, max));
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_TEXT, wr_text_get(&text));
    wr_text_fini(&text);
}

/* In a box of constant height, so that nothing below moves when the pointer enters. */
static void tell(const WrAccuracy *a, int present, bool old)
{
    wr_gui_list_begin("rung", wr_gui_px(TELL_UNITS));
    if (a->plot_hot >= 0) report_rung(&a->plot->benchmark, a->plot_hot, a->plot_hot == present);
    else if (old)
        wr_gui_text_wrapped(
            WR_FONT_SMALL, WR_COLOUR_CELL,
            "For another state of table or scene.\nMeasured again when the view rests.");
    else if (present >= 0 && wr_plot_has_point(&a->plot->benchmark.rungs[present]))
        report_rung(&a->plot->benchmark, present, true);
    else
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            "The present setting has no point here.\nClick one to use it.");
    wr_gui_list_end();
}

static void legend(void)
{
    static const char *const labels[] = { "slopes", "normal",     "antialiasing", "visibility",
                                          "light",  "arithmetic", "several" };
    _Static_assert(WR_LENGTH(labels) == WR_AXIS_COUNT + 1, "a label for each colour");
    const double s = wr_gui_scale(), line = wr_gui_line_height(WR_FONT_SMALL),
                 from = wr_gui_place();
    const double column = floor(wr_gui_available() / 2);
    for (int i = 0; i <= WR_AXIS_COUNT; i++) {
        if (i % 2) wr_gui_same_line(0);
        wr_gui_move_to(from + (i % 2) * column);
        wr_gui_swatch(wr_series[i], 3.5 * s, line);
        wr_gui_same_line(5);
        wr_gui_text(WR_FONT_SMALL, WR_COLOUR_LABEL, labels[i]);
        if (i % 2) wr_gui_space(-8);
    }
    wr_gui_text_wrapped(
        WR_FONT_SMALL, WR_COLOUR_LABEL,
        "Ring: the present setting. Line: no other is faster and more accurate. Dashes: the "
        "reference's own error.");
    wr_gui_space(4);
}

static void foot(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    double fraction = 0;
    char text[96];
    if (wr_accuracy_busy(app, WR_WORK_BENCHMARK, &fraction)) {
        wr_gui_progress(wr_gui_available() - wr_gui_px(64), fraction);
        wr_gui_same_line(8);
        if (wr_gui_chip(NULL, "Stop")) wr_job_interrupt(a->measure);
        return;
    }
    if (wr_gui_button("Measure", false)) wr_action_run(app, WR_ACT(accuracy_measure));
    wr_gui_tip("Renders this view with each setting of each dial and their combinations, measures "
               "the times, and compares each with the reference. It also starts by itself when the "
               "view rests.");
    if (!a->plot) return;
    const WrAccuracyBenchmark *benchmark = &a->plot->benchmark;
    snprintf(text, sizeof text, wr_words("%d \xc3\x97 %d, one thread"), benchmark->width,
             benchmark->height);
    wr_gui_same_line(10);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_MUTED, text);
}

static void field(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    WrPlot plot = { 0 };
    const bool axes = a->plot && wr_plot_init(&a->plot->benchmark, &plot);
    const bool old = axes && !wr_accuracy_plot_fits(app);
    const int present = axes && !old ? wr_accuracy_current_rung(app) : -1;
    WrPad pad = wr_gui_pad_begin("pareto", 0, wr_gui_px(PLOT_UNITS));
    int clicked = -1;
    a->plot_hot = -1;
    if (axes) {
        lay_out(&pad, &plot);
        if (pad.hovered)
            a->plot_hot = wr_plot_nearest(plot.spots, a->plot->benchmark.count, pad.pointer_x,
                                          pad.pointer_y, REACH_UNITS * wr_gui_scale());
        draw_plot(a, &pad, &plot, present, old);
        if (pad.pressed) clicked = a->plot_hot;
    } else {
        const char *words =
            app->settings->turning ? "Measured when the patch rests" : "Not measured yet";
        const double wide = wr_gui_text_width(WR_FONT_SMALL, words);
        wr_gui_draw_text(pad.x + (pad.w - wide) / 2, pad.y + pad.h / 2, WR_FONT_SMALL,
                         WR_COLOUR_LABEL, words);
    }
    wr_gui_pad_end();
    if (axes) {
        legend();
        tell(a, present, old);
    }
    wr_plot_fini(&plot);
    if (clicked >= 0) wr_accuracy_take_rung(app, a->chooses, clicked);
}

static void panel_accuracy_plot(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    if (!wr_gui_fold("COST", true)) return;
    a->plot_open = wr_gui_will_see(wr_gui_px(PLOT_UNITS));
    field(app);
    foot(app);
}

/* ---- whole tab ---- */

void wr_panel_accuracy(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    a->error_open = true;
    wr_panel_study(app);
    show(app);
    error(app);
    stages(app);
    panel_accuracy_plot(app);
    if (wr_is_study(app)) a->plot_open = true; /* measured although out of sight */
    panel_accuracy_dials(app);
    wr_panel_illusion(app);
    if (wr_gui_fold("HARD CASES", false)) {
        if (wr_gui_button("Hard cases...", false)) wr_action_run(app, WR_ACT(hard_cases));
        wr_gui_tip("120 inputs at which a naive program fails: the required result, and this "
                   "program's error");
    }
    wr_gui_space(8);
}

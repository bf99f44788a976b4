/* Plot of error against time of all settings in the ladder, both logarithmic: the Pareto front, and a ring around the
   present setting. A click on a point applies it. */
#include "ui/accuracy/accuracy.h"
#include "ui/accuracy/accuracy_work.h"
#include "ui/state/action.h"
#include "ui/state/action_list.h"
#include "ui/state/app_state.h"
#include "ui/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/jobs/job.h"

#include "accuracy/plot.h"
#include "accuracy/ladder.h"
#include "base/array.h"
#include "base/enum_rows.h"
#include "base/memory.h"
#include "base/text.h"
#include "scene/dials.h"

#include <math.h>
#include <stdio.h>

#define TICKS 6
#define PLOT_UNITS 210 /* height of the plot */
#define REACH_UNITS 12 /* hit radius of a point */

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

static void tell_rung(const WrLadder *ladder, int index, bool present)
{
    WrText text = { 0 };
    char time[16], rms[16], max[16];
    const WrRung *rung = &ladder->rungs[index];
    if (present) wr_text_add(&text, "ringed: ");
    if (rung->current) wr_text_add(&text, "as the scene stood");
    else wr_setting_print(&rung->setting, &text);
    wr_text_addf(&text, wr_words("\n%s ms, rms %s, max %s"),
                 wr_plot_number(1e3 * rung->seconds, time), wr_plot_number(rung->errors.rms, rms),
                 wr_plot_number(rung->errors.max, max));
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_TEXT, wr_text_get(&text));
    wr_text_fini(&text);
}

/* Always two lines high, so that nothing below moves when the pointer enters. */
static void tell(const WrAccuracy *a, int present, bool old)
{
    if (a->plot_hot >= 0) tell_rung(&a->plot->ladder, a->plot_hot, a->plot_hot == present);
    else if (old)
        wr_gui_text_wrapped(
            WR_FONT_SMALL, WR_COLOUR_CELL,
            "Of another state of table or scene.\nMeasured anew when the view rests.");
    else if (present >= 0 && wr_plot_has_point(&a->plot->ladder.rungs[present]))
        tell_rung(&a->plot->ladder, present, true);
    else
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            "The present setting has no point here.\nClick one to use it.");
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
    wr_gui_space(8);
}

static void foot(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    double fraction = 0;
    char text[96];
    if (wr_accuracy_busy(app, WR_WORK_LADDER, &fraction)) {
        wr_gui_progress(wr_gui_available() - wr_gui_px(64), fraction);
        wr_gui_same_line(8);
        if (wr_gui_chip(NULL, "Stop")) wr_job_interrupt(a->measure);
        return;
    }
    if (wr_gui_button("Measure", false)) wr_action_run(app, WR_ACT(accuracy_measure));
    wr_gui_tip("Render this very view with each rung of each dial and with their combinations, "
               "time them, compare "
               "each with the reference. It also begins by itself, when the view rests.");
    if (!a->plot) return;
    const WrLadder *ladder = &a->plot->ladder;
    snprintf(text, sizeof text, wr_words("%d \xc3\x97 %d, one thread"), ladder->width,
             ladder->height);
    wr_gui_same_line(10);
    wr_gui_text(WR_FONT_SMALL, WR_COLOUR_MUTED, text);
}

static void field(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    WrPlot plot = { 0 };
    const bool axes = a->plot && wr_plot_init(&a->plot->ladder, &plot);
    const bool old = axes && !wr_accuracy_plot_fits(app);
    const int present = axes && !old ? wr_accuracy_current_rung(app) : -1;
    WrPad pad = wr_gui_pad_begin("pareto", 0, wr_gui_px(PLOT_UNITS));
    int clicked = -1;
    a->plot_hot = -1;
    if (axes) {
        lay_out(&pad, &plot);
        if (pad.hovered)
            a->plot_hot = wr_plot_nearest(plot.spots, a->plot->ladder.count, pad.pointer_x,
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

void wr_panel_accuracy_plot(WrApp *app)
{
    WrAccuracy *a = app->accuracy;
    wr_gui_heading("WHAT IT COSTS");
    a->plot_open = wr_gui_will_see(wr_gui_px(PLOT_UNITS));
    field(app);
    foot(app);
}

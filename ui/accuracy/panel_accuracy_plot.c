/* Plot of error against time of all settings in the ladder, both logarithmic: the Pareto front, and a ring around the
   present setting. A click on a point applies it. */
#include "ui/accuracy/accuracy.h"
#include "ui/accuracy/accuracy_plot.h"
#include "ui/accuracy/accuracy_work.h"
#include "ui/state/action.h"
#include "ui/state/action_list.h"
#include "ui/state/app_state.h"
#include "ui/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/jobs/job.h"

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

typedef struct Plot {
    WrPlotAxis time, error; /* seconds; RMS */
    double floor;           /* the reference's own error: smaller errors are unknown */
    double x, y, w, h;      /* area between the axes, pixels */
    double (*points)[2];    /* [count] pixels; far outside for a rung without a point */
    int count;
} Plot;

static bool has_point(const WrRung *rung)
{
    return !rung->model && !rung->note.text[0] && rung->seconds > 0 && rung->errors.rms > 0;
}

/* Errors below the reference's own are not measurable, so they are drawn at its line. */
static double error_of(const Plot *plot, const WrRung *rung)
{
    return fmax(rung->errors.rms, plot->floor);
}

static bool make_axes(const WrLadder *ladder, Plot *plot)
{
    const double own = ladder->reference.last_rms;
    plot->floor = isfinite(own) ? own : 0;
    double *times = wr_alloc((size_t)ladder->count + 1, sizeof *times);
    double *errors = wr_alloc((size_t)ladder->count + 1, sizeof *errors);
    int n = 0;
    for (int i = 0; i < ladder->count; i++)
        if (has_point(&ladder->rungs[i])) {
            times[n] = ladder->rungs[i].seconds;
            errors[n++] = error_of(plot, &ladder->rungs[i]);
        }
    bool good = wr_plot_axis(times, n, &plot->time) && wr_plot_axis(errors, n, &plot->error);
    wr_free(times);
    wr_free(errors);
    return good;
}

static void lay_out(const WrLadder *ladder, const WrPad *pad, Plot *plot)
{
    const double s = wr_gui_scale(), line = wr_gui_line_height(WR_FONT_SMALL);
    double ticks[TICKS], widest = 0;
    char text[16];
    const int count = wr_plot_ticks(&plot->error, ticks, TICKS);
    for (int i = 0; i < count; i++)
        widest = fmax(widest, wr_gui_text_width(WR_FONT_SMALL, wr_plot_number(ticks[i], text)));
    plot->x = pad->x + widest + 12 * s;
    plot->y = pad->y + line + 12 * s;
    plot->w = pad->x + pad->w - 12 * s - plot->x;
    plot->h = pad->y + pad->h - line - 10 * s - plot->y;
    plot->count = ladder->count;
    plot->points = wr_alloc((size_t)ladder->count + 1, sizeof *plot->points);
    for (int i = 0; i < ladder->count; i++) {
        const WrRung *rung = &ladder->rungs[i];
        plot->points[i][0] = plot->points[i][1] = -1e9;
        if (!has_point(rung)) continue;
        plot->points[i][0] = plot->x + plot->w * wr_plot_place(&plot->time, rung->seconds);
        plot->points[i][1] =
            plot->y + plot->h * (1 - wr_plot_place(&plot->error, error_of(plot, rung)));
    }
}

static void draw_axes(const WrPad *pad, const Plot *plot)
{
    const double s = wr_gui_scale(), line = wr_gui_line_height(WR_FONT_SMALL);
    double ticks[TICKS];
    char text[16];
    int count = wr_plot_ticks(&plot->error, ticks, TICKS);
    for (int i = 0; i < count; i++) {
        const double y = floor(plot->y + plot->h * (1 - wr_plot_place(&plot->error, ticks[i])));
        wr_plot_number(ticks[i], text);
        wr_gui_draw_fill(plot->x, y, plot->w, 1, WR_COLOUR_GRID, 0);
        wr_gui_draw_text(plot->x - 6 * s - wr_gui_text_width(WR_FONT_SMALL, text), y - line / 2,
                         WR_FONT_SMALL, WR_COLOUR_LABEL, text);
    }
    const int room = (int)(plot->w / (44 * s));
    count = wr_plot_ticks(&plot->time, ticks, room < 2 ? 2 : room > TICKS ? TICKS : room);
    for (int i = 0; i < count; i++) {
        const double x = floor(plot->x + plot->w * wr_plot_place(&plot->time, ticks[i]));
        wr_plot_number(1e3 * ticks[i], text);
        const double wide = wr_gui_text_width(WR_FONT_SMALL, text), end = pad->x + pad->w - 4 * s;
        wr_gui_draw_fill(x, plot->y, 1, plot->h, WR_COLOUR_GRID, 0);
        wr_gui_draw_text(fmin(x - wide / 2, end - wide), plot->y + plot->h + 4 * s, WR_FONT_SMALL,
                         WR_COLOUR_LABEL, text);
    }
    if (plot->floor > plot->error.low) {
        const double y = plot->y + plot->h * (1 - wr_plot_place(&plot->error, plot->floor));
        for (double x = plot->x; x < plot->x + plot->w; x += 8 * s)
            wr_gui_draw_fill(x, floor(y), fmin(4 * s, plot->x + plot->w - x), 1, WR_COLOUR_FAINT,
                             0);
        wr_gui_draw_text(plot->x + 5 * s, y + 2 * s, WR_FONT_SMALL, WR_COLOUR_MUTED,
                         "the reference's own");
    }
    wr_gui_draw_rect(plot->x, plot->y, plot->w, plot->h, WR_COLOUR_GRAB, 1);
    wr_gui_draw_text(pad->x + 6 * s, pad->y + 5 * s, WR_FONT_SMALL, WR_COLOUR_TEXT, "error, rms");
    const char *time = "ms a picture \xe2\x86\x92";
    wr_gui_draw_text(pad->x + pad->w - 8 * s - wr_gui_text_width(WR_FONT_SMALL, time),
                     pad->y + 5 * s, WR_FONT_SMALL, WR_COLOUR_TEXT, time);
}

/* The front from fastest to most accurate. */
static void draw_front(const WrLadder *ladder, const Plot *plot, WrColour colour)
{
    int last = -1;
    for (int done = 0; done < ladder->count; done++) {
        int next = -1;
        for (int i = 0; i < ladder->count; i++) {
            const double x = plot->points[i][0];
            if (!ladder->rungs[i].front || x < plot->x - 1 || i == last) continue;
            if (last >= 0 && x <= plot->points[last][0]) continue;
            if (next < 0 || x < plot->points[next][0]) next = i;
        }
        if (next < 0) return;
        if (last >= 0)
            wr_gui_draw_line(plot->points[last][0], plot->points[last][1], plot->points[next][0],
                             plot->points[next][1], colour, 1.5 * wr_gui_scale());
        last = next;
    }
}

static WrColour faded(WrColour colour, bool fade)
{
    return fade ? (colour & 0x00ffffffu) | 0x58000000u : colour;
}

static void draw_points(const WrAccuracy *a, const Plot *plot, int present, bool old)
{
    const double s = wr_gui_scale();
    const WrLadder *ladder = &a->plot->ladder;
    for (int pass = 0; pass < 2; pass++) /* points of the front on top */
        for (int i = 0; i < plot->count; i++) {
            const WrRung *rung = &ladder->rungs[i];
            if (rung->front != (pass == 1)) continue;
            wr_gui_draw_disc(plot->points[i][0], plot->points[i][1], (pass ? 4 : 3) * s,
                             faded(wr_series[rung->axis], old));
        }
    if (present >= 0 && has_point(&ladder->rungs[present])) {
        wr_gui_draw_circle(plot->points[present][0], plot->points[present][1], 7.5 * s,
                           WR_COLOUR_STRONG, 2 * s);
    }
    if (a->plot_hot >= 0)
        wr_gui_draw_circle(plot->points[a->plot_hot][0], plot->points[a->plot_hot][1], 6 * s,
                           WR_COLOUR_ACCENT, 1.5 * s);
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
    else if (present >= 0 && has_point(&a->plot->ladder.rungs[present]))
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
    Plot plot = { 0 };
    const bool axes = a->plot && make_axes(&a->plot->ladder, &plot);
    const bool old = axes && !wr_accuracy_plot_fits(app);
    const int present = axes && !old ? wr_accuracy_rung(app) : -1;
    WrPad pad = wr_gui_pad_begin("pareto", 0, wr_gui_px(PLOT_UNITS));
    int clicked = -1;
    a->plot_hot = -1;
    if (axes) {
        lay_out(&a->plot->ladder, &pad, &plot);
        if (pad.hovered)
            a->plot_hot =
                wr_plot_nearest((const double(*)[2])plot.points, plot.count, pad.pointer_x,
                                pad.pointer_y, REACH_UNITS * wr_gui_scale());
        draw_axes(&pad, &plot);
        draw_front(&a->plot->ladder, &plot, faded(WR_COLOUR_MUTED, old));
        draw_points(a, &plot, present, old);
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
    wr_free(plot.points);
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

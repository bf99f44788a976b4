/* Plot of error against time as a gnuplot script. The front is listed below the plot, each setting in full: its
   lines are wrapped and the picture is made higher, so that every name is included. */
#include "accuracy/plot_labels.h"
#include "accuracy/report.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Layout in pixels from the upper left corner of the picture. */
#define WIDTH 1280
#define PLOT_LEFT 100
#define PLOT_RIGHT 1085
#define PLOT_TOP 50
#define PLOT_BOTTOM 640
#define LIST_TOP 736 /* centre of its first line */
#define LINE 23
#define LEFT 20
#define NUMBER_RIGHT 40
#define TIME_RIGHT 130
#define ERROR_RIGHT 230
#define SETTING_LEFT 252

/* Characters that fit: settings and file names have about 8.5 and 11 pixels a character. */
#define SETTING_FITS 112
#define NAME_FITS 48
#define REFERENCE_W 290 /* width of the text at the reference's line */

#define LISTED 24 /* maximum listed settings of the front */

/* ---- the data ---- */

/* A string in gnuplot's single quotes: only the quote itself must be escaped. */
static void add_quoted(WrText *text, const char *bytes)
{
    wr_text_add(text, "'");
    for (; *bytes; bytes++) {
        if (*bytes == '\'') wr_text_add(text, "'");
        if ((unsigned char)*bytes >= ' ') wr_text_add_n(text, bytes, 1);
    }
    wr_text_add(text, "'");
}

/* True if a rung can be shown on logarithmic axes. */
static bool placed(const WrRung *rung)
{
    return !rung->note.text[0] && !rung->model && rung->errors.rms > 0 && rung->seconds > 0;
}

static void add_points(const WrLadder *ladder, int axis, WrText *text)
{
    for (int i = 0; i < ladder->count; i++) {
        const WrRung *rung = &ladder->rungs[i];
        if (placed(rung) && (int)rung->axis == axis && !rung->current)
            wr_text_addf(text, "%.6g %.6g %.6g\n", 1e3 * rung->seconds, rung->errors.rms,
                         1e3 * rung->spread);
    }
}

static int by_time(const void *a, const void *b)
{
    const WrRung *const *x = a, *const *y = b;
    return ((*x)->seconds > (*y)->seconds) - ((*x)->seconds < (*y)->seconds);
}

/* The front sorted by time. The caller frees. */
static const WrRung **front_of(const WrLadder *ladder, int *count)
{
    const WrRung **front = wr_alloc((size_t)ladder->count + 1, sizeof *front);
    *count = 0;
    for (int i = 0; i < ladder->count; i++)
        if (ladder->rungs[i].front && placed(&ladder->rungs[i]))
            front[(*count)++] = &ladder->rungs[i];
    qsort(front, (size_t)*count, sizeof *front, by_time);
    return front;
}

static void add_data(const WrLadder *ladder, const WrRung **front, int fronts, WrText *text)
{
    for (int axis = 0; axis <= WR_AXIS_COUNT; axis++) {
        wr_text_addf(text, "$axis%d << EOD\n", axis);
        add_points(ladder, axis, text);
        wr_text_add(text, "EOD\n");
    }
    wr_text_add(text, "$front << EOD\n");
    for (int i = 0; i < fronts; i++)
        wr_text_addf(text, "%.6g %.6g %d\n", 1e3 * front[i]->seconds, front[i]->errors.rms, i + 1);
    wr_text_add(text, "EOD\n$now << EOD\n");
    for (int i = 0; i < ladder->count; i++)
        if (ladder->rungs[i].current && placed(&ladder->rungs[i]))
            wr_text_addf(text, "%.6g %.6g %.6g\n", 1e3 * ladder->rungs[i].seconds,
                         ladder->rungs[i].errors.rms, 1e3 * ladder->rungs[i].spread);
    wr_text_add(text, "EOD\n");
}

/* ---- the frame ---- */

typedef struct Range {
    double low, high;
} Range;

static void widen(Range *range, double value)
{
    if (!(value > 0)) return;
    range->low = range->low > 0 ? fmin(range->low, value) : value;
    range->high = fmax(range->high, value);
}

/* Ranges of everything shown, with a margin. The reference's own line is included if it is not far below. */
static void ranges_of(const WrLadder *ladder, Range *time, Range *error)
{
    *time = *error = (Range){ 0, 0 };
    for (int i = 0; i < ladder->count; i++) {
        if (!placed(&ladder->rungs[i])) continue;
        widen(time, 1e3 * ladder->rungs[i].seconds);
        widen(error, ladder->rungs[i].errors.rms);
    }
    if (!(time->low > 0)) *time = *error = (Range){ 1, 1 }; /* nothing is shown */
    if (ladder->reference.last_rms > error->low / 10) widen(error, ladder->reference.last_rms);
    *time = (Range){ time->low / 1.4, time->high * 1.4 };
    *error = (Range){ error->low / 1.6, error->high * 1.6 };
}

/* Position along the axis, 0..1. */
static double along(Range range, double value)
{
    return log(value / range.low) / log(range.high / range.low);
}

/* ---- positions ---- */

static double height_of(int lines)
{
    return LIST_TOP + LINE * (lines - 1) + 24;
}

/* Pixel position of a rung, y upwards from the plot's lower edge. */
static WrPlotSpot spot_of(const WrRung *rung, Range time, Range error)
{
    return (WrPlotSpot){ PLOT_LEFT + along(time, 1e3 * rung->seconds) * (PLOT_RIGHT - PLOT_LEFT),
                         along(error, rung->errors.rms) * (PLOT_BOTTOM - PLOT_TOP) };
}

/* Appends "at screen x, y" for a spot. */
static void add_at(WrPlotSpot spot, double height, WrText *text)
{
    wr_text_addf(text, "screen %.5f, screen %.5f", spot.x / WIDTH,
                 (height - PLOT_BOTTOM + spot.y) / height);
}

/* ---- numbers in the plot ---- */

/* The front's points, then all others. The caller frees. */
static WrPlotSpot *list_spots(const WrLadder *ladder, const WrRung **front, int fronts, Range time,
                              Range error, int *count)
{
    WrPlotSpot *spots = wr_alloc((size_t)ladder->count + 1, sizeof *spots);
    *count = 0;
    for (int i = 0; i < fronts; i++) spots[(*count)++] = spot_of(front[i], time, error);
    for (int i = 0; i < ladder->count; i++)
        if (placed(&ladder->rungs[i]) && !ladder->rungs[i].front)
            spots[(*count)++] = spot_of(&ladder->rungs[i], time, error);
    return spots;
}

/* Position of the text at the reference's line: above or below it, left or right, where it covers the fewest
   points. */
static WrPlotBox place_reference(const WrPlotSpot *spots, int count, double line)
{
    WrPlotBox best = { 0 };
    int least = count + 1;
    for (int i = 0; i < 4; i++) {
        const WrPlotBox box = { i % 2 ? PLOT_RIGHT - 6 - REFERENCE_W : PLOT_LEFT + 6,
                                i < 2 ? line + 3 : line - 21, REFERENCE_W, 18 };
        int covered = box.y < 0 || box.y + box.h > PLOT_BOTTOM - PLOT_TOP ? count : 0;
        for (int k = 0; k < count; k++)
            covered +=
                spots[k].x > box.x - WR_PLOT_MARK && spots[k].x < box.x + box.w + WR_PLOT_MARK &&
                spots[k].y > box.y - WR_PLOT_MARK && spots[k].y < box.y + box.h + WR_PLOT_MARK;
        if (covered >= least) continue;
        least = covered;
        best = box;
    }
    return best;
}

static void add_reference(const WrPlotBox *words, double line, double height, WrText *text)
{
    wr_text_add(text, "set arrow 1 from ");
    add_at((WrPlotSpot){ PLOT_LEFT, line }, height, text);
    wr_text_add(text, " to ");
    add_at((WrPlotSpot){ PLOT_RIGHT, line }, height, text);
    wr_text_add(text, " nohead dt 2 lc rgb '#707070'\nset label 1 'the reference, at its last "
                      "doubling' at ");
    add_at((WrPlotSpot){ words->x, words->y + words->h / 2 }, height, text);
    wr_text_add(text, " font ',11' tc rgb '#505050'\n");
}

/* The front's line in gnuplot's steps: horizontal, then vertical. Two boxes from each point to the next. */
static int add_steps(const WrPlotSpot *spots, int fronts, WrPlotBox *out)
{
    int count = 0;
    for (int i = 0; i + 1 < fronts; i++) {
        const WrPlotSpot from = spots[i], to = spots[i + 1];
        out[count++] = (WrPlotBox){ from.x, from.y - 1, to.x - from.x, 2 };
        out[count++] = (WrPlotBox){ to.x - 1, to.y, 2, from.y - to.y };
    }
    return count;
}

/* The numbers of the front, each connected to its point by a line, and the reference's line. */
static void add_numbers(const WrLadder *ladder, const WrRung **front, int fronts, double height,
                        WrText *text)
{
    Range time, error;
    int count;
    ranges_of(ladder, &time, &error);
    WrPlotSpot *spots = list_spots(ladder, front, fronts, time, error, &count);
    WrPlotSpot *places = wr_alloc((size_t)fronts + 1, sizeof *places);
    const WrPlotBox frame = { PLOT_LEFT, 0, PLOT_RIGHT - PLOT_LEFT, PLOT_BOTTOM - PLOT_TOP };
    WrPlotBox *taken = wr_alloc(2 * (size_t)fronts + 1, sizeof *taken);
    int boxes = add_steps(spots, fronts, taken);
    if (ladder->reference.last_rms > error.low) {
        const double line = along(error, ladder->reference.last_rms) * frame.h;
        taken[boxes] = place_reference(spots, count, line);
        add_reference(&taken[boxes++], line, height, text);
    }
    wr_plot_number_places(&frame, spots, count, fronts, taken, boxes, places);
    for (int i = 0; i < fronts; i++) {
        wr_text_addf(text, "set arrow %d from ", 500 + i);
        add_at(places[i], height, text);
        wr_text_add(text, " to ");
        add_at(spots[i], height, text);
        wr_text_addf(text, " nohead lw 1 lc rgb '#606060' front\nset label %d '%d' at ", 500 + i,
                     i + 1);
        add_at(places[i], height, text);
        wr_text_add(text, " center font ',11' boxed front\n");
    }
    wr_free(spots);
    wr_free(places);
    wr_free(taken);
}

/* ---- the list ---- */

typedef struct List {
    WrText *text; /* NULL: lines are only counted */
    double height;
    int labels, lines;
} List;

static void add_word(List *list, double x, const char *place, const char *word)
{
    if (!list->text) return;
    wr_text_addf(list->text, "set label %d ", 1000 + list->labels++);
    add_quoted(list->text, word);
    wr_text_add(list->text, " noenhanced at ");
    add_at((WrPlotSpot){ x, PLOT_BOTTOM - LIST_TOP - LINE * list->lines }, list->height,
           list->text);
    wr_text_addf(list->text, " %s font ',11'\n", place);
}

/* Wraps at words, or within a word that is longer than a line. */
static void add_setting(List *list, const char *setting)
{
    char line[SETTING_FITS + 1];
    for (;;) {
        size_t length = strlen(setting);
        if (length > SETTING_FITS) {
            length = SETTING_FITS;
            while (length > 0 && setting[length] != ' ') length--;
            if (length == 0) length = SETTING_FITS;
        }
        memcpy(line, setting, length);
        line[length] = '\0';
        add_word(list, SETTING_LEFT, "left", line);
        list->lines++;
        setting += length;
        if (!*setting) return;
        setting += strspn(setting, " ");
    }
}

static void add_row(List *list, const char *number, const WrRung *rung)
{
    char word[40];
    add_word(list, NUMBER_RIGHT, "right", number);
    snprintf(word, sizeof word, "%.3g", 1e3 * rung->seconds);
    add_word(list, TIME_RIGHT, "right", word);
    snprintf(word, sizeof word, "%.2g", rung->errors.rms);
    add_word(list, ERROR_RIGHT, "right", word);
    add_setting(list, rung->full);
}

/* Lists the front, and the scene's own setting if it is not on it. */
static void add_list(const WrLadder *ladder, const WrRung **front, int fronts, List *list)
{
    add_word(list, LEFT, "left", "the front, fast to near");
    list->lines++;
    add_word(list, TIME_RIGHT, "right", "ms");
    add_word(list, ERROR_RIGHT, "right", "RMS error");
    add_word(list, SETTING_LEFT, "left", "setting");
    list->lines++;
    for (int i = 0; i < fronts && i < LISTED; i++) {
        char number[12];
        snprintf(number, sizeof number, "%d", i + 1);
        add_row(list, number, front[i]);
    }
    for (int i = 0; i < ladder->count; i++)
        if (ladder->rungs[i].current && placed(&ladder->rungs[i]) && !ladder->rungs[i].front)
            add_row(list, "o", &ladder->rungs[i]);
}

/* ---- whole script ---- */

/* 1, 2 and 5 of each power of ten, written out. */
static void add_ticks(const char *axis, Range range, WrText *text)
{
    static const double numbers[] = { 1, 2, 5 };
    const char *comma = "";
    wr_text_addf(text, "set %stics (", axis);
    for (int power = (int)floor(log10(range.low)); power <= (int)ceil(log10(range.high)); power++)
        for (int i = 0; i < 3; i++) {
            const double at = numbers[i] * pow(10, power);
            if (at < range.low || at > range.high) continue;
            wr_text_addf(text, "%s'%.6g' %.6g", comma, at, at);
            comma = ", ";
        }
    wr_text_add(text, ")\n");
}

/* One colour and one mark per axis, from a palette for colour-blind readers. */
static void add_series(WrText *text)
{
    static const struct {
        const char *colour;
        int mark;
    } looks[WR_AXIS_COUNT + 1] = { { "#0072b2", 7 },  { "#d55e00", 5 }, { "#009e73", 9 },
                                   { "#cc79a7", 11 }, { "#b8a000", 3 }, { "#e69f00", 13 },
                                   { "#56b4e9", 15 } };
    wr_text_add(text, "plot $front using 1:2 with steps lw 2 lc rgb '#303030' title 'front', \\\n");
    for (int axis = 0; axis <= WR_AXIS_COUNT; axis++) {
        wr_text_addf(text,
                     "  $axis%d using 1:2:3 with xerrorbars pt %d ps 1.2 lw 1.4 lc rgb '%s' title "
                     "'%s', \\\n",
                     axis, looks[axis].mark, looks[axis].colour,
                     axis < WR_AXIS_COUNT ? wr_axis_labels[axis] : "combinations");
    }
    wr_text_add(
        text,
        "  $now using 1:2:3 with xerrorbars pt 7 ps 0.4 lw 1.4 lc rgb '#000000' notitle, \\\n"
        "  $now using 1:2 with points pt 6 ps 2.6 lw 2.5 lc rgb '#000000' title 'as it stands'\n");
}

/* Truncates a long name at its start, since the end is more specific. */
static void add_name(const char *name, WrText *title)
{
    const size_t length = strlen(name);
    const char *from = length > NAME_FITS ? name + length - NAME_FITS : name;
    while ((*from & 0xc0) == 0x80) from++; /* inside a character */
    wr_text_addf(title, "%s%s%s", from > name ? "..." : "", from, name[0] ? ": " : "");
}

static void add_page(const WrLadder *ladder, const char *name, const char *terminal, double height,
                     WrText *text)
{
    WrText title = { 0 };
    add_name(name, &title);
    wr_text_addf(&title, "error against time, %d x %d pixels, %d %s", ladder->width, ladder->height,
                 ladder->threads, ladder->threads == 1 ? "thread" : "threads");
    wr_text_addf(text,
                 "set terminal %s size %d,%.0f font 'DejaVu Sans,12' background rgb "
                 "'#ffffff'\nset title ",
                 terminal, WIDTH, height);
    add_quoted(text, wr_text_get(&title));
    wr_text_addf(
        text,
        " noenhanced font ',14'\n"
        "set logscale xy\n"
        "set xlabel 'time of a frame, ms (bars: half of the runs lie within)'\n"
        "set ylabel 'RMS error of linear intensity' offset screen 0.004, screen 0\n"
        "set grid xtics ytics mxtics mytics lc rgb '#b4b4b4' lw 1, lc rgb '#dedede' lw 0.7\n"
        "set style textbox opaque noborder margins 0.3,0.3\n"
        "set lmargin at screen %.5f\nset rmargin at screen %.5f\n"
        "set tmargin at screen %.5f\nset bmargin at screen %.5f\n"
        "set key at screen %.5f, screen %.5f left top Left reverse samplen 1.5 spacing 1.2\n",
        (double)PLOT_LEFT / WIDTH, (double)PLOT_RIGHT / WIDTH, 1 - PLOT_TOP / height,
        1 - PLOT_BOTTOM / height, (PLOT_RIGHT + 10.0) / WIDTH, 1 - PLOT_TOP / height);
    wr_text_fini(&title);
}

void wr_report_plot_script(const WrLadder *ladder, const char *name, const char *terminal,
                           WrText *text)
{
    int fronts;
    Range time, error;
    const WrRung **front = front_of(ladder, &fronts);
    List list = { 0 };
    add_list(ladder, front, fronts, &list);
    list = (List){ .text = text, .height = height_of(list.lines) };
    add_data(ladder, front, fronts, text);
    add_page(ladder, name, terminal, list.height, text);
    ranges_of(ladder, &time, &error);
    wr_text_addf(text, "set xrange [%.6g:%.6g]\nset yrange [%.6g:%.6g]\n", time.low, time.high,
                 error.low, error.high);
    add_ticks("x", time, text);
    add_ticks("y", error, text);
    add_numbers(ladder, front, fronts, list.height, text);
    add_list(ladder, front, fronts, &list);
    add_series(text);
    wr_free(front);
}

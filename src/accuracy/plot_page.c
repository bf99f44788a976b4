/* The plot of error against time as a file: with spreads, numbers, a key, and the front as a list, each setting in full.
   Its lines are wrapped and the page is made higher, so that every name is included. */
#include "accuracy/plot_labels.h"
#include "accuracy/report.h"

#include "base/enum_rows.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/vector_drawing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Layout in pixels from the upper left corner. */
#define WIDTH 1280
#define PLOT_LEFT 100
#define PLOT_RIGHT 1085
#define PLOT_TOP 76
#define PLOT_BOTTOM 666
#define KEY_LEFT 1105
#define LIST_TOP 762 /* centre of its first line */
#define LINE 23
#define LEFT 20
#define NUMBER_RIGHT 40
#define TIME_RIGHT 130
#define ERROR_RIGHT 230
#define SETTING_LEFT 252
#define SIZE 15.0 /* of text */
#define TITLE 19.0
#define BASELINE 0.36 /* below the middle of a line, of the size */

/* Characters that fit: settings and file names have about 8.5 and 11 pixels a character. */
#define SETTING_FITS 112
#define NAME_FITS 48
#define REFERENCE_W 270 /* width of the text at the reference's line */

#define LISTED 24 /* maximum listed settings of the front */
#define SCALE 1.6 /* of marks and lines; the window's are smaller */

/* ---- the canvas ---- */

/* One colour and one mark per axis, from a palette for colour-blind readers: a disc or a polygon. */
static const struct {
    uint32_t rgb;
    int corners; /* 0: a disc */
    double turn; /* of the first corner from the right, turns clockwise */
} series_marks[] = { { 0x0072b2, 0, 0 },    { 0xd55e00, 4, 0.125 }, { 0x009e73, 3, 0.75 },
                     { 0xcc79a7, 3, 0.25 }, { 0xb8a000, 6, 0.25 },  { 0xe69f00, 4, 0 },
                     { 0x56b4e9, 5, 0.75 } };
_Static_assert(WR_LENGTH(series_marks) == WR_AXIS_COUNT + 1,
               "a mark for each axis and for combinations");

static uint32_t colour_of(WrPlotInk ink)
{
    static const uint32_t colours[WR_PLOT_SERIES] = {
        [WR_PLOT_GRID] = 0xdedede, [WR_PLOT_REFERENCE] = 0x707070, [WR_PLOT_FRONT] = 0x303030
    };
    return ink < WR_PLOT_SERIES ? colours[ink] : series_marks[ink - WR_PLOT_SERIES].rgb;
}

static void line(void *ctx, const WrPlotSpot *points, int count, double width, WrPlotInk ink)
{
    WrVectorDrawingPoint at[WR_PLOT_LINE];
    for (int i = 0; i < count; i++)
        at[i] = (WrVectorDrawingPoint){ (float)points[i].x, (float)points[i].y };
    wr_vector_drawing_colour(ctx, ink == WR_PLOT_GRID ? 1 : width, colour_of(ink));
    wr_vector_drawing_line(ctx, at, count);
}

static WrPlotSpot around(WrPlotSpot middle, double radius, double turns)
{
    double s, c;
    wr_sincos_turns(turns, &s, &c);
    return (WrPlotSpot){ middle.x + radius * c, middle.y + radius * s };
}

/* A polygon is its outline around the disc that fits into it. */
static void mark(void *ctx, WrPlotSpot at, double radius, WrPlotInk ink)
{
    const int corners = series_marks[ink - WR_PLOT_SERIES].corners;
    const double turn = series_marks[ink - WR_PLOT_SERIES].turn;
    const double inner = corners == 0 ? 1 : around((WrPlotSpot){ 0 }, 1, 0.5 / corners).x;
    WrPlotSpot outline[7];
    for (int i = 0; i <= corners; i++)
        outline[i] = around(at, radius, turn + (double)i / fmax(1, corners));
    line(ctx, (const WrPlotSpot[]){ at, at }, 2, 2 * radius * inner, ink);
    if (corners > 0) line(ctx, outline, corners + 1, 1.5, ink);
}

static void ring(void *ctx, WrPlotSpot at, double radius, double width)
{
    WrPlotSpot points[33];
    for (int i = 0; i < 33; i++) points[i] = around(at, radius, i / 32.0);
    line(ctx, points, 33, width, WR_PLOT_RING);
}

static void write_word(WrVectorDrawing *to, const char *text, double x, double y, double size,
                       double anchor)
{
    wr_vector_drawing_colour(to, 1, 0);
    wr_vector_drawing_word(to, text, x, y + BASELINE * size, size, anchor);
}

static void word(void *ctx, const char *text, double x, double y, double anchor, WrPlotInk ink)
{
    (void)ink;
    write_word(ctx, text, x, y, SIZE, anchor);
}

/* ---- numbers in the plot ---- */

/* The front's points, then all others. The caller frees. */
static WrPlotSpot *list_spots(const WrPlot *plot, int *count)
{
    const WrRung *rungs = plot->ladder->rungs;
    WrPlotSpot *spots = wr_alloc((size_t)plot->ladder->count + 1, sizeof *spots);
    *count = 0;
    for (int i = 0; i < plot->fronts; i++) spots[(*count)++] = plot->spots[plot->front[i]];
    for (int i = 0; i < plot->ladder->count; i++)
        if (wr_plot_has_point(&rungs[i]) && !rungs[i].front) spots[(*count)++] = plot->spots[i];
    return spots;
}

/* The front's steps: two boxes from each point to the next. */
static int add_steps(const WrPlotSpot *spots, int fronts, WrPlotBox *out)
{
    int count = 0;
    for (int i = 0; i + 1 < fronts; i++) {
        const WrPlotSpot from = spots[i], to = spots[i + 1];
        out[count++] = (WrPlotBox){ from.x, from.y - 1, to.x - from.x, 2 };
        out[count++] = (WrPlotBox){ to.x - 1, from.y, 2, to.y - from.y };
    }
    return count;
}

/* The numbers of the front, each connected to its point by a line. */
static void draw_numbers(const WrPlot *plot, WrVectorDrawing *to)
{
    const WrPlotBox frame = { plot->x, plot->y, plot->w, plot->h };
    double y;
    int count;
    WrPlotSpot *spots = list_spots(plot, &count);
    WrPlotSpot *places = wr_alloc((size_t)plot->fronts + 1, sizeof *places);
    WrPlotBox *taken = wr_alloc(2 * (size_t)plot->fronts + 2, sizeof *taken);
    int boxes = add_steps(spots, plot->fronts, taken);
    if (wr_plot_reference(plot, &y)) {
        taken[boxes++] = (WrPlotBox){ frame.x, y - 1, frame.w, 2 };
        taken[boxes++] = (WrPlotBox){ frame.x, y - 24, REFERENCE_W, 24 };
    }
    wr_plot_number_places(&frame, spots, count, plot->fronts, taken, boxes, places);
    for (int i = 0; i < plot->fronts; i++) {
        char number[12];
        snprintf(number, sizeof number, "%d", i + 1);
        /* The line ends before the number. */
        const double dx = spots[i].x - places[i].x, dy = spots[i].y - places[i].y,
                     part = fmin(1, 10 / hypot(dx, dy));
        const WrPlotSpot lead[] = { { places[i].x + part * dx, places[i].y + part * dy },
                                    spots[i] };
        line(to, lead, 2, 1, WR_PLOT_REFERENCE);
        write_word(to, number, places[i].x, places[i].y, SIZE, 0.5);
    }
    wr_free(spots);
    wr_free(places);
    wr_free(taken);
}

static void draw_spreads(const WrPlot *plot, WrVectorDrawing *to)
{
    for (int i = 0; i < plot->ladder->count; i++) {
        const WrRung *rung = &plot->ladder->rungs[i];
        if (!wr_plot_has_point(rung)) continue;
        const double start = wr_plot_place(&plot->time, 1e3 * (rung->seconds - rung->spread)),
                     end = wr_plot_place(&plot->time, 1e3 * (rung->seconds + rung->spread));
        const double y = plot->spots[i].y;
        const WrPlotSpot bar[] = { { plot->x + plot->w * fmax(0, start), y },
                                   { plot->x + plot->w * fmin(1, end), y } };
        line(to, bar, 2, 1.4, WR_PLOT_SERIES + rung->axis);
    }
}

/* ---- the key ---- */

static bool has_series(const WrLadder *ladder, int axis)
{
    for (int i = 0; i < ladder->count; i++)
        if (wr_plot_has_point(&ladder->rungs[i]) && (int)ladder->rungs[i].axis == axis) return true;
    return false;
}

static void draw_key(const WrLadder *ladder, bool ringed, WrVectorDrawing *to)
{
    double y = PLOT_TOP + 10;
    const WrPlotSpot front[] = { { KEY_LEFT - 10, y }, { KEY_LEFT + 10, y } };
    line(to, front, 2, 1.5 * SCALE, WR_PLOT_FRONT);
    write_word(to, "front", KEY_LEFT + 20, y, SIZE, 0);
    for (int axis = 0; axis <= WR_AXIS_COUNT; axis++) {
        if (!has_series(ladder, axis)) continue;
        y += LINE;
        mark(to, (WrPlotSpot){ KEY_LEFT, y }, 4 * SCALE, WR_PLOT_SERIES + axis);
        write_word(to, axis < WR_AXIS_COUNT ? wr_axis_labels[axis] : "combinations", KEY_LEFT + 20,
                   y, SIZE, 0);
    }
    if (!ringed) return;
    y += LINE;
    ring(to, (WrPlotSpot){ KEY_LEFT, y }, 5 * SCALE, 2 * SCALE);
    write_word(to, "as it stands", KEY_LEFT + 20, y, SIZE, 0);
}

/* ---- the list ---- */

typedef struct List {
    WrVectorDrawing *to; /* NULL: lines are only counted */
    int lines;
} List;

static void add_word(const List *list, double x, double anchor, const char *text)
{
    if (list->to) write_word(list->to, text, x, LIST_TOP + LINE * list->lines, SIZE, anchor);
}

/* Wraps at words, or within a word that is longer than a line. */
static void add_setting(List *list, const char *setting)
{
    char text[SETTING_FITS + 1];
    for (;;) {
        size_t length = strlen(setting);
        if (length > SETTING_FITS) {
            length = SETTING_FITS;
            while (length > 0 && setting[length] != ' ') length--;
            if (length == 0) length = SETTING_FITS;
        }
        memcpy(text, setting, length);
        text[length] = '\0';
        add_word(list, SETTING_LEFT, 0, text);
        list->lines++;
        setting += length;
        if (!*setting) return;
        setting += strspn(setting, " ");
    }
}

static void add_row(List *list, const char *number, const WrRung *rung)
{
    char text[40];
    add_word(list, NUMBER_RIGHT, 1, number);
    snprintf(text, sizeof text, "%.3g", 1e3 * rung->seconds);
    add_word(list, TIME_RIGHT, 1, text);
    snprintf(text, sizeof text, "%.2g", rung->errors.rms);
    add_word(list, ERROR_RIGHT, 1, text);
    add_setting(list, rung->full);
}

/* Lists the front, and the scene's own setting if it is not on it. */
static void add_list(const WrPlot *plot, int ringed, List *list)
{
    const WrRung *rungs = plot->ladder->rungs;
    add_word(list, LEFT, 0, "the front, fast to near");
    list->lines++;
    add_word(list, TIME_RIGHT, 1, "ms");
    add_word(list, ERROR_RIGHT, 1, "RMS error");
    add_word(list, SETTING_LEFT, 0, "setting");
    list->lines++;
    for (int i = 0; i < plot->fronts && i < LISTED; i++) {
        char number[12];
        snprintf(number, sizeof number, "%d", i + 1);
        add_row(list, number, &rungs[plot->front[i]]);
    }
    if (ringed >= 0 && !rungs[ringed].front) add_row(list, "o", &rungs[ringed]);
}

/* ---- the page ---- */

/* Truncates a long name at its start, since the end is more specific. */
static void draw_title(const WrLadder *ladder, const char *name, WrVectorDrawing *to)
{
    const size_t length = strlen(name);
    const char *from = length > NAME_FITS ? name + length - NAME_FITS : name;
    WrText title = { 0 };
    while ((*from & 0xc0) == 0x80) from++; /* inside a character */
    wr_text_addf(&title, "%s%s%serror against time, %d x %d pixels, %d %s",
                 from > name ? "..." : "", from, name[0] ? ": " : "", ladder->width, ladder->height,
                 ladder->threads, ladder->threads == 1 ? "thread" : "threads");
    write_word(to, wr_text_get(&title), (PLOT_LEFT + PLOT_RIGHT) / 2.0, 24, TITLE, 0.5);
    wr_text_fini(&title);
    write_word(to, "RMS error of linear intensity", LEFT, PLOT_TOP - 24, SIZE, 0);
    write_word(to, "time of a frame, ms (bars: half of the runs lie within)",
               (PLOT_LEFT + PLOT_RIGHT) / 2.0, PLOT_BOTTOM + 48, SIZE, 0.5);
}

static int find_current(const WrLadder *ladder)
{
    for (int i = 0; i < ladder->count; i++)
        if (ladder->rungs[i].current && wr_plot_has_point(&ladder->rungs[i])) return i;
    return -1;
}

static void draw_page(const WrPlot *plot, const char *name, int ringed, WrVectorDrawing *to)
{
    const WrPlotCanvas canvas = { .ctx = to,
                                  .unit = SCALE,
                                  .text = SIZE,
                                  .times = WR_PLOT_TICKS,
                                  .errors = WR_PLOT_TICKS,
                                  .line = line,
                                  .mark = mark,
                                  .ring = ring,
                                  .word = word };
    List list = { .to = to };
    draw_title(plot->ladder, name, to);
    draw_spreads(plot, to);
    draw_numbers(plot, to);
    wr_plot_draw(plot, &canvas, "the reference, at its last doubling", ringed);
    draw_key(plot->ladder, ringed >= 0, to);
    add_list(plot, ringed, &list);
}

bool wr_report_plot(const WrLadder *ladder, const char *name, const char *path, WrError *err)
{
    char ending[16];
    WrPlot plot;
    List list = { 0 };
    wr_path_ending(path, ending);
    if (strcmp(ending, "svg") != 0 && strcmp(ending, "pdf") != 0 && strcmp(ending, "png") != 0)
        return wr_fail(err, "plot %s: the name must end in .pdf, .png or .svg", path);
    wr_plot_init(ladder, &plot);
    wr_plot_lay_out(&plot, PLOT_LEFT, PLOT_TOP, PLOT_RIGHT - PLOT_LEFT, PLOT_BOTTOM - PLOT_TOP);
    const int ringed = find_current(ladder);
    add_list(&plot, ringed, &list);
    WrVectorDrawing *to = wr_vector_drawing_new(path, WIDTH, LIST_TOP + LINE * list.lines, 3, err);
    if (to) draw_page(&plot, name, ringed, to);
    const bool good = to && wr_vector_drawing_write(to, err);
    wr_vector_drawing_free(to);
    wr_plot_fini(&plot);
    return good;
}

/* Placement of numbers beside their points: for each point in turn, the best free place around it. */
#include "accuracy/plot_labels.h"

#include "base/exactmath.h"

#include <math.h>
#include <stdbool.h>

#define DIGIT_W 9.5
#define NUMBER_H 18.0
#define NEAREST 17.0 /* distance from a point to the centre of its number */
#define RING 6.0     /* distance between rings of places */
#define TURNS 16     /* places on a ring */
#define CLOSE 8.0    /* a line this near to a point seems to end there */
/* Penalties of a place, in pixels of distance. */
#define NEAR_OTHER 24.0
#define THROUGH 60.0 /* the line to the point passes another point or number */

WrPlotBox wr_plot_number_box(WrPlotSpot middle, int number)
{
    const double w = DIGIT_W * (number < 10 ? 1 : number < 100 ? 2 : 3) + 4;
    return (WrPlotBox){ middle.x - w / 2, middle.y - NUMBER_H / 2, w, NUMBER_H };
}

static double distance(WrPlotSpot a, WrPlotSpot b)
{
    return hypot(a.x - b.x, a.y - b.y);
}

/* Distance of a spot from the line between two. */
static double beside(WrPlotSpot spot, WrPlotSpot a, WrPlotSpot b)
{
    const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    if (square == 0) return distance(spot, a);
    const double t = fmin(1, fmax(0, ((spot.x - a.x) * dx + (spot.y - a.y) * dy) / square));
    return distance(spot, (WrPlotSpot){ a.x + t * dx, a.y + t * dy });
}

typedef struct Sheet {
    const WrPlotBox *frame, *taken;
    const WrPlotSpot *points;
    int count, boxes;
    const WrPlotSpot *placed; /* [done] */
    int done;
} Sheet;

static WrPlotBox mark_box(WrPlotSpot at)
{
    return (WrPlotBox){ at.x - WR_PLOT_MARK, at.y - WR_PLOT_MARK, 2 * WR_PLOT_MARK,
                        2 * WR_PLOT_MARK };
}

static bool free_place(const Sheet *sheet, const WrPlotBox *box)
{
    const WrPlotBox *frame = sheet->frame;
    if (box->x < frame->x + 2 || box->x + box->w > frame->x + frame->w - 2 ||
        box->y < frame->y + 2 || box->y + box->h > frame->y + frame->h - 2)
        return false;
    for (int i = 0; i < sheet->boxes; i++)
        if (!wr_plot_apart(box, &sheet->taken[i])) return false;
    for (int i = 0; i < sheet->count; i++) {
        const WrPlotBox mark = mark_box(sheet->points[i]);
        if (!wr_plot_apart(box, &mark)) return false;
    }
    for (int i = 0; i < sheet->done; i++) {
        const WrPlotBox other = wr_plot_number_box(sheet->placed[i], i + 1);
        if (!wr_plot_apart(box, &other)) return false;
    }
    return true;
}

/* Ambiguity of a free place: penalty for being mistaken for another point's number. */
static double badness(const Sheet *sheet, int own, WrPlotSpot at)
{
    const WrPlotSpot point = sheet->points[own];
    double bad = distance(at, point);
    bool nearer = false, through = false;
    for (int i = 0; i < sheet->count; i++) {
        const WrPlotSpot other = sheet->points[i];
        if (distance(other, point) < 1) continue; /* visually the same point */
        nearer |= distance(at, other) < distance(at, point);
        through |= beside(other, at, point) < CLOSE && distance(other, point) > CLOSE;
    }
    for (int i = 0; i < sheet->done; i++)
        through |= beside(sheet->placed[i], at, point) < NUMBER_H / 2 + 2 ||
                   beside(at, sheet->placed[i], sheet->points[i]) < NUMBER_H / 2 + 2;
    return bad + NEAR_OTHER * nearer + THROUGH * through;
}

static WrPlotSpot place(const Sheet *sheet, int own)
{
    const WrPlotSpot point = sheet->points[own];
    WrPlotSpot best = point;
    double least = INFINITY;
    for (double radius = NEAREST; radius < fmin(least, sheet->frame->w + sheet->frame->h);
         radius += RING)
        for (int turn = 0; turn < TURNS; turn++) {
            /* Above and to the right first, among equally good places. */
            const double angle =
                WR_PI * (0.25 + (turn % 2 ? -1 : 1) * (turn + 1) / 2 * 2.0 / TURNS);
            const WrPlotSpot at = { point.x + radius * cos(angle), point.y - radius * sin(angle) };
            const WrPlotBox box = wr_plot_number_box(at, own + 1);
            if (!free_place(sheet, &box)) continue;
            const double bad = badness(sheet, own, at);
            if (bad >= least - 1e-6) continue;
            least = bad;
            best = at;
        }
    return best;
}

void wr_plot_number_places(const WrPlotBox *frame, const WrPlotSpot *points, int count, int numbers,
                           const WrPlotBox *taken, int boxes, WrPlotSpot *out)
{
    Sheet sheet = { frame, taken, points, count, boxes, out, 0 };
    for (int i = 0; i < numbers; i++) {
        out[i] = place(&sheet, i);
        sheet.done = i + 1;
    }
}

#include "ui/canvas/ants.h"
#include "ui/canvas/view.h"

#include "base/array.h"
#include "field/select.h"

#include <SDL.h>
#include <math.h>

#define COPIES_MAX 4096 /* of a line: a cell may be a pixel wide */

typedef struct Spot {
    double x, y;  /* pixels */
    double along; /* pixels */
} Spot;

typedef WR_ARRAY(Spot) Spots;

void wr_ants_free(WrAnts *ants)
{
    wr_array_free(&ants->pixels);
}

/* The part t0..t1 of a segment that lies in low..high along one axis; false: none. */
static bool clip(double from, double to, double low, double high, double *t0, double *t1)
{
    double d = to - from;
    if (d == 0.0) return from >= low && from <= high;
    double a = (low - from) / d, b = (high - from) / d;
    double near_by = a < b ? a : b, far_off = a < b ? b : a;
    *t0 = near_by > *t0 ? near_by : *t0;
    *t1 = far_off < *t1 ? far_off : *t1;
    return *t0 <= *t1;
}

/* The pixels of one segment inside the view, the last one left to the next segment. */
static void add_segment(WrAnts *ants, const WrCanvasView *view, Spot a, Spot b)
{
    double t0 = 0.0, t1 = 1.0;
    if (!clip(a.x, b.x, view->x, view->x + view->w, &t0, &t1)) return;
    if (!clip(a.y, b.y, view->y, view->y + view->h, &t0, &t1)) return;
    double steps = fmax(1.0, ceil(fmax(fabs(b.x - a.x), fabs(b.y - a.y))));
    for (double k = ceil(t0 * steps); k < steps && k <= t1 * steps; k += 1.0) {
        double t = k / steps;
        SDL_Point at = { (int)floor(a.x + t * (b.x - a.x)), (int)floor(a.y + t * (b.y - a.y)) };
        if (at.x < view->x || at.y < view->y || at.x >= view->x + view->w ||
            at.y >= view->y + view->h)
            continue;
        if (ants->pixels.count >= WR_ANTS_MAX) {
            ants->cut = true;
            return;
        }
        wr_array_push(&ants->pixels, ((WrAnt){ at, (float)(a.along + t * (b.along - a.along)) }));
    }
}

/* The line in pixels where it stands, points nearer than half a pixel left out, closed. */
static void to_pixels(const WrSelectPoint *points, int count, int wind_u, int wind_v,
                      const WrCanvasView *view, Spots *spots)
{
    double w = view->table_w, h = view->table_h;
    spots->count = 0;
    for (int i = 0; i <= count; i++) {
        double u = points[i % count].u + (i == count ? wind_u : 0);
        double v = points[i % count].v + (i == count ? wind_v : 0);
        Spot spot = { 0 };
        wr_view_to_pixel(view, u * w, (1.0 - v) * h, &spot.x, &spot.y);
        if (spots->count > 0) {
            const Spot *last = &spots->data[spots->count - 1];
            double step = hypot(spot.x - last->x, spot.y - last->y);
            if (step < 0.5 && i < count) continue;
            spot.along = last->along + step;
        }
        wr_array_push(spots, spot);
    }
}

/* Copies first..last along one axis put [low, high] into [from, to]. */
static void copies(double low, double high, double from, double to, double period, bool wraps,
                   int *first, int *last)
{
    *first = *last = 0;
    if (!wraps) return;
    double a = ceil((from - high) / period), b = floor((to - low) / period);
    *first = (int)fmax(-1e6, a);
    *last = (int)fmin(1e6, b);
}

void wr_ants_add(WrAnts *ants, const WrSelectPoint *points, int count, int wind_u, int wind_v,
                 const WrCanvasView *view, bool wraps_u, bool wraps_v)
{
    Spots spots = { 0 };
    if (count < 1) return; /* one is enough for a straight line round the table */
    to_pixels(points, count, wind_u, wind_v, view, &spots);
    double x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;
    for (int i = 0; i < spots.count; i++) {
        x0 = fmin(x0, spots.data[i].x);
        x1 = fmax(x1, spots.data[i].x);
        y0 = fmin(y0, spots.data[i].y);
        y1 = fmax(y1, spots.data[i].y);
    }
    double period_x = view->table_w * view->zoom, period_y = view->table_h * view->zoom;
    int i0, i1, j0, j1, made = 0;
    copies(x0, x1, view->x, view->x + view->w, period_x, wraps_u, &i0, &i1);
    copies(y0, y1, view->y, view->y + view->h, period_y, wraps_v, &j0, &j1);
    for (int j = j0; j <= j1; j++) {
        for (int i = i0; i <= i1 && made < COPIES_MAX && !ants->cut; i++, made++) {
            for (int k = 0; k + 1 < spots.count && !ants->cut; k++) {
                Spot a = spots.data[k], b = spots.data[k + 1];
                a.x += i * period_x;
                b.x += i * period_x;
                a.y += j * period_y;
                b.y += j * period_y;
                add_segment(ants, view, a, b);
            }
        }
    }
    wr_array_free(&spots);
}

void wr_ants_trace(WrAnts *ants, const WrOutline *outline, const WrCanvasView *view, bool wraps_u,
                   bool wraps_v)
{
    ants->pixels.count = 0;
    ants->cut = false;
    for (int i = 0; i < outline->loop_count && !ants->cut; i++) {
        const WrOutlineLoop *loop = &outline->loops[i];
        wr_ants_add(ants, outline->points + loop->first, loop->count, loop->wind_u, loop->wind_v,
                    view, wraps_u, wraps_v);
    }
}

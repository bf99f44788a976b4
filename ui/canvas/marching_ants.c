#include "ui/canvas/marching_ants.h"
#include "ui/canvas/view.h"

#include "base/array.h"
#include "field/select.h"

#include <SDL.h>
#include <math.h>

#define COPIES_MAX 4096 /* copies of a line: a cell may be one pixel wide */

typedef struct Spot {
    double x, y;  /* pixels */
    double along; /* pixels */
} Spot;

typedef WR_ARRAY(Spot) Spots;

void wr_marching_ants_free(WrMarchingAnts *ants)
{
    wr_array_free(&ants->pixels);
}

/* Parameters t0..t1 of the part of a segment inside low..high along one axis; false: none. */
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

/* Pixels of one segment inside the view; the last pixel belongs to the next segment. */
static void add_segment(WrMarchingAnts *ants, const WrCanvasView *view, Spot a, Spot b)
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
        if (ants->pixels.count >= WR_MARCHING_ANTS_MAX) {
            ants->cut = true;
            return;
        }
        wr_array_push(&ants->pixels, ((WrAnt){ at, (float)(a.along + t * (b.along - a.along)) }));
    }
}

/* The closed line in pixels at its own position, without points closer than half a pixel. */
static void to_pixels(const WrSelectPoint *points, int count, int wind_u, int wind_v,
                      const WrCanvasView *view, Spots *spots)
{
    double w = view->table_w, h = view->table_h;
    spots->count = 0;
    for (int i = 0; i <= count; i++) {
        double u = points[i % count].u + (i == count ? wind_u : 0);
        double v = points[i % count].v + (i == count ? wind_v : 0);
        Spot spot = { 0 };
        wr_view_place(view, u * w, (1.0 - v) * h, &spot.x, &spot.y);
        if (spots->count > 0) {
            const Spot *last = &spots->data[spots->count - 1];
            double step = hypot(spot.x - last->x, spot.y - last->y);
            if (step < 0.5 && i < count) continue;
            spot.along = last->along + step;
        }
        wr_array_push(spots, spot);
    }
}

/* Range of copies along one axis: the visible ones, extended by the line's own size in cells. */
static void copies(int from, int to, double low, double high, bool wraps, int *first, int *last)
{
    *first = *last = 0;
    if (!wraps) return;
    *first = from - (int)floor(high);
    *last = to - (int)floor(low);
}

/* Bounding box of the line in pixels. */
static void box_of(const Spots *spots, double box[4])
{
    box[0] = box[2] = INFINITY;
    box[1] = box[3] = -INFINITY;
    for (int i = 0; i < spots->count; i++) {
        box[0] = fmin(box[0], spots->data[i].x);
        box[1] = fmax(box[1], spots->data[i].x);
        box[2] = fmin(box[2], spots->data[i].y);
        box[3] = fmax(box[3], spots->data[i].y);
    }
}

static bool sees(const WrCanvasView *view, const double box[4], double dx, double dy)
{
    return box[0] + dx <= view->x + view->w && box[1] + dx >= view->x &&
           box[2] + dy <= view->y + view->h && box[3] + dy >= view->y;
}

static void add_copy(WrMarchingAnts *ants, const WrCanvasView *view, const Spots *spots, double dx,
                     double dy)
{
    for (int k = 0; k + 1 < spots->count && !ants->cut; k++) {
        Spot a = spots->data[k], b = spots->data[k + 1];
        a.x += dx;
        b.x += dx;
        a.y += dy;
        b.y += dy;
        add_segment(ants, view, a, b);
    }
}

void wr_marching_ants_add(WrMarchingAnts *ants, const WrSelectPoint *points, int count, int wind_u,
                          int wind_v, const WrCanvasView *view, bool wraps_u, bool wraps_v)
{
    Spots spots = { 0 };
    if (count < 1) return; /* one is enough for a straight line around the table */
    to_pixels(points, count, wind_u, wind_v, view, &spots);
    double box[4], low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    box_of(&spots, box);
    for (int i = 0; i <= count; i++) { /* in cells, to the right and down */
        double u = points[i % count].u + (i == count ? wind_u : 0);
        double v = points[i % count].v + (i == count ? wind_v : 0);
        low[0] = fmin(low[0], u), high[0] = fmax(high[0], u);
        low[1] = fmin(low[1], 1.0 - v), high[1] = fmax(high[1], 1.0 - v);
    }
    WrCellRange cells = wr_view_cells(view);
    int i0, i1, j0, j1, made = 0;
    copies(cells.i0, cells.i1, low[0], high[0], wraps_u, &i0, &i1);
    copies(cells.j0, cells.j1, low[1], high[1], wraps_v, &j0, &j1);
    for (int j = j0; j <= j1; j++) {
        for (int i = i0; i <= i1 && made < COPIES_MAX && !ants->cut; i++) {
            double dx, dy, px, py;
            wr_view_tiling_shift(view, i, j, &dx, &dy);
            wr_view_step(view, i * (double)view->table_w + dx, j * (double)view->table_h + dy, &px,
                         &py);
            if (!sees(view, box, px, py)) continue;
            add_copy(ants, view, &spots, px, py);
            made++;
        }
    }
    wr_array_free(&spots);
}

void wr_marching_ants_trace(WrMarchingAnts *ants, const WrOutline *outline,
                            const WrCanvasView *view, bool wraps_u, bool wraps_v)
{
    ants->pixels.count = 0;
    ants->cut = false;
    for (int i = 0; i < outline->loop_count && !ants->cut; i++) {
        const WrOutlineLoop *loop = &outline->loops[i];
        wr_marching_ants_add(ants, outline->points + loop->first, loop->count, loop->wind_u,
                             loop->wind_v, view, wraps_u, wraps_v);
    }
}

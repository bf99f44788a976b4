#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_mips.h"
#include "ui/canvas/canvas_colors.h"
#include "ui/canvas/view.h"
#include "ui/toolkit/retained_frame.h"
#include "ui/toolkit/theme.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_RANGE 1.0
#define DIRTY_MAX 4096          /* tiles; with more, the whole picture is redrawn */
#define BAND 16                 /* rows, work of a thread */
#define MANY_PIXELS (256 * 256) /* of a rectangle; number worth several threads */

/* Memory of one thread. */
typedef struct Lines {
    float *line[2];          /* sums of one cell row: [tiles_u * side] */
    float *value[2], *above; /* [width]: values of the present row, and of the previous one */
} Lines;

struct WrCanvas {
    WrCanvasMips *cells[2]; /* second component: slopes along v */
    int fields;             /* number of fields shown together */
    WrRetainedFrame *kept;  /* frame that is drawn into; borrowed */
    SDL_Texture *texture;
    int width, height;          /* picture size */
    uint32_t *pixels;           /* [height][width], ARGB, before rotation */
    uint32_t *turned;           /* size of the texture, if the view is rotated; else NULL */
    WrCellTaps *columns, *rows; /* [2][width], [2][height]: the second one for shifted copies */
    bool *moved_column,
        *moved_row;          /* [width], [height]: the tiling shifts that copy down, to the right */
    Lines *lines;            /* [threads of the pool] */
    bool *needed, *needed_v; /* [tiles_u], [tiles_v] tile columns and rows used by a rectangle */
    int threads;             /* 0: one per processor */
    WrPool *pool;            /* owned; created with the first picture */
    WrCanvasInk ink;
    WrCanvasView view, flat; /* view of the present picture, and without rotation */
    WrCanvasDisplay look;
    double low, high;
    /* automatic ranges of the table and of its maps; empty: to be chosen again. tried: of a preview */
    double follows[WR_CANVAS_SHOWN][2], tried[2];
    float table_low, table_high;
    bool valid, flooded;
    WR_ARRAY(SDL_Point) dirty; /* tiles */
};

WrCanvas *wr_canvas_new(int threads)
{
    WrCanvas *canvas = wr_alloc(1, sizeof *canvas);
    canvas->threads = threads;
    for (int k = 0; k < 2; k++) canvas->cells[k] = wr_canvas_mips_new();
    return canvas;
}

void wr_canvas_fit_range(WrCanvas *canvas)
{
    memset(canvas->follows, 0, sizeof canvas->follows);
}

void wr_canvas_forget(WrCanvas *canvas)
{
    if (canvas->texture) SDL_DestroyTexture(canvas->texture);
    canvas->texture = NULL;
    canvas->valid = false;
}

static void free_buffers(WrCanvas *canvas)
{
    wr_free(canvas->pixels);
    wr_free(canvas->turned);
    wr_free(canvas->columns);
    wr_free(canvas->rows);
    wr_free(canvas->moved_column);
    wr_free(canvas->moved_row);
    for (int i = 0; canvas->lines && i < wr_pool_threads(canvas->pool); i++) {
        Lines *lines = &canvas->lines[i];
        for (int k = 0; k < 2; k++) wr_free(lines->line[k]), wr_free(lines->value[k]);
        wr_free(lines->above);
    }
    wr_free(canvas->lines);
    canvas->lines = NULL;
    wr_free(canvas->needed);
    wr_free(canvas->needed_v);
    canvas->pixels = canvas->turned = NULL;
    canvas->columns = canvas->rows = NULL;
    canvas->moved_column = canvas->moved_row = NULL;
    canvas->needed = canvas->needed_v = NULL;
}

void wr_canvas_free(WrCanvas *canvas)
{
    if (!canvas) return;
    wr_canvas_forget(canvas);
    free_buffers(canvas);
    wr_array_free(&canvas->dirty);
    for (int k = 0; k < 2; k++) wr_canvas_mips_free(canvas->cells[k]);
    wr_pool_free(canvas->pool);
    wr_free(canvas);
}

uint32_t wr_canvas_colour(const WrCanvas *canvas, double height)
{
    return wr_canvas_ink_colour(&canvas->ink, height);
}

double wr_canvas_contour_interval(const WrCanvas *canvas)
{
    return canvas->ink.step;
}

/* ---- the picture ---- */

/* Taps along one axis, and again shifted by half a cell for copies that the tiling shifts. */
static void make_taps_along(WrCellTaps *taps, bool *moved, int count, bool reversed, double from,
                            double zoom, int size, int level, bool wraps)
{
    for (int i = 0; i < count; i++) {
        const int at = reversed ? count - 1 - i : i;
        double x0 = from + i / zoom, x1 = from + (i + 1) / zoom, half = size / 2.0;
        taps[at] = wr_taps_make(x0, x1, size, level, wraps);
        taps[count + at] = wr_taps_make(x0 - half, x1 - half, size, level, wraps);
        moved[at] = fmod(floor((x0 + x1) / 2.0 / size), 2.0) != 0.0;
    }
}

static void make_taps(WrCanvas *canvas, const WrField *field, int level)
{
    const WrCanvasView *view = &canvas->flat;
    bool wraps_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
    bool wraps_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    double x0 = view->centre_x - view->w / 2.0 / view->zoom;
    double y0 = view->centre_y - view->h / 2.0 / view->zoom;
    make_taps_along(canvas->columns, canvas->moved_column, view->w, view->mirrored, x0, view->zoom,
                    view->table_w, level, wraps_u);
    make_taps_along(canvas->rows, canvas->moved_row, view->h, false, y0, view->zoom, view->table_h,
                    level, wraps_v);
}

/* A rectangle with one set of rows, painted in bands. */
typedef struct Run {
    WrCanvas *canvas;
    SDL_Rect rect;
    int x0, x1, left; /* columns; left: with the neighbour that contours need */
    const WrCellTaps *rows;
    int tiles_u, level;
    double deadline;
} Run;

/* Weighted sum of the cell rows under one pixel row, over the needed tile columns. */
static void make_line(const Run *run, int field, const WrCellTaps *row, float *all)
{
    const int side = WR_TILE >> run->level, shift = 6 - run->level;
    for (int tx = 0; tx < run->tiles_u; tx++) {
        if (!run->canvas->needed[tx]) continue;
        float *line = all + (size_t)tx * (size_t)side;
        memset(line, 0, (size_t)side * sizeof *line);
        for (int k = 0; k < WR_TAPS; k++) {
            float weight = row->weight[k], flat = 0.0f;
            if (weight == 0.0f) continue;
            const float *block = wr_canvas_mips_block(run->canvas->cells[field], tx,
                                                      row->cell[k] >> shift, run->deadline, &flat);
            const float *from = block ? block + (row->cell[k] & (side - 1)) * side : NULL;
            if (!from)
                for (int i = 0; i < side; i++) line[i] += weight * flat;
            else
                for (int i = 0; i < side; i++) line[i] += weight * from[i];
        }
    }
}

/* Values of the run's pixels in a row; NaN beyond the table. */
static void make_values(const Run *run, const WrCellTaps *row, const WrCellTaps *columns,
                        const Lines *lines)
{
    for (int k = 0; k < run->canvas->fields; k++) {
        const float *line = lines->line[k];
        float *value = lines->value[k];
        make_line(run, k, row, lines->line[k]);
        for (int x = run->left; x < run->x1; x++) {
            const WrCellTaps *t = &columns[x];
            float sum = t->weight[0] * line[t->cell[0]] + t->weight[1] * line[t->cell[1]] +
                        t->weight[2] * line[t->cell[2]] + t->weight[3] * line[t->cell[3]];
            value[x] = t->outside ? NAN : sum;
        }
    }
}

/* above: lines->above contains the previous row. */
static void paint_line(const Run *run, const WrCellTaps *columns, const Lines *lines, bool above,
                       uint32_t *out)
{
    const WrCanvas *canvas = run->canvas;
    const float *value = lines->value[0];
    const int x0 = run->x0, x1 = run->x1;
    if (canvas->fields == 2)
        wr_canvas_ink_slopes(&canvas->ink, value + x0, lines->value[1] + x0, x1 - x0, out + x0);
    else
        wr_canvas_ink_heights(&canvas->ink, value + x0, value[x0 > 0 ? x0 - 1 : 0],
                              above ? lines->above + x0 : NULL, x1 - x0, out + x0);
    for (int x = x0; x < x1; x++)
        if (columns[x].outside) out[x] = WR_COLOUR_SURROUND;
}

/* Keep the row for the contours of the next one. */
static void keep_above(Lines *lines)
{
    float *value = lines->value[0];
    lines->value[0] = lines->above;
    lines->above = value;
}

/* Mark the tile columns used by pixel columns x0 to x1. */
static void need(WrCanvas *canvas, const WrCellTaps *columns, int x0, int x1, int shift)
{
    for (int x = x0; x < x1; x++)
        for (int k = 0; k < WR_TAPS; k++) canvas->needed[columns[x].cell[k] >> shift] = true;
}

/* Rows y0 to y1 of a run; independent of the rows of other bands. */
static void paint_band(const Run *run, int y0, int y1, Lines *lines)
{
    const WrCanvas *canvas = run->canvas;
    const bool brick = canvas->flat.tiling == WR_TILING_BRICK;
    const bool lined = canvas->look.colours == WR_CANVAS_CONTOURS;
    const int x0 = run->x0, x1 = run->x1;
    const size_t bytes = (size_t)(x1 - x0) * sizeof *canvas->pixels;
    bool above = false;
    for (int y = lined && y0 > 0 ? y0 - 1 : y0; y < y1; y++) { /* contours need the previous row */
        const WrCellTaps *row = &run->rows[y];
        bool moved = brick && canvas->moved_row[y];
        bool again = !lined && y > y0 && memcmp(row, row - 1, sizeof *row) == 0 &&
                     moved == (brick && canvas->moved_row[y - 1]);
        uint32_t *out = canvas->pixels + (size_t)y * (size_t)canvas->width;
        const WrCellTaps *columns = canvas->columns + (moved ? canvas->width : 0);
        if (row->outside) {
            for (int x = x0; x < x1 && y >= y0; x++) out[x] = WR_COLOUR_SURROUND;
        } else if (again) {
            memcpy(out + x0, out - canvas->width + x0, bytes);
        } else {
            make_values(run, row, columns, lines);
            if (y >= y0) paint_line(run, columns, lines, above, out);
            keep_above(lines);
        }
        above = lined && !row->outside;
    }
}

static void paint_piece(int index, int worker, void *ctx)
{
    const Run *run = ctx;
    const int y0 = run->rect.y + index * BAND, end = run->rect.y + run->rect.h;
    paint_band(run, y0, y0 + BAND < end ? y0 + BAND : end, &run->canvas->lines[worker]);
}

/* Compute all blocks of a run, after which its bands only read them. */
static void prepare(WrCanvas *canvas, Run *run, int tiles_v, int shift)
{
    memset(canvas->needed_v, 0, (size_t)tiles_v * sizeof *canvas->needed_v);
    for (int y = run->rect.y > 0 ? run->rect.y - 1 : 0; y < run->rect.y + run->rect.h; y++)
        for (int k = 0; k < WR_TAPS && !run->rows[y].outside; k++)
            canvas->needed_v[run->rows[y].cell[k] >> shift] = true;
    for (int k = 0; k < canvas->fields; k++)
        wr_canvas_mips_prepare(canvas->cells[k], canvas->needed, canvas->needed_v, run->deadline,
                               canvas->pool);
    run->deadline = -1.0; /* rough blocks stay rough until the next picture */
}

/* Paint columns x0 to x1 of a rectangle with one set of rows. */
static void paint_run(WrCanvas *canvas, SDL_Rect rect, int x0, int x1, const WrCellTaps *rows,
                      const WrField *field, int level, double deadline)
{
    const int tiles_u = wr_field_tiles_u(field), shift = 6 - level, left = x0 > 0 ? x0 - 1 : 0;
    Run run = { canvas, rect, x0, x1, left, rows, tiles_u, level, deadline };
    memset(canvas->needed, 0, (size_t)tiles_u * sizeof *canvas->needed);
    need(canvas, canvas->columns, left, x1, shift);
    if (canvas->flat.tiling == WR_TILING_BRICK)
        need(canvas, canvas->columns + canvas->width, left, x1, shift);
    if ((x1 - x0) * rect.h < MANY_PIXELS) {
        paint_band(&run, rect.y, rect.y + rect.h, &canvas->lines[0]);
        return;
    }
    prepare(canvas, &run, wr_field_tiles_v(field), shift);
    wr_pool_run(canvas->pool, (rect.h + BAND - 1) / BAND, paint_piece, &run);
}

/* Copy painted pixels to the texture, rotated if the view is. */
static void put(WrCanvas *canvas, SDL_Rect rect)
{
    const WrCanvasView *view = &canvas->view;
    const uint32_t *pixels = canvas->pixels;
    int width = canvas->width;
    if (view->turn != 0.0) {
        rect = wr_canvas_turned_rect(rect, canvas->width, canvas->height, view->w, view->h,
                                     view->turn);
        if (rect.w == 0) return;
        wr_canvas_turn(canvas->pixels, canvas->width, canvas->height, canvas->turned, view->w,
                       view->h, view->turn, rect);
        pixels = canvas->turned;
        width = view->w;
    }
    wr_gui_sdl_update(canvas->texture, &rect, pixels + (size_t)rect.y * (size_t)width + rect.x,
                      width * 4);
    wr_retained_frame_changed(canvas->kept,
                              &(SDL_Rect){ view->x + rect.x, view->y + rect.y, rect.w, rect.h });
}

static void paint_rect(WrCanvas *canvas, SDL_Rect rect, const WrField *field, int level,
                       double deadline)
{
    bool half_drop = canvas->flat.tiling == WR_TILING_HALF_DROP;
    for (int x0 = rect.x, x1; x0 < rect.x + rect.w; x0 = x1) {
        bool moved = half_drop && canvas->moved_column[x0];
        for (x1 = x0 + 1; x1 < rect.x + rect.w; x1++)
            if ((half_drop && canvas->moved_column[x1]) != moved) break;
        paint_run(canvas, rect, x0, x1, canvas->rows + (moved ? canvas->height : 0), field, level,
                  deadline);
    }
    put(canvas, rect);
}

/* ---- changes ---- */

static void note_dirty(int tx, int ty, void *ctx)
{
    WrCanvas *canvas = ctx;
    if (canvas->dirty.count >= DIRTY_MAX) {
        canvas->flooded = true;
        return;
    }
    wr_array_push(&canvas->dirty, ((SDL_Point){ tx, ty }));
}

/* Paint all visible copies of `count` tiles of a row of tiles. */
static void paint_tiles(WrCanvas *canvas, SDL_Point tile, int count, const WrField *field,
                        int level, double deadline)
{
    const WrCanvasView *v = &canvas->flat;
    double w = v->table_w, h = v->table_h, z = v->zoom, dx, dy;
    double left = v->centre_x - v->w / 2.0 / z, top = v->centre_y - v->h / 2.0 / z;
    double tw = fmin(count * WR_TILE, w - tile.x * WR_TILE),
           th = fmin(WR_TILE, h - tile.y * WR_TILE);
    WrCellRange cells = wr_view_cells(v);
    for (int j = cells.j0; j <= cells.j1; j++) {
        for (int i = cells.i0; i <= cells.i1; i++) {
            wr_view_tiling_shift(v, i, j, &dx, &dy);
            double x = i * w + tile.x * WR_TILE + dx - left,
                   y = j * h + tile.y * WR_TILE + dy - top;
            /* two more pixels on each side: footprints overlap the tile's edge, and contours depend on neighbours */
            int x0 = (int)floor(x * z) - 2, x1 = (int)ceil((x + tw) * z) + 2;
            int y0 = (int)floor(y * z) - 2, y1 = (int)ceil((y + th) * z) + 2;
            const int width = x1 - x0;
            if (v->mirrored) x0 = v->w - x1, x1 = x0 + width;
            SDL_Rect rect = { x0, y0, x1 - x0, y1 - y0 }, whole = { 0, 0, v->w, v->h };
            if (SDL_IntersectRect(&rect, &whole, &rect))
                paint_rect(canvas, rect, field, level, deadline);
        }
    }
}

static void make_lines(WrCanvas *canvas, int tiles_u, int tiles_v)
{
    const size_t w = (size_t)canvas->width, cells = (size_t)tiles_u * WR_TILE;
    if (!canvas->pool) canvas->pool = wr_pool_new(canvas->threads);
    const int threads = wr_pool_threads(canvas->pool);
    canvas->lines = wr_alloc((size_t)threads, sizeof *canvas->lines);
    for (int i = 0; i < threads; i++) {
        Lines *lines = &canvas->lines[i];
        for (int k = 0; k < 2; k++) {
            lines->line[k] = wr_alloc(cells, sizeof(float));
            lines->value[k] = wr_alloc(w, sizeof(float));
        }
        lines->above = wr_alloc(w, sizeof(float));
    }
    canvas->needed = wr_alloc((size_t)tiles_u, sizeof *canvas->needed);
    canvas->needed_v = wr_alloc((size_t)tiles_v, sizeof *canvas->needed_v);
}

static bool make_buffers(WrCanvas *canvas, const WrCanvasView *view, const WrField *field)
{
    const WrCanvasView flat = wr_view_flat(view);
    size_t w = (size_t)flat.w, h = (size_t)flat.h;
    if (!canvas->texture || canvas->view.w != view->w || canvas->view.h != view->h) {
        wr_canvas_forget(canvas);
        canvas->texture =
            SDL_CreateTexture(wr_retained_frame_renderer(canvas->kept), SDL_PIXELFORMAT_ARGB8888,
                              SDL_TEXTUREACCESS_STREAMING, view->w, view->h);
        if (!canvas->texture) return false;
        SDL_SetTextureBlendMode(canvas->texture, SDL_BLENDMODE_NONE);
        SDL_SetTextureScaleMode(canvas->texture, SDL_ScaleModeNearest);
    }
    free_buffers(canvas);
    canvas->width = flat.w;
    canvas->height = flat.h;
    canvas->pixels = wr_alloc(w * h, sizeof *canvas->pixels);
    if (view->turn != 0.0)
        canvas->turned = wr_alloc((size_t)view->w * (size_t)view->h, sizeof *canvas->turned);
    canvas->columns = wr_alloc(2 * w, sizeof *canvas->columns);
    canvas->rows = wr_alloc(2 * h, sizeof *canvas->rows);
    canvas->moved_column = wr_alloc(w, sizeof *canvas->moved_column);
    canvas->moved_row = wr_alloc(h, sizeof *canvas->moved_row);
    make_lines(canvas, wr_field_tiles_u(field), wr_field_tiles_v(field));
    canvas->valid = false;
    return true;
}

/* True if the buffers exist for this size of the view, of the picture before rotation, and of the table's rows. */
static bool has_buffers(const WrCanvas *canvas, const WrCanvasView *view)
{
    const WrCanvasView flat = wr_view_flat(view);
    return canvas->texture && canvas->view.w == view->w && canvas->view.h == view->h &&
           canvas->width == flat.w && canvas->height == flat.h &&
           (canvas->turned != NULL) == (view->turn != 0.0) &&
           canvas->view.table_w == view->table_w && canvas->view.table_h == view->table_h;
}

/* The automatic range: that of the table at rest, or of a finished preview. While it stays, nothing is followed: heights beyond
   it are clipped. */
static void follow(WrCanvas *canvas, WrCanvasShown shown, WrRangeHold hold)
{
    double *range = canvas->follows[shown];
    const double low = (double)canvas->table_low, high = (double)canvas->table_high;
    if (hold == WR_RANGE_RESTS || !(range[1] > range[0])) wr_range_follow(range, low, high);
    else if (hold == WR_RANGE_STAYS && shown == canvas->look.shown) return;
    memcpy(canvas->tried, range, sizeof canvas->tried);
    if (hold == WR_RANGE_TRIES) wr_range_widen(canvas->tried, low, high);
}

static void choose_range(WrCanvas *canvas, const WrCanvasDisplay *look, WrRangeHold hold)
{
    double shown[2] = { look->low, look->high };
    wr_canvas_mips_range(canvas->cells[0], canvas->pool, &canvas->table_low, &canvas->table_high);
    if (look->automatic[0] || look->automatic[1]) follow(canvas, look->shown, hold);
    for (int k = 0; k < 2; k++)
        if (look->automatic[k]) shown[k] = canvas->tried[k];
    /* a fixed end beyond all heights: the automatic one keeps its distance */
    if (!(shown[1] > shown[0]) && look->automatic[0]) shown[0] = shown[1] - LEAST_RANGE;
    else if (!(shown[1] > shown[0]) && look->automatic[1]) shown[1] = shown[0] + LEAST_RANGE;
    double low = shown[0], high = shown[1];
    if (!(high - low > 1e-30)) high = low + 1e-30; /* avoids a division by zero */
    if (low != canvas->low || high != canvas->high || look->colours != canvas->look.colours ||
        look->marks != canvas->look.marks || look->light_x != canvas->look.light_x ||
        look->light_y != canvas->look.light_y)
        canvas->valid = false;
    canvas->look = *look;
    canvas->low = low;
    canvas->high = high;
    if (!canvas->valid) wr_canvas_ink_make(&canvas->ink, look, low, high);
}

/* Update the cells of both fields. True if everything may have changed. */
static bool look_at(WrCanvas *canvas, const WrField *field, const WrField *second, int level)
{
    const WrField *fields[2] = { field, second };
    bool whole = canvas->fields != (second ? 2 : 1);
    canvas->fields = second ? 2 : 1;
    canvas->dirty.count = 0;
    canvas->flooded = false;
    for (int k = 0; k < canvas->fields; k++)
        if (!wr_canvas_mips_update(canvas->cells[k], fields[k], level, note_dirty, canvas))
            whole = true;
    return whole || canvas->flooded;
}

static bool is_rough(const WrCanvas *canvas)
{
    return wr_canvas_mips_rough(canvas->cells[0]) ||
           (canvas->fields == 2 && wr_canvas_mips_rough(canvas->cells[1]));
}

static int by_rows(const void *a, const void *b)
{
    const SDL_Point *p = a, *q = b;
    return p->y != q->y ? p->y - q->y : p->x - q->x;
}

/* Neighbours in a row of tiles are painted together: a large brush changes hundreds of tiles, of few pixels each. */
static void paint_dirty(WrCanvas *canvas, const WrField *field, int level, double deadline)
{
    SDL_Point *dirty = canvas->dirty.data;
    const int count = canvas->dirty.count;
    if (count > 1) qsort(dirty, (size_t)count, sizeof *dirty, by_rows);
    for (int i = 0, next; i < count; i = next) {
        for (next = i + 1; next < count; next++)
            if (dirty[next].y != dirty[i].y || dirty[next].x > dirty[next - 1].x + 1) break;
        paint_tiles(canvas, dirty[i], dirty[next - 1].x - dirty[i].x + 1, field, level, deadline);
    }
}

static void paint(WrCanvas *canvas, const WrField *field, int level, double deadline)
{
    if (!canvas->valid) {
        make_taps(canvas, field, level);
        paint_rect(canvas, (SDL_Rect){ 0, 0, canvas->width, canvas->height }, field, level,
                   deadline);
    } else {
        paint_dirty(canvas, field, level, deadline);
    }
    canvas->valid = true;
}

bool wr_canvas_draw(WrCanvas *canvas, WrRetainedFrame *kept, const WrCanvasView *view,
                    const WrField *field, const WrField *second, const WrCanvasDisplay *look,
                    WrRangeHold hold, double budget, WrCanvasRange *range)
{
    int level = wr_canvas_mips_level(view->zoom);
    canvas->kept = kept;
    bool whole = look_at(canvas, field, second, level);
    if (!has_buffers(canvas, view) && !make_buffers(canvas, view, field)) return false;
    if (whole || is_rough(canvas) || !wr_view_same(&canvas->view, view)) canvas->valid = false;
    canvas->view = *view;
    canvas->flat = wr_view_flat(view);
    choose_range(canvas, look, hold);
    for (int k = 0; k < 2; k++) wr_canvas_mips_forget_rough(canvas->cells[k]);
    if (!canvas->valid || canvas->dirty.count > 0)
        paint(canvas, field, level, wr_clock_seconds() + budget);
    *range = (WrCanvasRange){ canvas->low, canvas->high, (double)canvas->table_low,
                              (double)canvas->table_high };
    wr_retained_frame_copy_tracked(kept, canvas->texture, NULL,
                                   &(SDL_Rect){ view->x, view->y, view->w, view->h });
    return is_rough(canvas);
}

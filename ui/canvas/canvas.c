#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_mips.h"
#include "ui/canvas/canvas_colors.h"
#include "ui/canvas/view.h"
#include "ui/toolkit/retained_frame.h"
#include "ui/toolkit/theme.h"

#include "base/array.h"
#include "base/memory.h"
#include "field/field.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define LEAST_RANGE 1.0
#define DIRTY_MAX 4096 /* tiles; with more, the whole picture is redrawn */

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
    float *line[2];          /* sums of one cell row: [tiles_u * side] */
    float *value[2], *above; /* [width]: values of the present row, and of the previous one */
    bool *needed;            /* [tiles_u] tile columns used by a rectangle */
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

WrCanvas *wr_canvas_new(void)
{
    WrCanvas *canvas = wr_alloc(1, sizeof *canvas);
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
    for (int k = 0; k < 2; k++) {
        wr_free(canvas->line[k]);
        wr_free(canvas->value[k]);
        canvas->line[k] = canvas->value[k] = NULL;
    }
    wr_free(canvas->above);
    canvas->above = NULL;
    wr_free(canvas->needed);
    canvas->pixels = canvas->turned = NULL;
    canvas->columns = canvas->rows = NULL;
    canvas->moved_column = canvas->moved_row = NULL;
    canvas->needed = NULL;
}

void wr_canvas_free(WrCanvas *canvas)
{
    if (!canvas) return;
    wr_canvas_forget(canvas);
    free_buffers(canvas);
    wr_array_free(&canvas->dirty);
    for (int k = 0; k < 2; k++) wr_canvas_mips_free(canvas->cells[k]);
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

/* Weighted sum of the cell rows under one pixel row, over the needed tile columns. */
static void make_line(WrCanvas *canvas, int field, const WrCellTaps *row, int tiles_u, int level,
                      double deadline)
{
    int side = WR_TILE >> level, shift = 6 - level;
    for (int tx = 0; tx < tiles_u; tx++) {
        if (!canvas->needed[tx]) continue;
        float *line = canvas->line[field] + (size_t)tx * (size_t)side;
        memset(line, 0, (size_t)side * sizeof *line);
        for (int k = 0; k < WR_TAPS; k++) {
            float weight = row->weight[k], flat = 0.0f;
            if (weight == 0.0f) continue;
            const float *block = wr_canvas_mips_block(canvas->cells[field], tx,
                                                      row->cell[k] >> shift, deadline, &flat);
            const float *from = block ? block + (row->cell[k] & (side - 1)) * side : NULL;
            for (int i = 0; i < side; i++) line[i] += weight * (from ? from[i] : flat);
        }
    }
}

/* Values of pixels x0 to x1 of a row; NaN beyond the table. */
static void make_values(WrCanvas *canvas, const WrCellTaps *row, const WrCellTaps *columns, int x0,
                        int x1, int tiles_u, int level, double deadline)
{
    for (int k = 0; k < canvas->fields; k++) {
        make_line(canvas, k, row, tiles_u, level, deadline);
        const float *line = canvas->line[k];
        float *value = canvas->value[k];
        for (int x = x0; x < x1; x++) {
            const WrCellTaps *t = &columns[x];
            float sum = t->weight[0] * line[t->cell[0]] + t->weight[1] * line[t->cell[1]] +
                        t->weight[2] * line[t->cell[2]] + t->weight[3] * line[t->cell[3]];
            value[x] = t->outside ? NAN : sum;
        }
    }
}

/* above: canvas->above contains the previous row. */
static void paint_line(WrCanvas *canvas, const WrCellTaps *columns, int x0, int x1, bool above,
                       uint32_t *out)
{
    const float *value = canvas->value[0];
    if (canvas->fields == 2)
        wr_canvas_ink_slopes(&canvas->ink, value + x0, canvas->value[1] + x0, x1 - x0, out + x0);
    else
        wr_canvas_ink_heights(&canvas->ink, value + x0, value[x0 > 0 ? x0 - 1 : 0],
                              above ? canvas->above + x0 : NULL, x1 - x0, out + x0);
    for (int x = x0; x < x1; x++)
        if (columns[x].outside) out[x] = WR_COLOUR_SURROUND;
}

/* Keep the row for the contours of the next one. */
static void keep_above(WrCanvas *canvas)
{
    float *value = canvas->value[0];
    canvas->value[0] = canvas->above;
    canvas->above = value;
}

/* Mark the tile columns used by pixel columns x0 to x1. */
static void need(WrCanvas *canvas, const WrCellTaps *columns, int x0, int x1, int shift)
{
    for (int x = x0; x < x1; x++)
        for (int k = 0; k < WR_TAPS; k++) canvas->needed[columns[x].cell[k] >> shift] = true;
}

/* Paint columns x0 to x1 of a rectangle with one set of rows. */
static void paint_run(WrCanvas *canvas, SDL_Rect rect, int x0, int x1, const WrCellTaps *rows,
                      const WrField *field, int level, double deadline)
{
    int tiles_u = wr_field_tiles_u(field), shift = 6 - level, left = x0 > 0 ? x0 - 1 : 0;
    bool brick = canvas->flat.tiling == WR_TILING_BRICK;
    bool lined = canvas->look.colours == WR_CANVAS_CONTOURS, above = false;
    int first = lined && rect.y > 0 ? rect.y - 1 : rect.y; /* contours need the previous row */
    size_t bytes = (size_t)(x1 - x0) * sizeof *canvas->pixels;
    memset(canvas->needed, 0, (size_t)tiles_u * sizeof *canvas->needed);
    need(canvas, canvas->columns, left, x1, shift);
    if (brick) need(canvas, canvas->columns + canvas->width, left, x1, shift);
    for (int y = first; y < rect.y + rect.h; y++) {
        const WrCellTaps *row = &rows[y];
        bool moved = brick && canvas->moved_row[y];
        bool again = !lined && y > rect.y && memcmp(row, row - 1, sizeof *row) == 0 &&
                     moved == (brick && canvas->moved_row[y - 1]);
        uint32_t *out = canvas->pixels + (size_t)y * (size_t)canvas->width;
        const WrCellTaps *columns = canvas->columns + (moved ? canvas->width : 0);
        if (row->outside) {
            for (int x = x0; x < x1; x++) out[x] = WR_COLOUR_SURROUND;
        } else if (again) {
            memcpy(out + x0, out - canvas->width + x0, bytes);
        } else {
            make_values(canvas, row, columns, left, x1, tiles_u, level, deadline);
            if (y >= rect.y) paint_line(canvas, columns, x0, x1, above, out);
            keep_above(canvas);
        }
        above = lined && !row->outside;
    }
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

/* Paint all visible copies of one tile. */
static void paint_tile(WrCanvas *canvas, SDL_Point tile, const WrField *field, int level,
                       double deadline)
{
    const WrCanvasView *v = &canvas->flat;
    double w = v->table_w, h = v->table_h, z = v->zoom, dx, dy;
    double left = v->centre_x - v->w / 2.0 / z, top = v->centre_y - v->h / 2.0 / z;
    double tw = fmin(WR_TILE, w - tile.x * WR_TILE), th = fmin(WR_TILE, h - tile.y * WR_TILE);
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

static bool make_buffers(WrCanvas *canvas, const WrCanvasView *view, int cells)
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
    for (int k = 0; k < 2; k++) {
        canvas->line[k] = wr_alloc((size_t)cells, sizeof *canvas->line[k]);
        canvas->value[k] = wr_alloc(w, sizeof *canvas->value[k]);
    }
    canvas->above = wr_alloc(w, sizeof *canvas->above);
    canvas->needed = wr_alloc((size_t)cells, sizeof *canvas->needed);
    canvas->valid = false;
    return true;
}

/* True if the buffers exist for this size of the view, of the picture before rotation, and of the table's rows. */
static bool has_buffers(const WrCanvas *canvas, const WrCanvasView *view)
{
    const WrCanvasView flat = wr_view_flat(view);
    return canvas->texture && canvas->view.w == view->w && canvas->view.h == view->h &&
           canvas->width == flat.w && canvas->height == flat.h &&
           (canvas->turned != NULL) == (view->turn != 0.0) && canvas->view.table_w == view->table_w;
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
    wr_canvas_mips_range(canvas->cells[0], &canvas->table_low, &canvas->table_high);
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

static void paint(WrCanvas *canvas, const WrField *field, int level, double deadline)
{
    if (!canvas->valid) {
        make_taps(canvas, field, level);
        paint_rect(canvas, (SDL_Rect){ 0, 0, canvas->width, canvas->height }, field, level,
                   deadline);
    } else {
        for (int i = 0; i < canvas->dirty.count; i++)
            paint_tile(canvas, canvas->dirty.data[i], field, level, deadline);
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
    if (!has_buffers(canvas, view) &&
        !make_buffers(canvas, view, wr_field_tiles_u(field) * WR_TILE))
        return false;
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

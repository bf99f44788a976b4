#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_cells.h"
#include "ui/canvas/canvas_range.h"
#include "ui/canvas/canvas_turn.h"
#include "ui/canvas/view.h"
#include "ui/gui/theme.h"

#include "base/array.h"
#include "base/memory.h"
#include "field/field.h"
#include "system/clock.h"

#include <SDL.h>
#include <math.h>
#include <string.h>

#define CODES 256      /* of a picture; two more mark what lies beyond its range */
#define BEYOND 0.01f   /* of a code: so far off it counts as beyond */
#define DIRTY_MAX 4096 /* tiles; more than that and the whole picture is made anew */

struct WrCanvas {
    WrCanvasCells *cells;
    SDL_Texture *texture;
    int width, height;          /* of pixels */
    uint32_t *pixels;           /* [height][width], ARGB, not turned */
    uint32_t *turned;           /* as the texture, where the view is turned; else NULL */
    WrCellTaps *columns, *rows; /* [2][width], [2][height]: the second where copies are moved */
    bool *moved_column,
        *moved_row; /* [width], [height]: a copy that the tiling moves down, to the right */
    float *line;    /* one row of cells: [tiles_u * side] */
    bool *needed;   /* [tiles_u] tile columns that a rectangle looks at */
    uint32_t palette[CODES + 2]; /* the last two: below, above */
    WrCanvasView view, flat;     /* of the picture held, and not turned */
    WrCanvasLook look;
    double low, high;
    float table_low, table_high;
    bool valid, flooded;
    WR_ARRAY(SDL_Point) dirty; /* tiles */
};

WrCanvas *wr_canvas_new(void)
{
    WrCanvas *canvas = wr_alloc(1, sizeof *canvas);
    canvas->cells = wr_cells_new();
    return canvas;
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
    wr_free(canvas->line);
    wr_free(canvas->needed);
    canvas->pixels = canvas->turned = NULL;
    canvas->columns = canvas->rows = NULL;
    canvas->moved_column = canvas->moved_row = NULL;
    canvas->line = NULL;
    canvas->needed = NULL;
}

void wr_canvas_free(WrCanvas *canvas)
{
    if (!canvas) return;
    wr_canvas_forget(canvas);
    free_buffers(canvas);
    wr_array_free(&canvas->dirty);
    wr_cells_free(canvas->cells);
    wr_free(canvas);
}

/* ---- colours ---- */

static uint32_t mix(const double a[3], const double b[3], double t)
{
    uint32_t out = 0xff;
    for (int k = 0; k < 3; k++) out = out << 8 | (uint32_t)lrint(a[k] + t * (b[k] - a[k]));
    return out;
}

static void make_marks(WrCanvas *canvas)
{
    bool grey = canvas->look.colours == WR_CANVAS_GREY, marks = canvas->look.marks;
    uint32_t *palette = canvas->palette;
    palette[CODES] = !marks ? palette[0] : grey ? 0xff1d4a78u : 0xff101f4au;
    palette[CODES + 1] = !marks ? palette[CODES - 1] : grey ? 0xfff0b070u : 0xff6b2f05u;
}

static void make_palette(WrCanvas *canvas)
{
    static const double blue[3] = { 38, 92, 190 }, white[3] = { 245, 245, 245 },
                        orange[3] = { 214, 112, 24 };
    for (int i = 0; i < 256; i++) {
        uint32_t g = (uint32_t)i;
        if (canvas->look.colours == WR_CANVAS_GREY) {
            canvas->palette[i] = 0xff000000u | g << 16 | g << 8 | g;
            continue;
        }
        double f = canvas->low + (canvas->high - canvas->low) * i / 255.0;
        double reach = fmax(fabs(canvas->low), fabs(canvas->high));
        double t = reach > 0.0 ? f / reach : 0.0;
        canvas->palette[i] = t < 0.0 ? mix(white, blue, -t) : mix(white, orange, t);
    }
    make_marks(canvas);
}

/* scaled: 0 black, 255 white. */
static int code_of(float scaled)
{
    if (scaled < -BEYOND) return CODES;
    if (scaled > CODES - 1 + BEYOND) return CODES + 1;
    float code = scaled + 0.5f;
    code = code > 0.0f ? code : 0.0f; /* NaN too */
    return (int)(code < CODES - 1 ? code : CODES - 1);
}

uint32_t wr_canvas_colour(const WrCanvas *canvas, double height)
{
    return canvas->palette[code_of(
        (float)((height - canvas->low) * (CODES - 1) / (canvas->high - canvas->low)))];
}

/* ---- the picture ---- */

/* Along one axis: where copies stand, and half a cell before, which is what a copy shows that is moved. */
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

/* Add up the cell rows that one pixel row weighs, over the tile columns that are needed. */
static void make_line(WrCanvas *canvas, const WrCellTaps *row, int tiles_u, int level,
                      double deadline)
{
    int side = WR_TILE >> level, shift = 6 - level;
    for (int tx = 0; tx < tiles_u; tx++) {
        if (!canvas->needed[tx]) continue;
        float *line = canvas->line + (size_t)tx * (size_t)side;
        memset(line, 0, (size_t)side * sizeof *line);
        for (int k = 0; k < WR_TAPS; k++) {
            float weight = row->weight[k], flat = 0.0f;
            if (weight == 0.0f) continue;
            const float *block =
                wr_cells_block(canvas->cells, tx, row->cell[k] >> shift, deadline, &flat);
            const float *from = block ? block + (row->cell[k] & (side - 1)) * side : NULL;
            for (int i = 0; i < side; i++) line[i] += weight * (from ? from[i] : flat);
        }
    }
}

static void paint_line(const WrCanvas *canvas, const WrCellTaps *columns, int x0, int x1,
                       uint32_t *out)
{
    float low = (float)canvas->low;
    float scale = (float)((CODES - 1) / (canvas->high - canvas->low));
    const float *line = canvas->line;
    for (int x = x0; x < x1; x++) {
        const WrCellTaps *t = &columns[x];
        float f = t->weight[0] * line[t->cell[0]] + t->weight[1] * line[t->cell[1]] +
                  t->weight[2] * line[t->cell[2]] + t->weight[3] * line[t->cell[3]];
        out[x] = t->outside ? WR_COLOUR_SURROUND : canvas->palette[code_of((f - low) * scale)];
    }
}

/* The tile columns that columns x0 to x1 look at. */
static void need(WrCanvas *canvas, const WrCellTaps *columns, int x0, int x1, int shift)
{
    for (int x = x0; x < x1; x++)
        for (int k = 0; k < WR_TAPS; k++) canvas->needed[columns[x].cell[k] >> shift] = true;
}

/* Columns x0 to x1 of a rectangle, by one set of rows. */
static void paint_run(WrCanvas *canvas, SDL_Rect rect, int x0, int x1, const WrCellTaps *rows,
                      const WrField *field, int level, double deadline)
{
    int tiles_u = wr_field_tiles_u(field), shift = 6 - level;
    bool brick = canvas->flat.tiling == WR_TILING_BRICK;
    size_t bytes = (size_t)(x1 - x0) * sizeof *canvas->pixels;
    memset(canvas->needed, 0, (size_t)tiles_u * sizeof *canvas->needed);
    need(canvas, canvas->columns, x0, x1, shift);
    if (brick) need(canvas, canvas->columns + canvas->width, x0, x1, shift);
    for (int y = rect.y; y < rect.y + rect.h; y++) {
        const WrCellTaps *row = &rows[y];
        bool moved = brick && canvas->moved_row[y];
        bool again = y > rect.y && memcmp(row, row - 1, sizeof *row) == 0 &&
                     moved == (brick && canvas->moved_row[y - 1]);
        uint32_t *out = canvas->pixels + (size_t)y * (size_t)canvas->width;
        if (row->outside) {
            for (int x = x0; x < x1; x++) out[x] = WR_COLOUR_SURROUND;
        } else if (again) {
            memcpy(out + x0, out - canvas->width + x0, bytes);
        } else {
            make_line(canvas, row, tiles_u, level, deadline);
            paint_line(canvas, canvas->columns + (moved ? canvas->width : 0), x0, x1, out);
        }
    }
}

/* What was painted goes to the texture, turned if the view is. */
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
    SDL_UpdateTexture(canvas->texture, &rect, pixels + (size_t)rect.y * (size_t)width + rect.x,
                      width * 4);
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

/* ---- what changed ---- */

static void note_dirty(int tx, int ty, void *ctx)
{
    WrCanvas *canvas = ctx;
    if (canvas->dirty.count >= DIRTY_MAX) {
        canvas->flooded = true;
        return;
    }
    wr_array_push(&canvas->dirty, ((SDL_Point){ tx, ty }));
}

/* Paint every copy of one tile that is in view. */
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
            /* a pixel more on each side: footprints overlap the tile's edge */
            int x0 = (int)floor(x * z) - 1, x1 = (int)ceil((x + tw) * z) + 1;
            int y0 = (int)floor(y * z) - 1, y1 = (int)ceil((y + th) * z) + 1;
            const int width = x1 - x0;
            if (v->mirrored) x0 = v->w - x1, x1 = x0 + width;
            SDL_Rect rect = { x0, y0, x1 - x0, y1 - y0 }, whole = { 0, 0, v->w, v->h };
            if (SDL_IntersectRect(&rect, &whole, &rect))
                paint_rect(canvas, rect, field, level, deadline);
        }
    }
}

static bool make_buffers(WrCanvas *canvas, SDL_Renderer *renderer, const WrCanvasView *view,
                         int cells)
{
    const WrCanvasView flat = wr_view_flat(view);
    size_t w = (size_t)flat.w, h = (size_t)flat.h;
    if (!canvas->texture || canvas->view.w != view->w || canvas->view.h != view->h) {
        wr_canvas_forget(canvas);
        canvas->texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_ARGB8888,
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
    canvas->line = wr_alloc((size_t)cells, sizeof *canvas->line);
    canvas->needed = wr_alloc((size_t)cells, sizeof *canvas->needed);
    canvas->valid = false;
    return true;
}

/* Another size of the view, of the picture before it is turned, or of the table. */
static bool has_buffers(const WrCanvas *canvas, const WrCanvasView *view)
{
    const WrCanvasView flat = wr_view_flat(view);
    return canvas->texture && canvas->view.w == view->w && canvas->view.h == view->h &&
           canvas->width == flat.w && canvas->height == flat.h &&
           (canvas->turned != NULL) == (view->turn != 0.0) && canvas->view.table_w == view->table_w;
}

static void choose_range(WrCanvas *canvas, const WrCanvasLook *look, bool held)
{
    double shown[2] = { look->low, look->high };
    wr_cells_range(canvas->cells, &canvas->table_low, &canvas->table_high);
    if (look->automatic) {
        bool follows = held && canvas->look.automatic && canvas->texture;
        shown[0] = follows ? canvas->low : 0.0;
        shown[1] = follows ? canvas->high : 0.0;
        wr_range_follow(shown, (double)canvas->table_low, (double)canvas->table_high, held);
    }
    double low = shown[0], high = shown[1];
    if (!(high - low > 1e-30)) high = low + 1e-30; /* never divide by nothing */
    if (low != canvas->low || high != canvas->high || look->colours != canvas->look.colours ||
        look->marks != canvas->look.marks)
        canvas->valid = false;
    canvas->look = *look;
    canvas->low = low;
    canvas->high = high;
    if (!canvas->valid) make_palette(canvas);
}

bool wr_canvas_draw(WrCanvas *canvas, SDL_Renderer *renderer, const WrCanvasView *view,
                    const WrField *field, const WrCanvasLook *look, bool held, double budget,
                    WrCanvasRange *range)
{
    int level = wr_cells_level(view->zoom);
    canvas->dirty.count = 0;
    canvas->flooded = false;
    bool whole = !wr_cells_look(canvas->cells, field, level, note_dirty, canvas) || canvas->flooded;
    if (!has_buffers(canvas, view) &&
        !make_buffers(canvas, renderer, view, wr_field_tiles_u(field) * WR_TILE))
        return false;
    if (whole || wr_cells_rough(canvas->cells) || !wr_view_same(&canvas->view, view))
        canvas->valid = false;
    canvas->view = *view;
    canvas->flat = wr_view_flat(view);
    choose_range(canvas, look, held);
    double deadline = wr_clock_seconds() + budget;
    wr_cells_forget_rough(canvas->cells);
    if (!canvas->valid || canvas->dirty.count > 0) {
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
    *range = (WrCanvasRange){ canvas->low, canvas->high, (double)canvas->table_low,
                              (double)canvas->table_high };
    SDL_RenderCopy(renderer, canvas->texture, NULL,
                   &(SDL_Rect){ view->x, view->y, view->w, view->h });
    return wr_cells_rough(canvas->cells);
}

#include "brush/paint.h"

#include <float.h>
#include <math.h>
#include <stdalign.h>

#include "base/memory.h"

#define FAR_OFF 4e9 /* texels; beyond the largest radius from any table */
#define THIN                                                                                       \
    0.70711 /* a brush of at most this radius paints single texels; a little over sqrt(1/2) */

/* One axis's range of texels, not wrapped. */
typedef struct Window {
    int low, high;
} Window;

static double clamp(double value, double low, double high)
{
    return value > low ? (value < high ? value : high) : low; /* NaN becomes low */
}

WrBrush wr_brush_sane(const WrBrush *brush)
{
    WrBrush sane = *brush;
    sane.radius = clamp(brush->radius, 0.0, 1e9);
    sane.hardness = clamp(brush->hardness, 0.0, 1.0);
    /* twice float's range leads from its one end to the other */
    sane.strength =
        isnan(brush->strength) ? 0.0 : clamp(brush->strength, -2.0 * FLT_MAX, 2.0 * FLT_MAX);
    sane.to = isnan(brush->to) ? 0.0 : clamp(brush->to, -FLT_MAX, FLT_MAX);
    return sane;
}

double wr_brush_inner(const WrBrush *brush)
{
    double soft = brush->hardness * brush->radius, hard = brush->radius - 1.0;
    double inner = soft < hard ? soft : hard;
    return inner > THIN ? inner : THIN;
}

static double place(double u, int n, WrWrap wrap, bool runs_down)
{
    double p = wrap == WR_WRAP_PERIODIC ? wr_field_reduce(u, 1.0) : u;
    double x = n * (runs_down ? 1.0 - p : p) - 0.5;
    return clamp(x, -FAR_OFF, FAR_OFF);
}

bool wr_paint_place(const WrField *field, double u, double v, double *x, double *y)
{
    if (!isfinite(u) || !isfinite(v)) return false;
    *x = place(u, wr_field_width(field), wr_field_wrap_u(field), false);
    *y = place(v, wr_field_height(field), wr_field_wrap_v(field), true);
    return true;
}

static double finite_float(double height)
{
    height = height < FLT_MAX ? height : FLT_MAX;
    return height > -FLT_MAX ? height : -FLT_MAX;
}

/* The strength with which `mode` changes height f; the sum of both may overflow float. */
static double change(const WrBrush *brush, double f)
{
    if (brush->mode == WR_BRUSH_LOWER) return -brush->strength;
    if (brush->mode == WR_BRUSH_RAISE) return brush->strength;
    double gap = brush->to - f, sign = gap > 0.0 ? 1.0 : gap < 0.0 ? -1.0 : 0.0;
    return sign * (brush->strength < fabs(gap) ? brush->strength : fabs(gap));
}

/* Any mode and strength: heights made of `start` under `cover`; where that is 0 they keep their bits. */
static void make_slowly(const WrBrush *brush, const float *start, const float *cover, int count,
                        float *out)
{
    for (int i = 0; i < count; i++) {
        double f = start[i], c = cover[i], made = f + c * change(brush, f);
        /* where the way to `to` is shorter than strength, a mean, so that c = 1 gives `to` itself */
        if (brush->mode == WR_BRUSH_TO && brush->strength >= fabs(brush->to - f))
            made = f * (1.0 - c) + brush->to * c;
        out[i] = c > 0.0 ? (float)finite_float(made) : start[i];
    }
}

/* Whether the kernels' plain sum is what the brush does; if so, *strength is what it adds. */
static bool is_plain(const WrBrush *brush, double *strength)
{
    *strength = brush->mode == WR_BRUSH_LOWER ? -brush->strength : brush->strength;
    return brush->mode != WR_BRUSH_TO && fabs(brush->strength) <= WR_BRUSH_STRONG;
}

static void make_row(const WrPaint *paint, const float *start, const float *cover, int count,
                     float *out)
{
    double strength;
    if (is_plain(&paint->brush, &strength)) paint->kernels->add(strength, start, cover, count, out);
    else make_slowly(&paint->brush, start, cover, count, out);
}

/* A tile under the brush. Pointers to write through are fetched with the first texel that changes. */
typedef struct Sheet {
    WrPaint *paint;
    int tx, ty;
    const float *start, *cover; /* of the whole stroke; NULL: level, 0 */
    const float *selection;     /* NULL: its level */
    float *out, *cover_out, *mark_out;
} Sheet;

static Sheet sheet_of(WrPaint *paint, int tx, int ty)
{
    Sheet sheet = { .paint = paint, .tx = tx, .ty = ty };
    if (paint->start) {
        sheet.start = wr_field_tile(paint->start, tx, ty);
        sheet.cover = wr_field_tile(paint->cover, tx, ty);
    }
    if (paint->selection) sheet.selection = wr_field_tile(paint->selection, tx, ty);
    return sheet;
}

static void sheet_open(Sheet *sheet)
{
    sheet->out = wr_field_tile_write(sheet->paint->field, sheet->tx, sheet->ty);
    if (!sheet->paint->start) return;
    sheet->cover_out = wr_field_tile_write(sheet->paint->cover, sheet->tx, sheet->ty);
    sheet->cover = sheet->cover_out;
    if (sheet->paint->mark)
        sheet->mark_out = wr_field_tile_write(sheet->paint->mark, sheet->tx, sheet->ty);
}

static bool all_zero(const float *cover, int count)
{
    for (int i = 0; i < count; i++)
        if (cover[i] > 0.0f) return false;
    return true;
}

/* Is nothing selected in the tile, or in `count` of its texels from `at` on? */
static bool sheet_closed(const Sheet *sheet, int at, int count)
{
    const WrField *selection = sheet->paint->selection;
    if (!selection) return false;
    return sheet->selection ? all_zero(sheet->selection + at, count)
                            : !(wr_field_level(selection) > 0.0f);
}

/* Coverage as the selection lets it through. */
static const float *through(const Sheet *sheet, int at, const float *cover, int count,
                            float *limited)
{
    const WrField *selection = sheet->paint->selection;
    if (!selection) return cover;
    float level = wr_field_level(selection);
    for (int i = 0; i < count; i++) {
        float s = sheet->selection ? sheet->selection[at + i] : level;
        s = s > 0.0f ? s : 0.0f;
        limited[i] = cover[i] * (s < 1.0f ? s : 1.0f);
    }
    return limited;
}

/* Bring `count` texels from `at` on, whole blocks, up to coverage `fresh`. */
static void sheet_blocks(Sheet *sheet, int at, int count, const float *fresh)
{
    const WrPaint *paint = sheet->paint;
    bool opened = sheet->out != NULL;
    if (!(opened && !paint->start)) { /* a dab's open tile takes all */
        bool gains = sheet->cover ? paint->kernels->grows(sheet->cover + at, fresh, count)
                                  : !all_zero(fresh, count);
        if (!gains || sheet_closed(sheet, at, count)) return;
        if (!opened) sheet_open(sheet);
    }
    if (!paint->start) {
        make_row(paint, sheet->out + at, fresh, count, sheet->out + at);
        return;
    }
    alignas(WR_ALIGN) float flat[WR_TILE], limited[WR_TILE];
    paint->kernels->join(sheet->cover_out + at, fresh, count);
    const float *cover = through(sheet, at, sheet->cover_out + at, count, limited);
    if (sheet->mark_out) paint->kernels->join(sheet->mark_out + at, cover, count);
    if (!sheet->start)
        for (int i = 0; i < count; i++) flat[i] = wr_field_level(paint->start);
    make_row(paint, sheet->start ? sheet->start + at : flat, cover, count, sheet->out + at);
}

/* The texels of one axis that a motion from p to p + d may reach with radius r. On a periodic axis those
 * farther than half a period have a nearer image; a motion of no length meets none twice. */
static Window window(double p, double d, double r, int n, WrWrap wrap)
{
    double low = d < 0.0 ? p + d : p, high = d < 0.0 ? p : p + d;
    if (wrap == WR_WRAP_CLAMP)
        return (Window){ (int)clamp(ceil(low - r), 0.0, n),
                         (int)clamp(floor(high + r), -1.0, n - 1.0) };
    r = r < 0.5 * n ? r : 0.5 * n;
    Window w = { (int)ceil(low - r), (int)floor(high + r) };
    if (d == 0.0 && w.high - w.low >= n) w.high = w.low + n - 1;
    return w;
}

/* How many texels from unwrapped index i to `last` lie in one tile; *texel is i in the table. */
static int tile_run(int i, int last, int n, int *texel)
{
    *texel = i % n < 0 ? i % n + n : i % n;
    int count = WR_TILE - *texel % WR_TILE;
    if (count > n - *texel) count = n - *texel;
    return count < last - i + 1 ? count : last - i + 1;
}

/* Rows j .. j + count - 1, all in one row of tiles. */
typedef struct Band {
    int j, texel, count;
    Window span[WR_TILE]; /* columns that each row reaches */
    Window all;           /* columns that any reaches */
    bool whole;           /* the brush spans the table's period */
} Band;

/* floor of |x| < 2^31, without a call */
static int floor_int(double x)
{
    int whole = (int)x;
    return whole - (x < whole);
}

static void find_spans(Band *band, const WrCapsule *capsule, Window columns)
{
    band->all = (Window){ columns.high + 1, columns.low - 1 };
    for (int row = 0; row < band->count; row++) {
        Window *span = &band->span[row];
        *span = (Window){ 0, -1 };
        double low, high;
        if (!wr_capsule_span(capsule, band->j + row, &low, &high)) continue;
        low = clamp(low, columns.low, columns.high + 1.0);
        high = clamp(high, columns.low - 1.0, columns.high);
        *span = (Window){ -floor_int(-low), floor_int(high) };
        if (span->low < band->all.low) band->all.low = span->low;
        if (span->high > band->all.high) band->all.high = span->high;
    }
}

/* A run of texels of one row of a tile, widened to whole blocks. */
typedef struct Run {
    int y, x;       /* unwrapped row; unwrapped column of the first block's first texel */
    int at, count;  /* place in the tile, texels: whole blocks */
    int head, tail; /* texels at the blocks' ends that must keep their bits */
} Run;

/* What a widened run takes in besides lies outside the capsule and gets no coverage; but where the brush
 * is as large as the table it would meet another image's texels, and at the table's edge unused ones. */
static Run run_of(const Band *band, int row, int first, int last, int texel, int width)
{
    int at = texel % WR_TILE, head = at % WR_BRUSH_BLOCK, end = head + last - first + 1;
    Run run = { .y = band->j + row, .x = first - head };
    run.count = (end + WR_BRUSH_BLOCK - 1) / WR_BRUSH_BLOCK * WR_BRUSH_BLOCK;
    run.at = (band->texel + row) % WR_TILE * WR_TILE + at - head;
    int beyond = texel - head + run.count - width; /* texels beyond the table's edge */
    run.head = band->whole ? head : 0;
    run.tail = band->whole ? run.count - end : beyond > 0 ? beyond : 0;
    return run;
}

static void paint_run(Sheet *sheet, const WrCapsule *capsule, const Run *run)
{
    const WrPaint *paint = sheet->paint;
    const WrBrushKernels *kernels = paint->kernels;
    bool moves = capsule->inverse_length2 > 0.0;
    double strength;
    if (sheet->out && !paint->start && !moves && !run->head && !run->tail &&
        is_plain(&paint->brush, &strength)) {
        kernels->dab_add(capsule, run->y, run->x, run->count, strength, sheet->out + run->at);
        return;
    }
    alignas(WR_ALIGN) float fresh[WR_TILE];
    (moves ? kernels->motion : kernels->dab)(capsule, run->y, run->x, run->count, fresh);
    for (int i = 0; i < run->head; i++) fresh[i] = 0.0f;
    for (int i = run->count - run->tail; i < run->count; i++) fresh[i] = 0.0f;
    sheet_blocks(sheet, run->at, run->count, fresh);
}

/* The part of a band that lies in one tile: columns i .. i + count - 1, texel column `texel`. */
static void paint_tile(WrPaint *paint, const WrCapsule *capsule, const Band *band, int i, int count,
                       int texel)
{
    Sheet sheet = sheet_of(paint, texel / WR_TILE, band->texel / WR_TILE);
    if (!sheet.selection && sheet_closed(&sheet, 0, 0)) return;
    int width = wr_field_width(paint->field);
    double stronger =
        capsule->growth > 0.0 ? capsule->pressure + capsule->growth : capsule->pressure;
    for (int row = 0; row < band->count; row++) {
        Window span = band->span[row];
        int first = span.low > i ? span.low : i;
        int last = span.high < i + count - 1 ? span.high : i + count - 1;
        if (first > last) continue;
        Run run = run_of(band, row, first, last, texel + first - i, width);
        bool done = sheet.cover && /* no texel of it can gain */
                    !paint->kernels->below(sheet.cover + run.at, (float)stronger, run.count);
        if (!done) paint_run(&sheet, capsule, &run);
    }
}

static void paint_capsule(WrPaint *paint, const WrCapsule *capsule)
{
    int width = wr_field_width(paint->field), height = wr_field_height(paint->field);
    Window columns =
        window(capsule->x, capsule->dx, capsule->radius, width, wr_field_wrap_u(paint->field));
    Window rows =
        window(capsule->y, capsule->dy, capsule->radius, height, wr_field_wrap_v(paint->field));
    Band band = { .whole = wr_field_wrap_u(paint->field) == WR_WRAP_PERIODIC &&
                           capsule->radius >= 0.5 * width };
    for (int j = rows.low; j <= rows.high; j += band.count) {
        band.j = j;
        band.count = tile_run(j, rows.high, height, &band.texel);
        find_spans(&band, capsule, columns);
        for (int i = band.all.low; i <= band.all.high;) {
            int texel, count = tile_run(i, band.all.high, width, &texel);
            paint_tile(paint, capsule, &band, i, count, texel);
            i += count;
        }
    }
}

/* The texel that holds coordinate x; false off a clamped axis. The far end, u = 1, is in the last. */
static bool holder(double x, int n, WrWrap wrap, int *texel)
{
    double cell = floor(x + 0.5);
    if (wrap == WR_WRAP_CLAMP) {
        if (cell == n && x + 0.5 == n) cell = n - 1;
        if (!(cell >= 0.0 && cell < n)) return false;
        *texel = (int)cell;
    } else {
        tile_run((int)cell, (int)cell, n, texel); /* |x| <= 2 n on a periodic axis */
    }
    return true;
}

static void paint_texel(WrPaint *paint, double x, double y, double pressure)
{
    int i, j;
    if (!holder(x, wr_field_width(paint->field), wr_field_wrap_u(paint->field), &i) ||
        !holder(y, wr_field_height(paint->field), wr_field_wrap_v(paint->field), &j))
        return;
    Sheet sheet = sheet_of(paint, i / WR_TILE, j / WR_TILE);
    int at = j % WR_TILE * WR_TILE + i % WR_TILE, head = at % WR_BRUSH_BLOCK;
    alignas(WR_ALIGN) float fresh[WR_BRUSH_BLOCK] = { 0 };
    fresh[head] = (float)pressure;
    sheet_blocks(&sheet, at - head, WR_BRUSH_BLOCK, fresh);
}

/* A line one texel wide: one texel for each column that it passes, or row if it is steep. */
static void paint_line(WrPaint *paint, double x, double y, double dx, double dy, double pressure,
                       double growth)
{
    bool steep = fabs(dy) > fabs(dx);
    double from = steep ? y : x, way = steep ? dy : dx;
    bool clamped =
        WR_WRAP_CLAMP == (steep ? wr_field_wrap_v(paint->field) : wr_field_wrap_u(paint->field));
    int n = steep ? wr_field_height(paint->field) : wr_field_width(paint->field);
    double low = floor((way < 0.0 ? from + way : from) + 0.5);
    double high = floor((way < 0.0 ? from : from + way) + 0.5);
    if (clamped) {
        low = low > 0.0 ? low : 0.0;
        high = high < n ? high : n;
    }
    for (double k = low; k <= high; k += 1.0) {
        double t = way != 0.0 ? clamp((k - from) / way, 0.0, 1.0) : 1.0;
        paint_texel(paint, x + t * dx, y + t * dy, pressure + t * growth);
    }
}

void wr_paint_motion(WrPaint *paint, double x, double y, double dx, double dy,
                     double pressure_start, double pressure_end)
{
    const WrBrush *brush = &paint->brush;
    if (!(brush->radius > 0.0) || brush->strength == 0.0) return;
    if (!(pressure_start > 0.0 || pressure_end > 0.0)) return;
    if (brush->radius <= THIN) {
        paint_line(paint, x, y, dx, dy, pressure_start, pressure_end - pressure_start);
        return;
    }
    WrCapsule capsule = wr_capsule(brush, x, y, dx, dy, pressure_start, pressure_end);
    paint_capsule(paint, &capsule);
}

/* Lines and fields: grid, checks, stripes, waves, knurling. */
#include "generate/pattern.h"

#include "base/error.h"
#include "field/field.h"

#include <math.h>

/* Distance of x from the nearest integer, 0..1/2. */
static double to_whole(double x)
{
    return fabs(x - floor(x + 0.5));
}

/* ---- grid ---- */

const WrParam wr_params_grid[] = {
    WR_P_ACROSS(8), WR_P_ROWS(8), WR_P_TEXELS("width", "Width", 12, 64, "width of the lines"),
    WR_P_BEVEL(5),  WR_P_PROFILE, WR_P_HEIGHT,
    WR_P_ORIGIN,    WR_P_END
};

typedef struct Lines {
    WrCells cells;
    WrEdge edge;
    double width; /* texels; stripes: of the period */
    double a, b;  /* periods along u and v */
    double steep; /* periods a texel, across the stripes */
} Lines;

/* The union of both families is 1 minus the product of 1 - a and 1 - b: exact for steps, since the two
 * are filtered along separate axes, and rounded where bevels meet. */
static double grid_at(const void *ctx, double x, double y)
{
    const Lines *l = ctx;
    double dx = to_whole(x / l->cells.cell_width) * l->cells.cell_width;
    double dy = to_whole(y / l->cells.cell_height) * l->cells.cell_height;
    double a = wr_edge_height(&l->edge, 0.5 * l->width - dx),
           b = wr_edge_height(&l->edge, 0.5 * l->width - dy);
    return 1.0 - (1.0 - a) * (1.0 - b);
}

bool wr_pattern_grid(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                     WrError *err)
{
    const WrParams params = { wr_params_grid, values };
    Lines l = { .cells = wr_cells_of(&params, job->like),
                .edge = wr_edge_of(&params),
                .width = wr_param_number(&params, "width") };
    return wr_pattern_make(&params, job, grid_at, &l, 1, out, err);
}

/* ---- checks ---- */

const WrParam wr_params_checks[] = {
    WR_P_WHOLE("across", "Across", 8, 2, WR_CELLS_MAX, 32, "fields in a row; even"),
    WR_P_WHOLE("rows", "Rows", 8, 2, WR_CELLS_MAX, 32, "fields in a column; even"),
    WR_P_BEVEL(3),
    WR_P_PROFILE,
    WR_P_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

/* -1..1 along one axis, with a sign change at each side of a field. */
static double field_sign(const WrEdge *edge, double place, double size)
{
    double cell = floor(place), d = (0.5 - fabs(place - cell - 0.5)) * size;
    double rise = 2.0 * wr_edge_height(edge, d + 0.5 * edge->bevel) - 1.0;
    return cell - 2.0 * floor(0.5 * cell) == 0.0 ? rise : -rise;
}

/* 1/2 + s t / 2 with a sign along each axis: exact for a box filter, which is separable. */
static double check_at(const void *ctx, double x, double y)
{
    const Lines *l = ctx;
    double s = field_sign(&l->edge, x / l->cells.cell_width, l->cells.cell_width);
    double t = field_sign(&l->edge, y / l->cells.cell_height, l->cells.cell_height);
    return 0.5 + 0.5 * s * t;
}

bool wr_pattern_checks(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                       WrError *err)
{
    const WrParams params = { wr_params_checks, values };
    Lines l = { .cells = wr_cells_of(&params, job->like), .edge = wr_edge_of(&params) };
    bool odd = l.cells.across % 2 != 0;
    if (odd || l.cells.rows % 2 != 0)
        return wr_fail(err, "pattern checks: %s=%d: must be even, or the fields do not tile",
                       odd ? "across" : "rows", odd ? l.cells.across : l.cells.rows);
    return wr_pattern_make(&params, job, check_at, &l, 1, out, err);
}

/* ---- periodic directions ---- */

#define DIRECTION(a, b, what)                                                                      \
    WR_P_WHOLE("across", "Across", a, -WR_CELLS_MAX, WR_CELLS_MAX, 32,                             \
               what " from left to right"),                                                        \
        WR_P_WHOLE("rows", "Rows", b, -WR_CELLS_MAX, WR_CELLS_MAX, 32, what " from bottom to top")

static bool read_direction(const WrParams *params, const char *name, Lines *l,
                           const WrGenerateJob *job, WrError *err)
{
    double width = wr_field_width(job->like), height = wr_field_height(job->like);
    l->a = wr_param_number(params, "across");
    l->b = wr_param_number(params, "rows");
    if (l->a == 0.0 && l->b == 0.0)
        return wr_fail(err, "pattern %s: across=0 rows=0: one of them must be other than 0", name);
    l->cells = wr_cell_grid_make(job->like, 1, 1);
    l->steep = sqrt(l->a / width * (l->a / width) + l->b / height * (l->b / height));
    return true;
}

/* a and b whole: the phase changes by whole numbers across the table, so that stripes in this direction close. */
static double phase_at(const Lines *l, double x, double y)
{
    return l->a * (x / l->cells.width) + l->b * (y / l->cells.height);
}

/* ---- stripes ---- */

const WrParam wr_params_stripes[] = {
    DIRECTION(6, 4, "stripes"),
    WR_P_PART("width", "Width", 0.5, "width of the high stripes, relative to the period"),
    WR_P_BEVEL(6),
    WR_P_PROFILE,
    WR_P_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

static double stripe_at(const void *ctx, double x, double y)
{
    const Lines *l = ctx;
    return wr_edge_height(&l->edge, (0.5 * l->width - to_whole(phase_at(l, x, y))) / l->steep);
}

bool wr_pattern_stripes(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams params = { wr_params_stripes, values };
    Lines l = { .edge = wr_edge_of(&params), .width = wr_param_number(&params, "width") };
    if (!read_direction(&params, "stripes", &l, job, err)) return false;
    return wr_pattern_make(&params, job, stripe_at, &l, 1, out, err);
}

/* ---- waves ---- */

#define WAVES(X) X(SINE, "sine") X(TRIANGLE, "triangle") X(RIPPLE, "ripple") X(DUNE, "dune")
typedef enum WaveShape { WAVES(WR_WORD_ID) } WaveShape;
static const char *const wave_shapes[] = { WAVES(WR_WORD) NULL };

const WrParam wr_params_waves[] = {
    DIRECTION(8, 0, "waves"),
    WR_P_CHOICE("shape", "Shape", SINE, wave_shapes,
                "shape of a wave; ripples have sharp crests, dunes are asymmetric"),
    WR_P_NUMBER("sway", "Sway", 0.3, 0, 16, 1, "", "sideways swing of the crests, in wavelengths"),
    WR_P_WHOLE("swings", "Swings", 3, 0, 64, 16, "number of swings along the crests"),
    WR_P_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Waves {
    Lines lines;
    WaveShape shape;
    int swings;
    double sway;
    double along_u, along_v; /* integer counts of the direction along the crests */
} Waves;

static double wave_at(const void *ctx, double x, double y)
{
    const Waves *w = ctx;
    double phase = phase_at(&w->lines, x, y);
    double u = x / w->lines.cells.width, v = y / w->lines.cells.height;
    double along = w->along_u * u + w->along_v * v;
    if (w->swings > 0)
        phase += w->sway * (0.7 * wr_ripple(w->swings * along) +
                            0.3 * wr_ripple((w->swings + 1) * along + 0.37));
    double part = phase - floor(phase);
    switch (w->shape) {
    case TRIANGLE: return 2.0 * to_whole(phase);
    case RIPPLE: return 1.0 - wr_ripple(0.5 * part);
    case DUNE: { /* rises for 70 % of a wave, falls for 30 %, smooth at both ends */
        double t = part < 0.7 ? part / 0.7 : (1.0 - part) / 0.3;
        return t * t * (3.0 - 2.0 * t);
    }
    case SINE: break;
    }
    return 0.5 - 0.5 * wr_ripple(phase + 0.25);
}

static int common_divisor(int a, int b)
{
    a = abs(a);
    b = abs(b);
    while (b) {
        int rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

bool wr_pattern_waves(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams params = { wr_params_waves, values };
    Waves w = { .shape = (WaveShape)wr_param_whole(&params, "shape"),
                .swings = wr_param_whole(&params, "swings"),
                .sway = wr_param_number(&params, "sway") };
    if (!read_direction(&params, "waves", &w.lines, job, err)) return false;
    /* The direction along the crests is perpendicular in (a, b): (-b, a) / gcd are the smallest whole numbers, so that the
       swings close, too. */
    int divisor = common_divisor((int)w.lines.a, (int)w.lines.b);
    w.along_u = -w.lines.b / divisor;
    w.along_v = w.lines.a / divisor;
    return wr_pattern_make(&params, job, wave_at, &w, 2, out, err);
}

/* ---- knurling ---- */

const WrParam wr_params_knurl[] = {
    DIRECTION(16, 16, "grooves in each direction"),
    WR_P_PART("flat", "Flat tops", 0.2, "share of the pyramids' height that is cut off"),
    WR_P_PART("valley", "Valleys", 0.1, "width of the floor of the grooves"),
    WR_P_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Knurl {
    Lines lines;
    double flat, valley;
} Knurl;

static double knurl_at(const void *ctx, double x, double y)
{
    const Knurl *k = ctx;
    double p = k->lines.a * (x / k->lines.cells.width),
           q = k->lines.b * (y / k->lines.cells.height);
    double one = 2.0 * to_whole(p + q), two = 2.0 * to_whole(p - q);
    /* The minimum of two triangle waves is a field of pyramids; their tops are cut off at `top`, their valleys filled up to
       `low`. */
    double h = one < two ? one : two, top = 1.0 - k->flat;
    double low = k->valley * top;
    if (h >= top) return 1.0;
    return h > low ? (h - low) / (top - low) : 0.0;
}

bool wr_pattern_knurl(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams params = { wr_params_knurl, values };
    Knurl k = { .flat = wr_param_number(&params, "flat"),
                .valley = wr_param_number(&params, "valley") };
    if (!read_direction(&params, "knurl", &k.lines, job, err)) return false;
    return wr_pattern_make(&params, job, knurl_at, &k, WR_PATTERN_SAMPLES, out, err);
}

#include "generate/transform_piece.h"

#include "base/exactmath.h"
#include "field/field.h"
#include "generate/tile_builder.h"

#include <math.h>
#include <stdlib.h>

const char *const wr_place_filters[] = { WR_PLACE_FILTERS(WR_WORD) NULL };

typedef struct Placed {
    const WrPlacing *placing;
    bool whole;        /* texels map to texels: only bits are copied */
    double to[2][2];   /* A */
    double back[2][2]; /* its inverse */
    double at[2];      /* target of `from`, such that whole pieces are on whole texels */
    double soft
        [2]; /* texels of the table per texel of the source, along its axes: for the window's rim */
    double wide[2]; /* stretch of the filter along the source's axes */
    double box[4];  /* of the piece in the table: left, top, right, bottom */
    int period[2];  /* of the table; 0: none */
} Placed;

/* ---- where things go ---- */

static void turn(double degrees, double *cosine, double *sine)
{
    wr_sincos_turns(degrees / 360.0, sine, cosine);
}

/* Source (x, y) to table: at + A (x - from) with A = R diag(scale) and R a rotation; negative scales mirror. The inverse is
   diag(1/scale) R^T. */
static void set_maps(Placed *p, const WrPlacing *placing)
{
    double c, s;
    turn(placing->turn_deg, &c, &s);
    const double *scale = placing->scale;
    /* rows run down: anticlockwise turns right to up, which is a row less */
    p->to[0][0] = c * scale[0];
    p->to[0][1] = s * scale[1];
    p->to[1][0] = -s * scale[0];
    p->to[1][1] = c * scale[1];
    p->back[0][0] = c / scale[0];
    p->back[0][1] = -s / scale[0];
    p->back[1][0] = s / scale[1];
    p->back[1][1] = c / scale[1];
    for (int k = 0; k < 2; k++) {
        p->soft[k] = fabs(scale[k]);
        p->wide[k] = fmax(1.0, 1.0 / fabs(scale[k]));
        p->at[k] = placing->at[k];
    }
    p->whole = fabs(scale[0]) == 1.0 && fabs(scale[1]) == 1.0 && (c == 0.0 || s == 0.0);
    if (!p->whole) return;
    /* centres are at halves, so A maps them to halves plus this offset */
    for (int k = 0; k < 2; k++) {
        double lead = p->to[k][0] * placing->from[0] + p->to[k][1] * placing->from[1];
        p->at[k] = rint(placing->at[k] - lead) + lead;
    }
}

static void set_box(Placed *p)
{
    const double *w = p->placing->window;
    for (int k = 0; k < 4; k++) p->box[k] = k < 2 ? INFINITY : -INFINITY;
    for (int corner = 0; corner < 4; corner++) {
        double x = w[0] + (corner & 1 ? w[2] : 0.0) - p->placing->from[0];
        double y = w[1] + (corner & 2 ? w[3] : 0.0) - p->placing->from[1];
        for (int k = 0; k < 2; k++) {
            double at = p->at[k] + p->to[k][0] * x + p->to[k][1] * y;
            p->box[k] = fmin(p->box[k], at - 1.0);
            p->box[k + 2] = fmax(p->box[k + 2], at + 1.0);
        }
    }
}

/* ---- reading the source ---- */

static int index_of(int i, int n, bool periodic)
{
    if (!periodic) return i < 0 ? 0 : i >= n ? n - 1 : i;
    i %= n;
    return i < 0 ? i + n : i;
}

static double source_at(const WrField *field, int i, int j)
{
    i = index_of(i, wr_field_width(field), wr_field_wrap_u(field) == WR_WRAP_PERIODIC);
    j = index_of(j, wr_field_height(field), wr_field_wrap_v(field) == WR_WRAP_PERIODIC);
    return (double)wr_field_get(field, i, j);
}

/* Tent, or Catmull-Rom with a = -1/2. Stretched by 1 / scale where the piece shrinks, so that all source texels contribute. */
static double filter_value(WrPlaceFilter filter, double x)
{
    double a = fabs(x);
    if (filter == WR_PLACE_LINEAR) return a < 1.0 ? 1.0 - a : 0.0;
    return a < 1.0   ? 1.0 + a * a * (1.5 * a - 2.5)
           : a < 2.0 ? 2.0 + a * (-4.0 + a * (2.5 - 0.5 * a))
                     : 0.0;
}

#define TAPS_MAX (4 * (int)WR_PLACE_SCALE + 4)

/* The texels and weights at x along one axis; the weights sum to 1. */
static int taps_at(const Placed *p, int axis, double x, int *first, double weight[TAPS_MAX])
{
    const WrPlaceFilter filter = p->placing->filter;
    double wide = p->wide[axis], reach = (filter == WR_PLACE_LINEAR ? 1.0 : 2.0) * wide, sum = 0.0;
    if (filter == WR_PLACE_NEAREST) {
        *first = (int)floor(x);
        weight[0] = 1.0;
        return 1;
    }
    *first = (int)ceil(x - 0.5 - reach);
    int count = (int)floor(x - 0.5 + reach) - *first + 1;
    for (int k = 0; k < count; k++)
        sum += weight[k] = filter_value(filter, (*first + k + 0.5 - x) / wide);
    for (int k = 0; k < count; k++) weight[k] /= sum;
    return count;
}

typedef struct Taps {
    int first[2], count[2];
    double weight[2][TAPS_MAX];
} Taps;

static double sum_of(const WrField *field, const Taps *t)
{
    double sum = 0.0;
    for (int y = 0; y < t->count[1]; y++) {
        double row = 0.0;
        for (int x = 0; x < t->count[0]; x++)
            row += t->weight[0][x] * source_at(field, t->first[0] + x, t->first[1] + y);
        sum += t->weight[1][y] * row;
    }
    return sum;
}

static double unit(double x)
{
    return x > 0.0 ? x < 1.0 ? x : 1.0 : 0.0;
}

/* Fraction of a texel at that position of the source inside the window. Whole pieces include or exclude
 * texels by their centres. */
static double inside(const Placed *p, const double q[2])
{
    double part = 1.0;
    for (int k = 0; k < 2; k++) {
        double from = q[k] - p->placing->window[k], to = p->placing->window[k + 2] - from;
        double in = from < to ? from : to;
        part *= p->whole ? in > 0.0 : unit(in * p->soft[k] + 0.5);
    }
    return part;
}

/* ---- texels ---- */

/* The texel at (x, y) for one image of the piece: true if its weight exceeds *most. */
static bool take(const Placed *p, double x, double y, double *most, float *height)
{
    double dx = x - p->at[0], dy = y - p->at[1], q[2];
    for (int k = 0; k < 2; k++)
        q[k] = p->placing->from[k] + p->back[k][0] * dx + p->back[k][1] * dy;
    double part = inside(p, q);
    if (!(part > *most)) return false;
    const WrField *weight = p->placing->weight;
    if (p->whole) {
        int i = (int)floor(q[0]), j = (int)floor(q[1]); /* q is at halves except for rounding */
        if (weight) part *= unit(source_at(weight, i, j));
        if (!(part > *most)) return false;
        *height = (float)source_at(p->placing->heights, i, j);
    } else {
        Taps taps;
        for (int k = 0; k < 2; k++)
            taps.count[k] = taps_at(p, k, q[k], &taps.first[k], taps.weight[k]);
        if (weight) part *= unit(sum_of(weight, &taps));
        if (!(part > *most)) return false;
        *height = (float)sum_of(p->placing->heights, &taps);
    }
    *most = part;
    return true;
}

/* First and last image, in whole periods, that reaches from..to. */
static void images(const Placed *p, int axis, double from, double to, int *first, int *last)
{
    *first = *last = 0;
    int n = p->period[axis];
    if (!n) return;
    *first = (int)ceil((p->box[axis] - to) / n);
    *last = (int)floor((p->box[axis + 2] - from) / n);
}

/* Enumerates image numbers in the order 0, 1, -1, 2, -2, ...: among images of equal weight, the one
   nearest to the piece's own position wins. A piece larger than the table overlaps itself. */
static int next_image(int image)
{
    return image > 0 ? -image : 1 - image;
}

/* The height of the image with the largest weight at one texel. */
static float take_images(const Placed *p, double x, double y, const int first[2], const int last[2],
                         float *height)
{
    const int most_u = last[0] > -first[0] ? last[0] : -first[0];
    const int most_v = last[1] > -first[1] ? last[1] : -first[1];
    double most = 0.0;
    for (int v = 0; abs(v) <= most_v; v = next_image(v)) {
        if (v < first[1] || v > last[1]) continue;
        for (int u = 0; abs(u) <= most_u; u = next_image(u))
            if (u >= first[0] && u <= last[0])
                take(p, x + (double)u * p->period[0], y + (double)v * p->period[1], &most, height);
    }
    return (float)most;
}

static void fill_block(const void *ctx, const WrGenerateBlock *b, int worker, float *heights,
                       float *cover)
{
    const Placed *p = ctx;
    (void)worker;
    int first[2], last[2];
    images(p, 0, b->i, b->i + b->count_i, &first[0], &last[0]);
    images(p, 1, b->j, b->j + b->count_j, &first[1], &last[1]);
    for (int y = 0; y < b->count_j; y++)
        for (int x = 0; x < b->count_i; x++)
            cover[y * WR_TILE + x] = take_images(p, b->i + x + 0.5, b->j + y + 0.5, first, last,
                                                 &heights[y * WR_TILE + x]);
}

bool wr_transform_piece(const WrPlacing *placing, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    Placed p = { .placing = placing };
    const WrField *like = job->like;
    if (wr_field_wrap_u(like) == WR_WRAP_PERIODIC) p.period[0] = wr_field_width(like);
    if (wr_field_wrap_v(like) == WR_WRAP_PERIODIC) p.period[1] = wr_field_height(like);
    set_maps(&p, placing);
    set_box(&p);
    return wr_generate_build(job, fill_block, &p, true, 0.0, out, err);
}

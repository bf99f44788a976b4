/* Operations for tables whose opposite edges do not fit: make seamless, match edges, even out light. */
#include "base/memory.h"
#include "base/progress.h"
#include "field/fft_plane.h"
#include "field/field.h"
#include "field/least_path.h"
#include "field/ops_internal.h"

#include <math.h>
#include <stdint.h>

/* ---- the table in double precision ---- */

/* Heights z[height][width]. One axis is processed after the other; the second pass applies to both edges of
   the first axis alike, so that these still fit. */
typedef struct Plane {
    const WrOpJob *job;
    double *z;
    int width, height;
} Plane;

/* The plane along one axis: n texels from edge to edge in each of `lines` lines. */
typedef struct Axis {
    const WrOpJob *job;
    double *z;
    int n, lines;
    size_t step, across; /* doubles to the next texel, to the next line */
    const double *shift; /* [lines]: difference in level of the edges and the middle */
} Axis;

static Axis axis_of(const Plane *p, int axis)
{
    const size_t row = (size_t)p->width;
    return axis == 0 ? (Axis){ p->job, p->z, p->width, p->height, 1, row, NULL }
                     : (Axis){ p->job, p->z, p->height, p->width, row, 1, NULL };
}

/* Texel k of line 0, counted from the near edge (side 0) or the far edge (side 1). */
static double *texel(const Axis *a, int side, int k)
{
    return a->z + (size_t)(side ? a->n - 1 - k : k) * a->step;
}

/* The same texel of the table offset by half: opposite edges of that table are neighbours in the middle
   of this one. Its level is that of both edges. */
static double half_height(const Axis *a, int side, int k, int line)
{
    const int at = side ? a->n / 2 - 1 - k : a->n / 2 + k;
    return a->z[(size_t)at * a->step + (size_t)line * a->across] + a->shift[line];
}

static void load_row(int index, int worker, void *ctx)
{
    enum { PART = 256 };
    (void)worker;
    const Plane *p = ctx;
    float part[PART];
    double *row = p->z + (size_t)index * (size_t)p->width;
    for (int i = 0; i < p->width; i += PART) {
        const int count = p->width - i < PART ? p->width - i : PART;
        wr_field_read(p->job->in, i, index, count, 1, part, PART);
        for (int x = 0; x < count; x++) row[i + x] = part[x];
    }
}

static void make_plane(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                       void *scratch)
{
    (void)job, (void)scratch;
    const Plane *p = ctx;
    for (int y = 0; y < b.count_j; y++) {
        const double *row = p->z + (size_t)(b.j + y) * (size_t)p->width + b.i;
        for (int x = 0; x < b.count_i; x++) out[(size_t)y * pitch + x] = wr_op_float(row[x]);
    }
}

/* 0 at 0, 1 at 1, level at both */
static double smooth_step(double t)
{
    return t <= 0.0 ? 0.0 : t >= 1.0 ? 1.0 : t * t * (3.0 - 2.0 * t);
}

/* A width in texels: 0 is an eighth of the side; at most the side divided by `parts`. */
static int width_of(const Axis *a, double width, int parts)
{
    const int wanted = width > 0.0 ? (int)width : (a->n + 7) / 8, most = a->n / parts;
    return wanted < most ? wanted : most;
}

/* ---- blend ---- */

/* Cross-fade of the table F with G, the table offset by half, at one distance from an edge.
 *
 * L = F + s (G - F) has less contrast than F and G unless these are equal. The variance v along the edge is
 * restored to (1 - s) v(F) + s v(G): deviations of L from its mean are multiplied by
 *
 *   gain = sqrt(((1 - s) v(F) + s v(G)) / v(L)),  1 .. sqrt(2) for F and G without correlation,
 *
 * which is 1 where F and G agree, so that slopes and flat places are not amplified. */
static void mix_lines(const Axis *a, int side, int k, double s)
{
    double *f = texel(a, side, k), mean_f = 0.0, mean_g = 0.0, ff = 0.0, gg = 0.0, fg = 0.0;
    for (int l = 0; l < a->lines; l++) {
        mean_f += f[(size_t)l * a->across] / a->lines;
        mean_g += half_height(a, side, k, l) / a->lines;
    }
    for (int l = 0; l < a->lines; l++) {
        const double x = f[(size_t)l * a->across] - mean_f;
        const double y = half_height(a, side, k, l) - mean_g;
        ff += x * x;
        gg += y * y;
        fg += x * y;
    }
    const double mixed = (1 - s) * (1 - s) * ff + s * s * gg + 2 * s * (1 - s) * fg;
    const double wanted = (1 - s) * ff + s * gg, mean = mean_f + s * (mean_g - mean_f);
    const double gain = mixed > 0.0 ? fmin(sqrt(wanted / mixed), sqrt(2.0)) : 1.0;
    for (int l = 0; l < a->lines; l++) {
        double *to = f + (size_t)l * a->across;
        const double linear = *to + s * (half_height(a, side, k, l) - *to);
        *to = linear + (gain - 1.0) * (linear - mean);
    }
}

static bool blend_edges(const Axis *a, int width)
{
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < width && !wr_progress_cancelled(a->job->progress); k++)
            mix_lines(a, side, k, 1.0 - smooth_step((double)k / width));
    return true;
}

/* ---- patches ---- */

/* A cut between the table offset by half (towards the edge) and the table (inside). */
typedef struct Cut {
    const Axis *a;
    int side, reach; /* of the fade on either side of the cut, in texels */
    int *path;       /* [lines]: distance from the edge, less `reach` */
} Cut;

static double mismatch(const void *ctx, int along, int line)
{
    const Cut *cut = ctx;
    const int k = along + cut->reach - 1;
    const double d = texel(cut->a, cut->side, k)[(size_t)line * cut->a->across] -
                     half_height(cut->a, cut->side, k, line);
    return d * d;
}

static void join_at_cut(const Cut *cut)
{
    const Axis *a = cut->a;
    for (int l = 0; l < a->lines; l++)
        for (int k = 0; k < cut->path[l] + 2 * cut->reach; k++) {
            const double t = cut->reach ? (k - cut->path[l]) / (2.0 * cut->reach) : 0.0;
            double *to = texel(a, cut->side, k) + (size_t)l * a->across;
            *to += (1.0 - smooth_step(t)) * (half_height(a, cut->side, k, l) - *to);
        }
}

static bool cut_edges(const Axis *a, int width)
{
    const int reach = width < 3 ? 0 : (width + 15) / 16;
    if (width < 1) return true;
    int *path = wr_try_alloc((size_t)a->lines, sizeof *path, a->job->name, a->job->err);
    bool good = path != NULL;
    for (int side = 0; side < 2 && good; side++) {
        const Cut cut = { a, side, reach, path };
        const WrOverlap overlap = { width - 2 * reach + 1, a->lines, true, mismatch, &cut };
        good = wr_least_path(&overlap, path, a->job->err) && wr_op_step(a->job, 0.5 * side);
        if (good) join_at_cut(&cut);
    }
    wr_free(path);
    return good;
}

/* ---- mirror ---- */

/* Mirrors at the first and the middle texel: neither is doubled. */
static bool mirror_half(const Axis *a)
{
    for (int k = a->n / 2 + 1; k < a->n && !wr_progress_cancelled(a->job->progress); k++)
        for (int l = 0; l < a->lines; l++)
            texel(a, 0, k)[(size_t)l * a->across] = texel(a, 0, a->n - k)[(size_t)l * a->across];
    return true;
}

/* ---- the operations ---- */

/* shift[line]: by how much both edges, `width` texels wide, are higher than the middle, as the mean over `width`
   lines on either side. Without it a strip of another level would remain along the edge. differences:
   [lines] of scratch. */
static void measure_shift(const Axis *a, int width, double *differences, double *shift)
{
    const int reach = width < a->lines / 2 ? width : (a->lines - 1) / 2;
    for (int l = 0; l < a->lines; l++)
        for (int side = 0; side < 2; side++)
            for (int k = 0; k < width; k++)
                differences[l] +=
                    (texel(a, side, k)[(size_t)l * a->across] - half_height(a, side, k, l)) /
                    (2.0 * width);
    for (int l = 0; l < a->lines && !wr_progress_cancelled(a->job->progress); l++) {
        double sum = 0.0;
        for (int k = l - reach; k <= l + reach; k++)
            sum += differences[k < 0 ? k + a->lines : k < a->lines ? k : k - a->lines];
        shift[l] = sum / (2 * reach + 1);
    }
}

static bool seamless_axis(const Axis *whole, const double *param)
{
    Axis a = *whole;
    const int how = (int)param[0], width = width_of(&a, param[1], 4);
    if (how == WR_REPEAT_MIRROR) return mirror_half(&a);
    const size_t lines = (size_t)a.lines;
    double *shift = wr_try_alloc(2 * lines, sizeof *shift, a.job->name, a.job->err);
    if (!shift) return false;
    double *made = shift + lines;
    a.shift = made; /* zeros while it is measured */
    measure_shift(&a, width, shift, made);
    const bool good = (how == WR_REPEAT_BLEND ? blend_edges : cut_edges)(&a, width);
    wr_free(shift);
    return good;
}

static bool match_axis(const Axis *a, const double *param)
{
    const int width = width_of(a, param[0], 2);
    for (int l = 0; l < a->lines; l++) {
        double *near = texel(a, 0, 0) + (size_t)l * a->across;
        double *far = texel(a, 1, 0) + (size_t)l * a->across;
        const double half = 0.5 * (*far - *near), middle = *near + half;
        for (int k = 1; k < width; k++) {
            const double t = 1.0 - (double)k / width;
            const double ramp = half * (param[1] == WR_RAMP_LINEAR ? t : smooth_step(t));
            near[(size_t)k * a->step] += ramp;
            *(far - (size_t)k * a->step) -= ramp;
        }
        if (width > 0) *near = *far = middle;
    }
    return true;
}

/* The periodic component of the whole plane. */
static bool make_periodic(const Plane *p)
{
    const WrPlane plane = { .width = p->width,
                            .height = p->height,
                            .ends = { WR_ENDS_RING, WR_ENDS_RING },
                            .z = p->z,
                            .pool = p->job->pool,
                            .progress = p->job->progress };
    return wr_plane_make_periodic(&plane, p->job->err);
}

/* Runs `change` along both axes of a copy of the input; NULL: makes it periodic. */
static WrField *change_plane(WrOpJob *job, bool (*change)(const Axis *a, const double *param),
                             const double *param)
{
    Plane p = { job, NULL, wr_field_width(job->in), wr_field_height(job->in) };
    p.z = wr_try_alloc((size_t)p.height, (size_t)p.width * sizeof *p.z, job->name, job->err);
    job->to = 0.25;
    bool good = p.z && wr_op_pieces(job, p.height, load_row, &p);
    for (int axis = 0; axis < 2 && good; axis++) {
        job->from = job->to;
        job->to += 0.25;
        const Axis a = axis_of(&p, axis);
        good = change ? change(&a, param) : axis > 0 || make_periodic(&p);
        good = good && wr_op_step(job, 1.0);
    }
    job->from = job->to;
    job->to = 1.0;
    const WrOpWork work = { .make = make_plane, .ctx = &p, .reach = -1 };
    WrField *out = good ? wr_op_build_same(job, &work) : NULL;
    wr_free(p.z);
    return out;
}

/* param: how, width */
WrField *wr_op_seamless(WrOpJob *job, const double *param)
{
    return change_plane(job, param[0] == WR_REPEAT_FREQUENCY ? NULL : seamless_axis, param);
}

/* param: width, ramp */
WrField *wr_op_match_edges(WrOpJob *job, const double *param)
{
    return change_plane(job, match_axis, param);
}

/* ---- even out light ---- */

typedef struct Even {
    const WrField *low; /* blurred input */
    double mean;        /* of the input */
} Even;

static void make_even(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                      void *scratch)
{
    const Even *even = ctx;
    float *low = scratch;
    wr_field_read(job->in, b.i, b.j, b.count_i, b.count_j, out, pitch);
    wr_field_read(even->low, b.i, b.j, b.count_i, b.count_j, low, WR_OP_SIDE);
    for (int y = 0; y < b.count_j; y++)
        for (int x = 0; x < b.count_i; x++) {
            float *to = out + (size_t)y * pitch + x;
            *to = wr_op_float(*to + (even->mean - low[y * WR_OP_SIDE + x]));
        }
}

/* The mean height. Heights are counted in steps of 2^-30 of the largest |F|, rounded up to a power of two: sums
   of integers do not depend on their order, so that a rolled table has the same mean. */
static bool mean_height(const WrOpJob *job, double *mean)
{
    const int width = wr_field_width(job->in), height = wr_field_height(job->in);
    float low, high, row[WR_OP_SIDE];
    wr_field_range(job->in, &low, &high);
    const double largest = fmax(fabs((double)low), fabs((double)high));
    const int exponent = largest > 0.0 ? ilogb(largest) + 1 : 0;
    int64_t sum = 0;
    for (int j = 0; j < height; j++) {
        if (j % WR_TILE == 0 && !wr_op_step(job, (double)j / height)) return false;
        for (int i = 0; i < width; i += WR_OP_SIDE) {
            const int count = width - i < WR_OP_SIDE ? width - i : WR_OP_SIDE;
            wr_field_read(job->in, i, j, count, 1, row, WR_OP_SIDE);
            for (int x = 0; x < count; x++) sum += llrint(scalbn((double)row[x], 30 - exponent));
        }
    }
    *mean = scalbn((double)sum / ((double)width * height), exponent - 30);
    return true;
}

/* F - blurred F + mean; param: sigma */
WrField *wr_op_even_light(WrOpJob *job, const double *param)
{
    Even even = { 0 };
    job->to = 0.25;
    if (!mean_height(job, &even.mean)) return NULL;
    WrOpJob blur = *job;
    blur.mask = blur.was = blur.made = NULL;
    blur.from = 0.25;
    blur.to = 0.75;
    WrField *low = wr_op_blur(&blur, param);
    if (!low) return NULL;
    even.low = low;
    job->from = 0.75;
    job->to = 1.0;
    const WrOpWork work = { .make = make_even,
                            .ctx = &even,
                            .scratch = sizeof(float[WR_OP_SIDE][WR_OP_SIDE]),
                            .reach = -1 };
    WrField *out = wr_op_build_same(job, &work);
    wr_field_free(low);
    return out;
}

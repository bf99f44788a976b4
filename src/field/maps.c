#include "field/maps.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"
#include "field/occlusion.h"
#include "field/ops.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define ROWS 16     /* rows of a map in one piece of work */
#define COLUMNS 256 /* columns of the box sums, so that they stay in the cache */

WrMapJob wr_map_default(const WrDerivatives *ground)
{
    return (WrMapJob){ .ground = *ground, .directions = 16, .sigma = 8, .box = 9 };
}

/* ---- texel by texel ------------------------------------------------------------------------------ */

/* Converts derivatives of a row to `count` numbers of the map. */
typedef void Derive(const WrMapJob *job, const WrDerivativesRow *row, int count, double *out);

typedef struct Making {
    const WrMapJob *job;
    const WrMapPart *part;
    float *out;
    float *second; /* slopes along v */
    Derive *derive;
    bool bends;
    int64_t replaced; /* updated atomically */
} Making;

static int put(const double *row, int count, float *out)
{
    int replaced = 0;
#pragma omp simd reduction(+ : replaced)
    for (int i = 0; i < count; i++) {
        const float x = (float)row[i];
        const int good = fabsf(x) <= FLT_MAX;
        out[i] = good ? x : 0.0f;
        replaced += 1 - good;
    }
    return replaced;
}

static void derive_piece(int index, int worker, void *ctx)
{
    Making *m = ctx;
    const WrMapPart *part = m->part;
    const int y = index * ROWS, rows = part->h - y < ROWS ? part->h - y : ROWS;
    /* One band of rows with its apron is read per piece: neighbouring pieces read overlapping texels instead of sharing them,
       which needs no locks. Each result depends on its own stencil only, so any number of threads makes the same bytes. */
    int64_t replaced = 0;
    WrDerivativesRow row = wr_derivatives_row_new(part->w, m->bends);
    WrDerivativesBand *band =
        wr_derivatives_open(&m->job->ground, part->x, part->y + y, part->w, rows);
    double *made = wr_alloc((size_t)part->w, sizeof *made);
    (void)worker;
    for (int j = 0; j < rows; j++) {
        const size_t at = (size_t)(y + j) * part->pitch;
        wr_derivatives_row(band, j, &row);
        if (m->derive) m->derive(m->job, &row, part->w, made);
        replaced += put(m->derive ? made : row.p, part->w, m->out + at);
        if (m->second) replaced += put(row.q, part->w, m->second + at);
    }
    wr_free(made);
    wr_derivatives_close(band);
    wr_derivatives_row_free(&row);
    __atomic_fetch_add(&m->replaced, replaced, __ATOMIC_RELAXED);
}

static bool run_rows(Making *m, WrPool *pool, int64_t *replaced, WrError *err)
{
    if (!wr_pool_run(pool, (m->part->h + ROWS - 1) / ROWS, derive_piece, m))
        return wr_fail(err, "map: cancelled");
    *replaced += m->replaced;
    return true;
}

static void curvature(const WrMapJob *job, const WrDerivativesRow *row, int count, double *out)
{
    (void)job;
    for (int i = 0; i < count; i++)
        out[i] = wr_derivatives_convexity(row->p[i], row->q[i], row->r[i], row->s[i], row->t[i]);
}

/* Angle between the normal and the vertical: atan |grad F|, in degrees. */
static void slope(const WrMapJob *job, const WrDerivativesRow *row, int count, double *out)
{
    (void)job;
    for (int i = 0; i < count; i++) {
        const double p = row->p[i], q = row->q[i];
        out[i] = wr_atan2(sqrt(p * p + q * q), 1) * 180 / WR_PI;
    }
}

/* 360 degrees wraps to 0, also if only rounding to float produced it. Downhill is -grad F, hence atan2(-q, -p). */
static void direction(const WrMapJob *job, const WrDerivativesRow *row, int count, double *out)
{
    (void)job;
    for (int i = 0; i < count; i++) {
        const double p = row->p[i], q = row->q[i];
        double turn = p == 0 && q == 0 ? 0 : wr_atan2(-q, -p) * 180 / WR_PI;
        if (turn < 0) turn += 360;
        out[i] = (float)turn < 360 ? turn : 0;
    }
}

static void slope_u(const WrMapJob *job, const WrDerivativesRow *row, int count, double *out)
{
    (void)job;
    memcpy(out, row->p, (size_t)count * sizeof *out);
}

static void slope_v(const WrMapJob *job, const WrDerivativesRow *row, int count, double *out)
{
    (void)job;
    memcpy(out, row->q, (size_t)count * sizeof *out);
}

static bool make_slope_u(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                         int64_t *replaced, WrError *err)
{
    Making m = { .job = job, .part = part, .out = out, .derive = slope_u };
    return run_rows(&m, pool, replaced, err);
}

static bool make_slope_v(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                         int64_t *replaced, WrError *err)
{
    Making m = { .job = job, .part = part, .out = out, .derive = slope_v };
    return run_rows(&m, pool, replaced, err);
}

static bool make_curvature(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                           int64_t *replaced, WrError *err)
{
    Making m = { .job = job, .part = part, .out = out, .derive = curvature, .bends = true };
    return run_rows(&m, pool, replaced, err);
}

static bool make_slope(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                       int64_t *replaced, WrError *err)
{
    Making m = { .job = job, .part = part, .out = out, .derive = slope };
    return run_rows(&m, pool, replaced, err);
}

static bool make_direction(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                           int64_t *replaced, WrError *err)
{
    Making m = { .job = job, .part = part, .out = out, .derive = direction };
    return run_rows(&m, pool, replaced, err);
}

/* ---- occlusion ----------------------------------------------------------------------------------- */

static WrOcclusion occlusion_of(const WrMapJob *job)
{
    const WrDerivatives *g = &job->ground;
    return (WrOcclusion){ g->field,
                          g->height,
                          g->cell_w / wr_field_width(g->field),
                          g->cell_h / wr_field_height(g->field),
                          job->directions,
                          job->reach };
}

/* Occlusion is relative to each texel's own tilted hemisphere: the slopes p, q are made first, [part->h][part->pitch] as the
   map. */
static bool make_occlusion(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                           int64_t *replaced, WrError *err)
{
    const size_t texels = part->pitch * (size_t)part->h;
    const WrOcclusion occlusion = occlusion_of(job);
    float *p = wr_try_alloc_unset(texels, sizeof *p, "slopes of the table", err);
    float *q = p ? wr_try_alloc_unset(texels, sizeof *q, "slopes of the table", err) : NULL;
    Making m = { .job = job, .part = part, .out = p, .second = q };
    const bool good = q && run_rows(&m, pool, replaced, err) &&
                      wr_occlusion_make(&occlusion, part, p, q, pool, out, err);
    wr_free(p);
    wr_free(q);
    return good;
}

/* ---- cavity -------------------------------------------------------------------------------------- */

/* A separate table for a part and the margin that the blur reads. */
static WrField *cut_out(const WrField *field, const WrMapPart *part, int more, WrError *err)
{
    const int w = part->w + 2 * more, h = part->h + 2 * more;
    WrField *cut = wr_field_new(w, h, WR_WRAP_CLAMP, WR_WRAP_CLAMP, wr_field_level(field), err);
    float *row = cut ? wr_alloc_unset((size_t)w, sizeof *row) : NULL;
    for (int j = 0; cut && j < h; j++) {
        wr_derivatives_read_clamped(field, part->x - more, part->y - more + j, w, row);
        wr_field_write(cut, 0, j, w, 1, row, (size_t)w);
    }
    wr_free(row);
    return cut;
}

/* Margin of the Gaussian: the tails beyond 4 sigma hold erfc(4 / sqrt 2) = 6e-5 of its mass. */
static int blurred(const WrMapJob *job)
{
    return (int)ceil(4 * job->sigma) + 2;
}

/* out contains blurred heights and receives the cavity. */
static void sink(const WrMapJob *job, const WrMapPart *part, float *out)
{
    float *row = wr_alloc_unset((size_t)part->w, sizeof *row);
    for (int j = 0; j < part->h; j++) {
        float *at = out + (size_t)j * part->pitch;
        wr_field_read(job->ground.field, part->x, part->y + j, part->w, 1, row, (size_t)part->w);
        for (int i = 0; i < part->w; i++) {
            const double depth = job->ground.height * ((double)row[i] - (double)at[i]);
            at[i] = depth < 0 ? (float)depth : 0.0f;
        }
    }
    wr_free(row);
}

static bool make_cavity(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                        int64_t *replaced, WrError *err)
{
    const WrField *field = job->ground.field;
    const bool whole = part->w == wr_field_width(field) && part->h == wr_field_height(field);
    const int more = whole ? 0 : blurred(job);
    WrField *cut = whole ? NULL : cut_out(field, part, more, err);
    const WrOpOptions options = { .pool = pool };
    WrField *blur = whole || cut ? wr_op_run(wr_op_find("blur"), whole ? field : cut, &job->sigma,
                                             &options, err)
                                 : NULL;
    (void)replaced;
    if (blur) {
        wr_field_read(blur, more, more, part->w, part->h, out, part->pitch);
        sink(job, part, out);
    }
    wr_field_free(blur);
    wr_field_free(cut);
    return blur != NULL;
}

/* ---- roughness ----------------------------------------------------------------------------------- */

/* Sums over a box's columns of p, q, p p and q q. */
typedef struct Sums {
    double *at[4]; /* [rows][COLUMNS] each */
} Sums;

static void sum_row(const WrDerivativesRow *row, int box, int count, const Sums *sums, int j)
{
    for (int i = 0; i < count; i++) {
        double p = 0, q = 0, pp = 0, qq = 0;
        for (int k = i; k < i + box; k++) {
            p += row->p[k], q += row->q[k];
            pp += row->p[k] * row->p[k], qq += row->q[k] * row->q[k];
        }
        const size_t at = (size_t)j * COLUMNS + (size_t)i;
        sums->at[0][at] = p, sums->at[1][at] = q, sums->at[2][at] = pp, sums->at[3][at] = qq;
    }
}

/* Beckmann roughness of the slopes in a box. The variance of p is E[p^2] - E[p]^2, clamped at 0 against cancellation (HC93), and
   so is that of q. Beckmann's alpha^2 is twice the variance of the slope along one axis, here var p + var q, and variances of
   independent slopes add (LEAN): alpha = sqrt(base^2 + var p + var q). The map stores its root, the roughness of glTF. */
static double rough_of(const WrMapJob *job, const Sums *sums, int i, int j)
{
    const double n = (double)job->box * job->box;
    double mean[4] = { 0 };
    for (int c = 0; c < 4; c++) {
        for (int k = j; k < j + job->box; k++)
            mean[c] += sums->at[c][(size_t)k * COLUMNS + (size_t)i];
        mean[c] /= n;
    }
    const double spread =
        fmax(mean[2] - mean[0] * mean[0], 0) + fmax(mean[3] - mean[1] * mean[1], 0);
    const double rough = sqrt(sqrt(job->base * job->base + spread));
    return rough < 1 ? rough : 1;
}

static void rough_block(Making *m, int x, int y, int columns, int rows)
{
    const WrMapJob *job = m->job;
    const int less = job->box / 2, wide = columns + 2 * less, tall = rows + 2 * less;
    WrDerivativesRow row = wr_derivatives_row_new(wide, false);
    WrDerivativesBand *band =
        wr_derivatives_open(&job->ground, m->part->x + x - less, m->part->y + y - less, wide, tall);
    double *all = wr_alloc_unset(4 * (size_t)tall * COLUMNS, sizeof *all);
    Sums sums;
    for (int c = 0; c < 4; c++) sums.at[c] = all + (size_t)c * (size_t)tall * COLUMNS;
    for (int j = 0; j < tall; j++) {
        wr_derivatives_row(band, j, &row);
        sum_row(&row, job->box, columns, &sums, j);
    }
    int64_t replaced = 0;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++) {
            const double rough = rough_of(job, &sums, i, j);
            replaced += put(&rough, 1, m->out + (size_t)(y + j) * m->part->pitch + (size_t)(x + i));
        }
    wr_free(all);
    wr_derivatives_close(band);
    wr_derivatives_row_free(&row);
    __atomic_fetch_add(&m->replaced, replaced, __ATOMIC_RELAXED);
}

static void rough_piece(int index, int worker, void *ctx)
{
    Making *m = ctx;
    const int y = index * ROWS, rows = m->part->h - y < ROWS ? m->part->h - y : ROWS;
    (void)worker;
    for (int x = 0; x < m->part->w; x += COLUMNS) {
        const int left = m->part->w - x;
        rough_block(m, x, y, left < COLUMNS ? left : COLUMNS, rows);
    }
}

static bool make_roughness(const WrMapJob *job, const WrMapPart *part, WrPool *pool, float *out,
                           int64_t *replaced, WrError *err)
{
    Making m = { .job = job, .part = part, .out = out };
    if (!wr_pool_run(pool, (part->h + ROWS - 1) / ROWS, rough_piece, &m))
        return wr_fail(err, "map: cancelled");
    *replaced += m.replaced;
    return true;
}

/* ---- the table of maps --------------------------------------------------------------------------- */

/* Support of the slopes, including their spline coefficients. Functions of_NAME return the margin in texels that a map reads
   beyond a part, -1: the whole table. A partial update after an edit enlarges the edited rectangle by it. */
static int of_slopes(const WrMapJob *job)
{
    return 1 + (wr_schemes[job->ground.scheme].taps == WR_TAPS_FITTED ? WR_PREFILTER_REACH : 0);
}

static int of_bends(const WrMapJob *job)
{
    return 1 + of_slopes(job);
}

static int of_occlusion(const WrMapJob *job)
{
    const int slopes = of_slopes(job);
    return job->reach == 0 ? -1 : job->reach + 1 > slopes ? job->reach + 1 : slopes;
}

static int of_box(const WrMapJob *job)
{
    return job->box / 2 + of_slopes(job);
}

const WrFieldMap wr_field_maps[WR_FIELD_MAP_COUNT] = {
    [WR_FIELD_MAP_OCCLUSION] = { "occlusion", make_occlusion, of_occlusion },
    [WR_FIELD_MAP_CAVITY] = { "cavity", make_cavity, blurred },
    [WR_FIELD_MAP_CURVATURE] = { "curvature", make_curvature, of_bends },
    [WR_FIELD_MAP_SLOPE] = { "slope", make_slope, of_slopes },
    [WR_FIELD_MAP_DIRECTION] = { "direction", make_direction, of_slopes },
    [WR_FIELD_MAP_ROUGHNESS] = { "roughness", make_roughness, of_box },
    [WR_FIELD_MAP_SLOPE_U] = { "slope_u", make_slope_u, of_slopes },
    [WR_FIELD_MAP_SLOPE_V] = { "slope_v", make_slope_v, of_slopes },
};

bool wr_map_make(WrFieldMapKind kind, const WrMapJob *job, const WrMapPart *part, WrPool *pool,
                 float *out, int64_t *replaced, WrError *err)
{
    int64_t count = 0;
    const bool good = wr_field_maps[kind].make(job, part, pool, out, &count, err);
    if (replaced) *replaced = count;
    return good;
}

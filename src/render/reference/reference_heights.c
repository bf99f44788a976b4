/* Inverse of the filter (1, 4, 1) / 6 as two recursions (Unser): with z = sqrt(3) - 2
     p[i] = 6 T[i] + z p[i-1]      upwards
     c[i] = z (c[i+1] - p[i])      downwards
   The influence of the start decays by a factor z = -0.268 per texel, so starting REACH texels beyond the ends,
   with the extended texels, leaves an error of 3e-37. */
#include "render/reference/reference_heights.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"
#include "scene/scene.h"

#include <float.h>
#include <math.h>

#define REACH 64
#define BLOCK 32 /* columns that are filtered side by side */

typedef struct Filter {
    WrReferenceTable *table;
    const WrField *field;
    double z;
} Filter;

/* Value number i, any i, of n values `stride` apart, extended according to the axis. */
static double texel(const double *in, size_t stride, int n, int i, bool periodic)
{
    if (periodic) return in[(size_t)((i % n + n) % n) * stride];
    if (i >= 0 && i < n) return in[(size_t)i * stride];
    const double *end = i < 0 ? in : in + (size_t)(n - 1) * stride;
    if (n < 3) return *end;
    const ptrdiff_t inward = i < 0 ? (ptrdiff_t)stride : -(ptrdiff_t)stride;
    const double x = i < 0 ? i : n - 1 - i; /* below 0: outwards from the end */
    return end[0] * ((x - 1) * (x - 2) / 2) - end[inward] * (x * (x - 2)) +
           end[2 * inward] * (x * (x - 1) / 2);
}

/* Replaces in [count + 2 REACH][lanes], from number -REACH on, by the coefficients. */
static void recurse(double *in, int count, int lanes, double z)
{
    const int total = count + 2 * REACH;
    for (int k = 0; k < lanes; k++) in[k] *= 6 / (1 - z);
    for (int i = 1; i < total; i++) {
        double *now = in + (size_t)i * (size_t)lanes;
        for (int k = 0; k < lanes; k++) now[k] = 6 * now[k] + z * now[k - lanes];
    }
    double *last = in + (size_t)(total - 1) * (size_t)lanes;
    for (int k = 0; k < lanes; k++) last[k] *= -z / (1 - z);
    for (int i = total - 2; i >= 0; i--) {
        double *now = in + (size_t)i * (size_t)lanes;
        for (int k = 0; k < lanes; k++) now[k] = z * (now[k + lanes] - now[k]);
    }
}

/* Texels of row j -> coefficients along u, in the table's row j + 2. */
static void filter_row(int j, int worker, void *ctx)
{
    (void)worker;
    const Filter *filter = ctx;
    WrReferenceTable *table = filter->table;
    const int n = table->width;
    float *texels = wr_alloc((size_t)n, sizeof *texels);
    double *row = wr_alloc((size_t)n, sizeof *row);
    double *wide = wr_alloc((size_t)n + 2 * REACH, sizeof *wide);
    wr_field_read(filter->field, 0, j, n, 1, texels, (size_t)n);
    for (int i = 0; i < n; i++) row[i] = (double)texels[i] - table->base;
    for (int i = -REACH; i < n + REACH; i++)
        wide[i + REACH] = texel(row, 1, n, i, table->periodic_u);
    recurse(wide, n, 1, filter->z);
    double *out = table->c + (size_t)(j + 2) * table->pitch;
    for (int i = 0; i < n + 4; i++) out[i] = wide[i - 2 + REACH];
    wr_free(wide);
    wr_free(row);
    wr_free(texels);
}

/* Coefficients along v for BLOCK columns. */
static void filter_columns(int block, int worker, void *ctx)
{
    (void)worker;
    const Filter *filter = ctx;
    WrReferenceTable *table = filter->table;
    const int n = table->height, first = block * BLOCK;
    const int left = (int)table->pitch - first, lanes = left < BLOCK ? left : BLOCK;
    double *wide = wr_alloc(((size_t)n + 2 * REACH) * (size_t)lanes, sizeof *wide);
    const double *in = table->c + 2 * table->pitch + first;
    for (int j = -REACH; j < n + REACH; j++)
        for (int k = 0; k < lanes; k++)
            wide[(size_t)(j + REACH) * (size_t)lanes + (size_t)k] =
                texel(in + k, table->pitch, n, j, table->periodic_v);
    recurse(wide, n, lanes, filter->z);
    for (int j = 0; j < n + 4; j++)
        for (int k = 0; k < lanes; k++)
            table->c[(size_t)j * table->pitch + (size_t)(first + k)] =
                wide[(size_t)(j - 2 + REACH) * (size_t)lanes + (size_t)k];
    wr_free(wide);
}

bool wr_reference_table_init(WrReferenceTable *table, const WrField *field, WrPool *pool,
                             WrError *err)
{
    WrReferenceTable made = { .width = wr_field_width(field),
                              .height = wr_field_height(field),
                              .periodic_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC,
                              .periodic_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC,
                              .base = wr_field_get(field, 0, 0) };
    made.pitch = (size_t)made.width + 4;
    made.c = wr_try_alloc(made.pitch * ((size_t)made.height + 4), sizeof *made.c,
                          "the reference's table", err);
    if (!made.c) return false;
    Filter filter = { &made, field, sqrt(3.0) - 2.0 };
    wr_pool_run(pool, made.height, filter_row, &filter);
    wr_pool_run(pool, (int)((made.pitch + BLOCK - 1) / BLOCK), filter_columns, &filter);
    *table = made;
    return true;
}

void wr_reference_table_fini(WrReferenceTable *table)
{
    wr_free(table->c);
    *table = (WrReferenceTable){ 0 };
}

/* Weights of four coefficients for the value at a = 0..1 past the second, and of their three differences for the
   slope. */
static void weights(double a, double w[4], double d[3])
{
    const double b = 1 - a;
    w[0] = b * b * b / 6;
    w[1] = 2.0 / 3 - a * a * (1 - a / 2);
    w[2] = 2.0 / 3 - b * b * (1 - b / 2);
    w[3] = a * a * a / 6;
    d[0] = b * b / 2;
    d[1] = 0.5 + a * b;
    d[2] = a * a / 2;
}

/* r u reduced to the table: 0..1, and whether F varies there. */
static double place(double u, double replicate, bool periodic, bool *varies)
{
    *varies = true;
    if (periodic) return wr_field_reduce(u, replicate);
    const double x = replicate * u;
    *varies = x >= 0 && x <= 1;
    return x > 0 ? x < 1 ? x : 1 : 0;
}

static double bounded(double x)
{
    return x > DBL_MAX ? DBL_MAX : x < -DBL_MAX ? -DBL_MAX : x;
}

void wr_reference_table_at(const WrReferenceTable *table, const WrScene *scene, double u, double v,
                           double *f, double *fu, double *fv)
{
    *f = *fu = *fv = 0;
    if (!table->c) return;
    const double ru = scene->replicate_u, rv = scene->replicate_v;
    bool varies_u, varies_v;
    const double tu = place(u, ru, table->periodic_u, &varies_u);
    const double tv = place(v, rv, table->periodic_v, &varies_v);
    const double x = table->width * tu - 0.5, y = table->height * (1 - tv) - 0.5;
    const double i = floor(x), j = floor(y);
    double wx[4], dx[3], wy[4], dy[3], across[4], slope[4];
    weights(x - i, wx, dx);
    weights(y - j, wy, dy);
    const double *c = table->c + (size_t)((int)j + 1) * table->pitch + (size_t)((int)i + 1);
    for (int r = 0; r < 4; r++, c += table->pitch) {
        across[r] = wx[0] * c[0] + wx[1] * c[1] + wx[2] * c[2] + wx[3] * c[3];
        slope[r] = dx[0] * (c[1] - c[0]) + dx[1] * (c[2] - c[1]) + dx[2] * (c[3] - c[2]);
    }
    const double value =
        wy[0] * across[0] + wy[1] * across[1] + wy[2] * across[2] + wy[3] * across[3];
    const double right = wy[0] * slope[0] + wy[1] * slope[1] + wy[2] * slope[2] + wy[3] * slope[3];
    const double down = dy[0] * (across[1] - across[0]) + dy[1] * (across[2] - across[1]) +
                        dy[2] * (across[3] - across[2]);
    const double h = scene->height;
    *f = bounded(h * (table->base + value));
    if (varies_u) *fu = bounded(bounded(h * (right * table->width)) * ru);
    if (varies_v) *fv = bounded(bounded(h * (0.0 - down * table->height)) * rv);
}

#include "field/occlusion.h"

#include "base/cpu.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/horizon.h"
#include "field/occlusion_lines.h"

#include <math.h>

#define ROWS 64 /* rows of the table that a thread processes at once */

static const WrCpuBuilds builds = { &wr_sky_kernels_v1, &wr_sky_kernels_v3, &wr_sky_kernels_v4 };

const WrSkyKernels *wr_sky_kernels_at(int index)
{
    return wr_cpu_build(&builds, index);
}

const WrSkyKernels *wr_sky_kernels(void)
{
    return wr_cpu_best(&builds);
}

/* ---- directions ---------------------------------------------------------------------------------- */

/* In scene units, y up. */
static void vector_of(const WrOcclusion *o, int k, double *x, double *y)
{
    double i, j;
    wr_horizon_direction((k + o->directions) % o->directions, o->directions, &i, &j);
    *x = i * o->texel_w;
    *y = j * o->texel_h; /* anticlockwise: rows count downwards like the table's directions, so the
                            direction is -j */
}

static double turns_of(const WrOcclusion *o, int k)
{
    double x, y;
    vector_of(o, k, &x, &y);
    const double turns = wr_atan2(y, x) / (2 * WR_PI);
    return turns < 0 ? turns + 1 : turns;
}

double wr_occlusion_degrees(const WrOcclusion *occlusion, int k)
{
    return 360 * turns_of(occlusion, k);
}

static double between(double from, double to)
{
    return to < from ? to + 1 - from : to - from;
}

WrSkyCourse wr_sky_course(const WrOcclusion *occlusion, int pair)
{
    const WrOcclusion *o = occlusion;
    const int half = o->directions / 2, fine = o->directions < 8 ? 1 : o->directions / 8;
    double i, j, x, y;
    wr_horizon_direction(pair, o->directions, &i, &j);
    j = -j;
    WrSkyCourse c = { .upright = fabs(j) >= fabs(i) }; /* rows of texels are contiguous */
    const bool back = (c.upright ? j : i) < 0;
    c.k = back ? pair + half : pair;
    if (back) i = -i, j = -j;
    c.q = fine;
    c.p = (int)lrint(fine * (c.upright ? i : j));
    while (c.q > 1 && c.p % 2 == 0) c.q /= 2, c.p /= 2;
    vector_of(o, c.k, &x, &y);
    c.step = sqrt(x * x + y * y);
    const double before = turns_of(o, c.k - 1), after = turns_of(o, c.k + 1);
    c.share = (WrSkyShare){ .ux = (float)(x / c.step),
                            .uy = (float)(y / c.step),
                            .weight = (float)(between(before, after) / 2),
                            .first = pair == 0,
                            .last = pair == half - 1 };
    return c;
}

/* ---- a table ------------------------------------------------------------------------------------- */

typedef struct Rows {
    WrSky *sky;
    double scale; /* steps for F = 1 */
} Rows;

static void fill_rows(int index, int worker, void *ctx)
{
    const Rows *rows = ctx;
    const WrSky *sky = rows->sky;
    const int w = sky->part->w, end = (index + 1) * ROWS;
    float *row = wr_alloc_unset((size_t)w, sizeof *row);
    (void)worker;
    for (int j = index * ROWS; j < end && j < sky->part->h; j++) {
        int32_t *out = sky->steps + (size_t)j * sky->pitch;
        wr_field_read(sky->occlusion->field, 0, j, w, 1, row, (size_t)w);
        for (int i = 0; i < w; i++) out[i] = (int32_t)lrint(rows->scale * (double)row[i]);
    }
    wr_free(row);
}

static int pieces_of(const WrSky *sky)
{
    return (sky->part->h + ROWS - 1) / ROWS;
}

static bool fill_steps(WrSky *sky, WrPool *pool, WrError *err)
{
    const WrOcclusion *o = sky->occlusion;
    const int w = sky->part->w, h = sky->part->h;
    float low, high;
    wr_field_range(o->field, &low, &high);
    int exponent;
    frexp(fmax(fabs((double)low), fabs((double)high)), &exponent);
    Rows rows = { sky, ldexp(o->height < 0 ? -1 : 1, WR_SKY_BITS - exponent) };
    sky->unit = fabs(o->height) * ldexp(1, exponent - WR_SKY_BITS);
    sky->range = fabs(o->height) * ((double)high - (double)low);
    /* not a power of two, to avoid cache conflicts */
    sky->pitch = (size_t)w + 16 + (size_t)(w % 2 == 0);
    sky->steps = wr_try_alloc(sky->pitch * (size_t)h, sizeof(int32_t), "occlusion", err);
    if (sky->steps) wr_pool_run(pool, pieces_of(sky), fill_rows, &rows);
    return sky->steps != NULL;
}

static bool run_table(WrSky *sky, WrPool *pool, WrError *err)
{
    const int pairs = sky->occlusion->directions / 2;
    for (int pair = 0; pair < pairs; pair++)
        if (!wr_sky_run_pair(sky, pair, pool) || !wr_progress_report((pair + 1.0) / pairs))
            return wr_fail(err, "occlusion: cancelled");
    return true;
}

static bool make(const WrOcclusion *occlusion, const WrMapPart *part, int k, const float *p,
                 const float *q, WrPool *pool, float *out, WrError *err)
{
    if (occlusion->reach > 0) return wr_sky_near(occlusion, part, k, p, q, pool, out, err);
    WrSky sky = { occlusion, part, NULL, 0, 0, 0, k, p, q, out, wr_sky_kernels() };
    const bool good = fill_steps(&sky, pool, err) && run_table(&sky, pool, err);
    wr_free(sky.steps);
    return good;
}

bool wr_occlusion_make(const WrOcclusion *occlusion, const WrMapPart *part, const float *p,
                       const float *q, WrPool *pool, float *out, WrError *err)
{
    return make(occlusion, part, -1, p, q, pool, out, err);
}

bool wr_occlusion_horizon(const WrOcclusion *occlusion, const WrMapPart *part, int k, WrPool *pool,
                          float *out, WrError *err)
{
    return make(occlusion, part, k, NULL, NULL, pool, out, err);
}

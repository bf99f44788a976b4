#include "export/mip_files.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "export/normal_kern.h"

#include <stddef.h>

#define CHANNELS WR_LEVEL_CHANNELS
#define STRIPE 8 /* rows of a level computed at a time */

/* Coverage of texel i of m over n = 2m or 2m + 1, or n = m = 1: taps from 2i on, with their weights. */
typedef struct Cover {
    int tap[3];
    double part[3];
} Cover;

static Cover cover_of(int n, int m, int i)
{
    if (n == 1) return (Cover){ { 0, 0, 0 }, { 1, 0, 0 } };
    const int first = 2 * i, last = n % 2 ? first + 2 : first + 1;
    const double odd = n % 2 ? 1.0 / m : 0.0, whole = (double)m / n;
    return (Cover){ { first, first + 1, last },
                    { (1 - odd * i) * whole, whole, odd * (i + 1) * whole } };
}

/* ---- one stripe ---- */

typedef struct Making {
    WrLevels *levels;
    int at; /* the level being computed */
    WrLevelRows rows;
    void *ctx;
    Cover *columns; /* [width of that level] */
} Making;

/* The rows covered by rows [y, end) of the level; *first: the first of them. Level 0 is computed into `scratch`. */
static const float *covered(const Making *m, int y, int end, int *first, float *scratch)
{
    const WrLevel *from = &m->levels->level[m->at - 1], *to = from + 1;
    const Cover top = cover_of(from->height, to->height, y);
    const Cover bottom = cover_of(from->height, to->height, end - 1);
    *first = top.tap[0];
    if (from->data) return from->data + (size_t)*first * (size_t)from->width * (size_t)CHANNELS;
    m->rows(m->ctx, *first, bottom.tap[2] + 1 - *first, scratch);
    return scratch;
}

static void sum_rows(const float *const row[3], const double part[3], size_t count,
                     double *restrict sum)
{
    const float *restrict a = row[0], *restrict b = row[1], *restrict c = row[2];
    const double x = part[0], y = part[1], z = part[2];
    if (z == 0.0)
#pragma omp simd
        for (size_t k = 0; k < count; k++) sum[k] = x * (double)a[k] + y * (double)b[k];
    else
#pragma omp simd
        for (size_t k = 0; k < count; k++)
            sum[k] = x * (double)a[k] + y * (double)b[k] + z * (double)c[k];
}

static void sum_columns(const Cover *columns, int width, const double *restrict sum,
                        float *restrict out)
{
    for (int i = 0; i < width; i++) {
        const Cover *cover = &columns[i];
        const double *a = sum + (ptrdiff_t)cover->tap[0] * CHANNELS;
        const double *b = sum + (ptrdiff_t)cover->tap[1] * CHANNELS;
        const double *c = sum + (ptrdiff_t)cover->tap[2] * CHANNELS;
#pragma omp simd
        for (int k = 0; k < CHANNELS; k++)
            out[k] = (float)(cover->part[0] * a[k] + cover->part[1] * b[k] + cover->part[2] * c[k]);
        out += CHANNELS;
    }
}

static void make_stripe(int index, int worker, void *ctx)
{
    (void)worker;
    const Making *m = ctx;
    const WrLevel *from = &m->levels->level[m->at - 1], *to = from + 1;
    const int y = index * STRIPE;
    const int end = y + STRIPE < to->height ? y + STRIPE : to->height;
    const size_t row = (size_t)from->width * (size_t)CHANNELS;
    const size_t out_row = (size_t)to->width * (size_t)CHANNELS;
    const WrNormalKernels *kernels = wr_normal_kernels();
    const bool even = from->width % 2 == 0 && from->height % 2 == 0;
    double *sum = even ? NULL : wr_alloc_unset(row, sizeof *sum);
    float *scratch = from->data ? NULL : wr_alloc_unset(row * (2 * STRIPE + 1), sizeof *scratch);
    int first;
    const float *in = covered(m, y, end, &first, scratch);
    for (int j = y; j < end; j++) {
        const Cover cover = cover_of(from->height, to->height, j);
        const float *rows[3];
        for (int k = 0; k < 3; k++) rows[k] = in + (size_t)(cover.tap[k] - first) * row;
        float *out = to->data + (size_t)j * out_row;
        if (even) {
            kernels->halve(rows[0], rows[1], to->width, out);
            continue;
        }
        sum_rows(rows, cover.part, row, sum);
        sum_columns(m->columns, to->width, sum, out);
    }
    wr_free(scratch);
    wr_free(sum);
}

/* ---- all levels ---- */

static int half(int n)
{
    return n > 1 ? n / 2 : 1;
}

static bool make_level(Making *m, WrPool *pool, WrError *err)
{
    const WrLevel *from = &m->levels->level[m->at - 1], *to = from + 1;
    m->columns = wr_alloc((size_t)to->width, sizeof *m->columns);
    for (int i = 0; i < to->width; i++) m->columns[i] = cover_of(from->width, to->width, i);
    const bool good = wr_pool_run(pool, (to->height + STRIPE - 1) / STRIPE, make_stripe, m);
    wr_free(m->columns);
    return good || wr_fail(err, "cancelled");
}

bool wr_levels_make(WrLevels *levels, int width, int height, WrLevelRows rows, void *ctx,
                    WrPool *pool, WrError *err)
{
    levels->count = 1;
    levels->level[0].width = width, levels->level[0].height = height;
    bool good = true;
    while (good && (width > 1 || height > 1)) {
        width = half(width), height = half(height);
        WrLevel *level = &levels->level[levels->count];
        *level = (WrLevel){ width, height, NULL };
        level->data = wr_try_alloc((size_t)width * (size_t)height * (size_t)CHANNELS,
                                   sizeof *level->data, "levels of a picture", err);
        Making m = { levels, levels->count, rows, ctx, NULL };
        good = level->data && make_level(&m, pool, err);
        levels->count++;
    }
    if (!good) wr_levels_free(levels);
    return good;
}

void wr_levels_free(WrLevels *levels)
{
    for (int k = 0; k < levels->count; k++) wr_free(levels->level[k].data);
    *levels = (WrLevels){ 0 };
}

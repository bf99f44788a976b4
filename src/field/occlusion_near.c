/* Horizons within a reach: every line is searched texel by texel. */
#include "field/occlusion_lattice.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"

#include <string.h>

#define ROWS 16 /* rows of the map in one piece of work */

typedef struct Near {
    const WrOcclusion *occlusion;
    const WrMapPart *part;
    int k; /* < 0: occlusion */
    const float *p, *q;
    float *out;
    const WrSkyKernels *kernels;
} Near;

/* A piece's heights with a margin of the search distance on all sides. */
typedef struct Ground {
    float *heights;
    size_t pitch;
    int reach;
} Ground;

static Ground open_ground(const Near *near, int y, int rows)
{
    const WrOcclusion *o = near->occlusion;
    /* one more texel for samples between two */
    const int reach = o->reach + 1, wide = near->part->w + 2 * reach;
    Ground g = { NULL, (size_t)wide, reach };
    g.heights = wr_alloc_unset((size_t)wide * (size_t)(rows + 2 * reach), sizeof(float));
    for (int j = 0; j < rows + 2 * reach; j++) {
        float *row = g.heights + (size_t)j * g.pitch;
        wr_derivatives_read_held(o->field, near->part->x - reach, near->part->y + y + j - reach,
                                 wide, row);
        for (int i = 0; i < wide; i++) row[i] *= (float)o->height;
    }
    return g;
}

static int floor_div(int a, int b)
{
    return a / b - (a % b < 0);
}

/* The horizon along a direction (sign 1) or against it, for `count` texels whose first is at c. */
static void look_along(const Near *near, const Ground *g, const WrSkyCourse *course, int sign,
                       const float *c, int count, float *best)
{
    const ptrdiff_t own = course->upright ? (ptrdiff_t)g->pitch : 1;
    const ptrdiff_t other = course->upright ? 1 : (ptrdiff_t)g->pitch;
    memset(best, 0, (size_t)count * sizeof *best);
    for (int t = 1; t <= near->occlusion->reach; t++) {
        const int moved = sign * course->p * t, whole = floor_div(moved, course->q);
        const float part = (float)(moved - whole * course->q) / (float)course->q;
        const float *a = c + sign * t * own + whole * other;
        near->kernels->look(c, a, a + other, part, (float)(1 / (t * course->step)), count, best);
    }
}

static void strip(const Near *near, const Ground *g, int x, int y, int from, int count)
{
    const size_t at = (size_t)y * near->part->pitch + (size_t)x;
    const float *c = g->heights + (size_t)(y - from + g->reach) * g->pitch + (size_t)(x + g->reach);
    float ahead[WR_SKY_STRIP], behind[WR_SKY_STRIP];
    for (int pair = 0; pair < near->occlusion->directions / 2; pair++) {
        const WrSkyCourse course = wr_sky_course(near->occlusion, pair);
        const int opposite =
            (course.k + near->occlusion->directions / 2) % near->occlusion->directions;
        if (near->k >= 0 && near->k != course.k && near->k != opposite) continue;
        if (near->k != opposite) look_along(near, g, &course, 1, c, count, ahead);
        if (near->k != course.k) look_along(near, g, &course, -1, c, count, behind);
        const WrSkyRun run = { ahead,
                               behind,
                               near->k < 0 ? near->p + at : NULL,
                               near->k < 0 ? near->q + at : NULL,
                               near->out + at,
                               count };
        if (near->k < 0) near->kernels->share(&course.share, &run, 1);
        else
            memcpy(near->out + at, near->k == course.k ? ahead : behind,
                   (size_t)count * sizeof(float));
    }
}

static void piece(int index, int worker, void *ctx)
{
    const Near *near = ctx;
    const int y = index * ROWS, left = near->part->h - y, rows = left < ROWS ? left : ROWS;
    Ground g = open_ground(near, y, rows);
    (void)worker;
    for (int j = y; j < y + rows; j++) {
        for (int x = 0; x < near->part->w; x += WR_SKY_STRIP) {
            const int more = near->part->w - x;
            strip(near, &g, x, j, y, more < WR_SKY_STRIP ? more : WR_SKY_STRIP);
        }
    }
    wr_free(g.heights);
}

bool wr_sky_near(const WrOcclusion *occlusion, const WrMapPart *part, int k, const float *p,
                 const float *q, WrPool *pool, float *out, WrError *err)
{
    Near near = { occlusion, part, k, p, q, out, wr_sky_kernels() };
    if (wr_pool_run_with_progress(pool, (part->h + ROWS - 1) / ROWS, piece, &near)) return true;
    return wr_fail(err, "occlusion: cancelled");
}

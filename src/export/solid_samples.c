/* Samples for measuring a solid: all texels' centres, and points between those of a coarse table. */
#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "export/solid.h"
#include "field/field.h"
#include "scene/scene.h"
#include "system/thread.h"

#include <math.h>

#define FINEST 2000 /* minimum samples along each direction for the smallest error */
#define COARSEST 64 /* minimum for the largest error */
#define CLOSE                                                                                      \
    16.0 /* times sqrt(size / error): the sagitta between two samples on a sphere is 1/100 of the error */

/* Samples along one direction of a face, from `from` to `to`. A texel's centre is at k + 1/2 texels from 0, and
   is a sample if each texel has an odd number of them. */
static bool lay_direction(double texels, double fine, double from, double to, double *first,
                          double *step, int *count)
{
    const double there = fmax(texels * (to - from), 1.0);
    double each = ceil(fine / there);
    each += fmod(each, 2.0) == 0.0;
    *step = 1.0 / (fmax(texels, 1.0) * each);
    *first = ceil(from / *step - 0.5);
    const double last = floor(to / *step - 0.5);
    *count = (int)fmin(last - *first + 1.0, 1e9);
    return last - *first < 1e9;
}

static bool lay_lattice(WrSolid *solid, int face, int64_t *samples, WrError *err)
{
    const WrScene *scene = solid->scene;
    const WrSurfaceCell cell = wr_surface_cell(&scene->shape, face);
    WrSolidLattice *l = &solid->lattice[face];
    const double fine = fmin(fmax(CLOSE * sqrt(solid->size / solid->error), COARSEST), FINEST);
    const bool fits = lay_direction(wr_field_width(solid->field) * fabs(scene->replicate_u), fine,
                                    cell.u0, cell.u1, &l->first_u, &l->step_u, &l->count_u) &
                      lay_direction(wr_field_height(solid->field) * fabs(scene->replicate_v), fine,
                                    cell.v0, cell.v1, &l->first_v, &l->step_v, &l->count_v);
    *samples += (int64_t)l->count_u * l->count_v;
    if (fits && *samples <= WR_SOLID_SAMPLES) return true;
    return wr_fail(
        err,
        "the surface wears more than %lld texels: fewer repeats (replicate), or a smaller table",
        (long long)WR_SOLID_SAMPLES);
}

/* ---- positions ---- */

typedef struct Work {
    WrSolid *solid;
    int face;
    WrMutex lock;
    bool bad; /* exceeds single precision */
} Work;

static void note(Work *work, double low, double high, bool bad)
{
    wr_mutex_lock(&work->lock);
    work->solid->low = fmin(work->solid->low, low);
    work->solid->high = fmax(work->solid->high, high);
    work->bad |= bad;
    wr_mutex_unlock(&work->lock);
}

static void put(const WrSolid *s, const WrSurfacePoint *o, double f, float out[3])
{
    const WrVec3 p = v3_mad(o->p, o->n_unit, f);
    out[0] = (float)((s->stretch.x * p.x - s->middle.x) * s->scale);
    out[1] = (float)((s->stretch.y * p.y - s->middle.y) * s->scale);
    out[2] = (float)((s->stretch.z * p.z - s->middle.z) * s->scale);
}

static void sample_row(int j, int worker, void *ctx)
{
    (void)worker;
    Work *work = ctx;
    const WrSolid *s = work->solid;
    const WrSolidLattice *l = &s->lattice[work->face];
    double low = INFINITY, high = -INFINITY, u[WR_HEIGHTS_RUN], v[WR_HEIGHTS_RUN],
           f[WR_HEIGHTS_RUN];
    bool bad = false;
    for (int from = 0; from < l->count_u; from += WR_HEIGHTS_RUN) {
        const int count = l->count_u - from < WR_HEIGHTS_RUN ? l->count_u - from : WR_HEIGHTS_RUN;
        for (int i = 0; i < count; i++) {
            u[i] = (l->first_u + from + i + 0.5) * l->step_u;
            v[i] = (l->first_v + j + 0.5) * l->step_v;
        }
        wr_scene_heights(s->scene, s->field, count, u, v, f);
        for (int i = 0; i < count; i++) {
            float *at = l->at[(size_t)j * (size_t)l->count_u + (size_t)(from + i)];
            WrSurfacePoint o;
            wr_surface_at(&s->scene->shape, work->face, u[i], v[i], &o);
            put(s, &o, f[i], at);
            low = fmin(low, f[i]);
            high = fmax(high, f[i]);
            bad |= !(fabsf(at[0]) < 1e18f && fabsf(at[1]) < 1e18f && fabsf(at[2]) < 1e18f);
        }
    }
    note(work, low, high, bad);
}

bool wr_solid_measure(WrSolid *solid, WrError *err)
{
    int64_t samples = 0;
    bool good = true;
    for (int face = 0; face < solid->faces && good; face++)
        good = lay_lattice(solid, face, &samples, err);
    Work work = { .solid = solid };
    wr_mutex_init(&work.lock);
    for (int face = 0; face < solid->faces && good; face++) {
        WrSolidLattice *l = &solid->lattice[face];
        WrProgressPart part;
        const WrProgress *whole =
            wr_progress_enter(&part, (double)face / solid->faces, (face + 1.0) / solid->faces);
        work.face = face;
        l->at = wr_try_alloc((size_t)l->count_u * (size_t)l->count_v, sizeof *l->at,
                             "a solid's samples", err);
        good = l->at && (wr_pool_run_with_progress(solid->pool, l->count_v, sample_row, &work) ||
                         wr_fail(err, "cancelled"));
        wr_progress_set(whole);
    }
    wr_mutex_fini(&work.lock);
    if (good && work.bad)
        good =
            wr_fail(err, "the relief is too high for a solid of that size: a smaller bump height");
    return good;
}

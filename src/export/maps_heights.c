/* Maps of heights themselves, and of worn edges. */
#include "export/job.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/maps.h"
#include "noise/noise.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

static bool take_heights(WrExportJob *job, WrError *err)
{
    const size_t texels = (size_t)job->width * (size_t)job->height;
    job->map = wr_try_alloc(texels, sizeof(float), "map", err);
    if (!job->map) return false;
    job->report.replaced += wr_export_heights(job, 0, job->height, job->map);
    wr_export_map_range(job, "heights");
    return true;
}

typedef double OfHeight(const WrExportJob *job, double f);

static void change(WrExportJob *job, OfHeight *of)
{
    const size_t texels = (size_t)job->width * (size_t)job->height;
    for (size_t i = 0; i < texels; i++) {
        const float x = (float)of(job, (double)job->map[i]);
        job->map[i] = isfinite(x) ? x : 0.0f;
        job->report.replaced += !isfinite(x);
    }
}

/* ---- displacement -------------------------------------------------------------------------------- */

static double lifted(const WrExportJob *job, double f)
{
    return job->options.scale * (f - job->options.ground_at);
}

bool wr_export_displacement_make(WrExportJob *job, WrError *err)
{
    WrExportOptions *o = &job->options;
    if (!take_heights(job, err)) return false;
    if (o->ground == WR_EXPORT_GROUND_ZERO) o->ground_at = 0;
    if (o->ground == WR_EXPORT_GROUND_LOWEST) o->ground_at = job->report.low;
    if (isnan(o->scale)) o->scale = job->scene->height;
    change(job, lifted);
    wr_export_map_range(job, "displacements");
    if (o->range == WR_EXPORT_RANGE_GIVEN) wr_export_codes(job, o->low, o->high);
    else if (o->range == WR_EXPORT_RANGE_SIGNED)
        wr_export_signed_codes(job, fmax(fabs(job->report.low), fabs(job->report.high)));
    else wr_export_codes(job, job->report.low, job->report.high);
    wr_text_add_number(wr_export_attribute(job, "wrinkle:ground"), o->ground_at);
    wr_text_add_number(wr_export_attribute(job, "wrinkle:scale"), o->scale);
    return true;
}

/* ---- mask ---------------------------------------------------------------------------------------- */

/* 1 if x >= 0, falling to 0 at -feather. */
static double edge(double x, double feather)
{
    if (x >= 0) return 1;
    return feather > 0 && x > -feather ? 1 + x / feather : 0;
}

static double masked(const WrExportJob *job, double f)
{
    const WrExportOptions *o = &job->options;
    const double above = edge(f - o->mask_low, o->feather);
    return isnan(o->mask_high) ? above : above * edge(o->mask_high - f, o->feather);
}

bool wr_export_mask_make(WrExportJob *job, WrError *err)
{
    WrExportOptions *o = &job->options;
    if (!take_heights(job, err)) return false;
    if (isnan(o->mask_low)) o->mask_low = 0.5 * (job->report.low + job->report.high);
    if (o->mask_high < o->mask_low)
        return wr_fail(err, "mask: high %g must not be below low %g", o->mask_high, o->mask_low);
    change(job, masked);
    wr_export_map_range(job, "mask");
    wr_export_codes(job, 0, 1);
    return true;
}

/* ---- wear ---------------------------------------------------------------------------------------- */

/* The number of that rank, in any order: the array is partitioned until it is isolated. */
static float ranked(float *x, size_t count, size_t rank)
{
    size_t low = 0, high = count - 1;
    while (low < high) {
        const float pivot = x[low + (high - low) / 2];
        size_t i = low, j = high;
        for (;;) {
            while (x[i] < pivot) i++;
            while (x[j] > pivot) j--;
            if (i >= j) break;
            const float other = x[i];
            x[i++] = x[j], x[j--] = other;
        }
        if (rank <= j) high = j;
        else low = j + 1;
    }
    return x[rank];
}

/* The value that one texel in fifty exceeds. */
static bool usual_full(const WrExportJob *job, double *full, WrError *err)
{
    const size_t texels = (size_t)job->width * (size_t)job->height;
    float *copy = wr_try_alloc(texels, sizeof *copy, "wear", err);
    if (!copy) return false;
    memcpy(copy, job->map, texels * sizeof *copy);
    *full = (double)ranked(copy, texels, texels - 1 - texels / 50);
    wr_free(copy);
    return true;
}

typedef struct Wear {
    WrNoise noise;
    double full;
} Wear;

static void wear_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const Wear *wear = ctx;
    const WrExportOptions *o = &job->options;
    for (int j = y; j < y + rows; j++)
        for (int i = 0; i < job->width; i++) {
            float *at = job->map + (size_t)j * (size_t)job->width + (size_t)i;
            const double t[2] = { o->grain * job->u[i], o->grain * wr_export_row_v(job, j) };
            double c = fmin((double)*at / wear->full, 1);
            if (o->noise > 0) c *= 1 + o->noise * wr_noise_at(&wear->noise, t, NULL);
            c = (c - o->threshold) / (1 - o->threshold);
            *at = (float)(c < 0 ? 0 : c < 1 ? c : 1);
        }
}

bool wr_export_wear_make(WrExportJob *job, WrError *err)
{
    WrExportOptions *o = &job->options;
    o->part = WR_EXPORT_CONVEX;
    if (!wr_export_curvature_make(job, err)) return false;
    double most = o->full;
    if (!(most > 0) && !usual_full(job, &most, err)) return false;
    Wear wear = { { .kind = WR_NOISE_PERLIN,
                    .fade = WR_FADE_QUINTIC,
                    .dim = 2,
                    .lattice = { .source = WR_LATTICE_HASH,
                                 .seed = 1,
                                 .period = { o->grain, o->grain, 0 } } },
                  most > 0 ? most : 1 };
    if (!wr_noise_check(&wear.noise, err)) return false;
    wr_export_run(job, 0, job->height, wear_piece, &wear);
    wr_export_map_range(job, "wear");
    wr_export_codes(job, 0, 1);
    return true;
}

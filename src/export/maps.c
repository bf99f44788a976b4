/* Maps that are computed from the whole table before the first row is written. */
#include "base/error.h"
#include "base/memory.h"
#include "export/job.h"
#include "export/normal_kern.h"
#include "field/field.h"
#include "field/maps.h"
#include "field/occlusion.h"
#include "noise/noise.h"
#include "scene/scene.h"
#include "shade/reflection.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Codes of a map with 0 in the middle, from -full to full. */
static void export_signed_codes(WrExportJob *job, double full);

/* ---- Maps of heights themselves, and of worn edges ---- */

static bool take_heights(WrExportJob *job, WrError *err)
{
    const size_t texels = (size_t)job->width * (size_t)job->height;
    job->map = wr_try_alloc(texels, sizeof(float), "map", err);
    if (!job->map) return false;
    job->report.replaced += wr_export_heights(job, 0, job->height, job->map);
    wr_export_report_range(job, "heights");
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
    wr_export_report_range(job, "displacements");
    if (o->range == WR_EXPORT_RANGE_GIVEN) wr_export_codes(job, o->low, o->high);
    else if (o->range == WR_EXPORT_RANGE_SIGNED)
        export_signed_codes(job, fmax(fabs(job->report.low), fabs(job->report.high)));
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
    wr_export_report_range(job, "mask");
    wr_export_codes(job, 0, 1);
    return true;
}

/* ---- wear ---------------------------------------------------------------------------------------- */

/* The number of that rank, in any order: the array is partitioned until it is isolated. Hoare's quickselect: linear on
   average, in place, no full sort of a table. */
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

/* Wear at a texel with convexity c (relative to full), noise n in -1..1, threshold t:
     w = clamp((min(c, 1) (1 + noise n) - t) / (1 - t), 0, 1).
   The noise has `grain` lattice cells across the cell on both axes and the same period, so the map tiles. */
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
    wr_export_report_range(job, "wear");
    wr_export_codes(job, 0, 1);
    return true;
}

/* ---- shared functions --------------------------------------------------------------------------- */

WrDerivatives wr_export_ground(const WrExportJob *job, const WrField *field)
{
    return (WrDerivatives){ .field = field ? field : job->field,
                            .formula = job->analytic ? &job->scene->analytic : NULL,
                            .scheme = (WrScheme)job->options.scheme,
                            .height = job->scene->height,
                            .cell_w = job->options.cell_w,
                            .cell_h = job->options.cell_h };
}

static bool hold_map(WrExportJob *job, WrError *err)
{
    const size_t texels = (size_t)job->width * (size_t)job->height;
    job->map = wr_try_alloc(texels * (size_t)job->channels, sizeof(float), "map", err);
    return job->map != NULL;
}

static WrMapPart whole(const WrExportJob *job)
{
    return (WrMapPart){ 0, 0, job->width, job->height, (size_t)job->width };
}

/* A formula's heights as a table; the caller frees it. */
static WrField *sampled(WrExportJob *job, WrError *err)
{
    WrField *field = wr_field_new(job->width, job->height, wr_field_wrap_u(job->field),
                                  wr_field_wrap_v(job->field), 0.0f, err);
    float *row = wr_alloc((size_t)job->width, sizeof *row);
    for (int y = 0; y < job->height && field; y++) {
        job->report.replaced += wr_export_heights(job, y, 1, row);
        wr_field_write(field, 0, y, job->width, 1, row, (size_t)job->width);
    }
    wr_free(row);
    return field;
}

static void find_extent(WrExportJob *job, int y, int rows, void *ctx)
{
    WrExtent *extent = ctx;
    const size_t row = (size_t)job->width * (size_t)job->channels;
    const float *at = job->map + (size_t)y * row;
    float low = at[0], high = at[0];
    for (size_t i = 0; i < row * (size_t)rows; i++) {
        low = at[i] < low ? at[i] : low;
        high = at[i] > high ? at[i] : high;
    }
    wr_export_extent_add(extent, (double)low, (double)high);
}

void wr_export_report_range(WrExportJob *job, const char *quantity)
{
    WrExtent extent;
    wr_export_extent_init(&extent);
    wr_export_run(job, 0, job->height, find_extent, &extent);
    wr_export_extent_finish(&extent, &job->report);
    job->report.quantity = quantity;
}

void wr_export_codes(WrExportJob *job, double low, double high)
{
    WrExportReport *report = &job->report;
    if (job->options.depth == 32) return;
    report->ranged = true;
    report->code_low = low;
    report->code_high = high > low ? high : low + 1;
}

static void export_signed_codes(WrExportJob *job, double full)
{
    WrExportReport *report = &job->report;
    if (job->options.depth == 32) return;
    const double last = wr_export_last_code(job);
    report->ranged = true;
    report->amplitude = full;
    /* 0 has a code of its own, 128 or 32768, so that flat is exact; full is last - zero = zero - 1 codes away on both sides,
       and code 0 is unused. */
    report->zero_code = (int)(last + 1) / 2;
    const double step = full / (report->zero_code - 1);
    report->code_low = -step * report->zero_code;
    report->code_high = step * (last - report->zero_code);
}

/* Converts a number to a code relative to the code of 0, or to the first code. */
static double code_of(const WrExportJob *job, double x)
{
    const WrExportReport *report = &job->report;
    if (report->zero_code >= 0)
        return report->amplitude > 0 ? (report->zero_code - 1) * x / report->amplitude : 0;
    return wr_export_last_code(job) * (x - report->code_low) /
           (report->code_high - report->code_low);
}

typedef struct Strip {
    int y;
    void *out;
} Strip;

static bool beyond(const WrExportReport *report, double x)
{
    if (report->zero_code >= 0) return fabs(x) > report->amplitude;
    return x < report->code_low || x > report->code_high;
}

/* Parameters of code_of, for arrays of numbers. code = zero + times (x - less) / by, rounded, within 0..last; x outside
   low..high counts as clipped. Both forms of code_of in one, so that the kernel has no branch. A flat map has times = 0: all
   codes are `zero`. */
static WrMapCodes codes_of(const WrExportJob *job)
{
    const WrExportReport *r = &job->report;
    const double last = wr_export_last_code(job);
    if (r->zero_code < 0)
        return (WrMapCodes){ last,        r->code_low, r->code_high - r->code_low, 0, last,
                             r->code_low, r->code_high };
    const bool flat = !(r->amplitude > 0);
    return (WrMapCodes){ flat ? 0 : r->zero_code - 1,
                         0,
                         flat ? 1 : r->amplitude,
                         r->zero_code,
                         last,
                         -r->amplitude,
                         r->amplitude };
}

/* Codes of one row, without dither. Returns the number of clipped values. */
static int64_t plain_codes(const WrExportJob *job, const WrMapCodes *codes, const float *from,
                           size_t count, void *out, size_t first)
{
    enum { RUN = 512 };
    int32_t code[RUN];
    int64_t clipped = 0;
    for (size_t k = 0; k < count; k += RUN) {
        const int now = count - k < RUN ? (int)(count - k) : RUN;
        clipped += wr_normal_kernels()->codes_of(codes, from + k, now, code);
        if (job->options.depth == 8)
            for (int i = 0; i < now; i++)
                ((uint8_t *)out)[first + k + (size_t)i] = (uint8_t)code[i];
        else
            for (int i = 0; i < now; i++)
                ((uint16_t *)out)[first + k + (size_t)i] = (uint16_t)code[i];
    }
    return clipped;
}

/* Codes of row y, with dither, from numbers at `from` to the codes from `first` on. Returns the number of
   clipped values. */
static int64_t dithered_codes(const WrExportJob *job, int y, const float *from, size_t count,
                              void *out, size_t first)
{
    const int zero = job->report.zero_code < 0 ? 0 : job->report.zero_code;
    int64_t clipped = 0;
    for (size_t i = 0; i < count; i++) {
        const int column = (int)i / job->channels, channel = (int)i % job->channels;
        const double x = (double)from[i];
        clipped += beyond(&job->report, x);
        wr_export_store_code(job, out, first + i, code_of(job, x), zero,
                             (WrExportTexel){ column, y, channel });
    }
    return clipped;
}

static void map_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const Strip *strip = ctx;
    const size_t row = (size_t)job->width * (size_t)job->channels;
    const WrMapCodes codes = codes_of(job);
    int64_t clipped = 0;
    for (int j = y; j < y + rows; j++) {
        const float *from = job->map + (size_t)j * row;
        const size_t first = (size_t)(j - strip->y) * row;
        if (job->options.depth == 32) memcpy((float *)strip->out + first, from, row * sizeof *from);
        else if (job->options.dither)
            clipped += dithered_codes(job, j, from, row, strip->out, first);
        else clipped += plain_codes(job, &codes, from, row, strip->out, first);
    }
    __atomic_fetch_add(&job->report.clipped, clipped, __ATOMIC_RELAXED);
}

void wr_export_map_rows(WrExportJob *job, int y, int rows, void *out)
{
    Strip strip = { y, out };
    wr_export_run(job, y, rows, map_piece, &strip);
}

static void describe_sky(WrExportJob *job)
{
    wr_text_addf(wr_export_attribute(job, "wrinkle:directions"), "%d", job->options.directions);
    WrText *reach = wr_export_attribute(job, "wrinkle:reach");
    if (job->options.reach) wr_text_addf(reach, "%d", job->options.reach);
    else wr_text_add(reach, "all");
}

void wr_export_map_describe(WrExportJob *job)
{
    const WrExportKind *kind = job->kind;
    if (kind->make == wr_export_occlusion_make || kind->make == wr_export_horizon_make)
        describe_sky(job);
    wr_export_derived_describe(job);
}

/* ---- maps of field/maps.h ---- */

/* Computes the map and its range. job: settings except the ground. A formula is sampled into a table first where a map reads
   neighbours (occlusion, cavity); slopes still come from the formula. */
static bool fill(WrExportJob *job, WrFieldMapKind kind, const WrMapJob *settings,
                 const char *quantity, WrError *err)
{
    const WrMapPart part = whole(job);
    WrField *own = job->analytic ? sampled(job, err) : NULL;
    WrMapJob made = *settings;
    int64_t replaced = 0;
    if ((job->analytic && !own) || !hold_map(job, err)) {
        wr_field_free(own);
        return false;
    }
    made.ground = wr_export_ground(job, own);
    const bool good = wr_map_make(kind, &made, &part, job->pool, job->map, &replaced, err);
    wr_field_free(own);
    job->report.replaced += replaced;
    if (good) wr_export_report_range(job, quantity);
    return good;
}

bool wr_export_occlusion_make(WrExportJob *job, WrError *err)
{
    const WrMapJob settings = { .directions = job->options.directions,
                                .reach = job->options.reach };
    if (!fill(job, WR_FIELD_MAP_OCCLUSION, &settings, "occlusion", err)) return false;
    wr_export_codes(job, 0, 1);
    return true;
}

bool wr_export_cavity_make(WrExportJob *job, WrError *err)
{
    const WrMapJob settings = { .sigma = job->options.radius };
    if (!fill(job, WR_FIELD_MAP_CAVITY, &settings, "depth", err)) return false;
    wr_export_codes(job, job->options.full > 0 ? -job->options.full : job->report.low, 0);
    if (!(job->report.low < 0) && !(job->options.full > 0)) wr_export_codes(job, -1, 0);
    return true;
}

bool wr_export_direction_make(WrExportJob *job, WrError *err)
{
    const WrMapJob settings = { 0 };
    if (!fill(job, WR_FIELD_MAP_DIRECTION, &settings, "degrees", err)) return false;
    wr_export_codes(job, 0, 360);
    return true;
}

/* Beckmann's alpha of the scene's material: roughness squared, or the width of the lobe of its shininess
   (Walter, Marschner, Li, Torrance 2007: s = 2 / alpha^2 - 2). */
double wr_export_material_alpha(const WrScene *scene)
{
    const double roughness = scene->material.roughness;
    if (wr_reflects[scene->material.model].roughness) return roughness * roughness;
    return fmin(1, sqrt(2 / (scene->material.shininess + 2)));
}

bool wr_export_roughness_make(WrExportJob *job, WrError *err)
{
    const double base = job->options.base;
    const WrMapJob settings = { .box = job->options.box,
                                .base = base < 0 ? wr_export_material_alpha(job->scene) : base };
    if (!fill(job, WR_FIELD_MAP_ROUGHNESS, &settings, "roughness", err)) return false;
    wr_export_codes(job, 0, 1);
    return true;
}

/* Keeps only the convex, or the concave, part; both are then positive. */
static void keep_part(WrExportJob *job, WrExportPart part)
{
    const size_t texels = (size_t)job->width * (size_t)job->height;
    const float sign = part == WR_EXPORT_CONVEX ? 1.0f : -1.0f;
    for (size_t i = 0; i < texels && part != WR_EXPORT_BOTH; i++) {
        const float x = sign * job->map[i];
        job->map[i] = x > 0 ? x : 0.0f;
    }
}

bool wr_export_curvature_make(WrExportJob *job, WrError *err)
{
    const WrMapJob settings = { 0 };
    const double full = job->options.full;
    if (!fill(job, WR_FIELD_MAP_CURVATURE, &settings, "curvature", err)) return false;
    const double most = fmax(fabs(job->report.low), fabs(job->report.high));
    if (job->options.part == WR_EXPORT_BOTH) {
        export_signed_codes(job, full > 0 ? full : most);
        return true;
    }
    keep_part(job, (WrExportPart)job->options.part);
    wr_export_report_range(job, job->options.part == WR_EXPORT_CONVEX ? "convexity" : "concavity");
    wr_export_codes(job, 0, full > 0 ? full : job->report.high);
    return true;
}

/* ---- horizons ------------------------------------------------------------------------------------ */

static WrOcclusion horizon_of(const WrExportJob *job, const WrField *field)
{
    return (WrOcclusion){ .field = field,
                          .height = job->scene->height,
                          .texel_w = job->options.cell_w / job->width,
                          .texel_h = job->options.cell_h / job->height,
                          .directions = job->options.directions,
                          .reach = job->options.reach };
}

int wr_export_horizon_channels(const WrExportJob *job, char (*names)[WR_EXPORT_NAME])
{
    WrExportJob sized = *job;
    if (job->options.toward >= 0) return 1;
    sized.width = wr_field_width(job->field);
    sized.height = wr_field_height(job->field);
    if (sized.options.cell_w == 0) sized.options.cell_w = job->scene->cell.w;
    if (sized.options.cell_h == 0) sized.options.cell_h = job->scene->cell.h;
    const WrOcclusion o = horizon_of(&sized, job->field);
    for (int k = 0; k < o.directions; k++)
        snprintf(names[k], WR_EXPORT_NAME, "h%02u_%03u", (unsigned)k % 100,
                 (unsigned)lrint(wr_occlusion_degrees(&o, k)) % 1000);
    return o.directions;
}

/* The direction nearest to that angle. */
static int nearest(const WrOcclusion *o, double degrees)
{
    int best = 0;
    double least = 1e9;
    for (int k = 0; k < o->directions; k++) {
        const double off = fabs(remainder(wr_occlusion_degrees(o, k) - degrees, 360));
        if (off < least) least = off, best = k;
    }
    return best;
}

/* job->map is [height][width][channels]; a horizon is computed as a plane and then interleaved. */
static bool fill_horizons(WrExportJob *job, const WrOcclusion *o, WrError *err)
{
    const size_t texels = (size_t)job->width * (size_t)job->height,
                 channels = (size_t)job->channels;
    const WrMapPart part = whole(job);
    float *one = job->channels > 1 ? wr_try_alloc(texels, sizeof *one, "horizons", err) : job->map;
    bool good = one != NULL;
    for (int k = 0; k < job->channels && good; k++) {
        const int direction = job->channels > 1 ? k : nearest(o, job->options.toward);
        good = wr_occlusion_horizon(o, &part, direction, job->pool, one, err);
        for (size_t i = 0; i < texels && one != job->map; i++)
            job->map[i * channels + (size_t)k] = one[i];
    }
    if (one != job->map) wr_free(one);
    return good;
}

bool wr_export_horizon_make(WrExportJob *job, WrError *err)
{
    WrField *own = job->analytic ? sampled(job, err) : NULL;
    const WrOcclusion o = horizon_of(job, own ? own : job->field);
    const bool good = (own || !job->analytic) && hold_map(job, err) && fill_horizons(job, &o, err);
    wr_field_free(own);
    if (!good) return false;
    wr_export_report_range(job, "slopes");
    wr_export_codes(job, 0, job->options.full > 0 ? job->options.full : job->report.high);
    return true;
}

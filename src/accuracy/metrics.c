#include "accuracy/metrics.h"

#include "base/memory.h"
#include "render/frame/frame.h"
#include "shade/bump.h"

#include <math.h>
#include <string.h>

/* Sum of `count` values, added in pairs; they are overwritten.
   Rounding grows with log2(count) instead of count: a mean over 10^7 pixels keeps its last digits, and its
   order is fixed. */
static double pair_sum(double *values, int64_t count)
{
    for (; count > 1; count = (count + 1) / 2) {
        for (int64_t i = 0; i < count / 2; i++) values[i] = values[2 * i] + values[2 * i + 1];
        if (count % 2) values[count / 2] = values[count - 1];
    }
    return count > 0 ? values[0] : 0;
}

/* One value for each of some pixels. */
typedef struct Values {
    double *value; /* [count], owned */
    int64_t count;
} Values;

static Values values_new(size_t most)
{
    return (Values){ wr_alloc(most > 0 ? most : 1, sizeof(double)), 0 };
}

static void note(Values *values, double value)
{
    values->value[values->count++] = value;
}

static double largest(const Values *values)
{
    double most = 0;
    for (int64_t i = 0; i < values->count; i++) most = fmax(most, values->value[i]);
    return most;
}

/* sqrt of the sum divided by `terms` per value; the values are overwritten. */
static double root_mean(Values *values, int terms)
{
    const double count = (double)values->count * terms;
    return values->count > 0 ? sqrt(pair_sum(values->value, values->count) / count) : 0;
}

/* The value that the part `share` of all does not exceed: number ceil(share count) in ascending order, found by
   partitioning.
   Hoare's selection, linear on average; no full sort. */
static double percentile(Values *values, double share)
{
    if (values->count == 0) return 0;
    double *v = values->value;
    const int64_t rank = (int64_t)ceil(share * (double)values->count) - 1;
    int64_t low = 0, high = values->count - 1;
    while (low < high) {
        const double middle = v[low + (high - low) / 2];
        int64_t i = low, j = high;
        while (i <= j) {
            while (v[i] < middle) i++;
            while (v[j] > middle) j--;
            if (i > j) break;
            const double swapped = v[i];
            v[i++] = v[j], v[j--] = swapped;
        }
        if (rank <= j) high = j;
        else if (rank >= i) low = i;
        else break;
    }
    return v[rank];
}

/* All values collected from a pair of pictures, pixel by pixel. */
typedef struct Gathered {
    Values all, inner, covered;      /* sum of a pixel's three squared differences */
    Values inner_most, covered_most; /* a pixel's largest difference */
    Values angles, angle_squares;
    Values coverage; /* squared differences, over edges */
    double coverage_max;
} Gathered;

static bool chosen(const unsigned char *only, int width, int x, int y)
{
    const int across = (width + WR_FRAME_BLOCK - 1) / WR_FRAME_BLOCK;
    return !only || only[y / WR_FRAME_BLOCK * across + x / WR_FRAME_BLOCK] != 0;
}

/* NaN counts as the largest difference. */
static double difference(double a, double b)
{
    const double d = fabs(a - b);
    return d >= 0 ? d : INFINITY;
}

/* A pixel is inside if both coverages are 1, an edge if either is between 0 and 1 or they differ.
   Outlines are reported apart: their error is one of coverage and hides that of shading. */
static void gather_pixel(const float *a, const double *b, Gathered *gathered, WrErrors *out)
{
    double squares = 0, most = 0;
    for (int c = 0; c < 3; c++) {
        const double d = difference((double)a[c], b[c]);
        squares += d * d;
        most = fmax(most, d);
    }
    out->pixels++;
    note(&gathered->all, squares);
    const double ours = (double)a[3], theirs = b[3];
    if (!(ours > 0 || theirs > 0)) return;
    out->covered++;
    note(&gathered->covered, squares);
    note(&gathered->covered_most, most);
    if (ours == 1 && theirs == 1) {
        note(&gathered->inner, squares);
        note(&gathered->inner_most, most);
        return;
    }
    const double d = difference(ours, theirs);
    out->edges++;
    note(&gathered->coverage, d * d);
    gathered->coverage_max = fmax(gathered->coverage_max, d);
}

/* atan2 of cross and dot product (HC20): acos would return 0.02 degrees or NaN for equal normals in float. */
static void gather_angle(const float *a, const double *b, Gathered *gathered)
{
    const WrVec3 ours = { (double)a[0], (double)a[1], (double)a[2] }, theirs = { b[0], b[1], b[2] };
    if (v3_dot(ours, ours) == 0 || v3_dot(theirs, theirs) == 0) return;
    const double deg = wr_bump_tilt_deg(ours, theirs);
    note(&gathered->angles, deg);
    note(&gathered->angle_squares, deg * deg);
}

static void gather(const float *rgba, const float *normal, const WrReference *reference,
                   const unsigned char *only, Gathered *gathered, WrErrors *out)
{
    for (int y = 0; y < reference->height; y++)
        for (int x = 0; x < reference->width; x++) {
            if (!chosen(only, reference->width, x, y)) continue;
            const size_t at = (size_t)y * (size_t)reference->width + (size_t)x;
            gather_pixel(rgba + 4 * at, reference->rgba + 4 * at, gathered, out);
            if (normal && reference->normal)
                gather_angle(normal + 3 * at, reference->normal + 3 * at, gathered);
        }
}

void wr_errors_measure(const float *rgba, const float *normal, const WrReference *reference,
                       const unsigned char *only, WrErrors *out)
{
    const size_t pixels = (size_t)reference->width * (size_t)reference->height;
    Gathered g = { 0 };
    Values *const each[] = { &g.all,          &g.inner,  &g.covered,       &g.inner_most,
                             &g.covered_most, &g.angles, &g.angle_squares, &g.coverage };
    for (size_t i = 0; i < sizeof each / sizeof *each; i++) *each[i] = values_new(pixels);
    WrErrors errors = { 0 };
    gather(rgba, normal, reference, only, &g, &errors);
    errors.max = largest(&g.covered_most);
    errors.max_inside = largest(&g.inner_most);
    errors.p999 = percentile(&g.covered_most, 0.999);
    errors.rms = root_mean(&g.covered, 3);
    errors.rms_inside = root_mean(&g.inner, 3);
    errors.rms_all = root_mean(&g.all, 3);
    errors.coverage_max = g.coverage_max;
    errors.coverage_rms = root_mean(&g.coverage, 1);
    errors.angle_rms = errors.angle_max = errors.angle_p999 = NAN;
    if (g.angles.count > 0) {
        errors.angle_max = largest(&g.angles);
        errors.angle_p999 = percentile(&g.angles, 0.999);
        errors.angle_rms = root_mean(&g.angle_squares, 1);
    }
    for (size_t i = 0; i < sizeof each / sizeof *each; i++) wr_free(each[i]->value);
    *out = errors;
}

/* Stops of the scale: black, violet, orange, white, with rising lightness. */
void wr_heat_colour(double t, uint8_t rgb[3])
{
    static const double stops[4][3] = {
        { 0, 0, 0 }, { 98, 22, 140 }, { 244, 124, 32 }, { 255, 255, 255 }
    };
    t = t > 0 ? t < 1 ? t : 1 : 0;
    const int k = t < 1 ? (int)(3 * t) : 2;
    const double a = 3 * t - k;
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)(stops[k][c] + a * (stops[k + 1][c] - stops[k][c]) + 0.5);
}

static double pixel_error(const float *a, const double *b)
{
    double most = 0;
    for (int c = 0; c < 3; c++) most = fmax(most, difference((double)a[c], b[c]));
    return most;
}

void wr_errors_picture(const float *rgba, const WrReference *reference, double full, uint8_t *out)
{
    const size_t pixels = (size_t)reference->width * (size_t)reference->height;
    if (!(full > 0)) {
        full = 0;
        for (size_t i = 0; i < pixels; i++) {
            const double d = pixel_error(rgba + 4 * i, reference->rgba + 4 * i);
            if (isfinite(d)) full = fmax(full, d);
        }
    }
    for (size_t i = 0; i < pixels; i++) {
        const double d = pixel_error(rgba + 4 * i, reference->rgba + 4 * i);
        wr_heat_colour(d > 0 ? full > 0 ? d / full : 1 : 0, out + 3 * i);
    }
}

#include "generate/normals.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

#define STEEPEST 100.0

/* ---- decoding ---- */

/* How far a pixel is from a unit normal, its numbers taken as scale x + offset. */
static double misfit(const float *c, int channels, double scale, double offset)
{
    double sum = 0.0;
    for (int a = 0; a < 3 && a < channels; a++) {
        double x = scale * (double)c[a] + offset;
        sum += x * x;
    }
    double much = channels == 2 ? sum - 1.0 : fabs(sum - 1.0); /* of two, the third is unknown */
    return much > 0.0 ? much < 1.0 ? much : 1.0 : 0.0;
}

/* Floats below 0 are normals as they are; others where they are nearer to unit length so. */
static bool is_signed(const WrImage *image, WrNormalCodes codes)
{
    if (image->type != WR_PIXEL_F32) return false;
    if (codes != WR_NORMALS_AUTO) return codes == WR_NORMALS_SIGNED;
    size_t count = (size_t)image->width * (size_t)image->height;
    double as_is = 0.0, as_codes = 0.0;
    for (size_t k = 0; k < count; k++) {
        const float *c = image->data + k * (size_t)image->channels;
        if (c[0] < -0.01f || c[1] < -0.01f) return true;
        as_is += misfit(c, image->channels, 1.0, 0.0);
        as_codes += misfit(c, image->channels, 2.0, -1.0);
    }
    return as_is < as_codes;
}

static double axis_of(double c, double most, bool as_is)
{
    if (as_is) return c;
    double twice = most > 0.0 ? 2.0 * rint(c * most) - most : 2.0 * c - 1.0;
    if (most == 0.0) return twice;
    return fabs(twice) <= 1.0 ? 0.0 : twice / most;
}

static double limited(double slope, bool *steep)
{
    if (fabs(slope) <= STEEPEST) return slope;
    *steep = true;
    return slope > 0.0 ? STEEPEST : -STEEPEST;
}

static void decode_texel(const WrImage *image, const float *pixel, bool as_is, size_t k,
                         WrNormals *out)
{
    static const double codes[] = { [WR_PIXEL_U8] = 255.0, [WR_PIXEL_U16] = 65535.0 };
    double most = image->type == WR_PIXEL_F32 ? 0.0 : codes[image->type], z;
    double x = axis_of((double)pixel[0], most, as_is), y = axis_of((double)pixel[1], most, as_is);
    if (image->channels == 2) {
        double rest = 1.0 - x * x - y * y;
        z = rest > 0.0 ? sqrt(rest) : 0.0;
    } else {
        z = axis_of((double)pixel[2], most, as_is);
    }
    if (!(z > 0.0) || !(fabs(x) < 1e30 && fabs(y) < 1e30)) {
        out->unknown++;
        return;
    }
    bool steep = false;
    out->p[k] = limited(-x / z, &steep);
    out->q[k] = limited(y / z, &steep);
    out->steep += steep;
}

bool wr_normals_decode(const WrImage *image, WrNormalCodes codes, WrNormals *out, WrError *err)
{
    if (image->channels < 2)
        return wr_fail(err, "a normal map has 2 channels or more; this picture has 1: photo and "
                            "elevation read heights");
    size_t count = (size_t)image->width * (size_t)image->height;
    WrNormals made = { .width = image->width, .height = image->height };
    made.p = wr_try_alloc(count, sizeof *made.p, "a normal map", err);
    made.q = made.p ? wr_try_alloc(count, sizeof *made.q, "a normal map", err) : NULL;
    if (!made.q) {
        wr_normals_fini(&made);
        return false;
    }
    bool as_is = is_signed(image, codes);
    for (size_t k = 0; k < count; k++)
        decode_texel(image, image->data + k * (size_t)image->channels, as_is, k, &made);
    *out = made;
    return true;
}

void wr_normals_fini(WrNormals *normals)
{
    wr_free(normals->p);
    wr_free(normals->q);
    *normals = (WrNormals){ .p = NULL };
}

double wr_normals_upward(const WrNormals *n)
{
    double both = 0.0, along = 0.0, across = 0.0;
    size_t w = (size_t)n->width;
    for (int j = 1; j + 1 < n->height; j++)
        for (int i = 1; i + 1 < n->width; i++) {
            size_t k = (size_t)j * w + (size_t)i;
            double py = n->p[k + w] - n->p[k - w], qx = n->q[k + 1] - n->q[k - 1];
            both += py * qx;
            along += py * py;
            across += qx * qx;
        }
    double size = sqrt(along) * sqrt(across);
    return size > 0.0 ? both / size : 0.0;
}

void wr_normals_flip(WrNormals *n)
{
    for (size_t k = 0; k < (size_t)n->width * (size_t)n->height; k++) n->q[k] = -n->q[k];
}

/* ---- integration ---- */

/* Slopes at texels to steps between them: the integral of the cubic through four texels, or of the parabola
 * through the last three. */
static void steps_of_line(const void *ctx, const WrFft *fft, double *a, double *b, double *scratch)
{
    (void)fft;
    int n = *(const int *)ctx;
    double *line[2] = { a, b };
    for (int s = 0; s < 2; s++) {
        double *z = line[s];
        const double *p = scratch;
        memcpy(scratch, z, (size_t)n * sizeof *z);
        for (int i = 0; i + 1 < n; i++) {
            if (i > 0 && i + 2 < n)
                z[i] = (13.0 * (p[i] + p[i + 1]) - (p[i - 1] + p[i + 2])) / 24.0;
            else if (i + 2 < n) z[i] = (5.0 * p[i] + 8.0 * p[i + 1] - p[i + 2]) / 12.0;
            else if (i > 0) z[i] = (5.0 * p[i + 1] + 8.0 * p[i] - p[i - 1]) / 12.0;
            else z[i] = 0.5 * (p[i] + p[i + 1]);
        }
        z[n - 1] = 0.0;
    }
}

/* An axis' slopes in table units a texel, as the way of taking slopes there wants them. */
static bool prepare(const WrPlane *plane, int axis, const double *slopes, double unit, WrError *err)
{
    size_t count = (size_t)plane->width * (size_t)plane->height;
    int n = axis == 0 ? plane->width : plane->height;
    for (size_t k = 0; k < count; k++) plane->z[k] = slopes[k] * unit;
    return plane->ends[axis] == WR_ENDS_RING || wr_plane_lines(plane, axis, steps_of_line, &n, err);
}

/* The heights' own slopes, in the same way. z: heights in, slopes out. */
static bool own_slopes(const WrPlane *plane, int axis, WrSlopes slopes, WrError *err)
{
    size_t w = (size_t)plane->width, h = (size_t)plane->height;
    double *z = plane->z;
    if (slopes != WR_SLOPES_STEP) {
        if (!wr_plane_turned_slope(plane, axis, slopes, err)) return false;
        for (size_t k = 0; k < w * h; k++) z[k] = -z[k]; /* turned round they only change sign */
        return true;
    }
    size_t step = axis == 0 ? 1 : w;
    for (size_t k = 0; k < w * h; k++) {
        bool last = axis == 0 ? k % w == w - 1 : k >= w * (h - 1);
        z[k] = last ? 0.0 : z[k + step] - z[k];
    }
    return true;
}

/* Root mean square angle between normals of slopes (a, b) and (c, d), in degrees. */
static double mean_angle(const double *const s[4], const double unit[2], size_t count)
{
    double sum = 0.0;
    for (size_t k = 0; k < count; k++) {
        double a = s[0][k] / unit[0], b = s[1][k] / unit[1];
        double c = s[2][k] / unit[0], d = s[3][k] / unit[1];
        double x = b - d, y = c - a, z = a * d - b * c; /* of the vector product */
        double angle = wr_atan2(sqrt(x * x + y * y + z * z), 1.0 + a * c + b * d);
        sum += angle * angle;
    }
    return sqrt(sum / (double)count) / WR_RAD_PER_DEG;
}

typedef struct Work {
    WrPlane plane;
    WrSlopes slopes[2];
    double *want[2]; /* slopes of the map, table units a texel */
    double *have[2]; /* for what is worked out from them */
    size_t count;
} Work;

static bool solve(Work *w, double *z, WrError *err)
{
    for (int a = 0; a < 2; a++) {
        w->plane.z = w->have[a];
        memcpy(w->have[a], w->want[a], w->count * sizeof *z);
        if (!wr_plane_turned_slope(&w->plane, a, w->slopes[a], err)) return false;
    }
    for (size_t k = 0; k < w->count; k++) z[k] = w->have[0][k] + w->have[1][k];
    w->plane.z = z;
    return wr_plane_solve(&w->plane, w->slopes, err);
}

static bool compare(Work *w, const double *z, WrIntegral *how, WrError *err)
{
    for (int a = 0; a < 2; a++) {
        memcpy(w->have[a], z, w->count * sizeof *z);
        w->plane.z = w->have[a];
        if (!own_slopes(&w->plane, a, w->slopes[a], err)) return false;
        double mean = 0.0;
        for (size_t k = 0; k < w->count; k++) mean += w->want[a][k] / (double)w->count;
        how->tilt_deg[a] = how->ends[a] == WR_ENDS_RING
                               ? wr_atan2(mean / how->unit[a], 1.0) / WR_RAD_PER_DEG
                               : 0.0;
    }
    const double *const s[] = { w->want[0], w->want[1], w->have[0], w->have[1] };
    how->residual_deg = mean_angle(s, how->unit, w->count);
    return true;
}

bool wr_normals_integrate(const WrNormals *normals, WrIntegral *how, const WrGenerateJob *job,
                          WrSheet *sheet, WrError *err)
{
    const double *slopes[2] = { normals->p, normals->q };
    WrSheet made = { .z = NULL };
    WrWrap wrap[2];
    Work w = { .plane = { .width = normals->width,
                          .height = normals->height,
                          .ends = { how->ends[0], how->ends[1] },
                          .pool = job->pool,
                          .progress = job->progress },
               .count = (size_t)normals->width * (size_t)normals->height };
    bool good = true;
    for (int a = 0; a < 2; a++) {
        bool ring = how->ends[a] == WR_ENDS_RING;
        wrap[a] = ring ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP;
        w.slopes[a] = !ring ? WR_SLOPES_STEP : how->central ? WR_SLOPES_CENTRAL : WR_SLOPES_SMOOTH;
        w.want[a] = wr_try_alloc(w.count, sizeof *made.z, "a normal map", err);
        w.have[a] = w.want[a] ? wr_try_alloc(w.count, sizeof *made.z, "a normal map", err) : NULL;
        w.plane.z = w.want[a];
        good = good && w.have[a] && prepare(&w.plane, a, slopes[a], how->unit[a], err);
    }
    good = good && wr_sheet_new(&made, normals->width, normals->height, wrap, err) &&
           solve(&w, made.z, err) && compare(&w, made.z, how, err);
    for (int a = 0; a < 2; a++) {
        wr_free(w.want[a]);
        wr_free(w.have[a]);
    }
    if (good) *sheet = made;
    else wr_sheet_fini(&made);
    return good;
}

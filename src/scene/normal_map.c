#include "scene/normal_map.h"

#include "base/error.h"
#include "base/progress.h"
#include "image/image.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define LEVEL_CODES                                                                                \
    2.1            /* in units of 2/M: maximum distance from 0 of codes of z = 0, centred or not */
#define LOOK 16384 /* texels between cancellation checks */

/* ---- numbers ------------------------------------------------------------------------------------- */

/* A map becomes unit vectors in float, x to the right, y up, z out of the surface, at reading; everything
   after it ignores the file's coding (NUMERICS-SCENES b). */

typedef struct Reading {
    const WrImage *from;
    int channels;
    int last;   /* code; 0: float */
    bool remap; /* 2 c - 1 */
    bool centred;
    bool object; /* all directions are allowed */
} Reading;

static size_t texels_of(const WrImage *image)
{
    return (size_t)image->width * (size_t)image->height;
}

static const float *texel_of(const Reading *r, size_t i)
{
    return r->from->data + i * (size_t)r->from->channels;
}

/* True if more than half of the texels have the code above the middle in x and y.
   Without a code for 0 a flat map of 8 bits is tilted by 0.318 degrees; many tools mean 128 (or 32768) as 0.
   If most of the map has that code it is taken for 0, and the codes above and below are scaled alike (HC137). */
static bool is_centred(const Reading *r)
{
    const double middle = (r->last + 1) / 2;
    size_t count = 0;
    if (r->last == 0) return false;
    for (size_t i = 0; i < texels_of(r->from); i++) {
        const float *t = texel_of(r, i);
        count += fabs((double)t[0] * r->last - middle) < 0.25 &&
                 fabs((double)t[1] * r->last - middle) < 0.25;
    }
    return 2 * count > texels_of(r->from);
}

static double number(const Reading *r, double x)
{
    if (!r->remap) return x;
    if (!r->centred) return 2 * x - 1;
    const double middle = (r->last + 1) / 2, code = floor(x * r->last + 0.5);
    return fmax(-1, (code - middle) / (r->last - middle));
}

/* True if linear numbers about the middle were treated as light: encoded 0.735, decoded 0.214. */
static bool is_converted(const Reading *r)
{
    double mean[2] = { 0 };
    if (!r->remap) return false;
    for (size_t i = 0; i < texels_of(r->from); i++)
        for (int c = 0; c < 2; c++)
            mean[c] += (double)texel_of(r, i)[c] / (double)texels_of(r->from);
    const bool encoded = fabs(mean[0] - 0.735) < 0.03 && fabs(mean[1] - 0.735) < 0.03;
    const bool decoded = fabs(mean[0] - 0.214) < 0.03 && fabs(mean[1] - 0.214) < 0.03;
    return encoded || decoded;
}

/* ---- vectors ------------------------------------------------------------------------------------- */

/* Stores a unit vector; true if it faced away from a tangent plane.
   z below WR_NORMAL_MIN would make the slope -x/z infinite or flip its sign (HC139). */
static bool put_vector(double x, double y, double z, bool object, float out[3])
{
    const bool away = !object && z < WR_NORMAL_MIN;
    if (away) z = WR_NORMAL_MIN;
    const double unit = 1 / sqrt(x * x + y * y + z * z);
    out[0] = (float)(x * unit), out[1] = (float)(y * unit), out[2] = (float)(z * unit);
    return away;
}

/* Reads one texel.
   Two channels: z = sqrt(1 - x^2 - y^2); outside the unit circle z is 0 and the vector is scaled to the rim
   (HC138). off is the deviation of the stored length from 1, a sign of wrong coding. */
static void read_vector(const Reading *r, size_t i, float out[3], WrNormalMapReport *report)
{
    const float *t = texel_of(r, i);
    double x = number(r, (double)t[0]), y = number(r, (double)t[1]);
    const double xy = x * x + y * y;
    double z = r->channels == 3 ? number(r, (double)t[2]) : sqrt(fmax(0, 1 - xy));
    const double length = sqrt(xy + z * z), off = r->channels == 3 ? fabs(length - 1) : 0;
    report->off = fmax(report->off, off);
    report->off_mean += off / (double)texels_of(r->from);
    if (!(length > 0)) { /* undefined direction */
        out[0] = out[1] = 0, out[2] = 1;
        report->away++;
        return;
    }
    const bool level = r->last && fabs(z) < LEVEL_CODES / r->last;
    x /= length, y /= length, z /= length;
    const bool away = put_vector(x, y, z, r->object, out);
    report->away += away;
    report->level += away && level;
}

void wr_normal_map_slopes(const float n[3], double *p, double *q)
{
    *p = -(double)n[0] / (double)n[2];
    *q = -(double)n[1] / (double)n[2];
}

/* ---- the sign of green --------------------------------------------------------------------------- */

/* Heights exist only if D_v p = D_u q (mixed second derivatives). For a true sign of green the sum of D_v p
   D_u q is that of F_uv squared, hence positive; for the wrong sign it is negative. f(u) + g(v) has F_uv = 0:
   undecided (HC140). */

static const float *vector_at(const WrImage *image, int i, int j)
{
    const int x = (i + image->width) % image->width, y = (j + image->height) % image->height;
    return image->data + ((size_t)y * (size_t)image->width + (size_t)x) * 3;
}

/* sum of D_v p D_u q, rows upwards; noise: standard deviation from rounding of codes by `step`.
   Errors of the four ends are independent with standard deviation e each, so those of dp and dq have 2 e^2;
   the variance of dp dq is 2 e^2 (dp^2 + dq^2) + 4 e^4. */
static double twist(const WrImage *image, double step, double *noise)
{
    double sum = 0, squares = 0;
    for (int j = 0; j < image->height; j++)
        for (int i = 0; i < image->width; i++) {
            double p[2], q[2], other, steep = 1;
            const float *const ends[4] = { vector_at(image, i, j - 1), vector_at(image, i, j + 1),
                                           vector_at(image, i + 1, j), vector_at(image, i - 1, j) };
            for (int k = 0; k < 2; k++) {
                wr_normal_map_slopes(ends[k], &p[k], &other);
                wr_normal_map_slopes(ends[2 + k], &other, &q[k]);
            }
            for (int k = 0; k < 4; k++) steep = fmin(steep, (double)ends[k][2]);
            /* a slope is -x/z: an error e of a unit vector's components changes it by at most e/z^2 */
            const double dp = p[0] - p[1], dq = q[0] - q[1], error = step / (steep * steep);
            sum += dp * dq;
            squares += error * error * (2 * dp * dp + 2 * dq * dq + 4 * error * error);
        }
    *noise = sqrt(squares);
    return sum;
}

#define SURE 6 /* standard deviations */

static bool find_down(const WrImage *image, double step, WrNormalMapReport *report)
{
    double noise;
    const double sum = twist(image, step, &noise);
    report->undecided = !(fabs(sum) > SURE * noise);
    return !report->undecided && sum < 0;
}

/* Reads all texels with the reading's settings. */
static WrImage *read_vectors(Reading *r, WrCoding coding, WrNormalMapReport *report, WrError *err)
{
    WrCoding found;
    if (!wr_coding_find(r->from, r->channels, coding, &found, err)) return NULL;
    WrImage *to = wr_image_new(r->from->width, r->from->height, 3, err);
    if (!to) return NULL;
    to->type = WR_PIXEL_F32;
    r->last = (int)wr_pixel_type_max(r->from->type);
    r->remap = found == WR_CODING_UNIT;
    r->centred = !r->object && is_centred(r);
    report->channels = r->channels;
    report->own = !r->remap;
    report->centred = r->centred;
    report->converted = !r->object && is_converted(r);
    for (size_t i = 0; i < texels_of(to); i++) {
        if (i % LOOK == 0 && wr_progress_stopped()) {
            wr_image_free(to);
            wr_fail(err, "cancelled");
            return NULL;
        }
        read_vector(r, i, to->data + 3 * i, report);
    }
    return to;
}

static void turn_green(WrImage *map)
{
    for (size_t i = 0; i < texels_of(map); i++) map->data[3 * i + 1] = -map->data[3 * i + 1];
}

WrImage *wr_normal_map_turned(const WrImage *map, WrError *err)
{
    WrImage *to = wr_image_new(map->width, map->height, 3, err);
    if (!to) return NULL;
    to->type = WR_PIXEL_F32;
    memcpy(to->data, map->data, 3 * texels_of(map) * sizeof *map->data);
    turn_green(to);
    return to;
}

WrImage *wr_normal_map_raised(const WrImage *map, int64_t *away, WrError *err)
{
    WrImage *to = wr_image_new(map->width, map->height, 3, err);
    *away = 0;
    if (!to) return NULL;
    to->type = WR_PIXEL_F32;
    for (size_t i = 0; i < texels_of(map); i++) {
        const float *n = map->data + 3 * i;
        *away += put_vector((double)n[0], (double)n[1], (double)n[2], false, to->data + 3 * i);
    }
    return to;
}

WrImage *wr_normal_map_decode(const WrImage *from, WrGreen green, int channels, WrCoding coding,
                              WrNormalMapReport *report, WrError *err)
{
    const int colours = from->channels > 3 ? 3 : from->channels;
    Reading r = { .from = from, .channels = channels ? channels : colours };
    *report = (WrNormalMapReport){ 0 };
    if (r.channels < 2 || r.channels > from->channels) {
        wr_fail(err, "channels=%d: the normal map has %d; must be 2 or 3",
                r.channels < 2 ? 2 : r.channels, from->channels);
        return NULL;
    }
    WrImage *to = read_vectors(&r, coding, report, err);
    if (!to) return NULL;
    const double step = r.last ? 2.0 / r.last : 1e-6;
    report->green_down =
        green == WR_GREEN_AUTO ? find_down(to, step, report) : green == WR_GREEN_DOWN;
    if (report->green_down) turn_green(to);
    return to;
}

WrImage *wr_normal_map_read_object(const WrImage *from, bool green_down, WrCoding coding,
                                   WrNormalMapReport *report, WrError *err)
{
    Reading r = { .from = from, .channels = 3, .object = true };
    *report = (WrNormalMapReport){ 0 };
    if (from->channels < 3) {
        wr_fail(err, "an object-space normal map has %d channels; must be 3", from->channels);
        return NULL;
    }
    WrImage *to = read_vectors(&r, coding, report, err);
    /* Documents store maps as they were decoded; a changed file must not bring vectors of other lengths into
       the shading. */
    report->green_down = green_down;
    if (to && green_down) turn_green(to);
    return to;
}

/* True for a valid vector as produced by reading. */
static bool is_made(const float n[3], bool object)
{
    const double square =
        (double)n[0] * (double)n[0] + (double)n[1] * (double)n[1] + (double)n[2] * (double)n[2];
    return fabs(square - 1) <= 4 * (double)FLT_EPSILON &&
           (object || (double)n[2] >= WR_NORMAL_MIN * 0.999);
}

WrImage *wr_normal_map_share(const WrImage *held, bool object, WrError *err)
{
    bool made = held->channels == 3 && held->type == WR_PIXEL_F32;
    for (size_t i = 0; made && i < texels_of(held); i++) made = is_made(held->data + 3 * i, object);
    if (made) return wr_image_share(held);
    wr_fail(err, "damaged: the normal map contains vectors that are not of unit length");
    return NULL;
}

#include "shade/environment_map.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

#define WORD(KIND, word, label, light) word,
#define LABEL(KIND, word, label, light) label,
const char *const wr_environment_map_names[WR_ENVIRONMENT_MAP_KINDS] = { "off", WR_ENVIRONMENT_SETS(
                                                                                    WORD) "file" };
const char *const wr_environment_map_labels[WR_ENVIRONMENT_MAP_KINDS] = {
    "None", WR_ENVIRONMENT_SETS(LABEL) "A picture \xe2\x80\xa6"
};

WrEnvironmentMap *wr_environment_map_share(const WrEnvironmentMap *map)
{
    WrEnvironmentMap *shared = (WrEnvironmentMap *)map; /* only the reference count changes */
    if (shared) __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_environment_map_free(WrEnvironmentMap *map)
{
    if (!map || __atomic_sub_fetch(&map->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_image_free(map->image);
    wr_free(map);
}

/* ---- directions ---- */

/* u = 1/2 + atan2(x, -z) / 2 pi, v = 1/2 + atan2(y, hypot(x, z)) / pi: the picture's centre is -z, +x lies at
   u = 3/4. asin(y) would lose half the digits at the poles (NUMERICS-LIGHT b). */

WrVec3 wr_environment_map_direction(double u, double v)
{
    double s, c, sl, cl;
    wr_sincos_turns(u - 0.5, &s, &c);
    wr_sincos_turns(0.5 * (v - 0.5), &sl, &cl);
    return (WrVec3){ s * cl, sl, -c * cl };
}

void wr_environment_map_place(WrVec3 d, double *u, double *v)
{
    const double across = sqrt(d.x * d.x + d.z * d.z);
    *u = 0.5 + wr_atan2(d.x, -d.z) / (2 * WR_PI);
    *v = 0.5 + (across > 0 || d.y != 0 ? wr_atan2(d.y, across) / WR_PI : 0);
}

/* Texel i, j of a channel. Rows -1 and H, beyond the poles, are the adjacent row reflected through its mean, 2 mean - x, so
   that bilinear interpolation at the pole is the mean for every longitude (HC111). */
static double texel(const WrEnvironmentMap *s, int i, int j, int c)
{
    const WrImage *image = s->image;
    const int w = image->width, h = image->height, row = j < 0 ? 0 : j >= h ? h - 1 : j;
    const double x =
        (double)image->data[((size_t)row * (size_t)w + (size_t)((i + w) % w)) * 3 + (size_t)c];
    return row == j ? x : 2 * s->pole[j >= h][c] - x;
}

void wr_environment_map_at_place(const WrEnvironmentMap *s, double u, double v, double rgb[3])
{
    const double x = s->image->width * u - 0.5, y = s->image->height * (1 - v) - 0.5;
    const int i = (int)floor(x), j = (int)floor(y);
    const double a = x - i, b = y - j;
    for (int c = 0; c < 3; c++)
        rgb[c] = (1 - b) * ((1 - a) * texel(s, i, j, c) + a * texel(s, i + 1, j, c)) +
                 b * ((1 - a) * texel(s, i, j + 1, c) + a * texel(s, i + 1, j + 1, c));
}

void wr_environment_map_at(const WrEnvironmentMap *s, WrVec3 direction, double rgb[3])
{
    double u, v;
    wr_environment_map_place(direction, &u, &v);
    wr_environment_map_at_place(s, u, v, rgb);
}

/* The inverse of the turn: it maps a direction of the world to one of the unturned picture. Directions are
   turned, the picture is never resampled, so 360 degrees are the same bytes as 0 (HC116). */
void wr_environment_map_turn(double turn_deg, double out[9])
{
    double s, c;
    wr_sincos_turns(remainder(turn_deg, 360) / 360, &s, &c);
    const double turn[9] = { c, 0, -s, 0, 1, 0, s, 0, c };
    memcpy(out, turn, sizeof turn);
}

/* ---- harmonics ---- */

/* Real spherical harmonics of order 0..2, Y = k0, k1 (y, z, x), k2 (xy, yz), k20 (3 z^2 - 1), k2 xz, k22 (x^2
   - y^2), integrated in double. Longitude and latitude separate: a row needs five sums over its columns,
   whatever the number of harmonics. */

/* Sums of a row over its columns, weighted by functions of longitude p: 1, sin p, cos p, sin 2p, cos
 * 2p. */
typedef struct RowSums {
    double of[5][3];
} RowSums;

static void add_row(RowSums *sums, const float *row, int width, const double *wave)
{
    *sums = (RowSums){ 0 };
    for (int i = 0; i < width; i++)
        for (int k = 0; k < 5; k++)
            for (int c = 0; c < 3; c++) sums->of[k][c] += wave[5 * i + k] * (double)row[3 * i + c];
}

/* 1, sin, cos, sin 2p, cos 2p of the columns' longitudes. */
static double *make_waves(int width)
{
    double *wave = wr_alloc((size_t)width, 5 * sizeof *wave);
    for (int i = 0; i < width; i++) {
        const double turns = (i + 0.5) / width - 0.5;
        wave[5 * i] = 1;
        wr_sincos_turns(turns, &wave[5 * i + 1], &wave[5 * i + 2]);
        wr_sincos_turns(2 * turns, &wave[5 * i + 3], &wave[5 * i + 4]);
    }
    return wave;
}

/* x = sin p cos t, y = sin t, z = -cos p cos t; `angle` is the solid angle of a texel.
   sin^2 p = (1 - cos 2p) / 2 and cos^2 p = (1 + cos 2p) / 2 express all products by the five sums. */
static void add_harmonics(const RowSums *sums, double cl, double sl, double angle,
                          double out[WR_HARMONICS][3])
{
    const double k0 = 0.5 / sqrt(WR_PI), k1 = sqrt(3 / (4 * WR_PI)), k2 = 0.5 * sqrt(15 / WR_PI);
    const double k20 = 0.25 * sqrt(5 / WR_PI), k22 = 0.5 * k2;
    for (int c = 0; c < 3; c++) {
        const double one = angle * sums->of[0][c], s1 = angle * sums->of[1][c];
        const double c1 = angle * sums->of[2][c], s2 = angle * sums->of[3][c];
        const double c2 = angle * sums->of[4][c];
        out[0][c] += k0 * one;
        out[1][c] += k1 * sl * one;
        out[2][c] += k1 * -cl * c1;
        out[3][c] += k1 * cl * s1;
        out[4][c] += k2 * cl * sl * s1;
        out[5][c] += k2 * sl * -cl * c1;
        out[6][c] += k20 * (1.5 * cl * cl * (one + c2) - one);
        out[7][c] += k2 * cl * cl * -0.5 * s2;
        out[8][c] += k22 * (0.5 * cl * cl * (one - c2) - sl * sl * one);
    }
}

/* The integral over the texels, each with its own solid angle (4 pi / W) sin(pi / 2H) cos t.
   The texel's solid angle is exact, but Y is sampled at its centre; for a constant picture orders 1 and 2 must
   be 0, so the harmonics of the constant 1 are subtracted in proportion to the mean (HC115). */
static void find_harmonics(const WrImage *image, double out[WR_HARMONICS][3])
{
    const int w = image->width, h = image->height;
    double *wave = make_waves(w), half, unused;
    wr_sincos_turns(0.25 / h, &half, &unused);
    memset(out, 0, WR_HARMONICS * sizeof *out);
    double one[WR_HARMONICS][3] = { 0 };
    const RowSums ones = { .of[0] = { w, w, w } };
    for (int j = 0; j < h; j++) {
        RowSums sums;
        double sl, cl;
        wr_sincos_turns(0.5 * (0.5 - (j + 0.5) / h), &sl, &cl);
        add_row(&sums, image->data + (size_t)j * (size_t)w * 3, w, wave);
        add_harmonics(&sums, cl, sl, 4 * WR_PI / w * half * cl, out);
        add_harmonics(&ones, cl, sl, 4 * WR_PI / w * half * cl, one);
    }
    wr_free(wave);
    for (int l = 1; l < WR_HARMONICS;
         l++) /* contribution of the mean by discretisation; exactly it is 0 */
        for (int c = 0; c < 3; c++) out[l][c] -= out[0][c] / one[0][c] * one[l][c];
}

/* For a constant colour all but the first are 0. */
static void find_even(const WrImage *image, double out[WR_HARMONICS][3])
{
    memset(out, 0, WR_HARMONICS * sizeof *out);
    for (int c = 0; c < 3; c++) out[0][c] = 2 * sqrt(WR_PI) * (double)image->data[c];
}

/* The same surroundings at a resolution where each texel is represented by its centre. */
static WrImage *finer(const WrEnvironmentMap *s, WrError *err)
{
    WrImage *to = wr_image_new(256, 128, 3, err);
    for (int j = 0; to && j < to->height; j++)
        for (int i = 0; i < to->width; i++) {
            double rgb[3];
            wr_environment_map_at(
                s, wr_environment_map_direction((i + 0.5) / to->width, 1 - (j + 0.5) / to->height),
                rgb);
            for (int c = 0; c < 3; c++)
                to->data[((size_t)j * (size_t)to->width + (size_t)i) * 3 + (size_t)c] =
                    (float)rgb[c];
        }
    return to;
}

static bool find_light(WrEnvironmentMap *s, WrError *err)
{
    if (s->even) {
        find_even(s->image, s->harmonic);
        return true;
    }
    if (s->image->width >= 128 && s->image->height >= 64) {
        find_harmonics(s->image, s->harmonic);
        return true;
    }
    WrImage *fine = finer(s, err);
    if (!fine) return false;
    find_harmonics(fine, s->harmonic);
    wr_image_free(fine);
    return true;
}

/* k, b and Q of one colour in the picture's directions.
   E / pi = k + b.n + n.Q n, with A_l / pi = 1, 2/3, 1/4 (Ramamoorthi and Hanrahan 2001). k20 (3 z^2 - 1)
   contributes to k and to Q's last entry. */
static void world_form(double l[WR_HARMONICS][3], int c, double *k, double b[3], double q[9])
{
    const double k0 = 0.5 / sqrt(WR_PI), k1 = sqrt(3 / (4 * WR_PI)), k2 = 0.5 * sqrt(15 / WR_PI);
    const double k20 = 0.25 * sqrt(5 / WR_PI), k22 = 0.5 * k2, one = 2.0 / 3, two = 0.25;
    *k = k0 * l[0][c] - two * k20 * l[6][c];
    b[0] = one * k1 * l[3][c], b[1] = one * k1 * l[1][c], b[2] = one * k1 * l[2][c];
    q[0] = two * k22 * l[8][c], q[4] = -q[0], q[8] = two * 3 * k20 * l[6][c];
    q[1] = q[3] = 0.5 * two * k2 * l[4][c];
    q[5] = q[7] = 0.5 * two * k2 * l[5][c];
    q[2] = q[6] = 0.5 * two * k2 * l[7][c];
}

/* Entry r, s of A^T Q A. */
static double turned(const double a[9], const double q[9], int r, int s)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) sum += a[3 * i + r] * q[3 * i + k] * a[3 * k + s];
    return sum;
}

/* out[c] is k, b (3), the diagonal of Q (3) and twice its off-diagonal entries xy, yz, zx, in the axes of `a`:
   the kernel evaluates ten terms per colour. Only harmonics up to `order` enter; the others are 0. */
void wr_environment_map_form(const WrEnvironmentMap *map, const double a[9], double strength,
                             int order, double out[3][WR_FORM_TERMS])
{
    double l[WR_HARMONICS][3] = { { 0 } };
    memcpy(l, map->harmonic, (size_t)((order + 1) * (order + 1)) * sizeof *l);
    for (int c = 0; c < 3; c++) {
        double k, b[3], q[9], *f = out[c];
        world_form(l, c, &k, b, q);
        f[0] = k;
        for (int r = 0; r < 3; r++) {
            f[1 + r] = a[r] * b[0] + a[3 + r] * b[1] + a[6 + r] * b[2];
            f[4 + r] = turned(a, q, r, r);
            f[7 + r] = 2 * turned(a, q, r, (r + 1) % 3);
        }
        for (int i = 0; i < WR_FORM_TERMS; i++) f[i] *= strength;
    }
}

/* ---- from pictures ---- */

static float clamp_value(float x, WrEnvironmentMapChanges *changes)
{
    if (isnan(x)) return changes->not_numbers++, 0;
    if (x < 0) return changes->negative++, 0;
    if (x > WR_ENVIRONMENT_MAP_MAX) return changes->too_large++, WR_ENVIRONMENT_MAP_MAX;
    return x;
}

static float channel(const WrImage *image, size_t pixel, int c, WrEnvironmentMapChanges *changes)
{
    const int from = image->channels < 3 ? 0 : c;
    const float x = image->data[pixel * (size_t)image->channels + (size_t)from];
    return clamp_value(image->type == WR_PIXEL_F32 ? x : wr_srgb_decode(x), changes);
}

/* Means of n x n texels, or of fewer at the ends.
   Box means reduce very wide pictures; light is averaged, not codes, and each bad value is counted once
   (HC114). */
static void reduce_row(const WrImage *from, int n, int j, WrImage *to,
                       WrEnvironmentMapChanges *changes)
{
    const int below = j * n + n < from->height ? n : from->height - j * n;
    for (int i = 0; i < to->width; i++) {
        const int beside = i * n + n < from->width ? n : from->width - i * n;
        double sum[3] = { 0 };
        for (int y = 0; y < below; y++)
            for (int x = 0; x < beside; x++)
                for (int c = 0; c < 3; c++)
                    sum[c] += (double)channel(
                        from, (size_t)(j * n + y) * (size_t)from->width + (size_t)(i * n + x), c,
                        changes);
        float *out = to->data + ((size_t)j * (size_t)to->width + (size_t)i) * 3;
        for (int c = 0; c < 3; c++) out[c] = (float)(sum[c] / (beside * below));
    }
}

static bool is_even(const WrImage *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height * 3;
    for (size_t i = 3; i < count; i++)
        if (image->data[i] != image->data[i - 3]) return false;
    return true;
}

static void find_poles(WrEnvironmentMap *s)
{
    const int w = s->image->width;
    for (int end = 0; end < 2; end++) {
        const float *row =
            s->image->data + (end ? (size_t)(s->image->height - 1) * (size_t)w * 3 : 0);
        for (int i = 0; i < w; i++)
            for (int c = 0; c < 3; c++) s->pole[end][c] += (double)row[3 * i + c] / w;
    }
}

/* Takes ownership of the picture, also on failure. */
static WrEnvironmentMap *new_map(WrImage *image, WrError *err)
{
    WrEnvironmentMap *s = wr_alloc(1, sizeof *s);
    s->refs = 1;
    s->image = image;
    image->type = WR_PIXEL_F32;
    s->even = is_even(image);
    find_poles(s);
    if (find_light(s, err)) return s;
    wr_environment_map_free(s);
    return NULL;
}

WrEnvironmentMap *wr_environment_map_new(const WrImage *image, WrEnvironmentMapChanges *changes,
                                         WrError *err)
{
    const int n = (image->width + WR_ENVIRONMENT_MAP_WIDTH - 1) / WR_ENVIRONMENT_MAP_WIDTH;
    const int w = (image->width + n - 1) / n, h = (image->height + n - 1) / n;
    WrImage *to = wr_image_new(w, h, 3, err);
    if (!to) return NULL;
    *changes = (WrEnvironmentMapChanges){ .reduced = n };
    for (int j = 0; j < h; j++) {
        if (wr_progress_stopped()) {
            wr_image_free(to);
            wr_fail(err, "cancelled");
            return NULL;
        }
        reduce_row(image, n, j, to, changes);
    }
    return new_map(to, err);
}

/* ---- built-in sets ---- */

/* 0 below a, 1 above b, smooth between. */
static double step(double a, double b, double x)
{
    const double t = fmin(fmax((x - a) / (b - a), 0), 1);
    return t * t * (3 - 2 * t);
}

static void add_light(double rgb[3], double share, double r, double g, double b)
{
    rgb[0] += share * r, rgb[1] += share * g, rgb[2] += share * b;
}

/* A panel with soft edges about a direction, with this half width and height.
   Gnomonic projection onto the panel's plane; |x|, |y| are tangents of angles from its middle. */
static inline double panel(WrVec3 d, WrVec3 middle, double wide, double high)
{
    if (!(v3_dot(d, middle) > 0)) return 0; /* behind it */
    const WrVec3 m = v3_unit(middle, (WrVec3){ 0, 1, 0 }), up = { 0, 1, 0 }, back = { 0, 0, 1 };
    const WrVec3 side = v3_unit(v3_cross(fabs(m.y) > 0.99 ? back : up, m), back);
    const WrVec3 above = v3_cross(m, side);
    const double ahead = v3_dot(d, m), soft = 0.04;
    if (!(ahead > 0.05)) return 0;
    const double x = fabs(v3_dot(d, side)) / ahead, y = fabs(v3_dot(d, above)) / ahead;
    return (1 - step(wide - soft, wide + soft, x)) * (1 - step(high - soft, high + soft, y));
}

/* A dim room with a large soft box at the upper left, a strip at the right and a card in front. */
static void studio(WrVec3 d, double rgb[3])
{
    const double up = step(-0.5, 1, d.y);
    rgb[0] = 0.05 + 0.09 * up, rgb[1] = 0.05 + 0.09 * up, rgb[2] = 0.055 + 0.095 * up;
    add_light(rgb, step(0.1, -0.6, d.y), 0.07, 0.062, 0.055); /* the floor */
    add_light(rgb, panel(d, (WrVec3){ -0.7, 0.8, 0.6 }, 0.55, 0.42), 6.2, 5.9, 5.5);
    add_light(rgb, panel(d, (WrVec3){ 0.95, 0.15, 0.15 }, 0.12, 0.85), 3.1, 3.5, 4.1);
    add_light(rgb, panel(d, (WrVec3){ 0.25, -0.25, 1 }, 0.4, 0.25), 0.35, 0.34, 0.33);
}

/* A clear day: haze above the horizon, brown ground below, the sun at the upper left. */
static void sky(WrVec3 d, double rgb[3])
{
    const WrVec3 sun = v3_unit((WrVec3){ -0.5, 0.6, 0.75 }, (WrVec3){ 0, 1, 0 });
    const double high = fmax(d.y, 0), haze = wr_exp2(-5.5 * high), c = v3_dot(d, sun);
    rgb[0] = 0.17 + 0.55 * haze, rgb[1] = 0.33 + 0.45 * haze, rgb[2] = 0.78 + 0.2 * haze;
    add_light(rgb, wr_exp2(-9 * (1 - c)), 0.45, 0.38, 0.26); /* brighter about the sun */
    const double ground = step(0.012, -0.012, d.y), far = wr_exp2(6 * fmin(d.y, 0));
    const double earth[3] = { 0.16 + 0.16 * far, 0.13 + 0.16 * far, 0.1 + 0.15 * far };
    for (int i = 0; i < 3; i++) rgb[i] += ground * (earth[i] - rgb[i]);
    add_light(rgb, (1 - ground) * step(0.9982, 0.9990, c), 330, 300, 250); /* 3 degrees */
}

/* Almost dark, with a long low window at the left: grazing light for reliefs. */
static void raking(WrVec3 d, double rgb[3])
{
    const double up = step(-1, 1, d.y);
    rgb[0] = 0.02 + 0.03 * up, rgb[1] = 0.022 + 0.034 * up, rgb[2] = 0.03 + 0.045 * up;
    add_light(rgb, panel(d, (WrVec3){ -1, 0.16, 0.12 }, 0.5, 0.13), 17, 15.5, 13.5);
    add_light(rgb, panel(d, (WrVec3){ 1, 0.3, -0.3 }, 0.3, 0.3), 0.28, 0.34, 0.45);
}

/* The CIE overcast sky, three times as bright above as at the horizon, over grey ground. */
static void overcast(WrVec3 d, double rgb[3])
{
    const double above = step(-0.03, 0.03, d.y), sky = 1.15 * (1 + 2 * fmax(d.y, 0)) / 3;
    rgb[0] = 0.97 * above * sky, rgb[1] = above * sky, rgb[2] = 1.04 * above * sky;
    add_light(rgb, 1 - above, 0.2, 0.195, 0.185);
}

/* A warm room with two panes of a tall window at the left and their light on the wall at the right. */
static void window(WrVec3 d, double rgb[3])
{
    const double up = step(-0.6, 1, d.y);
    rgb[0] = 0.09 + 0.06 * up, rgb[1] = 0.078 + 0.054 * up, rgb[2] = 0.066 + 0.048 * up;
    add_light(rgb, panel(d, (WrVec3){ -1, 0.28, 0.72 }, 0.2, 0.5), 5.2, 5.8, 6.4);
    add_light(rgb, panel(d, (WrVec3){ -1, 0.28, 0.12 }, 0.24, 0.56), 5.2, 5.8, 6.4);
    add_light(rgb, panel(d, (WrVec3){ 1, -0.1, 0.2 }, 0.8, 0.7), 0.2, 0.18, 0.15);
}

/* A sun just above the horizon at the left: a warm glow about it, blue above, dark ground. */
static void sunset(WrVec3 d, double rgb[3])
{
    const WrVec3 sun = v3_unit((WrVec3){ -0.85, 0.3, 0.5 }, (WrVec3){ 0, 1, 0 });
    const double c = v3_dot(d, sun), low = wr_exp2(-5 * fabs(d.y)), ground = step(0.02, -0.02, d.y);
    const double near = wr_exp2(-2.2 * (1 - c));
    rgb[0] = 0.15 + low * (0.16 + 0.8 * near), rgb[1] = 0.2 + low * (0.13 + 0.36 * near);
    rgb[2] = 0.38 + low * (0.14 + 0.06 * near);
    add_light(rgb, wr_exp2(-40 * (1 - c)), 3.2, 1.7, 0.7);
    const double earth[3] = { 0.1, 0.075, 0.06 };
    for (int i = 0; i < 3; i++) rgb[i] += ground * (earth[i] - rgb[i]);
    add_light(rgb, (1 - ground) * step(0.9982, 0.9990, c), 130, 70, 28); /* 3 degrees */
}

/* Linear light from the unit direction d. */
typedef void Light(WrVec3 d, double rgb[3]);
#define LIGHT(KIND, word, label, light) [WR_ENVIRONMENT_MAP_##KIND] = light,
static Light *const lights[WR_ENVIRONMENT_MAP_KINDS] = { WR_ENVIRONMENT_SETS(LIGHT) };

WrEnvironmentMap *wr_environment_map_built(WrEnvironmentMapKind kind, WrError *err)
{
    WrImage *to = wr_image_new(512, 256, 3, err);
    if (!to) return NULL;
    double across[512][2]; /* sine and cosine; the window shows its first picture after this */
    for (int i = 0; i < to->width; i++)
        wr_sincos_turns((i + 0.5) / to->width - 0.5, &across[i][0], &across[i][1]);
    for (int j = 0; j < to->height; j++) {
        double y, out_of_axis;
        wr_sincos_turns(0.5 * (1 - (j + 0.5) / to->height - 0.5), &y, &out_of_axis);
        for (int i = 0; i < to->width; i++) {
            double rgb[3];
            const WrVec3 d = { across[i][0] * out_of_axis, y, -across[i][1] * out_of_axis };
            lights[kind](d, rgb);
            float *out = to->data + ((size_t)j * (size_t)to->width + (size_t)i) * 3;
            for (int c = 0; c < 3; c++) out[c] = (float)rgb[c];
        }
    }
    return new_map(to, err);
}

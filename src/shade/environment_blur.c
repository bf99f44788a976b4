#include "shade/environment_blur.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/fft.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

/* The glossy prefilter int L w(l.r) / int w is a convolution on the sphere with a zonal lobe. By the
   Funk-Hecke theorem it multiplies each harmonic of order l by h_l = int w P_l / int w. Steps: Fourier
   transform of each row; for each wave m, projection on the associated Legendre functions of order l,
   multiplication, sum; inverse transform. Unlike sums over texels this is exact for every width of the lobe,
   and O(H^3). */
#define NODES 4096   /* for a lobe's integral */
#define NOTHING 1e-7 /* higher orders are dropped if all are below this */

/* The finest structure of a lobe of width alpha needs about fine / alpha texels around. */
int wr_blur_width(const WrEnvironmentBrdf *gloss, double fine)
{
    int width = 64;
    while (width < WR_BLUR_WIDEST && width * gloss->alpha < fine) width *= 2;
    return width;
}

/* ---- the lobe ---- */

/* 1 - c and the weight of a node: dense where the lobe is steep, and towards the back.
   With a2 = alpha^2, f = t^2 (3 - 2t) and w = 1 + f (a2 - 1): 1 - c = 2 a2 f / w, and d((1 - c) / 2) = a2 /
   w^2 * 6 t (1 - t) dt. 1 - c is computed directly because c = 1 - tiny has lost it. */
static void node(const WrEnvironmentBrdf *gloss, int i, double *below, double *weight)
{
    const double t = (i + 0.5) / NODES, f = t * t * (3 - 2 * t), a2 = gloss->alpha * gloss->alpha;
    const double w = 1 + f * (a2 - 1); /* (1 - c) / 2 = a2 f / w */
    *below = fmin(2 * a2 * f / w, 2);
    *weight = wr_environment_brdf_lobe(gloss, 1 - *below, *below) * a2 / (w * w) * 6 * t * (1 - t);
}

/* Legendre's recursion (l + 1) P_l+1 = (2l + 1) c P_l - l P_l-1, all nodes side by side; the division by the
   weights' own sum makes h_0 exactly 1, so a constant sky stays constant (HC115). */
void wr_blur_orders(const WrEnvironmentBrdf *gloss, int count, double *out)
{
    double *c = wr_alloc(4 * NODES, sizeof *c), *weight = c + NODES;
    double *now = weight + NODES, *before = now + NODES, whole = 0;
    for (int i = 0; i < NODES; i++) {
        double below;
        node(gloss, i, &below, &weight[i]);
        c[i] = 1 - below, before[i] = 0, now[i] = 1;
        whole += weight[i];
    }
    for (int l = 0; l < count; l++) {
        double sum = 0;
        for (int i = 0; i < NODES; i++) {
            const double next = ((2 * l + 1) * c[i] * now[i] - l * before[i]) / (l + 1);
            sum += weight[i] * now[i];
            before[i] = now[i], now[i] = next;
        }
        out[l] = sum / whole;
    }
    wr_free(c);
}

/* ---- waves along a row ---- */

typedef struct Complex {
    double re, im;
} Complex;

/* ---- the sphere ---- */

typedef struct Blur {
    const WrEnvironmentMap *from;
    int width, height, orders; /* waves 0 .. orders - 1 */
    int places;                /* samples averaged for a texel, per side */
    Complex *wave;             /* [3][orders][height]: transforms of rows, then blurred */
    WrFft *fft;                /* of a row */
    double *sine, *cosine,
        *weight;   /* [height] a row's angle from the upper pole; weight of its integral */
    double *order; /* [orders] */
    float *out;
} Blur;

static Complex *wave_of(const Blur *b, int c, int m)
{
    return b->wave + ((size_t)c * (size_t)b->orders + (size_t)m) * (size_t)b->height;
}

/* The mean of the surroundings over texel i, j.
   Weighted by the sine of the sample's angle from the pole, its share of solid angle. */
static void texel(const Blur *b, int i, int j, double rgb[3])
{
    const int n = b->places;
    double whole = 0;
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (int k = 0; k < n * n; k++) {
        const double u = (i + (k % n + 0.5) / n) / b->width;
        const double v = 1 - (j + (k / n + 0.5) / n) / b->height;
        double one[3], s, unused;
        wr_sincos_turns(0.5 * v, &s, &unused);
        wr_environment_map_at_place(b->from, u, v, one);
        for (int c = 0; c < 3; c++) rgb[c] += s * one[c];
        whole += s;
    }
    for (int c = 0; c < 3; c++) rgb[c] /= whole;
}

static void row_to_waves(int j, int worker, void *ctx)
{
    const Blur *b = ctx;
    (void)worker;
    if (wr_progress_stopped()) return;
    Complex *row = wr_alloc(3 * (size_t)b->width, sizeof *row);
    double *scratch = wr_alloc(wr_fft_scratch(b->fft), sizeof *scratch);
    for (int i = 0; i < b->width; i++) {
        double rgb[3];
        texel(b, i, j, rgb);
        for (int c = 0; c < 3; c++) row[c * b->width + i] = (Complex){ rgb[c], 0 };
    }
    for (int c = 0; c < 3; c++) {
        wr_fft_run(b->fft, &row[c * b->width].re, scratch);
        for (int m = 0; m < b->orders; m++) {
            const Complex x = row[c * b->width + m];
            wave_of(b, c, m)[j] = (Complex){ x.re / b->width, x.im / b->width };
        }
    }
    wr_free(scratch);
    wr_free(row);
}

/* The rows are real: wave -m is the conjugate of wave m. Negative results are ripples of the finite series and
   become 0. */
static void waves_to_row(int j, int worker, void *ctx)
{
    const Blur *b = ctx;
    const int w = b->width;
    (void)worker;
    Complex *row = wr_alloc((size_t)w, sizeof *row);
    double *scratch = wr_alloc(wr_fft_scratch(b->fft), sizeof *scratch);
    for (int c = 0; c < 3; c++) {
        memset(row, 0, (size_t)w * sizeof *row);
        for (int m = 0; m < b->orders; m++) {
            const Complex x = wave_of(b, c, m)[j];
            /* the inverse transform is computed with the conjugate */
            row[m] = (Complex){ x.re, -x.im };
            if (m > 0) row[w - m] = x;
        }
        wr_fft_run(b->fft, &row->re, scratch);
        for (int i = 0; i < w; i++)
            b->out[3 * ((size_t)j * (size_t)w + (size_t)i) + (size_t)c] = (float)fmax(row[i].re, 0);
    }
    wr_free(scratch);
    wr_free(row);
}

/* The harmonics of one wave, order by order: projected from the rows, multiplied, added back.
   P is normalised so that 2 pi int P^2 d(cos) = 1. wave[c][m][j]: rows run fastest, so projection and sum are
   contiguous. */
typedef struct Legendre {
    double *now, *before; /* [height] */
    Complex *sum;         /* [3][height] */
} Legendre;

/* P_mm = sqrt(1 / 4 pi prod (2k + 1) / (2k)) sin^m. In logarithms: sin^m of a high wave near a pole is below
   double's range; it contributes nothing there, and the recursion never raises it to a significant size. */
static void start_legendre(const Blur *b, int m, Legendre *p)
{
    double norm = -0.5 * wr_log2(4 * WR_PI); /* its logarithm: a high power underflows */
    for (int k = 1; k <= m; k++) norm += 0.5 * wr_log2((2 * k + 1) / (2.0 * k));
    for (int j = 0; j < b->height; j++) {
        p->before[j] = 0;
        p->now[j] = wr_exp2(fmax(norm + m * wr_log2(b->sine[j]), -1000));
    }
    memset(p->sum, 0, 3 * (size_t)b->height * sizeof *p->sum);
}

static void take_order(const Blur *b, int m, double by, Legendre *p)
{
    const int h = b->height;
    for (int c = 0; c < 3; c++) {
        const Complex *row = wave_of(b, c, m);
        Complex *out = p->sum + c * h, a = { 0, 0 };
        for (int j = 0; j < h; j++) {
            const double w = b->weight[j] * p->now[j];
            a.re += w * row[j].re, a.im += w * row[j].im;
        }
        a.re *= by, a.im *= by;
        for (int j = 0; j < h; j++) {
            out[j].re += a.re * p->now[j], out[j].im += a.im * p->now[j];
        }
    }
}

/* P_l = a (cos P_l-1 - d P_l-2), a^2 = (4 l^2 - 1) / (l^2 - m^2), d^2 = ((l-1)^2 - m^2) / (4 (l-1)^2 - 1):
   stable upwards. */
static void next_order(const Blur *b, int l, int m, Legendre *p)
{
    const double l2 = (double)l * l, m2 = (double)m * m, k2 = (double)(l - 1) * (l - 1);
    const double a = sqrt((4 * l2 - 1) / (l2 - m2)), d = sqrt((k2 - m2) / (4 * k2 - 1));
    for (int j = 0; j < b->height; j++) {
        const double next = a * (b->cosine[j] * p->now[j] - d * p->before[j]);
        p->before[j] = p->now[j], p->now[j] = next;
    }
}

static void blur_wave(int m, int worker, void *ctx)
{
    const Blur *b = ctx;
    const size_t h = (size_t)b->height;
    (void)worker;
    if (wr_progress_stopped()) return;
    Legendre p = { .now = wr_alloc(2 * h, sizeof(double)),
                   .sum = wr_alloc(3 * h, sizeof(Complex)) };
    p.before = p.now + h;
    start_legendre(b, m, &p);
    for (int l = m; l < b->orders; l++) {
        take_order(b, m, 2 * WR_PI * b->order[l], &p);
        next_order(b, l + 1, m, &p);
    }
    for (int c = 0; c < 3; c++) memcpy(wave_of(b, c, m), p.sum + (size_t)c * h, h * sizeof *p.sum);
    wr_free(p.now);
    wr_free(p.sum);
}

/* Fejer's weights: with them sums over the rows are the exact integrals of all orders below their
 * number.
 * w_j = 2/H (1 - 2 sum cos(2 k theta_j) / (4 k^2 - 1)), theta_j = pi (j + 1/2) / H. */
static void fill_rows(Blur *b)
{
    for (int j = 0; j < b->height; j++) {
        const double turns = 0.5 * (j + 0.5) / b->height;
        double sum = 1, s, c;
        wr_sincos_turns(turns, &b->sine[j], &b->cosine[j]);
        for (int k = 1; k <= b->height / 2; k++) {
            wr_sincos_turns(2 * k * turns, &s, &c);
            sum -= 2 * c / (4.0 * k * k - 1);
        }
        b->weight[j] = 2 * sum / b->height;
    }
}

static int least_texels(int texels, int parts)
{
    return (texels + parts - 1) / parts > 1 ? (texels + parts - 1) / parts : 1;
}

static void fill_orders(Blur *b, const WrEnvironmentBrdf *gloss)
{
    wr_blur_orders(gloss, b->height, b->order);
    b->orders = b->height;
    while (b->orders > 1 && fabs(b->order[b->orders - 1]) < NOTHING) b->orders--;
}

bool wr_environment_map_blur(const WrEnvironmentMap *map, const WrEnvironmentBrdf *gloss, int width,
                             WrPool *pool, float *out, WrError *err)
{
    const size_t h = (size_t)width / 2;
    Blur b = { .from = map, .width = width, .height = width / 2, .out = out };
    b.places = least_texels(map->image->width, width);
    b.sine = wr_alloc(4 * h, sizeof *b.sine);
    b.cosine = b.sine + h, b.weight = b.cosine + h, b.order = b.weight + h;
    fill_rows(&b);
    fill_orders(&b, gloss);
    b.fft = wr_fft_new(width, err);
    if (b.fft)
        b.wave =
            wr_try_alloc(3 * (size_t)b.orders * h, sizeof *b.wave, "blurred surroundings", err);
    if (b.wave) {
        wr_pool_run(pool, b.height, row_to_waves, &b);
        wr_pool_run(pool, b.orders, blur_wave, &b);
        wr_pool_run(pool, b.height, waves_to_row, &b);
    }
    const bool good = b.wave && (!wr_progress_stopped() || wr_fail(err, "cancelled"));
    wr_free(b.wave);
    wr_fft_free(b.fft);
    wr_free(b.sine);
    return good;
}

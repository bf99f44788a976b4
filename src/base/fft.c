#include "base/fft.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"

#include <stdint.h>
#include <string.h>

#define FACTORS 16

/* Mixed-radix Stockham transform of n complex numbers (re, im interleaved, double) with factors 2, 3, 4, 5, 7, 11, 13; other
   lengths by Bluestein's convolution at a power of two >= 2 n - 1. Twiddle factors come from wr_sincos_turns, which is exact
   at multiples of a quarter turn and the same on all processors. A plan is read-only after its creation: threads share it,
   each with its own scratch. */
struct WrFft {
    int n, passes;
    int factor[FACTORS];
    double *turn;   /* [n][2] exp(-2 pi i k / n) */
    double *half;   /* [n][2] exp(-pi i k / (2 n)), for the cosine transform */
    WrFft *inner;   /* for Bluestein: transform of a power-of-two length; else NULL */
    double *chirp;  /* [n][2] exp(-pi i k^2 / n) */
    double *answer; /* [inner->n][2] transform of the conjugate chirp, divided by inner->n */
};

/* ---- plans ---- */

/* Radix 4 comes first: its passes are the cheapest. */
static bool factorise(WrFft *fft)
{
    static const int radices[] = { 4, 2, 3, 5, 7, 11, 13 };
    int rest = fft->n;
    for (size_t k = 0; k < sizeof radices / sizeof *radices; k++)
        while (rest % radices[k] == 0) {
            fft->factor[fft->passes++] = radices[k];
            rest /= radices[k];
        }
    return rest == 1;
}

/* exp(-2 pi i k / n) for k = 0, 1, ... */
static double *turns_of(int count, double n, WrError *err)
{
    double *turn = wr_try_alloc((size_t)count, 2 * sizeof *turn, "a Fourier transform", err);
    for (int k = 0; turn && k < count; k++) {
        double sine, cosine;
        wr_sincos_turns(k / n, &sine, &cosine);
        turn[2 * k] = cosine;
        turn[2 * k + 1] = -sine;
    }
    return turn;
}

static bool plan_chirp(WrFft *fft, WrError *err)
{
    int n = fft->n, size = 1;
    while (size < 2 * n - 1) size *= 2;
    fft->inner = wr_fft_new(size, err);
    fft->chirp = wr_try_alloc((size_t)n, 2 * sizeof *fft->chirp, "a Fourier transform", err);
    fft->answer = wr_try_alloc((size_t)size, 2 * sizeof *fft->answer, "a Fourier transform", err);
    if (!fft->inner || !fft->chirp || !fft->answer) return false;
    for (int k = 0; k < n; k++) {
        double sine, cosine;
        /* exp(-pi i k^2 / n) has the period 2 n in k^2: reduced as an integer, since k^2 / n in floating point loses the
           digits of the angle. */
        wr_sincos_turns((double)((int64_t)k * k % (2 * n)) / (2.0 * n), &sine, &cosine);
        fft->chirp[2 * k] = cosine;
        fft->chirp[2 * k + 1] = -sine;
        for (int side = 0; side < 2; side++) {
            int at = side && k > 0 ? size - k : k;
            fft->answer[2 * at] = cosine / size;
            fft->answer[2 * at + 1] = sine / size;
        }
    }
    double *scratch =
        wr_try_alloc(wr_fft_scratch(fft->inner), sizeof *scratch, "a Fourier transform", err);
    if (scratch) wr_fft_run(fft->inner, fft->answer, scratch);
    wr_free(scratch);
    return scratch != NULL;
}

WrFft *wr_fft_new(int n, WrError *err)
{
    WrFft *fft = wr_alloc(1, sizeof *fft);
    fft->n = n;
    bool plain = factorise(fft);
    fft->turn = turns_of(n, n, err);
    fft->half = turns_of(n, 4.0 * n, err);
    if (fft->turn && fft->half && (plain || plan_chirp(fft, err))) return fft;
    wr_fft_free(fft);
    return NULL;
}

void wr_fft_free(WrFft *fft)
{
    if (!fft) return;
    wr_fft_free(fft->inner);
    wr_free(fft->turn);
    wr_free(fft->half);
    wr_free(fft->chirp);
    wr_free(fft->answer);
    wr_free(fft);
}

size_t wr_fft_scratch(const WrFft *fft)
{
    return fft->inner ? 4 * (size_t)fft->inner->n : 2 * (size_t)fft->n;
}

/* ---- passes ---- With n = r m and the elements `stride` apart, one pass computes for each lane q:

     out[q + stride (r p + k)] = w^(p k) sum over j of in[q + stride (p + m j)] exp(-2 pi i j k / r),

   w = exp(-2 pi i / n). After all passes the results are in natural order (Stockham: no bit reversal). */

typedef struct Pass {
    int radix, m, stride;
    const double *in;
    double *out;
} Pass;

static void pass_2(const WrFft *fft, const Pass *s)
{
    for (int p = 0; p < s->m; p++) {
        const double *w = fft->turn + 2 * (size_t)p * (size_t)s->stride;
        const double *a = s->in + 2 * (size_t)p * (size_t)s->stride;
        const double *b = a + 2 * (size_t)s->m * (size_t)s->stride;
        double *out = s->out + 4 * (size_t)p * (size_t)s->stride;
        double *up = out + 2 * (size_t)s->stride;
        for (int q = 0; q < 2 * s->stride; q += 2) {
            double re = a[q] - b[q], im = a[q + 1] - b[q + 1];
            out[q] = a[q] + b[q];
            out[q + 1] = a[q + 1] + b[q + 1];
            up[q] = re * w[0] - im * w[1];
            up[q + 1] = re * w[1] + im * w[0];
        }
    }
}

/* Radix 4 needs no multiplications within the butterfly: its roots of unity are 1, -i, -1, i, which swap and negate parts. */
static void pass_4(const WrFft *fft, const Pass *s)
{
    size_t lane = 2 * (size_t)s->stride, far = lane * (size_t)s->m;
    for (int p = 0; p < s->m; p++) {
        const double *w1 = fft->turn + lane * (size_t)p, *w2 = fft->turn + 2 * lane * (size_t)p;
        const double *w3 = fft->turn + 3 * lane * (size_t)p;
        const double *a = s->in + lane * (size_t)p, *b = a + far, *c = b + far, *d = c + far;
        double *out = s->out + 4 * lane * (size_t)p;
        for (size_t q = 0; q < lane; q += 2) {
            double sr = a[q] + c[q], si = a[q + 1] + c[q + 1];
            double dr = a[q] - c[q], di = a[q + 1] - c[q + 1];
            double tr = b[q] + d[q], ti = b[q + 1] + d[q + 1];
            double er = b[q] - d[q], ei = b[q + 1] - d[q + 1]; /* times -i: (ei, -er) */
            double x1 = dr + ei, y1 = di - er, x2 = sr - tr, y2 = si - ti;
            double x3 = dr - ei, y3 = di + er;
            out[q] = sr + tr;
            out[q + 1] = si + ti;
            out[lane + q] = x1 * w1[0] - y1 * w1[1];
            out[lane + q + 1] = x1 * w1[1] + y1 * w1[0];
            out[2 * lane + q] = x2 * w2[0] - y2 * w2[1];
            out[2 * lane + q + 1] = x2 * w2[1] + y2 * w2[0];
            out[3 * lane + q] = x3 * w3[0] - y3 * w3[1];
            out[3 * lane + q + 1] = x3 * w3[1] + y3 * w3[0];
        }
    }
}

static void pass_any(const WrFft *fft, const Pass *s)
{
    size_t lane = 2 * (size_t)s->stride;
    int r = s->radix;
    for (int p = 0; p < s->m; p++)
        for (int k = 0; k < r; k++) {
            const double *w = fft->turn + lane * (size_t)p * (size_t)k;
            double *out = s->out + lane * ((size_t)r * (size_t)p + (size_t)k);
            for (size_t q = 0; q < lane; q += 2) {
                double re = 0.0, im = 0.0;
                for (int j = 0; j < r; j++) {
                    const double *t = fft->turn + 2 * (size_t)(j * k % r) * (size_t)(fft->n / r);
                    const double *x = s->in + lane * ((size_t)p + (size_t)s->m * (size_t)j) + q;
                    re += x[0] * t[0] - x[1] * t[1];
                    im += x[0] * t[1] + x[1] * t[0];
                }
                out[q] = re * w[0] - im * w[1];
                out[q + 1] = re * w[1] + im * w[0];
            }
        }
}

static void run_passes(const WrFft *fft, double *z, double *scratch)
{
    int rest = fft->n, stride = 1;
    double *from = z, *to = scratch;
    for (int k = 0; k < fft->passes; k++) {
        int r = fft->factor[k];
        rest /= r;
        Pass pass = { r, rest, stride, from, to };
        if (r == 4) pass_4(fft, &pass);
        else if (r == 2) pass_2(fft, &pass);
        else pass_any(fft, &pass);
        stride *= r;
        double *swap = from;
        from = to;
        to = swap;
    }
    if (from != z) memcpy(z, from, (size_t)fft->n * 2 * sizeof *z);
}

/* Bluestein: j k = (j^2 + k^2 - (k - j)^2)/2, so X[k] = c[k] sum of (x[j] c[j]) / c[k - j], a
 * convolution. Its inverse transform is computed as a forward transform of conjugates. */
static void run_chirp(const WrFft *fft, double *z, double *scratch)
{
    int n = fft->n, size = fft->inner->n;
    double *x = scratch, *more = scratch + 2 * (size_t)size;
    memset(x, 0, (size_t)size * 2 * sizeof *x);
    for (int k = 0; k < n; k++) {
        const double *c = fft->chirp + 2 * k;
        x[2 * k] = z[2 * k] * c[0] - z[2 * k + 1] * c[1];
        x[2 * k + 1] = z[2 * k] * c[1] + z[2 * k + 1] * c[0];
    }
    wr_fft_run(fft->inner, x, more);
    for (int k = 0; k < size; k++) {
        const double *a = fft->answer + 2 * k;
        double re = x[2 * k] * a[0] - x[2 * k + 1] * a[1];
        x[2 * k + 1] = -(x[2 * k] * a[1] + x[2 * k + 1] * a[0]);
        x[2 * k] = re;
    }
    wr_fft_run(fft->inner, x, more);
    for (int k = 0; k < n; k++) {
        const double *c = fft->chirp + 2 * k;
        z[2 * k] = x[2 * k] * c[0] + x[2 * k + 1] * c[1];
        z[2 * k + 1] = x[2 * k] * c[1] - x[2 * k + 1] * c[0];
    }
}

void wr_fft_run(const WrFft *fft, double *z, double *scratch)
{
    if (fft->inner) run_chirp(fft, z, scratch);
    else run_passes(fft, z, scratch);
}

/* ---- real lines: two of them form one complex line ---- */

/* Hartley transform: H[k] = Re A[k] - Im A[k], where A[k] = (Z[k] + conj Z[-k])/2, B[k] = (Z[k] - conj
 * Z[-k])/2i. It is its own inverse up to the factor n. */
static void hartley(const WrFft *fft, double *a, double *b, double *scratch)
{
    int n = fft->n;
    double *z = scratch;
    for (int k = 0; k < n; k++) {
        z[2 * k] = a[k];
        z[2 * k + 1] = b[k];
    }
    wr_fft_run(fft, z, scratch + 2 * n);
    for (int k = 0; k < n; k++) {
        int m = k ? n - k : 0;
        a[k] = 0.5 * ((z[2 * k] + z[2 * m]) - (z[2 * k + 1] - z[2 * m + 1]));
        b[k] = 0.5 * ((z[2 * k + 1] + z[2 * m + 1]) + (z[2 * k] - z[2 * m]));
    }
}

/* Index to which x[j] moves: even indices forwards, then odd ones backwards (Makhoul 1980). The cosine transform of n numbers
   is then one complex transform of n, not of 2 n or 4 n. */
static int fold(int j, int n)
{
    return j % 2 == 0 ? j / 2 : n - 1 - j / 2;
}

/* C[k] = sum of x[j] cos(pi (j + 1/2) k / n) = Re(exp(-pi i k / 2n) V[k]), V of the folded line. */
static void cosine_forward(const WrFft *fft, double *a, double *b, double *scratch)
{
    int n = fft->n;
    double *z = scratch;
    for (int j = 0; j < n; j++) {
        z[2 * fold(j, n)] = a[j];
        z[2 * fold(j, n) + 1] = b[j];
    }
    wr_fft_run(fft, z, scratch + 2 * n);
    for (int k = 0; k < n; k++) {
        int m = k ? n - k : 0;
        const double *w = fft->half + 2 * k;
        double ar = 0.5 * (z[2 * k] + z[2 * m]), ai = 0.5 * (z[2 * k + 1] - z[2 * m + 1]);
        double br = 0.5 * (z[2 * k + 1] + z[2 * m + 1]), bi = 0.5 * (z[2 * m] - z[2 * k]);
        a[k] = ar * w[0] - ai * w[1];
        b[k] = br * w[0] - bi * w[1];
    }
}

/* V[k] = exp(pi i k / 2n) (C[k] - i C[n-k]), C[n] = 0. The inverse is a forward transform of the
 * conjugate. */
static void cosine_back(const WrFft *fft, double *a, double *b, double *scratch)
{
    int n = fft->n;
    double *z = scratch;
    for (int k = 0; k < n; k++) {
        const double *w = fft->half + 2 * k; /* cos, -sin */
        double ac = a[k], as = k ? a[n - k] : 0.0, bc = b[k], bs = k ? b[n - k] : 0.0;
        double ar = ac * w[0] - as * w[1], ai = -as * w[0] - ac * w[1];
        double br = bc * w[0] - bs * w[1], bi = -bs * w[0] - bc * w[1];
        z[2 * k] = ar - bi; /* A + iB */
        z[2 * k + 1] = -(ai + br);
    }
    wr_fft_run(fft, z, scratch + 2 * n);
    for (int j = 0; j < n; j++) {
        a[j] = z[2 * fold(j, n)] / n;
        b[j] = -z[2 * fold(j, n) + 1] / n;
    }
}

void wr_line_forward(const WrFft *fft, WrEnds ends, double *a, double *b, double *scratch)
{
    if (ends == WR_ENDS_RING) hartley(fft, a, b, scratch);
    else cosine_forward(fft, a, b, scratch);
}

void wr_line_back(const WrFft *fft, WrEnds ends, double *a, double *b, double *scratch)
{
    if (ends == WR_ENDS_FREE) {
        cosine_back(fft, a, b, scratch);
        return;
    }
    hartley(fft, a, b, scratch);
    for (int k = 0; k < fft->n; k++) {
        a[k] /= fft->n;
        b[k] /= fft->n;
    }
}

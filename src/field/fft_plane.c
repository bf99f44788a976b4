/* Transforms of real planes, line by line. Columns are gathered a few at a time, so that whole cache
   lines are used. */
#include "field/fft_plane.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"

#include <string.h>

#define GROUP 8 /* lines of a piece of work */

typedef struct Lines {
    const WrPlane *plane;
    int axis, n, count; /* lines of n numbers */
    const WrFft *fft;
    WrLinePair pair;
    const void *ctx;
    double *memory; /* [threads][each] */
    size_t each;
} Lines;

static void move_lines(const Lines *lines, int first, int count, double *packed, bool back)
{
    const WrPlane *p = lines->plane;
    size_t across = (size_t)p->width;
    for (int j = 0; j < lines->n; j++)
        for (int k = 0; k < count; k++) {
            double *there = lines->axis == 0 ? p->z + (size_t)(first + k) * across + (size_t)j
                                             : p->z + (size_t)j * across + (size_t)(first + k);
            double *here = packed + (size_t)k * (size_t)lines->n + (size_t)j;
            if (back) *there = *here;
            else *here = *there;
        }
}

static void do_group(int index, int worker, void *ctx)
{
    const Lines *lines = ctx;
    if (wr_progress_cancelled(lines->plane->progress)) return;
    double *packed = lines->memory + (size_t)worker * lines->each;
    size_t n = (size_t)lines->n;
    int first = index * GROUP;
    int count = lines->count - first < GROUP ? lines->count - first : GROUP;
    move_lines(lines, first, count, packed, false);
    if (count % 2) memset(packed + (size_t)count * n, 0, n * sizeof *packed);
    for (int k = 0; k < count; k += 2)
        lines->pair(lines->ctx, lines->fft, packed + (size_t)k * n, packed + (size_t)(k + 1) * n,
                    packed + GROUP * n);
    move_lines(lines, first, count, packed, true);
}

bool wr_plane_lines(const WrPlane *plane, int axis, WrLinePair pair, const void *ctx, WrError *err)
{
    int n = axis == 0 ? plane->width : plane->height;
    WrFft *fft = wr_fft_new(n, err);
    if (!fft) return false;
    Lines lines = { .plane = plane,
                    .axis = axis,
                    .n = n,
                    .count = axis == 0 ? plane->height : plane->width,
                    .fft = fft,
                    .pair = pair,
                    .ctx = ctx,
                    .each = ((size_t)GROUP + 2) * (size_t)n + wr_fft_scratch(fft) };
    lines.memory = wr_try_alloc((size_t)wr_pool_threads(plane->pool), lines.each * sizeof(double),
                                "a Fourier transform", err);
    bool good = lines.memory != NULL;
    if (good) {
        wr_pool_run(plane->pool, (lines.count + GROUP - 1) / GROUP, do_group, &lines);
        if (wr_progress_cancelled(plane->progress)) good = wr_fail(err, "cancelled");
    }
    wr_free(lines.memory);
    wr_fft_free(fft);
    return good;
}

static void forward(const void *ctx, const WrFft *fft, double *a, double *b, double *scratch)
{
    wr_line_forward(fft, *(const WrEnds *)ctx, a, b, scratch);
}

static void back(const void *ctx, const WrFft *fft, double *a, double *b, double *scratch)
{
    wr_line_back(fft, *(const WrEnds *)ctx, a, b, scratch);
}

/* ---- slopes ---- */

/* Frequency of k on a ring of n: radians per texel of the smoothest function; the highest of an even n
 * has no slope at the texels. */
static double frequency(int k, int n)
{
    int m = 2 * k < n ? k : 2 * k == n ? 0 : k - n;
    return 2.0 * WR_PI * m / n;
}

typedef struct Turned {
    WrSlopes slopes;
    WrEnds ends;
    int n;
} Turned;

/* Hartley transform of the slope: -w[k] H[n-k]; of the transposed slope: + w[k] H[n-k]. */
static void turn_smooth(const Turned *t, const WrFft *fft, double *line[2], double *scratch)
{
    int n = t->n;
    wr_line_forward(fft, WR_ENDS_RING, line[0], line[1], scratch);
    for (int s = 0; s < 2; s++) {
        double *h = line[s];
        h[0] = 0.0;
        for (int k = 1; 2 * k <= n; k++) {
            double low = h[k], high = h[n - k], w = frequency(k, n);
            h[k] = w * high;
            h[n - k] = -w * low;
        }
    }
    wr_line_back(fft, WR_ENDS_RING, line[0], line[1], scratch);
}

static void turn_slope(const void *ctx, const WrFft *fft, double *a, double *b, double *scratch)
{
    const Turned *t = ctx;
    double *line[2] = { a, b };
    int n = t->n;
    if (t->slopes == WR_SLOPES_SMOOTH) {
        turn_smooth(t, fft, line, scratch);
        return;
    }
    for (int s = 0; s < 2; s++) {
        double *z = line[s];
        memcpy(scratch, z, (size_t)n * sizeof *z);
        if (t->slopes == WR_SLOPES_CENTRAL) {
            for (int i = 0; i < n; i++)
                z[i] = 0.5 * (scratch[(i + n - 1) % n] - scratch[(i + 1) % n]);
            continue;
        }
        if (t->ends == WR_ENDS_FREE) scratch[n - 1] = 0.0;
        for (int i = 0; i < n; i++) z[i] = scratch[(i + n - 1) % n] - scratch[i];
    }
}

bool wr_plane_slope_adjoint(const WrPlane *plane, int axis, WrSlopes slopes, WrError *err)
{
    const Turned turned = { slopes, plane->ends[axis], axis == 0 ? plane->width : plane->height };
    return wr_plane_lines(plane, axis, turn_slope, &turned, err);
}

/* D^T D for the function of frequency k. Exactly 0 where the slope is 0.
     smooth   w^2
     central  sin^2(2 pi k / n)
     step     4 sin^2(pi k / n) on a ring, 4 sin^2(pi k / 2 n) for free ends, where the transform is a cosine transform */
static double stiffness(WrSlopes slopes, WrEnds ends, int k, int n)
{
    double sine, cosine, turns = ends == WR_ENDS_RING ? (double)k / n : 0.5 * k / n;
    if (slopes == WR_SLOPES_SMOOTH) {
        double w = frequency(k, n);
        return w * w;
    }
    wr_sincos_turns(slopes == WR_SLOPES_CENTRAL ? turns : 0.5 * turns, &sine, &cosine);
    return slopes == WR_SLOPES_CENTRAL ? sine * sine : 4.0 * sine * sine;
}

static double *stiffnesses(const WrPlane *plane, int axis, WrSlopes slopes, WrError *err)
{
    int n = axis == 0 ? plane->width : plane->height;
    double *all = wr_try_alloc((size_t)n, sizeof *all, "a Fourier transform", err);
    for (int k = 0; all && k < n; k++) all[k] = stiffness(slopes, plane->ends[axis], k, n);
    return all;
}

/* True if a map does not determine the function of frequency k of this axis; `other` is the stiffness
   along the other axis. This is the alternating function on a ring of even length, whose slopes are 0
   at every texel. Only the other axis' slopes contain it, and are divided by a small number for long
   waves:

     smooth   always excluded: no surface is rough enough to have such slopes, and noise of the map at that frequency
              would be amplified a hundred times over its neighbours, to a comb
     central  included if it is determined as well as its neighbours: then a table may contain it, and the map has
              its exact slopes */
static bool unseen(WrSlopes slopes, const double *stiffness, int k, double other)
{
    if (k == 0 || stiffness[k] > 1e-20) return false;
    return slopes == WR_SLOPES_SMOOTH || other < stiffness[1];
}

/* Both operators are diagonal in the transform of each axis: z(k,l) = rhs(k,l) / (s_u(k) + s_v(l)). The mean (k = l = 0) is
   not determined by slopes and becomes 0. */
bool wr_plane_solve(const WrPlane *plane, const WrSlopes slopes[2], WrError *err)
{
    double *u = stiffnesses(plane, 0, slopes[0], err), *v = stiffnesses(plane, 1, slopes[1], err);
    bool good = u && v && wr_plane_lines(plane, 0, forward, &plane->ends[0], err) &&
                wr_plane_lines(plane, 1, forward, &plane->ends[1], err);
    if (good) {
        for (int j = 0; j < plane->height; j++)
            for (int i = 0; i < plane->width; i++) {
                double s = u[i] + v[j], *z = plane->z + (size_t)j * (size_t)plane->width + i;
                const bool none = unseen(slopes[0], u, i, v[j]) || unseen(slopes[1], v, j, u[i]);
                *z = s > 1e-20 && !none ? *z / s : 0.0;
            }
        good = wr_plane_lines(plane, 1, back, &plane->ends[1], err) &&
               wr_plane_lines(plane, 0, back, &plane->ends[0], err);
    }
    wr_free(u);
    wr_free(v);
    return good;
}

/* With L = Du^T Du + Dv^T Dv on the torus, L of the result should equal that of z without the jumps at its
   edges; so L s of the smooth component s consists of these jumps, on both sides of the edges. */
bool wr_plane_make_periodic(const WrPlane *plane, WrError *err)
{
    size_t w = (size_t)plane->width, h = (size_t)plane->height;
    double *s = wr_try_alloc(w * h, sizeof *s, "a seamless picture", err);
    if (!s) return false;
    const double *z = plane->z;
    for (size_t j = 0; j < h && plane->ends[0] == WR_ENDS_RING; j++) {
        double jump = z[j * w] - z[j * w + w - 1];
        s[j * w] += jump;
        s[j * w + w - 1] -= jump;
    }
    for (size_t i = 0; i < w && plane->ends[1] == WR_ENDS_RING; i++) {
        double jump = z[i] - z[(h - 1) * w + i];
        s[i] += jump;
        s[(h - 1) * w + i] -= jump;
    }
    WrPlane smooth = *plane;
    smooth.z = s;
    bool good = wr_plane_solve(&smooth, (WrSlopes[]){ WR_SLOPES_STEP, WR_SLOPES_STEP }, err);
    for (size_t k = 0; good && k < w * h; k++) plane->z[k] -= s[k];
    wr_free(s);
    return good;
}

/* Test for slopes being the gradient of one height field. */
#include "export/check_internal.h"

#include "image/image.h"
#include "scene/normal_map.h"

#include <math.h>

#define CLEARLY 4 /* factor over the effect of rounding on the sum */

/* Sums over D_v p and D_u q: squares, their product, and the mean effect of rounding on the squares. */
typedef struct Sums {
    double pp, qq, pq, noise_p, noise_q;
} Sums;

/* Slopes of texel (i, j); returns the mean square of the error caused by rounding a code by `step`. */
static double slopes_at(const WrImage *map, int i, int j, double step, double *p, double *q)
{
    const float *n = map->data + 3 * ((size_t)j * (size_t)map->width + (size_t)i);
    const double error = step / ((double)n[2] * (double)n[2]);
    wr_normal_map_slopes(n, p, q);
    return error * error / 12;
}

static void add_texel(const WrImage *map, int i, int j, double step, Sums *sums)
{
    double p[2], q[2], other;
    sums->noise_p += slopes_at(map, i, j - 1, step, &p[0], &other);
    sums->noise_p += slopes_at(map, i, j + 1, step, &p[1], &other);
    sums->noise_q += slopes_at(map, i + 1, j, step, &other, &q[0]);
    sums->noise_q += slopes_at(map, i - 1, j, step, &other, &q[1]);
    const double dp = p[0] - p[1], dq = q[0] - q[1];
    sums->pp += dp * dp;
    sums->qq += dq * dq;
    sums->pq += dp * dq;
}

void wr_check_curl(const WrImage *map, double step, WrCheckNormals *normals)
{
    Sums s = { 0 };
    for (int j = 1; j < map->height - 1; j++)
        for (int i = 1; i < map->width - 1; i++) add_texel(map, i, j, step, &s);
    const double pp = s.pp - s.noise_p, qq = s.qq - s.noise_q;
    normals->curl_known = pp > CLEARLY * s.noise_p || qq > CLEARLY * s.noise_q;
    const double both = pp > 0 && qq > 0 ? s.pq / sqrt(pp * qq) : 0;
    normals->curl = sqrt(1 - fmax(-1, fmin(1, both)));
}

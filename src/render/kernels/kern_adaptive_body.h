/* kern_adaptive_body.h - pixels predicted from one sample each, with an error estimate (adaptive.c). Part of
   kern_body.h; single precision only.

   Over a pixel, quadratic light f = f0 + .. + fxx x^2 / 2 + fyy y^2 / 2 has the mean f0 + (fxx + fyy) / 24;
   samples in K x K cells have 1 - 1 / K^2 of that correction. Second differences of neighbours are fxx and fyy
   where light is smooth. It is not where third differences are large: at a step H they reach 2 H and the mean is
   off by H / 2; at a kink J, as between texels, they reach J and it is off by J / 12. */

#define MIXED 1e9f /* error if a neighbour is on the other side of the outline */

/* Third differences along both axes, over all channels; `mixed` weights the fourth channel, coverage. */
FLAT static void third_differences(const float *const restrict row[5], int count, float slope,
                                   float *restrict out)
{
    const float *far = row[0] + 8, *up = row[1], *mid = row[2], *low = row[3], *end = row[4] + 8;
    SIMD for (int i = 0; i < 4 * count; i++)
    {
        const float f = mid[i + 8], a = mid[i + 4], b = mid[i + 12];
        const float c = up[i + 8], d = low[i + 8];
        const float x0 = r_abs((b - mid[i]) - 3.0f * (f - a));
        const float x1 = r_abs((mid[i + 16] - a) - 3.0f * (b - f));
        const float y0 = r_abs((d - far[i]) - 3.0f * (f - c));
        const float y1 = r_abs((end[i] - c) - 3.0f * (d - f));
        const float lean = r_abs(b - a) + r_abs(d - c);
        const float beside = (r_abs(a - f) + r_abs(b - f)) + (r_abs(c - f) + r_abs(d - f));
        const float across = (r_abs(up[i + 4] - f) + r_abs(up[i + 12] - f)) +
                             (r_abs(low[i + 4] - f) + r_abs(low[i + 12] - f));
        const float mixed = (i & 3) == 3 ? MIXED * (beside + across) : 0.0f;
        out[i] = (larger(x0, x1) + larger(y0, y1)) * 0.125f + slope * lean + mixed;
    }
}

FLAT static void kern_smooth(const float *const row[5], int count, float weight, float slope,
                             float *restrict rgba, float *restrict off)
{
    float of[4 * WR_SPAN];
    const float *up = row[1] + 8, *mid = row[2], *low = row[3] + 8;
    third_differences(row, count, slope, of);
    SIMD for (int i = 0; i < 4 * count; i++)
    {
        const float f = mid[i + 8], about = (mid[i + 4] + mid[i + 12]) + (up[i] + low[i]);
        rgba[i] = f + weight * (about - 4.0f * f);
    }
    SIMD for (int x = 0; x < count; x++)
    {
        const float r = of[4 * x], g = of[4 * x + 1], b = of[4 * x + 2], a = of[4 * x + 3];
        const float sum = (r + g) + (b + a);
        off[x] = wr_is_finite_f(sum) ? larger(larger(r, g), larger(b, a)) : FLT_MAX;
    }
}

FLAT static void kern_texels(const float *const row[3], int count, const float of[2],
                             float *restrict out)
{
    const float *up = row[0], *mid = row[1], *low = row[2];
    const float by_u = 0.5f * of[0], by_v = 0.5f * of[1];
    SIMD for (int x = 0; x < count; x++)
    {
        const int i = 2 * x;
        const float u = r_abs(mid[i + 4] - mid[i]) + r_abs(low[i + 2] - up[i + 2]);
        const float v = r_abs(mid[i + 5] - mid[i + 1]) + r_abs(low[i + 3] - up[i + 3]);
        out[x] = larger(by_u * u, by_v * v);
    }
}

#include "noise/lattice.h"

#include "base/exactmath.h"
#include "base/enum_rows.h"

#include <math.h>
#include <string.h>

const char *const wr_fade_words[] = { WR_FADES(WR_WORD) NULL };

/* alpha(x) = sum c[k] x^k. All satisfy alpha(1 - x) = 1 - alpha(x), so the weights of corners sum to 1 (L10).
   continuity is the number of continuous derivatives across lattice points (L8). */
WR_ROWS(wr_fades);
const WrFadeInfo wr_fades[WR_FADE_COUNT] = {
    [WR_ROW(WR_FADE_LINEAR)] = { .continuity = 0, .c = { 0, 1, 0, 0, 0, 0 } },
    [WR_ROW(WR_FADE_CUBIC)] = { .continuity = 1, .c = { 0, 0, 3, -2, 0, 0 } },
    [WR_ROW(WR_FADE_QUINTIC)] = { .continuity = 2, .c = { 0, 0, 0, 10, -15, 6 } },
};
WR_ROWS_END(wr_fades, WR_FADE_COUNT);

uint32_t wr_lattice_hash(uint32_t seed, const uint32_t *c, int dim)
{
    uint32_t h = wr_lattice_hash_start(seed);
    for (int a = 0; a < dim; a++) h = wr_lattice_hash_link(h, wr_lattice_hash_part(c[a], a));
    return h;
}

/* cos and sin of 11.25 and 33.75 degrees
   Sets of gradients without a preferred axis: 16 directions of a circle at odd multiples of 11.25 degrees; the
   middles of a cube's edges (length sqrt 2) and of a tesseract's (sqrt 3). */
#define C1 0.98078528040323044
#define S1 0.19509032201612827
#define C3 0.83146961230254524
#define S3 0.55557023301960222

static const double set_1d[16][1] = {
    { 0.125 },  { 0.25 },  { 0.375 },  { 0.5 },  { 0.625 },  { 0.75 },  { 0.875 },  { 1.0 },
    { -0.125 }, { -0.25 }, { -0.375 }, { -0.5 }, { -0.625 }, { -0.75 }, { -0.875 }, { -1.0 },
};
static const double set_2d[16][2] = {
    { C1, S1 },  { C3, S3 },  { S3, C3 },   { S1, C1 },   { -S1, C1 },  { -S3, C3 },
    { -C3, S3 }, { -C1, S1 }, { -C1, -S1 }, { -C3, -S3 }, { -S3, -C3 }, { -S1, -C1 },
    { S1, -C1 }, { S3, -C3 }, { C3, -S3 },  { C1, -S1 },
};
static const double set_3d[12][3] = {
    { 1, 1, 0 },  { -1, 1, 0 },  { 1, -1, 0 }, { -1, -1, 0 }, { 1, 0, 1 },  { -1, 0, 1 },
    { 1, 0, -1 }, { -1, 0, -1 }, { 0, 1, 1 },  { 0, -1, 1 },  { 0, 1, -1 }, { 0, -1, -1 },
};
static const double set_4d[32][4] = {
    { 0, 1, 1, 1 },    { 0, 1, 1, -1 },   { 0, 1, -1, 1 },   { 0, 1, -1, -1 },  { 0, -1, 1, 1 },
    { 0, -1, 1, -1 },  { 0, -1, -1, 1 },  { 0, -1, -1, -1 }, { 1, 0, 1, 1 },    { 1, 0, 1, -1 },
    { 1, 0, -1, 1 },   { 1, 0, -1, -1 },  { -1, 0, 1, 1 },   { -1, 0, 1, -1 },  { -1, 0, -1, 1 },
    { -1, 0, -1, -1 }, { 1, 1, 0, 1 },    { 1, 1, 0, -1 },   { 1, -1, 0, 1 },   { 1, -1, 0, -1 },
    { -1, 1, 0, 1 },   { -1, 1, 0, -1 },  { -1, -1, 0, 1 },  { -1, -1, 0, -1 }, { 1, 1, 1, 0 },
    { 1, 1, -1, 0 },   { 1, -1, 1, 0 },   { 1, -1, -1, 0 },  { -1, 1, 1, 0 },   { -1, 1, -1, 0 },
    { -1, -1, 1, 0 },  { -1, -1, -1, 0 },
};

/* By the highest bits, the best mixed ones. 12 is not a power of two: a multiplication maps h to 0..11 nearly
   evenly, without a division. */
const double *wr_lattice_gradient(int dim, uint32_t h)
{
    switch (dim) {
    case 1: return set_1d[h >> 28];
    case 2: return set_2d[h >> 28];
    case 3: return set_3d[(uint64_t)h * 12 >> 32];
    default: return set_4d[h >> 27];
    }
}

/* L13. x - floor(x) rounds to 1 for tiny negative x; 0 then. */
double wr_hash_lecture(double x, double y, double salt)
{
    double angle_rad = 12.3456 * x + 78.910 * y + (1.1235 + salt), sine, cosine;
    if (!isfinite(angle_rad)) return 0.0;
    wr_sincos_turns(angle_rad / (2.0 * WR_PI), &sine, &cosine);
    double a = 5678.1234 * sine, fraction = a - floor(a);
    return fraction < 1.0 ? fraction : 0.0;
}

double wr_noise_reduce(double t, double period)
{
    if (!isfinite(t)) return 0.0;
    if (period <= 0.0) return t;
    /* Below 2^52 the quotient is off by at most one and the product and the difference are exact.
       Above, fmod is exact by definition, but slower. */
    double r = fabs(t) < 0x1p52 ? t - period * floor(t / period) : fmod(t, period);
    if (r < 0.0) r += period;
    return r < period ? r : 0.0; /* a tiny negative t rounds up to the period itself */
}

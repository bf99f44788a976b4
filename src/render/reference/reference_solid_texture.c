#include "render/reference/reference_solid_texture.h"

#include "base/exactmath.h"
#include "noise/octaves.h"

#include <math.h>

static double fraction(double t)
{
    return t - floor(t);
}

/* Value of a pattern as a function of one number, and its slope. */
typedef struct Rise {
    double value, slope;
} Rise;

/* Total length of the pulses 1 - d .. 1 of all turns, from 0 to t. */
static double pulses(double t, double d)
{
    return floor(t) * d + fmax(0, fraction(t) - (1 - d));
}

static double pulse(double t, double d)
{
    return fraction(t) >= 1 - d ? 1 : 0;
}

/* Pulses, or their mean over an edge. */
static Rise ring(double t, double d, double edge)
{
    if (!(edge > 0)) return (Rise){ pulse(t, d), 0 };
    const double f = fraction(t), low = f - edge / 2, high = f + edge / 2;
    return (Rise){ (pulses(high, d) - pulses(low, d)) / edge,
                   (pulse(high, d) - pulse(low, d)) / edge };
}

static Rise ramp(double t)
{
    return (Rise){ fmin(fmax(t, 0), 1), t > 0 && t < 1 ? 1 : 0 };
}

static Rise wave(double t)
{
    const double turn = 2 * WR_PI * fraction(t);
    return (Rise){ 0.5 + 0.5 * sin(turn), WR_PI * cos(turn) };
}

/* Checker of cubes: odd cells along one axis are 1, even ones 0. */
static double board(const WrSolidTexture *grain, double edge, const double p[3], double slope[3])
{
    double side[3], rise[3];
    for (int a = 0; a < 3; a++) {
        const Rise odd = ring(grain->rings * p[a] / 2, 0.5, edge / 2);
        side[a] = 1 - 2 * odd.value;
        rise[a] = -grain->rings * odd.slope;
    }
    for (int a = 0; a < 3; a++) slope[a] = -0.5 * rise[a] * side[(a + 1) % 3] * side[(a + 2) % 3];
    return 0.5 - 0.5 * side[0] * side[1] * side[2];
}

/* Argument of the pattern, with its slope: noise, and rings or bands. */
static double place(const WrSolidTexture *grain, const WrOctavesPlan *noise, const double p[3],
                    double slope[3])
{
    const int x = (grain->axis + 1) % 3, y = (grain->axis + 2) % 3, z = grain->axis;
    const double amount = grain->kind == WR_SOLID_TEXTURE_NOISE ? grain->amount / 2 : grain->amount;
    double t = 0, by[3] = { 0, 0, 0 };
    if (wr_grains[grain->kind].noisy && amount != 0) t = amount * wr_octaves_at(noise, p, by);
    for (int a = 0; a < 3; a++) slope[a] = amount * by[a];
    if (grain->kind == WR_SOLID_TEXTURE_NOISE) return 0.5 + t;
    if (grain->kind == WR_SOLID_TEXTURE_MARBLE) {
        slope[z] += grain->rings;
        return grain->rings * p[z] + t;
    }
    if (grain->kind != WR_SOLID_TEXTURE_WOOD) return t;
    const double from = hypot(p[x], p[y]);
    if (from > 0) slope[x] += grain->rings * p[x] / from, slope[y] += grain->rings * p[y] / from;
    return grain->rings * from + t;
}

static Rise pattern(const WrSolidTexture *grain, double edge, double t)
{
    switch (grain->kind) {
    case WR_SOLID_TEXTURE_WOOD: return ring(t, grain->share, edge);
    case WR_SOLID_TEXTURE_MARBLE: return wave(t);
    case WR_SOLID_TEXTURE_GRANITE:
    case WR_SOLID_TEXTURE_NOISE: return ramp(t);
    case WR_SOLID_TEXTURE_CHECKER:
    case WR_SOLID_TEXTURE_OFF:
    case WR_SOLID_TEXTURE_KINDS: break;
    }
    return (Rise){ 0, 0 };
}

double wr_reference_grain(const WrSolidTexture *grain, const WrOctavesPlan *noise, WrVec3 p,
                          WrVec3 *slope)
{
    const double at[3] = { p.x, p.y, p.z }, edge = wr_solid_texture_edge(grain);
    double by[3], value;
    if (grain->kind == WR_SOLID_TEXTURE_CHECKER) {
        value = board(grain, edge, at, by);
    } else {
        const Rise got = pattern(grain, edge, place(grain, noise, at, by));
        value = got.value;
        for (int a = 0; a < 3; a++) by[a] *= got.slope;
    }
    if (slope) *slope = (WrVec3){ by[0], by[1], by[2] };
    return value;
}

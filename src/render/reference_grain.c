#include "render/reference_grain.h"

#include "base/exactmath.h"
#include "noise/octaves.h"

#include <math.h>

/* Along the axis, and across it. */
static void along_axis(WrGrainAxis axis, WrVec3 p, double *x, double *y, double *z)
{
    switch (axis) {
    case WR_GRAIN_X: *x = p.y, *y = p.z, *z = p.x; return;
    case WR_GRAIN_Y: *x = p.z, *y = p.x, *z = p.y; return;
    case WR_GRAIN_Z:
    case WR_GRAIN_AXES: break;
    }
    *x = p.x, *y = p.y, *z = p.z;
}

static double fraction(double t)
{
    return t - floor(t);
}

static double board(double k, WrVec3 p)
{
    return fmod(fabs(floor(k * p.x) + floor(k * p.y) + floor(k * p.z)), 2);
}

static double pattern(const WrGrain *grain, const WrOctavesPlan *noise, WrVec3 p)
{
    const double at[3] = { p.x, p.y, p.z };
    double x, y, z;
    along_axis(grain->axis, p, &x, &y, &z);
    const double moved = wr_grains[grain->kind].noisy && grain->amount != 0
                             ? grain->amount * wr_octaves_at(noise, at, NULL)
                             : 0;
    switch (grain->kind) {
    case WR_GRAIN_WOOD:
        return fraction(grain->rings * hypot(x, y) + moved) >= 1 - grain->share ? 1 : 0;
    case WR_GRAIN_MARBLE: return 0.5 + 0.5 * sin(2 * WR_PI * fraction(grain->rings * z + moved));
    case WR_GRAIN_CHECKER: return board(grain->rings, p);
    case WR_GRAIN_GRANITE: return fmin(moved, 1);
    case WR_GRAIN_NOISE: return fmin(fmax(0.5 + 0.5 * moved, 0), 1);
    case WR_GRAIN_OFF:
    case WR_GRAIN_KINDS: break;
    }
    return 0;
}

void wr_reference_grain(const WrGrain *grain, const WrOctavesPlan *noise, WrVec3 p, double rgb[3])
{
    const double g = pattern(grain, noise, p);
    for (int c = 0; c < 3; c++) rgb[c] = (1 - g) * grain->light[c] + g * grain->dark[c];
}

#include "generate/erode.h"

#include "base/exactmath.h"
#include "base/memory.h"

#include <math.h>

#define RADIUS_MOST 16
#define GRAVITY 4.0
#define LEAST_SLOPE 0.01 /* by which a drop on flat ground carries something */
#define REPORT 4096      /* drops */

const WrParam wr_params_hydraulic[] = {
    WR_P_NUMBER("rain", "Rain", 1, 0, 100, 4, "", "drops for each texel"),
    WR_P_PART("strength", "Strength", 0.4, "how fast water takes up ground"),
    WR_P_NUMBER("capacity", "Capacity", 4, 0, 100, 16, "", "how much ground water carries"),
    WR_P_PART("deposition", "Deposition", 0.3, "how fast it lays it down where it slows"),
    WR_P_PART("inertia", "Inertia", 0.02, "how hard it is to turn it"),
    WR_P_PART("evaporation", "Evaporation", 0.01, "of a drop, each texel"),
    WR_P_WHOLE("radius", "Radius", 2, 1, RADIUS_MOST, 8,
               "of the ground that a drop takes from, texels"),
    WR_P_WHOLE("life", "Life", 128, 1, 4096, 200, "of a drop, texels"),
    WR_P_SEED,
    WR_P_END
};

typedef struct Brush {
    int radius, side;
    double weight[(2 * RADIUS_MOST + 1) * (2 * RADIUS_MOST + 1)]; /* [side][side], sum 1 */
} Brush;

typedef struct Weather {
    WrSheet *sheet;
    const WrRain *rain;
    Brush brush;
    double scale; /* slopes: table units a texel -> parts of the relief in 1/256 of the width */
} Weather;

typedef struct Drop {
    double x, y, dx, dy;       /* texels, texel centres at whole numbers */
    double speed, water, load; /* load: table units of one texel */
} Drop;

static void make_brush(Brush *brush, int radius)
{
    double sum = 0.0;
    brush->radius = radius;
    brush->side = 2 * radius + 1;
    for (int pass = 0; pass < 2; pass++)
        for (int j = -radius; j <= radius; j++)
            for (int i = -radius; i <= radius; i++) {
                double w = 1.0 - sqrt((double)(i * i + j * j)) / (radius + 0.5);
                double *at = &brush->weight[(j + radius) * brush->side + i + radius];
                if (pass == 0) sum += w > 0.0 ? w : 0.0;
                else *at = (w > 0.0 ? w : 0.0) / sum;
            }
}

static double *texel(const WrSheet *s, int i, int j)
{
    i = wr_sheet_index(i, s->width, s->wrap[0]);
    j = wr_sheet_index(j, s->height, s->wrap[1]);
    return &s->z[(size_t)j * (size_t)s->width + (size_t)i];
}

/* Whether texels i..i + size - 1, j..j + size - 1 need no wrapping: most drops are there. */
static bool within(const WrSheet *s, int i, int j, int size)
{
    return i >= 0 && j >= 0 && i <= s->width - size && j <= s->height - size;
}

/* The four texels about a place, and how far it is from the first. */
typedef struct Corners {
    double *p, *q, *r, *t; /* left, right; the same below */
    double a, b;
} Corners;

static Corners corners(const WrSheet *s, double x, double y)
{
    int i = (int)floor(x), j = (int)floor(y);
    Corners c = { .a = x - i, .b = y - j };
    if (within(s, i, j, 2)) {
        c.p = s->z + (size_t)j * (size_t)s->width + (size_t)i;
        c.q = c.p + 1;
        c.r = c.p + s->width;
        c.t = c.r + 1;
    } else {
        c.p = texel(s, i, j);
        c.q = texel(s, i + 1, j);
        c.r = texel(s, i, j + 1);
        c.t = texel(s, i + 1, j + 1);
    }
    return c;
}

/* The height at a place, bilinear, and its slopes. */
static double ground(const WrSheet *s, double x, double y, double *zx, double *zy)
{
    const Corners c = corners(s, x, y);
    double p = *c.p, q = *c.q, r = *c.r, t = *c.t;
    *zx = (q - p) * (1.0 - c.b) + (t - r) * c.b;
    *zy = (r - p) * (1.0 - c.a) + (t - q) * c.a;
    return (p * (1.0 - c.a) + q * c.a) * (1.0 - c.b) + (r * (1.0 - c.a) + t * c.a) * c.b;
}

/* One after the other, since on small tables they may be the same texel. */
static void lay_down(const WrSheet *s, double x, double y, double amount)
{
    const Corners c = corners(s, x, y);
    *c.p += amount * (1.0 - c.a) * (1.0 - c.b);
    *c.q += amount * c.a * (1.0 - c.b);
    *c.r += amount * (1.0 - c.a) * c.b;
    *c.t += amount * c.a * c.b;
}

/* Below 0: lay it down, softly. */
static void take_up(const Weather *w, double x, double y, double amount)
{
    const Brush *brush = &w->brush;
    const WrSheet *s = w->sheet;
    int r = brush->radius, i = (int)floor(x + 0.5) - r, j = (int)floor(y + 0.5) - r;
    bool direct = within(s, i, j, brush->side);
    for (int b = 0; b < brush->side; b++)
        for (int a = 0; a < brush->side; a++) {
            double part = brush->weight[b * brush->side + a];
            if (part > 0.0) {
                double *z = direct ? s->z + (size_t)(j + b) * (size_t)s->width + (size_t)(i + a)
                                   : texel(s, i + a, j + b);
                *z -= amount * part;
            }
        }
}

/* Back onto the table round a ring; false beyond a clamped edge. */
static bool bring_back(double *x, int n, WrWrap wrap)
{
    if (*x >= 0.0 && *x < n) return true;
    if (wrap == WR_WRAP_CLAMP) return *x >= -0.5 && *x < n - 0.5;
    *x -= n * floor(*x / n);
    if (!(*x < n)) *x = 0.0;
    return true;
}

/* One texel on. False when the drop has come to its end. */
static bool step(const Weather *w, Drop *d)
{
    const WrRain *rain = w->rain;
    const WrSheet *s = w->sheet;
    double zx, zy, unused, x = d->x, y = d->y, z = ground(s, x, y, &zx, &zy);
    d->dx = d->dx * rain->inertia - zx * w->scale * (1.0 - rain->inertia);
    d->dy = d->dy * rain->inertia - zy * w->scale * (1.0 - rain->inertia);
    double length = sqrt(d->dx * d->dx + d->dy * d->dy);
    if (!(length > 1e-12)) return false;
    d->dx /= length;
    d->dy /= length;
    double to_x = x + d->dx, to_y = y + d->dy;
    if (!bring_back(&to_x, s->width, s->wrap[0]) || !bring_back(&to_y, s->height, s->wrap[1]))
        return false;
    double rise = ground(s, to_x, to_y, &unused, &unused) - z, fall = -rise * w->scale;
    double can =
        (fall > LEAST_SLOPE ? fall : LEAST_SLOPE) * d->speed * d->water * rain->capacity / w->scale;
    if (rise > 0.0 || d->load > can) {
        double amount = (d->load - can) * rain->deposition;
        if (rise > 0.0) amount = rise < d->load ? rise : d->load; /* fill the hollow */
        lay_down(s, x, y, amount);
        d->load -= amount;
    } else {
        double amount = (can - d->load) * rain->erosion;
        if (amount > -rise) amount = -rise; /* no deeper than where it goes */
        take_up(w, x, y, amount);
        d->load += amount;
    }
    double speed = d->speed * d->speed + fall * GRAVITY;
    d->speed = speed > 0.0 ? sqrt(speed) : 0.0;
    d->water *= 1.0 - rain->evaporation;
    d->x = to_x;
    d->y = to_y;
    return d->speed > 0.0 && d->water > 0.01;
}

static double chance(uint32_t seed, uint32_t drop, uint32_t use)
{
    return wr_mix32(wr_mix32(drop * 2 + use) ^ wr_mix32(seed + 0x68e31da4U)) / 4294967296.0;
}

static void run_drop(const Weather *w, uint32_t number)
{
    const WrSheet *s = w->sheet;
    Drop d = { .x = floor(s->width * chance(w->rain->seed, number, 0)),
               .y = floor(s->height * chance(w->rain->seed, number, 1)),
               .speed = 1.0,
               .water = 1.0 };
    for (int k = 0; k < w->rain->life && step(w, &d);) k++;
    if (d.load > 0.0) take_up(w, d.x, d.y, -d.load);
}

bool wr_erode_rain(WrSheet *sheet, const WrRain *rain, const WrGenerateJob *job, WrError *err)
{
    double low, high;
    wr_sheet_range(sheet, &low, &high);
    if (!(high - low > 1e-30)) return true; /* nothing runs */
    Weather w = { .sheet = sheet, .rain = rain };
    w.scale = sheet->width / 256.0 / (high - low);
    make_brush(&w.brush, rain->radius);
    double drops = floor(rain->drops * sheet->width * sheet->height);
    if (drops > 4294967295.0) drops = 4294967295.0;
    for (double k = 0.0; k < drops; k += 1.0) {
        if (fmod(k, REPORT) == 0.0 && !wr_progress_step(job->progress, k / drops))
            return wr_fail(err, "cancelled");
        run_drop(&w, (uint32_t)k);
    }
    return true;
}

bool wr_terrain_hydraulic(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                          WrError *err)
{
    const WrParams p = { wr_params_hydraulic, values };
    WrSheet sheet = { .z = NULL };
    if (!wr_erode_begin(&sheet, job, err)) return false;
    const WrRain rain = { .drops = wr_param_number(&p, "rain"),
                          .inertia = wr_param_number(&p, "inertia"),
                          .capacity = wr_param_number(&p, "capacity"),
                          .erosion = wr_param_number(&p, "strength"),
                          .deposition = wr_param_number(&p, "deposition"),
                          .evaporation = wr_param_number(&p, "evaporation"),
                          .radius = wr_param_whole(&p, "radius"),
                          .life = wr_param_whole(&p, "life"),
                          .seed = wr_param_seed(&p) };
    bool good = wr_erode_rain(&sheet, &rain, job, err);
    return wr_erode_end(&sheet, job, good, out, err);
}

#include "generate/erode.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"

#include <math.h>

#define RADIUS_MOST 16
#define GRAVITY 4.0
#define LEAST_SLOPE 0.01 /* slope used for the capacity on flat ground */
#define RUN 64           /* maximum run of a drop, in texels of a grid */
#define LEAST_SIDE 48    /* texels; smaller grids are not used */
#define LEVELS_MAX 10
#define COARSE                                                                                     \
    0.15         /* fraction of rain on the first coarser grid; half of it on each further grid */
#define ROUNDS 8 /* passes over the whole table, each with a part of the rain */

const WrParam wr_params_hydraulic[] = {
    WR_P_NUMBER("rain", "Rain", 1, 0, 100, 4, "", "drops for each texel"),
    WR_P_PART("strength", "Strength", 0.4, "how fast water takes up ground"),
    WR_P_NUMBER("capacity", "Capacity", 4, 0, 100, 16, "", "how much ground water carries"),
    WR_P_PART("deposition", "Deposition", 0.3, "how fast it lays it down where it slows"),
    WR_P_PART("inertia", "Inertia", 0.02, "how hard it is to turn it"),
    WR_P_PART("evaporation", "Evaporation", 0.01, "of a drop, each texel"),
    WR_P_WHOLE("radius", "Radius", 2, 1, RADIUS_MOST, 8,
               "of the ground that a drop takes from, texels"),
    WR_P_WHOLE("life", "Life", 128, 1, 4096, 512, "how far water runs, texels"),
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
    double scale;     /* slopes: table units per texel -> fractions of the relief per 1/256 of the
                         width */
    double fade[RUN]; /* remaining water by distance run, besides evaporation */
    double capacity;  /* per texel of the grid */
    double drops;     /* for each of its texels */
    int life, level;
} Weather;

typedef struct Drop {
    double x, y, dx, dy;       /* texels, with texel centres at integers */
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

/* True if texels i..i + size - 1, j..j + size - 1 need no wrapping: the usual case. */
static bool within(const WrSheet *s, int i, int j, int size)
{
    return i >= 0 && j >= 0 && i <= s->width - size && j <= s->height - size;
}

static int floor_of(double x)
{
    int i = (int)x;
    return i - ((double)i > x);
}

/* The four texels about a position: upper left, upper right, lower left, lower right; and the
 * fractions. */
typedef struct Corners {
    double *at[4];
    double a, b;
} Corners;

static inline Corners corners(const WrSheet *s, double x, double y)
{
    int i = floor_of(x), j = floor_of(y);
    Corners c = { .a = x - i, .b = y - j };
    if (within(s, i, j, 2)) {
        double *first = s->z + (size_t)j * (size_t)s->width + (size_t)i;
        c.at[0] = first;
        c.at[1] = first + 1;
        c.at[2] = first + s->width;
        c.at[3] = first + s->width + 1;
    } else {
        for (int k = 0; k < 4; k++) c.at[k] = texel(s, i + k % 2, j + k / 2);
    }
    return c;
}

/* Bilinear height at the position. */
static inline double ground(const Corners *c)
{
    double above = *c->at[0] * (1.0 - c->a) + *c->at[1] * c->a;
    return above * (1.0 - c->b) + (*c->at[2] * (1.0 - c->a) + *c->at[3] * c->a) * c->b;
}

/* Sequentially, since on small tables they may be the same texel. */
static void lay_down(const Corners *c, double amount)
{
    *c->at[0] += amount * (1.0 - c->a) * (1.0 - c->b);
    *c->at[1] += amount * c->a * (1.0 - c->b);
    *c->at[2] += amount * (1.0 - c->a) * c->b;
    *c->at[3] += amount * c->a * c->b;
}

static void take_up_direct(const Brush *brush, double *corner, size_t width, double amount)
{
    for (int b = 0; b < brush->side; b++) {
        const double *weight = brush->weight + b * brush->side;
        double *z = corner + (size_t)b * width;
#pragma omp simd
        for (int a = 0; a < brush->side; a++) z[a] -= amount * weight[a];
    }
}

/* Erodes within the radius; negative amounts are deposited smoothly. */
static void take_up(const Weather *w, double x, double y, double amount)
{
    const Brush *brush = &w->brush;
    const WrSheet *s = w->sheet;
    int r = brush->radius, i = floor_of(x + 0.5) - r, j = floor_of(y + 0.5) - r;
    if (within(s, i, j, brush->side)) {
        size_t width = (size_t)s->width;
        take_up_direct(brush, s->z + (size_t)j * width + (size_t)i, width, amount);
        return;
    }
    for (int b = 0; b < brush->side; b++)
        for (int a = 0; a < brush->side; a++)
            *texel(s, i + a, j + b) -= amount * brush->weight[b * brush->side + a];
}

/* Wraps around a periodic axis; false beyond a clamped edge. */
static bool bring_back(double *x, int n, WrWrap wrap)
{
    if (*x >= 0.0 && *x < n) return true;
    if (wrap == WR_WRAP_CLAMP) return *x >= -0.5 && *x < n - 0.5;
    *x -= n * floor(*x / n);
    if (!(*x < n)) *x = 0.0;
    return true;
}

/* Updates the direction of the drop, of length 1. False if it has none. */
static inline bool turn(const Weather *w, const Corners *c, Drop *d)
{
    double p = *c->at[0], q = *c->at[1], r = *c->at[2], t = *c->at[3];
    double zx = (q - p) * (1.0 - c->b) + (t - r) * c->b;
    double zy = (r - p) * (1.0 - c->a) + (t - q) * c->a;
    double inertia = w->rain->inertia;
    d->dx = d->dx * inertia - zx * w->scale * (1.0 - inertia);
    d->dy = d->dy * inertia - zy * w->scale * (1.0 - inertia);
    double length = sqrt(d->dx * d->dx + d->dy * d->dy);
    if (!(length > 1e-12)) return false;
    double unit = 1.0 / length;
    d->dx *= unit;
    d->dy *= unit;
    return true;
}

/* Erodes or deposits at the drop's position, before it moves to ground that is higher by `rise`. */
static inline void carry(const Weather *w, const Corners *c, double rise, double fade, Drop *d)
{
    const WrRain *rain = w->rain;
    double fall = -rise * w->scale;
    double can =
        (fall > LEAST_SLOPE ? fall : LEAST_SLOPE) * d->speed * d->water * fade * w->capacity;
    if (rise > 0.0 || d->load > can) {
        double amount = (d->load - can) * rain->deposition;
        if (rise > 0.0) amount = rise < d->load ? rise : d->load; /* fills the hollow */
        lay_down(c, amount);
        d->load -= amount;
    } else {
        double amount = (can - d->load) * rain->erosion;
        if (amount > -rise) amount = -rise; /* not below the next position */
        take_up(w, d->x, d->y, amount);
        d->load += amount;
    }
    double speed = d->speed * d->speed + fall * GRAVITY;
    d->speed = speed > 0.0 ? sqrt(speed) : 0.0;
    d->water *= 1.0 - rain->evaporation;
}

/* Moves one texel. False at the end of the drop. */
static inline bool step(const Weather *w, Drop *d, double fade)
{
    const WrSheet *s = w->sheet;
    const Corners from = corners(s, d->x, d->y);
    if (!turn(w, &from, d)) return false;
    double x = d->x + d->dx, y = d->y + d->dy;
    if (!bring_back(&x, s->width, s->wrap[0]) || !bring_back(&y, s->height, s->wrap[1]))
        return false;
    const Corners to = corners(s, x, y);
    carry(w, &from, ground(&to) - ground(&from), fade, d);
    d->x = x;
    d->y = y;
    return d->speed > 0.0 && d->water > 0.01;
}

static double chance(const Weather *w, uint32_t tile, uint32_t drop, uint32_t use)
{
    uint32_t place = wr_mix32(tile * 64U + (uint32_t)w->level) ^ (drop * 2U + use);
    return wr_mix32(wr_mix32(place) ^ wr_mix32(w->rain->seed + 0x68e31da4U)) / 4294967296.0;
}

static void run_drop(const Weather *w, double x, double y)
{
    Drop d = { .x = x, .y = y, .speed = 1.0, .water = 1.0 };
    for (int k = 0; k < w->life && step(w, &d, w->fade[k]);) k++;
    if (d.load > 0.0) take_up(w, d.x, d.y, -d.load);
}

/* ---- tiles ----
 *
 * A drop affects nothing farther than `reach` from its start. So in tiles larger than twice that, with
 * every other one selected along each axis, drops do not meet: four classes of tiles are processed one
 * after another, those of a class in parallel, drops of a tile in order. The result is the same on any
 * number of threads. */

typedef struct Storm {
    const Weather *w;
    int tiles[2]; /* along each axis; even, or 1 */
    int sort[2];  /* parity of the active tiles */
    int round;
    const WrProgress *progress;
} Storm;

static int tiles_of(int n, int reach)
{
    int tiles = n / (2 * reach + 2);
    return tiles < 2 ? 1 : tiles - tiles % 2;
}

static int sorts(int tiles)
{
    return tiles > 1 ? 2 : 1;
}

static double edge(int n, int tiles, int k)
{
    return (double)((int64_t)n * k / tiles);
}

static void rain_on_tile(int index, int worker, void *ctx)
{
    (void)worker;
    const Storm *storm = ctx;
    const WrSheet *s = storm->w->sheet;
    int across = storm->tiles[0] / sorts(storm->tiles[0]);
    int i = index % across * sorts(storm->tiles[0]) + storm->sort[0];
    int j = index / across * sorts(storm->tiles[1]) + storm->sort[1];
    double x = edge(s->width, storm->tiles[0], i), y = edge(s->height, storm->tiles[1], j);
    double wide = edge(s->width, storm->tiles[0], i + 1) - x;
    double high = edge(s->height, storm->tiles[1], j + 1) - y;
    double all = storm->w->drops * wide * high / ROUNDS;
    uint32_t tile = (uint32_t)(j * storm->tiles[0] + i);
    uint32_t end = (uint32_t)floor(all * (storm->round + 1));
    for (uint32_t k = (uint32_t)floor(all * storm->round); k < end; k++) {
        if (k % 256 == 0 && wr_progress_cancelled(storm->progress)) return;
        run_drop(storm->w, x + floor(wide * chance(storm->w, tile, k, 0)),
                 y + floor(high * chance(storm->w, tile, k, 1)));
    }
}

/* done, share: fractions of all the work. */
static bool rain_on_sheet(const Weather *w, double done, double share, const WrGenerateJob *job)
{
    int reach = w->life + w->brush.radius + 2;
    Storm storm = { .w = w, .progress = job->progress };
    storm.tiles[0] = tiles_of(w->sheet->width, reach);
    storm.tiles[1] = tiles_of(w->sheet->height, reach);
    int u = sorts(storm.tiles[0]), v = sorts(storm.tiles[1]), phases = ROUNDS * u * v;
    for (int k = 0; k < phases; k++) {
        storm.round = k / (u * v);
        storm.sort[0] = k % u;
        storm.sort[1] = k / u % v;
        wr_pool_run(job->pool, storm.tiles[0] / u * (storm.tiles[1] / v), rain_on_tile, &storm);
        if (!wr_progress_step(job->progress, done + share * (k + 1) / phases)) return false;
    }
    return true;
}

/* ---- grids ---- */

static void set_weather(Weather *w, WrSheet *sheet, const WrRain *rain, int level, double relief)
{
    int life = rain->life >> level;
    *w = (Weather){ .sheet = sheet, .rain = rain, .level = level };
    w->life = life < 1 ? 1 : life < RUN ? life : RUN;
    w->scale = sheet->width / 256.0 / relief;
    w->capacity = rain->capacity / w->scale;
    w->drops = rain->drops;
    for (int k = 0; k < level; k++) w->drops *= k == 0 ? COARSE : 0.5;
    for (int k = 0; k < w->life; k++) {
        double t = (double)k / w->life;
        w->fade[k] = 1.0 - t * t * t;
    }
    make_brush(&w->brush, rain->radius);
}

/* Adds the difference of `small` and `before` to sheet; the sum of heights is preserved. */
static bool add_change(WrSheet *sheet, WrSheet *small, const WrSheet *before,
                       const WrGenerateJob *job, WrError *err)
{
    size_t count = (size_t)small->width * (size_t)small->height;
    double sum = 0.0;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) small->z[k] -= before->z[k];
    if (!wr_sheet_resize(small, sheet->width, sheet->height, job, err)) return false;
    count = (size_t)small->width * (size_t)small->height;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) sum += small->z[k];
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++)
        sheet->z[k] += small->z[k] - sum / (double)count;
    return true;
}

typedef struct Rainfall {
    const WrRain *rain;
    const WrGenerateJob *job;
    double relief;
    int levels;
} Rainfall;

/* Rain falls on coarser grids first, then on this one. */
static bool rain_on_level(WrSheet *sheet, const Rainfall *all, int level, WrError *err)
{
    double share = 0.75; /* of the work; each grid has a quarter of the finer one's */
    for (int k = 0; k < level; k++) share *= 0.25;
    if (level + 1 < all->levels) {
        WrSheet small = { .z = NULL }, before = { .z = NULL };
        bool good = wr_sheet_copy(&small, sheet, err) &&
                    wr_sheet_resize(&small, (sheet->width + 1) / 2, (sheet->height + 1) / 2,
                                    all->job, err) &&
                    wr_sheet_copy(&before, &small, err) &&
                    rain_on_level(&small, all, level + 1, err) &&
                    add_change(sheet, &small, &before, all->job, err);
        wr_sheet_fini(&small);
        wr_sheet_fini(&before);
        if (!good) return false;
    }
    Weather *w = wr_alloc(1, sizeof *w);
    set_weather(w, sheet, all->rain, level, all->relief);
    bool good = rain_on_sheet(w, share / 3.0, share, all->job);
    wr_free(w);
    return good || wr_fail(err, "cancelled");
}

bool wr_erode_rain(WrSheet *sheet, const WrRain *rain, const WrGenerateJob *job, WrError *err)
{
    double low, high;
    wr_sheet_range(sheet, &low, &high);
    if (!(high - low > 1e-30)) return true; /* flat: no flow */
    Rainfall all = { rain, job, high - low, 1 };
    int side = sheet->width < sheet->height ? sheet->width : sheet->height;
    while (all.levels < LEVELS_MAX && rain->life >> (all.levels - 1) > RUN &&
           side >> all.levels >= LEAST_SIDE)
        all.levels++;
    return rain_on_level(sheet, &all, 0, err) &&
           (wr_progress_step(job->progress, 1.0) || wr_fail(err, "cancelled"));
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

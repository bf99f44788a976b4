#include "generate/erode.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "generate/terrain.h"

#include <math.h>

/* Converts the sheet to the output; for a smaller one, adds its change to the table. Releases it. */
static bool erode_end(WrSheet *sheet, const WrGenerateJob *job, bool good, WrRelief *out,
                      WrError *err);

/* Reads the table of a job into a sheet; at lower resolution for a coarse preview. */
static bool erode_begin(WrSheet *sheet, const WrGenerateJob *job, WrError *err);

/* Drops that follow the slope, after Beyer 2015 (Implementation of a method for hydraulic erosion). Each step of one texel:
     d' = unit(inertia d - (1 - inertia) grad z)      direction
     can = max(fall, LEAST_SLOPE) speed water capacity   load that it can carry
     load > can: deposits deposition (load - can); else erodes erosion (can - load), at most the fall
     speed' = sqrt(speed^2 + GRAVITY fall), water' = (1 - evaporation) water
   A drop runs RUN texels of a grid at most: valleys longer than that are cut on coarser grids first, whose change is added
   here. */
/* ---- water ---- */

#define RADIUS_MAX 16
#define GRAVITY 4.0
#define LEAST_SLOPE 0.01 /* slope used for the capacity on flat ground */
#define RUN 64           /* maximum run of a drop, in texels of a grid */
#define LEAST_SIDE 48    /* texels; smaller grids are not used */
#define LEVELS_MAX 10
#define COARSE                                                                                     \
    0.15         /* fraction of rain on the first coarser grid; half of it on each further grid */
#define ROUNDS 8 /* passes over the whole table, each with a part of the rain */

const WrParam wr_params_hydraulic[] = {
    WR_P_NUMBER("rain", "Rain", 1, 0, 100, 4, "", "drops per texel"),
    WR_P_PART("strength", "Strength", 0.4, "rate at which water erodes the ground"),
    WR_P_NUMBER("capacity", "Capacity", 4, 0, 100, 16, "", "sediment capacity of water"),
    WR_P_PART("deposition", "Deposition", 0.3, "rate at which slowing water deposits sediment"),
    WR_P_PART("inertia", "Inertia", 0.02, "inertia: resistance of a drop to changes of direction"),
    WR_P_PART("evaporation", "Evaporation", 0.01, "share of a drop that evaporates per texel"),
    WR_P_WHOLE("radius", "Radius", 2, 1, RADIUS_MAX, 8, "radius of the ground that a drop erodes"),
    WR_P_WHOLE("life", "Life", 128, 1, 4096, 512, "longest path of a drop"),
    WR_P_SEED,
    WR_P_END
};

typedef struct Brush {
    int radius, side;
    double weight[(2 * RADIUS_MAX + 1) * (2 * RADIUS_MAX + 1)]; /* [side][side], sum 1 */
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

/* Weights fall linearly from the middle to radius + 1/2 and sum to 1, so that the mass taken equals the mass loaded. */
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
    /* The gradient of the bilinear interpolation: differences along one axis, interpolated along the other. */
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

/* A hash of tile, number and level, not a generator with a state: a drop does not depend on the drops before it. */
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

static int life_on_level(const WrRain *rain, int level)
{
    const int life = rain->life >> level;
    return life < 1 ? 1 : life < RUN ? life : RUN;
}

/* Drops for each texel. */
static double drops_on_level(const WrRain *rain, int level)
{
    double drops = rain->drops;
    for (int k = 0; k < level; k++) drops *= k == 0 ? COARSE : 0.5;
    return drops;
}

/* Share of all the work of the grids from `level` on: that of a grid is its texels' drops, each of which runs for its
   life. Progress and the time left depend on it. */
static double share_from(const WrRain *rain, int level, int levels)
{
    double all = 0.0, from = 0.0, texels = 1.0;
    for (int k = 0; k < levels; k++, texels *= 0.25) {
        const double work = texels * drops_on_level(rain, k) * life_on_level(rain, k);
        all += work;
        if (k >= level) from += work;
    }
    return all > 0.0 ? from / all : 0.0;
}

static void set_weather(Weather *w, WrSheet *sheet, const WrRain *rain, int level, double relief)
{
    *w = (Weather){ .sheet = sheet, .rain = rain, .level = level };
    w->life = life_on_level(rain, level);
    w->scale = sheet->width / 256.0 / relief;
    w->capacity = rain->capacity / w->scale;
    w->drops = drops_on_level(rain, level);
    for (int k = 0; k < w->life; k++) {
        double t = (double)k / w->life;
        w->fade[k] = 1.0 - t * t * t;
    }
    make_brush(&w->brush, rain->radius);
}

/* Adds the difference of `small` and `before` to sheet; the sum of heights is preserved. Only the change is enlarged: details
   of the fine grid remain, and an interpolated change has no steps. */
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
    const double done = share_from(all->rain, level + 1, all->levels);
    const double share = share_from(all->rain, level, all->levels) - done;
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
    bool good = rain_on_sheet(w, done, share, all->job);
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
    if (!erode_begin(&sheet, job, err)) return false;
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
    return erode_end(&sheet, job, good, out, err);
}

/* ---- thermal ---- */

const WrParam wr_params_thermal[] = {
    WR_P_NUMBER("talus", "Angle of rest", 35, 0, 89, 89, "degrees",
                "talus angle: steeper slopes slide"),
    WR_P_ABOVE("width", "Width", 8, 0, WR_PARAM_HEIGHT, 20, "table units",
               "width of the whole table, for measuring angles"),
    WR_P_WHOLE("rounds", "Rounds", 60, 0, 100000, 500, "number of steps"),
    WR_P_PART("rate", "Rate", 0.7,
              "share of the material above the talus angle that slides in one step"),
    WR_P_END
};

static const int step_i[8] = { -1, 1, 0, 0, -1, 1, -1, 1 };
static const int step_j[8] = { 0, 0, -1, 1, -1, -1, 1, 1 };

typedef struct Round {
    const WrThermal *how;
    const WrSheet *from;
    WrSheet *to;
    double *part; /* rate/2 max(d) / sum(d); 0: no flow */
    double hold[8];
} Round;

/* Index of neighbour k, or -1 beyond an edge (or if it is the texel itself). */
static int64_t neighbour(const WrSheet *s, int i, int j, int k)
{
    int x = i + step_i[k], y = j + step_j[k];
    if ((x < 0 || x >= s->width) && s->wrap[0] == WR_WRAP_CLAMP) return -1;
    if ((y < 0 || y >= s->height) && s->wrap[1] == WR_WRAP_CLAMP) return -1;
    x = wr_sheet_index(x, s->width, s->wrap[0]);
    y = wr_sheet_index(y, s->height, s->wrap[1]);
    return x == i && y == j ? -1 : (int64_t)y * s->width + x;
}

/* Musgrave's thermal erosion: material above the angle of rest, d = z - z_k - hold_k > 0, flows to the lower neighbours in
   proportion to d; the total is rate max(d) / 2, since moving half of the excess levels it. */
static void weigh_rows(const void *ctx, int first, int end)
{
    const Round *r = ctx;
    const WrSheet *s = r->from;
    for (int j = first; j < end; j++)
        for (int i = 0; i < s->width; i++) {
            int64_t at = (int64_t)j * s->width + i;
            double most = 0.0, sum = 0.0;
            for (int k = 0; k < 8; k++) {
                int64_t to = neighbour(s, i, j, k);
                double d = to < 0 ? 0.0 : s->z[at] - s->z[to] - r->hold[k];
                if (d > most) most = d;
                if (d > 0.0) sum += d;
            }
            r->part[at] = sum > 0.0 ? 0.5 * r->how->rate * (most / sum) : 0.0;
        }
}

/* Both ends of a flow compute it from the same numbers. So mass is preserved, and texels can be processed in parallel: `from`
   is read, `to` written, no texel is written twice. */
static void flow_rows(const void *ctx, int first, int end)
{
    const Round *r = ctx;
    const WrSheet *s = r->from;
    for (int j = first; j < end; j++)
        for (int i = 0; i < s->width; i++) {
            int64_t at = (int64_t)j * s->width + i;
            double change = 0.0;
            for (int k = 0; k < 8; k++) {
                int64_t to = neighbour(s, i, j, k);
                if (to < 0) continue;
                double out = s->z[at] - s->z[to] - r->hold[k];
                double in = s->z[to] - s->z[at] - r->hold[k];
                if (out > 0.0) change -= r->part[at] * out;
                if (in > 0.0) change += r->part[to] * in;
            }
            r->to->z[at] = s->z[at] + change;
        }
}

bool wr_erode_thermal(WrSheet *sheet, const WrThermal *how, const WrGenerateJob *job, WrError *err)
{
    WrSheet other = { .z = NULL };
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    if (!wr_sheet_copy(&other, sheet, err)) return false;
    Round r = { .how = how, .part = wr_try_alloc(count, sizeof *r.part, "flows of stones", err) };
    bool good = r.part != NULL;
    for (int k = 0; k < 8; k++) r.hold[k] = how->talus * (k < 4 ? 1.0 : sqrt(2.0));
    for (int n = 0; good && n < how->rounds; n++) {
        r.from = sheet;
        r.to = &other;
        good = wr_sheet_run(sheet, job, false, weigh_rows, &r, err) &&
               wr_sheet_run(sheet, job, false, flow_rows, &r, err);
        double *swap = sheet->z;
        sheet->z = other.z;
        other.z = swap;
        if (good && !wr_progress_step(job->progress, (n + 1.0) / how->rounds))
            good = wr_fail(err, "cancelled");
    }
    wr_free(r.part);
    wr_sheet_fini(&other);
    return good;
}

bool wr_terrain_thermal(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams p = { wr_params_thermal, values };
    WrSheet sheet = { .z = NULL };
    double sine, cosine;
    wr_sincos_turns(wr_param_number(&p, "talus") / 360.0, &sine, &cosine);
    if (!erode_begin(&sheet, job, err)) return false;
    double texel = wr_param_number(&p, "width") / sheet.width;
    double scale = (double)sheet.width / wr_field_width(job->like);
    WrThermal how = { .talus = sine / cosine * texel,
                      .rate = wr_param_number(&p, "rate"),
                      /* material spreads with the root of the number of rounds, in texels */
                      .rounds = (int)ceil(wr_param_number(&p, "rounds") * scale * scale) };
    bool good = wr_erode_thermal(&sheet, &how, job, err);
    return erode_end(&sheet, job, good, out, err);
}

static int smaller(int n)
{
    return n < WR_ERODE_COARSE ? n : WR_ERODE_COARSE;
}

static bool erode_begin(WrSheet *sheet, const WrGenerateJob *job, WrError *err)
{
    if (!wr_sheet_read(sheet, job->like, err)) return false;
    if (!job->coarse) return true;
    int width = smaller(sheet->width), height = smaller(sheet->height);
    double across = (double)width / sheet->width, up = (double)height / sheet->height;
    if (across < up) height = (int)(sheet->height * across + 0.5);
    else width = (int)(sheet->width * up + 0.5);
    if (wr_sheet_resize(sheet, width > 0 ? width : 1, height > 0 ? height : 1, job, err))
        return true;
    wr_sheet_fini(sheet);
    return false;
}

/* Adds after - before, resized to the table, to the table. */
static bool add_change_to_table(WrSheet *sheet, const WrGenerateJob *job, WrError *err)
{
    WrSheet before = { .z = NULL }, whole = { .z = NULL };
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    bool good = wr_sheet_read(&whole, job->like, err) && wr_sheet_copy(&before, &whole, err) &&
                wr_sheet_resize(&before, sheet->width, sheet->height, job, err);
    for (size_t k = 0; good && k < count && wr_sheet_goes_on(k); k++) sheet->z[k] -= before.z[k];
    good = good && wr_sheet_resize(sheet, whole.width, whole.height, job, err);
    count = (size_t)whole.width * (size_t)whole.height;
    for (size_t k = 0; good && k < count && wr_sheet_goes_on(k); k++) sheet->z[k] += whole.z[k];
    wr_sheet_fini(&before);
    wr_sheet_fini(&whole);
    return good;
}

static bool erode_end(WrSheet *sheet, const WrGenerateJob *job, bool good, WrRelief *out,
                      WrError *err)
{
    bool small =
        sheet->width != wr_field_width(job->like) || sheet->height != wr_field_height(job->like);
    good = good && (!small || add_change_to_table(sheet, job, err)) &&
           wr_sheet_relief(sheet, job, out, err);
    wr_sheet_fini(sheet);
    return good;
}

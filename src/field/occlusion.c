#include "field/occlusion.h"

#include "base/cpu.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/horizon.h"
#include "field/occlusion_lattice.h"

#include <math.h>
#include <string.h>

#define LANES WR_SKY_LANES
#define STEPS 28 /* bits of the largest height, a quarter texel's sums hold two more */

static const WrCpuBuilds builds = { &wr_sky_kernels_v1, &wr_sky_kernels_v3, &wr_sky_kernels_v4 };

const WrSkyKernels *wr_sky_kernels_at(int index)
{
    return wr_cpu_build(&builds, index);
}

const WrSkyKernels *wr_sky_kernels(void)
{
    return wr_cpu_best(&builds);
}

/* ---- directions ---------------------------------------------------------------------------------- */

/* In scene units, y up. */
static void vector_of(const WrOcclusion *o, int k, double *x, double *y)
{
    double i, j;
    wr_horizon_direction((k + o->directions) % o->directions, o->directions, &i, &j);
    *x = i * o->texel_w;
    *y =
        j *
        o->texel_h; /* anticlockwise: rows count downwards, as directions of a table do, so they meet -j */
}

static double turns_of(const WrOcclusion *o, int k)
{
    double x, y;
    vector_of(o, k, &x, &y);
    const double turns = wr_atan2(y, x) / (2 * WR_PI);
    return turns < 0 ? turns + 1 : turns;
}

double wr_occlusion_degrees(const WrOcclusion *occlusion, int k)
{
    return 360 * turns_of(occlusion, k);
}

static double between(double from, double to)
{
    return to < from ? to + 1 - from : to - from;
}

WrSkyCourse wr_sky_course(const WrOcclusion *occlusion, int pair)
{
    const WrOcclusion *o = occlusion;
    const int half = o->directions / 2, fine = o->directions < 8 ? 1 : o->directions / 8;
    double i, j, x, y;
    wr_horizon_direction(pair, o->directions, &i, &j);
    j = -j;
    WrSkyCourse c = { .upright = fabs(j) >= fabs(i) }; /* rows of texels lie side by side */
    const bool back = (c.upright ? j : i) < 0;
    c.k = back ? pair + half : pair;
    if (back) i = -i, j = -j;
    c.q = fine;
    c.p = (int)lrint(fine * (c.upright ? i : j));
    while (c.q > 1 && c.p % 2 == 0) c.q /= 2, c.p /= 2;
    vector_of(o, c.k, &x, &y);
    c.step = sqrt(x * x + y * y);
    const double before = turns_of(o, c.k - 1), after = turns_of(o, c.k + 1);
    c.share = (WrSkyShare){ 0, (float)(x / c.step), (float)(y / c.step),
                            (float)(between(before, after) / 2) };
    return c;
}

void wr_sky_finish(const WrMapPart *part, int row, const float *p, const float *q, float *out)
{
    const size_t at = (size_t)row * part->pitch;
    for (int i = 0; i < part->w; i++) {
        const float x = p[at + (size_t)i], y = q[at + (size_t)i];
        const float seen = (1 - out[at + (size_t)i]) / sqrtf(1 + x * x + y * y);
        out[at + (size_t)i] = seen < 0 ? 0 : seen < 1 ? seen : 1;
    }
}

/* ---- lines --------------------------------------------------------------------------------------- */

/* The whole table, in steps that are a power of two, so that nothing is rounded that floats hold apart. */
typedef struct Sky {
    const WrOcclusion *occlusion;
    const WrMapPart *part;
    int32_t *steps;
    size_t pitch;
    double unit;  /* scene units a step */
    double range; /* scene units */
    int k;        /* < 0: occlusion */
    const float *p, *q;
    float *out;
    const WrSkyKernels *kernels;
} Sky;

/* All lines of one course. */
typedef struct Lines {
    const Sky *sky;
    WrSkyCourse course;
    int along, across; /* texels of the own axis and of the other */
    bool turns_along, turns_across;
    int ahead;            /* rows that are looked at beyond the table */
    int first, stripes;   /* of lanes, over the other axis */
    double scale;         /* of steps a row */
    struct Work **worker; /* [threads] */
} Lines;

typedef struct Work {
    int32_t *h, *next, *top; /* [ahead + along + ahead][LANES] */
    int *rows;               /* [along + ahead] */
    float *slope[2];         /* [along][LANES] */
} Work;

/* Lines are a few tables long: most of them need no division. */
static int place(int64_t at, int n, bool turns)
{
    if (!turns) return at < 0 ? 0 : at < n ? (int)at : n - 1;
    if (at >= n) at -= n;
    else if (at < 0) at += n;
    if (at >= 0 && at < n) return (int)at;
    const int left = (int)(at % n);
    return left < 0 ? left + n : left;
}

/* How far a line has moved over the other axis after some rows, in parts of a texel: q is 1, 2 or 4. */
static int64_t whole_of(int64_t parts, int q)
{
    return q == 1 ? parts : q == 2 ? parts >> 1 : parts >> 2;
}

/* Texels of row `row` of the own axis, lanes from `from` on over the other. */
static void texels(const Lines *l, int row, int64_t from, int32_t *restrict out)
{
    const Sky *sky = l->sky;
    const size_t own = l->course.upright ? sky->pitch : 1,
                 other = l->course.upright ? 1 : sky->pitch;
    const int32_t *at = sky->steps + (size_t)row * own;
    const int first = place(from, l->across, l->turns_across);
    const bool inside = l->turns_across || (from >= 0 && from < l->across);
    if (inside && first + LANES <= l->across) {
        at += (size_t)first * other;
        if (other == 1) memcpy(out, at, LANES * sizeof *out);
        else
            for (int i = 0; i < LANES; i++) out[i] = at[(size_t)i * other];
        return;
    }
    for (int i = 0; i < LANES; i++)
        out[i] = at[(size_t)place(from + i, l->across, l->turns_across) * other];
}

/* Row s, beyond the table too, of lanes that start at `base` and meet texels in rows of this phase. */
static void sample(const Lines *l, int64_t s, int64_t base, int phase, int32_t *restrict out)
{
    const int q = l->course.q;
    const int64_t moved = (int64_t)l->course.p * (s - phase), whole = whole_of(moved, q);
    const int part = (int)(moved - whole * q), row = place(s, l->along, l->turns_along);
    texels(l, row, base + whole, out);
    if (q == 1) return;
    if (part == 0) {
        for (int i = 0; i < LANES; i++) out[i] *= q;
        return;
    }
    int32_t beside[LANES];
    texels(l, row, base + whole + 1, beside);
    for (int i = 0; i < LANES; i++) out[i] = (q - part) * out[i] + part * beside[i];
}

/* Of what lies beyond the table only rows count that are higher than all before them, in some lane. */
static int beyond(const Lines *l, int sign, int64_t base, int phase, Work *work)
{
    int32_t highest[LANES], row[LANES];
    int count = 0;
    for (int i = 0; i < LANES; i++) highest[i] = INT32_MIN;
    for (int k = 0; k < l->ahead; k++) {
        const int64_t s = sign > 0 ? l->along + k : -1 - k;
        sample(l, s, base, phase, row);
        if (!l->sky->kernels->higher(row, highest)) continue;
        memcpy(work->h + (s + l->ahead) * LANES, row, sizeof row);
        work->rows[count++] = (int)(s + l->ahead);
    }
    for (int i = 0; i < count / 2; i++) {
        const int far = work->rows[count - 1 - i];
        work->rows[count - 1 - i] = work->rows[i];
        work->rows[i] = far;
    }
    return count;
}

static int opposite_of(const Lines *l)
{
    const int directions = l->sky->occlusion->directions;
    return (l->course.k + directions / 2) % directions;
}

/* Horizons ahead, and behind, of lanes from `base` on. */
static void sweep_both(const Lines *l, int64_t base, int phase, Work *work)
{
    const int opposite = opposite_of(l);
    for (int s = 0; s < l->along; s++)
        sample(l, s, base, phase, work->h + (size_t)(s + l->ahead) * LANES);
    for (int side = 0; side < 2; side++) {
        if (l->sky->k >= 0 && l->sky->k != (side ? opposite : l->course.k)) continue;
        const int count = beyond(l, side ? -1 : 1, base, phase, work);
        for (int i = 0; i < l->along; i++)
            work->rows[count + i] = l->ahead + (side ? i : l->along - 1 - i);
        const WrSkySweep sweep = { work->h,    work->next,       work->top,
                                   work->rows, count + l->along, count };
        l->sky->kernels->sweep(&sweep, l->scale, work->slope[side] - (ptrdiff_t)l->ahead * LANES);
    }
}

/* ---- what is made of them ------------------------------------------------------------------------ */

/* Texels that lie side by side, and their horizons. */
static void take(const Lines *l, size_t at, const float *ahead, const float *behind, int count)
{
    const Sky *sky = l->sky;
    if (sky->k < 0) {
        sky->kernels->share(&l->course.share, ahead, behind, sky->p + at, sky->q + at, count,
                            sky->out + at);
        return;
    }
    const float level = l->course.share.level;
    const float *slope = sky->k == l->course.k ? ahead : behind;
    for (int i = 0; i < count; i++) {
        const float over = slope[i] > level ? 2 * (slope[i] - level) : 0;
        sky->out[at + (size_t)i] = over < slope[i] ? over : slope[i];
    }
}

/* The lanes of row s, whose other axis is that of the table's rows. */
static void put_row(const Lines *l, int64_t start, int lanes, int s, const Work *work)
{
    const size_t from = (size_t)s * LANES, row = (size_t)s * l->sky->part->pitch;
    const float *ahead = work->slope[0] + from, *behind = work->slope[1] + from;
    for (int i = 0, more; i < lanes; i += more) {
        const int64_t at = start + i;
        const int across = place(at, l->across, l->turns_across);
        more = l->across - across < lanes - i ? l->across - across : lanes - i;
        if (!l->turns_across && at < 0) more = -at < lanes - i ? (int)-at : lanes - i;
        else if (!l->turns_across && at >= l->across) more = lanes - i;
        else take(l, row + (size_t)across, ahead + i, behind + i, more);
    }
}

/* Rows s, s + q, ... as far as they are in order, up to LANES of them: lane by lane, since it is there that texels lie side
 * by side. */
static int put_block(const Lines *l, int64_t start, int lanes, int s, const Work *work)
{
    float turned[2][LANES][LANES];
    const int q = l->course.q, left = (l->along - s + q - 1) / q;
    const int rows = q > 1 || l->course.p != 0 ? 1 : left < LANES ? left : LANES;
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < rows; k++)
            for (int i = 0; i < LANES; i++)
                turned[side][i][k] = work->slope[side][(size_t)(s + k) * LANES + (size_t)i];
    for (int i = 0; i < lanes; i++) {
        if (!l->turns_across && (start + i < 0 || start + i >= l->across)) continue;
        const size_t row = (size_t)place(start + i, l->across, l->turns_across);
        take(l, row * l->sky->part->pitch + (size_t)s, turned[0][i], turned[1][i], rows);
    }
    return rows * q;
}

static void put_lines(const Lines *l, int64_t base, int phase, const Work *work)
{
    const int64_t left = l->turns_across ? l->across - base : LANES;
    const int lanes = left < LANES ? (int)left : LANES;
    for (int s = phase; s < l->along;) {
        const int64_t start = base + whole_of((int64_t)l->course.p * (s - phase), l->course.q);
        if (l->course.upright) {
            put_row(l, start, lanes, s, work);
            s += l->course.q;
        } else {
            s += put_block(l, start, lanes, s, work);
        }
    }
}

static void free_work(Work *work)
{
    if (!work) return;
    wr_free(work->h), wr_free(work->next), wr_free(work->top), wr_free(work->rows);
    wr_free(work->slope[0]), wr_free(work->slope[1]);
    wr_free(work);
}

static Work *new_work(const Lines *l)
{
    const size_t rows = (size_t)l->along + 2 * (size_t)l->ahead, main = (size_t)l->along;
    Work *work = wr_alloc(1, sizeof *work);
    work->h = wr_alloc_unset(rows * LANES, sizeof(int32_t));
    work->next = wr_alloc_unset(rows * LANES, sizeof(int32_t));
    work->top = wr_alloc_unset(rows * LANES, sizeof(int32_t));
    work->rows = wr_alloc_unset(rows, sizeof(int));
    for (int side = 0; side < 2; side++) work->slope[side] = wr_alloc(main * LANES, sizeof(float));
    return work;
}

static void piece(int index, int worker, void *ctx)
{
    const Lines *l = ctx;
    const int64_t base = l->first + (int64_t)(index % l->stripes) * LANES;
    if (!l->worker[worker]) l->worker[worker] = new_work(l);
    sweep_both(l, base, index / l->stripes, l->worker[worker]);
    put_lines(l, base, index / l->stripes, l->worker[worker]);
}

/* ---- a course ------------------------------------------------------------------------------------ */

static int64_t common(int64_t a, int64_t b)
{
    return b == 0 ? a : common(b, a % b);
}

/* Rows after which a line has nothing new to show: it is where it began, or goes along clamped edges. */
static int64_t period_of(const Lines *l)
{
    const int64_t q = l->course.q, p = llabs((long long)l->course.p);
    int64_t settle = 0, period = 1;
    if (l->turns_along) period = l->along / common(l->along, q) * q;
    else settle += l->along;
    if (p == 0) return settle + period;
    if (!l->turns_across) return settle + (l->across + p - 1) / p * q + period;
    if (!l->turns_along) return settle + q * l->across;
    const int64_t drift = p * period / q;
    return period * (l->across / common(l->across, drift % l->across));
}

static void open_lines(Lines *l)
{
    const WrField *field = l->sky->occlusion->field;
    const bool turns_u = wr_field_wrap_u(field) == WR_WRAP_PERIODIC;
    const bool turns_v = wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
    const int w = wr_field_width(field), h = wr_field_height(field), longer = w > h ? w : h;
    const int most = longer * WR_OCCLUSION_ROUND > WR_OCCLUSION_LEAST ? longer * WR_OCCLUSION_ROUND
                                                                      : WR_OCCLUSION_LEAST;
    l->along = l->course.upright ? h : w;
    l->across = l->course.upright ? w : h;
    l->turns_along = l->course.upright ? turns_v : turns_u;
    l->turns_across = l->course.upright ? turns_u : turns_v;
    const int64_t period = period_of(l);
    l->ahead = period <= most ? (int)period : most;
    l->course.share.level =
        period <= most ? 0 : (float)(l->sky->range / (l->ahead * l->course.step));
    l->scale = l->sky->unit / (l->course.q * l->course.step);
    const int drift = (int)whole_of((int64_t)l->course.p * l->along, l->course.q);
    const int less = l->turns_across || drift < 0 ? 0 : drift,
              more = l->turns_across || drift > 0 ? 0 : -drift;
    l->first = -less - (less > 0 ? LANES : 0);
    l->stripes = (l->across + more + (more > 0 ? LANES : 0) - l->first + LANES - 1) / LANES;
}

static bool run_pair(const Sky *sky, int pair, WrPool *pool)
{
    const int threads = wr_pool_threads(pool);
    Lines l = { .sky = sky, .course = wr_sky_course(sky->occlusion, pair) };
    const int opposite = opposite_of(&l);
    if (sky->k >= 0 && sky->k != l.course.k && sky->k != opposite) return true;
    open_lines(&l);
    l.worker = wr_alloc((size_t)threads, sizeof *l.worker);
    const bool good = wr_pool_run(pool, l.stripes * l.course.q, piece, &l);
    for (int i = 0; i < threads; i++) free_work(l.worker[i]);
    wr_free(l.worker);
    return good;
}

/* ---- a table ------------------------------------------------------------------------------------- */

static bool fill_steps(Sky *sky, WrError *err)
{
    const WrOcclusion *o = sky->occlusion;
    const int w = sky->part->w, h = sky->part->h;
    float low, high;
    wr_field_range(o->field, &low, &high);
    int exponent;
    frexp(fmax(fabs((double)low), fabs((double)high)), &exponent);
    const double scale = ldexp(o->height < 0 ? -1 : 1, STEPS - exponent);
    sky->unit = fabs(o->height) * ldexp(1, exponent - STEPS);
    sky->range = fabs(o->height) * ((double)high - (double)low);
    sky->pitch = (size_t)w + 16 + (size_t)(w % 2 == 0); /* not a power of two */
    sky->steps = wr_try_alloc(sky->pitch * (size_t)h, sizeof(int32_t), "occlusion", err);
    float *row = wr_alloc_unset((size_t)w, sizeof *row);
    for (int j = 0; j < h && sky->steps; j++) {
        wr_field_read(o->field, 0, j, w, 1, row, (size_t)w);
        int32_t *out = sky->steps + (size_t)j * sky->pitch;
        for (int i = 0; i < w; i++) out[i] = (int32_t)lrint(scale * (double)row[i]);
    }
    wr_free(row);
    return sky->steps != NULL;
}

static bool run_table(Sky *sky, WrPool *pool, WrError *err)
{
    const int pairs = sky->occlusion->directions / 2;
    for (int pair = 0; pair < pairs; pair++)
        if (!run_pair(sky, pair, pool) || !wr_progress_tell((pair + 1.0) / pairs))
            return wr_fail(err, "occlusion: cancelled");
    for (int j = 0; j < sky->part->h && sky->k < 0; j++)
        wr_sky_finish(sky->part, j, sky->p, sky->q, sky->out);
    return true;
}

static bool make(const WrOcclusion *occlusion, const WrMapPart *part, int k, const float *p,
                 const float *q, WrPool *pool, float *out, WrError *err)
{
    if (occlusion->reach > 0) return wr_sky_near(occlusion, part, k, p, q, pool, out, err);
    Sky sky = { occlusion, part, NULL, 0, 0, 0, k, p, q, out, wr_sky_kernels() };
    for (int j = 0; j < part->h; j++)
        memset(out + (size_t)j * part->pitch, 0, (size_t)part->w * sizeof *out);
    const bool good = fill_steps(&sky, err) && run_table(&sky, pool, err);
    wr_free(sky.steps);
    return good;
}

bool wr_occlusion_make(const WrOcclusion *occlusion, const WrMapPart *part, const float *p,
                       const float *q, WrPool *pool, float *out, WrError *err)
{
    return make(occlusion, part, -1, p, q, pool, out, err);
}

bool wr_occlusion_horizon(const WrOcclusion *occlusion, const WrMapPart *part, int k, WrPool *pool,
                          float *out, WrError *err)
{
    return make(occlusion, part, k, NULL, NULL, pool, out, err);
}

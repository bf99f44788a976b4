/* Operations over a neighbourhood: blur, unsharp mask, median, dilate, erode, slope limit. */
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/filter_kernels.h"
#include "field/ops_internal.h"

#include <math.h>
#include <string.h>

/* ---- wide Gaussian blur ---- */

/* A wide Gaussian blur at a cost that hardly depends on its width.
 *
 * Four successive boxes approximate a Gaussian, but flatter: the excess kurtosis is -1.2/4. The mean of
 * two such kernels with variances sigma^2 (1 - 1/3) and sigma^2 (1 + 1/3) has the variance sigma^2 and
 * no excess kurtosis. It differs from the Gaussian by 0.7 % in the sum of |differences| (four plain
 * boxes: 3.9 %), so that along one axis the error of a blurred height is at most 0.35 % of the table's
 * range; it has three continuous derivatives and no negative weight.
 *
 * A box of real variance v has 2r + 1 whole texels and a fraction `end` of one more on either side:
 *
 *   v = ((2r + 1) r (r + 1)/3 + 2 end (r + 1)^2) / (2r + 1 + 2 end),  0 <= end < 1.
 *
 * Box sums run along the row: one texel is added, one subtracted. They must not depend on their
 * starting point (a rolled table produces rolled heights, a flat place stays flat), so they are sums of
 * integers, which doubles represent exactly: heights are counted in steps of 2^-40 of the largest |F|,
 * rounded up to a power of two, and each box's result is rounded to whole steps again. A box has less
 * than 2^12 texels. */

#define LANES WR_BOX_LANES
#define BOXES 4
#define CHAINS 2
#define BITS 40

typedef struct WideBlur {
    const WrField *in;
    WrOpPlane *plane;
    WrBox box[CHAINS];
    const WrTaps *taps;
    int apron;            /* texels read on either side of a row */
    double scale, step;   /* steps in a table unit, and its inverse; powers of two */
    double *work;         /* [threads][pitch] */
    size_t pitch, length; /* doubles; `length` of one row of LANES with its aprons */
} WideBlur;

static WrBox box_of(double variance)
{
    int r = (int)((sqrt(1.0 + 12.0 * variance) - 1.0) / 2.0);
    while (r > 0 && r * (r + 1.0) / 3.0 > variance) r--;
    while ((r + 1.0) * (r + 2.0) / 3.0 <= variance) r++;
    double whole = 2.0 * r + 1.0, next = (r + 1.0) * (r + 1.0);
    double end = whole * (variance - r * (r + 1.0) / 3.0) / (2.0 * (next - variance));
    return (WrBox){ r, end, 1.0 / (whole + 2.0 * end) };
}

/* Filters `count` elements of LANES steps each; row begins with the apron. Returns the sum of both
   chains, [count][LANES]. */
static const double *run_chains(const WideBlur *wide, double *row, int count)
{
    double *a = row + wide->length, *b = a + wide->length, *sum = b + wide->length;
    for (int chain = 0; chain < CHAINS; chain++) {
        const WrBox *box = &wide->box[chain];
        int ring = box->r + 1, skip = wide->apron - BOXES * ring;
        const double *from = row + (size_t)skip * LANES;
        for (int pass = 1; pass <= BOXES; pass++) {
            double *to = pass == BOXES && chain == 0 ? sum : pass % 2 ? a : b;
            wide->taps->box(box, from, count + 2 * ring * (BOXES - pass), to);
            from = to;
        }
        if (chain > 0)
            for (size_t i = 0; i < (size_t)count * LANES; i++) sum[i] += from[i];
    }
    return sum;
}

static void blur_rows(int index, int worker, void *ctx)
{
    const WideBlur *wide = ctx;
    const WrOpPlane *plane = wide->plane;
    int j = index * LANES, rows = plane->height - j < LANES ? plane->height - j : LANES;
    int across = plane->width + 2 * wide->apron;
    double *row = wide->work + (size_t)worker * wide->pitch;
    float *texels = (float *)(row + 4 * wide->length);
    for (int lane = 0; lane < rows; lane++) {
        wr_op_read(wide->in, -wide->apron, j + lane, across, 1, texels, (size_t)across);
        wide->taps->to_steps(wide->scale, texels, across, row + lane);
    }
    const double *sum = run_chains(wide, row, plane->width);
    for (int lane = 0; lane < rows; lane++) {
        float *to = plane->at + (size_t)(j + lane) * plane->pitch;
        wr_field_read(wide->in, 0, j + lane, plane->width, 1, to, plane->pitch);
        wide->taps->add_steps(wide->scale, wide->step, sum + lane, plane->width, to);
    }
}

static int row_of(const WideBlur *wide, int j)
{
    int height = wide->plane->height;
    if (wr_field_wrap_v(wide->in) == WR_WRAP_CLAMP) return j < 0 ? 0 : j < height ? j : height - 1;
    int rest = j % height;
    return rest < 0 ? rest + height : rest;
}

static void blur_columns(int index, int worker, void *ctx)
{
    const WideBlur *wide = ctx;
    const WrOpPlane *plane = wide->plane;
    int i = index * LANES; /* the last ones may extend into the gap between rows */
    double *row = wide->work + (size_t)worker * wide->pitch;
    for (int y = 0; y < plane->height + 2 * wide->apron; y++) {
        const float *from = plane->at + (size_t)row_of(wide, y - wide->apron) * plane->pitch + i;
        wide->taps->to_steps_across(wide->scale, from, row + (size_t)y * LANES);
    }
    const double *sum = run_chains(wide, row, plane->height);
    for (int y = 0; y < plane->height; y++) {
        float *to = plane->at + (size_t)y * plane->pitch + i;
        wide->taps->add_steps_across(wide->scale, wide->step, sum + (size_t)y * LANES, to);
    }
}

/* Powers of two, so that scaling is exact. A table of zeros has any scale. */
static void set_scale(WideBlur *wide)
{
    float low, high;
    wr_field_range(wide->in, &low, &high);
    double largest = fmax(fabs((double)low), fabs((double)high));
    int exponent = largest > 0.0 ? ilogb(largest) + 1 : 0;
    wide->scale = scalbn(1.0, BITS - exponent);
    wide->step = scalbn(1.0, exponent - BITS);
}

static bool run_axes(const WrOpJob *job, WideBlur *wide)
{
    WrOpJob half = *job;
    half.to = 0.5 * (job->from + job->to);
    if (!wr_op_pieces(&half, (wide->plane->height + LANES - 1) / LANES, blur_rows, wide))
        return false;
    half.from = half.to;
    half.to = job->to;
    return wr_op_pieces(&half, (wide->plane->width + LANES - 1) / LANES, blur_columns, wide);
}

/* The blurred input for sigma above WR_OP_NARROW_SIGMA, by repeated boxes. */
static bool op_blur_wide(const WrOpJob *job, double sigma, WrOpPlane *plane)
{
    WideBlur wide = { .in = job->in, .plane = plane, .taps = wr_taps() };
    double third = sigma * sigma / 3.0;
    wide.box[0] = box_of(2.0 * third / BOXES);
    wide.box[1] = box_of(4.0 * third / BOXES);
    wide.apron = BOXES * (wide.box[1].r + 1);
    set_scale(&wide);
    int longest = plane->width > plane->height ? plane->width : plane->height;
    size_t across = (size_t)longest + 2 * (size_t)wide.apron;
    wide.length = across * LANES;
    wide.pitch = 4 * wide.length + across; /* the last is a row of floats */
    wide.work = wr_try_alloc((size_t)wr_pool_threads(job->pool), wide.pitch * sizeof(double),
                             job->name, job->err);
    if (!wide.work) return false;
    bool good = run_axes(job, &wide);
    wr_free(wide.work);
    return good;
}

/* ---- Gaussian blur and unsharp mask ---- */

/* Gaussian blur and the unsharp mask.
 *
 * Along each axis, with w the weights and R = 4 sigma,
 *
 *   out = c + sum over k = 1..R of w_k ((T[-k] + T[+k]) - 2 c),   c = T[0],
 *
 * which is sum w_k T[k] since the weights add to 1. In this form a flat neighbourhood yields exactly c,
 * and float's rounding applies only to the differences. The tails beyond 4 sigma have a weight of 6e-5.
 *
 * A block is read with an apron of R texels, filtered along u, then along v. The block stays in the
 * second-level cache, the rows filtered at once in the first. */

#define REACH WR_OP_NARROW_REACH
#define SIDE WR_OP_SIDE
#define BLUR_LANES WR_TAPS_LANES
#define WIDE (SIDE + 2 * REACH)  /* a block with its apron */
#define ROWS (WIDE + BLUR_LANES) /* padded: the last LANES may extend beyond it */
#define READ_PITCH (WIDE + 16)
#define MID_PITCH (SIDE + 16)
#define LOG2_E 1.4426950408889634

static int op_gauss(double sigma, float weight[REACH + 1])
{
    double raw[REACH + 1], sum = 1.0;
    int reach = (int)ceil(4.0 * sigma);
    reach = reach > REACH ? REACH : reach;
    raw[0] = 1.0;
    for (int k = 1; k <= reach; k++) {
        double x = k / sigma;
        raw[k] = wr_exp2(-0.5 * LOG2_E * x * x);
        sum += 2.0 * raw[k];
    }
    for (int k = 0; k <= REACH; k++) weight[k] = k <= reach ? (float)(raw[k] / sum) : 0.0f;
    return reach;
}

typedef struct Blur {
    int reach;
    float weight[REACH + 1];
    float amount; /* fraction of the blurred difference that is added to the height: 1 for a blur */
} Blur;

/* Buffers of a thread. */
typedef struct BlurDesk {
    float in[ROWS * READ_PITCH]; /* the block with its apron */
    float mid[ROWS * MID_PITCH]; /* filtered along u */
    float turned[WIDE * BLUR_LANES],
        done[SIDE * BLUR_LANES]; /* LANES rows transposed to columns; filtered */
} BlurDesk;

/* Filters LANES rows along u: transposed, so that the texels of one vector are contiguous. */
static void filter_rows(const Blur *blur, int count, const float *in, float *mid, BlurDesk *desk)
{
    const WrTaps *taps = wr_taps();
    const int r = blur->reach;
    for (int x = 0; x < count + 2 * r; x += BLUR_LANES)
        taps->turn(in + x, READ_PITCH, desk->turned + x * BLUR_LANES, BLUR_LANES);
    taps->smooth(blur->weight, r, desk->turned + r * BLUR_LANES, BLUR_LANES, count, desk->done,
                 BLUR_LANES);
    for (int x = 0; x < count; x += BLUR_LANES)
        taps->turn(desk->done + x * BLUR_LANES, BLUR_LANES, mid + x, MID_PITCH);
}

/* Converts the sums along v to heights. */
static void sharpen(const Blur *blur, const WrOpBlock *b, const BlurDesk *desk, float *out,
                    size_t pitch)
{
    const int r = blur->reach;
    for (int y = 0; y < b->count_j; y++) {
        const float *centre = desk->mid + (y + r) * MID_PITCH;
        const float *was = desk->in + (y + r) * READ_PITCH + r;
        float *row = out + (size_t)y * pitch;
        for (int k = 0; k < b->count_i; k++)
            row[k] = was[k] + blur->amount * ((centre[k] - was[k]) + row[k]);
    }
}

/* The lower rows needed by the block above are the top rows of this one: reuses them and returns their
 * number. */
static int keep_rows(const Blur *blur, const WrOpBlock *b, BlurDesk *desk)
{
    const size_t rows = b->follows ? 2 * (size_t)blur->reach : 0;
    memmove(desk->in, desk->in + SIDE * READ_PITCH, rows * READ_PITCH * sizeof *desk->in);
    memmove(desk->mid, desk->mid + SIDE * MID_PITCH, rows * MID_PITCH * sizeof *desk->mid);
    return (int)rows;
}

static void make_blurred(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    BlurDesk *desk = scratch;
    const Blur *blur = ctx;
    const WrTaps *taps = wr_taps();
    const int r = blur->reach, rows = b.count_j + 2 * r, first = keep_rows(blur, &b, desk);
    const bool blurs = blur->amount == 1.0f;
    wr_op_read(job->in, b.i - r, b.j - r + first, b.count_i + 2 * r, rows - first,
               desk->in + first * READ_PITCH, READ_PITCH);
    for (int y = first; y < rows; y += BLUR_LANES)
        filter_rows(blur, b.count_i, desk->in + y * READ_PITCH, desk->mid + y * MID_PITCH, desk);
    for (int x = 0; x < b.count_i; x += BLUR_LANES)
        (blurs ? taps->smooth : taps->add)(blur->weight, r, desk->mid + r * MID_PITCH + x,
                                           MID_PITCH, b.count_j, out + x, (ptrdiff_t)pitch);
    if (!blurs) sharpen(blur, &b, desk, out, pitch);
}

typedef struct Wide {
    const WrOpPlane *plane;
    float amount;
} Wide;

static void make_wide(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                      void *scratch)
{
    (void)scratch;
    const Wide *wide = ctx;
    wr_field_read(job->in, b.i, b.j, b.count_i, b.count_j, out, pitch);
    for (int y = 0; y < b.count_j; y++) {
        const float *blurred = wide->plane->at + (size_t)(b.j + y) * wide->plane->pitch + b.i;
        float *row = out + (size_t)y * pitch;
        if (wide->amount == 1.0f)
            for (int x = 0; x < b.count_i; x++) row[x] = blurred[x];
        else
            for (int x = 0; x < b.count_i; x++)
                row[x] = row[x] + wide->amount * (blurred[x] - row[x]);
    }
}

static WrField *run_blur(WrOpJob *job, double sigma, double amount)
{
    if (sigma <= WR_OP_NARROW_SIGMA) {
        Blur blur = { .amount = (float)amount };
        blur.reach = op_gauss(sigma, blur.weight);
        WrOpWork work = { .make = make_blurred,
                          .ctx = &blur,
                          .scratch = sizeof(BlurDesk),
                          .input = { (size_t)blur.reach * (READ_PITCH + 1), READ_PITCH },
                          .reach = blur.reach,
                          .window = 2 * blur.reach + 1 };
        return wr_op_build_same(job, &work);
    }
    WrOpPlane plane;
    if (!wr_op_plane_init(&plane, job)) return NULL;
    Wide wide = { &plane, (float)amount };
    WrOpWork work = { .make = make_wide, .ctx = &wide, .reach = -1 };
    WrField *out = NULL;
    const double to = job->to;
    job->to = job->from + 0.8 * (to - job->from);
    if (op_blur_wide(job, sigma, &plane)) {
        job->from = job->to;
        job->to = to;
        out = wr_op_build_same(job, &work);
    }
    wr_op_plane_fini(&plane);
    return out;
}

/* param: sigma */
WrField *wr_op_blur(WrOpJob *job, const double *param)
{
    return run_blur(job, param[0], 1.0);
}

/* F + amount (F - blurred F); param: amount, sigma */
WrField *wr_op_sharpen(WrOpJob *job, const double *param)
{
    return run_blur(job, param[1], -param[0]);
}

/* ---- median ---- */

/* Exact median over a window.
 *
 * Works on one tile at a time: the heights of the tile and its apron (at most 128 x 128) are sorted
 * once and then represented by their ranks, so that a window's contents are a bit set. The window moves
 * over the tile in a serpentine: right, down, left, down; each step adds the texels of one edge and
 * removes those of the other. The number of members in words before a current one is kept up to date,
 * and the median's word is never far away. */

#define MEDIAN_RADIUS_MAX 32
#define MEDIAN_WIDE (WR_TILE + 2 * MEDIAN_RADIUS_MAX)
#define TEXELS (MEDIAN_WIDE * MEDIAN_WIDE)
#define WORDS (TEXELS / 64)

typedef struct Median {
    int reach;
    int half[2 * MEDIAN_RADIUS_MAX +
             1]; /* half width of the window's row (and column) -reach .. reach */
    int size;    /* texels in the window; odd */
} Median;

/* Scratch memory of one thread. */
typedef struct MedianDesk {
    float height[TEXELS]; /* the tile and its apron, `pitch` a row */
    float sorted[TEXELS]; /* by rank */
    uint16_t rank[TEXELS];
    uint64_t item[2][TEXELS]; /* key << 32 | position */
    uint64_t word[WORDS];     /* members, by rank */
    uint8_t members[WORDS];
    int pitch;
    int at, below; /* a word, and the members in those before it */
} MedianDesk;

/* Maps the order of heights to the order of integers; -0 and 0 are equal. */
static uint32_t key_of(float height)
{
    union {
        float f;
        uint32_t u;
    } bits = { height == 0.0f ? 0.0f : height };
    return bits.u & 0x80000000u ? ~bits.u : bits.u | 0x80000000u;
}

/* Sorts by key with a radix sort, 11 bits at a time from the lowest; stable. */
static void set_ranks(MedianDesk *desk, int count)
{
    enum { DIGIT = 11, VALUES = 1 << DIGIT };
    for (int k = 0; k < count; k++)
        desk->item[0][k] = (uint64_t)key_of(desk->height[k]) << 32 | (uint32_t)k;
    for (int pass = 0; pass < 3; pass++) {
        const uint64_t *from = desk->item[pass % 2];
        uint64_t *to = desk->item[1 - pass % 2];
        int start[VALUES + 1] = { 0 }, shift = 32 + DIGIT * pass;
        for (int k = 0; k < count; k++) start[(from[k] >> shift & (VALUES - 1)) + 1]++;
        for (int v = 0; v < VALUES; v++) start[v + 1] += start[v];
        for (int k = 0; k < count; k++) to[start[from[k] >> shift & (VALUES - 1)]++] = from[k];
    }
    for (int r = 0; r < count; r++) {
        uint32_t place = (uint32_t)desk->item[1][r];
        desk->rank[place] = (uint16_t)r;
        desk->sorted[r] = desk->height[place] == 0.0f ? 0.0f : desk->height[place];
    }
}

static void take_in(MedianDesk *desk, int x, int y)
{
    int rank = desk->rank[y * desk->pitch + x], w = rank >> 6;
    desk->word[w] |= 1ull << (rank & 63);
    desk->members[w]++;
    desk->below += w < desk->at;
}

static void drop(MedianDesk *desk, int x, int y)
{
    int rank = desk->rank[y * desk->pitch + x], w = rank >> 6;
    desk->word[w] &= ~(1ull << (rank & 63));
    desk->members[w]--;
    desk->below -= w < desk->at;
}

/* The member with `before` members before it. */
static float member(MedianDesk *desk, int before)
{
    while (desk->below > before) desk->below -= desk->members[--desk->at];
    while (desk->below + desk->members[desk->at] <= before)
        desk->below += desk->members[desk->at++];
    uint64_t word = desk->word[desk->at];
    for (int skip = before - desk->below; skip > 0; skip--) word &= word - 1;
    return desk->sorted[desk->at * 64 + __builtin_ctzll(word)];
}

/* Moves the window's centre from (x, y) to the right (+1) or to the left (-1). */
static void step_across(const Median *median, MedianDesk *desk, int x, int y, int way)
{
    for (int d = -median->reach; d <= median->reach; d++) {
        int half = median->half[d + median->reach];
        take_in(desk, x + way * (half + 1), y + d);
        drop(desk, x - way * half, y + d);
    }
}

static void step_down(const Median *median, MedianDesk *desk, int x, int y)
{
    for (int d = -median->reach; d <= median->reach; d++) {
        int half = median->half[d + median->reach];
        take_in(desk, x + d, y + half + 1);
        drop(desk, x + d, y - half);
    }
}

static void plough(const Median *median, MedianDesk *desk, int count_i, int count_j, float *out,
                   size_t pitch)
{
    int r = median->reach, way = 1, x = 0;
    memset(desk->word, 0, sizeof desk->word);
    memset(desk->members, 0, sizeof desk->members);
    desk->at = desk->below = 0;
    for (int d = -r; d <= r; d++)
        for (int e = -median->half[d + r]; e <= median->half[d + r]; e++)
            take_in(desk, r + e, r + d);
    for (int y = 0; y < count_j; y++, way = -way) {
        for (int k = 0; k < count_i; k++) {
            out[(size_t)y * pitch + x] = member(desk, median->size / 2);
            if (k == count_i - 1) break;
            step_across(median, desk, r + x, r + y, way);
            x += way;
        }
        if (y < count_j - 1) step_down(median, desk, r + x, r + y);
    }
}

static void make_median(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                        void *scratch)
{
    const Median *median = ctx;
    MedianDesk *desk = scratch;
    int r = median->reach;
    for (int y = 0; y < b.count_j; y += WR_TILE)
        for (int x = 0; x < b.count_i; x += WR_TILE) {
            int count_i = b.count_i - x < WR_TILE ? b.count_i - x : WR_TILE;
            int count_j = b.count_j - y < WR_TILE ? b.count_j - y : WR_TILE;
            if (wr_progress_cancelled(job->progress)) return;
            desk->pitch = count_i + 2 * r;
            wr_op_read(job->in, b.i + x - r, b.j + y - r, desk->pitch, count_j + 2 * r,
                       desk->height, (size_t)desk->pitch);
            set_ranks(desk, desk->pitch * (count_j + 2 * r));
            plough(median, desk, count_i, count_j, out + (size_t)y * pitch + x, pitch);
        }
}

/* param: radius, window */
WrField *wr_op_median(WrOpJob *job, const double *param)
{
    double radius = param[0];
    bool square = param[1] == WR_WINDOW_SQUARE;
    Median median = { .reach = (int)floor(radius) };
    for (int d = -median.reach; d <= median.reach; d++) {
        int half = square ? median.reach : (int)floor(sqrt(radius * radius - (double)d * d));
        median.half[d + median.reach] = half;
        median.size += 2 * half + 1;
    }
    WrOpWork work = { .make = make_median,
                      .ctx = &median,
                      .scratch = sizeof(MedianDesk),
                      .reach = median.reach,
                      .window = 2 * median.reach + 1 };
    return wr_op_build_same(job, &work);
}

/* ---- dilate and erode ---- */

/* Dilate and erode: largest and smallest height in a round window.
 *
 * The window's row d has the half width h = floor(sqrt(radius^2 - d^2)). The largest of 2h + 1 texels
 * is the larger of two overlapping runs whose length is a power of two. The maxima of all such runs are
 * computed once for each input row (each length from the previous one), and then merged into the output
 * rows whose window contains this row. Only comparisons are used, so the result is exact; eroding is
 * dilating -F. */

#define MORPH_RADIUS_MAX 64
#define MORPH_WIDE (SIDE + 2 * MORPH_RADIUS_MAX)
#define LEVELS 8 /* runs of 1, 2, .. 128 texels */

typedef struct Morph {
    int reach;
    int half[2 * MORPH_RADIUS_MAX + 1],
        level[2 * MORPH_RADIUS_MAX + 1]; /* for the window's row -reach .. reach */
    int levels;
    bool erode;
} Morph;

static void negate(float *row, int count)
{
    for (int i = 0; i < count; i++) row[i] = -row[i];
}

static void larger(const float *a, const float *b, int count, float *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) out[i] = a[i] > b[i] ? a[i] : b[i];
}

static void larger_of_three(const float *a, const float *b, int count, float *restrict out)
{
#pragma omp simd
    for (int i = 0; i < count; i++) {
        float x = a[i] > b[i] ? a[i] : b[i];
        out[i] = x > out[i] ? x : out[i];
    }
}

/* runs[level][i] = largest of 2^level texels from i on; runs[0] is given. */
static void make_runs(const Morph *morph, float (*runs)[MORPH_WIDE], int count)
{
    for (int level = 1; level < morph->levels; level++) {
        int step = 1 << (level - 1), left = count - 2 * step + 1;
        if (left > 0) larger(runs[level - 1], runs[level - 1] + step, left, runs[level]);
    }
}

static void make_dilated(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    const Morph *morph = ctx;
    float(*runs)[MORPH_WIDE] = scratch;
    int r = morph->reach, across = b.count_i + 2 * r;
    for (int y = 0; y < b.count_j; y++)
        for (int x = 0; x < b.count_i; x++) out[(size_t)y * pitch + x] = -FLT_MAX;
    for (int row = -r; row < b.count_j + r; row++) {
        wr_op_read(job->in, b.i - r, b.j + row, across, 1, runs[0], MORPH_WIDE);
        if (morph->erode) negate(runs[0], across);
        make_runs(morph, runs, across);
        int first = row - r < 0 ? 0 : row - r, last = row + r < b.count_j ? row + r : b.count_j - 1;
        for (int y = first; y <= last; y++) {
            int d = row - y + r, half = morph->half[d];
            const float *run = runs[morph->level[d]] + r;
            larger_of_three(run - half, run + half + 1 - (1 << morph->level[d]), b.count_i,
                            out + (size_t)y * pitch);
        }
    }
    if (morph->erode)
        for (int y = 0; y < b.count_j; y++) negate(out + (size_t)y * pitch, b.count_i);
}

static WrField *run_morph(WrOpJob *job, double radius, bool erode)
{
    Morph morph = { .reach = (int)floor(radius), .levels = 1, .erode = erode };
    for (int d = -morph.reach; d <= morph.reach; d++) {
        int half = (int)floor(sqrt(radius * radius - (double)d * d)), level = 0;
        while (2 << level <= 2 * half + 1) level++;
        morph.half[d + morph.reach] = half;
        morph.level[d + morph.reach] = level;
        morph.levels = level + 1 > morph.levels ? level + 1 : morph.levels;
    }
    WrOpWork work = { .make = make_dilated,
                      .ctx = &morph,
                      .scratch = sizeof(float[LEVELS][MORPH_WIDE]),
                      .reach = morph.reach,
                      .window = 2 * morph.reach + 1 };
    return wr_op_build_same(job, &work);
}

/* param: radius */
WrField *wr_op_dilate(WrOpJob *job, const double *param)
{
    return run_morph(job, param[0], false);
}

WrField *wr_op_erode(WrOpJob *job, const double *param)
{
    return run_morph(job, param[0], true);
}

/* ---- slope limit ---- */

/* Slope limit: the largest function G below F whose heights differ by at most `limit` from one texel to
 * the next along an axis, and by sqrt(2) limit along a diagonal:
 *
 *   G(p) = min over q of F(q) + limit |p - q|,   |p - q| the length of the shortest path by such steps.
 *
 * It is the largest solution of G = min(F, G of the eight neighbours + a step). Float addition is
 * monotonic, so rounded sums have one largest solution too, and lowering texels in any order until none
 * changes converges to it: the result does not depend on the order of the sweeps or the number of
 * threads.
 *
 * A path may be reordered: vertical and diagonal steps, then horizontal ones. So one sweep down, one up
 * and one along each row do nearly everything; a second round propagates across the seams, and the rest
 * is rounding. Sweeps down and up process row by row, all texels of a row at once; rows are independent
 * in the third. The smallest function above F is computed the same way for -F.
 *
 * The heights are floats: a limit under half a unit in the last place of the heights acts as 0, and
 * along a long slope the rounding errors of its steps accumulate. */

typedef struct Sweep {
    const WrOpJob *job;
    WrOpPlane *plane;
    float step, diagonal;
    bool wraps_u, wraps_v;
    bool negated;
    int changed; /* atomic while rows are swept by several threads */
} Sweep;

#define SLOPE_ROWS                                                                                 \
    16 /* rows of a piece of work, and of a sweep between two checks for cancellation */

static float *row_at(const WrOpPlane *plane, int j)
{
    return plane->at + (size_t)j * plane->pitch;
}

static int rows_of_piece(const WrOpPlane *plane, int index, int *first)
{
    *first = index * SLOPE_ROWS;
    return plane->height - *first < SLOPE_ROWS ? plane->height - *first : SLOPE_ROWS;
}

static void load_rows(int index, int worker, void *ctx)
{
    (void)worker;
    const Sweep *sweep = ctx;
    int first, rows = rows_of_piece(sweep->plane, index, &first);
    wr_field_read(sweep->job->in, 0, first, sweep->plane->width, rows, row_at(sweep->plane, first),
                  sweep->plane->pitch);
    if (!sweep->negated) return;
    for (int y = first; y < first + rows; y++) {
        float *row = row_at(sweep->plane, y);
        for (int x = 0; x < sweep->plane->width; x++) row[x] = -row[x];
    }
}

/* Sets the two texels beside a row's ends; without neighbours, to the maximum. */
static void set_margins(const Sweep *sweep, float *row)
{
    int width = sweep->plane->width;
    row[-1] = sweep->wraps_u ? row[width - 1] : FLT_MAX;
    row[width] = sweep->wraps_u ? row[0] : FLT_MAX;
}

/* Lowers `row` to the limit given by its neighbour row. */
static bool lower_row(const Sweep *sweep, float *from, float *restrict row)
{
    int changed = 0, width = sweep->plane->width;
    float step = sweep->step, diagonal = sweep->diagonal;
    set_margins(sweep, from);
#pragma omp simd reduction(| : changed)
    for (int x = 0; x < width; x++) {
        float straight = from[x] + step;
        float slant = (from[x - 1] < from[x + 1] ? from[x - 1] : from[x + 1]) + diagonal;
        float low = straight < slant ? straight : slant;
        changed |= low < row[x];
        row[x] = low < row[x] ? low : row[x];
    }
    return changed != 0;
}

/* True if the sweep should stop before row y; the caller checks for cancellation after it. */
static bool gives_up(const Sweep *sweep, int y)
{
    return y % SLOPE_ROWS == 0 && wr_progress_cancelled(sweep->job->progress);
}

/* A table of one periodic row is its own neighbour: the diagonals from the ends of the row would lower
   it like the steps along it, but are longer, so there is nothing to do. */
static bool sweep_down(const Sweep *sweep)
{
    const WrOpPlane *plane = sweep->plane;
    int height = plane->height;
    bool changed = false;
    if (height == 1) return false;
    if (sweep->wraps_v) changed |= lower_row(sweep, row_at(plane, height - 1), row_at(plane, 0));
    for (int y = 1; y < height && !gives_up(sweep, y); y++)
        changed |= lower_row(sweep, row_at(plane, y - 1), row_at(plane, y));
    return changed;
}

static bool sweep_up(const Sweep *sweep)
{
    const WrOpPlane *plane = sweep->plane;
    int height = plane->height;
    bool changed = false;
    if (height == 1) return false;
    if (sweep->wraps_v) changed |= lower_row(sweep, row_at(plane, 0), row_at(plane, height - 1));
    for (int y = height - 2; y >= 0 && !gives_up(sweep, y); y--)
        changed |= lower_row(sweep, row_at(plane, y + 1), row_at(plane, y));
    return changed;
}

static bool too_steep(const Sweep *sweep, float *row)
{
    set_margins(sweep, row);
    for (int x = 0; x < sweep->plane->width; x++) {
        float low = (row[x - 1] < row[x + 1] ? row[x - 1] : row[x + 1]) + sweep->step;
        if (low < row[x]) return true;
    }
    return false;
}

/* Sweeps right and left, twice each if the row is periodic. */
static void sweep_row(const Sweep *sweep, float *row)
{
    int width = sweep->plane->width;
    for (int round = 0; round < 2; round++) {
        float low = sweep->wraps_u ? row[width - 1] : FLT_MAX;
        for (int x = 0; x < width; x++) {
            low += sweep->step;
            low = row[x] < low ? row[x] : low;
            row[x] = low;
        }
        low = sweep->wraps_u ? row[0] : FLT_MAX;
        for (int x = width - 1; x >= 0; x--) {
            low += sweep->step;
            low = row[x] < low ? row[x] : low;
            row[x] = low;
        }
        if (!sweep->wraps_u) break;
    }
}

static void sweep_rows(int index, int worker, void *ctx)
{
    (void)worker;
    Sweep *sweep = ctx;
    int first, rows = rows_of_piece(sweep->plane, index, &first);
    for (int y = first; y < first + rows; y++) {
        if (!too_steep(sweep, row_at(sweep->plane, y))) continue;
        sweep_row(sweep, row_at(sweep->plane, y));
        __atomic_store_n(&sweep->changed, 1, __ATOMIC_RELAXED);
    }
}

/* Fills the plane with the largest limited function below F (or -F). The number of rounds is unknown,
   so each round gets a smaller part of the progress. */
static bool limit_plane(const WrOpJob *job, WrOpPlane *plane, double limit, bool negated)
{
    Sweep sweep = { .job = job,
                    .plane = plane,
                    .step = wr_op_float(limit),
                    .diagonal = wr_op_float(limit * sqrt(2.0)),
                    .wraps_u = wr_field_wrap_u(job->in) == WR_WRAP_PERIODIC,
                    .wraps_v = wr_field_wrap_v(job->in) == WR_WRAP_PERIODIC,
                    .negated = negated };
    int pieces = (plane->height + SLOPE_ROWS - 1) / SLOPE_ROWS;
    wr_pool_run(job->pool, pieces, load_rows, &sweep);
    bool again = true;
    for (int round = 1; again; round++) {
        if (!wr_op_step(job, 1.0 - 1.0 / round)) return false;
        sweep.changed = 0;
        again = sweep_down(&sweep);
        if (!wr_op_step(job, 1.0 - 1.0 / (round + 0.3))) return false;
        again = sweep_up(&sweep) || again;
        if (!wr_op_step(job, 1.0 - 1.0 / (round + 0.6))) return false;
        wr_pool_run(job->pool, pieces, sweep_rows, &sweep);
        again = again || sweep.changed;
    }
    return true;
}

typedef struct Sides {
    const WrOpPlane *below, *above; /* `above` contains -F's; one of them may be NULL */
} Sides;

static void make_limited(const WrOpJob *job, const void *ctx, WrOpBlock b, float *out, size_t pitch,
                         void *scratch)
{
    (void)job, (void)scratch;
    const Sides *sides = ctx;
    for (int y = 0; y < b.count_j; y++) {
        const float *low = sides->below ? row_at(sides->below, b.j + y) + b.i : NULL;
        const float *high = sides->above ? row_at(sides->above, b.j + y) + b.i : NULL;
        float *row = out + (size_t)y * pitch;
        WR_ASSERT(low || high);
        for (int x = 0; x < b.count_i; x++)
            row[x] = !high  ? low[x]
                     : !low ? -high[x]
                            : (float)(0.5 * ((double)low[x] - (double)high[x]));
    }
}

/* param: limit, side */
WrField *wr_op_slope_limit(WrOpJob *job, const double *param)
{
    int side = (int)param[1];
    WrOpPlane below = { 0 }, above = { 0 };
    Sides sides = { side == WR_SIDE_ABOVE ? NULL : &below, side == WR_SIDE_BELOW ? NULL : &above };
    double middle = side == WR_SIDE_MEAN ? 0.45 : 0.9;
    bool good = true;
    job->to = side == WR_SIDE_ABOVE ? 0.0 : middle;
    if (sides.below)
        good = wr_op_plane_init(&below, job) && limit_plane(job, &below, param[0], false);
    job->from = job->to;
    job->to = 0.9;
    if (good && sides.above)
        good = wr_op_plane_init(&above, job) && limit_plane(job, &above, param[0], true);
    job->from = 0.9;
    job->to = 1.0;
    WrOpWork work = { .make = make_limited, .ctx = &sides, .reach = -1 };
    WrField *out = good ? wr_op_build_same(job, &work) : NULL;
    wr_op_plane_fini(&below);
    wr_op_plane_fini(&above);
    return out;
}

/* Exact median over a window.
 *
 * Works on one tile at a time: the heights of the tile and its apron (at most 128 x 128) are sorted
 * once and then represented by their ranks, so that a window's contents are a bit set. The window moves
 * over the tile in a serpentine: right, down, left, down; each step adds the texels of one edge and
 * removes those of the other. The number of members in words before a current one is kept up to date,
 * and the median's word is never far away. */
#include "field/ops_internal.h"

#include "base/progress.h"

#include <math.h>
#include <string.h>

#define RADIUS_MAX 32
#define WIDE (WR_TILE + 2 * RADIUS_MAX)
#define TEXELS (WIDE * WIDE)
#define WORDS (TEXELS / 64)

typedef struct Median {
    int reach;
    int half[2 * RADIUS_MAX + 1]; /* half width of the window's row (and column) -reach .. reach */
    int size;                     /* texels in the window; odd */
} Median;

/* Scratch memory of one thread. */
typedef struct Desk {
    float height[TEXELS]; /* the tile and its apron, `pitch` a row */
    float sorted[TEXELS]; /* by rank */
    uint16_t rank[TEXELS];
    uint64_t item[2][TEXELS]; /* key << 32 | position */
    uint64_t word[WORDS];     /* members, by rank */
    uint8_t members[WORDS];
    int pitch;
    int at, below; /* a word, and the members in those before it */
} Desk;

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
static void set_ranks(Desk *desk, int count)
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

static void take_in(Desk *desk, int x, int y)
{
    int rank = desk->rank[y * desk->pitch + x], w = rank >> 6;
    desk->word[w] |= 1ull << (rank & 63);
    desk->members[w]++;
    desk->below += w < desk->at;
}

static void drop(Desk *desk, int x, int y)
{
    int rank = desk->rank[y * desk->pitch + x], w = rank >> 6;
    desk->word[w] &= ~(1ull << (rank & 63));
    desk->members[w]--;
    desk->below -= w < desk->at;
}

/* The member with `before` members before it. */
static float member(Desk *desk, int before)
{
    while (desk->below > before) desk->below -= desk->members[--desk->at];
    while (desk->below + desk->members[desk->at] <= before)
        desk->below += desk->members[desk->at++];
    uint64_t word = desk->word[desk->at];
    for (int skip = before - desk->below; skip > 0; skip--) word &= word - 1;
    return desk->sorted[desk->at * 64 + __builtin_ctzll(word)];
}

/* Moves the window's centre from (x, y) to the right (+1) or to the left (-1). */
static void step_across(const Median *median, Desk *desk, int x, int y, int way)
{
    for (int d = -median->reach; d <= median->reach; d++) {
        int half = median->half[d + median->reach];
        take_in(desk, x + way * (half + 1), y + d);
        drop(desk, x - way * half, y + d);
    }
}

static void step_down(const Median *median, Desk *desk, int x, int y)
{
    for (int d = -median->reach; d <= median->reach; d++) {
        int half = median->half[d + median->reach];
        take_in(desk, x + d, y + half + 1);
        drop(desk, x + d, y - half);
    }
}

static void plough(const Median *median, Desk *desk, int count_i, int count_j, float *out,
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
    Desk *desk = scratch;
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
                      .scratch = sizeof(Desk),
                      .reach = median.reach,
                      .window = 2 * median.reach + 1 };
    return wr_op_build_same(job, &work);
}

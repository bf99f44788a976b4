#include "field/horizon.h"

#include "base/array.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"

#include <limits.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define PI 3.14159265358979323846
#define FINEST 256 /* minimum number of steps of a line around the table */
#define AHEAD                                                                                      \
    131072 /* maximum look-ahead of a line in samples, also the longest piece swept at once */

/* ---- one line ------------------------------------------------------------------------------------ */

/* Heights at 0 .. n + ahead - 1, slopes of the first n; hull: [n + ahead]. */
static void sweep(const double *heights, int n, int ahead, double *slope, int *hull)
{
    int top = 0;
    for (int i = n + ahead - 1; i >= 0; i--) {
        double best = 0;
        while (top > 0) {
            best = (heights[hull[top - 1]] - heights[i]) / (hull[top - 1] - i);
            if (top == 1) break;
            const int next = hull[top - 2];
            if ((heights[next] - heights[i]) / (next - i) < best) break;
            top--;
        }
        if (i < n) slope[i] = best > 0 ? best : 0;
        hull[top++] = i;
    }
}

void wr_horizon_line(const double *heights, int n, double *slope, int *hull)
{
    double *twice = wr_alloc_unset(2 * (size_t)n, sizeof *twice);
    for (int i = 0; i < 2 * n; i++) twice[i] = heights[i % n];
    sweep(twice, n, n, slope, hull);
    wr_free(twice);
}

/* ---- a table ------------------------------------------------------------------------------------- */

/* Bounding boxes of the edited texels. */
typedef WR_ARRAY(WrFieldRect) Rects;

/* One direction of a table: lines that advance by one texel along their main axis while they drift
   along the other axis, and so close after a whole number of turns about the table. */
typedef struct Course {
    bool upright, back; /* the main axis is j; lines run against it */
    int along, across;  /* texels of both axes */
    int turns;          /* turns about the main axis, after which they have drifted by ... */
    int drift;          /* ... this whole number of texels */
    double step;        /* texels from sample to sample */
} Course;

typedef struct Making {
    WrHorizon *horizon;
    const float *heights;
    double sign;
    const Rects *edits;     /* NULL: compute all horizons */
    unsigned char *changed; /* for an update: [height][width] */
    float steepest[WR_HORIZON_MAX];
    bool failed[WR_HORIZON_MAX];
} Making;

static Course course_of(const WrHorizon *h, int direction)
{
    double x, y;
    wr_horizon_direction(direction, h->directions, &x, &y);
    const bool upright = fabs(y) > fabs(x);
    const double own = upright ? y : x, other = upright ? x : y;
    Course c = { .upright = upright, .back = own < 0 };
    c.along = upright ? h->height : h->width;
    c.across = upright ? h->width : h->height;
    c.turns = (FINEST + c.along - 1) / c.along;
    const double round = (double)c.turns * c.along;
    c.drift = (int)lrint(round * other);
    c.step = wr_hypot(1, c.drift / round);
    return c;
}

static int whole_mod(int64_t a, int n)
{
    /* the 32-bit division is far faster */
    const int left = (int)(a == (int)a ? (int)a % n : a % n);
    return left < 0 ? left + n : left;
}

static double texel(const Making *m, const Course *c, int along, int across)
{
    const int own = c->back ? c->along - 1 - along : along;
    const int i = c->upright ? across : own, j = c->upright ? own : across;
    return m->sign * (double)m->heights[(size_t)j * (size_t)m->horizon->width + (size_t)i];
}

/* Sample k of the line that starts at index `first` of the other axis. */
static double sample(const Making *m, const Course *c, int first, int64_t k)
{
    const int64_t round = (int64_t)c->turns * c->along;
    const double drifted = (double)(k % round) * c->drift / (double)round;
    const double low = floor(drifted), part = drifted - low;
    const int64_t at = first + (k / round) * c->drift + (int64_t)low;
    const int along = (int)(k % c->along);
    const double a = texel(m, c, along, whole_mod(at, c->across));
    if (part == 0) return a;
    return a + part * (texel(m, c, along, whole_mod(at + 1, c->across)) - a);
}

typedef struct Line {
    unsigned char *edited; /* [lines]: the line crosses a changed texel; NULL: sweep all */
    double *heights, *slope;
    int *hull;
    float *sheared; /* [across][along], at the lines' positions in the first turn */
    bool *beside;   /* [across]: the slopes between that row and the next are needed */
} Line;

/* Stores the slopes of one turn of a line in the sheared table. */
static void note(const Course *c, int first, int64_t k, int count, Line *line)
{
    const int64_t round = (int64_t)c->turns * c->along;
    for (int i = 0; i < count; i++) {
        const int64_t in = (k + i) % round;
        if (in >= c->along) continue;
        const int row = whole_mod(first + (k + i) / round * c->drift, c->across);
        line->sheared[(size_t)row * (size_t)c->along + (size_t)in] =
            (float)(line->slope[i] / c->step);
    }
}

static int common(int a, int b)
{
    return b == 0 ? a : common(b, a % b);
}

/* Sweeps a closed line piece by piece, each extended by one period, or by the maximum look-ahead. */
static void run_line(const Making *m, const Course *c, int first, int64_t period, Line *line)
{
    const int ahead = period < AHEAD ? (int)period : AHEAD;
    for (int64_t k = 0; k < period; k += ahead) {
        const int count = period - k < ahead ? (int)(period - k) : ahead;
        for (int i = 0; i < count + ahead; i++)
            line->heights[i] = sample(m, c, first, (k + i) % period);
        sweep(line->heights, count, ahead, line->slope, line->hull);
        note(c, first, k, count, line);
    }
}

/* Repeats the first column and row at the end. */
static void close_plane(float *of, int width, int height)
{
    const size_t pitch = (size_t)width + 1;
    for (size_t j = 0; j < (size_t)height; j++) of[j * pitch + (size_t)width] = of[j * pitch];
    memcpy(of + (size_t)height * pitch, of, pitch * sizeof *of);
}

/* Stores a texel's slope in an updated direction and marks the texel if it changed. Several directions
 * may mark one texel at once. */
static void put_slope(const Making *m, size_t i, size_t j, float slope, float *to)
{
    if (m->changed && memcmp(to, &slope, sizeof slope) != 0)
        __atomic_store_n(&m->changed[j * (size_t)m->horizon->width + i], 1, __ATOMIC_RELAXED);
    *to = slope;
}

/* True if the line of this row or of the next was edited. */
static bool is_beside(const Line *line, int lines, int row)
{
    return !line->edited || line->edited[row % lines] || line->edited[(row + 1) % lines];
}

/* Interpolates the slopes at the texels from the two lines beside each; for an update only texels
 * beside an edited line. */
static void unshear(Making *m, const Course *c, int direction, const Line *line)
{
    const WrHorizon *h = m->horizon;
    const double rate = (double)c->drift / ((double)c->turns * c->along);
    float *plane = h->slope + (size_t)direction * wr_horizon_plane_size(h), most = 0;
    for (int along = 0; along < c->along; along++)
        for (int across = 0; across < c->across; across++) {
            const double at = across - along * rate, low = floor(at);
            const int row = whole_mod((int)low, c->across);
            const int own = c->back ? c->along - 1 - along : along;
            const size_t i = (size_t)(c->upright ? across : own);
            const size_t j = (size_t)(c->upright ? own : across);
            float *to = plane + j * ((size_t)h->width + 1) + i;
            if (line->beside[row]) {
                const int next = row + 1 < c->across ? row + 1 : 0;
                const float a = line->sheared[(size_t)row * (size_t)c->along + (size_t)along];
                const float b = line->sheared[(size_t)next * (size_t)c->along + (size_t)along];
                put_slope(m, i, j, a + (float)(at - low) * (b - a), to);
            }
            most = *to > most ? *to : most;
        }
    m->steepest[direction] = most;
    close_plane(plane, h->width, h->height);
}

/* Marks the lines that cross texels [across from .. to) of column `along` of the main axis. */
static void mark_column(const Course *c, int lines, int along, int from, int to,
                        unsigned char *edited)
{
    const int64_t round = (int64_t)c->turns * c->along;
    for (int turn = 0; turn < c->turns; turn++) {
        const int64_t k = (int64_t)turn * c->along + along;
        const int64_t low = (int64_t)floor((double)k * c->drift / (double)round);
        for (int64_t row = from - 1 - low; row < to - low; row++) edited[whole_mod(row, lines)] = 1;
    }
}

/* Flags of the lines that cross edited texels. NULL: out of memory. */
static unsigned char *edited_lines(const Making *m, const Course *c, int lines)
{
    unsigned char *edited = wr_try_alloc((size_t)lines, 1, "horizons of the table", NULL);
    for (int k = 0; k < m->edits->count && edited; k++) {
        const WrFieldRect *r = &m->edits->data[k];
        const int from = c->upright ? r->j0 : r->i0, to = c->upright ? r->j1 : r->i1;
        for (int own = from; own < to; own++)
            mark_column(c, lines, c->back ? c->along - 1 - own : own, c->upright ? r->i0 : r->j0,
                        c->upright ? r->i1 : r->j1, edited);
    }
    return edited;
}

/* True if the line or an adjacent one was edited: slopes at texels are interpolated between two lines. */
static bool is_wanted(const Line *line, int lines, int first)
{
    return !line->edited || line->edited[first] || line->edited[(first + 1) % lines] ||
           line->edited[(first + lines - 1) % lines];
}

static bool hold_line(Line *line, const Course *c, int lines, int ahead)
{
    const char *what = "horizons of the table";
    WrError err;
    line->heights = wr_try_alloc(2 * (size_t)ahead, sizeof(double), what, &err);
    line->slope = wr_try_alloc((size_t)ahead, sizeof(double), what, &err);
    line->hull = wr_try_alloc(2 * (size_t)ahead, sizeof(int), what, &err);
    line->sheared = wr_try_alloc((size_t)c->along * (size_t)c->across, sizeof(float), what, &err);
    line->beside = wr_try_alloc((size_t)c->across, sizeof *line->beside, what, &err);
    for (int row = 0; row < c->across && line->beside; row++)
        line->beside[row] = is_beside(line, lines, row);
    return line->heights && line->slope && line->hull && line->sheared && line->beside;
}

static void run_direction(int direction, int worker, void *ctx)
{
    Making *m = ctx;
    const Course c = course_of(m->horizon, direction);
    const int lines = common(c.across, abs(c.drift) % c.across);
    const int64_t period = (int64_t)c.turns * c.along * (c.across / lines);
    const int ahead = period < AHEAD ? (int)period : AHEAD;
    Line line = { .edited = m->edits ? edited_lines(m, &c, lines) : NULL };
    (void)worker;
    m->failed[direction] = !hold_line(&line, &c, lines, ahead) || (m->edits && !line.edited);
    for (int first = 0; first < lines && !m->failed[direction]; first++)
        if (is_wanted(&line, lines, first)) run_line(m, &c, first, period, &line);
    if (!m->failed[direction]) unshear(m, &c, direction, &line);
    wr_free(line.edited);
    wr_free(line.beside);
    wr_free(line.heights);
    wr_free(line.slope);
    wr_free(line.hull);
    wr_free(line.sheared);
}

static bool make_all(Making *m, WrPool *pool, WrError *err)
{
    WrHorizon *h = m->horizon;
    if (!wr_pool_run(pool, h->directions, run_direction, m))
        return wr_fail(err, "horizons: cancelled");
    for (int k = 0; k < h->directions; k++) {
        if (m->failed[k]) return wr_fail(err, "horizons: not enough memory");
        h->steepest = fmaxf(h->steepest, m->steepest[k]);
    }
    return true;
}

/* Computes all directions of the table into `making`'s horizon. */
static bool make_of(Making *making, const WrField *field, WrPool *pool, WrError *err)
{
    WrHorizon *horizon = making->horizon;
    const int w = horizon->width, h = horizon->height;
    float *heights =
        wr_try_alloc((size_t)w * (size_t)h, sizeof *heights, "horizons of the table", err);
    bool good = heights != NULL;
    if (good) {
        making->heights = heights;
        wr_field_read(field, 0, 0, w, h, heights, (size_t)w);
        good = make_all(making, pool, err);
    }
    wr_free(heights);
    if (!good) wr_horizon_drop(horizon);
    return good;
}

bool wr_horizon_make(WrHorizon *horizon, const WrField *field, int directions, double sign,
                     WrPool *pool, WrError *err)
{
    Making making = { .horizon = horizon, .sign = sign };
    wr_horizon_drop(horizon);
    *horizon = (WrHorizon){ wr_field_width(field), wr_field_height(field), directions, NULL, 0 };
    horizon->slope = wr_try_alloc(wr_horizon_plane_size(horizon) * (size_t)directions,
                                  sizeof(float), "horizons of the table", err);
    return horizon->slope && make_of(&making, field, pool, err);
}

typedef struct Finding {
    const WrField *before, *now;
    Rects rects;
} Finding;

/* Marks a box of texels and their neighbours, across the table's ends. */
static void mark_about(const WrHorizon *h, const WrFieldRect *r, unsigned char *changed)
{
    for (int j = r->j0 - 1; j <= r->j1; j++)
        for (int i = r->i0 - 1; i <= r->i1; i++)
            changed[(size_t)whole_mod(j, h->height) * (size_t)h->width +
                    (size_t)whole_mod(i, h->width)] = 1;
}

static void find_rect(int tx, int ty, void *ctx)
{
    Finding *f = ctx;
    const WrFieldRect r = wr_field_difference(f->before, f->now, tx, ty);
    if (r.i0 < r.i1) wr_array_push(&f->rects, r);
}

/* `changed` is a superset of the texels whose occlusion changes: texels of edited boxes and their neighbours (central
   differences), and those whose horizon changes, which make_of marks. */
bool wr_horizon_update(WrHorizon *horizon, const WrField *before, const WrField *now, double sign,
                       unsigned char *changed, WrPool *pool, WrError *err)
{
    Finding found = { .before = before, .now = now };
    Making making = { .horizon = horizon, .sign = sign, .edits = &found.rects, .changed = changed };
    memset(changed, 0, (size_t)horizon->width * (size_t)horizon->height);
    wr_field_changes(before, now, find_rect, &found);
    for (int k = 0; k < found.rects.count; k++) mark_about(horizon, &found.rects.data[k], changed);
    horizon->steepest = 0;
    const bool good = make_of(&making, now, pool, err);
    wr_array_free(&found.rects);
    return good;
}

void wr_horizon_drop(WrHorizon *horizon)
{
    wr_free(horizon->slope);
    *horizon = (WrHorizon){ 0 };
}

/* ---- a sky --------------------------------------------------------------------------------------- */

/* Light of a uniform sky on a surface with normal n: per azimuth phi with horizon h the cosine-weighted integral over the
   elevation e from h to pi/2, with n . w = n_z sin e + o cos e and o = n_x cos phi + n_y sin phi,
       integral (n . w) cos e de = n_z cos^2 h / 2 + o ((pi/2 - h) / 2 - sin 2h / 4),
   summed over D azimuths of width 2 pi / D and divided by pi, the value of an open level surface. The horizon is at least
   that of the tangent plane, tan e = -o / n_z, below which n . w is negative. */
double wr_horizon_sky(const double *slope, int directions, const double n[3])
{
    double sum = 0;
    for (int k = 0; k < directions; k++) {
        const double phi = 2 * PI * k / directions, out = n[0] * wr_cos(phi) + n[1] * wr_sin(phi);
        const double h = fmax(wr_atan(slope[k]), wr_atan2(-out, n[2]));
        const double up = wr_cos(h);
        sum += n[2] * up * up / 2 + out * ((PI / 2 - h) / 2 - wr_sin(2 * h) / 4);
    }
    return 2 * sum / directions;
}

/* Direction k of the table is (x, y) texels; on the surface it is (across x, down y), so its slope per texel is multiplied by
   |(x, y)| / |(across x, down y)|. Half the angle between the two neighbours, over 2 pi, is the share; the shares add up to
   1. */
void wr_occlusion_map_make(WrOcclusionMap *opening, int directions, double across, double down)
{
    double angle[WR_HORIZON_MAX];
    opening->directions = directions;
    for (int k = 0; k < directions; k++) {
        double x, y;
        wr_horizon_direction(k, directions, &x, &y);
        const double length = wr_hypot(x, y), far = wr_hypot(x * across, y * down);
        opening->cosine[k] = x * across / far, opening->sine[k] = y * down / far;
        opening->steep[k] = length / far;
        angle[k] = wr_atan2(opening->sine[k], opening->cosine[k]);
    }
    for (int k = 0; k < directions; k++) {
        double wide = angle[(k + 1) % directions] - angle[(k + directions - 1) % directions];
        if (wide < 0) wide += 2 * PI;
        opening->share[k] = wide / 2 / (2 * PI);
    }
}

/* wr_horizon_sky for one texel; its normal comes from the slopes of F along i and j, heights per texel. With t = tan h the
   terms become cos^2 h = 1 / (1 + t^2) and sin 2h / 2 = t / (1 + t^2), so no sine is needed. The azimuths are not equally
   spaced on a surface whose two axes have different scales: share[k] is the fraction of the circle nearest to direction k and
   replaces 1 / D. */
static double occlusion_map_sky(const WrOcclusionMap *opening, const float *slope, double along_i,
                                double along_j)
{
    /* Slope on the surface, from the two axis directions. */
    const int quarter = opening->directions / 4;
    const double gx = along_i * opening->steep[0], gy = along_j * opening->steep[quarter];
    const double inv = 1 / sqrt(1 + gx * gx + gy * gy);
    double sum = 0;
    for (int k = 0; k < opening->directions; k++) {
        const double out = -inv * (gx * opening->cosine[k] + gy * opening->sine[k]);
        const double t = fmax((double)slope[k] * opening->steep[k], -out / inv);
        const double cc = 1 / (1 + t * t), h = wr_atan2(t, 1);
        sum += opening->share[k] * (inv * cc + out * (PI / 2 - h - t * cc));
    }
    return fmin(fmax(sum, 0), 1);
}

typedef struct OpeningJob {
    const WrOcclusionMap *opening;
    const WrHorizon *horizon;
    const float *heights;
    double sign;
    const unsigned char *changed; /* NULL: all texels */
    float *out;
} OpeningJob;

static void open_row(int j, int worker, void *ctx)
{
    (void)worker;
    const OpeningJob *job = ctx;
    const int w = job->horizon->width, h = job->horizon->height;
    const float *row = job->heights + (size_t)j * (size_t)w;
    const float *above = job->heights + (size_t)((j + h - 1) % h) * (size_t)w;
    const float *below = job->heights + (size_t)((j + 1) % h) * (size_t)w;
    float *out = job->out + (size_t)j * ((size_t)w + 1), slope[WR_HORIZON_MAX];
    for (int i = 0; i < w; i++) {
        if (job->changed && !job->changed[(size_t)j * (size_t)w + (size_t)i]) continue;
        for (int k = 0; k < job->horizon->directions; k++)
            slope[k] = wr_horizon_at(job->horizon, i, j, k);
        const double x = (double)row[(i + 1) % w] - (double)row[(i + w - 1) % w];
        const double y = (double)below[i] - (double)above[i];
        out[i] =
            (float)occlusion_map_sky(job->opening, slope, job->sign * x / 2, job->sign * y / 2);
    }
}

void wr_occlusion_map_table(const WrOcclusionMap *opening, const WrHorizon *horizon,
                            const WrField *field, double sign, const unsigned char *changed,
                            WrPool *pool, float *out)
{
    const int w = horizon->width, h = horizon->height;
    float *heights = wr_alloc((size_t)w * (size_t)h, sizeof *heights);
    wr_field_read(field, 0, 0, w, h, heights, (size_t)w);
    OpeningJob job = { opening, horizon, heights, sign, changed, out };
    wr_pool_run(pool, h, open_row, &job);
    close_plane(out, w, h);
    wr_free(heights);
}

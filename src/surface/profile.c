#include "surface/profile.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/text.h"
#include "surface/surface.h"

#include <math.h>
#include <string.h>

#define NEAR 1e-5 /* relative to the length: distinct points are farther apart */

typedef struct Points {
    double r[WR_PROFILE_POINTS], z[WR_PROFILE_POINTS];
    double s[WR_PROFILE_POINTS]; /* length of the chords up to each point, as a fraction */
    int count;
} Points;

/* ---- parsing ---- */

static bool read_number(const char **at, char stop, double low, double *out)
{
    const char *end = *at;
    while (*end && *end != ',' && *end != ';') end++;
    if (*end != stop || !wr_number_parse(*at, (size_t)(end - *at), out)) return false;
    if (!(*out >= low && *out <= WR_LENGTH_MAX)) return false;
    *at = end + (*end != '\0');
    return true;
}

static bool read_points(const char *text, Points *p, WrError *err)
{
    p->count = 0;
    for (const char *at = text; *at;) {
        if (p->count == WR_PROFILE_POINTS)
            return wr_fail(err, "revolution profile: must be 2 to %d points", WR_PROFILE_POINTS);
        const char *second = strchr(at, ','), *end = strchr(at, ';');
        double r, z;
        bool good = second && (!end || second < end) && read_number(&at, ',', 0, &r) &&
                    read_number(&at, end ? ';' : '\0', -WR_LENGTH_MAX, &z) && !(end && !*at);
        if (!good)
            return wr_fail(err,
                           "revolution profile: point %d: must be r,z with r 0..1e+30 and z "
                           "-1e+30..1e+30, as in \"0.5,-1;0.8,0;0.3,1\"",
                           p->count + 1);
        p->r[p->count] = r, p->z[p->count++] = z;
    }
    return p->count >= 2 || wr_fail(err, "revolution profile: must be 2 to %d points, r,z;r,z;...",
                                    WR_PROFILE_POINTS);
}

int wr_profile_points(const char *text, double points[WR_PROFILE_POINTS][2])
{
    Points p;
    if (!read_points(text, &p, NULL)) return 0;
    for (int i = 0; i < p.count; i++) points[i][0] = p.r[i], points[i][1] = p.z[i];
    return p.count;
}

static bool same_point(const Points *p, int i, int j)
{
    return p->r[i] == p->r[j] && p->z[i] == p->z[j];
}

static bool measure(Points *p, WrError *err)
{
    double most = 0;
    p->s[0] = 0;
    for (int i = 1; i < p->count; i++)
        p->s[i] = p->s[i - 1] + wr_hypot(p->r[i] - p->r[i - 1], p->z[i] - p->z[i - 1]);
    const double length = p->s[p->count - 1];
    for (int i = 0; i < p->count; i++) most = fmax(most, p->r[i]);
    if (!(length >= WR_LENGTH_MIN) || !(most >= WR_LENGTH_MIN))
        return wr_fail(err, "revolution profile: has no extent: must have a length and a radius");
    for (int i = 1; i < p->count; i++) {
        const double step = (p->s[i] - p->s[i - 1]) / length;
        if (!(step < NEAR) || same_point(p, i, i - 1)) continue;
        return wr_fail(
            err,
            "revolution profile: points %d and %d are less than 1e-5 of its length apart: must be "
            "farther, or the same for a corner",
            i, i + 1);
    }
    for (int i = 0; i < p->count; i++) p->s[i] /= length;
    p->s[p->count - 1] = 1;
    return true;
}

/* ---- the spline ---- */

/* The curve (r, z)(s) is a cubic spline through the points, parametrised by chord length s = 0 .. 1, which is
   the surface's v. A point that is given twice is a corner: the spline ends there and a new one begins. */

/* A run of points from one corner or end to the next. */
typedef struct Run {
    int first, count;
    bool pole[2]; /* its start, its end is a smooth pole */
    bool ring;
} Run;

enum { SIDE = WR_PROFILE_POINTS };

/* Solves a x = b; a is diagonally dominant.
   Gauss elimination without pivoting is stable for a diagonally dominant matrix; 2/h + 2/h against 1/h + 1/h. */
static void solve(double a[SIDE][SIDE], double *b, int n)
{
    for (int k = 0; k < n; k++)
        for (int i = k + 1; i < n; i++) {
            const double by = a[i][k] / a[k][k];
            if (by == 0) continue;
            for (int j = k; j < n; j++) a[i][j] -= by * a[k][j];
            b[i] -= by * b[k];
        }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
}

/* Slopes of one coordinate x at the points of a run. level: at a pole the slope is 0, otherwise the
   second derivative is.
   Unknowns are the slopes m. Continuity of the second derivative at a point between intervals h and h' reads
       m[i-1]/h + 2 m[i] (1/h + 1/h') + m[i+1]/h' = 3 d/h + 3 d'/h',   d = chord slope;
   each interval contributes its half to both ends, which leaves the natural condition (second derivative 0) at
   free ends. At a pole z has slope 0, so that the surface is smooth there. */
static void find_slopes(const Points *p, const double *x, const Run *run, bool level, double *slope)
{
    static const int end_of[2] = { 0, 1 };
    double a[SIDE][SIDE];
    const int n = run->count, at = run->first;
    memset(a, 0, sizeof a);
    for (int i = 0; i + 1 < n; i++) {
        const double h = p->s[at + i + 1] - p->s[at + i], d = (x[at + i + 1] - x[at + i]) / h;
        a[i][i] += 2 / h, a[i][i + 1] += 1 / h, a[i + 1][i] += 1 / h, a[i + 1][i + 1] += 2 / h;
        slope[i] = (i ? slope[i] : 0) + 3 * d / h;
        slope[i + 1] = 3 * d / h;
    }
    if (run->ring) { /* the last point equals the first: one unknown for both */
        for (int j = 0; j < n - 1; j++) a[0][j] += a[n - 1][j];
        slope[0] += slope[n - 1];
        for (int i = 0; i < n - 1; i++) a[i][0] += a[i][n - 1];
        a[0][0] += a[n - 1][n - 1];
        solve(a, slope, n - 1);
        slope[n - 1] = slope[0];
        return;
    }
    for (int e = 0; e < 2; e++) {
        const int i = end_of[e] ? n - 1 : 0;
        if (!(level && run->pole[e])) continue;
        memset(a[i], 0, sizeof a[i]);
        a[i][i] = 1;
        slope[i] = 0;
    }
    solve(a, slope, n);
}

/* Bezier points of the Hermite piece: a third of the interval times the slope from each end. */
static void add_pieces(const Points *p, const Run *run, WrProfiled *out)
{
    double dr[SIDE], dz[SIDE];
    find_slopes(p, p->r, run, false, dr);
    find_slopes(p, p->z, run, true, dz);
    for (int i = 0; i + 1 < run->count; i++) {
        const int at = run->first + i, k = out->count++;
        const double third = (p->s[at + 1] - p->s[at]) / 3;
        double *r = out->r + 4 * (size_t)k, *z = out->z + 4 * (size_t)k;
        out->from[k] = p->s[at], out->to[k] = p->s[at + 1];
        out->inv[k] = 1 / (out->to[k] - out->from[k]);
        r[0] = p->r[at], r[1] = r[0] + third * dr[i];
        r[3] = p->r[at + 1], r[2] = r[3] - third * dr[i + 1];
        z[0] = p->z[at], z[1] = z[0] + third * dz[i];
        z[3] = p->z[at + 1], z[2] = z[3] - third * dz[i + 1];
    }
}

static void make_pieces(const Points *p, WrProfiled *out)
{
    const int last = p->count - 1;
    for (int from = 0, to; from < last; from = to) {
        if (same_point(p, from, from + 1)) {
            to = from + 1;
            continue;
        }
        for (to = from + 1; to < last && !same_point(p, to, to + 1);) to++;
        const bool whole = from == 0 && to == last;
        const Run run = { .first = from,
                          .count = to - from + 1,
                          .pole = { from == 0 && p->r[0] == 0, to == last && p->r[last] == 0 },
                          .ring = whole && same_point(p, 0, last) && p->count > 2 };
        add_pieces(p, &run, out);
    }
}

/* ---- distance from the axis ---- */

static double cubic(const double *c, double t)
{
    const double w = 1 - t;
    return w * w * w * c[0] + 3 * w * w * t * c[1] + 3 * w * t * t * c[2] + t * t * t * c[3];
}

/* The t of the smallest r of a piece: its ends and the zeros of its derivative.
   r'(t) / 3 = a (1 - t)^2 + 2 b t (1 - t) + d t^2 = q t^2 - 2 half t + a; the roots without cancellation as s
   / q and a / s. */
static double least_place(const double *c)
{
    const double a = c[1] - c[0], b = c[2] - c[1], d = c[3] - c[2];
    const double q = a - 2 * b + d, half = a - b, root = half * half - q * a;
    double tries[4] = { 0, 1, 0, 0 }, best = 0;
    int count = 2;
    if (root >= 0) {
        const double s = half + copysign(sqrt(root), half);
        if (q != 0) tries[count++] = s / q;
        if (s != 0) tries[count++] = a / s;
    }
    for (int i = 0; i < count; i++)
        if (tries[i] >= 0 && tries[i] <= 1 && cubic(c, tries[i]) < cubic(c, best)) best = tries[i];
    return best;
}

/* Inside the surface r = 0 would invert N (HC144); at both ends it is a pole. */
static bool check_axis(const WrProfiled *p, WrError *err)
{
    for (int k = 0; k < p->count; k++) {
        const double *r = p->r + 4 * (size_t)k, t = least_place(r), least = cubic(r, t);
        const double v = p->from[k] + t * (p->to[k] - p->from[k]);
        const bool crosses = least < 0, touches = least <= 0 && v > 0 && v < 1;
        char text[WR_NUMBER_SIZE];
        if (crosses || touches)
            return wr_fail(err,
                           "revolution profile: %s the axis at v = %s: r must be above 0 except at "
                           "its ends; move its points, or repeat one for a corner",
                           crosses ? "crosses" : "touches",
                           wr_number_print(round(v * 1e4) / 1e4, text));
    }
    return true;
}

/* Unused pieces begin at 2, beyond every v, so that the kernels' search needs no count. */
bool wr_profile_make(const char *text, WrProfiled *out, WrError *err)
{
    Points points = { .count = 0 };
    WrProfiled made = { .count = 0 };
    if (!read_points(text, &points, err) || !measure(&points, err)) return false;
    make_pieces(&points, &made);
    if (!check_axis(&made, err)) return false;
    for (int k = made.count; k < WR_PROFILE_PIECES; k++) made.from[k] = 2;
    *out = made;
    /* Corners are the pieces whose first derivatives differ at the joint: rows of meshes are placed there. */
    return true;
}

void wr_profile_narrow(const WrProfiled *from, WrProfilef *to)
{
    for (int k = 0; k < WR_PROFILE_PIECES; k++) {
        to->from[k] = (float)from->from[k], to->to[k] = (float)from->to[k];
        to->inv[k] = k < from->count ? 1.0f / (to->to[k] - to->from[k]) : 0.0f;
    }
    for (int k = 0; k < 4 * WR_PROFILE_PIECES; k++)
        to->r[k] = (float)from->r[k], to->z[k] = (float)from->z[k];
}

int wr_profile_corners(const WrProfiled *profile, double *v, int most)
{
    int count = 0;
    for (int k = 1; k < profile->count && count < most; k++) {
        const double *r = profile->r + 4 * (size_t)k, *z = profile->z + 4 * (size_t)k;
        const double a = (r[-1] - r[-2]) * profile->inv[k - 1],
                     b = (z[-1] - z[-2]) * profile->inv[k - 1];
        const double c = (r[1] - r[0]) * profile->inv[k], d = (z[1] - z[0]) * profile->inv[k];
        if (wr_hypot(a - c, b - d) > 1e-9 * (wr_hypot(a, b) + wr_hypot(c, d)))
            v[count++] = profile->from[k];
    }
    return count;
}

#define STEPS 32

void wr_profile_extent(const WrProfiled *profile, double *middle, double *radius)
{
    double low = INFINITY, high = -INFINITY, most = 0;
    const int steps = profile->count * (STEPS + 1);
    for (int k = 0; k < steps; k++) {
        const double z =
            cubic(profile->z + 4 * (size_t)(k / (STEPS + 1)), k % (STEPS + 1) / (double)STEPS);
        low = fmin(low, z), high = fmax(high, z);
    }
    *middle = low + 0.5 * (high - low);
    for (int k = 0; k < steps; k++) {
        const size_t at = 4 * (size_t)(k / (STEPS + 1));
        const double t = k % (STEPS + 1) / (double)STEPS;
        most = fmax(most, wr_hypot(cubic(profile->r + at, t), cubic(profile->z + at, t) - *middle));
    }
    *radius = 1.001 * most; /* margin for points between the samples */
}

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "generate/fft_plane.h"
#include "generate/picture.h"

#include <string.h>

const char *const wr_seamless_words[] = { WR_SEAMLESS_WAYS(WR_WORD) NULL };

static WrEnds ends_of(WrWrap wrap)
{
    return wrap == WR_WRAP_PERIODIC ? WR_ENDS_RING : WR_ENDS_FREE;
}

static WrPlane plane_of(const WrSheet *sheet, double *z, const WrGenerateJob *job)
{
    return (WrPlane){ .width = sheet->width,
                      .height = sheet->height,
                      .ends = { ends_of(sheet->wrap[0]), ends_of(sheet->wrap[1]) },
                      .z = z,
                      .pool = job->pool,
                      .progress = job->progress };
}

/* ---- blend ---- With L = Du^T Du + Dv^T Dv on the torus, L p should equal that of the picture without
   the steps at its edges; so for s = z - p, L s consists of these steps, on both sides of the edges. */

static bool solve_steps(WrPlane *plane, WrError *err)
{
    static const WrSlopes steps[] = { WR_SLOPES_STEP, WR_SLOPES_STEP };
    return wr_plane_solve(plane, steps, err);
}

bool wr_picture_blend(WrSheet *sheet, const WrGenerateJob *job, WrError *err)
{
    size_t w = (size_t)sheet->width, h = (size_t)sheet->height;
    double *s = wr_try_alloc(w * h, sizeof *s, "a seamless picture", err);
    if (!s) return false;
    const double *z = sheet->z;
    for (size_t j = 0; j < h && sheet->wrap[0] == WR_WRAP_PERIODIC; j++) {
        double jump = z[j * w] - z[j * w + w - 1];
        s[j * w] += jump;
        s[j * w + w - 1] -= jump;
    }
    for (size_t i = 0; i < w && sheet->wrap[1] == WR_WRAP_PERIODIC; i++) {
        double jump = z[i] - z[(h - 1) * w + i];
        s[i] += jump;
        s[(h - 1) * w + i] -= jump;
    }
    WrPlane plane = plane_of(sheet, s, job);
    bool good = solve_steps(&plane, err);
    for (size_t k = 0; good && k < w * h; k++) sheet->z[k] -= s[k];
    wr_free(s);
    return good;
}

/* ---- cut ---- */

int wr_seamless_overlap(int n)
{
    return n < 16 ? 0 : n / 8;
}

/* Heights with their steps to the next texel to the right and below. */
typedef struct Steps {
    int size[2];      /* columns, rows */
    double *z, *g[2]; /* owned */
} Steps;

static bool steps_new(Steps *steps, int width, int height, WrError *err)
{
    size_t count = (size_t)width * (size_t)height;
    *steps = (Steps){ .size = { width, height } };
    steps->z = wr_try_alloc(count, sizeof *steps->z, "a seamless picture", err);
    for (int a = 0; a < 2 && steps->z; a++)
        steps->g[a] = wr_try_alloc(count, sizeof *steps->z, "a seamless picture", err);
    return steps->z && steps->g[0] && steps->g[1];
}

static void steps_fini(Steps *steps)
{
    wr_free(steps->z);
    wr_free(steps->g[0]);
    wr_free(steps->g[1]);
    *steps = (Steps){ .z = NULL };
}

static bool steps_of(Steps *steps, const WrSheet *sheet, WrError *err)
{
    size_t w = (size_t)sheet->width, h = (size_t)sheet->height;
    if (!steps_new(steps, sheet->width, sheet->height, err)) return false;
    memcpy(steps->z, sheet->z, w * h * sizeof *sheet->z);
    for (size_t j = 0; j < h; j++)
        for (size_t i = 0; i < w; i++) {
            size_t k = j * w + i;
            if (i + 1 < w) steps->g[0][k] = sheet->z[k + 1] - sheet->z[k];
            if (j + 1 < h) steps->g[1][k] = sheet->z[k + w] - sheet->z[k];
        }
    return true;
}

/* Closing of one axis: along it n of n + overlap texels remain; lines are adjacent across it. */
typedef struct Cutting {
    const Steps *from;
    int axis, n, overlap, lines;
    bool ring; /* the other axis is already closed */
    int *cut;  /* [lines] 1..overlap - 1: texels before it come from the far end, texels from it on
                from the near end */
    double *sum; /* [lines][overlap] least sum of squares up to here */
} Cutting;

static size_t place(const Steps *s, int axis, int along, int line)
{
    return axis == 0 ? (size_t)line * (size_t)s->size[0] + (size_t)along
                     : (size_t)along * (size_t)s->size[0] + (size_t)line;
}

static double mismatch(const Cutting *c, int along, int line)
{
    double d = c->from->z[place(c->from, c->axis, along, line)] -
               c->from->z[place(c->from, c->axis, c->n + along, line)];
    return d * d;
}

/* The path of least sum, from `start` (0: any) at line 0; on a ring it must return beside it. */
static void find_way(Cutting *c, int start)
{
    int o = c->overlap, last = c->lines - 1, best = 0;
    for (int line = 0; line <= last; line++) {
        double *now = c->sum + (size_t)line * (size_t)o;
        const double *before = line > 0 ? now - o : now;
        for (int a = 1; a < o; a++) {
            double least = 0.0;
            if (line == 0) least = start == 0 || a == start ? 0.0 : 1e300;
            else {
                least = before[a];
                if (a > 1 && before[a - 1] < least) least = before[a - 1];
                if (a + 1 < o && before[a + 1] < least) least = before[a + 1];
            }
            now[a] = least + mismatch(c, a, line);
        }
    }
    const double *end = c->sum + (size_t)last * (size_t)o;
    for (int a = 1; a < o; a++) {
        if (start && (a < start - 1 || a > start + 1)) continue;
        if (!best || end[a] < end[best]) best = a;
    }
    for (int line = last; line >= 0; line--) {
        c->cut[line] = best;
        if (line == 0) break;
        const double *before = c->sum + (size_t)(line - 1) * (size_t)o;
        int a = best;
        if (a > 1 && before[a - 1] < before[best]) best = a - 1;
        if (a + 1 < o && before[a + 1] < before[best]) best = a + 1;
    }
}

static bool far_end(const Cutting *c, int along, int line)
{
    return along < c->cut[line];
}

/* A step of the closed picture between two texels: from their common source, or the mean. */
static double choose(const Cutting *c, const double *g, int along, int line, bool a, bool b)
{
    double near = g[place(c->from, c->axis, along, line)];
    if (!a && !b) return near;
    double far = g[place(c->from, c->axis, c->n + along, line)];
    return a && b ? far : 0.5 * (near + far);
}

static void join_line(const Cutting *c, int line, Steps *to)
{
    const Steps *from = c->from;
    int next = line + 1 < c->lines ? line + 1 : c->ring ? 0 : line;
    for (int k = 0; k < c->n; k++) {
        size_t at = place(to, c->axis, k, line);
        bool here = far_end(c, k, line), beside = far_end(c, k, next);
        bool ahead = k + 1 < c->n && far_end(c, k + 1, line);
        to->z[at] = from->z[place(from, c->axis, here ? c->n + k : k, line)];
        to->g[c->axis][at] = choose(c, from->g[c->axis], k, line, here, ahead);
        to->g[1 - c->axis][at] = choose(c, from->g[1 - c->axis], k, line, here, beside);
    }
}

/* Closes one axis to n texels; *steps is replaced. */
static bool close_axis(Steps *steps, int axis, int n, bool ring, WrError *err)
{
    Steps made = { .z = NULL };
    Cutting c = { .from = steps,
                  .axis = axis,
                  .n = n,
                  .overlap = steps->size[axis] - n,
                  .lines = steps->size[1 - axis],
                  .ring = ring };
    size_t lines = (size_t)c.lines;
    if (c.overlap < 2) return true;
    c.cut = wr_try_alloc(lines, sizeof *c.cut, "a cut", err);
    c.sum = wr_try_alloc(lines * (size_t)c.overlap, sizeof *c.sum, "a cut", err);
    bool good =
        c.cut && c.sum &&
        steps_new(&made, axis == 0 ? n : steps->size[0], axis == 1 ? n : steps->size[1], err);
    if (good) {
        find_way(&c, 0);
        if (ring && lines > 1) find_way(&c, c.cut[0]);
        for (int line = 0; line < c.lines; line++) join_line(&c, line, &made);
        steps_fini(steps);
        *steps = made;
    } else {
        steps_fini(&made);
    }
    wr_free(c.cut);
    wr_free(c.sum);
    return good;
}

/* The heights whose steps are nearest to those of the two sides, with the picture's mean. */
static bool even_out(Steps *steps, WrSheet *sheet, const WrGenerateJob *job, WrError *err)
{
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    double mean = 0.0;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) mean += steps->z[k] / (double)count;
    for (int a = 0; a < 2; a++) {
        WrPlane plane = plane_of(sheet, steps->g[a], job);
        if (!wr_plane_turned_slope(&plane, a, WR_SLOPES_STEP, err)) return false;
    }
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++)
        sheet->z[k] = steps->g[0][k] + steps->g[1][k];
    WrPlane plane = plane_of(sheet, sheet->z, job);
    if (!solve_steps(&plane, err)) return false;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) sheet->z[k] += mean;
    return true;
}

bool wr_picture_cut(WrSheet *sheet, int width, int height, const WrGenerateJob *job, WrError *err)
{
    Steps steps = { .z = NULL };
    WrSheet made = { .z = NULL };
    bool good = steps_of(&steps, sheet, err) && close_axis(&steps, 0, width, false, err) &&
                close_axis(&steps, 1, height, sheet->wrap[0] == WR_WRAP_PERIODIC, err) &&
                wr_sheet_new(&made, width, height, sheet->wrap, err) &&
                even_out(&steps, &made, job, err);
    steps_fini(&steps);
    if (!good) {
        wr_sheet_fini(&made);
        return false;
    }
    wr_sheet_fini(sheet);
    *sheet = made;
    return true;
}

/* ---- */

/* Adds a remark if the table's aspect ratio distorts the picture. */
static void tell_shape(const WrSheet *sheet, const int size[2], const WrGenerateJob *job)
{
    double shape = (double)sheet->width * size[1] / ((double)sheet->height * size[0]);
    if (shape > 0.99 && shape < 1.01) return;
    wr_generate_note(job, "%dx%d texels are drawn out to %dx%d: another shape", sheet->width,
                     sheet->height, size[0], size[1]);
}

bool wr_picture_fit(WrSheet *sheet, WrSeamless seamless, const WrGenerateJob *job, WrError *err)
{
    const WrWrap wrap[] = { wr_field_wrap_u(job->like), wr_field_wrap_v(job->like) };
    int size[] = { wr_field_width(job->like), wr_field_height(job->like) }, larger[2];
    for (int a = 0; a < 2; a++) {
        bool overlaps = seamless == WR_SEAMLESS_CUT && wrap[a] == WR_WRAP_PERIODIC;
        larger[a] = size[a] + (overlaps ? wr_seamless_overlap(size[a]) : 0);
        sheet->wrap[a] = WR_WRAP_CLAMP; /* its ends do not match yet */
    }
    tell_shape(sheet, size, job);
    if (!wr_sheet_resize(sheet, larger[0], larger[1], job, err)) return false;
    sheet->wrap[0] = wrap[0];
    sheet->wrap[1] = wrap[1];
    if (seamless == WR_SEAMLESS_BLEND) return wr_picture_blend(sheet, job, err);
    if (seamless == WR_SEAMLESS_CUT) return wr_picture_cut(sheet, size[0], size[1], job, err);
    return true;
}

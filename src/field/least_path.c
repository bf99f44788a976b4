/* Minimum error boundary cut by dynamic programming: sum[line][a] = mismatch(a) + the least of
   sum[line - 1][a - 1 .. a + 1]. */
#include "field/least_path.h"

#include "base/memory.h"

#include <stddef.h>

/* Extends all paths by one line; `before` is NULL for the first, which starts at `start` (0: anywhere). */
static void extend_paths(const WrOverlap *o, int line, int start, const double *before, double *now)
{
    for (int a = 1; a < o->width; a++) {
        double least = 0.0;
        if (!before) least = start == 0 || a == start ? 0.0 : 1e300;
        else {
            least = before[a];
            if (a > 1 && before[a - 1] < least) least = before[a - 1];
            if (a + 1 < o->width && before[a + 1] < least) least = before[a + 1];
        }
        now[a] = least + o->mismatch(o->ctx, a, line);
    }
}

/* The path of least sum; from `start` (0: any) it must return beside it. */
static void find_path(const WrOverlap *o, int start, double *sum, int *path)
{
    const size_t width = (size_t)o->width;
    int last = o->lines - 1, best = 0;
    for (int line = 0; line <= last; line++) {
        double *now = sum + (size_t)line * width;
        extend_paths(o, line, start, line > 0 ? now - width : NULL, now);
    }
    const double *end = sum + (size_t)last * width;
    for (int a = 1; a < o->width; a++) {
        if (start && (a < start - 1 || a > start + 1)) continue;
        if (!best || end[a] < end[best]) best = a;
    }
    for (int line = last; line >= 0; line--) {
        path[line] = best;
        if (line == 0) break;
        const double *before = sum + (size_t)(line - 1) * width;
        int a = best;
        if (a > 1 && before[a - 1] < before[best]) best = a - 1;
        if (a + 1 < o->width && before[a + 1] < before[best]) best = a + 1;
    }
}

/* A closed path starts where the best open one does and must end beside it. This is not always the optimum, but
   needs two passes instead of one for each start. */
bool wr_least_path(const WrOverlap *overlap, int *path, WrError *err)
{
    double *sum =
        wr_try_alloc((size_t)overlap->lines * (size_t)overlap->width, sizeof *sum, "a cut", err);
    if (!sum) return false;
    find_path(overlap, 0, sum, path);
    if (overlap->ring && overlap->lines > 1) find_path(overlap, path[0], sum, path);
    wr_free(sum);
    return true;
}

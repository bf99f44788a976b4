#include "generate/path.h"

#include "base/error.h"

#include <math.h>
#include <stddef.h>

#define SMOOTH 32 /* straight pieces between two points */

void wr_path_fini(WrPath *path)
{
    wr_array_free(&path->xy);
    wr_array_free(&path->length);
}

static void path_add(WrPath *path, double x, double y)
{
    int n = path->length.count;
    double so_far = 0.0;
    if (n > 0) {
        double dx = x - path->xy.data[2 * n - 2], dy = y - path->xy.data[2 * n - 1];
        if (dx == 0.0 && dy == 0.0) return;
        so_far = path->length.data[n - 1] + sqrt(dx * dx + dy * dy);
    }
    wr_array_push(&path->xy, x);
    wr_array_push(&path->xy, y);
    wr_array_push(&path->length, so_far);
}

/* Catmull-Rom between b and c.
     p(t) = b + t (c - a) / 2 + t^2 (2 a - 5 b + 4 c - d) / 2 + t^3 (3 b - 3 c + d - a) / 2 */
static double smooth(double a, double b, double c, double d, double t)
{
    return b +
           0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

bool wr_path_make(WrPath *path, const double *points, int count, bool closed, double width,
                  double height, WrError *err)
{
    const double *p = points;
    const int n = count, pieces = closed && n > 2 ? n : n - 1;
    for (int i = 0; i < pieces; i++)
        for (int k = i ? 1 : 0; k <= SMOOTH; k++) {
            double t = (double)k / SMOOTH, at[2];
            for (int c = 0; c < 2; c++) {
                double b0 = p[2 * i + c], c0 = p[2 * ((i + 1) % n) + c];
                double a0 = i > 0 ? p[2 * i - 2 + c] : 2.0 * b0 - c0;
                double d0 = i + 2 < n ? p[2 * i + 4 + c] : 2.0 * c0 - b0;
                if (pieces == n) {
                    a0 = p[2 * ((i + n - 1) % n) + c];
                    d0 = p[2 * ((i + 2) % n) + c];
                }
                at[c] = smooth(a0, b0, c0, d0, t);
            }
            path_add(path, at[0] * width, (1.0 - at[1]) * height);
        }
    if (path->length.count >= 2) return true;
    return wr_fail(err, "points: a path needs two different places");
}

double wr_path_length(const WrPath *path)
{
    return path->length.data[path->length.count - 1];
}

/* Binary search for the straight piece; before the first and after the last one the line continues. */
WrStand wr_path_at(const WrPath *path, double s)
{
    int low = 0, high = path->length.count - 2;
    while (low < high) {
        int middle = (low + high + 1) / 2;
        if (path->length.data[middle] <= s) low = middle;
        else high = middle - 1;
    }
    const double *a = &path->xy.data[2 * (ptrdiff_t)low];
    double run = path->length.data[low + 1] - path->length.data[low];
    double dx = (a[2] - a[0]) / run, dy = (a[3] - a[1]) / run, t = s - path->length.data[low];
    return (WrStand){ a[0] + t * dx, a[1] + t * dy, dx, -dy };
}

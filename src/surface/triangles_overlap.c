/* Areas of a mesh with overlapping texture coordinates. */
#include "surface/triangles.h"

#include "base/memory.h"

#include <math.h>

/* Coverage count of cell centres: 0, 1, 2 for more. */
typedef struct Count {
    unsigned char *cell;
    int cells;
} Count;

typedef struct Flat {
    double u[3], v[3]; /* in cells */
} Flat;

static double side(const Flat *t, int k, double x, double y)
{
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    return (t->u[b] - t->u[a]) * (y - t->v[a]) - (t->v[b] - t->v[a]) * (x - t->u[a]);
}

/* True if the edge includes the points on it; its reverse does not (fill rule). */
static bool owns(const Flat *t, int k)
{
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    const double du = t->u[b] - t->u[a], dv = t->v[b] - t->v[a];
    return dv < 0 || (dv == 0 && du < 0);
}

static bool holds(const Flat *t, double sign, double x, double y)
{
    for (int k = 0; k < 3; k++) {
        const double e = sign * side(t, k, x, y);
        if (e < 0 || (e == 0 && owns(t, k) != (sign > 0))) return false;
    }
    return true;
}

static void cover(const Count *count, const Flat *t)
{
    const double area = side(t, 0, t->u[0], t->v[0]);
    if (area == 0) return;
    const double sign = area > 0 ? 1 : -1;
    /* A triangle over very many repeats covers everything it can within the first ones. */
    const int most = 4 * count->cells;
    const double x0 = floor(fmin(fmin(t->u[0], t->u[1]), t->u[2]) - 0.5);
    const double y0 = floor(fmin(fmin(t->v[0], t->v[1]), t->v[2]) - 0.5);
    const double x1 = fmin(ceil(fmax(fmax(t->u[0], t->u[1]), t->u[2])), x0 + most);
    const double y1 = fmin(ceil(fmax(fmax(t->v[0], t->v[1]), t->v[2])), y0 + most);
    for (double y = y0; y <= y1; y++)
        for (double x = x0; x <= x1; x++) {
            if (!holds(t, sign, x + 0.5, y + 0.5)) continue;
            const double n = count->cells;
            const int i = (int)(x - n * floor(x / n)), j = (int)(y - n * floor(y / n));
            unsigned char *cell = &count->cell[(size_t)j * (size_t)count->cells + (size_t)i];
            *cell = (unsigned char)(*cell < 2 ? *cell + 1 : 2);
        }
}

double wr_triangles_overlap(const WrTriangles *triangles, int cells, int32_t *outside)
{
    const size_t total = (size_t)cells * (size_t)cells;
    Count count = { wr_alloc(total, 1), cells };
    int32_t beyond = 0;
    for (int32_t i = 0; i < triangles->triangle_count; i++) {
        Flat t;
        bool out = false;
        for (int k = 0; k < 3; k++) {
            const WrTriangleCorner *c = &triangles->corners[triangles->triangles[i].corner[k]];
            t.u[k] = (double)c->u * cells, t.v[k] = (double)c->v * cells;
            out |= c->u < 0 || c->u > 1 || c->v < 0 || c->v > 1;
        }
        beyond += out;
        cover(&count, &t);
    }
    size_t once = 0, often = 0;
    for (size_t i = 0; i < total; i++) {
        once += count.cell[i] > 0;
        often += count.cell[i] > 1;
    }
    wr_free(count.cell);
    if (outside) *outside = beyond;
    return once > 0 ? (double)often / (double)once : 0;
}

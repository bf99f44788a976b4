/* Welding of shared points on the domain's border: seams, poles, edges of a cube. */
#include "render/tessellation/dice_internal.h"

#include <math.h>
#include <stdlib.h>

#define FINE 1e6 /* resolution of positions: parts of the surface's radius */

WrDicePoint wr_dice_point(int32_t index, const WrSurfacePoint *at, double f, double size)
{
    const WrVec3 p = v3_scale(at->p, FINE / size);
    /* keeps positions with round coordinates inside a step, not on its border */
    const double off = 0.3819;
    return (WrDicePoint){ .key = { (int64_t)floor(p.x + off), (int64_t)floor(p.y + off),
                                   (int64_t)floor(p.z + off) },
                          .index = index,
                          .p = at->p,
                          .n = at->n_unit,
                          .f = f };
}

static int compare(const void *a, const void *b)
{
    const WrDicePoint *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->key[k] != q->key[k]) return p->key[k] < q->key[k] ? -1 : 1;
    return (p->index > q->index) - (p->index < q->index);
}

void wr_dice_sort(WrDicePoint *points, int32_t count)
{
    qsort(points, (size_t)count, sizeof *points, compare);
}

int32_t wr_dice_run(const WrDicePoint *points, int32_t from, int32_t count)
{
    int32_t end = from + 1;
    while (end < count && points[end].key[0] == points[from].key[0] &&
           points[end].key[1] == points[from].key[1] && points[end].key[2] == points[from].key[2])
        end++;
    return end;
}

/* x of A x = b with a symmetric A of columns a0, a1, a2. */
static WrVec3 solve(WrVec3 a0, WrVec3 a1, WrVec3 a2, WrVec3 b)
{
    const double det = v3_dot(a0, v3_cross(a1, a2));
    return (WrVec3){ v3_dot(b, v3_cross(a1, a2)) / det, v3_dot(a0, v3_cross(b, a2)) / det,
                     v3_dot(a0, v3_cross(a1, b)) / det };
}

/* d with n_i . d = f_i, by least squares, if it is at most twice the largest f; else the mean displacement. */
WrVec3 wr_dice_move(const WrDicePoint *points, int32_t count)
{
    const double damp = 1e-9 * count;
    WrVec3 a0 = { damp, 0, 0 }, a1 = { 0, damp, 0 }, a2 = { 0, 0, damp }, b = { 0, 0, 0 };
    WrVec3 mean = { 0, 0, 0 };
    double most = 0, sum = 0;
    for (int32_t i = 0; i < count; i++) {
        const WrVec3 n = points[i].n;
        const double f = points[i].f;
        a0 = v3_mad(a0, n, n.x), a1 = v3_mad(a1, n, n.y), a2 = v3_mad(a2, n, n.z);
        b = v3_mad(b, n, f);
        mean = v3_add(mean, n);
        most = fmax(most, fabs(f));
        sum += f;
    }
    const WrVec3 d = solve(a0, a1, a2, b);
    if (v3_len(d) <= 2 * most) return d;
    return v3_scale(v3_unit(mean, (WrVec3){ 0, 0, 0 }), sum / count);
}

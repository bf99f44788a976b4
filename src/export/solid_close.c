/* Back of a relief, walls around it, and caps over open ends: they close the mesh. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "export/solid.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* Border of the relief: the next point along it, for each point; -1: inside. */
typedef struct Border {
    int32_t *next;  /* [points] */
    int32_t *start; /* [loops]: a point of each loop */
    int loops;
} Border;

static WrVec3 point(const WrSolid *s, int32_t i)
{
    return (WrVec3){ s->points[i][0], s->points[i][1], s->points[i][2] };
}

/* Area vector: twice the area along the normal. */
static WrVec3 area(const WrSolid *s, int32_t a, int32_t b, int32_t c)
{
    const WrVec3 p = point(s, a);
    return v3_cross(v3_sub(point(s, b), p), v3_sub(point(s, c), p));
}

/* ---- the border ---- */

static bool twice(WrError *err)
{
    return wr_fail(err, "the surface touches itself at its border: no body can be made of it");
}

static bool find_next(const WrSolid *s, Border *border, int32_t *count, WrError *err)
{
    memset(border->next, 0xff, (size_t)s->point_count * sizeof *border->next);
    for (int32_t i = 0; i < s->relief.count; i++)
        for (int k = 0; k < 3; k++) {
            const WrSolidTriangle *t = &s->relief.data[i];
            const int32_t a = t->point[(k + 1) % 3], b = t->point[(k + 2) % 3];
            if (t->across[k] >= 0 || a == b) continue;
            if (border->next[a] >= 0) return twice(err);
            border->next[a] = b;
            ++*count;
        }
    return true;
}

static bool find_border(const WrSolid *s, Border *border, WrError *err)
{
    const size_t points = (size_t)s->point_count;
    int32_t count = 0;
    border->next = wr_try_alloc(points, sizeof *border->next, "a solid", err);
    if (!border->next || !find_next(s, border, &count, err)) return false;
    bool *seen = wr_try_alloc(points, sizeof *seen, "a solid", err);
    border->start = wr_try_alloc((size_t)count + 1, sizeof *border->start, "a solid", err);
    bool good = seen && border->start;
    for (int32_t i = 0; i < s->point_count && good; i++) {
        if (border->next[i] < 0 || seen[i]) continue;
        border->start[border->loops++] = i;
        for (int32_t at = i; good && !seen[at]; at = border->next[at]) {
            seen[at] = true;
            good = border->next[at] >= 0 || twice(err);
        }
    }
    wr_free(seen);
    return good;
}

/* ---- (u,v) ---- */

static int32_t sights_end(const WrSolid *s, int32_t point)
{
    return point + 1 < s->first.count ? s->first.data[point + 1] : s->sights.count;
}

/* (u,v) of points a and b, neighbours on a border. A point on a seam has a sight at each end of u: the nearest pair is taken,
   so that u does not jump between a and b. */
static void side_sights(const WrSolid *s, int32_t a, int32_t b, WrSolidSight out[2])
{
    double least = INFINITY;
    for (int32_t i = s->first.data[a]; i < sights_end(s, a); i++)
        for (int32_t j = s->first.data[b]; j < sights_end(s, b); j++) {
            const WrSolidSight *p = &s->sights.data[i], *q = &s->sights.data[j];
            const double far = fabs(p->u - q->u) + fabs(p->v - q->v);
            if (least < INFINITY && !(far < least)) continue;
            least = far;
            out[0] = *p, out[1] = *q;
        }
}

static void triangle_sights(const WrSolidTriangle *t, WrSolidSight out[3])
{
    for (int k = 0; k < 3; k++) out[k] = (WrSolidSight){ t->u[k], t->v[k], t->face };
}

/* ---- a fan over a loop ---- */

/* Centre of a loop of points, and its axis of rotation; `map` converts point numbers. */
static WrVec3 middle_of(const WrSolid *s, const Border *b, const int32_t *map, int32_t start,
                        WrVec3 *up)
{
    WrVec3 sum = { 0, 0, 0 };
    double whole = 0.0;
    int32_t i = start;
    do {
        const WrVec3 p = point(s, map[i]), q = point(s, map[b->next[i]]);
        const double length = v3_len(v3_sub(q, p));
        sum = v3_add(sum, v3_scale(v3_add(p, q), length / 2));
        whole += length;
        i = b->next[i];
    } while (i != start);
    const WrVec3 middle = v3_scale(sum, 1.0 / whole);
    *up = (WrVec3){ 0, 0, 0 };
    do {
        const WrVec3 p = v3_sub(point(s, map[i]), middle);
        *up = v3_add(*up, v3_cross(p, v3_sub(point(s, map[b->next[i]]), middle)));
        i = b->next[i];
    } while (i != start);
    return middle;
}

/* Adds triangles from all its sides to a point in its middle; false and none if that point does not see all of
   them. */
static bool fan(WrSolid *s, const Border *b, const int32_t *map, int32_t start)
{
    WrVec3 up;
    const WrVec3 middle = middle_of(s, b, map, start, &up);
    const float at[3] = { (float)middle.x, (float)middle.y, (float)middle.z };
    const int32_t centre = wr_solid_add_bare(s, at);
    int32_t i = start;
    bool good = true;
    do {
        good = good && v3_dot(area(s, map[i], map[b->next[i]], centre), up) > 0;
        i = b->next[i];
    } while (i != start);
    if (!good) {
        s->point_count--;
        return false;
    }
    do {
        WrSolidSight uv[3];
        side_sights(s, b->next[i], i, uv);
        uv[2] = (WrSolidSight){ (uv[0].u + uv[1].u) / 2, (uv[0].v + uv[1].v) / 2, uv[0].face };
        wr_solid_add_triangle(s, (const int32_t[3]){ map[b->next[i]], map[i], centre }, uv);
        i = b->next[i];
    } while (i != start);
    return true;
}

/* ---- backs ---- */

static int32_t add_back_point(WrSolid *s, int32_t of)
{
    const int32_t first = s->first.data[of];
    float at[3];
    wr_solid_place(s, s->sights.data + first, sights_end(s, of) - first, true, at);
    return wr_solid_add_bare(s, at);
}

/* True if its back faces another way than the triangle. A mirrored object's triangles are clockwise. */
static bool folds(const WrSolid *s, const WrSolidTriangle *t, const int32_t *back)
{
    const double way = s->stretch.x * s->stretch.y * s->stretch.z;
    const int32_t *p = t->point;
    WrVec3 out = { 0, 0, 0 };
    for (int k = 0; k < 3; k++) out = v3_add(out, v3_sub(point(s, p[k]), point(s, back[p[k]])));
    return !(v3_dot(area(s, back[p[0]], back[p[1]], back[p[2]]), out) * way > 0);
}

static bool is_pole(const WrSolidTriangle *t)
{
    const int32_t *p = t->point;
    return p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
}

/* Adds the relief's triangles again, at the back. */
static bool add_shell(WrSolid *s, int32_t *back, int32_t points, WrError *err)
{
    for (int32_t i = 0; i < points; i++)
        if (back[i] < 0) back[i] = add_back_point(s, i);
    for (int32_t i = 0; i < s->relief.count; i++) {
        const WrSolidTriangle *t = &s->relief.data[i];
        if (is_pole(t)) continue;
        if (i % 4096 == 0 && wr_progress_stopped()) return wr_fail(err, "cancelled");
        if (folds(s, t, back))
            return wr_fail(
                err,
                "thickness=%.6g: more than the surface's curves leave room for: thinner, or filled",
                s->thickness);
        WrSolidSight at[3];
        triangle_sights(t, at);
        wr_solid_add_triangle(
            s, (const int32_t[3]){ back[t->point[1]], back[t->point[0]], back[t->point[2]] },
            (const WrSolidSight[3]){ at[1], at[0], at[2] });
    }
    return true;
}

static void add_walls(WrSolid *s, const Border *border, const int32_t *back, int32_t points)
{
    for (int32_t a = 0; a < points; a++) {
        const int32_t b = border->next[a];
        if (b < 0) continue;
        WrSolidSight at[2];
        side_sights(s, a, b, at);
        wr_solid_add_triangle(s, (const int32_t[3]){ b, a, back[a] },
                              (const WrSolidSight[3]){ at[1], at[0], at[0] });
        wr_solid_add_triangle(s, (const int32_t[3]){ b, back[a], back[b] },
                              (const WrSolidSight[3]){ at[1], at[0], at[1] });
    }
}

static bool add_back(WrSolid *s, const Border *border, WrError *err)
{
    const int32_t points = s->point_count;
    int32_t *back = wr_try_alloc((size_t)points, sizeof *back, "a solid", err);
    if (!back) return false;
    memset(back, 0xff, (size_t)points * sizeof *back);
    for (int32_t i = 0; i < points; i++)
        if (border->next[i] >= 0) back[i] = add_back_point(s, i);
    const bool flat = wr_surfaces[s->scene->shape.kind]->flat && border->loops == 1;
    const bool good =
        (flat && fan(s, border, back, border->start[0])) || add_shell(s, back, points, err);
    if (good) add_walls(s, border, back, points);
    wr_free(back);
    return good;
}

static bool add_caps(WrSolid *s, const Border *border, WrError *err)
{
    const int32_t points = s->point_count;
    int32_t *same = wr_try_alloc((size_t)points, sizeof *same, "a solid", err);
    if (!same) return false;
    for (int32_t i = 0; i < points; i++) same[i] = i;
    bool good = true;
    for (int l = 0; l < border->loops && good; l++)
        good = fan(s, border, same, border->start[l]) ||
               wr_fail(err, "an open end cannot be closed flat: thickness=MM makes a wall instead");
    wr_free(same);
    return good;
}

/* ---- the body ---- */

double wr_solid_volume(const WrSolid *solid)
{
    double sum = 0.0;
    for (int32_t i = 0; i < solid->triangle_count; i++) {
        const int32_t *t = solid->triangles[i];
        sum += v3_dot(point(solid, t[0]), v3_cross(point(solid, t[1]), point(solid, t[2])));
    }
    return sum / 6.0;
}

/* For mirrored objects, and formulas whose normals point inwards. */
static void turn_outwards(WrSolid *s)
{
    if (wr_solid_volume(s) >= 0.0) return;
    for (int32_t i = 0; i < s->triangle_count; i++) {
        const int32_t a = s->triangles[i][0];
        s->triangles[i][0] = s->triangles[i][1];
        s->triangles[i][1] = a;
        float uv[2];
        memcpy(uv, s->uv[i][0], sizeof uv);
        memcpy(s->uv[i][0], s->uv[i][1], sizeof uv);
        memcpy(s->uv[i][1], uv, sizeof uv);
    }
}

static bool check(const WrSolid *s, WrError *err)
{
    for (int32_t i = 0; i < s->triangle_count; i++) {
        const int32_t *t = s->triangles[i];
        const WrVec3 n = area(s, t[0], t[1], t[2]);
        if (!(v3_dot(n, n) > 0))
            return wr_fail(
                err, "the surface has a place without area: no body can be made of it; a larger "
                     "error may step over it");
    }
    return true;
}

bool wr_solid_close(WrSolid *solid, WrError *err)
{
    Border border = { 0 };
    for (int32_t i = 0; i < solid->relief.count; i++) {
        const WrSolidTriangle *t = &solid->relief.data[i];
        WrSolidSight at[3];
        triangle_sights(t, at);
        if (!is_pole(t)) wr_solid_add_triangle(solid, t->point, at);
    }
    bool good = find_border(solid, &border, err);
    if (good && border.loops > 0)
        good = solid->thickness > 0 ? add_back(solid, &border, err) : add_caps(solid, &border, err);
    wr_free(border.next);
    wr_free(border.start);
    good = good && check(solid, err) && (!wr_progress_stopped() || wr_fail(err, "cancelled"));
    if (good) turn_outwards(solid);
    return good;
}

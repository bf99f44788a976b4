#include "surface/tangent_frames.h"

#include "base/error.h"
#include "base/memory.h"
#include "surface/triangles_internal.h"

#include <stdlib.h>
#include <string.h>

static const WrVec3 none = { 0, 0, 0 };

static bool finite3(WrVec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

static bool is_zero(WrVec3 a)
{
    return a.x == 0 && a.y == 0 && a.z == 0;
}

/* ---- the lecture's equation ---- */

/* L1: T = (v2 E1 - v1 E2) / det, B = (-u2 E1 + u1 E2) / det. det is compared with the size of its own products
   (HC28, HC30). */

bool wr_tangent_lecture(const WrVec3 p[3], const double uv[3][2], WrVec3 *t, WrVec3 *b, double *det)
{
    const WrVec3 e1 = v3_sub(p[1], p[0]), e2 = v3_sub(p[2], p[0]);
    const double u1 = uv[1][0] - uv[0][0], v1 = uv[1][1] - uv[0][1];
    const double u2 = uv[2][0] - uv[0][0], v2 = uv[2][1] - uv[0][1];
    const double first = u1 * v2, second = u2 * v1, d = first - second;
    if (!(fabs(d) > WR_COLLINEAR * (fabs(first) + fabs(second)))) return false;
    const WrVec3 along = v3_add(v3_scale(e1, v2 / d), v3_scale(e2, -v1 / d));
    const WrVec3 across = v3_add(v3_scale(e1, -u2 / d), v3_scale(e2, u1 / d));
    if (!finite3(along) || !finite3(across)) return false;
    *t = along, *b = across, *det = d;
    return true;
}

/* ---- triangles with their corners ---- */

/* Corners with equal position, normal and (u,v) are one vertex (`weld`); -0 counts as 0. The arrays out[3 i +
   k] are by corner of each triangle, as seams may have different frames at one vertex. */

typedef struct Tri {
    WrVec3 p[3], n[3];
    double uv[3][2];
    int32_t weld[3]; /* index of corners with equal position, normal and (u,v) */
} Tri;

typedef struct Frames {
    Tri *tri; /* [count] */
    int32_t count, welds;
} Frames;

static WrVec3 wide(const float a[3])
{
    return (WrVec3){ (double)a[0], (double)a[1], (double)a[2] };
}

static void fill_tri(const WrTriangleCorner *corners, const WrTriangle *from, const int32_t *weld,
                     Tri *to)
{
    for (int k = 0; k < 3; k++) {
        const WrTriangleCorner *c = &corners[from->corner[k]];
        to->p[k] = wide(c->p);
        to->n[k] = v3_unit(wide(c->n), none);
        to->uv[k][0] = (double)c->u, to->uv[k][1] = (double)c->v;
        to->weld[k] = weld[from->corner[k]];
    }
}

static bool begin(const WrTriangleCorner *corners, const WrTriangle *triangles, int32_t count,
                  Frames *out, WrError *err)
{
    int32_t most = 0;
    for (int32_t i = 0; i < 3 * count; i++)
        if (triangles[i / 3].corner[i % 3] > most) most = triangles[i / 3].corner[i % 3];
    const size_t room = (size_t)most + 1;
    float(*rows)[8] = wr_try_alloc(room, sizeof *rows, "tangents", err);
    int32_t *weld = rows ? wr_try_alloc(room, sizeof *weld, "tangents", err) : NULL;
    out->tri = weld ? wr_try_alloc((size_t)count, sizeof *out->tri, "tangents", err) : NULL;
    out->count = count;
    for (size_t i = 0; i < room && out->tri; i++) {
        memcpy(rows[i], &corners[i], sizeof rows[i]);
        for (int k = 0; k < 8; k++) rows[i][k] += 0.0f;
    }
    const bool good = out->tri && wr_weld(rows, sizeof *rows, most + 1, weld, &out->welds, err);
    for (int32_t i = 0; i < count && good; i++)
        fill_tri(corners, &triangles[i], weld, &out->tri[i]);
    wr_free(weld);
    wr_free(rows);
    if (!good) wr_free(out->tri);
    return good;
}

static double angle_at(const Tri *t, int k)
{
    return wr_angle(v3_sub(t->p[(k + 1) % 3], t->p[k]), v3_sub(t->p[(k + 2) % 3], t->p[k]));
}

/* ---- averages of frames ---- */

/* Sums apart for both signs of det: mirrored halves never average to T = 0 (HC31). Weights are corner angles. */

typedef struct Sums {
    WrVec3 t[2], b[2]; /* of det > 0, of det < 0 */
} Sums;

bool wr_tangents_average(const WrTriangleCorner *corners, const WrTriangle *triangles,
                         int32_t count, WrTangent *out, WrError *err)
{
    Frames frames;
    if (!begin(corners, triangles, count, &frames, err)) return false;
    Sums *sums = wr_try_alloc((size_t)frames.welds, sizeof *sums, "tangents", err);
    double *weights =
        sums ? wr_try_alloc((size_t)frames.welds, 2 * sizeof *weights, "tangents", err) : NULL;
    for (int32_t i = 0; i < 3 * count && weights; i++) {
        const Tri *tri = &frames.tri[i / 3];
        const int k = i % 3;
        double det;
        WrVec3 t, b;
        out[i] = (WrTangent){ none, none, 0 };
        if (!wr_tangent_lecture(tri->p, (const double(*)[2])tri->uv, &t, &b, &det)) continue;
        const int mirrored = det < 0;
        const double angle = angle_at(tri, k);
        Sums *at = &sums[tri->weld[k]];
        out[i].sign = mirrored ? -1 : 1;
        at->t[mirrored] = v3_mad(at->t[mirrored], t, angle);
        at->b[mirrored] = v3_mad(at->b[mirrored], b, angle);
        weights[2 * tri->weld[k] + mirrored] += angle;
    }
    for (int32_t i = 0; i < 3 * count && weights; i++) {
        const int32_t weld = frames.tri[i / 3].weld[i % 3];
        const int mirrored = out[i].sign < 0;
        const double weight = weights[2 * weld + mirrored];
        if (out[i].sign == 0) continue;
        out[i].t = v3_scale(sums[weld].t[mirrored], weight > 0 ? 1 / weight : 0);
        out[i].b = v3_scale(sums[weld].b[mirrored], weight > 0 ? 1 / weight : 0);
    }
    const bool good = weights != NULL;
    wr_free(weights);
    wr_free(sums);
    wr_free(frames.tri);
    return good;
}

/* ---- MikkTSpace ---- */

/* After Mikkelsen's description (2008), in double: frames of other programs agree to float rounding. Steps:
   faces, neighbours over edges, groups around each vertex, one frame for each group and face. */

enum { UNSET = -1 };

typedef struct Face {
    WrVec3 s, t;          /* unit, times the sign; 0 if undefined */
    int sign;             /* of the area of (u,v) */
    bool any;             /* indefinite: it joins the first group that reaches it */
    bool no_area;         /* two equal positions: excluded */
    int32_t neighbour[3]; /* over the edge from corner k to the next; UNSET: none */
    int32_t group[3];
} Face;

typedef struct Group {
    int32_t weld, first, last; /* its members: a linked list in `next` */
    int sign;
} Group;

typedef struct Mikk {
    Frames frames;
    Face *face;
    Group *group;
    int32_t groups;
    int32_t *next, *stack; /* by corner 3 i + k */
} Mikk;

static bool same_place(WrVec3 a, WrVec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* S = sign unit(t31.v d1 - t21.v d2), T the same along v.
   Triangles without (u,v) area have no direction of their own (`any`) and adopt that of the first group that
   reaches them. */
static void fill_face(const Tri *tri, Face *face)
{
    const WrVec3 d1 = v3_sub(tri->p[1], tri->p[0]), d2 = v3_sub(tri->p[2], tri->p[0]);
    const double u1 = tri->uv[1][0] - tri->uv[0][0], v1 = tri->uv[1][1] - tri->uv[0][1];
    const double u2 = tri->uv[2][0] - tri->uv[0][0], v2 = tri->uv[2][1] - tri->uv[0][1];
    const double area = u1 * v2 - v1 * u2;
    const WrVec3 s = v3_sub(v3_scale(d1, v2), v3_scale(d2, v1));
    const WrVec3 t = v3_sub(v3_scale(d2, u1), v3_scale(d1, u2));
    face->sign = area > 0 ? 1 : -1;
    face->no_area = same_place(tri->p[0], tri->p[1]) || same_place(tri->p[1], tri->p[2]) ||
                    same_place(tri->p[2], tri->p[0]);
    face->any = true;
    for (int k = 0; k < 3; k++) face->neighbour[k] = face->group[k] = UNSET;
    if (area == 0) return;
    face->s = v3_scale(v3_unit(s, none), face->sign);
    face->t = v3_scale(v3_unit(t, none), face->sign);
    face->any = is_zero(face->s) || is_zero(face->t);
}

/* An edge between two welded corners, lower first. */
typedef struct Edge {
    int32_t low, high, corner; /* 3 i + k: it runs from corner k */
} Edge;

static int compare_edges(const void *a, const void *b)
{
    const Edge *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return p->corner < q->corner ? -1 : p->corner > q->corner;
}

static int32_t weld_of(const Mikk *m, int32_t corner)
{
    return m->frames.tri[corner / 3].weld[corner % 3];
}

/* Among the edges from `i` on that join the same corners, pairs each with the first free one of
 * opposite direction.
 * Edges are sorted, so equal ones are adjacent and the lower corner number comes first: the pairing is the
 * same on every machine. An edge of three faces leaves one without a neighbour (HC132). */
static void pair_edges(Mikk *m, const Edge *edges, int32_t i, int32_t count)
{
    const Edge *a = &edges[i];
    Face *own = &m->face[a->corner / 3];
    if (own->neighbour[a->corner % 3] != UNSET) return;
    for (int32_t j = i + 1; j < count && edges[j].low == a->low && edges[j].high == a->high; j++) {
        const int32_t other = edges[j].corner;
        Face *face = &m->face[other / 3];
        if (face->neighbour[other % 3] != UNSET || other / 3 == a->corner / 3 ||
            weld_of(m, other) == weld_of(m, a->corner))
            continue;
        own->neighbour[a->corner % 3] = other / 3;
        face->neighbour[other % 3] = a->corner / 3;
        return;
    }
}

static bool find_neighbours(Mikk *m, WrError *err)
{
    const int32_t count = m->frames.count;
    Edge *edges = wr_try_alloc((size_t)count, 3 * sizeof *edges, "tangents", err);
    int32_t found = 0;
    if (!edges) return false;
    for (int32_t i = 0; i < 3 * count; i++) {
        const int32_t a = weld_of(m, i), b = weld_of(m, i / 3 * 3 + (i % 3 + 1) % 3);
        if (!m->face[i / 3].no_area) edges[found++] = (Edge){ a < b ? a : b, a < b ? b : a, i };
    }
    qsort(edges, (size_t)found, sizeof *edges, compare_edges);
    for (int32_t i = 0; i < found; i++) pair_edges(m, edges, i, found);
    wr_free(edges);
    return true;
}

/* The face's corner at the group's position; UNSET: none. */
static int corner_at(const Mikk *m, int32_t i, int32_t weld)
{
    for (int k = 0; k < 3; k++)
        if (m->frames.tri[i].weld[k] == weld) return k;
    return UNSET;
}

/* Adds the face if the rules allow it; true if added.
   An undecided face adopts the sign of its first group, once for all its corners. */
static bool join(Mikk *m, int32_t index, int32_t i, int k)
{
    Face *face = &m->face[i];
    Group *group = &m->group[index];
    if (face->group[k] != UNSET) return false;
    if (face->any && face->group[0] == UNSET && face->group[1] == UNSET && face->group[2] == UNSET)
        face->sign = group->sign;
    if (face->sign != group->sign) return false;
    face->group[k] = index;
    m->next[3 * i + k] = UNSET;
    if (group->first == UNSET) group->first = 3 * i + k;
    else m->next[group->last] = 3 * i + k;
    group->last = 3 * i + k;
    return true;
}

/* Adds all faces around the corner that are reachable across edges.
   Depth first with an explicit stack; each corner joins at most one group, so at most 3 count entries. */
static void spread_group(Mikk *m, int32_t index, int32_t i, int k)
{
    int32_t height = 0;
    if (!join(m, index, i, k)) return;
    m->stack[height++] = 3 * i + k;
    while (height > 0) {
        const int32_t at = m->stack[--height], of = at / 3;
        const int corner = at % 3, edges[2] = { corner, (corner + 2) % 3 };
        for (int e = 0; e < 2; e++) {
            const int32_t to = m->face[of].neighbour[edges[e]];
            const int there = to == UNSET ? UNSET : corner_at(m, to, m->group[index].weld);
            if (there != UNSET && join(m, index, to, there)) m->stack[height++] = 3 * to + there;
        }
    }
}

static void make_groups(Mikk *m)
{
    for (int32_t i = 0; i < 3 * m->frames.count; i++) {
        const Face *face = &m->face[i / 3];
        if (face->no_area || face->any || face->group[i % 3] != UNSET) continue;
        m->group[m->groups] = (Group){ weld_of(m, i), UNSET, UNSET, face->sign };
        spread_group(m, m->groups++, i / 3, i % 3);
    }
}

/* a projected to the plane perpendicular to n, unit. */
static WrVec3 laid(WrVec3 a, WrVec3 n)
{
    return v3_unit(v3_mad(a, n, -v3_dot(n, a)), none);
}

/* False for exactly opposite frames, whose sum is 0.
   HC130: two folded faces with opposite S would sum to 0; each then keeps its own frame. */
static bool goes_along(const Mikk *m, int32_t i, int32_t j, WrVec3 n)
{
    const Face *a = &m->face[i], *b = &m->face[j];
    const double opposite = -1 + 1e-12;
    if (i == j || a->any || b->any) return true;
    return v3_dot(laid(a->s, n), laid(b->s, n)) > opposite &&
           v3_dot(laid(a->t, n), laid(b->t, n)) > opposite;
}

/* The frame of the face's corner k.
   Each S is projected onto the plane of the vertex normal, weighted by the projected corner angle, summed and
   made unit. The sum depends on the face (goes_along), so it is not stored per group. */
static WrVec3 tangent_of(const Mikk *m, int32_t i, int k)
{
    const Tri *own = &m->frames.tri[i];
    const WrVec3 n = own->n[k];
    WrVec3 sum = none;
    for (int32_t at = m->group[m->face[i].group[k]].first; at != UNSET; at = m->next[at]) {
        const int32_t j = at / 3;
        const Tri *tri = &m->frames.tri[j];
        const int c = at % 3;
        if (m->face[j].any || !goes_along(m, i, j, n)) continue;
        const WrVec3 to = laid(v3_sub(tri->p[(c + 1) % 3], tri->p[c]), n);
        const WrVec3 from = laid(v3_sub(tri->p[(c + 2) % 3], tri->p[c]), n);
        sum = v3_mad(sum, laid(m->face[j].s, n), wr_angle(to, from));
    }
    if (v3_len(sum) > 1e-12) return v3_unit(sum, none);
    return laid(m->face[i].s, n); /* its own frame if the sum is 0 */
}

static void fill_corner(const Mikk *m, int32_t corner, WrTangent *out)
{
    const Face *face = &m->face[corner / 3];
    const WrVec3 n = m->frames.tri[corner / 3].n[corner % 3];
    const WrVec3 x = { 1, 0, 0 };
    *out = (WrTangent){ x, none, -1 };
    if (face->group[corner % 3] != UNSET) {
        const WrVec3 t = tangent_of(m, corner / 3, corner % 3);
        if (!is_zero(t)) *out = (WrTangent){ t, none, face->sign };
    }
    out->b = v3_scale(v3_cross(n, out->t), out->sign);
}

/* Triangles without area copy the frame of a corner equal to theirs.
   Such triangles are invisible, but interpolation over a neighbouring sample may touch them (HC131). */
static bool copy_frames(const Mikk *m, WrTangent *out, WrError *err)
{
    int32_t *first = wr_try_alloc((size_t)m->frames.welds, sizeof *first, "tangents", err);
    if (!first) return false; /* 1 + corner */
    for (int32_t i = 0; i < 3 * m->frames.count; i++) {
        int32_t *at = &first[weld_of(m, i)];
        if (!m->face[i / 3].no_area && *at == 0) *at = i + 1;
    }
    for (int32_t i = 0; i < 3 * m->frames.count; i++) {
        const int32_t from = first[weld_of(m, i)];
        if (m->face[i / 3].no_area && from > 0) out[i] = out[from - 1];
    }
    wr_free(first);
    return true;
}

bool wr_tangents_mikk(const WrTriangleCorner *corners, const WrTriangle *triangles, int32_t count,
                      WrTangent *out, WrError *err)
{
    Mikk m = { 0 };
    const size_t room = 3 * (size_t)count;
    if (!begin(corners, triangles, count, &m.frames, err)) return false;
    m.face = wr_try_alloc((size_t)count, sizeof *m.face, "tangents", err);
    m.group = m.face ? wr_try_alloc(room, sizeof *m.group, "tangents", err) : NULL;
    m.next = m.group ? wr_try_alloc(room, sizeof *m.next, "tangents", err) : NULL;
    m.stack = m.next ? wr_try_alloc(room, sizeof *m.stack, "tangents", err) : NULL;
    for (int32_t i = 0; i < count && m.stack; i++) fill_face(&m.frames.tri[i], &m.face[i]);
    bool good = m.stack && find_neighbours(&m, err);
    if (good) {
        make_groups(&m);
        for (int32_t i = 0; i < 3 * count; i++) fill_corner(&m, i, &out[i]);
        good = copy_frames(&m, out, err);
    }
    wr_free(m.stack);
    wr_free(m.next);
    wr_free(m.group);
    wr_free(m.face);
    wr_free(m.frames.tri);
    return good;
}

bool wr_tangent_components(WrVec3 vt, WrVec3 vn, double sign, WrVec3 of, WrVec3 *out)
{
    const WrVec3 vb = v3_scale(v3_cross(vn, vt), sign);
    const WrVec3 bn = v3_cross(vb, vn), nt = v3_cross(vn, vt), tb = v3_cross(vt, vb);
    const double det = v3_dot(vt, bn);
    if (!(fabs(det) > 1e-12)) return false;
    *out = v3_unit((WrVec3){ v3_dot(of, bn) / det, v3_dot(of, nt) / det, v3_dot(of, tb) / det },
                   (WrVec3){ 0, 0, 1 });
    return true;
}

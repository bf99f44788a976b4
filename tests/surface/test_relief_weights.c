/* Masks and blended planes of relief on meshes: weights against formulas written once more, derivatives against differences,
   continuity across edges. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "surface/projection.h"
#include "surface/relief_weights.h"
#include "surface/triangles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SIDES 11
#define RINGS 6

static double number(uint32_t *state)
{
    *state = *state * 1664525U + 1013904223U;
    return (double)(*state >> 8) / 0x1p24;
}

static const WrVec3 none = { 0, 0, 0 };

static WrVec3 wide(const float a[3])
{
    return (WrVec3){ (double)a[0], (double)a[1], (double)a[2] };
}

static const WrTriangleCorner *corner(const WrTriangles *t, int32_t i, int k)
{
    return &t->corners[t->triangles[i].corner[k]];
}

/* A closed body with dents, of three materials: rings of points at random distances from its axis, and two poles. */
static WrTriangles *body(uint32_t seed)
{
    static const char *const names[3] = { "foot", "steel, brushed", "" };
    float p[SIDES * RINGS + 2][3];
    int32_t t[2 * SIDES * RINGS][3];
    int count = 0;
    for (int j = 0; j < RINGS; j++)
        for (int i = 0; i < SIDES; i++) {
            const double turn = (i + 0.3 * number(&seed)) / SIDES * 2 * M_PI;
            const double r = (j + 1) * (RINGS - j) + 4 * number(&seed);
            float *at = p[j * SIDES + i];
            at[0] = (float)(1.7 * r * cos(turn) - 3.1), at[1] = (float)(r * sin(turn) + 0.77);
            at[2] = (float)(4.3 * j + 2.2 * number(&seed));
        }
    const int low = SIDES * RINGS, high = low + 1;
    p[low][0] = -3.3F, p[low][1] = 0.6F, p[low][2] = -4.7F;
    p[high][0] = -2.9F, p[high][1] = 1.1F, p[high][2] = 29.9F;
    WrTrianglePart parts[3] = { 0 };
    for (int i = 0; i < SIDES; i++) {
        const int32_t foot[3] = { low, (i + 1) % SIDES, i };
        memcpy(t[count++], foot, sizeof foot);
    }
    parts[0].count = parts[1].first = count;
    for (int j = 0; j + 1 < RINGS; j++)
        for (int i = 0; i < SIDES; i++) {
            const int a = j * SIDES + i, b = j * SIDES + (i + 1) % SIDES;
            const int32_t one[3] = { a, b, b + SIDES }, two[3] = { a, b + SIDES, a + SIDES };
            memcpy(t[count++], one, sizeof one);
            memcpy(t[count++], two, sizeof two);
        }
    parts[1].count = count - parts[1].first;
    parts[2].first = count;
    for (int i = 0; i < SIDES; i++) {
        const int a = (RINGS - 1) * SIDES;
        const int32_t top[3] = { high, a + i, a + (i + 1) % SIDES };
        memcpy(t[count++], top, sizeof top);
    }
    parts[2].count = count - parts[2].first;
    for (int k = 0; k < 3; k++) snprintf(parts[k].name, sizeof parts[k].name, "%s", names[k]);
    WrError err = { "" };
    const WrTrianglesSource source = { .points = (const float(*)[3])p,
                                       .corners = (const int32_t(*)[3])t,
                                       .point_count = high + 1,
                                       .triangle_count = count,
                                       .parts = parts,
                                       .part_count = 3 };
    WrTriangles *made = wr_triangles_new(&source, &err);
    if (!made) fail_msg("%s", err.text);
    assert_true(made->closed);
    return made;
}

static WrTriangles *project(const WrTriangles *mesh, const WrProjection *projection)
{
    WrError err = { "" };
    WrTriangles *made = wr_triangles_project(mesh, projection, NULL, &err);
    if (!made) fail_msg("%s", err.text);
    return made;
}

static const WrProjection turned_box = { .kind = WR_PROJECTION_BOX,
                                         .unit = WR_UNIT_CM,
                                         .cell = { 33.166248, 78.740079 },
                                         .turn_deg = { 33.7, -71.3, 128.9 },
                                         .placed = true,
                                         .at = { 0.318, 12.9, 8.77 },
                                         .crease_deg = 27,
                                         .facing_deg = 45,
                                         .blend = 0.37 };

/* A function of the table, its derivatives in g. */
static double table(double u, double v, double g[2])
{
    const double a = 2 * M_PI * (2 * u + v) + 0.3, b = 2 * M_PI * (u - 3 * v);
    if (g) {
        g[0] = 2 * M_PI * (2 * cos(a) - 0.4 * sin(b));
        g[1] = 2 * M_PI * (cos(a) + 1.2 * sin(b));
    }
    return 1.1 + sin(a) + 0.4 * cos(b);
}

static double height(const WrTriangles *t, int32_t face, double b1, double b2)
{
    WrReliefTap taps[WR_RELIEF_TAPS];
    double f = 0;
    const int count = wr_relief_taps(t, face, b1, b2, taps);
    for (int k = 0; k < count; k++) f += taps[k].weight * table(taps[k].u, taps[k].v, NULL);
    return f;
}

static WrVec3 at_weights(WrVec3 a, WrVec3 b, WrVec3 c, double b1, double b2)
{
    return v3_add(v3_scale(a, 1 - b1 - b2), v3_add(v3_scale(b, b1), v3_scale(c, b2)));
}

static WrVec3 face_normal(const WrTriangles *t, int32_t i)
{
    const WrVec3 a = wide(corner(t, i, 0)->p);
    return v3_unit(
        v3_cross(v3_sub(wide(corner(t, i, 1)->p), a), v3_sub(wide(corner(t, i, 2)->p), a)), none);
}

/* The inverse of the projection's turn. */
static WrVec3 turned_back(WrVec3 p, const double deg[3])
{
    for (int k = 2; k >= 0; k--) {
        const double s = -sin(deg[k] * M_PI / 180), c = cos(deg[k] * M_PI / 180);
        const WrVec3 q = p;
        if (k == 0) p.y = c * q.y - s * q.z, p.z = s * q.y + c * q.z;
        if (k == 1) p.z = c * q.z - s * q.x, p.x = s * q.z + c * q.x;
        if (k == 2) p.x = c * q.x - s * q.y, p.y = s * q.x + c * q.y;
    }
    return p;
}

static double step(double t)
{
    return t <= 0 ? 0 : t >= 1 ? 1 : 3 * t * t - 2 * t * t * t;
}

/* The mean of the faces about a position, weighted by their angles, found by a search over all corners. */
static WrVec3 mean_normal(const WrTriangles *t, WrVec3 p)
{
    WrVec3 sum = none;
    for (int32_t i = 0; i < 3 * t->triangle_count; i++) {
        const WrVec3 a = wide(corner(t, i / 3, i % 3)->p);
        if (v3_len(v3_sub(a, p)) > 0) continue;
        const WrVec3 x = v3_unit(v3_sub(wide(corner(t, i / 3, (i + 1) % 3)->p), a), none);
        const WrVec3 y = v3_unit(v3_sub(wide(corner(t, i / 3, (i + 2) % 3)->p), a), none);
        sum = v3_mad(sum, face_normal(t, i / 3), acos(v3_dot(x, y)));
    }
    return v3_unit(sum, none);
}

/* F of the blended box by its formula. */
static double blended(const WrTriangles *t, int32_t face, double b1, double b2,
                      const WrProjection *p)
{
    WrVec3 at[3], s[3];
    for (int k = 0; k < 3; k++) at[k] = wide(corner(t, face, k)->p), s[k] = mean_normal(t, at[k]);
    const WrVec3 n = turned_back(at_weights(s[0], s[1], s[2], b1, b2), p->turn_deg);
    const WrVec3 from = { p->at[0], p->at[1], p->at[2] };
    const WrVec3 q = v3_scale(
        turned_back(v3_sub(at_weights(at[0], at[1], at[2], b1, b2), from), p->turn_deg), 10);
    const double part[3] = { fabs(n.x), fabs(n.y), fabs(n.z) };
    const double most = fmax(part[0], fmax(part[1], part[2]));
    const double u[3] = { n.x < 0 ? -q.y : q.y, n.y < 0 ? q.x : -q.x, n.z < 0 ? -q.x : q.x };
    const double v[3] = { q.z, q.z, q.y };
    double sum = 0, all = 0;
    for (int k = 0; k < 3; k++) {
        const double w = step((part[k] / most - 1 + p->blend) / p->blend);
        sum += w * table(u[k] / p->cell[0], v[k] / p->cell[1], NULL);
        all += w;
    }
    return sum / all;
}

static void blended_planes_are_the_formula(void **state)
{
    (void)state;
    uint32_t seed = 71;
    int mixed = 0;
    WrTriangles *mesh = body(5);
    for (int round = 0; round < 3; round++) {
        WrProjection p = turned_box;
        p.blend = round == 0 ? 1 : 0.37 / round;
        WrTriangles *t = project(mesh, &p);
        for (int i = 0; i < 4000; i++) {
            const int32_t face = (int32_t)(number(&seed) * t->triangle_count);
            double b1 = number(&seed), b2 = number(&seed);
            if (b1 + b2 > 1) b1 = 1 - b1, b2 = 1 - b2;
            WrReliefTap taps[WR_RELIEF_TAPS];
            assert_int_equal(wr_relief_taps(t, face, b1, b2, taps), 3);
            const double sum = taps[0].weight + taps[1].weight + taps[2].weight;
            assert_near(sum, 1, 1e-12);
            mixed += fmax(taps[0].weight, fmax(taps[1].weight, taps[2].weight)) < 0.99;
            assert_near(height(t, face, b1, b2), blended(t, face, b1, b2, &p), 2e-4);
        }
        wr_triangles_free(t);
    }
    assert_true(mixed > 2000);
    wr_triangles_free(mesh);
}

/* F on both sides of every edge, at a random place of it. */
static double largest_step(const WrTriangles *t, int *edges)
{
    uint32_t seed = 3;
    double worst = 0;
    *edges = 0;
    for (int32_t h = 0; h < 3 * t->triangle_count; h++)
        for (int32_t g = 0; g < h; g++) {
            const WrVec3 a = wide(corner(t, h / 3, h % 3)->p),
                         b = wide(corner(t, h / 3, (h + 1) % 3)->p);
            if (v3_len(v3_sub(a, wide(corner(t, g / 3, (g + 1) % 3)->p))) > 0 ||
                v3_len(v3_sub(b, wide(corner(t, g / 3, g % 3)->p))) > 0)
                continue;
            const double part = number(&seed);
            double w[2][3] = { 0 };
            w[0][h % 3] = 1 - part, w[0][(h + 1) % 3] = part;
            w[1][(g + 1) % 3] = 1 - part, w[1][g % 3] = part;
            worst = fmax(worst, fabs(height(t, h / 3, w[0][1], w[0][2]) -
                                     height(t, g / 3, w[1][1], w[1][2])));
            ++*edges;
        }
    return worst;
}

static void blended_relief_runs_on_across_edges(void **state)
{
    (void)state;
    WrTriangles *mesh = body(9);
    WrProjection p = turned_box;
    WrTextureSeams seams;
    WrError err = { "" };
    int edges;
    WrTriangles *t = project(mesh, &p);
    assert_true(largest_step(t, &edges) < 1e-5);
    assert_int_equal(edges, 3 * t->triangle_count / 2);
    assert_true(wr_triangles_seams(t, &seams, &err));
    assert_int_equal(seams.edges, 0);
    wr_triangles_free(t);
    p.blend = 0;
    p.facing = WR_FACING_OUT, p.facing_deg = 180; /* weights of 1 */
    t = project(mesh, &p);
    assert_true(largest_step(t, &edges) > 0.5);
    assert_true(wr_triangles_seams(t, &seams, &err));
    assert_true(seams.edges > 10);
    wr_triangles_free(t);
    wr_triangles_free(mesh);
}

/* ---- bodies and tables for masks ---- */

/* The body with (u,v) of its own, those of a plane, except on its last material. */
static WrTriangles *laid_body(uint32_t seed)
{
    WrTriangles *mesh = body(seed);
    float(*p)[3] = wr_alloc(3 * (size_t)mesh->triangle_count, sizeof *p);
    float(*uv)[2] = wr_alloc(3 * (size_t)mesh->triangle_count, sizeof *uv);
    int32_t(*c)[3] = wr_alloc((size_t)mesh->triangle_count, sizeof *c);
    WrError err = { "" };
    for (int32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        const float *at = corner(mesh, i / 3, i % 3)->p;
        memcpy(p[i], at, sizeof *p);
        uv[i][0] = 0.31F + 0.013F * at[0] - 0.004F * at[2];
        uv[i][1] = i / 3 < mesh->parts[2].first ? 0.42F + 0.017F * at[1] + 0.011F * at[2] : NAN;
        c[i / 3][i % 3] = i;
    }
    const WrTrianglesSource source = { .points = (const float(*)[3])p,
                                       .uv = (const float(*)[2])uv,
                                       .corners = (const int32_t(*)[3])c,
                                       .point_count = 3 * mesh->triangle_count,
                                       .triangle_count = mesh->triangle_count,
                                       .parts = mesh->parts,
                                       .part_count = mesh->part_count };
    WrTriangles *made = wr_triangles_new(&source, &err);
    if (!made) fail_msg("%s", err.text);
    wr_free(p);
    wr_free(uv);
    wr_free(c);
    wr_triangles_free(mesh);
    return made;
}

/* A ramp from -1.2 to 1.8 over v, except for the ends, where a periodic table falls again: B-splines reproduce straight
   lines. */
#define RAMP 50
static WrField *ramp_mask(void)
{
    WrError err = { "" };
    WrField *mask = wr_field_new(7, RAMP, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, &err);
    for (int j = 0; j < RAMP; j++)
        for (int i = 0; i < 7; i++)
            wr_field_set(mask, i, j, (float)(3 * (1 - (j + 0.5) / RAMP) - 1.2));
    return mask;
}

/* ---- derivatives ---- */

static void slopes_are_differences(void **state)
{
    (void)state;
    uint32_t seed = 17;
    WrTriangles *mesh = laid_body(31);
    WrField *mask = ramp_mask();
    WrError err = { "" };
    WrProjection p = turned_box;
    p.cell[0] = 331.66, p.cell[1] = 787.4;
    for (int round = 0; round < 8; round++) {
        const int which = round % 4;
        p.kind = which == 3 ? WR_PROJECTION_SPHERICAL : WR_PROJECTION_BOX;
        p.facing = which == 0   ? WR_FACING_ANY
                   : which == 1 ? WR_FACING_MINUS_Y
                   : which == 2 ? WR_FACING_IN
                                : WR_FACING_OUT;
        p.facing_deg = 30, p.facing_soft_deg = 140;
        p.at[0] = -3.1, p.at[1] = 0.7, p.at[2] = 11;
        WrTriangles *t = wr_triangles_project(mesh, &p, round < 4 ? NULL : mask, &err);
        int sloped = 0;
        for (int i = 0; i < 3000; i++) {
            const int32_t face = (int32_t)(number(&seed) * t->triangle_count);
            const double b1 = 0.1 + 0.4 * number(&seed), b2 = 0.1 + 0.4 * number(&seed), h = 1e-6;
            WrReliefTap taps[WR_RELIEF_TAPS];
            WrReliefSum sum = { 0 };
            const int count = wr_relief_taps(t, face, b1, b2, taps);
            for (int k = 0; k < count; k++) {
                double g[2];
                const double f = table(taps[k].u, taps[k].v, g);
                wr_relief_add(&sum, &taps[k], f, g[0], g[1]);
                sloped += taps[k].weight_b[0] != 0;
            }
            const double one =
                (height(t, face, b1 + h, b2) - height(t, face, b1 - h, b2)) / (2 * h);
            const double two =
                (height(t, face, b1, b2 + h) - height(t, face, b1, b2 - h)) / (2 * h);
            assert_near(sum.f_b[0], one, 1e-4 * (1 + fabs(one)));
            assert_near(sum.f_b[1], two, 1e-4 * (1 + fabs(two)));
            double fu, fv; /* along an edge of the face they give the same derivative */
            wr_relief_slopes(t, face, &sum, &fu, &fv);
            const WrTriangleCorner *a = corner(t, face, 0), *b = corner(t, face, 2);
            const double along = fu * (double)(b->u - a->u) + fv * (double)(b->v - a->v);
            assert_near(along, two, 2e-3 * (1 + fabs(two)));
        }
        assert_true(sloped > 500);
        wr_triangles_free(t);
    }
    wr_field_free(mask);
    wr_triangles_free(mesh);
}

/* ---- masks ---- */

static WrVec3 direction(const WrProjection *p, WrVec3 at)
{
    const double sign = p->facing >= WR_FACING_MINUS_X && p->facing != WR_FACING_OUT ? -1 : 1;
    const int axis = (p->facing - WR_FACING_X) % 3;
    const WrVec3 from = { p->at[0], p->at[1], p->at[2] };
    WrVec3 q = turned_back(v3_sub(at, from), p->turn_deg);
    if (p->facing < WR_FACING_OUT) q = (WrVec3){ axis == 0, axis == 1, axis == 2 };
    else if (p->kind != WR_PROJECTION_SPHERICAL) q.z = 0;
    return v3_scale(v3_unit(q, none), sign);
}

static void directions_are_angles(void **state)
{
    (void)state;
    uint32_t seed = 23;
    int whole = 0, part = 0, nothing = 0;
    WrTriangles *mesh = body(77);
    WrProjection p = turned_box;
    p.blend = 0;
    p.at[0] = -3.1, p.at[1] = 0.7, p.at[2] = 11;
    for (p.facing = WR_FACING_X; p.facing < WR_FACINGS; p.facing++)
        for (int which = 0; which < 3; which++) {
            p.kind = which == 2 ? WR_PROJECTION_SPHERICAL : WR_PROJECTION_BOX;
            p.facing_deg = 20 + 60 * number(&seed);
            p.facing_soft_deg = which == 0 ? 0 : 5 + 50 * number(&seed);
            WrTriangles *t = project(mesh, &p);
            for (int32_t i = 0; i < t->triangle_count; i++) {
                const double b1 = 0.5 * number(&seed), b2 = 0.5 * number(&seed);
                WrVec3 n[3], at[3];
                for (int k = 0; k < 3; k++)
                    n[k] = wide(corner(t, i, k)->n), at[k] = wide(corner(t, i, k)->p);
                const double third = 1.0 / 3;
                const WrVec3 place = which == 0 ? at_weights(at[0], at[1], at[2], third, third)
                                                : at_weights(at[0], at[1], at[2], b1, b2);
                WrVec3 normal =
                    which == 0 ? face_normal(t, i) : at_weights(n[0], n[1], n[2], b1, b2);
                normal = turned_back(v3_unit(normal, none), p.turn_deg);
                const double c = v3_dot(normal, direction(&p, place));
                const double inner = cos(p.facing_deg * M_PI / 180),
                             outer = cos((p.facing_deg + p.facing_soft_deg) * M_PI / 180);
                const double is = which == 0 ? c >= inner : step((c - outer) / (inner - outer));
                WrReliefTap tap[WR_RELIEF_TAPS];
                const int count = wr_relief_taps(t, i, b1, b2, tap);
                const double m = count ? tap[0].weight : 0;
                assert_near(m, is, 1e-5);
                assert_true(which != 0 || wr_relief_covers(t, i) == (m > 0));
                whole += m == 1, nothing += m == 0, part += m > 0 && m < 1;
            }
            wr_triangles_free(t);
        }
    assert_true(whole > 500 && part > 500 && nothing > 500);
    wr_triangles_free(mesh);
}

/* The part's number of a triangle. */
static int part_of(const WrTriangles *t, int32_t triangle)
{
    int k = 0;
    while (triangle >= t->parts[k].first + t->parts[k].count) k++;
    return k + 1;
}

static void materials_are_listed(void **state)
{
    (void)state;
    static const struct {
        const char *list;
        int parts; /* bit n: number n */
    } rows[] = { { "foot", 2 }, { "3", 8 }, { "3,foot", 10 }, { "2", 4 }, { "1,2,3", 14 } };
    WrTriangles *mesh = body(41);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int kind = 0; kind < WR_PROJECTIONS; kind++) {
            WrProjection p = turned_box;
            p.kind = (WrProjectionKind)kind;
            p.blend = 0;
            strcpy(p.materials, rows[i].list);
            WrTriangles *t = project(mesh, &p);
            for (int32_t k = 0; k < t->triangle_count; k++)
                assert_int_equal(wr_relief_covers(t, k), rows[i].parts >> part_of(t, k) & 1);
            wr_triangles_free(t);
        }
    WrError err = { "" };
    WrProjection p = turned_box;
    strcpy(p.materials, "foot,hand");
    assert_null(wr_triangles_project(mesh, &p, NULL, &err));
    assert_string_equal(err.text, "materials=hand: the mesh has no such material; it has 1 foot, 2 "
                                  "steel, brushed, 3 (unnamed)");
    wr_triangles_free(mesh);
}

/* Masks multiply; meshes without any are those of before; other masks have other keys. */
static void masks_combine(void **state)
{
    (void)state;
    uint32_t seed = 55;
    WrTriangles *mesh = body(12);
    WrProjection p = wr_projection_default;
    assert_true(project(mesh, &p) == mesh);
    wr_triangles_free(mesh);
    p.kind = WR_PROJECTION_BOX;
    WrTriangles *plain = project(mesh, &p);
    assert_null(plain->weights);
    p.blend = 0.6;
    WrTriangles *mixed = project(mesh, &p);
    strcpy(p.materials, "foot,2");
    p.facing = WR_FACING_Z, p.facing_deg = 80, p.facing_soft_deg = 70;
    WrTriangles *all = project(mesh, &p);
    p.blend = 0;
    WrTriangles *masked = project(mesh, &p);
    assert_true(plain->key != mixed->key && all->key != mixed->key && all->key != masked->key);
    int parts = 0;
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        const double b1 = 0.5 * number(&seed), b2 = 0.5 * number(&seed);
        WrReliefTap tap[WR_RELIEF_TAPS], own[WR_RELIEF_TAPS];
        const int count = wr_relief_taps(masked, i, b1, b2, tap);
        const double m = count ? tap[0].weight : 0;
        assert_near(height(all, i, b1, b2), m * height(mixed, i, b1, b2), 1e-9);
        if (m > 0) assert_int_equal(wr_relief_taps(all, i, b1, b2, own), 3);
        parts += m > 0 && m < 1;
    }
    assert_true(parts > 20);
    wr_triangles_free(plain);
    wr_triangles_free(mixed);
    wr_triangles_free(all);
    wr_triangles_free(masked);
    wr_triangles_free(mesh);
}

/* ---- a mask table ---- */

/* Whatever the projection, and however it divides the triangles, the mask is read at the plane's (u,v) of the point. */
static void mask_tables_lie_in_the_own_coordinates(void **state)
{
    (void)state;
    uint32_t seed = 91;
    WrTriangles *mesh = laid_body(64);
    WrField *mask = ramp_mask();
    for (int kind = 0; kind < WR_PROJECTIONS; kind++) {
        WrProjection p = turned_box;
        WrError err = { "" };
        int whole = 0, part = 0, nothing = 0;
        p.kind = (WrProjectionKind)kind;
        WrTriangles *t = wr_triangles_project(mesh, &p, mask, &err);
        WrTriangles *plain = project(mesh, &p);
        assert_true(t->key != plain->key);
        for (int i = 0; i < 4000; i++) {
            const int32_t face = (int32_t)(number(&seed) * t->triangle_count);
            const double b1 = 0.5 * number(&seed), b2 = 0.5 * number(&seed);
            WrVec3 at[3];
            for (int k = 0; k < 3; k++) at[k] = wide(corner(t, face, k)->p);
            const WrVec3 q = at_weights(at[0], at[1], at[2], b1, b2);
            const double v = 0.42 + 0.017 * q.y + 0.011 * q.z, ramp = 3 * (v - floor(v)) - 1.2;
            const bool has = part_of(t, face) < 3;
            if (has && fabs(v - rint(v)) < 2.5 / RAMP) continue; /* of the table's ends */
            WrReliefTap taps[WR_RELIEF_TAPS];
            const int count = wr_relief_taps(t, face, b1, b2, taps);
            double m = 0;
            for (int k = 0; k < count; k++) m += taps[k].weight;
            assert_near(m, has ? fmin(fmax(ramp, 0), 1) : 0, 1e-5);
            const bool full = m > 1 - 1e-9;
            whole += full, nothing += has && m == 0, part += m > 0 && !full;
        }
        if (whole < 200 || part < 400 || nothing < 20)
            fail_msg("%d whole, %d part, %d nothing", whole, part, nothing);
        wr_triangles_free(plain);
        wr_triangles_free(t);
    }
    wr_field_free(mask);
    wr_triangles_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blended_planes_are_the_formula),
        cmocka_unit_test(blended_relief_runs_on_across_edges),
        cmocka_unit_test(slopes_are_differences),
        cmocka_unit_test(directions_are_angles),
        cmocka_unit_test(materials_are_listed),
        cmocka_unit_test(masks_combine),
        cmocka_unit_test(mask_tables_lie_in_the_own_coordinates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

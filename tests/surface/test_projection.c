/* Projections of texture coordinates onto meshes: formulas at corners, continuity, creases, seams. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "surface/projection.h"
#include "surface/triangles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int32_t cube_corners[12][3] = {
    { 0, 2, 1 }, { 0, 3, 2 }, { 4, 5, 6 }, { 4, 6, 7 }, { 0, 1, 5 }, { 0, 5, 4 },
    { 1, 2, 6 }, { 1, 6, 5 }, { 2, 3, 7 }, { 2, 7, 6 }, { 3, 0, 4 }, { 3, 4, 7 },
};

static WrTriangles *mesh_of(const float (*points)[3], int32_t point_count,
                            const int32_t (*corners)[3], int32_t count)
{
    WrError err = { "" };
    const WrTrianglesSource source = {
        .points = points, .corners = corners, .point_count = point_count, .triangle_count = count
    };
    WrTriangles *made = wr_triangles_new(&source, &err);
    if (!made) fail_msg("%s", err.text);
    return made;
}

/* A box of these sides with its lowest corner at `at`. */
static WrTriangles *box(double a, double b, double c, const double at[3])
{
    float p[8][3];
    const double side[3] = { a, b, c };
    for (int i = 0; i < 8; i++) {
        const bool far[3] = { (i & 3) == 1 || (i & 3) == 2, (i & 2) != 0, i >= 4 };
        for (int k = 0; k < 3; k++) p[i][k] = (float)(at[k] + (far[k] ? side[k] : 0));
    }
    return mesh_of((const float(*)[3])p, 8, cube_corners, 12);
}

#define ROUND_MAX 4000

/* A body of revolution about z with `sides` sides: radii r, heights z of its rings; r = 0: a point. */
static WrTriangles *lathe(int sides, int rings, const double *r, const double *z, double tilt)
{
    static float p[ROUND_MAX][3];
    static int32_t t[ROUND_MAX][3];
    int count = 0;
    for (int j = 0; j < rings; j++)
        for (int i = 0; i < sides; i++) {
            const double turn = (i + tilt) / sides * 2 * M_PI;
            const double q[3] = { r[j] * cos(turn), r[j] * sin(turn), z[j] };
            for (int k = 0; k < 3; k++) p[j * sides + i][k] = (float)q[k];
        }
    for (int j = 0; j + 1 < rings; j++)
        for (int i = 0; i < sides; i++) {
            const int a = j * sides + i, b = j * sides + (i + 1) % sides;
            const int32_t low[3] = { a, b, b + sides }, up[3] = { a, b + sides, a + sides };
            if (r[j] > 0) memcpy(t[count++], low, sizeof low);
            if (r[j + 1] > 0) memcpy(t[count++], up, sizeof up);
        }
    return mesh_of((const float(*)[3])p, rings * sides, (const int32_t(*)[3])t, count);
}

static WrTriangles *project(const WrTriangles *mesh, const WrProjection *projection)
{
    WrError err = { "" };
    WrTriangles *made = wr_triangles_project(mesh, projection, NULL, &err);
    if (!made) fail_msg("%s", err.text);
    return made;
}

static const WrTriangleCorner *corner(const WrTriangles *t, int32_t i, int k)
{
    return &t->corners[t->triangles[i].corner[k]];
}

static WrVec3 wide(const float a[3])
{
    return (WrVec3){ (double)a[0], (double)a[1], (double)a[2] };
}

static WrVec3 face(const WrTriangles *t, int32_t i)
{
    const WrVec3 a = wide(corner(t, i, 0)->p), none = { 0, 0, 0 };
    return v3_unit(
        v3_cross(v3_sub(wide(corner(t, i, 1)->p), a), v3_sub(wide(corner(t, i, 2)->p), a)), none);
}

/* ---- formulas ---- */

/* The inverse of the turn about x, then y, then z, by another road: one axis after the other. */
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

static void corners_are_the_formulas(void **state)
{
    (void)state;
    const double low[3] = { -3.7182818, 11.414213, 5.7724 };
    WrTriangles *mesh = box(7.3890561, 4.8104774, 9.8696044, low);
    WrProjection p = { .unit = WR_UNIT_CM,
                       .cell = { 3.3166248, 7.8740079 },
                       .turn_deg = { 33.7, -71.3, 128.9 },
                       .placed = true,
                       .at = { 0.318, 12.9, 8.77 },
                       .crease_deg = 180 };
    for (p.kind = WR_PROJECTION_PLANAR; p.kind <= WR_PROJECTION_BOX; p.kind++) {
        WrTriangles *t = project(mesh, &p);
        assert_int_equal(t->triangle_count, 12);
        for (int32_t i = 0; i < 12; i++) {
            const WrVec3 n = p.kind == WR_PROJECTION_BOX ? turned_back(face(t, i), p.turn_deg)
                                                         : (WrVec3){ 0, 0, 1 };
            const bool x = fabs(n.x) > fabs(n.y) && fabs(n.x) > fabs(n.z);
            const bool y = !x && fabs(n.y) > fabs(n.z);
            for (int k = 0; k < 3; k++) {
                const WrTriangleCorner *c = corner(t, i, k);
                const WrVec3 at = { p.at[0], p.at[1], p.at[2] };
                const WrVec3 q = v3_scale(turned_back(v3_sub(wide(c->p), at), p.turn_deg), 10);
                const double u = x   ? copysign(q.y, q.y * n.x)
                                 : y ? copysign(q.x, -q.x * n.y)
                                     : copysign(q.x, q.x * n.z);
                assert_near((double)c->u, u / p.cell[0], 1e-5);
                assert_near((double)c->v, (x || y ? q.z : q.y) / p.cell[1], 1e-5);
            }
        }
        wr_triangles_free(t);
    }
    wr_triangles_free(mesh);
}

static void round_ones_are_the_formulas(void **state)
{
    (void)state;
    const double r[] = { 20, 20 }, z[] = { -7, 13 };
    WrTriangles *mesh = lathe(72, 2, r, z, 0.37); /* an open pipe; R is a little less than 20 */
    WrProjection p = wr_projection_default;
    p.kind = WR_PROJECTION_CYLINDRICAL;
    p.cell[0] = 7.1, p.cell[1] = 3.3;
    double radius;
    const int n = wr_projection_round(mesh, &p, &radius);
    assert_int_equal(n, 18); /* 2 pi 20 / 7.1 is 17.7 */
    assert_near(radius, 20, 0.05);
    WrTriangles *t = project(mesh, &p);
    assert_int_equal(t->triangle_count, mesh->triangle_count); /* 5 degrees are narrow enough */
    for (p.kind = WR_PROJECTION_CYLINDRICAL; p.kind <= WR_PROJECTION_SPHERICAL; p.kind++) {
        WrTriangles *round = project(mesh, &p);
        const int cells = wr_projection_round(mesh, &p, &radius);
        for (int32_t i = 0; i < round->triangle_count; i++)
            for (int k = 0; k < 3; k++) {
                const WrTriangleCorner *c = corner(round, i, k);
                const WrVec3 q = v3_sub(wide(c->p), (WrVec3){ 0, 0, 3 });
                const double u = cells * atan2(q.y, q.x) / (2 * M_PI), away = hypot(q.x, q.y);
                const double v =
                    (p.kind == WR_PROJECTION_CYLINDRICAL ? q.z : radius * atan2(q.z, away)) / 3.3;
                assert_near(remainder((double)c->u - u, cells), 0, 2e-5);
                assert_near((double)c->v, v, 1e-5);
            }
        wr_triangles_free(round);
    }
    wr_triangles_free(t);
    wr_triangles_free(mesh);
}

/* Seen from outside, u goes to the right and v up. */
static void letters_read_from_outside(void **state)
{
    (void)state;
    const double low[3] = { -1, -2, -3 }, r[] = { 0, 1, 1.3, 1, 0 }, z[] = { -1, -0.6, 0, 0.6, 1 };
    const WrVec3 up = { 0, 0, 1 };
    WrTriangles *meshes[] = { box(2, 4, 6, low), lathe(17, 5, r, z, 0) };
    for (int m = 0; m < 2; m++)
        for (int kind = WR_PROJECTION_BOX; kind < WR_PROJECTIONS; kind++) {
            WrProjection p = wr_projection_default;
            p.kind = (WrProjectionKind)kind;
            p.cell[0] = p.cell[1] = 0.7;
            WrTriangles *t = project(meshes[m], &p);
            for (int32_t i = 0; i < t->triangle_count; i++) {
                WrVec3 q[3], n, gu, gv;
                double uv[3][2];
                for (int k = 0; k < 3; k++) {
                    q[k] = wide(corner(t, i, k)->p);
                    uv[k][0] = (double)corner(t, i, k)->u, uv[k][1] = (double)corner(t, i, k)->v;
                }
                assert_true(wr_triangle_gradients(q, (const double(*)[2])uv, &n, &gu, &gv));
                if (kind == WR_PROJECTION_BOX) assert_true(v3_dot(v3_cross(gu, gv), n) > 1e-3);
                if (fabs(n.z) > 0.7) continue; /* tops and bottoms */
                assert_true(v3_dot(gu, v3_cross(up, n)) > 0.1);
                assert_true(v3_dot(gv, up) > 0.1);
            }
            wr_triangles_free(t);
        }
    for (int m = 0; m < 2; m++) wr_triangles_free(meshes[m]);
}

/* ---- continuity ---- */

typedef struct Half {
    float p[2][3]; /* the end of the lower bytes first */
    const WrTriangleCorner *end[2];
} Half;

static int compare_halves(const void *a, const void *b)
{
    return memcmp(((const Half *)a)->p, ((const Half *)b)->p, sizeof((const Half *)a)->p);
}

static double from_whole(float a, float b)
{
    const double d = (double)a - (double)b;
    return fabs(d - rint(d));
}

static bool on_axis(const float *p)
{
    return hypotf(p[0], p[1]) < 1e-4f;
}

/* Compares the faces at each edge; returns the number of edges with two. Corners on the axis have no angle. */
static int check_edges(const WrTriangles *t)
{
    const size_t count = 3 * (size_t)t->triangle_count;
    Half *half = wr_alloc(count, sizeof *half);
    int shared = 0;
    for (size_t i = 0; i < count; i++) {
        const WrTriangleCorner *a = corner(t, (int32_t)(i / 3), (int)(i % 3));
        const WrTriangleCorner *b = corner(t, (int32_t)(i / 3), (int)((i + 1) % 3));
        const bool turn = memcmp(a->p, b->p, sizeof a->p) > 0;
        half[i].end[0] = turn ? b : a, half[i].end[1] = turn ? a : b;
        for (int k = 0; k < 2; k++) memcpy(half[i].p[k], half[i].end[k]->p, sizeof half[i].p[k]);
    }
    qsort(half, count, sizeof *half, compare_halves);
    for (size_t i = 1; i < count; i++) {
        if (compare_halves(half + i - 1, half + i) != 0) continue;
        shared++;
        for (int k = 0; k < 2; k++) {
            const WrTriangleCorner *a = half[i - 1].end[k], *b = half[i].end[k];
            if (!on_axis(a->p) && !(from_whole(a->u, b->u) < 2e-5))
                fail_msg("u %g and %g", (double)a->u, (double)b->u);
            assert_near((double)a->v, (double)b->v, 1e-5);
        }
    }
    wr_free(half);
    return shared;
}

/* The largest angle of an edge in the projection, from the point `at` for a sphere. */
static double span_deg(const WrTriangles *t, int32_t i, WrVec3 at, bool sphere)
{
    double most = 0;
    for (int k = 0; k < 3; k++) {
        const float *a = corner(t, i, k)->p, *b = corner(t, i, (k + 1) % 3)->p;
        const WrVec3 from = v3_sub(wide(a), at), to = v3_sub(wide(b), at);
        if (v3_len(v3_sub(from, to)) < 13.7 / 128) continue; /* short enough */
        if (sphere) most = fmax(most, v3_angle_rad(from, to) * 180 / M_PI);
        const double turn = atan2(to.y, to.x) - atan2(from.y, from.x);
        if (on_axis(a) || on_axis(b)) continue;
        most = fmax(most, fabs(remainder(turn, 2 * M_PI)) * 180 / M_PI);
    }
    return most;
}

static double volume(const WrTriangles *t)
{
    double sum = 0;
    for (int32_t i = 0; i < t->triangle_count; i++)
        sum += v3_dot(wide(corner(t, i, 0)->p),
                      v3_cross(wide(corner(t, i, 1)->p), wide(corner(t, i, 2)->p))) /
               6;
    return sum;
}

/* Coarse bodies of odd numbers of sides, with the seam inside of a side and on an edge, and with poles. */
static void relief_runs_on_across_the_seam(void **state)
{
    (void)state;
    const double r[] = { 0, 9.1, 13.7, 0 }, z[] = { -8.3, -5.1, 6.7, 11.9 };
    for (int kind = WR_PROJECTION_CYLINDRICAL; kind < WR_PROJECTIONS; kind++)
        for (int i = 0; i < 4; i++) {
            WrTriangles *mesh = lathe(i < 2 ? 5 : 7, 4, r, z, i % 2 ? 0.5 : 0.31);
            WrProjection p = wr_projection_default;
            p.kind = (WrProjectionKind)kind;
            p.placed = true;
            p.at[0] = p.at[1] = 0, p.at[2] = 0.4;
            p.cell[0] = 5.3, p.cell[1] = 2.9;
            WrTriangles *t = project(mesh, &p);
            assert_true(mesh->closed && t->closed); /* no cracks */
            assert_near(volume(t), volume(mesh), 1e-5 * volume(mesh));
            assert_int_equal(2 * check_edges(t), 3 * t->triangle_count);
            const WrVec3 at = { 0, 0, 0.4 };
            double most = 0;
            for (int32_t k = 0; k < t->triangle_count; k++)
                most = fmax(most, span_deg(t, k, at, kind == WR_PROJECTION_SPHERICAL));
            assert_true(most < 5.011 && t->triangle_count > 8 * mesh->triangle_count);
            WrTextureSeams seams;
            assert_true(wr_triangles_seams(t, &seams, NULL));
            /* only the edges that end on the axis, where the angle is another for each triangle */
            assert_near(hypot(seams.at.x, seams.at.y), 0, 14);
            int poles = 0;
            for (int32_t k = 0; k < 3 * t->triangle_count; k++) {
                const float *q = corner(t, k / 3, k % 3)->p;
                poles += on_axis(q);
            }
            assert_int_equal(seams.edges, poles);
            wr_triangles_free(t);
            wr_triangles_free(mesh);
        }
}

/* A body about an axis outside of it has no poles and no seams; one that the axis pierces between its corners is
   divided there until edges are short. */
static void an_axis_beside_the_mesh(void **state)
{
    (void)state;
    const double low[3] = { 3, -2, -3 }, around[3] = { -3.1, -2.2, -3 };
    for (int i = 0; i < 2; i++) {
        WrTriangles *mesh = i ? box(6, 4, 6, around) : box(2, 4, 6, low);
        WrProjection p = wr_projection_default;
        p.kind = WR_PROJECTION_CYLINDRICAL;
        p.placed = true;
        p.cell[0] = p.cell[1] = 1;
        WrTriangles *t = project(mesh, &p);
        WrTextureSeams seams;
        assert_true(wr_triangles_seams(t, &seams, NULL));
        assert_true(t->closed);
        assert_true(i ? seams.edges == 2 : seams.edges == 0);
        if (i) assert_true(hypot(seams.at.x, seams.at.y) < 0.1 && t->triangle_count < 30000);
        wr_triangles_free(t);
        wr_triangles_free(mesh);
    }
}

static void a_box_has_seams_at_its_edges(void **state)
{
    (void)state;
    const double low[3] = { 1, 2, 3 };
    WrTriangles *mesh = box(4.1, 5.3, 6.7, low);
    WrProjection p = wr_projection_default;
    WrTextureSeams seams;
    p.kind = WR_PROJECTION_BOX;
    p.cell[0] = p.cell[1] = 1.37;
    WrTriangles *t = project(mesh, &p);
    assert_true(wr_triangles_seams(t, &seams, NULL));
    assert_int_equal(seams.edges, 12);
    assert_near(seams.length, 4 * (4.1 + 5.3 + 6.7), 1e-4);
    assert_near(seams.at.z, 3 + 6.7 / 2, 1e-5); /* the middle of an upright edge, the longest */
    assert_int_equal(seams.runs, 1);
    const WrVec3 n = seams.run[0].n; /* the mean of two of the four sides' normals */
    assert_near(fabs(n.x), sqrt(0.5), 1e-6);
    assert_near(fabs(n.y), sqrt(0.5), 1e-6);
    assert_near(n.z, 0, 1e-6);
    assert_true(n.x * (seams.at.x - (1 + 4.1 / 2)) > 0 && n.y * (seams.at.y - (2 + 5.3 / 2)) > 0);
    wr_triangles_free(t);
    wr_triangles_free(mesh);
    /* a whole number of cells from the centre to each side: the table runs on around the upright edges, from the
       front (-y) to the top, and from the back to the bottom */
    mesh = box(4, 6, 2, low);
    p.cell[0] = p.cell[1] = 1;
    t = project(mesh, &p);
    assert_true(wr_triangles_seams(t, &seams, NULL));
    assert_int_equal(seams.edges, 6);
    assert_int_equal(seams.runs, 2); /* three edges of the top, and three of the bottom */
    for (int k = 0; k < 2; k++) assert_near(seams.run[k].length, 4 + 6 + 6, 1e-5);
    assert_near(fabs(seams.run[0].at.z - seams.run[1].at.z), 2, 1e-5);
    wr_triangles_free(t);
    p.kind = WR_PROJECTION_PLANAR;
    t = project(mesh, &p);
    assert_true(wr_triangles_seams(t, &seams, NULL));
    assert_int_equal(seams.edges, 0);
    wr_triangles_free(t);
    wr_triangles_free(mesh);
}

/* Sides at 45 degrees belong to x in spite of their rounding: no seam inside of them. */
static void ties_are_broken_alike(void **state)
{
    (void)state;
    const double r[] = { 3.3, 3.4 }, z[] = { -4, 5 };
    for (int i = 0; i < 8; i++) {
        WrTriangles *mesh = lathe(8, 2, r, z, 0.5 + 0.13 * i);
        WrProjection p = wr_projection_default;
        WrTextureSeams seams;
        p.kind = WR_PROJECTION_BOX;
        p.cell[0] = p.cell[1] = 1.37;
        p.turn_deg[2] = 0.13 * i * 45;
        WrTriangles *t = project(mesh, &p);
        assert_true(wr_triangles_seams(t, &seams, NULL));
        assert_int_equal(seams.edges, 4);
        wr_triangles_free(t);
        wr_triangles_free(mesh);
    }
}

/* ---- normals ---- */

static void creases_part_normals(void **state)
{
    (void)state;
    const double low[3] = { 0, 0, 0 }, r[] = { 2, 2 }, z[] = { 0, 5 };
    WrTriangles *mesh = box(1, 2, 3, low), *pipe = lathe(12, 2, r, z, 0); /* 30 degrees an edge */
    WrProjection p = wr_projection_default;
    WrTriangles *t = project(mesh, &p);
    assert_ptr_equal(t, mesh); /* nothing to do: the same mesh */
    wr_triangles_free(t);
    p.crease_deg = 89;
    t = project(mesh, &p);
    assert_true(t->faceted && !mesh->faceted);
    assert_int_equal(t->corner_count, 24);
    for (int32_t i = 0; i < t->triangle_count; i++)
        assert_near(v3_dot(face(t, i), wide(corner(t, i, 0)->n)), 1, 1e-12);
    wr_triangles_free(t);
    p.crease_deg = 91;
    t = project(mesh, &p);
    assert_int_equal(t->corner_count, 8);
    assert_near((double)fabsf(corner(t, 0, 0)->n[0]), sqrt(1.0 / 3), 1e-6);
    wr_triangles_free(t);
    for (int i = 0; i < 3; i++) {
        static const double limit[3] = { 29, 30, 31 };
        p.crease_deg = limit[i];
        t = project(pipe, &p);
        assert_int_equal(t->faceted, i == 0);
        assert_int_equal(t->corner_count, i == 0 ? 48 : 24);
        wr_triangles_free(t);
    }
    wr_triangles_free(mesh);
    wr_triangles_free(pipe);
}

/* The same bits on every machine: the numbers of this one. Documents hold the settings only. */
static void results_are_the_same_everywhere(void **state)
{
    (void)state;
    static const uint64_t keys[WR_PROJECTIONS] = { 0x99cb67a520abdf5c, 0x29271819332e974d,
                                                   0x43f8628489f06fe2, 0x499041f442fceee2,
                                                   0x1ba95f090de9b811 };
    const double low[3] = { -0.375, -1.25, 0.8125 };
    WrTriangles *mesh = box(1.625, 2.375, 0.6875, low);
    WrProjection p = { .unit = WR_UNIT_IN,
                       .cell = { 3.25, 7.5 },
                       .turn_deg = { 33.75, -71.5, 128.25 },
                       .placed = true,
                       .at = { 0.25, -0.5, 1 },
                       .crease_deg = 40 };
    for (p.kind = WR_PROJECTION_UV; p.kind < WR_PROJECTIONS; p.kind++) {
        WrTriangles *t = project(mesh, &p);
        if (t->key != keys[p.kind]) fail_msg("%d: 0x%016llx", p.kind, (unsigned long long)t->key);
        wr_triangles_free(t);
    }
    wr_triangles_free(mesh);
}

/* ---- limits ---- */

static void too_much_is_refused(void **state)
{
    (void)state;
    const double low[3] = { 0, 0, 0 };
    WrTriangles *mesh = box(1, 1, 1, low);
    WrError err = { "" };
    WrProjection p = wr_projection_default;
    p.kind = WR_PROJECTION_BOX;
    p.cell[1] = 1e-6;
    assert_null(wr_triangles_project(mesh, &p, NULL, &err));
    assert_non_null(
        strstr(err.text, "cell=10,1e-06 mm: the mesh extends over more than 65536 cells"));
    p.cell[1] = 10;
    p.unit = WR_UNIT_M; /* 100 cells a side */
    WrTriangles *t = project(mesh, &p);
    assert_near((double)fabsf(corner(t, 0, 0)->u), 50, 1e-3);
    wr_triangles_free(t);
    wr_triangles_free(mesh);
}

static void lengths_have_units(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double mm; /* below 0: none */
    } rows[] = { { "10mm", 10 },   { "2.5cm", 25 },  { "0.5m", 500 }, { "1in", 25.4 },
                 { "2ft", 609.6 }, { "5um", 0.005 }, { "7", 7 },      { "mm", -1 },
                 { "10 mm", -1 },  { "10km", -1 },   { "1e-1cm", 1 }, { "", -1 },
                 { "1mmm", -1 },   { "1mm2", -1 },   { "m", -1 } };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double mm = -1;
        const bool good = wr_length_parse(rows[i].text, strlen(rows[i].text), &mm);
        if (good != (rows[i].mm >= 0)) fail_msg("%s", rows[i].text);
        if (good) assert_near(mm, rows[i].mm, 1e-12 * rows[i].mm);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_are_the_formulas),
        cmocka_unit_test(round_ones_are_the_formulas),
        cmocka_unit_test(letters_read_from_outside),
        cmocka_unit_test(relief_runs_on_across_the_seam),
        cmocka_unit_test(an_axis_beside_the_mesh),
        cmocka_unit_test(a_box_has_seams_at_its_edges),
        cmocka_unit_test(ties_are_broken_alike),
        cmocka_unit_test(creases_part_normals),
        cmocka_unit_test(results_are_the_same_everywhere),
        cmocka_unit_test(too_much_is_refused),
        cmocka_unit_test(lengths_have_units),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

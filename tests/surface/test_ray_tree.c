/* The tree of triangles: hits against every triangle tested alone in extended precision, rays through corners and
   edges of closed bodies, ties, triangles without area, sizes near the ends of floats, distances. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "surface/ray_tree.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

static WrTriangles *mesh_of(const float (*points)[3], int count, const int32_t (*corners)[3],
                            int triangles)
{
    WrError err = { "" };
    const WrTrianglesSource source = {
        .points = points, .corners = corners, .point_count = count, .triangle_count = triangles
    };
    WrTriangles *mesh = wr_triangles_new(&source, &err);
    if (!mesh) fail_msg("%s", err.text);
    return mesh;
}

static WrRayTree *tree_of(const WrTriangles *mesh)
{
    WrError err = { "" };
    WrRayTree *tree = wr_ray_tree_new(mesh, 0, mesh->triangle_count, &err);
    if (!tree) fail_msg("%s", err.text);
    return tree;
}

static double symmetric(TestRandom *random)
{
    return 2 * test_random(random) - 1;
}

/* Loose triangles of random places, sizes and shapes, every seventh of them with its corners on a line. */
static WrTriangles *loose(int count, double scale, double edge, TestRandom *random)
{
    float(*points)[3] = wr_alloc(3 * (size_t)count, sizeof *points);
    int32_t(*corners)[3] = wr_alloc((size_t)count, sizeof *corners);
    for (int i = 0; i < count; i++) {
        const double size = edge * (i % 5 == 0 ? 1 : test_random(random));
        double at[3], e[3];
        for (int k = 0; k < 3; k++) at[k] = symmetric(random), e[k] = size * symmetric(random);
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++) {
                const double off = i % 7 == 0 ? c * e[k] : size * symmetric(random);
                points[3 * i + c][k] = (float)(scale * (at[k] + off));
            }
        for (int c = 0; c < 3; c++) corners[i][c] = 3 * i + c;
    }
    WrTriangles *mesh =
        mesh_of((const float(*)[3])points, 3 * count, (const int32_t(*)[3])corners, count);
    wr_free(points);
    wr_free(corners);
    return mesh;
}

typedef long double Long;

/* Moeller and Trumbore's test. *margin: how far inside the triangle the hit is, as a share of it. */
static bool meets(const WrTriangles *mesh, int i, const double o[3], const double d[3], bool front,
                  Long *t, Long *margin)
{
    Long a[3], e[3], f[3], p[3], q[3], w[3];
    for (int k = 0; k < 3; k++) {
        const int32_t *corner = mesh->triangles[i].corner;
        a[k] = mesh->corners[corner[0]].p[k];
        e[k] = mesh->corners[corner[1]].p[k] - a[k], f[k] = mesh->corners[corner[2]].p[k] - a[k];
        w[k] = o[k] - a[k];
    }
    for (int k = 0; k < 3; k++) {
        const int x = (k + 1) % 3, y = (k + 2) % 3;
        p[k] = d[x] * f[y] - d[y] * f[x], q[k] = w[x] * e[y] - w[y] * e[x];
    }
    const Long det = e[0] * p[0] + e[1] * p[1] + e[2] * p[2];
    if (det == 0 || (front && det < 0)) return false;
    const Long x = (w[0] * p[0] + w[1] * p[1] + w[2] * p[2]) / det;
    const Long y = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
    *t = (f[0] * q[0] + f[1] * q[1] + f[2] * q[2]) / det;
    *margin = fminl(fminl(x, y), 1 - x - y);
    return *t > 0;
}

typedef struct Expected {
    int triangle;
    Long t, next;  /* of the second hit */
    bool doubtful; /* some triangle is met, or missed, by less than rounding */
} Expected;

static Expected brute(const WrTriangles *mesh, const double o[3], const double d[3], bool front)
{
    Expected best = { -1, INFINITY, INFINITY, false };
    for (int i = 0; i < mesh->triangle_count; i++) {
        Long t, margin;
        if (!meets(mesh, i, o, d, front, &t, &margin)) continue;
        if (fabsl(margin) < 1e-7L) best.doubtful = true;
        if (margin < 0) continue;
        if (t < best.t) best.next = best.t, best.t = t, best.triangle = i;
        else if (t < best.next) best.next = t;
    }
    return best;
}

static void compare_rays(double scale, double edge, uint64_t seed)
{
    TestRandom random = { seed };
    WrTriangles *mesh = loose(900, scale, edge, &random);
    WrRayTree *tree = tree_of(mesh);
    int hits = 0, checked = 0;
    for (int i = 0; i < 1600; i++) {
        double o[3], d[3];
        const int32_t *aim = mesh->triangles[i % mesh->triangle_count].corner;
        for (int k = 0; k < 3; k++) {
            o[k] = scale * 1.5 * symmetric(&random);
            d[k] = i % 3 == k && i % 4 == 0 ? 0 : symmetric(&random);
            if (i % 3 != 0) continue;
            double middle = 0;
            for (int c = 0; c < 3; c++) middle += (double)mesh->corners[aim[c]].p[k] / 3;
            d[k] = (middle - o[k]) / scale + 0.01 * edge * d[k];
        }
        const bool front = i % 2 == 1;
        const WrVec3 from = { o[0], o[1], o[2] }, along = { d[0], d[1], d[2] };
        const Expected want = brute(mesh, o, d, front);
        if (want.doubtful || want.next - want.t < 1e-9L * want.t) continue;
        WrRayHit hit;
        const bool met = wr_ray_tree_closest(tree, from, along, INFINITY, front, &hit);
        checked++, hits += met;
        assert_int_equal(met, want.triangle >= 0);
        if (!front) assert_int_equal(wr_ray_tree_any(tree, from, along, INFINITY), met);
        if (!met) continue;
        assert_int_equal(hit.triangle, want.triangle);
        assert_near(hit.t, (double)want.t, 1e-9 * (double)want.t);
        assert_near(hit.share[0] + hit.share[1] + hit.share[2], 1, 1e-12);
        assert_false(wr_ray_tree_closest(tree, from, along, hit.t * (1 - 1e-9), front, &hit));
    }
    if (checked < 1400 || hits < 100) fail_msg("%d rays compared, %d hits", checked, hits);
    wr_ray_tree_free(tree);
    wr_triangles_free(mesh);
}

static void hits_are_those_of_all_triangles_tested_alone(void **state)
{
    (void)state;
    compare_rays(1, 0.3, 1);
    compare_rays(1, 0.05, 2);
    compare_rays(1e-30, 0.3, 3);
    compare_rays(1e28, 0.3, 4);
}

/* A closed body of (2 n) x n cells about the origin, radius 0.4..1, random. */
static WrTriangles *body(int n, double scale, TestRandom *random)
{
    const int around = 2 * n;
    float(*points)[3] = wr_alloc((size_t)(around * n + 2), sizeof *points);
    int32_t(*corners)[3] = wr_alloc((size_t)(2 * around * n), sizeof *corners);
    int count = 0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < around; i++) {
            const double a = 2 * M_PI * i / around, b = M_PI * (j + 1) / (n + 1);
            const double r = scale * (1 - 0.6 * test_random(random));
            float *p = points[j * around + i];
            p[0] = (float)(r * cos(a) * sin(b)), p[1] = (float)(r * sin(a) * sin(b));
            p[2] = (float)(r * cos(b));
        }
    points[around * n][2] = (float)scale, points[around * n + 1][2] = (float)-scale;
    for (int i = 0; i < around; i++) {
        const int next = (i + 1) % around;
        const int32_t top[3] = { around * n, i, next };
        const int32_t low[3] = { around * n + 1, around * (n - 1) + next, around * (n - 1) + i };
        memcpy(corners[count++], top, sizeof top);
        memcpy(corners[count++], low, sizeof low);
        for (int j = 0; j + 1 < n; j++) {
            const int a = j * around + i, b = j * around + next;
            const int32_t one[3] = { a, a + around, b }, two[3] = { b, a + around, b + around };
            memcpy(corners[count++], one, sizeof one);
            memcpy(corners[count++], two, sizeof two);
        }
    }
    WrTriangles *mesh =
        mesh_of((const float(*)[3])points, around * n + 2, (const int32_t(*)[3])corners, count);
    assert_true(mesh->closed);
    wr_free(points);
    wr_free(corners);
    return mesh;
}

static void no_ray_leaves_a_closed_body_through_its_edges_or_corners(void **state)
{
    (void)state;
    for (int round = 0; round < 4; round++) {
        TestRandom random = { (uint64_t)round + 7 };
        const double scale = round == 2 ? 1e-25 : round == 3 ? 1e25 : 1;
        WrTriangles *mesh = body(23, scale, &random);
        WrRayTree *tree = tree_of(mesh);
        for (int i = 0; i < 3 * mesh->triangle_count; i++) {
            const int32_t *corner = mesh->triangles[i / 3].corner;
            const float *a = mesh->corners[corner[i % 3]].p,
                        *b = mesh->corners[corner[(i + 1) % 3]].p;
            const double s = round == 0 ? 0 : round == 1 ? 0.5 : test_random(&random);
            const WrVec3 o = { 0.1 * scale * symmetric(&random), 0.1 * scale * symmetric(&random),
                               i % 4 ? 0 : 0.1 * scale * symmetric(&random) };
            const WrVec3 to = { (1 - s) * (double)a[0] + s * (double)b[0],
                                (1 - s) * (double)a[1] + s * (double)b[1],
                                (1 - s) * (double)a[2] + s * (double)b[2] };
            const WrVec3 d = v3_sub(to, i % 2 ? o : (WrVec3){ 0, 0, 0 });
            WrRayHit hit;
            const WrVec3 from = i % 2 ? o : (WrVec3){ 0, 0, 0 };
            assert_true(wr_ray_tree_closest(tree, from, d, INFINITY, false, &hit));
            assert_true(hit.t > 0 && (i % 2 || hit.t < 1 + 1e-9));
            /* As seen from the origin every triangle shows its back. */
            if (i % 2 == 0) assert_false(wr_ray_tree_closest(tree, from, d, INFINITY, true, &hit));
            assert_true(wr_ray_tree_any(tree, from, d, INFINITY));
            /* From outside the front is met, and first. */
            const WrVec3 outside = v3_scale(to, 3), back = v3_scale(to, -1);
            assert_true(wr_ray_tree_closest(tree, outside, back, 2.5, true, &hit));
        }
        wr_ray_tree_free(tree);
        wr_triangles_free(mesh);
    }
}

static void of_equal_distances_the_first_triangle_is_hit(void **state)
{
    (void)state;
    float points[4 * 12][3];
    int32_t corners[24][3];
    /* Twelve equal squares in one plane: the hit is triangle 0 or 1, whatever leaf they are in. */
    for (int i = 0; i < 12; i++)
        for (int k = 0; k < 4; k++) {
            points[4 * i + k][0] = k == 1 || k == 2, points[4 * i + k][1] = k >= 2;
            points[4 * i + k][2] = 0.5f;
        }
    for (int i = 0; i < 12; i++) {
        const int32_t one[3] = { 4 * i, 4 * i + 1, 4 * i + 2 },
                      two[3] = { 4 * i, 4 * i + 2, 4 * i + 3 };
        memcpy(corners[2 * i], one, sizeof one);
        memcpy(corners[2 * i + 1], two, sizeof two);
    }
    WrTriangles *mesh = mesh_of((const float(*)[3])points, 48, (const int32_t(*)[3])corners, 24);
    WrRayTree *tree = tree_of(mesh);
    TestRandom random = { 5 };
    for (int i = 0; i < 200; i++) {
        const WrVec3 o = { test_random(&random), test_random(&random), 2 }, d = { 0, 0, -1 };
        const double from[3] = { o.x, o.y, o.z }, along[3] = { 0, 0, -1 };
        const Expected want = brute(mesh, from, along, false); /* keeps the first of equals */
        WrRayHit hit;
        assert_true(wr_ray_tree_closest(tree, o, d, INFINITY, false, &hit));
        assert_int_equal(hit.triangle, want.triangle);
        assert_near(hit.t, 1.5, 1e-15);
    }
    wr_ray_tree_free(tree);
    wr_triangles_free(mesh);
}

static void distance_is_that_of_the_nearest_point(void **state)
{
    (void)state;
    enum { GRID = 60 };
    TestRandom random = { 11 };
    WrTriangles *mesh = loose(60, 1, 0.4, &random);
    WrRayTree *tree = tree_of(mesh);
    for (int i = 0; i < 60; i++) {
        const WrVec3 p = { 2 * symmetric(&random), 2 * symmetric(&random), 2 * symmetric(&random) };
        const double found = wr_ray_tree_distance(tree, p, INFINITY);
        double least = INFINITY;
        for (int t = 0; t < mesh->triangle_count; t++)
            for (int a = 0; a <= GRID; a++)
                for (int b = 0; a + b <= GRID; b++) {
                    const double l[3] = { (double)a / GRID, (double)b / GRID,
                                          (double)(GRID - a - b) / GRID };
                    double sum = 0;
                    for (int k = 0; k < 3; k++) {
                        double x = k == 0 ? -p.x : k == 1 ? -p.y : -p.z;
                        for (int c = 0; c < 3; c++)
                            x += l[c] * (double)mesh->corners[mesh->triangles[t].corner[c]].p[k];
                        sum += x * x;
                    }
                    least = fmin(least, sqrt(sum));
                }
        assert_true(found <= least + 1e-12 && found > least - 0.8 / GRID);
        assert_near(wr_ray_tree_distance(tree, p, found / 2), found / 2, 1e-12);
    }
    wr_ray_tree_free(tree);
    wr_triangles_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_are_those_of_all_triangles_tested_alone),
        cmocka_unit_test(no_ray_leaves_a_closed_body_through_its_edges_or_corners),
        cmocka_unit_test(of_equal_distances_the_first_triangle_is_hit),
        cmocka_unit_test(distance_is_that_of_the_nearest_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

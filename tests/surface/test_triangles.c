/* Meshes as surfaces: conversion of a file's arrays, without loss on the way to a document. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "surface/mesh_faults.h"
#include "surface/triangles.h"

#include <math.h>
#include <string.h>

static const float cube_points[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
                                         { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
static const int32_t cube_corners[12][3] = {
    { 0, 2, 1 }, { 0, 3, 2 }, { 4, 5, 6 }, { 4, 6, 7 }, { 0, 1, 5 }, { 0, 5, 4 },
    { 1, 2, 6 }, { 1, 6, 5 }, { 2, 3, 7 }, { 2, 7, 6 }, { 3, 0, 4 }, { 3, 4, 7 },
};

static WrTrianglesSource cube_source(void)
{
    return (WrTrianglesSource){
        .points = cube_points, .corners = cube_corners, .point_count = 8, .triangle_count = 12
    };
}

static WrTriangles *make(const WrTrianglesSource *source)
{
    WrError err = { "" };
    WrTriangles *made = wr_triangles_new(source, &err);
    if (!made) fail_msg("%s", err.text);
    return made;
}

static WrVec3 wide(const float a[3])
{
    return (WrVec3){ (double)a[0], (double)a[1], (double)a[2] };
}

static double volume(const WrTriangles *t)
{
    double sum = 0;
    for (int32_t i = 0; i < t->triangle_count; i++) {
        const int32_t *c = t->triangles[i].corner;
        sum += v3_dot(wide(t->corners[c[0]].p),
                      v3_cross(wide(t->corners[c[1]].p), wide(t->corners[c[2]].p))) /
               6;
    }
    return sum;
}

static void a_cube_is_a_body(void **state)
{
    (void)state;
    const WrTrianglesSource source = cube_source();
    WrTriangles *t = make(&source);
    assert_true(t->closed);
    assert_false(t->report.inside_out);
    assert_int_equal(t->triangle_count, 12);
    assert_int_equal(t->corner_count, 8);
    assert_near(volume(t), 1, 1e-12);
    assert_near(t->centre[1], 0.5, 0);
    assert_near(t->radius, sqrt(0.75), 1e-9);
    /* weighted by angles each face contributes a right angle at a corner, for any division: the normals are the
       diagonals */
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++) {
            const double away = t->corners[i].p[k] > 0 ? 1 : -1;
            assert_near((double)t->corners[i].n[k], away * sqrt(1.0 / 3), 1e-6);
        }
    wr_triangles_free(t);
}

/* An inside-out mesh is reversed; one with a hole is an open surface. */
static void bodies_are_told(void **state)
{
    (void)state;
    int32_t turned[12][3];
    for (int i = 0; i < 12; i++) {
        turned[i][0] = cube_corners[i][0];
        turned[i][1] = cube_corners[i][2];
        turned[i][2] = cube_corners[i][1];
    }
    WrTrianglesSource source = cube_source();
    source.corners = (const int32_t(*)[3])turned;
    WrTriangles *t = make(&source);
    assert_true(t->closed && t->report.inside_out);
    assert_near(volume(t), 1, 1e-12);
    assert_true(t->corners[0].n[0] * (t->corners[0].p[0] - 0.5f) > 0);
    wr_triangles_free(t);
    source = cube_source();
    source.triangle_count = 11;
    t = make(&source);
    assert_false(t->closed);
    wr_triangles_free(t);
    memcpy(turned, cube_corners, sizeof turned); /* one reversed */
    turned[3][1] = cube_corners[3][2], turned[3][2] = cube_corners[3][1];
    source = cube_source();
    source.corners = (const int32_t(*)[3])turned;
    t = make(&source);
    assert_false(t->closed);
    wr_triangles_free(t);
}

/* Two tips over a ring of many triangles: their edges are found from the other end. Each defect is detected. */
static void hubs_are_bodies_too(void **state)
{
    (void)state;
    enum { RING = 4000 };
    float(*points)[3] = wr_alloc(RING + 2, sizeof *points);
    int32_t(*corners)[3] = wr_alloc(2 * RING + 1, sizeof *corners);
    for (int i = 0; i < RING; i++) {
        points[i][0] = (float)cos(2 * acos(-1.0) * i / RING),
        points[i][1] = (float)sin(2 * acos(-1.0) * i / RING);
        const int32_t up[3] = { i, (i + 1) % RING, RING },
                      down[3] = { (i + 1) % RING, i, RING + 1 };
        memcpy(corners[2 * i], up, sizeof up);
        memcpy(corners[2 * i + 1], down, sizeof down);
    }
    points[RING][2] = 1, points[RING + 1][2] = -1;
    WrTrianglesSource source = { .points = (const float(*)[3])points,
                                 .corners = (const int32_t(*)[3])corners,
                                 .point_count = RING + 2,
                                 .triangle_count = 2 * RING };
    WrTriangles *t = make(&source);
    assert_true(t->closed);
    wr_triangles_free(t);
    memcpy(corners[2 * RING], corners[77], sizeof corners[0]); /* a duplicate */
    source.triangle_count++;
    t = make(&source);
    assert_false(t->closed);
    wr_triangles_free(t);
    source.triangle_count -= 2; /* a hole */
    t = make(&source);
    assert_false(t->closed);
    wr_triangles_free(t);
    wr_free(points);
    wr_free(corners);
}

/* A box of 3 x 2 x 1 squares' corners as a body, made faulty: counts and places follow from the faces that are left out,
   added or turned. Places may be those of any fault of the kind: the first in the mesh's order. */
static void faults_are_counted(void **state)
{
    (void)state;
    static const double origin[3] = { 10, 20, 30 }, none[3] = { 0, 0, 0 };
    WrMeshFaults f;
    WrError err = { "" };
    float points[9][3];
    int32_t corners[24][3];
    WrTrianglesSource source = cube_source();
    memcpy(points, source.points, 8 * sizeof *points);
    memcpy(corners, cube_corners, sizeof cube_corners);
    points[8][0] = 5, points[8][1] = 6, points[8][2] = 7;
    source.points = (const float(*)[3])points, source.point_count = 9;
    source.corners = (const int32_t(*)[3])corners;
    for (int k = 0; k < 10; k++) {
        const int32_t *face = corners[3];
        /* open, crowded, turned, doubled, without area */
        static const int32_t counts[10][WR_MESH_FAULTS] = {
            { 0, 0, 0, 0, 0 }, { 3, 0, 0, 0, 0 },  { 0, 0, 3, 0, 0 }, { 0, 0, 0, 1, 0 },
            { 2, 1, 0, 0, 0 }, { 0, 0, 0, 0, 2 },  { 0, 0, 0, 1, 0 }, { 0, 0, 3, 1, 0 },
            { 0, 0, 0, 2, 0 }, { 0, 0, 0, 12, 0 },
        };
        memcpy(corners, cube_corners, sizeof cube_corners);
        source.triangle_count = 12;
        const int32_t a = face[0], b = face[1], c = face[2];
        const int32_t turned[3] = { b, a, c }, again[3] = { c, b, a }, fin[3] = { a, b, 8 };
        const int32_t flat[2][3] = { { a, b, b }, { c, c, c } };
        if (k == 1) memcpy(corners[3], corners[11], sizeof *corners), source.triangle_count--;
        if (k == 2) memcpy(corners[3], turned, sizeof turned);
        if (k == 3) memcpy(corners[source.triangle_count++], again, sizeof again);
        if (k == 4) memcpy(corners[source.triangle_count++], fin, sizeof fin);
        if (k == 5) memcpy(corners[12], flat, sizeof flat), source.triangle_count += 2;
        if (k == 6) memcpy(corners[source.triangle_count++], corners[3], sizeof turned);
        if (k == 7 || k == 8) /* the turned face twice, and the right one behind them */
            for (int i = 0; i < 2; i++) memcpy(corners[i ? 12 : 3], turned, sizeof turned);
        if (k == 8) memcpy(corners[13], cube_corners[3], sizeof turned);
        if (k == 7 || k == 8) source.triangle_count = k + 6;
        if (k == 9) memcpy(corners[12], cube_corners, sizeof cube_corners);
        if (k == 9) source.triangle_count = 24;
        WrTriangles *t = make(&source);
        if (!wr_mesh_faults_find(t, k == 1 ? origin : none, &f, &err)) fail_msg("%s", err.text);
        assert_string_equal(wr_mesh_faults_body(&f, t), k == 0 || k == 5   ? "closed"
                                                        : k == 1 || k == 4 ? "open"
                                                                           : "no closed body");
        for (int i = 0; i < WR_MESH_FAULTS; i++) {
            if (f.count[i] != counts[k][i])
                fail_msg("case %d: %d %s", k, (int)f.count[i], wr_mesh_fault_rows[i].label);
            assert_int_equal(f.placed[i], f.count[i] > 0);
        }
        WrVec3 p[4];
        for (int i = 0; i < 4; i++) {
            const float *at = points[i < 3 ? cube_corners[3][i] : 8];
            p[i] = (WrVec3){ (double)at[0], (double)at[1], (double)at[2] };
        }
        if (k == 1) { /* the middle of a side of the missing face */
            const WrVec3 at = { f.at[0].x - 10, f.at[0].y - 20, f.at[0].z - 30 };
            double nearest = INFINITY;
            for (int i = 0; i < 3; i++)
                nearest =
                    fmin(nearest, v3_len(v3_sub(at, v3_scale(v3_add(p[i], p[(i + 1) % 3]), 0.5))));
            assert_near(nearest, 0, 1e-6);
        }
        if (k == 3) {
            const WrVec3 middle = v3_scale(v3_add(v3_add(p[0], p[1]), p[2]), 1 / 3.0);
            assert_near(v3_len(v3_sub(f.at[WR_MESH_FAULT_DOUBLED], middle)), 0, 1e-6);
        }
        if (k == 4)
            assert_near(
                v3_len(v3_sub(f.at[WR_MESH_FAULT_CROWDED], v3_scale(v3_add(p[0], p[1]), 0.5))), 0,
                1e-6);
        wr_triangles_free(t);
    }
}

/* HC136: a normal that is 0 or NaN is replaced by that of the adjacent faces, and counted. */
static void bad_normals_are_mended(void **state)
{
    (void)state;
    const float points[6][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 },
                                 { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 } };
    const float normals[6][3] = { { 0, 0, 2 },  { NAN, 0, 0 }, { 0, 0, 0 },
                                  { 0, 0, -1 }, { 0, 0, -1 },  { 0, 0, -1 } };
    const int32_t corners[2][3] = { { 0, 1, 2 }, { 3, 4, 5 } };
    WrTrianglesSource source = { .points = points,
                                 .normals = normals,
                                 .corners = corners,
                                 .point_count = 6,
                                 .triangle_count = 2 };
    WrTriangles *t = make(&source);
    assert_int_equal(t->report.bad_normal, 2);
    /* the adjacent faces are opposite and add up to 0: each corner uses its face's normal */
    assert_int_equal(t->report.face_normal, 2);
    for (int i = 0; i < t->corner_count; i++) assert_near(fabs((double)t->corners[i].n[2]), 1, 0);
    wr_triangles_free(t);
    source.triangle_count = 1;
    t = make(&source);
    assert_int_equal(t->report.face_normal, 0);
    assert_near((double)t->corners[1].n[2], 1, 0);
    wr_triangles_free(t);
}

static void empty_triangles_are_left_out(void **state)
{
    (void)state;
    const float points[5][3] = {
        { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 2, 0, 0 }, { -0.0f, 0, 0 }
    };
    const int32_t corners[4][3] = { { 0, 1, 2 }, { 0, 1, 3 }, { 0, 4, 2 }, { 1, 1, 2 } };
    WrTrianglesSource source = {
        .points = points, .corners = corners, .point_count = 5, .triangle_count = 4
    };
    WrTriangles *t = make(&source);
    assert_int_equal(t->triangle_count, 1);
    assert_int_equal(t->report.no_area, 3);
    assert_int_equal(t->report.no_map, 1);
    assert_false(t->mapped);
    wr_triangles_free(t);
    WrError err = { "" };
    source.corners = corners + 1;
    source.triangle_count = 3;
    assert_null(wr_triangles_new(&source, &err));
    assert_non_null(strstr(err.text, "no triangle has an area"));
}

/* Each triangle starts at the corner between its two shortest edges, with unchanged winding. */
static void the_longest_edge_is_opposite(void **state)
{
    (void)state;
    TestRandom random = { 3 };
    for (int round = 0; round < 200; round++) {
        float points[3][3];
        const int32_t corners[1][3] = { { 0, 1, 2 } };
        for (int i = 0; i < 9; i++) points[i / 3][i % 3] = (float)test_random(&random);
        const WrTrianglesSource source = { .points = (const float(*)[3])points,
                                           .corners = corners,
                                           .point_count = 3,
                                           .triangle_count = 1 };
        WrTriangles *t = make(&source);
        WrVec3 p[3];
        for (int k = 0; k < 3; k++) p[k] = wide(t->corners[t->triangles[0].corner[k]].p);
        const double opposite = v3_len(v3_sub(p[2], p[1]));
        assert_true(opposite >= v3_len(v3_sub(p[1], p[0])) &&
                    opposite >= v3_len(v3_sub(p[2], p[0])));
        const WrVec3 before = v3_cross(v3_sub(wide(points[1]), wide(points[0])),
                                       v3_sub(wide(points[2]), wide(points[0])));
        assert_true(v3_dot(before, v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]))) > 0);
        wr_triangles_free(t);
    }
}

/* A strip of `count` squares along x with (u,v), in parts of two. */
static WrTriangles *strip(int count, double repeat)
{
    float(*points)[3] = wr_alloc(4 * (size_t)count, sizeof *points);
    float(*uv)[2] = wr_alloc(4 * (size_t)count, sizeof *uv);
    int32_t(*corners)[3] = wr_alloc(2 * (size_t)count, sizeof *corners);
    WrTrianglePart *parts = wr_alloc((size_t)count, sizeof *parts);
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 4; k++) {
            const float x = (float)(i + (k == 1 || k == 2)), y = k >= 2;
            float *p = points[4 * i + k];
            p[0] = x, p[1] = y, p[2] = 0;
            uv[4 * i + k][0] = (float)(repeat * (double)x / count);
            uv[4 * i + k][1] = y;
        }
        const int32_t a = 4 * i, both[2][3] = { { a, a + 1, a + 2 }, { a, a + 2, a + 3 } };
        memcpy(corners[2 * i], both, sizeof both);
        parts[i] = (WrTrianglePart){ .first = 2 * i, .count = 2 };
        parts[i].name[0] = (char)('a' + i % 26);
    }
    const WrTrianglesSource source = { .points = (const float(*)[3])points,
                                       .uv = (const float(*)[2])uv,
                                       .corners = (const int32_t(*)[3])corners,
                                       .point_count = 4 * count,
                                       .triangle_count = 2 * count,
                                       .parts = parts,
                                       .part_count = count };
    WrTriangles *made = make(&source);
    wr_free(parts);
    wr_free(corners);
    wr_free(uv);
    wr_free(points);
    return made;
}

static void parts_keep_their_triangles(void **state)
{
    (void)state;
    WrTriangles *t = strip(20, 1);
    assert_int_equal(t->part_count, 20);
    assert_int_equal(t->corner_count, 42); /* shared ones are merged */
    for (int32_t i = 0, part = 0; i < t->triangle_count; i++) {
        if (part + 1 < t->part_count && t->parts[part + 1].first == i) part++;
        const float x = t->corners[t->triangles[i].corner[0]].p[0];
        assert_true(x >= (float)part && x <= (float)part + 1);
        assert_int_equal(t->parts[part].name[0], 'a' + part);
        assert_true(t->parts[part].mapped);
    }
    wr_triangles_free(t);
}

static void documents_bring_it_back(void **state)
{
    (void)state;
    WrTriangles *t = strip(30, 1);
    size_t count;
    float *block = wr_triangles_serialize(t, &count);
    for (size_t i = 0; i < count; i++) assert_true(isfinite(block[i]));
    WrError err = { "" };
    WrTriangles *back = wr_triangles_deserialize(block, count, &err);
    if (!back) fail_msg("%s", err.text);
    assert_true(back->key == t->key && back->closed == t->closed && back->mapped && back->faceted);
    assert_memory_equal(back->corners, t->corners, (size_t)t->corner_count * sizeof *t->corners);
    assert_memory_equal(back->triangles, t->triangles,
                        (size_t)t->triangle_count * sizeof *t->triangles);
    assert_memory_equal(back->parts, t->parts, (size_t)t->part_count * sizeof *t->parts);
    assert_memory_equal(&back->report, &t->report, sizeof t->report);
    assert_memory_equal(back->centre, t->centre, sizeof t->centre);
    assert_near(back->radius, t->radius, 0);
    wr_triangles_free(back);
    /* random corruption */
    TestRandom random = { 9 };
    for (int i = 0; i < 3000; i++) {
        const size_t at = (size_t)(test_random(&random) * (double)count);
        const float kept = block[at], wild[] = { NAN, -1, 0.5f, 1e9f, INFINITY, 3e38f };
        block[at] = wild[i % 6];
        back = wr_triangles_deserialize(block, i % 7 == 0 ? at : count, &err);
        if (back) wr_triangles_free(back);
        block[at] = kept;
    }
    wr_free(block);
    wr_triangles_free(t);
}

/* Where (u,v) are used twice, painting appears twice. */
static void overlaps_are_told(void **state)
{
    (void)state;
    WrTriangles *once = strip(8, 1), *twice = strip(8, 2), *half = strip(8, 1.5);
    assert_near(wr_triangles_overlap(once, 64).share, 0, 0);
    assert_int_equal(wr_triangles_overlap(once, 64).outside, 0);
    assert_near(wr_triangles_overlap(twice, 64).share, 1, 0);
    assert_true(wr_triangles_overlap(twice, 64).outside >= 8);
    const WrUvOverlap part = wr_triangles_overlap(half, 64);
    assert_near(part.share, 0.5, 1e-9);
    assert_near(part.at[0], 0.5 / 64, 1e-12); /* u of 1 .. 1.5 is that of 0 .. 0.5 */
    assert_near(part.at[1], 0.5 / 64, 1e-12);
    wr_triangles_free(once);
    wr_triangles_free(twice);
    wr_triangles_free(half);
}

static void nonsense_is_refused(void **state)
{
    (void)state;
    WrError err = { "" };
    WrTrianglesSource source = cube_source();
    int32_t corners[12][3];
    memcpy(corners, cube_corners, sizeof corners);
    corners[5][1] = 8;
    source.corners = (const int32_t(*)[3])corners;
    assert_null(wr_triangles_new(&source, &err));
    assert_non_null(strstr(err.text, "refers to point 8 of 8"));
    source = cube_source();
    source.triangle_count = 0;
    assert_null(wr_triangles_new(&source, &err));
    float points[8][3];
    memcpy(points, cube_points, sizeof points);
    points[4][2] = INFINITY;
    source = cube_source();
    source.points = (const float(*)[3])points;
    assert_null(wr_triangles_new(&source, &err));
    assert_non_null(strstr(err.text, "point 5"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_is_a_body),
        cmocka_unit_test(bodies_are_told),
        cmocka_unit_test(hubs_are_bodies_too),
        cmocka_unit_test(faults_are_counted),
        cmocka_unit_test(bad_normals_are_mended),
        cmocka_unit_test(empty_triangles_are_left_out),
        cmocka_unit_test(the_longest_edge_is_opposite),
        cmocka_unit_test(parts_keep_their_triangles),
        cmocka_unit_test(documents_bring_it_back),
        cmocka_unit_test(overlaps_are_told),
        cmocka_unit_test(nonsense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Tangent frames: the lecture's solution and the rules of MikkTSpace, against values computed by hand; degenerate,
   mirrored, folded and branching meshes (HC126 to HC133, HC136). */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "surface/tangent_frames.h"

#include <math.h>
#include <string.h>

/* A mesh in written form. */
typedef struct Hand {
    WrTriangleCorner corner[8];
    WrTriangle triangle[4];
    int32_t count;
} Hand;

typedef struct Want {
    int triangle, corner;
    double t[3], sign;
} Want;

static WrVec3 unit3(double x, double y, double z)
{
    return v3_unit((WrVec3){ x, y, z }, (WrVec3){ 0, 0, 0 });
}

static const Hand mesh_a = { { { { 0, 0, 0 }, { 0, 0, 1 }, 0.5f, 0 },
                               { { 1, 0, 0 }, { 0, 0, 1 }, 1, 0.5f },
                               { { 0, 1, 0 }, { 0, 0, 1 }, 0, 1 } },
                             { { { 0, 1, 2 } } },
                             1 };
static const Hand mesh_b = { { { { 0, 0, 0 }, { 0, 0, 1 }, 0, 0 },
                               { { 1, 0, 0 }, { 0, 0, 1 }, 1, 0 },
                               { { 1, 1, 0 }, { 0, 0, 1 }, 1, 1 },
                               { { 0, 1, 0 }, { 0, 0, 1 }, 0, 0.5f } },
                             { { { 0, 1, 2 } }, { { 0, 2, 3 } } },
                             2 };
static const Hand mesh_c = { { { { -1, 0, 0 }, { 0, 0, 1 }, 1, 0 },
                               { { 0, 0, 0 }, { 0, 0, 1 }, 0, 0 },
                               { { 0, 1, 0 }, { 0, 0, 1 }, 0, 1 },
                               { { 1, 0, 0 }, { 0, 0, 1 }, 1, 0 } },
                             { { { 0, 1, 2 } }, { { 1, 3, 2 } } },
                             2 };
static const Hand mesh_e = { { { { 0, 0, 0 }, { 0, 0, 1 }, 0, 0 },
                               { { 2, 0, 0 }, { 0, 0, 1 }, 1, 0 },
                               { { 2, 1, 0 }, { 0, 0, 1 }, 1, 1 },
                               { { 0, 1, 0 }, { 0, 0, 1 }, 0.25f, 0.75f },
                               { { 3, 0, 0 }, { 0, 0, 1 }, 1, 0.5f } },
                             { { { 0, 1, 2 } }, { { 0, 2, 3 } }, { { 1, 4, 2 } } },
                             3 };

static Hand mesh_d(void)
{
    Hand d = { { { { 0, 0, 0 }, { 0 }, 0, 0 },
                 { { 1, 0, 0 }, { 0, 0, 1 }, 1, 0 },
                 { { 0, 1, 0 }, { 0 }, 0.25f, 1 },
                 { { -1, 0, -1 }, { 0 }, -1, 0.25f } },
               { { { 0, 1, 2 } }, { { 0, 2, 3 } } },
               2 };
    const WrVec3 n[4] = { unit3(-1, 0, 2), { 0, 0, 1 }, unit3(-1, 0, 2), unit3(-1, 0, 1) };
    for (int i = 0; i < 4; i++) {
        d.corner[i].n[0] = (float)n[i].x;
        d.corner[i].n[1] = (float)n[i].y;
        d.corner[i].n[2] = (float)n[i].z;
    }
    return d;
}

static void expect_near(double got, double want, double most, const char *what, int i, int k)
{
    if (!(fabs(got - want) <= most))
        fail_msg("%s of %d.%d is %.9f, not %.9f", what, i, k, got, want);
}

static void expect_mikk(const Hand *hand, const Want *want, int count)
{
    WrTangent out[12];
    WrError err = { "" };
    assert_true(wr_tangents_mikk(hand->corner, hand->triangle, hand->count, out, &err));
    for (int i = 0; i < count; i++) {
        const WrTangent *got = &out[3 * want[i].triangle + want[i].corner];
        expect_near(got->t.x, want[i].t[0], 1e-7, "t.x", want[i].triangle, want[i].corner);
        expect_near(got->t.y, want[i].t[1], 1e-7, "t.y", want[i].triangle, want[i].corner);
        expect_near(got->t.z, want[i].t[2], 1e-7, "t.z", want[i].triangle, want[i].corner);
        expect_near(got->sign, want[i].sign, 0, "sign", want[i].triangle, want[i].corner);
    }
}

static void the_lecture_by_hand(void **state)
{
    (void)state;
    const WrVec3 p[3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
    const double uv[3][2] = { { 0.5, 0 }, { 1, 0.5 }, { 0, 1 } };
    WrVec3 t, b;
    double det;
    assert_true(wr_tangent_lecture(p, uv, &t, &b, &det));
    assert_near(det, 0.75, 1e-15);
    assert_near(t.x, 4.0 / 3, 1e-15);
    assert_near(t.y, -2.0 / 3, 1e-15);
    assert_near(b.x, 2.0 / 3, 1e-15);
    assert_near(b.y, 2.0 / 3, 1e-15);
    const double degrees = acos(v3_dot(unit3(b.x, b.y, b.z), unit3(1, 2, 0))) * 57.29577951308232;
    assert_near(degrees, 18.4, 0.05); /* the shear that an orthonormal frame drops */
}

static void mikk_by_hand(void **state)
{
    (void)state;
    const Hand d = mesh_d();
    const double h = 0.707106781;
    expect_mikk(&mesh_a, (Want[]){ { 0, 0, { 0.894427191, -0.447213595, 0 }, 1 } }, 1);
    expect_mikk(&mesh_b,
                (Want[]){ { 0, 0, { 0.923879533, -0.382683432, 0 }, 1 },
                          { 0, 1, { 1, 0, 0 }, 1 },
                          { 0, 2, { 0.923879533, -0.382683432, 0 }, 1 },
                          { 1, 0, { 0.923879533, -0.382683432, 0 }, 1 },
                          { 1, 2, { h, -h, 0 }, 1 } },
                5);
    expect_mikk(&mesh_c,
                (Want[]){ { 0, 0, { -1, 0, 0 }, -1 },
                          { 0, 1, { -1, 0, 0 }, -1 },
                          { 0, 2, { -1, 0, 0 }, -1 },
                          { 1, 0, { 1, 0, 0 }, 1 },
                          { 1, 2, { 1, 0, 0 }, 1 } },
                5);
    expect_mikk(&d,
                (Want[]){ { 0, 0, { 0.890635347, 0.091982866, 0.445317674 }, 1 },
                          { 0, 1, { 1, 0, 0 }, 1 },
                          { 0, 2, { 0.889661806, 0.103088983, 0.444830903 }, 1 },
                          { 1, 1, { 0.889661806, 0.103088983, 0.444830903 }, 1 },
                          { 1, 2, { 0.696310624, 0.174077656, 0.696310624 }, 1 } },
                5);
    expect_mikk(&mesh_e,
                (Want[]){ { 0, 0, { 0.993225462, -0.116203191, 0 }, 1 },
                          { 0, 1, { 1, 0, 0 }, 1 },
                          { 0, 2, { 0.998815248, -0.048663139, 0 }, 1 },
                          { 1, 2, { 0.986393924, -0.164398987, 0 }, 1 },
                          { 2, 0, { 1, 0, 0 }, 1 },
                          { 2, 2, { 0.998815248, -0.048663139, 0 }, 1 },
                          { 2, 1, { 1, 0, 0 }, -1 } },
                7);
}

/* B = sign n x T, and the mean of the lecture's frames has both signs side by side (HC128). */
static void signs_stay_apart(void **state)
{
    (void)state;
    WrTangent out[6];
    WrError err = { "" };
    assert_true(wr_tangents_mikk(mesh_a.corner, mesh_a.triangle, 1, out, &err));
    assert_near(out[0].b.x, 0.447213595, 1e-9);
    assert_near(out[0].b.y, 0.894427191, 1e-9);
    assert_true(wr_tangents_average(mesh_c.corner, mesh_c.triangle, 2, out, &err));
    for (int k = 0; k < 3; k++) {
        assert_near(out[k].t.x, -1, 1e-12);
        assert_near(out[3 + k].t.x, 1, 1e-12);
        assert_near(out[k].sign, -1, 0);
        assert_near(out[3 + k].sign, 1, 0);
    }
}

/* HC126, HC127: a determinant of rounding size defines no frame; the gradient needs none and is exact. */
static void thin_maps_have_no_frame(void **state)
{
    (void)state;
    const WrVec3 p[3] = { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 1, 0 } };
    const double tiny[3][2] = { { 0, 0 }, { 1, 1 }, { 1, 1 + 1e-12 } };
    const double line[3][2] = { { 0, 0 }, { 1, 0 }, { 0.5, 0 } };
    WrVec3 t, b, n, gu, gv;
    double det;
    assert_false(wr_tangent_lecture(p, tiny, &t, &b, &det));
    assert_false(wr_tangent_lecture(p, line, &t, &b, &det));
    assert_true(wr_triangle_gradients(p, line, &n, &gu, &gv));
    assert_near(n.z, 1, 0);
    assert_near(gu.x, 0.5, 1e-15); /* u = x/2 + y/2 */
    assert_near(gu.y, 0.5, 1e-15);
    assert_near(gu.z, 0, 0);
    assert_near(v3_len(gv), 0, 0);
}

/* The gradient is dual to the solution where there is one: T . grad u = B . grad v = 1. */
static void gradients_are_dual(void **state)
{
    (void)state;
    TestRandom random = { 5 };
    for (int i = 0; i < 2000; i++) {
        WrVec3 p[3], t, b, n, gu, gv;
        double uv[3][2], det;
        for (int k = 0; k < 3; k++) {
            p[k] = (WrVec3){ test_random(&random), test_random(&random), test_random(&random) };
            uv[k][0] = test_random(&random), uv[k][1] = test_random(&random);
        }
        if (!wr_tangent_lecture(p, (const double(*)[2])uv, &t, &b, &det) || fabs(det) < 1e-2)
            continue;
        assert_true(wr_triangle_gradients(p, (const double(*)[2])uv, &n, &gu, &gv));
        assert_near(v3_dot(t, gu), 1, 1e-9);
        assert_near(v3_dot(b, gv), 1, 1e-9);
        assert_near(v3_dot(t, gv), 0, 1e-9);
        assert_near(v3_dot(b, gu), 0, 1e-9);
        assert_near(v3_dot(v3_cross(t, b), n) > 0 ? 1 : -1, det > 0 ? 1 : -1, 0);
        const WrVec3 side = v3_sub(p[1], p[0]);
        assert_near(v3_dot(gu, side), uv[1][0] - uv[0][0], 1e-9);
    }
}

/* HC133: the normal of a needle, from its two shortest edges. */
static void needles_have_normals(void **state)
{
    (void)state;
    const double length = 1, wide = 1e-7;
    const WrVec3 p[3] = { { 0, 0, 0 }, { length, 0, length }, { length, wide, length + 1e-9 } };
    const double uv[3][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 } };
    WrVec3 n, gu, gv;
    assert_true(wr_triangle_gradients(p, uv, &n, &gu, &gv));
    /* (1,0,1) x (0,1e-7,1e-9) */
    const WrVec3 want = unit3(-wide * length, -1e-9 * length, wide * length);
    assert_true(v3_len(v3_sub(n, want)) < 1e-8);
}

static void expect_units(const WrTangent *out, const WrTriangleCorner *corners,
                         const WrTriangle *triangles, int32_t count)
{
    for (int32_t i = 0; i < 3 * count; i++) {
        const float *n = corners[triangles[i / 3].corner[i % 3]].n;
        assert_near(v3_len(out[i].t), 1, 1e-9);
        assert_true(isfinite(v3_len(out[i].b)));
        const double across =
            out[i].t.x * (double)n[0] + out[i].t.y * (double)n[1] + out[i].t.z * (double)n[2];
        if (out[i].sign != -1 || out[i].t.x != 1) assert_near(across, 0, 1e-6);
    }
}

/* HC130: two triangles folded onto each other, with opposite tangents and equal signs: each keeps its own. */
static void folded_pairs_keep_their_own(void **state)
{
    (void)state;
    /* (u,v) turned by half a circle about the shared edge's middle, seen with one normal */
    const Hand fold = { { { { 0, 0, 0 }, { 0, 0, 1 }, 0, 0 },
                          { { 0, 1, 0 }, { 0, 0, 1 }, 0, 1 },
                          { { -1, 0, 0 }, { 0, 0, 1 }, -1, 0 },
                          { { -1, 0, 0 }, { 0, 0, 1 }, 1, 0 } },
                        { { { 0, 1, 2 } }, { { 1, 0, 3 } } },
                        2 };
    WrTangent out[6];
    WrError err = { "" };
    assert_true(wr_tangents_mikk(fold.corner, fold.triangle, 2, out, &err));
    expect_units(out, fold.corner, fold.triangle, 2);
}

/* HC131: a triangle with coinciding points copies the frame of its neighbour's corner; alone it has (1,0,0). */
static void collapsed_triangles_copy(void **state)
{
    (void)state;
    const Hand hand = { { { { 0, 0, 0 }, { 0, 0, 1 }, 0, 0 },
                          { { 1, 0, 0 }, { 0, 0, 1 }, 0, 1 },
                          { { 0, 1, 0 }, { 0, 0, 1 }, -1, 0 },
                          { { 5, 5, 0 }, { 0, 0, 1 }, 0, 0 } },
                        { { { 0, 1, 2 } }, { { 0, 0, 1 } }, { { 3, 3, 3 } } },
                        3 };
    WrTangent out[9];
    WrError err = { "" };
    assert_true(wr_tangents_mikk(hand.corner, hand.triangle, 3, out, &err));
    for (int k = 0; k < 2; k++) assert_memory_equal(&out[3 + k], &out[0], sizeof out[0]);
    assert_memory_equal(&out[5], &out[1], sizeof out[0]);
    assert_near(out[6].t.x, 1, 0);
    expect_units(out, hand.corner, hand.triangle, 3);
}

/* HC132: three faces at one edge: groups terminate, and all is finite. Random meshes of few points branch
   everywhere. */
static void tangles_end(void **state)
{
    (void)state;
    TestRandom random = { 77 };
    for (int round = 0; round < 300; round++) {
        WrTriangleCorner corners[12];
        WrTriangle triangles[60];
        WrTangent out[180];
        WrError err = { "" };
        for (int i = 0; i < 12; i++) {
            WrTriangleCorner *c = &corners[i];
            const WrVec3 n = unit3(test_random(&random) - 0.5, test_random(&random) - 0.5, 0.2);
            for (int k = 0; k < 3; k++) c->p[k] = floorf(4 * (float)test_random(&random));
            c->n[0] = (float)n.x, c->n[1] = (float)n.y, c->n[2] = (float)n.z;
            c->u = floorf(3 * (float)test_random(&random)) / 2;
            c->v = floorf(3 * (float)test_random(&random)) / 2;
        }
        for (int i = 0; i < 180; i++)
            triangles[i / 3].corner[i % 3] = (int32_t)(12 * test_random(&random));
        assert_true(wr_tangents_mikk(corners, triangles, 60, out, &err));
        expect_units(out, corners, triangles, 60);
        assert_true(wr_tangents_average(corners, triangles, 60, out, &err));
        for (int i = 0; i < 180; i++) assert_true(isfinite(v3_len(out[i].t) + v3_len(out[i].b)));
    }
}

/* HC129: (u,v) one unit of the last place apart at a place are two corners, and two frames. */
static void seams_part_frames(void **state)
{
    (void)state;
    Hand hand = mesh_b;
    hand.corner[4] = hand.corner[0];
    hand.corner[4].u = nextafterf(0, 1);
    hand.triangle[1].corner[0] = 4;
    WrTangent out[6];
    WrError err = { "" };
    assert_true(wr_tangents_mikk(hand.corner, hand.triangle, 2, out, &err));
    assert_near(out[0].t.x, 1, 1e-9);
    assert_near(out[3].t.x, 0.707106781, 1e-8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_lecture_by_hand),
        cmocka_unit_test(mikk_by_hand),
        cmocka_unit_test(signs_stay_apart),
        cmocka_unit_test(thin_maps_have_no_frame),
        cmocka_unit_test(gradients_are_dual),
        cmocka_unit_test(needles_have_normals),
        cmocka_unit_test(folded_pairs_keep_their_own),
        cmocka_unit_test(collapsed_triangles_copy),
        cmocka_unit_test(tangles_end),
        cmocka_unit_test(seams_part_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

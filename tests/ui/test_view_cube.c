/* The orientation cube: the part under the pointer, and the rotations that bring a side to the front. */
#include "test.h"

#include "base/vec.h"

#include "ui/patch/preview/rotation.h"

static WrRotation random_rotation(TestRandom *r)
{
    return wr_rotation_from_deg(
        (WrVec3){ 360 * test_random(r), 180 * test_random(r) - 90, 360 * test_random(r) });
}

/* Angle between two rotations in degrees, from the trace of a b^-1. */
static double between_deg(const WrRotation *a, const WrRotation *b)
{
    double trace = 0;
    for (int i = 0; i < 9; i++) trace += a->m[i] * b->m[i];
    return acos(fmax(-1, fmin(1, (trace - 1) / 2))) * 57.29577951308232;
}

/* Points on all faces: a point whose face is towards the viewer is found at its position. */
static void what_is_seen_is_what_is_found(void **state)
{
    (void)state;
    TestRandom r = { 51 };
    int seen = 0;
    for (int i = 0; i < 3000; i++) {
        const WrRotation cube = random_rotation(&r);
        double at[3] = { 2 * test_random(&r) - 1, 2 * test_random(&r) - 1,
                         2 * test_random(&r) - 1 };
        const int k = i % 3, end = i & 8 ? 1 : -1;
        int side[3];
        at[k] = end;
        const WrVec3 p = wr_rotation_apply(&cube, (WrVec3){ at[0], at[1], at[2] });
        const double towards = cube.m[6 + k] * end; /* z of the face's normal */
        bool rim = false;
        for (int j = 0; j < 3; j++) rim = rim || fabs(fabs(at[j]) - WR_CUBE_RIM) < 1e-6;
        if (towards < 1e-3 || rim) continue;
        seen++;
        assert_true(wr_cube_at(&cube, p.x, p.y, side));
        for (int j = 0; j < 3; j++)
            assert_int_equal(side[j], at[j] > WR_CUBE_RIM ? 1 : at[j] < -WR_CUBE_RIM ? -1 : 0);
    }
    assert_true(seen > 1000);
    const WrRotation plain = wr_rotation_from_deg((WrVec3){ 0, 0, 0 });
    int side[3];
    assert_false(wr_cube_at(&plain, 1.01, 0, side));
    assert_true(wr_cube_at(&plain, 0.9, 0.1, side)); /* the front's right edge */
    assert_true(side[0] == 1 && side[1] == 0 && side[2] == 1);
}

/* All 26: the side is in front, without mirroring, and upright wherever that is defined. */
static void every_side_can_be_brought_to_the_front(void **state)
{
    (void)state;
    for (int n = 0; n < 27; n++) {
        const int side[3] = { n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1 };
        if (n == 13) continue;
        const WrRotation m = wr_cube_facing(side);
        const WrVec3 d = { side[0], side[1], side[2] },
                     front = wr_rotation_apply(&m, v3_scale(d, 1 / v3_len(d)));
        assert_near(front.z, 1, 1e-12);
        const WrVec3 x = { m.m[0], m.m[1], m.m[2] }, y = { m.m[3], m.m[4], m.m[5] },
                     z = { m.m[6], m.m[7], m.m[8] };
        assert_near(v3_dot(v3_cross(x, y), z), 1, 1e-12);
        const WrVec3 up = wr_rotation_apply(&m, (WrVec3){ 0, 1, 0 });
        assert_near(up.x, 0, 1e-12);
        if (side[0] || side[2]) assert_true(up.y > 0.5);
        else assert_near(wr_rotation_apply(&m, (WrVec3){ 0, 0, 1 }).y, -side[1], 1e-12);
    }
}

static void turns_are_even_and_end_where_they_shall(void **state)
{
    (void)state;
    TestRandom r = { 52 };
    for (int i = 0; i < 300; i++) {
        const WrRotation a = random_rotation(&r);
        WrRotation b = random_rotation(&r);
        if (i % 5 == 0) { /* half a turn */
            const WrRotation half = wr_rotation_axis((WrVec3){ 0, 0.6, 0.8 }, 180);
            b = wr_rotation_times(&half, &a);
        }
        const double t = test_random(&r), whole = between_deg(&a, &b);
        const WrRotation begin = wr_rotation_between(&a, &b, 0),
                         end = wr_rotation_between(&a, &b, 1), mid = wr_rotation_between(&a, &b, t);
        assert_near(between_deg(&a, &begin), 0, 1e-4);
        for (int k = 0; k < 9; k++) assert_near(end.m[k], b.m[k], 1e-6);
        assert_near(between_deg(&a, &mid), t * whole, 1e-3);
        assert_near(between_deg(&mid, &b), (1 - t) * whole, 1e-3);
    }
    assert_near(wr_cube_ease(0), 0, 0);
    assert_near(wr_cube_ease(1), 1, 0);
    assert_near(wr_cube_ease(7), 1, 0);
    assert_near(wr_cube_ease(1e-4), 0, 1e-7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_seen_is_what_is_found),
        cmocka_unit_test(every_side_can_be_brought_to_the_front),
        cmocka_unit_test(turns_are_even_and_end_where_they_shall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

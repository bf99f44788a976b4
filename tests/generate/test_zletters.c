/* Solids cut along outlines, against their definition and marching along rays. */
#include "test.h"

#include "base/error.h"
#include "generate/zbuffer_intersect.h"

static double implicit_plate(double depth, double bevel, WrZBevel kind, const double q[3])
{
    /* a square of half side 10 with a square hole of half side 4 */
    double far = fmax(fabs(q[0]), fabs(q[1])), d = fmin(10.0 - far, far - 4.0);
    if (far > 10.0) d = -hypot(fmax(0.0, fabs(q[0]) - 10.0), fmax(0.0, fabs(q[1]) - 10.0));
    if (far > 4.0 && far < 10.0) /* corners of the hole are round at a distance */
        d = fmin(10.0 - far, hypot(fmax(0.0, fabs(q[0]) - 4.0), fmax(0.0, fabs(q[1]) - 4.0)));
    if (d < 0.0 || q[2] < 0.0) return 1.0;
    double e = fmax(0.0, bevel - d);
    double top = depth - (kind == WR_Z_BEVEL_CHAMFER ? e : bevel - sqrt(bevel * bevel - e * e));
    return q[2] - top;
}

static WrZLetters *plate(double depth, double bevel, WrZBevel kind)
{
    static const double outer[] = { -10, -10, 10, -10, 10, 10, -10, 10 };
    static const double hole[] = { -4, -4, -4, 4, 4, 4, 4, -4 };
    const WrZContour contours[2] = { { outer, 4 }, { hole, 4 } };
    WrError err = { "" };
    WrZLetters *letters = wr_zletters_new(contours, 2, depth, bevel, kind, &err);
    if (!letters) fail_msg("%s", err.text);
    return letters;
}

static void check_plate(const WrZLetters *letters, double bevel, WrZBevel kind, const double b[3],
                        TestRandom *r)
{
    int hits = 0, grazing = 0;
    for (int i = 0; i < 400; i++) {
        double a[3] = { 24.0 * test_random(r) - 12.0, 24.0 * test_random(r) - 12.0, 4.0 }, t = 0.0;
        bool hit = wr_zletters_meet(letters, a, b, &t);
        hits += hit;
        for (double s = 40.0; s >= -40.0; s -= 0.01) {
            const double q[3] = { a[0] + b[0] * s, a[1] + b[1] * s, a[2] + b[2] * s };
            if (implicit_plate(6.0, bevel, kind, q) > -1e-3) continue;
            if (!hit || t < s - 1e-4)
                fail_msg("inside at %g, found %g; %g,%g", s, hit ? t : NAN, a[0], a[1]);
            break;
        }
        if (!hit) continue;
        const double above[3] = { a[0] + b[0] * (t + 1e-4), a[1] + b[1] * (t + 1e-4),
                                  a[2] + b[2] * (t + 1e-4) };
        const double below[3] = { a[0] + b[0] * (t - 1e-3), a[1] + b[1] * (t - 1e-3),
                                  a[2] + b[2] * (t - 1e-3) };
        assert_true(implicit_plate(6.0, bevel, kind, above) > -1e-6);
        grazing += implicit_plate(6.0, bevel, kind, below) > 2e-3;
        assert_false(wr_zletters_clear(letters, a, b, 0.1));
    }
    assert_true(hits > 20 && grazing <= 3);
}

static void letters_in_any_pose_are_what_marching_along_rays_finds(void **state)
{
    (void)state;
    TestRandom r = { 7 };
    static const double lines[][3] = { { 0, 0, 1 },        { 0, 0, -1 },      { 0.6, 0, 0.8 },
                                       { -0.3, 0.7, 0.6 }, { 0.9, 0.1, 0.2 }, { 0.5, 0.5, -0.7 } };
    for (int kind = 0; kind < 2; kind++)
        for (int wide = 0; wide < 3; wide++) {
            double bevel = 2.5 * wide; /* none, some, more than the strokes are wide */
            WrZLetters *letters = plate(6.0, bevel, (WrZBevel)kind);
            for (int l = 0; l < 6; l++) check_plate(letters, bevel, (WrZBevel)kind, lines[l], &r);
            wr_zletters_free(letters);
        }
}

static void the_distance_to_outlines_is_true_near_them_and_safe_far_away(void **state)
{
    (void)state;
    WrZLetters *letters = plate(6.0, 2.0, WR_Z_BEVEL_ROUND);
    for (double y = -15.05; y < 15.0; y += 0.7)
        for (double x = -15.05; x < 15.0; x += 0.7) {
            double far = fmax(fabs(x), fabs(y)), d = wr_zletters_distance(letters, x, y);
            double out = hypot(fmax(0.0, fabs(x) - 10.0), fmax(0.0, fabs(y) - 10.0));
            double hole =
                far < 4.0 ? 4.0 - far : hypot(fmax(0.0, fabs(x) - 4.0), fmax(0.0, fabs(y) - 4.0));
            double true_d = far > 10.0 ? -out : far < 4.0 ? -hole : fmin(10.0 - far, hole);
            if (fabs(true_d) < 2.0) assert_near(d, true_d, 1e-12);
            assert_true(fabs(d) <= fabs(true_d) + 1e-12 && (d > 0.0) == (true_d > 0.0));
        }
    wr_zletters_free(letters);
}

static void outlines_without_an_area_or_with_wild_points_are_refused(void **state)
{
    (void)state;
    const double line[] = { 0, 0, 5, 0, 9, 0 }, wild[] = { 0, 0, NAN, 1, 4, 4 };
    const WrZContour flat = { line, 3 }, odd = { wild, 3 };
    WrError err = { "" };
    assert_null(wr_zletters_new(&flat, 1, 5, 1, WR_Z_BEVEL_ROUND, &err));
    assert_non_null(strstr(err.text, "no area"));
    assert_null(wr_zletters_new(&odd, 1, 5, 1, WR_Z_BEVEL_ROUND, &err));
    assert_non_null(strstr(err.text, "outline point 2"));
    assert_null(wr_zletters_new(&flat, 0, 5, 1, WR_Z_BEVEL_ROUND, &err));
    assert_null(wr_zletters_new(&flat, 1, 5, 6, WR_Z_BEVEL_ROUND, &err));
    assert_non_null(strstr(err.text, "bevel"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(letters_in_any_pose_are_what_marching_along_rays_finds),
        cmocka_unit_test(the_distance_to_outlines_is_true_near_them_and_safe_far_away),
        cmocka_unit_test(outlines_without_an_area_or_with_wild_points_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Theorems behind the accuracy of pictures that no other test covers: A1, A2, A7 and A8 are in test_scheme.c, A3 to
   A5, A9 and A10 in test_bump.c, A11 and A12 of noise in test_noise.c. */
#include "test.h"
#include "field/scheme_list.h"

#include "render/reference/reference.h"
#include "render_scenes.h"

/* A wavy plane that fills the picture, lit everywhere without a highlight: I is smooth in every pixel. */
static WrScene *smooth_scene(WrAnalyticTerm *terms)
{
    WrScene *scene = wr_scene_new();
    terms[0] = (WrAnalyticTerm){ .i = 3, .j = 2, .a = 1 };
    terms[1] = (WrAnalyticTerm){ .i = 1, .j = -4, .a = 0.6, .phase_u_deg = 40 };
    scene->analytic = (WrAnalytic){ WR_ANALYTIC_FOURIER, 2, terms };
    scene->height = 0.02;
    scene->bump = WR_BUMP_EXACT;
    scene->material.specular = 0;
    scene->camera.orthographic = true;
    scene->camera.size = 0.8;
    return scene;
}

#define SIDE 20

static WrReference mean_of(const WrScene *scene, int k)
{
    WrReference out = { 0 };
    WrPool *pool = wr_pool_new(2);
    const WrReferenceRequest request = {
        .scene = scene, .width = SIDE, .height = SIDE, .first = k, .most = k
    };
    assert_true(wr_reference_render(&request, pool, &out, NULL));
    wr_pool_free(pool);
    return out;
}

static double rms_of(const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < SIDE * SIDE * 4; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum / (3 * SIDE * SIDE));
}

/* The slope of log2 y over log2 k, k = 1, 2, 4, ..., by least squares. */
static double fitted_slope(const double *y, int count)
{
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int i = 0; i < count; i++) {
        const double v = log2(y[i]);
        sx += i, sy += v, sxx += i * i, sxy += i * v;
    }
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

static void a6_the_error_of_k_by_k_samples_falls_with_the_square_of_k(void **state)
{
    (void)state;
    WrAnalyticTerm terms[2];
    WrScene *scene = smooth_scene(terms);
    WrReference truth = mean_of(scene, 64);
    double rms[4];
    for (int i = 0; i < 4; i++) {
        WrReference r = mean_of(scene, 1 << i);
        rms[i] = rms_of(r.rgba, truth.rgba);
        wr_reference_fini(&r);
    }
    assert_true(rms[0] > 1e-4); /* there are differences to average */
    assert_near(fitted_slope(rms, 4), -2, 0.1);
    scene->analytic = (WrAnalytic){ 0 };
    wr_reference_fini(&truth);
    wr_scene_free(scene);
}

static void a6_so_does_that_of_the_pictures_own_supersampling(void **state)
{
    (void)state;
    WrAnalyticTerm terms[2];
    WrScene *scene = smooth_scene(terms);
    WrField *field = bumpy_field(4, 4);
    WrReference truth = mean_of(scene, 64);
    WrRenderer *renderer = wr_renderer_new(NULL, "ref", NULL);
    double rms[4], picture[SIDE * SIDE * 4];
    for (int i = 0; i < 4; i++) {
        WrFrame frame;
        scene->dials.aa = i == 0 ? WR_AA_POINT : WR_AA_SUPERSAMPLE;
        scene->dials.samples = 1 << i;
        const WrFrameRequest request = {
            .field = field, .scene = scene, .width = SIDE, .height = SIDE
        };
        assert_true(wr_renderer_frame(renderer, &request, &frame, NULL));
        for (int k = 0; k < SIDE * SIDE * 4; k++) picture[k] = (double)frame.rgba[k];
        rms[i] = rms_of(picture, truth.rgba);
    }
    assert_near(fitted_slope(rms, 4), -2, 0.1);
    scene->analytic = (WrAnalytic){ 0 };
    wr_renderer_free(renderer);
    wr_reference_fini(&truth);
    wr_field_free(field);
    wr_scene_free(scene);
}

static void a11_a_table_has_period_1_to_the_bit_under_every_scheme(void **state)
{
    (void)state;
    WrField *field = random_field(48, 20, 7);
    for (int scheme = 0; scheme < WR_SCHEME_COUNT; scheme++)
        for (int k = 0; k < 64; k++) { /* dyadic, so that u + 7 is exact */
            const double u[3] = { k / 64.0, k / 64.0 + 7, k / 64.0 - 3 };
            const double v[3] = { (63 - k) / 64.0, (63 - k) / 64.0 - 2, (63 - k) / 64.0 + 1024 };
            double f[3], fu[3], fv[3];
            wr_field_sample(field, (WrScheme)scheme, 3, u, v, f, fu, fv);
            for (int i = 1; i < 3; i++)
                assert_true(same_bits(f[i], f[0]) && same_bits(fu[i], fu[0]) &&
                            same_bits(fv[i], fv[0]));
        }
    wr_field_free(field);
}

static void a13_hc35_n_times_a_number_below_1_is_below_n(void **state)
{
    (void)state;
    const double last = nextafter(1, 0);
    const float last_f = nextafterf(1, 0);
    for (int n = 1; n <= WR_FIELD_MAX; n++) {
        const double x = n * last;
        const float x_f = (float)n * last_f;
        assert_true(x < n && x_f < (float)n);
        assert_true((int)floor(n * wr_field_reduce(last, 1)) == n - 1);
        assert_true(n * wr_field_reduce(-1e-17, 1) < n); /* HC36 */
        assert_true(n * wr_field_reduce(last, n) < n);
    }
}

/* The steepest slope of the bilinear interpolant, heights `height` times the table on the unit square: in a
 * cell Fu depends on v alone and Fv on u alone, linearly, so that |grad F|^2 is largest at a corner. */
static double steepest(const WrField *field, double height, double direction[2])
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    double most = 0;
    for (int k = 0; k < 4 * w * h; k++) {
        const int i = k / 4 % w, j = k / 4 / w, right = (i + 1) % w, down = (j + 1) % h;
        const int row = k & 1 ? down : j, column = k & 2 ? right : i;
        double fu =
            height * w * ((double)wr_field_get(field, right, row) - wr_field_get(field, i, row));
        double fv = -height * h *
                    ((double)wr_field_get(field, column, down) - wr_field_get(field, column, j));
        if (!(hypot(fu, fv) > most)) continue;
        most = hypot(fu, fv);
        direction[0] = fu / most, direction[1] = fv / most;
    }
    return most;
}

static double height_at(const WrField *field, double height, double u, double v)
{
    double f;
    wr_field_sample(field, WR_SCHEME_BILINEAR, 1, &u, &v, &f, NULL, NULL);
    return height * f;
}

/* Number of n x n points whose line to a light at slope `rise` in that direction is below the relief, for a march
 * over a whole period and more. */
static int shadowed(const WrField *field, double height, const double to[2], double rise, int n)
{
    int count = 0;
    for (int k = 0; k < n * n; k++) {
        const double u = (k % n + 0.37) / n, v = (k / n + 0.21) / n;
        const double here = height_at(field, height, u, v);
        bool dark = false;
        for (int s = 1; s <= 300 && !dark; s++) {
            const double t = s / 200.0;
            dark = height_at(field, height, u + t * to[0], v + t * to[1]) > here + t * rise + 1e-12;
        }
        count += dark;
    }
    return count;
}

static void a14_gentle_slopes_on_a_flat_base_cast_no_shadows(void **state)
{
    (void)state;
    for (int seed = 1; seed <= 3; seed++) {
        WrField *field = random_field(8, 11, (uint64_t)seed);
        const double height = 0.07;
        double uphill[2];
        const double slope = steepest(field, height, uphill);
        for (int k = 0; k < 12; k++) { /* all around, with the light as low as the theorem allows */
            double s, c;
            wr_sincos_turns(k / 12.0, &s, &c);
            assert_int_equal(shadowed(field, height, (const double[]){ c, s }, slope, 12), 0);
        }
        assert_int_equal(shadowed(field, height, uphill, slope, 40), 0);
        /* With a lower light along the steepest slope there is shadow: the bound is tight. */
        assert_true(shadowed(field, height, uphill, 0.8 * slope, 40) > 0);
        wr_field_free(field);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a6_the_error_of_k_by_k_samples_falls_with_the_square_of_k),
        cmocka_unit_test(a6_so_does_that_of_the_pictures_own_supersampling),
        cmocka_unit_test(a11_a_table_has_period_1_to_the_bit_under_every_scheme),
        cmocka_unit_test(a13_hc35_n_times_a_number_below_1_is_below_n),
        cmocka_unit_test(a14_gentle_slopes_on_a_flat_base_cast_no_shadows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

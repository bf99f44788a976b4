/* The depth buffer against square roots, marching along rays, and areas. */
#include "test.h"
#include "generate_help.h"

#include "base/pool.h"
#include "generate/zbuffer.h"

static const double upright[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };

static WrZSolid solid_of(WrZShape shape, double param, double sx, double sy, double sz,
                         const double turn[9], double x, double y, double z)
{
    WrZSolid solid;
    WrError err = { "" };
    const double size[3] = { sx, sy, sz }, at[3] = { x, y, z };
    if (!wr_zsolid_set(&solid, shape, param, NULL, size, turn, at, &err)) fail_msg("%s", err.text);
    return solid;
}

static WrRelief drawn(const WrZScene *scene, const WrField *like, WrPool *pool)
{
    WrGenerateJob job = { .like = like, .pool = pool };
    WrRelief relief = { 0 };
    WrError err = { "" };
    if (!wr_zbuffer_draw(scene, &job, &relief, &err)) fail_msg("%s", err.text);
    return relief;
}

static WrRelief drawn_solid(const WrZSolid *solid, const WrField *like)
{
    WrZScene scene = { .solids = solid, .solid_count = 1, .floor = -1e9, .scale = 1.0 };
    return drawn(&scene, like, NULL);
}

/* ---- spheres ---- */

/* On a clamped table, completely, partly or not at all on it. */
static void check_sphere(double radius, double x, double y, int n)
{
    WrField *like = wr_field_new(n, n, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, NULL);
    WrZSolid sphere = solid_of(WR_Z_SPHERE, 0, radius, radius, radius, upright, x, y, 0);
    WrRelief relief = drawn_solid(&sphere, like);
    x = sphere.at[0];
    y = sphere.at[1];
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            double dx = i - x, dy = j - y, rest = radius * radius - dx * dx - dy * dy;
            double z = (double)wr_field_get(relief.heights, i, j);
            double cover = (double)wr_field_get(relief.cover, i, j);
            if (rest >= 0.0) {
                /* one rounding to float, and the error of doubles near the silhouette */
                assert_near(z, sqrt(rest), sqrt(rest) * 0x1p-24 + radius * 1e-8);
                assert_true(cover > 0.0);
            }
            double far = sqrt(dx * dx + dy * dy) - radius;
            if (far > 0.71) assert_true(cover == 0.0 && z == 0.0);
            if (far < -0.71) assert_true(cover == 1.0);
        }
    wr_relief_fini(&relief);
    wr_field_free(like);
}

static void hc79_a_sphere_is_its_square_root_however_large_small_or_far_off(void **state)
{
    (void)state;
    check_sphere(20.0, 31.5, 30.25, 64);
    check_sphere(0.3, 12.0, 12.0, 24);
    check_sphere(0.01, 12.1, 12.2, 24);
    check_sphere(1.0, 0.0, 23.0, 24);
    check_sphere(500.0, 40.0, -300.0, 96);
    check_sphere(90000.0, 50.0, 60.0, 96);
    check_sphere(10.0, -200.0, 5.0, 24);
    check_sphere(33.3, 70.0, 70.0, 150); /* across tiles */
}

static void hc79_a_sphere_larger_than_a_periodic_table_is_the_highest_of_its_images(void **state)
{
    (void)state;
    const int w = 24, h = 17;
    const double r = 31.0;
    WrField *like = table_of(w, h);
    WrZSolid sphere = solid_of(WR_Z_SPHERE, 0, r, r, r, upright, 5.5, 8.25, 0);
    WrRelief relief = drawn_solid(&sphere, like);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            double most = -1.0;
            for (int b = -4; b <= 4; b++)
                for (int a = -4; a <= 4; a++) {
                    double dx = i - 5.5 - a * w, dy = j - 8.25 - b * h;
                    double rest = r * r - dx * dx - dy * dy;
                    if (rest > 0.0 && sqrt(rest) > most) most = sqrt(rest);
                }
            assert_near((double)wr_field_get(relief.heights, i, j), most, 1e-5);
            assert_true(wr_field_get(relief.cover, i, j) == 1.0f);
        }
    wr_relief_fini(&relief);
    wr_field_free(like);
}

/* ---- every solid by brute force ---- */

/* Negative inside, in the unit solid's space; from the solids' definitions. */
static double implicit(const WrZSolid *s, const double q[3])
{
    double xy = sqrt(q[0] * q[0] + q[1] * q[1]), z = q[2];
    switch (s->shape) {
    case WR_Z_SPHERE: return xy * xy + z * z - 1.0;
    case WR_Z_BOX: return fmax(fabs(q[0]), fmax(fabs(q[1]), fabs(z))) - 1.0;
    case WR_Z_CYLINDER: return fmax(xy, fabs(z)) - 1.0;
    case WR_Z_CONE: return fmax(fmax(-1.0 - z, z - 1.0), xy - 0.5 * (1.0 - z));
    case WR_Z_CAPSULE: {
        double over = fmax(0.0, fabs(z) - s->param);
        return sqrt(xy * xy + over * over) - 1.0;
    }
    default: return sqrt((xy - 1.0) * (xy - 1.0) + z * z) - s->param;
    }
}

static double implicit_at(const WrZSolid *s, double x, double y, double z)
{
    const double d[3] = { x - s->at[0], y - s->at[1], z - s->at[2] };
    double q[3] = { 0 };
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++) q[k] += s->inverse[3 * k + c] * d[c];
    return implicit(s, q);
}

/* March down a ray: no inner point is above the top, and the top is the first inner point. */
static void check_ray(const WrZSolid *s, double x, double y, double reach)
{
    double top;
    bool hit = wr_zsolid_top(s, x, y, &top);
    double from = s->at[2] + reach, to = s->at[2] - reach, step = reach / 400.0;
    for (double z = from; z >= to; z -= step) {
        if (implicit_at(s, x, y, z) > -1e-9) continue;
        if (!hit || top < z - 1e-9)
            fail_msg("shape %d at %g,%g: inside at %g, top %g", (int)s->shape, x, y, z,
                     hit ? top : NAN);
        break;
    }
    if (!hit) return;
    assert_near(implicit_at(s, x, y, top), 0.0, 1e-7);
    assert_true(implicit_at(s, x, y, top + 1e-4 * reach) > 0.0);
    assert_false(wr_zsolid_far(s, x, y, 0.0));
    assert_false(wr_zsolid_far(s, x + 0.5, y - 0.5, 0.75));
}

static void check_shape(WrZShape shape, double param, TestRandom *r)
{
    for (int pose = 0; pose < 30; pose++) {
        double turn[9], size[3], angles[3], most = 0.0;
        for (int k = 0; k < 3; k++) {
            angles[k] = pose < 4 ? 90.0 * (pose * (k + 1) % 4) : 720.0 * test_random(r) - 360.0;
            size[k] = 3.0 + 20.0 * test_random(r);
            most = fmax(most, size[k]);
        }
        wr_z_turn(angles, turn);
        WrZSolid s = solid_of(shape, param, size[0], size[1], size[2], turn, 7.0, -3.0, 2.0);
        double reach = most * (2.0 + param);
        assert_true(s.left >= -2.0 * reach && s.right <= 2.0 * reach);
        for (int i = 0; i < 120; i++) {
            double x = 7.0 + reach * (2.0 * test_random(r) - 1.0);
            double y = -3.0 + reach * (2.0 * test_random(r) - 1.0), z;
            check_ray(&s, x, y, reach);
            if (wr_zsolid_top(&s, x, y, &z)) /* its box contains it */
                assert_true(x - 7.0 >= s.left && x - 7.0 <= s.right && y + 3.0 >= s.top &&
                            y + 3.0 <= s.bottom);
        }
        check_ray(&s, 7.0, -3.0, reach);
    }
}

static void every_solid_in_any_pose_is_what_marching_along_rays_finds(void **state)
{
    (void)state;
    TestRandom r = { 79 };
    check_shape(WR_Z_SPHERE, 0, &r);
    check_shape(WR_Z_BOX, 0, &r);
    check_shape(WR_Z_CYLINDER, 0, &r);
    check_shape(WR_Z_CONE, 0, &r);
    check_shape(WR_Z_CAPSULE, 0.0, &r);
    check_shape(WR_Z_CAPSULE, 3.5, &r);
    check_shape(WR_Z_TORUS, 0.05, &r);
    check_shape(WR_Z_TORUS, 0.3, &r);
    check_shape(WR_Z_TORUS, 0.95, &r);
}

/* A torus on its edge, where rays run in its plane and touch its outer circle. */
static void a_torus_on_its_edge_has_the_outer_circle_as_its_top(void **state)
{
    (void)state;
    const double up[3] = { 90, 0, 0 };
    double turn[9], z;
    wr_z_turn(up, turn);
    WrZSolid s = solid_of(WR_Z_TORUS, 0.25, 40, 40, 40, turn, 0, 0, 0);
    for (int i = -2000; i <= 2000; i++) {
        double x = i / 41.0, rest = 50.0 * 50.0 - x * x;
        assert_true(wr_zsolid_top(&s, x, 0.0, &z) == (rest >= 0.0));
        if (rest >= 0.0) assert_near(z, sqrt(rest), 1e-6);
    }
}

/* ---- triangles ---- */

/* A square of cells with random inner corners, each cell two triangles; z = 3 + x / 4 - y / 8. */
#define MESH 9
static int jittered_square(WrZTriangle *out, double x0, double y0, double cell, TestRandom *r)
{
    double p[MESH + 1][MESH + 1][3];
    int count = 0;
    for (int j = 0; j <= MESH; j++)
        for (int i = 0; i <= MESH; i++) {
            bool inner = i > 0 && j > 0 && i < MESH && j < MESH;
            p[j][i][0] = x0 + cell * (i + (inner ? 0.4 * test_random(r) - 0.2 : 0.0));
            p[j][i][1] = y0 + cell * (j + (inner ? 0.4 * test_random(r) - 0.2 : 0.0));
            p[j][i][2] = 3.0 + p[j][i][0] / 4.0 - p[j][i][1] / 8.0;
        }
    for (int j = 0; j < MESH; j++)
        for (int i = 0; i < MESH; i++)
            for (int half = 0; half < 2; half++) {
                const double *c[3] = { p[j][i], half ? p[j + 1][i + 1] : p[j][i + 1],
                                       half ? p[j + 1][i] : p[j + 1][i + 1] };
                for (int k = 0; k < 3; k++) {
                    int to = (i + j) % 2 ? k : 2 - k; /* with either winding */
                    out[count].x[to] = c[k][0];
                    out[count].y[to] = c[k][1];
                    out[count].z[to] = c[k][2];
                }
                count++;
            }
    return count;
}

static void a_mesh_has_no_cracks_and_no_sample_is_covered_twice(void **state)
{
    (void)state;
    TestRandom r = { 5 };
    WrField *like = wr_field_new(130, 130, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, NULL);
    WrZTriangle mesh[2 * MESH * MESH];
    for (int trial = 0; trial < 6; trial++) {
        double cell = trial < 3 ? 13.3 : 0.9 + trial, low = 2.5 + 0.37 * trial;
        int count = jittered_square(mesh, low, low, cell, &r);
        WrZScene all = { .triangles = mesh, .triangle_count = count, .floor = -1e9, .scale = 1 };
        WrRelief whole = drawn(&all, like, NULL);
        double *sum = calloc(130 * 130, sizeof *sum);
        for (int t = 0; t < count; t++) {
            WrZScene one = all;
            one.triangles = &mesh[t];
            one.triangle_count = 1;
            WrRelief part = drawn(&one, like, NULL);
            for (int i = 0; i < 130 * 130; i++)
                sum[i] += (double)wr_field_get(part.cover, i % 130, i / 130);
            wr_relief_fini(&part);
        }
        double area = 0.0;
        for (int i = 0; i < 130 * 130; i++) {
            double x = i % 130, y = i / 130, high = low + cell * MESH;
            double cover = (double)wr_field_get(whole.cover, i % 130, i / 130);
            assert_true(cover == sum[i]);
            bool inside = x - 0.5 >= low && x + 0.5 <= high && y - 0.5 >= low && y + 0.5 <= high;
            if (inside) assert_true(cover == 1.0);
            if (x >= low && x <= high && y >= low && y <= high)
                assert_near((double)wr_field_get(whole.heights, i % 130, i / 130),
                            3.0 + x / 4.0 - y / 8.0, 2e-5);
            area += cover;
        }
        /* a sixteenth of a texel at most along each side */
        assert_near(area, cell * MESH * cell * MESH, 4.0 * (cell * MESH + 1.0) / 16.0);
        free(sum);
        wr_relief_fini(&whole);
    }
    wr_field_free(like);
}

/* Longitudes and latitudes of a sphere, closed. */
static int sphere_mesh(WrZTriangle *out, double radius, double x, double y, int n)
{
    int count = 0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < 2 * n; i++)
            for (int half = 0; half < 2; half++) {
                int at[3][2] = { { i, j },
                                 { i + 1, half ? j + 1 : j },
                                 { half ? i : i + 1, j + 1 } };
                for (int k = 0; k < 3; k++) {
                    double u = M_PI * (at[k][0] % (2 * n)) / n, v = M_PI * at[k][1] / n;
                    out[count].x[k] = x + radius * sin(v) * cos(u);
                    out[count].y[k] = y + radius * sin(v) * sin(u);
                    out[count].z[k] = radius * cos(v);
                }
                count++;
            }
    return count;
}

/* A chord of an arc of angle a is at most r (1 - cos(a/2)) inside; a triangle of two such arcs, twice that. Seen from
 * above, an error e along the normal is e / cos(slope), and vice versa for depth. */
static void a_fine_mesh_of_a_sphere_is_the_sphere_within_its_chords(void **state)
{
    (void)state;
    const double r = 60.0;
    WrField *like = wr_field_new(128, 128, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, NULL);
    double before = INFINITY;
    for (int n = 32; n <= 256; n *= 2) {
        WrZTriangle *mesh = calloc((size_t)(4 * n * n), sizeof *mesh);
        int count = sphere_mesh(mesh, r, 63.7, 64.1, n);
        WrZScene scene = { .triangles = mesh, .triangle_count = count, .floor = -1e9, .scale = 1 };
        WrRelief relief = drawn(&scene, like, NULL);
        double most = 0.0, bound = 2.0 * r * (1.0 - cos(M_PI / n / 2.0)) / 0.6;
        for (int j = 0; j < 128; j++)
            for (int i = 0; i < 128; i++) {
                double d = hypot(i - 63.7, j - 64.1);
                if (d < r - 1.0 - bound) assert_true(wr_field_get(relief.cover, i, j) == 1.0f);
                if (d > r + 0.71) assert_true(wr_field_get(relief.cover, i, j) == 0.0f);
                if (d > 0.8 * r) continue; /* cos(slope) >= 0.6 */
                double low = sqrt(r * r - d * d) - (double)wr_field_get(relief.heights, i, j);
                assert_true(low > -4.0 / 3.0 / 2048.0 - 1e-5); /* corners are rounded */
                most = fmax(most, low);
            }
        assert_true(most <= bound + 0.0007);
        assert_true(most < before / 3.5 + 0.0005); /* second order */
        before = most;
        wr_relief_fini(&relief);
        free(mesh);
    }
    wr_field_free(like);
}

/* ---- ties, order, threads, rolls ---- */

static bool same_relief(const WrRelief *a, const WrRelief *b)
{
    return wr_hash_equal(wr_field_hash(a->heights), wr_field_hash(b->heights)) &&
           wr_hash_equal(wr_field_hash(a->cover), wr_field_hash(b->cover));
}

static int soup(WrZSolid *solids, int count, double span, TestRandom *r)
{
    for (int i = 0; i < count; i++) {
        double turn[9], angles[3];
        for (int k = 0; k < 3; k++) angles[k] = 360.0 * test_random(r);
        wr_z_turn(angles, turn);
        double size = 2.0 + 12.0 * test_random(r);
        int shape = i % WR_Z_LETTERS;
        solids[i] = solid_of((WrZShape)shape, shape == WR_Z_TORUS ? 0.3 : 0.5, size, size, size,
                             turn, floor(span * test_random(r)), floor(span * test_random(r)), 0);
    }
    return count;
}

static void hc80_equal_and_coplanar_depths_do_not_depend_on_the_order(void **state)
{
    (void)state;
    TestRandom r = { 80 };
    WrField *like = table_of(150, 100);
    WrZSolid solids[42], turned[42];
    WrZTriangle mesh[2 * MESH * MESH + 2], other[2 * MESH * MESH + 2];
    int count = soup(solids, 40, 150.0, &r), triangles = jittered_square(mesh, 9.1, 7.2, 8.0, &r);
    solids[40] = solids[3]; /* duplicates, and coplanar tops */
    solids[41] = solids[1];
    count += 2;
    mesh[triangles] = (WrZTriangle){ { 20, 60, 20 }, { 20, 20, 60 }, { 5.5, 15.5, 0.5 } };
    mesh[triangles + 1] = mesh[0]; /* in the mesh's own plane */
    triangles += 2;
    for (int i = 0; i < count; i++) turned[i] = solids[count - 1 - i];
    for (int i = 0; i < triangles; i++) other[i] = mesh[triangles - 1 - i];
    WrZScene a = { solids, count, mesh, triangles, 0.0, 0.0, 0.5, 0.0, false };
    WrZScene b = { turned, count, other, triangles, 0.0, 0.0, 0.5, 0.0, false };
    WrRelief one = drawn(&a, like, NULL), two = drawn(&b, like, NULL);
    assert_true(same_relief(&one, &two));
    wr_relief_fini(&one);
    wr_relief_fini(&two);
    wr_field_free(like);
}

static void hc80_any_number_of_threads_gives_the_same_bytes(void **state)
{
    (void)state;
    TestRandom r = { 81 };
    WrField *like = table_of(333, 210);
    WrZSolid solids[200];
    int count = soup(solids, 200, 333.0, &r);
    WrZScene scene = { .solids = solids, .solid_count = count, .scale = 1.0, .soft = 2.0 };
    WrRelief first = drawn(&scene, like, NULL);
    for (int threads = 1; threads <= 3; threads++) {
        WrPool *pool = wr_pool_new(threads);
        WrRelief again = drawn(&scene, like, pool);
        assert_true(same_relief(&first, &again));
        wr_relief_fini(&again);
        wr_pool_free(pool);
    }
    wr_relief_fini(&first);
    wr_field_free(like);
}

static void what_moves_by_whole_texels_rolls_bit_for_bit(void **state)
{
    (void)state;
    TestRandom r = { 82 };
    const int w = 150, h = 110, di = 67, dj = -31; /* dj upwards */
    WrField *like = table_of(w, h);
    WrZSolid solids[60];
    WrZTriangle mesh[2 * MESH * MESH];
    int count = soup(solids, 60, 150.0, &r), triangles = jittered_square(mesh, 9.1, 7.2, 8.0, &r);
    for (int i = 0; i < count; i++) solids[i].at[0] = wr_z_place(solids[i].at[0] + test_random(&r));
    for (int i = 0; i < triangles; i++)
        for (int k = 0; k < 3; k++) {
            mesh[i].x[k] = wr_z_place(mesh[i].x[k]);
            mesh[i].y[k] = wr_z_place(mesh[i].y[k]);
        }
    WrZScene scene = { solids, count, mesh, triangles, 0.0, 0.0, 1.0, 0.0, false };
    WrRelief still = drawn(&scene, like, NULL);
    for (int i = 0; i < count; i++) {
        solids[i].at[0] += di;
        solids[i].at[1] -= dj;
    }
    for (int i = 0; i < triangles; i++)
        for (int k = 0; k < 3; k++) {
            mesh[i].x[k] += di - 3 * w;
            mesh[i].y[k] -= dj - 2 * h;
        }
    WrRelief moved = drawn(&scene, like, NULL);
    assert_true(is_rolled(still.heights, moved.heights, di, dj));
    assert_true(is_rolled(still.cover, moved.cover, di, dj));
    assert_false(is_rolled(still.heights, moved.heights, di + 1, dj));
    wr_relief_fini(&still);
    wr_relief_fini(&moved);
    wr_field_free(like);
}

/* ---- coverage and the ground ---- */

static void coverage_sums_to_the_area_that_is_seen(void **state)
{
    (void)state;
    WrField *like = table_of(64, 64);
    const struct {
        WrZShape shape;
        double param, size, area;
    } cases[] = {
        { WR_Z_SPHERE, 0, 17.3, M_PI * 17.3 * 17.3 },
        { WR_Z_BOX, 0, 11.37, 4.0 * 11.37 * 11.37 },
        { WR_Z_CYLINDER, 0, 9.21, M_PI * 9.21 * 9.21 },
        { WR_Z_TORUS, 0.4, 15.0, 4.0 * M_PI * 15.0 * 6.0 },
        { WR_Z_TORUS, 0.02, 20.0, 4.0 * M_PI * 20.0 * 0.4 }, /* thinner than a texel */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double s = cases[i].size, sum = 0.0;
        WrZSolid solid = solid_of(cases[i].shape, cases[i].param, s, s, s, upright, 31.3, 63.6, 0);
        WrRelief relief = drawn_solid(&solid, like);
        for (int k = 0; k < 64 * 64; k++) sum += (double)wr_field_get(relief.cover, k % 64, k / 64);
        assert_near(sum, cases[i].area, 0.01 * cases[i].area + 0.5);
        wr_relief_fini(&relief);
    }
    wr_field_free(like);
}

/* Sunk by 6 of 10: a cap of radius 8. */
static void what_is_below_the_ground_is_neither_seen_nor_covers(void **state)
{
    (void)state;
    WrField *like = wr_field_new(40, 40, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, NULL);
    WrZSolid sphere = solid_of(WR_Z_SPHERE, 0, 10, 10, 10, upright, 20, 20, -6);
    WrZScene scene = { .solids = &sphere, .solid_count = 1, .scale = 2.0, .offset = 0.5 };
    WrRelief relief = drawn(&scene, like, NULL);
    scene.soft = 3.0;
    WrRelief soft = drawn(&scene, like, NULL);
    double area = 0.0;
    for (int j = 0; j < 40; j++)
        for (int i = 0; i < 40; i++) {
            double d = hypot(i - 20, j - 20), cover = (double)wr_field_get(relief.cover, i, j);
            double z = sqrt(fmax(0.0, 100.0 - d * d)) - 6.0, t = fmin(1.0, fmax(0.0, z / 3.0));
            area += cover;
            if (d > 8.71) assert_true(cover == 0.0);
            if (d > 7.99) continue;
            assert_near((double)wr_field_get(relief.heights, i, j), 0.5 + 2.0 * z, 1e-5);
            assert_near((double)wr_field_get(soft.cover, i, j), cover * t * t * (3.0 - 2.0 * t),
                        1e-6);
        }
    assert_near(area, M_PI * 64.0, 2.0);
    wr_relief_fini(&relief);
    wr_relief_fini(&soft);
    wr_field_free(like);
}

/* A low plate under a high one whose edge halves a column of texels. */
static void the_rim_of_a_solid_over_another_is_smoothed(void **state)
{
    (void)state;
    WrField *like = wr_field_new(40, 40, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, NULL);
    WrZSolid plates[2] = { solid_of(WR_Z_BOX, 0, 15, 15, 1, upright, 20, 20, 1),
                           solid_of(WR_Z_BOX, 0, 5, 5, 1, upright, 20, 20, 9) };
    WrZScene scene = { .solids = plates, .solid_count = 2, .scale = 1.0 };
    WrRelief relief = drawn(&scene, like, NULL);
    assert_near((double)wr_field_get(relief.heights, 20, 20), 10.0, 0.0);
    assert_near((double)wr_field_get(relief.heights, 15, 20), 6.0, 1.0);
    assert_near((double)wr_field_get(relief.heights, 25, 20), 6.0, 1.0);
    assert_near((double)wr_field_get(relief.heights, 14, 20), 2.0, 0.0);
    assert_near((double)wr_field_get(relief.heights, 5, 20), 2.0, 0.0); /* the outer edge */
    wr_relief_fini(&relief);
    wr_field_free(like);
}

/* ---- errors ---- */

static void expect_error(const WrZScene *scene, const WrField *like, const char *words)
{
    WrGenerateJob job = { .like = like };
    WrRelief relief = { 0 };
    WrError err = { "" };
    assert_false(wr_zbuffer_draw(scene, &job, &relief, &err));
    if (!strstr(err.text, words)) fail_msg("%s: has not: %s", err.text, words);
    assert_null(relief.heights);
}

static void wild_places_give_one_error_with_the_first_ones_number(void **state)
{
    (void)state;
    WrField *like = table_of(4, 4);
    WrZTriangle t[2] = { { { 0, 3, 0 }, { 0, 0, 3 }, { 1, 1, 1 } },
                         { { 0, 3, 0 }, { 0, 0, 3 }, { 1, NAN, 1 } } };
    WrZScene scene = { .triangles = t, .triangle_count = 2, .scale = 1 };
    expect_error(&scene, like, "triangle 2");
    t[0].x[2] = INFINITY;
    expect_error(&scene, like, "triangle 1");
    t[0].x[2] = 2e6;
    expect_error(&scene, like, "within 524288");
    WrZSolid s = solid_of(WR_Z_SPHERE, 0, 5, 5, 5, upright, 0, 2e7, 0);
    scene = (WrZScene){ .solids = &s, .solid_count = 1, .scale = 1 };
    expect_error(&scene, like, "solid 1");
    s = solid_of(WR_Z_SPHERE, 0, 1e5, 1e5, 1e5, upright, 0, 0, 0);
    expect_error(&scene, like, "at most");
    wr_field_free(like);
}

static void triangles_without_area_or_of_extreme_shape_are_harmless(void **state)
{
    (void)state;
    WrField *like = table_of(50, 50);
    const WrZTriangle t[] = {
        { { 5, 5, 5 }, { 5, 5, 5 }, { 1, 2, 3 } },
        { { 0, 49, 98 }, { 0, 49, 98 }, { 1, 2, 3 } },
        { { 0, 40, 40 }, { 10, 10.004, 10 }, { -1e300, 1e300, 1e300 } },
        { { 10, 10.001, 10 }, { 10, 10, 10.001 }, { 7, 7, 7 } },
        { { -5e5, 5e5, 0 }, { -5e5, -5e5, 5e5 }, { 0.25, 0.25, 0.25 } },
    };
    for (int i = 0; i < 5; i++) {
        WrZScene scene = { .triangles = &t[i], .triangle_count = 1, .floor = -1e9, .scale = 1e10 };
        WrField *clamp = wr_field_new(50, 50, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, NULL);
        WrRelief relief = drawn(&scene, clamp, NULL);
        for (int k = 0; k < 2500; k++)
            assert_true(isfinite(wr_field_get(relief.heights, k % 50, k / 50)));
        if (i < 2) assert_near((double)wr_field_get(relief.cover, 5, 5), 0.0, 0.0);
        if (i == 4) assert_near((double)wr_field_get(relief.heights, 7, 9), 2.5e9, 1.0);
        wr_relief_fini(&relief);
        wr_field_free(clamp);
    }
    wr_field_free(like);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hc79_a_sphere_is_its_square_root_however_large_small_or_far_off),
        cmocka_unit_test(hc79_a_sphere_larger_than_a_periodic_table_is_the_highest_of_its_images),
        cmocka_unit_test(every_solid_in_any_pose_is_what_marching_along_rays_finds),
        cmocka_unit_test(a_torus_on_its_edge_has_the_outer_circle_as_its_top),
        cmocka_unit_test(a_mesh_has_no_cracks_and_no_sample_is_covered_twice),
        cmocka_unit_test(a_fine_mesh_of_a_sphere_is_the_sphere_within_its_chords),
        cmocka_unit_test(hc80_equal_and_coplanar_depths_do_not_depend_on_the_order),
        cmocka_unit_test(hc80_any_number_of_threads_gives_the_same_bytes),
        cmocka_unit_test(what_moves_by_whole_texels_rolls_bit_for_bit),
        cmocka_unit_test(coverage_sums_to_the_area_that_is_seen),
        cmocka_unit_test(what_is_below_the_ground_is_neither_seen_nor_covers),
        cmocka_unit_test(the_rim_of_a_solid_over_another_is_smoothed),
        cmocka_unit_test(wild_places_give_one_error_with_the_first_ones_number),
        cmocka_unit_test(triangles_without_area_or_of_extreme_shape_are_harmless),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

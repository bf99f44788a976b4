/* Hidden parts are not rasterised, without changing any visible bit; work is counted in rasterised squares, so that
   the speed of the machine does not matter. */
#include "test.h"

#include "base/error.h"
#include "base/hash.h"
#include "field/field.h"
#include "generate/zbuffer.h"

#include <string.h>

static double between(TestRandom *r, double low, double high)
{
    return low + (high - low) * test_random(r);
}

static double sometimes(TestRandom *r, double value)
{
    return test_random(r) < 0.5 ? value : 0.0;
}

/* Square letters: a frame of `size` with a hole. */
static WrZLetters *frame(double size)
{
    double h = 0.5 * size, q = 0.2 * size;
    double outer[] = { -h, -h, h, -h, h, h, -h, h }, inner[] = { -q, -q, -q, q, q, q, q, -q };
    const WrZContour contours[] = { { outer, 4 }, { inner, 4 } };
    WrError err;
    return wr_zletters_new(contours, 2, 0.25 * size, 0.05 * size, WR_Z_BEVEL_ROUND, &err);
}

/* Copies of one shape as placed by the solids' commands: at random, or on a lattice, upright or rotated. */
static WrZSolid *crowd(TestRandom *r, WrZShape shape, const WrZLetters *letters, int count,
                       double size)
{
    WrZSolid *solids = calloc((size_t)count, sizeof *solids);
    const double angles[3] = { sometimes(r, between(r, -90, 90)), sometimes(r, between(r, -90, 90)),
                               sometimes(r, between(r, -90, 90)) };
    double turn[9], loose = sometimes(r, 0.2), vary = sometimes(r, 0.5), param = 0.4;
    double tall = between(r, 0.3, 1.5);
    bool lattice = test_random(r) < 0.5;
    wr_z_turn(angles, turn);
    for (int i = 0; i < count; i++) {
        WrError err;
        double scale = shape == WR_Z_LETTERS ? 1.0 : size * (1.0 + vary * (test_random(r) - 0.5));
        const double sizes[3] = { scale, scale, shape <= WR_Z_CONE ? scale * tall : scale };
        const double at[3] = { lattice ? 3.5 * (i % 16) : between(r, 0, 64),
                               lattice ? 2.25 * (i / 16) : between(r, 0, 64),
                               loose * size * test_random(r) - sometimes(r, 0.3 * size) };
        assert_true(wr_zsolid_set(&solids[i], shape, param, letters, sizes, turn, at, &err));
    }
    return solids;
}

static WrHash hash_of(const WrZScene *scene, const WrField *like, int64_t *squares)
{
    WrGenerateJob job = { .like = like };
    WrRelief relief = { 0 };
    WrError err = { "" };
    int64_t before = wr_zbuffer_squares();
    if (!wr_zbuffer_draw(scene, &job, &relief, &err)) fail_msg("%s", err.text);
    *squares = wr_zbuffer_squares() - before;
    WrHash hashes[2] = { wr_field_hash(relief.heights), wr_field_hash(relief.cover) };
    wr_relief_fini(&relief);
    return wr_hash_bytes(hashes, sizeof hashes, (WrHash){ 0, 0 });
}

static void what_is_hidden_changes_no_bit(void **state)
{
    (void)state;
    int rounds = getenv("WR_FULL") ? 300 : 30;
    TestRandom r = { 12 };
    int64_t with = 0, without = 0;
    for (int round = 0; round < rounds; round++) {
        WrZShape shape = (WrZShape)(round % WR_Z_SHAPES);
        double size = between(&r, 4, round % 3 ? 40 : 300);
        int count = 40 + (int)between(&r, 0, 200), side = (int)between(&r, 20, 150);
        WrZLetters *letters = shape == WR_Z_LETTERS ? frame(size) : NULL;
        WrZSolid *solids = crowd(&r, shape, letters, size > 40 ? 5 : count, size);
        WrWrap wrap = test_random(&r) < 0.8 ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP;
        WrField *like = wr_field_new(side, side, wrap, WR_WRAP_PERIODIC, 0.0f, NULL);
        WrZScene scene = { .solids = solids,
                           .solid_count = size > 40 ? 5 : count,
                           .soft = sometimes(&r, 5.0),
                           .scale = 0.3 };
        int64_t few, all;
        WrHash culled = hash_of(&scene, like, &few);
        scene.hidden = true;
        WrHash whole = hash_of(&scene, like, &all);
        if (!wr_hash_equal(culled, whole))
            fail_msg("round %d: shape %d, size %g: other bits where hidden ones are left out",
                     round, (int)shape, size);
        with += few;
        without += all;
        wr_field_free(like);
        free(solids);
        wr_zletters_free(letters);
    }
    if (getenv("WR_TELL")) printf("%lld of %lld squares\n", (long long)with, (long long)without);
    assert_true(2 * with < without);
}

static void hidden_triangles_change_no_bit(void **state)
{
    (void)state;
    TestRandom r = { 13 };
    for (int round = 0; round < 20; round++) {
        int count = 2000;
        WrZTriangle *triangles = calloc((size_t)count, sizeof *triangles);
        for (int i = 0; i < count; i++)
            for (int k = 0; k < 3; k++) {
                triangles[i].x[k] = wr_z_place(between(&r, -40, 120));
                triangles[i].y[k] = wr_z_place(between(&r, -40, 120));
                triangles[i].z[k] = between(&r, -5, 20);
            }
        WrField *like = wr_field_new(70, 90, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
        WrZScene scene = { .triangles = triangles, .triangle_count = count, .scale = 1.0 };
        int64_t none;
        WrHash culled = hash_of(&scene, like, &none);
        scene.hidden = true;
        assert_true(wr_hash_equal(culled, hash_of(&scene, like, &none)));
        wr_field_free(like);
        free(triangles);
    }
}

/* The largest possible disc on the smallest table: only the parts left by its first copies are rasterised. */
static void a_solid_larger_than_the_table_costs_what_is_seen(void **state)
{
    (void)state;
    static const struct {
        WrZShape shape;
        double size;
        int64_t most; /* squares */
    } cases[] = { { WR_Z_CYLINDER, 4096, 40000 },
                  { WR_Z_BOX, 4096, 40000 },
                  { WR_Z_SPHERE, 4096, 60000 } };
    const double upright[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        WrError err;
        WrZSolid solid;
        const double sizes[3] = { cases[i].size, cases[i].size, 100 }, at[3] = { 31.25, 30.5, 0 };
        const double ball[3] = { cases[i].size, cases[i].size, cases[i].size };
        assert_true(wr_zsolid_set(&solid, cases[i].shape, 0.4, NULL,
                                  cases[i].shape == WR_Z_SPHERE ? ball : sizes, upright, at, &err));
        WrField *like = wr_field_new(64, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
        WrZScene scene = { .solids = &solid, .solid_count = 1, .scale = 1.0 };
        int64_t squares;
        hash_of(&scene, like, &squares);
        if (getenv("WR_TELL")) printf("shape %d: %lld squares\n", (int)i, (long long)squares);
        if (squares > cases[i].most)
            fail_msg("shape %d: %lld squares were drawn", (int)cases[i].shape, (long long)squares);
        wr_field_free(like);
    }
}

/* Lattices much closer than the copies' width: in a square of the table almost all copies are hidden by the others
   together. */
static void copies_in_copies_cost_what_is_seen(void **state)
{
    (void)state;
    static const struct {
        WrZShape shape;
        int64_t most; /* squares */
    } cases[] = { { WR_Z_TORUS, 90000 }, { WR_Z_SPHERE, 9000 }, { WR_Z_BOX, 900 } };
    enum { ALONG = 64 };
    const double upright[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, size[3] = { 32, 32, 32 };
    WrZSolid *solids = calloc((size_t)ALONG * ALONG, sizeof *solids);
    WrField *like = wr_field_new(64, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int k = 0; k < ALONG * ALONG; k++) {
            const double at[3] = { k % ALONG + 0.25, (double)k / ALONG, 0 };
            assert_true(
                wr_zsolid_set(&solids[k], cases[i].shape, 0.3, NULL, size, upright, at, NULL));
        }
        WrZScene scene = { .solids = solids, .solid_count = ALONG * ALONG, .scale = 1.0 };
        int64_t squares;
        hash_of(&scene, like, &squares);
        if (getenv("WR_TELL")) printf("shape %d: %lld squares\n", (int)i, (long long)squares);
        if (squares > cases[i].most)
            fail_msg("shape %d: %lld squares were drawn", (int)cases[i].shape, (long long)squares);
    }
    wr_field_free(like);
    free(solids);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_hidden_changes_no_bit),
        cmocka_unit_test(hidden_triangles_change_no_bit),
        cmocka_unit_test(a_solid_larger_than_the_table_costs_what_is_seen),
        cmocka_unit_test(copies_in_copies_cost_what_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

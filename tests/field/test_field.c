/* The height table: tiles, sharing, reading beyond the edges, hashes. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "field/field.h"

#include <float.h>

static WrField *new_field(int width, int height, WrWrap u, WrWrap v, float level)
{
    WrError err;
    WrField *field = wr_field_new(width, height, u, v, level, &err);
    if (!field) fail_msg("%s", err.text);
    return field;
}

static WrField *random_field(int width, int height, WrWrap u, WrWrap v, uint64_t seed)
{
    WrField *field = new_field(width, height, u, v, 0.0f);
    TestRandom random = { seed };
    float row[WR_FIELD_MAX];
    for (int j = 0; j < height; j++) {
        for (int i = 0; i < width; i++) row[i] = (float)(test_random(&random) - 0.5);
        assert_int_equal(wr_field_write(field, 0, j, width, 1, row, 0), 0);
    }
    return field;
}

static int modulus(int i, int n)
{
    return ((i % n) + n) % n;
}

static void sizes_out_of_range_are_refused_with_the_value(void **state)
{
    (void)state;
    const int bad[][2] = { { 0, 5 }, { 5, 0 }, { -3, 5 }, { 16385, 5 }, { 5, INT32_MAX } };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        WrError err = { "" };
        char size[40];
        snprintf(size, sizeof size, "%dx%d", bad[k][0], bad[k][1]);
        assert_null(wr_field_new(bad[k][0], bad[k][1], WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0, &err));
        assert_non_null(strstr(err.text, size));
    }
}

static void texels_of_any_size_of_table_read_back(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 },     { 1, 7 },     { 9, 1 },    { 3, 3 },  { 48, 100 },
                             { 16384, 1 }, { 1, 16384 }, { 513, 65 }, { 64, 64 } };
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        int width = sizes[k][0], height = sizes[k][1];
        WrField *field = new_field(width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, -1.0f);
        assert_int_equal(wr_field_width(field), width);
        assert_int_equal(wr_field_height(field), height);
        for (int j = 0; j < height; j++)
            for (int i = 0; i < width; i++)
                if ((i + j) % 3) wr_field_set(field, i, j, (float)(i + 0.5 * j));
        for (int j = 0; j < height; j++)
            for (int i = 0; i < width; i++)
                assert_true(wr_field_get(field, i, j) ==
                            ((i + j) % 3 ? (float)(i + 0.5 * j) : -1.0f));
        wr_field_free(field);
    }
}

static void a_share_and_its_source_do_not_see_each_others_writes(void **state)
{
    (void)state;
    WrField *a = random_field(300, 200, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 1);
    WrHash before = wr_field_hash(a);
    WrField *b = wr_field_share(a), *c = wr_field_share(b);
    assert_true(wr_field_key(a) == wr_field_key(b));
    wr_field_set(a, 70, 70, 5.0f);
    assert_true(wr_hash_equal(wr_field_hash(b), before));
    wr_field_set(b, 0, 0, 6.0f);
    wr_field_fill(c, 7.0f);
    assert_true(wr_field_get(a, 70, 70) == 5.0f && wr_field_get(a, 0, 0) != 6.0f);
    assert_true(wr_field_get(b, 70, 70) != 5.0f && wr_field_get(b, 0, 0) == 6.0f);
    assert_true(wr_field_get(c, 0, 0) == 7.0f && wr_field_get(c, 299, 199) == 7.0f);
    assert_true(wr_field_key(a) != wr_field_key(b) && wr_field_key(b) != wr_field_key(c));
    wr_field_free(a);
    wr_field_set(b, 0, 0, 6.5f); /* its other tiles outlive a */
    assert_true(wr_field_get(b, 0, 0) == 6.5f);
    wr_field_free(b);
    wr_field_free(c);
}

static void every_write_changes_the_key(void **state)
{
    (void)state;
    WrField *field = new_field(10, 10, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f);
    uint64_t keys[5] = { wr_field_key(field) };
    float row[3] = { 1, 2, 3 };
    wr_field_set(field, 1, 1, 1.0f), keys[1] = wr_field_key(field);
    wr_field_tile_write(field, 0, 0), keys[2] = wr_field_key(field);
    wr_field_write(field, 0, 0, 3, 1, row, 3), keys[3] = wr_field_key(field);
    wr_field_fill(field, 0.0f), keys[4] = wr_field_key(field);
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < i; j++) assert_true(keys[i] != keys[j]);
    wr_field_free(field);
}

typedef struct Visits {
    int count, sum_x, sum_y;
} Visits;

static void note_visit(int tx, int ty, void *ctx)
{
    Visits *visits = ctx;
    visits->count++;
    visits->sum_x += tx;
    visits->sum_y += ty;
}

static Visits changes(const WrField *a, const WrField *b)
{
    Visits visits = { 0 };
    wr_field_changes(a, b, note_visit, &visits);
    return visits;
}

static void changes_are_the_tiles_written_since_the_share(void **state)
{
    (void)state;
    WrField *a = random_field(1000, 700, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 2);
    WrField *b = wr_field_share(a);
    assert_int_equal(changes(a, b).count, 0);
    wr_field_set(a, 64 * 3, 64 * 5, 1.0f);
    wr_field_set(a, 64 * 3 + 63, 64 * 5 + 63, 1.0f);
    wr_field_set(b, 999, 699, 1.0f);
    Visits visits = changes(a, b);
    assert_int_equal(visits.count, 2);
    assert_int_equal(visits.sum_x, 3 + 15);
    assert_int_equal(visits.sum_y, 5 + 10);
    wr_field_free(a);
    wr_field_free(b);
}

static void tables_of_different_levels_differ_in_every_tile(void **state)
{
    (void)state;
    WrField *a = new_field(1000, 700, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f);
    WrField *b = wr_field_share(a);
    wr_field_fill(b, 0.5f);
    assert_int_equal(changes(a, b).count, 16 * 11);
    wr_field_fill(b, 0.0f);
    assert_int_equal(changes(a, b).count, 0);
    wr_field_free(a);
    wr_field_free(b);
}

static void the_largest_table_costs_only_what_is_written(void **state)
{
    (void)state;
    WrField *a = new_field(16384, 16384, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.25f);
    assert_int_equal(wr_field_bytes(a), 0);
    WrField *b = wr_field_share(a);
    wr_field_set(b, 16383, 9000, 1.0f);
    Visits visits = changes(a, b);
    assert_int_equal(visits.count, 1);
    assert_int_equal(visits.sum_x, 255);
    assert_int_equal(visits.sum_y, 9000 / 64);
    assert_true(wr_field_bytes(b) < 20000);
    float low, high;
    wr_field_range(b, &low, &high);
    assert_true(low == 0.25f && high == 1.0f);
    wr_field_free(a);
    wr_field_free(b);
}

static void reads_wrap_by_true_modulus_at_any_index(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 3, 1 }, { 48, 100 }, { 64, 128 }, { 130, 65 } };
    const int corners[][2] = { { 0, 0 }, { -1, -1 }, { -300, 77 }, { 1000003, -2000003 } };
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        int width = sizes[k][0], height = sizes[k][1];
        WrField *field = random_field(width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, k);
        for (size_t c = 0; c < sizeof corners / sizeof *corners; c++) {
            enum { ACROSS = 150, DOWN = 140, PITCH = 153 };
            static float out[DOWN * PITCH];
            for (int p = 0; p < DOWN * PITCH; p++) out[p] = 99.0f;
            int i = corners[c][0], j = corners[c][1];
            wr_field_read(field, i, j, ACROSS, DOWN, out, PITCH);
            for (int y = 0; y < DOWN; y++) {
                for (int x = 0; x < ACROSS; x++)
                    assert_true(out[y * PITCH + x] ==
                                wr_field_get(field, modulus(i + x, width), modulus(j + y, height)));
                for (int x = ACROSS; x < PITCH; x++) assert_true(out[y * PITCH + x] == 99.0f);
            }
        }
        wr_field_free(field);
    }
}

/* Whole numbers, so that floats hold the polynomial exactly. */
static float quadratic(int i, int j)
{
    return (float)(3 + 2 * i - i * i + 5 * j + 2 * j * j - 3 * i * j);
}

static void reads_beyond_a_clamped_end_continue_a_quadratic_exactly(void **state)
{
    (void)state;
    WrField *field = new_field(70, 5, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f);
    for (int j = 0; j < 5; j++)
        for (int i = 0; i < 70; i++) wr_field_set(field, i, j, quadratic(i, j));
    float out[40 * 400];
    wr_field_read(field, -150, -20, 400, 40, out, 400);
    for (int j = 0; j < 40; j++)
        for (int i = 0; i < 400; i++) assert_true(out[400 * j + i] == quadratic(i - 150, j - 20));
    wr_field_read(field, 90, 7, 3, 2, out, 3); /* wholly outside */
    assert_true(out[0] == quadratic(90, 7) && out[5] == quadratic(92, 8));
    wr_field_free(field);
}

static void fewer_than_three_clamped_texels_are_repeated(void **state)
{
    (void)state;
    WrField *field = new_field(2, 1, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f);
    wr_field_set(field, 0, 0, 4.0f);
    wr_field_set(field, 1, 0, 9.0f);
    float out[3 * 6];
    wr_field_read(field, -2, -1, 6, 3, out, 6);
    const float expected[6] = { 4, 4, 4, 9, 9, 9 };
    for (int k = 0; k < 18; k++) assert_true(out[k] == expected[k % 6]);
    wr_field_free(field);
}

static void extrapolated_heights_stay_finite(void **state)
{
    (void)state;
    WrField *field = new_field(3, 3, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, 0.0f);
    wr_field_set(field, 0, 0, FLT_MAX);
    wr_field_set(field, 1, 0, -FLT_MAX);
    float out[2];
    wr_field_read(field, -1, 0, 1, 1, out, 1);
    wr_field_read(field, INT32_MIN, 0, 1, 1, out + 1, 1);
    assert_true(out[0] == FLT_MAX && out[1] == FLT_MAX);
    wr_field_free(field);
}

static void hc49_heights_that_are_not_finite_become_0_and_are_counted(void **state)
{
    (void)state;
    WrField *field = new_field(100, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1.0f);
    float row[5] = { NAN, INFINITY, FLT_MAX, -INFINITY, FLT_TRUE_MIN };
    assert_int_equal(wr_field_write(field, 62, 1, 5, 1, row, 5), 3);
    const float expected[5] = { 0, 0, FLT_MAX, 0, FLT_TRUE_MIN };
    for (int k = 0; k < 5; k++) assert_true(wr_field_get(field, 62 + k, 1) == expected[k]);
    wr_field_set(field, 0, 0, NAN);
    assert_true(wr_field_get(field, 0, 0) == 0.0f);
    wr_field_fill(field, INFINITY);
    assert_true(wr_field_level(field) == 0.0f);
    wr_field_free(field);
}

static void the_hash_depends_on_contents_alone(void **state)
{
    (void)state;
    WrField *level = new_field(100, 70, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 2.0f);
    WrField *painted = new_field(100, 70, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, -1.0f);
    for (int j = 0; j < 70; j++)
        for (int i = 0; i < 100; i++) wr_field_set(painted, i, j, 2.0f);
    assert_true(wr_hash_equal(wr_field_hash(level), wr_field_hash(painted)));
    wr_field_tile_write(level, 1, 1); /* a tile, with nothing new in it */
    assert_true(wr_hash_equal(wr_field_hash(level), wr_field_hash(painted)));
    wr_field_set(level, 99, 69, 3.0f);
    assert_false(wr_hash_equal(wr_field_hash(level), wr_field_hash(painted)));
    wr_field_set(painted, 99, 69, 3.0f);
    assert_true(wr_hash_equal(wr_field_hash(level), wr_field_hash(painted)));
    wr_field_free(level);
    wr_field_free(painted);
}

static void the_hash_tells_sizes_wraps_and_signs_of_zero_apart(void **state)
{
    (void)state;
    WrField *fields[] = { new_field(64, 128, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f),
                          new_field(128, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f),
                          new_field(64, 128, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, 0.0f),
                          new_field(64, 128, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0.0f),
                          new_field(64, 128, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, -0.0f),
                          new_field(64, 128, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f) };
    wr_field_set(fields[5], 63, 127, FLT_TRUE_MIN);
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < a; b++)
            assert_false(wr_hash_equal(wr_field_hash(fields[a]), wr_field_hash(fields[b])));
    for (int a = 0; a < 6; a++) wr_field_free(fields[a]);
}

static void the_range_counts_the_level_only_where_it_shows(void **state)
{
    (void)state;
    WrField *field = new_field(65, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 9.0f);
    float low, high;
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 65; i++) wr_field_set(field, i, j, (float)(i - j));
    wr_field_range(field, &low, &high); /* the second tile's unused texels still hold 9 */
    assert_true(low == -63.0f && high == 64.0f);
    assert_true(wr_field_tile(field, 1, 0)[5] == 9.0f);
    wr_field_free(field);
    field = new_field(65, 64, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 9.0f);
    wr_field_set(field, 0, 0, 10.0f);
    wr_field_range(field, &low, &high);
    assert_true(low == 9.0f && high == 10.0f);
    wr_field_free(field);
}

static void writing_what_is_there_makes_no_tile(void **state)
{
    (void)state;
    WrField *field = new_field(200, 200, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.5f);
    float *rows = wr_alloc(200 * 200, sizeof *rows);
    for (int k = 0; k < 200 * 200; k++) rows[k] = 0.5f;
    wr_field_write(field, 0, 0, 200, 200, rows, 200);
    assert_int_equal(wr_field_bytes(field), 0);
    rows[70 * 200 + 130] = 1.0f;
    wr_field_write(field, 0, 0, 200, 200, rows, 200);
    assert_non_null(wr_field_tile(field, 2, 1));
    assert_null(wr_field_tile(field, 1, 1));
    wr_free(rows);
    wr_field_free(field);
}

typedef struct Crowd {
    const WrField *source;
    WrHash expected;
    int bad; /* atomic */
} Crowd;

static void share_and_write(int index, int worker, void *ctx)
{
    (void)worker;
    Crowd *crowd = ctx;
    WrField *mine = wr_field_share(crowd->source), *copy = wr_field_share(mine);
    wr_field_set(mine, index % 200, index % 150, 1000.0f + (float)index);
    bool good = wr_hash_equal(wr_field_hash(copy), crowd->expected) &&
                !wr_hash_equal(wr_field_hash(mine), crowd->expected);
    if (!good) __atomic_fetch_add(&crowd->bad, 1, __ATOMIC_RELAXED);
    wr_field_free(copy);
    wr_field_free(mine);
}

static void many_threads_may_share_one_table_and_write_to_their_own(void **state)
{
    (void)state;
    WrField *source = random_field(200, 150, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 8);
    Crowd crowd = { source, wr_field_hash(source), 0 };
    WrPool *pool = wr_pool_new(4);
    wr_pool_run(pool, 400, share_and_write, &crowd);
    wr_pool_free(pool);
    assert_int_equal(crowd.bad, 0);
    assert_true(wr_hash_equal(wr_field_hash(source), crowd.expected));
    wr_field_free(source);
}

/* Borders of tiles that are not full, equal and different levels. */
static void a_shared_tile_is_the_others_until_one_is_written(void **state)
{
    (void)state;
    for (int same = 0; same < 2; same++) {
        WrField *from = random_field(200, 100, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 7);
        WrField *to = new_field(200, 100, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, same ? 0.0f : 2.5f);
        wr_field_tile_drop(from, 1, 1);
        uint64_t key = wr_field_key(to);
        for (int k = 0; k < 8; k++) wr_field_tile_share(to, from, k % 4, k / 4);
        assert_true(wr_field_key(to) != key);
        for (int j = 0; j < 100; j++)
            for (int i = 0; i < 200; i++)
                assert_true(same_bits(wr_field_get(to, i, j), wr_field_get(from, i, j)));
        assert_ptr_equal(wr_field_tile(to, 0, 0), wr_field_tile(from, 0, 0));
        assert_true((wr_field_tile(to, 3, 0) == wr_field_tile(from, 3, 0)) == same);
        const float *last = wr_field_tile(to, 3, 1); /* 8 columns and 36 rows are in use */
        assert_true(last[63] == wr_field_level(to) && last[63 * 64] == wr_field_level(to));
        float was = wr_field_get(from, 5, 6);
        wr_field_set(to, 5, 6, was + 1.0f);
        assert_true(wr_field_get(from, 5, 6) == was && wr_field_get(to, 5, 6) == was + 1.0f);
        wr_field_free(from);
        assert_true(wr_field_get(to, 5, 6) == was + 1.0f);
        wr_field_free(to);
    }
}

static void a_fresh_tile_is_no_ones_else_and_a_dropped_one_has_the_level(void **state)
{
    (void)state;
    WrField *field = random_field(128, 128, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 8);
    WrField *share = wr_field_share(field);
    float was = wr_field_get(share, 70, 3);
    float *fresh = wr_field_tile_fresh(field, 1, 0);
    for (int k = 0; k < WR_TILE * WR_TILE; k++) fresh[k] = (float)k;
    assert_true(wr_field_get(share, 70, 3) == was && wr_field_get(field, 70, 3) == 3 * 64 + 6);
    assert_ptr_equal(wr_field_tile_fresh(field, 1, 0), fresh);
    wr_field_tile_drop(field, 1, 0);
    assert_null(wr_field_tile(field, 1, 0));
    assert_true(wr_field_get(field, 70, 3) == 0.0f && wr_field_get(share, 70, 3) == was);
    wr_field_tile_drop(share, 0, 1);
    assert_non_null(wr_field_tile(field, 0, 1));
    wr_field_free(field);
    wr_field_free(share);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_out_of_range_are_refused_with_the_value),
        cmocka_unit_test(texels_of_any_size_of_table_read_back),
        cmocka_unit_test(a_share_and_its_source_do_not_see_each_others_writes),
        cmocka_unit_test(every_write_changes_the_key),
        cmocka_unit_test(changes_are_the_tiles_written_since_the_share),
        cmocka_unit_test(tables_of_different_levels_differ_in_every_tile),
        cmocka_unit_test(the_largest_table_costs_only_what_is_written),
        cmocka_unit_test(reads_wrap_by_true_modulus_at_any_index),
        cmocka_unit_test(reads_beyond_a_clamped_end_continue_a_quadratic_exactly),
        cmocka_unit_test(fewer_than_three_clamped_texels_are_repeated),
        cmocka_unit_test(extrapolated_heights_stay_finite),
        cmocka_unit_test(hc49_heights_that_are_not_finite_become_0_and_are_counted),
        cmocka_unit_test(the_hash_depends_on_contents_alone),
        cmocka_unit_test(the_hash_tells_sizes_wraps_and_signs_of_zero_apart),
        cmocka_unit_test(the_range_counts_the_level_only_where_it_shows),
        cmocka_unit_test(writing_what_is_there_makes_no_tile),
        cmocka_unit_test(many_threads_may_share_one_table_and_write_to_their_own),
        cmocka_unit_test(a_shared_tile_is_the_others_until_one_is_written),
        cmocka_unit_test(a_fresh_tile_is_no_ones_else_and_a_dropped_one_has_the_level),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

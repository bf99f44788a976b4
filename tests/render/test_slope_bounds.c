/* Samples where the table has no slope skip bump mapping: the picture is bit-identical to the full computation. */
#include "test.h"
#include "field/scheme_list.h"
#include "render_scenes.h"

#include "render/textures/slope_pyramid.h"
#include "render/textures/height_copies.h"

/* Level except for a few texels, often beside a tile's border or the table's end. */
static WrField *spotted_field(int w, int h, TestRandom *random)
{
    const WrWrap u = test_random(random) < 0.5 ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP;
    const WrWrap v = test_random(random) < 0.5 ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP;
    const float ground = (float)(test_random(random) - 0.5);
    WrField *field = wr_field_new(w, h, u, v, ground, NULL);
    const int step = test_random(random) < 0.4 ? WR_TILE : 0; /* one whole tile is higher */
    for (int j = 0; j < step; j++)
        for (int i = 0; i < step; i++) wr_field_set(field, i, j, ground + 0.3f);
    for (int k = 0; k < 3; k++) {
        const bool edge = test_random(random) < 0.6;
        int i = (int)(w * test_random(random)), j = (int)(h * test_random(random));
        if (edge) i = i / WR_TILE * WR_TILE - (int)(2 * test_random(random));
        if (edge) j = j / WR_TILE * WR_TILE - (int)(2 * test_random(random));
        i = (i + w) % w, j = (j + h) % h;
        wr_field_set(field, i, j, ground + (float)test_random(random));
    }
    return field;
}

static WrScene *some_scene(TestRandom *random)
{
    static const char *const surfaces[] = { "sphere", "plane", "cube", "torus", "cylinder" };
    static const double replications[] = { 1, 1, -1, 2, 0.37, -2.61, 7 };
    WrScene *scene = scene_of(surfaces[(int)(5 * test_random(random))]);
    scene->replicate_u = replications[(int)(7 * test_random(random))];
    scene->replicate_v = replications[(int)(7 * test_random(random))];
    scene->scheme = (WrScheme)(WR_SCHEME_COUNT * test_random(random));
    scene->bump = test_random(random) < 0.7 ? WR_BUMP_BLINN : WR_BUMP_INVARIANT;
    scene->height = 0.2;
    scene->camera.orthographic = test_random(random) < 0.5;
    scene->camera.size = test_random(random) < 0.5 ? 0.5 : 2.2;
    scene->dials.aa = test_random(random) < 0.6 ? WR_AA_POINT : WR_AA_SUPERSAMPLE;
    scene->dials.samples = 3;
    return scene;
}

static void what_is_spared_shows_nowhere(void **state)
{
    (void)state;
    TestRandom random = { 21 };
    int spared = 0, partly = 0;
    for (int k = 0; k < (getenv("WR_FULL") ? 1500 : 150); k++) {
        const int w = 70 + (int)(500 * test_random(&random)),
                  h = 65 + (int)(400 * test_random(&random));
        WrField *field = spotted_field(w, h, &random);
        WrScene *scene = some_scene(&random);
        const int size = 40 + (int)(90 * test_random(&random));
        Shot planned = shoot(scene, field, 3 * size, size, 1 + k % 3, "auto", false);
        Shot full = shoot(scene, field, 3 * size, size, 1, "auto", true);
        const WrPlanRow *bump = &planned.frame.plan->rows[WR_EFFECT_BUMP];
        const bool even =
            scene->bump == WR_BUMP_BLINN || planned.frame.plan->bump == WR_BUMP_INVARIANT;
        if (even && !same_picture(&planned, &full))
            fail_msg("table %d: off by %g", k, (double)worst_difference(&planned, &full));
        assert_int_equal(full.frame.plan->rows[WR_EFFECT_BUMP].pixels, full.frame.shaded);
        assert_in_range(bump->pixels, 0, planned.frame.shaded);
        spared += bump->run && bump->pixels < planned.frame.shaded;
        partly += bump->pixels > 0 && bump->pixels < planned.frame.shaded;
        put_away(&planned);
        put_away(&full);
        wr_scene_free(scene);
        wr_field_free(field);
    }
    assert_in_range(spared, 15, 1500); /* otherwise nothing was tested */
    assert_in_range(partly, 10, 1500);
}

static bool box_is_level(const WrLevel *level, double u0, double u1, double v0, double v1)
{
    float found[2];
    wr_level_box(level, u0, u1, v0, v1, found);
    return found[0] == 0 && found[1] == 0;
}

/* The bound of a box against every texel it could read. */
static void no_tile_that_a_box_reads_is_steeper_than_it_says(void **state)
{
    (void)state;
    TestRandom random = { 9 };
    int yes = 0, level_boxes = 0;
    for (int k = 0; k < 20000; k++) {
        float steep[4 * 3][2] = { { 0 } }, found[2];
        WrLevel level = { .steep = (const float(*)[2])steep,
                          .steepest = { 9, 9 },
                          .width = 193 + (int)(60 * test_random(&random)),
                          .height = 130 + (int)(60 * test_random(&random)),
                          .ru = 6 * test_random(&random) - 3,
                          .rv = 6 * test_random(&random) - 3,
                          .periodic_u = k & 1,
                          .periodic_v = k & 2 };
        level.tiles_u = 4, level.tiles_v = 3;
        for (int i = 0; i < 12; i++)
            for (int c = 0; c < 2; c++)
                steep[i][c] = test_random(&random) < 0.1 ? (float)test_random(&random) : 0;
        const double u0 = test_random(&random), u1 = u0 + 0.2 * test_random(&random);
        const double v0 = test_random(&random), v1 = v0 + 0.2 * test_random(&random);
        wr_level_box(&level, u0, u1, v0, v1, found);
        yes += found[0] < 9;
        level_boxes += found[0] == 0 && found[1] == 0;
        for (int s = 0; s < 100; s++) {
            double u = level.ru * (u0 + (u1 - u0) * test_random(&random));
            double v = level.rv * (v0 + (v1 - v0) * test_random(&random));
            u = level.periodic_u ? u - floor(u) : fmin(fmax(u, 0), 1);
            v = level.periodic_v ? v - floor(v) : fmin(fmax(v, 0), 1);
            for (int tap = 0; tap < 4; tap++) {
                int i = (int)floor(level.width * u - 0.5) + tap % 2;
                int j = (int)floor(level.height * (1 - v) - 0.5) + tap / 2;
                i = level.periodic_u ? (i + level.width) % level.width : i < 0 ? 0 : i;
                j = level.periodic_v ? (j + level.height) % level.height : j < 0 ? 0 : j;
                i = i < level.width ? i : level.width - 1;
                j = j < level.height ? j : level.height - 1;
                for (int c = 0; c < 2; c++)
                    if (steep[j / WR_TILE * 4 + i / WR_TILE][c] > found[c])
                        fail_msg("box %d reads texel %d,%d, whose tile is steeper", k, i, j);
            }
        }
    }
    assert_in_range(yes, 500, 20000);
    assert_in_range(level_boxes, 500, 20000);
    const float nothing[1][2] = { { 0 } };
    const WrLevel none = { .steep = nothing,
                           .steepest = { 9, 9 },
                           .tiles_u = 1,
                           .tiles_v = 1,
                           .width = 8,
                           .height = 8,
                           .ru = 1,
                           .rv = 1 };
    assert_true(box_is_level(&none, 0, 1, 0, 1));
    assert_false(box_is_level(&none, NAN, 1, 0, 1));
    assert_false(box_is_level(&none, 0, 1, 0, NAN));
}

/* Edits anywhere, also in level areas, at corners and ends: every pixel equals a new picture. */
static void edits_show_wherever_they_are(void **state)
{
    (void)state;
    TestRandom random = { 33 };
    WrError err = { "" };
    const int rounds = getenv("WR_FULL") ? 10 : 2;
    for (int k = 0; k < rounds; k++) {
        const int w = 70 + (int)(300 * test_random(&random)),
                  h = 65 + (int)(200 * test_random(&random));
        WrField *field = spotted_field(w, h, &random);
        WrScene *scene = some_scene(&random);
        WrPool *pool = wr_pool_new(1 + k % 3);
        WrRenderer *renderer = wr_renderer_new(pool, NULL, &err);
        for (int edit = 0; edit < 50; edit++) {
            WrFrame frame;
            const WrFrameRequest request = { .field = field,
                                             .scene = scene,
                                             .width = 150,
                                             .height = 70,
                                             .turn_deg = 15,
                                             .keep = true };
            if (!wr_renderer_frame(renderer, &request, &frame, &err)) fail_msg("%s", err.text);
            Shot fresh = shoot(scene, field, 150, 70, 1, "auto", false);
            if (memcmp(frame.rgba, fresh.frame.rgba, frame_bytes(&frame)) != 0)
                fail_msg("table %d (%dx%d), after edit %d", k, w, h, edit);
            put_away(&fresh);
            WrField *next = wr_field_share(field);
            const int i = edit % 5 == 0 ? (edit % 2) * (w - 1) : (int)(w * test_random(&random));
            const int j = edit % 7 == 0 ? (edit % 2) * (h - 1) : (int)(h * test_random(&random));
            const float old = wr_field_get(next, i, j);
            wr_field_set(next, i, j, old + (float)(test_random(&random) - 0.5));
            wr_field_free(field);
            field = next;
        }
        free_view(renderer, pool, scene, field);
    }
}

/* The slope bound of a tile covers all fetches in it, including extrapolation past a clamped end. */
static void check_steep(const WrTable *table, const WrField *field, int k)
{
    const WrTableCopy *copy = &table->copies[WR_COPY_GRADIENT];
    const int w = wr_field_width(field), h = wr_field_height(field);
    const int out_u = wr_field_wrap_u(field) == WR_WRAP_CLAMP;
    const int out_v = wr_field_wrap_v(field) == WR_WRAP_CLAMP;
    for (int j = -out_v; j < h + out_v; j++)
        for (int i = -out_u; i < w + out_u; i++) {
            const int x = i < 0 ? 0 : i < w ? i : w - 1, y = j < 0 ? 0 : j < h ? j : h - 1;
            const int tile = y / WR_TILE * wr_field_tiles_u(field) + x / WR_TILE;
            const float *slope = copy->data + 2 * ((size_t)(j + WR_APRON) * (size_t)copy->pitch +
                                                   (size_t)(i + WR_APRON));
            if (fabsf(slope[0]) > table->steep[tile][0] || fabsf(slope[1]) > table->steep[tile][1])
                fail_msg("table %d: texel %d,%d is steeper than its tile", k, i, j);
        }
}

static void tiles_are_as_steep_as_what_is_read_of_them(void **state)
{
    (void)state;
    TestRandom random = { 759 };
    WrError err = { "" };
    WrPool *pool = wr_pool_new(2);
    for (int k = 0; k < 24; k++) {
        WrTable table;
        WrField *field = spotted_field(65 + 3 * k, 130 + k, &random);
        wr_table_init(&table);
        for (int edit = 0; edit < 6; edit++) {
            assert_true(wr_table_update(&table, WR_COPY_GRADIENT, field, pool, &err));
            check_steep(&table, field, k);
            WrField *next = wr_field_share(field);
            const int w = wr_field_width(field), h = wr_field_height(field);
            const int i = edit % 2 ? (int)(w * test_random(&random)) : (edit % 4 / 2) * (w - 1);
            const int j = edit % 3 ? (int)(h * test_random(&random)) : (edit % 2) * (h - 1);
            wr_field_set(next, i, j, (float)test_random(&random));
            wr_field_free(field);
            field = next;
        }
        wr_table_fini(&table);
        wr_field_free(field);
    }
    wr_pool_free(pool);
}

/* As numbers: 0 and -0 are the same. */
static void assert_same_copies(const WrTable *a, const WrTable *b, WrCopyKind kind, int rows)
{
    const WrTableCopy *one = &a->copies[kind], *other = &b->copies[kind];
    assert_int_equal(one->pitch, other->pitch);
    const size_t floats = kind == WR_COPY_GRADIENT ? 2 : 1;
    const size_t count = (size_t)one->pitch * (size_t)(rows + 2 * WR_APRON) * floats;
    for (size_t i = 0; i < count; i++)
        if (one->data ? one->data[i] != other->data[i] : one->fine[i] != other->fine[i])
            fail_msg("kind %d: number %zu differs", (int)kind, i);
}

/* Random heights in a random rectangle, from a point to most of the table. */
static void scatter(WrField *field, TestRandom *random)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const int i0 = (int)(w * test_random(random)), j0 = (int)(h * test_random(random));
    const double share = test_random(random);
    for (int j = j0; j <= j0 + (int)(0.8 * share * h) && j < h; j++)
        for (int i = i0; i <= i0 + (int)(0.8 * share * w) && i < w; i++)
            wr_field_set(field, i, j, (float)test_random(random));
}

static void edits_refresh_a_copy_to_the_bits_of_a_new_one(void **state)
{
    (void)state;
    TestRandom random = { 4321 };
    WrError err = { "" };
    WrPool *pool = wr_pool_new(3);
    for (int k = 0; k < 12; k++) {
        const int w = 700 + 37 * k, h = 900 - 29 * k, kind = k % WR_COPY_COUNT;
        const WrWrap u = k % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        const WrWrap v = k % 4 < 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrField *field = wr_field_new(w, h, u, v, 0, NULL);
        WrTable kept;
        wr_table_init(&kept);
        for (int edit = 0; edit < test_amount(6, 3); edit++) {
            WrTable fresh;
            wr_table_init(&fresh);
            assert_true(wr_table_update(&kept, (WrCopyKind)kind, field, pool, &err));
            assert_true(wr_table_update(&fresh, (WrCopyKind)kind, field, pool, &err));
            assert_same_copies(&kept, &fresh, (WrCopyKind)kind, h);
            if (kind == WR_COPY_GRADIENT)
                assert_memory_equal(kept.steep, fresh.steep,
                                    (size_t)wr_field_tiles_u(field) *
                                        (size_t)wr_field_tiles_v(field) * sizeof *kept.steep);
            wr_table_fini(&fresh);
            scatter(field, &random);
        }
        wr_table_fini(&kept);
        wr_field_free(field);
    }
    wr_pool_free(pool);
}

/* Empty tiles are left out of copies; those of a table that stores its zeros are not. Both are edited, and edits undone. */
static void empty_tiles_are_left_out_and_read_as_zeros(void **state)
{
    (void)state;
    TestRandom random = { 1612 };
    WrError err = { "" };
    WrPool *pool = wr_pool_new(2);
    for (int k = 0; k < 24; k++) {
        const int w = WR_TILE * (3 + k % 5), h = WR_TILE * (2 + k % 7), kind = k % WR_COPY_COUNT;
        const WrWrap u = k % 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        const WrWrap v = k % 4 < 2 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
        WrField *empty = wr_field_new(w, h, u, v, 0, NULL), *full = wr_field_share(empty);
        WrField *first = wr_field_share(empty);
        for (int ty = 0; ty < wr_field_tiles_v(full); ty++)
            for (int tx = 0; tx < wr_field_tiles_u(full); tx++) wr_field_tile_write(full, tx, ty);
        WrField *first_full = wr_field_share(full);
        WrTable tables[2];
        for (int n = 0; n < 2; n++) {
            wr_table_init(&tables[n]);
            if (k >= 12) tables[n].precision = WR_PRECISION_DOUBLE;
        }
        for (int edit = 0; edit < 7; edit++) {
            assert_true(wr_table_update(&tables[0], (WrCopyKind)kind, empty, pool, &err));
            assert_true(wr_table_update(&tables[1], (WrCopyKind)kind, full, pool, &err));
            assert_same_copies(&tables[0], &tables[1], (WrCopyKind)kind, h);
            const int i = edit % 2 ? (int)(w * test_random(&random)) : edit % 4 ? 0 : w - 1;
            const int j = edit % 3 ? (int)(h * test_random(&random)) : 0;
            const float height = (float)test_random(&random);
            if (edit == 3) { /* all of it undone */
                wr_field_free(empty), wr_field_free(full);
                empty = wr_field_share(first), full = wr_field_share(first_full);
            } else {
                wr_field_set(empty, i, j, height), wr_field_set(full, i, j, height);
            }
        }
        for (int n = 0; n < 2; n++) wr_table_fini(&tables[n]);
        wr_field_free(empty), wr_field_free(full), wr_field_free(first), wr_field_free(first_full);
    }
    wr_pool_free(pool);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_spared_shows_nowhere),
        cmocka_unit_test(edits_show_wherever_they_are),
        cmocka_unit_test(tiles_are_as_steep_as_what_is_read_of_them),
        cmocka_unit_test(edits_refresh_a_copy_to_the_bits_of_a_new_one),
        cmocka_unit_test(empty_tiles_are_left_out_and_read_as_zeros),
        cmocka_unit_test(no_tile_that_a_box_reads_is_steeper_than_it_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

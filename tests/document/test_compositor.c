/* The composite of a stack of layers: its value, and partial updates with identical bits at a cost proportional to
   the edit. */
#include "test.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "document/composite.h"
#include "field/field.h"

enum { MAX_MOST = 8 };

static WrField *new_field(int width, int height, float level)
{
    WrError err;
    WrField *field = wr_field_new(width, height, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, level, &err);
    if (!field) fail_msg("%s", err.text);
    return field;
}

/* A layer that the test owns and edits. */
typedef struct Own {
    WrField *heights, *cover, *mask;
} Own;

typedef struct Stack {
    Own own[MAX_MOST];
    WrBlendLayer layers[MAX_MOST];
    int count, width, height;
} Stack;

static void link_layer(Stack *s, int i)
{
    s->layers[i].heights = s->own[i].heights;
    s->layers[i].cover = s->own[i].cover;
    s->layers[i].mask = s->own[i].mask;
}

static int add_layer(Stack *s, WrBlend mode, float level)
{
    int i = s->count++;
    s->own[i] = (Own){ new_field(s->width, s->height, level), NULL, NULL };
    s->layers[i] = (WrBlendLayer){ .mode = mode, .opacity = 1.0f, .radius = 0.3f };
    link_layer(s, i);
    return i;
}

static int add_covered(Stack *s, WrBlend mode, float level)
{
    int i = add_layer(s, mode, level);
    s->own[i].cover = new_field(s->width, s->height, 0.0f);
    link_layer(s, i);
    return i;
}

static void free_layer(Stack *s, int i)
{
    wr_field_free(s->own[i].heights);
    wr_field_free(s->own[i].cover);
    wr_field_free(s->own[i].mask);
}

static void free_stack(Stack *s)
{
    for (int i = 0; i < s->count; i++) free_layer(s, i);
    s->count = 0;
}

/* The definition, row by row, without tiles. */
static void plain_row(const Stack *s, int j, float *below)
{
    float rows[3][1024];
    bool ground = true;
    for (int x = 0; x < s->width; x++) below[x] = 0.0f;
    for (int i = 0; i < s->count; i++) {
        const WrBlendLayer *l = &s->layers[i];
        if (l->hidden || l->opacity == 0.0f) continue;
        WrBlendTile tile = { .heights = rows[0], .cover_level = 1.0f, .mask_level = 1.0f };
        wr_field_read(l->heights, 0, j, s->width, 1, rows[0], 1024);
        if (l->cover) wr_field_read(l->cover, 0, j, s->width, 1, rows[1], 1024);
        if (l->mask) wr_field_read(l->mask, 0, j, s->width, 1, rows[2], 1024);
        tile.cover = l->cover ? rows[1] : NULL;
        tile.mask = l->mask ? rows[2] : NULL;
        WrBlend mode = ground && l->mode == WR_BLEND_ADD ? WR_BLEND_MIX : l->mode;
        wr_blend_tile(mode, l->opacity, l->radius, &tile, (size_t)s->width, below);
        ground = false;
    }
}

static void assert_is_composite(const WrField *field, const Stack *s)
{
    float expected[1024], row[1024];
    assert_int_equal(wr_field_width(field), s->width);
    assert_int_equal(wr_field_height(field), s->height);
    for (int j = 0; j < s->height; j++) {
        plain_row(s, j, expected);
        wr_field_read(field, 0, j, s->width, 1, row, 1024);
        if (memcmp(row, expected, sizeof *row * (size_t)s->width) == 0) continue;
        for (int i = 0; i < s->width; i++)
            if (memcmp(&row[i], &expected[i], sizeof *row) != 0)
                fail_msg("texel %d,%d: %.9g, should be %.9g", i, j, row[i], expected[i]);
    }
}

/* Random heights, exact zeros of either sign among them, in a random rectangle. */
static void scribble(WrField *field, TestRandom *random, double low, double high)
{
    static const float special[] = { 0.0f, -0.0f, 1.0f, 3e38f };
    int width = wr_field_width(field), height = wr_field_height(field);
    int i = (int)(test_random(random) * width), j = (int)(test_random(random) * height);
    int count_i = 1 + (int)(test_random(random) * 40),
        count_j = 1 + (int)(test_random(random) * 40);
    for (int y = j; y < j + count_j && y < height; y++)
        for (int x = i; x < i + count_i && x < width; x++) {
            uint64_t dice = test_random_u64(random) % 16;
            float value = (float)(low + (high - low) * test_random(random));
            wr_field_set(field, x, y, dice < 3 || (dice == 3 && high > 1) ? special[dice] : value);
        }
}

static void swap_layers(Stack *s, int a, int b)
{
    Own own = s->own[a];
    WrBlendLayer layer = s->layers[a];
    s->own[a] = s->own[b];
    s->layers[a] = s->layers[b];
    s->own[b] = own;
    s->layers[b] = layer;
}

static void remove_layer(Stack *s, int i)
{
    free_layer(s, i);
    for (s->count--; i < s->count; i++) {
        s->own[i] = s->own[i + 1];
        s->layers[i] = s->layers[i + 1];
    }
}

static void insert_random_layer(Stack *s, TestRandom *random)
{
    static const float levels[] = { 0.0f, 0.0f, 0.0f, -0.0f, 1.0f, 0.5f };
    WrBlend mode = (WrBlend)(test_random_u64(random) % WR_BLEND_COUNT);
    float level = levels[test_random_u64(random) % 6];
    int at = test_random_u64(random) % 2 ? add_covered(s, mode, level) : add_layer(s, mode, level);
    if (test_random_u64(random) % 3 == 0) s->own[at].mask = new_field(s->width, s->height, 1.0f);
    link_layer(s, at);
    for (int to = (int)(test_random_u64(random) % (uint64_t)s->count); at > to; at--)
        swap_layers(s, at, at - 1);
}

/* Any layer edit; painting with the highest probability. */
static void random_edit(Stack *s, TestRandom *random)
{
    int i = (int)(test_random_u64(random) % (uint64_t)s->count);
    WrBlendLayer *l = &s->layers[i];
    Own *own = &s->own[i];
    switch (test_random_u64(random) % 16) {
    case 0: l->hidden = !l->hidden; break;
    case 1: l->opacity = (float)(test_random_u64(random) % 5) / 4.0f; break;
    case 2: l->mode = (WrBlend)(test_random_u64(random) % WR_BLEND_COUNT); break;
    case 3: l->radius = (float)test_random(random); break;
    case 4: swap_layers(s, i, (i + 1) % s->count); break;
    case 5:
        if (s->count < MAX_MOST) insert_random_layer(s, random);
        break;
    case 6:
        if (s->count > 1) remove_layer(s, i);
        break;
    case 7: wr_field_fill(own->heights, (float)(test_random_u64(random) % 3) - 1.0f); break;
    case 8:
        if (own->mask) wr_field_free(own->mask);
        own->mask = own->mask ? NULL : new_field(s->width, s->height, 0.0f);
        link_layer(s, i);
        break;
    case 9:
    case 10:
        if (own->mask) scribble(own->mask, random, -0.2, 1.2);
        break;
    default:
        scribble(own->heights, random, -2, 2);
        if (own->cover) scribble(own->cover, random, -0.2, 1.2);
        break;
    }
}

static void any_edits_give_the_bits_of_a_fresh_composite_on_any_threads(void **state)
{
    (void)state;
    const int threads[] = { 1, 2, 7 };
    TestRandom random = { 11 };
    for (int round = 0; round < 6; round++) {
        Stack s = { .width = 150 + 37 * round, .height = 131 };
        WrCompositor *c[3];
        WrPool *pools[3];
        for (int k = 0; k < 3; k++) c[k] = wr_compositor_new();
        for (int k = 0; k < 3; k++) pools[k] = wr_pool_new(threads[k]);
        add_layer(&s, WR_BLEND_ADD, 0.0f);
        add_covered(&s, WR_BLEND_REPLACE, 0.0f);
        for (int n = 0; n < 120; n++) {
            for (uint64_t edits = test_random_u64(&random) % 3 + 1; edits > 0; edits--)
                random_edit(&s, &random);
            for (int k = 0; k < 3; k++)
                assert_is_composite(wr_compositor_update(c[k], s.layers, s.count, pools[k]), &s);
        }
        for (int k = 0; k < 3; k++) wr_compositor_free(c[k]);
        for (int k = 0; k < 3; k++) wr_pool_free(pools[k]);
        free_stack(&s);
    }
}

static void one_layer_added_in_full_is_that_layer_with_its_tiles(void **state)
{
    (void)state;
    Stack s = { .width = 200, .height = 100 };
    TestRandom random = { 12 };
    add_layer(&s, WR_BLEND_ADD, 0.25f);
    scribble(s.own[0].heights, &random, -1, 1);
    wr_field_set(s.own[0].heights, 199, 99, -0.0f);
    WrCompositor *c = wr_compositor_new();
    const WrField *f = wr_compositor_update(c, s.layers, 1, NULL);
    for (int ty = 0; ty < 2; ty++)
        for (int tx = 0; tx < 4; tx++)
            assert_ptr_equal(wr_field_tile(f, tx, ty), wr_field_tile(s.own[0].heights, tx, ty));
    assert_true(wr_hash_equal(wr_field_hash(f), wr_field_hash(s.own[0].heights)));
    wr_compositor_free(c);
    free_stack(&s);
}

static void tiles_under_an_empty_layer_are_the_lower_layers_own(void **state)
{
    (void)state;
    Stack s = { .width = 256, .height = 64 };
    add_layer(&s, WR_BLEND_ADD, 0.0f);
    add_covered(&s, WR_BLEND_MAX, 0.0f);
    add_layer(&s, WR_BLEND_ADD, 0.0f);
    wr_field_set(s.own[0].heights, 10, 10, -3.0f);
    wr_field_set(s.own[0].heights, 70, 10, -3.0f);
    wr_field_set(s.own[1].heights, 71, 10, 2.0f);
    wr_field_set(s.own[1].cover, 71, 10, 1.0f);
    WrCompositor *c = wr_compositor_new();
    const WrField *f = wr_compositor_update(c, s.layers, 3, NULL);
    assert_ptr_equal(wr_field_tile(f, 0, 0), wr_field_tile(s.own[0].heights, 0, 0));
    assert_ptr_not_equal(wr_field_tile(f, 1, 0), wr_field_tile(s.own[0].heights, 1, 0));
    assert_null(wr_field_tile(f, 2, 0));
    assert_null(wr_field_tile(f, 3, 0));
    assert_true(wr_field_get(f, 70, 10) == -3.0f && wr_field_get(f, 71, 10) == 2.0f);
    wr_compositor_free(c);
    free_stack(&s);
}

static void levels_alone_make_no_tiles(void **state)
{
    (void)state;
    Stack s = { .width = 16384, .height = 16384 };
    add_layer(&s, WR_BLEND_ADD, 1.0f);
    add_layer(&s, WR_BLEND_MULTIPLY, 3.0f);
    add_layer(&s, WR_BLEND_MIX, 1.0f);
    s.layers[2].opacity = 0.5f;
    WrCompositor *c = wr_compositor_new();
    const WrField *f = wr_compositor_update(c, s.layers, 3, NULL);
    assert_true(wr_field_level(f) == 2.0f);
    assert_int_equal(wr_field_bytes(f), 0);
    for (int i = 0; i < 3; i++) s.layers[i].hidden = true;
    f = wr_compositor_update(c, s.layers, 3, NULL);
    assert_true(wr_field_level(f) == 0.0f);
    assert_int_equal(wr_field_bytes(f), 0);
    wr_compositor_free(c);
    free_stack(&s);
}

static void count_tile(int tx, int ty, void *ctx)
{
    (void)tx;
    (void)ty;
    ++*(int *)ctx;
}

/* Number of composite tiles that have changed. */
static int tiles_redone(WrCompositor *c, const Stack *s, WrField **before)
{
    int changed = 0;
    const WrField *now = wr_compositor_update(c, s->layers, s->count, NULL);
    wr_field_changes(*before, now, count_tile, &changed);
    wr_field_free(*before);
    *before = wr_field_share(now);
    return changed;
}

/* A table of 65536 tiles with a base that holds 300 of them, and on it layers that hold a few. */
static void big_stack(Stack *s)
{
    *s = (Stack){ .width = 16384, .height = 16384 };
    add_layer(s, WR_BLEND_ADD, 0.0f);
    for (int i = 0; i < 300; i++) wr_field_set(s->own[0].heights, i % 256 * 64, i / 256 * 64, 1.0f);
    for (int k = 1; k < 5; k++) {
        add_covered(s, k % 2 ? WR_BLEND_MAX : WR_BLEND_REPLACE, 0.0f);
        for (int i = 0; i < 3 * k; i++) {
            wr_field_set(s->own[k].heights, 64 * 20 * k + 64 * i, 5, (float)k);
            wr_field_set(s->own[k].cover, 64 * 20 * k + 64 * i, 5, 0.5f);
        }
    }
}

static void an_edit_or_setting_redoes_only_the_tiles_that_it_concerns(void **state)
{
    (void)state;
    Stack s;
    big_stack(&s);
    WrCompositor *c = wr_compositor_new();
    WrField *before = wr_field_share(wr_compositor_update(c, s.layers, s.count, NULL));
    assert_int_equal(tiles_redone(c, &s, &before), 0);
    wr_field_set(s.own[2].heights, 64 * 40, 5, 9.0f);
    assert_int_equal(tiles_redone(c, &s, &before), 1);
    wr_field_set(s.own[0].heights, 16383, 16383, 9.0f); /* no other layer covers it */
    assert_int_equal(tiles_redone(c, &s, &before), 1);
    s.layers[1].opacity = 0.5f;
    assert_int_equal(tiles_redone(c, &s, &before), 3);
    s.layers[3].hidden = true;
    assert_int_equal(tiles_redone(c, &s, &before), 9);
    s.layers[3].hidden = false;
    assert_int_equal(tiles_redone(c, &s, &before), 9);
    swap_layers(&s, 2, 4);
    assert_true(tiles_redone(c, &s, &before) <= 6 + 9 + 12);
    swap_layers(&s, 2, 3);
    assert_true(tiles_redone(c, &s, &before) <= 9 + 12);
    remove_layer(&s, 4); /* the former second */
    assert_int_equal(tiles_redone(c, &s, &before), 6);
    wr_field_free(before);
    wr_compositor_free(c);
    free_stack(&s);
}

static int tiles_not_shared(const WrField *a, const WrField *b)
{
    int differing = 0;
    wr_field_changes(a, b, count_tile, &differing);
    return differing;
}

static void painting_the_base_under_a_small_layer_does_not_copy_the_base(void **state)
{
    (void)state;
    Stack s;
    big_stack(&s); /* 30 tiles are blended */
    WrCompositor *c = wr_compositor_new(), *fresh = wr_compositor_new();
    for (int n = 0; n < 2000; n++) {
        wr_field_set(s.own[0].heights, n * 37 % 256 * 64 + 1, 640 + n / 50 * 64, (float)n);
        const WrField *f = wr_compositor_update(c, s.layers, s.count, NULL);
        /* the blended ones, as many leftovers, 64 more, and the last edit's */
        assert_true(tiles_not_shared(f, s.own[0].heights) <= 30 + 30 + 64 + 1);
    }
    assert_true(wr_hash_equal(wr_field_hash(wr_compositor_update(c, s.layers, s.count, NULL)),
                              wr_field_hash(wr_compositor_update(fresh, s.layers, s.count, NULL))));
    wr_compositor_free(c);
    wr_compositor_free(fresh);
    free_stack(&s);
}

static void a_base_that_changes_in_many_tiles_is_shared_again(void **state)
{
    (void)state;
    Stack s;
    big_stack(&s);
    WrCompositor *c = wr_compositor_new(), *fresh = wr_compositor_new();
    for (int n = 0; n < 5; n++) {
        wr_compositor_update(c, s.layers, s.count, NULL);
        for (int k = 0; k < 500; k++)
            wr_field_set(s.own[0].heights, k * 37 % 256 * 64 + n, k / 10 * 64, (float)(n + k));
        const WrField *f = wr_compositor_update(c, s.layers, s.count, NULL);
        assert_int_equal(tiles_not_shared(f, s.own[0].heights), 30);
        /* not visible before the next update */
        wr_field_set(s.own[0].heights, 3, 3, -1.0f - (float)n);
        assert_true(wr_field_get(f, 3, 3) != -1.0f - (float)n);
    }
    assert_true(wr_hash_equal(wr_field_hash(wr_compositor_update(c, s.layers, s.count, NULL)),
                              wr_field_hash(wr_compositor_update(fresh, s.layers, s.count, NULL))));
    wr_compositor_free(c);
    wr_compositor_free(fresh);
    free_stack(&s);
}

static void a_share_of_a_compositor_goes_its_own_way(void **state)
{
    (void)state;
    TestRandom random = { 13 };
    Stack s = { .width = 200, .height = 90 };
    add_layer(&s, WR_BLEND_ADD, 0.0f);
    add_covered(&s, WR_BLEND_REPLACE, 0.0f);
    scribble(s.own[0].heights, &random, -1, 1);
    scribble(s.own[1].heights, &random, -1, 1);
    scribble(s.own[1].cover, &random, 0, 1);
    WrCompositor *a = wr_compositor_new(), *empty = wr_compositor_snapshot(a);
    WrHash first = wr_field_hash(wr_compositor_update(a, s.layers, s.count, NULL));
    WrCompositor *b = wr_compositor_snapshot(a);
    scribble(s.own[1].heights, &random, -1, 1);
    wr_field_set(s.own[1].cover, 3, 3, 1.0f);
    wr_field_set(s.own[1].heights, 3, 3, 77.0f);
    const WrField *later = wr_compositor_update(b, s.layers, s.count, NULL);
    assert_is_composite(later, &s);
    assert_false(wr_hash_equal(first, wr_field_hash(later)));
    wr_compositor_free(b);
    assert_is_composite(wr_compositor_update(a, s.layers, s.count, NULL), &s);
    assert_is_composite(wr_compositor_update(empty, s.layers, s.count, NULL), &s);
    wr_compositor_free(a);
    wr_compositor_free(empty);
    free_stack(&s);
}

static void tables_of_another_size_start_anew(void **state)
{
    (void)state;
    const int sizes[][2] = { { 1, 1 }, { 64, 64 }, { 65, 1 }, { 1, 300 }, { 1, 1 }, { 130, 70 } };
    TestRandom random = { 14 };
    WrCompositor *c = wr_compositor_new();
    for (size_t n = 0; n < sizeof sizes / sizeof *sizes; n++) {
        Stack s = { .width = sizes[n][0], .height = sizes[n][1] };
        for (int mode = 0; mode < 8; mode++) {
            add_covered(&s, (WrBlend)mode, 0.5f);
            scribble(s.own[mode].heights, &random, -1, 1);
            scribble(s.own[mode].cover, &random, 0, 1);
        }
        assert_is_composite(wr_compositor_update(c, s.layers, s.count, NULL), &s);
        free_stack(&s);
    }
    wr_compositor_free(c);
}

/* A document that is saved and read again drops tiles that hold only the level. */
static void tiles_full_of_the_level_count_as_none(void **state)
{
    (void)state;
    Stack s = { .width = 130, .height = 70 };
    static const WrBlend modes[] = { WR_BLEND_ADD, WR_BLEND_MULTIPLY, WR_BLEND_MAX };
    for (int k = 0; k < 3; k++) add_covered(&s, modes[k], k == 1 ? 1.0f : -0.0f);
    wr_field_set(s.own[2].cover, 5, 5, 1.0f);
    WrCompositor *a = wr_compositor_new(), *b = wr_compositor_new();
    WrHash without = wr_field_hash(wr_compositor_update(a, s.layers, s.count, NULL));
    for (int k = 0; k < 3; k++) {
        wr_field_tile_write(s.own[k].heights, 0, 0);
        wr_field_tile_write(s.own[k].cover, 1, 1);
        assert_true(wr_hash_equal(without,
                                  wr_field_hash(wr_compositor_update(a, s.layers, s.count, NULL))));
    }
    assert_true(
        wr_hash_equal(without, wr_field_hash(wr_compositor_update(b, s.layers, s.count, NULL))));
    wr_compositor_free(a);
    wr_compositor_free(b);
    free_stack(&s);
}

static void settings_out_of_range_are_refused_with_the_value(void **state)
{
    (void)state;
    Stack s = { .width = 8, .height = 8 };
    add_layer(&s, WR_BLEND_ADD, 0.0f);
    WrField *other = new_field(8, 9, 1.0f);
    WrError err;
    assert_true(wr_blend_layer_check(&s.layers[0], &err));
    WrBlendLayer bad = s.layers[0];
    bad.opacity = 1.5f;
    assert_false(wr_blend_layer_check(&bad, &err));
    assert_non_null(strstr(err.text, "1.5"));
    bad.opacity = NAN;
    assert_false(wr_blend_layer_check(&bad, &err));
    bad = s.layers[0];
    bad.radius = -2.0f;
    assert_false(wr_blend_layer_check(&bad, &err));
    assert_non_null(strstr(err.text, "-2"));
    bad.radius = INFINITY;
    assert_false(wr_blend_layer_check(&bad, &err));
    bad = s.layers[0];
    bad.mode = (WrBlend)99;
    assert_false(wr_blend_layer_check(&bad, &err));
    assert_non_null(strstr(err.text, "99"));
    bad = s.layers[0];
    bad.mask = other;
    assert_false(wr_blend_layer_check(&bad, &err));
    assert_non_null(strstr(err.text, "8x9"));
    wr_field_free(other);
    free_stack(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_edits_give_the_bits_of_a_fresh_composite_on_any_threads),
        cmocka_unit_test(one_layer_added_in_full_is_that_layer_with_its_tiles),
        cmocka_unit_test(tiles_under_an_empty_layer_are_the_lower_layers_own),
        cmocka_unit_test(levels_alone_make_no_tiles),
        cmocka_unit_test(an_edit_or_setting_redoes_only_the_tiles_that_it_concerns),
        cmocka_unit_test(painting_the_base_under_a_small_layer_does_not_copy_the_base),
        cmocka_unit_test(a_base_that_changes_in_many_tiles_is_shared_again),
        cmocka_unit_test(a_share_of_a_compositor_goes_its_own_way),
        cmocka_unit_test(tables_of_another_size_start_anew),
        cmocka_unit_test(tiles_full_of_the_level_count_as_none),
        cmocka_unit_test(settings_out_of_range_are_refused_with_the_value),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

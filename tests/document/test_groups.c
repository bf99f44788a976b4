/* Groups of layers: their composite against a naive one, partial recomputation after an edit with identical bits, and
   changes of the list of layers. */
#include "test.h"

#include "base/error.h"
#include "base/pool.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "field/ops.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double between(TestRandom *r, double low, double high)
{
    return low + (high - low) * test_random(r);
}

static int pick(TestRandom *r, int count)
{
    return (int)(test_random(r) * count);
}

/* ---- a naive composite: whole tables in double, colours with alpha premultiplied ---- */

typedef struct Table {
    double *h, *a; /* [count] heights and coverage */
} Table;

static const WrDocument *of; /* the document that is composited */
static int count;            /* texels */

static double value(const WrField *field, int i)
{
    if (!field) return 1.0;
    return (double)wr_field_get(field, i % wr_field_width(field), i / wr_field_width(field));
}

static double joined(WrBlend blend, double b, double h, double k)
{
    const double s = k > 0 ? fmax(k - fabs(b - h), 0) / k : 0, bulge = s * s * k / 4;
    switch (blend) {
    case WR_BLEND_ADD: return b + h;
    case WR_BLEND_SUBTRACT: return b - h;
    case WR_BLEND_MAX: return fmax(b, h);
    case WR_BLEND_MIN: return fmin(b, h);
    case WR_BLEND_SMOOTH_MAX: return fmax(b, h) + bulge;
    case WR_BLEND_SMOOTH_MIN: return fmin(b, h) - bulge;
    case WR_BLEND_MULTIPLY: return b * h;
    case WR_BLEND_REPLACE:
    case WR_BLEND_MIX:
    case WR_BLEND_COUNT: break;
    }
    return h;
}

static bool counts_cover(WrBlend blend)
{
    return blend != WR_BLEND_ADD && blend != WR_BLEND_SUBTRACT && blend != WR_BLEND_MIX;
}

/* Joins a layer's heights and coverage to those below. */
static void join(const WrLayer *layer, const Table *own, bool partial, Table *below)
{
    const bool adds = layer->blend == WR_BLEND_ADD || layer->blend == WR_BLEND_SUBTRACT;
    for (int i = 0; i < count; i++) {
        double *b = &below->h[i], *a = &below->a[i];
        const double shown = (double)layer->opacity * value(layer->mask, i);
        const double area = layer->blend == WR_BLEND_MIX ? shown : shown * own->a[i];
        const double whole = *a + area * (1 - *a);
        const double full = joined(layer->blend, *b, own->h[i], (double)layer->radius);
        if (adds) *b += shown * (full - *b);
        else if (!partial) *b += area * (full - *b);
        else if (area > 0)
            *b = ((1 - area) * *a * *b + area * ((1 - *a) * own->h[i] + *a * full)) / whole;
        *a = whole;
    }
}

static Table table_of(double height, double cover)
{
    Table table = { malloc((size_t)count * sizeof(double)),
                    malloc((size_t)count * sizeof(double)) };
    for (int i = 0; i < count; i++) table.h[i] = height, table.a[i] = cover;
    return table;
}

static void free_table(Table *table)
{
    free(table->h);
    free(table->a);
}

static void filter(const WrLayer *layer, Table *below)
{
    WrField *in = wr_field_share(layer->heights);
    const int width = wr_field_width(in);
    for (int i = 0; i < count; i++) wr_field_set(in, i % width, i / width, (float)below->h[i]);
    WrField *out = wr_op_run(layer->filter.op, in, layer->filter.param, NULL, NULL);
    for (int i = 0; i < count; i++) {
        const double full = joined(layer->blend, below->h[i], value(out, i), (double)layer->radius);
        below->h[i] += (double)layer->opacity * value(layer->mask, i) * (full - below->h[i]);
    }
    wr_field_free(in);
    wr_field_free(out);
}

/* The rows below `end` that are `depth` deep or deeper; false: none is visible. */
static bool naive(int end, int depth, bool partial, Table *out)
{
    int from = end;
    bool any = false;
    while (from > 0 && of->layers[from - 1].depth >= depth) from--;
    *out = table_of(0, 0);
    for (int i = from; i < end; i++) {
        const WrLayer *layer = &of->layers[i];
        if (layer->depth != depth || !layer->visible || layer->opacity == 0) continue;
        Table own = table_of(0, 0);
        bool shown = true;
        if (layer->filter.op) {
            filter(layer, out);
        } else if (layer->is_group) {
            free_table(&own);
            shown = naive(i, depth + 1, counts_cover(layer->blend), &own);
            if (shown) join(layer, &own, partial, out);
        } else {
            for (int k = 0; k < count; k++)
                own.h[k] = value(layer->heights, k), own.a[k] = value(layer->cover, k);
            join(layer, &own, partial, out);
        }
        any |= shown;
        free_table(&own);
    }
    return any;
}

static void assert_naive(const WrDocument *document, int step)
{
    const WrField *made = wr_document_field(document);
    Table expected;
    double most = 1;
    of = document;
    count = wr_field_width(made) * wr_field_height(made);
    naive(document->layer_count, 0, false, &expected);
    for (int i = 0; i < count; i++) most = fmax(most, fabs(expected.h[i]));
    for (int i = 0; i < count; i++)
        if (!(fabs(value(made, i) - expected.h[i]) <= 2e-4 * most))
            fail_msg("edit %d: texel %d is %.9g, expected %.9g", step, i, value(made, i),
                     expected.h[i]);
    free_table(&expected);
}

/* ---- random documents ---- */

static WrFilter some_filter(TestRandom *r)
{
    static const char *const lines[] = { "blur sigma=2.3", "levels in-low=-0.4 in-high=1.3 gamma=1",
                                         "add amount=0.37", "multiply factor=-0.7",
                                         "dilate radius=3.1" };
    WrFilter made;
    WrError err;
    if (!wr_filter_parse(lines[pick(r, 5)], &made, &err)) fail_msg("%s", err.text);
    return made;
}

static WrField *flat(const WrDocument *document, float level)
{
    const WrField *like = document->layers[0].heights;
    return wr_field_new(wr_field_width(like), wr_field_height(like), wr_field_wrap_u(like),
                        wr_field_wrap_v(like), level, NULL);
}

/* Sets a rectangle to random values, often 0 and 1. */
static void scribble(TestRandom *r, WrField *field, bool unit)
{
    const int width = wr_field_width(field), height = wr_field_height(field);
    const int x = pick(r, width), y = pick(r, height), w = 1 + pick(r, width), h = 1 + pick(r, 30);
    const bool rough = test_random(r) < 0.5;
    const float all = (float)between(r, unit ? 0 : -1.5, unit ? 1 : 1.5);
    for (int j = y; j < y + h && j < height; j++)
        for (int i = x; i < x + w && i < width; i++)
            wr_field_set(field, i, j,
                         !rough ? roundf(all) : (float)between(r, unit ? 0 : -1.5, unit ? 1 : 1.5));
}

static void set_blend(TestRandom *r, WrLayer *layer)
{
    layer->opacity = test_random(r) < 0.6 ? 1.0f : test_random(r) < 0.2 ? 0.0f : 0.37f;
    layer->blend = (WrBlend)pick(r, WR_BLEND_COUNT);
    layer->radius = 0.3f;
}

static void insert(TestRandom *r, WrDocument *document)
{
    const int place = 1 + pick(r, document->layer_count);
    const WrFilter filter_made = some_filter(r);
    const WrField *like = document->layers[0].heights;
    WrLayer layer = test_random(r) < 0.2 ? wr_layer_make_filter("f", &filter_made, like)
                                         : wr_layer_make("l", like);
    if (layer.cover) {
        set_blend(r, &layer);
        for (int k = 0; k < 3; k++) {
            scribble(r, layer.heights, false);
            scribble(r, layer.cover, true);
        }
    }
    wr_document_insert(document, place, layer);
}

static void regroup(TestRandom *r, WrDocument *document)
{
    bool chosen[WR_LAYERS_MAX] = { false };
    const int from = pick(r, document->layer_count), step = 1 + pick(r, 3);
    for (int i = from; i < document->layer_count && i < from + 4 * step; i += step)
        chosen[i] = true;
    if (document->layer_count >= 14) return;
    const int made = wr_document_group(document, chosen, "g");
    if (made >= 0 && test_random(r) < 0.5) set_blend(r, &document->layers[made]);
}

static void move(TestRandom *r, WrDocument *document)
{
    const int from = pick(r, document->layer_count);
    const int members = from - wr_layers_first(document->layers, from);
    const int to = members + pick(r, document->layer_count - members);
    int least, most;
    wr_document_move_depths(document, from, to, &least, &most);
    assert_true(least <= most);
    const int depth = least + pick(r, most - least + 1);
    if (depth + wr_document_height(document, from) > WR_DEPTH_MAX) return;
    wr_document_move(document, from, to, depth);
}

static void take_away(TestRandom *r, WrDocument *document)
{
    const int i = pick(r, document->layer_count);
    const int rows = i + 1 - wr_layers_first(document->layers, i);
    if (document->layers[i].is_group && test_random(r) < 0.7 && document->layer_count > 2)
        wr_document_ungroup(document, i);
    else if (document->layer_count - rows > 3) wr_document_remove(document, i);
}

static void edit(TestRandom *r, WrDocument *document)
{
    WrLayer *layer = &document->layers[pick(r, document->layer_count)];
    const double what = test_random(r);
    if (what < 0.35) {
        if (!wr_layer_holds(layer)) return;
        scribble(r, layer->heights, false);
        if (layer->cover) scribble(r, layer->cover, true);
    } else if (what < 0.45) {
        if (!layer->mask) layer->mask = flat(document, test_random(r) < 0.5 ? 1.0f : 0.0f);
        scribble(r, layer->mask, true);
    } else if (what < 0.52) layer->visible = test_random(r) < 0.7;
    else if (what < 0.6) set_blend(r, layer);
    else if (what < 0.75 && document->layer_count < 12) insert(r, document);
    else if (what < 0.85) regroup(r, document);
    else if (what < 0.93) move(r, document);
    else take_away(r, document);
}

static void assert_same(const WrField *a, const WrField *b, int step)
{
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            if (!same_bits((double)wr_field_get(a, i, j), (double)wr_field_get(b, i, j)))
                fail_msg("edit %d: texel %d,%d is %.9g, expected %.9g", step, i, j,
                         (double)wr_field_get(a, i, j), (double)wr_field_get(b, i, j));
}

static WrDocument *document_of(int width, int height)
{
    WrDocument *document = wr_document_new();
    wr_document_start_over(
        document, wr_field_new(width, height, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 0.0f, NULL));
    return document;
}

static void random_groups_equal_a_naive_composite(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 131, 97 }, { 67, 203 }, { 9, 7 } };
    WrPool *pool = wr_pool_new(2);
    for (int t = 0; t < 3; t++) {
        TestRandom r = { 31 + (uint64_t)t };
        int deepest = 0;
        WrDocument *document = document_of(sizes[t][0], sizes[t][1]);
        scribble(&r, document->layers[0].heights, false);
        for (int k = 0; k < 6; k++) insert(&r, document);
        for (int k = 0; k < 220; k++) {
            edit(&r, document);
            WrError err;
            if (!wr_document_check_groups(document, &err)) fail_msg("edit %d: %s", k, err.text);
            for (int i = 0; i < document->layer_count; i++)
                deepest = document->layers[i].depth > deepest ? document->layers[i].depth : deepest;
            WrDocument *anew = wr_document_snapshot(document);
            assert_same(wr_document_composite(document, pool), wr_document_field(anew), k);
            if (k % test_amount(1, 4) == 0) assert_naive(anew, k);
            wr_document_free(anew);
            if (k % 25 < 24) continue; /* a share reuses the cached data */
            WrDocument *shared = wr_document_share(document);
            wr_document_free(document);
            document = shared;
        }
        assert_true(deepest >= 3);
        wr_document_free(document);
    }
    wr_pool_free(pool);
}

/* ---- statements of composite.h ---- */

/* A random layer on a base; its composite alone, and in a group of default settings. */
static void a_group_of_one_layer_is_the_layer(void **state)
{
    (void)state;
    for (int blend = 0; blend < WR_BLEND_COUNT; blend++) {
        TestRandom r = { 7 + (uint64_t)blend };
        WrDocument *document = document_of(83, 131);
        for (int k = 0; k < 5; k++) scribble(&r, document->layers[0].heights, false);
        WrLayer layer = wr_layer_make("l", document->layers[0].heights);
        for (int k = 0; k < 9; k++) {
            scribble(&r, layer.heights, false);
            scribble(&r, layer.cover, true);
        }
        layer.blend = (WrBlend)blend;
        layer.radius = 0.4f;
        layer.opacity = 0.7f;
        wr_document_insert(document, 1, layer);
        document->layers[1].mask = flat(document, 1.0f);
        scribble(&r, document->layers[1].mask, true);
        WrDocument *grouped = wr_document_snapshot(document);
        assert_int_equal(wr_document_group(grouped, (bool[]){ false, true }, "g"), 2);
        assert_int_equal(grouped->layer_count, 3);
        assert_int_equal(grouped->layers[1].depth, 1);
        assert_same(wr_document_field(grouped), wr_document_field(document), blend);
        wr_document_free(grouped);
        wr_document_free(document);
    }
}

/* Layers of one blend on a base, and the upper ones in a group. */
static void compare_stack(WrBlend blend, bool hard, double tolerance)
{
    TestRandom r = { 91 + (uint64_t)blend };
    WrDocument *document = document_of(101, 75);
    for (int k = 0; k < 5; k++) scribble(&r, document->layers[0].heights, false);
    for (int i = 1; i < 5; i++) {
        WrLayer layer = wr_layer_make("l", document->layers[0].heights);
        for (int k = 0; k < 9; k++) scribble(&r, layer.heights, false);
        for (int k = 0; k < 9; k++) scribble(&r, layer.cover, true);
        for (int k = 0; hard && k < 101 * 75; k++)
            wr_field_set(layer.cover, k % 101, k / 101, roundf((float)value(layer.cover, k)));
        layer.blend = blend;
        wr_document_insert(document, i, layer);
    }
    WrDocument *grouped = wr_document_snapshot(document);
    wr_document_group(grouped, (bool[]){ false, true, true, true, true }, "g");
    const WrField *a = wr_document_field(document), *b = wr_document_field(grouped);
    for (int i = 0; i < 101 * 75; i++)
        if (!(fabs(value(a, i) - value(b, i)) <= tolerance))
            fail_msg("%s: texel %d is %.9g in a group, %.9g without", wr_blends[blend].name, i,
                     value(b, i), value(a, i));
    wr_document_free(document);
    wr_document_free(grouped);
}

static void groups_of_layers_of_one_blend_are_the_layers(void **state)
{
    (void)state;
    compare_stack(WR_BLEND_ADD, false, 4 * 7.5 * ldexp(1, -23)); /* 5 heights up to 1.5 */
    compare_stack(WR_BLEND_SUBTRACT, false, 4 * 7.5 * ldexp(1, -23));
    compare_stack(WR_BLEND_MAX, true, 0);
    compare_stack(WR_BLEND_MIN, true, 0);
    compare_stack(WR_BLEND_REPLACE, false, 1e-6);
}

/* ---- changes of the list ---- */

static void name_rows(const WrDocument *document, char *out)
{
    *out = '\0';
    for (int i = 0; i < document->layer_count; i++)
        sprintf(out + strlen(out), "%s%d ", document->layers[i].name, document->layers[i].depth);
}

static void assert_rows(const WrDocument *document, const char *expected)
{
    char rows[256];
    name_rows(document, rows);
    assert_string_equal(rows, expected);
}

static WrDocument *five_layers(void)
{
    WrDocument *document = document_of(19, 5);
    for (int i = 1; i < 5; i++)
        wr_document_insert(
            document, i,
            wr_layer_make((char[]){ (char)('a' + i), '\0' }, document->layers[0].heights));
    return document;
}

static void groups_are_made_moved_and_removed_with_their_members(void **state)
{
    (void)state;
    WrDocument *document = five_layers();
    document->solo = 2;
    wr_document_group(document, (bool[]){ false, true, false, true, false }, "G");
    assert_rows(document, "base0 c0 b1 d1 G0 e0 ");
    assert_int_equal(document->active, 4);
    assert_int_equal(document->solo, 1);
    /* one of its members and the layer above: the new group is put where the higher one was */
    wr_document_group(document, (bool[]){ false, false, false, true, false, true }, "H");
    assert_rows(document, "base0 c0 b1 G0 d1 e1 H0 ");
    wr_document_move(document, 6, 5, 1); /* H as the highest member of G */
    assert_rows(document, "base0 c0 b1 d2 e2 H1 G0 ");
    wr_document_free(document);
}

static void groups_leave_when_moved(void **state)
{
    (void)state;
    WrDocument *document = five_layers();
    wr_document_group(document, (bool[]){ false, true, true, false, false }, "G");
    assert_rows(document, "base0 b1 c1 G0 d0 e0 ");
    int least, most;
    wr_document_move_depths(document, 4, 1, &least, &most); /* d below b */
    assert_int_equal(least, 0);
    assert_int_equal(most, 1);
    wr_document_move_depths(document, 4, 2, &least, &most); /* between b and c */
    assert_int_equal(least, 1);
    assert_int_equal(most, 1);
    wr_document_move(document, 3, 5, 0); /* the group to the top */
    assert_rows(document, "base0 d0 e0 b1 c1 G0 ");
    wr_document_move(document, 5, 2, 0); /* and to the bottom */
    assert_rows(document, "b1 c1 G0 base0 d0 e0 ");
    wr_document_remove(document, 2);
    assert_rows(document, "base0 d0 e0 ");
    wr_document_free(document);
}

/* Rasterizing a group and merging in it. */
static void joining_leaves_the_composite(void **state)
{
    (void)state;
    TestRandom r = { 5 };
    for (int k = 0; k < 60; k++) {
        WrDocument *document = document_of(77, 23);
        scribble(&r, document->layers[0].heights, false);
        for (int i = 0; i < 5; i++) insert(&r, document);
        for (int i = 0; i < 3; i++) regroup(&r, document);
        for (int i = 0; i < document->layer_count; i++)
            if (document->layers[i].opacity == 0) document->layers[i].opacity = 0.5f;
        const WrField *before = wr_field_share(wr_document_field(document));
        for (int i = document->layer_count - 1; i >= 0; i--) {
            if (!document->layers[i].is_group || test_random(&r) < 0.5) continue;
            WrDocument *plain = wr_document_snapshot(document);
            const int made = wr_document_rasterize_group(plain, i, NULL);
            assert_false(plain->layers[made].is_group);
            assert_same(wr_document_field(plain), before, k);
            wr_document_free(plain);
        }
        for (int i = document->layer_count - 1; i > 0; i--) {
            const int first = wr_layers_first(document->layers, i);
            if (first == wr_layers_first_sibling(document->layers, i)) continue;
            WrDocument *merged = wr_document_snapshot(document);
            wr_document_merge(merged, i, NULL);
            WrError err;
            assert_true(wr_document_check_groups(merged, &err));
            const WrField *after = wr_document_field(merged);
            for (int t = 0; t < 77 * 23; t++)
                if (fabs(value(after, t) - value(before, t)) > 3e-5)
                    fail_msg("document %d, layer %d merged: texel %d is %.9g, was %.9g", k, i, t,
                             value(after, t), value(before, t));
            wr_document_free(merged);
        }
        wr_field_free((WrField *)before);
        wr_document_free(document);
    }
}

static void solo_shows_a_group_alone(void **state)
{
    (void)state;
    WrDocument *document = five_layers();
    for (int i = 0; i < 5; i++) wr_field_fill(document->layers[i].heights, (float)(1 << i));
    wr_document_group(document, (bool[]){ false, true, false, true, false }, "G");
    assert_rows(document, "base0 c0 b1 d1 G0 e0 ");
    document->layers[3].visible = false; /* d, 8 */
    document->layers[4].visible = false;
    document->layers[4].opacity = 0.5f;
    document->solo = 4;
    assert_float_equal((double)wr_field_get(wr_document_field(document), 3, 2), 1.0, 0);
    assert_true(wr_document_shows(document, 2));
    assert_false(wr_document_shows(document, 3));
    assert_false(wr_document_shows(document, 1));
    document->solo = 3; /* alone, without its group */
    assert_float_equal((double)wr_field_get(wr_document_field(document), 3, 2), 8.0, 0);
    document->solo = -1;
    assert_float_equal((double)wr_field_get(wr_document_field(document), 3, 2), 21.0, 0);
    assert_false(wr_document_shows(document, 2));
    /* below d in its group lies b; below G the two others */
    WrField *below = wr_document_below(document, 3, NULL);
    assert_float_equal((double)wr_field_get(below, 3, 2), 2.0, 0);
    wr_field_free(below);
    below = wr_document_below(document, 4, NULL);
    assert_float_equal((double)wr_field_get(below, 3, 2), 5.0, 0);
    wr_field_free(below);
    wr_document_free(document);
}

static void nesting_beyond_the_limit_is_an_error(void **state)
{
    (void)state;
    WrDocument *document = document_of(5, 3);
    WrError err;
    for (int k = 0; k < WR_DEPTH_MAX; k++) {
        bool chosen[WR_LAYERS_MAX] = { true };
        assert_int_equal(wr_document_group(document, chosen, "g"), 1);
    }
    assert_int_equal(wr_document_group(document, (bool[WR_LAYERS_MAX]){ true }, "g"), -1);
    assert_true(wr_document_check_groups(document, &err));
    document->layers[0].is_group = true;
    assert_false(wr_document_check_groups(document, &err));
    assert_string_equal(err.text, "layer 1 is in 9 groups: up to 8 can be nested");
    document->layers[0].is_group = false;
    document->layers[2].is_group = false;
    assert_false(wr_document_check_groups(document, &err));
    assert_string_equal(err.text,
                        "layer 2 is 7 groups deep, but only 6 are open: a group is missing");
    wr_document_free(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_groups_equal_a_naive_composite),
        cmocka_unit_test(a_group_of_one_layer_is_the_layer),
        cmocka_unit_test(groups_of_layers_of_one_blend_are_the_layers),
        cmocka_unit_test(groups_are_made_moved_and_removed_with_their_members),
        cmocka_unit_test(groups_leave_when_moved),
        cmocka_unit_test(joining_leaves_the_composite),
        cmocka_unit_test(solo_shows_a_group_alone),
        cmocka_unit_test(nesting_beyond_the_limit_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Filter layers: their results, and partial recomputation after an edit with identical bits. */
#include "test.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/text.h"
#include "document/document.h"
#include "document/object_tables.h"
#include "field/field.h"
#include "field/ops.h"

static double between(TestRandom *r, double low, double high)
{
    return low + (high - low) * test_random(r);
}

static int pick(TestRandom *r, int count)
{
    return (int)(test_random(r) * count);
}

/* Ordinary values for each operation that keeps the table's size. */
static const char *const kinds[] = {
    "blur sigma=%.3f",
    "sharpen amount=0.7 sigma=%.3f",
    "median radius=%.3f window=square",
    "dilate radius=%.3f",
    "erode radius=%.3f",
    "levels in-low=-0.37 in-high=%.3f gamma=1.7 out-low=0.21 out-high=0.83",
    "add amount=%.3f",
    "curves points=-0.7,0.21;0.4,%.3f;1.2,0.35",
    "multiply factor=%.3f",
    "noise amount=%.3f cells=7 octaves=3 kind=value mode=billow seed=41",
    "warp amount=1%.3f cells=3 octaves=2 seed=3",
    "clamp low=0.19 high=%.3f",
    "invert about=zero",
    "invert about=range",
    "normalise low=-0.3 high=%.3f",
    "slope-limit limit=0.07",
    "offset du=17 dv=-29",
    "flip-u",
    "flip-v",
    "blur sigma=17.%0.f",
    "seamless how=blend",
    "seamless how=patches width=4",
    "seamless how=mirror",
    "seamless how=frequency",
    "match-edges width=9",
    "even-light sigma=%.3f",
};
enum {
    KINDS = sizeof kinds / sizeof *kinds,
    NEAR = 13 /* the first ones do not depend on the whole table */
};

static WrFilter filter_of(int kind, double value)
{
    char text[128];
    WrFilter filter;
    WrError err;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
    snprintf(text, sizeof text, kinds[kind], value);
#pragma GCC diagnostic pop
    if (!wr_filter_parse(text, &filter, &err)) fail_msg("%s: %s", text, err.text);
    return filter;
}

static WrFilter some_filter(TestRandom *r)
{
    return filter_of(pick(r, test_random(r) < 0.6 ? NEAR : KINDS), between(r, 0.4, 5.0));
}

static void scribble(TestRandom *r, WrField *field, bool unit)
{
    float texels[40 * 40];
    int width = wr_field_width(field), height = wr_field_height(field);
    int w = 1 + pick(r, width < 40 ? width : 40), h = 1 + pick(r, height < 40 ? height : 40);
    for (int i = 0; i < w * h; i++) texels[i] = (float)between(r, unit ? 0 : -1, unit ? 1 : 2);
    wr_field_write(field, pick(r, width - w + 1), pick(r, height - h + 1), w, h, texels, (size_t)w);
}

static WrField *like(const WrDocument *document, float level)
{
    const WrField *f = document->layers[0].heights;
    return wr_field_new(wr_field_width(f), wr_field_height(f), wr_field_wrap_u(f),
                        wr_field_wrap_v(f), level, NULL);
}

/* One random change of any input of a composite. */
static void edit(TestRandom *r, WrDocument *document)
{
    int i = pick(r, document->layer_count);
    WrLayer *layer = &document->layers[i];
    if (document->solo >= 0 && test_random(r) < 0.5) document->solo = -1;
    double what = test_random(r);
    if (what < 0.55) {
        i = pick(r, 2);
        scribble(r, document->layers[i].heights, false);
        if (document->layers[i].cover) scribble(r, document->layers[i].cover, true);
    } else if (what < 0.65) {
        if (!layer->mask) layer->mask = like(document, test_random(r) < 0.5 ? 1.0f : 0.0f);
        scribble(r, layer->mask, true);
    } else if (what < 0.72) {
        if (layer->filter.op) layer->filter = some_filter(r);
    } else if (what < 0.79) {
        layer->visible = test_random(r) < 0.8;
    } else if (what < 0.86) {
        layer->opacity = test_random(r) < 0.5 ? 1.0f : (float)test_random(r);
        if (test_random(r) < 0.5) layer->blend = (WrBlend)pick(r, WR_BLEND_COUNT);
        else layer->blend = layer->filter.op ? WR_BLEND_MIX : WR_BLEND_ADD;
        layer->radius = 0.3f;
    } else if (what < 0.90) {
        document->solo = test_random(r) < 0.7 ? -1 : i;
    } else if (what < 0.95 && document->layer_count < 6) {
        WrFilter filter = some_filter(r);
        WrLayer made = wr_layer_make_filter("f", &filter, document->layers[0].heights);
        wr_document_insert(document, 2 + pick(r, document->layer_count - 1), made);
    } else if (document->layer_count > 3) {
        wr_document_remove(document, 2 + pick(r, document->layer_count - 2));
    }
}

static void assert_same(const WrField *a, const WrField *b, int step, const char *what)
{
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            if (!same_bits((double)wr_field_get(a, i, j), (double)wr_field_get(b, i, j)))
                fail_msg("edit %d, %s, %dx%d: texel %d,%d is %.9g, made anew %.9g", step, what,
                         wr_field_width(a), wr_field_height(a), i, j, (double)wr_field_get(a, i, j),
                         (double)wr_field_get(b, i, j));
}

static WrDocument *document_of(int width, int height, WrWrap u, WrWrap v)
{
    WrDocument *document = wr_document_new();
    wr_document_start_over(document, wr_field_new(width, height, u, v, 0.0f, NULL));
    wr_document_insert(document, 1, wr_layer_make("second", document->layers[0].heights));
    return document;
}

static void edits_under_filters_give_what_all_of_it_made_anew_gives(void **state)
{
    (void)state;
    static const struct {
        int width, height;
        WrWrap u, v;
    } tables[] = { { 131, 97, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC },
                   { 67, 203, WR_WRAP_CLAMP, WR_WRAP_PERIODIC },
                   { 300, 45, WR_WRAP_PERIODIC, WR_WRAP_CLAMP },
                   { 9, 7, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC } };
    WrPool *pool = wr_pool_new(2);
    for (size_t t = 0; t < sizeof tables / sizeof *tables; t++) {
        TestRandom r = { 19 + t };
        WrDocument *document =
            document_of(tables[t].width, tables[t].height, tables[t].u, tables[t].v);
        for (int k = 0; k < 120; k++) {
            edit(&r, document);
            WrDocument *anew = wr_document_snapshot(document);
            assert_same(wr_document_composite(document, pool), wr_document_field(anew), k,
                        document->layers[document->layer_count - 1].name);
            wr_document_free(anew);
            if (k % 25 < 24) continue; /* a share reuses the cached data */
            WrDocument *shared = wr_document_share(document);
            wr_document_free(document);
            document = shared;
        }
        wr_document_free(document);
    }
    wr_pool_free(pool);
}

/* Each operation after many edits, most of them at the edges, with varying height ranges. */
static void each_operation_made_again_is_the_operation(void **state)
{
    (void)state;
    /* long tables whose last tile is narrower than the filters' support and far from the first */
    static const struct {
        int width, height;
        WrWrap u;
    } tables[] = { { 517, 23, WR_WRAP_PERIODIC }, { 21, 523, WR_WRAP_CLAMP } };
    TestRandom r = { 11 };
    bool seen[64] = { false };
    for (int kind = 0; kind < KINDS; kind++)
        for (int w = 0; w < 2; w++) {
            const WrFilter filter = filter_of(kind, between(&r, 3.2, 5.0));
            const int width = tables[w].width, height = tables[w].height;
            WrField *in = wr_field_new(width, height, tables[w].u, WR_WRAP_PERIODIC, 0.25f, NULL);
            for (int k = 0; k < 40; k++) scribble(&r, in, false);
            WrField *was = wr_field_share(in);
            WrField *made = wr_op_run(filter.op, in, filter.param, NULL, NULL);
            seen[filter.op - wr_ops] = true;
            for (int k = 0; k < 12; k++) {
                int i = k % 3 ? pick(&r, width) : k % 2 ? width - 1 - pick(&r, 4) : pick(&r, 4);
                int j = k % 3       ? pick(&r, height)
                        : k % 4 < 2 ? height - 1 - pick(&r, 4)
                                    : pick(&r, 4);
                if (k == 7) /* from one edge's support to the next tile's */
                    for (int at = 3; at < 62; at++)
                        wr_field_set(in, at % width, at % height, (float)between(&r, -1, 2));
                else if (k % 3 == 1) scribble(&r, in, false);
                else wr_field_set(in, i, j, (float)between(&r, -k, k + 2));
                const WrOpOptions options = { .was = was, .made = made };
                WrField *again = wr_op_run(filter.op, in, filter.param, &options, NULL);
                WrField *anew = wr_op_run(filter.op, in, filter.param, NULL, NULL);
                assert_same(again, anew, k, filter.op->name);
                wr_field_free(anew);
                wr_field_free(made);
                wr_field_free(was);
                made = again;
                was = wr_field_share(in);
            }
            wr_field_free(made);
            wr_field_free(was);
            wr_field_free(in);
        }
    for (int k = 0; k < wr_op_count; k++)
        if (!seen[k] && !wr_ops[k].reshapes) fail_msg("%s was not tried", wr_ops[k].name);
}

/* ---- results, by independent formulas ---- */

static double wrapped(const double *f, int w, int h, int i, int j)
{
    return f[(j % h + h) % h * w + (i % w + w) % w];
}

static void a_filter_is_its_operation_by_opacity_and_mask(void **state)
{
    (void)state;
    enum { W = 37, H = 29 };
    TestRandom r = { 5 };
    WrDocument *document = document_of(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    WrFilter levels, wide;
    WrError err;
    assert_true(
        wr_filter_parse("levels in-low=-0.3 in-high=0.9 out-low=0.1 out-high=1.7", &levels, &err));
    assert_true(wr_filter_parse("dilate radius=1", &wide, &err));
    WrLayer first = wr_layer_make_filter("l", &levels, document->layers[0].heights);
    WrLayer second = wr_layer_make_filter("d", &wide, document->layers[0].heights);
    second.opacity = 0.37f;
    second.mask = like(document, 1.0f);
    wr_document_insert(document, 1, first);
    wr_document_insert(document, 2, second); /* "second" is added on top, unfiltered */
    double base[W * H], low[W * H];
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            wr_field_set(document->layers[0].heights, i, j, (float)between(&r, -1, 2));
            wr_field_set(document->layers[2].mask, i, j, (float)test_random(&r));
            wr_field_set(document->layers[3].heights, i, j, (float)between(&r, -1, 1));
            base[j * W + i] = (double)wr_field_get(document->layers[0].heights, i, j);
            low[j * W + i] = 0.1 + (base[j * W + i] + 0.3) / 1.2 * 1.6;
        }
    const WrField *f = wr_document_field(document);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            double most = low[j * W + i];
            most = fmax(most, fmax(wrapped(low, W, H, i - 1, j), wrapped(low, W, H, i + 1, j)));
            most = fmax(most, fmax(wrapped(low, W, H, i, j - 1), wrapped(low, W, H, i, j + 1)));
            double mask = (double)wr_field_get(document->layers[2].mask, i, j);
            double want = low[j * W + i] + 0.37 * mask * (most - low[j * W + i]) +
                          (double)wr_field_get(document->layers[3].heights, i, j);
            assert_near((double)wr_field_get(f, i, j), want, 2e-6);
        }
    wr_document_free(document);
}

/* ---- costs ---- */

static void count_tile(int tx, int ty, void *ctx)
{
    (void)tx, (void)ty;
    ++*(int *)ctx;
}

/* A dab at a corner below a blur with a support of 12 texels: the tiles at the table's four corners change; no other
   tile is computed or copied. */
static void an_edit_makes_only_the_tiles_again_that_the_filter_reaches(void **state)
{
    (void)state;
    WrDocument *document = document_of(1024, 640, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    TestRandom r = { 7 };
    WrFilter filter;
    WrError err;
    for (int k = 0; k < 400; k++) scribble(&r, document->layers[0].heights, false);
    assert_true(wr_filter_parse("blur sigma=3", &filter, &err));
    wr_document_insert(document, 2,
                       wr_layer_make_filter("blur", &filter, document->layers[0].heights));
    WrField *before = wr_field_share(wr_document_field(document));
    wr_field_set(document->layers[0].heights, 3, 5, 9.0f);
    int changed = 0;
    wr_field_changes(before, wr_document_field(document), count_tile, &changed);
    assert_int_equal(changed, 4);
    wr_field_free(before);
    /* in the middle of a tile: only that tile changes */
    before = wr_field_share(wr_document_field(document));
    wr_field_set(document->layers[0].heights, 64 * 7 + 31, 64 * 4 + 20, 9.0f);
    changed = 0;
    wr_field_changes(before, wr_document_field(document), count_tile, &changed);
    assert_int_equal(changed, 1);
    wr_field_free(before);
    wr_document_free(document);
}

/* ---- its line ---- */

static void what_is_printed_reads_back_and_nothing_else_does(void **state)
{
    (void)state;
    TestRandom r = { 3 };
    for (int k = 0; k < 200; k++) {
        WrFilter filter = some_filter(&r), again;
        WrText text = { 0 };
        WrError err;
        wr_filter_print(&filter, &text);
        if (!wr_filter_parse(text.data, &again, &err)) fail_msg("%s: %s", text.data, err.text);
        assert_true(wr_filter_same(&filter, &again));
        wr_text_fini(&text);
    }
    static const char *const bad[] = { "",
                                       "blu sigma=3",
                                       "blur sigma=",
                                       "blur sigma=3x",
                                       "blur sigma=-1",
                                       "blur radius=3",
                                       "blur sigma",
                                       "blur sigma=1e999",
                                       "resize width=8",
                                       "crop",
                                       "rotate angle=90",
                                       "levels in-low=1 in-high=1",
                                       "clamp low=2 high=1",
                                       "median window=oval",
                                       "dilate radius=65" };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        WrFilter filter;
        WrError err = { "" };
        if (wr_filter_parse(bad[k], &filter, &err)) fail_msg("'%s' was taken", bad[k]);
        assert_true(strlen(err.text) > 0);
    }
}

/* An object whose table is a filter layer depends on changes below the layer. */
static void a_filters_key_changes_with_what_lies_below(void **state)
{
    (void)state;
    WrDocument *document = document_of(33, 21, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    WrFilter filter;
    WrError err;
    assert_true(wr_filter_parse("blur sigma=1.5", &filter, &err));
    wr_document_insert(document, 2,
                       wr_layer_make_filter("b", &filter, document->layers[0].heights));
    uint64_t key = wr_layer_key(document, 2);
    assert_true(key == wr_layer_key(document, 2));
    wr_field_set(document->layers[0].heights, 30, 20, 1.0f);
    assert_true(key != wr_layer_key(document, 2));
    key = wr_layer_key(document, 2);
    document->layers[2].filter.param[0] = 1.75;
    assert_true(key != wr_layer_key(document, 2));
    WrField *alone = wr_document_layer_alone(document, 2, NULL);
    assert_same(alone, wr_document_field(document), 0, "alone");
    wr_field_free(alone);
    wr_document_free(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edits_under_filters_give_what_all_of_it_made_anew_gives),
        cmocka_unit_test(each_operation_made_again_is_the_operation),
        cmocka_unit_test(a_filter_is_its_operation_by_opacity_and_mask),
        cmocka_unit_test(an_edit_makes_only_the_tiles_again_that_the_filter_reaches),
        cmocka_unit_test(what_is_printed_reads_back_and_nothing_else_does),
        cmocka_unit_test(a_filters_key_changes_with_what_lies_below),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

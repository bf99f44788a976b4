/* Stacks of live layers: the bits after random edits, layers that are not needed, and the plan. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/commands.h"
#include "command/layer_plan.h"
#include "document/blend.h"
#include "document/layer_times.h"

#define SIZE "table 97x61"

/* ---- the composite, texel by texel ---- */

static float at(const WrField *field, int i, int j, float otherwise)
{
    return field ? wr_field_get(field, i, j) : otherwise;
}

/* Heights of one size; coverage as the layers above see it, and as layers of the same group do. */
typedef struct Sum {
    const WrField *like;
    bool partial, shown; /* on nothing instead of the ground; false: no layer is visible */
    float *heights, *cover, *inner;
} Sum;

static Sum sum_of(const WrField *like, bool partial)
{
    const size_t texels = (size_t)wr_field_width(like) * (size_t)wr_field_height(like);
    return (Sum){ like,
                  partial,
                  false,
                  wr_alloc(texels, sizeof(float)),
                  wr_alloc(texels, sizeof(float)),
                  wr_alloc(texels, sizeof(float)) };
}

static void free_sum(Sum *sum)
{
    wr_free(sum->heights);
    wr_free(sum->cover);
    wr_free(sum->inner);
}

/* Blends heights of that coverage (NULL: 1) with the settings of a layer. */
static void blend_on(const WrLayer *layer, const WrField *own, const WrField *covered, Sum *sum)
{
    const int width = wr_field_width(own), height = wr_field_height(own);
    const bool filters = layer->filter.op, first = !sum->shown && !filters;
    const WrBlend mode = first && layer->blend == WR_BLEND_ADD ? WR_BLEND_MIX : layer->blend;
    const WrBlend fills = layer->blend == WR_BLEND_MIX ? WR_BLEND_MIX : WR_BLEND_REPLACE;
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            const int k = j * width + i;
            const float h = wr_field_get(own, i, j), cover = at(covered, i, j, 1.0f), one = 1.0f;
            const float mask = at(layer->mask, i, j, 1.0f);
            WrBlendTile tile = { .heights = &h, .cover = &cover, .mask = &mask };
            if (sum->partial && !filters)
                wr_blend_tile_partial(layer->blend, first, layer->opacity, layer->radius, &tile, 1,
                                      &sum->heights[k], &sum->inner[k]);
            else wr_blend_tile(mode, layer->opacity, layer->radius, &tile, 1, &sum->heights[k]);
            tile.heights = &one;
            if (filters) sum->inner[k] = sum->cover[k];
            else wr_blend_tile(fills, layer->opacity, 0.0f, &tile, 1, &sum->cover[k]);
        }
    sum->shown = true;
}

static WrField *table_of(const WrField *like, const float *heights)
{
    WrField *field = wr_field_new(wr_field_width(like), wr_field_height(like),
                                  wr_field_wrap_u(like), wr_field_wrap_v(like), 0.0f, NULL);
    wr_field_write(field, 0, 0, wr_field_width(like), wr_field_height(like), heights,
                   (size_t)wr_field_width(like));
    return field;
}

static Sum composite_rows(const WrLayer *layers, int from, int to, bool partial);

static void add_row(const WrLayer *layers, int first, int index, Sum *sum)
{
    const WrLayer *layer = &layers[index];
    if (!layer->visible || !(layer->opacity > 0.0f)) return;
    if (layer->is_group) {
        Sum inner = composite_rows(layers, first, index, wr_blends[layer->blend].uses_cover);
        WrField *heights = table_of(sum->like, inner.heights);
        WrField *cover = table_of(sum->like, inner.cover);
        if (inner.shown) blend_on(layer, heights, cover, sum);
        wr_field_free(heights);
        wr_field_free(cover);
        free_sum(&inner);
    } else if (layer->filter.op) {
        WrField *below = table_of(sum->like, sum->heights);
        WrField *own = wr_op_run(layer->filter.op, below, layer->filter.param, NULL, NULL);
        blend_on(layer, own, NULL, sum);
        wr_field_free(below);
        wr_field_free(own);
    } else {
        blend_on(layer, layer->heights, layer->cover, sum);
    }
}

static Sum composite_rows(const WrLayer *layers, int from, int to, bool partial)
{
    Sum sum = sum_of(layers[0].heights, partial);
    for (int i = from, first = from; i < to; i++) {
        if (layers[i].depth > layers[to - 1].depth) continue;
        add_row(layers, first, i, &sum);
        first = i + 1;
    }
    return sum;
}

/* The composite of the visible rows from..to-1, of one group or of the top level; owned by the caller. */
static WrField *composite_of(const WrDocument *document, int from, int to)
{
    const int group = from < to ? wr_document_parent(document, to - 1) : -1;
    const bool partial = group >= 0 && wr_blends[document->layers[group].blend].uses_cover;
    Sum sum = composite_rows(document->layers, from, to, partial);
    WrField *made = table_of(sum.like, sum.heights);
    free_sum(&sum);
    return made;
}

/* ---- random edits ---- */

static const char *const stack[] = {
    SIZE,
    "noise gradient cells=3 amplitude=0.731 level=0.113 seed=29",
    "layer add hills from=\"noise perlin cells=4 amplitude=0.31 seed=7 blend=add\"",
    "layer mask 2 live=\"slope low=4 soft=9\"",
    "layer add rain from=\"terrain hydraulic\"",
    "layer add painted",
    "dab 0.3,0.6 radius=14 strength=0.4",
    "filter blur sigma=1.3",
    "layer mask 5 live=\"height low=0.1 soft=0.2; mask of=hills op=max\"",
    "layer add steps from=\"terrain terraces steps=5\"",
    "layer set 6 opacity=0.63",
    "layer add word from=\"text Ab size=31 height=0.4\"",
    "layer mask 7 live=\"curvature scale=1.7 low=-1 high=0.3 soft=0.5; noise op=max\"",
    "layer add rim from=\"rim of=heights kind=round width=5 height=0.2 level=0.4\"",
    "layer add ball from=\"solid sphere radius=13 at=0.6,0.4 blend=max\"",
    "layer mask 9 live=\"wear low=0.1; direction angle=40 op=subtract; occlusion reach=9 op=max\"",
    NULL
};

/* The same layers in two groups, one of them in the other, with copies of layers below and above them. */
static const char *const groups[] = { "layer duplicate hills linked=on",
                                      "layer move \"hills copy\" to=9",
                                      "layer duplicate ball linked=on",
                                      "layer move \"ball copy\" to=2",
                                      "layer set \"ball copy\" blend=max change=\"shift=0.3,0.1\"",
                                      "layer group inner of=hills..painted",
                                      "layer set inner opacity=0.83",
                                      "layer group outer of=inner..word",
                                      "layer set outer blend=smooth-max radius=0.2",
                                      "layer mask outer live=\"height low=0.1 soft=0.3\"",
                                      NULL };

static int pick(TestRandom *random, int count)
{
    return (int)(test_random(random) * count);
}

/* Some of these are refused, as dabs on a generator layer. */
static void edit(WrSession *s, TestRandom *random)
{
    static const char *const changes[] = {
        "hills change=\"cells=%d\"", "rain change=\"seed=%d\"", "steps change=\"steps=%d\"",
        "word change=\"size=2%d\"",  "rim change=\"width=%d\"", "ball change=\"radius=1%d\""
    };
    static const char *const settings[] = { "opacity=0.%d",    "opacity=0",  "opacity=1",
                                            "visible=off",     "visible=on", "visible=on",
                                            "blend=replace",   "blend=mix",  "blend=add",
                                            "blend=smooth-max" };
    const int layers = doc(s)->layer_count;
    const int n = 1 + pick(random, layers), digit = 1 + pick(random, 9);
    char line[128], words[64];
    WrError err;
    switch (pick(random, 9)) {
    case 0:
    case 1: snprintf(words, sizeof words, changes[pick(random, 6)], digit); break;
    case 2:
    case 3: snprintf(words, sizeof words, settings[pick(random, 10)], digit); break;
    default: words[0] = '\0';
    }
    if (strchr(words, '"')) snprintf(line, sizeof line, "layer set %s", words);
    else if (words[0]) snprintf(line, sizeof line, "layer set %d %s", n, words);
    else if (digit < 3) snprintf(line, sizeof line, "layer use %d", n);
    else if (digit < 7)
        snprintf(line, sizeof line, "dab %.4f,%.4f radius=%d strength=0.3", test_random(random),
                 test_random(random), 3 + pick(random, 17));
    else if (digit == 7)
        snprintf(line, sizeof line, "layer move %d to=%d", n, 1 + pick(random, layers));
    else if (digit == 8 && pick(random, 3) == 0)
        snprintf(line, sizeof line, "layer move %d in=%s", n, pick(random, 2) ? "outer" : "none");
    else if (digit == 8 && pick(random, 2)) snprintf(line, sizeof line, "layer solo %d", n);
    else if (digit == 8) snprintf(line, sizeof line, "layer solo off");
    else snprintf(line, sizeof line, pick(random, 3) ? "undo" : "redo");
    wr_session_run(s, line, &err);
}

/* A document with the same layers whose lines and terms all ran again, from the bottom up. */
static WrSession *made_anew(WrSession *s)
{
    WrSession *again = wr_session_new(NULL);
    wr_session_set_outputs(s, true);
    static int files;
    char name[64];
    snprintf(name, sizeof name, "save anew%d.exr", ++files);
    must_run(s, name);
    snprintf(name, sizeof name, "open anew%d.exr", files);
    must_run(again, name);
    must_run(again, "layer solo off");
    for (int i = 0; i < doc(again)->layer_count; i++) {
        const WrLayer layer = wr_layer_share(&doc(again)->layers[i]);
        char number[WR_NUMBER_SIZE];
        WrText line = { 0 };
        if (layer.line) {
            wr_text_addf(&line, "layer set %d from=", i + 1);
            wr_text_add_word(&line, layer.line);
            wr_text_addf(&line, " blend=%s radius=%s", wr_blends[layer.blend].name,
                         wr_number_print((double)layer.radius, number));
            must_run(again, wr_text_get(&line));
        }
        if (layer.mask_line) {
            wr_text_clear(&line);
            wr_text_addf(&line, "layer mask %d live=", i + 1);
            wr_text_add_word(&line, layer.mask_line);
            WrError
                err; /* one whose terms name a layer that is not below any more stays as it is */
            wr_session_run(again, wr_text_get(&line), &err);
        }
        wr_text_fini(&line);
        wr_layer_fini((WrLayer *)&layer);
    }
    return again;
}

static void check_bits(WrSession *s, uint64_t seed)
{
    const WrDocument *document = doc(s);
    if (document->solo >= 0) must_run(s, "layer solo off");
    for (int i = 1; i < document->layer_count; i++) {
        const int from = wr_layers_first_sibling(document->layers, i);
        WrField *below = wr_document_below(document, i, NULL);
        WrField *wanted = composite_of(document, from, wr_layers_first(document->layers, i));
        if (!same_field(below, wanted))
            fail_msg("seed %d: the composite below layer %d differs", (int)seed, i + 1);
        wr_field_free(below);
        wr_field_free(wanted);
    }
    WrSession *again = made_anew(s);
    WrField *wanted = composite_of(doc(again), 0, doc(again)->layer_count);
    if (!same_field(wr_document_field(document), wanted))
        fail_msg("seed %d: the composite differs from that of layers made anew", (int)seed);
    wr_field_free(wanted);
    wr_session_free(again);
}

static void random_edits_leave_the_bits_of_layers_made_anew(void **state)
{
    (void)state;
    const int seeds = getenv("WR_FULL") ? 24 : test_amount(6, 2);
    for (int seed = 0; seed < seeds; seed++) {
        WrSession *s = session_of(stack);
        for (int k = 0; seed % 2 && groups[k]; k++) must_run(s, groups[k]);
        TestRandom random = { 1000 + (uint64_t)seed };
        for (int round = 0; round < 4; round++) {
            for (int k = 0; k < 9; k++) edit(s, &random);
            check_bits(s, (uint64_t)seed);
        }
        wr_session_free(s);
    }
}

/* ---- layers that are not needed ---- */

static int makings(WrSession *s, const char *line)
{
    const uint64_t before = wr_layer_time_last();
    must_run(s, line);
    wr_document_field(doc(s));
    return (int)(wr_layer_time_last() - before);
}

static WrLayerPlan plan_of(const WrSession *s, int layer)
{
    WrLayerPlan plan[WR_LAYERS_MAX];
    wr_session_layer_plan(s, plan);
    return plan[layer - 1];
}

static void check_plan(const WrSession *s, int layer, WrLayerRun run, const char *reason)
{
    const WrLayerPlan plan = plan_of(s, layer);
    if (plan.run != run || !strstr(plan.reason, reason))
        fail_msg("layer %d: %s, %s; not %s, %s", layer, wr_layer_runs[plan.run], plan.reason,
                 wr_layer_runs[run], reason);
}

static const char *const tower[] = { SIZE,
                                     "noise gradient cells=3 amplitude=0.731 seed=29",
                                     "layer add a from=\"terrain terraces steps=5\"",
                                     "layer add b from=\"terrain thermal\"",
                                     "layer add c from=\"pattern dots across=3\"",
                                     "layer mask 4 live=\"slope low=4\"",
                                     "filter blur sigma=1",
                                     "layer add top from=\"pattern bricks blend=add\"",
                                     "layer use 1",
                                     NULL };

static void only_needed_layers_are_made(void **state)
{
    (void)state;
    WrSession *s = session_of(tower);
    wr_document_field(doc(s));
    assert_int_equal(makings(s, "dab 0.3,0.4 radius=9"), 4); /* a, b, the mask and the filter */
    check_plan(s, 1, WR_LAYER_REUSED, "painted");
    check_plan(s, 2, WR_LAYER_EVALUATED, "changed");
    check_plan(s, 4, WR_LAYER_EVALUATED, "changed");
    check_plan(s, 6, WR_LAYER_REUSED, "nothing");
    assert_int_equal(makings(s, "layer set top opacity=0.5"), 0);
    check_plan(s, 2, WR_LAYER_REUSED, "nothing");
    assert_int_equal(makings(s, "layer set 3 visible=off"), 2);
    check_plan(s, 3, WR_LAYER_SKIPPED, "is hidden");
    assert_int_equal(makings(s, "dab 0.7,0.4 radius=9"), 3);
    assert_int_equal(makings(s, "layer set 2 opacity=0"), 2);
    check_plan(s, 2, WR_LAYER_SKIPPED, "opacity is 0");
    assert_int_equal(makings(s, "dab 0.6,0.2 radius=9"), 2);
    /* an opaque layer without a mask covers all below: nothing there is made */
    makings(s, "layer set top blend=replace opacity=1");
    check_plan(s, 4, WR_LAYER_SKIPPED, "layer 6 covers it");
    check_plan(s, 1, WR_LAYER_REUSED, "painted"); /* the active layer is always up to date */
    makings(s, "layer set 1 visible=off");
    assert_int_equal(makings(s, "layer set 5 opacity=0.5"), 0);
    must_run(s, "layer set 1 visible=on");
    /* alone, a layer that reads heights needs those below it, others need none */
    must_run(s, "layer set 2 opacity=1");
    must_run(s, "layer set 3 visible=on");
    must_run(s, "layer solo top");
    check_plan(s, 3, WR_LAYER_SKIPPED, "layer 6 is shown alone");
    assert_int_equal(makings(s, "layer set 2 change=\"steps=7\""), 1);
    check_plan(s, 2, WR_LAYER_EVALUATED, "its own settings");
    assert_int_equal(makings(s, "layer solo 3"), 1);
    /* and all have the right bits when they are shown */
    must_run(s, "layer solo off");
    must_run(s, "layer set top blend=add opacity=0.7");
    check_bits(s, 0);
    wr_session_free(s);
}

/* Merging and rasterizing bake a layer's heights: they are up to date before, covered or not. */
static void covered_layers_are_baked_up_to_date(void **state)
{
    (void)state;
    static const char *const lines[] = { "layer rasterize a", "layer merge 3",
                                         "layer mask 4 live=off", "layer flatten" };
    for (int k = 0; k < 4; k++) {
        WrSession *s = session_of(tower), *other = session_of(tower);
        must_run(s, "layer set top blend=replace");
        must_run(s, "dab 0.7,0.4 radius=11");
        check_plan(s, 3, WR_LAYER_SKIPPED, "covers it");
        must_run(s, lines[k]);
        must_run(other, "dab 0.7,0.4 radius=11");
        if (k == 3) must_run(other, "layer set top blend=replace");
        must_run(other, lines[k]);
        if (k < 3) must_run(s, "layer set top blend=add");
        if (!same_field(wr_document_field(doc(s)), wr_document_field(doc(other))))
            fail_msg("%s: heights of before the dab", lines[k]);
        wr_session_free(s);
        wr_session_free(other);
    }
}

static void the_plan_counts_the_tiles_of_each_layer(void **state)
{
    (void)state;
    WrSession *s = session_of(
        (const char *[]){ "table 192x128", "layer add one", "dab 0.17,0.25 radius=9", NULL });
    /* heights and coverage of one tile of 64 x 64 */
    assert_int_equal(plan_of(s, 2).tiles, 2);
    assert_int_equal(plan_of(s, 2).bytes, 2 * 64 * 64 * 4);
    must_run(s, "layer duplicate 2");
    assert_int_equal(plan_of(s, 2).tiles, 0);
    must_run(s, "dab 0.83,0.75 radius=9");
    assert_int_equal(plan_of(s, 2).tiles, 0);
    assert_int_equal(plan_of(s, 3).tiles, 2);
    must_run(s, "layer add far from=\"pattern bricks\"");
    const WrLayerPlan plan = plan_of(s, 4);
    assert_int_equal(plan.tiles, 6);
    assert_true(plan.seconds > 0.0);
    assert_string_equal(plan.kind, "generator");
    must_run(s, "layer group of=far");
    assert_string_equal(plan_of(s, 5).kind, "group");
    check_plan(s, 5, WR_LAYER_REUSED, "a group");
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_edits_leave_the_bits_of_layers_made_anew),
        cmocka_unit_test(only_needed_layers_are_made),
        cmocka_unit_test(covered_layers_are_baked_up_to_date),
        cmocka_unit_test(the_plan_counts_the_tiles_of_each_layer),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

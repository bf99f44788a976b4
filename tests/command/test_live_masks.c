/* Live masks: each kind on analytic heights, joins, following edits, refusals, files. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/commands.h"
#include "command/linked_copies.h"
#include "document/document_file.h"
#include "field/wrap.h"
#include "scene/scene.h"

#include <math.h>

#define W 167
#define H 131
#define PI 3.14159265358979323846

/* ---- heights as functions of the place, in texels from the middle, y up ---- */

typedef double Function(double x, double y);

/* A session whose layer 1 has these heights (in texels), and an empty layer 2 "top" of opacity 1. */
static WrSession *of_function(Function *f, WrWrap wrap)
{
    WrSession *s = wr_session_new(NULL);
    WrField *field = wr_field_new(W, H, wrap, wrap, 0.0f, NULL);
    const double relief = fabs(doc(s)->scene->height) * W;
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++)
            wr_field_set(field, i, j, (float)(f(i - W / 2, H / 2 - j) / relief));
    WrDocument *document = wr_document_new();
    wr_document_start_over(document, field);
    WrError err;
    if (!wr_document_save(document, "", "f.exr", NULL, &err)) fail_msg("%s", err.text);
    wr_document_free(document);
    must_run(s, "open f.exr");
    must_run(s, "layer add top");
    return s;
}

static void set_mask(WrSession *s, const char *layer, const char *terms)
{
    WrText line = { 0 };
    wr_text_addf(&line, "layer mask %s live=", layer);
    wr_text_add_word(&line, terms);
    must_run(s, wr_text_get(&line));
    wr_text_fini(&line);
}

static void fail_mask(WrSession *s, const char *layer, const char *terms, const char *word)
{
    WrText line = { 0 };
    wr_text_addf(&line, "layer mask %s live=", layer);
    wr_text_add_word(&line, terms);
    must_fail(s, wr_text_get(&line), word);
    wr_text_fini(&line);
}

static const WrField *mask(const WrSession *s, int layer)
{
    return doc(s)->layers[layer].mask;
}

/* The mask of layer 2 is f within a window of the table, except nearer to its middle than `hole`. */
static void compare(const WrSession *s, Function *f, double hole, double tolerance)
{
    assert_non_null(mask(s, 1));
    for (int j = 20; j < H - 20; j++)
        for (int i = 20; i < W - 20; i++) {
            const double x = i - W / 2, y = H / 2 - j, seen = wr_field_get(mask(s, 1), i, j);
            if (hypot(x, y) > hole && fabs(seen - f(x, y)) > tolerance)
                fail_msg("at %g,%g: %.6f instead of %.6f", x, y, seen, f(x, y));
        }
}

/* ---- kinds ---- */

#define BEND 0.0137 /* 1 / texel */

static double dome(double x, double y)
{
    return -0.5 * BEND * (x * x + y * y);
}

static double bowl(double x, double y)
{
    return -dome(x, y);
}

/* Mean curvature of a paraboloid at slope g = BEND r: BEND (2 + g^2) / (2 (1 + g^2)^1.5); a blur only lifts it. The mask
   is that times the scale 3, over 0.05. */
static double bend_of_dome(double x, double y)
{
    const double g = BEND * hypot(x, y), m = 3 * BEND * (2 + g * g) / 2 / pow(1 + g * g, 1.5);
    return m < 0.05 ? m / 0.05 : 1.0;
}

static double nothing(double x, double y)
{
    (void)x, (void)y;
    return 0.0;
}

static void curvature_of_paraboloids(void **state)
{
    (void)state;
    WrSession *s = of_function(dome, WR_WRAP_CLAMP);
    set_mask(s, "top", "curvature scale=3 low=0.05 soft=0.05");
    compare(s, bend_of_dome, 0, 2e-3);
    set_mask(s, "top", "curvature side=concave scale=3 low=0.001 soft=0.001");
    compare(s, nothing, 0, 0);
    set_mask(s, "top", "curvature scale=3 low=-1 high=-0.001 soft=0.001");
    compare(s, nothing, 0, 0);
    /* wear without noise is curvature */
    set_mask(s, "top", "wear scale=3 rough=0 low=0.05 soft=0.05");
    compare(s, bend_of_dome, 0, 2e-3);
    wr_session_free(s);
    s = of_function(bowl, WR_WRAP_CLAMP);
    set_mask(s, "top", "curvature side=concave scale=3 low=0.05 soft=0.05");
    compare(s, bend_of_dome, 0, 2e-3);
    set_mask(s, "top", "curvature scale=3 low=0.001 soft=0.001");
    compare(s, nothing, 0, 0);
    wr_session_free(s);
}

static double cone(double x, double y)
{
    return -0.7 * hypot(x, y);
}

/* Downhill is away from the apex: the angle between that and 40 degrees, of 180. */
static double facing_of_cone(double x, double y)
{
    const double a = fabs(remainder(atan2(y, x) * 180 / PI - 40, 360));
    return 1 - a / 180;
}

static double steep(double x, double y)
{
    (void)x, (void)y;
    return (atan(0.7) * 180 / PI - 20) / 30; /* low=50 soft=30 */
}

static void direction_and_slope_of_a_cone(void **state)
{
    (void)state;
    WrSession *s = of_function(cone, WR_WRAP_CLAMP);
    set_mask(s, "top", "direction angle=40 low=0 high=0 soft=180");
    compare(s, facing_of_cone, 10, 2e-3);
    set_mask(s, "top", "slope low=50 high=90 soft=30");
    compare(s, steep, 10, 5e-3);
    wr_session_free(s);
    s = of_function(nothing, WR_WRAP_PERIODIC); /* level: no direction */
    set_mask(s, "top", "direction angle=40 low=0 high=179 soft=0");
    compare(s, nothing, 0, 0);
    wr_session_free(s);
}

static double valley(double x, double y)
{
    (void)y;
    return 1.3 * fabs(x);
}

/* At the bottom of a valley the horizon in direction a has the slope 1.3 |cos a|: the mean of 1 / (1 + H^2) is
   1 / sqrt(1 + 1.3^2). More of the sky is open on its sides. */
static void occlusion_of_a_valley(void **state)
{
    (void)state;
    WrSession *s = of_function(valley, WR_WRAP_CLAMP);
    set_mask(s, "top", "occlusion reach=17 low=0 high=0 soft=1");
    const double seen = 1.0 - wr_field_get(mask(s, 1), W / 2, H / 2);
    if (fabs(seen - 1 / sqrt(1 + 1.3 * 1.3)) > 0.01) fail_msg("sky %.4f", seen);
    assert_true(wr_field_get(mask(s, 1), W / 2 + 30, H / 2) < 1.0 - seen - 0.1);
    wr_session_free(s);
    s = of_function(cone, WR_WRAP_CLAMP); /* nothing is higher than its apex */
    set_mask(s, "top", "occlusion low=0 high=0 soft=1");
    assert_true(wr_field_get(mask(s, 1), W / 2, H / 2) < 1e-6f);
    wr_session_free(s);
    s = of_function(nothing, WR_WRAP_PERIODIC);
    set_mask(s, "top", "occlusion");
    compare(s, nothing, 0, 0);
    wr_session_free(s);
}

static double waves(double x, double y)
{
    return 4.1 * sin(2 * PI * 3 * (x + W / 2 + 0.5) / W) + 2.3 * cos(2 * PI * 2 * y / H);
}

/* On an empty layer the composite is that of the layers below. */
static void height_and_slope_have_the_bits_of_plain_masks(void **state)
{
    (void)state;
    static const char *const ranges[] = { "height low=-0.013 high=0.207 soft=0.05",
                                          "height high=0.1", "slope low=7 high=19 soft=3.3",
                                          "slope low=11" };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        WrSession *live = of_function(waves, WR_WRAP_PERIODIC);
        WrSession *plain = of_function(waves, WR_WRAP_PERIODIC);
        WrText line = { 0 };
        wr_text_addf(&line, "layer mask top from=%s", ranges[i]);
        set_mask(live, "top", ranges[i]);
        must_run(plain, wr_text_get(&line));
        assert_true(same_field(mask(live, 1), mask(plain, 1)));
        must_run(live, "layer mask top live=off");
        assert_true(wr_hash_equal(wr_session_hash(live), wr_session_hash(plain)));
        wr_text_fini(&line);
        wr_session_free(live);
        wr_session_free(plain);
    }
}

static void noise_is_that_of_the_generator_in_0_to_1(void **state)
{
    (void)state;
    WrSession *s = of_function(nothing, WR_WRAP_PERIODIC);
    must_run(s, "noise perlin cells=11 octaves=3 seed=77 amplitude=0.5 level=0.5");
    must_run(s, "layer add two");
    set_mask(s, "two", "noise cells=11 octaves=3 seed=77 low=1 high=1 soft=1");
    const WrField *made = mask(s, 2), *noise = doc(s)->layers[1].heights;
    double sum = 0, low = 1, high = 0;
    for (int k = 0; k < W * H; k++) {
        const double m = wr_field_get(made, k % W, k / W), n = wr_field_get(noise, k % W, k / W);
        if (!(m >= 0 && m <= 1) || fabs(m - fmin(fmax(n, 0), 1)) > 1e-6)
            fail_msg("%.7f for noise %.7f", m, n);
        sum += m, low = fmin(low, m), high = fmax(high, m);
    }
    assert_true(fabs(sum / (W * H) - 0.5) < 0.05 && low < 0.3 && high > 0.7);
    WrField *kept = wr_field_share(made);
    set_mask(s, "two", "noise cells=11 octaves=3 seed=78 low=1 high=1 soft=1");
    assert_false(same_field(kept, mask(s, 2)));
    /* on level ground wear is the noise alone: 0.3 (2 n - 1) >= 0.03 where n >= 0.55 */
    set_mask(s, "two", "wear of=1 rough=0.3 cells=11 octaves=3 seed=77 low=0.03 soft=0");
    for (int k = 0; k < W * H; k++) {
        const double n = wr_field_get(noise, k % W, k / W);
        if (fabs(n - 0.55) > 1e-5)
            assert_int_equal(wr_field_get(mask(s, 2), k % W, k / W) == 1.0f, n > 0.55);
    }
    wr_field_free(kept);
    wr_session_free(s);
}

/* ---- joins ---- */

static void terms_join_in_order(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){
        "table 97x61", "layer add a", "select ellipse centre=0.4,0.5 radii=0.3,0.4",
        "select feather by=7", "layer mask a from=selection", "layer add b",
        "select rect from=0.3,0.2 to=0.8,0.9", "select feather by=5", "layer mask b from=selection",
        "select none", "layer set b visible=off", "layer add top", NULL });
    const WrField *a = mask(s, 1), *b = mask(s, 2);
    static const char *const lines[] = {
        "mask of=a; mask of=b",
        "mask of=a; mask of=b op=subtract",
        "mask of=a op=max; mask of=b op=max",
        "mask of=a; mask of=b invert=on",
        "mask of=a op=subtract; mask of=b op=max; mask of=b op=multiply",
        "mask of=a op=subtract invert=on; mask of=2 op=subtract; mask of=3 op=max",
    };
    for (int n = 0; n < 6; n++) {
        set_mask(s, "top", lines[n]);
        for (int k = 0; k < 97 * 61; k++) {
            const float x = wr_field_get(a, k % 97, k / 97), y = wr_field_get(b, k % 97, k / 97);
            const float expected[] = {
                x * y,       fmaxf(0, x - y),     fmaxf(x, y),
                x * (1 - y), fmaxf(1 - x, y) * y, fmaxf(fmaxf(0, x - x), y)
            };
            if (wr_field_get(mask(s, 3), k % 97, k / 97) != expected[n])
                fail_msg("%s at %d", lines[n], k);
        }
    }
    assert_string_equal(doc(s)->layers[3].mask_line,
                        "mask of=a op=subtract invert=on; mask of=a op=subtract; mask of=b op=max");
    /* a layer without a mask shows all */
    set_mask(s, "top", "mask of=base invert=on");
    assert_true(wr_field_get(mask(s, 3), 5, 5) == 0.0f);
    wr_session_free(s);
}

/* ---- following ---- */

/* The mask has the bits of one that is made now. */
static void is_up_to_date(WrSession *s, int layer)
{
    WrText line = { 0 };
    WrField *seen = wr_field_share(mask(s, layer));
    char number[12];
    snprintf(number, sizeof number, "%d", layer + 1);
    wr_text_add(&line, doc(s)->layers[layer].mask_line);
    set_mask(s, number, wr_text_get(&line));
    assert_true(same_field(seen, mask(s, layer)));
    must_run(s, "undo");
    wr_field_free(seen);
    wr_text_fini(&line);
}

static WrSession *masked(const char *terms)
{
    WrSession *s = of_function(waves, WR_WRAP_PERIODIC);
    must_run(s, "fill 0.31");
    set_mask(s, "top", terms);
    return s;
}

static void masks_follow_the_layers_below(void **state)
{
    (void)state;
    static const char *const lines[] = { "height low=0.013 high=0.207 soft=0.05",
                                         "slope low=7 soft=5",
                                         "direction soft=60",
                                         "curvature low=0.01 soft=0.01",
                                         "occlusion high=0.9",
                                         "wear low=0.05",
                                         NULL };
    for (int i = 0; lines[i]; i++) {
        WrSession *s = masked(lines[i]);
        const uint64_t first = wr_field_key(mask(s, 1));
        const WrHash before = wr_session_hash(s);
        /* an edit of the masked layer, or above, changes nothing below */
        must_run(s, "dab 0.5,0.5 radius=9");
        must_run(s, "layer add above");
        must_run(s, "fill 1");
        assert_int_equal(wr_field_key(mask(s, 1)), first);
        must_run(s, "layer use 1");
        must_run(s, "dab 0.31,0.77 radius=13 strength=0.4");
        assert_int_not_equal(wr_field_key(mask(s, 1)), first);
        is_up_to_date(s, 1);
        const WrHash after = wr_session_hash(s);
        must_run(s, "undo 4");
        assert_true(wr_hash_equal(wr_session_hash(s), before));
        must_run(s, "redo 4");
        assert_true(wr_hash_equal(wr_session_hash(s), after));
        wr_session_free(s);
    }
}

/* Every setting of a layer below that changes the composite. */
static void settings_of_layers_below_count(void **state)
{
    (void)state;
    static const char *const lines[] = { "layer set mid opacity=0.6",
                                         "layer set mid blend=max",
                                         "layer set mid visible=off",
                                         "layer set mid visible=on",
                                         "layer mask mid from=height low=0.2",
                                         "layer set mid blend=smooth-max radius=0.2",
                                         "layer set mid radius=0.1",
                                         "filter blur sigma=9 layer=2",
                                         "layer set 2 opacity=0.5",
                                         "layer move mid to=2",
                                         "layer delete mid" };
    WrSession *s = of_function(waves, WR_WRAP_PERIODIC);
    must_run(s, "layer use 1");
    must_run(s, "filter blur sigma=2");
    must_run(s, "layer add mid");
    must_run(s, "ramp radial from=0.4,0.5 to=0.7,0.5 high=0.2");
    must_run(s, "layer use top");
    must_run(s, "fill 0.2");
    set_mask(s, "top", "curvature low=0.01 soft=0.3");
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        const int top = doc(s)->layer_count - 1;
        const uint64_t key = wr_field_key(mask(s, top));
        must_run(s, lines[i]);
        if (wr_field_key(mask(s, doc(s)->layer_count - 1)) == key) fail_msg("%s", lines[i]);
        is_up_to_date(s, doc(s)->layer_count - 1);
    }
    wr_session_free(s);
}

/* Tiles out of reach of an edit stay the same memory: composites and the history are spared them. */
static void far_tiles_are_shared(void **state)
{
    (void)state;
    WrSession *s = masked("slope low=7 soft=5");
    must_run(s, "layer use 1");
    const float *near = wr_field_tile(mask(s, 1), 0, 0), *far = wr_field_tile(mask(s, 1), 2, 2);
    assert_non_null(far);
    must_run(s, "dab 0.2,0.8 radius=9 strength=0.4");
    assert_ptr_equal(wr_field_tile(mask(s, 1), 2, 2), far);
    assert_ptr_not_equal(wr_field_tile(mask(s, 1), 0, 0), near);
    wr_session_free(s);
}

static void only_slopes_follow_the_scenes_height(void **state)
{
    (void)state;
    static const char *const lines[] = { "height low=0.01", "slope low=7 soft=5",
                                         "direction soft=60", "curvature low=0.01 soft=0.01",
                                         "noise" };
    for (int i = 0; i < 5; i++) {
        WrSession *s = masked(lines[i]);
        const uint64_t first = wr_field_key(mask(s, 1));
        must_run(s, "bump height=0.0731");
        assert_int_equal(wr_field_key(mask(s, 1)) != first, i == 1 || i == 3);
        is_up_to_date(s, 1);
        must_run(s, "bump height=0"); /* and level ground is no error */
        wr_session_free(s);
    }
}

static void hidden_layers_are_made_when_shown(void **state)
{
    (void)state;
    WrSession *s = masked("slope low=7 soft=5");
    const uint64_t first = wr_field_key(mask(s, 1));
    must_run(s, "layer set 2 visible=off");
    must_run(s, "layer use 1");
    must_run(s, "dab 0.31,0.77 radius=13 strength=0.4");
    assert_int_equal(wr_field_key(mask(s, 1)), first);
    must_run(s, "layer set 2 visible=on");
    assert_int_not_equal(wr_field_key(mask(s, 1)), first);
    is_up_to_date(s, 1);
    const uint64_t shown = wr_field_key(mask(s, 1));
    must_run(s, "layer solo 1");
    must_run(s, "dab 0.5,0.2 radius=13 strength=0.4");
    assert_int_equal(wr_field_key(mask(s, 1)), shown);
    must_run(s, "layer solo off");
    is_up_to_date(s, 1);
    /* a hidden layer whose mask a shown one reads is made too */
    must_run(s, "layer set 2 visible=off");
    must_run(s, "layer add reader above=top");
    set_mask(s, "reader", "mask of=top");
    must_run(s, "layer use 1");
    const uint64_t read = wr_field_key(mask(s, 1));
    must_run(s, "dab 0.5,0.7 radius=13 strength=0.4");
    assert_int_not_equal(wr_field_key(mask(s, 1)), read);
    assert_true(same_field(mask(s, 1), mask(s, 2)));
    wr_session_free(s);
}

/* A chain: the mask of 2 follows 1, the mask of 3 that of 2, a generator on 4 all of them. */
static void chains_are_made_from_the_bottom_up(void **state)
{
    (void)state;
    WrSession *s = masked("height low=0.05 soft=0.05");
    must_run(s, "layer add three");
    must_run(s, "fill 0.2");
    set_mask(s, "three", "mask of=top invert=on; curvature");
    must_run(s, "layer add worn from=\"terrain terraces steps=5\"");
    must_run(s, "layer use 1");
    const uint64_t second = wr_field_key(mask(s, 1)), third = wr_field_key(mask(s, 2)),
                   heights = wr_field_key(doc(s)->layers[3].heights);
    must_run(s, "dab 0.31,0.77 radius=13 strength=0.4");
    assert_int_not_equal(wr_field_key(mask(s, 1)), second);
    assert_int_not_equal(wr_field_key(mask(s, 2)), third);
    assert_int_not_equal(wr_field_key(doc(s)->layers[3].heights), heights);
    is_up_to_date(s, 1);
    is_up_to_date(s, 2);
    wr_session_free(s);
}

static void other_layers_are_named_for_good(void **state)
{
    (void)state;
    Said said;
    WrSession *s = listening(&said);
    must_run(s, "table 97x61");
    must_run(s, "layer add \"a\\\"; b\"");
    must_run(s, "noise perlin");
    must_run(s, "layer add top");
    must_run(s, "fill 1");
    set_mask(s, "top", "height of=2 low=0.5");
    assert_string_equal(doc(s)->layers[2].mask_line, "height low=0.5 of=\"a\\\"; b\"");
    is_up_to_date(s, 2);
    must_run(s, "layer rename 2 c");
    assert_string_equal(doc(s)->layers[2].mask_line, "height low=0.5 of=c");
    must_run(s, "layer use 1");
    must_run(s, "dab 0.5,0.5 radius=9"); /* of another layer than the one it reads */
    is_up_to_date(s, 2);
    const WrHash kept = wr_field_hash(mask(s, 2));
    must_run(s, "layer delete c");
    must_run(s, "layer use 1");
    must_run(s, "dab 0.2,0.5 radius=9");
    assert_non_null(strstr(said.text, "no layer \"c\" is below it"));
    assert_true(wr_hash_equal(kept, wr_field_hash(mask(s, 1))));
    must_run(s, "undo 3");
    must_run(s, "layer move c to=3");
    assert_true(wr_hash_equal(kept, wr_field_hash(mask(s, 1))));
    /* never a layer above: no cycle */
    fail_mask(s, "2", "height of=c low=0.5", "is not below layer 2");
    fail_mask(s, "2", "mask of=top", "is not below layer 2");
    fail_mask(s, "1", "curvature", "no layers below");
    set_mask(s, "1", "noise");
    wr_session_free(s);
}

static void whole_tables_take_live_masks_along(void **state)
{
    (void)state;
    WrSession *s = masked("slope low=7 soft=5");
    static const char *const lines[] = { "adjust offset du=7 layers=all",
                                         "table 83x77 content=resample",
                                         "transform rotate=90 layers=all" };
    for (int i = 0; i < 3; i++) {
        WrError err;
        if (!wr_session_run(s, lines[i], &err)) continue; /* at least one must run */
        assert_non_null(doc(s)->layers[1].mask_line);
        is_up_to_date(s, 1);
    }
    must_run(s, "layer duplicate 2");
    assert_string_equal(doc(s)->layers[2].mask_line, doc(s)->layers[1].mask_line);
    must_run(s, "layer merge 3");
    assert_null(doc(s)->layers[1].mask_line);
    wr_session_free(s);
}

static void live_masks_are_not_painted_on(void **state)
{
    (void)state;
    WrSession *s = masked("slope low=7 soft=5");
    must_run(s, "layer use 2 part=mask");
    must_fail(s, "dab 0.5,0.5 radius=4", "live=off");
    must_fail(s, "fill 1", "live=off");
    must_fail(s, "layer mask 2", "from= or live=");
    must_fail(s, "layer mask 2 from=white live=noise", "from= or live=");
    must_fail(s, "layer mask 2 live=noise low=1", "into live=");
    const WrHash seen = wr_field_hash(wr_document_field(doc(s)));
    const WrHash live = wr_session_hash(s);
    must_run(s, "layer mask 2 live=off");
    assert_false(wr_hash_equal(live, wr_session_hash(s)));
    assert_true(wr_hash_equal(seen, wr_field_hash(wr_document_field(doc(s)))));
    must_run(s, "dab 0.5,0.5 radius=4 mode=to to=0");
    must_fail(s, "layer mask 2 live=off", "no live mask");
    must_run(s, "undo 2");
    must_run(s, "layer mask 2 from=inverse");
    assert_null(doc(s)->layers[1].mask_line);
    must_run(s, "undo");
    assert_non_null(doc(s)->layers[1].mask_line);
    must_run(s, "layer mask 2 from=none");
    assert_null(doc(s)->layers[1].mask_line);
    wr_session_free(s);
}

static void bad_terms_are_refused(void **state)
{
    (void)state;
    WrSession *s = masked("noise");
    static const char *const lines[][2] = {
        { "", "KIND" },
        { ";", "KIND" },
        { "noise;", "KIND" },
        { "hight low=1", "did you mean height" },
        { "slope lo=1", "low" },
        { "slope low=-1", "0..90" },
        { "height low=2 high=1", "must not be above high" },
        { "height low=nan", "must be" },
        { "height of=nobody", "no layer" },
        { "height of=top", "is not below" },
        { "mask", "of" },
        { "noise low=1 low=2", "given twice" },
        { "noise op=divide", "must be" },
        { "mask of=\"", "quote" },
        { "noise;noise;noise;noise;noise;noise;noise;noise;noise;noise;noise;noise;noise;noise;"
          "noise;noise;noise",
          "up to 16" },
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        fail_mask(s, "top", lines[i][0], lines[i][1]);
    wr_session_free(s);
}

/* ---- files ---- */

static void save_and_open(const char *name)
{
    char line[100];
    WrSessionOptions options = { .outputs = true };
    WrSession *s = masked("slope low=7 soft=5; noise op=max"), *again = wr_session_new(&options);
    wr_session_set_outputs(s, true);
    snprintf(line, sizeof line, "save %s", name);
    must_run(s, line);
    snprintf(line, sizeof line, "open %s", name);
    must_run(again, line);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    assert_string_equal(doc(again)->layers[1].mask_line, "slope low=7 soft=5; noise op=max");
    const uint64_t key = wr_field_key(mask(again, 1));
    must_run(again, "layer use 1");
    assert_int_equal(wr_field_key(mask(again, 1)), key); /* unchanged layers make no mask again */
    must_run(s, "layer use 1");
    must_run(s, "dab 0.31,0.77 radius=13 strength=0.4");
    must_run(again, "dab 0.31,0.77 radius=13 strength=0.4");
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    /* a hidden mask that was not up to date is made when the opened layer is shown */
    must_run(s, "layer set 2 visible=off");
    must_run(s, "dab 0.6,0.2 radius=13 strength=0.4");
    snprintf(line, sizeof line, "save %s replace=on", name);
    WrError err;
    if (!wr_session_run(s, line, &err)) {
        snprintf(line, sizeof line, "save %s", name);
        must_run(s, line);
    }
    snprintf(line, sizeof line, "open %s", name);
    must_run(again, line);
    must_run(again, "layer set 2 visible=on");
    is_up_to_date(again, 1);
    wr_session_free(s);
    wr_session_free(again);
}

/* As a recovery runs them. */
static void the_lines_of_the_history_make_the_same_masks(void **state)
{
    (void)state;
    WrSession *s = masked("wear low=0.05; noise op=subtract"), *again = wr_session_new(NULL);
    wr_session_set_outputs(s, true);
    must_run(s, "layer use 1");
    must_run(s, "dab 0.31,0.77 radius=13 strength=0.4");
    must_run(s, "bump height=0.07");
    must_run(s, "layer rename 1 \"the ground\"");
    must_run(s, "layer mask 2 live=\"slope low=9 of=1\"");
    must_run(s, "script all.wrinkle");
    WrError err;
    if (!wr_session_run_script(again, "all.wrinkle", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(again), wr_session_hash(s)));
    wr_session_free(s);
    wr_session_free(again);
}

static void files_keep_the_terms(void **state)
{
    (void)state;
    save_and_open("kept.exr");
    save_and_open("kept.ora");
}

/* As a program of another version, or an enemy, would write them. */
static void terms_that_are_not_known_leave_the_mask(void **state)
{
    (void)state;
    char *deep = wr_alloc(70001, 1);
    memset(deep, ';', 70000);
    const char *const lines[] = { "storm force=3",
                                  "slope low=7 tint=2",
                                  "height low=5 high=1",
                                  "mask of=nobody",
                                  "height of=top",
                                  "noise \"",
                                  ";;;",
                                  "curvature scale=1e99",
                                  deep };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        WrSession *s = masked("slope low=7 soft=5");
        WrDocument *document = wr_document_share(doc(s));
        const WrHash seen = wr_field_hash(wr_document_field(document));
        WrError err;
        wr_layer_set_mask_line(&document->layers[1], lines[i], (WrHash){ 5, 6 });
        if (!wr_document_save(document, "", "odd.exr", NULL, &err)) fail_msg("%s", err.text);
        wr_document_free(document);
        Said said;
        WrSession *other = listening(&said);
        must_run(other, "open odd.exr");
        must_run(other, "layer use 1");
        assert_true(wr_hash_equal(seen, wr_field_hash(wr_document_field(doc(other)))));
        if (!strstr(said.text, "its live mask stays as it is")) fail_msg("%.40s", lines[i]);
        const WrHash kept = wr_field_hash(mask(other, 1));
        must_run(other, "dab 0.5,0.5 radius=4");
        assert_true(wr_hash_equal(kept, wr_field_hash(mask(other, 1))));
        must_run(other, "save odd.ora"); /* and it stays writable, with the terms */
        must_run(other, "open odd.ora");
        assert_string_equal(doc(other)->layers[1].mask_line, lines[i]);
        must_run(other, "layer mask 2 live=off");
        wr_session_free(other);
        wr_session_free(s);
    }
    wr_free(deep);
}

/* ---- masks made again where the layers below change ---- */

static double chance(uint32_t *seed)
{
    *seed = wr_mix32(*seed + 0x9e3779b9U);
    return (*seed >> 8) * 0x1p-24;
}

/* A random edit of the layers below; some cross the edges. */
static void edit(WrSession *s, uint32_t *seed)
{
    char line[160];
    const double u = chance(seed), v = chance(seed), radius = 2.0 + 30.0 * chance(seed);
    must_run(s, chance(seed) < 0.5 ? "layer use 1" : "layer use ball");
    snprintf(line, sizeof line, "dab %.6f,%.6f radius=%.3f strength=%.4f", u, v, radius,
             chance(seed) - 0.5);
    const double kind = chance(seed);
    if (kind < 0.2)
        snprintf(line, sizeof line, "layer set disc change=\"at=%.6f,%.6f radius=%.3f\"", u, v,
                 radius);
    else if (kind < 0.3) snprintf(line, sizeof line, "layer set disc opacity=%.4f", u);
    else if (kind < 0.4) snprintf(line, sizeof line, "undo");
    must_run(s, line);
}

static WrSession *under(const char *table)
{
    WrSession *s = wr_session_new(NULL);
    must_run(s, table);
    must_run(s, "noise perlin cells=5 amplitude=0.1");
    must_run(s, "layer add ball blend=max");
    must_run(s, "layer mask ball from=white");
    must_run(s, "layer add disc from=\"solid cylinder at=0.9,0.1 radius=20 height=0.2\"");
    must_run(s, "layer add top");
    return s;
}

/* One session has the mask, or the layer, all the time, and makes it again near the edits; the other makes it once, whole.
   terms: of a mask of the layer "top"; or NULL: line: of a new layer above it */
static void local_and_whole(const char *table, const char *terms, const char *line, uint32_t seed)
{
    WrSession *local = under(table), *whole = under(table);
    uint32_t same = seed;
    if (terms) set_mask(local, "top", terms);
    else must_run(local, line);
    must_run(local, "layer use 1");
    must_run(local, "dab 0.5,0.5"); /* undo must not reach the mask */
    must_run(whole, "layer use 1");
    must_run(whole, "dab 0.5,0.5");
    for (int k = 0; k < 12; k++) {
        edit(local, &seed);
        edit(whole, &same);
    }
    must_run(whole, "layer use top");
    if (terms) set_mask(whole, "top", terms);
    else must_run(whole, line);
    for (int k = 3; k < doc(local)->layer_count; k++) {
        const WrHash a = wr_layer_content_hash(&doc(local)->layers[k]);
        const WrHash b = wr_layer_content_hash(&doc(whole)->layers[k]);
        if (!wr_hash_equal(a, b) ||
            (terms && !wr_hash_equal(wr_field_hash(mask(local, k)), wr_field_hash(mask(whole, k)))))
            fail_msg("%s, %s: not as made whole", table, terms ? terms : line);
    }
    wr_session_free(local);
    wr_session_free(whole);
}

static const char *const odd_tables[] = { "table 421x613", "table 587x449 wrap=clamp",
                                          "table 391x709 wrap=clamp-u" };

static void masks_made_near_edits_are_those_made_whole(void **state)
{
    (void)state;
    static const char *const terms[] = {
        "height low=0.02 high=0.4 soft=0.1",
        "slope low=5 high=40 soft=10",
        "direction angle=30",
        "curvature scale=1.7 soft=0.3",
        "curvature side=concave scale=0.4",
        "curvature scale=17",
        "occlusion reach=11",
        "wear scale=2.3",
        "slope; noise cells=7 op=subtract invert=on",
        "mask of=ball; curvature of=disc op=max",
        "height low=0.1; occlusion reach=5 of=ball op=subtract; noise cells=3 op=max",
    };
    uint32_t seed = 17;
    for (size_t i = 0; i < sizeof terms / sizeof *terms; i++)
        local_and_whole(odd_tables[i % 3], terms[i], NULL, seed += 101);
}

static void layers_made_near_edits_are_those_made_whole(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "layer add made from=\"terrain terraces steps=5 jitter=0.7 origin=0.31,0.77\"",
        "layer add made from=\"rim of=heights level=0.06 width=7.3\"",
        "layer add made from=\"rim of=heights kind=outline level=0.1 width=5\"",
        "layer add made from=\"rim kind=emboss layer=ball level=0.05 width=9\"",
        "layer add made from=\"rim kind=round layer=disc width=4\"",
        "layer add made from=\"rim of=heights kind=ridge level=0.1 width=5\"",
    };
    uint32_t seed = 3;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        local_and_whole(odd_tables[i % 3], NULL, lines[i], seed += 103);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(curvature_of_paraboloids),
        cmocka_unit_test(direction_and_slope_of_a_cone),
        cmocka_unit_test(occlusion_of_a_valley),
        cmocka_unit_test(height_and_slope_have_the_bits_of_plain_masks),
        cmocka_unit_test(noise_is_that_of_the_generator_in_0_to_1),
        cmocka_unit_test(terms_join_in_order),
        cmocka_unit_test(masks_follow_the_layers_below),
        cmocka_unit_test(settings_of_layers_below_count),
        cmocka_unit_test(far_tiles_are_shared),
        cmocka_unit_test(masks_made_near_edits_are_those_made_whole),
        cmocka_unit_test(layers_made_near_edits_are_those_made_whole),
        cmocka_unit_test(only_slopes_follow_the_scenes_height),
        cmocka_unit_test(hidden_layers_are_made_when_shown),
        cmocka_unit_test(chains_are_made_from_the_bottom_up),
        cmocka_unit_test(other_layers_are_named_for_good),
        cmocka_unit_test(whole_tables_take_live_masks_along),
        cmocka_unit_test(live_masks_are_not_painted_on),
        cmocka_unit_test(bad_terms_are_refused),
        cmocka_unit_test(the_lines_of_the_history_make_the_same_masks),
        cmocka_unit_test(files_keep_the_terms),
        cmocka_unit_test(terms_that_are_not_known_leave_the_mask),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

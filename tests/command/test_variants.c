/* Variants: the bits of documents made directly, changes of layers, files of each variant, documents, recovery. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"
#include "recovery_help.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/variants.h"
#include "document/blend.h"
#include "document/document_file.h"

#include <stdio.h>

/* ---- a document, and random values of its layers ---- */

static const char *const setup[] = {
    "table 97x61",
    "noise gradient cells=3 amplitude=0.731 level=0.113 seed=29",
    "layer add wall from=\"pattern bricks rows=3 across=2\"",
    "layer add dirt",
    "fill 0.17",
    "dab 0.3,0.6 radius=17 strength=0.4",
    "layer mask dirt live=\"height low=0.2 high=0.5 soft=0.1 of=wall\"",
    "layer add copy from=\"link dirt\"",
    "layer add worn from=\"terrain terraces steps=4\"",
    "filter blur sigma=1.3",
    "layer add sign from=\"text Wri size=19\"",
};

static WrSession *document(void)
{
    WrSession *s = wr_session_new(&(WrSessionOptions){ .outputs = true });
    for (size_t i = 0; i < sizeof setup / sizeof *setup; i++) must_run(s, setup[i]);
    return s;
}

/* Give all layers values that depend on k only. */
static void set_values(WrSession *s, int k)
{
    TestRandom r = { (uint64_t)k * 77 + 5 };
    char line[300];
    for (int i = 0; i < doc(s)->layer_count; i++) {
        const char *blend = wr_blends[test_random_u64(&r) % WR_BLEND_COUNT].name;
        const double opacity = test_random(&r), radius = test_random(&r);
        snprintf(line, sizeof line, "layer set %d blend=%s opacity=%.7g radius=%.7g visible=%s",
                 i + 1, blend, opacity, radius, test_random_u64(&r) % 4 ? "on" : "off");
        must_run(s, line);
    }
    snprintf(line, sizeof line, "layer set wall change=\"rows=%d joint=%.4g\"",
             1 + (int)(test_random_u64(&r) % 5), 1 + 3 * test_random(&r));
    must_run(s, line);
    snprintf(line, sizeof line, "layer set copy change=\"shift=%.3f,0 factor=%.3f\"",
             test_random(&r), test_random(&r));
    must_run(s, line);
    snprintf(line, sizeof line, "layer set worn change=\"steps=%d\"",
             2 + (int)(test_random_u64(&r) % 5));
    must_run(s, line);
    snprintf(line, sizeof line, "layer set sign change=\"size=%.4g\"", 11 + 9 * test_random(&r));
    must_run(s, line);
    snprintf(line, sizeof line, "layer mask dirt live=\"%s; noise cells=%d op=max\"",
             k % 2 ? "height low=0.1 of=wall" : "slope high=30 soft=20",
             1 + (int)(test_random_u64(&r) % 7));
    must_run(s, line);
    snprintf(line, sizeof line, "filter blur sigma=%.4g layer=6", 0.3 + 2 * test_random(&r));
    must_run(s, line);
    must_run(s, "layer use 1"); /* where `filter` leaves it is of no interest */
}

static WrSession *direct(int k)
{
    WrSession *s = document();
    set_values(s, k);
    return s;
}

/* Stores variants v0, v1, ... */
static WrSession *with_variants(int count)
{
    WrSession *s = document();
    char line[40];
    for (int k = 0; k < count; k++) {
        set_values(s, k);
        snprintf(line, sizeof line, "variant add v%d", k);
        must_run(s, line);
    }
    return s;
}

static bool same_or_none(const WrField *a, const WrField *b)
{
    return a && b ? same_field(a, b) : a == b;
}

/* Equal except for the variants themselves. Contents of hidden layers do not follow, and are not compared. */
static void compare(const WrSession *s, const WrSession *other, const char *where)
{
    if (!same_field(wr_document_field(doc(s)), wr_document_field(doc(other))))
        fail_msg("%s: the composite differs", where);
    assert_int_equal(doc(s)->layer_count, doc(other)->layer_count);
    for (int i = 0; i < doc(s)->layer_count; i++) {
        const WrLayer *a = &doc(s)->layers[i], *b = &doc(other)->layers[i];
        assert_string_equal(a->name, b->name);
        assert_true(a->visible == b->visible && a->blend == b->blend);
        assert_true(a->opacity == b->opacity && a->radius == b->radius);
        assert_string_equal(a->line ? a->line : "", b->line ? b->line : "");
        assert_string_equal(a->mask_line ? a->mask_line : "", b->mask_line ? b->mask_line : "");
        assert_true(wr_filter_same(&a->filter, &b->filter));
        if (!a->visible) continue;
        if (!same_field(a->heights, b->heights)) fail_msg("%s: heights of %s", where, a->name);
        if (!same_or_none(a->cover, b->cover)) fail_msg("%s: coverage of %s", where, a->name);
        if (!same_or_none(a->mask, b->mask)) fail_msg("%s: mask of %s", where, a->name);
    }
}

#define VARIANTS 6

static void a_variant_has_the_bits_of_a_document_made_directly(void **state)
{
    (void)state;
    WrSession *s = with_variants(VARIANTS), *made[VARIANTS];
    TestRandom r = { 4711 };
    char line[40];
    for (int k = 0; k < VARIANTS; k++) made[k] = direct(k);
    compare(s, made[VARIANTS - 1], "just stored");
    for (int n = 0; n < 30; n++) {
        const int k = (int)(test_random_u64(&r) % VARIANTS);
        snprintf(line, sizeof line, "variant use v%d", k);
        must_run(s, line);
        compare(s, made[k], line);
        assert_string_equal(doc(s)->variant, line + 12);
        assert_false(wr_variant_differs(doc(s)));
    }
    const WrHash now = wr_session_hash(s); /* each is one step */
    must_run(s, "variant use v2");
    must_run(s, "variant use v3");
    must_run(s, "undo 2");
    assert_true(wr_hash_equal(wr_session_hash(s), now));
    must_run(s, "redo 2");
    compare(s, made[3], "redone");
    /* heights are shared by all variants */
    must_run(s, "variant use v0");
    static const char *const edits[] = { "layer use 1", "dab 0.4,0.5 radius=21 strength=-0.7" };
    for (int i = 0; i < 2; i++) {
        must_run(s, "layer set 1 visible=on");
        must_run(s, edits[i]);
        must_run(made[4], "layer set 1 visible=on");
        must_run(made[4], edits[i]);
    }
    must_run(s, "variant use v4");
    set_values(made[4], 4);
    compare(s, made[4], "after an edit");
    for (int k = 0; k < VARIANTS; k++) wr_session_free(made[k]);
    wr_session_free(s);
}

/* ---- the commands ---- */

static void variants_are_stored_renamed_and_deleted(void **state)
{
    (void)state;
    WrSession *s = document();
    must_fail(s, "variant use worn", "no variant \"worn\"");
    must_fail(s, "variant set", "no variant is in use");
    assert_false(wr_variant_differs(doc(s)));
    const WrHash before = wr_session_hash(s);
    must_run(s, "variant add worn");
    must_fail(s, "variant add worn", "already");
    must_run(s, "layer set wall opacity=0.3");
    assert_true(wr_variant_differs(doc(s)));
    must_run(s, "variant set");
    assert_false(wr_variant_differs(doc(s)));
    must_run(s, "variant add \"as new; \\\"visible=off\\\" #1\"");
    must_run(s, "layer set wall opacity=0.9");
    must_run(s, "variant set \"as new; \\\"visible=off\\\" #1\"");
    must_run(s, "variant use worn");
    assert_true(doc(s)->layers[1].opacity == 0.3f);
    must_run(s, "variant rename worn \"used hard\"");
    assert_string_equal(doc(s)->variant, "used hard");
    assert_false(wr_variant_differs(doc(s)));
    must_run(s, "variant use \"as new; \\\"visible=off\\\" #1\"");
    assert_true(doc(s)->layers[1].opacity == 0.9f && doc(s)->layers[1].visible);
    must_fail(s, "variant rename \"used hard\" \"used hard\"", "already");
    must_run(s, "variant delete \"as new; \\\"visible=off\\\" #1\"");
    assert_null(doc(s)->variant);
    assert_int_equal(wr_variant_count(doc(s)), 1);
    must_run(s, "variant delete \"used hard\"");
    must_run(s, "layer set wall opacity=1");
    assert_true(wr_hash_equal(wr_session_hash(s), before)); /* nothing is left of them */
    char line[40];
    for (int k = 0; k < WR_VARIANTS_MAX; k++) {
        snprintf(line, sizeof line, "variant add v%d", k);
        must_run(s, line);
    }
    must_fail(s, "variant add more", "up to 64 variants");
    must_run(s, "table 33x21"); /* another table has other layers */
    assert_int_equal(wr_variant_count(doc(s)), 0);
    wr_session_free(s);
}

/* Values stay with their layers. */
static void values_follow_their_layers(void **state)
{
    (void)state;
    WrSession *s = with_variants(2), *other = document();
    static const char *const changes[] = { "layer rename dirt \"dirt, wet\"",
                                           "layer move sign to=2", "layer rename wall \"the wall\"",
                                           "layer delete worn" };
    for (int i = 0; i < 4; i++) must_run(s, changes[i]);
    set_values(other, 0);
    for (int i = 0; i < 4; i++) must_run(other, changes[i]);
    must_run(s, "variant use v0");
    must_run(s, "layer use 1");
    must_run(other, "layer use 1");
    compare(s, other, "after changes of the layers");
    assert_non_null(strstr(doc(s)->layers[4].line, "link \"dirt, wet\""));
    must_run(s, "variant use v1"); /* whose mask reads the layer that was renamed */
    assert_non_null(strstr(doc(s)->layers[3].mask_line, "of=\"the wall\""));
    /* a duplicate has the values of its layer; a new layer is in no variant, and hidden in all */
    must_run(s, "layer duplicate sign");
    must_run(s, "layer add new blend=max opacity=0.25");
    assert_true(wr_variant_differs(doc(s)));
    must_run(s, "variant use v0");
    const WrLayer *layers = doc(s)->layers;
    assert_true(layers[2].opacity == layers[1].opacity && layers[2].blend == layers[1].blend);
    assert_true(layers[3].opacity == 0.25f && !layers[3].visible);
    assert_false(wr_variant_differs(doc(s)));
    must_run(s, "layer set new visible=on");
    assert_true(wr_variant_differs(doc(s)));
    must_run(s, "variant set");
    must_run(s, "variant use v1");
    assert_false(doc(s)->layers[3].visible);
    must_run(s, "variant use v0");
    assert_true(doc(s)->layers[3].visible);
    wr_session_free(s);
    wr_session_free(other);
}

/* Painted heights and masks are never lost to a line, or to terms, of a variant. */
static void plain_layers_keep_their_heights(void **state)
{
    (void)state;
    Said said;
    WrSession *s = listening(&said);
    for (size_t i = 0; i < sizeof setup / sizeof *setup; i++) must_run(s, setup[i]);
    must_run(s, "variant add worn");
    must_run(s, "layer rasterize wall");
    must_run(s, "layer mask dirt live=off");
    must_run(s, "layer use wall");
    must_run(s, "dab 0.2,0.2 radius=5");
    must_run(s, "layer set wall opacity=0.5");
    const WrHash wall = wr_field_hash(doc(s)->layers[1].heights),
                 mask = wr_field_hash(doc(s)->layers[2].mask);
    said.text[0] = '\0';
    must_run(s, "variant use worn");
    assert_non_null(strstr(said.text, "layer 2 \"wall\" no longer has a generator"));
    assert_non_null(strstr(said.text, "layer 3 \"dirt\" no longer has a live mask"));
    assert_true(doc(s)->layers[1].opacity == 1.0f);
    assert_true(wr_hash_equal(wall, wr_field_hash(doc(s)->layers[1].heights)));
    assert_true(wr_hash_equal(mask, wr_field_hash(doc(s)->layers[2].mask)));
    must_run(s, "layer merge 3");    /* a joined layer is in all variants as it is */
    must_run(s, "variant use worn"); /* the copy's source is gone, which is no error */
    assert_true(doc(s)->layers[1].visible);
    wr_session_free(s);
}

/* ---- files of each variant ---- */

static void assert_same_file(const char *a, const char *b)
{
    char *x = NULL, *y = NULL;
    size_t m = 0, n = 0;
    WrError err;
    if (!wr_file_read(a, 1 << 24, &x, &m, &err) || !wr_file_read(b, 1 << 24, &y, &n, &err))
        fail_msg("%s", err.text);
    if (m != n || memcmp(x, y, m) != 0) fail_msg("%s and %s differ", a, b);
    wr_free(x);
    wr_free(y);
}

static void write_file(WrSession *s, const char *verb, const char *file, const char *rest)
{
    WrText line = { 0 };
    wr_text_addf(&line, "%s \"%s\" %s", verb, file, rest);
    must_run(s, wr_text_get(&line));
    wr_text_fini(&line);
}

static void each_variant_is_exported_in_one_go(void **state)
{
    (void)state;
    static const struct {
        const char *verb, *ending, *rest;
    } files[] = { { "export height", "png", "depth=16" },
                  { "export normal+y", "png", "" },
                  { "render", "png", "size=40x30" },
                  { "export height", "r32", "" } };
    WrSession *s = with_variants(3);
    char one[40], all[40];
    must_run(s, "layer set wall opacity=0.123"); /* differs from the variant in use */
    const WrHash before = wr_session_hash(s);
    const uint64_t revision = wr_session_revision(s);
    const int steps = wr_session_history_count(s);
    for (int i = 0; i < 4; i++) {
        snprintf(all, sizeof all, "all%d_<VARIANT>.%s", i, files[i].ending);
        write_file(s, files[i].verb, all, files[i].rest);
    }
    assert_true(wr_hash_equal(wr_session_hash(s), before));
    assert_true(wr_session_revision(s) == revision && wr_session_history_count(s) == steps);
    for (int k = 0; k < 3; k++) {
        snprintf(one, sizeof one, "variant use v%d", k);
        must_run(s, one);
        for (int i = 0; i < 4; i++) {
            snprintf(one, sizeof one, "one%d_v%d.%s", i, k, files[i].ending);
            snprintf(all, sizeof all, "all%d_v%d.%s", i, k, files[i].ending);
            write_file(s, files[i].verb, one, files[i].rest);
            assert_same_file(one, all);
        }
    }
    must_run(s, "maps unreal . name=\"set <VARIANT>\"");
    must_run(s, "maps unreal . name=\"one\"");
    assert_same_file("T_set v2_N.png", "T_one_N.png");
    must_run(s, "variant rename v0 ../v0");
    must_run(s, "export height \"<VARIANT>.png\"");
    assert_int_equal(access("-.-v0.png", F_OK), 0);
    must_run(s, "variant rename v1 -.-v0");
    must_fail(s, "export height \"<VARIANT>.png\"", "two variants would write this file");
    WrSession *none = document();
    must_fail(none, "export height \"<VARIANT>.png\"", "the document has no variants");
    wr_session_free(none);
    wr_session_free(s);
}

static void the_pattern_goes_before_the_ending(void **state)
{
    (void)state;
    static const char *const pairs[][2] = { { "a/b.png", "a/b_<VARIANT>.png" },
                                            { "a.b/c", "a.b/c_<VARIANT>" },
                                            { "a_<VARIANT>_b.exr", "a_<VARIANT>_b.exr" } };
    for (int i = 0; i < 3; i++) {
        char *made = wr_variant_insert(pairs[i][0]), *filled = wr_variant_fill(made, NULL);
        assert_string_equal(made, pairs[i][1]);
        assert_string_equal(filled, made);
        wr_free(made);
        wr_free(filled);
    }
    char *filled = wr_variant_fill("<VARIANT>/x<VARIANT>.png", "..a/b");
    assert_string_equal(filled, "-.a-b/x-.a-b.png");
    wr_free(filled);
}

/* ---- documents ---- */

static void documents_keep_the_variants(void **state)
{
    (void)state;
    static const char *const names[] = { "kept.exr", "kept.ora", "kept.wrinkle" };
    WrSession *s = with_variants(3);
    must_run(s, "variant rename v1 \"größer <&> \\\"2\\\"\"");
    must_run(s, "variant use v0");
    for (int i = 0; i < 3; i++) {
        char line[60];
        WrSession *again = wr_session_new(NULL);
        snprintf(line, sizeof line, "%s %s", i == 2 ? "script" : "save", names[i]);
        must_run(s, line);
        WrError err;
        if (!wr_session_open(again, names[i], &err)) fail_msg("%s", err.text);
        assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
        assert_string_equal(doc(again)->variant, "v0");
        must_run(again, "variant use \"größer <&> \\\"2\\\"\"");
        must_run(s, "variant use \"größer <&> \\\"2\\\"\"");
        assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
        must_run(s, "undo");
        wr_session_free(again);
    }
    wr_session_free(s);
}

/* A file of one part has the attributes of the document and of the layer beside each other. */
static void a_document_of_one_layer_keeps_them(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(&(WrSessionOptions){ .outputs = true });
    must_run(s, "table 33x21");
    must_run(s, "noise perlin");
    must_run(s, "save before.exr");
    must_run(s, "variant add worn");
    must_run(s, "save one.exr");
    WrSession *again = session_of((const char *[]){ "open one.exr", NULL });
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    assert_false(wr_variant_differs(doc(again)));
    must_run(s, "variant delete worn"); /* without variants a file is as it was */
    must_run(s, "save after.exr");
    assert_same_file("before.exr", "after.exr");
    wr_session_free(again);
    wr_session_free(s);
}

static void strange_files_do_no_harm(void **state)
{
    (void)state;
    static const char *const names[] = { "a\n\n\tb\na\nc", "\n\n", "../../etc\n", "a" };
    static const char *const values[] = {
        "a visible=on blend=add opacity=2 radius=0\n",
        "a visible=on blend=add opacity=0.5\nc visible=perhaps blend=add opacity=1 radius=0\n",
        "a visible=on blend=add opacity=0.5 radius=0 line=\"undo\" mask=\"; ;\" filter=\"x\"\n",
        "a visible=on blend=add opacity=0.5 radius=0 line=\"pattern bricks file=/etc/passwd\"",
        "a visible=off blend=replace opacity=1e-300 radius=1e38 mask=\"mask of=wall\"\na\na ",
        "\"a\" \"\n\"",
    };
    for (int n = 0; n < 4; n++)
        for (int v = 0; v < 6; v++) {
            if ((n + v) % test_amount(1, 3) != 0) continue;
            WrSession *s = document();
            WrDocument *document = wr_document_share(doc(s));
            document->variants = wr_strdup(names[n]);
            document->variant = wr_strdup(v % 2 ? "a" : "nothing");
            for (int i = 0; i < document->layer_count; i++)
                document->layers[i].values = wr_strdup(values[(v + i) % 6]);
            WrError err;
            if (!wr_document_save(document, "", "odd.exr", NULL, &err)) fail_msg("%s", err.text);
            wr_document_free(document);
            WrSession *other = wr_session_new(&(WrSessionOptions){ .outputs = true });
            must_run(other, "open odd.exr");
            char name[WR_VARIANT_NAME_MAX + 1];
            for (int k = 0; k < wr_variant_count(doc(other)); k++) {
                WrText line = { 0 };
                wr_variant_name(doc(other), k, name);
                assert_true(name[0] && !strchr(name, '\t'));
                wr_text_addf(&line, "variant use \"%s\"", name);
                must_run(other, wr_text_get(&line));
                wr_text_fini(&line);
            }
            wr_variant_differs(doc(other));
            must_run(other, "layer rename wall other");
            must_run(other, "save odd.ora");
            WrSession *again = session_of((const char *[]){ "open odd.ora", NULL });
            assert_true(wr_hash_equal(wr_session_hash(other), wr_session_hash(again)));
            wr_session_free(again);
            wr_session_free(other);
            wr_session_free(s);
        }
}

static void a_journal_brings_them_back(void **state)
{
    (void)state;
    WrSession *s = wr_session_new(&(WrSessionOptions){ .journal = true });
    for (size_t i = 0; i < sizeof setup / sizeof *setup; i++) must_run(s, setup[i]);
    must_run(s, "variant add a");
    set_values(s, 3);
    must_run(s, "variant add b");
    must_run(s, "layer duplicate wall linked=on");
    must_run(s, "variant use a");
    const WrHash hash = wr_session_hash(s);
    wr_session_journal_leave(s);
    wr_session_free(s);
    char *journal = only_journal();
    WrError err;
    WrRecovered how;
    WrSession *back = wr_session_new(NULL);
    if (!wr_session_recover(back, journal, true, &how, &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(back), hash));
    wr_recovered_fini(&how);
    wr_session_free(back);
    wr_free(journal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_variant_has_the_bits_of_a_document_made_directly),
        cmocka_unit_test(variants_are_stored_renamed_and_deleted),
        cmocka_unit_test(values_follow_their_layers),
        cmocka_unit_test(plain_layers_keep_their_heights),
        cmocka_unit_test(each_variant_is_exported_in_one_go),
        cmocka_unit_test(the_pattern_goes_before_the_ending),
        cmocka_unit_test(documents_keep_the_variants),
        cmocka_unit_test(a_document_of_one_layer_keeps_them),
        cmocka_unit_test(strange_files_do_no_harm),
        cmocka_unit_test(a_journal_brings_them_back),
    };
    return cmocka_run_group_tests(tests, enter_state_folder, remove_folder);
}

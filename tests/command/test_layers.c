/* Layers as commands: their composite, order, and merging. */
#include "test.h"
#include "session_help.h"

#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"

/* ---- the composite ---- */

static double value(const WrField *field, int i, int j)
{
    return field ? wr_field_get(field, i, j) : 1.0;
}

/* One layer onto b, as in blend.h, in double precision. */
static double blend(const WrLayer *layer, double b, int i, int j)
{
    double h = wr_field_get(layer->heights, i, j), k = layer->radius;
    double om = layer->opacity * value(layer->mask, i, j), w = om * value(layer->cover, i, j);
    double near = fmax(k - fabs(b - h), 0), lift = k > 0 ? near * near / k / 4 : 0;
    switch (layer->blend) {
    case WR_BLEND_ADD: return b + om * h;
    case WR_BLEND_SUBTRACT: return b - om * h;
    case WR_BLEND_MAX: return b + w * (fmax(b, h) - b);
    case WR_BLEND_MIN: return b + w * (fmin(b, h) - b);
    case WR_BLEND_SMOOTH_MAX: return b + w * (fmax(b, h) + lift - b);
    case WR_BLEND_SMOOTH_MIN: return b + w * (fmin(b, h) - lift - b);
    case WR_BLEND_REPLACE: return b + w * (h - b);
    case WR_BLEND_MIX: return b + om * (h - b);
    default: return b + w * (b * h - b);
    }
}

static double composite(const WrDocument *document, int i, int j)
{
    double b = 0;
    for (int k = 0; k < document->layer_count; k++) {
        bool shown = document->solo < 0 ? document->layers[k].visible : document->solo == k;
        if (shown) b = blend(&document->layers[k], b, i, j);
    }
    return b;
}

/* 20 layers with a few float roundings each, of heights up to about 10. */
static void check_composite(const WrSession *session)
{
    const WrField *f = wr_document_field(doc(session));
    for (int j = 0; j < wr_field_height(f); j++)
        for (int i = 0; i < wr_field_width(f); i++)
            assert_near(wr_field_get(f, i, j), composite(doc(session), i, j), 2e-5);
}

static void the_composite_is_what_the_formulas_give_for_all_blends_and_edits(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 130x70", "grid cells=5x3 width=7 low=0.25",
                                                "select ellipse centre=0.5,0.5 radii=0.4,0.3",
                                                "select feather by=3", NULL });
    for (int blend_mode = 0; blend_mode < WR_BLEND_COUNT; blend_mode++) {
        char line[128];
        snprintf(line, sizeof line, "layer add blend=%s opacity=%g radius=0.5",
                 wr_blends[blend_mode].name, blend_mode % 2 ? 1.0 : 0.7);
        must_run(s, line);
        must_run(s, "dab 0.9,0.1 radius=30 strength=0.8");
        check_composite(s);
        must_run(s, "layer mask 2 from=selection");
        snprintf(line, sizeof line, "stroke points=0,0;%g,1,0.5 radius=9 strength=1.5",
                 0.1 * blend_mode);
        must_run(s, line);
        check_composite(s);
        must_run(s, "select invert");
    }
    const char *const changes[] = { "layer move 3 to=7",
                                    "layer set 5 visible=off",
                                    "layer solo 4",
                                    "layer set 4 opacity=0.3",
                                    "layer solo off",
                                    "layer delete 2",
                                    "layer duplicate 6",
                                    "layer mask 3 from=black",
                                    "layer mask 3 from=white",
                                    "layer mask 3 from=none",
                                    "layer set 5 blend=subtract visible=on",
                                    "undo 4",
                                    "redo 2",
                                    "layer use 1",
                                    "fill -1",
                                    "layer clear" };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        must_run(s, changes[i]);
        check_composite(s);
    }
    wr_session_free(s);
}

static void a_max_layer_touches_only_what_was_painted_on_it(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 64x64", "fill -5", "layer add blend=max",
                                                "dab 0.5,0.5 radius=8 strength=1", NULL });
    assert_true(f_at(s, 0, 0) == -5);  /* though the layer's 0 is higher */
    assert_true(f_at(s, 32, 32) == 1); /* fully covered */
    must_run(s, "fill 2");             /* now it covers everything */
    assert_true(f_at(s, 0, 0) == 2);
    must_run(s, "layer clear");
    assert_true(f_at(s, 0, 0) == -5 && f_at(s, 32, 32) == -5);
    wr_session_free(s);
}

static void a_document_of_one_plain_layer_is_that_layer(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 64x64", "dab 0.5,0.5", NULL });
    assert_ptr_equal(wr_document_field(doc(s)), doc(s)->layers[0].heights);
    must_run(s, "layer set 1 opacity=0.5");
    assert_true(f_at(s, 32, 32) == 0.05f);
    must_run(s, "layer set 1 opacity=1 visible=off");
    assert_true(f_at(s, 32, 32) == 0);
    wr_session_free(s);
}

/* ---- the stack ---- */

static void check_stack(const WrSession *session, const char *names, int active, int solo)
{
    WrText text = { 0 };
    for (int i = 0; i < doc(session)->layer_count; i++)
        wr_text_addf(&text, "%s ", doc(session)->layers[i].name);
    assert_string_equal(wr_text_get(&text), names);
    assert_int_equal(doc(session)->active + 1, active);
    assert_int_equal(doc(session)->solo + 1, solo);
    wr_text_fini(&text);
}

static void active_and_solo_stay_at_their_layers(void **state)
{
    (void)state;
    WrSession *s = session_of(
        (const char *[]){ "table 8x8", "layer add a", "layer add b", "layer add c", NULL });
    check_stack(s, "base a b c ", 4, 0);
    must_run(s, "layer solo b");
    must_run(s, "layer use a");
    must_run(s, "layer move b to=1");
    check_stack(s, "b base a c ", 3, 1);
    must_run(s, "layer move 1 to=4");
    check_stack(s, "base a c b ", 2, 4);
    must_run(s, "layer add d above=1");
    check_stack(s, "base d a c b ", 2, 5);
    must_run(s, "layer delete base");
    check_stack(s, "d a c b ", 1, 4);
    must_run(s, "layer delete b");
    check_stack(s, "d a c ", 1, 0);
    must_run(s, "layer use c");
    must_run(s, "layer delete c");
    check_stack(s, "d a ", 2, 0);
    must_run(s, "layer duplicate 1");
    must_run(s, "layer add");
    must_run(s, "layer rename 4 \"x y\"");
    check_stack(s, "d d copy layer 4 x y ", 3, 0);
    wr_session_free(s);
}

static void layers_that_do_not_exist_are_named_in_the_message(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 8x8", "layer add a", "layer add a", NULL });
    must_fail(s, "layer use 4", "layer 4: must be 1..3");
    must_fail(s, "layer use 0", "layer 0: must be 1..3");
    must_fail(s, "layer use 99999999999999999999", "must be 1..3");
    must_fail(s, "layer use b", "no layer is called \"b\"");
    must_fail(s, "layer use a", "2 layers are called \"a\": give its number");
    must_fail(s, "layer move 1 to=4", "to=4: must be 1..3");
    must_fail(s, "layer set 1", "nothing to set");
    must_fail(s, "layer set 1..2 name=a", "name= is for one layer: N names 2");
    must_fail(s, "layer merge 1", "no layer below");
    must_fail(s, "layer mask 1 from=selection", "nothing is selected");
    must_run(s, "layer delete 1");
    must_run(s, "layer delete 1");
    must_fail(s, "layer delete 1", "the last layer stays");
    for (int i = 1; i < WR_LAYERS_MAX; i++) must_run(s, "layer add");
    must_fail(s, "layer add", "up to 256 layers");
    must_fail(s, "layer duplicate 1", "up to 256 layers");
    wr_session_free(s);
}

/* ---- several layers in one line ---- */

static WrSession *letters(void)
{
    return session_of((const char *[]){ "table 13x9", "layer add a", "layer add b", "layer add c",
                                        "layer add d", "layer add e", "layer use c", NULL });
}

/* One line is one step: undo restores the whole stack. */
static void check_step(const char *line, const char *names, int active, int solo)
{
    WrSession *s = letters();
    must_run(s, "layer solo d");
    const int before = wr_session_history_position(s);
    const WrHash hash = wr_session_hash(s);
    must_run(s, line);
    check_stack(s, names, active, solo);
    assert_string_equal(wr_session_last_command(s), line);
    assert_int_equal(wr_session_history_position(s), before + 1);
    must_run(s, "undo");
    check_stack(s, "base a b c d e ", 4, 5);
    assert_true(wr_hash_equal(wr_session_hash(s), hash));
    wr_session_free(s);
}

static void several_layers_change_in_one_step(void **state)
{
    (void)state;
    check_step("layer delete 2,6", "base b c d ", 3, 4);
    check_step("layer delete 6,b,2", "base c d ", 2, 3);
    check_step("layer delete c,d", "base a b e ", 3, 0); /* active: the layer below */
    check_step("layer delete 1,2,3,4", "d e ", 1, 1);
    check_step("layer move 2,4,5 to=1", "a c d base b e ", 2, 3);
    check_step("layer move 5,2,4,4 to=4", "base b e a c d ", 5, 6);
    check_step("layer move 1,6 to=2", "a base e b c d ", 5, 6);
    check_step("layer move 4 to=4", "base a b c d e ", 4, 5);
    check_step("layer duplicate 2,4", "base a b c a copy c copy d e ", 6, 7);
    check_step("layer duplicate 6,2", "base a b c d e a copy e copy ", 8, 5);
    check_step("layer merge 3,2,4", "base a d e ", 2, 3);
}

static void several_layers_take_the_same_settings(void **state)
{
    (void)state;
    WrSession *s = letters();
    must_run(s, "layer set 2,a,5 opacity=0.25 blend=max visible=off lock=on");
    for (int i = 0; i < 6; i++) {
        const WrLayer *layer = &doc(s)->layers[i];
        const bool set = i == 1 || i == 4;
        assert_true(layer->opacity == (set ? 0.25f : 1.0f));
        assert_int_equal(layer->blend, set ? WR_BLEND_MAX : WR_BLEND_ADD);
        assert_int_equal(layer->visible, !set);
        assert_int_equal(layer->locked, set);
    }
    must_fail(s, "layer delete 3,5", "layer 5 \"d\" is locked");
    must_fail(s, "layer merge 5,4", "layer 5 \"d\" is locked");
    must_fail(s, "layer set 3,9 opacity=0.5", "layer 9: must be 1..6");
    must_fail(s, "layer set 3, opacity=0.5", "\"3,\": a layer is missing before or after a comma");
    must_fail(s, "layer move 1,2,3 to=5", "to=5: must be 1..4");
    must_fail(s, "layer merge 1,3", "layers 1 and 3 are not neighbours");
    wr_session_free(s);
}

static void a_name_may_contain_commas(void **state)
{
    (void)state;
    WrSession *s = session_of(
        (const char *[]){ "table 5x4", "layer add a", "layer add b", "layer add \"a,b\"", NULL });
    must_run(s, "layer delete a,b");
    check_stack(s, "base a b ", 3, 0);
    must_run(s, "layer delete a,b");
    check_stack(s, "base ", 1, 0);
    must_fail(s, "layer delete 1", "the last layer stays");
    wr_session_free(s);
}

static void several_generator_layers_become_plain(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){
        "table 24x17", "layer add p from=\"pattern bricks\"", "layer add q", "dab 0.3,0.6",
        "layer add r from=\"noise perlin\"", "layer add t from=\"pattern dots\"", NULL });
    must_fail(s, "layer rasterize 2,3", "layer 3 is already a plain layer");
    assert_non_null(doc(s)->layers[1].line);
    must_run(s, "layer rasterize 5,2");
    assert_null(doc(s)->layers[1].line);
    assert_non_null(doc(s)->layers[3].line);
    assert_null(doc(s)->layers[4].line);
    must_run(s, "layer clear 3,5");
    for (int j = 0; j < 17; j++)
        for (int i = 0; i < 24; i++) {
            assert_true(wr_field_get(doc(s)->layers[2].heights, i, j) == 0);
            assert_true(wr_field_get(doc(s)->layers[4].heights, i, j) == 0);
        }
    wr_session_free(s);
}

/* ---- several layers and groups ---- */

/* Rows from the top, members of a group in parentheses behind it: "e G(c b) a". */
static void print_tree(const WrDocument *document, WrText *text)
{
    int depth = 0;
    for (int i = document->layer_count - 1; i >= 0; i--) {
        const WrLayer *layer = &document->layers[i];
        for (; depth > layer->depth; depth--) wr_text_add(text, ")");
        const bool first = i == document->layer_count - 1 || layer->depth > depth;
        wr_text_add(text, first ? layer->depth > depth ? "(" : "" : " ");
        depth = layer->depth;
        wr_text_add(text, layer->name);
    }
    for (; depth > 0; depth--) wr_text_add(text, ")");
}

static void check_tree(const WrSession *session, const char *tree)
{
    WrText text = { 0 };
    WrError err;
    print_tree(doc(session), &text);
    assert_string_equal(wr_text_get(&text), tree);
    if (!wr_document_check_groups(doc(session), &err)) fail_msg("%s", err.text);
    wr_text_fini(&text);
}

/* Numbers: 8 h, 7 G, 6 e, 5 H, 4 d, 3 c, 2 b, 1 base. */
static WrSession *tree(void)
{
    WrSession *s = session_of((const char *[]){
        "table 21x16", "layer add b", "layer add c", "dab 0.3,0.4 radius=5 strength=0.7",
        "layer add d", "dab 0.6,0.6 radius=4 strength=-0.3", "layer group H of=c,d", "layer add e",
        "dab 0.8,0.3 radius=6", "layer group G of=H,e", "layer add h above=G", "layer use b",
        NULL });
    check_tree(s, "h G(e H(d c)) b base");
    return s;
}

static void check_tree_step(const char *line, const char *right)
{
    WrSession *s = tree();
    const WrHash hash = wr_session_hash(s);
    must_run(s, line);
    check_tree(s, right);
    must_run(s, "undo");
    check_tree(s, "h G(e H(d c)) b base");
    assert_true(wr_hash_equal(wr_session_hash(s), hash));
    wr_session_free(s);
}

static void groups_change_with_their_layers(void **state)
{
    (void)state;
    check_tree_step("layer delete c,H", "h G(e) b base"); /* c is in H */
    check_tree_step("layer delete e,c,b", "h G(H(d)) base");
    check_tree_step("layer delete 2..7", "h base");
    check_tree_step("layer duplicate b,H", "h G(e H copy(d c) b copy H(d c)) b base");
    check_tree_step("layer duplicate h,c", "h copy c copy h G(e H(d c)) b base");
    check_tree_step("layer move b,e to=2", "h G(H(d c) e) b base"); /* e stays in G */
}

static void several_layers_move_into_groups(void **state)
{
    (void)state;
    check_tree_step("layer move b,h in=G", "G(h b e H(d c)) base");
    check_tree_step("layer move base,b in=H", "h G(e H(b base d c))");
    check_tree_step("layer move b,h in=H to=3", "G(e H(d h b c)) base");
    check_tree_step("layer move H,h in=none", "h H(d c) G(e) b base");
    check_tree_step("layer move c,e in=none to=1", "h G(H(d)) b base e c");
    check_tree_step("layer move H,b to=2 in=none", "h G(e) H(d c) b base");
    WrSession *s = tree();
    must_fail(s, "layer move b,G in=H", "cannot be moved into itself");
    must_fail(s, "layer move b,h in=e", "is not a group");
    must_fail(s, "layer move b,h in=G to=1", "is not in that group");
    must_fail(s, "layer move G,h to=4", "to=4: must be 5..7");
    wr_session_free(s);
}

static void several_groups_are_joined_and_removed(void **state)
{
    (void)state;
    check_tree_step("layer ungroup G,H", "h e d c b base");
    check_tree_step("layer rasterize G,H", "h G b base");
    check_tree_step("layer merge b,G", "h b base");
    check_tree_step("layer merge c..e", "h G(H) b base"); /* with H between them */
    check_tree_step("layer group all of=base,h,c", "all(h c base) G(e H(d)) b");
    WrSession *s = tree();
    WrField *before = wr_field_share(wr_document_field(doc(s)));
    must_fail(s, "layer merge c,e", "layers 3 and 6 are not neighbours");
    must_fail(s, "layer merge b,c", "layers 2 and 3 are not neighbours");
    must_run(s, "layer set c lock=on");
    must_fail(s, "layer merge b,G", "layer 3 \"c\" is locked");
    must_fail(s, "layer delete h,H", "layer 3 \"c\" is locked");
    must_fail(s, "layer set b,h collapsed=on", "layer 2 is not a group");
    must_run(s, "layer set G,H collapsed=on");
    assert_true(doc(s)->layers[4].collapsed && doc(s)->layers[6].collapsed);
    must_run(s, "layer set c lock=off");
    must_run(s, "layer merge 1,2,7");
    check_tree(s, "h base");
    for (int j = 0; j < 16; j++)
        for (int i = 0; i < 21; i++)
            assert_near(f_at(s, i, j), wr_field_get(before, i, j), 0x1p-20);
    wr_field_free(before);
    wr_session_free(s);
}

/* ---- joining ---- */

static WrSession *stack(const char *lower, const char *upper, bool floor)
{
    WrSession *s =
        session_of((const char *[]){ "table 100x80", "grid cells=4x3 width=9 low=-0.7 high=1.1",
                                     "dab 0.3,0.3 radius=60 strength=3", NULL });
    const char *blends[2] = { lower, upper };
    for (int k = floor ? 0 : 1; k < 2; k++) {
        char line[96];
        snprintf(line, sizeof line, "layer add blend=%s opacity=0.8 radius=0.4", blends[k]);
        must_run(s, line);
        must_run(s, "dab 0.6,0.5 radius=50 strength=1.7");
        must_run(s, k ? "dab 0.4,0.4 radius=30 strength=-0.4" : "dab 0.1,0.9 radius=20");
    }
    return s;
}

static void merging_any_two_layers_keeps_the_composite(void **state)
{
    (void)state;
    for (int a = 0; a < WR_BLEND_COUNT; a++)
        for (int b = 0; b < WR_BLEND_COUNT; b++) {
            WrSession *s = stack(wr_blends[a].name, wr_blends[b].name, true);
            WrField *before = wr_field_share(wr_document_field(doc(s)));
            must_run(s, "layer merge 3");
            assert_int_equal(doc(s)->layer_count, 2);
            assert_int_equal(doc(s)->active, 1);
            for (int j = 0; j < 80; j++)
                for (int i = 0; i < 100; i++) /* the largest height that meets here is under 8 */
                    assert_near(f_at(s, i, j), wr_field_get(before, i, j), 8 * 0x1p-21);
            wr_field_free(before);
            wr_session_free(s);
        }
}

/* Several neighbours: as one after the other, from the bottom. */
static void merging_several_keeps_the_composite(void **state)
{
    (void)state;
    for (int b = 0; b < WR_BLEND_COUNT; b++) {
        WrSession *s = stack("max", wr_blends[b].name, true);
        must_run(s, "layer duplicate 2,3");
        WrField *before = wr_field_share(wr_document_field(doc(s)));
        must_run(s, "layer merge 3,4,2");
        assert_int_equal(doc(s)->layer_count, 3);
        for (int j = 0; j < 80; j++)
            for (int i = 0; i < 100; i++)
                assert_near(f_at(s, i, j), wr_field_get(before, i, j), 2 * 8 * 0x1p-21);
        must_run(s, "undo");
        must_run(s, "layer merge 1,2,3,4");
        assert_int_equal(doc(s)->layer_count, 2);
        WrField *joined = wr_document_below(doc(s), 1, NULL);
        must_run(s, "undo");
        WrField *apart = wr_document_below(doc(s), 4, NULL);
        assert_true(same_field(joined, apart)); /* onto layer 1 every bit stays */
        wr_field_free(joined);
        wr_field_free(apart);
        wr_field_free(before);
        wr_session_free(s);
    }
}

static void merging_onto_the_bottom_and_flattening_keep_every_bit(void **state)
{
    (void)state;
    for (int b = 0; b < WR_BLEND_COUNT; b++) {
        WrSession *s = stack("", wr_blends[b].name, false);
        WrField *before = wr_field_share(wr_document_field(doc(s)));
        must_run(s, "layer merge 2");
        assert_true(same_field(before, wr_document_field(doc(s))));
        assert_int_equal(doc(s)->layer_count, 1);
        wr_field_free(before);
        wr_session_free(s);
        s = stack("max", wr_blends[b].name, true);
        must_run(s, "layer set 1 opacity=0.3");
        must_run(s, "layer add hidden");
        must_run(s, "layer set hidden visible=off");
        before = wr_field_share(wr_document_field(doc(s)));
        must_run(s, "layer solo 1");
        must_run(s, "layer flatten");
        assert_true(same_field(before, wr_document_field(doc(s))));
        check_stack(s, "base ", 1, 0);
        wr_field_free(before);
        wr_session_free(s);
    }
}

static void merging_sums_of_layers_goes_with_later_edits_below(void **state)
{
    (void)state;
    WrSession *s = stack("add", "subtract", true);
    must_run(s, "layer merge 3");
    must_run(s, "layer use 1");
    must_run(s, "fill 4");
    WrSession *t = stack("add", "subtract", true);
    must_run(t, "layer use 1");
    must_run(t, "fill 4");
    for (int j = 0; j < 80; j++)
        for (int i = 0; i < 100; i++) assert_near(f_at(s, i, j), f_at(t, i, j), 8 * 0x1p-21);
    wr_session_free(s);
    wr_session_free(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_composite_is_what_the_formulas_give_for_all_blends_and_edits),
        cmocka_unit_test(a_max_layer_touches_only_what_was_painted_on_it),
        cmocka_unit_test(a_document_of_one_plain_layer_is_that_layer),
        cmocka_unit_test(active_and_solo_stay_at_their_layers),
        cmocka_unit_test(layers_that_do_not_exist_are_named_in_the_message),
        cmocka_unit_test(several_layers_change_in_one_step),
        cmocka_unit_test(several_layers_take_the_same_settings),
        cmocka_unit_test(a_name_may_contain_commas),
        cmocka_unit_test(several_generator_layers_become_plain),
        cmocka_unit_test(groups_change_with_their_layers),
        cmocka_unit_test(several_layers_move_into_groups),
        cmocka_unit_test(several_groups_are_joined_and_removed),
        cmocka_unit_test(merging_several_keeps_the_composite),
        cmocka_unit_test(merging_any_two_layers_keeps_the_composite),
        cmocka_unit_test(merging_onto_the_bottom_and_flattening_keep_every_bit),
        cmocka_unit_test(merging_sums_of_layers_goes_with_later_edits_below),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Linked copies: the bits of copies made by hand, chains, cycles, names, lost sources, files. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document_file.h"

#include <math.h>
#include <stdio.h>

#define GROUND "table 97x61", "noise gradient cells=3 amplitude=0.731 level=0.113 seed=29"

static WrSession *ground(void)
{
    return session_of((const char *[]){ GROUND, "layer add a", NULL });
}

static const WrLayer *layer(const WrSession *s, const char *name)
{
    for (int i = 0; i < doc(s)->layer_count; i++)
        if (strcmp(doc(s)->layers[i].name, name) == 0) return &doc(s)->layers[i];
    fail_msg("no layer %s", name);
    return NULL;
}

static bool shares(const WrSession *s, const char *a, const char *b)
{
    return wr_field_key(layer(s, a)->heights) == wr_field_key(layer(s, b)->heights) &&
           wr_field_key(layer(s, a)->cover) == wr_field_key(layer(s, b)->cover);
}

static bool same_cover(const WrField *a, const WrField *b)
{
    return a && b ? same_field(a, b) : a == b;
}

/* ---- random edits ---- */

static void random_edit(TestRandom *r, char line[160])
{
    const double u = test_random(r), v = test_random(r), x = test_random(r);
    switch (test_random_u64(r) % 7) {
    case 0:
    case 1:
        snprintf(line, 160, "dab %.4f,%.4f radius=%.3f strength=%.4f", u, v, 2 + 11 * x, x - 0.4);
        break;
    case 2: snprintf(line, 160, "stroke points=%.4f,%.4f;%.4f,%.4f radius=4.7", u, v, v, x); break;
    case 3: snprintf(line, 160, "adjust blur sigma=%.3f", 0.3 + x); break;
    case 4: snprintf(line, 160, "text Wri size=%.2f at=%.3f,%.3f", 9 + 20 * x, u, v); break;
    case 5: snprintf(line, 160, "layer clear a"); break;
    default: snprintf(line, 160, "shape ellipse middle=%.3f,%.3f radii=0.17,0.11 paint=fill", u, v);
    }
}

static void a_copy_has_the_bits_of_one_made_by_hand(void **state)
{
    (void)state;
    enum { EDITS = 24 };
    char edits[EDITS][160];
    TestRandom r = { 20260711 };
    WrSession *s = ground();
    must_run(s, "layer duplicate a linked=on");
    must_run(s, "layer add moved from=\"link a shift=-0.216494845360824748,0.114754098360655737 "
                "scale=-1,1\"");
    must_run(s,
             "layer add b from=\"link a shift=0.113,-0.27 turn=33 scale=0.7,-1.2 factor=-0.37\"");
    for (int k = 0; k < EDITS; k++) {
        random_edit(&r, edits[k]);
        must_run(s, "layer use a");
        must_run(s, edits[k]);
        WrSession *hand = ground();
        for (int i = 0; i <= k; i++) must_run(hand, edits[i]);
        assert_true(shares(s, "a", "a copy"));
        must_run(hand, "layer duplicate a");
        must_run(hand, "transform move=-21,7 scale=-1,1");
        assert_true(same_field(layer(s, "moved")->heights, layer(hand, "a copy")->heights));
        assert_true(same_cover(layer(s, "moved")->cover, layer(hand, "a copy")->cover));
        must_run(hand, "layer duplicate a");
        must_run(hand, "transform move=10.961,-16.47 turn=33 scale=0.7,-1.2");
        const WrLayer *made = &doc(hand)->layers[doc(hand)->active];
        assert_true(same_cover(layer(s, "b")->cover, made->cover));
        must_run(hand, "adjust multiply factor=-0.37");
        made = &doc(hand)->layers[doc(hand)->active];
        if (!same_field(layer(s, "b")->heights, made->heights))
            fail_msg("after %s: the copy differs from the one made by hand", edits[k]);
        wr_session_free(hand);
    }
    const WrHash after = wr_session_hash(s);
    must_run(s, "undo 9");
    must_run(s, "redo 9");
    assert_true(wr_hash_equal(wr_session_hash(s), after));
    assert_true(shares(s, "a", "a copy"));
    wr_session_free(s);
}

/* ---- order ---- */

/* A copy below its source, copies of copies in the wrong order, and lines and masks that read them. */
static void everything_follows_in_one_command(void **state)
{
    (void)state;
    static const char *const setup[] = {
        "table 97x61",
        "noise gradient cells=3 amplitude=0.731 level=0.113 seed=29",
        "layer add low",
        "layer add c",
        "layer add worn from=\"terrain terraces steps=5\"",
        "layer add masked",
        "fill 0.21",
        "layer mask masked live=\"height low=0.1 high=0.4 soft=0.1 of=worn\"",
        "layer add b",
        "layer add a",
        "dab 0.3,0.4 radius=11.3 strength=0.613",
    };
    static const char *const links[] = { "layer set low from=\"link c factor=0.5\"",
                                         "layer set c from=\"link b shift=0.13,0\"",
                                         "layer set b from=\"link a turn=90\"" };
    static const char edit[] = "dab 0.61,0.27 radius=7.1 strength=-0.417";
    WrSession *s = wr_session_new(NULL), *other = wr_session_new(NULL);
    for (int i = 0; i < 11; i++) must_run(s, setup[i]);
    for (int i = 0; i < 11; i++) must_run(other, setup[i]);
    static const char *const names[] = { "low", "c", "b" };
    for (int i = 0; i < 3; i++) { /* generator layers first, then links in either order */
        char line[80];
        snprintf(line, sizeof line, "layer delete %s", names[i]);
        must_run(s, line);
        must_run(other, line);
    }
    must_run(s, "layer add low blend=add from=\"pattern dots\" above=1");
    must_run(s, "layer add c blend=add from=\"pattern dots\" above=2");
    must_run(s, "layer add b blend=add from=\"pattern dots\" above=masked");
    for (int i = 0; i < 3; i++) must_run(s, links[i]);
    must_run(s, "layer use a");
    must_run(s, edit);
    /* the other one is edited first: each copy is made once, in a right order */
    must_run(other, "layer use a");
    must_run(other, edit);
    must_run(other, "layer add b from=\"link a turn=90\" above=masked");
    must_run(other, "layer add c from=\"link b shift=0.13,0\" above=1");
    must_run(other, "layer add low from=\"link c factor=0.5\" above=1");
    static const char *const all[] = { "low", "c", "b", "worn" };
    for (int i = 0; i < 4; i++)
        if (!same_field(layer(s, all[i])->heights, layer(other, all[i])->heights))
            fail_msg("%s has not followed", all[i]);
    assert_true(same_field(layer(s, "masked")->mask, layer(other, "masked")->mask));
    assert_true(same_field(wr_document_field(doc(s)), wr_document_field(doc(other))));
    wr_session_free(s);
    wr_session_free(other);
}

static void a_copy_is_made_only_if_its_source_changes(void **state)
{
    (void)state;
    WrSession *s = ground();
    must_run(s, "dab 0.3,0.4 radius=11.3");
    must_run(s, "layer add b from=\"link a turn=33\"");
    const uint64_t key = wr_field_key(layer(s, "b")->heights);
    must_run(s, "layer use 1");
    must_run(s, "dab 0.3,0.4 radius=9");
    must_run(s, "layer set a opacity=0.3 blend=max");
    must_run(s, "layer mask a from=white");
    must_run(s, "layer rename a other");
    assert_int_equal(wr_field_key(layer(s, "b")->heights), key);
    assert_string_equal(layer(s, "b")->line, "link other turn=33");
    must_run(s, "layer set b visible=off"); /* a hidden one waits, unless a copy of it is shown */
    must_run(s, "layer use other");
    must_run(s, "dab 0.5,0.5 radius=9");
    assert_int_equal(wr_field_key(layer(s, "b")->heights), key);
    must_run(s, "layer add c from=\"link b\"");
    assert_int_not_equal(wr_field_key(layer(s, "b")->heights), key);
    assert_true(shares(s, "b", "c"));
    wr_session_free(s);
}

/* ---- refusals ---- */

static void cycles_are_refused(void **state)
{
    (void)state;
    WrSession *s = ground();
    must_run(s, "layer add b from=\"link a\"");
    must_run(s, "layer add c from=\"link b\"");
    must_run(s, "layer delete a");
    must_run(s, "layer add a from=\"pattern dots\" above=1");
    must_fail(s, "layer set a from=\"link c\"",
              "a cycle of links: layer 2 \"a\" > layer 4 \"c\" > layer 3 \"b\" > layer 2 \"a\"");
    must_fail(s, "layer set a from=\"link a\"", "cannot copy itself");
    must_fail(s, "layer set b change=c", "a cycle of links: layer 3 \"b\" > layer 4 \"c\"");
    must_fail(s, "layer add d from=\"link nothing\"", "no layer is called");
    must_run(s, "layer set b change=a");
    /* a line that reads the composite below reads the copies there too */
    must_run(s, "layer add worn from=\"terrain terraces\"");
    must_fail(s, "layer set a from=\"link worn\"",
              "a cycle of links: layer 2 \"a\" > layer 3 \"worn\"");
    must_run(s, "filter blur");
    must_fail(s, "layer add d from=\"link 4\"", "is a filter");
    must_fail(s, "layer duplicate 4 linked=on", "is a filter");
    must_run(s, "layer use c");
    must_fail(s, "dab 0.5,0.5 radius=3", "layer rasterize 6");
    must_run(s, "layer rasterize c");
    must_run(s, "dab 0.5,0.5 radius=3");
    wr_session_free(s);
}

/* A move can close a cycle: the copy in it keeps its heights, and everything else works. */
static void a_cycle_closed_by_a_move_keeps_the_heights(void **state)
{
    (void)state;
    Said said;
    WrSession *s = listening(&said);
    must_run(s, "table 97x61");
    must_run(s, "noise gradient cells=3 amplitude=0.731 seed=29");
    must_run(s, "layer add worn from=\"terrain terraces steps=4\"");
    must_run(s, "layer add b from=\"link worn factor=2\"");
    const WrHash heights = wr_field_hash(layer(s, "b")->heights);
    said.text[0] = '\0';
    must_run(s, "layer move b to=1");
    assert_non_null(strstr(said.text,
                           "keeps its heights (a cycle of links: layer 1 \"b\" > layer 3 "
                           "\"worn\" > layer 1 \"b\")"));
    assert_true(wr_hash_equal(heights, wr_field_hash(layer(s, "b")->heights)));
    said.text[0] = '\0';
    must_run(s, "layer use 2");
    must_run(s, "dab 0.5,0.5 radius=9");
    assert_string_equal(said.text, ""); /* one warning */
    assert_true(wr_hash_equal(heights, wr_field_hash(layer(s, "b")->heights)));
    must_run(s, "layer move b to=3");
    assert_false(wr_hash_equal(heights, wr_field_hash(layer(s, "b")->heights)));
    wr_session_free(s);
}

static void a_lost_source_leaves_the_heights(void **state)
{
    (void)state;
    Said said;
    WrSession *s = listening(&said);
    must_run(s, "table 97x61");
    must_run(s, "layer add a");
    must_run(s, "dab 0.3,0.4 radius=11.3");
    must_run(s, "layer add b from=\"link a turn=33\"");
    const WrHash heights = wr_field_hash(layer(s, "b")->heights);
    said.text[0] = '\0';
    must_run(s, "layer delete a");
    assert_string_equal(said.text,
                        "layer 2 \"b\": a linked copy, which keeps its heights (no layer "
                        "\"a\" has heights to be copied)\n");
    said.text[0] = '\0';
    must_run(s, "layer use 1");
    must_run(s, "dab 0.5,0.5 radius=9");
    assert_string_equal(said.text, "");
    must_run(s, "save lost.ora");
    assert_null(strstr(said.text, "heights ("));
    assert_true(wr_hash_equal(heights, wr_field_hash(layer(s, "b")->heights)));
    must_run(s, "open lost.ora");
    assert_non_null(strstr(said.text, "keeps its heights"));
    must_run(s, "layer use 1");
    must_run(s, "layer add a");
    must_run(s, "fill 0.3");
    assert_true(f_at(s, 3, 3) != 0.0f);
    assert_false(wr_hash_equal(heights, wr_field_hash(layer(s, "b")->heights)));
    wr_session_free(s);
}

/* ---- groups ---- */

/* A group whose members overlap with soft edges, an opacity and a mask. */
static WrSession *grouped(void)
{
    return session_of((const char *[]){
        GROUND, "layer add low", "dab 0.31,0.42 radius=19.3 strength=0.613", "layer add high",
        "dab 0.44,0.57 radius=17.1 strength=0.377", "layer set high blend=max opacity=0.71",
        "layer mask high live=\"noise cells=3 low=0.3 high=0.6 seed=5\"",
        "layer group g of=low..high", "layer set g opacity=0.4 blend=add", NULL });
}

/* Height and coverage of the group at one texel, by the rules of groups (composite.h). */
static void expect_group(const WrSession *s, int x, int y, double *height, double *cover)
{
    const WrLayer *low = layer(s, "low"), *high = layer(s, "high");
    const double h = (double)wr_field_get(low->heights, x, y);
    const double other = (double)wr_field_get(high->heights, x, y);
    const double area =
        0.71 * (double)wr_field_get(high->mask, x, y) * (double)wr_field_get(high->cover, x, y);
    const double below = (double)wr_field_get(low->cover, x, y);
    *height = h + area * (fmax(h, other) - h);
    *cover = below + area * (1 - below);
}

static void check_group_copy(const WrSession *s, const char *name, int dx, int dy, double factor)
{
    const WrLayer *copy = layer(s, name);
    for (int y = 0; y < 61; y++)
        for (int x = 0; x < 97; x++) {
            double height, cover;
            const int to_x = (x + dx + 97) % 97, to_y = (y + dy + 61) % 61;
            expect_group(s, x, y, &height, &cover);
            assert_float_equal(wr_field_get(copy->heights, to_x, to_y), factor * height, 1e-6);
            assert_float_equal(wr_field_get(copy->cover, to_x, to_y), cover, 1e-6);
        }
}

static void a_copy_of_a_group_follows_its_composite(void **state)
{
    (void)state;
    static const char *const edits[] = {
        "layer use low",           "dab 0.61,0.27 radius=7.1 strength=-0.4",
        "layer use high",          "stroke points=0.1,0.3;0.6,0.9 radius=4",
        "layer set g opacity=0.9", "layer mask g from=black"
    };
    WrSession *s = grouped();
    must_run(s, "layer duplicate g linked=on");
    assert_false(layer(s, "g copy")->is_group);
    assert_true(layer(s, "g copy")->opacity == 0.4f);
    must_run(s, "layer add moved from=\"link g shift=-0.216494845360824748,0.114754098360655737 "
                "factor=-0.37\" above=1");
    for (int i = 0; i < 6; i++) {
        const uint64_t key = wr_field_key(layer(s, "moved")->heights);
        must_run(s, edits[i]);
        check_group_copy(s, "g copy", 0, 0, 1);
        check_group_copy(s, "moved", -21, -7, -0.37);
        const bool edits_members = i == 1 || i == 3;
        assert_int_equal(wr_field_key(layer(s, "moved")->heights) != key, edits_members);
    }
    must_run(s, "layer set high visible=off");
    assert_true(same_field(layer(s, "g copy")->heights, layer(s, "low")->heights));
    must_run(s, "layer rename g leaves");
    assert_string_equal(layer(s, "g copy")->line, "link leaves");
    wr_session_free(s);
}

/* A hidden group is a usual source: its copies show its layers, computed ones too. */
static void a_hidden_group_is_followed_for_its_copies(void **state)
{
    (void)state;
    WrSession *s = grouped(), *shown = grouped();
    WrSession *both[] = { s, shown };
    for (int i = 0; i < 2; i++) {
        must_run(both[i], "layer add dots from=\"pattern dots across=3\" in=g");
        must_run(both[i], "layer add c from=\"link dots turn=33\" in=g");
        must_run(both[i], "layer add worn from=\"terrain terraces steps=3\" in=g");
        must_run(both[i], "layer set worn blend=max");
        must_run(both[i], "layer duplicate g linked=on");
        must_run(both[i], i == 0 ? "layer set g visible=off" : "layer set g opacity=0.3");
        must_run(both[i], "layer set dots change=\"across=7\"");
    }
    assert_true(same_field(layer(s, "c")->heights, layer(shown, "c")->heights));
    assert_true(same_field(layer(s, "worn")->heights, layer(shown, "worn")->heights));
    assert_true(same_field(layer(s, "g copy")->heights, layer(shown, "g copy")->heights));
    assert_true(same_cover(layer(s, "g copy")->cover, layer(shown, "g copy")->cover));
    wr_session_free(s);
    wr_session_free(shown);
}

static void cycles_through_groups_are_refused(void **state)
{
    (void)state;
    Said said;
    WrSession *s = grouped();
    must_fail(s, "layer add c from=\"link g\" above=2",
              "a cycle of links: layer 3 \"c\" > layer 5 \"g\" > layer 3 \"c\"");
    must_run(s, "layer group outer of=g");
    must_fail(s, "layer add c from=\"link outer\" in=g",
              "layer 4 \"c\" > layer 6 \"outer\" > layer 5 \"g\" > layer 4 \"c\"");
    must_run(s, "layer add c from=\"link outer\" above=1"); /* below the group: no cycle */
    wr_session_free(s);
    s = listening(&said);
    must_run(s, "table 97x61");
    must_run(s, "layer add a");
    must_run(s, "dab 0.3,0.4 radius=11.3");
    must_run(s, "layer group g of=a");
    must_run(s, "layer duplicate g linked=on");
    const WrHash heights = wr_field_hash(layer(s, "g copy")->heights);
    said.text[0] = '\0';
    must_run(s, "layer move \"g copy\" in=g");
    assert_non_null(strstr(said.text, "keeps its heights (a cycle of links: layer 3 \"g copy\" > "
                                      "layer 4 \"g\" > layer 3 \"g copy\")"));
    must_run(s, "layer use a");
    must_run(s, "dab 0.6,0.4 radius=11.3");
    assert_true(wr_hash_equal(heights, wr_field_hash(layer(s, "g copy")->heights)));
    wr_session_free(s);
}

/* A mask in the group reads a layer that reads the copy. */
static void a_cycle_through_a_mask_of_a_member_is_refused(void **state)
{
    (void)state;
    WrSession *s = ground();
    must_run(s, "layer add x from=\"pattern dots\"");
    must_run(s, "layer add m");
    must_run(s, "layer group g of=m");
    must_run(s, "layer mask m live=\"height of=x\"");
    must_fail(s, "layer set x from=\"link g\"",
              "layer 3 \"x\" > layer 5 \"g\" > layer 4 \"m\" > layer 3 \"x\"");
    must_run(s, "layer add y from=\"link g\" above=1"); /* nothing in the group reads it */
    wr_session_free(s);
}

/* ---- names ---- */

static void of_several_names_the_nearest_counts(void **state)
{
    (void)state;
    WrSession *s = ground(); /* base, a */
    must_run(s, "fill 0.1");
    must_run(s, "layer add x");
    must_run(s, "layer add y");
    must_run(s, "layer rename y a"); /* base, a, x, a */
    must_run(s, "fill 0.2");
    must_run(s, "layer set x visible=on");
    must_run(s, "layer add b from=\"link a\" above=x"); /* nearest below: number 2 */
    assert_true(wr_field_get(layer(s, "b")->heights, 5, 5) == 0.1f);
    must_fail(s, "layer set b change=5", "has the name of another layer");
    must_run(s, "layer rename 5 \"the upper; \\\"one\\\" #2\"");
    must_run(s, "layer set b change=5");
    assert_true(wr_field_get(layer(s, "b")->heights, 5, 5) == 0.2f);
    must_run(s, "layer rename 5 a");
    assert_string_equal(layer(s, "b")->line, "link a");
    wr_session_free(s);
}

/* ---- other commands ---- */

static void commands_on_all_tables_keep_the_link(void **state)
{
    (void)state;
    WrSession *s = ground();
    must_run(s, "dab 0.3,0.4 radius=11.3");
    must_run(s, "layer duplicate a linked=on");
    must_run(s, "adjust offset du=7 layers=all");
    assert_true(shares(s, "a", "a copy"));
    must_run(s, "adjust resize width=131 height=53");
    assert_non_null(layer(s, "a copy")->line);
    assert_true(shares(s, "a", "a copy"));
    must_run(s, "layer clear \"a copy\""); /* a copy that is written alone is a plain layer */
    assert_null(layer(s, "a copy")->line);
    must_run(s, "undo");
    must_run(s, "layer merge \"a copy\"");
    assert_null(layer(s, "a")->line);
    wr_session_free(s);
}

/* The plain command, inside the selection. */
static void the_command_copies_into_the_active_layer(void **state)
{
    (void)state;
    WrSession *s = ground();
    must_run(s, "fill 0.37");
    must_run(s, "layer add b");
    must_run(s, "select rect from=0,0 to=0.5,1");
    must_run(s, "link a factor=2");
    assert_true(wr_field_get(layer(s, "b")->heights, 10, 10) == 0.74f);
    assert_true(wr_field_get(layer(s, "b")->heights, 90, 10) == 0.0f);
    assert_true(wr_field_get(layer(s, "b")->cover, 10, 10) == 1.0f);
    assert_true(wr_field_get(layer(s, "b")->cover, 90, 10) == 0.0f);
    wr_session_free(s);
}

/* ---- files ---- */

static void save_and_open(const char *name)
{
    char line[100];
    Said said;
    WrSession *s = listening(&said), *again = wr_session_new(NULL);
    must_run(s, "table 97x61");
    must_run(s, "layer add a");
    must_run(s, "dab 0.3,0.4 radius=11.3");
    must_run(s, "layer duplicate a linked=on");
    must_run(s, "layer add b from=\"link a turn=33\"");
    must_run(s, "layer group g of=a");
    must_run(s, "layer duplicate g linked=on");
    snprintf(line, sizeof line, "save %s", name);
    must_run(s, line);
    snprintf(line, sizeof line, "open %s", name);
    must_run(again, line);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    const uint64_t key = wr_field_key(layer(again, "b")->heights);
    const uint64_t group_key = wr_field_key(layer(again, "g copy")->heights);
    must_run(again, "layer use 1"); /* tiles are shared again; others are not made again */
    assert_true(shares(again, "a", "a copy"));
    assert_int_equal(wr_field_key(layer(again, "b")->heights), key);
    assert_int_equal(wr_field_key(layer(again, "g copy")->heights), group_key);
    static const char *const edits[] = { "layer use a", "dab 0.7,0.2 radius=9" };
    for (int i = 0; i < 2; i++) {
        must_run(s, edits[i]);
        must_run(again, edits[i]);
    }
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    wr_session_free(s);
    wr_session_free(again);
}

static void files_keep_the_link(void **state)
{
    (void)state;
    save_and_open("link.exr");
    save_and_open("link.ora");
}

/* A file whose copies copy each other, or themselves, as no command makes it. */
static void a_file_with_a_cycle_can_be_edited(void **state)
{
    (void)state;
    static const char *const pairs[][2] = { { "link b", "link a" },
                                            { "link a", "link a" },
                                            { "link a turn=1e9", "link \"\"" },
                                            { "link", "link b b" } };
    for (int k = 0; k < 4; k++) {
        WrSession *s = ground();
        must_run(s, "fill 0.3");
        must_run(s, "layer duplicate a");
        must_run(s, "layer rename 3 b");
        WrDocument *document = wr_document_share(doc(s));
        for (int i = 0; i < 2; i++)
            wr_layer_set_line(&document->layers[1 + i], pairs[k][i], (WrHash){ 7, 7 });
        WrError err;
        if (!wr_document_save(document, "", "cycle.exr", NULL, &err)) fail_msg("%s", err.text);
        wr_document_free(document);
        Said said;
        WrSession *other = listening(&said);
        must_run(other, "open cycle.exr");
        assert_true(said.text[0]);
        must_run(other, "layer use 1");
        must_run(other, "dab 0.5,0.5 radius=4");
        assert_true(same_field(layer(other, "a")->heights, layer(s, "a")->heights));
        must_run(other, "layer rasterize a");
        must_run(other, "save cycle.ora");
        wr_session_free(other);
        wr_session_free(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_copy_has_the_bits_of_one_made_by_hand),
        cmocka_unit_test(everything_follows_in_one_command),
        cmocka_unit_test(a_copy_is_made_only_if_its_source_changes),
        cmocka_unit_test(cycles_are_refused),
        cmocka_unit_test(a_cycle_closed_by_a_move_keeps_the_heights),
        cmocka_unit_test(a_lost_source_leaves_the_heights),
        cmocka_unit_test(a_copy_of_a_group_follows_its_composite),
        cmocka_unit_test(a_hidden_group_is_followed_for_its_copies),
        cmocka_unit_test(cycles_through_groups_are_refused),
        cmocka_unit_test(a_cycle_through_a_mask_of_a_member_is_refused),
        cmocka_unit_test(of_several_names_the_nearest_counts),
        cmocka_unit_test(commands_on_all_tables_keep_the_link),
        cmocka_unit_test(the_command_copies_into_the_active_layer),
        cmocka_unit_test(files_keep_the_link),
        cmocka_unit_test(a_file_with_a_cycle_can_be_edited),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

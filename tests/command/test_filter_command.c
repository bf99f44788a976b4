/* Filter layers by command lines: creation, changes, undo, refusals, masks, merging, files. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/memory.h"
#include "document/document_file.h"
#include "field/ops.h"
#include "image/image.h"

static WrSession *hilly(void)
{
    return session_of((const char *[]){ "table 77x53", "grid cells=5x3 width=7 low=0.25 high=1.25",
                                        "layer add top", "stroke points=0.1,0.2;0.9,0.4 radius=6",
                                        "layer use 1", NULL });
}

static WrField *now(const WrSession *s)
{
    return wr_field_share(wr_document_field(doc(s)));
}

static bool is_close(const WrField *a, const WrField *b, double most)
{
    for (int j = 0; j < wr_field_height(a); j++)
        for (int i = 0; i < wr_field_width(a); i++)
            if (!(fabs((double)wr_field_get(a, i, j) - (double)wr_field_get(b, i, j)) <= most))
                return false;
    return true;
}

static void a_filter_is_made_above_the_active_layer_and_changed_by_its_number(void **state)
{
    (void)state;
    WrSession *s = hilly();
    WrField *plain = now(s);
    must_run(s, "filter blur sigma=2.5");
    assert_int_equal(doc(s)->layer_count, 3);
    assert_int_equal(doc(s)->active, 1);
    assert_string_equal(doc(s)->layers[1].name, "Gaussian blur");
    WrField *blurred = now(s);
    assert_false(same_field(plain, blurred));
    /* equal to `adjust` on the bottom layer */
    WrSession *other = hilly();
    must_run(other, "adjust blur sigma=2.5");
    assert_true(same_field(blurred, wr_document_field(doc(other))));
    must_run(s, "filter levels in-high=2 layer=2");
    assert_int_equal(doc(s)->layer_count, 3);
    assert_false(same_field(blurred, wr_document_field(doc(s))));
    must_run(s, "undo");
    assert_true(same_field(blurred, wr_document_field(doc(s))));
    /* it is updated after changes below */
    must_run(s, "layer use 1");
    must_run(s, "dab 0.31,0.77 radius=9 strength=0.6");
    must_run(other, "undo");
    must_run(other, "dab 0.31,0.77 radius=9 strength=0.6");
    must_run(other, "adjust blur sigma=2.5");
    assert_true(same_field(wr_document_field(doc(s)), wr_document_field(doc(other))));
    must_run(s, "undo 2"); /* the stroke and the filter */
    assert_true(same_field(plain, wr_document_field(doc(s))));
    wr_field_free(plain);
    wr_field_free(blurred);
    wr_session_free(other);
    wr_session_free(s);
}

static void its_heights_are_refused_and_its_mask_is_painted(void **state)
{
    (void)state;
    WrSession *s = hilly();
    WrField *plain = now(s);
    must_run(s, "filter add amount=0.5 name=lift");
    static const char *const edits[] = { "dab 0.5,0.5 radius=4", "fill 1",
                                         "adjust blur sigma=1",  "pattern dots",
                                         "noise value",          "transform move=3,0",
                                         "flood 0.5,0.5 to=1" };
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) must_fail(s, edits[i], "filter");
    must_fail(s, "layer clear", "filter");
    must_fail(s, "filter blur sigma=1 layer=1", "is not a filter layer");
    must_fail(s, "filter blur sigma=1 layer=2 name=x", "rename");
    must_fail(s, "filter levels in-low=2 in-high=2", "differ");
    must_fail(s, "filter clamp low=2 high=1", "above");
    must_fail(s, "filter resize width=8", "resize");
    must_run(s, "layer set 2 lock=on");
    must_fail(s, "filter blur sigma=1 layer=2", "locked");
    must_run(s, "layer set 2 lock=off");
    must_run(s, "layer mask 2 from=black");
    must_run(s, "layer use 2 part=mask");
    assert_true(same_field(plain, wr_document_field(doc(s))));
    must_run(s, "dab 0.5,0.5 radius=5 hardness=1 strength=1 mode=to to=1");
    assert_near(f_at(s, 38, 26), (double)wr_field_get(plain, 38, 26) + 0.5, 1e-6);
    assert_near(f_at(s, 3, 3), (double)wr_field_get(plain, 3, 3), 0.0);
    /* operations on all layers keep its empty heights, and transform its mask */
    must_run(s, "layer use 2 part=heights");
    must_run(s, "adjust add amount=1 layers=all");
    assert_near(f_at(s, 3, 3), (double)wr_field_get(plain, 3, 3) + 2.0, 1e-6);
    must_run(s, "adjust offset du=7 layers=all");
    assert_near(f_at(s, 45, 26), (double)wr_field_get(plain, 38, 26) + 2.5, 1e-6);
    must_run(s, "adjust rotate angle=90");
    must_run(s, "transform turn=90 layers=all");
    wr_field_free(plain);
    wr_session_free(s);
}

static void joining_and_doubling_keep_what_is_seen(void **state)
{
    (void)state;
    WrSession *s = hilly();
    must_run(s, "filter blur sigma=1.3");
    must_run(s, "layer set 2 opacity=0.7");
    must_run(s, "filter levels in-low=0.2 in-high=0.9 gamma=1.4");
    must_run(s, "layer set 3 blend=max");
    WrField *seen = now(s);
    must_run(s, "layer merge 3"); /* two filters */
    assert_true(is_close(seen, wr_document_field(doc(s)), 1e-6));
    assert_null(doc(s)->layers[1].filter.op);
    must_run(s, "undo");
    must_run(s, "layer merge 2"); /* onto the bottom layer: exact */
    assert_true(same_field(seen, wr_document_field(doc(s))));
    must_run(s, "undo");
    must_run(s, "layer merge 4"); /* an ordinary layer onto a filter */
    assert_true(is_close(seen, wr_document_field(doc(s)), 1e-6));
    must_run(s, "undo");
    must_run(s, "layer flatten");
    assert_int_equal(doc(s)->layer_count, 1);
    assert_true(same_field(seen, wr_document_field(doc(s))));
    must_run(s, "undo");
    must_run(s, "layer duplicate 2");
    assert_true(doc(s)->layers[2].filter.op == wr_op_find("blur"));
    assert_near(doc(s)->layers[2].filter.param[0], 1.3, 0);
    must_run(s, "layer set 3 opacity=0");
    assert_true(same_field(seen, wr_document_field(doc(s))));
    /* solo: its whole input, without layers above */
    must_run(s, "layer solo 2");
    WrSession *below = hilly();
    must_run(below, "layer set 2 visible=off");
    must_run(below, "filter blur sigma=1.3");
    must_run(below, "layer set 2 opacity=0.7");
    assert_true(same_field(wr_document_field(doc(s)), wr_document_field(doc(below))));
    wr_session_free(below);
    wr_field_free(seen);
    wr_session_free(s);
}

static void check_version(const char *path, const char *version)
{
    WrError err;
    WrImageFile *file = wr_image_file_open(path, &err);
    if (!file) fail_msg("%s", err.text);
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:version"), version);
    wr_image_file_close(file);
}

static void files_keep_filters_and_older_ones_stay_as_they_were(void **state)
{
    (void)state;
    static const char *const names[] = { "a.exr", "a.ora" };
    WrSession *s = hilly();
    WrSessionOptions writes = { .outputs = true };
    WrSession *out = wr_session_new(&writes);
    must_run(out, "table 41x23");
    must_run(out, "save old.exr");
    check_version("old.exr", "3"); /* uses no new feature */
    must_run(out, "grid cells=3x2 width=4");
    must_run(out, "filter median radius=2.25 window=square");
    must_run(out, "layer mask 2 from=white");
    must_run(out, "layer use 2 part=mask");
    must_run(out, "dab 0.3,0.3 radius=7 strength=0.7 mode=lower");
    must_run(out, "filter clamp low=-0.125 high=0.8125");
    must_run(out, "layer set 3 opacity=0.3 blend=add");
    for (int i = 0; i < 2; i++) {
        char line[64];
        WrError err;
        snprintf(line, sizeof line, "save %s", names[i]);
        must_run(out, line);
        WrSession *in = wr_session_new(NULL);
        if (!wr_session_open(in, names[i], &err)) fail_msg("%s", err.text);
        assert_true(wr_hash_equal(wr_session_hash(in), wr_session_hash(out)));
        assert_true(same_field(wr_document_field(doc(in)), wr_document_field(doc(out))));
        assert_true(wr_filter_same(&doc(in)->layers[1].filter, &doc(out)->layers[1].filter));
        wr_session_free(in);
    }
    check_version("a.exr", "9");
    /* a single filter layer is not a plain table */
    must_run(out, "layer delete 1");
    must_run(out, "layer delete 2");
    must_run(out, "save single.exr");
    WrSession *in = wr_session_new(NULL);
    WrError err;
    if (!wr_session_open(in, "single.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(in), wr_session_hash(out)));
    wr_session_free(in);
    wr_session_free(out);
    wr_session_free(s);
}

static void files_with_filters_that_are_none_are_refused(void **state)
{
    (void)state;
    WrSessionOptions writes = { .outputs = true };
    WrSession *out = wr_session_new(&writes);
    must_run(out, "table 9x7");
    must_run(out, "filter blur sigma=2.5");
    must_run(out, "save good.exr");
    wr_session_free(out);
    static const char *const in_its_place[] = { "blur sigma=-.5", "blur sagma=2.5",
                                                "crop width=2.5" };
    for (size_t i = 0; i < sizeof in_its_place / sizeof *in_its_place; i++) {
        FILE *file = fopen("good.exr", "rb");
        char bytes[20000];
        size_t length = fread(bytes, 1, sizeof bytes, file);
        fclose(file);
        char *at = memmem(bytes, length, "blur sigma=2.5", 14);
        assert_non_null(at);
        memcpy(at, in_its_place[i], 14);
        file = fopen("bad.exr", "wb");
        assert_int_equal(fwrite(bytes, 1, length, file), length);
        fclose(file);
        WrSession *in = wr_session_new(NULL);
        WrError err = { "" };
        assert_false(wr_session_open(in, "bad.exr", &err));
        if (!strstr(err.text, "filter '")) fail_msg("%s", err.text);
        wr_session_free(in);
    }
}

/* Undo of an edit below filters stores tiles of the layer, not composites. */
static void undo_costs_what_the_edit_touched(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 2048x1024", "noise value cells=9",
                                                "filter blur sigma=3", "filter levels in-high=0.7",
                                                "layer use 1", NULL });
    wr_document_field(doc(s));
    WrDocument *before = wr_document_snapshot(doc(s));
    must_run(s, "dab 0.503,0.503 radius=5 strength=0.3");
    wr_document_field(doc(s));
    size_t bytes = wr_document_difference(before, doc(s));
    assert_true(bytes > 0 && bytes < 6 * 16384 + 8192);
    wr_document_free(before);
    wr_session_free(s);
}

/* Simulates a lack of memory: the operation fails, by values that no command can set. */
static void break_filter(WrSession *s, int layer, double to)
{
    ((WrDocument *)doc(s))->layers[layer].filter.param[1] = to;
}

static void what_a_filter_cannot_be_carried_out_for_is_refused(void **state)
{
    (void)state;
    static const char *const refused[] = { "save lacks.exr",
                                           "save lacks.ora",
                                           "export height lacks.png",
                                           "export normal+y lacks.png",
                                           "render lacks.png size=16x16",
                                           "maps blender .",
                                           "layer flatten",
                                           "layer merge 2",
                                           "select height low=0.2 high=0.7",
                                           "layer mask 3 from=height low=0.2 high=0.9",
                                           "copy lacks.exr of=composite" };
    WrSession *s = hilly();
    wr_session_set_outputs(s, true);
    must_run(s, "filter levels in-low=0.17 in-high=1.3");
    WrField *right = now(s);
    WrHash before = wr_session_hash(s);
    break_filter(s, 1, 0.17);
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        WrError err = { "" };
        must_run(s, "undo");
        must_run(s, "redo"); /* whose composite is not computed yet */
        break_filter(s, 1, 0.17);
        if (wr_session_run(s, refused[i], &err)) fail_msg("%s went through", refused[i]);
        if (!strstr(err.text, "'Levels' cannot be computed (levels: "))
            fail_msg("%s: %s", refused[i], err.text);
    }
    assert_int_not_equal(access("lacks.exr", F_OK), 0);
    assert_int_not_equal(access("lacks.ora", F_OK), 0);
    assert_int_not_equal(access("lacks.png", F_OK), 0);
    must_run(s, "layer use 1");
    must_run(s, "dab 0.5,0.5 radius=3 strength=1"); /* lines that do not need it still work */
    must_run(s, "undo");
    must_run(s, "layer set 3 blend=mix");
    must_run(s, "layer use 3");
    break_filter(s, 1, 0.17);
    WrError erased = { "" };
    assert_false(wr_session_stroke_begin(s, "stroke mode=erase radius=5", &erased));
    assert_non_null(strstr(erased.text, "cannot be computed"));
    must_run(s, "undo");
    must_run(s, "layer use 2");
    break_filter(s, 1, 0.17);
    must_run(s, "layer set 2 visible=off");
    must_run(s, "save lacks.exr");
    must_run(s, "undo");
    break_filter(s, 1, 1.3);
    WrHash after = wr_session_hash(s);
    assert_memory_equal(&before, &after, sizeof before);
    assert_true(same_field(right, wr_document_field(doc(s))));
    wr_field_free(right);
    wr_session_free(s);
}

/* A previewed filter is not computed again: the composite is the preview's table itself. */
static void a_filter_that_was_made_before_is_taken(void **state)
{
    (void)state;
    static const char *const lines[] = { "filter blur sigma=2.5",
                                         "filter median radius=2 layer=2" };
    WrError err;
    WrSession *s = hilly(), *tried = hilly();
    for (int i = 0; i < 2; i++) {
        WrDocument *made = wr_document_share(doc(s));
        WrFilter filter;
        assert_true(wr_filter_parse(i ? "median radius=2" : "blur sigma=2.5", &filter, &err));
        if (i) made->layers[1].filter = filter;
        else wr_document_add_filter(made, "", &filter);
        const uint64_t key = wr_field_key(wr_document_field(made));
        assert_true(wr_session_takes_made(lines[i]));
        if (!wr_session_run_made(s, lines[i], made, &err)) fail_msg("%s", err.text);
        wr_document_free(made);
        assert_true(wr_field_key(wr_document_field(doc(s))) == key);
        must_run(tried, lines[i]);
        assert_true(same_field(wr_document_field(doc(s)), wr_document_field(doc(tried))));
        WrHash a = wr_session_hash(s), b = wr_session_hash(tried);
        assert_memory_equal(&a, &b, sizeof a);
    }
    wr_session_free(s);
    wr_session_free(tried);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_filter_is_made_above_the_active_layer_and_changed_by_its_number),
        cmocka_unit_test(its_heights_are_refused_and_its_mask_is_painted),
        cmocka_unit_test(joining_and_doubling_keep_what_is_seen),
        cmocka_unit_test(files_keep_filters_and_older_ones_stay_as_they_were),
        cmocka_unit_test(files_with_filters_that_are_none_are_refused),
        cmocka_unit_test(what_a_filter_cannot_be_carried_out_for_is_refused),
        cmocka_unit_test(a_filter_that_was_made_before_is_taken),
        cmocka_unit_test(undo_costs_what_the_edit_touched),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

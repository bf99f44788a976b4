/* Groups of layers as commands: edits, order, transforms, live masks, and documents. */
#include "test.h"
#include "session_help.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "command/session.h"
#include "document/blend.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"

/* Names from the bottom up, each with its depth; groups in capitals. */
static void assert_rows(const WrSession *s, const char *expected)
{
    char rows[400] = "";
    for (int i = 0; i < doc(s)->layer_count; i++)
        snprintf(rows + strlen(rows), sizeof rows - strlen(rows), "%s%s%d", i ? " " : "",
                 doc(s)->layers[i].name, doc(s)->layers[i].depth);
    assert_string_equal(rows, expected);
}

static WrSession *four_layers(void)
{
    return session_of((const char *[]){
        "table 90x53", "layer rename 1 a", "noise perlin cells=5", "layer add b",
        "dab 0.4,0.6 radius=17 strength=0.7", "layer add c blend=max",
        "dab 0.5,0.4 radius=20 strength=0.9", "layer add d opacity=0.6", "pattern bricks", NULL });
}

static void groups_are_made_of_numbers_ranges_and_names(void **state)
{
    (void)state;
    WrSession *s = four_layers();
    must_run(s, "layer group G of=b..c");
    assert_rows(s, "a0 b1 c1 G0 d0");
    assert_int_equal(doc(s)->active, 3);
    assert_int_equal(doc(s)->layers[3].blend, WR_BLEND_ADD);
    must_run(s, "layer group of=5,a");
    assert_rows(s, "b1 c1 G0 a1 d1 group 10");
    must_run(s, "layer set c blend=replace radius=0.25");
    must_run(s, "layer group H of=c");
    assert_int_equal(doc(s)->layers[2].blend, WR_BLEND_REPLACE);
    assert_rows(s, "b1 c2 H1 G0 a1 d1 group 10");
    must_run(s, "layer ungroup G");
    assert_rows(s, "b0 c1 H0 a1 d1 group 10");
    must_run(s, "undo 2");
    assert_rows(s, "b1 c1 G0 a1 d1 group 10");
    must_fail(s, "layer group x of=2..9", "must be 1..6");
    must_fail(s, "layer group x of=1,,2", "a layer is missing before or after a comma");
    must_fail(s, "layer ungroup a", "is not a group");
    wr_session_free(s);
}

static void layers_move_into_groups_and_out(void **state)
{
    (void)state;
    WrSession *s = four_layers();
    must_run(s, "layer group G of=b,c");
    must_run(s, "layer move d in=G");
    assert_rows(s, "a0 b1 c1 d1 G0");
    must_run(s, "layer move b in=none");
    assert_rows(s, "a0 c1 d1 G0 b0");
    must_run(s, "layer move b to=2 in=G");
    assert_rows(s, "a0 b1 c1 d1 G0");
    must_run(s, "layer move G to=4"); /* with its layers, so the least is 4 */
    assert_rows(s, "b1 c1 d1 G0 a0");
    must_run(s, "layer move d to=4"); /* up, out of its group */
    assert_rows(s, "b1 c1 G0 d0 a0");
    must_run(s, "layer add e in=G");
    assert_rows(s, "b1 c1 e1 G0 d0 a0");
    must_fail(s, "layer move G to=2", "must be 4..6");
    must_fail(s, "layer move G in=G", "into itself");
    must_fail(s, "layer move a to=2 in=none", "is in a group");
    must_fail(s, "layer move a to=5 in=G", "is not in that group");
    must_fail(s, "layer move a in=d", "is not a group");
    must_fail(s, "layer move a", "give to=, the new number");
    must_run(s, "layer duplicate G");
    assert_rows(s, "b1 c1 e1 G0 b1 c1 e1 G copy0 d0 a0");
    assert_int_equal(doc(s)->active, 7);
    must_run(s, "layer delete G");
    assert_rows(s, "b1 c1 e1 G copy0 d0 a0");
    wr_session_free(s);
}

static void nesting_ends_at_eight(void **state)
{
    (void)state;
    WrSession *s = four_layers();
    for (int k = 0; k < WR_DEPTH_MAX; k++) must_run(s, "layer group of=1");
    /* each group of layer 1 is the innermost one */
    assert_int_equal(doc(s)->layers[0].depth, 8);
    must_fail(s, "layer group of=1", "up to 8 groups");
    must_run(s, "layer group of=c");
    must_run(s, "layer move c in=2");
    must_run(s, "undo");
    must_fail(s, "layer move 12 in=2", "up to 8 groups");
    wr_session_free(s);
}

static void a_group_itself_takes_no_paint(void **state)
{
    (void)state;
    WrSession *s = four_layers();
    must_run(s, "layer group G of=b,c");
    must_fail(s, "dab 0.5,0.5", "is a group, which has no heights");
    must_fail(s, "layer clear G", "is a group");
    must_run(s, "layer mask G from=white");
    must_run(s, "layer use G part=mask");
    must_run(s, "dab 0.5,0.5 radius=30 strength=-1");
    assert_true(wr_field_get(doc(s)->layers[3 - 1].heights, 45, 26) != 0);
    assert_true(wr_field_get(doc(s)->layers[3].mask, 45, 26) < 0.1f);
    must_run(s, "layer set G visible=off");
    must_run(s, "layer use b");
    must_fail(s, "dab 0.5,0.5", "\"G\" is hidden");
    must_run(s, "layer set G visible=on lock=on");
    must_fail(s, "dab 0.5,0.5", "\"G\" is locked");
    must_fail(s, "layer set a collapsed=on", "is not a group");
    wr_session_free(s);
}

static void a_group_becomes_one_layer_of_the_same_composite(void **state)
{
    (void)state;
    WrSession *s = four_layers();
    must_run(s, "layer group G of=b..d");
    must_run(s, "layer set G opacity=0.7");
    WrField *before = wr_field_share(wr_document_field(doc(s)));
    must_run(s, "layer rasterize G");
    assert_rows(s, "a0 G0");
    assert_true(same_field(before, wr_document_field(doc(s))));
    must_run(s, "undo");
    must_run(s, "layer merge G");
    assert_true(same_field(before, wr_document_field(doc(s))));
    must_run(s, "undo");
    must_fail(s, "layer merge b", "no layer below it in its group");
    must_run(s, "layer merge c");
    assert_rows(s, "a0 b1 d1 G0");
    wr_field_free(before);
    wr_session_free(s);
}

/* Moving by whole texels moves the composite. */
static void transforms_take_every_layer_of_a_group(void **state)
{
    (void)state;
    WrSession *s = four_layers();
    must_run(s, "layer delete a");
    must_run(s, "layer group G of=1..3");
    must_run(s, "layer mask G from=white");
    must_run(s, "layer use G part=mask");
    must_run(s, "dab 0.2,0.5 radius=20 strength=-0.6");
    must_run(s, "layer use G part=heights");
    WrField *before = wr_field_share(wr_document_field(doc(s)));
    must_run(s, "transform move=7,-5");
    for (int j = 0; j < 53; j++)
        for (int i = 0; i < 90; i++)
            assert_true(f_at(s, i, j) == wr_field_get(before, (i + 83) % 90, (j + 48) % 53));
    must_run(s, "undo");
    must_run(s, "adjust offset du=7 dv=-5 layers=all");
    for (int j = 0; j < 53; j++)
        for (int i = 0; i < 90; i++) {
            const float was = wr_field_get(before, (i + 83) % 90, (j + 48) % 53);
            const float other = wr_field_get(before, (i + 83) % 90, (j + 5) % 53);
            assert_true(f_at(s, i, j) == was || f_at(s, i, j) == other);
        }
    must_run(s, "adjust resize width=64 height=40");
    for (int i = 0; i < 4; i++) assert_int_equal(wr_field_width(doc(s)->layers[i].heights), 64);
    wr_field_free(before);
    wr_session_free(s);
}

static void masks_and_lines_in_a_group_read_what_is_below_there(void **state)
{
    (void)state;
    WrSession *s =
        session_of((const char *[]){ "table 90x53", "fill 5", "layer add b", "fill 0.3",
                                     "layer add c", "fill 1", "layer group G of=b,c", NULL });
    /* below c lies b alone, at 0.3 */
    must_run(s, "layer mask c live=\"height low=0.2 high=0.4\"");
    assert_true(wr_field_get(doc(s)->layers[2].mask, 9, 9) == 1);
    must_run(s, "layer use b");
    must_run(s, "fill 0.7");
    assert_true(wr_field_get(doc(s)->layers[2].mask, 9, 9) == 0);
    must_run(s, "undo");
    must_run(s, "layer move b in=none"); /* nothing is below c any more */
    assert_true(wr_field_get(doc(s)->layers[1].mask, 9, 9) == 0);
    must_fail(s, "layer mask b live=\"height of=G\"", "is a filter layer or a group");
    must_run(s, "layer mask G from=black");
    must_run(s, "layer mask b live=\"mask of=G\"");
    assert_true(wr_field_get(doc(s)->layers[3].mask, 9, 9) == 0);
    wr_session_free(s);
}

static void an_object_can_use_a_group_as_its_table(void **state)
{
    (void)state;
    WrSession *s = four_layers();
    must_run(s, "layer group G of=b,c");
    must_run(s, "object set layer=G");
    must_run(s, "layer set G visible=off");
    must_run(s, "layer use b"); /* hidden, but the object shows it */
    must_run(s, "dab 0.5,0.5");
    wr_session_free(s);
}

/* ---- documents ---- */

static void save_load_save(const char *first, const char *second)
{
    WrError err;
    Said said;
    WrSession *a = four_layers(), *b = listening(&said);
    must_run(a, "layer group G of=b..c");
    must_run(a, "filter blur sigma=2 name=soft");
    must_run(a, "layer move soft in=G");
    must_run(a, "layer group H of=G,d");
    must_run(a, "layer mask G from=white");
    must_run(a, "layer set G collapsed=on blend=smooth-max radius=0.1 lock=on");
    must_run(a, "layer set H opacity=0.4 visible=off");
    must_run(a, "layer add e in=H");
    must_run(a, "layer group empty of=e");
    must_run(a, "layer move e to=1 in=none");
    if (!wr_session_save(a, first, &err)) fail_msg("%s", err.text);
    if (!wr_session_open(b, first, &err)) fail_msg("%s", err.text);
    assert_rows(b, "e0 a0 b2 c2 soft2 G1 d1 empty1 H0");
    assert_true(doc(b)->layers[5].collapsed && doc(b)->layers[5].is_group);
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    if (!wr_session_save(b, second, &err)) fail_msg("%s", err.text);
    char *bytes[2];
    size_t length[2];
    assert_true(wr_file_read(first, 1 << 26, &bytes[0], &length[0], &err));
    assert_true(wr_file_read(second, 1 << 26, &bytes[1], &length[1], &err));
    assert_int_equal(length[0], length[1]);
    assert_memory_equal(bytes[0], bytes[1], length[0]);
    wr_free(bytes[0]);
    wr_free(bytes[1]);
    wr_session_free(a);
    wr_session_free(b);
}

static void documents_bring_groups_back(void **state)
{
    (void)state;
    save_load_save("a.exr", "b.exr");
    save_load_save("a.ora", "b.ora");
}

static bool zeros(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)ctx;
    (void)y;
    (void)err;
    memset(out, 0, (size_t)rows * 12 * sizeof(float));
    return true;
}

/* A document of layers with these depths, bottom first; negative: a group of depth -1 - d. */
static void refuse(const int *depths, int count, const char *filter, const char *word)
{
    const WrImageAttribute of_file[] = { { "wrinkle:version", "12" },
                                         { "wrinkle:wrap", "periodic" } };
    WrImageAttribute of_layers[16][3];
    char texts[16][8], names[16][16];
    WrImageOut outs[17];
    WrError err;
    Said said;
    for (int i = 0; i <= count; i++) {
        const int d = i ? depths[i - 1] : 0;
        outs[i] = (WrImageOut){ .width = 12,
                                .height = 7,
                                .channels = 1,
                                .type = WR_PIXEL_F32,
                                .data = true,
                                .rows = zeros,
                                .part_name = i ? names[i - 1] : "F",
                                .attributes = i ? of_layers[i - 1] : of_file,
                                .attribute_count = i == 0            ? 2
                                                   : filter && d < 0 ? 3
                                                                     : 2 };
        if (i == 0) continue;
        snprintf(names[i - 1], sizeof *names, "layer:%d", i);
        snprintf(texts[i - 1], sizeof *texts, "%d", d < 0 ? -1 - d : d);
        of_layers[i - 1][0] = (WrImageAttribute){ "wrinkle:depth", texts[i - 1] };
        of_layers[i - 1][1] = (WrImageAttribute){ "wrinkle:group", d < 0 ? "on" : "off" };
        of_layers[i - 1][2] = (WrImageAttribute){ "wrinkle:filter", filter };
    }
    if (!wr_image_write("hostile.exr", outs, count + 1, &err)) fail_msg("%s", err.text);
    WrSession *s = listening(&said);
    if (wr_session_open(s, "hostile.exr", &err)) {
        if (word) fail_msg("accepted: %s", word);
    } else if (!word || !strstr(err.text, word)) {
        fail_msg("%s", err.text);
    }
    wr_session_free(s);
}

static void documents_with_broken_groups_are_refused(void **state)
{
    (void)state;
    refuse((const int[]){ 1, -1 }, 2, NULL, NULL);
    refuse((const int[]){ 1 }, 1, NULL, "layer 1 is 1 groups deep, but only 0 are open");
    refuse((const int[]){ 2, -1 }, 2, NULL, "layer 1 is 2 groups deep, but only 1 are open");
    refuse((const int[]){ 1, 0 }, 2, NULL, "a group is missing");
    refuse((const int[]){ 8, -8, -7, -6, -5, -4, -3, -2, -1 }, 9, NULL, NULL);
    refuse((const int[]){ -9, -8, -7, -6, -5, -4, -3, -2, -1 }, 9, NULL, "up to 8 can be nested");
    refuse((const int[]){ 9, -1 }, 2, NULL, "wrinkle:depth '9'");
    refuse((const int[]){ 1, -1 }, 2, "blur sigma=2", "is a group and a filter");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(groups_are_made_of_numbers_ranges_and_names),
        cmocka_unit_test(layers_move_into_groups_and_out),
        cmocka_unit_test(nesting_ends_at_eight),
        cmocka_unit_test(a_group_itself_takes_no_paint),
        cmocka_unit_test(a_group_becomes_one_layer_of_the_same_composite),
        cmocka_unit_test(transforms_take_every_layer_of_a_group),
        cmocka_unit_test(masks_and_lines_in_a_group_read_what_is_below_there),
        cmocka_unit_test(an_object_can_use_a_group_as_its_table),
        cmocka_unit_test(documents_bring_groups_back),
        cmocka_unit_test(documents_with_broken_groups_are_refused),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

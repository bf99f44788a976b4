/* Generator layers that name a layer below: edges of it, and copies of its relief; reliefs of pictures. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/memory.h"
#include "base/text.h"
#include "image/font.h"
#include "command/command_line.h"
#include "image/image.h"

#include <fontconfig/fontconfig.h>

static float made_at(const WrSession *s, int i, int j)
{
    const WrDocument *d = doc(s);
    return wr_field_get(d->layers[d->layer_count - 1].heights, i, j);
}

static void check_near(double got, double want, double off)
{
    if (fabs(got - want) > off) fail_msg("%g, not %g", got, want);
}

/* Bevels of width 8 on a rectangle of texels 20..43 x 10..33 rise by the distance from its sides. */
static void check_bevel(const WrSession *s, int left)
{
    check_near((double)made_at(s, left + 2, 22), 2.5 / 8, 0.02);
    check_near((double)made_at(s, left + 11, 13), 3.5 / 8, 0.02);
    check_near((double)made_at(s, left + 12, 22), 1.0, 1e-6);
    assert_true(made_at(s, left - 2, 22) == 0.0f);
}

#define RECT "select rect from=0.3125,0.5 to=0.6875,0.875" /* of 64 x 48 */

static void the_edge_of_a_selection_stays_as_a_layer(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){ "table 64x48", RECT, NULL });
    const float before = f_at(s, 30, 20);
    must_run(s, "layer add edge from=\"rim kind=bevel width=8\"");
    assert_int_equal(doc(s)->layer_count, 3);
    assert_string_equal(doc(s)->layers[1].name, "edge shape");
    assert_null(doc(s)->layers[2].mask);
    assert_int_equal(doc(s)->active, 2);
    must_run(s, "select none");
    const double top = 48 * (1 - 0.875); /* row 6 */
    assert_true(top == 6.0);
    check_near((double)made_at(s, 22, 18), 2.5 / 8, 0.02);
    must_run(s, "layer set edge change=\"height=3 width=4\"");
    check_near((double)made_at(s, 22, 18), 3 * 2.5 / 4, 0.05);
    assert_true(f_at(s, 2, 2) == before); /* the shape itself is not seen */
    /* the shape is painted on: the edge follows, to the ends of a clean strip */
    must_run(s, "layer use \"edge shape\"");
    must_run(s, "select rect from=0,0 to=1,0.5");
    must_run(s, "fill 1");
    check_near((double)made_at(s, 5, 24 + 1), 3 * 1.5 / 4, 0.05);
    must_run(s, "undo");
    must_run(s, "undo");
    must_run(s, "undo");
    must_run(s, "undo");
    must_run(s, "undo");
    must_run(s, "undo");
    assert_int_equal(doc(s)->layer_count, 1); /* one step for both layers */
    wr_session_free(s);
}

static void a_script_of_the_steps_makes_the_same_layers(void **state)
{
    (void)state;
    Said said = { "" };
    WrSession *s = listening(&said), *again = listening(&said);
    must_run(s, "table 64x48");
    must_run(s, RECT);
    must_run(s, "layer add edge from=\"rim kind=round width=5\"");
    must_run(s, "script steps.wrinkle");
    WrError err;
    if (!wr_session_run_script(again, "steps.wrinkle", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(s), wr_session_hash(again)));
    wr_session_free(s);
    wr_session_free(again);
}

static void an_edge_follows_the_outline_of_a_layer(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){
        "table 96x48", "layer add form from=\"solid box size=24,24,8 at=0.333333333,0.541666667\"",
        "layer add edge from=\"rim layer=form width=8\"", NULL });
    /* the box covers texels 20..43 x 10..33 */
    check_bevel(s, 20);
    must_run(s, "layer set form change=\"at=0.541666667,0.541666667\"");
    check_bevel(s, 40);
    must_run(s, "layer set form name=other");
    assert_non_null(strstr(doc(s)->layers[2].line, "layer=other"));
    must_run(s, "layer set other change=\"at=0.333333333,0.541666667\"");
    check_bevel(s, 20);
    must_run(s, "layer set other visible=off"); /* hidden layers count too */
    must_run(s, "layer set other change=\"at=0.541666667,0.541666667\"");
    check_bevel(s, 40);
    must_run(s, "layer delete other");
    check_bevel(s, 40);
    must_fail(s, "layer set edge change=\"width=9\"", "layer=other: no layer below");
    must_run(s, "layer set edge change=\"layer=\\\"\\\"\"");
    assert_true(made_at(s, 52, 22) == 0.0f);
    wr_session_free(s);
}

/* ---- reliefs ---- */

#define W 5
#define H 3

/* Codes of a picture whose samples fall on texels: no two alike; the sides fall to the ground in a texel. */
static const uint8_t codes[H][W] = { { 21, 40, 90, 13, 17 },
                                     { 7, 255, 3, 200, 61 },
                                     { 33, 1, 99, 2, 5 } };

static void write_stone(void)
{
    WrError err;
    if (!wr_image_write_pixels("stone.png", W, H, 1, WR_PIXEL_U8, true, codes, &err))
        fail_msg("%s", err.text);
}

/* The stone's middle is at texel x, y; `by` times its codes. */
static void check_stone(const WrSession *s, int x, int y, double by)
{
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++)
            check_near((double)f_at(s, x + i - W / 2, y + j - H / 2), by * codes[j][i] / 255.0,
                       1e-5);
    assert_true(f_at(s, x - W / 2 - 2, y) == 0.0f && f_at(s, x, y + H / 2 + 2) == 0.0f);
}

static void a_picture_stands_where_it_is_scattered(void **state)
{
    (void)state;
    write_stone();
    WrSession *s = session_of(
        (const char *[]){ "table 61x43",
                          "layer add stones from=\"solid relief stone.png size=5 across=2 rows=3 "
                          "spacing=17,11 height=0.7 depth=2 at=0.5,0.5\"",
                          NULL });
    /* the middle of 61 x 43 is texel 30, 21; two columns are 17 apart: 8.5 to each side is half a texel off */
    must_run(s, "layer set stones change=\"spacing=18,11\"");
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i += 2) check_stone(s, 30 + 9 * i, 21 + 11 * j, 0.7);
    must_run(s, "layer set stones change=\"size=10 across=1 rows=1\""); /* twice the size */
    check_near((double)f_at(s, 30 - 2, 21), 0.7 * 255 / 255.0, 0.1);
    wr_session_free(s);
}

static void copies_vary_in_angle_depth_and_size(void **state)
{
    (void)state;
    write_stone();
    WrSession *s = session_of(
        (const char *[]){ "table 256x192",
                          "layer add stones from=\"solid relief stone.png size=20 across=6 rows=5 "
                          "turn=180 vary=0.4 deep=3 depth=10 seed=5\"",
                          NULL });
    float most[30], sum = 0.0f;
    int different = 0;
    for (int k = 0; k < 30; k++) {
        most[k] = 0.0f;
        for (int j = 0; j < 192 / 5; j++)
            for (int i = 0; i < 256 / 6; i++) {
                const float h = f_at(s, k % 6 * 256 / 6 + i, k / 6 * 192 / 5 + j);
                most[k] = h > most[k] ? h : most[k];
            }
        /* the highest place is depth * scale - deep of 10 texels */
        assert_true(most[k] > 0.6f - 0.3f - 0.15f && most[k] <= 1.4f);
        sum += most[k];
        different += k > 0 && most[k] != most[k - 1];
    }
    assert_int_equal(different, 29);
    check_near((double)sum / 30, 1.0 - 0.15, 0.15);
    must_run(s, "layer set stones change=\"seed=6\"");
    assert_true(f_at(s, 30, 30) != 0.0f || f_at(s, 20, 20) != most[0]);
    wr_session_free(s);
}

/* A layer's content is cut out by its box: a 3 x 2 block of heights 0.5 and one of 2. */
static void a_layer_is_scattered_and_followed(void **state)
{
    (void)state;
    WrSession *s = session_of((const char *[]){
        "table 40x30", "layer add stamp", "select rect from=0.1,0.8 to=0.175,0.866666667",
        "fill 0.5", "select none", "layer set stamp opacity=0",
        "layer add copies from=\"solid relief layer=stamp size=3 height=1 at=0.5125,0.5\"", NULL });
    /* rows are even, so the block's middle is a texel's edge: at v 0.5 of 30, between rows 14 and 15 */
    for (int j = 14; j <= 15; j++)
        for (int i = 19; i <= 21; i++) check_near((double)f_at(s, i, j), 1.0, 1e-5);
    assert_true(f_at(s, 17, 14) == 0.0f && f_at(s, 20, 17) == 0.0f);
    assert_true(f_at(s, 5, 5) == 0.0f);
    must_run(s, "layer use stamp");
    must_run(s, "select rect from=0.1,0.8 to=0.125,0.866666667"); /* its left column */
    must_run(s, "fill 2");
    check_near((double)f_at(s, 19, 14), 1.0, 1e-5);
    check_near((double)f_at(s, 21, 14), 0.25, 1e-5);
    must_fail(s, "layer add more from=\"solid relief layer=nobody\"", "no layer below");
    must_fail(s, "layer add more from=\"solid relief layer=base\"",
              "all of its heights are 0 or less");
    write_stone();
    must_fail(s, "layer add more from=\"solid relief stone.png layer=stamp\"", "not both");
    wr_session_free(s);
}

/* ---- missing files ---- */

static void missing_files_are_noted_once_and_their_heights_stay(void **state)
{
    (void)state;
    Said said = { "" };
    WrError err;
    WrText path = { 0 };
    write_stone();
    WrSession *s = listening(&said);
    must_run(s, "table 61x43");
    must_run(s, "layer add one from=\"solid relief stone.png size=9\"");
    must_run(s, "layer add two from=\"picture photo stone.png\"");
    must_run(s, "layer add three from=\"text A\"");
    assert_null(wr_line_missing_file(doc(s)->layers[1].line, &path));
    if (!wr_session_save(s, "stones.exr", &err)) fail_msg("%s", err.text);
    const WrHash before = wr_session_hash(s);
    assert_int_equal(rename("stone.png", "moved stone.png"), 0);
    said.text[0] = '\0';
    if (!wr_session_open(s, "stones.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    const char *first = strstr(said.text, "stone.png is missing");
    assert_true(first && strstr(said.text, "and 1 more layers"));
    assert_null(strstr(first + 20, "is missing"));
    const char *name = wr_line_missing_file(doc(s)->layers[2].line, &path);
    assert_string_equal(name, "");
    assert_non_null(strstr(wr_text_get(&path), "/stone.png"));
    must_fail(s, "layer set two change=\"height=0.5\"", "stone.png");
    must_run(s, "layer set two change=\"\\\"moved stone.png\\\"\"");
    wr_text_clear(&path);
    assert_null(wr_line_missing_file(doc(s)->layers[2].line, &path));
    wr_text_fini(&path);
    wr_session_free(s);
}

/* Of a font by its name, the file that it has on this machine. */
static void a_font_that_is_not_installed_is_a_missing_file(void **state)
{
    (void)state;
    Said said = { "" };
    WrError err;
    WrText path = { 0 };
    char line[600];
    char *there = wr_font_find(WR_FONT_SERIF, 32, &err);
    assert_non_null(there);
    FcConfig *installed = FcConfigReference(NULL), *nothing = FcConfigCreate();
    WrSession *s = listening(&said);
    must_run(s, "table 61x43");
    must_run(s, "layer add one from=\"text A font=serif size=30\"");
    must_run(s, "layer add two from=\"text B font=serif size=20\"");
    if (!wr_session_save(s, "serif.exr", &err)) fail_msg("%s", err.text);
    const WrHash before = wr_session_hash(s);
    assert_true(FcConfigSetCurrent(nothing));
    said.text[0] = '\0';
    if (!wr_session_open(s, "serif.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(before, wr_session_hash(s)));
    const char *first = strstr(said.text, "DejaVu Serif is missing");
    assert_true(first && strstr(said.text, "change=\"file=PATH\""));
    assert_null(strstr(first + 15, "is missing"));
    must_fail(s, "layer set two change=size=21", "is not installed");
    snprintf(line, sizeof line, "layer set two change=\"file=%s\"", there);
    must_run(s, line);
    assert_null(wr_line_missing_file(doc(s)->layers[2].line, &path));
    assert_string_equal(wr_line_missing_file(doc(s)->layers[1].line, &path), "file");
    assert_true(FcConfigSetCurrent(installed));
    FcConfigDestroy(installed);
    FcConfigDestroy(nothing);
    assert_null(wr_line_missing_file(doc(s)->layers[1].line, &path));
    wr_text_fini(&path);
    wr_free(there);
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_edge_of_a_selection_stays_as_a_layer),
        cmocka_unit_test(a_script_of_the_steps_makes_the_same_layers),
        cmocka_unit_test(an_edge_follows_the_outline_of_a_layer),
        cmocka_unit_test(a_picture_stands_where_it_is_scattered),
        cmocka_unit_test(copies_vary_in_angle_depth_and_size),
        cmocka_unit_test(a_layer_is_scattered_and_followed),
        cmocka_unit_test(missing_files_are_noted_once_and_their_heights_stay),
        cmocka_unit_test(a_font_that_is_not_installed_is_a_missing_file),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

/* Text labels: position of pixels, widths, truncation, invalid characters. */
#include "test.h"

#include "base/error.h"
#include "image/caption.h"

enum { W = 120, H = 40 };

typedef struct Ink {
    int left, right, top, bottom, pixels;
} Ink;

static Ink draw(WrLabel *label, const char *text, int x, int y, int room, uint8_t *pixels)
{
    Ink ink = { W, -1, H, -1, 0 };
    memset(pixels, 0, (size_t)W * H);
    wr_label_draw(label, text, x, y, room, 255, pixels, W, H);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            if (pixels[j * W + i] == 0) continue;
            ink.left = i < ink.left ? i : ink.left;
            ink.right = i > ink.right ? i : ink.right;
            ink.top = j < ink.top ? j : ink.top;
            ink.bottom = j;
            ink.pixels++;
        }
    return ink;
}

static void letters_stand_on_the_baseline_within_their_width(void **state)
{
    (void)state;
    WrError err = { "" };
    WrLabel *label = wr_label_new(16, &err);
    if (!label) fail_msg("%s", err.text);
    uint8_t pixels[W * H];
    Ink ink = draw(label, "Hill", 10, 25, W, pixels);
    assert_true(ink.pixels > 30);
    assert_in_range(ink.left, 9, 13);
    assert_in_range(ink.right, 20, 10 + wr_label_width(label, "Hill"));
    assert_in_range(ink.bottom, 23, 25);
    assert_in_range(ink.top, 25 - 16, 25 - 8);
    wr_label_free(label);
}

static void widths_add_up(void **state)
{
    (void)state;
    WrError err;
    WrLabel *label = wr_label_new(14, &err);
    assert_non_null(label);
    assert_int_equal(wr_label_width(label, ""), 0);
    assert_int_equal(wr_label_width(label, "groove"),
                     wr_label_width(label, "gro") + wr_label_width(label, "ove"));
    assert_true(wr_label_width(label, "W") > wr_label_width(label, "i"));
    /* Two bytes of one letter, and two bytes of none. */
    assert_int_equal(wr_label_width(label, "\xc3\xbc"), wr_label_width(label, "u"));
    assert_int_equal(wr_label_width(label, "\xff\x80"), 2 * wr_label_width(label, "?"));
    assert_int_equal(wr_label_width(label, "\xe2\x82"), 2 * wr_label_width(label, "?"));
    wr_label_free(label);
}

static void text_that_is_too_wide_is_cut_with_dots(void **state)
{
    (void)state;
    WrError err;
    WrLabel *label = wr_label_new(12, &err);
    assert_non_null(label);
    uint8_t pixels[W * H];
    Ink whole = draw(label, "a long brush name", 0, 20, W, pixels);
    Ink cut = draw(label, "a long brush name", 0, 20, 50, pixels);
    assert_true(whole.right > 60);
    assert_true(cut.right < 50 && cut.right > 30);
    wr_label_free(label);
}

static void ink_never_leaves_the_picture(void **state)
{
    (void)state;
    WrError err;
    WrLabel *label = wr_label_new(40, &err);
    assert_non_null(label);
    static uint8_t guarded[3 * W * H];
    static const int places[][2] = { { -9, 5 }, { W - 9, H - 1 }, { 20, -500 }, { -9000, 20 } };
    for (int k = 0; k < 4; k++) {
        memset(guarded, 7, sizeof guarded);
        wr_label_draw(label, "@gjW", places[k][0], places[k][1], 1000, 255, guarded + W * H, W, H);
        for (int i = 0; i < W * H; i++) {
            assert_int_equal(guarded[i], 7);
            assert_int_equal(guarded[2 * W * H + i], 7);
        }
    }
    wr_label_free(label);
}

static void sizes_out_of_range_are_refused(void **state)
{
    (void)state;
    WrError err = { "" };
    assert_null(wr_label_new(3, &err));
    assert_non_null(strstr(err.text, "3"));
    assert_null(wr_label_new(201, &err));
    wr_label_free(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(letters_stand_on_the_baseline_within_their_width),
        cmocka_unit_test(widths_add_up),
        cmocka_unit_test(text_that_is_too_wide_is_cut_with_dots),
        cmocka_unit_test(ink_never_leaves_the_picture),
        cmocka_unit_test(sizes_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

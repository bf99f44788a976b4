/* Font samples: as much coverage as the letters' dots, wherever the font comes from; none for a damaged one. */
#include "test.h"

#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/pool.h"
#include "base/progress.h"
#include "image/font.h"
#include "ui/panels/generate/font_choice.h"

#define SIZE 62 /* size for the text generator: 0.62 of the height */
#define HIGH 100

/* Dots of A, 13 of them, and of B, 9, in cells of five. */
static const char bdf[] =
    "STARTFONT 2.1\nFONT -made-here-medium-r-normal--5-50-75-75-c-40-iso10646-1\nSIZE 5 75 75\n"
    "FONTBOUNDINGBOX 4 5 0 -1\nSTARTPROPERTIES 2\nFONT_ASCENT 4\nFONT_DESCENT 1\nENDPROPERTIES\n"
    "CHARS 2\nSTARTCHAR A\nENCODING 65\nSWIDTH 800 0\nDWIDTH 5 0\nBBX 4 4 0 0\nBITMAP\n60\n90\nF0\n"
    "F0\nENDCHAR\nSTARTCHAR B\nENCODING 66\nSWIDTH 600 0\nDWIDTH 4 0\nBBX 3 5 0 -1\nBITMAP\nC0\n"
    "A0\nC0\nA0\nC0\nENDCHAR\nENDFONT\n";
#define DOTS (2 + 2 + 4 + 4 + 2 + 2 + 2 + 2 + 2)

static double ink(const uint32_t *argb, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        assert_int_equal(argb[i] & 0xffffffu, 0xffffffu);
        sum += (argb[i] >> 24) / 255.0;
    }
    return sum;
}

static bool sampled(const char *path, int w, int h, uint32_t *argb)
{
    WrPool *pool = wr_pool_new(1);
    const WrProgress progress = { 0 };
    char sample[] = "AB", file[200];
    snprintf(file, sizeof file, "%s", path);
    const WrFontEntry entry = { .path = file, .sample = sample };
    const WrFontSample of = { NULL, &entry, w, h };
    const bool good = wr_font_sample(&of, pool, &progress, argb);
    wr_pool_free(pool);
    return good;
}

static void a_sample_has_the_ink_of_its_letters(void **state)
{
    (void)state;
    WrError err;
    static uint32_t argb[HIGH * 237];
    assert_true(wr_file_write("dots odd.bdf", bdf, sizeof bdf - 1, &err));
    assert_true(sampled("dots odd.bdf", 237, HIGH, argb));
    const double dot = SIZE / 5.0;
    assert_in_range((long)ink(argb, HIGH * 237), (long)(DOTS * dot * dot * 0.99),
                    (long)(DOTS * dot * dot * 1.01));
    /* Longer text is clipped and does not wrap around. */
    assert_true(sampled("dots odd.bdf", 31, HIGH, argb));
    for (int y = 0; y < HIGH; y++) assert_int_equal(argb[y * 31] >> 24, 0);
}

static void a_damaged_font_has_no_sample(void **state)
{
    (void)state;
    WrError err;
    static uint32_t argb[40 * 20];
    static const char torn[] = "\0\1\0\0\0\x13\1\0\0\4\0\x30OS/2garbage";
    assert_true(wr_file_write("torn.ttf", torn, sizeof torn - 1, &err));
    assert_false(sampled("torn.ttf", 40, 20, argb));
    assert_false(sampled("absent.ttf", 40, 20, argb));
    assert_true(wr_file_write("half.bdf", bdf, 180, &err));
    assert_false(sampled("half.bdf", 40, 20, argb));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sample_has_the_ink_of_its_letters),
        cmocka_unit_test(a_damaged_font_has_no_sample),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}

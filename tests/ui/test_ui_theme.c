/* Themes of the window: contrast of text and background in each of them, by the contrast ratio of WCAG 2.1 (relative
   luminance of sRGB; 1.4.3: 4.5 for text, 1.4.11: 3 for icons). */
#include "test.h"

#include "accuracy/metrics.h"
#include "render/frame/frame.h"
#include "render/plan/effect_heatmap.h"
#include "ui/toolkit/theme.h"

#include <math.h>

static double linear(unsigned code)
{
    const double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static double luminance(WrColour c)
{
    return 0.2126 * linear(c >> 16 & 255) + 0.7152 * linear(c >> 8 & 255) +
           0.0722 * linear(c & 255);
}

static double contrast(WrThemeColour a, WrThemeColour b)
{
    const double x = luminance(wr_theme_colour(a)), y = luminance(wr_theme_colour(b));
    return (fmax(x, y) + 0.05) / (fmin(x, y) + 0.05);
}

static void words_can_be_read_in_every_theme(void **state)
{
    (void)state;
    static const WrThemeColour grounds[] = { WR_THEMED_BAR,   WR_THEMED_PANEL, WR_THEMED_FIELD,
                                             WR_THEMED_POPUP, WR_THEMED_LIST,  WR_THEMED_CHIP };
    static const struct {
        WrThemeColour ink;
        double least;
    } inks[] = { { WR_THEMED_TEXT, 7 },    { WR_THEMED_STRONG, 7 }, { WR_THEMED_LABEL, 4.5 },
                 { WR_THEMED_MUTED, 3.9 }, { WR_THEMED_LINK, 4.5 }, { WR_THEMED_BAD, 3.9 },
                 { WR_THEMED_CELL, 3.9 },  { WR_THEMED_WARN, 4.5 }, { WR_THEMED_GOOD, 3.9 },
                 { WR_THEMED_FAINT, 2.5 }, { WR_THEMED_ACCENT, 3 }, { WR_THEMED_FOCUS, 3 } };
    static const WrThemeColour beneath[] = { WR_THEMED_SELECTED,   WR_THEMED_FILL,
                                             WR_THEMED_FILL_HOT,   WR_THEMED_ROW_SELECTED,
                                             WR_THEMED_ROW_CHOSEN, WR_THEMED_BUTTON,
                                             WR_THEMED_BUTTON_HOT, WR_THEMED_REFUSED };
    for (int theme = 0; theme < WR_THEME_KINDS; theme++) {
        wr_theme_set((WrThemeKind)theme);
        for (size_t i = 0; i < sizeof inks / sizeof *inks; i++)
            for (size_t g = 0; g < sizeof grounds / sizeof *grounds; g++)
                if (contrast(inks[i].ink, grounds[g]) < inks[i].least)
                    fail_msg("theme %d: ink %d on %d: %.2f, less than %g", theme, (int)inks[i].ink,
                             (int)grounds[g], contrast(inks[i].ink, grounds[g]), inks[i].least);
        for (size_t g = 0; g < sizeof beneath / sizeof *beneath; g++)
            if (contrast(WR_THEMED_STRONG, beneath[g]) < 4.5)
                fail_msg("theme %d: on %d: %.2f", theme, (int)beneath[g],
                         contrast(WR_THEMED_STRONG, beneath[g]));
    }
    wr_theme_set(WR_THEME_DARK);
}

/* The surroundings are neutral, for correct perception of greys. */
static void the_surround_is_neutral(void **state)
{
    (void)state;
    for (int theme = 0; theme < WR_THEME_KINDS; theme++) {
        wr_theme_set((WrThemeKind)theme);
        const WrColour c = WR_COLOUR_SURROUND;
        assert_int_equal(c >> 16 & 255, c & 255);
        assert_int_equal(c >> 8 & 255, c & 255);
    }
    wr_theme_set(WR_THEME_DARK);
}

/* ---- those who see red and green alike ---- */

typedef double Lab[3];

/* Machado, Oliveira and Fernandes 2009, severity 1, on linear RGB: without red cones, without green cones; and normal
   vision. */
static const double seen[3][3][3] = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
                                      { { 0.152286, 1.052583, -0.204868 },
                                        { 0.114503, 0.786281, 0.099216 },
                                        { -0.003882, -0.048116, 1.051998 } },
                                      { { 0.367322, 0.860646, -0.227968 },
                                        { 0.280085, 0.672501, 0.047413 },
                                        { -0.011820, 0.042940, 0.968881 } } };

static double bent(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : t * (24389.0 / 27.0) / 116.0 + 16.0 / 116.0;
}

/* CIE 1976 L*a*b* for D65. */
static void lab_of(WrColour c, int eyes, Lab out)
{
    const double own[3] = { linear(c >> 16 & 255), linear(c >> 8 & 255), linear(c & 255) };
    double v[3];
    for (int k = 0; k < 3; k++) {
        const double *m = seen[eyes][k];
        v[k] = fmin(fmax(m[0] * own[0] + m[1] * own[1] + m[2] * own[2], 0.0), 1.0);
    }
    const double x = bent((0.4124564 * v[0] + 0.3575761 * v[1] + 0.1804375 * v[2]) / 0.95047);
    const double y = bent(0.2126729 * v[0] + 0.7151522 * v[1] + 0.0721750 * v[2]);
    const double z = bent((0.0193339 * v[0] + 0.1191920 * v[1] + 0.9503041 * v[2]) / 1.08883);
    out[0] = 116.0 * y - 16.0;
    out[1] = 500.0 * (x - y);
    out[2] = 200.0 * (y - z);
}

/* Pairwise distance for each kind of vision. 2.3 is just distinguishable side by side; apart several times that is
   needed. */
static void assert_apart(const char *what, const WrColour *colours, int count, double least)
{
    for (int eyes = 0; eyes < 3; eyes++)
        for (int i = 0; i < count; i++)
            for (int k = 0; k < i; k++) {
                Lab a, b;
                lab_of(colours[i], eyes, a);
                lab_of(colours[k], eyes, b);
                const double d =
                    sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                         (a[2] - b[2]) * (a[2] - b[2]));
                if (d < least)
                    fail_msg("%s: %06x and %06x by eyes %d: %.1f, less than %g", what,
                             (unsigned)(colours[i] & 0xffffffu), (unsigned)(colours[k] & 0xffffffu),
                             eyes, d, least);
            }
}

static void states_are_told_apart_without_red_and_green(void **state)
{
    (void)state;
    for (int theme = 0; theme < WR_THEME_KINDS; theme++) {
        wr_theme_set((WrThemeKind)theme);
        const WrColour modes[] = { WR_COLOUR_RAISE, WR_COLOUR_LOWER, WR_COLOUR_LEVEL };
        const WrColour seam[] = { WR_COLOUR_LEVEL, WR_COLOUR_WARN, WR_COLOUR_RAISE };
        const WrColour verdicts[] = { WR_COLOUR_GOOD, WR_COLOUR_WARN, WR_COLOUR_BAD };
        const WrColour words[] = { WR_COLOUR_TEXT, WR_COLOUR_WARN, WR_COLOUR_BAD };
        const WrColour quiet[] = { WR_COLOUR_LABEL, WR_COLOUR_RAISE };
        const WrColour rows[] = { WR_COLOUR_SELECTED, WR_COLOUR_REFUSED };
        assert_apart("modes of the brush", modes, 3, 12);
        assert_apart("edges of the cell", seam, 3, 12);
        assert_apart("verdicts", verdicts, 3, 12);
        assert_apart("words", words, 3, 12);
        assert_apart("journal", quiet, 2, 12);
        assert_apart("what can be done", rows, 2, 12);
    }
    wr_theme_set(WR_THEME_DARK);
    assert_apart("series", wr_series, WR_SERIES, 15);
}

static WrColour packed(const uint8_t rgb[3])
{
    return 0xff000000u | (WrColour)rgb[0] << 16 | (WrColour)rgb[1] << 8 | rgb[2];
}

/* A scale is read by lightness: it must increase visibly over its whole length for each kind of vision. */
static void scales_rise_for_all_eyes(void **state)
{
    (void)state;
    enum { STEPS = 12 };
    for (int eyes = 0; eyes < 3; eyes++) {
        double before = -100;
        for (int i = 0; i <= STEPS; i++) {
            uint8_t rgb[3];
            Lab lab;
            wr_heat_colour((double)i / STEPS, rgb);
            lab_of(packed(rgb), eyes, lab);
            assert_true(lab[0] > before + 2.3);
            before = lab[0];
        }
    }
}

/* Colours of the effect heatmap, for equal numbers of samples. */
static void what_ran_is_told_apart_by_all_eyes(void **state)
{
    (void)state;
    WrHeatmapCounts counts = { { 0 } };
    uint8_t rgb[256][3];
    WrColour kinds[16];
    int count = 0;
    wr_heatmap_colours(&counts, rgb);
    for (int b = 0; b < WR_MAP_SAMPLES; b++) {
        bool known = false;
        for (int i = 0; i < count; i++) known = known || kinds[i] == packed(rgb[b]);
        if (!known) kinds[count++] = packed(rgb[b]);
    }
    assert_int_equal(count, 7);
    assert_apart("what ran", kinds, count, 15);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(words_can_be_read_in_every_theme),
                                        cmocka_unit_test(the_surround_is_neutral),
                                        cmocka_unit_test(
                                            states_are_told_apart_without_red_and_green),
                                        cmocka_unit_test(scales_rise_for_all_eyes),
                                        cmocka_unit_test(what_ran_is_told_apart_by_all_eyes) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

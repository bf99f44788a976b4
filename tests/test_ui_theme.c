/* The window's themes: what is read stands out from what it is written on, in each of them, by the contrast ratio of
   WCAG 2.1 (relative luminance of sRGB; 1.4.3: 4.5 for words, 1.4.11: 3 for signs). */
#include "test.h"

#include "ui/gui/theme.h"

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
    } inks[] = { { WR_THEMED_TEXT, 7 },    { WR_THEMED_STRONG, 7 },  { WR_THEMED_LABEL, 4.5 },
                 { WR_THEMED_MUTED, 3.9 }, { WR_THEMED_LINK, 4.5 },  { WR_THEMED_BAD, 3.9 },
                 { WR_THEMED_CELL, 3.9 },  { WR_THEMED_FAINT, 2.5 }, { WR_THEMED_ACCENT, 3 } };
    static const WrThemeColour beneath[] = { WR_THEMED_SELECTED, WR_THEMED_FILL,
                                             WR_THEMED_FILL_HOT, WR_THEMED_ROW_SELECTED,
                                             WR_THEMED_BUTTON,   WR_THEMED_BUTTON_HOT,
                                             WR_THEMED_REFUSED };
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

/* Greys are judged against what surrounds them: it has no colour of its own. */
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

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(words_can_be_read_in_every_theme),
                                        cmocka_unit_test(the_surround_is_neutral) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

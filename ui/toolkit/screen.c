#include "ui/toolkit/screen.h"

#include "base/enum_rows.h"

#include <string.h>

/* True if SDL's driver can show a window surface without acceleration. Wayland's cannot, and a window that requires
 * it is never shown. */
static bool has_direct(const char *driver)
{
    return driver && (strcmp(driver, "x11") == 0 || strcmp(driver, "dummy") == 0 ||
                      strcmp(driver, "offscreen") == 0);
}

int wr_screen_ways(const char *driver, bool gpu, const char *wanted,
                   WrScreenWay ways[WR_SCREEN_WAYS])
{
    bool card = wanted ? strcmp(wanted, "opengl") == 0 : gpu;
    int count = 0;
    if (card) ways[count++] = WR_SCREEN_OPENGL;
    if (has_direct(driver)) ways[count++] = WR_SCREEN_DIRECT;
    ways[count++] = WR_SCREEN_SURFACE;
    ways[count++] = WR_SCREEN_ANY;
    return count;
}

const char *wr_screen_words(WrScreenWay way)
{
    WR_ROWS(words);
    static const char *const words[WR_SCREEN_WAYS] = {
        [WR_ROW(WR_SCREEN_OPENGL)] = "by OpenGL",
        [WR_ROW(WR_SCREEN_DIRECT)] = "by software",
        [WR_ROW(WR_SCREEN_SURFACE)] = "by software on a surface of SDL's choice",
        [WR_ROW(WR_SCREEN_ANY)] = "in whatever way SDL finds"
    };
    WR_ROWS_END(words, WR_SCREEN_WAYS);
    return words[way];
}

#include "ui/toolkit/video_driver.h"
#include "ui/toolkit/desktop_scale.h"

#include "base/enum_rows.h"
#include "base/text.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static bool said(const char *text)
{
    return text && text[0];
}

static bool is_wayland(const WrDisplayEnv *env)
{
    return said(env->wayland) || (env->session && strcmp(env->session, "wayland") == 0);
}

WrDisplayEnv wr_display_env(void)
{
    return (WrDisplayEnv){ getenv("SDL_VIDEODRIVER"), getenv("DISPLAY"), getenv("WAYLAND_DISPLAY"),
                           getenv("XDG_SESSION_TYPE") };
}

/* A list of SDL drivers in the order in which they are tried; NULL leaves the choice to SDL. On Wayland, XWayland comes
   first, since pictures on the clipboard are read from X11. An explicit SDL_VIDEODRIVER always wins. */
const char *wr_display_driver(const WrDisplayEnv *env)
{
    if (said(env->driver) || !is_wayland(env)) return NULL;
    return said(env->x11) ? "x11,wayland" : "wayland,x11";
}

bool wr_display_none(const WrDisplayEnv *env)
{
    return !said(env->driver) && !said(env->x11) && !said(env->wayland);
}

bool wr_display_no_output(const char *asked, const char *opened)
{
    static const char *const unseen[] = { "dummy", "offscreen", "evdev" };
    if (!opened || (asked && strstr(asked, opened))) return false;
    for (size_t i = 0; i < sizeof unseen / sizeof *unseen; i++)
        if (strcmp(opened, unseen[i]) == 0) return true;
    return false;
}

const char *wr_display_driver_message(const WrDisplayEnv *env, const char *opened)
{
    if (!is_wayland(env) || !opened || strcmp(opened, "x11") != 0 || said(env->driver)) return NULL;
    return "The session is Wayland: the window runs on XWayland, which passes on all pen values. "
           "SDL_VIDEODRIVER=wayland opens it on Wayland itself.";
}

/* ---- presentation on the screen ---- */

/* True if SDL's driver can show a window surface without acceleration. Wayland's cannot, and a window that requires
 * it is never shown. */
static bool has_direct(const char *driver)
{
    return driver && (strcmp(driver, "x11") == 0 || strcmp(driver, "dummy") == 0 ||
                      strcmp(driver, "offscreen") == 0);
}

/* The ways in the order in which they are tried; the last one always exists. A graphics card comes first
   only by request or where `gpu` holds. */
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

/* ---- parsers for the desktop's scale ---- */

#define LEAST_DPI 48.0
#define MAX_DPI 768.0
#define SETTING "Xft/DPI"
#define RESOURCE "Xft.dpi:"

/* 96 dpi is scale 1, so the bounds are scales of 0.5 and 8; values outside are faults of the desktop and count as absent (0). */
static double meant(double dpi)
{
    return dpi >= LEAST_DPI && dpi <= MAX_DPI ? dpi : 0;
}

/* ---- XSETTINGS: byte order, 3 bytes, serial, count; each setting: type, a byte, length of the name, the name up to
   a multiple of 4, serial, value (https://specifications.freedesktop.org/xsettings-spec/) ---- */

/* A bounded reader: after the first read beyond the end `good` is false for ever, and all further reads return 0 without
   moving. The bytes come from another process and are not trusted. */
typedef struct Reading {
    const unsigned char *at;
    size_t left;
    bool high_first, good;
} Reading;

static const unsigned char *take(Reading *r, size_t count)
{
    const unsigned char *at = r->at;
    r->good = r->good && count <= r->left;
    if (!r->good) return NULL;
    r->at += count;
    r->left -= count;
    return at;
}

static uint32_t number(Reading *r, size_t size)
{
    const unsigned char *at = take(r, size);
    uint32_t value = 0;
    for (size_t i = 0; at && i < size; i++)
        value |= (uint32_t)at[i] << 8 * (r->high_first ? size - 1 - i : i);
    return value;
}

static size_t padded(size_t count)
{
    return (count + 3) / 4 * 4;
}

enum { WHOLE, STRING, COLOUR };

/* The value of a setting; only integers are returned. */
static uint32_t value_of(Reading *r, unsigned type)
{
    if (type == WHOLE) return number(r, 4);
    if (type == STRING) take(r, padded(number(r, 4)));
    else if (type == COLOUR) take(r, 8);
    else r->good = false;
    return 0;
}

/*     byte 0      byte order: 0 low byte first, 1 high byte first     bytes 1 - 3  unused
       bytes 4 - 7 serial                                              bytes 8 - 11 number of settings
       setting:    type (1), unused (1), length of the name (2), name, padded to 4 bytes, serial (4), value
       value:      integer 4 bytes; string: length (4), text padded to 4 bytes; colour: 4 x 2 bytes
   Xft/DPI is an integer in 1024ths of dots per inch. A length near 2^32 wraps in none of the sums here: size_t has 64 bits,
   and `take` compares with the bytes that are left. */
double wr_desktop_dpi_of_settings(const unsigned char *bytes, size_t count)
{
    Reading r = { bytes, count, .good = true };
    const unsigned char *head = take(&r, 4);
    r.high_first = head && head[0] == 1;
    number(&r, 4);
    const uint32_t settings = number(&r, 4);
    for (uint32_t i = 0; i < settings && r.good; i++) {
        const uint32_t type = number(&r, 1);
        take(&r, 1);
        const uint32_t length = number(&r, 2);
        const unsigned char *name = take(&r, padded(length));
        number(&r, 4);
        const uint32_t value = value_of(&r, type);
        if (!r.good || type != WHOLE || length != strlen(SETTING)) continue;
        if (memcmp(name, SETTING, length) == 0) return meant(value / 1024.0);
    }
    return 0;
}

/* ---- resources ---- */

double wr_desktop_dpi_of_resources(const char *text)
{
    for (const char *line = text; line && *line; line = strchr(line, '\n')) {
        line += *line == '\n';
        if (strncmp(line, RESOURCE, strlen(RESOURCE)) != 0) continue;
        const char *at = line + strlen(RESOURCE);
        at += strspn(at, " \t");
        double dpi;
        return wr_number_parse(at, strcspn(at, " \t\r\n"), &dpi) ? meant(dpi) : 0;
    }
    return 0;
}

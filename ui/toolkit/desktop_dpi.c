/* Parsers for the desktop's scale. */
#include "ui/toolkit/desktop.h"

#include "base/text.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define LEAST_DPI 48.0
#define MOST_DPI 768.0
#define SETTING "Xft/DPI"
#define RESOURCE "Xft.dpi:"

static double meant(double dpi)
{
    return dpi >= LEAST_DPI && dpi <= MOST_DPI ? dpi : 0;
}

/* ---- XSETTINGS: byte order, 3 bytes, serial, count; each setting: type, a byte, length of the name, the name up to
   a multiple of 4, serial, value (https://specifications.freedesktop.org/xsettings-spec/) ---- */

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

/* Text conversions for the portal. */
#include "ui/app/jobs/portal.h"

#include <string.h>

static int digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    const int low = c | 32;
    return low >= 'a' && low <= 'f' ? low - 'a' + 10 : -1;
}

bool wr_portal_path(const char *uri, char *path, size_t size)
{
    static const char scheme[] = "file://", here[] = "localhost";
    size_t length = 0;
    if (size == 0 || strncmp(uri, scheme, sizeof scheme - 1) != 0) return false;
    const char *at = uri + sizeof scheme - 1;
    if (strncmp(at, here, sizeof here - 1) == 0) at += sizeof here - 1;
    if (*at != '/') return false;
    for (; *at; at++) {
        char c = *at;
        if (c == '%') {
            const int high = digit(at[1]), low = high < 0 ? -1 : digit(at[2]);
            if (low < 0) return false;
            c = (char)(high * 16 + low);
            at += 2;
        } else if (c == '?' || c == '#') {
            return false;
        }
        if (c == '\0' || length + 1 >= size) return false;
        path[length++] = c;
    }
    path[length] = '\0';
    return length > 1;
}

void wr_portal_pattern(const char *ending, char *pattern, size_t size)
{
    size_t length = 0;
    const char start[] = "*.";
    for (const char *c = start; *c && length + 1 < size; c++) pattern[length++] = *c;
    for (const char *c = ending; *c && length + 5 < size; c++) {
        const bool letter = *c >= 'a' && *c <= 'z';
        if (letter) pattern[length++] = '[';
        pattern[length++] = *c;
        if (letter) pattern[length++] = (char)(*c - 32);
        if (letter) pattern[length++] = ']';
    }
    pattern[length] = '\0';
}

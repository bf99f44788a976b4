#include "base/error.h"

#include <stdarg.h>
#include <string.h>

/* Removes an incomplete UTF-8 sequence from the end: vsnprintf may have cut inside it. */
static void trim_utf8(char *text, size_t capacity)
{
    size_t length = strlen(text);
    if (length + 1 < capacity) return;
    size_t start = length;
    while (start > 0 && ((unsigned char)text[start - 1] & 0xC0) == 0x80) start--;
    if (start == 0) return;
    unsigned char lead = (unsigned char)text[start - 1];
    size_t need = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
    if (length - (start - 1) < need) text[start - 1] = '\0';
}

bool wr_fail(WrError *err, const char *format, ...)
{
    if (!err) return false;
    va_list args;
    va_start(args, format);
    vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
    trim_utf8(err->text, sizeof err->text);
    return false;
}

void wr_error_prefix(WrError *err, const char *format, ...)
{
    if (!err) return;
    char old[sizeof err->text];
    memcpy(old, err->text, sizeof old);
    va_list args;
    va_start(args, format);
    int n = vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
    if (n < 0) n = 0;
    if ((size_t)n < sizeof err->text)
        snprintf(err->text + n, sizeof err->text - (size_t)n, "%s", old);
    trim_utf8(err->text, sizeof err->text);
}

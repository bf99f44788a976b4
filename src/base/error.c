#include "base/error.h"

#include "base/message.h"

#include <stdarg.h>
#include <string.h>

_Static_assert(sizeof(WrError) == WR_ERROR_TEXT + WR_ERROR_MESSAGE,
               "a WrError holds text and message");

/* The message follows the NUL of the text, so that a copy of WrError has both and `text` stays a plain string. */
static void store(WrError *err, const char *text, const char *message)
{
    const size_t length = strlen(text);
    memcpy(err->text, text, length + 1);
    memcpy(err->text + length + 1, message, strlen(message) + 1);
}

bool wr_fail(WrError *err, const char *format, ...)
{
    if (!err) return false;
    char text[WR_ERROR_TEXT], message[WR_ERROR_MESSAGE];
    va_list args;
    va_start(args, format);
    wr_message_format(text, sizeof text, message, sizeof message, format, args);
    va_end(args);
    store(err, text, message);
    return false;
}

void wr_error_prefix(WrError *err, const char *format, ...)
{
    if (!err) return;
    char text[WR_ERROR_TEXT], message[WR_ERROR_MESSAGE];
    const char *old = wr_error_message(err);
    va_list args;
    va_start(args, format);
    wr_message_format(text, sizeof text, message, sizeof message, format, args);
    va_end(args);
    char joined[WR_ERROR_TEXT + 2 * WR_ERROR_MESSAGE];
    snprintf(joined, sizeof joined, "%s%s", message[0] ? message : text, old);
    wr_message_print(joined, NULL, text, sizeof text);
    store(err, text, message[0] && strlen(joined) < sizeof message ? joined : "");
}

const char *wr_error_message(const WrError *err)
{
    const size_t length = strlen(err->text), rest = sizeof err->text - 1 - length;
    const char *message = err->text + length + 1;
    char text[WR_ERROR_TEXT];
    /* A text that other code wrote or changed has no message, or that of an older text. */
    if (rest == 0 || !message[0] || !memchr(message, '\0', rest)) return err->text;
    return strcmp(wr_message_print(message, NULL, text, sizeof text), err->text) == 0 ? message
                                                                                      : err->text;
}

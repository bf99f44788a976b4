/* message.h - texts that keep their format and values, so that they can be translated.
 *
 * A message is plain text in which each formatted part is written as \2 FORMAT \37 VALUE \37 VALUE ... \3. A value is
 * the text of one conversion and may itself contain messages. The format is the key of a translation, as in gettext.
 * A message can be copied, stored and sent like any string. Cut anywhere, it is still readable. All functions are
 * thread-safe and none allocates, except wr_message_addf. */
#pragma once
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

struct WrText;

/* WR_MESSAGE: a constant text as a message without values, such as a value of another message. */
#define WR_MESSAGE_MARKS "\2\3\37"
#define WR_MESSAGE(text) "\2" text "\3"

/* Formats a message. plain: the same text as by vsnprintf, except that messages in %s are written as plain text, and that
   other marks are left out. A message needs a %s without width and precision.
   out: the message; "" if it does not fit, or if the format has a conversion other than %d %i %u %x %X %o %c %s %p and
   those of double, with any flags and length. Either may be NULL if its size is 0. Cut at a whole UTF-8 character. */
void wr_message_format(char *plain, size_t plain_size, char *out, size_t out_size,
                       const char *format, va_list args);
/* Appends a message to a text. */
void wr_message_addf(struct WrText *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Translations of a message's parts. */
typedef struct WrMessageWords {
    const char *(*format)(const char *english); /* itself if it has no translation */
    const char *(*value)(const char *english);  /* likewise; asked for values without messages */
} WrMessageWords;

/* Writes a message as text: English if `words` is NULL. A translated format may number its conversions (%2$s) or omit
   a value (%.0s). Cut at a whole UTF-8 character; size is 1 or more. Returns out. */
const char *wr_message_print(const char *message, const WrMessageWords *words, char *out,
                             size_t size);

#ifdef __cplusplus
}
#endif

/* message.h - translatable messages: texts that keep their format and values.
 *
 * A message is plain text in which each formatted part is written as \2 FORMAT \37 VALUE \37 VALUE ... \3. A value is
 * the text of one conversion and may itself contain messages. The format is the key of a translation, as in gettext.
 * A message can be copied, stored and sent like any string. Cut anywhere, it is still readable. All functions are
 * thread-safe. Only wr_message_addf allocates. */
#pragma once
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

struct WrText;

/* The control characters of messages. */
#define WR_MESSAGE_MARKS "\2\3\37"
/* A string literal as a message without values, for example as a value of another message. */
#define WR_MESSAGE(text) "\2" text "\3"

/* Formats a message, as plain text and with marks.
 *
 *   plain    the text that vsnprintf writes, except that a message in %s is written as its text and other marks are
 *            left out; cut at a whole UTF-8 character if it is too long
 *   out      the message; "" if it is too long, if a value has unpaired marks, or if the format has another conversion
 *            than %d %i %u %x %X %o %c %s %p and those of double, or the length h or L
 *
 * Sizes are in bytes, with the NUL. plain or out may be NULL if its size is 0. A %s without width and precision nests a
 * message; any other %s keeps only its text. */
void wr_message_format(char *plain, size_t plain_size, char *out, size_t out_size,
                       const char *format, va_list args);
/* Appends a message of up to 4095 bytes to a text. A longer one is appended as plain text, cut at 4095 bytes. */
void wr_message_addf(struct WrText *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Lookup of translations. Both functions return their argument if it has no translation. */
typedef struct WrMessageWords {
    const char *(*format)(const char *english); /* of a message */
    const char *(*value)(const char *english);  /* a value that contains no message */
} WrMessageWords;

/* Writes a message as plain text, translated by `words`; NULL: English. A translated format may number its conversions
   (%2$s) or omit a value (%.0s). Cut at a whole UTF-8 character; size is 1 or more. Returns out. */
const char *wr_message_print(const char *message, const WrMessageWords *words, char *out,
                             size_t size);

#ifdef __cplusplus
}
#endif

/* error.h - error messages of functions that can fail, and assertions. */
#pragma once
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One English sentence: the failure, the value, the remedy. Owned by the caller; untouched on success. Behind the
   sentence's NUL stands its message, the format and the values (base/message.h): read it by wr_error_message. */
#define WR_ERROR_TEXT 512     /* bytes of the sentence, with its NUL */
#define WR_ERROR_MESSAGE 1024 /* bytes of the message, with its NUL */
typedef struct WrError {
    char text[WR_ERROR_TEXT + WR_ERROR_MESSAGE];
} WrError;

/* Writes the message and returns false, so that a check is one line:
 *
 *    if (width < 1) return wr_fail(err, "width %d: must be 1..16384", width);
 *
 * err may be NULL. A message that is too long is cut at a whole UTF-8 character. */
bool wr_fail(WrError *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The format and the values, for translation (wr_message_print); the text if there are none, because the message was
   too long or the text was written by other means. Valid as long as err is unchanged. As a value of %s of another error
   it is nested: wr_fail(err, "%s: %s", path, wr_error_message(&inner)). */
const char *wr_error_message(const WrError *err);

/* Inserts "prefix" before an existing message (file, line, command). */
void wr_error_prefix(WrError *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

#ifdef __cplusplus
}
#endif

/* Reports a bug of the program, never a user's mistake. Active in debug and test builds. */
#ifdef NDEBUG
#define WR_ASSERT(condition) ((void)0)
#else
#define WR_ASSERT(condition)                                                                       \
    ((condition)                                                                                   \
         ? (void)0                                                                                 \
         : (fprintf(stderr, "%s:%d: assertion failed: %s\n", __FILE__, __LINE__, #condition),      \
            abort()))
#endif

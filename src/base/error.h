/* error.h - error messages of functions that can fail, and assertions. */
#pragma once
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One English sentence: the failure, the value, the remedy. Owned by the caller; untouched on success. After the NUL
   of the sentence follows the same as a message (base/message.h), which wr_error_message returns. */
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

/* Returns the error as a message for translation (wr_message_print), or as plain text if the message was too long or
   the text was not written by the functions of this header. Valid as long as err is unchanged. Errors are nested by %s:
   wr_fail(err, "%s: %s", path, wr_error_message(&inner)). */
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

/* error.h - error messages of functions that can fail, and assertions. */
#pragma once
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* One sentence: the failure, the value, the remedy. Owned by the caller; untouched on success. */
typedef struct WrError {
    char text[512];
} WrError;

/* Writes the message and returns false, so that a check is one line:
 *
 *    if (width < 1) return wr_fail(err, "width %d: must be 1..16384", width);
 *
 * err may be NULL. A message that is too long is cut at a whole UTF-8 character. */
bool wr_fail(WrError *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Inserts "prefix" before an existing message (file, line, command). */
void wr_error_prefix(WrError *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

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

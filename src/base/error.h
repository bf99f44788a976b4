/* error.h - how functions say that they failed, and assertions.
   Layer 0. */
#pragma once
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* One sentence: what, the value, what would be right. The caller owns it; untouched on success. */
typedef struct WrError {
    char text[512];
} WrError;

/* Write the message and return false, so that a check is one line:
 *   if (width < 1) return wr_fail(err, "width %d: must be 1..16384", width);
 * err may be NULL. A message that is too long is cut at a whole UTF-8 character. */
bool wr_fail(WrError *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Put "prefix" in front of a message that is already there (file, line, command). */
void wr_error_prefix(WrError *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Our own bug, never a user's mistake. On in debug and test builds. */
#ifdef NDEBUG
#define WR_ASSERT(condition) ((void)0)
#else
#define WR_ASSERT(condition)                                                                       \
    ((condition)                                                                                   \
         ? (void)0                                                                                 \
         : (fprintf(stderr, "%s:%d: assertion failed: %s\n", __FILE__, __LINE__, #condition),      \
            abort()))
#endif

/* sentences.h - what the program put together, an error or a note, in the user's language: found again by the form that it
   was made of. What no form fits stays English, as do names, numbers and commands in it. One thread, the window's. */
#pragma once
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* out: the caller's, size bytes, at least 1; where the sentence is too long it is cut between letters. Returns `out`. */
const char *wr_sentence(const char *english, char *out, size_t size);
#define WR_SENTENCE 1200 /* bytes: room for the longest error */

#ifdef __cplusplus
}
#endif

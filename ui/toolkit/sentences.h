/* sentences.h - translation of composed messages (errors and notes). The message is matched against known format
   strings; unmatched text stays English, as do names, numbers and commands inside. Window thread only. */
#pragma once
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* out: buffer of the caller, size bytes, at least 1; longer sentences are truncated at a character boundary. Returns
   `out`. */
const char *wr_sentence(const char *english, char *out, size_t size);
#define WR_SENTENCE 1200 /* bytes: enough for the longest error */

#ifdef __cplusplus
}
#endif

/* suggest.h - spelling suggestions: the words of a list that a mistyped word most likely means.
   Layer 0. Every message that rejects a word gets its suggestion here. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* Word i of a list, i from 0; NULL past the last. `ctx` is the caller's. A word is read before the next call. */
typedef const char *(*WrWordList)(const void *ctx, int i);
/* A list whose ctx is an array of words that ends with NULL. */
const char *wr_word_of_array(const void *ctx, int i);

#define WR_NEAREST_MAX 2

/* The places in the list of the words that are nearest to `word` in edits: insertions, deletions, changes and swaps of
 * neighbours. Capitals count as small letters, _ as -. A word may differ by a third of its letters, by 3 at most. A word that
 * `word` begins ("out" of "output") is between one edit and two. If no word is within one edit, words of the list that mean in
 * this program what `word` means in another ("intensity" for strength). Returns how many there are: 0 if none is near,
 * or if more than WR_NEAREST_MAX are equally near. */
int wr_nearest(const char *word, WrWordList list, const void *ctx, int places[WR_NEAREST_MAX]);

/* Append the nearest words: "normal+y or normal-y". Appends nothing, and returns false, if none is near. */
bool wr_suggest(const char *word, WrWordList list, const void *ctx, WrText *text);

/* Reject a word that is not in the list: "WHAT: did you mean A? It must be one of A, B, C", or without a suggestion
 * "WHAT: must be one of A, B, C". `what` names the argument and its value, as "--as hieght". Returns false. */
bool wr_fail_word(WrError *err, const char *what, const char *word, WrWordList list,
                  const void *ctx);

/* suggest.h - spelling suggestions: the words of a list that a mistyped word most likely means.

   Every message that rejects a word uses them. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* Word i of a list, i from 0; NULL past the last. `ctx` is the caller's. A word is valid until the next
 * call. */
typedef const char *(*WrWordList)(const void *ctx, int i);
/* A list whose ctx is an array of words that ends with NULL. */
const char *wr_word_of_array(const void *ctx, int i);

#define WR_NEAREST_MAX 2

/* Indices of the words nearest to `word` in edits: insertions, deletions, changes and swaps of
 * neighbours. Case is ignored, and _ equals -. A word may differ by a third of its letters, by 3 at
 * most. A word of which `word` is a prefix ("out" of "output") ranks between one edit and two. If no
 * word is within one edit, the result contains words that mean here the same as `word` in another
 * program ("intensity" for strength). Returns their number: 0 if none is near, or if more than
 * WR_NEAREST_MAX are equally near. */
int wr_nearest(const char *word, WrWordList list, const void *ctx, int places[WR_NEAREST_MAX]);

/* Appends the nearest words: "normal+y or normal-y". Appends nothing and returns false if none is near. */
bool wr_suggest(const char *word, WrWordList list, const void *ctx, WrText *text);

/* Rejects a word that is not in the list: "WHAT: did you mean A? It must be one of A, B, C", or without
 * a suggestion "WHAT: must be one of A, B, C". `what` is the argument and its value, as "--as hieght".
 * Returns false. */
bool wr_fail_word(WrError *err, const char *what, const char *word, WrWordList list,
                  const void *ctx);

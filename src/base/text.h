/* text.h - growing text, and locale-independent conversion between numbers and text. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A growing, always NUL-terminated string. Zero-initialise; fini frees. data is "" while empty only
   after the first append, so read it through wr_text_get. */
typedef struct WrText {
    char *data;      /* owned */
    size_t length;   /* bytes, NUL not counted */
    size_t capacity; /* bytes */
} WrText;

void wr_text_fini(WrText *text);
void wr_text_clear(WrText *text);
const char *wr_text_get(const WrText *text); /* never NULL; valid until the next change */
void wr_text_add(WrText *text, const char *bytes);
void wr_text_add_n(WrText *text, const char *bytes, size_t length);
void wr_text_addf(WrText *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The shortest decimal digits that read back as the same double (float): "0.1", "1e+20", "-3".
   Never depends on the locale. Non-finite values print as nan, inf, -inf. Returns buffer, which
   holds at least WR_NUMBER_SIZE bytes. */
#define WR_NUMBER_SIZE 32
char *wr_number_print(double value, char *buffer);
char *wr_number_print_float(float value, char *buffer);
void wr_text_add_number(WrText *text, double value);

/* Reads a number that fills text[0..length): decimal, optional sign, fraction, exponent. No hex, no inf
   or nan, no surrounding space. Values beyond the range of double are rejected. */
bool wr_number_parse(const char *text, size_t length, double *value);

/* True if equal, ignoring the case of the letters A to Z. */
bool wr_text_same_letters(const char *a, const char *b);
/* Edit distance of two words: insertions, deletions, changes, swaps of neighbours. Only the first
   WR_WORD_MAX bytes of a longer word are compared. */
#define WR_WORD_MAX 63
int wr_word_distance(const char *a, const char *b);

/* True if the bytes are valid UTF-8. */
bool wr_text_is_utf8(const char *bytes);
/* Appends a JSON string with its quotes; invalid UTF-8 bytes become U+FFFD. */
void wr_text_add_json_string(WrText *text, const char *bytes);
/* Appends a JSON number with up to 17 digits, or null when not finite. */
void wr_text_add_json_number(WrText *text, double value);

/* ---- spelling suggestions ---- */

/* Spelling suggestions: the words of a list that a mistyped word most likely means.

   Every message that rejects a word uses them. */

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

/* Rejects a word that is not in the list: "ARGUMENT: did you mean A? It must be one of A, B, C", or
 * without a suggestion "ARGUMENT: must be one of A, B, C". argument: with its value, as "--as hieght".
 * Returns false. */
bool wr_fail_word(WrError *err, const char *argument, const char *word, WrWordList list,
                  const void *ctx);

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
int wr_text_distance(const char *a, const char *b);

/* Appends a JSON string with its quotes; invalid UTF-8 bytes become U+FFFD. */
void wr_text_add_json_string(WrText *text, const char *bytes);
/* Appends a JSON number with up to 17 digits, or null when not finite. */
void wr_text_add_json_number(WrText *text, double value);

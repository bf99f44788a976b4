/* scan.h - a text cursor for mesh files, with number parsing in double precision.
   Private to src/image.
   Part of the reader process, and of reading "inside". */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrScan {
    const char *at, *end;
} WrScan;

/* Skips blanks and tabs; the second also skips line ends. */
void wr_scan_blanks(WrScan *scan);
void wr_scan_space(WrScan *scan);
/* Reads the word at the cursor, up to a space, a control character or the end. Returns its length, 0 at
 * the end. */
size_t wr_scan_word(WrScan *scan, const char **word);
/* Reads a decimal number that ends with its word, with a decimal point in any locale. false: no number,
 * or beyond double. Up to 18 digits without an exponent are accurate to 1e-16 of the value; all others
 * are the nearest double. */
bool wr_scan_number(WrScan *scan, double *out);
/* wr_scan_number that also accepts nan, inf, -inf and similar words. */
bool wr_scan_any_number(WrScan *scan, double *out);

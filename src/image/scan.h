/* scan.h - a cursor over the text of a mesh file, and its numbers in double precision.
   Private to src/image. Part of the reader process, and of reading "inside". */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrScan {
    const char *at, *end;
} WrScan;

/* Pass over blanks and tabs; the second passes over ends of lines, too. */
void wr_scan_blanks(WrScan *scan);
void wr_scan_space(WrScan *scan);
/* The word at the cursor, up to a space, a control character or the end; passed over. Its length, 0 at the end. */
size_t wr_scan_word(WrScan *scan, const char **word);
/* A decimal number that ends with its word, in any locale with a point. false: there is none, or it is beyond double.
 * Up to 18 digits without an exponent are right to some 1e-16 of the value; all others are the nearest double. */
bool wr_scan_number(WrScan *scan, double *out);
/* The same where files also write nan, inf, -inf and the like. */
bool wr_scan_any_number(WrScan *scan, double *out);

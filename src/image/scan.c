#include "image/scan.h"

#include "base/text.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define DIGITS 18 /* digits that fit into 64 bits */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static bool is_space(char c)
{
    return (unsigned char)c <= ' ';
}

void wr_scan_blanks(WrScan *scan)
{
    while (scan->at < scan->end && is_blank(*scan->at)) scan->at++;
}

void wr_scan_space(WrScan *scan)
{
    while (scan->at < scan->end && is_space(*scan->at)) scan->at++;
}

size_t wr_scan_word(WrScan *scan, const char **word)
{
    *word = scan->at;
    while (scan->at < scan->end && !is_space(*scan->at)) scan->at++;
    return (size_t)(scan->at - *word);
}

/* Reads digits into *value; returns their number. */
static int take_digits(WrScan *scan, uint64_t *value)
{
    const char *from = scan->at;
    for (; scan->at < scan->end; scan->at++) {
        const unsigned digit = (unsigned)*scan->at - '0';
        if (digit > 9) break;
        *value = *value * 10 + digit;
    }
    return scan->at - from > DIGITS ? DIGITS + 1 : (int)(scan->at - from);
}

/* A number of any other form, from its first letter. */
static bool odd_number(WrScan *scan, const char *from, double *out)
{
    const char *word;
    scan->at = from;
    const size_t length = wr_scan_word(scan, &word);
    return wr_number_parse(word, length, out);
}

bool wr_scan_number(WrScan *scan, double *out)
{
    static const double tens[DIGITS + 1] = { 1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                             1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                             1e14, 1e15, 1e16, 1e17, 1e18 };
    const char *from = scan->at;
    const bool minus = from < scan->end && *from == '-';
    if (minus || (from < scan->end && *from == '+')) scan->at++;
    uint64_t digits = 0;
    int whole = take_digits(scan, &digits), places = 0;
    if (scan->at < scan->end && *scan->at == '.') {
        scan->at++;
        places = take_digits(scan, &digits);
    }
    if (whole + places == 0 || whole + places > DIGITS ||
        (scan->at < scan->end && !is_space(*scan->at)))
        return odd_number(scan, from, out);
    const double value = (double)digits / tens[places];
    *out = minus ? -value : value;
    return true;
}

bool wr_scan_any_number(WrScan *scan, double *out)
{
    static const char *const nothing[] = { "nan", "-nan", "nan(ind)", "-nan(ind)" };
    const char *from = scan->at;
    char word[16] = "";
    if (wr_scan_number(scan, out)) return true;
    const size_t length = (size_t)(scan->at - from);
    if (length >= sizeof word) return false;
    memcpy(word, from, length);
    for (size_t i = 0; i < sizeof nothing / sizeof *nothing; i++)
        if (wr_text_same_letters(word, nothing[i])) {
            *out = NAN;
            return true;
        }
    const bool minus = *word == '-';
    const char *bare = word + (minus || *word == '+');
    if (!wr_text_same_letters(bare, "inf") && !wr_text_same_letters(bare, "infinity")) return false;
    *out = minus ? -INFINITY : INFINITY;
    return true;
}

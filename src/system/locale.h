/* locale.h - number formatting and parsing in the C locale, whatever locale a library has set.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stddef.h>

/* Switches the calling thread to the C locale permanently. */
void wr_locale_keep_plain(void);
/* Prints with `digits` significant digits, as printf's %.*g. */
void wr_locale_print_plain(char *text, size_t size, double value, int digits);
/* As strtod and strtof; *end is the first unread character. */
double wr_locale_read_double(const char *text, char **end);
float wr_locale_read_float(const char *text, char **end);

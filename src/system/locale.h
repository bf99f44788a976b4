/* locale.h - numbers as C writes them, whatever language a library has set for the program.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stddef.h>

/* All that the calling thread prints and reads is so from now on, whatever language is set meanwhile. */
void wr_locale_keep_plain(void);
/* With `digits` significant digits, as printf's %.*g. */
void wr_locale_print_plain(char *text, size_t size, double value, int digits);
/* As strtod and strtof; *end is what follows. */
double wr_locale_read_double(const char *text, char **end);
float wr_locale_read_float(const char *text, char **end);

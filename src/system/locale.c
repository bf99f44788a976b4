#include "system/locale.h"

#include <locale.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#ifdef __APPLE__ /* macOS declares them in a header of its own */
#include <xlocale.h>
#endif

/* The C locale, whatever a library has set for the process. Created once. */
static locale_t c_locale(void)
{
    static locale_t made;
    locale_t now = __atomic_load_n(&made, __ATOMIC_ACQUIRE);
    if (now) return now;
    locale_t mine = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!__atomic_compare_exchange_n(&made, &now, mine, false, __ATOMIC_ACQ_REL,
                                     __ATOMIC_ACQUIRE)) {
        freelocale(mine);
        return now;
    }
    return mine;
}

void wr_locale_keep_plain(void)
{
    uselocale(c_locale());
}

void wr_locale_print_plain(char *text, size_t size, double value, int digits)
{
    locale_t old = uselocale(c_locale());
    snprintf(text, size, "%.*g", digits, value);
    uselocale(old);
}

double wr_locale_read_double(const char *text, char **end)
{
    locale_t old = uselocale(c_locale());
    double value = strtod(text, end);
    uselocale(old);
    return value;
}

float wr_locale_read_float(const char *text, char **end)
{
    locale_t old = uselocale(c_locale());
    float value = strtof(text, end);
    uselocale(old);
    return value;
}

#include "base/length_unit.h"

#include "base/text.h"

#include <string.h>

static const double sizes[WR_UNIT_COUNT] = { 1, 1, 10, 1000, 25.4, 304.8, 0.001 };
const char *const wr_length_units[WR_UNIT_COUNT] = { "mm", "cm", "m", "in", "ft", "um", NULL };

double wr_length_unit_mm(WrLengthUnit unit)
{
    return sizes[unit];
}

/* "m" is the end of "mm", "cm" and "um", so that the part before it is no number there. */
bool wr_length_parse(const char *text, size_t length, double *mm)
{
    for (int i = 0; wr_length_units[i]; i++) {
        const size_t n = strlen(wr_length_units[i]);
        if (length <= n || memcmp(text + length - n, wr_length_units[i], n) != 0 ||
            !wr_number_parse(text, length - n, mm))
            continue;
        *mm *= sizes[i + 1];
        return true;
    }
    return wr_number_parse(text, length, mm);
}

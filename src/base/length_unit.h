/* length_unit.h - units of length: their names and sizes. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef enum WrLengthUnit {
    WR_UNIT_UNKNOWN, /* treated as millimetres */
    WR_UNIT_MM,
    WR_UNIT_CM,
    WR_UNIT_M,
    WR_UNIT_IN,
    WR_UNIT_FT,
    WR_UNIT_UM,
    WR_UNIT_COUNT
} WrLengthUnit;

/* Words of the units from WR_UNIT_MM on: "mm", "cm", ...; NULL-terminated. */
extern const char *const wr_length_units[WR_UNIT_COUNT];
/* Its size in millimetres. */
double wr_length_unit_mm(WrLengthUnit unit);
/* Reads a length such as "10mm" or "0.5in" in millimetres; a number without a unit is in millimetres. */
bool wr_length_parse(const char *text, size_t length, double *mm);

/* line.h - construction of command lines. */
#pragma once
#include "base/vec.h"

typedef struct WrText WrText;

void wr_line_number(WrText *line, const char *name, double value); /* " name=1.5" */
void wr_line_vec(WrText *line, const char *name, WrVec3 value);    /* " name=1,2,3" */
void wr_line_plain_vec(WrText *line, WrVec3 value);                /* "1,2,3" */
/* Append " name="value"" with the quoting of the command language. */
void wr_line_text(WrText *line, const char *name, const char *value);
/* x rounded to `digits` (0..9) after the point, never -0: the precision of a pointer, for readable lines. */
double wr_line_round(double x, int digits);
WrVec3 wr_line_round_vec(WrVec3 v, int digits);

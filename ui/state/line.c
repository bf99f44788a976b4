#include "ui/state/line.h"

#include "base/text.h"
#include "base/vec.h"

#include <math.h>

void wr_line_number(WrText *line, const char *name, double value)
{
    wr_text_addf(line, " %s=", name);
    wr_text_add_number(line, value);
}

void wr_line_plain_vec(WrText *line, WrVec3 v)
{
    wr_text_add_number(line, v.x);
    wr_text_add(line, ",");
    wr_text_add_number(line, v.y);
    wr_text_add(line, ",");
    wr_text_add_number(line, v.z);
}

void wr_line_vec(WrText *line, const char *name, WrVec3 value)
{
    wr_text_addf(line, " %s=", name);
    wr_line_plain_vec(line, value);
}

void wr_line_text(WrText *line, const char *name, const char *value)
{
    wr_text_addf(line, " %s=\"", name);
    for (const char *c = value; *c; c++) {
        if (*c == '"' || *c == '\\') wr_text_add(line, "\\");
        wr_text_add_n(line, c, 1);
    }
    wr_text_add(line, "\"");
}

double wr_line_round(double x, int digits)
{
    static const double powers[] = { 1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9 };
    double p = powers[digits], k = rint(x * p);
    return fabs(k) < 0x1p53 ? k / p + 0.0 : x;
}

WrVec3 wr_line_round_vec(WrVec3 v, int digits)
{
    return (WrVec3){ wr_line_round(v.x, digits), wr_line_round(v.y, digits),
                     wr_line_round(v.z, digits) };
}

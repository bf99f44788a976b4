#include "ui/canvas/seam.h"

#include "field/field.h"

#include <math.h>

#define LOOKS 256
#define CLEARLY 1.5 /* times what is found inside */

typedef struct Breaks {
    double jump, crease; /* sums of squares */
    double most;
} Breaks;

/* The four texels about the line between texel `line - 1` and `line`, at place k along it. */
static void read_four(const WrField *field, bool along_v, int line, int k, float four[4])
{
    if (along_v) wr_field_read(field, line - 2, k, 4, 1, four, 4);
    else wr_field_read(field, k, line - 2, 1, 4, four, 1);
}

static Breaks measure_line(const WrField *field, bool along_v, int line, int length)
{
    Breaks sum = { 0 };
    int looks = length < LOOKS ? length : LOOKS;
    for (int n = 0; n < looks; n++) {
        float t[4];
        read_four(field, along_v, line, (int)((int64_t)n * length / looks), t);
        double before = (double)t[1] - (double)t[0], after = (double)t[3] - (double)t[2];
        double jump = (double)t[2] - (double)t[1] - (before + after) / 2.0;
        double crease = after - before;
        sum.jump += jump * jump;
        sum.crease += crease * crease;
        sum.most = fmax(sum.most, fabs(jump));
    }
    sum.jump = sqrt(sum.jump / looks);
    sum.crease = sqrt(sum.crease / looks);
    return sum;
}

/* along_v: the edge runs along v, and the lines inside are columns. */
static WrSeamEdge measure(const WrField *field, bool along_v)
{
    int size = along_v ? wr_field_width(field) : wr_field_height(field);
    int length = along_v ? wr_field_height(field) : wr_field_width(field);
    WrWrap wrap = along_v ? wr_field_wrap_u(field) : wr_field_wrap_v(field);
    WrSeamEdge edge = { .wraps = wrap == WR_WRAP_PERIODIC && size >= 4 };
    if (!edge.wraps) return edge;
    Breaks seam = measure_line(field, along_v, 0, length);
    edge.jump = seam.jump;
    edge.jump_most = seam.most;
    edge.crease = seam.crease;
    int inside = size - 3; /* lines 2 .. size - 2: none that reads across the seam */
    int looks = inside < LOOKS ? inside : LOOKS;
    for (int n = 0; n < looks; n++) {
        int line = 2 + (int)((int64_t)n * inside / looks);
        Breaks b = measure_line(field, along_v, line, length);
        edge.jump_inside = fmax(edge.jump_inside, b.jump);
        edge.crease_inside = fmax(edge.crease_inside, b.crease);
    }
    /* what rounding to float leaves is none */
    double noise = 1e-6 * (fabs((double)wr_field_get(field, 0, 0)) + edge.jump_inside);
    edge.jumps = edge.jump > CLEARLY * edge.jump_inside + noise;
    edge.creases = edge.crease > CLEARLY * edge.crease_inside + noise;
    return edge;
}

WrSeam wr_seam_measure(const WrField *field)
{
    return (WrSeam){ measure(field, true), measure(field, false) };
}

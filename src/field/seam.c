#include "field/seam.h"

#include "field/field.h"

#include <math.h>

typedef struct Breaks {
    double jump, crease; /* sums of squares */
    double jump_most, crease_most;
} Breaks;

/* The four texels about the line between texel `line - 1` and `line`, at place k along it. */
static void read_four(const WrField *field, bool along_v, int line, int k, float four[4])
{
    if (along_v) wr_field_read(field, line - 2, k, 4, 1, four, 4);
    else wr_field_read(field, k, line - 2, 1, 4, four, 1);
}

static Breaks measure_line(const WrField *field, bool along_v, int line, int length, int most)
{
    Breaks sum = { 0 };
    const int looks = length < most ? length : most;
    for (int n = 0; n < looks; n++) {
        float t[4];
        read_four(field, along_v, line, (int)((int64_t)n * length / looks), t);
        double before = (double)t[1] - (double)t[0], after = (double)t[3] - (double)t[2];
        double jump = (double)t[2] - (double)t[1] - (before + after) / 2.0;
        double crease = after - before;
        sum.jump += jump * jump;
        sum.crease += crease * crease;
        sum.jump_most = fmax(sum.jump_most, fabs(jump));
        sum.crease_most = fmax(sum.crease_most, fabs(crease));
    }
    sum.jump = sqrt(sum.jump / looks);
    sum.crease = sqrt(sum.crease / looks);
    return sum;
}

static void measure_inside(const WrField *field, bool along_v, int size, int length, int most,
                           WrSeamEdge *edge)
{
    const int inside = size - 3; /* lines 2 .. size - 2: none that reads across the seam */
    const int looks = inside < most ? inside : most;
    for (int n = 0; n < looks; n++) {
        const int line = 2 + (int)((int64_t)n * inside / looks);
        const Breaks b = measure_line(field, along_v, line, length, most);
        edge->rank += b.jump < edge->jump ? 1.0 / looks : 0;
        edge->jump_inside = fmax(edge->jump_inside, b.jump);
        edge->crease_inside = fmax(edge->crease_inside, b.crease);
        edge->jump_most_inside = fmax(edge->jump_most_inside, b.jump_most);
        edge->crease_most_inside = fmax(edge->crease_most_inside, b.crease_most);
    }
}

/* along_v: the edge runs along v, and the lines inside are columns. */
static WrSeamEdge measure(const WrField *field, bool along_v, int most)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const int size = along_v ? w : h, length = along_v ? h : w;
    const WrWrap wrap = along_v ? wr_field_wrap_u(field) : wr_field_wrap_v(field);
    WrSeamEdge edge = { .wraps = wrap == WR_WRAP_PERIODIC && size >= 4 };
    if (!edge.wraps) return edge;
    const Breaks seam = measure_line(field, along_v, 0, length, most);
    edge.jump = seam.jump, edge.jump_most = seam.jump_most;
    edge.crease = seam.crease, edge.crease_most = seam.crease_most;
    measure_inside(field, along_v, size, length, most, &edge);
    /* what rounding to float leaves is none */
    const double noise = 1e-6 * (fabs((double)wr_field_get(field, 0, 0)) + edge.jump_inside);
    edge.jumps = edge.jump > WR_SEAM_CLEARLY * edge.jump_inside + noise;
    edge.creases = edge.crease > WR_SEAM_CLEARLY * edge.crease_inside + noise;
    return edge;
}

WrSeam wr_seam_measure(const WrField *field, int looks)
{
    return (WrSeam){ measure(field, true, looks), measure(field, false, looks) };
}

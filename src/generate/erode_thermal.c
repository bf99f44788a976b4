#include "generate/erode.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"

#include <math.h>

const WrParam wr_params_thermal[] = {
    WR_P_NUMBER("talus", "Angle of rest", 35, 0, 89, 89, "degrees",
                "slopes steeper than this slide"),
    WR_P_ABOVE("width", "Width", 8, 0, WR_PARAM_HEIGHT, 20, "table units",
               "of the whole table, by which angles are measured"),
    WR_P_WHOLE("rounds", "Rounds", 60, 0, 100000, 500, "how long it weathers"),
    WR_P_PART("rate", "Rate", 0.7, "how much of what is too steep slides at once"), WR_P_END
};

static const int step_i[8] = { -1, 1, 0, 0, -1, 1, -1, 1 };
static const int step_j[8] = { 0, 0, -1, 1, -1, -1, 1, 1 };

typedef struct Round {
    const WrThermal *how;
    const WrSheet *from;
    WrSheet *to;
    double *part; /* rate/2 max(d) / sum(d); 0: no flow */
    double hold[8];
} Round;

/* Index of neighbour k, or -1 beyond an edge (or if it is the texel itself). */
static int64_t neighbour(const WrSheet *s, int i, int j, int k)
{
    int x = i + step_i[k], y = j + step_j[k];
    if ((x < 0 || x >= s->width) && s->wrap[0] == WR_WRAP_CLAMP) return -1;
    if ((y < 0 || y >= s->height) && s->wrap[1] == WR_WRAP_CLAMP) return -1;
    x = wr_sheet_index(x, s->width, s->wrap[0]);
    y = wr_sheet_index(y, s->height, s->wrap[1]);
    return x == i && y == j ? -1 : (int64_t)y * s->width + x;
}

static void weigh_rows(const void *ctx, int first, int end)
{
    const Round *r = ctx;
    const WrSheet *s = r->from;
    for (int j = first; j < end; j++)
        for (int i = 0; i < s->width; i++) {
            int64_t at = (int64_t)j * s->width + i;
            double most = 0.0, sum = 0.0;
            for (int k = 0; k < 8; k++) {
                int64_t to = neighbour(s, i, j, k);
                double d = to < 0 ? 0.0 : s->z[at] - s->z[to] - r->hold[k];
                if (d > most) most = d;
                if (d > 0.0) sum += d;
            }
            r->part[at] = sum > 0.0 ? 0.5 * r->how->rate * (most / sum) : 0.0;
        }
}

/* Both ends of a flow compute it from the same numbers. */
static void flow_rows(const void *ctx, int first, int end)
{
    const Round *r = ctx;
    const WrSheet *s = r->from;
    for (int j = first; j < end; j++)
        for (int i = 0; i < s->width; i++) {
            int64_t at = (int64_t)j * s->width + i;
            double change = 0.0;
            for (int k = 0; k < 8; k++) {
                int64_t to = neighbour(s, i, j, k);
                if (to < 0) continue;
                double out = s->z[at] - s->z[to] - r->hold[k];
                double in = s->z[to] - s->z[at] - r->hold[k];
                if (out > 0.0) change -= r->part[at] * out;
                if (in > 0.0) change += r->part[to] * in;
            }
            r->to->z[at] = s->z[at] + change;
        }
}

bool wr_erode_thermal(WrSheet *sheet, const WrThermal *how, const WrGenerateJob *job, WrError *err)
{
    WrSheet other = { .z = NULL };
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    if (!wr_sheet_copy(&other, sheet, err)) return false;
    Round r = { .how = how, .part = wr_try_alloc(count, sizeof *r.part, "flows of stones", err) };
    bool good = r.part != NULL;
    for (int k = 0; k < 8; k++) r.hold[k] = how->talus * (k < 4 ? 1.0 : sqrt(2.0));
    for (int n = 0; good && n < how->rounds; n++) {
        r.from = sheet;
        r.to = &other;
        good = wr_sheet_run(sheet, job, false, weigh_rows, &r, err) &&
               wr_sheet_run(sheet, job, false, flow_rows, &r, err);
        double *swap = sheet->z;
        sheet->z = other.z;
        other.z = swap;
        if (good && !wr_progress_step(job->progress, (n + 1.0) / how->rounds))
            good = wr_fail(err, "cancelled");
    }
    wr_free(r.part);
    wr_sheet_fini(&other);
    return good;
}

bool wr_terrain_thermal(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams p = { wr_params_thermal, values };
    WrSheet sheet = { .z = NULL };
    double sine, cosine;
    wr_sincos_turns(wr_param_number(&p, "talus") / 360.0, &sine, &cosine);
    if (!wr_erode_begin(&sheet, job, err)) return false;
    double texel = wr_param_number(&p, "width") / sheet.width;
    double scale = (double)sheet.width / wr_field_width(job->like);
    WrThermal how = { .talus = sine / cosine * texel,
                      .rate = wr_param_number(&p, "rate"),
                      /* material spreads with the root of the number of rounds, in texels */
                      .rounds = (int)ceil(wr_param_number(&p, "rounds") * scale * scale) };
    bool good = wr_erode_thermal(&sheet, &how, job, err);
    return wr_erode_end(&sheet, job, good, out, err);
}

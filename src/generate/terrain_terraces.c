/* Terraces: the present heights quantized to steps. */
#include "generate/terrain.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "noise/grid.h"

#include <math.h>

const WrParam wr_params_terraces[] = {
    WR_P_WHOLE("steps", "Steps", 8, 1, 4096, 32, "from the lowest to the highest place"),
    WR_P_PART("sharpness", "Sharpness", 0.8, "how flat the terraces are: 0 leaves what lies there"),
    WR_P_NUMBER("riser", "Riser", 0.3, 0.01, 1, 1, "",
                "the part of a step's height over which it rises"),
    WR_P_PART("jitter", "Jitter", 0.3, "how unevenly they run, in steps"),
    WR_P_WHOLE("cells", "Cells", 6, 1, 4096, 32, "of the jitter, across the table"),
    WR_P_PART("uneven", "Uneven", 0.3, "how much some steps are higher than others"),
    WR_P_SEED,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Terraces {
    WrSheet *sheet;
    double low, high, steps, sharpness, riser, jitter, uneven;
    uint32_t seed;
    WrOctavesPlan noise;
    WrOrigin across, up;
} Terraces;

/* End of step k, in steps. */
static double bound(const Terraces *t, double k)
{
    if (k <= 0.0 || k >= t->steps) return k;
    uint32_t mixed = wr_mix32(t->seed ^ wr_mix32((uint32_t)(int64_t)k + 0x9e3779b9U));
    return k + t->uneven * 0.8 * (mixed / 4294967296.0 - 0.5);
}

/* x: in steps from the lowest; shifted by `bend` before the quantization and back after it. */
static double cut(const Terraces *t, double x, double bend)
{
    double at = x + bend, k = floor(at);
    if (at < bound(t, k)) k -= 1.0;
    else if (at >= bound(t, k + 1.0)) k += 1.0;
    double from = bound(t, k), to = bound(t, k + 1.0);
    double part = (at - from) / (to - from), s = (part - (1.0 - t->riser)) / t->riser;
    s = s > 0.0 ? s < 1.0 ? s : 1.0 : 0.0;
    double flat = from + (to - from) * s * s * (3.0 - 2.0 * s);
    return x + t->sharpness * (flat - at);
}

static void cut_rows(const void *ctx, int first, int end)
{
    const Terraces *t = ctx;
    int width = t->sheet->width, height = t->sheet->height;
    float *n = wr_alloc((size_t)width, sizeof *n);
    double step = (t->high - t->low) / t->steps;
    for (int j = first; j < end; j++) {
        WrNoiseGrid grid = { width, height, 0, j, width, 1 };
        wr_octaves_grid(&t->noise, &grid, n, NULL, NULL, (size_t)width);
        int to = height - 1 - (height - 1 - j + t->up.shift) % height;
        double *row = t->sheet->z + (size_t)to * (size_t)width;
        for (int i = 0; i < width; i++) {
            double *z = &row[(i + t->across.shift) % width];
            *z = t->low + step * cut(t, (*z - t->low) / step, t->jitter * (double)n[i]);
        }
    }
    wr_free(n);
}

static bool plan(Terraces *t, const WrParams *p, WrError *err)
{
    WrOctaves o = wr_octaves_default(2);
    const int texels[] = { t->sheet->width, t->sheet->height };
    o.count = 4;
    o.seed = t->seed;
    o.cells[0] = wr_param_number(p, "cells");
    o.cells[1] = floor(o.cells[0] * texels[1] / texels[0] + 0.5);
    if (o.cells[1] < 1.0) o.cells[1] = 1.0;
    if (!wr_octaves_plan(&o, texels, &t->noise, err)) return false;
    const double rest[] = { t->across.rest / t->across.size, t->up.rest / t->up.size };
    for (int k = 0; k < t->noise.used; k++)
        for (int a = 0; a < 2; a++) {
            WrOctave *octave = &t->noise.octave[k];
            octave->offset[a] = wr_noise_reduce(octave->offset[a] - octave->frequency[a] * rest[a],
                                                octave->frequency[a]);
        }
    return true;
}

bool wr_terrain_terraces(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                         WrError *err)
{
    const WrParams p = { wr_params_terraces, values };
    const WrParamValue *origin = wr_param_value(&p, "origin");
    WrSheet sheet = { .z = NULL };
    Terraces t = { .sheet = &sheet,
                   .steps = wr_param_number(&p, "steps"),
                   .sharpness = wr_param_number(&p, "sharpness"),
                   .riser = wr_param_number(&p, "riser"),
                   .jitter = wr_param_number(&p, "jitter"),
                   .uneven = wr_param_number(&p, "uneven"),
                   .seed = wr_param_seed(&p),
                   .across = wr_origin(wr_field_width(job->like), origin->number[0]),
                   .up = wr_origin(wr_field_height(job->like), origin->number[1]) };
    bool good = wr_sheet_read(&sheet, job->like, err) && plan(&t, &p, err);
    if (good) wr_sheet_range(&sheet, &t.low, &t.high);
    if (good && t.high > t.low) good = wr_sheet_run(&sheet, job, true, cut_rows, &t, err);
    good = good && wr_sheet_relief(&sheet, job, out, err);
    wr_sheet_fini(&sheet);
    return good;
}

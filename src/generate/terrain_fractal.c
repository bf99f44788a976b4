/* Mountains: sums of noise whose fine octaves are weighted by location: strong at heights, on ridges,
   and on gentle slopes. With n_k the octaves (about -1..1), a_k = ratio^-k and weights w_k,

     fbm      v = sum of a_k w_k n_k
     billow   v = sum of a_k w_k (2 |n_k| - 1)
     ridged   v = sum of a_k w_k s_k, s_k = (1 - |n_k|)^2,   m_(k+1) = min(1, gain m_k s_k)
     hybrid   v = sum of a_k w_k s_k, s_k = n_k + offset,    m_(k+1) = min(1, gain m_k s_k)

   (Musgrave's multifractals; in the first two m_k = 1), and

     w_k = m_k (1 - altitude + altitude h) / (1 + erosion |d|^2)

   where h = 0..1 is the relative height of the sum of the previous octaves between their lowest and
   highest, and d is the sum of the slopes of the octaves so far, each per own cell: steep places stay
   smooth. */
#include "generate/terrain.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "field/field.h"
#include "noise/grid.h"

#include <math.h>

#define TYPES(X) X(FBM, "fbm") X(BILLOW, "billow") X(RIDGED, "ridged") X(HYBRID, "hybrid")
enum { TYPES(WR_WORD_ID) };
static const char *const types[] = { TYPES(WR_WORD) NULL };

const WrParam wr_params_fractal[] = {
    WR_P_CHOICE("type", "Type", RIDGED, types, "round hills, lumps, ridges, plains with mountains"),
    WR_P_WHOLE("cells", "Cells", 3, 1, 4096, 16, "of the first octave, across the table"),
    WR_P_WHOLE("octaves", "Octaves", 9, 1, WR_OCTAVES_MOST, 12,
               "at most; those finer than two texels a cell are left out"),
    WR_P_ABOVE("ratio", "Fall", 2.1, 1, 64, 4, "",
               "each octave is so many times lower than the one before"),
    WR_P_ABOVE("step", "Step", 2, 1, 64, 4, "",
               "each octave has so many times more cells; rounded to whole cells"),
    WR_P_NUMBER("offset", "Offset", 0.7, 0, 10, 2, "", "type=hybrid: how much of it is mountains"),
    WR_P_NUMBER("gain", "Gain", 2, 0, 100, 4, "",
                "type=ridged, hybrid: how soon fine octaves show beside the ridges"),
    WR_P_PART("altitude", "By altitude", 0.5, "how much finer octaves fade towards low ground"),
    WR_P_NUMBER("erosion", "Erosion", 0.5, 0, 100, 2, "", "how much finer octaves fade on slopes"),
    WR_P_NUMBER("warp", "Warp", 0, -8, 8, 1, "cells",
                "how far places are moved by a noise of their own; slow"),
    WR_P_ABOVE("curve", "Curve", 1, 0, 16, 4, "",
               "heights, as parts of the whole, to this power: above 1, wider valleys"),
    WR_P_PART("sea", "Sea", 0, "what is lower is flat, as a part of the height"),
    WR_P_SEED,
    WR_P_HEIGHT,
    WR_P_NUMBER("level", "Level", 0, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "of the lowest place"),
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Fractal {
    int type, octaves;
    double ratio, offset, gain, altitude, erosion, warp;
    bool slopes;
    WrOctavesPlan octave[WR_OCTAVES_MOST]; /* one each, amplitude 1 */
    WrOctavesPlan bend[2];
    double low[WR_OCTAVES_MOST], high[WR_OCTAVES_MOST]; /* of the sum before octave k */
    WrOrigin across, up;
    WrSheet *sheet;
} Fractal;

/* One texel's sum while octaves are added. */
typedef struct Sum {
    double v, m, du, dv;
} Sum;

static void add_octave(const Fractal *f, int k, double amplitude, double n, double nu, double nv,
                       Sum *sum)
{
    const WrOctave *octave = &f->octave[k].octave[0];
    double weight = sum->m;
    if (k > 0) {
        double h = (sum->v - f->low[k]) / (f->high[k] - f->low[k]);
        h = h > 0.0 ? h < 1.0 ? h : 1.0 : 0.0;
        weight *= 1.0 - f->altitude + f->altitude * h * h * (3.0 - 2.0 * h);
    }
    if (f->slopes) {
        sum->du += nu / octave->frequency[0];
        sum->dv += nv / octave->frequency[1];
        weight /= 1.0 + f->erosion * (sum->du * sum->du + sum->dv * sum->dv);
    }
    double s = n, ridge = 1.0 - fabs(n);
    if (f->type == BILLOW) s = 1.0 - 2.0 * ridge;
    if (f->type == RIDGED) s = ridge > 0.0 ? ridge * ridge : 0.0;
    if (f->type == HYBRID) s = n + f->offset;
    sum->v += amplitude * weight * s;
    if (f->type == RIDGED || f->type == HYBRID) {
        double m = f->gain * sum->m * s;
        sum->m = m > 0.0 ? m < 1.0 ? m : 1.0 : 0.0;
    }
}

/* ---- plans ---- */

static bool plan(Fractal *f, const WrParams *p, const WrGenerateJob *job, WrError *err)
{
    int width = wr_field_width(job->like), height = wr_field_height(job->like);
    WrOctaves o = wr_octaves_default(2);
    WrOctavesPlan all;
    const int texels[] = { width, height };
    o.count = wr_param_whole(p, "octaves");
    o.ratio = f->ratio;
    o.step = wr_param_number(p, "step");
    o.seed = wr_param_seed(p);
    o.cells[0] = wr_param_number(p, "cells");
    o.cells[1] = floor(o.cells[0] * height / width + 0.5);
    if (o.cells[1] < 1.0) o.cells[1] = 1.0;
    if (!wr_octaves_plan(&o, texels, &all, err)) return false;
    if (all.used == 0)
        wr_generate_note(job, "nothing is left: cells=%g is finer than two texels a cell",
                         o.cells[0]);
    f->octaves = job->coarse && f->warp != 0.0 && all.used > 4 ? 4 : all.used;
    for (int k = 0; k < all.used; k++) {
        f->octave[k] = all;
        f->octave[k].used = 1;
        f->octave[k].octave[0] = all.octave[k];
        f->octave[k].octave[0].amplitude = 1.0;
    }
    o.count = 2;
    for (int a = 0; a < 2; a++) {
        o.seed = wr_mix32(o.seed + 0x51ed270bU);
        if (!wr_octaves_plan(&o, texels, &f->bend[a], err)) return false;
    }
    f->warp /= o.cells[0];
    return true;
}

/* Moves by a fraction of a texel; whole ones are rolled. */
static void move(WrOctavesPlan *one, const Fractal *f)
{
    const double by[] = { f->across.rest / f->across.size, f->up.rest / f->up.size };
    for (int k = 0; k < one->used; k++)
        for (int a = 0; a < 2; a++) {
            WrOctave *octave = &one->octave[k];
            octave->offset[a] = wr_noise_reduce(octave->offset[a] - octave->frequency[a] * by[a],
                                                octave->frequency[a]);
        }
}

/* Range of the sum of the first k octaves, for `altitude`: two thirds of the noise's bound, which is
 * seldom exceeded. */
static void span(Fractal *f)
{
    double low = 0.0, high = 0.0, amplitude = 1.0;
    for (int k = 0; k < f->octaves; k++) {
        f->low[k] = low;
        f->high[k] = high;
        double few = f->type == FBM ? -0.6 : f->type == BILLOW ? -1.0 : 0.0;
        double many = f->type == FBM      ? 0.6
                      : f->type == BILLOW ? 0.3
                      : f->type == RIDGED ? 1.0
                                          : f->offset + 0.6;
        low += few * amplitude;
        high += many * amplitude;
        amplitude /= f->ratio;
    }
}

/* ---- rows ---- */

static void octave_row(const Fractal *f, int k, const WrNoiseGrid *grid, const double *place,
                       float *n)
{
    int width = grid->width;
    float *nu = n + width, *nv = nu + width;
    if (f->warp == 0.0) {
        wr_octaves_grid(&f->octave[k], grid, n, f->slopes ? nu : NULL, f->slopes ? nv : NULL,
                        (size_t)width);
        return;
    }
    for (int i = 0; i < width; i++) {
        double slope[2];
        n[i] = (float)wr_octaves_at(&f->octave[k], place + 2 * i, slope);
        nu[i] = (float)slope[0];
        nv[i] = (float)slope[1];
    }
}

/* Noise positions of the row's texels. n: [2 width] scratch */
static void bend_row(const Fractal *f, const WrNoiseGrid *grid, double *place, float *n)
{
    for (int a = 0; a < 2; a++) {
        wr_octaves_grid(&f->bend[a], grid, n, NULL, NULL, (size_t)grid->width);
        for (int i = 0; i < grid->width; i++) {
            double at = a == 0 ? (i + 0.5) / grid->width : 1.0 - (grid->j + 0.5) / grid->height;
            place[2 * i + a] = at + f->warp * (double)n[i];
        }
    }
}

static void fill_rows(const void *ctx, int first, int end)
{
    const Fractal *f = ctx;
    int width = f->sheet->width, height = f->sheet->height;
    float *n = wr_alloc((size_t)width, 3 * sizeof *n);
    double *place = wr_alloc((size_t)width, 2 * sizeof *place);
    Sum *sums = wr_alloc((size_t)width, sizeof *sums);
    for (int j = first; j < end; j++) {
        WrNoiseGrid grid = { width, height, 0, j, width, 1 };
        double amplitude = 1.0;
        for (int i = 0; i < width; i++) sums[i] = (Sum){ .m = 1.0 };
        if (f->warp != 0.0) bend_row(f, &grid, place, n);
        for (int k = 0; k < f->octaves; k++, amplitude /= f->ratio) {
            octave_row(f, k, &grid, place, n);
            for (int i = 0; i < width; i++)
                add_octave(f, k, amplitude, (double)n[i], (double)n[width + i],
                           (double)n[2 * width + i], &sums[i]);
        }
        int to = height - 1 - (height - 1 - j + f->up.shift) % height;
        for (int i = 0; i < width; i++)
            f->sheet->z[(size_t)to * (size_t)width + (size_t)((i + f->across.shift) % width)] =
                sums[i].v;
    }
    wr_free(n);
    wr_free(place);
    wr_free(sums);
}

/* Maps 0..1 of the whole to level..level + height. */
static void shape(const WrParams *p, WrSheet *sheet)
{
    double low, high, height = wr_param_number(p, "height"), level = wr_param_number(p, "level");
    double curve = wr_param_number(p, "curve"), sea = wr_param_number(p, "sea");
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    wr_sheet_range(sheet, &low, &high);
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) {
        double t = high > low ? (sheet->z[k] - low) / (high - low) : 0.0;
        if (curve != 1.0) t = wr_pow(t, curve);
        sheet->z[k] = level + height * (t > sea ? t : sea);
    }
}

bool wr_terrain_fractal(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams p = { wr_params_fractal, values };
    const WrWrap wrap[] = { wr_field_wrap_u(job->like), wr_field_wrap_v(job->like) };
    const WrParamValue *origin = wr_param_value(&p, "origin");
    WrSheet sheet = { .z = NULL };
    Fractal *f = wr_alloc(1, sizeof *f);
    *f = (Fractal){ .type = wr_param_whole(&p, "type"),
                    .ratio = wr_param_number(&p, "ratio"),
                    .offset = wr_param_number(&p, "offset"),
                    .gain = wr_param_number(&p, "gain"),
                    .altitude = wr_param_number(&p, "altitude"),
                    .erosion = wr_param_number(&p, "erosion"),
                    .warp = wr_param_number(&p, "warp"),
                    .across = wr_origin(wr_field_width(job->like), origin->number[0]),
                    .up = wr_origin(wr_field_height(job->like), origin->number[1]),
                    .sheet = &sheet };
    f->slopes = f->erosion > 0.0;
    bool good = plan(f, &p, job, err) && wr_sheet_new(&sheet, wr_field_width(job->like),
                                                      wr_field_height(job->like), wrap, err);
    if (good) {
        for (int k = 0; k < f->octaves; k++) move(&f->octave[k], f);
        for (int a = 0; a < 2; a++) move(&f->bend[a], f);
        span(f);
        good = wr_sheet_run(&sheet, job, true, fill_rows, f, err);
    }
    if (good) {
        shape(&p, &sheet);
        good = wr_sheet_relief(&sheet, job, out, err);
    }
    wr_sheet_fini(&sheet);
    wr_free(f);
    return good;
}

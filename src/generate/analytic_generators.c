/* Analytic functions as heights: evaluated exactly at the texels' centres, then rounded to float. */
#include "field/analytic.h"

#include "base/error.h"
#include "base/memory.h"
#include "field/wrap.h"
#include "generate/tile_builder.h"
#include "generate/generator.h"

static const WrParamPart poly_parts[] = { { "i", 0, 64, true },
                                          { "j", 0, 64, true },
                                          { "a", -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, false } };
static const WrParamPart fourier_parts[] = { { "k", -16384, 16384, true },
                                             { "l", -16384, 16384, true },
                                             { "a", -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, false },
                                             { "phase_u", -1e6, 1e6, false },
                                             { "phase_v", -1e6, 1e6, false } };

static const WrParam poly_params[] = { { .name = "c",
                                         .label = "Terms",
                                         .help = "i,j,a: sum of a u^i v^j",
                                         .unit = "",
                                         .kind = WR_PARAM_TERMS,
                                         .components = 3,
                                         .shape = "i,j,a;...",
                                         .fewest = 3,
                                         .parts = poly_parts },
                                       WR_P_END };
static const WrParam fourier_params[] = {
    { .name = "terms",
      .label = "Terms",
      .help = "k,l,a: sum of a cos(2 pi k u + phase_u) cos(2 pi l v + phase_v); phases in degrees",
      .unit = "",
      .kind = WR_PARAM_TERMS,
      .components = 5,
      .shape = "k,l,a,phase_u,phase_v;...",
      .fewest = 3,
      .parts = fourier_parts },
    WR_P_END
};

/* Formulas are sampled at texel centres, u = (i + 1/2) / W and v = 1 - (j + 1/2) / H with rows from the top. */
static void fill(const void *ctx, const WrGenerateBlock *b, int worker, float *heights,
                 float *cover)
{
    (void)worker;
    (void)cover;
    for (int j = 0; j < b->count_j; j++)
        for (int i = 0; i < b->count_i; i++) {
            double f, u = (b->i + i + 0.5) / b->width, v = 1.0 - (b->j + j + 0.5) / b->height;
            wr_analytic_sample(ctx, u, v, &f, NULL, NULL);
            heights[j * WR_TILE + i] = (float)f;
        }
}

static bool make(WrAnalyticKind kind, const WrParam *param, const WrParamValue *value,
                 const WrGenerateJob *job, WrRelief *out, WrError *err)
{
    WrAnalytic analytic = { .kind = kind, .count = value->count };
    analytic.terms =
        wr_try_alloc((size_t)value->count, sizeof *analytic.terms, "terms of a formula", err);
    if (!analytic.terms) return false;
    for (int i = 0; i < value->count; i++) {
        const double *row = value->points + (size_t)i * (size_t)param->components;
        analytic.terms[i] = (WrAnalyticTerm){ .i = (int)row[0], .j = (int)row[1], .a = row[2] };
        if (kind == WR_ANALYTIC_FOURIER) {
            analytic.terms[i].phase_u_deg = row[3];
            analytic.terms[i].phase_v_deg = row[4];
        }
    }
    bool good = wr_generate_build(job, fill, &analytic, false, 0.0, out, err);
    wr_free(analytic.terms);
    return good;
}

static bool make_poly(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    return make(WR_ANALYTIC_POLY, poly_params, values, job, out, err);
}

static bool make_fourier(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                         WrError *err)
{
    return make(WR_ANALYTIC_FOURIER, fourier_params, values, job, out, err);
}

const WrGenerator wr_formula_rows[] = {
    WR_GENERATOR("formula", "poly", "Polynomial", "sum of a u^i v^j; it tiles only if the terms do",
                 "replace", poly_params, make_poly),
    WR_GENERATOR("formula", "fourier", "Fourier series",
                 "sum of a cos(2 pi k u + phase_u) cos(2 pi l v + phase_v)", "replace",
                 fourier_params, make_fourier),
    { .family = NULL },
};

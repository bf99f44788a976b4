/* analytic.h - F(u,v) as a formula with exact derivatives, usable wherever a table is. Source: Blinn
   1978 section 3, "a bivariate polynomial or bivariate Fourier series". */
#pragma once

typedef enum WrAnalyticKind {
    WR_ANALYTIC_OFF,
    WR_ANALYTIC_POLY,   /* sum of a u^i v^j */
    WR_ANALYTIC_FOURIER /* sum of a cos(2 pi k u + phase_u) cos(2 pi l v + phase_v) */
} WrAnalyticKind;

typedef struct WrAnalyticTerm {
    int i, j;                        /* poly: exponents 0..64; fourier: k, l, -16384..16384 */
    double a;                        /* amplitude, table units */
    double phase_u_deg, phase_v_deg; /* fourier only */
} WrAnalyticTerm;

typedef struct WrAnalytic {
    WrAnalyticKind kind;
    int count;
    WrAnalyticTerm *terms; /* [count], owned by the owner of the struct */
} WrAnalytic;

/* F, dF/du, dF/dv at (u, v); both coordinates are first reduced to [0,1) like a table's. In double with
 * deterministic functions: the same bits everywhere. Any output may be NULL. */
void wr_analytic_sample(const WrAnalytic *analytic, double u, double v, double *f, double *fu,
                        double *fv);
/* Upper bound of |F|: the sum of the terms' |amplitudes|. */
double wr_analytic_amplitude(const WrAnalytic *analytic);

/* stage_half_precision_body.h - rounding of intermediate results to half precision between stages. Part of
   pipeline_body.h. */

static void keep_half(REAL *x, int count)
{
#pragma omp simd
    for (int i = 0; i < count; i++) x[i] = (REAL)wr_round_half((float)x[i]);
}

static void keep_half3(const WrTileJob *job, REAL *x, REAL *y, REAL *z, int count, Watch *watch)
{
    if (!runs(job, WR_EFFECT_HALF)) return;
    keep_half(x, count);
    keep_half(y, count);
    keep_half(z, count);
    did(watch, WR_EFFECT_HALF);
    watch_lap(watch, WR_STAGE_HALF);
}

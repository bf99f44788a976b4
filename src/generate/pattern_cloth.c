/* Patterns of threads: weave and rope. */
#include "base/error.h"
#include "base/exactmath.h"
#include "generate/pattern.h"

#include <math.h>

/* ---- weave ---- */

#define DRAFTS(X) X(PLAIN, "plain") X(TWILL, "twill") X(BASKET, "basket") X(SATIN, "satin")
typedef enum Draft { DRAFTS(WR_WORD_ID) } Draft;
static const char *const drafts[] = { DRAFTS(WR_WORD) NULL };

/* Period of a draft in threads, along both axes. */
WR_ROWS(repeats);
static const int repeats[] = {
    [WR_ROW(PLAIN)] = 2, [WR_ROW(TWILL)] = 4, [WR_ROW(BASKET)] = 4, [WR_ROW(SATIN)] = 5
};
WR_ROWS_END(repeats, WR_LENGTH(drafts) - 1);

const WrParam wr_params_weave[] = {
    WR_P_WHOLE("across", "Across", 20, 1, WR_CELLS_MAX, 64, "upright threads (the warp)"),
    WR_P_WHOLE("rows", "Rows", 20, 1, WR_CELLS_MAX, 64, "level threads (the weft)"),
    WR_P_CHOICE("draft", "Draft", PLAIN, drafts,
                "weave, which decides the thread that lies on top"),
    WR_P_PART("width", "Width", 0.88, "width of the threads, relative to their distance"),
    WR_P_PART("round", "Roundness", 0.45, "roundness of the threads, as a share of the height"),
    WR_P_PART("fibre", "Fibres", 0.08, "depth of the twisted fibres, as a share of the height"),
    WR_P_WHOLE("turns", "Turns", 3, 0, 32, 8, "turns of the fibres between two crossings"),
    WR_P_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Weave {
    WrCells cells;
    Draft draft;
    double width, round, fibre;
    int turns;
} Weave;

/* True if the vertical thread i is above the horizontal thread j. */
static bool warp_on_top(Draft draft, int i, int j)
{
    switch (draft) {
    case PLAIN: return wr_modulo(i + j, 2) == 0;
    case TWILL: return wr_modulo(i + j, 4) < 2;
    case BASKET: return wr_modulo(i >> 1, 2) == wr_modulo(j >> 1, 2);
    /* A 5-end satin moves by 2 threads per row: no two binding points touch, unlike in a twill, which moves by 1. */
    case SATIN: return wr_modulo(i + 2 * j, 5) == 0;
    }
    return false;
}

/* 0..1: height of a thread's middle at `along` threads along it; the crossings are at 1/2, 3/2. */
static double course(const Weave *w, int own, double along, bool warp)
{
    double place = along - 0.5;
    int k = (int)floor(place);
    double t = place - k;
    bool from = warp ? warp_on_top(w->draft, own, k) : !warp_on_top(w->draft, k, own);
    bool to = warp ? warp_on_top(w->draft, own, k + 1) : !warp_on_top(w->draft, k + 1, own);
    double rise = t * t * (3.0 - 2.0 * t);
    return from + ((double)to - from) * rise;
}

/* A thread's height at `across` from its middle (-1/2..1/2 of the distance of threads); 0 beside it. */
static double thread(const Weave *w, int own, double across, double along, bool warp)
{
    double s = 2.0 * across / (w->width > 0.0 ? w->width : 1e-9);
    if (s * s >= 1.0) return 0.0;
    double bow = sqrt(1.0 - s * s), h = (1.0 - w->round) * course(w, own, along, warp);
    if (w->fibre > 0.0) h -= w->fibre * (0.5 + 0.5 * wr_ripple(w->turns * along + 0.6 * s)) * bow;
    return (h > 0.0 ? h : 0.0) * (0.5 + 0.5 * bow) + w->round * bow;
}

static double weave_at(const void *ctx, double x, double y)
{
    const Weave *w = ctx;
    double u = x / w->cells.cell_width, v = y / w->cells.cell_height;
    int i = (int)floor(u), j = (int)floor(v);
    double warp = thread(w, i, u - i - 0.5, v, true), weft = thread(w, j, v - j - 0.5, u, false);
    return warp > weft ? warp : weft;
}

bool wr_pattern_weave(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams params = { wr_params_weave, values };
    Weave w = { .cells = wr_cells_of(&params, job->like),
                .draft = (Draft)wr_param_whole(&params, "draft"),
                .width = wr_param_number(&params, "width"),
                .round = wr_param_number(&params, "round"),
                .fibre = wr_param_number(&params, "fibre"),
                .turns = wr_param_whole(&params, "turns") };
    int repeat = repeats[w.draft];
    bool across = w.cells.across % repeat != 0;
    if (across || w.cells.rows % repeat != 0)
        return wr_fail(err,
                       "pattern weave: %s=%d: must be a multiple of %d, or draft=%s does not tile",
                       across ? "across" : "rows", across ? w.cells.across : w.cells.rows, repeat,
                       drafts[w.draft]);
    return wr_pattern_make(&params, job, weave_at, &w, WR_PATTERN_SAMPLES, out, err);
}

/* ---- rope ---- */

const WrParam wr_params_rope[] = {
    WR_P_WHOLE("across", "Across", 14, 1, WR_CELLS_MAX, 32, "strands along each rope"),
    WR_P_WHOLE("rows", "Rows", 6, 1, WR_CELLS_MAX, 32, "ropes side by side"),
    WR_P_ALONG,
    WR_P_PART("width", "Width", 0.94, "width of a rope, relative to the distance of ropes"),
    WR_P_NUMBER("lay", "Lay", 1.8, -8, 8, 4, "",
                "lay: number of strands over which one strand crosses the rope"),
    WR_P_PART("groove", "Grooves", 0.45,
              "depth of the grooves between strands, as a share of the height"),
    WR_P_PART("fibre", "Fibres", 0.06, "depth of the fibres, as a share of the height"),
    WR_P_HEIGHT,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Rope {
    WrCells cells;
    double width, lay, groove, fibre;
} Rope;

/* The position on the rope's surface uses the angle about its axis, so strands are steeper towards the
 * sides. */
static double rope_at(const void *ctx, double x, double y)
{
    const Rope *r = ctx;
    wr_cells_turn(&r->cells, &x, &y);
    double v = y / r->cells.cell_height;
    double s = 2.0 * (v - floor(v) - 0.5) / (r->width > 0.0 ? r->width : 1e-9);
    if (s * s >= 1.0) return 0.0;
    double bow = sqrt(1.0 - s * s), angle = wr_asin(s) / WR_PI; /* -1/2..1/2 */
    double strand = x / r->cells.cell_width + r->lay * angle;
    double q = 2.0 * (strand - floor(strand)) - 1.0;
    double bulge = sqrt(1.0 - q * q), ripple = wr_ripple(5.0 * strand - 3.0 * r->lay * angle);
    double h = 1.0 - r->groove * (1.0 - bulge) - r->fibre * bulge * (0.5 + 0.5 * ripple);
    return bow * h;
}

bool wr_pattern_rope(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                     WrError *err)
{
    const WrParams params = { wr_params_rope, values };
    Rope r = { .cells = wr_cells_directed(&params, job->like),
               .width = wr_param_number(&params, "width"),
               .lay = wr_param_number(&params, "lay"),
               .groove = wr_param_number(&params, "groove"),
               .fibre = wr_param_number(&params, "fibre") };
    return wr_pattern_make(&params, job, rope_at, &r, WR_PATTERN_SAMPLES, out, err);
}

/* Bump slopes: a height, its two slopes and their products, per texel, on every mip level down to one texel.
   Levels above 0 are means of the texels they cover, so that moments of slopes stay moments. */
#include "export/mip_files.h"
#include "field/scheme_list.h"

#include "base/memory.h"
#include "export/job.h"
#include "export/normal_kern.h"
#include "field/analytic.h"
#include "field/field.h"
#include "field/scheme.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

#define CHANNELS WR_LEVEL_CHANNELS
#define APRON 1
#define HIGHEST 3e38f
#define STEEPEST                                                                                   \
    0x1p63 /* limit of a slope: its square, and a sum of squares, fit in a float (HC142) */

/* Factors from slopes to slopes per texel, to the right and downwards. Plain: height per texel. With uvslopes = k, height per
   cell and k, so the numbers of a map do not depend on its resolution (RenderMan's txmake, OpenImageIO's uvslopes_scale). */
typedef struct Factors {
    double s, t;
} Factors;

static Factors factors_of(const WrExportJob *job)
{
    const double sign = job->options.renderman ? -1.0 : 1.0, k = job->options.uvslopes;
    return (Factors){ k > 0.0 ? sign * job->width / k : sign,
                      k > 0.0 ? sign * job->height / k : sign };
}

static double limited(double slope, bool *bad)
{
    if (fabs(slope) <= STEEPEST) return slope;
    *bad = true;
    return isnan(slope) ? 0.0 : copysign(STEEPEST, slope);
}

/* Stores one texel's channels; returns 1 if a number had to be replaced. Channels: h, h_s, h_t, h_s^2, h_t^2, h_s h_t. Their
   means over a box are the moments from which LEAN derives the covariance of slopes, Sigma = E[s s^T] - E[s] E[s]^T. */
static inline int64_t put(double f, double s, double t, float *restrict out)
{
    bool bad = !(fabs(f) <= (double)HIGHEST);
    s = limited(s, &bad), t = limited(t, &bad);
    out[0] = fabs(f) <= (double)HIGHEST ? (float)f : 0.0f;
    out[1] = (float)s, out[2] = (float)t;
    out[3] = (float)(s * s), out[4] = (float)(t * t), out[5] = (float)(s * t);
    return bad;
}

/* ---- tables: the taps, processed by columns that stay in the first-level cache ---- */

typedef struct Piece {
    const WrExportJob *job;
    const WrNormalKernels *kernels;
    WrNormalJob slopes; /* per texel */
    Factors factors;
    float *out; /* output of row `y` */
    int y, rows;
    int64_t replaced;
} Piece;

/* The spline's value at its middle tap. (1 4 1)/6 along both axes: the B-spline's value at a knot is a smoothed height, not
   the texel's. */
static double spline_at(const double *at, ptrdiff_t pitch)
{
    const double above = at[-pitch - 1] + 4.0 * at[-pitch] + at[1 - pitch];
    const double here = at[-1] + 4.0 * at[0] + at[1];
    const double below = at[pitch - 1] + 4.0 * at[pitch] + at[pitch + 1];
    return (above + 4.0 * here + below) / 36.0;
}

/* Stores texels [x, x + count) of row j. at: taps; heights: NULL if they follow from the spline of the taps. */
static void put_run(Piece *piece, int x, int count, int j, const double *at, ptrdiff_t pitch,
                    const float *heights)
{
    /* t points down, the job's v up */
    const double right = piece->factors.s, down = -piece->factors.t;
    double s[WR_NORMAL_STRIP], t[WR_NORMAL_STRIP];
    float spline[WR_NORMAL_STRIP];
    float *out = piece->out + ((size_t)j * (size_t)piece->job->width + (size_t)x) * CHANNELS;
    piece->kernels->tilts(&piece->slopes, at, pitch, count, s, t);
    for (int i = 0; i < count; i++) s[i] *= right, t[i] *= down;
    for (int i = 0; i < count && !heights; i++) spline[i] = (float)spline_at(at + i, pitch);
    const float *f = heights ? heights : spline;
    if (piece->kernels->moments(f, s, t, count, HIGHEST, STEEPEST, out)) return;
    for (int i = 0; i < count; i++)
        piece->replaced += put((double)f[i], s[i], t[i], out + (size_t)i * CHANNELS);
}

static int run_length(const Piece *piece, int x)
{
    const int left = piece->job->width - x;
    return left < WR_NORMAL_STRIP ? left : WR_NORMAL_STRIP;
}

static void table_rows(Piece *piece)
{
    enum { PITCH = WR_NORMAL_STRIP + 2 * APRON, TALL = WR_EXPORT_PIECE_ROWS + 2 * APRON };
    const bool smoothed = piece->job->options.scheme == WR_SCHEME_BSPLINE;
    float texels[PITCH * TALL];
    double taps[PITCH * TALL];
    for (int x = 0; x < piece->job->width; x += WR_NORMAL_STRIP) {
        const int count = run_length(piece, x);
        wr_field_read(piece->job->field, x - APRON, piece->y - APRON, count + 2 * APRON,
                      piece->rows + 2 * APRON, texels, PITCH);
        for (int j = 0; j < piece->rows + 2 * APRON; j++)
            piece->kernels->widen(texels + j * PITCH, count + 2 * APRON, taps + j * PITCH);
        for (int j = 0; j < piece->rows; j++) {
            const int at = (j + APRON) * PITCH + APRON;
            put_run(piece, x, count, j, taps + at, PITCH, smoothed ? NULL : texels + at);
        }
    }
}

/* Coefficients are not rounded to float; the spline through the samples has their heights. */
static void fitted_rows(Piece *piece)
{
    const size_t width = (size_t)piece->job->width, pitch = width + 2 * APRON;
    const int tall = piece->rows + 2 * APRON;
    double *taps = wr_alloc_unset(pitch * (size_t)tall, sizeof *taps);
    float *row = wr_alloc_unset(width, sizeof *row);
    wr_field_read_bspline_coefficients_double(piece->job->field, -APRON, piece->y - APRON,
                                              (int)pitch, tall, taps, pitch);
    for (int j = 0; j < piece->rows; j++) {
        wr_field_read(piece->job->field, 0, piece->y + j, (int)width, 1, row, width);
        for (int x = 0; x < (int)width; x += WR_NORMAL_STRIP)
            put_run(piece, x, run_length(piece, x), j,
                    taps + (size_t)(j + APRON) * pitch + (size_t)(x + APRON), (ptrdiff_t)pitch,
                    row + x);
    }
    wr_free(row);
    wr_free(taps);
}

static void formula_rows(Piece *piece)
{
    const WrExportJob *job = piece->job;
    float *out = piece->out;
    for (int j = 0; j < piece->rows; j++)
        for (int i = 0; i < job->width; i++, out += CHANNELS) {
            double f, fu, fv;
            wr_analytic_sample(&job->scene->analytic, job->u[i], wr_export_row_v(job, piece->y + j),
                               &f, &fu, &fv);
            piece->replaced += put(f, piece->factors.s * (fu / job->width),
                                   piece->factors.t * (-fv / job->height), out);
        }
}

/* Computes rows [y, y + rows), at most WR_EXPORT_PIECE_ROWS; returns the number of replaced values. */
static int64_t make_rows(const WrExportJob *job, int y, int rows, float *out)
{
    Piece piece = { .job = job,
                    .kernels = wr_normal_kernels(),
                    .slopes = { .stencil = wr_normal_stencil(job->options.scheme),
                                .height = -1,
                                .cell_w = 1,
                                .cell_h = 1,
                                .width = 1,
                                .rows = 1 },
                    .factors = factors_of(job),
                    .out = out,
                    .y = y,
                    .rows = rows };
    if (job->analytic) formula_rows(&piece);
    else if (wr_schemes[job->options.scheme].taps == WR_TAPS_FITTED) fitted_rows(&piece);
    else table_rows(&piece);
    return piece.replaced;
}

/* ---- export kind ---- */

typedef struct Strip {
    int y;
    float *out;
} Strip;

static void strip_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const Strip *strip = ctx;
    float *out = strip->out + (size_t)(y - strip->y) * (size_t)job->width * CHANNELS;
    const int64_t replaced = make_rows(job, y, rows, out);
    __atomic_fetch_add(&job->report.replaced, replaced, __ATOMIC_RELAXED);
}

void wr_export_bump_slopes_rows(WrExportJob *job, int y, int rows, void *out)
{
    Strip strip = { y, out };
    wr_export_run(job, y, rows, strip_piece, &strip);
}

void wr_export_bump_slopes_level(void *ctx, int y, int rows, float *out)
{
    const WrExportJob *job = ctx;
    const size_t row = (size_t)job->width * CHANNELS;
    for (int done = 0; done < rows; done += WR_EXPORT_PIECE_ROWS) {
        const int left = rows - done;
        make_rows(job, y + done, left < WR_EXPORT_PIECE_ROWS ? left : WR_EXPORT_PIECE_ROWS,
                  out + (size_t)done * row);
    }
}

void wr_export_bump_slopes_describe(WrExportJob *job)
{
    const bool u = wr_field_wrap_u(job->field) == WR_WRAP_CLAMP;
    const bool v = wr_field_wrap_v(job->field) == WR_WRAP_CLAMP;
    wr_text_addf(wr_export_attribute(job, "wrapmodes"), "%s,%s", u ? "clamp" : "periodic",
                 v ? "clamp" : "periodic");
    wr_text_add(wr_export_attribute(job, "wrinkle:signs"),
                job->options.renderman ? "renderman" : "plain");
    wr_export_describe_slopes(job);
}

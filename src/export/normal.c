#include "base/error.h"
#include "base/memory.h"
#include "base/vec.h"
#include "export/job.h"
#include "export/normal_kern.h"
#include "field/analytic.h"
#include "field/field.h"
#include "field/scheme.h"
#include "field/scheme_list.h"
#include "scene/scene.h"
#include "scene/texture_sample.h"
#include "shade/bump.h"
#include "surface/surface.h"

#include <math.h>
#include <stdalign.h>
#include <stdlib.h>
#include <string.h>

/* ---- Object-space normals: the scene's surface bent by its bump, at each texel's centre ---- */

/* Slopes come from wr_scene_slopes, as in rendering: by the scene's scheme, replicated. */
static WrVec3 normal_at(const WrExportJob *job, double u, double v)
{
    const WrScene *scene = job->scene;
    WrSurfacePoint p;
    double f, fu, fv;
    wr_surface_at(&scene->shape, 0, u, v, &p);
    wr_scene_slopes(scene, job->field, &p, u, v, &f, &fu, &fv);
    return wr_bump_unit_normal(scene->bump, p.n, p.n_unit, p.pu, p.pv, p.n_u, p.n_v, f, fu, fv);
}

static void piece(WrExportJob *job, int y, int rows, void *ctx)
{
    const WrExportStrip *strip = ctx;
    for (int j = y; j < y + rows; j++)
        for (int i = 0; i < job->width; i++)
            wr_export_store_normal(job, strip->out,
                                   (size_t)(j - strip->y) * (size_t)job->width + (size_t)i,
                                   normal_at(job, job->u[i], wr_export_row_v(job, j)), i, j);
}

void wr_export_object_rows(WrExportJob *job, int y, int rows, void *out)
{
    WrExportStrip strip = { y, out };
    wr_export_run(job, y, rows, piece, &strip);
}

bool wr_export_object_check(const WrScene *scene, WrError *err)
{
    const WrSurfaceInfo *info = wr_surfaces[scene->shape.kind];
    if (info->faces > 1 || info->inversion == WR_INVERT_TRIANGLES)
        return wr_fail(err,
                       "surface %s: object-space normals need a surface with one point for each "
                       "(u,v): no mesh, patches, terrain or cube",
                       info->name);
    return true;
}

void wr_export_object_describe(WrExportJob *job)
{
    wr_text_add(wr_export_attribute(job, "wrinkle:space"), "object");
    wr_export_describe_axes(job);
}

/* Slopes at texel centres. There every scheme's derivative is a fixed stencil of table entries (scheme.h, with x
   and y whole numbers), in texels, rows downwards:
     nearest, central, catmull   (T[i+1] - T[i-1]) / 2
     bilinear                    T[i+1] - T[i], the cell that begins at the centre
     bspline, bspline-fit        (c[i+1] - c[i-1]) / 2, averaged across by 1/6, 4/6, 1/6
   So no position is rounded and no branch depends on one. dF/dV = -H * (slope downwards). */

#define APRON 1

/* normalise(x, y, 1) of x = -height Fu / cell_w, y = -height Fv / cell_h; straight up and counted if one is not
   finite. */
static WrVec3 normal_of(double x, double y, int64_t *replaced)
{
    WrVec3 n = { x, y, 1.0 }, up = { 0.0, 0.0, 1.0 };
    if (!isfinite(x) || !isfinite(y)) {
        ++*replaced;
        return up;
    }
    if (x == 0.0 && y == 0.0) return up;
    return v3_unit(n, up);
}

void wr_export_store_normal(const WrExportJob *job, void *out, size_t texel, WrVec3 n, int column,
                            int row)
{
    const double component[3] = { n.x, n.y, n.z };
    for (int c = 0; c < 3; c++) {
        /* axes[c] = +-(1 + component): channel c holds component |axes[c]| - 1 with its sign. */
        const int axis = job->options.axes[c];
        const double own = axis < 0 ? -component[-axis - 1] : component[axis - 1];
        /* n/2 + 1/2 of -1..1 over codes 0..last: 0 lies between two codes, at 127.5, so a flat 8-bit map reads (128,128,255),
           tilted by 0.32 degrees (NUMERICS.md L3). All common readers expect this coding. */
        const double value = own / 2.0 + 0.5;
        size_t i = 3 * texel + (size_t)c;
        if (job->options.depth == 32) ((float *)out)[i] = (float)value;
        else
            wr_export_store_code(job, out, i, wr_export_last_code(job) * value, 0,
                                 (WrExportTexel){ column, row, c });
    }
}

/* 1 if the components are x, y, z, -1 if they are x, -y, z, else 0. */
static int sign_of_green(const WrExportJob *job)
{
    const int *axes = job->options.axes;
    return axes[0] == 1 && abs(axes[1]) == 2 && axes[2] == 3 ? axes[1] / 2 : 0;
}

typedef struct Strip {
    int y;
    void *out;
} Strip;

WrNormalStencil wr_normal_stencil(int scheme)
{
    switch ((WrSchemeId)((WrScheme)scheme)) {
    case WR_SCHEME_BSPLINE:
    case WR_SCHEME_BSPLINE_FIT: return WR_STENCIL_SPLINE;
    case WR_SCHEME_BILINEAR: return WR_STENCIL_FORWARD;
    case WR_SCHEME_NEAREST:
    case WR_SCHEME_CENTRAL:
    case WR_SCHEME_CATMULL:
    case WR_SCHEME_COUNT: break;
    }
    return WR_STENCIL_CENTRAL;
}

/* State of a piece of the table's rows. */
typedef struct Piece {
    WrExportJob *job;
    WrNormalJob normal;
    const WrNormalKernels *kernels;
    const Strip *strip;
    int y, rows;
    int64_t replaced;
} Piece;

/* Texels x .. x + count - 1 of the piece's row j; at: the first one's tap. Extreme slopes, and dithered codes,
   are processed one by one. */
static void finish_run(Piece *piece, int x, int count, int j, const double *at, size_t pitch)
{
    const WrExportJob *job = piece->job;
    const WrNormalKernels *kernels = piece->kernels;
    double tx[WR_NORMAL_STRIP], ty[WR_NORMAL_STRIP];
    size_t texel = (size_t)(piece->y - piece->strip->y + j) * (size_t)job->width + (size_t)x;
    void *out = piece->strip->out;
    bool plain = kernels->tilts(&piece->normal, at, (ptrdiff_t)pitch, count, tx, ty);
    if (!plain || job->options.dither || !sign_of_green(job)) {
        for (int i = 0; i < count; i++)
            wr_export_store_normal(job, out, texel + (size_t)i,
                                   normal_of(tx[i], ty[i], &piece->replaced), x + i, piece->y + j);
        return;
    }
    switch (job->options.depth) {
    case 8: kernels->codes8(&piece->normal, tx, ty, count, (uint8_t *)out + 3 * texel); break;
    case 16: kernels->codes16(&piece->normal, tx, ty, count, (uint16_t *)out + 3 * texel); break;
    default: kernels->floats(&piece->normal, tx, ty, count, (float *)out + 3 * texel); break;
    }
}

static int run_length(const WrExportJob *job, int x)
{
    return job->width - x < WR_NORMAL_STRIP ? job->width - x : WR_NORMAL_STRIP;
}

/* True if codes may first be computed from heights in single precision. */
static bool is_quick(const Piece *piece)
{
    const WrExportJob *job = piece->job;
    return job->options.depth == 8 && !job->options.dither && sign_of_green(job) &&
           piece->normal.stencil != WR_STENCIL_SPLINE;
}

/* Row j of a run, whose first texel's height is `at`: single precision first, then exactly for the codes in
   doubt. */
static void quick_run(Piece *piece, int x, int count, int j, const float *at, size_t pitch)
{
    enum { TAPS = WR_NORMAL_BLOCK + 2 * APRON };
    size_t texel = (size_t)(piece->y - piece->strip->y + j) * (size_t)piece->job->width + (size_t)x;
    uint32_t doubtful = piece->kernels->nearly8(&piece->normal, at, (ptrdiff_t)pitch, count,
                                                (uint8_t *)piece->strip->out + 3 * texel);
    if (count % WR_NORMAL_BLOCK) doubtful |= 1u << count / WR_NORMAL_BLOCK;
    for (int b = 0; doubtful >> b; b++) {
        double taps[3][TAPS];
        int first = b * WR_NORMAL_BLOCK, left = count - first;
        if (!(doubtful >> b & 1)) continue;
        int texels = left < WR_NORMAL_BLOCK ? left : WR_NORMAL_BLOCK;
        const float *rows = at - pitch + first - APRON;
        for (int k = 0; k < 3; k++)
            piece->kernels->widen(rows + (size_t)k * pitch, texels + 2 * APRON, taps[k]);
        finish_run(piece, x + first, texels, j, &taps[1][APRON], TAPS);
    }
}

/* Prefetches the next row of a run that begins at x while row j is computed; also the row before the first and
   the rows after the last. */
static void expect_row(const Piece *piece, int x, int j)
{
    const int first = j == 0 ? -APRON : j, end = j + 1 == piece->rows ? j + 1 + APRON : j + 1;
    for (int k = first; k < end; k++)
        wr_field_expect(piece->job->field, x, piece->y + k, WR_NORMAL_STRIP + WR_TILE / 4);
}

/* The taps are heights: processed in runs of columns, so that they stay in the first-level cache. */
static void table_rows(Piece *piece)
{
    enum {
        BEFORE = WR_ALIGN / sizeof(float), /* aligns the start of rows with cache lines */
        PITCH = WR_NORMAL_STRIP + 2 * BEFORE,
        TALL = WR_EXPORT_PIECE_ROWS + 2 * APRON
    };
    /* texels[j][BEFORE + i] is texel (x + i, y - APRON + j): BEFORE floats precede it, so that the run itself begins on a
       cache line and its left apron ends the line before. */
    alignas(WR_ALIGN) float texels[PITCH * TALL];
    double taps[PITCH * TALL];
    const bool quick = is_quick(piece);
    for (int x = 0; x < piece->job->width; x += WR_NORMAL_STRIP) {
        int count = run_length(piece->job, x);
        wr_field_read(piece->job->field, x - APRON, piece->y - APRON, count + 2 * APRON,
                      piece->rows + 2 * APRON, texels + BEFORE - APRON, PITCH);
        for (int j = 0; quick && j < piece->rows; j++) {
            expect_row(piece, x + WR_NORMAL_STRIP, j);
            quick_run(piece, x, count, j, texels + (j + APRON) * PITCH + BEFORE, PITCH);
        }
        if (quick) continue;
        for (int j = 0; j < piece->rows + 2 * APRON; j++)
            piece->kernels->widen(texels + j * PITCH + BEFORE - APRON, count + 2 * APRON,
                                  taps + j * PITCH);
        for (int j = 0; j < piece->rows; j++)
            finish_run(piece, x, count, j, taps + (j + APRON) * PITCH + APRON, PITCH);
    }
}

/* The taps are coefficients in double: rounding them at a high level would lose the slopes. */
static void fitted_rows(Piece *piece)
{
    size_t pitch = (size_t)piece->job->width + 2 * APRON;
    int tall = piece->rows + 2 * APRON;
    double *taps = wr_alloc_unset(pitch * (size_t)tall, sizeof *taps);
    wr_field_read_bspline_coefficients_double(piece->job->field, -APRON, piece->y - APRON,
                                              (int)pitch, tall, taps, pitch);
    for (int j = 0; j < piece->rows; j++)
        for (int x = 0; x < piece->job->width; x += WR_NORMAL_STRIP)
            finish_run(piece, x, run_length(piece->job, x), j,
                       taps + (size_t)(j + APRON) * pitch + (size_t)(x + APRON), pitch);
    wr_free(taps);
}

static void table_piece(WrExportJob *job, int y, int rows, const Strip *strip, int64_t *replaced)
{
    Piece piece = { .job = job,
                    .normal = { .stencil = wr_normal_stencil(job->options.scheme),
                                .height = job->options.strength * job->scene->height,
                                .cell_w = job->options.cell_w,
                                .cell_h = job->options.cell_h,
                                .width = job->width,
                                .rows = job->height,
                                .last = wr_export_last_code(job),
                                .green = sign_of_green(job) },
                    .kernels = wr_normal_kernels(),
                    .strip = strip,
                    .y = y,
                    .rows = rows };
    bool fitted = wr_schemes[job->options.scheme].taps == WR_TAPS_FITTED;
    (fitted ? fitted_rows : table_rows)(&piece);
    *replaced += piece.replaced;
}

/* Formulas, and samples that are not at texels' centres. */
static void sampled_rows(WrExportJob *job, int y, int rows, const Strip *strip, int64_t *replaced)
{
    for (int j = 0; j < rows; j++) {
        double v = wr_export_row_v(job, y + j);
        for (int i = 0; i < job->width; i++) {
            double fu, fv;
            if (job->analytic)
                wr_analytic_sample(&job->scene->analytic, job->u[i], v, NULL, &fu, &fv);
            else
                wr_field_sample(job->field, (WrScheme)job->options.scheme, 1, &job->u[i], &v, NULL,
                                &fu, &fv);
            double height = job->options.strength * job->scene->height;
            WrVec3 n = normal_of(-height * fu / job->options.cell_w,
                                 -height * fv / job->options.cell_h, replaced);
            wr_export_store_normal(job, strip->out,
                                   (size_t)(y - strip->y + j) * (size_t)job->width + (size_t)i, n,
                                   i, y + j);
        }
    }
}

static void normal_piece(WrExportJob *job, int y, int rows, void *ctx)
{
    int64_t replaced = 0;
    if (job->analytic || job->options.border) sampled_rows(job, y, rows, ctx, &replaced);
    else table_piece(job, y, rows, ctx, &replaced);
    __atomic_fetch_add(&job->report.replaced, replaced, __ATOMIC_RELAXED);
}

void wr_export_normal_rows(WrExportJob *job, int y, int rows, void *out)
{
    Strip strip = { y, out };
    wr_export_run(job, y, rows, normal_piece, &strip);
}

/* ---- axes ---- */

bool wr_export_axes_parse(const char *text, int axes[3])
{
    int seen = 0;
    if (strcmp(text, "opengl") == 0) text = "+x+y+z";
    if (strcmp(text, "directx") == 0) text = "+x-y+z";
    for (int c = 0; c < 3; c++) {
        const char sign = text[2 * c], letter = sign ? text[2 * c + 1] : '\0';
        if ((sign != '+' && sign != '-') || letter < 'x' || letter > 'z') return false;
        axes[c] = (sign == '-' ? -1 : 1) * (letter - 'x' + 1);
        seen |= 1 << (letter - 'x');
    }
    return text[6] == '\0' && seen == 7;
}

void wr_export_axes_text(const int axes[3], char text[7])
{
    for (int c = 0; c < 3; c++) {
        text[2 * c] = axes[c] < 0 ? '-' : '+';
        text[2 * c + 1] = (char)('x' + abs(axes[c]) - 1);
    }
    text[6] = '\0';
}

void wr_export_describe_axes(WrExportJob *job)
{
    char text[7];
    const int green = sign_of_green(job);
    wr_export_axes_text(job->options.axes, text);
    if (!green) wr_text_add(wr_export_attribute(job, "wrinkle:axes"), text);
    else wr_text_add(wr_export_attribute(job, "wrinkle:convention"), green > 0 ? "+Y" : "-Y");
}

void wr_export_normal_describe(WrExportJob *job)
{
    wr_export_describe_axes(job);
    wr_export_describe_slopes(job);
}

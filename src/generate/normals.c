#include "generate/normals.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"
#include "generate/picture.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

/* Decodes slopes: the first two channels times these factors, to the right and down. */
static bool normals_from_slopes(const WrImage *image, double right, double down, WrNormals *out,
                                WrError *err);

/* ---- The generator row of heights from a normal map ---- */

#define SURE 0.2 /* correlation of the curl below which a sign is reported as a guess */

#define YS(X) X(Y_AUTO, "auto") X(Y_UP, "up") X(Y_DOWN, "down")
#define EDGES(X) X(EDGES_AUTO, "auto") X(EDGES_PERIODIC, "periodic") X(EDGES_FREE, "free")
#define SLOPES(X) X(SLOPES_AUTO, "auto") X(SLOPES_SMOOTH, "smooth") X(SLOPES_CENTRAL, "central")
enum { YS(WR_WORD_ID) };
enum { EDGES(WR_WORD_ID) };
enum { SLOPES(WR_WORD_ID) };
static const char *const ys[] = { YS(WR_WORD) NULL };
static const char *const edges[] = { EDGES(WR_WORD) NULL };
static const char *const ways[] = { SLOPES(WR_WORD) NULL };
static const char *const codes[] = { WR_NORMAL_CODES(WR_WORD) NULL };

const WrParam wr_params_normals[] = {
    WR_P_FILE("a normal map"),
    WR_P_CHANNELS("layer", "channel"),
    WR_P_CHOICE("y", "Green", Y_AUTO, ys,
                "direction of green: up (+Y), down (-Y), or auto: detected from the map"),
    WR_P_CHOICE("edges", "Edges", EDGES_AUTO, edges,
                "edges of the map: periodic or not; auto: as the table"),
    WR_P_CHOICE("slopes", "Slopes", SLOPES_AUTO, ways,
                "kind of slopes. smooth: of a smooth surface; central: central differences between "
                "texels, as many tools write; auto: the one that fits the map better"),
    WR_P_CHOICE("codes", "Codes", WR_NORMALS_AUTO, codes,
                "slopes, bump-slopes: the picture stores these, not normals; unsigned, signed: old "
                "names of coding="),
    WR_P_CHOICE("coding", "Coding", WR_CODING_AUTO, wr_codings,
                "coding of float pictures. unit: 0..1 stands for -1..1; signed: the vectors "
                "themselves; auto: the one whose vectors are nearer to length 1"),
    { .name = "cell",
      .label = "Cell",
      .help = "size of the map in scene units, as in export",
      .unit = "",
      .kind = WR_PARAM_TUPLE,
      .components = 2,
      .shape = "w,h",
      .fallback = { 1, 1 },
      .low = 0,
      .above = true,
      .high = 1e9,
      .soft_low = 0,
      .soft_high = 4 },
    WR_P_ABOVE("height", "Height", 1, 0, 1e9, 1, "scene units",
               "height of one table unit, as in `bump`"),
    WR_P_NUMBER("level", "Level", 0, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "level of the lowest place"),
    WR_P_END
};

/* Determines the sign of green, and reports it with its certainty. */
static void settle_green(const WrParams *p, WrNormals *normals, const WrGenerateJob *job)
{
    int y = wr_param_whole(p, "y");
    double r = wr_normals_upward(normals);
    bool down = y == Y_DOWN || (y == Y_AUTO && r <= -SURE);
    const char *name = down ? "down (-Y)" : "up (+Y)";
    if (down) wr_normals_flip(normals);
    if (y == Y_AUTO && fabs(r) >= SURE)
        wr_generate_note(job, "green points %s: so its curl agrees to %.0f%%", name,
                         100.0 * fabs(r));
    else if (y == Y_AUTO)
        wr_generate_note(job,
                         "the map does not tell whether green points up or down (its curl agrees "
                         "to %.0f%% either way): taken as up; y=down if bumps come out wrong",
                         100.0 * fabs(r));
    else if (down ? r > SURE : r < -SURE)
        wr_generate_note(
            job, "green is read as %s as requested, but the curl suggests the opposite", name);
}

static void say(const WrNormals *n, const WrIntegral *how, const WrGenerateJob *job)
{
    long long count = (long long)n->width * n->height;
    if (n->unknown > 0)
        wr_generate_note(job, "%lld normals of %lld do not face up: taken as flat",
                         (long long)n->unknown, count);
    if (n->steep > 0)
        wr_generate_note(job, "%lld slopes of %lld were brought down to 100", (long long)n->steep,
                         count);
    if (fabs(how->tilt_deg[0]) > 0.05 || fabs(how->tilt_deg[1]) > 0.05)
        wr_generate_note(job,
                         "the map leans by %.2f degrees to the right and %.2f down, which nothing "
                         "that meets itself can: left out",
                         how->tilt_deg[0], how->tilt_deg[1]);
    wr_generate_note(job, "its normals differ from the heights' own by %.2f degrees (rms)",
                     how->residual_deg);
}

/* ratio to the smooth surface's angle below which the map is assumed to come from central
 * differences */
#define BETTER 0.7

/* Integrates with the requested slope definition, or the one with the smaller residual. */
static bool integrate(int slopes, const WrNormals *n, WrIntegral *how, const WrGenerateJob *job,
                      WrSheet *sheet, WrError *err)
{
    how->central = slopes == SLOPES_CENTRAL;
    if (!wr_normals_integrate(n, how, job, sheet, err)) return false;
    bool ring = how->ends[0] == WR_ENDS_RING || how->ends[1] == WR_ENDS_RING;
    if (slopes != SLOPES_AUTO || !ring || how->residual_deg < 1e-3) return true;
    WrIntegral other = *how;
    WrSheet by_differences = { .z = NULL };
    other.central = true;
    if (!wr_normals_integrate(n, &other, job, &by_differences, err)) {
        wr_sheet_fini(sheet);
        return false;
    }
    bool better = other.residual_deg < BETTER * how->residual_deg;
    wr_sheet_fini(better ? sheet : &by_differences);
    if (better) {
        *sheet = by_differences;
        *how = other;
        wr_generate_note(job, "its slopes are central differences");
    }
    return true;
}

static WrEnds ends_of(const WrParams *p, WrWrap wrap)
{
    int choice = wr_param_whole(p, "edges");
    if (choice == EDGES_AUTO) return wrap == WR_WRAP_PERIODIC ? WR_ENDS_RING : WR_ENDS_FREE;
    return choice == EDGES_FREE ? WR_ENDS_FREE : WR_ENDS_RING;
}

static bool make(const WrParams *p, WrNormals *normals, const WrGenerateJob *job, WrRelief *out,
                 WrError *err)
{
    const WrParamValue *cell = wr_param_value(p, "cell");
    double height = wr_param_number(p, "height"), low, high;
    WrSheet sheet = { .z = NULL };
    WrIntegral how = { .ends = { ends_of(p, wr_field_wrap_u(job->like)),
                                 ends_of(p, wr_field_wrap_v(job->like)) },
                       .unit = { cell->number[0] / (height * normals->width),
                                 cell->number[1] / (height * normals->height) } };
    settle_green(p, normals, job);
    if (!integrate(wr_param_whole(p, "slopes"), normals, &how, job, &sheet, err)) return false;
    say(normals, &how, job);
    wr_sheet_range(&sheet, &low, &high);
    double level = wr_param_number(p, "level");
    size_t count = (size_t)sheet.width * (size_t)sheet.height;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) sheet.z[k] += level - low;
    bool good =
        wr_sheet_resize(&sheet, wr_field_width(job->like), wr_field_height(job->like), job, err) &&
        wr_sheet_relief(&sheet, job, out, err);
    wr_sheet_fini(&sheet);
    return good;
}

/* The file's label applies if the command does not specify it. */
static WrNormalCodes codes_of(const WrParams *p, const WrImage *image)
{
    const int code = wr_param_whole(p, "codes");
    if (code != WR_NORMALS_AUTO) return (WrNormalCodes)code;
    return image->label.kind == WR_LABEL_SLOPES        ? WR_NORMALS_SLOPES
           : image->label.kind == WR_LABEL_BUMP_SLOPES ? WR_NORMALS_BUMP_SLOPES
                                                       : WR_NORMALS_AUTO;
}

/* Per texel and downwards, or relative to the cell and divided by a number from the file. */
static bool decode_bump_slopes(const WrParams *p, const WrImage *first, WrNormals *out,
                               WrError *err)
{
    const WrImageRequest wish = { .channel = "b1_dhds,b2_dhdt",
                                  .part = wr_param_value(p, "part")->text };
    const WrParamValue *cell = wr_param_value(p, "cell");
    const WrImageLabel *label = &first->label;
    const double k = label->uvslopes, height = wr_param_number(p, "height"),
                 sign = label->turned ? -1 : 1;
    WrImage *image = wr_image_read_request(wr_param_value(p, "file")->text, &wish, err);
    const bool good =
        image && normals_from_slopes(
                     image, sign * height / cell->number[0] * (k > 0 ? k : image->width),
                     sign * height / cell->number[1] * (k > 0 ? k : image->height), out, err);
    if (image) wr_image_free(image);
    return good;
}

static bool decode(const WrParams *p, const WrImage *image, const WrGenerateJob *job,
                   WrNormals *out, WrError *err)
{
    const WrNormalCodes code = codes_of(p, image);
    if (code == WR_NORMALS_BUMP_SLOPES) return decode_bump_slopes(p, image, out, err);
    const WrCoding coding = code == WR_NORMALS_UNSIGNED ? WR_CODING_UNIT
                            : code == WR_NORMALS_SIGNED ? WR_CODING_SIGNED
                                                        : (WrCoding)wr_param_whole(p, "coding");
    const bool slopes = code == WR_NORMALS_SLOPES;
    const bool good = slopes ? normals_from_slopes(image, 1, -1, out, err)
                             : wr_normals_decode(image, coding, out, err);
    if (good && !slopes && image->type == WR_PIXEL_F32)
        wr_generate_note(job, "floats taken as %s",
                         out->coding == WR_CODING_UNIT
                             ? "coded, 0..1 for -1..1; coding=signed reads them unchanged"
                             : "the vectors' own numbers; coding=unit reads 0..1 as -1..1");
    if (!good) wr_error_prefix(err, "%s: ", wr_param_value(p, "file")->text);
    return good;
}

bool wr_picture_normals(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams p = { wr_params_normals, values };
    WrNormals normals = { .p = NULL };
    WrImage *image = wr_picture_read(&p, "layer", (WrImageRequest){ 0 }, job, err);
    const bool good =
        image && decode(&p, image, job, &normals, err) && make(&p, &normals, job, out, err);
    wr_image_free(image);
    wr_normals_fini(&normals);
    return good;
}

#define STEEPEST 100.0

/* ---- decoding ---- */

/* Integer codes: (2 k - last) / last with the code k recovered exactly, so that the two codes next to the middle, 127 and 128
   of 255, both mean 0: a flat 8-bit map is level instead of tilted by 0.32 degrees (NUMERICS.md L3). */
static double axis_of(double c, double most, bool as_is)
{
    if (as_is) return c;
    double twice = most > 0.0 ? 2.0 * rint(c * most) - most : 2.0 * c - 1.0;
    if (most == 0.0) return twice;
    return fabs(twice) <= 1.0 ? 0.0 : twice / most;
}

static double limited(double slope, bool *steep)
{
    if (fabs(slope) <= STEEPEST) return slope;
    *steep = true;
    return slope > 0.0 ? STEEPEST : -STEEPEST;
}

static void decode_texel(const WrImage *image, const float *pixel, bool as_is, size_t k,
                         WrNormals *out)
{
    double most = wr_pixel_type_max(image->type), z;
    double x = axis_of((double)pixel[0], most, as_is), y = axis_of((double)pixel[1], most, as_is);
    if (image->channels == 2) {
        /* Two channels hold x and y of a unit vector; z is the positive root (BC5 and similar formats). */
        double rest = 1.0 - x * x - y * y;
        z = rest > 0.0 ? sqrt(rest) : 0.0;
    } else {
        z = axis_of((double)pixel[2], most, as_is);
    }
    if (!(z > 0.0) || !(fabs(x) < 1e30 && fabs(y) < 1e30)) {
        out->unknown++;
        return;
    }
    bool steep = false;
    /* n is parallel to (-F_x, -F_y, 1). p is the slope to the right, q the slope downwards along rows, hence the sign of y. */
    out->p[k] = limited(-x / z, &steep);
    out->q[k] = limited(y / z, &steep);
    out->steep += steep;
}

/* Initialises with slopes of 0. */
static bool begin(const WrImage *image, WrNormals *out, WrError *err)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    *out = (WrNormals){ .width = image->width, .height = image->height };
    out->p = wr_try_alloc(count, sizeof *out->p, "a normal map", err);
    out->q = out->p ? wr_try_alloc(count, sizeof *out->q, "a normal map", err) : NULL;
    if (!out->q) wr_normals_fini(out);
    return out->q != NULL;
}

bool wr_normals_decode(const WrImage *image, WrCoding coding, WrNormals *out, WrError *err)
{
    if (image->channels < 2)
        return wr_fail(err, "a normal map has 2 channels or more; this picture has 1: read heights "
                            "with photo or elevation");
    size_t count = (size_t)image->width * (size_t)image->height;
    WrNormals made;
    if (!begin(image, &made, err)) return false;
    if (!wr_coding_find(image, image->channels < 3 ? 2 : 3, coding, &made.coding, err)) {
        wr_normals_fini(&made);
        return false;
    }
    const bool as_is = made.coding == WR_CODING_SIGNED;
    bool going = true;
    for (size_t k = 0; k < count && going; k++) {
        going = wr_sheet_goes_on(k);
        decode_texel(image, image->data + k * (size_t)image->channels, as_is, k, &made);
    }
    if (going) *out = made;
    else wr_normals_fini(&made);
    return going || wr_fail(err, "cancelled");
}

static bool normals_from_slopes(const WrImage *image, double right, double down, WrNormals *out,
                                WrError *err)
{
    WrNormals made;
    if (image->channels < 2)
        return wr_fail(err, "slopes need two channels or more; this picture has one");
    if (!begin(image, &made, err)) return false;
    const size_t count = (size_t)image->width * (size_t)image->height;
    bool going = true;
    for (size_t k = 0; k < count && going; k++) {
        const float *c = image->data + k * (size_t)image->channels;
        const double p = right * (double)c[0], q = down * (double)c[1];
        going = wr_sheet_goes_on(k);
        if (fabs(p) < 1e30 && fabs(q) < 1e30) made.p[k] = p, made.q[k] = q;
        else made.unknown++;
    }
    if (going) *out = made;
    else wr_normals_fini(&made);
    return going || wr_fail(err, "cancelled");
}

void wr_normals_fini(WrNormals *normals)
{
    wr_free(normals->p);
    wr_free(normals->q);
    *normals = (WrNormals){ .p = NULL };
}

/* Slopes of a height field have equal mixed derivatives, p_y = q_x. The correlation of the two over the map is near +1 if the
   sign of green is right and near -1 if it is reversed. */
double wr_normals_upward(const WrNormals *n)
{
    double both = 0.0, along = 0.0, across = 0.0;
    size_t w = (size_t)n->width;
    for (int j = 1; j + 1 < n->height && !wr_progress_stopped(); j++)
        for (int i = 1; i + 1 < n->width; i++) {
            size_t k = (size_t)j * w + (size_t)i;
            double py = n->p[k + w] - n->p[k - w], qx = n->q[k + 1] - n->q[k - 1];
            both += py * qx;
            along += py * py;
            across += qx * qx;
        }
    double size = sqrt(along) * sqrt(across);
    return size > 0.0 ? both / size : 0.0;
}

void wr_normals_flip(WrNormals *n)
{
    for (int j = 0; j < n->height && !wr_progress_stopped(); j++)
        for (size_t i = 0, k = (size_t)j * (size_t)n->width; i < (size_t)n->width; i++, k++)
            n->q[k] = -n->q[k];
}

/* ---- integration ---- */

/* Converts slopes at texels to steps between them: the integral of the cubic through four texels, or of
   * the parabola through the last three. Open axes have no periodic differentiation by FFT: the step F(i+1) - F(i) is the
   integral of the interpolated slope over one texel, (-p(i-1) + 13 p(i) + 13 p(i+1) - p(i+2)) / 24 for the cubic, (5 p(i) + 8
   p(i+1) - p(i+2)) / 12 at an end. */
static void steps_of_line(const void *ctx, const WrFft *fft, double *a, double *b, double *scratch)
{
    (void)fft;
    int n = *(const int *)ctx;
    double *line[2] = { a, b };
    for (int s = 0; s < 2; s++) {
        double *z = line[s];
        const double *p = scratch;
        memcpy(scratch, z, (size_t)n * sizeof *z);
        for (int i = 0; i + 1 < n; i++) {
            if (i > 0 && i + 2 < n)
                z[i] = (13.0 * (p[i] + p[i + 1]) - (p[i - 1] + p[i + 2])) / 24.0;
            else if (i + 2 < n) z[i] = (5.0 * p[i] + 8.0 * p[i + 1] - p[i + 2]) / 12.0;
            else if (i > 0) z[i] = (5.0 * p[i + 1] + 8.0 * p[i] - p[i - 1]) / 12.0;
            else z[i] = 0.5 * (p[i] + p[i + 1]);
        }
        z[n - 1] = 0.0;
    }
}

typedef struct Work {
    WrPlane plane;
    WrSlopes slopes[2];
    double *want[2];    /* slopes of the map, table units per texel */
    double *have[2];    /* slopes of the result */
    const double *from; /* for one axis: slopes of the map, or heights */
    const double *unit; /* table units per texel */
    int axis;
    double *sums; /* [height] a sum for each row */
} Work;

typedef void Row(Work *w, int j, size_t k, size_t end); /* row j: texels [k, end) */

typedef struct Rows {
    Work *work;
    Row *row;
} Rows;

static void one_row(int j, int worker, void *ctx)
{
    (void)worker;
    const Rows *rows = ctx;
    const size_t width = (size_t)rows->work->plane.width;
    rows->row(rows->work, j, (size_t)j * width, ((size_t)j + 1) * width);
}

static bool each_row(Work *w, Row *row, WrError *err)
{
    Rows rows = { w, row };
    return wr_pool_run(w->plane.pool, w->plane.height, one_row, &rows) || wr_fail(err, "cancelled");
}

/* Mean from the rows' sums; independent of the number of threads. */
static double mean_of(const Work *w)
{
    double sum = 0.0;
    for (int j = 0; j < w->plane.height; j++) sum += w->sums[j];
    return sum / ((double)w->plane.width * w->plane.height);
}

static void scale_row(Work *w, int j, size_t k, size_t end)
{
    (void)j;
    for (; k < end; k++) w->plane.z[k] = w->from[k] * w->unit[w->axis];
}

/* An axis' slopes in table units per texel, in its slope definition. */
static bool prepare(Work *w, int axis, const double *slopes, WrError *err)
{
    const int n = axis == 0 ? w->plane.width : w->plane.height;
    w->plane.z = w->want[axis];
    w->from = slopes;
    w->axis = axis;
    return each_row(w, scale_row, err) && (w->plane.ends[axis] == WR_ENDS_RING ||
                                           wr_plane_lines(&w->plane, axis, steps_of_line, &n, err));
}

static void copy_row(Work *w, int j, size_t k, size_t end)
{
    (void)j;
    memcpy(w->plane.z + k, w->from + k, (end - k) * sizeof *w->from);
}

static void turn_row_round(Work *w, int j, size_t k, size_t end)
{
    (void)j;
    for (; k < end; k++) w->plane.z[k] = -w->plane.z[k];
}

static void step_row(Work *w, int j, size_t k, size_t end)
{
    const size_t step = w->axis == 0 ? 1 : (size_t)w->plane.width;
    const bool last_row = w->axis == 1 && j == w->plane.height - 1;
    for (; k < end; k++) {
        const bool last = last_row || (w->axis == 0 && k + 1 == end);
        w->plane.z[k] = last ? 0.0 : w->from[k + step] - w->from[k];
    }
}

/* Slopes of these heights, in the same definition. */
static bool own_slopes(Work *w, int axis, const double *heights, WrError *err)
{
    w->plane.z = w->have[axis];
    w->from = heights;
    w->axis = axis;
    if (w->slopes[axis] == WR_SLOPES_STEP) return each_row(w, step_row, err);
    /* Transposed slopes differ only in sign. */
    return each_row(w, copy_row, err) &&
           wr_plane_slope_adjoint(&w->plane, axis, w->slopes[axis], err) &&
           each_row(w, turn_row_round, err);
}

static void sum_slopes_of_row(Work *w, int j, size_t k, size_t end)
{
    w->sums[j] = 0.0;
    for (; k < end; k++) w->sums[j] += w->want[w->axis][k];
}

/* Squared angles between the normals of the map and those of the heights. */
static void sum_angles_of_row(Work *w, int j, size_t k, size_t end)
{
    double sum = 0.0;
    for (; k < end; k++) {
        double a = w->want[0][k] / w->unit[0], b = w->want[1][k] / w->unit[1];
        double c = w->have[0][k] / w->unit[0], d = w->have[1][k] / w->unit[1];
        double x = b - d, y = c - a, z = a * d - b * c; /* cross product */
        double angle = wr_atan2(sqrt(x * x + y * y + z * z), 1.0 + a * c + b * d);
        sum += angle * angle;
    }
    w->sums[j] = sum;
}

static void add_row(Work *w, int j, size_t k, size_t end)
{
    (void)j;
    for (; k < end; k++) w->plane.z[k] = w->have[0][k] + w->have[1][k];
}

/* Least squares: the heights z that minimise |Du z - p|^2 + |Dv z - q|^2 satisfy (Du^T Du + Dv^T Dv) z = Du^T p + Dv^T q
   (Frankot and Chellappa 1988, with the operators D of the slope definition at hand). The transposes are applied here; the
   sum is solved by FFT along each axis in wr_plane_solve. */
static bool solve(Work *w, double *z, WrError *err)
{
    for (int a = 0; a < 2; a++) {
        w->plane.z = w->have[a];
        w->from = w->want[a];
        if (!each_row(w, copy_row, err) || !wr_plane_slope_adjoint(&w->plane, a, w->slopes[a], err))
            return false;
    }
    w->plane.z = z;
    return each_row(w, add_row, err) && wr_plane_solve(&w->plane, w->slopes, err);
}

/* On a ring the mean slope is not the gradient of any periodic height: it is reported as the tilt that was left out. */
static bool compare(Work *w, const double *z, WrIntegral *how, WrError *err)
{
    for (int a = 0; a < 2; a++) {
        if (!own_slopes(w, a, z, err) || !each_row(w, sum_slopes_of_row, err)) return false;
        how->tilt_deg[a] = how->ends[a] == WR_ENDS_RING
                               ? wr_atan2(mean_of(w) / how->unit[a], 1.0) / WR_RAD_PER_DEG
                               : 0.0;
    }
    if (!each_row(w, sum_angles_of_row, err)) return false;
    how->residual_deg = sqrt(mean_of(w)) / WR_RAD_PER_DEG;
    return true;
}

bool wr_normals_integrate(const WrNormals *normals, WrIntegral *how, const WrGenerateJob *job,
                          WrSheet *sheet, WrError *err)
{
    const double *slopes[2] = { normals->p, normals->q };
    const size_t count = (size_t)normals->width * (size_t)normals->height;
    WrSheet made = { .z = NULL };
    WrWrap wrap[2];
    Work w = { .plane = { .width = normals->width,
                          .height = normals->height,
                          .ends = { how->ends[0], how->ends[1] },
                          .pool = job->pool,
                          .progress = job->progress },
               .unit = how->unit,
               .sums = wr_alloc((size_t)normals->height, sizeof *w.sums) };
    bool good = true;
    for (int a = 0; a < 2; a++) {
        bool ring = how->ends[a] == WR_ENDS_RING;
        wrap[a] = ring ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP;
        w.slopes[a] = !ring ? WR_SLOPES_STEP : how->central ? WR_SLOPES_CENTRAL : WR_SLOPES_SMOOTH;
        w.want[a] = wr_try_alloc(count, sizeof *made.z, "a normal map", err);
        w.have[a] = w.want[a] ? wr_try_alloc(count, sizeof *made.z, "a normal map", err) : NULL;
        good = good && w.have[a] && prepare(&w, a, slopes[a], err);
    }
    good = good && wr_sheet_init(&made, normals->width, normals->height, wrap, err) &&
           solve(&w, made.z, err) && compare(&w, made.z, how, err);
    for (int a = 0; a < 2; a++) {
        wr_free(w.want[a]);
        wr_free(w.have[a]);
    }
    wr_free(w.sums);
    if (good) *sheet = made;
    else wr_sheet_fini(&made);
    return good;
}

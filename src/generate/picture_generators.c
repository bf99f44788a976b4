#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "field/fft_plane.h"
#include "field/field.h"
#include "field/least_path.h"
#include "field/ops.h"
#include "generate/picture.h"
#include "generate/tile_builder.h"
#include "generate/transform_piece.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

/* Adds remarks on differences from the file's pixels. */
static void picture_note(const char *path, const WrImage *image, const WrGenerateJob *job);

/* ---- An unchanged picture at a position: pasted copies, and pictures from other programs ---- */

#define MIRRORS(X)                                                                                 \
    X(MIRROR_NONE, "none")                                                                         \
    X(MIRROR_U, "u") X(MIRROR_V, "v") X(MIRROR_UV, "uv")
enum { MIRRORS(WR_WORD_ID) };
static const char *const mirrors[] = { MIRRORS(WR_WORD) NULL };

const WrParam wr_params_paste[] = {
    WR_P_FILE("a picture, or a file that `copy` wrote"),
    { .name = "at",
      .label = "At",
      .help = "position of its centre",
      .unit = "",
      .kind = WR_PARAM_TUPLE,
      .fallback = { 0.5, 0.5 },
      .low = -1e6,
      .high = 1e6,
      .soft_low = 0,
      .soft_high = 1,
      .shape = "u,v",
      .components = 2 },
    WR_P_TEXELS("size", "Width", 0, 512, "width; 0: one texel per pixel"),
    WR_P_NUMBER("angle", "Angle", 0, -36000, 36000, 180, "degrees", "rotation, anticlockwise"),
    WR_P_CHOICE("mirror", "Mirror", MIRROR_NONE, mirrors,
                "u: left and right swapped; v: top and bottom swapped"),
    WR_P_CHOICE("filter", "Filter", WR_PLACE_CATMULL, wr_place_filters,
                "interpolation between its pixels, unless they coincide with texels"),
    WR_P_SWITCH("transparent", "Transparent", 1, "on: its alpha is the opacity"),
    WR_P_LABELS,
    WR_P_NUMBER("height", "Height", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "height of white, or of 1 in float pictures"),
    WR_P_END
};

static bool put(const WrImage *image, bool alpha, double height, WrField *field,
                const WrGenerateJob *job, WrError *err)
{
    const int n = image->channels, width = image->width;
    float *row = wr_try_alloc((size_t)width, sizeof *row, "a row of a picture", err);
    for (int j = 0; row && j < image->height; j++) {
        const float *pixel = image->data + (size_t)j * (size_t)width * (size_t)n;
        if (wr_progress_cancelled(job->progress)) {
            wr_free(row);
            return wr_fail(err, "cancelled");
        }
        for (int i = 0; i < width; i++, pixel += n) {
            double v = alpha ? (double)pixel[n - 1] : (double)wr_image_luma(pixel, n) * height;
            row[i] = (float)(alpha ? v > 0.0 ? v < 1.0 ? v : 1.0 : 0.0 : v);
        }
        wr_field_write(field, 0, j, width, 1, row, (size_t)width);
    }
    wr_free(row);
    return row != NULL;
}

static WrField *field_of(const WrImage *image, bool alpha, double height, const WrGenerateJob *job,
                         WrError *err)
{
    WrField *field =
        wr_field_new(image->width, image->height, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, err);
    if (!field || put(image, alpha, height, field, job, err)) return field;
    wr_field_free(field);
    return NULL;
}

static bool check_size(double scale, const WrImage *image, double size, WrError *err)
{
    if (scale <= WR_PLACE_SCALE && scale >= 1.0 / WR_PLACE_SCALE) return true;
    return wr_fail(err, "size=%g: must be 1/%g to %g times the picture's %d pixels", size,
                   WR_PLACE_SCALE, WR_PLACE_SCALE, image->width);
}

bool wr_picture_paste(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams p = { wr_params_paste, values };
    const double *at = wr_param_value(&p, "at")->number, size = wr_param_number(&p, "size");
    const int mirror = wr_param_whole(&p, "mirror");
    WrImage *image = wr_image_read(wr_param_value(&p, "file")->text, err);
    if (!image) return false;
    picture_note(wr_param_value(&p, "file")->text, image, job);
    const double w = image->width, h = image->height, scale = size > 0.0 ? size / w : 1.0;
    bool good = check_size(scale, image, size, err);
    if (good && wr_picture_label(&p, image, job)) wr_image_apply_range(image);
    bool alpha = wr_param_whole(&p, "transparent") == 1 && image->channels % 2 == 0;
    WrField *heights =
        good ? field_of(image, false, wr_param_number(&p, "height"), job, err) : NULL;
    WrField *weight = heights && alpha ? field_of(image, true, 1.0, job, err) : NULL;
    WrPlacing placing = { .heights = heights,
                          .weight = weight,
                          .window = { 0.0, 0.0, w, h },
                          .from = { 0.5 * w, 0.5 * h },
                          .at = { at[0] * wr_field_width(job->like),
                                  (1.0 - at[1]) * wr_field_height(job->like) },
                          .scale = { mirror & 1 ? -scale : scale, mirror & 2 ? -scale : scale },
                          .turn_deg = wr_param_number(&p, "angle"),
                          .filter = (WrPlaceFilter)wr_param_whole(&p, "filter") };
    good = heights && (!alpha || weight) && wr_transform_piece(&placing, job, out, err);
    wr_image_free(image);
    wr_field_free(heights);
    wr_field_free(weight);
    return good;
}

/* ---- picture seam ---- */

const char *const wr_seamless_words[] = { WR_SEAMLESS_WAYS(WR_WORD) NULL };

static WrEnds ends_of(WrWrap wrap)
{
    return wrap == WR_WRAP_PERIODIC ? WR_ENDS_RING : WR_ENDS_FREE;
}

static WrPlane plane_of(const WrSheet *sheet, double *z, const WrGenerateJob *job)
{
    return (WrPlane){ .width = sheet->width,
                      .height = sheet->height,
                      .ends = { ends_of(sheet->wrap[0]), ends_of(sheet->wrap[1]) },
                      .z = z,
                      .pool = job->pool,
                      .progress = job->progress };
}

static bool solve_steps(WrPlane *plane, WrError *err)
{
    static const WrSlopes steps[] = { WR_SLOPES_STEP, WR_SLOPES_STEP };
    return wr_plane_solve(plane, steps, err);
}

bool wr_picture_blend(WrSheet *sheet, const WrGenerateJob *job, WrError *err)
{
    const WrPlane plane = plane_of(sheet, sheet->z, job);
    return wr_plane_make_periodic(&plane, err);
}

/* ---- cut ---- */

static int seamless_overlap(int n)
{
    return n < 16 ? 0 : n / 8;
}

/* Heights with their steps to the next texel to the right and below. */
typedef struct Steps {
    int size[2];      /* columns, rows */
    double *z, *g[2]; /* owned */
} Steps;

static bool steps_new(Steps *steps, int width, int height, WrError *err)
{
    size_t count = (size_t)width * (size_t)height;
    *steps = (Steps){ .size = { width, height } };
    steps->z = wr_try_alloc(count, sizeof *steps->z, "a seamless picture", err);
    for (int a = 0; a < 2 && steps->z; a++)
        steps->g[a] = wr_try_alloc(count, sizeof *steps->z, "a seamless picture", err);
    return steps->z && steps->g[0] && steps->g[1];
}

static void steps_fini(Steps *steps)
{
    wr_free(steps->z);
    wr_free(steps->g[0]);
    wr_free(steps->g[1]);
    *steps = (Steps){ .z = NULL };
}

static bool steps_of(Steps *steps, const WrSheet *sheet, WrError *err)
{
    size_t w = (size_t)sheet->width, h = (size_t)sheet->height;
    if (!steps_new(steps, sheet->width, sheet->height, err)) return false;
    memcpy(steps->z, sheet->z, w * h * sizeof *sheet->z);
    for (size_t j = 0; j < h; j++)
        for (size_t i = 0; i < w; i++) {
            size_t k = j * w + i;
            if (i + 1 < w) steps->g[0][k] = sheet->z[k + 1] - sheet->z[k];
            if (j + 1 < h) steps->g[1][k] = sheet->z[k + w] - sheet->z[k];
        }
    return true;
}

/* Closing of one axis: along it n of n + overlap texels remain; lines are adjacent across it. */
typedef struct Cutting {
    const Steps *from;
    int axis, n, overlap, lines;
    bool ring; /* the other axis is already closed */
    int *cut;  /* [lines] 1..overlap - 1: texels before it come from the far end, texels from it on
                from the near end */
} Cutting;

static size_t place(const Steps *s, int axis, int along, int line)
{
    return axis == 0 ? (size_t)line * (size_t)s->size[0] + (size_t)along
                     : (size_t)along * (size_t)s->size[0] + (size_t)line;
}

static double mismatch(const void *ctx, int along, int line)
{
    const Cutting *c = ctx;
    double d = c->from->z[place(c->from, c->axis, along, line)] -
               c->from->z[place(c->from, c->axis, c->n + along, line)];
    return d * d;
}

static bool far_end(const Cutting *c, int along, int line)
{
    return along < c->cut[line];
}

/* A step of the closed picture between two texels: from their common source, or the mean. */
static double choose(const Cutting *c, const double *g, int along, int line, bool a, bool b)
{
    double near = g[place(c->from, c->axis, along, line)];
    if (!a && !b) return near;
    double far = g[place(c->from, c->axis, c->n + along, line)];
    return a && b ? far : 0.5 * (near + far);
}

/* Steps, not heights, are copied from either side, and even_out integrates them: a difference in brightness between both
   sides would remain visible along the cut. */
static void join_line(const Cutting *c, int line, Steps *to)
{
    const Steps *from = c->from;
    int next = line + 1 < c->lines ? line + 1 : c->ring ? 0 : line;
    for (int k = 0; k < c->n; k++) {
        size_t at = place(to, c->axis, k, line);
        bool here = far_end(c, k, line), beside = far_end(c, k, next);
        bool ahead = k + 1 < c->n && far_end(c, k + 1, line);
        to->z[at] = from->z[place(from, c->axis, here ? c->n + k : k, line)];
        to->g[c->axis][at] = choose(c, from->g[c->axis], k, line, here, ahead);
        to->g[1 - c->axis][at] = choose(c, from->g[1 - c->axis], k, line, here, beside);
    }
}

/* Closes one axis to n texels; *steps is replaced. */
static bool close_axis(Steps *steps, int axis, int n, bool ring, WrError *err)
{
    Steps made = { .z = NULL };
    Cutting c = { .from = steps,
                  .axis = axis,
                  .n = n,
                  .overlap = steps->size[axis] - n,
                  .lines = steps->size[1 - axis],
                  .ring = ring };
    size_t lines = (size_t)c.lines;
    if (c.overlap < 2) return true;
    c.cut = wr_try_alloc(lines, sizeof *c.cut, "a cut", err);
    const WrOverlap overlap = { c.overlap, c.lines, ring, mismatch, &c };
    bool good =
        c.cut && wr_least_path(&overlap, c.cut, err) &&
        steps_new(&made, axis == 0 ? n : steps->size[0], axis == 1 ? n : steps->size[1], err);
    if (good) {
        for (int line = 0; line < c.lines; line++) join_line(&c, line, &made);
        steps_fini(steps);
        *steps = made;
    } else {
        steps_fini(&made);
    }
    wr_free(c.cut);
    return good;
}

/* The heights whose steps are nearest to those of the two sides, with the picture's mean. */
static bool even_out(Steps *steps, WrSheet *sheet, const WrGenerateJob *job, WrError *err)
{
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    double mean = 0.0;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) mean += steps->z[k] / (double)count;
    for (int a = 0; a < 2; a++) {
        WrPlane plane = plane_of(sheet, steps->g[a], job);
        if (!wr_plane_slope_adjoint(&plane, a, WR_SLOPES_STEP, err)) return false;
    }
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++)
        sheet->z[k] = steps->g[0][k] + steps->g[1][k];
    WrPlane plane = plane_of(sheet, sheet->z, job);
    if (!solve_steps(&plane, err)) return false;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) sheet->z[k] += mean;
    return true;
}

bool wr_picture_cut(WrSheet *sheet, int width, int height, const WrGenerateJob *job, WrError *err)
{
    Steps steps = { .z = NULL };
    WrSheet made = { .z = NULL };
    bool good = steps_of(&steps, sheet, err) && close_axis(&steps, 0, width, false, err) &&
                close_axis(&steps, 1, height, sheet->wrap[0] == WR_WRAP_PERIODIC, err) &&
                wr_sheet_init(&made, width, height, sheet->wrap, err) &&
                even_out(&steps, &made, job, err);
    steps_fini(&steps);
    if (!good) {
        wr_sheet_fini(&made);
        return false;
    }
    wr_sheet_fini(sheet);
    *sheet = made;
    return true;
}

/* ---- */

/* Adds a remark if the table's aspect ratio distorts the picture. */
static void report_shape(const WrSheet *sheet, const int size[2], const WrGenerateJob *job)
{
    double shape = (double)sheet->width * size[1] / ((double)sheet->height * size[0]);
    if (shape > 0.99 && shape < 1.01) return;
    wr_generate_note(job, "%dx%d texels are drawn out to %dx%d: another shape", sheet->width,
                     sheet->height, size[0], size[1]);
}

bool wr_picture_fit(WrSheet *sheet, WrSeamless seamless, const WrGenerateJob *job, WrError *err)
{
    const WrWrap wrap[] = { wr_field_wrap_u(job->like), wr_field_wrap_v(job->like) };
    int size[] = { wr_field_width(job->like), wr_field_height(job->like) }, larger[2];
    for (int a = 0; a < 2; a++) {
        bool overlaps = seamless == WR_SEAMLESS_CUT && wrap[a] == WR_WRAP_PERIODIC;
        larger[a] = size[a] + (overlaps ? seamless_overlap(size[a]) : 0);
        sheet->wrap[a] = WR_WRAP_CLAMP; /* its ends do not match yet */
    }
    report_shape(sheet, size, job);
    if (!wr_sheet_resize(sheet, larger[0], larger[1], job, err)) return false;
    sheet->wrap[0] = wrap[0];
    sheet->wrap[1] = wrap[1];
    if (seamless == WR_SEAMLESS_BLEND) return wr_picture_blend(sheet, job, err);
    if (seamless == WR_SEAMLESS_CUT) return wr_picture_cut(sheet, size[0], size[1], job, err);
    return true;
}

/* ---- picture photo ---- */

/* Heights from the brightness of a picture, in linear light, because the codes of pictures are not
   proportional to it. */

#define CHANNELS(X)                                                                                \
    X(LUMINANCE, "luminance")                                                                      \
    X(RED, "red")                                                                                  \
    X(GREEN, "green")                                                                              \
    X(BLUE, "blue")                                                                                \
    X(ALPHA, "alpha")                                                                              \
    X(LARGEST, "max")
enum { CHANNELS(WR_WORD_ID) };
static const char *const channels[] = { CHANNELS(WR_WORD) NULL };
#define LIGHTS(X) X(LINEAR, "linear") X(CODE, "code")
enum { LIGHTS(WR_WORD_ID) };
static const char *const lights[] = { LIGHTS(WR_WORD) NULL };

const WrParam wr_params_photo[] = {
    WR_P_FILE("a picture"),
    WR_P_CHANNELS("layer", NULL),
    WR_P_CHOICE("channel", "Channel", LUMINANCE, channels, "channel that is read as height"),
    WR_P_CHOICE("light", "Light", LINEAR, lights,
                "linear: codes of 8 and 16 bits are sRGB; code: they are numbers"),
    WR_P_SEAMLESS(WR_SEAMLESS_BLEND),
    WR_P_NUMBER("highpass", "High pass", 0, 0, 1000, 200, "texels",
                "remove features wider than this, such as shadows and uneven light; 0: none"),
    WR_P_SWITCH("stretch", "Stretch", 0,
                "on: first stretch the darkest to 0 and the lightest to 1"),
    WR_P_NUMBER("low", "Low", 0, -1e6, 1e6, 1, "",
                "brightness of the lowest height; darker parts are clipped"),
    WR_P_NUMBER("high", "High", 1, -1e6, 1e6, 1, "",
                "brightness of the highest height; brighter parts are clipped"),
    WR_P_NUMBER("gamma", "Gamma", 1, 0.01, 100, 5, "",
                "exponent 1/gamma of the heights; above 1 raises them"),
    WR_P_SWITCH("invert", "Invert", 0, "on: dark is high"),
    WR_P_LABELS,
    WR_P_HEIGHT,
    WR_P_NUMBER("level", "Level", 0, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "level of the lowest place"),
    WR_P_END
};

const char *const wr_picture_labels[] = { WR_PICTURE_LABELS(WR_WORD) NULL };

#define FLAT (1.0 / 255) /* of the heights: less than a step of 8 bits */

/* IEC 61966-2-1 (sRGB), decoded in double. */
static double picture_light(double code)
{
    return code <= 0.04045 ? code / 12.92 : wr_pow((code + 0.055) / 1.055, 2.4);
}

WrImage *wr_picture_read(const WrParams *params, const char *channels_, WrImageRequest wish,
                         const WrGenerateJob *job, WrError *err)
{
    const char *path = wr_param_value(params, "file")->text;
    wish.channel = wr_param_value(params, channels_)->text;
    wish.part = wr_param_value(params, "part")->text;
    WrImage *image = wr_image_read_request(path, &wish, err);
    if (image && image->taken[0])
        wr_generate_note(job, "%s: took %s (%s= and part= take others)", path, image->taken,
                         channels_);
    if (image) picture_note(path, image, job);
    return image;
}

static void picture_note(const char *path, const WrImage *image, const WrGenerateJob *job)
{
    if (image->note[0]) wr_generate_note(job, "%s: %s", path, image->note);
    if (image->filled)
        wr_generate_note(job, "%s: %lld missing values filled from their neighbours", path,
                         (long long)image->filled);
}

const WrImageLabel *wr_picture_label(const WrParams *params, const WrImage *image,
                                     const WrGenerateJob *job)
{
    const WrImageLabel *label = &image->label;
    const char *path = wr_param_value(params, "file")->text;
    if (wr_param_whole(params, "labels") == WR_LABELS_IGNORE) return NULL;
    if (label->refused[0])
        wr_generate_note(job, "%s: its metadata %s is invalid and not used", path, label->refused);
    return label->kind == WR_LABEL_NONE && !label->ranged ? NULL : label;
}

/* False if a label of heights or normals declares the codes as numbers. */
static bool is_light(const WrParams *p, const WrImage *image, const WrGenerateJob *job)
{
    bool linear = wr_param_whole(p, "light") == LINEAR;
    const WrImageLabel *label = wr_picture_label(p, image, job);
    if (!label || !linear || image->type == WR_PIXEL_F32) return linear;
    wr_generate_note(
        job,
        "%s: according to its label it holds %s: its codes are read as numbers, not as "
        "light (labels=ignore reads them as light)",
        wr_param_value(p, "file")->text,
        label->kind >= WR_LABEL_NORMAL_UP ? "normals or slopes" : "heights");
    return false;
}

/* Value of each code of a picture of 8 or 16 bits; NULL for floats. Caller frees. A table of at most 65536 entries replaces a
   power per texel. */
static double *light_of_codes(const WrImage *image, bool linear, double *most)
{
    *most = image->type == WR_PIXEL_U8 ? 255.0 : image->type == WR_PIXEL_U16 ? 65535.0 : 0.0;
    if (*most == 0.0) return NULL;
    double *light = wr_alloc((size_t)*most + 1, sizeof *light);
    for (int k = 0; k <= (int)*most; k++) light[k] = linear ? picture_light(k / *most) : k / *most;
    return light;
}

/* c[4]: red, green, blue, alpha */
static double pick(int channel, const double *c)
{
    if (channel >= RED && channel <= ALPHA) return c[channel - RED];
    if (channel == LARGEST) {
        double most = c[0] > c[1] ? c[0] : c[1];
        return most > c[2] ? most : c[2];
    }
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; /* Rec. 709 */
}

static void read_light(const WrImage *image, int channel, bool linear, WrSheet *sheet)
{
    double most, *light = light_of_codes(image, linear, &most);
    int n = image->channels, alpha = n == 2 ? 1 : n == 4 ? 3 : -1;
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) {
        const float *pixel = image->data + k * (size_t)n;
        double c[4] = { 0.0, 0.0, 0.0, 1.0 };
        for (int a = 0; a < 3; a++) {
            double code = (double)pixel[n < 3 ? 0 : a];
            c[a] = light ? light[(int)rint(code * most)] : code;
        }
        if (alpha >= 0) c[3] = (double)pixel[alpha];
        sheet->z[k] = n < 3 && channel != ALPHA ? c[0] : pick(channel, c);
    }
    wr_free(light);
}

/* Subtracts a Gaussian blur of that width; preserves the mean. Uneven lighting of a photo varies slowly: subtracting a wide
   Gaussian blur leaves the texture. */
static bool high_pass(WrSheet *sheet, double sigma, const WrGenerateJob *job, WrError *err)
{
    const WrOpOptions options = { .pool = job->pool };
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    double mean = 0.0;
    WrSheet wide = { .z = NULL };
    WrField *field = wr_sheet_field(sheet, err);
    WrField *blurred = field ? wr_op_run(wr_op_find("blur"), field, &sigma, &options, err) : NULL;
    bool good = blurred && wr_sheet_read(&wide, blurred, err);
    for (size_t k = 0; good && k < count && wr_sheet_goes_on(k); k++)
        mean += sheet->z[k] / (double)count;
    for (size_t k = 0; good && k < count && wr_sheet_goes_on(k); k++)
        sheet->z[k] += mean - wide.z[k];
    wr_sheet_fini(&wide);
    wr_field_free(field);
    wr_field_free(blurred);
    return good;
}

/* Numbers that are no light, such as elevations in metres, come out flat: what to do. t: least and most of the heights'
   shares of height=, 0..1; cut: values below low or above high. */
static void note_flat(const char *path, double least, double most, size_t cut, size_t count,
                      double darkest, double lightest, const WrGenerateJob *job)
{
    if (!(lightest > darkest)) return;
    if (2 * cut > count && (darkest < 0.0 || lightest > 1.0))
        wr_generate_note(job,
                         "%s: %zu of %zu values lie outside low and high and are cut (they go from "
                         "%g to %g): stretch=on uses their range",
                         path, cut, count, darkest, lightest);
    else if (most - least < FLAT)
        wr_generate_note(job,
                         "%s: its values go from %g to %g, which is nearly flat: stretch=on uses "
                         "their range",
                         path, darkest, lightest);
}

static void bring_to_heights(const WrParams *p, const char *path, WrSheet *sheet,
                             const WrGenerateJob *job)
{
    double low = wr_param_number(p, "low"), high = wr_param_number(p, "high");
    double power = 1.0 / wr_param_number(p, "gamma"), least = 1.0, most = 0.0, from, to;
    double height = wr_param_number(p, "height"), level = wr_param_number(p, "level");
    bool invert = wr_param_whole(p, "invert") == 1;
    wr_sheet_range(sheet, &from, &to);
    const bool stretch = wr_param_whole(p, "stretch") == 1;
    const double darkest = stretch ? from : 0.0, span = !stretch    ? 1.0
                                                        : to > from ? to - from
                                                                    : 1.0;
    size_t cut = 0;
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) {
        double t = ((sheet->z[k] - darkest) / span - low) / (high - low);
        if (!(t >= 0.0 && t <= 1.0)) cut++, t = t > 0.0 ? 1.0 : 0.0;
        if (t < least) least = t;
        if (t > most) most = t;
        if (power != 1.0) t = wr_pow(t, power);
        sheet->z[k] = level + height * (invert ? 1.0 - t : t);
    }
    note_flat(path, least, most, cut, count, from, to, job);
}

static bool check(const WrParams *p, const WrImage *image, const char *path, WrError *err)
{
    double low = wr_param_number(p, "low"), high = wr_param_number(p, "high");
    if (!(low < high))
        return wr_fail(err, "low=%g: must be below high=%g; invert=on makes dark high", low, high);
    if (wr_param_whole(p, "channel") == ALPHA && image->channels % 2 == 1)
        return wr_fail(err, "%s: channel=alpha: it has no alpha channel", path);
    return true;
}

bool wr_picture_photo(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams p = { wr_params_photo, values };
    const WrWrap wrap[] = { wr_field_wrap_u(job->like), wr_field_wrap_v(job->like) };
    const char *path = wr_param_value(&p, "file")->text;
    double sigma = wr_param_number(&p, "highpass");
    WrSheet sheet = { .z = NULL };
    WrImage *image = wr_picture_read(&p, "layer", (WrImageRequest){ 0 }, job, err);
    bool good = image && check(&p, image, path, err) &&
                wr_sheet_init(&sheet, image->width, image->height, wrap, err);
    if (good) {
        read_light(image, wr_param_whole(&p, "channel"), is_light(&p, image, job), &sheet);
        if (image->replaced > 0)
            wr_generate_note(job, "%s: %lld numbers that are none count as 0", path,
                             (long long)image->replaced);
    }
    wr_image_free(image);
    good = good && wr_picture_fit(&sheet, (WrSeamless)wr_param_whole(&p, "seamless"), job, err) &&
           (!(sigma > 0.0) || high_pass(&sheet, sigma, job, err));
    if (good) {
        bring_to_heights(&p, path, &sheet, job);
        good = wr_sheet_relief(&sheet, job, out, err);
    }
    wr_sheet_fini(&sheet);
    return good;
}

const WrGenerator wr_picture_rows[] = {
    WR_GENERATOR("picture", "photo", "Photo", "heights from the brightness of a picture", "replace",
                 wr_params_photo, wr_picture_photo),
    WR_GENERATOR("picture", "normals", "Normal map",
                 "heights integrated from a normal map by least squares", "replace",
                 wr_params_normals, wr_picture_normals),
    WR_GENERATOR("picture", "paste", "Picture",
                 "paste a picture as it is, such as a copied selection", "replace", wr_params_paste,
                 wr_picture_paste),
    { .family = "picture",
      .name = "svg",
      .label = "Vector drawing",
      .help = "an SVG file in relief, with the profiles of `text`",
      .blend = "add",
      .params = wr_params_svg,
      .make = wr_picture_svg },
    { .family = "picture",
      .name = "path",
      .label = "Vector path",
      .help = "an SVG path in relief, with the profiles of `text`",
      .blend = "add",
      .params = wr_params_path,
      .make = wr_picture_path },
    { .family = NULL },
};

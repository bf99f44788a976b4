/* The table of operations: their values as text, and the entry point that checks all arguments. */
#include "field/ops.h"

#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "field/field.h"
#include "field/ops_internal.h"
#include "noise/octaves.h"

#include <math.h>
#include <string.h>

/* ---- values as text ---- */

/* Number of values of parameter k, which start at value[k]. param[] of a filter is a flat list of doubles in the order of the
   row's parameters. A list of points is always the last one: its count, then x y x y ... */
static int numbers_of(const WrOpInfo *op, int k, const double *value)
{
    return op->params[k].points ? 1 + 2 * (int)value[k] : 1;
}

WrFilter wr_filter_of(const WrOpInfo *op)
{
    WrFilter filter = { .op = op };
    for (int k = 0; k < wr_op_param_count(op); k++) {
        const double *points = op->params[k].points;
        filter.param[k] = points ? *points : op->params[k].fallback;
        for (int i = 1; points && i <= 2 * (int)*points; i++) filter.param[k + i] = points[i];
    }
    return filter;
}

bool wr_filter_same(const WrFilter *a, const WrFilter *b)
{
    if (a->op != b->op) return false;
    for (int k = 0; a->op && k < wr_op_param_count(a->op); k++) {
        const int count = numbers_of(a->op, k, a->param);
        if (count != numbers_of(b->op, k, b->param) ||
            memcmp(a->param + k, b->param + k, sizeof *a->param * (size_t)count) != 0)
            return false;
    }
    return true;
}

/* ---- checks ---- */

static bool check_number(const WrOpInfo *op, const WrOpParam *param, double value, WrError *err)
{
    bool inside =
        value >= param->low && value <= param->high && (!param->above || value > param->low);
    if (inside && (!param->whole || value == floor(value) || (param->share && fabs(value) < 1)))
        return true;
    if (param->choices)
        return wr_fail(err, "%s: %s %g: must be the number of one of its choices, 0..%g", op->name,
                       param->name, value, param->high);
    return wr_fail(err, "%s: %s %g: must be %s%s %g..%g%s%s%s", op->name, param->name, value,
                   param->whole ? "a whole number" : "a number", param->above ? " above" : ",",
                   param->low, param->high, *param->unit ? " " : "", param->unit,
                   param->share ? ", or a share of the side between -1 and 1" : "");
}

static bool check_one(const WrOpInfo *op, const WrOpParam *param, const double *value, WrError *err)
{
    return check_number(op, param, *value, err);
}

static bool check_points(const WrOpInfo *op, const WrOpParam *param, const double *value,
                         WrError *err)
{
    if (!(*value >= 2 && *value <= WR_OP_POINTS && *value == floor(*value)))
        return wr_fail(err, "%s: %s: %g points: must be 2..%d", op->name, param->name, *value,
                       WR_OP_POINTS);
    for (int i = 1; i <= 2 * (int)*value; i++)
        if (!check_number(op, param, value[i], err)) return false;
    return true;
}

/* Checks all values, in the order of WrFilter. */
static bool op_check_params(const WrOpInfo *op, const double *value, WrError *err)
{
    for (int k = 0; k < wr_op_param_count(op); k++) {
        const WrOpParam *param = &op->params[k];
        if (!(param->points ? check_points : check_one)(op, param, value + k, err)) return false;
    }
    return true;
}

bool wr_filter_check(const WrFilter *filter, WrError *err)
{
    const WrOpInfo *op = filter->op;
    if (op->reshapes)
        return wr_fail(err, "%s changes the table's size or edges, so it cannot be a filter layer",
                       op->name);
    /* The operation runs on a table of one texel: checks of parameters together (a curve's points must rise) are in the
       operations, and this reaches them without repeating them. */
    WrField *texel = wr_field_new(1, 1, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, err);
    WrField *made = texel ? wr_op_run(op, texel, filter->param, NULL, err) : NULL;
    wr_field_free(texel);
    wr_field_free(made);
    return made != NULL;
}

/* ---- writing ---- */

void wr_filter_print(const WrFilter *filter, WrText *text)
{
    const WrOpInfo *op = filter->op;
    wr_text_add(text, op->name);
    for (int k = 0; k < wr_op_param_count(op); k++) {
        const WrOpParam *param = &op->params[k];
        const double *value = filter->param + k;
        wr_text_addf(text, " %s=", param->name);
        if (param->choices) wr_text_add(text, param->choices[(int)*value]);
        else if (!param->points) wr_text_add_number(text, *value);
        for (int i = 1; param->points && i <= 2 * (int)*value; i++) {
            if (i > 1) wr_text_add(text, i % 2 ? ";" : ",");
            wr_text_add_number(text, value[i]);
        }
    }
}

/* ---- reading ---- */

static bool read_word(const WrOpParam *param, const char *at, size_t length, double *value)
{
    for (int i = 0; param->choices[i]; i++)
        if (strlen(param->choices[i]) == length && strncmp(param->choices[i], at, length) == 0) {
            *value = i;
            return true;
        }
    return false;
}

/* "0,0;0.5,0.25;1,1" */
static bool read_points(const char *at, size_t length, double *value)
{
    const char *end = at + length, *stop = at;
    int count = 0;
    for (; stop < end && count < 2 * WR_OP_POINTS; at = stop + 1) {
        stop = memchr(at, count % 2 ? ';' : ',', (size_t)(end - at));
        if (!stop) stop = end;
        if (!wr_number_parse(at, (size_t)(stop - at), &value[++count])) return false;
    }
    *value = count / 2;
    return count % 2 == 0 && stop == end;
}

/* "sigma=3" */
static bool read_param(const char *at, size_t length, WrFilter *filter, WrError *err)
{
    const char *sign = memchr(at, '=', length);
    const size_t name = sign ? (size_t)(sign - at) : length;
    for (int k = 0; sign && k < wr_op_param_count(filter->op); k++) {
        const WrOpParam *param = &filter->op->params[k];
        if (strlen(param->name) != name || strncmp(param->name, at, name) != 0) continue;
        const char *text = sign + 1;
        const size_t rest = length - name - 1;
        bool good = param->choices  ? read_word(param, text, rest, &filter->param[k])
                    : param->points ? read_points(text, rest, &filter->param[k])
                                    : wr_number_parse(text, rest, &filter->param[k]);
        return good || wr_fail(err, "%s: %s: '%.*s' is not one of its values", filter->op->name,
                               param->name, (int)(rest < 40 ? rest : 40), text);
    }
    return wr_fail(err, "%s: has no '%.*s'", filter->op->name, (int)(length < 40 ? length : 40),
                   at);
}

bool wr_filter_parse(const char *text, WrFilter *filter, WrError *err)
{
    char name[32] = "";
    size_t length = strcspn(text, " ");
    if (length < sizeof name) memcpy(name, text, length);
    const WrOpInfo *op = wr_op_find(name);
    if (!op) return wr_fail(err, "no operation is called '%.40s'", text);
    *filter = wr_filter_of(op);
    for (text += length; *text; text += length) {
        text += strspn(text, " ");
        length = strcspn(text, " ");
        if (length > 0 && !read_param(text, length, filter, err)) return false;
    }
    return wr_filter_check(filter, err);
}

/* ---- the table and the entry point ---- */

#define HEIGHT_UNIT "table units"
/* Any height, with the slider range and the default. */
#define HEIGHT(name_, label_, help_, fallback_)                                                    \
    {                                                                                              \
        .name = name_, .label = label_, .help = help_, .unit = HEIGHT_UNIT, .fallback = fallback_, \
        .low = -FLT_MAX, .high = FLT_MAX, .soft_low = -1, .soft_high = 2                           \
    }

static const char *const invert_words[] = { WR_INVERT_ABOUTS(WR_WORD) NULL };
static const char *const repeat_words[] = { WR_REPEAT_WAYS(WR_WORD) NULL };
static const char *const ramp_words[] = { WR_RAMPS(WR_WORD) NULL };
static const char *const angle_words[] = { "90", "180", "270", NULL };
static const char *const filter_words[] = { WR_RESIZE_FILTERS(WR_WORD) NULL };
static const char *const window_words[] = { WR_WINDOWS(WR_WORD) NULL };
static const char *const between_words[] = { WR_WARP_BETWEENS(WR_WORD) NULL };
static const char *const side_words[] = { WR_LIMIT_SIDES(WR_WORD) NULL };

#define SIGMA(default_)                                                                            \
    {                                                                                              \
        .name = "sigma", .label = "Width", .help = "standard deviation of the Gaussian",           \
        .unit = "texels", .fallback = default_, .low = 0, .high = 1024, .soft_low = 0,             \
        .soft_high = 64                                                                            \
    }
#define RADIUS(most, soft_most)                                                                    \
    {                                                                                              \
        .name = "radius", .label = "Radius", .help = "radius of the window; 0 changes nothing",    \
        .unit = "texels", .fallback = 2, .low = 0, .high = most, .soft_low = 0,                    \
        .soft_high = soft_most                                                                     \
    }
#define TEXELS(name_, label_, help_, fallback_, low_, high_)                                       \
    {                                                                                              \
        .name = name_, .label = label_, .help = help_, .unit = "texels", .fallback = fallback_,    \
        .low = low_, .high = high_, .soft_low = low_, .soft_high = high_, .whole = true            \
    }
#define WHOLE(name_, label_, help_, fallback_, low_, high_, soft_high_)                            \
    {                                                                                              \
        .name = name_, .label = label_, .help = help_, .unit = "", .fallback = fallback_,          \
        .low = low_, .high = high_, .soft_low = low_, .soft_high = soft_high_, .whole = true       \
    }
#define CELLS(fallback_)                                                                           \
    WHOLE("cells", "Cells", "cells of the coarsest octave across the table; about square",         \
          fallback_, 1, 8192, 64)
#define SHIFT(name_, label_, help_)                                                                \
    {                                                                                              \
        .name = name_, .label = label_, .help = help_, .unit = "texels", .low = -WR_FIELD_MAX,     \
        .high = WR_FIELD_MAX, .soft_low = -WR_FIELD_MAX, .soft_high = WR_FIELD_MAX, .whole = true, \
        .share = true                                                                              \
    }
#define EDGE_WIDTH(help_)                                                                          \
    {                                                                                              \
        .name = "width", .label = "Width", .help = help_, .unit = "texels", .low = 0,              \
        .high = WR_FIELD_MAX / 2, .soft_high = 256, .whole = true                                  \
    }
#define SEED WHOLE("seed", "Seed", "seed of the random numbers", 1, 0, 4294967295.0, 100)
#define WORDS(name_, label_, help_, fallback_, words)                                              \
    {                                                                                              \
        .name = name_, .label = label_, .help = help_, .unit = "", .fallback = fallback_,          \
        .high = WR_LENGTH(words) - 2, .soft_high = WR_LENGTH(words) - 2, .whole = true,            \
        .choices = words                                                                           \
    }

static const double straight[] = { 2, 0, 0, 1, 1 };

const WrOpInfo wr_ops[] = {
    { .name = "offset",
      .label = "Offset",
      .help = "move all texels, wrapping around the edges",
      .moves = true,
      .run = wr_op_offset,
      .params = { SHIFT("du", "To the right", "offset to the right"),
                  SHIFT("dv", "Up", "offset upwards") } },
    { .name = "flip-u",
      .label = "Flip left to right",
      .help = "mirror the table, left for right",
      .moves = true,
      .run = wr_op_flip_u },
    { .name = "flip-v",
      .label = "Flip top to bottom",
      .help = "mirror the table, top for bottom",
      .moves = true,
      .run = wr_op_flip_v },
    { .name = "rotate",
      .label = "Rotate",
      .help =
          "rotate the table counter-clockwise by quarter turns; 90 and 270 degrees swap its sides",
      .reshapes = true,
      .moves = true,
      .run = wr_op_rotate,
      .params = { WORDS("angle", "Angle", "degrees, counter-clockwise", 0, angle_words) } },
    { .name = "crop",
      .label = "Crop",
      .help = "crop the table to a rectangle, which becomes periodic on both axes",
      .reshapes = true,
      .moves = true,
      .run = wr_op_crop,
      .params = { TEXELS("x", "Left", "column of the rectangle's top left texel", 0, 0,
                         WR_FIELD_MAX - 1),
                  TEXELS("y", "Top", "row of the rectangle's top left texel, from the top", 0, 0,
                         WR_FIELD_MAX - 1),
                  TEXELS("width", "Width", "columns", 64, 1, WR_FIELD_MAX),
                  TEXELS("height", "Height", "rows", 64, 1, WR_FIELD_MAX) } },
    { .name = "resize",
      .label = "Resize",
      .help = "resample the table to another number of texels; heights are not scaled",
      .reshapes = true,
      .run = wr_op_resize,
      .params = { TEXELS("width", "Width", "columns", 512, 1, WR_FIELD_MAX),
                  TEXELS("height", "Height", "rows", 512, 1, WR_FIELD_MAX),
                  WORDS("filter", "Filter",
                        "box: mean over a texel; linear, catmull, lanczos3: "
                        "ever sharper, the last two with overshoot",
                        WR_RESIZE_CATMULL, filter_words) } },
    { .name = "seamless",
      .label = "Make seamless",
      .help = "make the table tile by matching opposite edges",
      .run = wr_op_seamless,
      .params = { WORDS("how", "Method",
                        "blend: cross-fades the edges with the table's middle, keeping contrast; "
                        "patches: cuts where both differ least; mirror: mirrors the top left "
                        "quarter; frequency: removes slopes across the table, keeps detail",
                        WR_REPEAT_BLEND, repeat_words),
                  EDGE_WIDTH("width of the changed strip at each edge, for blend and patches; 0: "
                             "an eighth of the side; at most a quarter") } },
    { .name = "match-edges",
      .label = "Match edges",
      .help = "raise and lower opposite edges until they have equal heights",
      .run = wr_op_match_edges,
      .params = { EDGE_WIDTH("width of the changed strip at each edge; 0: an eighth of the side; "
                             "at most a half"),
                  WORDS("ramp", "Ramp", "fade of the change inwards", WR_RAMP_SMOOTH,
                        ramp_words) } },
    { .name = "even-light",
      .label = "Even out light",
      .help =
          "remove variation wider than a Gaussian, such as shading; detail and mean height stay",
      .run = wr_op_even_light,
      .params = { SIGMA(32) } },
    { .name = "levels",
      .label = "Levels",
      .help = "map in-low to out-low and in-high to out-high, with a curve between them",
      .run = wr_op_levels,
      .params = { HEIGHT("in-low", "From low", "height mapped to out-low", 0),
                  HEIGHT("in-high", "From high", "height mapped to out-high", 1),
                  { .name = "gamma",
                    .label = "Gamma",
                    .help = "exponent 1/gamma of the heights between in-low and in-high; above 1 "
                            "raises them",
                    .unit = "",
                    .fallback = 1,
                    .low = 0.01,
                    .high = 100,
                    .soft_low = 0.1,
                    .soft_high = 10 },
                  HEIGHT("out-low", "To low", "new height of in-low", 0),
                  HEIGHT("out-high", "To high", "new height of in-high", 1) } },
    { .name = "curves",
      .label = "Curves",
      .help = "map heights by a smooth curve through points; beyond the first and last point it is "
              "a straight line",
      .run = wr_op_curves,
      .params = { { .name = "points",
                    .label = "Points",
                    .help = "heights before and after; between them a monotone cubic (Fritsch "
                            "and Carlson)",
                    .unit = HEIGHT_UNIT,
                    .low = -FLT_MAX,
                    .high = FLT_MAX,
                    .soft_low = -1,
                    .soft_high = 2,
                    .points = straight } } },
    { .name = "invert",
      .label = "Invert",
      .help = "turn bumps into dents",
      .run = wr_op_invert,
      .params = { WORDS("about", "Pivot",
                        "range: about the middle of the range; zero: about 0, changing signs",
                        WR_INVERT_RANGE, invert_words) } },
    { .name = "normalise",
      .label = "Normalise",
      .help =
          "map the table's lowest height to low and its highest to high; a flat table becomes low",
      .run = wr_op_normalise,
      .params = { HEIGHT("low", "Low", "new lowest height", 0),
                  HEIGHT("high", "High", "new highest height", 1) } },
    { .name = "add",
      .label = "Add",
      .help = "add a constant to every height",
      .run = wr_op_add,
      .params = { HEIGHT("amount", "Amount", "the added height", 0) } },
    { .name = "multiply",
      .label = "Multiply",
      .help = "multiply every height by a constant",
      .run = wr_op_multiply,
      .params = { { .name = "factor",
                    .label = "Factor",
                    .help = "factor of each height",
                    .unit = "",
                    .fallback = 1,
                    .low = -FLT_MAX,
                    .high = FLT_MAX,
                    .soft_low = -2,
                    .soft_high = 4 } } },
    { .name = "clamp",
      .label = "Clamp",
      .help = "clamp heights to low and high",
      .run = wr_op_clamp,
      .params = { HEIGHT("low", "Low", "lowest height allowed", 0),
                  HEIGHT("high", "High", "highest height allowed", 1) } },
    { .name = "blur",
      .label = "Gaussian blur",
      .help = "smooth the table with a Gaussian; the mean height stays",
      .run = wr_op_blur,
      .params = { SIGMA(2) } },
    { .name = "sharpen",
      .label = "Sharpen",
      .help = "add the detail that a Gaussian blur would remove (unsharp mask)",
      .run = wr_op_sharpen,
      .params = { { .name = "amount",
                    .label = "Amount",
                    .help = "strength: multiple of the removed detail",
                    .unit = "",
                    .fallback = 1,
                    .low = 0,
                    .high = 100,
                    .soft_low = 0,
                    .soft_high = 5 },
                  SIGMA(2) } },
    { .name = "median",
      .label = "Median",
      .help = "set each texel to the median height of a window: removes specks, keeps edges",
      .run = wr_op_median,
      .params = { RADIUS(32, 8), WORDS("window", "Window", "shape of the window", WR_WINDOW_ROUND,
                                       window_words) } },
    { .name = "dilate",
      .label = "Dilate",
      .help = "give each texel the largest height of a round window: bumps grow",
      .run = wr_op_dilate,
      .params = { RADIUS(64, 16) } },
    { .name = "erode",
      .label = "Erode",
      .help = "give each texel the smallest height of a round window: dents grow",
      .run = wr_op_erode,
      .params = { RADIUS(64, 16) } },
    { .name = "slope-limit",
      .label = "Limit slope",
      .help = "limit the difference between neighbouring texels (diagonally sqrt(2) limit), "
              "changing as little as possible",
      .run = wr_op_slope_limit,
      .params = { { .name = "limit",
                    .label = "Limit",
                    .help = "largest change from a texel to the next",
                    .unit = "table units per texel",
                    .fallback = 0.1,
                    .low = 0,
                    .high = FLT_MAX,
                    .soft_low = 0,
                    .soft_high = 1 },
                  WORDS(
                      "side", "Side",
                      "below: only lowers heights; above: only raises them; mean: the mean of both",
                      WR_SIDE_MEAN, side_words) } },
    { .name = "noise",
      .label = "Noise",
      .help = "add noise that tiles",
      .run = wr_op_noise,
      .params = { HEIGHT("amount", "Amount", "amplitude of the coarsest octave", 0.1),
                  CELLS(16),
                  WHOLE("octaves", "Octaves",
                        "number of octaves, each twice as fine and half as high; those too fine "
                        "for the table are left out",
                        4, 1, WR_OCTAVES_MAX, 8),
                  { .name = "kind",
                    .label = "Kind",
                    .help = "kind of noise",
                    .unit = "",
                    .high = WR_OP_NOISE_COUNT - 1,
                    .soft_high = WR_OP_NOISE_COUNT - 1,
                    .whole = true,
                    .choices = wr_op_noise_kinds },
                  { .name = "mode",
                    .label = "Fractal type",
                    .help = "sum of: fbm: noise; turbulence: its absolute value; billow: the same, "
                            "centred about 0; ridged: crests where noise is 0",
                    .unit = "",
                    .high = WR_OCTAVES_MODE_COUNT - 1,
                    .soft_high = WR_OCTAVES_MODE_COUNT - 1,
                    .whole = true,
                    .choices = wr_octaves_words },
                  SEED } },
    { .name = "warp",
      .label = "Warp",
      .help = "displace heights sideways by noise that tiles",
      .moves = true,
      .run = wr_op_warp,
      .params = { { .name = "amount",
                    .label = "Amount",
                    .help = "largest displacement along an axis",
                    .unit = "texels",
                    .fallback = 12,
                    .low = 0,
                    .high = 256,
                    .soft_low = 0,
                    .soft_high = 64 },
                  CELLS(4),
                  WHOLE("octaves", "Octaves",
                        "number of octaves, each twice as fine and with half the displacement", 2,
                        1, WR_OCTAVES_MAX, 8),
                  WORDS("between", "Between texels", "interpolation between texels", WR_WARP_CUBIC,
                        between_words),
                  SEED } },
    { .name = NULL }
};
const int wr_op_count = sizeof wr_ops / sizeof *wr_ops - 1;

const WrOpInfo *wr_op_find(const char *name)
{
    for (const WrOpInfo *op = wr_ops; op->name; op++)
        if (strcmp(op->name, name) == 0) return op;
    return NULL;
}

int wr_op_param_count(const WrOpInfo *op)
{
    int count = 0;
    while (op->params[count].name) count++;
    return count;
}

static bool check_mask(const WrOpInfo *op, const WrField *in, const WrField *mask, WrError *err)
{
    if (!mask) return true;
    if (op->reshapes)
        return wr_fail(err, "%s: changes the whole table, so it cannot be limited to a selection",
                       op->name);
    if (wr_field_width(mask) == wr_field_width(in) && wr_field_height(mask) == wr_field_height(in))
        return true;
    return wr_fail(err, "%s: selection of %dx%d texels: must be %dx%d, as the table", op->name,
                   wr_field_width(mask), wr_field_height(mask), wr_field_width(in),
                   wr_field_height(in));
}

WrField *wr_op_run(const WrOpInfo *op, const WrField *in, const double *param,
                   const WrOpOptions *options, WrError *err)
{
    static const WrOpOptions none;
    const WrFilter usual = wr_filter_of(op);
    if (!options) options = &none;
    if (!param) param = usual.param;
    if (!op_check_params(op, param, err)) return NULL;
    if (!check_mask(op, in, options->mask, err)) return NULL;
    WR_ASSERT(!options->was || !options->mask);
    WrOpJob job = { .name = op->name,
                    .in = in,
                    .mask = options->mask,
                    .was = options->was,
                    .made = options->made,
                    .pool = options->pool,
                    .progress = options->progress,
                    .to = 1.0,
                    .err = err };
    return op->run(&job, param);
}

/* Selections are tables of 0..1: an operation that overshoots (lanczos, sharpen) is clamped afterwards. */
WrField *wr_op_run_unit(const WrOpInfo *op, const WrField *in, const double *param,
                        const WrOpOptions *options, WrError *err)
{
    const double unit[WR_OP_VALUES] = { 0, 1 };
    WrField *made = wr_op_run(op, in, param, options, err);
    if (!made) return NULL;
    /* a progress that falls back to 0 would confuse the user */
    WrProgressPart quiet = { .progress = { 0 } };
    wr_progress_part(&quiet, options ? options->progress : NULL, 0.0, 1.0);
    quiet.progress.report = NULL;
    const WrOpOptions rest = { .pool = options ? options->pool : NULL,
                               .progress = &quiet.progress };
    const WrOpInfo *clamp = wr_op_find("clamp");
    WR_ASSERT(clamp);
    WrField *kept = wr_op_run(clamp, made, unit, &rest, err);
    wr_field_free(made);
    return kept;
}

/* The table of operations, and their common entry point, which checks all arguments. */
#include "field/ops.h"

#include "base/error.h"
#include "base/progress.h"
#include "field/field.h"
#include "field/ops_internal.h"
#include "noise/octaves.h"

#include <math.h>
#include <string.h>

#define HEIGHT_UNIT "table units"
/* Any height, with the slider range and the default. */
#define HEIGHT(name_, label_, help_, fallback_)                                                    \
    {                                                                                              \
        .name = name_, .label = label_, .help = help_, .unit = HEIGHT_UNIT, .fallback = fallback_, \
        .low = -FLT_MAX, .high = FLT_MAX, .soft_low = -1, .soft_high = 2                           \
    }

static const char *const invert_words[] = { WR_INVERT_ABOUTS(WR_WORD) NULL };
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
        .name = "radius", .label = "Radius",                                                       \
        .help = "how far the window reaches; 0 changes "                                           \
                "nothing",                                                                         \
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
    WHOLE("cells", "Cells", "of the coarsest noise, across the table; upwards about as large",     \
          fallback_, 1, 8192, 64)
#define SHIFT(name_, label_, help_)                                                                \
    {                                                                                              \
        .name = name_, .label = label_, .help = help_, .unit = "texels", .low = -WR_FIELD_MAX,     \
        .high = WR_FIELD_MAX, .soft_low = -WR_FIELD_MAX, .soft_high = WR_FIELD_MAX, .whole = true, \
        .share = true                                                                              \
    }
#define SEED WHOLE("seed", "Seed", "another number, another noise", 1, 0, 4294967295.0, 100)
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
      .help = "move all texels, those that leave on one side coming in on the other",
      .moves = true,
      .run = wr_op_offset,
      .params = { SHIFT("du", "To the right", "to the right"), SHIFT("dv", "Up", "upwards") } },
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
      .help = "turn the table counter-clockwise by quarter turns; a quarter turn swaps its sides",
      .reshapes = true,
      .moves = true,
      .run = wr_op_rotate,
      .params = { WORDS("angle", "Angle", "degrees, counter-clockwise", 0, angle_words) } },
    { .name = "crop",
      .label = "Crop",
      .help = "make a rectangle of the table the new cell, periodic on both axes",
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
      .help = "bring the table to another number of texels; heights stay as high as they are",
      .reshapes = true,
      .run = wr_op_resize,
      .params = { TEXELS("width", "Width", "columns", 512, 1, WR_FIELD_MAX),
                  TEXELS("height", "Height", "rows", 512, 1, WR_FIELD_MAX),
                  WORDS("filter", "Filter",
                        "box: mean of what a texel covers; linear, catmull, lanczos3: "
                        "ever sharper, the last two with overshoot",
                        WR_RESIZE_CATMULL, filter_words) } },
    { .name = "levels",
      .label = "Levels",
      .help = "bring in-low to out-low and in-high to out-high, with a curve between them",
      .run = wr_op_levels,
      .params = { HEIGHT("in-low", "From low", "height that becomes out-low", 0),
                  HEIGHT("in-high", "From high", "height that becomes out-high", 1),
                  { .name = "gamma",
                    .label = "Gamma",
                    .help = "heights above in-low, as parts of in-low to in-high, to the power "
                            "1/gamma: above 1 lifts what is between",
                    .unit = "",
                    .fallback = 1,
                    .low = 0.01,
                    .high = 100,
                    .soft_low = 0.1,
                    .soft_high = 10 },
                  HEIGHT("out-low", "To low", "height that in-low becomes", 0),
                  HEIGHT("out-high", "To high", "height that in-high becomes", 1) } },
    { .name = "curves",
      .label = "Curves",
      .help = "give each height the one that a smooth curve through points has there; beyond the "
              "first and the last point it goes on straight",
      .run = wr_op_curves,
      .params = { { .name = "points",
                    .label = "Points",
                    .help = "heights and what they become; between them a monotone cubic (Fritsch "
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
      .params = { WORDS("about", "About",
                        "range: the lowest and the highest change places; zero: "
                        "the sign changes",
                        WR_INVERT_RANGE, invert_words) } },
    { .name = "normalise",
      .label = "Normalise",
      .help = "bring the table's lowest height to low and its highest to high; a flat table "
              "becomes low",
      .run = wr_op_normalise,
      .params = { HEIGHT("low", "Low", "new lowest height", 0),
                  HEIGHT("high", "High", "new highest height", 1) } },
    { .name = "add",
      .label = "Add",
      .help = "add a constant to every height",
      .run = wr_op_add,
      .params = { HEIGHT("amount", "Amount", "what is added", 0) } },
    { .name = "multiply",
      .label = "Multiply",
      .help = "multiply every height by a constant",
      .run = wr_op_multiply,
      .params = { { .name = "factor",
                    .label = "Factor",
                    .help = "what each height is multiplied by",
                    .unit = "",
                    .fallback = 1,
                    .low = -FLT_MAX,
                    .high = FLT_MAX,
                    .soft_low = -2,
                    .soft_high = 4 } } },
    { .name = "clamp",
      .label = "Clamp",
      .help = "cut off what is below low or above high",
      .run = wr_op_clamp,
      .params = { HEIGHT("low", "Low", "no height will be below", 0),
                  HEIGHT("high", "High", "no height will be above", 1) } },
    { .name = "blur",
      .label = "Gaussian blur",
      .help = "smooth the table with a Gaussian; the mean height stays",
      .run = wr_op_blur,
      .params = { SIGMA(2) } },
    { .name = "sharpen",
      .label = "Sharpen",
      .help = "add what a Gaussian blur would take away (unsharp mask)",
      .run = wr_op_sharpen,
      .params = { { .name = "amount",
                    .label = "Amount",
                    .help = "how many times what the blur takes away",
                    .unit = "",
                    .fallback = 1,
                    .low = 0,
                    .high = 100,
                    .soft_low = 0,
                    .soft_high = 5 },
                  SIGMA(2) } },
    { .name = "median",
      .label = "Median",
      .help = "give each texel the middle height of a window: takes away specks, keeps edges",
      .run = wr_op_median,
      .params = { RADIUS(32, 8),
                  WORDS("window", "Window", "its shape", WR_WINDOW_ROUND, window_words) } },
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
      .help = "let no height differ from the next texel's by more than limit (diagonally sqrt(2) "
              "limit), changing as little as possible",
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
                  WORDS("side", "Side",
                        "below: only lower heights; above: only raise them; mean: half way",
                        WR_SIDE_MEAN, side_words) } },
    { .name = "noise",
      .label = "Noise",
      .help = "add noise that tiles",
      .run = wr_op_noise,
      .params = { HEIGHT("amount", "Amount", "height of the coarsest noise", 0.1),
                  CELLS(16),
                  WHOLE("octaves", "Octaves",
                        "noises, each twice as fine and half as high; those too fine for the "
                        "table are left out",
                        4, 1, WR_OCTAVES_MOST, 8),
                  { .name = "kind",
                    .label = "Kind",
                    .help = "of the noise",
                    .unit = "",
                    .high = WR_OP_NOISE_COUNT - 1,
                    .soft_high = WR_OP_NOISE_COUNT - 1,
                    .whole = true,
                    .choices = wr_op_noise_kinds },
                  { .name = "mode",
                    .label = "Sum of",
                    .help = "fbm: the noises; turbulence: their amounts; billow: these about 0; "
                            "ridged: crests where they are 0",
                    .unit = "",
                    .high = WR_OCTAVES_MODE_COUNT - 1,
                    .soft_high = WR_OCTAVES_MODE_COUNT - 1,
                    .whole = true,
                    .choices = wr_octaves_words },
                  SEED } },
    { .name = "warp",
      .label = "Warp",
      .help = "move heights to the side by noise that tiles",
      .moves = true,
      .run = wr_op_warp,
      .params = { { .name = "amount",
                    .label = "Amount",
                    .help = "how far a height is moved along an axis, at most",
                    .unit = "texels",
                    .fallback = 12,
                    .low = 0,
                    .high = 256,
                    .soft_low = 0,
                    .soft_high = 64 },
                  CELLS(4),
                  WHOLE("octaves", "Octaves", "noises, each twice as fine and half as far", 2, 1,
                        WR_OCTAVES_MOST, 8),
                  WORDS("between", "Between texels", "what heights between texels are taken to be",
                        WR_WARP_CUBIC, between_words),
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
        return wr_fail(err, "%s: changes the whole table: it cannot be kept to a selection",
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
    if (!wr_op_check_params(op, param, err)) return NULL;
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
    WrField *kept = wr_op_run(wr_op_find("clamp"), made, unit, &rest, err);
    wr_field_free(made);
    return kept;
}

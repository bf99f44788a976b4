/* Arguments of what paints: the brush, dab, stroke, shape, flood, ramp. */
#include "command/args.h"

#include "field/ramp.h"
#include "field/select.h"

static const char *const off_on[] = { "off", "on", NULL };
static const char *const mirrors[] = { "none", "u", "v", "uv", NULL };
static const char *const paints[] = { "outline", "fill", NULL };
static const char *const ramp_blends[] = { "replace", "add", "max", "min", NULL };

static const char *mode_name(int i)
{
    return i < WR_BRUSH_MODE_COUNT ? wr_brush_modes[i].name : NULL;
}

static const char *pressure_name(int i)
{
    return i < WR_PRESSURE_COUNT ? wr_brush_pressures[i] : NULL;
}

/* "adds strength to the height (strength)": the argument names that the mode goes by. */
static void explain_mode(int i, WrText *text)
{
    static const struct {
        unsigned bit;
        const char *name;
    } uses[] = { { WR_USES_STRENGTH, "strength=" },
                 { WR_USES_TO, "to=" },
                 { WR_USES_REACH, "reach=" },
                 { WR_USES_SOURCE, "source=" } };
    const WrBrushModeInfo *mode = &wr_brush_modes[i];
    wr_text_add(text, mode->help);
    const char *before = " (";
    for (size_t k = 0; k < sizeof uses / sizeof *uses; k++)
        if (mode->uses & uses[k].bit) {
            wr_text_addf(text, "%s%s", before, uses[k].name);
            before = " ";
        }
    if (*before == ' ' && before[1] == '\0') wr_text_add(text, ")");
}

/* ---- the brush ---- */

/* What the covering of a region goes by. */
#define PAINT_ARGS                                                                                 \
    { .name = "strength",                                                                          \
      .type = WR_ARG_NUMBER,                                                                       \
      .low = -WR_BIG_HEIGHT,                                                                       \
      .high = WR_BIG_HEIGHT,                                                                       \
      .fallback = NUMBERS(0.1),                                                                    \
      .help = "how much the centre changes" },                                                     \
        { .name = "mode",                                                                          \
          .type = WR_ARG_CHOICE,                                                                   \
          .choice = mode_name,                                                                     \
          .explain = explain_mode,                                                                 \
          .fallback_text = "raise",                                                                \
          .help = "what it does" },                                                                \
        { .name = "to",                                                                            \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .fallback = NUMBERS(0),                                                                  \
          .help = "a height, for the modes that go by one" },                                      \
        { .name = "opacity",                                                                       \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = 1,                                                                               \
          .fallback = NUMBERS(1),                                                                  \
          .help = "how much of the whole counts" },                                                \
        { .name = "reach",                                                                         \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_FIELD_MAX,                                                                    \
          .fallback = NUMBERS(0),                                                                  \
          .unit = "texels",                                                                        \
          .help = "how far the modes that look around see; 0: an eighth of the radius, at least "  \
                  "1" },                                                                           \
    {                                                                                              \
        .name = "source", .type = WR_ARG_TUPLE, .components = 2, .shape = "du,dv", .low = -1e6,    \
        .high = 1e6, .help = "clone: the heights come from u + du, v + dv"                         \
    }

static const WrComponent jitter_parts[] = { { "place", 0, 100, false },
                                            { "angle", 0, 180, false },
                                            { "size", 0, 1, false } };

const WrArgSpec wr_args_brush[] = {
    { .name = "radius",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 1e9,
      .fallback = NUMBERS(16),
      .unit = "texels",
      .help = "from the centre to where nothing changes" },
    { .name = "hardness",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 1,
      .fallback = NUMBERS(0.5),
      .help = "part of the radius that is fully covered" },
    PAINT_ARGS,
    { .name = "flow",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 1,
      .fallback = NUMBERS(1),
      .help = "how much each dab covers: below 1 the stroke builds up to its opacity" },
    { .name = "buildup",
      .type = WR_ARG_CHOICE,
      .words = off_on,
      .fallback_text = "off",
      .help = "on: it builds up without end, also where it crosses itself" },
    { .name = "spacing",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 10,
      .fallback = NUMBERS(0),
      .unit = "radii",
      .help = "between dabs, at least 0.01; 0: the mode's or the tip's own" },
    { .name = "pressure",
      .type = WR_ARG_CHOICE,
      .choice = pressure_name,
      .fallback_text = "strength",
      .help = "what the pen's pressure turns; presets have their own curves" },
    { .name = "preset",
      .type = WR_ARG_PRESET,
      .help = "a brush preset by its name (`wrinkle brushes` lists them), or a .myb file; what is "
              "given besides takes the place of the preset's own" },
    { .name = "preset_sha256",
      .type = WR_ARG_SHA256,
      .help = "of the preset's file: another content is then an error" },
    { .name = "set",
      .type = WR_ARG_TEXT,
      .check = wr_check_settings,
      .shape = "name=value;...",
      .help = "other values of the preset's settings, as MyPaint calls them" },
    { .name = "seed",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 0x1p53,
      .whole = true,
      .fallback = NUMBERS(0),
      .help = "of all that is random in it" },
    { .name = "tip",
      .type = WR_ARG_PATH,
      .help = "a picture, .gbr or .gih file in place of the round dab" },
    { .name = "tip_sha256",
      .type = WR_ARG_SHA256,
      .help = "of the tip's file: another content is then an error" },
    { .name = "angle",
      .type = WR_ARG_NUMBER,
      .low = -360,
      .high = 360,
      .fallback = NUMBERS(0),
      .unit = "degrees",
      .help = "turns a tip or an ellipse anticlockwise" },
    { .name = "aspect",
      .type = WR_ARG_NUMBER,
      .low = 1,
      .high = 100,
      .fallback = NUMBERS(1),
      .help = "length over breadth" },
    { .name = "follow",
      .type = WR_ARG_CHOICE,
      .words = off_on,
      .fallback_text = "off",
      .help = "on: the angle counts from the path's direction" },
    { .name = "jitter",
      .type = WR_ARG_TUPLE,
      .components = 3,
      .parts = jitter_parts,
      .shape = "place,angle,size",
      .fallback = NUMBERS(0, 0, 0),
      .help = "chance of each dab: place in radii, angle in degrees either way, size 0..1 down" },
    { .name = "mirror",
      .type = WR_ARG_CHOICE,
      .words = mirrors,
      .fallback_text = "none",
      .help = "drawn again as in a mirror that stands across u, v or both" },
    { .name = "radial",
      .type = WR_ARG_NUMBER,
      .low = 1,
      .high = 360,
      .whole = true,
      .fallback = NUMBERS(1),
      .help = "drawn so many times about the centre" },
    { .name = "centre",
      .type = WR_ARG_TUPLE,
      .components = 2,
      .shape = "u,v",
      .low = -1e6,
      .high = 1e6,
      .fallback = NUMBERS(0.5, 0.5),
      .help = "of the mirrors and turns" },
    { .name = "repeat",
      .type = WR_ARG_SIZE,
      .shape = "MxN",
      .low = 1,
      .high = 64,
      .fallback = NUMBERS(1, 1),
      .help = "drawn so many times across and down the cell" },
    { .name = "stagger",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = 1,
      .fallback = NUMBERS(0),
      .help = "by this part of a row each column is moved up; M stagger must be whole" },
    { 0 }
};

const WrArgSpec wr_args_dab[] = { { PLACE("u,v"), .type = WR_ARG_TUPLE, .components = 2,
                                    .low = -1e9, .high = 1e9, .help = "the centre; v up" },
                                  { 0 } };

static const WrComponent sample_parts[] = {
    { "u", -1e9, 1e9, false },        { "v", -1e9, 1e9, false },
    { "pressure", -1e9, 1e9, false }, { "tilt_x", -1e9, 1e9, false },
    { "tilt_y", -1e9, 1e9, false },   { "seconds", -1e9, 1e9, false },
};

const WrArgSpec wr_args_stroke[] = {
    { .name = "points",
      .type = WR_ARG_LIST,
      .required = true,
      .components = 6,
      .parts = sample_parts,
      .counts = TUPLE_OF(2) | TUPLE_OF(3) | TUPLE_OF(5) | TUPLE_OF(6),
      .rows_low = 1,
      .rows_high = WR_POINTS_MAX,
      .shape = "u,v[,pressure[,tilt_x,tilt_y[,seconds]]];...",
      .help = "the pen's samples in order; pressure is clamped to 0..1, tilt to -1..1" },
    { 0 }
};

/* ---- shapes ---- */

#define POINT(name_, help_)                                                                        \
    {                                                                                              \
        .name = name_, .type = WR_ARG_TUPLE, .required = true, .components = 2, .shape = "u,v",    \
        .low = -WR_SELECT_REACH, .high = WR_SELECT_REACH, .help = help_                            \
    }
#define POINTS(low_, high_, help_)                                                                 \
    {                                                                                              \
        .name = "points", .type = WR_ARG_LIST, .required = true, .components = 2,                  \
        .shape = "u,v;...", .rows_low = low_, .rows_high = high_, .low = -WR_SELECT_REACH,         \
        .high = WR_SELECT_REACH, .help = help_                                                     \
    }
#define TURN                                                                                       \
    {                                                                                              \
        .name = "turn", .type = WR_ARG_NUMBER, .low = -360, .high = 360, .fallback = NUMBERS(0),   \
        .unit = "degrees", .help = "turns the shape anticlockwise about its middle"                \
    }
#define PAINT                                                                                      \
    {                                                                                              \
        .name = "paint", .type = WR_ARG_CHOICE, .words = paints, .fallback_text = "outline",       \
        .help = "draw its outline with the brush, or cover its inside with what the mode does"     \
    }

/* In the order of run_figure.c. */
static const WrForm shape_forms[] = {
    { .name = "rectangle",
      .help = "between two corners",
      .args = { POINT("a", "a corner"),
                POINT("b", "the corner across"),
                { .name = "corner",
                  .type = WR_ARG_NUMBER,
                  .low = 0,
                  .high = 1e9,
                  .fallback = NUMBERS(0),
                  .unit = "texels",
                  .help = "radius of its corners, at most half the shorter side" },
                TURN,
                PAINT } },
    { .name = "ellipse",
      .help = "about a point",
      .args = { POINT("middle", "its middle"),
                { .name = "radii",
                  .type = WR_ARG_TUPLE,
                  .required = true,
                  .components = 2,
                  .shape = "ru,rv",
                  .low = 0,
                  .high = WR_SELECT_REACH,
                  .help = "half its width and height, in parts of the cell as u and v" },
                TURN,
                PAINT } },
    { .name = "polygon",
      .help = "through points, closed; inside is where a ray meets it an odd number of times",
      .args = { POINTS(3, WR_SELECT_POINTS, "its corners in order"), PAINT } },
    { .name = "path",
      .help = "cubic Bezier curves, each from the end of the one before",
      .args = { POINTS(4, 3 * 4096 + 1, "the start, then for each curve two handles and its end"),
                { .name = "closed",
                  .type = WR_ARG_CHOICE,
                  .words = off_on,
                  .fallback_text = "off",
                  .help = "on: the outline goes straight back from the end to the start; a fill "
                          "always does" },
                PAINT } },
};

bool wr_form_shape(int i, WrForm *out)
{
    if (i >= (int)(sizeof shape_forms / sizeof *shape_forms)) return false;
    *out = shape_forms[i];
    return true;
}

/* ---- flood, ramp ---- */

const WrArgSpec wr_args_flood[] = {
    { PLACE("u,v"), .type = WR_ARG_TUPLE, .components = 2, .low = -1e6, .high = 1e6,
      .help = "where it begins" },
    { .name = "tolerance",
      .type = WR_ARG_NUMBER,
      .low = 0,
      .high = WR_BIG_HEIGHT,
      .fallback = NUMBERS(0.01),
      .unit = "height units",
      .help = "how far the composite's heights may be from the one at u,v" },
    { .name = "diagonal",
      .type = WR_ARG_CHOICE,
      .words = off_on,
      .fallback_text = "off",
      .help = "on: texels that meet at a corner are connected too" },
    PAINT_ARGS,
    { 0 }
};

#define HEIGHT(name_, default_, help_)                                                             \
    {                                                                                              \
        .name = name_, .type = WR_ARG_NUMBER, .low = -WR_BIG_HEIGHT, .high = WR_BIG_HEIGHT,        \
        .fallback = NUMBERS(default_), .help = help_                                               \
    }
#define RAMP_ARGS                                                                                  \
    POINT("from", "where the height is low"), POINT("to", "where it is high"),                     \
        HEIGHT("low", 0, "the height at from"), HEIGHT("high", 1, "the height at to"),             \
        { .name = "fold",                                                                          \
          .type = WR_ARG_CHOICE,                                                                   \
          .words = off_on,                                                                         \
          .fallback_text = "off",                                                                  \
          .help = "on: it leads back down again, so that nothing jumps" },                         \
    {                                                                                              \
        .name = "blend", .type = WR_ARG_CHOICE, .words = ramp_blends, .fallback_text = "replace",  \
        .help = "how it joins the heights that are there"                                          \
    }

/* In the order of WrRampKind. */
static const WrForm ramp_forms[WR_RAMP_KINDS] = {
    { .name = "linear",
      .help = "along the way; low before from, high after to. On periodic axes it jumps half a "
              "table away from the middle of the way; fold=on leads from to on round the table "
              "back to from instead, along u and v each",
      .args = { RAMP_ARGS } },
    { .name = "radial",
      .help = "by the distance from from, round all edges; high beyond to, or with fold=on a ring "
              "that is low again at twice the distance. Nothing jumps",
      .args = { RAMP_ARGS } },
    { .name = "cone",
      .help =
          "by the angle about from, anticlockwise from the direction of to, where it jumps, as "
          "it does half a table away; fold=on rises for half a turn and falls for the other, and "
          "beyond a quarter of the table mirrors itself, so that nothing jumps",
      .args = { RAMP_ARGS } },
};

bool wr_form_ramp(int i, WrForm *out)
{
    if (i >= WR_RAMP_KINDS) return false;
    *out = ramp_forms[i];
    return true;
}

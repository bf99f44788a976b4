/* Arguments of layer, select and adjust. */
#include "command/args.h"

#include "document/document.h"
#include "field/ops.h"
#include "field/select.h"

static const char *blend_name(int i)
{
    return i < WR_BLEND_COUNT ? wr_blends[i].name : NULL;
}

static const char *const off_on[] = { "off", "on", NULL };
static const char *const mask_sources[] = { "selection", "none", "white", "black", NULL };
static const char *const join_modes[] = { "replace", "add", "subtract", "intersect", NULL };
static const char *const layer_choices[] = { "active", "all", NULL };

#define LAYER_N                                                                                    \
    {                                                                                              \
        PLACE("N"), .type = WR_ARG_LAYER, .help = "the layer"                                      \
    }
#define LAYER_SETTINGS                                                                             \
    { .name = "blend",                                                                             \
      .type = WR_ARG_CHOICE,                                                                       \
      .choice = blend_name,                                                                        \
      .help = "how it joins what lies below" },                                                    \
        { .name = "opacity",                                                                       \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = 1,                                                                               \
          .help = "how much of it shows" },                                                        \
    {                                                                                              \
        .name = "radius", .type = WR_ARG_NUMBER, .low = 0, .high = WR_BIG_HEIGHT,                  \
        .unit = "height units", .help = "of the smooth blends: how near heights must be to melt"   \
    }

static const WrForm layer_forms[] = {
    { .name = "add",
      .help = "a new layer, empty and active",
      .args = { { .name = "NAME",
                  .type = WR_ARG_NAME,
                  .positional = true,
                  .help = "left out, \"layer 2\" and so on" },
                LAYER_SETTINGS,
                { .name = "above",
                  .type = WR_ARG_LAYER,
                  .help = "where it goes; left out, above the active one" } } },
    { .name = "delete", .help = "remove a layer", .args = { LAYER_N } },
    { .name = "use", .help = "edits go to this layer from now on", .args = { LAYER_N } },
    { .name = "move",
      .help = "bring a layer to another place in the stack",
      .args = { LAYER_N,
                { .name = "to",
                  .type = WR_ARG_NUMBER,
                  .required = true,
                  .whole = true,
                  .low = 1,
                  .high = WR_LAYERS_MAX,
                  .help = "its new number" } } },
    { .name = "rename",
      .help = "give a layer another name",
      .args = { LAYER_N, { PLACE("NAME"), .type = WR_ARG_NAME, .help = "the new name" } } },
    { .name = "set",
      .help = "only what is given changes",
      .args = { LAYER_N,
                LAYER_SETTINGS,
                { .name = "visible",
                  .type = WR_ARG_CHOICE,
                  .words = off_on,
                  .help = "whether it is in the composite" },
                { .name = "lock",
                  .type = WR_ARG_CHOICE,
                  .words = off_on,
                  .help = "whether edits are refused" } } },
    { .name = "duplicate", .help = "a copy above it, active", .args = { LAYER_N } },
    { .name = "merge",
      .help = "join a layer and the one below; the composite changes by rounding at most: not at "
              "all onto layer 1, else by 2^-21 of the largest height that meets there",
      .args = { LAYER_N } },
    { .name = "flatten", .help = "one layer that holds the composite; hidden layers are lost" },
    { .name = "clear",
      .help = "heights 0, and nothing painted, inside the selection",
      .args = { { .name = "N",
                  .type = WR_ARG_LAYER,
                  .positional = true,
                  .help = "left out, the active layer" } } },
    { .name = "solo",
      .help = "show one layer alone, or all again",
      .args = { { PLACE("N|off"), .type = WR_ARG_LAYER, .help = "the layer, or off" } } },
    { .name = "mask",
      .help = "how much of a layer shows, texel by texel",
      .args = { LAYER_N,
                { .name = "from",
                  .type = WR_ARG_CHOICE,
                  .required = true,
                  .words = mask_sources,
                  .help = "what is selected, no mask, a mask that shows all or nothing" } } },
};

bool wr_form_layer(int i, WrForm *out)
{
    if (i >= (int)(sizeof layer_forms / sizeof *layer_forms)) return false;
    *out = layer_forms[i];
    return true;
}

/* ---- select ---- */

#define POINT(name_, help_)                                                                        \
    {                                                                                              \
        .name = name_, .type = WR_ARG_TUPLE, .required = true, .components = 2, .shape = "u,v",    \
        .low = -WR_SELECT_REACH, .high = WR_SELECT_REACH, .help = help_                            \
    }
#define JOIN                                                                                       \
    {                                                                                              \
        .name = "mode", .type = WR_ARG_CHOICE, .words = join_modes, .fallback_text = "replace",    \
        .help = "how it joins what is selected already"                                            \
    }
#define TEXELS(most, help_)                                                                        \
    {                                                                                              \
        .name = "by", .type = WR_ARG_NUMBER, .required = true, .low = 0, .high = most,             \
        .unit = "texels", .help = help_                                                            \
    }
#define HEIGHT(name_, help_)                                                                       \
    {                                                                                              \
        .name = name_, .type = WR_ARG_NUMBER, .required = true, .low = -WR_BIG_HEIGHT,             \
        .high = WR_BIG_HEIGHT, .help = help_                                                       \
    }
#define ANGLE(name_, default_, help_)                                                              \
    {                                                                                              \
        .name = name_, .type = WR_ARG_NUMBER, .low = 0, .high = 90, .fallback = NUMBERS(default_), \
        .unit = "degrees", .help = help_                                                           \
    }

/* In the order of run_select.c. */
static const WrForm select_forms[] = {
    { .name = "all", .help = "everything, as a selection that can be changed" },
    { .name = "none", .help = "no selection: edits act everywhere" },
    { .name = "invert", .help = "what is not selected; without a selection, all" },
    { .name = "rect",
      .help = "a rectangle; a corner beyond 0 or 1 crosses the table's edge",
      .args = { POINT("from", "a corner"), POINT("to", "the corner across"), JOIN } },
    { .name = "ellipse",
      .help = "an ellipse, its sides along u and v",
      .args = { POINT("centre", "its middle"),
                { .name = "radii",
                  .type = WR_ARG_TUPLE,
                  .required = true,
                  .components = 2,
                  .shape = "ru,rv",
                  .low = 0,
                  .high = WR_SELECT_REACH,
                  .help = "half its width and height, in parts of the cell as u and v" },
                JOIN } },
    { .name = "lasso",
      .help = "a polygon",
      .args = { { .name = "points",
                  .type = WR_ARG_LIST,
                  .required = true,
                  .components = 2,
                  .shape = "u,v;...",
                  .rows_low = 3,
                  .rows_high = WR_SELECT_POINTS,
                  .low = -WR_SELECT_REACH,
                  .high = WR_SELECT_REACH,
                  .help = "its corners in order" },
                JOIN } },
    { .name = "height",
      .help = "where the composited height lies in a range",
      .args = { HEIGHT("low", "lower end"),
                HEIGHT("high", "upper end"),
                { .name = "soft",
                  .type = WR_ARG_NUMBER,
                  .low = 0,
                  .high = WR_BIG_HEIGHT,
                  .fallback = NUMBERS(0),
                  .unit = "height units",
                  .help = "over how much it fades beyond the ends" },
                JOIN } },
    { .name = "slope",
      .help = "where the composite's slope lies in a range",
      .args = { ANGLE("low", 0, "lower end"),
                ANGLE("high", 90, "upper end"),
                ANGLE("soft", 0, "over how much it fades beyond the ends"),
                { .name = "relief",
                  .type = WR_ARG_NUMBER,
                  .low = 0,
                  .above = true,
                  .high = 1e30,
                  .unit = "texels",
                  .help = "how tall a height of 1 is; left out, as the scene's height makes it "
                          "on a cell that is one scene unit wide" },
                JOIN } },
    { .name = "flood",
      .help = "a connected part of the composite that is of about one height, without soft edge",
      .args = { { PLACE("u,v"), .type = WR_ARG_TUPLE, .components = 2, .low = -1e6, .high = 1e6,
                  .help = "where it begins" },
                { .name = "tolerance",
                  .type = WR_ARG_NUMBER,
                  .low = 0,
                  .high = WR_BIG_HEIGHT,
                  .fallback = NUMBERS(0.01),
                  .unit = "height units",
                  .help = "how far heights may be from the one at u,v" },
                { .name = "diagonal",
                  .type = WR_ARG_CHOICE,
                  .words = off_on,
                  .fallback_text = "off",
                  .help = "on: texels that meet at a corner are connected too" },
                JOIN } },
    { .name = "grow",
      .help = "move its edge outwards",
      .args = { TEXELS(WR_FIELD_MAX, "how far") } },
    { .name = "shrink",
      .help = "move its edge inwards",
      .args = { TEXELS(WR_FIELD_MAX, "how far") } },
    { .name = "feather",
      .help = "blur its edge",
      .args = { TEXELS(1024, "standard deviation of the Gaussian") } },
};

bool wr_form_select(int i, WrForm *out)
{
    if (i >= (int)(sizeof select_forms / sizeof *select_forms)) return false;
    *out = select_forms[i];
    return true;
}

/* ---- adjust ---- */

static WrArgSpec op_argument(const WrOpParam *param)
{
    WrArgSpec spec = { .name = param->name,
                       .type = WR_ARG_NUMBER,
                       .low = param->low,
                       .high = param->high,
                       .above = param->above,
                       .whole = param->whole,
                       .fallback = &param->fallback,
                       .unit = *param->unit ? param->unit : NULL,
                       .help = param->help };
    if (!param->choices) return spec;
    spec.type = WR_ARG_CHOICE;
    spec.words = param->choices;
    spec.fallback = NULL;
    spec.fallback_text = param->choices[(int)param->fallback];
    return spec;
}

/* One form an operation. */
bool wr_form_adjust(int i, WrForm *out)
{
    if (i >= wr_op_count) return false;
    const WrOpInfo *op = &wr_ops[i];
    int count = wr_op_param_count(op);
    *out = (WrForm){ .name = op->name, .help = op->help };
    for (int k = 0; k < count; k++) out->args[k] = op_argument(&op->params[k]);
    if (op->reshapes) return true;
    out->args[count] = (WrArgSpec){ .name = "layers",
                                    .type = WR_ARG_CHOICE,
                                    .words = layer_choices,
                                    .fallback_text = "active",
                                    .help = "which layers it changes" };
    return true;
}

/* Arguments of the brush, shared by all painting commands. */
#include "command/brush_args.h"

#include "base/text.h"
#include "command/args.h"
#include "field/ramp.h"
#include "field/select.h"

const char *wr_brush_mode_name(int i)
{
    return i < WR_BRUSH_MODE_COUNT ? wr_brush_modes[i].name : NULL;
}

static const char *pressure_name(int i)
{
    return i < WR_PRESSURE_COUNT ? wr_brush_pressures[i] : NULL;
}

/* "adds strength to the height (strength)": description and the names of the arguments that the mode uses. */
void wr_brush_mode_explain(int i, WrText *text)
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
      .words = wr_off_on,
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
      .shape = "name=value;name:input=x,y|x,y|...;...",
      .help = "other values of the preset's settings, as MyPaint calls them, and other curves of "
              "what an input adds to one" },
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
      .words = wr_off_on,
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
      .words = wr_mirror_names,
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

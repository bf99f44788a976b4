#include "brush/mode.h"
#include "base/enum_rows.h"

#include <math.h>

#include "brush/displace_modes.h"

const WrModeWork *wr_mode_work(WrBrushMode mode)
{
    return wr_brush_modes[mode].work;
}

WrModeArgs wr_mode_args(const WrBrush *brush)
{
    return (WrModeArgs){ .strength = brush->strength,
                         .to = brush->to,
                         .grows = brush->buildup,
                         .kernels = wr_brush_kernels() };
}

/* Terms of a mode: f height at the stroke's start, c coverage times opacity, 0..1, or more with buildup. Where c = 0 the bits
   of f remain. */
static void add(const WrModeArgs *args, double strength, const float *start, const float *part,
                int count, float *out)
{
    if (!args->grows && fabs(strength) <= WR_BRUSH_STRONG) {
        args->kernels->add(strength, start, part, count, out);
        return;
    }
    for (int i = 0; i < count; i++) {
        float made = wr_finite_float(start[i] + (double)part[i] * strength);
        out[i] = part[i] > 0.0f ? made : start[i];
    }
}

static void cover_raise(const WrModeArgs *args, const float *start, const float *part,
                        const float *target, int count, float *out)
{
    (void)target;
    add(args, args->strength, start, part, count, out);
}

static void cover_lower(const WrModeArgs *args, const float *start, const float *part,
                        const float *target, int count, float *out)
{
    (void)target;
    add(args, -args->strength, start, part, count, out);
}

static void cover_to(const WrModeArgs *args, const float *start, const float *part,
                     const float *target, int count, float *out)
{
    (void)target;
    for (int i = 0; i < count; i++) {
        double f = start[i], c = part[i], gap = args->to - f, far = fabs(gap);
        double sign = gap > 0.0 ? 1.0 : gap < 0.0 ? -1.0 : 0.0, made;
        if (args->grows) { /* steps of strength, up to `to` */
            double step = c * args->strength;
            made = step < far ? f + sign * step : args->to;
        } else if (args->strength >= far) {
            made = f * (1.0 - c) + args->to * c; /* a mean, so that c = 1 yields exactly `to` */
        } else {
            made = f + c * (sign * args->strength);
        }
        out[i] = c > 0.0 ? wr_finite_float(made) : start[i];
    }
}

/* The mean of the height and the target; part 1 yields exactly the target. */
static inline float towards(float start, float part, double target)
{
    double c = part < 1.0f ? part : 1.0f;
    float made = (float)(start * (1.0 - c) + target * c);
    return part > 0.0f ? made : start;
}

static void cover_flatten(const WrModeArgs *args, const float *start, const float *part,
                          const float *target, int count, float *out)
{
    (void)target;
    for (int i = 0; i < count; i++) out[i] = towards(start[i], part[i], args->to);
}

static void cover_lift(const WrModeArgs *args, const float *start, const float *part,
                       const float *target, int count, float *out)
{
    (void)target;
    for (int i = 0; i < count; i++)
        out[i] = start[i] < args->to ? towards(start[i], part[i], args->to) : start[i];
}

static void cover_cut(const WrModeArgs *args, const float *start, const float *part,
                      const float *target, int count, float *out)
{
    (void)target;
    for (int i = 0; i < count; i++)
        out[i] = start[i] > args->to ? towards(start[i], part[i], args->to) : start[i];
}

static void cover_target(const WrModeArgs *args, const float *start, const float *part,
                         const float *target, int count, float *out)
{
    (void)args;
    for (int i = 0; i < count; i++) out[i] = towards(start[i], part[i], target[i]);
}

static void cover_sharpen(const WrModeArgs *args, const float *start, const float *part,
                          const float *target, int count, float *out)
{
    if (!args->grows) {
        cover_target(args, start, part, target, count, out);
        return;
    }
    for (int i = 0; i < count; i++) {
        double f = start[i];
        float made = wr_finite_float(f + part[i] * (target[i] - f));
        out[i] = part[i] > 0.0f ? made : start[i];
    }
}

/* clang-format off */
#define WORK(...) &(const WrModeWork){ __VA_ARGS__ }

WR_ROWS(wr_brush_modes);
const WrBrushModeInfo wr_brush_modes[WR_BRUSH_MODE_COUNT] = {
    [WR_ROW(WR_BRUSH_RAISE)] = { "raise", "Raise", "adds strength to the height",
        false, WR_USES_STRENGTH, 0.1, WORK(.cover = cover_raise, .as_strong = true) },
    [WR_ROW(WR_BRUSH_LOWER)] = { "lower", "Lower", "subtracts strength from the height",
        false, WR_USES_STRENGTH, 0.1, WORK(.cover = cover_lower, .as_strong = true) },
    [WR_ROW(WR_BRUSH_TO)] = { "to", "To height", "moves the height towards a given one, by strength "
                                                 "at most",
        false, WR_USES_STRENGTH | WR_USES_TO, 0.1, WORK(.cover = cover_to, .as_strong = true) },
    [WR_ROW(WR_BRUSH_FLATTEN)] = { "flatten", "Flatten", "moves the height to the one where the "
                                                         "stroke began",
        false, 0, 0.1, WORK(.cover = cover_flatten, .first_height = true) },
    [WR_ROW(WR_BRUSH_LIFT)] = { "lift", "Lift floors", "raises heights below a given height up to "
                                                       "it",
        false, WR_USES_TO, 0.1, WORK(.cover = cover_lift) },
    [WR_ROW(WR_BRUSH_CUT)] = { "cut", "Cut peaks", "cuts heights above a given height down to it",
        false, WR_USES_TO, 0.1, WORK(.cover = cover_cut) },
    [WR_ROW(WR_BRUSH_ERASE)] = { "erase", "Erase", "removes the layer's effect on those below",
        false, 0, 0.1, WORK(.cover = cover_target, .target = WR_BLEND_TARGET_BELOW, .lowers_mark = true) },
    [WR_ROW(WR_BRUSH_CLONE)] = { "clone", "Clone", "copies the heights of another place",
        false, WR_USES_SOURCE, 0.1, WORK(.cover = cover_target, .target = WR_BLEND_TARGET_SHIFTED) },
    [WR_ROW(WR_BRUSH_SHARPEN)] = { "sharpen", "Sharpen", "moves the height away from the mean around it",
        false, WR_USES_REACH, 0.1, WORK(.cover = cover_sharpen, .target = WR_BLEND_TARGET_SHARP) },
    [WR_ROW(WR_BRUSH_DILATE)] = { "dilate", "Dilate", "widens high parts: to the largest height "
                                                      "around",
        false, WR_USES_REACH, 0.1, WORK(.cover = cover_target, .target = WR_BLEND_TARGET_LARGEST) },
    [WR_ROW(WR_BRUSH_ERODE)] = { "erode", "Erode", "widens low parts: to the smallest height around",
        false, WR_USES_REACH, 0.1, WORK(.cover = cover_target, .target = WR_BLEND_TARGET_SMALLEST) },
    [WR_ROW(WR_BRUSH_SMOOTH)] = { "smooth", "Smooth", "lets heights flow to lower ones nearby; their mean stays",
        true, WR_USES_REACH, 0.25, WORK(.move = wr_move_smooth) },
    [WR_ROW(WR_BRUSH_LEVEL)] = { "level", "Level", "moves heights to the plane that fits them best",
        true, 0, 0.25, WORK(.move = wr_move_level) },
    [WR_ROW(WR_BRUSH_PINCH)] = { "pinch", "Pinch", "draws heights towards the path",
        true, 0, 0.2, WORK(.move = wr_move_pinch, .margin = wr_move_pinch_margin) },
    [WR_ROW(WR_BRUSH_SMEAR)] = { "smear", "Smear", "drags heights along the path",
        true, 0, 0.1, WORK(.move = wr_move_smear, .margin = wr_move_smear_margin) },
};
WR_ROWS_END(wr_brush_modes, WR_BRUSH_MODE_COUNT);

WR_ROWS(wr_brush_pressures);
const char *const wr_brush_pressures[WR_PRESSURE_COUNT] = {
    [WR_ROW(WR_PRESSURE_STRENGTH)] = "strength",
    [WR_ROW(WR_PRESSURE_SIZE)] = "size",
    [WR_ROW(WR_PRESSURE_BOTH)] = "both",
    [WR_ROW(WR_PRESSURE_NONE)] = "none",
};
WR_ROWS_END(wr_brush_pressures, WR_PRESSURE_COUNT);
/* clang-format on */

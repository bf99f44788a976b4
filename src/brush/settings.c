/* The settings of libmypaint 1.6, in its own order, and their meaning for heights. low and high are the
   library's, but tighter where a stroke could become endless (dabs_per_..._radius) or paint nothing
   (hardness: at 0 the whole dab is edge). */
#include "base/error.h"
#include "brush/preset_internal.h"

#include <string.h>

static const WrSettingInfo settings[MYPAINT_BRUSH_SETTINGS_COUNT] = {
    /* name, label, meaning, low, high, fallback, use */
    [MYPAINT_BRUSH_SETTING_OPAQUE] = { "opaque", "Opacity",
                                       "Fraction of a dab's height that one touch adds.", 0, 2, 1,
                                       WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OPAQUE_MULTIPLY] = { "opaque_multiply", "Opacity multiply",
                                                "Multiplied with the opacity; by default the pen's "
                                                "pressure.",
                                                0, 2, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OPAQUE_LINEARIZE] = { "opaque_linearize", "Opacity linearize",
                                                 "Corrects the opacity for dabs that lie over one "
                                                 "another, so that spacing does not change the "
                                                 "height.",
                                                 0, 2, 0.9, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC] = { "radius_logarithmic", "Radius",
                                                   "Logarithm of the radius in texels; the brush's "
                                                   "own radius replaces it, curves add to it.",
                                                   -2, 6, 2, WR_SETTING_MAPPED },
    [MYPAINT_BRUSH_SETTING_HARDNESS] = { "hardness", "Hardness",
                                         "Where the slope to the dab's edge begins; the brush's "
                                         "own "
                                         "hardness replaces it, curves add to it.",
                                         0.01, 1, 0.8, WR_SETTING_MAPPED },
    [MYPAINT_BRUSH_SETTING_ANTI_ALIASING] = { "anti_aliasing", "Pixel feather",
                                              "Texels that the edge is at least wide, so that "
                                              "relief does not come in stairs.",
                                              0, 5, 1, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_DABS_PER_BASIC_RADIUS] = { "dabs_per_basic_radius",
                                                      "Dabs per basic radius",
                                                      "Dabs on a way as long as the brush's "
                                                      "radius.",
                                                      0, 64, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_DABS_PER_ACTUAL_RADIUS] = { "dabs_per_actual_radius",
                                                       "Dabs per actual radius",
                                                       "Dabs on a way as long as the radius that "
                                                       "the dab has just now.",
                                                       0, 64, 2, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_DABS_PER_SECOND] = { "dabs_per_second", "Dabs per second",
                                                "Dabs a second while the pen is down, also at "
                                                "rest.",
                                                0, 200, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_RADIUS_BY_RANDOM] = { "radius_by_random", "Radius by random",
                                                 "Chance in the radius; larger dabs are fainter.",
                                                 0, 1.5, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_SPEED1_SLOWNESS] = { "speed1_slowness", "Fine speed filter",
                                                "Seconds that the fine speed needs to follow.", 0,
                                                0.2, 0.04, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_SPEED2_SLOWNESS] = { "speed2_slowness", "Gross speed filter",
                                                "Seconds that the gross speed needs to follow.", 0,
                                                3, 0.8, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_SPEED1_GAMMA] = { "speed1_gamma", "Fine speed gamma",
                                             "How the fine speed answers to very fast motions.", -8,
                                             8, 4, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_SPEED2_GAMMA] = { "speed2_gamma", "Gross speed gamma",
                                             "How the gross speed answers to very fast motions.",
                                             -8, 8, 4, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_BY_RANDOM] = { "offset_by_random", "Jitter",
                                                 "Scatters dabs about the path, in radii.", 0, 25,
                                                 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_BY_SPEED] = { "offset_by_speed", "Offset by speed",
                                                "Throws dabs forward (or back) with the pen's "
                                                "speed.",
                                                -3, 3, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_BY_SPEED_SLOWNESS] = { "offset_by_speed_slowness",
                                                         "Offset by speed filter",
                                                         "How slowly that throw follows the speed.",
                                                         0, 15, 1, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_SLOW_TRACKING] = { "slow_tracking", "Slow position tracking",
                                              "The path follows the pen slowly: a steadier hand.",
                                              0, 10, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_SLOW_TRACKING_PER_DAB] = { "slow_tracking_per_dab",
                                                      "Slow tracking per dab",
                                                      "The same, counted in dabs.", 0, 10, 0,
                                                      WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_TRACKING_NOISE] = { "tracking_noise", "Tracking noise",
                                               "Chance in the path that the pen is thought to have "
                                               "gone.",
                                               0, 12, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_COLOR_H] = { "color_h", "Color hue", "A colour has no height.", 0, 1, 0,
                                        WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_COLOR_S] = { "color_s", "Color saturation", "A colour has no height.",
                                        -0.5, 1.5, 0, WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_COLOR_V] = { "color_v", "Color value",
                                        "A colour has no height; strength and mode say how high.",
                                        -0.5, 1.5, 0, WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_RESTORE_COLOR] = { "restore_color", "Save color",
                                              "A colour has no height.", 0, 1, 0,
                                              WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_CHANGE_COLOR_H] = { "change_color_h", "Change color hue",
                                               "A colour has no height.", -2, 2, 0,
                                               WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_CHANGE_COLOR_L] = { "change_color_l", "Change color lightness (HSL)",
                                               "A colour has no height.", -2, 2, 0,
                                               WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_CHANGE_COLOR_HSL_S] = { "change_color_hsl_s",
                                                   "Change color satur. (HSL)",
                                                   "A colour has no height.", -2, 2, 0,
                                                   WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_CHANGE_COLOR_V] = { "change_color_v", "Change color value (HSV)",
                                               "A colour has no height.", -2, 2, 0,
                                               WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_CHANGE_COLOR_HSV_S] = { "change_color_hsv_s",
                                                   "Change color satur. (HSV)",
                                                   "A colour has no height.", -2, 2, 0,
                                                   WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_SMUDGE] = { "smudge", "Smudge",
                                       "The part of a dab that drags the heights found along the "
                                       "path, in place of the mode.",
                                       0, 1, 0, WR_SETTING_MAPPED },
    [MYPAINT_BRUSH_SETTING_SMUDGE_LENGTH] = { "smudge_length", "Smudge length",
                                              "How long a dragged height lasts before the heights "
                                              "under the dab replace it.",
                                              0, 1, 0.5, WR_SETTING_MAPPED },
    [MYPAINT_BRUSH_SETTING_SMUDGE_RADIUS_LOG] = { "smudge_radius_log", "Smudge radius",
                                                  "Logarithm of how much wider than the dab "
                                                  "heights are gathered for dragging.",
                                                  -1.6, 1.6, 0, WR_SETTING_MAPPED },
    [MYPAINT_BRUSH_SETTING_ERASER] = { "eraser", "Eraser",
                                       "From 0.5 on the mode is erase, and the dab erases by this "
                                       "part; below, it is the part that a dab leaves out.",
                                       0, 1, 0, WR_SETTING_MAPPED },
    [MYPAINT_BRUSH_SETTING_STROKE_THRESHOLD] = { "stroke_threshold", "Stroke threshold",
                                                 "Pressure at which a stroke counts as begun.", 0,
                                                 0.5, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_STROKE_DURATION_LOGARITHMIC] = { "stroke_duration_logarithmic",
                                                            "Stroke duration",
                                                            "Logarithm of the way, in radii, on "
                                                            "which the input `stroke` rises to 1.",
                                                            -1, 14, 4, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_STROKE_HOLDTIME] = { "stroke_holdtime", "Stroke hold time",
                                                "How long the input `stroke` stays at 1 before it "
                                                "begins anew; 10 is for ever.",
                                                0, 10, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_CUSTOM_INPUT] = { "custom_input", "Custom input",
                                             "Where the input `custom` is drawn to.", -5, 5, 0,
                                             WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_CUSTOM_INPUT_SLOWNESS] = { "custom_input_slowness",
                                                      "Custom input filter",
                                                      "How slowly the input `custom` follows.", 0,
                                                      10, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_ELLIPTICAL_DAB_RATIO] = { "elliptical_dab_ratio",
                                                     "Elliptical dab: ratio",
                                                     "Length of a dab over its breadth.", 1, 10, 1,
                                                     WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_ELLIPTICAL_DAB_ANGLE] = { "elliptical_dab_angle",
                                                     "Elliptical dab: angle",
                                                     "Angle of the long axis in degrees, clockwise "
                                                     "as seen.",
                                                     0, 180, 90, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_DIRECTION_FILTER] = { "direction_filter", "Direction filter",
                                                 "How slowly the direction of the path is "
                                                 "followed.",
                                                 0, 10, 2, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_LOCK_ALPHA] = { "lock_alpha", "Lock alpha",
                                           "Heights are there everywhere: nothing is see-through.",
                                           0, 1, 0, WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_COLORIZE] = { "colorize", "Colorize", "A colour has no height.", 0, 1, 0,
                                         WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_SNAP_TO_PIXEL] = { "snap_to_pixel", "Snap to pixel",
                                              "Draws dabs to the centres of texels.", 0, 1, 0,
                                              WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_PRESSURE_GAIN_LOG] = { "pressure_gain_log", "Pressure gain",
                                                  "Logarithm of how hard the pen must be pressed.",
                                                  -1.8, 1.8, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_GRIDMAP_SCALE] = { "gridmap_scale", "GridMap Scale",
                                              "Logarithm of how large the squares of the inputs "
                                              "`gridmap_x` and `gridmap_y` are; at 0 they are 256 "
                                              "texels.",
                                              -10, 10, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_GRIDMAP_SCALE_X] = { "gridmap_scale_x", "GridMap Scale X",
                                                "Squares across for one of that size.", 0, 10, 1,
                                                WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_GRIDMAP_SCALE_Y] = { "gridmap_scale_y", "GridMap Scale Y",
                                                "Squares down for one of that size.", 0, 10, 1,
                                                WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_SMUDGE_LENGTH_LOG] = { "smudge_length_log", "Smudge length multiplier",
                                                  "Logarithm of how much longer still a dragged "
                                                  "height lasts.",
                                                  0, 20, 0, WR_SETTING_MAPPED },
    [MYPAINT_BRUSH_SETTING_SMUDGE_BUCKET] = { "smudge_bucket", "Smudge bucket",
                                              "All dabs drag one and the same height.", 0, 255, 0,
                                              WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_SMUDGE_TRANSPARENCY] = { "smudge_transparency", "Smudge transparency",
                                                    "Heights are there everywhere: nothing is "
                                                    "see-through.",
                                                    -1, 1, 0, WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_OFFSET_Y] = { "offset_y", "Offset Y", "Moves dabs down, in radii.", -40,
                                         40, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_X] = { "offset_x", "Offset X",
                                         "Moves dabs to the right, in radii.", -40, 40, 0,
                                         WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_ANGLE] = { "offset_angle", "Angular Offset: Direction",
                                             "Moves dabs to one side of the path's direction, in "
                                             "radii.",
                                             -40, 40, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_ANGLE_ASC] = { "offset_angle_asc", "Angular Offset: Ascension",
                                                 "Moves dabs to one side of the pen's tilt, in "
                                                 "radii.",
                                                 -40, 40, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_ANGLE_VIEW] = { "offset_angle_view", "Angular Offset: View",
                                                  "Moves dabs towards an angle of the table, in "
                                                  "radii.",
                                                  -40, 40, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_ANGLE_2] = { "offset_angle_2",
                                               "Angular Offset Mirrored: Direction",
                                               "Moves dabs to both sides of the path's direction "
                                               "by turns, in radii.",
                                               0, 40, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_ANGLE_2_ASC] = { "offset_angle_2_asc",
                                                   "Angular Offset Mirrored: Ascension",
                                                   "Moves dabs to both sides of the pen's tilt by "
                                                   "turns, in radii.",
                                                   0, 40, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_ANGLE_2_VIEW] = { "offset_angle_2_view",
                                                    "Angular Offset Mirrored: View",
                                                    "Moves dabs to both sides of an angle of the "
                                                    "table by turns, in radii.",
                                                    0, 40, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_ANGLE_ADJ] = { "offset_angle_adj", "Angular Offsets Adjustment",
                                                 "Degrees added to the angles of these moves.",
                                                 -180, 180, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_OFFSET_MULTIPLIER] = { "offset_multiplier", "Offsets Multiplier",
                                                  "Logarithm of a factor for all these moves.", -2,
                                                  3, 0, WR_SETTING_USED },
    [MYPAINT_BRUSH_SETTING_POSTERIZE] = { "posterize", "Posterize", "A colour has no height.", 0, 1,
                                          0, WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_POSTERIZE_NUM] = { "posterize_num", "Posterization levels",
                                              "A colour has no height.", 0.01, 1.28, 0.05,
                                              WR_SETTING_IGNORED },
    [MYPAINT_BRUSH_SETTING_PAINT_MODE] = { "paint_mode", "Pigment",
                                           "Colours mix as paint does; heights do not.", 0, 1, 1,
                                           WR_SETTING_IGNORED },
};

int wr_preset_setting_count(void)
{
    return MYPAINT_BRUSH_SETTINGS_COUNT;
}

const WrSettingInfo *wr_preset_setting(int index)
{
    WR_ASSERT(index >= 0 && index < MYPAINT_BRUSH_SETTINGS_COUNT);
    return &settings[index];
}

int wr_preset_setting_find(const char *name)
{
    for (int i = 0; i < MYPAINT_BRUSH_SETTINGS_COUNT; i++)
        if (strcmp(settings[i].name, name) == 0) return i;
    return -1;
}

/* ---- inputs ---- */

/* The inputs of libmypaint 1.6, in its own order: properties of pen and motion that can control a
   setting. low and high are the plot range of a curve; most inputs exceed it occasionally. */

static const WrInputInfo inputs[MYPAINT_BRUSH_INPUTS_COUNT] = {
    [MYPAINT_BRUSH_INPUT_PRESSURE] = { "pressure", "Pressure", "How hard the pen presses.", 0, 1 },
    [MYPAINT_BRUSH_INPUT_SPEED1] = { "speed1", "Fine speed",
                                     "How fast the pen is just now, on a logarithmic scale.", 0,
                                     4 },
    [MYPAINT_BRUSH_INPUT_SPEED2] = { "speed2", "Gross speed", "The same, changing slowly.", 0, 4 },
    [MYPAINT_BRUSH_INPUT_RANDOM] = { "random", "Chance", "Another number for each dab.", 0, 1 },
    [MYPAINT_BRUSH_INPUT_STROKE] = { "stroke", "Stroke",
                                     "Rises from 0 to 1 along a stroke, and may begin anew.", 0,
                                     1 },
    [MYPAINT_BRUSH_INPUT_DIRECTION] = { "direction", "Direction",
                                        "Of the path, degrees; back and forth are the same.", 0,
                                        180 },
    [MYPAINT_BRUSH_INPUT_TILT_DECLINATION] = { "tilt_declination", "Tilt",
                                               "90 degrees: the pen stands upright, 0: it lies.", 0,
                                               90 },
    [MYPAINT_BRUSH_INPUT_TILT_ASCENSION] = { "tilt_ascension", "Tilt's direction",
                                             "Where the pen leans to, degrees.", -180, 180 },
    [MYPAINT_BRUSH_INPUT_CUSTOM] = { "custom", "Custom",
                                     "Target value: the setting `custom_input`.", -2, 2 },
    [MYPAINT_BRUSH_INPUT_DIRECTION_ANGLE] = { "direction_angle", "Direction all round",
                                              "Of the path, degrees; back and forth differ.", 0,
                                              360 },
    [MYPAINT_BRUSH_INPUT_ATTACK_ANGLE] = { "attack_angle", "Attack",
                                           "Between the pen's lean and the path, degrees.", -180,
                                           180 },
    [MYPAINT_BRUSH_INPUT_TILT_DECLINATIONX] = { "tilt_declinationx", "Tilt across",
                                                "The pen's lean to the right, degrees.", -90, 90 },
    [MYPAINT_BRUSH_INPUT_TILT_DECLINATIONY] = { "tilt_declinationy", "Tilt up and down",
                                                "The pen's lean downwards, degrees.", -90, 90 },
    [MYPAINT_BRUSH_INPUT_GRIDMAP_X] = { "gridmap_x", "Place across",
                                        "In squares that the table is parted into.", 0, 256 },
    [MYPAINT_BRUSH_INPUT_GRIDMAP_Y] = { "gridmap_y", "Place up and down",
                                        "In squares that the table is parted into.", 0, 256 },
    [MYPAINT_BRUSH_INPUT_VIEWZOOM] = { "viewzoom", "Zoom",
                                       "Of the view, logarithmic; strokes here are drawn at 0.",
                                       -2.77, 4.15 },
    [MYPAINT_BRUSH_INPUT_BARREL_ROTATION] = { "barrel_rotation", "Pen's turn",
                                              "About its own axis, degrees; 0 here.", -180, 180 },
    [MYPAINT_BRUSH_INPUT_BRUSH_RADIUS] = { "brush_radius", "Radius",
                                           "Logarithm of the brush's radius in texels.", -2, 6 },
};

int wr_preset_input_count(void)
{
    return MYPAINT_BRUSH_INPUTS_COUNT;
}

const WrInputInfo *wr_preset_input(int input)
{
    WR_ASSERT(input >= 0 && input < MYPAINT_BRUSH_INPUTS_COUNT);
    return &inputs[input];
}

int wr_preset_input_find(const char *name)
{
    for (int i = 0; i < MYPAINT_BRUSH_INPUTS_COUNT; i++)
        if (strcmp(inputs[i].name, name) == 0) return i;
    return -1;
}

double wr_preset_reach(int setting)
{
    const MyPaintBrushSettingInfo *info = mypaint_brush_setting_info((MyPaintBrushSetting)setting);
    return (double)info->max - (double)info->min;
}

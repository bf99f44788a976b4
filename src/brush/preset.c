/* The settings of libmypaint 1.6, in its own order, and their meaning for heights. low and high are the
   library's, but tighter where a stroke could become endless (dabs_per_..._radius) or paint nothing
   (hardness: at 0 the whole dab is edge). */
#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/preset_internal.h"
#include "system/path.h"

#include <json-c/json.h>
#include <math.h>
#include <string.h>

/* ---- table of settings ---- */

static const WrSettingInfo setting_rows[MYPAINT_BRUSH_SETTINGS_COUNT] = {
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
    return &setting_rows[index];
}

int wr_preset_setting_find(const char *name)
{
    for (int i = 0; i < MYPAINT_BRUSH_SETTINGS_COUNT; i++)
        if (strcmp(setting_rows[i].name, name) == 0) return i;
    return -1;
}

/* ---- table of inputs ---- */

/* The inputs of libmypaint 1.6, in its own order: properties of pen and motion that can control a
   setting. low and high are the plot range of a curve; most inputs exceed it occasionally. */

static const WrInputInfo input_rows[MYPAINT_BRUSH_INPUTS_COUNT] = {
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
                                              "Of an art pen about its own axis, degrees.", -180,
                                              180 },
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
    return &input_rows[input];
}

/* 0 .. count - 1 */
static int preset_input_find(const char *name)
{
    for (int i = 0; i < MYPAINT_BRUSH_INPUTS_COUNT; i++)
        if (strcmp(input_rows[i].name, name) == 0) return i;
    return -1;
}

double wr_preset_reach(int setting)
{
    const MyPaintBrushSettingInfo *info = mypaint_brush_setting_info((MyPaintBrushSetting)setting);
    return (double)info->max - (double)info->min;
}

/* ---- presets ---- */

/* The curve of a setting and an input, NULL if none. */
static const WrCurve *preset_find_curve(const WrPreset *preset, int setting, int input);

static void preset_drop_curves(WrPreset *preset, int setting);

/* A preset with every setting at its fallback, and the library's default curve: opacity by pressure. */
static WrPreset *preset_new(const char *name);

/* ---- parse ---- */

/* Parser of a preset's file: read by json-c and checked member by member. Unknown settings and inputs
   of other programs are skipped and counted; known ones must be valid. */

#define DEPTH 16  /* of nested objects and lists; a preset needs 7 */
#define LOTS 1e30 /* table units */

/* Position in the file for messages: "groove: radius_logarithmic: pressure". */
typedef struct Place {
    const char *file, *part, *member;
} Place;

static bool fail_at(WrError *err, Place at, const char *text)
{
    return wr_fail(err, "%.100s: %s%s%.60s: %s", at.file, at.part ? at.part : "",
                   at.part ? ": " : "", at.member, text);
}

/* A short excerpt of a value, for messages. */
static const char *excerpt(json_object *value, char buffer[48])
{
    const char *text =
        json_object_to_json_string_ext(value, JSON_C_TO_STRING_PLAIN | JSON_C_TO_STRING_NOZERO);
    snprintf(buffer, 48, "%.40s%s", text, strlen(text) > 40 ? "..." : "");
    for (char *p = buffer; *p; p++)
        if ((unsigned char)*p < 0x20 || (unsigned char)*p > 0x7e) *p = '?';
    return buffer;
}

static bool fail_type(WrError *err, Place at, json_object *value, const char *right)
{
    char shown[48], text[160];
    snprintf(text, sizeof text, "%s: must be %s", excerpt(value, shown), right);
    return fail_at(err, at, text);
}

static bool read_number(json_object *value, Place at, double low, double high, double *number,
                        WrError *err)
{
    char right[80], a[WR_NUMBER_SIZE], b[WR_NUMBER_SIZE];
    snprintf(right, sizeof right, "a number from %s to %s", wr_number_print(low, a),
             wr_number_print(high, b));
    if (!json_object_is_type(value, json_type_double) && !json_object_is_type(value, json_type_int))
        return fail_type(err, at, value, right);
    double x = json_object_get_double(value);
    if (!(x >= low && x <= high)) return fail_type(err, at, value, right);
    *number = x + 0.0; /* no minus zero */
    return true;
}

/* A text without embedded NUL, which would truncate it. The caller owns it. */
static bool read_text(json_object *value, Place at, char **text, WrError *err)
{
    if (!json_object_is_type(value, json_type_string)) return fail_type(err, at, value, "a text");
    const char *bytes = json_object_get_string(value);
    size_t length = (size_t)json_object_get_string_len(value);
    if (length > WR_PRESET_TEXT)
        return wr_fail(err, "%.100s: %s: %zu bytes of text: must be at most %d", at.file, at.member,
                       length, WR_PRESET_TEXT);
    if (strlen(bytes) != length) return fail_type(err, at, value, "a text without \\u0000");
    wr_free(*text);
    *text = wr_strndup(bytes, length);
    return true;
}

/* ---- settings of a file ---- */

/* Limits a value to its range without an error: presets of other programs, and of other versions of
   MyPaint, exceed it occasionally. */
static double bring(double x, double low, double high, int *skipped)
{
    double inside = x < low ? low : x > high ? high : x;
    *skipped += inside != x;
    return inside;
}

static bool read_point(json_object *pair, Place at, float point[2], double reach, int *skipped,
                       WrError *err)
{
    double xy[2] = { 0, 0 };
    if (!json_object_is_type(pair, json_type_array) || json_object_array_length(pair) != 2)
        return fail_type(err, at, pair, "points [x, y]");
    for (size_t k = 0; k < 2; k++)
        if (!read_number(json_object_array_get_idx(pair, k), at, -1e300, 1e300, &xy[k], err))
            return false;
    point[0] = (float)bring(xy[0], -WR_CURVE_FAR, WR_CURVE_FAR, skipped);
    point[1] = (float)bring(xy[1], -reach, reach, skipped);
    return true;
}

/* An empty list is no curve. A curve of one setting over one input is [[x, y], ...] with x not falling; y is added to the
   base value. It is linear between points and continues the outer pieces beyond them (libmypaint's mypaint-mapping). */
static bool read_curve(WrPreset *preset, json_object *list, Place at, int setting, int input,
                       WrError *err)
{
    if (!json_object_is_type(list, json_type_array))
        return fail_type(err, at, list, "a list of points [x, y]");
    size_t count = json_object_array_length(list);
    if (count == 0) return true;
    if (count < 2 || count > WR_PRESET_POINTS) {
        char text[80];
        snprintf(text, sizeof text, "%zu points: must be 2..%d", count, WR_PRESET_POINTS);
        return fail_at(err, at, text);
    }
    WrCurve curve = { .setting = setting, .input = input, .count = (int)count };
    const double reach = wr_preset_reach(setting);
    for (size_t i = 0; i < count; i++) {
        json_object *pair = json_object_array_get_idx(list, i);
        if (!read_point(pair, at, curve.points[i], reach, &preset->skipped, err)) return false;
        if (i > 0 && curve.points[i][0] < curve.points[i - 1][0])
            return fail_type(err, at, pair, "at an x not below the point's before");
    }
    wr_array_push(&preset->curves, curve);
    return true;
}

/* "NAME": { "base_value": number, "inputs": { "INPUT": curve, ... } }. A setting that the file states replaces the library's
   default curves, too: without inputs it is constant. */
static bool read_setting(WrPreset *preset, json_object *value, Place at, int setting, WrError *err)
{
    const char *name = at.member;
    if (!json_object_is_type(value, json_type_object))
        return fail_type(err, at, value, "an object with base_value and inputs");
    json_object *base, *inputs;
    at.part = name;
    at.member = "base_value";
    if (!json_object_object_get_ex(value, "base_value", &base))
        return fail_at(err, at, "is not there: must be a number");
    const WrSettingInfo *info = wr_preset_setting(setting);
    double x;
    if (!read_number(base, at, -1e300, 1e300, &x, err)) return false;
    preset->base[setting] = bring(x, info->low, info->high, &preset->skipped);
    preset_drop_curves(preset, setting);
    if (!json_object_object_get_ex(value, "inputs", &inputs)) return true;
    at.member = "inputs";
    if (!json_object_is_type(inputs, json_type_object))
        return fail_type(err, at, inputs, "an object of curves");
    json_object_object_foreach(inputs, key, list)
    {
        int input = preset_input_find(key);
        at.member = key;
        if (input < 0) {
            preset->skipped++;
        } else if (!read_curve(preset, list, at, setting, input, err)) {
            return false;
        }
    }
    return true;
}

static bool read_settings(WrPreset *preset, json_object *settings, Place at, WrError *err)
{
    if (!json_object_is_type(settings, json_type_object))
        return fail_type(err, at, settings, "an object of settings");
    json_object_object_foreach(settings, key, value)
    {
        int setting = wr_preset_setting_find(key);
        at.member = key;
        if (setting < 0) {
            preset->skipped++;
        } else if (!read_setting(preset, value, at, setting, err)) {
            return false;
        }
    }
    return true;
}

/* ---- "wrinkle" ---- */

static const char *mode_name(const void *ctx, int i)
{
    (void)ctx;
    return i < WR_BRUSH_MODE_COUNT ? wr_brush_modes[i].name : NULL;
}

static bool read_mode(WrPreset *preset, json_object *value, Place at, WrError *err)
{
    const char *text =
        json_object_is_type(value, json_type_string) ? json_object_get_string(value) : "";
    for (int i = 0; i < WR_BRUSH_MODE_COUNT; i++)
        if (strcmp(text, wr_brush_modes[i].name) == 0) {
            preset->own.mode = (WrBrushMode)i;
            preset->gives_mode = true;
            return true;
        }
    char shown[48], place[200];
    snprintf(place, sizeof place, "%.100s: wrinkle: mode: %s", at.file, excerpt(value, shown));
    return wr_fail_word(err, place, text, mode_name, NULL);
}

static bool read_bool(json_object *value, Place at, bool *flag, WrError *err)
{
    if (!json_object_is_type(value, json_type_boolean))
        return fail_type(err, at, value, "true or false");
    *flag = json_object_get_boolean(value);
    return true;
}

static bool read_jitter(WrPreset *preset, json_object *list, Place at, WrError *err)
{
    WrBrush *own = &preset->own;
    const struct {
        double high, *to;
    } part[] = { { 100.0, &own->jitter_place },
                 { 180.0, &own->jitter_angle_deg },
                 { 1.0, &own->jitter_size } };
    if (!json_object_is_type(list, json_type_array) || json_object_array_length(list) != 3)
        return fail_type(err, at, list, "a list [place, angle, size]");
    for (size_t i = 0; i < 3; i++)
        if (!read_number(json_object_array_get_idx(list, i), at, 0.0, part[i].high, part[i].to,
                         err))
            return false;
    return true;
}

/* The name of a file beside the preset. No slash and no leading dot: a preset from the net must not read other folders. */
static bool read_tip_file(WrPreset *preset, json_object *value, Place at, WrError *err)
{
    if (!read_text(value, at, &preset->tip_file, err)) return false;
    const char *name = preset->tip_file;
    bool plain = *name && *name != '.' && strlen(name) <= 200 && !strchr(name, '/');
    for (const char *p = name; *p; p++) plain = plain && (unsigned char)*p >= 0x20;
    return plain ||
           fail_type(err, at, value, "the plain name of a file in the folder of the preset");
}

static bool read_sha256(WrPreset *preset, json_object *value, Place at, WrError *err)
{
    const char *text =
        json_object_is_type(value, json_type_string) ? json_object_get_string(value) : "";
    if (strlen(text) != 64 || strspn(text, "0123456789abcdef") != 64)
        return fail_type(err, at, value, "64 hex digits in lower case");
    memcpy(preset->tip_sha256, text, 65);
    return true;
}

static bool read_relief_member(WrPreset *preset, const char *key, json_object *value, Place at,
                               WrError *err)
{
    WrBrush *own = &preset->own;
    const struct {
        const char *name;
        double low, high, *to;
    } numbers[] = {
        { "strength", -LOTS, LOTS, &own->strength }, { "to", -LOTS, LOTS, &own->to },
        { "opacity", 0.0, 1.0, &own->opacity },      { "flow", 0.0, 1.0, &own->flow },
        { "reach", 0.0, 1e6, &own->reach },          { "aspect", 1.0, 100.0, &own->aspect },
        { "angle", -360.0, 360.0, &own->angle_deg }, { "radius", 1e-3, 1e9, &own->radius },
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (strcmp(key, numbers[i].name) == 0)
            return read_number(value, at, numbers[i].low, numbers[i].high, numbers[i].to, err);
    if (strcmp(key, "mode") == 0) return read_mode(preset, value, at, err);
    if (strcmp(key, "buildup") == 0) return read_bool(value, at, &own->buildup, err);
    if (strcmp(key, "follow") == 0) return read_bool(value, at, &own->follow, err);
    if (strcmp(key, "jitter") == 0) return read_jitter(preset, value, at, err);
    if (strcmp(key, "tip") == 0) return read_tip_file(preset, value, at, err);
    if (strcmp(key, "tip_sha256") == 0) return read_sha256(preset, value, at, err);
    return fail_at(err, at,
                   "is not known: must be mode, strength, to, opacity, flow, buildup, reach, "
                   "radius, aspect, angle, follow, jitter, tip or tip_sha256");
}

static bool read_relief(WrPreset *preset, json_object *relief, Place at, WrError *err)
{
    if (!json_object_is_type(relief, json_type_object))
        return fail_type(err, at, relief, "an object");
    at.part = "wrinkle";
    json_object_object_foreach(relief, key, value)
    {
        at.member = key;
        if (!read_relief_member(preset, key, value, at, err)) return false;
    }
    at.member = "tip_sha256";
    if (preset->tip_file && !*preset->tip_sha256)
        return fail_at(err, at, "is not there: must be the SHA-256 of the tip");
    at.member = "tip";
    if (!preset->tip_file && *preset->tip_sha256)
        return fail_at(err, at, "is not there: must be the file that tip_sha256 is of");
    return true;
}

/* The picture beside the preset, else the stamp of that name that ships with the program. The caller frees it. */
static char *tip_path(const char *folder, const char *name)
{
    WrText stamp = { 0 };
    char *path = wr_path_join(folder, name), *file = wr_path_join("brushes/stamps", name);
    if (!wr_path_is_there(path) && wr_data_find(file, &stamp)) {
        wr_free(path);
        path = wr_strdup(wr_text_get(&stamp));
    }
    wr_text_fini(&stamp);
    wr_free(file);
    return path;
}

/* The tip's checksum is part of the preset: another picture under the same name would silently paint something else. */
static bool load_tip(WrPreset *preset, const char *folder, WrError *err)
{
    if (!preset->tip_file) return true;
    if (!folder)
        return wr_fail(err, "%.100s: wrinkle: tip: %.100s: only a preset in a file can have a tip",
                       preset->name, preset->tip_file);
    char *path = tip_path(folder, preset->tip_file), hex[65];
    bool ok = wr_sha256_file(path, hex, err);
    if (ok && strcmp(hex, preset->tip_sha256) != 0)
        ok = wr_fail(err, "%s: file has changed: SHA-256 is %s, the preset expects %s", path, hex,
                     preset->tip_sha256);
    if (ok) preset->tip = wr_tip_read(path, err);
    wr_free(path);
    if (preset->tip) return true;
    wr_error_prefix(err, "%.100s: tip: ", preset->name);
    return false;
}

/* ---- the file ---- */

/* JSON presets have version 3, the only one that libmypaint accepts; older presets are lists of lines and are not read. */
static bool read_version(json_object *root, Place at, WrError *err)
{
    json_object *version;
    at.member = "version";
    if (!json_object_object_get_ex(root, "version", &version))
        return fail_at(err, at, "is not there: must be 3, as MyPaint writes it");
    if (!json_object_is_type(version, json_type_int) || json_object_get_int64(version) != 3)
        return fail_type(err, at, version, "3");
    return true;
}

/* Members: "version": 3, "settings": {...}, optional texts, and "wrinkle": {...} for the properties that libmypaint has no
   setting for. libmypaint's loader reads the version and the settings only, so files remain usable there. */
static bool read_root(WrPreset *preset, json_object *root, const char *folder, WrError *err)
{
    Place at = { .file = preset->name, .member = "the file" };
    if (!json_object_is_type(root, json_type_object))
        return fail_type(err, at, root, "a JSON object");
    if (!read_version(root, at, err)) return false;
    json_object *value;
    at.member = "settings";
    if (!json_object_object_get_ex(root, "settings", &value))
        return fail_at(err, at, "is not there: must be an object of settings");
    if (!read_settings(preset, value, at, err)) return false;
    const struct {
        const char *name;
        char **to;
    } texts[] = { { "comment", &preset->comment },
                  { "description", &preset->description },
                  { "group", &preset->group },
                  { "notes", &preset->notes } };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        at.member = texts[i].name;
        if (json_object_object_get_ex(root, texts[i].name, &value) &&
            !read_text(value, at, texts[i].to, err))
            return false;
    }
    at.member = "wrinkle";
    if (json_object_object_get_ex(root, "wrinkle", &value) && !read_relief(preset, value, at, err))
        return false;
    return load_tip(preset, folder, err);
}

/* json_tokener_parse_ex stops at the object's end; bytes after it, also a NUL, are an error, or a truncated or concatenated
   file would be accepted. */
static json_object *parse_with(int flags, const char *text, size_t size, const char *name,
                               WrError *err)
{
    json_tokener *tokener = json_tokener_new_ex(DEPTH);
    if (!tokener) {
        wr_fail(err, "%.100s: not enough memory to read it", name);
        return NULL;
    }
    json_tokener_set_flags(tokener, flags);
    json_object *root = json_tokener_parse_ex(tokener, text, (int)size);
    enum json_tokener_error status = json_tokener_get_error(tokener);
    size_t end = json_tokener_get_parse_end(tokener);
    json_tokener_free(tokener);
    if (status != json_tokener_success) {
        json_object_put(root);
        root = NULL;
        wr_fail(err, "%.100s: byte %zu: %s: a preset is a JSON object", name, end,
                status == json_tokener_continue ? "the text ends too early"
                                                : json_tokener_error_desc(status));
    } else if (!root) {
        wr_fail(err, "%.100s: null: a preset is a JSON object", name);
    }
    for (; root && end < size; end++)
        if (!strchr(" \t\r\n", text[end]) || !text[end]) {
            json_object_put(root);
            root = NULL;
            wr_fail(err, "%.100s: byte %zu: text after the JSON object's end", name, end);
        }
    return root;
}

/* The strict mode of json-c 0.18 rejects letters beyond ASCII, so it checks the syntax of a copy that has an x for each of their
   bytes. */
static json_object *parse_json(const char *text, size_t size, const char *name, WrError *err)
{
    char *ascii = wr_alloc(size + 1, 1);
    bool more = false;
    for (size_t i = 0; i < size; i++) {
        const bool beyond = (unsigned char)text[i] > 127;
        ascii[i] = beyond ? 'x' : text[i];
        more |= beyond;
    }
    json_object *root = parse_with(JSON_TOKENER_STRICT, ascii, size, name, err);
    wr_free(ascii);
    if (!root || !more) return root;
    json_object_put(root);
    return parse_with(JSON_TOKENER_VALIDATE_UTF8, text, size, name, err);
}

WrPreset *wr_preset_parse(const char *text, size_t size, const char *name, const char *folder,
                          WrError *err)
{
    if (size > WR_PRESET_BYTES) {
        wr_fail(err, "%.100s: %zu bytes: a preset has at most %d", name, size, WR_PRESET_BYTES);
        return NULL;
    }
    json_object *root = parse_json(text, size, name, err);
    if (!root) return NULL;
    WrPreset *preset = preset_new(name);
    bool ok = read_root(preset, root, folder, err);
    json_object_put(root);
    if (ok) return preset;
    wr_preset_free(preset);
    return NULL;
}

WrPreset *wr_preset_read(const char *path, const char *name, WrError *err)
{
    char *text, *folder = wr_path_folder(path);
    size_t size;
    WrPreset *preset = NULL;
    if (wr_file_read(path, WR_PRESET_BYTES, &text, &size, err)) {
        preset = wr_preset_parse(text, size, name, folder, err);
        wr_free(text);
    }
    wr_free(folder);
    return preset;
}

/* ---- A preset as text ---- */

#define LN2 0.69314718055994530942

static void add_text(WrText *text, const char *name, const char *value)
{
    if (!value) return;
    wr_text_addf(text, "    \"%s\": ", name);
    wr_text_add_json_string(text, value);
    wr_text_add(text, ",\n");
}

static void add_curve(WrText *text, const WrCurve *curve, bool first)
{
    char x[WR_NUMBER_SIZE], y[WR_NUMBER_SIZE];
    wr_text_addf(text, "%s\"%s\": [", first ? " " : ", ", wr_preset_input(curve->input)->name);
    for (int i = 0; i < curve->count; i++)
        wr_text_addf(text, "%s[%s, %s]", i > 0 ? ", " : "",
                     wr_number_print_float(curve->points[i][0], x),
                     wr_number_print_float(curve->points[i][1], y));
    wr_text_add(text, "]");
}

static void add_setting(WrText *text, const WrPreset *preset, int setting, double base, bool last)
{
    bool first = true;
    wr_text_addf(text, "        \"%s\": { \"base_value\": ", wr_preset_setting(setting)->name);
    wr_text_add_number(text, base);
    wr_text_add(text, ", \"inputs\": {");
    for (int input = 0; input < wr_preset_input_count(); input++) {
        const WrCurve *curve = preset_find_curve(preset, setting, input);
        if (!curve) continue;
        add_curve(text, curve, first);
        first = false;
    }
    wr_text_addf(text, "%s} }%s\n", first ? "" : " ", last ? "" : ",");
}

static void add_number(WrText *text, const char *name, double value)
{
    wr_text_addf(text, ", \"%s\": ", name);
    wr_text_add_number(text, value);
}

/* Writes the brush's properties beyond the settings; defaults are omitted. */
static void add_relief(WrText *text, const WrPreset *preset, const WrBrush *brush, bool odd_radius)
{
    WrBrush usual = wr_brush_default();
    wr_text_addf(text, "    \"wrinkle\": { \"mode\": \"%s\"", wr_brush_modes[brush->mode].name);
    add_number(text, "strength", brush->strength);
    if (odd_radius) add_number(text, "radius", brush->radius);
    if (brush->to != usual.to) add_number(text, "to", brush->to);
    if (brush->opacity != usual.opacity) add_number(text, "opacity", brush->opacity);
    if (brush->flow != usual.flow) add_number(text, "flow", brush->flow);
    if (brush->buildup) wr_text_add(text, ", \"buildup\": true");
    if (brush->reach > 0.0) add_number(text, "reach", brush->reach);
    if (brush->aspect > 1.0) add_number(text, "aspect", brush->aspect);
    if (brush->angle_deg != 0.0) add_number(text, "angle", brush->angle_deg);
    if (brush->follow) wr_text_add(text, ", \"follow\": true");
    if (brush->jitter_place > 0.0 || brush->jitter_angle_deg > 0.0 || brush->jitter_size > 0.0) {
        char place[WR_NUMBER_SIZE], angle[WR_NUMBER_SIZE], size[WR_NUMBER_SIZE];
        wr_text_addf(text, ", \"jitter\": [%s, %s, %s]",
                     wr_number_print(brush->jitter_place, place),
                     wr_number_print(brush->jitter_angle_deg, angle),
                     wr_number_print(brush->jitter_size, size));
    }
    if (preset->tip_file && brush->tip == preset->tip) {
        wr_text_add(text, ", \"tip\": ");
        wr_text_add_json_string(text, preset->tip_file);
        wr_text_addf(text, ", \"tip_sha256\": \"%s\"", preset->tip_sha256);
    }
    wr_text_add(text, " },\n");
}

/* All settings are written, also those at their default: defaults of other versions of MyPaint differ. radius_logarithmic is
   the natural logarithm of the radius, limited to libmypaint's range; a radius beyond it is stored in "wrinkle". */
void wr_preset_print(const WrPreset *preset, const WrBrush *brush, WrText *text)
{
    const WrSettingInfo *radius = wr_preset_setting(MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC);
    double log_radius = brush->radius > 0.0 ? wr_log2(brush->radius) * LN2 : radius->low;
    bool odd = !(log_radius >= radius->low && log_radius <= radius->high);
    log_radius = log_radius > radius->high  ? radius->high
                 : log_radius > radius->low ? log_radius
                                            : radius->low;
    wr_text_add(text, "{\n");
    add_text(text, "comment", preset->comment);
    add_text(text, "group", preset->group);
    add_text(text, "description", preset->description);
    add_text(text, "notes", preset->notes);
    add_relief(text, preset, brush, odd);
    wr_text_add(text, "    \"settings\": {\n");
    for (int i = 0; i < MYPAINT_BRUSH_SETTINGS_COUNT; i++) {
        double base = preset->base[i];
        if (i == MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC) base = log_radius;
        if (i == MYPAINT_BRUSH_SETTING_HARDNESS) base = brush->hardness;
        add_setting(text, preset, i, base, i == MYPAINT_BRUSH_SETTINGS_COUNT - 1);
    }
    wr_text_add(text, "    },\n    \"version\": 3\n}\n");
}

/* ---- set ---- */

/* Modified presets from a text: base values, "slow_tracking=2", and curves,
   "opaque:pressure=0,0|0.4,0.1|1,1". */

static WrPreset *copy(const WrPreset *preset)
{
    WrPreset *made = preset_new(preset->name);
    made->comment = wr_strdup(preset->comment);
    made->description = wr_strdup(preset->description);
    made->group = wr_strdup(preset->group);
    made->notes = wr_strdup(preset->notes);
    memcpy(made->base, preset->base, sizeof made->base);
    made->curves.count = 0;
    for (int i = 0; i < preset->curves.count; i++)
        wr_array_push(&made->curves, preset->curves.data[i]);
    made->own = preset->own;
    made->gives_mode = preset->gives_mode;
    made->tip = preset->tip ? wr_tip_share(preset->tip) : NULL;
    made->tip_file = wr_strdup(preset->tip_file);
    memcpy(made->tip_sha256, preset->tip_sha256, sizeof made->tip_sha256);
    made->skipped = preset->skipped;
    return made;
}

/* A part of the text. */
typedef struct Piece {
    const char *at;
    size_t length;
} Piece;

static int shown(Piece piece)
{
    return piece.length < 60 ? (int)piece.length : 60;
}

/* Removes and returns the part before the first `mark`; everything if there is none. */
static Piece cut(Piece *rest, char mark)
{
    const char *found = memchr(rest->at, mark, rest->length);
    Piece piece = { rest->at, found ? (size_t)(found - rest->at) : rest->length };
    rest->at += piece.length + (found != NULL);
    rest->length -= piece.length + (found != NULL);
    return piece;
}

static void name_of(Piece piece, char name[64])
{
    name[0] = '\0';
    if (piece.length >= 64) return;
    memcpy(name, piece.at, piece.length);
    name[piece.length] = '\0';
}

static bool read_in(Piece piece, double low, double high, double *value)
{
    return wr_number_parse(piece.at, piece.length, value) && *value >= low && *value <= high;
}

static bool set_value(WrPreset *preset, int setting, Piece value, WrError *err)
{
    const WrSettingInfo *info = wr_preset_setting(setting);
    char low[WR_NUMBER_SIZE], high[WR_NUMBER_SIZE];
    double number;
    if (!read_in(value, info->low, info->high, &number))
        return wr_fail(err, "settings: %s=%.*s: must be %s..%s", info->name,
                       value.length < 40 ? (int)value.length : 40, value.at,
                       wr_number_print(info->low, low), wr_number_print(info->high, high));
    preset->base[setting] = number;
    /* The file's own radius would override this one. */
    if (setting == MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC) preset->own.radius = 0.0;
    return true;
}

static bool read_curve_point(WrCurve *curve, Piece point, WrError *err)
{
    const WrSettingInfo *info = wr_preset_setting(curve->setting);
    const double reach = wr_preset_reach(curve->setting);
    const Piece whole = point;
    const Piece x = cut(&point, ',');
    double at, by;
    char most[WR_NUMBER_SIZE];
    if (!read_in(x, -WR_CURVE_FAR, WR_CURVE_FAR, &at) || !read_in(point, -reach, reach, &by))
        return wr_fail(err,
                       "settings: %s:%s: point '%.*s': must be x,y: a value of the input, and the "
                       "number added to the setting there, -%s..%s",
                       info->name, wr_preset_input(curve->input)->name, shown(whole), whole.at,
                       wr_number_print(reach, most), most);
    float *to = curve->points[curve->count];
    to[0] = (float)at;
    to[1] = (float)by;
    if (curve->count > 0 && to[0] < curve->points[curve->count - 1][0])
        return wr_fail(err, "settings: %s:%s: point '%.*s': its x must not be below the one before",
                       info->name, wr_preset_input(curve->input)->name, shown(whole), whole.at);
    curve->count++;
    return true;
}

static void put_curve(WrPreset *preset, const WrCurve *curve)
{
    int kept = 0;
    for (int i = 0; i < preset->curves.count; i++) {
        const WrCurve *old = &preset->curves.data[i];
        if (old->setting != curve->setting || old->input != curve->input)
            preset->curves.data[kept++] = *old;
    }
    preset->curves.count = kept;
    if (curve->count > 0) wr_array_push(&preset->curves, *curve);
}

/* No points: no curve. */
static bool set_curve(WrPreset *preset, int setting, Piece input, Piece points, WrError *err)
{
    char name[64];
    name_of(input, name);
    WrCurve curve = { .setting = setting, .input = preset_input_find(name) };
    const char *of = wr_preset_setting(setting)->name;
    if (curve.input < 0)
        return wr_fail(err,
                       "settings: %s:%.*s: unknown input: must be pressure, speed1, random, "
                       "direction or another of MyPaint's",
                       of, shown(input), input.at);
    while (points.length > 0) {
        if (curve.count == WR_PRESET_POINTS)
            return wr_fail(err, "settings: %s:%s: more than %d points", of, name, WR_PRESET_POINTS);
        if (!read_curve_point(&curve, cut(&points, '|'), err)) return false;
    }
    if (curve.count == 1)
        return wr_fail(err,
                       "settings: %s:%s: one point: must be 2..%d, or none to remove the curve", of,
                       name, WR_PRESET_POINTS);
    put_curve(preset, &curve);
    return true;
}

/* One NAME=VALUE, or NAME:INPUT=POINTS. */
static bool set_one(WrPreset *preset, Piece text, WrError *err)
{
    char name[64];
    const Piece whole = text;
    Piece left = cut(&text, '=');
    if (left.length == whole.length)
        return wr_fail(err,
                       "settings: '%.*s': must be NAME=VALUE or NAME:INPUT=X,Y|X,Y|..., with "
                       "; between several",
                       shown(whole), whole.at);
    const bool curve = memchr(left.at, ':', left.length) != NULL;
    const Piece setting = cut(&left, ':');
    name_of(setting, name);
    const int index = wr_preset_setting_find(name);
    if (index < 0)
        return wr_fail(
            err,
            "settings: '%.*s' is not a setting of brush presets: `wrinkle brushes` lists "
            "them",
            shown(setting), setting.at);
    return curve ? set_curve(preset, index, left, text, err) : set_value(preset, index, text, err);
}

WrPreset *wr_preset_with(const WrPreset *preset, const char *settings, WrError *err)
{
    WrPreset *made = copy(preset);
    Piece rest = { settings, strlen(settings) };
    while (rest.length > 0) {
        const Piece one = cut(&rest, ';');
        if (one.length == 0 || set_one(made, one, err)) continue;
        wr_preset_free(made);
        return NULL;
    }
    return made;
}

bool wr_preset_settings_check(const char *settings, WrError *err)
{
    WrPreset *blank = preset_new(""), *made = wr_preset_with(blank, settings, err);
    wr_preset_free(blank);
    wr_preset_free(made);
    return made != NULL;
}

static WrPreset *preset_new(const char *name)
{
    WrPreset *preset = wr_alloc(1, sizeof *preset);
    preset->references = 1;
    preset->name = wr_strdup(name);
    preset->own = wr_brush_default();
    preset->own.radius = 0.0;
    for (int i = 0; i < MYPAINT_BRUSH_SETTINGS_COUNT; i++)
        preset->base[i] = wr_preset_setting(i)->fallback;
    WrCurve pressure = { .setting = MYPAINT_BRUSH_SETTING_OPAQUE_MULTIPLY,
                         .input = MYPAINT_BRUSH_INPUT_PRESSURE,
                         .count = 2,
                         .points = { { 0.0f, 0.0f }, { 1.0f, 1.0f } } };
    wr_array_push(&preset->curves, pressure);
    return preset;
}

static void preset_drop_curves(WrPreset *preset, int setting)
{
    int kept = 0;
    for (int i = 0; i < preset->curves.count; i++)
        if (preset->curves.data[i].setting != setting)
            preset->curves.data[kept++] = preset->curves.data[i];
    preset->curves.count = kept;
}

WrPreset *wr_preset_share(const WrPreset *preset)
{
    WrPreset *shared = (WrPreset *)(uintptr_t)preset; /* immutable except for this count */
    if (shared) __atomic_fetch_add(&shared->references, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_preset_free(WrPreset *preset)
{
    if (!preset || __atomic_sub_fetch(&preset->references, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_free(preset->name);
    wr_free(preset->comment);
    wr_free(preset->description);
    wr_free(preset->group);
    wr_free(preset->notes);
    wr_free(preset->tip_file);
    wr_tip_free(preset->tip);
    wr_array_free(&preset->curves);
    wr_free(preset);
}

/* ---- properties ---- */

const char *wr_preset_name(const WrPreset *preset)
{
    return preset->name;
}

const char *wr_preset_description(const WrPreset *preset)
{
    return preset->description ? preset->description : "";
}

const char *wr_preset_group(const WrPreset *preset)
{
    return preset->group ? preset->group : "";
}

const WrTip *wr_preset_tip(const WrPreset *preset)
{
    return preset->tip;
}

const char *wr_preset_tip_file(const WrPreset *preset)
{
    return preset->tip_file ? preset->tip_file : "";
}

int wr_preset_skipped(const WrPreset *preset)
{
    return preset->skipped;
}

double wr_preset_value(const WrPreset *preset, int index)
{
    WR_ASSERT(index >= 0 && index < MYPAINT_BRUSH_SETTINGS_COUNT);
    return preset->base[index];
}

static const WrCurve *preset_find_curve(const WrPreset *preset, int setting, int input)
{
    for (int i = 0; i < preset->curves.count; i++) {
        const WrCurve *curve = &preset->curves.data[i];
        if (curve->setting == setting && curve->input == input) return curve;
    }
    return NULL;
}

bool wr_preset_is_constant(const WrPreset *preset, int index)
{
    for (int i = 0; i < preset->curves.count; i++)
        if (preset->curves.data[i].setting == index) return false;
    return true;
}

int wr_preset_curve(const WrPreset *preset, int index, int input, const float (**points)[2])
{
    const WrCurve *curve = preset_find_curve(preset, index, input);
    if (!curve) return 0;
    *points = curve->points;
    return curve->count;
}

/* Upper bound of the setting over all inputs: base value plus the highest point of each curve (curves add). */
double wr_preset_peak(const WrPreset *preset, int setting)
{
    double sum = preset->base[setting];
    for (int i = 0; i < preset->curves.count; i++) {
        const WrCurve *curve = &preset->curves.data[i];
        if (curve->setting != setting) continue;
        double peak = curve->points[0][1];
        for (int k = 1; k < curve->count; k++)
            if (curve->points[k][1] > peak) peak = curve->points[k][1];
        sum += peak;
    }
    return sum;
}

/* True if its base value and its curves' points can exceed 0. */
static bool preset_uses(const WrPreset *preset, int setting)
{
    return wr_preset_peak(preset, setting) > 0.0;
}

bool wr_preset_is_random(const WrPreset *preset)
{
    static const int chance[] = { MYPAINT_BRUSH_SETTING_OFFSET_BY_RANDOM,
                                  MYPAINT_BRUSH_SETTING_RADIUS_BY_RANDOM,
                                  MYPAINT_BRUSH_SETTING_TRACKING_NOISE };
    for (size_t i = 0; i < sizeof chance / sizeof *chance; i++)
        if (preset->base[chance[i]] != 0.0 || !wr_preset_is_constant(preset, chance[i]))
            return true;
    for (int i = 0; i < preset->curves.count; i++)
        if (preset->curves.data[i].input == MYPAINT_BRUSH_INPUT_RANDOM) return true;
    return false;
}

/* ---- behaviour ---- */

bool wr_preset_smudges(const WrPreset *preset)
{
    return preset_uses(preset, MYPAINT_BRUSH_SETTING_SMUDGE);
}

bool wr_preset_sprays(const WrPreset *preset)
{
    return preset_uses(preset, MYPAINT_BRUSH_SETTING_DABS_PER_SECOND);
}

bool wr_preset_is_colour_only(const WrPreset *preset)
{
    /* Presets that only tint, or only change existing paint, completely and always; or that never cover
       anything. */
    static const int tints[] = { MYPAINT_BRUSH_SETTING_LOCK_ALPHA, MYPAINT_BRUSH_SETTING_COLORIZE,
                                 MYPAINT_BRUSH_SETTING_POSTERIZE };
    for (size_t i = 0; i < sizeof tints / sizeof *tints; i++)
        if (wr_preset_is_constant(preset, tints[i]) && preset->base[tints[i]] >= 1.0) return true;
    return !preset_uses(preset, MYPAINT_BRUSH_SETTING_OPAQUE) ||
           !preset_uses(preset, MYPAINT_BRUSH_SETTING_OPAQUE_MULTIPLY);
}

WrBrush wr_preset_brush(const WrPreset *preset)
{
    WrBrush brush = preset->own;
    brush.preset = preset;
    brush.tip = preset->tip;
    brush.hardness = preset->base[MYPAINT_BRUSH_SETTING_HARDNESS];
    if (!(brush.radius > 0.0)) {
        /* Rounded to a millionth of a texel, so that 16 is restored exactly from its logarithm. */
        double radius = wr_exp2(preset->base[MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC] / LN2);
        brush.radius = rint(radius * 1e6) / 1e6;
    }
    if (!preset->gives_mode && preset->base[MYPAINT_BRUSH_SETTING_ERASER] >= 0.5)
        brush.mode = WR_BRUSH_ERASE;
    return brush;
}

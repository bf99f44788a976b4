/* Modified presets from a text: base values, "slow_tracking=2", and curves,
   "opaque:pressure=0,0|0.4,0.1|1,1". */
#include "base/error.h"
#include "base/text.h"
#include "brush/preset_internal.h"

#include <math.h>
#include <string.h>

static WrPreset *copy(const WrPreset *preset)
{
    WrPreset *made = wr_preset_new(preset->name);
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

static bool read_point(WrCurve *curve, Piece point, WrError *err)
{
    const WrSettingInfo *info = wr_preset_setting(curve->setting);
    const double reach = wr_preset_reach(curve->setting);
    const Piece whole = point;
    const Piece x = cut(&point, ',');
    double at, by;
    char most[WR_NUMBER_SIZE];
    if (!read_in(x, -WR_CURVE_FAR, WR_CURVE_FAR, &at) || !read_in(point, -reach, reach, &by))
        return wr_fail(err,
                       "settings: %s:%s: point '%.*s': must be x,y with the input's value x and "
                       "what is added to the setting there, -%s..%s",
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
    WrCurve curve = { .setting = setting, .input = wr_preset_input_find(name) };
    const char *of = wr_preset_setting(setting)->name;
    if (curve.input < 0)
        return wr_fail(err,
                       "settings: %s:%.*s: is no input of brushes: must be pressure, speed1, "
                       "random, direction or another that MyPaint knows",
                       of, shown(input), input.at);
    while (points.length > 0) {
        if (curve.count == WR_PRESET_POINTS)
            return wr_fail(err, "settings: %s:%s: more than %d points", of, name, WR_PRESET_POINTS);
        if (!read_point(&curve, cut(&points, '|'), err)) return false;
    }
    if (curve.count == 1)
        return wr_fail(err,
                       "settings: %s:%s: one point: must be 2..%d, or none to take the curve "
                       "away",
                       of, name, WR_PRESET_POINTS);
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
        return wr_fail(err,
                       "settings: '%.*s' is not a setting of brush presets: `wrinkle brushes` "
                       "tells them",
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
    WrPreset *blank = wr_preset_new(""), *made = wr_preset_with(blank, settings, err);
    wr_preset_free(blank);
    wr_preset_free(made);
    return made != NULL;
}

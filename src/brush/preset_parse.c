/* Parser of a preset's file: read by json-c and checked member by member. Unknown settings and inputs
   of other programs are skipped and counted; known ones must be valid. */
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/suggest.h"
#include "base/text.h"
#include "brush/preset_internal.h"

#include <json-c/json.h>
#include <math.h>
#include <string.h>

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
    char what[48], text[160];
    snprintf(text, sizeof text, "%s: must be %s", excerpt(value, what), right);
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

/* ---- settings ---- */

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
    double xy[2];
    if (!json_object_is_type(pair, json_type_array) || json_object_array_length(pair) != 2)
        return fail_type(err, at, pair, "points [x, y]");
    for (size_t k = 0; k < 2; k++)
        if (!read_number(json_object_array_get_idx(pair, k), at, -1e300, 1e300, &xy[k], err))
            return false;
    point[0] = (float)bring(xy[0], -WR_CURVE_FAR, WR_CURVE_FAR, skipped);
    point[1] = (float)bring(xy[1], -reach, reach, skipped);
    return true;
}

/* An empty list is no curve. */
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
    wr_preset_drop_curves(preset, setting);
    if (!json_object_object_get_ex(value, "inputs", &inputs)) return true;
    at.member = "inputs";
    if (!json_object_is_type(inputs, json_type_object))
        return fail_type(err, at, inputs, "an object of curves");
    json_object_object_foreach(inputs, key, list)
    {
        int input = wr_preset_input_find(key);
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
    char found[48], what[200];
    snprintf(what, sizeof what, "%.100s: wrinkle: mode: %s", at.file, excerpt(value, found));
    return wr_fail_word(err, what, text, mode_name, NULL);
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

static bool load_tip(WrPreset *preset, const char *folder, WrError *err)
{
    if (!preset->tip_file) return true;
    if (!folder)
        return wr_fail(err, "%.100s: wrinkle: tip: %.100s: a tip needs a preset that is a file",
                       preset->name, preset->tip_file);
    char *path = wr_path_join(folder, preset->tip_file), hex[65];
    bool ok = wr_sha256_file(path, hex, err);
    if (ok && strcmp(hex, preset->tip_sha256) != 0)
        ok = wr_fail(err, "%s: its SHA-256 is %s: the preset was made for another file, %s", path,
                     hex, preset->tip_sha256);
    if (ok) preset->tip = wr_tip_read(path, err);
    wr_free(path);
    if (preset->tip) return true;
    wr_error_prefix(err, "%.100s: tip: ", preset->name);
    return false;
}

/* ---- the file ---- */

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

static json_object *parse_json(const char *text, size_t size, const char *name, WrError *err)
{
    json_tokener *tokener = json_tokener_new_ex(DEPTH);
    if (!tokener) {
        wr_fail(err, "%.100s: no memory to read it", name);
        return NULL;
    }
    json_tokener_set_flags(tokener, JSON_TOKENER_STRICT | JSON_TOKENER_VALIDATE_UTF8);
    json_object *root = json_tokener_parse_ex(tokener, text, (int)size);
    enum json_tokener_error what = json_tokener_get_error(tokener);
    size_t end = json_tokener_get_parse_end(tokener);
    json_tokener_free(tokener);
    if (what != json_tokener_success) {
        json_object_put(root);
        root = NULL;
        wr_fail(err, "%.100s: byte %zu: %s: a preset is a JSON object", name, end,
                what == json_tokener_continue ? "the text ends too early"
                                              : json_tokener_error_desc(what));
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

WrPreset *wr_preset_parse(const char *text, size_t size, const char *name, const char *folder,
                          WrError *err)
{
    if (size > WR_PRESET_BYTES) {
        wr_fail(err, "%.100s: %zu bytes: a preset has at most %d", name, size, WR_PRESET_BYTES);
        return NULL;
    }
    json_object *root = parse_json(text, size, name, err);
    if (!root) return NULL;
    WrPreset *preset = wr_preset_new(name);
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

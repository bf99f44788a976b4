/* Export options about the arrangement of files. */
#include "export/option_parsers.h"

#include "base/error.h"
#include "base/text.h"
#include "export/export.h"
#include "export/job.h"
#include "field/field.h"
#include "field/maps.h"
#include "field/occlusion.h"
#include "field/ops.h"
#include "field/wrap.h"

#include <math.h>
#include <string.h>

const char *const wr_lay_names[] = { WR_LAY_LIST(WR_WORD) NULL };
static const char *const filters[] = { WR_RESIZE_FILTERS(WR_WORD) NULL };

static bool set_switch(const char *name, const char *value, bool *out, WrError *err)
{
    *out = strcmp(value, "on") == 0;
    return *out || strcmp(value, "off") == 0 ||
           wr_fail(err, "%s '%.40s': must be on or off", name, value);
}

bool wr_export_set_dither(WrExportOptions *options, const char *value, WrError *err)
{
    return set_switch("dither", value, &options->dither, err);
}

bool wr_export_set_hidden(WrExportOptions *options, const char *value, WrError *err)
{
    return set_switch("hidden", value, &options->hidden, err);
}

bool wr_export_set_signs(WrExportOptions *options, const char *value, WrError *err)
{
    options->renderman = strcmp(value, "renderman") == 0;
    return options->renderman || strcmp(value, "plain") == 0 ||
           wr_fail(err, "signs '%.40s': must be plain or renderman", value);
}

bool wr_export_set_uvslopes(WrExportOptions *options, const char *value, WrError *err)
{
    double k;
    if (!wr_number_parse(value, strlen(value), &k) || !(k >= 0 && k <= 1e9))
        return wr_fail(err, "uvslopes '%.40s': must be a divisor above 0, or 0: per texel", value);
    options->uvslopes = k;
    return true;
}

bool wr_export_set_endian(WrExportOptions *options, const char *value, WrError *err)
{
    options->big = strcmp(value, "big") == 0;
    return options->big || strcmp(value, "little") == 0 ||
           wr_fail(err, "endian '%.40s': must be little or big", value);
}

bool wr_export_set_sidecar(WrExportOptions *options, const char *value, WrError *err)
{
    bool on;
    if (!set_switch("sidecar", value, &on, err)) return false;
    options->sidecar = on ? WR_EXPORT_SIDECAR_ON : WR_EXPORT_SIDECAR_OFF;
    return true;
}

/* ---- sheets ---- */

bool wr_export_parse_size(const char *value, double low, double high, int *a, int *b)
{
    const char *x = strchr(value, 'x');
    double m, n;
    if (!x || !wr_number_parse(value, (size_t)(x - value), &m) ||
        !wr_number_parse(x + 1, strlen(x + 1), &n) || m != floor(m) || n != floor(n) || m < low ||
        n < low || m > high || n > high)
        return false;
    *a = (int)m;
    *b = (int)n;
    return true;
}

static bool set_word(const char *name, const char *const *words, const char *value, int *out,
                     WrError *err)
{
    char what[80];
    for (int k = 0; words[k]; k++)
        if (strcmp(words[k], value) == 0) {
            *out = k;
            return true;
        }
    snprintf(what, sizeof what, "%s '%.40s'", name, value);
    return wr_fail_word(err, what, value, wr_word_of_array, words);
}

bool wr_export_set_lay(WrExportOptions *options, const char *value, WrError *err)
{
    int lay;
    if (!set_word("lay", wr_lay_names, value, &lay, err)) return false;
    options->lay = (WrExportLay)lay;
    return true;
}

bool wr_export_set_repeat(WrExportOptions *options, const char *value, WrError *err)
{
    return wr_export_parse_size(value, 1, WR_FIELD_MAX, &options->repeat_u, &options->repeat_v) ||
           wr_fail(err, "repeat '%.40s': must be MxN, whole numbers, 1..%d each", value,
                   WR_FIELD_MAX);
}

bool wr_export_set_resize(WrExportOptions *options, const char *value, WrError *err)
{
    options->resize_w = options->resize_h = -1;
    return strcmp(value, "pot") == 0 ||
           wr_export_parse_size(value, 1, WR_FIELD_MAX, &options->resize_w, &options->resize_h) ||
           wr_fail(err, "resize '%.40s': must be WIDTHxHEIGHT, 1..%d each, or pot", value,
                   WR_FIELD_MAX);
}

bool wr_export_set_filter(WrExportOptions *options, const char *value, WrError *err)
{
    return set_word("filter", filters, value, &options->filter, err);
}

bool wr_export_set_border(WrExportOptions *options, const char *value, WrError *err)
{
    return set_switch("border", value, &options->border, err);
}

bool wr_export_set_mips(WrExportOptions *options, const char *value, WrError *err)
{
    return set_switch("mips", value, &options->mips, err);
}

bool wr_export_set_atlas(WrExportOptions *options, const char *value, WrError *err)
{
    for (const char *at = value; at; at = strchr(at, ';') ? strchr(at, ';') + 1 : NULL)
        if (!memchr(at, '.', strcspn(at, ";")))
            return wr_fail(err,
                           "atlas '%.80s': must be files with their endings, separated by "
                           "semicolons",
                           value);
    options->atlas = value;
    return true;
}

bool wr_export_set_margin(WrExportOptions *options, const char *value, WrError *err)
{
    double texels;
    if (!wr_number_parse(value, strlen(value), &texels) || texels != floor(texels) ||
        !(texels >= 0 && texels <= 1024))
        return wr_fail(err, "margin '%.40s': must be a whole number of texels, 0..1024", value);
    options->margin = (int)texels;
    return true;
}

/* An option's range; whole: integers only. */
typedef struct Allowed {
    const char *name, *range; /* the range in words */
    double low, high;
    bool whole;
} Allowed;

static bool parse(const Allowed *a, const char *value, double *out, WrError *err)
{
    if (wr_number_parse(value, strlen(value), out) && *out >= a->low && *out <= a->high &&
        (!a->whole || *out == floor(*out)))
        return true;
    return wr_fail(err, "%s '%.40s': must be %s", a->name, value, a->range);
}

/* ---- bodies ---- */

/* Millimetres. */
static bool parse_length(const char *name, const char *value, double *out, WrError *err)
{
    const Allowed allowed = { name, "millimetres, 1e-6..1e6", 1e-6, 1e6, false };
    return parse(&allowed, value, out, err);
}

bool wr_export_set_solid_size(WrExportOptions *options, const char *value, WrError *err)
{
    return parse_length("size", value, &options->solid_size, err);
}

bool wr_export_set_solid_error(WrExportOptions *options, const char *value, WrError *err)
{
    return parse_length("error", value, &options->solid_error, err);
}

bool wr_export_set_thickness(WrExportOptions *options, const char *value, WrError *err)
{
    return parse_length("thickness", value, &options->solid_thickness, err);
}

/* One of two words. */
static bool parse_either(const char *name, const char *value, const char *off, const char *on,
                         bool *out, WrError *err)
{
    *out = strcmp(value, on) == 0;
    return *out || strcmp(value, off) == 0 ||
           wr_fail(err, "%s '%.40s': must be %s or %s", name, value, off, on);
}

bool wr_export_set_triangles(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "triangles", "a whole number, 1..40000000", 1, 4e7, true };
    double count;
    if (!parse(&allowed, value, &count, err)) return false;
    options->solid_most = (int32_t)count;
    return true;
}

bool wr_export_set_edges(WrExportOptions *options, const char *value, WrError *err)
{
    return parse_either("edges", value, "sharp", "round", &options->solid_rounded, err);
}

bool wr_export_set_folds(WrExportOptions *options, const char *value, WrError *err)
{
    return parse_either("folds", value, "keep", "limit", &options->solid_limited, err);
}

/* ---- by name ---- */

const WrExportKind *wr_export_find(const char *name)
{
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        if (strcmp(wr_export_kinds[i].name, name) == 0) return &wr_export_kinds[i];
    return NULL;
}

static const char *option_name(const void *ctx, int i)
{
    const WrExportKind *kind = ctx;
    return kind->options[i].name;
}

bool wr_export_option(const WrExportKind *kind, WrExportOptions *options, const char *name,
                      const char *value, WrError *err)
{
    for (const WrExportOptionInfo *option = kind->options; option->name; option++)
        if (strcmp(option->name, name) == 0) return option->set(options, value, err);
    char what[100];
    snprintf(what, sizeof what, "%s: unknown name \"%.40s\"", kind->name, name);
    return wr_fail_word(err, what, name, option_name, kind);
}

/* ---- map options ---- */

bool wr_set_directions(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "directions", "4, 8, 16 or 32", 4, 32, true };
    double n;
    if (!parse(&allowed, value, &n, err)) return false;
    if (n != 4 && n != 8 && n != 16 && n != 32)
        return wr_fail(err, "directions '%.40s': must be %s", value, allowed.range);
    options->directions = (int)n;
    return true;
}

bool wr_set_reach(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "reach", "whole texels, 1..256, or all", 1, WR_OCCLUSION_FARTHEST,
                              true };
    double texels = 0;
    if (strcmp(value, "all") != 0 && !parse(&allowed, value, &texels, err)) return false;
    options->reach = (int)texels;
    return true;
}

bool wr_set_toward(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "toward", "degrees from u towards v, 0..360, or all", 0, 360, false };
    double degrees = -1;
    if (strcmp(value, "all") != 0 && !parse(&allowed, value, &degrees, err)) return false;
    options->toward = degrees;
    return true;
}

static bool parse_full(const char *what, WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "full", what, 1e-30, 1e30, false };
    double full = 0;
    if (strcmp(value, "auto") != 0 && !parse(&allowed, value, &full, err)) return false;
    options->full = full;
    return true;
}

bool wr_set_steepest(WrExportOptions *options, const char *value, WrError *err)
{
    return parse_full("a slope above 0, or auto", options, value, err);
}

bool wr_set_full(WrExportOptions *options, const char *value, WrError *err)
{
    return parse_full("a curvature above 0, 1 / scene unit, or auto", options, value, err);
}

bool wr_set_depth_full(WrExportOptions *options, const char *value, WrError *err)
{
    return parse_full("a depth above 0 in scene units, or auto", options, value, err);
}

bool wr_set_radius(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "radius", "texels, 0.1..512", 0.1, 512, false };
    return parse(&allowed, value, &options->radius, err);
}

bool wr_set_part(WrExportOptions *options, const char *value, WrError *err)
{
    static const char *const words[] = { "signed", "convex", "concave" };
    for (int i = 0; i < 3; i++)
        if (strcmp(value, words[i]) == 0) {
            options->part = i;
            return true;
        }
    return wr_fail(err, "part '%.40s': must be signed, convex or concave", value);
}

bool wr_set_box(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "box", "an odd number of texels, 1..255", 1, WR_FIELD_MAP_BOX, true };
    double n;
    if (!parse(&allowed, value, &n, err)) return false;
    if (fmod(n, 2) != 1) return wr_fail(err, "box '%.40s': must be %s", value, allowed.range);
    options->box = (int)n;
    return true;
}

bool wr_set_base(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "base", "Beckmann's alpha of the material, 0..1, or material", 0, 1,
                              false };
    options->base = -1;
    return strcmp(value, "material") == 0 || parse(&allowed, value, &options->base, err);
}

bool wr_set_ground(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "ground", "zero, lowest or a height", -1e30, 1e30, false };
    if (strcmp(value, "zero") == 0) options->ground = WR_EXPORT_GROUND_ZERO;
    else if (strcmp(value, "lowest") == 0) options->ground = WR_EXPORT_GROUND_LOWEST;
    else if (parse(&allowed, value, &options->ground_at, err))
        options->ground = WR_EXPORT_GROUND_GIVEN;
    else return false;
    return true;
}

bool wr_set_scale(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "scale", "size of F = 1", -1e30, 1e30, false };
    return parse(&allowed, value, &options->scale, err);
}

bool wr_set_mask_low(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "low", "a height", -1e30, 1e30, false };
    return parse(&allowed, value, &options->mask_low, err);
}

bool wr_set_mask_high(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "high", "a height", -1e30, 1e30, false };
    return parse(&allowed, value, &options->mask_high, err);
}

bool wr_set_feather(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "feather", "a height, 0 or above", 0, 1e30, false };
    return parse(&allowed, value, &options->feather, err);
}

bool wr_set_threshold(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "threshold", "0..0.999", 0, 0.999, false };
    return parse(&allowed, value, &options->threshold, err);
}

bool wr_set_noise(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "noise", "0..1", 0, 1, false };
    return parse(&allowed, value, &options->noise, err);
}

bool wr_set_grain(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "grain", "whole cells, 1..4096", 1, 4096, true };
    double n;
    if (!parse(&allowed, value, &n, err)) return false;
    options->grain = (int)n;
    return true;
}

/* ---- normals ---- */

bool wr_export_set_axes(WrExportOptions *options, const char *value, WrError *err)
{
    if (wr_export_axes_parse(value, options->axes)) return true;
    return wr_fail(err,
                   "axes '%.40s': must be opengl, directx, or x, y and z in some order with signs, "
                   "as +x-z+y",
                   value);
}

bool wr_export_set_padding(WrExportOptions *options, const char *value, WrError *err)
{
    double rings;
    if (!wr_number_parse(value, strlen(value), &rings) || rings != floor(rings) || rings < 0 ||
        rings > 64)
        return wr_fail(err, "padding '%.40s': must be a whole number of texels, 0..64", value);
    options->padding = (int)rings;
    return true;
}

bool wr_export_set_map_size(WrExportOptions *options, const char *value, WrError *err)
{
    if (wr_export_parse_size(value, 1, WR_FIELD_MAX, &options->map_w, &options->map_h)) return true;
    return wr_fail(err, "size '%.40s': must be WIDTHxHEIGHT in texels, 1..%d each", value,
                   WR_FIELD_MAX);
}

bool wr_export_set_strength(WrExportOptions *options, const char *value, WrError *err)
{
    double strength;
    if (!wr_number_parse(value, strlen(value), &strength) || !(fabs(strength) <= 1e6) ||
        strength == 0.0)
        return wr_fail(err, "strength '%.40s': must be a factor of slopes, -1e6..1e6, not 0",
                       value);
    options->strength = strength;
    return true;
}

bool wr_export_words(const WrExportKind *kind, const char *const *words, int count,
                     WrExportOptions *options, WrError *err)
{
    WrText name = { 0 };
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        const char *equals = strchr(words[i], '=');
        if (!equals) {
            good = wr_fail(err, "%s: expected an option such as depth=16", words[i]);
            continue;
        }
        const size_t length = (size_t)(equals - words[i]);
        wr_text_clear(&name);
        wr_text_add_n(&name, words[i], length);
        for (int k = 0; k < i; k++)
            if (strncmp(words[k], words[i], length + 1) == 0)
                good = wr_fail(err, "%.40s= is given twice", wr_text_get(&name));
        good = good && wr_export_option(kind, options, wr_text_get(&name), equals + 1, err);
    }
    wr_text_fini(&name);
    return good;
}

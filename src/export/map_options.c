#include "export/map_options.h"

#include "export/job.h"
#include "export/options.h"

#include "base/error.h"
#include "base/text.h"
#include "field/field.h"
#include "field/maps.h"
#include "field/occlusion.h"

#include <math.h>
#include <string.h>

/* An option's range; whole: integers only. */
typedef struct Allowed {
    const char *name, *what;
    double low, high;
    bool whole;
} Allowed;

static bool parse(const Allowed *a, const char *value, double *out, WrError *err)
{
    if (wr_number_parse(value, strlen(value), out) && *out >= a->low && *out <= a->high &&
        (!a->whole || *out == floor(*out)))
        return true;
    return wr_fail(err, "%s '%.40s': must be %s", a->name, value, a->what);
}

bool wr_set_directions(WrExportOptions *options, const char *value, WrError *err)
{
    const Allowed allowed = { "directions", "4, 8, 16 or 32", 4, 32, true };
    double n;
    if (!parse(&allowed, value, &n, err)) return false;
    if (n != 4 && n != 8 && n != 16 && n != 32)
        return wr_fail(err, "directions '%.40s': must be %s", value, allowed.what);
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
    if (fmod(n, 2) != 1) return wr_fail(err, "box '%.40s': must be %s", value, allowed.what);
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
    const Allowed allowed = { "scale", "what F = 1 becomes", -1e30, 1e30, false };
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

#include "export/job.h"

#include <math.h>
#include <string.h>

static bool set_depth(WrExportOptions *options, const char *value, WrError *err)
{
    double depth;
    if (!wr_number_parse(value, strlen(value), &depth) ||
        (depth != 8 && depth != 16 && depth != 32))
        return wr_fail(err, "depth '%.40s': must be 8, 16 or 32", value);
    options->depth = (int)depth;
    return true;
}

/* "A,B" */
static bool parse_pair(const char *value, double *a, double *b)
{
    const char *comma = strchr(value, ',');
    return comma && wr_number_parse(value, (size_t)(comma - value), a) &&
           wr_number_parse(comma + 1, strlen(comma + 1), b);
}

static bool set_range(WrExportOptions *options, const char *value, WrError *err)
{
    double low, high;
    if (strcmp(value, "auto") == 0) {
        options->range = WR_EXPORT_RANGE_AUTO;
    } else if (strcmp(value, "signed") == 0) {
        options->range = WR_EXPORT_RANGE_SIGNED;
    } else if (parse_pair(value, &low, &high) && low < high) {
        options->range = WR_EXPORT_RANGE_GIVEN;
        options->low = low;
        options->high = high;
    } else {
        return wr_fail(err, "range '%.80s': must be LOW,HIGH with LOW below HIGH, auto or signed",
                       value);
    }
    return true;
}

static bool set_cell(WrExportOptions *options, const char *value, WrError *err)
{
    double w, h;
    if (!parse_pair(value, &w, &h) || !(w > 0.0) || !(h > 0.0))
        return wr_fail(err, "cell '%.80s': must be WIDTH,HEIGHT in scene units, both above 0",
                       value);
    options->cell_w = w;
    options->cell_h = h;
    return true;
}

static bool set_scheme(WrExportOptions *options, const char *value, WrError *err)
{
    int scheme = wr_scheme_find(value);
    if (scheme >= 0) {
        options->scheme = scheme;
        return true;
    }
    WrText names = { 0 };
    for (int i = 0; i < WR_SCHEME_COUNT; i++)
        wr_text_addf(&names, "%s%s", i ? ", " : "", wr_schemes[i].name);
    wr_fail(err, "scheme '%.40s': must be one of %s", value, wr_text_get(&names));
    wr_text_fini(&names);
    return false;
}

static bool set_dither(WrExportOptions *options, const char *value, WrError *err)
{
    bool on = strcmp(value, "on") == 0;
    if (!on && strcmp(value, "off") != 0)
        return wr_fail(err, "dither '%.40s': must be on or off", value);
    options->dither = on;
    return true;
}

#define DEPTH                                                                                      \
    {                                                                                              \
        "depth", "8, 16 or 32",                                                                    \
            "bits a channel, 32 is float; left out: the deepest the ending holds", set_depth       \
    }
#define RANGE                                                                                      \
    {                                                                                              \
        "range", "LOW,HIGH, auto or signed",                                                       \
            "heights of the first and last code; auto: the table's own; signed: 0 in the middle, " \
            "exactly; "                                                                            \
            "left out: 0,1; float files hold heights as they are",                                 \
            set_range                                                                              \
    }
#define CELL                                                                                       \
    {                                                                                              \
        "cell", "WIDTH,HEIGHT", "size of the unit cell in scene units; left out: 1,1", set_cell    \
    }
#define SCHEME                                                                                     \
    {                                                                                              \
        "scheme", "a derivative scheme", "left out: the scene's", set_scheme                       \
    }
#define DITHER                                                                                     \
    {                                                                                              \
        "dither", "on or off", "hides the steps of 8-bit files; left out: off", set_dither         \
    }

#define NORMAL_OPTIONS                                                                             \
    {                                                                                              \
        DEPTH, CELL, SCHEME, DITHER                                                                \
    }

const WrExportKind wr_export_kinds[WR_EXPORT_KIND_COUNT] = {
    { .name = "height",
      .label = "height",
      .help = "the table itself: one channel, white is high",
      .options = { DEPTH, RANGE, DITHER },
      .channels = 1,
      .prepare = wr_export_height_prepare,
      .rows = wr_export_height_rows,
      .describe = wr_export_height_describe },
    { .name = "normal+y",
      .label = "normal map, +Y (OpenGL)",
      .help = "unit normals with green up: glTF, Blender, Godot, Unity, Maya",
      .options = NORMAL_OPTIONS,
      .channels = 3,
      .green = 1.0,
      .rows = wr_export_normal_rows,
      .describe = wr_export_normal_describe },
    { .name = "normal-y",
      .label = "normal map, -Y (DirectX)",
      .help = "unit normals with green down: Unreal, 3ds Max, Source",
      .options = NORMAL_OPTIONS,
      .channels = 3,
      .green = -1.0,
      .rows = wr_export_normal_rows,
      .describe = wr_export_normal_describe },
};

const WrExportKind *wr_export_find(const char *name)
{
    for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++)
        if (strcmp(wr_export_kinds[i].name, name) == 0) return &wr_export_kinds[i];
    return NULL;
}

bool wr_export_option(const WrExportKind *kind, WrExportOptions *options, const char *name,
                      const char *value, WrError *err)
{
    WrText names = { 0 };
    for (const WrExportOptionInfo *option = kind->options; option->name; option++) {
        if (strcmp(option->name, name) == 0) {
            wr_text_fini(&names);
            return option->set(options, value, err);
        }
        wr_text_addf(&names, "%s%s", names.length ? ", " : "", option->name);
    }
    wr_fail(err, "%s has no option '%.40s'; it has %s", kind->name, name, wr_text_get(&names));
    wr_text_fini(&names);
    return false;
}

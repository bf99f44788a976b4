/* preset_internal.h - the data of a preset, for parser, printer and engine.
   Private to this module.
   Settings and inputs use libmypaint's indices. */
#pragma once
#include <libmypaint/mypaint-brush-settings.h>
#include <stdbool.h>

#include "base/array.h"
#include "brush/preset.h"
#include "brush/tip.h"

#define WR_CURVE_FAR 1e9     /* maximum x of a curve's points */
#define WR_PRESET_TEXT 20000 /* maximum bytes of a description and of the other texts */

/* The curve of one input for one setting: linear between the points, added to the base value. */
typedef struct WrCurve {
    int setting, input, count;
    float points[WR_PRESET_POINTS][2]; /* x never falls; |y| is within the setting's range */
} WrCurve;

struct WrPreset {
    int references; /* atomic */
    char *name;
    char *comment, *description, *group, *notes; /* NULL if absent */
    double base[MYPAINT_BRUSH_SETTINGS_COUNT];   /* within their range */
    WR_ARRAY(WrCurve) curves;                    /* at most one per setting and input */
    WrBrush own; /* "wrinkle" applied to wr_brush_default(); its radius is 0 if the file has none */
    bool gives_mode; /* the file names a mode */
    WrTip *tip;
    char *tip_file; /* plain name; NULL if absent */
    char tip_sha256[65];
    int skipped; /* unknown settings and inputs, and values limited to their range */
};

/* The largest value of a setting with its curves. */
double wr_preset_peak(const WrPreset *preset, int setting);
/* True if it uses a random input, or settings that are random themselves. */
bool wr_preset_is_random(const WrPreset *preset);

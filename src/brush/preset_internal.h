/* preset_internal.h - what a preset is made of, for the files that read, print and run it.
   Private to this module. Settings and inputs go by libmypaint's own numbers. */
#pragma once
#include <libmypaint/mypaint-brush-settings.h>
#include <stdbool.h>

#include "base/array.h"
#include "brush/preset.h"
#include "brush/tip.h"

#define WR_CURVE_FAR 1e9     /* x of a curve's points, at most */
#define WR_PRESET_TEXT 20000 /* bytes of a description, at most; so of the other texts */

/* How one input turns one setting: straight lines between the points, added to the base value. */
typedef struct WrCurve {
    int setting, input, count;
    float points[WR_PRESET_POINTS][2]; /* x never falls; |y| is within the setting's range */
} WrCurve;

struct WrPreset {
    int references; /* atomic */
    char *name;
    char *comment, *description, *group, *notes; /* NULL without */
    double base[MYPAINT_BRUSH_SETTINGS_COUNT];   /* within their range */
    WR_ARRAY(WrCurve) curves;                    /* at most one of a setting and an input */
    WrBrush own; /* "wrinkle" over wr_brush_default(); its radius is 0 where the file gives none */
    bool gives_mode; /* the file names a mode */
    WrTip *tip;
    char *tip_file; /* plain name; NULL without */
    char tip_sha256[65];
    int skipped; /* settings and inputs that this program does not know, and values brought into range */
};

/* One with every setting at its fallback, and the library's own default curve: opacity by pressure. */
WrPreset *wr_preset_new(const char *name);
void wr_preset_drop_curves(WrPreset *preset, int setting);
/* The curve of a setting and an input, NULL without. */
const WrCurve *wr_preset_find_curve(const WrPreset *preset, int setting, int input);
/* The largest value that a setting can have by its points. */
double wr_preset_peak(const WrPreset *preset, int setting);
/* Do its base value and its curves' points, at one place at least, lift it over 0? */
bool wr_preset_uses(const WrPreset *preset, int setting);
/* Is an input that is random used, or chance in itself? */
bool wr_preset_is_random(const WrPreset *preset);

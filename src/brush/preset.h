/* preset.h - brush presets: MyPaint's .myb files, version 3, with our own parser.

   Untrusted text is never passed to the library's own parser, which aborts on many errors: the JSON is
   read here, every curve has 2..64 finite points whose x never falls (two points at one x are a step),
   every value is clamped to its setting's range, and values that would make a stroke endless are
   limited. Unknown settings and inputs are ignored; all other errors are reported with file, member,
   value and the valid range. A file: { "version": 3, "settings": { NAME: { "base_value": x, "inputs": {
   INPUT: [[x,y],...] } } },
             "comment", "group", "description", "notes": texts,
             "wrinkle": { "mode": NAME, "strength": x, "to": x, "opacity": x, "flow": x, "buildup": bool,
                          "reach": x, "radius": x, "aspect": x, "angle": deg, "follow": bool,
                          "jitter": [place, angle, size],
                          "tip": FILE, "tip_sha256": HEX } }
   base_value is required, inputs are optional; an empty curve is none. "wrinkle" is our extension and
   optional, as are its members; other programs ignore it. Its radius is for values beyond the setting's
   range (texels, outside e^-2 .. e^6). A tip is in the preset's folder or one of the program's stamps, by a plain name; its hash is in
   the preset, so that the preset's own hash identifies both. */
#pragma once
#include "brush/brush.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrPreset WrPreset;
typedef struct WrText WrText;
typedef struct WrTip WrTip;

#define WR_PRESET_BYTES 1048576 /* maximum bytes of a file */

/* size: at most WR_PRESET_BYTES. name: the preset's name. folder: of its tip; NULL: a tip is an error. */
WrPreset *wr_preset_parse(const char *text, size_t size, const char *name, const char *folder,
                          WrError *err);
WrPreset *wr_preset_read(const char *path, const char *name, WrError *err);
WrPreset *wr_preset_share(const WrPreset *preset);
void wr_preset_free(WrPreset *preset); /* NULL is allowed */

const char *wr_preset_name(const WrPreset *preset);
const char *wr_preset_description(const WrPreset *preset); /* "" if absent */
const char *wr_preset_group(const WrPreset *preset);       /* "" if absent */
const WrTip *wr_preset_tip(const WrPreset *preset);        /* NULL if absent; borrowed */
const char *wr_preset_tip_file(const WrPreset *preset);    /* its plain name; "" if absent */
/* Number of ignored members and of values limited to their range. */
int wr_preset_skipped(const WrPreset *preset);
/* The brush with the preset's values: radius, hardness, mode, strength, tip, ...; its `preset` is set
 * (borrowed). A preset that erases (`eraser` 0.5 or more, and no mode of its own) gets the mode erase. */
WrBrush wr_preset_brush(const WrPreset *preset);
/* True if some dab drags heights. Then strokes are drawn by moving dabs. */
bool wr_preset_smudges(const WrPreset *preset);
/* True if it continues to make dabs while the pen rests. */
bool wr_preset_sprays(const WrPreset *preset);
/* True if it only affects colour and not heights: if lock_alpha, colorize or posterize is always 1, or
 * if its opacity is never above 0. */
bool wr_preset_is_colour_only(const WrPreset *preset);

/* ---- settings ---- */

typedef enum WrSettingUse {
    WR_SETTING_USED,    /* as in the library */
    WR_SETTING_MAPPED,  /* has another meaning for heights: `meaning` */
    WR_SETTING_IGNORED, /* affects only colour */
    WR_SETTING_USES
} WrSettingUse;

typedef struct WrSettingInfo {
    const char *name;           /* "radius_logarithmic" */
    const char *label;          /* the library's label */
    const char *meaning;        /* for heights; a sentence */
    double low, high, fallback; /* of the base value, as limited here */
    WrSettingUse use;
} WrSettingInfo;

int wr_preset_setting_count(void);
const WrSettingInfo *wr_preset_setting(int index);
int wr_preset_setting_find(const char *name);                  /* -1 */
double wr_preset_value(const WrPreset *preset, int index);     /* base value */
bool wr_preset_is_constant(const WrPreset *preset, int index); /* controlled by no input */

#define WR_PRESET_POINTS 64 /* maximum points of a curve; minimum 2 */

/* A property of pen and motion that can control a setting. */
typedef struct WrInputInfo {
    const char *name;  /* "pressure" */
    const char *label; /* for people */
    const char *help;  /* a sentence */
    double low, high;  /* plot range of a curve; values may exceed it */
} WrInputInfo;

int wr_preset_input_count(void);
const WrInputInfo *wr_preset_input(
    int input); /* The contribution of a curve to a setting is within -reach .. reach. */
double wr_preset_reach(int setting);
/* One input's curve: points [count][2], borrowed; 0 points if none. */
int wr_preset_curve(const WrPreset *preset, int index, int input, const float (**points)[2]);

/* A copy of the preset with other base values and curves:
 * "slow_tracking=2;opaque:pressure=0,0|0.4,0.1|1,1". A curve replaces the setting's curve of that
 * input; without points it is removed. Owned by the caller; NULL and an error: unknown names, values
 * out of range, too many points, a single one, or not in order. */
WrPreset *wr_preset_with(const WrPreset *preset, const char *settings, WrError *err);
/* Checks such a text independently of a preset. False: the same errors. */
bool wr_preset_settings_check(const char *settings, WrError *err);
/* Appends this preset as a file's text with the brush's values, "wrinkle" included. The tip is named if
 * it is still the preset's own. The caller owns *text. */
void wr_preset_print(const WrPreset *preset, const WrBrush *brush, WrText *text);

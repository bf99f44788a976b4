/* preset.h - brush presets: MyPaint's .myb files, version 3, read and checked by ourselves.
   Strangers' text never reaches the library's own parser, which aborts on much of it: the JSON
   is read here, every curve has 2..64 finite points whose x never falls (two points at one x are a step),
   every value is clamped to its setting's range, and what would make a stroke endless is limited. Settings
   and inputs that this program does not know are passed over; anything else that is wrong is an error that
   names file, member, value and what would be right.

   A file: { "version": 3, "settings": { NAME: { "base_value": x, "inputs": { INPUT: [[x,y],...] } } },
             "comment", "group", "description", "notes": texts,
             "wrinkle": { "mode": NAME, "strength": x, "to": x, "opacity": x, "flow": x, "buildup": bool,
                          "reach": x, "radius": x, "aspect": x, "angle": deg, "follow": bool,
                          "jitter": [place, angle, size],
                          "tip": FILE, "tip_sha256": HEX } }
   base_value must be there, inputs need not; an empty curve is none. "wrinkle" is ours and may be left out,
   as may each of its members; others ignore it. Its radius is for what the setting cannot say (texels,
   beyond e^-2 .. e^6). A tip lies beside the preset, by a plain name; its hash is in the preset, so that
   the preset's own hash stands for both. */
#pragma once
#include "brush/brush.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrPreset WrPreset;
typedef struct WrText WrText;
typedef struct WrTip WrTip;

#define WR_PRESET_BYTES 1048576 /* of a file, at most */

/* Immutable, shared by reference count (atomic). */

/* size: at most WR_PRESET_BYTES. name: how it is called from now on. folder: where its tip lies; NULL: a tip is an error. */
WrPreset *wr_preset_parse(const char *text, size_t size, const char *name, const char *folder,
                          WrError *err);
WrPreset *wr_preset_read(const char *path, const char *name, WrError *err);
WrPreset *wr_preset_share(const WrPreset *preset);
void wr_preset_free(WrPreset *preset); /* NULL is fine */

const char *wr_preset_name(const WrPreset *preset);
const char *wr_preset_description(const WrPreset *preset); /* "" without */
const char *wr_preset_group(const WrPreset *preset);       /* "" without */
const WrTip *wr_preset_tip(const WrPreset *preset);        /* NULL without; borrowed */
const char *wr_preset_tip_file(const WrPreset *preset);    /* its plain name; "" without */
/* How much of the file was passed over, or brought into its range. */
int wr_preset_skipped(const WrPreset *preset);
/* The brush as the preset means it: radius, hardness, mode, strength, tip, ...; preset itself is set
 * (borrowed). A preset that erases (`eraser` 0.5 or more, and no mode of its own) gives mode erase. */
WrBrush wr_preset_brush(const WrPreset *preset);
/* Does it drag heights along in some dab? Then strokes go by the moving path. */
bool wr_preset_smudges(const WrPreset *preset);
/* Does it go on making dabs while the pen rests? */
bool wr_preset_sprays(const WrPreset *preset);
/* Has it nothing to say about heights: all that it does is colour? So where lock_alpha, colorize or
 * posterize is 1 whatever the pen does, or where its opacity never rises over 0. */
bool wr_preset_is_colour_only(const WrPreset *preset);

/* ---- settings ---- */

typedef enum WrSettingUse {
    WR_SETTING_USED,    /* as the library means it */
    WR_SETTING_MAPPED,  /* means something for heights instead: `meaning` */
    WR_SETTING_IGNORED, /* only colour */
    WR_SETTING_USES
} WrSettingUse;

typedef struct WrSettingInfo {
    const char *name;           /* "radius_logarithmic" */
    const char *label;          /* as the library calls it */
    const char *meaning;        /* for heights; a sentence */
    double low, high, fallback; /* of the base value, as we allow it */
    WrSettingUse use;
} WrSettingInfo;

int wr_preset_setting_count(void);
const WrSettingInfo *wr_preset_setting(int index);
int wr_preset_setting_find(const char *name);                  /* -1 */
double wr_preset_value(const WrPreset *preset, int index);     /* base value */
bool wr_preset_is_constant(const WrPreset *preset, int index); /* no input turns it */

#define WR_PRESET_POINTS 64 /* of a curve, at most; at least 2 */

/* What of pen and motion can turn a setting. */
typedef struct WrInputInfo {
    const char *name;  /* "pressure" */
    const char *label; /* for people */
    const char *help;  /* a sentence */
    double low, high;  /* what a curve is drawn over; values may lie beyond */
} WrInputInfo;

int wr_preset_input_count(void);
const WrInputInfo *wr_preset_input(int input); /* 0 .. count - 1 */
int wr_preset_input_find(const char *name);    /* -1 */
/* What a curve adds to a setting is within -reach .. reach. */
double wr_preset_reach(int setting);
/* One input's curve: points [count][2], borrowed; 0 points without. */
int wr_preset_curve(const WrPreset *preset, int index, int input, const float (**points)[2]);

/* A preset like this one with other base values, and other curves: "slow_tracking=2;opaque:pressure=0,0|0.4,0.1|1,1".
 * A curve takes the place of the one that the setting has by that input; without points there is none. The caller's;
 * NULL and an error: unknown names, values out of range, points that are too many, one alone, or not in order. */
WrPreset *wr_preset_with(const WrPreset *preset, const char *settings, WrError *err);
/* Is that such a text, whatever the preset? false: the same errors. */
bool wr_preset_settings_check(const char *settings, WrError *err);
/* Appends the file's text of this preset with brush's values as its own, "wrinkle" included. The tip is
 * named if it is still the preset's own. The caller owns *text. */
void wr_preset_print(const WrPreset *preset, const WrBrush *brush, WrText *text);

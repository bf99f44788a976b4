/* settings.h - what the window remembers from one time to the next, as lines "name value" in
   $XDG_CONFIG_HOME/wrinkle/window.conf. */
#pragma once
#include "ui/canvas/canvas.h"
#include "ui/state/layout.h"
#include "ui/toolkit/theme.h"
#include "ui/input/pen_curve.h"

#include "brush/brush.h"
#include "brush/symmetry.h"

#include <stdbool.h>

typedef struct WrText WrText;

#define WR_RECENT_MAX 8
#define WR_FAVOURITES_MAX 64
#define WR_USED_MAX 12
#define WR_FONTS_MAX 6
#define WR_PENS_MAX 32
#define WR_SETTINGS_FILE_MAX (1 << 16) /* bytes */

/* What the tools that draw other things than strokes go by. */
typedef struct WrDrawSettings {
    bool fills;       /* shapes: their inside, not their outline */
    bool closed;      /* the Bezier path ends where it began */
    double corner;    /* of rectangles, texels */
    double tolerance; /* of the flood, heights */
    bool diagonal;    /* it also goes over corners */
    int ramp, blend;  /* WrRampKind; of wr_ramp_blends */
    bool fold;
    double low, high; /* heights of the ramp's ends */
} WrDrawSettings;

typedef struct WrSettings {
    int width, height; /* of the window, pixels at scale 1 of the display */
    bool maximized;
    double scale; /* 0.75..3; 0: from the display */
    WrThemeKind theme;
    int language;   /* of wr_languages */
    int dialogs;    /* for files: WrFileWay */
    double divider; /* the canvas's share of the views, 0..1 */
    WrShownViews views;
    bool panels;        /* shown */
    double lower;       /* the layers' share of the panel on the right, 0..1 */
    bool ants;          /* the outline of a selection moves */
    bool grid;          /* is shown, and drawn things snap to it */
    int grid_parts;     /* of the cell along each axis */
    bool history_lines; /* the history shows command lines, not words */
    WrTiling tiling;    /* how its copies stand beside it, to the eye */
    int join;           /* how a new selection joins the present one: WrSelectMode */
    int tab;            /* of the panel on the right */
    bool turning;       /* the patch turns by itself */
    WrBrush brush;
    WrCanvasLook look;
    /* The files that the brush comes from, owned, NULL: none; as WrBrushSources. */
    char *preset, *tip, *set;
    double mask_strength;  /* of the brush on masks, 0..1 */
    double other_strength; /* of lowering while raising, and the other way round; 0: the same */
    bool lock_size;        /* another preset keeps the size */
    char *favourites[WR_FAVOURITES_MAX]; /* ids of presets, owned; NULL ends them */
    char *used[WR_USED_MAX]; /* the same, newest first; "round" is the brush without a preset */
    /* Fonts chosen last, newest first, owned; NULL ends them: a name of wr_font_names or "FACE PATH". */
    char *fonts[WR_FONTS_MAX];
    bool symmetric;      /* brush.symmetry is `symmetry`; else there is none */
    WrSymmetry symmetry; /* kept while it is off */
    bool symmetry_panel; /* shown */
    int key_map;         /* wr_key_maps */
    WrDrawSettings drawing;
    int steady;                          /* WrRelightKind of strokes by hand */
    double steady_smooth, steady_string; /* their lengths, pixels at scale 1 */
    bool steady_catch_up;                /* a line on a string ends where the pointer does */
    WrFakePressure fake;                 /* of the mouse; held counts while it is not by speed */
    char *pens[WR_PENS_MAX]; /* pressure curves of devices, "CURVE NAME", owned; NULL ends them */
    char *recent[WR_RECENT_MAX + 1]; /* absolute paths, newest first, owned; NULL ends them */
} WrSettings;

WrSettings wr_settings_default(void);
void wr_settings_fini(WrSettings *settings);
/* Take what lines say; lines that are unknown or out of range are passed over, so that a file of another
 * version, or a damaged one, never keeps the window from opening. */
void wr_settings_parse(WrSettings *settings, const char *text);
void wr_settings_print(const WrSettings *settings, WrText *text);

void wr_settings_load(WrSettings *settings);
/* The folder of wr_config_path (base/file.h); a failure is silent: nothing is lost but comfort. */
void wr_settings_make_folder(void);

/* ---- settings_keep.c: the file while several windows are open ---- */

/* All that is kept; the caller's (wr_settings_fini). Of the brush's preset and tip it has the names. */
WrSettings wr_settings_copy(const WrSettings *settings);
bool wr_settings_equal(const WrSettings *a, const WrSettings *b); /* in all that is kept */
/* What changed from `base` to `mine` is changed in `theirs` too; what did not stays as it is there. */
void wr_settings_merge(const WrSettings *base, const WrSettings *mine, WrSettings *theirs);
/* Have the same recent files, brushes used, favourites and pens as another. */
void wr_settings_take_lists(WrSettings *settings, const WrSettings *from);
/* Write what changed since `known`, which is what this program read or wrote last and becomes what is known now:
 * `now` with the lists as the file has them, another window's additions too. last: wait a little where
 * another window is writing just then, and write in any case; else that is a failure. True if it is
 * written; a failure is silent. */
bool wr_settings_update(WrSettings *known, const WrSettings *now, bool last);

/* Keep a text of the settings, NULL: none. */
void wr_settings_set_text(char **text, const char *value);
/* A preset was chosen: it becomes the first of those used. */
void wr_settings_note_used(WrSettings *settings, const char *id);
/* The same of a font. */
void wr_settings_note_font(WrSettings *settings, const char *font);
/* Index of a favourite, or -1; put it at the end, or take it out; does nothing more when all places are
 * taken. */
int wr_settings_favourite(const WrSettings *settings, const char *id);
void wr_settings_set_favourite(WrSettings *settings, const char *id, bool favourite);

/* A line "CURVE NAME" of a pen, in the place of that pen's old one: where its name begins, NULL if it is none. */
const char *wr_settings_pen_name(const char *line);
void wr_settings_keep_pen(WrSettings *settings, const char *line);

/* Put a path first in the list of recent files. */
void wr_settings_note_recent(WrSettings *settings, const char *path);

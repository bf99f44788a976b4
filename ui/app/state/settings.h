/* settings.h - persistent settings of the window, as lines "name value" in $XDG_CONFIG_HOME/wrinkle/window.conf. */
#pragma once
#include "ui/canvas/canvas.h"
#include "ui/app/state/layout.h"
#include "ui/toolkit/folds.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/input/pen_curve.h"

#include "brush/brush.h"
#include "brush/symmetry.h"

#include <stdbool.h>

typedef struct WrText WrText;

#define WR_RECENT_MAX 8
#define WR_FAVOURITES_MAX 200
#define WR_USED_MAX 12
#define WR_FONTS_MAX 6
#define WR_PENS_MAX 32
#define WR_FLOATS_MAX 8      /* tabs in floating panels */
#define WR_WORKSPACES_MAX 16 /* changed workspaces */
#define WR_PINS_MAX 64
#define WR_SETTINGS_FILE_MAX (1 << 16) /* bytes */

/* Settings of drawing tools other than the brush. */
typedef struct WrDrawSettings {
    bool fills;       /* shapes: filled, not outlined */
    bool closed;      /* the Bezier path is closed */
    double corner;    /* corner radius of rectangles, texels */
    double tolerance; /* of the flood fill, heights */
    bool diagonal;    /* the flood fill also crosses corners */
    int ramp, blend;  /* WrRampKind; index into wr_ramp_blends */
    bool fold;
    double low, high; /* heights at the ramp's ends */
} WrDrawSettings;

typedef struct WrSettings {
    int width, height; /* of the window, pixels at scale 1 of the display */
    bool maximized;
    double scale; /* 0.75..3; 0: the display's */
    WrThemeKind theme;
    int language; /* index into wr_languages */
    int dialogs;  /* file dialogs: WrFileWay */
    bool panels;  /* visible */
    /* The place of everything in the window, which each workspace has for itself (workspace.h). */
    double divider; /* share of the views' area for the canvas, 0..1; 0 and 1 close one of them */
    WrShownViews views;
    int tab;                     /* index of the tab in the side panel */
    bool inspector;              /* shown in place of the layers */
    double lower;                /* share of the side panel for the layers, 0..1; 0: closed */
    double side_width;           /* of the side panel, units; 0: automatic, below 0: closed */
    bool side_left;              /* the side panel is on the left */
    bool hide_strip;             /* hide the tool strip */
    bool hide_options;           /* hide the option row */
    bool meters;                 /* the status line shows times and memory */
    char *folds[WR_FOLDS_MAX];   /* folds.h; owned */
    char *floats[WR_FLOATS_MAX]; /* floating panels, "X Y WIDTH HEIGHT TAB" in units; owned */
    int workspace;               /* index into wr_workspaces */
    /* places of the other changed workspaces, "NAME PLACE" (wr_settings_place_print), owned; NULL-terminated */
    char *workspaces[WR_WORKSPACES_MAX];
    char *pins[WR_PINS_MAX]; /* pinned rows, "TAB/LABEL", owned; NULL-terminated */
    bool ants;               /* animate the selection outline */
    bool grid;               /* visible; drawing tools then snap to it */
    int grid_parts;          /* parts of the cell along each axis */
    bool snap;               /* the frame of Free transform snaps; Ctrl reverses it */
    bool history_lines;      /* the history shows command lines instead of names */
    WrTiling tiling;         /* display of the copies beside the cell */
    int join;                /* combination of a new selection with the present one: WrSelectMode */
    bool turning;            /* the patch rotates continuously */
    WrBrush brush;
    WrCanvasDisplay look;
    /* Files of the brush, owned, NULL: none; as in WrBrushSources. */
    char *preset, *tip, *set;
    double mask_strength; /* brush strength on masks, 0..1 */
    /* strength of the opposite action (lower while raising, or the reverse); 0: the same */
    double other_strength;
    bool lock_size; /* keep the size when the preset changes */
    char *favourites
        [WR_FAVOURITES_MAX]; /* ids of presets, stamps and others, owned; NULL-terminated */
    /* recently used preset ids, newest first, owned; NULL-terminated; "round" is the brush without
       a preset */
    char *used[WR_USED_MAX];
    /* Recently used fonts, newest first, owned; NULL-terminated: a name of wr_font_names or "FACE PATH". */
    char *fonts[WR_FONTS_MAX];
    /* Files of the window's fonts, for a faster start, owned (wr_gui_new). */
    char *window_fonts[WR_GUI_FONT_FILES];
    bool symmetric;      /* brush.symmetry is `symmetry`; else there is no symmetry */
    WrSymmetry symmetry; /* kept while symmetry is off */
    bool mesh_mirror[3]; /* on meshes it has mirrors across these axes instead */
    bool symmetry_panel; /* visible */
    int key_map;         /* index into wr_key_maps */
    WrDrawSettings drawing;
    int steady;                          /* stroke stabilizer: WrSmoothingKind */
    double steady_smooth, steady_string; /* stabilizer lengths, pixels at scale 1 */
    bool steady_catch_up;                /* the line catches up with the pointer at its end */
    /* simulated pressure of the mouse; `held` is its value unless it depends on speed */
    WrFakePressure fake;
    char *pens[WR_PENS_MAX]; /* pressure curves of devices, "CURVE NAME", owned; NULL-terminated */
    /* recent files: absolute paths, newest first, owned; NULL-terminated */
    char *recent[WR_RECENT_MAX + 1];
} WrSettings;

WrSettings wr_settings_default(void);
void wr_settings_fini(WrSettings *settings);
/* Apply setting lines. Unknown or out-of-range lines are skipped, so that a file of another version, or a damaged
 * one, never prevents the window from opening. */
void wr_settings_parse(WrSettings *settings, const char *text);
void wr_settings_print(const WrSettings *settings, WrText *text);

/* The place of everything in the window, as the same lines with tabulators in place of line ends; and apply such a
   text, without the present folds and floating panels. */
void wr_settings_place_print(const WrSettings *settings, WrText *text);
void wr_settings_place_parse(WrSettings *settings, const char *text);

void wr_settings_load(WrSettings *settings);
/* Create the folder of wr_config_path (base/file.h); a failure is ignored, since only settings are lost. */
void wr_settings_make_folder(void);

/* ---- the file shared by several open windows ---- */

/* A copy of all saved settings, owned by the caller (wr_settings_fini). The brush's preset and tip are copied as
   names. */
WrSettings wr_settings_copy(const WrSettings *settings);
bool wr_settings_equal(const WrSettings *a, const WrSettings *b); /* compares all saved settings */
/* Copy the lists shared by all windows from another: recent files, used brushes, fonts, favourites and pens. */
void wr_settings_take_lists(WrSettings *settings, const WrSettings *from);
/* Write the changes since `known`, the last state read or written by this program, and update it. Writes `now` with
 * the lists of the file merged in, so that additions by other windows are kept. last: wait briefly if another window
 * is writing, and write in any case; otherwise a busy file is a failure. True if written; failures are not reported.
 */
bool wr_settings_update(WrSettings *known, const WrSettings *now, bool last);

/* Set a text setting, NULL: none. */
void wr_settings_set_text(char **text, const char *value);
/* Move a preset to the front of the recently used ones. */
void wr_settings_note_used(WrSettings *settings, const char *id);
/* Move a font to the front of the recently used ones. */
void wr_settings_note_font(WrSettings *settings, const char *font);
/* Index of a favourite, or -1; toggle appends it, or removes it; nothing is appended to a full list. */
int wr_settings_find_favourite(const WrSettings *settings, const char *id);
void wr_settings_set_favourite(WrSettings *settings, const char *id, bool favourite);

/* The device name in a line "CURVE NAME", NULL if the line is invalid; adding such a line replaces the device's old
   one. */
const char *wr_settings_pen_name(const char *line);
void wr_settings_keep_pen(WrSettings *settings, const char *line);

/* Move a path to the front of the recent files. */
void wr_settings_add_recent(WrSettings *settings, const char *path);

/* preset_browser.h - brush presets: library, thumbnails, and the current choice. */
#pragma once
#include "ui/app/state/app_state.h"

#include "base/array.h"
#include "brush/brush.h"
#include "brush/library.h"
#include "brush/tip.h"
#include "ui/canvas/tools/script_list.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrApp WrApp;
typedef struct WrThumbs WrThumbs;

#define WR_ROUND                                                                                   \
    "round" /* name of the round brush, which has no preset, in lists of presets and in the settings of the window */
/* Files of the brush, as named in command lines. settings.brush.preset and .tip are loaded from them and owned by the
   window. */
typedef struct WrBrushSources {
    char *preset; /* id of the preset, owned; NULL: none */
    char *tip;    /* path of a tip other than the preset's own, owned; NULL: none */
    char *set;    /* "name=value;...", owned; NULL: the preset's own settings */
} WrBrushSources;

/* Lists of the browser. */
typedef enum WrStockKind {
    WR_STOCK_BRUSHES,
    WR_STOCK_STAMPS,
    WR_STOCK_PRESETS, /* of generators */
    WR_STOCK_CELLS,
    WR_STOCK_KINDS
} WrStockKind;

/* State of the preset browser. */
typedef struct WrPresetBrowser {
    WrLibrary *library; /* owned; NULL until first used */
    WrPreset *preset;   /* the chosen one, as in its file; owned; NULL: none */
    /* the chosen one with brush_files.set, target of settings.brush.preset; owned */
    WrPreset *tuned;
    WrTip *tip;         /* tip of brush_files.tip, target of settings.brush.tip; owned */
    WrBrushMode before; /* mode to restore after erasing */
    WrBrushMode kept;   /* the brush's mode while a tool uses another one */
    WrThumbs *thumbs;   /* owned */
    uint64_t serial;    /* number of library scans */
    WrScriptList cells, starters;
    /* the tab */
    int kind; /* WrStockKind */
    char search[80];
    int group[WR_STOCK_KINDS]; /* 0 all, 1 favourites, 2 recently used, 3.. groups of the list */
    int part;                  /* 0 presets, 1 brush parameters, if there is room for only one */
    bool large;                /* larger pictures */
    char pressed[256];         /* id of the entry with the open menu */
    int dragged;               /* index + 1 of the entry that is dragged to the canvas; 0: none */
    double checked;            /* clock: when the user's folder was compared */
    char name[80];             /* name of a new preset */
} WrPresetBrowser;

/* The library; scans the folders at the first call. */
const WrLibrary *wr_preset_browser_library(WrApp *app);
/* Scan again after presets were saved or removed. */
void wr_preset_browser_refresh(WrApp *app);
/* Index in the library, or -1: the round brush, or missing. */
int wr_preset_browser_find(WrApp *app, const char *id);
/* Id of the chosen preset, WR_ROUND without one. */
const char *wr_preset_browser_chosen(const WrApp *app);
/* Choose a preset and copy its values; a failure becomes a message. WR_ROUND: none. */
bool wr_preset_browser_choose(WrApp *app, const char *id);
/* Choose the preset of a .myb file anywhere. */
void wr_preset_browser_take_file(WrApp *app, const char *path);
/* The preset's own values (of the round brush: its defaults). */
WrBrush wr_preset_browser_own(const WrApp *app);
/* Override one base value of the preset; NAN: restore its own. */
void wr_preset_browser_tune(WrApp *app, const char *name, double value);
/* override all at once; NULL: restore all */
void wr_preset_browser_tune_all(WrApp *app, const char *set);
/* the same, with a question if the name exists */
void wr_preset_browser_open_save(WrApp *app, const char *name);
void wr_preset_browser_overwrite(WrApp *app,
                                 const char *path); /* after a yes: save the typed name */
/* Delete a user preset. */
bool wr_preset_browser_delete(WrApp *app, const char *id);
/* Switch to the previously used one; to the next or previous favourite. */
void wr_preset_browser_last(WrApp *app);
void wr_preset_browser_step(WrApp *app, int by);

/* Load the choice from the settings at the start; and copy it to a copy of the settings, which borrows the texts. */
void wr_preset_browser_start(WrApp *app);
void wr_preset_browser_remember(const WrApp *app, WrSettings *settings);
void wr_preset_browser_free(WrApp *app);

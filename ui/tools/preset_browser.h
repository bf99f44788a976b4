/* preset_browser.h - the brushes to choose from: presets, their small pictures, and what is chosen. */
#pragma once
#include "ui/state/app_state.h"

#include "brush/brush.h"
#include "brush/library.h"
#include "brush/tip.h"

#include <SDL.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct WrApp WrApp;
typedef struct WrThumbs WrThumbs;

#define WR_ROUND                                                                                   \
    "round" /* What of the brush comes from files, as command lines name it. settings.brush.preset and .tip are what
   was read from them, owned by the window. */
typedef struct WrBrushSources {
    char *preset; /* id of the preset, owned; NULL: none */
    char *tip;    /* path of a tip that is not the preset's own, owned; NULL: none */
    char *set;    /* "name=value;...", owned; NULL: the preset's own settings */
} WrBrushSources;

/* the brush without a preset, where lists name presets */

typedef struct WrPresetBrowser {
    WrLibrary *library; /* owned; NULL until somebody asks */
    WrPreset *preset;   /* the one chosen, as its file says; owned; NULL: none */
    WrPreset *tuned;    /* the same with brush_files.set, what settings.brush.preset is; owned */
    WrTip *tip;         /* of brush_files.tip, what settings.brush.tip is; owned */
    WrBrushMode before; /* mode to go back to from erasing */
    WrBrushMode kept;   /* the brush's own while a tool paints with another */
    WrThumbs *thumbs;   /* owned */
    uint64_t serial;    /* counts how often the library was looked through */
    /* the tab */
    char search[80];
    int group;         /* 0 all, 1 favourites, 2 used last, 3.. groups of the library */
    int part;          /* 0 presets, 1 the brush, where there is room for one of them only */
    char pressed[256]; /* id whose menu is open */
    char name[80];     /* of a preset to be saved */
} WrPresetBrowser;

/* Looks through the folders at the first call. */
const WrLibrary *wr_preset_browser_library(WrApp *app);
/* Look again: presets were saved or removed. */
void wr_preset_browser_refresh(WrApp *app);
/* Index in the library, or -1: the round brush, or not there. */
int wr_preset_browser_find(WrApp *app, const char *id);
/* Id of what is chosen, WR_ROUND without a preset. */
const char *wr_preset_browser_chosen(const WrApp *app);
/* Take a preset, and its values; a failure becomes a message. WR_ROUND: none. */
bool wr_preset_browser_choose(WrApp *app, const char *id);
/* The values that the preset has by itself (the round brush: those it begins with). */
WrBrush wr_preset_browser_own(const WrApp *app);
/* One base value of the preset in place of its own; NAN: its own again. */
void wr_preset_browser_tune(WrApp *app, const char *name, double value);
void wr_preset_browser_tune_all(WrApp *app,
                                const char *set); /* all at once; NULL: all its own again */
/* A picture as a tip, NULL: none. Leaves the preset. */
bool wr_preset_browser_tip(WrApp *app, const char *path);
/* The brush as a preset of the user's own, and choose it. */
bool wr_preset_browser_save(WrApp *app, const char *name);
void wr_preset_browser_ask_save(WrApp *app,
                                const char *name); /* the same, asking first where it is taken */
void wr_preset_browser_take(WrApp *app, const char *path); /* it may be replaced: save shelf.name */
/* Remove one of the user's own. */
bool wr_preset_browser_delete(WrApp *app, const char *id);
/* The one before in the list of those used; the next or the one before among the favourites. */
void wr_preset_browser_last(WrApp *app);
void wr_preset_browser_step(WrApp *app, int by);

/* What the settings remember, at the start; and put it into a copy of them, whose texts stay the shelf's. */
void wr_preset_browser_start(WrApp *app);
void wr_preset_browser_remember(const WrApp *app, WrSettings *settings);
void wr_preset_browser_free(WrApp *app);

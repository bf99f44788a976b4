/* settings.h - what the window remembers from one time to the next, as lines "name value" in
   $XDG_CONFIG_HOME/wrinkle/window.conf. */
#pragma once
#include "base/text.h"
#include "brush/brush.h"
#include "ui/canvas.h"
#include "ui/layout.h"

#define WR_RECENT_MAX 8

typedef struct WrSettings {
    int width, height; /* of the window, pixels at scale 1 of the display */
    bool maximized;
    double scale;   /* 0.75..3; 0: from the display */
    double divider; /* the canvas's share of the views, 0..1 */
    WrViews views;
    bool panels;  /* shown */
    double lower; /* the layers' share of the panel on the right, 0..1 */
    bool ants;    /* the outline of a selection moves */
    int join;     /* how a new selection joins the present one: WrSelectMode */
    int tab;      /* of the panel on the right */
    bool turning; /* the patch turns by itself */
    WrBrush brush;
    WrCanvasLook look;
    char *recent[WR_RECENT_MAX]; /* absolute paths, newest first, owned; NULL ends them */
} WrSettings;

WrSettings wr_settings_default(void);
void wr_settings_fini(WrSettings *settings);
/* Take what lines say; lines that are unknown or out of range are passed over, so that a file of another
 * version, or a damaged one, never keeps the window from opening. */
void wr_settings_parse(WrSettings *settings, const char *text);
void wr_settings_print(const WrSettings *settings, WrText *text);

/* A file of ours in the user's configuration folder. Caller frees with wr_free; NULL if there is no home. */
char *wr_config_path(const char *name);
void wr_settings_load(WrSettings *settings);
/* Creates the folder if need be; a failure is silent: nothing is lost but comfort. */
void wr_settings_save(const WrSettings *settings);

/* Put a path first in the list of recent files. */
void wr_settings_note_recent(WrSettings *settings, const char *path);

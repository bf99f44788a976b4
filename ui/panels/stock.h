/* stock.h - lists of the Brushes tab: brushes, stamps, presets of generators, cells. One row each; the tab is
   panel_brushes.c. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/canvas/tools/preset_browser.h"

#include <SDL.h>
#include <stdbool.h>

typedef struct WrStockItem {
    char id[300];    /* of favourites */
    char name[128];  /* shown; not translated */
    char group[96];  /* heading */
    char words[400]; /* also found by the search */
} WrStockItem;

typedef struct WrStockList {
    const char *label, *hint; /* hint: of the search field */
    int (*count)(WrApp *app);
    void (*item)(WrApp *app, int index, WrStockItem *item);
    SDL_Texture *(*picture)(WrApp *app, int index, int side); /* as wr_thumb */
    bool (*chosen)(WrApp *app, int index);                    /* NULL: none ever is */
    void (*choose)(WrApp *app, int index);
    /* Preview the entry while it is dragged over the canvas, or end that; NULL: none. */
    void (*hover)(WrApp *app, int index, double u, double v, bool over);
    void (*drop)(WrApp *app, int index, double u, double v); /* on the canvas */
    bool (*remove)(WrApp *app, int index); /* one of the user's own; false: it is not */
    const char *drop_help;
} WrStockList;

extern const WrStockList wr_stock[WR_STOCK_KINDS];

extern const WrPart wr_part_stock; /* of panel_brushes.c */

/* panel_search.h - state of the search of everything. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/panels/search_index.h"

#define WR_SEARCH_SHOWN 40 /* listed results */

typedef struct WrFinder { /* the search */
    char text[600];
    /* a command was just chosen: the field contains its verb and needs the keyboard focus */
    bool fill;
    bool line;        /* the text is a command line, not a search */
    int chosen, seen; /* row chosen, and that which was last scrolled to */
    bool empty;       /* Return in an empty field: restore the keyboard focus */
    WrSearchIndex index;
    /* results for a text, and the state of the index then */
    WrSearchHit found[WR_SEARCH_SHOWN];
    int found_count;
    char found_for[600];
    uint64_t found_at;
} WrFinder;

void wr_dialog_search(WrApp *app);
/* Opens the search. Not within a frame. */
void wr_search_open(WrApp *app);
/* Opens the search with a command line, to be changed and run. */
void wr_search_line(WrApp *app, const char *line);

extern const WrPart wr_part_search;

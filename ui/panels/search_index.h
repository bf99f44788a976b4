/* search_index.h - everything that the search finds: rows of panels, options of tools and dialogs as they are drawn, and the
   tables of actions, generators, operations, scene values, models, materials, brushes, pages and commands. */
#pragma once
#include "ui/app/state/app_state.h"

#include "base/array.h"

#include <stdbool.h>

typedef enum WrSearchKind {
    WR_SEARCH_ACTION,
    WR_SEARCH_TOOL,
    WR_SEARCH_ROW,
    WR_SEARCH_CHOICE, /* one of the alternatives of a row */
    WR_SEARCH_GENERATOR,
    WR_SEARCH_OPERATION,
    WR_SEARCH_FILTER, /* the operation as a filter layer */
    WR_SEARCH_OPTION, /* a value of a generator, an operation, a model or a brush */
    WR_SEARCH_MODEL,
    WR_SEARCH_MATERIAL,
    WR_SEARCH_BRUSH,
    WR_SEARCH_PAGE,
    WR_SEARCH_COMMAND,
    WR_SEARCH_KINDS
} WrSearchKind;

typedef struct WrSearchEntry {
    WrSearchKind kind;
    int item;         /* index in the table of its kind: brush, material, model */
    int pictures;     /* WrThumbKind + 1 of its picture; 0: none */
    char *label;      /* as shown; owned */
    char *where;      /* as shown, "Scene > LIGHT"; owned */
    const char *help; /* translated by the widget; owned by the index if `own_help` */
    bool own_help;
    char *field[5];      /* folded texts, [WR_SEARCH_FIELDS]; owned; NULL: none */
    char *action;        /* action, or text of its kind: line, command, page; owned; NULL: none */
    bool hidden;         /* the row is not drawn at present */
    bool button;         /* the row is a button */
    const char *tab;     /* label of the tab that has the row; NULL: none */
    int part;            /* of the tab of brushes */
    char *section, *row; /* texts of the row, owned; NULL: none */
} WrSearchEntry;

typedef struct WrSearchIndex {
    WR_ARRAY(WrSearchEntry) entries;
    int fixed; /* the first ones, which depend only on the language and the library */
    char language[8];
    const void *library; /* of brushes */
    uint64_t revision;   /* of the document */
    uint64_t made;       /* number of changes of the index */
} WrSearchIndex;

typedef struct WrSearchHit {
    int entry, score;
} WrSearchHit;

/* Make the index, unless it is that of the present document and language. Not within a frame. */
void wr_search_index_update(WrApp *app);
/* The best entries for a text, best first; commands come last. Returns their number. */
int wr_search_index_find(const WrSearchIndex *index, const char *text, WrSearchHit *out, int most);
/* Run the entry's action, or open its place and highlight its row. Not within a frame. */
void wr_search_index_open(WrApp *app, const WrSearchEntry *entry);
void wr_search_index_free(WrSearchIndex *index);

/* guide_page.h - a guide page as blocks, parsed from the guide's subset of Markdown. Pure; tested without a window.

   Supported: headings (#, ##, ###), paragraphs, items (- and 1.), tables, code (indented by four blanks), pictures on
   lines of their own; within a text `code`, *emphasis*, **strong**, [links](target) and ![pictures](path), of which
   only the words are shown. Comments (<!-- -->) are left out. Code within an item is treated as text. */
#pragma once
#include "base/array.h"

#include <stdbool.h>

typedef enum WrGuideKind {
    WR_GUIDE_HEADING,
    WR_GUIDE_TEXT,
    WR_GUIDE_ITEM,
    WR_GUIDE_CODE,   /* one line of code */
    WR_GUIDE_ROW,    /* row of a table */
    WR_GUIDE_PICTURE /* cell 0: its words, cell 1: its path as written */
} WrGuideKind;

#define WR_GUIDE_CELLS 10 /* limit of columns in a table; further ones are joined with the last */

typedef struct WrGuideBlock {
    WrGuideKind kind;
    int level;    /* heading: 1..3; item: its number, 0: none; row: 1 for the head row */
    bool command; /* code that the window can run; set by the page's owner (guide.h) */
    bool joined;  /* a row or code that continues the previous block */
    int cells;    /* 1 except for rows */
    char *cell[WR_GUIDE_CELLS]; /* owned; Markdown of one line; for code plain text */
} WrGuideBlock;

typedef struct WrGuidePage {
    char *name;  /* file name: "window.md"; owned */
    char *title; /* the first heading, or the file name; owned */
    WR_ARRAY(WrGuideBlock) blocks;
} WrGuidePage;

/* Parse a page. Never fails: anything else than Markdown is text. */
void wr_guide_parse(WrGuidePage *page, const char *name, const char *text);
void wr_guide_page_fini(WrGuidePage *page);

typedef enum WrGuideStyle {
    WR_GUIDE_PLAIN,
    WR_GUIDE_EMPHASIS,
    WR_GUIDE_STRONG,
    WR_GUIDE_LITERAL,
    WR_GUIDE_LINK
} WrGuideStyle;

typedef struct WrGuideSpan {
    WrGuideStyle style;
    const char *text; /* points into the Markdown */
    int length;       /* bytes */
    const char *link; /* target of a link; else NULL */
    int link_length;
} WrGuideSpan;

/* The next span of a cell's Markdown; *at starts at the cell and advances. False at its end. */
bool wr_guide_span(const char **at, WrGuideSpan *span);
/* A cell's words without marks, or unchanged if the block is code. Returns buffer. */
char *wr_guide_plain(const WrGuideBlock *block, int cell, char *buffer, size_t size);

typedef struct WrGuideFound {
    int page, block;
} WrGuideFound;

/* Find the blocks in which every word of a query occurs in the cells, or in heading and cells; headings first, then
 * blocks that start with the query. Returns the number of entries written to out[0..most). An empty query finds
 * nothing. */
int wr_guide_search(const WrGuidePage *pages, int count, const char *query, WrGuideFound *out,
                    int most);

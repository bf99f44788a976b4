/* guide_page.h - a guide page as blocks, parsed from Markdown by md4c. Pure; tested without a window.

   CommonMark and tables. Lists in lists and quotations are flat, HTML and comments are left out. A picture in a paragraph
   is a block of its own; elsewhere only its words are shown. */
#pragma once
#include "base/array.h"
#include "base/text.h"

#include <stdbool.h>

typedef enum WrGuideKind {
    WR_GUIDE_HEADING,
    WR_GUIDE_TEXT,
    WR_GUIDE_ITEM,
    WR_GUIDE_CODE,   /* one line of code */
    WR_GUIDE_ROW,    /* row of a table */
    WR_GUIDE_PICTURE /* its words, with its path as the link of the first span */
} WrGuideKind;

typedef enum WrGuideStyle {
    WR_GUIDE_PLAIN,
    WR_GUIDE_EMPHASIS,
    WR_GUIDE_STRONG,
    WR_GUIDE_LITERAL,
    WR_GUIDE_STYLES
} WrGuideStyle;

typedef struct WrGuideSpan {
    WrGuideStyle style;
    int length; /* bytes */
    char *link; /* target of a link; owned; NULL: none */
} WrGuideSpan;

typedef struct WrGuideCell {
    WrText text;                 /* words without marks, in one line */
    WR_ARRAY(WrGuideSpan) spans; /* from the start of the text to its end */
} WrGuideCell;

#define WR_GUIDE_CELLS 10 /* limit of columns in a table; further ones are joined with the last */

typedef struct WrGuideBlock {
    WrGuideKind kind;
    int level;    /* heading: 1..6; item: its number, 0: none; row: 1 for the head row */
    bool command; /* code that the window can run; set by the page's owner (guide.h) */
    bool joined;  /* a row or code that continues the previous block */
    WR_ARRAY(WrGuideCell) cells; /* 1 except for rows */
} WrGuideBlock;

typedef struct WrGuidePage {
    char *name;  /* file name: "window.md"; owned */
    char *title; /* the first heading, or the file name; owned */
    WR_ARRAY(WrGuideBlock) blocks;
} WrGuidePage;

/* Parse a page. Never fails: anything else than Markdown is text. */
void wr_guide_parse(WrGuidePage *page, const char *name, const char *text);
void wr_guide_page_fini(WrGuidePage *page);
/* The text of a cell; "" if the block has fewer. */
const char *wr_guide_words(const WrGuideBlock *block, int cell);

typedef struct WrGuideFound {
    int page, block;
} WrGuideFound;

/* Find the blocks in which every word of a query occurs in the cells, or in heading and cells; headings first, then
 * blocks that start with the query. Returns the number of entries written to out[0..most). An empty query finds
 * nothing. */
int wr_guide_search(const WrGuidePage *pages, int count, const char *query, WrGuideFound *out,
                    int most);

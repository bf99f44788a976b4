/* guide_page.h - a page of the guide as blocks: the part of Markdown that the guide is written in. Pure; tested
   without a window.

   Headings (#, ##, ###), paragraphs, items (- and 1.), tables, code (indented by four blanks), pictures that stand
   alone; within a text `code`, *emphasis*, **strong**, [links](target) and ![pictures](path), of which only the words
   are shown. Comments (<!-- -->) are left out. Code within an item is not told apart. */
#pragma once
#include "base/array.h"

#include <stdbool.h>

typedef enum WrGuideKind {
    WR_GUIDE_HEADING,
    WR_GUIDE_TEXT,
    WR_GUIDE_ITEM,
    WR_GUIDE_CODE,   /* one line of it */
    WR_GUIDE_ROW,    /* of a table */
    WR_GUIDE_PICTURE /* cell 0 its words, cell 1 its path as it stands */
} WrGuideKind;

#define WR_GUIDE_CELLS 10 /* columns of a table, at most; what follows is one with the last */

typedef struct WrGuideBlock {
    WrGuideKind kind;
    int level; /* of a heading, 1..3; of an item its number, 0: none; of a row 1 for the first, which heads the rest */
    bool joined;                /* a row or code goes on from the block before */
    int cells;                  /* 1 but of rows */
    char *cell[WR_GUIDE_CELLS]; /* Markdown of one line, owned; of code plain text */
} WrGuideBlock;

typedef struct WrGuidePage {
    char *name;  /* of its file: "window.md"; owned */
    char *title; /* its first heading, or its name; owned */
    WR_ARRAY(WrGuideBlock) blocks;
} WrGuidePage;

/* Read a page. Never fails: what is no Markdown is text. */
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
    const char *text; /* within the Markdown */
    int length;       /* bytes */
    const char *link; /* of a link: where it leads; else NULL */
    int link_length;
} WrGuideSpan;

/* The next span of a cell's Markdown; *at begins at the cell and is moved. False at its end. */
bool wr_guide_span(const char **at, WrGuideSpan *span);
/* A cell's words without the marks, or as they stand where the block is code. Returns buffer. */
char *wr_guide_plain(const WrGuideBlock *block, int cell, char *buffer, size_t size);

typedef struct WrGuideFound {
    int page, block;
} WrGuideFound;

/* Where all words of a query stand: blocks in whose cells, or in whose heading and cells, each is found; headings
 * first, then what begins with it. Returns how many of out[0..most) are set. An empty query finds nothing. */
int wr_guide_search(const WrGuidePage *pages, int count, const char *query, WrGuideFound *out,
                    int most);

#include "ui/panels/help/guide_page.h"
#include "ui/app/state/search_score.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/text.h"

#include <SDL.h>
#include <md4c.h>
#include <stdlib.h>
#include <string.h>

/* ---- parsing ---- */

typedef struct Reader {
    WrGuidePage *page;
    WrGuideBlock next;           /* kind, level and joined of the open block, or of the next one */
    bool begins, splits;         /* the next text begins a block; a span */
    int inside[WR_GUIDE_STYLES]; /* number of open spans of each style */
    char *link;                  /* target of the open link; owned; NULL: none */
    WR_ARRAY(int) numbers;       /* of each open list: its next item's number, 0: none */
} Reader;

static void begin(Reader *r, WrGuideKind kind, int level)
{
    r->next = (WrGuideBlock){ .kind = kind, .level = level };
    r->begins = true;
}

/* The page's last cell, after adding the block that begins, or another cell. */
static WrGuideCell *open_cell(Reader *r, bool another)
{
    if (r->begins) wr_array_push(&r->page->blocks, r->next);
    WrGuideBlock *block = &r->page->blocks.data[r->page->blocks.count - 1];
    if (r->begins || (another && block->cells.count < WR_GUIDE_CELLS)) {
        wr_array_push(&block->cells, ((WrGuideCell){ 0 }));
        r->splits = true;
    }
    r->begins = false;
    return &block->cells.data[block->cells.count - 1];
}

static void add_text(Reader *r, const char *text, size_t size)
{
    WrGuideCell *cell = open_cell(r, false);
    WrGuideStyle style = WR_GUIDE_LITERAL;
    while (style > WR_GUIDE_PLAIN && !r->inside[style]) style--;
    if (r->splits)
        wr_array_push(&cell->spans,
                      ((WrGuideSpan){ style, 0, r->link ? wr_strdup(r->link) : NULL }));
    r->splits = false;
    wr_text_add_n(&cell->text, text, size);
    cell->spans.data[cell->spans.count - 1].length += (int)size;
}

/* Characters by number, and the names of those that Markdown uses itself; other names remain as they are. */
static void add_entity(Reader *r, const char *text, size_t size)
{
    static const char *const names[] = { "&amp;", "&lt;", "&gt;", "&quot;", "&nbsp;" };
    const bool hex = text[2] == 'x' || text[2] == 'X';
    Uint32 code = 0;
    if (text[1] == '#') code = (Uint32)strtoul(text + 2 + hex, NULL, hex ? 16 : 10);
    for (int i = 0; i < 5; i++)
        if (strncmp(names[i], text, size) == 0) code = (Uint32) "&<>\" "[i];
    code = SDL_SwapLE32(code);
    char *letter = code ? SDL_iconv_string("UTF-8", "UTF-32LE", (char *)&code, 4) : NULL;
    if (letter) add_text(r, letter, strlen(letter));
    else add_text(r, text, size);
    SDL_free(letter);
}

static int take_text(MD_TEXTTYPE type, const char *text, MD_SIZE size, void *user)
{
    Reader *r = user;
    if (type == MD_TEXT_HTML) return 0;
    if (type == MD_TEXT_BR || type == MD_TEXT_SOFTBR) text = " ", size = 1;
    if (r->next.kind == WR_GUIDE_CODE && *text == '\n') {
        r->next.joined = !r->begins; /* not after an empty line */
        r->begins = true;
    } else if (type == MD_TEXT_ENTITY) {
        add_entity(r, text, size);
    } else if (!r->begins || r->next.kind == WR_GUIDE_CODE || strspn(text, " ") < size) {
        add_text(r, text, size); /* no block begins with the blank between two pictures */
    }
    return 0;
}

static int enter_block(MD_BLOCKTYPE type, void *detail, void *user)
{
    Reader *r = user;
    int *number = r->numbers.count ? &r->numbers.data[r->numbers.count - 1] : NULL;
    switch (type) {
    case MD_BLOCK_H: begin(r, WR_GUIDE_HEADING, (int)((MD_BLOCK_H_DETAIL *)detail)->level); break;
    case MD_BLOCK_P:
        if (!r->begins || r->next.kind != WR_GUIDE_ITEM) begin(r, WR_GUIDE_TEXT, 0);
        break;
    case MD_BLOCK_UL: wr_array_push(&r->numbers, 0); break;
    case MD_BLOCK_OL: wr_array_push(&r->numbers, (int)((MD_BLOCK_OL_DETAIL *)detail)->start); break;
    case MD_BLOCK_LI: begin(r, WR_GUIDE_ITEM, number && *number ? (*number)++ : 0); break;
    case MD_BLOCK_CODE: begin(r, WR_GUIDE_CODE, 0); break;
    case MD_BLOCK_THEAD: begin(r, WR_GUIDE_ROW, 1); break;
    case MD_BLOCK_TBODY:
        begin(r, WR_GUIDE_ROW, 0);
        r->next.joined = true;
        break;
    case MD_BLOCK_TR: r->begins = true; break;
    case MD_BLOCK_TH:
    case MD_BLOCK_TD: open_cell(r, true); break;
    default: break;
    }
    return 0;
}

static int leave_block(MD_BLOCKTYPE type, void *detail, void *user)
{
    (void)detail;
    Reader *r = user;
    if (type == MD_BLOCK_UL || type == MD_BLOCK_OL) r->numbers.count--;
    r->begins = false;
    return 0;
}

static WrGuideStyle style_of(MD_SPANTYPE type)
{
    switch (type) {
    case MD_SPAN_EM: return WR_GUIDE_EMPHASIS;
    case MD_SPAN_STRONG: return WR_GUIDE_STRONG;
    case MD_SPAN_CODE: return WR_GUIDE_LITERAL;
    default: return WR_GUIDE_PLAIN;
    }
}

static void set_link(Reader *r, const MD_ATTRIBUTE *target)
{
    wr_free(r->link);
    r->link = target ? wr_strndup(target->size ? target->text : "", target->size) : NULL;
}

static int enter_span(MD_SPANTYPE type, void *detail, void *user)
{
    Reader *r = user;
    r->inside[style_of(type)]++;
    r->splits = true;
    if (type == MD_SPAN_A) set_link(r, &((MD_SPAN_A_DETAIL *)detail)->href);
    if (type != MD_SPAN_IMG) return 0;
    set_link(r, &((MD_SPAN_IMG_DETAIL *)detail)->src);
    if (r->next.kind == WR_GUIDE_TEXT) {
        begin(r, WR_GUIDE_PICTURE, 0);
        add_text(r, "", 0);
    }
    return 0;
}

static int leave_span(MD_SPANTYPE type, void *detail, void *user)
{
    (void)detail;
    Reader *r = user;
    r->inside[style_of(type)]--;
    r->splits = true;
    if (type == MD_SPAN_A || type == MD_SPAN_IMG) set_link(r, NULL);
    if (type == MD_SPAN_IMG && r->next.kind == WR_GUIDE_PICTURE) begin(r, WR_GUIDE_TEXT, 0);
    return 0;
}

void wr_guide_parse(WrGuidePage *page, const char *name, const char *text)
{
    static const MD_PARSER parser = { .flags = MD_FLAG_TABLES,
                                      .enter_block = enter_block,
                                      .leave_block = leave_block,
                                      .enter_span = enter_span,
                                      .leave_span = leave_span,
                                      .text = take_text };
    Reader reader = { .page = page };
    *page = (WrGuidePage){ .name = wr_strdup(name) };
    md_parse(text, (MD_SIZE)strlen(text), &parser, &reader);
    wr_array_free(&reader.numbers);
    for (int i = 0; i < page->blocks.count && !page->title; i++)
        if (page->blocks.data[i].kind == WR_GUIDE_HEADING)
            page->title = wr_strdup(wr_guide_words(&page->blocks.data[i], 0));
    if (!page->title) page->title = wr_strdup(name);
}

const char *wr_guide_words(const WrGuideBlock *block, int cell)
{
    return cell < block->cells.count ? wr_text_get(&block->cells.data[cell].text) : "";
}

static void cell_fini(WrGuideCell *cell)
{
    for (int i = 0; i < cell->spans.count; i++) wr_free(cell->spans.data[i].link);
    wr_array_free(&cell->spans);
    wr_text_fini(&cell->text);
}

void wr_guide_page_fini(WrGuidePage *page)
{
    for (int i = 0; i < page->blocks.count; i++) {
        WrGuideBlock *block = &page->blocks.data[i];
        for (int k = 0; k < block->cells.count; k++) cell_fini(&block->cells.data[k]);
        wr_array_free(&block->cells);
    }
    wr_array_free(&page->blocks);
    wr_free(page->name);
    wr_free(page->title);
    *page = (WrGuidePage){ 0 };
}

/* ---- search ---- */

#define BLOCK_WORDS 8192 /* searched bytes of a block */

/* True if all words of the query are in the block, or some of them in it and the others in its heading. */
static bool answers(const WrGuideBlock *block, const WrGuideBlock *heading, const char *query)
{
    char words[BLOCK_WORDS] = "";
    if (heading && heading != block && wr_search_score(wr_guide_words(heading, 0), query) == 0)
        SDL_strlcat(words, wr_guide_words(heading, 0), sizeof words);
    for (int i = 0; i < block->cells.count; i++) {
        SDL_strlcat(words, " ", sizeof words);
        SDL_strlcat(words, wr_guide_words(block, i), sizeof words);
    }
    return wr_search_score(words, query) > 0;
}

/* Rank of a match: 0 headings, 1 blocks that start with the query (rows for a word), 2 others. */
static int rank_of(const WrGuideBlock *block, const char *query)
{
    if (block->kind == WR_GUIDE_HEADING) return 0;
    return SDL_strncasecmp(wr_guide_words(block, 0), query, strlen(query)) == 0 ? 1 : 2;
}

/* One pass over all pages for one rank. */
static int search(const WrGuidePage *pages, int count, const char *query, int rank,
                  WrGuideFound *out, int found, int most)
{
    for (int i = 0; i < count; i++) {
        const WrGuideBlock *heading = NULL;
        for (int k = 0; k < pages[i].blocks.count && found < most; k++) {
            const WrGuideBlock *block = &pages[i].blocks.data[k];
            if (block->kind == WR_GUIDE_HEADING) heading = block;
            if (rank_of(block, query) == rank && answers(block, heading, query))
                out[found++] = (WrGuideFound){ i, k };
        }
    }
    return found;
}

int wr_guide_search(const WrGuidePage *pages, int count, const char *query, WrGuideFound *out,
                    int most)
{
    query += strspn(query, " ");
    if (!*query) return 0;
    int found = 0;
    for (int rank = 0; rank < 3; rank++)
        found = search(pages, count, query, rank, out, found, most);
    return found;
}

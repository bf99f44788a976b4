#include "ui/help/guide_page.h"
#include "ui/state/search.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/text.h"

#include <SDL.h>
#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* ---- parsing ---- */

typedef struct Reader {
    WrGuidePage *page;
    WrText open;      /* the open text or item whose lines are being joined */
    WrGuideKind kind; /* kind of the open text */
    int level;
    bool blank, comment; /* the previous line was blank; inside a multi-line comment */
} Reader;

static WrGuideBlock *add(WrGuidePage *page, WrGuideKind kind, int level)
{
    wr_array_push(&page->blocks, ((WrGuideBlock){ .kind = kind, .level = level }));
    return &page->blocks.data[page->blocks.count - 1];
}

static void add_cell(WrGuideBlock *block, const char *text, size_t length)
{
    if (block->cells < WR_GUIDE_CELLS) block->cell[block->cells++] = wr_strndup(text, length);
}

/* A text of nothing but pictures becomes one block for each. */
static bool add_pictures(WrGuidePage *page, const char *text)
{
    const char *p = text;
    for (int pass = 0; pass < 2; pass++)
        for (p = text; *p;) {
            size_t words = strncmp(p, "![", 2) == 0 ? strcspn(p + 2, "]") : 0;
            const char *path = p + 2 + words;
            if (words == 0 || strncmp(path, "](", 2) != 0) return false;
            path += 2;
            size_t length = strcspn(path, ")");
            if (path[length] != ')') return false;
            if (pass == 1) {
                WrGuideBlock *block = add(page, WR_GUIDE_PICTURE, 0);
                add_cell(block, p + 2, words);
                add_cell(block, path, length);
            }
            p = path + length + 1;
            p += strspn(p, " ");
        }
    return p > text;
}

/* Close the open text or item. */
static void finish(Reader *r)
{
    const char *text = wr_text_get(&r->open);
    if (*text && (r->kind != WR_GUIDE_TEXT || !add_pictures(r->page, text)))
        add_cell(add(r->page, r->kind, r->level), text, strlen(text));
    wr_text_clear(&r->open);
}

static size_t trimmed(const char *text, size_t length)
{
    while (length > 0 && isspace((unsigned char)text[length - 1])) length--;
    return length;
}

/* | a | b |: a bar within `code` or after a backslash separates no cells. */
static void add_row(Reader *r, const char *line, size_t length)
{
    WrGuidePage *page = r->page;
    const WrGuideBlock *last =
        page->blocks.count ? &page->blocks.data[page->blocks.count - 1] : NULL;
    bool joined = !r->blank && last && last->kind == WR_GUIDE_ROW;
    if (joined && strspn(line, "|-: ") >= length) return; /* the line below the table head */
    WrGuideBlock *row = add(page, WR_GUIDE_ROW, joined ? 0 : 1);
    row->joined = joined;
    const char *end = line + length, *from = line + 1;
    bool code = false;
    for (const char *p = from; p <= end; p++) {
        if (p < end && *p == '`') code = !code;
        if (p < end && (*p != '|' || code || p[-1] == '\\')) continue;
        if (p == end && trimmed(from, (size_t)(p - from)) == 0) break;
        while (from < p && *from == ' ') from++;
        add_cell(row, from, trimmed(from, (size_t)(p - from)));
        from = p + 1;
    }
}

static void add_code(Reader *r, const char *line, size_t length)
{
    WrGuidePage *page = r->page;
    const WrGuideBlock *last =
        page->blocks.count ? &page->blocks.data[page->blocks.count - 1] : NULL;
    bool joined = last && last->kind == WR_GUIDE_CODE && !r->blank;
    WrGuideBlock *block = add(page, WR_GUIDE_CODE, 0);
    block->joined = joined;
    add_cell(block, line, length);
}

/* Length of an item's marker; 0: not an item. */
static size_t item_mark(const char *line, int *number)
{
    size_t digits = strspn(line, "0123456789");
    *number = 0;
    if (strncmp(line, "- ", 2) == 0) return 2;
    if (digits == 0 || digits > 3 || strncmp(line + digits, ". ", 2) != 0) return 0;
    for (size_t i = 0; i < digits; i++) *number = *number * 10 + (line[i] - '0');
    return digits + 2;
}

/* True if the line is a comment or part of one. */
static bool in_comment(Reader *r, const char *line, size_t length)
{
    char text[8] = "";
    bool begins = length >= 4 && strncmp(line, "<!--", 4) == 0;
    if (!begins && !r->comment) return false;
    snprintf(text, sizeof text, "%.*s", length >= 3 ? 3 : (int)length,
             line + length - (length >= 3 ? 3 : length));
    r->comment = strcmp(text, "-->") != 0;
    return true;
}

static void begin(Reader *r, WrGuideKind kind, int level, const char *text, size_t length)
{
    finish(r);
    r->kind = kind;
    r->level = level;
    wr_text_add_n(&r->open, text, length);
}

static void take_line(Reader *r, const char *line, size_t length)
{
    size_t indent = strspn(line, " "), marks = strspn(line, "#");
    int number;
    length = trimmed(line, length);
    if (in_comment(r, line, length)) return;
    if (length == 0) {
        finish(r);
    } else if (marks >= 1 && marks <= 3 && line[marks] == ' ') {
        finish(r);
        add_cell(add(r->page, WR_GUIDE_HEADING, (int)marks), line + marks + 1, length - marks - 1);
    } else if (line[0] == '|') {
        finish(r);
        add_row(r, line, length);
    } else if (indent >= 4 && r->open.length == 0) {
        add_code(r, line + 4, length - 4);
    } else if (item_mark(line + indent, &number)) {
        size_t skip = indent + item_mark(line + indent, &number);
        begin(r, WR_GUIDE_ITEM, number, line + skip, length - skip);
    } else if (r->open.length > 0) {
        wr_text_add(&r->open, " ");
        wr_text_add_n(&r->open, line + indent, length - indent);
    } else {
        begin(r, WR_GUIDE_TEXT, 0, line + indent, length - indent);
    }
    r->blank = length == 0;
}

void wr_guide_parse(WrGuidePage *page, const char *name, const char *text)
{
    Reader reader = { .page = page, .blank = true };
    *page = (WrGuidePage){ .name = wr_strdup(name) };
    for (const char *p = text; *p;) {
        size_t length = strcspn(p, "\n");
        char *line = wr_strndup(p, length);
        take_line(&reader, line, length);
        wr_free(line);
        p += length + (p[length] == '\n');
    }
    finish(&reader);
    wr_text_fini(&reader.open);
    for (int i = 0; i < page->blocks.count && !page->title; i++)
        if (page->blocks.data[i].kind == WR_GUIDE_HEADING)
            page->title = wr_strdup(page->blocks.data[i].cell[0]);
    if (!page->title) page->title = wr_strdup(name);
}

void wr_guide_page_fini(WrGuidePage *page)
{
    for (int i = 0; i < page->blocks.count; i++)
        for (int k = 0; k < page->blocks.data[i].cells; k++) wr_free(page->blocks.data[i].cell[k]);
    wr_array_free(&page->blocks);
    wr_free(page->name);
    wr_free(page->title);
    *page = (WrGuidePage){ 0 };
}

/* ---- spans ---- */

/* `code`, *emphasis*, **strong**: position of the closing mark for the one at p, or NULL. */
static const char *closes(const char *p, const char *mark, size_t length)
{
    if (strncmp(p, mark, length) != 0 || p[length] == ' ' || !p[length]) return NULL;
    const char *end = strstr(p + length, mark);
    return end && end > p + length && end[-1] != ' ' ? end : NULL;
}

/* Parse [words](target), with an optional ! before. */
static bool link_at(const char *p, WrGuideSpan *span, const char **end)
{
    if (!(p[0] == '[' || (p[0] == '!' && p[1] == '['))) return false;
    const char *text = *p == '!' ? p + 2 : p + 1, *words = strchr(text, ']');
    const char *close = words && words[1] == '(' ? strchr(words, ')') : NULL;
    if (!close || words == text) return false;
    *span = (WrGuideSpan){ WR_GUIDE_LINK, text, (int)(words - text), words + 2,
                           (int)(close - words - 2) };
    *end = close + 1;
    return true;
}

static bool marked_at(const char *p, WrGuideSpan *span, const char **end)
{
    static const struct {
        const char *mark;
        WrGuideStyle style;
    } marks[] = { { "`", WR_GUIDE_LITERAL },
                  { "**", WR_GUIDE_STRONG },
                  { "*", WR_GUIDE_EMPHASIS } };
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        size_t length = strlen(marks[i].mark);
        const char *close = closes(p, marks[i].mark, length);
        if (!close) continue;
        *span = (WrGuideSpan){ marks[i].style, p + length, (int)(close - p - (ptrdiff_t)length),
                               NULL, 0 };
        *end = close + length;
        return true;
    }
    return link_at(p, span, end);
}

/* True for a backslash before a mark character. */
static bool is_escape(const char *p)
{
    return p[0] == '\\' && p[1] && strchr("|*<", p[1]);
}

bool wr_guide_span(const char **at, WrGuideSpan *span)
{
    const char *from = *at, *end;
    if (!*from) return false;
    if (is_escape(from)) { /* the character alone */
        *span = (WrGuideSpan){ WR_GUIDE_PLAIN, from + 1, 1, NULL, 0 };
        *at = from + 2;
        return true;
    }
    if (marked_at(from, span, &end)) {
        *at = end;
        return true;
    }
    const char *p = from + 1;
    WrGuideSpan next;
    while (*p && !is_escape(p) && !(strchr("`*[!", *p) && marked_at(p, &next, &end))) p++;
    *span = (WrGuideSpan){ WR_GUIDE_PLAIN, from, (int)(p - from), NULL, 0 };
    *at = p;
    return true;
}

char *wr_guide_plain(const WrGuideBlock *block, int cell, char *buffer, size_t size)
{
    size_t used = 0;
    const char *at = cell < block->cells ? block->cell[cell] : "";
    WrGuideSpan span;
    buffer[0] = '\0';
    if (block->kind == WR_GUIDE_CODE) {
        snprintf(buffer, size, "%s", at);
        return buffer;
    }
    while (used + 1 < size && wr_guide_span(&at, &span)) {
        int wrote = snprintf(buffer + used, size - used, "%.*s", span.length, span.text);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
    return buffer;
}

/* ---- search ---- */

#define BLOCK_WORDS 8192 /* searched bytes of a block */

/* Words of a block; of a row, those of all cells. */
static void words_of(const WrGuideBlock *block, char *out, size_t size)
{
    size_t used = 0;
    out[0] = '\0';
    int cells = block->kind == WR_GUIDE_PICTURE ? 1 : block->cells;
    for (int i = 0; i < cells && used + 2 < size; i++) {
        wr_guide_plain(block, i, out + used, size - used);
        used += strlen(out + used);
        if (used + 2 < size) out[used++] = ' ';
        out[used] = '\0';
    }
}

/* True if all words of the query are in the block, or some of them in it and the others in its heading. */
static bool answers(const WrGuideBlock *block, const WrGuideBlock *heading, const char *query)
{
    char words[BLOCK_WORDS] = "";
    size_t used = 0;
    if (heading && heading != block && wr_search_score(heading->cell[0], query) == 0) {
        wr_guide_plain(heading, 0, words, 256);
        used = strlen(words);
        words[used++] = ' ';
    }
    words_of(block, words + used, sizeof words - used);
    return wr_search_score(words, query) > 0;
}

/* Rank of a match: 0 headings, 1 blocks that start with the query (rows for a word), 2 others. */
static int rank_of(const WrGuideBlock *block, const char *query)
{
    char first[200];
    if (block->kind == WR_GUIDE_HEADING) return 0;
    wr_guide_plain(block, 0, first, sizeof first);
    return SDL_strncasecmp(first, query, strlen(query)) == 0 ? 1 : 2;
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

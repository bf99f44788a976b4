/* The guide in the window: its Markdown, its search, and every page. */
#include "test.h"

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"

#include "ui/help/guide_page.h"

#include <ctype.h>
#include <dirent.h>
#include <string.h>
#include <unistd.h>

#define FOLDER WR_SOURCE_DIR "/ui/guide/"

static const char *const sample = "# Title\n"
                                  "\n"
                                  "<!-- not seen -->\n"
                                  "A paragraph\n"
                                  "of two lines.\n"
                                  "- one\n"
                                  "  goes on\n"
                                  "2. two\n"
                                  "\n"
                                  "    wrinkle run a.wrinkle\n"
                                  "      more\n"
                                  "\n"
                                  "| head | `a|b` |\n"
                                  "| --- | --- |\n"
                                  "| x \\| y | z |\n"
                                  "\n"
                                  "![words](a.png) ![more](b.png)\n"
                                  "\n"
                                  "## Next\n";

static void a_page_is_read_into_blocks(void **state)
{
    (void)state;
    static const struct {
        WrGuideKind kind;
        int level, cells;
        bool joined;
        const char *first, *second;
    } want[] = { { WR_GUIDE_HEADING, 1, 1, false, "Title", NULL },
                 { WR_GUIDE_TEXT, 0, 1, false, "A paragraph of two lines.", NULL },
                 { WR_GUIDE_ITEM, 0, 1, false, "one goes on", NULL },
                 { WR_GUIDE_ITEM, 2, 1, false, "two", NULL },
                 { WR_GUIDE_CODE, 0, 1, false, "wrinkle run a.wrinkle", NULL },
                 { WR_GUIDE_CODE, 0, 1, true, "  more", NULL },
                 { WR_GUIDE_ROW, 1, 2, false, "head", "`a|b`" },
                 { WR_GUIDE_ROW, 0, 2, true, "x \\| y", "z" },
                 { WR_GUIDE_PICTURE, 0, 2, false, "words", "a.png" },
                 { WR_GUIDE_PICTURE, 0, 2, false, "more", "b.png" },
                 { WR_GUIDE_HEADING, 2, 1, false, "Next", NULL } };
    WrGuidePage page;
    char plain[40];
    wr_guide_parse(&page, "a.md", sample);
    assert_string_equal(page.title, "Title");
    assert_int_equal(page.blocks.count, sizeof want / sizeof *want);
    for (int i = 0; i < page.blocks.count; i++) {
        const WrGuideBlock *b = &page.blocks.data[i];
        assert_int_equal(b->kind, want[i].kind);
        assert_int_equal(b->level, want[i].level);
        assert_int_equal(b->cells, want[i].cells);
        assert_int_equal(b->joined, want[i].joined);
        assert_string_equal(b->cell[0], want[i].first);
        if (want[i].second) assert_string_equal(b->cell[1], want[i].second);
    }
    assert_string_equal(wr_guide_plain(&page.blocks.data[6], 1, plain, sizeof plain), "a|b");
    assert_string_equal(wr_guide_plain(&page.blocks.data[7], 0, plain, sizeof plain), "x | y");
    assert_string_equal(wr_guide_plain(&page.blocks.data[0], 0, plain, 4), "Tit");
    wr_guide_page_fini(&page);
}

static void spans_tell_code_emphasis_and_links(void **state)
{
    (void)state;
    static const struct {
        WrGuideStyle style;
        const char *text, *link;
    } want[] = { { WR_GUIDE_PLAIN, "a ", NULL },      { WR_GUIDE_LITERAL, "b*c*", NULL },
                 { WR_GUIDE_PLAIN, ", ", NULL },      { WR_GUIDE_EMPHASIS, "d", NULL },
                 { WR_GUIDE_PLAIN, " 2 * 3 ", NULL }, { WR_GUIDE_STRONG, "e f", NULL },
                 { WR_GUIDE_PLAIN, " [ ] ", NULL },   { WR_GUIDE_LINK, "g h", "i.md#j" },
                 { WR_GUIDE_PLAIN, " `open", NULL } };
    const char *at = "a `b*c*`, *d* 2 * 3 **e f** [ ] [g h](i.md#j) `open";
    WrGuideSpan span;
    for (size_t i = 0; i < sizeof want / sizeof *want; i++) {
        assert_true(wr_guide_span(&at, &span));
        assert_int_equal(span.style, want[i].style);
        assert_int_equal(span.length, strlen(want[i].text));
        assert_memory_equal(span.text, want[i].text, strlen(want[i].text));
        assert_int_equal(!span.link, !want[i].link);
        if (span.link) assert_memory_equal(span.link, want[i].link, (size_t)span.link_length);
    }
    assert_false(wr_guide_span(&at, &span));
}

static void a_search_finds_all_words_headings_first(void **state)
{
    (void)state;
    WrGuidePage pages[2];
    WrGuideFound found[8];
    wr_guide_parse(&pages[0], "a", "# One\n\nBricks of clay.\n\n| `bricks` | walls |\n");
    wr_guide_parse(&pages[1], "b", "# Bricks\n\nMore of stone.\n");
    assert_int_equal(wr_guide_search(pages, 2, "", found, 8), 0);
    assert_int_equal(wr_guide_search(pages, 2, "  ", found, 8), 0);
    assert_int_equal(wr_guide_search(pages, 2, "BRICKS", found, 8), 3);
    assert_int_equal(found[0].page, 1); /* the heading */
    assert_int_equal(found[1].page, 0);
    assert_int_equal(wr_guide_search(pages, 2, "clay bricks", found, 8), 1);
    assert_int_equal(wr_guide_search(pages, 2, "stone bricks", found, 8), 1); /* in the heading */
    assert_int_equal(found[0].block, 1);
    assert_int_equal(wr_guide_search(pages, 2, "stone clay", found, 8), 0);
    assert_int_equal(wr_guide_search(pages, 2, "bricks", found, 2), 2);
    for (int i = 0; i < 2; i++) wr_guide_page_fini(&pages[i]);
}

/* ---- the guide itself ---- */

static void read_page(const char *name, WrGuidePage *page)
{
    char path[600], *text;
    size_t length;
    WrError err;
    snprintf(path, sizeof path, FOLDER "%s", name);
    if (!wr_file_read(path, 4u << 20, &text, &length, &err)) fail_msg("%s", err.text);
    wr_guide_parse(page, name, text);
    wr_free(text);
}

/* Links refer to existing files and to headings in them. */
static bool has_heading(const char *name, const char *anchor)
{
    WrGuidePage page;
    bool found = false;
    read_page(name, &page);
    for (int i = 0; i < page.blocks.count && !found; i++) {
        char slug[200];
        size_t n = 0;
        if (page.blocks.data[i].kind != WR_GUIDE_HEADING) continue;
        for (const char *p = page.blocks.data[i].cell[0]; *p && n < 198; p++)
            if (*p == ' ' || *p == '-') slug[n++] = '-';
            else if (isalnum((unsigned char)*p) || *p == '_')
                slug[n++] = (char)tolower((unsigned char)*p);
        slug[n] = '\0';
        found = strcmp(slug, anchor) == 0;
    }
    wr_guide_page_fini(&page);
    return found;
}

static void check_link(const char *page, const char *link, int length)
{
    char target[400], path[700], *anchor;
    snprintf(target, sizeof target, "%.*s", length, link);
    if (strncmp(target, "http", 4) == 0) return;
    anchor = strchr(target, '#');
    if (anchor) *anchor++ = '\0';
    const char *name = target[0] ? target : page;
    snprintf(path, sizeof path, FOLDER "%s", name);
    if (access(path, R_OK) != 0) fail_msg("%s: %s is not there", page, name);
    if (anchor && !has_heading(name, anchor)) fail_msg("%s: %s has no #%s", page, name, anchor);
}

/* Letters available in the window's fonts: gui_imgui_fonts.cpp. Code may contain any script. */
static void check_letters(const char *page, const char *text)
{
    for (const unsigned char *p = (const unsigned char *)text; *p;) {
        unsigned c = *p, more = c < 0x80 ? 0 : c < 0xe0 ? 1 : c < 0xf0 ? 2 : 3;
        c = more == 0 ? c : c & (0x3fu >> more);
        for (p++; more > 0; more--) c = c << 6 | (*p++ & 0x3fu);
        bool known = c < 0x180 || (c >= 0x370 && c < 0x460) || (c >= 0x2010 && c <= 0x2027) ||
                     (c >= 0x2190 && c <= 0x2193) || c == 0x2212;
        if (!known) fail_msg("%s: U+%04X is not in the window's fonts: %s", page, c, text);
    }
}

static void check_page(const char *name)
{
    WrGuidePage page;
    read_page(name, &page);
    assert_true(page.blocks.count > 3);
    assert_int_equal(page.blocks.data[0].kind, WR_GUIDE_HEADING);
    assert_int_equal(page.blocks.data[0].level, 1);
    for (int i = 0; i < page.blocks.count; i++) {
        const WrGuideBlock *block = &page.blocks.data[i];
        if (block->kind == WR_GUIDE_PICTURE)
            check_link(name, block->cell[1], (int)strlen(block->cell[1]));
        for (int k = 0; k < block->cells && block->kind != WR_GUIDE_CODE; k++) {
            const char *at = block->cell[k];
            WrGuideSpan span;
            check_letters(name, at);
            while (wr_guide_span(&at, &span))
                if (span.link) check_link(name, span.link, span.link_length);
        }
    }
    wr_guide_page_fini(&page);
}

static void every_page_is_led_to_and_its_links_lead_somewhere(void **state)
{
    (void)state;
    WrGuidePage index;
    char all[4000] = "";
    read_page("README.md", &index);
    for (int i = 0; i < index.blocks.count; i++)
        for (int k = 0; k < index.blocks.data[i].cells; k++)
            strncat(all, index.blocks.data[i].cell[k], sizeof all - strlen(all) - 1);
    wr_guide_page_fini(&index);
    DIR *folder = opendir(FOLDER);
    assert_non_null(folder);
    int pages = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        char link[300], ending[16];
        if (strcmp(wr_path_ending(entry->d_name, ending), "md") != 0) continue;
        check_page(entry->d_name);
        pages++;
        snprintf(link, sizeof link, "](%s)", entry->d_name);
        if (strcmp(entry->d_name, "README.md") != 0 && !strstr(all, link))
            fail_msg("ui/guide/README.md does not lead to %s", entry->d_name);
    }
    closedir(folder);
    assert_true(pages > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_page_is_read_into_blocks),
        cmocka_unit_test(spans_tell_code_emphasis_and_links),
        cmocka_unit_test(a_search_finds_all_words_headings_first),
        cmocka_unit_test(every_page_is_led_to_and_its_links_lead_somewhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The guide in the window: its Markdown, its search, and every page. */
#include "test.h"

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"

#include "ui/panels/help/guide_page.h"

#include <ctype.h>
#include <dirent.h>
#include <string.h>
#include <unistd.h>

#define FOLDER WR_SOURCE_DIR "/ui/guide/"
#define INDEX "README.md"

static const char *const sample = "# Title\n"
                                  "\n"
                                  "<!-- not seen -->\n"
                                  "A paragraph\n"
                                  "of two lines.\n"
                                  "\n"
                                  "    wrinkle run a.wrinkle\n"
                                  "      more\n"
                                  "\n"
                                  "    other\n"
                                  "\n"
                                  "- one\n"
                                  "  goes on\n"
                                  "\n"
                                  "3. two\n"
                                  "   - within\n"
                                  "4. three\n"
                                  "\n"
                                  "| head | `a|b` |\n"
                                  "| --- | --- |\n"
                                  "| x \\| y | z |\n"
                                  "\n"
                                  "![words](a.png) ![](b.png)\n"
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
                 { WR_GUIDE_CODE, 0, 1, false, "wrinkle run a.wrinkle", NULL },
                 { WR_GUIDE_CODE, 0, 1, true, "  more", NULL },
                 { WR_GUIDE_CODE, 0, 1, false, "other", NULL },
                 { WR_GUIDE_ITEM, 0, 1, false, "one goes on", NULL },
                 { WR_GUIDE_ITEM, 3, 1, false, "two", NULL },
                 { WR_GUIDE_ITEM, 0, 1, false, "within", NULL },
                 { WR_GUIDE_ITEM, 4, 1, false, "three", NULL },
                 { WR_GUIDE_ROW, 1, 2, false, "head", "a|b" },
                 { WR_GUIDE_ROW, 0, 2, true, "x | y", "z" },
                 { WR_GUIDE_PICTURE, 0, 1, false, "words", NULL },
                 { WR_GUIDE_PICTURE, 0, 1, false, "", NULL },
                 { WR_GUIDE_HEADING, 2, 1, false, "Next", NULL } };
    WrGuidePage page;
    wr_guide_parse(&page, "a.md", sample);
    assert_string_equal(page.title, "Title");
    assert_int_equal(page.blocks.count, sizeof want / sizeof *want);
    for (int i = 0; i < page.blocks.count; i++) {
        const WrGuideBlock *b = &page.blocks.data[i];
        assert_int_equal(b->kind, want[i].kind);
        assert_int_equal(b->level, want[i].level);
        assert_int_equal(b->cells.count, want[i].cells);
        assert_int_equal(b->joined, want[i].joined);
        assert_string_equal(wr_guide_words(b, 0), want[i].first);
        assert_string_equal(wr_guide_words(b, 1), want[i].second ? want[i].second : "");
        if (b->kind == WR_GUIDE_PICTURE)
            assert_string_equal(b->cells.data[0].spans.data[0].link,
                                *want[i].first ? "a.png" : "b.png");
    }
    wr_guide_page_fini(&page);
}

static void spans_tell_code_emphasis_and_links(void **state)
{
    (void)state;
    static const struct {
        WrGuideStyle style;
        const char *text, *link;
    } want[] = { { WR_GUIDE_PLAIN, "a ", NULL },
                 { WR_GUIDE_LITERAL, "b*c*", NULL },
                 { WR_GUIDE_PLAIN, ", ", NULL },
                 { WR_GUIDE_EMPHASIS, "d", NULL },
                 { WR_GUIDE_PLAIN, " 2 * 3 ", NULL },
                 { WR_GUIDE_STRONG, "e f", NULL },
                 { WR_GUIDE_PLAIN, " [ ] ", NULL },
                 { WR_GUIDE_PLAIN, "g ", "i.md#j" },
                 { WR_GUIDE_LITERAL, "h", "i.md#j" },
                 { WR_GUIDE_PLAIN, " *< & \xc3\xa9 &other; more `open", NULL } };
    WrGuidePage page;
    wr_guide_parse(&page, "a.md",
                   "a `b*c*`, *d* 2 * 3 **e f** [ ] [g `h`](i.md#j) \\*&lt; <b>&amp;</b> &#xe9; "
                   "&other;\nmore `open");
    assert_int_equal(page.blocks.count, 1);
    const WrGuideCell *cell = &page.blocks.data[0].cells.data[0];
    const char *at = cell->text.data;
    assert_int_equal(cell->spans.count, sizeof want / sizeof *want);
    for (int i = 0; i < cell->spans.count; i++) {
        const WrGuideSpan *span = &cell->spans.data[i];
        assert_int_equal(span->style, want[i].style);
        assert_int_equal(span->length, strlen(want[i].text));
        assert_memory_equal(at, want[i].text, strlen(want[i].text));
        assert_int_equal(!span->link, !want[i].link);
        if (span->link) assert_string_equal(span->link, want[i].link);
        at += span->length;
    }
    assert_string_equal(at, "");
    wr_guide_page_fini(&page);
}

static void a_search_finds_all_words_headings_first(void **state)
{
    (void)state;
    WrGuidePage pages[2];
    WrGuideFound found[8];
    wr_guide_parse(&pages[0], "a",
                   "# One\n\nBricks of clay.\n\n| `bricks` | walls |\n| --- | --- |\n");
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
        for (const char *p = wr_guide_words(&page.blocks.data[i], 0); *p && n < 198; p++)
            if (*p == ' ' || *p == '-') slug[n++] = '-';
            else if (isalnum((unsigned char)*p) || *p == '_')
                slug[n++] = (char)tolower((unsigned char)*p);
        slug[n] = '\0';
        found = strcmp(slug, anchor) == 0;
    }
    wr_guide_page_fini(&page);
    return found;
}

static void check_link(const char *page, const char *link)
{
    char target[400], path[700], *anchor;
    snprintf(target, sizeof target, "%s", link);
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
        for (int k = 0; k < block->cells.count && block->kind != WR_GUIDE_CODE; k++) {
            const WrGuideCell *cell = &block->cells.data[k];
            check_letters(name, wr_guide_words(block, k));
            for (int j = 0; j < cell->spans.count; j++)
                if (cell->spans.data[j].link) check_link(name, cell->spans.data[j].link);
        }
    }
    wr_guide_page_fini(&page);
}

static bool leads_to(const WrGuidePage *index, const char *name)
{
    for (int i = 0; i < index->blocks.count; i++)
        for (int k = 0; k < index->blocks.data[i].cells.count; k++) {
            const WrGuideCell *cell = &index->blocks.data[i].cells.data[k];
            for (int j = 0; j < cell->spans.count; j++)
                if (cell->spans.data[j].link && strcmp(cell->spans.data[j].link, name) == 0)
                    return true;
        }
    return false;
}

static void every_page_is_led_to_and_its_links_lead_somewhere(void **state)
{
    (void)state;
    WrGuidePage index;
    read_page(INDEX, &index);
    DIR *folder = opendir(FOLDER);
    assert_non_null(folder);
    int pages = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        char ending[16];
        if (strcmp(wr_path_ending(entry->d_name, ending), "md") != 0) continue;
        check_page(entry->d_name);
        pages++;
        if (strcmp(entry->d_name, INDEX) != 0 && !leads_to(&index, entry->d_name))
            fail_msg("ui/guide/" INDEX " does not lead to %s", entry->d_name);
    }
    wr_guide_page_fini(&index);
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

#include "ui/panels/help/guide.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/messages.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_page.h"
#include "ui/toolkit/theme.h"
#include "ui/panels/help/guide_flow.h"
#include "ui/panels/help/guide_page.h"
#include "ui/app/state/background_command.h"
#include "ui/toolkit/words.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/session.h"
#include "document/document.h"
#include "system/path.h"

#include <SDL.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FOLDER "ui/guide/"
#define INDEX "README.md" /* its links define the pages and their order */
#define PAGE_BYTES (4u << 20)
#define FOUND_MAX 80
#define COLUMN 250 /* width of the page list in units */

struct WrGuide {
    WR_ARRAY(WrGuidePage) pages;
    WR_ARRAY(double) scrolls; /* scroll position of each page, pixels */
    int page;                 /* index of the open page */
    int marked;               /* highlighted block; -1: none */
    int jump;                 /* block to scroll to; -1: none */
    bool opened;              /* another page was opened: restore its scroll position */
    bool focus;               /* give the keyboard focus to the search field */
    char query[80], asked[80];
    WrGuideFound found[FOUND_MAX];
    int found_count, chosen;
    WrGuideLayout layout;
    WrGuidePictures *pictures;
    WrGuiPage field; /* as the page was drawn last */
    char *proposed;  /* a command whose effect is shown before it runs; owned; NULL: none */
};

/* ---- pages ---- */

static void add_page(WrGuide *guide, const char *name, const char *text)
{
    WrGuidePage page;
    wr_guide_parse(&page, name, text);
    for (int i = 0; i < page.blocks.count; i++)
        page.blocks.data[i].command = page.blocks.data[i].kind == WR_GUIDE_CODE &&
                                      wr_guide_is_command(wr_guide_words(&page.blocks.data[i], 0));
    wr_array_push(&guide->pages, page);
    wr_array_push(&guide->scrolls, 0.0);
}

static bool read_page(WrGuide *guide, const char *name, WrError *err)
{
    WrText place = { 0 };
    char path[300], *text;
    size_t length;
    snprintf(path, sizeof path, FOLDER "%.200s", name);
    bool good =
        wr_data_find(path, &place)
            ? wr_file_read(wr_text_get(&place), PAGE_BYTES, &text, &length, err)
            : wr_fail(err, "%s was not found beside the program: set WRINKLE_DATA to its folder",
                      path);
    wr_text_fini(&place);
    if (!good) return false;
    add_page(guide, name, text);
    wr_free(text);
    return true;
}

static int find_page(const WrGuide *guide, const char *name, size_t length)
{
    for (int i = 0; i < guide->pages.count; i++)
        if (strlen(guide->pages.data[i].name) == length &&
            strncmp(guide->pages.data[i].name, name, length) == 0)
            return i;
    return -1;
}

static void read_links(WrGuide *guide, const WrGuideCell *cell)
{
    WrError err;
    for (int i = 0; i < cell->spans.count; i++) {
        const char *link = cell->spans.data[i].link;
        if (!link || strchr(link, '/') || find_page(guide, link, strlen(link)) >= 0) continue;
        if (!read_page(guide, link, &err)) add_page(guide, link, err.text);
    }
}

/* Read every page linked from the index. A missing page becomes a page with a note. */
static void read_linked(WrGuide *guide, int index)
{
    for (int i = 0; i < guide->pages.data[index].blocks.count; i++) {
        const WrGuideBlock *block = &guide->pages.data[index].blocks.data[i];
        for (int k = 0; k < block->cells.count; k++) read_links(guide, &block->cells.data[k]);
    }
}

static WrGuide *guide_of(WrApp *app)
{
    if (app->guide) return app->guide;
    WrGuide *guide = wr_alloc(1, sizeof *guide);
    WrError err;
    guide->marked = guide->jump = -1;
    guide->pictures = wr_guide_pictures_new(app->renderer, app->job_event);
    add_page(guide, "", ""); /* the page of keys */
    if (read_page(guide, INDEX, &err)) read_linked(guide, guide->pages.count - 1);
    else add_page(guide, INDEX, err.text);
    return app->guide = guide;
}

void wr_guide_free(WrApp *app)
{
    WrGuide *guide = app->guide;
    if (!guide) return;
    for (int i = 0; i < guide->pages.count; i++) wr_guide_page_fini(&guide->pages.data[i]);
    wr_array_free(&guide->pages);
    wr_array_free(&guide->scrolls);
    wr_guide_layout_fini(&guide->layout);
    wr_guide_pictures_free(guide->pictures);
    wr_free(guide->proposed);
    wr_free(guide);
    app->guide = NULL;
}

/* Update the page of keys, which may have changed. */
static void refresh_keys(WrApp *app, WrGuide *guide)
{
    WrText text = { 0 };
    wr_guide_keys(app, &text);
    wr_guide_page_fini(&guide->pages.data[0]);
    wr_guide_parse(&guide->pages.data[0], "keys", wr_text_get(&text));
    wr_text_fini(&text);
    guide->layout.page = NULL;
}

static void open_page(WrApp *app, WrGuide *guide, int page, int block)
{
    guide->opened = page != guide->page || block >= 0;
    guide->page = page;
    guide->jump = guide->marked = block;
    guide->focus = true;
    wr_app_redraw(app);
}

/* ---- links ---- */

/* True if the heading "Files and exports" matches the anchor #files-and-exports. */
static bool heading_is(const char *heading, const char *anchor)
{
    for (const char *p = heading; *p; p++) {
        char c = *p == ' ' ? '-' : (char)tolower((unsigned char)*p);
        if (c != '-' && c != '_' && !isalnum((unsigned char)c) && (unsigned char)c < 0x80) continue;
        if (*anchor++ != c) return false;
    }
    return !*anchor;
}

static void follow(WrApp *app, WrGuide *guide, const char *link)
{
    const char *anchor = strchr(link, '#');
    size_t name = strcspn(link, "#");
    int page = name == 0 ? guide->page : find_page(guide, link, name), block = -1;
    if (page < 0) {
        wr_app_say(app, "%s: a file that comes with the program", link);
        return;
    }
    const WrGuidePage *target = &guide->pages.data[page];
    for (int i = 0; anchor && i < target->blocks.count && block < 0; i++)
        if (target->blocks.data[i].kind == WR_GUIDE_HEADING &&
            heading_is(wr_guide_words(&target->blocks.data[i], 0), anchor + 1))
            block = i;
    open_page(app, guide, page, block);
}

void wr_guide_headings(WrApp *app,
                       void (*each)(void *ctx, const char *page, const char *title,
                                    const char *heading),
                       void *ctx)
{
    const WrGuide *guide = guide_of(app);
    for (int i = 0; i < guide->pages.count; i++) {
        const WrGuidePage *page = &guide->pages.data[i];
        if (page->name[0] && page->title) each(ctx, page->name, page->title, NULL);
        for (int k = 1; k < page->blocks.count; k++)
            if (page->blocks.data[k].kind == WR_GUIDE_HEADING && page->name[0])
                each(ctx, page->name, page->title, wr_guide_words(&page->blocks.data[k], 0));
    }
}

void wr_guide_open(WrApp *app, const char *place)
{
    WrGuide *guide = guide_of(app);
    const size_t name = strcspn(place, "#");
    const int page = find_page(guide, place, name);
    int block = -1;
    if (page < 0) return;
    for (int i = 0; i < guide->pages.data[page].blocks.count && block < 0; i++)
        if (guide->pages.data[page].blocks.data[i].kind == WR_GUIDE_HEADING &&
            strcmp(wr_guide_words(&guide->pages.data[page].blocks.data[i], 0), place + name + 1) ==
                0)
            block = i;
    wr_dialog_open(app, WR_DIALOG_HELP);
    open_page(app, guide, page, block);
}

/* ---- running ---- */

#define PROPOSAL 85 /* units of its place below the page */

const char *wr_guide_proposed(const WrApp *app)
{
    return app->guide ? app->guide->proposed : NULL;
}

static void propose(WrApp *app, WrGuide *guide, const char *line)
{
    wr_app_redraw(app);
    if (guide->proposed && strcmp(guide->proposed, line) == 0) return;
    wr_free(guide->proposed);
    guide->proposed = wr_strdup(line);
}

/* Whether a link is that of a command; then its effect is shown. */
static bool take_command(WrApp *app, WrGuide *guide, const char *link)
{
    const WrGuidePage *page = &guide->pages.data[guide->page];
    for (int i = 0; i < page->blocks.count; i++)
        if (page->blocks.data[i].command && wr_guide_words(&page->blocks.data[i], 0) == link) {
            propose(app, guide, link);
            return true;
        }
    return false;
}

/* Let the keys reach the word Run of each command. The first press shows the effect; a second one, which returns true,
   runs the command. */
static bool take_keys(WrApp *app, WrGuide *guide)
{
    bool again = false;
    const WrGuidePage *page = &guide->pages.data[guide->page];
    const double w = wr_gui_text_width(WR_FONT_TEXT, "Run"), h = wr_gui_line_height(WR_FONT_TEXT);
    for (int i = 0; i < page->blocks.count && i < guide->layout.places.count; i++) {
        double x, y;
        if (!page->blocks.data[i].command) continue;
        wr_guide_run_at(&guide->layout, &guide->field, i, &x, &y);
        if (!wr_gui_page_stop(i, x - w / 2, y - h / 2, w, h)) continue;
        const char *line = wr_guide_words(&page->blocks.data[i], 0);
        again = guide->proposed && strcmp(guide->proposed, line) == 0;
        propose(app, guide, line);
    }
    return again;
}

bool wr_guide_run_place(const WrApp *app, const char *line, int *x, int *y)
{
    const WrGuide *guide = app->guide;
    const WrGuidePage *page = guide ? guide->layout.page : NULL;
    for (int i = 0; page && i < page->blocks.count; i++) {
        double at_x, at_y;
        const WrGuideBlock *block = &page->blocks.data[i];
        if (!block->command || strcmp(wr_guide_words(block, 0), line) != 0) continue;
        wr_guide_run_at(&guide->layout, &guide->field, i, &at_x, &at_y);
        if (at_y < guide->field.top || at_y >= guide->field.bottom) continue;
        *x = (int)at_x;
        *y = (int)at_y;
        return true;
    }
    return false;
}

/* What the command would change, and the buttons that run it or not. agreed: its Run was pressed again. */
static void show_proposal(WrApp *app, WrGuide *guide, bool agreed)
{
    WrText effect = { 0 };
    wr_guide_effect(app, guide->proposed, &effect);
    wr_gui_as_it_is(true);
    wr_gui_text_wrapped(WR_FONT_BOLD, WR_COLOUR_STRONG, guide->proposed);
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, wr_text_get(&effect));
    wr_gui_as_it_is(false);
    wr_text_fini(&effect);
    const bool run = wr_gui_button("Run", true) || wr_gui_return_pressed() || agreed;
    wr_gui_same_line(8);
    const bool cancel = wr_gui_button("Cancel", false) || wr_gui_escape_pressed();
    if (!run && !cancel) return;
    if (run) wr_app_run_slow(app, guide->proposed);
    wr_free(guide->proposed);
    guide->proposed = NULL;
    wr_app_redraw(app);
}

/* ---- search ---- */

static void choose(WrApp *app, WrGuide *guide, int chosen)
{
    if (guide->found_count == 0) return;
    guide->chosen = chosen < 0 ? 0 : chosen >= guide->found_count ? guide->found_count - 1 : chosen;
    open_page(app, guide, guide->found[guide->chosen].page, guide->found[guide->chosen].block);
}

static void search(WrApp *app, WrGuide *guide)
{
    wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, WR_ICON_SEARCH);
    wr_gui_same_line(8);
    wr_gui_text_field("##guide", 0, guide->query, sizeof guide->query,
                      app->dialog->fresh || (guide->focus && !guide->query[0]));
    guide->focus = false;
    if (strcmp(guide->query, guide->asked) != 0) {
        memcpy(guide->asked, guide->query, sizeof guide->asked);
        guide->found_count = wr_guide_search(guide->pages.data, guide->pages.count, guide->query,
                                             guide->found, FOUND_MAX);
        guide->marked = -1;
        choose(app, guide, 0);
    }
    if (guide->query[0] && wr_gui_key_pressed(SDL_SCANCODE_DOWN))
        choose(app, guide, guide->chosen + 1);
    if (guide->query[0] && wr_gui_key_pressed(SDL_SCANCODE_UP))
        choose(app, guide, guide->chosen - 1);
}

static void list_found(WrApp *app, WrGuide *guide)
{
    char words[400];
    if (guide->found_count == 0)
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, "No page has these words.");
    for (int i = 0; i < guide->found_count; i++) {
        const WrGuidePage *page = &guide->pages.data[guide->found[i].page];
        const WrGuideBlock *block = &page->blocks.data[guide->found[i].block];
        snprintf(words, sizeof words, "%.119s%s%s", wr_guide_words(block, 0),
                 block->cells.count > 1 ? "   " : "", wr_guide_words(block, 1));
        WrRow row = wr_gui_row_begin(i, 46, i == guide->chosen);
        wr_gui_row_set_cursor(wr_gui_px(8), wr_gui_px(40));
        wr_gui_group_begin();
        wr_gui_as_it_is(true);
        wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_TEXT, words, wr_gui_row_width() - wr_gui_px(12));
        wr_gui_as_it_is(false);
        wr_gui_space(-10);
        wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_LABEL, page->title,
                        wr_gui_row_width() - wr_gui_px(12));
        wr_gui_group_end();
        wr_gui_row_end();
        if (row.clicked) choose(app, guide, i);
    }
}

static void list_pages(WrApp *app, WrGuide *guide)
{
    for (int i = 0; i < guide->pages.count; i++) {
        WrRow row = wr_gui_row_begin(i, 26, i == guide->page);
        wr_gui_row_set_cursor(wr_gui_px(8), 0);
        wr_gui_text_cut(WR_FONT_TEXT, WR_COLOUR_TEXT, guide->pages.data[i].title,
                        wr_gui_row_width() - wr_gui_px(12));
        wr_gui_row_end();
        if (row.clicked) open_page(app, guide, i, -1);
    }
}

/* ---- the page ---- */

/* Scroll position requested by keys, a link or the search; below 0: none. */
static double scroll_to(WrGuide *guide, const WrGuiPage *field)
{
    double page = field->bottom - field->top, to = -1;
    if (wr_gui_key_pressed(SDL_SCANCODE_PAGEDOWN)) to = field->scroll + 0.9 * page;
    if (wr_gui_key_pressed(SDL_SCANCODE_PAGEUP)) to = fmax(0, field->scroll - 0.9 * page);
    if (!guide->query[0] && wr_gui_key_pressed(SDL_SCANCODE_DOWN))
        to = field->scroll + wr_gui_px(40);
    if (!guide->query[0] && wr_gui_key_pressed(SDL_SCANCODE_UP))
        to = fmax(0, field->scroll - wr_gui_px(40));
    if (guide->opened) to = guide->scrolls.data[guide->page];
    if (guide->jump >= 0 && guide->jump < guide->layout.places.count)
        to = fmax(0, guide->layout.places.data[guide->jump].y - 0.2 * page);
    return to;
}

/* True if the proposed command was chosen again by keys. */
static bool show_page(WrApp *app, WrGuide *guide, double tall)
{
    WrGuiPage field = wr_gui_page_begin("page", 0, tall);
    guide->field = field;
    const WrGuidePage *page = &guide->pages.data[guide->page];
    wr_gui_as_it_is(true); /* the page of keys is translated, the others are English */
    if (wr_guide_layout(&guide->layout, page, field.w, guide->pictures)) wr_app_redraw(app);
    const char *link = wr_guide_draw(&guide->layout, &field, guide->marked, guide->pictures);
    wr_gui_as_it_is(false);
    const bool again = take_keys(app, guide);
    double to = scroll_to(guide, &field);
    guide->scrolls.data[guide->page] = to >= 0 ? to : field.scroll;
    guide->opened = false;
    guide->jump = -1;
    wr_gui_page_end(guide->layout.height, to);
    if (to >= 0) wr_app_redraw(app);
    if (link && field.clicked && !take_command(app, guide, link)) follow(app, guide, link);
    return again;
}

/* Content of the dialog: search, list of pages and the open page, with that height in pixels. */
static void guide_show(WrApp *app, double tall)
{
    WrGuide *guide = guide_of(app);
    if (app->dialog->fresh) refresh_keys(app, guide);
    guide->opened = guide->opened || app->dialog->fresh;
    if (app->dialog->fresh) wr_free(guide->proposed), guide->proposed = NULL;
    search(app, guide);
    if (guide->proposed) tall -= wr_gui_px(PROPOSAL);
    double wide = fmin(wr_gui_px(COLUMN), 0.34 * wr_gui_available());
    wr_gui_column_begin("pages", wide, tall);
    if (guide->query[0]) list_found(app, guide);
    else list_pages(app, guide);
    wr_gui_list_end();
    wr_gui_same_line(8);
    const bool asked = guide->proposed != NULL; /* before this press: its place is there */
    const bool again = show_page(app, guide, tall);
    if (asked && guide->proposed) show_proposal(app, guide, again);
}

/* ---- running of examples ---- */

bool wr_guide_is_command(const char *line)
{
    WrCall *call = NULL;
    WrError err;
    const bool good = wr_call_parse(line, false, &call, &err) && call->command;
    wr_call_free(call);
    return good;
}

/* Absolute path of the file that an output command writes; NULL if it names none. Caller frees. */
static char *written_file(const WrCall *call)
{
    for (int i = 0; i < call->count; i++) {
        if (call->specs[i].type != WR_ARG_PATH || !call->args[i].given) continue;
        char *folder = wr_path_here();
        char *path = wr_path_join(folder ? folder : "", call->args[i].text);
        free(folder);
        return path;
    }
    return NULL;
}

static void add_output(const WrCall *call, WrText *out)
{
    char *path = written_file(call);
    if (!path) wr_text_add(out, wr_words("Writes files."));
    else if (wr_path_is_there(path))
        wr_text_addf(out, wr_words("Replaces the file %s. Undo does not bring it back."), path);
    else wr_text_addf(out, wr_words("Writes the file %s."), path);
    wr_free(path);
}

void wr_guide_effect(const WrApp *app, const char *line, WrText *out)
{
    const WrDocument *document = wr_session_document(app->session);
    WrCall *call = NULL;
    WrError err;
    if (!wr_call_parse(line, false, &call, &err) || !call->command) {
        wr_call_free(call);
        return;
    }
    switch (wr_call_class(call)) {
    case WR_CLASS_EDIT:
        wr_text_addf(out,
                     wr_words("Changes layers, heights or the selection; the active layer is %s. "
                              "One undo step."),
                     document->layers[document->active].name);
        break;
    case WR_CLASS_SCENE:
        wr_text_add(out, wr_words("Changes the scene and no heights. One undo step."));
        break;
    case WR_CLASS_VIEW:
        wr_text_add(out, wr_words("Changes the view, no heights. No undo step."));
        break;
    case WR_CLASS_CHOICE:
        wr_text_add(out, wr_words("Chooses the layer of later edits. No undo step."));
        break;
    case WR_CLASS_OUTPUT: add_output(call, out); break;
    default: wr_text_add(out, wr_words("Goes to another step of the history.")); break;
    }
    wr_call_free(call);
}

/* ---- dialogs of the guide and of information about the program ---- */

static void about(void)
{
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT,
                        "Paint bump functions and watch them wrinkle a surface, after James F. "
                        "Blinn, Simulation of Wrinkled Surfaces, 1978.");
}

void wr_dialog_help(WrApp *app)
{
    bool only_about = app->dialog->now == WR_DIALOG_ABOUT;
    if (!wr_gui_dialog_begin(only_about ? "Wrinkle" : "Guide", only_about ? 440 : 1060)) return;
    const bool asks = !only_about && wr_guide_proposed(app); /* its keys are Run and Cancel */
    if (only_about) about();
    else guide_show(app, fmax(0.92 * app->height - wr_gui_px(180), wr_gui_px(120)));
    wr_gui_space(8);
    bool leave = wr_gui_button("Close", true);
    if (!app->dialog->fresh && !asks && (wr_gui_escape_pressed() || wr_gui_return_pressed()))
        leave = true;
    if (leave) wr_dialog_close(app);
    wr_gui_dialog_end();
}

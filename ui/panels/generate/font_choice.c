#include "ui/panels/generate/font_choice.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/search_score.h"
#include "ui/app/state/settings.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/gui_sdl_renderer.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/job.h"
#include "ui/app/jobs/edit_preview.h"

#include "base/array.h"
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "command/command_line.h"
#include "document/document.h"
#include "field/field.h"
#include "generate/generator.h"
#include "image/font.h"
#include "image/font_list.h"

#include <SDL.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROW 30.0
#define SAMPLE 180.0 /* width of a font sample in units */
#define WIDE 450.0
#define TALL 420.0
#define PAGE 10 /* rows */
#define BATCH 6 /* samples rendered in one job */

typedef struct Row {
    WrFontEntry entry; /* owned; for a built-in name only the family */
    const char *named; /* from wr_font_names; NULL: an installed font */
    SDL_Texture *texture;
    bool asked, failed;
} Row;

/* A shown row of the list, with an optional heading above. */
typedef struct Shown {
    int row;
    const char *heading; /* NULL: none */
} Shown;

typedef struct Item {
    int row;
    const char *named;
    WrFontEntry entry; /* owned */
    uint32_t *argb;    /* owned; NULL: unreadable font */
} Item;

typedef struct Work {
    bool lists; /* list the fonts; else render samples */
    WrFontList fonts;
    WrError err;
    int w, h, round, count;
    Item items[BATCH];
} Work;

struct WrFontChoice {
    WrJob *job;
    WR_ARRAY(Row) rows;
    WR_ARRAY(Shown) shown;
    bool asked, listed; /* the font list was requested, is ready */
    bool stale;         /* `shown` does not match the typed text */
    WrError err;
    int w, h, round; /* of the samples: size in pixels, and number of restarts */
    char filter[64];
    int chosen;       /* index into `shown` */
    bool fresh, jump; /* just opened; scroll to the chosen one */
    WR_ARRAY(int) wishes;
};

/* ---- on the worker thread ---- */

static void drop(void *arg)
{
    Work *work = arg;
    for (int i = 0; i < work->count; i++) {
        wr_font_entry_fini(&work->items[i].entry);
        wr_free(work->items[i].argb);
    }
    wr_font_list_fini(&work->fonts);
    wr_free(work);
}

static void run(void *arg, WrPool *pool, const WrProgress *progress)
{
    Work *work = arg;
    if (work->lists) wr_font_list(&work->fonts, &work->err);
    for (int i = 0; i < work->count && !wr_progress_cancelled(progress); i++) {
        Item *item = &work->items[i];
        const WrFontSample sample = { item->named, &item->entry, work->w, work->h };
        item->argb = wr_alloc((size_t)work->w * (size_t)work->h, sizeof *item->argb);
        if (wr_font_sample(&sample, pool, progress, item->argb)) continue;
        wr_free(item->argb);
        item->argb = NULL;
    }
}

/* ---- on the window's thread ---- */

static void add_named(WrFontChoice *choice)
{
    for (int i = 0; i < WR_FONT_FAMILY_COUNT; i++) {
        Row row = { .named = wr_font_names[i], .entry.family = wr_strdup(wr_font_names[i]) };
        wr_array_push(&choice->rows, row);
    }
}

static WrFontChoice *choice_of(WrApp *app)
{
    static const WrJobKind kind = { run, drop };
    if (app->generate->fonts) return app->generate->fonts;
    WrFontChoice *choice = wr_alloc(1, sizeof *choice);
    choice->job = wr_job_new(&kind, 1, app->job_event);
    add_named(choice);
    choice->stale = true;
    return app->generate->fonts = choice;
}

static void forget(WrApp *app)
{
    WrFontChoice *choice = app->generate->fonts;
    if (!choice) return;
    choice->round++;
    for (int i = 0; i < choice->rows.count; i++) {
        Row *row = &choice->rows.data[i];
        if (row->texture) SDL_DestroyTexture(row->texture);
        row->texture = NULL;
        row->asked = row->failed = false;
    }
}

void wr_font_choice_free(WrApp *app)
{
    WrFontChoice *choice = app->generate ? app->generate->fonts : NULL;
    if (!choice) return;
    forget(app);
    wr_job_free(choice->job);
    for (int i = 0; i < choice->rows.count; i++) wr_font_entry_fini(&choice->rows.data[i].entry);
    wr_array_free(&choice->rows);
    wr_array_free(&choice->shown);
    wr_array_free(&choice->wishes);
    wr_free(choice);
    app->generate->fonts = NULL;
}

static void take_list(WrFontChoice *choice, Work *work)
{
    for (int i = 0; i < work->fonts.count; i++) {
        Row row = { .entry = work->fonts.data[i] };
        wr_array_push(&choice->rows, row);
    }
    wr_array_free(&work->fonts); /* its entries were moved to the rows */
    choice->err = work->err;
    choice->listed = choice->stale = true;
}

static void take_samples(WrApp *app, WrFontChoice *choice, const Work *work)
{
    for (int i = 0; i < work->count && work->round == choice->round; i++) {
        const Item *item = &work->items[i];
        Row *row = &choice->rows.data[item->row];
        row->failed = !item->argb;
        if (!item->argb) continue;
        row->texture = SDL_CreateTexture(app->renderer, SDL_PIXELFORMAT_ARGB8888,
                                         SDL_TEXTUREACCESS_STATIC, work->w, work->h);
        if (!row->texture) continue;
        SDL_SetTextureBlendMode(row->texture, SDL_BLENDMODE_BLEND);
        wr_gui_sdl_update(row->texture, NULL, item->argb, work->w * 4);
    }
}

static char *copy_of(const char *text)
{
    return text ? wr_strdup(text) : NULL;
}

static void ask_samples(WrFontChoice *choice)
{
    Work *work = wr_alloc(1, sizeof *work);
    work->w = choice->w;
    work->h = choice->h;
    work->round = choice->round;
    for (int i = 0; i < choice->wishes.count && work->count < BATCH; i++) {
        Row *row = &choice->rows.data[choice->wishes.data[i]];
        if (row->asked) continue;
        row->asked = true;
        work->items[work->count++] = (Item){ .row = choice->wishes.data[i],
                                             .named = row->named,
                                             .entry = { .sample = copy_of(row->entry.sample),
                                                        .path = copy_of(row->entry.path),
                                                        .face = row->entry.face } };
    }
    wr_job_start(choice->job, work);
}

/* Continue once per frame while the list is open, after its rows were drawn. */
static void go_on(WrApp *app, WrFontChoice *choice)
{
    Work *work = wr_job_take(choice->job);
    if (work && work->lists) take_list(choice, work);
    else if (work) take_samples(app, choice, work);
    if (work) {
        drop(work);
        wr_app_redraw(app);
    }
    if (wr_job_busy(choice->job, NULL, NULL)) return;
    if (!choice->asked) {
        work = wr_alloc(1, sizeof *work);
        work->lists = choice->asked = true;
        wr_job_start(choice->job, work);
    } else if (choice->wishes.count > 0) {
        ask_samples(choice);
    }
    choice->wishes.count = 0;
}

/* ---- filter ---- */

static bool is_kept(const Row *row, const char *kept)
{
    char *path = NULL;
    if (row->named) return strcmp(row->named, kept) == 0;
    const long face = strtol(kept, &path, 10);
    return path != kept && *path == ' ' && face == row->entry.face &&
           strcmp(path + 1, row->entry.path) == 0;
}

static void show(WrFontChoice *choice, int row, const char *heading)
{
    const int count = choice->shown.count;
    bool begins = true;
    for (int i = 0; i < count && begins; i++) begins = choice->shown.data[i].heading != heading;
    wr_array_push(&choice->shown, ((Shown){ row, begins ? heading : NULL }));
}

static void label_of(const Row *row, char label[200])
{
    snprintf(label, 200, row->named || !row->entry.style[0] ? "%.90s" : "%.90s %.90s",
             row->entry.family, row->named ? "" : row->entry.style);
}

static bool answers(const Row *row, const char *query)
{
    char label[200];
    label_of(row, label);
    return wr_search_score(label, query) > 0;
}

/* Without typed text: recently chosen fonts, then all. */
static void sort_shown(const WrApp *app, WrFontChoice *choice)
{
    static const char recent[] = "RECENT", named[] = "BY NAME", installed[] = "INSTALLED";
    const bool all = choice->filter[strspn(choice->filter, " ")] == '\0';
    choice->shown.count = 0;
    for (int k = 0; all && k < WR_FONTS_MAX && app->settings->fonts[k]; k++)
        for (int i = 0; i < choice->rows.count; i++)
            if (is_kept(&choice->rows.data[i], app->settings->fonts[k])) show(choice, i, recent);
    for (int i = 0; i < choice->rows.count; i++)
        if (all || answers(&choice->rows.data[i], choice->filter))
            show(choice, i, choice->rows.data[i].named ? named : installed);
    choice->stale = false;
}

/* ---- current font ---- */

static int param_of(const WrGenerateState *hand, const char *name)
{
    return wr_generator_param_find(hand->generator, name);
}

static bool is_in_hand(const WrGenerateState *hand, int param, const Row *row)
{
    const int file = param_of(hand, "file"), face = param_of(hand, "face");
    const char *path = file >= 0 ? hand->value[file].text : "";
    if (row->named)
        return !path[0] &&
               strcmp(row->named, wr_font_names[(int)hand->value[param].number[0]]) == 0;
    return strcmp(row->entry.path, path) == 0 &&
           (face < 0 || (int)hand->value[face].number[0] == row->entry.face);
}

static void take_in_hand(WrApp *app, int param, const Row *row)
{
    WrGenerateState *hand = app->generate;
    const int file = param_of(hand, "file"), face = param_of(hand, "face");
    WrText kept = { 0 };
    for (int i = 0; row->named && i < WR_FONT_FAMILY_COUNT; i++)
        if (strcmp(wr_font_names[i], row->named) == 0) hand->value[param].number[0] = i;
    wr_generate_set_text(&hand->value[file], row->named ? "" : row->entry.path);
    if (face >= 0) hand->value[face].number[0] = row->entry.face;
    if (row->named) wr_text_add(&kept, row->named);
    else wr_text_addf(&kept, "%d %s", row->entry.face, row->entry.path);
    wr_settings_note_font(app->settings, wr_text_get(&kept));
    wr_text_fini(&kept);
}

/* ---- the list ---- */

static bool row_pressed(WrFontChoice *choice, int i, bool chosen, bool current)
{
    char label[200];
    const int index = choice->shown.data[i].row;
    const Row *row = &choice->rows.data[index];
    const double wide = wr_gui_px(SAMPLE), left = wr_gui_px(12) + wide + wr_gui_px(12);
    if (!wr_gui_will_see(wr_gui_px(ROW)) && !(chosen && choice->jump)) {
        wr_gui_space(ROW);
        return false;
    }
    if (!row->asked) wr_array_push(&choice->wishes, index);
    const WrRow place = wr_gui_row_begin(i, ROW, chosen);
    if (chosen && choice->jump) wr_gui_row_see();
    wr_gui_row_set_cursor(wr_gui_px(12), choice->h);
    if (row->failed) wr_gui_text_cut(WR_FONT_SMALL, WR_COLOUR_BAD, "cannot be read", wide);
    else wr_gui_ink(row->texture, choice->w, choice->h, WR_COLOUR_TEXT);
    label_of(row, label);
    wr_gui_row_set_cursor(left, 0);
    wr_gui_as_it_is(true);
    wr_gui_text_cut(WR_FONT_SMALL, current ? WR_COLOUR_STRONG : WR_COLOUR_LABEL, label,
                    wr_gui_row_width() - left - wr_gui_px(12));
    wr_gui_as_it_is(false);
    wr_gui_row_end();
    return place.clicked;
}

static void move_by_keys(WrFontChoice *choice)
{
    const int was = choice->chosen, last = choice->shown.count - 1;
    if (wr_gui_key_pressed(SDL_SCANCODE_DOWN)) choice->chosen++;
    if (wr_gui_key_pressed(SDL_SCANCODE_UP)) choice->chosen--;
    if (wr_gui_key_pressed(SDL_SCANCODE_PAGEDOWN)) choice->chosen += PAGE;
    if (wr_gui_key_pressed(SDL_SCANCODE_PAGEUP)) choice->chosen -= PAGE;
    if (choice->chosen > last) choice->chosen = last;
    if (choice->chosen < 0) choice->chosen = 0;
    choice->jump = choice->jump || choice->chosen != was;
}

/* The pressed index into `shown`, or -1. */
static int rows(const WrApp *app, WrFontChoice *choice, int param)
{
    int pressed = -1;
    wr_gui_space(-6);
    for (int i = 0; i < choice->shown.count; i++) {
        const Shown *shown = &choice->shown.data[i];
        if (shown->heading) wr_gui_heading(shown->heading);
        const bool current = is_in_hand(app->generate, param, &choice->rows.data[shown->row]);
        if (row_pressed(choice, i, i == choice->chosen, current)) pressed = i;
    }
    choice->jump = false;
    if (!choice->listed)
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                            "Looking for the fonts that are installed...");
    else if (choice->err.text[0])
        wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_BAD, wr_error_message(&choice->err));
    else if (choice->shown.count == 0)
        wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "Nothing matches these words.");
    return pressed;
}

/* Scroll to the current font. */
static void find_current(const WrApp *app, WrFontChoice *choice, int param)
{
    choice->chosen = 0;
    choice->jump = true;
    for (int i = choice->shown.count - 1; i >= 0; i--)
        if (is_in_hand(app->generate, param, &choice->rows.data[choice->shown.data[i].row]))
            choice->chosen = i;
}

static void size_samples(WrApp *app, WrFontChoice *choice)
{
    const int w = wr_gui_px(SAMPLE), h = wr_gui_px(ROW - 2.0);
    if (w != choice->w || h != choice->h) forget(app);
    choice->w = w;
    choice->h = h;
}

static bool list(WrApp *app, int param)
{
    if (!wr_gui_popup_begin("fonts")) return false;
    WrFontChoice *choice = choice_of(app);
    char before[sizeof choice->filter];
    memcpy(before, choice->filter, sizeof before);
    size_samples(app, choice);
    wr_gui_width_at_least(WIDE);
    const bool enter =
        wr_gui_text_field("##filter", 0, choice->filter, sizeof choice->filter, choice->fresh);
    wr_gui_tip("Shows only those that match these words");
    const bool typed = strcmp(before, choice->filter) != 0;
    if (typed || choice->stale) sort_shown(app, choice);
    if (choice->fresh) find_current(app, choice, param);
    else if (typed) choice->chosen = 0, choice->jump = true;
    choice->fresh = false;
    move_by_keys(choice);
    wr_gui_list_begin("##fonts", fmin(wr_gui_px(TALL), app->height - wr_gui_px(150)));
    int taken = rows(app, choice, param);
    wr_gui_list_end();
    if (enter && choice->chosen < choice->shown.count) taken = choice->chosen;
    if (taken >= 0) take_in_hand(app, param, &choice->rows.data[choice->shown.data[taken].row]);
    if (taken >= 0 || wr_gui_escape_pressed()) wr_gui_popup_close();
    go_on(app, choice);
    wr_gui_popup_end();
    return taken >= 0;
}

bool wr_font_choice_row(WrApp *app, int param)
{
    char label[200];
    WrGenerateState *hand = app->generate;
    const WrFontChoice *known = hand->fonts;
    const int file = param_of(hand, "file");
    const char *path = hand->value[file].text, *slash = strrchr(path, '/');
    snprintf(label, sizeof label, "%.190s",
             path[0] ? (slash ? slash + 1 : path)
                     : wr_font_names[(int)hand->value[param].number[0]]);
    for (int i = 0; known && path[0] && i < known->rows.count; i++)
        if (is_in_hand(hand, param, &known->rows.data[i])) label_of(&known->rows.data[i], label);
    wr_gui_as_it_is(true);
    const bool open = wr_gui_list_button("font", label, wr_gui_available());
    wr_gui_as_it_is(false);
    if (open) {
        WrFontChoice *choice = choice_of(app);
        choice->filter[0] = '\0';
        choice->fresh = choice->stale = true;
        wr_gui_popup_open("fonts");
        app->redraw = WR_GENERATE_WAKE;
    }
    return list(app, param);
}

const WrPart wr_part_font_choice = { .forget = forget };

/* ---- A word in a font as a small picture, rendered by the text generator ---- */

/* The sample thus matches the result, and a damaged font can harm only the reader process. */

#define BASELINE 0.72 /* fraction of the height, from the top */
#define LETTERS 0.62  /* font size, as a fraction of the height */

static void line_of(const WrFontSample *sample, WrText *line)
{
    wr_text_add(line, "text ");
    wr_text_add_word(line, sample->named ? sample->named : sample->entry->sample);
    if (sample->named) {
        wr_text_addf(line, " font=%s", sample->named);
    } else {
        wr_text_add(line, " file=");
        wr_text_add_word(line, sample->entry->path);
        wr_text_addf(line, " face=%d", sample->entry->face);
    }
    wr_text_addf(line, " size=%d at=", (int)floor(LETTERS * sample->h + 0.5));
    wr_text_add_number(line, 2.0 / sample->w);
    wr_text_add(line, ",");
    wr_text_add_number(line, 1.0 - floor(BASELINE * sample->h) / sample->h);
    wr_text_add(line,
                " align=left anchor=baseline profile=flat bevel=0 height=1 edge=clip missing=sign");
}

bool wr_font_sample(const WrFontSample *sample, WrPool *pool, const WrProgress *progress,
                    uint32_t *argb)
{
    WrError err;
    WrText line = { 0 }, notes = { 0 };
    WrField *level =
        wr_field_new(sample->w, sample->h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, &err);
    if (!level) return false;
    WrDocument *document = wr_document_new();
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = level;
    line_of(sample, &line);
    const bool good = wr_edit_preview_generate(document, wr_text_get(&line), WR_LINE_INTO_ACTIVE,
                                               false, pool, progress, &notes, &err);
    const WrField *made = document->layers[0].heights;
    for (int y = 0; good && y < sample->h; y++)
        for (int x = 0; x < sample->w; x++) {
            const double part = fmin(1.0, fmax(0.0, (double)wr_field_get(made, x, y)));
            argb[y * sample->w + x] = (uint32_t)floor(part * 255.0 + 0.5) << 24 | 0xffffffu;
        }
    wr_text_fini(&line);
    wr_text_fini(&notes);
    wr_document_free(document);
    return good;
}

/* Background work of the export sheet: pictures while it is open; files after the button or, in live export, after
   each pause in editing. Live export ends at the first error. */
#include "ui/state/app_options.h"
#include "ui/state/busy.h"
#include "ui/state/input_router.h"
#include "ui/state/messages.h"
#include "ui/state/session_view.h"
#include "ui/toolkit/words.h"
#include "ui/panels/panel_sheet.h"
#include "ui/toolkit/gui_sdl.h"

#include "base/hash.h"
#include "base/memory.h"
#include "command/session.h"
#include "document/document.h"
#include "command/command_line.h"
#include "field/field.h"
#include "scene/scene.h"
#include "system/clock.h"
#include "system/path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PAUSE_SECONDS 0.5 /* pause in editing before files are written again */

/* ---- settings and their storage in the document ---- */

static bool is_same(const WrSheetRequest *a, const WrSheetRequest *b)
{
    return strcmp(a->as, b->as) == 0 && strcmp(a->folder, b->folder) == 0 &&
           strcmp(a->name, b->name) == 0 && a->depth == b->depth && a->size == b->size &&
           a->range == b->range;
}

/* Store the settings in the document by a command, if they have changed. */
static void keep(WrApp *app)
{
    static const char *const depths[] = { "set", "8", "16", "32" };
    static const char *const sizes[] = { "table", "half", "quarter", "power" };
    static const char *const ranges[] = { "set", "auto", "unit", "signed" };
    const WrSheetRequest *ask = &app->sheet->ask;
    if (is_same(ask, &wr_session_document(app->session)->scene->sheet)) return;
    WrText line = { 0 };
    wr_text_add(&line, "sheet ");
    wr_text_add_word(&line, ask->as);
    wr_text_add(&line, " folder=");
    wr_text_add_word(&line, ask->folder);
    wr_text_add(&line, " name=");
    wr_text_add_word(&line, ask->name);
    wr_text_addf(&line, " depth=%s size=%s range=%s", depths[ask->depth], sizes[ask->size],
                 ranges[ask->range]);
    wr_app_run_slow(app, wr_text_get(&line));
    wr_text_fini(&line);
}

/* Default folder and name: those of the document. */
static void take_place(const WrApp *app, WrSheetRequest *ask)
{
    const WrSheetRequest *kept = &wr_session_document(app->session)->scene->sheet;
    *ask = *kept;
    if (!*ask->as) snprintf(ask->as, sizeof ask->as, "%s", wr_set_rows[0].name);
    if (*ask->folder && *ask->name) return;
    const char *path = wr_session_path(app->session);
    char *here = wr_path_real(".");
    WrText name = { 0 };
    wr_set_cell_name(path, &name);
    snprintf(ask->name, sizeof ask->name, "%.120s", wr_text_get(&name));
    wr_text_fini(&name);
    const char *slash = strrchr(path, '/');
    if (slash)
        snprintf(ask->folder, sizeof ask->folder, "%.*s", (int)(slash - path),
                 slash > path ? path : "/");
    else snprintf(ask->folder, sizeof ask->folder, "%s", here ? here : ".");
    free(here);
}

WrSheetState *wr_sheet_open(WrApp *app)
{
    if (app->sheet) return app->sheet;
    app->sheet = wr_alloc(1, sizeof *app->sheet);
    take_place(app, &app->sheet->ask);
    app->sheet->names = wr_set_names();
    return app->sheet;
}

static void forget(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    if (!sheet) return;
    for (int i = 0; i < WR_SET_MAPS; i++) {
        if (sheet->pictures[i]) SDL_DestroyTexture(sheet->pictures[i]);
        sheet->pictures[i] = NULL;
    }
    for (int i = 0; i < 2; i++) {
        if (sheet->greens[i]) SDL_DestroyTexture(sheet->greens[i]);
        sheet->greens[i] = NULL;
    }
    sheet->looked_key = 0;
}

void wr_sheet_free(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    if (!sheet) return;
    wr_job_free(sheet->look);
    wr_job_free(sheet->write);
    forget(app);
    wr_sheet_look_free(sheet->shown);
    wr_set_names_free(&sheet->names);
    wr_free(sheet);
    app->sheet = NULL;
}

/* ---- detection of changes ---- */

/* Scene lines without effect on maps. */
static bool is_seen_only(const char *line, size_t length)
{
    static const char *const verbs[] = { "camera",      "rotate",     "material",  "light",
                                         "environment", "background", "tone",      "colour",
                                         "colouring",   "grain",      "dials",     "tolerance",
                                         "view",        "normalmap",  "replicate", "sheet",
                                         "roughness",   "metalness" };
    for (size_t i = 0; i < sizeof verbs / sizeof *verbs; i++) {
        const size_t n = strlen(verbs[i]);
        if (length > n && strncmp(line, verbs[i], n) == 0 && line[n] == ' ') return true;
    }
    return false;
}

/* Hash of all inputs of the files: the table, and the parts of the scene that affect maps. */
static uint64_t make_key(const WrApp *app, uint64_t table)
{
    WrText text = { 0 }, kept = { 0 };
    wr_session_scene_text(app->session, &text);
    for (const char *at = wr_text_get(&text); *at;) {
        const size_t length = strcspn(at, "\n");
        if (!is_seen_only(at, length)) wr_text_add_n(&kept, at, length);
        at += length + (at[length] == '\n');
    }
    const WrHash hash =
        wr_hash_bytes(wr_text_get(&kept), kept.length, (WrHash){ .low = table, .high = 1 });
    wr_text_fini(&text);
    wr_text_fini(&kept);
    return hash.low | 1;
}

/* Called in every frame, so the scene is hashed only after a command. */
static uint64_t key_of(const WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    const uint64_t table = wr_field_key(wr_document_field(wr_session_document(app->session)));
    const uint64_t revision = wr_session_revision(app->session);
    if (sheet->key && table == sheet->key_table && revision == sheet->key_revision)
        return sheet->key;
    sheet->key_table = table;
    sheet->key_revision = revision;
    return sheet->key = make_key(app, table);
}

/* ---- pictures ---- */

void wr_sheet_look(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    const uint64_t key = key_of(app);
    if (key == sheet->looked_key && is_same(&sheet->ask, &sheet->looked)) return;
    if (!sheet->look)
        sheet->look = wr_job_new(&wr_sheet_look_kind, app->options->threads, app->job_event);
    sheet->looked = sheet->ask;
    sheet->looked_key = key;
    wr_job_start(
        sheet->look,
        wr_sheet_look_new(wr_document_share(wr_session_document(app->session)), &sheet->ask));
}

static SDL_Texture *texture_of(SDL_Renderer *renderer, int w, int h, const uint8_t *rgb)
{
    SDL_Texture *texture =
        SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGB24, SDL_TEXTUREACCESS_STATIC, w, h);
    if (texture) wr_gui_sdl_update(texture, NULL, rgb, w * 3);
    return texture;
}

static void take_look(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    WrSheetLook *look = sheet->look ? wr_job_take(sheet->look) : NULL;
    if (!look) return;
    wr_sheet_look_free(sheet->shown);
    sheet->shown = look;
    for (int i = 0; i < WR_SET_MAPS; i++) {
        const WrExportPicture *p = &look->pictures[i];
        if (sheet->pictures[i]) SDL_DestroyTexture(sheet->pictures[i]);
        sheet->pictures[i] = p->rgb ? texture_of(app->renderer, p->width, p->height, p->rgb) : NULL;
    }
    wr_app_redraw(app);
}

/* ---- files ---- */

void wr_sheet_write(WrApp *app, bool loud)
{
    WrSheetState *sheet = app->sheet;
    if (!sheet->write)
        sheet->write = wr_job_new(&wr_sheet_write_kind, app->options->threads, app->job_event);
    sheet->written_key = key_of(app);
    sheet->loud = loud;
    if (loud) keep(app);
    wr_job_start(
        sheet->write,
        wr_sheet_write_new(wr_document_share(wr_session_document(app->session)), &sheet->ask));
    wr_app_redraw(app);
}

static void take_write(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    WrSheetWrite *write = sheet->write ? wr_job_take(sheet->write) : NULL;
    if (!write) return;
    if (write->ok) {
        if (sheet->loud) wr_app_say_lines(app, wr_text_get(&write->told));
        wr_app_say(app,
                   write->files == 1 ? "%s: wrote %d file to %s in %.2g s%s"
                                     : "%s: wrote %d files to %s in %.2g s%s",
                   write->ask.as, write->files, write->ask.folder, write->seconds,
                   sheet->live ? wr_words("; follows the hand") : "");
    } else {
        if (sheet->live) wr_error_prefix(&write->err, "live export stopped: ");
        sheet->live = false;
        if (write->cancelled) wr_app_say(app, "Cancelled: no file was replaced");
        else wr_app_fail(app, &write->err);
    }
    wr_sheet_write_free(write);
    wr_app_redraw(app);
}

bool wr_sheet_writing(const WrApp *app, double *fraction, double *seconds, const char **as)
{
    if (!app->sheet || !app->sheet->write) return false;
    *as = app->sheet->ask.as;
    return wr_job_busy(app->sheet->write, fraction, seconds);
}

/* The job returns its result in its present state, marked as cancelled. */
void wr_sheet_cancel(WrApp *app)
{
    if (app->sheet && app->sheet->write) wr_job_interrupt(app->sheet->write);
}

/* ---- live export ---- */

static bool hand_rests(const WrApp *app)
{
    return app->hand->grab == WR_GRAB_NONE && !wr_session_in_stroke(app->session) && !app->trying;
}

static void follow(WrApp *app)
{
    WrSheetState *sheet = app->sheet;
    const double now = wr_clock_seconds();
    if (!sheet->live || !hand_rests(app)) return;
    const uint64_t key = key_of(app);
    if (key != sheet->seen_key) {
        sheet->seen_key = key;
        sheet->seen_at = now;
    }
    if (key != sheet->written_key && now - sheet->seen_at >= PAUSE_SECONDS)
        wr_sheet_write(app, false);
}

static bool waits(const WrApp *app)
{
    const WrSheetState *sheet = app->sheet;
    return sheet && sheet->live && hand_rests(app) && sheet->seen_key != sheet->written_key;
}

static void update(WrApp *app)
{
    if (!app->sheet) return;
    take_look(app);
    take_write(app);
    follow(app);
}

static double next_time(const WrApp *app)
{
    return waits(app) ? app->sheet->seen_at + PAUSE_SECONDS : 0.0;
}

static bool works(WrApp *app)
{
    const WrSheetState *sheet = app->sheet;
    if (!sheet) return false;
    return waits(app) || (sheet->look && wr_job_busy(sheet->look, NULL, NULL)) ||
           (sheet->write && wr_job_busy(sheet->write, NULL, NULL));
}

/* Another document has other files. */
static void another(WrApp *app)
{
    if (!app->sheet) return;
    app->sheet->live = false;
    app->sheet->key = 0;
    take_place(app, &app->sheet->ask);
}

const WrPart wr_part_sheet = {
    .update = update, .next_time = next_time, .works = works, .another = another, .forget = forget
};

/* Question before a file is overwritten. Neither Return nor an accidental double click confirms it. */
#include "ui/app/state/overwrite_question.h"
#include "ui/app/state/action.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/document.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/session_view.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/files.h"

#include "base/array.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "command/variants.h"
#include "document/document.h"
#include "system/clock.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* The file of that name if it exists, or the first of those that <VARIANT> stands for. The caller frees it. */
static char *find_existing(const WrApp *app, const char *path)
{
    const WrDocument *document = wr_app_document(app);
    const int count = wr_variant_is_pattern(path) ? wr_variant_count(document) : 0;
    char name[WR_VARIANT_NAME_MAX + 1];
    if (wr_file_identity(path).there) return wr_strdup(path);
    for (int i = 0; i < count; i++) {
        wr_variant_name(document, i, name);
        char *file = wr_variant_fill(path, name);
        if (wr_file_identity(file).there) return file;
        wr_free(file);
    }
    return NULL;
}

bool wr_replace_confirm(WrApp *app, WrReplaceKind kind, WrFilePurpose purpose, const char *path)
{
    char *found = find_existing(app, path);
    if (!found) return false;
    char *kept = wr_strdup(path); /* `path` may be the old string */
    wr_free(app->replace->path);
    wr_free(app->replace->found);
    *app->replace = (WrReplace){ .kind = kind, .purpose = purpose, .path = kept, .found = found };
    wr_dialog_open(app, WR_DIALOG_REPLACE);
    return true;
}

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* "1.25 MB, written 3 May 2026, 14:02:07" */
static void describe(const WrReplace *replace, char *text, size_t size)
{
    WrFileIdentity stamp = wr_file_identity(replace->found);
    char when[64] = "";
    struct tm parts;
    time_t t = (time_t)stamp.seconds;
    double bytes = (double)stamp.bytes, unit = bytes < 1e3 ? 1.0 : bytes < 1e6 ? 1e3 : 1e6;
    const char *word = bytes < 1e3 ? "bytes" : bytes < 1e6 ? "kB" : "MB";
    if (wr_clock_local(t, &parts)) strftime(when, sizeof when, "%Y-%m-%d %H:%M:%S", &parts);
    wr_words_print(text, size, wr_words("%.3g %s, written %s"), bytes / unit, wr_words(word), when);
}

/* Return to the file dialog with the chosen name. */
static void go_back(WrApp *app)
{
    const WrReplace *replace = app->replace;
    wr_dialog_close(app);
    if (replace->kind == WR_REPLACE_CHANGED) {
        app->file->after = WR_AFTER_NOTHING;
    } else if (replace->kind == WR_REPLACE_PRESET) {
        wr_dialog_open(app, WR_DIALOG_PRESET);
    } else {
        char *folder = wr_path_folder(replace->path);
        if (!wr_files_request_path(app->files, replace->purpose, folder, name_of(replace->path)))
            wr_dialog_open(app, WR_DIALOG_FILE);
        wr_free(folder);
    }
}

static void go_ahead(WrApp *app)
{
    const WrReplace *replace = app->replace;
    wr_dialog_close(app);
    wr_deferred(app, app->registry->takes[replace->purpose], replace->path);
}

void wr_dialog_replace(WrApp *app)
{
    WR_ROWS(titles);
    static const char *const titles[WR_REPLACE_KINDS] = {
        [WR_ROW(WR_REPLACE_CHOSEN)] = "Replace this file?",
        [WR_ROW(WR_REPLACE_CHANGED)] = "Replace the changed file?",
        [WR_ROW(WR_REPLACE_PRESET)] = "Replace this preset?"
    };
    WR_ROWS_END(titles, WR_REPLACE_KINDS);
    const WrReplace *replace = app->replace;
    bool changed = replace->kind == WR_REPLACE_CHANGED, key = !app->dialog->fresh;
    char text[400], facts[160];
    if (!wr_gui_dialog_begin(titles[replace->kind], 440)) return;
    snprintf(text, sizeof text,
             changed
                 ? wr_words("Another program has changed %.200s since it was opened or saved here. "
                            "Saving would lose the changes of that program.")
                 : wr_words("There is already a file %.200s."),
             name_of(replace->found));
    describe(replace, facts, sizeof facts);
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_TEXT, text);
    wr_gui_text_wrapped(WR_FONT_TEXT, WR_COLOUR_LABEL, facts);
    wr_gui_space(8);
    bool other = wr_gui_button(changed ? "Save as..." : "Another name", true);
    if (changed) wr_gui_tip("S");
    wr_gui_same_line(8);
    bool replaces = wr_gui_button("Replace", false);
    wr_gui_tip("R");
    wr_gui_same_line(8);
    bool cancel = wr_gui_button("Cancel", false);
    wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL,
                        changed ? "Keys: S saves under another name, R replaces, Escape goes back."
                                : "Keys: R replaces, Escape goes back to the name.");
    if (key && wr_gui_letter_pressed(SDL_SCANCODE_R)) replaces = true;
    if (key && changed && wr_gui_letter_pressed(SDL_SCANCODE_S)) other = true;
    if (key && wr_gui_escape_pressed()) go_back(app);
    else if (replaces) go_ahead(app);
    else if (other && changed) {
        wr_dialog_close(app);
        wr_action_run(app, WR_ACT(save_as));
    } else if (other) go_back(app);
    else if (cancel) {
        wr_dialog_close(app);
        app->file->after = WR_AFTER_NOTHING;
    }
    wr_gui_dialog_end();
}

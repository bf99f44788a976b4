/* The current preset: its values are copied to settings.brush, its name to the command lines. */
#include "ui/canvas/tools/preset_browser.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/overwrite_question.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/tools/stroke_input.h"
#include "ui/canvas/tools/symmetry.h"
#include "ui/canvas/tools/tool.h"
#include "ui/canvas/tools/preset_overrides.h"
#include "ui/app/jobs/files.h"

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "brush/brush.h"
#include "brush/library.h"
#include "brush/preset.h"
#include "brush/symmetry.h"
#include "brush/tip.h"
#include "system/path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const WrLibrary *wr_preset_browser_library(WrApp *app)
{
    if (!app->shelf->library) app->shelf->library = wr_library_new();
    return app->shelf->library;
}

void wr_preset_browser_refresh(WrApp *app)
{
    wr_library_free(app->shelf->library);
    app->shelf->library = NULL;
    app->shelf->serial++;
    wr_app_redraw(app);
}

int wr_preset_browser_find(WrApp *app, const char *id)
{
    const WrLibrary *library = wr_preset_browser_library(app);
    for (int i = 0; i < wr_library_count(library); i++)
        if (strcmp(wr_library_entry(library, i)->id, id) == 0) return i;
    return -1;
}

const char *wr_preset_browser_chosen(const WrApp *app)
{
    return app->brush_files->preset ? app->brush_files->preset : WR_ROUND;
}

WrBrush wr_preset_browser_own(const WrApp *app)
{
    const WrPresetBrowser *shelf = app->shelf;
    return shelf->tuned ? wr_preset_brush(shelf->tuned) : wr_brush_default();
}

/* ---- choice ---- */

/* Use a preset (NULL: none) with its changed settings; ownership of both passes. Running strokes keep their own. `preset` is
   the file's, `tuned` a copy with the user's changed settings (the text brush_files->set), or the same preset shared; the
   brush points to `tuned`. */
static void install(WrApp *app, WrPreset *preset, WrPreset *tuned)
{
    WrPresetBrowser *shelf = app->shelf;
    wr_input_router_let_go(app);
    wr_preset_free(shelf->tuned);
    if (preset != shelf->preset) wr_preset_free(shelf->preset);
    shelf->preset = preset;
    shelf->tuned = tuned;
    app->settings->brush.preset = tuned;
    app->brush->now.preset = NULL; /* only read while a stroke is drawn */
    app->brush->now.tip = NULL;
}

static void drop_tip(WrApp *app)
{
    if (app->shelf->tip) app->settings->brush.tip = NULL;
    wr_tip_free(app->shelf->tip);
    app->shelf->tip = NULL;
    wr_settings_set_text(&app->brush_files->tip, NULL);
}

/* Copy the preset's values; settings of the user's hand, which are not part of a brush, are unchanged. */
static void take_values(WrApp *app)
{
    WrPresetBrowser *shelf = app->shelf;
    WrBrush *brush = &app->settings->brush, own = wr_preset_browser_own(app);
    own.preset = shelf->tuned;
    own.symmetry = brush->symmetry;
    own.source_u = brush->source_u;
    own.source_v = brush->source_v;
    if (app->settings->lock_size) own.radius = brush->radius;
    own.seed = 0;
    shelf->kept = own.mode;
    int forced = wr_tool_now(app)->mode;
    if (forced) own.mode = (WrBrushMode)(forced - 1);
    *brush = own;
    app->settings->other_strength = 0.0;
}

bool wr_preset_browser_choose(WrApp *app, const char *id)
{
    WrPreset *preset = NULL;
    WrError err;
    if (strcmp(id, WR_ROUND) != 0) {
        preset = wr_library_read(id, &err);
        if (!preset) {
            wr_app_fail(app, &err);
            return false;
        }
    }
    char *copy = wr_strdup(id); /* id may point to a text that changes below */
    install(app, preset, preset ? wr_preset_share(preset) : NULL);
    drop_tip(app);
    wr_settings_set_text(&app->brush_files->preset, preset ? copy : NULL);
    wr_settings_set_text(&app->brush_files->set, NULL);
    take_values(app);
    wr_settings_note_used(app->settings, copy);
    if (preset && wr_preset_is_colour_only(preset))
        wr_app_say(app, "This preset only changes colours: it leaves heights as they are");
    wr_free(copy);
    wr_app_redraw(app);
    return true;
}

void wr_preset_browser_take_file(WrApp *app, const char *path)
{
    char *full =
        wr_path_real(path); /* strokes name the preset, also after a change of the folder */
    wr_preset_browser_choose(app, full ? full : path);
    free(full);
}

void wr_preset_browser_tune_all(WrApp *app, const char *set)
{
    WrPresetBrowser *shelf = app->shelf;
    WrError err;
    if (!shelf->preset) return;
    WrPreset *tuned =
        set && set[0] ? wr_preset_with(shelf->preset, set, &err) : wr_preset_share(shelf->preset);
    if (!tuned) {
        wr_app_fail(app, &err);
        return;
    }
    char *copy = set && set[0] ? wr_strdup(set) : NULL;
    install(app, shelf->preset, tuned);
    wr_settings_set_text(&app->brush_files->set, copy);
    wr_free(copy);
    if (!shelf->tip) app->settings->brush.tip = wr_preset_tip(tuned);
    wr_app_redraw(app);
}

void wr_preset_browser_tune(WrApp *app, const char *name, double value)
{
    WrText set = { 0 };
    wr_tuning_put(app->brush_files->set, name, value, &set);
    wr_preset_browser_tune_all(app, wr_text_get(&set));
    wr_text_fini(&set);
}

/* Use a picture as tip, NULL: none. Deselects the preset. */
static bool preset_browser_tip(WrApp *app, const char *path)
{
    WrTip *tip = NULL;
    WrError err;
    if (path) {
        tip = wr_tip_read(path, &err);
        if (!tip) {
            wr_app_fail(app, &err);
            return false;
        }
    }
    char *copy = path ? wr_strdup(path) : NULL;
    wr_input_router_let_go(app);
    drop_tip(app);
    app->shelf->tip = tip;
    app->brush->now.tip = NULL;
    app->settings->brush.tip = tip;
    wr_settings_set_text(&app->brush_files->tip, copy);
    wr_free(copy);
    wr_app_redraw(app);
    return true;
}

void wr_preset_browser_last(WrApp *app)
{
    if (app->settings->used[1]) wr_preset_browser_choose(app, app->settings->used[1]);
    else wr_app_say(app, "No brush was chosen before this one");
}

void wr_preset_browser_step(WrApp *app, int by)
{
    const char *list[WR_FAVOURITES_MAX], *chosen = wr_preset_browser_chosen(app);
    int count = 0, at = -1;
    for (int i = 0; i < WR_FAVOURITES_MAX && app->settings->favourites[i]; i++) {
        const char *id = app->settings->favourites[i];
        if (strchr(id, ':')) continue; /* of another list */
        if (strcmp(id, chosen) == 0) at = count;
        list[count++] = id;
    }
    if (count == 0) {
        wr_app_say(app, "No favourites yet: the star in the Brushes tab makes them");
        return;
    }
    at = at < 0 ? (by > 0 ? 0 : count - 1) : (at + by + count) % count;
    wr_preset_browser_choose(app, list[at]);
}

/* ---- user presets ---- */

static bool is_name(const char *name)
{
    if (!name[0] || name[0] == '.') return false;
    for (const char *c = name; *c; c++)
        if (*c == '/' || *c == '\\' || (unsigned char)*c < ' ') return false;
    return true;
}

#define TIP_MAX (64u << 20) /* bytes */

/* True if the file contains these bytes, or does not exist. The picture of another preset is never replaced. */
static bool is_free_for(const char *path, const char *bytes, size_t length, WrError *err)
{
    char *there = NULL;
    size_t size = 0;
    if (!wr_path_is_there(path)) return true;
    bool same = wr_file_read(path, TIP_MAX, &there, &size, NULL) && size == length &&
                memcmp(there, bytes, size) == 0;
    wr_free(there);
    return same ||
           wr_fail(err, "%s: another picture of this name is there; rename one of them", path);
}

/* A preset's picture must be in its folder, so a copy of the preset needs a copy of the picture. */
static bool copy_tip(const WrApp *app, const char *folder, WrError *err)
{
    const char *path = app->brush_files->tip;
    const char *from = path ? strrchr(path, '/') : NULL;
    char *bytes = NULL;
    size_t length;
    if (!path) return true;
    char *to = wr_path_join(folder, from ? from + 1 : path);
    bool ok = strcmp(to, path) == 0 ||
              (wr_file_read(path, TIP_MAX, &bytes, &length, err) &&
               is_free_for(to, bytes, length, err) && wr_file_write(to, bytes, length, err));
    wr_free(bytes);
    wr_free(to);
    return ok;
}

/* Base of a saved brush without a preset: libmypaint's default settings. */
static WrPreset *plain(WrError *err)
{
    static const char text[] = "{\"version\":3,\"settings\":{}}";
    return wr_preset_parse(text, sizeof text - 1, "brush", NULL, err);
}

/* File of a user preset. The caller frees it. */
static char *preset_path(const char *folder, const char *name)
{
    WrText file = { 0 };
    wr_text_addf(&file, "%s.myb", name);
    char *path = wr_path_join(folder, wr_text_get(&file));
    wr_text_fini(&file);
    return path;
}

static bool write_preset(WrApp *app, const char *folder, const char *name, WrError *err)
{
    WrPresetBrowser *shelf = app->shelf;
    WrText text = { 0 };
    WrPreset *preset = shelf->tuned ? wr_preset_share(shelf->tuned) : plain(err);
    if (!preset) return false;
    WrBrush brush = app->settings->brush;
    brush.symmetry = (WrSymmetry){ 0 };
    if (wr_tool_now(app)->mode) brush.mode = shelf->kept;
    wr_preset_print(preset, &brush, &text);
    char *path = preset_path(folder, name);
    bool ok =
        copy_tip(app, folder, err) && wr_file_write(path, wr_text_get(&text), text.length, err);
    wr_preset_free(preset);
    wr_free(path);
    wr_text_fini(&text);
    return ok;
}

static bool preset_browser_save(WrApp *app, const char *name);

void wr_preset_browser_open_save(WrApp *app, const char *name)
{
    char *folder = is_name(name) ? wr_library_user_folder(NULL) : NULL;
    char *path = folder ? preset_path(folder, name) : NULL;
    bool asks = path && wr_replace_confirm(app, WR_REPLACE_PRESET, WR_FILE_PRESET, path);
    if (!asks) preset_browser_save(app, name);
    wr_free(path);
    wr_free(folder);
}

/* Save the brush as a user preset, and choose it. */
static bool preset_browser_save(WrApp *app, const char *name)
{
    WrError err;
    char *folder = NULL;
    bool ok = is_name(name) || wr_fail(&err, "name '%s': a file name without slashes", name);
    if (ok) folder = wr_library_user_folder(&err);
    ok = folder && write_preset(app, folder, name, &err);
    if (!ok) wr_app_fail(app, &err);
    wr_free(folder);
    if (!ok) return false;
    WrText id = { 0 };
    wr_text_addf(&id, "user/%s", name);
    wr_preset_browser_refresh(app);
    ok = wr_preset_browser_choose(app, wr_text_get(&id));
    if (ok) wr_app_say(app, "Saved the brush as %s", name);
    wr_text_fini(&id);
    return ok;
}

void wr_preset_browser_overwrite(WrApp *app, const char *path)
{
    (void)path; /* of that name, as typed */
    preset_browser_save(app, app->shelf->name);
}

bool wr_preset_browser_delete(WrApp *app, const char *id)
{
    WrError err;
    int index = wr_preset_browser_find(app, id);
    if (index < 0 || strncmp(id, "user/", 5) != 0) return false;
    const WrPresetEntry *entry = wr_library_entry(app->shelf->library, index);
    if (!wr_path_remove(entry->path)) {
        wr_fail(&err, "%s: cannot be removed", entry->path);
        wr_app_fail(app, &err);
        return false;
    }
    wr_app_say(app, "Removed %s", entry->name);
    wr_settings_set_favourite(app->settings, id, false);
    if (strcmp(id, wr_preset_browser_chosen(app)) == 0) wr_preset_browser_choose(app, WR_ROUND);
    wr_preset_browser_refresh(app);
    return true;
}

/* ---- storage in the settings ---- */

void wr_preset_browser_start(WrApp *app)
{
    WrSettings *s = app->settings;
    WrBrush values = s->brush;
    WrError err;
    app->shelf->before = app->shelf->kept = WR_BRUSH_RAISE;
    WrPreset *preset = s->preset ? wr_library_read(s->preset, &err) : NULL;
    if (preset) {
        WrPreset *tuned = s->set ? wr_preset_with(preset, s->set, &err) : NULL;
        if (tuned) wr_settings_set_text(&app->brush_files->set, s->set);
        app->shelf->preset = preset;
        app->shelf->tuned = tuned ? tuned : wr_preset_share(preset);
        wr_settings_set_text(&app->brush_files->preset, s->preset);
        values.preset = app->shelf->tuned;
        values.tip = wr_preset_tip(app->shelf->tuned);
    } else if (s->preset) {
        wr_app_fail(app, &err);
        values.tip = NULL;
    }
    s->brush = values;
    if (s->tip) preset_browser_tip(app, s->tip);
    if (!s->used[0]) wr_settings_note_used(s, wr_preset_browser_chosen(app));
    wr_symmetry_apply(app);
}

void wr_preset_browser_remember(const WrApp *app, WrSettings *settings)
{
    if (wr_tool_now(app)->mode) settings->brush.mode = app->shelf->kept;
    settings->preset = app->brush_files->preset;
    settings->tip = app->brush_files->tip;
    settings->set = app->brush_files->set;
}

void wr_preset_browser_free(WrApp *app)
{
    WrPresetBrowser *shelf = app->shelf;
    wr_library_free(shelf->library);
    wr_preset_free(shelf->tuned);
    wr_preset_free(shelf->preset);
    wr_tip_free(shelf->tip);
    wr_free(app->brush_files->preset);
    wr_free(app->brush_files->tip);
    wr_free(app->brush_files->set);
    *app->brush_files = (WrBrushSources){ 0 };
    *shelf = (WrPresetBrowser){ 0 };
}

/* Preferences: window settings and keys. Each change takes effect and is saved at once. */
#include "ui/panels/panel_preferences.h"
#include "ui/app/state/action.h"
#include "ui/app/state/app_state.h"
#include "ui/app/state/dialog.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/search_score.h"
#include "ui/app/state/settings.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/theme.h"
#include "ui/toolkit/words.h"
#include "ui/app/jobs/files.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/enum_rows.h"
#include "base/text.h"
#include "system/path.h"

#include <SDL.h>
#include <stdio.h>
#include <string.h>

#define MAX_FILE (1 << 16)
#define ROW 26.0
#define ROWS 11.0

/* ---- the window ---- */

static void language_row(WrApp *app)
{
    const char *names[16];
    const int count = wr_language_count < 16 ? wr_language_count : 16;
    for (int i = 0; i < count; i++) names[i] = wr_languages[i].name;
    wr_gui_label("Language");
    if (wr_gui_choice("language", 0, names, count, &app->settings->language))
        wr_words_choose(app->settings->language);
}

static void dialogs_row(WrApp *app)
{
    static const char *const ways[] = { WR_FILE_WAYS(WR_WORD) };
    wr_gui_label("File dialogs");
    if (wr_gui_choice("dialogs", 0, ways, WR_FILE_WAY_COUNT, &app->settings->dialogs))
        wr_files_choose_way(app->files, (WrFileWay)app->settings->dialogs);
    wr_gui_tip("File dialogs: of the desktop, through its portal, or of this program. Automatic: "
               "the desktop's if it answers within a second.");
}

static void window_rows(WrApp *app)
{
    static const char *const themes[] = { "Dark", "Light", "High contrast" };
    static const char *const sizes[] = { "As the display", "75 %",  "100 %", "125 %", "150 %",
                                         "175 %",          "200 %", "250 %", "300 %" };
    static const double scales[] = { 0, 0.75, 1, 1.25, 1.5, 1.75, 2, 2.5, 3 };
    _Static_assert(WR_LENGTH(themes) == WR_THEME_KINDS, "in the order of theme.h");
    _Static_assert(WR_LENGTH(sizes) == WR_LENGTH(scales), "a name each");
    int theme = (int)app->settings->theme, size = 0;
    for (int i = 0; i < WR_LENGTH(scales); i++)
        if (app->settings->scale == scales[i]) size = i;
    wr_gui_label("Theme");
    if (wr_gui_choice("theme", 0, themes, WR_LENGTH(themes), &theme))
        app->settings->theme = (WrThemeKind)theme;
    wr_gui_label("Size");
    if (wr_gui_choice("size", 0, sizes, WR_LENGTH(sizes), &size))
        wr_app_set_scale(app, scales[size]);
    language_row(app);
    dialogs_row(app);
}

static void map_row(WrApp *app)
{
    const char *labels[WR_KEY_MAPS];
    int map = app->settings->key_map;
    for (int i = 0; i < WR_KEY_MAPS; i++) labels[i] = wr_key_maps[i].label;
    wr_gui_label("Habits");
    if (!wr_gui_choice("habits", 0, labels, WR_KEY_MAPS, &map)) return;
    app->settings->key_map = map;
    wr_app_read_keys(app);
}

/* ---- keys ---- */

static const char *label_of(const WrApp *app, const char *action)
{
    const WrAction *found = wr_action_find(app, action);
    return found ? found->label : action;
}

/* Text of the user's key file with the map's keys of one action, or of two. */
static bool write_keys(WrApp *app, const char *action, const char *also, WrError *err)
{
    WrText once = { 0 }, twice = { 0 };
    char *path = wr_config_path("keys.conf"), *text = NULL;
    size_t length;
    if (!path) return wr_fail(err, "there is no folder for settings: HOME is not set");
    wr_settings_make_folder();
    bool good = !wr_path_is_there(path) || wr_file_read(path, MAX_FILE, &text, &length, err);
    if (good) {
        wr_keys_edit(app->keys, action, text ? text : "", &once);
        if (also) wr_keys_edit(app->keys, also, wr_text_get(&once), &twice);
        const char *result = wr_text_get(also ? &twice : &once);
        good = wr_file_write(path, result, strlen(result), err);
    }
    wr_free(text);
    wr_free(path);
    wr_text_fini(&once);
    wr_text_fini(&twice);
    return good;
}

static void tell(WrPreferences *p, const WrError *err, const char *format, const char *key,
                 const char *what, const char *other)
{
    p->bad = err != NULL;
    if (err) wr_words_message(wr_error_message(err), p->message, sizeof p->message);
    else snprintf(p->message, sizeof p->message, format, key, what, other);
}

/* Apply the written keys of both actions; after a failed write, restore the map. */
static void settle(WrApp *app, const char *action, const char *other, const char *key)
{
    WrError err;
    WrPreferences *p = app->preferences;
    const bool good = write_keys(app, action, other, &err);
    wr_app_read_keys(app);
    if (!good) tell(p, &err, "", "", "", "");
    else if (!key) tell(p, NULL, wr_words("%s%s has no key now%s"), "", label_of(app, action), "");
    else if (other)
        tell(p, NULL, wr_words("%s: %s; taken from %s"), key, label_of(app, action),
             label_of(app, other));
    else tell(p, NULL, "%s: %s%s", key, label_of(app, action), "");
}

static void give(WrApp *app, const char *action, WrKey key)
{
    char other[64] = "", label[32];
    const char *owner = wr_keys_owner(app->keys, key);
    if (owner && strcmp(owner, action) != 0) snprintf(other, sizeof other, "%.63s", owner);
    wr_keymap_bind(app->keys, action, key);
    wr_keys_label(app->keys, action, label);
    settle(app, action, other[0] ? other : NULL, label);
}

bool wr_preferences_take_key(WrApp *app, const SDL_KeyboardEvent *event)
{
    WrPreferences *p = app->preferences;
    if (app->dialog->now != WR_DIALOG_PREFERENCES || !p->waits[0]) return false;
    if (!wr_key_can_be_given(event->keysym.sym)) return false;
    p->key = (WrKey){ event->keysym.sym, wr_key_mods((SDL_Keymod)event->keysym.mod) };
    return true;
}

/* Dialog state while an action waits for its key. */
static void wait_for_key(WrApp *app)
{
    WrPreferences *p = app->preferences;
    char action[sizeof p->waits];
    const WrKey key = p->key;
    if (key.code == SDLK_UNKNOWN) return;
    memcpy(action, p->waits, sizeof action);
    p->waits[0] = '\0';
    p->key = (WrKey){ SDLK_UNKNOWN, 0 };
    if ((key.code == SDLK_BACKSPACE || key.code == SDLK_DELETE) && key.mods == 0) {
        wr_keys_unbind_all(app->keys, action);
        settle(app, action, NULL, NULL);
    } else {
        give(app, action, key);
    }
}

static void key_row(WrApp *app, int i, const WrAction *action)
{
    WrText keys = { 0 };
    WrPreferences *p = app->preferences;
    const bool waits = strcmp(p->waits, action->name) == 0;
    const WrRow row = wr_gui_row_begin(i, ROW, waits);
    wr_keys_list(app->keys, action->name, &keys);
    const char *right = waits ? wr_words("press a key; Delete: none") : wr_text_get(&keys);
    const double wide = wr_gui_text_width(WR_FONT_SMALL, right), room = wr_gui_row_width();
    wr_gui_row_set_cursor(wr_gui_px(14), 0);
    wr_gui_text_cut(WR_FONT_TEXT, waits ? WR_COLOUR_STRONG : WR_COLOUR_TEXT, action->label,
                    room - wide - wr_gui_px(42));
    wr_gui_row_set_cursor(room - wide - wr_gui_px(14), 0);
    wr_gui_text(WR_FONT_SMALL, waits ? WR_COLOUR_STRONG : WR_COLOUR_LABEL, right);
    wr_gui_row_end();
    wr_text_fini(&keys);
    if (row.clicked) p->key = (WrKey){ SDLK_UNKNOWN, 0 };
    if (row.clicked) snprintf(p->waits, sizeof p->waits, "%.63s", waits ? "" : action->name);
}

static bool is_wanted(const WrApp *app, const WrAction *action)
{
    const char *query = app->preferences->query;
    if (!query[0] || wr_search_score(action->label, query) > 0) return true;
    WrText keys = { 0 };
    wr_keys_list(app->keys, action->name, &keys);
    const bool any = strstr(wr_text_get(&keys), query) != NULL;
    wr_text_fini(&keys);
    return any;
}

static void key_list(WrApp *app)
{
    WrPreferences *p = app->preferences;
    int shown = 0;
    wr_gui_hint_field("##find", "An action, or a key such as Ctrl+", 0, p->query, sizeof p->query);
    wr_gui_list_begin("##keys", wr_gui_px(ROW * ROWS));
    wr_gui_space(-6);
    for (const WrAction *a = app->registry->actions; a->name; a++)
        if (is_wanted(app, a)) key_row(app, shown++, a);
    if (shown == 0) wr_gui_text(WR_FONT_TEXT, WR_COLOUR_LABEL, "No action matches these words.");
    wr_gui_list_end();
    wr_gui_text_wrapped(WR_FONT_SMALL, p->bad ? WR_COLOUR_BAD : WR_COLOUR_LABEL,
                        p->message[0] ? p->message : "Click an action, then press its new key.");
}

void wr_dialog_preferences(WrApp *app)
{
    WrPreferences *p = app->preferences;
    if (app->dialog->fresh) *p = (WrPreferences){ 0 };
    if (!wr_gui_dialog_begin("Preferences", 520)) return;
    const bool waited = p->waits[0] != '\0';
    if (waited && wr_gui_escape_pressed()) p->waits[0] = '\0';
    else if (waited) wait_for_key(app);
    window_rows(app);
    map_row(app);
    if (app->display_word) wr_gui_text_wrapped(WR_FONT_SMALL, WR_COLOUR_LABEL, app->display_word);
    key_list(app);
    const bool key = !waited && !app->dialog->fresh;
    if (wr_gui_button("Close", true) ||
        (key && (wr_gui_escape_pressed() || wr_gui_return_pressed())))
        wr_dialog_close(app);
    wr_gui_dialog_end();
}

/* Every row of every panel, option bar and dialog is changed once by keys and once by the pointer, every menu and list
   is walked, every action is run in several documents, and every kind of every generator is applied; an error message
   fails the test. The rows come from the window's list of widgets (ui/toolkit/focus.h), the kinds of lights,
   surfaces, generators and so on from their tables, so that new ones are tested automatically. */
#include "test.h"

#include "window_walk.h"

#include "scene/objects.h"
#include "scene/scene.h"
#include "shade/reflection.h"

#include "ui/app/state/background_command.h"
#include "ui/app/state/action.h"
#include "ui/app/state/messages.h"
#include "ui/toolkit/focus.h"

#include <time.h>

#define MAX_ROWS 2000
#define MAX_STEPS 40 /* steps through a list by keys */

static int rows_changed, rows_of_document, complaints;
static bool dialogs_seen[WR_DIALOG_COUNT];

/* ---- the window ---- */

static void key(Walk *walk, SDL_Scancode code)
{
    const SDL_Keysym keysym = { .scancode = code, .sym = SDL_GetKeyFromScancode(code) };
    wr_gui_event(walk->app->gui, &(SDL_Event){ .key = { .type = SDL_KEYDOWN, .keysym = keysym } });
    wr_gui_event(walk->app->gui, &(SDL_Event){ .key = { .type = SDL_KEYUP, .keysym = keysym } });
}

/* Frames until every change has reached the document. */
static void settle(Walk *walk)
{
    WrApp *app = walk->app;
    for (int i = 0; i < 40; i++) {
        walk_frame(walk);
        app->visible = false; /* deferred work does not wait for a drawn picture */
        wr_deferred_run(app);
        app->visible = true;
        wr_busy_update(app);
        wr_busy_settle(app);
        if (i > 1 && !app->busy && !wr_gui_unsettled(app->gui) && !wr_deferred_waits(app, NULL))
            return;
    }
}

static void tap(Walk *walk, SDL_Scancode code)
{
    key(walk, code);
    settle(walk);
}

static void type(Walk *walk, const char *text)
{
    SDL_Event event = { .text = { .type = SDL_TEXTINPUT } };
    snprintf(event.text.text, sizeof event.text.text, "%s", text);
    wr_gui_event(walk->app->gui, &event);
    walk_frame(walk);
}

static void button(Walk *walk, bool down, double x, double y)
{
    walk_button(walk, SDL_BUTTON_LEFT, down, x, y);
}

static void click_with(Walk *walk, Uint8 which, double x, double y)
{
    walk_point(walk, x, y);
    walk_button(walk, which, true, x, y);
    walk_button(walk, which, false, x, y);
    settle(walk);
}

static void click(Walk *walk, double x, double y)
{
    click_with(walk, SDL_BUTTON_LEFT, x, y);
}

static void forget_messages(Walk *walk)
{
    wr_messages_free(walk->app->messages);
    *walk->app->messages = (WrMessages){ 0 };
}

static void see_messages(Walk *walk, const WrKeyStop *stop, const char *act)
{
    WrMessages *messages = walk->app->messages;
    for (int i = 0; i < messages->list.count; i++) {
        const WrMessage *m = &messages->list.data[i];
        if (!m->bad) continue;
        complaints++;
        printf("%s: %s at %g,%g (kind %d): %s\n", walk->where, act, (double)stop->x0,
               (double)stop->y0, (int)stop->kind, m->text);
    }
    forget_messages(walk);
}

/* A text typed into a row may be refused, with a message that contains a valid text or the missing file. */
static void see_answer(Walk *walk, const WrKeyStop *stop)
{
    static const char *const answers[] = { "must be ", "No such file" };
    bool refused = false;
    for (int i = 0; i < walk->app->messages->list.count; i++)
        for (size_t k = 0; k < sizeof answers / sizeof *answers; k++)
            refused |= strstr(walk->app->messages->list.data[i].text, answers[k]) != NULL;
    if (refused) forget_messages(walk);
    else see_messages(walk, stop, "a text typed");
}

/* ---- one place, as it was ---- */

typedef struct Base {
    int position; /* of the history */
    int tab, tool;
    WrDialog dialog;
} Base;

static void close_lists(Walk *walk)
{
    for (int i = 0; i < 4 && wr_gui_popup_open_now(walk->app->gui); i++)
        tap(walk, SDL_SCANCODE_ESCAPE);
}

static Base base_of(const Walk *walk)
{
    return (Base){ .position = wr_session_history_position(walk->session),
                   .tab = walk->app->settings->tab,
                   .tool = walk->app->tool,
                   .dialog = walk->app->dialog->now };
}

/* A scene with every optional row of the panel: two objects, each kind of light, pictures, a solid texture. */
static void fill(Walk *walk)
{
    static const char *const lines[] = { "light directional to=-1,1,2 size=2",
                                         "light point at=1,2,3 shadow=off",
                                         "environment studio",
                                         "grain wood drives=all",
                                         "cell 20,10 mm=on",
                                         "colour " WR_SOURCE_DIR "/samples/wood-diffuse.jpg",
                                         "normalmap " WR_SOURCE_DIR "/samples/wood-normal.jpg",
                                         "object add second at=2,0,0",
                                         "object set size=1,2,1",
                                         "camera save front" };
    walk_fill(walk);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) walk_run(walk, lines[i]);
}

/* After a button replaced the document: restore the test's document. */
static void fill_again(Walk *walk)
{
    wr_session_reset(walk->session);
    fill(walk);
    for (const WrPart *const *p = walk->app->registry->parts; *p; p++)
        if ((*p)->another) (*p)->another(walk->app);
}

/* Undo a change, so that the next row is tested in the same document, at the same place. */
static void back_to(Walk *walk, const Base *base)
{
    WrError err;
    WrApp *app = walk->app;
    close_lists(walk);
    wr_app_settle(app);
    wr_app_try_end(app);
    if (wr_session_history_count(walk->session) < base->position) fill_again(walk);
    else if (wr_session_history_position(walk->session) != base->position &&
             !wr_session_history_go(walk->session, base->position, &err))
        fail_msg("%s: %s", walk->where, err.text);
    if (app->dialog->now != base->dialog && app->dialog->now != WR_DIALOG_NONE)
        wr_dialog_close(app);
    if (app->dialog->now != base->dialog || app->settings->tab != base->tab ||
        app->tool != base->tool)
        walk->open(walk, walk->which);
    settle(walk);
}

/* ---- one row ---- */

static bool find(Walk *walk, unsigned id, WrKeyStop *stop)
{
    int count;
    const WrKeyStop *stops = wr_gui_stops(walk->app->gui, &count);
    for (int i = 0; i < count; i++)
        if (stops[i].id == id) return *stop = stops[i], true;
    return false;
}

/* Scroll to the row and focus it; false if it is missing or disabled. */
static bool come_to(Walk *walk, unsigned id, WrKeyStop *stop)
{
    if (!wr_gui_focus_on(walk->app->gui, id)) return false;
    walk_frame(walk);
    walk_frame(walk);
    return find(walk, id, stop);
}

static void type_number(Walk *walk, const char *text)
{
    tap(walk, SDL_SCANCODE_RETURN);
    type(walk, text);
    tap(walk, SDL_SCANCODE_RETURN);
}

/* ---- rows that jump ---- */

static WrKeyStop places[MAX_ROWS];
static int place_count, places_compared;
static const char *places_language; /* another language has other lengths of words */

static void note_places(Walk *walk)
{
    const WrKeyStop *stops = wr_gui_stops(walk->app->gui, &place_count);
    if (place_count > MAX_ROWS) fail_msg("%s: too many rows", walk->where);
    memcpy(places, stops, (size_t)place_count * sizeof *places);
    places_language = wr_words_language();
}

/* Where the rows are still the same ones, only values and notes have changed: no row may have moved. */
static void see_places(Walk *walk, const WrKeyStop *stop, const char *act)
{
    int count;
    const WrKeyStop *now = wr_gui_stops(walk->app->gui, &count);
    bool same = count == place_count && places_language == wr_words_language();
    for (int i = 0; i < count && same; i++) same = now[i].id == places[i].id;
    for (int i = 0; i < count && same; i++) {
        if (fabs((double)(now[i].y0 - places[i].y0)) < 0.5) continue;
        complaints++;
        printf("%s: %s at %g,%g (kind %d): a row at %g,%g moves by %g\n", walk->where, act,
               (double)stop->x0, (double)stop->y0, (int)stop->kind, (double)places[i].x0,
               (double)places[i].y0, (double)(now[i].y0 - places[i].y0));
        break;
    }
    places_compared += same;
}

/* The pointer above a row shows its tip and moves nothing. */
static void hover(Walk *walk, const WrKeyStop *stop)
{
    note_places(walk);
    walk_point(walk, 0.5 * (double)(stop->x0 + stop->x1), 0.5 * (double)(stop->y0 + stop->y1));
    walk_frame(walk);
    see_places(walk, stop, "the pointer above it");
}

static void by_keys(Walk *walk, const WrKeyStop *stop)
{
    note_places(walk);
    switch (stop->kind) {
    case WR_STOP_NUMBER:
        tap(walk, SDL_SCANCODE_RIGHT);
        see_places(walk, stop, "an arrow on the number");
        tap(walk, SDL_SCANCODE_LEFT);
        see_messages(walk, stop, "an arrow on the number");
        type_number(walk, "1e12");
        see_messages(walk, stop, "the largest number typed");
        type_number(walk, "-1e12");
        see_messages(walk, stop, "the smallest number typed");
        tap(walk, SDL_SCANCODE_DELETE);
        break;
    case WR_STOP_CHOICE:
        for (int i = 0; i < MAX_STEPS; i++) {
            const uint64_t before = wr_session_revision(walk->session);
            note_places(walk);
            tap(walk, SDL_SCANCODE_DOWN);
            see_places(walk, stop, "a step down the list");
            see_messages(walk, stop, "a step down the list");
            if (wr_session_revision(walk->session) == before && i > 2) break;
            if (wr_gui_focus_now(walk->app->gui) != stop->id) break;
        }
        break;
    case WR_STOP_TEXT:
        tap(walk, SDL_SCANCODE_RETURN);
        type(walk, "1");
        tap(walk, SDL_SCANCODE_RETURN);
        see_answer(walk, stop);
        tap(walk, SDL_SCANCODE_RETURN); /* Escape restores a refused text */
        tap(walk, SDL_SCANCODE_ESCAPE);
        break;
    case WR_STOP_PAD:
        tap(walk, SDL_SCANCODE_RIGHT);
        tap(walk, SDL_SCANCODE_SPACE);
        tap(walk, SDL_SCANCODE_SPACE);
        break;
    default: tap(walk, SDL_SCANCODE_SPACE); see_places(walk, stop, "the space key");
    }
    see_messages(walk, stop, "keys");
}

static void by_pointer(Walk *walk, const WrKeyStop *stop)
{
    const double x = 0.5 * ((double)stop->x0 + (double)stop->x1);
    const double y = 0.5 * ((double)stop->y0 + (double)stop->y1);
    const double row = (double)stop->y1 - (double)stop->y0;
    switch (stop->kind) {
    case WR_STOP_NUMBER:
    case WR_STOP_PAD:
        walk_point(walk, x, y);
        button(walk, true, x, y);
        for (int i = 1; i <= 4; i++) walk_point(walk, x + 5 * i, y);
        button(walk, false, x + 20, y);
        settle(walk);
        break;
    case WR_STOP_CHOICE:
        click(walk, x, y);
        if (wr_gui_popup_open_now(walk->app->gui)) click(walk, x, y + 2 * row);
        break;
    default: click(walk, x, y);
    }
    see_messages(walk, stop, "the pointer");
}

/* Menus, tool strip and status line are the same at every place: they are tested only at the first. */
static unsigned known[4 * MAX_ROWS];
static int known_count;

static bool is_new(unsigned id)
{
    for (int i = 0; i < known_count; i++)
        if (known[i] == id) return false;
    if (known_count < 4 * MAX_ROWS) known[known_count++] = id;
    return true;
}

static void click_stop(Walk *walk, Uint8 which, const WrKeyStop *stop)
{
    click_with(walk, which, 0.5 * (double)(stop->x0 + stop->x1),
               0.5 * (double)(stop->y0 + stop->y1));
}

/* The stops of the newest frame that are not among the older ones. */
static int list_added(Walk *walk, const WrKeyStop *old, int old_count, WrKeyStop *out, int most)
{
    int count, n = 0;
    const WrKeyStop *stops = wr_gui_stops(walk->app->gui, &count);
    for (int i = 0; i < count; i++) {
        bool is_old = false;
        for (int k = 0; k < old_count && !is_old; k++) is_old = old[k].id == stops[i].id;
        if (!is_old && n < most) out[n++] = stops[i];
    }
    return n;
}

#define POPUP_MAX 60 /* tried entries of a popup */

static int popups_opened;

/* If a press of the button opens a list or a menu: each of its entries once, by the pointer. */
static void change_popup(Walk *walk, unsigned id, Uint8 which, const Base *base)
{
    static WrKeyStop before[MAX_ROWS];
    WrKeyStop items[POPUP_MAX], stop;
    int old;
    if (!come_to(walk, id, &stop)) return;
    const WrKeyStop *stops = wr_gui_stops(walk->app->gui, &old);
    memcpy(before, stops, (size_t)old * sizeof *before);
    click_stop(walk, which, &stop);
    const bool opened = wr_gui_popup_open_now(walk->app->gui);
    const int count = opened ? list_added(walk, before, old, items, POPUP_MAX) : 0;
    see_messages(walk, &stop, "a press that may open a list");
    back_to(walk, base);
    for (int i = 0; i < count; i++) {
        WrKeyStop item;
        if (!is_new(items[i].id) || !come_to(walk, id, &stop)) continue;
        click_stop(walk, which, &stop);
        if (find(walk, items[i].id, &item)) by_pointer(walk, &item);
        see_messages(walk, &stop, "an entry of its list");
        back_to(walk, base);
        rows_changed++;
    }
    popups_opened += count > 0;
}

static void change_row(Walk *walk, unsigned id, const Base *base)
{
    WrKeyStop stop;
    if (!come_to(walk, id, &stop)) return;
    hover(walk, &stop);
    by_keys(walk, &stop);
    rows_of_document += wr_session_history_position(walk->session) != base->position;
    back_to(walk, base);
    if (!come_to(walk, id, &stop)) return;
    by_pointer(walk, &stop);
    back_to(walk, base);
    change_popup(walk, id, SDL_BUTTON_RIGHT, base);
    if (stop.kind == WR_STOP_PRESS) change_popup(walk, id, SDL_BUTTON_LEFT, base);
    rows_changed++;
}

/* ---- one place ---- */

/* The rows of the open place; of a dialog, its own. */
static int list_rows(Walk *walk, WrKeyStop *out)
{
    int count, n = 0;
    settle(walk);
    settle(walk);
    const WrKeyStop *now = wr_gui_stops(walk->app->gui, &count);
    if (count > MAX_ROWS) fail_msg("%s: too many rows", walk->where);
    for (int i = 0; i < count; i++)
        if (now[i].kind != WR_STOP_MENU && now[i].kind != WR_STOP_TAB) out[n++] = now[i];
    return n;
}

/* The rows not seen at an earlier place. */
static int list_new(Walk *walk, WrKeyStop *out)
{
    static WrKeyStop all[MAX_ROWS];
    const int count = list_rows(walk, all);
    int n = 0;
    for (int i = 0; i < count; i++)
        if (is_new(all[i].id)) out[n++] = all[i];
    return n;
}

static bool is_of_list(const WrKeyStop *row)
{
    return row->kind == WR_STOP_LIST || row->kind == WR_STOP_ROW || row->kind == WR_STOP_TILE;
}

/* Of a long list, such as that of the hard cases, every seventh after the first ones; all with WR_FULL. */
static void change_rows(Walk *walk, const WrKeyStop *rows, int count)
{
    enum { FIRST = 40, FIRST_OF_LIST = 4, STEP = 7 };
    const Base base = base_of(walk);
    int listed = 0;
    forget_messages(walk);
    for (int i = 0; i < count; i++) {
        const bool is_first = is_of_list(&rows[i]) ? listed++ < FIRST_OF_LIST : i < FIRST;
        if (is_first || i % STEP == 0 || i == count - 1 || getenv("WR_FULL"))
            change_row(walk, rows[i].id, &base);
    }
}

/* Rows near a choice belong to the object whose kind it sets. Of the others some are changed, all with WR_FULL. */
static void change_again(Walk *walk, const WrKeyStop *rows, int count, int choice, int step)
{
    const Base base = base_of(walk);
    for (int i = 0; i < count; i++)
        if (abs(i - choice) <= 5 || (i + step) % 41 == 0 || getenv("WR_FULL"))
            change_row(walk, rows[i].id, &base);
}

/* Each choice of the panel at each of its items: rows shown then are changed as well. Kinds have rows of the same
   names, so the panel's other rows are changed again. */
static void change_kinds(Walk *walk, const WrKeyStop *rows, int count)
{
    static WrKeyStop fresh[MAX_ROWS];
    WrKeyStop stop;
    const Base base = base_of(walk);
    char place[sizeof walk->where];
    snprintf(place, sizeof place, "%s", walk->where);
    for (int i = 0; i < count; i++) {
        if (rows[i].kind != WR_STOP_CHOICE) continue;
        for (int step = 1; step < MAX_STEPS; step++) {
            uint64_t before = 0;
            bool there = come_to(walk, rows[i].id, &stop);
            for (int k = 0; k < step && there; k++) {
                before = wr_session_revision(walk->session);
                tap(walk, SDL_SCANCODE_DOWN);
            }
            if (!there || wr_session_revision(walk->session) == before) break;
            snprintf(walk->where, sizeof walk->where, "%.50s, after: %.60s", place,
                     wr_session_last_command(walk->session));
            change_rows(walk, fresh, list_new(walk, fresh));
            change_again(walk, rows, count, i, step);
            back_to(walk, &base);
        }
        back_to(walk, &base);
    }
    snprintf(walk->where, sizeof walk->where, "%s", place);
}

static void examine(Walk *walk)
{
    dialogs_seen[walk->app->dialog->now] = true;
    static WrKeyStop rows[MAX_ROWS];
    const double began = (double)clock() / CLOCKS_PER_SEC;
    const int before = rows_changed;
    const bool scene =
        walk->open == walk_open_tab && walk->which == wr_tab_find(walk->app, "Scene");
    const int count = list_new(walk, rows);
    change_rows(walk, rows, count);
    if (scene) change_kinds(walk, rows, count);
    if (getenv("WR_ROWS_TIMES"))
        printf("%s: %d rows, %.1f s\n", walk->where, rows_changed - before,
               (double)clock() / CLOCKS_PER_SEC - began);
    fflush(stdout);
}

/* Objects added by a line, not by a choice of the panel. */
static bool open_with(Walk *walk, int which)
{
    static const char *const lines[] = { "surface patches file=" WR_SOURCE_DIR "/samples/cube.bpt",
                                         "surface terrain layer=1", "colouring ramp of=table",
                                         "light clear", "object remove" };
    if (which >= (int)(sizeof lines / sizeof *lines)) return false;
    wr_tab_show(walk->app, "Scene");
    walk_run(walk, lines[which]);
    return walk_name(walk, "Scene with %s", lines[which]);
}

static void no_row_is_answered_by_an_error(void **state)
{
    (void)state;
    Walk walk;
    walk_open(&walk, "en");
    fill_again(&walk);
    wr_gui_reports_all = false;
    wr_gui_unseen = true;
    walk.shown = examine;
    walk_all(&walk);
    walk_each(&walk, open_with, NULL);
    printf("%d rows changed, %d of them the document; %d lists opened\n", rows_changed,
           rows_of_document, popups_opened);
    wr_gui_unseen = false;
    walk_close(&walk);
    for (int i = 0; i < WR_DIALOG_COUNT; i++)
        if (!dialogs_seen[i]) printf("dialog %d was not opened\n", i), complaints++;
    assert_int_equal(complaints, 0);
    assert_true(rows_changed > 500 && rows_of_document > 200 && places_compared > 1000);
}

/* ---- actions, menus ---- */

/* Documents in which actions are run: an action that needs more than they have must be disabled. */
static const char *const states[][8] = {
    { "table 32x32" },
    { "table 32x32 wrap=clamp" },
    { "table 32x32", "layer add", "layer set 2 lock=on" },
    { "table 32x32", "layer add", "layer set 2 visible=off" },
    { "table 32x32", "filter blur sigma=2" },
    { "table 32x32", "layer add", "layer mask 2 from=white", "layer use 2 part=mask" },
    { "table 32x32", "layer add", "layer use 1", "select rect from=0.2,0.2 to=0.7,0.7" },
    { "table 32x32", "layer add", "layer set 2 lock=on", "layer use 1" },
    { "table 32x32", "select rect from=0.2,0.2 to=0.7,0.7", "select none", "undo" },
    { "table 32x32", "surface plane", "object add second at=2,0,0", "light clear" },
    { "table 1x1" },
};

static void take_state(Walk *walk, int which)
{
    wr_session_reset(walk->session);
    for (int i = 0; i < 8 && states[which][i]; i++) {
        walk_run(walk, states[which][i]);
        snprintf(walk->where, sizeof walk->where, "document %d: %.90s", which, states[which][i]);
    }
    for (const WrPart *const *p = walk->app->registry->parts; *p; p++)
        if ((*p)->another) (*p)->another(walk->app);
    settle(walk);
    forget_messages(walk);
}

static void run_action(Walk *walk, const char *name, Base *base)
{
    const WrKeyStop none = { .kind = WR_STOP_ITEM };
    wr_action_run(walk->app, name);
    settle(walk);
    dialogs_seen[walk->app->dialog->now] = true;
    see_messages(walk, &none, name);
    walk->app->quit = false;
    base->tool = walk->app->tool;
    base->tab = walk->app->settings->tab;
    back_to(walk, base);
}

static void no_action_is_answered_by_an_error(void **state)
{
    (void)state;
    Walk walk;
    const int step = test_step(3, 6); /* each action in some of the documents */
    int count = 0;
    complaints = 0;
    walk_open(&walk, "en");
    wr_gui_reports_all = false;
    wr_gui_unseen = true;
    for (int i = 0; i < (int)(sizeof states / sizeof *states); i++) {
        take_state(&walk, i);
        Base base = base_of(&walk);
        for (const WrAction *a = walk.app->registry->actions; a->name; a++) {
            if ((a - walk.app->registry->actions + i) % step != 0) continue;
            if (wr_session_history_count(walk.session) < base.position) take_state(&walk, i);
            if (!wr_action_can(walk.app, a)) continue;
            run_action(&walk, a->name, &base);
            count++;
        }
    }
    printf("%d actions\n", count);
    wr_gui_unseen = false;
    walk_close(&walk);
    assert_int_equal(complaints, 0);
}

/* ---- menus ---- */

#define MENU_LEVELS 3

static int items_pressed;

/* Click through the menus of the path; out: the entries of the last one. */
static int open_menus(Walk *walk, const unsigned *path, int levels, WrKeyStop *out)
{
    static WrKeyStop before[MAX_ROWS];
    int known_before = 0;
    WrKeyStop stop;
    for (int i = 0; i < levels; i++) {
        const WrKeyStop *stops = wr_gui_stops(walk->app->gui, &known_before);
        memcpy(before, stops, (size_t)known_before * sizeof *before);
        if (!find(walk, path[i], &stop)) return 0;
        click_stop(walk, SDL_BUTTON_LEFT, &stop);
    }
    return list_added(walk, before, known_before, out, MAX_ROWS);
}

static void after_item(Walk *walk, const WrKeyStop *item, const char *act)
{
    settle(walk);
    dialogs_seen[walk->app->dialog->now] = true;
    see_messages(walk, item, act);
    walk->app->quit = false;
    if (walk->app->settings->scale != 0.0) wr_app_set_scale(walk->app, 0.0);
}

static void press_item(Walk *walk, const unsigned *path, int levels, const WrKeyStop *item,
                       const Base *base, bool by_key)
{
    static WrKeyStop items[MAX_ROWS];
    WrKeyStop stop;
    Base now = *base;
    open_menus(walk, path, levels, items);
    assert_true(find(walk, item->id, &stop));
    if (by_key) {
        assert_true(wr_gui_focus_on(walk->app->gui, item->id));
        tap(walk, SDL_SCANCODE_RETURN);
    } else {
        click_stop(walk, SDL_BUTTON_LEFT, &stop);
    }
    after_item(walk, item, by_key ? "the menu by keys" : "the menu");
    now.tool = walk->app->tool;
    now.tab = walk->app->settings->tab;
    back_to(walk, &now);
    items_pressed++;
}

static void walk_menu(Walk *walk, unsigned *path, int levels, const Base *base)
{
    WrKeyStop items[200];
    static WrKeyStop all[MAX_ROWS];
    int count = open_menus(walk, path, levels, all);
    if (count > 200) count = 200;
    memcpy(items, all, (size_t)count * sizeof *items);
    close_lists(walk);
    for (int i = 0; i < count; i++) {
        snprintf(walk->where, sizeof walk->where, "menu %u entry %d", path[0], i);
        path[levels] = items[i].id;
        if (items[i].kind == WR_STOP_MENU && levels < MENU_LEVELS)
            walk_menu(walk, path, levels + 1, base);
        else press_item(walk, path, levels, &items[i], base, i % 2 == 1);
    }
}

static void no_menu_is_answered_by_an_error(void **state)
{
    (void)state;
    Walk walk;
    WrKeyStop titles[40];
    int count, n = 0;
    complaints = 0;
    walk_open(&walk, "en");
    fill_again(&walk);
    wr_gui_reports_all = false;
    wr_gui_unseen = true;
    settle(&walk);
    forget_messages(&walk);
    const Base base = base_of(&walk);
    const WrKeyStop *stops = wr_gui_stops(walk.app->gui, &count);
    for (int i = 0; i < count && n < 40; i++)
        if (stops[i].kind == WR_STOP_MENU) titles[n++] = stops[i];
    for (int i = 0; i < n; i++) {
        unsigned path[MENU_LEVELS + 1] = { titles[i].id };
        walk_menu(&walk, path, 1, &base);
    }
    printf("%d entries of %d menus\n", items_pressed, n);
    wr_gui_unseen = false;
    walk_close(&walk);
    assert_int_equal(complaints, 0);
    assert_true(n > 5 && items_pressed > 200);
}

/* ---- generators ---- */

/* A file for each generator that needs one. */
static void give_file(WrGenerateState *generate)
{
    const WrGenerator *generator = generate->generator;
    const bool mesh = strcmp(generator->family, "solid") == 0;
    for (int i = 0; generator->params[i].name; i++)
        if (generator->params[i].kind == WR_PARAM_FILE && !generator->params[i].fallback_text)
            wr_generate_set_text(&generate->value[i],
                                 mesh ? "cube.obj" : WR_SOURCE_DIR "/samples/wood-normal.jpg");
}

/* An answer that names the file: it lacks what the choice requires, such as alpha. */
static bool is_about_file(const Walk *walk)
{
    for (int i = 0; i < walk->app->messages->list.count; i++)
        if (strstr(walk->app->messages->list.data[i].text, "wood-normal.jpg: ")) return true;
    return false;
}

static void apply(Walk *walk, const WrKeyStop *stop)
{
    WrApp *app = walk->app;
    WrText line = { 0 };
    wr_generate_line(app->generate, &line);
    snprintf(walk->where, sizeof walk->where, "%.110s", wr_text_get(&line));
    wr_text_fini(&line);
    wr_generate_changed(app);
    settle(walk);
    wr_generate_commit(app);
    settle(walk);
    if (is_about_file(walk)) forget_messages(walk);
    else see_messages(walk, stop, "Apply");
}

/* Each word of each choice, each switch, each blend. */
static int apply_choices(Walk *walk, const WrGenerator *generator, const Base *base)
{
    const WrKeyStop stop = { .kind = WR_STOP_CHOICE };
    WrGenerateState *generate = walk->app->generate;
    int applied = 0;
    for (int i = 0; generator->params[i].name; i++) {
        const WrParam *p = &generator->params[i];
        int words = p->kind == WR_PARAM_SWITCH ? 2 : 0;
        while (p->kind == WR_PARAM_CHOICE && p->words[words]) words++;
        for (int w = i == 0 && words == 0 ? -1 : 0; w < words; w++) {
            wr_generate_open(walk->app, generator);
            wr_generate_defaults(walk->app);
            give_file(generate);
            if (w >= 0) generate->value[i].number[0] = w;
            apply(walk, &stop);
            back_to(walk, base);
            applied++;
        }
    }
    return applied;
}

/* cube.obj in the current folder, which is the test's. */
static void write_cube(void)
{
    FILE *file = fopen("cube.obj", "w");
    assert_non_null(file);
    for (int i = 0; i < 8; i++) fprintf(file, "v %d %d %d\n", i & 1, i >> 1 & 1, i >> 2);
    fputs("f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n", file);
    fclose(file);
}

static void every_kind_of_every_generator_is_applied(void **state)
{
    (void)state;
    Walk walk;
    int applied = 0;
    complaints = 0;
    walk_open(&walk, "en");
    walk_run(&walk, "table 32x32");
    walk_run(&walk, "layer mask 1 from=white");
    walk_run(&walk, "select rect from=0.2,0.2 to=0.7,0.7");
    write_cube();
    wr_gui_reports_all = false;
    wr_gui_unseen = true;
    settle(&walk);
    forget_messages(&walk);
    Base base = base_of(&walk);
    for (const WrFamily *f = wr_families; f->name; f++)
        for (const WrGenerator *g = f->rows; g->family; g++) {
            wr_generate_open(walk.app, g);
            settle(&walk);
            base.tool = walk.app->tool;
            base.tab = walk.app->settings->tab;
            applied += apply_choices(&walk, g, &base);
        }
    printf("%d times applied\n", applied);
    wr_gui_unseen = false;
    walk_close(&walk);
    assert_int_equal(complaints, 0);
    assert_true(applied > 100);
}

/* ---- places of rows ---- */

/* Every widget of the newer frame that the older one has is at the same height. */
static void assert_in_place(Walk *walk, const WrKeyStop *old, int old_count, const char *what)
{
    int count, moved = 0, same = 0;
    const WrKeyStop *stops = wr_gui_stops(walk->app->gui, &count);
    for (int i = 0; i < old_count; i++)
        for (int k = 0; k < count; k++) {
            if (stops[k].id != old[i].id) continue;
            same++;
            if (stops[k].y0 == old[i].y0) continue;
            moved++;
            printf("%s: a row moved from y %g to %g\n", what, (double)old[i].y0,
                   (double)stops[k].y0);
        }
    assert_int_equal(moved, 0);
    assert_true(same > 10);
}

static int rows_now(Walk *walk, WrKeyStop *out)
{
    int count;
    for (int i = 0; i < 3; i++) walk_frame(walk);
    const WrKeyStop *stops = wr_gui_stops(walk->app->gui, &count);
    assert_true(count <= MAX_ROWS);
    memcpy(out, stops, (size_t)count * sizeof *out);
    return count;
}

static const char long_reason[] = "the view cannot be measured: the eye is inside the object, "
                                  "where the reference has no picture; "
                                  "move the camera away from it, or reset it";

static void notes_of_generators_move_no_row(Walk *walk)
{
    static WrKeyStop rows[MAX_ROWS], after[MAX_ROWS];
    WrApp *app = walk->app;
    wr_action_run(app, "generate_pattern_bricks");
    settle(walk);
    wr_generate_cancel(app); /* the preview does not change err meanwhile */
    const int count = rows_now(walk, rows);
    wr_fail(&app->generate->err, "%s", long_reason);
    rows_now(walk, after);
    assert_in_place(walk, rows, count, "the note of a generator");
    app->generate->err.text[0] = '\0';
}

static void notes_of_accuracy_move_no_row(Walk *walk)
{
    static WrKeyStop rows[MAX_ROWS], after[MAX_ROWS];
    WrApp *app = walk->app;
    WrAccuracy *a = app->accuracy;
    walk_run(walk, "tolerance rms=0.004");
    wr_tab_show(app, "Accuracy");
    settle(walk);
    a->error_why.text[0] = '\0';
    a->full_times.chosen = (WrChosen){ 0 };
    const int count = rows_now(walk, rows);
    a->error_of = a->state;
    wr_fail(&a->error_why, "%s", long_reason);
    rows_now(walk, after);
    assert_in_place(walk, rows, count, "the error's reason");
    a->full_times.chosen = (WrChosen){ .any = true, .met = true };
    snprintf(a->full_times.chosen.reason, sizeof a->full_times.chosen.reason, "%s", long_reason);
    strcpy(a->full_times.chosen.line, "exact bspline-fit 16\xc3\x97"
                                      "16");
    rows_now(walk, after);
    assert_in_place(walk, rows, count, "the dials of a tolerance");
}

/* Rows of a dialog with a picture that needs no note, and with one that does. */
static void estimates_move_no_row(Walk *walk)
{
    static WrKeyStop rows[MAX_ROWS], after[MAX_ROWS];
    WrApp *app = walk->app;
    wr_action_run(app, "render");
    settle(walk);
    app->forms->picture_width = app->forms->picture_height = 32;
    const int count = rows_now(walk, rows);
    app->forms->picture_width = app->forms->picture_height = 16384;
    rows_now(walk, after);
    assert_in_place(walk, rows, count, "the estimate of a dialog");
    wr_dialog_close(app);
}

static void notes_keep_their_space(void **state)
{
    (void)state;
    Walk walk;
    walk_open(&walk, "en");
    wr_gui_reports_all = false;
    wr_gui_unseen = true;
    settle(&walk);
    notes_of_generators_move_no_row(&walk);
    notes_of_accuracy_move_no_row(&walk);
    wr_gui_unseen = false;
    walk_close(&walk);
    walk_open(&walk, "de"); /* longer texts */
    wr_gui_reports_all = false;
    wr_gui_unseen = true;
    wr_app_set_scale(walk.app, 3.0); /* little room */
    settle(&walk);
    estimates_move_no_row(&walk);
    wr_gui_unseen = false;
    walk_close(&walk);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(no_action_is_answered_by_an_error),
                                        cmocka_unit_test(no_menu_is_answered_by_an_error),
                                        cmocka_unit_test(every_kind_of_every_generator_is_applied),
                                        cmocka_unit_test(notes_keep_their_space),
                                        cmocka_unit_test(no_row_is_answered_by_an_error) };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

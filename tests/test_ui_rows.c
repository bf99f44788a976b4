/* Every row of every panel, option bar and dialog is changed once by keys and once by the pointer; an error message
   fails the test. The rows come from the window's list of widgets (ui/toolkit/focus.h), the kinds of lights,
   surfaces, materials and so on from their tables, so that new rows are tested automatically. */
#include "test.h"

#include "window_walk.h"

#include "scene/objects.h"
#include "scene/scene.h"
#include "shade/reflection.h"

#include "ui/state/busy.h"
#include "ui/state/deferred_actions.h"
#include "ui/state/messages.h"
#include "ui/toolkit/focus.h"

#include <time.h>

#define ROWS_MOST 2000
#define STEPS_MOST 40 /* steps through a list by keys */

static int rows_changed, rows_of_document, complaints;

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
        wr_busy_tend(app);
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

static void point(Walk *walk, double x, double y)
{
    wr_gui_event(walk->app->gui,
                 &(SDL_Event){ .motion = { .type = SDL_MOUSEMOTION, .x = (int)x, .y = (int)y } });
    walk_frame(walk);
}

static void button(Walk *walk, bool down, double x, double y)
{
    wr_gui_event(walk->app->gui,
                 &(SDL_Event){ .button = { .type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP,
                                           .button = SDL_BUTTON_LEFT,
                                           .state = down ? SDL_PRESSED : SDL_RELEASED,
                                           .clicks = 1,
                                           .x = (int)x,
                                           .y = (int)y } });
    walk_frame(walk);
}

static void click(Walk *walk, double x, double y)
{
    point(walk, x, y);
    button(walk, true, x, y);
    button(walk, false, x, y);
    settle(walk);
}

/* deferred work does not wait for a drawn frame */

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
    for (const WrPart *const *p = walk->app->roster->parts; *p; p++)
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
             !wr_session_go(walk->session, base->position, &err))
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

static void by_keys(Walk *walk, const WrKeyStop *stop)
{
    switch (stop->kind) {
    case WR_STOP_NUMBER:
        tap(walk, SDL_SCANCODE_RIGHT);
        tap(walk, SDL_SCANCODE_LEFT);
        see_messages(walk, stop, "an arrow on the number");
        type_number(walk, "1e12");
        see_messages(walk, stop, "the largest number typed");
        type_number(walk, "-1e12");
        see_messages(walk, stop, "the smallest number typed");
        tap(walk, SDL_SCANCODE_DELETE);
        break;
    case WR_STOP_CHOICE:
        for (int i = 0; i < STEPS_MOST; i++) {
            const uint64_t before = wr_session_revision(walk->session);
            tap(walk, SDL_SCANCODE_DOWN);
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
    default: tap(walk, SDL_SCANCODE_SPACE);
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
        point(walk, x, y);
        button(walk, true, x, y);
        for (int i = 1; i <= 4; i++) point(walk, x + 5 * i, y);
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

static void change_row(Walk *walk, unsigned id, const Base *base)
{
    WrKeyStop stop;
    if (!come_to(walk, id, &stop)) return;
    by_keys(walk, &stop);
    rows_of_document += wr_session_history_position(walk->session) != base->position;
    back_to(walk, base);
    if (!come_to(walk, id, &stop)) return;
    by_pointer(walk, &stop);
    back_to(walk, base);
    rows_changed++;
}

/* ---- one place ---- */

/* Menus, tool strip and status line are the same at every place: they are tested only at the first. */
static unsigned known[4 * ROWS_MOST];
static int known_count;

static bool is_new(unsigned id)
{
    for (int i = 0; i < known_count; i++)
        if (known[i] == id) return false;
    if (known_count < 4 * ROWS_MOST) known[known_count++] = id;
    return true;
}

/* The rows of the open place; of a dialog, its own. */
static int list_rows(Walk *walk, WrKeyStop *out)
{
    int count, n = 0;
    settle(walk);
    settle(walk);
    const WrKeyStop *now = wr_gui_stops(walk->app->gui, &count);
    if (count > ROWS_MOST) fail_msg("%s: too many rows", walk->where);
    for (int i = 0; i < count; i++)
        if (now[i].kind != WR_STOP_MENU && now[i].kind != WR_STOP_TAB) out[n++] = now[i];
    return n;
}

/* The rows not seen at an earlier place. */
static int list_new(Walk *walk, WrKeyStop *out)
{
    static WrKeyStop all[ROWS_MOST];
    const int count = list_rows(walk, all);
    int n = 0;
    for (int i = 0; i < count; i++)
        if (is_new(all[i].id)) out[n++] = all[i];
    return n;
}

static void change_rows(Walk *walk, const WrKeyStop *rows, int count)
{
    const Base base = base_of(walk);
    forget_messages(walk);
    for (int i = 0; i < count; i++) change_row(walk, rows[i].id, &base);
}

/* Rows near a choice belong to the object whose kind it sets. Of the others some are changed, all with WR_FULL. */
static void change_again(Walk *walk, const WrKeyStop *rows, int count, int choice, int step)
{
    const Base base = base_of(walk);
    for (int i = 0; i < count; i++)
        if (abs(i - choice) <= 8 || (i + step) % 9 == 0 || getenv("WR_FULL"))
            change_row(walk, rows[i].id, &base);
}

/* Each choice of the panel at each of its items: rows shown then are changed as well. Kinds have rows of the same
   names, so the panel's other rows are changed again. */
static void change_kinds(Walk *walk, const WrKeyStop *rows, int count)
{
    static WrKeyStop fresh[ROWS_MOST];
    WrKeyStop stop;
    const Base base = base_of(walk);
    char place[sizeof walk->where];
    snprintf(place, sizeof place, "%s", walk->where);
    for (int i = 0; i < count; i++) {
        if (rows[i].kind != WR_STOP_CHOICE) continue;
        for (int step = 1; step < STEPS_MOST; step++) {
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
    static WrKeyStop rows[ROWS_MOST];
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
    printf("%d rows changed, %d of them the document\n", rows_changed, rows_of_document);
    wr_gui_unseen = false;
    walk_close(&walk);
    assert_int_equal(complaints, 0);
    assert_true(rows_changed > 500 && rows_of_document > 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(no_row_is_answered_by_an_error) };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

/* Keyboard-only use: every widget that the pointer can reach can be reached by keys, in visual order, and none of
   them traps the keys. The pointer is moved over points of a Halton sequence; the widget below it comes from the
   widget library, independently of the list of stops. */
#include "test.h"

#include "window_walk.h"

#include "ui/app/state/action.h"
#include "ui/toolkit/focus.h"

#define STOPS_MAX 1500

static int complaints;

/* All faults are printed before the test fails. */
#define COMPLAIN(...) (complaints++ < 40 ? (void)printf(__VA_ARGS__) : (void)0)

static void send(Walk *walk, Uint32 type, SDL_Scancode code, Uint16 mod)
{
    SDL_Keysym keysym = { .scancode = code, .sym = SDL_GetKeyFromScancode(code), .mod = mod };
    wr_gui_event(walk->app->gui, &(SDL_Event){ .key = { .type = type, .keysym = keysym } });
}

/* Press a key, and draw frames until the window is idle. */
static void tap(Walk *walk, SDL_Scancode code, Uint16 mod)
{
    send(walk, SDL_KEYDOWN, code, mod);
    send(walk, SDL_KEYUP, code, mod);
    walk_frame(walk);
    for (int i = 0; i < 6 && wr_gui_unsettled(walk->app->gui); i++) walk_frame(walk);
}

static void point_at(Walk *walk, int x, int y)
{
    wr_gui_event(walk->app->gui, &(SDL_Event){ .motion = { SDL_MOUSEMOTION, .x = x, .y = y } });
    walk_frame(walk);
}

/* ---- one place ---- */

typedef struct Place {
    WrKeyStop stops[STOPS_MAX];
    bool reached[STOPS_MAX];
    int count;
} Place;

static int index_of(const Place *place, unsigned id)
{
    for (int i = 0; i < place->count; i++)
        if (place->stops[i].id == id) return i;
    return -1;
}

/* Collect the stops seen during a tour by keys: lists scroll meanwhile. */
static void gather(Walk *walk, Place *place)
{
    int count;
    const WrKeyStop *stops = wr_gui_stops(walk->app->gui, &count);
    for (int i = 0; i < count; i++) {
        int at = index_of(place, stops[i].id);
        if (at < 0 && place->count == STOPS_MAX) fail_msg("%s: too many stops", walk->where);
        if (at < 0) place->reached[at = place->count++] = false;
        place->stops[at] = stops[i];
    }
}

static void note_focus(Walk *walk, Place *place)
{
    unsigned now = wr_gui_focus_now(walk->app->gui);
    int at = index_of(place, now);
    if (!now || at < 0) {
        COMPLAIN("%s: the keys are nowhere\n", walk->where);
        return;
    }
    const WrKeyStop *stop = &place->stops[at];
    for (int i = 0; i < place->count; i++) /* arrow keys move along a group */
        if (i == at || (stop->group && place->stops[i].group == stop->group &&
                        place->stops[i].window == stop->window))
            place->reached[i] = true;
}

/* One tour by Tab, or by Shift+Tab. */
static void go_round(Walk *walk, Place *place, Uint16 mod)
{
    if (walk->app->dialog->now == WR_DIALOG_NONE) wr_gui_focus_part(walk->app->gui, 1);
    else tap(walk, SDL_SCANCODE_TAB, mod);
    walk_frame(walk);
    const unsigned first = wr_gui_focus_now(walk->app->gui);
    for (int n = 0; n < STOPS_MAX; n++) {
        gather(walk, place);
        note_focus(walk, place);
        tap(walk, SDL_SCANCODE_TAB, mod);
        if (wr_gui_focus_now(walk->app->gui) == first) return;
        if (n > place->count + 20) break;
    }
    COMPLAIN("%s: the keys do not come round\n", walk->where);
}

static double halton(int index, int base)
{
    double part = 1.0, sum = 0.0;
    for (int i = index; i > 0; i /= base) {
        part /= base;
        sum += part * (i % base);
    }
    return sum;
}

static void find_by_pointer(Walk *walk, const Place *place, int points)
{
    static int next;
    for (int n = 0; n < points; n++) {
        next++;
        point_at(walk, (int)(1280 * halton(next, 2)), (int)(800 * halton(next, 3)));
        unsigned id = wr_gui_under_pointer();
        if (id && index_of(place, id) < 0)
            COMPLAIN("%s: at %d,%d is something that the keys do not come to\n", walk->where,
                     (int)(1280 * halton(next, 2)), (int)(800 * halton(next, 3)));
    }
}

/* Equal names would make a widget act for another one. */
static void see_names(const Walk *walk)
{
    int count;
    const WrKeyStop *s = wr_gui_stops(walk->app->gui, &count);
    for (int i = 1; i < count; i++)
        for (int j = 0; j < i; j++)
            if (s[i].id == s[j].id)
                COMPLAIN("%s: what stands at %g,%g (kind %d) and at %g,%g have one name\n",
                         walk->where, s[j].x0, s[j].y0, s[j].kind, s[i].x0, s[i].y0);
}

/* Reading order: down, and to the right within a row. */
static void see_order(const Walk *walk)
{
    int count;
    const WrKeyStop *s = wr_gui_stops(walk->app->gui, &count);
    for (int i = 1; i < count; i++) {
        const WrKeyStop *a = &s[i - 1], *b = &s[i];
        if (a->window != b->window) continue;
        const bool above = b->y1 <= a->y0 + 1, left = b->x1 <= a->x0 + 1;
        const bool same_row = b->y0 < a->y1 - 1 && b->y1 > a->y0 + 1;
        if (above || (same_row && left))
            COMPLAIN("%s: after the one at %g,%g (kind %d) comes the one at %g,%g (kind %d)\n",
                     walk->where, a->x0, a->y0, a->kind, b->x0, b->y0, b->kind);
    }
}

static int places, stops_seen;

/* Of similar objects with equal panels only some are tested. */
static bool is_left_out(const Walk *walk)
{
    static const char *const alike[] = { "generator", "surface", "dialog of adjust", "curves of" };
    static int seen;
    for (size_t i = 0; i < sizeof alike / sizeof *alike && !getenv("WR_FULL"); i++)
        if (strncmp(walk->where, alike[i], strlen(alike[i])) == 0) return ++seen % 9 != 0;
    return false;
}

static void examine(Walk *walk)
{
    static Place place;
    if (is_left_out(walk)) return;
    place.count = 0;
    for (int i = 0; i < 4 || (i < 12 && wr_gui_unsettled(walk->app->gui)); i++) walk_frame(walk);
    see_names(walk);
    see_order(walk);
    go_round(walk, &place, places % 2 ? KMOD_LSHIFT : 0);
    const int at = index_of(&place, wr_gui_focus_now(walk->app->gui));
    const bool modal = walk->app->dialog->now != WR_DIALOG_NONE;
    const unsigned dialog = modal && at >= 0 ? place.stops[at].part : 0;
    for (int i = 0; i < place.count; i++)
        if (!place.reached[i] && (!dialog || place.stops[i].part == dialog))
            COMPLAIN("%s: the keys pass by what stands at %g,%g (kind %d)\n", walk->where,
                     place.stops[i].x0, place.stops[i].y0, place.stops[i].kind);
    find_by_pointer(walk, &place, test_amount(15, 37));
    places++;
    stops_seen += place.count;
    if (modal) return;
    for (int i = 0; i < 3 && wr_gui_focus_now(walk->app->gui); i++)
        tap(walk, SDL_SCANCODE_ESCAPE, 0);
    if (wr_gui_focus_now(walk->app->gui) || wr_gui_wants_text(walk->app->gui))
        COMPLAIN("%s: Escape does not lead to the canvas\n", walk->where);
}

static void the_keys_come_to_all_that_the_pointer_finds(void **state)
{
    (void)state;
    Walk walk;
    walk_open(&walk, "en");
    wr_gui_reports_all = false;
    wr_gui_unseen = true;
    walk.shown = examine;
    walk_all(&walk);
    wr_gui_unseen = false;
    printf("%d places, %d stops\n", places, stops_seen);
    assert_int_equal(complaints, 0);
    assert_true(places > 50 && stops_seen > 50 * 40);
    walk_close(&walk);
}

/* ---- effect of keys ---- */

static void enter_bench(Walk *walk)
{
    walk_open(walk, "en");
    wr_gui_reports_all = false;
    wr_gui_unseen = true;
    for (int i = 0; i < 4; i++) walk_frame(walk);
}

static void leave_bench(Walk *walk)
{
    wr_gui_unseen = false;
    walk_close(walk);
}

/* Press Tab until the nth stop of a kind has the ring. */
static WrKeyStop come_to(Walk *walk, WrKeyStopKind kind, int nth)
{
    if (!wr_gui_focus_now(walk->app->gui)) {
        wr_gui_focus_part(walk->app->gui, 1);
        walk_frame(walk);
    }
    for (int n = 0; n < 400; n++) {
        int count;
        const WrKeyStop *s = wr_gui_stops(walk->app->gui, &count);
        for (int i = 0; i < count; i++)
            if (s[i].id == wr_gui_focus_now(walk->app->gui) && s[i].kind == kind && nth-- == 0)
                return s[i];
        tap(walk, SDL_SCANCODE_TAB, 0);
    }
    fail_msg("no stop of kind %d", (int)kind);
    return (WrKeyStop){ 0 };
}

static void arrows_move_numbers_and_a_press_types_into_them(void **state)
{
    (void)state;
    Walk walk;
    enter_bench(&walk);
    WrBrush *brush = &walk.app->settings->brush;
    brush->hardness = 0.5;
    come_to(&walk, WR_STOP_NUMBER, 1); /* the brush's size comes before it */
    for (int i = 0; i < 3; i++) send(&walk, SDL_KEYDOWN, SDL_SCANCODE_RIGHT, 0);
    send(&walk, SDL_KEYUP, SDL_SCANCODE_RIGHT, 0);
    for (int i = 0; i < 6; i++) walk_frame(&walk);
    assert_float_equal(brush->hardness, 0.53, 1e-12); /* three hundredths of 0..1 */
    tap(&walk, SDL_SCANCODE_DOWN, 0);
    assert_float_equal(brush->hardness, 0.52, 1e-12);
    tap(&walk, SDL_SCANCODE_RETURN, 0);
    for (int i = 0; i < 3; i++) walk_frame(&walk);
    assert_true(wr_gui_wants_text(walk.app->gui));
    wr_gui_event(walk.app->gui, &(SDL_Event){ .text = { SDL_TEXTINPUT, .text = "0.7" } });
    walk_frame(&walk);
    /* the typed value is applied, and the next field has the ring */
    tap(&walk, SDL_SCANCODE_TAB, 0);
    for (int i = 0; i < 3; i++) walk_frame(&walk);
    assert_float_equal(brush->hardness, 0.7, 1e-12);
    assert_false(wr_gui_wants_text(walk.app->gui));
    tap(&walk, SDL_SCANCODE_TAB, KMOD_LSHIFT);
    tap(&walk, SDL_SCANCODE_DELETE, 0);
    assert_float_equal(brush->hardness, 0.5, 1e-12); /* as Ctrl+click resets it */
    leave_bench(&walk);
}

/* A drag of many steps is one change of the scene, and so is a held arrow key. */
static void a_held_arrow_is_one_step_of_the_history(void **state)
{
    (void)state;
    Walk walk;
    enter_bench(&walk);
    wr_tab_show(walk.app, "Scene");
    walk_frame(&walk);
    WrKeyStop stop = come_to(&walk, WR_STOP_NUMBER, 0);
    while (stop.x0 < 1000 || stop.y0 < 90) { /* in the right panel */
        tap(&walk, SDL_SCANCODE_TAB, 0);
        stop = come_to(&walk, WR_STOP_NUMBER, 0);
    }
    uint64_t before = 0;
    /* a value whose preview is live */
    for (int n = 0; n < 12 && !walk.app->live; n++) {
        tap(&walk, SDL_SCANCODE_TAB, 0);
        come_to(&walk, WR_STOP_NUMBER, 0);
        before = wr_session_revision(walk.session);
        for (int i = 0; i < 5; i++) {
            send(&walk, SDL_KEYDOWN, SDL_SCANCODE_RIGHT, 0);
            walk_frame(&walk);
        }
    }
    assert_true(wr_session_revision(walk.session) == before);
    assert_non_null(walk.app->live);
    send(&walk, SDL_KEYUP, SDL_SCANCODE_RIGHT, 0);
    for (int i = 0; i < 3; i++) walk_frame(&walk);
    assert_true(wr_session_revision(walk.session) == before + 1);
    leave_bench(&walk);
}

static void only_what_a_widget_needs_is_taken_from_the_canvas(void **state)
{
    (void)state;
    Walk walk;
    enter_bench(&walk);
    WrGui *gui = walk.app->gui;
    static const SDL_Scancode its[] = { SDL_SCANCODE_TAB, SDL_SCANCODE_RIGHT, SDL_SCANCODE_SPACE,
                                        SDL_SCANCODE_RETURN };
    static const SDL_Scancode not_its[] = { SDL_SCANCODE_B, SDL_SCANCODE_LEFTBRACKET,
                                            SDL_SCANCODE_1, SDL_SCANCODE_F2, SDL_SCANCODE_DELETE };
    for (int shown = 0; shown < 2; shown++) {
        for (size_t i = 0; i < sizeof its / sizeof *its; i++) {
            send(&walk, SDL_KEYDOWN, its[i], 0);
            assert_int_equal(wr_gui_took_key(gui), shown);
            send(&walk, SDL_KEYUP, its[i], 0);
        }
        for (size_t i = 0; i < sizeof not_its / sizeof *not_its; i++) {
            send(&walk, SDL_KEYDOWN, not_its[i], 0);
            assert_false(wr_gui_took_key(gui));
            send(&walk, SDL_KEYUP, not_its[i], 0);
        }
        send(&walk, SDL_KEYDOWN, SDL_SCANCODE_TAB, KMOD_LCTRL);
        assert_false(wr_gui_took_key(gui));
        for (int i = 0; i < 8; i++) walk_frame(&walk);
        if (!shown) come_to(&walk, WR_STOP_PRESS, 2);
    }
    SDL_Event press = { .button = { SDL_MOUSEBUTTONDOWN, .button = SDL_BUTTON_LEFT, .x = 5,
                                    .y = 5 } };
    wr_gui_event(gui, &press);
    assert_int_equal(wr_gui_focus_now(gui), 0); /* the keys belong to the canvas again */
    leave_bench(&walk);
}

static void keys_lead_through_the_menus(void **state)
{
    (void)state;
    Walk walk;
    enter_bench(&walk);
    WrGui *gui = walk.app->gui;
    WrCanvasDisplay *look = &walk.app->settings->look;
    look->shown = WR_CANVAS_HEIGHTS, look->colours = WR_CANVAS_GREY;
    for (int run = 0; run < 2; run++) {
        wr_gui_focus_menus(gui, true);
        for (int i = 0; i < 4; i++) walk_frame(&walk);
        assert_true(wr_gui_popup_open_now(gui));
        for (int i = 0; i < 8; i++) tap(&walk, SDL_SCANCODE_RIGHT, 0); /* from File to View */
        if (run == 0) tap(&walk, SDL_SCANCODE_RIGHT, 0); /* its first entry is a menu */
        for (int i = 0; i < 4; i++) walk_frame(&walk);
        tap(&walk, SDL_SCANCODE_DOWN, 0); /* the second entry of that */
        if (run == 0) tap(&walk, SDL_SCANCODE_RETURN, 0);
        for (int i = 0; i < 4 && run == 0; i++) walk_frame(&walk);
        if (run == 1) break;
        walk.app->visible = false; /* a hidden window does not wait for a frame */
        wr_deferred_run(walk.app);
        walk.app->visible = true;
        assert_int_equal(look->colours, WR_CANVAS_SIGNED);
        assert_false(wr_gui_popup_open_now(gui));
        assert_int_equal(wr_gui_focus_now(gui), 0); /* the canvas had the keys before */
    }
    assert_true(wr_gui_popup_open_now(gui));
    tap(&walk, SDL_SCANCODE_ESCAPE, 0);
    walk_frame(&walk);
    assert_false(wr_gui_popup_open_now(gui));
    assert_int_not_equal(wr_gui_focus_now(gui), 0); /* on the menu's title */
    tap(&walk, SDL_SCANCODE_ESCAPE, 0);
    assert_int_equal(wr_gui_focus_now(gui), 0);
    leave_bench(&walk);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrows_move_numbers_and_a_press_types_into_them),
        cmocka_unit_test(a_held_arrow_is_one_step_of_the_history),
        cmocka_unit_test(only_what_a_widget_needs_is_taken_from_the_canvas),
        cmocka_unit_test(keys_lead_through_the_menus),
        cmocka_unit_test(the_keys_come_to_all_that_the_pointer_finds),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

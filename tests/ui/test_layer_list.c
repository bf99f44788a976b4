/* The layers' list: which layers are chosen, where dragged rows land, and the list in a window without a display, where
   each action on several layers is one step of the history. */
#include "test.h"

#include "app.h"

#include "base/text.h"
#include "base/error.h"
#include "document/document.h"

#include "ui/app/state/chosen_layers.h"
#include "ui/app/state/session_view.h"
#include "ui/app/state/messages.h"
#include "ui/app/state/pointer_state.h"
#include "ui/app/state/registry.h"
#include "ui/app/state/settings.h"
#include "ui/app/state/action.h"
#include "ui/app/state/dialog.h"
#include "ui/canvas/view.h"
#include "ui/panels/panel_search.h"
#include "ui/panels/panels.h"
#include "ui/panels/layer_choice.h"
#include "ui/panels/layer_rows.h"
#include "ui/panels/panel_layers.h"
#include "ui/toolkit/focus.h"
#include "ui/toolkit/gui.h"

#include <string.h>

static void run(WrSession *session, const char *line)
{
    WrError err = { "" };
    if (!wr_session_run(session, line, &err)) fail_msg("%s: %s", line, err.text);
}

/* Layers a, b, c ... from the bottom. */
static void letters(WrSession *session, int count)
{
    char line[32];
    run(session, "table 32x24");
    run(session, "layer rename 1 a");
    for (int i = 1; i < count; i++) {
        snprintf(line, sizeof line, "layer add %c", 'a' + i);
        run(session, line);
    }
}

/* ---- the choice, without a window ---- */

/* Names of the chosen layers, the active one as a capital. */
static void print_chosen(const WrDocument *document, const WrChosenLayers *chosen, char *out)
{
    for (int i = 0; i < document->layer_count; i++) {
        if (!chosen->chosen[i]) continue;
        *out = document->layers[i].name[0];
        if (i == document->active) *out = (char)(*out - 'a' + 'A');
        out++;
    }
    *out = '\0';
}

typedef struct List {
    WrSession *session;
    WrChosenLayers chosen;
} List;

static void follow(List *list)
{
    wr_chosen_follow(&list->chosen, wr_session_document(list->session),
                     wr_session_last_command(list->session));
}

static void assert_chosen(List *list, const char *names)
{
    char text[WR_LAYERS_MAX + 1];
    follow(list);
    print_chosen(wr_session_document(list->session), &list->chosen, text);
    assert_string_equal(text, names);
}

static void pick(List *list, char name, WrChoosing how)
{
    char line[32];
    const WrDocument *document = wr_session_document(list->session);
    int index = 0;
    while (document->layers[index].name[0] != name) index++;
    follow(list);
    const int next = wr_chosen_pick(&list->chosen, document->active, index, how);
    snprintf(line, sizeof line, "layer use %d", next + 1);
    wr_chosen_expect_active(&list->chosen, next, list->chosen.chosen);
    if (next != document->active) run(list->session, line);
}

static void clicks_choose_as_in_other_programs(void **state)
{
    (void)state;
    List list = { .session = wr_session_new(&(WrSessionOptions){ .outputs = false }) };
    letters(list.session, 7);
    assert_chosen(&list, "G");
    pick(&list, 'c', WR_CHOOSE_ONLY);
    assert_chosen(&list, "C");
    pick(&list, 'e', WR_CHOOSE_TOGGLE);
    assert_chosen(&list, "cE");
    pick(&list, 'a', WR_CHOOSE_TOGGLE);
    assert_chosen(&list, "Ace");
    pick(&list, 'e', WR_CHOOSE_TOGGLE); /* not the active one */
    assert_chosen(&list, "Ac");
    pick(&list, 'a', WR_CHOOSE_TOGGLE);
    assert_chosen(&list, "C");
    pick(&list, 'c', WR_CHOOSE_TOGGLE); /* the only one stays */
    assert_chosen(&list, "C");
    pick(&list, 'f', WR_CHOOSE_RANGE);
    assert_chosen(&list, "cdeF");
    pick(&list, 'b', WR_CHOOSE_RANGE); /* from the same end */
    assert_chosen(&list, "Bc");
    pick(&list, 'g', WR_CHOOSE_TOGGLE);
    pick(&list, 'e', WR_CHOOSE_RANGE);
    assert_chosen(&list, "Efg");
    pick(&list, 'f', WR_CHOOSE_ONLY);
    assert_chosen(&list, "F");
    wr_chosen_free(&list.chosen);
    wr_session_free(list.session);
}

static void chosen_layers_stay_chosen_while_others_change(void **state)
{
    (void)state;
    List list = { .session = wr_session_new(&(WrSessionOptions){ .outputs = false }) };
    letters(list.session, 6);
    pick(&list, 'b', WR_CHOOSE_ONLY);
    pick(&list, 'd', WR_CHOOSE_TOGGLE);
    run(list.session, "layer move b to=6");
    assert_chosen(&list, "Db");
    run(list.session, "layer move c to=1");
    assert_chosen(&list, "Db");
    run(list.session, "undo 2");
    assert_chosen(&list, "bD");
    run(list.session, "layer delete a,e");
    assert_chosen(&list, "bD");
    run(list.session, "layer delete d"); /* the active one: the one below becomes active */
    assert_chosen(&list, "C");
    run(list.session, "undo");
    assert_chosen(&list, "D");
    pick(&list, 'f', WR_CHOOSE_RANGE);
    run(list.session, "layer add x above=d");
    assert_chosen(&list, "X");
    run(list.session, "layer use f");
    assert_chosen(&list, "F");
    wr_chosen_free(&list.chosen);
    wr_session_free(list.session);
}

/* ---- drop places ---- */

/* The list from the top with the moved layers, in their order, put before place `gap`. */
static void drop_in_list(const char *list, const bool *moved, int gap, char *out)
{
    const int count = (int)strlen(list);
    int n = 0;
    for (int half = 0; half < 2; half++) {
        for (int r = half ? gap : 0; r < (half ? count : gap); r++)
            if (!moved[list[r] - 'a']) out[n++] = list[r];
        for (int r = 0; r < count && !half; r++)
            if (moved[list[r] - 'a']) out[n++] = list[r];
    }
    out[n] = '\0';
}

static void print_list(const WrSession *session, char *out)
{
    const WrDocument *document = wr_session_document(session);
    for (int i = document->layer_count - 1; i >= 0; i--) *out++ = document->layers[i].name[0];
    *out = '\0';
}

#define DROPPED 5

/* Every set of five layers, at every place. */
static void dropped_layers_land_at_the_line(void **state)
{
    (void)state;
    WrSession *session = wr_session_new(&(WrSessionOptions){ .outputs = false });
    letters(session, DROPPED);
    for (int set = 1; set < 1 << DROPPED; set++)
        for (int step = -1; step <= 4 * DROPPED + 2; step++) {
            const double y = 0.25 * step + 0.05; /* not at a half */
            const int gap = (int)fmin(fmax(floor(y + 0.5), 0), DROPPED);
            bool moved[WR_LAYERS_MAX] = { false };
            char right[DROPPED + 1], before[DROPPED + 1], after[DROPPED + 1], line[64];
            WrText layers = { 0 };
            for (int i = 0; i < DROPPED; i++) moved[i] = set >> i & 1;
            print_list(session, before);
            drop_in_list(before, moved, gap, right);
            const WrDocument *document = wr_session_document(session);
            const WrLayerRows rows = wr_layer_rows(document);
            const WrLayerBlock block = wr_layer_block(document, moved);
            const WrLayerDrop drop = wr_layer_drop(document, &rows, &block, y);
            assert_true(drop.line == gap);
            assert_int_equal(drop.to == 0, strcmp(before, right) == 0);
            if (!drop.to) continue;
            wr_layers_print(moved, &layers);
            snprintf(line, sizeof line, "layer move %s to=%d", wr_text_get(&layers), drop.to);
            run(session, line);
            print_list(session, after);
            assert_string_equal(after, right);
            run(session, "undo");
            wr_text_fini(&layers);
        }
    wr_session_free(session);
}

/* ---- groups ---- */

/* A document as an outline: rows from the top with their depths. */
typedef struct Outline {
    char name[40];
    int depth[40];
    bool closed[40]; /* a collapsed group */
    bool group[40];
    int count;
} Outline;

static Outline outline_of(const WrSession *session)
{
    const WrDocument *document = wr_session_document(session);
    Outline o = { .count = 0 };
    for (int i = document->layer_count - 1; i >= 0; i--) {
        const WrLayer *layer = &document->layers[i];
        o.name[o.count] = layer->name[0];
        o.group[o.count] = layer->is_group;
        o.closed[o.count] = layer->collapsed;
        o.depth[o.count++] = layer->depth;
    }
    return o;
}

static void add_rows(Outline *to, const Outline *from, int row, int end, int deeper)
{
    for (; row < end; row++) {
        to->name[to->count] = from->name[row];
        to->group[to->count] = from->group[row];
        to->closed[to->count] = from->closed[row];
        to->depth[to->count++] = from->depth[row] + deeper;
    }
}

/* End of a row with its members. */
static int end_of(const Outline *o, int row)
{
    int end = row + 1;
    while (end < o->count && o->depth[end] > o->depth[row]) end++;
    return end;
}

/* Which rows move, members of moved groups too; roots: those that are in no moved group. */
static void spread(const Outline *o, const bool *set, bool *moves, bool *roots)
{
    for (int r = 0; r < o->count; r++) moves[r] = roots[r] = false;
    for (int r = 0; r < o->count; r++) {
        if (!set[r] || moves[r]) continue;
        roots[r] = true;
        for (int k = r; k < end_of(o, r); k++) moves[k] = true;
    }
}

/* The outline with the set moved before row `at` (o->count: the end), in depth `depth`. */
static Outline with_moved(const Outline *o, const bool *set, int at, int depth)
{
    Outline out = { .count = 0 };
    bool moves[40], roots[40];
    spread(o, set, moves, roots);
    for (int r = 0; r <= o->count; r++) {
        for (int k = 0; r == at && k < o->count; k++)
            if (roots[k]) add_rows(&out, o, k, end_of(o, k), depth - o->depth[k]);
        if (r < o->count && !moves[r]) add_rows(&out, o, r, r + 1, 0);
    }
    return out;
}

/* The outline after a drop of the set at y, with the rows that are shown. False: it must not be there. */
static bool expect_drop(const Outline *o, const bool *set, double y, Outline *out)
{
    int shown[40], count = 0;
    bool moves[40], roots[40];
    spread(o, set, moves, roots);
    for (int r = 0; r < o->count; r = o->closed[r] ? end_of(o, r) : r + 1) shown[count++] = r;
    if (y >= count) return *out = with_moved(o, set, o->count, 0), true;
    const int row = shown[y < 0 ? 0 : (int)y];
    const double part = y < 0 ? 0 : y - (int)y;
    const bool above = part < (o->group[row] ? 0.25 : 0.5);
    const bool into = !above && o->group[row] && (part < 0.75 || !o->closed[row]);
    if (into ? moves[row] : moves[row] && !roots[row]) return false;
    *out = with_moved(o, set, above ? row : into ? row + 1 : end_of(o, row), o->depth[row] + into);
    return true;
}

static bool same_outline(const Outline *a, const Outline *b)
{
    return a->count == b->count && memcmp(a->name, b->name, (size_t)a->count) == 0 &&
           memcmp(a->depth, b->depth, (size_t)a->count * sizeof *a->depth) == 0;
}

/* Groups at random, some of them collapsed, one without layers. */
static WrSession *random_tree(TestRandom *random)
{
    WrSession *session = wr_session_new(&(WrSessionOptions){ .outputs = false });
    char line[64];
    letters(session, 7);
    for (int g = 0; g < 4; g++) {
        const int count = wr_session_document(session)->layer_count;
        const int low = 1 + (int)(test_random(random) * count);
        const int high = low + (int)(test_random(random) * 3);
        snprintf(line, sizeof line, "layer group %c of=%d..%d", 'G' + g, low,
                 high > count ? count : high);
        run(session, line);
        if (test_random(random) < 0.3) {
            snprintf(line, sizeof line, "layer set %c collapsed=on", 'G' + g);
            run(session, line);
        }
    }
    run(session, "layer add y above=g");
    run(session, "layer group Y of=y");
    run(session, "layer delete y");
    return session;
}

static void run_drop(WrSession *session, const bool *moved, const WrLayerDrop *drop)
{
    char group[16] = "none";
    WrText line = { 0 };
    if (drop->in >= 0) snprintf(group, sizeof group, "%d", drop->in + 1);
    wr_text_add(&line, "layer move ");
    wr_layers_print(moved, &line);
    wr_text_addf(&line, " to=%d in=%s", drop->to, group);
    run(session, wr_text_get(&line));
    wr_text_fini(&line);
}

static void drops_into_and_out_of_groups(void **state)
{
    (void)state;
    TestRandom random = { 71 };
    int moves = 0, refused = 0;
    for (int t = 0; t < 60; t++) {
        WrSession *session = random_tree(&random);
        for (int n = 0; n < 60; n++) {
            const Outline before = outline_of(session);
            bool moved[WR_LAYERS_MAX] = { false }, set[40] = { false };
            for (int k = 0; k < 1 + n % 3; k++)
                set[(int)(test_random(&random) * before.count)] = true;
            for (int r = 0; r < before.count; r++) moved[before.count - 1 - r] = set[r];
            const double y = test_random(&random) * (before.count + 3) - 1;
            Outline right = before;
            const bool allowed = expect_drop(&before, set, y, &right);
            const WrDocument *document = wr_session_document(session);
            const WrLayerRows rows = wr_layer_rows(document);
            const WrLayerBlock block = wr_layer_block(document, moved);
            const WrLayerDrop drop = wr_layer_drop(document, &rows, &block, y);
            assert_int_equal(drop.to != 0, allowed && !same_outline(&before, &right));
            refused += !allowed;
            if (!drop.to) continue;
            moves++;
            run_drop(session, moved, &drop);
            const Outline after = outline_of(session);
            assert_true(same_outline(&after, &right));
            if (n % 4) run(session, "undo");
        }
        wr_session_free(session);
    }
    assert_true(moves > 1000 && refused > 100);
}

static bool step(WrSession *session, char name, int way)
{
    const WrDocument *document = wr_session_document(session);
    bool moved[WR_LAYERS_MAX] = { false };
    for (int i = 0; i < document->layer_count; i++) moved[i] = document->layers[i].name[0] == name;
    const WrLayerRows rows = wr_layer_rows(document);
    const WrLayerBlock block = wr_layer_block(document, moved);
    const WrLayerDrop drop = wr_layer_step(document, &rows, &block, way);
    if (drop.to) run_drop(session, moved, &drop);
    return drop.to != 0;
}

/* From the top to the bottom, through all groups that are shown, and back the same way. */
static void steps_lead_through_groups_and_back(void **state)
{
    (void)state;
    TestRandom random = { 9 };
    int steps = 0;
    for (int t = 0; t < 40; t++) {
        WrSession *session = random_tree(&random);
        Outline way[60];
        int count = 0;
        run(session, "layer add x");
        run(session, "layer move x to=13 in=none");
        assert_false(step(session, 'x', 1));
        do way[count++] = outline_of(session);
        while (count < 60 && step(session, 'x', -1));
        assert_in_range(count, 2, 40);
        const Outline *end = &way[count - 1];
        assert_true(end->name[end->count - 1] == 'x' && end->depth[end->count - 1] == 0);
        for (int i = count - 2; i >= 0; i--) {
            const WrDocument *document = wr_session_document(session);
            assert_int_equal(document->layer_count, way[i].count);
            assert_true(step(session, 'x', 1));
            const Outline now = outline_of(session);
            assert_true(same_outline(&now, &way[i]));
            steps++;
        }
        wr_session_free(session);
    }
    assert_true(steps > 200);
}

/* ---- the list in a window ---- */

static void open_list(Bench *bench, int count)
{
    begin(bench);
    letters(bench->session, count);
    bench->app->settings->lower = 0.9; /* six rows are visible */
    for (const WrPart *const *p = bench->app->registry->parts; *p; p++)
        if ((*p)->another) (*p)->another(bench->app);
    settle(bench);
}

/* Row n of the list, from the top. */
static WrKeyStop row(const Bench *bench, int n)
{
    int count;
    const WrKeyStop *stops = wr_gui_stops(bench->app->gui, &count);
    for (int i = 0; i < count; i++)
        if (stops[i].kind == WR_STOP_ROW && n-- == 0) return stops[i];
    fail_msg("the row is missing");
    return (WrKeyStop){ 0 };
}

static int middle(const Bench *bench, int n)
{
    const WrKeyStop stop = row(bench, n);
    return (int)(0.5f * (stop.y0 + stop.y1));
}

static int name_x(const Bench *bench)
{
    const WrKeyStop stop = row(bench, 0);
    return (int)(stop.x0 + 0.45f * (stop.x1 - stop.x0));
}

static int eye_x(const Bench *bench)
{
    return (int)row(bench, 0).x0 + wr_gui_px(20);
}

static void push_key(const WrApp *app, bool down, SDL_Scancode code, SDL_Keymod mod)
{
    SDL_PushEvent(&(SDL_Event){ .key = { .type = down ? SDL_KEYDOWN : SDL_KEYUP,
                                         .windowID = SDL_GetWindowID(app->window),
                                         .keysym = { .scancode = code,
                                                     .sym = SDL_GetKeyFromScancode(code),
                                                     .mod = (Uint16)mod } } });
}

static void hold(Bench *bench, bool down, SDL_Scancode code, SDL_Keymod mod)
{
    push_key(bench->app, down, code, down ? mod : KMOD_NONE);
    draw_again(bench->app);
}

static void tap(Bench *bench, SDL_Scancode code, SDL_Keymod mod)
{
    push_key(bench->app, true, code, mod);
    push_key(bench->app, false, code, mod);
    settle(bench);
}

static void press(Bench *bench, bool down, int which, int x, int y)
{
    push_motion(bench->app, x, y);
    draw_again(bench->app);
    push_button(bench->app, down, which, x, y);
    draw_again(bench->app);
}

static void click(Bench *bench, int n, SDL_Scancode code, SDL_Keymod mod)
{
    if (code) hold(bench, true, code, mod);
    press(bench, true, SDL_BUTTON_LEFT, name_x(bench), middle(bench, n));
    press(bench, false, SDL_BUTTON_LEFT, name_x(bench), middle(bench, n));
    if (code) hold(bench, false, code, mod);
    settle(bench);
}

static void click_eye(Bench *bench, int n)
{
    press(bench, true, SDL_BUTTON_LEFT, eye_x(bench), middle(bench, n));
    press(bench, false, SDL_BUTTON_LEFT, eye_x(bench), middle(bench, n));
    settle(bench);
}

/* Of the names, away from clicks before, so that none becomes a double click. */
static int drag_x(const Bench *bench)
{
    return name_x(bench) + wr_gui_px(24);
}

/* From x and the middle of row `from` to y, without the release. */
static void drag(Bench *bench, int x, int from, int y)
{
    const int start = middle(bench, from);
    press(bench, true, SDL_BUTTON_LEFT, x, start);
    for (int i = 1; i <= 6; i++) {
        push_motion(bench->app, x, start + (y - start) * i / 6);
        draw_again(bench->app);
    }
}

static void let_go(Bench *bench, int x, int y)
{
    press(bench, false, SDL_BUTTON_LEFT, x, y);
    settle(bench);
}

static void assert_list(const Bench *bench, const char *names, const char *chosen)
{
    char text[WR_LAYERS_MAX + 1];
    print_list(bench->session, text);
    assert_string_equal(text, names);
    print_chosen(wr_session_document(bench->session), wr_app_chosen(bench->app), text);
    assert_string_equal(text, chosen);
}

static int steps(const Bench *bench)
{
    return wr_session_history_position(bench->session);
}

static void assert_last(const Bench *bench, const char *line)
{
    assert_string_equal(wr_session_last_command(bench->session), line);
}

#define CTRL SDL_SCANCODE_LCTRL, KMOD_LCTRL
#define SHIFT SDL_SCANCODE_LSHIFT, KMOD_LSHIFT
#define PLAIN SDL_SCANCODE_UNKNOWN, KMOD_NONE

static void rows_are_chosen_by_clicks_and_keys(void **state)
{
    (void)state;
    Bench bench;
    open_list(&bench, 5);
    assert_list(&bench, "edcba", "E");
    click(&bench, 3, PLAIN);
    assert_list(&bench, "edcba", "B");
    click(&bench, 1, SHIFT);
    assert_list(&bench, "edcba", "bcD");
    click(&bench, 4, CTRL);
    assert_list(&bench, "edcba", "Abcd");
    click(&bench, 2, CTRL);
    assert_list(&bench, "edcba", "Abd");
    press(&bench, true, SDL_BUTTON_RIGHT, name_x(&bench), middle(&bench, 3)); /* keeps the choice */
    press(&bench, false, SDL_BUTTON_RIGHT, name_x(&bench), middle(&bench, 3));
    assert_true(wr_gui_popup_open_now(bench.app->gui));
    tap(&bench, SDL_SCANCODE_ESCAPE, KMOD_NONE);
    assert_list(&bench, "edcba", "Abd");
    click(&bench, 0, PLAIN);
    assert_list(&bench, "edcba", "E");

    assert_true(wr_gui_focus_on(bench.app->gui, row(&bench, 0).id));
    draw_again(bench.app);
    tap(&bench, SDL_SCANCODE_DOWN, KMOD_NONE);
    assert_list(&bench, "edcba", "D");
    tap(&bench, SDL_SCANCODE_DOWN, KMOD_LSHIFT);
    tap(&bench, SDL_SCANCODE_DOWN, KMOD_LSHIFT);
    assert_list(&bench, "edcba", "Bcd");
    tap(&bench, SDL_SCANCODE_UP, KMOD_LSHIFT);
    assert_list(&bench, "edcba", "Cd");
    tap(&bench, SDL_SCANCODE_A, KMOD_LCTRL);
    assert_list(&bench, "edcba", "abCde");
    assert_null(wr_session_document(bench.session)->selection);
    tap(&bench, SDL_SCANCODE_ESCAPE, KMOD_NONE); /* the keys belong to the canvas */
    tap(&bench, SDL_SCANCODE_A, KMOD_LCTRL);
    assert_non_null(wr_session_document(bench.session)->selection);
    finish(&bench);
}

static void actions_change_all_chosen_layers_in_one_step(void **state)
{
    (void)state;
    static const struct {
        const char *action, *line, *names, *chosen;
    } acts[] = {
        { "layer_duplicate", "layer duplicate 2,4", "fedcedbcba", NULL },
        { "layer_delete", "layer delete 2,4", "fecba", NULL },
        { "layer_show", "layer set 2,4 visible=off", "fedcba", "bD" },
        { "layer_lock", "layer set 2,4 lock=on", "fedcba", "bD" },
        { "layer_raise", "layer move 2,4 to=4", "fdbeca", "bD" },
        { "layer_lower", "layer move 2,4 to=1", "fecadb", "bD" },
        { "layer_clear", "layer clear 2,4", "fedcba", "bD" },
    };
    Bench bench;
    open_list(&bench, 6);
    for (size_t i = 0; i < sizeof acts / sizeof *acts; i++) {
        click(&bench, 4, PLAIN);
        click(&bench, 2, CTRL);
        assert_list(&bench, "fedcba", "bD");
        char label[WR_ACTION_LABEL];
        const WrAction *action = wr_action_find(bench.app, "layer_delete");
        assert_string_equal(wr_menu_label(bench.app, action, label), "Delete 2 layers");
        const int before = steps(&bench);
        wr_action_run(bench.app, acts[i].action);
        settle(&bench);
        assert_last(&bench, acts[i].line);
        assert_int_equal(steps(&bench), before + 1);
        if (acts[i].chosen) assert_list(&bench, acts[i].names, acts[i].chosen);
        wr_action_run(bench.app, "undo");
        settle(&bench);
    }
    const int before = steps(&bench);
    wr_action_run(bench.app, "layer_above");
    settle(&bench);
    assert_list(&bench, "fedcba", "E");
    assert_int_equal(steps(&bench), before); /* a choice is no step */
    finish(&bench);
}

/* A ramp has no sliders. */
static void the_line_of_a_ramp_opens_as_text(void **state)
{
    (void)state;
    WrError err;
    Bench bench;
    open_list(&bench, 2);
    assert_true(wr_session_run(bench.session,
                               "layer add r from=\"ramp linear from=0.25,0.5 to=0.75,0.5\"", &err));
    settle(&bench);
    wr_action_run(bench.app, "filter_edit");
    settle(&bench);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_SEARCH);
    assert_string_equal(bench.app->finder->text,
                        "layer set 3 from=\"ramp linear from=0.25,0.5 to=0.75,0.5\"");
    finish(&bench);
}

/* A drag of a point on the canvas, whatever the tool, is one change of the line. */
static void points_of_a_shape_are_dragged_on_the_canvas(void **state)
{
    (void)state;
    WrError err;
    Bench bench;
    open_list(&bench, 2);
    assert_true(wr_session_run(bench.session,
                               "layer add p from=\"shape polygon "
                               "points=0.3,0.4;0.7,0.45;0.5,0.8 paint=fill\"",
                               &err));
    settle(&bench);
    WrApp *app = bench.app;
    const WrCanvasView *view = app->view;
    const int before = steps(&bench);
    double x, y;
    wr_view_to_pixel(view, 0.7 * view->table_w, (1 - 0.45) * view->table_h, &x, &y);
    const int from[] = { (int)x, (int)y }, to[] = { (int)x - 31, (int)y - 17 };
    press(&bench, true, SDL_BUTTON_LEFT, from[0], from[1]);
    push_motion(app, to[0] + 5, to[1]);
    settle(&bench);
    press(&bench, false, SDL_BUTTON_LEFT, to[0], to[1]);
    settle(&bench);
    double u[3], v[3];
    const char *line = wr_session_document(bench.session)->layers[2].line;
    assert_non_null(line);
    assert_int_equal(sscanf(strstr(line, "points="), "points=%lf,%lf;%lf,%lf;%lf,%lf", &u[0], &v[0],
                            &u[1], &v[1], &u[2], &v[2]),
                     6);
    assert_float_equal(u[1], 0.7 - 31 / view->zoom / view->table_w, 1e-5);
    assert_float_equal(v[1], 0.45 + 17 / view->zoom / view->table_h, 1e-5);
    assert_true(u[0] == 0.3 && v[0] == 0.4 && u[2] == 0.5 && v[2] == 0.8);
    assert_int_equal(steps(&bench), before + 1);
    finish(&bench);
}

static void copies_are_chosen_and_merged(void **state)
{
    (void)state;
    Bench bench;
    open_list(&bench, 4);
    click(&bench, 3, PLAIN);
    char label[WR_ACTION_LABEL];
    const WrAction *action = wr_action_find(bench.app, "layer_delete");
    assert_string_equal(wr_menu_label(bench.app, action, label), "Delete layer");
    click(&bench, 1, CTRL);
    wr_action_run(bench.app, "layer_duplicate");
    settle(&bench);
    /* names begin with the same letters as those of the originals */
    assert_list(&bench, "dcacba", "aC");
    assert_true(wr_app_chosen(bench.app)->chosen[3] && wr_app_chosen(bench.app)->chosen[4]);
    const int before = steps(&bench);
    wr_action_run(bench.app, "layer_merge");
    settle(&bench);
    assert_last(&bench, "layer merge 4,5");
    assert_int_equal(steps(&bench), before + 1);
    assert_list(&bench, "dacba", "A");
    click(&bench, 0, PLAIN);
    click(&bench, 2, CTRL);
    wr_action_run(bench.app, "layer_merge"); /* refused, with the reason */
    settle(&bench);
    assert_list(&bench, "dacba", "Cd");
    const WrMessages *messages = bench.app->messages;
    assert_non_null(strstr(messages->list.data[messages->list.count - 1].text, "not neighbours"));
    finish(&bench);
}

static void eyes_of_several_layers(void **state)
{
    (void)state;
    Bench bench;
    open_list(&bench, 5);
    click(&bench, 1, PLAIN);
    click(&bench, 3, SHIFT);
    int before = steps(&bench);
    click_eye(&bench, 2); /* of a chosen row: all chosen */
    assert_last(&bench, "layer set 2,3,4 visible=off");
    click_eye(&bench, 0); /* of another row: itself */
    assert_last(&bench, "layer set 5 visible=off");
    assert_int_equal(steps(&bench), before + 2);
    assert_list(&bench, "edcba", "Bcd");
    before = steps(&bench);
    drag(&bench, eye_x(&bench), 4, middle(&bench, 2)); /* from the visible one upwards */
    assert_int_equal(steps(&bench), before);
    let_go(&bench, eye_x(&bench), middle(&bench, 2));
    assert_last(&bench, "layer set 1,2,3 visible=off");
    drag(&bench, eye_x(&bench), 1, middle(&bench, 3));
    let_go(&bench, eye_x(&bench), middle(&bench, 3));
    assert_last(&bench, "layer set 2,3,4 visible=on");
    assert_int_equal(steps(&bench), before + 2);
    drag(&bench, eye_x(&bench), 0, middle(&bench, 3));
    tap(&bench, SDL_SCANCODE_ESCAPE, KMOD_NONE);
    let_go(&bench, eye_x(&bench), middle(&bench, 3));
    assert_int_equal(steps(&bench), before + 2);
    assert_list(&bench, "edcba", "Bcd");
    finish(&bench);
}

static int edge_below(const Bench *bench, int n, int off)
{
    return (int)row(bench, n).y1 + off;
}

static void rows_are_dragged_together(void **state)
{
    (void)state;
    Bench bench;
    open_list(&bench, 5);
    click(&bench, 0, PLAIN);
    click(&bench, 2, CTRL);
    int before = steps(&bench);
    drag(&bench, drag_x(&bench), 2, edge_below(&bench, 3, -6));
    assert_true(bench.app->layers->dragged == 2 && bench.app->layers->drop.line == 4);
    let_go(&bench, drag_x(&bench), edge_below(&bench, 3, -6));
    assert_last(&bench, "layer move 3,5 to=2");
    assert_list(&bench, "dbeca", "Ce");
    drag(&bench, drag_x(&bench), 0, edge_below(&bench, 4, 3)); /* a row that is not chosen */
    let_go(&bench, drag_x(&bench), edge_below(&bench, 4, 3));
    assert_last(&bench, "layer move 5 to=1");
    assert_list(&bench, "becad", "Ce");
    assert_int_equal(steps(&bench), before + 2);
    drag(&bench, drag_x(&bench), 1, edge_below(&bench, 3, 5));
    tap(&bench, SDL_SCANCODE_ESCAPE, KMOD_NONE);
    assert_int_equal(bench.app->layers->dragged, -1);
    let_go(&bench, drag_x(&bench), edge_below(&bench, 3, 5));
    drag(&bench, drag_x(&bench), 1, edge_below(&bench, 2, -4)); /* its own place */
    let_go(&bench, drag_x(&bench), edge_below(&bench, 2, -4));
    assert_int_equal(steps(&bench), before + 2);
    assert_list(&bench, "becad", "Ce");
    finish(&bench);
}

static void groups_in_the_list(void **state)
{
    (void)state;
    Bench bench;
    open_list(&bench, 5);
    click(&bench, 1, PLAIN);
    click(&bench, 3, SHIFT);
    tap(&bench, SDL_SCANCODE_G, KMOD_LCTRL);
    assert_last(&bench, "layer group of=2,3,4"); /* d, c and b in "group 1" */
    assert_list(&bench, "egdcba", "G");
    drag(&bench, drag_x(&bench), 0, middle(&bench, 1));
    assert_int_equal(bench.app->layers->drop.row, 1);
    let_go(&bench, drag_x(&bench), middle(&bench, 1));
    assert_last(&bench, "layer move 6 to=5 in=5");
    assert_list(&bench, "gedcba", "G");
    drag(&bench, drag_x(&bench), 3, edge_below(&bench, 5, 8)); /* below the list */
    let_go(&bench, drag_x(&bench), edge_below(&bench, 5, 8));
    assert_last(&bench, "layer move 3 to=1 in=none");
    assert_list(&bench, "gedbac", "G");
    run(bench.session, "layer set 6 collapsed=on");
    settle(&bench);
    click(&bench, 0, PLAIN);
    click(&bench, 2, SHIFT); /* without the group's layers */
    assert_list(&bench, "gedbac", "Cag");
    click(&bench, 0, PLAIN);
    tap(&bench, SDL_SCANCODE_PAGEDOWN, KMOD_NONE);
    assert_list(&bench, "gedbac", "A");
    tap(&bench, SDL_SCANCODE_PAGEUP, KMOD_NONE);
    tap(&bench, SDL_SCANCODE_PAGEDOWN, KMOD_LCTRL);
    assert_last(&bench, "layer move 6 to=5 in=none");
    assert_list(&bench, "agedbc", "G");
    tap(&bench, SDL_SCANCODE_G, (SDL_Keymod)(KMOD_LCTRL | KMOD_LSHIFT));
    assert_last(&bench, "layer ungroup 5");
    finish(&bench);
}

static void a_drag_scrolls_at_the_edge(void **state)
{
    (void)state;
    Bench bench;
    open_list(&bench, 26);
    const WrKeyStop first = row(&bench, 0);
    click(&bench, 0, PLAIN);
    assert_true(wr_gui_focus_on(bench.app->gui, row(&bench, 0).id));
    settle(&bench);
    const int bottom = 700 - wr_gui_px(40); /* below the list, on its buttons */
    drag(&bench, drag_x(&bench), 0, bottom);
    float before = 0; /* until it is at its end */
    for (int i = 0, same = 0; i < 4000 && same < 100; i++) {
        const float now = row(&bench, 0).y0;
        same = now == before ? same + 1 : 0;
        before = now;
        draw_again(bench.app);
    }
    assert_true(row(&bench, 0).y0 < first.y0 - 300);
    let_go(&bench, drag_x(&bench), bottom);
    assert_last(&bench, "layer move 26 to=1");
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clicks_choose_as_in_other_programs),
        cmocka_unit_test(chosen_layers_stay_chosen_while_others_change),
        cmocka_unit_test(dropped_layers_land_at_the_line),
        cmocka_unit_test(drops_into_and_out_of_groups),
        cmocka_unit_test(steps_lead_through_groups_and_back),
        cmocka_unit_test(rows_are_chosen_by_clicks_and_keys),
        cmocka_unit_test(actions_change_all_chosen_layers_in_one_step),
        cmocka_unit_test(the_line_of_a_ramp_opens_as_text),
        cmocka_unit_test(points_of_a_shape_are_dragged_on_the_canvas),
        cmocka_unit_test(copies_are_chosen_and_merged),
        cmocka_unit_test(eyes_of_several_layers),
        cmocka_unit_test(rows_are_dragged_together),
        cmocka_unit_test(groups_in_the_list),
        cmocka_unit_test(a_drag_scrolls_at_the_edge),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

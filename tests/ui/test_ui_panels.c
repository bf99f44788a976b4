/* The side panel: folds, floating tabs, pinned rows and workspaces, by the pointer. */
#include "test.h"

#include "window_walk.h"

#include "ui/app/state/workspace.h"
#include "ui/toolkit/focus.h"

#include <math.h>
#include <string.h>

static void settle(Walk *walk)
{
    for (int i = 0; i < 4 || (i < 40 && wr_gui_unsettled(walk->app->gui)); i++) {
        walk_frame(walk);
        walk->app->visible = false; /* deferred work does not wait for a drawn picture */
        wr_deferred_run(walk->app);
        walk->app->visible = true;
    }
}

static void click(Walk *walk, Uint8 which, double x, double y)
{
    walk_point(walk, x, y);
    walk_button(walk, which, true, x, y);
    walk_button(walk, which, false, x, y);
    settle(walk);
}

static void drag(Walk *walk, double x, double y, double to_x, double to_y)
{
    walk_point(walk, x, y);
    walk_button(walk, SDL_BUTTON_LEFT, true, x, y);
    for (int i = 1; i <= 6; i++) walk_point(walk, x + (to_x - x) * i / 6, y + (to_y - y) * i / 6);
    walk_button(walk, SDL_BUTTON_LEFT, false, to_x, to_y);
    settle(walk);
}

static void open_scene(Walk *walk)
{
    walk_open(walk, "en");
    wr_gui_reports_all = wr_gui_folds_open = false;
    wr_gui_unseen = true;
    wr_tab_show(walk->app, "Scene");
    settle(walk);
}

static void close_scene(Walk *walk)
{
    wr_gui_unseen = false;
    walk_close(walk);
}

/* Stops of a kind in the area with the heading at (x, y). */
static int count_rows(Walk *walk, WrKeyStopKind kind, double x, double y)
{
    int count, rows = 0;
    unsigned area = 0;
    const WrKeyStop *s = wr_gui_stops(walk->app->gui, &count);
    for (int i = 0; i < count; i++)
        if (x > (double)s[i].x0 && x < (double)s[i].x1 && y > (double)s[i].y0 &&
            y < (double)s[i].y1)
            area = s[i].part;
    for (int i = 0; i < count; i++) rows += s[i].kind == kind && s[i].part == area;
    return rows;
}

static const WrKeyStop *tab_stop(Walk *walk, int nth)
{
    int count;
    const WrKeyStop *stops = wr_gui_stops(walk->app->gui, &count);
    for (int i = 0; i < count; i++)
        if (stops[i].kind == WR_STOP_TAB && nth-- == 0) return &stops[i];
    fail_msg("no tab");
    return NULL;
}

static bool has_fold(const Walk *walk, const char *entry)
{
    char *const *folds = walk->app->settings->folds;
    for (int i = 0; i < WR_FOLDS_MAX && folds[i]; i++)
        if (strcmp(folds[i], entry) == 0) return true;
    return false;
}

static void sections_fold_and_are_remembered(void **state)
{
    (void)state;
    Walk walk;
    open_scene(&walk);
    const SDL_Rect panel = walk.app->layout->panel;
    const double x = panel.x + 100, y = panel.y + 64 + 12 + 11; /* the first heading */
    const int open = count_rows(&walk, WR_STOP_NUMBER, x, y);
    click(&walk, SDL_BUTTON_LEFT, x, y);
    assert_true(has_fold(&walk, "-Scene/OBJECTS"));
    click(&walk, SDL_BUTTON_LEFT, x, y);
    assert_null(walk.app->settings->folds[0]); /* as at first: nothing to remember */
    const SDL_Keysym ctrl = { .scancode = SDL_SCANCODE_LCTRL, .sym = SDLK_LCTRL, .mod = KMOD_CTRL };
    SDL_SetModState(KMOD_LCTRL);
    wr_gui_event(walk.app->gui, &(SDL_Event){ .key = { .type = SDL_KEYDOWN, .keysym = ctrl } });
    click(&walk, SDL_BUTTON_LEFT, x, y);
    assert_true(open > 5);
    assert_int_equal(count_rows(&walk, WR_STOP_NUMBER, x, y), 0);
    assert_true(has_fold(&walk, "-Scene/LIGHT") && !has_fold(&walk, "-Scene/CAMERA"));
    click(&walk, SDL_BUTTON_LEFT, x, y);
    assert_true(count_rows(&walk, WR_STOP_NUMBER, x, y) > open);
    assert_true(has_fold(&walk, "+Scene/CAMERA"));
    SDL_SetModState(KMOD_NONE);
    close_scene(&walk);
}

static void a_tab_is_torn_off_and_docked_by_the_pointer(void **state)
{
    (void)state;
    Walk walk;
    open_scene(&walk);
    WrSettings *s = walk.app->settings;
    const WrKeyStop tab = *tab_stop(&walk, 1);
    const double x = (double)(tab.x0 + tab.x1) / 2, y = (double)(tab.y0 + tab.y1) / 2;
    drag(&walk, x, y, x + 30, y + 10); /* along the bar: it stays */
    assert_null(s->floats[0]);
    drag(&walk, x, y, 500, 300);
    assert_non_null(s->floats[0]);
    int px, py, w, h;
    char label[32];
    assert_int_equal(sscanf(s->floats[0], "%d %d %d %d %31s", &px, &py, &w, &h, label), 5);
    assert_string_equal(label, "Scene");
    assert_true(px < 500 && px + w > 500 && py < 300 && py + h > 300);
    assert_true(wr_gui_owns_point(walk.app->gui, 500, 300));
    drag(&walk, px + w - 5, py + h - 5, px + w + 55, py + h + 35);
    int wide, tall;
    assert_int_equal(sscanf(s->floats[0], "%d %d %d %d", &px, &py, &wide, &tall), 4);
    assert_true(wide > w + 50 && tall > h + 30);
    drag(&walk, px + 60, py + 12, -300, 5000); /* it stays in the window */
    assert_int_equal(sscanf(s->floats[0], "%d %d", &px, &py), 2);
    assert_true(px == 0 && py + tall <= walk.app->height);
    drag(&walk, px + 60, py + 12, x, y);
    assert_null(s->floats[0]);
    assert_int_equal(s->tab, wr_tab_find(walk.app, "Scene"));
    close_scene(&walk);
}

static void a_pinned_row_works_above_the_tabs(void **state)
{
    (void)state;
    Walk walk;
    open_scene(&walk);
    WrSettings *s = walk.app->settings;
    s->pins[0] = wr_strdup("Scene/BUMP/Height");
    s->folds[0] = wr_strdup("-Scene/BUMP"); /* a closed section shows its pinned rows too */
    wr_tab_show(walk.app, "History");
    settle(&walk);
    int count, found = 0;
    WrKeyStop row = { 0 };
    const WrKeyStop *stops = wr_gui_stops(walk.app->gui, &count);
    for (int i = 0; i < count; i++) {
        const bool above = (double)stops[i].x0 >= walk.app->layout->panel.x &&
                           (double)stops[i].y0 >= walk.app->layout->panel.y &&
                           (double)stops[i].y1 < (double)tab_stop(&walk, 0)->y0;
        if (above && stops[i].kind == WR_STOP_NUMBER) row = stops[i], found++;
        else if (above) assert_int_equal(stops[i].kind, WR_STOP_PRESS); /* the heading */
    }
    assert_int_equal(found, 1);
    const double height = wr_app_scene(walk.app)->height;
    const double x = (double)(row.x0 + row.x1) / 2, y = (double)(row.y0 + row.y1) / 2;
    drag(&walk, x, y, x + 40, y);
    assert_true(wr_app_scene(walk.app)->height != height);
    click(&walk, SDL_BUTTON_RIGHT, x, y);
    assert_true(wr_gui_popup_open_now(walk.app->gui));
    click(&walk, SDL_BUTTON_LEFT, x + 20, y + 20); /* Unpin */
    assert_null(s->pins[0]);
    close_scene(&walk);
}

static void a_workspace_remembers_its_changes(void **state)
{
    (void)state;
    Walk walk;
    open_scene(&walk);
    WrApp *app = walk.app;
    WrSettings *s = app->settings;
    for (int i = 0; i < WR_WORKSPACES; i++) {
        if (strcmp(app->registry->tabs[wr_tab_find(app, wr_workspaces[i].tab)].label,
                   wr_workspaces[i].tab) != 0)
            fail_msg("workspace %s: no tab %s", wr_workspaces[i].name, wr_workspaces[i].tab);
        wr_workspace_choose(app, (WrWorkspaceKind)i);
        settle(&walk);
    }
    assert_true(s->meters && s->inspector); /* Study */
    wr_workspace_choose(app, WR_WORKSPACE_LIGHT);
    assert_int_equal(s->tab, wr_tab_find(app, "Scene"));
    assert_true(!s->meters && s->lower == 0 && has_fold(&walk, "+Scene/CAMERA"));
    s->lower = 0.375;
    s->side_left = true;
    wr_folds_set(s->folds, "Scene/LIGHT", true, false);
    wr_workspace_choose(app, WR_WORKSPACE_PAINT);
    assert_true(s->lower != 0.375 && !s->side_left && !has_fold(&walk, "-Scene/LIGHT"));
    assert_int_equal(s->tab, wr_tab_find(app, "Scene")); /* shown there before */
    WrText file = { 0 };
    wr_settings_print(s, &file);
    WrSettings read = wr_settings_default(), own = *s;
    wr_settings_parse(&read, wr_text_get(&file)); /* the next start */
    *s = read;
    wr_workspace_choose(app, WR_WORKSPACE_LIGHT);
    assert_true(s->lower == 0.375 && s->side_left && has_fold(&walk, "-Scene/LIGHT"));
    wr_workspace_reset(app);
    assert_true(s->lower == 0 && !s->side_left && !has_fold(&walk, "-Scene/LIGHT"));
    wr_settings_fini(s);
    *s = own;
    wr_text_fini(&file);
    close_scene(&walk);
}

/* Pixels between the tabs and the first widget below them. */
static double space_below_tabs(Walk *walk)
{
    const SDL_Rect *panel = &walk->app->layout->panel;
    int count;
    const WrKeyStop *s = wr_gui_stops(walk->app->gui, &count);
    double tabs = panel->y, first = panel->y + panel->h;
    for (int i = 0; i < count; i++) {
        if (!wr_layout_inside(panel, (int)s[i].x0 + 1, (int)s[i].y0 + 1)) continue;
        if (s[i].kind == WR_STOP_TAB) tabs = fmax(tabs, (double)s[i].y1);
        else if (s[i].kind != WR_STOP_SCROLL) first = fmin(first, (double)s[i].y0);
    }
    return first - tabs;
}

/* Alternatives that do not fit are set closer together; a first row has no empty row above it. */
static void a_panel_begins_below_its_tabs_at_every_width(void **state)
{
    (void)state;
    Walk walk;
    open_scene(&walk);
    WrApp *app = walk.app;
    wr_tab_show(app, "Brushes");
    for (int width = 236; width <= 400; width += 3) {
        app->settings->side_width = width;
        settle(&walk);
        const double space = space_below_tabs(&walk);
        if (!(space >= 0.0 && space < 20.0)) fail_msg("%d units wide: %g pixels", width, space);
    }
    app->settings->side_width = 0.0;
    close_scene(&walk);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_panel_begins_below_its_tabs_at_every_width),
        cmocka_unit_test(sections_fold_and_are_remembered),
        cmocka_unit_test(a_tab_is_torn_off_and_docked_by_the_pointer),
        cmocka_unit_test(a_pinned_row_works_above_the_tabs),
        cmocka_unit_test(a_workspace_remembers_its_changes),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

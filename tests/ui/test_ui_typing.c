/* Typing faster than the frame rate: all keys arrive between two frames and must give the same text as key by key.
   The field is the search for actions. */
#include "test.h"
#include "app.h"

#include "ui/app/state/dialog.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/app/state/settings.h"
#include "ui/app/state/pointer_state.h"
#include "ui/toolkit/gui.h"
#include "ui/toolkit/focus.h"
#include "ui/panels/generate/generate_state.h"
#include "ui/panels/panel_search.h"

#include "base/error.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"

#include "scene/scene.h"
#include "ui/app/state/session_view.h"

#include <math.h>
#include <string.h>

static void push_key(Uint32 type, SDL_Scancode code, Uint16 mod)
{
    SDL_Keysym keysym = { .scancode = code, .sym = SDL_GetKeyFromScancode(code), .mod = mod };
    SDL_PushEvent(&(SDL_Event){ .key = { .type = type, .keysym = keysym } });
}

static void tap(SDL_Scancode code, Uint16 mod)
{
    push_key(SDL_KEYDOWN, code, mod);
    push_key(SDL_KEYUP, code, mod);
}

/* Send letters as key events and text events. */
static void type(const char *letters)
{
    for (const char *at = letters; *at; at++) {
        bool upper = *at >= 'A' && *at <= 'Z';
        Uint16 mod = upper ? KMOD_LSHIFT : 0;
        SDL_Scancode code = (SDL_Scancode)(SDL_SCANCODE_A + (*at - (upper ? 'A' : 'a')));
        if (upper) push_key(SDL_KEYDOWN, SDL_SCANCODE_LSHIFT, mod);
        push_key(SDL_KEYDOWN, code, mod);
        SDL_Event event = { .text = { .type = SDL_TEXTINPUT } };
        event.text.text[0] = *at;
        SDL_PushEvent(&event);
        push_key(SDL_KEYUP, code, mod);
        if (upper) push_key(SDL_KEYUP, SDL_SCANCODE_LSHIFT, 0);
    }
}

static void chord(SDL_Scancode code)
{
    push_key(SDL_KEYDOWN, SDL_SCANCODE_LCTRL, KMOD_LCTRL);
    tap(code, KMOD_LCTRL);
    push_key(SDL_KEYUP, SDL_SCANCODE_LCTRL, 0);
}

static void steps(WrApp *app, int count)
{
    for (int i = 0; i < count; i++) draw_again(app);
}

static void open_search(Bench *bench)
{
    begin(bench);
    wr_dialog_open(bench->app, WR_DIALOG_SEARCH);
    steps(bench->app, 4);
    assert_int_equal(bench->app->dialog->now, WR_DIALOG_SEARCH);
    assert_true(wr_gui_wants_text(bench->app->gui));
}

static void expect(WrApp *app, const char *text)
{
    steps(app, 24); /* more frames than there were keys that need a frame of their own */
    assert_string_equal(app->finder->text, text);
}

static void letters_and_keys_keep_their_order(void **state)
{
    (void)state;
    Bench bench;
    open_search(&bench);
    type("rast");
    tap(SDL_SCANCODE_BACKSPACE, 0);
    tap(SDL_SCANCODE_BACKSPACE, 0);
    type("dli");
    tap(SDL_SCANCODE_LEFT, 0);
    type("oo");
    tap(SDL_SCANCODE_HOME, 0);
    tap(SDL_SCANCODE_DELETE, 0);
    type("b");
    expect(bench.app, "badlooi");
    finish(&bench);
}

static void letters_before_a_chord_are_not_lost(void **state)
{
    (void)state;
    Bench bench;
    open_search(&bench);
    type("oak");
    chord(SDL_SCANCODE_A);
    type("el");
    chord(SDL_SCANCODE_A);
    chord(SDL_SCANCODE_X);
    type("m");
    chord(SDL_SCANCODE_V);
    expect(bench.app, "mel");
    finish(&bench);
}

/* A long name with repeated letters and capitals, typed within one frame. */
static void no_letter_of_many_is_lost(void **state)
{
    (void)state;
    static const char many[] =
        "MwWLkLkkGKCojaaGinjVbGblkVgzRGewnhrwWwBggMgGKrHMKqJXYHNMYrLvucqyJwNqrqrAxoKxaSNbbMfI"
        "wNqrqrAxoKxaSNbbMfIOVmKjUtrfXrDCtTNMuIMOKjgkGUiiLuRoDsTeNFQM";
    Bench bench;
    open_search(&bench);
    type(many);
    expect(bench.app, many);
    finish(&bench);
}

static void an_answer_waits_for_the_letters_before_it(void **state)
{
    (void)state;
    Bench bench;
    open_search(&bench);
    int layers = wr_session_document(bench.session)->layer_count;
    type("duplicate");
    tap(SDL_SCANCODE_RETURN, 0);
    steps(bench.app, 24);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_NONE);
    assert_int_equal(wr_session_document(bench.session)->layer_count, layers + 1);
    finish(&bench);
}

static void nothing_typed_is_no_answer(void **state)
{
    (void)state;
    Bench bench;
    open_search(&bench);
    tap(SDL_SCANCODE_RETURN, 0);
    steps(bench.app, 8);
    assert_int_equal(bench.app->dialog->now, WR_DIALOG_SEARCH);
    type("mask");
    expect(bench.app, "mask");
    finish(&bench);
}

/* ---- the text of a generator ---- */

static void push_wheel(const WrApp *app, int steps)
{
    SDL_PushEvent(&(SDL_Event){ .wheel = { .type = SDL_MOUSEWHEEL,
                                           .windowID = SDL_GetWindowID(app->window),
                                           .y = steps,
                                           .preciseY = (float)steps } });
}

static void write_text(WrApp *app, const char *text)
{
    tap(SDL_SCANCODE_T, 0);
    steps(app, 8);
    assert_true(wr_gui_wants_text(app->gui));
    type(text);
    steps(app, 8);
}

static void a_text_scrolled_out_of_sight_leaves_the_window_alive(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    WrApp *app = bench.app;
    write_text(app, "oak");
    const SDL_Rect panel = app->layout->panel, canvas = app->layout->canvas;
    for (int i = 0; i < 30; i++) {
        push_motion(app, panel.x + 12, panel.y + (app->layout->lower.y - panel.y) * 6 / 10);
        push_wheel(app, -1);
        steps(app, 2);
    }
    push_motion(app, canvas.x + 37, canvas.y + 41);
    steps(app, 3);
    assert_int_equal(app->hand->x, canvas.x + 37);
    assert_int_equal(app->hand->y, canvas.y + 41);
    finish(&bench);
}

static void the_second_text_is_a_layer_with_a_name_of_its_own(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    for (int i = 0; i < 3; i++) {
        write_text(bench.app, "elm");
        chord(SDL_SCANCODE_RETURN);
        settle(&bench);
    }
    const WrDocument *document = wr_session_document(bench.session);
    assert_int_equal(document->layer_count, 4);
    assert_string_equal(document->layers[1].name, "Text: elm");
    assert_string_equal(document->layers[2].name, "Text: elm 2");
    assert_string_equal(document->layers[3].name, "Text: elm 3");
    finish(&bench);
}

/* Names of new layers, and of a layer whose line is replaced by another one. */
static void automatic_names_follow_the_line(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        { "text \"OLD MILL\" size=40", "\"Text: OLD MILL\"" },
        { "text \"The quick brown foxes jump\"", "\"Text: The quick brown foxes…\"" },
        { "text \"The quick brown wolverines jump\"", "\"Text: The quick brown…\"" },
        { "text \"Ölmühle\\\\nNord\"", "\"Text: Ölmühle Nord\"" },
        { "text Donaudampfschifffahrtsgesellschaft", "\"Text: Donaudampfschifffahrtsge…\"" },
        { "solid mesh \"/tmp/a b/teapot.obj\"", "\"Mesh file: teapot.obj\"" },
        { "pattern bricks rows=3", "Bricks" },
        { "picture path \"M0,0 L1,0 1,1 Z\"", "\"Vector path\"" },
    };
    Bench bench;
    begin(&bench);
    WrText text = { 0 };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        wr_text_clear(&text);
        wr_generate_add_name(bench.app, cases[i][0], &text);
        assert_string_equal(wr_text_get(&text), cases[i][1]);
    }
    WrError err;
    static const char *const names[] = { "Bricks", "Bricks 2", "Bricks 2b", "wall" };
    static const char *const follows[] = { " name=Dots", " name=Dots", "", "" };
    for (int i = 0; i < 4; i++) {
        wr_text_clear(&text);
        wr_text_addf(&text, "layer add \"%s\" from=\"pattern bricks\"", names[i]);
        assert_true(wr_session_run(bench.session, wr_text_get(&text), &err));
        wr_text_clear(&text);
        wr_generate_follow_name(bench.app, i + 1, "pattern dots", &text);
        assert_string_equal(wr_text_get(&text), follows[i]);
        wr_text_clear(&text);
        wr_generate_follow_name(bench.app, i + 1, "pattern bricks rows=3", &text);
        assert_string_equal(wr_text_get(&text), "");
    }
    wr_text_fini(&text);
    finish(&bench);
}

/* ---- menus ---- */

/* Also that of a menu which is taller than the window. */
static void a_click_on_the_title_of_a_menu_only_opens_it(void **state)
{
    (void)state;
    Bench bench;
    begin(&bench);
    WrApp *app = bench.app;
    WrKeyStop titles[20];
    int count, menus = 0;
    const WrKeyStop *stops = wr_gui_stops(app->gui, &count);
    for (int i = 0; i < count && menus < 20; i++)
        if (stops[i].kind == WR_STOP_MENU) titles[menus++] = stops[i];
    assert_true(menus > 5);
    SDL_SetWindowSize(app->window, 900, 500);
    steps(app, 4);
    for (int i = 0; i < menus; i++) {
        const int x = (int)(titles[i].x0 + titles[i].x1) / 2;
        const int y = (int)(titles[i].y0 + titles[i].y1) / 2;
        const uint64_t before = wr_session_revision(bench.session);
        push_motion(app, x, y);
        push_button(app, true, SDL_BUTTON_LEFT, x, y);
        steps(app, 4);
        push_button(app, false, SDL_BUTTON_LEFT, x, y);
        settle(&bench);
        assert_true(wr_gui_popup_open_now(app->gui));
        assert_int_equal(wr_session_revision(bench.session), before);
        tap(SDL_SCANCODE_ESCAPE, 0);
        steps(app, 4);
    }
    finish(&bench);
}

static SDL_Keycode german_layout(SDL_Scancode place)
{
    return place == SDL_SCANCODE_SLASH ? '-' : SDL_GetKeyFromScancode(place);
}

static void type_sign(SDL_Scancode code, Uint16 mod, char sign)
{
    SDL_Event event = { .text = { .type = SDL_TEXTINPUT } };
    event.text.text[0] = sign;
    push_key(SDL_KEYDOWN, code, mod);
    SDL_PushEvent(&event);
    push_key(SDL_KEYUP, code, mod);
}

/* Shift+7 types "/" on a German keyboard. A key with an action of its own does only that. */
static void a_sign_behind_shift_is_a_shortcut_once(void **state)
{
    (void)state;
    Bench bench;
    WrError err;
    begin(&bench);
    WrApp *app = bench.app;
    WrBrushMode *mode = &app->settings->brush.mode;
    wr_keys_layout = german_layout;
    if (!wr_keys_read(app->keys, "erase_mode: / E\n", &err)) fail_msg("%s", err.text);
    *mode = WR_BRUSH_RAISE;
    type_sign(SDL_SCANCODE_7, KMOD_LSHIFT, '/');
    steps(app, 4);
    assert_int_equal(*mode, WR_BRUSH_ERASE);
    type_sign(SDL_SCANCODE_E, 0, '/');
    steps(app, 4);
    assert_int_equal(*mode, WR_BRUSH_RAISE);
    wr_dialog_open(app, WR_DIALOG_SEARCH);
    steps(app, 4);
    type_sign(SDL_SCANCODE_7, KMOD_LSHIFT, '/');
    steps(app, 4);
    assert_string_equal(app->finder->text, "/");
    assert_int_equal(*mode, WR_BRUSH_RAISE);
    wr_keys_layout = SDL_GetKeyFromScancode;
    finish(&bench);
}

/* A whole command line in the search is run, although the search finds rows of the same words. */
static void a_command_line_in_the_search_is_run(void **state)
{
    Bench bench;
    (void)state;
    open_search(&bench);
    SDL_Event event = { .text = { .type = SDL_TEXTINPUT } };
    strcpy(event.text.text, "bump height=0.371");
    SDL_PushEvent(&event);
    steps(bench.app, 4);
    tap(SDL_SCANCODE_RETURN, 0);
    steps(bench.app, 6);
    settle(&bench);
    assert_true(fabs(wr_app_scene(bench.app)->height - 0.371) < 1e-9);
    finish(&bench);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(letters_and_keys_keep_their_order),
        cmocka_unit_test(letters_before_a_chord_are_not_lost),
        cmocka_unit_test(no_letter_of_many_is_lost),
        cmocka_unit_test(an_answer_waits_for_the_letters_before_it),
        cmocka_unit_test(nothing_typed_is_no_answer),
        cmocka_unit_test(a_command_line_in_the_search_is_run),
        cmocka_unit_test(a_text_scrolled_out_of_sight_leaves_the_window_alive),
        cmocka_unit_test(the_second_text_is_a_layer_with_a_name_of_its_own),
        cmocka_unit_test(automatic_names_follow_the_line),
        cmocka_unit_test(a_sign_behind_shift_is_a_shortcut_once),
        cmocka_unit_test(a_click_on_the_title_of_a_menu_only_opens_it),
    };
    return cmocka_run_group_tests(tests, enter_window, remove_folder);
}

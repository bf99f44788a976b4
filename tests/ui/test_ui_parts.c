/* Building blocks of panels and canvas: search, thumbnails, seams, marching ants, background jobs. */
#include "test.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "field/field.h"
#include "field/seam_check.h"
#include "system/clock.h"

#include "ui/canvas/marching_ants.h"
#include "ui/canvas/canvas_colors.h"
#include "ui/toolkit/theme.h"
#include "ui/app/jobs/job.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/keys.h"
#include "ui/app/state/layout.h"
#include "ui/patch/preview/rotation.h"
#include "ui/toolkit/video_driver.h"
#include "ui/app/state/search_score.h"
#include "ui/app/state/settings.h"
#include "ui/canvas/tools/preset_overrides.h"

#include <unistd.h>

#define TURN 6.28318530717958648

/* ---- search ---- */

static void a_search_takes_all_words_in_any_order_and_case(void **state)
{
    (void)state;
    assert_int_equal(wr_search_score("Gaussian blur...", "sharp"), 0);
    assert_true(wr_search_score("Gaussian blur...", "BLUR gau") > 0);
    assert_int_equal(wr_search_score("Gaussian blur...", "blur sharp"), 0);
    assert_true(wr_search_score("Gaussian blur...", "") > 0);
    assert_true(wr_search_score("Gaussian blur...", "   ") > 0);
}

static void the_beginning_of_a_label_counts_more_than_its_middle(void **state)
{
    (void)state;
    int begin = wr_search_score("Select all", "sel");
    int word = wr_search_score("Grow selection...", "sel");
    int inside = wr_search_score("Unselect", "sel");
    assert_true(begin > word && word > inside && inside > 0);
}

/* A brush named "***" has no letter to search for, but is found by its place. */
static void a_label_without_letters_is_found_by_other_words(void **state)
{
    (void)state;
    WrSearchQuery query;
    const char *const field[WR_SEARCH_FIELDS] = {
        [WR_SEARCH_LABEL] = "", [WR_SEARCH_PLACE] = "brushes"
    };
    wr_search_parse("brushes", &query);
    assert_true(wr_search_rank(&query, field, false) > 0);
    wr_search_parse("pencil", &query);
    assert_int_equal(wr_search_rank(&query, field, false), 0);
}

/* ---- the canvas's range ---- */

static void assert_range(const double range[2], double low, double high)
{
    if (range[0] != low || range[1] != high)
        fail_msg("the range is %g .. %g, not %g .. %g", range[0], range[1], low, high);
}

/* The range chosen from an empty one. */
static void assert_own(double low, double high, double black, double white)
{
    double range[2] = { 0 };
    wr_range_follow(range, low, high);
    assert_range(range, black, white);
}

static void a_range_shows_a_new_table_in_the_middle_and_signs_around_it(void **state)
{
    (void)state;
    assert_own(0, 0, -0.5, 0.5);
    assert_own(3, 3, -6, 6); /* level, but not white */
    assert_own(0.25, 0.75, 0.25, 0.75);
    assert_own(-0.25, 0.125, -0.25, 0.25); /* zero is mid-grey */
    assert_own(0, 1, 0, 1);
    /* slight dents do not reduce the contrast of the bumps */
    assert_own(-0.055, 0.9375, -0.055, 0.9375);
    assert_own(-0.5, 0, -0.5, 0.5); /* a lowered level table */
}

/* Earlier heights keep their grey, except for the room needed by new heights. */
static void a_range_moves_only_the_end_that_is_passed(void **state)
{
    (void)state;
    double range[2] = { 0, 1 };
    wr_range_follow(range, -0.625, 1); /* a command far below 0: just as far */
    assert_range(range, -0.625, 1);
    wr_range_follow(range, 0, 1); /* undone */
    assert_range(range, -0.625, 1);
    double tried[2] = { range[0], range[1] };
    wr_range_widen(tried, 0.5, 7); /* a preview */
    assert_range(tried, -0.625, 7);
    wr_range_widen(tried, 0, 0);
    assert_range(tried, -0.625, 7);
    wr_range_follow(range, 0.4, 0.45); /* almost nothing would be visible */
    assert_range(range, 0.4, 0.45);
    wr_range_follow(range, 0.4, 0.4); /* a single grey in any case */
    assert_range(range, 0.4, 0.45);
}

/* Each of 100 strokes raises the top a little: not every one moves the range, and all heights stay within. */
static void a_range_is_not_moved_by_every_stroke(void **state)
{
    (void)state;
    double range[2] = { 0 }, before;
    wr_range_follow(range, 0, 0);
    assert_range(range, -0.5, 0.5);
    wr_range_follow(range, 0, 1 / 64.0); /* zero stays mid-grey */
    assert_range(range, -1 / 64.0, 1 / 64.0);
    int changes = 0;
    for (int i = 1; i <= 100; i++) {
        before = range[1];
        wr_range_follow(range, 0, i / 64.0);
        assert_true(range[0] == -1 / 64.0 && range[1] >= i / 64.0 && range[1] >= before);
        changes += range[1] != before;
    }
    assert_in_range(changes, 2, 33);
}

static void assert_ends(double low, double high, const char *black, const char *white)
{
    char texts[2][WR_RANGE_TEXT];
    wr_range_print(low, high, texts[0], texts[1]);
    assert_string_equal(texts[0], black);
    assert_string_equal(texts[1], white);
}

static void ends_of_a_range_have_no_digits_that_cannot_be_seen(void **state)
{
    (void)state;
    assert_ends(-0.000325, 1.03, "0", "1.03");
    assert_ends(0, 1, "0", "1");
    assert_ends(-0.5, 0.5, "-0.5", "0.5");
    assert_ends(-0.25, 0.124, "-0.25", "0.124");
    assert_ends(0.1234567, 0.1240567, "0.123457", "0.124057");
    assert_ends(-12345.678, 4000, "-12346", "4000");
    assert_ends(-100, 20, "-100", "20");
    assert_ends(-3e9, 2e9, "-3e+09", "2e+09");
    assert_ends(2, 2, "2", "2");
}

/* ---- icons ---- */

/* Based on the lines of the header: every new icon needs a word too. */
static void every_icon_has_a_word_where_its_font_is_missing(void **state)
{
    (void)state;
    WrError err;
    char *text;
    size_t length;
    int count = 0;
    assert_true(wr_file_read(WR_SOURCE_DIR "/ui/toolkit/gui.h", 1 << 20, &text, &length, &err));
    for (char *at = text; (at = strstr(at, "#define WR_ICON_")); at++, count++) {
        unsigned bytes[3];
        const char *code = strchr(at, '"');
        assert_non_null(code);
        assert_int_equal(sscanf(code, "\"\\x%2x\\x%2x\\x%2x\"", bytes, bytes + 1, bytes + 2), 3);
        char icon[4] = { (char)bytes[0], (char)bytes[1], (char)bytes[2], '\0' };
        const char *word = wr_icon_word(icon);
        if (strcmp(word, icon) == 0) fail_msg("no word for %.40s", at);
        assert_in_range(strlen(word), 1, 3);
        for (const char *c = word; *c; c++) assert_in_range(*c, ' ', '~');
    }
    assert_true(count > 40);
    assert_string_equal(wr_icon_word("Brush"), "Brush");
    wr_free(text);
}

/* ---- ways to the screen ---- */

static void every_driver_has_a_way_to_the_screen_that_it_knows(void **state)
{
    (void)state;
    static const char *const drivers[] = { "x11", "wayland", "dummy", "KMSDRM", NULL };
    static const char *const wishes[] = { NULL, "opengl", "software" };
    WrScreenWay ways[WR_SCREEN_WAYS];
    for (int i = 0; i < 30; i++) {
        const char *driver = drivers[i % 5], *wish = wishes[i / 5 % 3];
        bool gpu = i >= 15, card = wish ? wish[0] == 'o' : gpu;
        int count = wr_screen_ways(driver, gpu, wish, ways);
        assert_in_range(count, 2, WR_SCREEN_WAYS); /* there is always a fallback */
        assert_int_equal(ways[0] == WR_SCREEN_OPENGL, card);
        assert_int_equal(ways[count - 1], WR_SCREEN_ANY);
        bool direct = false;
        for (int k = 0; k < count; k++) direct |= ways[k] == WR_SCREEN_DIRECT;
        /* Wayland cannot show a window in that way */
        assert_int_equal(direct, i % 5 == 0 || i % 5 == 2);
    }
}

/* ---- rocking ---- */

static void a_sheet_rocks_smoothly_and_never_shows_its_back(void **state)
{
    (void)state;
    double way = 0, turn = 0, least = 0, most = 0, before = 0, swings = 0;
    for (int i = 0; i < 4800; i++) { /* two minutes */
        turn = wr_rotation_rock(&way, turn, 1.0 / 40.0);
        assert_true(turn >= 0 && turn < 360);
        double deg = turn > 180 ? turn - 360 : turn;
        assert_true(fabs(deg - before) < 0.5); /* no jumps */
        swings += (deg < 0) != (before < 0);
        least = fmin(least, deg);
        most = fmax(most, deg);
        before = deg;
    }
    assert_true(fabs(most - 35) < 0.1 && fabs(least + 35) < 0.1);
    assert_in_range(swings, 18, 22);
    /* a closed surface was replaced by an open one */
    assert_true(wr_rotation_rock(&way, 170, 0) < 36);
    assert_true(wr_rotation_rock(&way, 200, 0) > 324);
}

/* ---- a window and its borders ---- */

static void a_window_keeps_to_the_room_that_the_desktop_leaves(void **state)
{
    (void)state;
    const SDL_Rect room = { 0, 24, 1440, 876 }; /* a bar at the top of 1440 x 900 */
    const int borders[4] = { 1, 22, 1, 5 };
    SDL_Rect fits;
    assert_true(wr_layout_window(&room, &(SDL_Rect){ 0, 0, 1440, 900 }, borders, &fits));
    assert_true(SDL_RectEquals(&fits, &(SDL_Rect){ 1, 46, 1438, 849 }));
    assert_false(wr_layout_window(&room, &fits, borders, &fits)); /* then nothing more changes */
    /* A window that fits is moved only as far as necessary. */
    assert_true(wr_layout_window(&room, &(SDL_Rect){ 700, 500, 1000, 600 }, borders, &fits));
    assert_true(SDL_RectEquals(&fits, &(SDL_Rect){ 439, 295, 1000, 600 }));
    assert_false(wr_layout_window(&room, &(SDL_Rect){ 100, 100, 800, 600 }, borders, &fits));
    const int none[4] = { 0 };
    assert_false(wr_layout_window(&room, &room, none, &fits));
}

/* ---- changed settings of a preset ---- */

static void a_changed_setting_takes_its_place_and_can_be_taken_back(void **state)
{
    (void)state;
    WrText a = { 0 }, b = { 0 };
    double value = 7;
    wr_tuning_put(NULL, "opaque", 0.5, &a);
    assert_string_equal(wr_text_get(&a), "opaque=0.5");
    wr_tuning_put(wr_text_get(&a), "slow_tracking", 2, &b);
    assert_string_equal(wr_text_get(&b), "opaque=0.5;slow_tracking=2");
    wr_tuning_put(wr_text_get(&b), "opaque", -1.25, &a);
    assert_string_equal(wr_text_get(&a), "opaque=-1.25;slow_tracking=2");
    assert_true(wr_tuning_get(wr_text_get(&a), "slow_tracking", &value) && value == 2);
    assert_false(wr_tuning_get(wr_text_get(&a), "slow", &value));
    assert_false(wr_tuning_get(NULL, "opaque", &value));
    assert_true(value == 2);
    wr_tuning_put(wr_text_get(&a), "opaque", (double)NAN, &b);
    assert_string_equal(wr_text_get(&b), "slow_tracking=2");
    wr_tuning_put(wr_text_get(&b), "hardness", (double)NAN, &a);
    assert_string_equal(wr_text_get(&a), "slow_tracking=2");
    wr_tuning_put(wr_text_get(&a), "slow_tracking", (double)NAN, &b);
    assert_string_equal(wr_text_get(&b), "");
    /* curves, beside the value of the same setting */
    wr_tuning_put(NULL, "opaque", 0.5, &a);
    wr_tuning_put_text(wr_text_get(&a), "opaque:pressure", "0,0|1,1", &b);
    assert_string_equal(wr_text_get(&b), "opaque=0.5;opaque:pressure=0,0|1,1");
    assert_true(wr_tuning_has(wr_text_get(&b), "opaque:pressure"));
    assert_false(wr_tuning_has(wr_text_get(&b), "opaque:press"));
    wr_tuning_put_text(wr_text_get(&b), "opaque:pressure", "", &a);
    assert_string_equal(wr_text_get(&a), "opaque=0.5;opaque:pressure=");
    assert_true(wr_tuning_get(wr_text_get(&a), "opaque", &value) && value == 0.5);
    wr_tuning_put_text(wr_text_get(&a), "opaque:pressure", NULL, &b);
    assert_string_equal(wr_text_get(&b), "opaque=0.5");
    wr_text_fini(&a);
    wr_text_fini(&b);
}

static void damaged_texts_of_settings_are_read_as_far_as_they_make_sense(void **state)
{
    (void)state;
    double value = 7;
    assert_int_equal(wr_tuning_count(";;nothing;a=1;=;b=x;"), 3);
    assert_true(wr_tuning_get(";;nothing;a=1;", "a", &value) && value == 1);
    assert_false(wr_tuning_get("b=x", "b", &value));
    assert_int_equal(wr_tuning_count(NULL), 0);
}

/* ---- stored brushes ---- */

static void favourites_come_and_go_and_survive_the_settings_file(void **state)
{
    (void)state;
    WrSettings s = wr_settings_default(), t = wr_settings_default();
    WrText text = { 0 };
    wr_settings_set_favourite(&s, "wrinkle/groove", true);
    wr_settings_set_favourite(&s, "mypaint2/classic/pencil", true);
    wr_settings_set_favourite(&s, "wrinkle/groove", true);
    assert_int_equal(wr_settings_find_favourite(&s, "mypaint2/classic/pencil"), 1);
    wr_settings_set_text(&s.preset, "wrinkle/groove");
    wr_settings_set_text(&s.set, "opaque=0.5;hardness=1");
    wr_settings_note_used(&s, "round");
    wr_settings_note_used(&s, "wrinkle/groove");
    wr_settings_note_used(&s, "round");
    wr_settings_print(&s, &text);
    wr_settings_parse(&t, wr_text_get(&text));
    assert_int_equal(wr_settings_find_favourite(&t, "wrinkle/groove"), 0);
    assert_int_equal(wr_settings_find_favourite(&t, "mypaint2/classic/pencil"), 1);
    assert_string_equal(t.preset, "wrinkle/groove");
    assert_string_equal(t.set, "opaque=0.5;hardness=1");
    assert_null(t.tip);
    assert_string_equal(t.used[0], "round");
    assert_string_equal(t.used[1], "wrinkle/groove");
    assert_null(t.used[2]);
    wr_settings_set_favourite(&t, "wrinkle/groove", false);
    assert_int_equal(wr_settings_find_favourite(&t, "wrinkle/groove"), -1);
    assert_int_equal(wr_settings_find_favourite(&t, "mypaint2/classic/pencil"), 0);
    wr_text_fini(&text);
    wr_settings_fini(&s);
    wr_settings_fini(&t);
}

static void more_favourites_than_there_are_places_are_left_out(void **state)
{
    (void)state;
    WrSettings s = wr_settings_default();
    char name[32], last[32];
    for (int i = 0; i < WR_FAVOURITES_MAX + 5; i++) {
        snprintf(name, sizeof name, "user/%d", i);
        wr_settings_set_favourite(&s, name, true);
        wr_settings_note_used(&s, name);
    }
    snprintf(last, sizeof last, "user/%d", WR_FAVOURITES_MAX - 1);
    assert_int_equal(wr_settings_find_favourite(&s, last), WR_FAVOURITES_MAX - 1);
    assert_int_equal(wr_settings_find_favourite(&s, name), -1);
    wr_settings_set_favourite(&s, "user/0", false);
    assert_int_equal(wr_settings_find_favourite(&s, last), WR_FAVOURITES_MAX - 2);
    assert_string_equal(s.used[0], name);
    snprintf(last, sizeof last, "user/%d", WR_FAVOURITES_MAX + 5 - WR_USED_MAX);
    assert_string_equal(s.used[WR_USED_MAX - 1], last);
    wr_settings_fini(&s);
}

/* ---- modifier keys ---- */

static void keys_that_are_held_go_by_the_map(void **state)
{
    (void)state;
    WrError err;
    WrKeyMap *map = wr_keys_new();
    assert_true(wr_keys_hold(map, "hold_pick", WR_MOD_CTRL));
    assert_true(wr_keys_hold(map, "hold_size", WR_MOD_SHIFT));
    assert_false(wr_keys_hold(map, "hold_pick", WR_MOD_CTRL | WR_MOD_SHIFT));
    assert_false(wr_keys_hold(map, "hold_pick", 0));
    assert_true(wr_keys_read(map, wr_key_maps[1].text, &err));
    assert_true(wr_keys_hold(map, "hold_invert", WR_MOD_CTRL));
    assert_true(wr_keys_hold(map, "hold_smooth", WR_MOD_SHIFT));
    assert_true(wr_keys_hold(map, "hold_pick", WR_MOD_ALT));
    assert_true(wr_keys_hold(map, "hold_size", WR_MOD_ALT | WR_MOD_SHIFT));
    assert_false(wr_keys_hold(map, "hold_pick", WR_MOD_CTRL));
    assert_true(wr_keys_read(map, "hold_pick: Shift+Ctrl", &err));
    assert_true(wr_keys_hold(map, "hold_pick", WR_MOD_CTRL | WR_MOD_SHIFT));
    wr_keys_free(map);
}

static void a_key_that_is_held_has_a_name_and_no_event(void **state)
{
    (void)state;
    char label[32];
    WrKeyMap *map = wr_keys_new();
    assert_string_equal(wr_keys_label(map, "hold_pick", label), "Ctrl");
    assert_string_equal(wr_keys_label(map, "hold_smooth", label), "Shift+Alt");
    assert_null(wr_keys_find(map, (SDL_Keysym){ .sym = SDLK_UNKNOWN, .mod = KMOD_LCTRL }));
    wr_keys_free(map);
}

static const char *const actions[] = {
#define WORD(name, keys) #name,
    WR_ACTIONS(WORD) WR_FAMILY_ACTIONS(WORD)
#undef WORD
};

/* `keys` in the form of wr_keys_list. */
static void assert_each_finds(const WrKeyMap *map, const char *keys, const char *action)
{
    WrError err;
    for (const char *at = keys; *at;) {
        const char *end = strstr(at, "  ");
        size_t length = end ? (size_t)(end - at) : strlen(at);
        WrKey key;
        char name[32];
        snprintf(name, sizeof name, "%.*s", (int)length, at);
        for (char *c = name; *c; c++)
            if (*c == ' ') *c = '_';
        if (!wr_key_parse(name, length, &key, &err)) fail_msg("%s: %s", action, err.text);
        SDL_Keymod mod = (SDL_Keymod)((key.mods & WR_MOD_CTRL ? KMOD_LCTRL : 0) |
                                      (key.mods & WR_MOD_SHIFT ? KMOD_LSHIFT : 0) |
                                      (key.mods & WR_MOD_ALT ? KMOD_LALT : 0));
        const char *found = wr_keys_find(map, (SDL_Keysym){ .sym = key.code, .mod = mod });
        if (!found || strcmp(found, action) != 0)
            fail_msg("%s is the key of %s and of %s", name, action, found ? found : "none");
        at += length + (end ? 2 : 0);
    }
}

/* No two actions of a key map may have the same key. */
static void no_key_of_a_map_that_is_shipped_means_two_things(void **state)
{
    (void)state;
    WrError err;
    WrText keys = { 0 };
    for (int m = 0; m < WR_KEY_MAPS; m++) {
        WrKeyMap *map = wr_keys_new();
        assert_true(wr_keys_read(map, wr_key_maps[m].text, &err));
        for (size_t i = 0; i < sizeof actions / sizeof *actions; i++) {
            wr_text_clear(&keys);
            wr_keys_list(map, actions[i], &keys);
            assert_each_finds(map, wr_text_get(&keys), actions[i]);
        }
        wr_keys_free(map);
    }
    wr_text_fini(&keys);
}

static bool is_action(const char *word, size_t length)
{
    static const char *const held[] = {
#define WORD(name, keys) #name,
        WR_HELD_ACTIONS(WORD)
#undef WORD
    };
    for (size_t i = 0; i < sizeof held / sizeof *held; i++)
        if (strlen(held[i]) == length && strncmp(word, held[i], length) == 0) return true;
    for (size_t i = 0; i < sizeof actions / sizeof *actions; i++)
        if (strlen(actions[i]) == length && strncmp(word, actions[i], length) == 0) return true;
    return false;
}

static void maps_that_are_shipped_name_actions_that_there_are(void **state)
{
    (void)state;
    for (int m = 0; m < WR_KEY_MAPS; m++)
        for (const char *at = wr_key_maps[m].text; *at; at += strcspn(at, "\n") + 1)
            if (!is_action(at, strcspn(at, ":"))) fail_msg("no action: %.40s", at);
}

/* ---- the strip of tools ---- */

static void a_strip_that_is_too_short_for_its_tools_has_two_columns(void **state)
{
    (void)state;
    WrLayoutInput in = { .width = 900,
                         .height = 600,
                         .menu_height = 28,
                         .scale = 1.0,
                         .divider = 0.5,
                         .panels = true,
                         .lower = 0.4,
                         .tools = 12 };
    assert_int_equal(wr_layout_make(&in).strip.w, 48);
    in.tools = 20;
    WrLayout layout = wr_layout_make(&in);
    assert_true(layout.strip.w > 72);
    assert_int_equal(layout.canvas.x, layout.strip.w);
    in.height = 1000;
    assert_int_equal(wr_layout_make(&in).strip.w, 48);
}

/* ---- small pictures ---- */

static int grey_of(uint32_t argb)
{
    assert_int_equal(argb >> 24, 255);
    assert_int_equal(argb >> 16 & 255, argb & 255);
    assert_int_equal(argb >> 8 & 255, argb & 255);
    return (int)(argb & 255);
}

static void a_small_picture_shows_the_table_upright(void **state)
{
    (void)state;
    uint32_t argb[16 * 16];
    WrField *field = wr_field_new(256, 128, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < 64; j++)
        for (int i = 0; i < 128; i++) wr_field_set(field, i, j, 5.0f); /* top left quarter */
    wr_thumb_draw(field, NULL, false, 16, argb);
    for (int y = 0; y < 16; y++)
        for (int x = 0; x < 16; x++)
            assert_int_equal(grey_of(argb[16 * y + x]), x < 8 && y < 8 ? 255 : 0);
    wr_field_free(field);
}

/* A layer's thumbnail: raised areas are lighter than the background, lowered ones darker, uncovered ones neither. */
static void a_layers_picture_tells_up_from_down_from_nothing(void **state)
{
    (void)state;
    uint32_t argb[4];
    WrField *field = wr_field_new(128, 128, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    WrField *cover = wr_field_new(128, 128, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 1, NULL);
    for (int j = 0; j < 128; j++)
        for (int i = 0; i < 128; i++) {
            wr_field_set(field, i, j, i < 64 ? (j < 64 ? 2.0f : -2.0f) : 0.0f);
            if (i >= 64 && j >= 64) wr_field_set(cover, i, j, 0.0f);
        }
    wr_thumb_draw(field, cover, false, 2, argb);
    assert_int_equal(grey_of(argb[0]), 255);
    assert_int_equal(grey_of(argb[2]), 0);
    assert_true(abs(grey_of(argb[1]) - 128) <= 1);
    assert_true(grey_of(argb[3]) > 20 && grey_of(argb[3]) < 110);
    wr_field_free(cover);
    wr_field_free(field);
}

static void a_masks_picture_goes_from_0_to_1_whatever_is_in_it(void **state)
{
    (void)state;
    uint32_t argb[WR_THUMB_MAX * WR_THUMB_MAX];
    WrField *field = wr_field_new(1, 1, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.25f, NULL);
    wr_thumb_draw(field, NULL, true, WR_THUMB_MAX, argb);
    assert_true(abs(grey_of(argb[WR_THUMB_MAX * WR_THUMB_MAX - 1]) - 64) <= 1);
    wr_field_free(field);
}

/* ---- seams ---- */

static WrField *table_of(int w, int h, double (*f)(double u, double v))
{
    WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            wr_field_set(field, i, j, (float)f((i + 0.5) / w, 1.0 - (j + 0.5) / h));
    return field;
}

static double waves(double u, double v)
{
    return sin(TURN * 2 * u) + cos(TURN * v);
}

static double slope_in_u(double u, double v)
{
    return u + 0.1 * sin(TURN * v);
}

static double ridge(double u, double v)
{
    (void)v;
    return 4 * u * (1 - u); /* continuous at the seam, but not in slope */
}

static void waves_that_fit_the_cell_have_no_seam(void **state)
{
    (void)state;
    WrField *field = table_of(512, 200, waves);
    WrSeam seam = wr_seam_measure(field, NULL);
    assert_true(seam.u.measured && seam.v.measured && !seam.u.ends && !seam.v.ends);
    assert_true(seam.u.order == 2 && seam.v.order == 2);
    wr_field_free(field);
}

static void a_slope_that_does_not_fit_jumps_by_what_is_missing(void **state)
{
    (void)state;
    WrField *field = table_of(256, 256, slope_in_u);
    WrSeam seam = wr_seam_measure(field, NULL);
    assert_int_equal(seam.u.order, -1);
    assert_near(seam.u.across[WR_SEAM_STEP], 255.0 / 256,
                1e-3); /* from 1 back to 0, and 1/256 inside */
    assert_near(seam.u.inside[WR_SEAM_STEP], 1.0 / 256, 1e-5);
    assert_near(seam.u.inside[WR_SEAM_BEND], 0.0, 1e-5);
    assert_int_equal(seam.v.order, 2);
    wr_field_free(field);
}

static void a_ridge_on_the_edge_is_a_crease_and_no_jump(void **state)
{
    (void)state;
    WrField *field = table_of(256, 64, ridge);
    WrSeam seam = wr_seam_measure(field, NULL);
    assert_int_equal(seam.u.order, 0);
    /* slope 4 to slope -4, per texel */
    assert_near(seam.u.across[WR_SEAM_SLOPE], 8.0 / 256, 0.05 * 8.0 / 256);
    assert_true(seam.u.across[WR_SEAM_STEP] < 0.01 * seam.u.across[WR_SEAM_SLOPE]);
    wr_field_free(field);
}

static void an_axis_that_ends_has_no_seam_to_measure(void **state)
{
    (void)state;
    WrField *field = wr_field_new(64, 64, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, 0, NULL);
    WrField *tiny = wr_field_new(1, 3, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < 64; j++) wr_field_set(field, 0, j, 9.0f);
    /* its ends are adjacent in another program that repeats it: 9 against 0 */
    const WrSeam seam = wr_seam_measure(field, NULL), none = wr_seam_measure(tiny, NULL);
    assert_true(seam.u.ends && !seam.v.ends && seam.v.order == 2);
    assert_false(none.u.measured || none.v.measured);
    assert_true(none.u.order == 2 && none.v.order == 2);
    wr_field_free(tiny);
    wr_field_free(field);
}

/* ---- marching outlines ---- */

/* A table of 100 x 100 texels at two pixels per texel: copies every 200 pixels; the cell starts at (100, 50). */
static WrCanvasView ants_view(void)
{
    return (WrCanvasView){ .x = 10,
                           .y = 20,
                           .w = 580,
                           .h = 460,
                           .table_w = 100,
                           .table_h = 100,
                           .zoom = 2,
                           .centre_x = 100,
                           .centre_y = 100 };
}

static const WrSelectPoint square[] = { { 0.2, 0.2 }, { 0.4, 0.2 }, { 0.4, 0.4 }, { 0.2, 0.4 } };

static void an_outline_is_drawn_on_every_copy_that_is_seen(void **state)
{
    (void)state;
    WrCanvasView view = ants_view();
    WrMarchingAnts ants = { 0 };
    wr_marching_ants_add(&ants, square, 4, 0, 0, &view, false, false);
    int one = ants.pixels.count;
    assert_int_equal(one, 160); /* four sides of 40 pixels */
    for (int i = 0; i < one; i++) {
        double x, y;
        wr_view_to_texel(&view, ants.pixels.data[i].at.x + 0.5, ants.pixels.data[i].at.y + 0.5, &x,
                         &y);
        double dx = fabs(x - 30), dy = fabs(y - 70);
        assert_near(dx > dy ? dx : dy, 10, 0.6);
        assert_near((double)ants.pixels.data[i].along, i, 1e-3);
    }
    ants.pixels.count = 0;
    wr_marching_ants_add(&ants, square, 4, 0, 0, &view, true, true);
    int whole = ants.pixels.count;
    assert_true(whole > 5 * one && whole < 9 * one); /* 580 x 460 pixels hold 2.9 x 2.3 cells */
    for (int i = 0; i < whole; i++) {
        SDL_Point p = ants.pixels.data[i].at;
        assert_true(p.x >= 10 && p.x < 590 && p.y >= 20 && p.y < 480);
    }
    wr_marching_ants_free(&ants);
}

/* A band around the table: its edges are lines without ends. */
static void hc73_an_outline_that_runs_round_the_table_goes_on_over_the_edge(void **state)
{
    (void)state;
    WrCanvasView view = ants_view();
    WrField *band = wr_field_new(100, 100, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 40; j < 60; j++)
        for (int i = 0; i < 100; i++) wr_field_set(band, i, j, 1.0f);
    WrOutline outline = { 0 };
    assert_true(wr_select_outline(band, &outline, NULL));
    WrMarchingAnts ants = { 0 };
    wr_marching_ants_trace(&ants, &outline, &view, true, true);
    static bool seen[460][580];
    memset(seen, 0, sizeof seen);
    for (int i = 0; i < ants.pixels.count; i++)
        seen[ants.pixels.data[i].at.y - 20][ants.pixels.data[i].at.x - 10] = true;
    int full = 0;
    for (int y = 0; y < 460; y++) {
        int dots = 0;
        for (int x = 0; x < 580; x++) dots += seen[y][x];
        assert_true(dots == 0 || dots >= 578); /* no gap where cells meet */
        full += dots > 0;
    }
    assert_true(full >= 4 && full <= 6); /* two edges on each of two to three copies */
    wr_marching_ants_free(&ants);
    wr_outline_fini(&outline);
    wr_field_free(band);
}

static void a_huge_outline_is_cut_off_and_says_so(void **state)
{
    (void)state;
    WrCanvasView view = ants_view();
    WrMarchingAnts ants = { 0 };
    TestRandom r = { 5 };
    int count = 60000;
    WrSelectPoint *points = wr_alloc((size_t)count, sizeof *points);
    for (int i = 0; i < count; i++) points[i] = (WrSelectPoint){ test_random(&r), test_random(&r) };
    wr_marching_ants_add(&ants, points, count, 0, 0, &view, true, true);
    assert_true(ants.cut);
    assert_int_equal(ants.pixels.count, WR_MARCHING_ANTS_MAX);
    wr_free(points);
    wr_marching_ants_free(&ants);
}

/* Zoomed far in, a side of millions of pixels costs only its visible part. */
static void only_what_is_seen_of_a_long_side_is_walked(void **state)
{
    (void)state;
    WrCanvasView view = ants_view();
    view.table_w = view.table_h = 16384;
    view.zoom = 128;
    view.centre_x = view.centre_y = 8192;
    static const WrSelectPoint big[] = { { 0.5, -40 }, { 0.5, 40 }, { -40, 40 } };
    WrMarchingAnts ants = { 0 };
    double began = wr_clock_seconds();
    wr_marching_ants_add(&ants, big, 3, 0, 0, &view, false, false);
    assert_true(wr_clock_seconds() - began < 0.5);
    assert_true(abs(ants.pixels.count - 460) <= 2);
    wr_marching_ants_free(&ants);
}

/* ---- work in the background ---- */

typedef struct Piece {
    volatile int *dropped, *ran; /* counters, atomic */
    double seconds;              /* unless cancelled */
    int number;
    bool cancelled;
} Piece;

static void run_piece(void *arg, WrPool *pool, const WrProgress *progress)
{
    (void)pool;
    Piece *piece = arg;
    __atomic_add_fetch(piece->ran, 1, __ATOMIC_SEQ_CST);
    double began = wr_clock_seconds(), now = began;
    while (now - began < piece->seconds && wr_progress_step(progress, (now - began) / 10)) {
        usleep(1000);
        now = wr_clock_seconds();
    }
    piece->cancelled = wr_progress_cancelled(progress);
}

static void drop_piece(void *arg)
{
    Piece *piece = arg;
    __atomic_add_fetch(piece->dropped, 1, __ATOMIC_SEQ_CST);
    wr_free(piece);
}

static const WrJobKind kind = { run_piece, drop_piece };
static volatile int dropped, ran;

static Piece *piece_of(int number, double seconds)
{
    Piece *piece = wr_alloc(1, sizeof *piece);
    *piece = (Piece){ &dropped, &ran, seconds, number, false };
    return piece;
}

static Piece *wait_for(WrJob *job)
{
    double began = wr_clock_seconds();
    Piece *piece;
    while (!(piece = wr_job_take(job)) && wr_clock_seconds() - began < 10) usleep(500);
    assert_non_null(piece);
    return piece;
}

static void the_newest_piece_of_work_wins_and_the_others_are_dropped(void **state)
{
    (void)state;
    dropped = ran = 0;
    WrJob *job = wr_job_new(&kind, 1, SDL_USEREVENT);
    assert_false(wr_job_busy(job, NULL, NULL));
    wr_job_start(job, piece_of(1, 30)); /* would take half a minute */
    while (__atomic_load_n(&ran, __ATOMIC_SEQ_CST) == 0) usleep(500);
    double fraction, seconds;
    assert_true(wr_job_busy(job, &fraction, &seconds));
    assert_true(fraction >= 0 && fraction <= 1 && seconds >= 0);
    wr_job_start(job, piece_of(2, 0));
    wr_job_start(job, piece_of(3, 0));
    Piece *piece = wait_for(job);
    while (piece->number != 3) { /* 2 may have finished before 3 was started: then it is dropped */
        drop_piece(piece);
        piece = wait_for(job);
    }
    assert_false(piece->cancelled);
    assert_false(wr_job_busy(job, NULL, NULL));
    assert_null(wr_job_take(job));
    drop_piece(piece);
    wr_job_free(job);
    assert_int_equal(dropped, 3); /* each exactly once */
}

static void cancelled_work_gives_nothing_and_interrupted_work_what_it_has(void **state)
{
    (void)state;
    dropped = ran = 0;
    WrJob *job = wr_job_new(&kind, 1, SDL_USEREVENT);
    wr_job_start(job, piece_of(1, 30));
    while (__atomic_load_n(&ran, __ATOMIC_SEQ_CST) == 0) usleep(500);
    wr_job_cancel(job);
    assert_false(wr_job_busy(job, NULL, NULL));
    wr_job_start(job, piece_of(2, 30));
    while (__atomic_load_n(&ran, __ATOMIC_SEQ_CST) < 2) usleep(500);
    wr_job_interrupt(job);
    Piece *piece = wait_for(job);
    assert_int_equal(piece->number, 2);
    assert_true(piece->cancelled);
    drop_piece(piece);
    wr_job_start(job, piece_of(3, 30));
    wr_job_free(job); /* in the middle of it */
    assert_int_equal(dropped, 3);
}

/* ---- the two parts of the panel ---- */

static void the_layers_get_their_share_of_the_panel_where_there_is_room(void **state)
{
    (void)state;
    WrLayoutInput in = { .width = 1440,
                         .height = 900,
                         .menu_height = 29,
                         .scale = 1,
                         .divider = 0.5,
                         .panels = true,
                         .lower = 0.4,
                         .tools = 17 };
    for (int y = 0; y < 900; y += 13) {
        WrLayout l = wr_layout_make(&in);
        in.lower = wr_layout_lower_at(&l, y);
        l = wr_layout_make(&in);
        assert_true(l.panel.h >= 150 && (l.lower.h >= 150 || l.lower.w == 0)); /* closed */
        if (y > 280 && y < 580) assert_near(l.panel_divider.y + l.panel_divider.h / 2.0, y, 2);
    }
    in.height = 420;
    assert_int_equal(wr_layout_make(&in).lower.w, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_search_takes_all_words_in_any_order_and_case),
        cmocka_unit_test(a_label_without_letters_is_found_by_other_words),
        cmocka_unit_test(the_beginning_of_a_label_counts_more_than_its_middle),
        cmocka_unit_test(a_range_shows_a_new_table_in_the_middle_and_signs_around_it),
        cmocka_unit_test(a_range_moves_only_the_end_that_is_passed),
        cmocka_unit_test(a_range_is_not_moved_by_every_stroke),
        cmocka_unit_test(ends_of_a_range_have_no_digits_that_cannot_be_seen),
        cmocka_unit_test(every_icon_has_a_word_where_its_font_is_missing),
        cmocka_unit_test(every_driver_has_a_way_to_the_screen_that_it_knows),
        cmocka_unit_test(a_sheet_rocks_smoothly_and_never_shows_its_back),
        cmocka_unit_test(a_window_keeps_to_the_room_that_the_desktop_leaves),
        cmocka_unit_test(a_changed_setting_takes_its_place_and_can_be_taken_back),
        cmocka_unit_test(damaged_texts_of_settings_are_read_as_far_as_they_make_sense),
        cmocka_unit_test(favourites_come_and_go_and_survive_the_settings_file),
        cmocka_unit_test(more_favourites_than_there_are_places_are_left_out),
        cmocka_unit_test(keys_that_are_held_go_by_the_map),
        cmocka_unit_test(a_key_that_is_held_has_a_name_and_no_event),
        cmocka_unit_test(no_key_of_a_map_that_is_shipped_means_two_things),
        cmocka_unit_test(maps_that_are_shipped_name_actions_that_there_are),
        cmocka_unit_test(a_strip_that_is_too_short_for_its_tools_has_two_columns),
        cmocka_unit_test(a_small_picture_shows_the_table_upright),
        cmocka_unit_test(a_layers_picture_tells_up_from_down_from_nothing),
        cmocka_unit_test(a_masks_picture_goes_from_0_to_1_whatever_is_in_it),
        cmocka_unit_test(waves_that_fit_the_cell_have_no_seam),
        cmocka_unit_test(a_slope_that_does_not_fit_jumps_by_what_is_missing),
        cmocka_unit_test(a_ridge_on_the_edge_is_a_crease_and_no_jump),
        cmocka_unit_test(an_axis_that_ends_has_no_seam_to_measure),
        cmocka_unit_test(an_outline_is_drawn_on_every_copy_that_is_seen),
        cmocka_unit_test(hc73_an_outline_that_runs_round_the_table_goes_on_over_the_edge),
        cmocka_unit_test(a_huge_outline_is_cut_off_and_says_so),
        cmocka_unit_test(only_what_is_seen_of_a_long_side_is_walked),
        cmocka_unit_test(the_newest_piece_of_work_wins_and_the_others_are_dropped),
        cmocka_unit_test(cancelled_work_gives_nothing_and_interrupted_work_what_it_has),
        cmocka_unit_test(the_layers_get_their_share_of_the_panel_where_there_is_room),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

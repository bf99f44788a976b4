/* Reassigned keys: removed from their former actions, and written so that a key file, comments included, reads back
   the same. */
#include "test.h"

#include "base/error.h"
#include "base/text.h"
#include "ui/app/state/action_list.h"
#include "ui/app/state/keys.h"

#include <string.h>

static WrKey key_of(const char *text)
{
    WrKey key;
    WrError err;
    if (!wr_key_parse(text, strlen(text), &key, &err)) fail_msg("%s", err.text);
    return key;
}

static void a_key_is_taken_from_its_owner(void **state)
{
    (void)state;
    char label[32];
    WrKeyMap *map = wr_keys_new();
    assert_string_equal(wr_keys_owner(map, key_of("Ctrl+Y")), "redo");
    wr_keymap_bind(map, "fill", key_of("Ctrl+Y"));
    assert_string_equal(wr_keys_owner(map, key_of("Ctrl+Y")), "fill");
    assert_string_equal(wr_keys_label(map, "fill", label), "Ctrl+Y");
    /* its other keys stay */
    assert_string_equal(wr_keys_owner(map, key_of("Ctrl+Shift+Z")), "redo");
    wr_keymap_bind(map, "fill", key_of("Shift+F11")); /* and its old keys are removed */
    assert_null(wr_keys_owner(map, key_of("Ctrl+Y")));
    wr_keys_unbind_all(map, "fill");
    assert_null(wr_keys_owner(map, key_of("Shift+F11")));
    assert_string_equal(wr_keys_label(map, "fill", label), "");
    wr_keys_free(map);
}

/* After the edit the file matches the map, and its other content is unchanged. */
static void a_file_says_what_the_map_does(void **state)
{
    (void)state;
    static const char *const keys[] = { "Ctrl+#", "Keypad_+", "Alt+Shift+PageUp",   "_",
                                        ":",      ",",        "Ctrl+Shift+Alt+F12", "Left" };
    static const char old[] = "# mine\n\nundo: F5 # both\nfill: F3\nredo:F6";
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        WrError err;
        WrText out = { 0 };
        WrKey key =
            strcmp(keys[i], "Ctrl+#") == 0 ? (WrKey){ SDLK_HASH, WR_MOD_CTRL } : key_of(keys[i]);
        WrKeyMap *map = wr_keys_new(), *read = wr_keys_new();
        assert_true(wr_keys_read(map, old, &err));
        wr_keymap_bind(map, "fill", key);
        wr_keys_edit(map, "fill", old, &out);
        const char *text = wr_text_get(&out);
        assert_non_null(strstr(text, "# mine\n\nundo: F5 # both\nredo:F6\nfill: "));
        assert_null(strstr(text, "F3"));
        if (!wr_keys_read(read, text, &err)) fail_msg("%s: %s", text, err.text);
        assert_string_equal(wr_keys_owner(read, key), "fill");
        wr_text_fini(&out);
        wr_keys_free(map);
        wr_keys_free(read);
    }
}

static void what_may_be_given_is_read_back(void **state)
{
    (void)state;
    static const SDL_Keycode not [] = { SDLK_ESCAPE, SDLK_LSHIFT, SDLK_RALT, SDLK_UNKNOWN,
                                        SDLK_SPACE };
    static const SDL_Keycode may[] = { SDLK_a,        SDLK_z,      SDLK_HASH,     SDLK_UNDERSCORE,
                                       SDLK_KP_PLUS,  SDLK_PAGEUP, SDLK_F12,      SDLK_LEFT,
                                       SDLK_DELETE,   0xe4,        SDLK_KP_ENTER, SDLK_COLON,
                                       SDLK_BACKQUOTE };
    for (size_t i = 0; i < sizeof not / sizeof *not ; i++)
        assert_false(wr_key_can_be_given(not [i]));
    for (size_t i = 0; i < sizeof may / sizeof *may; i++)
        if (!wr_key_can_be_given(may[i])) fail_msg("%s", SDL_GetKeyName(may[i]));
}

/* ---- other keyboards ---- */

/* Characters of some layouts at positions where a US keyboard has others. */
static const struct {
    SDL_Scancode place;
    SDL_Keycode german, spanish, italian;
} signs[] = { { SDL_SCANCODE_GRAVE, '^', 0xba, '\\' },
              { SDL_SCANCODE_MINUS, 0xdf, '\'', '\'' },
              { SDL_SCANCODE_EQUALS, 0xb4, 0xa1, 0xec },
              { SDL_SCANCODE_LEFTBRACKET, 0xfc, '`', 0xe8 },
              { SDL_SCANCODE_RIGHTBRACKET, '+', '+', '+' },
              { SDL_SCANCODE_SEMICOLON, 0xf6, 0xf1, 0xf2 },
              { SDL_SCANCODE_APOSTROPHE, 0xe4, 0xb4, 0xe0 },
              { SDL_SCANCODE_BACKSLASH, '#', 0xe7, 0xf9 },
              { SDL_SCANCODE_NONUSBACKSLASH, '<', '<', '<' },
              { SDL_SCANCODE_SLASH, '-', '-', '-' },
              { SDL_SCANCODE_Y, 'z', 'y', 'y' },
              { SDL_SCANCODE_Z, 'y', 'z', 'z' } };
static int keyboard;

static SDL_Keycode sign_at(SDL_Scancode place)
{
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++)
        if (signs[i].place == place)
            return keyboard == 0   ? signs[i].german
                   : keyboard == 1 ? signs[i].spanish
                                   : signs[i].italian;
    return SDL_GetKeyFromScancode(place);
}

/* The key of a label as sent by the keyboard; false: the keyboard has no such key. */
static bool press(const char *label, SDL_Keysym *sym)
{
    const WrKey key = key_of(label);
    for (int place = 1; place < SDL_NUM_SCANCODES; place++) {
        if (sign_at((SDL_Scancode)place) != key.code) continue;
        *sym = (SDL_Keysym){ .scancode = (SDL_Scancode)place,
                             .sym = key.code,
                             .mod = (Uint16)((key.mods & WR_MOD_CTRL ? KMOD_LCTRL : 0) |
                                             (key.mods & WR_MOD_SHIFT ? KMOD_LSHIFT : 0) |
                                             (key.mods & WR_MOD_ALT ? KMOD_LALT : 0)) };
        return true;
    }
    return false;
}

static int check_labels(const WrKeyMap *map)
{
#define NAME(name, keys) #name,
    static const char *const actions[] = { WR_ACTIONS(NAME) };
#undef NAME
    int shown = 0;
    for (size_t i = 0; i < sizeof actions / sizeof *actions; i++) {
        char label[32];
        SDL_Keysym sym;
        if (!wr_keys_label(map, actions[i], label)[0]) continue;
        shown++;
        if (!press(label, &sym))
            fail_msg("keyboard %d: %s: no key %s", keyboard, actions[i], label);
        const char *does = wr_keys_find(map, sym);
        if (!does || strcmp(does, actions[i]) != 0)
            fail_msg("keyboard %d: %s does %s, not %s", keyboard, label, does ? does : "nothing",
                     actions[i]);
    }
    return shown;
}

/* Keys shown in menus, tips and hints exist on German, Spanish and Italian keyboards and trigger their action
   there. */
static void a_key_that_is_shown_does_its_action_on_every_keyboard(void **state)
{
    (void)state;
    int shown = 0;
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy"); /* SDL has no keyboard before */
    assert_int_equal(SDL_InitSubSystem(SDL_INIT_VIDEO), 0);
    wr_keys_layout = sign_at;
    for (keyboard = 0; keyboard < 3; keyboard++)
        for (int m = 0; m < WR_KEY_MAPS; m++) {
            WrError err;
            WrKeyMap *map = wr_keys_new();
            assert_true(wr_keys_read(map, wr_key_maps[m].text, &err));
            shown += check_labels(map);
            wr_keys_free(map);
        }
    wr_keys_layout = SDL_GetKeyFromScancode;
    SDL_QuitSubSystem(SDL_INIT_VIDEO);
    assert_true(shown > 300);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_key_is_taken_from_its_owner),
        cmocka_unit_test(a_file_says_what_the_map_does),
        cmocka_unit_test(what_may_be_given_is_read_back),
        cmocka_unit_test(a_key_that_is_shown_does_its_action_on_every_keyboard)
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

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

/* Signs of the keys of a PC keyboard in xkeyboard-config's order: rows AE, AD, AC, then TLDE, BKSL, row AB, LSGT. From its files
   symbols/us, de, fr, es and it, version 2.35, as Latin-1; \1: a dead key, which SDL reports without a sign. Levels: plain, with
   Shift, with AltGr; there, signs beyond ASCII are left out. SDL replaces the French signs above the letters by digits;
   the second French row is without that. */
#define PLACES 48
static const SDL_Scancode places[PLACES] = {
    SDL_SCANCODE_1,         SDL_SCANCODE_2,           SDL_SCANCODE_3,
    SDL_SCANCODE_4,         SDL_SCANCODE_5,           SDL_SCANCODE_6,
    SDL_SCANCODE_7,         SDL_SCANCODE_8,           SDL_SCANCODE_9,
    SDL_SCANCODE_0,         SDL_SCANCODE_MINUS,       SDL_SCANCODE_EQUALS,
    SDL_SCANCODE_Q,         SDL_SCANCODE_W,           SDL_SCANCODE_E,
    SDL_SCANCODE_R,         SDL_SCANCODE_T,           SDL_SCANCODE_Y,
    SDL_SCANCODE_U,         SDL_SCANCODE_I,           SDL_SCANCODE_O,
    SDL_SCANCODE_P,         SDL_SCANCODE_LEFTBRACKET, SDL_SCANCODE_RIGHTBRACKET,
    SDL_SCANCODE_A,         SDL_SCANCODE_S,           SDL_SCANCODE_D,
    SDL_SCANCODE_F,         SDL_SCANCODE_G,           SDL_SCANCODE_H,
    SDL_SCANCODE_J,         SDL_SCANCODE_K,           SDL_SCANCODE_L,
    SDL_SCANCODE_SEMICOLON, SDL_SCANCODE_APOSTROPHE,  SDL_SCANCODE_GRAVE,
    SDL_SCANCODE_BACKSLASH, SDL_SCANCODE_Z,           SDL_SCANCODE_X,
    SDL_SCANCODE_C,         SDL_SCANCODE_V,           SDL_SCANCODE_B,
    SDL_SCANCODE_N,         SDL_SCANCODE_M,           SDL_SCANCODE_COMMA,
    SDL_SCANCODE_PERIOD,    SDL_SCANCODE_SLASH,       SDL_SCANCODE_NONUSBACKSLASH
};
enum { PLAIN, SHIFT, ALTGR, LEVELS };
#define FRENCH_SHIFT "1234567890 +AZERTYUIOP  QSDFGHJKLM%~ WXCVBN?./ >"
#define FRENCH_ALTGR " ~#{[|`\\^@]}                                   |"
static const struct {
    const char *name, *signs[LEVELS];
    /* keys for these actions that the layout must have, by their position */
    SDL_Scancode size_down, size_up;
} layouts[] = {
    { "us",
      { "1234567890-=qwertyuiop[]asdfghjkl;'`\\zxcvbnm,./<",
        "!@#$%^&*()_+QWERTYUIOP{}ASDFGHJKL:\"~|ZXCVBNM<>?>",
        "                                                " },
      SDL_SCANCODE_LEFTBRACKET,
      SDL_SCANCODE_RIGHTBRACKET },
    { "de",
      { "1234567890\337\1qwertzuiop\374+asdfghjkl\366\344\1#yxcvbnm,.-<",
        "!\" $%&/()=? QWERTZUIOP *ASDFGHJKL   'YXCVBNM;:_>",
        "      {[]}\\ @          ~                       |" },
      SDL_SCANCODE_SEMICOLON,
      SDL_SCANCODE_APOSTROPHE },
    { "fr",
      { "1234567890)=azertyuiop\1$qsdfghjklm\371\262*wxcvbn,;:!<", FRENCH_SHIFT, FRENCH_ALTGR },
      SDL_SCANCODE_LEFTBRACKET,
      SDL_SCANCODE_RIGHTBRACKET },
    { "fr, without digits",
      { "&\351\"'(-\350_\347\340)=azertyuiop\1$qsdfghjklm\371\262*wxcvbn,;:!<", FRENCH_SHIFT,
        FRENCH_ALTGR },
      SDL_SCANCODE_LEFTBRACKET,
      SDL_SCANCODE_RIGHTBRACKET },
    { "es",
      { "1234567890'\241qwertyuiop\1+asdfghjkl\361\1\272\347zxcvbnm,.-<",
        "!\" $%&/()=? QWERTYUIOP *ASDFGHJKL    ZXCVBNM;:_>",
        "|@#~  {[]}\\           []          {\\}          |" },
      SDL_SCANCODE_SEMICOLON,
      SDL_SCANCODE_APOSTROPHE },
    { "it",
      { "1234567890'\354qwertyuiop\350+asdfghjkl\362\340\\\371zxcvbnm,.-<",
        "!\" $%&/()=?^QWERTYUIOP *ASDFGHJKL  | ZXCVBNM;:_>",
        "      {[]}`~          []         @#             " },
      SDL_SCANCODE_SEMICOLON,
      SDL_SCANCODE_APOSTROPHE },
};
#define LAYOUTS ((int)(sizeof layouts / sizeof *layouts))
static int keyboard;

static int index_of(SDL_Scancode place)
{
    for (int i = 0; i < PLACES; i++)
        if (places[i] == place) return i;
    return -1;
}

static SDL_Keycode sign_at(SDL_Scancode place)
{
    const int i = index_of(place);
    if (i < 0) return SDL_GetKeyFromScancode(place);
    const unsigned char sign = (unsigned char)layouts[keyboard].signs[PLAIN][i];
    return sign == 1 ? SDLK_SCANCODE_MASK : sign;
}

static SDL_Keysym pressed(SDL_Scancode place, int mods)
{
    return (SDL_Keysym){ .scancode = place,
                         .sym = sign_at(place),
                         .mod = (Uint16)((mods & WR_MOD_CTRL ? KMOD_LCTRL : 0) |
                                         (mods & WR_MOD_SHIFT ? KMOD_LSHIFT : 0) |
                                         (mods & WR_MOD_ALT ? KMOD_LALT : 0)) };
}

/* The action of the key at that position, as the window finds it: by the key, else by the sign it types. */
static const char *action_of(const WrKeyMap *map, SDL_Keysym key, int level)
{
    const char *action = wr_keys_find(map, key);
    const int i = index_of(key.scancode);
    if (action || i < 0 || (key.mod & (KMOD_CTRL | KMOD_LALT))) return action;
    const char text[] = { layouts[keyboard].signs[level][i], '\0' };
    return wr_keys_find_typed(map, text);
}

#define NAME(name, keys) { #name, keys },
static const struct {
    const char *action, *keys;
} actions[] = { WR_ACTIONS(NAME) };
#undef NAME
#define ACTIONS ((int)(sizeof actions / sizeof *actions))

/* Marks the actions of every key with all modifiers. No key loses a shortcut of its own. */
static void press_all(const WrKeyMap *map, bool reached[ACTIONS])
{
    for (int place = 1; place < SDL_NUM_SCANCODES; place++)
        for (int mods = 0; mods <= (WR_MOD_CTRL | WR_MOD_SHIFT | WR_MOD_ALT); mods++) {
            const SDL_Keysym key = pressed((SDL_Scancode)place, mods);
            const char *action = action_of(map, key, mods & WR_MOD_SHIFT ? SHIFT : PLAIN);
            const char *owner = wr_keys_owner(map, (WrKey){ key.sym, mods });
            if (owner && action != owner && key.sym)
                fail_msg("%s: key %d with %d does %s, not its own %s", layouts[keyboard].name,
                         place, mods, action ? action : "nothing", owner);
            for (int i = 0; action && i < ACTIONS; i++)
                if (strcmp(action, actions[i].action) == 0) reached[i] = true;
        }
}

static void check_reached(const WrKeyMap *map)
{
    bool reached[ACTIONS] = { false };
    press_all(map, reached);
    for (int i = 0; i < ACTIONS; i++)
        if (actions[i].keys[0] && !reached[i])
            fail_msg("%s: no key does %s", layouts[keyboard].name, actions[i].action);
    assert_string_equal(action_of(map, pressed(layouts[keyboard].size_down, 0), PLAIN),
                        "size_down");
    assert_string_equal(action_of(map, pressed(layouts[keyboard].size_up, 0), PLAIN), "size_up");
    assert_string_equal(action_of(map, pressed(layouts[keyboard].size_up, WR_MOD_SHIFT), SHIFT),
                        "hardness_up");
}

/* AltGr types signs and is not Alt: with "[" and "]" it sizes the brush. */
static void check_altgr(const WrKeyMap *map)
{
    const char *signs = layouts[keyboard].signs[ALTGR];
    for (int i = 0; i < PLACES && keyboard > 0; i++) {
        SDL_Keysym key = pressed(places[i], 0);
        key.mod = KMOD_RALT;
        const char *action = action_of(map, key, ALTGR);
        const char *wanted = signs[i] == '[' ? "size_down" : signs[i] == ']' ? "size_up" : NULL;
        if (wanted ? !action || strcmp(action, wanted) != 0 : action != NULL)
            fail_msg("%s: AltGr at %d does %s", layouts[keyboard].name, i,
                     action ? action : "nothing");
    }
}

/* Labels in menus name a key that is on the keyboard, or a sign that it types. */
static int check_labels(const WrKeyMap *map)
{
    int shown = 0;
    for (int i = 0; i < ACTIONS; i++) {
        char label[32];
        const char *does = NULL;
        if (!wr_keys_label(map, actions[i].action, label)[0]) continue;
        const WrKey key = key_of(label);
        for (int place = 1; !does && place < SDL_NUM_SCANCODES; place++)
            if (sign_at((SDL_Scancode)place) == key.code)
                does = wr_keys_find(map, pressed((SDL_Scancode)place, key.mods));
        for (int level = SHIFT; !does && level < LEVELS; level++)
            if (strchr(layouts[keyboard].signs[level], label[0]) && !label[1])
                does = wr_keys_find_typed(map, label);
        if (!does || strcmp(does, actions[i].action) != 0)
            fail_msg("%s: %s does %s, not %s", layouts[keyboard].name, label,
                     does ? does : "nothing", actions[i].action);
        shown++;
    }
    return shown;
}

static void every_shortcut_has_a_key_on_every_keyboard(void **state)
{
    (void)state;
    int shown = 0;
    SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy"); /* SDL has no keyboard before */
    assert_int_equal(SDL_InitSubSystem(SDL_INIT_VIDEO), 0);
    wr_keys_layout = sign_at;
    for (keyboard = 0; keyboard < LAYOUTS; keyboard++) {
        for (int level = 0; level < LEVELS; level++)
            assert_int_equal(strlen(layouts[keyboard].signs[level]), PLACES);
        for (int m = 0; m < WR_KEY_MAPS; m++) {
            WrError err;
            WrKeyMap *map = wr_keys_new();
            assert_true(wr_keys_read(map, wr_key_maps[m].text, &err));
            check_reached(map);
            check_altgr(map);
            shown += check_labels(map);
            wr_keys_free(map);
        }
    }
    wr_keys_layout = SDL_GetKeyFromScancode;
    SDL_QuitSubSystem(SDL_INIT_VIDEO);
    assert_true(shown > 800);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(a_key_is_taken_from_its_owner),
                                        cmocka_unit_test(a_file_says_what_the_map_does),
                                        cmocka_unit_test(what_may_be_given_is_read_back),
                                        cmocka_unit_test(
                                            every_shortcut_has_a_key_on_every_keyboard) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* keys.h - key map: lines "action: key key ...", first built in, then the user's. Modifier actions, such as
   hold_pick, have keys that are held while the pointer works: "Ctrl", "Alt+Shift". */
#pragma once
#include <SDL.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* Modifiers, as bits. */
#define WR_MOD_CTRL 1
#define WR_MOD_SHIFT 2
#define WR_MOD_ALT 4

typedef struct WrKey {
    SDL_Keycode code; /* by the key's label; SDLK_UNKNOWN: only modifiers, held */
    int mods;
} WrKey;

/* Parse "Ctrl+Shift+Z", "[", "F1", "Keypad +". Names are SDL's. */
bool wr_key_parse(const char *text, size_t length, WrKey *key, WrError *err);
/* WR_MOD_ bits of SDL's. The right Alt key is AltGr, which is none of them, in layouts without a key for brackets. */
int wr_key_mods(SDL_Keymod held);

typedef struct WrKeyMap WrKeyMap;

/* The built-in keys. The caller owns the map. */
WrKeyMap *wr_keys_new(void);
void wr_keys_free(WrKeyMap *map);
/* Apply lines: each sets the keys of its action and removes these keys from other actions. '#' starts a comment. On
 * an error, which contains the line number, the map is unchanged. */
bool wr_keys_read(WrKeyMap *map, const char *text, WrError *err);
/* The action of a key, or NULL. Valid while the map is unchanged. If the layout has no keys for digits or brackets, a key
 * without an action by its label is found by its position on a US keyboard; if a key beside P has a shortcut of its own,
 * such as "+", the brackets are also on the two keys below, right of L. */
const char *wr_keys_find(const WrKeyMap *map, SDL_Keysym sym);
/* The action of a typed sign that no key has without Shift or AltGr, such as "/" on a German keyboard, or NULL. For text
 * whose key has no action itself. */
const char *wr_keys_find_typed(const WrKeyMap *map, const char *text);
/* True if exactly these modifiers (WR_MOD_ bits) are the keys of a modifier action. */
bool wr_keys_hold(const WrKeyMap *map, const char *action, int held);
/* The sign on each key of the keyboard: SDL_GetKeyFromScancode, or a test's layout. */
extern SDL_Keycode (*wr_keys_layout)(SDL_Scancode place);
/* The first key of an action that exists in this keyboard's layout, as text, "" if none. Returns buffer. */
char *wr_keys_label(const WrKeyMap *map, const char *action, char buffer[32]);
/* All such keys of an action, separated by two spaces. */
void wr_keys_list(const WrKeyMap *map, const char *action, WrText *out);

/* ---- changes ---- */

/* The action that has a key, or NULL. */
const char *wr_keys_owner(const WrKeyMap *map, WrKey key);
/* Make the key the only one of the action, and remove it from others. */
void wr_keymap_bind(WrKeyMap *map, const char *action, WrKey key);
void wr_keys_unbind_all(WrKeyMap *map, const char *action); /* remove all keys of the action */
/* The text of a key file with the action's line replaced by the map's; other lines and comments are unchanged. */
void wr_keys_edit(const WrKeyMap *map, const char *action, const char *text, WrText *out);
/* True if the key can be assigned alone: not a modifier, lock or Escape key. */
bool wr_key_can_be_given(SDL_Keycode code);

/* ---- key maps ---- */

/* A key map: its differences from the built-in keys, as text. */
typedef struct WrKeyMapText {
    const char *label, *help, *text;
} WrKeyMapText;

/* Paint: Ctrl picks a height, Shift resizes. Sculpt: Ctrl swaps raise and lower, Shift smooths. In each of them Alt
 * has the function of the other map. */
enum { WR_KEYS_PAINT, WR_KEYS_SCULPT, WR_KEY_MAPS };
extern const WrKeyMapText wr_key_maps[WR_KEY_MAPS];

/* keys.h - which keys do what: lines "action: key key ...", built in and then the user's own. Actions of
   the hand, such as hold_pick, have keys that are held while the pointer works: "Ctrl", "Alt+Shift". */
#pragma once
#include <SDL.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

/* Held keys, as bits. */
#define WR_MOD_CTRL 1
#define WR_MOD_SHIFT 2
#define WR_MOD_ALT 4

typedef struct WrKey {
    SDL_Keycode code; /* by what is printed on the key; SDLK_UNKNOWN: only mods, held */
    int mods;
} WrKey;

/* "Ctrl+Shift+Z", "[", "F1", "Keypad +". Names are SDL's. */
bool wr_key_parse(const char *text, size_t length, WrKey *key, WrError *err);
int wr_key_mods(SDL_Keymod held);

typedef struct WrKeyMap WrKeyMap;

/* The built-in keys. The caller owns the map. */
WrKeyMap *wr_keys_new(void);
void wr_keys_free(WrKeyMap *map);
/* Lines that replace the keys of the actions that they name, and take them from others. '#' starts a comment. On an error, which
 * names the line, the map is as it was. */
bool wr_keys_read(WrKeyMap *map, const char *text, WrError *err);
/* The action of a key, or NULL. Valid while the map is. A key that no action has by what is printed on
 * it counts by its place where that is a bracket on a US keyboard: other layouts have none to press. */
const char *wr_keys_find(const WrKeyMap *map, SDL_Keysym sym);
/* Is exactly this held (WR_MOD_ bits) for an action of the hand? */
bool wr_keys_hold(const WrKeyMap *map, const char *action, int held);
/* The first key of an action that this keyboard's layout has, as text, "" if none. Returns buffer. */
char *wr_keys_label(const WrKeyMap *map, const char *action, char buffer[32]);
/* All such keys of an action, separated by two spaces. */
void wr_keys_list(const WrKeyMap *map, const char *action, WrText *out);

/* ---- changing them ---- */

/* The action that has a key, or NULL. */
const char *wr_keys_owner(const WrKeyMap *map, WrKey key);
/* The key is the action's, its only one, and nobody else's. */
void wr_keymap_bind(WrKeyMap *map, const char *action, WrKey key);
void wr_keys_take(WrKeyMap *map, const char *action); /* it has none any more */
/* The text of a file of such lines, changed so that it says of the action what the map does; its other lines and its
   comments stay. */
void wr_keys_edit(const WrKeyMap *map, const char *action, const char *text, WrText *out);
/* Can it be pressed for an action by itself: no key that is held, locks, or closes dialogs? */
bool wr_key_can_be_given(SDL_Keycode code);

/* ---- key_maps.c ---- */

/* A whole map: what it changes of the built-in keys, as text. */
typedef struct WrKeyMapText {
    const char *label, *help, *text;
} WrKeyMapText;

/* Paint, with the habits of painters: Ctrl picks a height, Shift sizes; and Sculpt: Ctrl turns raise and
 * lower round, Shift smooths. In each of them Alt does what the other does. */
enum { WR_KEYS_PAINT, WR_KEYS_SCULPT, WR_KEY_MAPS };
extern const WrKeyMapText wr_key_maps[WR_KEY_MAPS];

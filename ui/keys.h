/* keys.h - which keys do what: lines "action: key key ...", built in and then the user's own. */
#pragma once
#include "base/text.h"

#include <SDL.h>

/* Held keys, as bits. */
#define WR_MOD_CTRL 1
#define WR_MOD_SHIFT 2
#define WR_MOD_ALT 4

typedef struct WrKey {
    SDL_Keycode code; /* by what is printed on the key */
    int mods;
} WrKey;

/* "Ctrl+Shift+Z", "[", "F1", "Keypad +". Names are SDL's. */
bool wr_key_parse(const char *text, size_t length, WrKey *key, WrError *err);
int wr_key_mods(SDL_Keymod held);

typedef struct WrKeyMap WrKeyMap;

/* The built-in keys. The caller owns the map. */
WrKeyMap *wr_keys_new(void);
void wr_keys_free(WrKeyMap *map);
/* Lines that replace the keys of the actions that they name. '#' starts a comment. On an error, which
 * names the line, the map is as it was. */
bool wr_keys_read(WrKeyMap *map, const char *text, WrError *err);
/* The action of a key, or NULL. Valid while the map is. A key that no action has by what is printed on
 * it counts by its place where that is a bracket on a US keyboard: other layouts have none to press. */
const char *wr_keys_find(const WrKeyMap *map, SDL_Keysym sym);
/* The first key of an action as text, "" if none. Returns buffer. */
char *wr_keys_label(const WrKeyMap *map, const char *action, char buffer[32]);
/* All keys of an action, separated by two spaces. */
void wr_keys_list(const WrKeyMap *map, const char *action, WrText *out);

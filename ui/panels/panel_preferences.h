/* panel_preferences.h - preferences dialog: window settings and keys. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/keys.h"

#include <stdbool.h>

typedef struct WrPreferences {
    char query[80];
    char waits[64]; /* action that waits for the next key; "": none */
    /* key pressed for it, with the modifiers at that time; SDLK_UNKNOWN: none yet */
    WrKey key;
    char message[200]; /* message of the last change */
    bool bad;          /* the change failed */
} WrPreferences;

void wr_dialog_preferences(WrApp *app);
/* Handle a key press; true if an action waits for a key and gets this one. */
bool wr_preferences_take_key(WrApp *app, const SDL_KeyboardEvent *event);

/* panel_preferences.h - what the window is like, and which keys do what. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/keys.h"

#include <stdbool.h>

typedef struct WrPreferences {
    char query[80];
    char waits[64]; /* the action that the next key is for; "": none */
    WrKey key;      /* that went down for it, with what was held then; SDLK_UNKNOWN: none yet */
    char told[200]; /* of the last change */
    bool bad;       /* it could not be made */
} WrPreferences;

void wr_dialog_preferences(WrApp *app);
/* A key went down: is it the one that an action waits for? */
bool wr_preferences_take_key(WrApp *app, const SDL_KeyboardEvent *event);

/* tool.h - what a tool of the strip on the left is, and which one is in hand. The tools themselves are in rows that
   the roster lists. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"

#include <SDL.h>
#include <stdbool.h>

/* Each function may be NULL. */
struct WrTool {
    const char *action; /* that chooses it; its name, label and keys are the action's */
    const char *icon;
    const char *help; /* one sentence */
    void (*press)(WrApp *app, const WrPointer *at);
    void (*drag)(WrApp *app, const WrPointer *at);
    void (*release)(WrApp *app, const WrPointer *at);
    void (*overlay)(WrApp *app);              /* drawn over the canvas while the pointer is on it */
    void (*marks)(WrApp *app);                /* drawn over the canvas wherever the pointer is */
    void (*options)(WrApp *app);              /* widgets of the option row */
    bool (*key)(WrApp *app, SDL_Keycode key); /* Escape, Return, ...: true if it took it */
    bool (*wheel)(WrApp *app, double steps);  /* over the canvas: true if it took it */
    void (*leave)(WrApp *app);                /* another tool is chosen, or another document */
    /* Also while something runs beside the window: it changes nothing, or what comes of it can wait. */
    bool meanwhile;
    bool paints; /* press, drag, release are the brush's */
    int mode;    /* 1 + the WrBrushMode that it paints with; 0: the brush's own */
};

const WrTool *wr_tool_now(const WrApp *app);
int wr_tool_find(const WrApp *app, const char *action); /* index in the roster, or -1 */
/* Take it in hand: the one before is left, with what it had begun. */
void wr_tool_choose(WrApp *app, int index);

extern const WrPart wr_part_tools;

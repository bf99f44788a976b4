/* tool.h - interface of a tool in the tool strip, and the current tool. The tools' rows are listed in the registry. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/app/state/registry.h"

#include <SDL.h>
#include <stdbool.h>

/* Each function may be NULL. */
struct WrTool {
    const char *action; /* action that chooses it and provides name, label and keys */
    const char *icon;
    const char *help; /* one sentence */
    void (*press)(WrApp *app, const WrPointer *at);
    void (*drag)(WrApp *app, const WrPointer *at);
    void (*release)(WrApp *app, const WrPointer *at);
    void (*overlay)(WrApp *app);              /* drawn over the canvas while the pointer is on it */
    void (*marks)(WrApp *app);                /* drawn over the canvas always */
    void (*options)(WrApp *app);              /* widgets of the option row */
    bool (*key)(WrApp *app, SDL_Keycode key); /* Escape, Return, ...: true if handled */
    bool (*wheel)(WrApp *app, double steps);  /* over the canvas: true if handled */
    void (*leave)(WrApp *app);                /* another tool or another document is chosen */
    /* Allowed during a background command: it changes nothing, or its result can wait. */
    bool meanwhile;
    bool paints; /* press, drag and release are the brush's */
    int mode;    /* 1 + its WrBrushMode; 0: the brush's own */
};

const WrTool *wr_tool_now(const WrApp *app);
int wr_tool_find(const WrApp *app, const char *action); /* index in the registry, or -1 */
/* Make it the current tool; the previous one is left and its operation ended. */
void wr_tool_choose(WrApp *app, int index);

extern const WrPart wr_part_tools;

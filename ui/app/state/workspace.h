/* workspace.h - named arrangements of the window: tabs, views, folds, bars. Each remembers the user's changes. */
#pragma once
#include "ui/app/state/app_state.h"

typedef enum WrWorkspaceKind {
    WR_WORKSPACE_PAINT, /* the first is that of a new window */
    WR_WORKSPACE_GENERATE,
    WR_WORKSPACE_LIGHT,
    WR_WORKSPACE_EXPORT,
    WR_WORKSPACE_STUDY,
    WR_WORKSPACES
} WrWorkspaceKind;

typedef struct WrWorkspace {
    const char *name, *label;
    const char *tab;   /* label of the tab above the layers */
    const char *place; /* differences from the default settings, as in wr_settings_place_parse */
} WrWorkspace;

extern const WrWorkspace wr_workspaces[WR_WORKSPACES];

/* Name of the action that chooses it: "workspace_NAME". Returns buffer. */
const char *wr_workspace_action(WrWorkspaceKind kind, char buffer[48]);
/* Store the present workspace's places, and apply those of another one. */
void wr_workspace_choose(WrApp *app, WrWorkspaceKind kind);
/* Undo all changes of the present workspace. */
void wr_workspace_reset(WrApp *app);

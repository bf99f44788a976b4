/* bump_mode.h - names of the bump modes, whose formulas are in bump.h. */
#pragma once

typedef enum WrBumpMode {
    WR_BUMP_NONE,
    WR_BUMP_BLINN,
    WR_BUMP_INVARIANT,
    WR_BUMP_EXACT,
    WR_BUMP_COUNT
} WrBumpMode;

typedef struct WrBumpInfo {
    const char *name;  /* as in commands: "blinn" */
    const char *title; /* in lists of the window: "Blinn, N + D" */
} WrBumpInfo;
extern const WrBumpInfo wr_bumps[WR_BUMP_COUNT];

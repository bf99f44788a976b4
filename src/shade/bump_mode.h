/* bump_mode.h - names of the bump modes and of the ways to combine two reliefs; the formulas are in bump.h. */
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

/* The table's relief over a normal map. */
typedef enum WrCombine {
    WR_COMBINE_SLOPES,     /* slopes add: the relief rises along n */
    WR_COMBINE_REORIENTED, /* the relief's normal turns as n turned into the map's */
    WR_COMBINE_SURFACE,    /* the relief rises along the map's normal */
    WR_COMBINE_COUNT
} WrCombine;
/* As in commands: "slopes", "reoriented", "surface"; then NULL. */
extern const char *const wr_combine_names[WR_COMBINE_COUNT + 1];

/* panel_scene.h - the scene panel's own state. */
#pragma once
#include "surface/surface.h"

/* The texts of a surface as they are being written. */
typedef struct WrSurfaceHand {
    char text[WR_SURFACE_TEXTS][WR_SURFACE_TEXT_MAX + 1];
    uint64_t key; /* the data that they were taken from */
} WrSurfaceHand;

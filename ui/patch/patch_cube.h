/* patch_cube.h - orientation cube in the patch's corner. A click on a face, an edge or a corner rotates it to the
   front; a drag rotates freely. */
#pragma once
#include "ui/patch/preview/rotation.h"

#include <stdbool.h>

typedef struct WrApp WrApp;
typedef struct WrPointer WrPointer;

typedef struct WrPatchCube {
    bool pressed;        /* the drag started on the cube */
    double began;        /* clock at the start of the animation; 0: none */
    WrRotation from, to; /* orientations of the cube */
} WrPatchCube;

void wr_patch_cube_draw(const WrApp *app);
/* True if the pointer is over it. */
bool wr_patch_cube_under(const WrApp *app, const WrPointer *at);
/* Handle a click. */
void wr_patch_cube_click(WrApp *app, const WrPointer *at);
/* Advance the animation; its end becomes one command. now: jump to the end. */
void wr_patch_cube_update(WrApp *app, bool now);
/* Drag distance in pixels for half a rotation. */
double wr_patch_cube_span(void);

/* patch_cube.h - the cube in the patch's corner that stands as the patch does: a click on a face, an edge or a corner turns
   it to the front, a drag turns it by hand. */
#pragma once
#include "ui/preview/rotation.h"

#include <stdbool.h>

typedef struct WrApp WrApp;
typedef struct WrPointer WrPointer;

typedef struct WrPatchCube {
    bool pressed;        /* the drag began on it */
    double began;        /* clock at which it began to turn by itself; 0: it does not */
    WrRotation from, to; /* of the cube */
} WrPatchCube;

void wr_patch_cube_draw(const WrApp *app);
/* The pointer is on it. */
bool wr_patch_cube_under(const WrApp *app, const WrPointer *at);
/* It was clicked there. */
void wr_patch_cube_click(WrApp *app, const WrPointer *at);
/* Turn on, if it does; the end becomes one command. now: at once to the end. */
void wr_patch_cube_update(WrApp *app, bool now);
/* Pixels across which a drag on it turns it by half a turn. */
double wr_patch_cube_span(void);

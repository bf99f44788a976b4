/* dropped_files.h - files dropped on the window: documents and meshes open, drawings become layers, and a dialog offers the uses of pictures. */
#pragma once
#include "ui/app/state/app_state.h"

#include "base/array.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum WrDropUse {
    WR_DROP_LAYER,
    WR_DROP_STAMP,
    WR_DROP_COLOUR,
    WR_DROP_NORMALS,
    WR_DROP_SURROUND,
    WR_DROP_OPEN,
    WR_DROP_USES
} WrDropUse;

#define WR_DROP_SIDE 160 /* of the shown picture, pixels */

/* Pictures of the open dialog. Zeroed is empty. */
typedef struct WrDroppedFiles {
    WR_ARRAY(char *) paths; /* owned */
    int width, height;      /* of the first one, pixels */
    WrDropUse guess;
    int shown_w, shown_h; /* of it at most WR_DROP_SIDE on a side */
    uint8_t *rgb; /* [shown_h][shown_w][3], owned; black where it is not read within a second */
} WrDroppedFiles;

/* The likely use of a picture. floats: its values are no codes. rgb: [count][3] samples of it. Surroundings are floats, twice
   as wide as high; normal maps point upwards on average, towards blue; pictures without colour are heights. */
WrDropUse wr_drop_guess(int width, int height, bool floats, const uint8_t *rgb, int count);
/* A file dropped on the window. Pictures of one drop share a dialog. */
void wr_app_drop(WrApp *app, const char *path);
/* Forget the pictures. */
void wr_dropped_free(WrDroppedFiles *dropped);

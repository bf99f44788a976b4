/* tool_transform.h - state of the transform tool until it is applied. */
#pragma once
#include "ui/app/state/app_state.h"
#include "ui/canvas/tools/transform_snap.h"

#include "document/document.h"
#include "field/select.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrText WrText;

typedef enum WrTransformPart {
    WR_TRANSFORM_NONE,
    WR_TRANSFORM_MOVE,
    WR_TRANSFORM_TURN,
    WR_TRANSFORM_SCALE /* by one of eight handles */
} WrTransformPart;

/* Arguments of `transform`. Lengths are texels, y pointing down. */
typedef struct WrTransformValues {
    double move[2]; /* right, up */
    double scale[2];
    double turn; /* degrees */
} WrTransformValues;

typedef struct WrTransformState {
    bool measured; /* the box is up to date for the document's revision and the layers, */
    uint64_t revision;
    bool any; /* and is not empty */
    WrSelectBox box;
    bool layers[WR_LAYERS_MAX];   /* chosen when it was measured, */
    int layer_count;              /* and their number */
    WrTransformValues now, first; /* first: at the start of the drag */
    bool leave, all;
    bool leave_once, leave_first; /* a drag with Alt leaves a copy; first: at its start */
    WrTransformPart part;
    int side[2];    /* of the handle: -1, 0, 1 along the piece's axes, right and down */
    double from[2]; /* start of the drag, texels from the piece's centre at that time */
    int back;       /* 1 + index of the tool that Enter and Escape return to; 0: none */
    WrSnapOthers others;
    bool snapped[2]; /* along an axis in the drag, */
    double lines[2]; /* to this line, texels */
} WrTransformState;

/* Paste a picture as a layer above the active one, at most as large as the table, and choose the tool with its frame about
   it; Enter and Escape return to the tool before. at: u, v of its centre; NULL: the middle of the canvas. */
bool wr_transform_paste(WrApp *app, const char *path, const double at[2], WrError *err);
/* Add that position to the line of a paste. */
void wr_transform_add_place(const WrApp *app, const double at[2], WrText *line);

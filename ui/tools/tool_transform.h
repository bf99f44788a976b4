/* tool_transform.h - what is moved, turned and scaled by hand, until it is applied. */
#pragma once
#include "ui/state/app_state.h"

#include "field/select.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum WrTransformPart {
    WR_TRANSFORM_NONE,
    WR_TRANSFORM_MOVE,
    WR_TRANSFORM_TURN,
    WR_TRANSFORM_SCALE /* by one of eight handles */
} WrTransformPart;

/* As the arguments of `transform`. Lengths are texels, rows running down. */
typedef struct WrTransformValues {
    double move[2]; /* right, up */
    double scale[2];
    double turn; /* degrees */
} WrTransformValues;

typedef struct WrTransformHand {
    bool measured; /* the box is that of the selection by the document's revision, */
    uint64_t revision;
    bool any; /* and there is one */
    WrSelectBox box;
    WrTransformValues now, first; /* first: as the drag began */
    bool leave, all;
    WrTransformPart part;
    int side[2];    /* of the handle: -1, 0, 1 along the piece's axes, right and down */
    double from[2]; /* where the drag began, texels from the piece's middle as it was */
} WrTransformHand;

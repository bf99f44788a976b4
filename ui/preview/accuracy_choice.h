/* accuracy_choice.h - what a tolerance chose for a picture, as the window keeps it. */
#pragma once
#include "accuracy/tolerance.h"
#include "scene/dials.h"

#include <stdbool.h>

typedef struct WrChosen {
    bool any; /* a tolerance chose the dials of this picture */
    bool met;
    bool kept;        /* the document had them, for this very picture */
    char reason[480]; /* one or two sentences */
    char lines[2000]; /* a line a part: share, dials, kinds of blocks */
    /* One setting for all blocks that is as fine as the finest of any: keeps to the tolerance too. By WrDialId */
    double finest[WR_DIAL_COUNT];
} WrChosen;

void wr_chosen_from(const WrChoice *choice, WrChosen *out);

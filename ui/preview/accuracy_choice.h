/* accuracy_choice.h - dials that a tolerance chose for a picture, for display in the window. */
#pragma once
#include "accuracy/tolerance_search.h"
#include "scene/dials.h"

#include <stdbool.h>

typedef struct WrChosen {
    bool any; /* a tolerance chose this picture's dials */
    bool met;
    bool kept;        /* they were stored in the document for this very picture */
    char reason[480]; /* one or two sentences */
    char lines[2000]; /* one line per part: share, dials, kinds of blocks */
    /* One setting for all blocks, as fine as the finest of any block, so that it also meets the tolerance. By
       WrDialId */
    double finest[WR_DIAL_COUNT];
} WrChosen;

void wr_choice_summary(const WrChoice *choice, WrChosen *out);

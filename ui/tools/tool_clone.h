/* tool_clone.h - where cloned heights come from. */
#pragma once
#include "ui/state/roster.h"

#include <stdbool.h>

typedef struct WrCloneHand {
    bool source, anchored; /* a source was set; and a stroke tied it to the pointer */
    double source_u, source_v;
} WrCloneHand;

extern const WrPart wr_part_clone;

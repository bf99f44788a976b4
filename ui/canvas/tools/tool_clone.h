/* tool_clone.h - source of cloned heights. */
#pragma once
#include "ui/app/state/registry.h"

#include <stdbool.h>

typedef struct WrCloneState {
    bool source, anchored; /* a source is set; a stroke has fixed the offset */
    double source_u, source_v;
} WrCloneState;

extern const WrPart wr_part_clone;

/* hardcases_stretch.h - what objects that are stretched, mirrored or flat must keep to.
   Layer 6, private to the room. */
#pragma once
#include "hardcases/hardcases_internal.h"

bool wr_hard_hc33(WrHardGauge *gauge, WrError *err);
bool wr_hard_hc34(WrHardGauge *gauge, WrError *err);
bool wr_hard_hc153(WrHardGauge *gauge, WrError *err);
bool wr_hard_hc154(WrHardGauge *gauge, WrError *err);

/* hardcases_stretch.h - measurements of stretched, mirrored or flat objects.
   Private to this module. */
#pragma once
#include "hardcases/hardcases_internal.h"

bool wr_hard_hc33(WrHardGauge *gauge, WrError *err);
bool wr_hard_hc34(WrHardGauge *gauge, WrError *err);
bool wr_hard_hc153(WrHardGauge *gauge, WrError *err);
bool wr_hard_hc154(WrHardGauge *gauge, WrError *err);

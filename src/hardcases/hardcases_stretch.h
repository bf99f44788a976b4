/* hardcases_stretch.h - measurements of stretched, mirrored or flat objects.
   Private to this module. */
#pragma once
#include "hardcases/hardcases_internal.h"

bool wr_hard_hc33(WrHardMeasurement *gauge, WrError *err);
bool wr_hard_hc34(WrHardMeasurement *gauge, WrError *err);
bool wr_hard_hc153(WrHardMeasurement *gauge, WrError *err);
bool wr_hard_hc154(WrHardMeasurement *gauge, WrError *err);

/* idle_trim.h - release of cached memory after an idle period. */
#pragma once
#include "ui/state/roster.h"

extern const WrPart wr_part_thrift;

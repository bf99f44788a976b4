/* idle_trim.h - memory that nobody uses, while nobody uses the window. */
#pragma once
#include "ui/state/roster.h"

extern const WrPart wr_part_thrift;

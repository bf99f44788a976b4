/* thumbs.h - small pictures of presets and stamps. */
#pragma once
#include "ui/desk/roster.h"

extern const WrPart wr_part_thumbs;

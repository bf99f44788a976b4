/* hardcases_later.h - measurements of HC156 on, in files by subject, for their common list of rows. Private to
   this module. */
#pragma once
#include "hardcases/hardcases_internal.h"

#include <stdbool.h>

/* The precision that a picture of that arithmetic (WrHardWay) measures. */
static inline WrHardPrecision wr_hard_precision(int way)
{
    return way == WR_HARD_WIDE ? WR_HARD_DOUBLE : WR_HARD_FLOAT;
}

/* Renders pictures in every arithmetic and by the reference: every value must be finite. */
bool wr_hard_tame(WrHardMeasurement *gauge, const WrField *field, const WrScene *scene,
                  WrError *err);

/* clang-format off */
#define WR_HARD_LATER(X)                                                                           \
    X(156) X(157) X(158) X(159) X(160) X(161) X(162) X(163) X(164) X(165)                          \
    X(166) X(167) X(168) X(169) X(170) X(171) X(172) X(173) X(174) X(175)                          \
    X(176) X(177) X(178) X(179)
/* clang-format on */
#define WR_HARD_DECLARE(number) bool wr_hard_hc##number(WrHardMeasurement *gauge, WrError *err);
WR_HARD_LATER(WR_HARD_DECLARE)
#undef WR_HARD_DECLARE

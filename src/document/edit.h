/* edit.h - keeping an edit to the selection, and noting what a layer says something about.
   Layer 5. Knows fields only. Selections and coverage are 0..1; values outside count as 0 or 1. */
#pragma once

typedef struct WrField WrField;

/* What an edit that led from `before` to `after` leaves where it may act only inside a selection:
 *
 *   before + s (after - before),   in double, rounded once; before's bits where s = 0, after's where s = 1
 *
 * Tiles that come out as before are the very tiles of before. All of one size and wrap; selection NULL
 * gives a share of after. The caller owns the result. */
WrField *wr_edit_within(const WrField *before, const WrField *after, const WrField *selection);

/* Raise a layer's coverage to the selection's: max(cover, s); to 1 everywhere without one. Cover NULL, which
 * is 1 everywhere, stays so. */
void wr_edit_mark(WrField *cover, const WrField *selection);

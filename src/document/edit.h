/* edit.h - restriction of edits to the selection, and the coverage of a layer after an edit. Works on fields
   only. Selections and coverage are 0..1; values outside are clamped. */
#pragma once

typedef struct WrField WrField;

/* Result of an edit from `before` to `after` restricted to a selection:

     before + s (after - before),   in double, rounded once; before's bits if s = 0, after's if s = 1

   Unchanged tiles are shared with `before`. All fields have one size and wrap; without a selection, a share of
   after. The caller owns the result. */
WrField *wr_edit_within(const WrField *before, const WrField *after, const WrField *selection);

/* Raises a layer's coverage to the selection's: max(cover, s); to 1 everywhere without a selection. Cover NULL,
   which is 1 everywhere, is unchanged. */
void wr_edit_mark(WrField *cover, const WrField *selection);

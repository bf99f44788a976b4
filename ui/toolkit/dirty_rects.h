/* dirty_rects.h - changed regions of a frame against the previous one. Each drawing operation adds its hash to every
   square it touches, in order; squares with different hashes are redrawn. Pixels are not compared. */
#pragma once
#include <SDL.h>
#include <stdint.h>

#define WR_DIRTY_RECTS_MAX 16

typedef struct WrDirtyRects WrDirtyRects;

WrDirtyRects *wr_dirty_rects_new(void);
void wr_dirty_rects_free(WrDirtyRects *damage); /* NULL is allowed */
/* Start a frame of width x height pixels, both above 0. After a change of size all is dirty. */
void wr_dirty_rects_begin(WrDirtyRects *damage, int width, int height);
/* Add an operation, drawn over the previous ones; it touches no pixel beyond `box`. what: hash of its appearance,
   including its position. */
void wr_dirty_rects_add(WrDirtyRects *damage, const SDL_Rect *box, uint64_t what);
/* Mark `box` as dirty although its hash may be equal; allowed at any time, takes effect at the next end. */
void wr_dirty_rects_touch(WrDirtyRects *damage, const SDL_Rect *box);
/* Mark everything as dirty at the next end. */
void wr_dirty_rects_forget(WrDirtyRects *damage);
/* Finish the frame: returns the number of rectangles to redraw (0: none), which do not overlap. Each of the `count`
   boxes in `whole` that they touch is completely inside one of them. */
int wr_dirty_rects_end(WrDirtyRects *damage, const SDL_Rect *whole, int count,
                       SDL_Rect rects[WR_DIRTY_RECTS_MAX]);

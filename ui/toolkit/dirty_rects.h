/* dirty_rects.h - which parts of a picture are not as in the picture before: what is drawn is noted for each square that it
   touches, in order, and squares whose notes differ are drawn again. No pixel is looked at. */
#pragma once
#include <SDL.h>
#include <stdint.h>

#define WR_DIRTY_RECTS_RECTS 16

typedef struct WrDirtyRects WrDirtyRects;

WrDirtyRects *wr_dirty_rects_new(void);
void wr_dirty_rects_free(WrDirtyRects *damage); /* NULL is fine */
/* Another picture of width x height pixels, both above 0. Of another size than the last one all is damaged. */
void wr_dirty_rects_begin(WrDirtyRects *damage, int width, int height);
/* Something is drawn on top of what was; no pixel beyond `box` is touched. what: a hash of all that it looks like,
   place and all. */
void wr_dirty_rects_add(WrDirtyRects *damage, const SDL_Rect *box, uint64_t what);
/* What is drawn within `box` is not as it was, though its hash may be: at any time, for the next end. */
void wr_dirty_rects_touch(WrDirtyRects *damage, const SDL_Rect *box);
/* All is damaged, at the next end. */
void wr_dirty_rects_forget(WrDirtyRects *damage);
/* The picture is complete: rectangles that must be drawn again; they do not overlap. Each of the `count` boxes in `whole`
   that they touch lies in one of them altogether. Returns how many there are, 0: none. */
int wr_dirty_rects_end(WrDirtyRects *damage, const SDL_Rect *whole, int count,
                       SDL_Rect rects[WR_DIRTY_RECTS_RECTS]);

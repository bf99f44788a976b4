/* retained_frame.h - the picture of the window. What is drawn is noted first; at the end only what is not as in the picture before
   is drawn and put on the screen, where SDL draws by software: there each pixel counts. Elsewhere all of it is. The window's
   thread alone. */
#pragma once
#include "ui/toolkit/gui_sdl.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct WrRetainedFrame WrRetainedFrame;

WrRetainedFrame *wr_retained_frame_new(SDL_Renderer *renderer); /* which is borrowed */
void wr_retained_frame_free(WrRetainedFrame *kept); /* before the renderer; NULL is fine */
SDL_Renderer *wr_retained_frame_renderer(const WrRetainedFrame *kept);

/* Each of these is drawn on top of those before. Pixels of the window, colours 0xAARRGGBB; what is pointed at is copied,
   but for textures. */
void wr_retained_frame_clear(WrRetainedFrame *kept,
                             uint32_t argb); /* a new picture begins, in one colour */
void wr_retained_frame_fill(WrRetainedFrame *kept, const SDL_Rect *place, uint32_t argb);
/* Texels `of` (NULL: all) at `to`; the texture, which is borrowed, must last until the end. */
void wr_retained_frame_copy(WrRetainedFrame *kept, SDL_Texture *texture, const SDL_Rect *of,
                            const SDL_Rect *to);
/* The same, whose maker tells by wr_retained_frame_changed what changes in it, so that not all is drawn; scaled, all is. */
void wr_retained_frame_copy_told(WrRetainedFrame *kept, SDL_Texture *texture, const SDL_Rect *of,
                                 const SDL_Rect *to);
/* Such pixels within `place` of the window are others now; at any time, for the next end. */
void wr_retained_frame_changed(WrRetainedFrame *kept, const SDL_Rect *place);
void wr_retained_frame_points(WrRetainedFrame *kept, const SDL_Point *points, int count,
                              uint32_t argb);
/* Of the widgets; what it borrows lasts until the next picture begins. */
void wr_retained_frame_command(WrRetainedFrame *kept, const WrGuiCommand *command);

/* Draw it, and put it on the screen. */
void wr_retained_frame_end(WrRetainedFrame *kept);
/* What was noted is not drawn after all; the next picture is drawn whole. */
void wr_retained_frame_drop(WrRetainedFrame *kept);
/* Draw all of the picture again, as noted, and put it on the screen: gives the pixels that are there. For tests. */
void wr_retained_frame_draw_whole(WrRetainedFrame *kept);

#ifdef __cplusplus
}
#endif

/* retained_frame.h - retained frame of the window. Drawing operations are recorded; with SDL's software renderer,
   where each pixel is expensive, only regions that changed since the previous frame are drawn and presented at the
   end. With other renderers the whole frame is drawn. Window thread only. */
#pragma once
#include "ui/toolkit/gui_sdl_renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct WrRetainedFrame WrRetainedFrame;

WrRetainedFrame *wr_retained_frame_new(SDL_Renderer *renderer); /* the renderer is borrowed */
/* must be freed before the renderer; NULL is allowed */
void wr_retained_frame_free(WrRetainedFrame *kept);
SDL_Renderer *wr_retained_frame_renderer(const WrRetainedFrame *kept);

/* Record an operation over the previous ones. Pixels of the window, colours 0xAARRGGBB; pointed-to data is copied,
   except textures. */
/* starts a frame with one colour */
void wr_retained_frame_clear(WrRetainedFrame *kept, uint32_t argb);
void wr_retained_frame_fill(WrRetainedFrame *kept, const SDL_Rect *place, uint32_t argb);
/* Copy texels `of` (NULL: all) to `to`; the texture is borrowed and must stay valid until the end. */
void wr_retained_frame_copy(WrRetainedFrame *kept, SDL_Texture *texture, const SDL_Rect *of,
                            const SDL_Rect *to);
/* Copy a texture whose owner reports changes by wr_retained_frame_changed, so that only these are redrawn; if scaled,
   it is redrawn as a whole. */
void wr_retained_frame_copy_tracked(WrRetainedFrame *kept, SDL_Texture *texture, const SDL_Rect *of,
                                    const SDL_Rect *to);
/* Report changed pixels of such a texture within `place` of the window; allowed at any time, takes effect at the next
   end. */
void wr_retained_frame_changed(WrRetainedFrame *kept, const SDL_Rect *place);
void wr_retained_frame_points(WrRetainedFrame *kept, const SDL_Point *points, int count,
                              uint32_t argb);
/* Record widgets; borrowed data must stay valid until the next frame begins. */
void wr_retained_frame_command(WrRetainedFrame *kept, const WrGuiCommand *command);

/* Draw and present the frame. */
void wr_retained_frame_end(WrRetainedFrame *kept);
/* Discard the recorded frame; the next one is drawn completely. */
void wr_retained_frame_drop(WrRetainedFrame *kept);
/* Draw the whole recorded frame again and present it: the result must equal the displayed pixels. For tests. */
void wr_retained_frame_draw_whole(WrRetainedFrame *kept);

#ifdef __cplusplus
}
#endif

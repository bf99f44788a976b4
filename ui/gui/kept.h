/* kept.h - the picture of the window. What is drawn is noted first; at the end only what is not as in the picture before
   is drawn and put on the screen, where SDL draws by software: there each pixel counts. Elsewhere all of it is. The window's
   thread alone. */
#pragma once
#include "ui/gui/gui_sdl.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct WrKept WrKept;

WrKept *wr_kept_new(SDL_Renderer *renderer); /* which is borrowed */
void wr_kept_free(WrKept *kept);             /* before the renderer; NULL is fine */
SDL_Renderer *wr_kept_renderer(const WrKept *kept);

/* Each of these is drawn on top of those before. Pixels of the window, colours 0xAARRGGBB; what is pointed at is copied,
   but for textures. */
void wr_kept_clear(WrKept *kept, uint32_t argb); /* a new picture begins, in one colour */
void wr_kept_fill(WrKept *kept, const SDL_Rect *place, uint32_t argb);
/* Texels `of` (NULL: all) at `to`; the texture, which is borrowed, must last until the end. */
void wr_kept_copy(WrKept *kept, SDL_Texture *texture, const SDL_Rect *of, const SDL_Rect *to);
/* The same, whose maker tells by wr_kept_changed what changes in it, so that not all is drawn; scaled, all is. */
void wr_kept_copy_told(WrKept *kept, SDL_Texture *texture, const SDL_Rect *of, const SDL_Rect *to);
/* Such pixels within `place` of the window are others now; at any time, for the next end. */
void wr_kept_changed(WrKept *kept, const SDL_Rect *place);
void wr_kept_points(WrKept *kept, const SDL_Point *points, int count, uint32_t argb);
/* Of the widgets; what it borrows lasts until the next picture begins. */
void wr_kept_command(WrKept *kept, const WrGuiCommand *command);

/* Draw it, and put it on the screen. */
void wr_kept_end(WrKept *kept);
/* What was noted is not drawn after all; the next picture is drawn whole. */
void wr_kept_drop(WrKept *kept);
/* Draw all of the picture again, as noted, and put it on the screen: gives the pixels that are there. For tests. */
void wr_kept_draw_whole(WrKept *kept);

#ifdef __cplusplus
}
#endif

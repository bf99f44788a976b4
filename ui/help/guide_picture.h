/* guide_picture.h - the pictures of the guide, read in the background. */
#pragma once
#include <SDL.h>

typedef struct WrGuidePictures WrGuidePictures;

/* done_event: an SDL event type, pushed when another one is there. */
WrGuidePictures *wr_guide_pictures_new(SDL_Renderer *renderer, Uint32 done_event);
void wr_guide_pictures_free(WrGuidePictures *pictures); /* NULL is fine; before the renderer */
/* The picture of that path, as a page writes it; NULL while it is not there, or if it cannot be read. */
SDL_Texture *wr_guide_picture(WrGuidePictures *pictures, const char *path, int *width, int *height);
int wr_guide_pictures_made(const WrGuidePictures *pictures); /* how many are there: more is news */

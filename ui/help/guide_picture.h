/* guide_picture.h - pictures of the guide, loaded in the background. */
#pragma once
#include <SDL.h>

typedef struct WrGuidePictures WrGuidePictures;

/* done_event: an SDL event type, pushed when another picture is loaded. */
WrGuidePictures *wr_guide_pictures_new(SDL_Renderer *renderer, Uint32 done_event);
/* NULL is allowed; must be freed before the renderer */
void wr_guide_pictures_free(WrGuidePictures *pictures);
/* The picture of that path, as written in a page; NULL if it is not loaded yet, or unreadable. */
SDL_Texture *wr_guide_picture(WrGuidePictures *pictures, const char *path, int *width, int *height);
/* number of loaded pictures, to detect new ones */
int wr_guide_pictures_made(const WrGuidePictures *pictures);

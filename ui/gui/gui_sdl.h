/* gui_sdl.h - triangles of the widgets onto an SDL_Renderer. */
#pragma once
#include <SDL.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The layout of a vertex is the widget library's own: position, texture coordinate, colour. */
typedef struct WrGuiVertex {
    float x, y, u, v;
    SDL_Color colour;
} WrGuiVertex;

/* One command: triangles of `indices` into `vertices`, clipped. white_u, white_v: the texture
   coordinate of a white texel; triangles that lie wholly on it are drawn without the texture, which
   SDL's software renderer does several times faster. */
void wr_gui_sdl_draw(SDL_Renderer *renderer, SDL_Texture *texture, float white_u, float white_v,
                     const WrGuiVertex *vertices, int vertex_count, const uint16_t *indices,
                     int index_count, SDL_Rect clip);

/* All of the window, or a rectangle of it, in one colour (0xAARRGGBB). */
void wr_gui_sdl_clear(SDL_Renderer *renderer, uint32_t argb);
void wr_gui_sdl_fill(SDL_Renderer *renderer, const SDL_Rect *place, uint32_t argb);

/* A texture of white with the given coverage, from width x height RGBA bytes; NULL if SDL cannot. */
SDL_Texture *wr_gui_sdl_texture(SDL_Renderer *renderer, int width, int height, const void *rgba);

#ifdef __cplusplus
}
#endif

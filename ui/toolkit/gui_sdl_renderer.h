/* gui_sdl_renderer.h - drawing of the widgets' triangles with an SDL_Renderer. */
#pragma once
#include <SDL.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A vertex in ImGui's layout: position, texture coordinate, colour. */
typedef struct WrGuiVertex {
    float x, y, u, v;
    SDL_Color colour;
} WrGuiVertex;

/* Triangles of `indices` into `vertices`, clipped. white_u, white_v: texture coordinate of a white texel; triangles
   entirely on it are drawn without the texture, which is several times faster in SDL's software renderer. All
   borrowed. */
typedef struct WrGuiCommand {
    SDL_Texture *texture;
    int texture_w, texture_h; /* texels */
    float white_u, white_v;
    const WrGuiVertex *vertices;
    const uint16_t *indices;
    int index_count;
    SDL_Rect clip;
} WrGuiCommand;

typedef enum WrGuiKind {
    WR_GUI_NOTHING,  /* invisible */
    WR_GUI_TRIANGLE, /* textured triangle */
    WR_GUI_PLAIN,    /* triangle without texture */
    WR_GUI_FILL,     /* axis-aligned rectangle of one colour */
    WR_GUI_LETTER,   /* texels copied 1:1 to pixels, times one colour */
    /* scaled texels: SDL's result depends on the clip rectangle */
    WR_GUI_SCALED
} WrGuiKind;

/* The smallest part of a command that is drawn separately. */
typedef struct WrGuiPiece {
    WrGuiKind kind;
    int first, count; /* indices */
    SDL_Rect box;     /* touched pixels lie inside; clipped */
    SDL_Rect to, of;  /* of rectangles: pixels before clipping, and texels */
} WrGuiPiece;

/* The piece that starts at index `first`, a multiple of 3 below index_count. letters: SDL draws letters faster one by
   one; otherwise they are triangles. */
WrGuiPiece wr_gui_sdl_piece(const WrGuiCommand *command, int first, bool letters);

#define WR_GUI_PEN_VERTICES 768

/* Batches pieces that can be drawn together with the same result. */
typedef struct WrGuiPen {
    SDL_Renderer *renderer; /* borrowed, as is the texture */
    SDL_Texture *texture;   /* of the batched triangles; NULL: none */
    int count;              /* number of vertices, three per triangle */
    WrGuiVertex vertices[WR_GUI_PEN_VERTICES];
} WrGuiPen;

/* The renderer's clip must lie inside the command's. */
void wr_gui_sdl_piece_draw(WrGuiPen *pen, const WrGuiCommand *command, const WrGuiPiece *piece);
/* Draw the batched triangles: before the clip changes, before other drawing, and at the end. */
void wr_gui_sdl_flush(WrGuiPen *pen);

/* Fill a rectangle with one colour (0xAARRGGBB). */
void wr_gui_sdl_fill(SDL_Renderer *renderer, const SDL_Rect *place, uint32_t argb);

/* A white texture with the given coverage as alpha, from width x height RGBA bytes; NULL if SDL fails. */
SDL_Texture *wr_gui_sdl_texture(SDL_Renderer *renderer, int width, int height, const void *rgba);
/* Change pixels of a texture (place NULL: all), as SDL_UpdateTexture does. Textures shown by wr_retained_frame_copy
   or a widget must be changed only by this function. */
void wr_gui_sdl_update(SDL_Texture *texture, const SDL_Rect *place, const void *pixels, int pitch);
/* Revision of a texture, unique over all textures; 0: never changed. */
uintptr_t wr_gui_sdl_revision(const SDL_Texture *texture);

#ifdef __cplusplus
}
#endif

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

/* Triangles of `indices` into `vertices`, clipped. white_u, white_v: the texture coordinate of a white texel; triangles
   that lie wholly on it are drawn without the texture, which SDL's software renderer does several times faster. All
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
    WR_GUI_NOTHING,  /* to be seen */
    WR_GUI_TRIANGLE, /* of the texture */
    WR_GUI_PLAIN,    /* a triangle without it */
    WR_GUI_FILL,     /* an upright rectangle of one colour */
    WR_GUI_LETTER,   /* texels as pixels, times one colour */
    /* The same, larger or smaller: SDL draws other pixels when it is clipped otherwise. */
    WR_GUI_SCALED
} WrGuiKind;

/* A part of a command that is drawn by itself. */
typedef struct WrGuiPiece {
    WrGuiKind kind;
    int first, count; /* indices */
    SDL_Rect box;     /* no pixel beyond it is touched; clipped */
    SDL_Rect to, of;  /* of rectangles: pixels, not clipped, and texels */
} WrGuiPiece;

/* The piece that begins at index `first`, a multiple of 3 below index_count. letters: SDL draws the widgets' letters faster
   one by one; otherwise they are triangles. */
WrGuiPiece wr_gui_sdl_piece(const WrGuiCommand *command, int first, bool letters);

#define WR_GUI_PEN_VERTICES 768

/* Draws pieces, several at once where that gives the same pixels. */
typedef struct WrGuiPen {
    SDL_Renderer *renderer; /* borrowed, as is the texture */
    SDL_Texture *texture;   /* of the triangles below; NULL: none */
    int count;              /* vertices, three of each triangle */
    WrGuiVertex vertices[WR_GUI_PEN_VERTICES];
} WrGuiPen;

/* The renderer's clip must lie within the command's. */
void wr_gui_sdl_piece_draw(WrGuiPen *pen, const WrGuiCommand *command, const WrGuiPiece *piece);
/* What is still held back is drawn: before the clip changes, before others draw, and at the end. */
void wr_gui_sdl_flush(WrGuiPen *pen);

/* A rectangle in one colour (0xAARRGGBB). */
void wr_gui_sdl_fill(SDL_Renderer *renderer, const SDL_Rect *place, uint32_t argb);

/* A texture of white with the given coverage, from width x height RGBA bytes; NULL if SDL cannot. */
SDL_Texture *wr_gui_sdl_texture(SDL_Renderer *renderer, int width, int height, const void *rgba);
/* Pixels of a texture are others now (place NULL: all), as by SDL_UpdateTexture. Every texture that wr_retained_frame_copy or a widget
   shows is changed by this alone. */
void wr_gui_sdl_update(SDL_Texture *texture, const SDL_Rect *place, const void *pixels, int pitch);
/* Another number after each of these, of all textures; 0: never changed by it. */
uintptr_t wr_gui_sdl_revision(const SDL_Texture *texture);

#ifdef __cplusplus
}
#endif

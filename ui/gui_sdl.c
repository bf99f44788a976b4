/* SPDX-License-Identifier: MIT */
#include "ui/gui_sdl.h"

static bool is_white(const WrGuiVertex *vertices, const uint16_t *triangle, float u, float v)
{
    for (int k = 0; k < 3; k++) {
        const WrGuiVertex *at = &vertices[triangle[k]];
        if (at->u != u || at->v != v) return false;
    }
    return true;
}

static void draw_run(SDL_Renderer *renderer, SDL_Texture *texture, const WrGuiVertex *vertices,
                     int vertex_count, const uint16_t *indices, int index_count)
{
    const int stride = (int)sizeof(WrGuiVertex);
    SDL_RenderGeometryRaw(renderer, texture, &vertices->x, stride, &vertices->colour, stride,
                          texture ? &vertices->u : NULL, stride, vertex_count, indices, index_count,
                          (int)sizeof *indices);
}

void wr_gui_sdl_draw(SDL_Renderer *renderer, SDL_Texture *texture, float white_u, float white_v,
                     const WrGuiVertex *vertices, int vertex_count, const uint16_t *indices,
                     int index_count, SDL_Rect clip)
{
    SDL_RenderSetClipRect(renderer, &clip);
    int start = 0;
    bool plain = false;
    for (int i = 0; i + 2 < index_count; i += 3) {
        bool white = is_white(vertices, indices + i, white_u, white_v);
        if (i > start && white != plain) {
            draw_run(renderer, plain ? NULL : texture, vertices, vertex_count, indices + start,
                     i - start);
            start = i;
        }
        plain = white;
    }
    if (index_count > start)
        draw_run(renderer, plain ? NULL : texture, vertices, vertex_count, indices + start,
                 index_count - start);
    SDL_RenderSetClipRect(renderer, NULL);
}

SDL_Texture *wr_gui_sdl_texture(SDL_Renderer *renderer, int width, int height, const void *rgba)
{
    SDL_Texture *texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_ABGR8888,
                                             SDL_TEXTUREACCESS_STATIC, width, height);
    if (!texture) return NULL;
    SDL_UpdateTexture(texture, NULL, rgba, 4 * width);
    SDL_SetTextureBlendMode(texture, SDL_BLENDMODE_BLEND);
    SDL_SetTextureScaleMode(texture, SDL_ScaleModeLinear);
    return texture;
}

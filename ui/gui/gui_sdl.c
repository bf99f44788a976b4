#include "ui/gui/gui_sdl.h"

#include <SDL.h>
#include <math.h>

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

static bool same_colour(SDL_Color a, SDL_Color b)
{
    return a.r == b.r && a.g == b.g && a.b == b.b && a.a == b.a;
}

/* Two white triangles that make an upright rectangle of one colour, as the grounds of panels and fields
 * are: filled as one, which costs a fraction. Covers the pixels whose middles lie inside, as the triangles
 * would. */
static bool is_rectangle(const WrGuiVertex *vertices, const uint16_t *indices)
{
    if (indices[3] != indices[0] || indices[4] != indices[2]) return false;
    const WrGuiVertex *a = &vertices[indices[0]], *b = &vertices[indices[1]];
    const WrGuiVertex *c = &vertices[indices[2]], *d = &vertices[indices[5]];
    bool upright = a->y == b->y && c->y == d->y && a->x == d->x && b->x == c->x;
    bool plain = same_colour(a->colour, b->colour) && same_colour(a->colour, c->colour) &&
                 same_colour(a->colour, d->colour);
    return upright && plain && b->x >= a->x && c->y >= a->y;
}

static void fill(SDL_Renderer *renderer, const WrGuiVertex *vertices, const uint16_t *indices)
{
    const WrGuiVertex *a = &vertices[indices[0]], *c = &vertices[indices[2]];
    int x0 = (int)ceilf(a->x - 0.5f), x1 = (int)ceilf(c->x - 0.5f);
    int y0 = (int)ceilf(a->y - 0.5f), y1 = (int)ceilf(c->y - 0.5f);
    SDL_SetRenderDrawColor(renderer, a->colour.r, a->colour.g, a->colour.b, a->colour.a);
    /* SDL blends pixel by pixel even where nothing shines through. */
    bool opaque = a->colour.a == 255;
    if (opaque) SDL_SetRenderDrawBlendMode(renderer, SDL_BLENDMODE_NONE);
    SDL_RenderFillRect(renderer, &(SDL_Rect){ x0, y0, x1 - x0, y1 - y0 });
    if (opaque) SDL_SetRenderDrawBlendMode(renderer, SDL_BLENDMODE_BLEND);
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
        bool pair = white && i + 5 < index_count &&
                    is_white(vertices, indices + i + 3, white_u, white_v) &&
                    is_rectangle(vertices, indices + i);
        if (i > start && (white != plain || pair)) {
            draw_run(renderer, plain ? NULL : texture, vertices, vertex_count, indices + start,
                     i - start);
            start = i;
        }
        if (pair) {
            fill(renderer, vertices, indices + i);
            i += 3;
            start = i + 3;
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

static void take_colour(SDL_Renderer *renderer, uint32_t argb)
{
    SDL_SetRenderDrawColor(renderer, (uint8_t)(argb >> 16), (uint8_t)(argb >> 8), (uint8_t)argb,
                           (uint8_t)(argb >> 24));
}

void wr_gui_sdl_clear(SDL_Renderer *renderer, uint32_t argb)
{
    take_colour(renderer, argb);
    SDL_RenderClear(renderer);
}

void wr_gui_sdl_fill(SDL_Renderer *renderer, const SDL_Rect *place, uint32_t argb)
{
    take_colour(renderer, argb);
    SDL_RenderFillRect(renderer, place);
}

#include "ui/toolkit/gui_sdl_renderer.h"

#include <SDL.h>
#include <math.h>

/* ---- pieces ---- */

static bool is_white(const WrGuiCommand *command, const uint16_t *triangle)
{
    for (int k = 0; k < 3; k++) {
        const WrGuiVertex *at = &command->vertices[triangle[k]];
        if (at->u != command->white_u || at->v != command->white_v) return false;
    }
    return true;
}

static bool same_colour(SDL_Color a, SDL_Color b)
{
    return a.r == b.r && a.g == b.g && a.b == b.b && a.a == b.a;
}

/* True for two triangles that form an axis-aligned rectangle of one colour: the first corner is the upper left one,
 * the third the lower right one, and the same holds for the texture. */
static bool is_rectangle(const WrGuiVertex *vertices, const uint16_t *indices)
{
    if (indices[3] != indices[0] || indices[4] != indices[2]) return false;
    const WrGuiVertex *a = &vertices[indices[0]], *b = &vertices[indices[1]];
    const WrGuiVertex *c = &vertices[indices[2]], *d = &vertices[indices[5]];
    bool upright = a->y == b->y && c->y == d->y && a->x == d->x && b->x == c->x;
    bool plain = same_colour(a->colour, b->colour) && same_colour(a->colour, c->colour) &&
                 same_colour(a->colour, d->colour);
    bool texels = a->v == b->v && c->v == d->v && a->u == d->u && b->u == c->u;
    return upright && plain && texels && b->x >= a->x && c->y >= a->y && c->u >= a->u &&
           c->v >= a->v;
}

/* Pixels whose centres lie inside, as two triangles would cover them. */
static void make_fill(const WrGuiVertex *a, const WrGuiVertex *c, WrGuiPiece *piece)
{
    int x0 = (int)ceilf(a->x - 0.5f), x1 = (int)ceilf(c->x - 0.5f);
    int y0 = (int)ceilf(a->y - 0.5f), y1 = (int)ceilf(c->y - 0.5f);
    piece->to = (SDL_Rect){ x0, y0, x1 - x0, y1 - y0 };
    piece->kind = x1 > x0 && y1 > y0 ? WR_GUI_FILL : WR_GUI_NOTHING;
}

/* Round a sum of fractions that may deviate slightly from an integer. */
static int whole(float x)
{
    return (int)floorf(x + 0.01f);
}

/* False: it has no texels of its own. */
static bool make_copy(const WrGuiCommand *command, const WrGuiVertex *a, const WrGuiVertex *c,
                      WrGuiPiece *piece)
{
    const float w = (float)command->texture_w, h = (float)command->texture_h;
    const int u = whole(a->u * w), v = whole(a->v * h);
    piece->of = (SDL_Rect){ u, v, whole(c->u * w) - u, whole(c->v * h) - v };
    piece->to =
        (SDL_Rect){ (int)floorf(a->x), (int)floorf(a->y), whole(c->x - a->x), whole(c->y - a->y) };
    if (piece->of.w <= 0 || piece->of.h <= 0) return false;
    const bool same = piece->of.w == piece->to.w && piece->of.h == piece->to.h;
    const bool any = piece->to.w > 0 && piece->to.h > 0;
    piece->kind = !any ? WR_GUI_NOTHING : same ? WR_GUI_LETTER : WR_GUI_SCALED;
    return true;
}

/* Bounding box of the corners, enlarged by one pixel. */
static void make_triangle(const WrGuiCommand *command, bool white, WrGuiPiece *piece)
{
    const uint16_t *indices = command->indices + piece->first;
    float x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const WrGuiVertex *at = &command->vertices[indices[k]];
        x0 = fminf(x0, at->x), x1 = fmaxf(x1, at->x);
        y0 = fminf(y0, at->y), y1 = fmaxf(y1, at->y);
    }
    const float most = 1e6f; /* far beyond any window; also excludes NaN */
    if (!(x0 > -most && y0 > -most && x1 < most && y1 < most)) return;
    const int left = (int)floorf(x0) - 1, top = (int)floorf(y0) - 1;
    piece->to = (SDL_Rect){ left, top, (int)ceilf(x1) + 1 - left, (int)ceilf(y1) + 1 - top };
    piece->kind = white ? WR_GUI_PLAIN : WR_GUI_TRIANGLE;
}

WrGuiPiece wr_gui_sdl_piece(const WrGuiCommand *command, int first, bool letters)
{
    const uint16_t *indices = command->indices + first;
    WrGuiPiece piece = { .first = first, .count = 3 };
    const bool white = is_white(command, indices);
    bool done = false;
    if (first + 5 < command->index_count && is_rectangle(command->vertices, indices)) {
        const WrGuiVertex *a = &command->vertices[indices[0]], *c = &command->vertices[indices[2]];
        done = true;
        if (white && is_white(command, indices + 3)) make_fill(a, c, &piece);
        else done = letters && make_copy(command, a, c, &piece);
        if (done) piece.count = 6;
    }
    if (!done) make_triangle(command, white, &piece);
    if (!SDL_IntersectRect(&piece.to, &command->clip, &piece.box)) piece.kind = WR_GUI_NOTHING;
    return piece;
}

/* ---- drawing ---- */

void wr_gui_sdl_flush(WrGuiPen *pen)
{
    const int stride = (int)sizeof(WrGuiVertex);
    const WrGuiVertex *at = pen->vertices;
    if (pen->count > 0)
        SDL_RenderGeometryRaw(pen->renderer, pen->texture, &at->x, stride, &at->colour, stride,
                              pen->texture ? &at->u : NULL, stride, pen->count, NULL, 0, 0);
    pen->count = 0;
}

static void hold_back(WrGuiPen *pen, const WrGuiCommand *command, const WrGuiPiece *piece)
{
    SDL_Texture *texture = piece->kind == WR_GUI_PLAIN ? NULL : command->texture;
    if (texture != pen->texture || pen->count + 3 > WR_GUI_PEN_VERTICES) wr_gui_sdl_flush(pen);
    pen->texture = texture;
    for (int k = 0; k < 3; k++)
        pen->vertices[pen->count++] = command->vertices[command->indices[piece->first + k]];
}

static void copy(const WrGuiPen *pen, SDL_Texture *texture, const WrGuiPiece *piece, SDL_Color c)
{
    SDL_SetTextureColorMod(texture, c.r, c.g, c.b);
    SDL_SetTextureAlphaMod(texture, c.a);
    SDL_RenderCopy(pen->renderer, texture, &piece->of, &piece->to);
    SDL_SetTextureColorMod(texture, 255, 255, 255);
    SDL_SetTextureAlphaMod(texture, 255);
}

void wr_gui_sdl_piece_draw(WrGuiPen *pen, const WrGuiCommand *command, const WrGuiPiece *piece)
{
    const SDL_Color colour = command->vertices[command->indices[piece->first]].colour;
    switch (piece->kind) {
    case WR_GUI_NOTHING: break;
    case WR_GUI_TRIANGLE:
    case WR_GUI_PLAIN: hold_back(pen, command, piece); break;
    case WR_GUI_FILL:
        wr_gui_sdl_flush(pen);
        wr_gui_sdl_fill(pen->renderer, &piece->to,
                        (uint32_t)colour.a << 24 | (uint32_t)colour.r << 16 |
                            (uint32_t)colour.g << 8 | colour.b);
        break;
    case WR_GUI_LETTER:
    case WR_GUI_SCALED:
        wr_gui_sdl_flush(pen);
        copy(pen, command->texture, piece, colour);
        break;
    }
}

/* Opaque fills skip blending, which SDL does for each pixel even at full alpha. */
void wr_gui_sdl_fill(SDL_Renderer *renderer, const SDL_Rect *place, uint32_t argb)
{
    const bool opaque = argb >> 24 == 255;
    SDL_SetRenderDrawColor(renderer, (uint8_t)(argb >> 16), (uint8_t)(argb >> 8), (uint8_t)argb,
                           (uint8_t)(argb >> 24));
    SDL_SetRenderDrawBlendMode(renderer, opaque ? SDL_BLENDMODE_NONE : SDL_BLENDMODE_BLEND);
    SDL_RenderFillRect(renderer, place);
    SDL_SetRenderDrawBlendMode(renderer, SDL_BLENDMODE_BLEND);
}

/* ---- textures ---- */

SDL_Texture *wr_gui_sdl_texture(SDL_Renderer *renderer, int width, int height, const void *rgba)
{
    SDL_Texture *texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_ABGR8888,
                                             SDL_TEXTUREACCESS_STATIC, width, height);
    if (!texture) return NULL;
    wr_gui_sdl_update(texture, NULL, rgba, 4 * width);
    SDL_SetTextureBlendMode(texture, SDL_BLENDMODE_BLEND);
    SDL_SetTextureScaleMode(texture, SDL_ScaleModeLinear);
    return texture;
}

/* The count is shared by all textures, so that a new texture at the same address has another revision. */
void wr_gui_sdl_update(SDL_Texture *texture, const SDL_Rect *place, const void *pixels, int pitch)
{
    static uintptr_t newest;
    SDL_UpdateTexture(texture, place, pixels, pitch);
    SDL_SetTextureUserData(texture, (void *)++newest);
}

uintptr_t wr_gui_sdl_revision(const SDL_Texture *texture)
{
    return (uintptr_t)SDL_GetTextureUserData((SDL_Texture *)texture);
}

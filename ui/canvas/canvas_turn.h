/* canvas_turn.h - rotation of a picture with bilinear filtering. Tested without a window. */
#pragma once
#include <SDL.h>
#include <stdint.h>

/* Fill `rect` (pixels of `to`, within it) of the picture to[to_h][to_w] from from[from_h][from_w], both ARGB, rotated
   clockwise by `degrees` about the centres of both. Bilinear interpolation keeps all colours in quarter turns. from
   must extend one pixel beyond the visible area. */
void wr_canvas_turn(const uint32_t *from, int from_w, int from_h, uint32_t *to, int to_w, int to_h,
                    double degrees, SDL_Rect rect);
/* The rectangle of the rotated picture that is affected by a rectangle of the flat one. */
SDL_Rect wr_canvas_turned_rect(SDL_Rect rect, int from_w, int from_h, int to_w, int to_h,
                               double degrees);

/* canvas_turn.h - a picture, turned. Tested without a window. */
#pragma once
#include <SDL.h>
#include <stdint.h>

/* Fill `rect` (pixels of `to`, within it) of the picture to[to_h][to_w] with from[from_h][from_w], both ARGB, turned clockwise by `degrees` about the middles of both; between pixels
   straight lines, so that quarters keep every colour. from must reach a pixel beyond all that is seen. */
void wr_canvas_turn(const uint32_t *from, int from_w, int from_h, uint32_t *to, int to_w, int to_h,
                    double degrees, SDL_Rect rect);
/* The rectangle of the turned picture that holds all that a rectangle of the flat one has a share in. */
SDL_Rect wr_canvas_turned_rect(SDL_Rect rect, int from_w, int from_h, int to_w, int to_h,
                               double degrees);

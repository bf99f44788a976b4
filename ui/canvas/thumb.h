/* thumb.h - small pictures of tables for lists. Pure; tested without a window. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;

#define WR_THUMB_MAX 128 /* pixels along a side */

/* A picture of side x side pixels (1..WR_THUMB_MAX) of the whole table, squeezed where it is not square:
 * grey from the lowest to the highest height seen, four texels a pixel, so that the cost does not depend
 * on the table's size. A flat table shows its height, 0 black and 1 white. With a cover the ground, 0, is
 * middle grey, so that what is raised and what is lowered both stand out.
 *
 * cover  0..1, of the field's size: where it is 0 the background shows; NULL: 1 everywhere
 * unit   true: black is 0 and white is 1 whatever is seen, as for masks
 * argb   [side * side] 0xAARRGGBB */
void wr_thumb_draw(const WrField *field, const WrField *cover, bool unit, int side, uint32_t *argb);

/* thumb.h - thumbnails of tables for lists. Pure; tested without a window. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrField WrField;

#define WR_THUMB_MAX 128 /* largest side in pixels */

/* Draw a picture of side x side pixels (1..WR_THUMB_MAX) of the whole table, stretched to a square: grey from the
 * lowest to the highest sampled height. Four texels per pixel are read, so the cost is independent of the table's
 * size. A flat table shows its height, 0 black and 1 white. With a cover, height 0 is middle grey, so that raised and
 * lowered areas are both visible.
 *
 * cover  0..1, of the field's size: the background shows where it is 0; NULL: 1 everywhere
 * unit   true: fixed range, black is 0 and white is 1, as for masks
 * argb   [side * side] 0xAARRGGBB */
void wr_thumb_draw(const WrField *field, const WrField *cover, bool unit, int side, uint32_t *argb);

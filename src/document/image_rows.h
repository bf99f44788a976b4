/* image_rows.h - conversion of a scene's picture to float rows, for saving.
   Private to this module. */
#pragma once
typedef struct WrImage WrImage;

/* Copies rows [y, y + rows) with that number of channels: the picture's first ones, or its only one into each.
   out: floats. */
void wr_image_rows_out(const WrImage *image, int channels, int y, int rows, float *out);

/* image_rows.h - rows of a picture that the scene holds, for the file that keeps it.
   Private to this room. */
#pragma once
typedef struct WrImage WrImage;

/* The rows [y, y + rows) with so many channels: the picture's first ones, or its only one in each. out: floats. */
void wr_image_rows_out(const WrImage *image, int channels, int y, int rows, float *out);

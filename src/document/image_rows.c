#include "document/image_rows.h"

#include "image/image.h"

void wr_image_rows_out(const WrImage *image, int channels, int y, int rows, float *out)
{
    const size_t first = (size_t)y * (size_t)image->width;
    const size_t count = (size_t)rows * (size_t)image->width;
    const size_t step = (size_t)image->channels, wide = (size_t)channels;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < wide; c++)
            out[wide * i + c] = image->data[(first + i) * step + (step < wide ? 0 : c)];
}

#include "brush/tip_internal.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/image.h"

#include <string.h>

/* The coverage is luma times alpha, in 0..1. From 8-bit files it is stored in codes 0..255, and
   wr_tip_cell_build_levels smooths the steps of the codes; from other files in 0..1, with `codes` 0 and no smoothing. */
static WrTip *from_image(const WrImage *image, const char *path, WrError *err)
{
    int codes = image->type == WR_PIXEL_U8 ? 255 : 0;
    float steps = codes > 0 ? (float)codes : 1.0f;
    WrTip *tip = wr_tip_blank(1);
    if (!wr_tip_cell_alloc(tip, 0, image->width, image->height, path, err)) goto fail;
    size_t count = (size_t)image->width * (size_t)image->height;
    int channels = image->channels;
    for (size_t i = 0; i < count; i++) {
        const float *pixel = image->data + i * (size_t)channels;
        float alpha = channels == 2 || channels == 4 ? pixel[channels - 1] : 1.0f;
        float value = wr_image_luma(pixel, channels) * alpha;
        value = value > 0.0f ? value < 1.0f ? value : 1.0f : 0.0f;
        tip->cell[0].values[i] = value * steps;
    }
    if (!wr_tip_cell_build_levels(tip, 0, codes, err)) goto fail;
    return tip;
fail:
    wr_tip_free(tip);
    return NULL;
}

WrTip *wr_tip_read(const char *path, WrError *err)
{
    char ending[16];
    wr_path_ending(path, ending);
    if (strcmp(ending, "gbr") != 0 && strcmp(ending, "gih") != 0) {
        WrImage *image = wr_image_read(path, err);
        WrTip *tip = image ? from_image(image, path, err) : NULL;
        wr_image_free(image);
        return tip;
    }
    char *bytes = NULL;
    size_t size = 0;
    if (!wr_file_read(path, WR_TIP_BYTES, &bytes, &size, err)) return NULL;
    WrTip *tip = wr_tip_parse(bytes, size, path, err);
    wr_free(bytes);
    return tip;
}

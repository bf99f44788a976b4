#include "ui/preview/picture_heatmap.h"
#include "ui/preview/preview.h"

#include "base/memory.h"
#include "render/plan/effect_heatmap.h"

#include <string.h>

static bool make_room(WrPictureRan *ran, int width, int height, WrError *err)
{
    if (ran->map && ran->width == width && ran->height == height) return true;
    wr_free(ran->map);
    ran->map = wr_try_alloc((size_t)width * (size_t)height, 1, "the preview", err);
    ran->width = width;
    ran->height = height;
    return ran->map != NULL;
}

bool wr_picture_heatmap_update(WrPictureRan *ran, WrFrameRequest *request, WrError *err)
{
    if (!make_room(ran, request->width, request->height, err)) return false;
    request->map = ran->map;
    return true;
}

void wr_picture_ran_show(const WrPictureRan *ran, WrPreviewPicture *out)
{
    const size_t pixels = (size_t)ran->width * (size_t)ran->height;
    uint8_t rgb[256][3], bgra[256][4];
    wr_heatmap_count(ran->map, pixels, &out->counts);
    wr_heatmap_colours(&out->counts, rgb);
    for (int b = 0; b < 256; b++) {
        for (int c = 0; c < 3; c++) bgra[b][c] = rgb[b][2 - c];
        bgra[b][3] = 255;
    }
    for (size_t i = 0; i < pixels; i++) memcpy(out->bgra + 4 * i, bgra[ran->map[i]], 4);
}

#include "ui/preview/picture_upload.h"
#include "ui/preview/checkerboard.h"
#include "ui/preview/overexposure.h"
#include "ui/preview/picture_heatmap.h"
#include "ui/preview/preview.h"

#include "base/error.h"
#include "base/memory.h"
#include "render/frame/frame.h"
#include "scene/scene.h"

#include <string.h>

bool wr_preview_look_same(const WrPreviewLook *a, const WrPreviewLook *b)
{
    return a->ran == b->ran && a->marked == b->marked && a->force == b->force &&
           (!a->force || a->effect == b->effect);
}

void wr_picture_put(WrPreviewPicture *picture, const WrFrame *frame, const WrFrameRequest *request,
                    const WrPreviewLook *look, double scale, const WrPictureRan *ran, WrPool *pool)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    picture->clipped = 0;
    if (look->ran) {
        wr_picture_ran_show(ran, picture);
        return;
    }
    if (frame->codes) memcpy(picture->bgra, frame->codes, 4 * pixels);
    else wr_frame_to_srgb8(frame, &request->codes, true, picture->bgra, pool);
    if (!request->codes.wanted && frame->rgba)
        wr_chequer_behind(frame, &request->scene->tone, scale, picture->bgra);
    picture->clipped = wr_overexposed(picture->bgra, frame->width, frame->height, look->marked);
}

/* ---- pixels of a picture ---- */

void wr_picture_free(WrPreviewPicture *picture)
{
    if (picture) wr_free(picture->bgra);
    if (picture) wr_free(picture->kept);
    wr_free(picture);
}

bool wr_picture_room(WrPreviewPicture *picture, int width, int height, WrError *err)
{
    if (picture->bgra && picture->width == width && picture->height == height) return true;
    uint8_t *bgra = wr_try_alloc((size_t)width * (size_t)height, 4, "the preview", err);
    if (!bgra) return false;
    wr_free(picture->bgra);
    picture->bgra = bgra;
    picture->width = width;
    picture->height = height;
    return true;
}

static const uint8_t *row_of(const WrPreviewPicture *picture, int y)
{
    return picture->bgra + 4 * (size_t)picture->width * (size_t)y;
}

/* The first differing pixel of a row before `most`; and the last one after `least`. */
static int first_other(const uint8_t *a, const uint8_t *b, int most)
{
    int x = 0;
    while (x < most && memcmp(a + 4 * x, b + 4 * x, 4) == 0) x++;
    return x;
}

static int last_other(const uint8_t *a, const uint8_t *b, int width, int least)
{
    int x = width - 1;
    while (x > least && memcmp(a + 4 * x, b + 4 * x, 4) == 0) x--;
    return x;
}

void wr_picture_compare(WrPreviewPicture *picture, const WrPreviewPicture *before)
{
    const int width = picture->width, height = picture->height;
    int left = width, right = -1, top = height, bottom = -1;
    picture->changed = (SDL_Rect){ 0, 0, width, height };
    picture->since = 0;
    if (!before || before->width != width || before->height != height) return;
    for (int y = 0; y < height; y++) {
        const uint8_t *a = row_of(picture, y), *b = row_of(before, y);
        if (memcmp(a, b, 4 * (size_t)width) == 0) continue;
        left = first_other(a, b, left);
        right = last_other(a, b, width, right);
        if (top > y) top = y;
        bottom = y;
    }
    picture->since = before->serial;
    picture->changed = bottom < 0 ? (SDL_Rect){ 0, 0, 0, 0 }
                                  : (SDL_Rect){ left, top, right + 1 - left, bottom + 1 - top };
}

void wr_picture_follow(WrPreviewPicture *picture, const WrPreviewPicture *missed)
{
    if (picture->since != missed->serial) return;
    SDL_UnionRect(&picture->changed, &missed->changed, &picture->changed);
    picture->since = missed->since;
}

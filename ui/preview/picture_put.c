#include "ui/preview/picture_put.h"
#include "ui/preview/chequer.h"
#include "ui/preview/clipped.h"
#include "ui/preview/picture_ran.h"
#include "ui/preview/preview.h"

#include "render/frame.h"
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
    picture->clipped = wr_clipped(picture->bgra, frame->width, frame->height, look->marked);
}

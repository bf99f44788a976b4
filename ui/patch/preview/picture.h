/* picture.h - conversion of a rendered frame to the preview's pixels, and comparison of pictures. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrFrame WrFrame;
typedef struct WrFrameRequest WrFrameRequest;
typedef struct WrPictureRan WrPictureRan;
typedef struct WrPool WrPool;
typedef struct WrPreviewLook WrPreviewLook;
typedef struct WrPreviewPicture WrPreviewPicture;

/* scale: frame pixels per view pixel; ran: effects of each pixel, if the view mode needs them. */
void wr_picture_put(WrPreviewPicture *picture, const WrFrame *frame, const WrFrameRequest *request,
                    const WrPreviewLook *look, double scale, const WrPictureRan *ran, WrPool *pool);

void wr_picture_free(WrPreviewPicture *picture); /* NULL is allowed */
/* Allocate pixels, width and height at least 1. Errors: out of memory; the picture is then unchanged. */
bool wr_picture_room(WrPreviewPicture *picture, int width, int height, WrError *err);
/* Set `changed` and `since` by comparison with the previous picture (NULL: none), whose pixels must not change
   meanwhile. */
void wr_picture_compare(WrPreviewPicture *picture, const WrPreviewPicture *before);
/* `missed`, the previous picture, will never be delivered: refer to the one before it. */
void wr_picture_follow(WrPreviewPicture *picture, const WrPreviewPicture *missed);

/* ---- effect heatmap of the preview ---- */

/* Effects of each pixel from the renderer; pixels reused in a static view keep theirs. */
typedef struct WrPictureRan {
    uint8_t *map; /* [height][width], owned; NULL: none yet */
    int width, height;
} WrPictureRan;

/* Make the request fill the map. Errors: out of memory. */
bool wr_picture_heatmap_update(WrPictureRan *ran, WrFrameRequest *request, WrError *err);

/* ---- checkerboard behind transparent areas of a picture ---- */

typedef struct WrTone WrTone;

/* picture_heatmap.h - the preview's picture in false colours: where each effect ran. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrFrameRequest WrFrameRequest;
typedef struct WrPreviewPicture WrPreviewPicture;

/* What each pixel took, as the renderer left it: of pixels that a resting view keeps it is kept too. */
typedef struct WrPictureRan {
    uint8_t *map; /* [height][width], owned by whom this is; NULL: none yet */
    int width, height;
} WrPictureRan;

/* Have the request fill the map. Errors: no memory. */
bool wr_picture_ran_bring(WrPictureRan *ran, WrFrameRequest *request, WrError *err);
/* Into the picture's pixels, of the same size, and its counts. */
void wr_picture_ran_show(const WrPictureRan *ran, WrPreviewPicture *out);

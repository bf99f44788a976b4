/* picture_heatmap.h - effect heatmap of the preview: false colours for the effects that ran in each pixel. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrFrameRequest WrFrameRequest;
typedef struct WrPreviewPicture WrPreviewPicture;

/* Effects of each pixel from the renderer; pixels reused in a static view keep theirs. */
typedef struct WrPictureRan {
    uint8_t *map; /* [height][width], owned; NULL: none yet */
    int width, height;
} WrPictureRan;

/* Make the request fill the map. Errors: out of memory. */
bool wr_picture_heatmap_update(WrPictureRan *ran, WrFrameRequest *request, WrError *err);
/* Write the colours to the picture's pixels, of the same size, and its counts. */
void wr_picture_ran_show(const WrPictureRan *ran, WrPreviewPicture *out);

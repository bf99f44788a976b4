/* picture_upload.h - from a rendered frame to the pixels of the preview's picture. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrFrame WrFrame;
typedef struct WrFrameRequest WrFrameRequest;
typedef struct WrPictureRan WrPictureRan;
typedef struct WrPool WrPool;
typedef struct WrPreviewLook WrPreviewLook;
typedef struct WrPreviewPicture WrPreviewPicture;

/* scale: the frame's pixels to one of the view's; ran: what each took, where the look asks for that. */
void wr_picture_put(WrPreviewPicture *picture, const WrFrame *frame, const WrFrameRequest *request,
                    const WrPreviewLook *look, double scale, const WrPictureRan *ran, WrPool *pool);

void wr_picture_free(WrPreviewPicture *picture); /* NULL is fine */
/* Room for its pixels, width and height at least 1. Errors: no memory; it is as it was then. */
bool wr_picture_room(WrPreviewPicture *picture, int width, int height, WrError *err);
/* Set `changed` and `since` by the picture before (NULL: there is none), whose pixels must not change meanwhile. */
void wr_picture_compare(WrPreviewPicture *picture, const WrPreviewPicture *before);
/* `missed`, the picture before it, is never handed over: it counts from what that counts from. */
void wr_picture_follow(WrPreviewPicture *picture, const WrPreviewPicture *missed);

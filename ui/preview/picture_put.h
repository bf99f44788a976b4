/* picture_put.h - from a rendered frame to the pixels of the preview's picture. */
#pragma once

typedef struct WrFrame WrFrame;
typedef struct WrFrameRequest WrFrameRequest;
typedef struct WrPictureRan WrPictureRan;
typedef struct WrPool WrPool;
typedef struct WrPreviewLook WrPreviewLook;
typedef struct WrPreviewPicture WrPreviewPicture;

/* scale: the frame's pixels to one of the view's; ran: what each took, where the look asks for that. */
void wr_picture_put(WrPreviewPicture *picture, const WrFrame *frame, const WrFrameRequest *request,
                    const WrPreviewLook *look, double scale, const WrPictureRan *ran, WrPool *pool);

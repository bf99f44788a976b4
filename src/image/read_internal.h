/* read_internal.h - reading functions used by whole-image reading and by readback.
   Private to this module. */
#pragma once
#include "image/image.h"

#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrHash WrHash;
typedef struct WrImage WrImage;
typedef struct WrImageFile WrImageFile;
typedef struct WrImageRows WrImageRows;
typedef struct WrImageRequest WrImageRequest;

/* The rows of an existing image, owned by the result. keep: non-finite values are kept. */
WrImageRows *wr_image_rows_of(WrImage *image, bool keep);

/* The file of a descriptor, owned by the result. levels: mip levels of its first part, instead of
 * parts. */
WrImageFile *wr_image_file_take(const char *name, int fd, bool levels, WrError *err);
/* Chains rows of a part into *digest (decode.h). y: a multiple of WR_IMAGE_STRIP. */
bool wr_image_file_digest(WrImageFile *file, int part, int y, int rows, WrHash *digest,
                          WrError *err);

/* ---- parser of an image file's label (WrImageLabel, image.h) ---- */

/* The text of that name, or NULL. */
typedef const char *WrLabelText(const void *from, const char *name);
void wr_image_label_read(WrLabelText *text, const void *from, WrPixelType type,
                         WrImageLabel *label);

/* read_inner.h - what reading back what was written needs of reading.
   Private to this room. */
#pragma once
#include "base/hash.h"
#include "image/image.h"

/* The file behind a descriptor, which is taken over. */
WrImageFile *wr_image_file_take(const char *name, int fd, WrError *err);
/* Chain rows of a part into *digest (decode.h). y: a multiple of WR_IMAGE_STRIP. */
bool wr_image_file_digest(WrImageFile *file, int part, int y, int rows, WrHash *digest,
                          WrError *err);

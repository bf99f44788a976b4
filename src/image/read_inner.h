/* read_inner.h - what reading whole pictures, and reading back what was written, need of reading.
   Private to this room. */
#pragma once
#include "base/hash.h"
#include "image/image.h"

/* Rows and the first `channels` channels of a part. */
bool wr_image_file_read_first(WrImageFile *file, int part, int y, int rows, int channels,
                              float *out, WrError *err);
/* Of an open file; whole.c. Errors may lack the file's name. */
WrImage *wr_image_file_whole(WrImageFile *file, const WrImageWish *wish, WrError *err);

/* The file behind a descriptor, which is taken over. */
WrImageFile *wr_image_file_take(const char *name, int fd, WrError *err);
/* Chain rows of a part into *digest (decode.h). y: a multiple of WR_IMAGE_STRIP. */
bool wr_image_file_digest(WrImageFile *file, int part, int y, int rows, WrHash *digest,
                          WrError *err);

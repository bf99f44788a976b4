/* read_internal.h - what reading whole pictures, and reading back what was written, need of reading.
   Private to this module. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrHash WrHash;
typedef struct WrImage WrImage;
typedef struct WrImageFile WrImageFile;
typedef struct WrImageRows WrImageRows;
typedef struct WrImageWish WrImageWish;

/* Rows and the first `channels` channels of a part. */
bool wr_image_file_read_first(WrImageFile *file, int part, int y, int rows, int channels,
                              float *out, WrError *err);
const char *wr_image_file_path(const WrImageFile *file); /* for messages */
/* The rows of an open file, which is taken over, on failure too; whole.c. */
WrImageRows *wr_image_rows_take(WrImageFile *file, const WrImageWish *wish, WrError *err);

/* Those of a picture that is there, which is taken over. keep: what is not finite stays so. */
WrImageRows *wr_image_rows_of(WrImage *image, bool keep);

/* The file behind a descriptor, which is taken over. levels: of its first part, in place of parts. */
WrImageFile *wr_image_file_take(const char *name, int fd, bool levels, WrError *err);
/* Chain rows of a part into *digest (decode.h). y: a multiple of WR_IMAGE_STRIP. */
bool wr_image_file_digest(WrImageFile *file, int part, int y, int rows, WrHash *digest,
                          WrError *err);

/* read_internal.h - reading functions used by whole-image reading and by readback.
   Private to this module. */
#pragma once
#include <stdbool.h>

typedef struct WrError WrError;
typedef struct WrHash WrHash;
typedef struct WrImage WrImage;
typedef struct WrImageFile WrImageFile;
typedef struct WrImageRows WrImageRows;
typedef struct WrImageRequest WrImageRequest;

/* Reads rows and the first `channels` channels of a part. */
bool wr_image_file_read_first(WrImageFile *file, int part, int y, int rows, int channels,
                              float *out, WrError *err);
const char *wr_image_file_path(const WrImageFile *file); /* for messages */
/* The rows of an open file, owned by the result, on failure too; whole.c. */
WrImageRows *wr_image_rows_take(WrImageFile *file, const WrImageRequest *wish, WrError *err);

/* The rows of an existing image, owned by the result. keep: non-finite values are kept. */
WrImageRows *wr_image_rows_of(WrImage *image, bool keep);

/* The file of a descriptor, owned by the result. levels: mip levels of its first part, instead of
 * parts. */
WrImageFile *wr_image_file_take(const char *name, int fd, bool levels, WrError *err);
/* Chains rows of a part into *digest (decode.h). y: a multiple of WR_IMAGE_STRIP. */
bool wr_image_file_digest(WrImageFile *file, int part, int y, int rows, WrHash *digest,
                          WrError *err);

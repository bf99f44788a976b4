/* image.h - images in memory, and image files of every format of OpenImageIO.

   The library is loaded on first use: a program that opens no image does not pay for it. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrPool WrPool;

typedef enum WrPixelType { WR_PIXEL_U8, WR_PIXEL_U16, WR_PIXEL_F32 } WrPixelType;
/* The largest code; 0 for floats. */
static inline double wr_pixel_type_max(WrPixelType type)
{
    return type == WR_PIXEL_U8 ? 255.0 : type == WR_PIXEL_U16 ? 65535.0 : 0.0;
}

/* Kind of an export of this program (export/export.h), as stored in the file; checked, since the file
 * is untrusted. */
typedef enum WrLabelKind {
    WR_LABEL_NONE, /* no label, or an unsupported kind */
    WR_LABEL_HEIGHT,
    WR_LABEL_BUMP_SLOPES, /* heights, with slopes in other channels */
    WR_LABEL_NORMAL_UP,   /* green up; this kind and the following contain no heights */
    WR_LABEL_NORMAL_DOWN,
    WR_LABEL_SLOPES
} WrLabelKind;

typedef struct WrImageLabel {
    WrLabelKind kind;
    int green;   /* green channel of normals, also of object-space ones, which have no kind here: 1
                  up, -1 down, 0: unknown */
    bool ranged; /* integer heights: F = low + step (code - zero) */
    double low, step;
    int zero;
    bool sized; /* the cell's size is known: the next three are valid */
    bool mm;    /* cell and height are millimetres, else scene units */
    double cell[2],
        height;  /* values of the export, always for normals and slopes; height may be negative */
    bool turned; /* bump slopes: their sign is inverted */
    double
        uvslopes;  /* bump slopes: relative to the cell and divided by this, whichever program wrote
                     them; 0: per texel */
    bool wrapped;  /* the wrap modes are known: the next one is valid */
    bool clamp[2]; /* u, v */
    bool edged;    /* the edges of the pattern are known: the next four are valid */
    bool open;     /* the image is not one cell: an atlas, a map over a whole surface */
    bool border;   /* the last column and row repeat the first ones */
    int edge
        [2]; /* u, v: -1 the height steps, 0 the slope breaks, 1, 2 continuous (field/seam_check.h) */
    int copies[2];    /* of the cell, side by side */
    char refused[96]; /* "wrinkle:range=nan,1": an invalid value, ignored; "" */
} WrImageLabel;

/* An image in memory: float, channels interleaved, row 0 on top. Integer files are read as code / 255
   or code / 65535 (PNM: divided by its header's largest code), never colour-converted; float files by
   their values. Shared by reference count. */
typedef struct WrImage {
    int refs;          /* atomic; use wr_image_share, wr_image_free */
    int width, height; /* 1..WR_IMAGE_MAX */
    int channels;      /* 1..4: grey, grey + alpha, RGB, RGB + alpha */
    WrPixelType type;  /* type of the file (half counts as F32) */
    int64_t replaced;  /* number of texels that were NaN or infinite and became 0 */
    int64_t filled; /* number of values marked as missing in the file (GDAL's no-data, FITS's BLANK,
                   voids of signed elevations), filled from their neighbours */
    float *data;    /* [height][width][channels], owned */
    WrImageLabel label;
    char note
        [200]; /* differences from the file's pixels: "its data window, 15x10 at 8,5, ..."; "" if
                  none */
    char taken
        [400]; /* "diffuse.R, diffuse.G, diffuse.B of its channels Z, ..., in part 1 of 2", if a
                  file has more than was read; else "" */
} WrImage;

#define WR_IMAGE_MAX 16384        /* pixels along a side */
#define WR_IMAGE_PARTS_MAX 1280   /* parts in a file */
#define WR_IMAGE_TILE 64          /* side of the tiles of tiled files, in pixels */
#define WR_IMAGE_CHANNELS_MAX 256 /* channels in a part */
#define WR_IMAGE_STRIP 64         /* maximum number of rows of a WrRowSource call */
#define WR_IMAGE_BAND 512         /* rows read at once for whole images */

/* An image of zeros. NULL and an error when sizes are out of range or memory is exhausted. */
WrImage *wr_image_new(int width, int height, int channels, WrError *err);
WrImage *wr_image_share(const WrImage *image);
void wr_image_free(WrImage *image);

/* Reads an image file: the first part; with layers, the first one with R, G, B or Y, else the first
   channel; oriented according to EXIF and TIFF. Errors name the file and the problem: missing, not an
   image, truncated, over the limit. */
WrImage *wr_image_read(const char *path, WrError *err);
/* Options for reading an image. */
typedef struct WrImageRequest {
    const char *
        channel; /* "Depth.Z", several, "a,b", or a layer, "diffuse"; NULL, "": the default above */
    const char *part; /* number from 1, or name; a frame of an animation; NULL, "": the first */
    bool keep_lost; /* non-finite values are kept (`replaced` still counts them), and missing values
                      are NaN */
    bool elevation; /* unsigned integers are numbers, not codes: those of 32 bits, and in TIFF all
                      that are georeferenced or have a no-data value. Unless keep_lost: -9999 and
                      -32768 also mark missing values of numbers */
} WrImageRequest;
WrImage *wr_image_read_request(const char *path, const WrImageRequest *wish, WrError *err);
/* Reads a file in memory; name is used in messages, and its extension selects the format. */
WrImage *wr_image_read_bytes(const char *name, const void *bytes, size_t length, WrError *err);

/* Reads an image row by row, downwards, so that only a band is in memory, unless the image has to be
   rotated. The head is the image without its pixels; `replaced` counts those of the rows read so far,
   and `taken` reports an all-zero image only after the last row. */
typedef struct WrImageRows WrImageRows;
WrImageRows *wr_image_rows_open(const char *path, const WrImageRequest *wish, WrError *err);
void wr_image_rows_close(WrImageRows *rows); /* NULL is allowed */
const WrImage *wr_image_rows_head(const WrImageRows *rows);
/* Row y, [width][channels], valid until the next call; y must not decrease. NULL and an error on
 * failure. */
const float *wr_image_rows_get(WrImageRows *rows, int y, WrError *err);
/* wr_image_apply_range for the following rows. */
bool wr_image_rows_apply_range(WrImageRows *rows);
/* All rows as one image; call it before any row was read. */
WrImage *wr_image_rows_whole(WrImageRows *rows, WrError *err);

/* Converts codes to heights with the range of the image's label; false if it has none. Not for shared
 * images. */
bool wr_image_apply_range(WrImage *image);

/* Starts the reader process ahead of need and returns at once; any thread. Files are read by a separate
 * process, so that a hostile one can only crash that, with one clear error here. It is started by the
 * first read and kept; loading the library for formats other than PNG needs a quarter of a second
 * once. With WRINKLE_READER=inside in the environment files are read in this process, for debugging. */
void wr_image_warm(void);
/* Starts loading the writing library ahead of need and returns at once; any thread. The library writes
 * all formats except PNG and documents; it is loaded into this process, with some 260 others, by the first such
 * write, which needs half a second, or a few on a slow disk. */
void wr_image_warm_writing(void);

/* sRGB transfer curves (IEC 61966-2-1), exact to float; for images only, never for heights. */
float wr_srgb_encode(float linear);
float wr_srgb_decode(float code);

/* Converts `count` values 0..1 to codes (or floats): round(255 x), round(65535 x), halves away from 0.
 * Values outside 0..1 are clamped and counted in *clipped (may be NULL; floats are never clamped). NaN
 * and infinity become 0; returns their number (HC96). */
int64_t wr_image_codes(WrPixelType type, const float *in, size_t count, void *out,
                       int64_t *clipped);

/* Rec. 709 luma of a pixel of 1 to 4 channels (grey images: the grey; alpha is ignored). */
float wr_image_luma(const float *pixel, int channels);

/* ---- files with several parts, attributes and any number of channels ---- */

typedef struct WrImageAttribute {
    const char *name, *text;
} WrImageAttribute;

/* Fills rows [y, y + rows) of a part, interleaved, in the part's pixel type. Called for strips of at
   most WR_IMAGE_STRIP rows, downwards, each row once. Return false to stop (the write then fails with
   `err`). */
typedef bool (*WrRowSource)(void *ctx, int y, int rows, void *out, WrError *err);

/* Receives rows [y, y + rows) as read back from the disk, before the file replaces its target: values
   as in WrImage, all channels, in the part's order; exact: the format is lossless. Called downwards,
   each row once; not called if the file size limit (ulimit -f) leaves no room for rows, which are then
   only hashed. Return false if the rows are wrong (the write then fails with `err`, and the old file
   stays). */
typedef bool (*WrRowSeen)(void *ctx, int y, int rows, const float *values, bool exact,
                          WrError *err);

typedef struct WrImageOut {
    int width, height, channels;
    WrPixelType type;                 /* integer types contain final codes */
    const char *const *channel_names; /* [channels], or NULL for Y, YA, RGB, RGBA */
    const char *part_name;            /* EXR parts; may be NULL */
    const WrImageAttribute
        *attributes; /* other formats than EXR store them as lines "name=text" of the image
                        description, if supported */
    int attribute_count;
    bool data; /* numbers, not colours: no format declares them as sRGB, and PNG declares nothing */
    const uint8_t *profile; /* an embedded ICC profile; NULL: none */
    size_t profile_size;
    WrRowSource rows;
    WrRowSeen seen; /* NULL: no callback */
    void *ctx;
    /* threads that compress a PNG or a document, in the first part; NULL: the caller's */
    WrPool *pool;
    bool reports; /* `rows` reports the progress itself, because it is most of the work */
    bool half;    /* all floats are halves, and are stored as such: EXR */
    /* EXR: the parts are the mip levels of one tiled image, each half as large as the one before
       (rounded down, at least 1), down to 1x1. Attributes are those of the first. */
    bool levels;
    bool uvslopes; /* for such a file: the next member is stored in its attribute uvslopes_scale */
    double uvslopes_scale;
} WrImageOut;

/* Writes a file as an atomic replacement (base/file.h); the extension selects the format. Several parts
   only in EXR. A type that the format cannot store is an error, never a silent conversion; so is any
   failure that the library reports late (a full disk). */
bool wr_image_write(const char *path, const WrImageOut *parts, int count, WrError *err);
/* Writes an image to memory, one part only: the bytes of a file named `name`, owned by the caller
   (wr_free). For PNG, EXR and other formats written sequentially; not TIFF. */
bool wr_image_write_bytes(const char *name, const WrImageOut *part, char **bytes, size_t *length,
                          WrError *err);
/* Convenience: one part from memory, `pixels` tightly packed in `type`. */
bool wr_image_write_pixels(const char *path, int width, int height, int channels, WrPixelType type,
                           bool data, const void *pixels, WrError *err);

/* Rejects a file name whose extension is no supported format, or one that cannot store images of this
   type and channel count; needs no library. */
bool wr_image_can_write(const char *path, WrPixelType type, int channels, bool data, WrError *err);
/* The deepest type of this extension's format: F32 for EXR and TIFF, U16 for PNG, U8 for JPEG, BMP, TGA
   and PNM. */
bool wr_image_deepest(const char *path, WrPixelType *type, WrError *err);

/* Reading part by part. A file belongs to one thread at a time. */
typedef struct WrImageFile WrImageFile;

typedef struct WrImagePart {
    const char *name; /* "" if it has none */
    int width, height, channels;
    WrPixelType type; /* type in the file; half, double and 32-bit integers count as F32 */
    const char *const *channel_names;
} WrImagePart;

/* Opens a file for reading part by part; checks sizes, part and channel counts before any allocation. */
WrImageFile *wr_image_file_open(const char *path, WrError *err);
/* Opens the mip levels of the first part as parts, if it has more than one. */
WrImageFile *wr_image_file_open_levels(const char *path, WrError *err);
void wr_image_file_close(WrImageFile *file);
int wr_image_file_parts(const WrImageFile *file);
WrImagePart wr_image_file_part(const WrImageFile *file, int part); /* valid until close */
/* A text attribute of a part, or NULL; also one that wr_image_write stored in an image's description.
   Valid until close. */
const char *wr_image_file_attribute(const WrImageFile *file, int part, const char *name);
/* All pixels of one part as float, [height][width][channels]. */
bool wr_image_file_read(WrImageFile *file, int part, float *out, WrError *err);
/* Rows [y, y + rows) of one part, as [rows][width][channels]. Fastest downwards in strips. */
bool wr_image_file_read_rows(WrImageFile *file, int part, int y, int rows, float *out,
                             WrError *err);

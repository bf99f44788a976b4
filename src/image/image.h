/* image.h - pictures in memory and picture files of every kind that OpenImageIO knows.
   The library behind it is loaded on first use: a program that opens no picture never pays
   for it. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

typedef enum WrPixelType { WR_PIXEL_U8, WR_PIXEL_U16, WR_PIXEL_F32 } WrPixelType;
/* The largest code; of floats, which have none, 0. */
static inline double wr_pixel_last(WrPixelType type)
{
    return type == WR_PIXEL_U8 ? 255.0 : type == WR_PIXEL_U16 ? 65535.0 : 0.0;
}

/* What this program wrote of an export of its own (export/export.h): checked, since a stranger may have. */
typedef enum WrLabelKind {
    WR_LABEL_NONE, /* no label, or of a kind that is not read */
    WR_LABEL_HEIGHT,
    WR_LABEL_BUMP_SLOPES, /* heights, with slopes beside them */
    WR_LABEL_NORMAL_UP,   /* green up; from here on there are no heights in it */
    WR_LABEL_NORMAL_DOWN,
    WR_LABEL_SLOPES
} WrLabelKind;

typedef struct WrImageLabel {
    WrLabelKind kind;
    int green; /* of normals, also of those that are of a surface and so of no kind here: 1 up, -1 down, 0: not told */
    bool ranged; /* integer heights: F = low + step (code - zero) */
    double low, step;
    int zero;
    bool sized; /* tells how large the cell is: the next three hold */
    bool mm;    /* cell and height are millimetres, else scene units */
    double cell[2],
        height;  /* as export had them, of normals and slopes in any case; height may be below 0 */
    bool turned; /* bump slopes: their slopes have the other sign */
    double
        uvslopes; /* bump slopes: over the cell and divided by this, whoever wrote them; 0: per texel */
    bool wrapped;  /* tells what lies beyond the edges: the next one holds */
    bool clamp[2]; /* u, v */
    bool edged;    /* tells how its pattern's edges meet: the next four hold */
    bool open;     /* the picture is not one cell: an atlas, a map over a whole surface */
    bool border;   /* the last column and row are the first ones again */
    int edge[2]; /* u, v: -1 the height steps, 0 the slope breaks, 1, 2 they meet (field/seam.h) */
    int copies[2];    /* of the cell, side by side */
    char refused[96]; /* "wrinkle:range=nan,1": what made no sense and was not used; "" */
} WrImageLabel;

/* A picture in memory: float, channels interleaved, row 0 on top. Integer files read as code / 255 or
   code / 65535 (PNM: as its header's largest code), never colour-converted; float files as their values.
   Shared by reference count. */
typedef struct WrImage {
    int refs;          /* atomic; use wr_image_share, wr_image_free */
    int width, height; /* 1..WR_IMAGE_MAX */
    int channels;      /* 1..4: grey, grey + alpha, RGB, RGB + alpha */
    WrPixelType type;  /* what the file held (half counts as F32) */
    int64_t replaced;  /* texels that were NaN or infinite and became 0 */
    int64_t
        filled; /* values that the file marks as missing (GDAL's no-data, FITS's BLANK, voids of signed
                          elevations), filled from their neighbours */
    float *data; /* [height][width][channels], owned */
    WrImageLabel label;
    char note
        [200]; /* how reading departs from the file's pixels: "its data window, 15x10 at 8,5, ..."; "" */
    char taken
        [400]; /* "diffuse.R, diffuse.G, diffuse.B of its channels Z, ..., in part 1 of 2", where a file
                        has more than was read; else "" */
} WrImage;

#define WR_IMAGE_MAX 16384        /* pixels along a side */
#define WR_IMAGE_PARTS_MAX 1280   /* parts in a file */
#define WR_IMAGE_TILE 64          /* pixels along a side of the tiles that levels are kept in */
#define WR_IMAGE_CHANNELS_MAX 256 /* channels in a part */
#define WR_IMAGE_STRIP 64         /* rows that a WrRowSource is asked for at a time, at most */
#define WR_IMAGE_BAND 512         /* rows that whole pictures are read by */

/* A picture of zeros. NULL and an error when sizes are out of range or memory is gone. */
WrImage *wr_image_new(int width, int height, int channels, WrError *err);
WrImage *wr_image_share(const WrImage *image);
void wr_image_free(WrImage *image);

/* Read a picture file: the first part; of channels in layers the first with R, G, B or Y, else the first channel;
   turned as EXIF and TIFF tell. Errors name the file and say what is wrong: missing, not a picture, truncated,
   over the limit. */
WrImage *wr_image_read(const char *path, WrError *err);
/* The same of what is wished for. */
typedef struct WrImageWish {
    const char
        *channel; /* "Depth.Z", several, "a,b", or a layer of them, "diffuse"; NULL, "": as above */
    const char
        *part; /* its number, from 1, or its name; a frame of an animation; NULL, "": the first */
    bool
        keep_lost; /* what is not finite stays so (`replaced` counts it none the less), and missing values are NaN */
    bool
        elevation; /* unsigned integers are numbers, not codes: of 32 bits, and in TIFF of all that are georeferenced or
                      have a no-data value. Unless keep_lost: of numbers, -9999 and -32768 are missing values, too */
} WrImageWish;
WrImage *wr_image_read_wish(const char *path, const WrImageWish *wish, WrError *err);
/* The same of a file that is in memory; name stands in messages, and its ending counts as a path's. */
WrImage *wr_image_read_bytes(const char *name, const void *bytes, size_t length, WrError *err);

/* The same picture row by row, downwards, so that no more of it than a band lies in memory, unless it has to be
   turned. The head is the picture without its pixels; `replaced` counts those of the rows that were read, and
   `taken` tells only after the last whether all is 0. */
typedef struct WrImageRows WrImageRows;
WrImageRows *wr_image_rows_open(const char *path, const WrImageWish *wish, WrError *err);
void wr_image_rows_close(WrImageRows *rows); /* NULL is fine */
const WrImage *wr_image_rows_head(const WrImageRows *rows);
/* Row y, [width][channels], valid until the next call; y never goes up again. NULL and an error. */
const float *wr_image_rows_get(WrImageRows *rows, int y, WrError *err);
/* wr_image_apply_range for the rows that come. */
bool wr_image_rows_apply_range(WrImageRows *rows);
/* All rows as one picture, before any was read. */
WrImage *wr_image_rows_whole(WrImageRows *rows, WrError *err);

/* Codes become the heights that the picture's label tells; false where it tells none. Not for shared ones. */
bool wr_image_apply_range(WrImage *image);

/* Files are read by a process of its own, so that a hostile one can only end that: with one clear error
 * here. It is started when the first file is read, and kept; the library that reads other pictures than PNG takes it a
 * quarter of a second once. This starts
 * it ahead of need and returns at once; any thread. With WRINKLE_READER=inside in the environment files are
 * read in this process, for debugging. */
void wr_image_warm(void);
/* The library that writes all but PNG is loaded into this process, with some 260 others, when the first such file is
 * written, which takes half a second, or a few where the disk is slow. This begins ahead of need and returns at once; any
 * thread. */
void wr_image_warm_writing(void);

/* sRGB transfer curves (IEC 61966-2-1), exact to float; for pictures only, never for heights. */
float wr_srgb_encode(float linear);
float wr_srgb_decode(float code);

/* Finished codes (or floats) of `count` values 0..1: round(255 x), round(65535 x), halves away from 0.
 * Values outside 0..1 are clamped and counted in *clipped (may be NULL; floats are never clamped). NaN
 * and infinity become 0; returns how many (HC96). */
int64_t wr_image_codes(WrPixelType type, const float *in, size_t count, void *out,
                       int64_t *clipped);

/* Rec. 709 luma of a pixel of 1 to 4 channels (grey pictures: the grey; alpha is left out). */
float wr_image_luma(const float *pixel, int channels);

/* ---- files with several parts, attributes and any number of channels ---- */

typedef struct WrImageAttribute {
    const char *name, *text;
} WrImageAttribute;

/* Fill rows [y, y + rows) of a part, interleaved, in the part's pixel type. Called for strips of at most
   WR_IMAGE_STRIP rows, downwards, each row once. Return false to stop (the write then fails with `err`). */
typedef bool (*WrRowSource)(void *ctx, int y, int rows, void *out, WrError *err);

/* What stands on the disk of rows [y, y + rows), before the file takes its target's place: values as WrImage has
   them, all channels, in the part's order; exact: the format keeps every code and float. Called downwards, each row
   once; not at all where a limit on file sizes (ulimit -f) leaves no room for rows, which are then only hashed. Return false where it is not what it should be (the write then fails with `err`, the old file stays). */
typedef bool (*WrRowSeen)(void *ctx, int y, int rows, const float *values, bool exact,
                          WrError *err);

typedef struct WrImageOut {
    int width, height, channels;
    WrPixelType type;                 /* integer types hold finished codes */
    const char *const *channel_names; /* [channels], or NULL for Y, YA, RGB, RGBA */
    const char *part_name;            /* EXR parts; may be NULL */
    const WrImageAttribute
        *attributes; /* formats other than EXR keep them as lines "name=text" of the
                                           picture's description, where they have one */
    int attribute_count;
    bool data; /* numbers, not colours: no format says that they are sRGB, nor PNG anything */
    const uint8_t *profile; /* an ICC profile that goes into the file; NULL: none */
    size_t profile_size;
    WrRowSource rows;
    WrRowSeen seen; /* NULL: nobody but the writer looks */
    void *ctx;
    bool tells; /* rows tells itself how far the part is: it is most of the work */
    bool half;  /* floats that are all halves, and are kept as such: EXR */
    /* EXR: the parts are the levels of one picture in tiles, each half as large as the one before (rounded down, at
       least 1), down to 1x1. Attributes are those of the first. */
    bool levels;
    bool uvslopes; /* of such a file: the next one goes into its number uvslopes_scale */
    double uvslopes_scale;
} WrImageOut;

/* Write a file as a whole replacement (base/file.h); the format goes by the ending. Several parts only
   in EXR. A type that the format cannot hold is an error, never a silent conversion; so is any
   failure that the library reports late (a full disk). */
bool wr_image_write(const char *path, const WrImageOut *parts, int count, WrError *err);
/* The same into memory, one part only: the bytes of the file that `name` would be. They are the caller's
   (wr_free). For PNG, EXR and what else goes through one file; not TIFF. */
bool wr_image_write_bytes(const char *name, const WrImageOut *part, char **bytes, size_t *length,
                          WrError *err);
/* Convenience: one part from memory, `pixels` tightly packed in `type`. */
bool wr_image_write_pixels(const char *path, int width, int height, int channels, WrPixelType type,
                           bool data, const void *pixels, WrError *err);

/* Refuse a file name whose ending names no format that we write, or one that cannot hold pictures of
   this type and channel count; needs no library. */
bool wr_image_can_write(const char *path, WrPixelType type, int channels, bool data, WrError *err);
/* The deepest type that the format of this ending holds: F32 for EXR and TIFF, U16 for PNG,
   U8 for JPEG, BMP, TGA and PNM. */
bool wr_image_deepest(const char *path, WrPixelType *type, WrError *err);

/* Reading part by part. A file belongs to one thread at a time. */
typedef struct WrImageFile WrImageFile;

typedef struct WrImagePart {
    const char *name; /* "" if it has none */
    int width, height, channels;
    WrPixelType type; /* what the file holds; half, double and 32-bit integers count as F32 */
    const char *const *channel_names;
} WrImagePart;

/* Open for reading part by part; checks sizes, part and channel counts before anything is allocated. */
WrImageFile *wr_image_file_open(const char *path, WrError *err);
/* The levels of the first part in place of parts, where it has more than one. */
WrImageFile *wr_image_file_open_levels(const char *path, WrError *err);
void wr_image_file_close(WrImageFile *file);
int wr_image_file_parts(const WrImageFile *file);
WrImagePart wr_image_file_part(const WrImageFile *file, int part); /* valid until close */
/* A text attribute of a part, or NULL; also one that wr_image_write put into a picture's description.
   Valid until close. */
const char *wr_image_file_attribute(const WrImageFile *file, int part, const char *name);
/* All pixels of one part as float, [height][width][channels]. */
bool wr_image_file_read(WrImageFile *file, int part, float *out, WrError *err);
/* Rows [y, y + rows) of one part, as [rows][width][channels]. Fastest downwards in strips. */
bool wr_image_file_read_rows(WrImageFile *file, int part, int y, int rows, float *out,
                             WrError *err);

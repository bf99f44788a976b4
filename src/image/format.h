/* format.h - what we know of picture formats without opening a file: what each can hold, and how the
   files of each begin.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

typedef struct WrImageFormat {
    const char *endings[3]; /* lower case, without dot */
    const char *library;    /* OpenImageIO's name */
    const char *label;      /* for people */
    bool holds[3];          /* by WrPixelType */
    const char *types;      /* what it holds, in words, and what to do instead */
    unsigned channels;      /* bit c is set if c channels can be written; bit 0: any number up to
                               WR_IMAGE_CHANNELS_MAX */
    bool pictures_only;     /* keeps too little for numbers */
    bool exact;             /* gives back every code or float as it was given */
} WrImageFormat;

/* By the ending of a file's name; NULL and an error if we do not write such files. */
const WrImageFormat *wr_image_format(const char *path, WrError *err);

/* OpenImageIO's name of the format by a file's first bytes; NULL when they tell nothing. */
#define WR_IMAGE_SNIFF 34
const char *wr_image_sniff(const unsigned char *bytes, size_t count);

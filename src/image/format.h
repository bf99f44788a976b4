/* format.h - static properties of image formats: supported types and signatures.
   Private to this module. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrError WrError;

typedef struct WrImageFormat {
    const char *endings[3]; /* lower case, without dot */
    const char *library;    /* OpenImageIO's name */
    const char *label;      /* for people */
    bool holds[3];          /* supported, by WrPixelType */
    const char *types;  /* description of the supported types, with the alternative for others */
    unsigned channels;  /* bit c is set if c channels can be written; bit 0: any number up to
                               WR_IMAGE_CHANNELS_MAX */
    bool pictures_only; /* too imprecise for data */
    bool exact;         /* lossless: returns every code or float unchanged */
} WrImageFormat;

/* By the extension of a file's name; NULL and an error if the program does not write such files. */
const WrImageFormat *wr_image_format(const char *path, WrError *err);

/* OpenImageIO's name of the format by a file's first bytes; NULL if they are not characteristic. */
#define WR_IMAGE_SNIFF 34
const char *wr_image_sniff(const unsigned char *bytes, size_t count);

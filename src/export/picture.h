/* picture.h - a map as a picture in memory, before any file is written.
   Layer 6. */
#pragma once
#include "export/export.h"

#define WR_HISTOGRAM 64 /* bars */

typedef struct WrExportPicture {
    int width, height;
    uint8_t *rgb;          /* [height][width][3]; owned */
    WrExportReport report; /* of the file that it stands for: range, clipped, convention, seam */
} WrExportPicture;

/* What the kind would write of the document with these options, as codes of 8 bits; of floats, their own range is what
 * the picture shows.
 * Errors: options that are out of range; a drawing or a body, which is no picture of the table. */
bool wr_export_picture(const WrExportKind *kind, const WrDocument *document,
                       const WrExportOptions *options, WrPool *pool, WrExportPicture *picture,
                       WrError *err);
void wr_export_picture_fini(WrExportPicture *picture);

/* Heights, counted: bar i holds those from low + i/64 (high - low) on; outside: those below from or above to. */
typedef struct WrHistogram {
    double low, high; /* of the table */
    int64_t count[WR_HISTOGRAM];
    int64_t outside;
} WrHistogram;
WrHistogram wr_export_histogram(const WrDocument *document, double from, double to);

/* Bytes that the file will have at most, about: its numbers, uncompressed. */
double wr_export_bytes(const WrExportKind *kind, int width, int height, int depth);

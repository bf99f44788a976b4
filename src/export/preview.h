/* preview.h - preview picture of a map in memory, without a file. */
#pragma once
#include "export/export.h"

#define WR_HISTOGRAM 64 /* bars */

typedef struct WrExportPreview {
    int width, height;
    uint8_t *rgb;          /* [height][width][3]; owned */
    WrExportReport report; /* for the file that it stands for: range, clipped, convention, seam */
} WrExportPreview;

/* Computes the picture that the kind would export with these options, as 8-bit codes; floats are scaled to their
   own range.
   Errors: options out of range; a drawing or a body, which is not a picture of the table. */
bool wr_export_preview(const WrExportKind *kind, const WrDocument *document,
                       const WrExportOptions *options, WrPool *pool, WrExportPreview *picture,
                       WrError *err);
void wr_export_preview_fini(WrExportPreview *picture);

/* A map in memory, as a file would hold it. */
typedef struct WrExportValues {
    int width, height, channels, depth; /* bits per channel: 8, 16, or 32 for floats */
    char names[WR_EXPORT_CHANNELS]
              [WR_EXPORT_NAME]; /* of the channels; "" for those of Y, RGB and RGBA */
    void *data;                 /* [height][width][channels]; owned */
    WrExportReport report;
} WrExportValues;

/* Computes the map that the kind would export with these options, of options->depth bits; 0: floats. sizes_only: without the
   data, which remains NULL. Free the data with wr_free, also after a failure.
   Errors: options out of range; a drawing or a body, which is not a picture of the table. */
bool wr_export_values(const WrExportKind *kind, const WrDocument *document,
                      const WrExportOptions *options, bool sizes_only, WrPool *pool,
                      WrExportValues *values, WrError *err);

/* Histogram of heights: bar i counts those from low + i/64 (high - low) on; outside: those below from or above
   to. */
typedef struct WrHistogram {
    double low, high; /* of the table */
    int64_t count[WR_HISTOGRAM];
    int64_t outside;
} WrHistogram;
WrHistogram wr_export_histogram(const WrDocument *document, double from, double to);

/* Approximate upper bound of the file's size in bytes: its numbers, uncompressed. */
double wr_export_estimate_bytes(const WrExportKind *kind, int width, int height, int depth);

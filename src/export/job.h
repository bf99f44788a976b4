/* job.h - one export under way: what the kinds' functions work on.
   Layer 6. Private to this room. */
#pragma once
#include "base/text.h"
#include "base/vec.h"
#include "export/export.h"
#include "image/image.h"
#include "system/thread.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrField WrField;
typedef struct WrScene WrScene;

#define WR_EXPORT_ATTRIBUTES 20 /* at most */

struct WrExportJob {
    const WrExportKind *kind;
    const WrField *field;
    const WrField *cell; /* field, before it was laid out as a sheet */
    int copies[2];       /* of the cell in the field, side by side in u and in v; 0: 1 */
    const WrScene *scene;
    WrExportOptions options; /* depth and scheme settled */
    WrPool *pool;            /* may be NULL */
    int width, height, channels;
    char channel_names[WR_EXPORT_CHANNELS][WR_EXPORT_NAME]; /* of kinds that count them */
    float *map;                      /* [height][width][channels] of kinds that make it whole */
    struct WrExportPicture *picture; /* this is wanted, and no file; NULL: a file */
    bool numbers;                    /* a file of numbers alone (raw_file.h) */
    bool analytic;                   /* F is the scene's formula, not the table */
    double *u;                       /* [width] texel centres */
    WrExportReport report;           /* pieces add their counts atomically */
    const char *attribute_names[WR_EXPORT_ATTRIBUTES];
    WrText attribute_texts[WR_EXPORT_ATTRIBUTES];
    int attribute_count;
};

/* The largest code, 255 or 65535. */
double wr_export_last_code(const WrExportJob *job);
/* The v of row y's centres. */
double wr_export_row_v(const WrExportJob *job, int y);

/* out[i] = zero + round(x), clamped to the codes that there are; halves away from zero. x is finite. With
 * dither x is first moved by less than half a code, so that whole x stay as they are. */
typedef struct WrExportTexel {
    int column, row, channel; /* choose the dither */
} WrExportTexel;
void wr_export_store_code(const WrExportJob *job, void *out, size_t i, double x, int zero,
                          WrExportTexel at);

/* Call piece(job, y, rows, ctx) for stretches of [y, y + rows), on the job's pool. */
#define WR_EXPORT_PIECE_ROWS 16 /* at most in one */
typedef void (*WrExportPiece)(WrExportJob *job, int y, int rows, void *ctx);
void wr_export_run(WrExportJob *job, int y, int rows, WrExportPiece piece, void *ctx);

/* write.c: the picture file of a job whose options are settled; the type of its pixels. */
bool wr_export_write(WrExportJob *job, const char *path, WrError *err);
WrPixelType wr_export_pixels(int depth);

/* receipt.c: what stands on the disk, a WrRowSeen of the job; its largest error goes into the report. */
bool wr_export_receipt(void *ctx, int y, int rows, const float *values, bool exact, WrError *err);

/* picture.c: in place of writing a file. */
bool wr_export_fill_picture(WrExportJob *job, WrError *err);
/* As wr_export_picture, of another kind: of what that job is of, with its options. */
struct WrExportPicture;
bool wr_export_picture_like(const WrExportJob *job, const WrExportKind *kind,
                            struct WrExportPicture *picture, WrError *err);
bool wr_export_contact_write(WrExportJob *job, const char *path, WrError *err);

/* Smallest and largest number of all pieces, found on several threads. */
typedef struct WrExtent {
    WrMutex lock;
    double low, high;
} WrExtent;
void wr_export_extent_init(WrExtent *extent);
/* What one piece has. */
void wr_export_extent_add(WrExtent *extent, double low, double high);
/* Into the report; the extent is done with. */
void wr_export_extent_take(WrExtent *extent, WrExportReport *report);

/* A new attribute's text, to be filled. */
WrText *wr_export_attribute(WrExportJob *job, const char *name);

/* What slopes go by besides the cell and its height, which all files tell: the scheme. */
void wr_export_describe_slopes(WrExportJob *job);

/* Heights of rows [y, y + rows) in table units; returns how many were not finite and became 0. */
int64_t wr_export_heights(const WrExportJob *job, int y, int rows, float *out);

/* What the maps of a table are made of. field: heights of a formula, sampled; owned by the caller; NULL: the table. */
typedef struct WrDerivatives WrDerivatives;
WrDerivatives wr_export_ground(const WrExportJob *job, const WrField *field);
/* Smallest and largest number of the map into the report. */
void wr_export_map_range(WrExportJob *job, const char *quantity);
/* Codes of a map about 0 in the middle, from -full to full. */
void wr_export_signed_codes(WrExportJob *job, double full);
/* The map's numbers in codes from low to high. */
void wr_export_codes(WrExportJob *job, double low, double high);
void wr_export_map_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_map_describe(WrExportJob *job);

/* maps.c, maps_plain.c */
bool wr_export_occlusion_make(WrExportJob *job, WrError *err);
bool wr_export_horizon_make(WrExportJob *job, WrError *err);
int wr_export_horizon_channels(const WrExportJob *job, char (*names)[WR_EXPORT_NAME]);
bool wr_export_cavity_make(WrExportJob *job, WrError *err);
bool wr_export_curvature_make(WrExportJob *job, WrError *err);
bool wr_export_direction_make(WrExportJob *job, WrError *err);
bool wr_export_roughness_make(WrExportJob *job, WrError *err);
bool wr_export_displacement_make(WrExportJob *job, WrError *err);
bool wr_export_mask_make(WrExportJob *job, WrError *err);
bool wr_export_wear_make(WrExportJob *job, WrError *err);

/* channel_packing.c */
int wr_export_packed_channels(const WrExportJob *job, char (*names)[WR_EXPORT_NAME]);
bool wr_export_packed_make(WrExportJob *job, WrError *err);
void wr_export_packed_describe(WrExportJob *job);

/* height.c, normal.c, derived.c, drawing.c, profile.c, solid.c: the functions of the kinds. */
void wr_export_height_prepare(WrExportJob *job);
void wr_export_height_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_height_describe(WrExportJob *job);
void wr_export_normal_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_normal_describe(WrExportJob *job);
void wr_export_object_rows(WrExportJob *job, int y, int rows, void *out);
bool wr_export_object_check(const WrScene *scene, WrError *err);
void wr_export_object_describe(WrExportJob *job);
bool wr_export_baked_make(WrExportJob *job, WrError *err);
void wr_export_baked_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_baked_describe(WrExportJob *job);
/* Rows that a piece puts down, from y on. */
typedef struct WrExportStrip {
    int y;
    void *out;
} WrExportStrip;
/* A unit normal as the options' axes have it, in codes or floats. */
void wr_export_store_normal(const WrExportJob *job, void *out, size_t texel, WrVec3 n, int column,
                            int row);
bool wr_export_axes_parse(const char *text, int axes[3]); /* "+x-y+z", "directx" */
void wr_export_axes_text(const int axes[3], char text[7]);
/* Their attribute: +Y or -Y as the convention, else all three. */
void wr_export_describe_axes(WrExportJob *job);
void wr_export_slopes_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_slope_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_slope_prepare(WrExportJob *job);
void wr_export_derived_describe(WrExportJob *job);
void wr_export_bump_slopes_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_bump_slopes_level(void *job, int y, int rows, float *out); /* a WrLevelRows */
void wr_export_bump_slopes_describe(WrExportJob *job);
bool wr_export_drawing_write(WrExportJob *job, const char *path, WrError *err);
bool wr_export_profile_write(WrExportJob *job, const char *path, WrError *err);
bool wr_export_solid_write(WrExportJob *job, const char *path, WrError *err);

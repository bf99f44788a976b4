/* job.h - state of one export, used by the kinds' functions.
   Private to this module. */
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

#define WR_EXPORT_ATTRIBUTES 20 /* maximum */

struct WrExportJob {
    const WrExportKind *kind;
    const WrField *field;
    const WrField *cell; /* the field before its arrangement as a sheet */
    int copies[2];       /* copies of the cell in the field along u and v; 0: 1 */
    const WrScene *scene;
    int object, objects;     /* which of how many, from 1; 0: the only one */
    WrExportOptions options; /* with final depth and scheme */
    WrPool *pool;            /* may be NULL */
    int width, height, channels;
    char channel_names[WR_EXPORT_CHANNELS][WR_EXPORT_NAME]; /* for kinds that compute them */
    float *map; /* [height][width][channels] for kinds that compute it as a whole */
    struct WrExportPreview *picture; /* output if no file is written; NULL: a file */
    struct WrExportValues *values;   /* output if neither file nor picture is written */
    bool sizes_only;                 /* without the values' data */
    bool numbers;                    /* a raw file (write.c) */
    bool sidecar;                    /* a sidecar is written beside the file */
    bool analytic;                   /* F is the scene's formula, not the table */
    double *u;                       /* [width] texel centres */
    double solid_guess; /* after a solid failed with too many triangles: an error= that may fit */
    WrExportReport report; /* pieces add their counts atomically */
    const char *attribute_names[WR_EXPORT_ATTRIBUTES];
    WrText attribute_texts[WR_EXPORT_ATTRIBUTES];
    int attribute_count;
};

/* The largest code, 255 or 65535. */
double wr_export_last_code(const WrExportJob *job);
/* The v of row y's centres. */
double wr_export_row_v(const WrExportJob *job, int y);

/* A code: zero + round(x), clamped to the valid codes; halves away from zero. x is finite. With dither x is
   first changed by less than half a code, so that whole x are unchanged. */
typedef struct WrExportTexel {
    int column, row, channel; /* select the dither offset */
} WrExportTexel;
void wr_export_store_code(const WrExportJob *job, void *out, size_t i, double x, int zero,
                          WrExportTexel at);

/* Calls piece(job, y, rows, ctx) for parts of [y, y + rows), on the job's pool. */
#define WR_EXPORT_PIECE_ROWS 16 /* maximum of one piece */
typedef void (*WrExportPiece)(WrExportJob *job, int y, int rows, void *ctx);
void wr_export_run(WrExportJob *job, int y, int rows, WrExportPiece piece, void *ctx);

/* write.c: writes the picture file of a job with final options; and the pixel type for a depth. */
bool wr_export_write(WrExportJob *job, const char *path, WrError *err);
WrPixelType wr_export_pixels(int depth);

/* preview.c: fills a picture, or values, instead of writing a file. */
bool wr_export_fill_preview(WrExportJob *job, WrError *err);
bool wr_export_fill_values(WrExportJob *job, WrError *err);
/* As wr_export_preview, for another kind, with that job's document and options. */
struct WrExportPreview;
bool wr_export_preview_like(const WrExportJob *job, const WrExportKind *kind,
                            struct WrExportPreview *picture, WrError *err);
bool wr_export_contact_write(WrExportJob *job, const char *path, WrError *err);

/* Smallest and largest number over all pieces, computed by several threads. */
typedef struct WrExtent {
    WrMutex lock;
    double low, high;
} WrExtent;
void wr_export_extent_init(WrExtent *extent);
/* Adds the extent of one piece. */
void wr_export_extent_add(WrExtent *extent, double low, double high);
/* Stores the extent in the report and frees it. */
void wr_export_extent_finish(WrExtent *extent, WrExportReport *report);

/* The text of a new attribute, to be filled. */
WrText *wr_export_attribute(WrExportJob *job, const char *name);

/* Attributes for slopes in addition to the cell and its height, which all files have: the scheme. */
void wr_export_describe_slopes(WrExportJob *job);

/* Heights of rows [y, y + rows) in table units; returns the number of non-finite ones, which become 0. */
int64_t wr_export_heights(const WrExportJob *job, int y, int rows, float *out);

/* Source of a table's maps. field: sampled heights of a formula; owned by the caller; NULL: the table. */
typedef struct WrDerivatives WrDerivatives;
WrDerivatives wr_export_ground(const WrExportJob *job, const WrField *field);
/* Stores the smallest and largest number of the map in the report. */
void wr_export_report_range(WrExportJob *job, const char *quantity);
/* Codes of a map's numbers from low to high. */
void wr_export_codes(WrExportJob *job, double low, double high);
void wr_export_map_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_map_describe(WrExportJob *job);

/* maps.c */
/* Beckmann's alpha of the scene's material, 0..1; its root is the roughness of other programs. */
double wr_export_material_alpha(const WrScene *scene);
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

/* height.c, normal.c, derived.c, line_drawing.c, profile.c, solid.c: functions of the kinds. */
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
/* Rows that a piece stores, from y on. */
typedef struct WrExportStrip {
    int y;
    void *out;
} WrExportStrip;
/* Stores a unit normal along the options' axes, in codes or floats. */
void wr_export_store_normal(const WrExportJob *job, void *out, size_t texel, WrVec3 n, int column,
                            int row);
bool wr_export_axes_parse(const char *text, int axes[3]); /* "+x-y+z", "directx" */
void wr_export_axes_text(const int axes[3], char text[7]);
/* Adds the axes' attribute: +Y or -Y as the convention, else all three. */
void wr_export_describe_axes(WrExportJob *job);
void wr_export_slopes_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_slope_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_slope_prepare(WrExportJob *job);
void wr_export_derived_describe(WrExportJob *job);
void wr_export_bump_slopes_rows(WrExportJob *job, int y, int rows, void *out);
void wr_export_bump_slopes_level(void *job, int y, int rows, float *out); /* is a WrLevelRows */
void wr_export_bump_slopes_describe(WrExportJob *job);
bool wr_export_line_drawing_write(WrExportJob *job, const char *path, WrError *err);
bool wr_export_profile_write(WrExportJob *job, const char *path, WrError *err);
bool wr_export_solid_write(WrExportJob *job, const char *path, WrError *err);
bool wr_export_glb_write(WrExportJob *job, const char *path, WrError *err);
bool wr_export_gltf_write(WrExportJob *job, const char *path, WrError *err);
/* The relief on the job's surface, with its facts in the job's report. body: zero-initialised. */
typedef struct WrSolidBody WrSolidBody;
bool wr_export_solid_make(WrExportJob *job, WrSolidBody *body, WrError *err);

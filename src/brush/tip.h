/* tip.h - stamps: pictures that replace a brush's round falloff.

   Supports any image (its Rec. 709 luma of the codes times its alpha; float values are clamped to
   0..1), GIMP's .gbr (version 1 and 2; grey: 255 is full paint; RGBA: luma times alpha) and .gih
   (several pictures with selection rules, of up to 4 ranks). 8-bit tips are smoothed when loaded, so
   that heights have no quantization steps: values change by at most half a code, and edges and black
   pixels beside them not at all. Each cell has a mip pyramid for small sizes, which
   preserves its mean. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

#define WR_TIP_SIDE 8192          /* maximum pixels along a cell's side */
#define WR_TIP_CELLS 1024         /* maximum pictures of a .gih */
#define WR_TIP_BYTES (512u << 20) /* maximum for all levels */

typedef struct WrTip WrTip; /* immutable, shared by reference count (atomic) */

/* Reads a file by its extension and first bytes. Errors name the file and the problem. */
WrTip *wr_tip_read(const char *path, WrError *err);
/* .gbr or .gih in memory, by first bytes. */
WrTip *wr_tip_parse(const void *bytes, size_t size, const char *name, WrError *err);
/* One cell of width x height values 0..1, row by row from the top; `codes`: number of quantization
 * steps from 0 to 1 of the values, to be smoothed (255); 0: none. */
WrTip *wr_tip_new(int width, int height, const float *values, int codes, WrError *err);
WrTip *wr_tip_share(const WrTip *tip);
void wr_tip_free(WrTip *tip); /* NULL is allowed */

const char *wr_tip_name(const WrTip *tip); /* "" if absent */
/* relative to the radius, from its file; 0: unspecified */
double wr_tip_spacing(const WrTip *tip);
int wr_tip_cells(const WrTip *tip);
void wr_tip_size(const WrTip *tip, int cell, int *width, int *height); /* pixels */

/* The cell for the dab with that number (from 0), by the file's rules. direction_rad: of the path,
 * anticlockwise (angular ranks begin upwards and continue clockwise); pressure, random: 0..1. Ranks
 * controlled by inputs that strokes lack (velocity, tilt) always use their first cell. */
int wr_tip_pick(const WrTip *tip, uint64_t number, double direction_rad, double pressure,
                double random);

/* A cell at a drawing scale: one level of its pyramid, or between two. Sampled with our own arithmetic
   (same bits everywhere). Outside the picture: 0, so the border fades out over half a pixel of the
   level on either side. */
typedef struct WrTipView {
    const float *fine, *coarse; /* [height][width] of two levels; coarse may be NULL */
    int fine_w, fine_h, coarse_w, coarse_h;
    float mix; /* 0..1: weight of coarse */
} WrTipView;
/* scale: texels of the table per pixel of the tip. */
void wr_tip_view(const WrTip *tip, int cell, double scale, WrTipView *view);
/* At (s, t), 0..1 across and down the picture. */
float wr_tip_value(const WrTipView *view, double s, double t);

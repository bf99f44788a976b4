/* tip.h - stamps: pictures in place of a brush's round falloff.
   Any picture (its Rec. 709 luma of the codes times its alpha; float values are clamped to
   0..1), GIMP's .gbr (version 1 and 2; grey: 255 is full paint; RGBA: luma times alpha) and .gih (several
   pictures and rules which comes next, of up to 4 ranks). 8-bit tips are smoothed when they are loaded, so
   that heights do not come in stairs: the values move within half a code, and edges and what is black
   beside them not at all (tip_smooth.c). Each cell has a pyramid of halves for small sizes, which keep its
   mean. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct WrError WrError;

#define WR_TIP_SIDE 8192          /* pixels along a cell's side, at most */
#define WR_TIP_CELLS 1024         /* pictures of a .gih, at most */
#define WR_TIP_BYTES (512u << 20) /* of all levels, at most */

typedef struct WrTip WrTip; /* immutable, shared by reference count (atomic) */

/* By the file's ending and its first bytes. Errors name the file and what is wrong with it. */
WrTip *wr_tip_read(const char *path, WrError *err);
/* .gbr or .gih from memory, by first bytes. */
WrTip *wr_tip_parse(const void *bytes, size_t size, const char *name, WrError *err);
/* One cell of width x height values 0..1, row by row from the top; `codes`: how many steps from 0 to 1 the
 * values have, to be smoothed (255); 0: none. */
WrTip *wr_tip_new(int width, int height, const float *values, int codes, WrError *err);
WrTip *wr_tip_share(const WrTip *tip);
void wr_tip_free(WrTip *tip); /* NULL is fine */

const char *wr_tip_name(const WrTip *tip); /* "" without */
double wr_tip_spacing(const WrTip *tip);   /* of the radius, as its file wishes; 0: nothing said */
int wr_tip_cells(const WrTip *tip);
void wr_tip_size(const WrTip *tip, int cell, int *width, int *height); /* pixels */

/* The cell for the dab with that number (from 0): by the file's rules. direction_rad: of the path,
 * anticlockwise (angular ranks begin upwards and go round clockwise); pressure, random: 0..1. Ranks that
 * go by what a stroke has no measure for (velocity, tilt) stay at their first cell. */
int wr_tip_pick(const WrTip *tip, uint64_t number, double direction_rad, double pressure,
                double random);

/* A cell as it is drawn at a scale: one level of its pyramid, or between two. Sampling with arithmetic
   of our own (same bits everywhere). Outside the picture: 0, so the border fades out over half a pixel of
   the level on either side. */
typedef struct WrTipView {
    const float *fine, *coarse; /* [height][width] of two levels; coarse may be NULL */
    int fine_w, fine_h, coarse_w, coarse_h;
    float mix; /* 0..1 from fine to coarse */
} WrTipView;
/* scale: texels of the table a pixel of the tip becomes. */
void wr_tip_view(const WrTip *tip, int cell, double scale, WrTipView *view);
/* At (s, t), 0..1 across and down the picture. */
float wr_tip_value(const WrTipView *view, double s, double t);

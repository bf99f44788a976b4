/* mode.h - the implementation of brush modes. A new mode is one function and one row of wr_brush_modes.
   Private to this module. */
#pragma once
#include "brush/brush.h"
#include "brush/brush_kernels.h"

#include <stdbool.h>

/* Source of a covering mode's `target`; computed from the table before the stroke. */
typedef enum WrBlendTargetKind {
    WR_BLEND_TARGET_NONE,
    WR_BLEND_TARGET_BELOW,   /* the heights below the layer */
    WR_BLEND_TARGET_SHIFTED, /* the height at the clone's source */
    WR_BLEND_TARGET_SHARP,   /* the height mirrored at the mean within reach */
    WR_BLEND_TARGET_LARGEST, /* within reach */
    WR_BLEND_TARGET_SMALLEST
} WrBlendTargetKind;

typedef struct WrModeArgs {
    double strength; /* finite */
    double to;       /* finite; for flatten: its target height */
    bool grows;      /* buildup: parts above 1 */
    const WrBrushKernels *kernels;
} WrModeArgs;

/* out[i] = new height for start[i] where the weight is part[i] >= 0: the product of selection, opacity
 * and the stroke's coverage; at most 1 unless args->grows. Where it is 0, start's bits. Finite. target:
 * NULL unless the mode has a target kind. count: whole blocks. */
typedef void (*WrCoverageMode)(const WrModeArgs *args, const float *start, const float *part,
                               const float *target, int count, float *out);

struct WrMoveBox; /* displace_modes.h */
/* Changes the heights of a dab's box. */
typedef void (*WrMoveMode)(struct WrMoveBox *box);
/* Margin for a dab's radius and its vector from the previous one, in texels. */
typedef double (*WrMoveMargin)(double radius, double way_x, double way_y);

typedef struct WrModeWork {
    WrCoverageMode cover; /* NULL for moving modes */
    WrBlendTargetKind target;
    WrMoveMode move;     /* NULL for covering ones */
    WrMoveMargin margin; /* moving: margin in texels that it reads; NULL: one */
    bool first_height;   /* `to` is the height under the stroke's first sample */
    bool lowers_mark;
    bool as_strong; /* has no effect if strength is 0 */
} WrModeWork;

const WrModeWork *wr_mode_work(WrBrushMode mode);
WrModeArgs wr_mode_args(const WrBrush *brush); /* sane */

/* The nearest float, limited to float's range. */
static inline float wr_finite_float(double height)
{
    height = height < 3.4028234663852886e38 ? height : 3.4028234663852886e38;
    return (float)(height > -3.4028234663852886e38 ? height : -3.4028234663852886e38);
}

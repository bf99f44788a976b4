/* mode.h - what the modes do to heights. A new mode is one function and one row of wr_brush_modes.
   Private to this module. */
#pragma once
#include "brush/brush.h"
#include "brush/brush_kernels.h"

#include <stdbool.h>

/* Where a covering mode's `target` comes from; of the table as it was when the stroke began. */
typedef enum WrBlendTargetKind {
    WR_BLEND_TARGET_NONE,
    WR_BLEND_TARGET_BELOW,   /* what lies below the layer */
    WR_BLEND_TARGET_SHIFTED, /* the height at the clone's source */
    WR_BLEND_TARGET_SHARP,   /* as far beyond the height as the mean within reach is before it */
    WR_BLEND_TARGET_LARGEST, /* within reach */
    WR_BLEND_TARGET_SMALLEST
} WrBlendTargetKind;

typedef struct WrModeArgs {
    double strength; /* finite */
    double to;       /* finite; of flatten: the height that it flattens to */
    bool grows;      /* buildup: parts above 1 */
    const WrBrushKernels *kernels;
} WrModeArgs;

/* out[i] = what the height start[i] becomes where the part is part[i] >= 0: of selection, opacity and the
 * stroke's coverage; at most 1 unless args->grows. Where it is 0, start's bits. Finite. target: NULL
 * unless the mode has a kind. count: whole blocks. */
typedef void (*WrCoverageMode)(const WrModeArgs *args, const float *start, const float *part,
                               const float *target, int count, float *out);

struct WrMoveBox; /* displace_modes.h */
/* Change the heights of a dab's box. */
typedef void (*WrMoveMode)(struct WrMoveBox *box);
/* Of a dab's radius and its way from the one before, in texels. */
typedef double (*WrMoveMargin)(double radius, double way_x, double way_y);

typedef struct WrModeWork {
    WrCoverageMode cover; /* NULL for moving modes */
    WrBlendTargetKind target;
    WrMoveMode move;     /* NULL for covering ones */
    WrMoveMargin margin; /* moving: texels beside the dab that it reads; NULL: one */
    bool first_height;   /* `to` is the height under the stroke's first sample */
    bool lowers_mark;
    bool as_strong; /* does nothing where strength is 0 */
} WrModeWork;

const WrModeWork *wr_mode_work(WrBrushMode mode);
WrModeArgs wr_mode_args(const WrBrush *brush); /* sane */

/* The nearest float, cut to float's range. */
static inline float wr_finite_float(double height)
{
    height = height < 3.4028234663852886e38 ? height : 3.4028234663852886e38;
    return (float)(height > -3.4028234663852886e38 ? height : -3.4028234663852886e38);
}

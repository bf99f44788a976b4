/* kern_wide_set_body.h - the text of each kern_wide_*.c, which defines WR_WIDE_TABLE. A header without a guard, by
   intention. */
#include "base/kernmath.h"
#include "render/pyramid.h"
#include "render/srgb_codes.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "render/kern_wide_body.h"
#ifdef WIDE
#include "render/kern_wide_light_body.h"
#include "render/kern_wide_place_body.h"
#include "render/kern_wide_chord_body.h"
#include "render/kern_wide_sphere_body.h"
#include "render/kern_wide_look_body.h"
#include "render/kern_wide_filter_body.h"
#include "render/kern_wide_codes_body.h"
#include "render/kern_wide_newton_body.h"
#include "render/kern_wide_bend_body.h"
#include "render/kern_wide_knots_body.h"

const WrWide WR_WIDE_TABLE = { narrow,       wide_shade,     wide_smooth,       wide_paint,
                               wide_sphere,  wide_points,    wide_sphere_light, wide_central,
                               wide_filters, wide_footprint, wide_filtered,     wide_colour,
                               wide_codes,   wide_newton,    wide_cross,        wide_blinn,
                               wide_between, wide_sheet_row };
#else
const WrWide WR_WIDE_TABLE = { 0 };
#endif
